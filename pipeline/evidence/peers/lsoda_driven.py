"""LSODA, compiled, on Eq. (22) with a force and a torque, in (V, omega) and with the law's own saturation: no events.

What a user would do with the contact law and a good general integrator.  By numbalsoda (C++), called from compiled
code; there is no such peer where that is not installed.
"""

from __future__ import annotations

from functools import cache
from importlib.util import find_spec

import numba
import numpy as np
from numpy.typing import NDArray

from viscoroll.kernels.compile.address import doubles, integers
from viscoroll.kernels.rows.contact import traction_of
from viscoroll.kernels.rows.law import place, speed, way_of
from viscoroll.kernels.rows.record import Law
from viscoroll.kernels.rows.states import State
from viscoroll.materials.law_table import law_table

from ..bench.jit import compiled
from .lsoda_compiled import numbalsoda_driver

INSTALLED = bool(find_spec("numbalsoda"))
#: share of rtol that the absolute tolerance is
ATOL_SHARE = 1e-3
#: between two outputs
_MOST_STEPS = 20_000


@compiled
def _rates(V, omega, t, par, du):
    """Rates over tau at f = par[4] + par[5] t and q = par[6] + par[7] t; counts the call in par[8].

    par[0]: alpha, which the law is of whose rows and marks, addresses and sizes, are behind.
    """
    rows, marks = doubles(int(par[9]), int(par[10])), integers(int(par[11]), int(par[12]))
    law = Law(rows, marks, rows[:0], 0, 0, 0)
    state = State(par[1], par[2], V, omega, True)
    u = state.kappa * abs(V)
    at = place(u, law)
    found = speed(at, u, law)
    Q, M = traction_of(u, found.L, state, law), way_of(at, u, found.scale, state) * found.m
    f, q = par[4] + par[5] * t, par[6] + par[7] * t
    du[0] = Q - 0.5 * M + f
    du[1] = (q - Q - 0.5 * M) / par[3]
    par[8] += 1.0


@cache
def _compiled():
    driver = numbalsoda_driver()
    lsoda = driver.lsoda

    @numba.cfunc(driver.lsoda_sig, cache=True)
    def rates(t, u, du, p):
        y = numba.carray(u, 2)
        _rates(y[0], y[1], t, numba.carray(p, 13), numba.carray(du, 2))

    @numba.njit(nogil=True)
    def one(address, start, par, t, rtol, atol):
        return lsoda(address, start, t, par, rtol, atol, _MOST_STEPS)

    return rates.address, one


def roll(par: NDArray, start: NDArray, t: NDArray, rtol: float) -> tuple[NDArray, int]:
    """((V, omega) at ``t`` or NaN, evaluations) of one motion; ``par``: alpha, kappa, mu, j, f, f', q, q'."""
    address, one = _compiled()
    law = law_table(float(par[0])).record
    pointers = [each for part in (law.rows, law.marks) for each in (part.ctypes.data, part.size)]
    given = np.concatenate([par, [0.0], pointers])
    found, good = one(address, start.copy(), given, t, rtol, ATOL_SHARE * rtol)
    return (found if good else np.full((t.size, 2), np.nan)), int(given[8])
