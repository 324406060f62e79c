"""`make release-check`: sound packages pass, and each planted fault is told."""

import pytest

from pipeline.evidence import release
from pipeline.evidence.results import RESULTS
from pipeline.evidence.stamps import outdated


@pytest.fixture(scope="module")
def packages(tmp_path_factory):
    return release.built(tmp_path_factory.mktemp("release"))


def problems(check, packages):
    return "; ".join(release.CHECKS[check](packages))


def test_the_packages_of_this_tree_pass(packages):
    """But for numbers of other kernels, which are measured again for a release."""
    told = {name: problems(name, packages) for name in release.CHECKS}
    measured = told.pop("measured numbers")
    assert told == dict.fromkeys(told, "")
    assert all(name in measured for name in outdated(RESULTS))


def test_planted_faults_are_told(packages):
    texts = packages.texts | {"CITATION.cff": "version: 0.0.1\n", "data/materials/README.md": ""}
    wrong = packages._replace(
        texts=texts,
        wheel=[name for name in packages.wheel if not name.endswith("viscoroll/rollers.py")]
        + ["viscoroll/x.tmp"],
        sdist=packages.sdist | {"docs/_build/html/index.html": 1, "big.csv": 10**8},
    )
    told = problems("metadata", wrong)
    assert "CITATION.cff does not name version" in told
    assert "CITATION.cff has no date-released" in told
    told = problems("contents", wrong)
    for each in (
        "lacks viscoroll/rollers.py",
        "ships viscoroll/x.tmp",
        "ships docs/_build/html/index.html",
        "100.0 MB",
    ):
        assert each in told
    assert "has no licence" in problems("licences", wrong)
