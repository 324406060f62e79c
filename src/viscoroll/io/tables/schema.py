"""What the file of a grid holds: variables, dimensions, attributes, and the check of them.

Files follow CF-1.11.  ``schema_version`` is "major.minor": a new minor version only adds,
a new major version changes the meaning of something and is refused by older readers.
"""

from __future__ import annotations

import shlex
import sys
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ... import __version__
from ...core.errors import FileError
from ...core.scale import si_unit
from ...core.symbols import PAPER, SYMBOLS, describe_quantity

if TYPE_CHECKING:
    import xarray as xr

SCHEMA_VERSION = "1.3"
#: Global attribute that names the kind of a file: "grid", or of earlier versions "atlas", "literal", "material".
KIND = "viscoroll_table"
KINDS = ("grid", "atlas", "literal", "material")
#: Fields over (V, alpha) and over (V, delta, alpha).
PLANE = ("lam", "epsilon", "M", "M_half_space", "M_cylinder", "delta_star", "zeta")
VOLUME = ("beta", "Q")
_ATLAS_FIELDS = ("beta", "Q_over_mu", "lam", "epsilon", "kappa_M", "kappa_delta_star_over_mu")

COMMENT = (
    "Signs, Eqs. (17), (18): the table holds V > 0. For V < 0 look up |V|: lam, epsilon, delta_star and beta are "
    "even in V; M, its two parts and Q(V, delta) are odd. beta is even in delta, Q odd. beta has a kink at "
    "|delta| = delta_star(V), beyond which the contact slips fully: beta = 0, |Q| = mu P. epsilon may exceed 1. "
    "A grid is for plots and for look-up blocks of other programs. Do not use it where the edge of full slip, "
    "|delta| = delta_star, decides a result: look-up smooths it, and the spline_error and linear_error of Q and beta, "
    "absolute, are those there. The file of a law (viscoroll tables law) is exact at every V, delta, kappa and mu, in "
    "a tenth of the size; law.nc of make tables holds every alpha."
)


def axes_of(table: xr.Dataset) -> tuple[str, ...]:
    """Its axes, the first slowest."""
    if table.attrs[KIND] == "atlas":
        return ("alpha", "kappa_V", "s")
    return ("V", "delta", *(("alpha",) if "alpha" in table.dims else ()))


def fields_of(table: xr.Dataset) -> tuple[str, ...]:
    """Variables that can be interpolated."""
    return _ATLAS_FIELDS if table.attrs[KIND] == "atlas" else (*VOLUME, *(name for name in PLANE if name in table))


def variable(name: str, dims: tuple[str, ...], values: Any, si: bool) -> xr.Variable:
    """``values`` over ``dims`` with long_name, units, symbol, range, equation and reference."""
    import xarray as xr

    symbol = SYMBOLS[name]
    attributes = {
        "long_name": describe_quantity(name, si), "units": si_unit(name) if si else "1", "symbol": symbol.latex,
        "range": symbol.range, "equation": symbol.equation, "reference": PAPER,
    }  # fmt: skip
    return xr.Variable(dims, np.asarray(values, dtype=np.float64), attributes)


def global_attributes(title: str, grid: str, command: str | None) -> dict[str, str]:
    """Global attributes of a table made now by ``command`` (default: this process's)."""
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
    """Refuse what is no table of a grid: its kind, version, variables, dimensions, axes and values.

    Raises
    ------
    FileError
        Naming ``path`` and the first thing that is wrong.
    """
    attributes = getattr(table, "attrs", {})
    if attributes.get(KIND) not in KINDS:
        raise FileError(path, f"is no table of viscoroll: attribute {KIND} is {attributes.get(KIND)!r:.40}")
    version, major = attributes.get("schema_version"), SCHEMA_VERSION.partition(".")[0]
    if str(version).partition(".")[0] != major:
        problem = f"is a table of schema {version!s:.20}, and this viscoroll ({__version__}) reads {major}.x"
        raise FileError(path, f"{problem}: build it again, or install the version that wrote it")
    axes = axes_of(table)
    for name in (*axes, *fields_of(table)):
        if name not in table.variables:
            raise FileError(path, f"is no whole table: variable {name!r} is missing")
        if tuple(dim for dim in axes if dim in table[name].dims) != table[name].dims:
            raise FileError(path, f"variable {name!r} has dimensions {table[name].dims}, out of {axes} in this order")
        _check_values(name, table[name].values, name in axes, path)


def _check_values(name: str, values: NDArray, is_axis: bool, path: Any) -> None:
    if values.dtype != np.float64 or not np.isfinite(values).all():
        raise FileError(path, f"variable {name!r} must hold finite 64-bit floats")
    if is_axis and (not values.size or (np.diff(values) <= 0.0).any()):
        raise FileError(path, f"coordinate {name!r} must increase strictly")
