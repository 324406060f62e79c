"""Stage 1: build the tables -> data/tables/atlas.nc, paper.nc, rubber.nc, rubber-on-steel.nc.

python -m pipeline.demo.tabulate [--config FILE] [--tables FOLDER] [-o FOLDER]

Exit code 1 where a measured interpolation error exceeds the one that the configuration allows.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path
from typing import Any

from viscoroll import tables
from viscoroll.config import read_grids

from .. import stage


def errors(table: Any) -> dict[str, tuple[float, float]]:
    """Measured and allowed interpolation error of every field that names an allowed one."""
    return {
        str(name): (field.attrs["interpolation_error"], field.attrs["interpolation_error_allowed"])
        for name, field in table.data_vars.items()
        if "interpolation_error_allowed" in field.attrs
    }


def build_all(config: Path, folder: Path) -> stage.Outcome:
    """Build, save and report every table of the configuration."""
    outcome = stage.Outcome([])
    for name, grid in read_grids(config).items():
        start, path = time.perf_counter(), stage.make_folder(folder) / f"{name}.nc"
        table = tables.build(grid, progress=True)
        tables.save(table, path)
        outcome.files.append(path)
        outcome.headline[f"{name}: build and save, s"] = time.perf_counter() - start
        outcome.headline[f"{name}: size, MB"] = path.stat().st_size / 1e6
        for field, (measured, allowed) in errors(table).items():
            outcome.headline[f"{name}: interpolation error of {field} (allowed {allowed:g})"] = measured
            outcome.failed |= measured > allowed
    return outcome


if __name__ == "__main__":
    sys.exit(stage.run("tabulate", None, build_all, __doc__, tables=stage.ROOT / "data/tables"))
