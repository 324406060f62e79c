"""The contact law on a grid: what look-up blocks of other programs read."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from ...contact_law.contact import contact
from ...core.array_types import Floats
from ...core.errors import ParameterError
from ...cylinder import Cylinder
from ...materials.law.netcdf import bodies_as_toml, parse_law
from ...materials.law.table import LawTable
from ...materials.law_file import dataset_content
from ...materials.prony_forms import HIGHEST_ALPHA
from ...scene import Scene
from . import schema
from .interpolate import Interpolant
from .nodes import MAX_NODES, increasing

if TYPE_CHECKING:
    import xarray as xr

#: Random points that a stated error is the largest over, and their seed: it can be had again.
SAMPLE, SEED = 100_000, 20260102
#: Fields whose difference of two methods is relative at every node.  The printed forms of the others lose relative
#: digits where they are small beside their largest value (kernels/printed/law.py).
RELATIVE = ("lam", "zeta", "delta_star")
#: of a scene, and of a cylinder: the numbers among the attributes, and what all is counted in
_NUMBERS = ("alpha", "kappa", "mu"), ("R", "m", "mu", "load")
_UNITS = "dimensionless", "in SI units, per m of length"


def build(
    what: Scene | Cylinder | LawTable | xr.Dataset,
    V: ArrayLike,
    *,
    delta: ArrayLike,
    alpha: ArrayLike | None = None,
    method: Literal["table", "direct"] = "table",
    command: str | None = None,
) -> xr.Dataset:
    """Table of the contact over (V, delta) or (V, delta, alpha), with what interpolation makes of it.

    Parameters
    ----------
    what : a :class:`Scene`, dimensionless; a :class:`Cylinder`, in SI units; a law, of :func:`viscoroll.load_law` or
        :func:`viscoroll.io.tables.law`: then kappa = mu = 1: V is kappa V, delta kappa delta/mu, Q Q/mu and M
        kappa M.  Its numbers are single.
    V : speeds of the axis, > 0, strictly increasing; for V < 0 see the signs of Eqs. (17), (18).
    delta : creep ratios, any sign, strictly increasing.
    alpha : strictly increasing, in place of that of a scene without a material.
    method : as of :func:`contact`: "table", from the rows of the law, or "direct", by root solves of the printed
        equations, of one relaxation time; the rows are then evaluated too, and ``difference_from_rows`` of a field is
        the largest difference: of lam, zeta and delta_star relative, of other fields over their largest value.
    command : recorded in ``history``; default: the command line of this process.

    Returns
    -------
    xarray.Dataset
        beta and Q over all axes; lam, epsilon, M, its parts in both bodies, delta_star and zeta over V (and alpha);
        units, symbols, equations in the attributes.  Nodes have the bits of :func:`contact`.  ``spline_error`` of a
        field is the largest absolute error of :func:`interpolate`, ``linear_error`` that of linear interpolation in
        the axes as they stand, over 10^5 random points in random cells; ``spline_error_at`` and ``linear_error_at``
        name the point, as in "V = 0.31, delta = 0.0042".

    Raises
    ------
    ParameterError
        Where ``what`` is none of these or has arrays, an axis is out of range or does not increase; an unknown method,
        or "direct" of a material.

    Notes
    -----
    For programs that look up tables.  The file of a law is smaller and exact (:func:`viscoroll.io.tables.law`).
    """
    import xarray as xr

    what = _single(what)
    axes = {"V": increasing("V", V, unit=what.scale, low=0.0, strict=True), "delta": increasing("delta", delta)}
    if alpha is not None:
        if isinstance(what, Cylinder) or what.material is not None:
            raise ParameterError("alpha", "given", "left out: the material has its own")
        axes["alpha"] = increasing("alpha", alpha, low=1.0, high=HIGHEST_ALPHA)
    if math.prod(nodes.size for nodes in axes.values()) > MAX_NODES:
        raise ParameterError(", ".join(axes), "their product", f"at most {MAX_NODES} nodes in all")
    fields = _on_nodes(what, axes, method)
    si = isinstance(what, Cylinder)
    plane = tuple(name for name in axes if name != "delta")
    data = {
        name: schema.variable(name, plane if name in schema.PLANE else tuple(axes), values, si)
        for name, values in fields.items()
    }
    coordinates = {name: schema.variable(name, (name,), nodes, si) for name, nodes in axes.items()}
    title = f"Contact of a viscoelastic cylinder rolling with partial slip, {_UNITS[si]}"
    of = ", ".join(f"{name} {nodes.size} in [{nodes[0]:g}, {nodes[-1]:g}]" for name, nodes in axes.items())
    table = xr.Dataset(data, coordinates, schema.global_attributes(title, of, command) | {"method": method})
    material = what.pair if isinstance(what, Cylinder) else what.material
    numbers = {name: float(getattr(what, name)) for name in _NUMBERS[si] if name not in axes}
    table.attrs |= numbers | ({} if material is None else {"material": bodies_as_toml(material)})
    _state_errors(table, what)
    if method == "direct":
        for name, difference in differences(table, what).items():
            table[name].attrs["difference_from_rows"] = difference
    return table


def _single(what: Any) -> Scene | Cylinder:
    """What has the contact: a law at kappa = mu = 1."""
    if getattr(what, "attrs", {}).get(schema.KIND) == "law":
        what = parse_law(dataset_content(what), "law")
    if isinstance(what, LawTable):
        what = Scene(kappa=1.0, mu=1.0, material=what)
    if not isinstance(what, Scene | Cylinder):
        raise ParameterError("what", f"{what!r:.60}", "a Scene, a Cylinder or a law")
    shape = (what if isinstance(what, Scene) else what.scene()).shape
    if shape:
        raise ParameterError("what", f"of shape {shape}", "one scene, of single numbers")
    return what


def _on_nodes(what: Scene | Cylinder, axes: dict[str, Floats], method: str) -> dict[str, Floats]:
    """All fields on the nodes of a grid.

    Parameters
    ----------
    what : of single numbers.
    axes : V, delta and perhaps alpha -> nodes.
    method : "table" or "direct".

    Returns
    -------
    Field -> values over all axes, or over V and alpha, of those that creep does not change.
    """
    grid = dict(zip(axes, np.meshgrid(*axes.values(), indexing="ij", sparse=True), strict=True))
    plane = {name: nodes for name, nodes in grid.items() if name != "delta"}
    flat = _fields(what, plane, schema.PLANE, method)
    volume = _fields(what, grid, schema.VOLUME, method)
    return volume | {name: np.take(values, 0, axis=1) for name, values in flat.items()}


def _fields(
    what: Scene | Cylinder, at: dict[str, Floats], names: tuple[str, ...], method: Any = "table"
) -> dict[str, Floats]:
    """Fields at V, perhaps delta, and perhaps an alpha each."""
    one = what.replace(alpha=at["alpha"]) if "alpha" in at else what
    creep = at.get("delta", np.zeros(1))
    return contact(one, at["V"], delta=creep, fields=names, method=method).as_dict()


def _difference(name: str, direct: Floats, rows: Floats) -> float:
    """Largest difference of two ways to a field, relative, or over the largest value of the field."""
    scale = np.abs(rows) if name in RELATIVE else np.abs(rows).max()
    return float(np.max(np.abs(direct - rows) / np.where(scale > 0.0, scale, 1.0)))


def _state_errors(table: xr.Dataset, what: Scene | Cylinder) -> None:
    """Put the largest errors of both ways to interpolate, and where they occur, into the attributes of the fields.

    Parameters
    ----------
    table : the grid; its fields gain ``spline_error``, ``spline_error_at``, ``linear_error``, ``linear_error_at``.
    what : the scene or cylinder that the grid is of, for the exact values at the random points.
    """
    points = random_points(table, SAMPLE, SEED)
    for key, linear in (("spline_error", False), ("linear_error", True)):
        for name, errors in errors_at(table, what, points, linear).items():
            worst = int(errors.argmax())
            place = ((dim, points[str(dim)][worst]) for dim in table[name].dims)
            table[name].attrs[key] = float(errors[worst])
            table[name].attrs[f"{key}_at"] = ", ".join(f"{dim} = {at:.6g}" for dim, at in place)


def errors_at(
    table: xr.Dataset, what: Scene | Cylinder, points: dict[str, Floats], linear: bool = False
) -> dict[str, Floats]:
    """Absolute errors of interpolation in a grid.

    Parameters
    ----------
    table : the grid.
    what : that it is of.
    points : axis -> coordinates, all of one length.
    linear : of linear interpolation, in place of splines.

    Returns
    -------
    Field -> its errors at the points.
    """
    exact = _fields(what, points, schema.VOLUME + schema.PLANE)
    found = Interpolant(table, linear)(**points)
    return {name: np.abs(found[name] - exact[name]) for name in schema.fields_of(table)}


def random_points(table: xr.Dataset, count: int, seed: int) -> dict[str, Floats]:
    """Random points in random cells of a grid: axis -> ``count`` coordinates."""
    random = np.random.default_rng(seed)
    return {name: _between(table[name].values, count, random) for name in schema.axes_of(table)}


def differences(table: xr.Dataset, what: Scene | Cylinder) -> dict[str, float]:
    """Largest difference of the nodes of a grid from the rows of the law, by field: relative, or over the largest."""
    rows = _on_nodes(what, {name: table[name].values for name in schema.axes_of(table)}, "table")
    return {name: _difference(name, table[name].values, values) for name, values in rows.items() if name in table}


def _between(nodes: Floats, count: int, random: np.random.Generator) -> Floats:
    """Random points within random cells of an axis; its node where it has only one."""
    if nodes.size == 1:
        return np.full(count, nodes[0])
    cell = random.integers(nodes.size - 1, size=count)
    return nodes[cell] + random.random(count) * (nodes[cell + 1] - nodes[cell])
