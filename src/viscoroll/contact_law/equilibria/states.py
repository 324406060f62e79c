"""Steady states that were found, one after another: :class:`States`."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core.typed import Floats, Integers
from . import row
from .loads import Gains, Loads


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
