"""What changes no bit: company, order, threads."""

from concurrent.futures import ThreadPoolExecutor
from functools import partial
from threading import Barrier

import numpy as np
import pytest
from many import MATERIALS, UNLIKE
from many import states as of_all_alphas

import viscoroll as vr
from viscoroll.motion.ensembles import FIELDS

pytestmark = pytest.mark.filterwarnings(
    "ignore::viscoroll.ModelWarning"
)  # the paper's own scene is beyond the model

SCENE = vr.presets.PAPER_SECTION_5_ROUNDED
T = np.array([1e-5, 1e-3, 3e-3, 1e-1, 1.0])
X = np.linspace(-0.5, 1.0, 61)[:, None]
GRID = {"what": SCENE, "V": [0.1, 0.3, 2.0], "delta": [-0.01, 0.0, 0.03], "alpha": [1.0, 11.0]}


def states():
    """From the least to the largest speeds, a third of them in full slip."""
    rng = np.random.default_rng(1)
    V = np.concatenate(
        [
            rng.uniform(-2.0, 2.0, 1000),
            rng.choice([-1.0, 1.0], 1000) * 10.0 ** rng.uniform(-300, 50, 1000),
        ]
    )
    delta = rng.uniform(-0.04, 0.04, V.size)
    return {"V": np.append(V, 0.0), "delta": np.append(delta, 0.01)}


def states_of_alphas():
    alpha, kappa, mu, V, s = of_all_alphas(300, 5)
    V[::2] = -V[::2]
    V[7] = 0.0
    delta = 1.2 * s * vr.Scene(alpha, kappa, mu).contact(V, delta=0.0).delta_star
    return {"alpha": alpha, "kappa": kappa, "mu": mu, "V": V, "delta": delta}


def starts():
    V0, omega0 = np.random.default_rng(2).uniform(-2.0, 2.0, (2, 60))
    V0[:4] = (0.0, 1.0, 0.0, 5e-324)
    omega0[:4] = (0.0, 0.0, 1.0, 1.0)
    return {"V0": V0, "omega0": omega0}


def drives():
    rng = np.random.default_rng(3)
    return {
        "V0": rng.uniform(-1.0, 1.0, 12),
        "force": rng.normal(size=12),
        "torque": rng.normal(size=(12, 2)),
    }


def pairs_and_speeds():
    many = MATERIALS["each"]()
    return {"material": many, "V": np.geomspace(1e-4, 1e6, len(many))}


def rolled(scene, **given):
    many = scene.ensemble(t=T, rtol=1e-6, fields=FIELDS, **given)
    names = (*FIELDS, "onset_time", "rest_time", "status", "switches", "steps", "flow")
    return {name: getattr(many, name) for name in names}


#: name -> arrays of states or starts, and the call of them
CALLS = {
    "states": (states, lambda **given: SCENE.contact(**given, slopes=True).as_dict()),
    "two bodies": (
        lambda: {"V": np.concatenate([states()["V"][::40], [1e-140, 1e140]])},
        lambda V: scene_of(UNLIKE).contact(V, delta=1e-4, slopes=True).as_dict(),
    ),
    "as printed": (
        lambda: {name: values[:1000:15] for name, values in states().items()},
        lambda **given: SCENE.contact(**given, method="direct").as_dict(),
    ),
    "an alpha each": (
        states_of_alphas,
        lambda V, delta, **scene: vr.Scene(**scene).contact(V, delta=delta, slopes=True).as_dict(),
    ),
    "a pair each": (
        pairs_and_speeds,
        lambda material, V: scene_of(material).contact(V, delta=1e-3, slopes=True).as_dict(),
    ),
    "stress": (
        lambda: {name: values[:1000:40] for name, values in states().items()},
        lambda **given: {k: v.T for k, v in SCENE.stress(X, **given).as_dict().items()},
    ),
    **{method: (starts, partial(rolled, SCENE, method=method)) for method in ("integrate", "flow")},
    "driven": (
        drives,
        lambda torque, **given: rolled(
            SCENE.replace(gamma=1e3),
            omega0=0.1,
            torque=vr.Schedule([0.0, 1.0], torque),
            brake=0.05,
            **given,
        ),
    ),
}


def scene_of(material):
    return vr.Scene(material=material, kappa=2.91, mu=0.2)


def of(name, part=slice(None)):
    """What a call gives, of a part of its arrays."""
    make, call = CALLS[name]
    return {
        field: np.array(value)
        for field, value in call(**{k: v[part] for k, v in make().items()}).items()
    }


def everything():
    """All calls, a single motion and a table, as named arrays."""
    found = {f"{name}: {field}": value for name in CALLS for field, value in of(name).items()}
    motion = SCENE.roll(1.5, 0.5, T)
    found |= {f"roll: {name}": getattr(motion, name) for name in ("V", "omega", "x")}
    table = vr.tables.build(**GRID)
    found |= {f"table: {name}": values.values for name, values in table.data_vars.items()}
    middle = {str(name): axis.values.mean() for name, axis in table.coords.items()}
    found |= {
        f"between: {k}": v for k, v in vr.tables.interpolate(table, **middle).as_dict().items()
    }
    return {name: np.array(values) for name, values in found.items()}


def assert_same(found, expected):
    assert found.keys() == expected.keys()
    for name, values in expected.items():
        assert np.array_equal(found[name], values, equal_nan=values.dtype.kind == "f"), name


# --- company ---


@pytest.mark.parametrize("name", CALLS)
def test_any_company_and_any_threads(name, monkeypatch, own_maps):
    """Parts, none, backward, two by two (a single alpha has a table of its own), and on other
    numbers of threads.
    """
    whole = of(name)
    count = len(next(iter(CALLS[name][0]().values())))
    for part in (
        slice(0, 3 * (name == "a pair each")),  # of no pairs none is of unlike bodies
        slice(2, None),
        slice(None, None, -1),
        *(slice(n, n + 2) for n in range(0, count, 1 + count // 9)),
    ):
        assert_same(of(name, part), {field: values[part] for field, values in whole.items()})
    for threads in ("1", "3"):
        monkeypatch.setenv("VISCOROLL_THREADS", threads)
        assert_same(of(name), whole)


@pytest.fixture(scope="module")
def expected(maps_of_this_file):
    return everything()


# --- threads ---


@pytest.mark.long
def test_called_from_several_threads_at_once(expected, own_maps):
    """The same bits as one call alone, with nothing at hand when they start."""
    together = Barrier(2)

    def work(_):
        together.wait()
        return everything()

    with ThreadPoolExecutor(2) as pool:
        for found in pool.map(work, range(2)):
            assert_same(found, expected)


# --- numpy ---


def test_numpy_set_to_raise(expected, own_maps):
    with np.errstate(all="raise"):
        found = everything()
    assert_same(found, expected)
