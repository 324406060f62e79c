"""What the stages share: options, their section of the configuration, timing, and a record of what they found.

A stage is a function work(settings, out) -> Outcome.  :func:`run` calls it and leaves
<out>/stages/<name>.json: seconds, files and headline numbers, which pipeline/demo/summary.py reads.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
import time
import tomllib
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import msgspec

from viscoroll import ViscorollError
from viscoroll.errors import ConfigError, OutputError
from viscoroll.files import write_text

if TYPE_CHECKING:
    import xarray as xr

ROOT = Path(__file__).parents[1]
CONFIG = ROOT / "pipeline/config/production.toml"
T = TypeVar("T", bound=msgspec.Struct)


@dataclass
class Outcome:
    """What a stage made and found; ``failed`` if a stated tolerance is exceeded."""

    files: list[Path]
    headline: dict[str, float | int | str] = field(default_factory=dict)
    failed: bool = False


def read_toml(path: Path) -> dict[str, Any]:
    """Content of a TOML file.

    Raises
    ------
    ConfigError
        If it cannot be read or is not TOML.
    """
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise ConfigError(path, f"cannot be read ({error.strerror or error})") from error
    except ValueError as error:  # of tomllib and of UTF-8
        raise ConfigError(path, f"is not TOML ({error})") from error


def read_section(path: Path, name: str, kind: type[T]) -> T:
    """Section [name] of a TOML file as a ``kind``, a struct that forbids unknown fields.

    Raises
    ------
    ConfigError
        A file that cannot be read, is not TOML, lacks the section or a key, holds a misspelt key
        or a value of the wrong type.
    """
    content = read_toml(path)
    if name not in content:
        raise ConfigError(path, f"section [{name}] is missing")
    try:
        return msgspec.convert(content[name], kind)
    except msgspec.ValidationError as error:
        raise ConfigError(path, f"[{name}] {error}") from error


def make_folder(path: Path) -> Path:
    """``path``, made a folder if there is none.

    Raises
    ------
    OutputError
        If it cannot be made.
    """
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(path, f"cannot be made a folder ({error.strerror or error})") from error
    return path


def plain_encoding(dataset: xr.Dataset) -> dict[str, Any]:
    """For ``write_dataset``, of a dataset that holds strings: those take neither compression nor checksums."""
    return {str(name): {"_FillValue": None} for name in dataset.variables}


def parser(doc: str | None) -> argparse.ArgumentParser:
    """Options of every stage."""
    result = argparse.ArgumentParser(description=doc, formatter_class=argparse.RawTextHelpFormatter)
    result.add_argument("--config", type=Path, default=CONFIG, help="TOML file (default config/production.toml)")
    result.add_argument("-o", "--output", type=Path, default=ROOT / "out", help="folder (default out)")
    return result


def finish(name: str, seconds: float, outcome: Outcome, out: Path) -> None:
    """Leave <out>/stages/<name>.json and print it; raises OutputError."""
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


def run(
    name: str, kind: type[T], work: Callable[[T, Path], Outcome], doc: str | None, folder: Path | None = None
) -> int:
    """Run a stage from the command line: 0 done, 1 a tolerance is exceeded, 2 an error in one line.

    ``work`` writes to --output, or where there is a ``folder`` for what is kept in git, to that or --folder.
    """
    options = parser(doc)
    if folder is not None:
        options.add_argument("--folder", type=Path, default=folder, help=f"default {shown(folder)}")
    arguments = options.parse_args()
    try:
        settings = read_section(arguments.config, name, kind)
        out = make_folder(arguments.output)
        start = time.perf_counter()
        outcome = work(settings, out if folder is None else make_folder(arguments.folder))
        finish(name, time.perf_counter() - start, outcome, out)
    except ViscorollError as error:
        print(f"{name}: {error}", file=sys.stderr)
        return 2
    return 1 if outcome.failed else 0


def shown(path: Path) -> str:
    """A path as the user would type it, seen from where they are."""
    here = Path.cwd()
    return str(path.relative_to(here)) if path.is_relative_to(here) else str(path)


def readable(value: Any) -> str:
    """A number with three significant digits, anything else as it is."""
    return f"{value:.3g}" if isinstance(value, float) else str(value)
