"""Many motions at once: the same as one at a time, for any number of threads."""

import numpy as np
import pytest
from closeness import close
from drives import RUBBER

import viscoroll as vr
from viscoroll.motion import drive_functions
from viscoroll.motion.ensembles import FIELDS
from viscoroll.motion.motion_arguments import STATES

pytestmark = pytest.mark.filterwarnings(
    "ignore::viscoroll.ModelWarning"
)  # the paper's own scene is beyond the model

SCENE = vr.presets.PAPER_SECTION_5_ROUNDED
T = np.linspace(0.0, 3e-3, 7)
COUNT = 10


STARTS = np.random.default_rng(1).uniform(-2.0, 2.0, (2, COUNT))
STARTS[:, :3] = [[0.0, 1.0, 0.0], [0.0, 1.0, -1.0]]


def from_to(first, last):
    """A value of each motion."""
    return np.linspace(first, last, COUNT)


TORQUE = from_to(-0.2, 0.2)
CORNERS = from_to([0.0, 1.0, 4.0], [0.0, 3.0, 9.0])
#: scenes, starts, times, and what acts; what is an array is of each
MANY = {
    "one scene": (SCENE, STARTS, T, {}),
    "a scene each": (
        vr.Scene(4.3, from_to(2.0, 30.0), 0.02, from_to(2e4, 5e3), from_to(0.3, 1.2)),
        STARTS,
        T,
        {},
    ),
    "driven": (
        RUBBER,
        (from_to(0.1, 0.1), from_to(0.0, 0.0)),
        np.linspace(0.0, 8.0, 9),
        {
            "torque": vr.Schedule(CORNERS, TORQUE[:, None] * [1.0, -0.3, 0.5]),
            "force": 0.01,
            "slope": 0.1 * TORQUE,
        },
    ),
    "unsteady, an alpha each": (
        RUBBER.replace(alpha=from_to(5.0, 9.0)),
        (from_to(1.0, 1.5), from_to(0.0, 0.0)),
        np.linspace(0.0, 3.5, 8),
        {"unsteady": True},
    ),
}


def one_of(many, index):
    names = ("alpha", "kappa", "mu", "gamma", "j")
    return vr.Scene(*(np.broadcast_to(getattr(many, name), COUNT)[index] for name in names))


def given_to(index, value):
    if isinstance(value, vr.Schedule):
        return vr.Schedule(value.times[index], value.values[index])
    return value[index] if np.ndim(value) else value


@pytest.mark.parametrize("name", MANY)
def test_ensemble_is_roll_bit_for_bit(monkeypatch, name):
    """Whatever the number of motions the pieces of whose drives are made at a time.  Of materials
    each that are known by their rows: ``materials/test_each.py``.
    """
    monkeypatch.setattr(drive_functions, "_BLOCK_BYTES", 2000)
    many, (V0, omega0), t, options = MANY[name]
    result = many.ensemble(V0, omega0, t, fields=FIELDS, threads=2, method="integrate", **options)
    for i in range(COUNT):
        motion = one_of(many, i).roll(
            V0[i], omega0[i], t, **{k: given_to(i, v) for k, v in options.items()}
        )
        for field in (*STATES, "onset_time", "status", "steps"):
            assert np.array_equal(result[field][i], getattr(motion, field), True), (i, field)
        assert result.switches[i] == len(motion.switches)


# --- what a result holds ---


def test_summary():
    result = SCENE.ensemble(*STARTS, T)
    summary = result.summary(quantiles=(0.25, 0.5))
    assert close(summary.V_mean, result.V.mean(axis=0), 1e-13)
    assert close(summary.V_quantiles.sel(quantile=0.5), np.median(result.V, axis=0), 1e-13)
    assert summary.attrs["motions"] == summary.ended.sum() == COUNT
    for counted in (summary.V_counted, summary.V_histogram.sum("V_bin")):
        assert (counted == COUNT).all()


def test_the_sense_of_a_start_from_rest():
    """Friction moves the axis in the sense of the rotation, so the states that are judged have
    omega >= 0 at V >= 0.
    """
    motions = vr.presets.RUBBER_CYLINDER.ensemble(0.0, [-20.0, 20.0], 1.0)
    assert motions.fastest().omega.tolist() == [20.0, 20.0]
