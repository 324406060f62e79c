"""Storage and loss modulus over frequency from a text file: :func:`read_dma`."""

from __future__ import annotations

import re
import warnings
from collections.abc import Mapping
from itertools import product
from os import PathLike
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ...core.errors import FileError, ModelWarning, ParameterError, caller_level, check_names
from ...io.measurements import Numbers, Table, conversion, read_table
from .column_quantities import Column, columns_of, numbers_of
from .dynamic_moduli import SAME_TEMPERATURE, DynamicModuli
from .moduli_from_pair import AVERAGED, PAIRS, storage_and_loss
from .vocabulary import OF_SHEAR, UNITS, meanings

#: relative difference of frequencies in Hz and in rad/s that agree: 6.28 in place of 2 pi is off by 5e-4
_ROUND_PI = 1e-3
#: relative difference of frequencies that are one: instruments keep theirs to this
_ONE_FREQUENCY = 1e-3
#: ratio of moduli at one frequency and one temperature above which something else was varied
_REPEATED = 1.25
#: advice where columns are not understood
_NAME_THEM = "name the columns by columns={...} (`viscoroll material fit`: --column NAME=HEADING)"
#: a line with a number in degrees Celsius or kelvin, which is no rate, or with a word for temperature before a number
_TEMPERATURE = re.compile(r"\d\s*(?:℃|(?:[°º]\s*|deg\s*)?[CK]\b)(?!\s*/)|(?i:temp(?:[eé]rat|\b).*\d)")


