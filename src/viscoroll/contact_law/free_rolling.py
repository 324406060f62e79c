"""How far a free motion goes by the law of steady rolling: from the term that follows it, M = M(V) + N(V) V'.

N acts as an added mass.  Its share, the unsteadiness g |N(V)| with g = gamma/(1 + j), is about the error of V over V
in a motion where it was no larger before (docs/validity.md).
Free rolling depends on u = kappa V, on g and the material:
u' = -g kappa M(u), over a way of the integral of u du/(g kappa M), in l0.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from ..core.array_types import Booleans, Floats, Integers
from ..core.scale import Scale
from ..materials.bodies import total_series
from ..materials.law.evaluate import evaluate_by_modes
from ..materials.law.table import law_table
from ..materials.prony import Prony
from .contact_table import pure_rolling_fields

#: ln u in steps of a sixteenth of an octave, to 20 octaves beyond the times of a material, where it is in its limits
#: to 1e-6
_PER_OCTAVE, _MARGIN = 16, 20
#: of the work of leaving the imprint of a rest, measured with a transient solver: of the length of a mode's memory, and
#: of the way of a motion that is shorter, at least as far as the contact climbs; half lengths at
#: rest (docs/validity.md)
_MEMORY, _SHORT, _CLIMB = 0.681, 4.84, 20.0
#: kappa |V|, where every contact is at its limits
_FASTEST = 1e300
#: share of the energy below which what it costs is proportional to it
_LITTLE = 1e-7


class Curve:
    """Free rolling of one material over ln u, g = 1: N, time and way."""

    def __init__(self, material: float | Prony) -> None:
        from scipy.interpolate import CubicSpline

        series = total_series(material)
        self.modes, self.alpha = (series.J, series.T), series.alpha
        shortest, longest = series.tau[-1], series.T[0]
        octaves = math.ceil(math.log2(longest / shortest * math.sqrt(self.alpha))) + 2 * _MARGIN
        places = np.linspace(0.0, octaves * math.log(2.0), octaves * _PER_OCTAVE + 1) - math.log(longest)
        # by the formulas of the modes at places of 1/(2 zeta): kernels of contacts need not be compiled for a warning
        (_, rise, half_space, cylinder), _, N = evaluate_by_modes(
            material, 0.5 * np.exp(_MARGIN * math.log(2.0) - places)
        )
        self.s = places - _MARGIN * math.log(2.0) - 0.5 * np.log1p(2.0 * rise)
        u = np.exp(self.s)
        M = u * (half_space + cylinder)
        self.low, self.high, self.M_high = float(u[0]), float(u[-1]), float(M[-1])
        self._N, self._rate = CubicSpline(self.s, N), CubicSpline(self.s, u * u / M)
        self._time, self._way = CubicSpline(self.s, u / M).antiderivative(), self._rate.antiderivative()
        self._rise = self._N(self.s[0], 1)
        self._first = u[0] ** 2 / M[0]  # the way from u[0] on, where M is proportional to u

    def _place(self, u: Floats) -> tuple[Floats, Floats]:
        """(ln u within the curve, u over the end that it is beyond)."""
        inside = np.clip(u, self.low, self.high)
        return np.log(inside), u / inside

    def N(self, u: Floats) -> Floats:
        """Linear in u below the curve, as u^-2 above."""
        s, beyond = self._place(u)
        return (self._N(s) + self._rise * (np.minimum(beyond, 1.0) - 1.0)) / np.maximum(beyond, 1.0) ** 2

    def M(self, u: Floats) -> Floats:
        """kappa M."""
        s, beyond = self._place(u)
        return np.exp(2.0 * s) / self._rate(s) * np.where(beyond < 1.0, beyond, 1.0 / beyond)

    def time(self, u: Floats) -> Floats:
        """From u to some u below the curve."""
        s, beyond = self._place(u)
        return self._time(s) + 0.5 * self.high / self.M_high * (np.maximum(beyond, 1.0) ** 2 - 1.0)

    def way(self, u: Floats) -> Floats:
        """From u to rest, in l0."""
        s, beyond = self._place(u)
        above = self.high**2 / (3.0 * self.M_high) * (np.maximum(beyond, 1.0) ** 3 - 1.0)
        return (self._first + self._way(s)) * np.minimum(beyond, 1.0) + above

    def bound(self, u: Floats, least: float) -> tuple[Floats, Booleans]:
        """(u down to which |N| stays below ``least`` on the way from u, or 0; whether it is below at u).

        Where it is not, the next u above from which on it is.
        """
        roots = np.sort(np.concatenate([self._N.solve(level, extrapolate=False) for level in (least, -least)]))
        falls = roots[self._N(roots) * self._N(roots, 1) < 0.0]
        last = float(np.abs(self._N(self.s[-1])))
        behind = [self.high * math.sqrt(last / least)] if last >= least else []  # where N falls as u^-2
        ends = np.concatenate([[0.0], np.exp(falls), behind, [np.inf]])
        below = np.abs(self.N(u)) < least
        at = np.searchsorted(ends, u, side="right")
        return ends[np.where(below, at - 1, np.minimum(at, ends.size - 1))], below

    def work(self, u: Floats, way: Floats, rested: Floats) -> Floats:
        """W of leaving the imprint of a rest: an energy of P l0^2 W/(4 R) in SI units; ``way`` in l0.

        The last term is what the contact gains as it shrinks.  Under a load P the elastic energy and the height of a
        contact of half length a and compliance C hold C ln(1/a), so that they differ between rest and fast rolling,
        both of the instantaneous compliance 1/alpha, by ln(a_rest/a_fast)/(4 alpha).  After a long rest that is
        sqrt(alpha): ln(alpha)/(8 alpha); without a rest the contact starts as short as it rolls, and it is 0.  Between
        the two the slowest mode rules how much of it there is; the term is below 0.05 for every alpha.
        """
        longest, W = _SHORT * np.maximum(2.0 * way, _CLIMB), np.zeros(u.shape)
        for J, T in zip(*self.modes, strict=True):
            L, fresh = np.minimum(2.0 * u * T, longest), np.exp(-rested / T)
            W += 0.5 * J * ((1.0 - fresh) * np.log(np.hypot(1.0, _MEMORY * L)) - fresh / (1.0 + 2.0 / L))
        grown = -np.expm1(-rested / self.modes[1][0])
        return np.maximum(W - grown * math.log(self.alpha) / (8.0 * self.alpha), 0.0)


@lru_cache(maxsize=256)  # those that an ensemble's validity looks at; 0.1 MB each
def curve(material: float | Prony) -> Curve | None:
    """The curve of a material in its own time; None of an elastic one, which rolls for ever."""
    return Curve(material) if total_series(material).alpha > 1.0 else None


class Strained(NamedTuple):
    """Of the contact at a speed: lam (1 + epsilon)/(2 kappa), epsilon, and lam."""

    reach: Any
    epsilon: Any
    lam: Any


class Reach(NamedTuple):
    """Down to where V of a free motion is right to a share of V.

    Attributes
    ----------
    speed : down to this one; 0: to rest.  Where it is not right even at V, the next higher speed from which on it is.
    time, way : until there, from V on; infinite time: to rest.  0 where it is not right at V.
    left : the way from there to rest.
    """

    speed: Any
    time: Any
    way: Any
    left: Any


class Start(NamedTuple):
    """What a start at V from a contact that rested long loses first, against one from steady contact.

    Attributes
    ----------
    speed, way : lost; all of V where the cylinder is caught in its own imprint.
    """

    speed: Any
    way: Any


@dataclass(frozen=True, eq=False)
class Free:
    """States that roll freely, each of one of the materials, in their own times.

    ``speed``, ``time`` and ``length`` are what 1 of u, of time and of l0 are to the caller, ``words`` their units.
    """

    materials: Sequence[float | Prony]
    which: Integers
    u: Floats
    g: Floats
    speed: Any
    time: Any
    length: Any
    words: tuple[str, str, str] = ("", "", "")

    def scaled(self, scale: Scale) -> Free:
        """The same in other units."""
        if not scale.si:
            return self
        speed, time, length = self.speed * scale["V"], self.time * scale["t"], self.length * scale["x"]
        return replace(self, speed=speed, time=time, length=length, words=("m/s", "s", "m"))

    def at(self, place: tuple[Any, ...]) -> Free:
        """One of the states."""
        arrays = ("which", "u", "g", "speed", "time", "length")
        return replace(self, **{name: np.broadcast_to(getattr(self, name), self.u.shape)[place] for name in arrays})

    def _groups(self) -> Iterator[tuple[float | Prony, Any]]:
        """Materials that are there, and where."""
        if len(self.materials) == 1:
            yield self.materials[0], slice(None)
            return
        order = np.argsort(self.which, axis=None, kind="stable")
        ends = np.searchsorted(self.which.ravel()[order], np.arange(len(self.materials) + 1))
        for material, (first, last) in zip(self.materials, pairwise(ends), strict=True):
            if last > first:
                yield material, order[first:last]

    def strained(self, kappa: Any) -> Strained:
        """Lengths of the contact."""
        out, u = np.empty((2, self.u.size)), np.minimum(self.u.ravel(), _FASTEST)
        for material, part in self._groups():
            out[:, part] = pure_rolling_fields(law_table(material), u[part], "lam", "epsilon")
        lam, epsilon = (row.reshape(self.u.shape)[()] for row in out)
        return Strained(lam * (1.0 + epsilon) / (2.0 * kappa), epsilon, lam)

    def each(self, of: Callable[..., Sequence[Floats]], elastic: Sequence[float], *more: Any) -> list[Floats]:
        """Numbers of every state, by u, g and ``more``; ``elastic``: of those that no law brakes."""
        out = np.empty((len(elastic), self.u.size))
        given = [np.broadcast_to(each, self.u.shape).ravel() for each in (self.u, self.g, *more)]
        with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
            for material, part in self._groups():
                known = curve(material)
                values: Any = elastic if known is None else of(known, *(each[part] for each in given))
                for row, value in zip(out, values, strict=True):
                    row[part] = value
        return [row.reshape(self.u.shape)[()] for row in out]

    @cached_property
    def unsteadiness(self) -> Any:
        """g |N|; 0 at rest."""
        return self.each(lambda curve, u, g: [np.where(u > 0.0, g * np.abs(curve.N(u)), 0.0)], [0.0])[0]

    def whole(self) -> Any:
        """The way to rest by the law."""
        return self.each(lambda curve, u, g: [curve.way(u) / g], [np.inf])[0] * self.length

    def reach(self, level: float) -> Reach:
        """Until the unsteadiness was ``level``."""

        def of(curve: Curve, u: Floats, g: Floats) -> list[Floats]:
            end, below = np.empty(u.size), np.empty(u.size, bool)
            several, own = np.unique(g, return_inverse=True)
            for n, one in enumerate(several):
                some = own == n if several.size > 1 else slice(None)
                end[some], below[some] = curve.bound(u[some], level / one)
            start, left = np.where(below, end, u), curve.way(np.where(below, end, u))
            time = np.where(start > 0.0, curve.time(u) - curve.time(start), np.inf)
            way = np.where(below, curve.way(u) - left, 0.0)
            return [end, np.where(below, time, 0.0) / g, way / g, left / g]

        end, time, way, left = self.each(of, [0.0, np.inf, np.inf, 0.0])
        return Reach(end * self.speed, time * self.time, way * self.length, left * self.length)

    def start(self, rested: float = math.inf) -> Start:
        """What a start from a rest of this time, as the caller counts it, costs."""

        def of(curve: Curve, u: Floats, g: Floats, rested: Floats) -> list[Floats]:
            way = curve.way(u)
            W = curve.work(u, way / g, rested)
            share = np.where(u > 0.0, np.minimum(0.5 * g * W / u / u, 1.0), 0.0)
            kept = np.sqrt(1.0 - share)
            lost = np.where(share > _LITTLE, (way - curve.way(u * kept)) / g, 0.25 * W / curve.M(u))
            return [u * share / (1.0 + kept), np.where(u > 0.0, lost, 0.0)]

        speed, way = self.each(of, [0.0, 0.0], rested / self.time)
        return Start(speed * self.speed, way * self.length)
