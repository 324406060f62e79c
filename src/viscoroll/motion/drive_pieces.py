"""Functions of time that act on motions, as piecewise polynomials: :class:`Piecewise`.

A piece lasts from ``starts`` to ``ends``.  In it x runs from -1 to 1, and the value is the sum of
terms[n] x^n.  A piece without length does not act; in the last piece, which has no end, the
function is constant.  All is dimensionless.  T_ref is the unit of time: T_epsilon of a material
that is an alpha, the ``T_ref`` of any other material.

**Fit of a callable.**  The whole time is halved into pieces until a polynomial fits each, and a
piece is joined to the one before it where one polynomial fits both.  A fit is good where it agrees
with the callable between its nodes, and at samples spread over the
whole time, which find narrow pulses: a thousand, or as many as ``resolve`` requires.

It may differ by a part of the largest value so far, or by a small part of the largest value at all:
a callable that rises from nearly nothing, as a Gauss pulse does, would otherwise never be fitted.
Before it has risen to that level the fit is 0, since an error of the wrong sign would start a
motion from rest in the wrong direction.

Halving leaves pieces of 1/2, 1/4, 1/8, ... on either side of a corner; joined they are one to the
left and one to the right, which meet in it.  A jump is located between two neighbouring doubles.
"""

import dataclasses
import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial.polynomial import polyval

from ..core import Floats, NDArray, Schedule, check_array, require_time_argument, shape_error
from ..kernels.numerics.interpolation import powers_of_chebyshev
from .motion_arguments import dimensionless_error

#: Terms of a polynomial.
TERMS = 14
#: Samples of a callable over the whole time, without ``resolve``: a pulse of a thousandth of the
#: motion is seen.
SAMPLES = 1000
#: Largest number of values taken of a callable: some tenths of a second for a cheap one.
MOST = 500_000
#: Error allowed to a fit, divided by rtol of the motion: small beside the error of the integrator.
_SHARE = 0.1
#: Level below which errors are not compared with values so far, divided by the largest value of
#: all.
_FOOT = 1e-9
#: Level up to which a callable that has not risen yet counts as 0, divided by the error allowed
#: there.
_ZERO_LEVEL = 1e3
#: Part of a piece within which a callable that rises from 0 must have risen: else the piece is cut
#: where it rises.
_RISE = 1e-5
#: Roundings of the largest value that a fit may show.
_ROUNDINGS = 8.0
#: Roundings of the time whose effect on the values a fit may show.
_TIME_ROUNDINGS = 8.0
#: Smallest length of a piece that is halved, in spacings of doubles.
_LEAST_SPACINGS = 64
#: Ratio of the neighbours' lengths to that of a piece at which the piece is taken to contain a
#: corner.
_SHORTER = 50.0
#: Nodes of a piece in [-1, 1], its ends among them so that pieces meet, and points between them to
#: compare at.
_POINTS = -np.cos(np.pi * np.arange(2 * TERMS - 1) / (2 * TERMS - 2))
_POINTS[TERMS - 1] = 0.0
#: Matrix from values at the nodes to Chebyshev coefficients, by the orthogonality of the
#: polynomials at the nodes.
_TO_SERIES = np.polynomial.chebyshev.chebvander(_POINTS[::2], TERMS - 1) * (2.0 / (TERMS - 1))
_TO_SERIES[[0, -1]] *= 0.5
_TO_SERIES[:, [0, -1]] *= 0.5
#: Matrix from Chebyshev coefficients to those of powers.
_TO_TERMS = powers_of_chebyshev(TERMS, 0.0, 1.0)
#: Spacing of doubles at 1.
_EPSILON = float(np.finfo(float).eps)

#: Neighbouring doubles between which a piece is cut.
Cut = tuple[float, float]


class Piece(NamedTuple):
    """A polynomial of x = -1 ... 1 from ``start`` to ``stop``, in T_ref, that fits a callable;
    dimensionless.

    terms : coefficients of powers of x, ascending, (TERMS,).
    largest : largest magnitude of the callable at the points of the piece; 0 where it counts as 0.
    error : largest absolute difference seen between callable and polynomial.
    so_far : largest magnitude before the piece.
    """

    start: float
    stop: float
    terms: Floats
    largest: float
    error: float
    so_far: float

    def value(self, t: float) -> float:
        """Return the polynomial at time t, in T_ref, a float; it is extrapolated outside of the
        piece.
        """
        return float(
            polyval((2.0 * t - self.start - self.stop) / (self.stop - self.start), self.terms)
        )


