"""The law of a grid: splines of Q over V and delta and of M over V, or over both, from a file of
this package or another program.

A grid is in SI units where its V has a unit, else dimensionless as a :class:`viscoroll.Scene`: V
over R/T_epsilon, Q over the load, M over load times radius, delta = (omega R - V)/V in both.

Tensor splines by scipy are packed into the form that compiled code reads (:func:`pack_spline`,
``kernels.splines``).
"""

import contextlib
import dataclasses
import io
import math
import os
from collections.abc import Iterator
from typing import Any

import numpy as np

from ..core import (
    DIMENSIONLESS,
    SI,
    DataArray,
    Dataset,
    FileError,
    Floats,
    OutOfTableError,
    ParameterError,
    Scale,
    check_array,
    check_number,
    conversion_factor,
    describe_value,
    described_error,
    read_sealed,
)
from .law_rows import FIELDS, CoupledRows
from .law_tables import LawTable, coupled_table

# --- The law of a grid ---

#: SI unit of each variable of a grid; a moment divided by a length is a force
UNITS = {"V": "m/s", "delta": "1", "Q": "N/m", "M": "N", "M_half_space": "N", "M_cylinder": "N"}
#: methods to interpolate to an alpha between the nodes, by the number of nodes less 2
_METHODS = ("linear", "quadratic", "cubic")
#: error of a value relative to the largest of its variable: files may have six digits only
_ROUNDING = 1e-5
#: fraction of the largest |Q| by which Q may fall with delta: to this, other programs iterate
_NOISE = 1e-3
#: moduli of what programs write where they have no value: the default of netCDF, and habits
_FILL_VALUES = np.array(
    [9.969209968386869e36, 1e20, np.float32(1e20), 1e30, 1e35, 9999.0, 99999.0, 999999.0]
)
#: moments, which of a layer depend on the traction and have either sign
_MOMENTS = "M", "M_half_space", "M_cylinder"
#: field -> highest value that a contact has, beside moments; the lowest is 0
_HIGHEST = {"beta": 1.0, "lam": np.inf, "delta_star": np.inf}
#: largest file that is read, bytes
_MOST_BYTES = 1 << 31


