"""Stage 2: laws, stresses and motions against direct solves -> out/validation.nc, out/validation.txt.

    python -m pipeline.demo.validate [--config FILE] [-o FOLDER]

Exit code 1 where a stated tolerance is exceeded.
"""

from __future__ import annotations

import sys
from pathlib import Path

import msgspec

import viscoroll as vr
from viscoroll.files import write_dataset, write_text
from viscoroll.materials.law_store import errors_of
from viscoroll.validation import report_dataset, validate

from .. import stage


class Validate(msgspec.Struct, forbid_unknown_fields=True):
    """[validate]: files of laws, and the arguments of :func:`viscoroll.validation.validate`."""

    tables: list[str]
    states: int
    stress_states: int
    table_points: int
    times: int
    seed: int


def work(settings: Validate, out: Path) -> stage.Outcome:
    sizes = msgspec.structs.asdict(settings)
    tables = tuple(vr.tables.load(stage.ROOT / name) for name in sizes.pop("tables"))
    report = validate(tables, progress=True, **sizes)
    files = [out / "validation.nc", out / "validation.txt"]
    dataset = report_dataset(report)
    write_dataset(dataset, files[0], stage.plain_encoding(dataset))
    write_text(files[1], f"{report}\n")
    print(report, end="\n\n")
    worst = {c.name: c.measured for c in report.checks}
    headline: dict[str, float | int | str] = {
        "checks passed": f"{sum(c.passed for c in report.checks)} of {len(report.checks)}",
        "Q, table against direct, over mu": worst["random states: Q"],
        "motions IC1-IC3 at rtol 1e-8 against direct solves, V and omega": max(
            worst[f"motion {start}: {name}"] for start in vr.PAPER_STARTS for name in ("V", "omega")
        ),
        "motions IC1-IC3, onset time, relative": max(worst[f"motion {start}: onset time"] for start in vr.PAPER_STARTS),
    }
    for table in tables:
        rows = (worst[f"{table.attrs['title']}: {name}"] for name in errors_of(table))
        headline[f"{table.attrs['title']}: any function, relative"] = max(rows)
    return stage.Outcome(files, headline, not report.ok)


if __name__ == "__main__":
    sys.exit(stage.run("validate", Validate, work, __doc__))
