"""The flow map against the integrator, to the error that it states; what it leaves to the
integrator; its files.
"""

import numpy as np
import pytest
import tolerances as tol
from closeness import close
from drives import PAPER
from maps import beside, decay_time
from memory import forget

import viscoroll as vr
from viscoroll.motion import flow
from viscoroll.motion.ensembles import FIELDS
from viscoroll.motion.many_motions import FLOW_PAYS
from viscoroll.motion.motion_arguments import LOSSES

SCENE = vr.presets.PAPER_SECTION_5_ROUNDED


# the paper's own scene is beyond the model
pytestmark = [
    pytest.mark.usefixtures("maps_of_this_file"),
    pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning"),
]


def starts(count, seed, scene, top=2.0):
    """Any speeds, a fifth of them inside the stick band or near it, some on the axes."""
    rng = np.random.default_rng(seed)
    V0, omega0 = rng.uniform(-top, top, (2, count))
    few = count // 5
    omega0[:few] = V0[:few] * (1.0 + scene.mu / scene.kappa * rng.uniform(-0.6, 0.6, few))
    V0[-3] = 0.0
    omega0[-2] = 0.0
    return V0, omega0


THREE = vr.Prony([2.0, 6.0, 1.0], [1.0, 0.1, 0.01])
PAIR = vr.Scene(material=vr.Bodies(THREE, THREE, 0.5), kappa=20.0, mu=0.3, gamma=1.0)
#: scene, highest speed; any scenes are those of claims (prove/motion.py, mapped)
SCENES = {
    "paper": (SCENE, 2.0),
    "alpha 1000": (PAPER.replace(alpha=1000.0), 2.0),
    "j 1.5": (PAPER.replace(j=1.5), 2.0),
    "pair": (PAIR, 2.0),
    "fast": (PAPER, 2000.0),
}


@pytest.mark.parametrize("name", SCENES)
def test_as_the_integrator_to_its_stated_error(name):
    """Speeds, way, losses, onset, regimes, against rtol 1e-12; what has no entry in the map is
    integrated.
    """
    scene, top = SCENES[name]
    V0, omega0 = starts(40, 2, scene, top)
    t = np.concatenate([np.geomspace(1e-7, 1e-1, 7), [1.0, 10.0, 200.0]]) * decay_time(scene)
    mapped = scene.ensemble(V0, omega0, t, method="flow", rtol=1e-4, fields=FIELDS)
    rolled = scene.ensemble(V0, omega0, t, method="integrate", rtol=1e-12, fields=FIELDS)
    assert mapped.success.all()
    assert np.array_equal(mapped.switches, rolled.switches)
    earliest = 6e-3 * decay_time(scene)
    assert close(mapped.onset_time, rolled.onset_time, tol.FLOW_ONSET, scale=earliest)
    by = mapped.flow
    assert np.array_equal(mapped.regime[by], rolled.regime[by])
    assert by.mean() > 0.9
    built = flow.flow_map(scene, max(abs(V0).max(), abs(omega0).max()))
    speed = np.maximum(abs(rolled.V), abs(rolled.omega))
    moved = np.maximum.accumulate(np.maximum(abs(rolled.x), abs(rolled.angle)), axis=1)
    # what is left to rest is at most V times the decay time
    path = moved + 1e-5 * decay_time(scene) * speed[:, :1]
    energy = np.broadcast_to(0.5 * (V0**2 + scene.j * omega0**2)[:, None], path.shape)
    allowed = tol.FLOW_SPEED, tol.FLOW_PATH, tol.FLOW_LOSS
    kinds = ("V", "omega"), ("x", "angle"), LOSSES
    for stated, most, size, names in zip(built.errors, allowed, (speed, path, energy), kinds):
        assert stated < most, names
        for name in names:
            assert close(mapped[name][by], rolled[name][by], stated, scale=size[by], what=name)


def deep():
    """Starts over 15 octaves of speed, and at outputs from a hundredth of the boundary layer on."""
    rng = np.random.default_rng(11)
    V0 = 2.0 ** rng.uniform(-14.0, 1.0, 200) * rng.choice([-1.0, 1.0], 200)
    star = PAPER.contact(V0, delta=0.0).delta_star
    omega0 = V0 * (1.0 + star * rng.uniform(-1.0, 1.0, 200))
    return PAPER, V0, omega0, np.array([1e-2, 1e-1, 1.0, 10.0]) * 2.0**-5 / PAPER.kappa


#: starts deep inside the stick zone, half of which had no table once; a layer that decays to
#: rounding, as with j = 1 the slow manifold is delta = 0; motions that die out, whose error was 0/0
ALL_MAPPED = {
    "deep": deep,
    "to rounding": lambda: (
        vr.Scene(2.958e10, 1.316, 1.096, 1.0, 1.0),
        [1.0, 0.5, 0.2],
        [0.2, 1.0, 0.3],
        [0.3, 1.0, 2.0, 9.0],
    ),
    "die out": lambda: (vr.Scene(2.0, 1.0, 1.0, 1.0, 1.5), [1.0], [-257.0], [1.0]),
}


@pytest.mark.parametrize("name", ALL_MAPPED)
def test_all_of_these_are_in_the_map(name):
    assert beside(*ALL_MAPPED[name]()).flow.all()


