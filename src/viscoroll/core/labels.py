"""Labels of xarray and pandas: removed from the arguments of a call, with their units, and put on
its results.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np

from .checks import check_array
from .drive_arguments import Feedback, Schedule, convert_argument
from .errors import ParameterError
from .quantities import has_no_unit
from .scale import HasUnits


class Labels(NamedTuple):
    """Labels that the arguments of a call have in common.

    shape : shape of the arguments, broadcast.
    like : array of xarray with the axes and coordinates of the arguments, or their index of pandas.
    dims : names of the axes, as many as ``shape`` has.
    coords : name of a coordinate -> (names of its axes, its values), as xarray has them, for pandas
    too.
    """

    shape: tuple[int, ...]
    like: Any
    dims: tuple[str, ...]
    coords: dict[str, Any]

    def axes_in_front(self, shape: tuple[int, ...], after: int = 0) -> int:
        """Return how many axes an array has before those of the arguments, as arrays of the roller
        give them.

        shape: shape of the array.
        after: number of its axes after those of the arguments.
        Returns -1 if the array has not the axes of the arguments there.
        """
        front = len(shape) - len(self.shape) - after
        return front if front >= 0 and shape[front : len(shape) - after] == self.shape else -1

    def apply(self, name: str, values: Any, *further: str) -> Any:
        """Return values with the labels of the arguments.

        name: name of the result, which the labelled array gets.
        values: array with the axes of the arguments, perhaps others in front of them, which
        :func:`state_axes` names.
        further: names of its axes after those of the arguments.
        Returns an array of xarray, in which an axis or a coordinate of the arguments with the name
        of another axis is called given_NAME, or a series of pandas, with one further axis a data
        frame, whose columns are 0 to m - 1.  ``values`` itself is returned if its shape is another
        one, and with pandas if there are more axes.
        """
        shape = np.shape(values)
        front = self.axes_in_front(shape, len(further))
        if front < 0:
            return values
        if hasattr(self.like, "dims"):
            import xarray as xr

            before = state_axes(len(shape) - len(further))[:front]
            own = {*self.like.dims, *self.like.coords}
            like = self.like.rename(
                {other: f"given_{other}" for other in (*before, *further) if other in own}
            )
            return xr.DataArray(
                values, dims=(*before, *like.dims, *further), coords=like.coords, name=name
            )
        import pandas as pd

        if front or len(further) > 1:  # no type of pandas has more axes
            return values
        if further:
            return pd.DataFrame(
                values, index=self.like, columns=pd.RangeIndex(shape[1], name=further[0])
            )
        return pd.Series(values, index=self.like, name=name)

    def differ(self, name: str, values: Any) -> bool:
        """Whether a coordinate or an axis has the ``name`` of an argument, but not its ``values``,
        an array.

        An axis without a coordinate differs from a number alone.
        """
        import xarray as xr

        if name not in self.coords:
            return name in self.dims and not values.ndim
        dims, label = self.coords[name]
        own = xr.DataArray(values, dims=self.dims[len(self.dims) - values.ndim :])
        return not xr.DataArray(label, dims=dims).broadcast_equals(own)

    def axes_beside(
        self, names: Iterable[str], *dims: str
    ) -> tuple[tuple[str, ...], dict[str, Any]]:
        """Return axes and coordinates for a dataset; what has the name of a variable there is
        called given_NAME.

        names: names of the variables of the dataset, and of its other axes.
        dims: new names of the axes, which their coordinates get too; without any they keep their
        names.
        Returns (names of the axes; dict from the name of a coordinate to (its axes, its values,
        {"long_name": name in the arguments})), as xarray takes them.  Whether a name given_NAME is
        free is not checked.
        """
        new = {
            name: f"given_{name}" if name in names else name for name in (*self.dims, *self.coords)
        }
        new |= zip(self.dims, dims, strict=False)
        coords = {
            new[name]: (tuple(new[dim] for dim in own), values, {"long_name": name})
            for name, (own, values) in self.coords.items()
        }
        return tuple(new[dim] for dim in self.dims), coords


def state_axes(count: int) -> tuple[str, ...]:
    """Return names of ``count`` axes without labels: "state" of a single one, else "state_0",
    "state_1" and so on.
    """
    return ("state",) if count == 1 else tuple(f"state_{n}" for n in range(count))


def dataset_axes(
    labels: Labels | None, shape: tuple[int, ...], names: Iterable[str]
) -> tuple[tuple[str, ...], dict[str, Any]]:
    """Return the axes of a dataset of results, and its coordinates by the labels of the arguments.

    labels: labels of the arguments; None: they had none.
    shape: shape of the results; other axes may be in front of those of the labels.
    names: names of the variables of the dataset.
    Returns (names of the axes, by :func:`state_axes` where they have no labels; coordinates as in
    :meth:`Labels.axes_beside`, {} if the labels have another shape).
    """
    axes = state_axes(len(shape))
    if labels is None or (front := labels.axes_in_front(shape)) < 0:
        return axes, {}
    dims, coords = labels.axes_beside((*names, *axes[:front]))
    return axes[:front] + dims, coords


#: Types that have neither labels nor units.
UNLABELLED_TYPES = frozenset((float, int, np.float64, type(None)))


def strip_labels(given: dict[str, Any], units: HasUnits) -> tuple[dict[str, Any], Labels | None]:
    """Return the arguments of a call as plain numbers in their units, and their labels.

    Parameters
    ----------
    given : name -> what a caller gave: numbers, arrays, values with units or labels, functions of
        time, schedules and feedbacks, or None.  Labels of the fields of a schedule or a feedback
        are not examined.
    units : object with a method ``unit``, which gives the unit of each argument by name, as a
    :class:`.scale.Scale`.

    Returns
    -------
    plain : name -> value without labels and unit; labelled arrays are broadcast to their common
        shape, and numbers of other kinds, as an index of pandas, a nested list or a Decimal, are
        float64.  It may be ``given`` itself, if no argument has a label or a unit.
    labels : the :class:`Labels` of the arguments; None where no argument has any.

    Raises
    ------
    ParameterError
        What :func:`.drive_arguments.convert_argument` refuses, as a unit of another dimension;
        numbers of other kinds that are not finite; labelled arrays beside plain ones (numbers and
        schedules
        may stand beside them), arrays of xarray whose common axes have different coordinates,
        series of pandas with different indices, or both kinds together.
    """
    if UNLABELLED_TYPES.issuperset(map(type, given.values())) or all(
        map(has_no_unit, given.values())
    ):
        return given, None
    given = {name: convert_argument(name, value, units) for name, value in given.items()}
    arrays, series = (
        {name: value for name, value in given.items() if kind and isinstance(value, kind)}
        for kind in (_loaded_type("xarray", "DataArray"), _loaded_type("pandas", "Series"))
    )
    labelled = arrays | series
    given |= {
        name: check_array(name, value)[()]
        for name, value in given.items()
        if not (
            name in labelled
            or has_no_unit(value)
            or callable(value)
            or isinstance(value, Schedule | Feedback)
        )
    }
    if not labelled:
        return given, None
    plain = [
        name
        for name, value in given.items()
        if name not in labelled and not isinstance(value, Schedule) and np.ndim(value)
    ]
    if plain or (arrays and series):
        names = ", ".join((*labelled, *plain))
        raise ParameterError(
            names, "some labelled", "alike", f"{names}: give labels to all of them or to none"
        )
    values, labels = _from_xarray(arrays) if arrays else _from_pandas(series)
    return given | values, labels


def _loaded_type(module: str, name: str) -> Any:
    """Return the type ``name`` of a ``module`` if the program has imported that module, else
    None.
    """
    return getattr(sys.modules.get(module), name, None)


def _from_xarray(arrays: dict[str, Any]) -> tuple[dict[str, Any], Labels]:
    """Broadcast arrays of xarray by the names of their axes, and separate their values from their
    labels.

    arrays: name of an argument -> array of xarray; at least one.
    Returns (name -> values, all of the broadcast shape, perhaps read-only views; :class:`Labels`,
    whose ``coords`` are the coordinates along an axis of every array; of two of one name that of
    the first array).
    Raises ParameterError if arrays differ in the coordinates or the length of an axis that they
    share.
    """
    import xarray as xr

    try:
        whole = dict(
            zip(arrays, xr.broadcast(*xr.align(*arrays.values(), join="exact")), strict=True)
        )
    except ValueError as error:
        names = " and ".join(arrays)
        sentence = (
            f"{names} have unlike coordinates: align them first ({str(error).splitlines()[0]:.120})"
        )
        raise ParameterError(names, "unlike coordinates", "aligned", sentence) from error
    like = next(iter(whole.values())).drop_attrs()
    others = {
        name: each for array in reversed(whole.values()) for name, each in array.coords.items()
    }
    like = like.assign_coords(
        {name: each for name, each in others.items() if name not in like.coords}
    )
    coords = {
        str(name): (tuple(map(str, each.dims)), each.values)
        for name, each in like.coords.items()
        if each.dims
    }
    labels = Labels(like.shape, like, tuple(map(str, like.dims)), coords)
    return {name: array.values for name, array in whole.items()}, labels


def _from_pandas(series: dict[str, Any]) -> tuple[dict[str, Any], Labels]:
    """Separate the values of series of pandas from their labels.

    series: name of an argument -> series of pandas; at least one.
    Returns (name -> values, (n,), of the dtype of the series; :class:`Labels`, which make series of
    results, and data frames of results with one more axis; results with several more axes are
    returned without labels).  The axis of these labels has the name of the index, "index" of one
    without a name, "state" of an index of several levels, each of which is a coordinate; levels
    without a name are called level_0, level_1 and so on.
    Raises ParameterError if the indices differ.
    """
    first, *others = series.values()
    index = first.index
    if not all(index.equals(other.index) for other in others):
        names = " and ".join(series)
        raise ParameterError(
            names,
            "unlike indices",
            "of one index",
            f"{names} have different indexes: align them first",
        )

    levels = first.rename("").reset_index().iloc[:, :-1]
    dim = str(levels.columns[0]) if index.nlevels == 1 else "state"
    coords = {str(name): ((dim,), values.to_numpy()) for name, values in levels.items()}
    return {name: each.to_numpy() for name, each in series.items()}, Labels(
        first.shape, index, (dim,), coords
    )
