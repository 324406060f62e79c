"""Numbers are measured by a stage, and put on pages by another."""

import re

import pytest
from places import kept
from processes import made, stage, stage_refused

from pipeline.evidence.results import SIZES, read_sizes

pytestmark = pytest.mark.filterwarnings(
    "ignore::viscoroll.ModelWarning"
)  # the paper's own scene is beyond the model


def test_document_fills_and_refuses(tmp_path):
    page = tmp_path / "page.md"
    page.write_text("before\n<!-- measured:stress -->\nold\n<!-- end -->\nafter\n")
    assert stage("evidence.document", "--check", page).returncode == 1
    made("evidence.document", page)
    filled = page.read_text()
    assert re.fullmatch(r"before\n.*\nafter\n", filled, re.DOTALL)
    assert "old" not in filled
    assert stage("evidence.document", "--check", page).returncode == 0
    for text in ("<!-- measured:stress -->\n", "<!-- measured:nothing -->\n<!-- end -->\n"):
        page.write_text(text)
        assert stage_refused("evidence.document", page).startswith("document: ")
        assert page.read_text() == text
    assert "nowhere: no folder" in stage_refused(
        "evidence.document", "--results", tmp_path / "nowhere", page
    )


@pytest.mark.parametrize(
    "file, section",
    [
        ("measured", "measure"),
        ("ensembles", "ensembles"),
        ("outside", "outside"),
        ("torture", "torture"),
    ],
)
def test_committed_sizes_are_those_of_production(file, section):
    found = kept(f"{file}.json")
    sizes = read_sizes(SIZES, section, quick=False)
    assert all(part["sizes"] == sizes for part in found.get("parts", {"": found}).values())


def test_blocks_show_the_measured_numbers():
    made("evidence.document", "--check")
