"""A linear viscoelastic material as a Prony series: :class:`Prony`, in relaxation and in creep form.

With moduli over the long-time modulus and times over a time T_ref of the user's,

    E(t) = 1 + sum E_i exp(-a_i t)   a_i = 1/tau_i     alpha = 1 + sum E_i
    J(t) = 1 - sum J_j exp(-b_j t)   b_j = 1/T_j       1/alpha = 1 - sum J_j

with b_1 < a_1 < b_2 < ... < b_N < a_N.  The rates of one form are the zeros of a sum over the poles of the other;
the unknown is the distance from the nearer pole, so that the gaps a_i - b_j keep all their digits, and the
strengths are products of gaps.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .checks import checked
from .errors import ParameterError

#: from some 1e18 on 1/alpha is lost beside 1; at 1e12 the law is that of alpha -> infinity where alpha zeta is large
HIGHEST_ALPHA = 1e12
#: most modes of a series, and longest over shortest time
MOST_MODES, WIDEST = 64, 1e32
#: halvings of ln(distance) until it is good to rounding, and steps of Newton's iteration behind them
_HALVINGS, _POLISH = 64, 3
#: a zero lies no closer to its pole than this share of the interval, whose logarithm is halved
_CLOSEST = 1e-300


@dataclass(frozen=True)
class Modes:
    """Both forms of one material, or of many behind leading axes, times descending, and the gaps between their rates.

    a, b : rates of relaxation and creep, ascending; E, J : strengths; gap[..., j, i] = a_i - b_j.
    """

    alpha: Any
    a: NDArray[np.float64]
    b: NDArray[np.float64]
    E: NDArray[np.float64]
    J: NDArray[np.float64]
    gap: NDArray[np.float64]


class Prony:
    """A linear viscoelastic material by its relaxation modulus, a Prony series.

    Parameters
    ----------
    E : strengths of the modes over the long-time modulus, >= 0; zeros are dropped.
    tau : their relaxation times over T_ref, > 0; strengths of equal times are added.
        Of arrays (n, N), one of which may be (N,), it makes n materials: a :class:`PronyArray`.

    Raises
    ------
    ParameterError
        Negative strengths, times that are not positive, more than 64 modes, times that span more than
        32 decades, or 1 + sum E above 1e12.

    Notes
    -----
    Immutable, hashable, equal where modes and ``alpha`` are.  Nothing that is given is rescaled.
    """

    def __new__(cls, E: ArrayLike = (), tau: ArrayLike = ()) -> Any:
        many = _array_of(E, tau, creep=False)
        return super().__new__(cls) if many is None else many

    def __init__(self, E: ArrayLike, tau: ArrayLike) -> None:
        self._relaxation: tuple[tuple[float, ...], tuple[float, ...]] | None = _series("E", E, "tau", tau)
        self._creep: tuple[tuple[float, ...], tuple[float, ...]] | None = None
        self._alpha = 1.0 + math.fsum(self._relaxation[0])
        if self._alpha > HIGHEST_ALPHA:
            raise ParameterError("E", f"{self._relaxation[0]}", f"of a sum up to {HIGHEST_ALPHA:g}")

    @classmethod
    def creep(cls, J: ArrayLike, T: ArrayLike, *, alpha: Any = None) -> Any:
        """The material by its creep compliance.

        Parameters
        ----------
        J : strengths over the long-time compliance, >= 0, of a sum below 1.
        T : retardation times over T_ref, > 0.
        alpha : instantaneous over long-time modulus, 1/(1 - sum J).  Where the sum is near 1 that difference
            has lost digits; what is given here takes its place, and must agree with it to rounding of J.
            Of arrays (n, N) a number or (n,).

        Returns
        -------
        Prony
            Or, of arrays (n, N), a :class:`PronyArray`.

        Raises
        ------
        ParameterError
            As for the class, and where the sum of J is not below 1 or ``alpha`` does not agree with it.
        """
        many = _array_of(J, T, alpha, creep=True)
        if many is not None:
            return many
        J, T = _series("J", J, "T", T)
        rest = 1.0 - math.fsum(J)
        if not rest > 0.0:
            raise ParameterError("J", f"{J}", "of a sum below 1: the instantaneous modulus would be infinite")
        given = 1.0 / rest if alpha is None else float(checked("alpha", alpha, low=1.0, high=HIGHEST_ALPHA))
        if abs(1.0 / given - rest) > 1e-14 * (1 + len(J)):
            raise ParameterError("alpha", alpha, f"1/(1 - sum J), here {1.0 / rest!r} to rounding")
        if given > HIGHEST_ALPHA:
            raise ParameterError("J", f"{J}", f"such that 1/(1 - sum J) is at most {HIGHEST_ALPHA:g}")
        made = cls.__new__(cls)
        made._relaxation, made._creep, made._alpha = None, (J, T), given
        return made

    @classmethod
    def elastic(cls) -> Prony:
        """No modes: alpha = 1."""
        return cls([], [])

    @cached_property
    def modes(self) -> Modes:
        """Both forms, and the gaps between their rates."""
        if self._relaxation is not None:
            E, tau = (np.array(values) for values in self._relaxation)
            return of_relaxation(E, tau, self._alpha)
        assert self._creep is not None
        J, T = (np.array(values) for values in self._creep)
        return of_creep(J, T, self._alpha)

    @property
    def by_creep(self) -> bool:
        """Whether it was given by its creep compliance."""
        return self._creep is not None

    @property
    def alpha(self) -> float:
        """Instantaneous over long-time modulus."""
        return self._alpha

    @property
    def E(self) -> NDArray[np.float64]:
        """Strengths of relaxation over the long-time modulus, slowest mode first."""
        return _read_only(self.modes.E)

    @property
    def tau(self) -> NDArray[np.float64]:
        """Relaxation times over T_ref, longest first."""
        return _read_only(np.array(self._relaxation[1]) if self._relaxation is not None else 1.0 / self.modes.a)

    @property
    def J(self) -> NDArray[np.float64]:
        """Strengths of creep over the long-time compliance, slowest mode first."""
        return _read_only(self.modes.J)

    @property
    def T(self) -> NDArray[np.float64]:
        """Retardation times over T_ref, longest first."""
        return _read_only(np.array(self._creep[1]) if self._creep is not None else 1.0 / self.modes.b)

    @property
    def T_mean(self) -> float:
        """sum J_j T_j = sum E_i tau_i over T_ref: M = V T_mean at low speed."""
        return math.fsum(self.E * self.tau) if self._relaxation is not None else math.fsum(self.J * self.T)

    @property
    def second_moments(self) -> tuple[float, float]:
        """(sum E_i tau_i^2, sum J_j T_j^2) over T_ref^2."""
        return math.fsum(self.E * self.tau**2), math.fsum(self.J * self.T**2)

    @property
    def slow_time(self) -> float:
        """(sum E_i tau_i^2 + sum J_j T_j^2)/T_mean over T_ref: kappa V beside its inverse tells slow from fast."""
        return sum(self.second_moments) / self.T_mean if self.E.size else 1.0

    def slower(self, factor: float) -> Prony:
        """All times longer by a factor, as a colder rubber has them."""
        factor = float(checked("factor", factor, low=0.0, strict=True))
        if self._relaxation is not None:
            return Prony(self._relaxation[0], np.array(self._relaxation[1]) * factor)
        assert self._creep is not None
        return Prony.creep(self._creep[0], np.array(self._creep[1]) * factor, alpha=self._alpha)

    def in_own_time(self) -> tuple[Prony, float]:
        """(The material with its slow time near 1, the time that this is counted in), a power of two: exact."""
        unit = 2.0 ** round(math.log2(self.slow_time))  # of no modes it is 1
        return (self, 1.0) if unit == 1.0 else (self.slower(1.0 / unit), unit)

    def _key(self) -> tuple[Any, ...]:
        return self._relaxation, self._creep, self._alpha

    def __eq__(self, other: object) -> bool:
        return self._key() == other._key() if isinstance(other, Prony) else NotImplemented

    def __hash__(self) -> int:
        return hash(self._key())

    def __repr__(self) -> str:
        if self._relaxation is not None:
            E, tau = map(list, self._relaxation)
            return f"Prony(E={E}, tau={tau})"
        assert self._creep is not None
        J, T = map(list, self._creep)
        return f"Prony.creep(J={J}, T={T}, alpha={self._alpha!r})"


def _array_of(strengths: ArrayLike, times: ArrayLike, alpha: Any = None, *, creep: bool) -> Any:
    """Materials, one each, of arrays (n, N); None of others."""
    try:
        if max(np.ndim(strengths), np.ndim(times)) < 2:
            return None
    except ValueError:  # ragged: refused where it is checked
        return None
    from .prony_array import PronyArray

    return PronyArray(strengths, times, alpha, creep=creep)


def _series(
    strength: str, strengths: ArrayLike, time: str, times: ArrayLike
) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Strengths and times as given, times descending; without zeros, equal times added up."""
    values, each = checked(strength, strengths, low=0.0), checked(time, times, low=0.0, strict=True)
    if values.ndim != 1 or values.shape != each.shape:
        raise ParameterError(time, f"of shape {each.shape}", f"one time for each {strength}, of shape {values.shape}")
    total: dict[float, float] = {}
    for value, at in zip(values.tolist(), each.tolist(), strict=True):
        if value > 0.0:
            total[at] = total.get(at, 0.0) + value
    ordered = sorted(total, reverse=True)
    if len(ordered) > MOST_MODES:
        raise ParameterError(time, f"{len(ordered)} times", f"at most {MOST_MODES}")
    if ordered and not ordered[0] <= WIDEST * ordered[-1]:
        raise ParameterError(time, f"from {ordered[-1]:g} to {ordered[0]:g}", f"within a factor of {WIDEST:g}")
    return tuple(total[at] for at in ordered), tuple(ordered)


