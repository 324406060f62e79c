"""Driven motions against those in extended precision."""

import json

import tolerances as tol
from drives import given
from places import ROOT

import viscoroll as vr

MOTIONS = json.loads((ROOT / "data/reference/check_driven.json").read_text())["motions"]


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
