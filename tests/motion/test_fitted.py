"""Callables of time as polynomials: how near, in how many values; and the motions that they
drive.
"""

import math
from functools import partial

import numpy as np
import pytest
import tolerances as tol
from closeness import close
from drives import ROLLER
from refusals import refused

import viscoroll as vr
from viscoroll.motion import drive_pieces

END = 20.0
#: smooth and steep; from next to nothing; with corners; with jumps; with a slope without bounds
CALLABLES = {
    "tanh": lambda t: 0.05 * (1.0 + math.tanh((t - 1.0) / 0.02)),
    "steep tanh": lambda t: 0.05 * (1.0 + math.tanh((t - 1.0) / 1e-6)),
    "Gauss pulse": lambda t: 0.1 * math.exp(-(((t - 3.0) / 0.1) ** 2)),
    "exp(-1/t)": lambda t: 0.05 * math.exp(-1.0 / t) if t > 0.0 else 0.0,
    "sine": lambda t: 0.1 * math.sin(2.0 * math.pi * t),
    "half waves": lambda t: 0.1 * max(0.0, math.sin(t)),
    "chain": lambda t: float(np.interp(t, [0.0, 1.0, 2.0, 7.0], [0.0, 0.1, -0.02, 0.05])),
    "root": lambda t: 0.02 * math.sqrt(t),
    "square wave": lambda t: 0.1 * math.copysign(1.0, math.sin(3.0 * t)),
}


class Counted:
    """A callable that counts its calls."""

    def __init__(self, function):
        self.function = function
        self.calls = 0

    def __call__(self, t):
        self.calls += 1
        return float(self.function(t))


@pytest.mark.parametrize("rtol", [1e-2, 1e-6, 1e-12])
@pytest.mark.parametrize("name", CALLABLES)
def test_a_callable_is_met_in_few_values(name, rtol):
    """Off by a tenth of rtol of the largest value so far, in thousands of values; most of these
    took no end of them.
    """
    function = Counted(CALLABLES[name])
    t = np.sort(np.random.default_rng(3).uniform(0.0, END, 2000))
    m = ROLLER.roll(0.5, 0.5, t, rtol=rtol, torque=function)
    assert function.calls <= tol.CALLABLE_VALUES
    exact = np.array([function(one) for one in t])
    so_far = np.maximum.accumulate(abs(exact))
    largest = so_far[-1]
    least = max(tol.CALLABLE_FOOT, tol.CALLABLE_ROUNDING / rtol) * largest
    share = tol.CALLABLE_SHARE * rtol
    assert close(m.torque, exact, share, scale=np.maximum(so_far, least))
    assert m.drive_error <= tol.CALLABLE_SHARE * max(rtol, tol.CALLABLE_ROUNDING) * largest


def test_what_polynomials_do_not_follow_is_refused(monkeypatch):
    """Noise, and a wave of 10^10 periods: the first after some halvings, the second after as many
    values as it may.
    """
    monkeypatch.setattr(drive_pieces, "MOST", 5_000)
    words = "torque is a function of t that could not be approximated near t = "
    for given in (lambda t: float(hash(t) % 997), lambda t: math.sin(1e10 * t)):
        function = Counted(given)
        refused(partial(ROLLER.roll, 0.5, 0.5, END, torque=function), words, "Schedule")
        assert function.calls <= 2 * drive_pieces.MOST


@pytest.mark.parametrize("roll", [ROLLER.roll, ROLLER.ensemble])
def test_a_narrow_pulse_is_seen_where_it_is_resolved(roll):
    """A pulse of END/8000, between two of the thousand samples that are taken without
    ``resolve``.
    """
    width = END / 8000.0
    at = END * 0.5

    def pulse(t):
        return 20.0 * (at < t < at + width)

    corners = vr.Schedule([at, at, at + width, at + width], [0.0, 20.0, 20.0, 0.0])
    exact, free = (roll(0.1, 0.1, [END], torque=torque).V for torque in (corners, None))
    missed = roll(0.1, 0.1, [END], torque=pulse).V
    seen = roll(0.1, 0.1, [END], torque=pulse, resolve=0.5 * width).V
    assert np.array_equal(missed, free)
    assert close(seen, exact, tol.CALLABLE_PULSE)
    assert abs(exact - free).min() > tol.CALLABLE_PULSE_ACTS * abs(exact).max()


@pytest.mark.parametrize("name", ["tanh", "Gauss pulse", "exp(-1/t)", "half waves"])
def test_speeds_prescribed_by_callables(name):
    """omega is what was prescribed, at every tolerance, and the motion that at a tight one."""
    t = np.linspace(0.0, END, 41)
    exact = np.array([CALLABLES[name](one) for one in t])
    best = ROLLER.roll(0.0, None, t, rtol=1e-12, omega=CALLABLES[name])
    for rtol in (1e-2, 1e-8):
        m = ROLLER.roll(0.0, None, t, rtol=rtol, omega=CALLABLES[name])
        assert m.steps < tol.CALLABLE_STEPS
        assert close(m.omega, exact, rtol, scale=abs(exact).max())
        assert close(m.V, best.V, rtol, scale=abs(exact).max())
