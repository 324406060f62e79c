"""The law of a grid by tensor splines, at one point, and that of a table at states.

**A tensor spline** over V, delta and alpha at one point: its value and its slopes.  A spline is one
vector of doubles: a head, its three axes, its coefficients.  An axis is a head, the edges of its
intervals, and for each interval the basis splines that are not 0 there, as polynomials of the
distance from its left edge.  An axis may run in the logarithm of its coordinate.  An axis on which
the field does not depend has no interval, and one basis spline, which is 1.
``viscoroll.laws.law_grid`` writes the vector.

**The law of a table** (:mod:`.coupled_splines`) at states: many at a time, and as a C function like
:mod:`.law_callables`.  Loads are odd in (V, omega), so that the table is read at |V|; V = 0.0 and V
= -0.0 count as V > 0.  In full slip Q does not depend on the creep.  Symbols are those of
:mod:`.coupled_splines`; all is dimensionless but what is said to be in units of a caller.
"""

from typing import Any, NamedTuple

import numpy as np
from numba import carray

from ..numerics.intrinsics import floats_at, fma, record_at, record_type
from ..numerics.jit import inline_kernel, kernel
from .coupled_splines import (
    CYLINDER,
    FREE,
    FRICTION,
    HALF_SPACE,
    LENGTH,
    LIMIT,
    MOST,
    ONSET,
    SHIFT,
    SLIPS,
    STICK,
    TRACTION,
    cell_at,
    edge_at,
    field_at,
    locate_creep,
    locate_speed,
    place_of,
    value_at,
)
from .law_callables import RESULTS, Jitted, pack_records, refuse
from .law_record import (
    asks_for_moments,
    asks_for_slopes,
    read_state,
    slip_and_creepage,
    write_field,
)

# --- A tensor spline over V, delta and alpha at one point ---

# Indices in the head of a spline.
#: Lower bound, to which values are clipped.
LOW = 0
#: Upper bound, to which values are clipped.
HIGH = 1
#: Where the axis of V begins.
V_AXIS = 2
#: Where the axis of delta begins.
DELTA_AXIS = 3
#: Where the axis of alpha begins.
ALPHA_AXIS = 4
#: Where the coefficients begin.
COEFFICIENTS = 5
# Indices in the head of an axis.
#: Number of intervals; 0 if the field does not depend on the coordinate.
INTERVALS = 0
#: Number of basis splines that are not 0 in an interval.
ORDER = 1
#: 1 if the coordinate is the logarithm, else 0.
IS_LOG = 2
#: Number of coefficients between neighbours along the axis.
STRIDE = 3
#: Where the edges of the intervals begin.
EDGES = 4
#: Coefficients of the polynomial of a basis spline; of a lower degree some are 0.
TERMS = 4


class Value(NamedTuple):
    """A field at a point and its slopes over V, delta and alpha, in the units of the grid.

    All four are NaN outside of the axes.  The slope over an axis on which the field does not depend
    is 0, and so are all slopes where the value is clipped to the bounds.
    """

    value: float
    dV: float
    ddelta: float
    dalpha: float


class AxisPosition(NamedTuple):
    """Position of a coordinate on an axis.

    axis : int, where the axis begins in the spline.
    interval : int, number of the interval, from 0.
    t : distance from its left edge, in the coordinate or in its logarithm; NaN outside of the axis.
    slope : derivative of the logarithm over the coordinate; 1 where the axis does not run in it.
    """

    axis: int
    interval: int
    t: float
    slope: float


@inline_kernel
def _number_at(spline, n):
    """Return number ``n`` of a spline; unsigned, as numba would test for negative ones."""
    return spline[np.uint64(n)]


@inline_kernel
def _integer_at(spline, n):
    """Return number ``n`` of a spline as an integer."""
    return np.int64(_number_at(spline, n))


@inline_kernel
def _locate(spline, name, x):
    """Return the position of a coordinate on an axis of the spline.

    spline : vector of the spline: bounds, axes and coefficients.
    name : V_AXIS, DELTA_AXIS or ALPHA_AXIS, index in the head of the spline.
    x : float, the coordinate itself, also of a logarithmic axis, in the units of the grid; it is
        ignored if the field does not depend on it.

    Returns :class:`AxisPosition`.  A coordinate on an inner edge is at the left end of its
    interval, one at the upper end of the axis is in the last interval.  Outside of the axis, and
    for NaN, t is NaN and the interval 0.  If the field does not depend on the coordinate, interval
    and t are 0 and the slope is 1.
    """
    axis = _integer_at(spline, name)
    first = axis + EDGES
    interval = np.int64(0)
    count = _integer_at(spline, axis + INTERVALS)
    slope = 1.0
    t = 0.0
    if count > 0:
        if _number_at(spline, axis + IS_LOG) > 0.0:
            slope = 1.0 / x
            x = np.log(x)  # NaN of x < 0
        if not _number_at(spline, first) <= x <= _number_at(spline, first + count):
            x = np.nan
        while count > 1:  # bisection, which ends in interval 0 for NaN; ``count`` are left
            middle = count >> 1
            interval += middle * np.int64(x >= _number_at(spline, first + interval + middle))
            count -= middle
        t = x - _number_at(spline, first + interval)
    return AxisPosition(axis, interval, t, slope)


