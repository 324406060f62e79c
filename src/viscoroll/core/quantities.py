"""Units that inputs carry: quantities of pint, ``units`` attributes of xarray, durations of pandas and numpy.

:func:`to_unit` converts what carries a unit to the unit of the argument, or refuses it.  What carries none, and labels
of xarray and pandas, pass as they are.
"""

from __future__ import annotations

import re
from datetime import timedelta
from decimal import Decimal
from numbers import Real
from typing import Any

import numpy as np

from .errors import ParameterError, describe_value
from .units import conversion_factor, pint_spelling

#: types that carry no unit
_BARE = frozenset((float, int, bool, str, complex, type(None), dict, np.float64))
#: kinds of arrays that carry no unit, as numpy calls them: truth values, integers, floats, complex, texts, dates
_PLAIN = frozenset("biufcUSM")
#: elements of lists that need no look
_NUMBERS = frozenset((float, int))
#: how a number without dimension is marked
_NO_UNIT = ("", "1", "-", "dimensionless")
#: hertz in a unit: a cycle is 2 pi rad of an angular velocity, and none of it anywhere else
_HERTZ = re.compile(r"(?:^|[^a-z])[a-z]{0,2}hz(?:$|[^a-z])|hertz", re.IGNORECASE)
#: a share, which is no angle: a slope of 5 % is one of atan(0.05)
_SHARE = re.compile(r"%|percent|permille|ppm", re.IGNORECASE)
#: the unit at the end of a title
_COLUMN = re.compile(r"\[([^\[\]]+)\]\s*$")
#: absolute temperatures, whose zero may be moved
_TEMPERATURE = "degC"


def has_no_unit(value: Any) -> bool:
    """Whether it carries no unit, to be seen from its type: a number, an array or a list of numbers."""
    kind = type(value)
    if kind is np.ndarray:
        return value.dtype.kind in _PLAIN
    return kind in _BARE or ((kind is list or kind is tuple) and _NUMBERS.issuperset(map(type, value)))


def to_unit(name: str, value: Any, wanted: str) -> Any:
    """``value`` without its unit, in the unit that the argument has.

    Parameters
    ----------
    name : of the argument.
    value : what a caller gave: a number, an array, a list, a quantity, a duration, an array of xarray, a series.
    wanted : SI unit of the argument as "m s-1"; "1" of a number without dimension.

    Returns
    -------
    value : as it was where it carries no unit; else numbers in ``wanted``, with the labels of xarray and pandas.

    Raises
    ------
    ParameterError
        A unit of another dimension, or one that is not known.
    """
    if has_no_unit(value):
        return value
    if _is_quantity(value) and not hasattr(value, "units"):
        try:
            return value.to(pint_spelling(wanted)).magnitude
        except Exception as error:  # whatever its library raises
            raise unit_error(name, f"another unit ({value!s:.40})", wanted) from error
    plain, unit = split_unit(name, value)
    return plain if unit is None else convert(name, plain, unit, wanted)


def split_unit(name: str, value: Any) -> tuple[Any, str | None]:
    """(``value`` without its unit, that unit; None where it carries none).

    Labels of xarray and pandas stay.  Of lists and arrays of objects all elements have the unit of the first.

    Raises
    ------
    ParameterError
        A list of numbers with and without units, or with truth values; a duration in months or years.
    """
    if has_no_unit(value):
        return value, None
    if type(value) is list or type(value) is tuple:
        return _of_elements(name, value)
    if type(value) is np.ndarray and value.dtype.kind == "O" and value.ndim:
        elements, unit = _of_elements(name, list(value.flat))
        found = np.empty(value.size, object)
        found[:] = elements
        return found.reshape(value.shape), unit
    if _is_quantity(value):
        unit = value.units
        # in full words, whatever the default format of its registry
        return value.magnitude, format(unit, "D") if hasattr(unit, "dimensionality") else str(unit)
    if hasattr(value, "dtype") and (hasattr(value, "attrs") or hasattr(value, "to_numpy")):
        return _of_labelled(name, value)
    if (duration := _seconds(name, value)) is not None:
        return duration, "s"
    if isinstance(value, np.ndarray | np.generic):  # astropy's and unyt's
        unit = getattr(value, "unit", getattr(value, "units", None))
        return (value, None) if unit is None else (np.array(value, subok=False), str(unit))
    return value, None


