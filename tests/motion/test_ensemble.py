"""Many motions at once: the same as one at a time, for any number of threads; sampling."""

from __future__ import annotations

import math

import numpy as np
import pytest
import tolerances as tol
import xarray as xr
from scipy import stats

import viscoroll as vr
from viscoroll.blocks import run_blocks, thread_count
from viscoroll.files import write_dataset
from viscoroll.motion.batch import FIELDS, STATES
from viscoroll.sampling import DESIGNS, Sample, sample

SCENE = vr.PAPER_SECTION_5_ROUNDED
T = np.linspace(0.0, 3e-3, 7)


#: sticks, slides again, and sticks for good within 2.5e-3 from V = omega = 1
RETURNING = vr.Scene(alpha=11.0, kappa=2.91, mu=0.01, gamma=1.1e4, j=0.5)


def starts(count: int, seed: int = 1) -> tuple[np.ndarray, np.ndarray]:
    V0, omega0 = np.random.default_rng(seed).uniform(-2.0, 2.0, (2, count))
    V0[:3], omega0[:3] = (0.0, 1.0, 0.0), (0.0, 1.0, -1.0)
    return V0, omega0


def scenes(count: int) -> vr.Scene:
    """Every parameter differs from motion to motion but mu; slip returns in some."""
    rng = np.random.default_rng(4)
    return vr.Scene(
        alpha=1.0 + 10.0 ** rng.uniform(-1, 2, count), kappa=rng.uniform(2, 30, count), mu=0.02,
        gamma=rng.uniform(5e3, 2e4, count), j=rng.uniform(0.3, 1.2, count),
    )  # fmt: skip


def one_of(many: vr.Scene, index: int) -> vr.Scene:
    names = ("alpha", "kappa", "mu", "gamma", "j")
    return vr.Scene(**{name: np.broadcast_to(getattr(many, name), many.shape)[index] for name in names})


def equal(a, b) -> bool:
    return np.array_equal(a, b, equal_nan=True)


@pytest.mark.parametrize("many", [SCENE, scenes(40)], ids=["one scene", "a scene each"])
def test_ensemble_is_roll_bit_for_bit(many):
    V0, omega0 = starts(40)
    result = vr.ensemble(many, V0, omega0, T, fields=FIELDS)
    for i in range(V0.size):
        motion = vr.roll(one_of(many, i) if many.shape else many, V0[i], omega0[i], T)
        for name in STATES:
            assert equal(getattr(result, name)[i], getattr(motion, name)), (i, name)
        assert equal(result.onset_time[i], motion.onset_time)
        assert result.status[i] == motion.status
        assert result.switches[i] == len(motion.switches)
        assert result.steps[i] == motion.steps


def test_threads_bit_for_bit():
    """300 motions are five blocks."""
    V0, omega0 = starts(300)
    one, two, five = (vr.ensemble(SCENE, V0, omega0, T, fields=FIELDS, threads=n) for n in (1, 2, 5))
    for name in (*FIELDS, "onset_time", "rest_time", "status", "switches", "steps"):
        assert equal(getattr(one, name), getattr(two, name)), name
        assert equal(getattr(one, name), getattr(five, name)), name


def test_any_subset_is_the_same_bit_for_bit():
    V0, omega0 = starts(100)
    whole = vr.ensemble(SCENE, V0, omega0, T)
    part = vr.ensemble(SCENE, V0[70:90], omega0[70:90], T)
    assert equal(whole.V[70:90], part.V)


def test_blocks_cover_the_work_once(monkeypatch):
    for threads in (1, 3):
        seen = np.zeros(1001, dtype=int)

        def work(start: int, stop: int, seen=seen) -> None:
            seen[start:stop] += 1

        run_blocks(work, 1001, 64, threads=threads)
        assert np.all(seen == 1)
    run_blocks(lambda start, stop: pytest.fail("no work"), 0, 64)
    monkeypatch.setenv("VISCOROLL_THREADS", "3")
    assert thread_count() == 3
    assert thread_count(1) == 1


def test_a_failing_block_is_not_swallowed():
    def work(start: int, stop: int) -> None:
        if start == 64:
            raise RuntimeError("block 1")

    with pytest.raises(RuntimeError, match="block 1"):
        run_blocks(work, 200, 64, threads=2)


def test_progress_bar_only_when_it_takes_long(capsys):
    V0, omega0 = starts(10)
    vr.ensemble(SCENE, V0, omega0, T)  # compiles
    vr.ensemble(SCENE, V0, omega0, T, progress=True)
    assert "motions" not in capsys.readouterr().err


