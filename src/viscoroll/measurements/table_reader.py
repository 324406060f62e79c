"""What the readers of tests of materials share: a table whose columns are understood
(:class:`Understood`), the numbers of these columns, and storage and loss modulus from any two of
storage, loss, tan delta and magnitude, with which a third is compared.
"""

import bisect
import collections
import math
import re
from collections.abc import Mapping
from contextlib import suppress
from typing import Any, NamedTuple

import numpy as np

from ..core import (
    FileError,
    FilePath,
    Floats,
    ParameterError,
    check_names,
    describe_value,
    described_error,
    warn_of_model,
)
from .dma_columns import (
    BARE,
    KELVIN,
    OF_SHEAR,
    QUANTITIES,
    UNITS,
    ByQuantity,
    Column,
    columns_of,
    meanings,
    numbers_of,
    unit_advice,
)
from .dynamic_moduli import SAME_TEMPERATURE
from .text_cells import NO_UNIT, Numbers, conversion, readings
from .text_table import Table, read_table

# --- Storage and loss modulus from any two of storage, loss, tan delta and magnitude ---

#: pair of quantities -> function of both that returns storage and loss, the pairs that lose the
#: fewest digits first
PAIRS: dict[Any, Any] = {
    ("storage", "loss"): lambda storage, loss: (storage, loss),
    ("storage", "tan delta"): lambda storage, tan: (storage, storage * tan),
    ("loss", "tan delta"): lambda loss, tan: (loss / tan, loss),
    ("modulus", "tan delta"): lambda whole, tan: (
        storage := whole / np.hypot(1.0, tan),
        storage * tan,
    ),
    ("loss", "modulus"): lambda loss, whole: (np.sqrt(whole**2 - loss**2), loss),
    ("storage", "modulus"): lambda storage, whole: (storage, np.sqrt(whole**2 - storage**2)),
}
#: relative difference of quantities that agree, beside rounding: instruments average each quantity
#: over cycles, and a mean of ratios is off the ratio of means by parts of a per cent
AVERAGED = 0.01
#: largest relative error of storage and loss that the rounding of the digits may cause
_ROUNDED = 0.05


@np.errstate(
    all="ignore"
)  # where a pair has no solution there is NaN or infinity, which is refused
def storage_and_loss(
    table: Table, pair: tuple[str, str], columns: dict[str, Numbers]
) -> tuple[Floats, Floats]:
    """Return storage and loss from two measured quantities, after a check that all others agree
    with them.

    table : :class:`Table`, the table that has the columns; its lines are named in the error
    message.
    pair : the two quantities, a key of :data:`PAIRS`; both are in ``columns``.
    columns : quantity ("storage", "loss", "tan delta", "modulus") -> :class:`Numbers`, values and
        half a unit of their last digits, (n,) each, of those that the file has; all in Pa or all in
        1/Pa, tan delta dimensionless.
    Returns (storage, loss), (n,) each, in the unit of the columns: compliances of compliances.
    Signs are not checked
    here: a negative or infinite value stays.
    Raises FileError, with the line, where a further column differs by more than 1 % beside the
    rounding of all three; of a pair of a magnitude and storage or loss also where the magnitude is
    not above the other, or where the digits of the file leave the modulus that is computed
    uncertain by more than 5 %.
    """
    storage, loss = PAIRS[pair](*(columns[name].values for name in pair))
    exact = {
        "storage": storage,
        "loss": loss,
        "tan delta": loss / storage,
        "modulus": np.hypot(storage, loss),
    }
    rounding = sum(columns[name].half / np.abs(columns[name].values) for name in pair)
    both = " and ".join(pair)
    if pair[1] == "modulus":  # a difference of squares
        table.require(
            ~np.isnan(storage + loss),
            f"{pair[0]} is above the magnitude of the complex modulus or compliance: correct the "
            "line, or the unit of one of the two columns",
        )
        wanted = "loss" if pair[0] == "storage" else "storage"
        other = exact[wanted]
        # of other^2 = modulus^2 - given^2 the relative error is at most modulus^2/other^2 times the
        # sum of those of both
        rounding *= (exact["modulus"] / other) ** 2
        table.require(
            rounding <= _ROUNDED,
            f"{pair[0]} and the magnitude of the complex modulus or compliance differ too little, "
            f"for their number of digits, to give {wanted}: add a column of tan delta",
        )
    for name in columns.keys() - set(pair):
        values, half = columns[name]
        table.require(
            np.abs(values - exact[name]) <= (AVERAGED + rounding) * np.abs(exact[name]) + half,
            f"{name} differs by more than {AVERAGED:.0%} from that of {both}: remove one of these "
            "columns, or, if one has another unit, give it, as units={'tan delta': '%'} (in a "
            "shell: --units 'tan delta=%')",
        )
    return storage, loss


