"""The law of a cover over speed: solutions of :mod:`.cover_solve` at nodes of u = kappa |V|, as rows of polynomials.

A scene fixes l0/h, so that theta = lam l0/(2 h) follows from the half contact length that carries the load; all
quantities are then smooth functions of u alone.  They are computed at twelve nodes an octave, from slow to fast, each
from a start that is extrapolated from the nodes before.  Octaves are interpolated between these nodes.  Below the first
octave there is a polynomial of u, beyond the last one a polynomial of 1/u, both with the limits of elastic layers.
Beside a half-space that relaxes too, that of 1/u has a second one times ln u: long waves then have a memory of their
own, which the core does not cut off.

The five quantities of a node, in the order of the indices below, are lam, L = 2 kappa delta_star/mu, 2 kappa delta_0,
epsilon and M/V, dimensionless, with M in units of P R, V in units of R/T_ref, and T_ref the unit of time of the cover's
series.  Until :func:`cover_rows` has set its sign, delta_0 is that of a cover on the base.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ...core.array_types import Floats
from ...core.errors import ParameterError
from ..cover import Cover
from .cover_pressure import local_strain
from .cover_solve import LARGEST_THETA, CoverModes, solve
from .pack import CoverRows, constant_rows, steady_table
from .rows import NODES, Rows, row_range

#: nodes an octave of u at which the cover is solved; with 12 and the neighbours below rows agree with the solve to
#: 1e-11
PER_OCTAVE = 12
#: nodes on either side of an octave that take part in its polynomial; with 18 it is accurate to rounding
_ASIDE = 18
#: imaginary step for derivatives, relative or of log2 u; its square is far below rounding, dimensionless
_TINY = 1e-30
#: index of lam among the quantities that are computed at the nodes
_LAM = 0
#: index of L = 2 kappa delta_star/mu
_LIMIT = 1
#: index of 2 kappa delta_0 of a cover on the base
_FREE = 2
#: index of epsilon
_EPSILON = 3
#: index of M/V
_MOMENT = 4
#: octaves between the fastest rate (times the thickness divided by l0 for thick covers) and the row in 1/u
_FAST_OCTAVES = 4
#: octaves of rows beyond those, after which the first order in 1/u is accurate to rounding
_BEYOND = 42
#: nodes of the polynomials at either end, from 0.05 to 1 of their range: wide enough for the noise of the solve, which
#: loses digits there, not to be amplified at 0
_END_NODES = 52
#: degree of these polynomials
_END_DEGREE = 12
#: degree of that of delta_0, which for nu < 1/2 has a term u^2 ln u at low speed, from the memory of the pressure near
#: the edges: with 12 delta_0 jumped by 2e-10 of delta_star/mu where the first octave begins, with 18 by 3e-13
_STRAIN_DEGREE = 18
#: terms in ln u of the rows beyond the last octave where the other body, a half-space, relaxes too: without them M was
#: wrong by 1 % at a thousand times the fastest rate, with two it is by 1e-9; more terms amplify the noise of the solve
_LOG_TERMS = 2
#: the secant method ends where the product of the last two relative errors of the load is below this: the next step
#: then leaves an error below rounding
_LOAD_ERRORS = 1e-14
#: least distance of two points of the secant method in ln z, for which rounding does not dominate the slope
_LEAST_STEP = 1e-8
#: most steps of the secant method; it needs 4 to 6
_MOST_STEPS = 40
#: thickness divided by l0 below which the half contact is longer than six thicknesses for any nu, and nothing is solved
_THINNEST = 0.01
#: factors of ln z at the last eight nodes in its extrapolation to the next one, the start of the secant method there
_EXTRAPOLATION = np.array([(-1.0) ** (k + 1) * math.comb(8, k) for k in range(8, 0, -1)])


def cover_rows(cover: Cover, thickest: float | None = None) -> CoverRows:
    """Compute the law of a cover over all speeds; takes 0.1 to 0.3 s.

    cover: one :class:`..cover.Cover`, of a single thickness and Poisson's ratio.
    thickest: thickness divided by l0 that determines the number of rows in place of that of the cover, for several
        covers to have as many; None: that of the cover.  It has no effect for elastic bodies.
    Returns :class:`.pack.CoverRows`: e0, exponent of the end of the first row; coefficients of the law, (rows, 24
    powers, 7 functions); creep, rows of L = 2 kappa delta_star/mu and of 2 kappa delta_0, (2, rows, 24 powers); limits
    of the functions for u -> infinity, (8,).  Of elastic bodies it is a single row of constants, with epsilon = M = 0.
    Raises ParameterError for a cover so thin that the half contact at rest is longer than six thicknesses, and where at
    some speed no contact length that carries the load is found.
    """
    # a stretched surface makes delta_0 positive on the base, which then has all of M, and negative on the cylinder
    modes, thickness, side = CoverModes(cover), cover.thickness, 1.0 if cover.on == "base" else -1.0
    slow_limit = _solve_elastic(modes, modes.share, 1.0) if thickness > _THINNEST else None
    if slow_limit is None or slow_limit[_LAM] > 2.0 * LARGEST_THETA * thickness:
        allowed = f"larger: half the contact at rest may be at most {LARGEST_THETA:g} thicknesses long"
        raise ParameterError("thickness/l0", f"{thickness:.3g}", allowed)
    if not modes.series.a.size:
        lam, L, free = slow_limit[_LAM], slow_limit[_LIMIT], side * slow_limit[_FREE]
        table = steady_table(constant_rows(lam, 0.0, 0.0, 0.0, lam / L, 1.0 / (L * L)))
        return CoverRows(0, table, constant_rows(L, free), np.array([L, lam, free, *np.zeros(5)]))
    fast_limit = _solve_elastic(modes, min(modes.layer_instant * modes.alpha, 1.0), modes.alpha)
    slow_limit[_MOMENT] = float(modes.series.e @ modes.series.e) if modes.share == 1.0 else math.nan
    # the solve loses digits of delta_0: its limits are extrapolated, to join the values at the nodes
    slow_limit[_FREE] = fast_limit[_FREE] = math.nan
    e0 = int(row_range(modes.series.b[0], modes.series.a[-1])[0])
    last = math.frexp(modes.series.a[-1] * max(1.0, thickest or thickness))[1] + _FAST_OCTAVES
    first_node = e0 * PER_OCTAVE - _END_NODES + 1
    u = np.exp2(np.arange(first_node, last * PER_OCTAVE + _END_NODES) / PER_OCTAVE)
    values = _solve_nodes(modes, u)
    values[_FREE] *= side
    rows = Rows(e0, last - e0 + 1 + _BEYOND)
    y = np.ldexp(u[:_END_NODES], -e0)
    slow_limit, _, slow = _fit_end(y, values[:, :_END_NODES], slow_limit, rows.t[0])
    inside = _interpolate_octaves(values, e0 * PER_OCTAVE - first_node, last - e0)
    x = rows.x[last - e0 + 1 :]
    log_terms = _LOG_TERMS if cover.other.alpha > 1.0 else 0
    fast, limits = _fit_fast_rows(
        u[-_END_NODES:], values[:, -_END_NODES:], fast_limit, x, math.ldexp(1.0, last), log_terms
    )
    powers = rows.fit_slopes(*np.concatenate([slow[:, :, None], inside, fast], axis=2))
    powers[:, 0, 0] = slow_limit
    share, press = rows.fit_slopes(*_stick_functions(rows, powers, limits))
    nothing = np.zeros_like(press)
    bodies = (powers[_MOMENT], nothing) if side > 0.0 else (nothing, powers[_MOMENT])
    table = steady_table([powers[_LAM], powers[_EPSILON], *bodies, share, press])
    return CoverRows(e0, table, powers[[_LIMIT, _FREE]], limits)


def solve_at_speed(cover: Cover, u: float, *, orders: int | None = None) -> Floats:
    """Solve one state of a cover, without rows; the rows are compared with it in tests.

    cover: one :class:`..cover.Cover`.
    u: kappa |V|, dimensionless, > 0.
    orders: number of terms of the pressure; None: as many as rows are made with (:func:`.cover_solve.solve`).
    Returns lam, L = 2 kappa delta_star/mu, 2 kappa delta_0 of a cover on the base, epsilon and M/V, dimensionless,
    (5,).  For a cover on the cylinder delta_0 has the other sign.
    Raises ParameterError where no contact length that carries the load is found; a contact that is longer than rows
    allow, half of it beyond six thicknesses, is not refused.
    """
    return _solve_node(CoverModes(cover), u, orders=orders)[0]


def _solve_node(
    modes: CoverModes,
    u: float,
    start: float | None = None,
    slope: float = 2.0,
    orders: int | None = None,
    stiffness: float = 1.0,
) -> tuple[Floats, float, float]:
    """Solve for the half contact length that carries the load at one speed, by the secant method.

    The unknown is ln z, z the half contact length divided by V T_ref; the equation is ln H = -ln(4 stiffness u^2) with
    the load H of :class:`.cover_solve.CoverState`.  At the end all quantities are extrapolated by the last secant step.
    modes: :class:`CoverModes` of the cover and the other body.
    u: kappa |V|, dimensionless, > 0.
    start: first approximation of ln z; None: that of a half-space of a stiffness between slow and fast, shortened for a
        thin cover.
    slope: first approximation of d ln H/d ln z, > 0; 2 is that of a half-space.
    orders: number of terms of the pressure; None: the default of the solve.
    stiffness: instantaneous divided by long-time stiffness, to solve fast rolling with the ``modes`` of elastic bodies;
        1: the modes have their own stiffness.
    Returns (lam, L = 2 kappa delta_star/mu, 2 kappa delta_0 of a cover on the base, epsilon and M/V, (5,),
    dimensionless; ln z after the last secant step; d ln H/d ln z of that step, limited to [0.5, 8]).
    Raises ParameterError where the secant method has not ended after 40 solves.
    """
    goal, previous, thickness = -math.log(4.0 * stiffness * u * u), None, modes.cover.thickness
    if start is None:
        start = 0.5 * goal - 0.5 * math.log1p((modes.alpha - 1.0) * u / (u + 1.0)) - math.log1p(0.2 / thickness)
    y = start
    for _ in range(_MOST_STEPS):
        z = math.exp(y)
        state = solve(modes, z, z * u / thickness, orders)
        error = math.log(state.load) - goal
        lengths = 2.0 * z * u, 2.0 * u * state.creep_limit, 2.0 * u * state.strain
        values = np.array([*lengths, state.shift / z, state.moment])
        if previous is not None:
            slope = min(max((error - previous[1]) / (y - previous[0]), 0.5), 8.0)
        step = -error / slope
        if previous is not None and abs(error * previous[1]) < _LOAD_ERRORS:
            # also the local strain is extrapolated by the last step, lest it jump from node to node
            part = step / (y - previous[0])
            values = values + (values - previous[2]) * part
            local, before = (local_strain(modes, *each) for each in ((z, state), previous[3]))
            values[_FREE] += 2.0 * u * (local + (local - before) * part)
            return values, y + step, slope
        previous = y, error, values, (z, state)
        y += min(max(step, -0.7), 0.7) if abs(step) > _LEAST_STEP else math.copysign(_LEAST_STEP, step)
    raise ParameterError("thickness/l0", f"{thickness:g}", "larger: no contact length with this load was found")


def _solve_nodes(modes: CoverModes, u: Floats) -> Floats:
    """Solve the states of a cover at increasing speeds, each from a start that is extrapolated from the eight before.

    The first eight nodes have no extrapolation and take the start of :func:`_solve_node`; the slope of the secant
    method is passed from node to node.
    modes: :class:`CoverModes` of the cover and the other body.
    u: kappa |V|, dimensionless, evenly spaced in ln u, ascending, (n,).
    Returns lam, L = 2 kappa delta_star/mu, 2 kappa delta_0 of a cover on the base, epsilon and M/V at each node, (5,
    n), dimensionless.
    Raises ParameterError where no contact length that carries the load is found.
    """
    values, logs, slope = np.empty((5, u.size)), np.empty(u.size), 2.0
    for n, speed in enumerate(u.tolist()):
        start = float(_EXTRAPOLATION @ logs[n - _EXTRAPOLATION.size : n]) if n >= _EXTRAPOLATION.size else None
        values[:, n], logs[n], slope = _solve_node(modes, speed, start, slope)
    return values


def _solve_elastic(modes: CoverModes, share: float, stiffness: float) -> Floats:
    """Solve the cover with elastic bodies: the limit of slow rolling, all relaxation completed, or of fast rolling.

    lam is the contact length divided by l0, delta_star the critical creepage, delta_0 the creepage of free rolling,
    epsilon the shift of the contact ahead of the axis in half contact lengths.  lam, L and delta_0 of elastic bodies do
    not depend on the speed, so that one solve, at u = 1/2, gives them.  In fast rolling all compliances are divided by
    alpha.  Then the length that carries the load is that of a load alpha times smaller on bodies of the long-time
    stiffness, and the slopes and creep of elastic bodies depend on that length and the layer's part of the compliance
    alone: bodies of the long-time stiffness are solved in both limits, under a load that ``stiffness`` divides.
    modes: :class:`CoverModes` of the viscoelastic bodies, of which the Poisson's ratios and the thickness are taken.
    share: the layer's part of the compliance of both bodies, in (0, 1]: of long times for slow rolling, of the
        instantaneous compliance for fast rolling.
    stiffness: stiffness of the bodies divided by their long-time stiffness: 1 for slow rolling, alpha for fast rolling.
    Returns lam, L = 2 kappa delta_star/mu, 2 kappa delta_0 of a cover on the base, epsilon and M/V, (5,),
    dimensionless, the last two exactly 0.
    Raises ParameterError where no contact length that carries the load is found.
    """
    values = _solve_node(modes.elastic(share), 0.5, stiffness=stiffness)[0]
    values[[_EPSILON, _MOMENT]] = 0.0
    return values


def _fit_fast_rows(
    u: Floats, values: Floats, limits: Floats, x: Floats, begin: float, log_terms: int
) -> tuple[Floats, Floats]:
    """Fit the rows beyond the last octave, where lam, L, 2 kappa delta_0, epsilon and M u/V are polynomials of 1/u.

    Beside a half-space that relaxes too, a second polynomial of 1/u, of ``log_terms`` terms, times ln u is added.
    u: last nodes of the solve, ascending, from ``begin`` to at most 20 ``begin``, (n,), dimensionless.
    values: lam, L, 2 kappa delta_0, epsilon and M/V there, (5, n); not changed.
    limits: of these for u -> infinity, (5,); NaN (delta_0): not known, then the value of a fitted polynomial at 1/u = 0
        is taken.  Those of epsilon and M/V are 0.
    x: nodes of these rows in u, ascending, >= ``begin``, (rows, nodes).
    begin: u where these rows begin, the end of the last octave.
    log_terms: number of terms in ln u, as of :func:`_fit_end`.
    Returns (values and slopes over ln u at x, of the five quantities, (2, 5, rows, nodes);
    :attr:`.pack.CoverRows.limits`, (8,), of which the last five, factors of 1/u, are those at the last node of x).
    """
    y, x_inverse = begin / u, (begin / x).ravel()
    values = values.copy()
    values[_MOMENT] /= y
    limits, first, (fitted, slopes) = _fit_end(y, values, limits, x_inverse, log_terms)
    fitted[_MOMENT], slopes[_MOMENT] = fitted[_MOMENT] * x_inverse, (slopes[_MOMENT] + fitted[_MOMENT]) * x_inverse
    first *= begin
    first[_MOMENT] *= begin
    order = [_LIMIT, _LAM, _FREE]
    packed = np.array([*limits[order], *first[order], *first[[_EPSILON, _MOMENT]]])
    return np.stack([fitted, -slopes]).reshape(2, len(values), *x.shape), packed


def _fit_end(
    y: Floats, values: Floats, limits: Floats, wanted: Floats, log_terms: int = 0
) -> tuple[Floats, Floats, Floats]:
    """Fit values = limit + y (P(y) + R(y) ln y) with polynomials P and R, by least squares, at one end of the speeds.

    The degree of P is 18 for 2 kappa delta_0 and 12 for the others.
    y: nodes, proportional to u at the slow end and to 1/u at the fast end, in [0.05, 1], (n,).
    values: lam, L, 2 kappa delta_0, epsilon and M/V at the nodes (at the fast end M/(V y)), (5, n).
    limits: values for y -> 0, (5,); for NaN the value at 0 of a polynomial through the values is taken.
    wanted: points in (0, 1], (m,), m >= 1.
    log_terms: number of terms of R; 0: none.
    Returns (limits, (5,), with the values at 0 in place of NaN; P + R ln y at the last of the points, (5,); values and
    derivatives with respect to ln y at the points, (2, 5, m)).
    """
    from numpy.polynomial.chebyshev import chebvander

    def basis(y: Any, n: int, log_terms: int) -> Any:
        """Return the terms of quantity ``n`` at points ``y``, (points,), real or complex, (points, terms): Chebyshev
        polynomials of 2 y - 1, then the first ``log_terms`` of them times ln y.
        """
        terms = chebvander(2.0 * y - 1.0, _STRAIN_DEGREE if n == _FREE else _END_DEGREE)
        return np.hstack([terms, np.log(y)[:, None] * terms[:, :log_terms]])

    def fit(values: Floats, at: Any, log_terms: int) -> Any:
        """Fit each quantity to its ``values`` at the nodes y, (5, n), by its :func:`basis` with ``log_terms``, and
        return the fits at the points ``at``, (points,), as (5, points), complex where ``at`` is.
        """
        fits = (np.linalg.lstsq(basis(y, n, log_terms), row, rcond=None)[0] for n, row in enumerate(values))
        return np.array([basis(at, n, log_terms) @ terms for n, terms in enumerate(fits)])

    limits = np.where(np.isnan(limits), fit(values, np.array([_TINY]), 0)[:, 0], limits)[:, None]
    # slopes by a step in the imaginary direction, which cancels no digits
    P = fit((values - limits) / y, wanted * (1.0 + 1j * _TINY), log_terms)
    value, slope = P.real, P.imag / _TINY
    return limits[:, 0], value[:, -1], np.stack([wanted * value + limits, wanted * (value + slope)])


def _interpolate_octaves(values: Floats, begin: int, count: int) -> Floats:
    """Interpolate from the nodes of the solve to those of octaves, by polynomials through 49 nodes, barycentric.

    values: lam, L, 2 kappa delta_0, epsilon and M/V at the nodes of the solve, which are evenly spaced in log2 u, 12 an
        octave, (5, n).
    begin: index of the node where the first octave begins, at least 18; 18 nodes before each octave and 18 after it
        are used.
    count: number of octaves.
    Returns values and slopes over ln u at the 24 nodes of each octave, (2, 5, octaves, 24).
    """
    points = PER_OCTAVE + 2 * _ASIDE + 1
    nodes = (np.arange(points) - _ASIDE) / PER_OCTAVE
    weights = np.array([(-1.0) ** k * math.comb(points - 1, k) for k in range(points)])
    # slopes by a step in the imaginary direction, which cancels no digits
    terms = weights[:, None] / (np.log2(0.5 * (NODES + 3.0)) + 1j * _TINY - nodes[:, None])
    basis = terms / terms.sum(axis=0)
    windows = np.lib.stride_tricks.sliding_window_view(values, points, axis=1)
    around = windows[:, begin - _ASIDE + PER_OCTAVE * np.arange(count)]
    return np.stack([around @ basis.real, around @ basis.imag / (_TINY * math.log(2.0))])


def _stick_functions(rows: Rows, powers: Floats, limits: Floats) -> tuple[Floats, Floats]:
    """Return eta/F and H/F^2 of a cover at the nodes of v = 1/F(eta), and their derivatives with respect to ln v.

    Where the stick zone has the creep limit F' = w/(2 u), w = L - 2 kappa |delta - delta_0|/mu, its law is taken as
    that of the whole contact at the speed u' with L(u')/(2 u') = F'.  So v = 2 u'/L(u'), H/F^2 = 1/L(u')^2 and eta/F =
    lam(u')/L(u').  That u' is found by Newton's method in ln u', from u' = v, until all steps are below 1e-15, in at
    most 60 steps; nothing is raised if it takes more.

    rows: octaves of u and of v, as :class:`.rows.Rows`.
    powers: coefficients of lam, L, 2 kappa delta_0, epsilon and M/V over u, (5, rows, 24); lam and L are read.
    limits: :attr:`.pack.CoverRows.limits`, (8,), which with the first order in 1/u give lam and L beyond the last row.
    Returns two arrays (2, rows, 24 nodes), dimensionless: (eta/F, H/F^2), and their derivatives.
    """
    v = rows.x.ravel()
    u, end = v.copy(), math.nextafter(math.ldexp(1.0, rows.e0 + rows.count - 1), 0.0)
    for _ in range(60):
        values, slopes = rows.read(powers[[_LIMIT, _LAM]], np.minimum(u, end))
        first = limits[3:5, None] / u
        (L, lam), (d_L, d_lam) = np.where(u > end, [limits[:2, None] + first, -first], [values, slopes])
        dlnu_dlnv, share, press = 1.0 / (1.0 - d_L / L), lam / L, 1.0 / (L * L)
        step = np.log(v * L / (2.0 * u)) * dlnu_dlnv
        if np.abs(step).max() < 1e-15:
            break
        u *= np.exp(step)
    slopes = dlnu_dlnv * np.stack([share * (d_lam / lam - d_L / L), -2.0 * press * d_L / L])
    return np.stack([share, press]).reshape(2, *rows.x.shape), slopes.reshape(2, *rows.x.shape)
