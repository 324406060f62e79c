"""Values between the nodes: tensor cubic splines for the atlas, linear for the others."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..blocks import flattened
from ..checks import broadcast_shape, checked
from ..errors import OutOfTableError, ParameterError, unknown
from ..rolling_contact import Values
from . import schema
from .grid import ATLAS_MAPS

if TYPE_CHECKING:
    import xarray as xr

CUBIC = 3


def spline_coefficients(values: NDArray, axes: list[NDArray]) -> tuple[list[NDArray], NDArray]:
    """Knots of each axis and coefficients of the tensor not-a-knot cubic through ``values``."""
    from scipy.interpolate import make_interp_spline

    knots = []
    for n, axis in enumerate(axes):
        spline = make_interp_spline(axis, values, k=CUBIC, axis=n)
        knots.append(spline.t)
        values = np.moveaxis(spline.c, 0, n)
    return knots, np.ascontiguousarray(values)


def spline_on_grid(knots: list[NDArray], coefficients: NDArray, axes: list[NDArray]) -> NDArray:
    """The spline on the tensor product of ``axes``: one dimension at a time, far cheaper than point by point."""
    from scipy.interpolate import BSpline

    for n, (t, x) in enumerate(zip(knots, axes, strict=True)):
        coefficients = BSpline(t, coefficients, CUBIC, axis=n)(x)
    return coefficients


class Interpolant:
    """A table ready for repeated interpolation; what :func:`interpolate` builds on each call.

    Called with fields and points, it returns and raises what :func:`interpolate` does, with the same errors.

    Parameters
    ----------
    table : a Dataset of :func:`viscoroll.tables.build` or :func:`viscoroll.tables.load`.
        Coefficients are made once a field, at its first use, from the values of that time.

    Raises
    ------
    TableError
        If it is not a table.
    """

    def __init__(self, table: xr.Dataset) -> None:
        self.kind = schema.check(table, "interpolate")
        self._table = table
        self._evaluators: dict[str, Any] = {}

    def __call__(self, fields: Iterable[str] | None = None, **points: ArrayLike) -> Values:
        """Interpolated ``fields`` at ``points``; see :func:`interpolate`."""
        names = self._field_names(fields)
        flat, shape = self._checked_points(points, names)
        results = {}
        for name in names:
            dims = schema.VARIABLES[self.kind][name]
            columns = [flat[dim] for dim in dims]
            xi = np.column_stack([np.broadcast_to(column, (int(np.prod(shape)),)) for column in columns])
            values = self._evaluator(name)(xi).reshape(shape)
            results[name] = values if shape else values.item()
        return Values(results)

    def _field_names(self, fields: Iterable[str] | None) -> tuple[str, ...]:
        known = schema.FIELDS[self.kind]
        names = known if fields is None else (fields,) if isinstance(fields, str) else tuple(fields)
        for name in names:
            if name not in known:
                raise unknown("fields", name, known, "a field of this table")
        return names

    def _checked_points(
        self, points: dict[str, ArrayLike], names: tuple[str, ...]
    ) -> tuple[dict[str, NDArray], tuple[int, ...]]:
        """Flattened coordinates in which the interpolation runs, and the shape of the answer."""
        axes = schema.AXES[self.kind]
        needed = {dim for name in names for dim in schema.VARIABLES[self.kind][name]}
        if not needed <= points.keys() or not points.keys() <= set(axes):
            allowed = f"{', '.join(axes)} (needed for these fields: {', '.join(a for a in axes if a in needed)})"
            raise ParameterError("coordinates", ", ".join(points) or "none", allowed)
        arrays = {name: checked(name, value) for name, value in points.items()}
        shape = broadcast_shape(**arrays)
        for name, array in arrays.items():
            low, high = self._table[name].values[[0, -1]]
            outside = (array < low) | (array > high)
            if outside.any():
                raise OutOfTableError(name, array[outside].flat[0] if array.ndim else float(array), low, high)
        return {name: self._mapped(name, flattened(array, shape)) for name, array in arrays.items()}, shape

    def _mapped(self, name: str, values: NDArray) -> NDArray:
        return ATLAS_MAPS[name][0](values) if self.kind == "atlas" else values

    def _evaluator(self, name: str) -> Any:
        if name not in self._evaluators:
            self._evaluators[name] = self._new_evaluator(name)
        return self._evaluators[name]

    def _new_evaluator(self, name: str) -> Any:
        from scipy.interpolate import NdBSpline, RegularGridInterpolator

        values = self._table[name].values
        axes = [self._mapped(dim, self._table[dim].values) for dim in schema.VARIABLES[self.kind][name]]
        if self.kind == "atlas":
            knots, coefficients = spline_coefficients(values, axes)
            return NdBSpline(tuple(knots), coefficients, CUBIC)
        return RegularGridInterpolator(tuple(axes), values, method="linear")


def interpolate(table: xr.Dataset, fields: Iterable[str] | None = None, **points: ArrayLike) -> Values:
    """Fields of a table between its nodes; nothing is extrapolated.

    Parameters
    ----------
    table : Dataset of :func:`viscoroll.tables.build` or :func:`viscoroll.tables.load`.
    fields : names out of the table's fields; default all.
    **points : ``alpha``, ``kappa_V``, ``s`` for an atlas (``s`` only where beta or Q_over_mu
        is asked for), ``V``, ``delta``, ``alpha`` for a literal table, ``V``, ``delta`` for that of a
        material; they broadcast.

    Returns
    -------
    Values
        The fields as attributes; scalars if all coordinates are.

    Raises
    ------
    OutOfTableError
        A coordinate outside the axis of the table, naming the range.
    ParameterError
        An unknown field, a coordinate that is missing, unknown, NaN or infinite, shapes that
        do not broadcast.
    TableError
        If ``table`` is not a table.

    Notes
    -----
    Atlas: tensor not-a-knot cubic spline in (ln alpha, ln kappa V, u = 1 - sqrt(1 - s)); the
    errors are those stored in the table, which a single point may exceed by up to 1.5 times
    (``tests/tables/test_tables.py``).  The others: linear in V, delta and alpha, what
    other tools do by default; a higher order would ring at the kink |delta| = delta_star,
    which crosses their cells.  Each call builds the splines anew, which takes most of its time;
    keep an :class:`Interpolant` for repeated calls.
    """
    return Interpolant(table)(fields, **points)
