"""Nodes of the axes of a grid: in equal steps or ratios, and of creep, dense where full slip begins."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from ...core.array_types import Floats
from ...core.checks import check_array, check_choice, check_integer, check_number
from ...core.errors import ParameterError
from ...cylinder import Cylinder
from ...scene import Scene

#: Most nodes of a grid: 400 MB a field, more than any look-up block reads.
MAX_NODES = 50_000_000
#: Of the nodes of creep this part lies in equal steps, the rest as densely as delta_star does: of 0.3 to 1 the least
#: error of Q and beta in the grid of the paper.
_EVEN_PART = 0.5
#: Largest creep over the largest delta_star: some nodes beyond, so that the ends of the spline are flat.
_BEYOND = 1.1
#: Places at which the density of delta_star is summed up; more move no node by a thousandth of a step.
_PLACES = 20_001


def spread(low: float, high: float, count: int, spacing: Literal["linear", "log"] = "linear") -> Floats:
    """``count`` values from ``low`` to ``high``, both exact, in equal steps or equal ratios.

    Raises
    ------
    ParameterError
        An unknown spacing, low >= high, high - low beyond the doubles, count < 2, or "log" with low <= 0.
    """
    check_choice("spacing", spacing, "linear", "log")
    low = check_number("low", low, low=0.0 if spacing == "log" else -np.inf, strict=True)
    high = check_number("high", high)
    if not high > low:
        raise ParameterError("high", high, f"> low = {low:g}")
    if high - low == np.inf:
        raise ParameterError("high", high, f"less than 1.8e308 above low = {low:g}")
    return (np.geomspace if spacing == "log" else np.linspace)(low, high, check_integer("count", count, 2, MAX_NODES))


def creep_nodes(what: Scene | Cylinder, V: ArrayLike, count: int, *, alpha: ArrayLike | None = None) -> Floats:
    """Nodes of creep for a grid, dense where full slip begins at some of its speeds: around +-delta_star(V, alpha).

    Parameters
    ----------
    what : a :class:`Scene` or a :class:`Cylinder` of single numbers, as of :func:`build`.
    V : speeds of the grid, > 0; in m/s of a Cylinder.
    count : of nodes, odd, at least 5.
    alpha : those of the grid, in place of that of a scene without a material.

    Returns
    -------
    array of shape (count,)
        Creep ratios, symmetric about 0, which is one of them.  Half of the nodes lie in equal steps, half as densely
        as the values of delta_star.  The ends lie beyond the largest delta_star, so the contact slips fully there.

    Raises
    ------
    ParameterError
        An even or small count; speeds or alphas out of range.

    Examples
    --------
    >>> import viscoroll as vr
    >>> scene = vr.presets.PAPER_SECTION_5
    >>> V = vr.tables.spread(1e-5, 4.0, 160, "log")
    >>> grid = vr.tables.build(scene, V, delta=vr.tables.creep_nodes(scene, V, 161))
    """
    if check_integer("count", count, 5, MAX_NODES) % 2 == 0:
        raise ParameterError("count", count, "odd: the nodes are symmetric about 0")
    at: Any = what if alpha is None else what.replace(alpha=increasing("alpha", alpha, low=1.0))
    speeds = increasing("V", V, low=0.0, strict=True)
    speeds = speeds if alpha is None else speeds[:, np.newaxis]
    star = np.sort(np.ravel(at.contact(speeds, delta=0.0, fields="delta_star").delta_star))
    places = np.linspace(0.0, _BEYOND * star[-1], _PLACES)
    below = np.searchsorted(star, places) / star.size
    share = _EVEN_PART * np.linspace(0.0, 1.0, _PLACES) + (1.0 - _EVEN_PART) * below
    half = np.interp(np.linspace(0.0, 1.0, count // 2 + 1), share, places)
    return np.concatenate([-half[:0:-1], half])


def increasing(name: str, nodes: Any, **bound: Any) -> Floats:
    """Nodes of an axis as a vector of its own; raises ParameterError where they are out of range or do not increase."""
    axis = np.atleast_1d(check_array(name, nodes, **bound)).copy()
    if axis.ndim != 1 or not axis.size or (np.diff(axis) <= 0.0).any():
        raise ParameterError(name, f"an array of shape {axis.shape}", "one-dimensional and strictly increasing")
    return axis
