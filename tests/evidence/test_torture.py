"""A short sample of `make torture`, and the results that are kept of the long one."""

import json

from places import kept
from processes import made

from pipeline.evidence.results import rows_of

#: seconds of the processor that a load may take, and MB that a process may take in all; issue and
#: RLIMIT_AS
SLOWEST = 5.0
MOST_MEMORY = 1000.0


def test_nothing_goes_unnoticed(tmp_path):
    """A sealed file is hardly ever unharmed: a flip must hit the few bytes that make a seal one."""
    made("evidence.torture", "--quick", "--only", "tables", "-o", tmp_path / "torture.json")
    rows = {
        row["done"]: row
        for row in json.loads((tmp_path / "torture.json").read_text())["parts"]["tables"]["rows"]
    }
    assert [(name, row["how"]) for name, row in rows.items() if row["wrong"]] == []
    for name in ("one bit flipped", "1-16 bytes of headers and B-trees replaced"):
        assert rows[name]["refused"] >= 0.9 * rows[name]["tried"]


def test_nothing_went_unnoticed_in_the_long_run():
    parts = kept("torture.json")["parts"]
    assert set(parts) == {"tables", "ensembles"}
    for row in rows_of(parts):
        assert row["tried"] > 0
        assert row["wrong"] == 0
        assert (row["slowest_s"] or 0.0) < SLOWEST
        assert (row["peak_mb"] or 0.0) < MOST_MEMORY
