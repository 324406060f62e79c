"""Free rolling of one material as splines over speed: :class:`Curve`.

kappa = R/l0 with the contact length at rest l0, M is the rolling moment over load and radius, and N its factor of dV/dt
in slow changes of speed, M = M(V) + N dV/dt.
"""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from ...core.array_types import Booleans, Floats
from ...materials.bodies import total_series
from ...materials.law.evaluate import evaluate_by_modes
from ...materials.prony import Prony

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


class Curve:
    """Free rolling of one material as splines over ln u, u = kappa V, for gamma/(1 + j) = 1: N, M, time and distance.

    Dimensionless, in the material's own unit of time, lengths divided by l0.  For another g = gamma/(1 + j) times and
    distances are divided by g.  Below and above the splines the limits of slow and of fast rolling apply.

    Attributes
    ----------
    ln_u : points of the splines, ln u, ascending, (points,).
    modes : strengths J and retardation times T of the creep modes, slowest first, (modes,) each.
    alpha : instantaneous divided by long-time stiffness, a number > 1, dimensionless.
    """

    def __init__(self, material: float | Prony) -> None:
        """Compute the splines, from 20 octaves below to 20 octaves above the rates of the material.

        material: alpha > 1, of which the unit of time is T_epsilon; or a :class:`Prony` series in its own time, with
            one mode at least.
        The attributes of the class are set, and the splines over ln u: N, u^2/M, and the integrals for time and
        distance.
        """
        from scipy.interpolate import CubicSpline

        series = total_series(material)
        self.modes, self.alpha = (series.J, series.T), series.alpha
        shortest, longest = series.tau[-1], series.T[0]
        octaves = math.ceil(math.log2(longest / shortest * math.sqrt(self.alpha))) + 2 * _MARGIN
        points = np.linspace(0.0, octaves * math.log(2.0), octaves * _PER_OCTAVE + 1) - math.log(longest)
        # The formulas of the modes at 1/(2 zeta) need no kernel of contacts, which a warning need not compile.
        half_rates = 0.5 * np.exp(_MARGIN * math.log(2.0) - points)
        (_, h_over_zeta, half_space, cylinder), _, N = evaluate_by_modes(material, half_rates)
        self.ln_u = points - _MARGIN * math.log(2.0) - 0.5 * np.log1p(2.0 * h_over_zeta)
        u = np.exp(self.ln_u)
        M = u * (half_space + cylinder)
        self._low, self._high, self._M_high = float(u[0]), float(u[-1]), float(M[-1])
        self._N, self._u2_over_M = CubicSpline(self.ln_u, N), CubicSpline(self.ln_u, u * u / M)
        self._time, self._distance = CubicSpline(self.ln_u, u / M).antiderivative(), self._u2_over_M.antiderivative()
        self._N_slope = self._N(self.ln_u[0], 1)
        self._first_distance = u[0] ** 2 / M[0]  # from u[0] to rest, where M is proportional to u

    def _locate(self, u: Floats) -> tuple[Floats, Floats]:
        """Return (ln u, limited to the range of the splines; u divided by the end that it is beyond, else 1), each in
        the shape of u; the second is below 1 for u below the splines, above 1 for u above.
        """
        inside = np.clip(u, self._low, self._high)
        return np.log(inside), u / inside

    def N(self, u: Floats) -> Floats:
        """Return N, of either sign, at u = kappa |V| >= 0, any shape, in that shape, dimensionless; below the splines
        linear in u, above proportional to u^-2.
        """
        ln_u, beyond = self._locate(u)
        return (self._N(ln_u) + self._N_slope * (np.minimum(beyond, 1.0) - 1.0)) / np.maximum(beyond, 1.0) ** 2

    def M(self, u: Floats) -> Floats:
        """Return kappa M >= 0 at u, any shape, in that shape, dimensionless; below the splines proportional to u, above
        to 1/u; 0 at u = 0.
        """
        ln_u, beyond = self._locate(u)
        return np.exp(2.0 * ln_u) / self._u2_over_M(ln_u) * np.where(beyond < 1.0, beyond, 1.0 / beyond)

    def time(self, u: Floats) -> Floats:
        """Return the time from u, any shape, down to the lower end of the splines, in that shape; 0 at and below it.

        Only differences count: the time from u to a lower u2 above that end is time(u) - time(u2), and that to rest is
        infinite.
        """
        ln_u, beyond = self._locate(u)
        return self._time(ln_u) + 0.5 * self._high / self._M_high * (np.maximum(beyond, 1.0) ** 2 - 1.0)

    def distance(self, u: Floats) -> Floats:
        """Return the distance from u, any shape, to rest, in that shape and in units of l0; below the splines
        proportional to u, 0 at u = 0.
        """
        ln_u, beyond = self._locate(u)
        above = self._high**2 / (3.0 * self._M_high) * (np.maximum(beyond, 1.0) ** 3 - 1.0)
        return (self._first_distance + self._distance(ln_u)) * np.minimum(beyond, 1.0) + above

    def limit_speed(self, u: Floats, level: float) -> tuple[Floats, Booleans]:
        """Return the speed at which |N| reaches a level in free rolling.

        u: kappa |V| at the start, dimensionless, any shape.
        level: level of |N|, > 0.
        Returns (speed; whether |N| is below the level at the start), both in the shape of u.  The speed is the u at
        which |N| first reaches the level as u falls, 0 if never.  Where |N| is at or above the level at the start
        already, it is the u above which |N| stays below the level.
        """
        roots = np.sort(np.concatenate([self._N.solve(value, extrapolate=False) for value in (level, -level)]))
        falls = roots[self._N(roots) * self._N(roots, 1) < 0.0]
        last = float(np.abs(self._N(self.ln_u[-1])))
        behind = [self._high * math.sqrt(last / level)] if last >= level else []  # where N falls as u^-2
        ends = np.concatenate([[0.0], np.exp(falls), behind])
        below = np.abs(self.N(u)) < level
        index = np.searchsorted(ends, u, side="right")
        return np.where(below, ends[index - 1], ends[-1]), below

    def work(self, u: Floats, distance: Floats, rested: Floats) -> Floats:
        """Return the work W that it takes to roll out of the indentation of a standstill; in SI units P l0^2 W/(4 R).

        The last term is the elastic and potential energy that is released as the contact shrinks.  Under a load P the
        elastic energy and the height of a contact of half length a and compliance C hold C ln(1/a), so that they differ
        between rest and fast rolling, both of the instantaneous compliance 1/alpha, by ln(a_rest/a_fast)/(4 alpha).
        After a long rest that ratio is sqrt(alpha), and the term is ln(alpha)/(8 alpha); without a rest the contact
        starts as short as it rolls, and the term is 0.  Between the two the term is taken in proportion to the
        relaxation of the slowest mode; it is below 0.05 for every alpha.

        u: kappa |V| at the start, (n,).
        distance: distance travelled until rest, in units of l0, for the g of the motion, (n,).
        rested: time of the standstill in the material's own time, >= 0, maybe infinite, (n,).
        Returns W, dimensionless, >= 0, (n,); 0 at u = 0.
        """
        longest, W = _SHORT * np.maximum(2.0 * distance, _CLIMB), np.zeros(u.shape)
        for J, T in zip(*self.modes, strict=True):
            L, fresh = np.minimum(2.0 * u * T, longest), np.exp(-rested / T)
            W += 0.5 * J * ((1.0 - fresh) * np.log(np.hypot(1.0, _MEMORY * L)) - fresh / (1.0 + 2.0 / L))
        grown = -np.expm1(-rested / self.modes[1][0])
        return np.maximum(W - grown * math.log(self.alpha) / (8.0 * self.alpha), 0.0)


@lru_cache(maxsize=256)  # as many as the validity of an ensemble examines; 0.1 MB each
def curve_of(material: float | Prony) -> Curve | None:
    """Return the curve of a material in its own time, alpha or a series, which is kept for the next call; None for an
    elastic one, which rolls for ever.
    """
    return Curve(material) if total_series(material).alpha > 1.0 else None
