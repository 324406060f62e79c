"""Rows for one thickness of a cover after another, interpolated between laws at nodes, without
root finding.

Every number of the law of a cover is a polynomial of log2(h/l0) within an octave of the thickness
h, l0 being the contact length at rest of half-spaces, and of ln(3 - 4 nu) where covers differ in
Poisson's ratio nu.  It is the sum of the numbers of the laws at the nodes, each times a weight that
depends on thickness and nu alone.  The nodes are Chebyshev points, of the octave and of the range
of nu (:mod:`.laws_per_element` makes laws and weights).

The law at a node is one vector, for n rows of these parts in this order:

- head of the rows, ROW_SIZE numbers, as of every law (:mod:`.law_record`);
- rows, ROW_SIZE n numbers;
- head of what only a cover has, COVER_FRONT_SIZE numbers (:mod:`.cover_law`);
- rows of what only a cover has, COVER_ROW_SIZE n numbers.

All laws of one octave have the same n.  A part of a row has the same place in each of them, so that
one loop over numbers that follow each other interpolates it.  Laws of different octaves may differ
in n.

:func:`select_cover` interpolates the head of the rows, and all that only a cover has, when another
cover is selected; :func:`make_part` interpolates a part of a row when it is first read.  Marks,
parts of a row and versions are those of :mod:`.law_record`.

All quantities are dimensionless (docs/symbols.md); an argument of which no shape is stated is a
number.
"""

from ..numerics.intrinsics import floats_at, integers_at, record_at, record_type
from ..numerics.jit import inline_kernel, kernel
from .cover_law import COVER_FRONT_SIZE, COVER_ROW_SIZE
from .law_record import (
    H_OVER_F2,
    MAKER_MARKS,
    MAKER_NUMBERS,
    PART_SIZE,
    PARTS_PER_ROW,
    ROW_COUNT,
    ROW_SIZE,
    SELECTED,
    VERSION,
    select_index,
)

#: What these kernels read.  The first three and ``cover_index``, ``weights`` and ``octaves`` are
#: addresses of arrays.
#:
#: - rows, marks, cover_rows: the law of the selected cover, which the kernels write.
#: - cover_index: index of the cover of each state, (state_count,), integers; state_count is 1 if
#:   all states have one cover.
#: - weights: for each cover the weights of the laws at the nodes, (cover_count, law_count).
#: - octaves: for each cover the address of the laws of its octave and their number of rows,
#:   (cover_count, 2), integers.
#: - cover_count: number of covers.
#: - law_count: number of laws of an octave, which follow each other in memory: all thicknesses of
#:   one Poisson's ratio, then of the next.
SOURCE = record_type(
    "rows marks cover_rows cover_index state_count weights octaves cover_count law_count"
)
#: Mark that is the address of the laws of the selected octave.
_LAWS = MAKER_MARKS


@inline_kernel
def _interpolate(source, marks, first, out):
    """Write numbers of the law of the selected cover, interpolated between the laws at the nodes of
    its thickness.

    Each number is the sum of those of the laws at the nodes, times weights whose sum is 1 (some may
    be negative).

    source : SOURCE record, with the weights of the nodes for each cover.
    marks : ``marks`` of the law, with the selected cover, its number of rows, and the address of
        the laws at the nodes of its octave.
    first : int, index of the first number in each of the laws at the nodes (head, rows, then cover
    rows).
    out : vector of neighbouring numbers of the rows or cover rows of the law, which are
        overwritten.  Returns nothing.
    """
    # Numbers of the law at one node: head and rows, then the head and the rows of a cover.
    law_size = (
        (marks[ROW_COUNT] + 1) * ROW_SIZE + COVER_FRONT_SIZE + COVER_ROW_SIZE * marks[ROW_COUNT]
    )
    # addresses count bytes, 8 for a double
    weights = floats_at(source.weights + 8 * source.law_count * marks[SELECTED], source.law_count)
    for k in range(out.size):
        out[k] = 0.0
    # node by node, each in the order of memory
    for j in range(source.law_count):
        law = floats_at(marks[_LAWS] + 8 * (j * law_size + first), out.size)
        weight = weights[j]
        for k in range(out.size):
            out[k] += weight * law[k]


@kernel(allocates=True)
def select_cover(n, source):
    """Make the cover of a state the selected one: interpolate the head of its rows, and its cover
    rows.

    n : int, index of the state, >= 0, of those for which the law was made; not checked.
    source : pointer to a SOURCE record.  If that cover is selected already, nothing is written.
        Else the first eight numbers of the head of rows (:data:`.law_record.ALPHA` to those of
        :data:`.law_record.FAST_CYLINDER`) and all cover rows are written, and in the head of marks
        the index of the cover, a new version, the number of rows and the address of the laws of its
        octave.

    Rows of the law are then interpolated when they are first read (:func:`make_part`).  Returns
    nothing.
    """
    source = record_at(source)
    marks = integers_at(source.marks, PARTS_PER_ROW)
    index = select_index(n, source.cover_index, source.state_count, marks)
    if index >= 0:  # Another cover than before, whose data are to be written.
        octaves = integers_at(source.octaves, 2 * source.cover_count)
        marks[_LAWS] = octaves[2 * index]
        count = octaves[2 * index + 1]
        marks[ROW_COUNT] = count  # before the interpolation, which reads it
        # the head of the rows, up to what belongs to the makers, and then the cover rows, which
        # follow the head and all rows in the law of a node
        _interpolate(source, marks, 0, floats_at(source.rows, MAKER_NUMBERS))
        cover_rows = floats_at(source.cover_rows, COVER_FRONT_SIZE + COVER_ROW_SIZE * count)
        _interpolate(source, marks, (count + 1) * ROW_SIZE, cover_rows)


@kernel(allocates=True)
def make_part(number, source):
    """Make a part of a row of the selected cover, by interpolation, and write it into the rows of
    the law.

    number : int, index of the part among the marks: (row + 1) PARTS_PER_ROW + offset of the part in
    the row/PART_SIZE.
    source : pointer to a SOURCE record.  The 24 coefficients of a function, or 48 of a pair (L with
        M/V, lam with epsilon, moments of the bodies), are written, and as mark ``number`` the
        version of the cover.

    Returns nothing.
    """
    source = record_at(source)
    marks = integers_at(source.marks, number + 1)
    start = PART_SIZE * number
    count = (
        2 * PART_SIZE if start % ROW_SIZE < H_OVER_F2 else PART_SIZE
    )  # of a pair of functions, or of one
    _interpolate(source, marks, start, floats_at(source.rows + 8 * start, count))
    marks[number] = marks[VERSION]
