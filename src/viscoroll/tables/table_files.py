"""Files of laws and grids: schema, save, load; and interpolation between the nodes of a grid.

The schema of the file of a grid: variables, dimensions, attributes, and their check.  A grid is a
table of fields of the contact over speed V, creepage delta and perhaps alpha,
T_epsilon/T_sigma; the fields are described at the head of :mod:`.grid_build`.

Files follow CF-1.11.  ``schema_version`` is "major.minor": a new minor version only adds,
a new major version changes the meaning of something and is refused by older readers.
Save is atomic, and load checks everything it reads.  :func:`interpolate` uses tensor cubic splines.
"""

import io
import pathlib
from collections.abc import Iterable
from os import PathLike
from typing import Any

import numpy as np

from .. import __version__
from ..core import (
    ArrayLike,
    Dataset,
    FileError,
    OutOfTableError,
    ParameterError,
    Values,
    attributes,
    broadcast_shape,
    check_array,
    check_names,
    describe_value,
    read_sealed,
    unit_of,
    write_dataset,
)
from ..laws import check_nodes, friction_limit, increases, pack_spline, refuse_filled
from ..materials import COUPLED, KIND, checked_netcdf

# --- The schema of the file of a grid ---

#: Version of the schema that this package writes.
SCHEMA_VERSION = "1.4"
#: Kind of the file of a grid.
GRID = "grid"
#: What a user can do about a file that is not as it was written.
_REBUILD = "make it again by vr.tables.law or build, or by `viscoroll tables law` or `tables build`"
#: Fields over V (and alpha): they do not depend on the creepage.  delta_0 is that of a layer
#: and of the coupled solution alone.
PLANE = ("lam", "epsilon", "M", "M_half_space", "M_cylinder", "delta_star", "zeta", "delta_0")
#: Fields over V and delta (and alpha).
VOLUME = ("beta", "Q")
#: Fields over V that of a layer, and by the coupled solution, are over V and delta: they depend on
#: the traction there.
OF_TRACTION = ("lam", "epsilon", "M", "M_half_space", "M_cylinder", "zeta")


def axes_of(table: Dataset) -> tuple[str, ...]:
    """Return the names of the axes of a grid, the first of which varies slowest.

    table: dataset of a grid.
    Returns ("V", "delta") or, if the dataset has that dimension, ("V", "delta", "alpha"); whether
    the dataset has the axes is not checked.
    """
    return ("V", "delta", *(("alpha",) if "alpha" in table.dims else ()))


def fields_of(table: Dataset) -> tuple[str, ...]:
    """Return the names of the fields of a grid ``table``."""
    return (*VOLUME, *(name for name in PLANE if name in table))


def check_grid(table: Any, path: Any) -> None:
    """Check kind, version, variables, dimensions, axes and values of a grid; nothing is returned or
    changed.

    Each axis and field must have float64 values, all finite and none a fill value, and fields those
    of a contact (:func:`.law_grid.check_nodes`); each axis at least one, strictly increasing;
    dimensions
    must be axes of the grid, in their order, and units those that :func:`variable` writes.  beta
    and Q are required, of the fields over V (:data:`PLANE`) none; other variables are not examined.

    Parameters
    ----------
    table : dataset; anything else is refused too.
    path : path of its file, or another name, for messages.

    Raises
    ------
    FileError
        With ``path`` and the first thing that is wrong.
    ParameterError
        A mu, or a load beside it, that is no finite number > 0.
    """
    if fault := _fault_of(table, path):
        raise FileError(path, fault)
    check_nodes(table, path)