@dataclasses.dataclass(frozen=True, eq=False, repr=False)
class LawGrid:
    """The law that :func:`viscoroll.load_law` reads from a grid; :func:`viscoroll.law` makes it a
    function of V and omega.

    Attributes
    ----------
    rows : :class:`.law_rows.CoupledRows` of V and delta, for kappa = 1: ``mu`` is the largest
        abs(Q), 1 where it is not known, Q is divided by it, and M has the units of the grid;
        ``slips`` says whether the contact slips fully at both ends of delta, in both directions, at
        every speed: abs(Q) is there at least 1 - 1e-5 of its limit, and known beyond; needs a mu.
    R : radius in m; 1 for a dimensionless grid.
    load : force per length P in N/m; 1 for a dimensionless grid, and where it is not known.
    title : title of the file; "of another program" without one.
    kappa : R/l0 for which a dimensionless grid was computed; None where it states none.
    scale : :class:`.Scale` of its speeds, whose units are those of SI, or 1.
    """

    rows: CoupledRows
    R: float
    load: float
    title: str
    kappa: float | None
    scale: Scale

    def __repr__(self) -> str:
        return f"LawGrid({self.title}; for vr.law, or as the material of a Scene)"

    def table(self, kappa: float) -> LawTable:
        """Return the law for motions of a scene; of a grid in SI units times are in s, speeds over
        R/s.

        kappa: R/l0 of the scene, a number, which has no effect on the motion.
        Raises ParameterError for a grid without mu, or that does not slip fully at both ends of its
        axis of delta, and for another kappa than the grid states.
        """
        if self.kappa is not None and abs(kappa - self.kappa) > _ROUNDING * self.kappa:
            raise ParameterError("kappa", kappa, f"{self.kappa:g}, the R/l0 of the grid")
        if not self.rows.slips:
            fault = (
                "the global attribute mu"
                if math.isinf(self.rows.limit)
                else "full slip (|Q| = mu times load) at the first and the last delta of each V"
            )
            raise described_error(
                "material",
                f"is a grid without {fault}",
                "one with mu and full slip at both ends of delta, as the material of a Scene; "
                "vr.law takes any grid",
            )
        # rows hold M in N for kappa = 1: a table has kappa M/(P R)
        of_moments = kappa / (self.load * self.R)
        fields = self.rows.fields * [1.0, of_moments, of_moments]
        # lengths are not known, and the work of strain counts as that of slip
        fields = np.pad(fields, [(0, 0), (0, 0), (0, len(FIELDS) - fields.shape[-1])])
        # u = kappa |V| with V over R/s, from V in m/s
        u = kappa / self.R * self.rows.u
        edges = kappa * self.rows.edges
        rows = dataclasses.replace(
            self.rows, mu=self.rows.mu / self.load, u=u, edges=edges, fields=fields, fastest=u[-1]
        )
        # the material is not known: alpha = 1 stands for it
        return coupled_table(1.0, rows)

    def refuse_outside(self, V: Floats, omega: Floats) -> None:
        """Raise the OutOfTableError of a state that the caller has found to be outside the axes:
        for V if |V| is beyond the fastest speed, else for delta, which is not compared.
        V: speed in the unit of the grid, a number or an array of one; of V = 0 the error states an
            infinite or NaN delta, and numpy gives a RuntimeWarning.
        omega: angular velocity in the unit of the grid, likewise.
        """
        fastest = self.rows.fastest
        if np.abs(V) > fastest:
            raise OutOfTableError("V", float(V), -fastest, fastest)
        # 2 kappa times the ends of delta, with kappa = 1
        low, high = 0.5 * self.rows.edges[0, 1:3]
        raise OutOfTableError("delta", float(np.divide(omega * self.R - V, V)), low, high)


def friction_limit(attributes: Any) -> float:
    """Return the largest |Q| that the law allows, Eq. (15): mu, or in SI units mu times the load.

    attributes: mapping of the attributes of a grid, of which "mu" (dimensionless) and "load" (N/m;
        without it 1) are used.
    Returns a float in the unit of Q: dimensionless, or N/m; infinite without a mu, beside which
    load is not used.
    Raises ParameterError for one of them that is no finite number > 0.
    """
    if "mu" not in attributes:
        return np.inf
    return _positive(attributes, "mu") * _positive(attributes, "load")


def _positive(attributes: Any, name: str) -> float:
    """Return the attribute ``name`` of a grid, a number, 1 where it is not stated; raises
    ParameterError unless it is finite and > 0.
    """
    return check_number(name, attributes.get(name, 1.0), above=0.0)


def increases(nodes: Floats) -> bool:
    """Return whether each of ``nodes``, (n,), is larger than the one before."""
    return bool((np.diff(nodes) > 0.0).all())


def check_alpha(alpha: Any, ends: Any, source: Any) -> float:
    """Return ``alpha``, what a caller gave, as a number.

    ends: lowest and highest alpha that is allowed.
    source: the file, and perhaps advice, for the message.
    Raises ParameterError for None, what is no single number, and a number outside.
    """
    low, high = ends
    if alpha is not None and low <= (number := check_number("alpha", alpha)) <= high:
        return number
    raise ParameterError(
        "alpha", alpha, f"a number in [{low:.15g}, {high:.15g}], the range of {source}"
    )


