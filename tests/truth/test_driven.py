"""Driven motions against those in extended precision."""

from __future__ import annotations

import json

import numpy as np
import pytest
import tolerances as tol
from closeness import close
from drives import given
from places import ROOT

import viscoroll as vr
from pipeline.evidence.truth.motion import PATHS

MOTIONS = json.loads((ROOT / "data/reference/check_driven.json").read_text(encoding="utf-8"))["motions"]


def inputs(row: dict) -> tuple[tuple, dict]:
    """Scene, start and times of a motion, and what drives it."""
    scene = {"alpha": None} | row["scene"]
    bodies = {name: vr.Prony(**scene.pop(name)) for name in ("prony", "cylinder", "half_space") if name in scene}
    if bodies:
        scene["material"] = bodies["prony"] if "prony" in bodies else vr.Bodies(**bodies, share=scene.pop("share"))
    drive = {name: given(value) for name, value in row["drive"].items()}
    return (vr.Scene(**scene), row["V0"], row["omega0"], row["t"]), drive


def test_check_motions_hold_together():
    """Thirty motions, each shown to 1e-15 by a second one; every regime and V = 0 in stick and in slip among them."""
    assert len(MOTIONS) == 30
    assert max(row["difference"] for row in MOTIONS) <= tol.PRECISE_DRIVEN
    assert {regime for row in MOTIONS for _, regime in row["switches"]} == {
        "full slip", "partial slip", "locked", "held"
    }  # fmt: skip
    assert sum(bool(row["reversals"]) for row in MOTIONS) >= 6
    assert {name for row in MOTIONS for name in row["drive"]} == {"force", "torque", "slope", "brake", "V", "omega"}


@pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")  # the paper's own scene is beyond the model
@pytest.mark.parametrize("rtol", [1e-6, 1e-10, 1e-12])
def test_roll_has_the_check_motions(rtol):
    """V and omega over the largest speed so far, works and losses over the largest, switches: within 30 rtol."""
    for row in MOTIONS:
        case, drive = inputs(row)
        m = vr.roll(*case, rtol=rtol, **drive)
        fastest = np.maximum.accumulate(np.maximum(np.abs(row["V"]), np.abs(row["omega"])))
        for field in ("V", "omega"):
            assert np.all(np.abs(getattr(m, field) - row[field]) <= tol.MOTION_RTOL * rtol * fastest), (
                row["name"],
                field,
            )
        for field in PATHS:
            best = np.array(row[field])
            off = np.abs(getattr(m, field) - best).max()
            assert off <= tol.MOTION_RTOL * rtol * np.abs(best).max(), (row["name"], field)
        assert [s.regime for s in m.switches] == [regime for _, regime in row["switches"]], row["name"]
        found = [*(s.t for s in m.switches), *m.reversals, m.t[-1]]
        best = [*(when for when, _ in row["switches"]), *row["reversals"], row["t"][-1]]
        assert close(found, best, rel=tol.MOTION_RTOL * rtol, scale=row["t"][-1], what=row["name"])