# --- What the readers of tests of materials share ---

#: relative difference of frequencies in Hz and in rad/s that agree: 6.28 in place of 2 pi is off by
#: 5e-4
_ROUND_PI = 1e-3
#: Pa; moduli that are all below it are not of a rubber in Pa
SOFTEST = 1e3
#: relative difference of frequencies that are one: instruments keep theirs to this
ONE_FREQUENCY = 1e-3
#: ratio of moduli at one frequency and one temperature above which something else was varied
_REPEATED = 1.25
#: test -> advice where columns are not understood; the program reads no relaxation tests
_NAME_THEM = {
    "relaxation": "name the columns by columns={'time': HEADING, 'relaxation modulus': HEADING}",
    "dma": "name the columns by columns={'frequency': HEADING, 'storage': HEADING, 'loss': HEADING}"
    " ('angular frequency' for one in rad/s; in a shell: --column storage=HEADING for each)",
}
#: a number in degrees Celsius, or of three digits in kelvin, which is no rate, and none that a
#: comma in a row of cells may have cut; before it what makes it the end of a range, as "20 to "
_IN_DEGREES = re.compile(
    r"(\d\s*(?:[-–~]|to|bis|à)\s*)?(?<!\d[.,])(?<![\d.])"
    r"(\d{3}(?:[.,]\d+)?(?=[\s;,|\"]*K\b)|[+-]?\d+(?:[.,]\d+)?(?![\s;,|\"]*K\b))"
    r"[\s;,|\"]*(℃|(?:[°º]\s*|deg\s*)?[CKF]\b)(?!\s*[/·*])"
)
#: a temperature without a unit behind it, at the end of a line
_NAMED = re.compile(
    r"(?:(?i:temp[^\W\d_]*\.?)|温度|\bT(?=\s*[:=;,\t]))\s*(?:[\[(]\s*(?:[°º]|deg)?\s*C\s*[\])])?[\s:：=;,|\"]*"
    r"()([+-]?\d+(?:[.,]\d+)?)()[\s;,|\"]*$"
)
#: a heading of a temperature that is not understood, as "Ts", "theta_C" or "Chamber temp."
_LIKE_TEMPERATURE = re.compile(
    r".*(?i:temp(?!o\b|s\b|l)|theta|celsius|kelvin|grad\b)|.*温度|[Tϑθ][^\W_]{0,2}(?![^\W_])"
)
#: change of ln(modulus) of rows of one frequency that is more than that of repeated tests
_SCATTER = 0.1
#: tan delta that no rubber has at any frequency: that of damping rubbers in their glass transition
#: is below
_MOST_DAMPED = 3.0


