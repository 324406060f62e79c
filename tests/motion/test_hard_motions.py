"""Motions of every regime, and that once went wrong: as at the tightest tolerance, in few steps
(hard_motions.json).
"""

import json
from pathlib import Path

import numpy as np
import pytest
from closeness import close
from drives import given

import viscoroll as vr

pytestmark = [
    pytest.mark.filterwarnings(
        "ignore::viscoroll.ModelWarning"
    ),  # scenes of all kinds, beyond the model too
    pytest.mark.filterwarnings("ignore:roll"),
]
#: scene, start, drive, times; tolerances, and how many of each the error may be; steps at most
MOTIONS = json.loads(Path(__file__).with_name("hard_motions.json").read_text())
TIGHT = 1e-12


def mirrored(name, drive):
    """What drives the other way: all but a brake, and gains."""
    if isinstance(drive, vr.Feedback):
        return vr.Feedback(mirrored(name, drive.value), V=drive.V, omega=drive.omega)
    sign = 1.0 if name == "brake" else -1.0
    return (
        vr.Schedule(drive.times, sign * drive.values)
        if isinstance(drive, vr.Schedule)
        else sign * drive
    )


@pytest.mark.parametrize("row", MOTIONS, ids=[row["name"] for row in MOTIONS])
def test_as_at_the_tightest_tolerance(row):
    """Regimes, their ends and turns of V; speeds over the largest so far, of free motions over that
    of the time.  Start and drive the other way: the same bits, the other way.
    """
    scene = vr.Scene(*row["scene"])
    case = *row["start"], row["t"]
    drive = {name: given(plain) for name, plain in row["drive"].items()}
    best = scene.roll(*case, rtol=TIGHT, **drive)
    speed = np.maximum(abs(best.V), abs(best.omega))
    scale = np.maximum.accumulate(speed) if drive else speed
    for rtol in row["rtols"]:
        m = scene.roll(*case, rtol=rtol, **drive)
        bound = row["bound"] * (rtol + TIGHT)
        assert {m.status, best.status} == {vr.MotionStatus.DONE}
        assert m.steps <= row["steps"]
        assert [s.regime for s in m.switches] == [s.regime for s in best.switches]
        events, found = ([*(s.t for s in of.switches), *of.reversals] for of in (best, m))
        assert not events or close(found, events, bound, scale=row["t"][-1])
        sizes = {"V": scale, "omega": scale, "x": np.maximum.accumulate(abs(best.x))}
        for name, size in sizes.items():
            assert close(m[name], best[name], bound, scale=size, what=(name, rtol))
    other = {name: mirrored(name, each) for name, each in drive.items()}
    start = [None if one is None else -one for one in row["start"]]
    back = scene.roll(*start, row["t"], rtol=rtol, **other)
    for field in ("V", "omega", "x", "angle", *(("force", "torque") if drive else ())):
        assert np.array_equal(m[field], -back[field], equal_nan=True), field
    moves = abs(m.V) > 0.0
    assert np.array_equal(m.delta[moves], back.delta[moves])
