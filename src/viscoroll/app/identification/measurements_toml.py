"""A TOML file of measurements, a cylinder, [unknown], [prior] and [[data]], as arguments of
:func:`.identify.identify`.
"""

from __future__ import annotations

import dataclasses
import warnings
from os import PathLike
from pathlib import Path
from typing import Any

import msgspec

from ...core.errors import FileError, ModelWarning, ParameterError, caller_level, described_error
from ...core.sections import as_struct, check_keys, read_toml, section_error, suggestion
from ...cylinder import Cylinder
from ...io.config import read_roller
from ...io.measurements import column_in_unit, find_column, missing_column, named_table
from ...materials.material_toml import parse_shifts
from .records import Coastdown, Record, Resistance, Traction

#: section of the file -> its type
_SECTIONS = {"unknown": dict, "prior": dict, "data": list}
#: kind of [[data]] -> record
_KINDS: dict[str, type[Record]] = {"resistance": Resistance, "traction": Traction, "coastdown": Coastdown}
#: keys of [[data]] that all kinds of record have
_SECTION: list[Any] = [
    ("kind", str), ("file", str), ("decimal", str, ""), ("encoding", str, ""),
    *((name, dict[str, str], msgspec.field(default_factory=dict)) for name in ("columns", "units")),
]  # fmt: skip
#: word for an initial speed that is unknown, None in Python
_UNKNOWN = "unknown"


def read_measurements(path: str | PathLike[str]) -> dict[str, Any]:
    """Read the arguments of :func:`.identify.identify` from a TOML file.

    path : path of the TOML file, with [cylinder], [unknown], [[data]] and perhaps [prior].

    Returns
    -------
    dict
        Arguments of :func:`.identify.identify` by name: cylinder, a :class:`Cylinder`; unknown and prior, name -> two
        numbers, not checked here, prior perhaps empty; data, a list of records; shift, "material" or "base" -> a_T over
        temperature in degrees Celsius, of the materials that have one.

    Raises
    ------
    FileError
        A file that cannot be read, a misspelt key, a value of the wrong type or out of range, with its line; a [scene]
        in place of a [cylinder]; no [unknown] or no [[data]].  A file of data that cannot be read, or without a column.

    Warns
    -----
    ModelWarning
        Columns of a file of data that are left out.

    Examples
    --------
    >>> from viscoroll.app.identification.measurements_toml import read_measurements
    >>> vr.identify(**read_measurements(vr.datasets.path("measured.toml")))  # doctest: +SKIP
    """
    cylinder, content = read_roller(path, tuple(_SECTIONS)), {"prior": {}} | read_toml(path)
    if not isinstance(cylinder, Cylinder):
        raise section_error(path, "", "scene", "measurements are in SI units: give [cylinder]")
    for section, kind in _SECTIONS.items():
        if not isinstance(given := content.get(section), kind):
            header = "[[data]]" if kind is list else f"[{section}]"
            found = f"{section} = {given!r:.40}: must be a section {header}"
            raise section_error(path, "", section, found if section in content else f"section {header} is missing")
    data = [_record(Path(path), section, number) for number, section in enumerate(content["data"], 1)]
    ranges = {name: content[name] for name in ("unknown", "prior")}
    return {"cylinder": cylinder, "data": data, "shift": parse_shifts(path, content)} | ranges


