"""Stages of the demo at the tolerances of its own configuration."""

import tomllib

import msgspec
import numpy as np
import pytest
from places import PIPELINE
from scipy.integrate import solve_ivp

import viscoroll as vr
from pipeline import benchmark

#: evaluations of the rates of a motion; a sign that flipped at V = 0 took no end of them
MOST_RATES = 20_000


@pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")  # the paper's own scene is beyond the model
def test_radau_ends_by_every_law_of_the_benchmark(monkeypatch):
    """The other ways are compiled; they and the finest splines, which take SciPy ten seconds, are CI's `make demo`."""

    def bounded(rates, *given, **options):
        left = iter(range(MOST_RATES))
        return solve_ivp(lambda t, y: (next(left), rates(t, y))[1], *given, **options)

    monkeypatch.setattr(benchmark, "solve_ivp", bounded)
    config = tomllib.loads((PIPELINE / "config.toml").read_text())
    settings = msgspec.convert(config["benchmark"], benchmark.Benchmark)
    t = np.linspace(0.0, config["runtime"]["end"], config["runtime"]["times"])
    settings.splines = settings.splines[:1]
    for name, rtol, way in benchmark.ways(settings, t):
        for start in vr.presets.PAPER_STARTS.values() if "Radau" in name else ():
            # splines may be given up, which is NaN
            assert np.isfinite(way(*start)).all() or "splines" in name, (name, rtol)
