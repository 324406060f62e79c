"""What the proofs are made of; the claims themselves are in tests/test_claims.py."""

from __future__ import annotations

import csv
import json

from places import DATA
from processes import made, printed

CHECK_VALUES = DATA / "reference/check_values.csv"


def test_check_values_are_made_again(tmp_path):
    """The first states and motions, to the last digit, from the inputs that the files hold."""
    for what, count, name, lines in (("values", 40, "check_values.csv", 40), ("motions", 1, "check_motions.csv", 7)):
        made("evidence.truth.reference", what, "--count", count, "-o", tmp_path)
        again, kept = (
            [
                row | {"difference": ""}
                for row in csv.DictReader((folder / name).read_text(encoding="utf-8").splitlines())
            ]
            for folder in (tmp_path, CHECK_VALUES.parent)
        )
        assert again == kept[:lines]
    made("evidence.truth.reference", "driven", "--count", 1, "-o", tmp_path)
    again, kept = (
        json.loads((folder / "check_driven.json").read_text(encoding="utf-8"))["motions"][0]
        for folder in (tmp_path, CHECK_VALUES.parent)
    )
    assert again | {"difference": 0} == kept | {"difference": 0}


def test_a_planted_error_of_1e_9_fails_the_proof():
    """The proof of the ratios sees it wherever it reaches 10 ULP of the value.

    In higher orders a term is itself too small for that; tests/kernels/bessel/test_ratios.py fits every coefficient
    anew.
    """
    script = """
import flint
import numpy as np
from pipeline.evidence.prove import ratios as proof
from viscoroll.kernels.bessel import layout
from viscoroll.kernels.bessel import ratios
table = ratios._ROWS.reshape(-1)  # the bins come first
rng, seen, tried = np.random.default_rng(3), 0, 0
while tried < 60:
    number, order = int(rng.integers(len(layout.SEGMENTS))), int(rng.integers(5))
    segment = layout.SEGMENTS[number]
    octave, index = int(rng.integers(segment.low, segment.high)), int(rng.integers(layout.BINS))
    at = layout.segment_start(number) + ((octave - segment.low) * layout.BINS + index) * layout.COEFFICIENTS
    good = table[at + order]
    x = 2.0**octave * (1.0 + index / layout.BINS)
    with flint.ctx.workprec(120):
        size = {0: "r", 1: "r", 2: "k", 3: "k", 4: "i2"}[number]
        # above x = 2 (r) and z = 1 (k) the table holds x (1 - r) and z (1 - k)
        share = good * (0.5 / layout.BINS) ** order * (1.0 if number in (0, 2, 4) else 1.0 / x)
        value = table[at] if number in (0, 2, 4) else 1.0
        if 1e-9 * abs(share) < 10 * np.spacing(abs(value)):
            continue
        tried += 1
        assert dict(proof.compared(x))[size] <= proof.RATIO_ULP
        table[at + order] = good * (1.0 + 1e-9)
        seen += dict(proof.compared(x))[size] > proof.RATIO_ULP
        table[at + order] = good
print(seen, tried)
"""
    seen, tried = map(int, printed(script, NUMBA_DISABLE_JIT="1").split())
    assert seen == tried
