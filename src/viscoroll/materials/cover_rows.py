"""The law of a cover over speed: what :mod:`.cover_solve` finds at nodes of u = kappa |V|, as rows of polynomials.

A scene fixes l0/h, so that theta = lam l0/(2 h) follows from the half length that carries the load; all quantities are
then smooth functions of u alone.  They are found at twelve nodes an octave, from slow to fast, each from what the last
ones say of it.  Octaves are interpolated between these; below the first octave a polynomial of u, beyond the last one a
polynomial of 1/u takes over, both with the limits of elastic layers.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from ..core.array_types import Floats
from ..core.errors import ParameterError
from ..kernels.numerics.interpolation import chebyshev, to_doubles
from .cover_solve import MOST_THETA, CoverModes, CoverState, local_strain, solve
from .law_build import FUNCTIONS, TERMS, Rows, octaves

#: nodes an octave of u, and nodes on either side of an octave that take part in its polynomial
PER_OCTAVE, _ASIDE = 12, 18
#: what is computed at the nodes, in this order: lam, L = 2 kappa delta_star/mu, 2 kappa delta_0 of a cover on the base,
#: epsilon and M/V
_LAM, _LIMIT, _FREE, _EPSILON, _MOMENT = range(5)
#: octaves between the fastest rate (times the thickness over l0 of thick covers) and the row in 1/u
_FAST_OCTAVES = 4
#: octaves of rows beyond those, behind which the first order in 1/u is good to rounding
_BEYOND = 42
#: nodes of the polynomials at either end, from 0.05 to 1 of their range, and their degree: wide enough for little
#: noise to be carried to 0, where the solve itself loses digits
_END_NODES, _END_DEGREE = 52, 10
#: secants for the load end where the product of the relative errors of the last two is below this: the line through
#: both then leaves rounding; and the two lie at least so far apart in ln z, for rounding not to turn the line
_LOAD_ERRORS, _LEAST_STEP = 1e-14, 1e-8
_MOST_STEPS = 40
#: thickness over l0 up to which half the contact is longer than that in any case, and nothing is solved
_THINNEST = 0.01
#: last nodes that a node is extrapolated from
_EXTRAPOLATED = 8


class CoverRows(NamedTuple):
    """The rows of a cover.

    e0 : the first row holds [0, 2^e0), each of the others an octave.
    coefficients : (rows, 24 powers, 7 functions) as of a half-space, without N.
    creep : (2, rows, 24 powers) of L = 2 kappa delta_star/mu and of 2 kappa delta_0, over u.
    limits : for u -> infinity, (L, lam, 2 kappa delta_0), and the factors of 1/u that each of the first order has;
        then epsilon u and M u^2/V.
    """

    e0: int
    coefficients: Floats
    creep: Floats
    limits: Floats


def cover_rows(modes: CoverModes, thickness: float, side: float, thickest: float | None = None) -> CoverRows:
    """The rows of one cover.

    Parameters
    ----------
    modes : of the cover.
    thickness : over l0.
    side : sign of delta_0 where the surface of the cover is stretched: 1 on the base, which then has all of M, and -1
        on the cylinder.
    thickest : of covers that are to have as many rows; default: this one.

    Raises
    ------
    ParameterError
        A cover so thin that the half length at rest is more than six thicknesses.
    """
    slow_limit = _elastic(modes, thickness, 1.0) if thickness > _THINNEST else None
    if slow_limit is None or slow_limit[_LAM] > 2.0 * MOST_THETA * thickness:
        allowed = f"larger: half the contact at rest may be at most {MOST_THETA:g} thicknesses long"
        raise ParameterError("thickness", f"{thickness:.3g} (over l0)", allowed)
    if not modes.a.size:
        return _of_elastic(slow_limit, side)
    fast_limit = _elastic(modes, thickness, modes.alpha)
    e0 = int(octaves(modes.b[0], modes.a[-1])[0])
    last = math.frexp(modes.a[-1] * max(1.0, thickest or thickness))[1] + _FAST_OCTAVES
    first = e0 * PER_OCTAVE - _END_NODES + 1
    u = np.exp2(np.arange(first, last * PER_OCTAVE + _END_NODES) / PER_OCTAVE)
    values = _march(modes, thickness, u, slow_limit[_LAM])
    values[_FREE] *= side
    rows = Rows(e0, last - e0 + 1 + _BEYOND)
    slow, slow_limit = _slow_row(u[:_END_NODES], values[:, :_END_NODES], slow_limit, rows)
    inside = _octave_rows(values, e0 * PER_OCTAVE - first, last - e0)
    fast, limits = _fast_rows(u[-_END_NODES:], values[:, -_END_NODES:], fast_limit, rows.x[last - e0 + 1 :], last)
    found, slopes = np.concatenate([slow, inside, fast], axis=2)
    powers = rows.fit_slopes(found, slopes)
    powers[:, 0, 0] = slow_limit
    stick, d_stick = _over_stick(rows, powers, limits)
    share, press = rows.fit_slopes(stick, d_stick)
    nothing = np.zeros_like(press)
    bodies = (powers[_MOMENT], nothing) if side > 0.0 else (nothing, powers[_MOMENT])
    columns = [powers[_LAM], powers[_EPSILON], *bodies, np.full_like(press, np.nan), share, press]
    return CoverRows(e0, np.stack(columns, axis=-1), powers[[_LIMIT, _FREE]], limits)


def _slow_row(u: Floats, values: Floats, limit: Floats, rows: Rows) -> tuple[Floats, Floats]:
    """((values, slopes over ln u) at the nodes of the row [0, 2^e0), their limits at 0).

    u, values : nodes in that row, and what was found there.  limit : as computed; those of the creep of free rolling,
    which is less accurate than an elastic layer apart would be, and of M/V beside a body that deforms too are
    extrapolated.
    """
    y, limit = u / math.ldexp(1.0, rows.e0), limit.copy()
    for which in (_FREE, _MOMENT) if np.isnan(limit[_MOMENT]) else (_FREE,):
        limit[which] = _at_end(y, values[which])
    found, slopes = _end(y, (values - limit[:, None]) / y, rows.t[0])
    return np.stack([found + limit[:, None], slopes])[:, :, None], limit


def _octave_rows(values: Floats, begin: int, count: int) -> Floats:
    """(Values, slopes over ln u) at the nodes of octaves; ``begin``: the number of the node where the first begins."""
    windows = np.lib.stride_tricks.sliding_window_view(values, PER_OCTAVE + 2 * _ASIDE + 1, axis=1)
    around = windows[:, begin - _ASIDE + PER_OCTAVE * np.arange(count)]
    return np.stack([around @ matrix for matrix in _interpolation()])


def _fast_rows(u: Floats, values: Floats, limit: Floats, x: Floats, last: int) -> tuple[Floats, Floats]:
    """((values, slopes over ln u) at the nodes x of the rows from 2^last on, :attr:`CoverRows.limits`).

    There everything is a polynomial of 1/u: limits and first order of lengths and creep, epsilon u, M u^2/V.
    """
    end = math.ldexp(1.0, last)
    y, limit = end / u, limit.copy()
    limit[_FREE] = _at_end(y, values[_FREE])
    fall = (values - limit[:, None]) / y
    fall[_MOMENT] /= y
    at = (end / x).ravel()
    found, rising = _end(y, fall, at)
    found[_MOMENT], rising[_MOMENT] = found[_MOMENT] * at, (rising[_MOMENT] + found[_MOMENT]) * at
    first = np.array([_at_end(y, each) for each in fall]) * end
    first[_MOMENT] *= end
    limits = [*limit[[_LIMIT, _LAM, _FREE]], *first[[_LIMIT, _LAM, _FREE]], *first[[_EPSILON, _MOMENT]]]
    return np.stack([found + limit[:, None], -rising]).reshape(2, len(values), *x.shape), np.array(limits)


def quantities(state: CoverState, z: float, u: float) -> Floats:
    """lam, L, 2 kappa delta_0, epsilon and M/V of a solve at u."""
    return np.array([2.0 * z * u, 2.0 * u * state.creep_limit, 2.0 * u * state.strain, state.shift / z, state.moment])


def at_speed(modes: CoverModes, thickness: float, u: float, *, orders: int | None = None) -> Floats:
    """lam, L, 2 kappa delta_0 (of a cover on the base), epsilon and M/V at u, by the solve alone: what rows are
    compared with."""
    z = 0.5 / u / math.sqrt(1.0 + (modes.alpha - 1.0) * u / (u + 1.0)) / (1.0 + 0.2 / thickness)
    return _node(modes, thickness, u, math.log(z), 2.0, orders)[0]


def _node(
    modes: CoverModes,
    thickness: float,
    u: float,
    guess: float,
    slope: float,
    orders: int | None = None,
    factor: float = 1.0,
) -> tuple[Floats, float, float]:
    """(What is computed at u, ln z, d ln H/d ln z), by secants for ln H = -ln(4 factor u^2) from ln z = guess."""
    y, goal, before = guess, -math.log(4.0 * factor * u * u), None
    for _ in range(_MOST_STEPS):
        z = math.exp(y)
        state = solve(modes, z, z * u / thickness, orders)
        left, values = math.log(state.load) - goal, quantities(state, z, u)
        if before is not None:
            slope = min(max((left - before[1]) / (y - before[0]), 0.5), 8.0)
        step = -left / slope
        if before is not None and abs(left * before[1]) < _LOAD_ERRORS:
            found = values + (values - before[2]) * (step / (y - before[0]))
            found[_FREE] += 2.0 * u * local_strain(modes, z, state)
            return found, y + step, slope
        before = y, left, values
        y += min(max(step, -0.7), 0.7) if abs(step) > _LEAST_STEP else math.copysign(_LEAST_STEP, step)
    raise ParameterError("thickness", f"{thickness:g} (over l0)", "larger: the load of the layer was not met")


def _march(modes: CoverModes, thickness: float, u: Floats, lam: float) -> Floats:
    """What is computed at rising u, [quantity, node]."""
    found, logs, slope = np.empty((5, u.size)), np.empty(u.size), 2.0
    for n, each in enumerate(u.tolist()):
        known = logs[max(n - _EXTRAPOLATED, 0) : n][::-1]
        signs = (-1.0) ** np.arange(known.size)
        guess = math.log(0.5 * lam / each)
        if n:
            guess = float(sum(signs * [math.comb(known.size, k) for k in range(1, known.size + 1)] * known))
        found[:, n], logs[n], slope = _node(modes, thickness, each, guess, slope)
    return found


def _elastic(modes: CoverModes, thickness: float, alpha: float) -> Floats:
    """What is computed, of the layer with its long-time stiffness (alpha = 1) or its instantaneous one.

    epsilon is then 0, and M/V is T_mean at long times, or not known (NaN) beside a body that deforms too, and else 0.
    """
    instant = alpha != 1.0
    share = modes.layer_instant * modes.alpha if instant else modes.share
    elastic = modes.elastic(share)
    z = 0.5 / (1.0 + 0.2 / thickness)
    # slopes and creep of an elastic layer depend on its shape alone
    found = _node(elastic, thickness, 0.5, math.log(z / math.sqrt(alpha)), 2.0, factor=alpha)[0]
    found[_EPSILON], found[_MOMENT] = 0.0, 0.0
    if not instant:
        found[_MOMENT] = float(modes.e @ modes.e) if modes.share == 1.0 else math.nan
    return found


def _of_elastic(limit: Floats, side: float) -> CoverRows:
    """The one row of a cover that does not relax."""
    coefficients, creep = np.zeros((1, TERMS, len(FUNCTIONS))), np.zeros((2, 1, TERMS))
    lam, L, free = limit[_LAM], limit[_LIMIT], side * limit[_FREE]
    coefficients[0, 0] = [lam, 0.0, 0.0, 0.0, np.nan, lam / L, 1.0 / (L * L)]
    creep[:, 0, 0] = L, free
    return CoverRows(0, coefficients, creep, np.array([L, lam, free, *np.zeros(5)]))


def _end(places: Floats, values: Floats, wanted: Floats) -> tuple[Floats, Floats]:
    """x P(x) at ``wanted`` and its slope over ln x, P of degree 11 nearest to the values at places in [0.05, 1]."""
    from numpy.polynomial.chebyshev import chebder, chebfit, chebval

    terms = chebfit(2.0 * places - 1.0, values.T, _END_DEGREE)
    P, slope = chebval(2.0 * wanted - 1.0, terms), 2.0 * chebval(2.0 * wanted - 1.0, chebder(terms))
    return wanted * P, wanted * (P + wanted * slope)


def _at_end(places: Floats, values: Floats) -> float:
    """The value at 0 of the polynomial nearest to these at places in [0.05, 1]."""
    return float(np.polynomial.chebyshev.Chebyshev.fit(places, values, _END_DEGREE, [0.0, 1.0])(0.0))


@lru_cache(maxsize=1)
def _interpolation() -> tuple[Floats, Floats]:
    """From values at the nodes around an octave to values, and to slopes over ln u, at the nodes of its row."""
    count = PER_OCTAVE + 2 * _ASIDE + 1
    nodes = (np.arange(count) - _ASIDE) / PER_OCTAVE
    weights = np.array([(-1.0) ** k * math.comb(count - 1, k) for k in range(count)])
    places = np.log2(0.5 * (to_doubles(chebyshev(TERMS)) + 3.0))
    per = 1.0 / (places - nodes[:, None])
    terms = weights[:, None] * per
    basis = terms / terms.sum(axis=0)
    slopes = basis * ((terms * per).sum(axis=0) / terms.sum(axis=0) - per)
    return basis, slopes / math.log(2.0)


def _over_stick(rows: Rows, powers: Floats, limits: Floats) -> tuple[Floats, Floats]:
    """(eta/F and H/F^2 at the nodes of v = 2 u/L(u), their slopes over ln v).

    Where the stick zone has the creep limit F' = w/(2 u), its law is that of the whole contact at the speed u' with
    L(u')/(2 u') = F': H/F^2 = 1/L(u')^2 and eta/F = lam(u')/L(u').
    """
    v = rows.x.ravel()
    u = v.copy()
    for _ in range(60):
        (L, lam), (d_L, d_lam) = _lengths(rows, powers, limits, u)
        step = np.log(v * L / (2.0 * u)) / (1.0 - d_L / L)
        u *= np.exp(step)
        if np.abs(step).max() < 1e-15:
            break
    (L, lam), (d_L, d_lam) = _lengths(rows, powers, limits, u)
    turn = 1.0 / (1.0 - d_L / L)
    share, press = lam / L, 1.0 / (L * L)
    slopes = turn * np.stack([share * (d_lam / lam - d_L / L), -2.0 * press * d_L / L])
    return np.stack([share, press]).reshape(2, *rows.x.shape), slopes.reshape(2, *rows.x.shape)


def _lengths(rows: Rows, powers: Floats, limits: Floats, u: Floats) -> tuple[Floats, Floats]:
    """(L and lam at u, their slopes over ln u), by the rows and, behind them, by their limits."""
    end = math.nextafter(math.ldexp(1.0, rows.e0 + rows.count - 1), 0.0)
    values, slopes = rows.read(powers[[_LIMIT, _LAM]], np.minimum(u, end))
    first = limits[3:5, None] / u
    return np.where(u > end, limits[:2, None] + first, values), np.where(u > end, -first, slopes)
