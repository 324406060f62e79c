"""The exact law at a table's coordinates, and what plain linear interpolation makes of the table."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import NDArray

from ..rolling_contact import contact
from ..scene import Scene
from . import schema
from .of_material import state_of

if TYPE_CHECKING:
    import xarray as xr

#: Random points that an error is the largest over, and their seed: the error can be had again.
SAMPLE, SEED = 1_000_000, 20260102


def exact_fields(
    table: xr.Dataset, points: dict[str, NDArray], method: Literal["table", "direct"] = "table"
) -> dict[str, NDArray]:
    """All fields of ``table`` at ``points`` of its axes by :func:`viscoroll.contact` with ``method``."""
    kind = table.attrs[schema.KIND]
    if kind == "literal":
        scene = Scene(points["alpha"], table["kappa"].item(), table["mu"].item())
        return contact(scene, points["V"], delta=points["delta"], fields=schema.FIELDS[kind], method=method).as_dict()
    if kind == "material":
        return state_of(table, points, method)
    # mu = kappa = 1 turns V into kappa V, Q into Q/mu, M into kappa M, delta_star into kappa delta_star/mu
    scene, V = Scene(points["alpha"], 1.0, 1.0), points["kappa_V"]
    plane = contact(scene, V, delta=0.0, fields=("lam", "epsilon", "M", "delta_star"), method=method)
    volume = contact(scene, V, delta=points["s"] * plane.delta_star, fields=("beta", "Q"), method=method)
    return {
        "lam": plane.lam, "epsilon": plane.epsilon, "kappa_M": plane.M, "kappa_delta_star_over_mu": plane.delta_star,
        "beta": volume.beta, "Q_over_mu": volume.Q,
    }  # fmt: skip


def random_between(nodes: NDArray, random: np.random.Generator, count: int) -> NDArray[np.float64]:
    """Random points within random cells of an axis; its node where it has only one."""
    if nodes.size == 1:
        return np.full(count, nodes[0])
    cell = random.integers(nodes.size - 1, size=count)
    return nodes[cell] + random.random(count) * (nodes[cell + 1] - nodes[cell])


def linear_errors(table: xr.Dataset, at_nodes: Iterable[str] = ()) -> dict[str, float]:
    """Largest absolute error of linear interpolation in all axes as they stand, against the exact law.

    Parameters
    ----------
    table : of :func:`viscoroll.tables.build` or :func:`viscoroll.tables.load`.
    at_nodes : axes along which only nodes are looked at.

    Returns
    -------
    dict
        Field -> the largest over :data:`SAMPLE` random points in random cells.  A single point
        may exceed it slightly (tests/tables/test_export.py).
    """
    from scipy.interpolate import RegularGridInterpolator

    kind, random = table.attrs[schema.KIND], np.random.default_rng(SEED)
    axes = {name: table[name].values for name in schema.AXES[kind]}
    points = {
        name: random.choice(nodes, SAMPLE) if name in at_nodes else random_between(nodes, random, SAMPLE)
        for name, nodes in axes.items()
    }
    exact, errors = exact_fields(table, points), {}
    for name in schema.FIELDS[kind]:
        dims = [dim for dim in schema.VARIABLES[kind][name] if axes[dim].size > 1]
        values = table[name].values.squeeze()
        if dims:
            linear = RegularGridInterpolator([axes[dim] for dim in dims], values)
            values = linear(np.column_stack([points[dim] for dim in dims]))
        errors[name] = float(np.abs(values - exact[name]).max())
    return errors
