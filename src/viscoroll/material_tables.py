"""Materials as kernels take them: tables that fill where they are met, a few of which every thread keeps."""

from __future__ import annotations

import threading
from collections import OrderedDict
from collections.abc import Callable
from typing import Any

#: materials that a thread keeps, of each kind
_KEPT = 8


class _Kept(threading.local):
    """Tables are written to without the GIL, so threads do not share them."""

    def __init__(self) -> None:
        self.materials: OrderedDict[float, Any] = OrderedDict()
        self.inverses: OrderedDict[float, Any] = OrderedDict()


_kept = _Kept()


def material(alpha: float) -> Any:
    """The record of one material, for this thread alone."""
    from .kernels.law.tabulated import tabulated

    return _found(_kept.materials, alpha, tabulated)


def inverses(alpha: float) -> Any:
    """The record of one material and of the inverses of its law, for this thread alone."""
    from .kernels.law.inverses import inverses_of
    from .kernels.law.standard import standard

    return _found(_kept.inverses, alpha, lambda alpha: inverses_of(standard(alpha)))


def _found(kept: OrderedDict[float, Any], alpha: float, make: Callable[[float], Any]) -> Any:
    """What is kept of this alpha, or was made now; the last used is the last to go."""
    if alpha in kept:
        kept.move_to_end(alpha)
        return kept[alpha]
    kept[alpha] = made = make(alpha)
    if len(kept) > _KEPT:
        kept.popitem(last=False)
    return made
