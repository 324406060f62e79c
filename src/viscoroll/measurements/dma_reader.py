"""Text files of tests of materials: storage and loss modulus over frequency (:func:`read_dma`), and
relaxation modulus over time (:func:`read_relaxation`).
"""

import dataclasses
import itertools
import pathlib
import re
from collections import defaultdict
from typing import Any, TypeAlias

import numpy as np

from ..core import FileError, FilePath, Floats
from .dma_columns import UNITS, ByQuantity, Column
from .dynamic_moduli import SAME_TEMPERATURE, DynamicModuli, ModuliRecord
from .table_reader import (
    ONE_FREQUENCY,
    PAIRS,
    SOFTEST,
    Understood,
    quoted,
    refuse_repeats,
    storage_and_loss,
    temperatures_of_lines,
    understand,
    warn_of_assumed_units,
)

#: units of frequency or time and of moduli, or quantity -> unit; None: those of the file
GivenUnits: TypeAlias = tuple[str, str] | ByQuantity | None

# --- Relaxation modulus over time from a text file ---


@dataclasses.dataclass(frozen=True, eq=False, repr=False)
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
    path: FilePath,
    *,
    columns: ByQuantity | None = None,
    units: GivenUnits = None,
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
    source = understand(path, "relaxation", columns, units, decimal, encoding)
    table, found, others = source
    alike = defaultdict(list)
    for column in found:
        alike[column.quantity].append(column)
    pair = ("relaxation modulus",) if "relaxation modulus" in alike else ("stress", "strain")
    if not {"time", *pair} <= alike.keys():
        raise source.missing(
            "relaxation",
            (
                "no column was found for the relaxation modulus, nor two for stress and strain"
                if "time" in alike
                else "no column was found for time"
            )
            + _understood(found),
        )
    table.refuse_several()
    used = [name for name in ("time", *pair, "temperature") if name in alike]
    others |= {column.heading: "not needed" for column in found if column.quantity not in used}
    numbers = {name: source.numbers(alike[name]).values for name in used}
    for name in ("time", *pair):
        table.require(
            (numbers[name] > 0.0) & (numbers[name] < np.inf),
            f"the {name} must be > 0 and finite: correct or remove this line",
        )
    # a strain is in use only beside a stress
    relaxation = numbers[pair[0]] / numbers.get("strain", 1.0)
    refuse_repeats(table, "time", numbers["time"], relaxation)
    temperature = numbers.get("temperature")
    if temperature is None:
        source.refuse_unread_temperatures()
    elif np.ptp(temperature) > SAME_TEMPERATURE:
        raise table.error(
            f"has lines at {temperature.min():g} to {temperature.max():g} °C: keep only those of "
            f"one temperature (within {SAME_TEMPERATURE:g} K)"
        )
    taken = [alike[name][0] for name in used]
    warn_of_assumed_units(table, taken, relaxation)
    mode, notes = source.mode(next((each.mode for each in alike[pair[0]] if each.mode), ""))
    notes += ["the modulus is stress over strain"] * (len(pair) > 1) + source.notes(taken)
    return RelaxationModulus(
        numbers["time"],
        relaxation,
        None if temperature is None else float(np.median(temperature)),
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
        "source": pathlib.Path(path).name.encode(errors="replace").decode(),
        "columns": {column.name: column.heading for column in taken},
        "units": {column.name: column.unit for column in taken},
    }


# --- Storage and loss modulus over frequency from a text file ---

#: a line with a number in degrees Celsius or kelvin, which is no rate, or with a word for
#: temperature before a number
_TEMPERATURE = re.compile(
    r"\d\s*(?:℃|(?:[°º]\s*|deg\s*)?[CK]\b)(?!\s*/)|(?i:temp(?:[eé]rat|\b).*\d)|温度.*\d"
)


