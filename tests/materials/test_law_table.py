"""Tables of the law: how they are shared, and elastic contacts."""

from concurrent.futures import ThreadPoolExecutor

import viscoroll as vr
from viscoroll.laws.law_table import law_table

SOFT = vr.Prony([2.0, 5.0], [1.0, 1e-3])


def test_a_table_is_made_once_and_shared():
    with ThreadPoolExecutor(4) as pool:
        tables = [*pool.map(law_table, [vr.Prony([1.5, 0.25], [1.0, 0.125])] * 4)]
    assert all(table is tables[0] for table in tables)
    assert law_table(tables[0]) is tables[0]
    assert law_table(vr.Bodies(SOFT, SOFT)) is law_table(SOFT)
    for values in (
        tables[0].coefficients,
        tables[0].steady_coefficients,
        tables[0].fast_limit,
        tables[0].record.rows,
    ):
        assert not values.flags.writeable
