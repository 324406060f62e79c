"""Figures of many motions: quantiles and final distribution of each quantity, and Sobol indices as bars."""

from __future__ import annotations

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

#: Quantities of an ensemble that are drawn.
_QUANTITIES = ("V", "omega", "x", "angle")
#: Levels of the quantiles of an ensemble.
_LEVELS = (0.05, 0.25, 0.5, 0.75, 0.95)
#: Bars of the histogram of a run.
_BARS = 80
#: Bars of the histogram of an ensemble.
_ENSEMBLE_BARS = 40
#: Motions below which each is a point in place of a histogram.
_MIN_MOTIONS = 8
#: Relative range below which values are one point in place of a histogram.
_MIN_RANGE = 1e-12
#: Fraction of the motions in one bar above which a histogram has a logarithmic axis of counts.
_ONE_BAR = 0.9
#: Fraction of the motions at each end that the histogram of a run leaves out.
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
    """Draw a row for each quantity: its quantiles over time, and its histogram at the last time.

    data: :class:`xr.Dataset`, an ensemble, with each motion along the axis ``motion``; its summary, which has no
        histograms; or the summaries of a run, with NAME_quantiles and NAME_histogram.
    Returns the figure.  A quantity without times, or with a single one, has the fraction of motions below each value.
    """
    ensemble, about = "motion" in data.dims, data.attrs
    if ensemble:
        names = [name for name in _QUANTITIES if name in data and data[name].ndim == 2]
    else:
        names = [str(name).removesuffix("_quantiles") for name in data if str(name).endswith("_quantiles")]
    design = f", {about['design']}, seed {about['seed']}" if "design" in about else ""
    columns = 2 if ensemble or any(f"{name}_histogram" in data for name in names) else 1
    count, rows = data.sizes["motion"] if ensemble else about["motions"], max(len(names), 1)
    figure, grid = new_figure(f"{count:,} motions{design}", rows, columns, 2.4 * rows, squeeze=False)
    for name, (left, *right) in zip(names, grid, strict=False):
        variable = data[name if ensemble else f"{name}_quantiles"]
        label = axis_label(name, variable.attrs["units"], variable.attrs.get("symbol", ""))
        levels = np.array(_LEVELS) if ensemble else data["quantile"].values
        values = _finite_quantiles(variable.values) if ensemble else variable.values
        if "t" in variable.dims and data.sizes["t"] > 1:
            quantile_bands(left, t := data["t"].values, levels, values)
            left.set(xlabel=variable_label(data["t"]), ylabel=label, xlim=(t[0], t[-1]))
        else:
            left.plot(values.ravel(), levels, "o-", color="black")
            left.set(xlabel=label, ylabel="fraction of motions below", ylim=(0.0, 1.0))
        for axes in right:
            axes.set_xlabel(f"{label} at the end" if "t" in variable.dims else label)
            if ensemble:
                _ensemble_histogram(axes, variable.values[:, -1])
            else:
                _run_histogram(axes, data, name)
        for axes in (left, *right):
            linear = "x" if axes.get_yscale() == "log" else "both"
            axes.locator_params(nbins=6, axis=linear)
            axes.ticklabel_format(style="sci", scilimits=(-2, 5), axis=linear)
    return figure


def _finite_quantiles(values: NDArray) -> NDArray:
    """Return quantiles over motions, (levels, times); NaN at times that no motion reached.

    values: values of a quantity, (motions, times), NaN where a motion ended before.
    """
    quantiles = np.full((len(_LEVELS), values.shape[1]), np.nan)
    reached = np.isfinite(values).any(axis=0)
    quantiles[:, reached] = np.nanquantile(values[:, reached], _LEVELS, axis=0)
    return quantiles


def _ensemble_histogram(axes: Any, values: NDArray) -> None:
    """Draw the histogram of the motions of an ensemble; of few or equal values a point for each.

    axes: axes of matplotlib, drawn into; the axis of counts is logarithmic where one bar has nearly all motions.
    values: values of a quantity, (motions,); those that are not finite are left out.
    """
    finite = values[np.isfinite(values)]
    axes.set_ylabel(f"motions, of {values.size:,}")
    if finite.size >= _MIN_MOTIONS and np.ptp(finite) > _MIN_RANGE * np.abs(finite).max():
        counts, _, _ = axes.hist(finite, bins=_ENSEMBLE_BARS, color="0.6")
        if counts.max() > _ONE_BAR * finite.size:  # as at rest: the other bars would not be visible
            axes.set_yscale("log")
    else:
        axes.plot(finite, np.arange(1, finite.size + 1), "o", color="black")


def _run_histogram(axes: Any, data: xr.Dataset, name: str) -> None:
    """Draw the histogram of a run at the last time.

    axes: axes of matplotlib, drawn into; the title states how many motions lie beyond the ends, or that there is none.
    data: summaries of the run, with NAME_histogram (bins,) or (bins, times), NAME_bin_low and NAME_bin_high (bins,).
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
    if outside := int(counts.sum() - round(bars.sum())):
        axes.set_title(f"{outside} more beyond the ends", fontsize="small")


def _even_bars(low: NDArray, high: NDArray, counts: NDArray) -> tuple[NDArray, NDArray]:
    """Combine the bins of a run to bars of equal width, without the tails; one bar if all values are nearly equal.

    low, high: ends of the bins of a run, ascending, (bins,).
    counts: motions in each bin, (bins,), of which a bar gets the fraction that it overlaps.
    Returns (edges of the bars, (bars + 1,); numbers of motions, (bars,), which need not be whole).
    """
    reached = np.cumsum(counts) / max(counts.sum(), 1)
    first, last = np.searchsorted(reached, [_TAIL, 1.0 - _TAIL])
    last = min(last, counts.size - 1)
    start, end = np.clip([low[first], high[last]], -_MAX_NUMBER, _MAX_NUMBER)
    if end - start < _MIN_WIDTH:
        return start + max(1.0, abs(start)) * np.array([-0.5, 0.5]), counts[first : last + 1].sum(keepdims=True)
    edges = np.linspace(start, end, _BARS + 1)
    below = np.append(0, np.repeat(np.cumsum(counts), 2))[:-1]
    return edges, np.diff(np.interp(edges, np.ravel([low, high], "F"), below))


def sobol_bars(indices: xr.Dataset) -> Figure:
    """Draw first-order and total index of every input with its confidence interval, a panel for each quantity.

    Quantities over time are shown at the last time with indices.  Inputs have one order, the largest total index first.

    indices: indices of :func:`viscoroll.io.runs.sensitivity.sobol_indices`, or read from its netCDF file: of each
        quantity NAME_S1, NAME_S1_conf, NAME_ST and NAME_ST_conf over (t, input) or (input,), dimensionless.
    Returns the figure.
    """
    names = [str(name).removesuffix("_S1") for name in indices if str(name).endswith("_S1")]
    shown = [_last_indices(indices, name) for name in names]
    order = np.argsort(-np.max([values["ST"] for _, values in shown], axis=0), kind="stable")
    inputs = [_INITIAL_SYMBOLS.get(name) or axis_label(name) for name in indices["input"].values[order]]
    percent = f"{indices.attrs['confidence']:.0%}".replace("%", " %")
    title = f"Sobol indices of {indices.attrs['motions']:,} motions, with {percent} confidence intervals"
    figure, panels = new_panels(title, len(shown), 2, 2.1, sharey=True)
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
    """Return the Sobol indices of a quantity at the last time that has any.

    indices: Sobol indices of a run, a dataset with NAME_S1, NAME_S1_conf, NAME_ST and NAME_ST_conf over (t, input) or
        (input,).
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