@inline_kernel
def _basis(spline, position, n):
    """Return one basis spline at a position: value, slope and offset of its coefficient.

    spline : vector of the spline: bounds, axes and coefficients.
    position : the :class:`AxisPosition`.
    n : int, 0 ... 3, index of the basis spline among those that are not 0 in the interval; those
        beyond the degree of the axis are 0.

    Returns (value, slope, offset): value, a float, dimensionless; slope over the coordinate itself,
    also of a logarithmic axis, a float; int that is added to the position of a coefficient in the
    vector.  Value and slope are NaN outside of the axis.
    """
    axis = position.axis
    # Index of the constant coefficient: behind head and count + 1 edges of the axis, in the square
    # of TERMS basis splines with TERMS coefficients each of the interval.
    at = (
        (position.interval * TERMS + n) * TERMS
        + EDGES
        + 1
        + _integer_at(spline, axis + INTERVALS)
        + axis
    )
    c0 = _number_at(spline, at)
    c1 = _number_at(spline, at + 1)
    c2 = _number_at(spline, at + 2)
    c3 = _number_at(spline, at + 3)
    t = position.t
    # basis splines are numbered from left to right: in interval i those of i to i + 3 are not 0
    start = (position.interval + n) * _integer_at(spline, axis + STRIDE)
    return (
        fma(t, fma(t, fma(t, c3, c2), c1), c0),
        fma(t, fma(t, 3.0 * c3, 2.0 * c2), c1) * position.slope,
        start,
    )


@kernel
def spline_at(spline, V, delta, alpha):
    """Return the :class:`Value` of a field at a point: value and slopes over V, delta and alpha, in
    the units of the grid.

    spline : vector of doubles of :meth:`viscoroll.tables.Interpolant.jitted`: bounds, axes and
        coefficients.
    V, delta, alpha : float, coordinates in the units of the grid.  Where the field does not depend
        on one of them, that argument is ignored, and any number may be given.

    Returns NaN, the slopes too, if a coordinate that is not ignored is NaN or outside of its axis.
    A value beyond the bounds of the field is clipped to them, and its slopes are 0.  The slope over
    a coordinate that is ignored is 0.
    """
    over_V = _locate(spline, V_AXIS, V)
    over_delta = _locate(spline, DELTA_AXIS, delta)
    over_alpha = _locate(spline, ALPHA_AXIS, alpha)
    # 0, or NaN where a coordinate is outside of its axis.
    value = dV = ddelta = dalpha = 0.0 * (over_V.t + over_delta.t + over_alpha.t)
    # Over alpha as many basis splines as the axis has, often one; over V and delta always TERMS, a
    # number known to the compiler, of which those beyond the degree are 0.
    for k in range(_integer_at(spline, over_alpha.axis + ORDER)):
        c, dc, plane = _basis(spline, over_alpha, k)
        for i in range(TERMS):
            b, db, row = _basis(spline, over_V, i)
            row += plane + _integer_at(spline, COEFFICIENTS)
            f = df = 0.0
            for j in range(TERMS):
                a, da, column = _basis(spline, over_delta, j)
                coefficient = _number_at(spline, row + column)
                f = fma(a, coefficient, f)
                df = fma(da, coefficient, df)
            value = fma(c * b, f, value)
            dV = fma(c * db, f, dV)
            ddelta = fma(c * b, df, ddelta)
            dalpha = fma(dc * b, f, dalpha)
    low = _number_at(spline, LOW)
    high = _number_at(spline, HIGH)
    if value < low or value > high:
        return Value(min(max(value, low), high), 0.0, 0.0, 0.0)
    return Value(value, dV, ddelta, dalpha)


# --- The law of a table (coupled_splines) at states ---

