"""What rows are made of, of any series: g/z, h/z and the parts of m by the modes' formulas, at four places of z.

With E(t) = 1 + sum E_i exp(-a_i t) and J(t) = 1 - sum J_j exp(-b_j t), the two forms of one material,

    Q_ji = sqrt(J_j b_j E_i a_i)/(a_i - b_j)      orthogonal: Q^T t = e, t_j = sqrt(J_j T_j), e_i = sqrt(E_i tau_i)
    r_i = r(a_i z)   k_j = k(b_j z)               the ratios of one relaxation time (:mod:`..bessel.ratios`)
    (1/r + Q^T k Q) y = e      f = Q y      X_i = e_i y_i/r_i
    h = sum e_i y_i      g = sum t_j k_j f_j      m = g + lam^2 sum X_i i2(a_i z)

All sums but the last are of positive terms.  What a creep mode has in m, all of them positive as well,

    m_j = t_j [k_j f_j + sum_i Q_ji v_i]      v_i = lam^2 X_i u_i/e_i
    u_i = i2_i + sum_l X_l a_i a_l (i2_i - i2_l)/(a_i + a_l)

makes the parts of two bodies that deform unlike each other: the contact sees their sum, one series.

Four numbers are those of four places, or those of a **jet** at one: value, d/dz, d/ds, d2/dz ds, s being taken from
all rates a_i and b_j while E_i a_i, J_j b_j and Q stay what they are (:mod:`modes`).
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ..bessel.ratios import ratio_i2, ratio_k, ratio_r
from ..compile.jit import kernel
from ..numerics.simd4 import LANES, broadcast, fma4, load, pack, store, unpack

#: functions of z that rows are made of: g/z, h/z, m of the half-space and of the cylinder
G_OVER_Z, H_OVER_Z, M_HALF_SPACE, M_CYLINDER = range(4)
FUNCTIONS = 4


class Series(NamedTuple):
    """Rates of relaxation and creep; strengths of relaxation times time, of creep times time, under roots; Q.

    weights : what of the strength of each creep mode is the half-space's; none where the bodies are alike.
    """

    a: Any
    b: Any
    e: Any
    t: Any
    weights: Any
    Q: Any


class Workspace(NamedTuple):
    """What an evaluation keeps, four numbers each, of every mode: 1/r, k, i2, y and then X, k f; a right side.

    matrix : 1/r + Q^T k Q.  found : four numbers a function.
    """

    per_r: Any
    k: Any
    i2: Any
    y: Any
    kf: Any
    right: Any
    matrix: Any
    found: Any


_VECTORS = len(Workspace._fields) - 2
_FOUND = LANES * FUNCTIONS


def series_size(modes: int) -> int:
    """How many numbers a series has, packed: its vectors, then Q."""
    return modes * (len(Series._fields) - 1 + modes)


def workspace_size(modes: int) -> int:
    """How many numbers its room has, likewise."""
    return LANES * modes * (_VECTORS + modes) + _FOUND


@kernel(inline=True)
def unpack_series(numbers, n, unlike):
    """A series of n modes."""
    row = numbers[: (5 + n) * n].reshape(5 + n, n)
    return Series(row[0], row[1], row[2], row[3], row[4, : n if unlike else 0], row[5:])


@kernel(inline=True)
def split_workspace(work, modes):
    """Room for the evaluations of one."""
    n = LANES * modes
    end = (_VECTORS + modes) * n
    row, matrix = work[: _VECTORS * n].reshape(_VECTORS, n), work[_VECTORS * n : end]
    return Workspace(row[0], row[1], row[2], row[3], row[4], row[5], matrix, work[end:])


def new_workspace(modes: int) -> Workspace:
    """Room for the evaluations of a series of so many modes."""
    return split_workspace.py_func(np.empty(workspace_size(modes)), modes)


@kernel(inline=True)
def evaluate_ratios(places, series, work):
    """The ratios of every mode at four places."""
    for at in range(LANES * series.a.size):
        i, z = at // LANES, places[at % LANES]
        r, _ = ratio_r(series.a[i] * z)
        work.per_r[at], work.i2[at] = 1.0 / r, ratio_i2(series.a[i] * z, r)
        work.k[at], _ = ratio_k(series.b[i] * z)


# --- four places or a jet ---


@kernel(inline=True)
def multiply(jets, p, q):
    """The product."""
    if not jets:
        return p * q
    p0, p1, p2, p3 = unpack(p)
    q0, q1, q2, q3 = unpack(q)
    return pack(p0 * q0, p1 * q0 + p0 * q1, p2 * q0 + p0 * q2, p3 * q0 + p1 * q2 + p2 * q1 + p0 * q3)


@kernel(inline=True)
def reciprocal(jets, p):
    """1/p."""
    per = 1.0 / p
    if not jets:
        return per
    w, _, _, _ = unpack(per)
    _, dz, ds, dzds = unpack(p)
    return pack(w, -w * w * dz, -w * w * ds, w * w * (2.0 * w * dz * ds - dzds))


@kernel(inline=True)
def _strength(jets, strength, rate):
    """e_i or t_j."""
    return pack(strength, 0.0, strength / rate, 0.0) if jets else broadcast(strength)


@kernel(inline=True)
def _value(jets, p):
    """Of a jet, its value four times."""
    return broadcast(unpack(p)[0]) if jets else p


@kernel(inline=True)
def _factorize(matrix, count):
    """A triangle times its diagonal, and 1 over that, in the lower half of a symmetric positive definite matrix."""
    row_of = LANES * count
    for i in range(0, LANES * count, LANES):
        per = 1.0 / load(matrix, i * count + i)
        store(matrix, i * count + i, per)
        for row in range(i + LANES, row_of, LANES):
            share = load(matrix, row * count + i) * (0.0 - per)
            for column in range(i + LANES, row + LANES, LANES):
                at = row * count + column
                store(matrix, at, fma4(share, load(matrix, column * count + i), load(matrix, at)))


@kernel(inline=True)
def _substitute(matrix, right, count):
    """Solve a linear system in place of its right side, from the factors of the matrix."""
    row_of = LANES * count
    for i in range(0, row_of, LANES):
        known = load(matrix, i * count + i) * load(right, i)
        for row in range(i + LANES, row_of, LANES):
            store(right, row, load(right, row) - load(matrix, row * count + i) * known)
    for row in range(row_of - LANES, -1, -LANES):
        known = load(matrix, row * count + row) * load(right, row)
        store(right, row, known)
        for i in range(0, row, LANES):
            store(right, i, load(right, i) - load(matrix, row * count + i) * known)


@kernel(inline=True)
def solve_modes(jets, series, work):
    """y and k f, from the ratios.

    A jet takes the factors of the matrix's value for those of all of it, which leaves an error with d/dz or d/ds as a
    factor: the second time with both, the third time none.
    """
    count, matrix = series.a.size, work.matrix
    for i in range(count):
        for j in range(count):
            store(work.kf, LANES * j, series.Q[j, i] * load(work.k, LANES * j))
        for n in range(0, i + 1, 2):  # two sums that do not wait for one another
            other, at = min(n + 1, i), LANES * i * count
            one = two = broadcast(0.0)
            for j in range(count):
                x = load(work.kf, LANES * j)
                one, two = fma4(broadcast(series.Q[j, n]), x, one), fma4(broadcast(series.Q[j, other]), x, two)
            store(matrix, at + LANES * n, _value(jets, one))
            store(matrix, at + LANES * other, _value(jets, two))
        at = LANES * i * (count + 1)
        store(matrix, at, load(matrix, at) + _value(jets, load(work.per_r, LANES * i)))
        store(work.right, LANES * i, _strength(jets, series.e[i], series.a[i]))
        store(work.y, LANES * i, broadcast(0.0))
    _factorize(matrix, count)
    for turn in range(3 if jets else 1):
        if turn > 0:
            for i in range(count):
                total = multiply(jets, load(work.per_r, LANES * i), load(work.y, LANES * i))
                for j in range(count):
                    total = fma4(broadcast(series.Q[j, i]), load(work.kf, LANES * j), total)
                store(work.right, LANES * i, _strength(jets, series.e[i], series.a[i]) - total)
        _substitute(matrix, work.right, count)
        for at in range(0, LANES * count, LANES):
            store(work.y, at, load(work.y, at) + load(work.right, at))
        for j in range(count):
            f = broadcast(0.0)
            for i in range(count):
                f = fma4(broadcast(series.Q[j, i]), load(work.y, LANES * i), f)
            store(work.kf, LANES * j, multiply(jets, load(work.k, LANES * j), f))


@kernel
def _shares(jets, lam2, series, work):
    """(Of the half-space, of the cylinder): their creep modes' parts of m; no slopes over s."""
    count, half_space, cylinder = series.a.size, broadcast(0.0), broadcast(0.0)
    for i in range(count):
        own, a = load(work.i2, LANES * i), series.a[i]
        u = load(work.i2, LANES * i)
        for n in range(count):
            weight = a * series.a[n] / (a + series.a[n])
            u += weight * multiply(jets, load(work.y, LANES * n), own - load(work.i2, LANES * n))
        pressed = multiply(jets, multiply(jets, load(work.y, LANES * i), u), lam2)
        store(work.right, LANES * i, (1.0 / series.e[i]) * pressed)
    for j in range(count):
        share = load(work.kf, LANES * j)
        for i in range(count):
            share += series.Q[j, i] * load(work.right, LANES * i)
        half_space += series.weights[j] * series.t[j] * share
        cylinder += (1.0 - series.weights[j]) * series.t[j] * share
    return half_space, cylinder


