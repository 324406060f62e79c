"""Figures of results: :func:`draw` of any dataset of a result or a file.

Common parts of all figures: size, line styles that differ in grey, titles, labels; and the figures
of contact states, stresses, equilibria, tables and motions.  Other figures are in
:mod:`.result_figures`.
"""

import re
import textwrap
from typing import Any

import numpy as np

from ..arrays import NDArray
from ..errors import FileError, ParameterError
from ..files import DataArray, Dataset, Figure, FilePath, as_path, replace_file
from ..quantities import MEASURED, SYMBOLS

# --- Common parts of all figures ---

#: Styles of curves.  The colours differ in lightness too, from black to light, so that prints in
#: grey are readable.
LINES: tuple[dict[str, Any], ...] = (
    {"color": "black", "linestyle": "-"},
    {"color": "#1f5fa8", "linestyle": "--"},
    {"color": "#c8642a", "linestyle": "-."},
    {"color": "#6aa84f", "linestyle": (0, (1, 1.2))},
)
#: Greys of quantile bands, from the widest.
_GREYS = ("0.85", "0.65", "0.45")
#: Width of every figure, inches.  On a screen 390 pixels wide the smallest text, of 8.3 points, is
#: then 7 pixels high.
WIDTH = 6.4

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


def new_panels(title: str, count: int, height: float, **options: bool) -> tuple[Figure, list]:
    """Make a figure with several axes of one size, two in a row.

    title: text on top of the figure.
    count: number of axes, >= 1.
    height: height of each row of axes, inches; the figure has 0.8 inches more, for its title.
    options: keyword arguments of ``Figure.subplots``, as ``sharex``.
    Returns (figure; list of its ``count`` axes, row by row).  Of an odd number above 1 the last
    position stays empty.
    """
    columns = min(2, count)
    rows = -(-count // columns)  # rounded up
    figure, grid = new_figure(title, rows, columns, 0.8 + height * rows, squeeze=False, **options)
    for axes in grid.flat[count:]:
        axes.remove()
    return figure, [*grid.flat[:count]]


def plot_measured_range(
    axes: Any, x: NDArray, y: NDArray, band: tuple[float, float] | None, **line: Any
) -> Any:
    """Plot a curve, solid where |x| lies in a measured band and dashed outside.

    axes: axes of matplotlib, drawn into.
    x, y: points of the curve, (n,).
    band: lowest and highest measured |x|, which belong to it; None: the curve has the style
    ``line`` everywhere.
    line: keyword arguments of ``Axes.plot``, the style of the line, of which with a band linestyle
    has no effect.
    Returns the line of matplotlib that has the label, with a band the solid one; it, and the dashed
    one, may be without points.
    """
    if band is None:
        return axes.plot(x, y, **line)[0]
    outside = (np.abs(x) < band[0]) | (np.abs(x) > band[1])
    # The dashed curve begins at the last measured point: neighbours of points outside belong to it.
    dashed = outside.copy()
    dashed[1:] |= outside[:-1]
    dashed[:-1] |= outside[1:]
    (drawn,) = axes.plot(x, np.where(outside, np.nan, y), **line | {"linestyle": "-"})
    axes.plot(x, np.where(dashed, y, np.nan), **line | {"linestyle": "--", "label": None})
    return drawn


def has_numbers(x: NDArray) -> bool:
    """Whether an array has real numbers, not texts, dates or other objects."""
    return x.dtype.kind in "iuf"


def spaced_by_factors(x: NDArray) -> bool:
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
    middle = levels.size // 2
    for n in range(middle):
        text = f"{100 * levels[n]:g} % to {100 * levels[-1 - n]:g} %"
        grey = _GREYS[min(n, len(_GREYS) - 1)]
        axes.fill_between(t, values[n], values[-1 - n], color=grey, linewidth=0.0, label=text)
    if levels.size % 2:
        axes.plot(t, values[middle], ".-", color="black", label=f"{100 * levels[middle]:g} %")
    zero_line(axes)
    if levels.size:
        low, high = axes.get_ylim()
        # the three lines of the legend are as high as half of the bands
        axes.set_ylim(low, high + 0.5 * (high - low))
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
    # 26 characters in a line, since two panels stand beside each other
    words = textwrap.fill(str(variable.attrs.get("long_name", "")).partition(",")[0], 26)
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


def save(figure: Figure, path: FilePath) -> None:
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
            path, f"suffix {suffix!r} is no figure format: must be one of .{', .'.join(formats)}"
        )
    with replace_file(path) as temporary:
        figure.savefig(temporary)


# --- Figures of states and motions ---

