"""The tables of a flow map in partial slip, made from the rows of the law and from integrated
motions: :func:`fill_manifold`, :func:`fill_layers`; and the polynomials of which they consist.
All is dimensionless, times are gamma t.

The slow manifold is the curve in (V, delta) that all motions in partial slip approach, on which V
decays to rest.  The slow logarithm of V falls linearly in time along it, at
``FlowProblem.slow_rate`` (:mod:`.motion_problem`); it tends to ln V plus a constant as V -> 0.

After the onset of partial slip omega - V relaxes in a boundary layer at the rate k0, until the
motion follows the slow manifold.  E = k0 (tau - tau_onset), tau = gamma t, is the time since the
onset in units of 1/k0.  The law has a kink at delta = 0.  Each layer is therefore divided at a
value of E, its split: that at which delta passes 0, or 1 where delta does not.  The layer
coordinate u grows with E, linearly on either side of the split, from 2^LAYER_LOW at the onset over
1 at the split to 2^LAYER_HIGH at the end.  The two families are the motions with omega > V and with
omega < V at the onset.  V0 is the speed at the onset.

Motions give V and delta at interpolation nodes; distance, angle and loss are integrals of their
polynomials.
"""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial.polynomial import polyval

from ..core import Floats
from ..kernels.motion import flow_layout
from ..kernels.numerics.interpolation import (
    Interpolation,
    chebyshev,
    gauss,
    powers_of_chebyshev,
    to_chebyshev,
)
from ..kernels.numerics.simd import TERMS
from ..laws import interleave_pairs
from .motion_problem import FULL_SLIP_RETURNS, OUT_OF_RANGE, STICK_ENDS, FlowProblem, NoFlowMap

# --- Piecewise polynomials of one variable, one for each octave ---

#: limit of Newton's iteration for the inverse function
_MAX_ITERATIONS = 20
#: relative step after which the iteration ends: the error that remains is about its square
_CONVERGED = 1e-8


class Nodes:
    """Chebyshev nodes in [-1, 1], and linear maps of the values of functions there, along the last
    axis.

    An integral is fitted through its values; this drops its highest Chebyshev term, which the
    values do not determine.

    count : number of nodes.
    t : the nodes, ascending, (count,).
    """

    def __init__(self, count: int) -> None:
        rule = Interpolation(chebyshev(count))
        self.t = rule.nodes
        # rows: integrals from -1 to each node, the last one to 1
        self._integrals = rule.integrals([*rule.exact, 1])
        self._chebyshev = to_chebyshev(count)
        self._powers = powers_of_chebyshev(count, 0.0, 1.0).T.copy()

    def powers(self, values: Floats) -> Floats:
        """Return the coefficients of the powers of t in [-1, 1] of the polynomials through values
        at the nodes.

        They are computed by way of Chebyshev coefficients, which limits the rounding errors.

        values : values at the nodes, (..., nodes).
        Returns the coefficients, ascending, (..., nodes).
        """
        return _multiply(self._powers, _multiply(self._chebyshev, values))

    def integrals(self, slopes: Floats, half: Any, start: Any = 0.0) -> Floats:
        """Return the integral of a piecewise polynomial at the nodes, continuous over all rows.

        slopes : values of the integrand at the nodes, (..., rows, nodes).
        half : half the length of each row, a number, (rows,) or (..., rows).
        start : value of the integral at the left end of the first row, a number.
        Returns the integral from that end to each node plus ``start``, in the shape of ``slopes``.
        """
        whole = _multiply(self._integrals, slopes) * np.asarray(half)[..., None]
        # the integral over all rows before each
        rises = np.cumsum(whole[..., -1], axis=-1) - whole[..., -1]
        return whole[..., :-1] + (start + rises)[..., None]

    def end(self, slopes: Floats, half: Any) -> Floats:
        """Return the integral over all rows together.

        slopes : values of the integrand at the nodes, (..., rows, nodes).
        half : half the length of each row, (rows,) or (..., rows).
        Returns one integral for each function, (...), a number for slopes of shape (rows, nodes).
        """
        return (_multiply(self._integrals[-1:], slopes)[..., 0] * half).sum(axis=-1)


def _multiply(matrix: Floats, values: Floats) -> Floats:
    """Return the products of a matrix with vectors along the last axis.

    BLAS is not used, as its last bits differ between machines.

    matrix : (m, n).
    values : vectors, (..., n).
    Returns the products, (..., m).
    """
    return np.einsum("...n,mn->...m", values, matrix)