def read_dma(
    path: str | PathLike[str], *, columns: Mapping[str, str] | None = None,
    units: tuple[str, str] | Mapping[str, str] | None = None, decimal: str | None = None, encoding: str | None = None,
) -> DynamicModuli:  # fmt: skip
    """Read storage and loss modulus over frequency, as instruments and spreadsheets write them.

    The headings say which column is which, in any order: frequency or angular frequency (reduced ones first), and two
    of storage, loss, tan delta or phase angle, and magnitude of the complex modulus, or the same of compliances.  A
    third is compared with what the two give.  Units stand after the names or in a row of their own.  Other columns are
    left out and listed in ``notes``.  Columns are parted by tabs, semicolons, commas or blanks; there may be lines
    before the headings, and comments that begin with ``#``.

    Parameters
    ----------
    path : a text file in UTF-8, UTF-16 or Latin-1.
    columns : meaning -> heading, as ``{"storage": "Module 1"}``, of columns whose names are not understood; meanings
        are frequency, angular frequency, storage, loss, tan delta, phase angle, modulus (the magnitude), storage
        compliance, loss compliance, modulus compliance, temperature, and reduced (angular) frequency.  The columns of a
        file without headings are called "column 0", "column 1" ...; if there are three, they are taken as angular
        frequency, storage and loss, in this order.
    units : units of frequency and of moduli, as ("Hz", "MPa"), of columns that the file gives none for; or meaning
        -> unit, in place of what the file says.  Columns for which neither gives a unit are taken in Hz (frequencies),
        rad/s (angular frequencies), Pa (moduli), degrees (phase angles) and degrees Celsius, the first three with a
        warning; compliances must have one, and so must temperatures above 200 and phase angles of which none is above
        pi/2, since they may be in kelvin or in radians.
    decimal : "." or ","; default: the one that the numbers have.
    encoding : encoding of the file; default: by its first bytes.

    Returns
    -------
    DynamicModuli
        ``omega`` in rad/s, ``storage`` and ``loss`` in Pa and ``temperature`` in degrees Celsius or None, (n,) each, in
        the order of the file; ``mode`` is "shear" where the headings say so, else "tension".  ``temperature`` is None
        where the file has no column of it, and of reduced frequencies at several temperatures, which belong to a
        reference that no column says; ``notes`` then quotes lines above the headings that state one.  ``print`` shows
        in three lines what was understood.  It unpacks into three arrays: ``omega, storage, loss = read_dma(path)``.

    Raises
    ------
    FileError
        A file that cannot be read, is no text or has no table; tables with different headings; columns that are
        missing, ambiguous or contradict each other, units that are missing, unknown or of another dimension, gaps and
        separators of thousands; a frequency or modulus that is not > 0 and finite, a phase angle of 90 degrees and
        more, a temperature at or below absolute zero; a modulus from a magnitude and storage or loss that the digits of
        the file leave uncertain by more than 5 %; all rows at one frequency; several moduli at one frequency, or
        several tables, without a column of temperatures.
    ParameterError
        Names or headings in ``columns``, units, a decimal mark or an encoding that are not allowed or not in the file,
        also the unit of a quantity of which the file has no column.

    Warns
    -----
    ModelWarning
        Where neither the file nor ``units`` says what a column is in.

    Examples
    --------
    >>> import viscoroll as vr
    >>> omega, storage, loss = vr.read_dma(vr.datasets.path("dma.csv"))  # rad/s, Pa, Pa
    """
    if not isinstance(columns, Mapping | None):
        raise ParameterError("columns", f"{columns!r:.60}", "quantity -> heading")
    named = dict(columns or {})
    check_names("columns", named, UNITS, "a quantity")
    overruling, defaults = _units(units)
    table = read_table(path, lambda cells: _is_heading_line(cells, named), decimal=decimal, encoding=encoding)
    if table.without_headings and not named:
        if len(table.headings) != 3:
            count = len(table.headings)
            problem = f"has {count} columns, and no headings for frequency, storage and loss modulus"
            raise FileError(path, f"{problem}: {_NAME_THEM}")
        named = dict(zip(("angular frequency", "storage", "loss"), table.headings, strict=True))
    found, others = columns_of(table, named, overruling, defaults)
    check_names("units", overruling, [column.name for column in found], "a quantity of this file")
    notes = [f"{table.parts} tables"] * (table.parts > 1)
    # as rheometers write; instruments of tension name E
    beside = next((heading for heading in others if OF_SHEAR.search(heading)), None)
    mode, pair, columns_of_quantity = _choose_columns(table, found, others)
    if not mode:
        mode = "shear" if beside else "tension"
        reason = f"{beside!r} is beside them" if beside else "no heading says E or G"
        notes.append(f"{mode} is assumed, since {reason}")
    numbers = {
        quantity: _agreeing_numbers(table, quantity, alike, others) for quantity, alike in columns_of_quantity.items()
    }
    temperature = numbers.get("temperature")
    if temperature and "reduced frequency" in numbers and np.ptp(temperature.values) > SAME_TEMPERATURE:
        temperature = None
        others[columns_of_quantity.pop("temperature")[0].heading] = "reduced frequencies belong to one temperature"
    omega = numbers[next(name for name in numbers if name.endswith("frequency"))].values
    moduli = {name: numbers[name] for names in PAIRS for name in names if name in numbers}
    storage, loss = storage_and_loss(table, pair, moduli)
    taken = [alike[0] for alike in columns_of_quantity.values()]
    sources = [columns_of_quantity[name][0].name for name in pair]
    if any(UNITS[name] == "1/Pa" for name in sources):
        with np.errstate(all="ignore"):  # what is not finite is refused
            square = storage**2 + loss**2
            storage, loss = storage / square, loss / square
    for name, values in {"frequency": omega, "storage modulus": storage, "loss modulus": loss}.items():
        table.require((values > 0.0) & (values < np.inf), f"the {name} is not > 0 and finite: remove the row")
    if sources != ["storage", "loss"]:
        notes.append(f"moduli are from {' and '.join(sources)}")
    notes += [f"{name} agrees with them" for name in moduli if name not in pair]
    notes += [f"{column.heading!r} is log10" for column in taken if column.log]
    listed = ", ".join(f"{heading!r}" + f" ({why})" * bool(why) for heading, why in others.items())
    notes += [f"unused: {listed}"] * bool(others)
    stated = ", ".join(f"{' '.join(line.split())!r:.60}" for line in table.above if _TEMPERATURE.search(line))
    if stated and temperature is None:
        notes.append(f"no temperature is read from lines above the headings, {stated}: give temperature= to fit_prony")
    _warn_of_assumed_units(table, taken)
    record = DynamicModuli(
        omega, storage, loss, temperature and temperature.values, mode,
        Path(path).name.encode(errors="replace").decode(),
        {column.name: column.heading for column in taken}, {column.name: column.unit for column in taken}, tuple(notes),
    )  # fmt: skip
    _refuse_mixed_sweeps(table, record)
    return record


class _Choice(NamedTuple):
    """The columns that :func:`read_dma` reads, as :func:`_choose_columns` chose them.

    mode : "tension", "shear", or "" where no heading says.
    pair : the two quantities that give the moduli, or compliances, a key of :data:`.moduli_from_pair.PAIRS`.
    columns : quantity (:attr:`.column_quantities.Column.quantity`) -> its columns, one or more, which must then agree;
        those of ``mode`` or of no mode, and all of moduli or all of compliances.
    """

    mode: str
    pair: tuple[str, str]
    columns: dict[str, list[Column]]


