"""Covers of finite thickness against boundary elements, of data/reference/check_elements.json.

The law of a cover takes Q from its own contact, as :class:`viscoroll.Cover` says; the elements
solve the stick zone without that, and without coupling.  Compared are states at one share of the
way from free rolling to full slip.  The bound of the difference is the error that ``validity``
states.
"""

from __future__ import annotations

from typing import Any

import numpy as np

import viscoroll as vr
from viscoroll.contact_mechanics.validity import stated_error

from ..truth.reference import read_elements
from .claim import Found, Proof, at

_KAPPA = 10.0
_MU = 0.5
#: Friction, and creepage of full slip, far above all others.
_MUCH = 1e3
_FAR = 1e6


def placed(truth: dict[str, Any]) -> tuple[vr.Scene, Any, str]:
    """Return the scene of a state of the file, its contact in free rolling, and where it is, in
    words.

    truth: series, cover, V, half lengths, and what the elements find.
    """
    cover = vr.Cover(vr.Prony(**truth["series"]), **truth["cover"])
    scene = vr.Scene(material=cover, kappa=_KAPPA, mu=_MU, coupled=False)
    free = vr.contact(scene, truth["V"], delta=0.0, fields="delta_0").delta_0
    fields = ("lam", "epsilon", "M", "delta_star", "delta_0", "delta_minus", "delta_plus")
    return (
        scene,
        vr.contact(scene, truth["V"], delta=free, fields=fields),
        at(V=truth["V"], eta=truth["eta"]) + f", {cover!r}",
    )


def states(_: np.random.Generator, count: int) -> Found:
    """Yield errors of lam, epsilon, M, delta_star and Q.

    count: how many states of the file, the first ones.
    """
    for truth in read_elements("covers")[:count]:
        (scene, state, where) = placed(truth)
        V = truth["V"]
        z = truth["z"]
        # the onsets of the law lie unlike far from free rolling, those without coupling do not
        shift = 0.5 * (state.delta_plus + state.delta_minus) - state.delta_0
        share = _MU * V * truth["d"] / state.delta_star
        delta = state.delta_0 + state.delta_star * share + shift * min(share**2, 1.0)
        Q = vr.contact(scene, V, delta=delta, fields="Q").Q
        yield (
            where,
            {
                # of a contact of the elements' half length, which is the law's when it was solved
                "lam": abs(state.lam / z * np.sqrt(truth["H"]) - 1.0),
                "epsilon": abs(truth["g"] / z - state.epsilon),
                "M": abs(V * truth["m"] / state.M - 1.0),
                "delta_star": abs(_MU * V * truth["star"] / state.delta_star - 1.0),
                "Q": abs(Q / _MU - truth["Q"]) / stated_error(truth["cover"]["thickness"]),
            },
        )


def free_creep(_: np.random.Generator, count: int) -> Found:
    """Yield errors of delta_0 and delta_0* where nu = 1/2: all strain by the pressure comes of the
    finite thickness.

    count: how many states of the file, the first ones.
    """
    for truth in read_elements("free_creep")[:count]:
        (scene, state, where) = placed(truth)
        V = truth["V"]
        # in full slip, with so much friction that the law does not limit delta_0* - delta_0
        forth, back = (
            vr.contact(scene.replace(mu=_MUCH), V, delta=each).M_half_space
            for each in (_FAR, -_FAR)
        )
        yield (
            where,
            {
                "free": abs(V * truth["free"] / state.delta_0 - 1.0),
                "mirrored": abs(V * truth["mirrored"] / (0.5 * (back - forth) / _MUCH) - 1.0),
            },
        )


_BOUND = 2e-6
PROOFS = [
    Proof(
        "covers",
        "cover_states",
        "one and three modes, against rigid and elastic bodies, ν 0 to 0.5, h/l0 0.2 to 20, κV "
        "0.05 to 4",
        {
            "lam": ("λ of a cover against boundary elements, relative", _BOUND),
            "epsilon": ("ε of a cover against boundary elements", _BOUND),
            "M": ("M of a cover against boundary elements, relative", _BOUND),
            "delta_star": ("δ* of a cover against boundary elements, relative", _BOUND),
            "Q": (
                "Q of a cover against the solution without coupling, divided by the error that "
                "validity states",
                1.0,
            ),
        },
        states,
    ),
    Proof(
        "covers",
        "cover_states",
        "one and three modes, ν = 0.5, h/l0 0.2 to 20, κV 0.05 to 4",
        {
            "free": (
                "δ0 of a cover, free rolling with stick, against boundary elements, relative",
                _BOUND,
            ),
            "mirrored": (
                "δ0* of a cover, the mirrored strain, against boundary elements, relative",
                _BOUND,
            ),
        },
        free_creep,
        "free creep",
    ),
]
