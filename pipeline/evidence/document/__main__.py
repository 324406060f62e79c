"""Put measured numbers into the text: data/results/ -> marked blocks of README.md and docs/.

    python -m pipeline.evidence.document [--check] [--results FOLDER] [FILE ...]

A block is what stands between <!-- measured:NAME --> and <!-- end -->; NAME is one of BLOCKS.
Below its numbers it says of which kernels they are, where not of those of this tree.
Nothing else is touched, and a second run changes nothing.  With --check nothing is written: exit
code 1 if a block is out of date.  Exit code 2 for results that are missing or incomplete, and for
broken marks.
"""

import re
import sys
from pathlib import Path

from viscoroll import ViscorollError
from viscoroll.core.files import write_text

from ...stage import ROOT, said, told
from ..results import RESULTS, SHORT, Results, kernels_digest, stamps
from .blocks import BLOCKS, block

#: Its table of costs follows every change of code: it is filled, but --check does not compare it.
CONTRIBUTING = ROOT / "CONTRIBUTING.md"
DOCUMENTS = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
_BLOCK = re.compile(r"(<!-- measured:(\w+) -->\n).*?(<!-- end -->)", re.DOTALL)
_MARK = re.compile(r"<!-- (?:measured:\w+|end) -->")
#: Parts of results that a sentence names; of more it states the number.
_NAMED = 4


class DocumentError(ViscorollError):
    """Results that are missing or incomplete, or marks that do not pair."""


def filled(text: str, folders: list[Path], name: str) -> str:
    """``text`` of the page ``name`` with every block filled, from the first of ``folders`` that has
    the results.

    Raises
    ------
    DocumentError
        Marks that do not pair, an unknown block, or results that lack a number.
    """

    def fill(match):
        if match[2] not in BLOCKS:
            raise DocumentError(
                f"{name}: unknown block {match[2]!r}: must be one of {', '.join(BLOCKS)}"
            )
        results = Results(*folders)
        try:
            return f"{match[1]}{block(match[2], results)}{provenance(results)}{match[3]}"
        except (KeyError, TypeError) as error:
            stage = BLOCKS[match[2]]["stage"]
            raise DocumentError(
                f"results lack {error} for {match[2]!r}: run pipeline.evidence.{stage}"
            ) from error

    result, count = _BLOCK.subn(fill, text)
    if len(_MARK.findall(text)) != 2 * count:
        raise DocumentError(f"{name}: a mark <!-- measured:NAME --> or <!-- end --> has no partner")
    return result


def provenance(results: Results) -> str:
    """A sentence on the kernels of all that was read of ``results``, if any are not those of this
    tree.
    """
    read = {
        part: digest
        for name, found in results.items()
        for part, digest in stamps(found, name).items()
    }
    others = {}
    for part, digest in read.items():
        if digest != kernels_digest():
            others.setdefault(digest[:SHORT], []).append(part)
    if not others:
        return ""
    alone = len(set(read.values())) == 1
    named = (
        f"`{digest}`" + ("" if alone else f" ({_listed(parts)})")
        for digest, parts in others.items()
    )
    return (
        "\nMeasured with an earlier version of the compiled code, source hash "
        f"{' and '.join(named)}.\n"
    )


def _listed(parts):
    """Return the names of parts of results in a sentence, of many their number."""
    return ", ".join(parts) if len(parts) <= _NAMED else f"{len(parts)} of them"


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
        print(
            f"{', '.join(stale)}: "
            f"{'out of date: run pipeline.evidence.document' if check else 'filled'}"
        )
    return int(check and bool(stale))


def main():
    parser = said(__doc__)
    parser.add_argument(
        "--check", action="store_true", help="write nothing; exit code 1 if a block is out of date"
    )
    parser.add_argument(
        "--results",
        type=Path,
        default=RESULTS,
        metavar="FOLDER",
        help="results that go before data/results",
    )
    parser.add_argument("files", nargs="*", type=Path, metavar="FILE")
    arguments = parser.parse_args()
    files = arguments.files or [*DOCUMENTS, *([] if arguments.check else [CONTRIBUTING])]
    return told("document", lambda: document(files, arguments.results, arguments.check))


if __name__ == "__main__":
    sys.exit(main())
