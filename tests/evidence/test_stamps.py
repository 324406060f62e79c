"""Results say of which kernels they are, and pages where those are not this tree's."""

import json
import re

import pytest
from places import RESULTS

from pipeline.evidence.document.__main__ import BLOCKS, filled
from pipeline.evidence.results import kernels_digest, outdated

OTHER = "0123456789abcdef"
SENTENCE = "Measured with an earlier version of the compiled code, source hash `01234567`.\n"


KERNEL = '@njit\ndef law(x):\n    """Doubled."""\n    return 2.0 * x\n'
digest_of = kernels_digest.__wrapped__


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
    "old, new, outdates",
    [
        ("2.0", "3.0", True),
        ("*", "/", True),
        ("@njit", "", True),
        ("law", "flow", True),
        ("Doubled", "Twice the number", False),
        ("\n    return", "  # a comment\n\n    return", False),
    ],
)
def test_what_computes_outdates_a_result_words_do_not(tmp_path, old, new, outdates):
    file = tmp_path / "law.py"
    file.write_text(KERNEL)
    before = digest_of(tmp_path)
    file.write_text(KERNEL.replace(old, new))
    assert (digest_of(tmp_path) != before) == outdates


@pytest.mark.parametrize(
    "name", [name for name, given in BLOCKS.items() if given["stage"] != "document"]
)
def test_a_block_says_where_it_is_of_other_kernels(name, results):
    said = block(name, results(OTHER))
    assert said.count("an earlier version") == said.count(SENTENCE) == 1
    assert said.replace(f"\n{SENTENCE}", "") == block(name, results(kernels_digest()))


def test_results_of_other_kernels_are_found(results):
    folder = results(kernels_digest())
    assert outdated(folder) == {}
    (folder / "unstamped.json").write_text("{}")
    mutants = json.loads((folder / "mutants.json").read_text())
    next(iter(mutants.values()))["kernels"] = OTHER
    (folder / "mutants.json").write_text(json.dumps(mutants))
    assert outdated(folder) == {"mutants.json": [OTHER], "unstamped.json": ["unknown"]}
