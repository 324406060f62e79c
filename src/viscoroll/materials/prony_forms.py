"""Both forms of a series, one from the other, of one material or of many at once.

The rates of one form are the zeros of a sum over the poles of the other; the unknown is the distance from the nearer
pole, so that the gaps a_i - b_j keep all their digits, and the strengths are products of gaps.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core.array_types import Floats

#: from some 1e18 on 1/alpha is lost beside 1; at 1e12 the law is that of alpha -> infinity where alpha zeta is large
HIGHEST_ALPHA = 1e12
#: most modes of a series, and longest over shortest time
MOST_MODES, WIDEST = 64, 1e32
#: halvings of ln(distance) until it is good to a thousandth, and steps of Newton's iteration from there to rounding
_HALVINGS, _POLISH = 20, 3
#: a zero lies no closer to its pole than this share of the interval, whose logarithm is halved
_CLOSEST = 1e-300


@dataclass(frozen=True)
class Modes:
    """Both forms of one material, or of many behind leading axes, times descending, and the gaps between their rates.

    a, b : rates of relaxation and creep, ascending; E, J : strengths; gap[..., j, i] = a_i - b_j.
    """

    alpha: Any
    a: Floats
    b: Floats
    E: Floats
    J: Floats
    gap: Floats


def of_relaxation(E: NDArray, tau: NDArray, alpha: Any) -> Modes:
    """Both forms from strengths and times of relaxation (..., modes), times descending."""
    a, modes = 1.0 / tau, tau.shape[-1]
    # -1/s + sum E/(a - s): the pole at 0 stands for the long-time modulus
    spread = np.zeros((*tau.shape[:-1], modes + 1, modes + 1))
    spread[..., 1:, 1:], spread[..., 1:, 0], spread[..., 0, 1:] = _between(tau), a, -a
    gaps = zeros_from_poles(spread, np.concatenate([np.ones((*E.shape[:-1], 1)), E], axis=-1), np.zeros(()))
    b, gap = gaps[..., 0, :].copy(), np.ascontiguousarray(np.swapaxes(-gaps[..., 1:, :], -1, -2))
    return Modes(alpha, a, b, E, _strengths(gap, alpha)[0] / b, gap)


def of_creep(J: NDArray, T: NDArray, alpha: Any) -> Modes:
    """Both forms from strengths and times of creep (..., modes), times descending."""
    b = 1.0 / T
    gap = zeros_from_poles(_between(T), J * b, np.asarray(1.0 / alpha))
    a = b + np.diagonal(gap, axis1=-2, axis2=-1)
    return Modes(alpha, a, b, _strengths(gap, alpha)[1] / a, J, gap)


def _between(times: NDArray) -> Floats:
    """rate[j] - rate[l] of the rates 1/times: of close times the difference is exact, of their rates it is not."""
    row, column = times[..., None, :], times[..., :, None]
    return (row - column) / (column * row)


def zeros_from_poles(spread: NDArray, weight: NDArray, constant: NDArray) -> Floats:
    """gap[..., j, i] = s_i - pole_j to full relative accuracy, s_i the zeros of constant + sum weight_j/(pole_j - s).

    spread[..., j, l] = pole_j - pole_l.  Poles ascend and weights are positive, so that the sum rises from pole to
    pole: one zero between two neighbours, and one right of the last if ``constant`` > 0.
    """
    poles, constant = weight.shape[-1], constant[..., None]
    half = 0.5 * np.diagonal(spread, -1, -2, -1)
    if poles and (constant > 0.0).all():  # right of all poles every term is at least -weight over the distance
        half = np.concatenate([half, 2.0 * weight.sum(axis=-1, keepdims=True) / constant], axis=-1)
    left = np.broadcast_to(np.arange(half.shape[-1]), half.shape)
    in_left = np.ones(half.shape, dtype=bool)
    middle = _sum_at(half, _seen_from(left, spread), weight, constant)
    in_left[..., : poles - 1] = middle[..., : poles - 1] >= 0.0
    origin, side = np.where(in_left, left, left + 1), np.where(in_left, 1.0, -1.0)
    seen, low, high = _seen_from(origin, spread), np.log(half * _CLOSEST), np.log(half)
    for _ in range(_HALVINGS):
        mid = 0.5 * (low + high)
        beyond = side * _sum_at(side * np.exp(mid), seen, weight, constant) > 0.0
        low, high = np.where(beyond, low, mid), np.where(beyond, mid, high)
    distance = np.exp(0.5 * (low + high))
    for _ in range(_POLISH):
        distance = _polished(distance, origin, side, seen, weight, constant)
    return np.swapaxes((side * distance)[..., None] - seen, -1, -2)


def _seen_from(origin: NDArray, spread: NDArray) -> Floats:
    """[..., i, j] = pole_j - pole of the origin of zero i."""
    return np.take_along_axis(np.swapaxes(spread, -1, -2), origin[..., None], axis=-2)


def _sum_at(step: NDArray, seen: NDArray, weight: NDArray, constant: NDArray) -> Floats:
    """The sum at s = pole[origin] + step."""
    return constant + (weight[..., None, :] / (seen - step[..., None])).sum(axis=-1)


def _polished(
    distance: NDArray, origin: NDArray, side: NDArray, seen: NDArray, weight: NDArray, constant: NDArray
) -> Floats:
    """One step of Newton's iteration for weight[origin] = distance side (the rest of the sum)."""
    per, own = 1.0 / (seen - (side * distance)[..., None]), np.arange(weight.shape[-1]) == origin[..., None]
    each = np.where(own, 0.0, weight[..., None, :] * per)
    # poles first: then numpy adds one after another, as it has done since the first of these series
    rest, slope = (np.ascontiguousarray(np.moveaxis(terms, -1, 0)).sum(axis=0) for terms in (each, each * per))
    rest = constant + rest
    value = np.take_along_axis(weight, origin, axis=-1) - distance * side * rest
    new = distance + value / (side * rest + distance * slope)
    return np.where((new > 0.5 * distance) & (new < 2.0 * distance), new, distance)


def _strengths(gap: NDArray, alpha: Any) -> tuple[Floats, Floats]:
    """(J, E) times their rates: products of gaps over products of the differences of their own rates.

    The rates of the two forms alternate, so that such a difference is a sum of two gaps: no digits cancel.  Factors are
    paired so that nothing overflows.
    """
    size, own = np.abs(gap), np.eye(gap.shape[-1], dtype=bool)
    nearest, alpha = np.diagonal(size, 0, -2, -1), np.asarray(alpha)[..., None]
    # b_j - b_l = (a_l - b_l) + (b_j - a_l) and a_i - a_l = (a_i - b_i) + (b_i - a_l), j, i > l
    sums = nearest[..., None, :] + size, nearest[..., :, None] + size
    apart = (np.where(own, 1.0, low + np.swapaxes(low, -1, -2)) for low in (np.tril(each, -1) for each in sums))
    per_b, per_a = (np.where(own, 1.0, size / each) for each in apart)
    return nearest / alpha * per_b.prod(axis=-1), nearest * alpha * per_a.prod(axis=-2)
