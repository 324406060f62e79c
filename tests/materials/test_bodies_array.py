"""Many pairs of bodies, one for each state or motion: the same bits as one after the other."""

from __future__ import annotations

import memory
import numpy as np
import pytest
import tolerances as tol
from closeness import close
from refusals import refused

import viscoroll as vr
from viscoroll.materials.tables import _pair_tables, records, series

pytestmark = pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")  # the paper's own scene is beyond the model

COUNT = 12
SCENE = {"kappa": 2.91, "mu": 0.2, "gamma": 700.0}
T = np.linspace(0.0, 3e-2, 9)
FIELDS = ("lam", "epsilon", "delta_star", "Q", "M", "M_half_space", "M_cylinder", "dQ_dV", "dM_half_space_dV")


def rubbers(draw: np.random.Generator, modes: int, creep: bool = False, count: int = COUNT) -> vr.Prony:
    """Random ones; some with a mode less, of strength 0 or of equal times."""
    times, strengths = 10.0 ** draw.uniform(-4.0, 1.0, (count, modes)), 10.0 ** draw.uniform(-1.0, 1.0, (count, modes))
    if creep:
        strengths *= 0.9 / strengths.sum(axis=1, keepdims=True)
    if modes > 2:
        strengths[1, 2], times[4, 1] = 0.0, times[4, 0]
    return (vr.Prony.creep if creep else vr.Prony)(strengths, times)


def pairs(kind: str) -> vr.Bodies:
    """Of both forms, of one body for all, of rigid and elastic bodies, of like series with a share each."""
    draw = np.random.default_rng(len(kind))
    share, one = draw.uniform(0.0, 1.0, COUNT), vr.Prony([2.0, 1.0], [1.0, 1e-2])
    first = rubbers(draw, 3)
    return {
        "each": lambda: vr.Bodies(first, rubbers(draw, 3), share),
        "creep": lambda: vr.Bodies(rubbers(draw, 2, True), rubbers(draw, 3), 0.3),
        "one base": lambda: vr.Bodies(first, one, 0.6),
        "a share each": lambda: vr.Bodies(one, vr.Prony([0.5], [0.1]), share),
        "elastic base": lambda: vr.Bodies(first, vr.Prony.elastic(), share),
        "both elastic": lambda: vr.Bodies(vr.Prony.elastic(), vr.Prony.elastic(), share),
        "some rigid": lambda: vr.Bodies(first, rubbers(draw, 2), np.where(np.arange(COUNT) % 2, 1.0, 0.0)),
        "rigid cylinder": lambda: vr.Bodies(vr.Prony.elastic(), first, 0.0),
        "of one series": lambda: vr.Bodies(first, first, share),
        "of equal times": lambda: vr.Bodies(
            vr.Prony.creep(0.4 * draw.uniform(size=(COUNT, 2)), [1.0, 0.1]),
            vr.Prony.creep(0.4 * draw.uniform(size=(COUNT, 2)), [1.0, 1e-3]), share,
        ),
    }[kind]()  # fmt: skip


KINDS = (
    "each", "creep", "one base", "a share each", "elastic base", "both elastic", "some rigid", "rigid cylinder",
    "of one series", "of equal times",
)  # fmt: skip


@pytest.mark.parametrize("kind", KINDS)
def test_they_are_what_single_ones_are(kind):
    """Every number that a kernel is given."""
    many = pairs(kind)
    record, unit = records(many, np.arange(COUNT))
    for i, one in enumerate(many):
        own, time = one.in_own_time()
        assert (many.alpha[i], unit[i]) == (one.alpha, time)
        assert one == many[i] == many[i : i + 2][0]
        count = record.bins[i, 2]
        assert count == own.total.J.size
        if count:
            *vectors, Q = map(np.ravel, series(own.total))
            packed = np.concatenate([*vectors, own.half_space_weights, Q])
            assert np.array_equal(record.packed[i, : packed.size], packed)
            table = _pair_tables(own)
            bodies = [value for body in (table.half_space, table.cylinder) for value in (body.T_mean, *body.ends[1:])]
            assert record.numbers[i].tolist() == [table.alpha, table.T_mean, table.tau, *table.ends[1:], *bodies]


