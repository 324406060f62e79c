"""Stage 1: build the tables -> data/tables/atlas.nc, data/tables/paper.nc.

    python pipeline/tabulate.py [--config FILE] [-o FOLDER]

Exit code 1 where a measured interpolation error exceeds the one that the configuration allows.
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path
from typing import Any

from viscoroll import ViscorollError, tables
from viscoroll.config import read_grids

ROOT = Path(__file__).parents[1]


def exceeded(table: Any) -> list[str]:
    """Fields whose measured interpolation error is above the allowed one."""
    return [
        f"{name}: {field.attrs['interpolation_error']:.3g} > {field.attrs['interpolation_error_allowed']:.3g}"
        for name, field in table.data_vars.items()
        if field.attrs.get("interpolation_error", 0.0) > field.attrs.get("interpolation_error_allowed", float("inf"))
    ]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--config", type=Path, default=ROOT / "pipeline/config/production.toml")
    parser.add_argument("-o", "--output", type=Path, default=ROOT / "data/tables", help="folder")
    arguments = parser.parse_args()
    failures = []
    try:
        grids = read_grids(arguments.config)
        for name, grid in grids.items():
            path, start = arguments.output / f"{name}.nc", time.perf_counter()
            table = tables.build(grid, progress=True)
            path.parent.mkdir(parents=True, exist_ok=True)
            tables.save(table, path)
            seconds = time.perf_counter() - start
            print(f"{path}: {path.stat().st_size / 1e6:.1f} MB, {seconds:.1f} s")
            print(f"  {table.attrs['tolerances']}")
            failures += [f"{name}: {failure}" for failure in exceeded(table)]
    except (ViscorollError, OSError) as error:
        print(f"tabulate: {error}", file=sys.stderr)
        return 1
    for failure in failures:
        print(f"tabulate: interpolation error above the allowed one: {failure}", file=sys.stderr)
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
