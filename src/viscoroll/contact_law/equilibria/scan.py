"""Steady rolling where force or torque follow omega: a scan over V.

With gains f = f0 + fV V + fw omega, q = q0 + qV V + qw omega the sum of the two equations, M(V) - (fV + qV) V -
(fw + qw) omega = f0 + q0, gives omega for every V, and the other is one equation in V:

    R = Q(V, omega) - M_half_space + f = 0          Q = +-mu where the contact slips fully

Between the speeds where omega - V is 0 or the limit of stick, which are found first, R is smooth.  Where fw + qw = 0
the sum fixes V, and R is an equation in omega.  All here is in a frame where V > 0.
"""

from __future__ import annotations

import math
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...materials.law_table import LawTable
from . import row
from .loads import Loads
from .resistance import grid, zeros
from .states import States, contact_at, crossings, rows_at

#: nodes that an interval of V within the stick limit is cut into, and those of a slip between its limits
_FINE, _SLIPS = 16, 129
#: steps of Newton's iteration in V and slip; what is left of an equation over mu that is no state; states of the same V
#: and slip, relative, are one
_POLISH, _LEFT, _SAME = 4, 1e-6, 1e-10
#: of R over the sum of its terms: as V -> 0 it may vanish altogether
_ROUNDING = 2e-15


class _Case(NamedTuple):
    """One load along the motion; ``acts``: rows of force and torque, at rest and for each unit of V and omega."""

    law: LawTable
    acts: NDArray
    kappa: float
    mu: float

    def at(self, x: NDArray) -> tuple[NDArray, NDArray, NDArray, NDArray]:
        """(V, M, M_half_space, slip at the limit of stick) at x = log2(kappa V)."""
        V = np.exp2(x) / self.kappa
        M, M_half_space, star = contact_at(self.law, self.kappa, self.mu, V, 0.0, "M", "M_half_space", "delta_star")
        return V, M, M_half_space, star * V

    def acting(self, V: Any, omega: Any) -> NDArray:
        """Force and torque at these speeds."""
        return self.acts @ np.array([np.ones_like(V), V, omega])

    def slip(self, V: NDArray, M: NDArray) -> NDArray:
        """omega - V by the sum of the equations."""
        return (M - self.acting(V, V).sum(axis=0)) / self.acts[:, 2].sum()

    def excess(self, x: NDArray, slip: NDArray) -> NDArray:
        """R at x and omega - V."""
        V = np.exp2(x) / self.kappa
        Q, M_half_space = contact_at(self.law, self.kappa, self.mu, V, slip / V, "Q", "M_half_space")
        return Q - M_half_space + self.acting(V, V + slip)[0]

    def rows(self, V: NDArray, slip: NDArray) -> tuple[NDArray, NDArray]:
        """(Rows of :mod:`row` where omega - V is given, full slip included; what is left of the sum of the equations,
        and of that along V)."""
        rows = rows_at(self.law, self.kappa, self.mu, V, slip / V)
        force, torque = self.acting(V, V + slip)
        M_half_space = rows[row.M_HALF_SPACE]
        sums = M_half_space + rows[row.M_CYLINDER] - force - torque
        return rows, np.array([sums, rows[row.Q] - M_half_space + force])


def scanned(law: LawTable, loads: Loads) -> States:
    """All states of rolling but rest."""
    gains = loads.gains
    gained = np.array([[gains.force_V, gains.force_omega], [gains.torque_V, gains.torque_omega]])
    parts = [States.none()]
    for n in range(loads.mu.size):
        at_rest = np.array([[loads.force[n]], [loads.torque[n]]])
        for sign in (1.0, -1.0):
            case = _Case(law, np.hstack([sign * at_rest, gained]), loads.kappa[n], loads.mu[n])
            x, slip = _over_V(case) if case.acts[:, 2].sum() else _over_slip(case)
            rows = _polished(case, np.exp2(x) / case.kappa, slip)
            count = rows.shape[1]
            parts.append(States.of(loads, np.full(count, n), np.full(count, sign), rows))
        parts += _on_the_spot(law, loads, n)
    return States.joined(*parts)


def _on_the_spot(law: LawTable, loads: Loads, n: int) -> list[States]:
    """V = 0 and omega not, where friction and force balance to the bit."""
    gains, total = loads.gains, loads.force[n] + loads.torque[n]
    gain = gains.force_omega + gains.torque_omega
    if not (gain and total):
        return []
    omega = -total / gain
    side = math.copysign(1.0, omega)
    if side * loads.mu[n] + loads.force[n] + gains.force_omega * omega != 0.0:
        return []
    slowest = np.exp2(grid(law)[:1]) / loads.kappa[n]
    rows = rows_at(law, loads.kappa[n], loads.mu[n], slowest, 1.0 / slowest)
    spinning = States.of(loads, np.array([n]), np.array([side]), rows)
    spinning.rows[[row.V, row.DELTA, row.M_HALF_SPACE, row.M_CYLINDER, row.OMEGA], 0] = 0.0, math.inf, 0.0, 0.0, omega
    return [spinning]


