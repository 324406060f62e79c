"""The law of a motion as a table of one scene (:mod:`.coupled_splines`), in the unknowns of a
motion.

A table holds traction and moments as functions of u = kappa |V| and of the creep D = 2 kappa delta
at one coefficient of friction mu.  D_0(u) is its middle creep, which divides two sides, sigma = 1
above it and -1 below it; on either side full slip begins at an onset D_sigma(u).  The relative
distance w = (D - D_0)/(D_sigma - D_0) is 0 at the middle creep and 1 at the onset.

The second unknown of partial slip is d = sigma w: 2 kappa delta = D_0 + mu L d, where mu L = sigma
(D_sigma - D_0) is the distance of the onset of sigma from D_0.  So D_0 stands where the creepage
without creep force stands in the equations of a cover (:mod:`.rhs`), and L depends on sigma.

``table`` is None for a law without one: then functions return what their callers found on the rows
of the law (``rows``), and nothing of a table is compiled.  All is dimensionless: speeds in
R/T_epsilon, Q in P, moments in P R.
"""

from typing import NamedTuple

import numpy as np

from ..law.coupled_splines import (
    CYLINDER,
    FIELD_COUNT,
    FRICTION,
    HALF_SPACE,
    MIDDLE,
    ONSET,
    TRACTION,
    cell_at,
    edge_at,
    field_at,
    locate_creep,
    locate_speed,
    place_of,
    value_at,
)
from ..law.cover_law import FreeCreep, OverSpeed
from ..numerics.jit import inline_kernel

#: Bisections of d in [-1, 1], to rounding.
_HALVINGS = 54
#: Margin over mu that counts as none: rounding where nothing slips in slow free rolling.
_ROUNDING = 1e-14
#: Distance of d from +-1 that counts as none.
_EDGE = 1e-12


class Width(NamedTuple):
    """Creeps at one speed, dimensionless: L of one side and the middle creep D_0.

    L, dL, ddL : L and its first two derivatives over u.
    middle, dmiddle, ddmiddle : D_0 and its first two derivatives over u; of a law without a table
        2 kappa delta_0, or 0 where the caller adds the creepage delta_0 of free rolling itself.
    """

    L: float
    dL: float
    ddL: float
    middle: float
    dmiddle: float
    ddmiddle: float


@inline_kernel
def free_creep_of_table(width, u, kappa, k, rows, table):
    """Return D_0 as :class:`.cover_law.FreeCreep`, whose delta_0 is D_0/(2 kappa) of a table.

    width: :class:`Width` at u, with its derivatives.
    u: float, kappa |V|, at least 0.
    kappa: float, slenderness R/l0, > 0.
    k: float, mu/(2 kappa), > 0.
    rows: what :func:`.cover_law.free_kinematics` gives, the result without a table.
    table: vector of :mod:`.coupled_splines`, or None.
    """
    if table is None:
        return rows
    factor = 0.5 / kappa
    # delta_0; d(V delta_0)/dV over k d(u L)/du; d^2(u delta_0)/du^2 over k.
    return FreeCreep(
        factor * width.middle,
        factor * (width.middle + u * width.dmiddle) / (k * (width.L + u * width.dL)),
        factor * (2.0 * width.dmiddle + u * width.ddmiddle) / k,
    )


@inline_kernel
def asymmetry_of_table(rows, table):
    """Return the asymmetry c as :class:`.cover_law.OverSpeed`: 0 of a table, whose sides have an L
    each; else ``rows``, that of the rows.
    """
    return rows if table is None else OverSpeed(0.0, 0.0, 0.0)


class Loads(NamedTuple):
    """Traction and rolling moments of partial or full slip, dimensionless, with their derivatives:
    in V at fixed d (_dV; of rows in full slip at fixed omega), in d at fixed V (_dd).

    Q : traction.  half_space, cylinder : M_half_space and M_cylinder.
    """

    Q: float
    Q_dV: float
    Q_dd: float
    half_space: float
    half_space_dV: float
    half_space_dd: float
    cylinder: float
    cylinder_dV: float
    cylinder_dd: float


