"""Functions of time that act on motions, and as piecewise polynomials for the kernels.

A piece lasts from ``starts`` to ``ends``.  In it x runs from -1 to 1, and the value is the sum of
terms[n] x^n.  A piece without length does not act; in the last piece, which has no end, the
function is constant.

All is dimensionless.  T_ref is the unit of time: T_epsilon of a material that is an alpha, the
``T_ref`` of any other material.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core import (
    Feedback,
    Floats,
    Schedule,
    check_array,
    described_error,
    mark_dimensionless,
    require_time_argument,
    shape_error,
)
from ..kernels.records import COL_COEFFICIENTS, COL_SCALE, COL_START
from .drive_fit import fit_callable

#: First value of a piece divided by the size of its terms, dimensionless, that counts as rounding:
#: some 50 roundings.
_ROUNDING = 1e-14
#: The same of the slope of a piece, which the differentiation makes larger.
_ROUNDING_OF_SLOPE = 1e-12
#: Jump of a prescribed speed divided by its largest size, dimensionless, that counts as rounding.
_ROUNDING_OF_JUMP = 1e-12
#: Duration of a piece, in T_ref, that counts as none: 2 divided by it and by gamma is to be finite.
_INSTANT = 1e-280


class Piecewise(NamedTuple):
    """A piecewise polynomial function of time, the same for all motions or one for each of m;
    dimensionless.

    starts : when pieces start, (1 or m, k), in T_ref, ascending, the first at 0; the last piece has
    no end.  Pieces may have no length.
    terms : coefficients of powers of x in [-1, 1], ascending, (1 or m, k, terms); one row where the
    function is the same for all motions.
    error : largest absolute difference seen between a callable and this fit; 0 of other functions.
    corners : number of times at which an integration step must end: the corners of a schedule, the
    pieces of a fitted callable with that after the last time; 0 of numbers.
    """

    starts: Floats
    terms: Floats
    error: float = 0.0
    corners: int = 0

    @property
    def ends(self) -> Floats:
        """When the pieces end, in the shape of ``starts``."""
        return _ends(self.starts)

    def take(self, index: Any) -> Piecewise:
        """Return the function of some of the motions; what is the same for all motions stays.

        index: index of numpy, a slice or a vector of integers, that selects the motions.
        """
        starts, terms = (a[index] if len(a) > 1 else a for a in (self.starts, self.terms))
        return self._replace(starts=starts, terms=terms)


def piecewise(
    name: str,
    function: Any,
    end: float,
    rtol: float,
    *,
    low: float = -np.inf,
    resolve: float | None = None,
) -> Piecewise:
    """Return a function of time that acts on motions as piecewise polynomials, checked.

    A schedule is linear between its times and constant outside; a callable is fitted.

    name: name of the argument, for refusals.
    function: None (0), a number, an array with one for each motion, a :class:`Schedule`, a callable
    of t, or a :class:`Feedback` of one of these, whose gains are ignored; dimensionless, times in
    T_ref, the unit of time (module docstring).
    end: last time, >= 0, in T_ref; ignored but for a callable.
    rtol: relative tolerance of the motion; a fit may differ from a callable by a tenth of it, times
    the largest magnitude so far.  Ignored but for a callable.
    low: smallest value allowed, in the unit of the values of the function.
    resolve: largest spacing of the samples of a callable, in T_ref; None: a thousandth of ``end``.
    Raises ParameterError for what is neither a number, a schedule nor a callable; an array of
    several dimensions; values that are not finite or below ``low``; a callable that cannot be
    called with a time alone, or that polynomials do not follow; a ``resolve`` that requires too
    many samples.  Exceptions of the callable pass.
    Returns :class:`Piecewise`: of numbers one piece with one term, starts (1, 1) and terms (1 or m,
    1, 1); of a schedule with k corners up to k + 1 pieces with two terms, since pieces that have no
    length for any motion are left out; the fit of a callable, which beyond ``end`` keeps its value
    there.
    """
    if isinstance(function, Feedback):
        function = function.value
    if callable(function):
        require_time_argument(name, function)
        starts, terms, error = fit_callable(name, function, end, rtol, low, resolve)
        after = np.zeros((1, terms.shape[1]))
        after[0, 0] = terms[-1].sum()
        starts = np.append(starts, end)[None]
        return Piecewise(starts, np.concatenate([terms, after])[None], error, starts.size)
    if isinstance(function, Schedule):
        check_array(f"values of {name}", function.values, low=low)
        return _follow_corners(*np.atleast_2d(function.times, function.values))
    values = check_array(name, 0.0 if function is None else function, low=low)
    if values.ndim > 1:
        allowed = "a number, an array with one for each motion, or a Schedule(times, values)"
        raise shape_error(name, values.shape, allowed)
    return Piecewise(np.zeros((1, 1)), values.reshape(-1, 1, 1))


def _follow_corners(times: Floats, values: Floats) -> Piecewise:
    """Return the :class:`Piecewise` of a schedule, linear between its times and constant outside.

    times, values: corners, (1 or m, k) each, times ascending, in T_ref; values dimensionless.
    """
    values = np.pad(values, [(0, 0), (1, 1)], mode="edge")
    terms = np.empty((len(values), times.shape[1] + 1, 2))
    np.add(values[:, 1:], values[:, :-1], out=terms[..., 0])
    np.subtract(values[:, 1:], values[:, :-1], out=terms[..., 1])
    terms *= 0.5
    terms = np.broadcast_to(terms, (max(len(times), len(terms)), *terms.shape[1:]))
    starts = np.pad(times, [(0, 0), (1, 0)])
    kept = (_ends(starts) > starts).any(axis=0)
    if not kept.all():
        starts = starts[:, kept]
        terms = terms[:, kept]
    return Piecewise(starts, terms, corners=times.shape[1])


def _ends(starts: Floats) -> Floats:
    """Return the ends of pieces that follow one another, (m, k), from their starts, (m, k)."""
    return np.pad(starts[:, 1:], [(0, 0), (0, 1)], constant_values=np.inf)


def differentiate(name: str, speed: Piecewise) -> Piecewise:
    """Return the derivative with respect to time of a prescribed speed.

    name: name of the argument, for the refusal.
    speed: :class:`Piecewise`, prescribed speed, dimensionless, time in T_ref.
    Raises ParameterError where the speed jumps by more than rounding (1e-12 of its largest
    coefficient) and four times the error of its fit.
    Returns :class:`Piecewise` with the same starts, dimensionless.  It has one term less; of a
    speed of one term, which is constant, it has one term that is 0.  It is 0 in pieces without
    length or end, and its value at the left end of a piece is shifted to 0 where it is rounding.
    Its ``error`` is still that of the speed.
    """
    lengths = speed.ends - speed.starts
    first = values_at_start(speed.terms)
    last = speed.terms.sum(axis=-1)
    # for each motion by itself: a slow one must not jump either
    scale = np.maximum(np.abs(speed.terms).max(axis=(1, 2), initial=0.0), 1e-300)[:, None]
    least = _ROUNDING_OF_JUMP * scale + 4.0 * speed.error
    jumps = (lengths == 0.0) & (np.abs(last - first) > least)  # in pieces without length
    jumps[:, 1:] |= np.abs(last[:, :-1] - first[:, 1:]) > least
    if jumps.any():
        when = np.broadcast_to(speed.starts, jumps.shape)[jumps][0]
        allowed = "continuous, as it is a prescribed speed"
        raise mark_dimensionless(described_error(name, f"jumps at t = {when:.6g}", allowed))
    order = np.arange(1, speed.terms.shape[-1])
    dx_dt = np.divide(2.0, lengths, out=np.zeros_like(lengths), where=lengths > 0.0)
    terms = speed.terms[..., 1:] * order * dx_dt[..., None]
    return speed._replace(
        terms=_start_at_zero(terms, _ROUNDING_OF_SLOPE)
        if order.size
        else np.zeros_like(speed.terms)
    )


def values_at_start(terms: Floats) -> Floats:
    """Return the values at x = -1 of polynomials, (...).

    terms: coefficients of powers of x in [-1, 1], ascending, (..., terms).
    """
    return (terms * (-1.0) ** np.arange(terms.shape[-1])).sum(axis=-1)


def _start_at_zero(terms: Floats, rounding: float = _ROUNDING) -> Floats:
    """Set the value at the left end of pieces to 0 where it is rounding, as it would move a
    cylinder at rest.

    terms: coefficients of powers of x in [-1, 1], ascending, (..., terms).
    rounding: ratio of that value to the sum of the magnitudes of the coefficients below which it
    counts as rounding.
    Returns new coefficients, (..., terms).  Where the value counts as rounding it is subtracted
    from the constant coefficient; all others are the same.
    """
    first = values_at_start(terms)
    size = np.abs(terms).sum(axis=-1)
    shifted = terms.copy()
    shifted[..., 0] -= np.where(np.abs(first) < rounding * size, first, 0.0)
    return shifted


def pack_pieces(functions: tuple[Piecewise, ...], end: float) -> Floats:
    """Return several functions over common pieces, in the layout of the kernels.

    functions: piecewise polynomials, each for the same m motions, or the same for all.
    end: last time, in T_ref.  Pieces that for every motion start at or after it are left out; the
    first piece always stays.
    Returns (1 or m, k, 2 + number of functions * terms): start of each piece in T_ref; 2 divided by
    its length, 0 of one without length or end; then the coefficients of each function in turn,
    padded with 0 to the largest number of terms.  Where motions have times of their own, pieces
    between equal times have no length; the kernels skip them.  Pieces of a motion that start at or
    beyond ``end``, but are kept since other motions have them before it, repeat the coefficients of
    its last piece before ``end``.
    """
    rows = max(len(f.starts) for f in functions)
    own = [np.broadcast_to(f.starts, (rows, f.starts.shape[1])) for f in functions]
    starts = np.sort(np.concatenate([own[0], *(part[:, 1:] for part in own[1:])], axis=1), axis=1)
    starts = starts[:, (_ends(starts) > starts + _INSTANT).any(axis=0)]
    kept = max(int((starts < end).any(axis=0).sum()), 1)
    ends = _ends(starts)[:, :kept]
    starts = starts[:, :kept]
    count = max(len(f.terms) for f in functions)
    terms = max(f.terms.shape[-1] for f in functions)
    packed = np.zeros((count, kept, COL_COEFFICIENTS + len(functions) * terms))
    lengths = ends - starts
    packed[..., COL_START] = starts
    packed[..., COL_SCALE] = np.divide(
        2.0, lengths, out=np.zeros(lengths.shape), where=lengths > _INSTANT
    )
    for n, function in enumerate(functions):
        part = _restrict(function, rows, starts, ends)
        packed[..., COL_COEFFICIENTS + n * terms :][..., : part.shape[-1]] = part
    at_end = np.maximum((starts < end).sum(axis=1) - 1, 0)
    late = starts > np.take_along_axis(starts, at_end[:, None], axis=1)
    if late.any():  # the last piece before the end acts after it too
        acting = packed[np.arange(count), np.broadcast_to(at_end, count), COL_COEFFICIENTS:]
        packed[..., COL_COEFFICIENTS:] = np.where(
            late[..., None], acting[:, None], packed[..., COL_COEFFICIENTS:]
        )
    return packed


def _restrict(function: Piecewise, rows: int, starts: Floats, ends: Floats) -> Floats:
    """Return the coefficients of a function over finer pieces.

    function: :class:`Piecewise` of one motion or of m motions.
    rows: number of motions with times of their own, or 1.
    starts, ends: when the finer pieces start and end, (rows, k), in T_ref; none extends over a
    start of the function's own.  The last may end at infinity.
    Returns coefficients of powers of x in [-1, 1] on the finer pieces, (1 or m, k, terms); their
    value at the left end of a piece is shifted to 0 where it is rounding.
    """
    piece = _piece_at(function.starts, starts)
    shape = rows, function.starts.shape[1]
    first, last = (
        np.take_along_axis(np.broadcast_to(t, shape), piece, 1)
        for t in (function.starts, function.ends)
    )
    piece = np.broadcast_to(piece, (max(rows, len(function.terms)), piece.shape[1]))
    terms = np.broadcast_to(function.terms, (len(piece), *function.terms.shape[1:]))
    terms = np.take_along_axis(terms, piece[..., None], 1)
    same = (first == starts) & (last == ends)
    return _start_at_zero(
        np.where(same[..., None], terms, _substitute(terms, first, last, starts, ends))
    )


def _piece_at(begins: Floats, times: Floats) -> NDArray:
    """Return the index of the piece that acts at each time: the last that starts by then.

    begins: when pieces start, (1 or m, k), ascending, the first at 0.
    times: times in the unit of ``begins``, >= 0, (m, n); where ``begins`` has one row, m is any
    number.
    Returns indices in 0 ... k - 1, int, in the shape of ``times``.  Takes memory in proportion to
    its input, and n log k steps for each row.
    """
    if len(begins) == 1:
        return np.searchsorted(begins[0], times, side="right") - 1
    # Complex numbers are sorted by their real parts first: one search through the pieces of all
    # motions in a row.
    row = np.arange(len(begins))[:, None]
    found = np.searchsorted((row + 1j * begins).ravel(), row + 1j * times, side="right")
    return found - row * begins.shape[1] - 1


def _substitute(
    terms: Floats, first: NDArray, last: NDArray, starts: NDArray, ends: NDArray
) -> Floats:
    """Return the coefficients of polynomials on parts of their pieces, by Horner's scheme with x ->
    shift + scale x.

    terms: coefficients of powers of x in [-1, 1], ascending, (m, k, terms).
    first, last: start and end of each piece, (1 or m, k).
    starts, ends: start and end of each part, (1 or m, k), in the unit of ``first``.
    Returns the coefficients on the parts, (m, k, terms).  Of a piece without length, or without end
    (``last`` infinite), they are those of a constant: its value at x = 0.
    """
    endless = np.isinf(last) | (last == first)
    length = np.where(endless, 1.0, last - first)
    scale = np.where(endless, 0.0, (ends - starts) / length)
    shift = np.where(endless, 0.0, (starts - first) / length * 2.0 - 1.0 + scale)
    result = np.zeros_like(terms)
    for n in range(terms.shape[-1] - 1, -1, -1):
        raised = np.zeros_like(result)
        raised[..., 1:] = result[..., :-1] * scale[..., None]
        result = result * shift[..., None] + raised
        result[..., 0] += terms[..., n]
    return result
