"""Reference motions of data/reference as scenes, starts and drives; data/README.md says how they
were made.
"""

from __future__ import annotations

import json
from types import SimpleNamespace
from typing import Any, NamedTuple

import numpy as np

import viscoroll as vr

from ... import stage

FOLDER = stage.ROOT / "data/reference"
VALUES, FREE, DRIVEN = (
    FOLDER / name for name in ("check_values.csv", "check_motions.csv", "check_driven.json")
)
PARAMETERS = ("alpha", "kappa", "mu", "gamma", "j")
SPEEDS = ("V", "omega")
OUTPUTS = ("V", "omega", "x", "angle")
PATHS = ("x", "angle", "work_force", "work_torque", "brake_loss", "slip_loss")


class Case(NamedTuple):
    """A motion: scene, start, output times, and the keywords of its drive."""

    scene: vr.Scene
    V0: float | None
    omega0: float | None
    t: Any
    drive: dict[str, Any]

    def __str__(self) -> str:
        return (
            f"{self.scene!r:.200}, V0 = {self.V0!r}, omega0 = {self.omega0!r}, end = "
            f"{float(self.t[-1])!r}"
        )


def free_motion(rows: list[dict[str, Any]]) -> tuple[Case, Any]:
    """The motion that rows of check_motions.csv describe, and its values."""
    first = rows[0]
    t = np.array([row["t"] for row in rows])
    values = {name: np.array([row[name] for row in rows]) for name in OUTPUTS}
    scene = vr.Scene(*(first[name] for name in PARAMETERS))
    return Case(scene, first["V0"], first["omega0"], t, {}), SimpleNamespace(
        **values, onset_time=first["onset_time"]
    )


def driven_motion(row: dict[str, Any]) -> Case:
    """The motion that a row of check_driven.json describes."""
    given = {"alpha": None} | row["scene"]
    bodies = {
        name: vr.Prony(**given.pop(name))
        for name in ("prony", "cylinder", "half_space")
        if name in given
    }
    if bodies:
        given["material"] = bodies.get("prony") or vr.Bodies(*bodies.values(), given.pop("share"))
    drive = {
        name: value
        if not isinstance(value, dict)
        else (vr.Schedule if "times" in value else vr.Feedback)(**value)
        for name, value in row["drive"].items()
    }
    return Case(vr.Scene(**given), row["V0"], row["omega0"], np.array(row["t"]), drive)


def read_elements(name: str) -> list[dict[str, Any]]:
    """Return the states of check_elements.json of one kind: "bodies", "covers" or "free_creep"."""
    return json.loads((FOLDER / "check_elements.json").read_text(encoding="utf-8"))[name]
