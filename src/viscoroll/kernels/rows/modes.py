"""What rows are made of: g/z, h/z and the parts of m by the modes of a series, with slopes, at many places of z.

As :mod:`..material.series`, whose system B x = sqrt(r) e is differentiated: with y = sqrt(r) x and y' = sqrt(r) x~,

    B x~ = (r'/r) x - sqrt(r) Q^T k' f      f' = Q y'      X_i' = e_i (x~ - (r'/r) x)_i/sqrt(r_i)
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ..compile.choice import by_record
from ..compile.jit import kernel
from ..material.series import FOUND, LANES, Parts, Room, Series, ratios, solve_four, substitute
from ..material.standard import at_contact, standard
from ..numerics.four import add, divide, four, load, multiply, spread, store, subtract

#: functions of w = 1/z that rows are made of: g/z, h/z, m of the half-space and of the cylinder
SHIFT, RISE, HALF_SPACE, CYLINDER = range(4)
FUNCTIONS = 4
_FOUND = 2 * LANES * FUNCTIONS


class Sloped(NamedTuple):
    """Room of the modes, and for slopes, four numbers each, of x~, f, X and i2; values and slopes found."""

    room: Room
    x: Any
    f: Any
    X: Any
    i2: Any
    found: Any


def sloped_room(modes: int) -> Sloped:
    """Room for a series of so many modes."""
    four, room = LANES * modes, len(Room._fields) - 2
    arrays = [np.empty(four) for _ in range(room)]
    return Sloped(
        Room(*arrays, np.empty(four * modes), np.empty(FOUND)), *(np.empty(four) for _ in range(4)), np.empty(_FOUND)
    )


@kernel
def _slopes_of_i2(places, series, work):
    for at in range(LANES * series.a.size):
        a = series.a[at // LANES]
        x, root, i2 = a * places[at % LANES], work.room.root[at], work.room.i2[at]
        r = root * root
        near = a * (r - (2.0 / x + r) * i2)
        work.i2[at] = near if x < 4.0 else 2.0 * (a * r / x - work.room.slope_r[at]) / x


@kernel
def _slopes(series, work):
    """x~, slopes of f and X."""
    known, count = work.room, series.a.size
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
def _halves(m, dm, lam2, d_lam2, z, series, work):
    """m and its slope over ln(1/z) in halves: bodies that are alike."""
    half = spread(0.5)
    _put(HALF_SPACE, multiply(half, m), multiply(half, dm), work)
    _put(CYLINDER, multiply(half, m), multiply(half, dm), work)


@kernel
def _parts(m, dm, lam2, d_lam2, z, series, work):
    """What either body has in them, as :func:`..material.series.shares` has it.

    What the two together differ by, they take in proportion.
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
        rise, pressed = add(multiply(load(work.X, LANES * i), u), multiply(X, du)), multiply(X, u)
        # x is not asked for any more
        store(work.x, LANES * i, multiply(per, add(multiply(rise, lam2), multiply(pressed, d_lam2))))
        store(known.x, LANES * i, multiply(per, multiply(pressed, lam2)))
    half_space, cylinder, d_half_space, d_cylinder = spread(0.0), spread(0.0), spread(0.0), spread(0.0)
    for j in range(count):
        at = LANES * j
        k, f = load(known.k, at), load(known.f, at)
        share, d_share = multiply(k, f), add(multiply(load(known.slope_k, at), f), multiply(k, load(work.f, at)))
        for i in range(count):
            share = add(share, multiply(spread(series.Q[j, i]), load(known.x, LANES * i)))
            d_share = add(d_share, multiply(spread(series.Q[j, i]), load(work.x, LANES * i)))
        own, other = spread(series.weights[j] * series.t[j]), spread((1.0 - series.weights[j]) * series.t[j])
        half_space, cylinder = add(half_space, multiply(own, share)), add(cylinder, multiply(other, share))
        d_half_space, d_cylinder = add(d_half_space, multiply(own, d_share)), add(d_cylinder, multiply(other, d_share))
    whole, minus = divide(m, add(half_space, cylinder)), subtract(spread(0.0), z)
    half_space, cylinder = multiply(half_space, whole), multiply(cylinder, whole)
    d_half_space, d_cylinder = multiply(minus, d_half_space), multiply(minus, d_cylinder)
    miss = divide(subtract(dm, add(d_half_space, d_cylinder)), m)
    _put(HALF_SPACE, half_space, add(d_half_space, multiply(miss, half_space)), work)
    _put(CYLINDER, cylinder, add(d_cylinder, multiply(miss, cylinder)), work)


_share = by_record(5, (Series, _halves), (Parts, _parts))


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
        root, x, f, t = load(known.root, at), load(known.x, at), load(known.f, at), spread(series.t[i])
        k, slope_k, X, i2 = load(known.k, at), load(known.slope_k, at), load(known.X, at), load(known.i2, at)
        h = add(h, multiply(multiply(root, spread(series.e[i])), x))
        g = add(g, multiply(multiply(t, k), f))
        dg = add(dg, multiply(t, add(multiply(slope_k, f), multiply(k, load(work.f, at)))))
        per = divide(x, root)
        bend = subtract(multiply(load(known.slope_r, at), multiply(per, per)), multiply(slope_k, multiply(f, f)))
        dh, pressed = add(dh, bend), add(pressed, multiply(X, i2))
        d_pressed = add(d_pressed, add(multiply(load(work.X, at), i2), multiply(X, load(work.i2, at))))
    shift, rise = divide(g, z), divide(h, z)
    _put(SHIFT, shift, subtract(shift, dg), work)
    _put(RISE, rise, subtract(rise, dh), work)
    one = spread(1.0)
    lam2 = divide(one, add(one, add(rise, rise)))
    d_lam2 = multiply(multiply(spread(2.0), multiply(lam2, lam2)), divide(subtract(rise, dh), z))
    m = add(g, multiply(lam2, pressed))
    dm = add(dg, add(multiply(d_lam2, pressed), multiply(lam2, d_pressed)))
    _share(m, multiply(subtract(spread(0.0), z), dm), lam2, d_lam2, z, series, work)


@kernel
def functions_loop(series, work, z, out):
    """Values and slopes over ln(1/z) of the functions, a row each, at the places z, whose number is one of fours."""
    for n in range(0, z.size, LANES):
        functions((z[n], z[n + 1], z[n + 2], z[n + 3]), series, work)
        for at in range(work.found.size):
            out[at // LANES, n + at % LANES] = work.found[at]


@kernel
def functions_of_alpha_loop(alpha, z, out):
    """Likewise of one relaxation time, by its Bessel ratios: less to compile."""
    material = standard(alpha)
    for n in range(z.size):
        g, h, dg, dh, m, dm, _, _ = at_contact(z[n], material)
        shift, rise = g / z[n], h / z[n]
        out[0, n], out[1, n], out[2, n], out[3, n] = shift, shift - dg, rise, rise - dh
        out[4, n], out[5, n], out[6, n], out[7, n] = 0.5 * m, -0.5 * z[n] * dm, 0.5 * m, -0.5 * z[n] * dm