def _fault_of(table: Any, path: Any) -> str:
    """Return what is wrong with a grid but for the values of its fields, the first fault in words
    that follow the path, as :func:`check_grid` states them; "" if nothing is.

    table, path: as in :func:`check_grid`.
    Raises FileError for a node without a value.
    """
    if not hasattr(table, "attrs"):
        return (
            f"is {describe_value(table)}, but must be a dataset, as vr.tables.build and "
            "vr.tables.load(file) return it"
        )
    about = table.attrs
    if is_law(table):
        return (
            "is a law, not a grid: give vr.load_law(file) as material= of a Scene or Cylinder, and "
            "call the method contact of this roller"
        )
    if str(kind := about.get(KIND)) != GRID:
        return (
            f"is not a table of viscoroll (its attribute {KIND} is {kind!r:.40}, that of a grid "
            f"{GRID!r}): give a dataset of vr.tables.build, or for a law of vr.tables.law, or a "
            "file that vr.tables.save wrote"
        )
    version = str(about.get("schema_version"))
    major = SCHEMA_VERSION.partition(".")[0]
    if version.partition(".")[0] != major:
        return (
            f"has schema_version = {version:.20}, but viscoroll {__version__} reads {major}.x; "
            "make the grid again by vr.tables.build or `viscoroll tables build`, or use the "
            "version of viscoroll that wrote it"
        )
    axes = axes_of(table)
    for name in (*axes, *fields_of(table)):
        if name not in table.variables:
            return (
                f"is incomplete, as variable {name!r} is missing: keep all variables of the grid, "
                "or make it again by vr.tables.build or `viscoroll tables build`"
            )
        values = table[name].values
        dims = table[name].dims
        own = (name,) if name in axes else tuple(dim for dim in axes if dim in dims)
        if dims != own:
            return (
                f"variable {name!r} has the dimensions {dims}, but must have {own} in this order: "
                "select by lists, as .isel(V=[0]), which keep dimensions, or make the grid again "
                "by vr.tables.build"
            )
        unit = table[name].attrs.get("units")
        # a grid of a cylinder, in SI units, states its load; that of a scene has none
        written = attributes(name, "load" in about)["units"]
        if unit != written:
            return (
                f"variable {name!r} has units = {unit!r:.40}: must be {written!r} (a grid with the "
                "attribute load, the force per length in N/m, is in SI units, one without it "
                "dimensionless)"
            )
        if values.dtype != np.float64:
            return f"variable {name!r} is of type {values.dtype}: convert it by .astype(float)"
        refuse_filled(table[name], path)
        if name in axes and not values.size:
            return f"coordinate {name!r} has no values: keep one at least"
        if name in axes and not increases(values):
            return (
                f"coordinate {name!r} does not increase strictly: sort it by .sortby({name!r}), "
                f"and leave out equal values by .drop_duplicates({name!r})"
            )
    return ""


# --- Files of tables ---

#: Largest size of a file; no table is larger.
_MAX_BYTES = 1 << 31
#: Attribute of a field with an error of interpolation -> its name in :func:`tables.info`.
_ERROR_NAMES = {"spline_error": "spline", "linear_error": "linear"}


def is_law(table: Any) -> bool:
    """Whether a dataset ``table`` is the law of a material or of every alpha; else it is a grid, or
    no table.
    """
    return str(getattr(table, "attrs", {}).get(KIND)) in checked_netcdf.KINDS


def check_content(table: Any, path: Any) -> None:
    """Raise FileError if a dataset is neither a law nor a grid, is incomplete, or differs from its
    checksum.

    Of a law the checksum of its numbers is compared; a grid has none.

    table: the dataset; anything else is refused too.
    path: path of its file, or another name, for the message.
    """
    if is_law(table):
        checked_netcdf.check_law(checked_netcdf.dataset_content(table), path)
    else:
        check_grid(table, path)


