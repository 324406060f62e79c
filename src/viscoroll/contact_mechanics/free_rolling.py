"""Free rolling by the law of steady rolling, without integration of a motion, and where it is
accurate.

M is the rolling moment over P R, kappa = R/l0 with the contact length at rest l0, gamma = P
T_ref^2/(m R), j the moment of inertia over m R^2, and g = gamma/(1 + j).  Free rolling depends on u
= kappa V, on g and on the material: u' = -g kappa M(u), and the distance is the integral of u du/(g
kappa M), in units of l0.  :class:`Curve` has these integrals of one material, as splines over ln u,
for g = 1.

In slow changes of speed the moment is M(V) + N(V) dV/dt, where N acts as an added mass.  Divided by
the mass it is the unsteadiness g |N(V)|, which is about the relative error of V in a motion in
which it was no larger before (docs/validity_low_speed.md).

The own time of a material is a unit of time in which its slow time
(:attr:`viscoroll.Prony.slow_time`) is near 1; u and g are in that unit.
"""

import functools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from ..core import Booleans, Floats, Integers, Scale
from ..laws import evaluate_by_modes
from ..materials import Prony, total_series
from .parameters import Parameters, refuse_cover, series_in_own_time

# --- Free rolling of one material as splines over speed ---

#: Points of a curve in an octave of u: the splines then have errors below 1e-6.
_PER_OCTAVE = 16
#: Octaves of 1/u beyond the shortest and the longest time of a material, where N and M are in their
#: limits to 1e-6.
_MARGIN = 20
#: Length in half contact lengths at rest over which a mode remembers the indentation, divided by 2
#: u T of the mode; measured with a transient solver (docs/validity_low_speed.md).
_MEMORY = 0.681
#: Largest such length divided by twice the coasting distance; measured likewise.
_SHORT = 4.84
#: Smallest distance, half contact lengths at rest, that limits the memory: as far as the contact
#: climbs; measured likewise.
_CLIMB = 20.0