def _record(path: Path, content: Any, number: int) -> Record:
    """Return the record of one [[data]].

    path : path of the TOML file, from whose folder files of data are found.
    content : the section as the TOML reader gives it, a dict:
        kind, "resistance", "traction" or "coastdown";
        file, path of the data, relative to the folder of the TOML file;
        decimal, "." or ",", and encoding, both optional, "" for what the file shows;
        columns, name -> heading, and units, name -> unit, both optional;
        fields of the record but coordinates and quantities, as sigma, load or V0, in SI units, all optional; "unknown"
        stands for None, but for a name.
    number : which of the sections [[data]] it is, from 1.
    Returns a :class:`Resistance`, :class:`Traction` or :class:`Coastdown`, a plan where the file has no quantity.
    Raises FileError for unknown keys, wrong types, values that make no record, and as :func:`_columns` does, whose
    ParameterError becomes a FileError too.
    """
    header = f"data {number}" if number > 1 else "data"
    given = content.get("kind") if isinstance(content, dict) else None
    kind = _KINDS.get(str(given))
    if kind is None:
        found = "needs kind" if given is None else f"kind = {given!r:.40}"
        problem = f"{found}: must be one of {', '.join(_KINDS)}{suggestion(str(given), _KINDS)}"
        raise section_error(path, header, "kind", problem)
    columns = (*kind.COORDINATES, *kind.QUANTITIES)
    fields = (field for field in dataclasses.fields(kind) if field.init and field.name not in columns)
    own = [(field.name, Any, field.default) for field in fields]
    section: Any = as_struct(path, header, content, msgspec.defstruct("Data", [*_SECTION, *own]))
    for name in ("columns", "units"):
        check_keys(path, f"{header}.{name}", getattr(section, name), columns)
    more: Any = {name: getattr(section, name) for name, *_ in own}
    more = {name: None if value == _UNKNOWN and name != "name" else value for name, value in more.items()}
    try:
        return kind(**more, **_columns(path.parent / section.file, kind, section))
    except ParameterError as error:
        raise FileError(path, f"[[data]] {section.file}: {error}") from error


def _columns(path: Path, kind: type[Record], section: Any) -> dict[str, Any]:
    """Read coordinates and quantities from a file of data, in SI units.

    path : path of the file of data.
    kind : class of the record, whose names of coordinates and quantities the columns have where the section names none.
    section : the [[data]] with its attributes ``columns``, name -> heading; ``units``, name -> unit in place of that of
        the file; ``decimal`` and ``encoding``, "" for what the file shows.
    Returns a dict, name of each coordinate, and of each quantity that the file has -> values, SI, (n,); columns without
    a unit are taken in SI units.

    Raises
    ------
    FileError
        A file that cannot be read; a coordinate, or a column that the section names or gives a unit of,
        that is missing; other columns
        where none is a quantity, since one of them may be; a cell that is no number.
    ParameterError
        A column whose unit has another dimension.

    Warns
    -----
    ModelWarning
        Columns that are left out.
    """
    headings = {name: section.columns.get(name, name) for name in (*kind.COORDINATES, *kind.QUANTITIES)}
    table = named_table(path, headings.values(), section.decimal or None, section.encoding or None)
    columns = {name: find_column(table, heading) for name, heading in headings.items()}
    present = [name for name, column in columns.items() if column is not None]
    for name in (*kind.COORDINATES, *section.columns, *section.units):
        if name not in present:
            raise missing_column(table, headings[name], f": name one of these in columns = {{ {name} = ... }}")
    others = [repr(heading) for n, heading in enumerate(table.headings) if heading and n not in columns.values()]
    if others and not set(present) & set(kind.QUANTITIES):
        name = kind.QUANTITIES[0]
        problem = f"has no column {' or '.join(kind.QUANTITIES)}, but {', '.join(others)}"
        advice = f"if one of them is {name}, name it in columns = {{ {name} = ... }}; to plan a test, delete them"
        raise FileError(path, f"{problem}: {advice}")
    if others:
        text = f"{path.name}: unused columns: {', '.join(others)}"
        warnings.warn(text, ModelWarning, stacklevel=caller_level())
    found = {}
    for name in present:
        unit = kind.unit(name)
        try:
            found[name] = column_in_unit(table, headings[name], unit, section.units.get(name, ""))
        except ParameterError as error:
            per = ", per metre of length of the cylinder" * unit.endswith(" m-1")
            raise described_error(name, f"is in {error.value}", f"in a unit of the dimension of {unit}{per}") from error
    return found