def save(table: Dataset, path: str | PathLike[str]) -> None:
    """Write a law or a grid as netCDF-4/HDF5: whole and synced, or not at all.

    The file ends with a SHA-256 of its bytes, which other programs do not see.

    Parameters
    ----------
    table : dataset of :func:`law`, :func:`build` or :func:`load`, all of ``viscoroll.tables``.
    path : file to write; a file of that name is replaced.

    Raises
    ------
    FileError
        If it cannot be written there; a file of that name is then left as it was.  If ``table`` is
        neither a law nor a grid, is incomplete, of another major version of the schema, or a law
        whose numbers differ from their checksum.

    Examples
    --------
    >>> import viscoroll as vr
    >>> vr.tables.save(vr.tables.law(11.0), "law.nc")

    Notes
    -----
    :func:`tables.load` returns the same values, bit for bit (``tests/tables/test_grids.py``,
    ``tests/tables/test_law.py``).
    """
    check_content(table, f"the table for {path}")
    # a table that was read has the encoding of its file, which may be another program's
    plain = table.drop_encoding()
    # Compression does not make the coefficients of a law smaller: their last digits are noise.
    encoding = (
        {str(name): {"_FillValue": None} for name in plain.variables} if is_law(plain) else None
    )
    write_dataset(plain, path, encoding, sealed=True)


def load(path: str | PathLike[str]) -> Dataset:
    """Read a law or a grid of the schema 1.x into memory, check it and
    close the file.

    Parameters
    ----------
    path : file written by :func:`tables.save`.  The SHA-256 at its end is compared before the file
        is parsed; a file that another program has written or edited has none, and its content alone
        is checked.

    Returns
    -------
    xarray.Dataset
        As it was saved, bit for bit.

    Raises
    ------
    FileError
        A file that is missing, truncated or damaged, larger than 2 GiB, of another major schema
        version, or no table; a law whose numbers differ from their checksum.

    Examples
    --------
    >>> import viscoroll as vr
    >>> vr.tables.save(vr.tables.law(11.0), "law.nc")
    >>> table = vr.tables.load("law.nc")
    """
    import xarray as xr

    content = read_sealed(path, _MAX_BYTES, "law or a grid of viscoroll", _REBUILD)
    try:
        # numbers as they are written: no fill values as NaN, no seconds as durations
        table = xr.load_dataset(
            io.BytesIO(content), engine="h5netcdf", mask_and_scale=False, decode_times=False
        )
    except Exception as error:  # libraries raise errors of many kinds
        raise FileError(
            path,
            f"is damaged, or is HDF5 but not netCDF-4: {_REBUILD}"
            if content.startswith(b"\x89HDF")
            else "is not a netCDF-4 file of a law or grid: give a .nc file of vr.tables.save or "
            "`viscoroll tables` (a .cdf file is netCDF-3, for other programs)",
        ) from error
    table.attrs = {  # xarray decodes as ASCII what another program has not declared UTF-8
        name: text.encode(errors="surrogateescape").decode(errors="replace")
        if isinstance(text, str)
        else text
        for name, text in table.attrs.items()
    }
    check_content(table, path)
    table.encoding["source"] = str(path)  # for messages, as where xarray reads a file
    return table


