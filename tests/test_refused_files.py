"""Bad files: one line with the file, the place in it, and what is allowed."""

from functools import partial

import pytest
from calls import (
    CYLINDER_FILE,
    OTHER_GRID,
    PAPER,
    ROLLER_FILE,
    RUBBER_FILE,
    SCENE_FILE,
    SOFT,
    STEEL,
    data,
    file,
    grid,
    law_file,
    measured,
    netcdf,
    of_law_source,
    of_materials,
    of_roller,
    run,
)
from refusals import each, refusals

import viscoroll as vr
from viscoroll.core import write_dataset
from viscoroll.materials.checked_netcdf import material_as_dataset
from viscoroll.presets import read_roller
from viscoroll.runs import read_run

pytestmark = pytest.mark.usefixtures("here")


def of_grid(table):
    return vr.load_law(netcdf(table))


def of_material(dataset):
    write_dataset(dataset, "given.nc", sealed=True)
    return vr.Material.from_netcdf("given.nc")


files = partial(each, error=vr.FileError)
OF_LAW = '[material]\nfile = "given.nc"\n'
SOFT_DATA = material_as_dataset(SOFT)
REFUSED = [
    *each(measured, {"unknown E = 3000000.0 | (low, high)": ("E = [3e5, 3e7]", "E = 3e6")}),
    *files(
        of_materials,
        {
            "file.toml | line 2 | E = inf | for a viscoelastic": RUBBER_FILE.replace(
                "2.3e5", "inf"
            ),
            "[material] has T_epsilon: T_eps": "[material]\nE = 1\nnu = 0.5\nT_epsilon = 1.0",
            "line 6: [material] temperature = 30 needs wlf or": RUBBER_FILE + "temperature = 30.0",
            "file.toml | temperature = -40.0 | °C, where the WLF shift is infinite": RUBBER_FILE
            + "wlf = { T0 = 20.0 }\ntemperature = -40.0",
            "file.toml | line 6: [material.arrhenius] needs energy": RUBBER_FILE
            + "arrhenius = { T0 = 20.0 }",
            "file.toml | section [material]": "material = 3",
            "file.toml | line 1: [material] needs nu": "\ufeff[material]\nE = 1.0",
            "line 2 | none.nc": '[material]\nfile = "none.nc"\n',
        },
    ),
    *files(
        of_grid,
        {
            "given.nc | V = | shape (0,) | must be real numbers, at least one": OTHER_GRID.isel(
                V=slice(0)
            ),
            "is not a grid of a law, since it has the | neither M (the": OTHER_GRID.drop_vars("M"),
            "must have V(V), delta(delta), Q(V, delta)": OTHER_GRID.assign(
                Q=OTHER_GRID.Q.isel(V=0)
            ),
            "given.nc | attribute units of Q = N m2 | N/m": OTHER_GRID.assign(
                Q=OTHER_GRID.Q.assign_attrs(units="N m2")
            ),
            "units of V = missing | m/s or a multiple of it, or 1 of a": OTHER_GRID.assign_coords(
                V=OTHER_GRID.V.drop_attrs()
            ),
            "grid of a law, since V = | must be two or more numbers, each la": OTHER_GRID.isel(
                V=[0]
            ),
        },
    ),
    *files(
        None,
        {
            "the table for x.nc: variable 'Q' has units = 'N': must be '1'": lambda: vr.tables.save(
                grid().assign(Q=grid().Q.assign_attrs(units="N")), "x.nc"
            ),
            "column 'j' of given.nc: the file has no column of this name": lambda: run(
                "a preset", "j = 0.4", f'j = {{ file = "{netcdf(grid())}", column = "j" }}'
            ),
            "column 'j' of j.nc: the file is damaged, or is not a .nc file": lambda: run(
                "a preset", "j = 0.4", f'j = {{ file = "{file("j", "j.nc")}", column = "j" }}'
            ),
            "has the laws of a range of alpha": lambda: vr.tables.export(
                vr.tables.law(alpha=(1, 2)), "law.h"
            ),
            "line 8: [material] T_ref cannot be uncertain; E, nu, prony, creep, temperature, "
            "thickness can": lambda: read_run(
                file(
                    CYLINDER_FILE.replace(
                        "E = 2.3e5\nnu = 0.49\nT_epsilon = 10.7\nT_sigma = 0.97\n", ""
                    )
                    + '[material]\nE = 1e6\nnu = 0.5\nT_ref = { distribution = "lognorm", '
                    "s = 0.1 }\nprony = { E = [1.0], tau = [1.0] }\n[start]\nV0 = 1.0\nomega0 "
                    "= 10.0\n[run]\nn = 2\nt = [1.0]"
                )
            ),
            "line 2: [start] V0 is missing: give a number": lambda: read_run(
                file('preset = "paper-section-5"\n[start]\nomega0 = 1.0\n[run]\nn = 2\nt = [1e-3]')
            ),
            "attribute 'material' is missing or | write the file again by vr.tables.save": lambda: [
                netcdf(law_file(), without="material"),
                of_materials(OF_LAW),
            ],
            "(its attribute viscoroll_table is 'other', that of a grid 'grid')": lambda: (
                vr.tables.save(grid().assign_attrs(viscoroll_table="other"), "x.nc")
            ),
            "given.nc: is not a material; it has the variables | : give a file": lambda: (
                vr.Material.from_netcdf(netcdf(grid()))
            ),
            "alpha = | must be > 0 and increase strictly": lambda: vr.load_law(
                netcdf(OTHER_GRID.expand_dims(alpha=[3.0, 2.0])), alpha=2.5
            ),
            "is damaged": lambda: of_grid(
                vr.tables.law(PAPER.alpha).assign(lam=("row", ["a", "b"]))
            ),
            "given.nc: is not a netCDF-4 (HDF5) file": [
                lambda: vr.Material.from_netcdf(file("E = 1", "given.nc")),
                lambda: vr.load_law(file("E = 1", "given.nc")),
            ],
            "line 2 | law of two materials: it must be that of one": lambda: [
                netcdf(vr.tables.law(SOFT, STEEL)),
                of_roller(OF_LAW + ROLLER_FILE),
            ],
            "line 2 | dimensionless contact law": lambda: [
                netcdf(law_file()),
                of_roller(OF_LAW + ROLLER_FILE),
            ],
            "line 2: [base] | dma.toml | section [material] is missing": lambda: [
                file("[scene]\nalpha = 2.0\n", "dma.toml"),
                of_materials('[base]\nfile = "dma.toml"\n'),
            ],
            "V has the unit m/s and km/h, a unit that is not known: must be in a unit": lambda: (
                data("V [m/s],M [N]\nkm/h,N\n1,2\n2,3\n")
            ),
            "delta has the unit deg, an angle: must be": lambda: data(
                "V [m/s],delta [deg],Q [N/m]\n1,2,3\n", "traction"
            ),
            "cannot be read": lambda: read_roller("missing.toml"),
        },
    ),
    *files(
        lambda **changed: of_grid(law_file().assign_attrs(**changed)),
        {
            "given.nc | law_schema = 2 (version | but viscoroll": {"law_schema": 2},
            "given.nc | its numbers do not match the checksum": {"sha256_of_numbers": "0" * 64},
            "given.nc: is damaged or was edited: | attribute material": {"material": "not TOML"},
        },
    ),
    *files(
        lambda call: call(3),
        {
            "3: is not a path": [
                lambda path: vr.tables.export(grid(), path),
                vr.Material.from_netcdf,
                vr.load_law,
                lambda path: PAPER.contact(V=[1.0, 2.0], delta=0.0).plot(path),
                read_run,
                vr.runs.verify,
                vr.runs.open_run,
                vr.datasets.copy_files,
            ]
        },
    ),
    *files(
        of_material,
        {
            "is incomplete: the variable or attribute 'nu' is missing; write the file": (
                SOFT_DATA.drop_vars("nu")
            ),
            "given = 'both': must be relaxation or creep": SOFT_DATA.assign_attrs(given="both"),
            "has a wrong value (nu = 0.7: must be in (-1, 0.5])": SOFT_DATA.assign(nu=0.7),
            "schema = 'other', but a | 'viscoroll material 1'": SOFT_DATA.assign_attrs(
                schema="other"
            ),
        },
    ),
    *files(
        measured,
        {
            "line 2: prior = 3: must be a section with the header [prior]": (
                "[cylinder]",
                "prior = 3\n[cylinder]",
            ),
            "is not a path: must be a text without null characters": ('"drum.csv"', '"a\\u0000"'),
            "line 19: [data] kind is missing: must be one of resistance, traction, coastdown": (
                'kind = "resistance"',
                "",
            ),
            "unknown key 'sigmma' | did you mean 'sigma' | line 23": ("sigma", "sigmma"),
            "has no column 'moment'; its columns are | force": ("moment [N m/m]", "force [N]"),
            "[data.columns] unknown key 'Q' | V, M, F": (
                'M = "moment"',
                'M = "moment", Q = "moment"',
            ),
            "no.csv | cannot be read": ('"drum.csv"', '"no.csv"'),
            "unknown key 'more'": ("[[data]]", "[more]\n[[data]]"),
        },
    ),
    *files(
        of_roller,
        {
            "line 1: [scene] needs alpha": "[scene]\nkappa = 2.0\nmu = 0.1",
            "alpha and creep are both given": SCENE_FILE + "creep = { J = [0.5], T = [1.0] }",
            "line 4: [cylinder] | unknown key 'Mu' | did you mean 'mu'?": "[cylinder]\nR = "
            "0.1\nm = 35.5\nMu = 0.2\n[material]\nE = 1e6\nnu = 0.5",
            "file.toml: line 5: [material] is given beside [scene]": SCENE_FILE + RUBBER_FILE,
            "file.toml | [cylinder] | 'sideways' | plane": CYLINDER_FILE + 'plane = "sideways"',
            "file.toml | preset: 'paper' is not | paper-section-5": 'preset = "paper"',
            "file.toml | not TOML | line 1": "[scene\nalpha = 1",
        },
    ),
    *files(
        run,
        {
            "[base] base_E: material | but where shear acts on | coupled = false in": (
                "rubber on steel",
                "coupled = false",
                "",
            ),
            "[drive] V and omega are both given": (
                "driven",
                "brake = 0.01",
                "V = 0.01\nomega = 0.01",
            ),
            "file.toml: line 3: [scene.creep] J_2: draws extend from 0.3 to 0.9: sum of J = "
            "1.0999999999999999 | narrow the distribution by truncate = [low, high]": (
                "compliances",
                "scale = 0.2",
                "scale = 0.6",
            ),
            "[material.prony] E_1: the Prony series of the cover (of the cylinder) has several "
            "values: must be the same for all cylinders (thickness, load and R may differ; E "
            "and nu too if the other body is rigid": (
                "on what is rigid",
                "[material]",
                "coupled = false\n[material]\nthickness = 0.1",
            ),
            "file.toml: line 10: [drive.brake] drive_brake_time_1: draws extend from "
            "5.55112e-17 to 1: brake | narrow the distribution by truncate = [low, high]": (
                "driven",
                "brake = 0.01",
                'brake = { times = [{ distribution = "uniform" }, 0.5], values = [1.0, 2.0] }',
            ),
            "file.toml: line 4: [start] V0 = 0: must be left out | or 0.01, the prescribed V": (
                "driven",
                "brake = 0.01",
                "V = 0.01",
            ),
        },
    ),
    *files(
        partial(run, "a preset"),
        {
            "column 'j' of none.nc: the file does not exist": (
                "j = 0.4",
                'j = { file = "none.nc", column = "j" }',
            ),
            "line 4: [scene] mu: unknown key 'distribtion'; did you mean 'distribution'?": (
                'distribution = "lognorm"',
                'distribtion = "lognorm"',
            ),
            "line 4 | scipy.stats | did you mean 'lognorm'?": ('"lognorm"', '"lognrom"'),
            "line 4 | lognorm lacks these parameters: s": ("s = 0.3, ", ""),
            "an integer of more than 64 bits: write a shorter or a decimal": (
                "j = 0.4",
                f"j = {-(2**63) - 1}",
            ),
            "has the number 1e400, beyond 1.8e308": ("j = 0.4", "j = 1e400"),
            "line 4 | finite number without a unit": ("s = 0.3", 's = "0.3 %"'),
            "line 4 | truncate = [-0.05, 0.0]: must be where the distribution has draws": (
                "[0.05, 0.6]",
                "[-0.05, 0.0]",
            ),
            "line 10 | did you mean 'omega0'?": ("V0.mu = 0.7", "V0.omega = 0.7"),
            "line 14 | high = 1e+308: must be less than": (
                "low = 0.0, high = 3e-3",
                "low = -1e308, high = 1e308",
            ),
            "[heat] is given beside": ("[run]", "[heat]\nambient = 20.0\nconductance = 1.0\n[run]"),
            "line 16 | is uncertain, and not only V0 and omega0": ("block = 12", 'method = "flow"'),
            "line 18: [run] summaries = []: must name at least one quantity": ('["V", "x"]', "[]"),
        },
    ),
    *files(
        of_law_source,
        {
            "file.toml | section [material] | is missing": [
                "[base]\nE = 2e11\nnu = 0.3\n",
                "[other]\nx = 1",
            ]
        },
    ),
]
test_refused = refusals(REFUSED)
