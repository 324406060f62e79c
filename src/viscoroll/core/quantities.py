"""Units and symbols of all quantities: the one table of dimensions, the units in which a roller
counts (:class:`Scale`), symbols, meanings and equations; and inputs with units: quantities of pint,
astropy and unyt, arrays of xarray with an attribute ``units``, columns of pandas with a unit in the
title, durations of Python, pandas and numpy.

Quantities of a scene are dimensionless: each is divided by a unit that is made of the radius R, the
time T_epsilon, the load P, the mass m, the contact length at rest l0 and the modulus E'.
Quantities of a cylinder are in SI units, and a material may have a unit of time of its own (T_ref).
Files, figures and ``docs/symbols.md`` take their words and units from here.

Factors of conversion are those of pint, which is imported at the first conversion.
:func:`to_unit` converts a value with a unit to the unit of the argument, or raises ParameterError.
Values without a unit, and the labels of xarray and pandas, stay as they are.
"""

import csv
import datetime
import decimal
import re
from functools import lru_cache
from importlib import resources
from numbers import Real
from typing import Any, NamedTuple, Protocol, TypeGuard

import numpy as np

from .errors import ParameterError, describe_value, described_error, unit_error

# --- Units of each quantity ---


def _rows(table: str) -> list[list[str]]:
    """Return the rows of a ``table``, a CSV file beside this module, without its head."""
    with (resources.files(__package__) / table).open(encoding="utf-8") as file:
        return [*csv.reader(file)][1:]


class Dimension(NamedTuple):
    """A dimension, and the quantities that have it.

    formula : product of R, T, P, m, l0, E_prime and rad, as "P T/R"; of temperatures and energies
    another name.
    si_unit : as "N s m-2".
    divisor : words that follow the name of a quantity of a scene: the unit by which it is divided.
    names : quantities, separated by spaces.
    """

    formula: str
    si_unit: str
    divisor: str
    names: str


#: Quantity -> its dimension, from the rows of dimensions.csv.  A quantity that is not here is a
#: ratio.
DIMENSIONS = {
    name: dimension
    for dimension in (Dimension(*row) for row in _rows("dimensions.csv"))
    for name in dimension.names.split()
}


def dimension_powers(dimension: str) -> dict[str, int]:
    """Return the powers of the factors of a dimension or a unit.

    dimension: product of symbols, as "P T/R", "N m/m" or "N m m-1"; an integer after a symbol is
        its power, with or without "^" between, and all symbols after the first "/" are divisors.
    Returns symbol -> power, an int other than 0, without symbols whose powers cancel.
    """
    found: dict[str, int] = {}
    for n, part in enumerate(dimension.split("/")):
        # letters, of l0 with its digit, then perhaps a power
        for symbol, power in re.findall(r"([^\W\d]+0?|%)\^?(-?\d+)?", part):
            found[symbol] = found.get(symbol, 0) + (-1 if n else 1) * int(power or 1)
    return {symbol: power for symbol, power in found.items() if power}


#: Quantity -> powers of the factors of its dimension.
_POWERS = {name: dimension_powers(dimension.formula) for name, dimension in DIMENSIONS.items()}
#: Quantity -> power of time in its dimension, where that is not 0.
TIME_POWERS = {name: powers["T"] for name, powers in _POWERS.items() if "T" in powers}