def convert(name: str, value: Any, unit: str, wanted: str) -> Any:
    """Numbers in ``unit`` as numbers in ``wanted``; arguments and errors of :func:`to_unit`."""
    if unit == wanted or (wanted == "1" and unit.strip() in _NO_UNIT):
        return value
    if unit.strip() in _NO_UNIT and wanted != "rad":
        raise unit_error(name, "units of 1, without dimension", wanted)
    cycles = wanted != "rad s-1" and _HERTZ.search(unit)
    if cycles or (wanted == "rad" and _SHARE.search(unit)) or (wanted == _TEMPERATURE and "delta" in unit):
        raise unit_error(name, unit, wanted)
    try:
        times, zero = conversion_factor(unit, wanted)
    except ParameterError as error:
        raise unit_error(name, unit, wanted, known="pint knows" not in error.allowed) from None
    if zero and wanted != _TEMPERATURE:
        raise unit_error(name, unit, wanted)
    if isinstance(value, list):
        return [convert(name, each, unit, wanted) for each in value]
    number = _as_floats(name, value)
    return number * times + zero if zero else number * times


def _as_floats(name: str, value: Any) -> Any:
    """The numbers of a quantity as doubles, with their labels; raises ParameterError for what are no numbers."""
    kind = getattr(getattr(value, "dtype", None), "kind", "")
    try:
        if kind in ("i", "u", "f") or (kind == "O" and all(map(is_real, np.asarray(value).flat))):
            return value.astype(np.float64)
        if not kind and is_real(value):
            return float(value)
    except OverflowError:  # an integer beyond the doubles
        pass
    raise ParameterError(name, describe_value(value), "a finite number")


def is_real(value: Any) -> bool:
    """Whether an object is a real number, of Python or another library; no truth value."""
    return isinstance(value, Real | Decimal) and not isinstance(value, bool)


def unit_error(name: str, unit: str, wanted: str, known: bool = True) -> ParameterError:
    """The error where an argument that is counted in ``wanted`` is given in a ``unit`` that does not become it."""
    must = "a number without dimension" if wanted == "1" else f"in {wanted}, or in a unit of that dimension"
    which = f"in {unit:.40}" + ("" if known else ", a unit that is not known")
    return ParameterError(name, which, must, f"{name} is {which}: must be {must}")


def _is_quantity(value: Any) -> bool:
    """Whether it is a quantity of pint, or like one."""
    return hasattr(value, "magnitude") and hasattr(value, "to")


def _of_elements(name: str, values: Any) -> tuple[list[Any], str | None]:
    """The elements of a list without their units, all in that of the first."""
    parts = [split_unit(name, each) for each in values]
    units = list(dict.fromkeys(unit for _, unit in parts))
    if any(isinstance(plain, bool | np.bool_) for plain, _ in parts):
        raise ParameterError(name, f"{values!r:.60}", "numbers, no truth values")
    if len(units) > 1 and None in units:
        raise ParameterError(name, "numbers, some with units and some without", "alike")
    if len(units) <= 1:
        return [plain for plain, _ in parts], units[0] if units else None
    first: Any = units[0]
    return [convert(name, plain, str(unit), first) for plain, unit in parts], first


def _of_labelled(name: str, value: Any) -> tuple[Any, str | None]:
    """An array of xarray, a series or an index of pandas, with its labels, and the unit that it carries.

    That is the one of its elements, of its attributes, or in its title, as results write their columns.
    """
    of_xarray = hasattr(value, "dims")
    data = value.data if of_xarray else getattr(getattr(value, "array", None), "quantity", value.to_numpy())
    plain, own = split_unit(name, data)
    said = getattr(value, "attrs", {}).get("units", _of_column(getattr(value, "name", None)))
    if said is None and plain is data:
        return value, None
    if said is not None and own is not None:
        plain = convert(name, plain, own, str(said))
    unit = own if said is None else str(said)
    if not of_xarray:
        return type(value)(plain, index=value.index, name=value.name) if hasattr(value, "index") else plain, unit
    found = value.copy(deep=False, data=plain)
    found.attrs = {}  # it is of no unit any more
    return found, unit


def _of_column(title: Any) -> str | None:
    """The unit in the title of a column, as of "V [km/h]" of a table of pandas; None without, or of what is no unit."""
    found = _COLUMN.search(title) if isinstance(title, str) else None
    if found is None or found[1].strip() in _NO_UNIT:
        return None
    try:
        conversion_factor(found[1], found[1])
    except ParameterError:
        return None
    return found[1]


def _seconds(name: str, value: Any) -> Any:
    """Durations of Python, numpy and pandas in seconds; None of what is none."""
    if isinstance(value, timedelta):
        value = value.to_timedelta64() if hasattr(value, "to_timedelta64") else np.timedelta64(value)
    if getattr(getattr(value, "dtype", None), "kind", "") != "m" or isinstance(value, np.ma.MaskedArray):
        return None
    found = np.asarray(value)
    if np.datetime_data(found.dtype)[0] in ("generic", "Y", "M"):
        raise ParameterError(name, f"{value!r:.60}", "a duration in weeks, days, hours, seconds or parts of them")
    return found / np.timedelta64(1, "s")
