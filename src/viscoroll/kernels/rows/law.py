"""The record of a law that every reader takes, places in its rows, and its functions there and in the fast limit."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ..compile.jit import kernel
from ..compile.rarely import rarely

#: where the functions of a row begin: pairs over u = kappa |V|, then what is over v = 1/F(eta), and how long a row is
SPEED, LENGTHS, BODIES, PRESS, SHARE, WIDTH = 0, 48, 96, 144, 168, 192
#: row of a place behind the last
BEYOND = -1

_MANTISSA, _ONE, _MIDDLE = (1 << 52) - 1, 1023 << 52, 1022


class Law(NamedTuple):
    """Rows of one material or pair; a reader takes of a row what it asks for and nothing else.

    rows : one after the other, each (L, M/V), (lam, epsilon), (M_half_space/V, M_cylinder/V), H/F^2, eta/F
    count, e0 : how many, and the exponent of the first
    alpha, low, W, C : instantaneous over long-time modulus and its root's inverse; of the fast limit, sum J_j/T_j and
    sum J_j/T_j (ln 2 T_j - 0.5772...), of all and of either body
    """

    rows: Any
    count: int
    e0: int
    alpha: float
    low: float
    W: float
    C: float
    W_half_space: float
    C_half_space: float
    W_cylinder: float
    C_cylinder: float


class Place(NamedTuple):
    """Where the numbers of a row begin, or :data:`BEYOND`; argument of its polynomials, and its slope over x."""

    start: int
    t: float
    per: float


@kernel(inline=True)
def octave(x, e0):
    """(row, t, dt/dx) of x >= 0."""
    word = np.float64(x).view(np.int64)
    exponent = word >> 52
    row = exponent - _MIDDLE - e0
    if row <= 0:
        per = power_of_two(-e0)
        return 0, x * per, per
    t = 2.0 * np.int64((word & _MANTISSA) | _ONE).view(np.float64) - 3.0
    return row, t, np.int64((2047 - exponent) << 52).view(np.float64)


@kernel(inline=True)
def power_of_two(n):
    """2^n, a normal number."""
    return np.int64((1023 + n) << 52).view(np.float64)


@kernel(inline=True)
def place(x, law):
    """Where x >= 0 lies."""
    row, t, per = octave(x, law.e0)
    return Place(row * WIDTH if row < law.count else BEYOND, t, per)


@kernel(inline=True)
def beyond(at):
    """Whether a place is in the fast limit."""
    return rarely(at.start < 0)
