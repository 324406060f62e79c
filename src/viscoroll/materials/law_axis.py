"""The law of one relaxation time over alpha too: Chebyshev's polynomials of ln alpha, an octave of alpha a piece."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ..core.checks import check_number
from ..core.errors import ParameterError
from .law_table import Floats, LawTable, law_table, made
from .prony import read_only
from .prony_forms import HIGHEST_ALPHA

#: functions of an axis in their order, some of them over c = (alpha - 1)/alpha, whose limits as alpha -> 1 are finite
FUNCTIONS = ("lam", "epsilon", "m", "N", "share", "press")
_OVER_C = np.array([False, True, True, True, False, False])
#: terms over an octave of alpha; octaves of alpha
TERMS_OF_ALPHA, OCTAVES = 16, math.frexp(HIGHEST_ALPHA)[1]


@dataclass(frozen=True, eq=False)
class LawAxis:
    """The law of one relaxation time, T_epsilon, for every alpha of some octaves; arrays are read only.

    Attributes
    ----------
    coefficients : (octaves of alpha, 16 terms, rows, 24 powers, 6 functions), the functions as :data:`FUNCTIONS`.  For
        alpha in [2^n, 2^(n+1)) a row is the sum of its terms times T_j(2 log2(alpha/2^n) - 1).  As many rows in each
        octave: behind its own, in the fast limit, they are zero.
    rows : how many each octave of alpha has.
    first : log2 of the lowest alpha.
    e0 : the first row holds [0, 2^e0).
    """

    coefficients: Floats
    rows: tuple[int, ...]
    first: int
    e0: int

    @property
    def alpha(self) -> tuple[float, float]:
        """Lowest and highest."""
        return 2.0**self.first, 2.0 ** (self.first + len(self.rows))

    def at(self, alpha: float) -> LawTable:
        """The law of one alpha, with T_epsilon for the unit of time.

        Raises
        ------
        ParameterError
            An alpha beyond those of the axis.
        """
        low, high = self.alpha
        alpha = check_number("alpha", alpha, low=low, high=high)
        if alpha == 1.0:
            return law_table(1.0)
        n = min(math.frexp(alpha)[1] - 1 - self.first, len(self.rows) - 1)
        s = 2.0 * (math.log2(alpha / 2.0 ** (n + self.first))) - 1.0
        row = np.asarray(np.polynomial.chebyshev.chebval(s, self.coefficients[n, :, : self.rows[n]]))
        row[..., _OVER_C] *= (alpha - 1.0) / alpha
        row = row[..., [0, 1, 2, 2, 3, 4, 5]]  # either body takes half of m
        row[..., 2:4] *= 0.5
        return made(alpha, row)


def law_axis(low: float, high: float) -> LawAxis:
    """The axis of the octaves of alpha that these two lie in.

    Parameters
    ----------
    low, high : alpha, 1 <= low < high <= 1e12.

    Raises
    ------
    ParameterError
        Others.
    """
    low, high = (check_number("alpha", one, low=1.0, high=HIGHEST_ALPHA) for one in (low, high))
    if not low < high:
        raise ParameterError("alpha", f"{low:g} to {high:g}", "a lower and a higher one")
    octaves = range(math.frexp(low)[1] - 1, math.ceil(math.log2(high)))
    pieces = []
    for octave in octaves:
        tables = tables_of(octave)
        values = np.array([table.coefficients for table in tables])[..., [0, 1, 2, 4, 5, 6]]
        values[..., FUNCTIONS.index("m")] *= 2.0
        values[..., _OVER_C] /= np.array([table.T_mean for table in tables])[:, None, None, None]
        pieces.append(to_chebyshev(values))
    rows = tuple(piece.shape[1] for piece in pieces)
    behind = ((0, max(rows) - count) for count in rows)
    whole = read_only([np.pad(piece, ((0, 0), pad, (0, 0), (0, 0))) for piece, pad in zip(pieces, behind, strict=True)])
    return LawAxis(whole, rows, octaves[0], tables[0].e0)


def tables_of(octave: int) -> list[LawTable]:
    """Tables at the nodes of an octave of alpha, upward; they have as many rows each."""
    return [made(alpha) for alpha in np.exp2(octave + 0.5 + 0.5 * _nodes()[0]).tolist()]


def to_chebyshev(values: Floats) -> Floats:
    """Terms of an octave of alpha from values at its nodes, along the first axis."""
    return np.einsum("jk,k...->j...", _nodes()[1], values)


@lru_cache(maxsize=1)
def _nodes() -> tuple[Floats, Floats]:
    """Nodes of an octave in [-1, 1], and the matrix from values there to terms."""
    from ..kernels.numerics.interpolation import chebyshev, to_chebyshev, to_doubles

    return to_doubles(chebyshev(TERMS_OF_ALPHA)), to_chebyshev(TERMS_OF_ALPHA)
