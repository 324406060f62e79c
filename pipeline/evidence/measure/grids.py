"""Motions from grids, rows and root solves, as pipeline.benchmark left them ->
data/results/grids.json (kept in git).

    python -m pipeline.evidence.measure.grids [-o FILE]

Reads out/benchmark.csv (make benchmark).  pipeline/evidence/document/ puts a sentence of it into
README.md.
"""

import sys

from viscoroll.core.errors import FileError

from ...stage import ROOT, read_rows
from ..results import run

TIMES = ROOT / "out/benchmark.csv"


def work():
    try:
        rows = read_rows(TIMES)
    except OSError as error:
        raise FileError(
            TIMES, f"cannot be read ({error.strerror or error}); run pipeline.benchmark first"
        ) from error
    return {
        "rows": [
            {name: None if value != value else value for name, value in row.items()} for row in rows
        ]
    }


if __name__ == "__main__":
    sys.exit(run("grids", work, __doc__, sizes=False))
