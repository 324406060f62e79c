"""Base classes of results: summaries as text and HTML, datasets of xarray, tables of pandas,
figures.
"""

import dataclasses
import html
from collections.abc import Iterable, Mapping
from typing import Any, NamedTuple

import numpy as np

from .arrays import Named, Names, NDArray, Shape
from .drives_and_labels import Labels, dataset_axes, state_axes
from .files import DataFrame, Dataset, Figure, FilePath
from .quantities import attributes

#: Source of the model, an attribute of datasets.
PAPER = (
    "A. A. Zobova and I. G. Goryacheva, Dynamics of a viscoelastic cylinder on a viscoelastic "
    "half-space, Acta Mechanica (2020), doi:10.1007/s00707-020-02643-5"
)


class SummaryRow(NamedTuple):
    """A line of a summary.

    name : name of the quantity.
    value : its value as text.
    unit : its unit as "m s-1"; "" of a dimensionless quantity.
    """

    name: str
    value: str
    unit: str = ""


class Result:
    """Base class of results.  A subclass implements :meth:`_summary` and :meth:`to_xarray`."""

    def _summary(self) -> tuple[str, list[SummaryRow]]:
        """Return (title; rows, a list of :class:`SummaryRow`) of the summary; subclasses implement
        it.
        """
        raise NotImplementedError

    def to_xarray(self) -> Dataset:
        """Return all fields as a dataset, with long names and units; subclasses implement it."""
        raise NotImplementedError

    def to_pandas(self) -> DataFrame:
        """Return the dataset of :meth:`to_xarray` as a pandas.DataFrame, a row for each time or
        state.

        A column of a quantity with a unit is named as "V [m s-1]", because pandas writes no
        attributes into files.

        Returns
        -------
        pandas.DataFrame
            The index has the axes of the variable that has most axes, the first one of several with
            as many; a result of a single state has one row, with index 0 named "state".  Variables
            over fewer of these axes are repeated along the others; variables over other axes, as
            the corners of a drive, are left out.

        Raises
        ------
        ValueError
            A dataset without variables.

        Examples
        --------
        >>> import viscoroll as vr
        >>> table = vr.contact(
        ...     vr.presets.RUBBER_CYLINDER, [0.5, 1.0], delta=0.0, fields="M"
        ... ).to_pandas()
        >>> table.index.name, list(table.columns)
        ('V [m s-1]', ['delta', 'M [N m m-1]'])
        """
        data = self.to_xarray()
        # max takes the first of several
        dims = max((variable.dims for variable in data.values()), key=len)
        data = data[[name for name, variable in data.items() if set(variable.dims) <= set(dims)]]
        # a frame needs an index, which a dataset without axes does not give
        data = data if dims else data.expand_dims("state")
        names = {name: column_name(str(name), unit_of(data[name].attrs)) for name in data.variables}
        return data.to_dataframe().rename(columns=names).rename_axis(index=names)

    def plot(self: Any, path: FilePath | None = None) -> Figure:
        """Draw the result, and save the figure if a path is given.

        Parameters
        ----------
        path : file to save it in, with a suffix that matplotlib knows; default: none.

        Returns
        -------
        matplotlib.figure.Figure
            The figure, which is not shown.

        Raises
        ------
        ParameterError
            If the result has no axis, as that of a single state.
        FileError
            If the file cannot be written, or its suffix names no format.

        Examples
        --------
        >>> import viscoroll as vr
        >>> figure = vr.contact(
        ...     vr.presets.RUBBER_CYLINDER, [0.5, 1.0, 2.0], delta=0.0, fields="M"
        ... ).plot("M.png")
        >>> len(figure.axes)
        1
        """
        from .plots import save

        figure = self._figure()
        if path is not None:
            save(figure, path)
        return figure

    def _figure(self) -> Figure:
        """Return the figure of the dataset, as in :func:`.plots.draw`."""
        from .plots import draw

        return draw(self.to_xarray())

    def keys(self) -> Iterable[str]:
        """Return the names of the fields, which are attributes and are read by ``result[name]``
        too.

        Returns
        -------
        list of str
            The names, in the order of the class.

        Raises
        ------
        TypeError
            Of an ``Identification`` and of the results of a run: they have
            attributes alone.

        Examples
        --------
        >>> import viscoroll as vr
        >>> motion = vr.roll(vr.presets.RUBBER_CYLINDER, 1.0, 10.0, 2.0)
        >>> "onset_time" in motion.keys()
        True
        """
        return [field.name for field in dataclasses.fields(self) if not field.name.startswith("_")]  # type: ignore[arg-type]

    def __getitem__(self, name: str) -> Any:
        if name not in self:
            raise KeyError(f"{name!r} is not in this result: it contains {', '.join(self.keys())}")
        return getattr(self, name)

    def __contains__(self, name: object) -> bool:
        """Whether ``name`` is one of :meth:`keys`."""
        return name in tuple(self.keys())

    def __repr__(self) -> str:
        return as_text(*self._summary())

    def _repr_html_(self) -> str:
        return as_html(*self._summary())


