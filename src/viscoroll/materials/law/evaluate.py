"""Values of the law by its modes, without a table: from these all rows are made.

T_ref is the unit of time of a material, in which its rates and times are given; for a material that is given by alpha
alone it is T_epsilon.  z is half the transit time of the contact in units of T_ref (zeta of the paper).  The functions
g(z) and h(z) of the material (:mod:`...kernels.rows.series`) give the shift of the contact over half its length, g/z,
and the contact length over that at rest, (1 + 2 h/z)^(-1/2).
"""

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
    """Raise ParameterError for times that rows cannot hold: shorter than 1e-100 T_ref or longer than 1e100 T_ref.

    slowest: slowest rate of creep b_1, > 0, in units of 1/T_ref.
    fastest: fastest rate of relaxation a_N, >= ``slowest``, in units of 1/T_ref; a smaller one and NaN are refused too.
    Returns None for other times.
    """
    if not 1.0 / _LONGEST <= slowest <= fastest <= _LONGEST:
        allowed = f"within {1.0 / _LONGEST:g} to {_LONGEST:g} times T_ref"
        raise ParameterError("times", f"{1.0 / fastest:g} to {1.0 / slowest:g}", allowed)


def modes_record(modes: Modes, weights: Floats | None = None) -> Any:
    """Return the record of a series that kernels read (:class:`...kernels.rows.series.Series`).

    modes: :class:`..prony_forms.Modes`, strengths and rates of relaxation and of creep of one series, or of many along
        leading axes.
    weights: part of each creep mode that is the half-space's, 0 to 1, (..., modes), for two bodies that differ; None:
        they are alike, and the record has an empty array of weights.
    Returns a Series (a, b, e, t, weights, Q): rates a and b in units of 1/T_ref, ascending, those of ``modes``
    themselves; vectors e = sqrt(E_i/a_i) and t = sqrt(J_j/b_j), in T_ref^(1/2), (..., modes) each; ``weights``; and the
    dimensionless matrix Q = sqrt(J_j b_j E_i a_i)/(a_i - b_j), (..., modes, modes), [..., j, i].  All are empty along
    these axes for an elastic material.
    """
    from ...kernels.rows.series import Series

    strengths = (modes.J * modes.b)[..., :, None] * (modes.E * modes.a)[..., None, :]
    e, t = np.sqrt(modes.E / modes.a), np.sqrt(modes.J / modes.b)
    return Series(modes.a, modes.b, e, t, np.empty(0) if weights is None else weights, np.sqrt(strengths) / modes.gap)


def series_record(material: Any) -> tuple[Any, Floats]:
    """Return the arguments of the kernel that evaluates a law by its modes, for use by one thread.

    material: a :class:`..prony.Prony` of one material, a :class:`..bodies.Bodies` of one pair, or alphas >= 1: a
        number, or one for each element that the kernel is called for, (n,).
    Returns (record of the series, :class:`...kernels.rows.series.Series`, as of :func:`modes_record`; alphas).  For a
    series or bodies the alphas are an empty array; those of bodies have weights, also if they are alike.  For alphas
    they are a copy, (n,), (1,) of a number, and the record has one mode, which the kernel overwrites with each alpha in
    turn.
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

    values : g/z, h/z, and M/V of half-space and cylinder (in units of P T_ref), (4, n).
    slopes : their derivatives with respect to ln(1/z), (4, n).
    N : factor of dV/dt in M = M(V) + N dV/dt, in units of P T_ref^2, (n,).
    """

    values: Floats
    slopes: Floats
    N: Floats


def evaluate_by_modes(material: Any, z: Floats) -> ModesValues:
    """Evaluate the law by the formulas of its modes.

    material: a :class:`..prony.Prony` of one material, a :class:`..bodies.Bodies` of one pair, or alphas >= 1: a
        number, or one for each z, (n,).
    z: half contact length divided by V T_ref, zeta of the paper, > 0, (n,); infinite for the limit at rest.
    Returns :class:`ModesValues`: ``values``, g/z, h/z, and M/V of half-space and cylinder, (4, n); ``slopes``, their
    derivatives with respect to ln(1/z), (4, n); ``N`` of M = M(V) + N dV/dt, (n,); dimensionless, M/V in units of P
    T_ref, N of P T_ref^2.  Where z is infinite, values and N are the limits at rest and slopes are NaN.  Of elastic
    bodies all are 0 (alpha = 1 has slopes NaN at infinite z too).
    """
    from ...kernels.rows.modes import modes_loop
    from ...kernels.rows.series import FUNCTIONS, new_workspace

    series, alpha = series_record(material)
    values, z = np.zeros((2 * FUNCTIONS + 1, z.size)), z.view()
    z.flags.writeable = False  # kernels are compiled for arguments that are read only
    if series.a.size:
        modes_loop(series, alpha, new_workspace(series.a.size), z, values)
    return ModesValues(values[:FUNCTIONS], values[FUNCTIONS:-1], values[-1])
