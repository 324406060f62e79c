"""Figures of contact states, stresses, equilibria, tables and motions."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..symbols import MEASURED
from .style import LINES, THIN, variable_label, spaced_by_factors, plot_measured_range, log_ticks, new_figure, new_panels

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

#: fields that are drawn where they are there, in this order, at most so many
_FIELDS = (
    "Q", "M", "C_rr", "beta", "epsilon", "lam", "M_half_space", "M_cylinder", "length", "delta_star", "kappa_M", "N",
)  # fmt: skip
_PARTS, _MOST = ("M_half_space", "M_cylinder"), 6
#: of motions
_FULL_SLIP, _SHADE = 0, "0.87"
#: an output this near to a jump, as a share of the last time, holds one of its sides
_AT_A_JUMP = 1e-9


def varied_axes(data: xr.Dataset) -> list[str]:
    """Axes of more than one value that the fields lie over."""
    over = {dim for name in _shown(data) for dim in data[name].dims}
    return [str(dim) for dim, size in data.sizes.items() if size > 1 and dim in over]


def field_curves(data: xr.Dataset) -> Figure:
    """Each field over the first axis, a curve for some values of the second, at the middle of any other."""
    first, *others = varied_axes(data)
    title, held = str(data.attrs.get("title", "Contact")), data.attrs.get(MEASURED) if first == "V" else None
    if held is not None:
        title += "; dashed: beyond what was measured"
    for n, name in enumerate(others[1:]):
        middle = data.sizes[name] // 2
        title += f"{', ' if n else ', at '}{_at(data, name, middle)}"
        data = data.isel({name: middle})
    names = [name for name in _shown(data) if first in data[name].dims][:_MOST]
    figure, boxes = new_panels(title, len(names), 2, (4.8, 2.6), sharex=True)
    x, second = data[first].values, others[:1]
    places = np.linspace(0, data.sizes[second[0]] - 1, len(LINES)).astype(int) if second else [0]
    for name, box in zip(names, boxes, strict=True):
        for place, line in zip(np.unique(places).tolist(), LINES, strict=False):
            values = data[name].isel(dict.fromkeys(second, place), missing_dims="ignore").values
            plot_measured_range(box, x, values, held, label=_at(data, second[0], place) if second else None, **line)
        box.set(xlabel=variable_label(data[first]), ylabel=variable_label(data[name]))
        if name == "C_rr" or (name == "M" and data[name].attrs.get("units", "1") == "1"):
            box.set_title("coefficient of rolling resistance", fontsize="small")
        if spaced_by_factors(x):
            box.set_xscale("log")
            log_ticks(box.xaxis)
        else:
            box.locator_params(axis="x", nbins=6)
    if second:
        boxes[0].legend(frameon=False, fontsize="small")
    return figure


def stresses(data: xr.Dataset) -> Figure:
    """Pressure and shear stress along the contact, of the first state."""
    figure, box = new_figure("Pressure and shear stress along the contact")
    over = data["x"].dims[0]
    data = data.isel(dict.fromkeys(set(data.dims) - {over}, 0))
    for name, line in zip(("p", "tau"), LINES, strict=False):
        box.plot(data["x"].values, data[name].values, label=variable_label(data[name]), **line)
    box.axhline(0.0, **THIN)
    box.set(xlabel=variable_label(data["x"]), ylabel=f"{variable_label(data['p'])}, {variable_label(data['tau'])}")
    box.legend(frameon=False)
    return figure


def equilibria(data: xr.Dataset) -> Figure:
    """Speeds of all equilibria over what acts, stable (filled) and not (open)."""
    acting = (name for name in ("slope", "force", "torque") if name in data and np.ptp(_finite(data[name])) > 0.0)
    over = next(acting, "force")
    figure, box = new_figure("Steady rolling: stable (filled) and not (open)")
    x, V, stable = (data[name].broadcast_like(data["V"]).values.ravel() for name in (over, "V", "stable"))
    style: dict[str, Any] = {"color": LINES[1]["color"], "marker": "o", "linestyle": "", "markersize": 4}
    for which, face, text in ((stable != 0, style["color"], "stable"), (stable == 0, "white", "not stable")):
        held = which & np.isfinite(V)
        box.plot(x[held], V[held], markerfacecolor=face, label=text, **style)
    box.set(xlabel=variable_label(data[over]), ylabel=variable_label(data["V"]))
    moving = np.abs(_finite(data["V"]))
    moving = moving[moving > 0.0]
    if moving.max(initial=0.0) > 100.0 * moving.min(initial=np.inf):
        box.set_yscale("symlog", linthresh=moving.min())  # with rest, at V = 0
    box.legend(frameon=False)
    return figure


def motion(data: xr.Dataset) -> Figure:
    """V and omega, what acts, and the path over time; full slip is shaded."""
    driven = [name for name in ("force", "torque") if name in data and data[name].values.any()]
    rows = [["V", "omega"], ["x"], *[driven][: len(driven)]]
    if data["V"].attrs.get("units", "1") != "1":  # of unlike units
        rows = [[name] for row in rows for name in row]
    status = f": {data.attrs['status']}; full slip is grey" if "status" in data.attrs else ""
    size = 7.2, 1.0 + 1.9 * len(rows)
    figure, boxes = new_figure(f"Motion{status}", len(rows), 1, size, sharex=True, squeeze=False)
    t, slips = data["t"].values, np.concatenate(([0], data["regime"].values == _FULL_SLIP, [0]))
    ends = np.flatnonzero(np.diff(slips)).reshape(-1, 2)
    for box, names in zip(boxes.flat, rows, strict=True):
        for name, line in zip(names, LINES, strict=False):
            box.plot(*_with_corners(data, name), label=variable_label(data[name]), **line)
        for begin, end in ends.tolist():
            box.axvspan(t[begin], t[min(end, t.size - 1)], color=_SHADE, linewidth=0.0, zorder=0)
        box.axhline(0.0, **THIN)
        box.set_ylabel(", ".join(variable_label(data[name]) for name in names))
        if len(names) > 1:
            box.legend(frameon=False, fontsize="small")
    boxes[-1, 0].set(xlabel=variable_label(data["t"]), xlim=(t[0], t[-1] if t[-1] > t[0] else t[0] + 1.0))
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


def _shown(data: xr.Dataset) -> list[str]:
    """Fields that vary; all of them where none does.  Of like bodies without the parts of M, half of it each."""
    like = set(_PARTS) <= set(data) and data["M_cylinder"].equals(data["M_half_space"])
    fields = [name for name in _FIELDS if not (like and name in _PARTS)]
    names = [name for name in fields if name in data.data_vars and data[name].ndim]
    return [name for name in names if np.ptp(_finite(data[name])) > 0.0] or names


def _finite(values: xr.DataArray) -> NDArray[Any]:
    found: NDArray[Any] = values.values[np.isfinite(values.values)]
    return found if found.size else np.zeros(1)


def _at(data: xr.Dataset, name: str, place: int) -> str:
    """A place on an axis, in words."""
    return f"{variable_label(data[name])} = {float(data[name].values[place]):.4g}"
