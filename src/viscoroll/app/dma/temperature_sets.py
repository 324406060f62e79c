"""Sweeps at several temperatures: the points of each sweep, and the reference and the factors of their shifts."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ...core.array_types import Floats, Integers
from ...core.checks import check_array
from ...core.errors import ParameterError
from ...core.quantities import to_unit
from .curve import UNITS, Curve
from .dynamic_moduli import SAME_TEMPERATURE

#: K; least distance of the temperatures of two sets: sweeps are made 5 or 10 K apart
LEAST_DISTANCE = 0.5
#: distance from 1 up to which a factor counts as 1: rounding of factors in files
_ONE = 1e-9


class Sets(NamedTuple):
    """Sweeps, each at one temperature.

    temperature : temperature of each set, ascending, degrees Celsius: the median of its points, shape (sets,).
    of_point : index of the set of each point, shape (n,).
    of_curve : index of the set of each curve in the order of the caller, shape (curves,).
    """

    temperature: Floats
    of_point: Integers
    of_curve: Integers


def points_of(temperature: Any, *columns: Any) -> tuple[Floats, list[Floats], Integers | None]:
    """Return a temperature for each point, and the columns.

    temperature : temperature of all points, of each point, or of each curve; degrees Celsius.
    columns : omega, storage and loss, each a column or a list of curves.
    Returns (temperatures, columns, index of the first point of each curve; None where the columns are no lists).
    Raises ParameterError for shapes that do not go together.
    """
    given = check_array("temperature", temperature, unit="degC")
    columns = tuple(to_unit(name, each, UNITS[name]) for name, each in zip(Curve._fields, columns, strict=True))
    if isinstance(columns[0], (list, tuple)) and columns[0] and np.ndim(columns[0][0]) == 1:
        sizes, *others = ([np.size(curve) for curve in column] for column in columns)
        if others != [sizes, sizes] or given.shape != (len(sizes),):
            raise ParameterError(
                "temperature", f"of shape {given.shape}", f"one for each curve, here {len(sizes)} curves"
            )
        first = np.cumsum([0, *sizes[:-1]])
        return np.repeat(given, sizes), [np.concatenate(column) for column in columns], first
    flat = [np.asarray(column) for column in columns]
    if given.ndim == 0:
        given = np.full(flat[0].shape, float(given))
    if given.ndim != 1:
        raise ParameterError("temperature", f"of shape {given.shape}", "one column, or one for each curve")
    for name, column in zip(Curve._fields, flat, strict=True):
        if column.shape != given.shape:
            raise ParameterError(name, f"of shape {column.shape}", f"one for each temperature, of shape {given.shape}")
    return given, flat, None


def sets_of(temperature: Floats, first: Integers | None) -> Sets:
    """Divide points into sets; temperatures within :data:`LEAST_DISTANCE` of a neighbour are one set.

    temperature : temperature of each point, degrees Celsius, shape (n,).
    first : index of the first point of each curve; None: sets are taken in the order in which they come.
    Returns the sets.

    Raises
    ------
    ParameterError
        No points; a set that drifts by more than :data:`.dynamic_moduli.SAME_TEMPERATURE`.
    """
    if not temperature.size:
        raise ParameterError("temperature", "empty", "one a point")
    order = np.argsort(temperature, kind="stable")
    ascending = temperature[order]
    label = np.cumsum(np.diff(ascending, prepend=ascending[0]) > LEAST_DISTANCE, dtype=np.int64)
    of_point = np.empty_like(label)
    of_point[order] = label
    parts = np.split(ascending, np.flatnonzero(np.diff(label)) + 1)
    for part in parts:
        if part[-1] - part[0] > SAME_TEMPERATURE:
            found = f"{part[0]:g} to {part[-1]:g} C in steps of at most {LEAST_DISTANCE:g} K"
            allowed = f"sets within {SAME_TEMPERATURE:g} K, more than {LEAST_DISTANCE:g} K apart"
            raise ParameterError("temperature", found, f"{allowed}: round them to those of the sweeps")
    if first is None:  # in the order in which the sets come
        first = np.sort(np.unique(of_point, return_index=True)[1])
    return Sets(np.array([float(np.median(part)) for part in parts]), of_point, of_point[first])


def default_reference(temperatures: Floats, unshifted: list[float]) -> float:
    """Return the reference temperature where none is given.

    temperatures : temperatures of the sets, ascending.
    unshifted : temperatures at which the shift is 1; the first within the sets is the reference, else the middle set
    is.
    Returns the temperature, degrees Celsius.
    """
    low, high = temperatures[0], temperatures[-1]
    return next((T for T in unshifted if low <= T <= high), float(temperatures[temperatures.size // 2]))


def nearest(base: float, temperatures: Floats, name: str) -> int:
    """Return the index of the set nearest to a temperature.

    base : the temperature, degrees Celsius.
    temperatures : temperatures of the sets, ascending.
    name : name of the argument in the message of the ParameterError outside of all sets.
    """
    low, high = temperatures[0], temperatures[-1]
    if not low - LEAST_DISTANCE <= base <= high + LEAST_DISTANCE:
        raise ParameterError(name, base, f"within [{low:g}, {high:g}]")
    return int(np.argmin(np.abs(temperatures - base)))


def listed_factors(shift: Any, sets: Sets, base: float | None) -> tuple[Floats, float]:
    """Return factors of the sets, 1 at the reference, and the reference.

    shift : factors in the order of the curves.
    sets : the sets of the points.
    base : reference, degrees Celsius; None: where a factor is 1, else the middle set.
    Raises ParameterError for factors that do not fit the curves, and for a reference where no factor is given.
    Returns (factors of the sets, dimensionless, (sets,); reference temperature, degrees Celsius).
    """
    factors, temperatures = check_array("shift", shift), sets.temperature
    if not (factors > 0.0).all():
        raise ParameterError("shift", f"{factors.min():g}", "> 0: factors a_T, not their logarithms")
    if factors.shape != sets.of_curve.shape:
        allowed = f"one factor for each of {sets.of_curve.size} temperatures, in the order of the curves"
        raise ParameterError("shift", f"of shape {factors.shape}", allowed)
    found = np.empty(temperatures.size)
    found[sets.of_curve] = factors
    if (found[sets.of_curve] != factors).any():
        raise ParameterError("shift", "several factors for one temperature", "one factor a temperature")
    if base is None:
        base = default_reference(temperatures, temperatures[np.abs(found - 1.0) <= _ONE].tolist())
    index = nearest(base, temperatures, "reference")
    if abs(temperatures[index] - base) > LEAST_DISTANCE:
        listed = ", ".join(f"{T:g}" for T in temperatures)
        allowed = f"one of {listed}, where a factor is given; or give shift as a function of the temperature"
        raise ParameterError("reference", base, allowed)
    return found / found[index], base