def info(path: str | PathLike[str]) -> str:
    """Return the summary of a law or a grid: its functions or fields, their stated errors, its
    origin.

    Parameters
    ----------
    path : file of a law or a grid.

    Returns
    -------
    str
        Lines to print, joined by newlines: path, kind and size of the file; title; of a law a line
        for each function with its largest error; of a grid a line for each axis with its nodes and
        range, then one for each field with its axes and the absolute errors that it states
        ("spline", "linear"); at the end those of the attributes material,
        comment, source, history and checksum that the file has.

    Raises
    ------
    FileError
        As :func:`tables.load`.

    Examples
    --------
    >>> import viscoroll as vr
    >>> vr.tables.save(vr.tables.law(11.0), "law.nc")
    >>> text = vr.tables.info("law.nc")
    """
    table = load(path)
    about = table.attrs
    size = pathlib.Path(path).stat().st_size / 1e3
    lines = [f"{path}: {about[KIND]}, {size:.0f} kB", about.get("title", "no title"), ""]
    if is_law(table):
        stated = checked_netcdf.stated_errors(table)
        error = "absolute error" if about[KIND] == COUPLED else "relative error"
        lines += [f"  {'function':<18}largest {error}"]
        lines += [f"  {name:<18}{each:.1e}" for name, each in stated.items()]
    else:
        for name in axes_of(table):
            nodes = table[name].values
            word = f"node{'s' * (nodes.size > 1)} in [{nodes[0]:g}, {nodes[-1]:g}]"
            unit = unit_of(table[name].attrs) or "dimensionless"
            lines.append(f"  {name:<8} {nodes.size:>5} {word}, {unit}")
        lines += ["", f"  {'field':<26}{'axes':<18}absolute error between the nodes"]
        for name in fields_of(table):
            field = table[name]
            errors = ", ".join(
                f"{word} {field.attrs[key]:.2g}"
                for key, word in _ERROR_NAMES.items()
                if key in field.attrs
            )
            lines.append(f"  {name:<26}{', '.join(map(str, field.dims)):<18}{errors}")
    keys = ("material", "comment", "source", "history", checked_netcdf.CHECKSUM)
    return "\n".join([*lines, "", *(f"{key}: {about[key]}" for key in keys if key in about)])


# --- Interpolation between the nodes of a grid ---


