"""The check motions, of extended precision, hold together; ``roll`` has them by the claims of
``test_claims.py``.
"""

import json
from itertools import groupby
from operator import itemgetter

import tolerances as tol

from pipeline.evidence.prove.cases import DRIVEN, FREE
from pipeline.stage import read_rows

FREE_MOTIONS = [list(rows) for _, rows in groupby(read_rows(FREE), itemgetter("motion"))]
DRIVEN_MOTIONS = json.loads(DRIVEN.read_text(encoding="utf-8"))["motions"]


def test_free_motions_hold_together():
    """Fifty motions, each shown to 1e-17 by a second one."""
    assert len(FREE_MOTIONS) == 50
    assert max(row["difference"] for rows in FREE_MOTIONS for row in rows) < tol.PRECISE_MOTION
    assert {rows[0]["switches"] for rows in FREE_MOTIONS} >= {0.0, 1.0, 2.0}


def test_driven_motions_hold_together():
    """Thirty motions, each shown to 1e-17 by a second one; every regime and V = 0 in stick and in
    slip among them.
    """
    assert len(DRIVEN_MOTIONS) == 30
    assert max(row["difference"] for row in DRIVEN_MOTIONS) < tol.PRECISE_MOTION
    regimes = {regime for row in DRIVEN_MOTIONS for _, regime in row["switches"]}
    assert regimes == {"full slip", "partial slip", "locked", "held"}
    assert sum(bool(row["reversals"]) for row in DRIVEN_MOTIONS) >= 6
    drives = {name for row in DRIVEN_MOTIONS for name in row["drive"]}
    assert drives == {"force", "torque", "slope", "brake", "V", "omega"}
