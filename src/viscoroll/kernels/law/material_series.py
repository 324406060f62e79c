"""The functions that rows are made of, of any Prony series, by the formulas of its modes: g/z, h/z
and the parts of m.

With E(t) = 1 + sum E_i exp(-a_i t) and J(t) = 1 - sum J_j exp(-b_j t), the two forms of one
material, a_i = 1/tau_i and b_j = 1/T_j, z half the transit time of the contact, and the ratios of
Bessel functions r = I1/I0, k = K0/K1 and i2 = I2/I0 (:mod:`.bessel_ratios`),

    t_j = sqrt(J_j T_j)   e_i = sqrt(E_i tau_i)
    Q_ji = sqrt(J_j b_j E_i a_i)/(a_i - b_j)      orthogonal: Q^T t = e
    r_i = r(a_i z)   k_j = k(b_j z)               the ratios of one relaxation time
    (1/r + Q^T k Q) y = e      f = Q y      X_i = e_i y_i/r_i
    h = sum e_i y_i      g = sum t_j k_j f_j      m = g + lam^2 sum X_i i2(a_i z)

where r and k stand for diagonal matrices in the fourth line, lam^-2 = 1 + 2 h/z, and m is M/V
(docs/theory_materials.md, Any linear viscoelastic material).

All sums but the last are of positive terms.  What a creep mode has in m, all of them positive as
well,

    m_j = t_j [k_j f_j + sum_i Q_ji v_i]      v_i = lam^2 X_i u_i/e_i
    u_i = i2_i + sum_l X_l a_i a_l (i2_i - i2_l)/(a_i + a_l)

makes the parts of two bodies that deform unlike each other: the contact sees their sum, one series
(docs/theory_materials.md, Two bodies).

Every number is a vector of four (:mod:`.simd`).  The four are values at four places z, or, where
``jets`` is True, a **jet** at one place: value, d/dz, d/ds, d2/dz ds.  The parameter s is
subtracted from all rates a_i and b_j while E_i a_i, J_j b_j and Q stay what they are
(:mod:`.modes`).

All quantities are dimensionless (docs/symbols.md), times divided by the unit of time of the series;
an argument of which no shape is stated is a number.
"""

from typing import Any, NamedTuple

import numpy as np

from ..numerics.jit import inline_kernel, kernel
from ..numerics.simd import LANES, broadcast, fma4, load, pack, store, unpack
from .bessel_ratios import ratio_i2, ratio_k, ratio_r

#: Position of the four values of g/z among the results.
G_OVER_Z = 0
#: Position of h/z.
H_OVER_Z = 4
#: Position of m of the half-space.
M_HALF_SPACE = 8
#: Position of m of the cylinder.
M_CYLINDER = 12
#: Number of functions.
FUNCTIONS = 4


class Series(NamedTuple):
    """A Prony series of n modes in both forms, all times in one unit; n may be 0, for elastic
    bodies.

    a, b : rates of relaxation a_i = 1/tau_i and of creep b_j = 1/T_j, (n,).
    e, t : sqrt(E_i tau_i) and sqrt(J_j T_j), (n,).
    weights : fraction of each creep mode that is the half-space's, in [0, 1], (n,); empty if the
    bodies are alike.
    Q : the orthogonal matrix Q_ji, (n, n), with creep modes j for rows and relaxation modes i for
    columns.
    """

    a: Any
    b: Any
    e: Any
    t: Any
    weights: Any
    Q: Any


class Workspace(NamedTuple):
    """Arrays of an evaluation, flat, with a vector of four numbers for each mode.

    inverse_r, k, i2 : 1/r and i2 of the relaxation modes, k of the creep modes.
    y : y and, after the evaluation, X, of the relaxation modes.
    kf : k f of the creep modes.
    right : a right side, scratch.
    matrix : 1/r + Q^T k Q, four numbers an element; after the solve its factors.
    functions : the results, four numbers a function, at G_OVER_Z, H_OVER_Z, M_HALF_SPACE and
    M_CYLINDER.
    """

    inverse_r: Any
    k: Any
    i2: Any
    y: Any
    kf: Any
    right: Any
    matrix: Any
    functions: Any


