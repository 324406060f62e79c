"""Common data of one motion and of an ensemble (:class:`RollResult`), and both as xarray datasets
with names, units and provenance.
"""

from __future__ import annotations

import dataclasses
from typing import Any, NamedTuple

import numpy as np

from .. import __version__
from ..contact_mechanics import PARAMETERS, FreeRolling, Parameters, Roller, Steadiness, Validity
from ..core import (
    Dataset,
    Feedback,
    Floats,
    MotionStatus,
    NDArray,
    Result,
    Scale,
    Schedule,
    SummaryRow,
    attributes,
    format_value,
    unit_of,
)
from ..materials import Bodies, Cover, Prony
from .motion_arguments import ROWS, STATES, Drive

# --- Common data of one motion and of an ensemble ---


class Switch(NamedTuple):
    """A change of regime.

    t : when, in the unit of the roller.
    regime : the new regime, a name of :data:`.roll.REGIMES`.
    """

    t: float
    regime: str


@dataclasses.dataclass(frozen=True, eq=False, repr=False)
class RollResult(Result):
    """The data that :class:`Motion` and :class:`Ensemble` have in common: the roller, its drive,
    and the rows over the output times.

    The two classes describe the fields.
    """

    roller: Roller
    drive: Drive
    t: Floats
    V: Floats
    omega: Floats
    x: Floats
    angle: Floats
    delta: Floats
    regime: Any
    force: Floats
    torque: Floats
    work_force: Floats
    work_torque: Floats
    brake_loss: Floats
    slip_loss: Floats
    rolling_loss: Floats
    onset_time: Any
    rest_time: Any
    status: Any
    steps: Any
    switches: Any
    drive_error: float

    @property
    def scene(self) -> Parameters:
        """The dimensionless scene, on its slope."""
        return self.roller.scene()

    @property
    def scale(self) -> Scale:
        """1 of each dimensionless quantity: in SI units for a cylinder."""
        return self.roller.scale

    @property
    def success(self) -> Any:
        """Whether the motion reached the last output time, or rest; of an ensemble for each
        motion.
        """
        return self.status <= MotionStatus.RESTED

    def _add_steadiness(
        self, report: Validity, roller: Roller, V: Floats, rolls: Any, x: Any, *, ends: bool
    ) -> Validity:
        """Add to a report whether the law of steady rolling may drive the motions, as its entry
        ``steady``.

        report: :class:`Validity` of the states of the motions.
        roller: :class:`Scene` or :class:`Cylinder` of the motions, with gamma; not one with a
            cover, for which ParameterError is raised.  Its ``scene()`` and ``scale`` are read.
        V: speeds in its unit, (times, ...).
        rolls: mask, True where the motions are not in full slip, (times, ...).
        x: distances travelled, in the unit of the roller, (times, ...); NaN where they are not
        known.
        ends: whether the unsteadiness is that of each motion as a whole, (...); else it is the
        largest so far at each time, (times, ...).
        Returns a new report with that entry.
        """
        free = FreeRolling.of_scene(roller.scene(), V / roller.scale["V"]).scaled(roller.scale)
        return report._replace(steady=Steadiness.along(free, rolls, x, ends=ends))

    def _unit(self, name: str) -> str:
        """Return the unit of the quantity ``name`` for a printed report, for example "m s-1"; "" of
        a dimensionless one.
        """
        return unit_of(attributes(name, self.scale.si))

    def _row_of_times(self) -> SummaryRow:
        """Return the row of a printed report on the output times: their number, if above 1, and the
        last one.
        """
        return SummaryRow(
            "t",
            f"{self.t.size} times to " * (self.t.size > 1) + f"{self.t[-1]:.6g}",
            self._unit("t"),
        )


# --- Datasets ---

#: Variables of a dataset: name -> (dimensions, values, attributes), as xarray takes them.
Variables = dict[str, Any]
#: Comment of a schedule in a dataset.
_LINEAR = "linear between its times, constant outside; a time given twice is a jump"


