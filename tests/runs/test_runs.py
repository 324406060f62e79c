"""Run files, uncertain inputs, designs and summaries: what they mean, and what is refused at which line."""

from __future__ import annotations

import itertools
import re
from functools import partial
from importlib import import_module
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
import tolerances as tol
import xarray as xr
from closeness import close
from refusals import refused
from scipy import stats
from scipy.stats import qmc

import viscoroll as vr
from viscoroll.motion.batch import FLOW_PAYS
from viscoroll.runs import draws, estimate, read_run, roll_inputs
from viscoroll.runs.evaluate import block_inputs, roll_block, scene_of
from viscoroll.runs.inputs.record import LARGEST, SMALLEST, Distribution, Inputs
from viscoroll.runs.inputs.units import scales
from viscoroll.runs.quantities import QUANTITIES
from viscoroll.runs.sensitivity import sobol_indices
from viscoroll.runs.store import columns_of
from viscoroll.runs.summaries import (
    bin_edges,
    bin_of,
    histogram,
    lower_edge,
    merged,
    quantiles,
    summarise,
    summary_dataset,
)  # fmt: skip

pytestmark = pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")  # the paper's own scene is beyond the model

ANY = {"distribution": "uniform", "loc": -2.0, "scale": 4.0}
FULL = """
preset = "paper-section-5"
[scene]
mu = { distribution = "lognorm", s = 0.3, scale = 0.2, truncate = [0.05, 0.6] }
j = 0.4
[start]
V0 = { distribution = "uniform", loc = -2.0, scale = 4.0 }
omega0 = { distribution = "norm", scale = 0.5 }
[correlation]
V0.mu = 0.7
[run]
n = 3000
seed = 5
design = "DESIGN"
t = { low = 0.0, high = 3e-3, count = 3 }
rtol = 1e-6
block = 512
summaries = [
  "V", "omega", "x", "distance", "translation", "rotation", "lost", "slip_loss", "rolling_loss", "onset_time",
]
"""
CYLINDER = """
[cylinder]
R = 0.1
m = { file = "sample.csv", column = "mass" }
E = { file = "sample.csv", column = "modulus" }
nu = 0.49
T_epsilon = 10.7
T_sigma = { distribution = "uniform", loc = 0.5, scale = 1.0 }
mu = { distribution = "uniform", loc = 0.1, scale = 0.2 }
[start]
V0 = 0.014
omega0 = 0.05
[run]
n = 100
t = 0.03
"""


@pytest.fixture
def read(tmp_path):
    def read(text: str):
        (tmp_path / "run.toml").write_text(text, encoding="utf-8")
        return read_run(tmp_path / "run.toml")

    pd.DataFrame({"mass": [30.0, 40.0, 50.0], "modulus": [2e5, 3e5, 4e5], "name": ["a", "b", "c"]}).to_csv(
        tmp_path / "sample.csv"
    )
    return read


# --- designs ---


@pytest.mark.parametrize("design", ["random", "latin", "sobol"])
def test_points_depend_on_seed_and_block_alone(design):
    edges = [(0, 300), (300, 600), (600, 1000)]
    forward = [draws.points(design, 3, 1000, 2, *edge, b) for b, edge in enumerate(edges)]
    backward = [draws.points(design, 3, 1000, 2, *edges[b], b) for b in (2, 1, 0)][::-1]
    assert all(map(np.array_equal, forward, backward))
    every = np.hstack(forward)
    assert every.min() > 0.0
    assert every.max() < 1.0
    assert min(stats.kstest(row, "uniform").pvalue for row in every) > tol.KOLMOGOROV
    assert not np.array_equal(every, np.hstack([draws.points(design, 4, 1000, 2, *e, b) for b, e in enumerate(edges)]))


def test_permutation():
    """Of the strata of a Latin hypercube: every one once, for any number of them."""
    for n in (1, 2, 3, 7, 64, 1000, 1025):
        for row in draws.points("latin", 2, n, 3, 0, n, 0):
            assert np.array_equal(np.sort((row * n).astype(int)), np.arange(n)), n


def test_a_latin_hypercube_fills_every_stratum():
    n, edges = 1000, [(0, 333), (333, 1000)]
    every = np.hstack([draws.points("latin", 1, n, 3, *edge, b) for b, edge in enumerate(edges)])
    for row in every:
        assert np.array_equal(np.sort((row * n).astype(int)), np.arange(n))
    assert np.abs(np.corrcoef(every) - np.eye(3)).max() < tol.LATIN_CORRELATION


