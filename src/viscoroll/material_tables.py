"""Materials as kernels take them: tables that fill where they are met, a few of which every thread keeps."""

from __future__ import annotations

import math
import threading
from collections import OrderedDict
from collections.abc import Callable
from functools import lru_cache
from typing import Any

import numpy as np

from .prony import Prony

#: materials that a thread keeps, of each kind
_KEPT = 8
#: octaves beyond the shortest and the longest time of a material from which on it is in its limits
_MARGIN = 28


class _Kept(threading.local):
    """Tables are written to without the GIL, so threads do not share them."""

    def __init__(self) -> None:
        self.materials: OrderedDict[float | Prony, Any] = OrderedDict()
        self.inverses: OrderedDict[float | Prony, Any] = OrderedDict()


_kept = _Kept()


def record(given: float | Prony) -> Any:
    """The record of one material, an alpha or a series, for this thread alone."""
    return _found(_kept.materials, given, _tabulated)


def inverses(given: float | Prony) -> Any:
    """The record of one material and of the inverses of its law, for this thread alone."""
    from .kernels.law.inverses import inverses_of
    from .kernels.law.standard import standard

    def made(given: float | Prony) -> Any:
        return inverses_of(_tabulated(given) if isinstance(given, Prony) else standard(given))

    return _found(_kept.inverses, given, made)


def _tabulated(given: float | Prony) -> Any:
    from .kernels.law.tabulated import tabulated

    if not isinstance(given, Prony):
        return tabulated(given)
    whole = _series_table(given)
    return whole._replace(table=whole.table.copy())


def series(prony: Prony) -> Any:
    """The record of a series by its modes."""
    from .kernels.law.series import Series

    modes = prony.modes
    root = np.sqrt(np.outer(modes.J * modes.b, modes.E * modes.a))
    return Series(modes.a, modes.b, np.sqrt(modes.E / modes.a), np.sqrt(modes.J / modes.b), root / modes.gap)


@lru_cache(maxsize=_KEPT)
def _series_table(prony: Prony) -> Any:
    """The table of several modes, filled between its ends."""
    from .kernels.law.series import fill
    from .kernels.law.tabulated import Ends, Tabulated
    from .kernels.numerics.bins import bin_number
    from .kernels.numerics.quartet import BITS, empty_table

    modes = prony.modes
    octaves = math.floor(-math.log2(modes.a[-1])) - _MARGIN, math.ceil(-math.log2(modes.b[0])) + _MARGIN
    first, stop = (int(bin_number(2.0**octave, BITS)) for octave in octaves)
    table = empty_table(2 ** math.ceil(math.log2(stop - first)))
    fill(series(prony), first, stop, table)
    weights = modes.J * modes.b
    logs = math.log(2.0) - np.log(modes.b) - np.euler_gamma
    ends = Ends(True, float(weights.sum()), float((weights * logs).sum()), sum(prony.second_moments))
    return Tabulated(prony.alpha, prony.T_mean, float(1.0 / modes.a[-1]), table, ends)


def _found(kept: OrderedDict[float | Prony, Any], given: float | Prony, make: Callable[[Any], Any]) -> Any:
    """What is kept of this material, or was made now; the last used is the last to go."""
    if given in kept:
        kept.move_to_end(given)
        return kept[given]
    kept[given] = made = make(given)
    if len(kept) > _KEPT:
        kept.popitem(last=False)
    return made
