"""Free rolling by the law of steady rolling, and where it is accurate: by the next term of M = M(V) + N(V) V'.

N acts as an added mass.  Divided by the mass it is the unsteadiness g |N(V)| with g = gamma/(1 + j), which is about the
relative error of V in a motion where it was no larger before (docs/validity.md).
Free rolling depends on u = kappa V, on g and on the material:
u' = -g kappa M(u); the distance is the integral of u du/(g kappa M), in units of l0.

M is the rolling moment over P R, kappa = R/l0 with the contact length at rest l0, gamma = P T_ref^2/(m R), j the moment
of inertia over m R^2.  The own time of a material is a unit of time in which its slow time is near 1; u and g are in
that unit.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from ...core.array_types import Floats, Integers
from ...core.scale import Scale
from ...materials.bodies import total_series
from ...materials.law.table import law_table
from ...materials.prony import Prony
from ..contact_table import pure_rolling_fields
from ..parameters import Parameters, refuse_cover, series_in_own_time
from .free_rolling_curve import Curve, curve_of

#: kappa |V| from which on every contact is in its limit of fast rolling, dimensionless.
_FASTEST = 1e300
#: Part of the energy, dimensionless, below which the lost distance is computed as proportional to the lost energy.
_SMALL_LOSS = 1e-7


class ContactLengths(NamedTuple):
    """Lengths of the contact at a speed, dimensionless, numbers or arrays of one shape.

    reach : distance from the axis to the leading edge, the far end of the contact, divided by R:
    lam (1 + epsilon)/(2 kappa).
    epsilon : shift towards the leading edge in half contact lengths, 0 at rest and for elastic bodies.
    lam : contact length divided by l0.
    """

    reach: Any
    epsilon: Any
    lam: Any

    @classmethod
    def of(cls, lam: Any, epsilon: Any, kappa: Any) -> ContactLengths:
        """Return the lengths of contacts of given lam, epsilon and kappa = R/l0, numbers or arrays that broadcast."""
        return cls(lam * (1.0 + epsilon) / (2.0 * kappa), epsilon, lam)


class Reach(NamedTuple):
    """The part of free rolling in which the unsteadiness, and so the error of V, is below a level.

    Numbers or arrays in the shape of the states, in the units of the caller.

    Attributes
    ----------
    speed : speed at which the part ends; 0: it lasts to rest.  Where the unsteadiness is above the level already at V,
        the speed above which it stays below the level; there is always one.
    time, distance : time and distance from V to there; where the part lasts to rest the time is infinite, and of
        elastic bodies, which never stop, the distance too.  0 where the unsteadiness is above the level at V.
    left : distance from the end of the part to rest: 0 where it lasts to rest and for elastic bodies; where the
        unsteadiness is above the level at V, the distance from V to rest.
    """

    speed: Any
    time: Any
    distance: Any
    left: Any


class Start(NamedTuple):
    """Losses of a start at V after a standstill, compared with a start from steady contact, in the units of the caller.

    Attributes
    ----------
    speed : lost speed, in [0, |V|]: |V| where the cylinder stays in its indentation, 0 for elastic bodies and V = 0.
    distance : lost part of the distance to rest; the whole where the cylinder stays in its indentation.
    """

    speed: Any
    distance: Any


@dataclass(frozen=True, eq=False)
class FreeRolling:
    """Initial states of free rolling, each with one of several materials; its methods say how each of them goes on.

    Attributes
    ----------
    materials : alphas or series, each in its own unit of time, in which its slow time is near 1; 1.0 if elastic.
    index : index of the material of each state, in the shape of u.
    u : kappa |V| in the material's own time, dimensionless, any shape.
    g : gamma/(1 + j) in the material's own time, dimensionless, broadcasts with u; NaN without gamma.
    speed, time, length : factors, which broadcast with u: u times ``speed``, a time in the own unit times ``time`` and
        a distance in l0 times ``length`` are in the units of the caller.
    units : names of these units of speed, time and length; empty for dimensionless ones.
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
        """Return the states of a scene at given speeds.

        scene: dimensionless parameters, numbers or arrays, with one or several materials or alphas, no cover; mu is not
            read.
        V: speeds, dimensionless, any sign and shape; broadcasts with the scene.
        Returns the states: u = kappa |V| and the index of the material in the broadcast shape, the other fields as they
        broadcast with it; results will be divided by R/T_ref, T_ref and R.  u is infinite where kappa |V| overflows.
        Without gamma g is NaN, and only contact lengths are known.
        Raises ParameterError for a cover, whose N is not known.
        """
        refuse_cover(scene, "free rolling is not examined, since N is not available")
        materials: Any
        unit: Any
        if scene.material_array is None:
            material, unit = scene.in_own_time()
            materials, index = (
                np.unique(material, return_inverse=True) if np.ndim(material) else ([material], np.zeros((), int))
            )
        else:
            pairs = (series_in_own_time(total_series(one)) for one in scene.material_array)
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
        """Return the same states with results in m/s, s and m for a ``scale`` of a cylinder; itself for a scene's."""
        if not scale.si:
            return self
        speed, time, length = self.speed * scale["V"], self.time * scale["t"], self.length * scale["x"]
        return replace(self, speed=speed, time=time, length=length, units=("m/s", "s", "m"))

    def take(self, index: tuple[Any, ...]) -> FreeRolling:
        """Return the states at an ``index`` of numpy into u: a tuple of integers, one for each axis, or of arrays.

        All fields but ``materials`` and ``units`` are broadcast to u and indexed; IndexError of numpy passes.
        """
        arrays = ("index", "u", "g", "speed", "time", "length")
        return replace(self, **{name: np.broadcast_to(getattr(self, name), self.u.shape)[index] for name in arrays})

    def _groups(self) -> Iterator[tuple[float | Prony, Any]]:
        """Yield each material that occurs, and which states it has, so that a curve is evaluated once for all of them.

        Yields (alpha or series in its own time; index of numpy that selects its states in the flattened arrays: a
        slice of all for a single material, else integers (states of this material,)).  A material without states is
        left out, unless it is the only one.
        """
        if len(self.materials) == 1:
            yield self.materials[0], slice(None)
            return
        order = np.argsort(self.index, axis=None, kind="stable")
        ends = np.searchsorted(self.index.ravel()[order], np.arange(len(self.materials) + 1))
        for material, (first, last) in zip(self.materials, pairwise(ends), strict=True):
            if last > first:
                yield material, order[first:last]

    def contact_lengths(self, kappa: Any) -> ContactLengths:
        """Return the lengths of the contacts of the states at zero creepage, on which they do not depend.

        kappa: slenderness R/l0 of the scene, broadcasts with u.
        Returns :class:`ContactLengths` (reach over R, epsilon, lam), dimensionless, in the shape of u; numbers if u has
        no axes.
        """
        out, u = np.empty((2, self.u.size)), np.minimum(self.u.ravel(), _FASTEST)
        for material, part in self._groups():
            out[:, part] = pure_rolling_fields(law_table(material), u[part], "lam", "epsilon")
        lam, epsilon = (row.reshape(self.u.shape)[()] for row in out)
        return ContactLengths.of(lam, epsilon, kappa)

    def _evaluate(
        self, function: Callable[..., Sequence[Floats]], elastic: Sequence[float], *more: Any
    ) -> list[Floats]:
        """Evaluate a function of the curve of each material at its states.

        function: takes (:class:`Curve` of one material, u, g, *more) of its states, (n,) each, and returns a list of
            arrays (n,).
        elastic: numbers that an elastic material, which has no curve, has in place of these arrays, one for each.
        more: further arguments of the function, each broadcast to u.
        Returns a list of the arrays in the shape of u; numbers if u has no axes.  Overflow gives infinity, and NaN
        where g is NaN, without warnings.
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
        """g |N|, dimensionless, >= 0, in the shape of u; 0 at rest and for elastic bodies, NaN without gamma."""
        return self._evaluate(lambda curve, u, g: [np.where(u > 0.0, g * np.abs(curve.N(u)), 0.0)], [0.0])[0]

    @np.errstate(over="ignore")  # beyond the doubles it is infinite
    def distance(self) -> Any:
        """Return the distance to rest by the law of steady rolling, in the unit of the caller and the shape of u.

        It is 0 at V = 0, and infinite for elastic bodies, also at V = 0; of other bodies it is NaN without gamma.
        """
        return self._evaluate(lambda curve, u, g: [curve.distance(u) / g], [np.inf])[0] * self.length

    @np.errstate(over="ignore")  # beyond the doubles it is infinite
    def reach(self, level: float) -> Reach:
        """Return the part of free rolling in which the unsteadiness is below a level.

        level: of the unsteadiness, which is about the relative error of V by the law of steady rolling; dimensionless,
            > 0, not checked; an unsteadiness equal to it is not below it.
        Gamma must be known.
        Returns a :class:`Reach` (speed at its end, time and distance to there, distance left to rest) in the shape of u
        and the units of the caller.  At rest N(0) decides which of its cases holds, though :attr:`unsteadiness` is 0
        there.  Of elastic bodies speed and left are 0, time and distance infinite.
        """

        def evaluate(curve: Curve, u: Floats, g: Floats) -> list[Floats]:
            """Return the fields of :class:`Reach` for states of one material, in its own time and in l0.

            curve: free rolling of the material.
            u: kappa |V| at the start, (n,).
            g: gamma/(1 + j), (n,), > 0.
            Returns [u at the end, time, distance, distance left to rest], (n,) each; where the unsteadiness is above
            the level at the start, time and distance are 0, and the distance left is that from the start.
            """
            end, below = np.empty(u.size), np.empty(u.size, bool)
            levels, group = np.unique(g, return_inverse=True)
            for n, value in enumerate(levels):
                part = group == n if levels.size > 1 else slice(None)
                end[part], below[part] = curve.limit_speed(u[part], level / value)
            start, left = np.where(below, end, u), curve.distance(np.where(below, end, u))
            time = np.where(start > 0.0, curve.time(u) - curve.time(start), np.inf)
            distance = np.where(below, curve.distance(u) - left, 0.0)
            return [end, np.where(below, time, 0.0) / g, distance / g, left / g]

        end, time, distance, left = self._evaluate(evaluate, [0.0, np.inf, np.inf, 0.0])
        return Reach(end * self.speed, time * self.time, distance * self.length, left * self.length)

    @np.errstate(over="ignore")  # beyond the doubles it is infinite
    def start(self, rested: float = math.inf) -> Start:
        """Return the losses of a start after a standstill, compared with a start from steady contact.

        rested: time of the standstill, >= 0, in the unit of the caller, a number or an array that broadcasts to u;
            infinite for a long one.
        Returns a :class:`Start` in the shape of u and the units of the caller; the lost speed is all of |V|, and the
        lost distance the whole, where the work to leave the indentation exceeds the kinetic energy.  Both are 0 at V =
        0 and for elastic bodies.  Gamma must be known.
        """

        def evaluate(curve: Curve, u: Floats, g: Floats, rested: Floats) -> list[Floats]:
            """Return [lost u, lost distance] for states of one material, (n,) each, in its own time and in l0.

            They follow from the work W to leave the indentation, :meth:`Curve.work`.
            curve: free rolling of the material.
            u, g, rested: kappa |V| at the start, >= 0, gamma/(1 + j), > 0, time of the standstill, >= 0, (n,) each.
            """
            distance = curve.distance(u)
            W = curve.work(u, distance / g, rested)
            part = np.where(u > 0.0, np.minimum(0.5 * g * W / u / u, 1.0), 0.0)
            kept = np.sqrt(1.0 - part)
            lost = np.where(part > _SMALL_LOSS, (distance - curve.distance(u * kept)) / g, 0.25 * W / curve.M(u))
            return [u * part / (1.0 + kept), np.where(u > 0.0, lost, 0.0)]

        speed, distance = self._evaluate(evaluate, [0.0, 0.0], rested / self.time)
        return Start(speed * self.speed, distance * self.length)
