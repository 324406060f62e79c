"""Files of laws and grids: schema, save, load.

The schema of the file of a grid: variables, dimensions, attributes, and their check.

Files follow CF-1.11.  ``schema_version`` is "major.minor": a new minor version only adds,
a new major version changes the meaning of something and is refused by older readers.
The fields are described at the head of :mod:`.grid_build`.

Files of tables: atomic save, and a load that checks everything it reads.
"""

from __future__ import annotations

import io
import shlex
import sys
from datetime import UTC, datetime
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import __version__
from ..core import PAPER, SYMBOLS, FileError, attributes, read_sealed, write_dataset
from ..laws import check_nodes, refuse_filled
from ..materials import checked_netcdf

if TYPE_CHECKING:
    import xarray as xr


# --- The schema of the file of a grid ---

#: Version of the schema that this package writes.
SCHEMA_VERSION = "1.4"
#: Global attribute with the kind of a file.
KIND = "viscoroll_table"
#: Kind of the file of a grid.
GRID = "grid"
#: Fields over V (and alpha): they do not depend on the creepage.  delta_0 is that of a layer alone.
PLANE = ("lam", "epsilon", "M", "M_half_space", "M_cylinder", "delta_star", "zeta", "delta_0")
#: Fields over V and delta (and alpha).
VOLUME = ("beta", "Q")
#: Fields over V that of a layer are over V and delta: there they depend on the traction.
OF_TRACTION = ("lam", "epsilon", "M", "M_half_space", "M_cylinder", "zeta")

#: Attribute ``comment`` of a grid.
COMMENT = (
    "Signs, Eqs. (17), (18): the table holds V > 0. For V < 0 look up |V|: lam, epsilon, "
    "delta_star, delta_0 and beta "
    "are even in V; M, its two parts and Q(V, delta) are odd. Let d = delta - delta_0(V), where "
    "delta_0 is 0 in a "
    "grid without this field, where beta is even in d, Q odd. beta has a kink at |d| = "
    "delta_star(V), in a grid with delta_0 at other d of either sign, beyond which the whole "
    "contact slips: beta = 0, |Q| = mu P. epsilon may exceed 1. "
    "A grid is for plots and for look-up blocks of other programs. Do not use it where the onset "
    "of full slip decides a result: look-up smooths the kink, and spline_error and "
    "linear_error of Q and "
    "beta, which are absolute, occur there. The file of a law (viscoroll tables law) is exact at "
    "every V, delta, "
    "kappa and mu, and has a tenth of the size; law.nc of make tables holds every alpha."
)


def axes_of(table: xr.Dataset) -> tuple[str, ...]:
    """Return the names of the axes of a grid, the first of which varies slowest.

    table: dataset of a grid.
    Returns ("V", "delta") or, if the dataset has that dimension, ("V", "delta", "alpha"); whether
    the dataset has the axes is not checked.
    """
    return ("V", "delta", *(("alpha",) if "alpha" in table.dims else ()))


def fields_of(table: xr.Dataset) -> tuple[str, ...]:
    """Return the names of the fields of a grid ``table``."""
    return (*VOLUME, *(name for name in PLANE if name in table))


def variable(name: str, dims: tuple[str, ...], values: Any, si: bool) -> xr.Variable:
    """Make a variable of a grid, with long_name, units, symbol, range, equation and reference as
    attributes.

    name: name of the quantity, a key of ``core.symbols.SYMBOLS``.
    dims: names of the axes of the variable.
    values: array of its values, over ``dims``.
    si: whether the values are in SI units, else dimensionless; the range of Q is then that of "mu
    P" in place of "mu".
    Returns the variable, float64.
    Raises KeyError for another name, ValueError of xarray where ``values`` have another number of
    axes than ``dims``.
    """
    import xarray as xr

    symbol = SYMBOLS[name]
    allowed = symbol.range.replace("mu", "mu P") if si else symbol.range  # of Q
    about = {
        "symbol": symbol.latex,
        "range": allowed,
        "equation": symbol.equation,
        "reference": PAPER,
    }
    return xr.Variable(dims, np.asarray(values, dtype=np.float64), attributes(name, si) | about)