def load_grid(path: str | os.PathLike[str], alpha: float | None = None) -> LawGrid | None:
    """Read the law of a grid from a netCDF file of any program.

    Parameters
    ----------
    path : file with variables V(V) > 0, delta(delta), Q over both and M over V or both, each with
        an attribute ``units`` ("1" for none); all over alpha too where there is an axis of that
        name.  In place of M there may be M_half_space and M_cylinder; beside M one of them may be
        missing, and without both each is half of M.  Its global attributes are mu (without it Q has
        no bound), and where V has a unit R in m and, beside mu, the load in N/m; all > 0.
    alpha : required where the grid has an axis alpha, whose nodes must be > 0 and ascend; between
        them a spline in ln alpha is used.  It must be left out, or None, for a grid without that
        axis.

    Returns
    -------
    LawGrid or None
        None for a file that is no netCDF or has no variables V, delta and Q.

    Raises
    ------
    FileError
        A file that cannot be read or differs from its seal; a variable that is missing or empty, is
        not of real numbers, has other dimensions or other units, is not finite or does not
        increase; a node with a fill value or of no contact (:func:`refuse_filled`,
        :func:`check_nodes`); an R, mu or load that is no finite number > 0; beside speeds with a
        unit no R, or a mu without load.
    ParameterError
        An alpha outside the grid, or none for a grid with that axis; an alpha for a grid without
        it.
    """
    import xarray as xr

    content = io.BytesIO(
        read_sealed(path, _MOST_BYTES, "law or grid", "write it again by the call that made it")
    )
    try:
        # else a variable with the unit "s" would become dates or durations
        table = xr.load_dataset(content, decode_times=False)
    except Exception:  # libraries raise many kinds
        return None
    if not {"V", "delta", "Q"} <= set(map(str, table.variables)):
        return None
    names = [name for name in (*UNITS, "alpha") if name in table.variables]
    if "M" not in names and not {"M_half_space", "M_cylinder"} <= set(names):
        raise _no_law(
            path,
            f"it has the variables {', '.join(map(str, table.variables)):.80}, but neither M (the "
            "rolling moment at each V) nor both M_half_space and M_cylinder: add M, or rename the "
            "moment to M",
        )
    for name in names:
        variable = table[name]
        if not (variable.size and variable.dtype.kind in "iuf"):
            found = (
                f"{name} = {describe_value(variable.values)}: must be real numbers, at least one"
            )
            raise _no_law(path, found)
        refuse_filled(variable, path)
        if name in ("V", "delta") and not (variable.size > 1 and increases(variable.values)):
            found = f"{name} = {describe_value(variable.values)}: must be two or more numbers"
            raise _no_law(path, f"{found}, each larger than the one before")
    with _told_of(path, table):
        table = _with_known_units(table)
        check_nodes(table, path)
    table = _at_alpha(table, path, alpha)
    with _told_of(path, table):
        return _law_of(table)


def _no_law(path: Any, reason: Any) -> FileError:
    """Return the FileError, not raised, of a file that is not the grid of a law, by ``reason``."""
    return FileError(path, f"is not a grid of a law, since {reason}")


@contextlib.contextmanager
def _told_of(path: Any, table: Dataset) -> Iterator[None]:
    """Raise KeyError, ValueError and TypeError of the body of the ``with`` as FileError; a context
    manager.

    They come of a missing variable, of values that scipy refuses and of attributes; the text of a
    ParameterError is quoted.
    path: path of the file, for the error.
    table: the grid, whose variables the error states.
    """
    try:
        yield
    except ParameterError as error:
        raise _no_law(path, error) from error
    except (KeyError, ValueError, TypeError) as error:
        found = ", ".join(
            f"{name}({', '.join(map(str, each.dims))})" for name, each in table.variables.items()
        )
        allowed = "V(V), delta(delta), Q(V, delta) and M(V) or M(V, delta), perhaps over alpha too"
        raise _no_law(
            path, f"it has {found} (dimensions in brackets): must have {allowed}"
        ) from error


def _refuse_nodes(variable: DataArray, bad: Any, path: Any, allowed: str) -> None:
    """Raise FileError for the first bad node of a variable, if any, with its value and index.

    variable: variable of a grid.
    bad: truth values of its shape.
    path: path of the file, for the message.
    allowed: words that follow "must be".
    """
    if bad.any():
        first = np.argwhere(bad)[0]
        index = ", ".join(f"{n} of {dim}" for dim, n in zip(variable.dims, first))
        found = describe_value(variable.values[tuple(first)].item())
        unit = str(variable.attrs.get("units", "1"))
        found += f" {unit}" * (unit != "1")
        where = f"{variable.name} = {found} at index {index or '0'}"
        raise _no_law(path, f"{where}: must be {allowed}")


