"""How shear acts back on the rolling moments of a cover, for steady states: the traction of a load, and the speeds.

With the factors a and excesses e of base (b) and cylinder (c) of :class:`...kernels.rows.cover.Reaction`, the moments
are M_half_space = M_b - Q (a_b + e_b |Q|/mu) and M_cylinder = M_c - Q (a_c + e_c |Q|/mu), with M_b and M_c those
without
traction.  Equilibrium at V > 0 under a force f and a torque q is

    Q (1 + a_b + e_b |Q|/mu) = M_b - f        Q (1 - a_c - e_c |Q|/mu) = q - M_c

All is dimensionless; a law is a :class:`LawTable`, the rows of one material.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ...core.array_types import Booleans, Floats, Integers
from ...materials.law.table import LawTable
from ..contact_table import evaluate_law
from .loads import Loads
from .resistance import find_zeros, speed_nodes

#: rounding of a balance of force and torque at rest, relative to the larger: some units of rounding of both products
_BALANCE_ROUNDING = 4e-15
#: fields of the kernels that :class:`Shear` holds
_REACTION = "reaction_half_space", "reaction_cylinder", "excess_half_space", "excess_cylinder"


class Shear(NamedTuple):
    """How shear acts back on the moments at some speeds; all 0 of half-spaces.

    half_space, cylinder : factors a of base and cylinder, (n,) each, dimensionless.
    half_space_excess, cylinder_excess : excesses e, (n,) each, dimensionless.
    kappa, mu : slenderness R/l0 and coefficient of friction, (n,) each.
    """

    half_space: Floats
    cylinder: Floats
    half_space_excess: Floats
    cylinder_excess: Floats
    kappa: Any
    mu: Any

    def moments(self, Q: Floats) -> Floats:
        """Return what a traction Q, (n,), adds to M_half_space and M_cylinder, (2, n)."""
        used = np.abs(Q) / self.mu
        by_base = self.half_space + self.half_space_excess * used
        by_cylinder = self.cylinder + self.cylinder_excess * used
        return np.stack([-Q * by_base, -Q * by_cylinder])

    def traction_of_force(self, rest: Floats) -> Floats:
        """Return the Q with Q (1 + a_b + e_b |Q|/mu) = ``rest``, (n,)."""
        return _solve_quadratic(1.0 + self.half_space, self.half_space_excess / self.mu, rest)

    def traction_of_torque(self, rest: Floats) -> Floats:
        """Return the Q with Q (1 - a_c - e_c |Q|/mu) = ``rest``, (n,)."""
        return _solve_quadratic(1.0 - self.cylinder, -self.cylinder_excess / self.mu, rest)

    def slopes_at_rest(self, law: LawTable, Q: Floats) -> tuple[Floats, Floats, Floats, Floats]:
        """Return how a small speed changes the balance of a cylinder at rest under a traction.

        law : table of the material.
        Q : traction at rest, |Q| < mu, (n,).
        Returns (1 + d(Q (a_b + ...))/dQ, factor of a change of Q on the axis; the same on the cylinder;
        dM_half_space/dV
        and dM_cylinder/dV at fixed Q), (n,) each.
        """
        used = np.abs(Q) / self.mu
        on_axis = 1.0 + self.half_space + 2.0 * self.half_space_excess * used
        on_spin = 1.0 - self.cylinder - 2.0 * self.cylinder_excess * used
        if law.cover is None:
            half_space, cylinder = law.coefficients[0, 0, 2:4, None] * np.ones(Q.size)
            return on_axis, on_spin, half_space, cylinder
        limit, free = creep_at_rest(law)
        part = np.where(used < 1.0, used, 0.0)
        delta = 0.5 * (limit * self.mu * np.sign(Q) * (1.0 - np.sqrt(1.0 - part)) + free) / self.kappa
        names = "dM_half_space_dV", "dM_cylinder_dV", "dQ_dV"
        state = [1.0, self.kappa, self.mu, np.zeros(Q.size), delta]
        half_space, cylinder, over_V = evaluate_law(law, state, Q.shape, False, names)
        return on_axis, on_spin, half_space + (on_axis - 1.0) * over_V, cylinder + (1.0 - on_spin) * over_V


def _solve_quadratic(factor: Floats, excess: Floats, rest: Floats) -> Floats:
    """Return the y with y (factor + excess |y|) = rest that is 0 where ``rest`` is; (n,), dimensionless, factor > 0.

    Where |rest| is above what the left side reaches the y of its maximum is returned, which is beyond mu.
    """
    root = np.sqrt(np.maximum(factor * factor + 4.0 * excess * np.abs(rest), 0.0))
    return 2.0 * rest / (factor + root)


def creep_at_rest(law: LawTable) -> tuple[float, float]:
    """Return 2 kappa delta_star/mu and 2 kappa delta_0 in the limit V -> 0, dimensionless; 1 and 0 of half-spaces.

    law : table of the material.
    """
    if law.cover is None:
        return 1.0, 0.0
    limit, half_space, cylinder = law.cover.creep[:3, 0, 0]
    return float(limit), float(half_space + cylinder)


def shear_at(law: LawTable, kappa: Any, mu: Any, V: Floats) -> Shear:
    """Return how shear acts back on the moments at speeds V >= 0, (n,), as :class:`Shear`.

    law : table of the material; of half-spaces all is 0.
    kappa, mu : slenderness R/l0 and coefficient of friction, numbers or (n,).
    """
    if law.cover is None:
        nothing = np.zeros(V.size)
        return Shear(nothing, nothing, nothing, nothing, kappa, mu)
    fields = evaluate_law(law, [1.0, kappa, mu, V, 0.0], V.shape, False, _REACTION)
    return Shear(fields[0], fields[1], fields[2], fields[3], kappa, mu)


def find_speeds_of_cover(law: LawTable, loads: Loads) -> tuple[Integers, Floats, Floats]:
    """Find the speeds at which a cover rolls steadily under loads without a gain on omega, in both directions.

    At each speed the balance of the axis gives Q, and that of the cylinder is a function of the speed alone, of which
    the zeros are found between the nodes of :func:`.resistance.speed_nodes`.  M without traction is read at Q = 0.

    law : table of the material, of a cover.
    loads : the loads, dimensionless, without a gain on omega; V is not given.
    Returns (index of the load; sign of V, 1.0 or -1.0; |V|, > 0), one entry for each crossing, (crossings,) each.
    """
    nodes = speed_nodes(law)
    gains = loads.gains
    found: list[tuple[int, float, Floats]] = []
    for n in range(loads.mu.size):
        kappa, mu = loads.kappa[n], loads.mu[n]
        for sign in (1.0, -1.0):

            def unbalanced(x: Floats, n: int = n, sign: float = sign, kappa: Any = kappa, mu: Any = mu) -> Floats:
                """Return torque less M_cylinder and Q at speeds exp2(x)/kappa at which the axis is in balance."""
                V = np.exp2(x) / kappa
                shear = shear_at(law, kappa, mu, V)
                delta_0 = evaluate_law(law, [1.0, kappa, mu, V, 0.0], V.shape, False, ("delta_0",))[0]
                state = [1.0, kappa, mu, V, delta_0]
                half_space, cylinder = evaluate_law(law, state, V.shape, False, ("M_half_space", "M_cylinder"))
                Q = shear.traction_of_force(half_space - sign * loads.force[n] - gains.force_V * V)
                moments = shear.moments(Q)
                return sign * loads.torque[n] + gains.torque_V * V - cylinder - moments[1] - Q

            noise = _BALANCE_ROUNDING * (abs(loads.force[n]) + abs(loads.torque[n]))
            found.append((n, sign, np.exp2(find_zeros(unbalanced, nodes, noise)) / kappa))
    load = np.concatenate([np.full(V.size, n) for n, _, V in found])
    signs = np.concatenate([np.full(V.size, sign) for _, sign, V in found])
    return load, signs, np.concatenate([V for _, _, V in found])


def is_balanced_at_rest(law: LawTable, loads: Loads) -> Booleans:
    """Return under which loads V = omega = 0 is a state of equilibrium, (n,); the friction is not considered.

    law : table of the material.
    loads : the loads, dimensionless; force and torque are read.  Of half-spaces force + torque must be 0, of a cover
        what the traction of the torque leaves on the axis, to rounding.
    """
    if law.cover is None:
        return loads.force + loads.torque == 0.0
    shear = shear_at(law, loads.kappa, loads.mu, np.zeros(loads.mu.size))
    Q = shear.traction_of_torque(loads.torque)
    rest = Q - shear.moments(Q)[0] + loads.force
    return np.abs(rest) <= _BALANCE_ROUNDING * (np.abs(loads.force) + np.abs(loads.torque))