def global_attributes(title: str, grid: str, command: str | None) -> dict[str, str]:
    """Return the global attributes of a grid that is computed now.

    title: title of the grid.
    grid: axes of the grid in words.
    command: command that computed it, for ``history``; None or "": the command line of this
    process.
    Returns name -> text: Conventions, title, institution, source, history (time of the call in UTC
    and the command), references, comment, viscoroll_table ("grid"), schema_version,
    viscoroll_version and grid.
    """
    now = datetime.now(UTC).strftime("%Y-%m-%dT%H:%M:%SZ")
    return {
        "Conventions": "CF-1.11",
        "title": title,
        "institution": "made by its user with the open-source package viscoroll",
        "source": f"viscoroll {__version__}: the contact law, Eqs. (6), (8)-(10), (15), (16)",
        "history": f"{now} {command or shlex.join(sys.orig_argv)}",
        "references": PAPER,
        "comment": COMMENT,
        KIND: GRID,
        "schema_version": SCHEMA_VERSION,
        "viscoroll_version": __version__,
        "grid": grid,
    }


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
    if not hasattr(table, "attrs"):
        raise FileError(path, f"needs a dataset, not {table!r:.60}: read a file by vr.tables.load")
    about = table.attrs
    if is_law(table):
        raise FileError(
            path, "is a law, not a grid: load it by vr.load_law, and evaluate it by vr.contact"
        )
    if str(about.get(KIND)) != GRID:
        raise FileError(
            path, f"is not a table of viscoroll: attribute {KIND} is {about.get(KIND)!r:.40}"
        )
    version = about.get("schema_version")
    major = SCHEMA_VERSION.partition(".")[0]
    if str(version).partition(".")[0] != major:
        problem = (
            f"has the table schema {version!s:.20}, but viscoroll {__version__} reads {major}.x"
        )
        raise FileError(path, f"{problem}: build it again, or install the version that wrote it")
    axes = axes_of(table)
    for name in (*axes, *fields_of(table)):
        if name not in table.variables:
            raise FileError(path, f"is an incomplete table: variable {name!r} is missing")
        values = table[name].values
        dims = table[name].dims
        own = (name,) if name in axes else tuple(dim for dim in axes if dim in dims)
        if dims != own:
            raise FileError(path, f"variable {name!r} has the dimensions {dims}: must be {own}")
        unit = table[name].attrs.get("units")
        written = attributes(name, "load" in about)["units"]
        if unit != written:
            allowed = (
                f"{written!r} (a grid in SI units has the attribute load: the force per "
                "length, N/m)"
            )
            raise FileError(path, f"variable {name!r} is in {unit!r:.40}: must be in {allowed}")
        if values.dtype != np.float64:
            raise FileError(path, f"variable {name!r} must hold 64-bit floats")
        refuse_filled(table[name], path)
        if name in axes and (not values.size or (np.diff(values) <= 0.0).any()):
            raise FileError(path, f"coordinate {name!r} must increase strictly")
    check_nodes(table, path)


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


def save(table: xr.Dataset, path: str | PathLike[str]) -> None:
    """Write a law or a grid as netCDF-4/HDF5: whole and synced, or not at all.

    The file ends with a SHA-256 of its bytes, which other programs do not see.

    Parameters
    ----------
    table : a Dataset of :func:`law_dataset`, :func:`grid_build` or :func:`tables.load`.
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
    check_content(table, path)
    plain = table.copy()
    for variable in plain.variables.values():
        variable.encoding = {}
    # Compression does not make the coefficients of a law smaller: their last digits are noise.
    encoding = (
        {str(name): {"_FillValue": None} for name in plain.variables} if is_law(plain) else None
    )
    write_dataset(plain, path, encoding, sealed=True)


def load(path: str | PathLike[str]) -> xr.Dataset:
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

    content = read_sealed(path, _MAX_BYTES, "table of viscoroll", "build it again")
    try:
        table = xr.load_dataset(
            io.BytesIO(content), engine="h5netcdf", mask_and_scale=False, decode_times=False
        )
    except Exception as error:  # libraries raise errors of many kinds
        problem = (
            "is damaged or is not a table of viscoroll "
            f"({' '.join(str(error).split()):.120}): build it again"
        )
        raise FileError(path, problem) from error
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
    KeyError
        A table of another program without the attribute title, or a law without its errors.

    Examples
    --------
    >>> import viscoroll as vr
    >>> vr.tables.save(vr.tables.law(11.0), "law.nc")
    >>> text = vr.tables.info("law.nc")
    """
    table = load(path)
    about = table.attrs
    size = Path(path).stat().st_size / 1e3
    lines = [f"{path}: {about[KIND]}, {size:.0f} kB", about["title"], ""]
    if is_law(table):
        lines += [f"  {'function':<18}largest error"]
        lines += [
            f"  {name:<18}{error:.1e}"
            for name, error in checked_netcdf.stated_errors(table).items()
        ]
    else:
        axes = {axis: table[axis].values for axis in axes_of(table)}
        lines += [
            f"  {name:<8} {nodes.size:>5} nodes in [{nodes[0]:g}, {nodes[-1]:g}]"
            for name, nodes in axes.items()
        ]
        lines += ["", f"  {'field':<26}{'axes':<18}error between the nodes"]
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