class Understood(NamedTuple):
    """A table whose columns are understood.

    table : the :class:`Table`.
    columns : list of :class:`Column`, columns of known quantities, in the order of the file.
    others : heading -> why the column is left out, "" for an unknown quantity.
    """

    table: Table
    columns: list[Column]
    others: dict[str, str]

    def mode(self, said: str) -> tuple[str, list[str]]:
        """Return the mode of the moduli, and a note in a list if it is assumed.

        said : "tension", "shear", or "" where the headings of the moduli do not say it: then it is
            "shear" if another heading is one of a test in shear, as "Torque" of rheometers, else
            "tension".
        """
        if said:
            return said, []
        for heading in self.table.headings:
            if OF_SHEAR.search(heading):
                return "shear", [f"shear is assumed, since the file has the heading {heading!r}"]
        return "tension", ["tension is assumed, since no heading says E or G"]

    def notes(self, taken: list[Column]) -> list[str]:
        """Return the notes on columns of logarithms, columns that are left out, and lines below the
        rows.

        taken : the columns that are read.
        """
        notes = [
            f"{each.heading!r} is read as {'ln' if each.log == math.e else f'log{each.log:g}'}"
            for each in taken
            if each.log
        ]
        listed = ", ".join(
            f"{heading!r}{f' ({why})' * bool(why)}" for heading, why in self.others.items()
        )
        notes += [f"unused columns: {listed}"] * bool(listed)
        below = [text for n, text in self.table.titles.items() if n > self.table.rows[-1].number]
        return notes + [f"lines below the numbers are unused: {quoted(below[:1])}"] * bool(below)

    def numbers(self, alike: list[Column]) -> Numbers:
        """Return the numbers of the first of several columns of one quantity, after a check that
        the others agree with it.

        Frequencies agree to 0.1 %, moduli and tan delta to 1 %, temperatures to 1 K, each beside
        the rounding of the digits.

        alike : list of :class:`Column`, the columns of one quantity
            (:attr:`.dma_columns.Column.quantity`), as "frequency" or "storage", at least one.  All
            but the first are added to ``others``.
        Returns :class:`Numbers` of the first column: values, and half a unit of their last digits,
        (n,) each, in rad/s, Pa, 1/Pa, degrees Celsius or, of tan delta, dimensionless.
        Raises FileError with the line where two columns contradict each other, or where a cell is
        no number, and for a unit that is missing and cannot be assumed.
        """
        best, *further = alike
        first = numbers_of(self.table, best)
        for column in further:
            second = numbers_of(self.table, column)
            # of temperatures an absolute difference: the zero of degrees Celsius has no meaning
            allowed = (
                SAME_TEMPERATURE
                if best.name == "temperature"
                else (_ROUND_PI if best.quantity.endswith("frequency") else AVERAGED)
                * np.abs(first.values)
            )
            advice = "rename or remove one of these columns"
            if column.heading != best.heading:
                advice = (
                    f"choose one by columns={{{best.name!r}: {best.heading!r}}} or "
                    f"columns={{{column.name!r}: {column.heading!r}}}"
                )
            self.table.require(
                np.abs(first.values - second.values) <= first.half + second.half + allowed,
                f"columns {best.heading!r} and {column.heading!r} contradict each other: {advice}",
            )
            self.others[column.heading] = f"agrees with {best.heading!r}"
        return first

    def missing(self, test: str, problem: str) -> FileError:
        """Return the error, not raised, of columns that are missing: the problem, headings, and
        advice.

        test : "dma" or "relaxation".
        problem : words on what is missing.
        """
        reasons = "".join(
            f"; {heading!r} is unused, since {why}" for heading, why in self.others.items() if why
        )
        headings = ", ".join(
            repr(heading or f"column {n}") for n, heading in enumerate(self.table.headings)
        )
        advice = f"; {_NAME_THEM[test]}" * ("" in self.others.values() or not self.others)
        return self.table.error(f"{problem}; the headings are {headings}{reasons}{advice}")

    def refuse_unread_temperatures(self) -> None:
        """Refuse a column that is left out and seems to be of several temperatures, of which a
        sweep would be made one.

        It is such a column if its unit is one of temperature, or its heading is like one, and its
        values span more than 1 K.

        Raises FileError with advice.
        """
        table = self.table
        for index, heading in enumerate(table.headings):
            if heading in self.others and table.has_numbers(index):
                # kelvins of one unit of the column; without a unit those of degrees Celsius
                factor = max(
                    (
                        _kelvins(each.unit)
                        for each in readings(heading, table.units[index])
                        if each.unit not in NO_UNIT and (each.sure or "°" in each.unit)
                    ),
                    default=bool(_LIKE_TEMPERATURE.match(heading)),
                )
                spread = np.inf
                with suppress(FileError):
                    spread = factor * np.ptp(table.numbers(index).values)
                if factor and spread > SAME_TEMPERATURE:
                    raise table.error(
                        f"column {heading!r} looks like temperatures, but is not read: name it by "
                        f"columns={{'temperature': {heading!r}}}, or remove it if it is not the "
                        "temperature of the sample"
                    )


def quoted(lines: list[str]) -> str:
    """Return lines for a message, at most 60 characters of each, in quotes, separated by commas."""
    return ", ".join(f"{' '.join(line.split())!r:.60}" for line in lines)


