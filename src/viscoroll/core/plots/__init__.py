"""Figures of results: :func:`draw` of any dataset of a result or a file."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..errors import ParameterError

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure


def draw(data: xr.Dataset) -> Figure:
    """Draw a result, by the figure that its axes and variables call for.

    Parameters
    ----------
    data : dataset of the result, as of its ``to_xarray()``: a summary of an ensemble or of a run (axis
        "quantile"), Sobol indices ("input"), a motion ("t" and a variable "regime"), equilibria ("equilibrium"),
        stresses ("p", "tau" and "x"), else contact states or a table over at least one axis of several values.  A kind
        is recognised by the axes and names in brackets; the other variables of the kind must be there too.

    Returns
    -------
    matplotlib.figure.Figure
        The figure, not shown and not saved; the first of these kinds, in this order, that applies.

    Raises
    ------
    ParameterError
        If the dataset is none of these, or has a single state.
    KeyError
        If a variable or attribute that the figure needs is missing.
    ValueError
        If there is an axis "input", but no Sobol indices.
    """
    from . import ensembles, states

    names = {*data.dims, *data, *data.coords}
    kinds = (
        ("quantile" in names, ensembles.distributions),
        ("input" in data.dims, ensembles.sobol_bars),
        ({"t", "regime"} <= names, states.motion),
        ("equilibrium" in data.dims, states.equilibria),
        ({"p", "x"} <= names, states.stresses),
        (bool(states.varied_axes(data)), states.field_curves),
    )
    for applies, figure in kinds:
        if applies:
            return figure(data)
    found = ", ".join(f"{name}: {size}" for name, size in data.sizes.items()) or "a single state"
    sentence = f"a plot needs several speeds or creepages: the result contains {found}; compute it at more"
    raise ParameterError("plot", found, "a result over an axis", sentence)