def _units(units: Any) -> tuple[dict[str, str], dict[str, str]]:
    """Split the argument ``units`` into units that replace those of the file and units for columns that have none.

    units : argument ``units`` of :func:`read_dma`: None; (unit of frequencies, unit of moduli), as ("Hz", "MPa"); or
        quantity -> unit, with the keys of :data:`.vocabulary.UNITS`.
    Returns two dicts quantity -> unit: the first replaces what the file says, the second holds where the file gives
    none. One of them is empty: the first for a pair, the second for quantity -> unit, and both for None.
    Raises ParameterError for another form, an unknown quantity, a unit that is unknown or of another dimension.
    """
    by_name = isinstance(units, Mapping)
    allowed = "(frequency, moduli), as ('Hz', 'MPa'), or quantity -> unit"
    if not (units is None or by_name or (isinstance(units, (tuple, list)) and len(units) == 2)):
        raise ParameterError("units", f"{units!r:.60}", allowed)
    of_two = zip(("rad/s", "Pa"), units or (), strict=False)
    pairs = dict(units) if by_name else {name: unit for kind, unit in of_two for name in UNITS if UNITS[name] == kind}
    check_names("units", pairs, UNITS, "a quantity")
    for name, unit in pairs.items():
        try:
            conversion(str(unit), UNITS[name])
        except ParameterError as error:
            raise ParameterError("units", f"{units!r:.60}", f"{allowed}; {unit!r} is not a unit of {name}") from error
    return (pairs, {}) if by_name else ({}, pairs)


def _is_heading_line(cells: list[str], named: Mapping[str, str]) -> bool:
    """Return whether a line of the file is the one with the headings, which :func:`.read_table` looks for.

    It is if its cells name at least two different known quantities, or if a cell is a heading that the user gave.

    cells : texts of the cells of the line, with units or without.
    named : quantity -> heading, the argument ``columns`` of :func:`read_dma`; empty where the user named none.
    """
    quantities = {found[0].name for cell in cells if cell and (found := meanings(cell))}
    return len(quantities) > 1 or not set(named.values()).isdisjoint(filter(None, cells))


def _choose_columns(table: Table, found: list[Column], others: dict[str, str]) -> _Choice:
    """Choose the columns from which frequency and moduli are read: one mode, one pair of quantities, one kind of
    frequency.

    Tension comes before shear, moduli before compliances, and the pairs in the order of
    :data:`.moduli_from_pair.PAIRS`.

    table : the table of the file; it is used for the error message only.
    found : list of :class:`Column`, columns of known quantities, in the order of the file.
    others : heading -> why the column is left out, "" for an unknown quantity.  It is changed: columns of another mode
        or kind than the pair, and measured frequencies beside reduced ones, are added.
    Returns the :class:`_Choice`; its ``columns`` have temperature, and quantities beside the pair, too.
    Raises FileError where no column is a frequency, or no two give the moduli; its message lists the headings.
    """
    modes = [mode for mode in ("tension", "shear") if any(column.mode == mode for column in found)]
    quantities = {column.quantity for column in found}
    problem = "no column was found for frequency" + ": this is a sweep of temperature, not of frequency" * (
        "temperature" in quantities
    )
    if quantities & {"frequency", "reduced frequency"}:
        problem = "fewer than two columns were found of storage, loss, tan delta and modulus"
        for mode, excluded in product(modes or [""], ("1/Pa", "Pa")):
            columns: dict[str, list[Column]] = {}
            unused = {}
            for column in found:
                if column.mode not in ("", mode) or UNITS[column.name] == excluded:
                    unused[column.heading] = "not needed"
                elif column.quantity == "frequency" and "reduced frequency" in quantities:
                    unused[column.heading] = "the reduced frequency is taken"
                else:
                    columns.setdefault(column.quantity, []).append(column)
            for pair in PAIRS:
                if columns.keys() >= {*pair}:
                    others |= unused
                    return _Choice(mode, pair, columns)
    reasons = "".join(f"; {heading!r}: {why}" for heading, why in others.items() if why)
    headings = ", ".join(map(repr, filter(None, table.headings)))
    raise FileError(
        table.path,
        f"{problem}{reasons}; headings: {headings}; {_NAME_THEM}",
    )