def test_sobol_blocks_are_those_of_scipy():
    whole = qmc.Sobol(3, bits=52, rng=np.random.default_rng(7)).random(1024).T
    assert np.array_equal(draws.points("sobol", 7, 1024, 3, 0, 1024, 0), whole)
    for start, stop in itertools.pairwise([0, 1, 2, 100, 777, 1024]):
        assert np.array_equal(draws.points("sobol", 7, 1024, 3, start, stop, 0), whole[:, start:stop])
    far = draws.points("sobol", 7, 10**12, 3, 10**12 - 4, 10**12, 1)  # at once, not after 10^12 points
    assert far.shape == (3, 4)


# --- inputs ---


def test_a_cut_tail_keeps_its_digits():
    u = np.linspace(SMALLEST, LARGEST, 101)
    for low, high in ((30.0, 31.0), (-31.0, -30.0), (-1.0, 2.0)):
        found = Distribution(stats.norm(), low, high).ppf(u)
        exact = stats.truncnorm(low, high).ppf(u)
        assert np.abs(found - exact).max() < tol.TRUNCATED
        assert (np.diff(found) > 0.0).all()


def test_the_copula_keeps_marginals_and_gives_the_correlation():
    correlation = np.array([[1.0, 0.6], [0.6, 1.0]])
    laws = {"mu": Distribution(stats.expon(), 0.0, np.inf), "V0": Distribution(stats.norm(), -np.inf, np.inf)}
    inputs = Inputs({}, laws, {}, ("mu", "V0"), np.linalg.cholesky(correlation))
    values = inputs.values(draws.points("sobol", 1, 1 << 14, 2, 0, 1 << 14, 0))
    assert stats.kstest(values["mu"], "expon").pvalue > tol.KOLMOGOROV
    assert stats.kstest(values["V0"], "norm").pvalue > tol.KOLMOGOROV
    scores = [stats.norm.ppf(stats.expon.cdf(values["mu"])), values["V0"]]
    assert abs(np.corrcoef(scores)[0, 1] - 0.6) < tol.COPULA


@pytest.mark.parametrize("suffix", [".csv", ".nc", ".parquet"])
def test_columns_of_a_file_share_their_row(read, tmp_path, suffix):
    frame = pd.read_csv(tmp_path / "sample.csv")[["mass", "modulus"]]
    if suffix == ".nc":
        xr.Dataset.from_dataframe(frame).to_netcdf(tmp_path / "sample.nc", engine="h5netcdf")
    elif suffix == ".parquet":
        pytest.importorskip("pyarrow")
        frame.to_parquet(tmp_path / "sample.parquet")
    run = read(CYLINDER.replace(".csv", suffix))
    assert run.inputs.dimensions == ("T_sigma", "mu", f"sample{suffix}")
    values = block_inputs(run, 0)
    assert np.array_equal(values["E"], 1e4 * values["m"] - 1e5)
    assert set(values["m"]) == {30.0, 40.0, 50.0}


def test_a_file_by_two_names_is_one_file(read, tmp_path):
    """Also by way of a link; its columns share their row, and cannot be told apart by Sobol indices."""
    (tmp_path / "link.csv").symlink_to("sample.csv")
    for other in ("./sample.csv", "link.csv", str(tmp_path / "sample.csv")):
        run = read(CYLINDER.replace('"sample.csv", column = "modulus"', f'"{other}", column = "modulus"'))
        assert run.inputs.dimensions == ("T_sigma", "mu", "sample.csv")
        values = block_inputs(run, 0)
        assert np.array_equal(values["E"], 1e4 * values["m"] - 1e5)
        with pytest.raises(vr.ParameterError, match=r"m, \[cylinder\] E = rows of sample.csv"):
            sobol_indices(run, 16)


def test_a_drawn_cylinder_is_that_cylinder(read):
    values = block_inputs(read(CYLINDER), 0)
    scene = scene_of(values)
    for i in range(5):
        own = {name: values[name][i] if np.ndim(values[name]) else values[name] for name in values}
        one = vr.Cylinder(**{name: own[name] for name in own if name not in ("V0", "omega0")}).scene()
        for name in ("alpha", "kappa", "mu", "gamma"):
            assert np.broadcast_to(getattr(scene, name), 100)[i] == getattr(one, name)


