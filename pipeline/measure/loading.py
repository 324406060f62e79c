"""Check values for the examples of docs/loading, and the errors of the ways to read the atlas described there.

    python -m pipeline.measure.loading [--config FILE] [--folder FOLDER] [--results FOLDER] [-o FOLDER]

Writes check_atlas.csv and check_paper.csv into docs/loading, loading.json into data/results (all kept in git).  A check
value is the double nearest to a certified enclosure; beside it stands what a program may be off by: the error of
interpolation, from paper.nc as that file states it, from the atlas as measured here at random states.
"""

from __future__ import annotations

import json
import math
import runpy
import sys
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import msgspec
import numpy as np

import viscoroll as vr
from viscoroll import tables
from viscoroll.files import write_text
from viscoroll.reference.enclosures import INPUTS, contact_enclosure
from viscoroll.tables.grid import s_of_u, u_of_s

from .. import stage
from ..results import machine

LOADING = stage.ROOT / "docs/loading"
FIELDS = ("beta", "Q", "M")
State = tuple[float, float, float, float, float]

#: the code that readers copy is the code that is measured
example = SimpleNamespace(**runpy.run_path(str(LOADING / "read_tables_h5py.py")))


class Loading(msgspec.Struct, forbid_unknown_fields=True):
    """[loading]: states (alpha, kappa, mu, V, delta) to check, and a random sample to measure at."""

    atlas: list[State]
    paper: list[State]
    points: int
    seed: int


def spline_steps(table: Any, alpha: Any, kappa: Any, mu: Any, V: Any, delta: Any) -> dict[str, Any]:
    """The steps of docs/loading/README.md with tensor cubic splines, where 0 < |delta| < delta_star."""
    look_up, kappa_V = tables.Interpolant(table), kappa * np.abs(V)
    plane = look_up(("kappa_delta_star_over_mu", "kappa_M"), alpha=alpha, kappa_V=kappa_V)
    delta_star = mu / kappa * plane.kappa_delta_star_over_mu
    s = np.minimum(np.abs(delta) / delta_star, 1.0)
    volume = look_up(("beta", "Q_over_mu"), alpha=alpha, kappa_V=kappa_V, s=s)
    return {
        "kappa_V": kappa_V, **plane.as_dict(), "delta_star": delta_star, "s": s, "u": u_of_s(s), **volume.as_dict(),
        "Q": np.sign(delta * V) * mu * volume.Q_over_mu, "M": np.sign(V) * plane.kappa_M / kappa,
    }  # fmt: skip


def atlas_errors(table: Any, settings: Loading) -> dict[str, dict[str, float]]:
    """Largest errors of each way to interpolate, over random states with mu = kappa = 1: M is kappa M, Q is Q/mu."""
    random, one = np.random.default_rng(settings.seed), np.ones(settings.points)
    alpha, V = (
        np.exp(random.uniform(*np.log(table[name].values[[0, -1]]), settings.points)) for name in ("alpha", "kappa_V")
    )
    scene = vr.Scene(alpha, 1.0, 1.0)
    delta = s_of_u(random.random(settings.points)) * vr.contact(scene, V, delta=0.0, fields="delta_star").delta_star
    exact = vr.contact(scene, V, delta=delta, fields=FIELDS)
    arrays = {str(name): variable.values for name, variable in table.variables.items()}
    steps = spline_steps(table, alpha, one, one, V, delta)
    found = {
        "spline": tuple(steps[name] for name in FIELDS),
        "six_points": example.from_atlas(arrays, alpha, one, one, V, delta),
    }
    return {
        way: {
            name: float(np.abs(values - getattr(exact, name)).max()) for name, values in zip(FIELDS, found, strict=True)
        }
        for way, found in found.items()
    }


def rounded_up(value: float) -> float:
    """Two digits, never less: the same on machines that round differently."""
    scale = 10.0 ** (math.floor(math.log10(value)) - 1)
    return float(f"{math.ceil(value / scale) * scale:.1e}")


def check_row(state: State, allowed: tuple[float, ...]) -> dict[str, float]:
    exact = contact_enclosure(*state)
    row = dict(zip(INPUTS, state, strict=True)) | {name: float(exact[name]) for name in FIELDS}
    return row | {f"allowed_{name}": rounded_up(value) for name, value in zip(FIELDS, allowed, strict=True)}


def work(settings: Loading, source: Path, folder: Path, results: Path) -> stage.Outcome:
    atlas, paper = (tables.load(source / f"{name}.nc") for name in ("atlas", "paper"))
    errors = atlas_errors(atlas, settings)
    beta, Q, M = (max(found[name] for found in errors.values()) for name in FIELDS)
    stated = tuple(paper[name].attrs["interpolation_error"] for name in FIELDS)
    folder, results = stage.make_folder(folder), stage.make_folder(results)
    files = [folder / "check_atlas.csv", folder / "check_paper.csv", results / "loading.json"]
    stage.write_rows(files[0], [check_row(state, (beta, state[2] * Q, M / state[1])) for state in settings.atlas])
    stage.write_rows(files[1], [check_row(state, stated) for state in settings.paper])
    steps = {name: float(value) for name, value in spline_steps(atlas, *settings.atlas[0]).items()}
    record = {"points": settings.points, "errors": errors, "state": settings.atlas[0], "steps": steps}
    record["machine"] = machine()
    write_text(files[2], json.dumps(record, indent=1) + "\n")
    headline = {f"{way}: {name}": error for way, found in errors.items() for name, error in found.items()}
    return stage.Outcome(files, headline)


if __name__ == "__main__":
    folders = {"tables": stage.ROOT / "data/tables", "folder": LOADING, "results": stage.ROOT / "data/results"}
    sys.exit(stage.run("loading", Loading, work, __doc__, **folders))
