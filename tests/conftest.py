"""Fixtures that tests of several folders share, and an environment of the suite's own."""

import os
import re
from contextlib import contextmanager

# a thread of BLAS that waits for another spins: where cores are busy a fit of a master curve takes
# ten times longer
os.environ["OPENBLAS_NUM_THREADS"] = "1"

import pytest

# what a user chose for other work does not reach the tests
os.environ.pop("VISCOROLL_THREADS", None)
# standard error is compared, and which test compiles depends on the state of the cache
os.environ["VISCOROLL_QUIET"] = "1"


def pytest_addoption(parser):
    parser.addoption(
        "--skips",
        metavar="WORDS",
        help="any test skipped for a reason without these words fails the run",
    )


def pytest_sessionfinish(session):
    """With --skips a test that nobody knows to be skipped counts as one that failed."""
    expected = session.config.option.skips
    reporter = session.config.pluginmanager.get_plugin("terminalreporter")
    if expected is None or reporter is None:  # a worker of xdist has none
        return
    reasons = [str(report.longrepr[2]) for report in reporter.stats.get("skipped", [])]
    if unexpected := {reason for reason in reasons if not re.search(expected, reason)}:
        reporter.write_line(
            "not expected to be skipped: " + "; ".join(sorted(unexpected)), red=True
        )
        session.exitstatus = pytest.ExitCode.TESTS_FAILED


@pytest.fixture(autouse=True)
def nothing_said_yet(monkeypatch):
    """What is said of a material once a process is said in each test."""
    monkeypatch.setattr("viscoroll.contact_mechanics.model_warnings._warned_records", set())


@pytest.fixture
def here(tmp_path, monkeypatch):
    """Files of a test are its own; their folder."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def two_speeds(monkeypatch):
    """The accuracy of M by a fit is found at two speeds, not at two a decade of its data."""
    monkeypatch.setattr("viscoroll.measurements.spectrum._SPEEDS", 0)


@contextmanager
def maps_in(folder):
    """Flow maps are written to and read from this folder alone."""
    from memory import forget  # the process that hands tests out needs none of the package

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("viscoroll.motion.flow.folder", lambda: folder)
        forget()
        yield
    forget()


@pytest.fixture
def own_maps(tmp_path):
    """Flow maps of a test are its own; compiled kernels stay where they are.  Their folder."""
    with maps_in(tmp_path / "maps"):
        yield tmp_path / "maps"


@pytest.fixture(scope="module")
def maps_of_this_file(tmp_path_factory):
    with maps_in(tmp_path_factory.mktemp("maps")):
        yield