@pytest.mark.parametrize("design", ["random", "latin", "sobol"])
def test_blocks_are_rolled_as_an_ensemble(read, design):
    run = read(FULL.replace("DESIGN", design))
    values, motions = roll_block(run, 2)
    scene = vr.PAPER_SECTION_5.replace(mu=values["mu"], j=0.4)
    expected = vr.ensemble(scene, values["V0"], values["omega0"], [0.0, 1.5e-3, 3e-3], rtol=1e-6)
    assert np.array_equal(motions.V, expected.V)
    assert np.array_equal(roll_inputs(run, values).omega, expected.omega)
    assert ((values["mu"] >= 0.05) & (values["mu"] <= 0.6)).all()


def test_bits_do_not_depend_on_how_a_run_is_cut(read):
    """The flow map is chosen by the run: a block of slow starts does not get a finer one."""
    text = FULL[: FULL.index("[scene]")] + FULL[FULL.index("[start]") :].replace("[correlation]\nV0.mu = 0.7\n", "")
    run = read(text.replace("DESIGN", "sobol").replace("n = 3000", f"n = {FLOW_PAYS}"))
    assert run.method == "flow"
    values, motions = roll_block(run, 0)
    few = {name: value[3:4] if np.ndim(value) else value for name, value in values.items()}
    assert roll_inputs(run, few).V[0, 1] == motions.V[3, 1]


def test_more_times_than_a_block_has_bytes_for(read):
    run = read(FULL.replace("DESIGN", "random").replace("count = 3", "count = 3_000_000").replace("block = 512", ""))
    assert run.block == 1


def test_the_flow_map_of_motions_at_rest(read):
    """There is none: they are integrated, as by an ensemble."""
    run = read('preset = "paper-section-5"\n[start]\nV0 = 0.0\nomega0 = 0.0\n[run]\nn = 2\nt = 1e-3\nmethod = "flow"')
    _, motions = roll_block(run, 0)
    assert motions.V.tolist() == [[0.0], [0.0]]


def test_a_run_of_one_motion(read):
    run = read('preset = "paper-section-5"\n[start]\nV0 = 1.5\nomega0 = 0.5\n[run]\nn = 3\nt = 1e-3')
    _, motions = roll_block(run, 0)
    assert np.array_equal(motions.V[:, 0], [vr.roll(vr.PAPER_SECTION_5, 1.5, 0.5, [1e-3]).V[0]] * 3)


# --- a cylinder in SI units ---

SI = """
[cylinder]
R = { distribution = "uniform", loc = 0.08, scale = 0.04 }
m = 35.5
E = 2.3e5
nu = 0.49
T_epsilon = { distribution = "uniform", loc = 9.0, scale = 3.0 }
T_sigma = 0.97
mu = 0.2
[start]
V0 = { distribution = "uniform", loc = -0.02, scale = 0.04 }
omega0 = { distribution = "norm", loc = 0.05, scale = 0.1 }
[run]
n = 20
t = [1e-4, 2e-3, 0.03]
rtol = 1e-10
keep = "all"
fields = ["V", "omega", "x", "angle", "delta", "regime", "slip_loss", "rolling_loss"]
summaries = ["V", "omega", "x", "distance", "angle", "delta", "translation", "lost", "slip_loss", "onset_time"]
"""
ONE = SI.replace('{ distribution = "uniform", loc = 0.08, scale = 0.04 }', "0.1").replace(
    '{ distribution = "uniform", loc = 9.0, scale = 3.0 }', "10.7"
)


def by_hand(run, values, i):
    """(cylinder, motion) of a drawn input, by way of :class:`viscoroll.Cylinder`."""
    own = {name: value[i] if np.ndim(value) else value for name, value in values.items()}
    V0, omega0 = own.pop("V0"), own.pop("omega0")
    cylinder, settings = vr.Cylinder(**own), run.settings
    rest = None if settings.rest is None else cylinder.V_from_si(settings.rest)
    scene = cylinder.scene()
    return cylinder, vr.ensemble(
        scene.replace(alpha=[scene.alpha]),
        cylinder.V_from_si(V0), cylinder.omega_from_si(omega0), cylinder.t_from_si(run.t),
        rtol=settings.rtol, rest=rest, fields=settings.fields,
    )  # fmt: skip


