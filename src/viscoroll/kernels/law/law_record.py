"""Records of a law and of contact states, and the layout of their arrays: the one place where
columns have names.

A state is what the law is given; a request says which quantities are written where.

A law has two arrays.  ``rows`` holds one head, as long as a row, and then the rows.  A row has
:data:`ROW_SIZE` numbers in :data:`PARTS_PER_ROW` parts of :data:`PART_SIZE`; the constants from
:data:`LENGTH_MOMENT` to :data:`ETA_OVER_F` are offsets in a row.  Two functions whose powers are
interleaved (:mod:`.simd`) take two neighbouring parts.

``marks`` holds one head, as long as a row has parts, and then for every part of every row the
version of the material that it was made for: the number of the selection of a material, which
grows.  The rows of one material are complete.  Of many materials a part is made when it is first
read; who reads it need not know which (:mod:`.law_functions`).

All quantities are dimensionless (docs/symbols.md); an argument of which no shape is stated is a
number.
"""

from collections import namedtuple
from typing import Any, NamedTuple

import numpy as np

from ..numerics.intrinsics import call_address, integers_at, unlikely
from ..numerics.jit import inline_kernel, kernel
from ..numerics.simd import TERMS

# --- Records of contact states ---

#: The row of the output that each quantity is written to; -1 for a quantity that is not requested.
#: The names are those of the fields of ``contact``.
Fields = namedtuple(
    "Fields",
    "lam zeta epsilon delta_star delta full_slip beta grip Q M dQ_dV dQ_ddelta dQ_domega dM_dV "
    "M_half_space M_cylinder dM_half_space_dV dM_cylinder_dV delta_0 "
    "dM_ddelta dM_domega dM_half_space_domega dM_cylinder_domega "
    "reaction_half_space reaction_cylinder excess_half_space excess_cylinder "
    "delta_minus delta_plus",
    defaults=[-1] * 29,
)

#: States that pass through the stages of the evaluation together: enough that a loop over them
#: costs little for each, and few enough that their scratch stays in the first cache.
TOGETHER = 64
#: Numbers of the scratch of :func:`.contact_kernel.contact_loop`.
SCRATCH_SIZE = 21 * TOGETHER


class State(NamedTuple):
    """One state of the contact, dimensionless; or arrays of states, each of length 1 or with one
    value for each.

    kappa : R/l0, slenderness.
    mu : coefficient of friction.
    V : speed of the axis, of any sign.
    creep : creepage delta = (omega - V)/V, or angular velocity omega, of any sign.
    creep_is_omega : whether ``creep`` is omega; one bool for all states.
    """

    kappa: Any
    mu: Any
    V: Any
    creep: Any
    creep_is_omega: bool


class Request(NamedTuple):
    """States, and the quantities of them that are requested.

    states : a :class:`State` of arrays, each of length 1 or with one number for each state.
    order : numbers of the states in the order of evaluation, int; empty: in their own order.
    to : :class:`Fields`, for each quantity its row of ``out``, -1 if it is not requested.
    out : (requested quantities, columns), dimensionless, written; state n has column ``first`` + n.
    first : int, column of ``out`` for state 0.
    """

    states: Any
    order: Any
    to: Any
    out: Any
    first: int


@inline_kernel
def element(values, n):
    """Return an element of an array that has one value for all states, or one for each.

    values : array of one axis, not empty.
    n : int, index of the state, >= 0; not checked.
    Returns ``values[n]``; of an array of length 1 its only element, whatever n is.
    """
    # Index 0 of an array of length 1 by a product, True or False counting as 1 or 0, without a
    # branch; unsigned, as numba would test signed indices for negative ones.
    return values[np.uint64(n * (values.size > 1))]


@inline_kernel
def read_state(states, n):
    """Return one state of arrays of states.

    states : :class:`State` of arrays, each of length 1, for all states, or with one number for
    each.
    n : int, index of the state, >= 0; not checked.
    Returns a :class:`State` of numbers, dimensionless, with the ``creep_is_omega`` of ``states``.
    """
    return State(
        kappa=element(states.kappa, n),
        mu=element(states.mu, n),
        V=element(states.V, n),
        creep=element(states.creep, n),
        creep_is_omega=states.creep_is_omega,
    )


