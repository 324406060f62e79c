"""The law of a cover over speed, as rows; and what shear does in its contact, to first order.

Notation as in :mod:`.cover_solve`.

**Shear.**  With C the coupling of both bodies, that of the base less that of the cylinder, the
pressure p strains the surfaces by u' = -C p, and a traction q changes their slopes by C q
(docs/theory_covers.md):

- Stick without slip: T q - C p = delta with the pressure of the contact without shear.  Its
  creepage, less half of Q times the creep limit of full slip, is delta_f, the creepage of free
  rolling.
- Full slip, q = Q p: the slopes change by C q = Q C p.  At a given half length z the contact then
  carries another load and is shifted by another amount, to first order in Q.
- M of full slip changes by -delta_0* Q, with delta_0* the mean strain mirrored about the middle of
  the contact.

All of these are linear in C, so that each body has its part.

**Rows.**  The law over speed is solved by :mod:`.cover_solve` at nodes of u = kappa |V|, and rows
of polynomials are fitted to the solutions.  A scene fixes l0/h, so that theta = lam l0/(2 h)
follows from the half contact length that carries the load; all quantities are then smooth
functions of u alone.  They are computed at twelve nodes an octave, from slow to fast, each from a
start that is extrapolated from the nodes before.  Octaves are interpolated between these nodes.
Below the first octave there is a polynomial of u, beyond the last one a polynomial of 1/u, both
with the limits of elastic layers.  Beside a half-space that relaxes too, that of 1/u has a second
one times ln u: long waves then have a memory of their own, which the core does not cut off.

The eleven quantities of a node, in the order of the indices below, are

- lam, L = 2 kappa delta_star/mu, epsilon;
- M/V of the base and of the cylinder, with M in units of P R and V in units of R/T_ref, where T_ref
  is the unit of time of the cover's series;
- f of the base and of the cylinder, whose sum is 2 kappa delta_f;
- g of the base and of the cylinder, whose sum is 2 kappa (delta_0* - delta_f);
- lam_Q and epsilon_Q, the derivatives of lam and epsilon with respect to Q.

All are dimensionless (:mod:`.cover_law` has the formulas in which they enter).
"""

import math
from typing import Any, NamedTuple

import numpy as np

from ..core import Floats, ParameterError
from ..materials import Cover
from .cover_solve import (
    LARGE_ALPHA,
    LARGEST_THETA,
    CoverModes,
    CoverState,
    decays,
    layer_operator,
    local_pressure,
    solve,
    term_count,
)
from .law_rows import PER_OCTAVE, SHORT_TERMS, Rows, e0_and_row_count, fit_end, interpolate_octaves
from .row_layout import CoverRows, constant_rows, steady_table

# --- What shear does in the contact of a cover, to first order ---

#: least number of terms with which :func:`.cover_solve.solve` is called where shear matters: for
#: nu < 1/2 its coupling has terms of all orders, and a number that changes with the speed would
#: make it jump
LEAST_TERMS = 30
#: highest order of the local coupling, whose terms fall as 1/n^2: highest of
#: :func:`.cover_solve.decays`
_LOCAL_ORDERS = 100


class Shear(NamedTuple):
    """What shear does to a contact, dimensionless; slopes and creep in units of V T_ref/R; the base
    comes first.

    moments : M/V of each body, with M divided by P R and V by R/T_ref, (2,).
    free : parts of each body in the creepage without creep force with stick, (2,).
    mirrored : parts of each body in delta_0*, (2,).
    load : relative change of H with Q at fixed z, in full slip.
    shift : change of the shift g with Q at fixed z.
    """

    moments: Floats
    free: Floats
    mirrored: Floats
    load: float
    shift: float


