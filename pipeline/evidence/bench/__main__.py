"""Run time against error, beside what people would use instead -> data/results/bench-PART.json, docs/figures/.

    python -m pipeline.evidence.bench [PART ...] [--config FILE] [--quick] [-o FOLDER] [--figures FOLDER]

Parts: work-precision, own-parameters, fixed-scene, bound-law, series, first-calls, driven, last-release;
default: all.  Sizes are in [bench] of the configuration, those of --quick in
[bench.PART.quick].
Times are of this machine at this moment, medians of alternating runs on one core: run it with nothing else running.
A peer that is not installed is skipped with a printed reason (pipeline/evidence/peers/README.md).
"""

from __future__ import annotations

import os
import subprocess
import sys
import time
from importlib import import_module
from importlib.metadata import version
from importlib.util import find_spec
from pathlib import Path

from ...stage import ROOT, told
from .. import timing
from ..document.blocks import bench_peers
from ..results import RESULTS, Results, machine, parser, read_sizes, write_results

#: module -> its functions, each a part
MODULES = {
    "motions": ("work_precision", "own_parameters", "driven"),
    "calls": ("fixed_scene", "bound_law", "series"),
    "processes": ("first_calls", "last_release"),
}
PARTS = {part.replace("_", "-"): (module, part) for module, parts in MODULES.items() for part in parts}


def main() -> int:
    options = parser(__doc__, RESULTS)
    options.add_argument("parts", nargs="*", metavar="PART", help=f"out of {', '.join(PARTS)}")
    options.add_argument("--figures", type=Path, default=ROOT / "docs/figures", help="folder of the figures")
    arguments = options.parse_args()
    if unknown := set(arguments.parts) - PARTS.keys():
        options.error(f"unknown part {', '.join(sorted(unknown))}; choose from {', '.join(PARTS)}")

    def work() -> None:
        for part in arguments.parts or PARTS:
            module, name = PARTS[part]
            sizes, start = read_sizes(arguments.config, f"bench.{name}", arguments.quick), time.perf_counter()
            measured = getattr(import_module(f"pipeline.evidence.bench.{module}"), name)(sizes)
            result = {"part": part, "measured": measured, "sizes": sizes, "machine": machine() | tools()}
            path = arguments.output / f"bench-{part}.json"
            write_results(path, result, ordered=False)  # in the order of the figures
            print(f"{path}: written, {time.perf_counter() - start:.0f} s")
        from .figures import draw

        draw(arguments.output, arguments.figures)
        print(bench_peers(Results(arguments.output)))

    if arguments.quick:
        timing.shortest = 0.0
    os.environ["VISCOROLL_THREADS"] = "1"  # every time is that of one core, where it does not say otherwise
    return told("benchmark", work)


def tools() -> dict[str, str]:
    """Versions of what the peers are built with; those that are not there are left out."""
    found = {name: version(name) for name in ("scipy", "numbalsoda") if find_spec(name)}
    for name, command in {"cc": "cc -dumpfullversion", "gsl": "pkg-config --modversion gsl"}.items():
        done = subprocess.run(command, shell=True, check=False, capture_output=True, text=True)
        found |= {} if done.returncode else {name: done.stdout.strip()}
    return found


if __name__ == "__main__":
    sys.exit(main())
