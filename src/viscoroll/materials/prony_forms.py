"""Conversion between the relaxation and the creep form of a series, for one material or many at
once.

A series of N modes has the relaxation form E(t) = 1 + sum E_i exp(-a_i t) and the creep form J(t) =
1 - sum J_j exp(-b_j t), over the long-time modulus and compliance, with 1/alpha = 1 - sum J_j and
alpha = 1 + sum E_i.  The rates of one form are the zeros of a sum over the poles of the other, and
they alternate: b_1 < a_1 < b_2 < ... < a_N.  The unknown is the distance of a zero from the nearer
pole, so that the gaps a_i - b_j keep all digits; the strengths are products of gaps.
"""

from typing import Any, NamedTuple

import numpy as np

from ..core import ArrayLike, Floats, NDArray, ParameterError

#: highest alpha: beyond 1e18 the 1/alpha is lost beside 1; at 1e12 the law is that of alpha ->
#: infinity where alpha zeta is large
HIGHEST_ALPHA = 1e12
#: largest number of modes of a series, with which conversions stay accurate
#: (tests/materials/test_prony.py)
MOST_MODES = 64
#: largest ratio of the longest to the shortest time of a series, likewise
LARGEST_TIME_RATIO = 1e32
#: longest time of a series, and inverse of the shortest one, with which neither conversions nor
#: sums overflow
LONGEST_TIME = 1e140
#: halvings of the interval of ln(distance): 20 leave an error of 1e-3, from which Newton's method
#: converges
_HALVINGS = 20
#: steps of Newton's method from there to rounding
_NEWTON_STEPS = 3
#: least distance of a zero from its pole, as a fraction of the interval, whose logarithm is halved;
#: where it underflows it is the smallest double
_CLOSEST = 1e-300


class Modes(NamedTuple):
    """Relaxation and creep form of one material, or of many along leading axes, and the gaps
    between their rates.

    All arrays are empty along the modes for an elastic material.
    alpha : instantaneous divided by long-time modulus, a number or (...).
    a : rates of relaxation, 1/tau_i, in units of 1/T_ref, ascending, (..., modes).
    b : rates of creep, 1/T_j, in units of 1/T_ref, ascending, (..., modes).
    E : strengths of relaxation divided by the long-time modulus, (..., modes).
    J : strengths of creep divided by the long-time compliance, (..., modes).
    gap : a_i - b_j, in units of 1/T_ref, (..., modes, modes), [..., j, i]; positive where i >= j,
    else negative.
    """

    alpha: Any
    a: Floats
    b: Floats
    E: Floats
    J: Floats
    gap: Floats


def modes_of_relaxation(E: NDArray, tau: NDArray, alpha: Any) -> Modes:
    """Compute the creep form of a series from its relaxation form.

    E: strengths divided by the long-time modulus, > 0, (..., modes); of any number of modes, also
    0.
    tau: relaxation times, > 0, descending and different, (..., modes), in any unit.
    alpha: 1 + sum E, a number or (...).
    Returns both forms as :class:`Modes` (alpha, rates a and b, strengths E and J, gaps a_i - b_j),
    whose rates are in the inverse unit of ``tau``; E and alpha are the arguments themselves.
    """
    a = 1.0 / tau
    # -1/s + sum E/(a - s): the pole at 0 stands for the long-time modulus
    poles = np.insert(a, 0, 0.0, axis=-1)
    spread = poles[..., :, None] - poles[..., None, :]
    spread[..., 1:, 1:] = _rate_differences(tau)
    gaps = zeros_from_poles(spread, np.insert(E, 0, 1.0, axis=-1), np.zeros(()))
    # zero j less pole: of the pole at 0 that is b_j, of the others b_j - a_i, at [i, j]
    b = gaps[..., 0, :].copy()
    gap = np.ascontiguousarray(np.swapaxes(-gaps[..., 1:, :], -1, -2))
    return Modes(alpha=alpha, a=a, b=b, E=E, J=_strengths(gap, alpha, -1) / b, gap=gap)


def modes_of_creep(J: NDArray, T: NDArray, alpha: Any) -> Modes:
    """Compute the relaxation form of a series from its creep form.

    J: strengths divided by the long-time compliance, > 0, (..., modes); of any number of modes,
    also 0.
    T: retardation times, > 0, descending and different, (..., modes), in any unit.
    alpha: 1/(1 - sum J), a number or (...).
    Returns both forms as :class:`Modes` (alpha, rates a and b, strengths E and J, gaps a_i - b_j),
    whose rates are in the inverse unit of ``T``; J and alpha are the arguments themselves.
    """
    b = 1.0 / T
    gap = zeros_from_poles(_rate_differences(T), J * b, np.asarray(1.0 / alpha))
    a = b + np.diagonal(gap, axis1=-2, axis2=-1)
    return Modes(alpha=alpha, a=a, b=b, E=_strengths(gap, alpha, -2) / a, J=J, gap=gap)


