"""Pairs of bodies, one for each state or motion: :class:`BodiesArray`, which ``Bodies`` makes of arrays."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..checks import broadcast_shape, checked
from ..errors import ParameterError
from .prony import Prony
from .prony_array import Block, MaterialArray, PronyArray, block_of
from .prony_forms import MOST_MODES, of_relaxation


class _Given(NamedTuple):
    """A body of some pairs: its series, times descending, and its part of the compliance."""

    by_creep: bool
    strengths: NDArray[np.float64]
    times: NDArray[np.float64]
    alpha: NDArray[np.float64]
    part: NDArray[np.float64]

    def creep(self) -> tuple[NDArray, NDArray]:
        """What is its in the creep of the pair, strengths and times."""
        strengths, times = self.strengths, self.times
        if not self.by_creep:
            modes = of_relaxation(strengths, times, self.alpha)
            strengths, times = modes.J, 1.0 / modes.b
        return self.part[:, None] * strengths, times


@dataclass(frozen=True)
class _Body:
    """A body of all pairs."""

    series: Prony | PronyArray
    is_half_space: bool

    def unlike(self, which: NDArray[np.int64]) -> NDArray[np.bool_]:
        """Which of these have fewer modes than the others."""
        one = self.series
        return one.unlike[_within(which, one)] if isinstance(one, PronyArray) else np.zeros(which.size, bool)

    def of(self, which: NDArray[np.int64], share: NDArray[np.float64]) -> _Given:
        """It in some pairs; ``share``: the cylinder's."""
        one, part = self.series, 1.0 - share if self.is_half_space else share
        if isinstance(one, PronyArray):
            return _Given(one.by_creep, *one.ordered(_within(which, one)), part)
        modes = (one.J, one.T) if one.by_creep else (one.E, one.tau)
        strengths, times = (np.broadcast_to(each, (which.size, each.size)) for each in modes)
        return _Given(one.by_creep, strengths, times, np.full(which.size, one.alpha), part)


def _within(which: Any, series: PronyArray) -> Any:
    """Numbers of pairs as numbers of their series: 0 where one series is that of all."""
    return np.minimum(which, len(series) - 1)


