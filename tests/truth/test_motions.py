"""Motions in extended precision; ``roll`` has them by the claims of ``test_claims.py``."""

import csv

import pytest
import tolerances as tol
from places import ROOT

import viscoroll as vr

pytestmark = pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")  # the paper's own scene is beyond the model

CHECK_MOTIONS = ROOT / "data/reference/check_motions.csv"
PARAMETERS = ("alpha", "kappa", "mu", "gamma", "j")
OUTPUTS = ("V", "omega", "x", "angle")


def check_motions() -> list[list[dict[str, float]]]:
    """Rows of every motion."""
    with CHECK_MOTIONS.open(encoding="utf-8", newline="") as file:
        rows = [{name: float(text) for name, text in row.items()} for row in csv.DictReader(file)]
    return [[row for row in rows if row["motion"] == number] for number in sorted({row["motion"] for row in rows})]


def inputs(rows: list[dict[str, float]]) -> tuple:
    first = rows[0]
    return vr.Scene(*(first[name] for name in PARAMETERS)), first["V0"], first["omega0"], [row["t"] for row in rows]


def test_check_motions_hold_together():
    """Fifty motions, each shown to 1e-17 by a second one."""
    motions = check_motions()
    assert len(motions) == 50
    assert max(row["difference"] for rows in motions for row in rows) < tol.PRECISE_MOTION
    assert {rows[0]["switches"] for rows in motions} >= {0.0, 1.0, 2.0}
