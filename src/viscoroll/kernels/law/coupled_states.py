"""States of one row, that is at one speed, of a contact in which pressure and shear are solved
together: contact length of the load, zones of stick and slip, powers.

The equations are those of docs/theory_covers.md, Pressure and shear together.  Units as in
:mod:`.contact_elements`: lengths are divided by l0, slopes and creep by l0/R.  Letters:

- kappa = R/l0, mu the coefficient of friction, delta the creepage.
- x: position, the distance ahead of the middle of the contact.  c: half length of the contact, lam
  = 2 c.  g: distance of its middle ahead of the axis, epsilon = g/c.
- p, q: pressure, and shear on the cylinder along V.  The load int p is pi/8, as p = sqrt(c^2 - x^2)
  of an elastic half-space has int p = pi c^2/2, and c = 1/2 at rest.
- d = kappa delta.  u': strain of the surface; d - u' is the slip divided by V.
- M: rolling moment divided by P R, kappa M = g + int x p/int p.  Q: traction, int q/(mu int p) is
  Q/(mu P).
- The rear edge is at x = -c, where nodes begin.  The parameter t of the mesh is 0 there and 1 at
  the front edge.
- Edge of a zone: boundary between two neighbouring zones, of stick, of slip of one sign or of slip
  of the other sign.  The mesh is refined there (``spots``).
"""

import math
from typing import Any, NamedTuple

import numpy as np

from ..numerics.jit import inline_kernel, kernel
from .contact_elements import (
    Contact,
    assemble,
    make_mesh,
    moments,
    node_value,
    product,
)
from .contact_zones import (
    eliminate,
    find_zones,
    pressure_and_strain,
    solve_zones,
    strain_by_shear,
)

#: load in units of the elements
LOAD = math.pi / 8.0
#: columns of a state: lam, epsilon, Q/(mu P), kappa M, 2 kappa times the work of the strain, kappa
#: M and work of the cylinder alone, beta, status, half length
COLUMNS = 10
#: status of a state: solved (0); the zones were not found (1); negative pressure (2); the load was
#: not reached (3); singular matrix (4)
SOLVED, NO_ZONES, TENSION, NO_LOAD, SINGULAR = range(5)
#: largest distance, in the parameter of the mesh times the number of elements, of an edge of a zone
#: from the refinement that was made for it; beyond it a new mesh is made
OFF_SPOT = 0.25
#: number of new meshes after the first one, for one load; then the last mesh is kept
_MOST_CENTRINGS = 6
#: largest number of half lengths that are tried for one load
_MOST_LENGTHS = 20
#: largest relative error of the load; lam is then corrected for this error to first order
_LOAD_ERROR = 5e-6
#: largest relative error of the load where only zones are needed
_ROUGH_LOAD = 1e-3
#: change of ln(c) above which the slope is that of a secant: a new mesh alone changes ln(c) less
_LEAST_CHANGE = 1e-3
#: bounds of d ln(load)/d ln(half length)
_LEAST_SLOPE = 0.7
_LARGEST_SLOPE = 5.0
#: largest number of refinements of a mesh
MOST_SPOTS = 8
#: refinement at an edge of a zone: its width in the parameter of the mesh, times the number of
#: elements; and its weight, elements in a factor of e of the distance from the edge
WIDTH_OF_SPOT = 0.1
WEIGHT_OF_SPOT = 1.0
#: elements in a factor of e of the distance from the front edge, down to the edge layer
WEIGHT_OF_LAYER = 3.0
#: integral of negative pressure, divided by the load, that counts as tension
_TENSION = 1e-6
#: bisections of the creep at which slip of the other sign opens: to 5e-4 of the distance between
#: both onsets of full slip
_BISECTIONS = 11
#: largest factor by which the change between two states is extrapolated to the next one
_LARGEST_STEP = 2.0


class Row(NamedTuple):
    """Kernels of both bodies at one speed, dimensionless.

    both, own : kernels (table, instant, local) of :func:`.contact_elements.assemble`, summed over
        the bodies, and of the cylinder alone.
    coupled : whether shear acts on the pressure.
    split : whether both bodies deform; else all losses are in one.
    cylinder : whether that one is the cylinder.
    layer : length of the layer at the front edge in which the material is stiff, divided by l0;
        infinite without one.
    """

    both: Any
    own: Any
    coupled: bool
    split: bool
    cylinder: bool
    layer: float


