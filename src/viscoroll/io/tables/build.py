"""The contact law on a grid, for look-up blocks of other programs.

Fields: beta, length of the stick zone divided by contact length; Q, creep force; lam, contact length divided by that at
rest; epsilon, shift of the contact in half contact lengths; M, rolling moment, and its parts M_half_space and
M_cylinder; delta_star, creepage at which full slip begins; delta_0, creepage of free rolling, of a layer; zeta, time in
which a point passes through half the contact.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from ...contact_law.contact import contact
from ...contact_law.coupled_table import coupled_law
from ...core.array_types import Floats
from ...core.errors import ParameterError, described_error
from ...cylinder import Cylinder
from ...materials.law.netcdf import bodies_as_toml, law_as_dataset
from ...materials.law.table import LawTable
from ...materials.prony_forms import HIGHEST_ALPHA
from ...scene import Scene
from . import schema
from .interpolate import Interpolant
from .nodes import MAX_NODES, increasing, roller_of

if TYPE_CHECKING:
    import xarray as xr

#: Random points over which a stated error is the largest.
SAMPLE_SIZE = 100_000
#: Seed of these points, so that the error can be reproduced.
SEED = 20260102
#: Fields whose difference of two methods is relative at every node.  The printed forms of other fields lose relative
#: digits where they are small beside their largest value (kernels/printed/law.py), which is their scale.
RELATIVE_FIELDS = ("lam", "zeta", "delta_star")
#: Attributes with the parameters of a scene.
_SCENE_NUMBERS = ("alpha", "kappa", "mu")
#: Attributes with the parameters of a cylinder.
_CYLINDER_NUMBERS = ("R", "m", "mu", "load")


def build(
    what: Scene | Cylinder | LawTable | xr.Dataset,
    V: ArrayLike | None = None,
    *,
    delta: ArrayLike | None = None,
    alpha: ArrayLike | None = None,
    method: Literal["table", "direct", "coupled"] = "table",
    nodes: tuple[int, int] | None = None,
    progress: bool = False,
    command: str | None = None,
) -> xr.Dataset:
    """Compute a table of the contact over (V, delta) or (V, delta, alpha), and its errors of interpolation.

    Parameters
    ----------
    what : a :class:`Scene`, dimensionless; a :class:`Cylinder`, in SI units; or the law of half-spaces, of
        :func:`viscoroll.load_law` or the dataset of :func:`viscoroll.io.tables.law`.  A law is taken with kappa = mu =
        1: the axis V then means kappa V, delta means kappa delta/mu, Q means Q/mu and M means kappa M.  The law of a
        layer has no such scale, since delta_0 does not vary with mu: it is refused, as is the law of every alpha.  All
        parameters are numbers, no arrays.
    V : speeds of the axis, (n,), > 0, strictly increasing, divided by R/T_ref (T_ref is T_epsilon of a scene with
        alpha) or in m/s; for V < 0 the attribute ``comment`` states which fields change their sign.  A number, here and
        below, is an axis of one node.
    delta : creepages, (n,), dimensionless, any sign, strictly increasing.
    alpha : values of alpha, (n,), in [1, 1e12], strictly increasing, in place of that of a scene without a material;
        None: no such axis.
    method : "table": fields are evaluated from the rows of the law.  "direct": they are found by root solves of the
        equations as the paper prints them, which have one relaxation time; the rows are evaluated too, and the
        attribute ``difference_from_rows`` of each field is the largest difference (:func:`differences`).  "coupled":
        pressure and shear are solved together, at nodes of speed and creepage that the package chooses, so that V,
        delta and alpha are left out; the table is a law at this mu, which :func:`viscoroll.load_law` reads.
    nodes : of method "coupled", numbers of nodes over speed and over creepage, the second odd; None: 32 for each five
        decades between the rates of the bodies, and 33.
    progress : of method "coupled", whether to draw a progress bar on standard error, after one second.
    command : recorded in ``history``; default: the command line of this process.

    Returns
    -------
    xarray.Dataset
        beta and Q over (V, delta) or (V, delta, alpha); lam, epsilon, M, its parts in both bodies, delta_star and zeta
        over V (and alpha), and of a layer delta_0; units, symbols, equations in the attributes.  Nodes have the bits of
        :func:`contact` by this method.

        ``spline_error`` of a field is the largest absolute error of :func:`interpolate`, ``linear_error`` that of
        linear interpolation in the untransformed axes, over 10^5 random points in random cells; ``spline_error_at`` and
        ``linear_error_at`` name the point, as in "V = 0.31, delta = 0.0042".  Attributes of the dataset are those of a
        CF file, ``method``, the parameters of the roller (of a scene alpha, kappa and mu, of a cylinder R, m, mu and
        load) and, unless the scene has an alpha alone, ``material``, the bodies as TOML.

    Raises
    ------
    ParameterError
        Where ``what`` is none of these or has arrays; an axis is out of range or does not increase strictly; there are
        more than 5e7 nodes; ``alpha`` is given for a cylinder or for a scene with a material; an unknown method, or
        "direct" of a material; what :func:`viscoroll.contact` refuses, as kappa V above 1e300.
    FileError
        The dataset of a law that is incomplete or does not state its material.
    ConvergenceError
        Method "direct": an iteration reached its limit.

    Warns
    -----
    ModelWarning
        As :func:`viscoroll.contact`, of a Cylinder.

    Examples
    --------
    >>> import viscoroll as vr
    >>> grid = vr.tables.build(vr.presets.PAPER_SECTION_5, [0.1, 0.2, 0.3, 0.4], delta=[-0.1, 0.0, 0.1])
    >>> grid["Q"].dims
    ('V', 'delta')

    Notes
    -----
    For programs that look up tables.  The file of a law is smaller and exact (:func:`viscoroll.io.tables.law`).
    """
    import xarray as xr

    if method == "coupled":
        for name, given in {"V": V, "delta": delta, "alpha": alpha}.items():
            if given is not None:
                raise described_error(name, "is given", "left out: the method 'coupled' has nodes of its own")
        return _coupled_dataset(roller_of(what, None), nodes, progress)
    for name, given in {"V": V, "delta": delta}.items():
        if given is None:
            raise ParameterError(name, None, "given: the nodes of the axis")
    what = roller_of(what, alpha)
    si = isinstance(what, Cylinder)
    axes = {"V": increasing("V", V, unit=what.scale, above=0.0), "delta": increasing("delta", delta)}
    if alpha is not None:
        axes["alpha"] = increasing("alpha", alpha, low=1.0, high=HIGHEST_ALPHA)
    if (size := math.prod(axis.size for axis in axes.values())) > MAX_NODES:
        raise described_error("the grid", f"has {size:g} nodes", f"a grid of at most {MAX_NODES:g} nodes")
    plane = tuple(name for name in axes if name != "delta")
    data = {
        name: schema.variable(name, plane if name in schema.PLANE else tuple(axes), values, si)
        for name, values in _evaluate_nodes(what, axes, method).items()
    }
    coordinates = {name: schema.variable(name, (name,), axis, si) for name, axis in axes.items()}
    units = "in SI units, per m of length" if si else "dimensionless"
    title = f"Contact of a viscoelastic cylinder rolling with partial slip, {units}"
    grid = ", ".join(f"{name} {axis.size} in [{axis[0]:g}, {axis[-1]:g}]" for name, axis in axes.items())
    table = xr.Dataset(data, coordinates, schema.global_attributes(title, grid, command) | {"method": method})
    numbers = _CYLINDER_NUMBERS if si else _SCENE_NUMBERS
    table.attrs |= {name: float(getattr(what, name)) for name in numbers if name not in axes}
    material = what.pair if isinstance(what, Cylinder) else what.material
    if material is not None:
        table.attrs["material"] = bodies_as_toml(material)
    _state_errors(table, what)
    if method == "direct":
        for name, difference in differences(table, what).items():
            table[name].attrs["difference_from_rows"] = difference
    return table


def _coupled_dataset(roller: Scene | Cylinder, nodes: tuple[int, int] | None, progress: bool) -> xr.Dataset:
    """Return the table of the coupled solution of one roller; arguments as of :func:`build`."""
    law = coupled_law(roller.scene(), nodes=nodes, progress=progress)
    if isinstance(roller, Cylinder):
        law = replace(law, T_ref=roller.T_ref, pair=roller.pair)
    return law_as_dataset(law, {})


def _evaluate_nodes(roller: Scene | Cylinder, axes: dict[str, Floats], method: str) -> dict[str, Floats]:
    """Return all fields on the nodes of a grid; those over V alone are not computed for each delta.

    roller: :class:`Scene` or :class:`Cylinder`, roller of the grid.
    axes: "V", "delta" and perhaps "alpha" -> nodes, (n,), in the units of the roller.
    method: "table" (rows of the law) or "direct" (root solves of the printed equations).

    Returns field -> values in the units of the roller: "beta" and "Q" of shape (V, delta) or (V, delta, alpha); lam,
    epsilon, M, M_half_space, M_cylinder, delta_star, zeta and, of a layer, delta_0, which do not depend on the
    creepage, (V,) or (V, alpha).
    Raises as :func:`_evaluate`.
    """
    grid = dict(zip(axes, np.meshgrid(*axes.values(), indexing="ij", sparse=True), strict=True))
    plane = {name: nodes for name, nodes in grid.items() if name != "delta"}
    scene = roller.scene() if isinstance(roller, Cylinder) else roller
    names = tuple(name for name in schema.PLANE if name != "delta_0" or scene.cover is not None)
    fields = _evaluate(roller, plane, names, method)
    volume = _evaluate(roller, grid, schema.VOLUME, method)
    return volume | {name: np.take(values, 0, axis=1) for name, values in fields.items()}


def _evaluate(
    roller: Scene | Cylinder, points: dict[str, Floats], names: tuple[str, ...], method: Any = "table"
) -> dict[str, Floats]:
    """Return fields of the contact: name -> values in the broadcast shape of the points, in the units of the roller.

    roller: :class:`Scene` or :class:`Cylinder`, roller of the grid.
    points: "V", and perhaps "delta" and "alpha" -> arrays that broadcast; without "delta" fields are at delta = 0 as an
        array (1,), which broadcasts too; without "alpha" the roller has its own.
    names: names of the fields, as of :func:`viscoroll.contact`.
    method: "table" (rows of the law) or "direct" (root solves of the printed equations).
    Raises ParameterError for a method that is unknown or that the bodies do not have, and for V out of range;
    ConvergenceError where an iteration of "direct" reaches its limit.  A Cylinder may warn with ModelWarning.
    """
    own = roller.replace(alpha=points["alpha"]) if "alpha" in points else roller
    creep = points.get("delta", np.zeros(1))
    return contact(own, points["V"], delta=creep, fields=names, method=method).as_dict()


def _state_errors(table: xr.Dataset, roller: Scene | Cylinder) -> None:
    """Add the largest errors of both interpolations, and where they occur, to the attributes of the fields of a grid.

    table: the grid, which is changed.  Each field gets the attributes spline_error and linear_error, the largest
        absolute error of cubic splines and of linear interpolation over :data:`SAMPLE_SIZE` random points, in the unit
        of the field; and spline_error_at and linear_error_at, the first such point as text, as "V = 0.31, delta =
        0.0042", of the axes that the field depends on.
    roller: :class:`Scene` or :class:`Cylinder`, roller of the grid, for the exact values at random points.
    """
    points = random_points(table, SAMPLE_SIZE, SEED)
    for key, linear in (("spline_error", False), ("linear_error", True)):
        for name, errors in errors_at(table, roller, points, linear).items():
            worst = int(errors.argmax())
            table[name].attrs[key] = float(errors[worst])
            table[name].attrs[f"{key}_at"] = ", ".join(
                f"{dim} = {points[str(dim)][worst]:.6g}" for dim in table[name].dims
            )


def errors_at(
    table: xr.Dataset, roller: Scene | Cylinder, points: dict[str, Floats], linear: bool = False
) -> dict[str, Floats]:
    """Return the absolute errors of interpolation in a grid: field -> errors, (n,), in the unit of the field.

    table: :class:`xr.Dataset`, the grid.
    roller: :class:`Scene` or :class:`Cylinder`, roller of the grid, for the values from the rows of the law with which
        the interpolated ones are compared.
    points: each axis of the grid -> coordinates, (n,), finite, within the axis, in the units of the grid.
    linear: whether interpolation is linear in V, delta and alpha, else by cubic splines in ln V, delta and ln alpha.
    Raises OutOfTableError for a point outside of an axis.
    """
    exact = _evaluate(roller, points, schema.fields_of(table))
    found = Interpolant(table, linear)(**points)
    return {name: np.abs(found[name] - exact[name]) for name in schema.fields_of(table)}


def random_points(table: xr.Dataset, count: int, seed: int) -> dict[str, Floats]:
    """Return random points in random cells of a grid; along an axis of one node they all have its coordinate.

    A cell is drawn with equal probability for each axis, then the place in it evenly in the coordinate itself.

    table: the grid, dataset of :func:`build`; also an atlas.
    count: number of points, >= 0.
    seed: seed of the generator, >= 0.
    Returns axis -> coordinates, (count,), in the units of the grid.
    """
    random = np.random.default_rng(seed)
    points = {}
    for name in schema.axes_of(table):
        nodes = table[name].values
        if nodes.size == 1:
            points[name] = np.full(count, nodes[0])
            continue
        cell = random.integers(nodes.size - 1, size=count)
        points[name] = nodes[cell] + random.random(count) * (nodes[cell + 1] - nodes[cell])
    return points


def differences(table: xr.Dataset, roller: Scene | Cylinder) -> dict[str, float]:
    """Return the largest difference of each field between the nodes of a grid and the rows of the law.

    table: :class:`xr.Dataset`, the grid, by whatever method it was computed, which is not changed.
    roller: :class:`Scene` or :class:`Cylinder`, roller of the grid, with all of its fields (else KeyError).
    Returns field -> largest difference over all nodes, a float >= 0: for :data:`RELATIVE_FIELDS` divided by the
    magnitude in the rows at the same node, for other fields by the largest magnitude in the rows.  Both are
    dimensionless.  Where that magnitude is 0, as of M of elastic bodies, the difference itself is taken, in the unit of
    the field.
    """
    rows = _evaluate_nodes(roller, {name: table[name].values for name in schema.axes_of(table)}, "table")
    found = {}
    for name in schema.fields_of(table):
        size = np.abs(rows[name])
        scale = size if name in RELATIVE_FIELDS else size.max()
        found[name] = float(np.max(np.abs(table[name].values - rows[name]) / np.where(scale > 0.0, scale, 1.0)))
    return found
