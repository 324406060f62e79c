"""Summaries of motions: of an ensemble in memory, and of blocks of a run, with the same bits in whatever order these
were computed.

Counts are whole numbers, and moments are kept for each block and merged in the order of blocks.  A quantile of blocks
lies between two values that are known to 2^-8 each (``tests/runs/test_runs.py``); that of an ensemble in memory is
exact.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

import msgspec
import numpy as np
from numpy.typing import NDArray

from ..core.array_types import Floats
from ..core.errors import MotionStatus, ParameterError
from .export import column_attributes, provenance
from .histogram import Histogram, edges_of

if TYPE_CHECKING:
    import xarray as xr

#: Levels of the quantiles that are computed where no others are given.
LEVELS = (0.05, 0.25, 0.5, 0.75, 0.95)
#: Quantities of an ensemble that are drawn.
_DRAWN = ("V", "omega", "x", "angle")


class Quantity(NamedTuple):
    """A quantity that summaries describe.

    fields : names of the fields of an ensemble that it needs.
    values : function (motions, index of the output time) -> its values, (n,), in the unit of the roller or, of a part,
    dimensionless; the index is ignored without ``over_time``.
    column : name of the field whose long_name and unit it has; "" for a part of the kinetic energy at the start.
    part : words on which part that is; "" else.
    over_time : whether it has a value at each output time.
    """

    fields: tuple[str, ...]
    values: Callable[[Any, int], NDArray]
    column: str = ""
    part: str = ""
    over_time: bool = True

    def about(self, si: bool) -> dict[str, Any]:
        """Return the attributes long_name and units of the quantity, further ones of a field, as a dict.

        si: whether the units are those of a cylinder; a part of the energy at the start has "1" in either case.
        """
        if self.part:
            return {"long_name": f"share of the initial kinetic energy {self.part}", "units": "1"}
        return column_attributes(self.column, si)


def _dimensionless(motions: Any, name: str, k: int) -> NDArray:
    """Return a field at an output time, made dimensionless, (n,); NaN for motions that did not reach it.

    motions: an :class:`Ensemble`, of which the field and scale are read.
    name, k: name of a field over (motion, t) that it has, and index of the output time.
    """
    return getattr(motions, name)[:, k] / motions.scale[name]


def _start_energy(motions: Any) -> NDArray:
    """Return V0^2 + j omega0^2, twice the kinetic energy at the start divided by m (R/T_ref)^2, (n,); NaN for motions
    from rest.  T_ref is the unit of time of dimensionless motions.

    motions: an :class:`Ensemble`, of which V0, omega0, scale and scene.j are read; its start speeds are those after the
        cost of a standstill.
    """
    V, omega = (getattr(motions, name) / motions.scale[name] for name in ("V0", "omega0"))
    energy = V**2 + motions.scene.j * omega**2
    return np.where(energy > 0.0, energy, np.nan)


def _translation(motions: Any, k: int) -> NDArray:
    """Return V(t_k)^2/(V0^2 + j omega0^2), dimensionless, (n,): the translational energy at output time t_k divided by
    the kinetic energy at the start, above 1 perhaps under a drive; NaN for motions from rest, and for those that did
    not reach t_k.

    motions: an :class:`Ensemble` with the field V; V0, omega0 (after the cost of a standstill), scale and scene.j are
        read too.
    k: index of the output time.
    """
    return _dimensionless(motions, "V", k) ** 2 / _start_energy(motions)


def _rotation(motions: Any, k: int) -> NDArray:
    """Return j omega(t_k)^2/(V0^2 + j omega0^2), dimensionless, (n,): the rotational energy at output time t_k divided
    by the kinetic energy at the start, above 1 perhaps under a drive; NaN for motions from rest, and for those that did
    not reach t_k.

    motions: an :class:`Ensemble` with the field omega; V0, omega0, scale and scene.j are read too.
    k: index of the output time.
    """
    return motions.scene.j * _dimensionless(motions, "omega", k) ** 2 / _start_energy(motions)


def _loss(name: str, motions: Any, k: int) -> NDArray:
    """Return a loss up to an output time divided by the kinetic energy at the start, dimensionless, (n,); NaN for
    motions from rest, and for those that did not reach the time.

    name, k: name of the field, "slip_loss" or "rolling_loss", in m (R/T_ref)^2 or J/m; index of the output time.
    motions: an :class:`Ensemble` with that field; V0, omega0, scale and scene.j are read too.
    """
    return 2.0 * _dimensionless(motions, name, k) / _start_energy(motions)


def _field(name: str, motions: Any, k: int) -> NDArray:
    """Return the field ``name`` of ``motions`` at output time ``k``, (n,), in its unit; NaN where not reached."""
    return getattr(motions, name)[:, k]


#: Fields of an ensemble that are summarised as they are.
_FIELDS = (
    "V", "omega", "x", "angle", "delta", "force", "torque",
    "work_force", "work_torque", "brake_loss", "slip_loss", "rolling_loss",
)  # fmt: skip
#: All quantities by name.
QUANTITIES = {
    **{name: Quantity((name,), partial(_field, name), name) for name in _FIELDS},
    "distance": Quantity(("x",), lambda motions, k: np.abs(motions.x[:, k]), "x"),
    "translation": Quantity(("V",), _translation, part="in translation"),
    "rotation": Quantity(("omega",), _rotation, part="in rotation"),
    "lost": Quantity(
        ("V", "omega"), lambda motions, k: 1.0 - _translation(motions, k) - _rotation(motions, k),
        part="lost to slip and rolling resistance",
    ),
    "lost_to_slip": Quantity(("slip_loss",), partial(_loss, "slip_loss"), part="lost in slip"),
    "lost_to_rolling": Quantity(("rolling_loss",), partial(_loss, "rolling_loss"), part="lost in rolling"),
    "onset_time": Quantity((), lambda motions, k: motions.onset_time, "onset_time", over_time=False),
    "rest_time": Quantity((), lambda motions, k: motions.rest_time, "rest_time", over_time=False),
}  # fmt: skip


class Summary(msgspec.Struct):
    """Summary of a block of motions.

    histograms : name of a quantity -> a histogram for each output time, or one for a quantity that is one number per
    motion.
    statuses : code of :class:`MotionStatus` -> number of motions.
    mapped : number of motions from the flow map.
    """

    histograms: dict[str, list[Histogram]]
    statuses: dict[int, int]
    mapped: int


def summary_of(motions: Any, levels: tuple[float, ...]) -> xr.Dataset:
    """Return the summary of an ensemble in memory with exact quantiles, see ``Ensemble.summary``.

    motions: the :class:`Ensemble`.
    levels: levels of the quantiles, in [0, 1], in any order; the caller checks them (ValueError of numpy).
    Raises ParameterError for an ensemble without motions.
    Returns the dataset of :func:`summary_dataset`, of all fields that the ensemble has but the regime, of the distance
    |x| if it has x, and of onset and rest time, in the units of the roller; its attributes also are ``motions``, their
    number, and those of :func:`.export.provenance`.
    """
    if not len(motions):
        raise ParameterError("motions", 0, "at least 1")
    names = [
        name for name, quantity in QUANTITIES.items()
        if not quantity.part and all(getattr(motions, field) is not None for field in quantity.fields)
    ]  # fmt: skip
    dataset = summary_dataset(summarise(motions, names, exact=True), motions.t, levels, motions.scale.si)
    return dataset.assign_attrs(provenance("Summary of an ensemble of motions"), motions=len(motions))


def drawn_summary(ensemble: xr.Dataset) -> xr.Dataset:
    """Return the summary by which an ensemble is drawn: of both speeds, the distance and the angle, as it has them.

    ensemble: dataset of ``Ensemble.to_xarray``.  Those of V, omega, x and angle that it has are summarised, at its t;
        status and flow are read too; an attribute R tells that it is in SI units.
    Returns the dataset of :func:`summary_dataset`, with the quantiles of :data:`LEVELS`, in the units of ``ensemble``;
    its attributes also are ``motions``, their number.  A dataset without status or flow raises AttributeError.
    """
    names = [name for name in _DRAWN if name in ensemble]
    summary = summarise(ensemble, names, exact=True)
    dataset = summary_dataset(summary, ensemble["t"].values, LEVELS, si="R" in ensemble.attrs)
    return dataset.assign_attrs(motions=ensemble.sizes["motion"])


def summarise(motions: Any, names: Iterable[str], exact: bool = False) -> Summary:
    """Return the summary of the motions of a block, which merges with those of other blocks.

    motions: an :class:`Ensemble`, or its dataset, for which names of parts of the energy are not allowed; t, status,
        flow and the fields of the quantities are read, for a part of the energy V0, omega0, scale and scene.j too.
    names: names of quantities, keys of :data:`QUANTITIES` (else KeyError), whose fields the ensemble has.
    exact: whether to keep the values for exact quantiles.
    Returns the :class:`Summary`, in the units of the roller: a list of histograms for each name, one for each output
    time, or a single one of a quantity that is one number for each motion; its ``statuses`` have only those that occur.
    Values that are not finite are left out.
    """
    histograms = {}
    for name in names:
        quantity = QUANTITIES[name]
        times = range(motions.t.size if quantity.over_time else 1)
        histograms[name] = [Histogram.of(np.asarray(quantity.values(motions, k)), exact) for k in times]
    codes, counts = np.unique(motions.status, return_counts=True)
    return Summary(histograms, dict(zip(codes.tolist(), counts.tolist(), strict=True)), int(motions.flow.sum()))


def merge_summaries(summaries: Iterator[Summary]) -> Summary:
    """Merge the summaries of blocks to one of all their motions.

    summaries: iterator over at least one :class:`Summary`, in the order of blocks.
    Returns the first one, which is changed and then counts all motions.  A histogram keeps its values only if no more
    than one of the blocks has values there; else its quantiles are known to their bins.
    Raises StopIteration without a summary, KeyError for one that lacks a quantity of the first, ValueError for one of
    another number of times.  Quantities that the first lacks are left out.
    """
    total = next(summaries)
    for other in summaries:
        for name, histograms in total.histograms.items():
            pairs = zip(histograms, other.histograms[name], strict=True)
            total.histograms[name] = [first.merge(second) for first, second in pairs]
        for code, count in other.statuses.items():
            total.statuses[code] = total.statuses.get(code, 0) + count
        total.mapped += other.mapped
    return total


def summary_dataset(total: Summary, t: Floats, levels: tuple[float, ...], si: bool) -> xr.Dataset:
    """Return moments, quantiles and histograms, and counts of how motions ended, as a dataset.

    total: the :class:`Summary`, with at least one histogram for each quantity.
    t: output times, (times,), in the unit of the roller, as many as histograms of a quantity over time.
    levels: levels of the quantiles, in [0, 1].
    si: whether the attributes name the SI units of a cylinder; values are not converted.
    Returns the dataset over t, quantile (``levels``) and status (codes of :class:`MotionStatus`), its coordinates: of
    each quantity the variables of :func:`_variables`; ``ended`` over status, the number of motions with each status, 0
    included, whose attribute ``meanings`` has the messages as "CODE: MESSAGE; ..."; attributes ``failed_motions``, the
    number of those that reached neither the last output time nor rest, and ``motions_from_the_flow_map``.
    """
    import xarray as xr

    data: dict[str, Any] = {}
    for name, histograms in total.histograms.items():
        data |= _variables(name, histograms, levels, si)
    codes = np.array([int(code) for code in MotionStatus], np.int8)
    ended = column_attributes("status") | {
        "long_name": "number of motions with each status", "units": "1",
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
    """Return the variables of one quantity: moments, quantiles, and counts in all bins that hold a value at some time.

    name: name of the quantity, a key of :data:`QUANTITIES`.
    histograms: one :class:`Histogram` for each output time, or one.
    levels: levels of the quantiles, in [0, 1].
    si: whether the attributes name the SI units of a cylinder; values are not converted.
    Returns name of the variable -> (dimensions, values, attributes): NAME_counted, _mean, _std (the root of the mean
    square of the differences from the mean), _min, _max over t, NAME_quantiles over (quantile, t), NAME_histogram over
    (NAME_bin, t), NAME_bin_low and NAME_bin_high over NAME_bin; all without t of a quantity that is one number per
    motion.  At a time without values the moments and quantiles are NaN, and counts 0.  Attributes are long_name and
    units ("1" of counts), of the quantiles also ``comment``, their accuracy.
    """
    about, times = QUANTITIES[name].about(si), ("t",) if QUANTITIES[name].over_time else ()
    bins = np.unique(np.concatenate([one.bins for one in histograms]))
    moments = np.array([[one.count, one.mean, one.spread, one.low, one.high] for one in histograms]).T
    counted, mean, spread, low, high = moments
    below, above = edges_of(bins)
    in_bins = f"{name}_bin"
    parts: dict[str, tuple[tuple[str, ...], NDArray, str]] = {
        "counted": (times, counted.astype(np.int64), "motions that have a value"),
        "mean": (times, mean, "mean"),
        "std": (times, np.sqrt(spread / np.maximum(counted, 1)), "standard deviation"),
        "min": (times, low, "least value"),
        "max": (times, high, "largest value"),
        "quantiles": (("quantile", *times), np.array([one.quantiles(levels) for one in histograms]).T, "quantiles"),
        "histogram": ((in_bins, *times), np.array([one.counts_in(bins) for one in histograms]).T, "motions a bin"),
        "bin_low": ((in_bins,), below, "lower edge of a bin"),
        "bin_high": ((in_bins,), above, "upper edge of a bin"),
    }
    data: dict[str, Any] = {}
    for part, (dims, values, title) in parts.items():
        units = "1" if part in ("counted", "histogram") else about["units"]
        attributes = {"long_name": f"{title} of: {about['long_name']}", "units": units}
        data[f"{name}_{part}"] = dims, values.reshape(values.shape[: len(dims)]), attributes
    exact = any(one.values is not None for one in histograms)
    accuracy = "exact" if exact else "accurate to the width of a bin, at most 0.4 %"
    data[f"{name}_quantiles"][2]["comment"] = accuracy
    return data
