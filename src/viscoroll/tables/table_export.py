"""Export of laws and grids: netCDF, C, JSON, CSV, Modelica, MATLAB."""

import json
import os
import re
from importlib import resources
from pathlib import Path
from typing import Any

import numpy as np

from .. import __version__
from ..core import (
    PAPER,
    Dataset,
    Floats,
    ParameterError,
    as_path,
    described_error,
    replace_file,
    write_text,
)
from ..laws import LawTable, parse_law
from ..materials import CHECKSUM, dataset_content
from .table_files import axes_of, check_content, fields_of, is_law, save

#: Attributes of a grid with the parameters of its roller.
_PARAMETERS = ("alpha", "kappa", "mu", "R", "m", "load")
#: Pattern of the names that a law in C cannot have: keywords of C and C++, and the evaluator's own.
_TAKEN = (
    "vr_.*|auto|bool|break|case|catch|char|class|const|continue|default|delete|do|double|else|enum|"
    "explicit|export|extern|false|float|for|friend|goto|if|inline|int|long|main|mutable|namespace|"
    "new|operator|private|protected|public|register|restrict|return|short|signed|sizeof|static|"
    "struct|switch|template|this|throw|true|try|typedef|typename|union|unsigned|using|virtual|void|"
    "volatile|while"
)
#: Attribute of a field of a grid with the largest absolute error of linear interpolation.
_ERROR = "linear_error"


def export(table: Dataset, path: str | os.PathLike[str]) -> None:
    """Write a law or a grid for another program, whole or not at all.

    Parameters
    ----------
    table : dataset of :func:`law`, :func:`build` or :func:`load`, all of ``viscoroll.tables``.
    path : file to write, whose suffix, also in capitals, selects the format; a file of that name is
        replaced.  For a law and a grid: .nc (netCDF-4), or .cdf (netCDF-3, for readers without
        HDF5).  For a law: .h (C99 and C++: table and evaluator in one header) or .json.  For a
        grid: .csv, .txt (Modelica: CombiTable2D, CombiTimeTable) or .mat (MATLAB, Simulink).

    Raises
    ------
    ParameterError
        Another suffix; for C a file name that, without its suffix, is no identifier; for Modelica a
        grid over several alphas, as its tables have two inputs.
    FileError
        If it is no path or cannot be written there; ``table`` is neither a law nor a grid, is
        incomplete, of another major version of the schema, or a law whose numbers differ from their
        checksum; for C the law of every alpha.

    Examples
    --------
    >>> import viscoroll as vr
    >>> vr.tables.export(vr.tables.law(11.0), "rubber.h")

    Notes
    -----
    The numbers in a file have the same bits as in ``table`` (``tests/tables/test_grids.py``,
    ``tests/tables/test_law.py``).  netCDF has all variables and attributes; CSV has the variables
    alone, Modelica Q and M alone; a header of C has the polynomials and their limits; JSON has all
    variables, and of the attributes title, viscoroll_table, bodies, material, comment, references,
    source, license, the checksum and law_schema.
    """
    path = as_path(path)
    check_content(table, "table")
    kind, formats = ("law", LAW) if is_law(table) else ("grid", GRID)
    suffix = path.suffix.lower()
    if suffix not in formats:
        raise ParameterError("path", path, f"a name that ends in {', '.join(formats)} for a {kind}")
    formats[suffix](table, path)


def _write_netcdf3(table: Dataset, path: Path) -> None:
    """Write a law or a grid in the 64-bit offset format (CDF-2), which every netCDF library since
    2004 reads.

    table: dataset of the law or grid.
    path: file to write; it is replaced if it exists.
    Raises FileError if it cannot be written.
    """
    with replace_file(path) as temporary:
        encoding = {name: {"_FillValue": None} for name in table.variables}
        table.to_netcdf(temporary, engine="scipy", format="NETCDF3_64BIT", encoding=encoding)


def _write_csv(table: Dataset, path: Path) -> None:
    """Write a grid as CSV: a row of names, then one for every node, the first axis slowest.

    Columns are the axes, then the fields; a field that does not depend on the creepage is repeated
    for each delta.  The digits read back to the same bits.

    table: dataset of the grid.
    path: file to write; it is replaced if it exists.
    Raises FileError if it cannot be written.
    """
    fields = table[list(fields_of(table))]
    with replace_file(path) as temporary:
        fields.to_dataframe(dim_order=list(axes_of(table))).to_csv(temporary)


