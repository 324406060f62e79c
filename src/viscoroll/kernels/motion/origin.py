"""What follows V = omega = 0: the cylinder stays, rolls off sticking, or slides off.

Rolling off in the direction where V' > 0, d is that at which the right side of the equation of d vanishes
(:mod:`rates`) in the limit V -> 0, where L = press = 1:

    2 kappa (omega' - V')/mu = d V'      Q = mu sign(d) (2 |d| - d^2)

(of a cover with L d + 2 kappa delta_0/mu in place of d on the right).

Its left side less its right one falls with d where mu <= 2 kappa, and for |d| < 1 there is a root or slip is full from
the start: one way on.  Where mu > 2 kappa it falls from d = -2 kappa/mu on, where omega' = 0, and a force that holds
nearly what friction can leaves two ways.
"""

from __future__ import annotations

import numpy as np

from ..compile.by_reference import by_value
from ..compile.jit import kernel
from ..rows.cover import is_cover
from ..rows.evaluate import limits_at_rest
from .load import brakes, constant, load_at, piece_end
from .rates import inertia_at
from .records import Frame, Load

STAYS, STICKS, SLIDES, EITHER = range(4)
_HALVINGS, _ROUNDING = 200, 1e-16
#: share of a piece of the drive behind which it is looked at where it begins with what moves nothing
_SOON = 1e-6
#: over what holds the cylinder, what rounding leaves of what it takes more to move it
_BARELY = 4e-15
#: parts of a piece in each of which what holds the cylinder is looked at
_PARTS = 64
#: force and torque that move nothing: speeds under them would leave the range in which panels set out
_FAINT = 1e-75


@kernel(inline=True)
def _pull(d, load, scene):
    """(Left less right side of the equation of d, its slope, V') at V = 0."""
    Q, Q_d = scene.mu * d * (2.0 - abs(d)), 2.0 * scene.mu * (1.0 - abs(d))
    V_rate = load.per_V * (Q + load.force) + load.V_rate
    omega_rate = load.per_omega * (load.torque - Q) + load.omega_rate
    L, free = limits_at_rest(scene.kappa, by_value(scene.law))
    per = 2.0 * scene.kappa / scene.mu / L
    tilt = d + free * per if is_cover(by_value(scene.law).cover_rows) else d
    slope = -(load.per_omega + load.per_V) * Q_d * per - V_rate - tilt * load.per_V * Q_d
    return (omega_rate - V_rate) * per - tilt * V_rate, slope, V_rate


@kernel(inline=True)
def _turning(scene):
    """d at which omega stays 0 as V grows from 0; in partial slip, above -1, only where mu > 2 kappa."""
    law = by_value(scene.law)
    if law.cover_rows is None:
        return -2.0 * scene.kappa / scene.mu
    L, free = limits_at_rest(scene.kappa, law)
    return -2.0 * scene.kappa / scene.mu / L * (1.0 + free)


@kernel
def _spin_off(load, scene):
    """Which way omega goes against a brake as V grows from 0 in partial slip.

    Parameters
    ----------
    load : Load
        At V = 0, with a brake.
    scene : Scene
        Of the motion.

    Returns
    -------
    (float, bool)
        The sign of omega, and whether the brake holds it at 0 instead: so it does where mu > 2 kappa and the traction
        at omega = 0 leaves less torque than the brake can take.
    """
    turning, load = _turning(scene), _burdened(load, scene)
    if turning <= -1.0:
        return 1.0, False
    free = load.torque - scene.mu * turning * (2.0 + turning)
    return np.sign(free), abs(free) <= load.brake


@kernel
def _under_brake(load, spin):
    """The load with the torque of the brake at this sign of omega."""
    force, torque, V_rate, omega_rate, brake, per_V, per_omega, gains = load
    return Load(force, torque - spin * brake, V_rate, omega_rate, brake, per_V, per_omega, gains)


@kernel
def _burdened(load, scene):
    """The load that has the same V' and omega' follow from Q at V = 0 without the added mass."""
    force, torque, V_rate, omega_rate, brake, per_V, per_omega, gains = load
    half = 0.5 * inertia_at(0.0, scene)[0]
    light = 1.0 / (1.0 + half * per_V)
    share = 1.0 + half * light * per_V
    torque = (torque - half * (light * per_V * force + V_rate)) / share
    return Load(force, torque, V_rate, omega_rate, brake, per_V * light, per_omega * share, gains)


@kernel(inline=True)
def _crest(load, scene):
    """Where :func:`_pull` has its local maximum over d < 0, of which it is a polynomial of degree 3.

    With Q = mu (2 d + d^2), k = mu L/(2 kappa) and W = per_omega + (1 + delta_0) per_V the terms with d are

        -[2 mu W/k + C] d - mu [W/k + 2 per_V] d^2 - mu per_V d^3

    where C = per_V f + V_rate, so that of both zeros of the slope the right one is the maximum.  Of a half-space at
    rest L = 1 and delta_0 = 0.

    Parameters
    ----------
    load : Load
        At V = 0, without brake and added mass.
    scene : Scene
        Of the motion.

    Returns
    -------
    float
        d there; -inf where the polynomial falls for all d.
    """
    L, free = limits_at_rest(scene.kappa, by_value(scene.law))
    moved = (load.per_omega + load.per_V * (1.0 + free)) * 2.0 * scene.kappa / L
    first, second = -2.0 * moved - load.per_V * load.force - load.V_rate, -moved - 2.0 * scene.mu * load.per_V
    # the larger root of first + 2 second d - 3 mu per_V d^2, with second < 0
    under = second * second + 3.0 * scene.mu * load.per_V * first
    return first / (np.sqrt(under) - second) if under > 0.0 else -np.inf


