"""What all figures share: size, line styles that differ in grey, titles, labels."""

from __future__ import annotations

import re
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..errors import FileError
from ..files import replace_file
from ..symbols import SYMBOLS

if TYPE_CHECKING:
    from matplotlib.figure import Figure

#: Colour, dashes: the colours differ in lightness too, from black to light.
LINES: tuple[dict[str, Any], ...] = (
    {"color": "black", "linestyle": "-"},
    {"color": "#1f5fa8", "linestyle": "--"},
    {"color": "#c8642a", "linestyle": "-."},
    {"color": "#6aa84f", "linestyle": (0, (1, 1.2))},
)
#: Of quantile bands, from the widest.
_GREYS = ("0.85", "0.65", "0.45")
THIN = {"color": "0.7", "linewidth": 0.6}


def new_figure(
    title: str, rows: int = 1, columns: int = 1, size: tuple[float, float] = (6.4, 4.2), **options: Any
) -> tuple[Figure, Any]:
    """A figure with a title line, and its axes; nothing global is touched."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=size, dpi=150, layout="constrained")
    figure.suptitle(title, fontsize="medium")
    return figure, figure.subplots(rows, columns, **options)


def new_panels(title: str, count: int, most: int, size: tuple[float, float], **shared: bool) -> tuple[Figure, list[Any]]:
    """A figure of so many axes of one size, at ``most`` so many beside each other."""
    columns = min(most, count)
    rows = -(-count // columns)
    whole = max(6.4, size[0] * columns), 0.8 + size[1] * rows
    figure, grid = new_figure(title, rows, columns, whole, squeeze=False, **shared)
    for axes in grid.flat[count:]:
        axes.remove()
    return figure, [*grid.flat[:count]]


def plot_measured_range(axes: Any, x: NDArray, y: NDArray, held: tuple[float, float] | None, **line: Any) -> list[Any]:
    """Lines of matplotlib: a curve where |x| lies between the ends of what data ``held``, and dashed beyond."""
    if held is None:
        return list(axes.plot(x, y, **line))
    beyond = (np.abs(x) < held[0]) | (np.abs(x) > held[1])
    seen = np.where(beyond, np.nan, y)
    beyond[1:], beyond[:-1] = beyond[1:] | beyond[:-1], beyond[:-1] | beyond[1:]  # up to its neighbours
    drawn = axes.plot(x, seen, **line | {"linestyle": "-"})
    return [*drawn, *axes.plot(x, np.where(beyond, y, np.nan), **line | {"linestyle": "--", "label": None})]


def spaced_by_factors(x: NDArray[Any]) -> bool:
    """Whether places lie more evenly on a logarithmic axis than on a linear one."""
    places = np.unique(x)
    if places.size < 3 or places[0] <= 0.0:
        return False
    linear, logarithmic = np.diff(places), np.diff(np.log(places))
    return bool(logarithmic.std() / logarithmic.mean() < linear.std() / linear.mean())


def log_ticks(axis: Any) -> None:
    """Labels of a logarithmic axis that do not meet: 1, 2, 5 in plain digits below two decades, else powers of ten."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    low, high = axis.get_view_interval()
    if high < 100.0 * low:
        axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(NullFormatter())


def quantile_bands(axes: Any, t: NDArray, levels: NDArray, values: NDArray) -> None:
    """Quantiles over t, a row a level: pairs of them as bands, a middle one as a line."""
    for n in range(levels.size // 2):
        text = f"{100 * levels[n]:g} % to {100 * levels[-1 - n]:g} %"
        grey = _GREYS[min(n, len(_GREYS) - 1)]
        axes.fill_between(t, values[n], values[-1 - n], color=grey, linewidth=0.0, label=text)
    if levels.size % 2:
        n = levels.size // 2
        axes.plot(t, values[n], ".-", color="black", label=f"{100 * levels[n]:g} %")
    axes.axhline(0.0, **THIN)
    if levels.size:
        axes.legend(frameon=False, fontsize="small")


def axis_label(name: str, units: str = "1", symbol: str = "") -> str:
    """Axis label of a quantity: its symbol, or its name in words, and its unit if it has one."""
    symbol = SYMBOLS[name].latex if name in SYMBOLS else symbol
    # an SI quantity is not the ratio that its symbol may spell out
    symbol = symbol.partition("/")[0] if units != "1" else symbol
    return with_unit(f"${symbol}$" if symbol else name.replace("_", " "), units, ", ")


def variable_label(values: Any) -> str:
    """Axis label of a variable of a dataset."""
    return axis_label(str(values.name), values.attrs.get("units", "1"), values.attrs.get("symbol", ""))


def with_unit(text: str, units: str, between: str = " ") -> str:
    """Text, and behind it a unit like "m s-1", but for numbers ("1")."""
    return text if units == "1" else text + between + re.sub(r"(-\d)", r"$^{\1}$", units)


def save(figure: Figure, path: str | PathLike[str]) -> None:
    """Write a figure, whole or not at all; the suffix of ``path`` chooses the format.

    Raises
    ------
    FileError
        If it cannot be written there, or the suffix names no format.
    """
    formats = sorted(figure.canvas.get_supported_filetypes())
    suffix = Path(path).suffix
    if suffix.removeprefix(".").lower() not in formats:
        raise FileError(path, f"suffix {suffix!r} names no format: must be one of .{', .'.join(formats)}")
    with replace_file(path) as temporary:
        figure.savefig(temporary)
