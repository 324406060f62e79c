"""Sobol indices as bars."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .style import THIN, labelled, new_figure, with_unit

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

_COLUMNS = 3
_WIDTH = 0.38
_BARS = {"S1": ("first-order", "0.35", -0.5), "ST": ("total", "0.8", 0.5)}
_STARTS = {"V0": "$V_0$", "omega0": r"$\omega_0$"}


def sobol_bars(indices: xr.Dataset) -> Figure:
    """First-order and total index of every input with its confidence interval, a panel a quantity.

    Parameters
    ----------
    indices : of ``viscoroll.io.runs.sensitivity.sobol_indices``, or read from its netCDF file; quantities over t are
        shown at the last t at which they have indices.  Inputs stand in one order, the largest total index first.
    """
    names = [str(name).removesuffix("_S1") for name in indices if str(name).endswith("_S1")]
    shown = [_at_last_time(indices, name) for name in names]
    order = np.argsort(-np.max([values["ST"] for _, values in shown], axis=0), kind="stable")
    inputs = indices["input"].values[order]
    columns = min(_COLUMNS, len(shown))
    rows = -(-len(shown) // columns)
    percent = f"{indices.attrs['confidence']:.0%}".replace("%", " %")
    title = f"Sobol indices of {indices.attrs['motions']} motions, with intervals of {percent}"
    size = (max(6.4, 3.2 * columns), 0.6 + 2.6 * rows)
    figure, grid = new_figure(title, rows, columns, size, squeeze=False, sharey=True)
    for axes, (text, values) in zip(grid.flat, shown):
        _panel(axes, [_STARTS.get(name) or labelled(name) for name in inputs], values, order)
        axes.set_title(text, fontsize="small")
    for axes in grid.flat[len(shown) :]:
        axes.set_axis_off()
    for axes in grid[:, 0]:
        axes.set_ylabel("share of the variance")
    grid[0, 0].legend(frameon=False, fontsize="small")
    return figure


def _at_last_time(indices: xr.Dataset, name: str) -> tuple[str, dict[str, NDArray]]:
    """(title of a panel, its indices over input)."""
    keys = [*_BARS, *(f"{key}_conf" for key in _BARS)]
    values = {key: indices[f"{name}_{key}"].values for key in keys}
    if values["S1"].ndim == 1:
        return labelled(name), values
    last = np.flatnonzero(np.isfinite(values["S1"][:, 0]))[-1]
    t = indices["t"]
    time = with_unit(f"{labelled('t')} = {t.values[last]:g}", t.attrs["units"])
    return f"{labelled(name)} at {time}", {key: v[last] for key, v in values.items()}


def _panel(axes: Any, inputs: list[str], values: dict[str, NDArray], order: NDArray) -> None:
    at = np.arange(len(inputs))
    for key, (text, grey, side) in _BARS.items():
        axes.bar(
            at + side * _WIDTH, values[key][order], _WIDTH, yerr=values[f"{key}_conf"][order], label=text, color=grey,
            edgecolor="black", linewidth=0.5, capsize=2.5, error_kw={"linewidth": 0.9},
        )  # fmt: skip
    axes.axhline(0.0, **THIN)
    axes.set_xticks(at, inputs)
