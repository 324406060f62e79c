"""Offline: the rows of one material or pair.

The modes' formulas are evaluated once, at 24 nodes an octave of w = 1/z.  Polynomials of these turn over to the tables:
of u, where w = 2 u (1 + 2 h/z)^(1/2), and of v, where w = v (1 + g/z).
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ..compile.jit import kernel
from ..law.unsteady import room as unsteady_room
from ..law.unsteady import unsteady
from . import lanes
from .fit import fit, fit_slopes, node
from .lanes import TERMS
from .law import octave, power_of_two
from .modes import CYLINDER, FUNCTIONS, HALF_SPACE, LANES, RISE, SHIFT, functions, sloped_room

#: the functions of a table in their order; the first five are of u, the others of v
LAM, EPSILON, M_HALF_SPACE, M_CYLINDER, N, SHARE_OF_F, PRESS_OF_F = range(7)
TABLE = 7
#: the octave behind the shortest time where the fast limit is first tried; what it may be off by there
_FIRST, _NEAR = 12, 2.0**-44
#: and how many octaves further: it comes closer by 3.5 an octave
_FURTHER = 5
_MOST_STEPS, _SMALL = 20, 1e-9
#: what N rounds by where it is largest
_ROUNDING_OF_N = 1e-14


class Ends(NamedTuple):
    """alpha; sum J_j T_j, and the two numbers of the fast limit, of either body."""

    alpha: float
    T_half_space: float
    T_cylinder: float
    W_half_space: float
    C_half_space: float
    W_cylinder: float
    C_cylinder: float


class Bench(NamedTuple):
    """Values and slopes over t of functions at the nodes of a row, the powers fitted, and scratch."""

    values: Any
    slopes: Any
    fitted: Any
    scratch: Any


@kernel(inline=True)
def _off(found, limit):
    return abs(limit - found) / found if found > 0.0 else 0.0


@kernel
def _off_limit(w, c, ends, found):
    """What the fast limit is off by, at most, at the place ``c`` of those evaluated."""
    shift, rise = found[2 * LANES * SHIFT + c], found[2 * LANES * RISE + c]
    v, square = w / (1.0 + shift), 1.0 + 2.0 * rise
    W, C = ends.W_half_space + ends.W_cylinder, ends.C_half_space + ends.C_cylinder
    share = 1.0 - 0.5 * ends.alpha * (C + W * np.log(v)) / v
    z = np.sqrt(square / ends.alpha) / w
    worst = _off(square / ((1.0 + shift) * (1.0 + shift)), ends.alpha * share * share)
    worst = max(worst, _off(shift, 0.5 * ends.alpha * z * (C - W * np.log(z))))
    half = 0.5 * ends.alpha * z * z
    for body, W, C in (
        (HALF_SPACE, ends.W_half_space, ends.C_half_space), (CYLINDER, ends.W_cylinder, ends.C_cylinder),
    ):  # fmt: skip
        worst = max(worst, _off(found[2 * LANES * body + c], half * (C - W * (np.log(z) - 0.25))))
    return worst


@kernel
def _last_octave(series, ends, work):
    """Exponent of w from which on the fast limit holds."""
    n = int(np.ceil(np.log2(series.a[series.a.size - 1]))) + _FIRST
    while True:
        z = power_of_two(-n)
        functions((z, 0.5 * z, 0.25 * z, 0.125 * z), series, work)
        for c in range(LANES):
            if _off_limit(1.0 / (z * power_of_two(-c)), c, ends, work.found) <= _NEAR:
                return n + c + _FURTHER
        n += LANES


@kernel
def _place(row, k, e0):
    """(x, dln x/dt) of node k."""
    t = node(row, k)
    if row == 0:
        return t * power_of_two(e0), 1.0 / t
    return 0.25 * (t + 3.0) * power_of_two(e0 + row), 1.0 / (t + 3.0)


@kernel
def _keep(bench, f, k, value, slope):
    bench.values[f, k], bench.slopes[f, k] = value, slope


@kernel
def _fit_over_z(row, e0, series, ends, work, bench, fine):
    """Polynomials of g/z, h/z and the parts of m over w."""
    for first in range(0, TERMS, LANES):
        x0, x1 = _place(row, first, e0)[0], _place(row, first + 1, e0)[0]
        x2, x3 = _place(row, first + 2, e0)[0], _place(row, first + 3, e0)[0]
        functions((1.0 / x0, 1.0 / x1, 1.0 / x2, 1.0 / x3), series, work)
        for f in range(FUNCTIONS):
            for c in range(LANES):
                at, per = 2 * LANES * f + c, _place(row, first + c, e0)[1]
                _keep(bench, f, first + c, work.found[at], work.found[at + LANES] * per)
    for f in range(FUNCTIONS):
        fit_slopes(row, bench.values[f], bench.slopes[f], bench.fitted, bench.scratch)
        for n in range(TERMS):
            fine[(row * FUNCTIONS + f) * TERMS + n] = bench.fitted[n]
    if row == 0:
        rise = 0.5 * (ends.T_half_space + ends.T_cylinder) * power_of_two(e0)
        for f in (SHIFT, RISE):
            fine[f * TERMS], fine[f * TERMS + 1] = 0.0, rise
        fine[HALF_SPACE * TERMS], fine[CYLINDER * TERMS] = ends.T_half_space, ends.T_cylinder


@kernel
def _at(f, w, e0, fine):
    """A function of w and its slope over ln w."""
    row, t, per = octave(w, e0)
    value, slope = lanes.one_slopes(fine, (row * FUNCTIONS + f) * TERMS, t)
    return value, slope * per * w


@kernel
def _w_of_speed(u, guess, e0, fine):
    """(w, h/z and its slope there, dln w/dln u)."""
    w = guess
    rise, d_rise, bend = 0.0, 0.0, 0.0
    for _ in range(_MOST_STEPS):
        rise, d_rise = _at(RISE, w, e0, fine)
        bend = d_rise / (1.0 + 2.0 * rise)
        step = (2.0 * u * np.sqrt(1.0 + 2.0 * rise) - w) / (1.0 - bend)
        w += step
        if abs(step) <= _SMALL * w:
            break
    rise, d_rise = _at(RISE, w, e0, fine)
    return w, rise, d_rise, 1.0 / (1.0 - d_rise / (1.0 + 2.0 * rise))


@kernel
def _w_of_stick(v, guess, e0, fine):
    """(w, g/z and its slope there, dln w/dln v)."""
    w = guess
    shift, d_shift = 0.0, 0.0
    for _ in range(_MOST_STEPS):
        shift, d_shift = _at(SHIFT, w, e0, fine)
        step = (v * (1.0 + shift) - w) / (1.0 - v * d_shift / w)
        w += step
        if abs(step) <= _SMALL * w:
            break
    shift, d_shift = _at(SHIFT, w, e0, fine)
    return w, shift, d_shift, 1.0 / (1.0 - d_shift / (1.0 + shift))


@kernel
def _over_speed(row, e0, near, fine, bench):
    """lam, epsilon and the parts of m at the nodes of a row; ``near``: u and w of the last one, and of this."""
    u_before, w = near
    for k in range(TERMS):
        u, per = _place(row, k, e0)
        w, rise, d_rise, turn = _w_of_speed(u, w * (u / u_before), e0, fine)
        u_before, turn = u, turn * per
        lam = 1.0 / np.sqrt(1.0 + 2.0 * rise)
        _keep(bench, LAM, k, lam, -lam * lam * lam * d_rise * turn)
        for f, of_z in ((EPSILON, SHIFT), (M_HALF_SPACE, HALF_SPACE), (M_CYLINDER, CYLINDER)):
            value, slope = _at(of_z, w, e0, fine)
            _keep(bench, f, k, value, slope * turn)
    return u_before, w


@kernel
def _over_stick(row, e0, near, fine, bench):
    """eta/F and H/F^2 at the nodes of a row, likewise."""
    v_before, w = near
    for k in range(TERMS):
        v, per = _place(row, k, e0)
        w, shift, d_shift, turn = _w_of_stick(v, w * (v / v_before), e0, fine)
        v_before, turn = v, turn * per
        rise, d_rise = _at(RISE, w, e0, fine)
        share = 1.0 / (1.0 + shift)
        press, fall = (1.0 + 2.0 * rise) * share * share, share * d_shift
        _keep(bench, SHARE_OF_F, k, share, -share * fall * turn)
        _keep(bench, PRESS_OF_F, k, press, 2.0 * (d_rise * share * share - press * fall) * turn)
    return v_before, w


@kernel
def _put_row(row, e0, ends, bench, out):
    """The polynomials of a row of the table."""
    for f in range(TABLE):
        if f != N:
            fit_slopes(row, bench.values[f], bench.slopes[f], bench.fitted, bench.scratch)
            for n in range(TERMS):
                out[row, n, f] = bench.fitted[n]
    if row == 0:
        out[0, 0, LAM] = out[0, 0, SHARE_OF_F] = out[0, 0, PRESS_OF_F] = 1.0
        out[0, 0, EPSILON], out[0, 1, EPSILON] = 0.0, (ends.T_half_space + ends.T_cylinder) * power_of_two(e0)
        out[0, 0, M_HALF_SPACE], out[0, 0, M_CYLINDER] = ends.T_half_space, ends.T_cylinder


@kernel(allocates=True)
def build(series, e0, ends, least):
    """The table (rows, 24, 7) of a series of two bodies (``Parts``, without weights where they are alike); N is NaN.

    ``least`` rows, and more up to the fast limit.
    """
    work = sloped_room(series)
    bench = Bench(np.empty((TABLE, TERMS)), np.empty((TABLE, TERMS)), np.empty(TERMS), np.empty(TERMS))
    rows = max(_last_octave(series, ends, work) - e0 + 1, least)
    finer = rows + 2 + int(np.ceil(0.5 * np.log2(ends.alpha)))
    fine = np.empty(finer * FUNCTIONS * TERMS)
    for row in range(finer):
        _fit_over_z(row, e0, series, ends, work, bench, fine)
    out = np.full((rows, TERMS, TABLE), np.nan)
    speed, stick = (0.5, 1.0), (1.0, 1.0)
    for row in range(rows):
        speed = _over_speed(row, e0, speed, fine, bench)
        stick = _over_stick(row, e0, stick, fine, bench)
        _put_row(row, e0, ends, bench, out)
    return out


@kernel(allocates=True)
def build_unsteady(series, e0, table):
    """Fill in N."""
    work, values, fitted, scratch = unsteady_room(series), np.empty(TERMS), np.empty(TERMS), np.empty(TERMS)
    for row in range(table.shape[0]):
        for k in range(TERMS):
            t, lam = node(row, k), 0.0
            for n in range(TERMS - 1, -1, -1):
                lam = lam * t + table[row, n, LAM]
            values[k] = unsteady(0.5 * lam / _place(row, k, e0)[0], series, work)
        fit(row, TERMS, _ROUNDING_OF_N, values, fitted, scratch)
        for n in range(TERMS):
            table[row, n, N] = fitted[n]


@kernel(allocates=True)
def by_modes(series, z, out):
    """g/z, h/z, the parts of m and N at every z by the formulas of the modes: what errors of a table are told by."""
    work, slow = sloped_room(series), unsteady_room(series)
    for first in range(0, z.size, LANES):
        last = z.size - 1
        places = z[first], z[min(first + 1, last)], z[min(first + 2, last)], z[min(first + 3, last)]
        functions(places, series, work)
        for n in range(first, min(first + LANES, z.size)):
            for f in range(FUNCTIONS):
                out[f, n] = work.found[2 * LANES * f + n - first]
            out[FUNCTIONS, n] = unsteady(z[n], series, slow)
