"""Motions in extended precision: Eq. (22) by collocation of high order on the law in Arb's digits.

Shares nothing with the kernels: other unknowns, another method, Bessel functions from Arb.  What a step
leaves out, by the last Legendre coefficients of its polynomials, is held below a tolerance; steps end
at every change of the law (onset of stick, its end, V = 0, zero creep) and at every output.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

from ..errors import ConvergenceError, ParameterError
from ..extras import imported
from ..scene import Scene
from .collocation import Radau, radau, zero_between
from .phases import Sliding, Sticking, begin
from .zones import Law

_MOST_STEPS = 5000
_SHORTEST_SHARE = 1e-30
_GROWTH, _SHRINK, _SAFETY = 3.0, 0.2, 0.8
#: least error that step sizes are chosen by
_LEAST_ERROR = 1e-60
#: the slope of an event's function is taken over this share of a step
_DIFFERENCE = 1e-8


@dataclass
class PreciseMotion:
    """V, omega, x, angle at the times ``t``; ``switches`` are pairs of time and regime that follows.

    Numbers are ``arb`` without a radius: their error is not proven but shown, by other nodes and tolerances.
    """

    t: list[float]
    V: list[Any] = field(default_factory=list)
    omega: list[Any] = field(default_factory=list)
    x: list[Any] = field(default_factory=list)
    angle: list[Any] = field(default_factory=list)
    switches: list[tuple[Any, str]] = field(default_factory=list)
    steps: int = 0

    @property
    def onset_time(self) -> Any:
        """First change from full to partial slip, or None."""
        return next((when for when, regime in self.switches if regime == Sticking.regime), None)


@dataclass
class _State:
    """Phase, time, distance and angle (times gamma), and the step to be tried."""

    phase: Sliding | Sticking
    h: Any
    tau: Any
    x: Any
    angle: Any


def roll_precise(
    scene: Scene,
    V0: float,
    omega0: float,
    t: Sequence[float],
    *,
    tolerance: float = 1e-20,
    nodes: int = 22,
    bits: int = 160,
) -> PreciseMotion:
    """Motion from (V0, omega0), not both 0, at ascending times ``t``; every argument is the exact double it is.

    Parameters
    ----------
    scene : one scene.
    tolerance : what a step may leave out, relative to max(|V|, |omega|).
    nodes : of the collocation, whose order is twice that less one.
    bits : working precision.

    Raises
    ------
    ParameterError
        Both speeds 0.
    MissingDependencyError
        If python-flint is not installed.
    ConvergenceError
        If a motion takes more than 5000 steps, or a step becomes too small.

    Notes
    -----
    ``data/reference/check_motions.csv`` states for every motion there how far another choice of nodes and
    tolerance is from the default one: 1e-17 of max(|V|, |omega|) or less
    (``tests/reference/test_reference_motions.py``).
    """
    if V0 == 0.0 and omega0 == 0.0:
        raise ParameterError("V0, omega0", "0, 0", "not both 0")
    flint = imported("flint", "python-flint", "dev")
    arb = flint.arb
    with flint.ctx.workprec(bits):
        alpha, kappa, mu, gamma, j, V, omega = (
            arb(float(value)) for value in (scene.alpha, scene.kappa, scene.mu, scene.gamma, scene.j, V0, omega0)
        )
        phase = begin(Law(alpha, ((alpha - 1) / alpha).mid(), kappa, mu, j), V, omega)
        state = _State(phase, arb(phase.first_step()), arb(0), arb(0), arb(0))
        motion = PreciseMotion([float(time) for time in t])
        for time in motion.t:
            end = (gamma * arb(time)).mid()
            while state.tau < end:
                regime = state.phase.regime
                _advance(state, end, radau(nodes, bits), tolerance)
                if state.phase.regime != regime:
                    motion.switches.append(((state.tau / gamma).mid(), state.phase.regime))
                motion.steps += 1
                if motion.steps == _MOST_STEPS:
                    raise ConvergenceError(f"roll_precise: more than {_MOST_STEPS} steps")
            V, omega = state.phase.speeds(state.phase.unknowns(), arb(0))
            for name, value in (("V", V), ("omega", omega), ("x", state.x / gamma), ("angle", state.angle / gamma)):
                getattr(motion, name).append(value.mid())
    return motion


def _advance(state: _State, end: Any, method: Radau, tolerance: float) -> None:
    """One step, no further than ``end`` or the first event."""
    phase, to_end = state.phase, (end - state.tau).mid()
    asked = min(state.h, type(state.h)(phase.longest()), to_end)
    h, values, growth = _step(phase, asked, method, tolerance)
    event, theta, slope = _first_event(phase, h, values, method)
    if event is not None:
        h, values = _step_to(phase, phase.events()[event][0], h, values, theta, slope, method)
    speeds = [phase.speeds(u, h * c) for u, c in zip(values, method.nodes, strict=True)]
    state.x = (state.x + h * method.integral([V for V, _ in speeds])).mid()
    state.angle = (state.angle + h * method.integral([omega for _, omega in speeds])).mid()
    state.tau = end if event is None and h == to_end else (state.tau + h).mid()
    state.phase = phase.moved(values[-1], h) if event is None else phase.after(event, values[-1], h)
    if event is not None or state.phase.regime != phase.regime:
        state.h = type(h)(state.phase.first_step())
    else:  # a step cut short by the end says nothing against a longer one
        state.h = (max(state.h, growth * h) if h == asked else growth * h).mid()


def _step(phase: Any, h: Any, method: Radau, tolerance: float) -> tuple[Any, Any, float]:
    """(length, values at the nodes, factor for the next step); shorter than ``h`` where that leaves out too much."""
    start, shortest = phase.unknowns(), h * _SHORTEST_SHARE
    while h > shortest:
        taus = [h * c for c in method.nodes]
        slopes = phase.slopes(h)
        guess = [[(u + tau * slope).mid() for u, slope in zip(start, slopes, strict=True)] for tau in taus]
        values, factor = method.step(phase, start, guess, h), _SHRINK
        if values is not None:
            sizes = phase.sizes(values, taus)
            left_out = max(tail / size for tail, size in zip(method.tails(start, values), sizes, strict=True))
            factor = _SAFETY * (tolerance / max(left_out, _LEAST_ERROR)) ** (1 / len(taus))
            if left_out <= tolerance:
                return h, values, min(_GROWTH, factor)
        h = (h * max(_SHRINK, factor)).mid()
    raise ConvergenceError("roll_precise: the step has become too small")


def _first_event(phase: Any, h: Any, values: Any, method: Radau) -> tuple[str | None, Any, Any]:
    """(event, share of the step at which its function is 0, slope there over the step); None where there is none."""
    start, first = phase.unknowns(), (None, 1, 0)
    for event, (function, told) in phase.events().items():
        found = [function(u, h * c) for u, c in zip(values, method.nodes, strict=True)]
        beyond = next((i for i, value in enumerate(found) if value < told), None)
        if beyond is None:
            continue

        def along(theta: Any, function: Callable[[Any, Any], Any] = function) -> Any:
            return function(method.at(start, values, theta), h * theta)

        before = (method.nodes[beyond - 1], found[beyond - 1]) if beyond else (0 * h, function(start, 0 * h))
        theta = zero_between(along, *before, method.nodes[beyond], found[beyond])
        if theta < first[1]:
            near = theta * (1 - _DIFFERENCE)
            first = event, theta, (along(theta) - along(near)) / (theta - near)
    return first


def _step_to(
    phase: Any, function: Callable[[Any, Any], Any], h: Any, values: Any, theta: Any, slope: Any, method: Radau
) -> tuple[Any, Any]:
    """(length, values) of the step at whose end the event is: repeated with its length, and once more corrected."""
    start, length = phase.unknowns(), (h * theta).mid()
    guess = [method.at(start, values, theta * c) for c in method.nodes]
    for correct in (True, False):
        found = method.step(phase, start, guess, length)
        if found is None:
            raise ConvergenceError("roll_precise: the step to an event was not found")
        if correct:
            length, guess = (length - function(found[-1], length) * h / slope).mid(), found
    return length, found
