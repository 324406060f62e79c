"""Sweeps at several temperatures: the points of each sweep, and the reference and the factors of their shifts."""

from __future__ import annotations

from itertools import zip_longest
from typing import Any, NamedTuple

import numpy as np

from ...core.array_types import Floats, Integers
from ...core.checks import check_array
from ...core.errors import ParameterError, described_error, shape_error
from ...core.quantities import to_unit
from ...materials.shift import NEAR
from .curve import UNITS, Curve
from .dynamic_moduli import SAME_TEMPERATURE

#: K; least distance of the temperatures of two sets: sweeps are made 5 or 10 K apart
LEAST_DISTANCE = NEAR
#: distance from 1 up to which a factor counts as 1: rounding of factors in files
_ONE = 1e-9


class Sets(NamedTuple):
    """Sets of points, each measured at one temperature.

    temperature : temperature of each set, ascending, degrees Celsius: the median of its points, shape (sets,).
    of_point : index of the set of each point, shape (n,).
    of_curve : index of the set of each curve in the order of the caller, shape (curves,).
    """

    temperature: Floats
    of_point: Integers
    of_curve: Integers


def points_of(temperature: Any, *columns: Any) -> tuple[Floats, list[Floats], Integers | None]:
    """Return measured moduli as flat columns, with a temperature for each point.

    temperature : of columns of points one number for all of them, or (n,), number i of point i; of lists of curves
        (curves,), number k of vector k of each column, also if it is the only one; degrees Celsius.
    *columns : omega, storage and loss, three, each a column of points, (n,), or each a list or tuple of ``curves``
        vectors, those of curve k equally long, or a 2-D array of one curve a row; with units or without.  They count as
        lists of curves if omega is a 2-D array, or a list or tuple whose first element is a vector.
    Returns (temperature of each point, degrees Celsius, (n,); [omega, storage, loss], (n,) each, curve after curve, in
    rad/s and the unit of the moduli (Pa, if they have units); index of the first point of each curve, (curves,), or
    None of columns of points).  Whether the columns are numbers, finite and > 0, is not checked here.
    Raises ParameterError for shapes that do not go together, a curve without points, a unit of another dimension, and
    for temperatures that are no finite numbers.
    """
    given = check_array("temperature", temperature, unit="degC")
    columns = tuple(to_unit(name, each, UNITS[name]) for name, each in zip(Curve._fields, columns, strict=True))
    columns = tuple([*np.asarray(each)] if getattr(each, "ndim", 0) == 2 else each for each in columns)
    if isinstance(columns[0], (list, tuple)) and columns[0] and np.ndim(columns[0][0]) == 1:
        sizes, *others = ([np.size(curve) for curve in column] for column in columns)
        for name, other in zip(Curve._fields[1:], others, strict=True):
            for n, (own, wanted) in enumerate(zip_longest(other, sizes, fillvalue=0), 1):
                if own != wanted:
                    raise described_error(name, f"has {own} points in curve {n}", f"as many as omega, {wanted}")
        if given.shape != (len(sizes),):
            raise shape_error("temperature", given.shape, f"one for each of the {len(sizes)} curves")
        if 0 in sizes:
            found = f"has no points for curve {sizes.index(0) + 1}"
            raise described_error("omega", found, "one frequency or more for each curve")
        first = np.cumsum([0, *sizes[:-1]])
        return np.repeat(given, sizes), [np.concatenate(column) for column in columns], first
    flat = [np.asarray(column) for column in columns]
    if given.ndim == 0:
        given = np.full(flat[0].shape, float(given))
    if given.ndim != 1:
        raise shape_error("temperature", given.shape, "one column, or one for each curve")
    for name, column in zip(Curve._fields, flat, strict=True):
        if column.shape != given.shape:
            raise shape_error(name, column.shape, f"one for each temperature, of shape {given.shape}")
    return given, flat, None


