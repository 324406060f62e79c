"""A roller that is driven, and drives that data files hold: numbers, schedules and gains in plain
words.
"""

import math
from typing import NamedTuple

from scipy.integrate import solve_ivp

import viscoroll as vr

ROLLER = vr.Scene(11.0, 10.0, 0.3, 0.5)
#: the paper's, in which a time of 1/gamma is 1
PAPER = vr.Scene(11.0, 2.91, 0.2, 1.0)
#: whose law is unsteady
RUBBER = ROLLER.replace(gamma=18.0)
#: fits of src/viscoroll/datasets/dma.csv, and a roller of them as of docs/validity.md: 0.1 m,
#: T_ref 3 s, so that V = 30 is 1 m/s
DMA = vr.Prony([0.3, 0.5, 0.8, 1.3], [1.0, 0.1, 0.01, 0.001])
ON_DMA = vr.Scene(material=DMA, kappa=10.6, mu=0.5, gamma=882.9)


class Wave(NamedTuple):
    """A callable of time: mean + amplitude sin(rate t + phase)."""

    mean: float
    amplitude: float
    rate: float
    phase: float

    def __call__(self, t):
        return self.mean + self.amplitude * math.sin(self.rate * t + self.phase)

    def __rmul__(self, factor):  # type: ignore[override]
        return self._replace(mean=factor * self.mean, amplitude=factor * self.amplitude)


def given(plain):
    """As calls take them."""
    if not isinstance(plain, dict):
        return plain
    if "sine" in plain:
        return Wave(plain["mean"], *plain["sine"])
    if "times" in plain:
        return vr.Schedule(**plain)
    return vr.Feedback(**plain | {"value": given(plain["value"])})


def solved(scene, V0, omega0, t, force=0.0, torque=0.0, unsteady=False):
    """V and omega at times t by Radau's method on the equations of motion with the bound law; of
    two bodies of one material also with N.
    """
    law = scene.law()

    def rates(_, speeds):
        loads = law(*speeds)
        N = unsteady and scene.contact(speeds[0], delta=0.0, fields="N").N
        pull = scene.gamma * (loads.Q - loads.M_half_space + force)
        V_rate = pull / (1.0 + 0.5 * scene.gamma * N)
        moment = loads.M_cylinder + 0.5 * N * V_rate
        return V_rate, scene.gamma / scene.j * (torque - loads.Q - moment)

    start = V0, omega0
    return solve_ivp(rates, (0.0, t[-1]), start, "Radau", t, rtol=1e-11, atol=1e-14).y
