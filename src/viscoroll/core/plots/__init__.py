"""Common parts of all figures: size, line styles that differ in grey, titles, labels.

Figures of results: :func:`draw` of any dataset of a result or a file.
"""

from __future__ import annotations

import re
from os import PathLike
from textwrap import fill
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..errors import FileError, ParameterError
from ..files import as_path, replace_file
from ..scale import SYMBOLS

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure


# --- Common parts of all figures ---

#: Styles of curves.  The colours differ in lightness too, from black to light, so that prints in
#: grey are readable.
LINES: tuple[dict[str, Any], ...] = (
    {"color": "black", "linestyle": "-"},
    {"color": "#1f5fa8", "linestyle": "--"},
    {"color": "#c8642a", "linestyle": "-."},
    {"color": "#6aa84f", "linestyle": (0, (1, 1.2))},
)
#: Height above quantile bands that their legend needs, as a part of the height of the bands: that
#: of three lines.
_ABOVE_BANDS = 0.5
#: Greys of quantile bands, from the widest.
_GREYS = ("0.85", "0.65", "0.45")
#: Width of every figure, inches.  On a screen 390 pixels wide the smallest text, of 8.3 points, is
#: then 7 pixels high.
WIDTH = 6.4
#: Characters in a line of the words of an axis: two panels stand beside each other.
_LABEL_WIDTH = 26
#: Style of lines of reference, such as zero.
THIN = {"color": "0.7", "linewidth": 0.6}


