"""What every result can do: say itself in few lines, as HTML, as xarray and pandas, and draw itself."""

from __future__ import annotations

import html
from collections.abc import Iterable, Mapping
from dataclasses import fields
from os import PathLike
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .labels import Labels
from .symbols import attributes

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr
    from matplotlib.figure import Figure

#: rows of a short table
_MOST_ROWS = 40


class SummaryRow(NamedTuple):
    """A line of a result: a name, what it holds, its unit ("" without)."""

    name: str
    value: str
    unit: str = ""


class Result:
    """A result that shows itself; a subclass says its :meth:`_summary`, and gives :meth:`to_xarray`."""

    def _summary(self) -> tuple[str, list[SummaryRow]]:
        """A title and a line for each thing worth a look."""
        raise NotImplementedError

    def to_xarray(self) -> xr.Dataset:
        """All of it as a dataset, with names and units."""
        raise NotImplementedError

    def to_pandas(self) -> pd.DataFrame:
        """The dataset of :meth:`to_xarray` as a table of pandas, a row for each time or state.

        What has a unit bears it in its name, as "V [m s-1]": pandas writes names alone into files.  What lies over
        other axes, as the corners of a drive, is left out.
        """
        data = self.to_xarray()
        over = max((each.dims for each in data.values()), key=len)
        data = data[[name for name, each in data.items() if set(each.dims) <= set(over)]]
        data = data if over else data.expand_dims("state")
        names = {name: column_name(str(name), unit_of(data[name].attrs)) for name in data.variables}
        return data.to_dataframe().rename(columns=names).rename_axis(index=names)

    def plot(self: Any, path: str | PathLike[str] | None = None) -> Figure:
        """Draw it; a figure of matplotlib.

        Parameters
        ----------
        path : a file to save it in, of a suffix that matplotlib knows; default: none is written.

        Raises
        ------
        ParameterError
            Where there is nothing to draw over, as of a single state.
        FileError
            If the file cannot be written, or its suffix names no format.
        """
        from .plots.style import save

        figure = self._figure()
        if path is not None:
            save(figure, path)
        return figure

    def _figure(self) -> Figure:
        """Its figure, of most that of their dataset."""
        from .plots import draw

        return draw(self.to_xarray())

    def keys(self) -> Iterable[str]:
        """Names of what it holds."""
        return [field.name for field in fields(self) if not field.name.startswith("_")]  # type: ignore[arg-type]

    def __getitem__(self, name: str) -> Any:
        if name not in self.keys():
            raise KeyError(name)
        return getattr(self, name)

    def __repr__(self) -> str:
        return as_text(*self._summary())

    def _repr_html_(self) -> str:
        return as_html(*self._summary())


def as_text(title: str, rows: list[SummaryRow]) -> str:
    """A card for a terminal."""
    width = max((len(row.name) for row in rows), default=0)
    return "\n".join([title, *(f"  {row.name:<{width}}  {row.value} {row.unit}".rstrip() for row in rows)])


def as_html(title: str, rows: list[SummaryRow]) -> str:
    """A card for a notebook."""
    cells = "".join(
        "<tr>" + "".join(f'<td style="text-align:left">{html.escape(text)}</td>' for text in row) + "</tr>"
        for row in rows[:_MOST_ROWS]
    )
    return f"<div><strong>{html.escape(title)}</strong><table>{cells}</table></div>"


def unit_of(described: Mapping[Any, Any]) -> str:
    """The unit among the attributes of a quantity, "" of a number."""
    unit = str(described.get("units", "1"))
    return "" if unit == "1" else unit


def column_name(name: str, unit: str) -> str:
    """The name of a column: what stands in it, and its unit if it has one."""
    return f"{name} [{unit}]" if unit else name


def format_value(value: Any) -> str:
    """A number, or what an array holds, in few words."""
    if not isinstance(value, np.ndarray):
        return f"{value:.12g}" if isinstance(value, float) else str(value)
    if value.ndim == 0 or 0 < value.size <= 4:
        return np.array2string(value, precision=6, separator=", ")
    finite = value[np.isfinite(value)] if value.dtype.kind == "f" else value
    if not finite.size:
        return f"{value.shape}, none finite" if value.size else f"{value.shape}"
    text = f"{value.shape}, {finite.min():.6g} to {finite.max():.6g}"
    return text + (f", {value.size - finite.size} not finite" if finite.size < value.size else "")