@kernel(inline=True)
def evaluate_functions(jets, z, series, work):
    """(g, h, sum X_i i2_i) at z > 0, from the ratios there; ``found``.

    What the two bodies together differ from m by, roundings of alpha times the size of one, they take in proportion.
    """
    solve_modes(jets, series, work)
    one = pack(1.0, 0.0, 0.0, 0.0) if jets else broadcast(1.0)
    g, h, pressed = broadcast(0.0), broadcast(0.0), broadcast(0.0)
    for i in range(series.a.size):
        at = LANES * i
        e, t = _strength(jets, series.e[i], series.a[i]), _strength(jets, series.t[i], series.b[i])
        ey = multiply(jets, e, load(work.y, at))
        X = multiply(jets, ey, load(work.per_r, at))
        store(work.y, at, X)
        h, g, pressed = h + ey, g + multiply(jets, t, load(work.kf, at)), pressed + multiply(jets, X, load(work.i2, at))
    per_z = reciprocal(jets, z)
    rise = multiply(jets, h, per_z)
    lam2 = reciprocal(jets, one + 2.0 * rise)
    m = g + multiply(jets, lam2, pressed)
    half_space = cylinder = 0.5 * m
    if series.weights.size > 0:
        half_space, cylinder = _shares(jets, lam2, series, work)
        whole = multiply(jets, m, reciprocal(jets, half_space + cylinder))
        half_space, cylinder = multiply(jets, half_space, whole), multiply(jets, cylinder, whole)
    store(work.found, LANES * G_OVER_Z, multiply(jets, g, per_z))
    store(work.found, LANES * H_OVER_Z, rise)
    store(work.found, LANES * M_HALF_SPACE, half_space)
    store(work.found, LANES * M_CYLINDER, cylinder)
    return g, h, pressed
