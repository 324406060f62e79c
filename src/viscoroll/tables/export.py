"""Tables in the formats of other programs, each with the error of what that program makes between the nodes."""

from __future__ import annotations

from collections.abc import Callable
from datetime import UTC, datetime
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import __version__
from ..checks import checked
from ..errors import ParameterError, unknown
from ..files import replacing, write_text
from ..symbols import PAPER, SYMBOLS
from . import schema, store
from .accuracy import SAMPLE, SEED, linear_errors

if TYPE_CHECKING:
    import xarray as xr

#: An alpha is found by the six digits that messages print.
_SAME_ALPHA = 1e-6
_SAMPLED = f"largest of {SAMPLE} random points between the nodes (seed {SEED}), against the exact law"


def export(
    table: xr.Dataset, path: str | PathLike[str], format: str = "netcdf4", *, alpha: ArrayLike | None = None
) -> None:
    """Write a table for another program, whole or not at all.

    Parameters
    ----------
    table : of :func:`viscoroll.tables.build` or :func:`viscoroll.tables.load`.
    path : its ending must be that of the format.
    format : one of :data:`FORMATS`.  "modelica" wants a table over (V, delta, alpha) at one alpha.
    alpha : keep these alphas of a table over (V, delta, alpha) only; six digits decide.

    Raises
    ------
    ParameterError
        An unknown format, another ending, an alpha that the table does not hold, none or a matrix of them.
    OutputError
        If it cannot be written there.

    Notes
    -----
    All formats hold the same bits as ``table``.  The errors of linear interpolation that Modelica and MATLAB
    files state are measured when they are written (:func:`viscoroll.tables.accuracy.linear_errors`), and hold
    within 5 % at other random points (tests/tables/test_export.py).
    """
    check_format(format, path)
    kind = schema.check(table, "export")
    if alpha is not None:
        if kind != "literal":
            raise ParameterError("alpha", alpha, f"left out: a table of kind {kind} is exported whole")
        table = _at_alphas(table, checked("alpha", alpha))
    FORMATS[format][1](table, Path(path))


def check_format(format: str, path: str | PathLike[str]) -> None:
    """Raise ParameterError unless ``format`` is known and ``path`` ends as its files do."""
    if format not in FORMATS:
        raise unknown("format", format, FORMATS, "a format")
    suffix, _ = FORMATS[format]
    if Path(path).suffix != suffix:
        raise ParameterError("path", path, f"a name that ends in {suffix} for format {format}")


def _at_alphas(table: xr.Dataset, wanted: NDArray) -> xr.Dataset:
    """The part of a literal table at the ``wanted`` alphas; says so in its attributes."""
    wanted = np.atleast_1d(wanted)
    if wanted.ndim != 1 or not wanted.size:
        raise ParameterError("alpha", f"an array of shape {wanted.shape}", "one alpha or a vector of them")
    nodes = table["alpha"].values
    same = np.abs(wanted[:, np.newaxis] - nodes) <= _SAME_ALPHA * nodes
    missing = wanted[~same.any(axis=1)]
    if missing.size:
        raise ParameterError("alpha", f"{missing[0]:g}", f"one that the table holds: {_listed(nodes)}")
    part = table.isel(alpha=same.any(axis=0))
    now = datetime.now(UTC).strftime("%Y-%m-%dT%H:%M:%SZ")
    part.attrs["history"] = (
        f"{now} viscoroll {__version__}: only alpha = {_listed(part['alpha'].values)} kept\n" + (table.attrs["history"])
    )
    part.attrs["grid"] = f"{table.attrs['grid']}; of these only alpha = {_listed(part['alpha'].values)}"
    return part


def _listed(values: NDArray) -> str:
    return ", ".join(f"{value:g}" for value in values)


def _write_netcdf3(table: xr.Dataset, path: Path) -> None:
    """64-bit offset format (CDF-2), which every netCDF library since 2004 reads."""
    with replacing(path) as temporary:
        encoding = {name: {"_FillValue": None} for name in table.variables}
        table.to_netcdf(temporary, engine="scipy", format="NETCDF3_64BIT", encoding=encoding)


def _write_csv(table: xr.Dataset, path: Path) -> None:
    """A row of names, then a row for every node, first axis slowest; digits that read back to the same bits."""
    fields = table[list(schema.FIELDS[table.attrs[schema.KIND]])]
    with replacing(path) as temporary:
        fields.to_dataframe(dim_order=list(schema.AXES[table.attrs[schema.KIND]])).to_csv(temporary)


