"""Free rolling by the law of steady rolling, and where it is accurate: by the next term of M = M(V) + N(V) V'.

N acts as an added mass.  Divided by the mass it is the unsteadiness g |N(V)| with g = gamma/(1 + j), which is about the
relative error of V in a motion where it was no larger before (docs/validity.md).
Free rolling depends on u = kappa V, on g and on the material:
u' = -g kappa M(u); the distance is the integral of u du/(g kappa M), in units of l0.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from ...core.scale import Scale
from ...core.typed import Booleans, Floats, Integers
from ...materials.bodies import one_series
from ...materials.law_modes import by_modes
from ...materials.law_table import law_table
from ...materials.prony import Prony
from ..contact_table import rolling
from ..parameters import Parameters, refuse_cover, series_in_own_time

#: Points of a curve in an octave of u: the splines then have errors below 1e-6.
_PER_OCTAVE = 16
#: Octaves of 1/u beyond the shortest and the longest time of a material, where N and M are in their limits to 1e-6.
_MARGIN = 20
#: Length in half contact lengths at rest over which a mode remembers the indentation, divided by 2 u T of the mode;
#: measured with a transient solver (docs/validity.md).
_MEMORY = 0.681
#: Largest such length divided by twice the coasting distance; measured likewise.
_SHORT = 4.84
#: Smallest distance, half contact lengths at rest, that limits the memory: as far as the contact climbs; measured
#: likewise.
_CLIMB = 20.0
#: kappa |V| from which on every contact is in its limit of fast rolling, dimensionless.
_FASTEST = 1e300
#: Part of the energy, dimensionless, below which the lost distance is computed as proportional to the lost energy.
_SMALL_LOSS = 1e-7


class Curve:
    """Free rolling of one material as splines over ln u, for g = 1: N, M, time and distance."""

    def __init__(self, material: float | Prony) -> None:
        """Compute the splines.

        material: alpha, or a series in its own time; not elastic.
        """
        from scipy.interpolate import CubicSpline

        series = one_series(material)
        self.modes, self.alpha = (series.J, series.T), series.alpha
        shortest, longest = series.tau[-1], series.T[0]
        octaves = math.ceil(math.log2(longest / shortest * math.sqrt(self.alpha))) + 2 * _MARGIN
        points = np.linspace(0.0, octaves * math.log(2.0), octaves * _PER_OCTAVE + 1) - math.log(longest)
        # The formulas of the modes at 1/(2 zeta) need no kernel of contacts, which a warning need not compile.
        half_rates = 0.5 * np.exp(_MARGIN * math.log(2.0) - points)
        (_, h_over_zeta, half_space, cylinder), _, N = by_modes(material, half_rates)
        self.ln_u = points - _MARGIN * math.log(2.0) - 0.5 * np.log1p(2.0 * h_over_zeta)
        u = np.exp(self.ln_u)
        M = u * (half_space + cylinder)
        self._low, self._high, self._M_high = float(u[0]), float(u[-1]), float(M[-1])
        self._N, self._u2_over_M = CubicSpline(self.ln_u, N), CubicSpline(self.ln_u, u * u / M)
        self._time, self._distance = CubicSpline(self.ln_u, u / M).antiderivative(), self._u2_over_M.antiderivative()
        self._N_slope = self._N(self.ln_u[0], 1)
        self._first_distance = u[0] ** 2 / M[0]  # from u[0] to rest, where M is proportional to u

    def _locate(self, u: Floats) -> tuple[Floats, Floats]:
        """Return (ln u, limited to the curve; u divided by the end of the curve that it is beyond, else 1)."""
        inside = np.clip(u, self._low, self._high)
        return np.log(inside), u / inside

    def N(self, u: Floats) -> Floats:
        """Return N at u, any shape; below the curve linear in u, above it proportional to u^-2."""
        ln_u, beyond = self._locate(u)
        return (self._N(ln_u) + self._N_slope * (np.minimum(beyond, 1.0) - 1.0)) / np.maximum(beyond, 1.0) ** 2

    def M(self, u: Floats) -> Floats:
        """Return kappa M at u, any shape."""
        ln_u, beyond = self._locate(u)
        return np.exp(2.0 * ln_u) / self._u2_over_M(ln_u) * np.where(beyond < 1.0, beyond, 1.0 / beyond)

    def time(self, u: Floats) -> Floats:
        """Return the time from u, any shape, to a fixed speed below the curve."""
        ln_u, beyond = self._locate(u)
        return self._time(ln_u) + 0.5 * self._high / self._M_high * (np.maximum(beyond, 1.0) ** 2 - 1.0)

    def distance(self, u: Floats) -> Floats:
        """Return the distance from u, any shape, to rest, in units of l0."""
        ln_u, beyond = self._locate(u)
        above = self._high**2 / (3.0 * self._M_high) * (np.maximum(beyond, 1.0) ** 3 - 1.0)
        return (self._first_distance + self._distance(ln_u)) * np.minimum(beyond, 1.0) + above

    def limit_speed(self, u: Floats, level: float) -> tuple[Floats, Booleans]:
        """Return the speed at which |N| reaches a level in free rolling.

        u: kappa V at the start, any shape.
        level: of |N|, > 0.
        Returns (u at which |N| first reaches the level, 0 if never; where |N| is above it at the start already, the
        next higher u from which on it is below; whether |N| is below the level at the start).
        """
        roots = np.sort(np.concatenate([self._N.solve(value, extrapolate=False) for value in (level, -level)]))
        falls = roots[self._N(roots) * self._N(roots, 1) < 0.0]
        last = float(np.abs(self._N(self.ln_u[-1])))
        behind = [self._high * math.sqrt(last / level)] if last >= level else []  # where N falls as u^-2
        ends = np.concatenate([[0.0], np.exp(falls), behind, [np.inf]])
        below = np.abs(self.N(u)) < level
        index = np.searchsorted(ends, u, side="right")
        return ends[np.where(below, index - 1, np.minimum(index, ends.size - 1))], below

    def work(self, u: Floats, distance: Floats, rested: Floats) -> Floats:
        """Return the work W of leaving the indentation of a standstill; in SI units it is P l0^2 W/(4 R).

        The last term is what the contact gains as it shrinks.  Under a load P the elastic energy and the height of a
        contact of half length a and compliance C hold C ln(1/a), so that they differ between rest and fast rolling,
        both of the instantaneous compliance 1/alpha, by ln(a_rest/a_fast)/(4 alpha).  After a long rest that is
        sqrt(alpha): ln(alpha)/(8 alpha); without a rest the contact starts as short as it rolls, and it is 0.  Between
        the two the slowest mode rules how much of it there is; the term is below 0.05 for every alpha.

        u: kappa V at the start, (n,).
        distance: to rest, in units of l0, (n,).
        rested: time of the standstill in the material's own time, (n,).
        Returns W, dimensionless, (n,).
        """
        longest, W = _SHORT * np.maximum(2.0 * distance, _CLIMB), np.zeros(u.shape)
        for J, T in zip(*self.modes, strict=True):
            L, fresh = np.minimum(2.0 * u * T, longest), np.exp(-rested / T)
            W += 0.5 * J * ((1.0 - fresh) * np.log(np.hypot(1.0, _MEMORY * L)) - fresh / (1.0 + 2.0 / L))
        grown = -np.expm1(-rested / self.modes[1][0])
        return np.maximum(W - grown * math.log(self.alpha) / (8.0 * self.alpha), 0.0)


@lru_cache(maxsize=256)  # as many as the validity of an ensemble examines; 0.1 MB each
def curve_of(material: float | Prony) -> Curve | None:
    """Return the curve of a material in its own time; None for an elastic one, which rolls for ever."""
    return Curve(material) if one_series(material).alpha > 1.0 else None


class ContactLengths(NamedTuple):
    """Lengths of the contact at a speed, dimensionless.

    reach : distance from the axis to the far end of the contact divided by R, lam (1 + epsilon)/(2 kappa).
    epsilon : shift towards the leading edge in half contact lengths.
    lam : contact length divided by l0.
    """

    reach: Any
    epsilon: Any
    lam: Any

    @classmethod
    def of(cls, lam: Any, epsilon: Any, kappa: Any) -> ContactLengths:
        """Return the lengths of contacts of given lam, epsilon and kappa."""
        return cls(lam * (1.0 + epsilon) / (2.0 * kappa), epsilon, lam)


class Reach(NamedTuple):
    """The part of free rolling in which the error of V is below a level.

    Attributes
    ----------
    speed : the part ends at this speed; 0: at rest.  Where the error is above the level already at V, the next higher
        speed from which on it is below.
    time, way : time and distance from V to there; an infinite time: to rest.  0 where the error is above the level
        at V.
    left : distance from there to rest.
    """

    speed: Any
    time: Any
    way: Any
    left: Any


class Start(NamedTuple):
    """Losses of a start at V after a long standstill, compared with a start from steady contact.

    Attributes
    ----------
    speed, way : lost speed and lost distance; all of V where the cylinder stays in its indentation.
    """

    speed: Any
    way: Any


@dataclass(frozen=True, eq=False)
class FreeRolling:
    """Initial states of free rolling, each with one of several materials.

    Attributes
    ----------
    materials : alphas or series in their own times.
    index : of the material of each state, in the shape of u.
    u : kappa |V| in the material's own time, dimensionless, any shape.
    g : gamma/(1 + j) in the material's own time.
    speed, time, length : 1 of u, of the own time and of l0, in the units of the caller.
    units : names of these units; empty for dimensionless ones.
    """

    materials: Sequence[float | Prony]
    index: Integers
    u: Floats
    g: Floats
    speed: Any
    time: Any
    length: Any
    units: tuple[str, str, str] = ("", "", "")

    @classmethod
    def of_scene(cls, scene: Parameters, V: Any) -> FreeRolling:
        """Return the states of a scene at speeds V, dimensionless, any shape; raises ParameterError for a cover."""
        refuse_cover(scene, "how it rolls freely from rest needs N, which is not known")
        materials: Any
        unit: Any
        if scene.material_array is None:
            material, unit = scene.in_own_time()
            materials, index = (
                np.unique(material, return_inverse=True) if np.ndim(material) else ([material], np.zeros((), int))
            )
        else:
            pairs = (series_in_own_time(one_series(one)) for one in scene.material_array)
            materials, unit = zip(*pairs, strict=True)
            unit = np.array(unit, np.float64)
            index = np.arange(unit.size)
        gamma = np.nan if scene.gamma is None else scene.gamma
        with np.errstate(over="ignore"):
            u = np.asarray(scene.kappa * np.abs(V) * unit + 0.0 * index)
            g = gamma * unit * unit / (1.0 + np.asarray(scene.j))
        u, index = np.broadcast_arrays(u, index, g)[:2]
        return cls(materials, index, u, g, 1.0 / (scene.kappa * unit), unit, 1.0 / scene.kappa)

    def scaled(self, scale: Scale) -> FreeRolling:
        """Return the same states with the units of a cylinder's scale."""
        if not scale.si:
            return self
        speed, time, length = self.speed * scale["V"], self.time * scale["t"], self.length * scale["x"]
        return replace(self, speed=speed, time=time, length=length, units=("m/s", "s", "m"))

    def take(self, index: tuple[Any, ...]) -> FreeRolling:
        """Return the states at an index of numpy into u."""
        arrays = ("index", "u", "g", "speed", "time", "length")
        return replace(self, **{name: np.broadcast_to(getattr(self, name), self.u.shape)[index] for name in arrays})

    def _groups(self) -> Iterator[tuple[float | Prony, Any]]:
        """Yield each material that occurs, and the flat index of its states."""
        if len(self.materials) == 1:
            yield self.materials[0], slice(None)
            return
        order = np.argsort(self.index, axis=None, kind="stable")
        ends = np.searchsorted(self.index.ravel()[order], np.arange(len(self.materials) + 1))
        for material, (first, last) in zip(self.materials, pairwise(ends), strict=True):
            if last > first:
                yield material, order[first:last]

    def contact_lengths(self, kappa: Any) -> ContactLengths:
        """Return the lengths of the contacts of the states; ``kappa`` of the scene, broadcasts with u."""
        out, u = np.empty((2, self.u.size)), np.minimum(self.u.ravel(), _FASTEST)
        for material, part in self._groups():
            out[:, part] = rolling(law_table(material), u[part], "lam", "epsilon")
        lam, epsilon = (row.reshape(self.u.shape)[()] for row in out)
        return ContactLengths.of(lam, epsilon, kappa)

    def _evaluate(
        self, function: Callable[..., Sequence[Floats]], elastic: Sequence[float], *more: Any
    ) -> list[Floats]:
        """Evaluate a function of the curve of each material at its states.

        function: takes a curve, u, g and ``more`` of some states, (n,), and returns several arrays (n,).
        elastic: its values for an elastic material, which has no curve.
        more: further arguments, broadcast to u.
        Returns the arrays in the shape of u.
        """
        out = np.empty((len(elastic), self.u.size))
        arrays = [np.broadcast_to(array, self.u.shape).ravel() for array in (self.u, self.g, *more)]
        with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
            for material, part in self._groups():
                curve = curve_of(material)
                values: Any = elastic if curve is None else function(curve, *(array[part] for array in arrays))
                for row, value in zip(out, values, strict=True):
                    row[part] = value
        return [row.reshape(self.u.shape)[()] for row in out]

    @cached_property
    def unsteadiness(self) -> Any:
        """g |N|, dimensionless, in the shape of u; 0 at rest."""
        return self._evaluate(lambda curve, u, g: [np.where(u > 0.0, g * np.abs(curve.N(u)), 0.0)], [0.0])[0]

    def distance(self) -> Any:
        """Return the distance to rest by the law of steady rolling, in the unit of the caller."""
        return self._evaluate(lambda curve, u, g: [curve.distance(u) / g], [np.inf])[0] * self.length

    def reach(self, level: float) -> Reach:
        """Return the part of free rolling in which the unsteadiness is below a level, dimensionless."""

        def evaluate(curve: Curve, u: Floats, g: Floats) -> list[Floats]:
            end, below = np.empty(u.size), np.empty(u.size, bool)
            levels, group = np.unique(g, return_inverse=True)
            for n, value in enumerate(levels):
                part = group == n if levels.size > 1 else slice(None)
                end[part], below[part] = curve.limit_speed(u[part], level / value)
            start, left = np.where(below, end, u), curve.distance(np.where(below, end, u))
            time = np.where(start > 0.0, curve.time(u) - curve.time(start), np.inf)
            way = np.where(below, curve.distance(u) - left, 0.0)
            return [end, np.where(below, time, 0.0) / g, way / g, left / g]

        end, time, way, left = self._evaluate(evaluate, [0.0, np.inf, np.inf, 0.0])
        return Reach(end * self.speed, time * self.time, way * self.length, left * self.length)

    def start(self, rested: float = math.inf) -> Start:
        """Return the losses of a start after a standstill; ``rested``: its time, in the unit of the caller."""

        def evaluate(curve: Curve, u: Floats, g: Floats, rested: Floats) -> list[Floats]:
            way = curve.distance(u)
            W = curve.work(u, way / g, rested)
            part = np.where(u > 0.0, np.minimum(0.5 * g * W / u / u, 1.0), 0.0)
            kept = np.sqrt(1.0 - part)
            lost = np.where(part > _SMALL_LOSS, (way - curve.distance(u * kept)) / g, 0.25 * W / curve.M(u))
            return [u * part / (1.0 + kept), np.where(u > 0.0, lost, 0.0)]

        speed, way = self._evaluate(evaluate, [0.0, 0.0], rested / self.time)
        return Start(speed * self.speed, way * self.length)
