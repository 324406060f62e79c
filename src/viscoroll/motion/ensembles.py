"""Many motions at once: :func:`ensemble`, and their result, :class:`Ensemble`."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterable, Iterator
from typing import Any, Literal, NamedTuple

import numpy as np

from ..contact_mechanics import (
    FASTEST,
    Roller,
    Validity,
    refuse_beyond,
    scale_of,
    validity,
    warn_of_speeds,
)
from ..core import (
    Booleans,
    Dataset,
    Feedback,
    Figure,
    Floats,
    Integers,
    Labels,
    MotionStatus,
    NDArray,
    Numbers,
    ParameterError,
    Schedule,
    SummaryRow,
    broadcast_shape,
    broadcast_vector,
    check_array,
    check_bool,
    check_choice,
    check_names,
    check_number,
    describe_value,
    shape_error,
    thread_count,
)
from .flow import FlowResult
from .many_motions import Batch, solve_batch
from .motion_arguments import ACTING, ROWS, Drive, output_times, strip_units, with_scales
from .motion_datasets import RollResult, ensemble_dataset
from .motion_problem import MotionProblem, SolverOptions, make_problem
from .summaries import LEVELS, drawn_summary, ensemble_summary

# --- The result of many motions ---

#: Largest number of motions that ``validity`` examines: some tenths of a second.
_EXAMINED = 256


class Fastest(NamedTuple):
    """Motions of an ensemble and their highest speeds, in the unit of the roller.

    motion : indices of the motions, (m,), int.
    V, omega : largest magnitudes of the speeds that each starts with or reaches at an output time,
    (m,); omega has the sign of the product V0 omega0, and is positive where that is 0.
    """

    motion: Integers
    V: Floats
    omega: Floats


@dataclasses.dataclass(frozen=True, eq=False, repr=False)
class Ensemble(RollResult):
    """Motions 0 ... n - 1 at common output times, in the units of the roller, as for a
    :class:`Motion`.

    Attributes
    ----------
    roller : the :class:`Scene` or :class:`Cylinder`, on its slope.
    t : output times, (times,), divided by T_ref or in s.
    V, omega, x, angle, delta, regime : shape (n, times), in the units of a :class:`Motion`; those
        not requested are None.  Codes of the regime are those of a :class:`Motion` as floats, NaN
        where it was not reached.
    slip_loss, rolling_loss : likewise, the energy lost since t = 0, divided by m (R/T_ref)^2 or in
        J/m: the integrals of gamma (omega - V) Q >= 0 and of gamma (V + omega) M/2 over time.
        Without a drive their sum is what (V^2 + j omega^2)/2 has fallen by (at rest: all of it).
    force, torque, work_force, work_torque, brake_loss : likewise, as in a :class:`Motion`; 0
        without a drive.
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
    drive_error : as in a :class:`Motion`.
    drive : loads and prescribed speeds as they were given.
    labels : labels of the starts and loads, where they came as arrays of xarray or pandas;
        :meth:`to_xarray` has them.

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
    labels: Labels | None

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
        return {MotionStatus(code).message: int(n) for code, n in zip(codes, counts)}

    def summary(self, quantiles: Iterable[float] = LEVELS) -> Dataset:
        """Compute moments, quantiles and histograms over the motions, per output time, named as
        those of a run's store.

        Parameters
        ----------
        quantiles : levels of the quantiles, numbers in [0, 1], in any order.

        Returns
        -------
        xarray.Dataset
            In the units of the roller.  Of every field kept but the regime, with x also of
            ``distance``, |x|, and of onset_time and rest_time, which have no axis t: over t
            ``NAME_counted``, the number of motions with a finite value, ``_mean``, ``_std``
            (divided by that number), ``_min`` and ``_max`` of these values; ``_quantiles`` over
            (quantile, t), exact; ``_histogram`` over (NAME_bin, t), whose bins run from
            ``NAME_bin_low`` to ``NAME_bin_high``.  Without finite values they are NaN, counts 0.
            ``ended`` over status: how many motions have each :class:`MotionStatus`.  Attributes:
            ``motions``, ``failed_motions`` and ``motions_from_the_flow_map``, numbers of motions;
            Conventions, title, source.

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
        values: Any = list(quantiles) if isinstance(quantiles, Iterator) else quantiles
        levels = check_array("quantiles", values, low=0.0, high=1.0)
        if levels.ndim != 1:
            raise ParameterError("quantiles", describe_value(quantiles), "a list of numbers")
        return ensemble_summary(self, tuple(levels.tolist()))

    def validity(self) -> Validity:
        """Report which assumptions of the model the motions violate, at the highest speeds of each.

        See :func:`viscoroll.validity`.  ``steady`` examines the start speed and all output times of
        a motion, or, without V among the fields, its highest speed alone; ``steady`` is undecided
        on a cover.

        Returns
        -------
        Validity
            The report, with arrays over the motions, (n,); for more than 256 over that many of
            them, evenly spaced (:meth:`fastest`).

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
        # mask of the times out of full slip; of a motion without onset, NaN, all times are True
        rolls = ~(np.append(0.0, self.t)[:, None] < self.onset_time[index]) & ~np.isnan(speeds)
        x = (
            np.full(speeds.shape, np.nan)
            if self.x is None
            else np.vstack([np.zeros(index.size), self.x[index].T])
        )
        return self._add_steadiness(report, roller, np.nan_to_num(speeds), rolls, x, ends=True)

    def fastest(self) -> Fastest:
        """Return the motions that :meth:`validity` examines, with their highest speeds.

        These are all motions, or, of more than 256, as many as that, evenly spaced.  The highest
        speed is the largest magnitude of the start and of the output times that the motion reached;
        of a speed that is not among the fields, that of the start.

        Returns
        -------
        Fastest
            Named tuple of arrays (m,), m <= 256: ``motion``, indices of the motions, ascending;
            ``V``, >= 0, and ``omega``, in the unit of the roller.  omega has the sign of V0 omega0,
            and is positive where that is 0.

        Examples
        --------
        >>> import viscoroll as vr
        >>> motions = vr.ensemble(vr.presets.RUBBER_CYLINDER, [1.0, 2.0], [10.0, 20.0], 1.0)
        >>> motions.fastest().V
        array([1., 2.])
        """

        def highest(start: Floats, values: Floats | None) -> Floats:
            if values is None:
                return np.abs(start)
            return np.fmax(np.abs(start), np.fmax.reduce(np.abs(values), axis=1))

        index = np.linspace(0, len(self) - 1, min(len(self), _EXAMINED)).astype(np.int64)
        # +0 from rest: friction moves the axis in the sense of the rotation
        omega = np.copysign(highest(self.omega0, self.omega), self.V0 * self.omega0 + 0.0)
        return Fastest(index, highest(self.V0, self.V)[index], omega[index])

    def _summary(self) -> tuple[str, list[SummaryRow]]:
        """Return title and rows of the printed report, a list of :class:`SummaryRow`.

        The rows are: output times; median, 5 % and 95 % quantile of the last V, omega and x, of
        those that are fields, over the motions that reached the last time, NaN if none did, left
        out if there are no motions; number of motions with an onset of partial slip; number of
        motions from the flow map and its stated error, if any; how many motions ended in which way,
        a row each.
        """
        rows = [self._row_of_times()]
        for name in ("V", "omega", "x"):
            if (values := self[name]) is not None and values.size:
                last = values[:, -1][np.isfinite(values[:, -1])]
                low, middle, high = (
                    np.quantile(last, (0.05, 0.5, 0.95)) if last.size else [np.nan] * 3
                )
                text = (
                    f"at the last time: median {middle:.6g}, 90 % of the motions between {low:.6g} "
                    f"and {high:.6g}"
                )
                rows.append(SummaryRow(name, text, self._unit(name)))
        rows.append(
            SummaryRow(
                "onset of partial slip", f"in {np.isfinite(self.onset_time).sum()} of the motions"
            )
        )
        if self.flow.any():
            rows.append(
                SummaryRow(
                    "by flow map",
                    f"{self.flow.sum()} of the motions, stated error {self.flow_error:.2g}",
                )
            )
        rows += [
            SummaryRow("ended", f"{count}: {message}") for message, count in self.messages().items()
        ]
        return f"Ensemble of {len(self)} motion{'s' * (len(self) != 1)}", rows

    def to_xarray(self) -> Dataset:
        """Return the dataset over (motion, t) with starts, outputs, onset and rest times, status,
        drive and scene.

        Returns
        -------
        xarray.Dataset
            In the units of the roller, alpha, kappa, mu, gamma and j dimensionless.  Fields that
            were not requested are left out; labels of the starts become coordinates of the axis
            "motion", called given_NAME where a variable has their name.  Over motion it has V0,
            omega0, onset_time, rest_time, status and flow; alpha, kappa, mu, gamma, j and the drive
            are without axis where one was given for all motions.
            :func:`.motion_datasets.ensemble_dataset` states the attributes.

        Examples
        --------
        >>> import viscoroll as vr
        >>> motions = vr.ensemble(vr.presets.RUBBER_CYLINDER, [1.0, 2.0], [10.0, 20.0], 1.0)
        >>> motions.to_xarray()["V"].dims
        ('motion', 't')
        """
        return ensemble_dataset(self)

    def _figure(self) -> Figure:
        """Return the figure of quantiles over time and of the last values: of speeds, distance and
        angle.
        """
        from ..core.plots import draw

        return draw(drawn_summary(self.to_xarray()))


