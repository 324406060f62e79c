"""What measurements tell: the stage at its quick size, and what the committed numbers promise."""

from experiments import TRUTH, roller, traction
from places import kept

import viscoroll as vr
from pipeline.evidence.measure.identification import PARTS, complaint
from pipeline.evidence.results import rows_of


def committed_rows(part):
    return kept("identification.json")["parts"][part]["rows"]


def test_committed_numbers_hold():
    parts = kept("identification.json")["parts"]
    assert parts.keys() <= PARTS.keys()
    assert [text for row in rows_of(parts) if (text := complaint(row))] == []
    assert len(committed_rows("said")) == 6


# --- profiles of wide ranges take minutes ---

WIDE = {"mu": (3e-3, 30.0), "E": (3e4, 3e8), "E_1": (0.09, 900.0), "T_ref": (1e-5, 1e-1)}


def test_an_interval_reaches_over_its_branches():
    """A walk from the best fit, a narrow well, ends at its rim; the truth lies on the plateau
    behind it.

    By a dense scan chi2 rises by 2.91 up to the upper bound.
    """
    fit = vr.identify(roller(), WIDE, [traction((0.1, 1.0), seed=3)], starts=2)
    low, high = fit.intervals()["E_1"]
    assert low < TRUTH["E_1"]
    assert high is None
    assert fit.values["E_1"] < 0.1 * TRUTH["E_1"]
    assert "the interval of E_1 contains several branches of the fit" in str(fit)
