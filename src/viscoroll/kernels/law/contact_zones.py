"""Zones of stick and slip of one contact by Coulomb's law, and the linear system of its tractions.

With pressure p and shear q at inner nodes, g the distance of the middle of the contact ahead of the
axis, x the collocation points, counted from the middle, u' the strain of the surface there, d =
kappa delta with the creepage delta, mu the coefficient of friction, and the matrices H, T and C of
:mod:`.contact_elements`, whose units are those of this module,

    H p + C q = x + g        u' = T q - C p
    d - u' = 0 in stick, q = mu z p in slip with z = 1 or -1

(docs/theory_covers.md, Pressure and shear together).  Pressure and g are eliminated once for a
mesh, p = a - B q, so that the system of each choice of zones has the size of q alone.
"""

import numpy as np

from ..numerics.jit import kernel

#: choices of zones after which one node changes at a time
_TOGETHER = 12
#: largest number of choices of zones, beside one for each node
_MOST_CHOICES = 40
#: relative excess of |q| over mu p, and of slip in the wrong direction over the largest slip, that
#: count as rounding
_ROUNDING = 1e-10


@kernel(allocates=True)
def solve(matrix):
    """Solve linear systems by elimination with row exchanges; return whether no pivot is 0.

    matrix : (n, n + m), the square matrix and, behind it, m right sides as columns, which are
        replaced by the solutions; the rest is overwritten.  Where a pivot is 0 or NaN all numbers
        are without meaning.
    Returns a bool.
    """
    n, width = matrix.shape
    for k in range(n):
        best = k
        for i in range(k + 1, n):
            if abs(matrix[i, k]) > abs(matrix[best, k]):
                best = i
        if not abs(matrix[best, k]) > 0.0:  # True for NaN too.
            return False
        if best != k:
            for j in range(k, width):
                kept = matrix[k, j]
                matrix[k, j] = matrix[best, j]
                matrix[best, j] = kept
        scale = 1.0 / matrix[k, k]
        top = matrix[k]
        for i in range(k + 1, n):
            row = matrix[i]
            part = row[k] * scale
            if part != 0.0:
                for j in range(k + 1, width):
                    row[j] -= part * top[j]
    # the right sides, from the last row on
    for i in range(n - 1, -1, -1):
        row = matrix[i]
        for k in range(i + 1, n):
            part = row[k]
            other = matrix[k]
            for j in range(n, width):
                row[j] -= part * other[j]
        scale = 1.0 / row[i]
        for j in range(n, width):
            row[j] *= scale
    return True


@kernel(allocates=True)
def eliminate(contact, coupled):
    """Eliminate pressure and g: p = a - B q.

    contact : :class:`.contact_elements.Contact`, of which H, C and the collocation points are read.
    coupled : bool, whether C is not 0; else it is not read.
    Returns (whether the matrix has an inverse, a bool; (N, N): B in its first N - 1 columns, a in
    the last; the last row belongs to g; numbers without meaning if there is no inverse).  Without
    ``coupled`` B is 0.
    """
    N = contact.at.size
    # (H, -1) (p, g) = x - C q, N equations for N - 1 pressures and g: (p, g) is the inverse times
    # x, the column a, less the inverse times C, the columns B, times q.
    first = 0 if coupled else N - 1  # without coupling B stays 0: one right side instead of N
    matrix = np.empty((N, 2 * N - first))
    matrix[:, : N - 1] = contact.H
    matrix[:, N - 1] = -1.0
    if coupled:
        matrix[:, N : 2 * N - 1] = contact.C
    matrix[:, -1] = contact.at
    good = solve(matrix)
    found = np.zeros((N, N))
    found[:, first:] = matrix[:, N:]
    return good, found


@kernel(allocates=True)
def strain_by_shear(contact, B, coupled):
    """Return the strain u' in the elements as a linear function of the shear q.

    The pressure is not fixed: it follows q by p = a - B q.

    contact : :class:`.contact_elements.Contact`, of which are read T, strain by shear, and C, with
        the opposite sign strain by pressure.
    B : elimination of p, (N, N), of :func:`eliminate`: B and, in the last column, a.
    coupled : bool, whether C is not 0; else neither C nor B is read.
    Returns (N, N): the factors of q in the first N - 1 columns, u' for q = 0 in the last.
    """
    N = B.shape[0]
    # u' = T q - C p = (T + C B) q - C a.
    S = np.zeros((N, N))
    S[:, : N - 1] = contact.T
    if coupled:
        for i in range(N):
            row = S[i]
            for k in range(N - 1):
                part = contact.C[i, k]
                other = B[k]  # p_k = a_k - B_k q; a_k is the last number of the row
                for j in range(N - 1):
                    row[j] += part * other[j]
                row[N - 1] -= part * other[N - 1]
    return S


