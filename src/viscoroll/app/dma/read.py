"""Storage and loss modulus over frequency from a text file: :func:`read_dma`."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from ...core.errors import FileError, ModelWarning, ParameterError, caller_level, check_names
from ...io.measurements import Numbers, Table, conversion, read_table
from .columns import Column, columns_of, numbers_of
from .names import OF_SHEAR, UNITS, meanings
from .record import SAME_TEMPERATURE, DynamicModuli
from .solve import AVERAGED, PAIRS, refuse, storage_and_loss

#: 2 pi as people write it, 6.28, is off by 5e-4
_ROUND_PI = 1e-3
#: frequencies that differ by less are one: instruments keep theirs to this
_ONE_FREQUENCY = 1e-3
#: moduli at one frequency and one temperature repeat within this factor; beyond, something else was varied
_REPEATED = 1.25


def read_dma(
    path: str | PathLike[str], *, columns: Mapping[str, str] | None = None,
    units: tuple[str, str] | Mapping[str, str] | None = None, decimal: str | None = None, encoding: str | None = None,
) -> DynamicModuli:  # fmt: skip
    """Read storage and loss modulus over frequency, as instruments and spreadsheets write them.

    The headings say which column is which, in any order: frequency or angular frequency (reduced ones first), and two
    of storage, loss, tan delta or phase angle, and magnitude of the complex modulus, or the same of compliances.  A
    third is compared with what the two give.  Units are behind the names or in a row of their own.  Other columns are
    left aside and told in ``notes``.  Columns are parted by tabs, semicolons, commas or blanks; there may be lines
    before the headings, and comments that begin with ``#``.

    Parameters
    ----------
    path : a text file in UTF-8, UTF-16 or Latin-1.
    columns : meaning -> heading, as ``{"storage": "Module 1"}``, of columns whose names are not understood; meanings
        are frequency, angular frequency, storage, loss, tan delta, phase angle, modulus (the magnitude), storage
        compliance, loss compliance, modulus compliance, temperature, and reduced (angular) frequency.  The columns of a
        file without headings are called "column 0", "column 1" ...; three of them are frequency, storage and loss.
    units : of frequency and of moduli, as ("Hz", "MPa"), of columns that the file gives none for; or meaning -> unit,
        in place of what the file says.  Without, frequencies are in Hz, angular ones in rad/s, moduli in Pa, with a
        warning.
    decimal : "." or ","; default: the one that the numbers have.
    encoding : of the file; default: by its first bytes.

    Returns
    -------
    DynamicModuli
        In the order of the file; ``print`` shows in three lines what was understood.  It unpacks as before:
        ``omega, storage, loss = read_dma(path)``.

    Raises
    ------
    FileError
        A file that cannot be read, columns that are missing, ambiguous or contradict each other, units that are
        unknown or of another dimension, gaps and separators of thousands; rows of several temperatures without them.
    ParameterError
        ``columns``, ``units``, ``decimal`` or ``encoding`` that are none.

    Warns
    -----
    ModelWarning
        Where neither the file nor ``units`` says what a column is in.

    Examples
    --------
    >>> import viscoroll as vr
    >>> omega, storage, loss = vr.read_dma(vr.datasets.path("dma.csv"))  # rad/s, Pa, Pa
    """
    named = dict(columns or {})
    check_names("columns", named, UNITS, "a meaning")
    given, fills = _units_given(units)
    table = read_table(path, lambda cells: _known(cells, named), decimal=decimal, encoding=encoding)
    if table.bare and not named:
        if len(table.headings) != 3:
            problem = (
                f"has {len(table.headings)} columns, and no heading that names frequency, storage and loss modulus"
            )
            raise FileError(path, f"{problem}: give columns=")
        named = dict(zip(("angular frequency", "storage", "loss"), table.headings, strict=True))
    found, aside = columns_of(table, named, given, fills)
    mode, pair, kind = _pair(table, found, aside)
    notes = [f"{table.parts} tables"] * (table.parts > 1)
    if not mode:
        mode = _assumed_mode(aside, notes)
    kept = _kept(found, aside, mode, kind)
    numbers = {name: _agreeing(table, name, alike, aside) for name, alike in kept.items()}
    warm = numbers.get("temperature")
    if warm and "reduced frequency" in kept and np.ptp(warm.values) > SAME_TEMPERATURE:
        warm = None
        aside[kept.pop("temperature")[0].heading] = "reduced frequencies are of one temperature"
    omega = numbers[next(name for name in numbers if name.endswith("frequency"))].values
    refuse(table, omega > 0.0, "the frequency is not > 0")
    of_moduli = {
        name.removesuffix(kind): each for name, each in numbers.items() if name.removesuffix(kind) in _OF_PAIRS
    }
    storage, loss = storage_and_loss(table, pair, of_moduli)
    if kind:
        square = storage**2 + loss**2
        storage, loss = storage / square, loss / square
    if kind or pair != ("storage", "loss"):
        notes.append(f"moduli are from {' and '.join(kept[_full(name, kind)][0].meaning.name for name in pair)}")
    notes += [f"{name} agrees with them" for name in of_moduli.keys() - set(pair)]
    taken = [alike[0] for alike in kept.values()]
    notes += [f"{column.heading!r} is log10" for column in taken if column.meaning.log]
    notes += ["left aside: " + ", ".join(f"{of!r}" + f" ({why})" * bool(why) for of, why in aside.items())] * bool(
        aside
    )
    _warn_assumed(table, taken, fills)
    record = DynamicModuli(
        omega, storage, loss, warm and warm.values, mode, Path(path).name, {c.meaning.name: c.heading for c in taken},
        {c.meaning.name: c.unit for c in taken}, tuple(notes),
    )  # fmt: skip
    _refuse_mixed(table, record)
    return record


#: what pairs are of
_OF_PAIRS = {name for pair in PAIRS for name in pair}


def _units_given(units: Any) -> tuple[dict[str, str], dict[str, str]]:
    """Units by meaning that overrule the file, and those of columns that have none, by that of :data:`UNITS`."""
    by_name = isinstance(units, Mapping)
    allowed = "(frequency, moduli), as ('Hz', 'MPa'), or meaning -> unit"
    if units is not None and not by_name and not (isinstance(units, (tuple, list)) and len(units) == 2):
        raise ParameterError("units", f"{units!r:.60}", allowed)
    pairs = dict(units or {}) if by_name or not units else dict(zip(("frequency", "storage"), units, strict=True))
    check_names("units", pairs, UNITS, "a meaning")
    for name, unit in pairs.items():
        try:
            conversion(str(unit), UNITS[name])
        except ParameterError as error:
            raise ParameterError("units", f"{units!r:.60}", f"{allowed}; {unit!r} is none of {name}") from error
    return (pairs, {}) if by_name else ({}, {UNITS[name]: unit for name, unit in pairs.items()})


def _known(cells: list[str], named: Mapping[str, str]) -> bool:
    """Whether a line of texts is one of headings: two of its cells have a meaning, or one was named by the user."""
    found = {said[0].name for cell in cells if cell and (said := meanings(cell))}
    return len(found) > 1 or any(cell in named.values() for cell in cells if cell)


def _full(name: str, kind: str) -> str:
    """The quantity of a member of a pair, of moduli or compliances."""
    return name if name == "tan delta" else name + kind


def _pair(table: Table, found: list[Column], aside: dict[str, str]) -> tuple[str, tuple[str, str], str]:
    """Mode ("": no heading says), the pair that gives the moduli, and its kind: "" of moduli, or " compliance".

    Raises
    ------
    FileError
        There is none; its message lists the headings.
    """
    modes = [mode for mode in ("tension", "shear") if any(column.meaning.mode == mode for column in found)]
    everything = {column.quantity for column in found}
    missing = "two of storage, loss, tan delta and modulus"
    if not everything & {"frequency", "reduced frequency"}:
        missing = "frequency" + ": a sweep of temperature is none of frequency" * ("temperature" in everything)
    else:
        for mode in modes or [""]:
            names = {column.quantity for column in found if column.meaning.mode in ("", mode)}
            for kind in ("", " compliance"):
                pair = next((pair for pair in PAIRS if names.issuperset(_full(name, kind) for name in pair)), None)
                if pair:
                    return mode, pair, kind
    problems = "".join(f"; {heading!r}: {why}" for heading, why in aside.items() if why)
    headings = ", ".join(map(repr, filter(None, table.headings)))
    raise FileError(table.path, f"no column is named {missing}{problems}; headings: {headings}; give columns=")


def _assumed_mode(aside: dict[str, str], notes: list[str]) -> str:
    """Mode of moduli that no heading says: shear beside a column of it, as rheometers write, else tension; noted."""
    beside = next((heading for heading in aside if OF_SHEAR.search(heading)), None)
    reason = f"{beside!r} is beside them" if beside else "no heading says E or G"
    notes.append(f"{'shear' if beside else 'tension'} is assumed, since {reason}")
    return "shear" if beside else "tension"


def _kept(found: list[Column], aside: dict[str, str], mode: str, kind: str) -> dict[str, list[Column]]:
    """Quantity -> its columns; those of the other mode or kind, and measured beside reduced frequencies, go aside."""
    reduced = any(column.quantity == "reduced frequency" for column in found)
    kept: dict[str, list[Column]] = {}
    for column in found:
        other = UNITS[column.meaning.name] == ("Pa" if kind else "1/Pa") or column.meaning.mode not in ("", mode)
        if other:
            aside[column.heading] = "not needed"
        elif reduced and column.quantity == "frequency":
            aside[column.heading] = "the reduced frequency is taken"
        else:
            kept.setdefault(column.quantity, []).append(column)
    return kept


def _agreeing(table: Table, name: str, alike: list[Column], aside: dict[str, str]) -> Numbers:
    """The numbers of the first column of a quantity; others of the same quantity must agree with it."""
    first = numbers_of(table, alike[0])
    for column in alike[1:]:
        second = numbers_of(table, column)
        relative = 0.0 if name == "temperature" else (_ROUND_PI if name.endswith("frequency") else AVERAGED)
        allowed = relative * np.abs(first.values) + SAME_TEMPERATURE * (name == "temperature")
        agrees = np.abs(first.values - second.values) <= first.half + second.half + allowed
        both = f"{alike[0].heading!r} and {column.heading!r}"
        refuse(table, agrees, f"{both} contradict each other: choose by columns={{{name!r}: ...}}")
        aside[column.heading] = f"agrees with {alike[0].heading!r}"
    return first


def _warn_assumed(table: Table, taken: list[Column], fills: Mapping[str, str]) -> None:
    """Warn of units that neither the file nor the user says; refuse a modulus without one beside one that has it."""
    words = {"frequency": "rad/s", "moduli": "Pa"}
    assumed = []
    for word, unit in words.items():
        alike = [column for column in taken if UNITS[column.meaning.name] == unit]
        without = [column for column in alike if not column.stated and unit not in fills]
        if without and len(without) < len(alike):
            raise FileError(table.path, f"column {without[0].heading!r} has no unit, but others do: give units=")
        assumed += [f"{column.unit} ({word})" for column in without[:1]]
    if assumed:
        text = f"{table.path}: columns without a unit are taken in {' and '.join(assumed)}"
        warnings.warn(f"{text}: write units into the file, or give units=", ModelWarning, stacklevel=caller_level())


def _refuse_mixed(table: Table, record: DynamicModuli) -> None:
    """Raise FileError for rows of one frequency, and for several sweeps without the temperature of each."""
    omega, n = record.omega, record.omega.size
    if n > 1 and omega.max() < (1.0 + _ONE_FREQUENCY) * omega.min():
        raise FileError(
            table.path, f"all {n} rows are of one frequency, {omega[0]:.4g} rad/s: this is no frequency sweep"
        )
    if record.temperature is None and table.parts > 1:
        raise FileError(table.path, f"has {table.parts} tables, and no column has their temperature: keep one of them")
    if record.isothermal:
        order = np.argsort(omega, kind="stable")
        same = np.diff(omega[order]) <= _ONE_FREQUENCY * omega[order][1:]
        jumps = np.abs(np.diff(np.log(np.abs(record.storage[order])))) > np.log(_REPEATED)
        if (same & jumps).any():
            line = table.lines[int(order[1:][np.argmax(same & jumps)])]
            problem = f"line {line}: the same frequency has another modulus in a row before"
            raise FileError(
                table.path, f"{problem}: rows of several temperatures or strains need a column of temperature"
            )
