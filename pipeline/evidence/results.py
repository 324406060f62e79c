"""What the stages share whose results are kept in git: their options and sizes, the file, rows and
parts, and of which kernels they are.
"""

import argparse
import ast
import datetime
import hashlib
import json
import math
import platform
import sys
from collections.abc import Callable, Iterable, Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

import viscoroll
import viscoroll as vr
from viscoroll.core.arrays import available_cores
from viscoroll.core.errors import FileError
from viscoroll.core.files import write_text

from ..stage import ROOT, Row, Sizes, make_folder, read_toml, said, told
from . import timing

# --- of which kernels results are: a digest of what computes, which every file carries ---

KERNELS = Path(viscoroll.__file__).parent / "kernels"
#: digits of a digest in the text
SHORT = 8


@lru_cache(maxsize=1)
def kernels_digest(kernels: Path = KERNELS) -> str:
    """Hash of the syntax trees and of the coefficients below ``kernels``.

    It takes 0.3 s, as long as a first call from a full cache: what names the cache hashes the files
    as they are.
    """
    digest = hashlib.sha256()
    for path in sorted((*kernels.rglob("*.py"), *kernels.rglob("*.npy"))):
        content = path.read_bytes()
        if path.suffix == ".py":
            content = _plain(ast.parse(content)).encode()
        digest.update(path.relative_to(kernels).as_posix().encode() + b"\0" + content + b"\0")
    return digest.hexdigest()[:16]


def _plain(node):
    """A syntax tree as text, the same in every version of Python; expressions that are constants
    alone, docstrings say, are left out, and fields that hold nothing, of which later versions have
    more.
    """
    if isinstance(node, ast.AST):
        fields = (
            f"{name}={_plain(value)}"
            for name, value in ast.iter_fields(node)
            if value not in (None, [])
        )
        return f"{type(node).__name__}({','.join(fields)})"
    if isinstance(node, list):
        bare = (
            each
            for each in node
            if not (isinstance(each, ast.Expr) and isinstance(each.value, ast.Constant))
        )
        return f"[{','.join(map(_plain, bare))}]"
    return repr(node)


def stamps(found, name: str) -> dict[str, str]:
    """Part of a result -> digest of the kernels it is of; "unknown" where a result says none."""
    return dict(_stamps(found, name)) or {name: "unknown"}


def _stamps(found, name):
    if not isinstance(found, dict):
        return
    if "kernels" in found:
        yield name, found["kernels"]
    for key, value in found.items():
        yield from _stamps(value, name if key in ("machine", "parts") else f"{name} {key}")


def outdated(folder: Path) -> dict[str, list[str]]:
    """Results in ``folder`` of other kernels than this tree's -> the digests of those."""
    found = {}
    for path in sorted(folder.glob("*.json")):
        content = json.loads(path.read_text(encoding="utf-8"))
        if others := {*stamps(content, path.stem).values()} - {kernels_digest()}:
            found[path.name] = sorted(others)
    return found


# --- options, sizes, files ---

#: folder of the results
RESULTS = ROOT / "data/results"
SIZES = ROOT / "pipeline/evidence/sizes.toml"


#: name -> what measures that part of a stage: rows, or a dict that holds them, from the sizes
Parts = Mapping[str, Callable[[Sizes], Any]]


def parser(
    doc: str | None, output: Path, *, sizes: bool = True, parts: Parts | None = None
) -> argparse.ArgumentParser:
    """-o; where there are sizes to choose, --config and --quick; where there are parts, --only."""
    result = said(doc)
    if sizes:
        result.add_argument("--config", type=Path, default=SIZES, help="TOML file with the sizes")
        result.add_argument(
            "--quick", action="store_true", help="the sizes of a test: does it run?"
        )
    if parts:
        result.add_argument("--only", nargs="+", choices=parts, help="renew these parts alone")
    result.add_argument("-o", "--output", type=Path, default=output)
    return result


def run(
    name: str,
    work: Callable[..., Row],
    doc: str | None,
    file: str | None = None,
    *,
    sizes: bool = True,
) -> int:
    """Run a stage from the command line: what ``work`` finds, and the machine, into -o,
    data/results/``file``.
    """
    arguments = parser(doc, RESULTS / (file or f"{name}.json"), sizes=sizes).parse_args()

    def measured():
        output = arguments.output.resolve()
        found = work(*([read_sizes(arguments.config, name, arguments.quick)] if sizes else []))
        write_results(output, found | {"machine": machine()})
        print(f"{output}: written; now run pipeline.evidence.document")

    return told(name, measured)