#: User data.  function: address of the C function.  slopes: whether slopes are asked for.  table,
#: size: address and length of the table.  kappa, mu: of the scene.  V, omega, Q, M: 1 of each in
#: the units of the caller.
TABLE = record_type("function slopes table size", "kappa mu V omega Q M")


class LoadSlopes(NamedTuple):
    """Slopes of a load of a state, Q or a rolling moment, dimensionless.

    dV : slope over V at fixed creepage.
    ddelta : slope over the creepage at fixed V.
    """

    dV: float
    ddelta: float


class TablePlace(NamedTuple):
    """Where a state lies in a table.

    sign : that of V, 1.0 or -1.0, in which loads are odd.
    u : kappa |V|.
    speed : :class:`.coupled_splines.Weights` of u.
    state : :class:`.coupled_splines.Place` of its creep.
    cell : :class:`.coupled_splines.Cell`, the four nodes around it.
    """

    sign: float
    u: float
    speed: Any
    state: Any
    cell: Any


@inline_kernel
def _place(V, D, kappa, table):
    """Return the :class:`TablePlace` of a state.

    V : float, speed of the axis, dimensionless, of any sign; kappa |V| may exceed the nodes.
    D : float, 2 kappa delta, of any sign, which may be infinite.
    kappa : float, slenderness R/l0, > 0.
    table : vector of :mod:`.coupled_splines`.
    """
    u = kappa * abs(V)
    speed = locate_speed(u, table)
    state = place_of(D, u, speed, table)
    place = locate_creep(state.w, state.sigma, table)
    sign = -1.0 if V < 0.0 else 1.0  # V = -0.0 counts as V > 0, as for laws of rows
    return TablePlace(sign, u, speed, state, cell_at(speed, place, table))


@inline_kernel
def _load(name, factor, kappa, at, table):
    """Return the :class:`LoadSlopes` of a field times a factor, a load that is odd in V.

    name : int, TRACTION, HALF_SPACE or CYLINDER, of which the table has Q/mu and kappa times the
        moments.
    factor : float, mu of Q, 1/kappa of a moment.
    kappa : float, slenderness, > 0.
    at : :class:`TablePlace` of the state.
    table : vector of :mod:`.coupled_splines`.
    """
    found = field_at(name, at.state.w, at.cell, table)
    # With u = kappa |V| and D = 2 kappa delta.  The slope over V has the sign of V twice, as the
    # load is odd and du/dV = kappa sign V: it has none.
    return LoadSlopes(
        factor * kappa * (found.du + found.dw * at.state.dw_du),
        at.sign * factor * 2.0 * kappa * found.dw * at.state.dw_dD,
    )


@inline_kernel
def _traction(mu, at, table):
    """Return the traction Q, a float, dimensionless, limited to +-mu LIMIT.

    mu : float, coefficient of friction.
    at : :class:`TablePlace` of the state.
    table : vector of :mod:`.coupled_splines`.
    """
    limit = table[LIMIT]
    found = value_at(TRACTION, at.cell, table)
    # in full slip exactly the limit, not the value of the spline at the onset
    found = at.state.sigma * limit if at.state.w >= 1.0 and limit < np.inf else found
    return at.sign * mu * min(max(found, -limit), limit)


@inline_kernel
def _sloped_loads(mu, kappa, at, table):
    """Return the slopes of Q and of the moments of half-space and cylinder of one state, three
    :class:`LoadSlopes`.

    mu, kappa : floats, coefficient of friction and slenderness, > 0.
    at : :class:`TablePlace`, the state in the table.
    table : vector of :mod:`.coupled_splines`.
    The slopes of Q are 0 where |Q| is limited to mu times the entry LIMIT of the table, so also in
    full slip; an infinite LIMIT limits nothing.
    """
    Q = _load(TRACTION, mu, kappa, at, table)
    if abs(_traction(mu, at, table)) >= mu * table[LIMIT]:
        Q = LoadSlopes(0.0, 0.0)
    half_space = _load(HALF_SPACE, 1.0 / kappa, kappa, at, table)
    return Q, half_space, _load(CYLINDER, 1.0 / kappa, kappa, at, table)


@inline_kernel
def _at_fixed_omega(load, V, delta):
    """Return (slope of a load over V at fixed omega, that over omega), floats, dimensionless;
    infinite, or NaN, at V = 0 where it depends on the creepage.

    load : :class:`LoadSlopes`, slopes over V at fixed creepage and over the creepage.
    V, delta : floats, speed, of any sign, and creepage, dimensionless.
    """
    if load.ddelta == 0.0:  # Also at V = 0, where the quotients below are NaN.
        return load.dV, 0.0
    # delta = omega/V - 1: d delta/dV = -(1 + delta)/V at fixed omega, d delta/d omega = 1/V.
    return load.dV - load.ddelta * (1.0 + delta) / V, load.ddelta / V


