"""Plant one defect after another in the kernels and see whether the tests notice -> data/results/mutants.json.

    python pipeline/mutate.py [--only WORD ...] [--fresh] [--timeout SECONDS]

Each mutant of pipeline/mutants.py is planted in a copy of the tree with a compile cache of its own, and
the tests named beside it run until the first failure; without a defect they must pass.  All of them take
an hour or so; --only takes those whose file or texts hold a WORD, --fresh leaves out what was run on the
same kernels before.  The file says when each was run and on which kernels.  Exit code 1 if fewer than
95 % of those run are killed.
"""

from __future__ import annotations

import argparse
import datetime
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np
from mutants import MUTANTS, Mutant

from viscoroll.files import write_text
from viscoroll.kernels.compile.cache import sources_digest

ROOT = Path(__file__).parents[1]
RESULTS = ROOT / "data/results/mutants.json"
KERNELS = "src/viscoroll/kernels"
LEAST_KILLED = 0.95


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--only", nargs="+", default=[""], metavar="WORD")
    parser.add_argument("--fresh", action="store_true")
    parser.add_argument("--timeout", type=float, default=900.0)
    arguments = parser.parse_args()
    results: dict[str, Any] = json.loads(RESULTS.read_text(encoding="utf-8")) if RESULTS.exists() else {}
    known = {name_of(mutant) for mutant in MUTANTS}
    results = {name: result for name, result in results.items() if name in known}
    chosen = [mutant for mutant in MUTANTS if any(word in name_of(mutant) for word in arguments.only)]
    if arguments.fresh:
        chosen = [m for m in chosen if results.get(name_of(m), {}).get("kernels") != sources_digest()]
    for tests in sorted({mutant.tests for mutant in chosen}):
        outcome, by = judge(None, tests, arguments.timeout)
        if outcome != "survived":
            raise SystemExit(f"{tests}: {outcome} {by} without any defect planted")
    for mutant in chosen:
        begin = time.monotonic()
        outcome, by = judge(mutant, mutant.tests, arguments.timeout)
        seconds = round(time.monotonic() - begin, 1)
        results[name_of(mutant)] = {
            "outcome": outcome, "by": by, "seconds": seconds, "tests": mutant.tests,
            "date": datetime.date.today().isoformat(), "kernels": sources_digest(),
        }  # fmt: skip
        print(f"{outcome:>9} {seconds:>5.0f} s  {name_of(mutant)}", flush=True)
        write_text(RESULTS, json.dumps(results, indent=1, sort_keys=True, ensure_ascii=False) + "\n")
    killed = sum(result["outcome"] != "survived" for result in results.values())
    print(f"{killed} of {len(results)} killed, {len(MUTANTS) - len(results)} not run yet")
    return int(killed < LEAST_KILLED * len(results))


def name_of(mutant: Mutant) -> str:
    return f"{mutant.file}: {mutant.old.strip()} -> {mutant.new.strip()}"


def judge(mutant: Mutant | None, tests: str, timeout: float) -> tuple[str, str]:
    """Outcome of the tests on a tree with this defect or none, and the first test that failed."""
    with tempfile.TemporaryDirectory() as folder:
        tree = Path(folder) / "tree"
        for part in ("src", "tests", "pipeline", "data"):
            shutil.copytree(ROOT / part, tree / part, ignore=shutil.ignore_patterns("__pycache__"))
        shutil.copy(ROOT / "pyproject.toml", tree)
        if mutant is not None:
            plant(mutant, tree / KERNELS / mutant.file)
        return run(tree, tests, timeout)


def plant(mutant: Mutant, path: Path) -> None:
    if path.suffix == ".npy":
        table = np.load(path)
        table.reshape(-1)[int(mutant.old)] *= 1.0 + 1e-9
        np.save(path, table)
        return
    text = path.read_text(encoding="utf-8")
    if text.count(mutant.old) != 1:
        raise SystemExit(f"{path.name} holds {mutant.old!r} {text.count(mutant.old)} times: mend pipeline/mutants.py")
    path.write_text(text.replace(mutant.old, mutant.new), encoding="utf-8")


def run(tree: Path, tests: str, timeout: float) -> tuple[str, str]:
    """(killed, crashed, timed out or survived; the first failing test)."""
    command = [sys.executable, "-m", "pytest", "-x", "-rfE", "--tb=no", "-p", "no:cacheprovider", tests]
    environment = os.environ | {"PYTHONPATH": str(tree / "src"), "VISCOROLL_CACHE_DIR": str(tree / "cache")}
    try:
        done = subprocess.run(
            command, cwd=tree, env=environment, capture_output=True, text=True, timeout=timeout, check=False
        )
    except subprocess.TimeoutExpired:
        return "timed out", ""
    if done.returncode == 0:
        return "survived", ""
    failed = [line.split()[1] for line in done.stdout.splitlines() if line.startswith(("FAILED", "ERROR"))]
    return ("killed" if done.returncode == 1 and failed else "crashed"), (failed or [""])[0]


if __name__ == "__main__":
    sys.exit(main())
