"""The figure of an identification: data, best fit with its band, residuals."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from .style import LINES, THIN, labelled, new_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

#: places that rise by more than this factor lie on a logarithmic axis
_SPREAD = 30.0


def compared(fit: Any) -> Figure:
    """A column for each quantity of a record: data and band over its places above, residuals over sigma below."""
    columns = [(str(one), one.record, one.quantity) for one in fit._problem.columns]
    figure, axes = new_figure(
        f"Identification of {', '.join(fit.values)}", 2, len(columns), (3.6 * len(columns) + 1.2, 4.8), squeeze=False,
        sharex="col", height_ratios=(2.5, 1.0),
    )  # fmt: skip
    for (name, called, quantity), (above, below) in zip(columns, axes.T, strict=True):
        record, band = fit.records[called], getattr(fit.predicted[called], quantity)
        place = record.PLACES[-1]
        x, order = np.ravel(getattr(record, place)), np.argsort(np.ravel(getattr(record, place)), kind="stable")
        x, sigma = x[order], fit.sigma[name][order]
        value, low, high = (np.ravel(part)[order] for part in band)
        several = len(record.PLACES) > 1  # curves at several speeds: dots, not one line
        above.fill_between(x, low, high, color="0.85") if not several else above.vlines(x, low, high, color="0.7")
        above.plot(x, value, "_" if several else "-", color=LINES[1]["color"], label="fit")
        if not fit.planned:
            y = np.ravel(getattr(record, quantity))[order]
            above.plot(x, y, ".", color="black", markersize=3, label="data")
            below.plot(x, (value - y) / sigma, ".", color="black", markersize=3)
        below.axhline(0.0, **THIN)
        if x[0] > 0.0 and x[-1] > _SPREAD * x[0]:
            below.set_xscale("log")
        above.set(ylabel=labelled(quantity, record.unit(quantity)), title=called)
        above.legend(frameon=False, fontsize="small")
        below.set(xlabel=labelled(place, record.unit(place)), ylabel="residual/sigma")
    return figure