def _rate_differences(times: NDArray) -> Floats:
    """Return the differences of the rates 1/times of the modes, computed from the differences of
    the times.

    For close times their difference is exact, that of the rounded rates is not.

    times: relaxation or retardation times, > 0, (..., modes).
    Returns rate[j] - rate[l] as (..., modes, modes), [..., j, l], in the inverse unit of the times;
    0 on the diagonal.
    """
    row = times[..., None, :]
    column = times[..., :, None]
    return (row - column) / (column * row)


def zeros_from_poles(spread: NDArray, weight: NDArray, constant: NDArray) -> Floats:
    """Return the gaps between the zeros of constant + sum weight_j/(pole_j - s) and its poles, to
    full relative accuracy.

    The sum increases from pole to pole: one zero s_i lies between two neighbours, and one right of
    the last if ``constant`` > 0.  A zero is measured from the nearer of its two poles, from the
    left one where it is in the middle.  ln of that distance is found by 20 halvings, the distance
    then by three steps of Newton's method; convergence is not tested.

    spread: pole_j - pole_l, (..., poles, poles), [..., j, l], any unit; poles are ascending and
    different.
    weight: weights of the poles, positive, (..., poles), in the unit of the constant times that of
    the poles.
    constant: the constant, () or (...): > 0 for all, or 0 for all.
    Returns gap[..., j, i] = s_i - pole_j, (..., poles, zeros), in the unit of the poles, zeros
    ascending: as many as poles for a positive constant, one fewer for 0; an empty array where there
    is no zero, as without poles.
    """
    poles = weight.shape[-1]
    constant = constant[..., None]
    # distance of the middle of each interval from both of its poles
    half = 0.5 * np.diagonal(spread, -1, -2, -1)
    if poles and (constant > 0.0).all():
        # at a distance d right of the last pole every term is at least -weight/d: from d =
        # sum(weight)/constant on the sum is >= 0, so that the zero is nearer to that pole.  Twice
        # this d, where the sum is >= constant/2, stands for the half of an interval
        half = np.concatenate([half, 2.0 * weight.sum(axis=-1, keepdims=True) / constant], axis=-1)
    left = np.broadcast_to(np.arange(half.shape[-1]), half.shape)
    sum_at_middle = _sum_near(half, _relative_poles(left, spread), weight, constant)
    # the sum increases from pole to pole; right of the last one there is no other to measure from
    in_left = (sum_at_middle >= 0.0) | (left == poles - 1)
    origin = np.where(in_left, left, left + 1)
    # 1.0: the zero is right of its origin, -1.0: left of it
    side = np.where(in_left, 1.0, -1.0)
    poles_from_origin = _relative_poles(origin, spread)
    # so beyond the zero, seen from its origin, the sum is > 0 right of a pole, < 0 left of it
    low = np.log(np.maximum(half * _CLOSEST, 5e-324))
    high = np.log(half)
    for _ in range(_HALVINGS):
        mid = 0.5 * (low + high)
        beyond = side * _sum_near(side * np.exp(mid), poles_from_origin, weight, constant) > 0.0
        low = np.where(beyond, low, mid)
        high = np.where(beyond, mid, high)
    distance = np.exp(0.5 * (low + high))
    for _ in range(_NEWTON_STEPS):
        distance = _improve_distance(distance, origin, side, poles_from_origin, weight, constant)
    return np.swapaxes((side * distance)[..., None] - poles_from_origin, -1, -2)


def _relative_poles(origin: NDArray, spread: NDArray) -> Floats:
    """Return the poles relative to the origin of each zero, that pole from which the zero is
    measured.

    origin: index of the origin of each zero, int, (..., zeros).
    spread: pole_j - pole_l, (..., poles, poles), [..., j, l], in the unit of the rates.
    Returns pole_j - pole of the origin of zero i, (..., zeros, poles), [..., i, j], in that unit, 0
    at the origin.
    """
    return np.take_along_axis(np.swapaxes(spread, -1, -2), origin[..., None], axis=-2)


def _sum_near(
    step: NDArray, poles_from_origin: NDArray, weight: NDArray, constant: NDArray
) -> Floats:
    """Return constant + sum weight_j/(pole_j - s) at one s for each zero, s = pole[origin] + step.

    step: signed distance of s from the pole of its origin, in the unit of the poles, not 0, (...,
        zeros); s is at no other pole either.
    poles_from_origin: poles relative to the origin of each zero, in that unit, (..., zeros, poles),
        [..., i, j].
    weight: weights of the poles, in the unit of the constant times that of the poles, (..., poles).
    constant: the constant, (..., 1).
    Returns the value of the sum at the point of each zero, (..., zeros), in the unit of the
    constant.
    """
    return constant + (weight[..., None, :] / (poles_from_origin - step[..., None])).sum(axis=-1)


