"""Boundary elements of a contact: mesh, matrices of slopes by piecewise linear tractions, moments.

Lengths are divided by l0, the contact length at rest of half-spaces; slopes by l0/R; tractions so that an elastic
half-space of the summed long-time compliance has the slope (1/pi) int p(y)/(x - y) dy.  Nodes ascend from the rear edge
to the front edge; both tractions are 0 at the two outer nodes.  Slopes are collocated at one place in each element.
"""

import math

import numpy as np

from ..compile.intrinsics import fma
from ..compile.jit import inline_kernel, kernel

#: degree of the polynomials of a table in ln|x|
DEGREE = 8
#: smallest ln|x| of a table
LOWEST = -24.5
#: width of a bin in ln|x|
WIDTH = 0.35
#: number of bins: up to |x| = exp(1.4), four contact lengths at rest
BINS = 74


@inline_kernel
def graded(t):
    """Return the place in [0, 1] of the parameter t of a mesh: dense at both ends, as tractions fall like roots."""
    return math.sin(0.5 * math.pi * t) ** 2


@kernel
def make_mesh(c, count, edge, place, nodes, at):
    """Write the nodes of a mesh and the places of collocation, one in each element.

    c : half length of the contact, > 0.
    count : number of elements.
    edge : int, node that is moved, with the others along; 0: none.
    place : parameter in (0, 1) to which node ``edge`` is moved from edge/count.
    nodes, at : (count + 1,) and (count,), written, from -c to c.
    """
    own = edge / count
    for n in range(2 * count + 1):
        t = 0.5 * n / count
        if edge > 0:
            t = t * place / own if t <= own else place + (t - own) * (1.0 - place) / (1.0 - own)
        x = -c + 2.0 * c * graded(t)
        if n % 2:
            at[n // 2] = x
        else:
            nodes[n // 2] = x


@kernel(allocates=True)
def assemble(table, instant, nodes, at, H, T, C):
    """Write the matrices of slopes: second differences of the second antiderivatives of the kernels.

    table : polynomials in ln|x|, (BINS, 2 signs of x, 3 kernels, DEGREE + 1), of the slope by pressure, of the strain
        by shear, and of the coupling; without ``instant`` x ln|x|/pi of the first two.
    instant : instantaneous compliance over the summed long-time compliance.
    nodes, at : mesh, (N + 1,) and (N,), of at most exp(1.4) in all.
    H, T, C : (N, N - 1) each, written: slope at places by the traction at inner nodes.
    """
    N = at.size
    first = np.empty(N + 1)
    second = np.empty(N + 1)
    third = np.empty(N + 1)
    for i in range(N):
        for j in range(N + 1):
            x = at[i] - nodes[j]
            log = math.log(abs(x))
            y = (log - LOWEST) / WIDTH
            b = min(max(int(y), 0), BINS - 1)
            y = 2.0 * (y - b) - 1.0
            p = table[b, 0 if x > 0.0 else 1]
            a0 = p[0, DEGREE]
            a1 = p[1, DEGREE]
            a2 = p[2, DEGREE]
            for d in range(DEGREE - 1, -1, -1):
                a0 = fma(a0, y, p[0, d])
                a1 = fma(a1, y, p[1, d])
                a2 = fma(a2, y, p[2, d])
            own = instant * x * log / math.pi
            first[j] = a0 + own
            second[j] = a1 + own
            third[j] = a2
        for n in range(N - 1):
            behind = 1.0 / (nodes[n + 1] - nodes[n])
            ahead = 1.0 / (nodes[n + 2] - nodes[n + 1])
            H[i, n] = behind * (first[n] - first[n + 1]) + ahead * (first[n + 2] - first[n + 1])
            T[i, n] = behind * (second[n] - second[n + 1]) + ahead * (second[n + 2] - second[n + 1])
            C[i, n] = behind * (third[n] - third[n + 1]) + ahead * (third[n + 2] - third[n + 1])


@inline_kernel
def node_value(values, e):
    """Return the traction at node e of a mesh, 0 at the two outer ones; ``values``: those at inner nodes."""
    return values[e - 1] if 0 < e <= values.size else 0.0


@kernel
def moments(nodes, values):
    """Return (integral, first moment) of a traction.  nodes: (N + 1,); values: at inner nodes, (N - 1,)."""
    total = 0.0
    moment = 0.0
    for e in range(nodes.size - 1):
        a = node_value(values, e)
        b = node_value(values, e + 1)
        h = nodes[e + 1] - nodes[e]
        total += 0.5 * h * (a + b)
        moment += h * (0.5 * nodes[e] * (a + b) + h * (a + 2.0 * b) / 6.0)
    return total, moment


@kernel
def product(nodes, at, values, slope):
    """Return the integral of a traction times a slope that is linear in each element.

    The gradient in an element is that between the places of its neighbours, so that a linear slope is exact.
    nodes, at : mesh, (N + 1,) and (N,).
    values : traction at inner nodes, (N - 1,).
    slope : at ``at``, (N,).
    """
    found = 0.0
    last = at.size - 1
    for e in range(last + 1):
        a = node_value(values, e)
        b = node_value(values, e + 1)
        h = nodes[e + 1] - nodes[e]
        low = max(e - 1, 0)
        high = min(e + 1, last)
        gradient = (slope[high] - slope[low]) / (at[high] - at[low])
        middle = slope[e] + gradient * (0.5 * (nodes[e] + nodes[e + 1]) - at[e])
        found += h * (0.5 * (a + b) * middle + gradient * h * (b - a) / 12.0)
    return found
