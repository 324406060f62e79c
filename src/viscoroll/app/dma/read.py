"""Storage and loss modulus over frequency from a text file: :func:`read_dma`."""

from __future__ import annotations

import re
import warnings
from collections.abc import Mapping
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from ...core.errors import FileError, ModelWarning, ParameterError, outside, refuse_unknown
from ...core.typed import Floats
from ...io.measurements import Numbers, Table, conversion, read_table
from .choose_columns import Columns, choose_columns
from .names import UNITS, meanings
from .record import SAME_TEMPERATURE, DynamicModuli
from .solve import PAIRS, storage_and_loss

#: what a column of frequencies may be called, that which is taken first
_FREQUENCIES = ("reduced angular frequency", "reduced frequency", "angular frequency", "frequency")
#: 2 pi as people write it, 6.28, is off by 5e-4
_ROUND_PI = 1e-3
#: frequencies that differ by less are one: instruments hold theirs to this
_ONE_FREQUENCY = 1e-3
#: moduli at one frequency and one temperature repeat within this factor; beyond, something else was varied
_REPEATED = 1.25
#: columns beside moduli without E or G that only a test in shear has
_OF_SHEAR = re.compile(r"(?i)shear|schub|scher|torque|torsion|drehmoment|viscosity|viskosit|gamma|γ")
#: columns that number sweeps of a file
_SWEEPS = re.compile(
    r"(?i)(step|set|segment|sweep|interval|cycle|curve|run|series|schritt|zyklus)\W*(no|nr|number|id)?\W*"
)


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
        compliance, loss compliance, whole compliance, temperature, and reduced (angular) frequency.  The columns of a
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
    refuse_unknown("columns", named, UNITS, "a meaning")
    given, default = _units_given(units)
    table = read_table(path, lambda cells: _known(cells, named), decimal=decimal, encoding=encoding)
    if table.bare and not named:
        if len(table.headings) != 3:
            problem = (
                f"has {len(table.headings)} columns, and no heading that names frequency, storage and loss modulus"
            )
            raise FileError(path, f"{problem}: give columns=")
        named = dict(zip(("angular frequency", "storage", "loss"), table.headings, strict=True))
    chosen = choose_columns(table, named, given, default)
    notes = [f"{table.parts} tables"] * (table.parts > 1)
    mode, pair, compliance = _pair(chosen, notes)
    numbers = {name: _agreeing(chosen, name) for name in chosen.found}
    omega = _omega(chosen, numbers, notes)
    storage, loss = _moduli(chosen, numbers, pair, compliance, notes)
    temperature = numbers["temperature"].values if "temperature" in numbers else None
    units_taken = {name: chosen.unit(name) for name in chosen.found}
    if chosen.assumed:
        words = " and ".join(f"{unit} ({of})" for of, unit in sorted(chosen.assumed.items()))
        text = f"{path}: columns without a unit are taken in {words}"
        warnings.warn(f"{text}: write units into the file, or give units=", ModelWarning, stacklevel=outside())
    aside = [f"{heading!r}" + f" ({why})" * bool(why) for heading, why in chosen.aside.items()]
    notes += ["left aside: " + ", ".join(aside)] * bool(aside)
    found = {name: chosen.heading(name) for name in chosen.found}
    record = DynamicModuli(
        omega, storage, loss, temperature, mode, Path(path).name, found,
        units_taken, tuple(notes),
    )  # fmt: skip
    _refuse_mixed(table, record, chosen)
    return record


def _units_given(units: Any) -> tuple[dict[str, str], tuple[str, str] | None]:
    """Units by meaning that overrule the file, and those of columns that have none; raises ParameterError."""
    allowed = "(frequency, moduli), as ('Hz', 'MPa'), or meaning -> unit"
    by_name = isinstance(units, Mapping)
    if units is None:
        return {}, None
    if not by_name and not (isinstance(units, (tuple, list)) and len(units) == 2):
        raise ParameterError("units", f"{units!r:.60}", allowed)
    pairs = dict(units) if by_name else dict(zip(("frequency", "storage"), units, strict=True))
    refuse_unknown("units", pairs, UNITS, "a meaning")
    for name, unit in pairs.items():
        try:
            conversion(str(unit), UNITS[name])
        except ParameterError as error:
            raise ParameterError("units", f"{units!r:.60}", f"{allowed}; {unit!r} is none of {name}") from error
    return (pairs, None) if by_name else ({}, (units[0], units[1]))


