"""From SI units to the dimensionless scene: Sect. 3.1 and Eq. (4)."""

from __future__ import annotations

from typing import Any

import numpy as np

from .materials.pair import Pair, effective_modulus
from .materials.prony import Prony
from .scene import Scene


def contact_length(R: Any, load: Any, E_prime: Any) -> Any:
    """l0 of Sect. 3.1, m."""
    return np.sqrt(32.0 * R * load / E_prime)


def scene_from_si(
    R: Any, m: Any, E: Any, nu: Any, T_epsilon: Any, T_sigma: Any, mu: Any, j: Any, g: Any, plane: str, load: Any = None
) -> Scene:
    """The scene of a :class:`Cylinder`, or of many: its fields, unchecked, numbers or arrays."""
    T_epsilon, T_sigma = (np.asarray(value, np.float64)[()] for value in (T_epsilon, T_sigma))
    # what leaves the range of doubles becomes 0 or infinite, which Scene refuses by name
    with np.errstate(all="ignore"):
        alpha = T_epsilon / T_sigma
    return Scene(alpha, *_scaled(R, m, g, load, effective_modulus(E, nu, plane), T_epsilon, mu), j)


def scene_of_pair(R: Any, m: Any, pair: Pair, mu: Any, j: Any, g: Any, load: Any = None) -> Scene:
    """As :func:`scene_from_si`, of a pair of materials; times over its T_ref."""
    return scene_of_law(R, m, pair.E_prime, pair.T_ref, pair.law, mu, j, g, load)


def scene_of_law(
    R: Any, m: Any, E_prime: Any, T_ref: float, law: Any, mu: Any, j: Any, g: Any, load: Any = None
) -> Scene:
    """As :func:`scene_from_si`, of a series or bodies, or of one each, with E' of the pair; times over T_ref."""
    kappa, mu, gamma = _scaled(R, m, g, load, E_prime, np.float64(T_ref), mu)
    return Scene(kappa=kappa, mu=mu, gamma=gamma, j=j, material=law)


def scene_of_solids(
    R: Any, m: Any, E: Any, nu: Any, T_ref: float, times: tuple[Any, Any], mu: Any, j: Any, g: Any, plane: str,
    load: Any = None,
) -> Scene:  # fmt: skip
    """As :func:`scene_from_si`, of retardation and relaxation times (n,), a series each; times over T_ref."""
    slow, fast = np.broadcast_arrays(*(np.asarray(value, np.float64) for value in times))
    series = Prony.creep((1.0 - fast / slow)[:, np.newaxis], (slow / T_ref)[:, np.newaxis], alpha=slow / fast)
    return scene_of_law(R, m, effective_modulus(E, nu, plane), T_ref, series, mu, j, g, load)


def _scaled(R: Any, m: Any, g: Any, load: Any, E_prime: Any, T: Any, mu: Any) -> tuple[Any, Any, Any]:
    """(kappa, mu, gamma) of Sect. 3.1 and Eq. (4)."""
    R, m = (np.asarray(value, np.float64)[()] for value in (R, m))
    with np.errstate(all="ignore"):
        P = m * g if load is None else np.asarray(load, np.float64)[()]
        return R / contact_length(R, P, E_prime), mu, P * T**2 / (m * R)
