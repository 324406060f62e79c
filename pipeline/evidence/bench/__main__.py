"""Run time against error, beside what people would use instead -> data/results/bench-PART.json, docs/figures/.

    python -m pipeline.evidence.bench [PART ...] [--config FILE] [--quick] [-o FOLDER] [--figures FOLDER]

Parts: work-precision, own-parameters, fixed-scene, agreement, law, bound-law, tables, scaling, cold-start, first-calls,
skips, series, driven, last-release; default: all.  Sizes are in [bench] of the configuration, those of --quick in
[bench.PART.quick].
Times are of this machine at this moment, medians of alternating runs on one core: run it with nothing else running.
A peer that is not installed is skipped with a printed reason (pipeline/evidence/peers/README.md).
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import time
from importlib import import_module
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

from ...stage import ROOT, told
from .. import timing
from ..document import bench as report
from ..results import RESULTS, Results, machine, parser, read_sizes, write_results

PARTS = {
    "work-precision": ("work_precision", "work_precision"),
    "own-parameters": ("work_precision", "own_parameters"),
    "fixed-scene": ("fixed_scene", "fixed_scene"),
    "agreement": ("fixed_scene", "agreement"),
    "law": ("law", "law"),
    "bound-law": ("bound_law", "bound_law"),
    "tables": ("tables", "tables"),
    "scaling": ("scaling", "scaling"),
    "cold-start": ("cold_start", "cold_start"),
    "first-calls": ("cold_start", "first_calls"),
    "skips": ("skips", "skips"),
    "series": ("series", "series"),
    "driven": ("driven", "driven"),
    "last-release": ("last_release", "last_release"),
}


def main() -> int:
    options = parser(__doc__, RESULTS)
    options.add_argument("parts", nargs="*", metavar="PART", help=f"out of {', '.join(PARTS)}")
    options.add_argument("--figures", type=Path, default=ROOT / "docs/figures", help="folder of the figures")
    arguments = options.parse_args()
    chosen = arguments.parts or list(PARTS)
    if unknown := set(chosen) - PARTS.keys():
        options.error(f"unknown part {', '.join(sorted(unknown))}; choose from {', '.join(PARTS)}")

    def work() -> None:
        for part in chosen:
            run_part(part, read_sizes(arguments.config, section_of(part), arguments.quick), arguments.output)
        from .figures import draw

        draw(arguments.output, arguments.figures)
        print(report.peers(Results(arguments.output)))

    if arguments.quick:
        timing.shortest = 0.0
    os.environ["VISCOROLL_THREADS"] = "1"  # every time is that of one core, where it does not say otherwise
    return told("benchmark", work)


def section_of(part: str) -> str:
    """The part's section of the configuration."""
    return f"bench.{part.replace('-', '_')}"


def run_part(part: str, sizes: dict[str, Any], folder: Path) -> None:
    """Measure one part and write its results."""
    module, name = PARTS[part]
    start = time.perf_counter()
    measured = getattr(import_module(f"pipeline.evidence.bench.{module}"), name)(sizes)
    result = {"part": part, "measured": measured, "sizes": sizes, "machine": machine() | tools()}
    path = folder / f"bench-{part}.json"
    write_results(path, result, ordered=False)  # in the order of the figures
    print(f"{path}: written, {time.perf_counter() - start:.0f} s")


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


if __name__ == "__main__":
    sys.exit(main())