def test_motions_in_si_units_are_those_of_the_cylinder(read):
    """Each with its own R and T_epsilon, and so with another unit of time."""
    run = read(SI)
    values, motions = roll_block(run, 0)
    columns = columns_of(run, values, motions)
    for i in range(20):
        cylinder, one = by_hand(run, values, i)
        energy = cylinder.m * (cylinder.R / cylinder.T_epsilon) ** 2
        expected = {
            "V": cylinder.V_to_si(one.V), "omega": cylinder.omega_to_si(one.omega), "x": cylinder.x_to_si(one.x),
            "angle": one.angle, "delta": one.delta, "regime": one.regime,
            "slip_loss": energy * one.slip_loss, "rolling_loss": energy * one.rolling_loss,
            "onset_time": cylinder.t_to_si(one.onset_time),
        }  # fmt: skip
        for name, value in expected.items():
            size = np.nanmax(np.abs(value))
            assert close(columns[name][i], value[0], rel=tol.SI_UNITS, scale=size, what=name)
    assert np.ptp(motions.regime[:, 1]) > 0  # the times tell something


def test_summaries_in_si_units(read):
    run = read(SI)
    values, motions = roll_block(run, 0)
    columns, total = columns_of(run, values, motions), summarise(motions, run.settings.summaries, scales(values))
    for name in ("V", "omega", "x", "angle", "delta"):
        assert total.histograms[name][2].low == columns[name][:, 2].min()
    assert total.histograms["distance"][2].high == np.abs(columns["x"][:, 2]).max()
    start = 0.5 * 35.5 * (values["V0"] ** 2 + 0.5 * (values["R"] * values["omega0"]) ** 2)
    assert close(total.histograms["slip_loss"][2].high, (columns["slip_loss"][:, 2] / start).max(), rel=1e-8)
    assert close(
        total.histograms["lost"][2].high,
        ((columns["slip_loss"] + columns["rolling_loss"])[:, 2] / start).max(),
        rel=1e-8,
    )
    found = summary_dataset(total, run.t, (0.5,), run.si)
    units = {name: found[f"{name}_mean"].attrs["units"] for name in run.settings.summaries}
    assert units == {
        "V": "m s-1", "omega": "rad s-1", "x": "m", "distance": "m", "angle": "rad", "onset_time": "s",
        "delta": "1", "translation": "1", "lost": "1", "slip_loss": "1",
    }  # fmt: skip
    assert found.t.attrs["units"] == "s"
    assert found.V_bin_low.attrs["units"] == "m s-1"
    assert "T_epsilon" not in found.V_mean.attrs["long_name"]


def test_a_cylinder_from_its_flow_map(read):
    """The map is made for dimensionless speeds, the threshold of rest is one."""
    run = read(ONE.replace("n = 20", "n = 3000\nrest = 1e-3\nmethod = 'flow'").replace("1e-10", "1e-7"))
    values, motions = roll_block(run, 0)
    assert motions.flow.mean() > 0.5
    assert np.isfinite(motions.rest_time).sum() > 100
    for i in range(5):
        cylinder, one = by_hand(run, values, i)
        V = columns_of(run, values, motions)["V"][i]
        assert close(V, cylinder.V_to_si(one.V[0]), rel=1e-7, scale=abs(values["V0"][i]))
        assert close(motions.rest_time[i], cylinder.t_to_si(one.rest_time[0]), rel=1e-6)


RUBBER = """
[material]
E = 2.3e5
nu = 0.49
prony = { E = [2.0, 6.0], tau = [1.0, 1e-3] }
T_ref = 3.0
"""
LOAD = "load = { distribution = 'uniform', loc = 300.0, scale = 100.0 }\n"
ROLLER = re.sub(r"^(E|nu|T_epsilon|T_sigma) = .*\n", "", SI.replace("mu =", LOAD + "mu ="), flags=re.M)


