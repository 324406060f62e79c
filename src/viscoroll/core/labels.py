"""Labels of xarray and pandas: taken off what comes in, with its units, and put back on what goes out."""

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
    """What the labelled arguments of a call have in common.

    Attributes
    ----------
    shape : of the arguments, broadcast.
    wrap : (name, values, names of axes behind those of ``shape``) -> the values with their labels.
    dims, coords : as xarray takes them, of pandas too; a coordinate as its dims and its values.
    """

    shape: tuple[int, ...]
    wrap: Callable[[str, Any, tuple[str, ...]], Any]
    dims: tuple[str, ...]
    coords: dict[str, Any]

    def of(self, name: str, values: Any, *behind: str) -> Any:
        """``values`` with labels; as they are where their shape is another than that of the arguments."""
        found = np.shape(values)
        fits = found[: len(self.shape)] == self.shape and len(found) == len(self.shape) + len(behind)
        return self.wrap(name, values, behind) if fits else values

    def beside(self, names: tuple[str, ...], what: str) -> tuple[tuple[str, ...], dict[str, Any]]:
        """Axes and coordinates beside variables of these names: one that is called so is ``what`` before its name."""
        new = {name: f"{what}_{name}" if name in names else name for name in (*self.dims, *self.coords)}
        coords = {new[name]: (tuple(new[dim] for dim in dims), values) for name, (dims, values) in self.coords.items()}
        return tuple(new[dim] for dim in self.dims), coords

    def along(self, dim: str) -> dict[str, Any]:
        """The coordinates of a single axis for an axis that has the name ``dim``; those of its own name come first."""
        own, *_ = self.dims
        return {
            dim if name == own else name: (dim, values, {"long_name": name})
            for name, (_, values) in self.coords.items()
        }


#: types that bear neither labels nor units
UNLABELLED_TYPES = frozenset((float, int, np.float64, type(None)))


def strip_labels(given: dict[str, Any], units: HasUnits) -> tuple[dict[str, Any], Labels | None]:
    """Plain arrays in place of labelled ones, and what gives a result their labels; None where nothing has any.

    What carries a unit is converted to that of the argument.

    Parameters
    ----------
    given : arguments by name; functions of time, schedules and feedbacks stay as they are.
    units : what the arguments are counted in, a :class:`.scale.Scale`.

    Raises
    ------
    ParameterError
        A unit of another dimension, arrays of xarray beside plain ones, series of pandas with unlike indices, both
        kinds at once.
    """
    if UNLABELLED_TYPES.issuperset(map(type, given.values())) or all(map(has_no_unit, given.values())):
        return given, None
    given = {name: convert_argument(name, value, units) for name, value in given.items()}
    xarray, pandas = sys.modules.get("xarray"), sys.modules.get("pandas")
    arrays = {name: value for name, value in given.items() if xarray and isinstance(value, xarray.DataArray)}
    series = {name: value for name, value in given.items() if pandas and isinstance(value, pandas.Series)}
    if not arrays and not series:
        return given, None
    others = {name: value for name, value in given.items() if name not in arrays | series}
    plain = [name for name, value in others.items() if not isinstance(value, Schedule) and np.ndim(value)]
    if plain or (arrays and series):
        names = ", ".join((*arrays, *series, *plain))
        raise ParameterError(names, "some labelled", "alike", f"{names}: give labels to all of them, or to none")
    plain_values, labels = _of_xarray(arrays) if arrays else _of_pandas(series)
    return given | plain_values, labels


def _of_xarray(arrays: dict[str, Any]) -> tuple[dict[str, Any], Labels]:
    import xarray as xr

    try:
        whole = dict(zip(arrays, xr.broadcast(*xr.align(*arrays.values(), join="exact")), strict=True))
    except ValueError as error:
        names = " and ".join(arrays)
        sentence = f"{names} have unlike coordinates: align them first ({str(error).splitlines()[0]:.120})"
        raise ParameterError(names, "unlike coordinates", "aligned", sentence) from error
    like = next(iter(whole.values())).drop_attrs()
    dims = tuple(map(str, like.dims))

    def wrap(name: str, values: Any, behind: tuple[str, ...]) -> Any:
        return xr.DataArray(values, dims=(*like.dims, *behind), coords=like.coords, name=name)

    coords = {str(name): (tuple(map(str, one.dims)), one.values) for name, one in like.coords.items() if one.dims}
    return {name: array.values for name, array in whole.items()}, Labels(like.shape, wrap, dims, coords)


def _of_pandas(series: dict[str, Any]) -> tuple[dict[str, Any], Labels]:
    import pandas as pd

    first, *others = series.values()
    index = first.index
    if not all(index.equals(other.index) for other in others):
        names = " and ".join(series)
        raise ParameterError(names, "unlike indices", "of one index", f"{names} are of unlike index: align them first")

    def wrap(name: str, values: Any, behind: tuple[str, ...]) -> Any:
        if not behind:
            return pd.Series(values, index=index, name=name)
        if len(behind) > 1:
            return values
        return pd.DataFrame(values, index=index, columns=pd.RangeIndex(np.shape(values)[1], name=behind[0]))

    levels = first.rename("").reset_index().iloc[:, :-1]
    dim = str(levels.columns[0]) if index.nlevels == 1 else "state"
    coords = {str(name): ((dim,), values.to_numpy()) for name, values in levels.items()}
    return {name: each.to_numpy() for name, each in series.items()}, Labels(first.shape, wrap, (dim,), coords)
