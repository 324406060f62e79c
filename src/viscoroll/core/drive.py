"""What pushes and turns the cylinder: :class:`Schedule`, :class:`Feedback`, and the slope that it stands on."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from inspect import signature
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .checks import check_array, read_only
from .errors import ParameterError
from .quantities import convert, split_unit, to_unit
from .scale import HasUnits, Scale

#: of what acts, the quantities whose units its gains on V and omega have
_GAINS = {"force": ("dQ_dV", "dQ_domega"), "torque": ("dM_dV", "drag")}


@dataclass(frozen=True, eq=False)
class Schedule:
    """A function of time by its corners: linear between, constant outside; a time given twice is a jump.

    Parameters
    ----------
    times : (k,), ascending, >= 0; of an ensemble also (n, k), of each motion its own.
    values : (k,), or (n, k).  Where times or values carry units, what they drive converts them.

    Raises
    ------
    ParameterError
        What is not numeric or not finite, times that fall or that come more than twice, shapes that do not go together.
    """

    times: Any
    values: Any
    #: that times and values carried
    units: dict[str, str] = field(default_factory=dict, init=False, repr=False)

    def __post_init__(self) -> None:
        for name, low in (("times", 0.0), ("values", -np.inf)):
            _keep(self, name, low)
        times, values = self.times, self.values
        fits = {np.ndim(times), np.ndim(values)} <= {1, 2}
        fits = fits and times.size > 0 and values.shape[-1] == times.shape[-1]
        if not fits or len({len(array) for array in (times, values) if array.ndim == 2}) > 1:
            shapes = f"times {np.shape(times)}, values {np.shape(values)}"
            raise ParameterError("Schedule", shapes, "times (k,) and values (k,), or (n, k) for n motions")
        falls = times[..., 1:] < times[..., :-1]
        if falls.any():
            raise ParameterError("times", times[..., :-1][falls][0], "in ascending order")
        thrice = times[..., 2:] == times[..., :-2]
        if thrice.any():
            raise ParameterError("times", times[..., :-2][thrice][0], "there once, or twice for a jump")


@dataclass(frozen=True, eq=False)
class Feedback:
    """A force or torque that follows the speeds: value + V * speed of the axis + omega * angular velocity.

    Parameters
    ----------
    value : what acts at rest, over P for a force, over P R for a torque: a number or an array; for motions also
        a :class:`Schedule` or a callable of t, see :func:`roll`.
    V, omega : gains, numbers, for motions of an ensemble also (n,); < 0 brakes what is too fast, as an engine's torque
        falls with its speed.

    Raises
    ------
    ParameterError
        What is not numeric or not finite, gains that are neither numbers nor vectors.
    """

    value: Any
    V: Any = 0.0
    omega: Any = 0.0
    #: that value and gains carried
    units: dict[str, str] = field(default_factory=dict, init=False, repr=False)

    def __post_init__(self) -> None:
        if not (callable(self.value) or isinstance(self.value, Schedule)):  # those are checked with their motion
            _keep(self, "value", -np.inf)
        for name in ("V", "omega"):
            _keep(self, name, -np.inf)
            if np.ndim(gain := getattr(self, name)) > 1:
                raise ParameterError(name, f"of shape {np.shape(gain)}", "a number, or one a motion, (n,)")

    @property
    def shape(self) -> tuple[int, ...]:
        """Of its gains."""
        return np.broadcast_shapes(np.shape(self.V), np.shape(self.omega))


def _keep(given: Schedule | Feedback, name: str, low: float) -> None:
    """Check the numbers of a part of what drives, and keep them and their unit; raises ParameterError."""
    plain, unit = split_unit(name, getattr(given, name))
    object.__setattr__(given, name, read_only(check_array(name, plain, low=low)))
    if unit is not None:
        given.units[name] = unit


def convert_argument(name: str, given: Any, units: HasUnits) -> Any:
    """What a caller gave for an argument, in the unit of that: numbers, and what drives over time or with the speeds.

    Raises
    ------
    ParameterError
        A unit of another dimension; a feedback where nothing follows the speeds.
    """
    if isinstance(given, Schedule):
        return _converted(name, given, {"times": units.unit("t"), "values": units.unit(name)})
    if not isinstance(given, Feedback):
        return to_unit(name, given, units.unit(name))
    if name not in _GAINS:
        sentence = f"{name} is a Feedback, which acts as force= or torque= alone: give its gains there"
        raise ParameterError(name, "a Feedback", "no Feedback", sentence)
    wanted = dict(zip(("value", "V", "omega"), map(units.unit, (name, *_GAINS[name])), strict=True))
    given = _converted(name, given, wanted)
    value = convert_argument(name, given.value, units) if isinstance(given.value, Schedule) else given.value
    return given if value is given.value else replace(given, value=value)


def _converted(name: str, given: Any, wanted: dict[str, str]) -> Any:
    """A schedule or a feedback whose parts are in the ``wanted`` units, by their names."""
    if not given.units:
        return given
    parts = {
        part: convert(f"{part} of {name}", getattr(given, part), unit, wanted[part])
        for part, unit in given.units.items()
    }
    return replace(given, **parts)


def require_time_argument(name: str, function: Callable[..., Any]) -> None:
    """Raise ParameterError for a function that cannot be called with a time alone."""
    try:
        takes = signature(function)
    except ValueError:  # compiled code may not tell
        return
    try:
        takes.bind(0.0)
    except TypeError:
        sentence = (
            f"{name} is called with t alone, this function takes {takes}: for gains on the speeds give Feedback, "
        )
        sentence += "any other controller goes with vr.law into an integrator of your own"
        raise ParameterError(name, function, "a function of t", sentence) from None


def slope_tan_cos(slope: ArrayLike | None) -> tuple[Any, Any]:
    """(tan(theta), cos(theta)) of a slope in rad; (0, 1) without.

    Raises
    ------
    ParameterError
        A slope that is not in (-pi/2, pi/2).
    """
    if slope is None:
        return 0.0, 1.0
    theta = check_array("slope", slope, unit="rad")
    steep = np.abs(theta) >= 0.5 * np.pi
    if steep.any():
        allowed = "an angle below pi/2 in size: radians in (-pi/2, pi/2), as np.radians(degrees) gives"
        raise ParameterError("slope", f"{theta[steep].flat[0]:g}", allowed)
    return np.tan(theta), np.cos(theta)


def make_dimensionless(name: str, given: Any, scale: Scale) -> Any:
    """A number, an array, a schedule, a function of time or a feedback, over its unit and that of time.

    Raises
    ------
    ParameterError
        What is not numeric or not finite, a brake below 0, arrays where numbers belong.
    """
    if given is None or not scale.si:
        return given
    unit, low = scale[name], 0.0 if name in ("brake", "drag") else -np.inf
    if type(given) is type(unit) is float and low < given < np.inf:
        return given / unit
    if isinstance(given, Feedback):
        gains = given.V * scale["V"] / unit, given.omega * scale["omega"] / unit
        return Feedback(make_dimensionless(name, given.value, scale), *gains)
    if callable(given):
        if np.ndim(unit):
            raise ParameterError(name, "a function", "a number", f"{name} is a function: the cylinder must be one then")
        require_time_argument(name, given)
        return lambda t: check_array(f"{name}(t)", given(t * scale["t"]), unit=scale.unit(name), low=low) / unit
    if isinstance(given, Schedule):
        values = check_array(f"values of {name}", given.values, low=low)
        return Schedule(given.times / scale["t"], values / (unit[:, np.newaxis] if np.ndim(unit) else unit))
    value = check_array(name, given, unit=scale, low=low) / unit
    return value if value.ndim else float(value)
