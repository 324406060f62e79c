"""The law of a motion as a table of one scene (:mod:`.coupled_splines`), in the unknowns of a
motion.

The second unknown of partial slip is d = sigma w, with w the place of the table on the side sigma
of its middle creep: 2 kappa delta = D_0 + mu L d, where mu L is the distance of the onset of sigma
from D_0.  So D_0 stands where the creepage of free rolling stands in the equations of a cover
(:mod:`.rhs`), and L depends on sigma.

``table`` is None for a law without one: then functions return what their callers found on the rows,
and nothing of a table is compiled.  All is dimensionless.
"""

from typing import NamedTuple

import numpy as np

from ..law.coupled_splines import (
    CYLINDER,
    HALF_SPACE,
    MIDDLE,
    ONSET,
    TRACTION,
    WORK,
    edge_at,
    field_at,
    locate_creep,
    locate_speed,
    place_of,
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
    """Creeps at one speed: L of one side and the middle creep D_0, each with two derivatives over
    u.
    """

    L: float
    dL: float
    ddL: float
    middle: float
    dmiddle: float
    ddmiddle: float


@inline_kernel
def free_creep_of_table(width, u, kappa, k, rows, table):
    """Return D_0 as :class:`.cover_law.FreeCreep`.

    width: :class:`Width` at u = kappa |V|.  k: mu/(2 kappa).  rows: what
    :func:`.cover_law.free_kinematics` gives.
    """
    if table is None:
        return rows
    factor = 0.5 / kappa
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


class TableState(NamedTuple):
    """Loads of partial or full slip with their derivatives: in V at fixed d (_dV), in d at fixed V
    (_dd).
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
    """Return the :class:`Width` at u = kappa |V| on the side sigma, 1.0 or -1.0; ``rows``: that of
    the rows.
    """
    if table is None:
        return rows
    speed = locate_speed(u, table)
    middle, dmiddle, ddmiddle = _edge(MIDDLE, u, speed, table)
    onset, donset, ddonset = _edge(ONSET + np.int64(sigma > 0.0), u, speed, table)
    factor = sigma / mu
    L = factor * (onset - middle)
    return Width(
        L=L,
        dL=factor * (donset - dmiddle),
        ddL=factor * (ddonset - ddmiddle),
        middle=middle,
        dmiddle=dmiddle,
        ddmiddle=ddmiddle,
    )


@inline_kernel
def _edge(name, u, speed, table):
    """Return an edge with two derivatives over u."""
    found = edge_at(name, u, speed, table)
    return found.value, found.du, found.dw


@inline_kernel
def loads_on_rows(Q, Q_dV, Q_dd, moments):
    """Return traction with its derivatives and :class:`.motion_law.LoadedMoments`, of the rows, as
    :class:`TableState`.
    """
    return TableState(
        Q=Q,
        Q_dV=Q_dV,
        Q_dd=Q_dd,
        half_space=moments.half_space,
        half_space_dV=moments.half_space_dV,
        half_space_dd=moments.half_space_dd,
        cylinder=moments.cylinder,
        cylinder_dV=moments.cylinder_dV,
        cylinder_dd=moments.cylinder_dd,
    )


@inline_kernel
def table_state(V, d, sigma, kappa, mu, rows, table):
    """Return the :class:`TableState` at a speed V of either sign and d on the side sigma; full slip
    where sigma d >= 1.

    rows: that of the rows.

    In full slip at V < 0 it is that of the opposite direction, in which slip has the opposite sign.
    """
    if table is None:
        return rows
    w = sigma * d
    sign = 1.0
    if w >= 1.0 and V < 0.0:
        sign = -1.0
        sigma = -sigma
    u = kappa * abs(V)
    du_dV = kappa if V >= 0.0 else -kappa
    speed = locate_speed(u, table)
    place = locate_creep(w, sigma, table)
    Q = field_at(TRACTION, w, speed, place, table)
    half_space = field_at(HALF_SPACE, w, speed, place, table)
    cylinder = field_at(CYLINDER, w, speed, place, table)
    turned = mu * sign
    moment = sign / kappa
    return TableState(
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
    """Return what friction does at V = 0, in the direction of the regime: force on the axis, torque
    against the spin.

    d: float, at most 1 in modulus.
    rows: what the rows give, (Q - M_half_space, Q + M_cylinder, their derivatives in d).
    """
    if table is None:
        return rows
    none = TableState(
        Q=0.0,
        Q_dV=0.0,
        Q_dd=0.0,
        half_space=0.0,
        half_space_dV=0.0,
        half_space_dd=0.0,
        cylinder=0.0,
        cylinder_dV=0.0,
        cylinder_dd=0.0,
    )
    found = table_state(0.0, d, np.copysign(1.0, d), kappa, mu, none, table)
    return (
        found.Q - found.half_space,
        found.Q + found.cylinder,
        found.Q_dd - found.half_space_dd,
        found.Q_dd + found.cylinder_dd,
    )


@inline_kernel
def balance_of_table(load, kappa, mu, rows, table):
    """Return the margin by which a cylinder at rest keeps still under a load; below 0 it moves.

    It begins to roll in a direction if, with friction in balance with the force, the torque is
    above what friction takes in rolling: also where bodies are elastic some slip remains in free
    rolling of a cover.
    rows: float, the margin that the rows give.
    Returns the smaller margin of both directions, less than 0 where no friction balances the force.
    """
    if table is None:
        return rows
    margin = np.inf
    for direction in (1.0, -1.0):
        low = -1.0
        high = 1.0
        for _ in range(_HALVINGS):
            d = 0.5 * (low + high)
            if (
                pull_of_table(d, kappa, mu, (0.0, 0.0, 0.0, 0.0), table)[0] + direction * load.force
                < 0.0
            ):
                low = d
            else:
                high = d
        d = 0.5 * (low + high)
        if abs(d) >= 1.0 - _EDGE:
            return min(mu - abs(load.force), -_EDGE)
        margin = min(
            margin,
            pull_of_table(d, kappa, mu, (0.0, 0.0, 0.0, 0.0), table)[1] - direction * load.torque,
        )
    if abs(margin) < _ROUNDING * mu:
        margin = 0.0
    return margin + load.brake


@inline_kernel
def strain_power(V, omega, kappa, table):
    """Return the power that the bodies take by the strain of their surfaces along the path, at V >=
    0 and omega.
    """
    if table is None:
        return 0.0
    u = kappa * abs(V)
    slip = omega - V
    D = 2.0 * kappa * slip / V if V > 0.0 else np.copysign(np.inf, slip)
    speed = locate_speed(u, table)
    state = place_of(D, u, speed, table)
    place = locate_creep(state.w, state.sigma, table)
    work = (
        field_at(WORK, state.w, speed, place, table).value
        + field_at(WORK + 1, state.w, speed, place, table).value
    )
    return 0.5 * V * work / kappa
