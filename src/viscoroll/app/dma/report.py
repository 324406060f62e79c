"""A fit in words."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from ...core.results import Row

#: medians of the Kramers-Kronig ratio outside of which storage and loss are said not to go together
_SOUND = (0.8, 1.25)


def card(fit: Any) -> tuple[str, list[Row]]:
    """What ``print(fit)`` shows, of a :class:`viscoroll.app.dma.Fit`."""
    span = f"omega = {fit.omega[0]:.3g} to {fit.omega[-1]:.3g} rad/s"
    return f"Prony series of {fit.prony.E.size} modes for {fit.omega.size} points, {span}", [*_rows(fit)]


def _rows(fit: Any) -> Iterator[Row]:
    prony, reached = fit.prony, "" if fit.reached else " and not reached"
    floor = "" if fit.plateau else "; the least that is allowed: the data do not determine it"
    yield Row("E", f"{fit.E:.6g} (long-time modulus, unit of the data){floor}")
    yield Row("alpha", f"{prony.alpha:.6g} (instantaneous over long-time modulus)")
    yield Row("T_ref", f"{fit.T_ref:.6g} s (the longest time)")
    misfit = f"{fit.misfit.storage:.2%} in E', {fit.misfit.loss:.2%} in E'' (rms, relative)"
    yield Row("misfit", f"{misfit}; {fit.target:.2%} was asked for{reached}")
    yield Row("E''", _together(fit.kramers_kronig.median))
    yield Row("outside", _outside(fit))
    if fit.shifts is not None:
        held = zip(fit.shifts.temperature, fit.shifts.a_T, strict=True)
        factors = ", ".join(f"{T:g} C {np.log10(a):+.3f}" for T, a in held)
        yield Row("shifts", f"to {fit.shifts.reference:g} C, log10 a_T: {factors}")
        if np.isfinite(fit.shifts.mismatch).any():
            most = np.nanmax(fit.shifts.mismatch)
            yield Row("", f"neighbouring curves differ by up to {most:.2%} where they overlap (rms)")
    yield Row("wider", "with a grid of times wider on either side beside these, two a decade, none left out:")
    for other in fit.wider:
        ratios = f"E times {other.E / fit.E:.4g}, alpha times {other.alpha / prony.alpha:.4g}"
        change = f"M changes by up to {other.M_change:.2%} at speeds inside the data"
        yield Row("", f"by {other.decades:g} decade{'s' * (other.decades != 1)}: {ratios}, {change}")
    yield Row("modes", "E_i/E      tau_i, s")
    for E, tau, out in zip(prony.E, prony.tau * fit.T_ref, fit.outside, strict=True):
        yield Row("", f"{E:<10.4g} {tau:<10.4g}{' outside the data' if out else ''}")


def _together(median: float) -> str:
    """One sentence on storage and loss."""
    if np.isnan(median):
        return "cannot be held against E': too few different frequencies (Kramers-Kronig)"
    text = f"is {median:.2f} times what the slope of E' allows (Kramers-Kronig, median)"
    sound = _SOUND[0] <= median <= _SOUND[1]
    return text + ("" if sound else ": storage and loss do not go together, or the spectrum is of few narrow modes")


def _outside(fit: Any) -> str:
    if not (count := int(fit.outside.sum())):
        return "no mode lies outside the data's range of 1/omega"
    share = float(fit.prony.E[fit.outside].sum() / (fit.prony.alpha - 1.0))
    which = f"{count} of {fit.prony.E.size} modes, {share:.1%} of the sum of strengths"
    return f"{which}, lie outside the data's range of 1/omega"
