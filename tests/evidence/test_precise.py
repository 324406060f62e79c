"""Motions in extended precision: the check motions, and the integrator, which makes them again.

``roll`` has them by the claims of ``test_claims.py``.
"""

import json
import math
from itertools import groupby
from operator import itemgetter

import numpy as np
import pytest
import tolerances as tol

from data.reference.check_motions import roll_precise
from pipeline.evidence.truth.reference import DRIVEN, FREE, PATHS, driven_motion, free_motion
from pipeline.stage import read_rows

pytestmark = pytest.mark.filterwarnings(
    "ignore::viscoroll.ModelWarning"
)  # the paper's own scene is beyond the model

FREE_MOTIONS = [list(rows) for _, rows in groupby(read_rows(FREE), itemgetter("motion"))]
DRIVEN_MOTIONS = json.loads(DRIVEN.read_text(encoding="utf-8"))["motions"]


def found_again(case, values, names):
    """By fewer nodes and a larger tolerance, the same doubles."""
    motion = roll_precise(*case[:3], case.t.tolist(), **case.drive, nodes=18, tolerance=1e-19)
    for name in names:
        assert [float(value) for value in getattr(motion, name)] == list(values[name]), name
    return motion


def test_motions_hold_together():
    """Thirty and fifty motions, each shown to 1e-17 by a second one."""
    assert len(FREE_MOTIONS) == 50
    assert max(row["difference"] for rows in FREE_MOTIONS for row in rows) < tol.PRECISE_MOTION
    assert len(DRIVEN_MOTIONS) == 30
    assert max(row["difference"] for row in DRIVEN_MOTIONS) < tol.PRECISE_MOTION


@pytest.mark.parametrize("number", [0, 9, 10, 37])
def test_free_motions_are_found_again(number):
    """IC1, two of large alpha, one of 1; an integrator in other unknowns made them."""
    rows = FREE_MOTIONS[number]
    case, values = free_motion(rows)
    motion = found_again(case, vars(values), ("V", "omega", "x", "angle"))
    assert np.array_equal(float(motion.onset_time or math.nan), values.onset_time, equal_nan=True)
    assert len(motion.switches) == rows[0]["switches"]


@pytest.mark.parametrize(
    "name", ["pushed from rest", "slid off rest by a torque", "a jump there and back"]
)
def test_driven_motions_are_found_again(name):
    row = next(row for row in DRIVEN_MOTIONS if row["name"] == name)
    found_again(driven_motion(row), row, ("V", "omega", *PATHS))
