"""What rows are made of: g/z, h/z and the parts of m by the modes of a series, with slopes, at four places of z.

As :mod:`..material.series`, whose system B x = sqrt(r) e is differentiated: with x' = sqrt(r) x~,

    B x~ = (r'/r) x - sqrt(r) Q^T k' f      f' = Q sqrt(r) x~      X_i' = e_i (x~ - (r'/r) x)_i/sqrt(r_i)
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ..compile.jit import kernel
from ..material.series import LANES, Room, ratios, room, solve_four, substitute
from ..numerics.four import add, divide, four, load, multiply, spread, store, subtract

#: functions of w = 1/z that rows are made of: g/z, h/z, m of the half-space and of the cylinder
SHIFT, RISE, HALF_SPACE, CYLINDER = range(4)
FUNCTIONS = 4


class Sloped(NamedTuple):
    """Room of the modes, and for slopes, four numbers each, of x~, f, X and i2; then values and slopes found."""

    room: Room
    x: Any
    f: Any
    X: Any
    i2: Any
    found: Any


@kernel(allocates=True)
def sloped_room(series):
    """Room for the evaluations of a series of two bodies."""
    count = LANES * series.a.size
    return Sloped(
        room(series),
        np.empty(count),
        np.empty(count),
        np.empty(count),
        np.empty(count),
        np.empty(2 * LANES * FUNCTIONS),
    )


@kernel
def _slopes_of_i2(places, series, work):
    for i in range(series.a.size):
        for c in range(LANES):
            at, a = LANES * i + c, series.a[i]
            x, root, i2 = a * places[c], work.room.root[at], work.room.i2[at]
            r = root * root
            rise = a * (r - (2.0 / x + r) * i2) if x < 4.0 else 2.0 * (a * r / x - work.room.slope_r[at]) / x
            work.i2[at] = rise


@kernel
def _slopes(series, work):
    """x~, slopes of f and X."""
    known, count = work.room, series.a.size
    for i in range(count):
        root, x = load(known.root, LANES * i), load(known.x, LANES * i)
        total = spread(0.0)
        for j in range(count):
            bend = multiply(load(known.slope_k, LANES * j), load(known.f, LANES * j))
            total = add(total, multiply(spread(series.Q[j, i]), bend))
        rise = multiply(divide(load(known.slope_r, LANES * i), multiply(root, root)), x)
        store(work.X, LANES * i, rise)
        store(work.x, LANES * i, subtract(rise, multiply(root, total)))
    substitute(known.matrix, work.x, count)
    for i in range(count):
        rise = subtract(load(work.x, LANES * i), load(work.X, LANES * i))
        store(work.X, LANES * i, multiply(spread(series.e[i]), divide(rise, load(known.root, LANES * i))))
    for j in range(count):
        total = spread(0.0)
        for i in range(count):
            weighted = multiply(spread(series.Q[j, i]), load(known.root, LANES * i))
            total = add(total, multiply(weighted, load(work.x, LANES * i)))
        store(work.f, LANES * j, total)


@kernel(inline=True)
def _put(function, value, slope, work):
    """A function of w = 1/z and its slope over ln w."""
    store(work.found, 2 * LANES * function, value)
    store(work.found, 2 * LANES * function + LANES, slope)


@kernel
def functions(places, series, work):
    """Fill ``found`` at four places z > 0: of every function four values, then four slopes over ln(1/z)."""
    ratios(places, True, series, work.room)
    solve_four(series, work.room)
    _slopes_of_i2(places, series, work)
    _slopes(series, work)
    known, z = work.room, four(places[0], places[1], places[2], places[3])
    g, h, dg, dh, pressed, d_pressed = spread(0.0), spread(0.0), spread(0.0), spread(0.0), spread(0.0), spread(0.0)
    for i in range(series.a.size):
        at = LANES * i
        root, x, f, e, t = load(known.root, at), load(known.x, at), load(known.f, at), series.e[i], series.t[i]
        k, slope_k, X, i2 = load(known.k, at), load(known.slope_k, at), load(known.X, at), load(known.i2, at)
        h = add(h, multiply(multiply(root, spread(e)), x))
        g = add(g, multiply(multiply(spread(t), k), f))
        dg = add(dg, multiply(spread(t), add(multiply(slope_k, f), multiply(k, load(work.f, at)))))
        per = divide(x, root)
        dh = add(dh, multiply(load(known.slope_r, at), multiply(per, per)))
        dh = subtract(dh, multiply(slope_k, multiply(f, f)))
        pressed = add(pressed, multiply(X, i2))
        d_pressed = add(d_pressed, add(multiply(load(work.X, at), i2), multiply(X, load(work.i2, at))))
    shift, rise = divide(g, z), divide(h, z)
    _put(SHIFT, shift, subtract(shift, dg), work)
    _put(RISE, rise, subtract(rise, dh), work)
    lam2 = divide(spread(1.0), add(spread(1.0), multiply(spread(2.0), rise)))
    d_lam2 = multiply(multiply(spread(2.0), multiply(lam2, lam2)), divide(subtract(rise, dh), z))
    m = add(g, multiply(lam2, pressed))
    dm = add(dg, add(multiply(d_lam2, pressed), multiply(lam2, d_pressed)))
    dm = multiply(subtract(spread(0.0), z), dm)
    if series.weights.size > 0:
        _parts(m, dm, lam2, d_lam2, z, series, work)
    else:
        half = spread(0.5)
        _put(HALF_SPACE, multiply(half, m), multiply(half, dm), work)
        _put(CYLINDER, multiply(half, m), multiply(half, dm), work)


@kernel
def _parts(m, dm, lam2, d_lam2, z, series, work):
    """m of either body, as :func:`..material.series.shares` has it, and slopes over ln(1/z).

    What the two together differ from m by, they take in proportion.
    """
    known, count = work.room, series.a.size
    for i in range(count):
        own, d_own, a = load(known.i2, LANES * i), load(work.i2, LANES * i), series.a[i]
        u, du = own, d_own
        for n in range(count):
            at = LANES * n
            weight = spread(a * series.a[n] / (a + series.a[n]))
            apart, d_apart = subtract(own, load(known.i2, at)), subtract(d_own, load(work.i2, at))
            X = load(known.X, at)
            u = add(u, multiply(weight, multiply(X, apart)))
            du = add(du, multiply(weight, add(multiply(load(work.X, at), apart), multiply(X, d_apart))))
        X, per = load(known.X, LANES * i), spread(1.0 / series.e[i])
        rise = add(multiply(load(work.X, LANES * i), u), multiply(X, du))
        pressed = multiply(X, u)
        # x is not asked for any more
        store(work.x, LANES * i, multiply(per, add(multiply(rise, lam2), multiply(pressed, d_lam2))))
        store(known.x, LANES * i, multiply(per, multiply(pressed, lam2)))
    half_space, cylinder, d_half_space, d_cylinder = spread(0.0), spread(0.0), spread(0.0), spread(0.0)
    for j in range(count):
        at, k, slope_k = LANES * j, load(known.k, LANES * j), load(known.slope_k, LANES * j)
        share = multiply(k, load(known.f, at))
        d_share = add(multiply(slope_k, load(known.f, at)), multiply(k, load(work.f, at)))
        for i in range(count):
            share = add(share, multiply(spread(series.Q[j, i]), load(known.x, LANES * i)))
            d_share = add(d_share, multiply(spread(series.Q[j, i]), load(work.x, LANES * i)))
        own, other = spread(series.weights[j] * series.t[j]), spread((1.0 - series.weights[j]) * series.t[j])
        half_space, cylinder = add(half_space, multiply(own, share)), add(cylinder, multiply(other, share))
        d_half_space = add(d_half_space, multiply(own, d_share))
        d_cylinder = add(d_cylinder, multiply(other, d_share))
    whole, minus = divide(m, add(half_space, cylinder)), subtract(spread(0.0), z)
    half_space, cylinder = multiply(half_space, whole), multiply(cylinder, whole)
    d_half_space, d_cylinder = multiply(minus, d_half_space), multiply(minus, d_cylinder)
    miss = divide(subtract(dm, add(d_half_space, d_cylinder)), m)
    _put(HALF_SPACE, half_space, add(d_half_space, multiply(miss, half_space)), work)
    _put(CYLINDER, cylinder, add(d_cylinder, multiply(miss, cylinder)), work)
