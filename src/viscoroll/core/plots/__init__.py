"""Figures of results: :func:`draw` of any dataset that a result or a file holds."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..errors import ParameterError

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure


def draw(data: xr.Dataset) -> Figure:
    """The figure of a result: a motion, an ensemble or its summary, a run or its Sobol indices, equilibria, stresses,
    contact states, a table.

    Raises
    ------
    ParameterError
        A dataset that is none of these, or holds a single state.
    """
    from . import many, motion, sensitivity, states

    has = set(data.dims)
    if "quantile" in has or {"motion", "t"} <= has:
        return many.distributions(data)
    if "input" in has:
        return sensitivity.sobol_bars(data)
    if "t" in has and "regime" in data:
        return motion.one(data)
    if "equilibrium" in has:
        return states.equilibria(data)
    if {"p", "tau"} <= set(data) and "x" in data:
        return states.stresses(data)
    if states.axes_of(data):
        return states.over_axes(data)
    found = ", ".join(f"{name}: {size}" for name, size in data.sizes.items()) or "a single state"
    sentence = f"there is nothing to draw over: the result holds {found}; compute it at several speeds or creeps"
    raise ParameterError("plot", found, "a result over an axis", sentence)
