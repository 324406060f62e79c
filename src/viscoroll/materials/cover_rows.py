"""The law of a cover over speed: what :mod:`.cover_solve` finds at nodes of u = kappa |V|, as rows of polynomials.

A scene fixes l0/h, so that theta = lam l0/(2 h) follows from the half length that carries the load; all quantities are
then smooth functions of u alone.  They are found at twelve nodes an octave, from slow to fast, each from what the last ones
say of it.  Octaves are interpolated between these; below the first octave a polynomial of u, beyond the last one a
polynomial of 1/u takes over, both with the limits of elastic layers.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from ..core.errors import ParameterError
from ..core.typed import Floats
from ..kernels.numerics.nodes import chebyshev, rounded
from .cover_solve import MOST_THETA, CoverModes, CoverState, local_strain, solve
from .law_build import FUNCTIONS, TERMS, Rows

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
#: last nodes that a node is extrapolated from
_EXTRAPOLATED = 8


class CoverRows(NamedTuple):
    """The rows of a cover.

    e0 : the first row holds [0, 2^e0), each of the others an octave.
    coefficients : (rows, 24 powers, 7 functions) as of a half-space, without N.
    creep : (2, rows, 24 powers) of L = 2 kappa delta_star/mu and of 2 kappa delta_0, over u.
    limits : for u -> infinity, (L, lam, 2 kappa delta_0), and the factors of 1/u that each of the first order has;
        then epsilon u, M u^2/V and 0.
    """

    e0: int
    coefficients: Floats
    creep: Floats
    limits: Floats


def cover_rows(modes: CoverModes, thickness: float, side: float, on_base: bool) -> CoverRows:
    """The rows of one cover.

    Parameters
    ----------
    modes : of the cover.
    thickness : over l0.
    side : sign of delta_0 where the surface of the cover is stretched: 1 on the base, -1 on the cylinder.
    on_base : whether M is the half-space's.

    Raises
    ------
    ParameterError
        A cover so thin that the half length at rest is more than six thicknesses.
    """
    slow_limit = _elastic(modes, thickness, 1.0)
    if slow_limit[_LAM] * 0.5 / thickness > MOST_THETA:
        most = f"at least {slow_limit[_LAM] * 0.5 / MOST_THETA:.3g} for half a contact of at most {MOST_THETA:g} thicknesses"
        raise ParameterError("thickness", f"{thickness:g} (over l0)", most)
    if not modes.a.size:
        return _constant(slow_limit, side)
    from .law_build import octaves

    e0 = int(octaves(modes.b[0], modes.a[-1])[0])
    last = math.frexp(modes.a[-1] * max(1.0, thickness))[1] + _FAST_OCTAVES
    first = e0 * PER_OCTAVE - _END_NODES + 1
    u = np.exp2(np.arange(first, last * PER_OCTAVE + _END_NODES) / PER_OCTAVE)
    values = _march(modes, thickness, u, slow_limit[_LAM])
    fast_limit = _elastic(modes, thickness, modes.alpha)
    values[_FREE], slow_limit[_FREE], fast_limit[_FREE] = (side * each[_FREE] for each in (values, slow_limit, fast_limit))
    rows = Rows(e0, last - e0 + 1 + _BEYOND)
    found, slopes = (np.empty((5, *rows.x.shape)) for _ in range(2))
    # the slow row: limits, or 0, and u times a polynomial of u
    y, near = u[:_END_NODES] / math.ldexp(1.0, e0), values[:, :_END_NODES]
    slow_limit[_FREE] = _at_end(y, near[_FREE])
    found[:, 0], slopes[:, 0] = _end(y, (near - slow_limit[:, None]) / y, rows.t[0])
    found[:, 0] += slow_limit[:, None]
    # octaves
    inside = last - e0
    windows = np.lib.stride_tricks.sliding_window_view(values, PER_OCTAVE + 2 * _ASIDE + 1, axis=1)
    begin = e0 * PER_OCTAVE - _ASIDE - first + PER_OCTAVE * np.arange(inside)
    by_value, by_slope = _interpolation()
    found[:, 1 : inside + 1], slopes[:, 1 : inside + 1] = windows[:, begin] @ by_value, windows[:, begin] @ by_slope
    # beyond: limits and 1/u, for epsilon u and for M u^2
    end, ends = np.ldexp(1.0, last), slice(u.size - _END_NODES, u.size)
    y, x = end / u[ends], rows.x[inside + 1 :]
    fast_limit[_FREE] = _at_end(y, values[_FREE, ends])
    fall = (values[:, ends] - fast_limit[:, None]) / y
    fall[_MOMENT] /= y
    there, rising = _end(y, fall, (end / x).ravel())
    there, rising = there.reshape(5, *x.shape), -rising.reshape(5, *x.shape)
    slope_of_moment = end / x * (rising[_MOMENT] - there[_MOMENT])
    there[_MOMENT] *= end / x
    rising[_MOMENT] = slope_of_moment
    found[:, inside + 1 :], slopes[:, inside + 1 :] = there + fast_limit[:, None, None], rising
    powers = rows.fit_slopes(found, slopes)
    powers[:, 0, 0] = slow_limit
    first_order = _end(y, fall, np.full(1, 1e-6))[0][:, 0] * (1e6 * end)
    first_order[_MOMENT] *= end
    limits = [*fast_limit[[_LIMIT, _LAM, _FREE]], *first_order[[_LIMIT, _LAM, _FREE]], *first_order[[_EPSILON, _MOMENT]], 0.0]
    stick, d_stick = _over_stick(rows, powers, np.array(limits))
    share, press = rows.fit_slopes(stick, d_stick)
    half_space, cylinder = (powers[_MOMENT], 0.0 * press) if on_base else (0.0 * press, powers[_MOMENT])
    N = np.full_like(press, np.nan)
    columns = dict(lam=powers[_LAM], epsilon=powers[_EPSILON], m_half_space=half_space, m_cylinder=cylinder, N=N, share=share, press=press)
    coefficients = np.stack([columns[name] for name in FUNCTIONS], axis=-1)
    return CoverRows(e0, coefficients, powers[[_LIMIT, _FREE]], np.array(limits))


def quantities(state: CoverState, z: float, u: float) -> Floats:
    """lam, L, 2 kappa delta_0, epsilon and M/V of a solve at u."""
    return np.array([2.0 * z * u, 2.0 * u * state.creep_limit, 2.0 * u * state.strain, state.shift / z, state.moment])


def at_speed(modes: CoverModes, thickness: float, u: float, *, orders: int | None = None) -> Floats:
    """lam, L, 2 kappa delta_0 (of a cover on the base), epsilon and M/V at u, by the solve alone: what rows are
    compared with."""
    z = 0.5 / u / math.sqrt(1.0 + (modes.alpha - 1.0) * u / (u + 1.0)) / (1.0 + 0.2 / thickness)
    return _node(modes, thickness, u, math.log(z), 2.0, orders)[0]


def _node(
    modes: CoverModes, thickness: float, u: float, guess: float, slope: float, orders: int | None = None, factor: float = 1.0
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
            # ln z falls nearly like -ln u: the rest is extrapolated
        found[:, n], logs[n], slope = _node(modes, thickness, each, guess, slope)
    return found


def _elastic(modes: CoverModes, thickness: float, alpha: float) -> Floats:
    """What is computed, of the layer with its long-time stiffness (alpha = 1) or its instantaneous one, with epsilon = 0.

    At long times M/V is T_mean, else 0.
    """
    instant = alpha != 1.0
    share = modes.layer_instant * modes.alpha if instant else modes.share
    elastic = modes.elastic(share)
    z = 0.5 / (1.0 + 0.2 / thickness)
    # slopes and creep of an elastic layer depend on its shape alone
    found = _node(elastic, thickness, 0.5, math.log(z / math.sqrt(alpha)), 2.0, factor=alpha)[0]
    found[_EPSILON], found[_MOMENT] = 0.0, 0.0 if instant else float(modes.e @ modes.e)
    return found


def _constant(limit: Floats, side: float) -> CoverRows:
    """The one row of a cover that does not relax."""
    coefficients, creep = np.zeros((1, TERMS, len(FUNCTIONS))), np.zeros((2, 1, TERMS))
    L, W = limit[_LIMIT], side * limit[_FREE]
    coefficients[0, 0] = [limit[_LAM], 0.0, 0.0, 0.0, np.nan, limit[_LAM] / L, 1.0 / (L * L)]
    creep[:, 0, 0] = L, W
    return CoverRows(0, coefficients, creep, np.array([L, limit[_LAM], W, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]))


def _end(places: Floats, values: Floats, wanted: Floats) -> tuple[Floats, Floats]:
    """x P(x) at ``wanted`` and its slope over ln x, P of degree 11 nearest to the values at places in [0.05, 1]."""
    from numpy.polynomial.chebyshev import chebder, chebfit, chebval

    terms = chebfit(2.0 * places - 1.0, values.T, _END_DEGREE)
    P, slope = chebval(2.0 * wanted - 1.0, terms), 2.0 * chebval(2.0 * wanted - 1.0, chebder(terms))
    return wanted * P, wanted * (P + wanted * slope)


def _at_end(places: Floats, values: Floats) -> float:
    """The value at 0 of the polynomial nearest to these at places in [0.05, 1]: the strain by the pressure is too
    inaccurate for its limit to be computed apart."""
    return float(np.polynomial.chebyshev.Chebyshev.fit(places, values, _END_DEGREE, [0.0, 1.0])(0.0))


@lru_cache(maxsize=1)
def _interpolation() -> tuple[Floats, Floats]:
    """From values at the nodes around an octave to values, and to slopes over ln u, at the nodes of its row."""
    count = PER_OCTAVE + 2 * _ASIDE + 1
    nodes = (np.arange(count) - _ASIDE) / PER_OCTAVE
    weights = np.array([(-1.0) ** k * math.comb(count - 1, k) for k in range(count)])
    places = np.log2(0.5 * (rounded(chebyshev(TERMS)) + 3.0))
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
