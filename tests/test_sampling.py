"""Random inputs (sampling.py): designs, distributions, and what is refused."""

from functools import partial

import numpy as np
import pytest
from scipy import stats

from viscoroll import sampling
from viscoroll.sampling import sample


def test_no_draw_lies_on_the_edge(monkeypatch):
    """Of as many points as a Sobol sequence has one has the coordinate 0, whose normal draw would
    be infinite.
    """
    monkeypatch.setattr(sampling, "_BITS", 6)
    sampling._sequence.cache_clear()
    drawn = sample(64, seed=0, design="sobol", V0=stats.norm(), omega0=stats.uniform())
    sampling._sequence.cache_clear()
    assert np.all(np.isfinite(drawn["V0"]))
    for u in (stats.norm.cdf(drawn["V0"]), drawn["omega0"]):
        assert np.array_equal(np.sort(np.floor(64 * u + 0.25)), np.arange(64))


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