class Scale(dict[str, Any]):
    """Unit of each quantity by its name: ``scale["V"]`` is the m/s of a unit of speed; 1 of scenes.

    Parameters
    ----------
    R, T, P, m, l0, E_prime : radius (m), time (s), load (N/m), mass (kg/m), contact length at rest
        (m) and modulus (Pa); numbers, or arrays of many cylinders.
    si : whether these are SI units.
    """

    si: bool

    def __init__(
        self,
        R: Any = 1.0,
        T: Any = 1.0,
        P: Any = 1.0,
        m: Any = 1.0,
        l0: Any = 1.0,
        E_prime: Any = 1.0,
        *,
        si: bool = True,
    ) -> None:
        """Keep the units of which all others are products, by name, and that of angles, 1 rad.

        The arguments are those of the class.
        """
        super().__init__(R=R, T=T, P=P, m=m, l0=l0, E_prime=E_prime, rad=1.0)
        self.si = si

    # The units may be arrays, whose comparison gives no truth value.
    __eq__ = object.__eq__
    __hash__ = object.__hash__  # type: ignore[assignment]

    def __missing__(self, name: str) -> Any:
        """Compute and keep the unit of a quantity; Python calls it where the dict has no entry.

        name: name of the quantity, as "V".
        Returns the factor by which a dimensionless value is multiplied to be in SI units, a float,
        or an array (n,) of many cylinders; 1.0 for a ratio, a temperature, a molar energy, a name
        that the table of dimensions does not have, and for a scene.
        """
        # one division in place of negative powers, each of which would round
        numerator = 1.0
        denominator = 1.0
        for factor, power in _POWERS.get(name, {}).items():
            if power > 0:
                numerator = numerator * self[factor] ** power
            else:
                denominator = denominator * self[factor] ** -power
        self[name] = unit = numerator / denominator
        return unit

    def unit(self, name: str) -> str:
        """Unit of a quantity, as "m s-1"; "1" for a ratio, and in a scene for all but angles."""
        return si_unit(name) if self.si or name in ("angle", "slope") else "1"


class HasUnits(Protocol):
    """An object with a unit for each quantity: a :class:`Scale`, a record of measurements."""

    def unit(self, name: str) -> str:
        """Name of the unit of a quantity."""


#: Unit of an argument, or an object that gives it by the name of the argument.
Units = str | HasUnits

#: Scale of a scene: every unit is 1.
DIMENSIONLESS = Scale(si=False)
#: Scale of functions that take and return SI units and have no cylinder.
SI = Scale()


def si_unit(name: str) -> str:
    """SI unit of a quantity, as "m s-1"; "1" for a ratio."""
    return DIMENSIONS[name].si_unit if name in DIMENSIONS else "1"


# --- Symbols of all quantities ---

#: Attribute of a dataset over V: the lowest and the highest speed at which the material was
#: measured.
MEASURED = "measured_V"


class Symbol(NamedTuple):
    """A quantity.

    latex : symbol, "" of a quantity without one, whose range and equation are "" too.
    long_name : meaning.
    range : allowed values.
    equation : the equation or section of the paper that has it, "" without one.
    """

    latex: str
    long_name: str
    range: str
    equation: str


_WORDS = {name: Symbol(*cells) for name, *cells in _rows("symbols.csv")}
#: Name in code -> symbol; the rows of symbols.csv that have one.
SYMBOLS = {name: symbol for name, symbol in _WORDS.items() if symbol.latex}


def attributes(name: str, si: bool = False) -> dict[str, str]:
    """Return the attributes of a quantity in a dataset.

    name: name of the quantity in code, as "delta_star".
    si: whether it is in SI units, else dimensionless.
    Returns a dict with long_name ("" of an unknown name) and units ("1" of a dimensionless quantity
    and of an unknown name).  It also has symbol (LaTeX) and equation ("" for none) if the table of
    symbols has the name, unless the quantity is in SI units and has a dimension, as symbols stand
    for dimensionless quantities.
    """
    found = {"long_name": describe_quantity(name, si), "units": si_unit(name) if si else "1"}
    if name in SYMBOLS and not (si and name in DIMENSIONS):
        found |= {"symbol": SYMBOLS[name].latex, "equation": SYMBOLS[name].equation}
    return found


def describe_quantity(name: str, si: bool = False) -> str:
    """Return the meaning of a quantity in words, as for long_name of a dataset; "" where it is not
    known.

    name: name of the quantity in code, or of a slope as "dQ_dV".
    si: whether it is in SI units; a quantity whose unit is per m, as a force in N/m, ends with ",
        per length of the cylinder" then.  Else the words end with the unit by which the quantity is
        divided, as ", divided by R", of an angular velocity with ", multiplied by T_epsilon", of an
        angle with ", radians".  A ratio, and a temperature, has no such ending in either case.
    """
    if name in _WORDS:
        text = _WORDS[name].long_name
        if si and name == "delta":
            # the creepage of a scene is in units where R = 1
            text = text.replace("omega", "omega R")
    elif name.startswith("d") and "_d" in name:
        dependent, _, variable = name[1:].partition("_d")
        text = f"partial derivative of {dependent} with respect to {variable}"
    else:
        text = ""
    if not text or name not in DIMENSIONS:
        return text
    dimension = DIMENSIONS[name]
    return text + (
        ", per length of the cylinder" * dimension.si_unit.endswith(" m-1")
        if si
        else dimension.divisor
    )