@dataclasses.dataclass
class _Sampled:
    """A callable with its samples, evenly spread over the whole time; dimensionless, times in
    T_ref.

    Raises ParameterError for samples that are no finite numbers or below ``low``.  Exceptions of
    the function pass.

    name, function, low : name of the argument, for refusals; the callable; the smallest value
    allowed.
    share : error allowed, divided by the largest value so far.
    times, samples : times of the samples and values there, (samples,), at least one.
    taken : number of values taken so far.
    largest : largest magnitude seen.
    """

    name: str
    function: Callable[[float], Any]
    low: float
    share: float
    times: Floats
    taken: int = 0

    def __post_init__(self) -> None:
        self.samples = self.values(self.times)
        self.largest = float(np.abs(self.samples).max())

    def values(self, t: Floats) -> Floats:
        """Return the values of the callable, dimensionless, in the shape of ``t``; they count in
        ``taken``.

        t: times, (n,), in T_ref.
        Raises ParameterError for a value that is no finite number, no single number, or below the
        smallest value allowed.  Exceptions of the callable pass.
        """
        self.taken += t.size
        values = check_array(
            f"{self.name}(t)", [self.function(x) for x in t.tolist()], low=self.low
        )
        if values.shape != t.shape:
            raise shape_error(f"{self.name}(t)", values.shape[1:], "a number")
        return values

    def value(self, t: float) -> float:
        """Return the value at a time t, in T_ref, a float; it counts in ``taken``.  Raises as
        :meth:`values`.
        """
        return float(self.values(np.array([t]))[0])

    def fit(self, start: float, stop: float, so_far: float) -> tuple[Piece | None, Cut | None]:
        """Fit the callable between two times by one polynomial.

        It passes through the values at 14 Chebyshev nodes, and is good if it agrees with the
        callable to the error allowed at these, at points between them and at the samples.
        ``largest`` and ``taken`` are updated.

        start, stop: ends of the piece, start <= stop, in T_ref.
        so_far: largest magnitude of the callable before the piece, dimensionless; 0: it has not
        risen yet.
        Returns (piece, cut).  ``piece`` is the :class:`Piece` if the fit is good, and None if it is
        not; its polynomial is 0 where no value exceeds the error allowed, or, before the callable
        has risen, a thousand times the least error allowed.  ``cut`` says where to divide the
        interval if the fit is not good: between two neighbouring doubles, in T_ref, where the
        callable first rises from 0 or where it jumps; None: in the middle.  With a piece it is
        None.
        Raises as :meth:`values`.
        """
        middle = 0.5 * (start + stop)
        half = 0.5 * (stop - start)
        t = middle + half * _POINTS
        # the ends exactly, as a callable may jump beside them
        t[0] = start
        t[-1] = stop
        if so_far == 0.0:
            t = np.append(t, start + _RISE * (stop - start))
        values = self.values(t)
        part = slice(*np.searchsorted(self.times, [start, stop]))
        # every other point is a node of the fit; those between, and the samples, only compare
        nodes = values[: _POINTS.size : 2]
        t = np.append(t, self.times[part])
        values = np.append(values, self.samples[part])
        order = np.argsort(t, kind="stable")
        t = t[order]
        values = values[order]
        sizes = np.abs(values)
        largest = float(sizes.max())
        self.largest = max(self.largest, largest)
        least = max(self.share * _FOOT, _ROUNDINGS * _EPSILON) * self.largest
        zero = _ZERO_LEVEL * least if so_far == 0.0 else max(self.share * so_far, least)
        piece = Piece(
            start=start, stop=stop, terms=np.zeros(TERMS), largest=0.0, error=largest, so_far=so_far
        )
        if largest <= zero:
            return piece, None
        # still 0 at the start and at the point _RISE after it: cut where it rises
        if so_far == 0.0 and sizes[:2].max() <= zero:
            n = np.argmax(sizes > zero)
            return None, _bisect(t[n - 1], t[n], lambda time: abs(self.value(time)) <= zero)
        allowed = np.maximum(self.share * np.maximum(np.maximum.accumulate(sizes), so_far), least)
        # The effect of the rounding of t on the values is no error of the fit.
        rounding = float(np.spacing(stop))
        allowed += _TIME_ROUNDINGS * rounding / max(half, rounding) * np.ptp(values)
        # Values are fitted about the first one: terms are large and of both signs, and would
        # magnify its rounding.  The bits do not depend on numpy's library of linear algebra.
        series = np.einsum("i,ij->j", nodes - nodes[0], _TO_SERIES)
        terms = np.einsum("i,ij->j", series, _TO_TERMS)
        terms[0] += nodes[0]
        # half is 0 where the motion has no duration: all points are then x = 0
        error = np.abs(polyval((t - middle) / (half or 1.0), terms) - values)
        if (error <= allowed).all():
            return piece._replace(terms=terms, largest=largest, error=float(error.max())), None
        return None, self._locate_jump(t, values, float(allowed[-1]))

    def _locate_jump(self, t: NDArray, values: NDArray, allowed: float) -> Cut | None:
        """Return the neighbouring doubles between which the callable jumps.

        t, values: ascending times of a piece, in T_ref, and the values there, dimensionless, (n,),
        n >= 2.
        allowed: absolute error of a fit allowed at the end of the piece, dimensionless; a change up
        to it is no jump.
        Returns (last time before the jump, first time after it), in T_ref.  Returns None unless the
        largest change between two neighbouring times exceeds ``allowed`` and half of the sum of all
        changes, and more than half of it is left where the interval has shrunk to two neighbouring
        doubles.  Raises as :meth:`values`.
        """
        change = np.abs(np.diff(values))
        n = change.argmax()
        if change[n] <= allowed or 2.0 * change[n] <= change.sum():
            return None
        ends = values[n : n + 2].tolist()

        def is_before(time: float) -> bool:
            """Return whether the value at a time is nearer to that before the jump than to that
            after it.

            The nearer of the two values is replaced by it, for the next call.
            time: between the two times, in T_ref.
            """
            value = self.value(time)
            before = abs(value - ends[0]) < abs(ends[1] - value)
            ends[0 if before else 1] = value
            return before

        cut = _bisect(t[n], t[n + 1], is_before)
        return cut if 2.0 * abs(ends[1] - ends[0]) > change[n] else None


