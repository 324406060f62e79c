"""The law outside Python at its quick size, and what the committed numbers promise."""

import json
import shutil

import pytest
import tolerances as tol
from places import kept
from processes import made, stage_refused

MISSING = [name for name in ("chromium", "node", "cc") if shutil.which(name) is None]


@pytest.mark.skipif(
    bool(MISSING), reason=f"not installed (make interop site-tools): {', '.join(MISSING)}"
)
def test_stage_finds_the_law_in_every_program(tmp_path):
    made("evidence.measure.outside", "--quick", "-o", tmp_path / "outside.json")
    found = json.loads((tmp_path / "outside.json").read_text())
    holds(found)
    committed = kept("outside.json")
    assert all(found[key].keys() == committed[key].keys() for key in ("page", "states"))


def test_committed_numbers_hold():
    committed = kept("outside.json")
    holds(committed)
    assert committed["page"]["median_ms"] < 20.0


def holds(found):
    assert found["page"]["error"] < tol.INTEROP


def test_stage_says_what_is_missing(tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", str(tmp_path))
    refused = stage_refused("evidence.measure.outside", "--quick", "-o", tmp_path / "outside.json")
    assert "chromium is not installed" in refused
