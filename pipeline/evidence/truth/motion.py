"""Motions in extended precision: Eq. (22), free or with forces, slopes, brakes, prescribed speeds, in Arb's digits.

Shares nothing with the kernels but the equations: the matching conditions of the material as they stand, collocation
of high order, steps that end at every change of the law, every corner of the drive and every output.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from viscoroll.core.errors import ConvergenceError, ParameterError
from viscoroll.core.extras import imported
from viscoroll.scene import Scene

from .collocation import Radau, radau
from .load import Piece, course_of, pieces_of
from .phases import Law, Phase, Sticking, sign
from .rest import begun, departed, leaving
from .solid import solid_of
from .step import met, solved

PATHS = ("x", "angle", "work_force", "work_torque", "brake_loss", "slip_loss")
_MOST_STEPS = 20_000
_GROWTH, _SHRINK, _SAFETY, _LEAST_ERROR, _SHORTEST = 3.0, 0.2, 0.8, 1e-60, 1e-30


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
        return next((when for when, regime in self.switches if regime == Sticking.regime), None)


@dataclass
class _State:
    """Phase (None at rest), tau, the piece, what has added up, the step to be tried, and the last sign of V."""

    phase: Phase | None
    tau: Any
    piece: Piece
    paths: list[Any]
    h: Any
    heading: int


def roll_precise(
    scene: Scene,
    V0: float | None,
    omega0: float | None,
    t: Sequence[float],
    *,
    slope: float | None = None,
    tolerance: float = 1e-20,
    nodes: int = 22,
    bits: int = 200,
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
    ParameterError
        Both speeds prescribed.
    MissingDependencyError
        If python-flint or mpmath is not installed.
    ConvergenceError
        If a motion takes more than 20000 steps, or a step becomes too small.

    Notes
    -----
    ``data/reference/check_driven.csv`` states for every motion there how far other nodes and tolerances are off
    (``tests/truth/test_driven.py``).
    """
    flint = imported("flint", "python-flint", "dev")
    arb = flint.arb
    with flint.ctx.workprec(bits):
        theta = arb(float(slope or 0.0))
        kappa, mu, gamma, j = (arb(float(value)) for value in (scene.kappa, scene.mu, scene.gamma, scene.j))
        kappa, gamma = (kappa / theta.cos().sqrt()).mid(), (gamma * theta.cos()).mid()
        law = Law(solid_of(scene), kappa, mu, j)
        motion, method = PreciseMotion([float(time) for time in t]), radau(nodes, bits)
        ends = [(gamma * arb(time)).mid() for time in motion.t]
        pieces = pieces_of(drive, gamma, theta.tan().mid(), ends[-1])
        V, omega = (_start(arb, name, given, drive, gamma) for name, given in (("V", V0), ("omega", omega0)))
        state = _State(begun(law, pieces[0], V, omega), arb(0), pieces[0], [arb(0)] * len(PATHS), arb(0), sign(V))
        _leave(state, law)
        for end in ends:
            while state.tau < end:
                _go_on(state, law, pieces, motion, gamma, (end, method, tolerance))
            contact = state.phase.contact(state.phase.unknowns()) if state.phase else None
            for name in ("V", "omega"):
                getattr(motion, name).append(getattr(contact, name).mid() if contact else arb(0))
            for name, value in zip(PATHS, state.paths, strict=True):
                getattr(motion, name).append((value / gamma).mid() if name in ("x", "angle") else value.mid())
    return motion


def _start(arb: Any, name: str, given: float | None, drive: dict[str, Any], gamma: Any) -> Any:
    """A start speed, or what a prescribed one begins with."""
    if drive.get(name) is not None:
        return course_of(arb, drive[name], gamma)[0][1]
    if given is None:
        raise ParameterError(f"{name}0", None, f"a number, unless {name}= prescribes it")
    return arb(float(given))


def _regime(state: _State) -> str:
    if state.phase is None:
        return "held" if state.piece.braked or state.piece.prescribed else "rest"
    return "locked" if state.phase.locked else state.phase.regime


