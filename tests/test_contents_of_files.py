"""What files hold, by the calls that read them."""

from dataclasses import replace

import numpy as np
import pytest
import tolerances as tol
import xarray as xr
from calls import (
    CYLINDER_FILE,
    DRUM_M,
    DRUM_V,
    OMEGA,
    PAPER,
    ROLLER,
    ROLLER_FILE,
    RUBBER,
    RUBBER_FILE,
    SCENE_FILE,
    SERIES,
    STEEL,
    TREAD,
    data,
    file,
    measured,
    netcdf,
    pair,
    rows,
    run,
)
from closeness import close

import viscoroll as vr
from viscoroll.materials.material_toml import read_materials
from viscoroll.presets import PAPER_CYLINDER
from viscoroll.roller_toml import read_law_source, read_roller
from viscoroll.runs import estimate
from viscoroll.runs.run_store import block_inputs
from viscoroll.runs.uncertain_inputs import read_column

pytestmark = [
    pytest.mark.usefixtures("here"),
    pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning"),
]


def of_roller(content):
    return read_roller(file(content))


def of_materials(content):
    return read_materials(file(content))


def of_law_source(content):
    return read_law_source(file(content))


def test_scenes_and_cylinders_of_files():
    """What files hold: scenes, cylinders."""
    assert of_roller(SCENE_FILE).scene() == vr.Scene(11.0, 2.91, 0.2)
    assert (
        of_roller(SCENE_FILE + "gamma = 1.1e4\nj = 0.5").scene()
        == vr.presets.PAPER_SECTION_5_ROUNDED
    )
    assert of_roller(CYLINDER_FILE).scene() == vr.presets.PAPER_SECTION_5
    assert (
        of_roller(CYLINDER_FILE + 'plane = "stress"\nj = 1').scene()
        == replace(PAPER_CYLINDER, plane="stress", j=1.0).scene()
    )
    assert of_roller('preset = "paper-figures-2-3"').scene() == vr.presets.PAPER_FIGURES_2_3
    assert of_roller(
        'preset = "paper-figures-2-3"\n[scene]\nmu = 0.3'
    ).scene() == vr.presets.PAPER_FIGURES_2_3.replace(mu=0.3)
    assert of_roller(
        SCENE_FILE.replace("alpha = 11", "prony = { E = [2.0, 6.0], tau = [1.0, 1e-4] }")
    ) == vr.Scene(kappa=2.91, mu=0.2, material=SERIES)
    assert of_roller(
        SCENE_FILE.replace("alpha = 11", "creep = { J = [0.5], T = [1.0], alpha = 2.0 }")
    ) == vr.Scene(kappa=2.91, mu=0.2, material=vr.Prony.creep([0.5], [1.0]))
    assert of_roller(ROLLER_FILE + "load = 500\n" + RUBBER_FILE) == pair(RUBBER, None, load=500.0)


