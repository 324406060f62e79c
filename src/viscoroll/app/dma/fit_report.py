"""The lines that ``print`` shows of a fit.

Of the argument ``fit``, a :class:`.fit_results.SeriesFit`, the functions read the public attributes alone.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from ...core.results import SummaryRow
from .master_curve import undetermined_shifts

#: range of the median of the Kramers-Kronig ratio of data in which storage and loss go together
_CONSISTENT = (0.8, 1.25)
#: Poisson's ratio of the factor that the report gives of shear: the default of material()
_NU = 0.49


def summarize_fit(fit: Any) -> tuple[str, list[SummaryRow]]:
    """Return the title and the lines that ``print(fit)`` shows.

    fit : a :class:`viscoroll.app.dma.fit_results.SeriesFit`.
    Returns (title, a sentence with the number of modes and of measured points and the range of omega or t; the lines
    below, a list of :class:`SummaryRow` in order).  The first call computes ``fit.admissible``.
    """
    low, high = fit.band
    of_time = fit.data._fields[0] == "t"
    span = f"t = {1.0 / high:.3g} to {1.0 / low:.3g} s" if of_time else f"omega = {low:.3g} to {high:.3g} rad/s"
    rows = [SummaryRow(*row) for row in _rows(fit)]
    return f"Prony series of {fit.prony.E.size} modes for {fit.points} points, {span}", rows


def _rows(fit: Any) -> Iterator[tuple[str, str]]:
    """Yield the lines of the report below its title, each as (name, text).

    They are: constants (with the factor to Young's modulus where the data are of shear, and the temperature where it is
    known), thinning where points were thinned, misfit, the lines of this kind of fit, modes outside the data, accuracy
    of M, and the table of modes with strengths divided by the long-time modulus and times in s.

    fit : a :class:`viscoroll.app.dma.fit_results.SeriesFit`.
    Yields pairs (name, text); name is "" of a line that continues the one before.
    """
    prony, symbol = fit.prony, symbol_of(fit)
    floor = "" if fit.plateau else "; at its lower bound: the data do not determine it"
    yield symbol, f"{fit.E:.6g} (long-time modulus, unit of the data){floor}"
    if fit.mode == "shear":
        factor = f"{2.0 * (1.0 + _NU):.4g} G at nu = {_NU:g}"
        yield "shear", f"shear data: material(nu=) uses E = 2 (1 + nu) G, {factor}"
    yield "alpha", f"{prony.alpha:.6g} (instantaneous modulus divided by long-time modulus)"
    yield "T_ref", f"{fit.T_ref:.6g} s (the longest time)"
    if fit.temperature is not None:
        yield "temperature", f"{fit.temperature:g} C, the temperature of these times"
    if fit.points > fit.data[0].size:
        yield "thinned", f"the means of {fit.data[0].size} logarithmic bins replace the points, here and below"
    target = f"target {fit.target:.2%}{'' if fit.reached else ', not reached'}"
    yield "misfit", f"{fit.misfit_text(2)} (rms, relative); {target}"
    yield from _of_relaxation(symbol) if fit.data._fields[0] == "t" else _of_dynamic(fit, symbol)
    yield "outside", _outside(fit)
    found = fit.admissible
    ends = ", ".join(f"+-{found.error[n]:.2%}" for n in ((0, found.rate.size // 2, -1) if found.rate.size else ()))
    where = "at the lowest, middle and highest speed inside the measured band"
    yield "accuracy", f"M: {ends or 'no speed'}, {where}, by all spectra that meet the data as well"
    if found.rate.size:
        (low, high), (least, most) = ((part.min(), part.max()) for part in (found.E / fit.E, found.alpha / prony.alpha))
        yield (
            "",
            f"among them {symbol} changes by factors of {low:.3g} to {high:.3g}, alpha of {least:.3g} to {most:.3g}",
        )
    yield "modes", f"{symbol}_i/{symbol}      tau_i, s"
    for E, tau, out in zip(prony.E, prony.tau * fit.T_ref, fit.outside, strict=True):
        yield "", f"{E:<10.4g} {tau:<10.4g}{' outside the data' if out else ''}"


def symbol_of(fit: Any) -> str:
    """Return the symbol of the modulus of a ``fit``: "G" where ``fit.mode`` is "shear", else "E"."""
    return "G" if fit.mode == "shear" else "E"


def _of_dynamic(fit: Any, symbol: str) -> Iterator[tuple[str, str]]:
    """Yield the lines of the report on the consistency of storage and loss modulus, and on the shifts of a master
    curve, each as (name, text).

    They are one on Kramers-Kronig; of curves at two or more temperatures also the shift factors, a line where
    temperatures were combined into fewer curves, the largest mismatch of neighbours where shifts were found by their
    overlap, and a line for each shift that the overlap leaves open.

    fit : a :class:`viscoroll.Fit`.
    symbol : "E" or "G".
    """
    yield f"{symbol}''", _kramers_kronig(fit.kramers_kronig.median, symbol)
    if (shifts := fit.shifts) is None or len(shifts.temperature) < 2:
        return
    factors = ", ".join(f"{T:.4g} C {np.log10(a):+.3f}" for T, a in zip(shifts.temperature, shifts.a_T, strict=True))
    yield "shifts", f"to {shifts.reference:g} C, log10 a_T: {factors}"
    count = len(shifts.temperature)
    if shifts.distinct > count:
        yield "", f"{shifts.distinct} temperatures, within 0.5 K of one another, were combined into {count}"
    if np.isfinite(shifts.mismatch).any():
        most = np.nanmax(shifts.mismatch)
        yield "", f"neighbouring curves differ by up to {most:.2%} where they overlap (rms)"
    for pair in undetermined_shifts(shifts):
        yield "", f"the overlap does not determine the shift {pair}: the curves are flat there"


def _of_relaxation(symbol: str) -> Iterator[tuple[str, str]]:
    """Yield the line of the report on the error of the loss modulus of a fit of relaxation, as (name, text).

    symbol : "E" or "G".
    """
    yield "", f"{symbol}'' follows from the slope of {symbol}(t); its error is ten times larger or more"


def _kramers_kronig(median: float, symbol: str) -> str:
    """Return a sentence on whether storage and loss modulus can be of one material.

    median : median of the Kramers-Kronig ratio, measured over computed loss modulus, dimensionless; NaN where it could
        not be computed.
    symbol : "E" or "G".
    Returns a text without a subject, which follows the symbol of the loss modulus.  It warns of a median outside of
    0.8 to 1.25, and of NaN says that there are too few frequencies.
    """
    if np.isnan(median):
        return f"cannot be compared with {symbol}': too few different frequencies (Kramers-Kronig)"
    text = f"is {median:.2f} times the value from the slope of {symbol}' (Kramers-Kronig, median)"
    sound = _CONSISTENT[0] <= median <= _CONSISTENT[1]
    return text + ("" if sound else ": storage and loss modulus are inconsistent, or the spectrum has few narrow modes")


def _outside(fit: Any) -> str:
    """Return a sentence on the modes whose times lie outside the data, with their share of the sum of all strengths.

    Where there are none, the sentence says so; so it does of a series without modes.

    fit : a :class:`viscoroll.app.dma.fit_results.SeriesFit`.
    """
    range_of = f"the data's range of {'times' if fit.data._fields[0] == 't' else '1/omega'}"
    if not (count := int(fit.outside.sum())):
        return f"no mode lies outside {range_of}"
    share = float(fit.prony.E[fit.outside].sum() / (fit.prony.alpha - 1.0))
    which = f"{count} of {fit.prony.E.size} modes, {share:.1%} of the sum of strengths"
    return f"{which}, lie outside {range_of}"
