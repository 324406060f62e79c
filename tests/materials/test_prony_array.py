"""Many materials, one for each state or motion: the same bits as one after the other."""

from __future__ import annotations

import memory
import numpy as np
import pytest
import tolerances as tol
from closeness import close
from refusals import refused

import viscoroll as vr
from viscoroll.kernels.material.tabulated import Tabulated
from viscoroll.materials.tables import _series_table, records, series

pytestmark = pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")  # the paper's own scene is beyond the model

COUNT = 12
FIELDS = ("lam", "zeta", "epsilon", "delta_star", "beta", "Q", "M", "dQ_dV", "dM_dV")
SCENE = {"kappa": 2.91, "mu": 0.2, "gamma": 700.0}
T = np.linspace(0.0, 3e-2, 30)


def materials(modes: int, creep: bool = False, count: int = COUNT) -> vr.Prony:
    """Random ones; some with a mode less, of strength 0 or of equal times, and one elastic."""
    draw = np.random.default_rng(modes)
    times = 10.0 ** draw.uniform(-4.0, 3.0, (count, modes))
    strengths = 10.0 ** draw.uniform(-1.0, 1.0, (count, modes))
    if creep and modes:
        strengths *= 0.9 / strengths.sum(axis=1, keepdims=True)
    if modes > 2:
        strengths[1, 2], times[4, 1], strengths[5] = 0.0, times[4, 0], 0.0
    return (vr.Prony.creep if creep else vr.Prony)(strengths, times)


@pytest.mark.parametrize("creep", [False, True])
def test_they_are_what_single_ones_are(creep):
    """Strengths, times, alpha, and every number that a kernel is given, for 1 to 30 modes."""
    for modes in (0, 1, 3, 9, 30):
        many = materials(modes, creep)
        record, unit = records(many, np.arange(COUNT))
        for i, one in enumerate(many):
            own, time = one.in_own_time()
            assert (many.alpha[i], unit[i]) == (one.alpha, time)
            assert one == many[i] == many[i : i + 2][0]
            count, alone = record.bins[i, 2], series(own)
            *vectors, Q = map(np.ravel, alone)
            packed = np.concatenate([*vectors, np.ones(count), Q])
            assert np.array_equal(record.packed[i, : packed.size], packed)
            if count:
                table: Tabulated = _series_table(own)
                known = (table.alpha, table.T_mean, table.tau, *table.ends[1:])
                assert tuple(record.numbers[i]) == known
        assert np.array_equal(many.slower(2.0).alpha, many.alpha)


def test_one_of_the_two_may_be_shared():
    shared = vr.Prony([[1.0, 2.0], [3.0, 4.0]], [1.0, 0.1])
    assert (len(shared), shared.shape) == (2, (2,))
    assert shared[1] == vr.Prony([3.0, 4.0], [1.0, 0.1])
    assert shared == vr.Prony([[1.0, 2.0], [3.0, 4.0]], [1.0, 0.1])
    assert hash(shared) == hash(vr.Prony([[1.0, 2.0], [3.0, 4.0]], [1.0, 0.1]))
    assert vr.Prony([1.0, 2.0], [[1.0, 0.1], [2.0, 0.1]])[1] == vr.Prony([1.0, 2.0], [2.0, 0.1])
    near = vr.Prony.creep([[0.3, 0.6], [0.2, 0.7]], [1.0, 0.1], alpha=[10.0, 1.0 / (1.0 - 0.9)])
    assert near.alpha.tolist() == [10.0, 1.0 / (1.0 - 0.9)]
    assert vr.Scene(material=shared, kappa=[[1.0], [2.0], [3.0]], mu=0.1).shape == (3, 2)
    assert "2 series of 2 modes" in repr(shared)


