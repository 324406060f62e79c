"""Rows of a thickness each: interpolated between the laws of covers at nodes of an octave of thickness, with no root.

Every number of a law is a polynomial of log2(h/l0) within an octave, and so the sum of those at the nodes times weights
that depend on the thickness alone.
"""

from __future__ import annotations

import numpy as np

from ..compile.intrinsics import floats_at, integers_at, record_at
from ..compile.jit import kernel
from .record import COUNT, OWN_MARKS, PART, PARTS, PRESS, STAMP, WIDTH
from .states import element

#: laws of an octave of thickness; a rubber of three modes is off by 1e-12 then
NODES = 14
#: numbers in front of the rows that are a law's
_FRONT = 8
#: what these kernels know: addresses of the record's arrays; of states or motions the cover of each, and how many; of
#: covers their weights, and the address and the number of rows of their octave
SOURCE = np.dtype(
    [(name, np.int64) for name in ("rows", "marks", "free", "of", "count", "weights", "octaves", "covers")]
)
#: marks: the cover that is held, and where the laws of its octave lie
HELD, _OCTAVE = range(OWN_MARKS, OWN_MARKS + 2)


@kernel(inline=True)
def _numbers(count):
    """(Numbers of the rows of a law, and of what a cover has beside them)."""
    return (count + 1) * WIDTH, 8 + 3 * PART * count


@kernel(inline=True)
def _add(given, marks, first, to, out, numbers):
    """Interpolate ``numbers`` numbers of the laws from ``first`` on."""
    rows, free = _numbers(marks[COUNT])
    weights = floats_at(given.weights + 8 * NODES * marks[HELD], NODES)
    for k in range(numbers):
        out[to + k] = 0.0
    for j in range(NODES):
        law, weight = floats_at(marks[_OCTAVE] + 8 * (j * (rows + free) + first), numbers), weights[j]
        for k in range(numbers):
            out[to + k] += weight * law[k]


@kernel(allocates=True)
def hold(n, source):
    """:func:`record.hold`; what a cover has beside its rows is made at once."""
    given = record_at(source)
    marks = integers_at(given.marks, PARTS)
    row = element(integers_at(given.of, given.count), n)
    if marks[HELD] != row:
        octaves = integers_at(given.octaves, 2 * given.covers)
        marks[HELD], marks[_OCTAVE], marks[COUNT] = row, octaves[2 * row], octaves[2 * row + 1]
        marks[STAMP] += 1
        rows, free = _numbers(marks[COUNT])
        _add(given, marks, 0, 0, floats_at(given.rows, _FRONT), _FRONT)
        _add(given, marks, rows, 0, floats_at(given.free, free), free)


@kernel(allocates=True)
def make(start, source):
    """A part of a row."""
    given = record_at(source)
    marks = integers_at(given.marks, start // PART + 1)
    numbers = 2 * PART if start % WIDTH < PRESS else PART  # of a pair of functions, or of one
    _add(given, marks, start, start, floats_at(given.rows, start + numbers), numbers)
    marks[start // PART] = marks[STAMP]
