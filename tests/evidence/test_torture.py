"""A short sample of `make torture`, and the results that are kept of the long one."""

import json

import pytest
from places import full_sizes, kept
from processes import made

COMMITTED = kept("torture.json")
#: seconds of the processor that a load may take, and MB that a process may take in all; issue and RLIMIT_AS
SLOWEST, MOST_MEMORY = 5.0, 1000.0


@pytest.fixture(scope="module")
def quick(tmp_path_factory: pytest.TempPathFactory) -> list[dict]:
    output = tmp_path_factory.mktemp("torture") / "torture.json"
    made("evidence.torture", "--quick", "--only", "tables", "-o", output)
    return json.loads(output.read_text())["parts"]["tables"]["rows"]


def test_nothing_goes_unnoticed(quick: list[dict]) -> None:
    assert [(row["done"], row["how"]) for row in quick if row["wrong"]] == []


def test_damage_is_done(quick: list[dict]) -> None:
    """A sealed file is hardly ever unharmed: a flip must hit the few bytes that make a seal one."""
    rows = {row["done"]: row for row in quick}
    for name in ("one bit flipped", "1-16 bytes of headers and B-trees replaced"):
        assert rows[name]["refused"] >= 0.9 * rows[name]["tried"]


def test_committed_results_are_of_the_long_run() -> None:
    section = full_sizes("torture")
    parts = COMMITTED["parts"]
    assert set(parts) == {"tables", "ensembles"}
    for name, part in parts.items():
        assert part["sizes"].items() <= section.items(), name
    for row in (row for part in parts.values() for row in part["rows"]):
        assert row["tried"] > 0
        assert row["wrong"] == 0
        assert (row["slowest_s"] or 0.0) < SLOWEST
        assert (row["peak_mb"] or 0.0) < MOST_MEMORY
