"""A callable of time as polynomials: a piece is halved until it is good, and joined to the last one where one will do.

A piece is good where the callable is met between its nodes, and at looks spread over the whole time, which find what is
narrow: a thousand, or as many as ``resolve`` asks for.

It may be off by a share of the largest value so far, or of the foot, a small part of the largest of all: what
rises from next to nothing, as a Gauss pulse does, would else never be met.  Before it has risen to that it is 0: the
sign of what is off would set a motion from rest out the wrong way.

Halving leaves pieces of 1/2, 1/4, 1/8, ... on either side of a corner; joined they are one to the left and one to the
right, which meet in it.  A jump is followed down to the two neighbouring numbers that it lies between, where what is
steep but smooth hardly changes.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import chebyshev
from numpy.polynomial.polynomial import polyval
from numpy.typing import NDArray

from ..core.array_types import Floats
from ..core.checks import check_array, check_number
from ..core.errors import ParameterError
from ..kernels.numerics.interpolation import powers_of_chebyshev

#: terms of a polynomial, looks at a callable, values taken of it at most
TERMS, LOOKS, MOST = 14, 1000, 500_000
#: share of the tolerance of the motion that a fit may be off; part of the largest value of all that is the foot
_SHARE, _FOOT = 0.1, 1e-9
#: over what a fit may be off at the foot, values that are 0; share of a piece behind which they are to exceed that
_SLIGHT, _SOON = 1e3, 1e-5
#: roundings of the largest value, and of a time, that may show in a fit
_ROUNDINGS, _BLUR = 8.0, 8.0
#: numbers that a piece has, at least, to be halved; how much shorter than its neighbours one with a corner is
_NUMBERS, _SHORTER = 64, 50.0
#: nodes of a piece, its ends among them so that pieces meet, and between any two of them a place to compare at
_POINTS = -np.cos(np.pi * np.arange(2 * TERMS - 1) / (2 * TERMS - 2))
_POINTS[TERMS - 1] = 0.0
#: from values at the nodes to a series, by the orthogonality of the polynomials there, and from that to terms
_TO_SERIES = chebyshev.chebvander(_POINTS[::2], TERMS - 1) * (2.0 / (TERMS - 1))
_TO_SERIES[[0, -1]] *= 0.5
_TO_SERIES[:, [0, -1]] *= 0.5
_TO_TERMS = powers_of_chebyshev(TERMS, 0.0, 1.0)
_EPSILON = float(np.finfo(float).eps)


class Piece(NamedTuple):
    """A polynomial of x = -1 ... 1 from start to stop; the largest value in it, the largest difference seen, and the
    largest value before it."""

    start: float
    stop: float
    terms: Floats
    largest: float
    off: float
    so_far: float

    def at(self, t: float) -> float:
        """Its value."""
        return float(polyval((2.0 * t - self.start - self.stop) / (self.stop - self.start), self.terms))


Cut = tuple[float, float]


class _Given:
    """A callable up to ``end``, and what is known of it."""

    def __init__(
        self, name: str, function: Callable[[float], Any], end: float, rtol: float, low: float, looks: int
    ) -> None:
        self.name, self.function, self.low, self.taken = name, function, low, 0
        self.share = _SHARE * rtol
        self.looks = end * (np.arange(looks) + 0.5) / looks
        self.seen = self.values(self.looks)
        self.largest = float(np.abs(self.seen).max())

    def values(self, at: Floats) -> Floats:
        """Its values, checked."""
        self.taken += at.size
        found = check_array(f"{self.name}(t)", [self.function(t) for t in at.tolist()], low=self.low)
        if found.shape != at.shape:
            raise ParameterError(f"{self.name}(t)", f"array of shape {found.shape[1:]}", "a number")
        return found

    def value(self, at: float) -> float:
        """Its value."""
        return float(self.values(np.array([at]))[0])

    def piece(self, start: float, stop: float, so_far: float) -> tuple[Piece | None, Cut | None]:
        """(A good piece or None, neighbouring numbers between which it is better cut or None)."""
        middle, half = 0.5 * (start + stop), 0.5 * (stop - start)
        at = middle + half * _POINTS
        at[0], at[-1] = start, stop
        at = np.append(at, start + _SOON * (stop - start)) if so_far == 0.0 else at
        values, looks = self.values(at), slice(*np.searchsorted(self.looks, [start, stop]))
        nodes = values[: _POINTS.size : 2]
        at, values = np.append(at, self.looks[looks]), np.append(values, self.seen[looks])
        order = np.argsort(at, kind="stable")
        at, values = at[order], values[order]
        largest = float(np.abs(values).max())
        self.largest = max(self.largest, largest)
        least = max(self.share * _FOOT, _ROUNDINGS * _EPSILON) * self.largest
        slight = _SLIGHT * least if so_far == 0.0 else max(self.share * so_far, least)
        if largest <= slight:
            return Piece(start, stop, np.zeros(TERMS), 0.0, largest, so_far), None
        if so_far == 0.0 and np.abs(values[:2]).max() <= slight:
            return None, self.foot(at, values, slight)
        allowed = np.maximum(self.share * np.maximum(np.maximum.accumulate(np.abs(values)), so_far), least)
        # what the rounding of t makes of the values is none of the fit's
        rounding = float(np.spacing(stop))
        allowed += _BLUR * rounding / max(half, rounding) * np.ptp(values)
        # what is fitted varies about 0: terms are large and of both signs, and would magnify its rounding
        terms = _product(_product((nodes - nodes[0])[None], _TO_SERIES), _TO_TERMS)[0]
        terms[0] += nodes[0]
        off = np.abs(polyval((at - middle) / (half or 1.0), terms) - values)
        if (off <= allowed).all():
            return Piece(start, stop, terms, largest, float(off.max()), so_far), None
        return None, self.jump(at, values, float(allowed[-1]))

    def foot(self, at: NDArray, values: NDArray, slight: float) -> Cut:
        """Neighbouring numbers between which it first is more than this."""
        n = int(np.argmax(np.abs(values) > slight))
        low, high = at[n - 1 : n + 1].tolist()
        while low < (middle := 0.5 * (low + high)) < high:
            low, high = (low, middle) if abs(self.value(middle)) > slight else (middle, high)
        return low, high

    def jump(self, at: NDArray, values: NDArray, allowed: float) -> Cut | None:
        """Neighbouring numbers between which it jumps, if one jump is most of how it varies."""
        change = np.abs(np.diff(values))
        n = int(change.argmax())
        if change[n] <= allowed or 2.0 * change[n] <= change.sum():
            return None
        (low, high), (below, above) = at[n : n + 2].tolist(), values[n : n + 2].tolist()
        while low < (middle := 0.5 * (low + high)) < high:
            value = self.value(middle)
            if abs(value - below) < abs(above - value):
                low, below = middle, value
            else:
                high, above = middle, value
        return (low, high) if 2.0 * abs(above - below) > change[n] else None


def fitted(
    name: str, function: Callable[[float], Any], end: float, rtol: float, low: float, resolve: float | None = None
) -> tuple[Floats, Floats, float]:
    """(Starts, terms (k, TERMS), largest difference seen) of a callable up to ``end``.

    Parameters
    ----------
    name, function : the argument and the callable.
    end, rtol, low : the last time, the tolerance of the motion, the least value allowed.
    resolve : largest spacing of the samples; None: ``end`` over :data:`LOOKS`.

    Raises
    ------
    ParameterError
        Values that are no finite numbers or below ``low``; a ``resolve`` that is not above 0 or asks for more than
        :data:`MOST` samples; a callable of which half a million values beside these are not enough.
    """
    looks = LOOKS
    if resolve is not None:
        spacing = check_number("resolve", resolve, low=0.0, strict=True)
        if spacing * MOST < end:
            allowed = f"at least {end / MOST:.6g}: {MOST} samples up to t = {end:.6g}"
            raise ParameterError("resolve", spacing, allowed)
        looks = max(math.ceil(end / spacing), LOOKS)
    given = _Given(name, function, end, rtol, low, looks)
    pieces = _with_corners(_pieces(given, end), given)
    starts = np.array([one.start for one in pieces])
    starts[0] = 0.0  # a jump there leaves one value before it
    return starts, np.stack([one.terms for one in pieces]), max(one.off for one in pieces)


def _pieces(given: _Given, end: float) -> list[Piece]:
    """Good pieces up to ``end``, of which no two that follow one another would be one."""
    pieces: list[Piece] = []
    failed: set[tuple[float, float]] = set()
    todo, so_far = [(0.0, end)], 0.0
    while todo:
        start, stop = todo.pop()
        one, cut = given.piece(start, stop, so_far)
        if one is not None:
            if pieces and (pieces[-1].start, stop) not in failed:
                whole, _ = given.piece(pieces[-1].start, stop, pieces[-1].so_far)
                if whole is not None:
                    one, _ = whole, pieces.pop()
            pieces.append(one)
            so_far = max(so_far, one.largest)
            continue
        failed.add((start, stop))
        if given.taken - given.looks.size > MOST or (cut is None and stop - start <= _NUMBERS * np.spacing(stop)):
            what = f"a callable that no polynomials follow near t = {start:.6g} ({given.taken} values of it were taken)"
            raise ParameterError(given.name, what, "smooth but for jumps and corners; give it as a Schedule")
        left, right = cut or (0.5 * (start + stop),) * 2
        todo += [part for part in ((right, stop), (start, left)) if part[0] < part[1]]
    return pieces


def _with_corners(pieces: list[Piece], given: _Given) -> list[Piece]:
    """Without the short pieces that hold a corner: their neighbours meet in it."""
    kept: list[Piece] = []
    left = pieces[::-1]
    while left:
        one = left.pop()
        if kept and left:
            long = min(kept[-1].stop - kept[-1].start, left[-1].stop - left[-1].start)
            if _SHORTER * (one.stop - one.start) < long:
                corner = _meeting(kept[-1], left[-1], one)
                before, _ = given.piece(kept[-1].start, corner, kept[-1].so_far)
                behind, _ = given.piece(corner, left[-1].stop, one.so_far)
                if before and behind:
                    kept[-1], left[-1] = before, behind
                    continue
        kept.append(one)
    return kept


def _meeting(before: Piece, behind: Piece, between: Piece) -> float:
    """Where two polynomials meet within the piece between them; its middle where they pass each other by."""

    def apart(t: float) -> bool:
        return before.at(t) > behind.at(t)

    low, high = between.start, between.stop
    after = apart(high)
    if apart(low) == after:
        return 0.5 * (low + high)
    while low < (middle := 0.5 * (low + high)) < high:
        low, high = (low, middle) if apart(middle) == after else (middle, high)
    return high


def _product(one: NDArray[Any], other: NDArray[Any]) -> Floats:
    """The product of two matrices, of the same bits whatever library of linear algebra numpy has."""
    found: Floats = np.einsum("ij,jk->ik", one, other)
    return found
