"""Summaries of many motions: histograms, moments and quantiles, of an ensemble in memory, and of
blocks of a run, with the same bits in whatever order these were computed.

:class:`Histogram` has counts and moments of one quantity, which merge with those of further values:
counts to the same bits in any order, moments to rounding.

A bin holds the doubles that share sign, exponent and the first eight bits after the point: 256 bins
to the octave, so each is at most 2^-8 of its value wide (of magnitudes from 2^-1022 on), with no
range to choose beforehand (as in DDSketch: C. Masson, J. Rim, H. Lee, VLDB 2019).

Counts are whole numbers, and moments are kept for each block and merged in the order of blocks.  A
quantile of blocks lies between two values that are known to 2^-8 each
(``tests/runs/test_runs.py``); that of an ensemble in memory is exact.

:func:`summarise` counts the motions of a block and returns a :class:`Summary`, which merges with
those of other blocks; :func:`summary_dataset` makes a dataset of a :class:`Summary`.  By these two
:func:`ensemble_summary` makes the dataset that ``Ensemble.summary`` returns, and
:func:`drawn_summary` that from which the figure of an ensemble is drawn.
"""

from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from typing import Any, NamedTuple

import msgspec
import numpy as np

from ..core import Dataset, Floats, Integers, MotionStatus, NDArray, ParameterError
from .motion_arguments import ROWS
from .motion_datasets import Variables, column_attributes, provenance

# --- Counts and moments of one quantity, which merge with those of further values ---

#: Bits of a double below those that number a bin: 52 of the fraction less the eight that are kept.
_DROPPED = 44
#: All bits of a double but its sign.
_MAGNITUDE = np.int64(2**63 - 1)


