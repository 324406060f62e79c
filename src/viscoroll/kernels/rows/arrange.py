"""The rows that readers take, from a table as files hold it: functions side by side, and L = lam (1 + epsilon)."""

from __future__ import annotations

import numpy as np

from ..compile.jit import kernel
from . import lanes
from .build import EPSILON, LAM, M_CYLINDER, M_HALF_SPACE, PRESS_OF_F, SHARE_OF_F
from .fit import fit_slopes, node
from .lanes import TERMS
from .law import BODIES, LENGTHS, PRESS, SHARE, SPEED, WIDTH


@kernel
def _put_pair(start, which, powers, rows):
    """One function of a pair, ``which`` = 0 or 1."""
    for n in range(TERMS):
        rows[start + 4 * (n // 2) + 2 * which + n % 2] = powers[n]


@kernel
def _length(row, lam, epsilon, fitted, scratch):
    """Powers of L."""
    values, slopes = np.empty(TERMS), np.empty(TERMS)
    for k in range(TERMS):
        one, d_one = lanes.one_slopes(lam, 0, node(row, k))
        shift, d_shift = lanes.one_slopes(epsilon, 0, node(row, k))
        values[k], slopes[k] = one * (1.0 + shift), d_one * (1.0 + shift) + one * d_shift
    fit_slopes(row, values, slopes, fitted, scratch)
    if row == 0:
        fitted[0] = 1.0


@kernel(allocates=True)
def arrange(table):
    """The rows of a table (rows, 24, 7), one after the other."""
    count = table.shape[0]
    rows, scratch, powers = np.zeros(count * WIDTH), np.empty(TERMS), np.empty((6, TERMS))
    for row in range(count):
        start = row * WIDTH
        for n in range(TERMS):
            powers[0, n], powers[1, n] = table[row, n, LAM], table[row, n, EPSILON]
            powers[2, n], powers[3, n] = table[row, n, M_HALF_SPACE], table[row, n, M_CYLINDER]
            powers[4, n] = powers[2, n] + powers[3, n]
            rows[start + PRESS + n], rows[start + SHARE + n] = table[row, n, PRESS_OF_F], table[row, n, SHARE_OF_F]
        _put_pair(start + LENGTHS, 0, powers[0], rows)
        _put_pair(start + LENGTHS, 1, powers[1], rows)
        _put_pair(start + BODIES, 0, powers[2], rows)
        _put_pair(start + BODIES, 1, powers[3], rows)
        _put_pair(start + SPEED, 1, powers[4], rows)
        _length(row, powers[0], powers[1], powers[5], scratch)
        _put_pair(start + SPEED, 0, powers[5], rows)
    return rows
