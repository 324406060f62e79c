"""The linear system of one contact, and the zones of stick and slip that satisfy Coulomb's law.

With pressure p and shear q at inner nodes, g the place of the middle of the contact ahead of the axis, and x the places
of collocation,

    H p + C q = x + g        u' = T q - C p        d - u' = 0 in stick, q = mu z p in slip with z = 1 or -1

Pressure and g are eliminated once for a mesh, so that the system of each choice of zones has the size of q alone.
"""

import numpy as np

from ..compile.jit import kernel

#: choices of zones after which one node changes at a time
_TOGETHER = 12
#: largest number of choices of zones, beside one for each node
_MOST_CHOICES = 40
#: relative excess of |q| over mu p, and of slip in the wrong direction over the largest slip, that count as rounding
_ROUNDING = 1e-10


@kernel(allocates=True)
def factor(matrix, order):
    """Replace a square matrix by its factors L and U, with row exchanges; return whether no pivot is 0.

    matrix : (n, n), overwritten.
    order : (n,), int, written: the row that was exchanged with each.
    """
    n = matrix.shape[0]
    for k in range(n):
        best = k
        for i in range(k + 1, n):
            if abs(matrix[i, k]) > abs(matrix[best, k]):
                best = i
        order[k] = best
        if not abs(matrix[best, k]) > 0.0:
            return False
        if best != k:
            for j in range(n):
                kept = matrix[k, j]
                matrix[k, j] = matrix[best, j]
                matrix[best, j] = kept
        scale = 1.0 / matrix[k, k]
        top = matrix[k]
        for i in range(k + 1, n):
            row = matrix[i]
            part = row[k] * scale
            row[k] = part
            if part != 0.0:
                for j in range(k + 1, n):
                    row[j] -= part * top[j]
    return True


@kernel(allocates=True)
def substitute(matrix, order, right):
    """Solve for many right sides with the factors of :func:`factor`.

    matrix, order : factors and row exchanges, (n, n) and (n,).
    right : (n, m), replaced by the solutions.
    """
    n, m = right.shape
    for k in range(n):
        best = order[k]
        if best != k:
            for j in range(m):
                kept = right[k, j]
                right[k, j] = right[best, j]
                right[best, j] = kept
    for i in range(n):
        row = right[i]
        for k in range(i):
            part = matrix[i, k]
            other = right[k]
            for j in range(m):
                row[j] -= part * other[j]
    for i in range(n - 1, -1, -1):
        row = right[i]
        for k in range(i + 1, n):
            part = matrix[i, k]
            other = right[k]
            for j in range(m):
                row[j] -= part * other[j]
        scale = 1.0 / matrix[i, i]
        for j in range(m):
            row[j] *= scale


@kernel(allocates=True)
def eliminate(H, C, at, coupled):
    """Eliminate pressure and g: p = a - B q.

    H, C : matrices of slopes, (N, N - 1).
    at : places of collocation, (N,).
    coupled : whether C is not 0.
    Returns (whether the matrix has an inverse; (N, N): B in its first N - 1 columns, a in the last; the last row
    belongs to g).  Without ``coupled`` B is 0.
    """
    N = at.size
    matrix = np.empty((N, N))
    matrix[:, : N - 1] = H
    matrix[:, N - 1] = -1.0
    order = np.empty(N, np.int64)
    good = factor(matrix, order)
    found = np.zeros((N, N))
    if not good:
        return good, found
    if coupled:
        found[:, : N - 1] = C
        found[:, N - 1] = at
        substitute(matrix, order, found)
    else:
        one = at.reshape(N, 1).copy()
        substitute(matrix, order, one)
        found[:, N - 1] = one[:, 0]
    return good, found


