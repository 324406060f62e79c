"""Boundary elements of a contact: its mesh, and the matrices of slope and strain by tractions.

Lengths are divided by l0, the contact length at rest of half-spaces; slopes by l0/R; tractions so
that an elastic half-space of the summed long-time compliance has the slope (1/pi) int p(y)/(x - y)
dy.  There are N elements.  Nodes ascend from the rear edge to the front edge; tractions are linear
between them, and 0 at the two outer ones.  Slopes are collocated at one point in each element, the
collocation point.
The equations in which the matrices enter are those of :mod:`.contact_zones`.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from ..numerics.intrinsics import fma
from ..numerics.jit import inline_kernel, kernel

#: degree of the polynomials of a table in ln|x|
DEGREE = 8
#: smallest ln|x| of a table
LOWEST = -24.5
#: width of a bin in ln|x|
WIDTH = 0.35
#: number of bins: up to |x| = exp(1.4), four contact lengths at rest
BINS = 74
#: largest fraction of the elements that the refinements of a mesh (its spots) may take
_SPOTS_PART = 0.7
#: element over twice the length of a mode below and above which its local part is taken from a
#: series
_SMALL_RATIO = 1e-4
_LARGE_RATIO = 40.0
#: error of a node in units of elements, and largest number of steps that find it
_MESH_ERROR = 1e-9
_MOST_STEPS = 60


class Contact(NamedTuple):
    """Arrays of one contact of N elements, in the units of the module.

    Inner node i is node i + 1 of the mesh; element e lies between nodes e and e + 1.

    nodes : (N + 1,), x of the nodes, from -c to c.
    at : (N,), x of the collocation points, one in each element.
    H, T, C : (N, N - 1), slope by pressure, strain by shear and coupling at the collocation points,
        by the tractions at inner nodes (:func:`assemble`).
    p, q : (N - 1,), pressure and shear at inner nodes.
    strain : (N,), u' at the collocation points.
    zone : (N - 1,), 0 for stick, 1 or -1 for the sign of the slip, at inner nodes.
    place : (N + 1,), parameters t of the nodes in the mesh, from 0 to 1.
    """

    nodes: Any
    at: Any
    H: Any
    T: Any
    C: Any
    p: Any
    q: Any
    strain: Any
    zone: Any
    place: Any


@inline_kernel
def _gathered(t, spots, used):
    """Return the number of elements by which refinements shift t, and its derivative in t, floats.

    It is the sum over refinements of weight sgn(t - t_k) ln(1 + |t - t_k|/width).

    t : float, parameter of the mesh, in [0, 1].
    spots : (most, 3), t_k in [0, 1], width > 0 in the parameter and weight of each refinement, the
        number of elements in a factor of e of the distance from it.
    used : int, number of refinements, rows of ``spots`` that count.
    """
    total = 0.0
    rate = 0.0
    for k in range(used):
        distance = t - spots[k, 0]
        width = spots[k, 1]
        weight = spots[k, 2]
        # odd about t_k, so that it ascends everywhere: the slope is the same on both sides
        total += math.copysign(weight * math.log(1.0 + abs(distance) / width), distance)
        rate += weight / (abs(distance) + width)
    return total, rate


@kernel
def make_mesh(c, spots, used, contact):
    """Write the nodes of a mesh and the collocation points, one in each element.

    A spot is a refinement about t_k.  The elements are equal in s(t) = a t + sum of weight sgn(t -
    t_k) ln(1 + |t - t_k|/width): their sizes form a geometric series towards each t_k.

    c : half length of the contact, > 0.
    spots : (most, 3): t_k in [0, 1]; width > 0 in units of t; weight, the number of elements in a
        factor of e of the distance from t_k.  The weights are reduced in place where spots would
        take more than :data:`_SPOTS_PART` of the elements.
    used : int, number of spots, rows of ``spots`` that count.
    contact : :class:`Contact`, of which are written: nodes, ascending from -c to c; collocation
        points, each half an element after the node before it; the parameter t of each node, from 0
        to 1.
    Returns nothing.
    """
    count = contact.at.size
    # elements that the spots take, high - low, at most a part of all: the others are left for a > 0
    low, _ = _gathered(0.0, spots, used)
    high, _ = _gathered(1.0, spots, used)
    if high - low > _SPOTS_PART * count:
        reduced = _SPOTS_PART * count / (high - low)
        for k in range(used):
            spots[k, 2] *= reduced
        low *= reduced
        high *= reduced
    plain = count - (high - low)  # a of s(t), such that s(1) - s(0) is the number of elements
    t = 0.0
    # Nodes and, half an element after each, collocation points: t with s(t) - s(0) = n/2, by
    # Newton's iteration, bisected where it leaves its bracket.
    for n in range(2 * count + 1):
        wanted = 0.5 * n + low  # low: total of the spots at t = 0, so that s(0) counts as 0
        left = t  # s ascends: t is not below that of the point before
        right = 1.0
        t = min(t + 0.5 / count, 1.0)  # first guess: half an element of equal ones further
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
        if n == 0:  # The ends are exact.
            t = 0.0
        if n == 2 * count:
            t = 1.0
        # dense at both ends, as tractions fall like roots there
        x = -c + 2.0 * c * math.sin(0.5 * math.pi * t) ** 2
        if n % 2:  # odd: the collocation point in element n // 2, else node n // 2
            contact.at[n // 2] = x
        else:
            contact.nodes[n // 2] = x
            contact.place[n // 2] = t


@kernel
def _add_local(local, contact):
    """Add to the local part of the coupling what linear tractions leave out, by the values at four
    nodes.

    local : (modes, 2), strength and length, divided by l0, of each mode, 0 for the length of the
        instantaneous one.
    contact : :class:`Contact`, whose matrix C is changed: row e belongs to the collocation point in
        element e.
    The tractions are odd about the two outer nodes, in the parameter of the mesh.
    Returns nothing.

    The part of the coupling that acts at the middle of an element of length h as if at once is the
    integral of the memory times what linear tractions leave out: the parabola that is 1 there and 0
    at the ends of the element, less its mean 2/3, which the values at the nodes make up for.  With
    r = h/(2 length) the integral of exp(-s) (1/3 - s^2/r^2) over s from 0 to r, which is (1 - e)/3
    - (2 - e (r^2 + 2 r + 2))/r^2 with e = exp(-r).
    """
    nodes = contact.nodes
    C = contact.C
    last = contact.at.size - 1
    for e in range(last + 1):
        h = nodes[e + 1] - nodes[e]
        part = 0.0
        for k in range(local.shape[0]):
            strength = local[k, 0]
            length = local[k, 1]
            r = 0.5 * h / length if length > 0.0 else np.inf
            # Where terms of the closed form cancel, the first term of its series, r^2/12; where
            # exp(-r) is below rounding, or r infinite, the form without it, in which r^2 is not
            # formed: it might overflow.
            if r < _SMALL_RATIO:
                part += strength * r * r / 12.0
            elif r > _LARGE_RATIO:
                part += strength * (1.0 / 3.0 - (2.0 / r) / r)
            else:
                decay = math.exp(-r)
                part += strength * (
                    (1.0 - decay) / 3.0 - (2.0 - decay * (r * (r + 2.0) + 2.0)) / (r * r)
                )
        # What linear tractions leave out at the point: the cubic through four nodes, with weights
        # (-1, 9, 9, -1)/16 in the middle of the element, less the linear interpolation, with
        # weights 1 - ``ahead`` and ``ahead``.  Column n belongs to node n + 1.
        ahead = (contact.at[e] - nodes[e]) / h
        # 0.5625 = 9/16 and 0.0625 = 1/16; the outer nodes have no traction and no column
        if e > 0:
            C[e, e - 1] += part * (0.5625 - (1.0 - ahead))
        if e < last:
            C[e, e] += part * (0.5625 - ahead)
        if e > 1:
            C[e, e - 2] -= part * 0.0625
        elif e == 0:  # The node before the first one has minus the traction of node 1.
            C[e, 0] += part * 0.0625
        if e < last - 1:
            C[e, e + 1] -= part * 0.0625
        elif e == last:
            C[e, last - 1] += part * 0.0625


@kernel(allocates=True)
def assemble(kernels, contact):
    """Write the matrices of slopes: second differences of the second antiderivatives of the
    kernels.

    kernels : record of ``table``, polynomials in ln|x|, (BINS, 2 signs of x, 3 kernels, DEGREE +
        1), of the slope by pressure, of the strain by shear, and of the coupling; without
        ``instant`` x ln|x|/pi of the first two.  Sign 0 is that of x > 0, the constant of a
        polynomial in y comes first.  ``instant``: instantaneous compliance over the summed
        long-time compliance.  ``local``: local coupling by modes (:func:`_add_local`).
    contact : :class:`Contact`, with a mesh of at most exp(1.4) in all, in which no collocation
        point is a node; its matrices are written: slope by pressure, strain by shear, and coupling,
        at the collocation point in element i by the traction 1 at inner node n.
    Returns nothing.
    """
    nodes = contact.nodes
    N = contact.at.size
    # Second antiderivatives of the three kernels, at the distance of point i from each node.
    first = np.empty(N + 1)
    second = np.empty(N + 1)
    third = np.empty(N + 1)
    for i in range(N):
        for j in range(N + 1):
            x = contact.at[i] - nodes[j]
            log = math.log(abs(x))
            # Bin b of ln|x|, and the position y in it in [-1, 1].  Beyond the bins the first or the
            # last polynomial is extrapolated.
            y = (log - LOWEST) / WIDTH
            b = min(max(int(y), 0), BINS - 1)
            y = 2.0 * (y - b) - 1.0
            p = kernels.table[b, 0 if x > 0.0 else 1]
            a0 = p[0, DEGREE]
            a1 = p[1, DEGREE]
            a2 = p[2, DEGREE]
            for d in range(DEGREE - 1, -1, -1):
                a0 = fma(a0, y, p[0, d])
                a1 = fma(a1, y, p[1, d])
                a2 = fma(a2, y, p[2, d])
            # the part of an instantaneous half-space, which the table leaves out
            own = kernels.instant * x * log / math.pi
            first[j] = a0 + own
            second[j] = a1 + own
            third[j] = a2
        # The traction of inner node n is 1 at node n + 1 and falls linearly to 0 at its neighbours:
        # its second derivative is three impulses, with which the antiderivative is multiplied.
        for matrix, values in ((contact.H, first), (contact.T, second), (contact.C, third)):
            for n in range(N - 1):
                behind = 1.0 / (nodes[n + 1] - nodes[n])
                ahead = 1.0 / (nodes[n + 2] - nodes[n + 1])
                matrix[i, n] = behind * (values[n] - values[n + 1]) + ahead * (
                    values[n + 2] - values[n + 1]
                )
    _add_local(kernels.local, contact)


@inline_kernel
def node_value(values, e):
    """Return the traction at node e of a mesh, which is 0 at the two outer nodes; ``values``: the
    tractions at inner nodes.
    """
    return values[e - 1] if 0 < e <= values.size else 0.0


@kernel
def moments(nodes, values):
    """Return (integral, first moment about the middle of the contact) of a traction, floats.

    nodes : (N + 1,), x of the nodes.
    values : (N - 1,), traction at inner nodes.
    """
    total = 0.0
    moment = 0.0
    for e in range(nodes.size - 1):
        a = node_value(values, e)
        b = node_value(values, e + 1)
        h = nodes[e + 1] - nodes[e]
        # linear from a to b: the moment about the left node is h^2 (a + 2 b)/6
        total += 0.5 * h * (a + b)
        moment += h * (0.5 * nodes[e] * (a + b) + h * (a + 2.0 * b) / 6.0)
    return total, moment


@kernel
def product(contact, values, slope):
    """Return the integral of a traction times a slope that is linear in each element.

    The gradient in an element is that between the collocation points of its neighbours, so that a
    linear slope is exact.

    contact : :class:`Contact`, whose mesh is read, N >= 2.
    values : traction at inner nodes, (N - 1,).
    slope : (N,), the slope at the collocation points, one in each element.
    Returns a float, in the units of the module.
    """
    nodes = contact.nodes
    at = contact.at
    found = 0.0
    last = at.size - 1
    for e in range(last + 1):
        a = node_value(values, e)
        b = node_value(values, e + 1)
        h = nodes[e + 1] - nodes[e]
        low = max(e - 1, 0)
        high = min(e + 1, last)
        gradient = (slope[high] - slope[low]) / (at[high] - at[low])
        # Slope in the middle of the element; the product of the linear parts of both about it has
        # the integral gradient (b - a)/h h^3/12.
        middle = slope[e] + gradient * (0.5 * (nodes[e] + nodes[e + 1]) - at[e])
        found += h * (0.5 * (a + b) * middle + gradient * h * (b - a) / 12.0)
    return found
