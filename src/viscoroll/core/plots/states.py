"""Figures of contact states, stresses, equilibria and tables."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..symbols import MEASURED
from .style import LINES, THIN, axis, dashed, log_ticks, new_figure

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

#: fields that are drawn where they are there, in this order
_FIELDS = (
    "Q", "M", "C_rr", "beta", "epsilon", "lam", "M_half_space", "M_cylinder", "length", "delta_star", "kappa_M", "N",
)  # fmt: skip
_PARTS = ("M_half_space", "M_cylinder")
_MOST = 6
#: of a second axis
_CURVES = 4


def axes_of(data: xr.Dataset) -> list[str]:
    """Axes of more than one value that the fields lie over."""
    fields = [data[name] for name in _shown(data)]
    return [str(dim) for dim in data.sizes if data.sizes[dim] > 1 and any(dim in field.dims for field in fields)]


def over_axes(data: xr.Dataset) -> Figure:
    """Each field over the first axis, a curve for some values of the second, at the middle of any other."""
    first, *others = axes_of(data)
    rest = {name: data.sizes[name] // 2 for name in others[1:]}
    title, held = str(data.attrs.get("title", "Contact")), data.attrs.get(MEASURED) if first == "V" else None
    if held is not None:
        title += "; dashed: beyond what was measured"
    if rest:
        title += ", at " + ", ".join(f"{axis(data[name])} = {data[name].values[n]:.4g}" for name, n in rest.items())
    data = data.isel(rest)
    names = [name for name in _shown(data) if first in data[name].dims][:_MOST]
    columns = min(len(names), 2)
    rows = -(-len(names) // columns)
    figure, boxes = new_figure(title, rows, columns, (4.8 * columns, 1.0 + 2.6 * rows), squeeze=False, sharex=True)
    x = data[first].values if first in data.coords else np.arange(data.sizes[first])
    for name, box in zip(names, boxes.ravel(), strict=False):
        for n, line in _picked(data, others[:1]):
            values = data[name].isel(n) if n and set(n) <= set(data[name].dims) else data[name]
            text = ", ".join(f"{axis(data[key])} = {_at(data, key, place):.4g}" for key, place in n.items())
            dashed(box, x, values.values, held, label=text or None, **line)
        box.set(xlabel=axis(data[first]) if first in data.coords else first, ylabel=axis(data[name]))
        if name == "C_rr" or (name == "M" and data[name].attrs.get("units", "1") == "1"):
            box.set_title("coefficient of rolling resistance", fontsize="small")
        if _rises_by_factors(x):
            box.set_xscale("log")
            log_ticks(box.xaxis)
        else:
            box.locator_params(axis="x", nbins=6)
    for box in boxes.ravel()[len(names) :]:
        box.remove()
    if others:
        boxes[0, 0].legend(frameon=False, fontsize="small")
    return figure


def stresses(data: xr.Dataset) -> Figure:
    """Pressure and shear stress along the contact."""
    figure, box = new_figure("Pressure and shear stress along the contact")
    x = data["x"]
    for name, line in zip(("p", "tau"), LINES, strict=False):
        values = data[name].values
        values = values.reshape(x.size, -1)[:, 0] if x.ndim == 1 and values.shape[:1] == x.shape else values.ravel()
        box.plot(x.values.ravel()[: values.size], values, label=axis(data[name]), **line)
    box.axhline(0.0, **THIN)
    box.set(xlabel=axis(x), ylabel=f"{axis(data['p'])}, {axis(data['tau'])}")
    box.legend(frameon=False)
    return figure


def equilibria(data: xr.Dataset) -> Figure:
    """Speeds of all equilibria over what acts, stable (filled) and not (open)."""
    names = [name for name in ("slope", "force", "torque") if name in data and np.ptp(_finite(data[name])) > 0.0]
    over = names[0] if names else "force"
    figure, box = new_figure("Steady rolling: stable (filled) and not (open)")
    acting = data[over].broadcast_like(data["V"]).transpose(*data["V"].dims).values
    V, stable = data["V"].values, data["stable"].values != 0
    colour = LINES[1]["color"]
    for which, face, text in ((stable, colour, "stable"), (~stable, "white", "not stable")):
        held = which & np.isfinite(V)
        box.plot(acting[held], V[held], "o", color=colour, markerfacecolor=face, markersize=4, label=text)
    speeds = _finite(data["V"])
    wide = speeds.min() > 0.0 and speeds.max() > 100.0 * speeds.min()
    box.set(xlabel=axis(data[over]), ylabel=axis(data["V"]), yscale="log" if wide else "linear")
    box.legend(frameon=False)
    return figure


def _shown(data: xr.Dataset) -> list[str]:
    """Fields that vary; all of them where none does.  Of like bodies without the parts of M, half of it each."""
    like = set(_PARTS) <= set(data) and data["M_cylinder"].equals(data["M_half_space"])
    fields = [name for name in _FIELDS if not (like and name in _PARTS)]
    names = [name for name in fields if name in data.data_vars and data[name].ndim]
    return [name for name in names if np.ptp(_finite(data[name])) > 0.0] or names


def _finite(values: xr.DataArray) -> NDArray[Any]:
    found: NDArray[Any] = values.values[np.isfinite(values.values)]
    return found if found.size else np.zeros(1)


def _picked(data: xr.Dataset, others: list[str]) -> list[tuple[dict[str, int], dict[str, Any]]]:
    """Places on a second axis, evenly, and the style of each."""
    if not others:
        return [({}, LINES[0])]
    places = np.unique(np.linspace(0, data.sizes[others[0]] - 1, _CURVES).astype(int))
    return [({others[0]: int(place)}, line) for place, line in zip(places, LINES, strict=False)]


def _at(data: xr.Dataset, name: str, place: int) -> float:
    return float(data[name].values[place]) if name in data.coords else float(place)


def _rises_by_factors(x: NDArray[Any]) -> bool:
    """Whether places lie more evenly on a logarithmic axis than on a linear one."""
    places = np.unique(x)
    if places.size < 3 or places[0] <= 0.0:
        return False
    linear, logarithmic = np.diff(places), np.diff(np.log(places))
    return bool(logarithmic.std() / logarithmic.mean() < linear.std() / linear.mean())
