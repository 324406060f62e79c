"""Validate: laws, stresses and motions against root solves of the printed equations ->
out/validation.csv and .txt.

    python -m pipeline.validate [--config FILE] [-o FOLDER] [--corners]

The motions of out/runtime.nc, which come from the file of the law, are held against those of
out/direct.nc, which are made here and share neither the law nor the integrator with them.  One row
a quantity: found, allowed, verdict; exit code 1 where one is exceeded.  --corners looks at the ends
of what the package takes instead (pipeline/corners.py).
"""

import re
import sys
from dataclasses import replace
from pathlib import Path
from typing import Annotated

import msgspec
import numpy as np
import xarray as xr
from numpy.typing import NDArray

import viscoroll as vr
from pipeline.validation import roll_direct, validate
from viscoroll.contact_mechanics.coupled_pair import pair_of_scene
from viscoroll.contact_mechanics.coupled_tables import measure_errors
from viscoroll.core.errors import FileError
from viscoroll.core.files import write_dataset, write_text
from viscoroll.presets import read_roller
from viscoroll.tables.law_dataset import Check
from viscoroll.tables.table_files import is_law

from . import stage
from .runtime import motions

#: what the record says -> of which checks the worst
HEADLINE = {
    "Q, table against direct, divided by mu": "random states: Q",
    "grid, nodes against rows": "grid: .*, nodes",
    "grid, Q by splines, divided by the load": "grid: Q, splines",
    "motions from the file of the law, V and omega": "runtime .*",
    "motions IC1-IC3 by roll at rtol 1e-8, V and omega": "motion IC.: (V|omega)",
    "motions IC1-IC3 by roll, onset time, relative": "motion IC.: onset time",
}
Count = Annotated[int, msgspec.Meta(ge=1)]


class Coupled(msgspec.Struct, forbid_unknown_fields=True):
    """[validate.coupled]: the file of a table of the coupled solution, that of its roller; points
    that are no nodes, elements of the solver there, and the largest error of fields.
    """

    table: str
    roller: str
    points: Count
    elements: Count
    allowed: dict[str, float]


class Validate(msgspec.Struct, forbid_unknown_fields=True):
    """[validate]: files of laws, the arguments of :func:`pipeline.validation.validate`, what
    motions from the file may be off by, and a table of the coupled solution.
    """

    tables: list[str]
    states: Count
    stress_states: Count
    table_points: Count
    times: Annotated[int, msgspec.Meta(ge=2)]
    seed: Annotated[int, msgspec.Meta(ge=0)]
    runtime: float
    coupled: Coupled | None = None


def coupled_checks(settings: Coupled | None, seed: int) -> list[Check]:
    """Hold a table of the coupled solution against the solver; none without settings."""
    if settings is None:
        return []
    rows = vr.load_law(stage.ROOT / settings.table).coupled
    pair = pair_of_scene(read_roller(stage.ROOT / settings.roller).scene())
    found = measure_errors(rows, pair, settings.points, seed, settings.elements)
    meaning = f"against {settings.elements} elements at {settings.points} points that are no nodes"
    name = Path(settings.table).stem
    return [
        Check(f"{name}: {field}", found[field], allowed, meaning)
        for field, allowed in settings.allowed.items()
    ]


def direct(t: NDArray) -> xr.Dataset:
    """The paper's motions from root solves."""

    def way(V0, omega0):
        found = roll_direct(vr.presets.PAPER_SECTION_5, V0, omega0, t)
        return found.V, found.omega

    return motions(way, t, "root solves")


def loaded(path: Path) -> xr.Dataset:
    """What another stage left; raises FileError."""
    try:
        return xr.load_dataset(path, engine="h5netcdf")
    except (OSError, ValueError) as error:
        raise FileError(
            path, f"cannot be read ({error}); run the stage that makes it first"
        ) from error


def errors(found: xr.Dataset, truth: xr.Dataset) -> dict[str, float]:
    """Largest error of V and omega divided by the initial speed, by start."""
    off = np.maximum(abs(found.V - truth.V), abs(found.omega - truth.omega)).max("t", skipna=False)
    return dict(
        zip(map(str, truth.ic.values), (off / abs(truth.V[:, 0])).values.tolist(), strict=True)
    )


def work(settings, out):
    sizes = msgspec.structs.asdict(settings)
    allowed = sizes.pop("runtime")
    names = sizes.pop("tables")
    del sizes["coupled"]
    of_file = loaded(out / "runtime.nc")
    truth = direct(of_file.t.values)
    write_dataset(truth, out / "direct.nc", stage.plain_encoding(truth))
    tables = tuple(vr.tables.load(stage.ROOT / name) for name in names)
    report = validate(tables, progress=True, **sizes)
    meaning = f"V and omega by {of_file.law}, divided by the initial speed"
    rows = [
        Check(f"runtime {start}", error, allowed, meaning)
        for start, error in errors(of_file, truth).items()
    ]
    rows += coupled_checks(settings.coupled, settings.seed)
    report = replace(report, checks=(*report.checks, *rows))
    files = [out / "validation.csv", out / "validation.txt", out / "direct.nc"]
    stage.write_rows(
        files[0], [check._asdict() | {"passed": check.passed} for check in report.checks]
    )
    write_text(files[1], f"{report}\n")
    print(report, end="\n\n")
    said = HEADLINE | {
        f"{t.title}: any function, relative": f"{re.escape(t.title)}: .*"
        for t in tables
        if is_law(t)
    }
    headline = {
        text: max(check.measured for check in report.checks if re.fullmatch(which, check.name))
        for text, which in said.items()
    }
    passed = sum(check.passed for check in report.checks)
    headline = {"checks passed": f"{passed} of {len(report.checks)}"} | headline
    return stage.Outcome(files, headline, not report.ok)


if __name__ == "__main__":
    if "--corners" in sys.argv:
        from . import corners  # needs packages of the development environment

        sys.argv.remove("--corners")
        sys.exit(stage.run("corners", corners.Corners, corners.work, corners.__doc__))
    sys.exit(stage.run("validate", Validate, work, __doc__))
