"""Designs, distributions and summaries of runs, and what a run is expected to take."""

import itertools

import numpy as np
import pytest
import tolerances as tol
from closeness import close
from run_files import run_of
from scipy import stats
from scipy.stats import qmc

from viscoroll import sampling
from viscoroll.motion.summaries import QUANTITIES, Histogram, merge_summaries, summarise
from viscoroll.runs.run_store import roll_block
from viscoroll.runs.uncertain_inputs import Distribution, Inputs

pytestmark = pytest.mark.filterwarnings(
    "ignore::viscoroll.ModelWarning"
)  # the paper's own scene is beyond the model

RUN = """
preset = "paper-section-5"
[scene]
mu = { distribution = "lognorm", s = 0.3, scale = 0.2, truncate = [0.05, 0.6] }
[start]
V0 = { distribution = "uniform", loc = -2.0, scale = 4.0 }
omega0 = { distribution = "norm", scale = 0.5 }
[run]
n = 2560
t = { low = 0.0, high = 3e-3, count = 3 }
rtol = 1e-6
block = 512
summaries = [
  "V", "omega", "x", "distance", "translation", "rotation", "lost", "lost_to_slip", "lost_to_rolling", "onset_time",
]
"""  # noqa: E501


# --- designs ---

each_design = pytest.mark.parametrize("design", ["random", "latin", "sobol"])


def points_of_blocks(design, seed, n, dimensions, edges):
    """The points of these blocks of a design, one block after the other."""
    return [sampling.points(design, seed, n, dimensions, *edge, b) for b, edge in enumerate(edges)]


def test_a_latin_hypercube_fills_every_stratum():
    """Every one once, for any number of them and however they are cut into blocks."""
    for n in (1, 2, 3, 7, 64, 1000, 1025):
        every = np.hstack(points_of_blocks("latin", 1, n, 3, [(0, n // 3), (n // 3, n)]))
        for row in every:
            assert np.array_equal(np.sort((row * n).astype(int)), np.arange(n)), n
    assert np.abs(np.corrcoef(every) - np.eye(3)).max() < tol.LATIN_CORRELATION


def test_sobol_blocks_are_those_of_scipy():
    whole = qmc.Sobol(3, bits=52, rng=np.random.default_rng(7)).random(1024).T
    for cuts in ([0, 1024], [0, 1, 2, 100, 777, 1024]):
        blocks = points_of_blocks("sobol", 7, 1024, 3, itertools.pairwise(cuts))
        assert np.array_equal(np.hstack(blocks), whole)
    far = sampling.points(
        "sobol", 7, 10**12, 3, 10**12 - 4, 10**12, 1
    )  # at once, not after 10^12 points
    assert far.shape == (3, 4)


@each_design
def test_a_generator_in_place_of_a_seed(design):
    """As SciPy takes it: it moves on, and what was drawn can be drawn again by its seed."""

    def drawn(**more):
        return sampling.sample(64, design=design, V0=stats.uniform(), mu=0.2, **more)

    generator = np.random.default_rng(7)
    one, other = (drawn(rng=generator) for _ in range(2))
    assert (one.design, *one) == (design, "V0", "mu")
    assert np.all(one["mu"] == 0.2)
    assert not np.array_equal(one["V0"], other["V0"])
    for again in (drawn(rng=7), drawn(seed=one.seed)):
        assert np.array_equal(one["V0"], again["V0"])


# --- inputs ---


def test_the_copula_keeps_marginals_and_gives_the_correlation():
    correlation = np.array([[1.0, 0.6], [0.6, 1.0]])
    laws = {
        "mu": Distribution(stats.expon(), 0.0, np.inf),
        "V0": Distribution(stats.norm(), -np.inf, np.inf),
    }
    inputs = Inputs({}, laws, {}, ("mu", "V0"), np.linalg.cholesky(correlation))
    values = inputs.values(sampling.points("sobol", 1, 1 << 14, 2, 0, 1 << 14, 0))
    assert stats.kstest(values["mu"], "expon").pvalue > tol.KOLMOGOROV
    assert stats.kstest(values["V0"], "norm").pvalue > tol.KOLMOGOROV
    scores = [stats.norm.ppf(stats.expon.cdf(values["mu"])), values["V0"]]
    assert abs(np.corrcoef(scores)[0, 1] - 0.6) < tol.COPULA


# --- summaries ---


@pytest.mark.parametrize("size", [2, 1000, 100_000])
def test_moments_and_quantiles(size):
    values = np.random.default_rng(2).normal(0.3, 1.0, size)
    values[::7] = np.nan
    kept = values[np.isfinite(values)]
    one = Histogram.of(values)
    levels = (0.0, 0.01, 0.3, 0.5, 0.99, 1.0)
    ordered = np.sort(kept)
    at = (np.array(levels) * (kept.size - 1)).astype(int)
    beside = np.maximum(np.abs(ordered[at]), np.abs(ordered[np.minimum(at + 1, kept.size - 1)]))
    assert (np.abs(one.quantiles(levels) - np.quantile(kept, levels)) <= 2.0**-8 * beside).all()
    assert (one.low, one.high, one.count) == (kept.min(), kept.max(), kept.size)
    assert abs(one.mean - kept.mean()) <= tol.MOMENT
    assert abs(one.spread / one.count - kept.var()) <= tol.MOMENT
    wide = Histogram.of(np.array([1e200, -1e200]))  # squares beyond the doubles
    assert wide.spread == wide.merge(Histogram.of(np.array([1e200]))).spread == np.inf


def test_merged_summaries_are_those_of_all(tmp_path):
    run = run_of(RUN, tmp_path)
    blocks = [roll_block(run, block) for block in range(run.blocks)]
    total = merge_summaries(summarise(motions, run.settings.summaries) for _, motions in blocks)
    assert sum(total.statuses.values()) == run.settings.n
    for name in run.settings.summaries:
        for k, one in enumerate(total.histograms[name]):
            values = np.concatenate([QUANTITIES[name].values(motions, k) for _, motions in blocks])
            assert one.count == np.isfinite(values).sum()
            assert np.array_equal(one.counts, Histogram.of(values).counts)
            assert close(one.mean, np.nanmean(values), tol.MOMENT, scale=1.0)
            assert close(one.spread / one.count, np.nanvar(values), tol.MOMENT, scale=1.0)


def test_a_cut_tail_keeps_its_digits():
    u = np.linspace(sampling.SMALLEST, sampling.LARGEST, 101)
    for low, high in ((30.0, 31.0), (-31.0, -30.0), (-1.0, 2.0)):
        found = Distribution(stats.norm(), low, high).ppf(u)
        exact = stats.truncnorm(low, high).ppf(u)
        assert np.abs(found - exact).max() < tol.TRUNCATED
        assert (np.diff(found) > 0.0).all()


@each_design
def test_points_depend_on_seed_and_block_alone(design):
    edges = [(0, 300), (300, 600), (600, 1000)]
    forward = points_of_blocks(design, 3, 1000, 2, edges)
    backward = [sampling.points(design, 3, 1000, 2, *edges[b], b) for b in (2, 1, 0)][::-1]
    assert all(map(np.array_equal, forward, backward))
    every = np.hstack(forward)
    assert every.min() > 0.0
    assert every.max() < 1.0
    assert min(stats.kstest(row, "uniform").pvalue for row in every) > tol.KOLMOGOROV
    other = points_of_blocks(design, 4, 1000, 2, edges)
    assert not np.array_equal(every, np.hstack(other))
