"""What the results that are kept of long runs promise."""

import pytest
import tolerances as tol
from places import kept

from pipeline.evidence.measure import identification
from pipeline.evidence.mutate import MUTANTS, name_of
from pipeline.evidence.results import rows_of

#: seconds of the processor that a load of a damaged file may take, and MB that a process may take
#: in all; issue and RLIMIT_AS
SLOWEST = 5.0
MOST_MEMORY = 1000.0
BENCH = kept("bench.json")["parts"]


@pytest.mark.parametrize("part", ["work-precision", "own-parameters", "driven"])
def test_errors_of_motions(part):
    """The benchmark: every method is there, and errors are what the pages say."""
    rows = BENCH[part]["rows"]
    assert {row["method"] for row in rows} == set(BENCH[part]["methods"])
    for row in rows:
        if row["method"] in ("table", "flow"):
            assert row["failed"] == 0
            assert row["p99"] <= tol.MOTION_RTOL * row["rtol"]
    assert all(group["max"] < tol.BENCH_REFERENCE for group in BENCH[part]["reference"].values())


def test_the_stated_error_of_a_map_bounds_it():
    fixed = BENCH["fixed-scene"]
    assert fixed["error"]["all_times"] < fixed["stated_error"] < tol.FLOW_SPEED


def test_identification():
    """What measurements tell."""
    parts = kept("identification.json")["parts"]
    assert parts.keys() <= identification.PARTS.keys()
    assert [text for row in rows_of(parts) if (text := identification.complaint(row))] == []


def test_planted_defects():
    """Of all that are known; most are killed."""
    results = kept("mutants.json")
    assert set(results) == {*map(name_of, MUTANTS)}
    survived = sum(result["outcome"] == "survived" for result in results.values())
    assert survived <= (1.0 - tol.MUTANTS_KILLED) * len(results)


def test_the_law_outside_python():
    page = kept("outside.json")["page"]
    assert page["error"] < tol.INTEROP
    assert page["median_ms"] < 20.0


def test_nothing_went_unnoticed_in_damaged_files():
    parts = kept("torture.json")["parts"]
    assert set(parts) == {"tables", "ensembles"}
    for row in rows_of(parts):
        assert row["tried"] > 0
        assert row["wrong"] == 0
        assert (row["slowest_s"] or 0.0) < SLOWEST
        assert (row["peak_mb"] or 0.0) < MOST_MEMORY


def test_ensembles():
    """10^8 motions of a scene, and 10^6 with seven uncertain inputs, in a minute of two free cores
    and 1 GB.
    """
    committed = kept("ensembles.json")
    for name in ("100000000 motions of a scene", "1000000 motions, seven uncertain inputs"):
        assert committed["rows"][name]["cpu_s"] / committed["threads"] < 60.0
        assert committed["rows"][name]["peak_mb"] < 1000.0


def test_memory_is_bounded():
    """As measured at full size."""
    rows = kept("large.json")["rows"]
    assert max(row["elements"] for row in rows) == 100_000_000
    assert all(row["extra_bytes"] <= tol.MEMORY_SLACK for row in rows)