def understand(
    path: FilePath, test: str, columns: Any, units: Any, decimal: str | None, encoding: str | None
) -> Understood:
    """Read the table of a file, and find the quantities of its columns.

    path, columns, units, decimal, encoding : as in :func:`.dma_reader.read_dma`.
    test : kind of test, which determines the quantities that are looked for: "dma" or "relaxation".
    Returns the table with its columns, as :class:`Understood`.
    Raises ParameterError and FileError as :func:`.dma_reader.read_dma` does for these arguments and
    for what is no table.
    """
    if not isinstance(columns, Mapping | None):
        raise ParameterError(
            "columns",
            describe_value(columns),
            f"a dict of headings of the file, as {{{BARE[test][0]!r}: HEADING}}",
        )
    named = dict(columns or {})
    known = QUANTITIES[test]
    bare = BARE[test]
    check_names("columns", named, known, "a quantity")
    overruling, defaults = _units(units, test)

    def is_heading_line(cells: list[str]) -> bool:
        """Return whether the texts of the ``cells`` of a line, with units or without, name at least
        two different known quantities, or one of them is a heading that the user gave.
        """
        quantities = {found[0].name for cell in cells if (found := meanings(cell))}
        return len(quantities.intersection(known)) > 1 or any(
            cell in named.values() for cell in cells if cell
        )

    table = read_table(
        path,
        is_heading_line,
        decimal,
        encoding,
        is_title=lambda text: _IN_DEGREES.search(text) or _NAMED.search(text),
    )
    if table.without_headings and not named:
        if len(table.headings) != len(bare):
            raise FileError(
                path,
                f"has no headings, so that it must have {len(bare)} columns ({', '.join(bare)}), "
                f"but it has {len(table.headings)}: write headings and missing columns into the "
                "file; or, with "
                f"{', '.join(map(repr, table.headings))} as HEADING, {_NAME_THEM[test]}",
            )
        named = dict(zip(bare, table.headings))
    found, others = columns_of(table, test, named, overruling, defaults)
    check_names("units", overruling, [column.name for column in found], "a quantity of the file")
    return Understood(table, found, others)


def _units(units: Any, test: str) -> tuple[ByQuantity, ByQuantity]:
    """Split the argument ``units`` into units that replace those of the file and units for columns
    that have none.

    units : argument ``units`` of :func:`.dma_reader.read_dma`: None; (unit of frequencies or times,
        unit of moduli), as ("Hz", "MPa"); or quantity -> unit, with the keys of
        :data:`.dma_columns.UNITS`.
    test : "dma" or "relaxation".
    Returns two dicts quantity -> unit: the first replaces what the file says, the second holds
    where the file gives none. One of them is empty: the first for a pair, the second for
    quantity -> unit, and both for None.
    Raises ParameterError for another form, an unknown quantity, a unit that is unknown or of
    another dimension.
    """
    by_name = isinstance(units, Mapping)
    known = QUANTITIES[test]
    first = BARE[test][0]
    if not (units is None or by_name or (isinstance(units, (tuple, list)) and len(units) == 2)):
        raise ParameterError(
            "units",
            describe_value(units),
            f"(unit of {first.split()[-1]}, of moduli), as ({UNITS[first]!r}, 'MPa'), or a dict, "
            f"as {{{first!r}: {UNITS[first]!r}}}",
        )
    # each of the two is for all quantities that are converted to the same unit
    of_two = zip((UNITS[first], "Pa"), units or ())
    pairs = (
        dict(units)
        if by_name
        else {name: unit for kind, unit in of_two for name in known if UNITS[name] == kind}
    )
    check_names("units", pairs, known, "a quantity")
    for name, unit in pairs.items():
        try:
            conversion(str(unit), UNITS[name])
        except ParameterError as error:
            raise described_error(
                "units",
                f"has {unit!r} for {name}",
                f"a unit of the dimension of {UNITS[name]}{', as %' * (UNITS[name] == '1')}",
            ) from error
    return (pairs, {}) if by_name else ({}, pairs)


def warn_of_assumed_units(table: Table, taken: list[Column], moduli: Floats) -> None:
    """Warn of units that neither the file nor the user gives: by one ModelWarning of frequencies
    and moduli, by another of a tan delta above 3, which no rubber has: it may be in per cent.

    Temperatures, phase angles and compliances are not examined here.  There is no warning where all
    units are given.

    table : :class:`Table`, the table of the file, for the messages.
    taken : list of :class:`Column`, the columns that are read.
    moduli : storage or relaxation modulus, Pa, (n,).
    Raises FileError for a modulus without a unit beside one that has it, and for a frequency
    likewise.
    """
    assumed = [
        column
        for unit in ("rad/s", "s", "Pa")
        for column in taken
        if UNITS[column.name] == unit and not column.stated
    ]
    for column in assumed:
        if alike := [
            each.heading for each in taken if each.stated and UNITS[each.name] == UNITS[column.name]
        ]:
            raise table.error(
                f"column {column.heading!r} has no unit, but column {alike[0]!r} has one: "
                f"{unit_advice(column.name)}"
            )
    if assumed:
        units = {column.name: column.unit for column in assumed}
        doubt = (
            f"; moduli up to {moduli.max():g} Pa are too low for rubber: are they in MPa, or "
            "logarithms?"
        )
        warn_of_model(
            f"{table.path}: columns lack a unit, and units={units} are assumed: write the "
            "units into the file, or give yours by units= (in a shell: --units)"
            f"{doubt * bool(moduli.max() < SOFTEST)}"
        )
    for column in taken:
        if column.name == "tan delta" and not (column.stated or column.log):
            most = numbers_of(table, column).values.max()
            if most > _MOST_DAMPED:
                warn_of_model(
                    f"{table.path}: tan delta is up to {most:g}, above that of any rubber: "
                    f"{unit_advice(column.name)}, or '1' in place of '%' if it is not in per cent"
                )