def _write_modelica(table: xr.Dataset, path: Path) -> None:
    """Q over (V, delta) for CombiTable2D blocks, M over V for CombiTable1D blocks and CombiTimeTable."""
    if table.attrs[schema.KIND] == "atlas":
        raise ParameterError("table", "an atlas", "one over (V, delta, alpha): a Modelica table has two inputs")
    of_one = table
    if "alpha" in table.dims:
        alphas = table["alpha"].values
        if alphas.size > 1:
            raise ParameterError("alpha", _listed(alphas), "one of these alone: a Modelica table has two inputs")
        of_one = table.isel(alpha=0)
    V, delta = table["V"].values, table["delta"].values
    two = np.block([[np.zeros((1, 1)), delta[np.newaxis]], [V[:, np.newaxis], of_one["Q"].values]])
    one = np.column_stack([V, of_one["M"].values])
    head = _modelica_header(table, V, delta)
    write_text(path, "\n".join([*head, _matrix("Q", two), _matrix("M", one), ""]))


def _modelica_header(table: xr.Dataset, V: NDArray, delta: NDArray) -> list[str]:
    errors = linear_errors(table)
    of = f"alpha = {table['alpha'].item()!r}, " if "alpha" in table.dims else ""
    lines = [
        f"viscoroll {__version__}: contact of a viscoelastic cylinder rolling with partial slip",
        PAPER,
        f"{of}kappa = {table['kappa'].item()!r}, mu = {table['mu'].item()!r}",
        *table.attrs.get("material", "").splitlines(),
        f"V = {table['V'].attrs['long_name']}, in [{V[0]:g}, {V[-1]:g}]",
        f"delta = {SYMBOLS['delta'].long_name}, in [{delta[0]:g}, {delta[-1]:g}]",
        f"Q = {SYMBOLS['Q'].long_name}: CombiTable2D (CombiTable2Ds from Modelica 4.0 on), u1 = V, u2 = delta",
        f"M = {SYMBOLS['M'].long_name}: CombiTable1Ds, u = V; CombiTimeTable reads the same layout",
        "For V < 0 look up |V| and turn the sign of Q and M.  Do not extrapolate (Extrapolation.NoExtrapolation).",
        f"Absolute error with Smoothness.LinearSegments, {_SAMPLED}:",
        f"error_Q = {errors['Q']:.3g}",
        f"error_M = {errors['M']:.3g}",
    ]
    return ["#1", *(f"# {line}" for line in lines)]


def _matrix(name: str, values: NDArray) -> str:
    rows = (" ".join(map(repr, row)) for row in values.tolist())
    return "\n".join([f"double {name}({values.shape[0]},{values.shape[1]})", *rows])


def _write_matlab(table: xr.Dataset, path: Path) -> None:
    """One struct ``viscoroll``, as alpha and beta are functions of MATLAB: breakpoints, tables, their linear error."""
    from scipy.io import savemat

    kind = table.attrs[schema.KIND]
    arrays = {str(name): table[name].values.squeeze() for name in (*schema.AXES[kind], *schema.FIELDS[kind])}
    arrays |= {name: table[name].values for name in ("kappa", "mu") if name in table.coords}
    content: dict[str, Any] = arrays | {
        "dimensions": {name: ", ".join(map(str, table[name].squeeze().dims)) for name in schema.FIELDS[kind]},
        "linear_error": linear_errors(table),
        "about": f"viscoroll {__version__}. {table.attrs['title']}. {PAPER}. Breakpoints and tables for n-D lookup; "
        f"dimensions says which breakpoints a table is over. linear_error: absolute, of linear interpolation in all "
        f"breakpoints, {_SAMPLED}. {table.attrs['comment']}",
    }
    if kind == "material":
        content["material"] = table.attrs["material"]
    if kind == "literal" and table["alpha"].size > 1:
        content["linear_error_at_alpha"] = linear_errors(table, at_nodes=("alpha",))
        content["about"] += " linear_error_at_alpha: the same at the alphas of the table."
    with replacing(path) as temporary:
        savemat(temporary, {"viscoroll": content}, do_compression=True)


#: Name of a format -> (how its files end, who writes them).
FORMATS: dict[str, tuple[str, Callable[[xr.Dataset, Path], None]]] = {
    "netcdf4": (".nc", store.save),
    "netcdf3": (".nc", _write_netcdf3),
    "csv": (".csv", _write_csv),
    "modelica": (".txt", _write_modelica),
    "matlab": (".mat", _write_matlab),
}
