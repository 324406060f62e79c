"""The benchmark runs at smoke sizes: results complete, errors sane.  Its times are of no interest here."""

import json
import tomllib
from pathlib import Path

import pytest
import tolerances as tol
from places import PIPELINE, ROOT
from processes import made, stage_refused

CONFIG = PIPELINE / "evidence/sizes.toml"
MOVING = ("max_moving", "p99_moving")


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("bench")


def measured(folder: Path, *parts: str) -> list[dict]:
    made("evidence.bench", *parts, "--quick", "-o", folder, "--figures", folder)
    files = [json.loads((folder / f"bench-{part}.json").read_text()) for part in parts]
    assert all({"cpu", "cores", "date", "numba", "python"} <= file["machine"].keys() for file in files)
    return [file["measured"] for file in files]


def check_rows(result: dict) -> None:
    named = set(result["methods"]) - set(result["skipped"])
    assert {row["method"] for row in result["results"]} == named
    for row in result["results"]:
        assert row["us"] > 0.0
        assert row["failed"] == 0, row
        own = row["method"] in ("table", "flow")
        for name in ("max", "p99", *MOVING) if own else MOVING:  # peers in V lose their digits at rest
            assert 0.0 <= row[name] < (tol.BENCH_OWN if own else tol.BENCH_PEER), row
    for group in result["reference"].values():
        assert group["max"] < tol.BENCH_REFERENCE


def test_motions(folder):
    """Every method and peer that can run here; the paper's method in C is skipped where GSL is missing."""
    work, own = measured(folder, "work-precision", "own-parameters")
    check_rows(work)
    check_rows(own)
    assert {row["group"] for row in work["results"]} == {"IC1", "IC2", "IC3", "random"}
    assert (folder / "work-precision.png").stat().st_size > 0
    if work["skipped"]:
        assert set(work["skipped"]) <= {"gsl-adams", "gsl-bdf", "lsoda"}, work["skipped"]
        pytest.skip("; ".join(f"{name}: {reason}" for name, reason in work["skipped"].items()))


def test_driven(folder):
    """The peer, which looks for no events, finds the motions that this package does."""
    (found,) = measured(folder, "driven")
    check_rows(found)
    assert {row["group"] for row in found["results"]} == {"any start", "rest"}
    if found["skipped"]:
        pytest.skip("numbalsoda is not installed (make peer-tools)")


def test_law_and_the_rest(folder):
    """Every other part runs at a smoke size, and errors are what they are stated to be."""
    parts = "fixed-scene", "bound-law", "series"
    fixed, _, series = measured(folder, *parts)
    assert fixed["error"]["all_times"] < fixed["stated_error"] < tol.FLOW_SPEED
    assert {row["material"] for row in series if row["table_ms"]} >= {"1 modes", "30 modes", "pair of 10 and 3 modes"}


def test_first_calls(folder):
    """Compiled where the cache is empty, and nothing where it is full."""
    (first,) = measured(folder, "first-calls")
    (empty,), (full,) = first["empty"], first["full"]
    assert full["cpu_s"] < empty["cpu_s"]
    assert full["peak_mb"] < empty["peak_mb"]
    assert full["files"] == empty["files"] == 2  # what makes the rows of a law, and motions
    assert 0.0 < full["cache_mb"] == empty["cache_mb"]


def test_last_release(tmp_path):
    """Told for every case, here of a release that is this commit; a clone without the commit says so."""
    section = tomllib.loads(CONFIG.read_text())["bench"]["last_release"]

    def at(commit: str) -> tuple[str | Path, ...]:
        config = tmp_path / "config.toml"
        text = CONFIG.read_text().replace(section["commit"], commit).replace("200_000", "5000")
        config.write_text(text)
        return "last-release", "--quick", "--config", config, "-o", tmp_path, "--figures", tmp_path

    assert "no commit 0000000 here; a shallow clone has few" in stage_refused("evidence.bench", *at("0000000"))
    if not (ROOT / ".git").exists():
        pytest.skip("not a clone")
    said = made("evidence.bench", *at("HEAD"))
    found = json.loads((tmp_path / "bench-last-release.json").read_text())["measured"]
    assert found.keys() == section["cases"].keys()
    for case, row in found.items():
        assert min(row.values()) > 0.0
        assert f"contact, {case}: " in said