def new_figure(
    title: str, rows: int = 1, columns: int = 1, height: float = 4.2, **options: Any
) -> tuple[Figure, Any]:
    """Make a figure without a change of matplotlib's global state, of 200 dots per inch and with
    constrained layout.

    title: text on top of the figure.
    rows, columns: numbers of rows and columns of axes, >= 1.
    height: height of the figure, inches; its width is ``WIDTH``, 6.4 inches.
    options: keyword arguments of ``Figure.subplots``, as ``sharex``, ``squeeze`` and
    ``height_ratios``.
    Returns (figure; its axes as in ``Figure.subplots``: one for a single row and column, a vector
    for one row or one column, else an array (rows, columns); with ``squeeze=False`` always such an
    array).
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(WIDTH, height), dpi=200, layout="constrained")
    figure.suptitle(title, fontsize="medium")
    return figure, figure.subplots(rows, columns, **options)


def new_panels(title: str, count: int, height: float, **options: bool) -> tuple[Figure, list[Any]]:
    """Make a figure with several axes of one size, two in a row.

    title: text on top of the figure.
    count: number of axes, >= 1.
    height: height of each row of axes, inches; the figure has 0.8 inches more, for its title.
    options: keyword arguments of ``Figure.subplots``, as ``sharex``.
    Returns (figure; list of its ``count`` axes, row by row).  Of an odd number above 1 the last
    place stays empty.
    """
    columns = min(2, count)
    rows = -(-count // columns)
    figure, grid = new_figure(title, rows, columns, 0.8 + height * rows, squeeze=False, **options)
    for axes in grid.flat[count:]:
        axes.remove()
    return figure, [*grid.flat[:count]]


def plot_measured_range(
    axes: Any, x: NDArray, y: NDArray, band: tuple[float, float] | None, **line: Any
) -> list[Any]:
    """Plot a curve, solid where |x| lies in a measured band and dashed outside.

    axes: axes of matplotlib, drawn into.
    x, y: points of the curve, (n,).
    band: lowest and highest measured |x|, which belong to it; None: the curve has the style
    ``line`` everywhere.
    line: keyword arguments of ``Axes.plot``, the style of the line, of which with a band linestyle
    has no effect.
    Returns the lines of matplotlib: one without a band; else the solid and the dashed one, of which
    only the first has the label, and either may be without points.
    """
    if band is None:
        return list(axes.plot(x, y, **line))
    outside = (np.abs(x) < band[0]) | (np.abs(x) > band[1])
    solid = np.where(outside, np.nan, y)
    # The dashed curve begins at the last measured point.
    outside[1:], outside[:-1] = outside[1:] | outside[:-1], outside[:-1] | outside[1:]
    drawn = axes.plot(x, solid, **line | {"linestyle": "-"})
    return [
        *drawn,
        *axes.plot(x, np.where(outside, y, np.nan), **line | {"linestyle": "--", "label": None}),
    ]


def has_numbers(x: NDArray[Any]) -> bool:
    """Whether an array has real numbers, not texts, dates or other objects."""
    return x.dtype.kind in "iuf"


def spaced_by_factors(x: NDArray[Any]) -> bool:
    """Whether the numbers ``x``, any order, are spaced more evenly on a logarithmic axis than on a
    linear one.

    The spacing of the different numbers is compared by its relative standard deviation, linear and
    logarithmic.  The result is False for fewer than three different numbers, where one is not
    finite or not > 0, and where both spacings are as even.
    """
    points = np.unique(x) if has_numbers(x) else x[:0]
    if points.size < 3 or points[0] <= 0.0:
        return False
    linear = np.diff(points)
    logarithmic = np.diff(np.log(points))
    return bool(logarithmic.std() / logarithmic.mean() < linear.std() / linear.mean())


def log_ticks(axis: Any) -> None:
    """Set labels of a logarithmic axis that do not overlap.

    If its range is less than two decades, ticks at 1, 2 and 5 times powers of ten are labelled by
    digits, else matplotlib's powers of ten stay.  Minor ticks have no labels.

    axis: x or y axis of matplotlib, whose range is set already; changed.
    """
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    low, high = axis.get_view_interval()
    if high < 100.0 * low:
        axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(NullFormatter())


def zero_line(axes: Any) -> None:
    """Draw a thin line at 0 into ``axes``."""
    axes.axhline(0.0, **THIN)


def small_legend(axes: Any, **options: Any) -> None:
    """Add a legend without a frame to ``axes``; ``options`` as in ``Axes.legend``."""
    axes.legend(frameon=False, fontsize="small", **options)


def quantile_bands(axes: Any, t: NDArray, levels: NDArray, values: NDArray) -> None:
    """Plot quantiles over time: pairs of levels as bands, the middle one of an odd number as a
    line, with a legend.

    A line at 0 is drawn too, and the axis is extended upwards to make room for the legend, which is
    left out without levels.

    axes: axes of matplotlib, drawn into.
    t: times, (n,), ascending, in the unit of the axis.
    levels: probabilities, 0 to 1, ascending, (k,), k >= 0.
    values: quantiles, (k, n), a row for each level; where they are NaN nothing is drawn.
    """
    for n in range(levels.size // 2):
        text = f"{100 * levels[n]:g} % to {100 * levels[-1 - n]:g} %"
        grey = _GREYS[min(n, len(_GREYS) - 1)]
        axes.fill_between(t, values[n], values[-1 - n], color=grey, linewidth=0.0, label=text)
    if levels.size % 2:
        n = levels.size // 2
        axes.plot(t, values[n], ".-", color="black", label=f"{100 * levels[n]:g} %")
    zero_line(axes)
    if levels.size:
        low, high = axes.get_ylim()
        axes.set_ylim(low, high + _ABOVE_BANDS * (high - low))
        small_legend(axes, loc="upper right")


def axis_label(name: str, units: str = "1", symbol: str = "") -> str:
    """Return the label of an axis: symbol or name of a quantity, and its unit.

    name: name of the quantity, as "V".
    units: unit as "m s-1"; "1" of a dimensionless one, which is left out.
    symbol: LaTeX without $, where the table of symbols has none; "": the name is written, with
    blanks for "_".
    Returns a text as "$V$, m s$^{-1}$".  A symbol that is a ratio, as p/E', is cut at "/" if there
    is a unit.
    """
    symbol = SYMBOLS[name].latex if name in SYMBOLS else symbol
    # A symbol such as p/E' stands for a ratio; in SI units the quantity is p.
    symbol = symbol.partition("/")[0] if units != "1" else symbol
    return with_unit(f"${symbol}$" if symbol else name.replace("_", " "), units, ", ")


def variable_label(variable: Any) -> str:
    """Return the label of an axis for a ``variable`` of a dataset: its long name up to a comma,
    symbol and unit.
    """
    label = symbol_label(variable)
    name = str(variable.name).replace("_", " ")
    words = fill(str(variable.attrs.get("long_name", "")).partition(",")[0], _LABEL_WIDTH)
    return (
        label.replace(name, words, 1)
        if words and label.startswith(name)
        else f"{words}\n{label}".lstrip()
    )


def symbol_label(variable: Any) -> str:
    """Return the symbol and the unit of a ``variable`` of a dataset, as :func:`axis_label` writes
    them.
    """
    return axis_label(
        str(variable.name), variable.attrs.get("units", "1"), variable.attrs.get("symbol", "")
    )


def with_unit(text: str, units: str, separator: str = " ") -> str:
    """Return ``text``, a ``separator`` and ``units`` as "m s-1" with exponents; the text alone for
    the units "1".
    """
    return text if units == "1" else text + separator + re.sub(r"(-\d)", r"$^{\1}$", units)


def save(figure: Figure, path: str | PathLike[str]) -> None:
    """Write a figure, whole or not at all.

    Parameters
    ----------
    figure : figure of matplotlib.
    path : path of the file, whose suffix, in small or capital letters, chooses the format; it is
    replaced if it exists.

    Raises
    ------
    FileError
        If it is no path or cannot be written there, or the suffix names no format of matplotlib or
        is missing.
    """
    formats = sorted(figure.canvas.get_supported_filetypes())
    suffix = as_path(path).suffix
    if suffix.removeprefix(".").lower() not in formats:
        raise FileError(
            path, f"suffix {suffix!r} names no format: must be one of .{', .'.join(formats)}"
        )
    with replace_file(path) as temporary:
        figure.savefig(temporary)


# --- Figures of results ---


def draw(data: xr.Dataset) -> Figure:
    """Draw a result, by the figure that its axes and variables call for.

    Parameters
    ----------
    data : dataset of the result, as in its ``to_xarray()``: a summary of an ensemble or of a run
        (axis "quantile"), Sobol indices ("input"), a motion ("t" and a variable "regime"),
        equilibria ("equilibrium"), stresses ("p", "tau" and "x"), else contact states or a table
        over at least one axis of several values.  A kind is recognised by the axes and names in
        brackets; the other variables of the kind must be there too.

    Returns
    -------
    matplotlib.figure.Figure
        The figure, not shown and not saved; the first of these kinds, in this order, that applies.

    Raises
    ------
    ParameterError
        If the dataset is none of these, or has a single state.
    KeyError
        If a variable or attribute that the figure needs is missing.
    ValueError
        If there is an axis "input", but no Sobol indices.
    """
    from . import result_figures, state_figures

    names = {*data.dims, *data, *data.coords}
    kinds = (
        ("quantile" in names, result_figures.distributions),
        ("input" in data.dims, result_figures.sobol_bars),
        ({"t", "regime"} <= names, state_figures.motion),
        ("equilibrium" in data.dims, state_figures.equilibria),
        ({"p", "x"} <= names, state_figures.stresses),
        (bool(state_figures.varied_axes(data)), state_figures.field_curves),
    )
    for applies, figure in kinds:
        if applies:
            return figure(data)
    found = ", ".join(f"{name}: {size}" for name, size in data.sizes.items()) or "a single state"
    sentence = (
        f"a plot needs several speeds or creepages: the result contains {found}; compute it at more"
    )
    raise ParameterError("plot", found, "a result over an axis", sentence)
