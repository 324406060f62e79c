"""Hold what is stated against truth that shares nothing with it -> data/results/proofs.json (kept in git).

    python -m pipeline.evidence.prove [--config FILE] [--quick] [--only PROOF] [-o FILE]

Each proof holds its sizes, the machine, and rows: the claim, its domain, the bound, the worst that was
found, and where.  Sizes and seeds are in [prove] of the configuration, those of --quick in [prove.quick].
Exit code 1 where a bound is exceeded.  pipeline/evidence/document/ puts the table into docs/accuracy.md.
"""

from __future__ import annotations

import sys
from typing import Any

from ..results import run_parts
from . import boundary, contact, driven, motion, ratios, series, shape, slopes

#: name -> function of the sizes that returns rows of claim, domain, bound, worst, points, where
PROOFS = {
    "ratios": ratios.rows, "contact": contact.rows, "shape": shape.rows, "slopes": slopes.rows, "motion": motion.rows,
    "series": series.rows, "states": series.rows_of_states, "boundary": boundary.rows, "driven": driven.rows,
    "check_driven": driven.precise_rows,
}  # fmt: skip


def beyond(row: dict[str, Any]) -> str | None:
    """What is to be said of a row beyond its bound."""
    if row["worst"] <= row["bound"]:
        return None
    return f"{row['claim']}: {row['worst']:.3g} exceeds {row['bound']:.3g} at {row['where']}"


if __name__ == "__main__":
    sys.exit(run_parts("prove", PROOFS, __doc__, "proofs.json", beyond))