def refuse_filled(variable: DataArray, path: Any) -> None:
    """Raise FileError for a node of a grid that has no value: not finite, a fill value, declared or
    customary, or outside of the valid range that the file declares.

    variable: variable of a grid, of real numbers, in the unit of the file; of an axis, which users
        choose, customary fill values are numbers as any other.
    path: path of the file, for the message.
    """
    values = variable.values
    customary = () if variable.name in variable.dims else _FILL_VALUES
    # NaN, which no value equals, where none is declared
    declared = [variable.attrs.get(name, np.nan) for name in ("_FillValue", "missing_value")]
    allowed = "finite (a _FillValue or missing_value that the file declares is read as nan)"
    _refuse_nodes(variable, ~np.isfinite(values), path, allowed)
    allowed = "a computed value: the file declares this number as the mark of a missing one"
    _refuse_nodes(variable, np.isin(values, declared), path, allowed)
    allowed = "a computed value: this number usually marks a missing one; compute it"
    _refuse_nodes(variable, np.isin(np.abs(values), customary), path, allowed)
    # limits beyond which a file declares values as missing (CF conventions 1.11, section 2.5.1)
    about = variable.attrs
    try:
        low, high = about.get("valid_range", (-np.inf, np.inf))
        limits = (about.get("valid_min", low), about.get("valid_max", high))
        packed = np.array([np.asarray(limit, float).item() for limit in limits])
        factor = variable.encoding.get("scale_factor", 1.0)
        # limits of packed numbers are packed too, and a negative factor exchanges them
        low, high = np.sort(factor * packed + variable.encoding.get("add_offset", 0.0))
    except (TypeError, ValueError) as error:
        given = {name: about[name] for name in about if str(name).startswith("valid_")}
        raise _no_law(
            path,
            f"{variable.name} has {describe_value(given)}: valid_range must be two numbers, "
            "valid_min and valid_max one each",
        ) from error
    margin = _ROUNDING * np.abs((low, high))
    invalid = (values < low - margin[0]) | (values > high + margin[1])
    valid = f"in [{low:g}, {high:g}], as its attributes valid_range, valid_min, valid_max declare"
    _refuse_nodes(variable, invalid, path, valid)


