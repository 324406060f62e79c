"""The assumptions of the law of a layer of finite thickness, and its stated errors: :func:`assess_cover`.

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
#: Thicknesses divided by l0 at which the effect of coupling is known, dimensionless.
_COUPLED_THICKNESS = (0.3, 0.5, 1.0, 2.0)
#: Change of Q divided by mu P at those thicknesses by the pressure that shear causes, at nu = 1/2 and mu = 1/2, beside
#: the shift of the creepage by delta_0 (same proof).
_COUPLED = (0.13, 0.08, 0.03, 0.006)


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
    divided by the thickness; it holds where that is at most the limit for Poisson's ratio of the layer, from 3 at nu =
    0 to 1.25 at nu = 1/2, up to which one stick zone in front with slip behind is right at every creepage).  Both have
    the broadcast shape.  The sentence states the errors of the thinnest cover, and the limit for the cover whose limit
    is lowest.
    Raises ParameterError for kappa |V| above 1e300, shapes that do not broadcast, and a layer too thin for its law.
    """
    cover = scene.cover
    assert cover is not None
    state = evaluate_contact(scene, np.abs(V), np.zeros(()), False, ("lam", "epsilon"))
    theta = 0.5 * state["lam"] / cover.thickness
    most, thickness = np.interp(cover.nu, _NU, _MOST_THETA), float(np.min(cover.thickness))
    error, coupled = stated_error(thickness), np.interp(thickness, _COUPLED_THICKNESS, _COUPLED)
    sentence = (
        f"h/l0 = {thickness:.3g}: half the contact length is up to {float(np.max(theta, initial=0.0)):.2g} times the "
        f"thickness; up to {np.min(most):.3g} times is allowed, where the contact sticks in front and slips behind; "
        f"the error of Q is up to {100.0 * error:.1f} % of mu P; with nu near 1/2 a further "
        f"{100.0 * coupled:.1f} % at mu = 0.5, more at a smaller mu, as the pressure that shear causes is neglected"
    )
    return ContactLengths.of(state["lam"], state["epsilon"], scene.kappa), Assumption(theta <= most, theta, sentence)
