"""Stage 4: the motions of stage 3 from root solves of the printed equations -> out/direct.nc.

    python -m pipeline.demo.direct [--config FILE] [-o FOLDER]

It shares neither the law nor the integrator with stage 3, only the start and the times.
"""

from __future__ import annotations

import sys
from pathlib import Path

from numpy.typing import NDArray

import viscoroll as vr
from viscoroll.validation.direct_motion import roll_direct

from .. import stage
from .runtime import Runtime, left, motions


def work(config: Path, out: Path) -> stage.Outcome:
    t = stage.read_section(config, "runtime", Runtime).t

    def way(V0: float, omega0: float) -> tuple[NDArray, NDArray]:
        found = roll_direct(vr.PAPER_SECTION_5, V0, omega0, t)
        return found.V, found.omega

    return left(motions(way, t, "root solves"), out / "direct.nc")


if __name__ == "__main__":
    sys.exit(stage.run("direct", None, work, __doc__))
