"""Sections of TOML files, checked: misspelt keys, wrong types, and the line at fault."""

from __future__ import annotations

import difflib
import re
import tomllib
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import is_dataclass
from os import PathLike
from pathlib import Path
from typing import Any, TypeVar, get_args, get_type_hints

import msgspec

from .errors import FileError

T = TypeVar("T")
_HEADER = re.compile(r"\s*\[+\s*([^\]]*?)\s*\]")
_KEYS = re.compile(r"\w+")
_EXPECTED = re.compile(r"Expected `([^`]*)`, got `[^`]*`")
_BOUNDS = re.compile(r"Expected `[^`]*` (.*)")
_MISSING = re.compile(r"Object missing required field `(.*)`")
#: what msgspec calls a type -> words
_WORDS = {
    "float": "a number without a unit", "int": "a whole number", "str": "a text", "bool": "true or false",
    "array": "a list", "object": "a table",
}  # fmt: skip


def read_toml(path: str | PathLike[str]) -> dict[str, Any]:
    """The content of a TOML file; raises FileError."""
    try:
        return tomllib.loads(Path(path).read_text(encoding="utf-8-sig"))
    except OSError as error:
        raise FileError(path, f"cannot be read ({error.strerror or error})") from error
    except UnicodeDecodeError as error:
        raise FileError(path, f"is not TOML (byte {error.start} is not UTF-8)") from error
    except (ValueError, RecursionError) as error:  # tomllib's own error is a ValueError; so is a number of 5000 digits
        raise FileError(path, f"is not TOML ({error})") from error


def as_struct(path: Any, name: str, content: Any, kind: type[T]) -> T:
    """``content`` of section ``name`` as a ``kind``, its keys and types checked to any depth; raises FileError."""
    _refuse_unknown_within(path, name, content, kind)
    try:
        return msgspec.convert(content, kind)
    except msgspec.ValidationError as error:
        problem, _, place = str(error).partition(" - at `$")
        keys, value = _KEYS.findall(place), content
        for key in keys:
            value = value[int(key)] if isinstance(value, list) else value[key]
        words = [key for key in keys if not key.isdecimal()]
        if missing := _MISSING.fullmatch(problem):
            raise section_error(path, ".".join((name, *words)), "", f"needs {missing[1]}") from error
        if expected := _EXPECTED.fullmatch(problem):
            kinds = " or ".join(_WORDS[kind] for kind in expected[1].split(" | ") if kind != "null")
            problem = f"{'.'.join(words)} = {value!r:.40}: must be {kinds}"
        elif bounds := _BOUNDS.fullmatch(problem):
            problem = f"{words[-1]} = {value!r:.40}: must be {bounds[1]}"
        elif words and (choices := _choices(kind, words)):
            problem = f"{words[-1]} = {value!r:.40}: must be one of {choices}"
        elif words and not isinstance(value, dict):
            problem = f"{words[-1]} = {value!r:.40}: {problem}"
        raise section_error(path, ".".join((name, *words[:-1])), words[-1] if words else "", problem) from error


def _choices(kind: Any, words: list[str]) -> str:
    """The texts that a key of a section may have, as ``'linear', 'log'``; "" where it is no choice of texts."""
    for word in words:
        sections = (each for each in (kind, *get_args(kind)) if hasattr(each, "__struct_fields__"))
        kind = next((get_type_hints(each)[word] for each in sections if word in get_type_hints(each)), None)
    return ", ".join(repr(each) for each in get_args(kind) if isinstance(each, str))


def _refuse_unknown_within(path: Any, name: str, content: Any, kind: Any) -> None:
    """Refuse keys that are unknown in a section, or in any section within it."""
    hints = get_type_hints(kind)
    check_keys(path, name, content, hints)
    for key, value in content.items():
        kinds = hints[key], *get_args(hints[key])
        parts = [each for each in kinds if is_dataclass(each) or hasattr(each, "__struct_fields__")]
        if parts and isinstance(value, dict):
            _refuse_unknown_within(path, f"{name}.{key}", value, parts[0])


def check_keys(path: Any, name: str, content: Any, allowed: Iterable[str]) -> None:
    """Raise FileError, with the nearest allowed key, where a section has a key that is none."""
    if not isinstance(content, dict):
        raise section_error(path, "", name, f"{name} = {content!r:.40}: must be a section [{name}]")
    known = list(allowed)
    for key in content:
        if key not in known:
            raise section_error(
                path, name, key, f"unknown key {key!r}: must be one of {', '.join(known)}{suggestion(key, known)}"
            )


def section_error(path: Any, name: str, key: str, problem: str) -> FileError:
    """The error to raise for ``key`` of section ``name`` ("": the top), with its line if that is found."""
    line = None
    with suppress(OSError, UnicodeDecodeError):
        line = find_line(Path(path).read_text(encoding="utf-8-sig"), name, key)
    at = "" if line is None else f"line {line}: "
    return FileError(path, f"{at}[{name}] {problem}" if name else f"{at}{problem}")


def find_line(text: str, name: str, key: str) -> int | None:
    """Number of the line that sets ``key`` in section ``name``, else of the section's header, else None."""
    full = f"{name}.{key}" if name else key
    plain = re.compile(rf"\s*[\"']?{re.escape(key)}[\"']?\s*[=.]")
    dotted = re.compile(rf"\s*{re.escape(full)}\s*[=.]")
    header, of_section = "", None
    for number, line in enumerate(text.splitlines(), 1):
        if found := _HEADER.match(line):
            header = found.group(1)
            if header == full:
                return number
            if header == name:
                of_section = number
        elif (header == name and plain.match(line)) or (header == "" and dotted.match(line)):
            return number
    if of_section is None and "." in name:  # an inline table: the line of its name
        return find_line(text, *name.rsplit(".", 1))
    return of_section


def suggestion(name: str, candidates: Iterable[str]) -> str:
    """A question for the nearest of ``candidates``, or nothing."""
    near = difflib.get_close_matches(name, list(candidates), n=1, cutoff=0.5)
    return f"; did you mean {near[0]!r}?" if near else ""
