"""What a fit says of a record that was not made: values with bands."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..labels import Labels
from ..results import Row, Shown, Values, short
from .problem import STEP, Problem
from .records import Record

if TYPE_CHECKING:
    import xarray as xr

#: draws that are thrown away, at most, for one that lies within the ranges
_TRIES = 50


class Band(NamedTuple):
    """A quantity at the best values, and the ends of its band."""

    value: Any
    low: Any
    high: Any


class Prediction(Shown):
    """Quantities of a record by name, each with ``.value``, ``.low`` and ``.high``, of the shape of its places.

    record : what was asked for.
    level : what share of bands holds the truth, where the unknowns are determined.
    """

    def __init__(self, record: Record, level: float, bands: dict[str, Band]) -> None:
        self.record, self.level, self._bands = record, level, bands

    def __getattr__(self, name: str) -> Band:
        try:
            return self.__dict__["_bands"][name]
        except KeyError:
            raise AttributeError(f"a {type(self).__name__} has no {name!r}") from None

    def _card(self) -> tuple[str, list[Row]]:
        title = f"Prediction, {self.level:.0%} bands"
        return title, [
            Row(name, short(np.asarray(band.value)), self.record.unit(name)) for name, band in self._bands.items()
        ]

    def to_xarray(self) -> xr.Dataset:
        """Values over the record's places, and V_low, V_high beside V."""
        columns: dict[str, Any] = {}
        units: dict[str, str] = {}
        for name, band in self._bands.items():
            columns |= {name: band.value, f"{name}_low": band.low, f"{name}_high": band.high}
            units |= dict.fromkeys((name, f"{name}_low", f"{name}_high"), self.record.unit(name))
        places = {name: getattr(self.record, name) for name in self.record.PLACES}
        plain = {name: np.asarray(values) for name, values in columns.items()}
        return Values(
            plain, places, units | {name: self.record.unit(name) for name in places}, "Prediction"
        ).to_xarray()


def predicted(
    problem: Problem, record: Record, called: str, u: NDArray[np.float64], cov: NDArray[np.float64], level: float,
    width: float, draws: int, seed: int,
) -> Prediction:  # fmt: skip
    """At coordinates u with covariance cov: by slopes, ``width`` standard deviations to a side, or by draws."""

    def model(at: NDArray[np.float64]) -> dict[str, NDArray[np.float64]]:
        return problem.predicted(record, called, problem.values(at))

    value = model(u)
    ends = _drawn(problem, model, u, cov, level, draws, seed) if draws else _by_slopes(model, value, u, cov, width)
    labelled = _labelled(record.labels)
    return Prediction(record, level, {
        name: Band(*(labelled(name, one) for one in (value[name], *ends[name]))) for name in record.KINDS
    })  # fmt: skip


def _labelled(labels: Labels | None) -> Callable[[str, Any], Any]:
    return (lambda _, values: values) if labels is None else labels.of


def _by_slopes(model: Any, value: dict[str, NDArray], u: NDArray, cov: NDArray, width: float) -> dict[str, Any]:
    slopes = []
    for i in range(u.size):
        up, down = u.copy(), u.copy()
        up[i], down[i] = u[i] + STEP, u[i] - STEP
        high, low = model(up), model(down)
        slopes.append({name: (high[name] - low[name]) / (2.0 * STEP) for name in value})
    found = {}
    for name, middle in value.items():
        J = np.array([one[name] for one in slopes])
        sd = np.sqrt(np.maximum(np.einsum("i...,ij,j...->...", J, cov, J), 0.0))
        found[name] = (middle - width * sd, middle + width * sd)
    return found


def _drawn(
    problem: Problem, model: Any, u: NDArray, cov: NDArray, level: float, draws: int, seed: int
) -> dict[str, Any]:
    rng, kept = np.random.default_rng(seed), []
    many = rng.multivariate_normal(u, cov, draws * _TRIES, method="eigh")
    inside = many[((many >= problem.low) & (many <= problem.high)).all(axis=1)][:draws]
    for at in inside if len(inside) else u[np.newaxis]:
        kept.append(model(at))
    share = 0.5 * (1.0 - level)
    return {name: tuple(np.nanquantile([one[name] for one in kept], (share, 1.0 - share), axis=0)) for name in kept[0]}
