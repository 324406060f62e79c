"""The benchmark that is kept: every method is there, and errors are what the pages say."""

import pytest
import tolerances as tol
from places import kept

PARTS = kept("bench.json")["parts"]


@pytest.mark.parametrize("part", ["work-precision", "own-parameters", "driven"])
def test_errors_of_motions(part):
    rows = PARTS[part]["rows"]
    assert {row["method"] for row in rows} == set(PARTS[part]["methods"])
    for row in rows:
        if row["method"] in ("table", "flow"):
            assert row["failed"] == 0
            assert row["p99"] <= tol.MOTION_RTOL * row["rtol"]
    assert all(group["max"] < tol.BENCH_REFERENCE for group in PARTS[part]["reference"].values())


def test_the_stated_error_of_a_map_bounds_it():
    fixed = PARTS["fixed-scene"]
    assert fixed["error"]["all_times"] < fixed["stated_error"] < tol.FLOW_SPEED
