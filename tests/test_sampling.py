"""Random inputs (sampling.py): designs, distributions, and what is refused."""

from functools import partial

import numpy as np
import pytest
from scipy import stats

from viscoroll.sampling import sample


@pytest.mark.parametrize("design", ["random", "latin", "sobol"])
def test_a_generator_in_place_of_a_seed(design):
    """As SciPy takes it: it moves on, and what was drawn can be drawn again by its seed."""
    drawn = partial(sample, 64, design=design, V0=stats.uniform(), mu=0.2)
    generator = np.random.default_rng(7)
    one, other = (drawn(rng=generator) for _ in range(2))
    assert (one.design, *one) == (design, "V0", "mu")
    assert np.all(one["mu"] == 0.2)
    assert not np.array_equal(one["V0"], other["V0"])
    for again in (drawn(rng=7), drawn(seed=one.seed)):
        assert np.array_equal(one["V0"], again["V0"])
