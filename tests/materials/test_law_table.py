"""Tables of the law: every function of every row against 60 digits, its limits, and how they are shared."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from typing import Any

import mpmath as mp
import numpy as np
import pytest
import tolerances as tol
from closeness import close
from refusals import refused

import viscoroll as vr
from pipeline.evidence.prove.series import any_state, state_errors
from pipeline.evidence.truth import series as raw
from viscoroll.materials.law_axis import LawAxis, law_axis
from viscoroll.materials.law_table import FUNCTIONS, LawTable, law_table

DIGITS = 60
SOFT, STIFF = vr.Prony([2.0, 5.0], [1.0, 1e-3]), vr.Prony([4.0, 1.0, 0.3], [0.2, 2e-4, 1e-7])
UNLIKE = vr.Bodies(SOFT, STIFF, 0.3)


def random_series(seed: int, modes: int, decades: float) -> vr.Prony:
    draw = np.random.default_rng(seed)
    return vr.Prony(10.0 ** draw.uniform(-1.5, 1.5, modes), 10.0 ** draw.uniform(-decades, 0.0, modes))


MATERIALS: dict[str, Any] = {
    **{f"alpha {alpha:g}": alpha for alpha in (1.0 + 1e-9, 1.01, 11.0, 28.0, 300.0, 1e6)},
    "four modes": random_series(1, 4, 3.0),
    "six modes, 14 decades": random_series(2, 6, 14.0),
    "two bodies": UNLIKE,
    "a rigid base": vr.Bodies(SOFT, vr.Prony.elastic(), 1.0),
}


def at(table: LawTable, name: str, x: float) -> float:
    """A function of the table, by its file's own rule."""
    mantissa, exponent = np.frexp(x)
    row = max(exponent - table.e0, 0)
    t = x * 2.0**-table.e0 if row == 0 else 4.0 * mantissa - 3.0
    return float(np.polynomial.polynomial.polyval(t, table.coefficients[row, :, FUNCTIONS.index(name)]))


ALPHAS = (1.0 + 2.0**-52, 1.0 + 1e-9, 1.9, 2.0, 11.0, 27.0, 300.0, 4096.0, 2.0**20 - 1.0, 2.0**20)
ROWS = [*MATERIALS.values(), *ALPHAS]


@pytest.fixture(scope="module")
def axis() -> LawAxis:
    return law_axis(1.0, 2.0**20)


@pytest.mark.parametrize("n", range(len(ROWS)), ids=[*MATERIALS, *(f"axis at {alpha!r}" for alpha in ALPHAS)])
def test_against_60_digits(axis, n):
    """Rows of a material's own, and those of an alpha from the axis."""
    given, by_axis = ROWS[n], n >= len(MATERIALS)
    table, allowed = (axis.at(given), tol.AXIS_LAW) if by_axis else (law_table(given), tol.TABLE_LAW)
    places = np.random.default_rng(5).uniform(table.e0 - 4.0, table.e0 + len(table.coefficients) - 1.5, 10)
    with mp.workdps(DIGITS + 20):
        known = raw.rates_of(mp, given)
        for x in 2.0**places:
            z = 1 / mp.mpf(x)
            g, h, m, _ = raw.functions(mp, known, z)
            square, F = 1 + 2 * h / z, z + g
            u, v = float(1 / (2 * z * mp.sqrt(square))), float(1 / F)
            exact = {"lam": 1 / mp.sqrt(square), "epsilon": g / z, "share": z / F, "press": square * (z / F) ** 2}
            for function, truth in exact.items():
                found = at(table, function, v if function in ("share", "press") else u)
                bound = {"lam": tol.CONTACT_LENGTH, "epsilon": tol.CONTACT_SHIFT}.get(function, allowed)
                bound = max(bound, tol.CONTACT_SHIFT) if by_axis and function == "lam" else bound
                assert close(found, float(truth), rel=bound), (function, x)
            both = at(table, "m_half_space", u) + at(table, "m_cylinder", u)
            assert close(both, float(m), rel=allowed), x


