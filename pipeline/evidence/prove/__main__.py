"""Hold what is stated against truth that shares nothing with it -> data/results/proofs.json (kept
in git).

    python -m pipeline.evidence.prove [--config FILE] [--quick] [--only PART] [-o FILE]

One table of proofs (cases.py): what is drawn, and which claims are made of its errors.  Each part
holds its sizes, the machine, and rows: the claim, its domain, the bound, the worst that was found,
and where.  Sizes and seeds are in [prove] of the configuration, those of --quick in [prove.quick].
Exit code 1 where a bound is exceeded.  pipeline/evidence/document/ puts the table into
docs/accuracy_proofs.md.
"""

import sys
from functools import partial

from ...stage import Row, Sizes
from ..results import run_parts
from . import motion, series, shape, states

#: Every proof: what `make prove`, the tests and the accuracy page read.
TABLE = [
    *states.RATIO_PROOFS,
    *states.PROOFS,
    *shape.PROOFS,
    *series.PROOFS,
    *motion.PROOFS,
    *states.COVER_PROOFS,
]


def part(name: str, sizes: Sizes) -> list[Row]:
    """Return the rows of all proofs of a part.

    name: of the part.
    sizes: section [prove] of the sizes: the seed, and how many states or motions each proof draws.
    """
    return [
        row
        for proof in TABLE
        if proof.part == name
        for row in proof.rows(sizes["seed"], sizes[proof.size])
    ]


#: name -> function of the sizes that returns rows
PROOFS = {proof.part: partial(part, proof.part) for proof in TABLE}


def beyond(row: Row) -> str | None:
    """What is to be said of a row beyond its bound."""
    if row["worst"] <= row["bound"]:
        return None
    return f"{row['claim']}: {row['worst']:.3g} exceeds {row['bound']:.3g} at {row['where']}"


if __name__ == "__main__":
    sys.exit(run_parts("prove", PROOFS, __doc__, "proofs.json", beyond))