def new_contact(count: int) -> Contact:
    """Return a :class:`Contact` of ``count`` elements, of which all inner nodes stick: the
    parameters of its nodes are equidistant, all other numbers are 0.
    """
    inner = count - 1
    return Contact(
        nodes=np.zeros(count + 1),
        at=np.zeros(count),
        H=np.zeros((count, inner)),
        T=np.zeros((count, inner)),
        C=np.zeros((count, inner)),
        p=np.zeros(inner),
        q=np.zeros(inner),
        strain=np.zeros(count),
        zone=np.zeros(inner),
        place=np.linspace(0.0, 1.0, count + 1),
    )


@kernel
def find_spots(contact, spots):
    """Store where the mesh is to be refined: at each boundary between zones of stick and slip, or
    between zones of opposite slip.

    The boundary is put at the node that slips; if both slip, in opposite directions, at the rear
    one.

    contact : :class:`Contact`, of which ``zone`` and ``place``, the parameters of the nodes, are
        read.
    spots : (MOST_SPOTS, 3), written, one row for each boundary, from the rear edge of the contact
        to the front edge: parameter t of the mesh, in [0, 1]; width in units of t; weight, the
        number of elements in a factor of e of the distance from the boundary
        (:func:`.contact_elements.make_mesh`).  Boundaries beyond the number of rows are left out.
    Returns the number of boundaries that are stored, an int.
    """
    zone = contact.zone
    place = contact.place
    used = 0
    # place[i + 1] and place[i + 2] are the parameters of the inner nodes i and i + 1
    for i in range(zone.size - 1):
        if zone[i] != zone[i + 1] and used < spots.shape[0]:
            # the node that slips: node i if it does, else node i + 1
            spots[used, 0] = place[i + 1] if zone[i] != 0.0 else place[i + 2]
            # in the parameter: an element of a mesh of N = zone.size + 1 equal ones has 1/N
            spots[used, 1] = WIDTH_OF_SPOT / (zone.size + 1)
            spots[used, 2] = WEIGHT_OF_SPOT
            used += 1
    return used


@kernel(allocates=True)
def gather(row, contact, c, spots):
    """Make the mesh of a contact, which is refined at the edges of its zones and at the layer at
    the front edge.

    row : :class:`Row`, of which ``layer`` is read.
    contact : :class:`Contact`, whose mesh (``nodes``, ``at``, ``place``) is written, and whose
        zones are carried to the new mesh: each node gets the zone of the nearest node of the last
        mesh.  On entry ``place`` and ``zone`` are those of the last mesh.
    c : float, half length divided by l0, > 0.
    spots : (MOST_SPOTS, 3), written as by :func:`find_spots`: the edges of the zones first, then
        the layer if it is thinner than an element and a row is left.
    Returns the number of edges of zones that are stored, an int.
    """
    count = contact.at.size
    edges = find_spots(contact, spots)
    used = edges
    # Width of the layer in the parameter t: as x = -c + 2 c sin^2(pi t/2), a point near t = 1 is
    # c pi^2 (1 - t)^2/2 behind the front edge.
    thin = math.sqrt(2.0 * row.layer / c) / math.pi
    if thin * count < 1.0 and used < MOST_SPOTS:
        spots[used, 0] = 1.0
        spots[used, 1] = thin
        spots[used, 2] = WEIGHT_OF_LAYER
        used += 1
    zone = contact.zone.copy()  # of the old mesh, since both are overwritten
    place = contact.place.copy()
    make_mesh(c, spots, used, contact)
    i = 0  # inner node of the old mesh that is nearest to node k of the new one; it grows with k
    for k in range(zone.size):
        t = contact.place[k + 1]
        while i + 1 < zone.size and abs(place[i + 2] - t) <= abs(place[i + 1] - t):
            i += 1
        contact.zone[k] = zone[i]
    return edges


