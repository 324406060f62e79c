"""The ends of what the package takes: every pair of extreme alpha, kappa V, mu and creep -> out/corners.csv.

    python -m pipeline.validate --corners [--config FILE] [-o FOLDER]

The law is held against enclosures in ball arithmetic (pipeline/evidence/truth), motions against their own energy:
what friction and rolling take must be what V and omega have lost.  One row a quantity: worst, allowed, where; exit
code 1 where one is exceeded.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product
from pathlib import Path
from typing import Any

import msgspec
import numpy as np

import viscoroll as vr

from . import stage
from .evidence.truth import contact_enclosure

#: over what an error counts: the value itself, or a size that the inputs give
SCALES = {"lam": "lam", "epsilon": "1", "delta_star": "delta_star", "beta": "1", "Q": "mu", "M": "M"}


class Corners(msgspec.Struct, forbid_unknown_fields=True):
    """[corners]: the extremes; creep over that of full slip; what each field and an energy may be off by."""

    alpha: list[float]
    kappa: list[float]
    mu: list[float]
    kappa_V: list[float]
    s: list[float]
    allowed: dict[str, float]
    gamma: list[float]
    j: list[float]
    starts: list[tuple[float, float]]
    rtol: list[float]


def of_states(given: Corners) -> Iterator[tuple[str, float, str]]:
    """(Field, its error over its scale, where) of every state."""
    for alpha, kappa, mu, u in product(given.alpha, given.kappa, given.mu, given.kappa_V):
        scene, V = vr.Scene(alpha=alpha, kappa=kappa, mu=mu), u / kappa
        creep = np.array(given.s) * vr.contact(scene, V, delta=0.0, fields="delta_star").delta_star
        found = vr.contact(scene, V, delta=creep, fields=tuple(SCALES))
        for n, delta in enumerate(creep.tolist()):
            exact = contact_enclosure(alpha, kappa, mu, V, delta, 80)
            for name, scale in SCALES.items():
                value = float(np.broadcast_to(getattr(found, name), creep.shape)[n])
                size = {"1": max(1.0, abs(float(exact[name]))), "mu": mu}.get(scale, abs(float(exact[name])))
                off = abs(float(exact[name] - value))
                error = 0.0 if off == 0.0 else off / size if size else np.inf
                yield name, error, f"alpha {alpha:g}, kappa {kappa:g}, mu {mu:g}, V {V:g}, delta {delta:g}"


def of_motions(given: Corners) -> Iterator[tuple[str, float, str]]:
    """(Name, imbalance of energy over the tolerance, where) of every motion; infinite where one does not end well."""
    numbers = product(given.alpha, given.kappa, given.mu, given.gamma, given.j, given.starts, given.rtol)
    for alpha, kappa, mu, gamma, j, (V0, omega0), rtol in numbers:
        scene = vr.Scene(alpha=alpha, kappa=kappa, mu=mu, gamma=gamma, j=j)
        fields = ("V", "omega", "slip_loss", "rolling_loss")
        t = np.geomspace(1e-3, 10.0, 5) * max(abs(V0), abs(omega0)) / (gamma * mu)
        found = vr.ensemble(scene, [V0], [omega0], t, rtol=rtol, fields=fields)
        energy = 0.5 * (V0 * V0 + j * omega0 * omega0)
        left = 0.5 * (found.V**2 + j * found.omega**2) + found.slip_loss + found.rolling_loss
        error = float(np.max(np.abs(left - energy)) / energy / rtol) if found.status[0] <= 1 else np.inf
        where = f"alpha {alpha:g}, kappa {kappa:g}, mu {mu:g}, gamma {gamma:g}, j {j:g}, from ({V0:g}, {omega0:g})"
        yield "energy of motions, over rtol", error, f"{where}, rtol {rtol:g}, {found.messages()}"


def work(settings: Corners, out: Path) -> stage.Outcome:
    worst: dict[str, tuple[float, str]] = {}
    counts: dict[str, int] = {}
    for name, error, where in (*of_states(settings), *of_motions(settings)):
        counts[name] = counts.get(name, 0) + 1
        if not error <= worst.get(name, (-1.0, ""))[0]:
            worst[name] = error, where
    rows: list[dict[str, Any]] = [
        {"quantity": name, "corners": counts[name], "worst": error, "allowed": settings.allowed[name], "where": where}
        for name, (error, where) in worst.items()
    ]
    stage.write_rows(out / "corners.csv", rows)
    headline = {f"{row['quantity']} (allowed {row['allowed']:g}), {row['where']}": row["worst"] for row in rows}
    return stage.Outcome([out / "corners.csv"], headline, any(not row["worst"] <= row["allowed"] for row in rows))
