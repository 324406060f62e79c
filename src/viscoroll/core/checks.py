"""Numbers that callers give, as float64 in the unit of the argument, or refused by name.

Numbers are finite, in range, and of shapes that go together; what carries a unit is converted
(:mod:`.quantities`).
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .array_types import Booleans, Floats
from .errors import ParameterError, describe_value
from .quantities import has_no_unit, is_real, to_unit
from .scale import Units

#: bytes of a double
_DOUBLE = 8


def check_array(name: str, value: ArrayLike, **bounds: Any) -> Floats:
    """``value`` as float64, finite, >= ``low`` (> if ``strict``) and <= ``high``, which may be given.

    ``unit`` : what the argument is counted in, as of :func:`check_array_extent`.

    Raises
    ------
    ParameterError
        If it is not numeric, not finite, below ``low`` or above ``high``, or carries another unit.
    """
    return check_array_extent(name, value, **bounds)[0]


def check_array_extent(
    name: str, value: ArrayLike, *, unit: Units = "1", low: float = -math.inf, strict: bool = False,
    high: float = math.inf,
) -> tuple[Floats, tuple[float, float]]:  # fmt: skip
    """As :func:`check_array`, with the least and the largest element; (0, 0) of an empty array.

    Parameters
    ----------
    unit : what the argument is counted in, to which what carries a unit is converted: an SI unit as "m s-1", "1" of
        a number without dimension; or what has units by name, as a :class:`.scale.Scale`.
    """
    if type(value) is float and low < value < high:
        return np.asarray(value), (value, value)
    array = _numbers(name, value, unit, (low, strict, high))
    smallest, largest = extent(array) if array.size else (0.0, 0.0)
    # a NaN compares false; without one, no mask of the size of the array is needed
    above = smallest > low if strict else smallest >= low
    if array.size and not (above and -math.inf < smallest and largest < math.inf and largest <= high):
        bad = ~(np.isfinite(array) & (array > low if strict else array >= low) & (array <= high))
        raise ParameterError(name, _listed(array, bad), _allowed(low, strict, high) or "a finite number")
    return array, (smallest, largest)


def _allowed(low: float, strict: bool, high: float) -> str:
    """A range in words; "" of all finite numbers."""
    least = [] if low == -math.inf else [f"finite and {'>' if strict else '>='} {low:g}"]
    return ", ".join(least + ([] if high == math.inf else [f"<= {high:g}"]))


def _numbers(name: str, value: Any, unit: Units, bounds: tuple[float, bool, float]) -> Floats:
    """``value`` as float64 in ``unit``; raises ParameterError for what is no number, with its ``bounds`` in words."""
    plain = value
    if not has_no_unit(value):
        plain = to_unit(name, value, unit if isinstance(unit, str) else unit.unit(name))
        if isinstance(plain, np.ma.MaskedArray):
            raise ParameterError(name, "a masked array", "plain", f"{name} is a masked array: give {name}.compressed()")
    try:
        given = np.asarray(plain)
        if given.dtype.kind == "O" and all(map(is_real, given.flat)):
            given = given.astype(np.float64)
    except (TypeError, ValueError, OverflowError):  # ragged, or an integer beyond the doubles
        given = np.asarray(None)
    if given.dtype.kind not in "iuf":
        allowed = _allowed(*bounds)
        raise ParameterError(name, describe_value(value), f"a number, {allowed}" if allowed else "a finite number")
    if given.dtype.itemsize <= _DOUBLE:
        return given.astype(np.float64, copy=False)
    with np.errstate(over="ignore"):  # of long doubles, which are infinite then
        return given.astype(np.float64)


def _listed(array: Floats, bad: Booleans) -> str:
    """The first bad value, its place, and how many more there are."""
    if array.size == 1:
        return str(array.item())
    first = tuple(int(n[0]) for n in np.nonzero(bad))
    place = f"at row {first[0]}" if array.ndim == 1 else f"at {first}"
    more = int(np.count_nonzero(bad)) - 1
    return f"{array[first]} {place}" + (f", and {more} more" if more else "")


def extent(array: Floats) -> tuple[float, float]:
    """Least and largest element, both NaN if there is one."""
    if array.ndim == 0:
        return float(array), float(array)
    return float(array.min()), float(array.max())


def check_number(
    name: str, value: ArrayLike, *, unit: Units = "1", low: float = -math.inf, strict: bool = False,
    high: float = math.inf,
) -> float:  # fmt: skip
    """As :func:`check_array`, and a single number.

    Raises
    ------
    ParameterError
        As there, or for an array.
    """
    if type(value) is float and low < value < high:
        return value
    array = check_array(name, value, unit=unit, low=low, strict=strict, high=high)
    if array.ndim:
        raise ParameterError(name, describe_value(value), "a single number")
    return float(array)


def broadcast_shape(**arrays: NDArray) -> tuple[int, ...]:
    """Common shape of the named arrays.

    Raises
    ------
    ParameterError
        Naming the shapes, where they do not broadcast.
    """
    known = {array.shape for array in arrays.values()} - {()}
    try:
        return np.broadcast_shapes(*known) if len(known) > 1 else known.pop() if known else ()
    except ValueError:
        shapes = ", ".join(f"{name} {a.shape}" for name, a in arrays.items() if a.ndim)
        raise ParameterError("shapes", shapes, "broadcastable against each other") from None


def read_only(array: Floats) -> float | Floats:
    """A number, or a copy that nobody can write to."""
    if array.ndim == 0:
        return float(array)
    array = array.copy()
    array.flags.writeable = False
    return array


def check_integer(name: str, value: Any, least: int, most: float = math.inf) -> int:
    """``value`` as a whole number from ``least`` to ``most``.

    Raises
    ------
    ParameterError
        Otherwise.
    """
    if type(value) is int and least <= value <= most:
        return value
    if isinstance(value, bool) or not (isinstance(value, int | np.integer) and least <= value <= most):
        allowed = f"a whole number >= {least}" if most == math.inf else f"a whole number in [{least}, {most}]"
        raise ParameterError(name, describe_value(value), allowed)
    return int(value)


def check_choice(name: str, value: Any, *allowed: str) -> None:
    """Raise ParameterError where ``value`` is none of the ``allowed`` texts, the last of which stands behind "or"."""
    if not (isinstance(value, str) and value in allowed):
        *most, last = map(repr, allowed)
        raise ParameterError(name, describe_value(value), f"{', '.join(most)} or {last}")


def check_bool(name: str, value: Any) -> bool:
    """``value`` as True or False.

    Raises
    ------
    ParameterError
        For what is no truth value of Python or numpy: texts and numbers have a truth that nobody meant.
    """
    if isinstance(value, bool | np.bool_):
        return bool(value)
    raise ParameterError(name, describe_value(value), "True or False")
