"""The benchmark runs at smoke sizes: results complete, errors sane.  Its times are of no interest
here.
"""

import json

import pytest
import tolerances as tol
from processes import made

from pipeline.evidence.figures import draw
from pipeline.evidence.results import RESULTS, Results


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    return tmp_path_factory.mktemp("bench") / "bench.json"


def measured(results, *parts):
    made("evidence.bench", "--only", *parts, "--quick", "-o", results)
    found = json.loads(results.read_text())["parts"]
    assert all(
        {"cpu", "cores", "date", "numba", "python"} <= found[part]["machine"].keys()
        for part in parts
    )
    return [found[part] for part in parts]


def check_rows(result):
    assert {row["method"] for row in result["rows"]} == set(result["methods"]) - set(
        result["skipped"]
    )
    for row in result["rows"]:
        assert row["us"] > 0.0
        assert row["failed"] == 0, row
        for name in ("max", "p99"):
            assert (
                0.0
                <= row[name]
                < (tol.BENCH_OWN if row["method"] in ("table", "flow") else tol.BENCH_PEER)
            ), row
    for group in result["reference"].values():
        assert group["max"] < tol.BENCH_REFERENCE


def test_motions(results):
    """Every method and peer that can run here; the paper's method in C is skipped where GSL is
    missing.
    """
    work, own = measured(results, "work-precision", "own-parameters")
    check_rows(work)
    check_rows(own)
    assert {row["group"] for row in work["rows"]} == {"IC1", "IC2", "IC3", "random"}
    draw(Results(results.parent, RESULTS), results.parent)
    assert (results.parent / "work-precision.png").stat().st_size > 0
    if work["skipped"]:
        assert set(work["skipped"]) <= {"gsl-adams", "gsl-bdf", "lsoda"}, work["skipped"]
        pytest.skip("; ".join(f"{name}: {reason}" for name, reason in work["skipped"].items()))


def test_driven(results):
    """The peer, which looks for no events, finds the motions that this package does."""
    (found,) = measured(results, "driven")
    check_rows(found)
    assert {row["group"] for row in found["rows"]} == {"any start", "rest"}
    if found["skipped"]:
        pytest.skip("numbalsoda is not installed (make peer-tools)")


def test_law_and_the_rest(results):
    """Every other part runs at a smoke size, and errors are what they are stated to be."""
    parts = "fixed-scene", "bound-law", "series"
    fixed, _, series = measured(results, *parts)
    assert fixed["error"]["all_times"] < fixed["stated_error"] < tol.FLOW_SPEED
    assert {row["material"] for row in series["rows"] if row["table_ms"]} >= {
        "1 mode",
        "30 modes",
        "pair of 10 and 3 modes",
    }


def test_first_calls(results):
    """Compiled where the cache is empty, and nothing where it is full."""
    (first,) = measured(results, "first-calls")
    empty, full = first["rows"]
    assert (empty["cache"], full["cache"]) == ("empty", "full")
    assert full["cpu_s"] < empty["cpu_s"]
    assert full["peak_mb"] < empty["peak_mb"]
    assert full["files"] == empty["files"] == 2  # what makes the rows of a law, and motions
    assert 0.0 < full["cache_mb"] == empty["cache_mb"]
