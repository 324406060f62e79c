"""Grids of the tables, and the coordinate maps of their splines, in pairs."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..checks import checked, number
from ..errors import ParameterError
from ..rolling_contact import refuse_overflow
from ..scene import HIGHEST_ALPHA, Scene

#: A not-a-knot cubic needs four nodes.
_MIN_NODES = 4
_MAX_NODES = 50_000_000


def s_of_u(u: ArrayLike) -> NDArray[np.float64]:
    """s = |delta|/delta_star in [0, 1] from u in [0, 1]: s = 1 - (1 - u)^2.

    Q has terms (1 - s)^2 log(1 - s) = (1 - u)^4 log(1 - u)^2: uniform steps in u resolve them.
    """
    u = np.asarray(u, dtype=np.float64)
    return u * (2.0 - u)


def u_of_s(s: ArrayLike) -> NDArray[np.float64]:
    """u in [0, 1] from s in [0, 1]: the inverse of :func:`s_of_u`, without cancellation at 0."""
    s = np.asarray(s, dtype=np.float64)
    return s / (1.0 + np.sqrt(1.0 - s))


def log_of_alpha(alpha: ArrayLike) -> NDArray[np.float64]:
    """Spline coordinate ln alpha of alpha >= 1."""
    return np.log(np.asarray(alpha, dtype=np.float64))


def alpha_of_log(log_alpha: ArrayLike) -> NDArray[np.float64]:
    """alpha from ln alpha; the inverse of :func:`log_of_alpha`."""
    return np.exp(np.asarray(log_alpha, dtype=np.float64))


def log_of_kappa_V(kappa_V: ArrayLike) -> NDArray[np.float64]:
    """Spline coordinate ln(kappa V) of kappa V > 0."""
    return np.log(np.asarray(kappa_V, dtype=np.float64))


def kappa_V_of_log(log_kappa_V: ArrayLike) -> NDArray[np.float64]:
    """kappa V from ln(kappa V); the inverse of :func:`log_of_kappa_V`."""
    return np.exp(np.asarray(log_kappa_V, dtype=np.float64))


#: Axis of the atlas -> (to the spline's coordinate, back again); order of the dimensions.
ATLAS_MAPS = {
    "alpha": (log_of_alpha, alpha_of_log),
    "kappa_V": (log_of_kappa_V, kappa_V_of_log),
    "s": (u_of_s, s_of_u),
}


def spread(low: float, high: float, count: int, spacing: Literal["linear", "log"] = "linear") -> NDArray[np.float64]:
    """``count`` values from ``low`` to ``high``, both exact, in equal steps or equal ratios.

    Raises
    ------
    ParameterError
        An unknown spacing, low >= high, high - low beyond the doubles, count < 2, or "log" with low <= 0.
    """
    if spacing not in ("linear", "log"):
        raise ParameterError("spacing", repr(spacing), "'linear' or 'log'")
    low = number("low", low, low=0.0 if spacing == "log" else -np.inf, strict=True)
    high = number("high", high)
    if not high > low:
        raise ParameterError("high", high, f"> low = {low:g}")
    if high - low == np.inf:
        raise ParameterError("high", high, f"less than 1.8e308 above low = {low:g}")
    if not isinstance(count, int) or not 2 <= count <= _MAX_NODES:
        raise ParameterError("count", count, f"an integer in [2, {_MAX_NODES}]")
    return (np.geomspace if spacing == "log" else np.linspace)(low, high, count)


def increasing(name: str, nodes: Any, **bound: Any) -> NDArray[np.float64]:
    """Nodes of an axis as a vector of its own; raises ParameterError where they are out of range or do not increase."""
    axis = np.atleast_1d(checked(name, nodes, **bound)).copy()
    if axis.ndim != 1 or not axis.size or (np.diff(axis) <= 0.0).any():
        raise ParameterError(name, f"an array of shape {axis.shape}", "one-dimensional and strictly increasing")
    return axis


def refuse_large(**axes: NDArray) -> None:
    """Raise ParameterError where a table would have too many nodes."""
    if math.prod(nodes.size for nodes in axes.values()) > _MAX_NODES:
        raise ParameterError(", ".join(axes), "their product", f"at most {_MAX_NODES} nodes in all")


@dataclass(frozen=True)
class AtlasGrid:
    """Axes of the universal table: alpha and kappa V in equal ratios, s = 1 - (1 - u)^2 with uniform u.

    Parameters
    ----------
    alpha : (lowest, highest) T_epsilon/T_sigma, >= 1.
    kappa_V : (lowest, highest) kappa V, > 0.
    nodes : number of nodes along alpha, kappa_V and s, at least 4 each.
    block : cells along alpha, kappa_V and s that share one entry of the error maps.
    allowed : (Q/mu, beta), the interpolation errors that the table is meant to keep; written
        into the file beside the measured ones.

    Raises
    ------
    ParameterError
        Where a value is out of range.
    """

    alpha: tuple[float, float] = (1.0, 100.0)
    kappa_V: tuple[float, float] = (1e-3, 1e3)
    nodes: tuple[int, int, int] = (48, 128, 128)
    block: tuple[int, int, int] = (4, 8, 8)
    allowed: tuple[float, float] = (1e-6, 5e-6)

    def __post_init__(self) -> None:
        for name, length in (("alpha", 2), ("kappa_V", 2), ("nodes", 3), ("block", 3), ("allowed", 2)):
            value = getattr(self, name)
            if not isinstance(value, Iterable) or len(tuple(value)) != length:
                raise ParameterError(name, f"{value!r:.60}", f"{length} numbers")
            object.__setattr__(self, name, tuple(value))
        checked("alpha", self.alpha, low=1.0, high=HIGHEST_ALPHA)
        checked("allowed", self.allowed, low=0.0, strict=True)
        if any(not isinstance(n, int) or n < _MIN_NODES for n in self.nodes) or np.prod(self.nodes) > _MAX_NODES:
            raise ParameterError("nodes", self.nodes, f"integers >= {_MIN_NODES}, at most {_MAX_NODES} nodes in all")
        if any(not isinstance(n, int) or n < 1 for n in self.block):
            raise ParameterError("block", self.block, "integers >= 1")
        self.axes()

    def axes(self) -> dict[str, NDArray[np.float64]]:
        """Nodes of alpha, kappa_V and s."""
        return {
            "alpha": spread(*self.alpha, self.nodes[0], "log"),
            "kappa_V": spread(*self.kappa_V, self.nodes[1], "log"),
            "s": s_of_u(np.linspace(0.0, 1.0, self.nodes[2])),
        }


@dataclass(frozen=True, eq=False)
class LiteralGrid:
    """Axes of a table over (V, delta, alpha) at one kappa and one mu.

    Parameters
    ----------
    kappa : R/l0, > 0.
    mu : coefficient of friction, > 0.
    V : speeds of the axis, > 0, strictly increasing; for V < 0 see the signs of Eqs. (17), (18).
    delta : creep ratios, any sign, strictly increasing.
    alpha : T_epsilon/T_sigma, >= 1, strictly increasing.

    Raises
    ------
    ParameterError
        Where a value is out of range, an axis does not increase, mu/kappa leaves the range of :class:`Scene`
        or kappa V exceeds 1e300.
    """

    kappa: float
    mu: float
    V: Any
    delta: Any
    alpha: Any

    def __post_init__(self) -> None:
        for name in ("kappa", "mu"):
            value = checked(name, getattr(self, name), low=0.0, strict=True)
            if value.ndim:
                raise ParameterError(name, value, "a single number: a table holds one kappa and one mu")
            object.__setattr__(self, name, float(value))
        bounds: dict[str, dict[str, Any]] = {
            "V": {"low": 0.0, "strict": True},
            "delta": {},
            "alpha": {"low": 1.0, "high": HIGHEST_ALPHA},
        }
        for name, bound in bounds.items():
            object.__setattr__(self, name, increasing(name, getattr(self, name), **bound))
        Scene(self.alpha, self.kappa, self.mu)
        refuse_overflow(np.asarray(self.kappa), self.V)
        refuse_large(**self.axes())

    def axes(self) -> dict[str, NDArray[np.float64]]:
        """Nodes of V, delta and alpha."""
        return {"V": self.V, "delta": self.delta, "alpha": self.alpha}