def check_nodes(table: Dataset, path: Any) -> None:
    """Raise FileError for a node of a grid whose field no contact has, with its value and index.

    All conditions are checked to the digits of a file, 1e-5 of the largest value:

    - |Q| <= mu P, Eq. (15); Q does not fall where delta grows; at both ends of the axis of delta it
      has the sign of delta (of delta - delta_0 if the grid has delta_0);
    - 0 <= beta <= 1; lam >= 0; delta_star >= 0;
    - M and its parts are >= 0 if they depend on V alone.  If M depends on delta too (a layer), the
      power of force and torque is >= 0: M + delta (R Q + M_cylinder) >= 0.

    Missing values are refused by :func:`refuse_filled`.

    table: dataset of a grid, in SI units or dimensionless, whose values are finite.
    path: path of its file, for messages.
    Raises ParameterError for a mu or load that is no finite number > 0.
    """
    limit = friction_limit(table.attrs)
    arm = _positive(table.attrs, "R")
    most = limit / table.attrs.get("mu", 1.0) * arm  # the load acts within R of the axis
    for name, high in (_HIGHEST | dict.fromkeys(_MOMENTS, most)).items():
        if name in table.variables and not (name in _MOMENTS and "delta" in table[name].dims):
            values = table[name].values
            rounding = _ROUNDING * np.abs(values).max()
            bad = (values < -rounding) | (values > high + rounding)
            allowed = f"in [0, {high:g}]" if high < np.inf else ">= 0"
            allowed += ", as M resists rolling, by at most load times R" * (name in _MOMENTS)
            _refuse_nodes(table[name], bad, path, allowed)
    Q = table["Q"].transpose(..., "delta")
    allowed = f"at most {limit:.6g} in magnitude, the friction limit mu times load"
    _refuse_nodes(Q, np.abs(Q.values) > limit * (1.0 + _ROUNDING), path, allowed)
    noise = _NOISE * np.abs(Q.values).max()
    # + 0 Q: in the shape of Q
    creep = (table["delta"] - table.get("delta_0", 0.0) + 0.0 * Q).transpose(*Q.dims).values
    against = Q.values * np.sign(creep) < -noise
    against[..., 1:-1] = False  # of a layer without delta_0 the sign changes beside delta = 0
    allowed = (
        "of the same sign as delta (as delta - delta_0, if the grid has delta_0), since a roller "
        "with omega R > V is driven forward by Q > 0"
    )
    _refuse_nodes(Q, against, path, allowed)
    if "M" in table.variables and "delta" in table["M"].dims:
        M = table["M"].transpose(*Q.dims)
        of_cylinder = _moments_of_bodies(table)[1].transpose(*Q.dims)
        lost = M + table["delta"] * (arm * Q + of_cylinder)
        # noise/_NOISE is the largest |Q|
        made = lost.values < -_ROUNDING * max(np.abs(M.values).max(), arm * noise / _NOISE)
        allowed = "larger, as the lost power M + delta (R Q + M_cylinder) is below 0"
        _refuse_nodes(M, made, path, allowed)
    # before the first node -infinity: it never falls there
    falls = np.diff(Q.values, prepend=-np.inf) < -noise
    allowed = "at least Q at the next smaller delta, as Q does not fall where delta grows"
    _refuse_nodes(Q, falls, path, allowed)


def _at_alpha(table: Dataset, path: Any, alpha: float | None) -> Dataset:
    """Return a grid at one alpha.

    table: dataset of a grid, with or without an axis alpha, > 0 and ascending; without it the grid
        is returned as it is.
    path: path of the file, for errors.
    alpha: wanted value, from the first to the last node, both included; None: not given.
    Returns the dataset without that axis: of a single node as it is, else interpolated in ln alpha,
    linear between two nodes, quadratic between three, cubic from four on.
    Raises ParameterError for an alpha outside the axis or no single number, none for a grid that
    has one, and one for a grid without; FileError for an axis that is not > 0 or does not increase.
    Errors of xarray pass.
    """
    if "alpha" not in table.dims:
        if alpha is not None:
            raise ParameterError(
                "alpha", describe_value(alpha), f"left out: {path} has no axis alpha"
            )
        return table
    nodes = table["alpha"].values
    if not (nodes[0] > 0.0 and increases(nodes)):
        raise _no_law(path, f"alpha = {describe_value(nodes)}: must be > 0 and increase strictly")
    wanted = np.log(check_alpha(alpha, nodes[[0, -1]], path))
    if nodes.size == 1:
        return table.squeeze("alpha")
    # by the number of nodes, the last for all larger numbers
    method: Any = _METHODS[min(nodes.size - 2, 2)]
    return table.assign_coords(alpha=np.log(nodes)).interp(alpha=wanted, method=method)


