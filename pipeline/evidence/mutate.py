"""Plant one defect after another in the kernels and see whether the tests notice ->
data/results/mutants.json.

    python -m pipeline.evidence.mutate [--check] [--only WORD ...] [--fresh] [--jobs N]

Each mutant of mutants.toml is planted in a copy of the tree with a compile cache of its own, and
the tests named beside it run until the first failure; without a defect they must pass.  As many run
at a time as there are cores: all of them take half an hour on two.  --only takes those whose file
or texts hold a WORD, --fresh leaves out what was run on the same kernels before.  The file says
when each was run and on which kernels.  --check runs nothing: it lists the mutants that have no
place in the kernels, or several, or whose tests are gone (exit code 1 if there are any), which no
run begins with.  Exit code 1 if fewer than 95 % of those run are killed.
"""

import datetime
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor, as_completed
from functools import partial
from pathlib import Path
from typing import NamedTuple

import numpy as np

from viscoroll.core.files import write_text

from ..stage import ROOT, Row, read_toml, said
from .results import kernels_digest


class Mutant(NamedTuple):
    """``old`` occurs once in the kernel ``file`` and becomes ``new``; for a table, ``old`` is the
    coefficient's number.

    ``tests`` : files of tests, or tests of one, with spaces between.
    """

    file: str
    old: str
    new: str
    tests: str


def read_mutants() -> list[Mutant]:
    """Return all mutants of the file, its names of tests replaced by their paths."""
    content = read_toml(Path(__file__).with_name("mutants.toml"))
    rows = (row for group in content["mutants"].values() for row in group)
    return [
        Mutant(file, old, new, content["tests"].get(tests, tests)) for file, old, new, tests in rows
    ]


MUTANTS = read_mutants()


RESULTS = ROOT / "data/results/mutants.json"
KERNELS = "src/viscoroll/kernels"
LEAST_KILLED = 0.95
#: seconds of the tests of a mutant
LONGEST = 900.0


def main():
    parser = said(__doc__)
    parser.add_argument(
        "--check", action="store_true", help="only list the mutants that have lost their place"
    )
    parser.add_argument("--only", nargs="+", default=[""], metavar="WORD")
    parser.add_argument("--fresh", action="store_true")
    parser.add_argument(
        "--jobs",
        type=int,
        default=os.cpu_count() or 1,
        help="mutants at a time (default: all cores)",
    )
    arguments = parser.parse_args()
    chosen = {name_of(m): m for m in MUTANTS if any(word in name_of(m) for word in arguments.only)}
    lost = list(without_place(chosen.values()))
    print("\n".join(lost or [f"{len(chosen)} mutants, each with one place"]), flush=True)
    if lost or arguments.check:
        return int(bool(lost))
    before = json.loads(RESULTS.read_text(encoding="utf-8")) if RESULTS.exists() else {}
    results = {name: before[name] for name in map(name_of, MUTANTS) if name in before}
    if arguments.fresh:
        chosen = {
            name: m
            for name, m in chosen.items()
            if results.get(name, {}).get("kernels") != kernels_digest()
        }
    with ThreadPoolExecutor(arguments.jobs) as pool:
        try:
            judge_all(chosen, pool, results)
        finally:
            pool.shutdown(cancel_futures=True)
    killed = sum(result["outcome"] != "survived" for result in results.values())
    print(f"{killed} of {len(results)} killed, {len(MUTANTS) - len(results)} not run yet")
    return int(killed < LEAST_KILLED * len(results))


def without_place(mutants: Iterable[Mutant]) -> Iterator[str]:
    """Those that cannot be planted as they are, and why: to be renewed after kernels were
    rewritten.
    """
    for mutant in mutants:
        path = ROOT / KERNELS / mutant.file
        if not path.is_file():
            yield f"no such file: {name_of(mutant)}"
            continue
        if path.suffix == ".npy":
            places = int(np.load(path).reshape(-1)[int(mutant.old)] != 0.0)
        else:
            places = path.read_text(encoding="utf-8").count(mutant.old)
        if places != 1 or mutant.old == mutant.new:
            yield f"{places} places: {name_of(mutant)}"
        if not all((ROOT / tests.partition("::")[0]).is_file() for tests in mutant.tests.split()):
            yield f"no {mutant.tests}: {name_of(mutant)}"


def judge_all(mutants: dict[str, Mutant], pool: ThreadPoolExecutor, results: Row) -> None:
    """Into ``results`` and their file, one by one, once the tests have passed without a defect."""
    for found in pool.map(partial(judge, None), {mutant.tests for mutant in mutants.values()}):
        if found["outcome"] != "survived":
            raise SystemExit(
                f"{found['tests']}: {found['outcome']} {found['by']} without any defect planted"
            )
    runs = {pool.submit(judge, mutant, mutant.tests): name for name, mutant in mutants.items()}
    for number, run in enumerate(as_completed(runs), 1):
        found = results[runs[run]] = run.result()
        print(
            f"{number}/{len(runs)} {found['outcome']:>9} {found['seconds']:>5.0f} s  {runs[run]}",
            flush=True,
        )
        write_text(
            RESULTS, json.dumps(results, indent=1, sort_keys=True, ensure_ascii=False) + "\n"
        )


def name_of(mutant: Mutant) -> str:
    return f"{mutant.file}: {mutant.old.strip()} -> {mutant.new.strip()}"


def judge(mutant: Mutant | None, tests: str) -> Row:
    """Outcome of the tests on a tree with this defect or none, and the first of them that
    failed.
    """
    begun = time.monotonic()
    with tempfile.TemporaryDirectory() as folder:
        tree = Path(folder) / "tree"
        for part in ("src", "tests", "pipeline", "data"):
            shutil.copytree(
                ROOT / part, tree / part, ignore=shutil.ignore_patterns("__pycache__", ".*.tmp-*")
            )
        shutil.copy(ROOT / "pyproject.toml", tree)
        if mutant is not None:
            plant(mutant, tree / KERNELS / mutant.file)
        outcome, by = run(tree, tests)
    return {
        "outcome": outcome,
        "by": by,
        "seconds": round(time.monotonic() - begun, 1),
        "tests": tests,
        "date": datetime.date.today().isoformat(),
        "kernels": kernels_digest(),
    }


def plant(mutant: Mutant, path: Path) -> None:
    if path.suffix == ".npy":
        table = np.load(path)
        table.reshape(-1)[int(mutant.old)] *= 1.0 + 1e-9
        np.save(path, table)
        return
    text = path.read_text(encoding="utf-8")
    path.write_text(text.replace(mutant.old, mutant.new), encoding="utf-8")


def run(tree: Path, tests: str) -> tuple[str, str]:
    """(killed, crashed, timed out or survived; the first failing test)."""
    command = [sys.executable, *f"-m pytest -x -rfE --tb=no -p no:cacheprovider {tests}".split()]
    environment = os.environ | {
        "PYTHONPATH": str(tree / "src"),
        "VISCOROLL_CACHE_DIR": str(tree / "cache"),
    }
    try:
        done = subprocess.run(
            command,
            cwd=tree,
            env=environment,
            capture_output=True,
            text=True,
            timeout=LONGEST,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return "timed out", ""
    if done.returncode == 0:
        return "survived", ""
    failed = [
        line.split()[1] for line in done.stdout.splitlines() if line.startswith(("FAILED", "ERROR"))
    ]
    return ("killed" if done.returncode == 1 and failed else "crashed"), (failed or [""])[0]


if __name__ == "__main__":
    sys.exit(main())
