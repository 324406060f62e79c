"""A short sample of `make torture`, and the results that are kept of the long one."""

from places import kept

from pipeline.evidence.results import rows_of

#: seconds of the processor that a load may take, and MB that a process may take in all; issue and
#: RLIMIT_AS
SLOWEST = 5.0
MOST_MEMORY = 1000.0


def test_nothing_went_unnoticed_in_the_long_run():
    parts = kept("torture.json")["parts"]
    assert set(parts) == {"tables", "ensembles"}
    for row in rows_of(parts):
        assert row["tried"] > 0
        assert row["wrong"] == 0
        assert (row["slowest_s"] or 0.0) < SLOWEST
        assert (row["peak_mb"] or 0.0) < MOST_MEMORY
