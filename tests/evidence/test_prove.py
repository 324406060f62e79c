"""What the proofs are made of; the claims themselves are in tests/test_claims.py."""

from pipeline.evidence.prove.cases import VALUES
from pipeline.evidence.truth import INPUTS, contact_enclosure
from pipeline.stage import read_rows


def test_check_values_are_the_doubles_nearest_to_enclosures():
    """The first states, to the last digit, from the inputs that they hold."""
    for row in read_rows(VALUES)[:40]:
        exact = contact_enclosure(*(row[name] for name in INPUTS))
        found = {name: float(value) for name, value in exact.items() if name in row}
        assert row == row | found
