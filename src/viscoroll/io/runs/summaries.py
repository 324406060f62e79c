"""Summaries of blocks that merge to the same bits in any order: counts in bins, and moments a block.

A bin holds the doubles that share sign, exponent and the first eight bits behind the point: 256 bins
to the octave, so each is at most 2^-8 of its value wide, with no range to choose beforehand (as in
DDSketch: C. Masson, J. Rim, H. Lee, VLDB 2019).  Counts are whole numbers, and moments are kept a block and
merged in the order of blocks.  A quantile lies between the two values beside it, each of which is known to
its bin, that is to 2^-8 of itself (``tests/runs/test_runs.py``).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

import msgspec
import numpy as np
from numpy.typing import NDArray

from ...motion.many import Ensemble
from .quantities import QUANTITIES, attributes

if TYPE_CHECKING:
    import xarray as xr

#: bits of a double below those that name a bin: 52 less the eight that are kept
_DROPPED = 44
_MAGNITUDE = np.int64(2**63 - 1)
#: from so many values on, counting in an array over all bins between the ends beats sorting
_MANY = 1 << 15


class Histogram(msgspec.Struct):
    """Counts and moments of one quantity at one time; ``bins`` ascend, ``counts`` > 0.

    ``spread`` is the sum of squares about the mean.
    """

    bins: NDArray[np.int32]
    counts: NDArray[np.int64]
    count: int
    mean: float
    spread: float
    low: float
    high: float


class Summary(msgspec.Struct):
    """What is kept of a block: histograms by quantity and time, and how its motions ended."""

    histograms: dict[str, list[Histogram]]
    statuses: dict[int, int]
    mapped: int


def summarise(motions: Ensemble, names: Iterable[str]) -> Summary:
    """Summary of a block."""
    histograms = {
        name: [
            histogram(np.asarray(QUANTITIES[name].values(motions, k)))
            for k in range(motions.t.size if QUANTITIES[name].over_time else 1)
        ]
        for name in names
    }
    codes, counts = np.unique(motions.status, return_counts=True)
    statuses = dict(zip(codes.tolist(), counts.tolist(), strict=True))
    return Summary(histograms, statuses, int(motions.flow.sum()))


def histogram(values: NDArray[np.float64]) -> Histogram:
    """Histogram of the finite ones of ``values``."""
    finite = np.isfinite(values)
    kept = np.ascontiguousarray(values if finite.all() else values[finite])
    if kept.size == 0:
        return Histogram(np.empty(0, np.int32), np.empty(0, np.int64), 0, 0.0, 0.0, np.inf, -np.inf)
    keys = bin_of(kept)
    if kept.size < _MANY:
        bins, counts = np.unique(keys, return_counts=True)
    else:
        first = keys.min()
        dense = np.bincount(keys - first)
        filled = np.flatnonzero(dense)
        bins, counts = filled + first, dense[filled]
    mean = kept.mean()
    spread = np.square(kept - mean).sum()
    return Histogram(
        bins.astype(np.int32), counts.astype(np.int64), kept.size, float(mean), float(spread),
        float(kept.min()), float(kept.max()),
    )  # fmt: skip


def bin_of(values: NDArray[np.float64]) -> NDArray[np.int64]:
    """Number of the bin of each value; the order of numbers is that of bins."""
    bits = (values + 0.0).view(np.int64)  # -0 becomes 0
    return (bits ^ ((bits >> 63) & _MAGNITUDE)) >> _DROPPED


def lower_edge(bins: NDArray[np.int64]) -> NDArray[np.float64]:
    """Least number of each bin."""
    bits = np.asarray(bins, np.int64) << _DROPPED
    return (bits ^ ((bits >> 63) & _MAGNITUDE)).view(np.float64)


def bin_edges(bins: NDArray[np.integer]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Lower edges of bins, and of those that follow."""
    wide = np.asarray(bins, np.int64)
    return lower_edge(wide), lower_edge(wide + 1)


def merged(summaries: Iterator[Summary]) -> Summary:
    """One summary out of those of blocks, given in the order of blocks."""
    total = next(summaries)
    for other in summaries:
        for name, histograms in total.histograms.items():
            pairs = zip(histograms, other.histograms[name], strict=True)
            total.histograms[name] = [_sum(a, b) for a, b in pairs]
        for code, count in other.statuses.items():
            total.statuses[code] = total.statuses.get(code, 0) + count
        total.mapped += other.mapped
    return total


def _sum(a: Histogram, b: Histogram) -> Histogram:
    """Counts added; moments after T. Chan, G. Golub, R. LeVeque (The American Statistician 37, 1983)."""
    if not a.count or not b.count:
        return a if a.count else b
    bins = np.union1d(a.bins, b.bins)
    counts = np.zeros(bins.size, np.int64)
    for one in (a, b):
        counts[np.searchsorted(bins, one.bins)] += one.counts
    count, apart = a.count + b.count, b.mean - a.mean
    return Histogram(
        bins, counts, count, a.mean + apart * (b.count / count),
        a.spread + b.spread + apart**2 * (a.count * (b.count / count)), min(a.low, b.low), max(a.high, b.high),
    )  # fmt: skip


