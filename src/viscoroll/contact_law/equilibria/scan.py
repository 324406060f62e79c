"""Steady rolling with feedback on omega: a scan over V.

With gains f = f0 + fV V + fw omega, q = q0 + qV V + qw omega the sum of the two equations, M(V) - (fV + qV) V -
(fw + qw) omega = f0 + q0, determines omega for every V.  The other equation has one unknown, V:

    R = Q(V, omega) - M_half_space + f = 0          Q = +-mu in full slip

R is smooth between the speeds at which omega - V is that of free rolling (0 of half-spaces, V delta_0 of covers) or at
a limit of stick, which are found first.  If fw + qw = 0, the sum determines V, and R = 0 is an equation for omega.

In this file all is dimensionless, and states are in a frame where V > 0; ``slip`` is omega - V, x is log2(kappa V)
with kappa = R/l0, mu is the coefficient of friction, delta_0 the creepage (omega - V)/V at which Q = 0, delta_star the
distance from it at which full slip begins, and a law is a :class:`LawTable`, the rows of one material.
Rows of :class:`.states.Field` are V, delta, Q, M_half_space, M_cylinder, beta and six slopes of the law, dQ_dV at
fixed omega, dQ_domega, dM_half_space_dV and dM_cylinder_dV; :class:`.states.States` have omega and the eigenvalues in
place of the slopes.
"""

from __future__ import annotations

import math
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...materials.law.table import LawTable
from .loads import Loads
from .resistance import find_zeros, speed_nodes
from .states import Field, States, contact_fields_at, find_crossings, free_creep, state_rows

#: nodes into which an interval of V with partial slip is divided
_STICK_NODES = 16
#: nodes of the slip between its limits
_SLIP_NODES = 129
#: Newton steps in V and slip
_NEWTON_STEPS = 4
#: residual of an equation divided by its terms above which a zero is no state
_RESIDUAL = 1e-6
#: relative difference of V and of delta below which two states are one
_SAME_STATE = 1e-10
#: rounding error of R divided by the sum of its terms; nodes with a smaller R have no sign
_ROUNDING = 2e-15


class _FreeRolling(NamedTuple):
    """The contact at several speeds, in the frame of the motion, each (n,).

    V : speeds, > 0.
    M, M_half_space : moment of both bodies and of the half-space.
    limit : V delta_star, > 0: full slip begins at omega - V = ``slip`` + limit and ``slip`` - limit.
    slip : omega - V of free rolling, V delta_0, at which Q = 0; the number 0.0 times V for half-spaces.
    """

    V: NDArray
    M: NDArray
    M_half_space: NDArray
    limit: NDArray
    slip: NDArray


