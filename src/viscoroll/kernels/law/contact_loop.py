"""The contact law over arrays of states: signs, limits, and only the rows asked for."""

from __future__ import annotations

import numpy as np

from ..bessel.ratios import small_k_over_z
from ..compile.jit import kernel
from . import lockstep
from .length import OK, contact_solution, near_length
from .material import at_contact, generator_slopes, moment_of
from .standard import standard
from .slopes import slope_ratio, slope_ratio_rise
from .stick import CLOSE, slight, stick_from_root, stick_solution

#: Order of the rows of the kernel's output.
ROWS = (
    "lam", "zeta", "epsilon", "delta_star", "delta", "full_slip", "beta", "Q", "M",
    "dQ_dV", "dQ_ddelta", "dQ_domega", "dM_dV",
)  # fmt: skip
LAM, ZETA, EPSILON, DELTA_STAR, DELTA, FULL_SLIP, BETA, Q, M, DQ_DV, DQ_DDELTA, DQ_DOMEGA, DM_DV = range(len(ROWS))

#: above this zeta, g <= 1/2 is below rounding beside zeta and the law is Carter's
FAR = 1e17
#: below this zeta, products of r and k underflow, and the law is its limit at high speed to rounding
NEAR = 1e-140
#: below this s = |delta|/delta_star, Q is linear in s to rounding, while zeta - eta may underflow
_LINEAR = 1e-17
#: in place of (eta, g and h there, whether it is known) for ``stick``: eta is to be solved for
UNSOLVED = (0.0, 0.0, 0.0, False)


@kernel
def signed_slip(V, creep, creep_is_omega):
    """(omega - V, sign of the slip, direction of travel); V = 0 counts as V -> 0+."""
    direction = -1.0 if V < 0.0 else 1.0
    slip = creep - V if creep_is_omega else creep * V
    if creep_is_omega:
        sign = np.sign(slip)
    else:
        sign = np.sign(creep) * direction
    return slip, sign, direction


@kernel
def creep_ratio(V, creep, slip, creep_is_omega):
    """delta of Eq. (5); infinite when V = 0 < |omega|, 0 at rest."""
    if not creep_is_omega:
        return creep
    if V != 0.0:
        return slip / V
    return 0.0 if slip == 0.0 else np.copysign(np.inf, slip)


@kernel
def stick(speed, delta, mu, zeta, lam, g, h, dg, delta_star, root, material):
    """(eta, zeta - eta, beta, |Q|/mu, status) of partial slip at |V| and |delta|; Eqs. (10), (15)."""
    s = delta / delta_star
    if material.c == 0.0 or not NEAR <= zeta <= FAR:
        return zeta * (1.0 - s), zeta * s, 1.0 - s, s * (2.0 - s), OK
    if s < _LINEAR:
        _, _, dg, dh = generator_slopes(zeta, material)
        share = s * (1.0 + g / zeta) / (1.0 + dg)  # (zeta - eta)/zeta
        return zeta, share * zeta, 1.0, share * 2.0 * lam * lam * (1.0 + (h + zeta * dh) / zeta), OK
    d = delta / (mu * speed)
    if root[3]:
        eta, D, dH = stick_from_root(root[0], root[1], root[2], zeta, g, h, d, material)
        status = OK
    else:
        eta, D, dH, status = stick_solution(zeta, g, h, dg, d, material)
    return eta, D, eta / zeta, min(dH * (lam / zeta) * lam, 1.0), status


@kernel
def traction_slopes(speed, delta, kappa, mu, zeta, eta, D, beta, share, lam, material):
    """(d|Q|/d|V| at fixed delta, d|Q|/d|delta|) in partial slip; share = |Q|/mu."""
    if material.c == 0.0 or not NEAR <= zeta <= FAR:
        return 0.0, 4.0 * kappa * beta / lam
    # A = H'/F' is the slope of H over F; H and A stand here over zeta^2 and zeta
    A, A_eta = slope_ratio(zeta, material) / zeta, slope_ratio(eta, material) / zeta
    H = 1.0 / (lam * lam)
    d = delta / (mu * speed * zeta)
    fall = A - A_eta if D > CLOSE * zeta else slope_ratio_rise(zeta, D, material) / zeta
    bracket = -share * H + H * fall / A + 0.5 * A_eta * d
    dQ_dV = -mu * 2.0 * lam * lam * bracket / speed
    return dQ_dV, 2.0 * kappa * lam * A_eta


@kernel
def contact_state(material, kappa, mu, V, creep, creep_is_omega, need, out):
    """All rows of one state into ``out``; ``need`` = (shift, stick, moment, slopes)."""
    kappa_V = kappa * abs(V)
    solved = contact_solution(near_length(kappa_V, material, 1.0 / np.sqrt(material.alpha)), kappa_V, material)
    return contact_state_at(solved, UNSOLVED, material, kappa, mu, V, creep, creep_is_omega, need, out)