class BodiesArray(MaterialArray):
    """Pairs 0 ... n - 1, ``Bodies`` each.

    Made by ``Bodies(cylinder, half_space, share)`` where a body is n series (:class:`PronyArray`) or the share an array
    (n,); what is single is that of all pairs.

    Attributes
    ----------
    alpha : (n,), instantaneous over long-time stiffness.
    shape : (n,).

    Raises
    ------
    ParameterError
        What is no series, numbers of them that differ, a share outside [0, 1], more than 64 modes in both bodies.

    Notes
    -----
    Immutable, hashable, equal where what was given is.  ``p[i]`` is a single pair, and ``p[i:k]`` some of them.
    """

    def __init__(
        self, cylinder: Prony | PronyArray, half_space: Prony | PronyArray, share: ArrayLike, *, one: Any
    ) -> None:
        self._one = one  # the class of a single pair
        for name, body in (("cylinder", cylinder), ("half_space", half_space)):
            if not isinstance(body, Prony | PronyArray):
                raise ParameterError(name, f"{body!r:.60}", "a Prony series, or one for each pair")
        shares = checked("share", share, low=0.0, high=1.0).copy()
        shares.flags.writeable = False
        if shares.ndim > 1:
            raise ParameterError("share", f"of shape {shares.shape}", "a number, or one for each pair, (n,)")
        sizes = {"cylinder": cylinder, "half_space": half_space}
        given = {name: np.empty(body.shape) for name, body in sizes.items() if isinstance(body, PronyArray)}
        self._shape = broadcast_shape(**given, share=shares)
        self.cylinder, self.half_space, self.share = cylinder, half_space, shares
        most = sum(_most(body) for body in (cylinder, half_space))
        if most > MOST_MODES:
            raise ParameterError("cylinder, half_space", f"of {most} modes together", f"at most {MOST_MODES}")

    @property
    def shape(self) -> tuple[int]:
        """(n,)."""
        return (self._shape[0],)

    @property
    def like(self) -> bool:
        """Whether the two deform alike in every pair, which is then one series."""
        return isinstance(self.cylinder, PronyArray) and self._same and bool((self.share == 0.5).all())

    @cached_property
    def alpha(self) -> NDArray[np.float64]:
        """Instantaneous over long-time stiffness, of each."""
        first, second = np.asarray(self.cylinder.alpha), np.asarray(self.half_space.alpha)
        found = first if self._same else 1.0 / (self.share / first + (1.0 - self.share) / second)
        return np.broadcast_to(found, self.shape)

    def __getitem__(self, which: Any) -> Any:
        numbers, share = np.arange(len(self))[which], np.broadcast_to(self.share, self.shape)[which]
        cylinder, half_space = (_picked(body, numbers) for body in (self.cylinder, self.half_space))
        if isinstance(which, slice | np.ndarray):
            return BodiesArray(cylinder, half_space, share, one=self._one)
        return self._one(cylinder, half_space, float(share))

    def blocks(self, which: NDArray[np.int64]) -> Iterator[Block]:
        """The pairs ``which``, those of as many modes together."""
        share = np.broadcast_to(self.share, self.shape)[which]
        if self._same:
            yield from self._of_one(which, share)
            return
        both = _Body(self.cylinder, False), _Body(self.half_space, True)
        for bodies in ([both[0]], [both[1]], list(both)):  # those that deform
            deform = [(share > 0.0) == (both[0] in bodies), (share < 1.0) == (both[1] in bodies)]
            some = np.flatnonzero(deform[0] & deform[1])
            if some.size:
                yield from self._blocks(some, which[some], share[some], bodies)

    def _of_one(self, which: NDArray, share: NDArray) -> Iterator[Block]:
        """Pairs of two bodies of one series, which is that of both together."""
        series = self.cylinder
        if isinstance(series, Prony):
            series, which = _repeated(series), np.zeros(which.size, np.int64)
        for block in series.blocks(_within(which, series)):
            weights = np.broadcast_to(1.0 - share[block.rows, None], block.modes.J.shape)
            yield block._replace(weights=weights)

    def _blocks(self, places: NDArray, which: NDArray, share: NDArray, bodies: list[_Body]) -> Iterator[Block]:
        """Pairs of which these ``bodies`` deform; ``places``: theirs in the block."""
        odd = np.zeros(which.size, bool)
        for body in bodies:
            odd |= body.unlike(which)
        rows, given = np.flatnonzero(~odd), [body.of(which[~odd], share[~odd]) for body in bodies]
        J, T = (np.concatenate(each, axis=1) for each in zip(*(one.creep() for one in given), strict=True))
        own = np.repeat([float(body.is_half_space) for body in bodies], [one.times.shape[1] for one in given])
        order = np.argsort(-T, axis=1, kind="stable")
        J, T = (np.take_along_axis(each, order, axis=1) for each in (J, T))
        apart = (np.diff(T, axis=1) != 0.0).all(axis=1)
        odd[rows[~apart]] = True
        rows = rows[apart]
        if rows.size:
            found = block_of(places[rows], J[apart], T[apart], self.alpha[which[rows]], creep=True)
            yield found._replace(weights=own[order[apart]])
        for n in np.flatnonzero(odd):
            yield self._alone(places[n : n + 1], int(which[n]))

    def _alone(self, place: NDArray, number: int) -> Block:
        """A pair with a mode less than the others, or of two bodies with modes of one time."""
        own = self[number]
        total = own.total
        alone = total.J[None], total.T[None], np.array([total.alpha])
        return block_of(place, *alone, creep=True)._replace(weights=own.half_space_weights[None])

    @cached_property
    def _same(self) -> bool:
        return bool(self.cylinder == self.half_space)

    def _key(self) -> tuple[Any, ...]:
        return self.cylinder, self.half_space, self.share.shape, self.share.tobytes()

    def __eq__(self, other: object) -> bool:
        return self._key() == other._key() if isinstance(other, BodiesArray) else NotImplemented

    def __hash__(self) -> int:
        return hash(self._key())

    def __repr__(self) -> str:
        return f"<{self.shape[0]} pairs of {_most(self.cylinder)} and {_most(self.half_space)} modes>"


def _most(series: Prony | PronyArray) -> int:
    """Modes of a body, in any pair."""
    return series.given[0].shape[1] if isinstance(series, PronyArray) else series.E.size


def _picked(series: Prony | PronyArray, numbers: Any) -> Any:
    """The series of one pair, or of those of a slice."""
    if isinstance(series, Prony):
        return series
    if numbers.ndim == 0:
        return series[int(_within(numbers, series))]
    return series[_within(numbers, series)]


def _repeated(one: Prony) -> Any:
    """A series as an array of it alone."""
    if one.by_creep:
        return Prony.creep(one.J[None], one.T[None], alpha=one.alpha)
    return Prony(one.E[None], one.tau[None])
