"""Input checks that one motion and an ensemble share."""

from __future__ import annotations

import math
import sys
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..core.array_types import Floats
from ..core.checks import broadcast_shape, check_array, check_integer, check_number, extent
from ..core.errors import ParameterError
from ..core.scale import Scale, Units

RTOL_RANGE = (1e-12, 1e-2)
SPEED_RANGE = (1e-300, 1e100)
#: a motion takes some hundreds
MOST_STEPS = 10_000_000


def output_times(t: ArrayLike, units: Units = "1") -> Floats:
    """Output times as a vector: finite, >= 0, ascending, at least one; ``units`` that they are counted in.

    Raises
    ------
    ParameterError
        Otherwise.
    """
    times = np.array(check_array("t", t, unit=units, low=0.0), ndmin=1)  # contiguous, and the result's own
    if times.ndim != 1 or times.size == 0:
        raise ParameterError("t", f"array of shape {times.shape}", "one end time or a vector of output times")
    backward = times[1:] < times[:-1]
    if backward.any():
        at = int(np.argmax(backward))
        place = f"{times[at]:.6g}, {times[at + 1]:.6g} at rows {at}, {at + 1}"
        raise ParameterError("t", place, "in ascending order")
    return times


def refuse_end(end: float, T: float) -> None:
    """Raise ParameterError for a last output time that is infinite over T_ref."""
    if end / T == math.inf:
        raise ParameterError("t", end, f"less than {sys.float_info.max * min(T, 1.0):.3g}")


def refuse_many(**given: Any) -> None:
    """Raise ParameterError for an array where roll wants one number."""
    for name, each in given.items():
        if type(each) is not float and (shape := _shape(each)):
            sentence = f"roll computes one motion, but {name} has shape {shape}: use ensemble"
            raise ParameterError(name, f"array of shape {shape}", "a single number", sentence)


def _shape(given: Any) -> tuple[int, ...]:
    """Shape of what a caller gave, of a ragged list as one of objects; () of what is no array."""
    try:
        return tuple(np.shape(given if hasattr(given, "shape") else np.asarray(given, object)))
    except (TypeError, ValueError):
        return ()


def controls(rtol: float, rest: float | None, max_steps: int) -> tuple[float, float, int]:
    """(rtol, rest threshold or 0, max_steps), checked.

    Raises
    ------
    ParameterError
        rtol outside [1e-12, 1e-2], rest not positive, max_steps outside [1, 10^7].
    """
    low, high = RTOL_RANGE
    if not low <= check_number("rtol", rtol) <= high:
        raise ParameterError("rtol", rtol, f"a number in [{low:g}, {high:g}]")
    threshold = 0.0 if rest is None else check_number("rest", rest, low=0.0, strict=True)
    return float(rtol), threshold, check_integer("max_steps", max_steps, 1, MOST_STEPS)


def start_speeds(V0: ArrayLike, omega0: ArrayLike) -> tuple[Any, Any]:
    """Start velocities: finite, no more than 1e100, and the larger of the two 0 or no less than 1e-300.

    Beyond, intermediate results leave the range of doubles.

    Raises
    ------
    ParameterError
        Otherwise.
    """
    low, high = SPEED_RANGE
    # each by itself: max() of a NaN and another may be the other
    if type(V0) is float and type(omega0) is float and -high <= V0 <= high and -high <= omega0 <= high:
        if abs(V0) >= low or abs(omega0) >= low:
            return V0, omega0
    V, omega = check_array("V0", V0), check_array("omega0", omega0)
    broadcast_shape(V0=V, omega0=omega)
    for name, array in (("V0", V), ("omega0", omega)):
        fastest = max(extent(array), key=abs) if array.size else 0.0
        if abs(fastest) > SPEED_RANGE[1]:
            raise ParameterError(name, fastest, f"at most {SPEED_RANGE[1]:g} in size")
    # by parts, whose size does not depend on that of the arrays
    for V_part, omega_part in np.nditer((V, omega), ["external_loop", "buffered", "zerosize_ok"], buffersize=1 << 16):
        larger = np.maximum(np.abs(V_part), np.abs(omega_part))
        tiny = larger[(larger > 0.0) & (larger < SPEED_RANGE[0])]
        if tiny.size:
            raise ParameterError("max(|V0|, |omega0|)", tiny.min(), f"0, or at least {SPEED_RANGE[0]:g}")
    return V, omega


def in_words(error: ParameterError, scale: Scale) -> ParameterError:
    """A refusal of what has no dimension any more, with what its values are over."""
    if not scale.si:
        return error
    about = "dimensionless"
    if not (np.ndim(scale["V"]) or np.ndim(scale["force"])):
        T, V, P = (f"{scale[name]:.6g} {unit}" for name, unit in (("t", "s"), ("V", "m/s"), ("force", "N/m")))
        about += f": times over {T}, speeds over {V}, forces over {P}"
    return ParameterError(error.name, error.value, error.allowed, f"{error} ({about})")
