"""What the proofs are made of; the claims themselves are in tests/test_claims.py."""

import csv

from places import DATA

from data.reference import check_motions, check_values
from pipeline.evidence.prove.table import TABLE

CHECK_VALUES = DATA / "reference/check_values.csv"


def test_check_values_are_made_again(tmp_path):
    """The first states and motions, to the last digit, from the inputs that they hold; driven:
    ``test_precise.py``.
    """
    for make, count, name, lines in (
        (check_values.make, 40, "check_values.csv", 40),
        (check_motions.free, 1, "check_motions.csv", 7),
    ):
        make(tmp_path, count)
        again, kept = (
            [
                row | {"difference": ""}
                for row in csv.DictReader((folder / name).read_text().splitlines())
            ]
            for folder in (tmp_path, CHECK_VALUES.parent)
        )
        assert again == kept[:lines]


def test_draws_of_a_proof_are_its_own():
    """They follow from a key that no other proof has."""
    assert len({proof.key() for proof in TABLE}) == len(TABLE)
    first = [proof.random(1).integers(1 << 62) for proof in TABLE]
    assert len(set(first)) == len(TABLE)
    assert [proof.random(1).integers(1 << 62) for proof in TABLE[::-1]] == first[::-1]
