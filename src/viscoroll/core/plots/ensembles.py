"""Figures of many motions: quantiles of each quantity and how it lies at the end, and Sobol indices as bars."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .style import THIN, variable_label, axis_label, new_figure, new_panels, quantile_bands, with_unit

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

_DRAWN, _LEVELS = ("V", "omega", "x", "angle"), (0.05, 0.25, 0.5, 0.75, 0.95)
#: bars of a run; a histogram of motions needs some of these
_BARS, _FEWEST = 80, 8
#: fraction of the motions in one bar above which a histogram has a logarithmic axis of counts
_ONE_BAR = 0.9
#: what a plot can tell apart, and how far it reaches
_FINEST, _FARTHEST = 1e-280, 1e300
#: of Sobol indices: width of a bar; which, in words, its grey and its side; symbols of starts
_WIDTH = 0.38
_SOBOL = {"S1": ("first-order", "0.35", -0.5), "ST": ("total", "0.8", 0.5)}
_STARTS = {"V0": "$V_0$", "omega0": r"$\omega_0$"}


def distributions(data: xr.Dataset) -> Figure:
    """A row a quantity: quantiles over t if there are several times, and the histogram at the last.

    ``data`` : an ensemble, its summary, which has no histograms, or the summaries of a run.
    """
    each, about = "motion" in data.dims, data.attrs
    if each:
        names = [name for name in _DRAWN if name in data and data[name].ndim == 2]
    else:
        names = [str(name).removesuffix("_quantiles") for name in data if str(name).endswith("_quantiles")]
    drawn_by = f", {about['design']}, seed {about['seed']}" if "design" in about else ""
    columns = 2 if each or any(f"{name}_histogram" in data for name in names) else 1
    count, rows = data.sizes["motion"] if each else about["motions"], max(len(names), 1)
    size = 3.2 + 3.2 * columns, 2.8 * rows
    figure, boxes = new_figure(f"{count:,} motions{drawn_by}", rows, columns, size, squeeze=False)
    for name, (left, *right) in zip(names, boxes, strict=False):
        found = data[name if each else f"{name}_quantiles"]
        text, over_t = axis_label(name, found.attrs["units"], found.attrs.get("symbol", "")), "t" in found.dims
        levels = np.array(_LEVELS) if each else data["quantile"].values
        values = _quantiles(found.values) if each else found.values
        if over_t and data.sizes["t"] > 1:
            quantile_bands(left, t := data["t"].values, levels, values)
            left.set(xlabel=variable_label(data["t"]), ylabel=text, xlim=(t[0], t[-1]))
        else:
            left.plot(values.ravel(), levels, "o-", color="black")
            left.set(xlabel=text, ylabel="fraction of motions below", ylim=(0.0, 1.0))
        for box in right:
            box.set_xlabel(f"{text} at the end" if over_t else text)
            if each:
                _bars_of_each(box, found.values[:, -1])
            else:
                _bars(box, data, name)
        for box in (left, *right):
            box.locator_params(nbins=6, axis="x" if box.get_yscale() == "log" else "both")
            box.ticklabel_format(style="sci", scilimits=(-2, 5), axis="x" if box.get_yscale() == "log" else "both")
    return figure


def _quantiles(values: NDArray) -> NDArray:
    """Of those that reached each time."""
    reached, found = np.isfinite(values).any(axis=0), np.full((len(_LEVELS), values.shape[1]), np.nan)
    found[:, reached] = np.nanquantile(values[:, reached], _LEVELS, axis=0)
    return found


def _bars_of_each(box: Any, values: NDArray) -> None:
    """Of motions; of few, or where all lie together, a dot each."""
    found = values[np.isfinite(values)]
    box.set_ylabel(f"motions, of {values.size}")
    if found.size >= _FEWEST and np.ptp(found) > 1e-12 * np.abs(found).max():
        counts, _, _ = box.hist(found, bins=40, color="0.6")
        if counts.max() > _ONE_BAR * found.size:  # most motions are at rest: the others would not be visible
            box.set_yscale("log")
    else:
        box.plot(found, np.arange(1, found.size + 1), "o", color="black")


def _bars(box: Any, data: xr.Dataset, name: str) -> None:
    """The counts at the last time, gathered into even bars over all but a thousandth at each end."""
    counts = data[f"{name}_histogram"].values
    counts = counts[:, -1] if counts.ndim == 2 else counts
    box.set_ylabel(f"motions, of {counts.sum()}")
    if not counts.any():
        box.set_title("no values", fontsize="small")
        return
    edges, bars = _even_bars(data[f"{name}_bin_low"].values, data[f"{name}_bin_high"].values, counts)
    box.stairs(bars, edges, fill=True, color="0.6")
    if outside := int(counts.sum() - round(bars.sum())):
        box.set_title(f"{outside} more beyond the ends", fontsize="small")


def _even_bars(low: NDArray, high: NDArray, counts: NDArray) -> tuple[NDArray, NDArray]:
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
    below = np.append(0, np.repeat(np.cumsum(counts), 2))[:-1]
    return edges, np.diff(np.interp(edges, np.ravel([low, high], "F"), below))


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
    inputs = [_STARTS.get(name) or axis_label(name) for name in indices["input"].values[order]]
    percent = f"{indices.attrs['confidence']:.0%}".replace("%", " %")
    title = f"Sobol indices of {indices.attrs['motions']} motions, with intervals of {percent}"
    figure, boxes = new_panels(title, len(shown), 3, (3.2, 2.6), sharey=True)
    for box, (text, values) in zip(boxes, shown, strict=True):
        for key, (which, grey, side) in _SOBOL.items():
            box.bar(
                np.arange(order.size) + side * _WIDTH, values[key][order], _WIDTH, yerr=values[f"{key}_conf"][order],
                label=which, color=grey, edgecolor="black", linewidth=0.5, capsize=2.5, error_kw={"linewidth": 0.9},
            )  # fmt: skip
        box.axhline(0.0, **THIN)
        box.set_xticks(np.arange(order.size), inputs)
        box.set_title(text, fontsize="small")
    boxes[0].set_ylabel("Sobol index")
    boxes[0].legend(frameon=False, fontsize="small")
    return figure


def _at_last_time(indices: xr.Dataset, name: str) -> tuple[str, dict[str, NDArray]]:
    """(title of a panel, its indices over input)."""
    values = {key: indices[f"{name}_{key}"].values for each in _SOBOL for key in (each, f"{each}_conf")}
    if values["S1"].ndim == 1:
        return axis_label(name), values
    last = np.flatnonzero(np.isfinite(values["S1"][:, 0]))[-1]
    t = indices["t"]
    time = with_unit(f"{axis_label('t')} = {t.values[last]:g}", t.attrs["units"])
    return f"{axis_label(name)} at {time}", {key: v[last] for key, v in values.items()}
