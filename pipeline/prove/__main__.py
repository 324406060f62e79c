"""Hold what is stated against truth that shares nothing with it -> data/results/proofs.json (kept in git).

    python -m pipeline.prove [--config FILE] [--quick] [--only PROOF] [-o FILE]

Each proof holds its sizes, the machine, and rows: the claim, its domain, the bound, the worst that was
found, and where.  Sizes and seeds are in [prove] of the configuration, those of --quick in [prove.quick].
Exit code 1 where a bound is exceeded.  pipeline/document/ puts the table into docs/accuracy.md.
"""

from __future__ import annotations

import sys
from pathlib import Path

from ..results import RESULTS, parser, read_sizes, rows_of, run_parts, told, write_results
from . import contact as proofs_contact
from . import motion as proofs_motion
from . import ratios as proofs_ratios
from . import shape as proofs_shape
from . import slopes as proofs_slopes

#: name -> function of the sizes that returns rows of claim, domain, bound, worst, points, where
PROOFS = {
    "ratios": proofs_ratios.rows,
    "contact": proofs_contact.rows,
    "shape": proofs_shape.rows,
    "slopes": proofs_slopes.rows,
    "motion": proofs_motion.rows,
}


def main() -> int:
    options = parser(__doc__, RESULTS / "proofs.json", parts=PROOFS)
    arguments = options.parse_args()
    return told("prove", lambda: prove(arguments.config, arguments.quick, arguments.only, arguments.output))


def prove(config: Path, quick: bool, only: str | None, output: Path) -> int:
    """All proofs or one, into ``output``; 1 if a row lies beyond its bound."""
    sizes = read_sizes(config, "prove", quick)
    proofs = run_parts(PROOFS, sizes, only, output)
    write_results(output, {"parts": proofs})
    rows = rows_of(proofs)
    broken = [row for row in rows if not row["worst"] <= row["bound"]]
    for row in broken:
        print(
            f"prove: {row['claim']}: {row['worst']:.3g} exceeds {row['bound']:.3g} at {row['where']}", file=sys.stderr
        )
    print(f"{output}: {len(rows)} rows, {len(broken)} beyond their bound")
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