# --- Factors of conversion between units, by pint ---

#: Character of a unit that pint does not read -> spelling that it reads.
_SPELLINGS = str.maketrans("²³⁻¹·⋅µμ", "23-1  uu") | {ord("°"): "deg"}

#: Texts for the unit of a dimensionless number.
_DIMENSIONLESS = ("", "1", "-", "dimensionless")
#: Units of angles, turns and cycles, and of these per time.
CYCLES = re.compile(
    r"(?i)hz|hertz|count|[cr]p[ms]|rad|rev|cyc|circ|turn|osc|giri|tours|\b(?:[ucr]|tr|umdr)/|upm|u\s*min|deg|gon|arc|°"
)
#: Remark on an angular velocity in a unit that is none of these, as 1/min.
TURNS = ", which may be turns (write rpm or turn/s) or radians (write rad/min or rad/s)"


@lru_cache(maxsize=1)
def registry() -> Any:
    """Return the pint registry of this package: 1 Hz and 1 cps are 2 pi rad/s, 1 rpm 2 pi/60."""
    import pint

    units: Any = pint.UnitRegistry(autoconvert_offset_to_baseunit=True, on_redefinition="ignore")
    units.define("hertz = 2 * pi * radian / second = Hz")
    units.define("counts_per_second = hertz = cps")
    return units


@lru_cache(maxsize=256)
def conversion_factor(unit: str, target: str) -> tuple[float, float]:
    """Return factor and offset of a conversion: number in ``target`` = factor * number in
    ``unit`` + offset.

    unit, target: as people write them: "km/h", "N/mm²", "m s-1", "°C"; "" and "1" are a ratio's.
    Returns two floats; the offset, in ``target``, is 0 but for temperatures with different zeros.
    Raises ParameterError for a unit that is not known or of another dimension; an angle for a ratio
    ("1"), a ratio for an angle ("rad"; a slope of 5 % is one of atan(0.05)), and 1/min and the like
    for an angular velocity ("rad s-1"), where 1/s is accepted, V/R in lengths as pint writes them
    ("kilometer / centimeter / hour"), and Hz, which is 2 pi rad/s.
    """
    import pint

    quantity = registry().Quantity
    allowed = f"a unit of the dimension of {target}" if target != "1" else "a unit of a ratio, as %"
    try:
        at_0, at_1 = (
            quantity(number, pint_spelling(unit)).to(pint_spelling(target)).magnitude
            for number in (0.0, 1.0)
        )
    except pint.DimensionalityError:
        raise ParameterError("unit", unit, allowed) from None
    except Exception as error:  # pint raises errors of its own parser and of Python's
        raise ParameterError("unit", f"{unit:.40}, a unit that is not known", allowed) from error
    says = CYCLES.search(unit) is not None
    remark = ""
    if target == "rad s-1" and at_1 != 1.0 and not says and "meter" not in unit:
        remark = TURNS
    elif target == "1" and says:
        remark = ", an angle"
    elif target == "rad" and not says and unit.strip() not in _DIMENSIONLESS:
        remark = ", a ratio"
    if remark:
        raise ParameterError("unit", unit + remark, allowed)
    # Without an offset the factor is the converted 1 itself, so that exact ones stay exact.
    return (at_1 - at_0, at_0) if at_0 else (at_1, 0.0)


def is_unit(text: str) -> bool:
    """Return whether pint reads a text as a unit, of any dimension.

    text: the text, as "km/h".  "C" is coulomb, not degree Celsius.
    """
    try:
        registry().parse_units(pint_spelling(text))
    except Exception:  # pint raises errors of its own parser and of Python's
        return False
    return True


