"""Run time against error, beside what people would use instead -> data/results/bench-PART.json, docs/figures/.

    python pipeline/benchmark.py [PART ...] [--config FILE] [--smoke] [-o FOLDER] [--figures FOLDER]

Parts: work-precision, own-parameters, fixed-scene, agreement, law, tables, scaling, cold-start, skips;
default: all.  Sizes are in [bench] of the configuration, those of --smoke in [bench.smoke].  Times are of
this machine at this moment, medians of alternating runs on one core: run it with nothing else running.  A
peer that is not installed is skipped with a printed reason (pipeline/peers/README.md).
"""

from __future__ import annotations

import argparse
import json
import math
import os
import shutil
import subprocess
import sys
import time
import tomllib
from importlib import import_module
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

from bench import report
from measure import machine, rounded

import viscoroll as vr
from viscoroll.errors import ConfigError
from viscoroll.files import write_text

ROOT = Path(__file__).parents[1]
PARTS = {
    "work-precision": ("work_precision", "work_precision"),
    "own-parameters": ("work_precision", "own_parameters"),
    "fixed-scene": ("fixed_scene", "fixed_scene"),
    "agreement": ("fixed_scene", "agreement"),
    "law": ("law", "law"),
    "tables": ("tables", "tables"),
    "scaling": ("scaling", "scaling"),
    "cold-start": ("cold_start", "cold_start"),
    "skips": ("skips", "skips"),
}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("parts", nargs="*", metavar="PART", help=f"out of {', '.join(PARTS)}")
    parser.add_argument("--config", type=Path, default=ROOT / "pipeline/config/production.toml")
    parser.add_argument("--smoke", action="store_true", help="a few states and motions: does it run?")
    parser.add_argument("-o", "--output", type=Path, default=ROOT / "data/results", help="folder of the results")
    parser.add_argument("--figures", type=Path, default=ROOT / "docs/figures", help="folder of the figures")
    arguments = parser.parse_args()
    chosen = arguments.parts or list(PARTS)
    if unknown := set(chosen) - PARTS.keys():
        parser.error(f"unknown part {', '.join(sorted(unknown))}: must be out of {', '.join(PARTS)}")
    os.environ["VISCOROLL_THREADS"] = "1"  # every time is that of one core, where it does not say otherwise
    try:
        for part in chosen:
            run_part(part, read_sizes(arguments.config, part, arguments.smoke), arguments.output)
        from bench_figures import draw

        draw(arguments.output, arguments.figures)
    except (vr.ViscorollError, OSError) as error:
        print(f"benchmark: {error}", file=sys.stderr)
        return 1
    print(report.headline(arguments.output))
    return 0


def run_part(part: str, sizes: dict[str, Any], folder: Path) -> None:
    """Measure one part and write its results."""
    module, name = PARTS[part]
    start = time.perf_counter()
    measured = getattr(import_module(f"bench.{module}"), name)(sizes)
    result = {"part": part, "measured": measured, "sizes": sizes, "machine": machine() | tools()}
    path = folder / f"bench-{part}.json"
    folder.mkdir(parents=True, exist_ok=True)
    write_text(path, json.dumps(finite(rounded(result)), indent=1, ensure_ascii=False, allow_nan=False) + "\n")
    print(f"{path}: written, {time.perf_counter() - start:.0f} s")


def read_sizes(path: Path, part: str, smoke: bool) -> dict[str, Any]:
    """[bench.PART] of the configuration, with [bench.smoke.PART] over it if asked.

    Raises
    ------
    ConfigError
        A file that cannot be read, is not TOML, or lacks the section.
    """
    name = part.replace("-", "_")
    try:
        section = tomllib.loads(path.read_text(encoding="utf-8"))["bench"]
        return section[name] | (section["smoke"][name] if smoke else {})
    except OSError as error:
        raise ConfigError(path, f"cannot be read ({error.strerror})") from error
    except (UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise ConfigError(path, f"is not TOML ({error})") from error
    except KeyError as error:
        raise ConfigError(path, f"section [bench] or its key {error} is missing") from error


def tools() -> dict[str, str]:
    """Versions of what the peers are built with; those that are not there are left out."""
    found = {}
    for name in ("scipy", "numbalsoda"):
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            continue
    commands = {"cc": ("cc", "-dumpfullversion"), "gsl": ("pkg-config", "--modversion", "gsl")}
    for name, command in commands.items():
        if shutil.which(command[0]):
            result = subprocess.run(command, check=False, capture_output=True, text=True)
            if result.returncode == 0:
                found[name] = result.stdout.strip()
    return found


def finite(value: Any) -> Any:
    """The same with None for what JSON has no word for."""
    if isinstance(value, dict):
        return {key: finite(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [finite(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


if __name__ == "__main__":
    sys.exit(main())