def shear_of(modes: CoverModes, z: float, state: CoverState) -> Shear:
    """Return what shear does to a contact of half length z that :func:`.cover_solve.solve` has
    found.

    modes: :class:`CoverModes` of the bodies.
    z: half contact length divided by V T_ref, dimensionless, > 0.
    state: :class:`CoverState` of that length.
    Returns :class:`Shear`.
    """
    s, excess = _sources(modes, state)
    # minus the mean of C p, with the square of the transform, where the mean itself has that of its
    # magnitude: it is the mirrored one
    strain = modes.C * (state.own * state.transform**2).real / state.v
    mirrored = -2.0 / state.q[0] * (modes.mine @ strain)
    if any(body.local for body in modes.bodies):
        terms, local_mirrored = local_pressure(modes, z, state)
        # ahead of the edge there is no pressure, while the series goes on
        s += terms[: len(s)]
        excess -= decays(modes.series.b * z, _LOCAL_ORDERS).T @ terms[: _LOCAL_ORDERS + 1]
        mirrored -= local_mirrored
    # L and T - L together: the layers' tangential displacement by shear
    S, c = layer_operator(state.A, state.memory, (modes.L + modes.shear) * state.part)
    Phi = 2.0 * state.exponentials.ratio[1:]
    # the strain C p of each body, which the traction of stick takes back, (N, 2)
    right = Phi @ (state.Xi @ excess) + s[1:]
    stick = np.linalg.solve(np.eye(state.q.size) + S[1:] + Phi @ (state.Xi @ c), right)
    creep = _shift(modes, state, c @ stick - excess) + S[0] @ stick - s[0]
    # q_1 of the traction over q_1 of the pressure is Q
    free = creep - 0.5 * state.creep_limit * stick[0] / state.q[0]
    # slopes by Q p are those that the pressure of -C p takes back
    change = np.linalg.solve(state.matrix, -right.sum(axis=1))
    # the change is one of pressure: normal displacements again, without T - L
    S, c = layer_operator(state.A, state.memory, modes.L * state.part)
    shift = _shift(modes, state, c @ change + excess.sum(axis=1)) + S[0] @ change + s[0].sum()
    # the load is H = z q_1, at the same z
    load = float(change[0] / state.q[0])
    return Shear(
        moments=_moments(modes, z, state),
        free=free,
        mirrored=mirrored,
        load=load,
        shift=float(shift),
    )


def _shift(modes: CoverModes, state: CoverState, excess: Any) -> Any:
    """Return the mean slope of the surfaces over the contact that an excess memory of the creep
    modes makes, as on half-spaces: without what the operator S of the layers adds.

    modes, state: as in :func:`shear_of`.
    excess: excess memory of each creep mode, (modes,), or (modes, k) of k solutions.
    Returns the slope in units of V T_ref/R, a float, or (k,).
    """
    _, root, edge, x, sigma = state.exponentials
    # transposed, so that one vector (modes,) and columns (modes, k) broadcast alike
    source = (sigma * excess.T).T
    within = modes.series.Q @ (root * (x[:, 1:] @ source).T).T
    return modes.series.t @ (source - (edge * within.T).T)


def _sources(modes: CoverModes, state: CoverState) -> tuple[Floats, Floats]:
    """Return the strain C p of each body by long waves, divided by the compliance of both, as a
    source in the equations of the contact: terms T_n(x), and excess memory of each creep mode.

    modes, state: as in :func:`shear_of`; the state has N terms.
    Returns (terms from n = 0, (N + 1, 2); excess memory, (modes, 2)).
    """
    A = state.A
    F = modes.mine * (modes.C * state.part * state.transform)
    s = 2.0 * np.where(np.arange(len(A))[:, None] % 2, -(A @ F.imag.T), A @ F.real.T)
    s[0] *= 0.5
    return s, (state.memory @ F.T).real


def _moments(modes: CoverModes, z: float, state: CoverState) -> Floats:
    """Return M/V of each body, the power that its compliance dissipates in the pressure, (2,).

    Each creep mode has a part, as for half-spaces (:mod:`.material_series`), without
    cancellation; what the layers' smooth kernels change in the slopes is an integral over the wave
    number.
    modes, z, state: as in :func:`shear_of`.
    """
    # what all layers change in the slopes by the pressure; a body moves by its part of the
    # compliance
    total = modes.L * state.part
    multipliers = (
        modes.mine * (modes.L * state.own) + (modes.shares[:, None] - state.compliance) * total
    )
    smooth = 2.0 / state.q[0] * (multipliers.imag @ (np.abs(state.transform) ** 2 / state.v))
    _, _, e, t, _, Q = modes.series
    within = Q @ (state.X * _edge_weights(modes, z, state) / e)
    return modes.weights @ (state.shares + t * within) + smooth