def _read_only(values: NDArray[np.float64]) -> NDArray[np.float64]:
    values.flags.writeable = False
    return values


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


def _between(times: NDArray) -> NDArray[np.float64]:
    """rate[j] - rate[l] of the rates 1/times: of close times the difference is exact, of their rates it is not."""
    row, column = times[..., None, :], times[..., :, None]
    return (row - column) / (column * row)


def zeros_from_poles(spread: NDArray, weight: NDArray, constant: NDArray) -> NDArray[np.float64]:
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


def _seen_from(origin: NDArray, spread: NDArray) -> NDArray[np.float64]:
    """[..., i, j] = pole_j - pole of the origin of zero i."""
    return np.take_along_axis(np.swapaxes(spread, -1, -2), origin[..., None], axis=-2)


def _sum_at(step: NDArray, seen: NDArray, weight: NDArray, constant: NDArray) -> NDArray[np.float64]:
    """The sum at s = pole[origin] + step."""
    return constant + (weight[..., None, :] / (seen - step[..., None])).sum(axis=-1)


def _polished(
    distance: NDArray, origin: NDArray, side: NDArray, seen: NDArray, weight: NDArray, constant: NDArray
) -> NDArray[np.float64]:
    """One step of Newton's iteration for weight[origin] = distance side (the rest of the sum)."""
    per, own = 1.0 / (seen - (side * distance)[..., None]), np.arange(weight.shape[-1]) == origin[..., None]
    each = np.where(own, 0.0, weight[..., None, :] * per)
    # poles first: then numpy adds one after another, as it has done since the first of these series
    rest, slope = (np.ascontiguousarray(np.moveaxis(terms, -1, 0)).sum(axis=0) for terms in (each, each * per))
    rest = constant + rest
    value = np.take_along_axis(weight, origin, axis=-1) - distance * side * rest
    new = distance + value / (side * rest + distance * slope)
    return np.where((new > 0.5 * distance) & (new < 2.0 * distance), new, distance)


def _strengths(gap: NDArray, alpha: Any) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
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