@kernel(allocates=True)
def solve_contact(row, contact, c, mu, d, spots, again):
    """Solve for pressure, shear and zones of stick and slip of one contact of given length.

    row : :class:`Row`, kernels of both bodies at one speed.
    contact : :class:`Contact`, mesh, matrices and tractions, written; its zones are a first guess.
    c : float, half length of the contact divided by l0, > 0.
    mu : float, coefficient of friction, > 0.
    d : float, kappa times the creepage delta, of either sign; infinite, of any sign: full slip in
        the zones of ``contact``.
    spots : (MOST_SPOTS, 3), refinements of the mesh as :func:`gather` stores them: scratch, written
        unless ``again``.
    again : bool, whether the mesh of the previous call is kept and scaled to c.
    Returns three values: the status, an int, SOLVED, NO_ZONES or SINGULAR; the distance g of the
    middle of the contact ahead of the axis, a float, divided by l0; a bool, whether the edges of
    the zones lie within OFF_SPOT elements of the refinements that were made for them, True in full
    slip and without meaning where ``again``.
    """
    count = contact.at.size
    edges = 0  # number of edges at which the mesh is refined; 0 where the mesh is kept
    if again:
        # to the half length c about the middle of the contact, x = 0; parameters of nodes stay
        factor = 2.0 * c / (contact.nodes[count] - contact.nodes[0])
        for n in range(count):
            contact.nodes[n] *= factor
            contact.at[n] *= factor
        contact.nodes[count] *= factor
    else:
        edges = gather(row, contact, c, spots)
    assemble(row.both, contact)
    good, B = eliminate(contact, row.coupled)
    if not good:
        return SINGULAR, 0.0, True
    S = strain_by_shear(contact, B, row.coupled)
    if math.isinf(d):  # Full slip: the zones are given, and no node sticks, so that d is not read.
        if not solve_zones(S, B, mu, 0.0, contact):
            return SINGULAR, 0.0, True
        return SOLVED, pressure_and_strain(S, B, contact), True
    good, g = find_zones(S, B, mu, d, contact)
    # Edges of the zones of the solution.  With a mesh that is kept (edges = 0) ``centred`` has no
    # meaning, and find_length does not need it.
    found = np.empty((MOST_SPOTS, 3))
    centred = find_spots(contact, found) == edges
    for k in range(edges):
        centred = centred and abs(found[k, 0] - spots[k, 0]) * count < OFF_SPOT
    return SOLVED if good else NO_ZONES, g, centred


@inline_kernel
def _of_matrix(matrix, e, values):
    """Return the scalar product of row e of a matrix (rows, n) and a vector ``values`` (n,)."""
    found = 0.0
    for j in range(values.size):
        found += matrix[e, j] * values[j]
    return found


@kernel(allocates=True)
def write_state(contact, c, g, mu, d, status, out):
    """Write the quantities of a solved state, except moment and work of the cylinder alone.

    contact : solved :class:`Contact`.
    c, g : floats, half length, and distance of the middle ahead of the axis, divided by l0.
    mu, d : floats, coefficient of friction; kappa times the creepage delta, infinite in full slip.
    status : int, status of the solution; a solution with tension becomes TENSION.
    out : (COLUMNS,), written but for columns 5 and 6: 0, lam; 1, epsilon; 2, Q/(mu P); 3, kappa M;
        4, 2 kappa times the work of the strain; 7, beta; 8, status; 9, half length.  lam = 2 c
        belongs to the load of the elements, not yet to LOAD.
    Returns the load of the elements, the integral of p, a float.
    """
    total, moment = moments(contact.nodes, contact.p)
    traction, _ = moments(contact.nodes, contact.q)
    out[0] = 2.0 * c
    out[1] = g / c
    out[2] = traction / (mu * total)
    out[3] = g + moment / total
    nodes = contact.nodes
    work = 0.0  # int q (d - u') over the elements that slip, the slip loss divided by V
    stick = 0.0  # length of the others
    # Element e, ahead of inner node e - 1, has the zone of that node; the rearmost element that of
    # inner node 0.
    for e in range(contact.at.size):
        length = nodes[e + 1] - nodes[e]
        if contact.zone[e - 1 if e > 0 else 0] == 0.0:
            stick += length
        else:
            a = node_value(contact.q, e)
            b = node_value(contact.q, e + 1)
            work += 0.5 * length * (a + b) * (d - contact.strain[e])
    # In full slip d is not known here: q u' is integrated as it is, by the linear strain.
    if math.isinf(d):
        out[4] = 2.0 * product(contact, contact.q, contact.strain) / total
    else:
        # int q u' = d int q - int q (d - u'), of which the last vanishes where the contact sticks.
        out[4] = 2.0 * (d * traction - work) / total
    out[7] = stick / (nodes[contact.at.size] - nodes[0])
    # The integral of negative pressure: that of inner node i counts for half of the two elements
    # beside it, which lie between the nodes i and i + 2 of the mesh.
    if status == SOLVED:
        negative = 0.0
        for i in range(contact.p.size):
            negative -= min(contact.p[i], 0.0) * 0.5 * (nodes[i + 2] - nodes[i])
        if negative > _TENSION * total:
            status = TENSION
    out[8] = status
    out[9] = c
    return total


