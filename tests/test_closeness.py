"""The suite's one comparison allows what it is told, and nothing else."""

import numpy as np
import pytest
from closeness import close


@pytest.mark.parametrize(
    ("found", "exact", "rel", "scale"),
    [
        (1e-300, 0.0, 1e-3, 0.0),
        (1.0 + 2e-12, 1.0, 1e-12, 0.0),
        (2e-12, 0.0, 1e-12, 1.0),
        (np.nan, 1.0, 1.0, 0.0),
        (np.inf, -np.inf, 1.0, 0.0),
        ([1.0, 2.0], [1.0, 2.0, 3.0], 1e-3, 0.0),
        ([], [], 1.0, 1.0),
        (1.0 + 1e-3j, 1.0, 1e-4, 0.0),
    ],
)
def test_what_is_not_allowed_is_refused(found, exact, rel, scale):
    with pytest.raises(AssertionError):
        close(found, exact, rel, scale=scale)


@pytest.mark.parametrize(
    ("found", "exact", "rel", "scale"),
    [
        (0.0, -0.0, 0.0, 0.0),
        (np.nan, np.nan, 0.0, 0.0),
        (np.inf, np.inf, 0.0, 0.0),
        ([1.0, 1.0 + 9e-13], 1.0, 1e-12, 0.0),
        ([[1.0, 9e-10]], [[1.0, 0.0]], 1e-9, [[1.0, 1.0]]),
    ],
)
def test_what_is_allowed_passes(found, exact, rel, scale):
    assert close(found, exact, rel, scale=scale)
