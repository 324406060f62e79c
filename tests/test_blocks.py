"""Elements of broadcast arrays by blocks, and blocks on threads (core/arrays.py)."""

import threading

import pytest
from refusals import refused

from viscoroll.core.arrays import available_cores, run_blocks, thread_count


@pytest.mark.parametrize("threads", ["two", "0", "-5", "1.5"])
def test_a_number_of_threads_that_is_none(monkeypatch, threads):
    monkeypatch.setenv("VISCOROLL_THREADS", threads)
    refused(thread_count, f"VISCOROLL_THREADS = '{threads}': must be a whole number >= 1")
    refused(lambda: run_blocks(lambda start, stop: None, 2, 100), "VISCOROLL_THREADS")
    monkeypatch.setenv("VISCOROLL_THREADS", "")
    assert thread_count() == available_cores()


def test_blocks_after_an_error_are_not_begun():
    begun = []
    lock = threading.Lock()

    def work(start, stop):
        with lock:
            begun.append(start)
        if start == 10:
            raise ValueError("block 10")

    with pytest.raises(ValueError, match="block 10"):
        run_blocks(work, 100_000, 1, threads=2)
    assert len(begun) < 1000