def test_materials_of_files():
    """What files hold: materials."""
    assert of_materials(RUBBER_FILE) == {"material": RUBBER}
    assert of_materials(RUBBER_FILE + 'name = "tread"\ndensity = 1100\n') == {
        "material": replace(RUBBER, name="tread", density=1100.0)
    }
    assert of_materials(RUBBER_FILE + "wlf = { T0 = 20.0 }\ntemperature = 30.0\n") == {
        "material": RUBBER.at(30.0, vr.WLF(T0=20.0))
    }
    assert of_materials(
        RUBBER_FILE + "reference = 20.0\nwlf = { T0 = -10.0 }\ntemperature = 30.0\n"
    ) == {"material": replace(RUBBER, temperature=20.0).at(30.0, vr.WLF(T0=-10.0))}
    assert of_materials(
        RUBBER_FILE + "arrhenius = { energy = 8e4, T0 = 20.0 }\ntemperature = 30.0\n"
    ) == {"material": RUBBER.at(30.0, vr.Arrhenius(energy=80000.0, T0=20.0))}
    assert of_materials("[material]\nE = inf\nnu = 0.5") == {"material": vr.Material.rigid()}
    assert of_materials("[material]\nE = 2e11\nnu = 0.3") == {
        "material": vr.Material.elastic(200000000000.0, 0.3)
    }
    assert of_materials("[material]\nE = 2.3e5\nnu = 0.49\nT_epsilon = 10.7\nT_sigma = 0.97") == {
        "material": vr.Material.sls(230000.0, 0.49, 10.7, 0.97)
    }
    assert of_materials("[material]\nE = 1e5\nnu = 0.4\ncreep = { J = [0.5], T = [1.0] }") == {
        "material": vr.Material(100000.0, 0.4, vr.Prony.creep([0.5], [1.0]))
    }
    assert of_materials(RUBBER_FILE + "[base]\nE = 2e11\nnu = 0.3\n[other]\nanything = 1") == {
        "material": RUBBER,
        "base": STEEL,
    }
    # what has a law: a cylinder or a scene, else materials; the plane of a cylinder was not read
    assert of_law_source(RUBBER_FILE).base is None
    assert of_law_source(RUBBER_FILE + "[base]\nE = 2e11\nnu = 0.3\n").base.E == 200000000000.0
    assert of_law_source(ROLLER_FILE + RUBBER_FILE).pair == of_law_source(RUBBER_FILE)
    assert (
        of_law_source(
            ROLLER_FILE + 'plane = "stress"\n' + RUBBER_FILE + "[base]\nE = 2e5\nnu = 0.2\n"
        ).pair.plane
        == "stress"
    )
    assert of_law_source(CYLINDER_FILE).pair.cylinder == vr.Material.sls(230000.0, 0.49, 10.7, 0.97)
    assert of_law_source("[scene]\nalpha = 11\nkappa = 3\nmu = 0.2") == 11.0
    assert of_law_source(
        "[scene]\nprony = { E = [1.0], tau = [0.1] }\nkappa = 3\nmu = 0.2"
    ) == vr.Prony([1.0], [0.1])
    # or the name of a preset, as in other commands
    assert read_law_source("paper-section-5-rounded") == 11.0
    assert read_law_source("rubber-roller") == vr.presets.RUBBER_ROLLER.material


def test_tables_and_DMA_files_of_other_programs():
    """Tables and DMA files of other programs."""
    # rows of 2-D arrays are curves
    assert close(
        [
            vr.fit_prony(
                kind([OMEGA] * 2),
                kind([TREAD.storage(a * OMEGA) for a in (10.0, 1.0)]),
                kind([TREAD.loss(a * OMEGA) for a in (10.0, 1.0)]),
                temperature=[0.0, 20.0],
            ).shifts.a_T[0]
            for kind in (np.array, xr.DataArray)
        ],
        [10.0, 10.0],
        tol.DMA_SHIFT,
    )
    # units that are equal, and those that the user gives; a symbol is no unit
    assert [
        list(
            vr.read_dma(
                file(f"f [Hz],E' [MPa],E'' [MPa]\n{row}\n1,2,1\n2,2,1\n"), units=units
            ).units.values()
        )
        for row, units in (
            ("Hz,N/mm²,MPa", None),
            ("rad/s,kPa,kPa", {"frequency": "Hz", "storage": "kPa", "loss": "MPa"}),
        )
    ] == [["Hz", "MPa", "MPa"], ["Hz", "kPa", "MPa"]]
    assert vr.read_dma(
        file("f,E',E'',Temperature (T)\nrad/s,kPa,kPa,°C\n1,1,1,20\n2,1,1,20\n")
    ).temperature.tolist() == [20.0, 20.0]
    # without a mu Q has no bound, and the load is not needed
    assert not vr.load_law(
        netcdf(
            vr.tables.build(ROLLER, [0.1, 0.2], delta=[0.0, 0.1])
            .drop_attrs(deep=False)
            .assign_attrs(R=0.1)
        )
    ).slips


def test_measurements_and_fits():
    """Measurements and fits."""
    # values that are nearly equal, whose differences say nothing of sigma: in full slip Q = mu P
    assert [
        round(
            vr.identify(
                ROLLER.replace(mu=0.5),
                {"mu": (0.1, 1.0)},
                [vr.Traction(V=1.0, delta=[0.2, 0.25, 0.3], Q=[80.0, 80.0, last])],
                starts=1,
            ).values["mu"]
            * ROLLER.load,
            3,
        )
        for last in (80.0, 80.0003)
    ] == [80.0, 80.0]
    assert (
        vr.identify(
            ROLLER, {"E": (3e5, 3e7)}, [vr.Resistance([0.1, 0.28, 0.56], [0.3] * 3)], starts=1
        ).does_not_act
        == ()
    )
    assert close(
        read_column(
            file(
                "log10(V0/(km/h));mu\n" + rows(np.log10(3.6 * DRUM_V), DRUM_M, sep=";"),
                "starts.csv",
            ),
            "log10(V0/(km/h))",
            "m s-1",
        ),
        DRUM_V,
        tol.WRITTEN,
    )
    assert [*measured("[[data]]", '[[data]]\nname = "unknown"').records] == ["unknown"]