@inline_kernel
def width_at(u, sigma, mu, rows, table):
    """Return the :class:`Width` at a speed on one side of D_0.

    u : float, kappa |V|, at least 0.
    sigma : float, side, 1.0 or -1.0.
    mu : float, coefficient of friction, > 0.
    rows : Width that the rows give, the result without a table.
    table : vector of :mod:`.coupled_splines`, or None.
    """
    if table is None:
        return rows
    speed = locate_speed(u, table)
    middle = edge_at(MIDDLE, u, speed, table)
    # The onset of sigma = -1 is stored first, that of 1 after it.
    onset = edge_at(ONSET + np.int64(sigma > 0.0), u, speed, table)
    factor = sigma / mu
    return Width(
        L=factor * (onset.value - middle.value),
        dL=factor * (onset.du - middle.du),
        ddL=factor * (onset.ddu - middle.ddu),
        middle=middle.value,
        dmiddle=middle.du,
        ddmiddle=middle.ddu,
    )


@inline_kernel
def table_state(V, d, sigma, kappa, mu, rows, table):
    """Return the :class:`Loads` of a state by the table, or ``rows`` of a law without one.

    V: float, speed of the axis, of either sign.
    d: float, second unknown of the module, of either sign; full slip where sigma d >= 1.
    sigma: float, side of D_0, 1.0 or -1.0.
    kappa, mu: floats, slenderness and coefficient of friction, > 0.
    rows: :class:`Loads` that the rows of the law give, the result without a table.
    table: vector of :mod:`.coupled_splines`, or None.
    """
    if table is None:
        return rows
    return _loads(V, d, sigma, kappa, mu, table)


@inline_kernel
def _loads(V, d, sigma, kappa, mu, table):
    """Return the :class:`Loads` of a state of a table; full slip where sigma d >= 1.

    V : float, speed of the axis, of either sign.
    d : float, second unknown of the module, of either sign.
    sigma : float, side of D_0, 1.0 or -1.0.
    kappa, mu : floats, slenderness and coefficient of friction, > 0.
    table : vector of :mod:`.coupled_splines`.
    In full slip at V < 0 it is that of the opposite direction, in which slip has the opposite sign:
    the table is read on the other side, and loads and moments change their signs.
    """
    w = sigma * d
    sign = 1.0  # -1 where the state is read in the opposite direction
    if w >= 1.0 and V < 0.0:
        sign = -1.0
        sigma = -sigma
    u = kappa * abs(V)
    # Partial slip at V < 0, of trial states of Newton's iteration, is read at |V| without a change
    # of sign, so that only slopes over V change theirs.
    du_dV = kappa if V >= 0.0 else -kappa
    speed = locate_speed(u, table)
    cell = cell_at(speed, locate_creep(w, sigma, table), table)
    Q = field_at(TRACTION, w, cell, table)
    half_space = field_at(HALF_SPACE, w, cell, table)
    cylinder = field_at(CYLINDER, w, cell, table)
    # The table holds Q/mu and kappa times the moments; dw/dd = sigma at fixed V.
    turned = mu * sign
    moment = sign / kappa
    return Loads(
        Q=turned * Q.value,
        Q_dV=turned * du_dV * Q.du,
        Q_dd=turned * sigma * Q.dw,
        half_space=moment * half_space.value,
        half_space_dV=moment * du_dV * half_space.du,
        half_space_dd=moment * sigma * half_space.dw,
        cylinder=moment * cylinder.value,
        cylinder_dV=moment * du_dV * cylinder.du,
        cylinder_dd=moment * sigma * cylinder.dw,
    )