def sets_of(temperature: Floats, first: Integers | None) -> Sets:
    """Divide points into sets of one temperature.

    In ascending order, a temperature that is at most :data:`LEAST_DISTANCE`, 0.5 K, above the one before is of the same
    set.

    temperature : temperature of each point, degrees Celsius, shape (n,), in any order.
    first : index of the first point of each curve, each < n, (curves,), as of :func:`points_of`; None: each set counts
        as a curve, in the order in which their first points come.
    Returns the :class:`Sets`; several curves may be of one set.

    Raises
    ------
    ParameterError
        No points; a set whose temperatures span more than :data:`.dynamic_moduli.SAME_TEMPERATURE`, 1 K.
    """
    if not temperature.size:
        raise described_error("temperature", "is empty", "one number for each point")
    order = np.argsort(temperature, kind="stable")
    ascending = temperature[order]
    label = np.cumsum(np.diff(ascending, prepend=ascending[0]) > LEAST_DISTANCE, dtype=np.int64)
    of_point = np.empty_like(label)
    of_point[order] = label
    parts = np.split(ascending, np.flatnonzero(np.diff(label)) + 1)
    for part in parts:
        if part[-1] - part[0] > SAME_TEMPERATURE:
            found = f"rises from {part[0]:g} to {part[-1]:g} °C in steps of at most {LEAST_DISTANCE:g} K"
            allowed = f"equal within {SAME_TEMPERATURE:g} K in each sweep, and differ by more between sweeps"
            raise described_error("temperature", found, f"{allowed}: round it to that of the sweep")
    if first is None:  # in the order in which the sets come
        first = np.sort(np.unique(of_point, return_index=True)[1])
    return Sets(np.array([float(np.median(part)) for part in parts]), of_point, of_point[first])


def default_reference(temperatures: Floats, unshifted: list[float]) -> float:
    """Return the reference temperature of a master curve where the user gives none.

    temperatures : temperatures of the sets, at least one, ascending, degrees Celsius, (sets,).
    unshifted : temperatures at which the given shift is 1, degrees Celsius; empty, or NaN, where none is known.
    Returns a temperature, degrees Celsius: the first of ``unshifted`` between the lowest and the highest set, both
    included, else the temperature of the middle set, of an even number the warmer one of the two.
    """
    low, high = temperatures[0], temperatures[-1]
    return next((T for T in unshifted if low <= T <= high), float(temperatures[temperatures.size // 2]))


def nearest(base: float, temperatures: Floats) -> int:
    """Return the index of the set nearest to a temperature, which must not lie outside of all sets.

    base : the temperature for which the set is sought, degrees Celsius, a number.
    temperatures : temperatures of the sets, ascending, degrees Celsius, (sets,).
    Returns an index of ``temperatures``, an int; of two that are equally near that of the colder set.
    Raises ParameterError for a temperature more than :data:`LEAST_DISTANCE`, 0.5 K, below the first set or above the
    last.
    """
    low, high = temperatures[0], temperatures[-1]
    if not low - LEAST_DISTANCE <= base <= high + LEAST_DISTANCE:
        raise ParameterError("reference", base, f"within [{low:g}, {high:g}]")
    return int(np.argmin(np.abs(temperatures - base)))


def listed_factors(shift: Any, sets: Sets, base: float | None) -> tuple[Floats, float]:
    """Sort listed shift factors by sets and divide them by that of the reference, which is found if it is not given.

    shift : factors a_T > 0, dimensionless, (curves,), in the order of the curves.
    sets : :class:`Sets`, the sets of the points.
    base : reference, degrees Celsius; None: the temperature of the coldest set whose factor is 1 to 1e-9, else that of
        the middle set, of an even number the warmer one.
    Returns (factors of the sets, dimensionless, (sets,), divided by that of the reference; reference, degrees Celsius).
    Raises ParameterError for factors that are not finite and > 0, of another number than the curves, or different for
    curves of one set, and for a reference that is within 0.5 K of none of the sets.
    """
    factors, temperatures = check_array("shift", shift), sets.temperature
    if not (factors > 0.0).all():
        raise ParameterError("shift", f"{factors.min():g}", "> 0: factors a_T, not their logarithms")
    if factors.shape != sets.of_curve.shape:
        allowed = f"one factor for each of {sets.of_curve.size} temperatures, in the order of the curves"
        raise shape_error("shift", factors.shape, allowed)
    found = np.empty(temperatures.size)
    found[sets.of_curve] = factors
    if (found[sets.of_curve] != factors).any():
        raise described_error("shift", "has several factors for one temperature", "one factor for each temperature")
    if base is None:
        base = default_reference(temperatures, temperatures[np.abs(found - 1.0) <= _ONE].tolist())
    index = nearest(base, temperatures)
    if abs(temperatures[index] - base) > LEAST_DISTANCE:
        listed = ", ".join(f"{T:g}" for T in temperatures)
        allowed = f"{listed}, whose factors shift lists; for another one give shift as a function of the temperature"
        raise ParameterError("reference", base, allowed)
    return found / found[index], base
