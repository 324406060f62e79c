"""Validate: laws, stresses and motions against root solves of the printed equations -> out/validation.nc and .txt.

    python -m pipeline.validate [--config FILE] [-o FOLDER] [--corners]

The motions of out/runtime.nc, which come from the file of the law, are held against those of out/direct.nc, which are
made here and share neither the law nor the integrator with them.  One row a quantity: found, allowed, verdict; exit
code 1 where one is exceeded.  --corners looks at the ends of what the package takes instead (pipeline/corners.py).
"""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import msgspec
import numpy as np
import xarray as xr
from numpy.typing import NDArray

import viscoroll as vr
from pipeline.validation import report_dataset, validate
from pipeline.validation.direct_motion import roll_direct
from viscoroll.core.errors import FileError
from viscoroll.core.files import write_dataset, write_text
from viscoroll.io.tables.check import Check
from viscoroll.materials.law_store import errors_of

from . import corners, stage
from .runtime import motions


class Validate(msgspec.Struct, forbid_unknown_fields=True):
    """[validate]: files of laws, the arguments of :func:`pipeline.validation.validate`, and what motions from the file
    may be off by.
    """

    tables: list[str]
    states: int
    stress_states: int
    table_points: int
    times: int
    seed: int
    runtime: float


def direct(t: NDArray) -> xr.Dataset:
    """The paper's motions from root solves."""

    def way(V0: float, omega0: float) -> tuple[NDArray, NDArray]:
        found = roll_direct(vr.presets.PAPER_SECTION_5, V0, omega0, t)
        return found.V, found.omega

    return motions(way, t, "root solves")


def loaded(path: Path) -> xr.Dataset:
    """What another stage left; raises FileError."""
    try:
        return xr.load_dataset(path, engine="h5netcdf")
    except (OSError, ValueError) as error:
        raise FileError(path, f"cannot be read ({error}); run the stage that makes it first") from error


def errors(found: xr.Dataset, truth: xr.Dataset) -> dict[str, float]:
    """Largest error of V and omega over the first speed, by start."""
    off = np.maximum(abs(found.V - truth.V), abs(found.omega - truth.omega)).max("t", skipna=False)
    return dict(zip(map(str, truth.ic.values), (off / abs(truth.V[:, 0])).values.tolist(), strict=True))


def work(settings: Validate, out: Path) -> stage.Outcome:
    sizes = msgspec.structs.asdict(settings)
    allowed, names = sizes.pop("runtime"), sizes.pop("tables")
    of_file = loaded(out / "runtime.nc")
    truth = direct(of_file.t.values)
    write_dataset(truth, out / "direct.nc", stage.plain_encoding(truth))
    tables = tuple(vr.tables.load(stage.ROOT / name) for name in names)
    report = validate(tables, progress=True, **sizes)
    meaning = f"V and omega by {of_file.law} and a Rosenbrock method, over the first speed"
    rows = [Check(f"runtime {start}", error, allowed, meaning) for start, error in errors(of_file, truth).items()]
    report = replace(report, checks=(*report.checks, *rows))
    files = [out / "validation.nc", out / "validation.txt", out / "direct.nc"]
    dataset = report_dataset(report)
    write_dataset(dataset, files[0], stage.plain_encoding(dataset))
    write_text(files[1], f"{report}\n")
    print(report, end="\n\n")
    worst = {c.name: c.measured for c in report.checks}
    headline: dict[str, float | int | str] = {
        "checks passed": f"{sum(c.passed for c in report.checks)} of {len(report.checks)}",
        "Q, table against direct, over mu": worst["random states: Q"],
        "motions from the file of the law, V and omega": max(row.measured for row in rows),
        "motions IC1-IC3 by roll at rtol 1e-8, V and omega": max(
            worst[f"motion {start}: {name}"] for start in vr.presets.PAPER_STARTS for name in ("V", "omega")
        ),
        "motions IC1-IC3 by roll, onset time, relative": max(
            worst[f"motion {start}: onset time"] for start in vr.presets.PAPER_STARTS
        ),
    }
    for table in tables:
        of_table = (worst[f"{table.attrs['title']}: {name}"] for name in errors_of(table))
        headline[f"{table.attrs['title']}: any function, relative"] = max(of_table)
    return stage.Outcome(files, headline, not report.ok)


if __name__ == "__main__":
    if "--corners" in sys.argv:
        sys.argv.remove("--corners")
        sys.exit(stage.run("corners", corners.Corners, corners.work, corners.__doc__))
    sys.exit(stage.run("validate", Validate, work, __doc__))