def _known(cells: list[str], named: Mapping[str, str]) -> bool:
    """Whether a line of texts is one of headings: two of its cells have a meaning, or one was named by the user."""
    found = {said[0].name for cell in cells if cell and (said := meanings(cell))}
    return len(found) > 1 or any(cell in named.values() for cell in cells if cell)


def _pair(chosen: Columns, notes: list[str]) -> tuple[str, tuple[str, str], str]:
    """Mode, the two columns that give the moduli, and whether they are of moduli ("") or " compliance"s.

    Columns of the other mode and of the other kind are left aside.
    """
    columns = [(name, said.mode) for name, found in chosen.found.items() for _, said in found]
    modes = [mode for mode in ("tension", "shear") if any(own == mode for _, own in columns)]
    for mode in modes or [""]:
        names = {name for name, own in columns if own in ("", mode)}
        for kind in ("", " compliance"):
            pair = next((pair for pair in PAIRS if all(_there(name, kind, names) for name in pair)), None)
            if pair and names.intersection(_FREQUENCIES):
                _leave(chosen, mode, kind)
                return mode or _assumed_mode(chosen, notes), pair, kind
    table, names = chosen.table, {name for name, _ in columns}
    missing = "frequency" if not names.intersection(_FREQUENCIES) else "two of storage, loss, tan delta and modulus"
    sweep = ": a sweep of temperature is none of frequency" if missing == "frequency" and "temperature" in names else ""
    problems = "".join(
        f"; {heading!r}: {why}" for heading, why in chosen.aside.items() if why not in ("", "words", "empty")
    )
    headings = ", ".join(map(repr, filter(None, table.headings)))
    raise FileError(table.path, f"no column is named {missing}{sweep}{problems}; headings: {headings}; give columns=")


def _assumed_mode(chosen: Columns, notes: list[str]) -> str:
    """Mode of moduli that no heading says: shear beside a column of it, as rheometers write, else tension; noted."""
    beside = next((heading for heading in chosen.aside if _OF_SHEAR.search(heading)), None)
    reason = "no heading says E or G" if beside is None else f"{beside!r} is beside them"
    notes.append(f"{'tension' if beside is None else 'shear'} is assumed, since {reason}")
    return "tension" if beside is None else "shear"


def _there(name: str, kind: str, names: set[str]) -> bool:
    """Whether there is a column for a member of a pair; a phase angle stands for tan delta."""
    return bool(names & {"tan delta", "phase angle"}) if name == "tan delta" else _full(name, kind) in names


def _full(name: str, kind: str) -> str:
    """The meaning of a member of a pair, of moduli or compliances."""
    return name if not kind or name == "tan delta" else ("whole" if name == "modulus" else name) + kind


def _leave(chosen: Columns, mode: str, kind: str) -> None:
    """Leave columns aside that are of the other mode, or of compliances beside moduli and the other way round."""
    other = "Pa" if kind else "1/Pa"
    for name, found in [*chosen.found.items()]:
        kept = [each for each in found if each[1].mode in ("", mode) and UNITS[name] != other]
        for index, _ in [each for each in found if each not in kept]:
            chosen.aside[chosen.table.headings[index]] = "not needed"
        chosen.found[name] = kept
        if not kept:
            del chosen.found[name]


def _agreeing(chosen: Columns, name: str) -> Numbers:
    """The numbers of the first column of a meaning; others of the same meaning must agree with it."""
    first = chosen.numbers(name)
    for place, (index, _) in enumerate(chosen.found[name][1:], 1):
        second = chosen.numbers(name, place)
        allowed = SAME_TEMPERATURE if name == "temperature" else _ROUND_PI * np.abs(first.values)
        _refuse_unlike(chosen, name, first, second, chosen.table.headings[index], allowed)
        chosen.aside[chosen.table.headings[index]] = f"agrees with {chosen.heading(name)!r}"
    return first


def _refuse_unlike(chosen: Columns, name: str, first: Numbers, second: Numbers, heading: str, allowed: Any) -> None:
    """Raise FileError where two columns of one meaning differ by more than their rounding and what is allowed."""
    off = ~(np.abs(first.values - second.values) <= first.half + second.half + allowed)
    if off.any():
        line = chosen.table.lines[int(np.argmax(off))]
        both = f"{chosen.heading(name)!r} and {heading!r}"
        raise FileError(
            chosen.table.path, f"line {line}: {both} contradict each other: choose by columns={{{name!r}: ...}}"
        )


