"""Labels of xarray and pandas: taken off what comes in, and put back on what goes out."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import Any

import numpy as np

from .errors import ParameterError

_Wrap = Callable[[str, Any], Any]


def unlabelled(given: dict[str, Any]) -> tuple[dict[str, Any], _Wrap | None]:
    """Plain arrays in place of labelled ones, and what gives a result their labels; None where nothing has any.

    Raises
    ------
    ParameterError
        Arrays of xarray beside plain ones, series of pandas with unlike indices, both kinds at once.
    """
    xarray, pandas = sys.modules.get("xarray"), sys.modules.get("pandas")
    arrays = {name: value for name, value in given.items() if xarray and isinstance(value, xarray.DataArray)}
    series = {name: value for name, value in given.items() if pandas and isinstance(value, pandas.Series)}
    if not arrays and not series:
        return given, None
    plain = [name for name, value in given.items() if name not in arrays | series and np.ndim(value)]
    if plain or (arrays and series):
        names = ", ".join((*arrays, *series, *plain))
        raise ParameterError(names, "some labelled", "alike", f"{names}: give labels to all of them, or to none")
    plain_values, wrap = _of_xarray(arrays) if arrays else _of_pandas(series)
    return given | plain_values, wrap


def _of_xarray(arrays: dict[str, Any]) -> tuple[dict[str, Any], _Wrap]:
    import xarray as xr

    whole = dict(zip(arrays, xr.broadcast(*xr.align(*arrays.values(), join="exact")), strict=True))
    like = next(iter(whole.values()))

    def wrap(name: str, values: Any) -> Any:
        return like.copy(data=values).rename(name).drop_attrs() if np.shape(values) == like.shape else values

    return {name: array.values for name, array in whole.items()}, wrap


def _of_pandas(series: dict[str, Any]) -> tuple[dict[str, Any], _Wrap]:
    import pandas as pd

    first, *others = series.values()
    if not all(first.index.equals(other.index) for other in others):
        names = " and ".join(series)
        raise ParameterError(names, "unlike indices", "of one index", f"{names} are of unlike index: align them first")

    def wrap(name: str, values: Any) -> Any:
        return pd.Series(values, index=first.index, name=name) if np.shape(values) == first.shape else values

    return {name: each.to_numpy() for name, each in series.items()}, wrap