#: Fields of :class:`Workspace` with four numbers for each mode.
_VECTORS = len(Workspace._fields) - 2


def series_size(modes: int) -> int:
    """Return the number of doubles in which a series is stored, an int: five vectors of one number
    a mode, then Q.

    modes : int, number of modes, >= 0.
    """
    return modes * (len(Series._fields) - 1 + modes)


def workspace_size(modes: int) -> int:
    """Return the number of doubles of the workspace of a series, an int, that
    :func:`split_workspace` needs.

    modes : int, number of modes, >= 0.
    """
    return LANES * (modes * (_VECTORS + modes) + FUNCTIONS)


@inline_kernel
def unpack_series(numbers, n, unlike):
    """Return the :class:`Series` of a material as views of the vector in which it is stored.

    numbers : vector of doubles that begins with a, b, e, t and weights, ``n`` numbers each, and Q
        by rows; at least (5 + n) n numbers.
    n : int, number of modes, >= 0.
    unlike : bool, whether the bodies differ, so that the weights are kept; else they are empty.
    """
    # without weights these are still stored: Q begins at row 5 in any case
    row = numbers[: (5 + n) * n].reshape(5 + n, n)
    return Series(
        a=row[0], b=row[1], e=row[2], t=row[3], weights=row[4, : n if unlike else 0], Q=row[5:]
    )


@inline_kernel
def split_workspace(numbers, modes):
    """Return the :class:`Workspace` of a series as views of one vector; nothing is written.

    numbers : vector of :func:`workspace_size` doubles.
    modes : int, number of modes, >= 0.
    """
    # six vectors of n numbers, then the matrix, modes times n, then four numbers a function
    n = LANES * modes
    end = (_VECTORS + modes) * n
    row = numbers[: _VECTORS * n].reshape(_VECTORS, n)
    return Workspace(
        inverse_r=row[0],
        k=row[1],
        i2=row[2],
        y=row[3],
        kf=row[4],
        right=row[5],
        matrix=numbers[_VECTORS * n : end],
        functions=numbers[end:],
    )


def new_workspace(modes: int) -> Workspace:
    """Return a new :class:`Workspace` for a series of ``modes`` modes, an int >= 0; its arrays are
    not initialized.
    """
    return split_workspace.py_func(np.empty(workspace_size(modes)), modes)


@inline_kernel
def evaluate_ratios(places, series, work):
    """Write 1/r, k and i2 of every mode at four values of z: ratios of Bessel functions of rate
    times z.

    Of relaxation mode i, r = I1/I0 and i2 = I2/I0 at a_i z; of creep mode j, k = K0/K1 at b_j z.

    places : vector of four z > 0, in the unit of time of the series; z may be infinite, where r =
    k = i2 = 1.
    series : :class:`Series`, of which the rates a and b are read.
    work : :class:`Workspace` of the series, whose ``inverse_r``, ``i2`` and ``k`` are written,
        dimensionless, four numbers a mode: number c of a mode belongs to number c of ``places``.
        Returns nothing.
    """
    z = unpack(places)
    # number ``at`` of the flat vectors: place at % LANES of mode at // LANES
    for at in range(LANES * series.a.size):
        i = at // LANES
        x = series.a[i] * z[at % LANES]
        r, _ = ratio_r(x)
        work.inverse_r[at] = 1.0 / r
        work.i2[at] = ratio_i2(x, r)
        work.k[at], _ = ratio_k(series.b[i] * z[at % LANES])


# --- arithmetic of four values or of a jet ---


@inline_kernel
def multiply(jets, p, q):
    """Return the product of two vectors of four: number by number, or as jets.

    jets : bool, True if ``p`` and ``q`` are jets (value, d/dz, d/ds, d2/dz ds), whose product then
        follows the product rule; False: four values each, multiplied number by number.
    p, q : the factors, vectors of four.
    Returns a vector of four.
    """
    if not jets:
        return p * q
    # The product rule: value, d/dz, d/ds and d2/dz ds of p q.
    p0, p1, p2, p3 = unpack(p)
    q0, q1, q2, q3 = unpack(q)
    return pack(
        p0 * q0, p1 * q0 + p0 * q1, p2 * q0 + p0 * q2, p3 * q0 + p1 * q2 + p2 * q1 + p0 * q3
    )


