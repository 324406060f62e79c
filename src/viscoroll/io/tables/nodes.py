"""Nodes of the axes of a grid: in equal steps or ratios, and of creepage, for the onset of full slip at every speed."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from ...core.array_types import Floats
from ...core.checks import check_array, check_choice, check_integer, check_number
from ...core.errors import ParameterError, described_error, shape_error
from ...cylinder import Cylinder
from ...materials.law.netcdf import parse_law
from ...materials.law.table import LawTable
from ...materials.law_file import dataset_content
from ...scene import Scene
from . import schema

#: Largest number of nodes of a grid: 400 MB a field, more than any look-up block reads.
MAX_NODES = 50_000_000
#: Largest creepage divided by the largest one at which full slip begins: some nodes lie beyond, so that the ends of the
#: spline are flat.
_END_RATIO = 1.1


def spread(low: float, high: float, count: int, spacing: Literal["linear", "log"] = "linear") -> Floats:
    """Return numbers in equal steps or equal ratios between two ends, which are exact.

    Parameters
    ----------
    low, high : ends, low < high; with "log" low > 0.
    count : number of values, both ends among them, 2 to 5e7.
    spacing : "linear" (equal steps) or "log" (equal ratios).

    Returns
    -------
    array of shape (count,)
        The numbers, ascending; the first is ``low`` and the last is ``high``.  Neighbours may be equal where the steps
        are below rounding.

    Raises
    ------
    ParameterError
        An unknown spacing, ends that are not finite, low >= high, high - low beyond the doubles, a count out of range
        or no whole number, or "log" with low <= 0.

    Examples
    --------
    >>> import viscoroll as vr
    >>> vr.tables.spread(0.01, 1.0, 3, "log")
    array([0.01, 0.1 , 1.  ])
    """
    check_choice("spacing", spacing, "linear", "log")
    low = check_number("low", low, above=0.0 if spacing == "log" else -np.inf)
    high = check_number("high", high)
    if not high > low:
        raise ParameterError("high", high, f"> low = {low:g}")
    if high - low == np.inf:
        raise ParameterError("high", high, f"less than 1.8e308 above low = {low:g}")
    return (np.geomspace if spacing == "log" else np.linspace)(low, high, check_integer("count", count, 2, MAX_NODES))


def creep_nodes(what: Scene | Cylinder, V: ArrayLike, count: int, *, alpha: ArrayLike | None = None) -> Floats:
    """Return nodes of creepage for a grid, which resolve the partial slip at every speed and alpha.

    Full slip begins at delta = +-delta_star(V, alpha), of a layer at delta_0 +- delta_star.

    Parameters
    ----------
    what : a :class:`Scene` or a :class:`Cylinder` with numbers for parameters, or a law, as of :func:`build`.
    V : speeds of the grid, (n,), > 0, strictly increasing; of a Scene divided by R/T_ref, where T_ref is T_epsilon of a
        scene with alpha, else the unit of time of its material; of a Cylinder in m/s.
    count : number of nodes, odd, 5 to 5e7.
    alpha : values of alpha of the grid, (m,), in [1, 1e12], strictly increasing, in place of that of a Scene without a
        material; None: the grid has no such axis, and ``what`` its own alpha or material.

    Returns
    -------
    array of shape (count,)
        Creepages, dimensionless, ascending, symmetric about 0, which is one of them.  Half of the nodes lie in equal
        steps.  The other half are divided equally among all (V, alpha): those of each lie in equal steps within +-1.1
        times its delta_star, of a layer its delta_star + |delta_0|.  The ends are +-1.1 times the largest of these
        values: there the whole contact slips.

    Raises
    ------
    ParameterError
        Where ``what`` is none of these or has arrays; a count that is even, no whole number, or outside of 5 to 5e7;
        speeds or alphas that are empty, out of range or not increasing; ``alpha`` of a Cylinder or beside a material;
        what :func:`viscoroll.contact` refuses, as kappa V above 1e300.
    FileError
        The dataset of a law that is incomplete or does not state its material.

    Examples
    --------
    >>> import viscoroll as vr
    >>> scene = vr.presets.PAPER_SECTION_5
    >>> V = vr.tables.spread(1e-5, 4.0, 160, "log")
    >>> grid = vr.tables.build(scene, V, delta=vr.tables.creep_nodes(scene, V, 161))
    """
    if check_integer("count", count, 5, MAX_NODES) % 2 == 0:
        raise ParameterError("count", count, "odd: the nodes are symmetric about 0")
    roller: Any = roller_of(what, alpha)
    speeds = increasing("V", V, unit=roller.scale, above=0.0)
    roller = roller if alpha is None else roller.replace(alpha=increasing("alpha", alpha, low=1.0))
    speeds = speeds if alpha is None else speeds[:, np.newaxis]
    found = roller.contact(speeds, delta=0.0, fields=("delta_star", "delta_0"))
    ends = np.sort(_END_RATIO * (found.delta_star + np.abs(found.delta_0)), axis=None)
    # nodes divided by their number, per creepage; between two ends it is constant
    density = (1.0 / ends[-1] + np.cumsum(1.0 / ends[::-1])[::-1] / ends.size) / 2.0
    fraction, places = np.append(0.0, np.cumsum(density * np.diff(ends, prepend=0.0))), np.append(0.0, ends)
    half = np.interp(np.linspace(0.0, fraction[-1], count // 2 + 1), fraction, places)
    return np.concatenate([-half[:0:-1], half])


def roller_of(what: Any, alpha: Any) -> Scene | Cylinder:
    """Return the roller of a grid: a scene or a cylinder itself, of a law the scene with kappa = mu = 1.

    what: a :class:`Scene`, a :class:`Cylinder`, a :class:`LawTable` of half-spaces, or the dataset of one.
    alpha: what the caller gave for an axis of alpha; None without.
    Raises ParameterError for anything else (the law of a layer or of every alpha too), for a roller whose parameters
    are arrays, for a cylinder whose scene is out of range, and for alpha of a cylinder or beside a material; FileError
    for a dataset of a law that is incomplete.
    """
    if str(getattr(what, "attrs", {}).get(schema.KIND)) == "law":
        what = parse_law(dataset_content(what), "law")
    if isinstance(what, LawTable) and what.cover is None:
        what = Scene(kappa=1.0, mu=1.0, material=what)
    if not isinstance(what, Scene | Cylinder):
        raise ParameterError("what", f"{what!r:.60}", "a Scene, a Cylinder or a law of half-spaces")
    if shape := (what if isinstance(what, Scene) else what.scene()).shape:
        raise shape_error("what", shape, "one scene or cylinder whose parameters are numbers")
    if alpha is not None and (isinstance(what, Cylinder) or what.material is not None):
        raise described_error("alpha", "is given", "left out: the material determines alpha")
    return what


def increasing(name: str, nodes: Any, **bounds: Any) -> Floats:
    """Return the nodes of an axis as a new vector.

    name: name of the axis, for messages.
    nodes: a number, which is an axis of one node, or numbers (n,), as a caller gave them, perhaps with a unit.
    bounds: keywords of :func:`.check_array`: ``unit``, "1" by default, and the bounds ``low`` (>=), ``above`` (>) and
        ``high`` (<=) of the values, by default none.
    Raises ParameterError for nodes that are not numeric, not finite, out of range or not strictly increasing, for none,
    for more than one axis, and for a unit of another dimension.
    Returns the nodes, (n,), n >= 1, strictly increasing, float64, in the unit of ``bounds``; always a copy.
    """
    axis = np.atleast_1d(check_array(name, nodes, **bounds)).copy()
    if axis.ndim != 1 or not axis.size or (np.diff(axis) <= 0.0).any():
        found = "does not increase strictly" if axis.size else "is empty"
        found = found if axis.ndim == 1 else f"has shape {axis.shape}"
        raise described_error(name, found, "a number, or a vector that increases strictly")
    return axis