@kernel(allocates=True)
def look_up(table, u, D):
    """Return the fields of a table but friction at states, (n, FRICTION).

    table : vector of :mod:`.coupled_splines`, with all fields.
    u, D : kappa |V| and 2 kappa delta of each, (n,).
    Columns are the fields TRACTION to WORK + 1 of :mod:`.coupled_splines`.
    """
    out = np.empty((u.size, FRICTION))  # FRICTION is the number of fields before friction
    for n in range(u.size):
        at = _place(u[n], D[n], 1.0, table)  # u as V > 0 with kappa = 1
        for name in range(out.shape[1]):
            out[n, name] = value_at(name, at.cell, table)
    return out


@kernel
def table_loop(table, request, count):
    """Write the requested fields of many states, in their order.

    table : vector of :mod:`.coupled_splines`, with all fields.
    request : :class:`.law_record.Request`: the states, the requested fields, and ``out``, (fields,
        states), which is written; ``order`` is not read.
    count : int, number of states.
    Returns nothing.
    """
    for n in range(count):
        _write_state(table, read_state(request.states, n), n, request)


@inline_kernel
def _write_state(table, given, n, request):
    """Write the requested fields of one state.

    table : vector of :mod:`.coupled_splines`, with all fields.
    given : :class:`.law_record.State` of numbers; all fields are read.
    n : int, index of the state, >= 0; its column of ``out`` is n + ``request.first``.
    request : :class:`.law_record.Request`: of ``out`` the rows that ``to`` names are written,
        dimensionless: creepages, lengths, Q in units of P, moments in units of P R and their
        slopes.
    Returns nothing.
    """
    to = request.to
    kappa = given.kappa
    _, delta = slip_and_creepage(given)
    D = 2.0 * kappa * delta
    at = _place(given.V, D, kappa, table)
    write_field(to.delta, delta, n, request)
    write_field(to.full_slip, np.float64(at.state.w >= 1.0), n, request)
    # ``&`` of rows, here and below, as in law_record.asks_for_moments
    if (to.lam & to.zeta) >= 0:
        lam = value_at(LENGTH, at.cell, table)
        write_field(to.lam, lam, n, request)
        write_field(to.zeta, 0.5 * lam / at.u, n, request)
    if to.epsilon >= 0:
        write_field(to.epsilon, value_at(SHIFT, at.cell, table), n, request)
    if to.beta >= 0:
        stick = value_at(STICK, at.cell, table)  # a spline may pass 0 and 1 by its error
        write_field(to.beta, min(max(stick, 0.0), 1.0), n, request)
    if to.delta_0 >= 0:
        free = edge_at(FREE, at.u, at.speed, table).value
        write_field(to.delta_0, 0.5 * free / kappa, n, request)
    if (to.delta_star & to.delta_minus & to.delta_plus) >= 0:
        low = 0.5 * edge_at(ONSET, at.u, at.speed, table).value / kappa
        high = 0.5 * edge_at(ONSET + 1, at.u, at.speed, table).value / kappa
        write_field(to.delta_minus, low, n, request)
        write_field(to.delta_plus, high, n, request)
        # half the distance of the onsets, which need not be at equal distances from delta_0
        write_field(to.delta_star, 0.5 * (high - low), n, request)
    if (to.Q & to.grip) >= 0:
        Q = _traction(given.mu, at, table)
        write_field(to.Q, Q, n, request)
        write_field(to.grip, 1.0 - abs(Q) / given.mu, n, request)
    if asks_for_moments(to):
        factor = at.sign / kappa
        half_space = factor * value_at(HALF_SPACE, at.cell, table)
        cylinder = factor * value_at(CYLINDER, at.cell, table)
        write_field(to.M, half_space + cylinder, n, request)
        write_field(to.M_half_space, half_space, n, request)
        write_field(to.M_cylinder, cylinder, n, request)
    of_Q, of_M, of_bodies = asks_for_slopes(to)
    if of_Q or of_M or of_bodies:
        _write_slopes(table, given, at, delta, n, request)


