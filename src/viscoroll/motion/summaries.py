"""Summaries of motions: of an ensemble in memory, and of blocks, which merge to the same bits in any order.

A bin holds the doubles that share sign, exponent and the first eight bits behind the point: 256 bins
to the octave, so each is at most 2^-8 of its value wide, with no range to choose beforehand (as in
DDSketch: C. Masson, J. Rim, H. Lee, VLDB 2019).  Counts are whole numbers, and moments are kept a block and
merged in the order of blocks.  A quantile of blocks lies between the two values beside it, each of which is known to
its bin, that is to 2^-8 of itself (``tests/runs/test_runs.py``); that of an ensemble in memory is exact.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from typing import TYPE_CHECKING, Any, NamedTuple

import msgspec
import numpy as np
from numpy.typing import NDArray

from ..core.array_types import Floats, Integers
from ..core.errors import MotionStatus, ParameterError
from .export import column_attributes, provenance

if TYPE_CHECKING:
    import xarray as xr

#: bits of a double below those that name a bin: 52 less the eight that are kept
_DROPPED = 44
_MAGNITUDE = np.int64(2**63 - 1)


class Quantity(NamedTuple):
    """``values(motions, k)`` at output time k, or for all times if not ``over_time``.

    They are those of the column ``like``, or the ``share`` of the kinetic energy at the start.
    """

    fields: tuple[str, ...]
    values: Callable[[Any, int], NDArray]
    like: str = ""
    share: str = ""
    over_time: bool = True

    def about(self, si: bool) -> dict[str, Any]:
        """long_name and units."""
        if self.share:
            return {"long_name": f"share of the initial kinetic energy {self.share}", "units": "1"}
        return column_attributes(self.like, si)


def _over(motions: Any, name: str, k: int) -> NDArray:
    """A field without dimension."""
    return getattr(motions, name)[:, k] / motions.scale[name]


def _translation(motions: Any, k: int) -> NDArray:
    return _over(motions, "V", k) ** 2 / _start_energy(motions)


def _rotation(motions: Any, k: int) -> NDArray:
    return motions.scene.j * _over(motions, "omega", k) ** 2 / _start_energy(motions)


def _start_energy(motions: Any) -> NDArray:
    """Twice the kinetic energy at the start; NaN for those at rest, which have no shares."""
    V, omega = (getattr(motions, name) / motions.scale[name] for name in ("V0", "omega0"))
    energy = V**2 + motions.scene.j * omega**2
    return np.where(energy > 0.0, energy, np.nan)


def _field(name: str) -> Quantity:
    return Quantity((name,), lambda motions, k: getattr(motions, name)[:, k], name)


def _loss(name: str, where: str) -> Quantity:
    """Losses are over m (R/T_epsilon)^2, of which the kinetic energy has a half."""
    return Quantity(
        (name,), lambda motions, k: 2.0 * _over(motions, name, k) / _start_energy(motions), share=f"lost in {where}"
    )


def _each(name: str) -> Quantity:
    return Quantity((), lambda motions, k: getattr(motions, name), name, over_time=False)


QUANTITIES = {
    **{name: _field(name) for name in ("V", "omega", "x", "angle", "delta", "force", "torque")},
    **{name: _field(name) for name in ("work_force", "work_torque", "brake_loss", "slip_loss", "rolling_loss")},
    "distance": Quantity(("x",), lambda motions, k: np.abs(motions.x[:, k]), "x"),
    "translation": Quantity(("V",), _translation, share="in translation"),
    "rotation": Quantity(("omega",), _rotation, share="in rotation"),
    "lost": Quantity(
        ("V", "omega"), lambda motions, k: 1.0 - _translation(motions, k) - _rotation(motions, k),
        share="lost to slip and rolling resistance",
    ),
    "lost_to_slip": _loss("slip_loss", "slip"),
    "lost_to_rolling": _loss("rolling_loss", "rolling"),
    "onset_time": _each("onset_time"),
    "rest_time": _each("rest_time"),
}  # fmt: skip


class Histogram(msgspec.Struct):
    """Counts and moments of one quantity at one time; ``bins`` ascend, ``counts`` > 0.

    ``spread`` is the sum of squares about the mean; ``values`` are there where quantiles are to be exact.
    """

    bins: NDArray[np.int32]
    counts: Integers
    count: int = 0
    mean: float = np.nan
    spread: float = np.nan
    low: float = np.nan
    high: float = np.nan
    values: Floats | None = None


class Summary(msgspec.Struct):
    """What is kept of a block: histograms by quantity and time, and how its motions ended."""

    histograms: dict[str, list[Histogram]]
    statuses: dict[int, int]
    mapped: int


def summary_of(motions: Any, levels: tuple[float, ...]) -> xr.Dataset:
    """The summary of an ensemble in memory; see ``Ensemble.summary``."""
    if not len(motions):
        raise ParameterError("motions", 0, "at least one: a summary is over motions")
    names = [
        name for name, one in QUANTITIES.items()
        if not one.share and all(getattr(motions, field) is not None for field in one.fields)
    ]  # fmt: skip
    found = summary_dataset(summarise(motions, names, exact=True), motions.t, levels, motions.scale.si)
    return found.assign_attrs(provenance("Summary of an ensemble of motions"), motions=len(motions))


def summarise(motions: Any, names: Iterable[str], exact: bool = False) -> Summary:
    """Summary of a block."""
    histograms = {}
    for name in names:
        times = range(motions.t.size if QUANTITIES[name].over_time else 1)
        histograms[name] = [histogram(np.asarray(QUANTITIES[name].values(motions, k)), exact) for k in times]
    codes, counts = np.unique(motions.status, return_counts=True)
    return Summary(histograms, dict(zip(codes.tolist(), counts.tolist(), strict=True)), int(motions.flow.sum()))


def histogram(values: Floats, exact: bool = False) -> Histogram:
    """Histogram of the finite ones of ``values``."""
    kept = values[np.isfinite(values)]
    bins, counts = np.unique(_bin_of(kept), return_counts=True)
    if not kept.size:
        return Histogram(bins, counts)
    mean = float(kept.mean())
    moments = mean, float(np.square(kept - mean).sum()), float(kept.min()), float(kept.max())
    return Histogram(bins, counts, kept.size, *moments, kept if exact else None)


def _bin_of(values: Floats) -> NDArray[np.int32]:
    """Number of the bin of each value; the order of numbers is that of bins."""
    bits = (values + 0.0).view(np.int64)  # -0 becomes 0
    return ((bits ^ ((bits >> 63) & _MAGNITUDE)) >> _DROPPED).astype(np.int32)


def _edges(bins: NDArray[np.int32]) -> tuple[Floats, Floats]:
    """Least numbers of bins, and of those that follow."""
    bits = np.stack([bins, bins + 1]).astype(np.int64) << _DROPPED
    below, above = (bits ^ ((bits >> 63) & _MAGNITUDE)).view(np.float64)
    return below, above


def merged(summaries: Iterator[Summary]) -> Summary:
    """One summary out of those of blocks, given in the order of blocks."""
    total = next(summaries)
    for other in summaries:
        for name, histograms in total.histograms.items():
            total.histograms[name] = [_sum(*pair) for pair in zip(histograms, other.histograms[name], strict=True)]
        for code, count in other.statuses.items():
            total.statuses[code] = total.statuses.get(code, 0) + count
        total.mapped += other.mapped
    return total


def _sum(a: Histogram, b: Histogram) -> Histogram:
    """Counts added; moments after T. Chan, G. Golub, R. LeVeque (The American Statistician 37, 1983)."""
    if not a.count or not b.count:
        return a if a.count else b
    bins = np.union1d(a.bins, b.bins)
    count, apart = a.count + b.count, b.mean - a.mean
    return Histogram(
        bins, _counts(a, bins) + _counts(b, bins), count, a.mean + apart * (b.count / count),
        a.spread + b.spread + apart**2 * (a.count * (b.count / count)), min(a.low, b.low), max(a.high, b.high),
    )  # fmt: skip


def _counts(one: Histogram, bins: NDArray[np.int32]) -> Integers:
    """Its counts over more bins."""
    counts = np.zeros(bins.size, np.int64)
    counts[np.searchsorted(bins, one.bins)] = one.counts
    return counts


def quantiles(one: Histogram, levels: tuple[float, ...]) -> Floats:
    """Quantiles of a histogram; NaN where it is empty."""
    if not one.count:
        return np.full(len(levels), np.nan)
    if one.values is not None:
        return np.quantile(one.values, levels)
    position = np.asarray(levels) * (one.count - 1)
    lower = np.floor(position).astype(np.int64)
    first, second = _in_order(one, lower), _in_order(one, np.minimum(lower + 1, one.count - 1))
    return first + (position - lower) * (second - first)


def _in_order(one: Histogram, ranks: Integers) -> Floats:
    """The values of these ranks (from 0), if those of each bin were evenly spread.

    The bin of zero is no interval of values: it holds 0 and what is below 1e-310, and all of it counts as 0.
    """
    below, above = _edges(one.bins)
    above = np.where(one.bins == 0, below, above)
    reached = np.cumsum(one.counts)
    at = np.searchsorted(reached, ranks, side="right")
    share = (ranks - (reached[at] - one.counts[at]) + 0.5) / one.counts[at]
    return np.clip(below[at] + share * (above[at] - below[at]), one.low, one.high)


def summary_dataset(total: Summary, t: Floats, levels: tuple[float, ...], si: bool) -> xr.Dataset:
    """Moments, quantiles and histograms over t, and counts of how motions ended."""
    import xarray as xr

    data: dict[str, Any] = {}
    for name, histograms in total.histograms.items():
        data |= _variables(name, histograms, levels, si)
    codes = np.array([int(code) for code in MotionStatus], np.int8)
    ended = column_attributes("status") | {
        "long_name": "motions by how they ended", "units": "1",
        "meanings": "; ".join(f"{int(code)}: {code.message}" for code in MotionStatus),
    }  # fmt: skip
    data["ended"] = "status", np.array([total.statuses.get(code, 0) for code in codes.tolist()]), ended
    coords = {
        "t": ("t", t, column_attributes("t", si)),
        "quantile": ("quantile", np.array(levels), {"long_name": "share of motions below", "units": "1"}),
        "status": ("status", codes, {"long_name": "code of MotionStatus"}),
    }
    failed = sum(n for code, n in total.statuses.items() if code > MotionStatus.RESTED)
    return xr.Dataset(data, coords, {"failed_motions": failed, "motions_from_the_flow_map": total.mapped})


def _variables(name: str, histograms: list[Histogram], levels: tuple[float, ...], si: bool) -> dict[str, Any]:
    """Moments, quantiles, and counts in all bins that some time fills."""
    about, over = QUANTITIES[name].about(si), ("t",) if QUANTITIES[name].over_time else ()
    bins = np.unique(np.concatenate([one.bins for one in histograms]))
    moments = np.array([[one.count, one.mean, one.spread, one.low, one.high] for one in histograms]).T
    counted, mean, spread, low, high = moments
    exact = any(one.values is not None for one in histograms)
    known = "exact" if exact else "known to the bin that they lie in, at most 0.4 % wide"
    of_bins = (f"{name}_bin",)
    below, above = _edges(bins)
    found: dict[str, tuple[tuple[str, ...], NDArray, str]] = {
        "counted": (over, counted.astype(np.int64), "motions that have a value"),
        "mean": (over, mean, "mean"),
        "std": (over, np.sqrt(spread / np.maximum(counted, 1)), "standard deviation"),
        "min": (over, low, "least value"),
        "max": (over, high, "largest value"),
        "quantiles": (("quantile", *over), np.array([quantiles(one, levels) for one in histograms]).T, "quantiles"),
        "histogram": ((*of_bins, *over), np.array([_counts(one, bins) for one in histograms]).T, "motions a bin"),
        "bin_low": (of_bins, below, "lower edge of a bin"),
        "bin_high": (of_bins, above, "upper edge of a bin"),
    }
    data = {}
    for part, (dims, values, what) in found.items():
        units = "1" if part in ("counted", "histogram") else about["units"]
        attributes = {"long_name": f"{what} of: {about['long_name']}", "units": units}
        if part == "quantiles":
            attributes["comment"] = known
        data[f"{name}_{part}"] = (dims, values.reshape(values.shape[: len(dims)]), attributes)
    return data
