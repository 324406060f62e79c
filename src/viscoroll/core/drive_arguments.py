"""Forces and torques on the cylinder: :class:`Schedule`, :class:`Feedback`, their units, and the
slope.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from inspect import signature
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .checks import broadcast_shape, check_array, divide_by_unit, read_only
from .errors import ParameterError, described_error, shape_error
from .quantities import convert, split_unit, to_unit
from .scale import HasUnits, Scale

#: Load -> the quantities whose units its gains on V and omega have.
_GAINS = {"force": ("dQ_dV", "dQ_domega"), "torque": ("dM_dV", "drag")}


@dataclass(frozen=True, eq=False)
class Schedule:
    """A piecewise linear function of time, constant before its first and after its last corner.

    Parameters
    ----------
    times : times of the corners, (k,), ascending, >= 0; a time that occurs twice is a jump.  For an
        ensemble also (n, k), a row for each motion.
    values : values at the corners, (k,) or (n, k).  Units of times and values are converted by the
        function that takes the schedule.

    Raises
    ------
    ParameterError
        Values that are not numeric or not finite, times that decrease or occur three times, shapes
        that do not agree.

    Examples
    --------
    >>> import viscoroll as vr
    >>> push = vr.Schedule([0.0, 1.0, 1.0], [5.0, 5.0, 0.0])  # 5 N/m for one second, then 0
    >>> push.values
    array([5., 5., 0.])
    """

    times: Any
    values: Any
    #: Name of a field -> unit that it was given in.
    units: dict[str, str] = field(default_factory=dict, init=False, repr=False)

    def __post_init__(self) -> None:
        """Check the fields, make them read-only arrays of float64, and keep the units that they
        were given in.

        Both must be (k,) or (n, k), k >= 1, with equal k, and equal n where both have it; in each
        row times are >= 0, do not decrease, and no time occurs more than twice.  Raises
        ParameterError where that does not hold, or a field is not numeric or not finite.
        """
        for name, low in (("times", 0.0), ("values", -np.inf)):
            _check_field(self, name, low)
        times = self.times
        values = self.values
        fits = {np.ndim(times), np.ndim(values)} <= {1, 2}
        fits = fits and times.size > 0 and values.shape[-1] == times.shape[-1]
        if not fits or len({len(array) for array in (times, values) if array.ndim == 2}) > 1:
            shapes = f"times {np.shape(times)}, values {np.shape(values)}"
            allowed = "(k,) for both, or (n, k) for n motions"
            raise ParameterError("shapes of a Schedule", shapes, allowed)
        for wrong, found, allowed in (
            (times[..., 1:] < times[..., :-1], "fall after {:.6g}", "in ascending order"),
            (
                times[..., 2:] == times[..., :-2],
                "have {:.6g} three times",
                "given once, or twice for a jump",
            ),
        ):
            if wrong.any():
                raise described_error(
                    "times", found.format(times[..., : wrong.shape[-1]][wrong][0]), allowed
                )


@dataclass(frozen=True, eq=False)
class Feedback:
    """A force or torque that depends on the speeds: value + V * speed of the axis + omega * angular
    velocity.

    Parameters
    ----------
    value : force or torque at rest: a number or an array; for motions also a :class:`Schedule` or a
        function of t, see :func:`roll`.
    V, omega : gains on the speed of the axis and on the angular velocity: numbers, for motions of
        an ensemble also (n,).  A gain < 0 brakes, as the torque of an engine falls with its speed.

    Raises
    ------
    ParameterError
        Values that are not numeric or not finite, gains that are neither numbers nor vectors.

    Examples
    --------
    >>> import viscoroll as vr
    >>> engine = vr.Feedback(2.0, omega=-0.5)  # 2 N m/m at rest, 0 at 4 rad/s
    >>> equilibria = vr.presets.RUBBER_CYLINDER.steady(torque=engine)
    """

    value: Any
    V: Any = 0.0
    omega: Any = 0.0
    #: Name of a field -> unit that it was given in.
    units: dict[str, str] = field(default_factory=dict, init=False, repr=False)

    def __post_init__(self) -> None:
        """Check the fields, make each a float or a read-only array, and keep the units that they
        were given in.

        A value that is a schedule or a function stays; it is checked with its motion.  Gains may be
        numbers or (n,).
        Raises ParameterError for fields that are not numeric or not finite, and for gains of more
        axes.
        """
        if not (callable(self.value) or isinstance(self.value, Schedule)):
            _check_field(self, "value", -np.inf)
        for name in ("V", "omega"):
            _check_field(self, name, -np.inf)
            if np.ndim(gain := getattr(self, name)) > 1:
                raise shape_error(
                    name, np.shape(gain), "a number, or an array (n,) with one for each motion"
                )

    @property
    def shape(self) -> tuple[int, ...]:
        """Common shape of the gains."""
        return np.broadcast_shapes(np.shape(self.V), np.shape(self.omega))


def _check_field(load: Schedule | Feedback, name: str, low: float) -> None:
    """Replace a field by its checked numbers, and keep the unit that it was given in.

    load: :class:`Schedule` or :class:`Feedback`, changed in place although it is frozen: its field
        becomes a float or a read-only array, and a unit is entered into its ``units``.  Numbers
        with a unit stay in that unit.
    name: name of the field.
    low: smallest allowed number, -infinite for none; compared before any conversion.
    Raises ParameterError for numbers that are not numeric, not finite or below ``low``, and for
    what :func:`.quantities.split_unit` refuses, as a list of numbers with and without units.
    """
    numbers, unit = split_unit(name, getattr(load, name))
    object.__setattr__(load, name, read_only(check_array(name, numbers, low=low)))
    if unit is not None:
        load.units[name] = unit


def convert_argument(name: str, value: Any, units: HasUnits) -> Any:
    """Convert an argument that a caller gave with a unit to the unit of the argument.

    name: name of the argument, by which its unit is found.
    value: what a caller gave: a number, an array, a value with a unit, a :class:`Schedule`, a
        :class:`Feedback` or a function of time.
    units: object whose method ``unit`` gives the unit of each argument by name, as "N m-1".
    Returns ``value`` itself if it has no unit, as a function of time; else a value of the same kind
    without unit: plain numbers, with the labels of xarray and pandas, or a new schedule or feedback
    whose fields are in their units, those of a schedule within a feedback too.

    Raises
    ------
    ParameterError
        A unit of another dimension, an unknown one, or another that :func:`.quantities.to_unit`
        refuses; a feedback for an argument that is neither force nor torque.
    """
    if isinstance(value, Schedule):
        return _convert_fields(name, value, {"times": units.unit("t"), "values": units.unit(name)})
    if not isinstance(value, Feedback):
        return to_unit(name, value, units.unit(name))
    if name not in _GAINS:
        sentence = f"{name} is a Feedback, which can only be given as force= or torque="
        raise ParameterError(name, "a Feedback", "no Feedback", sentence)
    wanted = dict(zip(("value", "V", "omega"), map(units.unit, (name, *_GAINS[name])), strict=True))
    value = _convert_fields(name, value, wanted)
    schedule = (
        convert_argument(name, value.value, units)
        if isinstance(value.value, Schedule)
        else value.value
    )
    return value if schedule is value.value else replace(value, value=schedule)


def _convert_fields(name: str, load: Any, wanted: dict[str, str]) -> Any:
    """Convert those fields of a schedule or a feedback that were given with a unit.

    name: name of the argument, for errors.
    load: :class:`Schedule` or :class:`Feedback`; not changed.
    wanted: name of a field -> unit, as "m s-1"; for each field that may have a unit.
    Returns a new load of the same class without units; ``load`` itself if none of its fields has a
    unit.
    Raises ParameterError for a unit of another dimension or an unknown one, and for numbers that
    the class refuses after the conversion, as infinite ones.
    """
    converted = {
        part: convert(f"{part} of {name}", getattr(load, part), unit, wanted[part])
        for part, unit in load.units.items()
    }
    return replace(load, **converted) if converted else load


def require_time_argument(name: str, function: Callable[..., Any]) -> None:
    """Raise ParameterError for a function of time that cannot be called with a time alone; it is
    not called here.

    name: name of the argument that the function is, for the error.
    function: the function of a caller, a callable.  One whose signature Python cannot find, as of
        some compiled code, is accepted; parameters with defaults are allowed.
    """
    try:
        parameters = signature(function)
    except ValueError:  # compiled code may have no signature
        return
    try:
        parameters.bind(0.0)
    except TypeError:
        sentence = (
            f"{name} must be a function of t alone, but this function has the parameters "
            f"{parameters}: for feedback "
            "of the speeds give vr.Feedback; with another controller call vr.law in an integrator "
            "of your own"
        )
        raise ParameterError(name, function, "a function of t", sentence) from None


def slope_tan_cos(slope: ArrayLike | None) -> tuple[Any, Any]:
    """Return tangent and cosine of the angle of a slope.

    Parameters
    ----------
    slope : angle, rad, a number or an array, perhaps with a unit; None: level.

    Returns
    -------
    tan, cos : tangent, and cosine > 0, dimensionless, arrays of the shape of ``slope``, numpy
        floats of a number; the floats 0.0 and 1.0 for None.

    Raises
    ------
    ParameterError
        A slope that is not numeric, not finite, not in (-pi/2, pi/2), or has a unit that is no
        angle.
    """
    if slope is None:
        return 0.0, 1.0
    theta = check_array("slope", slope, unit="rad")
    steep = np.abs(theta) >= 0.5 * np.pi
    if steep.any():
        given = theta[steep].flat[0]
        allowed = f"in (-pi/2, pi/2), in radians; {given:g} degrees are {np.radians(given):.4g}"
        raise ParameterError("slope", f"{given:g}", allowed)
    return np.tan(theta), np.cos(theta)


def make_dimensionless(name: str, value: Any, scale: Scale) -> Any:
    """Return a load divided by its unit: a number, an array, a schedule, a function of time or a
    feedback.

    name: name of the argument, as "force", "torque", "brake", "drag" or "V", by which its unit is
        found.
    value: what a caller gave, in SI units for a cylinder; a number or an array with a unit is
        converted, the fields of schedules and feedbacks are taken to be in SI units
        (:func:`convert_argument`).  None stays None.
    scale: :class:`.scale.Scale` of the roller, a unit for each quantity, numbers or, of many
        cylinders, (n,).  With that of a scene ``value`` is returned itself, unchecked.
    Returns a new value of the same kind: a float for a number (an array (n,) of many cylinders), an
    array, a :class:`Schedule` (with values (n, k) of many cylinders), a :class:`Feedback`, whose
    gains are multiplied by the unit of the speed and divided by that of the load, or a function.
    Such a function takes the dimensionless time and returns dimensionless arrays; the values of the
    caller's function are checked when it is called.

    Raises
    ------
    ParameterError
        A value that is not numeric or not finite, a unit of another dimension, a brake or a drag <
        0, a function for an array of cylinders or one that cannot be called with a time alone, and
        an array or gains that do not broadcast with the cylinders.
    """
    if value is None or not scale.si:
        return value
    unit = scale[name]
    low = 0.0 if name in ("brake", "drag") else -np.inf
    if type(value) is type(unit) is float and low < value < np.inf:
        return value / unit
    if isinstance(value, Feedback):
        sizes = {
            "gain on V": value.V,
            "gain on omega": value.omega,
            "cylinders": unit * scale["V"] * scale["omega"],
        }
        broadcast_shape(**{label: np.asarray(size) for label, size in sizes.items()})
        gains = value.V * scale["V"] / unit, value.omega * scale["omega"] / unit
        return Feedback(make_dimensionless(name, value.value, scale), *gains)
    if callable(value):
        if np.ndim(unit):
            raise ParameterError(
                name,
                "a function",
                "a number",
                f"{name} is a function: then the call must have a single cylinder",
            )
        require_time_argument(name, value)
        return lambda t: (
            check_array(f"{name}(t)", value(t * scale["t"]), unit=scale.unit(name), low=low) / unit
        )
    if isinstance(value, Schedule):
        values = check_array(f"values of {name}", value.values, low=low)
        units = unit[:, np.newaxis] if np.ndim(unit) else unit
        return Schedule(value.times / scale["t"], divide_by_unit(name, values, units))
    quotient = divide_by_unit(name, check_array(name, value, unit=scale, low=low), unit)
    return quotient if quotient.ndim else float(quotient)