@inline_kernel
def write_field(row, value, n, request):
    """Write a quantity of a state into the output, if it is requested.

    row : int, row of ``request.out``: a field of the :class:`Fields` of ``request``; if it is below
        0, nothing is written.
    value : float, the quantity, dimensionless.
    n : int, index of the state; its column is n + ``request.first``.
    request : :class:`Request` of states and quantities, of whose ``out`` one number is written.
    Returns nothing.
    """
    if row >= 0:
        # unsigned: numba would test signed indices for negative ones
        request.out[np.uint64(row), np.uint64(n + request.first)] = value


@inline_kernel
def asks_for_moments(to):
    """Return whether M, the moment of a body, or how shear acts back on one is requested, a bool.

    to : :class:`Fields` of a :class:`Request`, -1 where a quantity is not requested.
    """
    # All bits of -1 are set: numbers joined by ``&`` are -1 if each of them is -1, else >= 0, as
    # rows are.
    reactions = to.reaction_half_space & to.reaction_cylinder
    excesses = to.excess_half_space & to.excess_cylinder
    return (to.M & to.M_half_space & to.M_cylinder & reactions & excesses) >= 0


@inline_kernel
def asks_for_slopes(to):
    """Return whether slopes are requested: of Q, of M, and of the moment of a body, three bools.

    to : :class:`Fields` of a :class:`Request`, -1 where a quantity is not requested.
    """
    # ``&`` as in asks_for_moments
    of_Q = to.dQ_dV & to.dQ_ddelta & to.dQ_domega
    of_M = to.dM_dV & to.dM_ddelta & to.dM_domega
    of_half_space = to.dM_half_space_dV & to.dM_half_space_domega
    of_cylinder = to.dM_cylinder_dV & to.dM_cylinder_domega
    return of_Q >= 0, of_M >= 0, (of_half_space & of_cylinder) >= 0


@inline_kernel
def slip_and_creepage(state):
    """Return the direction of slip and the creepage of a state, whichever of creepage and omega it
    has.

    state : :class:`State` of numbers, of which V, ``creep`` (delta or omega, dimensionless) and
        ``creep_is_omega`` are read.

    Returns (slip, delta), floats, dimensionless.  If omega is given, slip is omega - V; if delta is
    given, it is delta, or -delta for V < 0, which has the sign of omega - V but not its size.
    delta is the creepage (omega - V)/V.  V = 0 counts as V -> 0+: if omega is given, delta is 0 for
    omega = 0 and else infinite with the sign of omega.
    """
    V = state.V
    creep = state.creep  # delta or omega
    # omega - V = delta V has the sign of -delta for V < 0; V = 0.0 and -0.0 count as V > 0
    if not state.creep_is_omega:
        return -creep if V < 0.0 else creep, creep
    slip = creep - V
    # written out at V = 0: slip/V would be NaN for slip = 0, and would have the sign of a zero V
    return slip, slip / V if V != 0.0 else 0.0 if slip == 0.0 else np.copysign(np.inf, slip)


# --- The record of a law that every kernel reads, and the layout of its arrays ---

#: Numbers of a part: the coefficients of one polynomial.
PART_SIZE = TERMS
#: Offset of L and M/V, interleaved, over u = kappa |V|.
LENGTH_MOMENT = 0
#: Offset of lam and epsilon, interleaved, over u.
LAM_EPSILON = 48
#: Offset of M_half_space/V and M_cylinder/V, interleaved, over u.
BODY_MOMENTS = 96
#: Offset of H/F^2 over v = 1/F(eta).
H_OVER_F2 = 144
#: Offset of eta/F over v.
ETA_OVER_F = 168
#: Numbers of a row.
ROW_SIZE = 192
#: Parts of a row, each with a mark of its own.
PARTS_PER_ROW = ROW_SIZE // PART_SIZE

#: Index in the head of ``rows``: alpha, the instantaneous divided by the long-time modulus.
ALPHA = 0
#: Index in the head: lam in the fast limit, alpha^(-1/2).
LAM_FAST = 1
#: Index in the head: W = sum J_j/T_j of both bodies; after it C = sum J_j/T_j (ln 2 T_j -
#: 0.5772...).
FAST_TOTAL = 2
#: Index in the head: W and C of the half-space.
FAST_HALF_SPACE = 4
#: Index in the head: W and C of the cylinder.
FAST_CYLINDER = 6
#: Index in the head: the first of the numbers that belong to the kernels that make rows.
MAKER_NUMBERS = 8