# --- Many motions at once ---

#: A function of time of each motion.
Function = Numbers | Schedule | Callable[[float], float]
#: Fields that an ensemble may keep.
FIELDS = ROWS


def ensemble(
    roller: Roller,
    V0: Numbers | None,
    omega0: Numbers | None,
    t: Numbers,
    *,
    force: Function | Feedback | None = None,
    torque: Function | Feedback | None = None,
    slope: Numbers | None = None,
    brake: Function | None = None,
    drag: Numbers | None = None,
    omega: Function | None = None,
    V: Function | None = None,
    method: Literal["auto", "flow", "integrate"] = "auto",
    rtol: float = 1e-8,
    rest: float | None = None,
    unsteady: bool = False,
    rested: bool | float = False,
    fields: Iterable[str] = ("V", "omega", "x"),
    max_steps: int = 100_000,
    resolve: float | None = None,
    speed: float | None = None,
    threads: int | None = None,
    progress: bool = False,
) -> Ensemble:
    """Compute the motions of n cylinders or n starts; the result has the same bits for any number
    of threads.

    Parameters
    ----------
    roller : a :class:`Scene`, or a :class:`Cylinder` in SI units; its numbers may be arrays of n
        too: every motion can have a scene of its own.  The unit of time T_ref of a scene is
        T_epsilon of an ``alpha``, else that of its material.
    V0, omega0 : start speeds, numbers or arrays (n,), divided by R/T_ref and 1/T_ref, or in m/s and
        rad/s; None where they are prescribed.  Labels of xarray and pandas come back in
        ``to_xarray``; those of the roller's numbers and of the fields of a Schedule or a Feedback
        are not compared with them: such arrays are taken in their order.
    t : output times, (times,), >= 0, ascending, common to all, divided by T_ref or in s; one
        number: the final state only.
    force, torque, slope, brake, drag, omega, V : loads and prescribed speeds, as for :func:`roll`;
        numbers may be arrays (n,), times and values of a :class:`Schedule` of shape (n, k).
    method : "integrate": each motion as :func:`roll` would, bit for bit if all have one
        material (covers also one load, radius and slope), else to the error of ``rtol``.  "flow":
        look the motions up in the flow map of their one scene, which is built if it is not on disk
        yet.  "auto": "flow" for 4096 motions or more of one scene.  The map is used only
        where its stated error is at most ``rtol``, and only for the motions that it contains;
        all others are integrated, with "flow" too.  The result says which, and the map's error.
        Driven and unsteady motions, and those of bodies that differ, of covers or of a grid, are
        integrated: "flow" is refused.
    rtol, rest, unsteady, rested, max_steps, resolve : as for :func:`roll`; ``V0`` and ``omega0`` of
        the result are those after the cost of a standstill.  With a material each an unsteady
        motion takes some milliseconds more, for its N.
    fields : names of the quantities to compute, out of ``V omega x angle delta regime slip_loss
        rolling_loss``, and ``force torque work_force work_torque brake_loss``; only these are kept
        in memory.  Works and losses are good to some rtol of the energy that moves.
    speed : highest speed, > 0, in the unit of V0, that the flow map is made for; default the
        largest of the starts.  Where a large ensemble is computed in several calls, one number for
        all makes the
        bits independent of how it is divided.  Ignored where no flow map is used.
    threads : threads to use, >= 1; None: ``$VISCOROLL_THREADS``, or where that is not set the cores
        available.
    progress : draw a progress bar on standard error if the call takes longer than a second.

    Returns
    -------
    Ensemble
        Its ``fields``, (n, times) each, in the units of the roller; the others are None.

    Raises
    ------
    ParameterError
        NaN or infinite input, unsorted times, shapes that do not broadcast to (n,),
        unknown fields or method; method "flow" with parameters that differ between motions, with a
        drive, with ``unsteady``, with bodies that differ, a cover or a grid; arrays with labels
        beside arrays without, or with other labels; a number of threads that is no whole
        number >= 1; what :func:`roll` refuses.
    Exception
        What a callable raises.

    Warns
    -----
    ModelWarning
        Where starts or speeds violate assumptions of the model grossly.
    RuntimeWarning
        Where a flow map on disk is damaged; it is built again.

    Examples
    --------
    >>> import numpy as np, viscoroll as vr
    >>> V0 = np.linspace(1.0, 2.0, 5)
    >>> result = vr.ensemble(vr.presets.RUBBER_CYLINDER, V0, V0 / 0.1, [0.5, 1.0])
    >>> result.V.shape
    (5, 2)

    Notes
    -----
    The flow map has no entry for scenes in which full slip returns or rolling resistance can
    hold the sliding cylinder (mu below about M/2), for alpha = 1, and for motions that stick
    at speeds 10^6 times below the highest (``tests/motion/test_flow.py``).

    Nothing is raised where a motion cannot be rolled to the end: its ``status`` says so, its
    outputs from there on are NaN, and :meth:`Ensemble.messages` counts such motions.

    Beside float64 input and its result a call takes a few megabytes, whatever the number of
    motions (``tests/test_invariance.py``).
    """
    units = scale_of(roller)
    times = output_times(t, units)
    names = check_names("fields", fields, FIELDS, "a field")
    check_choice("method", method, "auto", "flow", "integrate")
    start, drive, labels = strip_units(
        (V0, omega0),
        Drive(force=force, torque=torque, slope=slope, brake=brake, drag=drag, omega=omega, V=V),
        units,
    )
    if speed is not None:
        speed = check_number("speed", speed, unit=units, above=0.0) / units["speed"]
    problem = make_problem(
        roller,
        start,
        drive,
        times[-1],
        SolverOptions(
            rtol=rtol,
            rest=rest,
            max_steps=max_steps,
            resolve=resolve,
            unsteady=unsteady,
            rested=rested,
        ),
    )
    inputs, count = _broadcast_inputs(problem, drive.numbers)
    problem.warn_of_start(start)
    scale = problem.roller.scale
    law: Any = problem.scene.rolling_law
    # a table of another program ends at a speed; those of the package do not
    ends = law is not None and law.coupled is not None and law.coupled.fastest < FASTEST
    if ends and "V" not in names:
        names = (*names, "V")
    batch = Batch(
        problem=problem,
        inputs=inputs,
        immobile=np.broadcast_to(problem.immobile, (count,)),
        times=times / scale["t"],
        rows=names if problem.drive.acts else tuple(name for name in names if name not in ACTING),
        threads=thread_count(threads),
        progress="motions" if check_bool("progress", progress) else None,
    )
    try:
        found, about = solve_batch(batch, method, speed)
    except ParameterError as error:
        raise with_scales(error, scale) from error
    if ends:
        kappa = np.reshape(inputs["kappa"], (-1, 1))
        for V in (np.reshape(inputs["V0"], (-1, 1)), found.out[batch.rows.index("V")]):
            refuse_beyond(law, kappa * np.abs(np.nan_to_num(V)))
    # None: not requested; 0: loads and works of free motions, which no kernel computes
    columns: dict[str, Any] = (
        dict.fromkeys(FIELDS)
        | {name: np.zeros((count, times.size)) for name in names}
        | _in_units(batch, found)
        | about
    )
    result = Ensemble(roller=problem.roller, t=times, drive=problem.drive, labels=labels, **columns)
    warn_of_speeds(problem.roller, start[0], result.V)
    return result


