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
from ..compile.choice import by_record
from ..compile.jit import kernel
from ..numerics import quartet
from ..numerics.bins import bin_place
from ..numerics.linear import factorize, substitute


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
    """Arrays of one evaluation: sqrt(r), a r', k, b k', x, f, X and i2; B."""

    root: Any
    slope_r: Any
    k: Any
    slope_k: Any
    x: Any
    f: Any
    X: Any
    i2: Any
    matrix: Any


class Solved(NamedTuple):
    """A series, and the room that it is evaluated in."""

    series: Series
    work: Room


@kernel(allocates=True)
def room(series):
    """Room for the evaluations of a series."""
    count = series.a.size
    return Room(
        np.empty(count), np.empty(count), np.empty(count), np.empty(count), np.empty(count), np.empty(count),
        np.empty(count), np.empty(count), np.empty((count, count)),
    )  # fmt: skip


def packed_size(modes: int) -> int:
    """How many numbers a series of two bodies has, packed: its vectors, then Q."""
    return modes * (len(Parts._fields) - 1 + modes)


def working_size(modes: int) -> int:
    """How many numbers it is evaluated in, with its own in front."""
    return packed_size(modes) + modes * (len(Room._fields) - 1 + modes)


@kernel(allocates=True)  # views of the numbers
def unpacked(numbers, modes):
    """A series of two bodies, and the room that it is evaluated in, from one vector."""
    n, square = modes, modes * modes
    Q, work = numbers[5 * n : 5 * n + square], numbers[5 * n + square :]
    parts = Parts(
        numbers[:n], numbers[n : 2 * n], numbers[2 * n : 3 * n], numbers[3 * n : 4 * n], Q.reshape(n, n),
        numbers[4 * n : 5 * n],
    )  # fmt: skip
    return parts, Room(
        work[:n], work[n : 2 * n], work[2 * n : 3 * n], work[3 * n : 4 * n], work[4 * n : 5 * n], work[5 * n : 6 * n],
        work[6 * n : 7 * n], work[7 * n : 8 * n], work[8 * n : 8 * n + square].reshape(n, n),
    )  # fmt: skip


@kernel
def _ratios(z, series, work):
    """Ratios and slopes of every mode."""
    for i in range(series.a.size):
        x = series.a[i] * z
        r, complement = ratio_r(x)
        work.root[i], work.slope_r[i] = np.sqrt(r), series.a[i] * slope_r(x, r, complement)
        y = series.b[i] * z
        k, complement = ratio_k(y)
        work.k[i], work.slope_k[i] = k, series.b[i] * slope_k(y, k, complement)


@kernel
def _solve(series, work):
    """x from B x = sqrt(r) e, X and f."""
    count, matrix = series.a.size, work.matrix
    for i in range(count):
        for n in range(i + 1):
            total = 0.0
            for j in range(count):
                total += series.Q[j, i] * work.k[j] * series.Q[j, n]
            total *= work.root[i] * work.root[n]
            matrix[i, n], matrix[n, i] = total, total
        matrix[i, i] += 1.0
        work.x[i] = work.root[i] * series.e[i]
    factorize(matrix, count)
    substitute(matrix, work.x, count)
    for i in range(count):
        work.X[i] = series.e[i] * work.x[i] / work.root[i]
    for j in range(count):
        total = 0.0
        for i in range(count):
            total += series.Q[j, i] * work.root[i] * work.x[i]
        work.f[j] = total


@kernel
def solve(z, series, work):
    """Fill the room at z > 0."""
    _ratios(z, series, work)
    _solve(series, work)


@kernel
def values(z, series, work):
    """(g, h, m, b) at z > 0."""
    solve(z, series, work)
    g = h = dh = pressed = 0.0
    for i in range(series.a.size):
        root, x, f = work.root[i], work.x[i], work.f[i]
        h += root * series.e[i] * x
        g += series.t[i] * work.k[i] * f
        per = x / root
        dh += work.slope_r[i] * (per * per) - work.slope_k[i] * (f * f)
        pressed += work.X[i] * ratio_i2(series.a[i] * z, root * root)
    square = 1.0 + 2.0 * h / z  # 1/lam^2
    m = g + pressed / square
    return g, h, m, m * np.sqrt(square) / (1.0 + h / z + dh)


@kernel
def shares(z, parts, work):
    """(m of the half-space, m of the cylinder) at z > 0."""
    _, h, m, _ = values(z, parts, work)
    return shares_of(z, h, m, parts, work)


@kernel
def shares_of(z, h, m, parts, work):
    """``shares`` where ``values`` has filled the room: sums of the shares of the creep modes, all positive.

    m_j = t_j k_j f_j + lam^2 J_j sum_i X_i a_i u_i/(a_i - b_j)
    u_i = i2_i + sum_l X_l a_i a_l (i2_i - i2_l)/(a_i + a_l)

    What their sum differs from m by, roundings of alpha times the size of one, is taken from both alike.
    """
    count, square = parts.a.size, 1.0 + 2.0 * h / z  # 1/lam^2
    half_space = cylinder = 0.0
    for i in range(count):
        work.i2[i] = ratio_i2(parts.a[i] * z, work.root[i] * work.root[i])
    for i in range(count):
        u, a = work.i2[i], parts.a[i]
        for n in range(count):
            u += work.X[n] * a * parts.a[n] / (a + parts.a[n]) * (work.i2[i] - work.i2[n])
        pressed = work.X[i] * u / (square * parts.e[i])
        for j in range(count):
            # J_j/(a_i - b_j) = Q_ji t_j/(e_i a_i)
            share = parts.t[j] * (parts.Q[j, i] * pressed)
            half_space += parts.weights[j] * share
            cylinder += (1.0 - parts.weights[j]) * share
    for j in range(count):
        share = parts.t[j] * work.k[j] * work.f[j]
        half_space += parts.weights[j] * share
        cylinder += (1.0 - parts.weights[j]) * share
    whole = m / (half_space + cylinder)
    return half_space * whole, cylinder * whole


@kernel
def fill_bin(z, series, work, row, table):
    """Make the bin of z of g, h, m and b."""
    for n in range(quartet.TERMS):
        g, h, m, b = values(quartet.node(z, n), series, work)
        quartet.put(table, row, n, g, h, m, b)
    quartet.finish(table, row, z)


@kernel
def fill_bin_of_parts(z, parts, work, row, table):
    """Make the bin of z of what two bodies have in m."""
    for n in range(quartet.TERMS):
        half_space, cylinder = shares(quartet.node(z, n), parts, work)
        quartet.put(table, row, n, half_space, cylinder, 0.0, 0.0)
    quartet.finish(table, row, z)


@kernel
def fill_bins(z, parts, work, row, table, table_of_parts):
    """Both."""
    for n in range(quartet.TERMS):
        at = quartet.node(z, n)
        g, h, m, b = values(at, parts, work)
        half_space, cylinder = shares_of(at, h, m, parts, work)
        quartet.put(table, row, n, g, h, m, b)
        quartet.put(table_of_parts, row, n, half_space, cylinder, 0.0, 0.0)
    quartet.finish(table, row, z)
    quartet.finish(table_of_parts, row, z)


_fill = by_record(1, (Series, fill_bin), (Parts, fill_bin_of_parts))


@kernel(allocates=True, seconds=3)
def fill(series, first, stop, table):
    """Make the bins first..stop of z, of a material, or of the parts that two bodies have in it."""
    work = room(series)
    for number in range(first, stop):
        middle = bin_place(number, quartet.BITS, 0.5)
        row, _ = quartet.row_of(middle, table)
        _fill(middle, series, work, row, table)
