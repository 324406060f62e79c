"""Materials, one for each state or motion: :class:`PronyArray`, which ``Prony`` makes of arrays (n, N).

Pairs of them: :mod:`bodies_array`.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Iterator
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..checks import broadcast_shape, checked
from ..errors import ParameterError
from .prony_forms import HIGHEST_ALPHA, MOST_MODES, WIDEST, Modes, of_creep, of_relaxation


class Block(NamedTuple):
    """Materials of equal numbers of modes, along the last axis.

    rows : which they are
    weights : of pairs, what of the strength of each creep mode is the half-space's
    """

    rows: NDArray[np.int64]
    modes: Modes
    weights: NDArray[np.float64] | None = None


class MaterialArray(ABC):
    """Materials 0 ... n - 1: what states and motions ask of them, be they series or pairs."""

    #: (n,), instantaneous over long-time modulus
    alpha: Any

    @property
    @abstractmethod
    def shape(self) -> tuple[int]:
        """(n,)."""

    @abstractmethod
    def __getitem__(self, which: Any) -> Any:
        """A single one by its number, or those of a slice."""

    @abstractmethod
    def blocks(self, which: NDArray[np.int64]) -> Iterator[Block]:
        """The materials ``which``, those of as many modes together."""

    def __len__(self) -> int:
        return self.shape[0]

    def __iter__(self) -> Iterator[Any]:
        return (self[i] for i in range(len(self)))


class PronyArray(MaterialArray):
    """Materials 0 ... n - 1, a ``Prony`` series each.

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

    def __init__(
        self, strengths: ArrayLike, times: ArrayLike, alpha: ArrayLike | None, *, creep: bool, one: Any
    ) -> None:
        names = ("J", "T") if creep else ("E", "tau")
        self._creep, self._one = creep, one  # the class of a single one
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

    def __getitem__(self, which: Any) -> Any:
        if isinstance(which, slice | np.ndarray):
            each = self._alpha if self._alpha is None or self._alpha.ndim == 0 else self._alpha[which]
            return self._like(self._whole[0][which], self._whole[1][which], each)
        strengths, times = (array[which] for array in self._whole)
        if not self._creep:
            return self._one(strengths, times)
        given = None if self._alpha is None else float(np.broadcast_to(self._alpha, self.shape)[which])
        return self._one.creep(strengths, times, alpha=given)

    def _like(self, strengths: NDArray, times: NDArray, alpha: NDArray | None) -> PronyArray:
        return PronyArray(strengths, times, alpha, creep=self._creep, one=self._one)

    @cached_property
    def alpha(self) -> NDArray[np.float64]:
        """Instantaneous over long-time modulus, of each."""
        found = np.empty(len(self))
        for i, strengths in enumerate(self._whole[0]):
            # the two spare the search for equal times
            plain = not self._creep and not self.unlike[i]
            found[i] = 1.0 + math.fsum(strengths) if plain else self[i].alpha
        if found.size and found.max() > HIGHEST_ALPHA:
            raise ParameterError("E", f"of a sum of {found.max() - 1.0:g}", f"of a sum up to {HIGHEST_ALPHA:g}")
        found.flags.writeable = False
        return found

    def slower(self, factor: ArrayLike) -> PronyArray:
        """All times longer by a factor, or by one each."""
        by = checked("factor", factor, low=0.0, strict=True)
        return self._like(self._strengths, self._times * by[..., None], self._alpha)

    def blocks(self, which: NDArray[np.int64]) -> Iterator[Block]:
        """The materials ``which``: those with all their modes together, and the others."""
        whole = ~self.unlike[which]
        if whole.any():
            yield block_of(np.flatnonzero(whole), *self.ordered(which[whole]), creep=self._creep)
        for place in np.flatnonzero(~whole):
            one = self[which[place]]
            strengths, times = (one.J, one.T) if self._creep else (one.E, one.tau)
            alpha = np.array([one.alpha])
            yield block_of(np.array([place]), strengths[None], times[None], alpha, creep=self._creep)

    def ordered(self, which: NDArray[np.int64]) -> tuple[NDArray, NDArray, NDArray]:
        """(Strengths, times, alpha) of some, the longest time first."""
        order = np.argsort(-self._whole[1][which], axis=1, kind="stable")
        strengths, times = (np.take_along_axis(array[which], order, axis=1) for array in self._whole)
        return strengths, times, self.alpha[which]

    @cached_property
    def unlike(self) -> NDArray[np.bool_]:
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


def block_of(rows: NDArray, strengths: NDArray, times: NDArray, alpha: NDArray, *, creep: bool) -> Block:
    """Series of equal numbers of modes; times descending."""
    return Block(rows, (of_creep if creep else of_relaxation)(strengths, times, alpha))


def _kept(array: NDArray[np.float64]) -> NDArray[np.float64]:
    array = array.copy()
    array.flags.writeable = False
    return array
