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

import viscoroll as vr
from viscoroll.kernels.compile.address import doubles, integers
from viscoroll.kernels.rows.contact import traction_of
from viscoroll.kernels.rows.law import place, speed, way_of
from viscoroll.kernels.rows.record import Law
from viscoroll.kernels.rows.states import State
from viscoroll.materials.law_table import law_table

from .lsoda_compiled import numbalsoda_driver

INSTALLED = bool(find_spec("numbalsoda"))
#: share of rtol that the absolute tolerance is
ATOL_SHARE = 1e-3
#: between two outputs
_MOST_STEPS = 20_000


@cache
def _compiled():
    driver = numbalsoda_driver()
    lsoda = driver.lsoda

    @numba.cfunc(driver.lsoda_sig)
    def rates(t, u, du, p):
        """Over tau at f = par[3] + par[5] t and q = par[4] + par[6] t; addresses and sizes of rows and marks behind."""
        y, found, par = numba.carray(u, 2), numba.carray(du, 2), numba.carray(p, 11)
        V, omega = y
        rows, marks = doubles(int(par[7]), int(par[8])), integers(int(par[9]), int(par[10]))
        law = Law(rows, marks, rows[:0], 0, 0, 0)
        state = State(par[0], par[1], V, omega, True)
        u = state.kappa * abs(V)
        at = place(u, law)
        of = speed(at, u, law)
        Q, M = traction_of(u, of.L, state, law), way_of(at, u, of.scale, state) * of.m
        found[0] = Q - 0.5 * M + par[3] + par[5] * t
        found[1] = (par[4] + par[6] * t - Q - 0.5 * M) / par[2]

    @numba.njit(nogil=True)
    def one(address, start, par, t, rtol, atol):
        return lsoda(address, start, t, par, rtol, atol, _MOST_STEPS)

    return rates.address, one


def roll(scene: vr.Scene, drive: NDArray, start: NDArray, t: NDArray, rtol: float) -> NDArray:
    """V and omega at ``t``, or NaN, of one motion; ``drive``: first values of force and torque, and their slopes."""
    address, one = _compiled()
    law = law_table(float(scene.alpha)).record
    pointers = [each for part in (law.rows, law.marks) for each in (part.ctypes.data, part.size)]
    given = np.concatenate([[scene.kappa, scene.mu, scene.j], drive.ravel(), pointers])
    found, good = one(address, start.copy(), given, t, rtol, ATOL_SHARE * rtol)
    return found if good else np.full((t.size, 2), np.nan)
