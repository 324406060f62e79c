"""Damage files as a bad night does, and count what goes unnoticed -> data/results/torture.json (kept in git).

    python pipeline/torture.py [--config FILE] [--quick] [--only PART] [-o FILE]

Each part is a list of rows: what was done, how often, and how often the file was refused, was unharmed,
or was wrong: other values without a word, an error that is not the package's own, a crash.  Sizes and
seeds are in [torture] of the configuration, those of --quick in [torture.quick].  Exit code 1 if
anything was wrong.  pipeline/document.py puts the table into docs/design.md.
"""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path
from typing import Any

import torture_ensembles
import torture_tables
from measure import machine, read_sizes, rounded

from viscoroll import ViscorollError
from viscoroll.files import write_text

ROOT = Path(__file__).parents[1]
#: name -> function of the sizes that returns rows of done, tried, refused, unharmed, wrong, slowest_s, peak_mb
PARTS = {"tables": torture_tables.rows, "ensembles": torture_ensembles.rows}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--config", type=Path, default=ROOT / "pipeline/config/production.toml")
    parser.add_argument("--quick", action="store_true", help="a few of each: the size of a test")
    parser.add_argument("--only", choices=PARTS, help="one part; the others stay as they are")
    parser.add_argument("-o", "--output", type=Path, default=ROOT / "data/results/torture.json")
    arguments = parser.parse_args()
    output: Path = arguments.output
    try:
        sizes = read_sizes(arguments.config, "torture", arguments.quick)
        done = {name: rows(sizes) for name, rows in PARTS.items() if arguments.only in (None, name)}
        known = json.loads(output.read_text(encoding="utf-8"))["parts"] if output.exists() and arguments.only else {}
        results: dict[str, Any] = {"parts": known | done, "sizes": sizes, "machine": machine()}
        output.parent.mkdir(parents=True, exist_ok=True)
        write_text(output, json.dumps(rounded(results), indent=1, sort_keys=True, ensure_ascii=False) + "\n")
    except (ViscorollError, OSError) as error:
        print(f"torture: {error}", file=sys.stderr)
        return 2
    wrong = [row for rows in done.values() for row in rows if row["wrong"]]
    for row in wrong:
        print(f"torture: {row['done']}: {row['wrong']} of {row['tried']} wrong: {row['how']}", file=sys.stderr)
    print(f"{output}: {sum(map(len, done.values()))} rows, {len(wrong)} with something wrong")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