class Curve:
    """Free rolling of one material as splines over ln u, u = kappa V, for gamma/(1 + j) = 1: N, M,
    time and distance.

    Dimensionless, in the material's own unit of time, lengths divided by l0.  For another g =
    gamma/(1 + j) times and distances are divided by g.  Below and above the splines the limits of
    slow and of fast rolling apply.

    Attributes
    ----------
    ln_u : points of the splines, ln u, ascending, (points,).
    modes : strengths J and retardation times T of the creep modes, slowest first, (modes,) each.
    alpha : instantaneous divided by long-time stiffness, a number > 1, dimensionless.
    """

    def __init__(self, material: float | Prony) -> None:
        """Compute the splines, from 20 octaves below to 20 octaves above the rates of the material.

        material: alpha > 1, of which the unit of time is T_epsilon; or a :class:`Prony` series in
            its own time, with one mode at least.
        The attributes of the class are set, and the splines over ln u: N, u^2/M, and the integrals
        for time and distance.
        """
        from scipy.interpolate import CubicSpline

        series = total_series(material)
        self.modes = (series.J, series.T)
        self.alpha = series.alpha
        longest = series.T[0]
        relaxing = math.ceil(math.log2(longest / series.tau[-1] * math.sqrt(self.alpha)))
        octaves = relaxing + 2 * _MARGIN
        points = np.linspace(0.0, octaves * math.log(2.0), octaves * _PER_OCTAVE + 1)
        points -= math.log(longest)
        points -= _MARGIN * math.log(2.0)
        # The formulas of the modes at 1/(2 zeta) need no kernel of contacts, which a warning need
        # not compile.  The points are even in ln 1/(2 zeta).
        zeta = 0.5 * np.exp(-points)
        (_, h_over_zeta, half_space, cylinder), _, N = evaluate_by_modes(material, zeta)
        self.ln_u = points - 0.5 * np.log1p(2.0 * h_over_zeta)
        # above: u = lam/(2 zeta) with lam = (1 + 2 h/zeta)^(-1/2).  M is kappa times the moment
        u = np.exp(self.ln_u)
        M = u * (half_space + cylinder)
        self._low = u[0]
        self._high = u[-1]
        self._M_high = M[-1]
        self._N = CubicSpline(self.ln_u, N)
        self._u2_over_M = CubicSpline(self.ln_u, u * u / M)
        # integrals of du/M and of u du/M, over ln u
        self._time = CubicSpline(self.ln_u, u / M).antiderivative()
        self._distance = self._u2_over_M.antiderivative()
        self._N_slope = self._N(self.ln_u[0], 1)
        self._first_distance = u[0] ** 2 / M[0]  # from u[0] to rest, where M is proportional to u

    def _locate(self, u: Floats) -> tuple[Floats, Floats, Floats]:
        """Return ln u, limited to the range of the splines; u divided by the lower end where it is
        below it, else 1; u divided by the upper end where it is above it, else 1; each in the
        shape of u.
        """
        inside = np.clip(u, self._low, self._high)
        beyond = u / inside
        return np.log(inside), np.minimum(beyond, 1.0), np.maximum(beyond, 1.0)

    def N(self, u: Floats) -> Floats:
        """Return N, of either sign, at u = kappa |V| >= 0, any shape, in that shape, dimensionless;
        below the splines linear in u, above proportional to u^-2.
        """
        ln_u, below, above = self._locate(u)
        # at the first point the slope over ln u is u dN/du: N is linear in u below
        return (self._N(ln_u) + self._N_slope * (below - 1.0)) / above**2

    def M(self, u: Floats) -> Floats:
        """Return kappa M >= 0 at u, any shape, in that shape, dimensionless; below the splines
        proportional to u, above to 1/u; 0 at u = 0.
        """
        ln_u, below, above = self._locate(u)
        return np.exp(2.0 * ln_u) / self._u2_over_M(ln_u) * (below / above)

    def time(self, u: Floats) -> Floats:
        """Return the time from u, any shape, down to the lower end of the splines, in that shape; 0
        at and below it.

        Only differences count: the time from u to a lower u2 above that end is time(u) - time(u2),
        and that to rest is infinite.
        """
        ln_u, _, above = self._locate(u)
        # above the splines M falls as 1/u, so that the integral of du/M grows as u^2
        return self._time(ln_u) + 0.5 * self._high / self._M_high * (above**2 - 1.0)

    def distance(self, u: Floats) -> Floats:
        """Return the distance from u, any shape, to rest, in that shape and in units of l0; below
        the splines proportional to u, 0 at u = 0.
        """
        ln_u, below, above = self._locate(u)
        # above the splines M falls as 1/u, so that the integral of u du/M grows as u^3
        further = self._high**2 / (3.0 * self._M_high) * (above**3 - 1.0)
        return (self._first_distance + self._distance(ln_u)) * below + further

    def limit_speed(self, u: Floats, level: float) -> tuple[Floats, Booleans]:
        """Return the speed at which |N| reaches a level in free rolling.

        u: kappa |V| at the start, dimensionless, any shape.
        level: level of |N|, > 0.
        Returns (speed; whether |N| is below the level at the start), both in the shape of u.  The
        speed is the u at which |N| first reaches the level as u falls, 0 if never.  Where |N| is at
        or above the level at the start already, it is the u above which |N| stays below the level.
        """
        roots = np.sort(
            np.concatenate([self._N.solve(value, extrapolate=False) for value in (level, -level)])
        )
        # roots at which |N| rises as u falls: a motion leaves the level there
        falls = roots[self._N(roots) * self._N(roots, 1) < 0.0]
        last = np.abs(self._N(self.ln_u[-1]))
        # where N falls as u^-2
        behind = [self._high * math.sqrt(last / level)] if last >= level else []
        ends = np.concatenate([[0.0], np.exp(falls), behind])
        below = np.abs(self.N(u)) < level
        # the last one at or below u
        end = ends[np.searchsorted(ends, u, "right") - 1]
        return np.where(below, end, ends[-1]), below

    def work(self, u: Floats, distance: Floats, rested: Floats) -> Floats:
        """Return the work W that it takes to roll out of the indentation of a standstill; in SI
        units P l0^2 W/(4 R).

        The last term is the elastic and potential energy that is released as the contact shrinks.
        Under a load P the elastic energy and the height of a contact of half length a and
        compliance C hold C ln(1/a), so that they differ between rest and fast rolling, both of the
        instantaneous compliance 1/alpha, by ln(a_rest/a_fast)/(4 alpha).  After a long rest that
        ratio is sqrt(alpha), and the term is ln(alpha)/(8 alpha); without a rest the contact starts
        as short as it rolls, and the term is 0.  Between the two the term is taken in proportion to
        the relaxation of the slowest mode; it is below 0.05 for every alpha.

        u: kappa |V| at the start, (n,).
        distance: distance travelled until rest, in units of l0, for the g of the motion, (n,).
        rested: time of the standstill in the material's own time, >= 0, maybe infinite, (n,).
        Returns W, dimensionless, >= 0, (n,); 0 at u = 0.
        """
        longest = _SHORT * np.maximum(2.0 * distance, _CLIMB)
        W = np.zeros(u.shape)
        for J, T in zip(*self.modes, strict=True):
            # distance of the time T at the start, in half contact lengths at rest, which the motion
            # may be too short for; and the part of the creep that the standstill was too short for
            L = np.minimum(2.0 * u * T, longest)
            fresh = np.exp(-rested / T)
            crept = (1.0 - fresh) * np.log(np.hypot(1.0, _MEMORY * L))
            W += 0.5 * J * (crept - fresh / (1.0 + 2.0 / L))
        grown = -np.expm1(-rested / self.modes[1][0])
        return np.maximum(W - grown * math.log(self.alpha) / (8.0 * self.alpha), 0.0)