def _edge_weights(modes: CoverModes, z: float, state: CoverState) -> Floats:
    """Return the mean of 1 - exp(alpha_i x)/I_0(alpha_i) over the contact, with the pressure as
    weight.

    modes, z, state: as in :func:`shear_of`, with at least one mode.
    Returns (modes,), dimensionless.  Sums over all orders are in closed form, with i2 = I_2/I_0.
    """
    ratio = state.exponentials.ratio
    alpha = np.minimum(modes.series.a * z, LARGE_ALPHA)
    i2 = ratio[2]
    # i2_i - i2_l, from 1 - i2 = 2 I_1/(alpha I_0) where that is small
    rest_of_1 = 2.0 * ratio[1] / alpha
    change = np.where(
        np.minimum.outer(alpha, alpha) > 1.0,
        np.subtract.outer(-rest_of_1, -rest_of_1),
        np.subtract.outer(i2, i2),
    )
    sums = change * np.multiply.outer(alpha, alpha) / np.add.outer(alpha, alpha)
    # the rest of the terms, which is smooth,
    # without the terms of the relaxation modes, and of Hertz, z in the first
    rest = state.q - 2.0 * ratio[1:] @ state.X
    rest[0] -= z
    weights = -2.0 / alpha * (np.arange(1, len(ratio))[:, None] * ratio[1:])
    weights[0] = i2
    return (z * i2 + sums @ state.X + rest @ weights) / state.q[0]


# --- The law of a cover over speed ---

#: quantities of a node
_COUNT = 11
#: index of lam among them
_LAM = 0
#: index of L = 2 kappa delta_star/mu
_LIMIT = 1
#: index of epsilon
_EPSILON = 2
#: indices of M/V
_MOMENTS = slice(3, 5)
#: indices of f, of which the sum is 2 kappa delta_f
_FREE = slice(5, 7)
#: functions that have a row each beside those of a table: L, f, g and the slopes
_BESIDE = [_LIMIT, *range(5, _COUNT)]
#: quantities whose limits for u -> infinity a record has
_LIMITED = [_LIMIT, _LAM, *_BESIDE[1:]]
#: offset in ln z of the first and a last solve beside the length found: slopes are differences
_OFFSET = 3e-5
#: octaves between the fastest rate (times the thickness divided by l0 for thick covers) and the row
#: in 1/u
_FAST_OCTAVES = 4
#: factor of the speed from which on rolling is fast: above rounding, below any change of the rows
_OVER = 1.0 + 1e-9
#: octaves of rows beyond those, after which the first order in 1/u is accurate to rounding
_BEYOND = 42
#: nodes of the polynomials at either end, from 0.05 to 1 of their range: wide enough for the noise
#: of the solve, which loses digits there, not to be amplified at 0
_END_NODES = 52
#: terms in ln u of the rows beyond the last octave where the other body, a half-space, relaxes too:
#: without them M was wrong by 1 % at a thousand times the fastest rate, with two it is by 1e-9;
#: more terms amplify the noise of the solve
_LOG_TERMS = 2
#: the secant method ends where the product of the last two relative errors of the load is below
#: this: the next step then leaves an error below rounding
_LOAD_ERRORS = 1e-13
#: least distance of two points of the secant method in ln z, for which rounding does not dominate
#: the slope
_LEAST_STEP = 1e-8
#: most steps of the secant method; it needs 4 to 6
_MOST_STEPS = 40
#: thickness divided by l0 below which the half contact is longer than six thicknesses for any nu,
#: and nothing is solved
_THINNEST = 0.01
#: factors of ln z at the last eight nodes in its extrapolation to the next one, the start of the
#: secant method there
_EXTRAPOLATION = np.array([(-1.0) ** (k + 1) * math.comb(8, k) for k in range(8, 0, -1)])


