"""A table against direct solves of the printed equations, at random nodes and between them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ..errors import ParameterError, TableError
from ..tables import interpolate, schema
from ..tables.accuracy import exact_fields, random_between
from ..tables.grid import ATLAS_MAPS
from .report import Check

if TYPE_CHECKING:
    import xarray as xr

#: Nodes are root solves; the printed form of M rounds at 1e-13 kappa V/100 (tests/kernels/printed/test_direct.py).
NODE_ALLOWED = 2e-12
#: The stated error is the largest of a sample; twice that bounds a kink anywhere in a cell whose middle was sampled.
SAMPLE_ALLOWANCE = 2.0


def check_table(table: xr.Dataset, count: int, seed: int) -> list[Check]:
    """Compare ``table`` with method "direct" at ``count`` random nodes, and as many points between.

    Parameters
    ----------
    table : of :func:`viscoroll.tables.load`.
    count : >= 1.
    seed : of the random points, >= 0.

    Returns
    -------
    list of Check
        Per field: the nodes against :data:`NODE_ALLOWED` of its largest value (at least of 1);
        interpolation against the error that the file states, times :data:`SAMPLE_ALLOWANCE`;
        the stated error against the allowed one where the file names it.

    Raises
    ------
    ParameterError
        A count or seed out of range.
    TableError
        A table that does not state its errors.
    """
    if count < 1:
        raise ParameterError("n", count, "a whole number >= 1")
    if seed < 0:
        raise ParameterError("seed", seed, "a whole number >= 0")
    kind = table.attrs[schema.KIND]
    random = np.random.default_rng(seed)
    axes = {name: table[name].values for name in schema.AXES[kind]}
    index = {name: random.integers(nodes.size, size=count) for name, nodes in axes.items()}
    at_nodes = exact_fields(table, {name: nodes[index[name]] for name, nodes in axes.items()}, "direct")
    points = {name: _between(kind, name, nodes, random, count) for name, nodes in axes.items()}
    exact, tabulated = exact_fields(table, points, "direct"), interpolate(table, **points)
    checks = []
    for name in schema.FIELDS[kind]:
        field = table[name]
        node_values = field.values[tuple(index[str(dim)] for dim in field.dims)]
        stated = field.attrs.get("interpolation_error")
        if stated is None:
            raise TableError(table.encoding.get("source", "table"), f"{name!r} states no interpolation_error")
        rounding = NODE_ALLOWED * max(1.0, float(np.abs(field).max()))
        row, error = f"{kind} table: {name}", _largest(getattr(tabulated, name), exact[name])
        against = f"absolute; {count} points, against direct solves"
        checks.append(Check(f"{row} at nodes", _largest(node_values, at_nodes[name]), rounding, against))
        checks.append(Check(f"{row} between nodes", error, SAMPLE_ALLOWANCE * stated + rounding, against))
        if "interpolation_error_allowed" in field.attrs:
            limit = field.attrs["interpolation_error_allowed"]
            checks.append(Check(f"{row} as stated", stated, limit, "absolute; the error that the file states"))
    return checks


def _largest(values: NDArray, exact: NDArray) -> float:
    return float(np.max(np.abs(values - exact)))


def _between(kind: str, name: str, nodes: NDArray, random: np.random.Generator, count: int) -> NDArray:
    """Random points within random cells, even in the coordinate in which the table is interpolated."""
    if (kind, name) == ("literal", "alpha"):
        return random.choice(nodes, count)  # the stated error is that at the table's alphas
    forward, back = ATLAS_MAPS[name] if kind == "atlas" else (np.asarray, np.asarray)
    return np.clip(back(random_between(forward(nodes), random, count)), nodes[0], nodes[-1])