class Values(Result):
    """Named results of one call; a name that was not asked for is an AttributeError.

    given : the arguments over which they were computed, by name.
    units : unit of each that has one; si : whether all that have a dimension are in SI units; title : what they are;
    labels : those of the arguments; about : attributes of the dataset.  What could not be computed was refused:
    ``success`` is True, as of motions and equilibria that were found.
    """

    success, status, message = True, 0, "all of it was computed"

    def __init__(
        self,
        values: dict[str, Any],
        given: dict[str, Any] | None = None,
        units: dict[str, str] | None = None,
        title: str = "Contact",
        *,
        si: bool = False,
        labels: Labels | None = None,
        about: dict[str, Any] | None = None,
    ) -> None:
        self._about = about or {}
        self._values = values if labels is None else {name: labels.of(name, value) for name, value in values.items()}
        self._given, self._units, self._labels = given or {}, units or {}, labels
        self._title, self._si = title + ", in SI units" * si, si

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        try:
            return self._values[name]
        except KeyError:
            held = ", ".join(self._values)
            raise AttributeError(f"{name!r} was not computed; this result holds {held}") from None

    def __dir__(self) -> Iterable[str]:
        return [*self._values, "as_dict", "plot", "to_pandas", "to_xarray"]

    def as_dict(self) -> dict[str, Any]:
        """The results by name."""
        return dict(self._values)

    def keys(self) -> Iterable[str]:
        return self._values.keys()

    def _summary(self) -> tuple[str, list[SummaryRow]]:
        shape = np.broadcast_shapes(*map(np.shape, self._values.values()))
        title = self._title + (f", {shape}" if shape else "")
        return title, [
            SummaryRow(name, format_value(value), unit_of(self._attributes(name)))
            for name, value in self._values.items()
        ]

    def to_xarray(self) -> xr.Dataset:
        """Dataset over the arguments that vary, with names and units.

        An axis along which one argument alone varies has its name and its values; others are called ``state``.
        Arguments with labels of xarray or pandas give theirs.
        """
        import xarray as xr

        plain = {name: np.asarray(value) for name, value in self._values.items()}
        given = {name: np.asarray(value) for name, value in self._given.items()}
        shape = np.broadcast_shapes(*(array.shape for array in (*plain.values(), *given.values())))
        labels = self._labels if self._labels and self._labels.shape == shape else None
        dims, coordinates = (labels.dims, labels.coords) if labels else _axes(given, shape)
        data = {}
        for name, array in (given | plain).items():
            if name in coordinates:
                continue
            whole = np.broadcast_to(array, shape) if array.ndim else array
            kept = whole.astype(np.int8) if whole.dtype == bool else whole
            data[name] = xr.Variable(dims if array.ndim else (), kept, self._attributes(name))
        if not labels:
            coordinates = {name: ((name,), values, self._attributes(name)) for name, values in coordinates.items()}
        return xr.Dataset(data, coordinates, attrs={"title": self._title} | self._about)

    def _attributes(self, name: str) -> dict[str, Any]:
        found: dict[str, Any] = dict(attributes(name, self._si))
        return found | {"units": self._units[name]} if name in self._units else found


def _axes(given: dict[str, NDArray], shape: tuple[int, ...]) -> tuple[tuple[str, ...], dict[str, Any]]:
    """Names of the axes, and the coordinates of those that one argument alone varies along."""
    dims, coordinates = [], {}
    for axis in range(len(shape)):
        along = [name for name, array in given.items() if _varies(array, axis - len(shape))]
        if len(along) == 1 and given[along[0]].size == shape[axis]:
            dims.append(along[0])
            coordinates[along[0]] = given[along[0]].ravel()
        else:
            dims.append("state" if len(shape) == 1 else f"state_{axis}")
    return tuple(dims), coordinates


def _varies(array: NDArray, axis: int) -> bool:
    return -axis <= array.ndim and array.shape[axis] > 1