# --- energy ---


@pytest.mark.parametrize("many", [SCENE, RETURNING, SCENE.replace(alpha=1.0)], ids=["paper", "slip returns", "elastic"])
def test_losses_are_the_integrals_of_their_powers(many):
    """Rolling, which the package takes from the balance of energy, by a quadrature of its own."""
    V0, omega0, end = 1.5, 0.5, 2e-3
    result = vr.ensemble(many, V0, omega0, [0.0, end], rtol=1e-10, fields=FIELDS)
    motion = vr.roll(many, V0, omega0, end, rtol=1e-10)
    node, weight = np.polynomial.legendre.leggauss(10)
    edges = np.unique([*motion.t, *(s.t for s in motion.switches)])
    width = 0.5 * np.diff(edges)[:, None]
    along = motion.at((edges[:-1, None] + width * (1.0 + node)).ravel())
    state, weight = along.contact(("Q", "M")), many.gamma * (width * weight).ravel()
    energy = 0.5 * (V0**2 + many.j * omega0**2)
    slip, rolling = weight @ ((along.omega - along.V) * state.Q), weight @ (0.5 * (along.V + along.omega) * state.M)
    assert result.slip_loss[0] == pytest.approx([0.0, slip], abs=tol.MOTION_IDENTITY * energy)
    assert result.rolling_loss[0] == pytest.approx([0.0, rolling], abs=tol.MOTION_IDENTITY * energy)


def test_all_energy_is_lost_at_rest():
    V0, omega0 = starts(20)
    result = vr.ensemble(SCENE, V0, omega0, [1.0], rest=1e-6, fields=FIELDS)
    energy = 0.5 * (V0**2 + SCENE.j * omega0**2)
    assert (result.V == 0.0).all()
    np.testing.assert_allclose((result.slip_loss + result.rolling_loss)[:, 0], energy, rtol=tol.ENERGY)
    assert (result.slip_loss >= 0.0).all()


def test_in_full_slip_friction_takes_mu_a_unit_of_path():
    V0, omega0 = np.array([1.0, -1.0, 0.3]), np.array([-1.0, 1.0, 2.0])
    result = vr.ensemble(SCENE, V0, omega0, [1e-5, 5e-5], fields=FIELDS)
    assert (result.regime == 0).all()
    slipped = SCENE.gamma * SCENE.mu * np.abs(result.angle - result.x)
    np.testing.assert_allclose(result.slip_loss, slipped, rtol=tol.SLIDING_LOSS)


# --- what a result holds ---


def test_shapes_and_fields():
    V0, omega0 = starts(5)
    result = vr.ensemble(SCENE, V0, omega0, T)
    assert result.V.shape == result.omega.shape == result.x.shape == (5, 7)
    assert result.angle is result.delta is result.regime is None
    assert result.onset_time.shape == result.status.shape == (5,)
    assert len(result) == 5
    only = vr.ensemble(SCENE, V0, omega0, T, fields="angle")
    assert only.V is None
    assert equal(only.angle, vr.ensemble(SCENE, V0, omega0, T, fields=FIELDS).angle)
    final = vr.ensemble(SCENE, V0, omega0, 3e-3)
    assert final.t.tolist() == [3e-3]
    assert equal(final.V[:, 0], result.V[:, -1])


def test_scalars_broadcast():
    V0 = np.array([1.0, 1.5, 2.0])
    assert vr.ensemble(SCENE, V0, 0.5, T).V.shape == (3, 7)
    assert vr.ensemble(SCENE, 1.5, 0.5, T).V.shape == (1, 7)
    mus = SCENE.replace(mu=[0.1, 0.2, 0.3, 0.4])
    assert vr.ensemble(mus, 1.5, 0.5, T).V.shape == (4, 7)


@pytest.mark.parametrize("start", [([], []), ([], 2.0), (2.0, [])])
@pytest.mark.parametrize("method", ["auto", "flow", "integrate"])
def test_no_motions(start, method):
    """The flow map once rolled one motion that nobody asked for."""
    none = vr.ensemble(SCENE, *start, T, method=method, rtol=1e-6, fields=FIELDS)
    assert none.V.shape == none.regime.shape == (0, 7)
    assert len(none) == none.flow.size == none.V0.size == 0
    with pytest.raises(vr.ParameterError, match="motions = 0: must be at least one"):
        none.summary()


