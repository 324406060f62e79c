"""Driven motions against those in extended precision."""

import json

import tolerances as tol
from places import ROOT

MOTIONS = json.loads((ROOT / "data/reference/check_driven.json").read_text())["motions"]


def test_check_motions_hold_together():
    """Thirty motions, each shown to 1e-15 by a second one; every regime and V = 0 in stick and in slip among them."""
    assert len(MOTIONS) == 30
    assert max(row["difference"] for row in MOTIONS) <= tol.PRECISE_DRIVEN
    assert {regime for row in MOTIONS for _, regime in row["switches"]} == {
        "full slip", "partial slip", "locked", "held"
    }  # fmt: skip
    assert sum(bool(row["reversals"]) for row in MOTIONS) >= 6
    assert {name for row in MOTIONS for name in row["drive"]} == {"force", "torque", "slope", "brake", "V", "omega"}
