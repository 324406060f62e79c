"""What one would write without the explicit law: an implicit integrator on (V, omega) with the law behind a call.

Two laws, chosen by number so that one compilation serves both: Brent-Dekker solves of the printed
equations in each right-hand side, and the tensor splines of the 3-D atlas, which is the plain
reading of the paper's design.  The integrator is as good as the package's (RODAS5P, regimes carried
as state, events located by repeated steps, dense output); the Jacobian is by differences.

Unknowns: full slip (V, |omega - V|); partial slip (ln |V|, delta/|V|).
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

import viscoroll as vr
from viscoroll.kernels.printed.law import (
    direct_contact_length,
    direct_delta_star,
    direct_moment,
    direct_stick,
    direct_traction,
)

from .jit import compiled
from .rodas5p import GAMMA, STAGES, A, C, dense, dense_terms
from .splines import at_2, at_3, basis, scratch, spline

DIRECT, ATLAS = 0, 1
_SHARE, _CREEP_SHARE = 0.15, 0.05
_MOST_STEPS, _MOST_SWITCHES, _LOCATE_CAP = 20_000, 50, 60
_NUDGE = 1e-7


class Atlas(NamedTuple):
    """Knots over (ln alpha, ln kappa V, u) and coefficients of kappa M, kappa delta_star/mu and Q/mu."""

    log_alpha: NDArray
    log_kappa_V: NDArray
    u: NDArray
    kappa_M: NDArray
    limit: NDArray
    share: NDArray


def atlas_of(nodes: tuple[int, int, int], alpha: tuple[float, float], kappa_V: tuple[float, float]) -> Atlas:
    """Splines of the law over (alpha, kappa V, s): equal ratios and, of s = 1 - (1 - u)^2, equal steps of u."""
    log_alpha, log_speed = (np.linspace(*np.log(ends), n) for ends, n in zip((alpha, kappa_V), nodes, strict=False))
    u = np.linspace(0.0, 1.0, nodes[2])
    scene, V = vr.Scene(np.exp(log_alpha)[:, None, None], 1.0, 1.0), np.exp(log_speed)[:, None]
    plane = vr.contact(scene, V, delta=0.0, fields=("M", "delta_star"))
    share = vr.contact(scene, V, delta=u * (2.0 - u) * plane.delta_star, fields="Q").Q
    share[..., -1] = 1.0
    axes = [log_alpha, log_speed, u]
    fits = [spline(values[..., 0], axes[:2])[1] for values in (plane.M, plane.delta_star)]
    knots, coefficients = spline(share, axes)
    return Atlas(*knots, *fits, coefficients)


def no_atlas() -> Atlas:
    """A place holder of the same type, for the direct law."""
    return Atlas(*(np.zeros(shape) for shape in (8, 8, 8, (1, 1), (1, 1), (1, 1, 1))))


class Law(NamedTuple):
    """What a right-hand side reads: DIRECT or ATLAS, (alpha, kappa, mu, gamma, j), splines, room for their bases."""

    which: int
    par: tuple[float, float, float, float, float]
    atlas: Atlas
    w: NDArray


@compiled
def atlas_law(alpha, kappa, mu, speed, delta, atlas, w):
    """(|Q|, |M|, delta_star) from the splines; beyond the table M goes on in proportion to V, the rest is held."""
    x = np.log(kappa * speed)
    i = basis(atlas.log_alpha, np.log(alpha), w[0])
    k = basis(atlas.log_kappa_V, x, w[1])
    M = at_2(i, w[0], k, w[1], atlas.kappa_M) / kappa
    low = atlas.log_kappa_V[0]
    if x < low:
        M *= np.exp(x - low)
    limit = at_2(i, w[0], k, w[1], atlas.limit) * mu / kappa
    if delta >= limit:
        return mu, M, limit
    s = delta / limit
    n = basis(atlas.u, s / (1.0 + np.sqrt(1.0 - s)), w[2])
    return mu * at_3(i, w[0], k, w[1], n, w[2], atlas.share), M, limit


@compiled
def direct_law(alpha, kappa, mu, speed, delta):
    """(|Q|, |M|, delta_star) by two Brent-Dekker solves of the printed equations."""
    lam, zeta, epsilon, _ = direct_contact_length(kappa * speed, alpha)
    M = direct_moment(kappa, lam, epsilon, zeta, alpha)
    limit = direct_delta_star(kappa, mu, lam, epsilon)
    if delta >= limit:
        return mu, M, limit
    beta, _ = direct_stick(delta, kappa, mu, lam, epsilon, zeta, alpha)
    return direct_traction(beta, delta, kappa, mu, lam, epsilon, zeta), M, limit


@compiled
def rates(law, sticking, u0, u1, sigma):
    """(u0', u1', event function, stick limit of |delta|) of the regime."""
    alpha, kappa, mu, gamma, j = law.par
    speed = np.exp(u0) if sticking else abs(u0)
    delta = u1 * speed if sticking else np.inf
    if speed == 0.0:
        Q, M, limit = mu, 0.0, 0.0
    elif law.which == DIRECT:
        Q, M, limit = direct_law(alpha, kappa, mu, speed, abs(delta))
    else:
        Q, M, limit = atlas_law(alpha, kappa, mu, speed, abs(delta), law.atlas, law.w)
    if not sticking:
        M *= np.sign(u0)
        dV = gamma * (sigma * mu - 0.5 * M)
        return dV, sigma * (-gamma / j * (sigma * mu + 0.5 * M) - dV), u1 - limit * speed, limit
    Q *= np.sign(delta)
    rate = gamma * (Q - 0.5 * M) / speed
    turn = -gamma * (Q + 0.5 * M) / (j * speed)
    return rate, (turn - (1.0 + delta) * rate) / speed - u1 * rate, limit - abs(delta), limit


@compiled
def difference_jacobian(law, sticking, u, sigma):
    """(J00, J01, J10, J11) by forward differences."""
    f0, f1, _, limit = rates(law, sticking, u[0], u[1], sigma)
    if sticking:
        d0, d1 = _NUDGE, _NUDGE * (abs(u[1]) + 0.01 * limit * np.exp(-u[0]))
    else:
        d0, d1 = _NUDGE * (abs(u[0]) + abs(u[1])), _NUDGE * abs(u[1])
    a0, a1, _, _ = rates(law, sticking, u[0] + d0, u[1], sigma)
    if not sticking:
        return (a0 - f0) / d0, 0.0, (a1 - f1) / d0, 0.0
    b0, b1, _, _ = rates(law, sticking, u[0], u[1] + d1, sigma)
    return (a0 - f0) / d0, (b0 - f0) / d1, (a1 - f1) / d0, (b1 - f1) / d1


@compiled
def step(law, sticking, u, h, J, sigma, K, new):
    """One step of RODAS5P; the last stage in K is the error estimate."""
    diagonal = 1.0 / (h * GAMMA)
    a, d = diagonal - J[0], diagonal - J[3]
    inverse = 1.0 / (a * d - J[1] * J[2])
    for i in range(STAGES):
        s0, s1, r0, r1 = u[0], u[1], 0.0, 0.0
        for n in range(i):
            s0 += A[i, n] * K[n, 0]
            s1 += A[i, n] * K[n, 1]
            r0 += C[i, n] / h * K[n, 0]
            r1 += C[i, n] / h * K[n, 1]
        f0, f1, _, _ = rates(law, sticking, s0, s1, sigma)
        r0 += f0
        r1 += f1
        K[i, 0], K[i, 1] = (d * r0 + J[1] * r1) * inverse, (a * r1 + J[2] * r0) * inverse
    for m in range(2):
        new[m] = u[m] + K[STAGES - 1, m]
        for n in range(STAGES - 1):
            new[m] += A[STAGES - 1, n] * K[n, m]


@compiled
def error_norm(sticking, u, K, limit, rtol, sigma, j):
    """Largest local error over its weight; <= 1 is acceptable."""
    if sticking:
        creep = abs(u[1]) + 1e-3 * limit * np.exp(-u[0])
        return max(abs(K[7, 0]), _CREEP_SHARE * abs(K[7, 1]) / creep) / (_SHARE * rtol)
    omega = u[0] + sigma * u[1]
    largest = max(abs(u[0]), abs(omega))
    scale = max(1e-3 * largest, min(largest, abs(u[0] + j * omega) / (1.0 + j)))
    return max(abs(K[7, 0]), abs(K[7, 1])) / (scale * _SHARE * rtol)


@compiled
def secant(low, high, at_low, at_high):
    """Where the straight line through both ends is zero."""
    return low + (high - low) * at_low / (at_low - at_high)


@compiled
def narrowed(low, high, at_low, at_high, side, middle, value):
    """(low, high, at_low, at_high, side) with ``middle`` as an end: low if ``side`` is +1, high if -1; 0 at first."""
    if value > 0.0:
        return middle, high, value, at_high * (0.5 if side == 1 else 1.0), 1
    return low, middle, at_low * (0.5 if side == -1 else 1.0), value, -1


@compiled
def locate(law, sticking, u, h, J, sigma, K, new):
    """Length of the step whose end lies on the event (Illinois); fills ``new``."""
    low, high, side = 0.0, h, 0
    at_low = max(rates(law, sticking, u[0], u[1], sigma)[2], 1e-300)
    at_high = rates(law, sticking, new[0], new[1], sigma)[2]
    for _ in range(_LOCATE_CAP):
        if high - low <= 4e-16 * high or at_high == 0.0:
            break
        middle = secant(low, high, at_low, at_high)
        if not (low < middle < high):
            middle = 0.5 * (low + high)
        step(law, sticking, u, middle, J, sigma, K, new)
        value = rates(law, sticking, new[0], new[1], sigma)[2]
        low, high, at_low, at_high, side = narrowed(low, high, at_low, at_high, side, middle, value)
    step(law, sticking, u, high, J, sigma, K, new)
    return high


@compiled
def speeds(sticking, direction, sigma, u0, u1):
    """(V, omega)."""
    if not sticking:
        return u0, u0 + sigma * u1
    V = np.exp(u0)
    return direction * V, direction * V * (1.0 + u1 * V)


@compiled
def unknowns(sticking, V, omega, u):
    """What the regime is integrated in, into u."""
    u[0], u[1] = V, abs(omega - V)
    if sticking:
        u[0], u[1] = np.log(abs(V)), (omega - V) / V / abs(V)


@compiled
def first_length(sticking, u, J, rtol, par):
    """Length of the first step in a regime."""
    if not sticking:
        _, _, mu, gamma, j = par
        return 0.5 * u[1] / (gamma * mu * (1.0 + 1.0 / j))
    return rtol**0.2 / (abs(J[3]) + abs(J[0]) + 1e-300)


@compiled
def roll(law, V0, omega0, t, rtol, V, omega):
    """One motion into V, omega (times,), which keep what they held where the step limit came first."""
    K, new, u, terms = np.zeros((STAGES, 4)), np.empty(4), np.empty(4), np.zeros((6, 4))
    new[:], u[:] = 0.0, 0.0
    sigma = 1.0 if omega0 >= V0 else -1.0
    direction = 1.0 if V0 >= 0.0 else -1.0
    u[0], u[1] = V0, abs(omega0 - V0)
    sticking = V0 != 0.0 and rates(law, False, u[0], u[1], sigma)[2] < 0.0
    unknowns(sticking, V0, omega0, u)
    now, at, switches, rejected = 0.0, 0, 0, 0
    J = difference_jacobian(law, sticking, u, sigma)
    h = first_length(sticking, u, J, rtol, law.par)
    for _ in range(_MOST_STEPS):
        if at == t.size or switches > _MOST_SWITCHES or rejected > 50:
            break
        last = h >= t[t.size - 1] - now
        length = t[t.size - 1] - now if last else h
        step(law, sticking, u, length, J, sigma, K, new)
        _, _, value, limit = rates(law, sticking, new[0], new[1], sigma)
        error = error_norm(sticking, new, K, limit, rtol, sigma, law.par[4])
        if not error <= 1.0:
            rejected += 1
            h = length * (max(0.1, 0.9 * error**-0.2) if error < 1e300 else 0.1)
            continue
        rejected = 0
        h = length * min(6.0, 0.9 * (error + 1e-30) ** -0.2)
        event = value < 0.0
        if event:
            length, last = locate(law, sticking, u, length, J, sigma, K, new), False
        dense_terms(K, terms)
        while at < t.size and (last or t[at] < now + length):
            theta = min((t[at] - now) / length, 1.0)
            y0, y1 = dense(theta, u, new, terms, 0), dense(theta, u, new, terms, 1)
            V[at], omega[at] = speeds(sticking, direction, sigma, y0, y1)
            at += 1
        now += length
        u[:] = new
        if event:
            switches += 1
            speed, turn = speeds(sticking, direction, sigma, u[0], u[1])
            direction, sigma = np.sign(speed), np.sign(turn - speed)
            sticking = not sticking
            unknowns(sticking, speed, turn, u)
        J = difference_jacobian(law, sticking, u, sigma)
        if event:
            h = first_length(sticking, u, J, rtol, law.par)


@compiled
def roll_all(which, parameters, V0, omega0, t, rtol, atlas, w, V, omega):
    """All motions."""
    for i in range(V0.size):
        p = parameters[i]
        law = Law(which, (p[0], p[1], p[2], p[3], p[4]), atlas, w)
        roll(law, V0[i], omega0[i], t, rtol, V[i], omega[i])


def run(which: int, problem: Any, rtol: float, atlas: Atlas) -> tuple[NDArray, NDArray]:
    """V, omega of all motions of a problem."""
    V, omega = np.full((2, problem.V0.size, problem.t.size), np.nan)
    parameters = np.ascontiguousarray(np.array(problem.parameters()).T)
    roll_all(which, parameters, problem.V0, problem.omega0, problem.t, rtol, atlas, scratch(), V, omega)
    return V, omega