def _over_V(case: _Case) -> tuple[NDArray, NDArray]:
    """x and slip of every state, where omega follows from V."""

    def beyond(x: NDArray, part: float) -> NDArray:
        V, M, _, limit = case.at(x)
        return case.slip(V, M) - part * limit

    nodes = grid(case.law)
    nodes = np.unique(np.concatenate([nodes, *(zeros(partial(beyond, part=part), nodes) for part in (-1.0, 0.0, 1.0))]))
    V, M, _, limit = case.at(nodes)
    stuck = np.abs(case.slip(V, M)) <= limit * (1.0 + 1e-9)
    within = np.flatnonzero(stuck[1:] | stuck[:-1])
    fine = nodes[within, None] + np.linspace(0.0, 1.0, _FINE)[1:-1] * np.diff(nodes)[within, None]
    nodes = np.unique(np.concatenate([nodes, fine.ravel()]))
    V, M, M_half_space, _ = case.at(nodes)
    terms = case.mu + M_half_space + np.abs(case.acts[0]) @ np.abs([np.ones_like(V), V, V + case.slip(V, M)])
    found = zeros(lambda x: case.excess(x, case.slip(*case.at(x)[:2])), nodes, _ROUNDING * terms)
    return found, case.slip(*case.at(found)[:2])


def _over_slip(case: _Case) -> tuple[NDArray, NDArray]:
    """x and slip of every state, where the sum of the equations fixes V."""
    at_rest, of_V, _ = case.acts.sum(axis=0)
    _, sign, u = crossings(case.law, of_V, np.array([case.kappa * at_rest]))
    places, slips = [np.empty(0)], [np.empty(0)]
    for x in np.log2(u[sign > 0.0]):
        V, _, M_half_space, (limit,) = case.at(np.array([x]))
        rest = M_half_space - case.acting(V, V)[0]  # Q + gain slip

        def excess(part: NDArray, x: float = x, limit: float = limit) -> NDArray:
            return case.excess(np.full(part.size, x), limit * part)

        sides = np.array([1.0, -1.0])
        free = (rest - sides * case.mu) / case.acts[0, 2]
        slips += [limit * zeros(excess, np.linspace(-1.0, 1.0, _SLIPS)), free[sides * free > limit]]
        places += [np.full(each.size, x) for each in slips[-2:]]
    return np.concatenate(places), np.concatenate(slips)


def _polished(case: _Case, V: NDArray, slip: NDArray) -> NDArray:
    """Rows of the states after some steps of Newton's iteration in V and slip; one that does not help is left out.

    Where the contact passes from slip to slip within rounding of V, two zeros are one state, or none.
    """
    rows, off = case.rows(V, slip)
    gains = case.acts[:, 1:]
    (of_V, of_omega), (force_V, force_omega) = gains.sum(axis=0), gains[0]
    for _ in range(_POLISH if V.size else 0):
        a, b, one, other = rows[row.DQ_DV :]
        sum_V, sum_slip = one + other - of_V - of_omega, -of_omega
        rest_V, rest_slip = a + b - one + force_V + force_omega, b + force_omega
        det = sum_V * rest_slip - sum_slip * rest_V
        with np.errstate(divide="ignore", invalid="ignore"):
            dV = (off[0] * rest_slip - off[1] * sum_slip) / det
            dslip = (off[1] * sum_V - off[0] * rest_V) / det
        good = np.isfinite(dslip) & (np.abs(dV) < 1e-3 * V)
        new = np.where(good, [V - dV, slip - dslip], [V, slip])
        new_rows, new_off = case.rows(*new)
        better = good & (np.abs(new_off).sum(axis=0) < np.abs(off).sum(axis=0))
        V, slip = np.where(better, new, [V, slip])
        rows, off = np.where(better, new_rows, rows), np.where(better, new_off, off)
    V, delta = rows[row.V], rows[row.DELTA]
    left = np.abs(off).max(axis=0) <= _LEFT * (case.mu + np.abs(rows[row.M_HALF_SPACE]) + np.abs(rows[row.M_CYLINDER]))
    order = np.flatnonzero(left)
    order = order[np.lexsort((delta[order], V[order]))]
    V, delta = V[order], delta[order]
    new = (np.abs(np.diff(V)) > _SAME * V[1:]) | (np.abs(np.diff(delta)) > _SAME * np.abs(delta[1:]))
    return rows[:, order[np.concatenate([[True], new]).astype(bool)[: order.size]]]
