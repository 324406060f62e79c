"""The assumptions of the law of a layer of finite thickness, and its stated errors: :func:`assess_cover`,
:func:`assess_traction`.

l0 is the contact length at rest that the same bodies would have as half-spaces.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ..contact_table import evaluate_contact
from ..parameters import Parameters
from .assumptions import Assumption
from .free_rolling import ContactLengths

#: Poisson's ratios at which the largest half contact length is known, dimensionless.
_NU = (0.0, 0.3, 0.45, 0.5)
#: Half contact length divided by the thickness, at those Poisson's ratios, up to which one stick zone in front with
#: slip behind is right at all creepages; beyond it the front slips too near full slip.
_MOST_THETA = (3.0, 2.0, 1.5, 1.25)
#: Thicknesses divided by l0 at which the error of Q is known, dimensionless.
_THICKNESS = (0.2, 0.3, 0.5, 1.0, 2.0, 5.0)
#: Largest error of Q divided by mu P at those thicknesses, compared with the exact solution without coupling, for every
#: nu, material, speed and creepage (held by ``pipeline/evidence/prove/cover.py``).
_ERROR = (0.064, 0.058, 0.046, 0.029, 0.018, 0.011)
#: Error of Q divided by mu P, divided by |delta_0|/delta_star, by which shear acts back on the pressure more than the
#: law has it: of coupled boundary elements at seven scenes 0.29 where the assumption ``traction`` holds, 0.36 else.
_SHEAR_ERROR = 0.3
#: The same of kappa M, dimensionless.
_SHEAR_ERROR_OF_M = 0.01
#: Creepage far above any delta_star, for full slip.
_FULL_SLIP = 1e6


def stated_error(thickness: float) -> float:
    """Return the largest error of Q divided by mu P, compared with the exact solution without coupling.

    thickness: thickness of the layer divided by l0, > 0.
    Returns the error, dimensionless, interpolated between the thicknesses 0.2 to 5 at which it was measured; the value
    of the nearest end outside of them.
    """
    return float(np.interp(thickness, _THICKNESS, _ERROR))


def assess_cover(scene: Parameters, V: Any) -> tuple[ContactLengths, Assumption]:
    """Return the lengths of the contact on a cover, and the assumption ``thick``.

    scene: dimensionless parameters of a roller with a cover, or with an array of covers; material and kappa are used.
    V: speeds, dimensionless, any sign, an array of any shape; broadcasts with the scene.
    Returns (:class:`ContactLengths`: reach over R, epsilon, lam; the assumption, whose value is half the contact length
    divided by the thickness of the thinner layer; it holds where that of each layer is at most the limit for its
    Poisson's ratio, from 3 at nu = 0 to 1.25 at nu = 1/2, up to which one stick zone in front with slip behind is right
    at every creepage).  Both have the broadcast shape.  The sentence states the errors of the thinnest cover, and the
    limit for the cover whose limit is lowest.
    Raises ParameterError for kappa |V| above 1e300, shapes that do not broadcast, and a layer too thin for its law.
    """
    cover = scene.cover
    assert cover is not None
    state = evaluate_contact(scene, np.abs(V), np.zeros(()), False, ("lam", "epsilon"))
    half, thickness = 0.5 * state["lam"], float(np.min(cover.thinnest))
    layers = [(nu, h) for _, nu, h in map(cover.body, ("cylinder", "base")) if h is not None]
    limits = [np.interp(nu, _NU, _MOST_THETA) for nu, _ in layers]
    holds = np.all([half / h <= limit for (_, h), limit in zip(layers, limits, strict=True)], axis=0)
    theta = half / cover.thinnest
    sentence = (
        f"h/l0 = {thickness:.3g}: half the contact length is up to {float(np.max(theta, initial=0.0)):.2g} times the "
        f"thickness; up to {np.min(np.concatenate([*map(np.ravel, limits)])):.3g} times is allowed, where the contact "
        f"sticks in front and slips behind; the error of Q is up to {100.0 * stated_error(thickness):.1f} % of mu P"
    )
    return ContactLengths.of(state["lam"], state["epsilon"], scene.kappa), Assumption(holds, theta, sentence)


def assess_traction(scene: Parameters, V: Any) -> Assumption:
    """Return the assumption ``traction`` of a cover: shear acts back on the pressure as the law has it.

    With delta_0* the mean strain mirrored about the middle of the contact (docs/theory_covers.md), it holds where
    |delta_0* - delta_0| is at most delta_star/2; beyond, both ends of the contact slip.

    scene: dimensionless parameters of a roller with a cover, or with an array of covers.
    V: speeds, dimensionless, any sign, an array of any shape; broadcasts with the scene.
    Returns the assumption, whose value is 2 |delta_0* - delta_0|/delta_star, in the broadcast shape.
    Raises ParameterError as :func:`assess_cover`.
    """
    names = ("delta_0", "delta_star", "M_half_space", "M_cylinder")
    forth, back = (
        evaluate_contact(scene, np.abs(V), np.full((), slip), False, names) for slip in (_FULL_SLIP, -_FULL_SLIP)
    )
    change = {name: 0.5 * (back[name] - forth[name]) / scene.mu for name in names[2:]}
    free, star = forth["delta_0"], forth["delta_star"]
    # the law limits the excess x in units of delta_star/2 to x/(1 + x^4)^(1/4)
    excess = change["M_half_space"] + (1.0 + free) * change["M_cylinder"] - free
    limited = np.minimum(2.0 * np.abs(excess) / star, 1.0)
    with np.errstate(divide="ignore"):
        value = limited / (1.0 - limited**4) ** 0.25
    part = float(np.max(np.abs(free) / star, initial=0.0))
    sentence = (
        f"shear acts back on the pressure: delta_0 is up to {part:.2g} delta_star, and the error of Q some "
        f"{100.0 * _SHEAR_ERROR * part:.2g} % of mu P, that of M {_SHEAR_ERROR_OF_M * part:.1g} P l0; "
        f"both ends slip where this value, up to {float(np.max(value, initial=0.0)):.2g}, is above 1: "
        "use method='coupled' there"
    )
    return Assumption(value <= 1.0, value, sentence)
