"""From SI units to the dimensionless scene: Sect. 3.1 and Eq. (4)."""

from __future__ import annotations

from typing import Any

import numpy as np

from .scene import Scene


def contact_length(R: Any, load: Any, E_prime: Any) -> Any:
    """l0 of Sect. 3.1, m."""
    return np.sqrt(32.0 * R * load / E_prime)


def scene_of(R: Any, m: Any, load: Any, E_prime: Any, T_ref: Any, law: Any, mu: Any, j: Any) -> Scene:
    """The scene of a :class:`Cylinder`, or of many: numbers or arrays, unchecked.

    ``law`` : alpha, one or one each, or what a scene takes for its material, with times over ``T_ref``.
    """
    R, m, load, T = (np.asarray(value, np.float64)[()] for value in (R, m, load, T_ref))
    # what leaves the range of doubles becomes 0 or infinite, which Scene refuses by name
    with np.errstate(all="ignore"):
        kappa, gamma = R / contact_length(R, load, E_prime), load * T**2 / (m * R)
    of = "alpha" if isinstance(law, float | np.ndarray) else "material"
    return Scene(kappa=kappa, mu=mu, gamma=gamma, j=j, **{of: law})