#: Attributes of columns of codes, as CF has them.
_FLAGS = {
    name: {
        "long_name": long_name,
        "flag_values": np.arange(first, first + len(meanings.split()), dtype=np.int8),
        "flag_meanings": meanings,
    }
    for name, long_name, first, meanings in (
        ("regime", "regime of motion", -1, "not_reached full_slip partial_slip rest locked held"),
        ("status", "how the motion ended", 0, " ".join(MotionStatus.__members__).lower()),
        ("flow", "source of the motion", 0, "integrated flow_map"),
    )
}


def column_attributes(name: str, si: bool = False) -> dict[str, Any]:
    """Return the attributes of a column of a dataset.

    name: name of a field of a motion, of a start ("V0", "omega0"), or "t", "status", "flow";
    another name gives long_name "" and units "1".
    si: whether it is in the units of a cylinder, else of a scene.
    Returns a new dict: long_name and units, of some also symbol and equation
    (:func:`.scale.attributes`); of the codes "regime", "status" and "flow" long_name,
    flag_values (int8, (codes,)) and flag_meanings, one word for each code in their order, and no
    units.
    """
    return dict(_FLAGS.get(name) or attributes(name, si))


def provenance(title: str) -> dict[str, str]:
    """Return the attributes that every dataset has, a new dict of texts: Conventions, title and
    source.
    """
    return {"Conventions": "CF-1.11", "title": title, "source": f"viscoroll {__version__}"}


def _dataset(
    result: RollResult,
    title: str,
    dims: tuple[str, ...],
    variables: Variables,
    about: dict[str, Any],
) -> Dataset:
    """Return the dataset of a motion or an ensemble.

    result: :class:`Motion` or :class:`Ensemble`, whose quantities, t, drive, scene and roller are
    put into the dataset.
    title: title of the dataset.
    dims: names of the dimensions of the quantities, ("t",) or ("motion", "t").
    variables: further variables: name -> (dimensions, values, attributes).
    about: further attributes by name.
    Returns the dataset over ``dims``, in the units of the roller; without loads, works and losses
    for a free single motion, and without quantities that an ensemble does not keep.  The regime is
    int8, -1 where it was not reached.  Its attributes are those of :func:`provenance`, ``about``,
    drive_error of driven motions and of ensembles; of one material relaxation_strengths and
    relaxation_times, also of a series given by its creep; of a cover cover_on, and
    cover_thickness_over_l0 and cover_nu if they are numbers; of a cylinder R, m, j, g, load and
    T_ref; and the texts of :func:`_describe_drive`.
    """
    si = result.scale.si
    acts = result.drive.given or "motion" in dims
    data = {}
    # of a free motion loads and works are 0 or follow from the states; an ensemble has what it kept
    for name in ROWS if acts else STATES:
        if (values := result[name]) is not None:
            if name == "regime":
                values = np.where(np.isnan(values), -1, values).astype(np.int8)
            data[name] = dims, values, column_attributes(name, si)
    drives, texts = _describe_drive(result)
    attrs = provenance(title) | about | texts
    if acts:
        attrs["drive_error"] = result.drive_error
    if (series := result.scene.series) is not None:  # the unit of time is its own
        attrs |= {"relaxation_strengths": series.E, "relaxation_times": series.tau}
    if (cover := result.scene.cover) is not None:
        numbers = {"cover_thickness_over_l0": cover.thickness, "cover_nu": cover.nu}
        attrs |= {"cover_on": cover.on} | {
            name: number for name, number in numbers.items() if not np.ndim(number)
        }
    if si:
        attrs |= {
            name: getattr(result.roller, name) for name in ("R", "m", "j", "g", "load", "T_ref")
        }
    import xarray as xr

    return xr.Dataset(
        data | variables | drives, {"t": ("t", result.t, column_attributes("t", si))}, attrs
    )


