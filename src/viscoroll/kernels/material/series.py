"""A material of several relaxation times: g, h, m and b of z, and the table that motions and contacts read.

With E(t) = 1 + sum E_i exp(-a_i t) and J(t) = 1 - sum J_j exp(-b_j t), the two forms of one material,

    Q_ji = sqrt(J_j b_j E_i a_i)/(a_i - b_j)      orthogonal: Q^T t = e, t_j = sqrt(J_j T_j), e_i = sqrt(E_i tau_i)
    r_i = r(a_i z)   k_j = k(b_j z)               the ratios of one relaxation time (:mod:`..bessel.ratios`)
    B = 1 + sqrt(r) Q^T k Q sqrt(r)               symmetric, eigenvalues in [1, 2)
    B x = sqrt(r) e      f = Q sqrt(r) x      X_i = e_i x_i/sqrt(r_i)
    h = sum sqrt(r_i) e_i x_i      g = sum t_j k_j f_j      m = g + lam^2 sum X_i i2(a_i z)
    h' = sum (a r')_i (x_i^2/r_i) - sum (b k')_j f_j^2

All sums but the last are of positive terms.  For one mode this is :mod:`standard`.  The material enters contact and
motion by these functions of one variable alone, so a table of them is made once, and nothing else knows of the modes.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ..bessel.ratios import ratio_i2, ratio_k, ratio_r, slope_k, slope_r
from ..compile.jit import kernel
from ..numerics.four import LANES, add, divide, four, load, multiply, spread, store, subtract

#: where the four of each begin in ``Room.found``, zeros last, and how many numbers that has
AT_G, AT_H, AT_M, AT_B, AT_HALF_SPACE, AT_CYLINDER, AT_ZEROS = range(0, 7 * LANES, LANES)
FOUND = 8 * LANES


class Series(NamedTuple):
    """Rates of relaxation and creep; strengths of relaxation times time, of creep times time, under roots; Q."""

    a: Any
    b: Any
    e: Any
    t: Any
    Q: Any


class Parts(NamedTuple):
    """A series of two bodies: as :class:`Series`, and what of the strength of each creep mode is the half-space's."""

    a: Any
    b: Any
    e: Any
    t: Any
    Q: Any
    weights: Any


class Room(NamedTuple):
    """What the evaluation at four places keeps, four numbers each, of every mode; then B, and what is found.

    sqrt(r), a r', k, b k', x, f, X and i2; B; g, h, m and b; m of the half-space and of the cylinder
    """

    root: Any
    slope_r: Any
    k: Any
    slope_k: Any
    x: Any
    f: Any
    X: Any
    i2: Any
    matrix: Any
    found: Any


class Solved(NamedTuple):
    """A series, and the room that it is evaluated in."""

    series: Series
    work: Room


@kernel(allocates=True)
def room(series):
    """Room for the evaluations of a series."""
    count = 4 * series.a.size
    return Room(
        np.empty(count), np.empty(count), np.empty(count), np.empty(count), np.empty(count), np.empty(count),
        np.empty(count), np.empty(count), np.empty(count * series.a.size), np.empty(FOUND),
    )  # fmt: skip


def packed_size(modes: int) -> int:
    """How many numbers a series of two bodies has, packed: its vectors, then Q."""
    return modes * (len(Parts._fields) - 1 + modes)


def working_size(modes: int) -> int:
    """How many numbers it is evaluated in, with its own in front."""
    return packed_size(modes) + 4 * modes * (len(Room._fields) - 2 + modes) + FOUND


