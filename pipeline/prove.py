"""Hold what is stated against truth that shares nothing with it -> data/results/proofs.json (kept in git).

    python pipeline/prove.py [--config FILE] [--quick] [--only PROOF] [-o FILE]

Each proof is a list of rows: the claim, its domain, the bound, the worst that was found, and where.
Sizes and seeds are in [prove] of the configuration, those of --quick in [prove.quick].  Exit code 1
where a bound is exceeded.  pipeline/document.py puts the table into docs/accuracy.md.
"""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path

import proofs_contact
import proofs_motion
import proofs_ratios
import proofs_shape
import proofs_slopes
from measure import read_sizes, rounded

from viscoroll import ViscorollError
from viscoroll.files import write_text

ROOT = Path(__file__).parents[1]
#: name -> function of the sizes that returns rows of claim, domain, bound, worst, points, where
PROOFS = {
    "ratios": proofs_ratios.rows,
    "contact": proofs_contact.rows,
    "shape": proofs_shape.rows,
    "slopes": proofs_slopes.rows,
    "motion": proofs_motion.rows,
}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--config", type=Path, default=ROOT / "pipeline/config/production.toml")
    parser.add_argument("--quick", action="store_true", help="few points: the size of a test")
    parser.add_argument("--only", choices=PROOFS, help="renew one proof in a file that has the others")
    parser.add_argument("-o", "--output", type=Path, default=ROOT / "data/results/proofs.json")
    arguments = parser.parse_args()
    try:
        sizes = read_sizes(arguments.config, "prove", arguments.quick)
        names = [arguments.only] if arguments.only else list(PROOFS)
        proofs = {name: PROOFS[name](sizes) for name in names}
        if arguments.only:
            proofs = json.loads(arguments.output.read_text(encoding="utf-8"))["proofs"] | proofs
        arguments.output.parent.mkdir(parents=True, exist_ok=True)
        text = json.dumps(rounded({"proofs": proofs, "sizes": sizes}), indent=1, sort_keys=True, ensure_ascii=False)
        write_text(arguments.output, f"{text}\n")
    except (ViscorollError, OSError) as error:
        print(f"prove: {error}", file=sys.stderr)
        return 2
    broken = [row for rows in proofs.values() for row in rows if not row["worst"] <= row["bound"]]
    for row in broken:
        print(
            f"prove: {row['claim']}: {row['worst']:.3g} exceeds {row['bound']:.3g} at {row['where']}", file=sys.stderr
        )
    print(f"{arguments.output}: {sum(map(len, proofs.values()))} rows, {len(broken)} beyond their bound")
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