@kernel(allocates=True)
def solve_zones(S, B, mu, d, contact):
    """Solve for the shear with given zones of stick and slip.

    A node that slips has q = zone mu p (Coulomb).  For a node that sticks the slip d - u' of the
    element ahead of it is 0.

    S : strain u' as a linear function of the shear, (N, N), of :func:`strain_by_shear`.
    B : pressure p = a - B q as a linear function of the shear, (N, N), of :func:`eliminate`.
    mu : float, coefficient of friction, > 0.
    d : float, kappa times the creepage delta.
    contact : :class:`.contact_elements.Contact`, whose zones are read, and whose shear is written
        if there is a solution.
    Returns whether there is a solution, a bool: False if the matrix is singular.
    """
    zone = contact.zone
    n = zone.size
    matrix = np.empty((n, n + 1))  # the right side is the last column
    for j in range(n):
        row = matrix[j]
        z = mu * zone[j]
        # Stick: the strain in element j + 1, ahead of inner node j, is d.  Slip: q = z (a - B q).
        if z == 0.0:
            other = S[j + 1]
            for k in range(n):
                row[k] = other[k]
            row[n] = d - other[n]
        else:
            other = B[j]
            for k in range(n):
                row[k] = z * other[k]
            row[j] += 1.0
            row[n] = z * other[n]
    if not solve(matrix):
        return False
    contact.q[:] = matrix[:, n]
    return True


@kernel(allocates=True)
def pressure_and_strain(S, B, contact):
    """Write pressure and strain that belong to a shear.

    S : strain u' as a linear function of the shear, (N, N), of :func:`strain_by_shear`.
    B : pressure p = a - B q as a linear function of the shear, (N, N), of :func:`eliminate`.
    contact : :class:`.contact_elements.Contact`, whose shear is read, and whose pressure and strain
        are written.
    Returns g, a float: distance of the middle of the contact ahead of the axis, divided by l0.
    """
    q = contact.q
    n = q.size
    for i in range(n + 1):
        own = B[i]
        row = S[i]
        # column n is the part without shear: p = a - B q, u' = u'(0) + S q
        value = own[n]
        slope = row[n]
        for j in range(n):
            value -= own[j] * q[j]
            slope += row[j] * q[j]
        contact.strain[i] = slope
        if i < n:  # the last row is that of g
            contact.p[i] = value
    return value


@kernel(allocates=True)
def find_zones(S, B, mu, d, contact):
    """Find the zones of stick and slip of one contact by exchange of nodes.

    Nodes that stick with |q| > mu p begin to slip; nodes whose slip is against q begin to stick.

    S : strain u' as a linear function of the shear, (N, N), of :func:`strain_by_shear`.
    B : pressure p = a - B q as a linear function of the shear, (N, N), of :func:`eliminate`.
    mu, d : floats, coefficient of friction, kappa times the creepage delta.
    contact : :class:`.contact_elements.Contact`, whose zones are a first guess, changed; pressure,
        shear and strain are written.
    Returns (whether zones were found, a bool; g of :func:`pressure_and_strain`, a float).
    """
    p = contact.p
    q = contact.q
    strain = contact.strain
    zone = contact.zone
    n = zone.size
    new = np.empty(n)
    g = 0.0
    for choice in range(_MOST_CHOICES + n):
        if not solve_zones(S, B, mu, d, contact):
            return False, g
        g = pressure_and_strain(S, B, contact)
        scale = 0.0  # largest slip, over V
        for e in range(n + 1):
            scale = max(scale, abs(d - strain[e]))
        worst = 0.0  # largest relative violation of Coulomb's law, and its node
        which = -1
        for i in range(n):
            new[i] = zone[i]
            slip = d - strain[i + 1]  # in the element ahead of the node, as in solve_zones
            wrong = 0.0
            if zone[i] == 0.0:
                over = abs(q[i]) - mu * p[i] * (1.0 + _ROUNDING)
                if over > 0.0:
                    new[i] = 1.0 if q[i] > 0.0 else -1.0
                    wrong = over / max(mu * abs(p[i]), 1e-300)  # not divided by a pressure of 0
            elif slip * zone[i] < -_ROUNDING * scale:  # never where ``scale`` is 0
                new[i] = 0.0
                wrong = abs(slip) / scale
            if wrong > worst:
                worst = wrong
                which = i
        if which < 0:
            return True, g
        # All wrong nodes change together in the first choices, then the worst alone.
        if choice > _TOGETHER:
            zone[which] = new[which]
        else:
            for i in range(n):
                zone[i] = new[i]
    return False, g