class _ScanProblem(NamedTuple):
    """One load in the frame of the motion, in which V > 0; all is dimensionless.

    law : table of the material.
    load_rows : (2, 3): the row of the force and the row of the torque, each (value at rest, gain on V, gain on omega);
    the values at rest are those of the load, with the other sign for a motion with V < 0.
    kappa, mu : slenderness R/l0 and coefficient of friction.
    """

    law: LawTable
    load_rows: NDArray
    kappa: float
    mu: float

    def free_rolling(self, x: NDArray) -> _FreeRolling:
        """Return the contact at given speeds as :class:`_FreeRolling`: V, M, M_half_space, limit V delta_star of stick,
        and slip V delta_0 of free rolling, (n,) each, dimensionless.

        x: log2(kappa V), (n,).
        """
        V = np.exp2(x) / self.kappa
        M, M_half_space, star = contact_fields_at(
            self.law, self.kappa, self.mu, V, 0.0, "M", "M_half_space", "delta_star"
        )
        return _FreeRolling(V, M, M_half_space, star * V, free_creep(self.law, self.kappa, self.mu, V) * V)

    def loads_at(self, V: Any, omega: Any) -> NDArray:
        """Return force and torque at the speeds V and omega, numbers or (n,), as two rows: (2,) or (2, n)."""
        return self.load_rows @ np.array([np.ones_like(V), V, omega])

    def slip(self, V: NDArray, M: NDArray) -> NDArray:
        """Return omega - V at which force + torque equal M at V, (n,); the gains on omega must not add to 0."""
        return (M - self.loads_at(V, V).sum(axis=0)) / self.load_rows[:, 2].sum()

    def residual(self, x: NDArray, slip: NDArray) -> NDArray:
        """Return R = Q - M_half_space + force, 0 in equilibrium, at x = log2(kappa V) and slip = omega - V, (n,)."""
        V = np.exp2(x) / self.kappa
        Q, M_half_space = contact_fields_at(self.law, self.kappa, self.mu, V, slip / V, "Q", "M_half_space")
        return Q - M_half_space + self.loads_at(V, V + slip)[0]

    def rows(self, V: NDArray, slip: NDArray) -> tuple[NDArray, NDArray]:
        """Evaluate the law and the residuals of the equations of equilibrium, full slip included.

        V, slip : speed and omega - V, (n,), dimensionless, in the frame where V > 0.
        Returns (rows of :class:`Field` with the slopes of the law from row 6 on, (12, n); residuals, (2, n): M less
        force and torque, and Q - M_half_space + force), dimensionless; a state is one of equilibrium if both residuals
        are 0.
        """
        rows = state_rows(self.law, self.kappa, self.mu, V, slip / V)
        force, torque = self.loads_at(V, V + slip)
        M_half_space = rows[Field.M_HALF_SPACE]
        sums = M_half_space + rows[Field.M_CYLINDER] - force - torque
        return rows, np.array([sums, rows[Field.Q] - M_half_space + force])


def scan_states(law: LawTable, loads: Loads) -> States:
    """Find all states of rolling under loads with a gain on omega, by a scan over the speed.

    law : table of the material.
    loads : the loads, of which at least one of force and torque has a gain on omega; V is not given.
    Returns the :class:`States` of both directions of motion, with the signs of the motion, and those that spin at V = 0
    and omega other than 0; load by load, else unsorted.  States of full slip, with Q = +-mu, are among
    them; rest, V = omega = 0, is not.  omega of all of them is finite.
    Raises ParameterError where the gains on omega add to 0, for a gain on V that :func:`.resistance.branches` refuses.
    """
    gains = loads.gains
    gained = np.array([[gains.force_V, gains.force_omega], [gains.torque_V, gains.torque_omega]])
    parts = [States.none()]
    for n in range(loads.mu.size):
        at_rest = np.array([[loads.force[n]], [loads.torque[n]]])
        for sign in (1.0, -1.0):
            problem = _ScanProblem(law, np.hstack([sign * at_rest, gained]), loads.kappa[n], loads.mu[n])
            x, slip = _scan_speed(problem) if problem.load_rows[:, 2].sum() else _scan_slip(problem)
            rows = _polish(problem, np.exp2(x) / problem.kappa, slip)
            count = rows.shape[1]
            parts.append(States.of(loads, np.full(count, n), np.full(count, sign), rows))
        parts += _spinning_at_rest(law, loads, n)
    return States.joined(*parts)


