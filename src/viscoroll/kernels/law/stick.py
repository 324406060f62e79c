"""Eq. (10), the stick zone: F(zeta) - F(eta) = delta/(mu V), beta = eta/zeta; Q = mu (1 - H(eta)/H(zeta)), Eq. (15).

Differences of F and H keep their digits where zeta and eta are neighbours.
"""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from ..material.functions import generator_slopes, generators, mean_slopes, second_slopes
from .length import MAX_STEPS, NOT_CONVERGED, OK, small_step

#: below this (zeta - eta)/zeta differences of g and h are integrals of their slopes
CLOSE = 0.1
#: below this d/F(zeta) zeta - eta starts from the slopes at zeta
_SLIGHT = 1e-4


@kernel
def differences(zeta, eta, D, material):
    """(F(zeta) - F(eta), (H(zeta) - H(eta))/zeta) with D = zeta - eta, to full relative accuracy.

    For neighbouring arguments both are integrals of the slopes: no digits cancel.  H comes
    divided by zeta so that nothing underflows at the highest speeds.
    """
    ratio = eta / zeta
    if material.T_mean == 0.0:
        return D, (1.0 + ratio) * D
    if D > CLOSE * zeta:
        g, h = generators(zeta, material)
        g_eta, h_eta = generators(eta, material)
        return D + (g - g_eta), (1.0 + ratio) * D + 2.0 * (h - ratio * h_eta)
    slope_g, slope_zh = mean_slopes(zeta, D, material)
    return D * (1.0 + slope_g), D * (1.0 + ratio + 2.0 * slope_zh / zeta)


@kernel
def stick_length(zeta, d, material):
    """Eq. (10): (eta, D = zeta - eta, status) with F(zeta) - F(eta) = d, 0 <= d < F(zeta)."""
    g, h, dg, _ = generator_slopes(zeta, material)
    eta, D, _, status = stick_solution(zeta, g, h, dg, d, material)
    return eta, D, status


@kernel
def stick_solution(zeta, g, h, dg, d, material):
    """Eq. (10): (eta, D, (H(zeta) - H(eta))/zeta, status); D = zeta - eta, F(zeta) - F(eta) = d.

    Given are g, h and g' at zeta.  Solved for eta; where slip is slight, so that differences
    cancel, D comes from that, or from the slopes at zeta, by a step of Newton's iteration.
    """
    if material.T_mean == 0.0:
        return zeta - d, d, (2.0 - d / zeta) * d, OK
    if slight(d, zeta, g):
        _, _, dg, _, ddg, _ = second_slopes(zeta, material)
        D = d / (1.0 + dg)
        return _sharper(zeta, D * (1.0 + 0.5 * D * ddg / (1.0 + dg)), d, material)
    y = (zeta + g) - d
    eta, g_eta, h_eta, status = root_of_F(y, near_eta(y, zeta, g, dg), material)
    D = d - (g - g_eta)
    if d <= CLOSE * (zeta + g):
        eta, D, rise_H, _ = _sharper(zeta, D, d, material)
        return eta, D, rise_H, status
    ratio = eta / zeta
    return eta, D, (1.0 + ratio) * D + 2.0 * (h - ratio * h_eta), status


@kernel(inline=True)
def slight(d, zeta, g):
    """Whether slip is so slight that zeta - eta starts from the slopes at zeta."""
    return d <= _SLIGHT * (zeta + g)


@kernel
def _sharper(zeta, D, d, material):
    """``stick_solution`` from D with an error of 1e-7 of D at most."""
    eta = zeta - D
    rise, rise_H = differences(zeta, eta, D, material)
    _, h, dg, dh = generator_slopes(eta, material)
    more = (d - rise) / (1.0 + dg)
    return eta - more, D + more, rise_H + 2.0 * more * (eta + h + eta * dh) / zeta, OK


@kernel(inline=True)
def near_eta(y, zeta, g, dg):
    """F^-1(y) with g(z) near A z/(B + z), which has the given value and slope at zeta."""
    curve = g - zeta * dg
    if curve <= 0.0:
        return zeta * (y / (zeta + g))
    B = zeta * zeta * dg / curve
    half = 0.5 * (y - B - g * (zeta + B) / zeta)
    root = np.sqrt(half * half + y * B)
    return half + root if half > 0.0 else y * B / (root - half)


@kernel(inline=True)
def root_bracket(y, material):
    """Bounds of F^-1(y)."""
    low, high = max(y - 0.5 * material.T_mean, 0.0), y
    return low, high


@kernel(inline=True)
def root_step(eta, y, slopes, low, high):
    """One step of Halley's iteration for F(eta) = y from ``second_slopes``: (new eta, g, h there, low, high)."""
    g, h, dg, dh, ddg, ddh = slopes
    excess = (eta - y) + g
    low, high = eta if excess <= 0.0 else low, eta if excess > 0.0 else high
    slope = 1.0 + dg
    new = eta - 2.0 * excess * slope / (2.0 * slope * slope - excess * ddg)
    new = new if low <= new <= high else 0.5 * (low + high)
    dz = new - eta
    return new, g + dz * (dg + 0.5 * dz * ddg), h + dz * (dh + 0.5 * dz * ddh), low, high


@kernel
def root_of_F(y, guess, material):
    """F(eta) = y by Halley's iteration: (eta, g, h, status); y - c/2 <= eta <= y, and 0 where y rounds to below it."""
    if y <= 0.0:
        return 0.0, 0.0, 0.0, OK
    low, high = root_bracket(y, material)
    eta = guess
    g, h = 0.0, 0.0
    for _ in range(MAX_STEPS):
        old = eta
        eta, g, h, low, high = root_step(old, y, second_slopes(old, material), low, high)
        if small_step(old, eta) or high <= low:
            return eta, g, h, OK
    return eta, g, h, NOT_CONVERGED