def test_a_regime_that_was_not_reached_is_no_full_slip():
    tiny = vr.ensemble(SCENE, 1.5, 0.5, T, fields="regime", max_steps=8)
    assert np.isnan(tiny.regime[0, -1])
    regime = tiny.to_xarray().regime
    assert regime.values[0, -1] == -1
    meanings = dict(zip(regime.flag_values.tolist(), regime.flag_meanings.split(), strict=True))
    assert meanings == {-1: "not_reached", 0: "full_slip", 1: "partial_slip", 2: "rest"}


def test_status_and_messages():
    V0, omega0 = starts(20)
    tiny = vr.ensemble(SCENE, V0, omega0, T, max_steps=8)
    assert set(tiny.status) == {vr.MotionStatus.DONE, vr.MotionStatus.STEP_LIMIT}
    words = tiny.messages()
    assert sum(words.values()) == 20
    assert words[vr.MOTION_STATUS[vr.MotionStatus.STEP_LIMIT]] == 19  # all but the one at rest
    limited = tiny.status == vr.MotionStatus.STEP_LIMIT
    assert np.all(np.isnan(tiny.V[limited, -1]))
    assert np.all(np.isfinite(tiny.V[limited, 0]))
    resting = vr.ensemble(SCENE, V0, omega0, [1e-2], rest=1e-3)
    assert resting.messages() == {vr.MOTION_STATUS[vr.MotionStatus.RESTED]: 20}
    assert np.all(resting.rest_time < 1e-2)
    assert np.all(resting.V == 0.0)


def test_summary():
    V0, omega0 = starts(50)
    result = vr.ensemble(SCENE, V0, omega0, T)
    summary = result.summary(quantiles=(0.25, 0.5))
    np.testing.assert_allclose(summary.V_mean, result.V.mean(axis=0), rtol=1e-13)
    np.testing.assert_allclose(summary.V_quantiles.sel(quantile=0.5), np.median(result.V, axis=0), rtol=1e-13)
    onset = result.onset_time[np.isfinite(result.onset_time)]
    np.testing.assert_allclose(summary.onset_time_quantiles, np.quantile(onset, (0.25, 0.5)), rtol=1e-13)
    assert summary.attrs["motions"] == 50
    assert "angle_mean" not in summary


@pytest.mark.parametrize("many", [SCENE, scenes(12)], ids=["one scene", "a scene each"])
def test_to_xarray_and_back_from_a_file(many, tmp_path):
    V0, omega0 = starts(12)
    result = vr.ensemble(many, V0, omega0, T, fields=FIELDS, rest=1e-3)
    data = result.to_xarray()
    assert dict(data.sizes) == {"motion": 12, "t": 7}
    path = tmp_path / "ensemble.nc"
    write_dataset(data, path)
    with xr.open_dataset(path, engine="h5netcdf") as again:
        again.load()
    assert set(again.variables) == set(data.variables)
    for name in data.variables:
        assert equal(again[name].values, data[name].values), name
        assert again[name].attrs["long_name"]
    assert again.alpha.dims == (("motion",) if many.shape else ())
    assert again.attrs["Conventions"] == "CF-1.11"
    assert equal(again.V.values, result.V)


def test_nothing_half_written(tmp_path):
    """A failure leaves the old file as it was and no temporary one."""
    path = tmp_path / "ensemble.nc"
    write_dataset(vr.ensemble(SCENE, 1.5, 0.5, T).to_xarray(), path)
    before = path.read_bytes()
    broken = xr.Dataset({"V": ("t", np.array([object()], dtype=object))})
    with pytest.raises(Exception, match=r".+"):
        write_dataset(broken, path)
    assert path.read_bytes() == before
    assert [p.name for p in tmp_path.iterdir()] == ["ensemble.nc"]
    with pytest.raises(vr.OutputError, match="cannot be written"):
        write_dataset(xr.Dataset(), tmp_path / "absent" / "ensemble.nc")


BAD_CALLS = {
    "V0 nan": ({"V0": [1.0, math.nan]}, "V0 = nan: must be a finite number"),
    "shapes": ({"V0": [1.0, 2.0], "omega0": [1.0, 2.0, 3.0]}, "V0 (2,), omega0 (3,): must be broadcastable"),
    "scene shape": ({"scene": SCENE.replace(mu=[0.1, 0.2]), "V0": [1.0, 2.0, 3.0]}, "mu (2,), V0 (3,)"),
    "matrix": ({"V0": [[1.0, 2.0]]}, "must be scalars or vectors (n,)"),
    "t": ({"t": [1.0, 0.5]}, "must be in ascending order"),
    "fields": ({"fields": ("V", "speed")}, "fields = 'speed': must be out of V, omega"),
    "rtol": ({"rtol": 1.0}, "rtol = 1.0: must be a number in"),
}


