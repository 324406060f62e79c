"""The transient solver behind "may I use this law?": contact at rest and run in, and the errors of that page."""

from __future__ import annotations

import json
import re

import numpy as np
import pytest
import tolerances as tol
from closeness import close
from places import DOCS, RESULTS

import viscoroll as vr
from pipeline.prove import transient


def test_run_in_it_is_the_steady_contact():
    imprint = transient.steadily(transient.Imprint(0.04), transient.V0)
    c = vr.contact(transient.scene_of(1.0), transient.V0, delta=0.0)
    assert close(imprint.M, c.M, rel=tol.TRANSIENT_M)
    assert close(0.5 * imprint.p.size * imprint.h, c.lam, rel=imprint.h, scale=1.0)
    assert close(imprint.p.sum() * imprint.h, 0.5 * np.pi, rel=1e-12)


def test_at_rest_it_is_hertz():
    imprint = transient.Imprint(0.04)
    x = (imprint.first + np.arange(imprint.low, imprint.high)) * imprint.h
    assert close(imprint.M, 0.0, rel=1e-12, scale=1.0)
    assert close(imprint.p, np.sqrt(np.maximum(1.0 - x * x, 0.0)), rel=imprint.h, scale=1.0)


@pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")  # a fifth of this way is too slow for the law
def test_errors_are_those_of_finer_cells():
    """gamma 10.7 by cells of half the size: 0.092 and 0.100 were found with 0.01."""
    found = transient.rows_of(transient.curves(0.04, (10.7,)))[0]
    assert close(found["nu"], 0.0232, rel=0.005)
    assert close(found["steady"], 0.092, rel=tol.TRANSIENT_ERROR, scale=1.0)
    assert close(found["rest"], 0.100, rel=tol.TRANSIENT_ERROR, scale=1.0)


def test_the_page_states_what_is_kept():
    page = (DOCS / "may_i.md").read_text(encoding="utf-8")
    row_of = r"^\| ([\d.]+) \| ([\d.]+) \| ([\d.]+) %.*?\| ([\d.]+) %"
    stated = {float(gamma): list(map(float, rest)) for gamma, *rest in re.findall(row_of, page, re.M)}
    rows = json.loads((RESULTS / "transient.json").read_text(encoding="utf-8"))["rows"]
    assert [row["gamma"] for row in rows] == list(stated)
    for row in rows:
        nu, steady, rest = stated[row["gamma"]]
        assert close(row["nu"], nu, rel=0.05, what=row)
        assert close(100.0 * row["steady"], steady, rel=0.1, what=row)
        assert close(100.0 * row["rest"], rest, rel=0.1, what=row)