def refuse_repeats(table: Table, name: str, at: Floats, modulus: Floats) -> None:
    """Refuse two rows of one frequency or time, to 0.1 %, whose moduli differ by more than a factor
    of 1.25.

    table : :class:`Table`, whose lines are named in the message.
    name : "frequency" or "time".
    at, modulus : frequency or time, and modulus of each row, > 0, (n,).
    """
    order = np.argsort(at, kind="stable")
    same = np.diff(at[order]) <= ONE_FREQUENCY * at[order][1:]
    change = np.where(same, np.abs(np.diff(np.log(modulus[order]))), 0.0)
    holds = np.ones(at.size, bool)
    # back to the order of the file: of two rows the one that is later there, by the stable sort
    holds[order[1:]] = change <= np.log(_REPEATED)
    advice = "if strain or temperature differs, make a file for each (DMA: or a temperature column)"
    problem = f"an earlier line has the same {name}, but another modulus (ratio above {_REPEATED})"
    table.require(holds, f"{problem}: {advice}; else remove one of the two lines")
    if change.max(initial=0.0) > _SCATTER:
        warn_of_model(
            f"{table.path}: lines with the same {name} have moduli that differ by up to "
            f"{np.expm1(change.max()):.0%}, and are taken as repetitions of a test: {advice}"
        )


def temperatures_of_lines(table: Table) -> Floats | None:
    """Return the temperatures that lines state above the rows of each table or block, as
    "Temperatur 20 °C".

    A line between rows belongs to those below it.  Above the first block the last line counts that
    differs from that of the second in its numbers alone.

    table : :class:`Table`.
    Returns degrees Celsius, (rows,); None where there is a single block, or no line between rows
    states a temperature.
    Raises FileError for a block above which not exactly one temperature is stated, as also in "20
    to 60 °C".
    """
    numbers = [row.number for row in table.rows]
    commas = table.decimal != "," and "," in table.rows[0].text
    lines: dict[int, dict[str, float | None]] = collections.defaultdict(dict)
    for n, text in table.titles.items():
        found = _IN_DEGREES.findall(text) or _NAMED.findall(text)
        if found and n < numbers[-1]:
            values = {_celsius(commas, *each) for each in found}
            # the line without its numbers, by which a line of the preamble is known as one of them
            wording = re.sub(r"[\d.,+-]", "", text)
            # by the index of the first row below the line
            lines[bisect.bisect(numbers, n)][wording] = values.pop() if len(values) == 1 else None
    if not lines.keys() - {0}:
        return None
    starts = sorted({*lines, *map(numbers.index, table.starts)})
    # starts[0] is 0, the block below the preamble
    for wording in lines[0].keys() - lines[starts[1]]:
        del lines[0][wording]
    temperature = np.empty(len(numbers))
    for start in starts:
        values = {*lines[start].values()}
        if len(values) != 1 or None in values:
            raise table.error(
                f"the numbers from line {numbers[start]} on have "
                f"{'several temperatures, or one in doubt,' if values else 'no temperature'} in "
                "the lines above them that are worded alike: write one such line above each "
                "block of numbers, as 'Temperature 20 °C'"
            )
        temperature[start:] = values.pop()  # blocks below overwrite theirs
    return temperature


def _celsius(commas: bool, low: str, number: str, unit: str) -> float | None:
    """Return a temperature in a line in degrees Celsius, None where it is in doubt.

    commas : whether commas separate cells, so that one in the number makes it doubtful.
    low : text before it that makes it the end of a range, as "20 to "; "" without.
    number : digits, with a decimal point or comma.
    unit : its unit as the file spells it, "" without, which is degrees Celsius unless the number is
    above 200.
    """
    value = float(number.replace(",", "."))
    if low or (commas and "," in number) or (not unit and value > KELVIN):
        return None
    factor, offset = conversion(unit or "degC", "degC")
    return factor * value + offset


def _kelvins(unit: str) -> float:
    """Return how many kelvins a unit of temperature is, 0 of another unit."""
    with suppress(ParameterError):
        return conversion(unit, "degC")[0]
    return 0.0
