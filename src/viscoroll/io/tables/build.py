"""The contact law on a grid: what look-up blocks of other programs read."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from ...core.checks import checked, number, whole
from ...core.errors import ParameterError
from ...core.typed import Floats
from ...cylinder import Cylinder
from ...materials.law_file import described, law_of
from ...materials.law_store import content_of
from ...materials.law_table import LawTable
from ...materials.prony_forms import HIGHEST_ALPHA
from ...scene import Scene
from . import schema
from .interpolate import Interpolant

if TYPE_CHECKING:
    import xarray as xr

_MAX_NODES = 50_000_000
#: Random points that a stated error is the largest over, and their seed: it can be had again.
SAMPLE, SEED = 100_000, 20260102
#: of a scene, and of a cylinder: the numbers among the attributes, and what all is counted in
_NUMBERS = ("alpha", "kappa", "mu"), ("R", "m", "mu", "load")
_UNITS = "dimensionless", "in SI units, per m of length"


def spread(low: float, high: float, count: int, spacing: Literal["linear", "log"] = "linear") -> Floats:
    """``count`` values from ``low`` to ``high``, both exact, in equal steps or equal ratios.

    Raises
    ------
    ParameterError
        An unknown spacing, low >= high, high - low beyond the doubles, count < 2, or "log" with low <= 0.
    """
    if spacing not in ("linear", "log"):
        raise ParameterError("spacing", repr(spacing), "'linear' or 'log'")
    low = number("low", low, low=0.0 if spacing == "log" else -np.inf, strict=True)
    high = number("high", high)
    if not high > low:
        raise ParameterError("high", high, f"> low = {low:g}")
    if high - low == np.inf:
        raise ParameterError("high", high, f"less than 1.8e308 above low = {low:g}")
    return (np.geomspace if spacing == "log" else np.linspace)(low, high, whole("count", count, 2, _MAX_NODES))


def build(
    what: Scene | Cylinder | LawTable | xr.Dataset,
    V: ArrayLike,
    *,
    delta: ArrayLike,
    alpha: ArrayLike | None = None,
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
    command : recorded in ``history``; default: the command line of this process.

    Returns
    -------
    xarray.Dataset
        beta and Q over all axes; lam, epsilon, M, its parts in both bodies and delta_star over V (and alpha); units,
        symbols, equations in the attributes.  Nodes have the bits of :func:`contact`.  ``spline_error`` of a field is
        the largest absolute error of :func:`interpolate`, ``linear_error`` that of linear interpolation in the axes as
        they stand, over 10^5 random points in random cells; ``spline_error_at`` and ``linear_error_at`` name the
        point, as in "V = 0.31, delta = 0.0042".

    Raises
    ------
    ParameterError
        Where ``what`` is none of these or has arrays, an axis is out of range or does not increase.

    Notes
    -----
    For programs that look up tables.  The file of a law is smaller and exact (:func:`viscoroll.io.tables.law`).
    """
    import xarray as xr

    what = _single(what)
    axes = {"V": increasing("V", V, low=0.0, strict=True), "delta": increasing("delta", delta)}
    if alpha is not None:
        if isinstance(what, Cylinder) or what.material is not None:
            raise ParameterError("alpha", "given", "left out: the material has its own")
        axes["alpha"] = increasing("alpha", alpha, low=1.0, high=HIGHEST_ALPHA)
    if math.prod(nodes.size for nodes in axes.values()) > _MAX_NODES:
        raise ParameterError(", ".join(axes), "their product", f"at most {_MAX_NODES} nodes in all")
    grid = dict(zip(axes, np.meshgrid(*axes.values(), indexing="ij", sparse=True), strict=True))
    plane = {name: nodes for name, nodes in grid.items() if name != "delta"}
    fields = _fields(what, grid, schema.VOLUME) | {
        name: np.take(values, 0, axis=1) for name, values in _fields(what, plane, schema.PLANE).items()
    }
    si = isinstance(what, Cylinder)
    data = {
        name: schema.variable(name, tuple(plane if name in schema.PLANE else axes), values, si)
        for name, values in fields.items()
    }
    coordinates = {name: schema.variable(name, (name,), nodes, si) for name, nodes in axes.items()}
    title = f"Contact of a viscoelastic cylinder rolling with partial slip, {_UNITS[si]}"
    of = ", ".join(f"{name} {nodes.size} in [{nodes[0]:g}, {nodes[-1]:g}]" for name, nodes in axes.items())
    table = xr.Dataset(data, coordinates, schema.global_attributes(title, of, command))
    material = what.pair if isinstance(what, Cylinder) else what.material
    numbers = {name: float(getattr(what, name)) for name in _NUMBERS[si] if name not in axes}
    table.attrs |= numbers | ({} if material is None else {"material": described(material)})
    _state_errors(table, what)
    return table