def as_text(title: str, rows: list[SummaryRow]) -> str:
    """Return a summary for a terminal: the title, then a line for each row, its name, value and
    unit.

    title: first line.
    rows: :class:`SummaryRow` each, perhaps none; values begin in one column.
    Returns the lines, joined by line feeds, without blanks at their ends.
    """
    width = max((len(row.name) for row in rows), default=0)
    return "\n".join(
        [title, *(f"  {row.name:<{width}}  {row.value} {row.unit}".rstrip() for row in rows)]
    )


def as_html(title: str, rows: list[SummaryRow]) -> str:
    """Return a summary as HTML for a notebook: the title, and a table of the name, value and unit
    of each row.

    title: text above the table.
    rows: :class:`SummaryRow` each, of which the first 40 are shown.
    Returns one element div, in which the characters of the texts that HTML reserves are escaped.
    """
    cells = "".join(
        "<tr>"
        + "".join(f'<td style="text-align:left">{html.escape(text)}</td>' for text in row)
        + "</tr>"
        for row in rows[:40]  # more do not fit a screen
    )
    return f"<div><strong>{html.escape(title)}</strong><table>{cells}</table></div>"


def unit_of(attributes: Mapping) -> str:
    """Return the unit in the ``attributes`` of a variable, "" of a dimensionless one."""
    unit = str(attributes.get("units", "1"))
    return "" if unit == "1" else unit


def column_name(name: str, unit: str) -> str:
    """Return the title of a column: the ``name`` of a quantity, and its ``unit`` unless that is
    "".
    """
    return f"{name} [{unit}]" if unit else name


