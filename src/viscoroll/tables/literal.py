"""Tables at one kappa and mu: over (V, delta, alpha), or over (V, delta) of one material."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..materials.bodies import Bodies
from . import schema
from .grid import LiteralGrid
from .of_material import MaterialGrid, solve
from .solving import SEED, off_nodes, run, tolerances

if TYPE_CHECKING:
    import xarray as xr

#: A literal table is sampled at about so many points along an axis, or else at the middle of every cell.
_ALONG = 128


def solve_literal(
    grid: LiteralGrid, axes: dict[str, NDArray], threads: int | None = None, label: str | None = None
) -> dict[str, NDArray[np.float64]]:
    """Fields of a literal table on the tensor product of ``axes`` (V, delta, alpha), by root solves.

    Raises
    ------
    ConvergenceError
        If a solve hits its iteration cap.
    """
    from ..kernels.law.table_loops import LITERAL_PLANE, LITERAL_VOLUME, literal_loop

    V, delta, alpha = axes.values()
    pairs = V.size * alpha.size
    plane = np.empty((len(LITERAL_PLANE), pairs))
    volume = np.empty((len(LITERAL_VOLUME), pairs, delta.size))

    def solve(start: int, stop: int) -> int:
        return literal_loop(V, delta, alpha, grid.kappa, grid.mu, plane, volume, start, stop)

    run(solve, pairs, threads, label)
    fields: dict[str, NDArray] = {
        name: row.reshape(V.size, alpha.size) for name, row in zip(LITERAL_PLANE, plane, strict=True)
    }
    for name, row in zip(LITERAL_VOLUME, volume, strict=True):
        fields[name] = np.ascontiguousarray(row.reshape(V.size, alpha.size, delta.size).swapaxes(1, 2))
    return fields


def _linear_errors(
    axes: dict[str, NDArray], fields: dict[str, NDArray], solve: Callable[[dict[str, NDArray]], dict[str, NDArray]]
) -> dict[str, float]:
    """Largest |linear - root solve| off the nodes of V and delta, at the alphas of the grid where it has some.

    The sample is the tensor product of the middles of the cells and, along a coarse axis, random points of each:
    there the largest error may be far from the middle, and one that is odd about it is 0 there.
    """
    random = np.random.default_rng(SEED)
    points = axes | {
        dim: off_nodes(axes[dim], random, _ALONG // (axes[dim].size - 1))
        for dim in ("V", "delta")
        if axes[dim].size > 1
    }
    exact, kind = solve(points), "literal" if "alpha" in axes else "material"
    errors = {}
    for name, values in fields.items():
        linear = values
        for n, dim in enumerate(schema.VARIABLES[kind][name]):
            if points[dim] is not axes[dim]:
                linear = _linear(axes[dim], linear, points[dim], n)
        errors[name] = float(np.abs(linear - exact[name]).max())
    return errors


def _linear(nodes: NDArray, values: NDArray, points: NDArray, axis: int) -> NDArray:
    """``values`` at ``nodes`` along an axis, linearly interpolated to ``points``."""
    cell = np.searchsorted(nodes, points) - 1
    shape = [-1 if n == axis else 1 for n in range(values.ndim)]
    share = ((points - nodes[cell]) / (nodes[cell + 1] - nodes[cell])).reshape(shape)
    return (1.0 - share) * np.take(values, cell, axis) + share * np.take(values, cell + 1, axis)


def literal(grid: LiteralGrid, threads: int | None, progress: bool, command: str | None) -> xr.Dataset:
    """The table over (V, delta, alpha) of a grid, with the errors of linear interpolation."""
    import xarray as xr

    axes = grid.axes()
    fields = solve_literal(grid, axes, threads, "table: nodes" if progress else None)
    label = "table: errors" if progress else None
    errors = _linear_errors(axes, fields, lambda points: solve_literal(grid, points, threads, label))
    coordinates, variables, shape = _laid_out("literal", grid, fields, errors)
    attributes = schema.global_attributes(
        "literal",
        f"Contact of a viscoelastic cylinder rolling with partial slip at kappa = {grid.kappa:g}, mu = {grid.mu:g}",
        f"kappa = {grid.kappa:g}, mu = {grid.mu:g}; {shape}",
        tolerances("of linear interpolation in V and delta, at the alphas of the table,", errors, {}),
        command,
    )
    return xr.Dataset(variables, coordinates, attributes)


def _laid_out(
    kind: str, grid: LiteralGrid | MaterialGrid, fields: dict[str, NDArray], errors: dict[str, float]
) -> tuple[dict[str, Any], dict[str, Any], str]:
    """(coordinates, variables, the axes in words) of a table at one kappa and mu."""
    axes = grid.axes()
    coordinates = {name: schema.variable(name, (name,), nodes) for name, nodes in axes.items()}
    coordinates |= {name: schema.variable(name, (), getattr(grid, name)) for name in ("kappa", "mu")}
    variables = {
        name: schema.variable(name, schema.VARIABLES[kind][name], fields[name], interpolation_error=errors[name])
        for name in fields
    }
    shape = ", ".join(f"{name} {nodes.size} in [{nodes[0]:g}, {nodes[-1]:g}]" for name, nodes in axes.items())
    return coordinates, variables, shape


def of_material(grid: MaterialGrid, command: str | None) -> xr.Dataset:
    """The table over (V, delta) of one material or of a pair, likewise."""
    import xarray as xr

    scene, axes, law = grid.scene(), grid.axes(), grid.pair.law
    fields = solve(scene, axes)
    errors = _linear_errors(axes, fields, lambda points: solve(scene, points))
    coordinates, variables, shape = _laid_out("material", grid, fields, errors)
    coordinates["T_ref"] = schema.variable("T_ref", (), grid.pair.T_ref)
    coordinates["V"].attrs["long_name"] = "velocity of the axis times T_ref/R"
    series = law.total if isinstance(law, Bodies) else law
    coordinates["mode"] = schema.variable("mode", ("mode",), np.arange(1.0, series.E.size + 1.0))
    for name, values in (("relaxation_strength", series.E), ("relaxation_time", series.tau)):
        variables[name] = schema.variable(name, ("mode",), values)
    names = [body.name or "a material without a name" for body in (grid.material, grid.base) if body is not None]
    attributes = schema.global_attributes(
        "material",
        f"Rolling contact with partial slip of {' on '.join(names)} at kappa = {grid.kappa:g}, mu = {grid.mu:g}",
        f"kappa = {grid.kappa:g}, mu = {grid.mu:g}; {shape}",
        tolerances("of linear interpolation in V and delta", errors, {}),
        command,
    )
    return xr.Dataset(variables, coordinates, attributes | {"material": grid.described()})