def run_parts(
    name: str,
    parts: Parts,
    doc: str | None,
    file: str,
    complaint: Callable[[Sizes], str | None] = lambda _: None,
) -> int:
    """Run a stage of ``parts``: what each finds, its sizes and the machine, beside the parts
    that -o has already.

    Sizes are those of the part, [name.part], or of all, [name].  Exit code 1 if there is a
    ``complaint`` about a row.
    """
    arguments = parser(doc, RESULTS / file, parts=parts).parse_args()
    output = arguments.output

    def measured():
        sizes = read_sizes(arguments.config, name, arguments.quick)
        before = json.loads(output.read_text(encoding="utf-8"))["parts"] if output.exists() else {}
        found = {part: before[part] for part in parts if part in before}
        for part in arguments.only or parts:
            own = sizes[part] if isinstance(sizes.get(part), dict) else sizes
            made = parts[part](own)
            found[part] = (made if isinstance(made, dict) else {"rows": made}) | {
                "sizes": own,
                "machine": machine(),
            }
            write_results(output, {"parts": found})
        rows = rows_of(found)
        complaints = [text for row in rows if (text := complaint(row))]
        for text in complaints:
            print(f"{name}: {text}", file=sys.stderr)
        print(f"{output}: {len(rows)} rows, {len(complaints)} of them bad")
        return int(bool(complaints))

    return told(name, measured)


class Results(Row):
    """What stages have left, by the name of the file, or "file part", from the first of the folders
    that has it.
    """

    def __init__(self, *folders: Path) -> None:
        super().__init__()
        self.folders = folders

    def __missing__(self, name: str):
        file, _, part = name.partition(" ")
        for folder in self.folders:
            if (path := folder / f"{file}.json").exists():
                found = json.loads(path.read_text(encoding="utf-8"))
                self[name] = found["parts"][part] if part else found
                return self[name]
        raise KeyError(f"{file}.json")


def rows_of(parts: dict[str, Row]) -> list[Row]:
    """The rows of all parts, one part after the other."""
    return [row for part in parts.values() for row in part["rows"]]


def table(head: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    """A Markdown table."""
    head = list(head)
    return "".join("| " + " | ".join(line) + " |\n" for line in (head, ["---"] * len(head), *rows))


def read_sizes(path: Path, name: str, quick: bool) -> Row:
    """Section [name] of the configuration, with its [quick] over it if asked, and those of its
    parts over theirs.

    Raises
    ------
    FileError
        A file that cannot be read, is not TOML, or lacks the section.
    """
    try:
        section = read_toml(path)[name]
    except KeyError as error:
        raise FileError(path, f"section [{name}] is missing") from error
    if quick:
        timing.shortest = 0.0
    return _sized(section, quick)


def _sized(section, quick):
    small = section.get("quick", {}) if quick else {}
    parts = {
        key: _sized(each, quick)
        for key, each in section.items()
        if isinstance(each, dict) and "quick" in each
    }
    return {key: value for key, value in (section | parts | small).items() if key != "quick"}


def write_results(path: Path, results) -> None:
    """``results`` as JSON; floats as :func:`rounded`."""
    make_folder(path.parent)
    text = json.dumps(rounded(results), indent=1, ensure_ascii=False, allow_nan=False)
    write_text(path, f"{text}\n")


def rounded(value):
    """Every float to three significant digits: more would be noise in the history; None for inf and
    NaN, as in JSON.
    """
    if isinstance(value, dict):
        return {str(key): rounded(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [rounded(item) for item in value]
    if not isinstance(value, float):
        return value
    return float(f"{value:.3g}") if math.isfinite(value) else None


def _caches():
    """Return the sizes of the caches of one core as Linux states them, {"L2 Unified": "1024K"};
    empty elsewhere.
    """
    found = {}
    for index in sorted(Path("/sys/devices/system/cpu/cpu0/cache").glob("index*")):
        level, kind, size = (
            (index / name).read_text(encoding="ascii").strip() for name in ("level", "type", "size")
        )
        found[f"L{level} {kind}"] = size
    return found


def machine() -> Row:
    """Where and when, and with what, this was measured."""
    import numba

    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
        cpu = next(line.split(":", 1)[1].strip() for line in lines if line.startswith("model name"))
    except (OSError, StopIteration):
        cpu = platform.processor() or platform.machine()
    return {
        "cpu": cpu,
        "caches": _caches(),
        "cores": available_cores(),
        "system": platform.system(),
        "python": platform.python_version(),
        "numpy": np.__version__,
        "numba": numba.__version__,
        "viscoroll": vr.__version__,
        "kernels": kernels_digest(),
        "date": datetime.datetime.now(datetime.UTC).date().isoformat(),
    }
