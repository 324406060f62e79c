"""The law of a cover beside the coupled solution -> data/results/covers.json (kept in git).

    python -m pipeline.evidence.measure.covers [--config FILE] [--quick] [-o FILE]

Of each scene at one speed, at creepages from beyond one onset of full slip to beyond the other;
[covers] of the configuration says how many.  pipeline/evidence/document/ puts the errors into
docs/validity_covers.md.
"""

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np

import viscoroll as vr
from viscoroll.contact_mechanics.coupled_pair import CoupledRow, pair_of_scene

from ...stage import Row, read_toml
from ..results import run

KAPPA = 10.0
#: Creepages go so far from the middle of the onsets, over half their distance.
_REACH = 1.1
MATERIALS = {
    "elastic": vr.Prony.elastic(),
    "one": vr.Prony([10.0], [1.0 / 11.0]),
    "three": vr.Prony([2.0, 6.0, 3.0], [1.0, 0.1, 0.003]),
}
#: Layers, and nips of two bodies that deform.
SCENES = read_toml(Path(__file__).with_suffix(".toml"))


class Compared(NamedTuple):
    """Errors of the law of one scene, the largest over creepage; moments are kappa M, creepages 2
    kappa delta.

    kM, Q, epsilon, lam : of kappa M, Q over mu P, epsilon, and lam, relative.
    free : of delta_0, divided by delta_star/mu; free_part : of delta_0, divided by delta_star.
    loss : least loss of a body or in slip, times 2 kappa/(mu V P).
    efficiency : largest power that the state hands on, over what it is given.
    value : of ``validity(V).traction``.
    """

    kM: float
    Q: float
    epsilon: float
    lam: float
    free: float
    free_part: float
    loss: float
    efficiency: float
    value: float


def scenes() -> list[tuple[str, vr.Scene, float]]:
    """Return names, scenes and speeds kappa |V|."""
    found = []
    for name, nu, h, u, mu, on in SCENES["layers"]:
        cover = vr.Cover(MATERIALS[name], nu=nu, thickness=h, on=on)
        found.append((f"{name}, {on}", cover, mu, u))
    for (name, nu, h), (other, other_nu, other_h), part, u, mu in SCENES["nips"]:
        own = {"nu": nu, "thickness": h, "part": part}
        theirs = {"other_nu": other_nu, "other_thickness": other_h or None}
        nip = vr.Cover(MATERIALS[name], on="base", other=MATERIALS[other], **own, **theirs)
        found.append((f"{name}, {other}", nip, mu, u))
    return [
        (name, vr.Scene(material=cover, kappa=KAPPA, mu=mu, coupled=False), u)
        for name, cover, mu, u in found
    ]


def energy(scene: vr.Scene, V: float, state) -> tuple[float, float]:
    """Return (least loss, times 2 kappa/(mu V P); largest efficiency) of states of the law at one
    speed.
    """
    free = vr.contact(scene, V, delta=float(state.delta_0[0]))
    spin = 1.0 + state.delta
    slip = (
        state.delta * state.Q
        + state.M_half_space
        - free.M_half_space
        + spin * (state.M_cylinder - free.M_cylinder)
    )
    least = min(slip.min(), free.M_half_space, (spin * free.M_cylinder).min())
    powers = np.stack([state.M_half_space - state.Q, spin * (state.Q + state.M_cylinder)])
    output, given = (np.maximum(signed, 0.0).sum(axis=0) for signed in (-powers, powers))
    rolls = given > 0.0
    return 2.0 * KAPPA / scene.mu * least, (output[rolls] / given[rolls]).max()


def compared(scene: vr.Scene, u: float, creeps: int) -> Compared:
    """Return the errors of a scene at kappa |V| = u, over so many creepages."""
    mu = float(scene.mu)
    row = CoupledRow(pair_of_scene(scene), u, mu)
    low, high = row.onsets()
    creep = 0.5 * (low + high) + _REACH * 0.5 * (high - low) * np.linspace(-1.0, 1.0, creeps)
    true = row.states(creep)
    if true.status.any():
        raise vr.ConvergenceError(f"the coupled solution of {scene}")
    V = u / KAPPA
    found = vr.contact(scene, V, delta=0.5 * creep / KAPPA)
    free = abs(2.0 * KAPPA * found.delta_0[0] - row.free_creep())
    least, efficiency = energy(scene, V, found)
    return Compared(
        kM=abs(KAPPA * found.M - true.kM_base - true.kM_cylinder).max(),
        Q=abs(found.Q / mu - true.Q_over_mu).max(),
        epsilon=abs(found.epsilon - true.epsilon).max(),
        lam=abs(found.lam / true.lam - 1.0).max(),
        free=0.5 * mu * free / KAPPA / found.delta_star[0],
        free_part=0.5 * free / KAPPA / found.delta_star[0],
        loss=least,
        efficiency=efficiency,
        value=scene.validity(V).traction.value,
    )


def summaries(rows: list[Row]) -> Iterator[Row]:
    """Yield, of each group of scenes, how many there are, and median and worst of every error."""
    groups = {
        "one layer": [row for row in rows if row["value"] <= 1.0 and not row["nip"]],
        "one layer, both ends slip": [row for row in rows if row["value"] > 1.0],
        "two bodies that deform": [row for row in rows if row["value"] <= 1.0 and row["nip"]],
    }
    for group, own in groups.items():
        if not own:
            continue
        found = {"group": group, "count": len(own)}
        for name in Compared._fields:
            values = [row[name] for row in own]
            worst = min(values) if name == "loss" else max(values)
            found[name] = {"median": np.median(values), "worst": worst}
        yield found


def measure(sizes):
    """Return a row for each scene, and their summaries."""
    rows = []
    for name, scene, u in scenes()[: sizes["scenes"]]:
        cover = scene.material
        nip = cover.part < 1.0
        key = {
            "name": name,
            "nip": nip,
            "nu": cover.nu,
            "h": cover.thickness,
            "u": u,
            "mu": float(scene.mu),
        }
        rows.append(key | compared(scene, u, sizes["creeps"])._asdict())
    return {"sizes": sizes, "rows": rows, "summaries": [*summaries(rows)]}


if __name__ == "__main__":
    sys.exit(run("covers", measure, __doc__))
