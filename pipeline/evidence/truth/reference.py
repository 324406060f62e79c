"""The check values in data/reference, for any implementation: what they are of, and how they were made.

    python -m pipeline.evidence.truth.reference [values|motions|driven ...] [--count N] [-o FOLDER]

Each file holds its inputs; its values are made from them again, and the file is written anew (the first N of them with
--count).  Contact states: the double nearest to a certified enclosure, and the condition numbers: the relative error
that one of 1 in each input makes.  Motions, free and driven: in extended precision, rolled twice, the second time with
more nodes, shorter steps and more digits; how far the two differ stands beside them.
"""

from __future__ import annotations

import argparse
import json
import math
import sys
from itertools import accumulate, groupby
from operator import itemgetter
from pathlib import Path
from types import SimpleNamespace
from typing import Any, NamedTuple

import flint
import numpy as np
from flint import arb
from tqdm import tqdm

import viscoroll as vr
from viscoroll.core.files import write_text

from ... import stage
from .enclosures import INPUTS, condition_numbers, contact_enclosure
from .motion import PATHS, PreciseMotion, roll_precise

FOLDER = stage.ROOT / "data/reference"
VALUES, FREE, DRIVEN = (FOLDER / name for name in ("check_values.csv", "check_motions.csv", "check_driven.json"))
FIELDS = ("lam", "zeta", "epsilon", "delta_star", "beta", "Q", "M")
CONDITIONED = ("epsilon", "delta_star", "beta", "Q", "M")
PARAMETERS = ("alpha", "kappa", "mu", "gamma", "j")
SPEEDS, OUTPUTS = ("V", "omega"), ("V", "omega", "x", "angle")
#: the second of two motions: what a step leaves out is about the power ``nodes`` of its length
FINER = {"tolerance": 1e-26, "nodes": 28, "bits": 280}
_BITS = 400


class Case(NamedTuple):
    """A motion: scene, start, output times, and the keywords of its drive."""

    scene: vr.Scene
    V0: float | None
    omega0: float | None
    t: Any
    drive: dict[str, Any]

    def __str__(self) -> str:
        return f"{self.scene!r:.200}, V0 = {self.V0!r}, omega0 = {self.omega0!r}, end = {float(self.t[-1])!r}"


def value_row(row: dict[str, Any]) -> dict[str, Any]:
    """Inputs, values and condition numbers of one state."""
    state = {name: row[name] for name in INPUTS}
    values = contact_enclosure(**state)
    conditions = condition_numbers({name: arb(abs(value)) for name, value in state.items()})
    found = {"full_slip": int(values["full_slip"])} | {name: float(values[name]) for name in FIELDS}
    return state | found | {f"condition_{name}": float(f"{conditions[name]:.2e}") for name in CONDITIONED}


def free_motion(rows: list[dict[str, Any]]) -> tuple[Case, Any]:
    """The motion that rows of check_motions.csv describe, and its values."""
    first, t = rows[0], np.array([row["t"] for row in rows])
    values = {name: np.array([row[name] for row in rows]) for name in OUTPUTS}
    scene = vr.Scene(*(first[name] for name in PARAMETERS))
    return Case(scene, first["V0"], first["omega0"], t, {}), SimpleNamespace(**values, onset_time=first["onset_time"])


def driven_motion(row: dict[str, Any]) -> Case:
    """The motion that a row of check_driven.json describes."""
    given = {"alpha": None} | row["scene"]
    bodies = {name: vr.Prony(**given.pop(name)) for name in ("prony", "cylinder", "half_space") if name in given}
    if bodies:
        given["material"] = bodies.get("prony") or vr.Bodies(*bodies.values(), given.pop("share"))
    drive = {
        name: value if not isinstance(value, dict) else (vr.Schedule if "times" in value else vr.Feedback)(**value)
        for name, value in row["drive"].items()
    }
    return Case(vr.Scene(**given), row["V0"], row["omega0"], np.array(row["t"]), drive)


def rolled_twice(case: Case) -> tuple[PreciseMotion, float]:
    """The finer of two motions, and how far they differ, to two digits."""
    given = case.scene, case.V0, case.omega0, case.t.tolist()
    coarse, fine = (roll_precise(*given, **case.drive, **how) for how in ({}, FINER))
    return fine, float(f"{difference(coarse, fine):.1e}")


def difference(one: PreciseMotion, other: PreciseMotion) -> float:
    """Worst of V, omega over the larger of both, paths and losses over their largest so far, events over themselves."""
    with flint.ctx.workprec(_BITS):
        if [regime for _, regime in one.switches] != [regime for _, regime in other.switches]:
            return math.inf
        events = ([*(when for when, _ in m.switches), *m.reversals] for m in (one, other))
        worst = [abs(a / b - 1) for a, b in zip(*events, strict=True) if b != 0]
        speeds = list(map(max, map(abs, other.V), map(abs, other.omega)))
        for name in (*SPEEDS, *PATHS):
            found = getattr(other, name)
            sizes = speeds if name in SPEEDS else accumulate(map(abs, found), max)
            worst += [abs(a - b) / size for a, b, size in zip(getattr(one, name), found, sizes) if size > 0]
        return max(map(float, worst))


def free_rows(rows: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """One row an output: inputs, values, onset (NaN: none), and the difference of the two motions."""
    case, _ = free_motion(rows)
    fine, apart = rolled_twice(case)
    onset = math.nan if fine.onset_time is None else float(fine.onset_time)
    found = {"motion": int(rows[0]["motion"]), "onset_time": onset, "switches": len(fine.switches), "difference": apart}
    return [row | found | {name: float(getattr(fine, name)[i]) for name in OUTPUTS} for i, row in enumerate(rows)]


def driven_row(row: dict[str, Any]) -> dict[str, Any]:
    """What a motion is and what it does, as the nearest doubles."""
    fine, apart = rolled_twice(driven_motion(row))
    found = {name: [float(value) for value in getattr(fine, name)] for name in (*SPEEDS, *PATHS)}
    switches = [[float(when), regime] for when, regime in fine.switches]
    return row | found | {"difference": apart, "switches": switches, "reversals": [float(t) for t in fine.reversals]}


def values(folder: Path, count: int | None) -> None:
    rows = [value_row(row) for row in tqdm(stage.read_rows(VALUES)[:count], "states", leave=False)]
    stage.write_rows(folder / VALUES.name, rows)


def motions(folder: Path, count: int | None) -> None:
    old = [list(rows) for _, rows in groupby(stage.read_rows(FREE), itemgetter("motion"))]
    rows = [row for rows in tqdm(old[:count], "motions", leave=False) for row in free_rows(rows)]
    stage.write_rows(folder / FREE.name, rows)


def driven(folder: Path, count: int | None) -> None:
    content = json.loads(DRIVEN.read_text(encoding="utf-8"))
    content["motions"] = [driven_row(row) for row in tqdm(content["motions"][:count], "driven motions", leave=False)]
    write_text(folder / DRIVEN.name, json.dumps(content, indent=1) + "\n")


FILES = {"values": values, "motions": motions, "driven": driven}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("files", nargs="*", metavar="FILE", help=f"out of {', '.join(FILES)}; default: all")
    parser.add_argument("--count", type=int)
    parser.add_argument("-o", "--output", type=Path, default=FOLDER)
    arguments = parser.parse_args()

    def made() -> None:
        for name in arguments.files or FILES:
            FILES[name](stage.make_folder(arguments.output), arguments.count)

    return stage.told("reference", made)


if __name__ == "__main__":
    sys.exit(main())
