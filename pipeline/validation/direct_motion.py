"""Eq. (22) by scipy's integrators on the printed contact law: what :func:`viscoroll.roll` is held
against.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from viscoroll import contact
from viscoroll.core.errors import ConvergenceError
from viscoroll.rollers import Scene

#: The tightest that run smoothly; delta's absolute one is the noise of Q as printed, 1e-16 mu/(4
#: kappa) and more.
_SLIDING_RTOL = 1e-12
_SLIDING_ATOL = 1e-13
_STICKING_RTOL = 1e-13
_STICKING_ATOL = 1e-16
_MOST_PHASES = 100


class DirectMotion(NamedTuple):
    """V and omega at the times asked for, and the first change from full to partial slip (NaN:
    none).
    """

    V: NDArray[np.float64]
    omega: NDArray[np.float64]
    onset_time: float


def roll_direct(scene: Scene, V0: float, omega0: float, t: NDArray[np.float64]) -> DirectMotion:
    """Motion from (V0, omega0) != (0, 0) at ascending times ``t``, on root solves of the printed
    equations.

    Full slip: unknowns (V, omega), DOP853.  Partial slip: (ln |V|, delta), LSODA, because
    with (V, omega) the slip omega - V drowns in rounding as V falls.  The regime is carried
    as state and changes only at events that look one way.

    Raises
    ------
    ConvergenceError
        If scipy's integrator gives up, or a motion changes its regime without end.

    Notes
    -----
    On IC1-IC3 down to |V| = 1e-6 it differs from :func:`viscoroll.roll` at its tightest
    tolerance by less than 1e-9 of the speed (``tests/validation/test_validation.py``).
    """
    V = np.full(t.size, np.nan)
    omega = np.full(t.size, np.nan)
    now = 0.0
    state = (float(V0), float(omega0))
    onset_time = np.nan
    sticking = abs(omega0 - V0) < _limit(scene, float(V0))
    for _ in range(_MOST_PHASES):
        phase = _stick if sticking else _slide
        solution, speeds = phase(now, t[-1], state, scene)
        reached = solution.t[-1]
        inside = (t >= now) & (t <= reached)
        if inside.any():
            V[inside], omega[inside] = speeds(solution.sol(t[inside]))
        if solution.status != 1:
            return DirectMotion(V, omega, onset_time)
        V_reached, omega_reached = speeds(solution.y[:, -1])
        now = reached
        state = (float(V_reached), float(omega_reached))
        sticking = not sticking
        if sticking and np.isnan(onset_time):
            onset_time = now
    raise ConvergenceError(f"direct motion: more than {_MOST_PHASES} changes of regime")


def _law(scene: Scene, V: float, delta: float) -> tuple[float, float, float]:
    """(Q, M, delta_star), as printed."""
    found = contact(scene, V, delta=delta, fields=("Q", "M", "delta_star"), method="direct")
    return float(found.Q), float(found.M), float(found.delta_star)


def _limit(scene: Scene, V: float) -> float:
    """The slip |omega - V| at which stick ends."""
    return _law(scene, V, 0.0)[2] * abs(V)


def _slide(now, end, state, scene):
    """Full slip from ``state`` (V, omega) to the onset of stick or the end."""
    sigma = float(np.sign(state[1] - state[0]))

    def rates(_, y):
        M = _law(scene, y[0], 0.0)[1]
        return scene.gamma * (sigma * scene.mu - 0.5 * M), -scene.gamma / scene.j * (
            sigma * scene.mu + 0.5 * M
        )

    def onset(_, y):
        return sigma * (y[1] - y[0]) - _limit(scene, y[0])

    return _solve(
        rates, now, end, state, onset, -1.0, "DOP853", _SLIDING_RTOL, _SLIDING_ATOL
    ), lambda y: (y[0], y[1])


def _stick(now, end, state, scene):
    """Partial slip from ``state`` (V, omega) to the return of full slip or the end, seen with V >
    0.
    """
    direction = np.sign(state[0])
    speed = abs(state[0])
    start = (np.log(speed), (state[1] - state[0]) / state[0])

    def rates(_, y):
        V = np.exp(y[0])
        delta = y[1]
        Q, M, _ = _law(scene, V, delta)
        rate = scene.gamma * (Q - 0.5 * M) / V
        return rate, -scene.gamma * (Q + 0.5 * M) / (scene.j * V) - (1.0 + delta) * rate

    def slip(_, y):
        return abs(y[1]) - _law(scene, np.exp(y[0]), 0.0)[2]

    def speeds(y):
        V = direction * np.exp(y[0])
        return V, V * (1.0 + y[1])

    return _solve(
        rates, now, end, start, slip, 1.0, "LSODA", _STICKING_RTOL, _STICKING_ATOL
    ), speeds


def _solve(rates, now, end, start, event, direction, method, rtol, atol):
    from scipy.integrate import solve_ivp

    event.terminal = True
    event.direction = direction
    solution = solve_ivp(
        rates, (now, end), start, method, events=event, dense_output=True, rtol=rtol, atol=atol
    )
    if solution.status < 0:
        raise ConvergenceError(
            f"direct motion: {method} gave up at t = {solution.t[-1]:.6g}: {solution.message}"
        )
    return solution