def test_a_material_of_a_run(read):
    """Motions of a series, over seconds, against those of the cylinder with each its own radius and load."""
    run = read(RUBBER + ROLLER)
    assert run.inputs.uncertain == ("R", "load", "V0", "omega0")
    values, motions = roll_block(run, 0)
    columns = columns_of(run, values, motions)
    material = vr.Material(2.3e5, 0.49, vr.Prony([2.0, 6.0], [1.0, 1e-3]), T_ref=3.0)
    for i in range(3):
        cylinder = vr.Cylinder(R=values["R"][i], m=35.5, mu=0.2, load=values["load"][i], material=material)
        V0, omega0 = cylinder.V_from_si(values["V0"][i]), cylinder.omega_from_si(values["omega0"][i])
        one = vr.roll(cylinder.scene(), V0, omega0, cylinder.t_from_si(run.t), rtol=1e-10)
        for name, value in (("V", cylinder.V_to_si(one.V)), ("x", cylinder.x_to_si(one.x))):
            assert close(columns[name][i], value, rel=tol.SI_SERIES, scale=np.abs(value).max())


def test_a_run_with_a_material_is_another_run(read):
    """Of the paper's four numbers the same motions, by a series; any change of the material is another digest."""
    solid = "[material]\nE = 2.3e5\nnu = 0.49\nT_epsilon = 10.7\nT_sigma = 0.97\n"
    bare = re.sub(r"^(E|nu|T_epsilon|T_sigma) = .*\n", "", ONE, flags=re.M)
    one, other = read(ONE), read(solid + bare)
    assert one.digest != other.digest
    assert other.digest != read(solid.replace("0.97", "0.98") + bare).digest
    (values, motions), (_, same) = roll_block(one, 0), roll_block(other, 0)
    assert scales(values)["V"] == 0.1 / 10.7
    assert close(same.V, motions.V, rel=tol.SI_SERIES, scale=np.abs(motions.V).max())


def test_refused_materials_of_a_run(read):
    for text, words in (
        (RUBBER + SI, ["[cylinder]", "unknown key 'E'"]),
        (RUBBER.replace("material", "base") + SI, ["[base] needs [material]"]),
        (RUBBER.replace("6.0", "-6.0") + ROLLER, ["line 5", "E = -6"]),
        ("[material]\nE = inf\nnu = 0.5\n" + ROLLER, ["base = rigid"]),
        (RUBBER + "[scene]\nalpha = 2\n[start]\n[run]\nn = 1\nt = 1", ["[material] goes with [cylinder]"]),
    ):
        refused(partial(read, text), *words, error=vr.ConfigError)


def test_refused_in_si_units(read):
    for old, new, words in (
        ("V0 = {", "V0 = '3 m/s' # {", ["line 11", "plain number, in m/s"]),
        ("omega0 = {", "omega0 = '3 rpm' # {", ["line 12", "plain number, in rad/s"]),
        ("V0 = {", "v0 = {", ["line 11", "did you mean 'V0'?"]),
        ("n = 20", "rest = 0.01\nn = 20", ["line 14", "R or T_epsilon is uncertain"]),
        ("t = [", "t = '3 s' # [", ["line 15", "str"]),
    ):
        refused(partial(read, SI.replace(old, new)), *words, error=vr.ConfigError)


# --- summaries ---


def test_bins_are_narrow_and_in_order():
    rng = np.random.default_rng(1)
    values = np.concatenate([rng.normal(size=1000) * 10.0 ** rng.uniform(-300, 300, 1000), [0.0, -0.0, 5e-324]])
    below, above = bin_edges(bin_of(values))
    assert ((below <= values) & (values < above)).all()
    normal = np.abs(values) > 1e-300
    assert ((above - below)[normal] <= np.abs(values[normal]) * 2.0**-8 * (1 + 1e-12)).all()
    order = np.argsort(values)
    assert (np.diff(bin_of(values[order])) >= 0).all()
    assert np.array_equal(lower_edge(bin_of(below)), below)


@pytest.mark.parametrize("size", [1, 2, 1000, 100_000])
def test_moments_and_quantiles(size):
    values = np.random.default_rng(2).normal(0.3, 1.0, size)
    values[::7] = np.nan
    kept, one = values[np.isfinite(values)], histogram(values)
    if not kept.size:
        assert one.count == 0
        assert np.isnan(quantiles(one, (0.5,))).all()
        return
    levels = (0.0, 0.01, 0.3, 0.5, 0.99, 1.0)
    ordered = np.sort(kept)
    at = (np.array(levels) * (kept.size - 1)).astype(int)
    beside = np.maximum(np.abs(ordered[at]), np.abs(ordered[np.minimum(at + 1, kept.size - 1)]))
    assert (np.abs(quantiles(one, levels) - np.quantile(kept, levels)) <= 2.0**-8 * beside).all()
    assert (one.low, one.high, one.count) == (kept.min(), kept.max(), kept.size)
    assert abs(one.mean - kept.mean()) <= tol.MOMENT
    assert abs(one.spread / one.count - kept.var()) <= tol.MOMENT


