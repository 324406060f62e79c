"""Random inputs (io/sampling.py): designs, distributions, and what is refused."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

import viscoroll as vr
from viscoroll import sampling
from viscoroll.io.sampling import Sample, sample


@pytest.mark.parametrize("design", ["random", "latin", "sobol"])
def test_sampling_is_reproducible(design):
    quantities = {"V0": stats.uniform(-1.0, 2.0), "omega0": stats.norm(0.5, 0.1), "mu": 0.2}
    first, again, other = (sample(64, seed=seed, design=design, **quantities) for seed in (3, 3, 4))
    assert isinstance(first, Sample)
    assert (first.seed, first.design) == (3, design)
    assert list(first) == ["V0", "omega0", "mu"]
    for name in first:
        assert first[name].shape == (64,)
        assert np.array_equal(first[name], again[name])
    assert not np.array_equal(first["V0"], other["V0"])
    assert np.all(first["mu"] == 0.2)
    assert np.all(abs(first["V0"]) <= 1.0)
    assert not np.array_equal(first["V0"], first["omega0"])


def test_no_draw_lies_on_the_edge(monkeypatch):
    """Of as many points as a Sobol sequence has one has the coordinate 0, whose normal draw would be infinite."""
    monkeypatch.setattr(sampling, "_BITS", 6)
    sampling._sequence.cache_clear()
    drawn = sample(64, seed=0, design="sobol", V0=stats.norm(), omega0=stats.uniform())
    sampling._sequence.cache_clear()
    assert np.all(np.isfinite(drawn["V0"]))
    for u in (stats.norm.cdf(drawn["V0"]), drawn["omega0"]):
        assert np.array_equal(np.sort(np.floor(64 * u + 0.25)), np.arange(64))


@pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")  # the paper's own scene is beyond the model
def test_a_sample_feeds_an_ensemble():
    drawn = sample(8, seed=5, design="sobol", V0=stats.uniform(0.5, 1.0), omega0=0.5, mu=stats.uniform(0.1, 0.2))
    result = vr.ensemble(vr.presets.PAPER_SECTION_5.replace(mu=drawn["mu"]), drawn["V0"], drawn["omega0"], [0.0, 3e-3])
    assert result.messages() == {vr.MotionStatus.DONE.message: 8}


def test_a_generator_in_place_of_a_seed():
    """As SciPy takes it: it moves on, and what was drawn can be drawn again by its seed."""
    generator = np.random.default_rng(7)
    one, other = (sample(4, rng=generator, V0=stats.uniform()) for _ in range(2))
    assert not np.array_equal(one["V0"], other["V0"])
    assert np.array_equal(one["V0"], sample(4, rng=7, V0=stats.uniform())["V0"])
    assert np.array_equal(one["V0"], sample(4, seed=one.seed, V0=stats.uniform())["V0"])
