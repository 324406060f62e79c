"""Figures of many motions: quantiles and final distribution of each quantity, and Sobol indices as bars."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .style import (
    axis_label,
    new_figure,
    new_panels,
    quantile_bands,
    small_legend,
    variable_label,
    with_unit,
    zero_line,
)

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

#: Largest number of bars of a histogram; fewer motions have two times the root of their number.
_MOST_BARS = 80
#: Fraction of the motions in one bar above which a histogram has a logarithmic axis of counts.
_ONE_BAR = 0.9
#: Fraction of the motions at each end that a histogram leaves out.
_TAIL = 1e-3
#: Smallest width of an axis that matplotlib draws.
_MIN_WIDTH = 1e-280
#: Largest number that matplotlib draws.
_MAX_NUMBER = 1e300
#: Width of a bar of a Sobol index.
_BAR_WIDTH = 0.38
#: Sobol index -> its name, the grey of its bar, the shift of its bar in widths.
_SOBOL = {"S1": ("first-order", "0.35", -0.5), "ST": ("total", "0.8", 0.5)}
#: Names of results for titles, where the name in files is too short.
_RESULT_NAMES = {"lost": "share of energy lost", "onset_time": "onset time $t^*$"}
#: Symbols of initial values.
_INITIAL_SYMBOLS = {"V0": "$V_0$", "omega0": r"$\omega_0$"}


def distributions(data: xr.Dataset) -> Figure:
    """Draw a row for each quantity: its quantiles over time on the left, its histogram at the last time on the right.

    Of a quantity that is one number per motion, or where there is a single output time, the left panel shows the
    fraction of motions below each quantile.

    data: :class:`xr.Dataset`, the summaries of a run or of an ensemble: coordinates quantile, the levels, and t,
        output times; NAME_quantiles over (quantile, t) or over quantile, with the attribute units and perhaps
        symbol; NAME_histogram, NAME_bin_low and NAME_bin_high; attribute motions, and of a run design and seed, for the
        title.  If no quantity has a histogram there is no right column; if any has, all must have one (else KeyError).
    Returns the :class:`matplotlib.figure.Figure`; without quantities it has one empty row.
    """
    data = data.sortby("quantile")
    about, levels = data.attrs, data["quantile"].values
    names = [str(name).removesuffix("_quantiles") for name in data if str(name).endswith("_quantiles")]
    design = f", {about['design']}, seed {about['seed']}" if "design" in about else ""
    columns = 2 if any(f"{name}_histogram" in data for name in names) else 1
    rows = max(len(names), 1)
    figure, grid = new_figure(f"{about['motions']:,} motions{design}", rows, columns, 2.4 * rows, squeeze=False)
    for name, (left, *right) in zip(names, grid, strict=False):
        variable = data[f"{name}_quantiles"]
        label = axis_label(name, variable.attrs["units"], variable.attrs.get("symbol", ""))
        if "t" in variable.dims and data.sizes["t"] > 1:
            quantile_bands(left, t := data["t"].values, levels, variable.values)
            left.set(xlabel=variable_label(data["t"]), ylabel=label, xlim=(t[0], t[-1]))
        else:
            left.plot(variable.values.ravel(), levels, "o-", color="black")
            left.set(xlabel=label, ylabel="fraction of motions below", ylim=(0.0, 1.0))
        for axes in right:
            axes.set_xlabel(f"{label} at the end" if "t" in variable.dims else label)
            _draw_histogram(axes, data, name)
        for axes in (left, *right):
            linear = "x" if axes.get_yscale() == "log" else "both"
            axes.locator_params(nbins=6, axis=linear)
            axes.ticklabel_format(style="sci", scilimits=(-2, 5), axis=linear)
    return figure


def _draw_histogram(axes: Any, data: xr.Dataset, name: str) -> None:
    """Draw the histogram of a quantity at the last time.

    The tails, a thousandth of the motions at either end, are left out; the title states how many motions that are, if
    any.  Where one of several bars has more than 90 % of the motions that are shown, the axis of counts is logarithmic.
    If no motion has a value the panel is empty and its title is "no values".

    axes: axes of matplotlib, drawn into.
    data: summaries of motions, with NAME_histogram (bins,) or (bins, times), NAME_bin_low and NAME_bin_high (bins,).
    name: name of the quantity, NAME.
    """
    counts = data[f"{name}_histogram"].values
    counts = counts[:, -1] if counts.ndim == 2 else counts
    axes.set_ylabel(f"motions, of {counts.sum():,}")
    if not counts.any():
        axes.set_title("no values", fontsize="small")
        return
    edges, bars = _even_bars(data[f"{name}_bin_low"].values, data[f"{name}_bin_high"].values, counts)
    axes.stairs(bars, edges, fill=True, color="0.6")
    if bars.size > 1 and bars.max() > _ONE_BAR * bars.sum():  # as at rest: the other bars would not be visible
        axes.set_yscale("log")
    if outside := int(counts.sum() - round(bars.sum())):
        axes.set_title(f"{outside} more beyond the ends", fontsize="small")


def _even_bars(low: NDArray, high: NDArray, counts: NDArray) -> tuple[NDArray, NDArray]:
    """Combine bins to bars of equal width, without a thousandth of the motions at either end.

    low, high: ends of the bins, ascending, (bins,), in the unit of the quantity.
    counts: motions in each bin, (bins,), at least one in all; a bar gets the fraction of a bin that it overlaps.
    Returns (edges of the bars, (bars + 1,); numbers of motions, (bars,), which need not be whole).  There are 80 bars,
    or two times the root of the number of motions, rounded down, if that is less.  Ends are clipped to -1e300 and
    1e300.  If the bins together are narrower than 1e-280, which matplotlib does not draw, there is one bar, about the
    value, as wide as its magnitude but at least 1, with all motions of these bins.
    """
    reached = np.cumsum(counts) / max(counts.sum(), 1)
    first, last = np.searchsorted(reached, [_TAIL, 1.0 - _TAIL])
    last = min(last, counts.size - 1)
    start, end = np.clip([low[first], high[last]], -_MAX_NUMBER, _MAX_NUMBER)
    if end - start < _MIN_WIDTH:
        return start + max(1.0, abs(start)) * np.array([-0.5, 0.5]), counts[first : last + 1].sum(keepdims=True)
    edges = np.linspace(start, end, min(_MOST_BARS, 2 * math.isqrt(counts.sum())) + 1)
    below = np.append(0, np.repeat(np.cumsum(counts), 2))[:-1]
    return edges, np.diff(np.interp(edges, np.ravel([low, high], "F"), below))


def sobol_bars(indices: xr.Dataset) -> Figure:
    """Draw first-order and total index of every input with its confidence interval, a panel for each quantity.

    Quantities over time are shown at the last time with indices.  All panels have the inputs in one order: the input
    with the largest total index of any quantity first.

    indices: dataset of :func:`viscoroll.io.runs.sensitivity.sobol_indices`, or read from its netCDF file: of each
        quantity NAME_S1, NAME_S1_conf, NAME_ST and NAME_ST_conf over (t, input) or (input,), dimensionless; at least
        one quantity (else ValueError); coordinates input, names, and t; attributes confidence, in (0, 1), and motions,
        their number, for the title.
    Returns the :class:`matplotlib.figure.Figure`.
    """
    names = [str(name).removesuffix("_S1") for name in indices if str(name).endswith("_S1")]
    shown = [_last_indices(indices, name) for name in names]
    order = np.argsort(-np.max([values["ST"] for _, values in shown], axis=0), kind="stable")
    inputs = [_INITIAL_SYMBOLS.get(name) or axis_label(name) for name in indices["input"].values[order]]
    percent = f"{indices.attrs['confidence']:.0%}".replace("%", " %")
    title = f"Sobol indices of {indices.attrs['motions']:,} motions, with {percent} confidence intervals"
    figure, panels = new_panels(title, len(shown), 2.1, sharey=True)
    x = np.arange(order.size)
    for axes, (text, values) in zip(panels, shown, strict=True):
        for key, (kind, grey, shift) in _SOBOL.items():
            axes.bar(
                x + shift * _BAR_WIDTH, values[key][order], _BAR_WIDTH, yerr=values[f"{key}_conf"][order], label=kind,
                color=grey, edgecolor="black", linewidth=0.5, capsize=2.5, error_kw={"linewidth": 0.9},
            )  # fmt: skip
        zero_line(axes)
        axes.set_xticks(x, inputs)
        axes.set_title(text, fontsize="small")
    panels[0].set_ylabel("Sobol index")
    small_legend(panels[0])
    return figure


def _last_indices(indices: xr.Dataset, name: str) -> tuple[str, dict[str, NDArray]]:
    """Return the Sobol indices of a quantity at the last time that has them for the first input.

    Of a quantity without times they are its indices.

    indices: Sobol indices of a run, a dataset with NAME_S1, NAME_S1_conf, NAME_ST and NAME_ST_conf over (t, input) or
        (input,), finite at one time at least (else IndexError), and t with the attribute units.
    name: name of the quantity, NAME.
    Returns (title of the panel; dict from "S1", "S1_conf", "ST" and "ST_conf" to values over the inputs, (inputs,)).
    """
    values = {key: indices[f"{name}_{key}"].values for index in _SOBOL for key in (index, f"{index}_conf")}
    text = _RESULT_NAMES.get(name) or axis_label(name)
    if values["S1"].ndim == 1:
        return text, values
    last = np.flatnonzero(np.isfinite(values["S1"][:, 0]))[-1]
    time = with_unit(f"{axis_label('t')} = {indices['t'].values[last]:g}", indices["t"].attrs["units"])
    return f"{text} at {time}", {key: v[last] for key, v in values.items()}
