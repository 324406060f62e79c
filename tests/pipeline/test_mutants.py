"""The planted defects (pipeline/mutate/mutants.py) still find their place, and their results say what was run."""

from __future__ import annotations

import importlib
import json
import subprocess
import sys

import numpy as np
import pytest
import tolerances as tol
from places import ROOT

KERNELS = ROOT / "src/viscoroll/kernels"


def mutants() -> list:
    return importlib.import_module("pipeline.mutate.mutants").MUTANTS


@pytest.mark.parametrize("mutant", mutants(), ids=lambda mutant: f"{mutant.file}: {mutant.old.strip()[:40]}")
def test_a_defect_has_one_place(mutant):
    assert (ROOT / mutant.tests).is_file()
    assert mutant.new != mutant.old
    if mutant.file.endswith(".npy"):
        assert np.load(KERNELS / mutant.file).reshape(-1)[int(mutant.old)] != 0.0
    else:
        assert (KERNELS / mutant.file).read_text(encoding="utf-8").count(mutant.old) == 1


def test_results_are_of_known_defects():
    results = json.loads((ROOT / "data/results/mutants.json").read_text(encoding="utf-8"))
    assert set(results) == {f"{mutant.file}: {mutant.old.strip()} -> {mutant.new.strip()}" for mutant in mutants()}
    survived = sum(result["outcome"] == "survived" for result in results.values())
    assert survived <= (1.0 - tol.MUTANTS_KILLED) * len(results)
    for result in results.values():
        assert result["outcome"] in ("killed", "crashed", "timed out", "survived")
        assert result["date"]
        assert result["kernels"]


def test_fuzzing_without_atheris_says_so():
    """An import that fails, as without the extra."""
    code = "import sys, runpy; sys.modules['atheris'] = None; sys.argv = ['fuzz', 'toml']; "
    code += "runpy.run_module('pipeline.torture.fuzz_loaders', run_name='__main__')"
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, timeout=60, check=False
    )
    assert done.returncode == 0, done.stderr
    assert "skipped, atheris is not installed" in done.stdout
