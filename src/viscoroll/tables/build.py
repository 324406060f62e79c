"""Root-solve the contact law on a grid and measure what interpolation makes of it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ..errors import ParameterError
from . import schema
from .grid import ATLAS_MAPS, AtlasGrid, LiteralGrid, u_of_s
from .interpolate import spline_coefficients, spline_on_grid
from .literal import literal, of_material
from .of_material import MaterialGrid
from .solving import SEED, off_nodes, run, tolerances

if TYPE_CHECKING:
    import xarray as xr

#: Distances from u = 1, in steps, of the extra sample in the last cell, where the law is least smooth.
_NEAR_FULL_SLIP = (0.3, 0.1, 0.03, 0.01)
_SAMPLE = (
    "tensor product, over the axes, of the middle and a random point of every cell, and points close to s = 1; "
    f"generator seed {SEED}; a single point may exceed its block's entry by up to 1.5 times"
)


def build(
    grid: AtlasGrid | LiteralGrid | MaterialGrid,
    *,
    threads: int | None = None,
    progress: bool = False,
    command: str | None = None,
) -> xr.Dataset:
    """Table of the contact law on ``grid``, with its measured interpolation errors.

    Parameters
    ----------
    grid : :class:`AtlasGrid` -> beta and Q/mu over (alpha, kappa_V, s), lam, epsilon,
        kappa M and kappa delta_star/mu over (alpha, kappa_V), error maps over blocks of cells;
        :class:`LiteralGrid` -> beta and Q over (V, delta, alpha), lam, epsilon, M and
        delta_star over (V, alpha); :class:`MaterialGrid` -> the same without alpha, and the parts of M in
        either body.
    threads : default ``$VISCOROLL_THREADS``, else all cores; the result does not depend on it.
    progress : draw a progress bar after the first second.
    command : recorded in ``history``; default: the command line of this process.

    Returns
    -------
    xarray.Dataset
        Everything dimensionless; units, symbols, equations and measured errors in the attributes.

    Raises
    ------
    ParameterError
        If ``grid`` is no grid.
    ConvergenceError
        If a solve hits its iteration cap.

    Notes
    -----
    Nodes are root solves, good to 1e-12 of the largest value of each field; a random point between
    them is off by no more than 1.5 times what the error maps state (``tests/tables/test_tables.py``).
    """
    if isinstance(grid, AtlasGrid):
        return _atlas(grid, threads, progress, command)
    if isinstance(grid, LiteralGrid):
        return literal(grid, threads, progress, command)
    if isinstance(grid, MaterialGrid):
        return of_material(grid, command)
    raise ParameterError("grid", f"a {type(grid).__name__}", "an AtlasGrid, a LiteralGrid or a MaterialGrid")


def solve_atlas(
    axes: dict[str, NDArray], threads: int | None = None, label: str | None = None
) -> dict[str, NDArray[np.float64]]:
    """Fields of the atlas on the tensor product of ``axes`` (alpha, kappa_V, s), by root solves.

    Raises
    ------
    ConvergenceError
        If a solve hits its iteration cap.
    """
    from ..kernels.law.table_loops import ATLAS_PLANE, ATLAS_VOLUME, atlas_loop

    alpha, kappa_V, s = axes.values()
    pairs = alpha.size * kappa_V.size
    plane = np.empty((len(ATLAS_PLANE), pairs))
    volume = np.empty((len(ATLAS_VOLUME), pairs, s.size))
    run(lambda start, stop: atlas_loop(alpha, kappa_V, s, plane, volume, start, stop), pairs, threads, label)
    fields: dict[str, NDArray] = {
        name: row.reshape(alpha.size, kappa_V.size) for name, row in zip(ATLAS_PLANE, plane, strict=True)
    }
    for name, row in zip(ATLAS_VOLUME, volume, strict=True):
        fields[name] = row.reshape(alpha.size, kappa_V.size, s.size)
    return fields


def atlas_errors(
    axes: dict[str, NDArray], fields: dict[str, NDArray], threads: int | None = None, label: str | None = None
) -> tuple[dict[str, NDArray], dict[str, NDArray]]:
    """|spline - root solve| off the nodes: the sample's spline coordinates, and the errors by field.

    The sample is the tensor product, over the axes, of the middle and a random point of each
    cell, plus points close to s = 1.
    """
    random = np.random.default_rng(SEED)
    mapped = {name: ATLAS_MAPS[name][0](nodes) for name, nodes in axes.items()}
    sample = {name: off_nodes(nodes, random) for name, nodes in mapped.items()}
    close = 1.0 - np.array(_NEAR_FULL_SLIP) * (1.0 - mapped["s"][-2])
    sample["s"] = np.sort(np.concatenate([sample["s"], close]))
    points = {name: ATLAS_MAPS[name][1](values) for name, values in sample.items()}
    # what a user passes is s, not u: the spline must be asked at the u that s gives back
    sample["s"] = u_of_s(points["s"])
    exact = solve_atlas(points, threads, label)
    errors = {}
    for name, values in fields.items():
        dims = schema.VARIABLES["atlas"][name]
        knots, coefficients = spline_coefficients(values, [mapped[dim] for dim in dims])
        errors[name] = np.abs(spline_on_grid(knots, coefficients, [sample[dim] for dim in dims]) - exact[name])
    return sample, errors


def _block_edges(nodes: NDArray, cells: int) -> NDArray:
    """Every ``cells``-th node and the last one."""
    return np.append(nodes[:-1:cells], nodes[-1])


def _block_maxima(errors: NDArray, sample: list[NDArray], edges: list[NDArray]) -> NDArray:
    """Largest error in each block of cells."""
    for n, (points, edge) in enumerate(zip(sample, edges, strict=True)):
        errors = np.maximum.reduceat(errors, np.searchsorted(points, edge[:-1]), axis=n)
    return errors


def _atlas(grid: AtlasGrid, threads: int | None, progress: bool, command: str | None) -> xr.Dataset:
    import xarray as xr

    axes = grid.axes()
    fields = solve_atlas(axes, threads, "atlas: nodes" if progress else None)
    sample, errors = atlas_errors(axes, fields, threads, "atlas: error map" if progress else None)
    coordinates = {name: schema.variable(name, (name,), nodes, **_spacing(name)) for name, nodes in axes.items()}
    variables = {}
    allowed = dict(zip(("Q_over_mu", "beta"), grid.allowed, strict=True))
    for name, values in fields.items():
        extra = {"interpolation_error": float(errors[name].max())}
        if name in allowed:
            extra["interpolation_error_allowed"] = float(allowed[name])
        variables[name] = schema.variable(name, schema.VARIABLES["atlas"][name], values, **extra)
    _add_error_maps(grid, sample, errors, coordinates, variables)
    measured = {name: error.max() for name, error in errors.items()}
    attributes = schema.global_attributes(
        "atlas",
        "Contact of a viscoelastic cylinder rolling with partial slip: universal table in similarity variables",
        "alpha and kappa_V in equal ratios; s = 1 - (1 - u)^2 with u uniform on [0, 1]; nodes "
        + " x ".join(f"{nodes.size} ({name})" for name, nodes in axes.items()),
        tolerances("of the tensor cubic spline", measured, allowed),
        command,
    )
    return xr.Dataset(variables, coordinates, attributes)


def _spacing(name: str) -> dict[str, str]:
    return {"spacing": "s = 1 - (1 - u)^2, u uniform" if name == "s" else f"uniform in ln {name}"}


def _add_error_maps(
    grid: AtlasGrid, sample: dict[str, NDArray], errors: dict[str, NDArray], coordinates: dict, variables: dict
) -> None:
    """Error maps, and the middles and edges of their blocks, into the two dictionaries."""
    edges = {}
    for (name, nodes), cells in zip(grid.axes().items(), grid.block, strict=True):
        forward, back = ATLAS_MAPS[name]
        edges[name] = forward(_block_edges(nodes, cells))
        blocks = {
            f"block_{name}": back(0.5 * (edges[name][1:] + edges[name][:-1])),
            f"block_{name}_edge": _block_edges(nodes, cells),
        }
        coordinates |= {block: schema.variable(block, (block,), values) for block, values in blocks.items()}
    for name in ("beta", "Q_over_mu"):
        maxima = _block_maxima(errors[name], list(sample.values()), list(edges.values()))
        variables[f"error_{name}"] = schema.variable(
            f"error_{name}", schema.VARIABLES["atlas"][f"error_{name}"], maxima, sample=_SAMPLE
        )
