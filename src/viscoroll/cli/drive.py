"""Options that drive a motion: force, torque, slope, brake and prescribed speeds."""

from __future__ import annotations

import csv
from argparse import ArgumentParser, ArgumentTypeError, Namespace
from collections.abc import Callable
from typing import Any

from .arguments import DISTRIBUTIONS, angle, distribution, number

SCHEDULE = (
    "a number, or VALUE@TIME,VALUE@TIME,... (linear between, constant outside,\n"
    "the same time twice: a jump), or FILE.csv with columns t,value"
)
_COLUMNS = ["t", "value"]
_WHAT = {
    "force": "along V, over P",
    "torque": "along omega, over P R",
    "brake": "most torque that a brake takes, over P R; it holds omega = 0 while it can",
    "omega": "prescribed speed of the motor, in place of --torque and --omega0",
    "V": "prescribed speed of the axis, in place of --force and --V0",
}


def add_drive_options(parser: ArgumentParser, drawn: bool = False) -> None:
    """--force, --torque, --slope, --brake, --omega and --V; ``drawn``: each may be a distribution."""
    may = f"\n{DISTRIBUTIONS.removeprefix('a number, ')} in place of a number" if drawn else ""
    group = parser.add_argument_group("drive", f"SCHEDULE: {SCHEDULE}{may}")
    slope = "slope angle (rad, or e.g. 3deg), positive downhill along +V; the normal load is P cos(slope)"
    group.add_argument("--slope", type=_or_drawn(angle) if drawn else angle, help=slope)
    for name, what in _WHAT.items():
        group.add_argument(f"--{name}", type=_or_drawn(schedule) if drawn else schedule, metavar="SCHEDULE", help=what)


def _or_drawn(plain: Callable[[str], Any]) -> Callable[[str], Any]:
    """Distributions too."""

    def parsed(text: str) -> Any:
        return distribution(text) if text.split(":")[0] in ("uniform", "normal") else plain(text)

    return parsed


def drive_of(arguments: Namespace) -> dict[str, Any]:
    """What is given of the drive, as keywords of ``roll``."""
    given = {name: getattr(arguments, name) for name in ("slope", *_WHAT)}
    return {name: value for name, value in given.items() if value is not None}


def schedule(text: str) -> float | tuple[list[float], list[float]]:
    """:data:`SCHEDULE`."""
    if text.endswith(".csv"):
        return _of_file(text)
    if "@" not in text and "," not in text:
        return number(text)
    values, times = [], []
    for part in text.split(","):
        value, at, time = part.partition("@")
        if not at:
            raise ArgumentTypeError(f"{text!r:.60}: {part!r:.40} must be VALUE@TIME")
        values.append(number(value))
        times.append(number(time))
    return times, values


def _of_file(path: str) -> tuple[list[float], list[float]]:
    """Times and values of a CSV file."""
    try:
        with open(path, newline="", encoding="utf-8") as file:
            first, *rows = [row for row in csv.reader(file) if row] or [[]]
    except OSError as error:
        raise ArgumentTypeError(f"{path}: cannot be read ({error.strerror or error})") from None
    except (ValueError, csv.Error) as error:
        raise ArgumentTypeError(f"{path}: is no CSV file ({error})") from None
    if [name.strip() for name in first] != _COLUMNS or not rows:
        raise ArgumentTypeError(f"{path}: must have a first line {','.join(_COLUMNS)} and a row of numbers a time")
    for row in rows:
        if len(row) != len(_COLUMNS):
            raise ArgumentTypeError(f"{path}: {','.join(row)!r:.40} must be a time and a value")
    return [number(row[0]) for row in rows], [number(row[1]) for row in rows]