NODES = Nodes(TERMS)


class Rows:
    """Consecutive intervals of one variable, the rows, with a polynomial in each.

    edges : ends of the rows, ascending, (rows + 1,).
    half : half the length of each row, (rows,).
    x : interpolation nodes of all rows, (rows, nodes).
    """

    def __init__(self, edges: Floats) -> None:
        self.edges = edges
        self.half = 0.5 * np.diff(edges)
        self.x = self.node_positions(NODES)

    def node_positions(self, nodes: Nodes) -> Floats:
        """Return interpolation nodes of all rows, (rows, nodes), ascending; nodes: :class:`Nodes`
        in [-1, 1].
        """
        return self.edges[:-1, None] + self.half[:, None] * (1.0 + nodes.t)

    def value(self, powers: Floats, x: Floats) -> Floats:
        """Evaluate a piecewise polynomial.

        powers : coefficients of powers of t in [-1, 1] on each row, ascending, (rows, powers).
        x : arguments, an array of any shape; beyond the ends the polynomial of the first or last
        row is continued, and an inner edge belongs to the row on its right.
        Returns the values, of the shape of x.
        """
        row = np.searchsorted(self.edges[1:-1], x, side="right")
        t = (x - self.edges[row]) / self.half[row] - 1.0
        return np.asarray(polyval(t, np.moveaxis(powers[row], -1, 0), tensor=False))

    def inverse(self, powers: Floats, target: Floats) -> Floats:
        """Return the arguments at which an increasing piecewise polynomial takes given values, by
        Newton's iteration.

        It ends when all relative steps are at most :data:`_CONVERGED`, or after
        :data:`_MAX_ITERATIONS` steps without an error.

        powers : coefficients of powers of t in [-1, 1] on each row, ascending, (rows, powers); its
        values are > 0.
        target : values, > 0, of any shape.
        Returns the arguments, of the shape of ``target``; the upper end of the last row for values
        beyond it; for values below those of the first row, those of its polynomial continued.
        """
        # derivative with respect to x: t = (x - begin)/half - 1
        slopes = powers[:, 1:] * np.arange(1, powers.shape[1]) / self.half[:, None]
        # values and arguments of neighbouring octaves differ by factors: the logarithm starts well
        x = np.interp(np.log(target), np.log(self.value(powers, self.x).ravel()), self.x.ravel())
        for _ in range(_MAX_ITERATIONS):
            change = (self.value(powers, x) - target) / self.value(slopes, x)
            x = np.minimum(x - change, self.edges[-1])
            if (np.abs(change) <= _CONVERGED * np.abs(x)).all():
                break
        return x


def octaves(low: int, high: int) -> Rows:
    """Return the :class:`Rows` of the high - low octaves from 2^low to 2^high; low, high: ints, low
    < high.
    """
    return Rows(np.ldexp(1.0, np.arange(low, high + 1)))


#: Octaves of the tables over kappa V.
SPEEDS = octaves(flow_layout.LOW, flow_layout.HIGH)


# --- The slow manifold of a flow map ---

#: 5-point Gauss-Legendre rule on [0, 1], (nodes, weights), as in :mod:`.flow_lookup`.
_GAUSS = gauss(5)
#: Edges of the rows over the slow logarithm, dimensionless.
_SLOW_LOG_EDGES = np.concatenate(
    [
        flow_layout.SLOW_WIDTH * np.arange(-flow_layout.SLOW_BINS, 0),
        np.ldexp(1.0, np.arange(flow_layout.SLOW_OCTAVES + 1)) - 1.0,
    ]
)
#: Octaves of V above the tables at which the motion along the slow manifold starts, to approach the
#: manifold.
_RUN_IN_OCTAVES = 3
#: kappa V, dimensionless: the slow logarithm is 0 at the first state of the slow motion that is at
#: or below it.
_SLOW_LOG_ORIGIN = 0.25


