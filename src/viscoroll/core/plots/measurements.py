"""Figures of what was measured: a material, a fit of its series, and an identification."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import ParameterError
from .style import LINES, THIN, spaced_by_factors, plot_measured_range, axis_label, new_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

#: decades shown beyond the shortest and the longest time
_MARGIN = 2.0
_POINTS = 400


def master_curve(material: Any) -> Figure:
    """E', E'' and tan delta of a :class:`Material` over angular frequency on the left, E(t) on the right.

    Raises
    ------
    ParameterError
        A rigid body: it has no curves.
    """
    if material.is_rigid:
        raise ParameterError("material", "rigid", "one of a finite modulus")
    times = material.T_ref * np.concatenate([material.prony.T, material.prony.tau, [1.0][: not material.prony.E.size]])
    ends = np.log10(times.min()) - _MARGIN, np.log10(times.max()) + _MARGIN
    t = np.logspace(*ends, _POINTS)
    omega = 1.0 / t[::-1]
    title = (material.name or "Material") + ("; dashed: beyond what was measured" if material.measured else "")
    figure, (left, right) = new_figure(title, 1, 2, (9.0, 4.0))
    held = material.measured and (material.measured.low, material.measured.high)
    lines = plot_measured_range(left, omega, material.storage(omega), held, **LINES[0], label="E'")[:1]
    left.set(xscale="log", yscale="log")
    if material.prony.E.size:  # an elastic material has none, and no logarithm of it
        lines += plot_measured_range(left, omega, material.loss(omega), held, **LINES[1], label="E''")[:1]
        factor = left.twinx()
        lines += plot_measured_range(factor, omega, material.tan_delta(omega), held, **LINES[2], label="tan delta")[:1]
        factor.set(ylabel="loss factor tan delta", ylim=(0.0, None))
    left.set(xlabel="angular frequency, rad/s", ylabel="storage and loss modulus, Pa")
    left.legend(handles=lines, frameon=False, loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=3, fontsize="small")
    plot_measured_range(right, t, material.relaxation(t), held and (1.0 / held[1], 1.0 / held[0]), **LINES[0])
    right.set(xlabel="time, s", ylabel="relaxation modulus E(t), Pa", xscale="log", yscale="log")
    return figure


def moduli_fit(fit: Any) -> Figure:
    """Storage and loss modulus of a :class:`viscoroll.Fit`: the data and the curves of the series."""
    symbol = "G" if fit.mode == "shear" else "E"
    misfit = f"misfit {fit.misfit.storage:.1%} in {symbol}', {fit.misfit.loss:.1%} in {symbol}''"
    columns = {f"{symbol}'": fit.storage, f"{symbol}''": fit.loss}
    return _with_data(fit, misfit, fit.omega, columns, fit.modulus, "angular frequency, rad/s")


def relaxation_fit(fit: Any) -> Figure:
    """Relaxation modulus of a :class:`viscoroll.RelaxationFit`: the data and the curve of the series."""
    columns = {"G(t)" if fit.mode == "shear" else "E(t)": fit.relaxation}
    return _with_data(fit, f"misfit {fit.misfit:.1%}", fit.t, columns, lambda t: (fit.modulus(t),), "time, s")


def _with_data(fit: Any, misfit: str, x: Any, columns: dict[str, Any], modulus: Any, label: str) -> Figure:
    """Columns over x, and the moduli of the fit there, a tuple of them."""
    fine = np.geomspace(x[0], x[-1], _POINTS)
    figure, axes = new_figure(f"Prony series of {fit.prony.E.size} modes: {misfit}")
    for (name, values), curve, line in zip(columns.items(), modulus(fine), LINES, strict=False):
        axes.loglog(x, values, "o", color=line["color"], markerfacecolor="none", markersize=4, label=name)
        axes.loglog(fine, curve, **line, label=f"{name} of the fit")
    axes.set(xlabel=label, ylabel="modulus, unit of the data")
    axes.legend(frameon=False, fontsize="small", ncols=2)
    return figure


def identification(fit: Any) -> Figure:
    """A column for each quantity of a record: data and band over its places above, residuals over sigma below."""
    shown = fit._problem.columns
    figure, axes = new_figure(
        f"Identification of {', '.join(fit.values)}", 2, len(shown), (3.6 * len(shown) + 1.2, 4.8), squeeze=False,
        sharex="col", height_ratios=(2.5, 1.0),
    )  # fmt: skip
    for one, (above, below) in zip(shown, axes.T, strict=True):
        name, called, quantity = str(one), one.record, one.quantity
        record, band = fit.records[called], getattr(fit.predicted[called], quantity)
        *others, place = record.PLACES
        several = bool(others)  # curves at several speeds: dots, not one line
        order = np.argsort(np.ravel(getattr(record, place)), kind="stable")
        columns = getattr(record, place), fit.sigma[name], *band
        x, sigma, value, low, high = (np.ravel(part)[order] for part in columns)
        (above.vlines if several else above.fill_between)(x, low, high, color="0.7" if several else "0.85")
        above.plot(x, value, "_" if several else "-", color=LINES[1]["color"], label="fit")
        if not fit.planned:
            y = np.ravel(getattr(record, quantity))[order]
            above.plot(x, y, ".", color="black", markersize=3, label="data")
            below.plot(x, (value - y) / sigma, ".", color="black", markersize=3)
        below.axhline(0.0, **THIN)
        if spaced_by_factors(x):
            below.set_xscale("log")
        above.set(ylabel=axis_label(quantity, record.unit(quantity)), title=called)
        above.legend(frameon=False, fontsize="small")
        below.set(xlabel=axis_label(place, record.unit(place)), ylabel="residual/sigma")
    return figure