def increasing(name: str, nodes: Any, **bound: Any) -> Floats:
    """Nodes of an axis as a vector of its own; raises ParameterError where they are out of range or do not increase."""
    axis = np.atleast_1d(checked(name, nodes, **bound)).copy()
    if axis.ndim != 1 or not axis.size or (np.diff(axis) <= 0.0).any():
        raise ParameterError(name, f"an array of shape {axis.shape}", "one-dimensional and strictly increasing")
    return axis


def _single(what: Any) -> Scene | Cylinder:
    """What has the contact: a law at kappa = mu = 1."""
    if getattr(what, "attrs", {}).get(schema.KIND) == "law":
        what = law_of(content_of(what), "law")
    if isinstance(what, LawTable):
        what = Scene(kappa=1.0, mu=1.0, material=what)
    if not isinstance(what, Scene | Cylinder):
        raise ParameterError("what", f"{what!r:.60}", "a Scene, a Cylinder or a law")
    shape = (what if isinstance(what, Scene) else what.scene()).shape
    if shape:
        raise ParameterError("what", f"of shape {shape}", "one scene, of single numbers")
    return what


def _fields(what: Scene | Cylinder, at: dict[str, Floats], names: tuple[str, ...]) -> dict[str, Floats]:
    """Fields at V, perhaps delta, and perhaps an alpha each."""
    one = what.replace(alpha=at["alpha"]) if "alpha" in at else what
    return one.contact(at["V"], delta=at.get("delta", np.zeros(1)), fields=names).as_dict()


def _state_errors(table: xr.Dataset, what: Scene | Cylinder) -> None:
    """Put the largest errors of both ways to interpolate, and where they occur, into the attributes of the fields.

    Parameters
    ----------
    table : the grid; its fields gain ``spline_error``, ``spline_error_at``, ``linear_error``, ``linear_error_at``.
    what : the scene or cylinder that the grid is of, for the exact values at the random points.
    """
    random = np.random.default_rng(SEED)
    points = {name: _between(table[name].values, random) for name in schema.axes_of(table)}
    exact = _fields(what, points, schema.VOLUME + schema.PLANE)
    ways = {"spline_error": Interpolant(table), "linear_error": Interpolant(table, linear=True)}
    for name in schema.fields_of(table):
        own = {str(dim): points[str(dim)] for dim in table[name].dims}
        for key, look_up in ways.items():
            errors = np.abs(look_up(name, **own)[name] - exact[name])
            worst = int(errors.argmax())
            table[name].attrs[key] = float(errors[worst])
            table[name].attrs[f"{key}_at"] = ", ".join(f"{axis} = {at[worst]:.6g}" for axis, at in own.items())


def _between(nodes: Floats, random: np.random.Generator) -> Floats:
    """Random points within random cells of an axis; its node where it has only one."""
    if nodes.size == 1:
        return np.full(SAMPLE, nodes[0])
    cell = random.integers(nodes.size - 1, size=SAMPLE)
    return nodes[cell] + random.random(SAMPLE) * (nodes[cell + 1] - nodes[cell])