@inline_kernel
def reciprocal(jets, p):
    """Return 1/p of a vector of four values, or of a jet.

    jets : bool, whether the four are a jet (value, d/dz, d/ds, d2/dz ds) instead of values at four
    places.
    p : vector of four numbers, of a jet with the first other than 0; of values a 0 gives an
    infinity.
    Returns a vector of four of the same kind: 1/p number by number, or the jet of 1/p.
    """
    inverse = 1.0 / p
    if not jets:
        return inverse
    # With w = 1/p: dw = -w^2 dp, and d2w/dz ds = w^2 (2 w p_z p_s - p_zs).
    w, _, _, _ = unpack(inverse)
    _, dz, ds, dzds = unpack(p)
    return pack(w, -w * w * dz, -w * w * ds, w * w * (2.0 * w * dz * ds - dzds))


@inline_kernel
def _strength(jets, strength, rate):
    """Return e_i, or t_j, as a vector of four: four times the number, or its jet.

    E_i a_i and J_j b_j do not depend on s, so that e_i = sqrt(E_i a_i)/a_i, with a_i - s for a_i,
    has the slope e_i/a_i at s = 0.

    jets : bool, whether a jet (value, d/dz, d/ds, d2/dz ds) is returned.
    strength : float, e_i or t_j, square root of a time.
    rate : float, a_i or b_j, rate of the same mode; read for a jet alone.
    Returns a vector of four: the strength four times, or its jet (strength, 0, strength/rate, 0).
    """
    return pack(strength, 0.0, strength / rate, 0.0) if jets else broadcast(strength)


@inline_kernel
def _value(jets, p):
    """Return the value of a jet ``p``, four times, a vector of four; if the bool ``jets`` is False,
    ``p`` itself.
    """
    return broadcast(unpack(p)[0]) if jets else p


@inline_kernel
def _factorize(matrix, count):
    """Factorize symmetric positive definite matrices as L D L^T, four at once, in place.

    matrix : (count, count) vectors of four, flat, row by row; number c of all vectors makes up
        matrix c.  The lower half with the diagonal is read, and overwritten by 1/D on the diagonal
        and by L D below it; the upper half is neither read nor written.
    count : int, number of rows, >= 0.
    Returns nothing.  It is not tested that D is positive: a 0 in it gives infinities and NaNs.
    """
    row_size = LANES * count
    # Column i of what is left: 1/D is stored, and from each later row L times column i subtracted;
    # LANES (n count + i) is the place of element (n, i).
    for i in range(0, row_size, LANES):
        inverse = 1.0 / load(matrix, i * count + i)
        store(matrix, i * count + i, inverse)
        for row in range(i + LANES, row_size, LANES):
            # -L of this row; vectors have no unary minus.  What is stored below the diagonal is not
            # divided by D: it is L D.
            factor = load(matrix, row * count + i) * (0.0 - inverse)
            for column in range(i + LANES, row + LANES, LANES):
                at = row * count + column
                store(matrix, at, fma4(factor, load(matrix, column * count + i), load(matrix, at)))


@inline_kernel
def _substitute(matrix, right, count):
    """Solve four linear systems with factorized matrices, in place of their right sides.

    matrix : factors by :func:`_factorize`, (count, count) vectors of four, flat; not changed.
    right : right sides, ``count`` vectors of four, flat; overwritten by the solutions.
    count : int, number of unknowns of each system, >= 0.
    Returns nothing.
    """
    row_size = LANES * count
    # Forwards with L: 1/D times the right side i, times column i of L D, is taken from later ones.
    # Then backwards: D and L^T, with the products of row ``row`` of L D taken from earlier ones.
    for i in range(0, row_size, LANES):
        unknown = load(matrix, i * count + i) * load(right, i)
        for row in range(i + LANES, row_size, LANES):
            store(right, row, load(right, row) - load(matrix, row * count + i) * unknown)
    for row in range(row_size - LANES, -1, -LANES):
        unknown = load(matrix, row * count + row) * load(right, row)
        store(right, row, unknown)
        for i in range(0, row, LANES):
            store(right, i, load(right, i) - load(matrix, row * count + i) * unknown)