class SlowManifold(NamedTuple):
    """The slow manifold: functions of the slow logarithm, and the slow logarithm as a function of
    kappa V.

    Each is given by coefficients of powers of t in [-1, 1] on each row, ascending, (rows, powers).

    rows : rows of the slow logarithm.
    speeds : coefficients of V and of delta.
    path : coefficients of the remaining distance and angle to rest.
    loss : coefficients of the remaining slip loss.
    slow_log : coefficients of the slow logarithm over the octaves of kappa V.
    """

    rows: Rows
    speeds: tuple[Floats, Floats]
    path: tuple[Floats, Floats]
    loss: Floats
    slow_log: Floats

    def path_between(self, start: Floats, span: Floats, rate: float) -> tuple[Floats, Floats]:
        """Return distance and angle of a motion along the slow manifold, while its slow logarithm
        decreases.

        They are differences of the remaining path to rest.  Over a short span, at most a quarter of
        max(1 + end, 1) with the slow logarithm at its end, these would cancel, and they are
        integrals of the speeds by a 5-point Gauss rule.

        start : slow logarithms at the beginning, of any shape.
        span : decreases of the slow logarithms, >= 0, in the shape of ``start``.
        rate : decrease of the slow logarithm in unit time gamma t, > 0.
        Returns (distance, angle), integrals over gamma t of V and omega, >= 0, of the shape of
        ``start``, dimensionless.
        """
        end = start - span
        value = self.rows.value
        x, angle = (value(powers, start) - value(powers, end) for powers in self.path)
        V, delta = (
            value(powers, end[..., None] + span[..., None] * _GAUSS[0]) for powers in self.speeds
        )
        # the logarithm falls at a constant rate, so that dt = -d(logarithm)/rate
        near = span <= 0.25 * np.maximum(1.0 + end, 1.0)
        near_x, near_angle = (
            (_GAUSS[1] * speed).sum(axis=-1) * span / rate for speed in (V, V * (1.0 + delta))
        )
        return np.where(near, near_x, x), np.where(near, near_angle, angle)


def fill_manifold(problem: FlowProblem, parts: flow_layout.FlowTables) -> SlowManifold:
    """Fill the tables of the slow manifold.

    One motion from high to low speed gives V and delta at the nodes; remaining distance, angle and
    loss are integrals from V -> 0 upward.

    problem : the :class:`FlowProblem`.
    parts : :class:`FlowTables`, views of the tables, of which ``slow`` and ``manifold`` are
    written; rows of ``slow`` above the highest speed of the tables stay as they are.
    Raises :class:`NoFlowMap` where that motion leaves partial slip or its numbers the range of
    doubles.
    Returns the :class:`SlowManifold`, the same functions as coefficients.
    """
    rows, V, delta = _integrate_manifold(problem)
    slopes = (
        V,
        V * (1.0 + delta),
        V * delta * problem.contact_states(V, delta)[flow_layout.TRACTION],
    )
    to_go = []
    # with the slow logarithm lambda V and omega go as exp(lambda), and so do delta and Q: the slip
    # loss as exp(3 lambda).  ``below`` is the integral from -infinity to the first edge
    for slope, n in zip(slopes, (1, 1, 3)):
        below = slope[0, 0] * math.exp(n * (rows.edges[0] - rows.x[0, 0])) / n
        to_go.append(NODES.powers(NODES.integrals(slope, rows.half, below) / problem.slow_rate))
    x, angle, loss = to_go
    speeds = NODES.powers(V), NODES.powers(delta)
    slow_log = rows.inverse(speeds[0], SPEEDS.x / problem.kappa)
    slow = SlowManifold(
        rows=rows, speeds=speeds, path=(x, angle), loss=loss, slow_log=NODES.powers(slow_log)
    )
    parts.slow[: len(V)] = np.hstack([interleave_pairs(*speeds), interleave_pairs(x, angle), loss])
    parts.manifold[:] = interleave_pairs(
        slow.slow_log, NODES.powers(rows.value(speeds[1], slow_log))
    )
    return slow


