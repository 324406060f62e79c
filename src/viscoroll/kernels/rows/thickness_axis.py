"""Rows of a thickness each: interpolated between the laws of covers at nodes of an octave of thickness, with no root.

Every number of a law is a polynomial of log2(h/l0) within an octave, and so the sum of those at the nodes times weights
that depend on the thickness alone.
"""

from __future__ import annotations

import numpy as np

from ..compile.intrinsics import floats_at, integers_at, record_at
from ..compile.jit import kernel
from .contact_states import element
from .record import H_OVER_F2, MAKER_MARKS, PART_SIZE, PARTS_PER_ROW, ROW_COUNT, ROW_SIZE, VERSION

#: laws of an octave of thickness; a rubber of three modes is off by 1e-12 then
NODES = 14
#: numbers in front of the rows that are a law's
_FRONT = 8
#: what these kernels know: addresses of the record's arrays; of states or motions the cover of each, and how many; of
#: covers their weights, and the address and the number of rows of their octave
SOURCE = np.dtype(
    [
        (name, np.int64)
        for name in ("rows", "marks", "cover_rows", "cover_index", "state_count", "weights", "octaves", "cover_count")
    ]
)
#: marks: the cover that is held, and where the laws of its octave lie
SELECTED, _OCTAVE = range(MAKER_MARKS, MAKER_MARKS + 2)


@kernel(inline=True)
def _numbers(count):
    """(Numbers of the rows of a law, and of what a cover has beside them)."""
    return (count + 1) * ROW_SIZE, 8 + 3 * PART_SIZE * count


@kernel(inline=True)
def _add(given, marks, first, to, out, numbers):
    """Interpolate ``numbers`` numbers of the laws from ``first`` on."""
    rows, free = _numbers(marks[ROW_COUNT])
    weights = floats_at(given.weights + 8 * NODES * marks[SELECTED], NODES)
    for k in range(numbers):
        out[to + k] = 0.0
    for j in range(NODES):
        law, weight = floats_at(marks[_OCTAVE] + 8 * (j * (rows + free) + first), numbers), weights[j]
        for k in range(numbers):
            out[to + k] += weight * law[k]


@kernel(allocates=True)
def select_cover(n, source):
    """:func:`record.hold`; what a cover has beside its rows is made at once."""
    given = record_at(source)
    marks = integers_at(given.marks, PARTS_PER_ROW)
    row = element(integers_at(given.cover_index, given.state_count), n)
    if marks[SELECTED] != row:
        octaves = integers_at(given.octaves, 2 * given.cover_count)
        marks[SELECTED], marks[_OCTAVE], marks[ROW_COUNT] = row, octaves[2 * row], octaves[2 * row + 1]
        marks[VERSION] += 1
        rows, free = _numbers(marks[ROW_COUNT])
        _add(given, marks, 0, 0, floats_at(given.rows, _FRONT), _FRONT)
        _add(given, marks, rows, 0, floats_at(given.cover_rows, free), free)


@kernel(allocates=True)
def make_part(start, source):
    """A part of a row."""
    given = record_at(source)
    marks = integers_at(given.marks, start // PART_SIZE + 1)
    numbers = 2 * PART_SIZE if start % ROW_SIZE < H_OVER_F2 else PART_SIZE  # of a pair of functions, or of one
    _add(given, marks, start, start, floats_at(given.rows, start + numbers), numbers)
    marks[start // PART_SIZE] = marks[VERSION]
