"""Whatever is asked of the public interface: an answer without NaN, or, of what it refuses, one of
its own errors.

Short here; ``make fuzz`` runs it for ten minutes (``FUZZ_SECONDS``).
"""

import contextlib
import os
import time

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import viscoroll as vr
from viscoroll.core.errors import MotionStatus
from viscoroll.motion.ensembles import FIELDS

pytestmark = pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")

#: seconds for each of the four tests; 0: the short profile
SECONDS = float(os.environ.get("FUZZ_SECONDS", "0")) / 4.0
#: a motion that takes longer hangs
STEPS = 5000
ENDED = {MotionStatus.DONE, MotionStatus.RESTED}


def tens(low, high):
    """Numbers whose logarithm is drawn."""
    return st.floats(low, high).map(lambda p: 10.0**p)


def one_or_three(numbers):
    return numbers | st.lists(numbers, min_size=3, max_size=3)


# --- what is accepted: every example reaches the law ---

alphas = st.just(1.0) | tens(-12.0, 0.0).map(lambda above: 1.0 + above) | tens(0.0, 6.0)
series = st.lists(st.tuples(tens(-2.0, 4.0), tens(-6.0, 0.0)), min_size=1, max_size=4).map(
    lambda modes: vr.Prony(*np.transpose(modes))
)
#: the contact hardly longer than the radius
others = {
    "kappa": tens(-1.0, 6.0),
    "mu": tens(-3.0, 2.0),
    "gamma": tens(-6.0, 6.0),
    "j": st.floats(0.05, 3.0),
}
of_alpha = st.builds(vr.Scene, alphas, **others)
scenes = of_alpha | st.builds(vr.Scene, material=series, **others)
arrays = st.builds(
    vr.Scene,
    one_or_three(alphas),
    **{name: one_or_three(values) for name, values in others.items()},
)
signs = st.sampled_from([-1.0, 1.0])
speeds = st.sampled_from([0.0, -0.0]) | st.builds(
    np.multiply, signs, tens(-3.0, 3.0) | tens(-150.0, 95.0)
)
creeps = st.just(0.0) | st.builds(np.multiply, signs, tens(-5.0, 2.0) | tens(-150.0, 99.0))
times = st.lists(st.just(0.0) | tens(-6.0, 6.0), min_size=1, max_size=4).map(sorted)

# --- what is not, mostly ---


def long_or_short(examples):
    """``examples``, or as many times that number as fit into the time of a long run."""

    def decorate(test):
        once = settings(max_examples=examples, deadline=None)(test)

        def again():
            end = time.monotonic() + SECONDS
            while time.monotonic() < end:
                once()

        return again if SECONDS else once

    return decorate


@long_or_short(80)
@given(scenes | arrays, one_or_three(speeds), one_or_three(creeps), st.booleans(), st.booleans())
def test_contact(scene, V, creep, is_omega, slopes):
    state = scene.contact(V, **{"omega" if is_omega else "delta": creep}, slopes=slopes)
    for name, values in state.as_dict().items():
        assert not np.isnan(values).any(), name
    for name in state.as_dict().keys() - {"zeta", "delta", "dQ_domega", "dQ_dV"}:
        assert np.isfinite(state[name]).all(), name
    assert np.all(abs(state.Q) <= scene.mu)
    assert np.all((state.beta >= 0.0) & (state.beta <= 1.0))
    assert np.all(state.lam <= 1.0)


@long_or_short(80)
@given(scenes, one_or_three(speeds), one_or_three(speeds), creeps, st.booleans())
def test_stress_and_validity(scene, x, V, creep, is_omega):
    found = scene.stress(x, V, **{"omega" if is_omega else "delta": creep})
    assert np.isfinite([found.p, found.tau]).all()
    assert np.all(found.p >= 0.0)
    assert np.all(abs(found.tau) <= scene.mu * found.p * (1.0 + 1e-15))
    assert str(scene.validity(V))


@long_or_short(60)
@given(
    scenes,
    speeds,
    speeds,
    times,
    tens(-11.0, -3.0),
    st.none() | tens(-6.0, 3.0),
    st.sampled_from(["auto", "integrate"]),
)
def test_motion(scene, V0, omega0, t, rtol, rest, method):
    options = {"rtol": rtol, "rest": rest, "max_steps": STEPS}
    many = scene.ensemble(V0, omega0, t, method=method, fields=FIELDS, **options)
    assert set(many.status) <= ENDED
    for name in ("V", "omega", "x", "angle"):
        assert np.isfinite(getattr(many, name)).all(), name
    one = scene.roll(V0, omega0, t, **options)
    assert one.status == many.status[0] or method != "integrate"


#: parameters at the ends of the doubles, where most are refused
widest = {
    "kappa": tens(-1.0, 259.0),
    "mu": tens(-30.0, 0.0),
    "gamma": tens(-300.0, 300.0),
    "j": tens(-300.0, 300.0),
}
far = st.builds(vr.Scene, alphas, **widest) | st.builds(vr.Scene, material=series, **widest)


@long_or_short(60)
@given(far, st.builds(np.multiply, signs, tens(-300.0, 300.0)), creeps, tens(-300.0, 0.0))
def test_the_ends_of_the_ranges(scene, V, creep, share):
    """An answer or a refusal without a warning of numpy, which the suite takes as an error."""
    calls = (
        lambda: scene.contact(V, delta=creep, slopes=True),
        lambda: scene.contact(V, omega=V * (1.0 + share)),
        lambda: scene.law()(V, V * (1.0 + share), slopes=True),
        lambda: scene.steady(V=V, torque=share * scene.mu),
        lambda: scene.steady(force=share * scene.mu),
        lambda: str(scene.validity(V)),
        lambda: scene.stress([-1.0, 0.0, 1e-3], V, delta=creep),
    )
    for call in calls:
        with contextlib.suppress(vr.ParameterError):
            call()
