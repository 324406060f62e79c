"""What measurements tell: what the committed numbers promise."""

from places import kept

from pipeline.evidence.measure.identification import PARTS, complaint
from pipeline.evidence.results import rows_of


def test_committed_numbers_hold():
    parts = kept("identification.json")["parts"]
    assert parts.keys() <= PARTS.keys()
    assert [text for row in rows_of(parts) if (text := complaint(row))] == []
    assert len(parts["said"]["rows"]) == 6
