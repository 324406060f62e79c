"""The functions of :mod:`series` with slopes over ln(1/z), at many places.

The system B x = sqrt(r) e is differentiated: with y = sqrt(r) x and y' = sqrt(r) x~,

    B x~ = (r'/r) x - sqrt(r) Q^T k' f      f' = Q y'      X_i' = e_i (x~ - (r'/r) x)_i/sqrt(r_i)
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ..bessel.ratios import ratio_i2, ratios_and_slopes
from ..compile.jit import kernel
from ..numerics.four import add, divide, four, load, multiply, spread, store, subtract
from .series import CYLINDER, FUNCTIONS, HALF_SPACE, LANES, RISE, SHIFT, Room, room_of, rooted, substitute, values


class Sloped(NamedTuple):
    """Room of the modes; for slopes, four numbers each, of x~, f, X and i2; and those found, four a function."""

    room: Room
    x: Any
    f: Any
    X: Any
    i2: Any
    found: Any


def sloped_room(modes: int) -> Sloped:
    """Room for a series of so many modes."""
    return Sloped(room_of(modes), *(np.empty(LANES * modes) for _ in range(4)), np.empty(LANES * FUNCTIONS))


@kernel
def _slopes(places, series, work):
    """Slopes of i2, x~, slopes of X and f."""
    known, count = work.room, series.a.size
    for at in range(LANES * count):
        a = series.a[at // LANES]
        x, root, i2 = a * places[at % LANES], known.root[at], known.i2[at]
        r = root * root
        near = a * (r - (2.0 / x + r) * i2)
        work.i2[at] = near if x < 4.0 else 2.0 * (a * r / x - known.slope_r[at]) / x
    for i in range(count):
        root, total = load(known.root, LANES * i), spread(0.0)
        for j in range(count):
            bend = multiply(load(known.slope_k, LANES * j), load(known.f, LANES * j))
            total = add(total, multiply(spread(series.Q[j, i]), bend))
        rise = multiply(divide(load(known.slope_r, LANES * i), multiply(root, root)), load(known.x, LANES * i))
        store(work.X, LANES * i, rise)
        store(work.x, LANES * i, subtract(rise, multiply(root, total)))
    substitute(known.matrix, work.x, count)
    for i in range(count):
        rise = subtract(load(work.x, LANES * i), load(work.X, LANES * i))
        store(work.X, LANES * i, multiply(spread(series.e[i]), divide(rise, load(known.root, LANES * i))))
    rooted(work.x, series, known, work.f)


@kernel
def _share_slopes(lam2, d_lam2, series, work):
    """Slopes of what either body's creep modes have in m; x~ is spoilt."""
    known, count = work.room, series.a.size
    for i in range(count):
        at, a = LANES * i, series.a[i]
        own, d_own = load(known.i2, at), load(work.i2, at)
        du = d_own
        for n in range(count):
            weight, X = spread(a * series.a[n] / (a + series.a[n])), load(known.X, LANES * n)
            apart, d_apart = subtract(own, load(known.i2, LANES * n)), subtract(d_own, load(work.i2, LANES * n))
            rise = add(multiply(load(work.X, LANES * n), apart), multiply(X, d_apart))
            du = add(du, multiply(weight, rise))
        X, u, per = load(known.X, at), load(known.u, at), spread(1.0 / series.e[i])
        rise, pressed = add(multiply(load(work.X, at), u), multiply(X, du)), multiply(X, u)
        store(work.x, at, multiply(per, add(multiply(rise, lam2), multiply(pressed, d_lam2))))
    half_space, cylinder = spread(0.0), spread(0.0)
    for j in range(count):
        at = LANES * j
        share = add(multiply(load(known.slope_k, at), load(known.f, at)), multiply(load(known.k, at), load(work.f, at)))
        for i in range(count):
            share = add(share, multiply(spread(series.Q[j, i]), load(work.x, LANES * i)))
        half_space = add(half_space, multiply(spread(series.weights[j] * series.t[j]), share))
        cylinder = add(cylinder, multiply(spread((1.0 - series.weights[j]) * series.t[j]), share))
    return half_space, cylinder


