"""Certified enclosures, and the digits of contact against check values made of them."""

from __future__ import annotations

import csv
import sys
from functools import partial

import flint
import mpmath as mp
import numpy as np
import pytest
import xarray as xr
from places import DATA
from refusals import refused

import viscoroll as vr
from pipeline.evidence.truth import contact_enclosure, contact_precise

CHECK_VALUES = DATA / "reference/check_values.csv"


# --- enclosures ---

STATES = [
    (11.0, 2.91, 0.2, 0.5, -0.01),
    (1e4, 29.1, 0.3, -1e3, 1e-6),
    (1.0 + 1e-8, 2.91, 0.2, 0.3, 0.02),
    (81.5, 29.1, 0.2, 1e-7, -0.0034),
    (1.0, 2.91, 0.2, 1.0, 0.01),
    (11.0, 2.91, 0.2, -0.5, -0.5),
    (1e6, 1.0, 1.0, 1e-3, 0.1),
]


def test_enclosures_hold_the_printed_law():
    """Reduced form in balls against the equations as printed in mpmath: no code in common but the series of K."""
    for state in STATES:
        balls, printed_law = contact_enclosure(*state), contact_precise(*state, digits=40)
        for name, value in printed_law.items():
            ball = balls[name]
            assert ball.is_zero() or ball.rel_accuracy_bits() >= 100, (name, state)
            with mp.workdps(60), flint.ctx.workdps(60):
                wide = ball + flint.arb(0, abs(ball) * flint.arb(10) ** -38)  # the digits of the printed one
                assert wide.contains(flint.arb(mp.nstr(value, 50))), (name, state)
        assert balls["full_slip"] == (printed_law["beta"] == 0), state


@pytest.mark.parametrize(("values", "package"), [(contact_enclosure, "flint"), (contact_precise, "mpmath")])
def test_bad_input_and_what_is_not_installed(values, package, monkeypatch):
    for bad in ((0.5, 1, 1, 1, 0), (2, 1, 1, 0.0, 0), (2, 1, 1, 1, float("nan")), (2, 1, 1, [1.0, 2.0], 0)):
        refused(partial(values, *bad))
    monkeypatch.setitem(sys.modules, package, None)
    with pytest.raises(vr.MissingDependencyError, match=package):
        values(11.0, 2.91, 0.2, 0.5, 0.01)


def test_creep_of_exactly_delta_star():
    """alpha = 1: delta_star is a double, and a creep of that is full slip, one ULP below it is not."""
    for delta, slip in ((0.25, True), (np.nextafter(0.25, 0.0), False)):
        assert contact_enclosure(1.0, 2.0, 1.0, 0.7, float(delta))["full_slip"] is slip


# --- check values ---


def check_rows() -> list[dict[str, float]]:
    with CHECK_VALUES.open(encoding="utf-8", newline="") as file:
        return [{name: float(text) for name, text in row.items()} for row in csv.DictReader(file)]


def test_check_values_sample_is_enclosed():
    """A sample of the file, each value the double nearest to its enclosure, and netCDF as CSV."""
    rows = check_rows()
    for row in rows[:: len(rows) // 60]:
        exact = contact_enclosure(*(row[name] for name in ("alpha", "kappa", "mu", "V", "delta")))
        for name, ball in exact.items():
            assert row[name] == float(ball), name
    with xr.open_dataset(CHECK_VALUES.with_suffix(".nc"), engine="h5netcdf") as data:
        assert set(data.data_vars) == set(rows[0])
        for name in rows[0]:
            assert np.array_equal(data[name], [row[name] for row in rows]), name
