"""The stages of `make demo` that are out of date, one after another in this process, which imports
and compiles once.

    python -m pipeline [--config FILE] [-o FOLDER] [--tables FOLDER] [STAGE ...]

A stage is out of date where its record, or a file of it, is missing or older than what it reads:
the package, its own module, the configuration, and the stages before it.  With names, these stages
and those that they need.  Exit codes are those of the stages; the first that fails is the last.
"""

import json
import runpy
import sys
from collections.abc import Iterable
from pathlib import Path

from . import stage

#: stage -> those whose files it reads
NEEDS = {
    "offline": (),
    "runtime": ("offline",),
    "ensemble": (),
    "validate": ("runtime",),
    "benchmark": ("validate",),
    "figures": ("offline", "ensemble"),
    "report": ("benchmark", "figures"),
}
HERE = stage.ROOT / "pipeline"


def newest(paths: Iterable[Path]) -> float:
    """When the last of these was written."""
    return max(path.stat().st_mtime for path in paths)


def written(record: Path) -> float:
    """When a stage left its record; 0 where it did not, failed, or a file of it is gone."""
    try:
        found = json.loads(record.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return 0.0
    whole = not found["failed"] and all(
        (record.parents[1] / file).exists() for file in found["files"]
    )
    return record.stat().st_mtime if whole else 0.0


def needed(names: Iterable[str]) -> set[str]:
    """Stages, and all that they need."""
    return {each for name in names for each in (name, *needed(NEEDS[name]))}


def main():
    options = stage.parser(__doc__)
    options.add_argument(
        "--tables", type=Path, default=stage.ROOT / "data/tables", help="default data/tables"
    )
    options.add_argument(
        "names", metavar="STAGE", nargs="*", choices=[*NEEDS, []], help=f"of {', '.join(NEEDS)}"
    )
    given = options.parse_args()
    shared = newest([*(stage.ROOT / "src").rglob("*.py"), HERE / "stage.py", given.config])
    wanted = needed(given.names or NEEDS)
    times = {}
    for name in NEEDS:
        record = given.output / f"stages/{name}.json"
        own = newest(
            path for part in HERE.glob(f"{name[:5]}*") for path in (part, *part.rglob("*.py"))
        )
        times[name] = written(record)
        if name in wanted and times[name] <= max(
            shared, own, *(times[each] for each in NEEDS[name])
        ):
            extra = ["--tables", str(given.tables)] if name == "offline" else []
            sys.argv = [name, "--config", str(given.config), "-o", str(given.output), *extra]
            try:
                runpy.run_module(f"pipeline.{name}", run_name="__main__", alter_sys=True)
            except SystemExit as ended:
                if ended.code:
                    return int(ended.code)
            times[name] = written(record)
    return 0


if __name__ == "__main__":
    sys.exit(main())