def _integrate_manifold(problem: FlowProblem) -> tuple[Rows, Floats, Floats]:
    """Integrate the motion along the slow manifold, from three octaves above the tables down to
    their lowest node.

    It is integrated in steps, each of about the time in which V halves, until kappa V is at most
    1/4, and each step anew from the state before it: the remaining time to the last of these states
    then keeps its digits.  The slow logarithm is 0 at that state, and increases with the time that
    a state precedes it.

    problem : the :class:`FlowProblem`.
    Raises :class:`NoFlowMap` for FULL_SLIP_RETURNS where the motion leaves partial slip, and for
    OUT_OF_RANGE where its numbers are not finite or V does not fall.
    Returns (:class:`Rows` over the slow logarithm, those of :data:`_SLOW_LOG_EDGES` that end below
    its value at the first of these states; V; delta at their nodes, (rows, nodes) each,
    dimensionless).
    """
    rate = problem.slow_rate
    V = np.array([2.0 ** (flow_layout.HIGH + _RUN_IN_OCTAVES) / problem.kappa])
    delta = np.zeros(1)
    gamma = np.ones(1)
    halves = []
    steps = []
    # a step is the time from V to V/2 with M/V as in the middle: (1 + j) V' = -M in time gamma t
    while problem.kappa * V[0] > _SLOW_LOG_ORIGIN:
        between = 0.75 * V
        moment = problem.contact_states(between)[flow_layout.MOMENT]
        step = math.log(2.0) * (1.0 + problem.j) * between / moment
        (V,), (delta,) = problem.integrate(V, delta, gamma, step, FULL_SLIP_RETURNS)
        if not V[0] < between[0]:
            raise NoFlowMap(OUT_OF_RANGE)
        halves.append((V, delta))
        steps.append(rate * step[0])
    # the slow logarithm of each state is the sum of the steps after it; the first step, which leads
    # to the first state, is in none
    starts = np.append(np.cumsum(steps[:0:-1])[::-1], 0.0)
    rows = Rows(_SLOW_LOG_EDGES[: np.searchsorted(_SLOW_LOG_EDGES, starts[0])])
    # in the order of time, in which the slow logarithm falls
    nodes = rows.x.ravel()[::-1]
    states = np.empty((2, nodes.size))
    for (V, delta), start, end in zip(halves, starts, [*starts[1:], -np.inf], strict=True):
        inside = np.flatnonzero((nodes <= start) & (nodes > end))
        if inside.size:
            states[:, inside] = np.concatenate(
                problem.integrate(
                    V, delta, gamma, (start - nodes[inside]) / rate, FULL_SLIP_RETURNS
                )
            )
    V, delta = states[:, ::-1].reshape(2, *rows.x.shape)
    return rows, V, delta


# --- The boundary layers of a flow map after the onset of partial slip ---

#: Nodes of the coordinates of a layer.
_COARSE = Nodes(flow_layout.LAYER_TERMS)
#: Octaves of the layer coordinate u.
_LAYER = octaves(flow_layout.LAYER_LOW, flow_layout.LAYER_HIGH)
#: Number of these octaves before the split.
_OCTAVES_BEFORE_SPLIT = -flow_layout.LAYER_LOW
#: Lower end of u.
_LOWEST_U = 2.0**flow_layout.LAYER_LOW
#: E after the split at which a motion has reached the slow manifold, dimensionless.
_JOIN_E = 2.0**flow_layout.LAYER_HIGH - 1.0
#: Time before the onset of partial slip at which a motion of the layer starts, divided by that from
#: onset to split, or by 1/k0 where the split is still sought: the change of state in it is near the
#: rounding of the integrator.
_LEAD = 1e-6
#: Values of E between which a zero of delta is searched; beyond them the kink of the law is below
#: rounding.
_CROSSINGS = np.linspace(0.0, 14.0, 71)[1:]
#: Nodes of an octave of kappa V at onset for the polynomial of the split, which is smooth.
_SPLIT_NODES = Nodes(6)


