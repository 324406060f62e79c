"""The law of one relaxation time for all alpha: Chebyshev polynomials of ln alpha, one an octave of alpha."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ...core.array_types import Floats
from ...core.checks import check_number
from ...core.errors import ParameterError
from ..prony import lock_array
from ..prony_forms import HIGHEST_ALPHA
from .pack import from_axis, to_axis
from .table import LawTable, law_table, make_table

#: Chebyshev terms of an octave of alpha; 16 leave an error of rounding (tests/tables/test_law_axis.py)
TERMS_OF_ALPHA = 16
#: octaves of alpha from 1 to the highest alpha
OCTAVES = math.frexp(HIGHEST_ALPHA)[1]


@dataclass(frozen=True, eq=False)
class LawAxis:
    """The law of one relaxation time, with unit of time T_epsilon, for all alpha of some octaves; arrays are read only.

    alpha is the instantaneous divided by the long-time modulus, dimensionless.

    Attributes
    ----------
    coefficients : (octaves of alpha, 16 terms, rows, 24 powers, 6 functions), the functions as
        :data:`.pack.AXIS_FUNCTIONS`, of which epsilon, M/V and N are divided by (alpha - 1)/alpha.  For alpha in [2^n,
        2^(n+1)) a row is the sum of its terms times T_j(2 log2(alpha/2^n) - 1).  All octaves have equal numbers of
        rows: those beyond the last of an octave, in the fast limit, are zero.
    rows : number of rows of each octave of alpha.
    first : log2 of the lowest alpha.
    e0 : exponent of the end of the first row.
    """

    coefficients: Floats
    rows: tuple[int, ...]
    first: int
    e0: int

    @property
    def alpha(self) -> tuple[float, float]:
        """Lowest and highest alpha."""
        return 2.0**self.first, 2.0 ** (self.first + len(self.rows))

    def at(self, alpha: float) -> LawTable:
        """Return the law of one ``alpha``, with T_epsilon for the unit of time.

        alpha: instantaneous divided by long-time modulus, dimensionless, from the lowest to the highest alpha of the
            axis (:attr:`alpha`), both included.
        Returns the :class:`LawTable`, whose rows are interpolated in ln alpha to rounding; of 1 that of elastic bodies,
        a single row of constants.

        Raises
        ------
        ParameterError
            An alpha outside the axis, or no finite number.
        """
        low, high = self.alpha
        alpha = check_number("alpha", alpha, low=low, high=high)
        if alpha == 1.0:
            return law_table(1.0)
        n = min(math.frexp(alpha)[1] - 1 - self.first, len(self.rows) - 1)
        s = 2.0 * (math.log2(alpha / 2.0 ** (n + self.first))) - 1.0
        columns = np.asarray(np.polynomial.chebyshev.chebval(s, self.coefficients[n, :, : self.rows[n]]))
        return make_table(alpha, from_axis(columns, (alpha - 1.0) / alpha))


def law_axis(low: float, high: float) -> LawAxis:
    """Compute the law of one relaxation time for all alpha of the octaves in which two values lie.

    low, high: alpha, dimensionless, 1 <= low < high <= 1e12.
    Returns the :class:`LawAxis`, from the octave [2^n, 2^(n+1)) of ``low`` to that which ends at or above ``high``: its
    range includes both values and is mostly wider.

    Raises
    ------
    ParameterError
        Values outside this range, or low >= high.
    """
    low, high = (check_number("alpha", value, low=1.0, high=HIGHEST_ALPHA) for value in (low, high))
    if not low < high:
        raise ParameterError("alpha", f"{low:g} to {high:g}", "two numbers, the lower one first")
    octaves = range(math.frexp(low)[1] - 1, math.ceil(math.log2(high)))
    pieces = []
    for octave in octaves:
        tables = tables_of_octave(octave)
        c = np.array([table.T_mean for table in tables])[:, None, None, None]
        pieces.append(alpha_terms(to_axis(np.array([table.coefficients for table in tables]), c)))
    rows = tuple(piece.shape[1] for piece in pieces)
    coefficients = np.zeros((len(rows), TERMS_OF_ALPHA, max(rows), *pieces[0].shape[2:]))
    for padded, piece in zip(coefficients, pieces, strict=True):
        padded[:, : piece.shape[1]] = piece
    return LawAxis(lock_array(coefficients), rows, octaves[0], tables[0].e0)


def tables_of_octave(octave: int) -> list[LawTable]:
    """Return the tables at the 16 Chebyshev nodes of an octave of alpha, from which it is interpolated.

    octave: n of the octave [2^n, 2^(n+1)), from 0 to 39.
    Returns a list of :class:`.table.LawTable`, in the order of the nodes, all with equal numbers of rows.
    """
    return [make_table(alpha) for alpha in np.exp2(octave + 0.5 + 0.5 * _nodes()[0]).tolist()]


def alpha_terms(values: Floats) -> Floats:
    """Return the Chebyshev terms of functions of alpha, by :func:`numpy.einsum`.

    values: values of the functions at the nodes of an octave, (16, ...).
    Returns the coefficients of T_0 to T_15 in s = 2 log2(alpha/2^n) - 1, in the same shape.
    """
    return np.einsum("jk,k...->j...", _nodes()[1], values)


@lru_cache(maxsize=1)
def _nodes() -> tuple[Floats, Floats]:
    """Return the nodes of an octave in [-1, 1], (16,), and the matrix from values there to terms, (16, 16)."""
    from ...kernels.numerics.interpolation import chebyshev, to_chebyshev, to_doubles

    return to_doubles(chebyshev(TERMS_OF_ALPHA)), to_chebyshev(TERMS_OF_ALPHA)