def _broadcast_inputs(
    problem: MotionProblem, drives: dict[str, NDArray]
) -> tuple[dict[str, NDArray], int]:
    """Broadcast the parameters and start speeds of an ensemble to the number of its motions.

    problem: :class:`MotionProblem`, checked motions of the ensemble; scene, V0, omega0 and
        functions are read.
    drives: name -> loads or prescribed speeds that are numbers or arrays, as the caller gave them;
    only their shapes matter.
    Returns (name -> read-only vector, (1,) where one value holds for all motions, else (n,): alpha,
    kappa, mu, gamma, j, V0, omega0, dimensionless; n, which is 1 if all are numbers).
    Raises ParameterError where they, the functions of the drive included, do not broadcast to (n,).
    """
    inputs = problem.scene.numbers | {"V0": problem.V0, "omega0": problem.omega0}
    arrays = {name: np.asarray(value) for name, value in inputs.items()}
    # stand-ins with as many entries as the drive has motions, for the shapes alone
    counts = zip(("functions of the drive", "gains and drag"), problem.functions.counts)
    own = {name: np.zeros(n) for name, n in counts if n > 1}
    shape = broadcast_shape(**arrays, **drives, **own)
    if len(shape) > 1:
        name, array = next((n, x) for n, x in (drives | arrays).items() if x.ndim > 1)
        # the numbers of the scene have other names than those of its cylinder
        name = "an array of the roller" if name in problem.scene.numbers else name
        raise shape_error(name, array.shape, "a number or a vector (n,)")
    count = shape[0] if shape else 1
    return {name: broadcast_vector(array, (count,)) for name, array in arrays.items()}, count


