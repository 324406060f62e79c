"""The summaries of a run: quantile bands over time, and histograms."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .style import labelled, new_figure, quantile_bands, with_unit

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

_BARS = 80
#: what a plot can tell apart, and how far it reaches
_FINEST, _FARTHEST = 1e-280, 1e300


def run_distributions(summaries: xr.Dataset) -> Figure:
    """A row a quantity: quantile bands over t if there are several times, and the histogram at the last.

    Parameters
    ----------
    summaries : of ``viscoroll.io.runs.open_summaries``.
    """
    names = [str(name).removesuffix("_histogram") for name in summaries if str(name).endswith("_histogram")]
    title = f"{summaries.attrs['motions']} motions, {summaries.attrs['design']}, seed {summaries.attrs['seed']}"
    figure, rows = new_figure(title, len(names), 2, (9.6, 2.8 * len(names)), squeeze=False)
    for name, (left, right) in zip(names, rows, strict=True):
        if summaries[f"{name}_mean"].size > 1:
            _bands(left, summaries, name)
        else:
            _levels(left, summaries, name)
        _bars(right, summaries, name)
        for axes in (left, right):
            axes.locator_params(nbins=6)
            axes.ticklabel_format(style="sci", scilimits=(-2, 5))
    return figure


def _label(summaries: xr.Dataset, name: str) -> str:
    return labelled(name, summaries[f"{name}_mean"].attrs["units"])


def _bands(axes: Any, summaries: xr.Dataset, name: str) -> None:
    """Quantiles over time, pairs of them as bands, a middle one as a line."""
    t = summaries["t"].values
    quantile_bands(axes, t, summaries["quantile"].values, summaries[f"{name}_quantiles"].values)
    axes.set(xlabel=labelled("t", summaries["t"].attrs["units"]), ylabel=_label(summaries, name), xlim=(t[0], t[-1]))


def _levels(axes: Any, summaries: xr.Dataset, name: str) -> None:
    """The quantiles of a quantity that has one value a motion."""
    values = summaries[f"{name}_quantiles"].values.ravel()
    axes.plot(values, summaries["quantile"].values, "o-", color="black")
    axes.set(xlabel=_label(summaries, name), ylabel="share of motions below", ylim=(0.0, 1.0))


def _bars(axes: Any, summaries: xr.Dataset, name: str) -> None:
    """The counts at the last time, gathered into even bars over all but a thousandth at each end."""
    counts = summaries[f"{name}_histogram"].values
    counts = counts[:, -1] if counts.ndim == 2 else counts
    low, high = summaries[f"{name}_bin_low"].values, summaries[f"{name}_bin_high"].values
    t = summaries["t"]
    at = with_unit(f", at t = {t.values[-1]:g}", t.attrs["units"]) if summaries[f"{name}_mean"].ndim else ""
    axes.set(xlabel=_label(summaries, name) + at, ylabel=f"motions, of {counts.sum()}")
    if not counts.any():
        axes.set_title("no values", fontsize="small")
        return
    edges, bars = even_bars(low, high, counts)
    axes.stairs(bars, edges, fill=True, color="0.6")
    outside = int(counts.sum() - round(bars.sum()))
    if outside:
        axes.set_title(f"{outside} more beyond the ends", fontsize="small")


def even_bars(low: NDArray, high: NDArray, counts: NDArray) -> tuple[NDArray, NDArray]:
    """(edges, counts) of even bars: a bin that lies in several is shared out by its width.

    One bar where all lie too close together for a plot, as at rest.
    """
    reached = np.cumsum(counts) / max(counts.sum(), 1)
    first, last = np.searchsorted(reached, [1e-3, 1.0 - 1e-3])
    last = min(last, counts.size - 1)
    start, end = np.clip([low[first], high[last]], -_FARTHEST, _FARTHEST)
    if end - start < _FINEST:
        return start + max(1.0, abs(start)) * np.array([-0.5, 0.5]), counts[first : last + 1].sum(keepdims=True)
    edges = np.linspace(start, end, _BARS + 1)
    ends = np.unique(np.concatenate([low, high]))
    below = np.zeros(ends.size)
    below[np.searchsorted(ends, high)] = np.cumsum(counts)
    below = np.maximum.accumulate(below)
    return edges, np.diff(np.interp(edges, ends, below))
