"""Checks of the sections of TOML files: unknown keys and wrong types, with the number of the
line.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import is_dataclass
from os import PathLike
from pathlib import Path
from typing import Any, TypeVar, get_args, get_type_hints

import msgspec

from .errors import FileError, ParameterError, suggestion
from .files import as_file_error

T = TypeVar("T")
#: Line with the header of a section.
_HEADER = re.compile(r"\s*\[+\s*([^\]]*?)\s*\]")
#: Number with a decimal comma as the value of a key.
_DECIMAL_COMMA = re.compile(r"=\s*([-+]?[\d.]+,\d+)")
#: List in one line.
_LIST = re.compile(r"\[[^\]]*\]")
#: Keys and indices in the path of a msgspec error, as ".prony.E[2]".
_KEYS = re.compile(r"\w+")
#: Message of msgspec for a wrong type.
_WRONG_TYPE = re.compile(r"Expected `([^`]*)`, got `[^`]*`")
#: Message of msgspec for a number out of range.
_OUT_OF_RANGE = re.compile(r"Expected `[^`]*` (.*)")
#: Message of msgspec for a missing key.
_MISSING = re.compile(r"Object missing required field `(.*)`")
#: Type as msgspec names it -> words.
_TYPE_NAMES = {
    "float": "a number without a unit",
    "int": "a whole number",
    "str": "a text",
    "bool": "true or false",
    "array": "a list",
    "object": "a table",
}


def read_toml(path: str | PathLike[str]) -> dict[str, Any]:
    """Return the content of a TOML file, as tomllib reads it: name of a key or section -> value or
    dict.

    path: path of the file, in UTF-8; a byte order mark is ignored.
    Raises FileError if it cannot be read, is not UTF-8 or is not TOML.
    """
    try:
        with as_file_error(path, "cannot be read"):
            return tomllib.loads(Path(path).read_text(encoding="utf-8-sig"))
    except UnicodeDecodeError as error:
        raise FileError(path, f"is not TOML (byte {error.start} is not UTF-8)") from error
    except (
        ValueError,
        RecursionError,
    ) as error:  # a ValueError of tomllib, or of Python for a number of 5000 digits
        advice = _advise_on_comma(Path(path), str(error))
        raise FileError(path, f"is not TOML ({error}){advice}") from error


def _advise_on_comma(path: Path, problem: str) -> str:
    """Return advice on a decimal comma in a file that is not TOML, to be appended to the error.

    path: path of the file, which is read again.
    problem: message of tomllib, which names the line.
    Returns ": " and words if the value of a key in that line, outside of lists, has a decimal
    comma, else "".
    """
    if number := re.search(r"line (\d+)", problem):
        line = path.read_text(encoding="utf-8-sig").split("\n")[int(number[1]) - 1]
        if comma := _DECIMAL_COMMA.search(_LIST.sub("", line)):
            return f": {comma[1]} must have a decimal point"
    return ""


def as_struct(path: Any, name: str, content: Any, kind: type[T]) -> T:
    """Return a section as an instance of a class, its keys and types checked at any depth.

    Unknown keys of the section and its subsections are refused first; then msgspec converts the
    content, and its error is put into words.

    path: path of the file, for errors; it is read again for the line.
    name: name of the section, as "material", for errors.
    content: content of the section, as tomllib reads it; not changed.
    kind: the class, of msgspec or a dataclass, whose fields are the keys.
    Returns a new instance of ``kind``.
    Raises FileError with the line of the first key that is unknown, missing, of the wrong type or
    out of range; also for a section that is no table.
    """
    _check_all_keys(path, name, content, kind)
    try:
        return msgspec.convert(content, kind)
    except msgspec.ValidationError as error:
        problem, _, location = str(error).partition(" - at `$")
        keys = _KEYS.findall(location)
        value = content
        for key in keys:
            value = value[int(key)] if isinstance(value, list) else value[key]
        words = [key for key in keys if not key.isdecimal()]
        if missing := _MISSING.fullmatch(problem):
            raise section_error(
                path, ".".join((name, *words)), "", f"needs {missing[1]}"
            ) from error
        text = repr(value)
        found = f"{words[-1]} = {text if len(text) <= 40 else f'{text:.37}...'}" if words else ""
        if expected := _WRONG_TYPE.fullmatch(problem):
            types = " or ".join(
                _TYPE_NAMES[name] for name in expected[1].split(" | ") if name != "null"
            )
            problem = f"{'.'.join(words)} = {value!r:.40}: must be {types}"
        elif bounds := _OUT_OF_RANGE.fullmatch(problem):
            problem = f"{found}: must be {bounds[1]}"
        elif words and (choices := _list_choices(kind, words)):
            problem = f"{found}: must be one of {choices}"
        elif problem == "Number out of range":
            problem = f"{found}: is larger than a double can be, 1.8e+308"
        elif words and not isinstance(value, dict):
            problem = f"{found}: {problem}"
        raise section_error(
            path, ".".join((name, *words[:-1])), words[-1] if words else "", problem
        ) from error


def _list_choices(kind: Any, keys: list[str]) -> str:
    """Return the texts that a key may have, as ``'linear', 'log'``, for an error; "" if it is not a
    choice of texts.

    kind: class of the section, whose annotations state the choices as ``Literal``.
    keys: path of the key in it, from the outermost subsection to the key; a key that the class does
    not have gives "".
    """
    for key in keys:
        sections = (each for each in (kind, *get_args(kind)) if hasattr(each, "__struct_fields__"))
        kind = next(
            (get_type_hints(each)[key] for each in sections if key in get_type_hints(each)), None
        )
    return ", ".join(repr(each) for each in get_args(kind) if isinstance(each, str))


def _check_all_keys(path: Any, name: str, content: Any, kind: Any) -> None:
    """Raise FileError, with the line of the key, for keys that a section or its subsections do not
    have.

    A subsection is a table at a key whose type is, or may be, a struct or dataclass; other tables
    are not searched.  Keys of the section come first, then those of its subsections in order.

    path, name: path of the file and name of the section, as "material.prony", for errors.
    content: keys and values of the section; what is no table is refused too.
    kind: struct or dataclass whose fields are the allowed keys; of several that a type allows the
    first counts.
    """
    hints = get_type_hints(kind)
    check_keys(path, name, content, hints)
    for key, value in content.items():
        kinds = hints[key], *get_args(hints[key])
        subsections = [
            each for each in kinds if is_dataclass(each) or hasattr(each, "__struct_fields__")
        ]
        if subsections and isinstance(value, dict):
            _check_all_keys(path, f"{name}.{key}", value, subsections[0])


def check_keys(path: Any, name: str, content: Any, allowed: Iterable[str]) -> None:
    """Refuse an unknown key of a section; the error states its line and a similar allowed key if
    there is one.

    path: path of the file, for the error, which reads it again for the line.
    name: name of the section, "" for the top level.
    content: content of the section, as tomllib reads it; subsections are not searched.
    allowed: keys that the section may have.
    Raises FileError for an unknown key, and for content that is no section.
    """
    if not isinstance(content, dict):
        raise section_error(path, "", name, f"{name} = {content!r:.40}: must be a section [{name}]")
    known = list(allowed)
    for key in content:
        if key not in known:
            problem = (
                f"unknown key {key!r}: must be one of {', '.join(known)}{suggestion(key, known)}"
            )
            raise section_error(path, name, key, problem)


@contextmanager
def as_section_error(path: Any, name: str, key: str = "") -> Iterator[None]:
    """Raise a ParameterError of the body of the ``with`` as FileError of a section, with its line;
    a context manager.

    Other exceptions pass unchanged.

    path: path of the file, which is read again for the line.
    name: name of the section.
    key: key that is at fault; "": the name of the parameter in the error is taken for the key.
    Yields None.
    """
    try:
        yield
    except ParameterError as error:
        raise section_error(path, name, key or error.name, str(error)) from error


def section_error(path: Any, name: str, key: str, problem: str) -> FileError:
    """Return the FileError, not raised, of a key of a section, with the number of its line if that
    is found.

    path: path of the file, which is read again for the line.
    name: name of the section, "" for the top level.
    key: key in the section, "" for the section itself; the message states it only as far as
    ``problem`` does.
    problem: what is wrong, in words, which end the message.
    The message is "PATH: line N: [NAME] PROBLEM", without the line if neither key nor section is
    found or the file cannot be read, and without [NAME] at the top level.
    """
    line = None
    with suppress(OSError, UnicodeDecodeError):
        line = find_line(Path(path).read_text(encoding="utf-8-sig"), name, key)
    prefix = "" if line is None else f"line {line}: "
    return FileError(path, f"{prefix}[{name}] {problem}" if name else f"{prefix}{problem}")


def find_line(text: str, name: str, key: str) -> int | None:
    """Return the number of the line that sets a key, for an error.

    text: content of the file, TOML.
    name: name of the section, as "material.prony", "" for the top level; of the second of several
    [[data]] "data 2".
    key: key in the section, "" for the section itself.
    Returns the number, from 1, of the first line that sets the key or is the header of that
    subsection; if there is none, that of the header of the section; if there is none and the name
    has a point, as for an inline table ``prony = { ... }`` in [material], what is found for "prony"
    as a key of "material"; else None.
    """
    full = f"{name}.{key}" if name else key
    plain = re.compile(rf"\s*[\"']?{re.escape(key)}[\"']?\s*[=.]")
    dotted = re.compile(rf"\s*{re.escape(full)}\s*[=.]")
    header = ""
    header_line = None
    tables = []
    for number, line in enumerate(text.splitlines(), 1):
        if found := _HEADER.match(line):
            header = found.group(1)
            if line.lstrip().startswith("[["):
                tables.append(header)
                header += f" {tables.count(header)}" * (tables.count(header) > 1)
            if header == full:
                return number
            if header == name:
                header_line = number
        elif (header == name and plain.match(line)) or (header == "" and dotted.match(line)):
            return number
    if header_line is None and "." in name:  # an inline table stands on the line of its name
        return find_line(text, *name.rsplit(".", 1))
    return header_line