@kernel(inline=True)
def unpacked(numbers, modes):
    """A series of two bodies, and the room that it is evaluated in, from one vector."""
    n, four = modes, 4 * modes
    Q, work = numbers[5 * n : 5 * n + n * n], numbers[5 * n + n * n :]
    parts = Parts(
        numbers[:n], numbers[n : 2 * n], numbers[2 * n : 3 * n], numbers[3 * n : 4 * n], Q.reshape(n, n),
        numbers[4 * n : 5 * n],
    )  # fmt: skip
    return parts, Room(
        work[:four], work[four : 2 * four], work[2 * four : 3 * four], work[3 * four : 4 * four],
        work[4 * four : 5 * four], work[5 * four : 6 * four], work[6 * four : 7 * four], work[7 * four : 8 * four],
        work[8 * four : (8 + n) * four], work[(8 + n) * four : (8 + n) * four + FOUND],
    )  # fmt: skip


@kernel(inline=True)
def ratios(places, sloped, series, work):
    """Ratios and slopes of every mode."""
    for at in range(LANES * series.a.size):
        i, z = at // LANES, places[at % LANES]
        x, y = series.a[i] * z, series.b[i] * z
        r, complement = ratio_r(x)
        root = np.sqrt(r)
        work.root[at], work.i2[at] = root, ratio_i2(x, root * root)
        k, k_complement = ratio_k(y)
        work.k[at] = k
        if sloped:
            work.slope_r[at] = series.a[i] * slope_r(x, r, complement)
            work.slope_k[at] = series.b[i] * slope_k(y, k, k_complement)


@kernel(inline=True)
def _factorize(matrix, count):
    """Two triangular factors in place of a matrix, without pivoting: its eigenvalues lie in [1, 2)."""
    row_of, one = 4 * count, spread(1.0)
    for i in range(count):
        inverse = divide(one, load(matrix, i * row_of + 4 * i))
        for row in range(i + 1, count):
            share = multiply(load(matrix, row * row_of + 4 * i), inverse)
            store(matrix, row * row_of + 4 * i, share)
            for column in range(i + 1, count):
                at = row * row_of + 4 * column
                store(matrix, at, subtract(load(matrix, at), multiply(share, load(matrix, i * row_of + 4 * column))))


@kernel(inline=True)
def substitute(matrix, right, count):
    """Solve a linear system in place of its right side, from the factors of the matrix."""
    row_of = 4 * count
    for row in range(1, count):
        total = load(right, 4 * row)
        for i in range(row):
            total = subtract(total, multiply(load(matrix, row * row_of + 4 * i), load(right, 4 * i)))
        store(right, 4 * row, total)
    for i in range(count - 1, -1, -1):
        total = load(right, 4 * i)
        for column in range(i + 1, count):
            total = subtract(total, multiply(load(matrix, i * row_of + 4 * column), load(right, 4 * column)))
        store(right, 4 * i, divide(total, load(matrix, i * row_of + 4 * i)))


@kernel(inline=True)
def solve_four(series, work):
    """x from B x = sqrt(r) e, X and f."""
    count, matrix = series.a.size, work.matrix
    for i in range(count):
        root = load(work.root, 4 * i)
        for n in range(i + 1):
            total = spread(0.0)
            for j in range(count):
                weighted = multiply(spread(series.Q[j, i]), load(work.k, 4 * j))
                total = add(total, multiply(weighted, spread(series.Q[j, n])))
            total = multiply(total, multiply(root, load(work.root, 4 * n)))
            if n == i:
                total = add(total, spread(1.0))
            store(matrix, 4 * (i * count + n), total)
            store(matrix, 4 * (n * count + i), total)
        store(work.x, 4 * i, multiply(root, spread(series.e[i])))
    _factorize(matrix, count)
    substitute(matrix, work.x, count)
    for i in range(count):
        weighted = multiply(spread(series.e[i]), load(work.x, 4 * i))
        store(work.X, 4 * i, divide(weighted, load(work.root, 4 * i)))
    for j in range(count):
        total = spread(0.0)
        for i in range(count):
            weighted = multiply(spread(series.Q[j, i]), load(work.root, 4 * i))
            total = add(total, multiply(weighted, load(work.x, 4 * i)))
        store(work.f, 4 * j, total)


