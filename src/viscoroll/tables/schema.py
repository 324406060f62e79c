"""What a table file holds: variables, dimensions, attributes, and the check of them.

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

from .. import __version__
from ..errors import ConfigError, TableError
from ..symbols import PAPER, SYMBOLS, Symbol

if TYPE_CHECKING:
    import xarray as xr

SCHEMA_VERSION = "1.1"
#: Global attribute that names the kind of table: "atlas", "literal" or, since 1.1, "material".
KIND = "viscoroll_table"

AXES = {"atlas": ("alpha", "kappa_V", "s"), "literal": ("V", "delta", "alpha"), "material": ("V", "delta")}
_PLANE, _BLOCKS = ("alpha", "kappa_V"), ("block_alpha", "block_kappa_V", "block_s")
#: Kind -> variable -> dimensions.
VARIABLES: dict[str, dict[str, tuple[str, ...]]] = {
    "atlas": {
        "beta": AXES["atlas"],
        "Q_over_mu": AXES["atlas"],
        **dict.fromkeys(("lam", "epsilon", "kappa_M", "kappa_delta_star_over_mu"), _PLANE),
        "error_beta": _BLOCKS,
        "error_Q_over_mu": _BLOCKS,
        **{block: (block,) for block in _BLOCKS},
        **{f"{block}_edge": (f"{block}_edge",) for block in _BLOCKS},
    },
    "literal": {
        "beta": AXES["literal"],
        "Q": AXES["literal"],
        **dict.fromkeys(("lam", "epsilon", "M", "delta_star"), ("V", "alpha")),
        "kappa": (),
        "mu": (),
    },
    "material": {
        "beta": AXES["material"],
        "Q": AXES["material"],
        **dict.fromkeys(("lam", "epsilon", "M", "M_half_space", "M_cylinder", "delta_star"), ("V",)),
        "mode": ("mode",),
        "relaxation_strength": ("mode",),
        "relaxation_time": ("mode",),
        "kappa": (),
        "mu": (),
        "T_ref": (),
    },
}
#: Variables that can be interpolated.
FIELDS = {
    "atlas": ("beta", "Q_over_mu", "lam", "epsilon", "kappa_M", "kappa_delta_star_over_mu"),
    "literal": ("beta", "Q", "lam", "epsilon", "M", "delta_star"),
    "material": ("beta", "Q", "lam", "epsilon", "M", "M_half_space", "M_cylinder", "delta_star"),
}

_ERROR_OF = "largest interpolation error of {} off the nodes, over a block of cells"
_TABLE_SYMBOLS = {
    "kappa_delta_star_over_mu": Symbol(
        r"\kappa\delta^*/\mu", "critical creep ratio times kappa over mu", "[alpha^(-1/2)/2, inf)", "Eq. (9)"
    ),
    "mode": Symbol("i", "number of the mode, the slowest first", ">= 1"),
    "relaxation_strength": Symbol(
        "E_i", "strengths of relaxation of the law's series over its long-time modulus", "> 0"
    ),
    "relaxation_time": Symbol(r"\tau_i", "relaxation times of the law's series over T_ref", "> 0"),
    "T_ref": Symbol(r"T_\mathrm{ref}", "unit of time", "> 0", units="s"),
    "error_beta": Symbol(r"\max|\Delta\beta|", _ERROR_OF.format("beta"), ">= 0", "Eq. (10)"),
    "error_Q_over_mu": Symbol(r"\max|\Delta(Q/\mu)|", _ERROR_OF.format("Q_over_mu"), ">= 0", "Eq. (15)"),
}

_SIGNS = (
    "Signs, Eqs. (17), (18): the table holds V > 0. For V < 0 look up |V|: lam, epsilon, delta_star and beta are "
    "even in V, M and Q(V, delta) are odd. beta is even in delta, Q odd."
)
COMMENTS = {
    "atlas": (
        "One table for every mu and kappa. For given kappa, mu, V, delta: kappa_V = kappa |V|; "
        "delta_star = (mu/kappa) kappa_delta_star_over_mu, because delta_star is mu/kappa times a function of alpha "
        "and kappa_V alone, Eq. (9); s = |delta|/delta_star, and where s >= 1 the contact slips fully: beta = 0, "
        "|Q| = mu; else |Q| = mu Q_over_mu; M = kappa_M/kappa. Q has the sign of omega - V, M that of V, "
        "Eqs. (17), (18). Interpolate by a cubic spline in (ln alpha, ln kappa_V, u) with u = 1 - sqrt(1 - s), "
        "in which all nodes are uniform. epsilon may exceed 1."
    ),
    "literal": (
        _SIGNS + " Interpolate linearly; Q and beta have a kink at |delta| = delta_star(V, alpha), "
        "beyond which the contact slips fully: beta = 0, |Q| = mu. epsilon may exceed 1."
    ),
}
COMMENTS["material"] = (
    COMMENTS["literal"].replace("delta_star(V, alpha)", "delta_star(V)").replace("M and Q", "M, its two parts and Q")
    + " V is the speed of the axis times T_ref/R. The attribute material holds the bodies in SI units as sections "
    "[material] and, of the half-space where it differs, [base] of a TOML file; the series in the variables is that of "
    "their compliances together."
)


def symbol_of(name: str) -> Symbol:
    """Symbol of a variable of a table; blocks and their edges borrow that of their axis."""
    if name in _TABLE_SYMBOLS:
        return _TABLE_SYMBOLS[name]
    if name.startswith("block_"):
        axis = SYMBOLS[name.removeprefix("block_").removesuffix("_edge")]
        part = "edges" if name.endswith("_edge") else "middles"
        return axis._replace(long_name=f"{axis.long_name}: {part} of the blocks of cells")
    return SYMBOLS[name]


def variable(name: str, dims: tuple[str, ...], values: Any, **extra: Any) -> xr.Variable:
    """``values`` over ``dims`` with long_name, units, symbol, range, equation and reference."""
    import xarray as xr

    symbol = symbol_of(name)
    attributes = {
        "long_name": symbol.long_name,
        "units": symbol.units,
        "symbol": symbol.latex,
        "range": symbol.range,
        "equation": symbol.equation,
        "reference": PAPER,
    }
    return xr.Variable(dims, np.asarray(values, dtype=np.float64), attributes | extra)


def global_attributes(kind: str, title: str, grid: str, tolerances: str, command: str | None) -> dict[str, str]:
    """Global attributes of a table made now by ``command`` (default: this process's)."""
    import platform
    from importlib.metadata import version

    libraries = ("numpy", "scipy", "numba", "xarray", "h5netcdf", "h5py")
    now = datetime.now(UTC).strftime("%Y-%m-%dT%H:%M:%SZ")
    return {
        "Conventions": "CF-1.11",
        "title": title,
        "institution": "made by its user with the open-source package viscoroll",
        "source": f"viscoroll {__version__}: root solves of the contact law, Eqs. (6), (8)-(10), (15), (16)",
        "history": f"{now} {command or shlex.join(sys.orig_argv)}",
        "references": PAPER,
        "comment": COMMENTS[kind],
        KIND: kind,
        "schema_version": SCHEMA_VERSION,
        "viscoroll_version": __version__,
        "software": ", ".join(
            [f"Python {platform.python_version()}", *(f"{name} {version(name)}" for name in libraries)]
        ),
        "grid": grid,
        "tolerances": tolerances,
    }


def check_material(table: xr.Dataset, path: Any) -> None:
    """Refuse a table of a material that does not name it.

    Raises
    ------
    TableError
        Naming ``path``.
    """
    from .of_material import scene_of

    try:
        scene_of(table)
    except (AttributeError, KeyError, TypeError, ValueError, ConfigError) as error:
        text = " ".join(str(error).split())
        raise TableError(path, f"not a whole table: attribute material names none ({text:.200})") from error


def check_version(schema_version: Any, path: Any) -> None:
    """Refuse a table of another major schema version.

    Raises
    ------
    TableError
        Naming the version found and the one that is read.
    """
    major = SCHEMA_VERSION.partition(".")[0]
    if str(schema_version).partition(".")[0] != major:
        raise TableError(
            path,
            f"schema version {schema_version!s:.20}: this viscoroll ({__version__}) reads {major}.x; "
            "rebuild the table, or install the version that wrote it",
        )


def check(table: xr.Dataset, path: Any) -> str:
    """Kind of ``table``, once its variables, dimensions, axes and values are found in order.

    Raises
    ------
    TableError
        Naming ``path`` and the first thing that is wrong.
    """
    kind = getattr(table, "attrs", {}).get(KIND)
    if not isinstance(kind, str) or kind not in AXES:
        raise TableError(
            path, f"not a viscoroll table: attribute {KIND} = {kind!r:.40}, must be one of {', '.join(AXES)}"
        )
    check_version(table.attrs.get("schema_version"), path)
    for name, dims in {**{axis: (axis,) for axis in AXES[kind]}, **VARIABLES[kind]}.items():
        if name not in table.variables:
            raise TableError(path, f"not a whole table: variable {name!r} is missing")
        if table[name].dims != dims:
            raise TableError(path, f"variable {name!r} has dimensions {table[name].dims}, must be {dims}")
    for key, variable in table.variables.items():
        _check_values(str(key), variable.values, key in table.indexes, path)
    if kind == "material":
        check_material(table, path)
    return kind


def _check_values(name: str, values: NDArray, is_axis: bool, path: Any) -> None:
    if values.dtype != np.float64 or not np.isfinite(values).all():
        raise TableError(path, f"variable {name!r} must hold finite 64-bit floats")
    if is_axis and (not values.size or (np.diff(values) <= 0.0).any()):
        raise TableError(path, f"coordinate {name!r} must increase strictly")