@pytest.mark.parametrize(
    "content",
    [
        "V [m/s],M [N m/m]\n" + rows(DRUM_V, DRUM_M),
        "V,M\n" + rows(DRUM_V, DRUM_M),  # no units
        "V [km/h],M [N m/m]\n" + rows(3.6 * DRUM_V, DRUM_M),
        "V km/h,M N m/m\n" + rows(3.6 * DRUM_V, DRUM_M),  # units without brackets
        "V [m/s];M [N m/m]\n" + rows(DRUM_V, DRUM_M, sep=";", decimal=","),
        "V\tM\nm/s\tN m/m\n" + rows(DRUM_V, DRUM_M, sep="\t", decimal=","),  # units in a row
        "V/(m/s);M/(Nm/m)\n" + rows(DRUM_V, DRUM_M, sep=";"),
        "Drum 3\nDate;25.11.2026\n\nV [m/s];M [N m/m]\n" + rows(DRUM_V, DRUM_M, sep=";"),
        ("V [m/s];M [N m/m]\n" + rows(DRUM_V, DRUM_M, sep=";")).encode("utf-16"),
        # a column that is left aside
        "V,M,T [°C]\n" + rows(DRUM_V, DRUM_M, 20.0 + 0.0 * DRUM_V),
    ],
)
def test_data_files_of_identify(content):
    """The same separators, decimal marks and units as of moduli."""
    drum = data(content)
    assert close([drum.V, drum.M], [DRUM_V, DRUM_M], tol.WRITTEN)


def test_creep_in_per_cent():
    found = data("V [m/s],delta [%],Q [N/m]\n" + rows(DRUM_V, DRUM_M, DRUM_M), "traction").delta
    assert close(found, 0.01 * DRUM_M, tol.WRITTEN)


@pytest.mark.parametrize("title", ["V0 [km/h]", "V0/(km/h)", "V0 km/h"])
def test_a_column_of_a_run_file_is_converted_to_the_unit_of_the_input(title):
    path = file(f"{title};mu\n" + rows(3.6 * DRUM_V, DRUM_M, sep=";", decimal=","), "starts.csv")
    for name in ("V0", title):
        assert close(read_column(path, name, "m s-1"), DRUM_V, tol.WRITTEN)


def test_runs():
    """A correlation of inputs, sizes, a drive that ends."""
    assert (
        0.4
        < np.corrcoef(
            *[
                block_inputs(run("driven", "n = 12", "n = 500"), 0)[name]
                for name in ("drive_torque_2", "drive_force")
            ]
        )[0, 1]
        < 0.6
    )
    assert run("a preset", "n = 30\nseed = 5", "n = 3_000_000_000").blocks == -(
        -3_000_000_000 // 12
    )
    assert f"in {-(-3_000_000_000 // 12)} blocks of 12" in str(
        estimate(run("a preset", "n = 30\nseed = 5", "n = 3_000_000_000"), threads=2)
    )
    assert run("a preset", "count = 3 }\nrtol = 1e-6\nblock = 12", "count = 3_000_000 }").block == 1


def test_grids_of_few_nodes():
    """Grids of few nodes."""
    assert close(
        [
            vr.tables.interpolate(
                vr.tables.build(PAPER, V, delta=[0.0, 0.01], alpha=11.0),
                "Q",
                V=0.5,
                delta=0.01,
                alpha=11.0,
            ).Q
            for V in ([0.5], [0.4, 0.5], [0.4, 0.5, 0.6])
        ],
        [vr.contact(PAPER, 0.5, delta=0.01).Q] * 3,
        tol.TABLE_SPLINE_NODE,
    )
    # values from a grid in SI units had the units of a dimensionless one
    assert [
        vr.tables.interpolate(
            vr.tables.build(roller, [0.4, 0.5], delta=[0.0, 0.01]), "Q", V=0.5, delta=0.01
        )
        .to_xarray()
        .Q.attrs["units"]
        for roller in (PAPER, vr.presets.RUBBER_CYLINDER)
    ] == ["1", "N m-1"]
