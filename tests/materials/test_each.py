"""A material or a pair of bodies for each motion: as one after the other, whatever their
company.
"""

import memory
import numpy as np
import pytest
import tolerances as tol
from closeness import close
from many import MATERIALS, rubbers

import viscoroll as vr

pytestmark = pytest.mark.filterwarnings(
    "ignore::viscoroll.ModelWarning"
)  # the paper's own scene is beyond the model

T = np.linspace(0.0, 3e-2, 9)


def scene_of(material, mu=0.2):
    return vr.Scene(material=material, kappa=2.91, mu=mu, gamma=700.0)


@pytest.mark.parametrize("name", MATERIALS)
def test_an_ensemble_is_its_motions(name):
    """To what rounding of its rows moves each; and to the bit in blocks and on threads that are cut
    elsewhere.
    """
    many = MATERIALS[name]()
    draw = np.random.default_rng(5)
    start = draw.uniform(-2.0, 2.0, (2, len(many)))
    mu = draw.uniform(0.1, 0.3, len(many))
    fields = ("V", "omega", "x", "angle", "delta", "slip_loss", "rolling_loss")
    asked = {"rtol": 1e-6, "rest": 1e-3, "fields": fields, "method": "integrate"}
    found = scene_of(many, mu=mu).ensemble(*start, T, **asked, threads=1)
    for i in range(1, len(many), 4):  # an elastic one and one of fewer modes among them
        motion = scene_of(many[i], mu=mu[i]).roll(*start[:, i], T, rtol=1e-6, rest=1e-3)
        for field in fields:
            exact = motion[field]
            scale = max(np.nanmax(np.abs(exact)), float(field.endswith("loss")))
            assert close(found[field][i], exact, tol.MOTION_EACH, scale=scale, what=(field, i))
        times = motion.onset_time, motion.rest_time
        assert close((found.onset_time[i], found.rest_time[i]), times, tol.MOTION_EACH)
    some = slice(1, len(many) - 1)
    again = scene_of(many[some], mu=mu[some]).ensemble(*start[:, some], T, **asked, threads=3)
    for field in (*fields, "onset_time", "rest_time", "status", "steps"):
        assert np.array_equal(found[field][some], again[field], equal_nan=True), field
    kept = 0.5 * (found.V**2 + 0.5 * found.omega**2) + found.slip_loss + found.rolling_loss
    assert close(kept, np.broadcast_to(kept[:, :1], kept.shape), tol.ENERGY_OF_PAIRS)


@pytest.mark.parametrize("name", ["3 modes", "each"])
def test_stress(name):
    many = MATERIALS[name]()
    x = np.linspace(-0.6, 0.9, 7)[:, None]
    found = scene_of(many).stress(x, 0.3, delta=1e-3)
    for i, one in enumerate(many):
        alone = scene_of(one).stress(x[:, 0], 0.3, delta=1e-3)
        for field in ("p", "tau"):
            assert close(
                found[field][:, i],
                alone[field],
                tol.SERIES_STATES,
                scale=alone.p.max(),
                what=(field, i),
            )


def test_memory_is_bounded_by_a_block():
    """Beside input and result four times as many motions take no more."""

    def beside(count):
        draw = np.random.default_rng(2)
        scene = scene_of(
            vr.Bodies(rubbers(draw, 3, count=count), rubbers(draw, 3, count=count), 0.4)
        )
        return memory.taken_beside(
            lambda: scene.ensemble(1.0, 0.0, T[::4], rtol=1e-3, fields="V", threads=1)
        )

    beside(64)
    assert beside(1024) - beside(256) <= tol.MEMORY_SLACK / 10


@pytest.mark.parametrize("name", MATERIALS)
def test_an_array_is_its_members(name):
    many = MATERIALS[name]()
    for i, one in enumerate(many):
        assert one == many[i] == many[i : i + 2][0]
        assert many.alpha[i] == one.alpha
        for form in ("E", "tau", "J", "T") if isinstance(many, vr.Prony) else ():
            assert np.array_equal(getattr(many, form)[i][: one.E.size], getattr(one, form)), form
    with pytest.raises(ValueError, match="read-only"):
        many.alpha[0] = 1.0
    with pytest.raises(TypeError):
        len(many[0])