def _omega(chosen: Columns, numbers: dict[str, Numbers], notes: list[str]) -> Floats:
    """Angular frequencies, rad/s: reduced ones before measured ones; two columns of the same must agree."""
    first, *others = (name for name in _FREQUENCIES if name in numbers)
    reduced = first.startswith("reduced")
    for name in others:
        if name.startswith("reduced") == reduced:
            heading, allowed = chosen.heading(name), _ROUND_PI * np.abs(numbers[first].values)
            _refuse_unlike(chosen, first, numbers[first], numbers[name], heading, allowed)
            _drop(chosen, numbers, name, f"agrees with {chosen.heading(first)!r}")
        else:
            _drop(chosen, numbers, name, "the reduced frequency is taken")
    if reduced and "temperature" in numbers and np.ptp(numbers["temperature"].values) > SAME_TEMPERATURE:
        _drop(chosen, numbers, "temperature", "reduced frequencies are of one temperature")
    omega = numbers[first].values
    if not (omega > 0.0).all():
        line = chosen.table.lines[int(np.argmin(omega > 0.0))]
        raise FileError(chosen.table.path, f"line {line}: {chosen.heading(first)!r} is not > 0")
    notes += [f"{chosen.heading(name)!r} is log10" for name in numbers if chosen.found[name][0][1].log]
    return omega


def _drop(chosen: Columns, numbers: dict[str, Numbers], name: str, why: str) -> None:
    """Leave the column of a meaning aside."""
    chosen.aside[chosen.heading(name)] = why
    del chosen.found[name], numbers[name]


def _moduli(
    chosen: Columns, numbers: dict[str, Numbers], pair: tuple[str, str], kind: str, notes: list[str]
) -> tuple[Floats, Floats]:
    """Storage and loss modulus, Pa, from two columns; the others are compared."""
    names = ("storage", "loss", "modulus", "tan delta")
    own = {name: numbers[full] for name in names if (full := _full(name, kind)) in numbers}
    if "phase angle" in numbers:
        phase, half = numbers["phase angle"]
        as_tangent = Numbers(np.tan(phase), half / np.cos(phase) ** 2)
        own["phase angle" if "tan delta" in own else "tan delta"] = as_tangent
    storage, loss = storage_and_loss(chosen.table, pair, own)
    if kind:
        square = storage**2 + loss**2
        storage, loss = storage / square, loss / square
    if kind or pair != PAIRS[0]:
        taken = (name if name in numbers else "phase angle" for name in (_full(name, kind) for name in pair))
        notes.append(f"moduli are from {' and '.join(taken)}")
    notes += [f"{name} agrees with them" for name in own.keys() - set(pair)]
    return storage, loss


def _refuse_mixed(table: Table, record: DynamicModuli, chosen: Columns) -> None:
    """Raise FileError for rows of one frequency, and for several sweeps without the temperature of each."""
    omega, n = record.omega, record.omega.size
    if n > 1 and omega.max() < (1.0 + _ONE_FREQUENCY) * omega.min():
        raise FileError(
            table.path, f"all {n} rows are of one frequency, {omega[0]:.4g} rad/s: this is no frequency sweep"
        )
    if record.temperature is None:
        for index, heading in enumerate(table.headings):
            sweeps = {row[index] for row in table.rows}
            if heading in chosen.aside and _SWEEPS.fullmatch(heading) and 1 < len(sweeps) < n:
                problem = f"column {heading!r} numbers {len(sweeps)} sweeps, and no column has their temperature"
                raise FileError(table.path, f"{problem}: keep one of them")
        if table.parts > 1:
            raise FileError(
                table.path, f"has {table.parts} tables, and no column has their temperature: keep one of them"
            )
    if record.isothermal and n > 1:
        order = np.argsort(omega, kind="stable")
        same = np.diff(omega[order]) <= _ONE_FREQUENCY * omega[order][1:]
        jump = np.abs(np.diff(np.log(np.abs(record.storage[order])))) > np.log(_REPEATED)
        if (same & jump).any():
            line = table.lines[int(order[1:][np.argmax(same & jump)])]
            problem = f"line {line}: the same frequency has another modulus in a row before"
            raise FileError(
                table.path, f"{problem}: rows of several temperatures or strains need a column of temperature"
            )