class Interpolant:
    """A table prepared for repeated interpolation; :func:`interpolate` prepares one in each call.

    A call ``interpolant(fields, V=..., delta=...)`` takes names of fields and points, and raises
    the errors of :func:`interpolate`; with ``linear=False`` it returns the same values.

    Parameters
    ----------
    table : a Dataset of :func:`viscoroll.tables.build` or :func:`viscoroll.tables.load`.
        The spline of a field is computed at its first use, from the values at that time.
    linear : whether to interpolate linearly in V, delta and alpha, as look-up blocks do; else by
        cubic splines in ln V, delta and ln alpha.

    Raises
    ------
    FileError
        If it is not a grid, as the law of a material is none, is incomplete, or is in other units
        than it was built in.
    ParameterError
        A mu, or a load beside it, that is no finite number > 0.

    Examples
    --------
    >>> import viscoroll as vr
    >>> grid = vr.tables.build(
    ...     vr.presets.PAPER_SECTION_5, [0.1, 0.2, 0.3, 0.4], delta=[-0.1, 0.0, 0.1]
    ... )
    >>> look_up = vr.tables.Interpolant(grid)
    >>> bool(look_up(["Q"], V=0.25, delta=0.01).Q > 0.0)
    True
    """

    def __init__(self, table: Dataset, linear: bool = False) -> None:
        """Check a table and choose its axes and bounds; splines are computed at the first use of a
        field.

        table : the grid, dataset of a file or of ``build``.
        linear : whether interpolation is linear in V, delta and alpha, else by cubic splines in ln
            V, delta and ln alpha.
        Raises FileError if it is not a grid, is incomplete or in other units; ParameterError for
        its mu and load.
        """
        check_grid(table, getattr(table, "encoding", {}).get("source", "the dataset"))
        self._table = table
        self._axes = axes_of(table)
        self._degree = 1 if linear else 3
        #: axis -> function of the coordinate in which fields are smooth; splines run in its values
        self._maps = dict.fromkeys(() if linear else ("V", "alpha"), np.log)
        self._splines: dict[str, Any] = {}
        # The law has these bounds; a spline may exceed them near the kink at delta_star.
        limit = friction_limit(table.attrs)
        self._bounds = {"Q": (-limit, limit), "beta": (0.0, 1.0)}

    def __call__(self, fields: Iterable[str] | None = None, **points: ArrayLike) -> Values:
        """Interpolate fields at points.

        fields: a name or names of fields of the table; None: all, which needs a coordinate on every
            axis; of an empty iterable the Values are empty.
        points: axis -> coordinates, numbers or arrays that broadcast, in the units of the table.  A
            coordinate is needed on each axis of the fields, also on one of a single node; others
            may be given too.
        Returns the fields as :class:`Values`, each a new array of the broadcast shape of all
        points, a float where all are numbers.  Q and beta are clipped to the bounds of the law:
        |Q| <= mu P and 0 <= beta <= 1.
        Raises ParameterError and OutOfTableError as :func:`interpolate`.
        """
        known = fields_of(self._table)
        names = check_names(
            "fields", known if fields is None else fields, known, "a field of this table"
        )
        needed = {str(dim) for name in names for dim in self._table[name].dims}
        if not needed <= points.keys() <= set(self._axes):
            wanted = ", ".join(axis for axis in self._axes if axis in needed)
            raise ParameterError(
                "coordinates",
                ", ".join(points) or "none",
                f"{wanted or 'none'}, as needed for {', '.join(names)} (this grid has the axes "
                f"{', '.join(self._axes)})",
            )
        coordinates = {
            name: check_array(name, value, unit=self._table[name].attrs["units"])
            for name, value in points.items()
        }
        shape = broadcast_shape(**coordinates)
        for name, array in coordinates.items():
            low, high = self._table[name].values[[0, -1]]  # an axis ascends
            outside = (array < low) | (array > high)
            if outside.any():
                raise OutOfTableError(name, float(array[outside].flat[0]), low, high)
            coordinates[name] = np.broadcast_to(self._maps.get(name, np.asarray)(array), shape)
        results = {}
        for name in names:
            dims, values = self._spline(name)
            if dims:
                values = values(np.stack([coordinates[dim] for dim in dims], axis=-1))
            if name in self._bounds:
                values = np.clip(values, *self._bounds[name])
            # a field over fewer axes than the points is repeated; copied, so that it can be written
            results[name] = np.broadcast_to(values, shape).copy() if shape else float(values)
        return Values(results, title="Interpolated", si="load" in self._table.attrs)

    def jitted(self, field: str) -> tuple[Any, Any]:
        """Return a field for numba's jitted functions: a function ``at(spline, V, delta, alpha)``
        and its spline.

        Parameters
        ----------
        field : name of a field of the grid, over V, delta and alpha or some of them.

        Returns
        -------
        at : jitted function of the spline and three floats V, delta and alpha, in the units of the
            table.  It returns a :class:`.spline_law.Value`: ``value`` and its
            derivatives ``dV``, ``ddelta`` and ``dalpha``.  Q and beta are clipped to the bounds of
            the law; where that happens the derivatives are 0.  All four are NaN for a coordinate
            outside of its axis.  The field may not depend on one of the coordinates, or the grid
            may have a single node on that axis: then any number may be given there, it is ignored,
            and its derivative is 0.
        spline : vector of doubles, the first argument of ``at``.

        Raises
        ------
        ParameterError
            An unknown field.

        Examples
        --------
        >>> import viscoroll as vr
        >>> grid = vr.tables.build(
        ...     vr.presets.PAPER_SECTION_5, [0.1, 0.2, 0.3, 0.4], delta=[-0.1, 0.0, 0.1]
        ... )
        >>> at, Q = vr.tables.Interpolant(grid).jitted("Q")
        >>> at(Q, 0.25, 0.01, 0.0).ddelta > 0.0
        True

        Notes
        -----
        Values differ from those of this class by rounding, slopes are those of the spline
        (``tests/tables/test_splines.py``).
        """
        from ..kernels.law.spline_law import spline_at

        (name,) = check_names("field", field, fields_of(self._table), "a field of this table")
        dims, found = self._spline(name)
        bounds = self._bounds.get(name, (-np.inf, np.inf))
        return spline_at, pack_spline(found, dims, tuple(self._maps), bounds)

    def _spline(self, name: str) -> tuple[tuple[str, ...], Any]:
        """Return a field as a spline over its axes, fitted at first use and kept in ``_splines``.

        It is a not-a-knot tensor spline.  Axes of one node are left out, since nothing can be
        interpolated along them.  The degree is ``_degree``, along axes of fewer than that + 1 nodes
        their number less 1.

        name: name of a field, which the caller has checked (else KeyError).
        Returns (names of the remaining axes, in their order; the spline).  The spline is a function
        of coordinates as ``_maps`` makes them, (..., axes); it returns values in the unit
        of the field, (...).  It does not check that points lie inside the axes.  If no axis
        remains, the names are () and the second entry is the value of the field, an array of shape
        ().
        Raises ValueError of scipy where values of the table are not finite, as after the caller
        changed them.
        """
        from scipy.interpolate import NdBSpline, make_interp_spline

        if name not in self._splines:
            field = self._table[name].squeeze()
            dims = tuple(map(str, field.dims))
            spline = field.values
            knots = []
            degrees = []
            for n, dim in enumerate(dims):
                nodes = self._maps.get(dim, np.asarray)(self._table[dim].values)
                degrees.append(min(self._degree, nodes.size - 1))
                one = make_interp_spline(nodes, spline, k=degrees[n], axis=n)
                knots.append(one.t)
                # scipy returns coefficients with the axis of the spline first
                spline = np.moveaxis(one.c, 0, n)
            if dims:
                spline = NdBSpline(tuple(knots), np.ascontiguousarray(spline), tuple(degrees))
            self._splines[name] = dims, spline
        return self._splines[name]


