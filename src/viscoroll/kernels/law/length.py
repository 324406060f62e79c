"""Eq. (6), the length of the contact: H(zeta) = 1/(2 kappa V)^2, lam = 2 kappa V zeta.

Nothing here divides by V or squares zeta where that could overflow: the equation is
solved for lam in [alpha^(-1/2), 1], and H enters as H/z^2 = 1 + 2 h/z = 1/lam^2.
"""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from ..material.functions import generator_slopes, second_slopes

OK, NOT_CONVERGED = 0, 1
MAX_STEPS = 60
#: below this 2 c kappa V the length is that at rest, below this alpha zeta that at high speed, to rounding
_SLOW, _FAST = 1e-17, 1e-9
#: a step of Halley's iteration of this relative size leaves an error of its cube
_CUBED = 3e-6


@kernel(inline=True)
def near_length(kappa_V, material, low):
    """lam to some per cent: a step of Newton's iteration with r(x) near x/(rho + x) and k(z) near z/(z + 0.35).

    ``low`` = alpha^(-1/2), the least that it can be.
    """
    alpha, c = material.alpha, material.T_mean
    w = 2.0 * kappa_V
    # lam^2 + 2 w lam h = 1 with h between its limits c alpha zeta/2 and c/2
    start = c * 0.5 * w
    lam = max(1.0 / (np.sqrt(1.0 + start * start) + start), low)
    z = lam / w
    x = alpha * z
    rho = 0.5 + np.sqrt(x * x + 2.25) - x
    rise = x + x * z / (z + 0.35)
    total = rise + rho
    square = 1.0 + 2.0 * c * alpha / total
    bend = 1.0 - c * alpha * rise / (square * total * total)
    return min(max(lam + (1.0 / np.sqrt(square) - lam) / bend, low), 1.0)


@kernel(inline=True)
def at_an_end(w, low, material):
    """Whether the length is that at rest, or that at high speed, to rounding."""
    return material.T_mean * w < _SLOW or low < _FAST * w * material.tau


@kernel(inline=True)
def length_step(lam, z, w, per_w, slopes, low, high):
    """One step of Halley's iteration for Eq. (6): (new lam, zeta, g, h, g' there, low, high).

    From ``second_slopes`` at z = lam/w, w = 2 kappa V.  On the square root of
    lam^2 + 2 w lam h(lam/w) = 1, which is nearly linear in lam, kept inside the bracket
    [low, high].  g and h are carried along: they are good where the step was small.
    """
    g, h, dg, dh, ddg, ddh = slopes
    root = np.sqrt(lam * (lam + 2.0 * w * h))
    excess = root - 1.0
    low, high = lam if excess <= 0.0 else low, lam if excess > 0.0 else high
    # slope and second derivative of the square of the root, halved; 1/root to first order in the excess
    slope = lam + w * h + lam * dh
    bend = (1.0 + 2.0 * dh + z * ddh) * root - slope * slope * (1.0 - excess)
    new = lam - 2.0 * excess * slope * root / (2.0 * slope * slope - excess * bend)
    if not low <= new <= high:
        # halving takes small steps too, at the least lam, where rounding puts the root below it
        new = low if low * (1.0 - _CUBED) <= new < low else 0.5 * (low + high)
    zeta = new * per_w
    dz = zeta - z
    return new, zeta, g + dz * (dg + 0.5 * dz * ddg), h + dz * (dh + 0.5 * dz * ddh), dg + dz * ddg, low, high


@kernel(inline=True)
def small_step(old, new):
    """Whether a step of Halley's iteration was small enough to be the last."""
    return abs(new - old) <= _CUBED * old


@kernel(inline=True)
def contact_solution(guess, kappa_V, material):
    """Eq. (6): (lam, zeta, g, h, g', status) at kappa |V| >= 0, from a guess of lam; g' to about 1e-10."""
    w = 2.0 * kappa_V
    low, high = 1.0 / np.sqrt(material.alpha), 1.0
    if at_an_end(w, low, material):
        lam = high if material.T_mean * w < _SLOW else low
        g, h, dg, _ = generator_slopes(lam / w, material)
        return lam, lam / w, g, h, dg, OK
    lam, per_w = guess, 1.0 / w
    for _ in range(MAX_STEPS):
        old, z = lam, lam * per_w
        lam, zeta, g, h, dg, low, high = length_step(old, z, w, per_w, second_slopes(z, material), low, high)
        if small_step(old, lam):
            return lam, zeta, g, h, dg, OK
    return lam, zeta, g, h, dg, NOT_CONVERGED


@kernel
def contact_length(kappa_V, material):
    """Eq. (6): lam at kappa |V| >= 0, and a status."""
    guess = near_length(kappa_V, material, 1.0 / np.sqrt(material.alpha))
    lam, _, _, _, _, status = contact_solution(guess, kappa_V, material)
    return lam, status