@inline_kernel
def pull_of_table(d, kappa, mu, rows, table):
    """Return force on the axis and torque against the spin at V = 0, in the direction of the
    regime, and their derivatives with respect to d.

    d: float, creepage divided by that of the onset of full slip, in [-1, 1].
    kappa, mu: floats, slenderness and coefficient of friction.
    rows: the same four numbers by the rows of the law, which are returned if there is no table.
    table: vector of :mod:`.coupled_splines`, or None.
    Returns four floats, dimensionless: Q - M_half_space, Q + M_cylinder, their derivatives.
    """
    if table is None:
        return rows
    return _pull(d, kappa, mu, table)


@inline_kernel
def _pull(d, kappa, mu, table):
    """Return (Q - M_half_space, Q + M_cylinder, their derivatives in d) at V = 0 of a table.

    d: float, at most 1 in modulus.
    kappa, mu: floats, slenderness and coefficient of friction.
    table: vector of :mod:`.coupled_splines`.
    Returns four floats, dimensionless.
    """
    # sigma is the sign of d; at d = 0 both sides have the same loads, but not the same derivatives
    found = _loads(0.0, d, np.copysign(1.0, d), kappa, mu, table)
    return (
        found.Q - found.half_space,
        found.Q + found.cylinder,
        found.Q_dd - found.half_space_dd,
        found.Q_dd + found.cylinder_dd,
    )


class SlowLaw(NamedTuple):
    """Loads in the limit V -> 0 near free rolling, dimensionless: with the traction Q, M_half_space
    = V half_space - reaction_half_space Q, M_cylinder alike, and the creepage exceeds that of free
    rolling at rest, delta_0, by creep_V V + creep_Q Q.

    Q_V : quotient Q/V at d = 0; Q is larger where d > 0.
    """

    half_space: float
    cylinder: float
    reaction_half_space: float
    reaction_cylinder: float
    creep_V: float
    creep_Q: float
    Q_V: float


@inline_kernel
def slow_law_of_table(sigma, kappa, mu, rows, table):
    """Return the :class:`SlowLaw` of a table on one side of D_0.

    Near V = 0 and d = 0 the table is linear in both, and d is eliminated in favour of Q.

    sigma: float, side, 1.0 or -1.0, on which slopes over d depend.
    kappa, mu: floats, slenderness and coefficient of friction.
    rows: SlowLaw of the rows of the law, the result without a table.
    table: vector of :mod:`.coupled_splines` with :func:`sticks_at_rest`, or None.
    """
    if table is None:
        return rows
    at = _loads(0.0, 0.0, sigma, kappa, mu, table)
    width = width_at(0.0, sigma, mu, Width(1.0, 0.0, 0.0, 0.0, 0.0, 0.0), table)
    # d = (Q - Q_dV V)/Q_dd; 2 kappa delta = D_0 + mu L d, where D_0 is linear in u = kappa V.  So
    # M = M_dV V + M_dd d = (M_dV - Q_dV M_dd/Q_dd) V + (M_dd/Q_dd) Q, and the reaction is minus the
    # factor of Q.
    half_space = at.half_space_dd / at.Q_dd
    cylinder = at.cylinder_dd / at.Q_dd
    creep = 0.5 * mu * width.L / (kappa * at.Q_dd)
    return SlowLaw(
        half_space=at.half_space_dV - half_space * at.Q_dV,
        cylinder=at.cylinder_dV - cylinder * at.Q_dV,
        reaction_half_space=-half_space,
        reaction_cylinder=-cylinder,
        creep_V=0.5 * width.dmiddle - creep * at.Q_dV,
        creep_Q=creep,
        Q_V=at.Q_dV,
    )


@inline_kernel
def sticks_at_rest(kappa, mu, table):
    """Return whether no slip remains in free rolling in the limit V -> 0, a bool; True without a
    table.

    Then Q and M are 0 exactly at d = 0.  Else a freely rolling cylinder comes to rest by the loss
    in slip.

    kappa, mu: floats, slenderness and coefficient of friction.
    table: vector of :mod:`.coupled_splines`, or None.
    """
    if table is None:
        return True
    found = _loads(0.0, 0.0, 1.0, kappa, mu, table)
    return found.Q == 0.0 and found.half_space + found.cylinder == 0.0