def cover_rows(cover: Cover, thickest: float | None = None) -> CoverRows:
    """Compute the law of a cover over all speeds; takes 0.1 to 0.3 s.

    cover: one :class:`.bodies.Cover`, of a single thickness and Poisson's ratio.
    thickest: thickness divided by l0 that determines the number of rows in place of that of the
        cover, for several covers to have as many; None: that of the cover.  It has no effect for
        elastic bodies.
    Returns :class:`.row_layout.CoverRows`; of elastic bodies it is a single row of constants, with
    epsilon = M = 0.
    Raises ParameterError for a cover so thin that the half contact at rest is longer than six
    thicknesses, and where at some speed no contact length that carries the load is found.
    """
    modes = CoverModes(cover)
    thickness = cover.thinnest
    slow_limit = _solve_elastic(modes, modes.cover.share, 1.0) if thickness > _THINNEST else None
    # lam/2 is the half contact divided by l0, as is the thickness
    if slow_limit is None or slow_limit[_LAM] > 2.0 * LARGEST_THETA * thickness:
        raise ParameterError(
            "thickness/l0",
            f"{thickness:.3g}",
            f"larger: half the contact at rest may be at most {LARGEST_THETA:g} thicknesses long; "
            "take a thicker layer or a smaller load (l0: contact length at rest of half-spaces of "
            "the same materials; are moduli in Pa, the load in N/m and lengths in m?)",
        )
    if not modes.series.a.size:
        L, lam = slow_limit[_LIMITED[:2]]
        # lam, epsilon, M/V of both bodies, eta/F = lam/L, H/F^2 = 1/L^2 (:func:`_stick_functions`)
        table = steady_table(constant_rows(lam, 0.0, 0.0, 0.0, lam / L, 1.0 / (L * L)))
        limits = np.append(slow_limit[_LIMITED], np.zeros(_COUNT))
        return CoverRows(0, table, constant_rows(*slow_limit[_BESIDE]), limits)
    # the cylinder's part in the instantaneous compliance 1/alpha of both, at most 1 but for
    # rounding
    instant = modes.bodies[1].instant * modes.alpha
    fast_limit = _solve_elastic(modes, min(instant, 1.0), modes.alpha)
    # the solve loses digits of what shear does: its limits are extrapolated, to join the values at
    # the nodes
    slow_limit[3:] = fast_limit[5:] = math.nan
    # beside a rigid body M/V at rest is exactly the sum of E_i/a_i, that is T_mean
    if 1.0 in modes.shares:
        slow_limit[_MOMENTS] = modes.shares * float(modes.series.e @ modes.series.e)
    # the contact is longest at rest: all nodes have the number of terms that it needs
    orders = max(LEAST_TERMS, term_count(0.5 * slow_limit[_LAM] / thickness))
    e0 = int(e0_and_row_count(modes.series.b[0], modes.series.a[-1])[0])
    widest = max(cover.thickness, cover.other_thickness or 0.0)
    widest *= 1.0 if thickest is None else thickest / cover.thickness
    # rolling is fast where even the shortest time is long beside the transit of l0, or of a length
    # of the thicker layer; by a little more than that, for covers of one ``thickest`` to have as
    # many rows in spite of rounding
    last = math.frexp(modes.series.a[-1] * max(1.0, widest) * _OVER)[1] + _FAST_OCTAVES
    first_node = e0 * PER_OCTAVE - _END_NODES + 1
    # the last of the slow 52 nodes is 2^e0, the first of the fast ones 2^last
    u = np.exp2(np.arange(first_node, last * PER_OCTAVE + _END_NODES) / PER_OCTAVE)
    values = _solve_nodes(modes, u, orders)
    rows = Rows(e0, last - e0 + 1 + _BEYOND)
    slow_limit, _, slow = fit_end(
        np.ldexp(u[:_END_NODES], -e0), values[:, :_END_NODES], slow_limit, rows.t[0]
    )
    inside = interpolate_octaves(values, e0 * PER_OCTAVE - first_node, last - e0)
    x = rows.x[last - e0 + 1 :]
    relaxes = cover.other_thickness is None and cover.other.alpha > 1.0 and cover.part < 1.0
    ends = u[-_END_NODES:], values[:, -_END_NODES:], fast_limit
    fast, limits = _fit_fast_rows(*ends, x, math.ldexp(1.0, last), _LOG_TERMS if relaxes else 0)
    fitted = np.concatenate([slow[:, :, None], inside, fast], axis=2)
    powers = np.append(
        rows.fit_slopes(*fitted[:, : _FREE.start]),
        rows.fit_slopes(*fitted[:, _FREE.start :], terms=SHORT_TERMS),
        axis=0,
    )
    # the limit at rest exactly, not as the fit has it
    powers[:, 0, 0] = slow_limit
    share, press = rows.fit_slopes(*_stick_functions(rows, powers, limits))
    table = steady_table([powers[_LAM], powers[_EPSILON], *powers[_MOMENTS], share, press])
    return CoverRows(e0, table, powers[_BESIDE], limits)


