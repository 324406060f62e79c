"""Whether the law of steady rolling may drive a motion, and down to which speed: :class:`Steadiness`, in words too."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np

from .assumptions import Assumption
from .free_rolling import Free, Reach, Start

#: unsteadiness up to which V is right to some 10 %: measured with a transient solver of many modes (docs/validity.md)
STEADY_LIMIT = 0.1
#: share of its speed, seven tenths of its energy, that a start from rest may lose: beyond, the cylinder was caught
CAUGHT = 0.45
#: a speed that is as good as rest, where a motion ended
_REST = 1e-300


class Steadiness(Assumption):
    """Whether the law of steady rolling may drive a motion, and how far; everything below is in the units of the call.

    ``value`` is the unsteadiness gamma |N(V)|/(1 + j), of a motion the largest so far; it counts as small up to 0.1,
    where V is right to some 10 %.  The attributes are of free rolling from each V, by the law.

    Attributes
    ----------
    one_percent, ten_percent : the :class:`Reach` within which V is right to about 1 % and 10 %.
    start : what a :class:`Start` from a contact that rested long costs.
    whole : the way to rest.
    share : of that way, or of the way of a motion, what lies where V is not right to 10 %; None where it is not known.
    """

    free: Free
    #: of a motion, ``share``
    rolled: Any = None

    @classmethod
    def of(cls, free: Free) -> Assumption:
        """That of states that are let go."""
        if free.u.size and not free.u.any():
            return Assumption(None, None, "at rest there is nothing to say: it is the speed that decides")
        return cls._made(free.unsteadiness, free)

    @classmethod
    def along(cls, free: Free, rolls: Any, x: Any, *, ends: bool) -> Steadiness:
        """That of motions over times, the first axis; ``ends``: of each as a whole.

        rolls : where they do not slip fully, which friction rules.  x : places; NaN where they are not known.
        """
        free = replace(free, u=np.where(np.maximum.accumulate(free.u > 0.0, axis=0), np.maximum(free.u, _REST), 0.0))
        value = np.maximum.accumulate(np.where(rolls, free.unsteadiness, 0.0), axis=0)
        fastest = free.at((np.argmax(free.u, axis=0), *np.indices(free.u.shape[1:])))
        way, steps = free.whole(), np.abs(np.diff(x, axis=0)) * rolls[1:]
        slow = np.where(fastest.unsteadiness > STEADY_LIMIT, np.inf, fastest.reach(STEADY_LIMIT).left)
        # of each step, as in free rolling
        with np.errstate(invalid="ignore"):
            below, whole = (np.abs(np.diff(each, axis=0)) for each in (np.minimum(way, slow), way))
        part = np.divide(below, whole, out=1.0 * (way[1:] < slow), where=(0.0 < whole) & (whole < np.inf))
        share = (steps * part).sum(axis=0) / np.maximum(np.abs(np.diff(x, axis=0)).sum(axis=0), _REST)
        return cls._made(value[-1] if ends else value, fastest, share)

    @classmethod
    def _made(cls, value: Any, free: Free, rolled: Any = None) -> Steadiness:
        sentence = "no motion"
        if np.size(value):
            most = float(np.max(value))
            worst = free.at(np.unravel_index(np.argmax(value), free.u.shape)) if free.u.ndim else free
            sentence = _let_go(worst) if rolled is None else _rolled(worst, most, float(np.mean(rolled)))
        made = cls(value <= STEADY_LIMIT, value, sentence)
        made.free, made.rolled = free, rolled
        return made

    @cached_property
    def one_percent(self) -> Reach:
        return self.free.reach(0.1 * STEADY_LIMIT)

    @cached_property
    def ten_percent(self) -> Reach:
        return self.free.reach(STEADY_LIMIT)

    @cached_property
    def start(self) -> Start:
        return self.free.start()

    @cached_property
    def whole(self) -> Any:
        return self.free.whole()

    @cached_property
    def share(self) -> Any:
        if self.rolled is not None:
            return self.rolled
        left, whole = np.asarray(self.ten_percent.left), np.asarray(self.whole)
        return np.divide(left, whole, out=np.asarray(self.value > STEADY_LIMIT, np.float64), where=left < whole)[()]


def _let_go(free: Free) -> str:
    """One state that is let go, in words that one can act on."""
    speed, time, length = (f" {word}".rstrip() for word in free.words)
    nu, most, whole = float(free.unsteadiness), free.reach(STEADY_LIMIT), free.whole()
    said = f"unsteadiness {nu:.2g}: "
    if nu > STEADY_LIMIT:
        return said + (
            "too slow for the law of steady rolling to drive a motion (contact states and constant speed are not "
            f"concerned); faster than {most.speed:.2g}{speed} V is right to 10 %"
        )
    if not np.isfinite(whole):
        return said + "let go here it rolls for ever"
    fine, start = free.reach(0.1 * STEADY_LIMIT), free.start()
    said += f"let go here it rolls {whole:.4g}{length} by the law of steady rolling; V is right to "
    said += ("1 % to the end" if not fine.speed else f"1 % down to {fine.speed:.2g}{speed}, to ") if fine.time else ""
    if fine.speed:
        end = f"down to {most.speed:.2g}{speed}, after {most.time:.3g}{time} and {most.left:.2g}{length} before the end"
        said += f"10 % {end if most.speed else 'to the end'}"
    if start.speed > CAUGHT * float(free.u * free.speed):
        return said + "; a contact that rested long would hold it in its imprint"
    return said + f"; a contact that rested long would cost {start.speed:.2g}{speed} and {start.way:.2g}{length} of way"


def _rolled(free: Free, most: float, share: float) -> str:
    """A motion, or the worst of several, from its fastest speed."""
    if most <= STEADY_LIMIT:
        return f"unsteadiness up to {most:.2g}: by the law of steady rolling V is right to 10 % all along"
    speed = f"{free.reach(STEADY_LIMIT).speed:.2g} {free.words[0]}".rstrip()
    below = "" if np.isnan(share) else f"; {100.0 * share:.2g} % of the way lies below"
    return f"unsteadiness up to {most:.2g}: by the law of steady rolling V is right to 10 % down to {speed}{below}"
