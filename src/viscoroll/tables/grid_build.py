"""Grids of the contact law, for look-up blocks of other programs: nodes of the axes, in equal steps
or ratios (:func:`spread`), and of creepage for the onset of full slip at every speed
(:func:`creep_nodes`); and the fields at the nodes (:func:`build`).

Fields: beta, length of the stick zone divided by contact length; Q, creep force; lam, contact
length divided by that at rest; epsilon, shift of the contact in half contact lengths; M, rolling
moment, and its parts M_half_space and M_cylinder; delta_star, creepage at which full slip begins;
delta_0, creepage without creep force; zeta, time in which a point passes half the contact.
"""

import dataclasses
import math
import shlex
import sys
from datetime import UTC, datetime
from typing import Any, Literal

import numpy as np

from .. import __version__
from ..contact_mechanics import contact, coupled_law
from ..core import (
    PAPER,
    SYMBOLS,
    ArrayLike,
    Dataset,
    Floats,
    ParameterError,
    attributes,
    check_array,
    check_choice,
    check_integer,
    check_number,
    describe_value,
    described_error,
)
from ..laws import LawTable, bodies_as_toml, increases, law_as_dataset, parse_law
from ..materials import HIGHEST_ALPHA, dataset_content
from ..rollers import Cylinder, Scene
from .table_files import (
    GRID,
    KIND,
    OF_TRACTION,
    PLANE,
    SCHEMA_VERSION,
    VOLUME,
    Interpolant,
    axes_of,
    fields_of,
)

# --- Nodes of the axes of a grid ---

#: Largest number of nodes of a grid: 400 MB a field, more than any look-up block reads.
MAX_NODES = 50_000_000
#: Largest creepage divided by the largest one at which full slip begins: some nodes lie beyond, so
#: that the ends of the spline are flat.
_END_RATIO = 1.1