def _improve_distance(
    distance: NDArray,
    origin: NDArray,
    side: NDArray,
    poles_from_origin: NDArray,
    weight: NDArray,
    constant: NDArray,
) -> Floats:
    """Improve the distances of zeros from their poles by one step of Newton's method.

    The equation is weight[origin] = distance side rest, where rest is the sum without the pole at
    the origin.  A step to at most half or at least twice the distance, or to NaN, is left out, and
    that distance stays as it is.

    distance: distance of each zero from its origin, the pole that it is measured from, > 0, in the
        unit of the poles, (..., zeros); not changed.
    origin: index of that pole, int, (..., zeros).
    side: 1.0 for a zero right of its origin, -1.0 left of it, (..., zeros).
    poles_from_origin: poles relative to the origin of each zero, in that unit, (..., zeros, poles),
        [..., i, j].
    weight: weights of the poles, in the unit of the constant times that of the poles, (..., poles).
    constant: the constant of the sum, >= 0, (..., 1).
    Returns a new array of the distances, > 0, (..., zeros), in the unit of the poles.
    """
    inverse = 1.0 / (poles_from_origin - (side * distance)[..., None])
    own = np.arange(weight.shape[-1]) == origin[..., None]
    terms = np.where(own, 0.0, weight[..., None, :] * inverse)
    # with the poles along the first axis numpy adds in their order: results keep their last bits
    rest, slope = (
        np.ascontiguousarray(np.moveaxis(values, -1, 0)).sum(axis=0)
        for values in (terms, terms * inverse)
    )
    rest = constant + rest
    value = np.take_along_axis(weight, origin, axis=-1) - distance * side * rest
    new = distance + value / (side * rest + distance * slope)
    return np.where((new > 0.5 * distance) & (new < 2.0 * distance), new, distance)


def _strengths(gap: NDArray, alpha: Any, axis: int) -> Floats:
    """Return the strengths of one form of a series, each times its rate, from the gaps between the
    rates of the two forms.

    With p the variable of Laplace's transform, the modulus divided by that of long times is

        1 + sum_i E_i p/(p + a_i) = alpha prod_l (p + b_l)/(p + a_l),

    and its inverse is 1 - sum_j J_j p/(p + b_j).  The residues at p = -a_i and p = -b_j are

        E_i a_i = alpha (a_i - b_i) prod_{l != i} (a_i - b_l)/(a_i - a_l)
        J_j b_j = (a_j - b_j)/alpha prod_{l != j} (a_l - b_j)/(b_l - b_j)

    Since the rates alternate, each difference in a denominator is the sum of two gaps of one sign,
    so that no digits cancel.  Each factor is divided before the product, so that nothing overflows.

    gap: a_i - b_j, rates of relaxation minus rates of creep, in any unit, (..., modes, modes),
    [..., j, i].
    alpha: instantaneous divided by long-time modulus, a number or (...).
    axis: -1 for the strengths of creep, -2 for those of relaxation: axis of the gaps along which
        the factors are multiplied.
    Returns J b or E a, in the unit of the gaps, (..., modes), > 0.
    """
    size = np.abs(gap)
    own = np.eye(gap.shape[-1], dtype=bool)
    nearest = np.diagonal(size, 0, -2, -1)
    alpha = np.asarray(alpha)[..., None]
    # b_j - b_l = (a_l - b_l) + (b_j - a_l) and a_i - a_l = (a_i - b_i) + (b_i - a_l), j, i > l
    low = np.tril(np.expand_dims(nearest, -3 - axis) + size, -1)
    apart = np.where(own, 1.0, low + np.swapaxes(low, -1, -2))
    product = np.where(own, 1.0, size / apart).prod(axis=axis)
    return (nearest / alpha if axis == -1 else nearest * alpha) * product


def lock_array(values: Any) -> Any:
    """Make an array read-only.

    values: a contiguous array, which is locked itself and so read-only for the caller too; or
        another one, of which a contiguous copy is made and locked.
    Returns the array that was locked.  A scalar becomes an array (1,).
    """
    values = np.ascontiguousarray(values)
    values.flags.writeable = False
    return values


def refuse_short_retardation(T_epsilon: ArrayLike, T_sigma: ArrayLike) -> None:
    """Raise ParameterError where T_epsilon < T_sigma, as no material has it; equal times are
    allowed.

    T_epsilon, T_sigma: retardation and relaxation times in one unit, numbers or arrays that
    broadcast; nothing else is
        checked, and NaN is no fault.
    The error states, of the elements at fault, the T_epsilon and T_sigma of that with the longest
    T_sigma (of equal ones the first).
    """
    slow, fast = np.broadcast_arrays(T_epsilon, T_sigma)
    short = fast > slow
    if short.any():
        at = int(np.argmax(np.where(short, fast, 0.0)))
        raise ParameterError(
            "T_epsilon",
            slow.flat[at],
            f">= T_sigma = {fast.flat[at]} (creep takes longer than relaxation)",
        )