def test_contact_of_a_material_each():
    """As of single ones, by their numbers over an axis."""
    many = materials(3)
    V = np.geomspace(1e-4, 1e3, 5)[:, None] * np.array([1.0, -1.0] * (COUNT // 2))
    for given in ({"delta": 1e-3}, {"omega": 1.001 * V}):
        found = vr.contact(vr.Scene(material=many, **SCENE), V, **given, fields=FIELDS)
        for i, one in enumerate(many):
            creep = {name: value if np.ndim(value) == 0 else value[:, i] for name, value in given.items()}
            alone = vr.contact(vr.Scene(material=one, **SCENE), V[:, i], **creep, fields=FIELDS)
            scales = {"dQ_dV": SCENE["mu"], "dM_dV": alone.M}
            for name in FIELDS:
                exact, scale = getattr(alone, name), scales.get(name, 0.0) / V[:, i]
                rel = tol.SERIES_SLOPE if name in scales else tol.SERIES_STATES
                assert close(getattr(found, name)[:, i], exact, rel=rel, scale=scale, what=f"{name} {i}")


def test_stress_of_a_material_each():
    many = materials(3)
    x = np.linspace(-0.6, 0.9, 7)[:, None]
    found = vr.stress(vr.Scene(material=many, **SCENE), x, 0.3, delta=1e-3)
    for i, one in enumerate(many):
        alone = vr.stress(vr.Scene(material=one, **SCENE), x[:, 0], 0.3, delta=1e-3)
        for name in ("p", "tau"):
            exact = getattr(alone, name)
            assert close(getattr(found, name)[:, i], exact, rel=tol.SERIES_STATES, scale=exact.max())


@pytest.mark.parametrize("creep", [False, True])
def test_an_ensemble_is_its_motions(creep):
    """``roll`` of each, to what rounding of its rows moves it, and the same bits for any number of threads."""
    many = materials(3, creep, 100)
    draw = np.random.default_rng(5)
    start = draw.uniform(-2.0, 2.0, (2, 100))
    scene = vr.Scene(material=many, kappa=2.91, mu=draw.uniform(0.1, 0.3, 100), gamma=700.0)
    asked = {"rtol": 1e-6, "rest": 1e-3, "fields": ("V", "omega", "x", "angle", "delta", "regime")}
    found = vr.ensemble(scene, *start, T, **asked, threads=1)
    again = vr.ensemble(scene, *start, T, **asked, threads=3)
    for name in (*asked["fields"], "onset_time", "rest_time", "status", "steps"):
        assert np.array_equal(getattr(found, name), getattr(again, name), equal_nan=True)
    for i in range(0, 100, 9):
        alone = vr.Scene(material=many[i], kappa=2.91, mu=scene.mu[i], gamma=700.0)
        motion = vr.roll(alone, start[0, i], start[1, i], T, 1e-6, rest=1e-3)
        for name in ("V", "omega", "x", "angle", "delta"):
            own = getattr(motion, name)
            assert close(
                getattr(found, name)[i], own, rel=tol.MOTION_EACH, scale=np.nanmax(np.abs(own)), what=(name, i)
            )
        times = [motion.onset_time, motion.rest_time]
        assert close([found.onset_time[i], found.rest_time[i]], times, rel=tol.MOTION_EACH)


def test_losses_of_a_material_each():
    many = materials(3)
    asked = {"fields": ("slip_loss", "rolling_loss"), "method": "integrate", "rtol": 1e-6}
    found = vr.ensemble(vr.Scene(material=many, **SCENE), 1.0, 0.0, T, **asked)
    for i, one in enumerate(many):
        alone = vr.ensemble(vr.Scene(material=one, **SCENE), 1.0, 0.0, T, **asked)
        assert close(found.slip_loss[i], alone.slip_loss[0], rel=tol.MOTION_EACH)
        assert close(found.rolling_loss[i], alone.rolling_loss[0], rel=tol.MOTION_EACH, scale=1.0)


def test_memory_is_bounded_by_a_block():
    """Beside input and result four times as many motions take no more."""

    def beside(count: int) -> int:
        scene, V0 = vr.Scene(material=materials(3, count=count), **SCENE), np.full(count, 1.0)
        return memory.taken_beside(lambda: vr.ensemble(scene, V0, 0.0, T[::6], rtol=1e-3, fields="V", threads=1))

    beside(64)
    assert beside(2048) - beside(512) <= tol.MEMORY_SLACK / 10


def test_exported_with_their_series():
    many = materials(3)
    stored = vr.ensemble(vr.Scene(material=many, **SCENE), 1.0, 0.0, T[:3]).to_xarray()
    assert np.array_equal(stored.relaxation_times, many.given[1])
    assert stored.relaxation_strengths.dims == ("motion", "mode")


def test_validity_of_a_material_each():
    """As of single ones, of scenes and of ensembles."""
    many = vr.Prony([[1.0, 2.0], [0.1, 0.4], [0.0, 3.0]], [0.1, 1e-3])
    scene = vr.Scene(material=many, **SCENE)
    found = scene.validity(0.3, omega=0.1)
    for n, material in enumerate(many):
        one = scene.replace(material=material).validity(0.3, omega=0.1)
        for name in ("small_contact", "under_axis", "steady", "creep"):
            assert close(getattr(found, name).value[n], getattr(one, name).value, rel=tol.UNIT)
            assert getattr(found, name).holds[n] == getattr(one, name).holds
    fastest = vr.ensemble(scene, 0.3, 0.1, 1e-3, fields=("x",)).validity()
    assert close(fastest.small_contact.value, found.small_contact.value, rel=tol.UNIT)


def test_refused():
    many = vr.Prony([[1.0, 2.0], [3.0, 4.0]], [1.0, 0.1])
    scene = vr.Scene(material=many, **SCENE)
    for call, words in (
        (lambda: vr.Prony([[1.0, -2.0]], [1.0, 0.1]), ("E = -2.0", ">= 0")),
        (lambda: vr.Prony([[1.0, 2.0]], [[1.0, 0.0]]), ("tau = 0.0", "> 0")),
        (lambda: vr.Prony([[1.0, np.nan]], [1.0, 0.1]), ("E = nan",)),
        (lambda: vr.Prony([[1.0, 2.0]], [1.0, 0.1, 0.2]), ("E (1, 2), tau (3,)", "broadcast")),
        (lambda: vr.Prony([[[1.0]]], [1.0]), ("E, tau", "(materials, modes)")),
        (lambda: vr.Prony(np.ones((2, 65)), np.arange(1.0, 66.0)), ("at most 64",)),
        (lambda: vr.Prony([[1.0, 1.0]], [1e-20, 1e20]), ("from 1e-20 to 1e+20", "within a factor")),
        (lambda: vr.Prony([[1.0], [2e12]], [1.0]), ("E = of a sum of 2e+12", "1e+12")),
        (lambda: vr.Prony.creep([[0.5], [1.0]], [1.0]), ("J", "of a sum below 1")),
        (lambda: vr.Prony.creep([[0.5], [0.6]], [1.0], alpha=2.0), ("alpha = 2.0", "2.5")),
        (lambda: vr.Prony.creep([[0.5], [0.6]], [1.0], alpha=[1.0, 2.0, 3.0]), ("alpha", "one a material")),
        (lambda: many.slower(-1.0), ("factor",)),
        (lambda: vr.Scene(material=many, kappa=[1.0, 2.0, 3.0], mu=0.1), ("shapes", "alpha (2,), kappa (3,)")),
        (lambda: scene.validity([0.3, 0.2, 0.1]), ("shapes", "broadcast")),
        (lambda: vr.roll(scene, 1.0, 1.0, T), ("scene", "one motion")),
        (lambda: vr.ensemble(scene, 1.0, 1.0, T, method="flow"), ("method = 'flow'",)),
        (lambda: vr.contact(scene, 1.0, delta=0.0, method="direct"), ("method = 'direct'",)),
        (lambda: vr.Material(1e6, 0.5, many), ("prony", "a Prony series")),
    ):
        refused(call, *words)
    with pytest.raises(ValueError, match="read-only"):
        many.alpha[0] = 1.0
