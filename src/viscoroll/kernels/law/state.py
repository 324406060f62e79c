"""One state of the contact: signs, limits, and only the rows asked for."""

from __future__ import annotations

import numpy as np

from ..compile.choice import by_record
from ..compile.jit import kernel
from ..material.each import FilledPair
from ..material.functions import at_contact, fast_limit, generator_slopes, moment_of
from ..material.pair import Pair, fast_parts, parts
from .length import OK, contact_solution, near_length
from .slopes import slope_ratio, slope_ratio_rise
from .states import (
    BETA,
    DELTA,
    DELTA_STAR,
    DM_CYLINDER_DV,
    DM_DV,
    DM_HALF_SPACE_DV,
    DQ_DDELTA,
    DQ_DOMEGA,
    DQ_DV,
    EPSILON,
    FULL_SLIP,
    LAM,
    M_CYLINDER,
    M_HALF_SPACE,
    ZETA,
    M,
    Q,
    creep_ratio,
    signed_slip,
)  # fmt: skip
from .stick import CLOSE, stick_from_root, stick_solution

#: above this zeta, g <= 1/2 is below rounding beside zeta and the law is Carter's
FAR = 1e17
#: below this zeta, products of r and k underflow, and the law is its limit at high speed to rounding
NEAR = 1e-140
#: below this s = |delta|/delta_star, Q is linear in s to rounding, while zeta - eta may underflow
_LINEAR = 1e-17
#: in place of ``at_contact``, where its slopes are not asked for or of no use
_NOWHERE = (0.0,) * 8
#: in place of (eta, g and h there, whether it is known) for ``stick``: eta is to be solved for
UNSOLVED = (0.0, 0.0, 0.0, False)


@kernel
def stick(speed, delta, mu, solved, delta_star, root, material):
    """(eta, zeta - eta, beta, |Q|/mu, status) of partial slip at |V| and |delta|; Eqs. (10), (15).

    ``solved``: as of ``contact_solution``.
    """
    lam, zeta, g, h, dg, _ = solved
    s = delta / delta_star
    if material.T_mean == 0.0 or not NEAR <= zeta <= FAR:
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
def traction_slopes(delta, state, solved, stuck, material):
    """(d|Q|/d|V| at fixed delta, d|Q|/d|delta|) in partial slip, from what ``stick`` found."""
    return _traction_slopes(delta, state, solved, stuck, slope_ratio(solved[1], material), material)


@kernel(inline=True)
def _traction_slopes(delta, state, solved, stuck, ratio, material):
    """``traction_slopes`` with ``slope_ratio`` at zeta."""
    lam, zeta, _, _, _, _ = solved
    eta, D, beta, share, _ = stuck
    speed = abs(state.V)
    if material.T_mean == 0.0 or not NEAR <= zeta <= FAR:
        return 0.0, 4.0 * state.kappa * beta / lam
    # A = H'/F' is the slope of H over F; H and A stand here over zeta^2 and zeta
    A, A_eta = ratio / zeta, slope_ratio(eta, material) / zeta
    H = 1.0 / (lam * lam)
    d = delta / (state.mu * speed * zeta)
    fall = A - A_eta if D > CLOSE * zeta else slope_ratio_rise(zeta, D, material) / zeta
    bracket = -share * H + H * fall / A + 0.5 * A_eta * d
    dQ_dV = -state.mu * 2.0 * lam * lam * bracket / speed
    return dQ_dV, 2.0 * state.kappa * lam * A_eta


@kernel
def contact_state(material, state, need, out):
    """All rows of one state into ``out``."""
    kappa_V = state.kappa * abs(state.V)
    solved = contact_solution(near_length(kappa_V, material, 1.0 / np.sqrt(material.alpha)), kappa_V, material)
    return contact_state_at(solved, UNSOLVED, material, state, need, out)


