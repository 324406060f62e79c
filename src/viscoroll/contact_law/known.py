"""What the bodies of a cylinder know of themselves: density, thickness, frequencies at which they were measured."""

from __future__ import annotations

import math
import warnings
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core.errors import ModelWarning, outside
from ..kernels.compile.notice import is_worker
from ..materials.material import Material
from ..materials.measured import Measured
from ..materials.pair import Pair
from ..materials.prony import Prony
from .assumptions import MISFIT_LIMIT, held_speeds, measurement

#: of the compliance, a part below which a body may be as thin and as little known as it likes
_LEAST_PART = 0.01
#: said once a process for each
_told: set[Measured] = set()


def deforming(pair: Pair | None) -> dict[str, Material]:
    """The different bodies whose part of the compliance counts; none where none is known."""
    if pair is None:
        return {}
    if pair.like:
        return {"the material": pair.half_space}
    bodies = {"the cylinder": (pair.cylinder, pair.share), "the base": (pair.half_space, 1.0 - pair.share)}
    return {name: body for name, (body, part) in bodies.items() if part >= _LEAST_PART}


def slowness(pair: Pair | None, G: Any, speed: NDArray[np.float64], density: float | None) -> tuple[Any, list[str]]:
    """(Speed over that of the slowest shear wave, or None; bodies whose density is not known).

    ``G`` : that of both bodies where there is no pair.
    """
    bodies: list[tuple[str, Any, float | None]] = [("the material", G, density)]
    if pair is not None:
        first, second = pair.cylinder, pair.half_space
        own = first.density if density is None else density
        bodies = [("the cylinder", first.G, own), ("the base", second.G, second.density)]
        if pair.like:
            bodies = [("the material", first.G, second.density if own is None else own)]
    # in this order V = 0 gives 0 at any density
    with np.errstate(over="ignore"):
        ratios = [speed * np.sqrt(1.0 / own) * math.sqrt(weight) for _, own, weight in bodies if weight is not None]
    unknown = [name for name, own, weight in bodies if weight is None and not np.all(np.isinf(own))]
    return (np.max(np.broadcast_arrays(*ratios), axis=0) if ratios else None), unknown


def held(records: Mapping[str, Measured], series: Prony, T_ref: float) -> tuple[float, float]:
    """|V|/l0 between which the contact asks for what all bodies' data hold, 1/s."""
    ends = max(data.low for data in records.values()), min(data.high for data in records.values())
    low, high = held_speeds(series, *(rate * T_ref for rate in ends))
    return low / T_ref, high / T_ref


def misses(records: Mapping[str, Measured]) -> bool:
    """Whether a fit misses its data."""
    return any(data.misfit > MISFIT_LIMIT for data in records.values())


def beyond(extent: tuple[float, float], ends: tuple[float, float]) -> bool:
    """Whether speeds leave what is held; rest is passed over: M is 0 there."""
    slowest, fastest = max(extent[0], -extent[1], 0.0), max(extent[1], -extent[0])
    return fastest > ends[1] or 0.0 < slowest < ends[0]


def extent_of(values: Any) -> tuple[float, float]:
    """Least and largest but for NaN; (0, 0) of nothing."""
    ends = (end.reduce(values, axis=None, initial=np.nan) for end in (np.fmin, np.fmax))
    return tuple(0.0 if np.isnan(end) else float(end) for end in ends)  # type: ignore[return-value]


def told(records: Mapping[str, Measured]) -> bool:
    """Whether all was said of these, or it is not to be said here."""
    return _told.issuperset(records.values()) or is_worker()


def tell(records: Mapping[str, Measured], seen: Any) -> None:
    """Say that the contact is passed at rates that the data of a body do not hold."""
    _told.update(records.values())
    text = f"the material is not known here as measured: {measurement(seen, records).sentence}.  M and the "
    text += "contact length are a guess of the fit then; validity(V).measured tells where"
    warnings.warn(text, ModelWarning, stacklevel=outside())
