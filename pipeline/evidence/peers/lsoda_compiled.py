"""LSODA, compiled, on this package's explicit right-hand side in (ln zeta, zeta - eta): partial slip only.

The best that a user could make of the reduction without an integrator of his own.  By numbalsoda
(C++), called from compiled code; where that is not installed, by scipy's LSODA with the compiled
right-hand side behind a Python call, which costs some 10 times more (:data:`ENGINE` says which).

Full slip is given to it: :func:`prepare` takes onset time and speed, and the outputs before, from
the package, and none of that is timed.  A motion whose full slip returns is beyond it.
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

from ..bench.jit import compiled
from .reduction import Scene, creep_speeds, partial_rates, slow_D
from .standard import standard

ENGINE = "numbalsoda" if find_spec("numbalsoda") else "scipy"
#: share of rtol that the absolute tolerance is; 1e-3 and less cost half as much again for the same error
ATOL_SHARE = 1.0
_MOST_STEPS = 100_000


class Stuck(NamedTuple):
    """Motions at the begin of partial slip: ``first`` output index, direction, time gamma t, unknowns, parameters."""

    first: NDArray
    direction: NDArray
    tau: NDArray
    u: NDArray
    par: NDArray
    gamma: NDArray
    V: NDArray
    omega: NDArray


def prepare(scene: vr.Scene, V0: NDArray, omega0: NDArray, t: NDArray) -> Stuck:
    """Full slip by the package: what LSODA continues, and the outputs that lie before."""
    n = V0.size
    names = ("alpha", "kappa", "mu", "gamma", "j")
    alpha, kappa, mu, gamma, j = (np.broadcast_to(np.asarray(getattr(scene, name)), n) for name in names)
    par = np.column_stack([alpha, kappa, mu, j])
    V, omega = np.full((2, n, t.size), np.nan)
    first, tau, direction, u = np.zeros(n, dtype=np.int64), np.zeros(n), np.ones(n), np.zeros((n, 2))
    for i in range(n):
        one = vr.Scene(alpha[i], kappa[i], mu[i], gamma[i], j[i])
        motion = vr.roll(one, V0[i], omega0[i], t, rtol=1e-11)
        first[i] = t.size
        sticks = bool(motion.regime[0] == 1) if t[0] == 0.0 else not vr.contact(one, V0[i], omega=omega0[i]).full_slip
        at = 0.0 if sticks else motion.onset_time
        if sticks or np.isfinite(at):
            speed, turn = (V0[i], omega0[i]) if sticks else _state_at(one, V0[i], omega0[i], at)
            first[i] = np.searchsorted(t, at)
            state = vr.contact(one, speed, omega=turn)
            eta = state.beta * state.zeta if sticks else 0.0
            direction[i], tau[i] = np.sign(speed), at * gamma[i]
            u[i, 0] = np.log(state.zeta)
            u[i, 1] = (
                np.sign(state.delta) * (state.zeta - eta) - slow_D(u[i, 0], Scene(standard(par[i, 0]), *par[i, 1:]))[0]
            )
        V[i, : first[i]], omega[i, : first[i]] = motion.V[: first[i]], motion.omega[: first[i]]
    return Stuck(first, direction, tau, u, par, gamma.copy(), V, omega)


def _state_at(scene: vr.Scene, V0: float, omega0: float, t: float) -> tuple[float, float]:
    """Speeds at ``t``; rolled a little further, so that the motion does not end on a switch."""
    motion = vr.roll(scene, V0, omega0, np.array([t, 1.01 * t]), rtol=1e-12)
    return motion.V[0], motion.omega[0]


def run(stuck: Stuck, t: NDArray, rtol: float) -> tuple[NDArray, NDArray]:
    """Continue all motions to the end of ``t``: V, omega of shape (n, times); NaN where LSODA gave up."""
    V, omega = stuck.V.copy(), stuck.omega.copy()
    unknowns = np.full((*V.shape, 2), np.nan)
    _engine()(stuck.first, stuck.tau, stuck.u, stuck.par, stuck.gamma, t, rtol, ATOL_SHARE * rtol, unknowns)
    _put(unknowns, stuck.first, stuck.direction, stuck.par, V, omega)
    return V, omega


@compiled
def _put(unknowns, first, direction, par, V, omega):
    """Speeds from the unknowns, from the first output in partial slip on."""
    for i in range(first.size):
        own = Scene(standard(par[i, 0]), par[i, 1], par[i, 2], par[i, 3])
        for m in range(first[i], V.shape[1]):
            if not np.isnan(unknowns[i, m, 0]):
                y, offset = unknowns[i, m]
                speed, delta = creep_speeds(y, slow_D(y, own)[0] + offset, own)
                V[i, m], omega[i, m] = direction[i] * speed, direction[i] * speed * (1.0 + delta)


@cache
def _engine():
    return _by_numbalsoda() if ENGINE == "numbalsoda" else _by_scipy


def numbalsoda_driver() -> ModuleType:
    """The module of ``lsoda`` alone: beside it lies another method, which numba compiles on import, for 5 s."""
    spec = spec_from_file_location("driver", Path(find_spec("numbalsoda").origin).with_name("driver.py"))
    module = module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def _by_numbalsoda():
    driver = numbalsoda_driver()
    lsoda = driver.lsoda

    @numba.cfunc(driver.lsoda_sig, cache=True)
    def rates(_, u, du, p):
        y = numba.carray(u, 2)
        par = numba.carray(p, 4)
        found = partial_rates(y[0], y[1], Scene(standard(par[0]), par[1], par[2], par[3]))
        du[0], du[1] = found[0], found[1]

    @numba.njit(nogil=True)
    def loop(address, first, tau, u, par, gamma, t, rtol, atol, unknowns):
        for i in range(first.size):
            if first[i] == t.size:
                continue
            times = np.empty(t.size - first[i] + 1)
            times[0] = tau[i]
            for m in range(1, times.size):  # numba takes seconds to compile the message of slices that do not fit
                times[m] = t[first[i] + m - 1] * gamma[i]
            solution, good = lsoda(address, u[i].copy(), times, par[i].copy(), rtol, atol, _MOST_STEPS)
            if good:
                for m in range(1, times.size):
                    unknowns[i, first[i] + m - 1, 0], unknowns[i, first[i] + m - 1, 1] = solution[m]

    return lambda *given: loop(rates.address, *given)


def _by_scipy(first, tau, u, par, gamma, t, rtol, atol, unknowns):
    from scipy.integrate import solve_ivp

    for i in np.flatnonzero(first < t.size):
        own = Scene(standard(par[i, 0]), *par[i, 1:])
        times = np.concatenate([[tau[i]], t[first[i] :] * gamma[i]])
        solution = solve_ivp(
            lambda _, y, own=own: partial_rates(y[0], y[1], own)[:2],
            (times[0], times[-1]), u[i], "LSODA", t_eval=times, rtol=rtol, atol=atol,
        )  # fmt: skip
        if solution.success:
            unknowns[i, first[i] :] = solution.y.T[1:]
