"""A TOML file of measurements: a cylinder, [unknown], [prior] and [[data]] -> what :func:`identify` takes."""

from __future__ import annotations

import csv
import dataclasses
import re
from os import PathLike
from pathlib import Path
from typing import Any

import msgspec
import numpy as np

from ...core.errors import FileError, ParameterError
from ...core.scale import refuse_other_unit
from ...core.sections import as_struct, fault, hint, read, refuse_unknown
from ...cylinder import Cylinder
from ...io.config import read_body
from ...materials.file import shifts_of
from .records import Coastdown, Record, Resistance, Traction

_SECTIONS = {"unknown": dict, "prior": dict, "data": list}
_KINDS: dict[str, type[Record]] = {"resistance": Resistance, "traction": Traction, "coastdown": Coastdown}
#: keys of [[data]] beside those that its kind of record has
_SECTION: list[Any] = [("kind", str), ("file", str), ("columns", dict[str, str], msgspec.field(default_factory=dict))]
#: in place of a start speed, what Python gives None for
_UNKNOWN = "unknown"
_HEADING = re.compile(r"(.*?)\s*(?:[\[(](.*)[\])])?$")


def read_measurements(path: str | PathLike[str]) -> dict[str, Any]:
    """Arguments of :func:`identify` that a file gives: cylinder, unknown, data, prior, shift.

    Raises
    ------
    FileError
        A file that cannot be read, a misspelt key, a value of the wrong type or out of range, with its line.
        A file of data that cannot be read, or without a column.
    """
    cylinder, content = read_body(path, tuple(_SECTIONS)), {"prior": {}} | read(path)
    if not isinstance(cylinder, Cylinder):
        raise fault(path, "", "scene", "measurements are in SI units: give [cylinder]")
    for section, kind in _SECTIONS.items():
        if not isinstance(content.get(section), kind):
            raise fault(path, "", section, f"section {'[[data]]' if kind is list else f'[{section}]'} is missing")
    data = [_record(Path(path), section) for section in content["data"]]
    given = {name: content[name] for name in ("unknown", "prior")}
    return {"cylinder": cylinder, "data": data, "shift": shifts_of(path, content)} | given


def _record(path: Path, given: Any) -> Record:
    named = given.get("kind") if isinstance(given, dict) else None
    kind = next((kind for name, kind in _KINDS.items() if name == named), None)
    if kind is None:
        raise FileError(path, f"[[data]] kind: must be one of {', '.join(_KINDS)}")
    columns = (*kind.PLACES, *kind.KINDS)
    own = [(one.name, Any, one.default) for one in dataclasses.fields(kind) if one.init and one.name not in columns]
    section: Any = as_struct(path, "data", given, msgspec.defstruct("Data", [*_SECTION, *own]))
    refuse_unknown(path, "data.columns", section.columns, columns)
    values = {name: getattr(section, name) for name, *_ in own}
    more: Any = {name: None if value == _UNKNOWN else value for name, value in values.items()}
    try:
        return kind(**more, **_columns(path.parent / section.file, kind, section.columns))
    except ParameterError as error:
        raise FileError(path, f"[[data]] {section.file}: {error}") from error


def _columns(path: Path, kind: type[Record], called: dict[str, str]) -> dict[str, Any]:
    """Places and quantities of a CSV file, by the names given to its columns, or their own."""
    try:
        lines = path.read_text(encoding="utf-8-sig").splitlines()
        head, *rows = [line for line in lines if line.strip() and not line.startswith("#")] or [""]
    except (OSError, ValueError) as error:
        raise FileError(path, f"cannot be read ({error})") from error
    names, units = zip(*(_HEADING.findall(cell.strip())[0] for cell in next(csv.reader([head]))), strict=True)
    where = {}
    for quantity in (*kind.PLACES, *kind.KINDS):
        name = called.get(quantity, quantity)
        if name in names:
            where[quantity] = names.index(name)
            refuse_other_unit(quantity, units[where[quantity]] or None, kind.unit(quantity))
        elif quantity in kind.PLACES or quantity in called:
            raise FileError(path, f"has no column {name!r}, but {', '.join(names)}{hint(name, names)}")
    try:
        values = np.loadtxt(rows, delimiter=",", usecols=list(where.values()), ndmin=2, quotechar='"')
    except ValueError as error:
        raise FileError(path, f"is no table of numbers ({error})") from error
    return dict(zip(where, values.T, strict=True))