def _bisect(low: float, high: float, is_before: Callable[[float], bool]) -> Cut:
    """Return the neighbouring doubles between which a condition of time becomes false, found by
    halving the interval.

    low, high: times, low < high, in T_ref: the condition is true at ``low`` and false at ``high``.
    is_before: function of a time, in T_ref, that returns whether the change comes after it.  It is
    not called at ``low`` and ``high``.
    Returns (last time before the change, first time after it), in T_ref; (low, high) if these are
    neighbours already.
    """
    low = float(low)
    high = float(high)
    while low < (middle := 0.5 * (low + high)) < high:
        low, high = (middle, high) if is_before(middle) else (low, middle)
    return low, high


def fit_callable(
    name: str,
    function: Callable[[float], Any],
    end: float,
    rtol: float,
    low: float,
    resolve: float | None,
) -> "Piecewise":
    """Fit a callable by piecewise polynomials, so that the integrator never calls it.

    name: name of the argument, for errors.
    function: takes the time in T_ref, returns a dimensionless number.
    end: last time, >= 0, in T_ref.
    rtol: relative tolerance of the motion.  The fit may differ by a tenth of it times the largest
    magnitude so far; below 1e-9 of the largest magnitude of all it is not compared with values so
    far, and it is 0 there until the callable has risen.
    low: smallest value allowed, in the unit of the values of the function.
    resolve: largest spacing of the samples, > 0, in T_ref; None, and at most: ``end`` divided by
    :data:`SAMPLES`.
    Returns the :class:`Piecewise`, which after ``end`` is constant.
    Raises ParameterError for values that are no finite numbers or below ``low``; a ``resolve`` that
    requires more than :data:`MOST` samples; a callable of which :data:`MOST` values beside these
    are not enough, or that is not smooth within the shortest piece.  Exceptions of the callable
    pass.
    """
    samples = SAMPLES
    if resolve is not None:
        if resolve * MOST < end:
            raise dimensionless_error(
                "resolve",
                "resolve = {}: must be at least {}: "
                f"at most {MOST} samples up to t = {{}} are taken",
                "t",
                resolve,
                end / MOST,
                end,
            )
        samples = max(math.ceil(end / resolve), SAMPLES)
    # at the middle of as many equal parts of the time
    times = end * (np.arange(samples) + 0.5) / samples
    sampled = _Sampled(name=name, function=function, low=low, share=_SHARE * rtol, times=times)
    pieces = _merge_corners(_fit_pieces(sampled, end), sampled)
    starts = np.array([*(piece.start for piece in pieces), end])
    starts[0] = 0.0  # a jump there leaves one value before it
    # a last piece, constant, with the value of the fit at x = 1
    terms = np.zeros((starts.size, TERMS))
    terms[:-1] = [piece.terms for piece in pieces]
    terms[-1, 0] = terms[-2].sum()
    return Piecewise(starts[None], terms[None], max(piece.error for piece in pieces), starts.size)