@kernel
def functions(places, series, work):
    """Fill the room and ``found`` at four places z > 0: of every function four slopes."""
    values(places, True, series, work.room)
    _slopes(places, series, work)
    known, z, one = work.room, four(places[0], places[1], places[2], places[3]), spread(1.0)
    shift, rise = load(known.found, LANES * SHIFT), load(known.found, LANES * RISE)
    m, lam2 = load(known.found, LANES * FUNCTIONS), divide(one, add(one, add(rise, rise)))
    dg, dh, pressed, d_pressed = spread(0.0), spread(0.0), spread(0.0), spread(0.0)
    for i in range(series.a.size):
        at = LANES * i
        x, f, t = load(known.x, at), load(known.f, at), spread(series.t[i])
        slope_k, X, i2 = load(known.slope_k, at), load(known.X, at), load(known.i2, at)
        dg = add(dg, multiply(t, add(multiply(slope_k, f), multiply(load(known.k, at), load(work.f, at)))))
        per = divide(x, load(known.root, at))
        bend = subtract(multiply(load(known.slope_r, at), multiply(per, per)), multiply(slope_k, multiply(f, f)))
        dh, pressed = add(dh, bend), add(pressed, multiply(X, i2))
        d_pressed = add(d_pressed, add(multiply(load(work.X, at), i2), multiply(X, load(work.i2, at))))
    d_lam2 = multiply(multiply(spread(2.0), multiply(lam2, lam2)), divide(subtract(rise, dh), z))
    dm = add(dg, add(multiply(d_lam2, pressed), multiply(lam2, d_pressed)))
    minus = subtract(spread(0.0), z)
    dm = multiply(minus, dm)
    half_space = cylinder = multiply(spread(0.5), dm)
    if series.weights.size > 0:
        half_space, cylinder = _share_slopes(lam2, d_lam2, series, work)
        half_space, cylinder = multiply(minus, half_space), multiply(minus, cylinder)
        miss = divide(subtract(dm, add(half_space, cylinder)), m)
        half_space = add(half_space, multiply(miss, load(known.found, LANES * HALF_SPACE)))
        cylinder = add(cylinder, multiply(miss, load(known.found, LANES * CYLINDER)))
    store(work.found, LANES * SHIFT, subtract(shift, dg))
    store(work.found, LANES * RISE, subtract(rise, dh))
    store(work.found, LANES * HALF_SPACE, half_space)
    store(work.found, LANES * CYLINDER, cylinder)


@kernel
def functions_loop(series, work, z, out):
    """Values and slopes of the functions, a row each, at the places z, whose number is one of fours."""
    for n in range(0, z.size, LANES):
        functions((z[n], z[n + 1], z[n + 2], z[n + 3]), series, work)
        for at in range(work.found.size):
            row, place = at // LANES, n + at % LANES
            out[2 * row, place], out[2 * row + 1, place] = work.room.found[at], work.found[at]


@kernel
def functions_of_alpha_loop(alpha, z, out):
    """Likewise of one relaxation time, by its Bessel ratios, which is less to compile.

    With p = r(alpha z) k(z), c = (alpha - 1)/alpha: g = c p/(1 + p), h = c r/(1 + p), m = c (lam^2 i2 + p)/(1 + p).
    """
    c = (alpha - 1.0) / alpha
    for n in range(z.size):
        x, r, k, s, dk, per_x, per_z = ratios_and_slopes(z[n], alpha)
        dr, p = alpha * s, r * k
        dp, whole, i2 = dr * k + r * dk, 1.0 / (1.0 + p), ratio_i2(x, r)
        share = c * whole
        g, h, dg, dh = share * p, share * r, share * whole * dp, share * whole * (dr - r * r * dk)
        lam2 = 1.0 / (1.0 + 2.0 * h * per_z)
        d_lam2 = -2.0 * lam2 * lam2 * ((dh - h * per_z) * per_z)
        m = c * (lam2 * i2 + r * k) * whole
        dm = whole * (c * (d_lam2 * i2 + lam2 * (alpha * 2.0 * (r * r - i2) * per_x) + dp) - m * dp)
        shift, rise = g / z[n], h / z[n]
        out[0, n], out[1, n], out[2, n], out[3, n] = shift, shift - dg, rise, rise - dh
        out[4, n], out[5, n], out[6, n], out[7, n] = 0.5 * m, -0.5 * z[n] * dm, 0.5 * m, -0.5 * z[n] * dm
