"""Interpolation between the nodes of a grid, by tensor cubic splines.

A grid is a table of fields of the contact over speed V, creepage delta and perhaps alpha,
T_epsilon/T_sigma.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from ..core import (
    Floats,
    OutOfTableError,
    ParameterError,
    Values,
    broadcast_shape,
    check_array,
    check_names,
)
from ..laws import fit_spline, friction_limit, pack_spline
from . import table_files

if TYPE_CHECKING:
    import xarray as xr


class Interpolant:
    """A table prepared for repeated interpolation; :func:`interpolate` prepares one in each call.

    A call ``interpolant(fields, V=..., delta=...)`` takes names of fields and points, and raises
    the errors of :func:`interpolate`; with ``linear=False`` it returns the same values.

    Parameters
    ----------
    table : a Dataset of :func:`viscoroll.tables.build` or :func:`viscoroll.tables.load`.
        The spline of a field is computed at its first use, from the values at that time.
    linear : whether to interpolate linearly in V, delta and alpha, as look-up blocks do; else by
        cubic splines in ln V, delta and ln alpha.

    Raises
    ------
    FileError
        If it is not a grid, as the law of a material is none, is incomplete, or is in other units
        than it was built in.
    ParameterError
        A mu, or a load beside it, that is no finite number > 0.

    Examples
    --------
    >>> import viscoroll as vr
    >>> grid = vr.tables.build(
    ...     vr.presets.PAPER_SECTION_5, [0.1, 0.2, 0.3, 0.4], delta=[-0.1, 0.0, 0.1]
    ... )
    >>> look_up = vr.tables.Interpolant(grid)
    >>> bool(look_up(["Q"], V=0.25, delta=0.01).Q > 0.0)
    True
    """

    def __init__(self, table: xr.Dataset, linear: bool = False) -> None:
        """Check a table and choose its axes and bounds; splines are computed at the first use of a
        field.

        table : the grid, dataset of a file or of ``build``.
        linear : whether interpolation is linear in V, delta and alpha, else by cubic splines in ln
            V, delta and ln alpha.
        Raises FileError if it is not a grid, is incomplete or in other units; ParameterError for
        its mu and load.
        """
        table_files.check_grid(table, getattr(table, "encoding", {}).get("source", "interpolate"))
        self._table = table
        self._axes = table_files.axes_of(table)
        self._linear = linear
        self._splines: dict[str, tuple[tuple[str, ...], Any]] = {}
        # The law has these bounds; a spline may exceed them near the kink at delta_star.
        limit = friction_limit(table.attrs)
        self._bounds = {"Q": (-limit, limit), "beta": (0.0, 1.0)}

    def __call__(self, fields: Iterable[str] | None = None, **points: ArrayLike) -> Values:
        """Interpolate fields at points.

        fields: a name or names of fields of the table; None: all, which needs a coordinate on every
            axis; of an empty iterable the Values are empty.
        points: axis -> coordinates, numbers or arrays that broadcast, in the units of the table.  A
            coordinate is needed on each axis of the fields, also on one of a single node; others
            may be given too.
        Returns the fields as :class:`Values`, each a new array of the broadcast shape of all
        points, a float where all are numbers.  Q and beta are clipped to the bounds of the law:
        |Q| <= mu P and 0 <= beta <= 1.
        Raises ParameterError and OutOfTableError as :func:`interpolate`.
        """
        known = table_files.fields_of(self._table)
        names = check_names(
            "fields", known if fields is None else fields, known, "a field of this table"
        )
        coordinates, shape = self._map_points(points, names)
        results: dict[str, Any] = {}
        for name in names:
            dims, values = self._spline(name)
            if dims:
                values = values(np.stack([coordinates[dim] for dim in dims], axis=-1))
            if name in self._bounds:
                values = np.clip(values, *self._bounds[name])
            results[name] = np.broadcast_to(values, shape).copy() if shape else float(values)
        return Values(results, title="Interpolated", si="load" in self._table.attrs)

    def jitted(self, field: str) -> tuple[Any, Any]:
        """Return a field for numba's jitted functions: a function ``at(spline, V, delta, alpha)``
        and its spline.

        Parameters
        ----------
        field : name of a field of the grid, over V, delta and alpha or some of them.

        Returns
        -------
        at : jitted function of the spline and three floats V, delta and alpha, in the units of the
            table.  It returns a :class:`.spline_law.Value`: ``value`` and its
            derivatives ``dV``, ``ddelta`` and ``dalpha``.  Q and beta are clipped to the bounds of
            the law; where that happens the derivatives are 0.  All four are NaN for a coordinate
            outside of its axis.  The field may not depend on one of the coordinates, or the grid
            may have a single node on that axis: then any number may be given there, it is ignored,
            and its derivative is 0.
        spline : vector of doubles, the first argument of ``at``.

        Raises
        ------
        ParameterError
            An unknown field.

        Examples
        --------
        >>> import viscoroll as vr
        >>> grid = vr.tables.build(
        ...     vr.presets.PAPER_SECTION_5, [0.1, 0.2, 0.3, 0.4], delta=[-0.1, 0.0, 0.1]
        ... )
        >>> at, Q = vr.tables.Interpolant(grid).jitted("Q")
        >>> at(Q, 0.25, 0.01, 0.0).ddelta > 0.0
        True

        Notes
        -----
        Values differ from those of this class by rounding, slopes are those of the spline
        (``tests/tables/test_splines.py``).
        """
        from ..kernels.law.spline_law import spline_at

        (name,) = check_names(
            "field", field, table_files.fields_of(self._table), "a field of this table"
        )
        dims, found = self._spline(name)
        logs = () if self._linear else ("V", "alpha")
        return spline_at, pack_spline(found, dims, logs, self._bounds.get(name, (-np.inf, np.inf)))

    def _map_points(
        self, points: dict[str, ArrayLike], names: tuple[str, ...]
    ) -> tuple[dict[str, Floats], tuple[int, ...]]:
        """Check the points of a call, and convert them to the coordinates of the splines.

        points: axis -> coordinates that the caller gave, numbers or arrays that broadcast, perhaps
            with units.
        names: names of the fields to interpolate, which need the axes that they depend on.
        Raises ParameterError for axes that are missing or unknown, for values that are no finite
        numbers, for shapes that do not broadcast and for a unit of another dimension;
        OutOfTableError for a point outside of an axis, whose ends belong to it.
        Returns (each axis of ``points`` -> coordinates of the interpolation, read-only, in the
        broadcast shape; that shape, () of numbers).  Coordinates are ln V, ln alpha, and delta as
        it is; where the interpolation is linear all are as given.
        """
        needed = {str(dim) for name in names for dim in self._table[name].dims}
        if not needed <= points.keys() <= set(self._axes):
            wanted = ", ".join(axis for axis in self._axes if axis in needed)
            allowed = f"axes of this grid ({', '.join(self._axes)}); these fields need {wanted}"
            raise ParameterError("coordinates", ", ".join(points) or "none", allowed)
        axes = {name: self._table[name] for name in points}
        arrays = {
            name: check_array(name, value, unit=axes[name].attrs.get("units", "1"))
            for name, value in points.items()
        }
        shape = broadcast_shape(**arrays)
        for name, array in arrays.items():
            low, high = axes[name].values[[0, -1]]
            outside = (array < low) | (array > high)
            if outside.any():
                raise OutOfTableError(name, float(array[outside].flat[0]), low, high)
        return {
            name: np.broadcast_to(self._map_axis(name, array), shape)
            for name, array in arrays.items()
        }, shape

    def _map_axis(self, name: str, values: Floats) -> Floats:
        """Transform values on one axis of the table to the coordinate in which the fields are
        smooth.

        Splines are fitted and evaluated in that coordinate.

        name: name of the axis: "V", "delta" or "alpha".
        values: values on the axis, of any shape, > 0 on V and alpha.
        Returns an array of the same shape.  Where the interpolation is linear, and on delta:
        ``values`` itself, not a copy.  Else ln(values).
        """
        return values if self._linear or name == "delta" else np.log(values)

    def _spline(self, name: str) -> tuple[tuple[str, ...], Any]:
        """Return the spline of a field, computed at its first use and kept in ``_splines``.

        name: name of a field, which the caller has checked (else KeyError).
        Returns (names of those of its axes that have more than one node, in their order; the spline
        over these, a function that takes coordinates of :meth:`_map_axis`, (..., axes), and returns
        values, (...)).  The spline is cubic, with ``_linear`` of degree 1, of lower degree along
        axes of few nodes (:func:`.law_grid.fit_spline`); it extrapolates, and values are not
        clipped.  Without such axes the names are () and the second entry is the value of the field,
        an array without axes.
        Raises ValueError of scipy where values that were changed after the check are not finite.
        """
        if name not in self._splines:
            field = self._table[name].squeeze()
            dims = tuple(map(str, field.dims))
            axes = [self._map_axis(dim, self._table[dim].values) for dim in dims]
            self._splines[name] = dims, fit_spline(field.values, axes, 1 if self._linear else 3)
        return self._splines[name]


def interpolate(
    table: xr.Dataset, fields: Iterable[str] | None = None, **points: ArrayLike
) -> Values:
    """Interpolate fields of a grid between its nodes, without extrapolation.

    Parameters
    ----------
    table : Dataset of :func:`viscoroll.tables.build` or :func:`viscoroll.tables.load`.
    fields : a name or names out of the table's fields; default all, which need a coordinate on
        every axis.
    **points : coordinates, numbers or arrays that broadcast, in the table's units: ``V``, ``delta``
        and, where the table has it, ``alpha``.  ``delta`` is needed for beta and Q only.

    Returns
    -------
    Values
        The fields as attributes, in the units of the table, arrays of the broadcast shape of all
        coordinates; floats if all coordinates are numbers.

    Raises
    ------
    OutOfTableError
        A coordinate outside the axis of the table, naming the range.
    ParameterError
        An unknown field, a coordinate that is missing, unknown, NaN, infinite or of a unit of
        another dimension, shapes that do not broadcast; a mu of ``table``, or a load beside it,
        that is no finite number > 0.
    FileError
        If ``table`` is not a grid, is incomplete, or is in other units than it was built in.

    Examples
    --------
    >>> import viscoroll as vr
    >>> grid = vr.tables.build(
    ...     vr.presets.PAPER_SECTION_5, [0.1, 0.2, 0.3, 0.4], delta=[-0.1, 0.0, 0.1]
    ... )
    >>> found = vr.tables.interpolate(grid, ["M"], V=[0.15, 0.25])
    >>> found.M.shape
    (2,)

    Notes
    -----
    Tensor not-a-knot cubic spline in ln V, delta and ln alpha, of a lower degree along an axis of
    fewer than four nodes, clipped to |Q| <= mu P and 0 <= beta <= 1; the largest error at random
    points is stated in ``spline_error`` of each field, which another point may exceed
    (``tests/tables/test_grids.py``), and the point in ``spline_error_at``.  The largest errors of
    beta occur where full slip begins, as beta falls there with a vertical tangent.  Each call
    builds the splines anew, which takes most of its time; keep an :class:`tables.Interpolant` for
    repeated calls.  A law (:func:`viscoroll.tables.law`, :func:`viscoroll.contact`) has none of
    these errors.
    """
    return Interpolant(table)(fields, **points)
