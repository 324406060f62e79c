"""What rows are made of, of any series: g/z, h/z and the parts of m by the modes' formulas, at four places of z.

With E(t) = 1 + sum E_i exp(-a_i t) and J(t) = 1 - sum J_j exp(-b_j t), the two forms of one material,

    Q_ji = sqrt(J_j b_j E_i a_i)/(a_i - b_j)      orthogonal: Q^T t = e, t_j = sqrt(J_j T_j), e_i = sqrt(E_i tau_i)
    r_i = r(a_i z)   k_j = k(b_j z)               the ratios of one relaxation time (:mod:`..bessel.ratios`)
    B = 1 + sqrt(r) Q^T k Q sqrt(r)               symmetric, eigenvalues in [1, 2)
    B x = sqrt(r) e      f = Q sqrt(r) x      X_i = e_i x_i/sqrt(r_i)
    h = sum sqrt(r_i) e_i x_i      g = sum t_j k_j f_j      m = g + lam^2 sum X_i i2(a_i z)

All sums but the last are of positive terms.  What a creep mode has in m, all of them positive as well,

    m_j = t_j [k_j f_j + sum_i Q_ji y_i]      y_i = lam^2 X_i u_i/e_i
    u_i = i2_i + sum_l X_l a_i a_l (i2_i - i2_l)/(a_i + a_l)

makes the parts of two bodies that deform unlike each other: the contact sees their sum, one series.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ..bessel.ratios import ratio_i2, ratio_k, ratio_r, slope_k, slope_r
from ..compile.jit import kernel
from ..numerics.four import LANES, add, divide, four, load, multiply, spread, store, subtract

#: functions of z that rows are made of: g/z, h/z, m of the half-space and of the cylinder
SHIFT, RISE, HALF_SPACE, CYLINDER = range(4)
FUNCTIONS = 4


class Series(NamedTuple):
    """Rates of relaxation and creep; strengths of relaxation times time, of creep times time, under roots; Q.

    weights : what of the strength of each creep mode is the half-space's; none where the bodies are alike.
    """

    a: Any
    b: Any
    e: Any
    t: Any
    Q: Any
    weights: Any


class Room(NamedTuple):
    """What the evaluation at four places keeps, four numbers each, of every mode; then B, and what is found.

    sqrt(r), a r', k, b k', x, f, X, i2, u and y; B; four values a function, and m
    """

    root: Any
    slope_r: Any
    k: Any
    slope_k: Any
    x: Any
    f: Any
    X: Any
    i2: Any
    u: Any
    y: Any
    matrix: Any
    found: Any


_VECTORS = len(Room._fields) - 2
_FOUND = LANES * (FUNCTIONS + 1)


def room_of(modes: int) -> Room:
    """Room for the evaluations of a series of so many modes."""
    vectors = [np.empty(LANES * modes) for _ in range(_VECTORS)]
    return Room(*vectors, np.empty(LANES * modes * modes), np.empty(_FOUND))


def packed_size(modes: int) -> int:
    """How many numbers a series has, packed: its vectors, then Q."""
    return modes * (len(Series._fields) - 1 + modes)


def working_size(modes: int) -> int:
    """How many numbers it is evaluated in, with its own in front."""
    return packed_size(modes) + LANES * modes * (_VECTORS + modes) + _FOUND


@kernel(inline=True)
def unpacked(numbers, modes, unlike):
    """A series, and the room that it is evaluated in, from one vector."""
    n, width = modes, LANES * modes
    Q, work = numbers[5 * n : (5 + n) * n], numbers[(5 + n) * n :]
    series = Series(
        numbers[:n], numbers[n : 2 * n], numbers[2 * n : 3 * n], numbers[3 * n : 4 * n], Q.reshape(n, n),
        numbers[4 * n : 5 * n] if unlike else numbers[:0],
    )  # fmt: skip
    return series, Room(
        work[:width], work[width : 2 * width], work[2 * width : 3 * width], work[3 * width : 4 * width],
        work[4 * width : 5 * width], work[5 * width : 6 * width], work[6 * width : 7 * width],
        work[7 * width : 8 * width], work[8 * width : 9 * width], work[9 * width : 10 * width],
        work[10 * width : (10 + n) * width], work[(10 + n) * width :],
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
    row_of, one = LANES * count, spread(1.0)
    for i in range(count):
        inverse = divide(one, load(matrix, i * row_of + LANES * i))
        for row in range(i + 1, count):
            share = multiply(load(matrix, row * row_of + LANES * i), inverse)
            store(matrix, row * row_of + LANES * i, share)
            for column in range(i + 1, count):
                at, above = row * row_of + LANES * column, load(matrix, i * row_of + LANES * column)
                store(matrix, at, subtract(load(matrix, at), multiply(share, above)))


@kernel(inline=True)
def substitute(matrix, right, count):
    """Solve a linear system in place of its right side, from the factors of the matrix."""
    row_of = LANES * count
    for row in range(1, count):
        total = load(right, LANES * row)
        for i in range(row):
            total = subtract(total, multiply(load(matrix, row * row_of + LANES * i), load(right, LANES * i)))
        store(right, LANES * row, total)
    for i in range(count - 1, -1, -1):
        total = load(right, LANES * i)
        for column in range(i + 1, count):
            total = subtract(total, multiply(load(matrix, i * row_of + LANES * column), load(right, LANES * column)))
        store(right, LANES * i, divide(total, load(matrix, i * row_of + LANES * i)))


@kernel(inline=True)
def rooted(x, series, work, f):
    """f = Q sqrt(r) x."""
    count = series.a.size
    for j in range(count):
        total = spread(0.0)
        for i in range(count):
            weighted = multiply(spread(series.Q[j, i]), load(work.root, LANES * i))
            total = add(total, multiply(weighted, load(x, LANES * i)))
        store(f, LANES * j, total)


@kernel(inline=True)
def _solve(series, work):
    """x from B x = sqrt(r) e, X and f."""
    count, matrix = series.a.size, work.matrix
    for i in range(count):
        root = load(work.root, LANES * i)
        for n in range(i + 1):
            total = spread(0.0)
            for j in range(count):
                weighted = multiply(spread(series.Q[j, i]), load(work.k, LANES * j))
                total = add(total, multiply(weighted, spread(series.Q[j, n])))
            total = multiply(total, multiply(root, load(work.root, LANES * n)))
            if n == i:
                total = add(total, spread(1.0))
            store(matrix, LANES * (i * count + n), total)
            store(matrix, LANES * (n * count + i), total)
        store(work.x, LANES * i, multiply(root, spread(series.e[i])))
    _factorize(matrix, count)
    substitute(matrix, work.x, count)
    for i in range(count):
        weighted = multiply(spread(series.e[i]), load(work.x, LANES * i))
        store(work.X, LANES * i, divide(weighted, load(work.root, LANES * i)))
    rooted(work.x, series, work, work.f)


@kernel
def _shares(lam2, series, work):
    """(Of the half-space, of the cylinder): their creep modes' parts of m; u and y."""
    count, half_space, cylinder = series.a.size, spread(0.0), spread(0.0)
    for i in range(count):
        own, a = load(work.i2, LANES * i), series.a[i]
        u = own
        for n in range(count):
            weight = spread(a * series.a[n] / (a + series.a[n]))
            apart = subtract(own, load(work.i2, LANES * n))
            u = add(u, multiply(weight, multiply(load(work.X, LANES * n), apart)))
        pressed = multiply(load(work.X, LANES * i), u)
        store(work.u, LANES * i, u)
        store(work.y, LANES * i, multiply(spread(1.0 / series.e[i]), multiply(pressed, lam2)))
    for j in range(count):
        share = multiply(load(work.k, LANES * j), load(work.f, LANES * j))
        for i in range(count):
            share = add(share, multiply(spread(series.Q[j, i]), load(work.y, LANES * i)))
        half_space = add(half_space, multiply(spread(series.weights[j] * series.t[j]), share))
        cylinder = add(cylinder, multiply(spread((1.0 - series.weights[j]) * series.t[j]), share))
    return half_space, cylinder


