"""What measurements tell: the stage at its quick size, and what the committed numbers promise."""

from __future__ import annotations

import json

import tolerances as tol
from closeness import close
from places import RESULTS
from processes import made

from pipeline.evidence.measure.identification import COVERAGE, PARTS, complaint
from pipeline.evidence.results import rows_of


def test_stage_plans_an_experiment(tmp_path):
    made("evidence.measure.identification", "--quick", "--only", "learn", "-o", tmp_path / "identification.json")
    (row, *_) = json.loads((tmp_path / "identification.json").read_text(encoding="utf-8"))["parts"]["learn"]["rows"]
    committed = committed_rows("learn")[0]
    found, known = row.pop("unknowns"), committed.pop("unknowns")
    assert row == committed
    for name, one in known.items():
        for key, value in one.items():
            assert found[name][key] == value is None or close(found[name][key], value, rel=tol.INTERVAL), (name, key)


def committed_rows(part: str) -> list[dict]:
    return json.loads((RESULTS / "identification.json").read_text(encoding="utf-8"))["parts"][part]["rows"]


def test_committed_numbers_hold():
    parts = json.loads((RESULTS / "identification.json").read_text(encoding="utf-8"))["parts"]
    assert parts.keys() <= PARTS.keys()
    assert [text for row in rows_of(parts) if (text := complaint(row))] == []
    assert len(committed_rows("said")) == 6


def test_a_row_beyond_its_bound_is_told():
    low, high = COVERAGE
    row = {"experiment": "M over the hump", "sets": 200, "held": {"E": 0.95, "T_ref": high + 0.01}}
    assert complaint(row) == "M over the hump: T_ref held by 99.0%"
    assert complaint(row | {"held": {"E": low}}) is None
    assert "90% of starts" in complaint({"experiment": "M over the hump", "reached": 0.9})
    assert "3.0% of the width" in complaint({"experiment": "thrown", "off": 0.03})
    assert "0.6 s a fit" in complaint({"case": "thrown", "fit_s": 0.6, "profiles_s": 2.0})
