"""The inverses of the law at one material: what Eqs. (6), (8)-(10), (15), (16) ask of kappa |V| and of y = F(eta).

Of u = kappa |V|

    lam, epsilon, L = 2 u F(zeta) = 2 kappa delta_star/mu, M/V

and of y

    eta/y, H(eta)/y^2, A = H'(eta)/(2 y F'(eta))

the last being the slope of H(F^-1(y)) over 2 y.  They are analytic where Re > 0, as g, h and m are, and
are found from those themselves, not from their table, whose slopes have lost four digits.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from ..compile.jit import kernel
from ..compile.rarely import rarely
from ..material.functions import generator_slopes, generators, moment_of
from ..material.pair import Pair, parts
from ..material.standard import GAUSS_W, GAUSS_X, Standard
from ..material.tabulated import Tabulated
from ..numerics import quartet
from ..numerics.bins import offset_slope
from ..numerics.nodes import gauss
from .length import OK, contact_length
from .stick import root_of_F

#: up to this D/L the integral of the slope of Q takes four points of the polynomial of one bin, which it may leave by
#: 0.15 of half a bin: to 2e-15, measured
SLIGHTEST = 0.01
#: distances of four points from the middle of an interval of length 1, and their weights
_OUTER, _INNER = (float(x) for x in 0.5 - gauss(4)[0][:2])
_OUTER_W, _INNER_W = (float(x) for x in gauss(4)[1][:2])


class Inverses(NamedTuple):
    """A material, and tables (:mod:`quartet`) over kappa |V| and over F(eta)."""

    material: Standard | Tabulated
    speed: Any
    stick: Any


class InversesOfPair(NamedTuple):
    """Likewise of two bodies, and a third table over kappa |V|: the parts of M/V."""

    material: Pair
    speed: Any
    stick: Any
    moments: Any


def inverses_of(material: Standard | Tabulated | Pair) -> Inverses | InversesOfPair:
    """With nothing in its tables."""
    if isinstance(material, Pair):
        return InversesOfPair(material, quartet.empty_table(), quartet.empty_table(), quartet.empty_table())
    return Inverses(material, quartet.empty_table(), quartet.empty_table())


@kernel
def _make_speed(row, u, inverses):
    """Make the bin of u; returns a status."""
    quartet.begin(inverses.speed, row)
    worst = OK
    for n in range(quartet.TERMS):
        kappa_V = quartet.node(u, n)
        lam, status = contact_length(kappa_V, inverses.material)
        zeta = 0.5 * lam / kappa_V
        g, h = generators(zeta, inverses.material)
        m = moment_of(zeta, lam, g, h, inverses.material)
        quartet.put(inverses.speed, row, n, lam, g / zeta, lam * (1.0 + g / zeta), m)
        worst = max(worst, status)
    if worst == OK:
        quartet.finish(inverses.speed, row, u)
    return worst


@kernel
def _make_moments(row, u, inverses):
    """Make the bin of u in the table of the parts of M/V; returns a status."""
    quartet.begin(inverses.moments, row)
    worst = OK
    for n in range(quartet.TERMS):
        kappa_V = quartet.node(u, n)
        lam, status = contact_length(kappa_V, inverses.material)
        half_space, cylinder, _, _ = parts(0.5 * lam / kappa_V, inverses.material)
        quartet.put(inverses.moments, row, n, half_space, cylinder, 0.0, 0.0)
        worst = max(worst, status)
    if worst == OK:
        quartet.finish(inverses.moments, row, u)
    return worst


@kernel
def _make_stick(row, y, inverses):
    """Make the bin of y; returns a status."""
    quartet.begin(inverses.stick, row)
    worst = OK
    for n in range(quartet.TERMS):
        at = quartet.node(y, n)
        eta, _, _, status = root_of_F(at, at, inverses.material)
        _, h, dg, dh = generator_slopes(eta, inverses.material)
        share = eta / at
        quartet.put(
            inverses.stick, row, n, share, share * (eta + 2.0 * h) / at, (eta + h + eta * dh) / (at * (1.0 + dg)), 0.0
        )
        worst = max(worst, status)
    if worst == OK:
        quartet.finish(inverses.stick, row, y)
    return worst


@kernel(inline=True)
def at_speed(u, inverses):
    """(lam, epsilon, L, M/V, status) at u = kappa |V|."""
    row, there = quartet.row_of(u, inverses.speed)
    status = OK
    if rarely(not there):
        status = _make_speed(row, u, inverses)
    lam, epsilon, L, m = quartet.values(inverses.speed, row, quartet.offset(u))
    return lam, epsilon, L, m, status


@kernel(inline=True)
def moments_at_speed(u, inverses):
    """(parts of M/V in the half-space and in the cylinder, status) at u = kappa |V|."""
    row, there = quartet.row_of(u, inverses.moments)
    status = OK
    if rarely(not there):
        status = _make_moments(row, u, inverses)
    half_space, cylinder, _, _ = quartet.values(inverses.moments, row, quartet.offset(u))
    return half_space, cylinder, status


@kernel(inline=True)
def _stick_row(y, inverses):
    """(row of the bin of y, status)."""
    row, there = quartet.row_of(y, inverses.stick)
    status = OK
    if rarely(not there):
        status = _make_stick(row, y, inverses)
    return row, status


@kernel(inline=True)
def at_stick(y, inverses):
    """(eta/y, H(eta)/y^2, A, status) at y = F(eta)."""
    row, status = _stick_row(y, inverses)
    share, press, rise, _ = quartet.values(inverses.stick, row, quartet.offset(y))
    return share, press, rise, status


@kernel
def slight_traction(u, L, D, inverses):
    """(|Q|/mu, status) as the integral of its slope, for small D = 2 kappa |delta|/mu: no digits cancel."""
    total, worst = 0.0, OK
    for n in range(GAUSS_X.size):
        w = L - D * GAUSS_X[n]
        _, _, rise, status = at_stick(0.5 * w / u, inverses)
        total += GAUSS_W[n] * w * rise
        worst = max(worst, status)
    return 2.0 * D * total, worst


@kernel(inline=True)
def slightest_traction(u, L, D, inverses):
    """``slight_traction`` up to :data:`SLIGHTEST`: four points from the bin of the middle one."""
    per, middle = 0.5 / u, L - 0.5 * D
    y = per * middle
    row, status = _stick_row(y, inverses)
    t, step = quartet.offset(y), per * D * offset_slope(y)
    inner, outer = step * _INNER, step * _OUTER
    a, b, c, d = quartet.third_at_four(inverses.stick, row, t - outer, t - inner, t + inner, t + outer)
    mean = middle * (_OUTER_W * (a + d) + _INNER_W * (b + c))
    return 2.0 * D * (mean + D * (_OUTER_W * _OUTER * (d - a) + _INNER_W * _INNER * (c - b))), status