def pint_spelling(unit: str) -> str:
    """Return a unit in the spelling of pint: superscripts and signs as ASCII, powers with ``**``.

    unit: unit as files and people write it, as "N/mm²"; of "" the result is "1".
    """
    power = r"([A-Za-z_%]+)\s*(?:\^|\*\*)?\s*\(?([+-]?\d+)\)?"  # as "m-1", "mm^2", "s**-2"
    return re.sub(power, r"\1**\2", unit.strip().translate(_SPELLINGS)) or "1"


# --- Inputs with units ---

#: Types without a unit and without labels.
UNITLESS_TYPES = frozenset((float, int, bool, str, complex, type(None), dict, np.float64))
#: Hertz in a unit, which has a clear meaning for an angular velocity alone: 2 pi rad/s.
_HERTZ = r"(?i)(?:^|[^a-z])[a-z]{0,2}hz(?:$|[^a-z])|hertz"
#: The only unit of arguments whose zero differs from that of other units of its dimension.
_TEMPERATURE = "degC"


def has_no_unit(value: Any) -> bool:
    """Whether the type of a value shows that it has no unit: a number, an array or a list of
    numbers.

    value: what a caller gave, of any type.
    Returns True also of None, texts, truth values, dicts, and arrays of texts or dates; False of
    anything else, which may have a unit: nested lists, arrays of objects or durations, numbers of
    numpy but float64, and instances of classes derived from those of Python and numpy.
    """
    kind = type(value)
    if kind is np.ndarray:
        return value.dtype.kind in "biufcUSM"  # truth values, numbers, texts, dates
    return kind in UNITLESS_TYPES or (
        kind in (list, tuple) and {float, int}.issuperset(map(type, value))
    )


def to_unit(name: str, value: Any, target: str) -> Any:
    """Convert a value that a caller gave with a unit to the unit of its argument.

    name: name of the argument.
    value: what a caller gave: a number, an array, a list, a quantity, a duration, an array of
        xarray, a series.
    target: SI unit of the argument as "m s-1"; "1" of a dimensionless number.
    Returns ``value`` itself if it has no unit, of whatever type it is, but a new list of a list or
    tuple with elements other than float and int, and a new array of an array of objects; else
    numbers in ``target``, in a container of the same kind (a list of a tuple), with the labels of
    xarray and pandas.
    Raises ParameterError as :func:`split_unit` and :func:`convert` do.
    """
    if _is_quantity(value) and not hasattr(value, "units"):
        try:
            return value.to(pint_spelling(target)).magnitude
        except Exception as error:  # libraries raise errors of their own
            found = f"cannot be converted ({' '.join(str(error).split()):.80})"
            raise unit_error(name, found, target) from error
    numbers, unit = split_unit(name, value)
    return numbers if unit is None else convert(name, numbers, unit, target)


def split_unit(name: str, value: Any) -> tuple[Any, str | None]:
    """Split a value into its numbers and its unit.

    Labels of xarray and pandas stay.  All elements of a list, or of an array of objects, are
    converted to the unit of the first.

    name: name of the argument, for errors.
    value: what a caller gave: a number, an array, a list, a quantity of pint, astropy or unyt, a
        duration, an array of xarray, a series or an index of pandas.
    Returns (numbers in the same kind of container, but a list in place of a tuple; their unit as a
    text, of pint in full, as "meter / second").  If there is no unit: (``value`` itself, None),
    except that lists with elements other than float and int and arrays of objects are new ones.
    Durations are numbers in "s".
    Raises ParameterError for a table of pandas, or a row of one; a list with truth values, or of
    numbers with and without units; a duration in months, years or without a unit; units of
    different dimensions in one list, or between the elements and the stated unit of an array of
    xarray or a series.
    """
    if has_no_unit(value):
        return value, None
    if type(value) in (list, tuple):
        return _split_elements(name, value)
    if type(value) is np.ndarray and value.dtype.kind == "O" and value.ndim:
        elements, unit = _split_elements(name, list(value.flat))
        # np.array would make further axes of elements that are lists
        numbers = np.empty(value.size, object)
        numbers[:] = elements
        return numbers.reshape(value.shape), unit
    if _is_quantity(value):
        unit = value.units
        # "D" is the format of pint for full names, whatever the default format of the registry is
        return value.magnitude, format(unit, "D") if hasattr(unit, "dimensionality") else str(unit)
    if hasattr(value, "columns"):  # DataFrame of pandas
        raise described_error(name, "is a table", "one column of it")
    # DataArray of xarray; Series or Index of pandas
    if hasattr(value, "dtype") and (hasattr(value, "attrs") or hasattr(value, "to_numpy")):
        return _split_labelled(name, value)
    if (duration := _to_seconds(name, value)) is not None:
        return duration, "s"
    unit = getattr(value, "unit", getattr(value, "units", None))  # of astropy and unyt
    if unit is not None and isinstance(value, np.ndarray | np.generic):
        # a plain array: the array type of the library would keep the unit
        return np.array(value, subok=False), str(unit)
    return value, None


