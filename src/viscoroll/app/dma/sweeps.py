"""Sweeps at several temperatures: which points are of one, and the reference and the factors that go with them."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ...core.array_types import Floats, Integers
from ...core.checks import check_array
from ...core.errors import ParameterError
from ...core.quantities import to_unit
from .curve import UNITS, Curve
from .record import SAME_TEMPERATURE

#: K; a temperature that is further from all others belongs to another set, as sweeps are made 5 or 10 K apart
APART = 0.5
#: of a factor that is taken for 1: rounding of factors in files
_ONE = 1e-9


class Sets(NamedTuple):
    """Temperatures of the sets, ascending; the set of each point; the set of each curve in the order given."""

    temperature: Floats
    which: Integers
    given: Integers


def points_of(temperature: Any, *columns: Any) -> tuple[Floats, list[Floats], Integers | None]:
    """A temperature each point, and the columns; of lists of curves the first point of each, else None."""
    given = check_array("temperature", temperature, unit="degC")
    columns = tuple(to_unit(name, each, UNITS[name]) for name, each in zip(Curve._fields, columns, strict=True))
    if isinstance(columns[0], (list, tuple)) and columns[0] and np.ndim(columns[0][0]) == 1:
        if given.ndim != 1:
            raise ParameterError("temperature", f"of shape {given.shape}", "one a curve")
        sizes, *others = ([np.size(curve) for curve in column] for column in columns)
        if others != [sizes, sizes] or len(sizes) != given.size:
            found = f"{given.size} temperatures"
            raise ParameterError("temperature", found, f"one a curve, here {len(sizes)} curves")
        first = np.cumsum([0, *sizes[:-1]])
        return np.repeat(given, sizes), [np.concatenate(column) for column in columns], first
    flat = [np.asarray(column) for column in columns]
    if given.ndim == 0:
        given = np.full(flat[0].shape, float(given))
    if given.ndim != 1:
        raise ParameterError("temperature", f"of shape {given.shape}", "one column, or one a curve")
    for name, column in zip(Curve._fields, flat, strict=True):
        if column.shape != given.shape:
            raise ParameterError(name, f"of shape {column.shape}", f"one a temperature, of shape {given.shape}")
    return given, flat, None


def sets_of(at: Floats, first: Integers | None) -> Sets:
    """Temperatures within :data:`APART` of a neighbour are one set.

    Raises
    ------
    ParameterError
        No points; a set that drifts by more than :data:`.record.SAME_TEMPERATURE`.
    """
    if not at.size:
        raise ParameterError("temperature", "empty", "one a point")
    order = np.argsort(at, kind="stable")
    label = np.cumsum(np.diff(at[order], prepend=at[order[0]]) > APART, dtype=np.int64)
    which = np.empty_like(label)
    which[order] = label
    parts = np.split(at[order], np.flatnonzero(np.diff(label)) + 1)
    for part in parts:
        if part[-1] - part[0] > SAME_TEMPERATURE:
            found = f"{part[0]:g} to {part[-1]:g} C in steps of at most {APART:g} K"
            allowed = (
                f"sets within {SAME_TEMPERATURE:g} K, more than {APART:g} K apart: round them to those of the sweeps"
            )
            raise ParameterError("temperature", found, allowed)
    if first is None:  # in the order in which the sets come
        _, first = np.unique(which, return_index=True)
        first = np.sort(first)
    return Sets(np.array([float(np.median(part)) for part in parts]), which, which[first])


def default_reference(temperatures: Floats, where_one: list[float]) -> float:
    """The reference where none is given: where the shift is 1, if that is among the temperatures, else the middle."""
    low, high = temperatures[0], temperatures[-1]
    return next((T for T in where_one if low <= T <= high), float(temperatures[temperatures.size // 2]))


def nearest(base: float, temperatures: Floats, name: str) -> int:
    """The set nearest to a temperature; raises ParameterError outside of all of them."""
    low, high = temperatures[0], temperatures[-1]
    if not low - APART <= base <= high + APART:
        raise ParameterError(name, base, f"within [{low:g}, {high:g}]")
    return int(np.argmin(np.abs(temperatures - base)))


def listed_factors(shift: Any, sets: Sets, base: float | None) -> tuple[Floats, float]:
    """Factors of the sets, 1 at the reference, and the reference, of factors in the order of the curves."""
    factors, temperatures = check_array("shift", shift), sets.temperature
    if not (factors > 0.0).all():
        raise ParameterError("shift", f"{factors.min():g}", "> 0: factors a_T, not their logarithms")
    if factors.shape != sets.given.shape:
        allowed = f"a factor each of {sets.given.size} temperatures, in the order of the curves"
        raise ParameterError("shift", f"of shape {factors.shape}", allowed)
    found = np.empty(temperatures.size)
    found[sets.given] = factors
    if (found[sets.given] != factors).any():
        raise ParameterError("shift", "several factors at one temperature", "one factor a temperature")
    if base is None:
        base = default_reference(temperatures, temperatures[np.abs(found - 1.0) <= _ONE].tolist())
    index = nearest(base, temperatures, "reference")
    if abs(temperatures[index] - base) > APART:
        listed = ", ".join(f"{T:g}" for T in temperatures)
        allowed = f"one of {listed}, where a factor is given; or give shift as a function of the temperature"
        raise ParameterError("reference", base, allowed)
    return found / found[index], base