def _agreeing_numbers(table: Table, quantity: str, alike: list[Column], others: dict[str, str]) -> Numbers:
    """Return the numbers of the first of several columns of one quantity, after a check that the others agree with it.

    Frequencies agree to 0.1 %, moduli and tan delta to 1 %, temperatures to 1 K, each beside the rounding of the
    digits.

    table : :class:`Table`, the table that has the columns.
    quantity : name of their quantity (:attr:`.column_quantities.Column.quantity`), as "frequency" or "storage".
    alike : list of :class:`Column`, the columns of this quantity, at least one.
    others : heading -> why the column is left out.  It is changed: all columns but the first are added.
    Returns :class:`Numbers` of the first column: values, and half a unit of their last digits, (n,) each, in rad/s, Pa,
    1/Pa, degrees Celsius or, of tan delta, dimensionless.
    Raises FileError with the line where two columns contradict each other, or where a cell is no number, and for a unit
    that is missing and cannot be assumed.
    """
    first = numbers_of(table, alike[0])
    for column in alike[1:]:
        second = numbers_of(table, column)
        relative = 0.0 if quantity == "temperature" else _ROUND_PI if quantity.endswith("frequency") else AVERAGED
        allowed = relative * np.abs(first.values) + SAME_TEMPERATURE * (quantity == "temperature")
        agrees = np.abs(first.values - second.values) <= first.half + second.half + allowed
        same = column.heading == alike[0].heading
        advice = "rename or remove one in the file" if same else f"choose by columns={{{quantity!r}: ...}}"
        table.require(agrees, f"{alike[0].heading!r} and {column.heading!r} contradict each other: {advice}")
        others[column.heading] = f"agrees with {alike[0].heading!r}"
    return first


def _warn_of_assumed_units(table: Table, taken: list[Column]) -> None:
    """Warn, by one ModelWarning, of frequencies and moduli whose unit neither the file nor the user gives.

    Temperatures, phase angles and compliances are not examined here.  There is no warning where all units are given.

    table : :class:`Table`, the table of the file, for the messages.
    taken : list of :class:`Column`, the columns that are read.
    Raises FileError for a modulus without a unit beside one that has it, and for a frequency likewise.
    """
    assumed = []
    for word, unit in {"frequency": "rad/s", "moduli": "Pa"}.items():
        alike = [column for column in taken if UNITS[column.name] == unit]
        without = [column for column in alike if not column.stated]
        if without and len(without) < len(alike):
            raise FileError(table.path, f"column {without[0].heading!r} has no unit, but others do: give units=")
        assumed += [f"{column.unit} ({word})" for column in without[:1]]
    if assumed:
        text = f"{table.path}: columns without a unit are taken in {' and '.join(assumed)}"
        warnings.warn(f"{text}: write units into the file, or give units=", ModelWarning, stacklevel=caller_level())


def _refuse_mixed_sweeps(table: Table, record: DynamicModuli) -> None:
    """Refuse what is not one frequency sweep at each temperature.

    These are: rows that are all of one frequency (to 0.1 %, at least two rows); several tables in the file without a
    column of temperatures; where all rows are of one temperature, within 1 K or because the file has none, two of one
    frequency whose storage moduli differ by more than a factor of 1.25.

    table : :class:`Table`, the table from which the record was read; its lines are named in the message.
    record : :class:`DynamicModuli`, the moduli in the order of the rows.
    Raises FileError for each of the three; returns nothing.
    """
    omega, n = record.omega, record.omega.size
    if n > 1 and omega.max() < (1.0 + _ONE_FREQUENCY) * omega.min():
        problem = f"all {n} rows are of one frequency, {omega[0]:.4g} rad/s: this is not a frequency sweep"
        raise FileError(table.path, problem)
    if record.temperature is None and table.parts > 1:
        raise FileError(
            table.path, f"has {table.parts} tables, and no column states their temperature: keep one of them"
        )
    if record.isothermal:
        order = np.argsort(omega, kind="stable")
        same = np.diff(omega[order]) <= _ONE_FREQUENCY * omega[order][1:]
        repeats = np.abs(np.diff(np.log(np.abs(record.storage[order])))) <= np.log(_REPEATED)
        holds = np.ones(n, bool)
        holds[order[1:]] = repeats | ~same
        problem = "an earlier row has the same frequency and another modulus"
        table.require(holds, f"{problem}: rows at several temperatures or strains need a column of temperature")