def _spinning_at_rest(law: LawTable, loads: Loads, n: int) -> list[States]:
    """Return the equilibrium with V = 0 and omega other than 0 under the n-th load, if there is one.

    At V = 0 and omega other than 0 the whole contact slips: Q is all of the friction, and must balance the force to
    the bit.  As M = 0 there, omega follows from force + torque = 0.

    law: table of the material.
    loads: the loads with their gains, dimensionless.
    n: index of the load.
    Returns a list of one :class:`States` with one state, whose V is 0, whose creepage is infinite with the sign of
    omega, as of :func:`..contact.contact` at V = 0, and whose eigenvalues are those of the slowest speed of the nodes;
    or an empty list: also where the gains on omega add to 0, and where force + torque are 0 at rest.
    """
    gains, total = loads.gains, loads.force[n] + loads.torque[n]
    gain = gains.force_omega + gains.torque_omega
    if not (gain and total):
        return []
    omega = -total / gain
    side = math.copysign(1.0, omega)
    if side * loads.mu[n] + loads.force[n] + gains.force_omega * omega != 0.0:
        return []
    slowest = np.exp2(speed_nodes(law)[:1]) / loads.kappa[n]
    rows = state_rows(law, loads.kappa[n], loads.mu[n], slowest, 1.0 / slowest)
    spinning = States.of(loads, np.array([n]), np.array([side]), rows)
    spinning.rows[[Field.V, Field.DELTA, Field.M_HALF_SPACE, Field.M_CYLINDER, Field.OMEGA], 0] = (
        0.0,
        side * math.inf,
        0.0,
        0.0,
        omega,
    )
    return [spinning]


def _scan_speed(problem: _ScanProblem) -> tuple[NDArray, NDArray]:
    """Find the states of a load by a scan over V, where the sum of the equations gives omega at each V.

    Used where the gains on omega of force and torque have a sum other than 0.
    problem : :class:`_ScanProblem`, the load and the table of its material.
    Returns (x = log2(kappa V), ascending; slip = omega - V), (states,) each, dimensionless, in the frame where V > 0;
    empty arrays if there is no state.  The states are approximate; :func:`_polish` refines them and drops those that
    are none.
    """

    def beyond(x: NDArray, part: float) -> NDArray:
        free = problem.free_rolling(x)
        return problem.slip(free.V, free.M) - free.slip - part * free.limit

    nodes = speed_nodes(problem.law)
    nodes = np.unique(
        np.concatenate([nodes, *(find_zeros(partial(beyond, part=part), nodes) for part in (-1.0, 0.0, 1.0))])
    )
    free = problem.free_rolling(nodes)
    stuck = np.abs(problem.slip(free.V, free.M) - free.slip) <= free.limit * (1.0 + 1e-9)
    within = np.flatnonzero(stuck[1:] | stuck[:-1])
    fine = nodes[within, None] + np.linspace(0.0, 1.0, _STICK_NODES)[1:-1] * np.diff(nodes)[within, None]
    nodes = np.unique(np.concatenate([nodes, fine.ravel()]))
    V, M, M_half_space, *_ = problem.free_rolling(nodes)
    terms = (
        problem.mu + M_half_space + np.abs(problem.load_rows[0]) @ np.abs([np.ones_like(V), V, V + problem.slip(V, M)])
    )
    found = find_zeros(
        lambda x: problem.residual(x, problem.slip(*problem.free_rolling(x)[:2])), nodes, _ROUNDING * terms
    )
    return found, problem.slip(*problem.free_rolling(found)[:2])


def _scan_slip(problem: _ScanProblem) -> tuple[NDArray, NDArray]:
    """Find the states of a load by a scan over the slip, where the sum of the equations gives V alone.

    Used where the gains on omega of force and torque have the sum 0, but are not 0.
    problem : :class:`_ScanProblem`, the load and the table of its material.
    Returns (x = log2(kappa V), slip = omega - V), (states,) each, dimensionless, in the frame where V > 0, unsorted;
    empty arrays if there is no state.  States of partial slip are zeros over the slip, those of full slip follow from
    Q = mu or -mu.
    Raises ParameterError for a gain on V out of range.
    """
    at_rest, of_V, _ = problem.load_rows.sum(axis=0)
    _, sign, u = find_crossings(problem.law, of_V, np.array([problem.kappa * at_rest]))
    positions, slips = [np.empty(0)], [np.empty(0)]
    for x in np.log2(u[sign > 0.0]):
        V, _, M_half_space, (limit,), (free_slip,) = problem.free_rolling(np.array([x]))
        rest = M_half_space - problem.loads_at(V, V)[0]  # Q + gain slip

        def residual(part: NDArray, x: float = x, limit: float = limit, free_slip: float = free_slip) -> NDArray:
            return problem.residual(np.full(part.size, x), free_slip + limit * part)

        sides = np.array([1.0, -1.0])
        full = (rest - sides * problem.mu) / problem.load_rows[0, 2]
        partial_slip = free_slip + limit * find_zeros(residual, np.linspace(-1.0, 1.0, _SLIP_NODES))
        slips += [partial_slip, full[sides * (full - free_slip) > limit]]
        positions += [np.full(each.size, x) for each in slips[-2:]]
    return np.concatenate(positions), np.concatenate(slips)