def _with_known_units(table: Dataset) -> Dataset:
    """Return a grid in SI units if its V has a unit, else without dimension.

    table: dataset of a grid; V, delta, Q, M, M_half_space and M_cylinder, where present, must have
        an attribute ``units``; "1" is no unit.
    Returns a dataset with doubles in the units of :data:`UNITS`, and their :class:`.Scale` as the
    attribute ``scale``; with "1" for V all are dimensionless, and the attributes R and load are 1.
    Raises ParameterError for a unit that is missing or of another dimension, and in SI units for a
    missing attribute R or, beside mu, load.
    """
    dimensionless = str(table["V"].attrs.get("units")) == "1"
    for name in (name for name in UNITS if name in table):
        unit = str(table[name].attrs.get("units", "missing"))
        wanted = "1" if dimensionless else UNITS[name]
        try:
            factor, _ = conversion_factor(unit, wanted)
        except ParameterError as error:
            allowed = "1" if wanted == "1" else f"{wanted} or a multiple of it"
            if name == "V":
                allowed += ", or 1 of a dimensionless grid"
            elif dimensionless:
                allowed += ", as the unit of V is 1"
            raise ParameterError(f"attribute units of {name}", unit, allowed) from error
        values = table[name].astype(float) * factor
        table = table.assign({name: values.assign_attrs(units=wanted)})
    if dimensionless:
        return table.assign_attrs(R=1.0, load=1.0, scale=DIMENSIONLESS)
    # the load is needed only for the friction limit, mu times load
    for name, unit in (("R", "m"), ("load", "N/m")):
        if name not in table.attrs and (name == "R" or "mu" in table.attrs):
            raise described_error(
                f"global attribute {name}", "is missing", f"given, in {unit}, as V has a unit"
            )
    return table.assign_attrs(scale=SI)


def _moments_of_bodies(table: Dataset) -> list[Any]:
    """Return M_half_space and M_cylinder of a grid: half of M each where neither is a variable; one
    that is missing is M without the other.
    """
    M: Any = table.get("M")
    bodies: list[Any] = [table.get(name) for name in _MOMENTS[1:]]
    for n, moment in enumerate(bodies):
        if moment is None:
            other = bodies[1 - n]
            bodies[n] = 0.5 * M if other is None else M - other
    return bodies


