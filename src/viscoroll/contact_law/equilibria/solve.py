"""States of steady rolling from the rows of the law, over arrays and on threads.

At V and Q the creep follows without a root: by Eq. (15) H(eta) = (1 - |Q|/mu) H(zeta), which is Eq. (6) at the speed
V/root, root^2 = 1 - |Q|/mu, so that delta = delta_star(V) - root delta_star(V/root), beta = root lam(V/root)/lam(V).
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...core.blocks import run_blocks
from ...core.typed import Floats
from ...materials.law_table import LawTable
from ..contact_table import states_of
from . import row
from .loads import Loads
from .resistance import branches
from .states import States

_BLOCK = 1 << 12
#: |Q|/mu up to which delta is first taken from its slope at 0, and up to which a step of Newton's iteration makes it
#: exact: the difference cancels
_SLIGHT, _CANCELS = 1e-8, 0.2
#: what :mod:`row` has of the contact
_ROWS = "Q", "M_half_space", "M_cylinder", "beta", "dQ_dV", "dQ_domega", "dM_half_space_dV", "dM_cylinder_dV"


def contact_at(law: LawTable, kappa: Any, mu: Any, V: NDArray, delta: Any, *names: str) -> Floats:
    """Fields of the contact, a row each."""
    return states_of(law, [1.0, kappa, mu, V, delta], V.shape, False, names)


def rows_at(law: LawTable, kappa: Any, mu: Any, V: NDArray, delta: NDArray) -> Floats:
    """The rows of :mod:`row` at V > 0 and a creep."""
    rows = np.empty((2 + len(_ROWS), V.size))
    rows[row.V], rows[row.DELTA], rows[2:] = V, delta, contact_at(law, kappa, mu, V, delta, *_ROWS)
    rows[row.DQ_DV] -= rows[row.DQ_DOMEGA] * (1.0 + delta)
    return rows


def crossings(law: LawTable, gain: float, total: Floats) -> tuple[NDArray, NDArray, NDArray]:
    """(load, sign of V, kappa |V|) wherever kappa (M - gain V) meets a total."""
    from ...kernels.rows.steady import crossing_loop

    found = branches(law, gain)
    signed = np.concatenate([total, -total])
    which, node = found.met(signed)
    met, curve, u = signed[which], found.curve, np.empty(which.size)

    def work(start: int, stop: int) -> None:
        crossing_loop(law.record, curve, met, node, u, start, stop)

    run_blocks(work, which.size, _BLOCK)
    return which % total.size, np.where(which < total.size, 1.0, -1.0), u


def states_at(law: LawTable, loads: Loads, load: NDArray, sign: NDArray, V: Floats) -> States:
    """Steady states at V > 0, in the frame of ``sign``, friction sufficing or not."""
    gains, kappa, mu = loads.gains, loads.kappa[load], loads.mu[load]
    force, torque = sign * loads.force[load] + gains.force_V * V, sign * loads.torque[load] + gains.torque_V * V
    free = contact_at(law, kappa, mu, V, 0.0, "M_half_space", "M_cylinder", "delta_star", "lam", "dQ_ddelta")
    M = free[0] + free[1]
    share = np.divide(free[0], M, out=np.full(M.size, 0.5), where=M > 0.0)
    if loads.given is None:
        M = force + torque
        Q = share * torque - (1.0 - share) * force
    else:
        Q = torque - (1.0 - share) * M if loads.given == "torque" else share * M - force
    part = np.abs(Q) / mu
    held = part < 1.0
    root, (star, lam, rise) = np.sqrt(np.where(held, 1.0 - part, 1.0)), free[2:]
    less_star, less_lam = contact_at(law, kappa, mu, V / root, 0.0, "delta_star", "lam")
    size = np.where(part > _SLIGHT, star - root * less_star, mu * part / rise)
    rows = rows_at(law, kappa, mu, V, np.copysign(size, Q))
    # the answers do not see this
    rows[row.DELTA] -= np.divide(rows[row.Q] - Q, V * rows[row.DQ_DOMEGA], out=0.0 * V, where=part < _CANCELS)
    rows[row.Q], rows[row.M_HALF_SPACE], rows[row.M_CYLINDER] = Q, share * M, (1.0 - share) * M
    rows[row.BETA] = root * less_lam / lam
    if not held.all():
        rows[[row.BETA, row.DQ_DV, row.DQ_DOMEGA]] *= held
        rows[row.DELTA, ~held] = np.nan
    return States.of(loads, load, sign, rows)