def fill_layers(
    problem: FlowProblem,
    sign: float,
    first: int,
    slow: SlowManifold,
    asymptote: Floats,
    layer: Floats,
) -> None:
    """Fill the tables of the boundary layers, and of the motions on the slow manifold that follow
    them, of one family.

    problem : the :class:`FlowProblem`.
    sign : sign of omega - V at onset, 1.0 or -1.0.
    first : binary exponent of the lowest kappa V at onset.
    slow : the :class:`SlowManifold`.
    asymptote : (octave of kappa V at onset, numbers of a row), written: the slow logarithm at onset
    and k0; the split; distance and angle, and slip loss, in excess of the motion on the slow
    manifold.
    layer : (octave of kappa V at onset, octave of u, column, powers of u and kappa V), written;
    columns: ln(V/V0), delta, distance and angle beyond those at constant speed V0, divided by
    V0/k0, and slip loss divided by V0^2.
    Returns nothing.  Raises :class:`NoFlowMap`, with nothing written, for the reason STICK_ENDS
    where a motion of the layer leaves partial slip, and for OUT_OF_RANGE where its start is not
    finite or k0 not positive.
    """
    kappa = problem.kappa
    onsets = octaves(first, first + flow_layout.OCTAVES)
    V0 = onsets.node_positions(_COARSE) / kappa
    k0 = _stiff_rate(problem, V0)
    split_powers = _split_powers(problem, sign, onsets)
    split = np.asarray(polyval(_COARSE.t, split_powers.T), np.float64)
    V, delta, V_end = _layer_motions(problem, sign, V0, k0, split)
    # dE/du: all E up to the split lie between the lowest u and 1; axes (octave, V, octave of u, u)
    half = _LAYER.half * np.where(
        np.arange(_LAYER.half.size) < _OCTAVES_BEFORE_SPLIT,
        split[..., None] / (1.0 - _LOWEST_U),
        1.0,
    )
    V_ratio = V / V0[..., None, None]
    # d(loss)/dE divided by V0^2: the power delta V Q in time gamma t, and dE = k0 d(gamma t)
    loss = (
        delta
        * V_ratio
        * problem.contact_states(V, delta)[flow_layout.TRACTION]
        / (V0 * k0)[..., None, None]
    )
    slopes = V_ratio - 1.0, V_ratio * (1.0 + delta) - 1.0, loss
    columns = [np.log(V_ratio), delta, *(_COARSE.integrals(slope, half) for slope in slopes)]
    for column, values in enumerate(columns):
        # powers of u, then, with the nodes of V as last axis, powers of kappa V
        powers = _COARSE.powers(np.moveaxis(_COARSE.powers(values), 1, -1))
        layer[:, :, column] = powers.reshape(*layer.shape[:2], -1)
    # the motion on the slow manifold that they have reached at the end of the layer
    E = split + _JOIN_E
    x, angle, lost = (_COARSE.end(slope, half) for slope in slopes)
    end = SPEEDS.value(slow.slow_log, kappa * V_end)
    span = problem.slow_rate * E / k0
    slow_log = end + span
    slow_x, slow_angle = slow.path_between(slow_log, span, problem.slow_rate)
    x = V0 / k0 * (E + x) - slow_x
    angle = V0 / k0 * (E + angle) - slow_angle
    lost = V0 * V0 * lost - (slow.rows.value(slow.loss, slow_log) - slow.rows.value(slow.loss, end))
    slow_log_at_V = slow.slow_log[first - flow_layout.LOW :][: flow_layout.OCTAVES]
    # the slow logarithm at onset is that of V0 on the manifold, whose row has 24 powers, plus this
    # smooth difference, for which 12 are enough
    above = _COARSE.powers(slow_log - SPEEDS.value(slow.slow_log, kappa * V0))
    rates = NODES.powers(_stiff_rate(problem, onsets.x / kappa))
    x, angle, lost = (_pad(_COARSE.powers(value)) for value in (x, angle, lost))
    asymptote[:] = np.hstack(
        [
            interleave_pairs(slow_log_at_V + _pad(above), rates),
            _pad(split_powers),
            interleave_pairs(x, angle),
            lost,
        ]
    )


def _stiff_rate(problem: FlowProblem, V: Floats) -> Floats:
    """Return k0 = (1 + 1/j) (dQ/d delta)/V at delta = 0, the rate at which omega - V relaxes in
    time gamma t.

    problem : the :class:`FlowProblem`; kappa, j and the law matter.
    V : speeds, > 0, dimensionless, of any shape.
    Returns the rates, > 0, dimensionless, in the shape of V.
    """
    return (1.0 + 1.0 / problem.j) * problem.contact_states(V)[flow_layout.STIFFNESS] / V


def _state_before_onset(
    problem: FlowProblem, sign: float, V: Floats, gamma: Floats
) -> tuple[Floats, Floats]:
    """Return the state in full slip the time :data:`_LEAD` times ``gamma`` (in gamma t) before the
    onset of partial slip.

    A motion of the layer starts there, so that the integrator finds the onset itself.

    problem : the :class:`FlowProblem`.
    sign : sign of omega - V, 1.0 or -1.0.
    V : speeds at onset, > 0, (n,), dimensionless.
    gamma : unit of the times with which each motion is integrated, in gamma t: the time from onset
    to split, or 1/k0 where the split is still sought; > 0, (n,), dimensionless.
    Returns (V, delta), (n,) each, dimensionless, to first order in that time.
    """
    state = problem.contact_states(V)
    push = sign * problem.mu
    half_moment = 0.5 * state[flow_layout.MOMENT]
    tau = _LEAD * gamma
    # full slip: V' = push - M/2 and j omega' = -(push + M/2) in time gamma t, backward from onset
    before = V - tau * (push - half_moment)
    return before, (
        V * (1.0 + sign * state[flow_layout.DELTA_STAR]) + tau * (push + half_moment) / problem.j
    ) / before - 1.0