@inline_kernel
def balance_of_table(load, kappa, mu, rows, table):
    """Return the margin by which a cylinder at rest keeps still under a load; below 0 it moves.

    It begins to roll in a direction if, with friction in balance with the force, the torque is
    above what friction takes in rolling: also where bodies are elastic some slip remains in free
    rolling of a cover.

    load: Load at rest, of which force, torque and brake are read.
    kappa, mu: floats, slenderness and coefficient of friction.
    rows: float, the margin that the rows give, the result without a table.
    table: vector of :mod:`.coupled_splines`, or None.
    Returns the smaller margin of both directions plus the torque of the brake, a float,
    dimensionless; less than 0 where no friction balances the force.
    """
    if table is None:
        return rows
    margin = np.inf
    for direction in (1.0, -1.0):
        # d at which Q - M_half_space, which grows with d, balances the force, by bisection.
        low = -1.0
        high = 1.0
        for _ in range(_HALVINGS):
            d = 0.5 * (low + high)
            if _pull(d, kappa, mu, table)[0] + direction * load.force < 0.0:
                low = d
            else:
                high = d
        d = 0.5 * (low + high)
        if abs(d) >= 1.0 - _EDGE:  # The bisection ran to an end: no d balances the force.
            # moments may leave a force below mu unbalanced too: below 0 in any case
            return min(mu - abs(load.force), -_EDGE)
        # torque that friction takes at this d in rolling in this direction
        on_spin = _pull(d, kappa, mu, table)[1]
        margin = min(margin, on_spin - direction * load.torque)
    if abs(margin) < _ROUNDING * mu:
        margin = 0.0
    return margin + load.brake


@inline_kernel
def friction_by_shear(V, omega, Q, kappa, mu, rows, table):
    """Return the slip loss minus (omega - V) Q, a power in units of P R/T_ref.

    The strains of both surfaces along the path make the slip of the surfaces differ from omega - V.
    The returned power is minus the power that the bodies lose by shear on these strains.

    V, omega: floats, speed of the axis, >= 0, and angular velocity, dimensionless.
    Q: float, traction divided by P.
    kappa, mu: floats, slenderness and coefficient of friction.
    rows: float, the same power by the rows of the law, which is returned if there is no table, or
        the table does not have the slip loss.
    table: vector of :mod:`.coupled_splines`, or None.
    Returns a float.  The slip loss has its own spline: where almost all of the contact sticks, the
    difference of two other splines would have no correct digits.
    """
    if table is None:
        return rows
    if table[FIELD_COUNT] <= FRICTION:  # Only graded tables have the slip loss.
        return rows
    u = kappa * abs(V)
    slip = omega - V
    D = 2.0 * kappa * slip / V if V > 0.0 else np.copysign(np.inf, slip)  # creep 2 kappa delta
    speed = locate_speed(u, table)
    state = place_of(D, u, speed, table)
    w = state.w
    sigma = state.sigma
    # Full slip, in which Q is mu or -mu to the last bit, is told by Q, not by the creep: the nodes
    # of a step that passes the onset have a smooth power, which its quadrature requires.
    if abs(Q) == mu:
        w = np.inf
        sigma = np.copysign(1.0, Q)
    cell = cell_at(speed, locate_creep(w, sigma, table), table)
    # Slip loss; the field is 2 kappa times it per unit of V.
    friction = 0.5 * V / kappa * max(value_at(FRICTION, cell, table), 0.0)
    if w > 1.0:
        # In full slip the field is that of the onset: mu times the speed by which the slip exceeds
        # that of the onset is added.
        onset = edge_at(ONSET + np.int64(sigma > 0.0), u, speed, table).value
        friction += mu * sigma * (slip - 0.5 * V * onset / kappa)
    return friction - slip * Q