@inline_kernel
def _write_slopes(table, given, at, delta, n, request):
    """Write the requested slopes of one state, of Q and of the moments.

    table : vector of :mod:`.coupled_splines`.
    given : :class:`.law_record.State`, the state, of which V, kappa, mu and ``creep_is_omega`` are
        read.
    at : :class:`TablePlace`, the state in the table.
    delta : float, creepage, dimensionless, infinite at V = 0 where omega is given and not 0.
    n : int, index of the state, >= 0; its column of ``out`` is n + ``request.first``.
    request : :class:`.law_record.Request`, of whose ``out`` the rows of the slopes that ``to``
        names are written, dimensionless.
    Returns nothing.
    """
    to = request.to
    Q, half_space, cylinder = _sloped_loads(given.mu, given.kappa, at, table)
    M = LoadSlopes(half_space.dV + cylinder.dV, half_space.ddelta + cylinder.ddelta)
    write_field(to.dQ_ddelta, Q.ddelta, n, request)
    write_field(to.dM_ddelta, M.ddelta, n, request)
    fixed = given.creep_is_omega
    # The slope over V is at fixed omega where the state has omega, else at fixed creepage; that
    # over omega is always at fixed V.
    for load, over_V, over_omega in (
        (Q, to.dQ_dV, to.dQ_domega),
        (M, to.dM_dV, to.dM_domega),
        (half_space, to.dM_half_space_dV, to.dM_half_space_domega),
        (cylinder, to.dM_cylinder_dV, to.dM_cylinder_domega),
    ):
        dV, domega = _at_fixed_omega(load, given.V, delta)
        write_field(over_V, dV if fixed else load.dV, n, request)
        write_field(over_omega, domega, n, request)


@kernel(allocates=True)
def _table_law(caller_V, caller_omega, pointer, scenes):
    """Evaluate a table at one state and write the results; it is the C function of a table.

    caller_V, caller_omega : speed of the axis and angular velocity in the units of the caller, of
    any sign.
    pointer : address of RESULTS numbers, which are written in the units of the caller as by
        :func:`.law_callables._evaluate`: without ``slopes`` the first four alone.
    scenes : pointer to a TABLE record, all of whose fields but ``function`` are read.
    Returns the status, an int: 0; or 1, and all results are NaN, where |V| is above the table, V or
    omega is not finite, or the creepage is outside of a table that does not slip fully at its ends.
    """
    out = carray(pointer, RESULTS)
    scene = record_at(scenes)
    table = floats_at(scene.table, scene.size)
    V = caller_V / scene.V
    slip = caller_omega / scene.omega - V
    kappa = scene.kappa
    u = kappa * abs(V)
    if not (u <= table[MOST] and abs(slip) < np.inf):  # too fast, or not finite
        return refuse(out)
    # as in law_record.slip_and_creepage: V = 0.0 and -0.0 count as V > 0
    delta = slip / V if V != 0.0 else 0.0 if slip == 0.0 else np.copysign(np.inf, slip)
    at = _place(V, 2.0 * kappa * delta, kappa, table)
    if at.state.w > 1.0 and table[SLIPS] == 0.0:
        return refuse(out)
    factor = scene.M * at.sign / kappa
    half_space = factor * value_at(HALF_SPACE, at.cell, table)
    cylinder = factor * value_at(CYLINDER, at.cell, table)
    out[0] = scene.Q * _traction(scene.mu, at, table)
    out[1] = half_space + cylinder
    out[2] = half_space
    out[3] = cylinder
    if scene.slopes:  # in the units of the caller: times that of the load over that of V or omega
        Q, of_half_space, of_cylinder = _sloped_loads(scene.mu, kappa, at, table)
        for load, unit, to_V, to_omega in (
            (Q, scene.Q, 4, 5),
            (of_half_space, scene.M, 6, 8),
            (of_cylinder, scene.M, 7, 9),
        ):
            dV, domega = _at_fixed_omega(load, V, delta)
            out[to_V] = unit / scene.V * dV
            out[to_omega] = unit / scene.omega * domega
    return 0


def jitted_table(table, owner, kappa: float, mu: float, scale) -> Jitted:
    """Return the law of a table as a function for jitted code, :class:`Jitted`.

    table : vector of :mod:`.coupled_splines`, contiguous doubles, which the law keeps alive.
    owner : any object that the law keeps alive besides, as it owns the memory of ``table``.
    kappa, mu : floats, slenderness R/l0 and coefficient of friction of the scene, > 0.
    scale : "V", "omega", "Q" and "M" -> the unit of this dimensionless quantity in the units of the
        caller, a float: a dimensionless number times it is the caller's.
    Raises KeyError if ``scale`` lacks a name.  The C function is compiled here if it is not yet.
    """
    records = pack_records(_table_law, TABLE, (table.ctypes.data, table.size), kappa, mu, scale)
    return Jitted(records, (table, owner))
