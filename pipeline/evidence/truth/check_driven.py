"""Driven motions to test any implementation against -> data/reference/check_driven.json (kept in git).

    python -m pipeline.evidence.truth.check_driven [--config FILE] [--folder FOLDER] [-o FOLDER]

Force, torque, slopes, feedback, prescribed speeds, brakes, unlike bodies and several relaxation times, integrated in
extended precision by pipeline.evidence.truth.roll_precise.  Each is rolled twice, the second time with more nodes,
shorter steps and more digits; how far the two differ stands beside it.
"""

from __future__ import annotations

import json
import math
import sys
from pathlib import Path
from typing import Any

import flint
import msgspec
from tqdm import tqdm

import viscoroll as vr
from viscoroll.files import write_text

from ... import stage
from ..results import SIZES
from .driven_motions import MOTIONS, Driven
from .motion import PATHS, PreciseMotion, roll_precise

TARGET = stage.ROOT / "data/reference/check_driven.json"
SPEEDS = ("V", "omega")
#: the second of the two
FINER = {"tolerance": 1e-23, "nodes": 26, "bits": 260}
_BITS = 400
_PARAMETERS = ("kappa", "mu", "gamma", "j")


class CheckDriven(msgspec.Struct, forbid_unknown_fields=True):
    """[check_driven]: how many of the motions of driven_motions.py."""

    motions: int


def described(motion: Driven) -> dict[str, Any]:
    """A motion as JSON has it."""
    scene, material = motion.scene, motion.scene.material
    given: dict[str, Any] = {name: getattr(scene, name) for name in _PARAMETERS}
    if material is None:
        given["alpha"] = scene.alpha
    elif isinstance(material, vr.Bodies):
        given |= {name: _series(getattr(material, name)) for name in ("cylinder", "half_space")}
        given["share"] = material.share
    else:
        given["prony"] = _series(material)
    drive = {name: _plain(value) for name, value in motion.drive.items()}
    return {"name": motion.name, "scene": given, "V0": motion.V0, "omega0": motion.omega0, "drive": drive}


def _series(p: vr.Prony) -> dict[str, list[float]]:
    return {"E": p.E.tolist(), "tau": p.tau.tolist()}


def _plain(given: Any) -> Any:
    if isinstance(given, vr.Feedback):
        return {"value": given.value, "V": given.V, "omega": given.omega}
    return {"times": given.times.tolist(), "values": given.values.tolist()} if isinstance(given, vr.Schedule) else given


def motion_of(row: dict[str, Any]) -> Driven:
    """The motion that a row describes; its end is the last of its times."""
    given = dict(row["scene"])
    if "alpha" not in given:
        bodies = {name: vr.Prony(**given.pop(name)) for name in ("prony", "cylinder", "half_space") if name in given}
        given["material"] = bodies["prony"] if "prony" in bodies else vr.Bodies(**bodies, share=given.pop("share"))
    drive = {name: _given(value) for name, value in row["drive"].items()}
    return Driven(row["name"], vr.Scene(**{"alpha": None} | given), row["V0"], row["omega0"], row["t"][-1], drive)


def _given(plain: Any) -> Any:
    if not isinstance(plain, dict):
        return plain
    return vr.Schedule(**plain) if "times" in plain else vr.Feedback(**plain)


def difference(one: PreciseMotion, other: PreciseMotion) -> float:
    """Worst of V, omega over the largest speed so far, of path, work and loss over their largest, and switch times."""
    with flint.ctx.workprec(_BITS):
        if [regime for _, regime in one.switches] != [regime for _, regime in other.switches]:
            return math.inf
        times = ([*(when for when, _ in m.switches), *m.reversals] for m in (one, other))
        worst = [abs(a / b - 1) for a, b in zip(*times, strict=True) if b != 0]
        fastest = flint.arb(0)
        for V, omega, V_too, omega_too in zip(one.V, one.omega, other.V, other.omega, strict=True):
            fastest = max(fastest, abs(V_too), abs(omega_too))
            if fastest > 0:
                worst += [abs(V - V_too) / fastest, abs(omega - omega_too) / fastest]
        for name in PATHS:
            found, best = getattr(one, name), getattr(other, name)
            largest = max(abs(value) for value in best)
            if largest > 0:
                worst += [abs(a - b) / largest for a, b in zip(found, best, strict=True)]
        return max(map(float, worst))


def check_row(motion: Driven) -> dict[str, Any]:
    """What a motion is and what it does, as the nearest doubles."""
    coarse, fine = (
        roll_precise(motion.scene, motion.V0, motion.omega0, motion.t, **motion.drive, **how) for how in ({}, FINER)
    )
    found = {name: [float(value) for value in getattr(fine, name)] for name in (*SPEEDS, *PATHS)}
    switches = [[float(when), regime] for when, regime in fine.switches]
    apart = float(f"{difference(coarse, fine):.1e}")
    return described(motion) | {
        "difference": apart, "t": motion.t, "switches": switches, "reversals": [float(t) for t in fine.reversals],
    } | found  # fmt: skip


def work(settings: CheckDriven, folder: Path) -> stage.Outcome:
    rows = [check_row(motion) for motion in tqdm(MOTIONS[: settings.motions], desc="motions", delay=1.0, leave=False)]
    target = stage.make_folder(folder) / TARGET.name
    content = {
        "title": "Driven motions of a viscoelastic cylinder: check values",
        "source": f"Eq. (22) with a drive, by collocation in extended precision, python-flint {flint.__version__}",
        "comment": "values: the nearest doubles; difference: of two motions with other nodes, steps and digits",
        "motions": rows,
    }
    write_text(target, json.dumps(content, indent=1) + "\n")
    return stage.Outcome([target], {"motions": len(rows), "largest difference": max(row["difference"] for row in rows)})


if __name__ == "__main__":
    sys.exit(stage.run("check_driven", CheckDriven, work, __doc__, config=SIZES, folder=TARGET.parent))
