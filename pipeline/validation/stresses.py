"""The closures of the stresses, Eqs. (11)-(13): their integrals are load, Q and M of Eqs. (15),
(16).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from viscoroll.contact_mechanics.contact import contact
from viscoroll.contact_mechanics.stress import stress
from viscoroll.rollers import Scene
from viscoroll.tables.law_dataset import Check

from .states import random_states

#: Roundings of the quadrature's 312 terms; 1.3e-14 seen over 200 states.
ALLOWED = 1e-13
_PANELS = 26
_NODES = 12


def panels(low: float, high: float) -> tuple[NDArray, NDArray]:
    """Nodes and weights for square roots at both ends: the angle, in panels that halve toward the
    ends.
    """
    halving = 0.5 * np.pi * 0.5 ** np.arange(_PANELS // 2)
    edges = np.concatenate([[0.0], halving[::-1], np.pi - halving[1:], [np.pi]])
    node, weight = np.polynomial.legendre.leggauss(_NODES)
    width = np.diff(edges)[:, None]
    angle = (edges[:-1, None] + 0.5 * width * (1.0 + node)).ravel()
    half = 0.5 * (high - low)
    return low + 2.0 * half * np.sin(0.5 * angle) ** 2, (
        0.5 * width * weight
    ).ravel() * half * np.sin(angle)


def closures(scene: Scene, V: float, delta: float) -> dict[str, float]:
    """Int p dx, Int tau dx and Int x p dx less load, Q and M, over the load (x in l0: its moment
    arm is l0).
    """
    c = contact(scene, V, delta=delta)
    # for V < 0 the contact is mirrored: "front" is the edge ahead of the axis
    ahead = -1.0 if V < 0.0 else 1.0
    rear = 0.5 * c.lam * (c.epsilon - 1.0)
    front = 0.5 * c.lam * (c.epsilon + 1.0)
    stick = front - c.lam * c.beta
    load = 1.0 / (32.0 * scene.kappa)
    x, weight = panels(rear, front)
    p = stress(scene, ahead * x, V, delta=delta).p
    shear = 0.0
    for low, high in ((rear, stick), (stick, front)):
        at, share = panels(low, high)
        shear += share @ stress(scene, ahead * at, V, delta=delta).tau
    return {
        "load": float(weight @ p / load - 1.0),
        "Q": float(shear / load - c.Q),
        "M": float(weight @ (ahead * x * p) / load - scene.kappa * c.M),
    }


def stress_checks(count: int, seed: int) -> list[Check]:
    """The closures at ``count`` random states."""
    scene, V, delta = random_states(count, seed)
    found = [
        closures(Scene(scene.alpha[i], scene.kappa[i], scene.mu[i]), float(V[i]), float(delta[i]))
        for i in range(count)
    ]
    meaning = {"load": "Int p dx = P", "Q": "Int tau dx = Q", "M": "Int x p dx = M"}
    return [
        # np.max: the max of Python may lose a NaN
        Check(
            f"stress: {name}",
            float(np.max([abs(one[name]) for one in found])),
            ALLOWED,
            f"divided by the load; {text}, {count} states",
        )
        for name, text in meaning.items()
    ]
