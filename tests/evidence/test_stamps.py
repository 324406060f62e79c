"""Results say of which kernels they are, and pages where those are not this tree's."""

import json
import re

import pytest
from places import RESULTS

from pipeline.evidence import stamps
from pipeline.evidence.document.__main__ import BLOCKS, filled

OTHER = "0123456789abcdef"
SENTENCE = "Measured with an earlier version of the compiled code, source hash `01234567`.\n"


KERNEL = '@njit\ndef law(x):\n    """Doubled."""\n    return 2.0 * x\n'
digest_of = stamps.kernels_digest.__wrapped__


@pytest.fixture
def results(tmp_path):
    """The committed ones, as if all were of the kernels named."""

    def restamped(digest):
        for path in RESULTS.glob("*.json"):
            text = re.sub(r'"kernels": "\w+"', f'"kernels": "{digest}"', path.read_text())
            (tmp_path / path.name).write_text(text)
        return tmp_path

    return restamped


def block(name, folder):
    return filled(f"<!-- measured:{name} -->\n<!-- end -->\n", [folder], "page")


@pytest.mark.parametrize(
    ("old", "new"), [("2.0", "3.0"), ("*", "/"), ("@njit", ""), ("law", "flow")]
)
def test_what_computes_outdates_it(tmp_path, old, new):
    file = tmp_path / "law.py"
    file.write_text(KERNEL)
    before = digest_of(tmp_path)
    file.write_text(KERNEL.replace(old, new))
    assert digest_of(tmp_path) != before


@pytest.mark.parametrize(
    "name", [name for name, given in BLOCKS.items() if given["stage"] != "document"]
)
def test_a_block_says_where_it_is_of_other_kernels(name, results):
    said = block(name, results(OTHER))
    assert said.count("an earlier version") == said.count(SENTENCE) == 1
    assert said.replace(f"\n{SENTENCE}", "") == block(name, results(stamps.kernels_digest()))


def test_results_of_other_kernels_are_found(results):
    folder = results(stamps.kernels_digest())
    assert stamps.outdated(folder) == {}
    (folder / "unstamped.json").write_text("{}")
    mutants = json.loads((folder / "mutants.json").read_text())
    next(iter(mutants.values()))["kernels"] = OTHER
    (folder / "mutants.json").write_text(json.dumps(mutants))
    assert stamps.outdated(folder) == {"mutants.json": [OTHER], "unstamped.json": ["unknown"]}