def _go_on(
    state: _State, law: Law, pieces: list[Piece], motion: PreciseMotion, gamma: Any, to: tuple[Any, Radau, float]
) -> None:
    """One step, or the stay at rest, no further than ``to``, the next corner of the drive or the first event."""
    end, method, tolerance = to
    regime = _regime(state)
    if state.tau >= state.piece.end:
        _take_up(state, pieces[pieces.index(state.piece) + 1])
    limit = min(end, state.piece.end)
    if state.phase is None:
        state.tau = min(leaving(state.piece, law, state.tau), limit)
    else:
        _advance(state, limit, method, tolerance)
    _leave(state, law)
    motion.steps += 1
    if motion.steps == _MOST_STEPS:
        raise ConvergenceError(f"roll_precise: more than {_MOST_STEPS} steps")
    if _regime(state) != regime:
        motion.switches.append(((state.tau / gamma).mid(), _regime(state)))
    heading = getattr(state.phase, "direction", getattr(state.phase, "ahead", 0))
    if heading and state.heading and heading != state.heading:
        motion.reversals.append((state.tau / gamma).mid())
    state.heading = heading or state.heading


def _leave(state: _State, law: Law) -> None:
    """From rest, if something moves the cylinder now."""
    if state.phase is None and state.tau < state.piece.end and leaving(state.piece, law, state.tau) == state.tau:
        state.phase, state.h = departed(state.piece, law, state.tau), 0 * state.tau


def _take_up(state: _State, piece: Piece) -> None:
    """The phase under the next piece of the drive."""
    state.piece, state.h = piece, 0 * state.tau
    phase = state.phase
    if phase is None:
        return
    phase = replace(phase, piece=piece)
    c = phase.contact(phase.unknowns())
    excess, most = phase.excess(c, state.tau)
    if phase.locked and abs(excess) > most:
        phase = replace(phase, locked=False, spin=sign(excess) if piece.braked else 0)
    elif not phase.locked:
        phase = replace(phase, spin=sign(c.omega) if piece.braked else 0)
    state.phase = phase


def _advance(state: _State, limit: Any, method: Radau, tolerance: float) -> None:
    phase, left = state.phase, (limit - state.tau).mid()
    assert phase is not None
    arb = type(left)
    if not state.h > 0:
        state.h = arb(min(phase.first_step(state.tau), 1e300))
    asked = h = min(state.h, arb(min(phase.longest(state.tau), 1e300)), left)
    while True:
        if h < _SHORTEST * left:
            raise ConvergenceError("roll_precise: the step has become too small")
        start = phase.unknowns()
        values = solved(phase, state.tau, h, phase.guess([h * c for c in method.nodes], state.tau), method)
        event, length, factor = None, h, _SHRINK
        if values is not None:
            event, length, values = met(phase, state.tau, h, values, method)
        if values is not None:
            sizes = phase.sizes(values)
            left_out = max(tail / size for tail, size in zip(method.tails(start, values), sizes, strict=True))
            factor = _SAFETY * (tolerance / max(left_out, _LEAST_ERROR)) ** (1 / len(method.nodes))
            if left_out <= tolerance:
                break
        h = (h * max(_SHRINK, min(factor, 0.7))).mid()
    paths = [phase.paths(u, state.tau + length * c) for u, c in zip(values, method.nodes, strict=True)]
    for n in range(len(PATHS)):
        state.paths[n] = (state.paths[n] + length * method.integral([rates[n] for rates in paths])).mid()
    whole = event is None and length == left
    state.tau = limit if whole else (state.tau + length).mid()
    last = values[-1]
    state.phase = phase.moved(last, state.tau) if event is None else phase.after(event, last, state.tau)
    if event is not None or type(state.phase) is not type(phase):
        state.h = 0 * length
    else:
        grown = min(_GROWTH, factor) * length
        state.h = (max(state.h, grown) if length == asked else grown).mid()