@kernel(allocates=True)
def find_length(row, contact, c, slope, mu, d, tolerance, out):
    """Find the half length at which the contact carries the load, by the secant method in
    logarithms.

    The mesh of each length is refined at the edges of the zones of the previous length.

    row : :class:`Row`, kernels of both bodies at one speed.
    contact : :class:`Contact`, written; its zones are the first guess.
    c, slope : floats, first guesses of the half length, divided by l0, > 0, and of d ln(load)/d
        ln(c), > 0.
    mu, d : floats, coefficient of friction, > 0; kappa times the creepage delta, infinite in full
        slip.
    tolerance : float, largest relative error of the load.
    out : (COLUMNS,), the state, written but for columns 5 and 6, with a status other than SOLVED if
        no solution was found.
    Returns (half length divided by l0, d ln(load)/d ln(c)), floats.
    """
    spots = np.empty((MOST_SPOTS, 3))
    y = math.log(c)
    last = 0.0  # error of the previous length
    before = 0.0  # y of the previous length
    error = 1.0  # ln(load/LOAD)
    for n in range(_MOST_LENGTHS):
        c = math.exp(y)
        # after some meshes the last one is kept, since it might change with each length for ever
        status, g, centred = solve_contact(row, contact, c, mu, d, spots, n > _MOST_CENTRINGS)
        total = write_state(contact, c, g, mu, d, status, out)
        if status == SINGULAR:
            return c, slope
        # A load of 0 or below counts as too small by the factor e, so that the contact grows.
        error = math.log(total / LOAD) if total > 0.0 else -1.0
        # the slope of the secant, within bounds; if the two lengths are too close, the last slope
        if n > 0 and abs(y - before) > _LEAST_CHANGE:
            slope = min(max((error - last) / (y - before), _LEAST_SLOPE), _LARGEST_SLOPE)
        if abs(error) < tolerance and (centred or n >= _MOST_CENTRINGS):
            break
        last = error
        before = y
        y -= error / slope
    if not abs(error) < tolerance and out[8] == SOLVED:
        out[8] = NO_LOAD
    c *= math.exp(-error / slope)  # to first order, to the load LOAD
    out[0] = 2.0 * c  # the other columns are ratios, which are not corrected
    out[9] = c
    return c, slope


@kernel(allocates=True)
def finish_state(row, contact, out):
    """Write moment and work of the cylinder alone into a state.

    row : :class:`Row`, of which ``split`` and ``cylinder`` are read, and where both bodies deform
        the kernels of the cylinder.
    contact : the solved :class:`Contact` of the state; where both bodies deform its matrices are
        overwritten by those of the cylinder, which do not belong to its tractions.
    out : (COLUMNS,), the state of :func:`write_state`, of which columns 5 and 6 are written: kappa
        M and 2 kappa times the work of the strain, of the cylinder.
    Returns nothing.
    """
    # kappa M of the cylinder alone, and 2 kappa times the work of its strain, per load; where only
    # one body deforms they are equal to columns 3 and 4, or 0
    if not row.split:
        out[5] = out[3] if row.cylinder else 0.0
        out[6] = out[4] if row.cylinder else 0.0
        return
    assemble(row.own, contact)
    slope = np.empty(contact.at.size)
    strain = np.empty(contact.at.size)
    # H p + C q and T q - C p, as in contact_elements, of the part that the cylinder has in both;
    # with p and q they give its moment and the work of its strain (docs/theory_covers.md, Powers)
    for e in range(contact.at.size):
        slope[e] = _of_matrix(contact.H, e, contact.p) + _of_matrix(contact.C, e, contact.q)
        strain[e] = _of_matrix(contact.T, e, contact.q) - _of_matrix(contact.C, e, contact.p)
    total, _ = moments(contact.nodes, contact.p)
    out[5] = product(contact, contact.p, slope) / total
    out[6] = 2.0 * product(contact, contact.q, strain) / total