@pytest.mark.parametrize(
    "scene, start",
    [
        (
            (22.822343517896204, 0.8333393570053901, 2.219273908549868, 1.0, 0.26883872),
            (1.4596, 1.41747),
        ),
        ((1432.3597795448325, 0.8023587553693244, 0.5276418, 1.0, 0.76536526), (1.00276, 0.996196)),
    ],
)
def test_start_near_the_slow_manifold_where_rates_are_near(scene, start):
    """The stiff rate at onset is not far above the slow one: V changes much within the boundary
    layer, and the search for an earlier entry may fail: it must notice.  Starts are kappa V0 and
    kappa omega0.
    """
    scene = vr.Scene(*scene)
    V0, omega0 = np.array(start) / scene.kappa
    t = np.geomspace(1e-3, 5.0, 8) * decay_time(scene)
    spread = np.linspace(1.0 - 1e-3, 1.0 + 1e-3, 41)
    beside(scene, np.full(41, V0), omega0 * spread, t, rtol=1e-4)


@pytest.mark.parametrize("rest", [1e-12, 1e-3, 1e4, 1e9])
def test_rest(rest):
    """Of any threshold: one above all speeds of the tables leaves every motion to the
    integrator.
    """
    V0, omega0 = starts(40, 7, SCENE)
    V0[:2] = 1e-4
    omega0[:2] = -1e-4
    V0[2] = omega0[2] = 0.0
    t = np.linspace(0.0, 2e-2, 9)
    mapped, rolled = (
        SCENE.ensemble(V0, omega0, t, rest=rest, method=method, fields=FIELDS, rtol=rtol)
        for method, rtol in (("flow", 1e-8), ("integrate", 1e-11))
    )
    assert mapped.flow.any() or rest >= 1.0
    for name in ("status", "regime", "switches"):
        assert np.array_equal(mapped[name], rolled[name]), name
    assert close(mapped.rest_time, rolled.rest_time, tol.FLOW_PATH)
    pairs = (mapped.x, mapped.angle), (rolled.x, rolled.angle)
    assert close(*pairs, tol.FLOW_PATH, scale=5e-8)


SPIN = 1.4692137743888765  # by bisection on the sign of V at onset
#: scene, starts, and whether each is in the map; two slide until V and omega vanish nearly
#: together: their onset lies below every table
BEYOND = {
    "elastic": (SCENE.replace(alpha=1.0), [1.0], [0.5], [False]),
    "steady speed": (SCENE.replace(mu=0.01), [1.0], [0.5], [False]),
    "onset": (
        SCENE,
        [1.0, -1.0, -1.0, 0.0],
        [1.0, SPIN, SPIN * (1.0 + 1e-7), 0.0],
        [True, False, False, False],
    ),
    **{
        f"kappa {kappa}, V {speed}": (
            SCENE.replace(kappa=kappa),
            [speed, -speed],
            [0.5 * speed, speed],
            [False] * 2,
        )
        for kappa, speed in ((1e250, 1.0), (2.91, 1e90), (2.91, 1e-200))
    },
}


@pytest.mark.parametrize("name", BEYOND)
def test_motions_beyond_the_map_are_integrated(name):
    scene, *start, mapped_ones = BEYOND[name]
    mapped, rolled = (
        scene.ensemble(*start, [1e-9, 3e-3], method=method) for method in ("flow", "integrate")
    )
    assert name not in ("elastic", "steady speed") or name in mapped.flow_problem
    assert mapped.flow.tolist() == mapped_ones
    assert np.array_equal(mapped.V[~mapped.flow], rolled.V[~mapped.flow], equal_nan=True)
    assert np.array_equal(mapped.status, rolled.status)


def test_auto():
    V0, omega0 = starts(FLOW_PAYS, 10, SCENE)
    assert not SCENE.ensemble(V0[1:], omega0[1:], 1e-3).flow.any()
    assert SCENE.ensemble(V0, omega0, 1e-3).flow.mean() > 0.99
    tight = SCENE.ensemble(V0[:9], omega0[:9], 1e-3, method="flow", rtol=1e-12)
    assert not tight.flow.any()
    assert tight.flow_error > 1e-12
    own = SCENE.replace(mu=np.linspace(0.2, 0.3, V0.size))
    assert not own.ensemble(V0, omega0, 1e-3, rtol=1e-3).flow.any()


def test_kept_on_disk_and_built_once(monkeypatch):
    first = flow.flow_map(SCENE, 2.0)
    monkeypatch.setattr(flow, "build_map", None)
    assert flow.flow_map(SCENE, 1.9) is first  # the same power of 16
    forget()
    again = flow.flow_map(SCENE, 2.0)
    assert np.array_equal(again.table, first.table)
    assert again.errors == first.errors


def test_hardly_any_speed_left_at_onset():
    """Errors of sliding weigh as many times more as V has fallen: by 5,000 they would exceed what
    the map states.
    """
    scene = vr.Scene(79.7, 7.3, 0.165, 1.0, 1.48)
    V0 = np.random.default_rng(5).uniform(0.5, 2.0, 4000)
    t = [12.0]
    # about the spin with which nothing is left
    spins = -V0 * np.linspace(0.55, 0.65, 4000)
    found = scene.ensemble(V0, spins, t, method="flow", fields="V")
    few = np.argsort(abs(found.V[:, 0]) / V0)[:100]
    best = scene.ensemble(V0[few], spins[few], t, method="integrate", rtol=1e-12, fields="V")
    by = found.flow[few]
    assert found.flow.mean() > 0.99
    assert not by.all()
    assert close(found.V[few][by], best.V[by], found.flow_error)