def solve_at_speed(cover: Cover, u: float, *, orders: int = LEAST_TERMS) -> Floats:
    """Solve one state of a cover, without rows; the rows are compared with it in tests.

    cover: one :class:`.bodies.Cover`.
    u: kappa |V|, dimensionless, > 0.
    orders: number of terms of the pressure (:func:`.cover_solve.solve`), at most 100; by default
    the least with which rows are made.
    Returns the quantities of a node (module), dimensionless, (11,).
    Raises ParameterError where no contact length that carries the load is found; a contact that is
    longer than rows allow, half of it beyond six thicknesses, is not refused.
    """
    return _solve_node(CoverModes(cover), u, orders)[0]


def _solve_node(
    modes: CoverModes,
    u: float,
    orders: int,
    start: float | None = None,
    slope: float = 2.0,
    stiffness: float = 1.0,
) -> tuple[Floats, float, float]:
    """Solve for the half contact length that carries the load at one speed, by the secant method.

    The unknown is ln z, z the half contact length divided by V T_ref; the equation is ln H = -ln(4
    stiffness u^2) with the load H of :class:`.cover_solve.CoverState`.  lam, L, epsilon and M are
    extrapolated by the last secant step; what shear does is that of the last solve.
    modes: :class:`CoverModes` of the bodies.
    u: kappa |V|, dimensionless, > 0.
    orders: as in :func:`solve_at_speed`.
    start: first approximation of ln z; None: that of a half-space of a stiffness between slow and
        fast, shortened for a thin cover, from which one is found first.
    slope: first approximation of d ln H/d ln z, > 0; 2 is that of a half-space.
    stiffness: instantaneous divided by long-time stiffness, to solve fast rolling with the
        ``modes`` of elastic bodies; 1: the modes have their own stiffness.
    Returns (the quantities of a node, (11,), dimensionless; ln z after the last secant step; d ln
    H/d ln z of the first one).
    Raises ParameterError where the secant method has not ended after 40 solves.
    """
    goal = -math.log(4.0 * stiffness * u * u)
    solves = 1
    if start is None:
        # the length of elastic half-spaces, z = e^(goal/2), divided by the root of a stiffness that
        # rises from 1 to alpha where u passes 1, and shortened where the layer is thinner than 0.2
        # l0 or so
        rough = (
            0.5 * goal
            - 0.5 * math.log1p((modes.alpha - 1.0) * u / (u + 1.0))
            - math.log1p(0.2 / modes.cover.thinnest)
        )
        start = _find_length(modes, u, orders, goal, rough, slope)[0][-1]
        # the first one for a slope as good as one that is extrapolated
        solves = 2
    for _ in range(solves):
        y, errors, states = _find_length(modes, u, orders, goal, start + _OFFSET, slope)
        start = y[-1]
        slope = (errors[1] - errors[0]) / (y[1] - y[0])

    def values_at(y: float, state: CoverState) -> Floats:
        """Return lam = 2 z u, L = 2 u times the creep limit, epsilon = g/z and M/V at ln z = y."""
        epsilon = state.shift * math.exp(-y)
        return np.array([2.0 * math.exp(y) * u, 2.0 * u * state.creep_limit, epsilon, state.moment])

    # y has one entry more, the step after the last solve
    found = [*map(values_at, y, states)]
    other = 2.0 * y[-1] - y[0]
    beyond = solve(modes, math.exp(other), math.exp(other) * u, orders)
    load_slope = (errors[0] + goal - math.log(beyond.load)) / (y[0] - other)
    shift_slope = (found[0] - values_at(other, beyond))[_EPSILON] / (y[0] - other)
    # from the last solve, at y[-2], on to y[-1], in units of the step that led to it
    part = (y[-1] - y[-2]) / (y[-2] - y[-3])
    lam, L, epsilon, moment = found[-1] + (found[-1] - found[-2]) * part
    z = math.exp(y[-2])
    shear = shear_of(modes, z, states[-1])
    # d ln z/dQ by which the load stays the same
    tilt = -shear.load / load_slope
    slopes = lam * tilt, shear.shift / z + shift_slope * tilt
    free = 2.0 * u * shear.free
    moments = shear.moments * (moment / shear.moments.sum() if modes.J.size else 0.0)
    values = np.array(
        [lam, L, epsilon, *moments, *free, *(2.0 * u * shear.mirrored - free), *slopes]
    )
    return values, start, slope


