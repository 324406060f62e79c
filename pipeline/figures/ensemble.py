"""An ensemble's distribution: speed over time, and the onset of stick."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from viscoroll.core.plots.style import labelled, new_figure, quantile_bands

from .title import number, scaled

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

_UNIT, _EXPONENT = 1e4, 4


def distribution(summary: xr.Dataset, sample: xr.Dataset) -> Figure:
    """Quantiles of V over time, and a histogram of the onset of stick.

    Parameters
    ----------
    summary : of ``Ensemble.summary`` with an odd number of quantiles; one of t holds V.
    sample : of ``Ensemble.to_xarray``, all of the motions or some.
    """
    count = int(summary.attrs["motions"])
    common = [name for name in ("alpha", "kappa", "mu", "gamma") if sample[name].ndim == 0]
    scene = ", ".join(f"{labelled(name)} = ${number(sample[name].item())}$" for name in common)
    title = f"{count} motions from random starts" + (f" for {scene}" if scene else "")
    figure, (left, right) = new_figure(title, 1, 2, (9.6, 4.2))
    t, quantile, V = _UNIT * summary["t"].values, summary["quantile"].values, summary["V_quantiles"].values
    quantile_bands(left, t, quantile, V, "median")
    left.set(xlabel=scaled("t", _EXPONENT), ylabel=labelled("V"), xlim=(t[0], t[-1]))
    onset = sample["onset_time"].values
    stuck = np.isfinite(onset)
    right.hist(_UNIT * onset[stuck], bins=60, color="0.6", edgecolor="black", linewidth=0.3)
    right.set(xlabel=scaled("onset_time", _EXPONENT), ylabel=f"motions, of {onset.size}")
    if not stuck.all():
        right.set_title(f"{np.count_nonzero(~stuck)} more without onset", fontsize="small")
    return figure
