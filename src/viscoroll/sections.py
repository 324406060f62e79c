"""Sections of TOML files, checked: misspelt keys, wrong types, and the line at fault."""

from __future__ import annotations

import difflib
import re
import tomllib
from collections.abc import Iterable
from contextlib import suppress
from os import PathLike
from pathlib import Path
from typing import Any, TypeVar, get_type_hints

import msgspec

from .errors import ConfigError

T = TypeVar("T")
_HEADER = re.compile(r"\s*\[+\s*([^\]]*?)\s*\]")
_AT = re.compile(r"\$\.(\w+)")


def read(path: str | PathLike[str]) -> dict[str, Any]:
    """The content of a TOML file; raises ConfigError."""
    try:
        return tomllib.loads(Path(path).read_text(encoding="utf-8-sig"))
    except OSError as error:
        raise ConfigError(path, f"cannot be read ({error.strerror or error})") from error
    except UnicodeDecodeError as error:
        raise ConfigError(path, f"is not TOML (byte {error.start} is not UTF-8)") from error
    except (ValueError, RecursionError) as error:  # tomllib's own error is a ValueError; so is a number of 5000 digits
        raise ConfigError(path, f"is not TOML ({error})") from error


def as_struct(path: Any, name: str, content: Any, kind: type[T]) -> T:
    """``content`` of section ``name`` as a ``kind``, its keys and types checked; raises ConfigError."""
    refuse_unknown(path, name, content, get_type_hints(kind))
    try:
        return msgspec.convert(content, kind)
    except msgspec.ValidationError as error:
        key = _AT.search(str(error))
        problem = str(error).replace(" | null", "")  # TOML has none
        raise fault(path, name, key.group(1) if key else "", problem) from error


def refuse_unknown(path: Any, name: str, content: Any, allowed: Iterable[str]) -> None:
    """Raise ConfigError, with the nearest allowed key, where a section has a key that is none."""
    if not isinstance(content, dict):
        raise fault(path, "", name, f"{name} = {content!r:.40}: must be a section [{name}]")
    known = list(allowed)
    for key in content:
        if key not in known:
            raise fault(path, name, key, f"unknown key {key!r}: must be one of {', '.join(known)}{hint(key, known)}")


def fault(path: Any, name: str, key: str, problem: str) -> ConfigError:
    """The error to raise for ``key`` of section ``name`` ("": the top), with its line if that is found."""
    line = None
    with suppress(OSError, UnicodeDecodeError):
        line = line_of(Path(path).read_text(encoding="utf-8-sig"), name, key)
    at = "" if line is None else f"line {line}: "
    return ConfigError(path, f"{at}[{name}] {problem}" if name else f"{at}{problem}")


def line_of(text: str, name: str, key: str) -> int | None:
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
        return line_of(text, *name.rsplit(".", 1))
    return of_section


def hint(name: str, candidates: Iterable[str]) -> str:
    """A question for the nearest of ``candidates``, or nothing."""
    near = difflib.get_close_matches(name, list(candidates), n=1, cutoff=0.5)
    return f"; did you mean {near[0]!r}?" if near else ""