def _find_length(
    modes: CoverModes, u: float, orders: int, goal: float, y: float, slope: float
) -> tuple[list[float], list[float], list[CoverState]]:
    """Find the half contact length that carries a load, by the secant method in ln z.

    modes: :class:`CoverModes` of the bodies.
    u: kappa |V|, dimensionless, > 0.
    orders: number of terms of the pressure.
    goal: ln H of the load.
    y: first ln z.
    slope: first approximation of d ln H/d ln z, > 0.
    Returns (ln z of each solve, then that after the last step; ln H - goal of each solve; their
    states), at least two solves.
    Raises ParameterError where it has not ended after 40 solves.
    """
    lengths = []
    errors = []
    states = []
    for _ in range(_MOST_STEPS):
        z = math.exp(y)
        states.append(solve(modes, z, z * u, orders))
        lengths.append(y)
        errors.append(math.log(states[-1].load) - goal)
        if len(errors) > 1:
            # 2 on half-spaces, up to 5 on thin layers: bounds against a difference that is rounding
            slope = min(max((errors[-1] - errors[-2]) / (lengths[-1] - lengths[-2]), 0.5), 8.0)
        step = -errors[-1] / slope
        if len(errors) > 1 and abs(errors[-1] * errors[-2]) < _LOAD_ERRORS:
            return [*lengths, y + step], errors, states
        # at most a factor of 2 in z at once; no step so small that the next slope would be rounding
        y += math.copysign(min(max(_LEAST_STEP, abs(step)), 0.7), step)
    raise ParameterError(
        "thickness/l0",
        f"{modes.cover.thinnest:g}",
        "larger, as no contact length was found that carries the load; take a thicker layer or a "
        "smaller load (l0: contact length at rest of half-spaces of the same materials)",
    )


def _solve_nodes(modes: CoverModes, u: Floats, orders: int) -> Floats:
    """Solve the states of a cover at increasing speeds, from starts and slopes extrapolated from
    the eight before.

    The first eight nodes have no extrapolation and take the start of :func:`_solve_node`.
    modes: :class:`CoverModes` of the bodies.
    u: kappa |V|, dimensionless, evenly spaced in ln u, ascending, (n,).
    orders: number of terms of the pressure.
    Returns the quantities at each node, (11, n), dimensionless.
    Raises ParameterError where no contact length that carries the load is found.
    """
    values = np.empty((_COUNT, u.size))
    known = np.empty((u.size, 2))
    count = _EXTRAPOLATION.size
    # known: ln z and the slope d ln H/d ln z of each node
    for n, speed in enumerate(u.tolist()):
        given = (_EXTRAPOLATION @ known[n - count : n]).tolist() if n >= count else ()
        values[:, n], *known[n] = _solve_node(modes, speed, orders, *given)
    return values


def _solve_elastic(modes: CoverModes, share: float, stiffness: float) -> Floats:
    """Solve the cover with elastic bodies: the limit of slow rolling, all relaxation completed, or
    of fast rolling.

    lam, L and delta_0 of elastic bodies do not depend on the speed, so that one solve, at u = 1/2,
    gives them.  In fast rolling all compliances are divided by alpha.  Then the length that carries
    the load is that of a load alpha times smaller on bodies of the long-time stiffness, and the
    slopes and creep of elastic bodies depend on that length and the layer's part of the compliance
    alone: bodies of the long-time stiffness are solved in both limits, under a load that
    ``stiffness`` divides.
    modes: :class:`CoverModes` of the viscoelastic bodies.
    share: the cylinder's part of the compliance of both bodies, in [0, 1]: of long times for slow
        rolling, of the instantaneous compliance for fast rolling.
    stiffness: that of the bodies over the long-time one: 1 for slow, alpha for fast rolling.
    Returns the quantities of a node, (11,), dimensionless, epsilon and M/V exactly 0.
    Raises ParameterError where no contact length that carries the load is found.
    """
    elastic = CoverModes(modes.cover.elastic(share))
    values = _solve_node(elastic, 0.5, LEAST_TERMS, stiffness=stiffness)[0]
    # the solve leaves rounding in them
    values[_EPSILON : _MOMENTS.stop] = 0.0
    return values


