"""What acts over time, as pieces that are polynomials: numbers, schedules, callables, feedback.

A piece runs from ``starts`` to ``ends``; in it x = -1 ... 1 and the value is sum terms[n] x^n.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.checks import checked
from ..core.drive import Feedback, Schedule, refuse_more_than_t
from ..core.errors import ParameterError
from ..core.typed import Floats
from ..kernels.motion.records import COL_COEFFICIENTS, COL_SCALE, COL_START
from .fitted import fitted

#: of the values of a piece, its first one where that is rounding
_ROUNDING = 1e-14
#: duration of a piece that counts as none: the scale of its time, 2 over it and over gamma, is to be finite
_INSTANT = 1e-280
#: the same of the slope of a piece
_ROUNDING_OF_SLOPE = 1e-12


class Curve(NamedTuple):
    """A function of time of one motion or m: starts (m, k), the last piece without end; terms (m, k, terms).

    What is the same for all has one row.  Where motions have times of their own, pieces may have no length.
    error : the largest difference seen between a callable and its fit.
    """

    starts: Floats
    terms: Floats
    error: float = 0.0

    @property
    def ends(self) -> Floats:
        """Of the pieces."""
        return _ends(self.starts)


class Corners(NamedTuple):
    """A function of time, linear between corners: times (k,) or (m, k), values (k,) or (m, k), of m motions."""

    times: Floats
    values: Floats


#: What acts over time, checked: a number or one a motion, corners, or the polynomials that follow a callable.
Course = Floats | Corners | Curve


def course(
    name: str, given: Any, end: float, rtol: float, *, low: float = -np.inf, resolve: float | None = None
) -> Course:
    """The function of time that is ``given``, checked, and if it is a callable fitted up to ``end``.

    Parameters
    ----------
    name : of the argument, for refusals.
    given : None (0), a number, one a motion, a Schedule, a callable of t, or a Feedback of one of these, of which the
        gains are left aside.
    end : the last time.
    rtol : tolerance of the motion, of which the fit of a callable takes a tenth.
    low : the least value allowed.
    resolve : as of :func:`viscoroll.roll`.

    Raises
    ------
    ParameterError
        What is neither a number, a schedule nor a callable; values that are not finite or below ``low``, a callable
        that polynomials do not follow.
    """
    if isinstance(given, Feedback):
        given = given.value
    if callable(given):
        refuse_more_than_t(name, given)
        starts, terms, error = fitted(name, given, end, rtol, low, resolve)
        after = np.zeros((1, terms.shape[1]))
        after[0, 0] = terms[-1].sum()
        return Curve(np.append(starts, end)[None], np.concatenate([terms, after])[None], error)
    if isinstance(given, Schedule):
        return Corners(given.times, checked(f"values of {name}", given.values, low=low))
    values = checked(name, 0.0 if given is None else given, low=low)
    if values.ndim > 1:
        raise ParameterError(
            name, f"array of shape {values.shape}", "a number, one a motion, or a Schedule(times, values)"
        )
    return values


def motions_of(given: Course) -> int:
    """Number of motions that a course tells apart; 1 if it is the same for all."""
    if isinstance(given, Curve):
        return len(given.terms)
    if isinstance(given, Corners):
        return max(len(array) for array in map(np.atleast_2d, given))
    return given.size


def of_some(given: Course, chosen: Any) -> Course:
    """The course of the ``chosen`` motions, an index of numpy; itself where it is the same for all."""
    if isinstance(given, Curve) or motions_of(given) == 1:
        return given
    if isinstance(given, Corners):
        return Corners(*(array[chosen] if array.ndim == 2 and len(array) > 1 else array for array in given))
    return given[chosen]


def curve(given: Course) -> Curve:
    """A course as polynomials over pieces of time."""
    if isinstance(given, Curve):
        return given
    if isinstance(given, Corners):
        return _linear(*given)
    return Curve(np.zeros((1, 1)), given.reshape(-1, 1, 1))


def _linear(times: Floats, values: Floats) -> Curve:
    """Linear between times, constant outside; a time given twice is a jump."""
    times, values = np.atleast_2d(times, values)
    values = np.pad(values, [(0, 0), (1, 1)], mode="edge")
    first, second = values[:, :-1], values[:, 1:]
    terms = np.stack([0.5 * (first + second), 0.5 * (second - first)], axis=-1)
    terms = np.broadcast_to(terms, (max(len(times), len(terms)), *terms.shape[1:]))
    starts = np.pad(times, [(0, 0), (1, 0)])
    kept = (_ends(starts) > starts).any(axis=0)
    return Curve(starts[:, kept], terms[:, kept])


def _ends(starts: Floats) -> Floats:
    """Of pieces one after another."""
    return np.pad(starts[:, 1:], [(0, 0), (0, 1)], constant_values=np.inf)


def slope_of(name: str, speed: Curve) -> Curve:
    """The slope over t of a prescribed speed, which must not jump."""
    lengths = speed.ends - speed.starts
    first, last = at_start(speed.terms), speed.terms.sum(axis=-1)
    # of each motion: one that is slow beside the others must not jump either
    scale = np.maximum(np.abs(speed.terms).max(axis=(1, 2), initial=0.0), 1e-300)[:, None]
    least = 1e-12 * scale + 4.0 * speed.error
    jumps = (lengths == 0.0) & (np.abs(last - first) > least)  # of pieces without length
    jumps[:, 1:] |= np.abs(last[:, :-1] - first[:, 1:]) > least
    if jumps.any():
        at = np.broadcast_to(speed.starts, jumps.shape)[jumps][0]
        raise ParameterError(name, f"a jump at t = {at:.6g}", "a speed that does not jump")
    order = np.arange(1, speed.terms.shape[-1])
    per = np.divide(2.0, lengths, out=np.zeros_like(lengths), where=lengths > 0.0)
    terms = speed.terms[..., 1:] * order * per[..., None]
    return speed._replace(terms=_from_zero(terms, _ROUNDING_OF_SLOPE) if order.size else np.zeros_like(speed.terms))


def at_start(terms: Floats) -> Floats:
    """Values at x = -1."""
    return (terms * (-1.0) ** np.arange(terms.shape[-1])).sum(axis=-1)


def _from_zero(terms: Floats, rounding: float = _ROUNDING) -> Floats:
    """Pieces that begin at 0 where their first value is rounding: by that a motion from rest would set out."""
    first, size = at_start(terms), np.abs(terms).sum(axis=-1)
    found = terms.copy()
    found[..., 0] -= np.where(np.abs(first) < rounding * size, first, 0.0)
    return found


def pieces_of(curves: tuple[Curve, ...], end: float) -> Floats:
    """All curves over common pieces up to ``end``, as the kernel takes them: (m, k, 2 + len(curves) terms).

    Where motions have times of their own, pieces between equal times have no length, and are passed over.
    """
    apart = max(len(each.starts) for each in curves)
    own = [np.broadcast_to(each.starts, (apart, each.starts.shape[1])) for each in curves]
    starts = np.sort(np.concatenate([own[0], *(part[:, 1:] for part in own[1:])], axis=1), axis=1)
    starts = starts[:, (_ends(starts) > starts + _INSTANT).any(axis=0)]
    kept = max(int((starts < end).any(axis=0).sum()), 1)
    starts, ends = starts[:, :kept], _ends(starts)[:, :kept]
    count, terms = max(len(each.terms) for each in curves), max(each.terms.shape[-1] for each in curves)
    rows, lengths = np.zeros((count, starts.shape[1], COL_COEFFICIENTS + len(curves) * terms)), ends - starts
    rows[..., COL_START] = starts
    rows[..., COL_SCALE] = np.divide(2.0, lengths, out=np.zeros(lengths.shape), where=lengths > _INSTANT)
    for n, (each, first) in enumerate(zip(curves, own, strict=True)):
        which = _piece_at(each.starts, starts)
        begin, last = (np.take_along_axis(np.broadcast_to(of, first.shape), which, 1) for of in (first, each.ends))
        which = np.broadcast_to(which, (max(apart, len(each.terms)), which.shape[1]))
        whole = np.take_along_axis(
            np.broadcast_to(each.terms, (len(which), *each.terms.shape[1:])), which[..., None], 1
        )
        same = (begin == starts) & (last == ends)
        part = np.where(same[..., None], whole, _moved(whole, begin, last, starts, ends))
        at = COL_COEFFICIENTS + n * terms
        rows[..., at : at + part.shape[-1]] = _from_zero(part)
    at_end = np.maximum((starts < end).sum(axis=1) - 1, 0)
    late = starts > np.take_along_axis(starts, at_end[:, None], axis=1)
    if late.any():  # the last acts at the end
        acting = rows[np.arange(count), np.broadcast_to(at_end, count), COL_COEFFICIENTS:]
        rows[..., COL_COEFFICIENTS:] = np.where(late[..., None], acting[:, None], rows[..., COL_COEFFICIENTS:])
    return rows


def _piece_at(begins: Floats, times: Floats) -> NDArray:
    """Number of the piece that acts at each time: the last that begins by then.

    Parameters
    ----------
    begins : (1 or m, k), when pieces begin, ascending, the first at 0.
    times : (m, n), >= 0.

    Returns
    -------
    ndarray
        (m, n), in 0 ... k - 1.  Takes memory of the order of its input, and n log k steps.
    """
    if len(begins) == 1:
        return np.searchsorted(begins[0], times, side="right") - 1
    # complex numbers are sorted by their real parts first: one search through the pieces of all motions in a row
    row = np.arange(len(begins))[:, None]
    found = np.searchsorted((row + 1j * begins).ravel(), row + 1j * times, side="right")
    return found - row * begins.shape[1] - 1


def _moved(terms: Floats, first: NDArray, last: NDArray, starts: NDArray, ends: NDArray) -> Floats:
    """Terms of pieces from ``first`` to ``last`` as those of the parts from ``starts`` to ``ends``."""
    endless = np.isinf(last) | (last == first)
    whole = np.where(endless, 1.0, last - first)
    scale = np.where(endless, 0.0, np.where(endless, 0.0, ends - starts) / whole)
    begin = (starts - first) / whole * 2.0 - 1.0
    shift = np.where(endless, 0.0, begin + scale)
    moved = np.zeros_like(terms)
    for n in range(terms.shape[-1] - 1, -1, -1):  # Horner's scheme with x -> shift + scale x
        raised = np.zeros_like(moved)
        raised[..., 1:] = moved[..., :-1] * scale[..., None]
        moved = moved * shift[..., None] + raised
        moved[..., 0] += terms[..., n]
    return moved
