"""The results of the planted defects (pipeline/evidence/mutate.py) are of all of them; stages that
want more say so.
"""

import tolerances as tol
from places import kept

from pipeline.evidence.mutate import MUTANTS


def test_results_are_of_known_defects():
    results = kept("mutants.json")
    assert set(results) == {
        f"{mutant.file}: {mutant.old.strip()} -> {mutant.new.strip()}" for mutant in MUTANTS
    }
    survived = sum(result["outcome"] == "survived" for result in results.values())
    assert survived <= (1.0 - tol.MUTANTS_KILLED) * len(results)
    for result in results.values():
        assert result["outcome"] in ("killed", "crashed", "timed out", "survived")
        assert result["date"]
        assert result["kernels"]