@kernel(allocates=True)
def full_slip(row, mu, sign, contact, c, out):
    """Solve full slip of one sign, and find the creepage at which it begins.

    The onset is the largest strain of that sign.  At both edges the strain is extrapolated from
    three elements: as a polynomial of the parameter of the mesh with coupling, where the strain
    varies like the root of the distance, else of the square of the parameter.

    row : :class:`Row`, kernels of both bodies at one speed.
    mu : float, coefficient of friction, > 0.
    sign : float, 1.0 or -1.0, sign of the slip.
    contact : :class:`Contact` of at least 3 elements, written.
    c : float, guess of the half length divided by l0, > 0.
    out : (COLUMNS,), the state, written, all columns.
    Returns (kappa times the creepage of the onset; d ln(load)/d ln(c)), floats.
    """
    count = contact.at.size
    contact.zone[:] = sign
    # 2.0: the load of an elastic half-space grows as c^2
    _, slope = find_length(row, contact, c, 2.0, mu, np.inf, _LOAD_ERROR, out)
    # slip d - u' of the sign everywhere means sign d >= sign u' everywhere
    best = -np.inf
    for e in range(count):
        best = max(best, sign * contact.strain[e])
    # The collocation points are at 0.5, 1.5 and 2.5 elements of the parameter from an edge of the
    # contact; the parabola through the three strains in that coordinate, or in its square, is
    # evaluated at 0 by Lagrange's formula.
    power = 1.0 if row.coupled else 2.0
    x0 = 0.5**power
    x1 = 1.5**power
    x2 = 2.5**power
    for end in range(2):
        f0 = contact.strain[count - 1 if end else 0]
        f1 = contact.strain[count - 2 if end else 1]
        f2 = contact.strain[count - 3 if end else 2]
        value = f0 * x1 * x2 / ((x0 - x1) * (x0 - x2)) + f1 * x0 * x2 / ((x1 - x0) * (x1 - x2))
        value += f2 * x0 * x1 / ((x2 - x0) * (x2 - x1))
        best = max(best, sign * value)
    finish_state(row, contact, out)
    return sign * best, slope


@kernel(allocates=True)
def move_edges(place, last, before, count, ahead):
    """Move the parameters of the nodes of a mesh along with the edges of zones, which are
    extrapolated from two states.

    place : parameters of the nodes, (N + 1,), ascending from 0 to 1; changed, unless edges would
        meet.  The nodes themselves are not moved: :func:`gather` reads their parameters, at which
        it carries zones and edges to the next mesh.
    last, before : edges of the last state and of the one before it, in column 0, (MOST_SPOTS, 3).
    count : int, number of edges of both, >= 0.
    ahead : float, step to the next state divided by the step between the two, > 0.
    Returns nothing.
    """
    # Parameters of both ends and of the edges, before and after; those of nodes are interpolated.
    old = np.zeros(count + 2)
    new = np.zeros(count + 2)
    old[count + 1] = new[count + 1] = 1.0
    for k in range(count):
        old[k + 1] = last[k, 0]
        new[k + 1] = last[k, 0] + ahead * (last[k, 0] - before[k, 0])
    if (np.diff(new) > 0.0).all():
        place[:] = np.interp(place, old, new)