@functools.lru_cache(maxsize=256)  # as many as the validity of an ensemble examines; 0.1 MB each
def curve_of(material: float | Prony) -> Curve | None:
    """Return the curve of a material in its own time, alpha or a series, which is kept for the next
    call; None for an elastic one, which rolls for ever.
    """
    return Curve(material) if total_series(material).alpha > 1.0 else None


# --- Free rolling by the law of steady rolling, and where it is accurate ---

#: Part of the energy, dimensionless, below which the lost distance is computed as proportional to
#: the lost energy.
_SMALL_LOSS = 1e-7


class Reach(NamedTuple):
    """The part of free rolling in which the unsteadiness, and so the error of V, is below a level.

    Numbers or arrays in the shape of the states, in the units of the caller.

    Attributes
    ----------
    speed : speed at which the part ends; 0: it lasts to rest.  Where the unsteadiness is above the
        level already at V, the speed above which it stays below the level; there is always one.
    time, distance : time and distance from V to there; where the part lasts to rest the time is
        infinite, and of elastic bodies, which never stop, the distance too.  0 where the
        unsteadiness is above the level at V.
    left : distance from the end of the part to rest: 0 where it lasts to rest and for elastic
        bodies; where the unsteadiness is above the level at V, the distance from V to rest.
    """

    speed: Any
    time: Any
    distance: Any
    left: Any


class Start(NamedTuple):
    """Losses of a start at V after a standstill, compared with a start from steady contact, in the
    units of the caller.

    Attributes
    ----------
    speed : lost speed, in [0, |V|]: |V| where the cylinder stays in its indentation, 0 for elastic
        bodies and V = 0.
    distance : lost part of the distance to rest; the whole where the cylinder stays in its
        indentation.
    """

    speed: Any
    distance: Any


