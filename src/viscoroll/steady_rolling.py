"""Steady rolling under force, torque or slope: :func:`steady`, all equilibria with their stability.

Sum and difference of V' = Q - M_half_space + force = 0 and j omega' = -Q - M_cylinder + torque = 0 (over gamma t) give
M(V) = force + torque, from which V, and Q = torque - M_cylinder, from which the creep.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .blocks import run_blocks
from .drive import Feedback
from .errors import ConvergenceError, ParameterError
from .material_tables import record
from .prony import Prony
from .resistance import LEAST_LOAD, MOST_LOAD, branches
from .scene import Scene
from .steady_loads import Loads, loads_of
from .steady_reason import reasons_of
from .steady_result import States, Steady, packed

_BLOCK = 1 << 12


def steady(
    scene: Scene,
    *,
    force: ArrayLike | Feedback | None = None,
    torque: ArrayLike | Feedback | None = None,
    slope: ArrayLike | None = None,
    V: ArrayLike | None = None,
) -> Steady:
    """Steady rolling: every pair of V and omega that force and torque hold, and whether it is stable.

    Everything is dimensionless.  Arguments, kappa, mu and j broadcast against each other.

    Parameters
    ----------
    scene : alpha or material, kappa, mu and j are used.
    force : over P, along V; torque : over P R, along omega; default 0.  Either may be a :class:`Feedback`.
    slope : theta, rad, in (-pi/2, pi/2), > 0 pushes along +V.  The load is then P cos(theta): tan(theta) adds to
        ``force``, kappa becomes kappa/sqrt(cos(theta)), and forces and torques are over that load.
    V : the speed, in place of one of force and torque, which is found (a slope alone counts as the force given).

    Returns
    -------
    Steady
        Of one load exactly its equilibria by rising |V|, none to many.  Of arrays of loads a last axis in
        addition, padded with NaN, and their ``count``.  ``reason`` says why there is none.

    Raises
    ------
    ParameterError
        NaN or infinite input, a slope out of range, V together with both or neither of force and torque or
        with a feedback, an array of alphas, shapes that do not broadcast, kappa |force + torque| in (0, 1e-120) or above 1e80.
    ConvergenceError
        If a solve hits its iteration cap.

    Notes
    -----
    For |force + torque| below the largest M(V) there are two equilibria a hump, on its rising and its falling
    branch; they need |Q| < mu.  force + torque = 0: V = 0 alone, where ``delta`` and ``eigenvalues`` are those
    of V -> 0 (that of slip is -inf).  Where equilibria are a continuum (elastic bodies without a drive; Q = mu exactly) none is
    listed and ``reason`` says so.

    Stability is that of (V, omega) under force and torque as named, also where V was given.  Without feedback
    det = (dQ/domega) M'(V)/j, so the falling branch of a hump is a saddle.

    Speeds are good to 1e-12/sqrt(1 - |force + torque|/M_top), M_top the extremum of M nearby, and what follows from Q to that
    over ``grip`` (``tests/test_steady.py``).
    """
    loads = loads_of(scene, force, torque, slope, V)
    material, unit = scene.in_own_time()
    free = loads.given is None and not (loads.gains.V or loads.gains.omega)
    if loads.given is not None:
        rolling = _at_speed(material, unit, loads)
    elif loads.gains.omega:
        from .steady_scan import scanned

        rolling = scanned(material, unit, loads)
    else:
        rolling = _under_load(material, unit, loads)
    elastic, T_mean = _slow_limit(material)
    states = States.joined(rolling, States.at_rest(loads, _resting(loads, elastic and free), T_mean * unit))
    held = states.held()
    number = np.bincount(held.load, minlength=loads.mu.size)
    top = _top(material, unit) if free and not elastic else (math.nan, math.nan)
    return packed(loads, held, number, reasons_of(loads, number, states, top, elastic))


def _slow_limit(material: Any) -> tuple[bool, float]:
    """Whether nothing relaxes, and M/V of slow rolling in the material's own time."""
    if isinstance(material, Prony):
        return False, material.T_mean
    return material == 1.0, (material - 1.0) / material