def spread(
    low: float, high: float, count: int, spacing: Literal["linear", "log"] = "linear"
) -> Floats:
    """Return numbers in equal steps or equal ratios between two ends, which are exact.

    Parameters
    ----------
    low, high : ends, low < high; with "log" low > 0.
    count : number of values, both ends among them, 2 to 5e7.
    spacing : "linear" (equal steps) or "log" (equal ratios).

    Returns
    -------
    array of shape (count,)
        The numbers, ascending; the first is ``low`` and the last is ``high``.  Neighbours may be
        equal where the steps are below rounding.

    Raises
    ------
    ParameterError
        An unknown spacing, ends that are not finite, low >= high, high - low beyond the doubles, a
        count out of range or no whole number, or "log" with low <= 0.

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
    return (np.geomspace if spacing == "log" else np.linspace)(
        low, high, check_integer("count", count, 2, MAX_NODES)
    )


def creep_nodes(
    what: Scene | Cylinder, V: ArrayLike, count: int, *, alpha: ArrayLike | None = None
) -> Floats:
    """Return nodes of creepage for a grid, which resolve the partial slip at every speed and alpha.

    Full slip begins at delta = +-delta_star(V, alpha), of a layer at delta_minus and delta_plus.

    Parameters
    ----------
    what : a :class:`Scene` or a :class:`Cylinder` with numbers for parameters, or a law, as in
        :func:`build`.
    V : speeds of the grid, (n,), > 0, strictly increasing; of a Scene divided by R/T_ref, where
        T_ref is T_epsilon of a scene with alpha, else the unit of time of its material; of a
        Cylinder in m/s.
    count : number of nodes, odd, 5 to 5e7.
    alpha : values of alpha of the grid, (m,), in [1, 1e12], strictly increasing, in place of that
        of a Scene without a material; None: the grid has no such axis, and ``what`` its own alpha
        or material.

    Returns
    -------
    array of shape (count,)
        Creepages, dimensionless, ascending, symmetric about 0, which is one of them.  Half of the
        nodes lie in equal steps.  The other half are divided equally among all (V, alpha): those of
        each lie in equal steps within +-1.1 times its delta_star, of a layer the
        larger of |delta_minus| and |delta_plus|.  The ends are +-1.1 times the largest of these
        values: there the whole contact slips.

    Raises
    ------
    ParameterError
        Where ``what`` is none of these or has arrays; a count that is even, no whole number, or
        outside of 5 to 5e7; speeds or alphas that are empty, out of range or not increasing;
        ``alpha`` of a Cylinder or beside a material; what :func:`viscoroll.contact` refuses, as
        kappa V above 1e300.
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
        raise ParameterError("count", count, "odd, as the nodes are symmetric about 0")
    roller = roller_of(what, alpha)
    speeds = increasing("V", V, unit=roller.scale, above=0.0)
    if alpha is not None:
        # all pairs of speed and alpha
        roller = roller.replace(alpha=increasing("alpha", alpha, low=1.0))
        speeds = speeds[:, np.newaxis]
    found = roller.contact(speeds, delta=0.0, fields=("delta_minus", "delta_plus"))
    largest = np.maximum(np.abs(found.delta_minus), np.abs(found.delta_plus))
    ends = np.sort(_END_RATIO * largest, axis=None)
    # Nodes divided by their number, per creepage; between two ends it is constant.  Half of it is
    # even up to the largest end; of the other half each (V, alpha) whose end lies beyond the
    # creepage has 1/end, a sum from the largest end down.
    density = (1.0 / ends[-1] + np.cumsum(1.0 / ends[::-1])[::-1] / ends.size) / 2.0
    # part of the nodes up to each end, and in its inverse the nodes at equal parts
    fraction = np.append(0.0, np.cumsum(density * np.diff(ends, prepend=0.0)))
    parts = np.linspace(0.0, fraction[-1], count // 2 + 1)
    half = np.interp(parts, fraction, np.append(0.0, ends))
    return np.concatenate([-half[:0:-1], half])  # the mirror image, without a second 0


def roller_of(what: Any, alpha: Any) -> Scene | Cylinder:
    """Return the roller of a grid: a scene or a cylinder itself, of a law the scene with kappa =
    mu = 1.

    what: a :class:`Scene`, a :class:`Cylinder`, a law of half-spaces, or the dataset of one.
    alpha: what the caller gave for an axis of alpha; None without.
    Raises ParameterError for anything else (the law of a layer or of every alpha too), for a roller
    whose parameters are arrays, for a cylinder whose scene is out of range, and for alpha of a
    cylinder or beside a material; FileError for a dataset of a law that is incomplete.
    """
    if str(getattr(what, "attrs", {}).get(KIND)) == "law":
        what = parse_law(dataset_content(what), "what")
    if isinstance(what, LawTable) and what.cover is None:
        what = Scene(kappa=1.0, mu=1.0, material=what)
    if not isinstance(what, Scene | Cylinder):
        raise ParameterError(
            "what",
            describe_value(what),
            "a Scene, a Cylinder, or the law of half-spaces (in place of the law of a layer give "
            "its Cylinder, in place of the law of every alpha a Scene)",
        )
    if shape := what.scene().shape:
        raise described_error(
            "what, the roller,",
            f"has arrays of shape {shape} as parameters",
            "a Scene or Cylinder whose parameters are numbers: make a grid for each element",
        )
    if alpha is not None and (isinstance(what, Cylinder) or what.material is not None):
        raise described_error(
            "alpha", "is given", "left out beside a Cylinder or a material, which determines it"
        )
    return what


def increasing(name: str, nodes: Any, **bounds: Any) -> Floats:
    """Return the nodes of an axis as a new vector.

    name: name of the axis, for messages.
    nodes: a number, which is an axis of one node, or numbers (n,), as a caller gave them, perhaps
    with a unit.
    bounds: keywords of :func:`.check_array`: ``unit``, "1" by default, and the bounds ``low`` (>=),
        ``above`` (>) and ``high`` (<=) of the values, by default none.
    Raises ParameterError for nodes that are not numeric, not finite, out of range or not strictly
    increasing, for none, for more than one axis, and for a unit of another dimension.
    Returns a copy of the nodes, (n,), n >= 1, strictly increasing, in the unit of ``bounds``.
    """
    axis = np.atleast_1d(check_array(name, nodes, **bounds)).copy()
    if axis.ndim == 1 and axis.size and increases(axis):
        return axis
    found = "does not increase strictly" if axis.size else "is empty"
    found = found if axis.ndim == 1 else f"has shape {axis.shape}"
    raise described_error(name, found, "a number, or a list of increasing numbers")


# --- The contact law on a grid, for look-up blocks of other programs ---

#: Random points over which a stated error is the largest.
SAMPLE_SIZE = 100_000
#: Seed of these points, so that the error can be reproduced.
SEED = 20260102
#: Fields whose difference of two methods is relative at every node.  The printed forms of other
#: fields lose relative digits where they are small beside their largest value
#: (kernels/law/printed_law.py), which is their scale.
RELATIVE_FIELDS = ("lam", "zeta", "delta_star")
#: Attributes with the parameters of a scene.
_SCENE_NUMBERS = ("alpha", "kappa", "mu")
#: Attributes with the parameters of a cylinder.
_CYLINDER_NUMBERS = ("R", "m", "mu", "load")
#: Attribute ``comment`` of a grid.
COMMENT = (
    "The table holds V > 0. For V < 0 look up |V| and the same delta, Eqs. (17), (18): lam, "
    "epsilon, delta_star, delta_0 and beta are those values; M, its two parts and Q change their "
    "sign. In a grid without delta_0, full slip begins at |delta| = delta_star(V); for -delta "
    "beta is the same, and Q changes its sign. In a grid with delta_0, full slip begins at one "
    "delta on each side of delta_0(V), and neither is at the distance delta_star from it. In full "
    "slip beta = 0 and |Q| = mu P. epsilon may exceed 1. A grid is for plots and for look-up "
    "blocks of other programs. Do not use it where the onset of full slip decides a result: there "
    "interpolation is least accurate, with spline_error and linear_error of Q and beta, which are "
    "absolute. The file of a law (viscoroll tables law) is exact at every V, delta, kappa and mu, "
    "and has a tenth of the size."
)


def variable(name: str, dims: tuple[str, ...], values: Any, si: bool) -> Any:
    """Make a variable of a grid, with long_name, units, symbol, range, equation and reference as
    attributes.

    name: name of the quantity, a key of ``core.quantities.SYMBOLS``.
    dims: names of the axes of the variable.
    values: array of its values, over ``dims``.
    si: whether the values are in SI units, else dimensionless; the range of Q is then that of "mu
    P" in place of "mu".
    Returns the xarray.Variable, float64.
    Raises KeyError for another name, ValueError of xarray where ``values`` have another number of
    axes than ``dims``.
    """
    import xarray as xr

    symbol = SYMBOLS[name]
    # that of Q: |Q| <= mu becomes |Q| <= mu P; other ranges do not have mu
    allowed = symbol.range.replace("mu", "mu P") if si else symbol.range
    about = {
        "symbol": symbol.latex,
        "range": allowed,
        "equation": symbol.equation,
        "reference": PAPER,
    }
    return xr.Variable(dims, values, attributes(name, si) | about)


def global_attributes(title: str, grid: str, command: str | None) -> dict[str, str]:
    """Return the global attributes of a grid that is computed now.

    title: title of the grid.
    grid: axes of the grid in words.
    command: command that computed it, for ``history``; None or "": that of this process.
    Returns name -> text: Conventions, title, institution, source, history (time of the call in UTC
    and the command), references, comment, viscoroll_table ("grid"), schema_version,
    viscoroll_version and grid.
    """
    return {
        "Conventions": "CF-1.11",
        "title": title,
        "institution": "made by its user with the open-source package viscoroll",
        "source": f"viscoroll {__version__}: the contact law, Eqs. (6), (8)-(10), (15), (16)",
        "history": f"{datetime.now(UTC):%Y-%m-%dT%H:%M:%SZ} {command or shlex.join(sys.orig_argv)}",
        "references": PAPER,
        "comment": COMMENT,
        KIND: GRID,
        "schema_version": SCHEMA_VERSION,
        "viscoroll_version": __version__,
        "grid": grid,
    }


def build(
    what: Scene | Cylinder | LawTable | Dataset,
    V: ArrayLike | None = None,
    *,
    delta: ArrayLike | None = None,
    alpha: ArrayLike | None = None,
    method: Literal["table", "direct", "coupled"] = "table",
    nodes: tuple[int, int] | None = None,
    progress: bool = False,
    command: str | None = None,
) -> Dataset:
    """Compute a table of the contact over (V, delta) or (V, delta, alpha), and its errors of
    interpolation.

    Parameters
    ----------
    what : a :class:`Scene`, dimensionless; a :class:`Cylinder`, in SI units; or the law of
        half-spaces, of :func:`viscoroll.load_law` or the dataset of
        :func:`viscoroll.tables.law`.  A law is taken with kappa = mu =
        1: the axis V then means kappa V, delta means kappa delta/mu, Q means Q/mu and M means kappa
        M.  The law of a layer has no such scale, since delta_0 does not vary with mu: it is
        refused, as is the law of every alpha.  All parameters are numbers, no arrays.
    V : speeds of the axis, (n,), > 0, strictly increasing, divided by R/T_ref (T_ref is T_epsilon
        of a scene with alpha) or in m/s; for V < 0 the attribute ``comment`` states which fields
        change their sign.  A number, here and below, is an axis of one node.
    delta : creepages, (n,), dimensionless, any sign, strictly increasing.
    alpha : values of alpha, (n,), in [1, 1e12], strictly increasing, in place of that of a scene
        without a material;
        None: no such axis.
    method : "table": fields are evaluated from the rows of the law.  "direct": they are found by
        root solves of the equations as the paper prints them, which have one relaxation time; the
        rows are evaluated too, and the attribute ``difference_from_rows`` of each field is the
        largest difference (:func:`differences`).  "coupled": pressure and shear are solved
        together, at nodes of speed and creepage that the package chooses, so that V, delta and
        alpha are left out; the table is a law at this mu, which :func:`viscoroll.load_law` reads.
    nodes : of method "coupled", numbers of nodes over speed and over creepage, the second odd;
        None: 5 to 13 a decade between the rates of the bodies, the more the faster their compliance
        grows, and 27.
    progress : of method "coupled", whether to draw a progress bar on standard error.
    command : recorded in ``history``; default: the command line of this process.

    Returns
    -------
    xarray.Dataset
        beta and Q over (V, delta) or (V, delta, alpha); lam, epsilon, M, its parts in both bodies,
        delta_star and zeta over V (and alpha), and of a layer delta_0; units, symbols, equations in
        the attributes.  Nodes have the bits of :func:`contact` by this method.

        ``spline_error`` of a field is the largest absolute error of :func:`interpolate`,
        ``linear_error`` that of linear interpolation in the untransformed axes, over 10^5 random
        points in random cells; ``spline_error_at`` and ``linear_error_at`` name the point, as in
        "V = 0.31, delta = 0.0042".  Attributes of the dataset are those of a CF file, ``method``,
        the parameters of the roller (of a scene alpha, kappa and mu, of a cylinder R, m, mu and
        load) and, unless the scene has an alpha alone, ``material``, the bodies as TOML.

    Raises
    ------
    ParameterError
        Where ``what`` is none of these or has arrays; an axis is out of range or does not increase
        strictly; there are more than 5e7 nodes; ``alpha`` is given for a cylinder or for a scene
        with a material; an unknown method, or "direct" of a material; what
        :func:`viscoroll.contact` refuses, as kappa V above 1e300.
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
    >>> grid = vr.tables.build(
    ...     vr.presets.PAPER_SECTION_5, [0.1, 0.2, 0.3, 0.4], delta=[-0.1, 0.0, 0.1]
    ... )
    >>> grid["Q"].dims
    ('V', 'delta')

    Notes
    -----
    For programs that look up tables.  The file of a law is smaller and exact
    (:func:`viscoroll.tables.law`).
    """
    import xarray as xr

    if method == "coupled":
        for name, given in {"V": V, "delta": delta, "alpha": alpha}.items():
            if given is not None:
                raise described_error(
                    name, "is given", "left out: method 'coupled' chooses speeds and creepages"
                )
        roller = roller_of(what, None)
        law = coupled_law(roller.scene(), nodes=nodes, progress=progress)
        if isinstance(roller, Cylinder):
            # so that the file states its unit of time in s, and the bodies in SI units
            law = dataclasses.replace(law, T_ref=roller.T_ref, pair=roller.pair)
        return law_as_dataset(law, {})
    for name, given, maker in (("V", V, "spread"), ("delta", delta, "creep_nodes")):
        if given is None:
            raise ParameterError(name, None, f"a list of values, as vr.tables.{maker} makes it")
    what = roller_of(what, alpha)
    si = isinstance(what, Cylinder)
    axes = {
        "V": increasing("V", V, unit=what.scale, above=0.0),
        "delta": increasing("delta", delta),
    }
    if alpha is not None:
        axes["alpha"] = increasing("alpha", alpha, low=1.0, high=HIGHEST_ALPHA)
    if (size := math.prod(axis.size for axis in axes.values())) > MAX_NODES:
        raise described_error(
            "the grid",
            f"has {size:.7g} points, all combinations of {', '.join(axes)}",
            f"one of at most {MAX_NODES:g} points: give fewer values",
        )
    plane = tuple(name for name in axes if name != "delta")
    data = {
        name: variable(name, tuple(axes) if values.ndim == len(axes) else plane, values, si)
        for name, values in _evaluate_nodes(what, axes, method).items()
    }
    coordinates = {name: variable(name, (name,), axis, si) for name, axis in axes.items()}
    title = "Contact of a viscoelastic cylinder rolling with partial slip, " + (
        "in SI units, per m of length" if si else "dimensionless"
    )
    grid = ", ".join(
        f"{axis.size} value{'s' * (axis.size > 1)} of {name} in [{axis[0]:g}, {axis[-1]:g}]"
        for name, axis in axes.items()
    )
    table = xr.Dataset(
        data, coordinates, global_attributes(title, grid, command) | {"method": method}
    )
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


def _evaluate_nodes(
    roller: Scene | Cylinder, axes: dict[str, Floats], method: str
) -> dict[str, Floats]:
    """Return all fields on the nodes of a grid; those over V alone are not computed for each delta.

    roller: :class:`Scene` or :class:`Cylinder`, roller of the grid.
    axes: "V", "delta" and perhaps "alpha" -> nodes, (n,), in the units of the roller.
    method: "table" (rows of the law) or "direct" (root solves of the printed equations).

    Returns field -> values in the units of the roller: "beta" and "Q" of shape (V, delta) or (V,
    delta, alpha); lam, epsilon, M, M_half_space, M_cylinder, delta_star, zeta and, of a layer,
    delta_0, (V,) or (V, alpha) where they do not depend on the creepage: of a layer, and of
    half-spaces by the coupled solution, delta_star and delta_0 alone.
    Raises as :func:`_evaluate`.
    """
    grid = dict(zip(axes, np.ix_(*axes.values())))
    # of one creepage, an array, which broadcasts too
    plane = grid | {"delta": np.zeros(1)}
    scene = roller.scene()
    of_traction = OF_TRACTION if scene.cover is not None or scene.tabulated else ()
    # delta_0 is 0 of half-spaces whose pressure and shear are uncoupled
    names = tuple(name for name in PLANE if name not in (of_traction or ("delta_0",)))
    fields = _evaluate(roller, plane, names, method)
    volume = _evaluate(roller, grid, (*VOLUME, *of_traction), method)
    # that creepage has the second axis
    return volume | {name: np.take(values, 0, axis=1) for name, values in fields.items()}


def _evaluate(
    roller: Scene | Cylinder,
    points: dict[str, Floats],
    names: tuple[str, ...],
    method: Any = "table",
) -> dict[str, Floats]:
    """Return fields of the contact: name -> values in the broadcast shape of the points, in the
    units of the roller.

    roller: :class:`Scene` or :class:`Cylinder`, roller of the grid.
    points: "V", "delta" and perhaps "alpha" -> arrays that broadcast; without "alpha" it is the
        roller's.
    names: names of the fields, as in :func:`viscoroll.contact`.
    method: "table" (rows of the law) or "direct" (root solves of the printed equations).
    Raises ParameterError for a method that is unknown or that the bodies do not have, and for V out
    of range; ConvergenceError where an iteration of "direct" reaches its limit.  A Cylinder may
    warn with ModelWarning.
    """
    own = roller.replace(alpha=points["alpha"]) if "alpha" in points else roller
    return contact(own, points["V"], delta=points["delta"], fields=names, method=method).as_dict()


def _state_errors(table: Dataset, roller: Scene | Cylinder) -> None:
    """Add the largest errors of both interpolations, and where they occur, to the attributes of the
    fields of a grid.

    table: the grid, which is changed.  Each field gets the attributes spline_error and
        linear_error, the largest absolute error of cubic splines and of linear interpolation over
        :data:`SAMPLE_SIZE` random points, in the unit of the field; and spline_error_at and
        linear_error_at, the first such point as text, as "V = 0.31, delta = 0.0042", of the axes
        that the field depends on.
    roller: :class:`Scene` or :class:`Cylinder`, roller of the grid, for the exact values at random
    points.
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
    table: Dataset, roller: Scene | Cylinder, points: dict[str, Floats], linear: bool = False
) -> dict[str, Floats]:
    """Return the absolute errors of interpolation in a grid: field -> errors, (n,), in the unit of
    the field.

    table: :class:`xr.Dataset`, the grid.
    roller: :class:`Scene` or :class:`Cylinder`, roller of the grid, for the values from the rows of
        the law with which the interpolated ones are compared.
    points: each axis of the grid -> coordinates, (n,), finite, within the axis, in the units of the
    grid.
    linear: whether interpolation is linear in V, delta and alpha, else by cubic splines in ln V,
    delta and ln alpha.
    Raises OutOfTableError for a point outside of an axis.
    """
    exact = _evaluate(roller, points, fields_of(table))
    found = Interpolant(table, linear)(**points)
    return {name: np.abs(found[name] - exact[name]) for name in fields_of(table)}


def random_points(table: Dataset, count: int, seed: int) -> dict[str, Floats]:
    """Return random points in random cells of a grid; along an axis of one node they all have its
    coordinate.

    A cell is drawn with equal probability for each axis, then the position in it evenly in the
    coordinate itself.

    table: the grid, dataset of :func:`build`.
    count: number of points, >= 0.
    seed: seed of the generator, >= 0.
    Returns axis -> coordinates, (count,), in the units of the grid.
    """
    random = np.random.default_rng(seed)
    points = {}
    for name in axes_of(table):
        nodes = table[name].values
        if nodes.size == 1:
            points[name] = np.full(count, nodes[0])
            continue
        cell = random.integers(nodes.size - 1, size=count)
        points[name] = nodes[cell] + random.random(count) * (nodes[cell + 1] - nodes[cell])
    return points


def differences(table: Dataset, roller: Scene | Cylinder) -> dict[str, float]:
    """Return the largest difference of each field between the nodes of a grid and the rows of the
    law.

    table: :class:`xr.Dataset`, the grid, by whatever method it was computed, which is not changed.
    roller: :class:`Scene` or :class:`Cylinder`, roller of the grid, with all of its fields (else
    KeyError).
    Returns field -> largest difference over all nodes, a float >= 0: for :data:`RELATIVE_FIELDS`
    divided by the magnitude in the rows at the same node, for other fields by the largest magnitude
    in the rows.  Both are dimensionless.  Where that magnitude is 0, for example for M of elastic
    bodies, the difference itself is taken, in the unit of the field.
    """
    rows = _evaluate_nodes(roller, {name: table[name].values for name in axes_of(table)}, "table")
    found = {}
    for name in fields_of(table):
        size = np.abs(rows[name])
        scale = size if name in RELATIVE_FIELDS else size.max()
        found[name] = float(
            np.max(np.abs(table[name].values - rows[name]) / np.where(scale > 0.0, scale, 1.0))
        )
    return found
