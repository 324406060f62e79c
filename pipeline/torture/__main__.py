"""Damage files as a bad night does, and count what goes unnoticed -> data/results/torture.json (kept in git).

    python -m pipeline.torture [--config FILE] [--quick] [--only PART] [-o FILE]

Each part holds its sizes, the machine, and rows: what was done, how often, and how often the file was
refused, was unharmed, or was wrong: other values without a word, an error that is not the package's own,
a crash.  Sizes and seeds are in [torture] of the configuration, those of --quick in [torture.quick].
Exit code 1 if anything was wrong.  pipeline/document/ puts the table into docs/design.md.
"""

from __future__ import annotations

import sys
from pathlib import Path

from ..results import RESULTS, parser, read_sizes, rows_of, run_parts, told, write_results
from . import cache as torture_cache
from . import ensembles as torture_ensembles
from . import tables as torture_tables

#: name -> function of the sizes that returns rows of done, tried, refused, unharmed, wrong, slowest_s, peak_mb
PARTS = {"tables": torture_tables.rows, "ensembles": torture_ensembles.rows, "cache": torture_cache.rows}


def main() -> int:
    options = parser(__doc__, RESULTS / "torture.json", parts=PARTS)
    arguments = options.parse_args()
    return told("torture", lambda: torture(arguments.config, arguments.quick, arguments.only, arguments.output))


def torture(config: Path, quick: bool, only: str | None, output: Path) -> int:
    """All parts or one, into ``output``; 1 if anything went wrong."""
    sizes = read_sizes(config, "torture", quick)
    parts = run_parts(PARTS, sizes, only, output)
    write_results(output, {"parts": parts})
    rows = rows_of(parts)
    wrong = [row for row in rows if row["wrong"]]
    for row in wrong:
        print(f"torture: {row['done']}: {row['wrong']} of {row['tried']} wrong: {row['how']}", file=sys.stderr)
    print(f"{output}: {len(rows)} rows, {len(wrong)} with something wrong")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