def _fit_pieces(sampled: _Sampled, end: float) -> list[Piece]:
    """Fit a callable by pieces as long as the tolerance allows: no two neighbours could be one.

    sampled: the callable, a :class:`_Sampled`; more values of it are taken, which changes ``taken``
    and ``largest``.
    end: last time, in T_ref.
    Returns the pieces from 0 to ``end``, at least one, in the order of time.  Each starts where the
    one before it stops, or, at a jump, at the next double; the first starts at 0, or, where the
    callable jumps there, at the smallest double above 0.
    Raises ParameterError where a piece of the shortest length (64 spacings of doubles) is not
    fitted, or where more than :data:`MOST` values beside the samples were taken before all is
    fitted, and as :meth:`_Sampled.values`.
    """
    pieces: list[Piece] = []
    failed: set[tuple[float, float]] = set()
    open_intervals = [(0.0, end)]
    so_far = 0.0
    while open_intervals:
        start, stop = open_intervals.pop()
        piece, cut = sampled.fit(start, stop, so_far)
        if piece is not None:
            # one polynomial for both, unless it was tried and failed as an interval that was then
            # halved
            if pieces and (pieces[-1].start, stop) not in failed:
                joined, _ = sampled.fit(pieces[-1].start, stop, pieces[-1].so_far)
                if joined is not None:
                    piece = joined
                    pieces.pop()
            pieces.append(piece)
            so_far = max(so_far, piece.largest)
            continue
        failed.add((start, stop))
        if sampled.taken - sampled.times.size > MOST or (
            cut is None and stop - start <= _LEAST_SPACINGS * np.spacing(stop)
        ):
            raise dimensionless_error(
                sampled.name,
                f"{sampled.name} is a function of t that could not be approximated near t = {{}}, "
                f"although it was called {sampled.taken} times: must be smooth except for "
                "jumps and corners, or be given as a Schedule",
                "t",
                start,
            )
        # at a cut the parts end and begin at neighbouring doubles, else both in the middle; the
        # left part is put last, to be fitted first, as ``so_far`` needs the order of time
        left, right = cut or (0.5 * (start + stop),) * 2
        open_intervals += [part for part in ((right, stop), (start, left)) if part[0] < part[1]]
    return pieces