def format_value(value: Any) -> str:
    """Return a number or a short array as text; of a long array its shape and range.

    value: a number, a text, or an array of numbers of any shape.
    Returns a text: of a float 12 significant digits; of an array of one to four elements, or
    without axes, its elements with at most six digits after the point; of a larger array its shape
    and the smallest and largest finite element, as "(100,), 0 to 2.5, 3 not finite" or "(100,),
    none finite"; of an empty one its shape; of anything else its ``str``.
    """
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
    """Named results of one call, as attributes and by ``[name]``; other names raise AttributeError.

    Parameters
    ----------
    values : name -> result.
    given : name -> argument, broadcast with the results.
    own : name -> attributes in the dataset, in place of those of the quantity of that name.
    title : title of summary, dataset and figure.
    si : whether quantities with a dimension are in SI units.
    labels : labels of the arguments.
    about : further attributes of the dataset.
    further : names of the axes after those of the labels.

    Attributes
    ----------
    success, status, message : True, 0 and a sentence, as motions and equilibria have them: a call
        that cannot compute its results raises an exception.

    Examples
    --------
    >>> import viscoroll as vr
    >>> state = vr.contact(
    ...     vr.presets.RUBBER_CYLINDER, [0.5, 1.0], delta=0.01, fields=("Q", "M")
    ... )
    >>> state.Q.shape, list(state.keys())
    ((2,), ['Q', 'M'])
    >>> list(state.to_pandas().columns)
    ['delta', 'Q [N m-1]', 'M [N m m-1]']
    """

    success = True
    status = 0
    message = "all fields were computed"

    def __init__(
        self,
        values: Named,
        given: Named | None = None,
        own: dict[str, Named] | None = None,
        title: str = "Contact",
        *,
        si: bool = False,
        labels: Labels | None = None,
        about: Named | None = None,
        further: Names = (),
    ) -> None:
        """Keep the fields of a result, with the arguments that tables and figures need as axes.

        values: name -> number or array of the field.
        given: name -> argument by which the call varied, a number or an array that broadcasts with
            the fields, which becomes a coordinate.  None: there is none.
        own: name -> attributes, as {"long_name": ...}, in place of those of the quantity of that
            name.  None: all have those of their names.
        title: first line of the summary, title of dataset and figure.
        si: whether values are in SI units, else dimensionless.
        labels: :class:`.drives_and_labels.Labels` of the caller's arrays, put onto the fields of
            their shape, also after axes of the roller; None: fields stay plain arrays.
        about: further attributes of the dataset by name; None: there are none.
        further: names of the axes after those of the labels, each that of an argument along it.
        """
        self._about = about or {}
        if labels is not None:
            values = {name: labels.apply(name, each, *further) for name, each in values.items()}
        self._values = values
        self._given = given or {}
        self._own = own or {}
        self._labels = labels
        self._further = further
        self._title = title + ", in SI units" * si
        self._si = si

    def __getattr__(self, name: str) -> Any:
        """Return the field of a name, which Python asks for where the object has no attribute of
        that name.

        name: name of a field.
        Raises AttributeError for another name; its message lists the fields that were computed,
        unless the name begins with "_".
        """
        if name.startswith("_"):
            raise AttributeError(name)
        if name in self._values:
            return self._values[name]
        names = ", ".join(self._values)
        raise AttributeError(
            f"{name!r} is not in this result: it contains {names}.  Some "
            "functions compute further quantities if asked, as contact by fields=, and stress by "
            "method='coupled'"
        )

    def __dir__(self) -> Iterable[str]:
        return [*self._values, "as_dict", "plot", "to_pandas", "to_xarray"]

    def as_dict(self) -> Named:
        """Return the results by name.

        Returns
        -------
        dict
            Name -> number or array, in the order of the printed summary; a new dict.

        Examples
        --------
        >>> import viscoroll as vr
        >>> list(vr.contact(vr.presets.RUBBER_CYLINDER, 0.5, delta=0.01, fields="M").as_dict())
        ['M']
        """
        return dict(self._values)

    def keys(self) -> Iterable[str]:
        """Return the names of the results, which are attributes and are read by ``result[name]``
        too.

        Returns
        -------
        iterable of str
            The names, in the order of the printed summary.

        Examples
        --------
        >>> import viscoroll as vr
        >>> list(vr.contact(vr.presets.RUBBER_CYLINDER, 0.5, delta=0.01, fields=("Q", "M")).keys())
        ['Q', 'M']
        """
        return self._values.keys()

    def _summary(self) -> tuple[str, list[SummaryRow]]:
        """Return (the title, with the common shape of the results unless it is (); a row for each
        result).
        """
        shape = np.broadcast_shapes(*map(np.shape, self._values.values()))
        title = self._title + (f", {shape}" if shape else "")
        return title, [
            SummaryRow(name, format_value(value), unit_of(self._attributes(name)))
            for name, value in self._values.items()
        ]

    def to_xarray(self) -> Dataset:
        """Return all results and arguments as a dataset with long names and units.

        Returns
        -------
        xarray.Dataset
            An axis along which one argument alone varies has the name and the values of that
            argument; another axis is named ``state``, or of several axes ``state_0``, ``state_1``
            and so on.  Arguments with labels of xarray or pandas determine axes and coordinates;
            one with the name NAME of a field, or of an argument with other values, is called
            given_NAME.  Results and arguments are broadcast to the common shape, numbers are
            variables without axes, truth values become 0 or 1 (int8).  Attributes of a variable are
            long_name and units, of some symbol and equation; those of the dataset are its title and
            those that the call added, as measured_V, the lowest and the highest speed at which the
            material was measured.

        Examples
        --------
        >>> import viscoroll as vr
        >>> data = vr.contact(vr.presets.RUBBER_CYLINDER, [0.5, 1.0], delta=0.01).to_xarray()
        >>> data["Q"].dims
        ('V',)
        """
        import xarray as xr

        given = {name: np.asarray(value) for name, value in self._given.items()}
        arrays = given | {name: np.asarray(value) for name, value in self._values.items()}
        shape = np.broadcast_shapes(*(array.shape for array in arrays.values()))
        own = shape[: len(shape) - len(self._further)]
        coords: Named = {}
        if self._labels and self._labels.axes_in_front(own) >= 0:
            # an argument that is itself the coordinate of its name needs no variable beside it
            alike = {name for name in given if not self._labels.differ(name, given[name])}
            names = (arrays.keys() - alike).union(self._further)
            dims, coords = dataset_axes(self._labels, own, names)
            dims += self._further
            axes = {name: given[name] for name in self._further}
        else:
            dims, axes = _name_axes(given, shape)
        coords |= {name: ((name,), values, self._attributes(name)) for name, values in axes.items()}
        data = {}
        for name, array in arrays.items():
            if name not in coords:
                # netCDF has no truth values
                numbers = array.astype(np.int8) if array.dtype == bool else array
                whole = np.broadcast_to(numbers, shape) if array.ndim else numbers
                data[name] = dims if array.ndim else (), whole, self._attributes(name)
        return xr.Dataset(data, coords, attrs={"title": self._title} | self._about)

    def _attributes(self, name: str) -> Named:
        """Return the attributes of the result or argument ``name``, as in
        :func:`.scale.attributes`; those that the call gave for it take the place of its own.
        """
        return attributes(name, self._si) | self._own.get(name, {})


def _name_axes(given: dict[str, NDArray], shape: Shape) -> tuple[Names, Named]:
    """Name the axes of a result by the arguments that vary along them.

    An axis has the name of an argument if that argument has more than one value along it, has none
    along other axes, and no other argument varies along it.  Else the axis is named "state" if it
    is the only one, and "state_0", "state_1" and so on by its index if there are several.

    given: name -> argument, an array that broadcasts to ``shape``.
    shape: shape of arguments and results, broadcast.
    Returns (tuple of the names of all axes; dict from the name of each such argument to its values,
    (size of the axis,)); ((), {}) for the shape ().
    """
    dims = []
    values = {}
    # axes are counted from the last one, -1, by which arrays of fewer axes broadcast
    for axis, size in enumerate(shape, -len(shape)):
        varying = [
            name for name, array in given.items() if -axis <= array.ndim and array.shape[axis] > 1
        ]
        # equal sizes: it has no other axis along which it varies
        if len(varying) == 1 and given[varying[0]].size == size:
            dims.append(varying[0])
            values[varying[0]] = given[varying[0]].ravel()
        else:
            dims.append(state_axes(len(shape))[axis])
    return tuple(dims), values