#: Index in the head of ``marks``: the version of the selected material.
VERSION = 0
#: Index in the head of ``marks``: how many rows the selected material has.
ROW_COUNT = 1
#: Index in the head of ``marks``: exponent e0 of the first row, which spans 0 <= x < 2^e0.
E0 = 2
#: Index in the head of ``marks``: the selected material among those of a block, -1 if there is none
#: yet.
SELECTED = 3
#: Index in the head of ``marks``: the first of the marks that belong to the kernels that make rows.
MAKER_MARKS = 4


class Law(NamedTuple):
    """The law of one material, or of many materials of which one is selected at a time.

    rows : head and rows, (1 + number of rows) * ROW_SIZE numbers, dimensionless.
    marks : head and versions of the parts, (1 + number of rows) * PARTS_PER_ROW integers.
    N_rows : rows of N and of its integral (:func:`.row_layout.pack_unsteady`), a vector;
        empty for steady rolling.
    selector : address of the kernel (n, source) that selects the material of state n; 0 if all rows
        are complete.
    maker : address of the kernel (number of a part, which is its index among the marks; source)
        that makes the part; 0 if all rows are complete.
    source : address of the record that these two kernels read, SOURCE of their module; 0 if all
        rows are complete.
    cover_rows : vector of the numbers that only a cover has (:mod:`.cover_law`); None of
        half-spaces, whose kernels are compiled without.
    table : vector of the law as a table of one scene (:mod:`.coupled_splines`), which is then the
        law; None without, and kernels are compiled without.
    """

    rows: Any
    marks: Any
    N_rows: Any
    selector: int
    maker: int
    source: int
    cover_rows: Any = None
    table: Any = None


@inline_kernel
def select_material(law, n):
    """Make a law that of one state or motion: the kernel at its address ``selector`` writes heads
    of rows and marks.

    law : :class:`Law`, of which ``selector`` and ``source`` are read.  Nothing is done if one law
        serves all (selector 0), and nothing is written if the material of ``n`` is selected
        already.
    n : int, index of the state or motion, >= 0, of those for which the law was made; not checked.
    Returns nothing.
    """
    if law.selector != 0:
        call_address(law.selector, n, law.source)


@inline_kernel
def ensure_part(part, row, law):
    """Return the index in ``law.rows`` of a part of a row, after making the part if it belongs to
    another material.

    part : int, offset in a row: LENGTH_MOMENT, LAM_EPSILON, BODY_MOMENTS, H_OVER_F2 or ETA_OVER_F.
        Rows of the axis of alpha (:mod:`.alpha_axis`) have no BODY_MOMENTS.
    row : int, number of the row, from 0 to the last row of the law; the fast limit beyond it has no
        parts.
    law : :class:`Law` with its material selected; where a part is made, its ``rows`` and ``marks``
        are written.
    Returns an int, the index of the first coefficient, of a pair of the first of its 48.
    """
    # row + 1, as the head, as long as a row, is in front of row 0 in both arrays; of a pair the
    # mark of its first part alone is read, and written by the maker
    number = (row + 1) * PARTS_PER_ROW + part // PART_SIZE
    if unlikely(law.marks[np.uint64(number)] != law.marks[VERSION]):
        call_address(law.maker, number, law.source)
    return (row + 1) * ROW_SIZE + part


@kernel(inline=True, allocates=True)
def select_index(n, addresses, state_count, marks):
    """Mark the material of state ``n`` as selected, with the next version number if it was another
    one.

    n : int, index of the state, >= 0, of those for which the law was made; not checked.
    addresses : int, address of an array of 64-bit integers: the index of the material of each
        state.
    state_count : int, length of that array; 1 if all states have one material.
    marks : ``marks`` of the :class:`Law`, whose entries SELECTED (the index) and VERSION (one more)
        are written, if another material or none was selected.

    Returns the index of the material, an int >= 0, if the caller has to write its data; -1 if it
    was selected already, and then nothing is written.
    """
    index = element(integers_at(addresses, state_count), n)
    if marks[SELECTED] == index:
        return -1
    # SELECTED is -1 at first, which no index equals: the first call always selects.  A new version
    # makes all parts that were made before outdated (ensure_part), without a loop over them.
    marks[SELECTED] = index
    marks[VERSION] += 1
    return index
