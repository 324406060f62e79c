"""A word where a contact asks more of a material than was measured."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np

from ..errors import ModelWarning
from ..free_rolling import rolling
from ..kernels.compile.notice import is_worker
from ..materials.measured import Measured
from ..motion.warned import outside
from ..validity import measurement, passage
from .units import Cylinder

#: said once a process for each
_told: set[Measured] = set()


def look(cylinder: Cylinder, V: Any, extent: tuple[float, float] | None = None) -> None:
    """Warn where the contact at a speed of V, m/s, asks for frequencies that the data of a body do not hold.

    Only extremes are looked at, and rest is passed over: M is 0 there.

    extent : least and largest of V, where they are known.
    """
    known = cylinder._known_speeds
    if known is None:
        return
    least, most = _extent(V) if extent is None else extent
    slowest, fastest = max(least, -most, 0.0), max(most, -least)
    if not _beyond(slowest, fastest, known) or _told.issuperset(cylinder._measured.values()) or is_worker():
        return
    # the extremes of V and of l0 may be of different cylinders
    slowest, fastest = _extent(np.abs(V) / cylinder.l0)
    if known != (np.inf, 0.0) and not _beyond(slowest, fastest, cylinder._held):
        return
    _told.update(cylinder._measured.values())
    material, unit = cylinder.scene().in_own_time()
    rates = np.array([slowest, fastest])
    seen = passage(rates, rolling(material, rates * unit * cylinder.T_ref, ("lam",))[0])
    text = f"the material is not known here as measured: {measurement(seen, cylinder._measured).sentence}.  M and the "
    text += "contact length are a guess of the fit then; validity(V).measured tells where"
    warnings.warn(text, ModelWarning, stacklevel=outside())


def look_at_motion(cylinder: Cylinder, V0: Any, V: Any, speed: Any) -> None:
    """As :func:`look`, at the fastest of each motion: towards rest every speed is passed.

    V0 : m/s.  V : over times along the last axis, in units of ``speed``, m/s.
    """
    if cylinder._known_speeds is None:
        return
    fastest = np.nan if V is None or not np.size(V) else np.fmax(np.fmax.reduce(V, -1), -np.fmin.reduce(V, -1)) * speed
    fastest = fastest if V0 is None else np.fmax(fastest, np.abs(V0))
    look(cylinder, fastest, None if np.ndim(fastest) else (fastest, fastest))


def _extent(values: Any) -> tuple[float, float]:
    """Least and largest but for NaN; (0, 0) of nothing."""
    ends = (end.reduce(values, axis=None, initial=np.nan) for end in (np.fmin, np.fmax))
    return tuple(0.0 if np.isnan(end) else float(end) for end in ends)  # type: ignore[return-value]


def _beyond(slowest: float, fastest: float, known: tuple[float, float]) -> bool:
    return fastest > known[1] or 0.0 < slowest < known[0]
