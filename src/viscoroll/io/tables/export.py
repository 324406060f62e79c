"""Laws and grids in the formats of other programs."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from importlib.resources import files
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ... import __version__
from ...core.array_types import Floats
from ...core.errors import ParameterError
from ...core.files import replace_file, write_text
from ...core.symbols import PAPER
from ...materials.law.netcdf import parse_law
from ...materials.law_file import CHECKSUM, dataset_content
from . import schema, store

if TYPE_CHECKING:
    import xarray as xr

#: Numbers of what a grid is of, among its attributes.
_GIVEN = ("alpha", "kappa", "mu", "R", "m", "load")


def export(table: xr.Dataset, path: str | PathLike[str]) -> None:
    """Write a law or a grid for another program, whole or not at all.

    Parameters
    ----------
    table : of :func:`law`, :func:`build` or :func:`load`.
    path : its suffix is that of the format: of either .nc, or .cdf for readers without HDF5; of a law .h (C99 and C++:
        table and evaluator in one header) or .json; of a grid .csv, .txt (Modelica: CombiTable2D, CombiTimeTable) or
        .mat (MATLAB, Simulink).

    Raises
    ------
    ParameterError
        Another suffix; for Modelica a grid over alpha, as its tables have two inputs.
    FileError
        If it cannot be written there.

    Notes
    -----
    All formats hold the same bits as ``table``.
    """
    path = Path(path)
    store.check(table, "export")
    formats = LAW if store.is_law(table) else GRID
    if path.suffix not in formats:
        kind = "law" if store.is_law(table) else "grid"
        raise ParameterError("path", path, f"a name that ends in {', '.join(formats)} for a {kind}")
    formats[path.suffix](table, path)


def _write_netcdf3(table: xr.Dataset, path: Path) -> None:
    """64-bit offset format (CDF-2), which every netCDF library since 2004 reads."""
    with replace_file(path) as temporary:
        encoding = {name: {"_FillValue": None} for name in table.variables}
        table.to_netcdf(temporary, engine="scipy", format="NETCDF3_64BIT", encoding=encoding)


def _write_csv(table: xr.Dataset, path: Path) -> None:
    """A row of names, then a row for every node, first axis slowest; digits that read back to the same bits."""
    fields = table[list(schema.fields_of(table))]
    with replace_file(path) as temporary:
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
        *(f"error_{name} = {linear_error(table[name]):.3g}{_place(table[name])}" for name in ("Q", "M")),
    ]
    return ["#1", *(f"# {line}" for line in lines)]


def linear_error(field: xr.DataArray) -> float:
    """The stated error of linear interpolation, which before 1.2 had another name; NaN of an atlas."""
    spline = field.attrs.get("interpolation_error", np.nan) if "V" in field.dims else np.nan
    return float(field.attrs.get("linear_error", spline))


def _place(field: xr.DataArray) -> str:
    """Where the error of linear interpolation is largest, " at V = ..."; "" of tables that do not state it."""
    at = field.attrs.get("linear_error_at")
    return f" at {at}" if at else ""


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
        "linear_error_at": {name: table[name].attrs.get("linear_error_at", "") for name in names},
        "about": f"viscoroll {__version__}. {table.attrs['title']}. {PAPER}. Breakpoints and tables for n-D lookup; "
        "dimensions says which breakpoints a table is over. linear_error: absolute, of linear interpolation in all "
        f"breakpoints; linear_error_at: where it is largest. {table.attrs['comment']}",
        "given": {name: table.attrs[name] for name in (*_GIVEN, "material") if name in table.attrs},
    }
    with replace_file(path) as temporary:
        savemat(temporary, {"viscoroll": content}, do_compression=True)


def _write_header(found: xr.Dataset, path: Path) -> None:
    """Write the rows of a law and their evaluator as one header of C.

    found : dataset of a law, of half-spaces or of a cover.
    path : file to write; its stem becomes the name of the variable, of type vr_law.
    """
    name = path.stem
    if not re.fullmatch(r"[A-Za-z_]\w*", name, re.ASCII):
        raise ParameterError("path", path, "named as a variable of C may be, as rubber.h is")
    table = parse_law(dataset_content(found), path)
    front = table.record.rows[:8]
    arrays = {f"{name}_coefficients": table.coefficients}
    fields, of_cover = [repr(front[0].item()), _initializer(front[2:].reshape(3, 2)), *arrays], ["0", "{0.0}"]
    if table.cover is not None:
        arrays[f"{name}_creep"] = np.moveaxis(table.cover.creep, 0, -1)
        of_cover = [f"{name}_creep", _initializer(table.record.cover_rows[:8])]
    constants = "".join(
        f"static const double {array}[{len(rows)}][VR_TERMS][{rows.shape[-1]}] = {_initializer(rows)};\n"
        for array, rows in arrays.items()
    )
    evaluator = files("viscoroll.io.tables").joinpath("c/vr_law.h").read_text(encoding="utf-8")
    about = "\n".join(f" * {line}".rstrip() for line in found.attrs["material"].splitlines()).replace("*/", "* /")
    write_text(
        path,
        f"""/* {found.attrs["title"].replace("*/", "* /")}
 *
 * Written by {found.attrs["source"]}; T_ref = {table.T_ref!r} s; {CHECKSUM} {found.attrs[CHECKSUM]}
 *
{about}
 */
{evaluator}
#ifndef VR_LAW_{name}
#define VR_LAW_{name}
{constants}static const vr_law {name} = {{{len(table.coefficients)}, {table.e0}, {", ".join(fields + of_cover)}}};
#endif
""",
    )


def _initializer(values: Floats) -> str:
    """Return an array as a nested initializer of C, with digits that read back to the same bits."""
    text = json.dumps(values.tolist(), separators=(",", ":")).replace("],", "],\n")
    return text.translate(str.maketrans("[]", "{}")).replace("NaN", "NAN")


def _write_json(found: xr.Dataset, path: Path) -> None:
    numbers = {str(name): variable.values.tolist() for name, variable in found.variables.items()}
    about = ("title", "viscoroll_table", "bodies", "material", "comment", "references", "source", "license", CHECKSUM)
    content = {name: found.attrs[name] for name in about} | {"law_schema": int(found.attrs["law_schema"])} | numbers
    write_text(path, json.dumps(content, separators=(",", ":")))


_EITHER: dict[str, Callable[[xr.Dataset, Path], None]] = {".nc": store.save, ".cdf": _write_netcdf3}
#: Suffix -> who writes a law, or a grid.
LAW = _EITHER | {".h": _write_header, ".json": _write_json}
GRID = _EITHER | {".csv": _write_csv, ".txt": _write_modelica, ".mat": _write_matlab}
