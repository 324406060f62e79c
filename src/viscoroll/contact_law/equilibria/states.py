"""Steady states that were found, one after another (:class:`States`), and how: from the rows of the law, on threads.

At V and Q the creep follows without a root: by Eq. (15) H(eta) = (1 - |Q|/mu) H(zeta), which is Eq. (6) at the speed
V/root, root^2 = 1 - |Q|/mu, so that delta = delta_star(V) - root delta_star(V/root), beta = root lam(V/root)/lam(V).
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core.blocks import run_blocks
from ...core.typed import Floats, Integers
from ...materials.law_table import LawTable
from ..contact_table import states_of
from . import row
from .loads import Gains, Loads
from .resistance import branches

_BLOCK = 1 << 12
#: |Q|/mu up to which delta is first taken from its slope at 0, and up to which a step of Newton's iteration makes it
#: exact: the difference cancels
_SLIGHT, _CANCELS = 1e-8, 0.2
#: what :mod:`row` has of the contact
_ROWS = "Q", "M_half_space", "M_cylinder", "beta", "dQ_dV", "dQ_domega", "dM_half_space_dV", "dM_cylinder_dV"


class States(NamedTuple):
    """Steady states one after another: which load each belongs to, and the rows of :mod:`row`; speeds in R/T_ref.

    Where friction does not suffice, delta and omega are NaN.
    """

    load: Integers
    rows: Floats

    @classmethod
    def of(cls, loads: Loads, load: NDArray, sign: NDArray, answers: NDArray) -> States:
        """From rows with answers."""
        rows = answers.copy()
        rows[[row.V, row.Q, row.M_HALF_SPACE, row.M_CYLINDER]] *= sign
        rows[row.OMEGA] = rows[row.V] * (1.0 + rows[row.DELTA])
        rows[row.FAST :] = _eigenvalues(answers[row.DQ_DV :], loads.gains, loads.j[load])
        return cls(load, rows)

    @classmethod
    def at_rest(cls, loads: Loads, load: NDArray, T_mean: float) -> States:
        """V = omega = 0, the limit of slow rolling: Carter's contact, and V' = -rate V with omega in step with it."""
        Q, kappa, mu, j = (values[load] for values in (loads.torque, loads.kappa, loads.mu, loads.j))
        if loads.given == "force":
            Q = -loads.force[load]
        part, rows = np.abs(Q) / mu, np.zeros((row.IMAGINARY + 1, load.size))
        rows[row.BETA] = beta = np.sqrt(np.where(part < 1.0, 1.0 - part, np.nan))
        delta = 0.5 * mu / kappa * part / (1.0 + beta)
        rows[row.OMEGA], rows[row.DELTA], rows[row.Q] = 0.0 * beta, np.sign(Q) * delta, Q
        rows[row.FAST] = rows[row.SLOW] = -np.inf
        gains = loads.gains
        for creep in (delta, -delta):  # to either side omega = V (1 + delta) or V (1 - delta)
            rate = T_mean - gains.V - (gains.force_omega + gains.torque_omega) * (1.0 + creep)
            rows[row.SLOW] = np.maximum(rows[row.SLOW], -rate / (1.0 + j * (1.0 + creep)))
        return cls(load, rows)

    @classmethod
    def none(cls) -> States:
        """No state."""
        return cls(np.empty(0, np.int64), np.empty((row.IMAGINARY + 1, 0)))

    @classmethod
    def joined(cls, *parts: States) -> States:
        """All of them, one after another."""
        return cls(np.concatenate([each.load for each in parts]), np.concatenate([each.rows for each in parts], axis=1))

    def held(self) -> States:
        """Those that friction holds, by load and rising |V|."""
        held = np.isfinite(self.rows[row.OMEGA]).nonzero()[0]
        held = held[np.lexsort((np.abs(self.rows[row.V, held]), self.load[held]))]
        return States(self.load[held], self.rows[:, held])


def _eigenvalues(slopes: NDArray, gains: Gains, j: NDArray) -> Floats:
    """Of (V, omega) over gamma t: real parts of the faster and of the other, and the imaginary part of the other.

    slopes : a, b of Q over V and omega, then those of both moments over V.

    The determinant is put together so that a and b, which are large, do not cancel: b (M'(V) - gain)/j without a gain
    on omega.
    """
    a, b, d_half_space, d_cylinder = slopes
    with np.errstate(invalid="ignore"):
        det = b * (d_half_space + d_cylinder - gains.V)
        det += gains.torque_omega * (a - d_half_space + gains.force_V)
        det = (det + gains.force_omega * (a + d_cylinder - gains.torque_V)) / j
        half = 0.5 * (a - d_half_space + gains.force_V + (gains.torque_omega - b) / j)
        spread = half * half - det
        root = np.sqrt(np.abs(spread))
        larger = half + np.copysign(root, half)
        other = np.divide(det, larger, out=0.0 * det, where=larger != 0.0)
        real = spread >= 0.0
        return np.array([
            np.where(real, np.minimum(larger, other), half), np.where(real, np.maximum(larger, other), half),
            np.where(real, 0.0, root),
        ])  # fmt: skip


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