#: Fields that a figure shows if the dataset has them, in this order.
_FIELDS = (
    "load",
    "temperature",
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

#: Codes of the regimes in which the contact slides: full slip, and a wheel that is locked (at rest
#: it is held).
_SLIDING = (0, 3)
#: Fastest speed of an axis in m/s: no roller is faster, though equilibria are, where shear waves
#: forbid them.
_FASTEST = 100.0


def varied_axes(data: Dataset) -> list[str]:
    """Return the names of the axes of several values that the shown fields of ``data`` depend on,
    in its order.
    """
    shown = data[_shown_fields(data)]
    return [str(dim) for dim, size in data.sizes.items() if size > 1 and dim in shown.dims]


def field_curves(data: Dataset) -> Figure:
    """Draw fields of a dataset against its first axis of several values, with curves for at most
    four of the second.

    data: fields of the contact over axes such as V and delta, with their coordinates and the
        attribute title.  At least one axis has several values (else ValueError).  Of the second
        such axis there are curves at its first, its last and two evenly spaced indices between.
        Third and further axes are at their middle, which the title states.  Over V curves are
        dashed outside the measured band, if the attribute :data:`.scale.MEASURED` states it.
    Returns the :class:`matplotlib.figure.Figure`, with the first six of those fields that depend on
    the first axis.  Its axis is logarithmic if the values are spaced by factors.
    """
    data = _in_millimetres(data.squeeze(drop=True), "length")
    first, *others = varied_axes(data)
    title = str(data.attrs.get("title", "Contact"))
    band = data.attrs.get(MEASURED) if first == "V" else None
    if band is not None:
        title += "; dashed: outside the measured frequencies"
    for n, name in enumerate(others[1:]):
        middle = data.sizes[name] // 2
        title += f"{', ' if n else ', at '}{_value_label(data, name, middle)}"
        data = data.isel({name: middle})
    names = [name for name in _shown_fields(data) if first in data[name].dims][:6]
    figure, panels = new_panels(title, len(names), 2.2, sharex=True)
    x = data[first].values
    second = others[:1]
    x = x.astype(str) if x.dtype.kind in "Om" else x  # matplotlib places texts evenly
    # of fewer than four values some are equal, which np.unique below removes
    indices = np.linspace(0, data.sizes[second[0]] - 1, len(LINES)).astype(int) if second else [0]
    for name, axes in zip(names, panels):
        for index, line in zip(np.unique(indices).tolist(), LINES):
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


def stresses(data: Dataset) -> Figure:
    """Draw pressure and, where it is known, shear stress along the contact.

    data: dataset with ``x``, position along the contact, ``p``, pressure, and, but for a cover,
        ``tau``, shear stress, with the attribute units; of several states, along other axes than
        the first that x varies along, the first is drawn.
    Returns the :class:`matplotlib.figure.Figure`, with the curves in one panel.
    """
    data = _in_millimetres(data, "x")
    names = [name for name in ("p", "tau") if name in data]
    figure, axes = new_figure(f"Pressure{' and shear stress' * ('tau' in names)} along the contact")
    x = data["x"]
    # first axis along which x varies; of the other axes the first state is drawn
    along = next((dim for n, dim in enumerate(x.dims) if np.diff(x.values, axis=n).any()), None)
    data = data.isel(dict.fromkeys(set(data.dims) - {along}, 0))
    for name, line in zip(names, LINES):
        axes.plot(data["x"].values, data[name].values, label=symbol_label(data[name]), **line)
    zero_line(axes)
    axes.set_xlabel(variable_label(x))
    axes.set_ylabel("\n".join(variable_label(data[name]) for name in names))
    axes.legend(frameon=False)
    return figure


def equilibria(data: Dataset) -> Figure:
    """Draw the speeds of all equilibria over the load, stable (filled) or not (open); of equilibria
    of heat the temperatures over the speed.

    data: dataset of steady rolling, as in ``Steady.to_xarray``: V, stable (1 or 0) and the loads;
        or of heat, as in ``Temperatures.to_xarray``: temperature, V and stable.
        The load on the axis is the first of slope, force and torque that varies, else the force,
        which must be there then (KeyError).  Entries whose V is NaN, where there are fewer
        equilibria, are left out.
    Returns the :class:`matplotlib.figure.Figure`.  If the magnitudes of the speeds, rest apart,
    differ by a factor of more than 100, their axis is logarithmic on both sides of a linear part
    between plus and minus the least magnitude.
    """
    load, shown = "force", "V"
    for name in ("torque", "force", "slope"):  # the last one that varies is shown
        if name in data and np.ptp(_finite(data[name])) > 0.0:
            load = name
    if "temperature" in data:
        load, shown = "V", "temperature"
    figure, axes = new_figure("Steady rolling: stable (filled) and unstable (open)")
    x, y, stable = (
        data[name].broadcast_like(data["V"]).values.ravel() for name in (load, shown, "stable")
    )
    style = {"color": LINES[1]["color"], "markersize": 4}
    for chosen, face, text in (
        (stable != 0, style["color"], "stable"),
        (stable == 0, "white", "unstable"),
    ):
        drawn = chosen & np.isfinite(y)
        axes.plot(x[drawn], y[drawn], "o", markerfacecolor=face, label=text, **style)
    axes.set(xlabel=variable_label(data[load]), ylabel=variable_label(data[shown]))
    # temperatures have an axis that is linear and has no limit
    speeds = np.abs(_finite(data["V"])) if shown == "V" else np.empty(0)
    speeds = speeds[speeds > 0.0]
    # the initial values make it false where all speeds are 0
    if speeds.max(initial=0.0) > 100.0 * speeds.min(initial=np.inf):
        axes.set_yscale("symlog", linthresh=speeds.min())  # it shows rest, V = 0, too
    if data["V"].attrs.get("units", "1") != "1" and speeds.max(initial=0.0) > _FASTEST:
        axes.set_ylim(*np.clip(axes.get_ylim(), -_FASTEST, _FASTEST))
    axes.legend(frameon=False)
    return figure


def motion(data: Dataset) -> Figure:
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
    # zeros at both ends close each interval: (first time that slides, first one after it), indices
    slips = np.concatenate(([0], data["regime"].isin(_SLIDING).values, [0]))
    ends = np.flatnonzero(np.diff(slips)).reshape(-1, 2)
    for axes, names in zip(grid.flat, rows):
        for name, line in zip(names, LINES):
            axes.plot(*_add_corners(data, name), label=symbol_label(data[name]), **line)
        for start, stop in ends.tolist():
            axes.axvspan(t[start], t[min(stop, t.size - 1)], color="0.87", linewidth=0.0, zorder=0)
        zero_line(axes)
        axes.set_ylabel("\n".join(variable_label(data[name]) for name in names))
        if len(names) > 1:
            small_legend(axes)
    # of a single time an axis of length 1, as matplotlib warns of one without length
    grid[-1, 0].set(
        xlabel=variable_label(data["t"]), xlim=(t[0], t[-1] if t[-1] > t[0] else t[0] + 1.0)
    )
    return figure


def _in_millimetres(data: Dataset, name: str) -> Dataset:
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


def _add_corners(data: Dataset, name: str) -> tuple[NDArray, NDArray]:
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
    # an output nearer to a jump than that has the value of one of its sides
    kept = (np.abs(t[:, None] - jumps) > 1e-9 * t[-1]).all(axis=1)
    within = (corners >= t[0]) & (corners <= t[-1])
    if not kept.any():
        return t, values
    other_loads = values[kept] - np.interp(t[kept], corners, given)
    times = np.concatenate([t[kept], corners[within]])
    found = np.concatenate(
        [values[kept], np.interp(corners[within], t[kept], other_loads) + given[within]]
    )
    order = np.argsort(times, kind="stable")  # both sides of a jump stay in their order
    return times[order], found[order]


def _shown_fields(data: Dataset) -> list[str]:
    """Return the fields of ``data`` that vary, else all of them; of like bodies without the parts
    of M, of limits by heat with the speed.
    """
    if {*_PARTS} <= {*data} and data["M_cylinder"].equals(data["M_half_space"]):
        data = data.drop_vars(_PARTS)
    fields = [*_FIELDS] + ["V"] * ("runaway" in data)
    names = [name for name in fields if name in data.data_vars and data[name].ndim]
    return [name for name in names if np.ptp(_finite(data[name])) > 0.0] or names


def _finite(values: DataArray) -> NDArray:
    """Return the finite ``values``, 0 if there is none."""
    found = values.values[np.isfinite(values.values)]
    return found if found.size else np.zeros(1)


def _value_label(data: Dataset, name: str, index: int) -> str:
    """Return a value of the axis ``name`` of ``data``, at an ``index``, in words."""
    values = data[name].values
    return f"{symbol_label(data[name])} = {values[index]:{'.4g' if has_numbers(values) else ''}}"


# --- Figures of results ---


def draw(data: Dataset) -> Figure:
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
    from . import result_figures

    names = {*data.dims, *data.variables}
    # quantile, input and equilibrium must be dimensions: where one value of them was selected they
    # are coordinates without an axis, and the dataset has nothing to draw over them
    kinds = (
        ("quantile" in data.dims, result_figures.distributions),
        ("input" in data.dims, result_figures.sobol_bars),
        ({"t", "regime"} <= names, motion),
        ("equilibrium" in data.dims, equilibria),
        ({"p", "x"} <= names and data["x"].size, stresses),
        (bool(varied_axes(data)), field_curves),
    )
    for applies, figure in kinds:
        if applies:
            return figure(data)
    found = ", ".join(f"{size} {name}" for name, size in data.sizes.items()) or "a single state"
    raise ParameterError(
        "plot",
        found,
        "a result over an axis",
        "a plot needs several speeds or creepages, and a field such as Q or M; this result has "
        f"only {found}",
    )
