"""Text files of tests of materials: storage and loss modulus over frequency (:func:`read_dma`), and
relaxation modulus over time (:func:`read_relaxation`).
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import product
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from ..core import FileError, Floats, warn_of_model
from .dma_columns import UNITS, Column, numbers_of, unit_advice
from .dynamic_moduli import SAME_TEMPERATURE, DynamicModuli, ModuliRecord
from .table_reader import (
    ONE_FREQUENCY,
    PAIRS,
    SOFTEST,
    agreeing_numbers,
    missing,
    quoted,
    refuse_repeats,
    refuse_unread_temperatures,
    storage_and_loss,
    temperatures_of_lines,
    understand,
    warn_of_assumed_units,
)
from .text_table import Table

# --- Relaxation modulus over time from a text file ---


@dataclass(frozen=True, eq=False, repr=False)
class RelaxationModulus(ModuliRecord):
    """Relaxation modulus over time, as :func:`viscoroll.read_relaxation` reads it from a file.

    It unpacks into its columns, ``t, relaxation = record``; ``fit_relaxation(record)`` takes it
    whole, with its temperature and its mode.

    Parameters
    ----------
    t : times since the strain was applied, s, shape (n,), in the order of the file.
    relaxation : relaxation modulus, Pa, shape (n,).
    temperature : temperature of the test, degrees Celsius; None where the file has none.
    mode : "tension" (E) or "shear" (G).
    source : name of the file.
    columns : meaning -> heading of the column that was taken for it.
    units : meaning -> unit in which that column was written.
    notes : sentences: what was computed, assumed, and which columns were left aside.

    Examples
    --------
    >>> import viscoroll as vr
    >>> vr.RelaxationModulus([0.1, 1.0, 10.0], [3e6, 2e6, 1.5e6], temperature=23.0).mode
    'tension'
    """

    TITLE = "Relaxation modulus"
    COLUMNS = ("t", "relaxation")
    AXES = ("time, s", "relaxation modulus, Pa")

    t: Floats
    relaxation: Floats
    temperature: float | None = None


def read_relaxation(
    path: str | PathLike[str],
    *,
    columns: Mapping[str, str] | None = None,
    units: tuple[str, str] | Mapping[str, str] | None = None,
    decimal: str | None = None,
    encoding: str | None = None,
) -> RelaxationModulus:
    """Read a relaxation modulus over time, as instruments and spreadsheets write it.

    The headings say which column is which, in any order: time, and the relaxation modulus, or
    stress and strain, of which it is the ratio.  Lines, separators and other columns are treated as
    of :func:`viscoroll.read_dma`.

    Parameters
    ----------
    path : a text file, in an encoding as in :func:`viscoroll.read_dma`.
    columns : meaning -> heading, of columns whose names are not understood; meanings are time,
        relaxation modulus, stress, strain and temperature.  Two columns without headings are taken
        as time and relaxation modulus.
    units : units of time and of moduli and stresses, as ("s", "MPa"), of columns that the file
        gives none for; or meaning -> unit, in place of what the file says.  Columns for which
        neither gives a unit are taken in s, Pa and degrees Celsius, the first two with a warning; a
        strain must have one.
    decimal : "." or ","; default: the one that the numbers have.
    encoding : encoding of the file; default: by its first bytes.

    Returns
    -------
    RelaxationModulus
        ``t`` in s and ``relaxation`` in Pa, (n,) each, in the order of the file; ``mode`` is
        "shear" where the headings say so, else "tension"; ``temperature`` is the median of its
        column.  Times are read as they are: leave out those before the strain was applied and those
        of the ramp.

    Raises
    ------
    FileError
        As in :func:`viscoroll.read_dma`: what is no table, columns that are missing or contradict
        each other, units; a time, modulus, stress or strain that is not > 0 and finite; several
        tests: tables, temperatures, or moduli at one time that differ by more than a factor of
        1.25.
    ParameterError
        Names or headings in ``columns``, units, a decimal mark or an encoding that are not allowed
        or not in the file.

    Warns
    -----
    ModelWarning
        Where neither the file nor ``units`` says what times or moduli are in.

    Examples
    --------
    >>> from pathlib import Path
    >>> import viscoroll as vr
    >>> size = Path("relaxation.csv").write_text(
    ...     "t [s];E(t) [MPa]\\n0,1;3,2\\n1;2,7\\n10;2,4\\n"
    ... )
    >>> record = vr.read_relaxation("relaxation.csv")
    >>> record.relaxation.tolist(), record.mode
    ([3200000.0, 2700000.0, 2400000.0], 'tension')
    """
    table, found, others = source = understand(
        path, "relaxation", columns=columns, units=units, decimal=decimal, encoding=encoding
    )
    alike: dict[str, list[Column]] = {}
    for column in found:
        alike.setdefault(column.quantity, []).append(column)
    pair = ("relaxation modulus",) if "relaxation modulus" in alike else ("stress", "strain")
    if "time" not in alike or not {*pair} <= alike.keys():
        raise missing(
            table,
            "relaxation",
            "no column was found for the relaxation modulus, nor for both stress and strain"
            if "time" in alike
            else "no column was found for time",
            others,
        )
    table.refuse_several()
    used = [name for name in ("time", *pair, "temperature") if name in alike]
    others |= {
        each.heading: "not needed" for name in alike.keys() - {*used} for each in alike[name]
    }
    numbers = {name: agreeing_numbers(table, name, alike[name], others).values for name in used}
    for name in used[: 1 + len(pair)]:  # all but the temperature
        holds = (numbers[name] > 0.0) & (numbers[name] < np.inf)
        table.require(holds, f"the {name} must be > 0 and finite: correct or remove the row")
    # a strain is in use only beside a stress
    relaxation = numbers[pair[0]] / numbers.get("strain", 1.0)
    refuse_repeats(table, "time", numbers["time"], relaxation)
    temperature = numbers.get("temperature")
    if temperature is None:
        refuse_unread_temperatures(table, others)
    elif np.ptp(temperature) > SAME_TEMPERATURE:
        raise FileError(
            table.path,
            f"is at {temperature.min():g} to {temperature.max():g} °C, and must be at one "
            "temperature: keep the rows of one",
        )
    taken = [alike[name][0] for name in used]
    warn_of_assumed_units(table, taken, relaxation)
    mode, notes = source.mode(next((each.mode for each in alike[pair[0]] if each.mode), ""))
    notes += ["the modulus is stress over strain"] * (len(pair) > 1) + source.notes(taken)
    return RelaxationModulus(
        t=numbers["time"],
        relaxation=relaxation,
        temperature=None if temperature is None else float(np.median(temperature)),
        mode=mode,
        notes=tuple(notes),
        **_origin(path, taken),
    )


def _origin(path: Any, taken: list[Column]) -> dict[str, Any]:
    """Return where the numbers of a record are from, as fields of the record.

    path: path of the file.
    taken: the columns that are read.
    Returns a dict with "source", name of the file; "columns", quantity -> heading; and "units",
    quantity -> unit in the file.
    """
    return {
        "source": Path(path).name.encode(errors="replace").decode(),
        "columns": {column.name: column.heading for column in taken},
        "units": {column.name: column.unit for column in taken},
    }


# --- Storage and loss modulus over frequency from a text file ---

#: tan delta that no rubber has at any frequency: that of damping rubbers in their glass transition
#: is below
_MOST_DAMPED = 3.0
#: a line with a number in degrees Celsius or kelvin, which is no rate, or with a word for
#: temperature before a number
_TEMPERATURE = re.compile(
    r"\d\s*(?:℃|(?:[°º]\s*|deg\s*)?[CK]\b)(?!\s*/)|(?i:temp(?:[eé]rat|\b).*\d)|温度.*\d"
)


def read_dma(
    path: str | PathLike[str],
    *,
    columns: Mapping[str, str] | None = None,
    units: tuple[str, str] | Mapping[str, str] | None = None,
    decimal: str | None = None,
    encoding: str | None = None,
) -> DynamicModuli:
    """Read storage and loss modulus over frequency, as instruments and spreadsheets write them.

    The headings say which column is which, in any order: frequency or angular frequency (reduced
    ones first), and two of storage, loss, tan delta or phase angle, and magnitude of the complex
    modulus, or the same of compliances.  A third is compared with what the two give.  Units stand
    after the names or in a row of their own; log and ln before a name are of base 10 and e.  Other
    columns are left out and listed in ``notes``, as are lines below the last row.  Columns are
    separated by tabs, semicolons, commas or blanks; there may be lines before the headings, and
    comments that begin with ``#``.  A line above each of several blocks of rows may state their
    temperature, as "Temperatur 20 °C".

    Parameters
    ----------
    path : a text file in UTF-8, UTF-16, cp932 or Latin-1.
    columns : meaning -> heading, as ``{"storage": "Module 1"}``, of columns whose names are not
        understood; meanings are frequency, angular frequency, storage, loss, tan delta, phase
        angle, modulus (the magnitude), storage compliance, loss compliance, modulus compliance,
        strain, temperature, and reduced (angular) frequency.  They replace all columns of the same
        quantity, as tan delta a phase angle.  The columns of a file without headings are called
        "column 0", "column 1" ...; if there are three, they are taken as angular frequency, storage
        and loss, in this order.
    units : units of frequency and of moduli, as ("Hz", "MPa"), of columns that the file gives none
        for; or meaning -> unit, in place of what the file says.  Columns for which neither gives a
        unit are taken in Hz (frequencies), rad/s (angular frequencies), Pa (moduli), degrees (phase
        angles) and degrees Celsius, the first three with a warning; compliances must have one, and
        so must temperatures above 200 and phase angles of which none is above pi/2, since they may
        be in kelvin or in radians.
    decimal : "." or ","; default: the one that the numbers have.
    encoding : encoding of the file; default: by its first bytes.

    Returns
    -------
    DynamicModuli
        ``omega`` in rad/s, ``storage`` and ``loss`` in Pa and ``temperature`` in degrees Celsius or
        None, (n,) each, in the order of the file; ``mode`` is "shear" where the headings say so,
        else "tension".  ``temperature`` is None where the file has no column of it, and of reduced
        frequencies at several temperatures, which belong to a reference that no column says;
        ``notes`` then quotes lines above the headings that state one.  ``strain``, dimensionless,
        is None where no column has it with its unit, without gaps.  ``print`` shows in three lines
        what was understood.  It unpacks into three arrays: ``omega, storage, loss =
        read_dma(path)``.

    Raises
    ------
    FileError
        A file that cannot be read, is no text or has no table; tables with different headings;
        columns that are missing, ambiguous or contradict each other, columns that seem to be
        temperatures, units that are missing, unknown or of another dimension, gaps and separators
        of thousands; a frequency or modulus that is not > 0 and finite, a phase angle of 90 degrees
        and more, a temperature at or below absolute zero; a modulus from a magnitude and storage or
        loss that the digits of the file leave uncertain by more than 5 %; all rows at one
        frequency; several moduli at one frequency, or several tables, without a column of
        temperatures.
    ParameterError
        Names or headings in ``columns``, units, a decimal mark or an encoding that are not allowed
        or not in the file, also the unit of a quantity of which the file has no column.

    Warns
    -----
    ModelWarning
        Where neither the file nor ``units`` says what a column is in; a tan delta above 3 without a
        unit, which no rubber has: it may be in per cent.

    Examples
    --------
    >>> import viscoroll as vr
    >>> omega, storage, loss = vr.read_dma(vr.datasets.path("dma.csv"))  # rad/s, Pa, Pa
    """
    table, found, others = source = understand(
        path, "dma", columns=columns, units=units, decimal=decimal, encoding=encoding
    )
    mode, pair, columns_of_quantity = _choose_columns(table, found, others)
    mode, assumed = source.mode(mode)
    notes = [f"{len(table.starts)} tables"] * (len(table.starts) > 1) + assumed
    # read at the end, since a strain that cannot be read is left out, while others are refused
    strains = columns_of_quantity.pop("strain", [])
    numbers = {
        quantity: agreeing_numbers(table, quantity, alike, others)
        for quantity, alike in columns_of_quantity.items()
    }
    temperature = numbers["temperature"].values if "temperature" in numbers else None
    reduced = "reduced frequency" in numbers
    if temperature is None and not reduced:
        refuse_unread_temperatures(table, others)
        temperature = temperatures_of_lines(table)
        notes += ["temperatures are those of lines above the rows"] * (temperature is not None)
    # those of the tests, not of the master curve, whose reference no column states
    elif temperature is not None and reduced and np.ptp(temperature) > SAME_TEMPERATURE:
        temperature = None
        others[columns_of_quantity.pop("temperature")[0].heading] = (
            "reduced frequencies belong to one reference temperature"
        )
    omega = numbers[next(name for name in numbers if name.endswith("frequency"))].values
    moduli = {name: numbers[name] for names in PAIRS for name in names if name in numbers}
    storage, loss = storage_and_loss(table, pair, moduli)
    taken = [alike[0] for alike in columns_of_quantity.values()]
    sources = [columns_of_quantity[name][0].name for name in pair]
    if any(UNITS[name] == "1/Pa" for name in sources):
        with np.errstate(all="ignore"):  # what is not finite is refused
            # compliance J' - i J'' and modulus E' + i E'' are inverse
            square = storage**2 + loss**2
            storage = storage / square
            loss = loss / square
    # the decades of a modulus are below 10, and those of a low frequency negative
    logs = omega.min() < 0.0 or storage.max() < SOFTEST
    advice = "write log before the heading of a logarithm" if logs else "correct or remove the row"
    for name, values in {
        "frequency": omega,
        "storage modulus": storage,
        "loss modulus": loss,
    }.items():
        table.require(
            (values > 0.0) & (values < np.inf), f"the {name} must be > 0 and finite: {advice}"
        )
    warn_of_assumed_units(table, taken, storage)
    if sources != ["storage", "loss"]:
        notes.append(f"moduli are from {' and '.join(sources)}")
    notes += [f"{name} agrees with {' and '.join(pair)}" for name in moduli if name not in pair]
    strain = _strain(table, strains, others)
    taken += strains[:1] if strain is not None else []
    notes += source.notes(taken)
    above = [
        text
        for n, text in table.titles.items()
        if n < table.starts[0] and _TEMPERATURE.search(text)
    ]
    if above and temperature is None:
        notes.append(
            f"no temperature is read from lines above the headings, {quoted(above)}: give "
            "temperature= to fit_prony (in a shell: --temperature)"
        )
    _warn_of_per_cent(table, taken)
    record = DynamicModuli(
        omega=omega,
        storage=storage,
        loss=loss,
        temperature=temperature,
        mode=mode,
        notes=tuple(notes),
        **_origin(path, taken),
        strain=strain,
    )
    _refuse_mixed_sweeps(table, record)
    return record


def _strain(table: Table, alike: list[Column], others: dict[str, str]) -> Floats | None:
    """Return the strain of each point, dimensionless, (n,); None where no column states it clearly.

    table : :class:`Table`, the table that has the columns.
    alike : list of :class:`Column`, the columns of strain, which may be none.
    others : heading -> why the column is left out.  It is changed: columns are added that have no
        unit or gaps, or that contradict each other.
    """
    try:
        return agreeing_numbers(table, "strain", alike, others).values if alike else None
    except FileError as error:
        why = str(error).removeprefix(f"{table.path}: ")
        others |= {column.heading: why if column is alike[0] else "" for column in alike}
        return None


def _warn_of_per_cent(table: Table, taken: list[Column]) -> None:
    """Warn, by one ModelWarning, of tan delta without a unit that is above 3, which no rubber has:
    it may be in per cent.

    table : :class:`Table`, the table of the file.
    taken : list of :class:`Column`, the columns that are read.
    """
    for column in taken:
        if column.name == "tan delta" and not column.stated and not column.log:
            most = numbers_of(table, column).values.max()
            if most > _MOST_DAMPED:
                warn_of_model(
                    f"{table.path}: tan delta is up to {most:g}, above that of any rubber: "
                    f"{unit_advice(column.name)}, or '1' in place of '%' if it is no per cent"
                )


def _choose_columns(
    table: Table, found: list[Column], others: dict[str, str]
) -> tuple[str, tuple[str, str], dict[str, list[Column]]]:
    """Choose the columns from which frequency and moduli are read: one mode, one pair of
    quantities, one kind of frequency.

    Tension comes before shear, moduli before compliances, and the pairs in the order of
    :data:`.table_reader.PAIRS`.

    table : the table of the file; it is used for the error message only.
    found : list of :class:`Column`, columns of known quantities, in the order of the file.
    others : heading -> why the column is left out, "" for an unknown quantity.  It is changed:
        columns of another mode or kind than the pair, and measured frequencies beside reduced ones,
        are added.
    Returns (mode: "tension", "shear", or "" where no heading says; pair: the two quantities that
    give the moduli, or compliances, a key of :data:`.table_reader.PAIRS`; columns: quantity
    (:attr:`.dma_columns.Column.quantity`) -> its columns, one or more, which must then agree: those
    of the mode or of no mode, all of moduli or all of compliances, with temperature, and quantities
    beside the pair, too).
    Raises FileError where no column is a frequency, or no two give the moduli; its message lists
    the headings.
    """
    modes = [mode for mode in ("tension", "shear") if any(column.mode == mode for column in found)]
    quantities = {column.quantity for column in found}
    swept = "temperature" in quantities
    problem = (
        "no column was found for frequency"
        + ", since this is a sweep of temperature: measure a sweep of frequency" * swept
    )
    if quantities & {"frequency", "reduced frequency"}:
        problem = (
            "fewer than two columns were found of storage, loss, tan delta and modulus (the "
            "magnitude), all in tension or all in shear"
        )
        # without compliances first, then without moduli
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
                    return mode, pair, columns
    raise missing(table, "dma", problem, others)


def _refuse_mixed_sweeps(table: Table, record: DynamicModuli) -> None:
    """Refuse what is not one frequency sweep at each temperature.

    These are: rows that are all of one frequency (to 0.1 %, at least two rows); several tables in
    the file without a column of temperatures; where all rows are of one temperature, within 1 K or
    because the file has none, two of one frequency whose storage moduli differ by more than a
    factor of 1.25.

    table : :class:`Table`, the table from which the record was read; its lines are named in the
        message.
    record : :class:`dynamic_moduli.DynamicModuli`, the moduli in the order of the rows.
    Raises FileError for each of the three; returns nothing.
    """
    omega = record.omega
    n = record.omega.size
    # a single row may be one of a sweep that the user cut
    if n > 1 and omega.max() < (1.0 + ONE_FREQUENCY) * omega.min():
        raise FileError(
            table.path,
            f"all {n} rows are of one frequency, {omega[0]:.4g} rad/s: this is not a "
            "frequency sweep; give a file with several frequencies",
        )
    if record.temperature is None and len(table.starts) > 1:
        raise FileError(
            table.path,
            f"has {len(table.starts)} tables, and no column states their temperature: keep one of "
            "them, or write 'Temperature 20 °C' above each",
        )
    if record.isothermal:
        refuse_repeats(table, "frequency", omega, record.storage)