def interpolate(table: Dataset, fields: Iterable[str] | None = None, **points: ArrayLike) -> Values:
    """Interpolate fields of a grid between its nodes, without extrapolation.

    Parameters
    ----------
    table : Dataset of :func:`viscoroll.tables.build` or :func:`viscoroll.tables.load`.
    fields : a name or names out of the table's fields; default all, which need a coordinate on
        every axis.
    **points : coordinates, numbers or arrays that broadcast, in the table's units: ``V``, ``delta``
        and, where the table has it, ``alpha``.  ``delta`` is needed for beta and Q only.

    Returns
    -------
    Values
        The fields as attributes, in the units of the table, arrays of the broadcast shape of all
        coordinates; floats if all coordinates are numbers.

    Raises
    ------
    OutOfTableError
        A coordinate outside the axis of the table, naming the range.
    ParameterError
        An unknown field, a coordinate that is missing, unknown, NaN, infinite or of a unit of
        another dimension, shapes that do not broadcast; a mu of ``table``, or a load beside it,
        that is no finite number > 0.
    FileError
        If ``table`` is not a grid, is incomplete, or is in other units than it was built in.

    Examples
    --------
    >>> import viscoroll as vr
    >>> grid = vr.tables.build(
    ...     vr.presets.PAPER_SECTION_5, [0.1, 0.2, 0.3, 0.4], delta=[-0.1, 0.0, 0.1]
    ... )
    >>> found = vr.tables.interpolate(grid, ["M"], V=[0.15, 0.25])
    >>> found.M.shape
    (2,)

    Notes
    -----
    Tensor not-a-knot cubic spline in ln V, delta and ln alpha, of a lower degree along an axis of
    fewer than four nodes, clipped to |Q| <= mu P and 0 <= beta <= 1; the largest error at random
    points is stated in ``spline_error`` of each field, which another point may exceed
    (``tests/tables/test_grids.py``), and the point in ``spline_error_at``.  The largest errors of
    beta occur where full slip begins, as beta falls there with a vertical tangent.  Each call
    builds the splines anew, which takes most of its time; keep an :class:`tables.Interpolant` for
    repeated calls.  A law (:func:`viscoroll.tables.law`, :func:`viscoroll.contact`) has none of
    these errors.
    """
    return Interpolant(table)(fields, **points)
