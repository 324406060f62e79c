"""States of steady rolling from kernels, over arrays and on threads."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ..blocks import run_blocks, solve_blocks
from ..materials.tables import record
from .loads import Loads
from .resistance import Law, branches
from .result import States

_BLOCK = 1 << 12


def crossings(law: Law, gain: float, total: NDArray[np.float64]) -> tuple[NDArray, NDArray, NDArray]:
    """(load, sign of V, zeta) wherever kappa (M - gain V) meets a total."""
    from ..kernels.law.steady_loop import crossing_loop

    found = branches(law.material, gain)
    pairs = []
    for sign in (1.0, -1.0):
        for branch in range(found.first.size):
            of = np.flatnonzero(found.crossed(branch, sign * total))
            pairs.append((of, np.full(of.size, sign), np.full(of.size, branch)))
    load, sign_of, place = (np.concatenate(each) for each in zip(*pairs, strict=True))
    met, first, last = sign_of * total[load], found.first[place], found.last[place]
    curve, zeta = found.curve, np.empty(load.size)

    def work(start: int, stop: int) -> None:
        crossing_loop(record(law.material), curve, met, first, last, zeta, start, stop)

    run_blocks(work, load.size, _BLOCK)
    return load, sign_of, zeta


def lengths(law: Law, kappa_V: NDArray[np.float64]) -> NDArray[np.float64]:
    """zeta of kappa V > 0, both in the material's own time."""
    from ..kernels.law.steady_loop import length_loop

    zeta = np.empty(kappa_V.size)
    solved("length", lambda start, stop: length_loop(record(law.material), kappa_V, zeta, start, stop), zeta.size)
    return zeta


def states_at(law: Law, loads: Loads, load: NDArray, sign: NDArray, zeta: NDArray[np.float64]) -> States:
    """Steady states at zeta, in the frame where V > 0 (``sign`` says which), friction sufficing or not."""
    from ..kernels.law.steady_loop import BOTH, FORCE, ROWS, TORQUE, Candidates, state_loop

    given = {None: BOTH, "torque": TORQUE, "force": FORCE}[loads.given]
    candidates = Candidates(
        zeta, sign * loads.force[load], sign * loads.torque[load], loads.gains.force_V / law.unit,
        loads.gains.torque_V / law.unit, loads.kappa[load], loads.mu[load], given,
    )  # fmt: skip
    rows = np.empty((len(ROWS), load.size))
    solved("creep", lambda start, stop: state_loop(record(law.bodies), candidates, rows, start, stop), load.size)
    return States.of(loads, load, sign, rows, law.unit)


def solved(what: str, loop: Callable[[int, int], int], count: int) -> None:
    """Run a kernel over blocks; ConvergenceError if an iteration hit its cap."""
    solve_blocks(loop, count, _BLOCK, f"steady: an iteration for the {what} hit its cap near state {{}}")
