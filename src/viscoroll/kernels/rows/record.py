"""The record of a law that every reader takes, and where its numbers stand.

Rows of one material all stand there; of one of many materials a part of a row is made where it is met.  Readers do not
know which (:mod:`evaluate`).
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ..compile.intrinsics import call_address, unlikely
from ..compile.jit import kernel
from .simd_polynomial import TERMS

#: where the functions of a row begin: pairs over u = kappa |V|, then what is over v = 1/F(eta), and how long a row is
LENGTH_MOMENT, LAM_EPSILON, BODY_MOMENTS, H_OVER_F2, ETA_OVER_F, ROW_SIZE = 0, 48, 96, 144, 168, 192
#: parts of a row, each with a mark of its own
PART_SIZE = TERMS
PARTS_PER_ROW = ROW_SIZE // PART_SIZE
#: numbers in front of the rows: instantaneous over long-time modulus and its root's inverse; of the fast limit
#: W = sum J_j/T_j and then C = sum J_j/T_j (ln 2 T_j - 0.5772...) of all and of either body; what the maker keeps
ALPHA, LAM_FAST, FAST_TOTAL, FAST_HALF_SPACE, FAST_CYLINDER, MAKER_NUMBERS = 0, 1, 2, 4, 6, 8
#: marks in front: that of the material that is held, how many rows it has, the exponent of the first; then the maker's
VERSION, ROW_COUNT, E0, MAKER_MARKS = range(4)


class Law(NamedTuple):
    """The law of a material, or of one of many at a time.

    rows : the numbers in front, as long as a row; then the rows, each (L, M/V), (lam, epsilon),
        (M_half_space/V, M_cylinder/V), H/F^2, eta/F
    marks : those in front, as many as a row has; then of every part of every row the stamp of the material that it was
        made for
    added : rows of N and of its integral (:func:`...materials.law_build.added`); none of a law of steady rolling
    free : of a cover the numbers of :mod:`cover`, and None of half-spaces, whose kernels are compiled without
    hold, make, source : addresses of the kernels (n, source) and (where a part begins, source), and of what these know
        (:mod:`..compile.intrinsics`); 0 where all rows stand
    """

    rows: Any
    marks: Any
    N_rows: Any
    selector: int
    maker: int
    source: int
    cover_rows: Any = None


@kernel(inline=True)
def select_material(law, n):
    """Have the law be that of state or motion n: nothing where all have one, or n the one that is held."""
    if law.selector != 0:
        call_address(law.selector, n, law.source)


@kernel(inline=True)
def ensure_part(part, row, law):
    """Where a part of a row begins, made if it was not."""
    start = (row + 1) * ROW_SIZE + part
    if unlikely(law.marks[np.uint64((row + 1) * PARTS_PER_ROW + part // PART_SIZE)] != law.marks[VERSION]):
        call_address(law.maker, start, law.source)
    return start
