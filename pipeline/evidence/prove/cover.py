"""Covers of finite thickness against boundary elements (:mod:`..truth.cover`), which share the elements' half-space.

The law of a cover takes Q from its own contact, as :class:`viscoroll.Cover` says; the elements solve the stick zone
without that, and without coupling.  How far both lie apart is held against what ``validity`` states.
"""

from __future__ import annotations

import numpy as np

import viscoroll as vr
from viscoroll.contact_law.validity.cover import stated_error

from ..truth.cover import extrapolated
from .claim import Found, Proof, at

MATERIALS = (vr.Prony([10.0], [1.0 / 11.0]), vr.Prony([2.0, 6.0, 3.0], [1.0, 0.1, 0.003]))
_KAPPA, _MU = 10.0, 0.5
#: thickness over l0, kappa V, and the share of the stick zone
_THICKNESS, _SPEEDS, _STICK = (0.2, 20.0), (0.05, 4.0), (0.1, 0.9)


def states(random: np.random.Generator, count: int) -> Found:
    """Both materials in turn, the other numbers at random, thickness and speed in their logarithms."""
    for n in range(count):
        thickness, u = (float(np.exp(random.uniform(*np.log(ends)))) for ends in (_THICKNESS, _SPEEDS))
        nu, share, on = (
            float(random.uniform(0.0, 0.5)),
            float(random.uniform(*_STICK)),
            ("base", "cylinder")[n // 2 % 2],
        )
        p, part = MATERIALS[n % 2], 1.0 if n % 3 else float(random.uniform(0.2, 1.0))
        cover = vr.Cover(p, nu=nu, thickness=thickness, on=on, part=part)
        scene = vr.Scene(material=cover, kappa=_KAPPA, mu=_MU)
        V = u / _KAPPA
        state = vr.contact(scene, V, delta=0.0)
        z = 0.5 * state.lam / u
        truth = extrapolated(p, nu, z, 0.5 * state.lam / thickness, share * z, part)
        delta = state.delta_0 + _MU * V * truth.d
        Q = vr.contact(scene, V, delta=delta, fields="Q").Q
        errors = {
            "lam": abs(2.0 * u * np.sqrt(truth.H) - 1.0),
            "epsilon": abs(truth.g / z - state.epsilon),
            "M": abs(V * truth.m / state.M - 1.0),
            "delta_star": abs(_MU * V * truth.star / state.delta_star - 1.0),
            "Q": abs(Q / _MU - truth.Q) / stated_error(thickness),
        }
        yield at(nu=nu, thickness=thickness, kappa_V=u, share=share, part=part) + f", {p!r} on the {on}", errors


def free_creep(random: np.random.Generator, count: int) -> Found:
    """delta_0 where nu = 1/2: then all strain by the pressure comes of the finite thickness."""
    for n in range(count):
        thickness, u = (float(np.exp(random.uniform(*np.log(ends)))) for ends in (_THICKNESS, _SPEEDS))
        cover = vr.Cover(MATERIALS[n % 2], nu=0.5, thickness=thickness, on="base")
        scene = vr.Scene(material=cover, kappa=_KAPPA, mu=_MU)
        state = vr.contact(scene, u / _KAPPA, delta=0.0)
        z = 0.5 * state.lam / u
        truth = extrapolated(cover.layer, 0.5, z, 0.5 * state.lam / thickness, 0.5 * z)
        yield at(thickness=thickness, kappa_V=u), {"": abs(u / _KAPPA * truth.strain / state.delta_0 - 1.0)}


_BOUND = 2e-6
PROOFS = [
    Proof(
        "covers", "cover_states",
        "one and three modes, against rigid and elastic bodies, ν 0 to 0.5, h/l0 0.2 to 20, κV 0.05 to 4",
        {
            "lam": ("λ of a cover against boundary elements, relative", _BOUND),
            "epsilon": ("ε of a cover against boundary elements", _BOUND),
            "M": ("M of a cover against boundary elements, relative", _BOUND),
            "delta_star": ("δ* of a cover against boundary elements, relative", _BOUND),
            "Q": ("Q of a cover against the solution without coupling, over the error that validity states", 1.0),
        },
        states,
    ),
    Proof(
        "covers", "cover_states", "one and three modes, ν = 0.5, h/l0 0.2 to 20, κV 0.05 to 4",
        {"": ("δ0 of a cover against boundary elements, relative", _BOUND)},
        free_creep, "free creep",
    ),
]  # fmt: skip
