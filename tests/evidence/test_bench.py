"""The benchmark that is kept: complete, and its errors are what the pages say."""

import pytest
import tolerances as tol
from places import kept

PARTS = kept("bench.json")["parts"]


@pytest.mark.parametrize("part", ["work-precision", "own-parameters", "driven"])
def test_errors_of_every_method(part):
    result = PARTS[part]
    assert {row["method"] for row in result["rows"]} == set(result["methods"])
    for row in result["rows"]:
        own = row["method"] in ("table", "flow")
        assert 0.0 <= row["p99"] <= row["max"] < (tol.BENCH_OWN if own else tol.BENCH_PEER)
        assert (row["failed"], row["us"] > 0.0) == (0, True)
    assert all(group["max"] < tol.BENCH_REFERENCE for group in result["reference"].values())


def test_a_full_cache_compiles_nothing():
    assert PARTS["fixed-scene"]["error"]["all_times"] < PARTS["fixed-scene"]["stated_error"]
    empty, full = PARTS["first-calls"]["rows"]
    assert full["cpu_s"] < empty["cpu_s"]
    assert full["files"] == empty["files"]
