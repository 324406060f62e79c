"""The schema of the file of a grid: variables, dimensions, attributes, and their check.

Files follow CF-1.11.  ``schema_version`` is "major.minor": a new minor version only adds,
a new major version changes the meaning of something and is refused by older readers.
The fields are described at the head of :mod:`.build`.
"""

from __future__ import annotations

import shlex
import sys
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Any

import numpy as np

from ... import __version__
from ...core.errors import FileError
from ...core.symbols import PAPER, SYMBOLS, attributes
from ...materials.law.grid import check_nodes, refuse_filled
from ...materials.law_file import KINDS as LAW_KINDS

if TYPE_CHECKING:
    import xarray as xr

#: Version of the schema that this package writes.
SCHEMA_VERSION = "1.4"
#: Global attribute with the kind of a file.
KIND = "viscoroll_table"
#: Kinds of grids; all but the first are of version 0.1.0.
KINDS = ("grid", "atlas", "literal", "material")
#: Fields over V (and alpha): they do not depend on the creepage.  delta_0 is that of a layer alone.
PLANE = ("lam", "epsilon", "M", "M_half_space", "M_cylinder", "delta_star", "zeta", "delta_0")
#: Fields over V and delta (and alpha).
VOLUME = ("beta", "Q")
#: Fields of a file of kind "atlas".
_ATLAS_FIELDS = ("beta", "Q_over_mu", "lam", "epsilon", "kappa_M", "kappa_delta_star_over_mu")

#: Attribute ``comment`` of a grid.
COMMENT = (
    "Signs, Eqs. (17), (18): the table holds V > 0. For V < 0 look up |V|: lam, epsilon, delta_star, delta_0 and beta "
    "are even in V; M, its two parts and Q(V, delta) are odd. Let d = delta - delta_0(V), where delta_0 is 0 in a "
    "grid without this field. beta is even in d, Q odd. beta has a kink at |d| = delta_star(V), beyond which the whole "
    "contact slips: beta = 0, |Q| = mu P. epsilon may exceed 1. "
    "A grid is for plots and for look-up blocks of other programs. Do not use it where the onset of full slip, "
    "|d| = delta_star, decides a result: look-up smooths the kink, and spline_error and linear_error of Q and "
    "beta, which are absolute, occur there. The file of a law (viscoroll tables law) is exact at every V, delta, "
    "kappa and mu, and has a tenth of the size; law.nc of make tables holds every alpha."
)


def axes_of(table: xr.Dataset) -> tuple[str, ...]:
    """Return the names of the axes of a grid, the first of which varies slowest.

    table: dataset of a grid, or of an atlas, the table of version 0.1.0.
    Returns ("V", "delta") or, if the dataset has that dimension, ("V", "delta", "alpha") of a grid; ("alpha",
    "kappa_V", "s") of an atlas, where s = |delta|/delta_star.
    Every kind but "atlas" counts as a grid, and whether the dataset has the axes is not checked.
    Raises KeyError for a dataset without the attribute :data:`KIND`, "viscoroll_table".
    """
    if table.attrs[KIND] == "atlas":
        return ("alpha", "kappa_V", "s")
    return ("V", "delta", *(("alpha",) if "alpha" in table.dims else ()))


def fields_of(table: xr.Dataset) -> tuple[str, ...]:
    """Return the names of the fields of a grid ``table``."""
    return _ATLAS_FIELDS if table.attrs[KIND] == "atlas" else (*VOLUME, *(name for name in PLANE if name in table))


def variable(name: str, dims: tuple[str, ...], values: Any, si: bool) -> xr.Variable:
    """Make a variable of a grid, with long_name, units, symbol, range, equation and reference as attributes.

    name: name of the quantity, a key of ``core.symbols.SYMBOLS``.
    dims: names of the axes of the variable.
    values: array of its values, over ``dims``.
    si: whether the values are in SI units, else dimensionless; the range of Q is then that of "mu P" in place of "mu".
    Returns the variable, float64.
    Raises KeyError for another name, ValueError of xarray where ``values`` have another number of axes than ``dims``.
    """
    import xarray as xr

    symbol = SYMBOLS[name]
    allowed = symbol.range.replace("mu", "mu P") if si else symbol.range  # of Q
    about = {"symbol": symbol.latex, "range": allowed, "equation": symbol.equation, "reference": PAPER}
    return xr.Variable(dims, np.asarray(values, dtype=np.float64), attributes(name, si) | about)


def global_attributes(title: str, grid: str, command: str | None) -> dict[str, str]:
    """Return the global attributes of a grid that is computed now.

    title: title of the grid.
    grid: axes of the grid in words.
    command: command that computed it, for ``history``; None or "": the command line of this process.
    Returns name -> text: Conventions, title, institution, source, history (time of the call in UTC and the command),
    references, comment, viscoroll_table ("grid"), schema_version, viscoroll_version and grid.
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
        KIND: "grid",
        "schema_version": SCHEMA_VERSION,
        "viscoroll_version": __version__,
        "grid": grid,
    }


def check(table: Any, path: Any) -> None:
    """Check kind, version, variables, dimensions, axes and values of a grid; nothing is returned or changed.

    Each axis and field must have float64 values, all finite and none a fill value, and fields those of a contact
    (:func:`.grid.check_nodes`); each axis at least one, strictly increasing; dimensions
    must be axes of the grid, in their order, and units those that :func:`variable` writes.  beta and Q are required, of
    the fields over V (:data:`PLANE`) none, of an atlas all fields; other variables are not examined.

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
    if str(about.get(KIND)) in LAW_KINDS:
        raise FileError(path, "is a law, not a grid: load it by vr.load_law, and evaluate it by vr.contact")
    if str(about.get(KIND)) not in KINDS:
        raise FileError(path, f"is not a table of viscoroll: attribute {KIND} is {about.get(KIND)!r:.40}")
    version, major = about.get("schema_version"), SCHEMA_VERSION.partition(".")[0]
    if str(version).partition(".")[0] != major:
        problem = f"has the table schema {version!s:.20}, but viscoroll {__version__} reads {major}.x"
        raise FileError(path, f"{problem}: build it again, or install the version that wrote it")
    axes = axes_of(table)
    for name in (*axes, *fields_of(table)):
        if name not in table.variables:
            raise FileError(path, f"is an incomplete table: variable {name!r} is missing")
        values, dims = table[name].values, table[name].dims
        own = (name,) if name in axes else tuple(dim for dim in axes if dim in dims)
        if dims != own:
            raise FileError(path, f"variable {name!r} has the dimensions {dims}: must be {own}")
        unit, written = table[name].attrs.get("units"), attributes(name, "load" in about)["units"]
        if unit != written:
            allowed = f"{written!r} (a grid in SI units has the attribute load: the force per length, N/m)"
            raise FileError(path, f"variable {name!r} is in {unit!r:.40}: must be in {allowed}")
        if values.dtype != np.float64:
            raise FileError(path, f"variable {name!r} must hold 64-bit floats")
        refuse_filled(table[name], path)
        if name in axes and (not values.size or (np.diff(values) <= 0.0).any()):
            raise FileError(path, f"coordinate {name!r} must increase strictly")
    check_nodes(table, path)