def _write_modelica(table: Dataset, path: Path) -> None:
    """Write tables of a grid for Modelica: Q over (V, delta) for CombiTable2D, M over V for
    CombiTable1D blocks.

    The file is text: "#1", comments, then "double Q(n+1,m+1)", whose first column is V and first
    row delta with 0 in the corner, and "double M(n,2)" with the columns V and M, or as Q for a
    layer, in the units of the grid.  Other fields are left out.

    table: dataset of a grid over V and delta with Q and M (else KeyError); an axis alpha must have
    one node.
    path: file to write; it is replaced if it exists.
    Raises ParameterError for a grid over several alphas; FileError if the file cannot be written;
    KeyError as :func:`_modelica_header`.
    """
    plane = table.squeeze("alpha") if table.sizes.get("alpha") == 1 else table
    if axes_of(plane) != ("V", "delta"):
        raise described_error(
            "table",
            f"has the axes {', '.join(axes_of(table))}",
            "a grid over V and delta alone, the two inputs of a Modelica table; take one alpha, as "
            "by table.isel(alpha=[0]), or build the grid with a single alpha",
        )
    if "M" not in table:
        raise described_error("table", "has no variable M", "a grid with M, as of vr.tables.build")
    lines = ["#1", *(f"# {line}" for line in _modelica_header(table))]
    for name in ("Q", "M"):
        matrix = np.column_stack([table["V"], plane[name]])
        if "delta" in plane[name].dims:
            # Modelica does not read the corner, but it must be there
            matrix = np.vstack([np.append(0.0, table["delta"]), matrix])
        rows, columns = matrix.shape
        lines += [f"double {name}({rows},{columns})"]
        lines += [" ".join(map(repr, row)) for row in matrix.tolist()]
    write_text(path, "\n".join([*lines, ""]))


def _modelica_header(table: Dataset) -> list[str]:
    """Return the lines that describe a grid and its use in Modelica, without marks of a comment.

    table: dataset of the grid.
    Returns texts of one line, in this order: version and title; the paper; a line for each
    parameter of the roller that the grid states, and the material as TOML; axes and units; use of Q
    and of M; signs for V < 0; the absolute errors of linear interpolation in Q and M, with the
    point where each occurs if the grid states it (NaN if it states none).
    Raises KeyError for a grid without the attributes title and grid, or without units of V, Q and
    M.
    """
    units = {name: table[name].attrs["units"] for name in ("V", "delta", "Q", "M")}
    stated = ", ".join(
        f"{name}: {'dimensionless' if unit == '1' else unit}" for name, unit in units.items()
    )
    errors = [
        f"error_{name} = {table[name].attrs.get(_ERROR, np.nan):.3g}"
        + (f" at {point}" if (point := table[name].attrs.get("linear_error_at")) else "")
        for name in ("Q", "M")
    ]
    return [
        f"viscoroll {__version__}: {table.attrs['title']}",
        PAPER,
        *(f"{name} = {table.attrs[name]!r}" for name in _PARAMETERS if name in table.attrs),
        *str(table.attrs.get("material", "")).splitlines(),
        f"Grid of {table.attrs['grid']}; units: {stated}",
        "Q: CombiTable2D (CombiTable2Ds from Modelica 4.0 on), u1 = V, u2 = delta",
        "M: as Q"
        if "delta" in table["M"].dims
        else "M: CombiTable1Ds, u = V; CombiTimeTable reads the same layout",
        "For V < 0 look up |V| and change the sign of Q and M.  Do not extrapolate "
        "(Extrapolation.NoExtrapolation).",
        "Absolute error with Smoothness.LinearSegments, the largest at random points between the "
        "nodes:",
        *errors,
    ]