@inline_kernel
def solve_modes(jets, series, work):
    """Solve (1/r + Q^T k Q) y = e for the stresses y of the modes; write y and k f, f = Q y, into
    the workspace.

    jets : bool, whether vectors are jets (value, d/dz, d/ds, d2/dz ds) instead of values at four
    places.
    series : :class:`Series`: rates, strengths and Q of the modes.
    work : :class:`Workspace` of the series with the ratios 1/r and k, four numbers a mode.  ``y``
        and ``kf`` are written, in the unit of e, square root of a time; ``right`` is scratch, and
        ``matrix`` ends as the factors of :func:`_factorize`.  Returns nothing; without modes
        nothing is written.

    Values need one solve.  For a jet the matrix is factorized by its value alone, and the error of
    the solution is corrected with these factors: the first solve leaves an error in the
    derivatives, which has d/dz or d/ds as a factor; the second leaves one with both, in d2/dz ds;
    the third leaves none.
    """
    count = series.a.size
    # Row i of the matrix, up to its diagonal; ``kf`` holds column i of k Q until it is written.
    for i in range(count):
        for j in range(count):
            store(work.kf, LANES * j, series.Q[j, i] * load(work.k, LANES * j))
        for n in range(0, i + 1, 2):  # two sums that do not wait for one another
            other = n + 1 if n < i else n  # the last sum may be formed twice; that is harmless
            at = LANES * i * count
            first = second = broadcast(0.0)
            for j in range(count):
                x = load(work.kf, LANES * j)
                first = fma4(broadcast(series.Q[j, n]), x, first)
                second = fma4(broadcast(series.Q[j, other]), x, second)
            store(work.matrix, at + LANES * n, _value(jets, first))
            store(work.matrix, at + LANES * other, _value(jets, second))
        at = LANES * i * (count + 1)  # the diagonal, to which 1/r is added
        store(
            work.matrix, at, load(work.matrix, at) + _value(jets, load(work.inverse_r, LANES * i))
        )
        store(work.right, LANES * i, _strength(jets, series.e[i], series.a[i]))
        store(work.y, LANES * i, broadcast(0.0))
    _factorize(work.matrix, count)
    for turn in range(3 if jets else 1):
        if turn > 0:  # The right side is the residual e - (1/r + Q^T k Q) y, as jets.
            for i in range(count):
                total = multiply(jets, load(work.inverse_r, LANES * i), load(work.y, LANES * i))
                for j in range(count):
                    total = fma4(broadcast(series.Q[j, i]), load(work.kf, LANES * j), total)
                store(work.right, LANES * i, _strength(jets, series.e[i], series.a[i]) - total)
        _substitute(work.matrix, work.right, count)
        for at in range(0, LANES * count, LANES):
            store(work.y, at, load(work.y, at) + load(work.right, at))
        for j in range(count):
            f = broadcast(0.0)
            for i in range(count):
                f = fma4(broadcast(series.Q[j, i]), load(work.y, LANES * i), f)
            store(work.kf, LANES * j, multiply(jets, load(work.k, LANES * j), f))


