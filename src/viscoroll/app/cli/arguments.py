"""The table of commands, and what their arguments mean: numbers, ranges, the scene, the output file."""

from __future__ import annotations

import os
from argparse import ArgumentTypeError, Namespace
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import viscoroll as vr

FIGURES = (".png", ".pdf", ".svg")

Run = Callable[[Namespace], int | None]


class Option(NamedTuple):
    """An argument, as of ``ArgumentParser.add_argument``; of those that are ``exclusive`` a command line has one."""

    names: tuple[str, ...]
    about: dict[str, Any]
    exclusive: bool = False


class Command(NamedTuple):
    """``run`` gives an exit code other than 0, or None; its docstring is the help, with an example at its end."""

    run: Run
    options: tuple[Option, ...]


#: the words of every command, in the order of ``--help``
COMMANDS: dict[str, Command] = {}


def command(words: str, *options: Option) -> Callable[[Run], Run]:
    """Add a function to :data:`COMMANDS`."""

    def add(run: Run) -> Run:
        COMMANDS[words] = Command(run, options)
        return run

    return add


def option(*names: str, **about: Any) -> Option:
    """An argument of a command."""
    return Option(names, about)


def numbers(text: str) -> Any:
    """A number, LOW:HIGH:COUNT, LOW:HIGH:COUNT:log, or several of these with commas between; one stays a scalar."""
    import numpy as np

    parts = [_part(part) for part in text.split(",")]
    return parts[0] if len(parts) == 1 else np.hstack(parts)


def _part(text: str) -> Any:
    try:
        low, *rest = text.split(":")
        if not rest:
            return float(low)
        high, count, *spacing = rest
        return vr.tables.spread(float(low), float(high), int(count), *spacing)  # type: ignore[arg-type]
    except vr.ParameterError as error:
        raise ArgumentTypeError(f"{text!r}: {error}") from None
    except (ValueError, TypeError):
        allowed = "a number, LOW:HIGH:COUNT, LOW:HIGH:COUNT:log, or several of these with commas between"
        raise ArgumentTypeError(f"{text!r} must be {allowed}") from None


def body_of(text: str) -> Any:
    """The scene or the cylinder of a file, or the preset of that name.

    Raises
    ------
    ParameterError
        An unknown preset.
    FileError
        A file that cannot be read, or whose name does not end in .toml.
    """
    from ...io.config import preset, read_roller

    if text.lower().endswith(".toml"):
        return read_roller(text)
    if os.path.exists(text):
        raise vr.FileError(text, "is no scene file: its name must end in .toml")
    return preset(text)


def output(*suffixes: str, name: str = "-o", required: bool = True, more: str = "") -> Option:
    """-o FILE, or another option, with one of ``suffixes``; what cannot be written is refused before any work."""

    def path(text: str) -> Path:
        text = text.rstrip("/") if text.endswith(".zarr/") else text  # as shells complete the name of a folder
        if Path(text).suffix.lower() not in suffixes:
            raise ArgumentTypeError(f"{text!r} must end in {' or '.join(suffixes)}")
        if not os.path.isdir(os.path.dirname(text) or "."):
            raise ArgumentTypeError(f"{text!r} cannot be written: its folder does not exist")
        if os.path.isdir(text) and not text.endswith(".zarr"):
            raise ArgumentTypeError(f"{text!r} cannot be written: it is a directory")
        return Path(text)

    text = f"{' or '.join(suffixes)}{more}"
    return option(
        name, dest="output" if name == "-o" else name[2:], metavar="FILE", type=path, required=required, help=text
    )


FILE = option("file", metavar="FILE")
SCENE = option("scene", metavar="SCENE", help="FILE.toml with [scene], [cylinder] (SI) or preset; or a preset")
#: of a table of numbers
TABLE = (
    output(".txt", ".csv", ".nc", required=False, more="; without it: standard output")._replace(exclusive=True),
    option(
        "--format", choices=("text", "csv", "json"), default="text", help="of standard output (default: text)"
    )._replace(exclusive=True),
)