def _resting(loads: Loads, neutral: bool) -> NDArray[np.int64]:
    """Loads that leave the cylinder at rest, if friction does; where ``neutral`` it need not be at rest under them."""
    if loads.V is not None:
        return np.flatnonzero(loads.V == 0.0)
    total = loads.force + loads.torque
    return np.flatnonzero((total == 0.0) & ((np.abs(loads.torque) > loads.mu) | (not neutral)))


def _top(material: Any, unit: float) -> tuple[float, float]:
    """The largest kappa M, and kappa V there."""
    found = branches(material, 0.0)
    n = int(np.argmax(found.rise))
    return float(found.rise[n]), float(found.speed[n]) / unit


def _under_load(material: Any, unit: float, loads: Loads) -> States:
    """All states of rolling under loads without a gain on omega."""
    gain = loads.gains.V / unit
    total = loads.kappa * (loads.force + loads.torque)
    size = np.abs(total)
    wrong = (size > MOST_LOAD) | ((size > 0.0) & (size < LEAST_LOAD))
    if wrong.any():
        allowed = f"0, or of a size in [{LEAST_LOAD:g}, {MOST_LOAD:g}]"
        raise ParameterError("kappa (force + torque)", f"{total[wrong][0]:g}", allowed)
    if not gain and material == 1.0:
        return States.none()
    found = branches(material, gain)
    signs = (1.0, -1.0)
    numbers, places, turned = [], [], []
    for sign in signs:
        for branch in range(found.first.size):
            of = np.flatnonzero(found.crossed(branch, sign * total))
            numbers.append(of)
            places.append(np.full(of.size, branch))
            turned.append(np.full(of.size, sign))
    load, place, sign_of = np.concatenate(numbers), np.concatenate(places), np.concatenate(turned)
    zeta = _crossings(material, found, sign_of * total[load], place)
    return states_at(material, unit, loads, load, sign_of, zeta)


def _crossings(material: Any, found: Any, load: NDArray, branch: NDArray) -> NDArray[np.float64]:
    """zeta where each load meets its branch."""
    from .kernels.law.steady_loop import crossing_loop

    zeta, first, last = np.empty(load.size), found.first[branch], found.last[branch]
    curve = found.curve
    run_blocks(
        lambda start, stop: crossing_loop(record(material), curve, load, first, last, zeta, start, stop),
        load.size, _BLOCK,
    )  # fmt: skip
    return zeta


def _at_speed(material: Any, unit: float, loads: Loads) -> States:
    """The states at given speeds but 0, where one of force and torque is found."""
    from .kernels.law.steady_loop import length_loop

    assert loads.V is not None
    load = np.flatnonzero(loads.V)
    speed = loads.V[load]
    kappa_V, zeta, failed = loads.kappa[load] * np.abs(speed) * unit, np.empty(load.size), []

    def work(start: int, stop: int) -> None:
        failed.append(length_loop(record(material), kappa_V, zeta, start, stop))

    run_blocks(work, load.size, _BLOCK)
    if any(failed):
        raise ConvergenceError("steady: an iteration for the contact length hit its cap")
    return states_at(material, unit, loads, load, np.sign(speed), zeta)


def states_at(
    material: Any, unit: float, loads: Loads, load: NDArray, sign: NDArray, zeta: NDArray[np.float64]
) -> States:
    """Steady states at zeta, in the frame where V > 0 (``sign`` says which), friction sufficing or not."""
    from .kernels.law.steady_loop import BOTH, FORCE, ROWS, TORQUE, Candidates, state_loop

    given = {None: BOTH, "torque": TORQUE, "force": FORCE}[loads.given]
    gains = loads.gains
    candidates = Candidates(
        zeta, sign * loads.force[load], sign * loads.torque[load], gains.force_V / unit, gains.torque_V / unit,
        loads.kappa[load], loads.mu[load], given,
    )  # fmt: skip
    rows, failed = np.empty((len(ROWS), load.size)), []

    def work(start: int, stop: int) -> None:
        failed.append(state_loop(record(material), candidates, rows, start, stop))

    run_blocks(work, load.size, _BLOCK)
    if any(failed):
        raise ConvergenceError("steady: an iteration for the creep hit its cap")
    return States.of(loads, load, sign, rows, unit)
