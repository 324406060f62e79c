"""The law outside Python at its quick size, and what the committed numbers promise."""

import tolerances as tol
from places import kept


def test_committed_numbers_hold():
    committed = kept("outside.json")
    assert committed["page"]["error"] < tol.INTEROP
    assert committed["page"]["median_ms"] < 20.0