def convert(name: str, value: Any, unit: str, target: str) -> Any:
    """Return numbers in one unit as numbers in another.

    name: name of the argument, for errors.
    value: number, array, or list of these, perhaps with labels, which stay.
    unit: their unit, as "km/h"; "", "1", "-" and "dimensionless" of a ratio; "-" is not allowed for
        an angle, the others are radians there.
    target: wanted unit, as "m s-1"; "1" of a dimensionless number, "rad" of an angle.
    Returns ``value`` itself if the texts of the units are equal or both mean a ratio.  Else numbers
    in ``target``: a float, a float64 array of the same shape with its labels, or a list of these.
    Raises ParameterError as :func:`conversion_factor`, for Hz of other arguments than an angular
    velocity and differences of temperature, and for numbers that are not numeric.
    """
    if unit == target or (target == "1" and unit.strip() in _DIMENSIONLESS):
        return value
    if unit.strip() in _DIMENSIONLESS and target != "rad":
        raise unit_error(name, "is without dimension (unit 1)", target)
    try:
        factor, offset = conversion_factor(unit, target)
    except ParameterError as error:
        raise unit_error(name, f"is in {error.value:.99}", target) from None
    # where no temperature is wanted, an offset makes the meaning unclear: 20 degC or 20 K more
    unclear = "delta" in unit if target == _TEMPERATURE else offset
    if unclear or (target != "rad s-1" and re.search(_HERTZ, unit)):
        raise unit_error(name, f"is in {unit:.99}", target)
    if isinstance(value, list):
        return [convert(name, element, unit, target) for element in value]
    number = _as_floats(name, value)
    # adding 0 would make -0.0 to 0.0
    return number * factor + offset if offset else number * factor


def _as_floats(name: str, value: Any) -> Any:
    """Return the numbers of a quantity as doubles, with labels.

    name: name of the argument, for the error.
    value: a number (int, float, Decimal, Fraction), or an array, perhaps with labels.
    Returns a float of a number, else a new float64 array, of the same type as ``value``.
    Raises ParameterError if they are not numeric (texts, truth values, complex numbers), or an
    integer is beyond the doubles.
    """
    kind = getattr(getattr(value, "dtype", None), "kind", "")
    try:
        if kind in ("i", "u", "f") or (kind == "O" and all(map(is_real, np.asarray(value).flat))):
            return value.astype(np.float64)
        if not kind and is_real(value):
            return float(value)
    except OverflowError:  # an integer that no double holds
        pass
    raise ParameterError(name, describe_value(value), "a finite number")


def is_real(value: Any) -> TypeGuard[float]:
    """Whether an object is a real number of Python or another library, and not a truth value."""
    return isinstance(value, Real | decimal.Decimal) and not isinstance(value, bool)


def _is_quantity(value: Any) -> bool:
    """Whether a value has the interface of a quantity of pint."""
    return hasattr(value, "magnitude") and hasattr(value, "to")