@kernel
def solve(z, series, work):
    """Fill the room at z > 0, all four places."""
    ratios((z, z, z, z), False, series, work)
    solve_four(series, work)


@kernel
def values(places, sloped, series, work):
    """g, h, m, b at four places > 0 into ``found``; b where ``sloped``."""
    ratios(places, sloped, series, work)
    solve_four(series, work)
    g, h, dh, pressed = spread(0.0), spread(0.0), spread(0.0), spread(0.0)
    for i in range(series.a.size):
        root, x, f = load(work.root, 4 * i), load(work.x, 4 * i), load(work.f, 4 * i)
        h = add(h, multiply(multiply(root, spread(series.e[i])), x))
        g = add(g, multiply(multiply(spread(series.t[i]), load(work.k, 4 * i)), f))
        pressed = add(pressed, multiply(load(work.X, 4 * i), load(work.i2, 4 * i)))
        if sloped:
            per = divide(x, root)
            rise = multiply(load(work.slope_r, 4 * i), multiply(per, per))
            dh = add(dh, subtract(rise, multiply(load(work.slope_k, 4 * i), multiply(f, f))))
    store(work.found, AT_G, g)
    store(work.found, AT_H, h)
    store(work.found, AT_M, pressed)
    store(work.found, AT_B, dh)
    for c in range(LANES):
        z, g_c, h_c = places[c], work.found[AT_G + c], work.found[AT_H + c]
        square = 1.0 + 2.0 * h_c / z  # 1/lam^2
        m = g_c + work.found[AT_M + c] / square
        work.found[AT_M + c] = m
        work.found[AT_B + c] = m * np.sqrt(square) / (1.0 + h_c / z + work.found[AT_B + c]) if sloped else 0.0


@kernel
def shares(places, parts, work):
    """m of the half-space and of the cylinder into ``found``, where ``values`` has filled the room.

    Sums of the shares of the creep modes, all positive:

    m_j = t_j k_j f_j + lam^2 J_j sum_i X_i a_i u_i/(a_i - b_j)
    u_i = i2_i + sum_l X_l a_i a_l (i2_i - i2_l)/(a_i + a_l)

    What their sum differs from m by, roundings of alpha times the size of one, is taken from both alike.
    """
    count, z = parts.a.size, four(places[0], places[1], places[2], places[3])
    h, m = load(work.found, AT_H), load(work.found, AT_M)
    square = add(spread(1.0), divide(multiply(spread(2.0), h), z))  # 1/lam^2
    half_space, cylinder = spread(0.0), spread(0.0)
    for i in range(count):
        own, a = load(work.i2, 4 * i), parts.a[i]
        u = own
        for n in range(count):
            apart = subtract(own, load(work.i2, 4 * n))
            weighted = multiply(multiply(load(work.X, 4 * n), spread(a)), spread(parts.a[n]))
            u = add(u, multiply(divide(weighted, spread(a + parts.a[n])), apart))
        pressed = divide(multiply(load(work.X, 4 * i), u), multiply(square, spread(parts.e[i])))
        for j in range(count):
            # J_j/(a_i - b_j) = Q_ji t_j/(e_i a_i)
            share = multiply(spread(parts.t[j]), multiply(spread(parts.Q[j, i]), pressed))
            half_space = add(half_space, multiply(spread(parts.weights[j]), share))
            cylinder = add(cylinder, multiply(spread(1.0 - parts.weights[j]), share))
    for j in range(count):
        share = multiply(multiply(spread(parts.t[j]), load(work.k, 4 * j)), load(work.f, 4 * j))
        half_space = add(half_space, multiply(spread(parts.weights[j]), share))
        cylinder = add(cylinder, multiply(spread(1.0 - parts.weights[j]), share))
    whole = divide(m, add(half_space, cylinder))
    store(work.found, AT_HALF_SPACE, multiply(half_space, whole))
    store(work.found, AT_CYLINDER, multiply(cylinder, whole))
