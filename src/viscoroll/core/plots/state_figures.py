"""Figures of contact states, stresses, equilibria, tables and motions."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..scale import MEASURED
from . import (
    LINES,
    has_numbers,
    log_ticks,
    new_figure,
    new_panels,
    plot_measured_range,
    small_legend,
    spaced_by_factors,
    symbol_label,
    variable_label,
    zero_line,
)

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

#: Fields that a figure shows if the dataset has them, in this order.
_FIELDS = (
    "Q",
    "M",
    "C_rr",
    "beta",
    "epsilon",
    "lam",
    "M_half_space",
    "M_cylinder",
    "length",
    "delta_star",
    "kappa_M",
    "N",
)
#: Fields that are left out where they are equal, each half of M.
_PARTS = ("M_half_space", "M_cylinder")
#: Largest number of fields in a figure.
_MAX_PANELS = 6
#: Codes of the regimes in which the contact slides: full slip, and a wheel that is locked (at rest
#: it is held).
_SLIDING = (0, 3)
#: Fastest speed of an axis in m/s: no roller is faster, though equilibria are, where shear waves
#: forbid them.
_FASTEST = 100.0
#: Grey of sliding in a motion.
_SHADE = "0.87"
#: An output nearer to a jump than this fraction of the last time has the value of one of its sides.
_JUMP_RTOL = 1e-9


def varied_axes(data: xr.Dataset) -> list[str]:
    """Return the names of the axes of several values that the shown fields of ``data`` depend on,
    in its order.
    """
    dims = {dim for name in _shown_fields(data) for dim in data[name].dims}
    return [str(dim) for dim, size in data.sizes.items() if size > 1 and dim in dims]


def field_curves(data: xr.Dataset) -> Figure:
    """Draw fields of a dataset against its first axis of several values, with curves for at most
    four of the second.

    data: fields of the contact over axes such as V and delta, with their coordinates and the
        attribute title.  At least one axis has several values (else ValueError).  Of the second
        such axis there are curves at its first, its last and two evenly spaced indices between.
        Third and further axes are at their middle, which the title states.  Over V curves are
        dashed outside the measured band, if the attribute :data:`.scale.MEASURED` states it.
    Returns the :class:`matplotlib.figure.Figure`, with the first :data:`_MAX_PANELS` of those
    fields that depend on the first axis.  Its axis is logarithmic if the values are spaced by
    factors.
    """
    data = _in_millimetres(data.squeeze(drop=True), "length")
    first, *others = varied_axes(data)
    title = str(data.attrs.get("title", "Contact"))
    band = data.attrs.get(MEASURED) if first == "V" else None
    if band is not None:
        title += "; dashed: outside the measured band"
    for n, name in enumerate(others[1:]):
        middle = data.sizes[name] // 2
        title += f"{', ' if n else ', at '}{_value_label(data, name, middle)}"
        data = data.isel({name: middle})
    names = [name for name in _shown_fields(data) if first in data[name].dims][:_MAX_PANELS]
    figure, panels = new_panels(title, len(names), 2.2, sharex=True)
    x = data[first].values
    second = others[:1]
    x = x.astype(str) if x.dtype.kind in "Om" else x  # matplotlib places texts evenly
    indices = np.linspace(0, data.sizes[second[0]] - 1, len(LINES)).astype(int) if second else [0]
    for name, axes in zip(names, panels, strict=True):
        for index, line in zip(np.unique(indices).tolist(), LINES, strict=False):
            values = data[name].isel(dict.fromkeys(second, index), missing_dims="ignore").values
            label = _value_label(data, second[0], index) if second else None
            plot_measured_range(axes, x, values, band, label=label, **line)
        axes.set(xlabel=variable_label(data[first]), ylabel=variable_label(data[name]))
        if name == "M" and data[name].attrs.get("units", "1") == "1":
            axes.set_title("coefficient of rolling resistance", fontsize="small")
        if spaced_by_factors(x):
            axes.set_xscale("log")
            log_ticks(axes.xaxis)
        elif has_numbers(x):
            axes.locator_params(axis="x", nbins=6)
    if second:
        small_legend(panels[0])
    return figure


def stresses(data: xr.Dataset) -> Figure:
    """Draw pressure and, where it is known, shear stress along the contact.

    data: dataset with ``x``, place along the contact, ``p``, pressure, and, but for a cover,
        ``tau``, shear stress, with the attribute units; of several states, along other axes than
        the first that x varies along, the first is drawn.
    Returns the :class:`matplotlib.figure.Figure`, with the curves in one panel.
    """
    data = _in_millimetres(data, "x")
    names = [name for name in ("p", "tau") if name in data]
    figure, axes = new_figure(f"Pressure{' and shear stress' * ('tau' in names)} along the contact")
    x = data["x"]
    along = next((dim for n, dim in enumerate(x.dims) if np.diff(x.values, axis=n).any()), None)
    data = data.isel(dict.fromkeys(set(data.dims) - {along}, 0))
    for name, line in zip(names, LINES, strict=False):
        axes.plot(data["x"].values, data[name].values, label=symbol_label(data[name]), **line)
    zero_line(axes)
    labels = (variable_label(data[name]) for name in names)
    axes.set(xlabel=variable_label(data["x"]), ylabel="\n".join(labels))
    axes.legend(frameon=False)
    return figure


def equilibria(data: xr.Dataset) -> Figure:
    """Draw the speeds of all equilibria over the load, stable (filled) or not (open).

    data: dataset of steady rolling, as in ``Steady.to_xarray``: V, stable (1 or 0) and the loads.
        The load on the axis is the first of slope, force and torque that varies, else the force,
        which must be there then (KeyError).  Entries whose V is NaN, where there are fewer
        equilibria, are left out.
    Returns the :class:`matplotlib.figure.Figure`.  If the magnitudes of the speeds, rest apart,
    differ by a factor of more than 100, their axis is logarithmic on both sides of a linear part
    between plus and minus the least magnitude.
    """
    loads = (
        name
        for name in ("slope", "force", "torque")
        if name in data and np.ptp(_finite(data[name])) > 0.0
    )
    load = next(loads, "force")
    figure, axes = new_figure("Steady rolling: stable (filled) and not (open)")
    x, V, stable = (
        data[name].broadcast_like(data["V"]).values.ravel() for name in (load, "V", "stable")
    )
    style: dict[str, Any] = {
        "color": LINES[1]["color"],
        "marker": "o",
        "linestyle": "",
        "markersize": 4,
    }
    for chosen, face, text in (
        (stable != 0, style["color"], "stable"),
        (stable == 0, "white", "unstable"),
    ):
        drawn = chosen & np.isfinite(V)
        axes.plot(x[drawn], V[drawn], markerfacecolor=face, label=text, **style)
    axes.set(xlabel=variable_label(data[load]), ylabel=variable_label(data["V"]))
    speeds = np.abs(_finite(data["V"]))
    speeds = speeds[speeds > 0.0]
    if speeds.max(initial=0.0) > 100.0 * speeds.min(initial=np.inf):
        axes.set_yscale("symlog", linthresh=speeds.min())  # it has a place for rest, V = 0
    if data["V"].attrs.get("units", "1") != "1" and speeds.max(initial=0.0) > _FASTEST:
        axes.set_ylim(*np.clip(axes.get_ylim(), -_FASTEST, _FASTEST))
    axes.legend(frameon=False)
    return figure


def motion(data: xr.Dataset) -> Figure:
    """Draw V and omega, the distance x, and force and torque of a motion over time; sliding is
    shaded.

    data: dataset of one motion, with ``t``, ``V``, ``omega``, ``x`` and ``regime``, whose codes 0
        and 3 are full slip and a locked wheel;
        ``force`` and ``torque`` are left out where they are missing or 0 at all times; corners of a
        schedule of NAME are in ``drive_NAME_time`` and ``drive_NAME``; the attribute ``status``, if
        it is there, is in the title.  In SI units, those of V, each quantity has its own panel,
        else V and omega share one, as force and torque do.
    Returns the :class:`matplotlib.figure.Figure`.
    """
    loads = [name for name in ("force", "torque") if name in data and data[name].values.any()]
    rows = [["V", "omega"], ["x"], *([loads] if loads else [])]
    if data["V"].attrs.get("units", "1") != "1":  # quantities of different units have an axis each
        rows = [[name] for row in rows for name in row]
    status = f": {data.attrs['status']}; sliding is grey" if "status" in data.attrs else ""
    figure, grid = new_figure(
        f"Motion{status}", len(rows), 1, 1.0 + 1.7 * len(rows), sharex=True, squeeze=False
    )
    t = data["t"].values
    slips = np.concatenate(([0], data["regime"].isin(_SLIDING).values, [0]))
    ends = np.flatnonzero(np.diff(slips)).reshape(-1, 2)
    for axes, names in zip(grid.flat, rows, strict=True):
        for name, line in zip(names, LINES, strict=False):
            axes.plot(*_add_corners(data, name), label=symbol_label(data[name]), **line)
        for start, stop in ends.tolist():
            axes.axvspan(t[start], t[min(stop, t.size - 1)], color=_SHADE, linewidth=0.0, zorder=0)
        zero_line(axes)
        axes.set_ylabel("\n".join(variable_label(data[name]) for name in names))
        if len(names) > 1:
            small_legend(axes)
    grid[-1, 0].set(
        xlabel=variable_label(data["t"]), xlim=(t[0], t[-1] if t[-1] > t[0] else t[0] + 1.0)
    )
    return figure


def _in_millimetres(data: xr.Dataset, name: str) -> xr.Dataset:
    """Return a dataset whose contact length is in mm, for figures.

    data: dataset of states.
    name: name of the variable with the contact length.
    Returns ``data`` itself if the variable is missing or is not in m; else a new dataset with the
    length in mm and without lam, the same length divided by l0.
    """
    if name not in data.variables or data[name].attrs.get("units") != "m":
        return data
    return data.drop_vars("lam", errors="ignore").assign(
        {name: (1e3 * data[name]).assign_attrs(units="mm")}
    )


def _add_corners(data: xr.Dataset, name: str) -> tuple[NDArray, NDArray]:
    """Add the corners and both sides of the jumps of a schedule to a quantity of a motion over
    time, for its curve.

    Without them a curve through the output times would show a jump as a slope.  The quantity is the
    schedule plus other loads, as a feedback and that of the slope, which have no jumps and are
    interpolated to the corners.  Output times at a jump are replaced by its two sides.
    data: :class:`xr.Dataset`, the motion; a schedule of NAME is in ``drive_NAME_time`` and
        ``drive_NAME``.
    name: name of the quantity, NAME.
    Returns (times, values), (k,) each, times ascending, in the units of ``data``: those of ``data``
    itself without a schedule, and if all output times are at jumps.
    """
    t = data["t"].values
    values = data[name].values
    if f"drive_{name}_time" not in data:
        return t, values
    corners, given = (data[key].values.ravel() for key in (f"drive_{name}_time", f"drive_{name}"))
    jumps = corners[1:][np.diff(corners) == 0.0]
    kept = (np.abs(t[:, None] - jumps) > _JUMP_RTOL * t[-1]).all(axis=1)
    within = (corners >= t[0]) & (corners <= t[-1])
    if not kept.any():
        return t, values
    other_loads = values[kept] - np.interp(t[kept], corners, given)
    times = np.concatenate([t[kept], corners[within]])
    found = np.concatenate(
        [values[kept], np.interp(corners[within], t[kept], other_loads) + given[within]]
    )
    order = np.argsort(times, kind="stable")
    return times[order], found[order]


def _shown_fields(data: xr.Dataset) -> list[str]:
    """Return the fields of ``data`` that vary, else all of them; of like bodies without the parts
    of M.
    """
    like = set(_PARTS) <= set(data) and data["M_cylinder"].equals(data["M_half_space"])
    fields = [name for name in _FIELDS if not (like and name in _PARTS)]
    names = [name for name in fields if name in data.data_vars and data[name].ndim]
    return [name for name in names if np.ptp(_finite(data[name])) > 0.0] or names


def _finite(values: xr.DataArray) -> NDArray[Any]:
    """Return the finite ``values``, 0 if there is none."""
    found: NDArray[Any] = values.values[np.isfinite(values.values)]
    return found if found.size else np.zeros(1)


def _value_label(data: xr.Dataset, name: str, index: int) -> str:
    """Return a value of the axis ``name`` of ``data``, at an ``index``, in words."""
    values = data[name].values
    return f"{symbol_label(data[name])} = {values[index]:{'.4g' if has_numbers(values) else ''}}"