@dataclass(frozen=True, eq=False)
class FreeRolling:
    """Initial states of free rolling, each with one of several materials; its methods say how each
    of them goes on.

    Attributes
    ----------
    materials : alphas or series, each in its own unit of time, in which its slow time is near 1;
        1.0 if elastic.
    index : index of the material of each state, in the shape of u.
    u : kappa |V| in the material's own time, dimensionless, any shape.
    g : gamma/(1 + j) in the material's own time, dimensionless, broadcasts with u; NaN without
        gamma.
    speed, time, length : factors, which broadcast with u: u times ``speed``, a time in the own unit
        times ``time`` and a distance in l0 times ``length`` are in the units of the caller.
    units : names of these units of speed, time and length, with a blank in front; empty for
        dimensionless ones.
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
    def of_scene(cls, scene: Parameters, V: Any) -> "FreeRolling":
        """Return the states of a scene at given speeds.

        scene: dimensionless parameters, numbers or arrays, with one or several materials or alphas,
            no cover; mu is not read.
        V: speeds, dimensionless, any sign and shape; broadcasts with the scene.
        Returns the states: u = kappa |V| and the index of the material in the broadcast shape, the
        other fields as they broadcast with it; results will be divided by R/T_ref, T_ref and R.  u
        is infinite where kappa |V| overflows.  Without gamma g is NaN, and only contact lengths are
        known.
        Raises ParameterError for a cover, whose N is not known.
        """
        scene = scene.uncoupled  # a free roller has hardly any traction
        refuse_cover(
            scene,
            "it cannot be checked whether speeds change slowly enough for the law of steady "
            "rolling, as the check needs the added mass N, which is not known",
        )
        materials: Any
        unit: Any
        if scene.material_array is None:
            material, unit = scene.in_own_time()
            materials, index = (
                np.unique(material, return_inverse=True)
                if np.ndim(material)
                else ([material], np.zeros((), int))
            )
        else:
            pairs = [series_in_own_time(total_series(one)) for one in scene.material_array]
            materials = [each for each, _ in pairs]
            unit = np.array([each for _, each in pairs])
            index = np.arange(unit.size)
        gamma = np.nan if scene.gamma is None else scene.gamma
        with np.errstate(over="ignore"):
            u = scene.kappa * np.abs(V) * unit
            g = gamma * unit * unit / (1.0 + scene.j)
        u, index = np.broadcast_arrays(u, index, g)[:2]
        speed = 1.0 / (scene.kappa * unit)
        return cls(materials, index, u, g, speed, time=unit, length=1.0 / scene.kappa)

    def scaled(self, scale: Scale) -> "FreeRolling":
        """Return the same states, whose results are in m/s, s and m.

        scale: units of the cylinder; with those of a scene, which is dimensionless, this object
            itself is returned.
        """
        if not scale.si:
            return self
        return replace(
            self,
            speed=self.speed * scale["V"],
            time=self.time * scale["t"],
            length=self.length * scale["x"],
            units=(" m/s", " s", " m"),
        )

    def take(self, index: tuple[Any, ...]) -> "FreeRolling":
        """Return some of the states, as a new object of the same materials and units.

        index: index of numpy into u, a tuple of integers or arrays, one for each axis; the other
            arrays are broadcast to u and indexed alike.
        Raises IndexError of numpy.
        """
        return replace(
            self,
            **{
                name: np.broadcast_to(getattr(self, name), self.u.shape)[index]
                for name in ("index", "u", "g", "speed", "time", "length")
            },
        )

    def _evaluate(
        self, function: Callable[..., Sequence[Floats]], elastic: Sequence[float], *more: Any
    ) -> list[Floats]:
        """Evaluate a function of the curve of each material at its states.

        function: takes (:class:`Curve` of one material, u, g, *more) of its states, (n,) each, and
            returns a list of arrays (n,).
        elastic: numbers that an elastic material, which has no curve, has in place of these arrays,
        one for each.
        more: further arguments of the function, each broadcast to u.
        Returns a list of the arrays in the shape of u; numbers if u has no axes.  Overflow gives
        infinity, and NaN where g is NaN, without warnings.
        """
        out = np.full((self.u.size, len(elastic)), elastic).T
        index, *arrays = (
            np.broadcast_to(array, self.u.shape).ravel()
            for array in (self.index, self.u, self.g, *more)
        )
        # the states of each material, for one evaluation of its curve
        order = np.argsort(index, kind="stable")
        ends = np.searchsorted(index[order], np.arange(1, len(self.materials)))
        with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
            for material, part in zip(self.materials, np.split(order, ends)):
                if part.size and (curve := curve_of(material)) is not None:
                    out[:, part] = function(curve, *(array[part] for array in arrays))
        return [row.reshape(self.u.shape)[()] for row in out]  # [()]: a number without axes

    @functools.cached_property
    def unsteadiness(self) -> Any:
        """g |N|, dimensionless, >= 0, in the shape of u; 0 at rest and for elastic bodies, NaN
        without gamma.
        """
        return self._evaluate(
            lambda curve, u, g: [np.where(u > 0.0, g * np.abs(curve.N(u)), 0.0)], [0.0]
        )[0]

    @np.errstate(over="ignore")  # beyond the doubles it is infinite
    def distance(self) -> Any:
        """Return the distance to rest by the law of steady rolling, in the unit of the caller and
        the shape of u.

        It is 0 at V = 0, and infinite for elastic bodies, also at V = 0; of other bodies it is NaN
        without gamma.
        """
        return (
            self._evaluate(lambda curve, u, g: [curve.distance(u) / g], [np.inf])[0] * self.length
        )

    @np.errstate(over="ignore")  # beyond the doubles it is infinite
    def reach(self, level: float) -> Reach:
        """Return the part of free rolling in which the unsteadiness is below a level.

        level: of the unsteadiness, which is about the relative error of V by the law of steady
            rolling; dimensionless, > 0, not checked; an unsteadiness equal to it is not below it.
        Gamma must be known.
        Returns a :class:`Reach` (speed at its end, time and distance to there, distance left to
        rest) in the shape of u and the units of the caller.  At rest N(0) decides which of its
        cases holds, though :attr:`unsteadiness` is 0 there.  Of elastic bodies speed and left are
        0, time and distance infinite.
        """

        def evaluate(curve: Curve, u: Floats, g: Floats) -> list[Floats]:
            """Return the fields of :class:`Reach` for states of one material, in its own time and
            in l0.

            curve: free rolling of the material.
            u: kappa |V| at the start, (n,).
            g: gamma/(1 + j), (n,), > 0.
            Returns [u at the end, time, distance, distance left to rest], (n,) each; where the
            unsteadiness is above the level at the start, time and distance are 0, and the distance
            left is that from the start.
            """
            end = np.empty(u.size)
            below = np.empty(u.size, bool)
            # the unsteadiness is g |N|: limit_speed takes one level of |N|, so a call for each g
            for value in np.unique(g):
                part = g == value
                end[part], below[part] = curve.limit_speed(u[part], level / value)
            # where the part is empty, u stands for its end, so that time and distance are 0
            start = np.where(below, end, u)
            left = curve.distance(start)
            time = np.where(start > 0.0, curve.time(u) - curve.time(start), np.inf)
            distance = np.where(below, curve.distance(u) - left, 0.0)
            # times and distances of the curve are those of g = 1, and in inverse proportion to g
            return [end, np.where(below, time, 0.0) / g, distance / g, left / g]

        end, time, distance, left = self._evaluate(evaluate, [0.0, np.inf, np.inf, 0.0])
        return Reach(end * self.speed, time * self.time, distance * self.length, left * self.length)

    @np.errstate(over="ignore")  # beyond the doubles it is infinite
    def start(self, rested: float = math.inf) -> Start:
        """Return the losses of a start after a standstill, compared with a start from steady
        contact.

        rested: time of the standstill, >= 0, in the unit of the caller, a number or an array that
            broadcasts to u; infinite for a long one.
        Returns a :class:`Start` in the shape of u and the units of the caller; the lost speed is
        all of |V|, and the lost distance the whole, where the work to leave the indentation exceeds
        the kinetic energy.  Both are 0 at V = 0 and for elastic bodies.  Gamma must be known.
        """

        def evaluate(curve: Curve, u: Floats, g: Floats, rested: Floats) -> list[Floats]:
            """Return [lost u, lost distance] for states of one material, (n,) each, in its own time
            and in l0.

            They follow from the work W to leave the indentation, :meth:`Curve.work`.
            curve: free rolling of the material.
            u, g, rested: kappa |V| at the start, >= 0, gamma/(1 + j), > 0, time of the standstill,
            >= 0, (n,) each.
            """
            distance = curve.distance(u)
            W = curve.work(u, distance / g, rested)
            part = np.where(u > 0.0, np.minimum(0.5 * g * W / u / u, 1.0), 0.0)
            kept = np.sqrt(1.0 - part)
            # part of the energy that is lost; for a small one the difference of distances would
            # cancel: u lost is u part/2, and the distance to rest changes by u/(g M) for each u
            lost = np.where(
                part > _SMALL_LOSS, (distance - curve.distance(u * kept)) / g, 0.25 * W / curve.M(u)
            )
            # u (1 - kept) without cancellation
            return [u * part / (1.0 + kept), np.where(u > 0.0, lost, 0.0)]

        speed, distance = self._evaluate(evaluate, [0.0, 0.0], rested / self.time)
        return Start(speed * self.speed, distance * self.length)