@kernel
def values(places, sloped, series, work):
    """Fill the room, and ``found``, at four places z > 0: of every function four values, and of m.

    What the two bodies together differ from m by, roundings of alpha times the size of one, they take in proportion.
    """
    ratios(places, sloped, series, work)
    _solve(series, work)
    z, one = four(places[0], places[1], places[2], places[3]), spread(1.0)
    g, h, pressed = spread(0.0), spread(0.0), spread(0.0)
    for i in range(series.a.size):
        at = LANES * i
        h = add(h, multiply(multiply(load(work.root, at), spread(series.e[i])), load(work.x, at)))
        g = add(g, multiply(multiply(spread(series.t[i]), load(work.k, at)), load(work.f, at)))
        pressed = add(pressed, multiply(load(work.X, at), load(work.i2, at)))
    rise = divide(h, z)
    lam2 = divide(one, add(one, add(rise, rise)))
    m = add(g, multiply(lam2, pressed))
    half_space = cylinder = multiply(spread(0.5), m)
    if series.weights.size > 0:
        half_space, cylinder = _shares(lam2, series, work)
        whole = divide(m, add(half_space, cylinder))
        half_space, cylinder = multiply(half_space, whole), multiply(cylinder, whole)
    store(work.found, LANES * SHIFT, divide(g, z))
    store(work.found, LANES * RISE, rise)
    store(work.found, LANES * HALF_SPACE, half_space)
    store(work.found, LANES * CYLINDER, cylinder)
    store(work.found, LANES * FUNCTIONS, m)
