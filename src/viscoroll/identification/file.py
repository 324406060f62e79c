"""A TOML file of measurements: a cylinder, [unknown], [prior] and [[data]] -> what :func:`identify` takes."""

from __future__ import annotations

import csv
import dataclasses
import re
from os import PathLike
from pathlib import Path
from typing import Any, Literal

import msgspec

from ..config import read_body
from ..cylinder import Cylinder
from ..errors import ConfigError, ParameterError, TableError
from ..materials.file import shifts_of
from ..scale import refuse_other_unit
from ..sections import as_struct, fault, hint, read
from .motions import Coastdown
from .records import Record, Resistance, Traction

_SECTIONS = ("unknown", "prior", "data")
_KINDS: dict[str, type[Record]] = {"resistance": Resistance, "traction": Traction, "coastdown": Coastdown}
#: in place of a start speed, what Python gives None for
_UNKNOWN = "unknown"
_HEADING = re.compile(r"(.*?)\s*[\[(](.*)[\])]$")


class DataSection(msgspec.Struct, omit_defaults=True):
    """[[data]]: a record, whose columns lie in a CSV file beside; the keys of its class."""

    kind: Literal["resistance", "traction", "coastdown"]
    file: str
    columns: dict[str, str] = {}
    sigma: float | dict[str, float] | None = None
    load: float | None = None
    temperature: float | None = None
    name: str = ""
    V0: float | None = None
    omega0: float | str | None = None
    t0: float | list[float] | None = None
    m: float | None = None


def read_measurements(path: str | PathLike[str]) -> dict[str, Any]:
    """Arguments of :func:`identify` that a file gives: cylinder, unknown, data, prior, shift.

    Raises
    ------
    ConfigError
        A file that cannot be read, a misspelt key, a value of the wrong type or out of range, with its line.
    TableError
        A file of data that cannot be read, or without a column.
    """
    cylinder, content = read_body(path, _SECTIONS), read(path)
    if not isinstance(cylinder, Cylinder):
        raise fault(path, "", "scene", "measurements are in SI units: give [cylinder]")
    for section in ("unknown", "data"):
        if section not in content:
            raise ConfigError(path, f"section [{section}] is missing")
    given = [name for name in ("unknown", "prior") if name in content]
    spans = {name: as_struct(path, name, {"of": content[name]}, _Spans).of for name in given}
    if not isinstance(content["data"], list):
        raise fault(path, "", "data", "data: must be sections [[data]]")
    data = [_record(Path(path), given) for given in content["data"]]
    return {"cylinder": cylinder, "data": data, "shift": shifts_of(path, content)} | spans


class _Spans(msgspec.Struct):
    of: dict[str, tuple[float, float]]


def _record(path: Path, content: Any) -> Record:
    given = as_struct(path, "data", content, DataSection)
    kind = _KINDS[given.kind]
    own = {name: value for name, value in msgspec.structs.asdict(given).items() if value is not None}
    for name in ("kind", "file", "columns"):
        del own[name]
    known = {field.name for field in dataclasses.fields(kind) if field.init}
    if wrong := [name for name in own if name not in known]:
        raise fault(path, "data", wrong[0], f"{wrong[0]}: must be left out of a {given.kind}")
    if own.get("omega0") == _UNKNOWN:
        own["omega0"] = None
    try:
        return kind(**own, **_columns(path.parent / given.file, kind, given.columns))
    except ParameterError as error:
        raise fault(path, "data", "file", f"{given.file}: {error}") from error


def _columns(path: Path, kind: type[Record], named: dict[str, str]) -> dict[str, Any]:
    """Places and quantities of a CSV file, by the names given to its columns, or their own."""
    try:
        with path.open(newline="", encoding="utf-8-sig") as file:
            rows = [[cell.strip() for cell in row] for row in csv.reader(file) if row and not row[0].startswith("#")]
    except (OSError, ValueError, csv.Error) as error:
        raise TableError(path, f"cannot be read ({error})") from error
    if len(rows) < 2:
        raise TableError(path, "must have a line of names and a row of numbers a point")
    heads = [_HEADING.match(cell) for cell in rows[0]]
    names = [head[1] if head else cell for head, cell in zip(heads, rows[0], strict=True)]
    found = {}
    for quantity in (*kind.PLACES, *kind.KINDS):
        name = named.get(quantity, quantity)
        if name not in names:
            if quantity in kind.PLACES or quantity in named:
                raise TableError(path, f"has no column {name!r}, but {', '.join(names)}{hint(name, names)}")
            continue
        n = names.index(name)
        if head := heads[n]:
            refuse_other_unit(quantity, head[2], kind.unit(quantity))
        found[quantity] = [_number(path, line, row, n) for line, row in enumerate(rows[1:], 2)]
    if wrong := named.keys() - {*kind.PLACES, *kind.KINDS}:
        raise TableError(path, f"columns: {', '.join(wrong)}: must be of {', '.join((*kind.PLACES, *kind.KINDS))}")
    return found


def _number(path: Path, line: int, row: list[str], n: int) -> float:
    try:
        return float(row[n])
    except (IndexError, ValueError):
        raise TableError(path, f"row {line} is no row of numbers: {','.join(row)[:60]!r}") from None
