"""Motions in extended precision: Eq. (22), free or with forces, slopes, brakes, prescribed speeds, in Arb's digits.

Shares nothing with the kernels but the equations: the matching conditions of the material as they stand, collocation
of high order, steps that end at every change of the law, every corner of the drive and every output.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import flint
from flint import arb

from viscoroll import Bodies
from viscoroll.core.errors import ConvergenceError
from viscoroll.scene import Scene

from .collocation import Radau, radau, weighted
from .load import Piece, pieces_of
from .material import material_of
from .phases import Law, Phase, begun, departed, leaving, sign
from .step import left_out, met

PATHS = ("x", "angle", "work_force", "work_torque", "brake_loss", "slip_loss")
_MOST_STEPS = 20_000
_GROWTH, _SHRINK, _SAFETY, _LEAST_ERROR, _SHORTEST = 4.0, 0.2, 0.8, 1e-60, 1e-40
#: first step of a phase over what is left, and of one into partial slip; share of the way to the end of a stick zone
_FIRST, _ENTRY, _APPROACH = 1e-3, 1e-14, 0.9


@dataclass
class PreciseMotion:
    """What is found at the times ``t``, as ``arb`` without a radius.

    switches : pairs of time and regime that follows ("rest" with V = omega = 0)
    reversals : times at which V changes its sign
    """

    t: list[float]
    V: list[Any] = field(default_factory=list)
    omega: list[Any] = field(default_factory=list)
    x: list[Any] = field(default_factory=list)
    angle: list[Any] = field(default_factory=list)
    work_force: list[Any] = field(default_factory=list)
    work_torque: list[Any] = field(default_factory=list)
    brake_loss: list[Any] = field(default_factory=list)
    slip_loss: list[Any] = field(default_factory=list)
    switches: list[tuple[Any, str]] = field(default_factory=list)
    reversals: list[Any] = field(default_factory=list)
    steps: int = 0

    @property
    def onset_time(self) -> Any:
        """First change from full to partial slip, or None."""
        return next((when for when, regime in self.switches if regime == "partial slip"), None)


def roll_precise(
    scene: Scene,
    V0: float | None,
    omega0: float | None,
    t: Sequence[float],
    *,
    slope: float | None = None,
    tolerance: float = 1e-22,
    nodes: int = 22,
    bits: int = 220,
    **drive: Any,
) -> PreciseMotion:
    """Motion from (V0, omega0) at ascending times ``t`` > 0; every argument is the exact double it is.

    Parameters
    ----------
    scene : one scene, of a material or of two bodies that share no creep time.
    slope : angle in radians.
    tolerance : what a step may leave out, relative to the largest speed in it.
    nodes : of the collocation, whose order is twice that less one.
    bits : working precision.
    **drive : force, torque, brake, V, omega as for :func:`viscoroll.roll`: numbers, schedules, Feedback.

    Raises
    ------
    ConvergenceError
        If a motion takes more than 20000 steps, or a step becomes too small.

    Notes
    -----
    ``data/reference/check_driven.json`` states for every motion there how far other nodes and tolerances are off
    (``tests/evidence/test_precise.py``).
    """
    with flint.ctx.workprec(bits):
        theta = arb(float(slope or 0.0))
        kappa, mu, gamma, j = (arb(float(value)) for value in (scene.kappa, scene.mu, scene.gamma, scene.j))
        kappa, gamma = (kappa / theta.cos().sqrt()).mid(), (gamma * theta.cos()).mid()
        material = scene.material
        if isinstance(material, Bodies) and scene.like_bodies:
            material = material.cylinder
        law = Law(material_of(float(scene.alpha) if material is None else material), kappa, mu, j)
        motion = PreciseMotion([float(time) for time in t])
        ends = [(gamma * arb(time)).mid() for time in motion.t]
        pieces = pieces_of(drive, gamma, theta.tan().mid(), ends[-1])
        first = {name: arb(float(value or 0.0)) for name, value in (("V", V0), ("omega", omega0))}
        if pieces[0].prescribed:
            first[pieces[0].prescribed] = pieces[0].lines[pieces[0].prescribed][0]
        rolling = _Rolling(law, pieces, motion, gamma, (radau(nodes, bits), tolerance), **first)
        for end in ends:
            while rolling.tau < end:
                rolling.go_on(end)
            rolling.keep()
    return motion


class _Rolling:
    """A motion up to tau: its phase (None at rest), the piece of the drive, what has added up, the step to be tried."""

    def __init__(
        self,
        law: Law,
        pieces: list[Piece],
        motion: PreciseMotion,
        gamma: Any,
        how: tuple[Radau, float],
        V: Any,
        omega: Any,
    ) -> None:
        self.law, self.motion, self.gamma, self.tau, self.h = law, motion, gamma, arb(0), arb(0)
        self.method, self.tolerance = how
        self.piece, *self.pieces = pieces
        self.phase, self.heading = begun(law, self.piece, V, omega), sign(V)
        self.paths = [arb(0)] * len(PATHS)
        self._leave()

    @property
    def regime(self) -> str:
        if self.phase is None:
            return "held" if self.piece.braked or self.piece.prescribed else "rest"
        return self.phase.regime

    def keep(self) -> None:
        """What is found now."""
        contact = self.phase.contact() if self.phase else None
        self.motion.V.append(contact.V if contact else arb(0))
        self.motion.omega.append(contact.omega.mid() if contact and self.regime != "locked" else arb(0))
        for name, value in zip(PATHS, self.paths, strict=True):
            getattr(self.motion, name).append((value / self.gamma).mid() if name in ("x", "angle") else value)

    def go_on(self, end: Any) -> None:
        """One step, or the stay at rest, no further than the end, the next corner of the drive or the first event."""
        regime, motion = self.regime, self.motion
        if self.tau >= self.piece.end:
            self.piece, self.h = self.pieces.pop(0), arb(0)
            self.phase = self.phase and self.phase.under(self.piece, self.tau)
        limit = min(end, self.piece.end)
        if self.phase is None:
            self.tau = min(leaving(self.piece, self.law, self.tau), limit)
        else:
            self._step(self.phase, limit)
        self._leave()
        motion.steps += 1
        if motion.steps == _MOST_STEPS:
            raise ConvergenceError(f"roll_precise: more than {_MOST_STEPS} steps")
        when = (self.tau / self.gamma).mid()
        if self.regime != regime:
            motion.switches.append((when, self.regime))
        heading = self.phase.ahead if self.phase else 0
        if heading and self.heading and heading != self.heading:
            motion.reversals.append(when)
        self.heading = heading or self.heading

    def _leave(self) -> None:
        """From rest, if something moves the cylinder now."""
        if self.phase is None and self.tau < self.piece.end and leaving(self.piece, self.law, self.tau) == self.tau:
            self.phase, self.h = departed(self.piece, self.law, self.tau), arb(0)

    def _step(self, phase: Phase, limit: Any) -> None:
        left = (limit - self.tau).mid()
        if not self.h > 0:
            self.h = (left * (_ENTRY if phase.sticks and phase.u[1] == 1 else _FIRST)).mid()
        h = min(self.h, left)
        while True:
            if h < _SHORTEST * left:
                raise ConvergenceError("roll_precise: the step has become too small")
            event, length, values = met(phase, self.tau, h, self.method)
            factor = _SHRINK
            if values is not None:
                error = left_out(phase, values, self.method)
                factor = _SAFETY * (self.tolerance / max(error, _LEAST_ERROR)) ** (1 / len(self.method.nodes))
                if error <= self.tolerance:
                    break
            h = (h * max(_SHRINK, min(factor, 0.7))).mid()
        at_nodes = zip(values, self.method.nodes, strict=True)
        rates = [phase.paths(u, self.tau + length * c) for u, c in at_nodes]
        for n, column in enumerate(zip(*rates, strict=True)):
            self.paths[n] = (self.paths[n] + length * weighted(self.method.weights, column)).mid()
        self.tau = limit if event is None and length == left else (self.tau + length).mid()
        self.phase = phase.after(event, values[-1], self.tau)
        if event is not None or (self.phase is not None and self.phase.sticks != phase.sticks):
            self.h = arb(0)
            return
        grown = min(_GROWTH, factor) * length
        if phase.sticks and values[-1][1] > values[-2][1]:  # no further than a share of the way to full slip
            rate = (values[-1][1] - values[-2][1]) / (1 - self.method.nodes[-2]) / length
            grown = min(grown, _APPROACH * (1 - values[-1][1]) / rate)
        self.h = grown.mid()