@pytest.mark.parametrize(("change", "text"), BAD_CALLS.values(), ids=BAD_CALLS)
def test_bad_input(change, text):
    with pytest.raises(vr.ParameterError) as caught:
        vr.ensemble(**({"scene": SCENE, "V0": 1.0, "omega0": 0.5, "t": T} | change))
    assert text in str(caught.value)
    assert "\n" not in str(caught.value)


# --- sampling ---


@pytest.mark.parametrize("design", DESIGNS)
def test_sampling_is_reproducible(design):
    quantities = {"V0": stats.uniform(-1.0, 2.0), "omega0": stats.norm(0.5, 0.1), "mu": 0.2}
    first, again, other = (sample(64, seed=seed, design=design, **quantities) for seed in (3, 3, 4))
    assert isinstance(first, Sample)
    assert (first.seed, first.design) == (3, design)
    assert list(first) == ["V0", "omega0", "mu"]
    for name in first:
        assert first[name].shape == (64,)
        assert equal(first[name], again[name])
    assert not equal(first["V0"], other["V0"])
    assert np.all(first["mu"] == 0.2)
    assert np.all(abs(first["V0"]) <= 1.0)
    assert not equal(first["V0"], first["omega0"])


def test_designs_fill_their_strata():
    """A Latin hypercube and a Sobol sequence of 64 have one point in each 64th."""
    for design in ("latin", "sobol"):
        V0 = sample(64, seed=0, design=design, V0=stats.uniform(0.0, 1.0), omega0=stats.uniform(0.0, 1.0))["V0"]
        assert np.array_equal(np.sort(np.floor(64 * V0)), np.arange(64))


def test_sample_follows_its_distribution():
    drawn = sample(4096, seed=1, V0=stats.norm(2.0, 0.5))["V0"]
    assert stats.kstest(drawn, stats.norm(2.0, 0.5).cdf).pvalue > tol.KOLMOGOROV


def test_a_sample_feeds_an_ensemble():
    drawn = sample(8, seed=5, design="sobol", V0=stats.uniform(0.5, 1.0), omega0=0.5, mu=stats.uniform(0.1, 0.2))
    result = vr.ensemble(SCENE.replace(mu=drawn["mu"]), drawn["V0"], drawn["omega0"], T)
    assert result.messages() == {vr.MOTION_STATUS[vr.MotionStatus.DONE]: 8}


def test_constants_alone():
    assert sample(3, seed=0, design="sobol", V0=1.0)["V0"].tolist() == [1.0, 1.0, 1.0]
    assert sample(5, seed=0, design="sobol", V0=stats.uniform())["V0"].shape == (5,)
    assert sample(1, seed=0, design="sobol", V0=stats.uniform())["V0"].shape == (1,)


@pytest.mark.parametrize(
    ("change", "text"),
    [
        ({"n": 0}, "n = 0: must be a whole number >= 1"),
        ({"n": 2.5}, "n = 2.5"),
        ({"seed": -1}, "seed = -1: must be a whole number >= 0"),
        ({"seed": None}, "seed = None"),
        ({"design": "grid"}, "design = 'grid': must be out of random, latin, sobol"),
        ({"V0": math.nan}, "V0 = nan: must be a finite number or a frozen scipy.stats distribution"),
        ({"V0": "fast"}, "V0 = fast"),
        ({"V0": [1.0, 2.0]}, "V0 = [1.0, 2.0]"),
        ({"V0": None}, "V0 = None"),
        ({"V0": {}}, "V0 = {}"),
        ({"V0": 1j}, "V0 = 1j"),
        ({"V0": True}, "V0 = True"),
        ({"V0": stats.uniform([0.0, 1.0], 1.0)}, "V0 = <scipy"),
        ({"V0": stats.norm(0.0, -1.0)}, "V0 = <scipy"),
        ({"V0": stats.gamma}, "V0 = <scipy"),
        ({"V0": stats.norm(0.0, 1e308), "n": 64}, "inf: must be a finite number"),
        ({"n": True}, "n = True: must be a whole number >= 1"),
        ({"n": 2**30 + 1, "design": "sobol"}, "n = 1073741825: must be at most 2^30 for design 'sobol'"),
    ],
)
def test_bad_sampling(change, text):
    with pytest.raises(vr.ParameterError) as caught:
        sample(**({"n": 4, "seed": 0, "V0": stats.uniform()} | change))
    assert text in str(caught.value)