def test_merged_summaries_are_those_of_all(read):
    run = read(FULL.replace("DESIGN", "sobol"))
    blocks = [roll_block(run, block) for block in range(run.blocks)]
    total = merged(summarise(motions, run.settings.summaries, {}) for _, motions in blocks)
    assert sum(total.statuses.values()) == run.settings.n
    for name in run.settings.summaries:
        for k, one in enumerate(total.histograms[name]):
            values = np.concatenate([QUANTITIES[name].values(motions, k) for _, motions in blocks])
            assert one.count == np.isfinite(values).sum()
            assert np.array_equal(one.counts, histogram(values).counts)
            assert close(one.mean, np.nanmean(values), rel=tol.MOMENT, scale=1.0)
            assert close(one.spread / one.count, np.nanvar(values), rel=tol.MOMENT, scale=1.0)


def test_energy_only_falls(read):
    run = read(FULL.replace("DESIGN", "random"))
    _, motions = roll_block(run, 0)
    lost = np.array([QUANTITIES["lost"].values(motions, k) for k in range(3)])
    assert np.abs(lost[0]).max() < tol.MOMENT
    assert (np.diff(lost, axis=0) > 0.0).all()
    shares = [QUANTITIES[name].values(motions, 1) for name in ("translation", "rotation", "lost")]
    assert np.abs(np.sum(shares, axis=0) - 1.0).max() < tol.MOMENT
    parts = [QUANTITIES[name].values(motions, 1) for name in ("slip_loss", "rolling_loss")]
    assert np.min(parts[0]) >= 0.0  # rolling resistance gains from a spin against the motion
    assert np.abs(np.sum(parts, axis=0) - shares[2]).max() < 30.0 * run.settings.rtol


# --- what is refused, and at which line ---

REFUSED = [
    ('V0 = {', 'Vo = {', ["line 7", "[start]", "unknown key 'Vo'", "did you mean 'V0'?"]),
    ("seed = 5", "sead = 5", ["line 13", "[run]", "did you mean 'seed'?"]),
    ("[start]", "[strat]", ["line 6", "did you mean 'start'?"]),
    ('"lognorm"', '"lognrom"', ["line 4", "scipy.stats", "did you mean 'lognorm'?"]),
    ('"lognorm"', '"poisson"', ["line 4", "no continuous one"]),
    ("s = 0.3", "sigma = 0.3", ["line 4", "unknown key 'sigma'"]),
    ("s = 0.3, ", "", ["line 4", "lognorm also needs s"]),
    ("s = 0.3", "s = -0.3", ["line 4", "does not allow"]),
    ("s = 0.3", 's = "0.3 %"', ["line 4", "finite number without a unit"]),
    ("[0.05, 0.6]", "[-0.05, 0.0]", ["line 4", "nothing of the distribution is left"]),
    ('"lognorm", s = 0.3, scale = 0.2, truncate = [0.05, 0.6]', '"norm", scale = 0.2', ["line 4", "truncate", "> 0"]),
    ("j = 0.4", "j = -0.4", ["line 5", "j = -0.4", "> 0"]),
    ("j = 0.4", 'j = "3 mm"', ["line 5", "'3 mm'", "plain number"]),
    ("j = 0.4", "j = true", ["line 5", "number"]),
    ("j = 0.4", "j = { file = 'no.csv', column = 'j' }", ["line 5", "no.csv"]),
    ("j = 0.4", "j = { file = 'sample.csv', column = 'name' }", ["line 5", "finite numbers"]),
    ("V0.mu = 0.7", "V0.omega = 0.7", ["line 10", "did you mean 'omega0'?"]),
    ("V0.mu = 0.7", "V0.mu = 1.7", ["line 10", "(-1, 1)"]),
    ("V0.mu = 0.7", "V0.mu = 0.9\nmu.omega0 = 0.9\nV0.omega0 = -0.9", ["line 9", "no joint distribution"]),
    ("n = 3000", "n = 0", ["line 12", ">= 1"]),
    ("n = 3000", 'n = "3000"', ["line 12", "int"]),
    ('"DESIGN"', '"grid"', ["line 14", "grid"]),
    ("count = 3 }", "count = 3, step = 1 }", ["line 15", "unknown key 'step'"]),
    ("t = {", "t = [2.0, 1.0] # {", ["line 15", "ascending"]),
    ("rtol = 1e-6", "rtol = 1.0", ["line 16", "rtol"]),
    ('"onset_time"', '"onset"', ["line 18", "onset"]),
    ("block = 512", 'method = "flow"', ["line 17", "scenes differ"]),
    ('preset = "paper-section-5"', 'preset = "paper"', ["line 2", "choose from paper-section-5"]),
    ("V0.mu = 0.7", "V0.mu = 0.0\nmu.V0 = 0.9", ["[correlation]", "V0.mu = 0.0: must be that of mu.V0 = 0.9"]),
    ("[0.05, 0.6]", "[0.05, nan]", ["line 4", "truncate = [0.05, nan]", "must be [low, high]"]),
    ("[0.05, 0.6]", "[false, true]", ["line 4", "truncate = [False, True]", "must be [low, high]"]),
    ('"norm", scale = 0.5', '"norm", scale = 0.0', ["line 8", "does not allow these parameters"]),
    ('"norm", scale = 0.5', '"uniform", loc = 1e308, scale = 1e308', ["line 8", "reaches from", "truncate"]),
    ("low = 0.0, high = 3e-3", "low = -1e308, high = 1e308", ["line 15", "high = 1e+308: must be less than"]),
]  # fmt: skip