def _fit_fast_rows(
    u: Floats, values: Floats, limits: Floats, x: Floats, begin: float, log_terms: int
) -> tuple[Floats, Floats]:
    """Fit the rows beyond the last octave, where all quantities, M u/V in place of M/V, are
    polynomials of 1/u.

    Beside a half-space that relaxes too, a second polynomial of 1/u, of ``log_terms`` terms, times
    ln u is added.
    u: last nodes of the solve, ascending, from ``begin`` to at most 20 ``begin``, (n,).
    values: the quantities there, (11, n); not changed.
    limits: of these for u -> infinity, (11,); NaN: not known, then the value of a fitted polynomial
        at 1/u = 0 is taken.  Those of epsilon and M/V are 0.
    x: nodes of these rows in u, ascending, >= ``begin``, (rows, nodes).
    begin: u where these rows begin, the end of the last octave.
    log_terms: number of terms in ln u, as in :func:`.law_rows.fit_end`.
    Returns (values and slopes over ln u at x, of the quantities, (2, 11, rows, nodes);
        :attr:`.row_layout.CoverRows.limits`, (19,), of which the last eleven, factors of 1/u, are
        those at the last node of x).
    """
    y = begin / u
    x_inverse = (begin / x).ravel()
    values = values.copy()
    values[_MOMENTS] /= y
    limits, first, (fitted, slopes) = fit_end(y, values, limits, x_inverse, log_terms)
    slopes[_MOMENTS] = (slopes[_MOMENTS] + fitted[_MOMENTS]) * x_inverse
    fitted[_MOMENTS] *= x_inverse
    # coefficients of y = begin/u become those of 1/u; M/V was divided by y, and its own are of
    # 1/u^2
    first *= begin
    first[_MOMENTS] *= begin
    # epsilon and M/V stand side by side
    packed = [limits[_LIMITED], first[_LIMITED], first[_EPSILON : _MOMENTS.stop]]
    # slopes over ln y have the other sign over ln u
    return np.stack([fitted, -slopes]).reshape(2, -1, *x.shape), np.concatenate(packed)


def _stick_functions(rows: Rows, powers: Floats, limits: Floats) -> tuple[Floats, Floats]:
    """Return eta/F and H/F^2 of a cover at the nodes of v = 1/F(eta), and their derivatives with
    respect to ln v.

    With L = 2 kappa delta_star/mu the creep limit of the whole contact, L/(2 u) in units of V
    T_ref/R, that of the stick zone is F' = w/(2 u), w = L - 2 kappa |delta - delta_0|/mu.  The law
    of the stick zone is taken as that of the whole contact at the speed u' with L(u')/(2 u') = F'.
    So v = 2 u'/L(u'), H/F^2 = 1/L(u')^2 and eta/F = lam(u')/L(u').  That u' is found by Newton's
    method in ln u', from u' = v, until all steps are below 1e-15, in at most 60 steps without an
    error.

    rows: octaves of u and of v, as :class:`.law_rows.Rows`.
    powers: coefficients of lam, L, 2 kappa delta_0, epsilon and M/V over u, (5, rows, 24); lam and
    L are read.
    limits: :attr:`.row_layout.CoverRows.limits`, which with the first order in 1/u give lam and L
    beyond the last row.
    Returns two arrays (2, rows, 24 nodes), dimensionless: (eta/F, H/F^2), and their derivatives.
    """
    v = rows.x.ravel()
    u = v.copy()
    for _ in range(60):
        values, slopes = rows.read(powers[[_LIMIT, _LAM]], np.minimum(u, rows.last))
        # limits[:2] are L and lam for u -> infinity, limits[8:10] their factors of 1/u
        first = limits[8:10, None] / u
        (L, lam), (d_L, d_lam) = np.where(
            u > rows.last, [limits[:2, None] + first, -first], [values, slopes]
        )
        dlnu_dlnv = 1.0 / (1.0 - d_L / L)
        share = lam / L
        press = 1.0 / (L * L)
        step = np.log(v * L / (2.0 * u)) * dlnu_dlnv
        if np.abs(step).max() < 1e-15:
            break
        u *= np.exp(step)
    slopes = dlnu_dlnv * np.stack([share * (d_lam / lam - d_L / L), -2.0 * press * d_L / L])
    return np.stack([share, press]).reshape(2, *rows.x.shape), slopes.reshape(2, *rows.x.shape)
