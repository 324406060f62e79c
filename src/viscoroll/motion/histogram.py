"""Counts and moments of one quantity, which merge with those of further values: :class:`Histogram`.

Counts merge to the same bits in any order, moments to rounding.

A bin holds the doubles that share sign, exponent and the first eight bits after the point: 256 bins
to the octave, so each is at most 2^-8 of its value wide (of magnitudes from 2^-1022 on), with no
range to choose beforehand (as in DDSketch: C. Masson, J. Rim, H. Lee, VLDB 2019).
"""

from __future__ import annotations

from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from ..core.array_types import Floats, Integers

#: Bits of a double below those that number a bin: 52 of the fraction less the eight that are kept.
_DROPPED = 44
#: All bits of a double but its sign.
_MAGNITUDE = np.int64(2**63 - 1)


class Histogram(msgspec.Struct):
    """Counts and moments of the finite values of one quantity at one time.

    bins : numbers of the bins that hold values, ascending, (bins,).
    counts : number of the values in each bin, > 0, (bins,).
    count : number of all values.
    mean, low, high : mean, least and largest value, in the unit of the quantity; NaN without values.
    spread : sum of squares of the differences from the mean; NaN without values.
    values : all values, (count,), where quantiles are to be exact; else None.
    """

    bins: NDArray[np.int32]
    counts: Integers
    count: int = 0
    mean: float = np.nan
    spread: float = np.nan
    low: float = np.nan
    high: float = np.nan
    values: Floats | None = None

    @classmethod
    def of(cls, values: Floats, exact: bool = False) -> Histogram:
        """Make the histogram of those values that are finite.

        values: float64, (n,), in the unit of the quantity; those that are not finite are left out, and -0 counts as 0.
        exact: whether to keep the values that are finite, (count,), for exact quantiles.
        Returns the :class:`Histogram`; without finite values it has no bins, its moments are NaN, and its ``values``
        None.
        """
        kept = values[np.isfinite(values)]
        bits = (kept + 0.0).view(np.int64)  # -0 becomes 0
        # The order of numbers is that of their bins.
        numbers = ((bits ^ ((bits >> 63) & _MAGNITUDE)) >> _DROPPED).astype(np.int32)
        bins, counts = np.unique(numbers, return_counts=True)
        if not kept.size:
            return cls(bins, counts)
        mean = float(kept.mean())
        moments = mean, float(np.square(kept - mean).sum()), float(kept.min()), float(kept.max())
        return cls(bins, counts, kept.size, *moments, kept if exact else None)

    def merge(self, other: Histogram) -> Histogram:
        """Return the histogram of the values of two histograms.

        Moments after T. Chan, G. Golub, R. LeVeque (The American Statistician 37, 1983).

        other: :class:`Histogram`, the second histogram.
        Returns a new histogram, which does not keep the values, so that its quantiles are not exact.  If one of the two
        has no values the other one itself is returned, with the values that it keeps.
        """
        if not self.count or not other.count:
            return self if self.count else other
        bins = np.union1d(self.bins, other.bins)
        count, distance = self.count + other.count, other.mean - self.mean
        mean = self.mean + distance * (other.count / count)
        spread = self.spread + other.spread + distance**2 * (self.count * (other.count / count))
        extremes = min(self.low, other.low), max(self.high, other.high)
        return Histogram(bins, self.counts_in(bins) + other.counts_in(bins), count, mean, spread, *extremes)

    def counts_in(self, bins: NDArray[np.int32]) -> Integers:
        """Return the counts in other bins, so that those of two histograms can be added (:meth:`merge`).

        bins: numbers of bins, (bins,), int32, ascending and different, which must contain all bins of this histogram.
            It is not checked: one that is missing gives IndexError or counts in a wrong bin.
        Returns the counts, (bins,), int64; 0 in bins without values.
        """
        counts = np.zeros(bins.size, np.int64)
        counts[np.searchsorted(bins, self.bins)] = self.counts
        return counts

    def quantiles(self, levels: tuple[float, ...]) -> Floats:
        """Return the quantiles, (levels,), in the unit of the quantity; NaN without values.

        A quantile lies at rank level (count - 1), counted from 0, linear between the values of the two nearest ranks.
        If the values were kept it is exact.  If not, the values of each bin count as evenly spread in it, within the
        least and the largest value, so that each is known to the width of its bin, 2^-8 of the value.

        levels: levels of the quantiles, in [0, 1], in any order; not checked.  For others numpy raises ValueError if
            the values were kept; else the result has no meaning, or IndexError is raised.
        """
        if not self.count:
            return np.full(len(levels), np.nan)
        if self.values is not None:
            return np.quantile(self.values, levels)
        position = np.asarray(levels) * (self.count - 1)
        lower = np.floor(position).astype(np.int64)
        first, second = self._at_rank(lower), self._at_rank(np.minimum(lower + 1, self.count - 1))
        return first + (position - lower) * (second - first)

    def _at_rank(self, ranks: Integers) -> Floats:
        """Return the values of ranks from 0, as if those of each bin were evenly spread.

        The bin of zero is no interval: it holds 0 and positive values below 1e-310, and all of them count as 0.

        ranks: ranks among the values in ascending order, 0 ... count - 1, (k,), int.
        Returns the values, (k,), in the unit of the quantity, between the least and the largest value.
        """
        below, above = edges_of(self.bins)
        above = np.where(self.bins == 0, below, above)
        reached = np.cumsum(self.counts)
        index = np.searchsorted(reached, ranks, side="right")
        share = (ranks - (reached[index] - self.counts[index]) + 0.5) / self.counts[index]
        return np.clip(below[index] + share * (above[index] - below[index]), self.low, self.high)


def edges_of(bins: NDArray[np.int32]) -> tuple[Any, Any]:
    """Return the edges of bins.

    bins: numbers of bins, (bins,), as of :class:`Histogram`.
    Returns (smallest value of each bin; smallest value of the bin after it, infinite for the last bin of finite
    values), floats, in the shape of ``bins`` each.
    """
    bits = np.stack([bins, bins + 1]).astype(np.int64) << _DROPPED
    below, above = (bits ^ ((bits >> 63) & _MAGNITUDE)).view(np.float64)
    return below, above
