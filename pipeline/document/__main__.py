"""Put measured numbers into the text: data/results/ -> marked blocks of README.md and docs/.

    python -m pipeline.document [--check] [--results FILE] [FILE ...]

A block is what stands between <!-- measured:NAME --> and <!-- end -->; NAME is a key of BLOCKS.
Nothing else is touched, and a second run changes nothing.  With --check nothing is written: exit code 1
if a block is out of date.  Exit code 2 for results that are missing or incomplete, and for broken marks.
"""

from __future__ import annotations

import argparse
import json
import re
import sys
from pathlib import Path
from typing import Any

from viscoroll import ViscorollError
from viscoroll.files import write_text

from ..stage import ROOT
from . import bench as report
from .tables import BLOCKS

RESULTS = ROOT / "data/results/measured.json"
#: results of other stages: file of data/results and the stage that makes it, by name
OTHERS = {
    "proofs": "prove", "independent": "prove.independent", "large": "measure.large", "loading": "measure.loading",
    "torture": "torture", "ensembles": "measure.ensembles",
}  # fmt: skip
DOCUMENTS = (
    ROOT / "README.md", ROOT / "docs/accuracy.md", ROOT / "docs/benchmark.md", ROOT / "docs/design.md",
    ROOT / "docs/loading/README.md", ROOT / "docs/ensembles.md",
)  # fmt: skip
_BLOCK = re.compile(r"(<!-- measured:(\w+) -->\n).*?(<!-- end -->)", re.DOTALL)
_MARK = re.compile(r"<!-- (?:measured:\w+|end) -->")


class DocumentError(ViscorollError):
    """Results that are missing or incomplete, or marks that do not pair."""


def filled(text: str, measured: dict[str, Any], folder: Path, name: str) -> str:
    """``text`` with every block filled, those of the benchmark from its files in ``folder``.

    Raises
    ------
    DocumentError
        Marks that do not pair, an unknown block, or results that lack a number.
    """

    def fill(match: re.Match[str]) -> str:
        try:
            if match[2] in report.BLOCKS:
                return f"{match[1]}{report.BLOCKS[match[2]](folder)}{match[3]}"
            return f"{match[1]}{BLOCKS[match[2]](measured)}{match[3]}"
        except (KeyError, TypeError) as error:
            if match[2] not in BLOCKS | report.BLOCKS:
                names = ", ".join([*BLOCKS, *report.BLOCKS])
                raise DocumentError(f"{name}: unknown block {match[2]!r}: must be one of {names}") from error
            stage = OTHERS.get(match[2].partition("_")[0], "measure") if match[2] in BLOCKS else "bench"
            raise DocumentError(f"results lack {error} for block {match[2]!r}: run pipeline.{stage}") from error

    result, count = _BLOCK.subn(fill, text)
    if len(_MARK.findall(text)) != 2 * count:
        raise DocumentError(f"{name}: a mark <!-- measured:NAME --> or <!-- end --> has no partner")
    return result


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--check", action="store_true", help="write nothing; exit code 1 if a block is out of date")
    parser.add_argument("--results", type=Path, default=RESULTS)
    parser.add_argument("files", nargs="*", type=Path, default=DOCUMENTS, metavar="FILE")
    arguments = parser.parse_args()
    stale = []
    try:
        measured = json.loads(arguments.results.read_text(encoding="utf-8"))
        for name in OTHERS:
            measured[name] = json.loads((ROOT / f"data/results/{name}.json").read_text(encoding="utf-8"))
        for path in arguments.files:
            old = path.read_text(encoding="utf-8")
            new = filled(old, measured, arguments.results.parent, path.name)
            if new != old:
                stale.append(path.name)
                if not arguments.check:
                    write_text(path, new)
    except (ViscorollError, OSError, ValueError) as error:
        print(f"document: {error}", file=sys.stderr)
        return 2
    if stale:
        print(f"{', '.join(stale)}: {'out of date: run pipeline.document' if arguments.check else 'filled'}")
    return 1 if stale and arguments.check else 0


if __name__ == "__main__":
    sys.exit(main())