@pytest.mark.parametrize("kind", KINDS)
def test_an_ensemble_is_its_motions(kind):
    """``roll`` of each pair to the rounding of its rows, and bit for bit in blocks that are cut elsewhere."""
    many, draw = pairs(kind), np.random.default_rng(5)
    start, mu = draw.uniform(-2.0, 2.0, (2, COUNT)), draw.uniform(0.1, 0.3, COUNT)
    scene = vr.Scene(material=many, **SCENE | {"mu": mu})
    asked = {"rtol": 1e-6, "fields": ("V", "omega", "x", "slip_loss", "rolling_loss")}
    found = vr.ensemble(scene, *start, T, **asked, threads=1)
    for i in range(COUNT):
        motion = vr.roll(vr.Scene(material=many[i], **SCENE | {"mu": mu[i]}), *start[:, i], T, 1e-6)
        for name in ("V", "omega", "x"):
            scale = np.abs(getattr(motion, name)).max()
            assert close(
                getattr(found, name)[i], getattr(motion, name), rel=tol.MOTION_EACH, scale=scale, what=(name, i)
            )
    some = vr.Scene(material=many[3:8], **SCENE | {"mu": mu[3:8]})
    again = vr.ensemble(some, *start[:, 3:8], T, **asked, threads=2)
    for name in asked["fields"]:
        assert np.array_equal(getattr(found, name)[3:8], getattr(again, name))
    kept = 0.5 * (found.V**2 + 0.5 * found.omega**2) + found.slip_loss + found.rolling_loss
    energy = kept[:, :1]
    assert close(kept, np.broadcast_to(energy, kept.shape), rel=tol.ENERGY_OF_PAIRS)


@pytest.mark.parametrize("drive", [{"force": 0.02, "torque": [0.1] * COUNT}, {"slope": -0.02, "brake": 0.01}])
def test_driven_pairs(drive):
    many = pairs("each")
    found = vr.ensemble(vr.Scene(material=many, **SCENE), 0.5, 0.4, T, **drive, rtol=1e-6, fields=("V", "work_force"))
    single = {name: value[0] if isinstance(value, list) else value for name, value in drive.items()}
    for i, one in enumerate(many):
        motion = vr.roll(vr.Scene(material=one, **SCENE), 0.5, 0.4, T, 1e-6, **single)
        assert close(found.V[i], motion.V, rel=tol.MOTION_EACH)
        assert close(found.work_force[i], motion.work_force, rel=tol.MOTION_EACH)


def test_like_bodies_are_one_series():
    """Given as a pair they are the array of their series; with other shares the sum of both."""
    one = rubbers(np.random.default_rng(1), 3)
    for pair in (vr.Bodies(one, one), vr.Bodies(one, vr.Prony(*one.given), np.full(COUNT, 0.5))):
        assert pair.like
        scene, alike = (vr.Scene(material=given, **SCENE) for given in (pair, one))
        for call in (
            lambda scene: vr.ensemble(scene, 1.0, 0.2, T, rtol=1e-6).V,
            lambda scene: vr.contact(scene, 0.3, delta=1e-3, fields=("Q", "M_half_space")).M_half_space,
            lambda scene: vr.stress(scene, 0.1, 0.3, delta=1e-3).tau,
        ):
            assert np.array_equal(call(scene), call(alike))


