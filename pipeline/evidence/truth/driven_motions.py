"""Thirty driven motions, one or more for every way through the regimes: what check_driven.py rolls.

Horizons are short: each ends soon behind what it is there for.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import viscoroll as vr

ramp = vr.Schedule

#: shares of the duration that outputs fall on
OUTPUT_SHARES = (0.02, 0.1, 0.25, 0.5, 0.75, 1.0)

SOFT = vr.Scene(alpha=11.0, kappa=2.91, mu=0.2, gamma=1.0, j=0.5)
ROLLER = vr.Scene(alpha=11.0, kappa=10.0, mu=0.3, gamma=0.5, j=0.5)
STIFF = vr.Scene(alpha=300.0, kappa=40.0, mu=0.6, gamma=20.0, j=0.9)
RING = vr.Scene(alpha=3.0, kappa=5.0, mu=0.15, gamma=2.0, j=1.3)
BROAD = vr.Prony(E=[2.0, 6.0], tau=[1.0, 1e-2])
THREE = vr.Prony(E=[1.5, 4.0, 9.0], tau=[1.0, 3e-2, 4e-4])
PAIR = vr.Bodies(cylinder=BROAD, base=vr.Prony(E=[1.0, 4.0], tau=[0.3, 1e-3]), share=0.7)
ON_RIGID = vr.Bodies(cylinder=BROAD, base=vr.Prony.elastic(), share=1.0)


class Driven(NamedTuple):
    """A motion: scene, start, end, and the keywords of its drive."""

    name: str
    scene: vr.Scene
    V0: float | None
    omega0: float | None
    end: float
    drive: dict[str, Any]

    @property
    def t(self) -> list[float]:
        return [self.end * share for share in OUTPUT_SHARES]


def _with(scene: vr.Scene, material: Any) -> vr.Scene:
    return scene.replace(material=material)


MOTIONS = [
    # force and torque that stay, and slopes
    Driven("pushed from rest", SOFT, 0.0, 0.0, 6.0, {"force": 0.05}),
    Driven("down a slope from rest", ROLLER, 0.0, 0.0, 8.0, {"slope": math.radians(2.0)}),
    Driven("up a slope and back down, V = 0 in stick", SOFT, 0.3, 0.3, 6.0, {"slope": -math.radians(3.0)}),
    Driven("turned by a torque, V = 0 in stick", SOFT, 0.5, 0.5, 5.0, {"torque": -0.2}),
    Driven("turned in stick at great stiffness", STIFF, 0.2, 0.2, 0.5, {"torque": -0.4}),
    Driven("slid off rest by a torque", SOFT, 0.0, 0.0, 3.0, {"torque": 0.5}),
    Driven("pushed beyond the critical slope", SOFT, 2.0, 2.0, 6.0, {"force": 0.2}),
    Driven("force and torque that hold each other", ROLLER, 0.4, 0.4, 6.0, {"force": 0.1, "torque": -0.1}),
    Driven("a heavy rim", RING, 0.4, 0.1, 4.0, {"torque": 0.06, "force": -0.02}),
    # full slip
    Driven("locked up and turned, V = 0 in slip", SOFT, 1.0, 1.0, 6.0, {"torque": -0.6}),
    Driven("backward spin, V = 0 in slip, then in stick", SOFT, 1.0, -1.0, 4.0, {"force": -0.1}),
    Driven("sliding under both, gripping", SOFT, 1.0, -1.0, 5.0,
           {"force": 0.1, "torque": ramp([0.0, 8.0], [0.05, 0.13])}),
    Driven("the stick band crossed", SOFT, 0.5, 0.9, 3.0, {"torque": ramp([0.0, 0.7, 0.7], [0.0, 0.0, -0.7])}),
    # ramps and jumps
    Driven("a torque ramp from rest: wheel spin, and grip again", SOFT, 0.0, 0.0, 5.0,
           {"torque": ramp([0.0, 3.0, 3.0, 4.5, 4.5], [0.0, 0.375, 0.375, 0.075, 0.0])}),
    Driven("a force ramp from rest", ROLLER, 0.0, 0.0, 6.0, {"force": ramp([0.0, 6.0], [0.0, 0.06])}),
    Driven("a force ramp through 0", ROLLER, 0.1, 0.1, 6.0, {"force": ramp([0.0, 6.0], [0.02, -0.05])}),
    Driven("creep zero within a ramp", SOFT, 0.5, 0.5, 4.0, {"torque": ramp([0.0, 4.0], [0.15, -0.1])}),
    Driven("a jump there and back", RING, 0.3, 0.3, 4.0, {"torque": ramp([1.0, 1.0, 2.0, 2.0], [0.0, 0.1, 0.1, 0.0])}),
    # feedback
    Driven("a speed controller", SOFT, 0.2, 0.2, 5.0, {"torque": vr.Feedback(0.3, V=-0.5)}),
    Driven("an engine with a falling torque", ROLLER, 0.0, 0.0, 6.0, {"torque": vr.Feedback(0.2, omega=-0.3)}),
    # prescribed speeds
    Driven("a motor's speed that rises and falls", ROLLER, 0.2, None, 5.0,
           {"omega": ramp([0.0, 3.0, 6.0], [0.2, 1.0, -0.4])}),
    Driven("a motor started from rest", SOFT, 0.0, None, 3.0, {"omega": ramp([0.0, 3.0], [0.0, 0.3]), "force": -0.02}),
    Driven("towed ever faster against a brake", ROLLER, None, 0.3, 5.0,
           {"V": ramp([0.0, 5.0], [0.3, 0.6]), "brake": 0.05}),
    # brakes
    Driven("braked to a lock and held", SOFT, 0.5, 0.5, 3.0, {"brake": 0.5}),
    Driven("a brake that rises on a spinning wheel", SOFT, 0.5, 1.5, 5.0, {"brake": ramp([0.0, 6.0], [0.1, 0.4])}),
    Driven("held by a brake until the force is too much", ROLLER, 0.0, 0.0, 6.0,
           {"brake": 0.05, "force": ramp([0.0, 8.0], [0.0, 0.2])}),
    # several relaxation times, unlike bodies
    Driven("three times, turned in stick", _with(ROLLER, THREE), 0.15, 0.15, 3.0, {"torque": -0.15}),
    Driven("two times, started by a ramp", _with(SOFT, BROAD), 0.0, 0.0, 3.0, {"torque": ramp([0.0, 2.0], [0.0, 0.3])}),
    Driven("unlike bodies down a slope", _with(ROLLER, PAIR), 0.0, 0.0, 6.0, {"slope": math.radians(2.0)}),
    Driven("on a rigid base, pushed back while it slides", _with(ROLLER, ON_RIGID), 0.4, -0.3, 4.0, {"force": -0.05}),
]  # fmt: skip
