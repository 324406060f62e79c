"""The result of many motions: :class:`Ensemble`."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..contact_law.validity.assumptions import Validity
from ..contact_law.validity.validity import validity
from ..core.array_types import Booleans, Floats, Integers
from ..core.checks import check_array
from ..core.errors import MotionStatus, ParameterError, describe_value
from ..core.labels import Labels
from ..core.results import SummaryRow
from .result import RollResult

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

#: Largest number of motions that ``validity`` examines: some tenths of a second.
_EXAMINED = 256


class Fastest(NamedTuple):
    """Motions of an ensemble and their highest speeds, in the unit of the roller.

    motion : indices of the motions, (m,), int.
    V, omega : largest magnitudes of the speeds that each starts with or reaches at an output time, (m,); omega has the
    sign of the product V0 omega0, and is positive where that is 0.
    """

    motion: Integers
    V: Floats
    omega: Floats


@dataclass(frozen=True, eq=False, repr=False)
class Ensemble(RollResult):
    """Motions 0 ... n - 1 at common output times, in the units of the roller, as of a :class:`Motion`.

    Attributes
    ----------
    roller : the :class:`Scene` or :class:`Cylinder`, on its slope.
    t : output times, (times,), divided by T_ref or in s.
    V, omega, x, angle, delta, regime : shape (n, times), in the units of a :class:`Motion`; those not requested are
        None.  Codes of the regime are those of a :class:`Motion` as floats, NaN where it was not reached.
    slip_loss, rolling_loss : likewise, the energy lost since t = 0, divided by m (R/T_ref)^2 or in J/m: the integrals
        of gamma (omega - V) Q >= 0 and of gamma (V + omega) M/2 over time.  Without a drive their sum is what (V^2 + j
        omega^2)/2 has fallen by (at rest: all of it).
    force, torque, work_force, work_torque, brake_loss : likewise, as of a :class:`Motion`; 0 without a drive.
    onset_time : (n,), first change from full to partial slip; NaN if there is none.
    rest_time : (n,), when max(|V|, R |omega|) fell below ``rest``; NaN if it did not.
    success, status : (n,), whether each reached the last output time or rest, and the code of its
        :class:`MotionStatus`; outputs that a motion did not reach are NaN.
    switches, steps : (n,), changes of regime, and integration steps taken.
    flow : (n,), whether the motion is from the flow map; the others were integrated.
    flow_error : stated error of the map relative to max(|V|, |omega|), or, with ``x`` or
        ``angle`` among the fields, that relative to the path if larger, or, with a loss, that
        relative to the energy at the start if larger; NaN without a map.
    flow_problem : why a map that was tried could not be used, or "".
    drive_error : as of a :class:`Motion`.
    drive : loads and prescribed speeds as they were given.
    labels : labels of the starts and loads, where they came as arrays of xarray or pandas; :meth:`to_xarray` has them.

    Examples
    --------
    >>> import viscoroll as vr
    >>> result = vr.ensemble(vr.presets.RUBBER_CYLINDER, [1.0, 2.0], [10.0, 20.0], 1.0)
    >>> len(result), bool(result.success.all())
    (2, True)
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
        """How the motions ended, in words."""
        return "; ".join(f"{count}: {text}" for text, count in self.messages().items())

    def messages(self) -> dict[str, int]:
        """Return the number of motions that ended in each way, by the way in words.

        Returns
        -------
        dict
            Message of a :class:`MotionStatus` -> number of motions, > 0; empty without motions.

        Examples
        --------
        >>> import viscoroll as vr
        >>> vr.ensemble(vr.presets.RUBBER_CYLINDER, [1.0, 2.0], [10.0, 20.0], 1.0).messages()
        {'reached the last output time': 2}
        """
        codes, counts = np.unique(self.status, return_counts=True)
        return {MotionStatus(code).message: int(n) for code, n in zip(codes, counts, strict=True)}

    def summary(self, quantiles: Iterable[float] = (0.05, 0.25, 0.5, 0.75, 0.95)) -> xr.Dataset:
        """Compute moments, quantiles and histograms over the motions, per output time, named as those of a run's store.

        Parameters
        ----------
        quantiles : levels of the quantiles, numbers in [0, 1], in any order.

        Returns
        -------
        xarray.Dataset
            In the units of the roller.  Of every field kept but the regime, with x also of ``distance``, |x|, and of
            onset_time and rest_time, which have no axis t: over t ``NAME_counted``, the number of motions with a finite
            value, ``_mean``, ``_std`` (divided by that number), ``_min`` and ``_max`` of these values;
            ``_quantiles`` over (quantile, t), exact; ``_histogram`` over (NAME_bin, t), whose bins run from
            ``NAME_bin_low`` to ``NAME_bin_high``.  Without finite values they are NaN, counts 0.  ``ended`` over
            status: how many motions have each :class:`MotionStatus`.  Attributes: ``motions``, ``failed_motions`` and
            ``motions_from_the_flow_map``, numbers of motions; Conventions, title, source.

        Raises
        ------
        ParameterError
            If there are no motions, or ``quantiles`` is no list of numbers in [0, 1].

        Examples
        --------
        >>> import viscoroll as vr
        >>> motions = vr.ensemble(vr.presets.RUBBER_CYLINDER, [1.0, 2.0], [10.0, 20.0], 1.0)
        >>> motions.summary(quantiles=[0.5])["V_quantiles"].dims
        ('quantile', 't')
        """
        from .summaries import summary_of

        values: Any = list(quantiles) if isinstance(quantiles, Iterator) else quantiles
        levels = check_array("quantiles", values, low=0.0, high=1.0)
        if levels.ndim != 1:
            raise ParameterError("quantiles", describe_value(quantiles), "a list of numbers")
        return summary_of(self, tuple(levels.tolist()))

    def validity(self) -> Validity:
        """Report which assumptions of the model the motions violate, at the highest speeds of each.

        See :func:`viscoroll.validity`.  ``steady`` examines the start speed and all output times of a motion; without V
        among the fields its highest speed alone, and of a cover it is not decided.

        Returns
        -------
        Validity
            The report, with arrays over the motions, (n,); for more than 256 over that many of them, evenly spaced
            (:meth:`fastest`).

        Examples
        --------
        >>> import viscoroll as vr
        >>> motions = vr.ensemble(vr.presets.RUBBER_CYLINDER, [1.0, 2.0], [10.0, 20.0], 1.0)
        >>> motions.validity().steady.holds.shape
        (2,)
        """
        index, V, omega = self.fastest()
        roller = self.roller.take(index, len(self))
        report = validity(roller, V, omega=omega)
        if self.V is None or not index.size or roller.scene().cover is not None:
            return report
        speeds = np.vstack([self.V0[index], self.V[index].T])
        rolls = ~(np.append(0.0, self.t)[:, np.newaxis] < self.onset_time[index]) & ~np.isnan(speeds)
        x = np.full(speeds.shape, np.nan) if self.x is None else np.vstack([np.zeros(index.size), self.x[index].T])
        return self._add_steadiness(report, roller, np.nan_to_num(speeds), rolls, x, ends=True)

    def fastest(self) -> Fastest:
        """Return the motions that :meth:`validity` examines, with their highest speeds.

        These are all motions, or, of more than 256, as many as that, evenly spaced.  The highest speed is the largest
        magnitude of the start and of the output times that the motion reached; of a speed that is not among the fields,
        that of the start.

        Returns
        -------
        Fastest
            Named tuple of arrays (m,), m <= 256: ``motion``, indices of the motions, ascending; ``V``, >= 0, and
            ``omega``, in the unit of the roller.  omega has the sign of V0 omega0, and is positive where that is 0.

        Examples
        --------
        >>> import viscoroll as vr
        >>> motions = vr.ensemble(vr.presets.RUBBER_CYLINDER, [1.0, 2.0], [10.0, 20.0], 1.0)
        >>> motions.fastest().V
        array([1., 2.])
        """
        speeds = {name: np.abs(getattr(self, f"{name}0")) for name in ("V", "omega")}
        for name, start in speeds.items():
            if (values := getattr(self, name)) is not None:
                speeds[name] = np.fmax(start, np.nanmax(np.abs(values), axis=1, initial=0.0, where=~np.isnan(values)))
        index = np.unique(np.linspace(0, len(self) - 1, min(len(self), _EXAMINED)).astype(np.int64))
        sense = self.V0 * self.omega0 + 0.0  # +0 from rest: friction moves the axis in the sense of the rotation
        return Fastest(index, speeds["V"][index], np.copysign(speeds["omega"], sense)[index])

    def _summary(self) -> tuple[str, list[SummaryRow]]:
        """Return title and rows of the printed report, a list of :class:`SummaryRow`.

        The rows are: output times; median, 5 % and 95 % quantile of the last V, omega and x, of those that are fields,
        over the motions that reached the last time, NaN if none did, left out if there are no motions; number of
        motions with an onset of partial slip; number of motions from the flow map and its stated error, if any; how
        many motions ended in which way, a row each.
        """
        ends = [SummaryRow("ended", f"{count}: {message}") for message, count in self.messages().items()]
        rows = [self._row_of_times()]
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
        """Return the dataset over (motion, t) with starts, outputs, onset and rest times, status, drive and scene.

        Returns
        -------
        xarray.Dataset
            In the units of the roller, alpha, kappa, mu, gamma and j dimensionless.  Fields that were not requested are
            left out; labels of the starts become coordinates of the axis "motion", called given_NAME where a variable
            has their name.  Over motion it has V0, omega0, onset_time, rest_time, status and flow; alpha, kappa, mu,
            gamma, j and the drive are without axis where one was given for all motions.
            :func:`.export.ensemble_dataset` states the attributes.

        Examples
        --------
        >>> import viscoroll as vr
        >>> motions = vr.ensemble(vr.presets.RUBBER_CYLINDER, [1.0, 2.0], [10.0, 20.0], 1.0)
        >>> motions.to_xarray()["V"].dims
        ('motion', 't')
        """
        from .export import ensemble_dataset

        return ensemble_dataset(self)

    def _figure(self) -> Figure:
        """Return the figure of quantiles over time and of the last values: of speeds, distance and angle."""
        from ..core.plots import draw
        from .summaries import drawn_summary

        return draw(drawn_summary(self.to_xarray()))
