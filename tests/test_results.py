"""What results say of themselves: short text, HTML, xarray, pandas, figures."""

import copy
import sys
from functools import partial

import numpy as np
import pytest
import tolerances as tol
import xarray as xr
from closeness import close

import viscoroll as vr
from viscoroll.core.files import write_dataset
from viscoroll.motion.ensembles import FIELDS

pytestmark = pytest.mark.filterwarnings(
    "ignore::viscoroll.ModelWarning"
)  # the paper's own scene is beyond the model

SCENE = vr.presets.PAPER_SECTION_5_ROUNDED
ROLLER = vr.presets.RUBBER_CYLINDER


@pytest.fixture(scope="module")
def results():
    """One of each kind, dimensionless and in SI units."""
    t = np.linspace(0.0, 4e-3, 9)
    V = np.geomspace(1e-2, 1.0, 5)
    dma = vr.read_dma(vr.datasets.path("dma.csv"))
    return {
        "contact": SCENE.contact(V[:, None], delta=np.linspace(-0.02, 0.02, 4)),
        "contact in SI": ROLLER.contact(V, delta=0.01),
        "stress": SCENE.stress(np.linspace(-0.2, 0.6, 21), 0.5, delta=-0.01),
        "driven": SCENE.roll(0.0, 0.0, t, torque=vr.Schedule([0.0, 2e-3], [0.0, 0.1])),
        "motion in SI": ROLLER.roll(1.0, 0.0, np.linspace(0.0, 1.0, 9)),
        "scenes each": SCENE.replace(mu=[0.1, 0.2, 0.3]).ensemble(
            1.0, 0.5, t, fields=FIELDS, rest=1e-3
        ),
        "ensemble in SI": ROLLER.ensemble(np.linspace(0.5, 1.5, 3), 0.0, [0.1, 0.2]),
        "steady": SCENE.steady(slope=np.radians([1.0, 2.0, 30.0])),
        "fit": vr.fit_prony(dma, modes=3, misfit=0.2),
        "relaxation": vr.RelaxationModulus([0.1, 1.0], [2e6, 1e6]),
        "material": ROLLER.material,
    }


def test_each_shows_itself(results, tmp_path):
    """A short text, HTML, and a dataset with units that a file keeps."""
    for name, result in results.items():
        assert len(repr(result).splitlines()) < 25, name
        assert result._repr_html_().startswith("<"), name
        data = result.to_xarray()
        for variable in () if name == "fit" else data.data_vars.values():
            assert {"units", "flag_values"} & variable.attrs.keys(), (name, variable.name)
        path = tmp_path / "result.nc"
        write_dataset(data, path)
        with xr.open_dataset(path, engine="h5netcdf", decode_times=False) as stored:
            xr.testing.assert_equal(stored.load(), data)


@pytest.mark.long
def test_each_is_drawn(results):
    for name, result in results.items():
        figure = result.plot()
        # takes most of the time; figures of the program have theirs
        figure.set_layout_engine("none")
        figure.draw_without_rendering()
        assert any(axes.get_xlabel() for axes in figure.axes), name


def test_each_is_equal_to_itself_alone(results):
    """Arrays have no single answer: a comparison of results raised, and so did their hash."""
    for result in (*results.values(), results["steady"].loss):
        other = copy.copy(result)
        assert result == result
        assert result in {result}
        if not isinstance(result, vr.Material):
            assert result != other


def test_a_torque_that_jumps_is_drawn_with_both_sides():
    """In a figure of few output times too: the schedule's corners, and beside it what does not
    jump.
    """
    schedule = vr.Schedule([0.0, 1.0, 1.0, 2.0, 2.0, 2.2, 2.2], [3.0, 3.0, 0.0, 0.0, 5.0, 5.0, 0.0])
    force = vr.Feedback(vr.Schedule([0.0, 0.7], [0.0, 4.0]), V=-2.0)
    m = ROLLER.roll(0.0, 0.0, [0.0, 0.5, 1.0, 3.0], torque=schedule, force=force)
    *_, force, torque = (axes.lines[0].get_data() for axes in m.plot().axes)
    t, drawn = torque
    for when, sides in ((1.0, (3.0, 0.0)), (2.2, (5.0, 0.0))):
        assert np.isin(sides, drawn[t == when]).all()
    assert not (np.diff(t) * np.diff(drawn)).any()
    t, drawn = force
    assert close(drawn[t == 3.0], m.force[-1], tol.FIGURE)
    assert 0.7 in t


@pytest.mark.parametrize(
    "call, most",
    [
        (partial(ROLLER.contact, 0.01, delta=1e-3), 75),
        (partial(ROLLER.roll, 0.05, 0.5, [1e-3]), 130),
        # it warns of the wave speed at two of its four states
        (partial(ROLLER.steady, force=2.0), 260),
        (partial(ROLLER.steady, V=0.05, torque=0.0), 260),
    ],
)
def test_the_way_of_one_state_is_short(call, most):
    """Calls of Python and of C for one state, those of its scene among them, as a profiler counts
    them: people loop over states.
    """
    call()  # what is made once
    events = []
    sys.setprofile(lambda frame, event, arg: events.append(event))
    try:
        call()
    finally:
        sys.setprofile(None)
    assert events.count("call") + events.count("c_call") <= most


def test_results_say_whether_they_succeeded():
    one = ROLLER.steady(force=2.0)
    none = ROLLER.steady(force=1e9)
    assert (one.success, one.status, one.message) == (True, 0, "")
    assert (none.success, none.status, none.message) == (False, 1, none.reason)
    assert ROLLER.steady(force=[2.0, 1e9]).success.tolist() == [True, False]
    assert ROLLER.contact(0.01, delta=0.0).success
