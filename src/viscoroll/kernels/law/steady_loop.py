"""Steady rolling over arrays: the speeds at which M(V) meets a load, the creep at which Q does, and how they answer.

With zeta as the unknown speed and moment are explicit, u = kappa V = lam/(2 zeta) and kappa M = u m(zeta), so that
M(V) - gain V = load is one equation between two nodes where its left side is monotone.  The creep comes from
Eqs. (15) and (10): H(eta) = (1 - |Q|/mu) H(zeta), Eq. (6) at the speed V/sqrt(1 - |Q|/mu).
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ..compile.choice import by_record
from ..compile.jit import kernel
from ..material.functions import at_contact, generator_slopes
from ..material.pair import Pair, parts
from ..material.tabulated import Tabulated
from .length import OK, contact_length, contact_solution, near_length
from .state import stick, traction_slopes
from .states import State
from .stick import CLOSE, differences

#: rows of :func:`curve_loop`: kappa V, kappa (M - gain V), and the slope of that over V
SPEED, RISE, SLOPE = range(3)
#: rows of :func:`state_loop`; the answers are to V and omega, of Q and of both moments to V
ROWS = (
    "V", "delta", "Q", "M_half_space", "M_cylinder", "beta", "dQ_dV", "dQ_domega", "dM_half_space", "dM_cylinder",
)  # fmt: skip
V, DELTA, Q, M_HALF_SPACE, M_CYLINDER, BETA, DQ_DV, DQ_DOMEGA, DM_HALF_SPACE, DM_CYLINDER = range(len(ROWS))
#: which of force and torque are given
BOTH, TORQUE, FORCE = range(3)
#: a load this close to an extremum, relative, is at it
SNAP = 1e-15
_MAX_STEPS = 40
#: a step of Newton's iteration of this size in ln zeta, over the distance from an extremum, leaves its square
_SQUARED = 1e-8
#: below this |Q|/mu, zeta - eta starts from the slope at zeta
_SLIGHT = 1e-8


class Curve(NamedTuple):
    """Nodes of kappa (M - gain V) by rising speed: zeta, value, whether it is an extremum; gain over the own time."""

    zeta: Any
    rise: Any
    flat: Any
    gain: float


class Candidates(NamedTuple):
    """Steady states to be found.

    zeta : one each.  force, torque : along the motion at rest, with gains on V.  kappa, mu : one value, or one each.
    given : which of force and torque are; what is not given is found.
    """

    zeta: Any
    force: Any
    torque: Any
    force_gain: float
    torque_gain: float
    kappa: Any
    mu: Any
    given: int


@kernel(inline=True)
def _on_curve(z, gain, material):
    """(kappa V, kappa (M - gain V), its slope over ln zeta, its slope over kappa V) at zeta."""
    _, h, _, dh, m, dm, _, _ = at_contact(z, material)
    square = 1.0 + 2.0 * h / z  # 1/lam^2
    fall = (1.0 + h / z + dh) / square  # -d ln V/d ln zeta
    u = 0.5 / (z * np.sqrt(square))
    return u, u * (m - gain), u * (z * dm - fall * (m - gain)), m - gain - z * dm / fall


@kernel
def curve_loop(material, gain, zeta, out):
    """Rows of the curve at an array of zeta."""
    for n in range(zeta.size):
        out[SPEED, n], out[RISE, n], _, out[SLOPE, n] = _on_curve(zeta[n], gain, material)


@kernel
def _bracket(load, first, last, rise):
    """The node from ``first`` to ``last`` - 1 behind which the monotone ``rise`` meets the load."""
    rising = rise[last] > rise[first]
    while last - first > 1:
        middle = (first + last) // 2
        if (rise[middle] <= load) == rising:
            first = middle
        else:
            last = middle
    return first


@kernel
def _crossing(load, n, curve, material):
    """zeta between the nodes n and n + 1 where the curve meets the load: Newton's iteration in a closed bracket.

    Beside an extremum steps may end in rounding, not below the bound: the last is then as near as others, 4e-15 of the
    load, measured.
    """
    high, low = curve.zeta[n], curve.zeta[n + 1]
    if curve.flat[n + 1] and abs(load - curve.rise[n + 1]) <= SNAP * abs(load):
        return low
    part = (load - curve.rise[n]) / (curve.rise[n + 1] - curve.rise[n])
    top = 0.0
    if curve.flat[n]:  # beside an extremum the curve is a parabola
        part, top = np.sqrt(part), high
    elif curve.flat[n + 1]:
        part, top = 1.0 - np.sqrt(1.0 - part), low
    z = high * (low / high) ** part
    rising = curve.rise[n + 1] > curve.rise[n]
    for _ in range(_MAX_STEPS):
        _, value, slope, _ = _on_curve(z, curve.gain, material)
        if (value <= load) == rising:
            high = z
        else:
            low = z
        step = (load - value) / slope
        new = z * np.exp(step)
        if not low <= new <= high:
            new, step = np.sqrt(low * high), 1.0
        old, z = z, new
        if abs(step) <= _SQUARED * min(1.0, abs(old - top) / old):
            break
    return z


@kernel
def crossing_loop(material, curve, load, first, last, out, start, stop):
    """zeta where the curve meets each load between two of its nodes."""
    for n in range(start, stop):
        at = _bracket(load[n], first[n], last[n], curve.rise)
        out[n] = _crossing(load[n], at, curve, material)


@kernel
def length_loop(material, kappa_V, out, start, stop):
    """zeta of each kappa V > 0; returns a status."""
    worst = OK
    for n in range(start, stop):
        lam, status = contact_length(kappa_V[n], material)
        out[n] = 0.5 * lam / kappa_V[n]
        worst = max(worst, status)
    return worst


@kernel
def _stick(zeta, lam, part, material):
    """(eta, D = zeta - eta, F(zeta) - F(eta), status) where H(zeta) - H(eta) is this part of H(zeta), in [0, 1)."""
    root = np.sqrt(1.0 - part)
    if material.T_mean == 0.0:
        D = zeta * part / (1.0 + root)
        return zeta - D, D, D, OK
    _, h, dg, dh = generator_slopes(zeta, material)
    rise, status = part * zeta / (lam * lam), OK  # of H, over zeta
    if part > _SLIGHT:
        speed = 0.5 * lam / (zeta * root)
        guess = near_length(speed, material, 1.0 / np.sqrt(material.alpha))
        _, eta, _, _, _, status = contact_solution(guess, speed, material)
        D = zeta - eta
        if D > CLOSE * zeta:
            return eta, D, differences(zeta, eta, D, material)[0], status
    else:
        D = 0.5 * rise * zeta / (zeta + h + zeta * dh)
    eta = zeta - D
    rise_F, rise_H = differences(zeta, eta, D, material)
    _, h, dg, dh = generator_slopes(eta, material)
    more = 0.5 * (rise - rise_H) * zeta / (eta + h + eta * dh)
    return eta - more, D + more, rise_F + more * (1.0 + dg), status


@kernel(inline=True)
def _half(z, material):
    return 0.5, 0.0


@kernel(inline=True)
def _share(z, material):
    one, other, rise, other_rise = parts(z, material)
    total = one + other
    return one / total, z * (rise * other - other_rise * one) / (total * total)


#: (the half-space's share of M, its slope over ln zeta)
_half_space = by_record(1, (Tabulated, _half), (Pair, _share))


@kernel
def _traction(M, share, force, torque, given):
    """Q, for this share of the half-space in M; what is not given is found."""
    if given == BOTH:
        return share * torque - (1.0 - share) * force
    return torque - (1.0 - share) * M if given == TORQUE else share * M - force


@kernel
def _rolling(material, zeta, kappa, n, out):
    """The rows of column n that do not depend on the creep, M aside: (speed, M/V, share of the half-space, solved)."""
    g, h, dg, dh, m, dm, _, _ = at_contact(zeta, material)
    share, d_share = _half_space(zeta, material)
    square = 1.0 + 2.0 * h / zeta
    lam, fall = 1.0 / np.sqrt(square), (1.0 + h / zeta + dh) / square
    speed = 0.5 * lam / (zeta * kappa)
    slope = m - zeta * dm / fall
    turned = -d_share / fall * m  # of the share, times V
    out[V, n] = speed
    out[DM_HALF_SPACE, n], out[DM_CYLINDER, n] = share * slope + turned, (1.0 - share) * slope - turned
    return speed, m, share, (lam, zeta, g, h, dg, OK)


@kernel
def _answers(material, state, sign, solved, stuck, n, out):
    """The rows of column n for the creep, in partial slip; ``state`` holds |delta|."""
    _, _, beta, _, _ = stuck
    at_delta, to_delta = traction_slopes(state.creep, state, solved, stuck, material)
    out[DELTA, n], out[BETA, n] = sign * state.creep, beta
    out[DQ_DOMEGA, n] = to_delta / state.V
    out[DQ_DV, n] = sign * at_delta - to_delta / state.V * (1.0 + sign * state.creep)


@kernel
def _state(material, candidates, n, out):
    """Column n of ``state_loop``."""
    kappa = candidates.kappa[min(n, candidates.kappa.size - 1)]
    mu = candidates.mu[min(n, candidates.mu.size - 1)]
    zeta, given = candidates.zeta[n], candidates.given
    speed, m, share, solved = _rolling(material, zeta, kappa, n, out)
    force = candidates.force[n] + candidates.force_gain * speed
    torque = candidates.torque[n] + candidates.torque_gain * speed
    moment = force + torque if given == BOTH else speed * m
    traction = _traction(moment, share, force, torque, given)
    part = abs(traction) / mu
    out[Q, n], out[M_HALF_SPACE, n], out[M_CYLINDER, n] = traction, share * moment, (1.0 - share) * moment
    if not part < 1.0:
        out[DELTA, n], out[BETA, n], out[DQ_DV, n], out[DQ_DOMEGA, n] = np.nan, 0.0, 0.0, 0.0
        return OK
    eta, D, rise, status = _stick(zeta, solved[0], part, material)
    beta = 1.0 - D / zeta if D < CLOSE * zeta else eta / zeta
    state, sign = State(kappa, mu, speed, mu * speed * rise, False), -1.0 if traction < 0.0 else 1.0
    _answers(material, state, sign, solved, (eta, D, beta, part, OK), n, out)
    return status


@kernel
def state_loop(material, candidates, out, start, stop):
    """Rows of steady rolling; delta is NaN where friction does not suffice.  Returns a status."""
    worst = OK
    for n in range(start, stop):
        worst = max(worst, _state(material, candidates, n, out))
    return worst


@kernel
def _slipping(material, zeta, slip, kappa, mu, n, out):
    """Column n of ``slip_loop``."""
    speed, m, share, solved = _rolling(material, zeta, kappa, n, out)
    sign = -1.0 if slip < 0.0 else 1.0
    delta, star = abs(slip) / speed, mu * speed * (zeta + solved[2])
    out[M_HALF_SPACE, n], out[M_CYLINDER, n] = share * m * speed, (1.0 - share) * m * speed
    if delta >= star:
        out[DELTA, n], out[Q, n] = sign * delta, sign * mu
        out[BETA, n], out[DQ_DV, n], out[DQ_DOMEGA, n] = 0.0, 0.0, 0.0
        return OK
    stuck = stick(speed, delta, mu, solved, star, material)
    out[Q, n] = sign * mu * stuck[3]
    _answers(material, State(kappa, mu, speed, delta, False), sign, solved, stuck, n, out)
    return stuck[4]


@kernel
def slip_loop(material, zeta, slip, kappa, mu, out, start, stop):
    """Rows as of ``state_loop`` where omega - V is given, full slip included.  Returns a status."""
    worst = OK
    for n in range(start, stop):
        worst = max(worst, _slipping(material, zeta[n], slip[n], kappa, mu, n, out))
    return worst


@kernel
def law_loop(material, zeta, out):
    """Rows kappa V, m, the half-space's share of it, and F at an array of zeta."""
    for n in range(zeta.size):
        g, h, _, _, m, _, _, _ = at_contact(zeta[n], material)
        out[0, n] = 0.5 / (zeta[n] * np.sqrt(1.0 + 2.0 * h / zeta[n]))
        out[1, n], out[2, n], out[3, n] = m, _half_space(zeta[n], material)[0], zeta[n] + g
