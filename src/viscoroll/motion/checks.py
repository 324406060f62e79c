"""Input checks that one motion and an ensemble share."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..errors import ParameterError
from ..scene import checked

RTOL_RANGE = (1e-12, 1e-2)


def output_times(t: ArrayLike) -> NDArray[np.float64]:
    """Output times as a vector: finite, >= 0, ascending, at least one.

    Raises
    ------
    ParameterError
        Otherwise.
    """
    times = np.atleast_1d(checked("t", t, low=0.0))
    if times.ndim != 1 or times.size == 0:
        raise ParameterError("t", f"array of shape {times.shape}", "one end time or a vector of output times")
    backward = np.flatnonzero(np.diff(times) < 0.0)
    if backward.size:
        at = backward[0]
        raise ParameterError("t", f"..., {times[at]:.6g}, {times[at + 1]:.6g}, ...", "in ascending order")
    return times


def controls(rtol: float, rest: float | None, max_steps: int) -> tuple[float, float, int]:
    """(rtol, rest threshold or 0, max_steps), checked.

    Raises
    ------
    ParameterError
        rtol outside [1e-12, 1e-2], rest not positive, max_steps < 1.
    """
    low, high = RTOL_RANGE
    if not (np.ndim(rtol) == 0 and low <= float(checked("rtol", rtol)) <= high):
        raise ParameterError("rtol", rtol, f"a number in [{low:g}, {high:g}]")
    if rest is not None and checked("rest", rest, low=0.0, strict=True).ndim:
        raise ParameterError("rest", rest, "one positive number, or None")
    if not (isinstance(max_steps, (int, np.integer)) and max_steps >= 1):
        raise ParameterError("max_steps", max_steps, "a whole number >= 1")
    return float(rtol), 0.0 if rest is None else float(rest), int(max_steps)


def start_speed(name: str, value: ArrayLike) -> NDArray[np.float64]:
    """A start velocity: finite, and of a size whose square is too.

    Raises
    ------
    ParameterError
        Otherwise.
    """
    array = checked(name, value)
    too_large = np.abs(array) > 1e150
    if too_large.any():
        raise ParameterError(name, array[too_large].flat[0] if array.ndim else array[()], "at most 1e150 in size")
    return array