def test_unsteady_term_of_the_axis_is_that_of_the_material(axis):
    for alpha in ALPHAS:
        N, own = (table.coefficients[:, :, FUNCTIONS.index("N")] for table in (axis.at(alpha), law_table(alpha)))
        t = np.array([-0.9, 0.1, 0.8])
        rows = range(1, len(own))
        found, exact = (np.array([np.polynomial.polynomial.polyval(t, c[row]) for row in rows]) for c in (N, own))
        assert close(found, exact, rel=tol.AXIS_UNSTEADY, scale=np.abs(exact).max()), alpha
    assert axis.at(1.0) is law_table(1.0)


#: the fields of a state
BOUNDS = dict.fromkeys(("delta_star", "Q", "M", "M_half_space", "M_cylinder"), tol.CONTACT) | {
    "lam": tol.CONTACT_LENGTH, "epsilon": tol.CONTACT_SHIFT, "beta": tol.CONTACT_LENGTH,
    "dQ_dV": tol.SLOPE, "dQ_ddelta": tol.SLOPE, "dM_dV": tol.SLOPE_OF_M,
}  # fmt: skip


@pytest.mark.parametrize("name", [*MATERIALS, "thirty modes, 14 decades"])
def test_states_against_60_digits(name):
    """Speeds from 1e-14 over the slowest time to 1e14 over the fastest, creep from 1e-14 delta_star on."""
    given = (MATERIALS | {"thirty modes, 14 decades": random_series(3, 30, 14.0)})[name]
    draw = np.random.default_rng(7)
    with mp.workdps(DIGITS + 20):
        known = raw.rates_of(mp, given)
        for _ in range(3 if len(known.a) > 20 else 10):
            at = any_state(draw, known)
            for field, error in state_errors(given, known, *at).items():
                assert error <= BOUNDS[field], (field, at)


def test_an_elastic_contact_is_closed_form():
    for given in (1.0, vr.Prony.elastic(), vr.Bodies(vr.Prony.elastic(), vr.Prony.elastic(), 0.3)):
        table = law_table(given)
        assert table.coefficients.shape == (1, 24, 7)
        assert table.coefficients[0, 0].tolist() == [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0]
        assert not table.coefficients[0, 1:].any()


def test_a_table_is_made_once_and_shared():
    with ThreadPoolExecutor(4) as pool:
        tables = [*pool.map(law_table, [vr.Prony([1.5, 0.25], [1.0, 0.125])] * 4)]
    assert all(table is tables[0] for table in tables)
    assert law_table(tables[0]) is tables[0]
    assert law_table(vr.Bodies(SOFT, SOFT)) is law_table(SOFT)
    for values in (tables[0].coefficients, tables[0].given_coefficients, tables[0].fast_limit, tables[0].record.rows):
        assert not values.flags.writeable


def test_a_rigid_body_takes_nothing():
    table = law_table(MATERIALS["a rigid base"])
    assert not table.coefficients[:, :, FUNCTIONS.index("m_half_space")].any()


def test_the_unit_of_time_is_an_exponent():
    """Times longer by 2^k move the rows by k, and nothing else but M/V, which is a time, and N, its square."""
    here, there = law_table(UNLIKE), law_table(vr.Bodies(SOFT.slower(2.0**60), STIFF.slower(2.0**60), 0.3))
    assert there.e0 == here.e0 - 60
    for power, name in zip((0, 0, 1, 1, 2, 0, 0), FUNCTIONS, strict=True):
        for x in 2.0 ** np.random.default_rng(6).uniform(here.e0 - 2.0, here.e0 + len(here.coefficients) - 1.5, 40):
            exact, scale = at(here, name, x), max(abs(at(here, name, 0.0)), 1.0) if name == "N" else 0.0
            assert close(
                at(there, name, x * 2.0**-60) * 2.0 ** (-60 * power), exact, rel=tol.CONTACT_SHIFT, scale=scale
            )


def test_times_beyond_the_doubles_are_refused():
    text = refused(lambda: law_table(vr.Prony([1.0], [1e-120])))
    assert text.startswith("times = 1e-120 to ")
