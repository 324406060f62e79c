"""A series as kernels take it by its modes, and what these make rows of."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ..core.array_types import Floats
from ..core.errors import ParameterError
from .bodies import Bodies
from .prony import Prony
from .prony_forms import Modes

#: times in T_ref beyond which numbers of rows leave the doubles
_LONGEST = 1e100


def refuse_far(slowest: float, fastest: float) -> None:
    """Raise ParameterError where times, by the rates of creep and relaxation, leave the range of rows."""
    if not 1.0 / _LONGEST <= slowest <= fastest <= _LONGEST:
        allowed = f"within {1.0 / _LONGEST:g} to {_LONGEST:g} of their unit"
        raise ParameterError("times", f"{1.0 / fastest:g} to {1.0 / slowest:g}", allowed)


def series_of(modes: Modes, weights: Floats | None = None) -> Any:
    """The record of one series, or of many; ``weights``: the half-space's, of two bodies that differ."""
    from ..kernels.rows.series import Series

    strengths = (modes.J * modes.b)[..., :, None] * (modes.E * modes.a)[..., None, :]
    e, t = np.sqrt(modes.E / modes.a), np.sqrt(modes.J / modes.b)
    return Series(modes.a, modes.b, e, t, np.empty(0) if weights is None else weights, np.sqrt(strengths) / modes.gap)


def kernel_series(given: Any) -> tuple[Any, Floats]:
    """(The record of a series, nothing), or (that of one mode, the alphas that it is to have); for one thread."""
    from ..kernels.rows.series import Series

    if isinstance(given, Bodies):
        # a copy, which can be written to: the table of a pair keeps its weights read only
        return series_of(given.total.modes, given.half_space_weights.copy()), np.empty(0)
    if isinstance(given, Prony):
        return series_of(given.modes), np.empty(0)
    one = Series(np.ones(1), np.ones(1), np.ones(1), np.ones(1), np.empty(0), np.ones((1, 1)))
    return one, np.array(given, dtype=np.float64).reshape(-1)


class AtPlaces(NamedTuple):
    """What rows are made of, at places of z: g/z, h/z and the parts of m in half-space and cylinder.

    values, slopes : (4, places), slopes over ln(1/z).  N : of M = M(V) + N V'.
    """

    values: Floats
    slopes: Floats
    N: Floats


def by_modes(given: Any, z: Floats) -> AtPlaces:
    """By no table, at every z = zeta > 0; ``given``: a series, a pair, or alphas, one or one each."""
    from ..kernels.rows.modes import modes_loop
    from ..kernels.rows.series import FUNCTIONS, new_workspace

    series, alpha = kernel_series(given)
    found, z = np.zeros((2 * FUNCTIONS + 1, z.size)), z.view()
    z.flags.writeable = False  # as all that a kernel reads, see ``blocks.block_reader``
    if series.a.size:
        modes_loop(series, alpha, new_workspace(series.a.size), z, found)
    return AtPlaces(found[:FUNCTIONS], found[FUNCTIONS:-1], found[-1])
