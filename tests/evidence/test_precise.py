"""Motions in extended precision: the integrator, and the check motions made again by it."""

import math

import numpy as np
import pytest
from truth.test_driven import MOTIONS as DRIVEN
from truth.test_motions import check_motions, inputs

from pipeline.evidence.truth import roll_precise
from pipeline.evidence.truth.motion import PATHS
from pipeline.evidence.truth.reference import driven_motion

pytestmark = pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")  # the paper's own scene is beyond the model

OUTPUTS = ("V", "omega", "x", "angle")


@pytest.mark.parametrize("number", [0, 9, 10, 37])
def test_check_motions_are_found_again(number):
    """The same doubles as by an integrator in other unknowns, which made them: IC1, two of large alpha, one of 1."""
    rows = check_motions()[number]
    motion = roll_precise(*inputs(rows), nodes=18, tolerance=1e-19)
    for name in OUTPUTS:
        assert [float(value) for value in getattr(motion, name)] == [row[name] for row in rows]
    assert np.array_equal(float(motion.onset_time or math.nan), rows[0]["onset_time"], equal_nan=True)
    assert len(motion.switches) == rows[0]["switches"]


@pytest.mark.parametrize("name", ["pushed from rest", "slid off rest by a torque", "a jump there and back"])
def test_driven_ones_are_found_again(name):
    """The same doubles by fewer nodes and a larger tolerance."""
    row = next(row for row in DRIVEN if row["name"] == name)
    case = driven_motion(row)
    found = roll_precise(*case[:3], row["t"], **case.drive, nodes=18, tolerance=1e-19)
    for field in ("V", "omega", *PATHS):
        assert [float(value) for value in getattr(found, field)] == row[field], field
