"""Materials as kernels take them: tables that fill where they are met, a few of which every thread keeps."""

from __future__ import annotations

import threading
from collections import OrderedDict
from typing import Any

#: materials that a thread keeps, some 0.3 MB each
_KEPT = 8


class _Kept(threading.local):
    """Tables are written to without the GIL, so threads do not share them."""

    def __init__(self) -> None:
        self.of: OrderedDict[float, Any] = OrderedDict()


_kept = _Kept()


def inverses(alpha: float) -> Any:
    """The record of one material and of the inverses of its law: for this thread alone."""
    from .kernels.law.inverses import Inverses
    from .kernels.law.tabulated import tabulated
    from .kernels.numerics.quartet import empty_table

    found = _kept.of.pop(alpha, None)
    if found is None:
        found = Inverses(tabulated(alpha), empty_table(), empty_table())
    _kept.of[alpha] = found
    if len(_kept.of) > _KEPT:
        _kept.of.popitem(last=False)
    return found


def material(alpha: float) -> Any:
    """The record of one material: for this thread alone."""
    return inverses(alpha).material