def test_refused(read):
    for old, new, words in REFUSED:
        assert old in FULL
        text = FULL.replace(old, new, 1).replace("DESIGN", "random")
        refused(partial(read, text), *words, error=vr.ConfigError)


def test_draws_that_overflow_are_refused_without_a_warning(read):
    for old, new, words in (
        ('"norm", scale = 0.5', '"dweibull", c = 1e-3', "omega0 = "),
        ("j = 0.4", 'j = { distribution = "uniform", loc = 1e308, scale = 1e308 }', "j = inf"),
    ):
        run = read(FULL.replace("DESIGN", "random").replace(old, new))
        refused(partial(roll_block, run, 0), words)


def test_a_run_that_summarises_nothing(read):
    text = FULL[: FULL.index("summaries")].replace("DESIGN", "random") + "summaries = []"
    with pytest.raises(vr.ConfigError, match=r"line 18: \[run\] summaries = \[\]: must name at least one quantity"):
        read(text)


def test_a_retardation_time_that_may_be_too_short(read):
    with pytest.raises(vr.ConfigError, match=r"line 7.*T_epsilon may fall below T_sigma"):
        read(CYLINDER.replace("T_epsilon = 10.7", "T_epsilon = 1.0"))


def test_comments_do_not_make_another_run(read):
    text = FULL.replace("DESIGN", "random")
    assert read(text).digest == read("# a comment\n" + text).digest
    assert read(text).digest != read(text.replace("0.3", "0.31")).digest
    assert read(text).digest != read(text.replace("seed = 5", "seed = 6")).digest


def test_estimate_says_what_it_takes(read):
    run = read(FULL.replace("DESIGN", "sobol").replace("n = 3000", "n = 3_000_000_000"))
    found = estimate(run, threads=2)
    assert found.blocks == run.blocks == -(-3_000_000_000 // 512)
    assert found.seconds > 60.0
    assert "MB" in str(found)


def test_an_estimate_does_not_scale_up_what_happens_once(read, monkeypatch):
    """By a clock that goes by the work alone: 100 s for what a process does once, as to import, then 1 s a trial."""
    clock = [0.0]

    def summarised(*given):
        clock[0] += 100.0 if clock[0] == 0.0 else 1.0
        return summarise(*given)

    module = import_module("viscoroll.runs.estimate")  # whose name is the function's
    monkeypatch.setattr(module, "summarise", summarised)
    monkeypatch.setattr(module, "time", SimpleNamespace(perf_counter=lambda: clock[0]))
    run = read(FULL.replace("DESIGN", "sobol").replace("n = 3000", f"n = {512 * 5}"))
    assert run.blocks == 5
    assert estimate(run, threads=1).seconds == 5.0
    assert estimate(run, threads=2).seconds == 3.0  # three blocks for one of the two
    assert estimate(run, threads=9).seconds == 1.0
