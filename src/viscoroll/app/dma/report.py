"""A fit in words."""

from __future__ import annotations

from typing import Any

import numpy as np

#: medians of the Kramers-Kronig ratio outside of which storage and loss are said not to go together
_SOUND = (0.8, 1.25)


def report(fit: Any) -> str:
    """The report that ``print(fit)`` shows, of a :class:`viscoroll.app.dma.Fit`."""
    prony = fit.prony
    lines = [
        f"Prony series of {prony.E.size} modes for {fit.omega.size} points, omega = {_span(fit.omega)} rad/s",
        f"  E        {fit.E:.6g} (long-time modulus, unit of the data)" + _floor(fit),
        f"  alpha    {prony.alpha:.6g} (instantaneous over long-time modulus)",
        f"  T_ref    {fit.T_ref:.6g} s (the longest time)",
        f"  misfit   {fit.misfit.storage:.2%} in E', {fit.misfit.loss:.2%} in E'' (rms, relative); " + _asked(fit),
        f"  E''      {_together(fit.kramers_kronig.median)}",
        f"  outside  {_outside(fit)}",
    ]
    lines += [f"  shifts   {line}" for line in _shifts(fit)]
    lines += ["  with a grid of times wider on either side beside these, two a decade, none left out:"]
    for other in fit.wider:
        lines.append(
            f"    by {other.decades:g} decade{'s' * (other.decades != 1)}: E times {other.E / fit.E:.4g}, alpha times "
            f"{other.alpha / prony.alpha:.4g}, M changes by up to {other.M_change:.2%} at speeds inside the data"
        )
    lines += ["  modes    E_i/E      tau_i, s"]
    lines += [
        f"           {E:<10.4g} {tau * fit.T_ref:<10.4g}{' outside the data' if out else ''}"
        for E, tau, out in zip(prony.E, prony.tau, fit.outside, strict=True)
    ]
    return "\n".join(lines)


def _span(values: np.ndarray) -> str:
    return f"{values.min():.3g} to {values.max():.3g}"


def _floor(fit: Any) -> str:
    return "" if fit.plateau else "; the least that is allowed: the data do not determine it"


def _asked(fit: Any) -> str:
    return f"{fit.target:.2%} was asked for" + ("" if fit.reached else " and not reached")


def _together(median: float) -> str:
    """One sentence on storage and loss."""
    if np.isnan(median):
        return "cannot be held against E': too few different frequencies (Kramers-Kronig)"
    text = f"is {median:.2f} times what the slope of E' allows (Kramers-Kronig, median)"
    if _SOUND[0] <= median <= _SOUND[1]:
        return text
    return text + ": storage and loss do not go together, or the spectrum is of few narrow modes"


def _outside(fit: Any) -> str:
    count = int(fit.outside.sum())
    if not count:
        return "no mode lies outside the data's range of 1/omega"
    share = float(fit.prony.E[fit.outside].sum() / (fit.prony.alpha - 1.0))
    which = f"{count} of {fit.prony.E.size} modes, {share:.1%} of the sum of strengths"
    return f"{which}, lie outside the data's range of 1/omega"


def _shifts(fit: Any) -> list[str]:
    if fit.shifts is None:
        return []
    held = zip(fit.shifts.temperature, fit.shifts.a_T, strict=True)
    lines = [f"to {fit.shifts.reference:g} C, log10 a_T: " + ", ".join(f"{T:g} C {np.log10(a):+.3f}" for T, a in held)]
    if np.isfinite(fit.shifts.mismatch).any():
        lines.append(
            f"neighbouring curves differ by up to {np.nanmax(fit.shifts.mismatch):.2%} where they overlap (rms)"
        )
    return lines
