"""Tables of the law: how they are shared, elastic contacts, and the unit of time."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import tolerances as tol
from closeness import close

import viscoroll as vr
from viscoroll.materials.law_table import FUNCTIONS, LawTable, law_table

SOFT, STIFF = vr.Prony([2.0, 5.0], [1.0, 1e-3]), vr.Prony([4.0, 1.0, 0.3], [0.2, 2e-4, 1e-7])
UNLIKE = vr.Bodies(SOFT, STIFF, 0.3)


def at(table: LawTable, name: str, x: float) -> float:
    """A function of the table, by its file's own rule."""
    mantissa, exponent = np.frexp(x)
    row = max(exponent - table.e0, 0)
    t = x * 2.0**-table.e0 if row == 0 else 4.0 * mantissa - 3.0
    return float(np.polynomial.polynomial.polyval(t, table.coefficients[row, :, FUNCTIONS.index(name)]))


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