def _write_matlab(table: Dataset, path: Path) -> None:
    """Write a grid as one struct ``viscoroll`` of MATLAB: breakpoints, tables, linear errors,
    dimensions, parameters.

    Its fields are each axis and each field of the grid by name, arrays whose axes of one node are
    dropped (such an axis itself is a number); structs ``dimensions`` (names of the axes of each
    field, as "V, delta"), ``linear_error`` (NaN where none is stated) and ``linear_error_at`` (""
    where none is stated), each with an entry for every field of the grid; a text ``about``; and a
    struct ``given`` with those of alpha, kappa, mu, R, m, load and material that the grid states.
    All is in one struct because alpha and beta are functions of MATLAB, which variables of these
    names would hide.

    table: dataset of the grid, with the attributes title and comment (else KeyError).
    path: file to write; it is replaced if it exists.
    Raises FileError if it cannot be written.
    """
    from scipy import io

    names = fields_of(table)
    # lookup blocks want no axes of one node
    arrays = {name: table[name].values.squeeze() for name in (*axes_of(table), *names)}
    content = arrays | {
        "dimensions": {name: ", ".join(map(str, table[name].squeeze().dims)) for name in names},
        "linear_error": {name: table[name].attrs.get(_ERROR, np.nan) for name in names},
        "linear_error_at": {name: table[name].attrs.get("linear_error_at", "") for name in names},
        "about": f"viscoroll {__version__}. {table.attrs['title']}. {PAPER}. Breakpoints and "
        "tables for n-D lookup; dimensions names the breakpoints of each table. linear_error: "
        "absolute error of linear interpolation in all breakpoints; linear_error_at: the point "
        f"where it is largest. {table.attrs['comment']}",
        "given": {
            name: table.attrs[name] for name in (*_PARAMETERS, "material") if name in table.attrs
        },
    }
    with replace_file(path) as temporary:
        io.savemat(temporary, {"viscoroll": content}, do_compression=True)


def _write_header(dataset: Dataset, path: Path) -> None:
    """Write the numbers of a law and their evaluator as one header of C.

    The header contains title, source, T_ref, checksum and material as a comment, the evaluator
    (``c/vr_law.h``, of a table of the coupled solution ``c/vr_table.h`` too), and constants of
    which the last is ``static const vr_law NAME`` or ``static const vr_table NAME``.

    dataset : dataset of a law, of half-spaces, of a cover, or of the coupled solution.
    path : file to write, replaced if it exists; its stem becomes the name of the variable.
    Raises ParameterError for a stem that is no identifier of C; FileError for the law of every
    alpha, which has no such evaluator, for a law that is incomplete, and if the file cannot be
    written.
    """
    name = path.stem
    if not re.fullmatch(rf"(?!({_TAKEN})$)[A-Za-z_]\w*", name, re.ASCII):
        raise ParameterError(
            "path",
            path,
            "a file name that without .h is a name in C (letters, digits, _; no digit first; no "
            "keyword of C or C++, nor vr_...), as rubber.h",
        )
    table = parse_law(dataset_content(dataset), dataset.encoding.get("source", "the table"))
    coupled = table.coupled is not None
    constants = (_table_constants if coupled else _law_constants)(table, name)
    evaluator = "".join(
        resources.files("viscoroll.tables").joinpath(f"c/{part}.h").read_text(encoding="utf-8")
        for part in ("vr_law", "vr_table")[: 1 + coupled]  # vr_table.h needs vr_law.h
    )
    material = "\n".join(
        f" * {line}".rstrip() for line in dataset.attrs["material"].splitlines()
    ).replace("*/", "* /")  # a name in the material may end the comment
    write_text(
        path,
        f"""/* {dataset.attrs["title"].replace("*/", "* /")}
 *
 * Written by {dataset.attrs["source"]}; T_ref = {table.T_ref!r} s; {CHECKSUM} {dataset.attrs[CHECKSUM]}
 *
{material}
 */
{evaluator}
#ifndef VR_LAW_{name}
#define VR_LAW_{name}
{constants}#endif
""",  # noqa: E501
    )


