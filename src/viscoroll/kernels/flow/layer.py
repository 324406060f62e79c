"""Flow map, boundary layer: one motion behind its entry into partial slip, in the stiff time E.

Three families of motions: those that enter the stick zone with omega > V or omega < V, and
those that start from delta = 0, where the law bends (Q has a corner in its second slope).
Within a family the law keeps the sign of delta, so its motions are smooth in both variables;
one that reaches delta = 0 changes families there.

A motion is collocated at Radau's nodes on panels of E: (y, D) of :mod:`motion.partial_slip`, by Newton's
iteration in D, which is stiff, and by substitution in y, which hardly moves: half the time that
:mod:`motion.radau` takes, which presumes nothing.  What the table holds are functions of the two and
integrals of such.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ..compile.jit import kernel
from ..free.collocation import INTEGRALS, NODES, SLOPES, N, fit_terms, polynomial
from ..free.partial_slip import branch_rates
from ..law.length import contact_length
from ..material.functions import generator_slopes
from ..numerics.bracket import narrowed, secant
from ..numerics.linear import eliminate
from ..numerics.nodes import Interpolation, chebyshev
from .layout import E_LOW, FAST_COEFFICIENTS, LAYER_ANGLE, LAYER_COLUMNS, LAYER_CREEP, LAYER_LN_V, LAYER_LOSS, LAYER_X

#: Chebyshev's nodes of a bin of E
FAST = Interpolation(chebyshev(FAST_COEFFICIENTS))
FAST_NODES = FAST.nodes
#: rows of the values at the nodes of a panel, behind the columns of the table: slopes over E of its integrals, the
#: unknowns, their slopes, and the derivatives of these with respect to D
_D_X, _D_ANGLE, _D_LOSS, _Y, _D, _D_Y, _D_D, _Y_OF_D, _D_OF_D = range(LAYER_COLUMNS, LAYER_COLUMNS + 9)
_ROWS = LAYER_COLUMNS + 9
#: length of the first panel behind the edge of the stick zone, at most and at least (rounding), of the longest, and
#: of the shortest over the first
_FIRST, _LEAST, _LONGEST, _SHORTEST = 2.0**-11, 1e-12, 8.0, 1e-3
_MOST_ITERATIONS, _CONVERGED, _ROUNDING = 30, 1e-11, 1e-13


class Onset(NamedTuple):
    """Where a motion of a layer starts: V, whether at the edge of the stick zone, the sign of delta, the stiff rate."""

    V: Any
    entering: Any
    sign: Any
    rate: Any
    scene: Any


class Reached(NamedTuple):
    """What the table of a layer holds at E: ln(V/V0), excess of distance and angle, slip loss over V0^2."""

    E: Any
    ln_V: Any
    x: Any
    angle: Any
    loss: Any


@kernel
def stiff_rate(V, scene):
    """k0 = (1 + 1/j) (dQ/d delta)/V at delta = 0, the rate at which omega - V relaxes."""
    material, kappa, _, j = scene
    lam, _ = contact_length(kappa * V, material)
    zeta = lam / (2.0 * kappa * V)
    _, h, dg, dh = generator_slopes(zeta, material)
    return (1.0 + 1.0 / j) * 4.0 * kappa * lam * (1.0 + h / zeta + dh) / ((1.0 + dg) * V)


@kernel
def fast_bin_ends(b, low):
    """Ends of bin b of E; the first is [0, 2**low)."""
    if b == 0:
        return 0.0, 2.0**low
    if b < 1 - low:
        return 2.0 ** (low + b - 1), 2.0 ** (low + b)
    octave, half = (b - (1 - low)) // 2, (b - (1 - low)) % 2
    return (1.0 + 0.5 * half) * 2.0**octave, (1.5 + 0.5 * half) * 2.0**octave


@kernel
def _evaluate(i, onset, nodes):
    """Fill node i from its y and D."""
    dy, dD, V, delta, _, dy_D, dD_D, _, q_over_V = branch_rates(nodes[_Y, i], nodes[_D, i], onset.sign, onset.scene)
    per_rate, share = 1.0 / onset.rate, V / onset.V
    nodes[_D_Y, i], nodes[_D_D, i] = dy * per_rate, dD * per_rate
    nodes[_Y_OF_D, i], nodes[_D_OF_D, i] = dy_D * per_rate, dD_D * per_rate
    nodes[LAYER_LN_V, i], nodes[LAYER_CREEP, i] = np.log(share), delta
    nodes[_D_X, i], nodes[_D_ANGLE, i] = share - 1.0, share * (1.0 + delta) - 1.0
    nodes[_D_LOSS, i] = delta * share * share * q_over_V * per_rate


@kernel
def _newton(half, onset, nodes, matrix, right):
    """One iteration on a panel of length 2 ``half``; the sum of changes, which NaN is not lost in, relative to zeta."""
    for i in range(N):
        _evaluate(i + 1, onset, nodes)
        right[i] = half * nodes[_D_D, i + 1]
        for n in range(N + 1):
            right[i] -= SLOPES[i, n] * nodes[_D, n]
        for n in range(N):
            matrix[i, n] = SLOPES[i, n + 1]
        matrix[i, i] -= half * nodes[_D_OF_D, i + 1]
    eliminate(matrix, right)
    change = 0.0
    for i in range(1, N + 1):
        y = nodes[_Y, 0]
        for n in range(N):
            y += half * INTEGRALS[i - 1, n] * (nodes[_D_Y, n + 1] + nodes[_Y_OF_D, n + 1] * right[n])
        change += abs(y - nodes[_Y, i]) + abs(right[i - 1]) * np.exp(-y)
        nodes[_Y, i] = y
        nodes[_D, i] += right[i - 1]
    return change


@kernel
def _collocate(half, onset, nodes, matrix, right):
    """Solve for y and D on a panel of length 2 ``half``; whether they were found."""
    for i in range(1, N + 1):  # first guess: the slope of D falls like exp(-E)
        nodes[_Y, i] = nodes[_Y, 0]
        nodes[_D, i] = nodes[_D, 0] - nodes[_D_D, 0] * np.expm1(-half * (1.0 + NODES[i]))
    for _ in range(_MOST_ITERATIONS):
        change = _newton(half, onset, nodes, matrix, right)
        if change < _CONVERGED or not change < 1e3:
            break
    return change < _CONVERGED


@kernel
def _panel(length, onset, nodes, matrix, right):
    """Roll over a panel from node 0, or a part of it: (its length, whether it was found and the stick zone lasts)."""
    shortest = _SHORTEST * length
    while not _collocate(0.5 * length, onset, nodes, matrix, right):
        length *= 0.5
        if length < shortest:
            return length, False
    lasts = True
    for n in range(N):
        for row in (LAYER_X, LAYER_ANGLE, LAYER_LOSS):
            nodes[row, n + 1] = nodes[row, 0]
            for m in range(N):
                nodes[row, n + 1] += 0.5 * length * INTEGRALS[n, m] * nodes[row - LAYER_X + _D_X, m + 1]
        lasts = lasts and onset.sign * nodes[_D, n + 1] * np.exp(-nodes[_Y, n + 1]) <= 1.0 + _ROUNDING
    return length, lasts


@kernel
def _reached(E, t, powers):
    """The columns at t in [-1, 1], which is E."""
    return Reached(
        E, polynomial(t, powers, LAYER_LN_V), polynomial(t, powers, LAYER_X), polynomial(t, powers, LAYER_ANGLE),
        polynomial(t, powers, LAYER_LOSS),
    )  # fmt: skip


@kernel
def _crossing(sign, powers):
    """t in [-1, 1] where delta, of this sign at -1 and not at 1, is 0 (Illinois)."""
    low, high, side = -1.0, 1.0, 0
    at_low, at_high = sign * polynomial(low, powers, LAYER_CREEP), sign * polynomial(high, powers, LAYER_CREEP)
    while high - low > 1e-15 and at_high < 0.0:
        t = secant(low, high, at_low, at_high)
        value = sign * polynomial(t, powers, LAYER_CREEP)
        low, high, at_low, at_high, side = narrowed(low, high, at_low, at_high, side, t, value)
    return high


@kernel
def _start(onset, nodes):
    """Fill node 0; length of the first panel."""
    scene = onset.scene
    lam, _ = contact_length(scene.kappa * onset.V, scene.material)
    zeta = lam / (2.0 * scene.kappa * onset.V)
    nodes[_Y, 0], nodes[_D, 0] = np.log(zeta), onset.sign * zeta if onset.entering else 0.0
    nodes[LAYER_X, 0] = nodes[LAYER_ANGLE, 0] = nodes[LAYER_LOSS, 0] = 0.0
    _evaluate(0, onset, nodes)
    if not onset.entering:
        return _LONGEST
    # the law bends where the stick zone is as small as eta = 1/alpha, and like eta ln eta from 0 on
    return max(min(0.25 * scene.material.tau / zeta, _FIRST), _LEAST)


@kernel
def _sample(b, ends, E, length, powers, values):
    """Fill the nodes of bin b, with these ends, that lie on the panel of this length from E."""
    left, right = ends
    for n in range(FAST_COEFFICIENTS):
        t = (left + 0.5 * (right - left) * (1.0 + FAST_NODES[n]) - E) / (0.5 * length) - 1.0
        if abs(t) <= 1.0 + _ROUNDING:
            for column in range(LAYER_COLUMNS):
                values[b, column, n] = polynomial(t, powers, column)


@kernel(allocates=True)
def layer_motion(onset, values):
    """One motion: ``values[bin, column, node]``, and (whether it lasts, where delta = 0, the end).

    E < 0 where delta = 0 is not passed, or where the motion starts.
    """
    nodes, powers = np.empty((_ROWS, N + 1)), np.empty((LAYER_COLUMNS, N + 2))
    matrix, right = np.empty((N, N)), np.empty(N)
    first = _start(onset, nodes)
    E, crossing, end = 0.0, Reached(-1.0, 0.0, 0.0, 0.0, 0.0), Reached(0.0, 0.0, 0.0, 0.0, 0.0)
    for b in range(values.shape[0]):
        ends = fast_bin_ends(b, E_LOW if onset.entering else 0)
        while E < ends[1]:
            ahead = min(ends[1] - E, max(0.5 * E, first), _LONGEST)
            length, lasts = _panel(ahead, onset, nodes, matrix, right)
            if not lasts:
                return False, crossing, end
            for row in range(LAYER_COLUMNS):
                fit_terms(nodes[row], powers[row])
            if onset.entering and crossing.E < 0.0 and onset.sign * nodes[LAYER_CREEP, N] <= 0.0:
                t = _crossing(onset.sign, powers)
                crossing = _reached(E + 0.5 * length * (1.0 + t), t, powers)
            _sample(b, ends, E, length, powers, values)
            E = ends[1] if length == ends[1] - E else E + length
            end = _reached(E, 1.0, powers)
            for row in range(_ROWS):
                nodes[row, 0] = nodes[row, N]
    return True, crossing, end