def _law_of(table: Dataset) -> LawGrid:
    """Return the law of a grid, as splines: cubic, in ln V, and Q in delta too, clipped to |Q| <=
    :func:`friction_limit`.

    table: dataset of a grid at one alpha, in SI units or dimensionless; M_half_space and
        M_cylinder as for :func:`load_grid`.
    Returns the :class:`LawGrid`; without the attribute ``mu`` Q is not clipped and ``slips`` is
    False.
    Raises KeyError for a missing variable, and ValueError, of which ParameterError is one, for
    values that are not finite, speeds that are not positive, axes that do not increase or have a
    single node, other dimensions, or an R, or a mu and load, that are no finite numbers > 0.
    """
    V = check_array("V", table["V"].values, above=0.0)
    delta = table["delta"].values
    limit = friction_limit(table.attrs)
    most = limit if limit < np.inf else 1.0
    Q = table["Q"].transpose("V", "delta").values
    slips = bool((Q[:, [0, -1]] * [-1.0, 1.0] >= (1.0 - _ROUNDING) * limit).all())
    bodies = _moments_of_bodies(table)
    moments = [field.broadcast_like(table["Q"]).transpose("V", "delta") for field in bodies]
    fields = np.stack([Q / most, *moments], axis=-1)
    # at V = 0 Q as at the slowest speed, and M over V alone is 0
    still = [1.0, *(float("delta" in field.dims) for field in bodies)]
    # the last row stands for infinite speed, which kernels refuse: beyond V[-1] nothing is known
    fields = np.concatenate([fields[:1] * still, fields, fields[-1:]])
    middle = 0.5 * (delta[0] + delta[-1])
    half = 0.5 * (delta[-1] - delta[0])
    # 2 kappa times creepages, with kappa = 1
    edges = np.tile(2.0 * np.array([middle, delta[0], delta[-1], middle]), (V.size + 2, 1))
    if slips:  # then Q has a zero, the creepage of free rolling; else it is not used
        from scipy import interpolate

        # a row at a time: scipy leaves out a zero that the row before has too
        zeros = [
            interpolate.CubicSpline(delta, row).roots(extrapolate=False) for row in fields[..., 0]
        ]
        edges[:, 3] = [2.0 * zero[zero.size // 2] for zero in zeros]
    # the ends exactly, which rounding would miss
    t = (delta - middle) / half
    t[[0, -1]] = -1.0, 1.0
    rows = CoupledRows(
        mu=most,
        u=V,
        t=t,
        edges=edges,
        fields=fields,
        graded=False,
        fastest=V[-1],
        slips=slips,
        limit=limit / most,
    )
    return LawGrid(
        rows=rows,
        R=_positive(table.attrs, "R"),
        load=_positive(table.attrs, "load"),
        title=str(table.attrs.get("title", "of another program")),
        kappa=_positive(table.attrs, "kappa") if "kappa" in table.attrs else None,
        scale=table.attrs["scale"],
    )


# --- Tensor splines on grids, by scipy ---


def _axis(knots: Floats, degree: int, log: bool, stride: int) -> Floats:
    """Return an axis of a spline in the form that ``kernels.splines.spline`` reads.

    knots: knots of a not-a-knot spline, ascending, with ``degree`` + 1 equal ones at either end, in
        the unit of the coordinate, or its logarithm.
    degree: 1 to 3, the degree of the spline.
    log: whether the spline runs in the logarithm of the coordinate; the knots are logarithms then.
    stride: number of coefficients that one step along the axis is.
    Returns one vector of 5 + 17 n numbers for n intervals between the different knots: n, degree +
    1, log (0 or 1) and stride; the n + 1 ends of the intervals; then for each interval four basis
    splines with four Taylor coefficients each about its left end, of which those from ``degree`` +
    1 on are 0.
    """
    from scipy import interpolate

    from ..kernels.law.spline_law import TERMS

    edges = knots[degree : knots.size - degree]
    of = np.arange(edges.size - 1)[:, None]
    own = np.arange(degree + 1)
    basis = np.zeros((edges.size - 1, TERMS, TERMS))
    every = interpolate.BSpline(knots, np.eye(knots.size - degree - 1), degree)
    for power in own:
        # in interval n only the basis splines n to n + degree are not 0
        basis[:, own, power] = every(edges[:-1], nu=power)[of, of + own] / math.factorial(power)
    return np.concatenate([[edges.size - 1, degree + 1, log, stride], edges, basis.ravel()])


def pack_spline(
    found: Any, axes: tuple[str, ...], logs: tuple[str, ...], bounds: tuple[float, float]
) -> Floats:
    """Return a spline over some of V, delta and alpha as the vector that ``kernels.splines.spline``
    reads.

    Parameters
    ----------
    found : a not-a-knot tensor spline, a scipy.interpolate.NdBSpline over all axes of the field; or
        the value, a number, of a field over no axis.
    axes : names of its axes, in their order, of "V", "delta" and "alpha".
    logs : names of the axes in whose logarithm it runs; other names in it have no effect.
    bounds : lowest and highest value, to which kernels clip results, in the unit of the values;
        infinite for none.

    Returns
    -------
    vector
        Six numbers: the bounds, and the indices in the vector where the axes V, delta and alpha and
        the coefficients begin; the three axes as in :func:`_axis`, with no interval and one basis
        spline, the constant 1, for an axis that the field does not depend on; the coefficients,
        last axis fastest, with 3 - degree zeros after the last ones of each axis.
    """
    # an axis that the field is not over: no interval, one basis spline, which is 1
    constant = np.zeros(21)
    constant[[1, 5]] = 1.0
    vectors = dict.fromkeys(("V", "delta", "alpha"), constant)
    # kernels read four coefficients along each axis: the zeros keep them within the vector
    values = np.pad(found.c, [(0, 3 - degree) for degree in found.k]) if axes else np.asarray(found)
    for n, name in enumerate(axes):
        vectors[name] = _axis(
            found.t[n], found.k[n], name in logs, values.strides[n] // values.itemsize
        )
    begin = np.cumsum([6, *(each.size for each in vectors.values())])
    return np.concatenate([bounds, begin, *vectors.values(), values.ravel()])
