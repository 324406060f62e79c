"""What the stages share: options, their section of the configuration, timing, and a record of what
they found.

A stage is a function work(settings, out) -> Outcome.  :func:`run` calls it and leaves
<out>/stages/<name>.json: seconds, files and headline numbers, which pipeline/report.py reads.
"""

import argparse
import json
import os
import subprocess
import sys
import time
import tomllib
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TypeVar

import msgspec
import pandas as pd

from viscoroll import ViscorollError
from viscoroll.core.errors import FileError
from viscoroll.core.files import write_text

ROOT = Path(__file__).parents[1]
CONFIG = ROOT / "pipeline/config.toml"
T = TypeVar("T", bound=msgspec.Struct)
#: Values by the name of their column, and a section of a configuration, by key.
Row = dict[str, Any]
Sizes = dict[str, Any]


@dataclass
class Outcome:
    """What a stage made and found; ``failed`` if a stated tolerance is exceeded."""

    files: list[Path]
    headline: dict[str, float | int | str] = field(default_factory=dict)
    failed: bool = False


def read_toml(path: Path) -> Row:
    """Content of a TOML file.

    Raises
    ------
    FileError
        If it cannot be read or is not TOML.
    """
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise FileError(path, f"cannot be read ({error.strerror or error})") from error
    except ValueError as error:  # of tomllib and of UTF-8
        raise FileError(path, f"is not TOML ({error})") from error


def read_section(path: Path, name: str, kind: type[T]) -> T:
    """Section [name] of a TOML file as a ``kind``, a struct that forbids unknown fields.

    Raises
    ------
    FileError
        A file that cannot be read, is not TOML, lacks the section or a key, holds a misspelt key
        or a value of the wrong type.
    """
    content = read_toml(path)
    if name not in content:
        raise FileError(path, f"section [{name}] is missing")
    try:
        return msgspec.convert(content[name], kind)
    except msgspec.ValidationError as error:
        raise FileError(path, f"[{name}] {error}") from error


def make_folder(path: Path) -> Path:
    """``path``, made a folder if there is none.

    Raises
    ------
    FileError
        If it cannot be made.
    """
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise FileError(path, f"cannot be made a folder ({error.strerror or error})") from error
    return path


def plain_encoding(dataset) -> Row:
    """For ``write_dataset``, of a dataset that holds strings: those take neither compression nor
    checksums.
    """
    return {str(name): {"_FillValue": None} for name in dataset.variables}


def said(doc: str | None) -> argparse.ArgumentParser:
    """A parser whose --help is a docstring as it stands."""
    return argparse.ArgumentParser(description=doc, formatter_class=argparse.RawTextHelpFormatter)


def parser(doc: str | None) -> argparse.ArgumentParser:
    """Options of every stage."""
    result = said(doc)
    result.add_argument(
        "--config", type=Path, default=CONFIG, help=f"TOML file (default {CONFIG.name})"
    )
    result.add_argument(
        "-o", "--output", type=Path, default=ROOT / "out", help="folder (default out)"
    )
    return result


def finish(name: str, seconds: float, outcome: Outcome, out: Path) -> None:
    """Leave <out>/stages/<name>.json and print it; raises FileError."""
    record = {
        "stage": name,
        "seconds": round(seconds, 2),
        "failed": outcome.failed,
        "files": [os.path.relpath(path, out) for path in outcome.files],
        "headline": outcome.headline,
    }
    text = json.dumps(record, indent=1, ensure_ascii=False)
    write_text(make_folder(out / "stages") / f"{name}.json", f"{text}\n")
    print(f"{name}: {seconds:.1f} s; " + ", ".join(shown(path) for path in outcome.files))
    for line, value in outcome.headline.items():
        print(f"  {line}: {readable(value)}")


def told(name: str, work: Callable[[], int | None]) -> int:
    """Exit code of ``work()``, None being 0; an error is told in one line, exit code 2."""
    try:
        return work() or 0
    except (ViscorollError, OSError, json.JSONDecodeError, subprocess.CalledProcessError) as error:
        print(f"{name}: {error}", file=sys.stderr)
        return 2


def run(
    name: str, kind: type[T] | None, work: Callable[..., Outcome], doc: str | None, **folders: Path
) -> int:
    """Run a stage from the command line: 0 done, 1 a tolerance is exceeded, 2 an error in one line.

    ``work`` gets its settings, a ``kind`` (without one the path of the configuration), and the
    ``folders``, which options of their names change; without any, --output.
    """
    options = parser(doc)
    for option, folder in folders.items():
        options.add_argument(
            f"--{option}", type=Path, default=folder, help=f"default {shown(folder)}"
        )
    arguments = options.parse_args()

    def timed():
        settings = read_section(arguments.config, name, kind) if kind else arguments.config
        out = make_folder(arguments.output)
        start = time.perf_counter()
        outcome = work(settings, *(getattr(arguments, option) for option in folders or ["output"]))
        finish(name, time.perf_counter() - start, outcome, out)
        return int(outcome.failed)

    return told(name, timed)


def read_rows(path: Path) -> list[Row]:
    """Rows of a CSV file by the names of its columns, numbers where there are any."""

    def value(text):
        try:
            return float(text)
        except ValueError:
            return text

    return pd.read_csv(path, dtype=str, keep_default_na=False).map(value).to_dict("records")


def write_rows(path: Path, rows: list[dict[str, float]]) -> None:
    """Rows as CSV under the names of their columns; raises FileError."""
    write_text(path, pd.DataFrame(rows).to_csv(index=False, lineterminator="\n"))


def shown(path: Path) -> str:
    """A path as the user would type it, seen from where they are."""
    here = Path.cwd()
    return str(path.relative_to(here)) if path.is_relative_to(here) else str(path)


def readable(value) -> str:
    """A number with three significant digits, nothing for NaN, anything else as it is."""
    return ("" if value != value else f"{value:.3g}") if isinstance(value, float) else str(value)
