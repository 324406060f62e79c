"""What one would write without rows: the Rosenbrock method of pipeline/runtime.py, with the law behind a call.

Two laws: root solves of the printed equations in each right-hand side, and the tensor splines of a 3-D atlas over
(alpha, kappa V, s), which is the plain reading of the paper's design.  Slopes are differences.
"""

from __future__ import annotations

from collections import namedtuple
from functools import cache

import numba
import numpy as np
from scipy.interpolate import make_interp_spline

import viscoroll as vr
from viscoroll.kernels.printed.law import (
    direct_contact_length,
    direct_delta_star,
    direct_moment,
    direct_stick,
    direct_traction,
)

#: nodes along alpha, kappa V and s, and the ends of the first two
NODES, ENDS = (48, 128, 128), ((1.0, 100.0), (1e-3, 1e3))
#: of V, and of the stick band, that differences are taken over
_NUDGE = 1e-6
Loads = namedtuple("Loads", "Q dQ_dV dQ_domega M_half_space dM_half_space_dV M_cylinder dM_cylinder_dV")


@cache
def by_roots(alpha: float, kappa: float, mu: float):
    """The law by two Brent-Dekker solves."""

    @numba.njit
    def law(speed, delta):
        lam, zeta, epsilon, _ = direct_contact_length(kappa * speed, alpha)
        M = direct_moment(kappa, lam, epsilon, zeta, alpha)
        if delta >= direct_delta_star(kappa, mu, lam, epsilon):
            return mu, M
        beta, _ = direct_stick(delta, kappa, mu, lam, epsilon, zeta, alpha)
        return direct_traction(beta, delta, kappa, mu, lam, epsilon, zeta), M

    return law


@cache
def by_atlas(alpha: float, kappa: float, mu: float):
    """The law by cubic splines of kappa M, kappa delta_star/mu and Q/mu, not-a-knot; of s = u (2 - u), even steps of u.

    Those along alpha are evaluated once.  Beyond the table M goes on in proportion to V, the rest is held.
    """
    axes = [*(np.linspace(*np.log(ends), n) for ends, n in zip(ENDS, NODES)), np.linspace(0.0, 1.0, NODES[2])]
    unit, V, u = vr.Scene(np.exp(axes[0])[:, None, None], 1.0, 1.0), np.exp(axes[1])[:, None], axes[2]
    plane = vr.contact(unit, V, delta=0.0, fields=("M", "delta_star"))
    share = vr.contact(unit, V, delta=u * (2.0 - u) * plane.delta_star, fields="Q").Q
    share[..., -1] = 1.0
    along, steps = (make_interp_spline(axis, axis).t for axis in axes[1:])
    M_of, star_of, Q_of = (
        _spline(make_interp_spline(axes[0], values)(np.log(alpha)), axes[1:])
        for values in (plane.M[..., 0], plane.delta_star[..., 0], share)
    )
    lowest = axes[1][0]

    @numba.njit
    def law(speed, delta):
        v, w, x = np.empty(4), np.empty(4), np.log(kappa * speed)
        k = _basis(along, x, v)
        M = limit = Q = 0.0
        for b in range(4):
            M, limit = M + v[b] * M_of[k + b], limit + v[b] * star_of[k + b]
        M *= np.exp(min(x - lowest, 0.0)) / kappa
        s = delta * kappa / (limit * mu)
        if s >= 1.0:
            return mu, M
        n = _basis(steps, s / (1.0 + np.sqrt(1.0 - s)), w)
        for b in range(4):
            for c in range(4):
                Q += v[b] * w[c] * Q_of[k + b, n + c]
        return mu * Q, M

    return law


def _spline(values, axes):
    """Coefficients of the tensor spline through values."""
    for n in range(values.ndim):
        values = np.moveaxis(make_interp_spline(axes[n], values, axis=n).c, 0, n)
    return np.ascontiguousarray(values)


@numba.njit
def _basis(knots, x, weights):
    """The four B-splines that are not zero at x, held to the even nodes; returns the index of the first."""
    nodes, low, high = knots.size - 4, knots[0], knots[-1]
    x = min(max(x, low), high)
    span = min(max(int((x - low) * ((nodes - 1) / (high - low))) + 2, 3), nodes - 1)
    if x < knots[span] and span > 3:  # the edge of a cell may round either way
        span -= 1
    weights[0] = 1.0
    for degree in range(1, 4):
        carried = 0.0
        for n in range(degree):
            right, left = knots[span + n + 1], knots[span + 1 - degree + n]
            share = weights[n] / (right - left)
            weights[n] = carried + (right - x) * share
            carried = (x - left) * share
        weights[degree] = carried
    return span - 3


@cache
def loaded(law):
    """(V, omega) -> Q and M/2, of (|V|, |delta|) -> (|Q|, |M|)."""

    @numba.njit
    def loads(V, omega):
        speed = max(abs(V), 1e-300)
        Q, M = law(speed, abs(omega - V) / speed)
        return np.sign(omega - V) * Q, 0.5 * np.sign(V) * M

    return loads


def differenced(law, band):
    """(V, omega) -> loads and slopes; creep of stick is of the size of ``band``."""
    loads = loaded(law)

    @numba.njit
    def state(V, omega):
        h = _NUDGE * max(abs(V), 1e-30)
        Q, M = loads(V, omega)
        faster, heavier = loads(V + h, omega + h)
        turned, _ = loads(V, omega + band * h)
        dQ_domega, dM = (turned - Q) / (band * h), (heavier - M) / h
        return Loads(Q, (faster - Q) / h - dQ_domega, dQ_domega, M, dM, M, dM)

    return state