def quantiles(one: Histogram, levels: tuple[float, ...]) -> NDArray[np.float64]:
    """Quantiles of a histogram; NaN where it is empty."""
    if not one.count:
        return np.full(len(levels), np.nan)
    position = np.asarray(levels) * (one.count - 1)
    lower = np.floor(position).astype(np.int64)
    first, second = _in_order(one, lower), _in_order(one, np.minimum(lower + 1, one.count - 1))
    return first + (position - lower) * (second - first)


def _in_order(one: Histogram, ranks: NDArray[np.int64]) -> NDArray[np.float64]:
    """The values of these ranks (from 0), were those of each bin evenly spread."""
    below, above = bin_edges(one.bins)
    reached = np.cumsum(one.counts)
    at = np.searchsorted(reached, ranks, side="right")
    share = (ranks - (reached[at] - one.counts[at]) + 0.5) / one.counts[at]
    return np.clip(below[at] + share * (above[at] - below[at]), one.low, one.high)


def summary_dataset(total: Summary, t: NDArray[np.float64], levels: tuple[float, ...], si: bool) -> xr.Dataset:
    """Moments, quantiles and histograms over t, and counts of how motions ended."""
    import xarray as xr

    from ...core.errors import MotionStatus

    data: dict[str, xr.Variable] = {}
    for name, histograms in total.histograms.items():
        data |= _variables(name, histograms, levels, si)
    codes = np.array([int(code) for code in MotionStatus], np.int8)
    ended = {
        "long_name": "motions by how they ended", "units": "1", "flag_values": codes,
        "flag_meanings": " ".join(code.name.lower() for code in MotionStatus),
        "meanings": "; ".join(f"{int(code)}: {code.message}" for code in MotionStatus),
    }  # fmt: skip
    counts = [total.statuses.get(int(code), 0) for code in codes]
    data["ended"] = xr.Variable("status", np.array(counts, np.int64), ended)
    coords = {
        "t": xr.Variable("t", t, attributes("t", si)),
        "quantile": xr.Variable("quantile", np.array(levels), {"long_name": "share of motions below", "units": "1"}),
        "status": xr.Variable("status", codes, {"long_name": "code of MotionStatus"}),
    }
    failed = sum(n for code, n in total.statuses.items() if code > MotionStatus.RESTED)
    return xr.Dataset(data, coords, {"failed_motions": failed, "motions_from_the_flow_map": total.mapped})


def _variables(name: str, histograms: list[Histogram], levels: tuple[float, ...], si: bool) -> dict[str, xr.Variable]:
    """Moments, quantiles, and counts in all bins that some time fills."""
    import xarray as xr

    text, unit = (QUANTITIES[name].about(si)[key] for key in ("long_name", "units"))
    over = ("t",) if QUANTITIES[name].over_time else ()

    def variable(dims: tuple[str, ...], values: NDArray, what: str, units: str = unit) -> xr.Variable:
        shaped = values if over else values[..., 0]
        return xr.Variable(dims, shaped, {"long_name": f"{what} of: {text}", "units": units})

    def each(part: str) -> NDArray:
        return np.array([getattr(one, part) if one.count else np.nan for one in histograms], np.float64)

    counted = np.array([one.count for one in histograms], np.int64)
    deviation = np.sqrt(each("spread") / np.maximum(counted, 1))
    table = np.stack([quantiles(one, levels) for one in histograms], axis=-1)
    quantile = variable(("quantile", *over), table, "quantiles")
    quantile.attrs["comment"] = "known to the bin that they lie in, at most 0.4 % wide"
    bins = np.unique(np.concatenate([one.bins for one in histograms]))
    counts = np.zeros((bins.size, len(histograms)), np.int64)
    for k, one in enumerate(histograms):
        counts[np.searchsorted(bins, one.bins), k] = one.counts
    below, above = bin_edges(bins)
    edge = {"units": unit}
    return {
        f"{name}_counted": variable(over, counted, "motions that have a value", "1"),
        f"{name}_mean": variable(over, each("mean"), "mean"),
        f"{name}_std": variable(over, deviation, "standard deviation"),
        f"{name}_min": variable(over, each("low"), "least value"),
        f"{name}_max": variable(over, each("high"), "largest value"),
        f"{name}_quantiles": quantile,
        f"{name}_histogram": variable((f"{name}_bin", *over), counts, "motions a bin", "1"),
        f"{name}_bin_low": xr.Variable(f"{name}_bin", below, edge | {"long_name": f"lower edge of a bin of {name}"}),
        f"{name}_bin_high": xr.Variable(f"{name}_bin", above, edge | {"long_name": f"upper edge of a bin of {name}"}),
    }