class Histogram(msgspec.Struct):
    """Counts and moments of the finite values of one quantity at one time.

    bins : numbers of the bins that hold values, ascending, (bins,).
    counts : number of the values in each bin, > 0, (bins,).
    count : number of all values.
    mean, low, high : mean, least and largest value, in the unit of the quantity; NaN without
    values.
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
    @np.errstate(over="ignore")  # a sum of squares beyond the doubles is infinite
    def of(cls, values: Floats, exact: bool = False) -> "Histogram":
        """Make the histogram of those values that are finite.

        values: float64, (n,), in the unit of the quantity; those that are not finite are left out,
        and -0 counts as 0.
        exact: whether to keep the values that are finite, (count,), for exact quantiles.
        Returns the :class:`Histogram`; without finite values it has no bins, its moments are NaN,
        and its ``values`` None.
        """
        kept = values[np.isfinite(values)]
        bits = (kept + 0.0).view(np.int64)  # -0 becomes 0
        # Bits of negative numbers but the sign are inverted: the order of numbers is that of their
        # bins.  The shift drops the bits of the fraction by which bins do not differ.
        numbers = ((bits ^ ((bits >> 63) & _MAGNITUDE)) >> _DROPPED).astype(np.int32)
        bins, counts = np.unique(numbers, return_counts=True)
        if not kept.size:
            return cls(bins, counts)
        mean = float(kept.mean())
        moments = mean, float(np.square(kept - mean).sum()), float(kept.min()), float(kept.max())
        return cls(bins, counts, kept.size, *moments, kept if exact else None)

    def merge(self, other: "Histogram") -> "Histogram":
        """Return the histogram of the values of two histograms.

        Moments after T. Chan, G. Golub, R. LeVeque (The American Statistician 37, 1983).

        other: :class:`Histogram`, the second histogram.
        Returns a new histogram, which does not keep the values, so that its quantiles are not
        exact.  If one of the two has no values the other one itself is returned, with the values
        that it keeps.
        """
        if not self.count or not other.count:
            return self if self.count else other
        bins = np.union1d(self.bins, other.bins)
        count = self.count + other.count
        distance = other.mean - self.mean
        mean = self.mean + distance * (other.count / count)
        between = distance * distance * (self.count * (other.count / count))
        return Histogram(
            bins=bins,
            counts=self.counts_in(bins) + other.counts_in(bins),
            count=count,
            mean=mean,
            spread=self.spread + other.spread + between,
            low=min(self.low, other.low),
            high=max(self.high, other.high),
        )

    def counts_in(self, bins: NDArray[np.int32]) -> Integers:
        """Return the counts in other bins, so that those of two histograms can be added
        (:meth:`merge`).

        bins: numbers of bins, (bins,), int32, ascending and different, which must contain all bins
            of this histogram.  It is not checked: one that is missing gives IndexError or counts in
            a wrong bin.
        Returns the counts, (bins,), int64; 0 in bins without values.
        """
        counts = np.zeros(bins.size, np.int64)
        counts[np.searchsorted(bins, self.bins)] = self.counts
        return counts

    def quantiles(self, levels: tuple[float, ...]) -> Floats:
        """Return the quantiles, (levels,), in the unit of the quantity; NaN without values.

        A quantile lies at rank level (count - 1), counted from 0, linear between the values of the
        two nearest ranks.  If the values were kept it is exact.  If not, the values of each bin
        count as evenly spread in it, within the least and the largest value, so that each is known
        to the width of its bin, 2^-8 of the value.

        levels: levels of the quantiles, in [0, 1], in any order; not checked.  For others numpy
            raises ValueError if the values were kept; else the least or the largest value is
            returned.
        """
        if not self.count:
            return np.full(len(levels), np.nan)
        if self.values is not None:
            return np.quantile(self.values, levels)
        below, above = edges_of(self.bins)
        # the bin of zero is no interval: 0 and positive values below 1e-310, which all count as 0
        width = np.where(self.bins == 0, 0.0, above - below)
        # ranks of the first and the last value of each bin, half a value from its edges
        last = np.cumsum(self.counts) - 1
        margin = 0.5 / self.counts
        ranks = np.ravel([last - self.counts + 1, last], "F")
        values = np.ravel([below + margin * width, below + (1.0 - margin) * width], "F")
        return np.interp(
            np.asarray(levels) * (self.count - 1), ranks, np.clip(values, self.low, self.high)
        )


def edges_of(bins: NDArray[np.int32]) -> tuple[Any, Any]:
    """Return the edges of bins.

    bins: numbers of bins, (bins,), as in :class:`Histogram`.
    Returns (smallest value of each bin; smallest value of the bin after it, infinite for the last
    bin of finite values), floats, in the shape of ``bins`` each.
    """
    bits = np.stack([bins, bins + 1]).astype(np.int64) << _DROPPED
    below, above = (bits ^ ((bits >> 63) & _MAGNITUDE)).view(np.float64)
    return below, above


# --- Summaries of motions ---

#: Bins of the histogram of an ensemble's figure.
_MOST_BARS = 80
#: Levels of the quantiles that are computed where no others are given.
LEVELS = (0.05, 0.25, 0.5, 0.75, 0.95)
#: Quantities of an ensemble that are drawn.
_DRAWN = ("V", "omega", "x", "angle")


class Quantity(NamedTuple):
    """A quantity that summaries describe.

    fields : names of the fields of an ensemble that it needs; none: it is the field ``column``,
    which has one value for each motion.
    of : function of these fields at an output time, (n,) each, in the unit of the roller -> its
    values, (n,), in that unit.  Of a part: a function (V0^2 + j omega0^2; j; fields), all
    dimensionless.
    column : name of the field whose long_name and unit it has; "" for a part of the kinetic energy
    at the start.
    part : words on which part that is; "" else.
    """

    fields: tuple[str, ...] = ()
    of: Callable[..., NDArray] = np.positive
    part: str = ""
    column: str = ""

    @property
    def over_time(self) -> bool:
        """Whether it has a value at each output time."""
        return bool(self.fields)

    def values(self, motions: Any, k: int) -> NDArray:
        """Return its values at an output time, (n,), in the unit of the roller, of a part
        dimensionless; NaN for motions that did not reach that time, and parts of motions from rest.

        motions: an :class:`Ensemble`, or a dataset of one for what is no part, with the fields; of
            a part V0, omega0 (after the cost of a standstill), scale and scene.j are read too.
        k: index of the output time, ignored without ``over_time``.
        """
        if not self.fields:
            return motions[self.column]
        found = [motions[name][:, k] for name in self.fields]
        if not self.part:
            return self.of(*found)
        scale = motions.scale
        j = motions.scene.j
        # twice the kinetic energy at the start divided by m (R/T_ref)^2
        whole = (motions.V0 / scale["V"]) ** 2 + j * (motions.omega0 / scale["omega"]) ** 2
        found = [values / scale[name] for name, values in zip(self.fields, found)]
        return self.of(np.where(whole > 0.0, whole, np.nan), j, *found)

    def about(self, si: bool) -> dict[str, Any]:
        """Return the attributes long_name and units of the quantity, further ones of a field, as a
        dict.

        si: whether the units are those of a cylinder; a part of the energy at the start has "1" in
        either case.
        """
        if self.part:
            return {
                "long_name": f"energy {self.part}, divided by the kinetic energy at the start",
                "units": "1",
            }
        return column_attributes(self.column, si)


def _loss(whole: NDArray, j: Any, loss: NDArray) -> NDArray:
    """Return a loss divided by the kinetic energy at the start, ``whole`` being twice that."""
    return 2.0 * loss / whole


#: All quantities by name.
QUANTITIES = {
    **{name: Quantity((name,), column=name) for name in ROWS if name != "regime"},
    "distance": Quantity(("x",), np.abs, column="x"),
    "translation": Quantity(("V",), lambda whole, j, V: V**2 / whole, "in translation"),
    "rotation": Quantity(("omega",), lambda whole, j, omega: j * omega**2 / whole, "in rotation"),
    "lost": Quantity(
        ("V", "omega"),
        lambda whole, j, V, omega: 1.0 - V**2 / whole - j * omega**2 / whole,
        "lost to slip and rolling resistance",
    ),
    "lost_to_slip": Quantity(("slip_loss",), _loss, "lost in slip"),
    "lost_to_rolling": Quantity(("rolling_loss",), _loss, "lost in rolling"),
    "onset_time": Quantity(column="onset_time"),
    "rest_time": Quantity(column="rest_time"),
}


class Summary(msgspec.Struct):
    """Summary of a block of motions.

    histograms : name of a quantity -> a histogram for each output time, or one for a quantity that
    is one number per motion.
    statuses : code of :class:`MotionStatus` -> number of motions.
    mapped : number of motions from the flow map.
    """

    histograms: dict[str, list[Histogram]]
    statuses: dict[int, int]
    mapped: int


def ensemble_summary(motions: Any, levels: tuple[float, ...]) -> Dataset:
    """Return the summary of an ensemble in memory with exact quantiles, see ``Ensemble.summary``.

    motions: the :class:`Ensemble`.
    levels: levels of the quantiles, in [0, 1], in any order; the caller checks them (ValueError of
    numpy).
    Raises ParameterError for an ensemble without motions.
    Returns the dataset of :func:`summary_dataset`, in the units of the roller: moments, quantiles
    and histograms of

    - every field of the ensemble except ``regime``,
    - the distance |x|, if x is there,
    - onset_time and rest_time.

    Its attributes also are ``motions``, their number, and those of
    :func:`.motion_datasets.provenance`.
    """
    if not len(motions):
        raise ParameterError("motions", 0, "at least 1")
    names = [
        name
        for name, quantity in QUANTITIES.items()
        if not quantity.part and all(motions[field] is not None for field in quantity.fields)
    ]
    summary = summarise(motions, names, exact=True)
    return summary_dataset(summary, motions.t, levels, motions.scale.si).assign_attrs(
        provenance("Summary of an ensemble of motions"), motions=len(motions)
    )


def drawn_summary(ensemble: Dataset) -> Dataset:
    """Return the summary from which the figure of an ensemble is drawn: of those of V, omega, x and
    angle that the ensemble has.

    ensemble: dataset of ``Ensemble.to_xarray``; t, status and flow are read too.  An attribute R
        tells that it is in SI units.
    Returns the dataset of :func:`summary_dataset`, with the quantiles of :data:`LEVELS`, in the
    units of ``ensemble``.  Its histograms are of the last time alone, in even bins between the
    least and the largest value; where these are too near each other, those of the summary stay.
    Its attributes also are ``motions``, their number.
    Raises AttributeError for a dataset without status or flow.
    """
    names = [name for name in _DRAWN if name in ensemble]
    summary = summarise(ensemble, names, exact=True)
    dataset = summary_dataset(summary, ensemble["t"].values, LEVELS, "R" in ensemble.attrs)
    for name in names:  # values that differ by less than a bin of the summary
        last: Any = summary.histograms[name][-1]
        # fewer different edges: values too near each other for even bins, or NaN without values
        edges = np.unique(np.linspace(last.low, last.high, _MOST_BARS + 1))
        if edges.size == _MOST_BARS + 1:
            bin_ = f"{name}_bin"
            dataset = dataset.drop_dims(bin_).assign(
                {
                    f"{bin_}_low": (bin_, edges[:-1]),
                    f"{bin_}_high": (bin_, edges[1:]),
                    f"{name}_histogram": (bin_, np.histogram(last.values, edges)[0]),
                }
            )
    return dataset.assign_attrs(motions=ensemble.sizes["motion"])


def summarise(motions: Any, names: Iterable[str], exact: bool = False) -> Summary:
    """Return the summary of the motions of a block, which merges with those of other blocks.

    motions: an :class:`Ensemble`, or its dataset, for which names of parts of the energy are not
        allowed; t, status, flow and the fields of the quantities are read, for a part of the energy
        V0, omega0, scale and scene.j too.
    names: names of quantities, keys of :data:`QUANTITIES` (else KeyError), whose fields the
    ensemble has.
    exact: whether to keep the values for exact quantiles.
    Returns the :class:`Summary`, in the units of the roller: a list of histograms for each name,
    one for each output time, or a single one of a quantity that is one number for each motion; its
    ``statuses`` have only those that occur.  Values that are not finite are left out.
    """
    histograms = {}
    for name in names:
        quantity = QUANTITIES[name]
        histograms[name] = [
            Histogram.of(np.asarray(quantity.values(motions, k)), exact)
            for k in range(motions.t.size if quantity.over_time else 1)
        ]
    statuses = Counter(np.asarray(motions.status).tolist())
    return Summary(histograms, dict(sorted(statuses.items())), int(motions.flow.sum()))


def merge_summaries(summaries: Iterator[Summary]) -> Summary:
    """Merge the summaries of blocks to one of all their motions.

    summaries: iterator over at least one :class:`Summary`, in the order of blocks.
    Returns the first one, which is changed and then counts all motions.  A histogram keeps its
    values only if no more than one of the blocks has values there; else its quantiles are known to
    their bins.
    Raises StopIteration without a summary, KeyError for one that lacks a quantity of the first,
    ValueError for one of another number of times.  Quantities that the first lacks are left out.
    """
    total = next(summaries)
    for other in summaries:
        for name, histograms in total.histograms.items():
            pairs = zip(histograms, other.histograms[name], strict=True)
            total.histograms[name] = [first.merge(second) for first, second in pairs]
        total.statuses = dict(Counter(total.statuses) + Counter(other.statuses))
        total.mapped += other.mapped
    return total


def summary_dataset(total: Summary, t: Floats, levels: tuple[float, ...], si: bool) -> Dataset:
    """Return moments, quantiles and histograms, and counts of how motions ended, as a dataset.

    total: the :class:`Summary`, with at least one histogram for each quantity.
    t: output times, (times,), in the unit of the roller, as many as histograms of a quantity over
    time.
    levels: levels of the quantiles, in [0, 1].
    si: whether the attributes name the SI units of a cylinder; values are not converted.
    Returns the dataset over t, quantile (``levels``) and status (codes of :class:`MotionStatus`),
    its coordinates: of each quantity the variables of :func:`_variables`; ``ended`` over status,
    the number of motions with each status, 0 included, whose attribute ``meanings`` has the
    messages as "CODE: MESSAGE; ..."; attributes ``failed_motions``, the number of those that
    reached neither the last output time nor rest, and ``motions_from_the_flow_map``.
    """
    import xarray as xr

    data: Variables = {}
    for name, histograms in total.histograms.items():
        data |= _variables(name, histograms, levels, si)
    data["ended"] = (
        "status",
        np.array([total.statuses.get(code, 0) for code in MotionStatus]),
        column_attributes("status")
        | {
            "long_name": "number of motions with each status",
            "units": "1",
            "meanings": "; ".join(f"{int(code)}: {code.message}" for code in MotionStatus),
        },
    )
    coords = {
        "t": ("t", t, column_attributes("t", si)),
        "quantile": (
            "quantile",
            np.array(levels),
            {"long_name": "share of motions below", "units": "1"},
        ),
        "status": (
            "status",
            np.array([*MotionStatus], np.int8),
            {"long_name": "code of MotionStatus"},
        ),
    }
    failed = sum(n for code, n in total.statuses.items() if code > MotionStatus.RESTED)
    return xr.Dataset(
        data, coords, {"failed_motions": failed, "motions_from_the_flow_map": total.mapped}
    )


def _variables(
    name: str, histograms: list[Histogram], levels: tuple[float, ...], si: bool
) -> Variables:
    """Return the variables of one quantity: moments, quantiles, and counts in all bins that hold a
    value at some time.

    name: name of the quantity, a key of :data:`QUANTITIES`.
    histograms: one :class:`Histogram` for each output time, or one.
    levels: levels of the quantiles, in [0, 1].
    si: whether the attributes name the SI units of a cylinder; values are not converted.
    Returns name of the variable -> (dimensions, values, attributes): NAME_counted, _mean, _std (the
    root of the mean square of the differences from the mean), _min, _max over t, NAME_quantiles
    over (quantile, t), NAME_histogram over (NAME_bin, t), NAME_bin_low and NAME_bin_high over
    NAME_bin; all without t of a quantity that is one number per motion.  At a time without values
    the moments and quantiles are NaN, and counts 0.  Attributes are long_name and units ("1" of
    counts), of the quantiles also ``comment``, their accuracy.
    """
    about = QUANTITIES[name].about(si)
    times = ("t",) if QUANTITIES[name].over_time else ()
    bins = np.unique(np.concatenate([one.bins for one in histograms]))
    counted, mean, spread, low, high = np.transpose(
        [[one.count, one.mean, one.spread, one.low, one.high] for one in histograms]
    )
    below, above = edges_of(bins)
    in_bins = f"{name}_bin"
    parts = {
        "counted": (times, counted.astype(np.int64), "motions that have a value"),
        "mean": (times, mean, "mean"),
        "std": (times, np.sqrt(spread / np.maximum(counted, 1)), "standard deviation"),
        "min": (times, low, "least value"),
        "max": (times, high, "largest value"),
        "quantiles": (
            ("quantile", *times),
            np.transpose([one.quantiles(levels) for one in histograms]),
            "quantiles",
        ),
        "histogram": (
            (in_bins, *times),
            np.transpose([one.counts_in(bins) for one in histograms]),
            "number of motions in each bin",
        ),
        "bin_low": ((in_bins,), below, "lower edge of a bin"),
        "bin_high": ((in_bins,), above, "upper edge of a bin"),
    }
    data = {}
    for part, (dims, values, title) in parts.items():
        units = "1" if part in ("counted", "histogram") else about["units"]
        attributes = {"long_name": f"{title} of: {about['long_name']}", "units": units}
        # a quantity that is one number per motion has no axis t: its last axis, of length 1, goes
        data[f"{name}_{part}"] = dims, values.reshape(values.shape[: len(dims)]), attributes
    exact = any(one.values is not None for one in histograms)
    accuracy = (
        "exact"
        if exact
        else "error at most the width of a bin, which is at most 0.4 % of the value"
    )
    data[f"{name}_quantiles"][2]["comment"] = accuracy
    return data