def _split_elements(name: str, values: Any) -> tuple[list, str | None]:
    """Split the unit from the elements of a list, all converted to the unit of the first.

    name: name of the argument, for errors.
    values: the list or tuple, whose elements may be lists, quantities, numbers or anything else.
    Returns (new list of numbers, all in the unit of the first element; that unit, None if no
    element has one, and of an empty list).
    Raises ParameterError for truth values, for numbers with and without a unit, and for units of
    different dimensions.
    """
    parts = [split_unit(name, value) for value in values]
    # different units in the order of the elements: the first is that of the result
    units = list(dict.fromkeys(unit for _, unit in parts))
    if any(isinstance(number, bool | np.bool_) for number, _ in parts):
        raise ParameterError(name, describe_value(values), "numbers, no truth values")
    if len(units) > 1 and None in units:
        raise described_error(
            name, "has numbers with a unit and numbers without", "all with a unit, or all without"
        )
    unit = units[0] if units else None
    return [
        number if own == unit else convert(name, number, str(own), str(unit))
        for number, own in parts
    ], unit


def _split_labelled(name: str, value: Any) -> tuple[Any, str | None]:
    """Split the unit from an array of xarray, a series or an index of pandas.

    The unit is stated by the attribute ``units``, else by the title of a column, as "V [m s-1]";
    elements with a unit of their own are converted to the stated one.  Without such a statement the
    unit is that of the elements.

    name: name of the argument, for errors.
    value: the array, series or index; not changed.
    Returns (numbers; unit).  Without a unit that is (``value`` itself, None); else the numbers are
    a new array or series with its labels, without attributes and name, of an index or a variable of
    xarray a plain array.
    Raises ParameterError where the unit of the elements is of another dimension than the stated
    one, for a series that is a row of a table, whose index has titles with units, and as
    :func:`split_unit` for the elements.
    """
    is_xarray = hasattr(value, "dims")
    index = None if is_xarray else getattr(value, "index", None)
    # a row of a table has fewer columns than are searched
    if index is not None and any(map(_title_unit, index[:100])):
        raise described_error(
            name, "is a row of a table (its index has units)", "a column of a table, or a number"
        )
    # pint's type of columns has its numbers and their unit in ``quantity``
    data = (
        value.data
        if is_xarray
        else getattr(getattr(value, "array", None), "quantity", value.to_numpy())
    )
    numbers, own = split_unit(name, data)
    stated = getattr(value, "attrs", {}).get("units", _title_unit(getattr(value, "name", None)))
    if stated is None and numbers is data:
        return value, None
    if stated is not None and own is not None:
        numbers = convert(name, numbers, own, str(stated))
    unit = own if stated is None else str(stated)
    if not hasattr(value, "coords"):
        return type(value)(numbers, index=index) if index is not None else numbers, unit
    # the old attributes and the name state the old unit
    labelled = value.copy(deep=False, data=numbers)
    labelled.attrs = {}
    labelled.name = None
    return labelled, unit


def _title_unit(title: Any) -> str | None:
    """Return the unit in brackets at the end of a title of a column, "km/h" of "V [km/h]".

    title: name of an array or a series; what is no text, as None, gives None.
    Returns None too if there are no brackets, or if they contain a unit of 1 or a text that pint
    does not know.
    """
    found = re.search(r"\[([^\[\]]+)\]\s*$", title) if isinstance(title, str) else None
    # text in brackets may be no unit, as "V [fast]"
    if found and found[1].strip() not in _DIMENSIONLESS and is_unit(found[1]):
        return found[1]
    return None


def _to_seconds(name: str, value: Any) -> Any:
    """Return durations of Python, numpy and pandas in seconds.

    name: name of the argument, for the error.
    value: what a caller gave, of any type.
    Returns a float or an array of the shape of ``value``, without its labels, NaN for NaT; None if
    the value is no duration, and for lists and masked arrays of durations.
    Raises ParameterError for a duration in months or years, or without a unit.
    """
    if isinstance(value, datetime.timedelta):  # that of pandas is one too, and has nanoseconds
        value = (
            value.to_timedelta64() if hasattr(value, "to_timedelta64") else np.timedelta64(value)
        )
    if getattr(getattr(value, "dtype", None), "kind", "") != "m" or isinstance(
        value, np.ma.MaskedArray
    ):
        return None
    durations = np.asarray(value)
    # generic: a number without a unit of time
    if np.datetime_data(durations.dtype)[0] in ("generic", "Y", "M"):
        raise ParameterError(
            name,
            describe_value(value),
            "a duration in weeks, days, hours, minutes, seconds or fractions of a second",
        )
    return durations / np.timedelta64(1, "s")
