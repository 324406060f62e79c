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
    from . import ensembles, states

    has = {*data.dims, *data}
    kinds = (
        ("quantile" in has or {"motion", "t"} <= set(data.dims), ensembles.distributions),
        ("input" in data.dims, ensembles.sobol_bars),
        ({"t", "regime"} <= {*has, *data.coords}, states.motion),
        ("equilibrium" in data.dims, states.equilibria),
        ({"p", "tau", "x"} <= {*has, *data.coords}, states.stresses),
        (bool(states.varied_axes(data)), states.field_curves),
    )
    for holds, figure in kinds:
        if holds:
            return figure(data)
    found = ", ".join(f"{name}: {size}" for name, size in data.sizes.items()) or "a single state"
    sentence = f"there is nothing to draw over: the result holds {found}; compute it at several speeds or creeps"
    raise ParameterError("plot", found, "a result over an axis", sentence)
