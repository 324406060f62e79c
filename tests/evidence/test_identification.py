"""What measurements tell: the stage at its quick size, and what the committed numbers promise."""

import json

import tolerances as tol
from closeness import close
from experiments import TRUTH, roller, traction
from places import kept
from processes import made

import viscoroll as vr
from pipeline.evidence.measure.identification import PARTS, complaint
from pipeline.evidence.results import rows_of


def test_stage_plans_an_experiment(tmp_path):
    made(
        "evidence.measure.identification",
        "--quick",
        "--only",
        "learn",
        "-o",
        tmp_path / "identification.json",
    )
    (row, *_) = json.loads((tmp_path / "identification.json").read_text())["parts"]["learn"]["rows"]
    committed = committed_rows("learn")[0]
    found = row.pop("unknowns")
    known = committed.pop("unknowns")
    assert row == committed
    for name, one in known.items():
        for key, value in one.items():
            assert found[name][key] == value is None or close(
                found[name][key], value, tol.INTERVAL
            ), (name, key)


def committed_rows(part):
    return kept("identification.json")["parts"][part]["rows"]


def test_committed_numbers_hold():
    parts = kept("identification.json")["parts"]
    assert parts.keys() <= PARTS.keys()
    assert [text for row in rows_of(parts) if (text := complaint(row))] == []
    assert len(committed_rows("said")) == 6


# --- profiles of wide ranges take minutes ---

WIDE = {"mu": (3e-3, 30.0), "E": (3e4, 3e8), "E_1": (0.09, 900.0), "T_ref": (1e-5, 1e-1)}


def test_an_end_that_a_range_makes_is_told():
    """Q at two speeds: mu and E, and of E_1 and T_ref hardly more than their product."""
    fit = vr.identify(roller(), WIDE, [traction((0.1, 1.0), seed=0)], starts=2)
    assert fit.undetermined == ("E_1", "T_ref")
    low, high = fit.intervals()["E_1"]
    assert low < TRUTH["E_1"]
    assert high is None
    said = str(fit)
    assert "the interval of E_1 has no upper end" in said
    assert "the best fit has E_1 at the end of its range" in said
    assert "the range of E_1, not the data, determines" in said


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


def test_ends_of_an_interval_are_seen_from_what_fits_of_other_unknowns():
    """Q at one speed: along T_ref at its bound a softer roller fits; the walk from the best fit
    never comes there.
    """
    data = [traction((0.1,), seed=0)]
    fit = vr.identify(roller(), WIDE, data, starts=1)
    low, high = fit.intervals()["E"]
    assert low < 0.9 * TRUTH["E"]
    others = {name: span for name, span in WIDE.items() if name != "E"}
    for end in (low, high):
        held = [
            vr.identify(
                roller(**fit.values | {"E": end, "E_1": E_1, "T_ref": T_ref}),
                others,
                data,
                starts=1,
            ).chi2
            for E_1, T_ref in ((9.0, 1e-3), (0.8, 0.099))
        ]
        assert close(min(held) - fit.chi2, 3.841, tol.INTERVAL)