def _describe_drive(result: RollResult) -> tuple[Variables, dict[str, Any]]:
    """Describe the drive of a result by variables and attributes of its dataset.

    result: :class:`Motion` or :class:`Ensemble`.  Of its scale the units are read, of its drive
        ``given``: name of each load or prescribed speed -> its numbers, its schedule or its
        function of time, and the gains of a feedback.
    Returns (variables, texts), both empty without a drive.

    The variables are name -> (dimensions, values, attributes), in the units of the roller: of a
    force for example ``drive_force`` and, if it is a schedule, ``drive_force_time``, the times of
    its corners.  Numbers have the dimensions (), or (motion) where each motion has its own.  The
    values of a schedule likewise have (drive_force_time) or (motion, drive_force_time).  Where each
    motion has times of its own, the times have (motion, drive_force_corner), and drive_force_corner
    takes the place of drive_force_time in the dimensions of the values.  Attributes are those of
    :func:`.scale.attributes` with "given: " before long_name; a schedule also has ``comment``, a
    feedback gain_V and gain_omega.

    The texts are name -> text, for example of ``drive_force``, which becomes an attribute of the
    dataset.  A text describes a function of time, which has no variable, and its gains.
    """
    variables: Variables = {}
    texts: dict[str, Any] = {}
    for name, given in result.drive.given.items():
        key = f"drive_{name}"
        value, gains = _value_and_gains(given)
        gain_attributes = {f"gain_{speed}": gain for speed, gain in gains.items()}
        if callable(value):
            texts[key] = "a function of t" + "".join(
                f", {gain} = {format_value(x) if np.ndim(x) else f'{x:.15g}'}"
                for gain, x in gain_attributes.items()
            )
            continue
        about = attributes(name, result.scale.si)
        about = about | {"long_name": f"given: {about['long_name']}"} | gain_attributes
        dims: tuple[str, ...] = ("motion",)
        if isinstance(value, Schedule):
            # of one axis if all motions have the same corners, which then are a coordinate
            times = _shared(value.times, 1)
            value = value.values
            dims = "motion", f"{key}_time" if times.ndim == 1 else f"{key}_corner"
            variables[f"{key}_time"] = (
                # times of one axis have the last of the two dimensions, of two axes both
                dims[-times.ndim :],
                times,
                {"long_name": f"times of the given {name}", "units": result.scale.unit("t")},
            )
            about = about | {"comment": _LINEAR}
        # what all motions share has no axis of the motions: "motion", the first of dims, falls away
        array = _shared(np.asarray(value, np.float64), len(dims) - 1)
        variables[key] = dims[len(dims) - array.ndim :], array, about
    return variables, texts


def _value_and_gains(given: Any) -> tuple[Any, dict[str, Any]]:
    """Return (value, speed -> gain) of a load as it was given; no gains without a Feedback."""
    if isinstance(given, Feedback):
        return given.value, {"V": given.V, "omega": given.omega}
    return given, {}


def describe_load(given: Any, unit: str) -> str:
    """Return a text on a load or speed as it was given: its value with the unit, and the gains of a
    feedback.

    given: a number, a :class:`Schedule`, a function of t, or a :class:`Feedback` of one of these,
    in the unit.
    unit: its unit, "" of a dimensionless one.
    Returns for example "0.5 N m m-1"; "schedule of 4 times, values from 0 to 1 N m m-1"; "a
    function of t"; and "0.5 N m m-1 - 0.1 omega" of a feedback, without gains that are 0.
    """
    value, gains = _value_and_gains(given)
    if callable(value):
        text = "a function of t"
    elif isinstance(value, Schedule):
        text = (
            f"schedule of {value.times.size} times, values from {value.values.min():.6g} "
            f"to {value.values.max():.6g} {unit}"
        ).rstrip()
    else:
        text = f"{value!s:.60} {unit}".rstrip()
    return text + "".join(
        f" {'-' if gain < 0.0 else '+'} {abs(gain):.6g} {name}"
        for name, gain in gains.items()
        if gain
    )


