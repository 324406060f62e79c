"""Labels of xarray and pandas: removed from the arguments of a call, with their units, and put on its results."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from .drive import Schedule, convert_argument
from .errors import ParameterError
from .quantities import has_no_unit
from .scale import HasUnits


class Labels(NamedTuple):
    """Labels that the arguments of a call have in common.

    shape : shape of the arguments, broadcast.
    wrap : function (name of the result, values, names of further axes after those of ``shape``) -> the values as an
        array of xarray, or a series or data frame of pandas.
    dims : names of the axes, as many as ``shape`` has.
    coords : name of a coordinate -> (names of its axes, its values), as xarray has them, for pandas too.
    """

    shape: tuple[int, ...]
    wrap: Callable[[str, Any, tuple[str, ...]], Any]
    dims: tuple[str, ...]
    coords: dict[str, Any]

    def apply(self, name: str, values: Any, *further: str) -> Any:
        """Return values with the labels of the arguments.

        name: name of the result, which the labelled array gets.
        values: array whose first axes are those of the arguments.
        further: names of its axes after those of the arguments.
        Returns an array of xarray, or a series of pandas, with one further axis a data frame.  ``values`` itself is
        returned if its shape is another one, and with pandas if there are several further axes.
        """
        shape = np.shape(values)
        fits = shape[: len(self.shape)] == self.shape and len(shape) == len(self.shape) + len(further)
        return self.wrap(name, values, further) if fits else values

    def renamed_coords(self, names: tuple[str, ...], prefix: str) -> tuple[tuple[str, ...], dict[str, Any]]:
        """Rename those axes and coordinates whose names the variables of a dataset have already.

        names: names of the variables of the dataset.
        prefix: word that is put before such an axis or coordinate, as "given" for given_V; others keep their names.
            Whether a new name is free is not checked.
        Returns (names of the axes; dict from the name of a coordinate to (its axes, its values)), as xarray takes
        them.
        """
        new = {name: f"{prefix}_{name}" if name in names else name for name in (*self.dims, *self.coords)}
        coords = {new[name]: (tuple(new[dim] for dim in dims), values) for name, (dims, values) in self.coords.items()}
        return tuple(new[dim] for dim in self.dims), coords

    def axis_coords(self, dim: str) -> dict[str, Any]:
        """Return the coordinates of arguments with one axis, for a dataset in which that axis is named ``dim``.

        dim: new name of the axis, and of the coordinate that had the axis' old name; others keep their names.
        Returns a dict from a name to (``dim``, values, {"long_name": old name}), as xarray takes them; {} without
        coordinates.  Where another coordinate is named ``dim`` already, the later of the two is kept.
        Raises ValueError for arguments without axes.
        """
        (own,) = self.dims[:1]
        return {
            dim if name == own else name: (dim, values, {"long_name": name})
            for name, (_, values) in self.coords.items()
        }


#: Types that have neither labels nor units.
UNLABELLED_TYPES = frozenset((float, int, np.float64, type(None)))


def strip_labels(given: dict[str, Any], units: HasUnits) -> tuple[dict[str, Any], Labels | None]:
    """Return the arguments of a call as plain numbers in their units, and their labels.

    Parameters
    ----------
    given : name -> what a caller gave: numbers, arrays, values with units or labels, functions of time, schedules and
        feedbacks, or None.  Labels of the fields of a schedule or a feedback are not examined.
    units : object with a method ``unit``, which gives the unit of each argument by name, as a :class:`.scale.Scale`.

    Returns
    -------
    plain : name -> value without labels and unit, of the same kind; labelled arrays are broadcast to their common
        shape.  It may be ``given`` itself, if no argument has a label or a unit.
    labels : the :class:`Labels` of the arguments; None where no argument has any.

    Raises
    ------
    ParameterError
        What :func:`.drive.convert_argument` refuses, as a unit of another dimension; labelled arrays beside plain ones
        (numbers and schedules may stand beside them), arrays of xarray whose common axes have different coordinates,
        series of pandas with different indices, or both kinds together.
    """
    if UNLABELLED_TYPES.issuperset(map(type, given.values())) or all(map(has_no_unit, given.values())):
        return given, None
    given = {name: convert_argument(name, value, units) for name, value in given.items()}
    arrays, series = (
        {name: value for name, value in given.items() if kind and isinstance(value, kind)}
        for kind in (_loaded_type("xarray", "DataArray"), _loaded_type("pandas", "Series"))
    )
    labelled = arrays | series
    if not labelled:
        return given, None
    plain = [
        name for name, value in given.items()
        if name not in labelled and not isinstance(value, Schedule) and np.ndim(value)
    ]  # fmt: skip
    if plain or (arrays and series):
        names = ", ".join((*labelled, *plain))
        raise ParameterError(names, "some labelled", "alike", f"{names}: give labels to all of them or to none")
    values, labels = _from_xarray(arrays) if arrays else _from_pandas(series)
    return given | values, labels


def _loaded_type(module: str, name: str) -> Any:
    """Return the type ``name`` of a ``module`` if the program has imported that module, else None."""
    return getattr(sys.modules.get(module), name, None)


def _from_xarray(arrays: dict[str, Any]) -> tuple[dict[str, Any], Labels]:
    """Broadcast arrays of xarray by the names of their axes, and separate their values from their labels.

    arrays: name of an argument -> array of xarray; at least one.
    Returns (name -> values, all of the broadcast shape, perhaps read-only views; :class:`Labels`, whose ``coords`` are
    those of all arrays that have an axis; of two of one name that of the first array).
    Raises ParameterError if arrays differ in the coordinates or the length of an axis that they share.
    """
    import xarray as xr

    try:
        whole = dict(zip(arrays, xr.broadcast(*xr.align(*arrays.values(), join="exact")), strict=True))
    except ValueError as error:
        names = " and ".join(arrays)
        sentence = f"{names} have unlike coordinates: align them first ({str(error).splitlines()[0]:.120})"
        raise ParameterError(names, "unlike coordinates", "aligned", sentence) from error
    like = next(iter(whole.values())).drop_attrs()
    others = {name: each for array in reversed(whole.values()) for name, each in array.coords.items()}
    like = like.assign_coords({name: each for name, each in others.items() if name not in like.coords})

    def wrap(name: str, values: Any, further: tuple[str, ...]) -> Any:
        """Return values as an array of xarray with the axes and coordinates of the arguments, then ``further`` axes."""
        return xr.DataArray(values, dims=(*like.dims, *further), coords=like.coords, name=name)

    coords = {str(name): (tuple(map(str, each.dims)), each.values) for name, each in like.coords.items() if each.dims}
    labels = Labels(like.shape, wrap, tuple(map(str, like.dims)), coords)
    return {name: array.values for name, array in whole.items()}, labels


def _from_pandas(series: dict[str, Any]) -> tuple[dict[str, Any], Labels]:
    """Separate the values of series of pandas from their labels.

    series: name of an argument -> series of pandas; at least one.
    Returns (name -> values, (n,), of the dtype of the series; :class:`Labels`, which make series of results, and data
    frames of results with one more axis; results with several more axes are returned without labels).  The axis of
    these labels has the name of the index, "index" of one without a name, "state" of an index of several levels, each
    of which is a coordinate; levels without a name are called level_0, level_1 and so on.
    Raises ParameterError if the indices differ.
    """
    import pandas as pd

    first, *others = series.values()
    index = first.index
    if not all(index.equals(other.index) for other in others):
        names = " and ".join(series)
        raise ParameterError(
            names, "unlike indices", "of one index", f"{names} have different indexes: align them first"
        )

    def wrap(name: str, values: Any, further: tuple[str, ...]) -> Any:
        """Return values, (n,) or (n, m), as a series or a data frame with the index of the arguments.

        name: name of the series; a data frame has none.
        values: array; it is returned itself if it has more axes.
        further: names of its axes after the first; with one the columns of the data frame are 0 to m - 1, of that name.
        """
        if len(further) > 1:  # no type of pandas has more axes
            return values
        if further:
            return pd.DataFrame(values, index=index, columns=pd.RangeIndex(np.shape(values)[1], name=further[0]))
        return pd.Series(values, index=index, name=name)

    levels = first.rename("").reset_index().iloc[:, :-1]
    dim = str(levels.columns[0]) if index.nlevels == 1 else "state"
    coords = {str(name): ((dim,), values.to_numpy()) for name, values in levels.items()}
    return {name: each.to_numpy() for name, each in series.items()}, Labels(first.shape, wrap, (dim,), coords)