@kernel(inline=True)
def contact_state_at(solved, root, material, state, need, out):
    """``contact_state`` from the solution of Eq. (6), and for ``stick`` perhaps that of Eq. (10)."""
    kappa, mu, V = state.kappa, state.mu, state.V
    lam, zeta, g, h, _, status = solved
    out[LAM], out[ZETA] = lam, zeta
    here = _NOWHERE
    if need.slopes and NEAR <= zeta <= FAR:
        here = at_contact(zeta, material)
    if need.moment:
        _moment(V, kappa, solved, here, material, need.slopes, out)
    if not need.shift:
        return status
    epsilon = g / zeta if zeta >= NEAR else fast_limit(zeta, h, material)[0]
    delta_star = 0.5 * mu * lam * (1.0 + epsilon) / kappa
    slip, sign, direction = signed_slip(state)
    delta = creep_ratio(state, slip)
    if V == 0.0 and state.creep_is_omega:
        full_slip = slip != 0.0
    else:
        full_slip = abs(delta) >= delta_star
    out[EPSILON], out[DELTA_STAR], out[DELTA], out[FULL_SLIP] = epsilon, delta_star, delta, 1.0 if full_slip else 0.0
    if not need.stick:
        return status
    if full_slip:
        out[BETA], out[Q] = 0.0, mu * sign
        out[DQ_DV] = out[DQ_DDELTA] = out[DQ_DOMEGA] = 0.0
        return status
    stuck = stick(abs(V), abs(delta), mu, solved, delta_star, root, material)
    _, _, beta, share, stick_status = stuck
    out[BETA] = beta
    out[Q] = sign * mu * share
    if need.slopes:
        _, h, dg, dh, _, _, _, _ = here
        ratio = 2.0 * (zeta + h + zeta * dh) / (1.0 + dg)
        dQ_dV, dQ_ddelta = _traction_slopes(abs(delta), state, solved, stuck, ratio, material)
        out[DQ_DV] = np.sign(delta) * dQ_dV
        out[DQ_DDELTA] = direction * dQ_ddelta
        out[DQ_DOMEGA] = dQ_ddelta / abs(V)
        if state.creep_is_omega:
            out[DQ_DV] -= dQ_ddelta * (1.0 + delta) / abs(V)
    return max(status, stick_status)


@kernel(inline=True)
def _moment(V, kappa, solved, here, material, need_slopes, out):
    """M = V m(zeta) and dM/dV = m - 2 (H/H') m' of Eqs. (16), (18), and the parts of two bodies in them."""
    lam, zeta, g, h, _, _ = solved
    c = material.T_mean
    if zeta > FAR:
        out[M], out[DM_DV] = c * V, c
    elif zeta < NEAR:
        out[M], out[DM_DV] = _over_zeta(V, kappa, lam) * fast_limit(zeta, h, material)[1], 0.0
    else:
        out[M] = V * moment_of(zeta, lam, g, h, material)  # the same bits with slopes and without
        if need_slopes:
            _, h, _, dh, m, dm, _, _ = here
            out[DM_DV] = m - zeta * dm / _steepness(lam, zeta, h, dh)
    _put_parts(V, kappa, solved, here, material, need_slopes, out)


@kernel(inline=True)
def _over_zeta(V, kappa, lam):
    """V zeta."""
    return np.copysign(0.5 * lam / kappa, V)


@kernel(inline=True)
def _steepness(lam, zeta, h, dh):
    """zeta H'/(2 H) = -zeta/(V dzeta/dV)."""
    return lam * lam * (1.0 + (h + zeta * dh) / zeta)


@kernel(inline=True)
def _no_parts(V, kappa, solved, here, material, need_slopes, out):
    """Bodies that are alike take half of M each."""


@kernel(inline=True)
def _parts_of_pair(V, kappa, solved, here, material, need_slopes, out):
    """What either body has in M and in dM/dV."""
    lam, zeta, _, _, _, _ = solved
    if zeta < NEAR:
        half_space, cylinder = fast_parts(zeta, material)
        half_space, cylinder = _over_zeta(V, kappa, lam) * half_space, _over_zeta(V, kappa, lam) * cylinder
        out[M_HALF_SPACE], out[M_CYLINDER], out[DM_HALF_SPACE_DV], out[DM_CYLINDER_DV] = half_space, cylinder, 0.0, 0.0
        return
    half_space, cylinder, d_half_space, d_cylinder = parts(zeta, material)
    out[M_HALF_SPACE], out[M_CYLINDER] = V * half_space, V * cylinder
    if need_slopes:
        _, h, _, dh, _, _, _, _ = here
        per = zeta / _steepness(lam, zeta, h, dh) if zeta <= FAR else 0.0
        out[DM_HALF_SPACE_DV], out[DM_CYLINDER_DV] = half_space - per * d_half_space, cylinder - per * d_cylinder


_put_parts = by_record(4, (Pair, _parts_of_pair), (FilledPair, _parts_of_pair), otherwise=_no_parts)