def _layer_motions(
    problem: FlowProblem, sign: float, V0: Floats, k0: Floats, split: Floats
) -> tuple[Floats, Floats, Floats]:
    """Integrate the motions of a boundary layer, and return them at the nodes of its tables.

    problem : the :class:`FlowProblem`.
    sign : sign of omega - V at onset, 1.0 or -1.0.
    V0 : speeds at onset, (octaves, nodes), dimensionless.
    k0 : relaxation rates of omega - V at these onsets, (octaves, nodes).
    split : E, the time since the onset in units of 1/k0, at which the table is divided, from
    :func:`_split_powers`, (octaves, nodes).
    Raises :class:`NoFlowMap` where a motion leaves partial slip, or its numbers are not finite.
    Returns (V; delta, both (octave, node of V, octave of u, node of u); V at the end of the layer,
    (octave, node of V)), dimensionless.
    """
    u = _LAYER.node_positions(_COARSE)
    # with this gamma t = 1 is the split: the times E/split are common to all motions
    gamma = (split / k0).ravel()
    starts = _state_before_onset(problem, sign, V0.ravel(), gamma)
    before = _LEAD + np.append((u[:_OCTAVES_BEFORE_SPLIT] - _LOWEST_U) / (1.0 - _LOWEST_U), 1.0)
    V, delta = problem.integrate(*starts, gamma, before, STICK_ENDS)
    V_on, delta_on = problem.integrate(
        V[:, -1],
        delta[:, -1],
        1.0 / k0.ravel(),
        np.append(u[_OCTAVES_BEFORE_SPLIT:] - 1.0, _JOIN_E),
        STICK_ENDS,
    )
    shape = (*V0.shape, _LAYER.half.size, _COARSE.t.size)
    V_whole, delta_whole = (
        np.hstack([a[:, :-1], b[:, :-1]]).reshape(shape) for a, b in ((V, V_on), (delta, delta_on))
    )
    return V_whole, delta_whole, V_on[:, -1].reshape(V0.shape)


def _split_powers(problem: FlowProblem, sign: float, onsets: Rows) -> Floats:
    """Fit the value of E at which delta passes 0 by polynomials of kappa V at onset, one for each
    octave.

    In an octave in which delta does not pass 0 up to E = 14 at every node, the value is 1.

    problem : the :class:`FlowProblem`.
    sign : sign of omega - V at onset, 1.0 or -1.0.  delta passes 0 only in motions of the sign of
    1 - j, so that for the other sign, and for j = 1, all values are 1.
    onsets : :class:`Rows`, octaves of kappa V at onset.
    Raises :class:`NoFlowMap` where a motion leaves partial slip, or its numbers are not finite.
    Returns coefficients of powers of t in [-1, 1] on each octave, ascending, (octaves, powers), for
    E, dimensionless.
    """
    powers = np.zeros((onsets.half.size, _SPLIT_NODES.t.size))
    powers[:, 0] = 1.0
    if sign != np.sign(1.0 - problem.j):
        return powers
    V = (onsets.node_positions(_SPLIT_NODES) / problem.kappa).ravel()
    gamma = 1.0 / _stiff_rate(problem, V)
    _, delta = problem.integrate(
        *_state_before_onset(problem, sign, V, gamma), gamma, _LEAD + _CROSSINGS, STICK_ENDS
    )
    passed = sign * delta < 0.0
    # two points on either side of the first change of sign
    index = np.clip(passed.argmax(axis=1), 2, _CROSSINGS.size - 2)[:, None] + np.arange(-2, 2)
    E = _CROSSINGS[index]
    delta = np.take_along_axis(delta, index, axis=1)
    # E as the cubic of delta through the four points, at delta = 0, in the form of Lagrange
    split = np.zeros(V.size)
    for n in range(4):
        others = [delta[:, m] / (delta[:, m] - delta[:, n]) for m in range(4) if m != n]
        split += E[:, n] * np.prod(others, axis=0)
    split = split.reshape(powers.shape)
    # only octaves in which delta passes 0 at every node: the others keep 1
    turns = np.all(passed.any(axis=1).reshape(powers.shape), axis=1)
    powers[turns] = _SPLIT_NODES.powers(split[turns])
    return powers


def _pad(powers: Floats) -> Floats:
    """Return coefficients padded with zeros to the number of powers of functions of one variable.

    powers : coefficients, ascending, (rows, powers), at most as many powers as :data:`NODES` has
    nodes.
    Returns a new array (rows, nodes).
    """
    return np.pad(powers, [(0, 0), (0, NODES.t.size - powers.shape[-1])])
