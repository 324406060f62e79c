"""Linear viscoelastic materials as Prony series: :class:`Prony`, one or many, in relaxation and in creep form.

With moduli over the long-time modulus and times over a time T_ref of the user's,

    E(t) = 1 + sum E_i exp(-a_i t)   a_i = 1/tau_i     alpha = 1 + sum E_i
    J(t) = 1 - sum J_j exp(-b_j t)   b_j = 1/T_j       1/alpha = 1 - sum J_j

with b_1 < a_1 < b_2 < ... < b_N < a_N (:mod:`prony_forms`).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.array_types import Floats, Integers
from ..core.checks import broadcast_shape, check_array
from ..core.errors import ParameterError
from .prony_forms import HIGHEST_ALPHA, MOST_MODES, WIDEST, Modes, of_creep, of_relaxation


class Block(NamedTuple):
    """Materials of equal numbers of modes, along the last axis.

    rows : which they are
    weights : of pairs, what of the strength of each creep mode is the half-space's
    """

    rows: Integers
    modes: Modes
    weights: Floats | None = None


class OneOrMany:
    """A material, of shape (), or materials 0 ... n - 1, of shape (n,), which index and iteration give."""

    #: of the materials
    shape: tuple[int, ...]

    def __getitem__(self, which: Any) -> Any:
        raise NotImplementedError

    def __len__(self) -> int:
        if not self.shape:
            raise TypeError("a single material has no length")
        return self.shape[0]

    def __bool__(self) -> bool:
        return True

    def __iter__(self) -> Iterator[Any]:
        return (self[i] for i in range(len(self)))


class Prony(OneOrMany):
    """A linear viscoelastic material by its relaxation modulus, a Prony series; or n of them.

    Parameters
    ----------
    E : strengths of the modes over the long-time modulus, >= 0; zeros are dropped.
    tau : their relaxation times over T_ref, > 0; strengths of equal times are added.
        Arrays (n, N), one of which may be (N,), are n materials: ``p[i]`` is one of them, ``p[i:k]`` are some.

    Attributes
    ----------
    shape : (), or (n,).
    alpha : instantaneous over long-time modulus, of each.
    by_creep : whether it was given by its creep compliance.

    Raises
    ------
    ParameterError
        Negative strengths, times that are not positive, more than 64 modes, times that span more than
        32 decades, or 1 + sum E above 1e12; of any of them.

    Notes
    -----
    Immutable, hashable, equal where modes and ``alpha`` are.  Nothing that is given is rescaled.
    """

    alpha: Any
    by_creep: bool

    def __init__(self, E: ArrayLike = (), tau: ArrayLike = ()) -> None:
        strengths, times = _given(("E", "tau"), E, tau)
        alpha = 1.0 + _sums(strengths)
        if (np.asarray(alpha) > HIGHEST_ALPHA).any():
            raise ParameterError("E", f"of a sum of {np.max(alpha) - 1.0:g}", f"of a sum up to {HIGHEST_ALPHA:g}")
        self._keep(False, strengths, times, alpha)

    @classmethod
    def creep(cls, J: ArrayLike, T: ArrayLike, *, alpha: Any = None) -> Prony:
        """The material by its creep compliance.

        Parameters
        ----------
        J : strengths over the long-time compliance, >= 0, of a sum below 1.
        T : retardation times over T_ref, > 0.
        alpha : instantaneous over long-time modulus, 1/(1 - sum J).  Where the sum is near 1 that difference
            has lost digits; what is given here takes its place, and must agree with it to rounding of J.
            Of arrays (n, N) a number or (n,).

        Raises
        ------
        ParameterError
            As for the class, and where the sum of J is not below 1 or ``alpha`` does not agree with it.
        """
        strengths, times = _given(("J", "T"), J, T)
        rest = np.asarray(1.0 - _sums(strengths))
        if not (rest > 0.0).all():
            found = f"of a sum of {1.0 - rest.min()!s}"
            raise ParameterError("J", found, "of a sum below 1: the instantaneous modulus would be infinite")
        given = 1.0 / rest if alpha is None else check_array("alpha", alpha, low=1.0, high=HIGHEST_ALPHA)
        if given.shape not in ((), rest.shape):
            raise ParameterError("alpha", f"of shape {given.shape}", f"a number, or one a material, {rest.shape}")
        given = np.broadcast_to(given, rest.shape)
        off = np.abs(1.0 / given - rest) > 1e-14 * (1.0 + np.count_nonzero(strengths, axis=-1))
        if off.any():
            here = f"1/(1 - sum J), here {1.0 / rest[off].flat[0]!s} to rounding"
            raise ParameterError("alpha", given[off].flat[0], here)
        if (given > HIGHEST_ALPHA).any():
            raise ParameterError("J", strengths.tolist(), f"such that 1/(1 - sum J) is at most {HIGHEST_ALPHA:g}")
        return cls._of(True, strengths, times, given if given.ndim else float(given))

    @classmethod
    def elastic(cls) -> Prony:
        """No modes: alpha = 1."""
        return cls([], [])

    @classmethod
    def _of(cls, by_creep: bool, strengths: NDArray, times: NDArray, alpha: Any) -> Prony:
        made = cls.__new__(cls)
        made._keep(by_creep, strengths, times, alpha)
        return made

    def _keep(self, by_creep: bool, strengths: NDArray, times: NDArray, alpha: Any) -> None:
        self.by_creep, self.alpha, self.shape = by_creep, alpha, strengths.shape[:-1]
        self._strengths, self._times = map(read_only, (strengths, times))
        if isinstance(alpha, np.ndarray):
            self.alpha = read_only(alpha)

    def __getitem__(self, which: Any) -> Prony:
        strengths, times, alpha = self._strengths[which], self._times[which], self.alpha[which]
        if strengths.ndim == 1:
            count = np.count_nonzero(strengths)
            strengths, times, alpha = strengths[:count], times[:count], float(alpha)
        return Prony._of(self.by_creep, strengths, times, alpha)

    def repeated(self, count: int) -> Prony:
        """A single one as ``count`` that are alike."""
        strengths, times = (np.broadcast_to(each, (count, each.size)) for each in (self._strengths, self._times))
        return Prony._of(self.by_creep, strengths, times, np.full(count, self.alpha))

    @cached_property
    def modes(self) -> Modes:
        """Both forms of a single one, and the gaps between their rates."""
        return (of_creep if self.by_creep else of_relaxation)(self._strengths, self._times, self.alpha)

    def blocks(self, which: Integers) -> Iterator[Block]:
        """The materials ``which``, those of as many modes together."""
        form = of_creep if self.by_creep else of_relaxation
        counts = np.count_nonzero(self._strengths[which], axis=-1)
        for count in np.unique(counts).tolist():
            rows = np.flatnonzero(counts == count)
            own = which[rows]
            strengths, times = (np.ascontiguousarray(each[own, :count]) for each in (self._strengths, self._times))
            yield Block(rows, form(strengths, times, self.alpha[own]))

    @cached_property
    def _other(self) -> tuple[NDArray, NDArray]:
        """Strengths and times of the form that was not given; of many behind the last mode 0 and 1."""
        names = ("E", "a") if self.by_creep else ("J", "b")
        if not self.shape:
            strengths, rates = (getattr(self.modes, name) for name in names)
            return read_only(strengths), read_only(1.0 / rates)
        strengths, rates = np.zeros(self._strengths.shape), np.ones(self._strengths.shape)
        for block in self.blocks(np.arange(len(self))):
            count = block.modes.a.shape[-1]
            strengths[block.rows, :count], rates[block.rows, :count] = (getattr(block.modes, name) for name in names)
        return read_only(strengths), read_only(1.0 / rates)

    @property
    def E(self) -> Floats:
        """Strengths of relaxation over the long-time modulus, slowest mode first."""
        return self._other[0] if self.by_creep else self._strengths

    @property
    def tau(self) -> Floats:
        """Relaxation times over T_ref, longest first."""
        return self._other[1] if self.by_creep else self._times

    @property
    def J(self) -> Floats:
        """Strengths of creep over the long-time compliance, slowest mode first."""
        return self._strengths if self.by_creep else self._other[0]

    @property
    def T(self) -> Floats:
        """Retardation times over T_ref, longest first."""
        return self._times if self.by_creep else self._other[1]

    @property
    def T_mean(self) -> Any:
        """sum J_j T_j = sum E_i tau_i over T_ref: M = V T_mean at low speed."""
        return _sums(self._strengths * self._times)

    @property
    def slow_time(self) -> float:
        """(sum E_i tau_i^2 + sum J_j T_j^2)/T_mean over T_ref: kappa V beside its inverse tells slow from fast."""
        if not self.E.size:
            return 1.0
        return (_sums(self.E * self.tau**2) + _sums(self.J * self.T**2)) / self.T_mean

    def slower(self, factor: ArrayLike) -> Prony:
        """All times longer by a factor, or by one each, as a colder rubber has them."""
        times = self._times * check_array("factor", factor, low=0.0, strict=True)[..., np.newaxis]
        if self.by_creep:
            return Prony.creep(self._strengths, times, alpha=self.alpha)
        return Prony(self._strengths, times)

    def in_own_time(self) -> tuple[Prony, float]:
        """(A single one with its slow time near 1, the time that this is counted in), a power of two: exact."""
        return self._own

    @cached_property
    def _own(self) -> tuple[Prony, float]:
        unit = 2.0 ** round(math.log2(self.slow_time))  # of no modes it is 1
        return (self, 1.0) if unit == 1.0 else (self.slower(1.0 / unit), unit)

    @cached_property
    def _key(self) -> tuple[Any, ...]:
        alpha = np.asarray(self.alpha).tobytes()
        return self.by_creep, self._strengths.shape, self._strengths.tobytes(), self._times.tobytes(), alpha

    def __eq__(self, other: object) -> bool:
        return self._key == other._key if isinstance(other, Prony) else NotImplemented

    def __hash__(self) -> int:
        return hash(self._key)

    def __repr__(self) -> str:
        if self.shape:
            form = "creep" if self.by_creep else "relaxation"
            return f"<{len(self)} series of {self._strengths.shape[-1]} modes, by {form}>"
        strengths, times = self._strengths.tolist(), self._times.tolist()
        if self.by_creep:
            return f"Prony.creep(J={strengths}, T={times}, alpha={self.alpha!r})"
        return f"Prony(E={strengths}, tau={times})"


def _given(names: tuple[str, str], strengths: ArrayLike, times: ArrayLike) -> tuple[NDArray, NDArray]:
    """Strengths and times as they are kept, refused by these names."""
    values, each = check_array(names[0], strengths, low=0.0), check_array(names[1], times, low=0.0, strict=True)
    if values.ndim == each.ndim == 1 and values.shape != each.shape:
        allowed = f"one time for each {names[0]}, of shape {values.shape}"
        raise ParameterError(names[1], f"of shape {each.shape}", allowed)
    shape = broadcast_shape(**dict(zip(names, (values, each), strict=True)))
    if len(shape) not in (1, 2):
        raise ParameterError(", ".join(names), f"of shape {shape}", "(modes,) or (materials, modes)")
    values, each = descending(np.broadcast_to(values, shape), np.broadcast_to(each, shape))
    there = values > 0.0
    most = int(there.sum(axis=-1).max(initial=0))
    if most > MOST_MODES:
        raise ParameterError(names[1], f"{most} times", f"at most {MOST_MODES}")
    longest, shortest = each.max(axis=-1, initial=0.0, where=there), each.min(axis=-1, initial=np.inf, where=there)
    wide = longest > WIDEST * shortest
    if wide.any():
        ends = f"from {shortest[wide].flat[0]:g} to {longest[wide].flat[0]:g}"
        raise ParameterError(names[1], ends, f"within a factor of {WIDEST:g}")
    return values[..., :most], each[..., :most]


def series_of_alpha(alpha: float) -> Prony:
    """The paper's material, its times in T_epsilon, with both forms exact to the last digit; elastic of alpha = 1."""
    c, one = np.array([(alpha - 1.0) / alpha]), np.ones(1)
    if alpha == 1.0:
        c, one = c[:0], one[:0]
    made = Prony._of(True, c, one, alpha)
    made.modes = Modes(alpha, alpha * one, 1.0 * one, alpha * c, c, (alpha * c)[:, np.newaxis])
    return made


def descending(strengths: NDArray, times: NDArray, *more: NDArray) -> list[Floats]:
    """Strengths and times by falling times: those of equal times added up, those of no strength behind the others.

    ``more`` : parts of the strengths, likewise.
    """
    order = np.argsort(-times, axis=-1, kind="stable")
    values, each, *parts = (np.take_along_axis(given, order, axis=-1) for given in (strengths, times, *more))
    for n in range(each.shape[-1] - 1):
        equal = each[..., n] == each[..., n + 1]
        for given in (values, *parts) if equal.any() else ():
            given[..., n + 1] += np.where(equal, given[..., n], 0.0)
            given[..., n] *= ~equal
    order = np.argsort(values == 0.0, axis=-1, kind="stable")
    return [np.take_along_axis(given, order, axis=-1) for given in (values, each, *parts)]


def _sums(values: NDArray) -> Any:
    """Along the modes, without an error of rounding but the last."""
    rows = values.tolist()
    return math.fsum(rows) if values.ndim == 1 else np.array([math.fsum(row) for row in rows])


def read_only(values: Any) -> Any:
    """The array itself, or a copy that lies in one piece, which nobody can write to."""
    values = np.ascontiguousarray(values)
    values.flags.writeable = False
    return values
