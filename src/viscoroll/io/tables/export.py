"""Laws and grids in the formats of other programs."""

from __future__ import annotations

from collections.abc import Callable
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ... import __version__
from ...core.errors import ParameterError
from ...core.files import replacing, write_text
from ...core.symbols import PAPER
from . import schema, store
from .law import export_law

if TYPE_CHECKING:
    import xarray as xr

#: Numbers of what a grid is of, among its attributes.
_GIVEN = ("alpha", "kappa", "mu", "R", "m", "load")


def export(table: xr.Dataset, path: str | PathLike[str], format: str | None = None) -> None:
    """Write a law or a grid for another program, whole or not at all.

    Parameters
    ----------
    table : of :func:`law`, :func:`build` or :func:`load`.
    path : its suffix is that of the format: of either .nc; of a law .h (C99 and C++: table and evaluator in one header)
        or .json; of a grid .csv, .txt (Modelica: CombiTable2D, CombiTimeTable) or .mat (MATLAB, Simulink).
    format : "netcdf3" for readers without HDF5.

    Raises
    ------
    ParameterError
        Another suffix or format; for Modelica a grid over alpha, as its tables have two inputs.
    FileError
        If it cannot be written there.

    Notes
    -----
    All formats hold the same bits as ``table``.
    """
    path = Path(path)
    if format is not None and (format != "netcdf3" or path.suffix != ".nc"):
        raise ParameterError("format", repr(format), "left out, or 'netcdf3' of a name that ends in .nc")
    store.check(table, "export")
    if path.suffix == ".nc":
        (store.save if format is None else _write_netcdf3)(table, path)
    elif store.is_law(table):
        export_law(table, path)
    elif path.suffix in FORMATS:
        FORMATS[path.suffix](table, path)
    else:
        raise ParameterError("path", path, f"a name that ends in .nc, {', '.join(FORMATS)} for a grid")


def _write_netcdf3(table: xr.Dataset, path: Path) -> None:
    """64-bit offset format (CDF-2), which every netCDF library since 2004 reads."""
    with replacing(path) as temporary:
        encoding = {name: {"_FillValue": None} for name in table.variables}
        table.to_netcdf(temporary, engine="scipy", format="NETCDF3_64BIT", encoding=encoding)


def _write_csv(table: xr.Dataset, path: Path) -> None:
    """A row of names, then a row for every node, first axis slowest; digits that read back to the same bits."""
    fields = table[list(schema.fields_of(table))]
    with replacing(path) as temporary:
        fields.to_dataframe(dim_order=list(schema.axes_of(table))).to_csv(temporary)


def _write_modelica(table: xr.Dataset, path: Path) -> None:
    """Q over (V, delta) for CombiTable2D blocks, M over V for CombiTable1D blocks and CombiTimeTable."""
    of_one = table.squeeze("alpha") if table.sizes.get("alpha") == 1 else table
    if schema.axes_of(of_one) != ("V", "delta"):
        allowed = "one over (V, delta): a Modelica table has two inputs; table.sel(alpha=...) is at one alpha"
        raise ParameterError("table", f"over {', '.join(schema.axes_of(table))}", allowed)
    V, delta = table["V"].values, table["delta"].values
    two = np.block([[np.zeros((1, 1)), delta[np.newaxis]], [V[:, np.newaxis], of_one["Q"].values]])
    one = np.column_stack([V, of_one["M"].values])
    write_text(path, "\n".join([*_modelica_header(table), _matrix("Q", two), _matrix("M", one), ""]))


def _modelica_header(table: xr.Dataset) -> list[str]:
    units = {name: table[name].attrs["units"].replace("1", "dimensionless") for name in ("V", "Q", "M")}
    lines = [
        f"viscoroll {__version__}: {table.attrs['title']}",
        PAPER,
        *(f"{name} = {table.attrs[name]!r}" for name in _GIVEN if name in table.attrs),
        *str(table.attrs.get("material", "")).splitlines(),
        f"{table.attrs['grid']}; V: {units['V']}, Q: {units['Q']}, M: {units['M']}",
        "Q: CombiTable2D (CombiTable2Ds from Modelica 4.0 on), u1 = V, u2 = delta",
        "M: CombiTable1Ds, u = V; CombiTimeTable reads the same layout",
        "For V < 0 look up |V| and turn the sign of Q and M.  Do not extrapolate (Extrapolation.NoExtrapolation).",
        "Absolute error with Smoothness.LinearSegments, largest of random points between the nodes:",
        *(f"error_{name} = {linear_error(table[name]):.3g}" for name in ("Q", "M")),
    ]
    return ["#1", *(f"# {line}" for line in lines)]


def linear_error(field: xr.DataArray) -> float:
    """The stated error of linear interpolation, which before 1.2 had another name; NaN of an atlas."""
    spline = field.attrs.get("interpolation_error", np.nan) if "V" in field.dims else np.nan
    return float(field.attrs.get("linear_error", spline))


def _matrix(name: str, values: Any) -> str:
    rows = (" ".join(map(repr, row)) for row in values.tolist())
    return "\n".join([f"double {name}({values.shape[0]},{values.shape[1]})", *rows])


def _write_matlab(table: xr.Dataset, path: Path) -> None:
    """One struct ``viscoroll``, as alpha and beta are functions of MATLAB: breakpoints, tables, their linear error."""
    from scipy.io import savemat

    names = schema.fields_of(table)
    arrays = {name: table[name].values.squeeze() for name in (*schema.axes_of(table), *names)}
    content: dict[str, Any] = arrays | {
        "dimensions": {name: ", ".join(map(str, table[name].squeeze().dims)) for name in names},
        "linear_error": {name: linear_error(table[name]) for name in names},
        "about": f"viscoroll {__version__}. {table.attrs['title']}. {PAPER}. Breakpoints and tables for n-D lookup; "
        "dimensions says which breakpoints a table is over. linear_error: absolute, of linear interpolation in all "
        f"breakpoints. {table.attrs['comment']}",
        "given": {name: table.attrs[name] for name in (*_GIVEN, "material") if name in table.attrs},
    }
    with replacing(path) as temporary:
        savemat(temporary, {"viscoroll": content}, do_compression=True)


#: Suffix -> who writes a grid.
FORMATS: dict[str, Callable[[xr.Dataset, Path], None]] = {
    ".csv": _write_csv, ".txt": _write_modelica, ".mat": _write_matlab,
}  # fmt: skip
