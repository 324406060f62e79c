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
#: largest part of the elements that gather at spots
_SPOTS_PART = 0.7
#: element over twice the length of a mode below and above which its local part is taken from a series
_SMALL_RATIO, _LARGE_RATIO = 1e-4, 40.0
#: error of a node in units of elements, and largest number of steps that find it
_MESH_ERROR, _MOST_STEPS = 1e-9, 60


@inline_kernel
def graded(t):
    """Return the place in [0, 1] of the parameter t of a mesh: dense at both ends, as tractions fall like roots."""
    return math.sin(0.5 * math.pi * t) ** 2


@inline_kernel
def _gathered(t, spots, used):
    """Return (sum over spots of weight sgn(t - place) ln(1 + |t - place|/width); its derivative)."""
    total = 0.0
    rate = 0.0
    for k in range(used):
        distance = t - spots[k, 0]
        width = spots[k, 1]
        weight = spots[k, 2]
        total += math.copysign(weight * math.log(1.0 + abs(distance) / width), distance)
        rate += weight / (abs(distance) + width)
    return total, rate


@kernel
def make_mesh(c, spots, used, nodes, at, place):
    """Write the nodes of a mesh and the places of collocation, one in each element.

    The elements are equal in s(t) = a t + sum of weight ln(1 + |t - spot|/width): geometric towards each spot.

    c : half length of the contact, > 0.
    spots : (most, 3): parameter in [0, 1], width > 0 in the parameter, and number of elements in a factor of e of the
        distance from it; changed in place: weights are reduced where spots would take more than :data:`_SPOTS_PART`.
    used : number of spots.
    nodes, at, place : (N + 1,), (N,) and (N + 1,), written: from -c to c; the parameter of each node.
    """
    count = at.size
    low, _ = _gathered(0.0, spots, used)
    high, _ = _gathered(1.0, spots, used)
    if high - low > _SPOTS_PART * count:
        reduced = _SPOTS_PART * count / (high - low)
        for k in range(used):
            spots[k, 2] *= reduced
        low *= reduced
        high *= reduced
    plain = count - (high - low)
    t = 0.0
    for n in range(2 * count + 1):
        wanted = 0.5 * n + low
        left = t
        right = 1.0
        t = min(t + 0.5 / count, 1.0)
        for _ in range(_MOST_STEPS):
            total, rate = _gathered(t, spots, used)
            error = plain * t + total - wanted
            if abs(error) < _MESH_ERROR:
                break
            if error > 0.0:
                right = t
            else:
                left = t
            t -= error / (plain + rate)
            if not left < t < right:
                t = 0.5 * (left + right)
        if n == 0:
            t = 0.0
        if n == 2 * count:
            t = 1.0
        x = -c + 2.0 * c * graded(t)
        if n % 2:
            at[n // 2] = x
        else:
            nodes[n // 2] = x
            place[n // 2] = t


@kernel
def scale_mesh(c, nodes, at):
    """Scale a mesh to another half length, c.  nodes, at : (N + 1,) and (N,), changed."""
    factor = 2.0 * c / (nodes[at.size] - nodes[0])
    for n in range(at.size):
        nodes[n] *= factor
        at[n] *= factor
    nodes[at.size] *= factor


@inline_kernel
def _local_part(local, h):
    """Return the part of the coupling that acts at the middle of an element of length h as if at once.

    local : (modes, 2), strength and length of each, with 0 for the length of the instantaneous one.
    It is the integral of the memory times what linear tractions leave out: the parabola that is 1 there and 0 at the
    ends of the element, less its mean 2/3, which the values at the nodes make up for.
    """
    found = 0.0
    for k in range(local.shape[0]):
        length = local[k, 1]
        r = 0.5 * h / length if length > 0.0 else np.inf
        if r < _SMALL_RATIO:
            found += local[k, 0] * r * r / 12.0
        elif r > _LARGE_RATIO:
            found += local[k, 0] * (1.0 / 3.0 - (2.0 / r) / r)
        else:
            decay = math.exp(-r)
            found += local[k, 0] * ((1.0 - decay) / 3.0 - (2.0 - decay * (r * (r + 2.0) + 2.0)) / (r * r))
    return found


@kernel
def add_local(local, nodes, at, C):
    """Add to the local part of the coupling what linear tractions leave out, by the values at four nodes.

    local : as of :func:`_local_part`; nodes, at : mesh; C : matrix of :func:`assemble`, changed.
    The tractions are odd about the two outer nodes, in the parameter of the mesh.
    """
    last = at.size - 1
    for e in range(last + 1):
        h = nodes[e + 1] - nodes[e]
        part = _local_part(local, h)
        ahead = (at[e] - nodes[e]) / h
        if e > 0:
            C[e, e - 1] += part * (0.5625 - (1.0 - ahead))
        if e < last:
            C[e, e] += part * (0.5625 - ahead)
        if e > 1:
            C[e, e - 2] -= part * 0.0625
        elif e == 0:
            C[e, 0] += part * 0.0625
        if e < last - 1:
            C[e, e + 1] -= part * 0.0625
        elif e == last:
            C[e, last - 1] += part * 0.0625


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
