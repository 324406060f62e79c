"""Put measured numbers into the text: data/results/ -> marked blocks of README.md and docs/.

    python -m pipeline.evidence.document [--check] [--results FOLDER] [FILE ...]

A block is what stands between <!-- measured:NAME --> and <!-- end -->; NAME is a block of STAGES.
Below its numbers it says of which kernels they are, where not of those of this tree.
Nothing else is touched, and a second run changes nothing.  With --check nothing is written: exit code 1
if a block is out of date.  Exit code 2 for results that are missing or incomplete, and for broken marks.
"""

from __future__ import annotations

import argparse
import re
import sys
from collections.abc import Callable
from pathlib import Path

from viscoroll import ViscorollError
from viscoroll.files import write_text

from ...stage import ROOT, told
from ..results import RESULTS, Results
from ..stamps import SHORT, kernels_digest, stamps
from . import bench, ensembles, identification, symbols, tables, unsteady

#: who measures what a block shows
STAGES: dict[str, dict[str, Callable[[Results], str]]] = {
    "measure": {
        "headline": tables.headline, "three": tables.three, "contact": tables.contact, "direct": tables.direct,
        "stress": tables.stress, "motion": tables.motion, "times": tables.times,
    },
    "document": {"symbols": symbols.symbols},
    "measure.large": {"large": tables.large},
    "measure.outside": {"page": tables.page, "outside": tables.outside},
    "measure.ensembles": {
        "ensembles": ensembles.rates, "ensembles_cluster": ensembles.cluster, "ensembles_plan": ensembles.plan,
    },
    "measure.identification": {
        "identify_learn": identification.learn, "identify_bearing": identification.bearing,
        "identify_said": identification.said, "identify_times": identification.times,
        "identify_coverage": identification.coverage, "identify_reach": identification.reach,
    },
    "prove": {"proofs": tables.proofs},
    "prove.independent": {"independent": tables.independent, "independent_paper": tables.paper},
    "prove.unsteady": {
        "unsteady_gamma": unsteady.over_gamma, "unsteady": unsteady.errors, "unsteady_ways": unsteady.ways,
    },
    "torture": {"torture": tables.torture},
    "bench": {
        "bench_peers": bench.peers, "bench_fixed_scene": bench.fixed_scene,
        "bench_own": bench.own_parameters, "bench_agreement": bench.agreement, "bench_law": bench.law,
        "bench_bound_law": bench.bound_law,
        "bench_scaling": bench.scaling, "bench_skips": bench.skips, "bench_cold_start": bench.cold_start,
        "bench_first_calls": bench.first_calls, "bench_series": bench.series, "bench_driven": bench.driven,
        "bench_last_release": bench.last_release,
    },
}  # fmt: skip
BLOCKS = {name: (stage, text) for stage, texts in STAGES.items() for name, text in texts.items()}
DOCUMENTS = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
_BLOCK = re.compile(r"(<!-- measured:(\w+) -->\n).*?(<!-- end -->)", re.DOTALL)
_MARK = re.compile(r"<!-- (?:measured:\w+|end) -->")


class DocumentError(ViscorollError):
    """Results that are missing or incomplete, or marks that do not pair."""


def filled(text: str, folders: list[Path], name: str) -> str:
    """``text`` of the page ``name`` with every block filled, from the first of ``folders`` that has the results.

    Raises
    ------
    DocumentError
        Marks that do not pair, an unknown block, or results that lack a number.
    """

    def fill(match: re.Match[str]) -> str:
        if match[2] not in BLOCKS:
            raise DocumentError(f"{name}: unknown block {match[2]!r}: must be one of {', '.join(BLOCKS)}")
        stage, block = BLOCKS[match[2]]
        results = Results(*folders)
        try:
            return f"{match[1]}{block(results)}{provenance(results)}{match[3]}"
        except (KeyError, TypeError) as error:
            raise DocumentError(f"results lack {error} for block {match[2]!r}: run pipeline.{stage}") from error

    result, count = _BLOCK.subn(fill, text)
    if len(_MARK.findall(text)) != 2 * count:
        raise DocumentError(f"{name}: a mark <!-- measured:NAME --> or <!-- end --> has no partner")
    return result


def provenance(results: Results) -> str:
    """A sentence on the kernels of all that was read of ``results``, if any are not those of this tree."""
    read = {part: digest for name, found in results.items() for part, digest in stamps(found, name).items()}
    others: dict[str, list[str]] = {}
    for part, digest in read.items():
        if digest != kernels_digest():
            others.setdefault(digest[:SHORT], []).append(part)
    if not others:
        return ""
    alone = len(set(read.values())) == 1
    named = (f"`{digest}`" + ("" if alone else f" ({', '.join(parts)})") for digest, parts in others.items())
    return f"\nMeasured at kernels {' and '.join(named)}, not those of this version.\n"


def document(files: list[Path], results: Path, check: bool) -> int:
    """Fill the blocks of ``files``, or only see whether they are up to date: 1 if they are not."""
    if not results.is_dir():
        raise DocumentError(f"{results}: no folder of results")
    stale = []
    for path in files:
        old = path.read_text(encoding="utf-8")
        new = filled(old, [results, RESULTS], path.name)
        if new != old:
            stale.append(path.name)
            if not check:
                write_text(path, new)
    if stale:
        print(f"{', '.join(stale)}: {'out of date: run pipeline.evidence.document' if check else 'filled'}")
    return int(check and bool(stale))


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--check", action="store_true", help="write nothing; exit code 1 if a block is out of date")
    parser.add_argument(
        "--results", type=Path, default=RESULTS, metavar="FOLDER", help="results that go before data/results"
    )
    parser.add_argument("files", nargs="*", type=Path, default=DOCUMENTS, metavar="FILE")
    arguments = parser.parse_args()
    return told("document", lambda: document(arguments.files, arguments.results, arguments.check))


if __name__ == "__main__":
    sys.exit(main())
