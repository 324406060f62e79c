"""Figures of measurements (a material, the fit of a series, an identification) and of many motions
(quantiles and final distribution of each quantity, and Sobol indices as bars).
"""

import math
from typing import Any

import numpy as np

from ..arrays import NDArray
from ..errors import ParameterError
from ..files import Dataset, Figure, names_ending
from . import (
    LINES,
    axis_label,
    new_figure,
    new_panels,
    plot_measured_range,
    quantile_bands,
    small_legend,
    spaced_by_factors,
    symbol_label,
    variable_label,
    with_unit,
    zero_line,
)

# --- Figures of measurements ---

#: Decades that are shown beyond the shortest and the longest time of a material.
_MARGIN = 2.0
#: Points of a curve.
_POINTS = 400


def master_curve(material: Any) -> Figure:
    """Draw E', E'' and tan delta over angular frequency on the left, E(t) on the right, in Pa,
    rad/s and s.

    The axis reaches two decades beyond the shortest and the longest time of the material.

    material: a :class:`Material`, whose name, series, T_ref and ``measured`` are read.  If it has a
        record of its measurement, curves are solid in the measured band, for E(t) the inverse of
        its frequencies, and dashed outside; else each curve has a style of its own.
    Returns the :class:`matplotlib.figure.Figure`; of an elastic material it has no E'' and tan
    delta.
    Raises ParameterError for a rigid body, which has no curves.
    """
    if material.is_rigid:
        raise ParameterError("material", "rigid", "a material with a finite modulus")
    # an elastic material has no times: 1 in their place, about which its constant moduli are drawn
    times = material.T_ref * np.concatenate(
        [material.prony.T, material.prony.tau, [1.0][: not material.prony.E.size]]
    )
    t = np.logspace(np.log10(times.min()) - _MARGIN, np.log10(times.max()) + _MARGIN, _POINTS)
    omega = 1.0 / t[::-1]  # reversed, so that it ascends
    title = material.name or "Material"
    band = inverse = None  # lowest and highest frequency, and the inverse of these
    if record := material.measured:
        title += "; dashed: outside the measured frequencies"
        band = record.low, record.high
        inverse = 1.0 / record.high, 1.0 / record.low
    figure, (left, right) = new_figure(title, 1, 2, 3.4)
    left.set(xscale="log", yscale="log")
    curves = [(left, material.storage, "E'")]
    if material.prony.E.size:  # the loss of an elastic material is 0, which has no logarithm
        curves += [(left, material.loss, "E''"), (left.twinx(), material.tan_delta, "tan delta")]
    lines = [
        plot_measured_range(axes, omega, modulus(omega), band, **line, label=label)
        for (axes, modulus, label), line in zip(curves, LINES)
    ]
    for factor, *_ in curves[2:]:
        factor.set(ylabel="loss factor tan delta", ylim=(0.0, None))
    left.set(xlabel="angular frequency, rad/s", ylabel="storage and loss modulus, Pa")
    small_legend(left, handles=lines, loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=3)
    plot_measured_range(right, t, material.relaxation(t), inverse, **LINES[0])
    right.set(xlabel="time, s", ylabel="relaxation modulus E(t), Pa", xscale="log", yscale="log")
    return figure


def series_fit(fit: Any) -> Figure:
    """Draw measured moduli as points and the series that was fitted to them as curves, on
    logarithmic axes.

    fit: a :class:`viscoroll.Fit` (E' and E'' over angular frequency, rad/s) or a
        :class:`viscoroll.RelaxationFit` (the relaxation modulus over time, s), in the unit of its
        data; its ``data``, sorted by frequency or time, > 0, ``symbols``, ``prony`` and misfit are
        read.
    Returns the :class:`matplotlib.figure.Figure`; its title states the number of modes and the
    misfit.
    """
    x, *columns = fit.data
    fine = np.geomspace(x[0], x[-1], _POINTS)
    figure, axes = new_figure(
        f"Prony series, {fit.prony.E.size} terms; misfit {fit.misfit_text(1)}"
    )
    for symbol, values, curve, line in zip(fit.symbols, columns, fit._moduli(fine), LINES):
        axes.loglog(
            x, values, "o", color=line["color"], markerfacecolor="none", markersize=4, label=symbol
        )
        axes.loglog(fine, curve, **line, label=f"{symbol} of the fit")
    label = "time, s" if fit.data._fields[0] == "t" else "angular frequency, rad/s"
    axes.set(xlabel=label, ylabel="modulus, unit of the data")
    small_legend(axes, ncols=2)
    return figure