def _polish(problem: _ScanProblem, V: NDArray, slip: NDArray) -> NDArray:
    """Refine approximate states, and drop those that are no states or occur twice.

    It makes four Newton steps in V and slip on M = force + torque and R = 0, since the scans find V to the rounding of
    its logarithm alone.
    problem : :class:`_ScanProblem`, the load and the table of its material.
    V, slip : speed and omega - V of the approximate states, (n,), dimensionless, in the frame where V > 0; n may be 0.
    Returns rows of :class:`Field` with the slopes of the law from row 6 on at the refined states, (12, states), sorted
    by V and creepage.  A step that does not reduce the sum of the moduli of both residuals, or changes V by a
    thousandth or more, is rejected.  A state of which a residual stays above :data:`_RESIDUAL` times (mu +
    |M_half_space| + |M_cylinder|) is dropped, and of neighbours in this order whose V and delta agree to
    :data:`_SAME_STATE`, relative, all but the first.  A jump from full slip to full slip of the other sign, within the
    rounding of V, may be found as two zeros of R: these are refined to one state, or dropped.
    """
    rows, residuals = problem.rows(V, slip)
    gains = problem.load_rows[:, 1:]
    (of_V, of_omega), (force_V, force_omega) = gains.sum(axis=0), gains[0]
    for _ in range(_NEWTON_STEPS if V.size else 0):
        a, b, one, other = rows[Field.DQ_DV : Field.DM_HALF_SPACE_DOMEGA]
        sum_V, sum_slip = one + other - of_V - of_omega, -of_omega
        rest_V, rest_slip = a + b - one + force_V + force_omega, b + force_omega
        det = sum_V * rest_slip - sum_slip * rest_V
        with np.errstate(divide="ignore", invalid="ignore"):
            dV = (residuals[0] * rest_slip - residuals[1] * sum_slip) / det
            dslip = (residuals[1] * sum_V - residuals[0] * rest_V) / det
        good = np.isfinite(dslip) & (np.abs(dV) < 1e-3 * V)
        new = np.where(good, [V - dV, slip - dslip], [V, slip])
        new_rows, new_residuals = problem.rows(*new)
        better = good & (np.abs(new_residuals).sum(axis=0) < np.abs(residuals).sum(axis=0))
        V, slip = np.where(better, new, [V, slip])
        rows, residuals = np.where(better, new_rows, rows), np.where(better, new_residuals, residuals)
    V, delta = rows[Field.V], rows[Field.DELTA]
    size = problem.mu + np.abs(rows[Field.M_HALF_SPACE]) + np.abs(rows[Field.M_CYLINDER])
    left = np.abs(residuals).max(axis=0) <= _RESIDUAL * size
    order = np.flatnonzero(left)
    order = order[np.lexsort((delta[order], V[order]))]
    V, delta = V[order], delta[order]
    new = (np.abs(np.diff(V)) > _SAME_STATE * V[1:]) | (np.abs(np.diff(delta)) > _SAME_STATE * np.abs(delta[1:]))
    return rows[:, order[np.concatenate([[True], new]).astype(bool)[: order.size]]]