def _merge_corners(pieces: list[Piece], sampled: _Sampled) -> list[Piece]:
    """Return the pieces without the short ones that contain a corner; their neighbours are extended
    to the corner.

    A piece that is more than 50 times shorter than both of its neighbours is taken to contain a
    corner, at the time at which the polynomials of the neighbours are equal, else in its middle
    (:func:`_intersection`).  The two neighbours are fitted anew and meet in the corner.  The first
    and the last piece stay.

    pieces: consecutive :class:`Piece` of the fit, in the order of time.
    sampled: the callable, a :class:`_Sampled`; more values of it are taken, which changes ``taken``
    and ``largest``.
    Returns a new list; a short piece and its neighbours stay as they are where a fit to the corner
    is not good.
    Raises as :meth:`_Sampled.values`.
    """
    merged: list[Piece] = []
    rest = pieces[::-1]  # a stack: the next piece is its last
    while rest:
        piece = rest.pop()
        if merged and rest:
            before = merged[-1]
            after = rest[-1]
            if _SHORTER * (piece.stop - piece.start) < min(
                before.stop - before.start, after.stop - after.start
            ):
                corner = _intersection(before, after, piece)
                # the tolerances are those of the largest value before each piece
                left, _ = sampled.fit(before.start, corner, before.so_far)
                right, _ = sampled.fit(corner, after.stop, piece.so_far)
                if left and right:
                    merged[-1] = left
                    rest[-1] = right
                    continue
        merged.append(piece)
    return merged


def _intersection(before: Piece, after: Piece, between: Piece) -> float:
    """Return the time, within a piece, at which the polynomials of its neighbours are equal: where
    a corner lies.

    before, after: :class:`Piece`, the piece before it and the piece after it, whose polynomials are
    extended over it.
    between: :class:`Piece`, the piece.
    Returns the time, in T_ref; the middle of the piece where the same polynomial is the larger one
    at both of its ends.
    """

    def is_above(t: float) -> bool:
        return before.value(t) > after.value(t)

    low = between.start
    high = between.stop
    above_at_end = is_above(high)
    if is_above(low) == above_at_end:
        return 0.5 * (low + high)
    return _bisect(low, high, lambda t: is_above(t) != above_at_end)[1]


# --- Numbers, schedules and fits as pieces ---


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

    def take(self, index: Any) -> "Piecewise":
        """Return the function of some of the motions; what is the same for all motions stays.

        index: index of numpy, a slice or a vector of integers, that selects the motions.
        """
        starts, terms = (a[index] if len(a) > 1 else a for a in (self.starts, self.terms))
        return self._replace(starts=starts, terms=terms)


def piecewise(
    name: str, function: Any, end: float, rtol: float, *, low: float, resolve: float | None
) -> Piecewise:
    """Return a function of time that acts on motions as piecewise polynomials, checked.

    A schedule is linear between its times and constant outside; a callable is fitted.

    name: name of the argument, for refusals.
    function: a number, an array with one for each motion, a :class:`Schedule`, or a callable of t;
    dimensionless, times in T_ref, the unit of time (module docstring).
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
    if callable(function):
        require_time_argument(name, function)
        return fit_callable(name, function, end, rtol, low, resolve)
    if isinstance(function, Schedule):
        check_array(f"values of {name}", function.values, low=low)
        return _follow_corners(*np.atleast_2d(function.times, function.values))
    values = check_array(name, function, low=low)
    if values.ndim > 1:
        raise shape_error(
            name,
            values.shape,
            "a number, or an array (n,) with one number for each motion",
        )
    return Piecewise(np.zeros((1, 1)), values.reshape(-1, 1, 1))


def _follow_corners(times: Floats, values: Floats) -> Piecewise:
    """Return the :class:`Piecewise` of a schedule, linear between its times and constant outside.

    times, values: corners, (1 or m, k) each, times ascending, in T_ref; values dimensionless.
    """
    # constant before the first corner and after the last; in a piece the mean of both ends, and x
    # times half of their difference
    values = np.pad(values, [(0, 0), (1, 1)], mode="edge")
    terms = 0.5 * np.stack([values[:, 1:] + values[:, :-1], np.diff(values)], axis=-1)
    terms = np.broadcast_to(terms, (max(len(times), len(terms)), *terms.shape[1:]))
    starts = np.pad(times, [(0, 0), (1, 0)])
    # without pieces that have no length for any motion, as at a first corner at t = 0
    kept = (ends_of(starts) > starts).any(axis=0)
    return Piecewise(starts[:, kept], terms[:, kept], corners=times.shape[1])


def ends_of(starts: Floats) -> Floats:
    """Return the ends of pieces that follow one another, (m, k), from their starts, (m, k)."""
    return np.pad(starts[:, 1:], [(0, 0), (0, 1)], constant_values=np.inf)