def identification(fit: Any) -> Figure:
    """Draw a column for each quantity of a record: data and prediction band on top, residuals
    below.

    Residuals are (fit - data)/sigma, dimensionless.  A record over several coordinates is drawn
    over its last one, with a vertical line for each point's prediction band.

    fit: a :class:`viscoroll.measurements.identification_result.Identification`, whose ``values``
        (for their names), ``records``, ``predicted`` bands (value, low, high), ``sigma`` (in the
        unit of the quantity), ``planned`` and columns of the problem are read.  Of a planned one,
        which has no data, neither data nor residuals are drawn.
    Returns the :class:`matplotlib.figure.Figure`, whose axis of a coordinate that is spaced by
    factors is logarithmic.
    """
    shown = fit._problem.columns
    figure, grid = new_figure(
        f"Identification of {', '.join(fit.values)}",
        2,
        len(shown),
        4.4,
        squeeze=False,
        sharex="col",
        height_ratios=(2.5, 1.0),
    )
    for column, (top, bottom) in zip(shown, grid.T):
        record = fit.records[column.record]
        band = getattr(fit.predicted[column.record], column.quantity)
        *others, variable = record.COORDINATES  # as t, or V and delta: the last one is drawn over
        curves = bool(others)  # of several speeds, which one line cannot connect
        order = np.argsort(np.ravel(getattr(record, variable)), kind="stable")
        x, sigma, value, low, high = (
            np.ravel(array)[order]
            for array in (getattr(record, variable), fit.sigma[str(column)], *band)
        )
        (top.vlines if curves else top.fill_between)(
            x, low, high, color="0.7" if curves else "0.85"
        )
        top.plot(x, value, "_" if curves else "-", color=LINES[1]["color"], label="fit")
        if not fit.planned:
            y = np.ravel(getattr(record, column.quantity))[order]
            top.plot(x, y, ".", color="black", markersize=3, label="data")
            bottom.plot(x, (value - y) / sigma, ".", color="black", markersize=3)
        zero_line(bottom)
        if spaced_by_factors(x):
            bottom.set_xscale("log")
        top.set(
            ylabel=axis_label(column.quantity, record.unit(column.quantity)), title=column.record
        )
        small_legend(top)
        bottom.set(xlabel=axis_label(variable, record.unit(variable)), ylabel="residual/sigma")
    return figure


# --- Figures of many motions ---

#: Fraction of the motions at each end that a histogram leaves out where they would make it much
#: wider.
_TAIL = 1e-3
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


def distributions(data: Dataset) -> Figure:
    """Draw a row for each quantity: its quantiles over time on the left, its histogram at the last
    time on the right.

    Of a quantity that is one number per motion, or where there is a single output time, the left
    panel shows the fraction of motions below each quantile.

    data: :class:`xr.Dataset`, the summaries of a run or of an ensemble: coordinates quantile, the
        levels, and t, output times; NAME_quantiles over (quantile, t) or over quantile, with the
        attribute units and perhaps symbol; NAME_histogram, NAME_bin_low and NAME_bin_high;
        attribute motions, and of a run design and seed, for the title.  If no quantity has a
        histogram there is no right column; if any has, all must have one (else KeyError).
    Returns the :class:`matplotlib.figure.Figure`; without quantities it has one empty row.
    """
    data = data.sortby("quantile")
    about = data.attrs
    levels = data["quantile"].values
    names = names_ending(data, "_quantiles")
    design = f", {about['design']}, seed {about['seed']}" if "design" in about else ""
    columns = 1 + any(f"{name}_histogram" in data for name in names)
    rows = max(len(names), 1)
    figure, grid = new_figure(
        f"{about['motions']:,} motions{design}", rows, columns, 2.4 * rows, squeeze=False
    )
    for name, (left, *right) in zip(names, grid):
        variable = data[f"{name}_quantiles"]
        label = symbol_label(variable.rename(name))
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
            # matplotlib refuses these settings for a logarithmic axis
            linear = "x" if axes.get_yscale() == "log" else "both"
            axes.locator_params(nbins=6 if axes is left else 4, axis=linear)
            axes.ticklabel_format(style="sci", scilimits=(-2, 5), axis=linear)
    return figure


def _draw_histogram(axes: Any, data: Dataset, name: str) -> None:
    """Draw the histogram of a quantity at the last time.

    The tails, a thousandth of the motions at either end, are left out where the axis would be more
    than twice as wide with them; the title states how many motions that are, if
    any.  Where one of several bars has more than 90 % of the motions that are shown, the axis of
    counts is logarithmic.  If no motion has a value the panel is empty and its title is "no
    values".

    axes: axes of matplotlib, drawn into.
    data: summaries of motions, with NAME_histogram (bins,) or (bins, times), NAME_bin_low and
    NAME_bin_high (bins,).
    name: name of the quantity, NAME.
    """
    counts = data[f"{name}_histogram"].values
    counts = counts[:, -1] if counts.ndim == 2 else counts
    axes.set_ylabel(f"motions, of {counts.sum():,}")
    if not counts.any():
        axes.set_title("no values", fontsize="small")
        return
    edges, bars = _even_bars(
        data[f"{name}_bin_low"].values, data[f"{name}_bin_high"].values, counts
    )
    axes.stairs(bars, edges, fill=True, color="0.6")
    # as at rest: the other bars would not be visible
    if bars.size > 1 and bars.max() > 0.9 * bars.sum():
        axes.set_yscale("log")
    # parts of bins need not sum to a whole number by rounding
    if outside := int(counts.sum() - round(bars.sum())):
        axes.set_title(f"{outside} more beyond the ends", fontsize="small")