def read_dma(
    path: FilePath,
    *,
    columns: ByQuantity | None = None,
    units: GivenUnits = None,
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
    source = understand(path, "dma", columns, units, decimal, encoding)
    table, _, others = source
    mode, pair, columns_of_quantity = _choose_columns(source)
    mode, assumed = source.mode(mode)
    notes = [f"{len(table.starts)} tables are joined"] * (len(table.starts) > 1) + assumed
    # read at the end, since a strain that cannot be read is left out, while others are refused
    strains = columns_of_quantity.pop("strain", [])
    numbers = {quantity: source.numbers(alike) for quantity, alike in columns_of_quantity.items()}
    temperature: Floats | None = None
    reduced = "reduced frequency" in numbers
    if "temperature" in numbers:
        temperature = numbers["temperature"].values
        # those of the tests, not of the master curve, whose reference no column states
        if reduced and np.ptp(temperature) > SAME_TEMPERATURE:
            temperature = None
            others[columns_of_quantity.pop("temperature")[0].heading] = (
                "temperatures of the tests, while reduced frequencies are of one reference"
            )
    elif not reduced:
        source.refuse_unread_temperatures()
        temperature = temperatures_of_lines(table)
        notes += ["temperatures are read from lines above the numbers"] * (temperature is not None)
    omega = numbers["reduced frequency" if reduced else "frequency"].values
    moduli = {name: numbers[name] for names in PAIRS for name in names if name in numbers}
    storage, loss = storage_and_loss(table, pair, moduli)
    taken = [alike[0] for alike in columns_of_quantity.values()]
    sources = [columns_of_quantity[name][0].name for name in pair]
    made = f" from {' and '.join(sources)}" * (sources != ["storage", "loss"])
    if UNITS[sources[0]] == "1/Pa":  # the second may be a tan delta
        with np.errstate(all="ignore"):  # what is not finite is refused
            # compliance J' - i J'' and modulus E' + i E'' are inverse
            square = storage**2 + loss**2
            storage = storage / square
            loss = loss / square
    # the decades of a modulus are below 10, and those of a low frequency negative
    advice = "correct or remove this line"
    if omega.min() < 0.0 or storage.max() < SOFTEST:
        advice += ", or, if the column has logarithms, write log before its heading"
    for name, values in {
        "frequency": omega,
        "storage modulus": storage,
        "loss modulus": loss,
    }.items():
        table.require(
            (values > 0.0) & (values < np.inf),
            f"the {name}{made * ('modulus' in name)} must be > 0 and finite: {advice}",
        )
    warn_of_assumed_units(table, taken, storage)
    notes += [f"moduli are{made}"] * bool(made)
    notes += [f"{name} agrees with {' and '.join(pair)}" for name in moduli if name not in pair]
    strain = None
    if strains:
        try:
            strain = source.numbers(strains).values
            taken.append(strains[0])
        except FileError as error:
            others |= {each.heading: error.problem * (each is strains[0]) for each in strains}
    notes += source.notes(taken)
    above = [
        text
        for n, text in table.titles.items()
        if n < table.starts[0] and _TEMPERATURE.search(text)
    ]
    if above and temperature is None:
        notes.append(
            f"the temperature above the headings ({quoted(above)}) is not used: give it as "
            "temperature= to fit_prony (in a shell: --temperature)"
        )
    # a single row may be one of a sweep that the user cut
    if omega.size > 1 and omega.max() < (1.0 + ONE_FREQUENCY) * omega.min():
        raise table.error(
            f"all {omega.size} lines have the same frequency, {omega[0]:.4g} rad/s "
            f"({omega[0] / (2.0 * np.pi):.4g} Hz): give a file with several frequencies (a "
            "frequency sweep)"
        )
    if temperature is None and len(table.starts) > 1:
        raise table.error(
            f"has {len(table.starts)} tables "
            + (
                "of reduced frequencies: keep one of them"
                if reduced
                else "without a column of temperature: keep one of them, or write a line with its "
                "temperature above each, as 'Temperature 20 °C'"
            )
        )
    record = DynamicModuli(
        omega=omega,
        storage=storage,
        loss=loss,
        temperature=temperature,
        strain=strain,
        mode=mode,
        notes=tuple(notes),
        **_origin(path, taken),
    )
    if record.isothermal:
        refuse_repeats(table, "frequency", omega, storage)
    return record


def _choose_columns(source: Understood) -> tuple[str, tuple[str, str], dict[str, list[Column]]]:
    """Choose the columns from which frequency and moduli are read: one mode, one pair of
    quantities, one kind of frequency.

    Tension comes before shear, moduli before compliances, and the pairs in the order of
    :data:`.table_reader.PAIRS`.

    source : the table with its columns of known quantities.  Its ``others`` is changed: columns of
        another mode or kind than the pair, and measured frequencies beside reduced ones, are added.
    Returns (mode: "tension", "shear", or "" where no heading says; pair: the two quantities that
    give the moduli, or compliances, a key of :data:`.table_reader.PAIRS`; columns: quantity
    (:attr:`.dma_columns.Column.quantity`) -> its columns, one or more, which must then agree: those
    of the mode or of no mode, all of moduli or all of compliances, with temperature, and quantities
    beside the pair, too).
    Raises FileError where no column is a frequency, or no two give the moduli; its message lists
    the headings.
    """
    _, found, others = source
    # tension before shear
    modes = sorted({column.mode for column in found} - {""}, reverse=True)
    quantities = {column.quantity for column in found}
    problem = (
        "no column was found for frequency"
        + " (if this is a temperature sweep, it cannot be used: measure a frequency sweep)"
        * ("temperature" in quantities)
    )
    if quantities & {"frequency", "reduced frequency"}:
        problem = (
            "two columns of storage, loss, tan delta and modulus (the magnitude) are needed, both "
            "of tension or both of shear, both moduli or both compliances"
        )
        # without compliances first, then without moduli
        for mode, excluded in itertools.product(modes or [""], ("1/Pa", "Pa")):
            columns = defaultdict(list)
            unused = {}
            for column in found:
                if column.mode not in ("", mode) or UNITS[column.name] == excluded:
                    unused[column.heading] = "not needed"
                elif column.quantity == "frequency" and "reduced frequency" in quantities:
                    unused[column.heading] = "the reduced frequency is taken"
                else:
                    columns[column.quantity].append(column)
            for pair in PAIRS:
                if columns.keys() >= {*pair}:
                    others |= unused
                    return mode, pair, columns
    raise source.missing("dma", problem + _understood(found))


def _understood(found: list[Column]) -> str:
    """Return the columns of known quantities in words that follow a message; "" where there are
    none.
    """
    known = (
        f"{each.heading!r} as {each.name}{f' in {each.mode}' * bool(each.mode)}" for each in found
    )
    return f"; understood were {', '.join(known)}" * bool(found)
