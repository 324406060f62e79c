"""Figures of measurements: a material, the fit of a series, and an identification."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import ParameterError
from .style import LINES, axis_label, new_figure, plot_measured_range, small_legend, spaced_by_factors, zero_line

if TYPE_CHECKING:
    from matplotlib.figure import Figure

#: Decades that are shown beyond the shortest and the longest time of a material.
_MARGIN = 2.0
#: Points of a curve.
_POINTS = 400


def master_curve(material: Any) -> Figure:
    """Draw E', E'' and tan delta over angular frequency on the left, E(t) on the right, in Pa, rad/s and s.

    The axis reaches two decades beyond the shortest and the longest time of the material.

    material: a :class:`Material`, whose name, series, T_ref and ``measured`` are read.  If it has a record of its
        measurement, curves are solid in the measured band, for E(t) the inverse of its frequencies, and dashed outside;
        else each curve has a style of its own.
    Returns the :class:`matplotlib.figure.Figure`; of an elastic material it has no E'' and tan delta.
    Raises ParameterError for a rigid body, which has no curves.
    """
    if material.is_rigid:
        raise ParameterError("material", "rigid", "a material with a finite modulus")
    times = material.T_ref * np.concatenate([material.prony.T, material.prony.tau, [1.0][: not material.prony.E.size]])
    ends = np.log10(times.min()) - _MARGIN, np.log10(times.max()) + _MARGIN
    t = np.logspace(*ends, _POINTS)
    omega = 1.0 / t[::-1]
    title = (material.name or "Material") + ("; dashed: outside the measured band" if material.measured else "")
    figure, (left, right) = new_figure(title, 1, 2, 3.4)
    band = material.measured and (material.measured.low, material.measured.high)
    lines = plot_measured_range(left, omega, material.storage(omega), band, **LINES[0], label="E'")[:1]
    left.set(xscale="log", yscale="log")
    if material.prony.E.size:  # the loss modulus of an elastic material is 0, which has no logarithm
        lines += plot_measured_range(left, omega, material.loss(omega), band, **LINES[1], label="E''")[:1]
        factor = left.twinx()
        lines += plot_measured_range(factor, omega, material.tan_delta(omega), band, **LINES[2], label="tan delta")[:1]
        factor.set(ylabel="loss factor tan delta", ylim=(0.0, None))
    left.set(xlabel="angular frequency, rad/s", ylabel="storage and loss modulus, Pa")
    small_legend(left, handles=lines, loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=3)
    plot_measured_range(right, t, material.relaxation(t), band and (1.0 / band[1], 1.0 / band[0]), **LINES[0])
    right.set(xlabel="time, s", ylabel="relaxation modulus E(t), Pa", xscale="log", yscale="log")
    return figure


def series_fit(fit: Any) -> Figure:
    """Draw measured moduli as points and the series that was fitted to them as curves, on logarithmic axes.

    fit: a :class:`viscoroll.Fit` (E' and E'' over angular frequency, rad/s) or a :class:`viscoroll.RelaxationFit` (the
        relaxation modulus over time, s), in the unit of its data; its ``data``, sorted by frequency or time, > 0,
        ``symbols``, ``prony`` and misfit are read.
    Returns the :class:`matplotlib.figure.Figure`; its title states the number of modes and the misfit.
    """
    x, *columns = fit.data
    fine = np.geomspace(x[0], x[-1], _POINTS)
    figure, axes = new_figure(f"Prony series of {fit.prony.E.size} modes: misfit {fit.misfit_text(1)}")
    for symbol, values, curve, line in zip(fit.symbols, columns, fit._moduli(fine), LINES, strict=False):
        axes.loglog(x, values, "o", color=line["color"], markerfacecolor="none", markersize=4, label=symbol)
        axes.loglog(fine, curve, **line, label=f"{symbol} of the fit")
    label = "time, s" if fit.data._fields[0] == "t" else "angular frequency, rad/s"
    axes.set(xlabel=label, ylabel="modulus, unit of the data")
    small_legend(axes, ncols=2)
    return figure


def identification(fit: Any) -> Figure:
    """Draw a column for each quantity of a record: data and prediction band on top, residuals below.

    Residuals are (fit - data)/sigma, dimensionless.  A record over several coordinates is drawn over its last one, with
    a vertical line for each point's prediction band.

    fit: a :class:`viscoroll.app.identification.fit.Identification`, whose ``values`` (for their names), ``records``,
        ``predicted`` bands (value, low, high), ``sigma`` (in the unit of the quantity), ``planned`` and columns of the
        problem are read.  Of a planned one, which has no data, neither data nor residuals are drawn.
    Returns the :class:`matplotlib.figure.Figure`, whose axis of a coordinate that is spaced by factors is logarithmic.
    """
    shown = fit._problem.columns
    figure, grid = new_figure(
        f"Identification of {', '.join(fit.values)}", 2, len(shown), 4.4, squeeze=False,
        sharex="col", height_ratios=(2.5, 1.0),
    )  # fmt: skip
    for column, (top, bottom) in zip(shown, grid.T, strict=True):
        record, band = fit.records[column.record], getattr(fit.predicted[column.record], column.quantity)
        *others, variable = record.COORDINATES
        curves = bool(others)  # of several speeds, which one line cannot connect
        order = np.argsort(np.ravel(getattr(record, variable)), kind="stable")
        arrays = getattr(record, variable), fit.sigma[str(column)], *band
        x, sigma, value, low, high = (np.ravel(array)[order] for array in arrays)
        (top.vlines if curves else top.fill_between)(x, low, high, color="0.7" if curves else "0.85")
        top.plot(x, value, "_" if curves else "-", color=LINES[1]["color"], label="fit")
        if not fit.planned:
            y = np.ravel(getattr(record, column.quantity))[order]
            top.plot(x, y, ".", color="black", markersize=3, label="data")
            bottom.plot(x, (value - y) / sigma, ".", color="black", markersize=3)
        zero_line(bottom)
        if spaced_by_factors(x):
            bottom.set_xscale("log")
        top.set(ylabel=axis_label(column.quantity, record.unit(column.quantity)), title=column.record)
        small_legend(top)
        bottom.set(xlabel=axis_label(variable, record.unit(variable)), ylabel="residual/sigma")
    return figure
