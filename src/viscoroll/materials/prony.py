"""A linear viscoelastic material as a Prony series: :class:`Prony`, in relaxation and in creep form.

With moduli over the long-time modulus and times over a time T_ref of the user's,

    E(t) = 1 + sum E_i exp(-a_i t)   a_i = 1/tau_i     alpha = 1 + sum E_i
    J(t) = 1 - sum J_j exp(-b_j t)   b_j = 1/T_j       1/alpha = 1 - sum J_j

with b_1 < a_1 < b_2 < ... < b_N < a_N (:mod:`prony_forms`).
"""

from __future__ import annotations

import math
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..checks import checked
from ..errors import ParameterError
from .prony_array import PronyArray
from .prony_forms import HIGHEST_ALPHA, MOST_MODES, WIDEST, Modes, of_creep, of_relaxation


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
        many = _array_of(E, tau, cls, creep=False)
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
        many = _array_of(J, T, cls, alpha, creep=True)
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
        return self._own

    @cached_property
    def _own(self) -> tuple[Prony, float]:
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


def _array_of(strengths: ArrayLike, times: ArrayLike, one: type[Prony], alpha: Any = None, *, creep: bool) -> Any:
    """Materials, one each, of arrays (n, N); None of others."""
    try:
        if max(np.ndim(strengths), np.ndim(times)) < 2:
            return None
    except ValueError:  # ragged: refused where it is checked
        return None
    return PronyArray(strengths, times, alpha, creep=creep, one=one)


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
