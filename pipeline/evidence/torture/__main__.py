"""Damage files as a bad night does, and count what goes unnoticed -> data/results/torture.json
(kept in git).

    python -m pipeline.evidence.torture [--config FILE] [--quick] [--only PART ...] [-o FILE]

Each part holds its sizes, the machine, and rows: what was done, how often, and how often the file
was refused, was unharmed, or was wrong: other values without a word, an error that is not the
package's own, a crash.  Sizes and seeds are in [torture] of the configuration, those of --quick in
[torture.quick].  Exit code 1 if anything was wrong.  pipeline/evidence/document/ puts the table
into docs/torture.md.
"""

from __future__ import annotations

import sys
from typing import Any

from ..results import run_parts
from . import ensembles, tables

#: name -> function of the sizes that returns rows of done, tried, refused, unharmed, wrong,
#: slowest_s, peak_mb
PARTS = {"tables": tables.rows, "ensembles": ensembles.rows}


def harm(row: dict[str, Any]) -> str | None:
    """What is to be said of a row in which something went wrong."""
    return (
        f"{row['done']}: {row['wrong']} of {row['tried']} wrong: {row['how']}"
        if row["wrong"]
        else None
    )


if __name__ == "__main__":
    sys.exit(run_parts("torture", PARTS, __doc__, "torture.json", harm))