@kernel(inline=True)
def contact_state_at(solved, root, material, kappa, mu, V, creep, creep_is_omega, need, out):
    """``contact_state`` from the solution of Eq. (6), and for ``stick`` perhaps that of Eq. (10)."""
    need_shift, need_stick, need_moment, need_slopes = need
    speed = abs(V)
    lam, zeta, g, h, dg, status = solved
    out[LAM], out[ZETA] = lam, zeta
    if need_moment:
        _moment(V, kappa, zeta, lam, g, h, material, need_slopes, out)
    if not need_shift:
        return status
    epsilon = g / zeta if zeta >= NEAR else h * small_k_over_z(zeta)
    delta_star = 0.5 * mu * lam * (1.0 + epsilon) / kappa
    slip, sign, direction = signed_slip(V, creep, creep_is_omega)
    delta = creep_ratio(V, creep, slip, creep_is_omega)
    if V == 0.0 and creep_is_omega:
        full_slip = slip != 0.0
    else:
        full_slip = abs(delta) >= delta_star
    out[EPSILON], out[DELTA_STAR], out[DELTA], out[FULL_SLIP] = epsilon, delta_star, delta, 1.0 if full_slip else 0.0
    if not need_stick:
        return status
    if full_slip:
        out[BETA], out[Q] = 0.0, mu * sign
        out[DQ_DV] = out[DQ_DDELTA] = out[DQ_DOMEGA] = 0.0
        return status
    eta, D, beta, share, stick_status = stick(speed, abs(delta), mu, zeta, lam, g, h, dg, delta_star, root, material)
    out[BETA] = beta
    out[Q] = sign * mu * share
    if need_slopes:
        dQ_dV, dQ_ddelta = traction_slopes(speed, abs(delta), kappa, mu, zeta, eta, D, beta, share, lam, material)
        out[DQ_DV] = np.sign(delta) * dQ_dV
        out[DQ_DDELTA] = direction * dQ_ddelta
        out[DQ_DOMEGA] = dQ_ddelta / speed
        if creep_is_omega:
            out[DQ_DV] -= dQ_ddelta * (1.0 + delta) / speed
    return max(status, stick_status)


@kernel(inline=True)
def _moment(V, kappa, zeta, lam, g, h, material, need_slopes, out):
    """M = V m(zeta) and dM/dV = m - 2 (H/H') m' of Eqs. (16), (18)."""
    alpha, c = material.alpha, material.c
    if zeta > FAR:
        out[M], out[DM_DV] = c * V, c
        return
    if zeta < NEAR:  # V zeta = lam/(2 kappa), lam^2 = 1/alpha, i2 = (alpha zeta)^2/8
        out[M] = np.copysign(0.5 * lam / kappa, V) * (0.125 * c * alpha * zeta + h * small_k_over_z(zeta))
        out[DM_DV] = 0.0
    elif not need_slopes:
        out[M] = V * moment_of(zeta, lam, g, h, material)
    else:
        _, h, _, dh, _, _, m, dm = at_contact(zeta, material)
        out[M] = V * m
        half_slope = 1.0 + (h + zeta * dh) / zeta
        out[DM_DV] = m - zeta * dm / (lam * lam * half_slope)


@kernel
def _slipping(first, count, mu, V, creep, creep_is_omega, block, some):
    """Collects states in partial slip that is not slight, with y = F(zeta) - d; returns how many."""
    found = 0
    for i in range(count):
        n = first + i
        speed, zeta, g = abs(V[min(n, V.size - 1)]), block[lockstep.ZETA + i], block[lockstep.G + i]
        slip, _, _ = signed_slip(V[min(n, V.size - 1)], creep[min(n, creep.size - 1)], creep_is_omega)
        delta = creep_ratio(V[min(n, V.size - 1)], creep[min(n, creep.size - 1)], slip, creep_is_omega)
        d = abs(delta) / (mu[min(n, mu.size - 1)] * speed)
        y = (zeta + g) - d
        if y > 0.0 and not slight(d, zeta, g) and block[lockstep.ALPHA + i] > 1.0 and NEAR <= zeta <= FAR:
            block[lockstep.Y + i], some[found] = y, i
            found += 1
    return found


@kernel(allocates=True)
def contact_loop(alpha, kappa, mu, V, creep, creep_is_omega, need, rows, out, start, stop):
    """States start..stop; inputs hold one value or one a state; ``rows`` picks the output."""
    state = np.empty(len(ROWS))
    block, place = np.empty(lockstep.SIZE), np.empty(lockstep.PLACES, np.int64)
    some = np.empty(lockstep.TOGETHER, np.int64)
    worst = OK
    for first in range(start, stop, lockstep.TOGETHER):
        count = min(stop - first, lockstep.TOGETHER)
        for i in range(count):
            n = first + i
            block[lockstep.ALPHA + i] = alpha[min(n, alpha.size - 1)]
            block[lockstep.KAPPA_V + i] = kappa[min(n, kappa.size - 1)] * abs(V[min(n, V.size - 1)])
            block[lockstep.FOUND + i] = 0.0
        lockstep.solve_lengths(count, block, place)
        if need[1]:
            slipping = _slipping(first, count, mu, V, creep, creep_is_omega, block, some)
            lockstep.solve_roots(slipping, some, block, place)
        for i in range(count):
            n = first + i
            solved = (
                block[lockstep.LAM + i], block[lockstep.ZETA + i], block[lockstep.G + i], block[lockstep.H + i],
                block[lockstep.DG + i], int(block[lockstep.STATUS + i]),
            )  # fmt: skip
            found = block[lockstep.FOUND + i] == 1.0
            root = block[lockstep.ETA + i], block[lockstep.G_ETA + i], block[lockstep.H_ETA + i], found
            material = standard(alpha[min(n, alpha.size - 1)])
            status = contact_state_at(
                solved, root, material, kappa[min(n, kappa.size - 1)], mu[min(n, mu.size - 1)], V[min(n, V.size - 1)],
                creep[min(n, creep.size - 1)], creep_is_omega, need, state,
            )  # fmt: skip
            worst = max(worst, status)
            for m in range(rows.size):
                out[m, n] = state[rows[m]]
    return worst
