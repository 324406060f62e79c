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
    netcdf,
    of_law_source,
    of_materials,
    of_roller,
    pair,
    rows,
)
from closeness import close

import viscoroll as vr
from viscoroll.presets import PAPER_CYLINDER, read_law_source
from viscoroll.runs.uncertain_inputs import read_column

pytestmark = [
    pytest.mark.usefixtures("here"),
    pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning"),
]


def test_scenes_and_cylinders_of_files():
    """What files hold: scenes, cylinders."""
    for text, exact in {
        SCENE_FILE: vr.Scene(11.0, 2.91, 0.2),
        SCENE_FILE + "gamma = 1.1e4\nj = 0.5": vr.presets.PAPER_SECTION_5_ROUNDED,
        CYLINDER_FILE + 'plane = "stress"\nj = 1': replace(PAPER_CYLINDER, plane="stress", j=1.0),
        'preset = "paper-figures-2-3"\n[scene]\nmu = 0.3': (
            vr.presets.PAPER_FIGURES_2_3.replace(mu=0.3)
        ),
        SCENE_FILE.replace("alpha = 11", "prony = { E = [2.0, 6.0], tau = [1.0, 1e-4] }"): (
            vr.Scene(kappa=2.91, mu=0.2, material=SERIES)
        ),
        SCENE_FILE.replace("alpha = 11", "creep = { J = [0.5], T = [1.0], alpha = 2.0 }"): (
            vr.Scene(kappa=2.91, mu=0.2, material=vr.Prony.creep([0.5], [1.0]))
        ),
        ROLLER_FILE + "load = 500\n" + RUBBER_FILE: pair(RUBBER, None, load=500.0),
    }.items():
        assert of_roller(text) == exact, text


def test_materials_of_files():
    """What files hold: materials."""
    for text, exact in {
        'name = "tread"\ndensity = 1100\n': replace(RUBBER, name="tread", density=1100.0),
        "wlf = { T0 = 20.0 }\ntemperature = 30.0\n": RUBBER.at(30.0, vr.WLF(T0=20.0)),
        "reference = 20.0\nwlf = { T0 = -10.0 }\ntemperature = 30.0\n": (
            replace(RUBBER, temperature=20.0).at(30.0, vr.WLF(T0=-10.0))
        ),
        "arrhenius = { energy = 8e4, T0 = 20.0 }\ntemperature = 30.0\n": (
            RUBBER.at(30.0, vr.Arrhenius(energy=80000.0, T0=20.0))
        ),
    }.items():
        assert of_materials(RUBBER_FILE + text) == {"material": exact}, text
    assert of_materials("[material]\nE = 1e5\nnu = 0.4\ncreep = { J = [0.5], T = [1.0] }") == {
        "material": vr.Material(100000.0, 0.4, vr.Prony.creep([0.5], [1.0]))
    }
    assert of_materials(RUBBER_FILE + "[base]\nE = 2e11\nnu = 0.3\n[other]\nanything = 1") == {
        "material": RUBBER,
        "base": STEEL,
    }
    # what has a law: a cylinder or a scene, else materials; the plane of a cylinder was not read
    assert of_law_source(RUBBER_FILE + "[base]\nE = 2e11\nnu = 0.3\n").base.E == 200000000000.0
    assert of_law_source(ROLLER_FILE + RUBBER_FILE).pair == of_law_source(RUBBER_FILE)
    assert (
        of_law_source(
            ROLLER_FILE + 'plane = "stress"\n' + RUBBER_FILE + "[base]\nE = 2e5\nnu = 0.2\n"
        ).pair.plane
        == "stress"
    )
    # or the name of a preset, as in other commands
    assert read_law_source("paper-section-5-rounded") == 11.0
    assert read_law_source("rubber-roller") == vr.presets.RUBBER_ROLLER.material


def test_rows_of_labelled_arrays_are_curves():
    shifted = OMEGA * np.array([[10.0], [1.0]])
    columns = [OMEGA] * 2, TREAD.storage(shifted), TREAD.loss(shifted)
    fit = vr.fit_prony(*map(xr.DataArray, columns), temperature=[0.0, 20.0])
    assert close(fit.shifts.a_T[0], 10.0, tol.DMA_SHIFT)


def test_grids_of_other_programs():
    # without a mu Q has no bound, and the load is not needed
    assert not vr.load_law(
        netcdf(
            vr.tables.build(ROLLER, [0.1, 0.2], delta=[0.0, 0.1])
            .drop_attrs(deep=False)
            .assign_attrs(R=0.1)
        )
    ).rows.slips


@pytest.mark.parametrize(
    "content",
    [
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


def test_a_column_of_a_run_file_is_converted_to_the_unit_of_the_input():
    text = "V0 [km/h];mu\n" + rows(3.6 * DRUM_V, DRUM_M, sep=";", decimal=",")
    path = file(text, "starts.csv")
    for name in ("V0", "V0 [km/h]"):
        assert close(read_column(path, name, "m s-1"), DRUM_V, tol.WRITTEN)