def describe_values(t: NDArray, values: NDArray, unit: str) -> str:
    """Return a text on values over time: the first, the last that was reached, the largest between
    them with its time.

    t, values: times and values, (times,), at least one, in the unit of the roller; values are NaN
    at times that the motion did not reach.
    unit: unit of the times, "" of dimensionless ones.
    Returns "first A, largest in magnitude B (at t = T UNIT), last C", with numbers to six digits.
    B is the value of the largest magnitude, of equal ones the first; the words on it are left out
    where it is printed like A or C.  For one time the result is A alone, and "not reached" where
    all values are NaN.
    """
    reached = values[~np.isnan(values)]
    if not reached.size:
        return "not reached"
    peak = np.nanargmax(np.abs(values))
    first, most, last = (f"{value:.6g}" for value in (reached[0], values[peak], reached[-1]))
    if t.size == 1:
        return first
    when = f"t = {t[peak]:.6g} {unit}".rstrip()
    largest = "" if most in (first, last) else f"largest in magnitude {most} (at {when}), "
    return f"first {first}, {largest}last {last}"


def _shared(array: NDArray, own: int = 0) -> NDArray:
    """Return numbers of motions without the axis of the motions, if it has length 1: they are then
    the same for all motions.

    array: numbers, (n, ...), or without the axis n.
    own: number of its axes beside n.
    Returns ``array`` itself, or its only row.
    """
    return array[0] if array.ndim > own and len(array) == 1 else array


def _material_variables(materials: Any, count: int) -> Variables:
    """Return strengths and times of several materials, and share or thickness, as variables.

    materials: :class:`Prony`, :class:`Bodies` or :class:`Cover` of several motions; for one
    material, or None, the result is empty.
    count: number of motions; what is the same for all of them is repeated.
    Returns name -> (dimensions, values, attributes), dimensionless; values over modes are (count,
    modes), others (count,).  Of series, in the form that was given: relaxation_strengths and
    relaxation_times (or creep_strengths and creep_times) over (motion, mode).  Of two bodies: the
    same of each, with the prefix cylinder_ or base_, over (motion, cylinder_mode) and (motion,
    base_mode), and ``share`` over (motion).  Of covers: ``cover_thickness`` over (motion), divided
    by l0, whose attributes are also the layer's relaxation_strengths and relaxation_times, (modes,)
    each, divided by its long-time modulus and T_ref, in whichever form it was given; ``cover_nu``
    over (motion), if the covers have several.  The side of a cover and the other body are not
    included (:func:`_dataset` has the side, and nu if it is one number).
    """
    if materials is None or not materials.shape:
        return {}
    if not isinstance(materials, Bodies):
        return _mode_variables(materials, count, "", "")

    def along(name: str, values: Any, long_name: str, **more: Any) -> Variables:
        """Return one variable over the motions, as a dict name -> (dimensions, values, attributes).

        name: name of the variable.
        values: a number, or (n,), dimensionless.
        long_name: its long name.
        more: further attributes.
        """
        about = {"long_name": long_name, "units": "1"} | more
        return {name: ("motion", np.broadcast_to(values, (count,)), about)}

    if isinstance(materials, Cover):
        layer = {"relaxation_strengths": materials.layer.E, "relaxation_times": materials.layer.tau}
        found = along(
            "cover_thickness",
            materials.thickness,
            "thickness of the cover divided by l0, the contact length at rest of half-spaces of "
            "the same materials under the same load",
            **layer,
        )
        if np.ndim(materials.nu):
            found |= along("cover_nu", materials.nu, "Poisson's ratio of the cover")
        return found
    return (
        _mode_variables(materials.cylinder, count, "cylinder_", "cylinder: ")
        | _mode_variables(materials.base, count, "base_", "base: ")
        | along(
            "share",
            materials.share,
            "long-time compliance of the cylinder, divided by the sum of those of both bodies",
        )
    )


