"""Cases of a test that only ``make evidence`` runs.

A test is marked ``long`` if it takes seconds, and if ``make test`` still finds an ordinary defect
of its subject by another case or test.  No defect of pipeline/evidence/mutants.toml needs one of
them.
"""

import pytest


def long(*cases):
    """Return the values of a parametrised test with the marker ``long``."""
    return [pytest.param(case, marks=pytest.mark.long) for case in cases]
