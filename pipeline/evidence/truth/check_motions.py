"""Motions in extended precision, to test any implementation against -> data/reference/check_motions.csv and .nc.

    python -m pipeline.evidence.truth.check_motions [--config FILE] [--folder FOLDER] [-o FOLDER]

The paper's IC1-IC3, one in which full slip returns, and random ones over the whole range, by
pipeline.evidence.truth.roll_precise.  Each is rolled twice, the second time with more nodes, shorter
steps and more digits; how far the two differ stands beside it.  Kept in git.
"""

from __future__ import annotations

import math
import sys
from pathlib import Path
from typing import Any

import flint
import msgspec
import numpy as np
import xarray as xr
from tqdm import tqdm

import viscoroll as vr
from viscoroll.files import write_dataset

from ... import stage
from ..results import SIZES
from .motion import PreciseMotion, roll_precise
from .random_motions import ChosenMotion, chosen_motion

PARAMETERS = ("alpha", "kappa", "mu", "gamma", "j")
OUTPUTS = ("V", "omega", "x", "angle")
#: the second of the two: what a step leaves out is about the power ``nodes`` of its length
FINER = {"tolerance": 1e-24, "nodes": 28, "bits": 200}
_BITS = 400


class CheckMotions(msgspec.Struct, forbid_unknown_fields=True):
    """[check_motions]: how many motions, and the seed of the random ones."""

    motions: int
    seed: int


def chosen(settings: CheckMotions) -> list[ChosenMotion]:
    """The motions of the file."""
    paper = vr.presets.PAPER_SECTION_5_ROUNDED
    returning = ChosenMotion(vr.Scene(alpha=11.0, kappa=2.91, mu=0.01, gamma=1.1e4, j=0.5), 1.0, 1.0, 4e-3)
    named = [*(ChosenMotion(paper, *start, 4e-3) for start in vr.presets.PAPER_STARTS.values()), returning]
    rng = np.random.default_rng(settings.seed)
    return [*named, *(chosen_motion(rng) for _ in range(settings.motions - len(named)))]


def difference(one: PreciseMotion, other: PreciseMotion) -> float:
    """Worst of V, omega (over the larger), x (over the longest way so far), and switch times, relative."""
    with flint.ctx.workprec(_BITS):
        if [regime for _, regime in one.switches] != [regime for _, regime in other.switches]:
            return math.inf
        worst = [abs(a / b - 1) for (a, _), (b, _) in zip(one.switches, other.switches, strict=True)]
        path = flint.arb(0)
        for i in range(len(one.t)):
            speed, path = max(abs(other.V[i]), abs(other.omega[i])), max(path, abs(other.x[i]))
            worst += [abs(getattr(one, name)[i] - getattr(other, name)[i]) / speed for name in ("V", "omega")]
            worst.append(abs(one.x[i] - other.x[i]) / path)
        return max(map(float, worst))


def check_rows(number: int, motion: ChosenMotion) -> list[dict[str, float]]:
    """One row an output: inputs, values, onset (NaN: none), and the difference of the two motions."""
    coarse = roll_precise(motion.scene, motion.V0, motion.omega0, motion.t.tolist())
    fine = roll_precise(motion.scene, motion.V0, motion.omega0, motion.t.tolist(), **FINER)
    onset = math.nan if fine.onset_time is None else float(fine.onset_time)
    shared: dict[str, float] = {"motion": number} | {name: float(getattr(motion.scene, name)) for name in PARAMETERS}
    shared |= {"V0": motion.V0, "omega0": motion.omega0, "onset_time": onset, "switches": len(fine.switches)}
    shared |= {"difference": float(f"{difference(coarse, fine):.1e}")}
    return [
        shared | {"t": when} | {name: float(getattr(fine, name)[i]) for name in OUTPUTS}
        for i, when in enumerate(fine.t)
    ]


def as_dataset(rows: list[dict[str, float]], motions: int) -> xr.Dataset:
    columns = {name: np.array([row[name] for row in rows]).reshape(motions, -1) for name in rows[0]}
    each = {name: ("motion", values[:, 0]) for name, values in columns.items() if name not in ("t", *OUTPUTS)}
    return xr.Dataset(
        each | {name: (("motion", "output"), columns[name]) for name in ("t", *OUTPUTS)},
        attrs={
            "title": "Motions of a viscoelastic cylinder rolling with partial slip: check values",
            "source": f"Eq. (22) by collocation in extended precision, python-flint {flint.__version__}",
            "comment": "values: the nearest doubles; difference: of two motions with other nodes, steps and digits, "
            "worst of V, omega over the larger of the two, x over the way, switch times",
        },
    )


def work(settings: CheckMotions, folder: Path) -> stage.Outcome:
    motions = chosen(settings)
    each: list[list[dict[str, Any]]] = [
        check_rows(number, motion)
        for number, motion in enumerate(tqdm(motions, desc="motions", delay=1.0, leave=False))
    ]
    rows = [row for some in each for row in some]
    folder = stage.make_folder(folder)
    files = [folder / "check_motions.csv", folder / "check_motions.nc"]
    stage.write_rows(files[0], rows)
    write_dataset(as_dataset(rows, len(motions)), files[1])
    return stage.Outcome(files, {"motions": len(motions), "largest difference": max(row["difference"] for row in rows)})


if __name__ == "__main__":
    sys.exit(
        stage.run("check_motions", CheckMotions, work, __doc__, config=SIZES, folder=stage.ROOT / "data/reference")
    )