@kernel
def _split_moment(jets, lam2, series, work):
    """Return the parts of m = M/V that half-space and cylinder take.

    A creep mode has the moment m_j (module docstring).  The half-space takes the sum of weights_j
    m_j, the cylinder that of (1 - weights_j) m_j.

    jets : bool, whether vectors are jets (value, d/dz, d/ds, d2/dz ds) instead of values at four
        places.  Of a jet only the value and d/dz of the results are right: here rates and strengths
        count as constant in s, so that the other two numbers have no meaning.
    lam2 : lam^2, square of the contact length divided by l0, dimensionless, vector of four.
    series : :class:`Series`, with weights of the half-space and at least one mode, all of whose
        strengths e are above 0.
    work : :class:`Workspace` of the series with i2, with k f, and with X in ``y``; ``right`` is
        overwritten by v_i = lam^2 X_i u_i/e_i.

    Returns (part of the half-space, part of the cylinder), vectors of four, in the unit of time of
    the series.  Their sum is m, but for rounding.
    """
    count = series.a.size
    half_space = cylinder = broadcast(0.0)
    # ``right`` becomes v_i: u is u_i, and ``y`` holds X.
    for i in range(count):
        own = u = load(work.i2, LANES * i)  # i2_i, and the first term of u_i
        a = series.a[i]
        for n in range(count):
            weight = a * series.a[n] / (a + series.a[n])
            u += weight * multiply(jets, load(work.y, LANES * n), own - load(work.i2, LANES * n))
        v = multiply(jets, multiply(jets, load(work.y, LANES * i), u), lam2)
        store(work.right, LANES * i, (1.0 / series.e[i]) * v)
    # m_j/t_j = k_j f_j + sum_i Q_ji v_i
    for j in range(count):
        moment = load(work.kf, LANES * j)
        for i in range(count):
            moment += series.Q[j, i] * load(work.right, LANES * i)
        half_space += series.weights[j] * series.t[j] * moment
        cylinder += (1.0 - series.weights[j]) * series.t[j] * moment
    return half_space, cylinder


@inline_kernel
def evaluate_functions(jets, z, series, work):
    """Write g/z, h/z and m of both bodies at z > 0 into ``work.functions``.

    jets : bool, whether vectors are jets (value, d/dz, d/ds, d2/dz ds) instead of values at four
    places.
    z : vector of four z, or the jet (z, 1, 0, 0) of one, in the unit of time of the series; it may
        be infinite, where g/z and h/z are 0 and the slopes of a jet are NaN.
    series : :class:`Series`: rates and strengths of the modes; elastic if it has no modes, where
    all results are 0.
    work : :class:`Workspace` of the series with the ratios 1/r, k and i2 at z.  ``functions`` is
        written: vectors of four g/z and h/z, dimensionless, at G_OVER_Z and H_OVER_Z, and m of
        half-space and cylinder, in the unit of time of the series, at M_HALF_SPACE and M_CYLINDER.
        ``y`` ends as X, ``kf`` as k f; ``right`` and ``matrix`` are scratch.

    Returns (g, h, sum X_i i2_i), vectors of four; g and h are in the unit of time of the series.

    If the bodies are alike (``weights`` is empty), each has half of m.  Else the parts by
    :func:`_split_moment`, whose sum has rounding errors of some alpha times its last digit, are
    multiplied by one factor that makes their sum m; of a jet they have no slopes in s.
    """
    solve_modes(jets, series, work)
    unit = pack(1.0, 0.0, 0.0, 0.0) if jets else broadcast(1.0)  # the number 1
    g = h = pressed = broadcast(0.0)  # ``pressed`` is sum X_i i2_i
    for i in range(series.a.size):
        at = LANES * i
        ey = multiply(jets, _strength(jets, series.e[i], series.a[i]), load(work.y, at))
        X = multiply(jets, ey, load(work.inverse_r, at))
        store(work.y, at, X)
        h += ey
        g += multiply(jets, _strength(jets, series.t[i], series.b[i]), load(work.kf, at))
        pressed += multiply(jets, X, load(work.i2, at))
    inverse_z = reciprocal(jets, z)
    h_over_z = multiply(jets, h, inverse_z)
    # lam^2 = 1/(1 + 2 h/z), and m = g + lam^2 sum X_i i2_i
    lam2 = reciprocal(jets, unit + 2.0 * h_over_z)
    m = g + multiply(jets, lam2, pressed)
    half_space = cylinder = 0.5 * m
    if series.weights.size > 0:
        half_space, cylinder = _split_moment(jets, lam2, series, work)
        factor = multiply(jets, m, reciprocal(jets, half_space + cylinder))
        half_space = multiply(jets, half_space, factor)
        cylinder = multiply(jets, cylinder, factor)
    store(work.functions, G_OVER_Z, multiply(jets, g, inverse_z))
    store(work.functions, H_OVER_Z, h_over_z)
    store(work.functions, M_HALF_SPACE, half_space)
    store(work.functions, M_CYLINDER, cylinder)
    return g, h, pressed
