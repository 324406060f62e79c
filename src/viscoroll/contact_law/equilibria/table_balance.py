"""Steady states on a table of the coupled solution: the balance of axis and cylinder, at speeds and at rest.

At V > 0 the axis is in balance where Q - M_half_space = -f, the cylinder where Q + M_cylinder = q, with force f and
torque q.  The left sides rise with the creep, so that one of the two gives the creep at each speed, and the other one
the speeds.  Where friction does not suffice the rest of a balance is kept, and the state does not exist.

All is dimensionless; a law is a :class:`LawTable` with ``coupled`` rows.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ...core.array_types import Booleans, Floats, Integers
from ...materials.law.coupled_rows import FIELDS
from ...materials.law.table import LawTable
from .loads import Loads
from .resistance import find_zeros

#: octaves of speed beyond the nodes of a table in which steady speeds are sought: there the law is its limit
_FAR_OCTAVES = 40
#: speeds of an octave at which the balance is evaluated
_DENSITY = 6
#: rounding of the balance
_NOISE = 1e-14
#: speed over the first node at which slopes at rest are taken: there the law is linear in u
_SLOW = 1e-3


def balance(law: LawTable, kappa: Any, mu: Any, V: Floats, load: Floats, spin: bool = False) -> tuple[Floats, Floats]:
    """Return the creepages at which friction is in balance with a load, and what is left of the load; (n,) each.

    kappa, mu : of the scene, numbers or (n,).  V : speeds >= 0, (n,).
    load : Q - M_half_space, or with ``spin`` Q + M_cylinder, (n,).
    """
    from ...kernels.splines.law import balance_loop

    kappa, mu = (np.ascontiguousarray(np.broadcast_to(each, V.shape), dtype=np.float64) for each in (kappa, mu))
    out = np.empty((V.size, 2))
    balance_loop(law.record.table, kappa, mu, kappa * V, np.ascontiguousarray(load), spin, out)
    return out[:, 0] / (2.0 * kappa), out[:, 1].copy()


def fields_at(law: LawTable, kappa: Any, V: Floats, delta: Floats) -> dict[str, Floats]:
    """Return the fields of a table at V >= 0 and creepages, (n,) each, by name (:data:`FIELDS`)."""
    from ...kernels.splines.law import look_up

    return dict(zip(FIELDS, look_up(law.record.table, kappa * V, 2.0 * kappa * delta).T, strict=True))


def moments_of_losses(law: LawTable, kappa: Any, V: Floats, delta: Floats) -> Floats:
    """Return the moments by which the losses in base and cylinder are V and omega times these, (2, n)."""
    found = fields_at(law, kappa, V, delta)
    half_space = found["M_half_space"] + 0.5 * found["work_half_space"]
    cylinder = found["M_cylinder"] + 0.5 * found["work_cylinder"] / (1.0 + delta)
    return np.stack([half_space, cylinder]) / kappa


def _torque_left(law: LawTable, kappa: Any, mu: Any, V: Floats, force: Floats, torque: Any) -> Floats:
    """Return the torque less what friction and cylinder take, where the axis is in balance with ``force``; (n,)."""
    delta, rest = balance(law, kappa, mu, V, -force)
    found = fields_at(law, kappa, V, delta)
    return torque - mu * found["Q_over_mu"] - found["M_cylinder"] / kappa - rest


def find_speeds_on_table(law: LawTable, loads: Loads) -> tuple[Integers, Floats, Floats]:
    """Find the speeds at which a table rolls steadily under loads without a gain on omega, in both directions.

    law : table of the material.
    loads : the loads, dimensionless, without a gain on omega; V is not given.
    Returns (index of the load; sign of V, 1.0 or -1.0; |V|, > 0), one entry for each crossing, (crossings,) each.
    """
    rows: Any = law.coupled
    low, high = np.log2(rows.u[0]) - _FAR_OCTAVES, np.log2(rows.u[-1]) + _FAR_OCTAVES
    nodes = np.linspace(low, high, int(_DENSITY * (high - low)))
    gains = loads.gains
    found: list[tuple[int, float, Floats]] = []
    for n in range(loads.mu.size):
        kappa, mu = float(loads.kappa[n]), float(loads.mu[n])
        for sign in (1.0, -1.0):

            def unbalanced(x: Floats, n: int = n, sign: float = sign, kappa: float = kappa, mu: float = mu) -> Floats:
                """Return the torque that is left at speeds exp2(x)/kappa."""
                V = np.exp2(x) / kappa
                force = sign * loads.force[n] + gains.force_V * V
                return _torque_left(law, kappa, mu, V, force, sign * loads.torque[n] + gains.torque_V * V)

            found.append((n, sign, np.exp2(find_zeros(unbalanced, nodes, _NOISE)) / kappa))
    load = np.concatenate([np.full(V.size, n) for n, _, V in found])
    signs = np.concatenate([np.full(V.size, sign) for _, sign, V in found])
    return load, signs, np.concatenate([V for _, _, V in found])


def rests_on_table(law: LawTable, loads: Loads) -> Booleans:
    """Return under which loads a cylinder on a table stays at V = omega = 0, (n,), by the slip of slow rolling."""
    still = np.zeros(loads.mu.size)
    left = [
        _torque_left(law, loads.kappa, loads.mu, still, sign * loads.force, sign * loads.torque) for sign in (1.0, -1.0)
    ]
    return (left[0] <= _NOISE) & (left[1] <= _NOISE)


def rest_on_table(law: LawTable, loads: Loads, load: Integers) -> tuple[Floats, Floats, Floats]:
    """Return creepage, fields and decay rate of states at rest, as limits of slow rolling with V > 0.

    law, loads : as of :func:`find_speeds_on_table`; ``load``: index of the load of each state, (n,).
    Returns (creepage, (n,), NaN where the friction does not suffice; Q, M_half_space, M_cylinder, beta, (4, n); rate by
    which V decays, (n,), without the slip that remains).
    """
    kappa, mu, j = (values[load] for values in (loads.kappa, loads.mu, loads.j))
    force, torque = loads.force[load], loads.torque[load]
    still = np.zeros(load.size)
    spin = loads.given != "force"
    delta, rest = balance(law, kappa, mu, still, torque if spin else -force, spin)
    found = fields_at(law, kappa, still, delta)
    Q, half_space, cylinder = mu * found["Q_over_mu"], found["M_half_space"] / kappa, found["M_cylinder"] / kappa
    V = _SLOW * law.coupled.u[0] / kappa  # type: ignore[union-attr]
    gains = loads.gains
    f, q = half_space - Q, Q + cylinder  # the loads in balance at this creepage
    push, turn = gains.force_V + gains.force_omega * (1.0 + delta), gains.torque_V + gains.torque_omega * (1.0 + delta)
    change = _torque_left(law, kappa, mu, V, f + push * V, q + turn * V) / V
    step = 1e-6 * mu
    lever = (_torque_left(law, kappa, mu, still, f - step, q) - _torque_left(law, kappa, mu, still, f, q)) / -step
    rate = -change / (j * (1.0 + delta) + np.maximum(lever, 0.0))
    return np.where(rest == 0.0, delta, np.nan), np.stack([Q, half_space, cylinder, found["beta"]]), rate
