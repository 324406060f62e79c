"""The ends of what the package takes: every pair of extreme alpha, kappa V, mu and creep ->
out/corners.csv.

    python -m pipeline.validate --corners [--config FILE] [-o FOLDER]

The law is held against enclosures in ball arithmetic (pipeline/evidence/truth.py), motions against
their own energy: what friction and rolling take must be what V and omega have lost.  One row a
quantity: worst, allowed, where; exit code 1 where one is exceeded.
"""

from itertools import chain, product

import msgspec
import numpy as np

import viscoroll as vr

from . import stage
from .evidence.prove.cases import Proof
from .evidence.truth import contact_enclosure
from .validation import FIELDS


class Corners(msgspec.Struct, forbid_unknown_fields=True):
    """[corners]: the extremes; creep over that of full slip; what each field and an energy may be
    off by.
    """

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


def of_states(given):
    """Errors of every state: of epsilon over 1 where it is less, of beta over 1, of Q over mu, else
    relative.
    """
    for alpha, kappa, mu, u in product(given.alpha, given.kappa, given.mu, given.kappa_V):
        scene = vr.Scene(alpha=alpha, kappa=kappa, mu=mu)
        V = u / kappa
        creep = np.array(given.s) * vr.contact(scene, V, delta=0.0, fields="delta_star").delta_star
        found = vr.contact(scene, V, delta=creep, fields=FIELDS).as_dict()
        for n, delta in enumerate(creep.tolist()):
            exact = contact_enclosure(alpha, kappa, mu, V, delta, 80)
            sizes = {name: max(abs(float(exact[name])), 5e-324) for name in FIELDS}
            sizes |= {"epsilon": max(1.0, sizes["epsilon"]), "beta": 1.0, "Q": mu}
            values = {name: float(np.broadcast_to(found[name], creep.shape)[n]) for name in FIELDS}
            errors = {name: abs(float(exact[name] - values[name])) / sizes[name] for name in FIELDS}
            yield f"alpha {alpha:g}, kappa {kappa:g}, mu {mu:g}, V {V:g}, delta {delta:g}", errors


def of_motions(given):
    """Imbalance of energy over the tolerance of every motion; infinite where one does not end
    well.
    """
    numbers = product(
        given.alpha, given.kappa, given.mu, given.gamma, given.j, given.starts, given.rtol
    )
    for alpha, kappa, mu, gamma, j, (V0, omega0), rtol in numbers:
        scene = vr.Scene(alpha=alpha, kappa=kappa, mu=mu, gamma=gamma, j=j)
        fields = ("V", "omega", "slip_loss", "rolling_loss")
        t = np.geomspace(1e-3, 10.0, 5) * max(abs(V0), abs(omega0)) / (gamma * mu)
        found = vr.ensemble(scene, [V0], [omega0], t, rtol=rtol, fields=fields)
        energy = 0.5 * (V0 * V0 + j * omega0 * omega0)
        left = 0.5 * (found.V**2 + j * found.omega**2) + found.slip_loss + found.rolling_loss
        error = np.max(np.abs(left - energy)) / energy / rtol if found.status[0] <= 1 else np.inf
        where = (
            f"alpha {alpha:g}, kappa {kappa:g}, mu {mu:g}, gamma {gamma:g}, j {j:g}, from "
            f"({V0:g}, {omega0:g})"
        )
        yield f"{where}, rtol {rtol:g}, {found.messages()}", {"energy of motions, over rtol": error}


def work(settings, out):
    claims = {name: (name, allowed) for name, allowed in settings.allowed.items()}
    proof = Proof(
        "corners", "", "", claims, lambda *_: chain(of_states(settings), of_motions(settings))
    )
    titles = {
        "quantity": "claim",
        "corners": "points",
        "worst": "worst",
        "allowed": "bound",
        "where": "where",
    }
    rows = [{title: row[name] for title, name in titles.items()} for row in proof.rows(0, None)]
    stage.write_rows(out / "corners.csv", rows)
    headline = {
        f"{row['quantity']} (allowed {row['allowed']:g}), {row['where']}": row["worst"]
        for row in rows
    }
    return stage.Outcome(
        [out / "corners.csv"], headline, any(row["worst"] > row["allowed"] for row in rows)
    )