@kernel(allocates=True)
def strain_by_shear(T, C, B, coupled):
    """Return (N, N): columns of the strain u' by q, and in the last column what u' is without q, both with p free.

    T, C : matrices of slopes, (N, N - 1).
    B : elimination of p, of :func:`eliminate`.
    coupled : whether C is not 0.
    """
    N = B.shape[0]
    S = np.zeros((N, N))
    S[:, : N - 1] = T
    if coupled:
        for i in range(N):
            row = S[i]
            for k in range(N - 1):
                part = C[i, k]
                other = B[k]
                for j in range(N - 1):
                    row[j] += part * other[j]
                row[N - 1] -= part * other[N - 1]
    return S


@kernel(allocates=True)
def solve_zones(S, B, mu, zone, d, q):
    """Solve for the shear with given zones; return whether it has a solution.

    S, B : of :func:`strain_by_shear` and :func:`eliminate`.
    mu : coefficient of friction.
    zone : 0 for stick, 1 or -1 for slip at each inner node, (N - 1,).
    d : creep.
    q : (N - 1,), written.
    A node that sticks demands no slip in the element ahead of it.
    """
    n = zone.size
    matrix = np.empty((n, n))
    right = np.empty((n, 1))
    for j in range(n):
        row = matrix[j]
        z = mu * zone[j]
        if z == 0.0:
            other = S[j + 1]
            for k in range(n):
                row[k] = other[k]
            right[j, 0] = d - other[n]
        else:
            other = B[j]
            for k in range(n):
                row[k] = z * other[k]
            row[j] += 1.0
            right[j, 0] = z * other[n]
    order = np.empty(n, np.int64)
    if not factor(matrix, order):
        return False
    substitute(matrix, order, right)
    q[:] = right[:, 0]
    return True


@kernel(allocates=True)
def pressure_and_strain(S, B, q, p, strain):
    """Write pressure and strain of a shear; return g.

    S, B : of :func:`strain_by_shear` and :func:`eliminate`.
    q : (N - 1,).
    p, strain : (N - 1,) and (N,), written.
    """
    n = q.size
    g = 0.0
    for i in range(n + 1):
        own = B[i]
        row = S[i]
        value = own[n]
        slope = row[n]
        for j in range(n):
            value -= own[j] * q[j]
            slope += row[j] * q[j]
        strain[i] = slope
        if i < n:
            p[i] = value
        else:
            g = value
    return g


@kernel(allocates=True)
def find_zones(S, B, mu, d, zone, kept, p, q, strain):
    """Find the zones of stick and slip of one contact by exchange of nodes.

    S, B : of :func:`strain_by_shear` and :func:`eliminate`.
    mu, d : coefficient of friction, creep.
    zone : (N - 1,), changed in place, from a first guess.
    kept : number of inner nodes from the rear whose zone is not changed.
    p, q, strain : (N - 1,), (N - 1,) and (N,), written.
    Returns (whether zones were found; g).
    """
    n = zone.size
    new = np.empty(n)
    g = 0.0
    for choice in range(_MOST_CHOICES + n):
        if not solve_zones(S, B, mu, zone, d, q):
            return False, g
        g = pressure_and_strain(S, B, q, p, strain)
        scale = 0.0
        for e in range(n + 1):
            scale = max(scale, abs(d - strain[e]))
        worst = 0.0
        which = -1
        for i in range(kept, n):
            new[i] = zone[i]
            slip = d - strain[i + 1]
            wrong = 0.0
            if zone[i] == 0.0:
                over = abs(q[i]) - mu * p[i] * (1.0 + _ROUNDING)
                if over > 0.0:
                    new[i] = 1.0 if q[i] > 0.0 else -1.0
                    wrong = over / max(mu * abs(p[i]), 1e-300)
            elif slip * zone[i] < -_ROUNDING * scale:
                new[i] = 0.0
                wrong = abs(slip) / scale
            if wrong > worst:
                worst = wrong
                which = i
        if which < 0:
            return True, g
        if choice > _TOGETHER:
            zone[which] = new[which]
        else:
            for i in range(kept, n):
                zone[i] = new[i]
    return False, g
