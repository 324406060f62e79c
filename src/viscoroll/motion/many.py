"""Many motions as they are given back: :class:`Ensemble`."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ..contact_law.assumptions import Validity
from ..contact_law.judged import validity
from ..contact_law.steadiness import Steadiness
from ..core.array_types import Booleans, Floats, Integers
from ..core.checks import check_array
from ..core.errors import MotionStatus, ParameterError, describe_value
from ..core.labels import Labels
from ..core.results import SummaryRow
from .result import Rolled

if TYPE_CHECKING:
    import xarray as xr

#: motions that validity looks at
_JUDGED = 256


@dataclass(frozen=True, eq=False, repr=False)
class Ensemble(Rolled):
    """Motions 0 ... n - 1 at common output times, in the units of what rolled, as of a :class:`Motion`.

    Attributes
    ----------
    roller : what rolled, on its slope.
    t : output times.
    V, omega, x, angle, delta, regime : shape (n, len(t)); those not asked for are None.
    slip_loss, rolling_loss : likewise, the energy lost since t = 0, over m (R/T_epsilon)^2 or in J/m: the integrals of
        gamma (omega - V) Q >= 0 and of gamma (V + omega) M/2 over time.  Their sum is what
        (V^2 + j omega^2)/2 has fallen by (at rest: all of it).
    force, torque, work_force, work_torque, brake_loss : likewise, as of a :class:`Motion`; 0 without a drive.
    onset_time : (n,), first change from full to partial slip; NaN if there is none.
    rest_time : (n,), when max(|V|, R |omega|) fell below ``rest``; NaN if it did not.
    success, status : (n,), whether each came to its end, and its :class:`MotionStatus`; outputs a motion did not reach
        are NaN.
    switches, steps : (n,), changes of regime, and integration steps taken.
    flow : (n,), whether the flow map gave this motion; the others were integrated.
    flow_error : stated error of the map relative to max(|V|, |omega|), or, with ``x`` or
        ``angle`` among the fields, that relative to the path if larger, or, with a loss, that
        relative to the energy at the start if larger; NaN without a map.
    flow_problem : why a map that was tried could not be used, or "".
    drive_error : as of a :class:`Motion`.
    drive : what was given to drive them.
    labels : of the starts and loads, where they came as arrays of xarray or pandas; :meth:`to_xarray` has them.
    """

    V0: Floats
    omega0: Floats
    flow: Booleans
    flow_error: float
    flow_problem: str
    labels: Labels | None = None

    def __len__(self) -> int:
        return self.status.size

    @property
    def message(self) -> str:
        """How they ended, in words."""
        return "; ".join(f"{count}: {text}" for text, count in self.messages().items())

    def messages(self) -> dict[str, int]:
        """How many motions ended in which way, in words."""
        codes, counts = np.unique(self.status, return_counts=True)
        return {MotionStatus(code).message: int(n) for code, n in zip(codes, counts, strict=True)}

    def summary(self, quantiles: Iterable[float] = (0.05, 0.25, 0.5, 0.75, 0.95)) -> xr.Dataset:
        """Moments, quantiles and histograms over the motions, per output time, named as those of a run's store.

        Parameters
        ----------
        quantiles : in [0, 1].

        Returns
        -------
        xarray.Dataset
            Of every field kept but the regime, of onset_time and rest_time: ``NAME_counted`` (motions that have a
            value: outputs that one did not reach do not count), ``_mean``, ``_std``, ``_min``, ``_max``, ``_quantiles``
            over (quantile, t), which are exact, those of a run to their bin (``comment``), and ``_histogram`` over
            ``_bin_low``, ``_bin_high``.  ``ended``: how many motions ended in which way.

        Raises
        ------
        ParameterError
            If there are no motions, or quantiles are none.
        """
        from .summaries import summary_of

        given: Any = list(quantiles) if isinstance(quantiles, Iterator) else quantiles
        levels = check_array("quantiles", given, low=0.0, high=1.0)
        if levels.ndim != 1:
            raise ParameterError("quantiles", describe_value(quantiles), "a list of numbers")
        return summary_of(self, tuple(levels.tolist()))

    def validity(self) -> Validity:
        """Which assumptions of the model the motions strain, at the highest speeds that they start with or reach.

        ``steady`` looks at all speeds on the way.  See :func:`viscoroll.validity`; arrays over the motions, of more
        than 256 over that many of them, evenly picked.
        """
        some, V, omega = self.judged()
        roller = self.roller.some(some, len(self))
        scene, scale = roller.scene(), roller.scale
        found = validity(roller, V, omega=omega)
        if self.V is None or not some.size or scene.cover is not None:
            return found
        speeds = np.vstack([self.V0[some], self.V[some].T])
        rolls = ~(np.append(0.0, self.t)[:, np.newaxis] < self.onset_time[some]) & ~np.isnan(speeds)
        x = np.full(speeds.shape, np.nan) if self.x is None else np.vstack([np.zeros(some.size), self.x[some].T])
        free = scene.freely(np.nan_to_num(speeds / scale["V"])).scaled(scale)
        return found._replace(steady=Steadiness.along(free, rolls, x, ends=True))

    def judged(self) -> tuple[Integers, Floats, Floats]:
        """Which motions :meth:`validity` looks at, and the highest V and omega that they start with or reach."""
        fastest = {name: np.abs(getattr(self, f"{name}0")) for name in ("V", "omega")}
        for name, found in fastest.items():
            if (values := getattr(self, name)) is not None:
                fastest[name] = np.fmax(found, np.nanmax(np.abs(values), axis=1, initial=0.0, where=~np.isnan(values)))
        some = np.unique(np.linspace(0, len(self) - 1, min(len(self), _JUDGED)).astype(np.int64))
        return some, fastest["V"][some], np.copysign(fastest["omega"], self.V0 * self.omega0)[some]

    def _summary(self) -> tuple[str, list[SummaryRow]]:
        ends = [SummaryRow("ended", f"{count}: {message}") for message, count in self.messages().items()]
        rows = [self._times()]
        for name in ("V", "omega", "x"):
            if (values := getattr(self, name)) is not None and values.size:
                last = values[:, -1][np.isfinite(values[:, -1])]
                low, middle, high = np.quantile(last, (0.05, 0.5, 0.95)) if last.size else [np.nan] * 3
                text = f"at the end: median {middle:.6g}, 5 % {low:.6g}, 95 % {high:.6g}"
                rows.append(SummaryRow(name, text, self._unit(name)))
        rows.append(SummaryRow("onset of partial slip", f"in {np.isfinite(self.onset_time).sum()}"))
        if self.flow.any():
            rows.append(SummaryRow("by the flow map", f"{self.flow.sum()}, stated error {self.flow_error:.2g}"))
        return f"Ensemble of {len(self)} motions", rows + ends

    def to_xarray(self) -> xr.Dataset:
        """Dataset over (motion, t) with starts, outputs, onset and status."""
        from .export import ensemble_dataset

        return ensemble_dataset(self)
