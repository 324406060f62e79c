"""What the law of a layer of finite thickness assumes, and what it leaves out: :func:`layer`."""

from __future__ import annotations

from typing import Any

import numpy as np

from .assumptions import Assumption
from .contact import evaluate_contact
from .free_rolling import Strained
from .parameters import Parameters

#: Poisson's ratios, and half length over thickness up to which one stick zone in front and slip behind holds at all
#: creeps; beyond, near full slip, the front slips too
_NU, _MOST_THETA = (0.0, 0.3, 0.45, 0.5), (3.0, 2.0, 1.5, 1.25)
#: thickness over l0, and by how much of mu Q is off at most beside the exact solution without coupling, of any nu,
#: material, speed and creep (held by ``pipeline/evidence/prove/cover.py``)
_THICKNESS, _ERROR = (0.2, 0.3, 0.5, 1.0, 2.0, 5.0), (0.064, 0.058, 0.046, 0.029, 0.018, 0.011)
#: likewise what shear acting back on the pressure does to Q at nu = 1/2 and mu = 1/2, beside the shift by delta_0
_COUPLED_THICKNESS, _COUPLED = (0.3, 0.5, 1.0, 2.0), (0.13, 0.08, 0.03, 0.006)


def stated_error(thickness: float) -> float:
    """How far Q may be off beside the exact solution without coupling, over mu P, at a thickness over l0."""
    return float(np.interp(thickness, _THICKNESS, _ERROR))


def layer(scene: Parameters, V: Any) -> tuple[Strained, Assumption]:
    """Lengths of the contact on a cover, and the assumption ``thick`` of :class:`.assumptions.Validity`.

    Parameters
    ----------
    scene : with a cover.  V : speeds, dimensionless.

    Returns
    -------
    (Strained, Assumption)
        The value of the assumption is half the length of the contact over the thickness.  It holds where one stick zone
        in front and slip behind are right at every creep.
    """
    cover = scene.cover
    assert cover is not None
    found = evaluate_contact(scene, np.abs(V), np.zeros(()), False, ("lam", "epsilon"))
    lam, epsilon = found["lam"], found["epsilon"]
    theta = 0.5 * lam / cover.thickness
    most, thickness = float(np.interp(cover.nu, _NU, _MOST_THETA)), float(np.min(cover.thickness))
    error, coupled = stated_error(thickness), np.interp(thickness, _COUPLED_THICKNESS, _COUPLED)
    sentence = (
        f"h/l0 = {thickness:.3g}, half the contact is up to {float(np.max(theta, initial=0.0)):.2g} thicknesses long; "
        f"up to {most:.3g} it sticks in front and slips behind; Q is off by up to {100.0 * error:.1f} % of mu P, and "
        f"where nu is near 1/2 and mu = 0.5 by {100.0 * coupled:.1f} % more by what shear does to the pressure"
    )
    strained = Strained(lam * (1.0 + epsilon) / (2.0 * scene.kappa), epsilon, lam)
    return strained, Assumption(theta <= most, theta, sentence)