@pytest.mark.parametrize("kind", KINDS)
def test_contact_of_a_pair_each(kind):
    many = pairs(kind)
    V = np.geomspace(1e-4, 1e3, 5)[:, None] * np.array([1.0, -1.0] * (COUNT // 2))
    found = vr.contact(vr.Scene(material=many, **SCENE), V, omega=1.001 * V, fields=FIELDS)
    for i, one in enumerate(many):
        alone = vr.contact(vr.Scene(material=one, **SCENE), V[:, i], omega=1.001 * V[:, i], fields=FIELDS)
        for name in FIELDS:
            exact, scale = getattr(alone, name), alone.M / V[:, i] if name == "dM_half_space_dV" else 0.0
            assert close(getattr(found, name)[:, i], exact, rel=tol.BODIES, scale=scale, what=f"{name} {i}")


def test_stress_of_a_pair_each():
    many, x = pairs("each"), np.linspace(-0.6, 0.9, 7)[:, None]
    found = vr.stress(vr.Scene(material=many, **SCENE), x, 0.3, delta=1e-3)
    for i, one in enumerate(many):
        alone = vr.stress(vr.Scene(material=one, **SCENE), x[:, 0], 0.3, delta=1e-3)
        assert close(found.p[:, i], alone.p, rel=tol.BODIES, scale=alone.p.max())
        assert close(found.tau[:, i], alone.tau, rel=tol.BODIES, scale=alone.p.max())


def test_memory_is_bounded_by_a_block():
    """Beside input and result four times as many motions take no more."""

    def beside(count: int) -> int:
        draw = np.random.default_rng(2)
        pair = vr.Bodies(rubbers(draw, 3, count=count), rubbers(draw, 3, count=count), 0.4)
        scene = vr.Scene(material=pair, **SCENE)
        return memory.taken_beside(lambda: vr.ensemble(scene, 1.0, 0.0, T[::4], rtol=1e-3, fields="V", threads=1))

    beside(64)
    assert beside(1024) - beside(256) <= tol.MEMORY_SLACK / 10


def test_exported_with_both_bodies():
    stored = vr.ensemble(vr.Scene(material=pairs("one base"), **SCENE), 1.0, 0.0, T[:3]).to_xarray()
    assert stored.cylinder_relaxation_times.dims == ("motion", "cylinder_mode")
    assert stored.half_space_relaxation_times.shape == (COUNT, 2)
    assert stored.share.values.tolist() == [0.6] * COUNT


def test_validity_of_a_pair_each():
    pairs = vr.Bodies(vr.Prony([[1.0], [3.0]], [1.0]), vr.Prony([2.0], [0.01]), 0.3)
    found = vr.Scene(material=pairs, kappa=10.0, mu=0.2, gamma=0.1).validity([0.3, 2.0]).steady
    for n, V in enumerate((0.3, 2.0)):
        one = vr.Scene(material=pairs[n], kappa=10.0, mu=0.2, gamma=0.1).validity(V).steady
        assert close(found.value[n], one.value, rel=tol.PAIR)


def test_refused():
    many, few = vr.Prony([[1.0, 2.0], [3.0, 4.0]], [1.0, 0.1]), vr.Prony([[1.0]] * 3, [1.0])
    scene, wide = (
        vr.Scene(material=vr.Bodies(many, many, 0.4), **SCENE),
        vr.Prony(np.ones((2, 40)), np.arange(1.0, 41.0)),
    )
    for call, words in (
        (lambda: vr.Bodies(many, few), ("shapes", "cylinder (2,), half_space (3,)")),
        (lambda: vr.Bodies(many, many, [0.1, 1.5]), ("share = 1.5 at row 1", "<= 1")),
        (lambda: vr.Bodies(many, many, [0.1, -0.5]), ("share = -0.5 at row 1", ">= 0")),
        (lambda: vr.Bodies(wide, wide, 0.1), ("of 80 modes together", "at most 64")),
        (lambda: vr.Bodies(many, 11.0), ("half_space = 11.0", "a Prony series")),
        (lambda: vr.Bodies(many, many, [[0.1, 0.5]]), ("share", "one for each pair")),
        (lambda: vr.Scene(material=vr.Bodies(many, many, 0.4), kappa=[1.0] * 3, mu=0.1), ("shapes", "alpha (2,)")),
        (lambda: vr.law(scene), ("material = <2 pairs", "one material")),
        (lambda: vr.roll(scene, 1.0, 1.0, T), ("scene", "one motion")),
        (lambda: vr.ensemble(scene, 1.0, 1.0, T, method="flow"), ("method = 'flow'",)),
        (lambda: vr.contact(scene, 1.0, delta=0.0, fields="N"), ("fields = 'N'", "one material")),
    ):
        refused(call, *words)
