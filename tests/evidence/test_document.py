"""Numbers are measured by a stage, and put on pages by another."""

import json
import re
import tomllib

import pytest
from places import RESULTS, ROOT
from processes import made, stage, stage_refused

pytestmark = pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")  # the paper's own scene is beyond the model


def test_document_fills_and_refuses(tmp_path):
    page = tmp_path / "page.md"
    page.write_text("before\n<!-- measured:stress -->\nold\n<!-- end -->\nafter\n", encoding="utf-8")
    assert stage("evidence.document", "--check", page).returncode == 1
    made("evidence.document", page)
    filled = page.read_text(encoding="utf-8")
    assert re.fullmatch(r"before\n.*\nafter\n", filled, re.DOTALL)
    assert "old" not in filled
    assert stage("evidence.document", "--check", page).returncode == 0
    for text in ("<!-- measured:stress -->\n", "<!-- measured:nothing -->\n<!-- end -->\n"):
        page.write_text(text, encoding="utf-8")
        assert stage_refused("evidence.document", page).startswith("document: ")
        assert page.read_text(encoding="utf-8") == text
    assert "nowhere: no folder" in stage_refused("evidence.document", "--results", tmp_path / "nowhere", page)


def test_measure_runs_and_document_reads_it(tmp_path):
    results, page = tmp_path / "measured.json", tmp_path / "README.md"
    made("evidence.measure", "--quick", "-o", results)
    measured = json.loads(results.read_text(encoding="utf-8"))
    committed = json.loads((RESULTS / "measured.json").read_text(encoding="utf-8"))
    assert measured.keys() == committed.keys()
    assert measured["time"].keys() == committed["time"].keys()
    page.write_text("<!-- measured:times -->\n<!-- end -->\n", encoding="utf-8")
    made("evidence.document", "--results", tmp_path, page)
    assert "not those of this version" not in page.read_text(encoding="utf-8")


def test_measure_refuses_a_configuration_without_its_section(tmp_path):
    (tmp_path / "empty.toml").write_text("", encoding="utf-8")
    assert "[measure]" in stage_refused(
        "evidence.measure", "--config", tmp_path / "empty.toml", "-o", tmp_path / "out.json"
    )
    assert not (tmp_path / "out.json").exists()


def test_committed_sizes_are_those_of_production():
    measured = json.loads((RESULTS / "measured.json").read_text(encoding="utf-8"))
    section = tomllib.loads((ROOT / "pipeline/evidence/sizes.toml").read_text(encoding="utf-8"))["measure"]
    del section["quick"]
    assert measured["sizes"] == section