def _mode_variables(series: Prony, count: int, prefix: str, title: str) -> Variables:
    """Return the strengths and times of the modes of one body, over (motion, mode), as variables.

    series: :class:`Prony`, the series of each motion, or one for all.
    count: number of motions.
    prefix, title: first letters of the names ("", "cylinder_", "base_") and of the long_names ("",
    "cylinder: ", "base: ").
    Returns name -> (dimensions, values (count, modes), attributes), dimensionless:
    PREFIXrelaxation_strengths, divided by the long-time modulus, and PREFIXrelaxation_times,
    divided by T_ref; of a series in creep form PREFIXcreep_strengths, divided by the long-time
    compliance, and PREFIXcreep_times.
    """
    form, total, strengths, times = (
        ("creep", "compliance", series.J, series.T)
        if series.by_creep
        else ("relaxation", "modulus", series.E, series.tau)
    )
    return {
        f"{prefix}{form}_{name}": (
            ("motion", f"{prefix}mode"),
            np.broadcast_to(values, (count, np.shape(values)[-1])),
            {"long_name": title + about, "units": "1"},
        )
        for name, values, about in (
            (
                "strengths",
                strengths,
                f"strengths of the modes of {form}, divided by the long-time {total}",
            ),
            ("times", times, f"times of the modes of {form}, divided by T_ref, the unit of time"),
        )
    }


def motion_dataset(motion: Any) -> Dataset:
    """Return the dataset over t of one motion; of a driven one with loads, works, losses and the
    times at which V reverses.

    motion: a :class:`Motion`.
    Returns the dataset of :func:`_dataset`, in the units of the roller, of a driven motion with
    ``reversals`` over reversal.  Its attributes are also the numbers of the scene by name,
    onset_time and rest_time (NaN where there is none), switches ("t = T: REGIME; ..."), status in
    words, and steps.
    """
    about = motion.scene.numbers | {
        "onset_time": motion.onset_time,
        "rest_time": motion.rest_time,
        "switches": "; ".join(f"t = {s.t:.15g}: {s.regime}" for s in motion.switches),
        "status": motion.message,
        "steps": motion.steps,
    }
    variables = {}
    if motion.drive.given:
        variables["reversals"] = (
            "reversal",
            motion.reversals,
            {"long_name": "times at which V changes its sign", "units": motion.scale.unit("t")},
        )
    return _dataset(
        motion,
        "Motion of a viscoelastic cylinder rolling with partial slip",
        ("t",),
        variables,
        about,
    )


def ensemble_dataset(result: Any) -> Dataset:
    """Return the dataset over (motion, t) of an ensemble.

    result: an :class:`Ensemble`; labels of its starts of length n become coordinates, called
    given_NAME where a variable has their name.
    Returns the dataset of :func:`_dataset`, in the units of the roller: quantities that the
    ensemble keeps over (motion, t); V0, omega0, onset_time, rest_time, status and flow over motion;
    alpha, kappa, mu, gamma and j, dimensionless, and the drive over motion, or without dimension
    where all motions have the same; of several materials the variables of
    :func:`_material_variables`; attributes flow_error and flow_problem.
    """
    si = result.scale.si
    variables = _material_variables(result.scene.material, len(result))
    for name in PARAMETERS:
        value = _shared(np.asarray(getattr(result.scene, name)))
        # () where all motions have one value
        variables[name] = ("motion",)[: value.ndim], value, attributes(name)
    for name in ("V0", "omega0", "onset_time", "rest_time", "status"):
        variables[name] = "motion", result[name], column_attributes(name, si)
    variables["flow"] = "motion", result.flow.astype(np.int8), column_attributes("flow")
    about = {"flow_error": result.flow_error, "flow_problem": result.flow_problem}
    dataset = _dataset(result, "Ensemble of motions", ("motion", "t"), variables, about)
    labels = result.labels
    if labels is None or labels.shape != (len(result),):
        return dataset
    return dataset.assign_coords(
        labels.axes_beside({*dataset.variables, *dataset.dims}, "motion")[1]
    )
