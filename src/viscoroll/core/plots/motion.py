"""The figure of one motion."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .style import LINES, THIN, axis, new_figure

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

_FULL_SLIP, _SHADE = 0, "0.87"
#: an output this near to a jump, as a share of the last time, holds one of its sides
_AT_A_JUMP = 1e-9


def one(data: xr.Dataset) -> Figure:
    """V and omega, what acts, and the path over time; full slip is shaded."""
    driven = [name for name in ("force", "torque") if name in data and data[name].values.any()]
    rows: list[tuple[str, ...]] = [("V",), ("omega",), ("x",)] if _units(data, "V") else [("V", "omega"), ("x",)]
    if driven:
        rows += [(name,) for name in driven] if _units(data, "force") else [tuple(driven)]
    figure, axes = new_figure(_title(data), len(rows), 1, (7.2, 1.0 + 1.9 * len(rows)), sharex=True, squeeze=False)
    t = data["t"].values
    for box, names in zip(axes.ravel(), rows, strict=True):
        for name, line in zip(names, LINES, strict=False):
            box.plot(*_with_corners(data, name), label=axis(data[name]), **line)
        _shade(box, t, data["regime"].values == _FULL_SLIP)
        box.axhline(0.0, **THIN)
        box.set_ylabel(", ".join(axis(data[name]) for name in names))
        if len(names) > 1:
            box.legend(frameon=False, fontsize="small")
    axes[-1, 0].set(xlabel=axis(data["t"]), xlim=(t[0], t[-1] if t[-1] > t[0] else t[0] + 1.0))
    return figure


def _with_corners(data: xr.Dataset, name: str) -> tuple[NDArray, NDArray]:
    """(times, values) of a quantity: what a schedule gave has its corners too, and both sides of each jump.

    What acts beside it, as a feedback and the pull of the slope, does not jump.
    """
    t, values = data["t"].values, data[name].values
    if f"drive_{name}_time" not in data:
        return t, values
    corners, given = (data[key].values.ravel() for key in (f"drive_{name}_time", f"drive_{name}"))
    jumps = corners[1:][np.diff(corners) == 0.0]
    kept = (np.abs(t[:, None] - jumps) > _AT_A_JUMP * t[-1]).all(axis=1)
    within = (corners >= t[0]) & (corners <= t[-1])
    if not kept.any():
        return t, values
    beside = values[kept] - np.interp(t[kept], corners, given)
    times = np.concatenate([t[kept], corners[within]])
    found = np.concatenate([values[kept], np.interp(corners[within], t[kept], beside) + given[within]])
    order = np.argsort(times, kind="stable")
    return times[order], found[order]


def _shade(axes: Any, t: NDArray, full_slip: NDArray[np.bool_]) -> None:
    """Grey where the motion slips fully."""
    edges = np.flatnonzero(np.diff(np.concatenate(([0], full_slip.astype(np.int8), [0]))))
    for first, last in zip(edges[::2], edges[1::2], strict=True):
        axes.axvspan(t[first], t[min(last, t.size - 1)], color=_SHADE, linewidth=0.0, zorder=0)


def _units(data: xr.Dataset, name: str) -> bool:
    return bool(data[name].attrs.get("units", "1") != "1")


def _title(data: xr.Dataset) -> str:
    return f"Motion: {data.attrs['status']}; full slip is grey" if "status" in data.attrs else "Motion"
