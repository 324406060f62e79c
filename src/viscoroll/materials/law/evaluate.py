"""Values of the law by its modes, without a table: from these all rows are made."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ...core.array_types import Floats
from ...core.errors import ParameterError
from ..bodies import Bodies
from ..prony import Prony
from ..prony_forms import Modes

#: longest time, in units of T_ref, and inverse of the shortest one; beyond it numbers of rows overflow or vanish
_LONGEST = 1e100


def refuse_distant_times(slowest: float, fastest: float) -> None:
    """Raise ParameterError for times that rows cannot hold.

    slowest: slowest rate of creep, in units of 1/T_ref.
    fastest: fastest rate of relaxation, in units of 1/T_ref.
    """
    if not 1.0 / _LONGEST <= slowest <= fastest <= _LONGEST:
        allowed = f"within {1.0 / _LONGEST:g} to {_LONGEST:g} times T_ref"
        raise ParameterError("times", f"{1.0 / fastest:g} to {1.0 / slowest:g}", allowed)


def modes_record(modes: Modes, weights: Floats | None = None) -> Any:
    """Return the record of a series that kernels read (:class:`...kernels.rows.series.Series`).

    modes: strengths and rates of relaxation and of creep of one series, or of many along leading axes.
    weights: part of each creep mode that is the half-space's, 0 to 1, (..., modes), for two bodies that differ; None:
        they are alike.
    """
    from ...kernels.rows.series import Series

    strengths = (modes.J * modes.b)[..., :, None] * (modes.E * modes.a)[..., None, :]
    e, t = np.sqrt(modes.E / modes.a), np.sqrt(modes.J / modes.b)
    return Series(modes.a, modes.b, e, t, np.empty(0) if weights is None else weights, np.sqrt(strengths) / modes.gap)


def series_record(material: Any) -> tuple[Any, Floats]:
    """Return the arguments of the kernel that evaluates a law by its modes, for use by one thread.

    material: a series, two bodies, or alphas, one or one for each element.
    Returns (record of the series; alphas, (n,)): for a series or bodies an empty array of alphas; for alphas the
    record of one mode, which the kernel overwrites with each alpha in turn.
    """
    from ...kernels.rows.series import Series

    if isinstance(material, Bodies):
        # the kernel writes into the record, and the weights of a pair are read only
        return modes_record(material.total.modes, material.half_space_weights.copy()), np.empty(0)
    if isinstance(material, Prony):
        return modes_record(material.modes), np.empty(0)
    one = Series(np.ones(1), np.ones(1), np.ones(1), np.ones(1), np.empty(0), np.ones((1, 1)))
    return one, np.array(material, dtype=np.float64).reshape(-1)


class ModesValues(NamedTuple):
    """Functions of z = zeta from which rows are made, dimensionless, T_ref being the unit of time.

    values : g/z, h/z, and M/V of half-space and cylinder, (4, n).
    slopes : their derivatives with respect to ln(1/z), (4, n).
    N : factor of dV/dt in M = M(V) + N dV/dt, (n,).
    """

    values: Floats
    slopes: Floats
    N: Floats


def evaluate_by_modes(material: Any, z: Floats) -> ModesValues:
    """Evaluate the law by the formulas of its modes.

    material: a series, two bodies, or alphas, one or one for each z.
    z: half contact length divided by V T_ref, zeta of the paper, > 0 (infinite at rest), (n,).
    Returns :class:`ModesValues`; of elastic bodies all 0.
    """
    from ...kernels.rows.modes import modes_loop
    from ...kernels.rows.series import FUNCTIONS, new_workspace

    series, alpha = series_record(material)
    values, z = np.zeros((2 * FUNCTIONS + 1, z.size)), z.view()
    z.flags.writeable = False  # kernels are compiled for arguments that are read only
    if series.a.size:
        modes_loop(series, alpha, new_workspace(series.a.size), z, values)
    return ModesValues(values[:FUNCTIONS], values[FUNCTIONS:-1], values[-1])
