"""What the stages share whose results are kept in git: their options and sizes, the file, errors in one line."""

from __future__ import annotations

import argparse
import datetime
import json
import math
import os
import platform
import subprocess
import sys
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from stage import CONFIG, ROOT, read_toml

import viscoroll as vr
from viscoroll.errors import ConfigError, ViscorollError
from viscoroll.files import write_text

#: folder of the results
RESULTS = ROOT / "data/results"


#: name -> what measures that part of a stage: rows, from the sizes
Parts = Mapping[str, Callable[[dict[str, Any]], list[dict[str, Any]]]]


def parser(doc: str | None, output: Path, *, sizes: bool = True, parts: Parts | None = None) -> argparse.ArgumentParser:
    """-o; where there are sizes to choose, --config and --quick; where there are parts, --only."""
    result = argparse.ArgumentParser(description=doc, formatter_class=argparse.RawTextHelpFormatter)
    if sizes:
        result.add_argument("--config", type=Path, default=CONFIG, help="TOML file with the sizes")
        result.add_argument("--quick", action="store_true", help="the sizes of a test: does it run?")
    if parts:
        result.add_argument("--only", choices=parts, help="renew one part in a file that has the others")
    result.add_argument("-o", "--output", type=Path, default=output)
    return result


def run_parts(parts: Parts, sizes: dict[str, Any], only: str | None, output: Path) -> dict[str, dict[str, Any]]:
    """Rows, sizes and machine of every part; with ``only``, of that one beside the others that ``output`` has."""
    known = json.loads(output.read_text(encoding="utf-8"))["parts"] if only and output.exists() else {}
    return known | {
        name: {"rows": rows(sizes), "sizes": sizes, "machine": machine()}
        for name, rows in parts.items()
        if only in (None, name)
    }


def rows_of(parts: dict[str, dict[str, Any]]) -> list[dict[str, Any]]:
    """The rows of all parts, one part after the other."""
    return [row for part in parts.values() for row in part["rows"]]


def table(head: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    """A Markdown table."""
    head = list(head)
    return "".join("| " + " | ".join(line) + " |\n" for line in (head, ["---"] * len(head), *rows))


def read_sizes(path: Path, name: str, quick: bool) -> dict[str, Any]:
    """Section [name] of the configuration ("bench.law" lies in [bench]), with its [quick] over it if asked.

    Raises
    ------
    ConfigError
        A file that cannot be read, is not TOML, or lacks the section.
    """
    section = read_toml(path)
    try:
        for key in name.split("."):
            section = section[key]
        sizes = section | section["quick"] if quick else section
    except KeyError as error:
        raise ConfigError(path, f"section [{name}] or its key {error} is missing") from error
    return {key: value for key, value in sizes.items() if key != "quick"}


def write_results(path: Path, results: Any, *, ordered: bool = True) -> None:
    """``results`` as JSON, keys sorted if ``ordered``; floats as :func:`rounded`."""
    path.parent.mkdir(parents=True, exist_ok=True)
    text = json.dumps(rounded(results), indent=1, sort_keys=ordered, ensure_ascii=False, allow_nan=False)
    write_text(path, f"{text}\n")


def rounded(value: Any) -> Any:
    """Every float to three significant digits: more would be noise in the history; None for inf and NaN, as in JSON."""
    if isinstance(value, dict):
        return {str(key): rounded(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [rounded(item) for item in value]
    if not isinstance(value, float):
        return value
    return float(f"{value:.3g}") if math.isfinite(value) else None


def told(name: str, work: Callable[[], int | None]) -> int:
    """Exit code of ``work()``, None being 0; an error is told in one line, exit code 2."""
    try:
        return work() or 0
    except (ViscorollError, OSError, json.JSONDecodeError, subprocess.CalledProcessError) as error:
        print(f"{name}: {error}", file=sys.stderr)
        return 2


def machine() -> dict[str, Any]:
    """Where and when, and with what, this was measured; ``kernels`` is the hash of their sources."""
    import numba

    from viscoroll.kernels.compile.cache import sources_digest

    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
        cpu = next(line.split(":", 1)[1].strip() for line in lines if line.startswith("model name"))
    except (OSError, StopIteration):
        cpu = platform.processor() or platform.machine()
    return {
        "cpu": cpu,
        "cores": len(os.sched_getaffinity(0)),
        "system": platform.system(),
        "python": platform.python_version(),
        "numpy": np.__version__,
        "numba": numba.__version__,
        "viscoroll": vr.__version__,
        "kernels": sources_digest(),
        "date": datetime.datetime.now(datetime.UTC).date().isoformat(),
    }
