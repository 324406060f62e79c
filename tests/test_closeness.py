"""The suite's one comparison allows nothing but what it is told.

That it allows this much, NaN for NaN and infinity for infinity, all other tests show.
"""

import numpy as np
import pytest
from closeness import close


def test_what_is_not_allowed_is_refused():
    for found, exact, rel, scale in (
        (1e-300, 0.0, 1e-3, 0.0),
        (1.0 + 2e-12, 1.0, 1e-12, 0.0),
        (2e-12, 0.0, 1e-12, 1.0),
        (np.nan, 1.0, 1.0, 0.0),
        (np.inf, -np.inf, 1.0, 0.0),
        ([1.0, 2.0], [1.0, 2.0, 3.0], 1e-3, 0.0),
        ([], [], 1.0, 1.0),
        (1.0 + 1e-3j, 1.0, 1e-4, 0.0),
    ):
        with pytest.raises(AssertionError):
            close(found, exact, rel, scale=scale)
