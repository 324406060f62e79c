"""The record of a law that every kernel reads, and the layout of its arrays: the one place where columns have names.

``rows`` holds one head, as long as a row, and then the rows.  A row has :data:`ROW_SIZE` numbers in
:data:`PARTS_PER_ROW` parts of :data:`PART_SIZE`; the constants from :data:`LENGTH_MOMENT` to :data:`ETA_OVER_F` are
offsets in a row.  Two functions whose powers are interleaved (:mod:`simd_polynomial`) take two neighbouring parts.

``marks`` holds one head, as long as a row has parts, and then for every part of every row the version of the material
that it was made for: the number of the selection of a material, which grows.  The rows of one material are complete.
Of many materials a part is made when it is first read; who reads it need not know which (:mod:`evaluate`).

All quantities are dimensionless (docs/symbols.md); an argument of which no shape is stated is a number.
"""

from typing import Any, NamedTuple

import numpy as np

from ..compile.intrinsics import call_address, integers_at, unlikely
from ..compile.jit import inline_kernel, kernel
from .contact_states import element
from .simd_polynomial import TERMS

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
#: Index in the head: W = sum J_j/T_j of both bodies; after it C = sum J_j/T_j (ln 2 T_j - 0.5772...).
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
#: Index in the head of ``marks``: the selected material among those of a block, -1 if there is none yet.
SELECTED = 3
#: Index in the head of ``marks``: the first of the marks that belong to the kernels that make rows.
MAKER_MARKS = 4


class Law(NamedTuple):
    """The law of one material, or of many materials of which one is selected at a time.

    rows : head and rows, (1 + number of rows) * ROW_SIZE numbers, dimensionless.
    marks : head and versions of the parts, (1 + number of rows) * PARTS_PER_ROW integers.
    N_rows : rows of N and of its integral (:func:`...materials.law.pack.pack_unsteady`), a vector; empty for steady
        rolling.
    selector : address of the kernel (n, source) that selects the material of state n; 0 if all rows are complete.
    maker : address of the kernel (number of a part, which is its index among the marks; source) that makes the part; 0
        if all rows are complete.
    source : address of the record that these two kernels read, SOURCE of their module; 0 if all rows are complete.
    cover_rows : vector of the numbers that only a cover has (:mod:`cover`); None of half-spaces, whose kernels are
        compiled without.
    table : vector of the law as a table of one scene (:mod:`..splines.table`), which is then the law; None without,
        and kernels are compiled without.
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
    """Make a law that of one state or motion: the kernel at its address ``selector`` writes heads of rows and marks.

    law : :class:`Law`, of which ``selector`` and ``source`` are read.  Nothing is done if one law serves all (selector
        0), and nothing is written if the material of ``n`` is selected already.
    n : int, index of the state or motion, >= 0, of those for which the law was made; not checked.
    Returns nothing.
    """
    if law.selector != 0:
        call_address(law.selector, n, law.source)


@inline_kernel
def ensure_part(part, row, law):
    """Return the index in ``law.rows`` of a part of a row, after making the part if it belongs to another material.

    part : int, offset in a row: LENGTH_MOMENT, LAM_EPSILON, BODY_MOMENTS, H_OVER_F2 or ETA_OVER_F.  Rows of the axis of
        alpha (:mod:`.alpha_axis`) have no BODY_MOMENTS.
    row : int, number of the row, from 0 to the last row of the law; the fast limit beyond it has no parts.
    law : :class:`Law` with its material selected; where a part is made, its ``rows`` and ``marks`` are written.
    Returns an int, the index of the first coefficient, of a pair of the first of its 48.
    """
    number = (row + 1) * PARTS_PER_ROW + part // PART_SIZE
    if unlikely(law.marks[np.uint64(number)] != law.marks[VERSION]):
        call_address(law.maker, number, law.source)
    return (row + 1) * ROW_SIZE + part


@kernel(inline=True, allocates=True)
def select_index(n, addresses, state_count, marks):
    """Mark the material of state ``n`` as selected, with the next version number if it was another one.

    n : int, index of the state, >= 0, of those for which the law was made; not checked.
    addresses : int, address of an array of 64-bit integers: the index of the material of each state.
    state_count : int, length of that array; 1 if all states have one material.
    marks : ``marks`` of the :class:`Law`, whose entries SELECTED (the index) and VERSION (one more) are written, if
        another material or none was selected.

    Returns the index of the material, an int >= 0, if the caller has to write its data; -1 if it was selected already,
    and then nothing is written.
    """
    index = element(integers_at(addresses, state_count), n)
    if marks[SELECTED] == index:
        return -1
    marks[SELECTED] = index
    marks[VERSION] += 1
    return index
