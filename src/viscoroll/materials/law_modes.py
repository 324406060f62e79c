"""A series as kernels take it by its modes, and N of these, which rows are made from."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import ParameterError
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


def series_of(modes: Modes, weights: NDArray[np.float64] | None = None) -> Any:
    """The record of one series, or of many; ``weights``: the half-space's, of two bodies that differ."""
    from ..kernels.rows.series import Series

    strengths = (modes.J * modes.b)[..., :, None] * (modes.E * modes.a)[..., None, :]
    e, t = np.sqrt(modes.E / modes.a), np.sqrt(modes.J / modes.b)
    return Series(modes.a, modes.b, e, t, np.sqrt(strengths) / modes.gap, np.empty(0) if weights is None else weights)


def kernel_series(given: Any) -> tuple[Any, NDArray[np.float64]]:
    """(The record of a series, nothing), or (that of one mode, the alphas that it is to have); for one thread."""
    from ..kernels.rows.series import Series

    if isinstance(given, Prony):
        return series_of(given.modes), np.empty(0)
    one = Series(np.ones(1), np.ones(1), np.ones(1), np.ones(1), np.ones((1, 1)), np.empty(0))
    return one, np.array(given, dtype=np.float64).reshape(-1)


def unsteadiness(given: Any, zeta: NDArray[np.float64]) -> NDArray[np.float64]:
    """N of M = M(V) + N V' at every zeta; ``given``: a series or a pair, or alphas, one or one each."""
    from ..kernels.law.unsteady import unsteady_loop

    given, found, zeta = given.total if isinstance(given, Bodies) else given, np.zeros(zeta.size), zeta.view()
    if isinstance(given, Prony) and not given.E.size:
        return found
    zeta.flags.writeable = False  # as all that a kernel reads, see ``blocks.elements``
    unsteady_loop(*kernel_series(given), zeta, found, 0, found.size)
    return found