def _law_constants(table: LawTable, name: str) -> str:
    """Return the rows of a law as constants in C.

    table: law of half-spaces or of a cover.
    name: name of the law, an identifier of C, with which the names of the constants begin.
    Returns the source text.
    """
    from ..kernels.law.cover_law import CYLINDER_PART

    # alpha; the limit of lam, which C computes itself; and W and C of both bodies together, of the
    # half-space and of the cylinder
    front = table.record.rows[:8]
    arrays = {f"{name}_coefficients": table.coefficients}
    fields = [repr(front[0].item()), _initializer(front[2:].reshape(3, 2)), *arrays]
    of_cover = ["0", "{0.0}"]  # a null pointer, and zeros in the array ``fast``
    if table.cover is not None:
        # functions last, as in the coefficients: (rows, powers, functions)
        arrays[f"{name}_creep"] = np.moveaxis(table.cover.creep, 0, -1)
        of_cover = [f"{name}_creep", _initializer(table.record.cover_rows[:CYLINDER_PART])]
    constants = "".join(
        f"static const double {array}[{len(rows)}][VR_TERMS][{rows.shape[-1]}] = "
        f"{_initializer(rows)};\n"
        for array, rows in arrays.items()
    )
    counts = f"{len(table.coefficients)}, {table.e0}"
    return (
        f"{constants}static const vr_law {name} = {{{counts}, {', '.join(fields + of_cover)}}};\n"
    )


def _table_constants(table: LawTable, name: str) -> str:
    """Return the splines of a table of the coupled solution as constants in C.

    table: law with ``coupled`` rows.
    name: name of the table, an identifier of C, with which the names of the constants begin.
    Returns the source text.
    """
    from ..kernels.law import coupled_splines as layout

    rows: Any = table.coupled
    count = rows.u.size + 2  # with the limits of u = 0 and of u infinite
    begin = rows.vector[[layout.EDGES, layout.FIELDS]].astype(int)
    edges = rows.vector[begin[0] : begin[1]].reshape(count, layout.EDGE_COUNT, 2)
    # fields before WORK, the first in the vector: C has neither the works of shear nor friction
    jets = rows.vector[begin[1] :].reshape(-1, layout.JET)[: layout.WORK * count * rows.t.size]
    numbers = ", ".join(map(repr, (rows.mu, rows.u[0].item(), rows.u[-1].item())))
    return (
        f"static const double {name}_edges[{count}][VR_EDGES][2] = {_initializer(edges)};\n"
        f"static const double {name}_fields[{len(jets)}][{layout.JET}] = {_initializer(jets)};\n"
        f"static const vr_table {name} = {{{count}, {rows.t.size}, {numbers}, {name}_edges, "
        f"{name}_fields}};\n"
    )


def _initializer(values: Floats) -> str:
    """Return an array as a nested initializer of C, with digits that read back to the same bits;
    NaN becomes NAN.
    """
    # JSON has the shortest digits that read back, and brackets in place of braces
    text = json.dumps(values.tolist(), separators=(",", ":")).replace("],", "],\n")
    return text.translate(str.maketrans("[]", "{}")).replace("NaN", "NAN")


def _write_json(dataset: Dataset, path: Path) -> None:
    """Write the variables, as nested lists of numbers, and some attributes of a law as one JSON
    object.

    The object has the attributes title, viscoroll_table, bodies, material, comment, references,
    source, license and sha256_of_numbers, the checksum, as far as the dataset has them; law_schema
    as an integer; and each variable by its name, a number if it has no axes.  Digits read back to
    the same bits; a NaN is written as NaN, which is no JSON.

    dataset: dataset of the law, of any kind.
    path: file to write; it is replaced if it exists.
    Raises FileError if it cannot be written.
    """
    numbers = {str(name): variable.values.tolist() for name, variable in dataset.variables.items()}
    about = (
        "title",
        "viscoroll_table",
        "bodies",
        "material",
        "comment",
        "references",
        "source",
        "license",
        CHECKSUM,
    )
    content = (
        {name: dataset.attrs[name] for name in about if name in dataset.attrs}
        | {"law_schema": int(dataset.attrs["law_schema"])}
        | numbers
    )
    write_text(path, json.dumps(content, separators=(",", ":")))


#: Suffix -> function (dataset, path) that writes a law or a grid.
_EITHER: dict[str, Any] = {
    ".nc": save,
    ".cdf": _write_netcdf3,
}
#: Suffix -> function that writes a law.
LAW = _EITHER | {".h": _write_header, ".json": _write_json}
#: Suffix -> function that writes a grid.
GRID = _EITHER | {".csv": _write_csv, ".txt": _write_modelica, ".mat": _write_matlab}