def _in_units(batch: Batch, found: FlowResult) -> dict[str, Any]:
    """Convert the motions of an ensemble to the fields of :class:`Ensemble`, in the units of its
    roller.

    batch: :class:`Batch`, motions of the ensemble, of which problem, inputs and rows are read.
    found: :class:`.flow.FlowResult`, dimensionless; of a cylinder its quantities are overwritten
        by those in SI units.
    Returns name -> field: quantities (n, times) by their names in :attr:`Batch.rows`, which are
    views of those of ``found``, NaN at times that a motion did not reach; onset_time, rest_time
    (NaN where there is none), V0 and omega0, read-only, status (codes of :class:`MotionStatus`),
    switches, (n,); drive_error, a float, which stays dimensionless.
    """
    scale = batch.problem.roller.scale
    rows = dict(zip(batch.rows, found.out, strict=True))
    times = {
        "onset_time": found.onset,
        "rest_time": found.rest,
        "V0": batch.inputs["V0"],
        "omega0": batch.inputs["omega0"],
    }
    if scale.si:
        for name in rows:
            # a unit for each motion is a column; in place, as the rows may fill the memory
            rows[name] *= np.reshape(scale[name], (-1, 1))
        times = {name: value * scale[name] for name, value in times.items()}
    times = {name: np.broadcast_to(value, found.status.shape) for name, value in times.items()}
    notes = {"status": found.status, "switches": found.switches}
    return rows | times | notes | {"drive_error": batch.problem.functions.error}
