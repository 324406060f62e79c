"""Materials, one for each state or motion: :class:`PronyArray`, which :class:`Prony` makes of arrays (n, N)."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .checks import broadcast_shape, checked
from .errors import ParameterError
from .prony import HIGHEST_ALPHA, MOST_MODES, WIDEST, Prony
from .prony_forms import Modes, of_creep, of_relaxation


class Block(NamedTuple):
    """Materials of equal numbers of modes in their own times (``Prony.in_own_time``), modes along the last axis.

    rows : which they are; unit : what their times are counted in
    T_mean, squares : sum J_j T_j, and sum E_i tau_i^2 + sum J_j T_j^2
    """

    rows: NDArray[np.int64]
    modes: Modes
    unit: NDArray[np.float64]
    T_mean: NDArray[np.float64]
    squares: NDArray[np.float64]


class PronyArray:
    """Materials 0 ... n - 1, a :class:`Prony` series each.

    Made by ``Prony(E, tau)`` and ``Prony.creep(J, T, alpha=...)`` of arrays (n, N), one of which may be (N,), shared by
    all; ``alpha`` a number or (n,).

    Attributes
    ----------
    alpha : (n,), instantaneous over long-time modulus.
    shape : (n,).

    Raises
    ------
    ParameterError
        As for a single series, of any of them.

    Notes
    -----
    Immutable, hashable, equal where what was given is.  ``p[i]`` is a single series, and ``p[i:k]`` some of them.
    What follows from strengths and times is found block by block where it is needed and not kept.
    """

    def __init__(self, strengths: ArrayLike, times: ArrayLike, alpha: ArrayLike | None, *, creep: bool) -> None:
        names = ("J", "T") if creep else ("E", "tau")
        self._creep = creep
        self._strengths, self._times = (
            _kept(checked(name, given, low=0.0, strict=strict))
            for name, given, strict in zip(names, (strengths, times), (False, True), strict=True)
        )
        shape = broadcast_shape(**dict(zip(names, (self._strengths, self._times), strict=True)))
        if len(shape) != 2 or shape[1] > MOST_MODES:
            raise ParameterError(", ".join(names), f"of shape {shape}", f"(materials, modes), at most {MOST_MODES}")
        self._whole = np.broadcast_to(self._strengths, shape), np.broadcast_to(self._times, shape)
        self._alpha = None if alpha is None else _kept(checked("alpha", alpha, low=1.0, high=HIGHEST_ALPHA))
        if self._alpha is not None and self._alpha.shape not in ((), shape[:1]):
            raise ParameterError("alpha", f"of shape {self._alpha.shape}", f"a number, or one a material, {shape[:1]}")
        self._refuse_wide(names[1])
        _ = self.alpha

    @property
    def by_creep(self) -> bool:
        """Whether they were given by their creep compliance."""
        return self._creep

    @property
    def given(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Strengths and times as they were given, (n, N)."""
        return self._whole

    @property
    def shape(self) -> tuple[int]:
        """(n,)."""
        return (self._whole[0].shape[0],)

    def __len__(self) -> int:
        return self.shape[0]

    def __getitem__(self, which: Any) -> Any:
        if isinstance(which, slice):
            each = self._alpha if self._alpha is None or self._alpha.ndim == 0 else self._alpha[which]
            return PronyArray(self._whole[0][which], self._whole[1][which], each, creep=self._creep)
        strengths, times = (array[which] for array in self._whole)
        if not self._creep:
            return Prony(strengths, times)
        given = None if self._alpha is None else float(np.broadcast_to(self._alpha, self.shape)[which])
        return Prony.creep(strengths, times, alpha=given)

    def __iter__(self) -> Iterator[Prony]:
        return (self[i] for i in range(len(self)))

    @cached_property
    def alpha(self) -> NDArray[np.float64]:
        """Instantaneous over long-time modulus, of each."""
        found = np.empty(len(self))
        for i, strengths in enumerate(self._whole[0]):
            # the two spare the search for equal times
            plain = not self._creep and not self._unlike[i]
            found[i] = 1.0 + math.fsum(strengths) if plain else self[i].alpha
        if found.size and found.max() > HIGHEST_ALPHA:
            raise ParameterError("E", f"of a sum of {found.max() - 1.0:g}", f"of a sum up to {HIGHEST_ALPHA:g}")
        found.flags.writeable = False
        return found

    def slower(self, factor: ArrayLike) -> PronyArray:
        """All times longer by a factor, or by one each."""
        by = checked("factor", factor, low=0.0, strict=True)
        return PronyArray(self._strengths, self._times * by[..., None], self._alpha, creep=self._creep)

    def blocks(self, which: NDArray[np.int64]) -> Iterator[Block]:
        """The materials ``which`` in their own times: those with all their modes together, and the others."""
        whole = ~self._unlike[which]
        if whole.any():
            rows = which[whole]
            order = np.argsort(-self._whole[1][rows], axis=1, kind="stable")
            strengths, times = (np.take_along_axis(array[rows], order, axis=1) for array in self._whole)
            yield self._block(np.flatnonzero(whole), strengths, times, self.alpha[rows])
        for place in np.flatnonzero(~whole):
            one = self[which[place]]
            strengths, times = (one.J, one.T) if self._creep else (one.E, one.tau)
            yield self._block(np.array([place]), strengths[None], times[None], np.array([one.alpha]))

    def _block(self, rows: NDArray, strengths: NDArray, times: NDArray, alpha: NDArray) -> Block:
        convert = of_creep if self._creep else of_relaxation
        sums = _sums(convert(strengths, times, alpha), times, self._creep)
        unit = np.array([2.0 ** round(math.log2(slow)) for slow in sums[:, 1] / sums[:, 0]]) if times.size else 1.0
        times = times * (1.0 / np.broadcast_to(unit, alpha.shape))[:, None]
        modes = convert(strengths, times, alpha)
        return Block(rows, modes, np.broadcast_to(unit, alpha.shape), *_sums(modes, times, self._creep).T)

    @cached_property
    def _unlike(self) -> NDArray[np.bool_]:
        """Which have strengths of 0 or times that are equal: fewer modes than the others."""
        strengths = self._whole[0]
        ordered = np.sort(self._times, axis=-1)
        equal = (np.diff(ordered, axis=-1) == 0.0).any(axis=-1)
        return np.broadcast_to(equal, strengths.shape[:1]) | (strengths == 0.0).any(axis=1)

    def _refuse_wide(self, name: str) -> None:
        strengths, times = self._whole
        longest = np.where(strengths > 0.0, times, 0.0).max(axis=1, initial=0.0)
        shortest = np.where(strengths > 0.0, times, np.inf).min(axis=1, initial=np.inf)
        wrong = np.flatnonzero(longest > WIDEST * shortest)
        if wrong.size:
            found = f"from {shortest[wrong[0]]:g} to {longest[wrong[0]]:g}"
            raise ParameterError(name, found, f"within a factor of {WIDEST:g}")

    def _key(self) -> tuple[Any, ...]:
        arrays = (self._strengths, self._times, self._alpha)
        return (self._creep, *((a.shape, a.tobytes()) for a in arrays if a is not None))

    def __eq__(self, other: object) -> bool:
        return self._key() == other._key() if isinstance(other, PronyArray) else NotImplemented

    def __hash__(self) -> int:
        return hash(self._key())

    def __repr__(self) -> str:
        n, modes = self._whole[0].shape
        return f"<{n} series of {modes} modes, by {'creep' if self._creep else 'relaxation'}>"


def _kept(array: NDArray[np.float64]) -> NDArray[np.float64]:
    array = array.copy()
    array.flags.writeable = False
    return array


def _sums(modes: Modes, times: NDArray, creep: bool) -> NDArray[np.float64]:
    """(sum J_j T_j, sum E_i tau_i^2 + sum J_j T_j^2) of each, as :class:`Prony` has them: of the times given."""
    tau, T = (1.0 / modes.a, times) if creep else (times, 1.0 / modes.b)
    first = modes.J * T if creep else modes.E * tau
    terms = zip(first, modes.E * tau**2, modes.J * T**2, strict=True)
    return np.array([(math.fsum(one), math.fsum(E) + math.fsum(J)) for one, E, J in terms]).reshape(-1, 2)
