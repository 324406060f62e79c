"""LSODA, compiled, on this package's explicit right-hand side in (ln zeta, zeta - eta): partial slip only.

The best that a user could make of the reduction without an integrator of his own, by numbalsoda (C++), called from
compiled code.  Full slip is given to it: :func:`prepare` takes onset time and speed, and the outputs before, from the
package, and none of that is timed.  A motion whose full slip returns is beyond it.
"""

from __future__ import annotations

from functools import cache
from importlib.util import find_spec, module_from_spec, spec_from_file_location
from pathlib import Path
from types import ModuleType
from typing import NamedTuple

import numba
import numpy as np
from numpy.typing import NDArray

import viscoroll as vr

from .reduction import Scene, creep_speeds, partial_rates, slow_D
from .standard import standard

#: share of rtol that the absolute tolerance is; 1e-3 and less cost half as much again for the same error
ATOL_SHARE = 1.0
_MOST_STEPS = 100_000


def missing() -> str | None:
    """Why it cannot run here, or None."""
    return None if find_spec("numbalsoda") else "numbalsoda is not installed (make peer-tools)"


class Stuck(NamedTuple):
    """Motions at the begin of partial slip: ``first`` output index, direction, time gamma t, unknowns, parameters."""

    first: NDArray
    direction: NDArray
    tau: NDArray
    u: NDArray
    par: NDArray
    V: NDArray
    omega: NDArray


def prepare(parameters: NDArray, V0: NDArray, omega0: NDArray, t: NDArray) -> Stuck:
    """Full slip by the package: what LSODA continues, and the outputs that lie before."""
    n = V0.size
    V, omega = np.full((2, n, t.size), np.nan)
    first, tau, direction, u = np.full(n, t.size), np.zeros(n), np.ones(n), np.zeros((n, 2))
    for i in range(n):
        one = vr.Scene(*parameters[i].tolist())
        motion = vr.roll(one, V0[i], omega0[i], t, rtol=1e-11)
        sticks = not vr.contact(one, V0[i], omega=omega0[i]).full_slip
        at = 0.0 if sticks else motion.onset_time
        if np.isfinite(at):
            speed, turn = V0[i], omega0[i]
            if not sticks:  # rolled a little further, so that the motion does not end on a switch
                begun = vr.roll(one, speed, turn, [at, 1.01 * at], rtol=1e-12)
                speed, turn = begun.V[0], begun.omega[0]
            first[i], direction[i], tau[i] = np.searchsorted(t, at), np.sign(speed), at * one.gamma
            state = vr.contact(one, speed, omega=turn)
            eta, y = state.beta * state.zeta if sticks else 0.0, np.log(state.zeta)
            own = Scene(standard(one.alpha), one.kappa, one.mu, one.j)
            u[i] = y, np.sign(state.delta) * (state.zeta - eta) - slow_D(y, own)[0]
        V[i, : first[i]], omega[i, : first[i]] = motion.V[: first[i]], motion.omega[: first[i]]
    return Stuck(first, direction, tau, u, parameters, V, omega)


def run(stuck: Stuck, t: NDArray, rtol: float) -> tuple[NDArray, NDArray]:
    """Continue all motions to the end of ``t``: V, omega of shape (n, times); NaN where LSODA gave up."""
    V, omega = stuck.V.copy(), stuck.omega.copy()
    _loop()(*stuck[:5], t, rtol, ATOL_SHARE * rtol, V, omega)
    return V, omega


def numbalsoda_driver() -> ModuleType:
    """The module of ``lsoda`` alone: beside it lies another method, which numba compiles on import, for 5 s."""
    spec = spec_from_file_location("driver", Path(find_spec("numbalsoda").origin).with_name("driver.py"))
    module = module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@cache
def _loop():
    driver = numbalsoda_driver()
    lsoda = driver.lsoda

    @numba.njit
    def scene_of(par):
        return Scene(standard(par[0]), par[1], par[2], par[4])

    @numba.cfunc(driver.lsoda_sig)
    def rates(_, u, du, p):
        y, par, found = numba.carray(u, 2), numba.carray(p, 5), numba.carray(du, 2)
        found[0], found[1] = partial_rates(y[0], y[1], scene_of(par))

    @numba.njit(nogil=True)
    def loop(address, first, direction, tau, u, par, t, rtol, atol, V, omega):
        for i in range(first.size):
            if first[i] == t.size:
                continue
            times = np.empty(t.size - first[i] + 1)
            times[0] = tau[i]
            for m in range(1, times.size):  # numba takes seconds to compile the message of slices that do not fit
                times[m] = t[first[i] + m - 1] * par[i, 3]
            solution, good = lsoda(address, u[i].copy(), times, par[i].copy(), rtol, atol, _MOST_STEPS)
            if good:
                own = scene_of(par[i])
                for m in range(1, times.size):
                    y, offset = solution[m]
                    speed, delta = creep_speeds(y, slow_D(y, own)[0] + offset, own)
                    V[i, first[i] + m - 1] = direction[i] * speed
                    omega[i, first[i] + m - 1] = direction[i] * speed * (1.0 + delta)

    return lambda *given: loop(rates.address, *given)
