"""Reference values to test any implementation against -> data/reference/check_values.csv and .nc (kept in git).

    python -m pipeline.evidence.truth.check_values [--config FILE] [--folder FOLDER] [-o FOLDER]

Contact states over the whole domain of the law and along its edges, each value the double nearest to a
certified enclosure (pipeline.evidence.truth.contact_enclosure), and the condition numbers of the values:
the relative error that one of 1 in each input makes.  Motions: pipeline/evidence/truth/check_motions.py.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import xarray as xr
from flint import arb
from tqdm import tqdm

from viscoroll.files import write_dataset

from ... import stage
from ..results import SIZES
from .enclosures import INPUTS, condition_numbers, contact_enclosure

FIELDS = ("lam", "zeta", "epsilon", "delta_star", "beta", "Q", "M")
CONDITIONED = ("epsilon", "delta_star", "beta", "Q", "M")
#: alphas at the end of the domain and next to it
EDGE_ALPHAS = (1.0, float(np.nextafter(1.0, 2.0)), 1.0 + 1e-15, 1.0 + 1e-8, 1.0001, 1e6)


class CheckValues(msgspec.Struct, forbid_unknown_fields=True):
    """[check_values]: how many contact states, and the seed."""

    states: int
    seed: int


def chosen_alpha(rng: np.random.Generator) -> float:
    """At an edge, one time in four; else log-uniform in [1, 1e6]."""
    return float(rng.choice(EDGE_ALPHAS)) if rng.random() < 0.25 else float(10.0 ** rng.uniform(0.0, 6.0))


def chosen_creep(rng: np.random.Generator, delta_star: Any) -> float:
    """s = delta/delta_star log-uniform toward 0 and toward 1, at 0, at 1e-300 and 1e-16, and within an ULP of 1."""
    nearest = float(delta_star)
    at_limit = (np.nextafter(nearest, 0.0), nearest, np.nextafter(nearest, np.inf), 1.5 * nearest)
    near_limit = float(delta_star * (1 - arb(10) ** -16))
    edges = (*at_limit, near_limit, 1e-300 * nearest, 1e-16 * nearest, 0.0)
    kinds = (
        float(rng.choice(edges)),
        float(10.0 ** rng.uniform(-20.0, 0.0)) * nearest,
        (1.0 - float(10.0 ** rng.uniform(-15.0, 0.0))) * nearest,
        float(rng.random()) * nearest,
    )
    return kinds[rng.integers(len(kinds))]


def chosen_state(rng: np.random.Generator, alpha: float | None = None) -> tuple[float, float, float, float, float]:
    """(alpha, kappa, mu, V, delta): kappa, mu in [1e-6, 1e6], kappa V in [1e-300, 1e300], half of it in [1e-8, 1e8]."""
    alpha = chosen_alpha(rng) if alpha is None else alpha
    kappa, mu = (float(10.0 ** rng.uniform(-6.0, 6.0)) for _ in range(2))
    most = 300.0 if rng.random() < 0.5 else 8.0
    V = float(10.0 ** rng.uniform(-most, most)) / kappa
    delta_star = contact_enclosure(alpha, kappa, mu, V, 0.0)["delta_star"]
    sign_V, sign_delta = rng.choice([-1.0, 1.0], 2)
    return alpha, kappa, mu, float(sign_V) * V, float(sign_delta) * chosen_creep(rng, delta_star)


def check_row(state: tuple[float, ...]) -> dict[str, float]:
    """Inputs, values and condition numbers of one state."""
    values = contact_enclosure(*state)
    given = {name: arb(abs(value)) for name, value in zip(INPUTS, state, strict=True)}
    conditions = condition_numbers(given)
    row: dict[str, float] = dict(zip(INPUTS, state, strict=True))
    row |= {"full_slip": int(values["full_slip"])} | {name: float(values[name]) for name in FIELDS}
    return row | {f"condition_{name}": float(f"{conditions[name]:.2e}") for name in CONDITIONED}


def as_dataset(rows: list[dict[str, float]]) -> xr.Dataset:
    columns = {name: ("state", np.array([row[name] for row in rows])) for name in rows[0]}
    return xr.Dataset(
        columns,
        attrs={
            "title": "Contact of a viscoelastic cylinder rolling with partial slip: check values",
            "source": "certified enclosures in ball arithmetic, Eqs. (6), (8)-(10), (15)-(18)",
            "comment": "values: the double nearest to the exact one; condition_NAME: sum of |d ln NAME/d ln input|",
        },
    )


def work(settings: CheckValues, folder: Path) -> stage.Outcome:
    rng = np.random.default_rng(settings.seed)
    rows = [check_row(chosen_state(rng)) for _ in tqdm(range(settings.states), desc="states", delay=1.0, leave=False)]
    folder = stage.make_folder(folder)
    files = [folder / "check_values.csv", folder / "check_values.nc"]
    stage.write_rows(files[0], rows)
    write_dataset(as_dataset(rows), files[1])
    return stage.Outcome(files, {"contact states": len(rows)})


if __name__ == "__main__":
    sys.exit(stage.run("check_values", CheckValues, work, __doc__, config=SIZES, folder=stage.ROOT / "data/reference"))