def _even_bars(low: NDArray, high: NDArray, counts: NDArray) -> tuple[NDArray, NDArray]:
    """Combine bins to bars of equal width, without a thousandth of the motions at either end if
    these lie far out.

    low, high: ends of the bins, ascending, (bins,), in the unit of the quantity.
    counts: motions in each bin, (bins,), at least one in all; a bar gets the fraction of a bin that
    it overlaps.
    Returns (edges of the bars, (bars + 1,); numbers of motions, (bars,), which need not be whole).
    There are 80 bars, or two times the root of the number of motions, rounded down, if that is
    less.  Ends are clipped to -1e300 and 1e300.  If the bins together are narrower than 1e-280,
    which matplotlib does not draw, there is one bar, about the value, as wide as its magnitude but
    at least 1, with all motions of these bins.
    """
    reached = np.cumsum(counts)
    # first bins up to whose end there are a thousandth of the motions, and all but a thousandth
    first, last = np.searchsorted(reached / reached[-1], [_TAIL, 1.0 - _TAIL])
    # the axis without the tails is at most half as wide, else it shows all motions
    if high[-1] - low[0] <= 2.0 * (high[last] - low[first]):
        first = 0
        last = counts.size - 1
    start, end = np.clip([low[first], high[last]], -_MAX_NUMBER, _MAX_NUMBER)
    if end - start < 1e-280:  # matplotlib draws no narrower axis
        edges = start + max(1.0, abs(start)) * np.array([-0.5, 0.5])
        return edges, counts[first : last + 1].sum(keepdims=True)
    edges = np.linspace(start, end, min(80, 2 * math.isqrt(reached[-1])) + 1)
    # motions below each end, in the order low, high, low, high: within a bin they grow evenly, and
    # in a gap between bins not at all
    below = np.append(0, np.repeat(reached, 2))[:-1]
    return edges, np.diff(np.interp(edges, np.ravel([low, high], "F"), below))


def sobol_bars(indices: Dataset) -> Figure:
    """Draw first-order and total index of every input with its confidence interval, a panel for
    each quantity.

    Quantities over time are shown at the last time with indices.  All panels have the inputs in one
    order: the input with the largest total index of any quantity first.

    indices: dataset of :func:`viscoroll.runs.sensitivity.sobol_indices`, or read from its netCDF
        file: of each quantity NAME_S1, NAME_S1_conf, NAME_ST and NAME_ST_conf over (t, input) or
        (input,), dimensionless; at least one quantity (else ValueError); coordinates input, names,
        and t; attributes confidence, in (0, 1), and motions, their number, for the title.
    Returns the :class:`matplotlib.figure.Figure`.
    """
    shown = [_last_indices(indices, name) for name in names_ending(indices, "_S1")]
    # minus: descending
    order = np.argsort(-np.max([values["ST"] for _, values in shown], axis=0), kind="stable")
    inputs = [
        _INITIAL_SYMBOLS.get(name) or axis_label(name) for name in indices["input"].values[order]
    ]
    title = f"Sobol indices of {indices.attrs['motions']:,} motions, with "
    title += f"{100.0 * indices.attrs['confidence']:.0f} % confidence intervals"
    figure, panels = new_panels(title, len(shown), 2.1, sharey=True)
    x = np.arange(order.size)
    for axes, (text, values) in zip(panels, shown):
        for key, (kind, grey, shift) in _SOBOL.items():
            axes.bar(
                x + shift * _BAR_WIDTH,
                values[key][order],
                _BAR_WIDTH,
                yerr=values[f"{key}_conf"][order],
                label=kind,
                color=grey,
                edgecolor="black",
                linewidth=0.5,
                capsize=2.5,
                error_kw={"linewidth": 0.9},
            )
        zero_line(axes)
        axes.set_xticks(x, inputs)
        axes.set_title(text, fontsize="small")
    panels[0].set_ylabel("Sobol index")
    small_legend(panels[0])
    return figure


def _last_indices(indices: Dataset, name: str) -> tuple[str, dict[str, NDArray]]:
    """Return the Sobol indices of a quantity at the last time that has them for the first input.

    Of a quantity without times they are its indices.

    indices: Sobol indices of a run, a dataset with NAME_S1, NAME_S1_conf, NAME_ST and NAME_ST_conf
        over (t, input) or (input,), finite at one time at least (else IndexError), and t with the
        attribute units.
    name: name of the quantity, NAME.
    Returns (title of the panel; dict from "S1", "S1_conf", "ST" and "ST_conf" to values over the
    inputs, (inputs,)).
    """
    values = {
        key: indices[f"{name}_{key}"].values for index in _SOBOL for key in (index, f"{index}_conf")
    }
    text = _RESULT_NAMES.get(name) or axis_label(name)
    if values["S1"].ndim == 1:
        return text, values
    # at a time without indices those of all inputs are NaN
    last = np.flatnonzero(np.isfinite(values["S1"][:, 0]))[-1]
    time = with_unit(
        f"{axis_label('t')} = {indices['t'].values[last]:g}", indices["t"].attrs["units"]
    )
    return f"{text} at {time}", {key: v[last] for key, v in values.items()}
