"""The law in full slip, Eq. (22).

With sigma = sign(omega - V) fixed, Q = sigma mu, so w = V - j omega is exactly linear in
tau = gamma t and V' = sigma mu - M(V)/2 stands alone.  The unknown in place of V is
s = 1/zeta, in which the law is explicit: V = s lam/(2 kappa), in a frame where V >= 0.
"""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from ..law.length import contact_length
from ..material.functions import at_slide, generators

#: kappa mu from which on M(V) < 2 mu for all alpha and V: the largest kappa M is 0.3091, for alpha -> infinity
HOLDS = 0.16
#: steps toward a speed at which V stands still, difference quotient, last step, largest step of Newton's over s
_SEARCH, _DIFFERENCE, _FOUND, _NEAR = 200, 1e-5, 1e-13, 0.1
#: s beyond which no such speed is looked for
_FASTEST = 1e30


@kernel
def sliding(s, sigma, scene):
    """(V, V', dV/ds, M/2, delta_star V) at s >= 0."""
    material, kappa, mu, _ = scene
    if material.T_mean == 0.0:
        per_s = 0.5 / kappa
        V = per_s * s
        return V, sigma * mu, per_s, 0.0, mu * per_s * V
    zeta = 1.0 / np.float64(s)
    g, h, dh, m = at_slide(zeta, material)
    square = 1.0 + 2.0 * h * s  # 1/lam^2
    half_lam = 0.5 / (kappa * np.sqrt(square))
    V = s * half_lam
    half_M = 0.5 * V * m
    # dV/ds = lam^3 U/(2 kappa), U = H'/(2 zeta)
    per_s = half_lam * (1.0 + h * s + dh) / square
    return V, sigma * mu - half_M, per_s, half_M, mu * half_lam * (1.0 + g * s) * V


@kernel
def sliding_speed(s, scene):
    """V at s >= 0."""
    return edge_of_stick(s, scene)[0]


@kernel
def edge_of_stick(s, scene):
    """(V, delta_star V) at s >= 0; the stick band is |omega - V| < delta_star V."""
    material, kappa, mu, _ = scene
    g, h = generators(1.0 / np.float64(s), material)
    half_lam = 0.5 / (kappa * np.sqrt(1.0 + 2.0 * h * s))
    V = s * half_lam
    return V, mu * half_lam * (1.0 + g * s) * V


@kernel
def stick_limit(V, scene):
    """(delta_star |V|, zeta, status) at V; the stick band is |omega - V| < delta_star |V|."""
    material, kappa, mu, _ = scene
    speed = abs(V)
    kappa_V = kappa * speed
    lam, status = contact_length(kappa_V, material)
    zeta = lam / (2.0 * kappa_V)
    g, _ = generators(zeta, material)
    return 0.5 * mu * lam * (1.0 + g / zeta) / kappa * speed, zeta, status


@kernel
def sliding_scale(V, w, scene):
    """Speed that errors of V are measured by: the speed expected at onset, within bounds.

    Sliding alone would keep V + j omega, so onset lies near V = (V + j omega)/(1 + j).
    """
    j = scene.j
    omega = (V - w) / j
    largest = max(abs(V), abs(omega))
    return max(1e-3 * largest, min(largest, abs(V + j * omega) / (1.0 + j)))


@kernel
def standstill(s, scene):
    """The s next to this one, the way V goes, at which rolling resistance holds V against the traction, M(V) = 2 mu.

    NaN if there is none.  From a fast spin V comes near that speed in a few relaxation times and stays until the spin
    is spent.  M(V)/V falls with V, so that no such speed lies between V and 2 mu V/M(V).
    """
    material, kappa, mu, _ = scene
    if material.T_mean == 0.0 or not kappa * mu < HOLDS:
        return np.nan
    s = max(s, 4.0 * kappa * mu / material.T_mean)  # below, M(V) <= V T_mean < 2 mu
    for _ in range(_SEARCH):
        _, rate, _, half_M, _ = sliding(s, 1.0, scene)
        _, further, _, _, _ = sliding(s * (1.0 + _DIFFERENCE), 1.0, scene)
        change, surely = rate * _DIFFERENCE * s / (rate - further), (mu / half_M - 1.0) * s
        if not (change * surely > 0.0 and abs(change) < _NEAR * s):
            change = surely
        s += change
        if abs(change) <= _FOUND * s:
            return s
        if not s < _FASTEST:
            return np.nan
    return np.nan
