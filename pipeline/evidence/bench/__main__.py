"""Run time against error, beside what people would use instead -> data/results/bench.json (kept in
git).

    python -m pipeline.evidence.bench [--config FILE] [--quick] [--only PART ...] [-o FILE]

Sizes are in [bench.PART] of the configuration, those of --quick in [bench.PART.quick].  Times are
of this machine at this moment, medians of alternating runs on one core: run it with nothing else
running.  A peer that is not installed is skipped with a printed reason
(pipeline/evidence/peers/README.md).  pipeline/evidence/bench/figures.py draws it.
"""

from __future__ import annotations

import os
import sys

from ..results import run_parts
from .calls import bound_law, fixed_scene, series
from .motions import driven, own_parameters, work_precision
from .processes import first_calls, last_release

PARTS = {
    part.__name__.replace("_", "-"): part
    for part in (
        work_precision,
        own_parameters,
        fixed_scene,
        bound_law,
        series,
        first_calls,
        driven,
        last_release,
    )
}

if __name__ == "__main__":
    os.environ["VISCOROLL_THREADS"] = (
        "1"  # every time is that of one core, where it does not say otherwise
    )
    sys.exit(run_parts("bench", PARTS, __doc__, "bench.json"))