@kernel
def departing(load, spin, scene):
    """(Whether the cylinder may roll off sticking with V > 0, d then), against a brake where ``spin`` is 1."""
    load, low, high = _burdened(_under_brake(load, spin), scene), -1.0, 1.0
    turning = _turning(scene)  # from there on the left less the right side falls
    if turning > -1.0 and load.per_omega == 0.0 and load.omega_rate == 0.0:
        return _pull(turning, load, scene)[2] > 0.0, turning
    if turning > -1.0 and _pull(turning, load, scene)[0] > 0.0:
        low = turning
    elif turning > -1.0:  # before it, it may rise first
        low, high = min(max(low, _crest(load, scene)), turning), turning
    if _pull(low, load, scene)[0] <= 0.0 or _pull(high, load, scene)[0] >= 0.0:
        return False, 0.0
    d, V_rate = 0.5 * (low + high), 0.0
    for _ in range(_HALVINGS):  # Newton's iteration, within a bracket
        pull, slope, V_rate = _pull(d, load, scene)
        low, high = (d, high) if pull > 0.0 else (low, d)
        then = d - pull / slope
        if not low < then < high:
            then = 0.5 * (low + high)
        if abs(then - d) <= _ROUNDING * abs(d):
            break
        d = then
    return V_rate > 0.0, d


@kernel
def holding(load, mu):
    """How much more it would take to move the cylinder from V = omega = 0; negative where it moves.

    A traction within +-mu must leave V as it is, and omega too, which a brake may help with.
    """
    if load.V_rate != 0.0 or load.omega_rate != 0.0:
        return -1.0
    if load.per_V == 0.0:
        return mu + load.brake - abs(load.torque)
    if load.per_omega == 0.0:
        return mu - abs(load.force)
    pull = abs(load.force + load.torque)
    return min(mu - abs(load.force), load.brake - (pull if pull > _FAINT else 0.0))


@kernel
def _moves_at(tau, piece, frame, case):
    """``holding`` at a time."""
    return holding(load_at(tau, piece, frame, case), case.scene.mu)


@kernel
def leaving_time(tau, piece, case):
    """When the drive first moves a cylinder at rest, up to the end of the piece."""
    frame, end = Frame(False, 1.0, 1.0, 0.0, False), piece_end(piece, case)
    if constant(piece, case.drive.pieces):
        return end if _moves_at(tau, piece, frame, case) >= 0.0 else tau
    low = tau
    for n in range(1, _PARTS + 1):
        high = tau + (end - tau) * n / _PARTS
        if _moves_at(high, piece, frame, case) < 0.0:
            while True:
                middle = 0.5 * (low + high)
                if not low < middle < high:
                    return high
                if _moves_at(middle, piece, frame, case) < 0.0:
                    high = middle
                else:
                    low = middle
        low = high
    return end


@kernel
def depart(tau, piece, case):
    """(STAYS, STICKS, SLIDES or EITHER; frame; d) from V = omega = 0 on."""
    scene = case.scene
    still = Frame(False, 1.0, 1.0, 0.0, False)
    when = tau
    load = load_at(tau, piece, still, case)
    barely = _BARELY * (scene.mu + load.brake)
    if holding(load, scene.mu) >= -barely and not constant(piece, case.drive.pieces):
        # what begins to move the cylinder shows a little later
        when = tau + _SOON * (piece_end(piece, case) - tau)
        load = load_at(when, piece, still, case)
    braked = brakes(piece, case.drive.pieces)
    if holding(load, scene.mu) >= 0.0:
        return STAYS, still, 0.0
    kind, way, beginning = STAYS, still, 0.0
    for direction in (1.0, -1.0):
        frame = Frame(False, direction, 1.0, 0.0, False)
        load = load_at(when, piece, frame, case)
        spin, locked = _spin_off(load, scene) if braked else (0.0, False)
        if locked:
            frame, spin = Frame(False, direction, -1.0, 0.0, True), 0.0
            load = load_at(when, piece, frame, case)
        sticks, d = departing(load, spin, scene)
        if sticks and kind == STICKS:
            return EITHER, still, 0.0
        if sticks:
            # d is that of now: the limit that the motion leaves from
            kind, beginning = STICKS, departing(load_at(tau, piece, frame, case), spin, scene)[1]
            way = Frame(False, direction, 1.0 if d >= 0.0 else -1.0, spin, locked)
            if scene.mu <= 2.0 * scene.kappa:
                return kind, way, beginning
    slides = _slide_off(when, piece, braked, 0.0 if kind == STAYS else 0.5 * scene.mu / scene.kappa, case)
    if kind == STAYS:
        return slides
    return (EITHER, still, 0.0) if slides[0] == SLIDES else (kind, way, beginning)


@kernel
def _slide_off(when, piece, braked, band, case):
    """Full slip out of rest, of the sign that lasts: with omega - V beyond this share of V."""
    scene = case.scene
    L, free_creep = limits_at_rest(scene.kappa, by_value(scene.law))
    load = load_at(when, piece, Frame(True, 1.0, 1.0, 0.0, False), case)
    for sigma in (1.0, -1.0):
        Q = sigma * scene.mu
        V_rate = load.per_V * (Q + load.force) + load.V_rate
        free = load.torque - Q
        spin = np.sign(free) if braked and abs(free) > load.brake else 0.0
        locked = braked and spin == 0.0
        omega_rate = 0.0 if locked else load.per_omega * (free - spin * load.brake) + load.omega_rate
        if sigma * (omega_rate - V_rate * (1.0 + free_creep)) > band * L * abs(V_rate):
            direction = 1.0 if V_rate >= 0.0 else -1.0
            return SLIDES, Frame(True, direction, direction * sigma, direction * spin, locked), 0.0
    return STAYS, Frame(False, 1.0, 1.0, 0.0, False), 0.0