@kernel(allocates=True)
def states_loop(row, mu, creeps, at, contact, c, slope, apart, out):
    """Solve states between the onsets of full slip, in their order.

    The first guess of each state, zones and length, is extrapolated from the two before it.

    row : :class:`Row`, kernels of both bodies at one speed.
    mu : float, coefficient of friction, > 0.
    creeps : kappa times the creepage delta of each state, finite, (n,); neighbours should be close.
    at : coordinate of the states in which they change smoothly, strictly ascending, (n,).
    contact : :class:`Contact`, written: its zones are the first guess, in the end it has nodes,
        pressure and traction of the last state.
    c, slope : floats, guesses of the first half length, divided by l0, and of d ln(load)/d ln(c),
        > 0.
    apart : bool, whether each state starts from stick and the guess c instead; the parameters of
        the nodes are then those of the state before, without effect, since all nodes stick.
    out : (n, COLUMNS), written, all columns.
    Returns nothing.
    """
    edges = np.zeros((2, MOST_SPOTS, 3))  # edges of the states with even and with odd numbers
    found = np.zeros(2, np.int64)  # their numbers
    guess = c
    steepness = slope
    for n in range(creeps.size):
        if apart:
            contact.zone[:] = 0.0
            guess = c
            steepness = slope
        length, steepness = find_length(
            row, contact, guess, steepness, mu, creeps[n], _LOAD_ERROR, out[n]
        )
        finish_state(row, contact, out[n])
        guess = length
        this = n % 2
        found[this] = find_spots(contact, edges[this])
        if 0 < n < creeps.size - 1:
            # linear in ``at``: ln of the half length (column 9), and the edges if both states have
            # the same number of them
            ahead = min((at[n + 1] - at[n]) / (at[n] - at[n - 1]), _LARGEST_STEP)
            guess *= (length / out[n - 1, 9]) ** ahead
            if found[0] == found[1]:
                move_edges(contact.place, edges[this], edges[1 - this], found[0], ahead)


@kernel(allocates=True)
def rear_slip(row, contact, c, slope, mu, d, out):
    """Solve a state roughly, and return the directions of slip in the rear half of the contact.

    row : :class:`Row`, kernels of both bodies at one speed.
    contact : :class:`Contact`, written; its zones are the first guess.
    c, slope : floats, guesses of the half length, divided by l0, and of d ln(load)/d ln(c), > 0.
    mu, d : floats, coefficient of friction, > 0, and kappa times the creepage delta, finite.
    out : (COLUMNS,), scratch, written.
    Returns (whether a node there slips with sign +, a bool; with sign -; zone of the rear inner
    node, 1.0, -1.0 or 0.0 in stick; half length divided by l0).
    """
    c, _ = find_length(row, contact, c, slope, mu, d, _ROUGH_LOAD, out)
    plus = False
    minus = False
    for i in range(contact.zone.size // 2):  # inner nodes of the rear half
        plus = plus or contact.zone[i] > 0.0
        minus = minus or contact.zone[i] < 0.0
    return plus, minus, contact.zone[0], c


@kernel(allocates=True)
def touch_creep(row, mu, low, high, contact, c, slope):
    """Return kappa times the creepage at which the slip in the rear half changes its sign.

    Below it the rear half slips with sign -, above it with sign +.  If zones of both signs exist in
    an interval of creepages, it is the lower end of the interval if the rear edge slips with sign -
    there, else the upper end.  It is found by bisection on the zones.

    row : :class:`Row`, kernels of both bodies at one speed.
    mu : float, coefficient of friction, > 0.
    low, high : floats, kappa times the creepages of both onsets of full slip, ``low`` < ``high``.
    contact : :class:`Contact`, written; its zones are the first guess.
    c, slope : floats, guesses of the half length, divided by l0, and of d ln(load)/d ln(c), > 0.
    Returns a float between ``low`` and ``high``.
    """
    out = np.zeros(COLUMNS)
    a = low
    b = high
    # first the creepage at which slip of sign + opens; then, if it is needed, the creepage at which
    # slip of sign - ends
    for ends in range(2):
        for _ in range(_BISECTIONS):
            middle = 0.5 * (a + b)
            plus, minus, _, c = rear_slip(row, contact, c, slope, mu, middle, out)
            above = plus if ends == 0 else not minus
            if above:
                b = middle
            else:
                a = middle
        a = 0.5 * (a + b)
        if ends == 0:
            # above it by a few times the error of the bisection: whether slip of sign - remains
            beyond = b + 2e-3 * (high - low)
            _, minus, edge, c = rear_slip(row, contact, c, slope, mu, beyond, out)
            if not minus or edge < 0.0:
                break
            b = high  # Both signs exist, with + at the rear edge.
    return a
