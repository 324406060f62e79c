"""Files of tables: atomic save, and a load that checks everything it reads."""

from __future__ import annotations

import io
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...core.errors import FileError
from ...core.files import read_sealed, write_dataset
from ...materials import law_file
from . import schema

if TYPE_CHECKING:
    import xarray as xr

#: Largest size of a file; no table is larger.
_MAX_BYTES = 1 << 31
#: Attribute of a field with an error of interpolation -> its name in :func:`info`.
_ERROR_NAMES = {"spline_error": "spline", "linear_error": "linear", "interpolation_error": "stated"}


def is_law(table: Any) -> bool:
    """Whether a dataset ``table`` is the law of a material or of every alpha; else it is a grid, or no table."""
    return str(getattr(table, "attrs", {}).get(schema.KIND)) in law_file.KINDS


def check(table: Any, path: Any) -> None:
    """Raise FileError if a dataset is neither a law nor a grid, is incomplete, or differs from its checksum.

    Of a law the checksum of its numbers is compared; a grid has none.

    table: the dataset; anything else is refused too.
    path: path of its file, or another name, for the message.
    """
    if is_law(table):
        law_file.check_law(law_file.dataset_content(table), path)
    else:
        schema.check(table, path)


def save(table: xr.Dataset, path: str | PathLike[str]) -> None:
    """Write a law or a grid as netCDF-4/HDF5: whole and synced, or not at all.

    The file ends with a SHA-256 of its bytes, which other programs do not see.

    Parameters
    ----------
    table : a Dataset of :func:`law`, :func:`build` or :func:`load`.
    path : file to write; a file of that name is replaced.

    Raises
    ------
    FileError
        If it cannot be written there; a file of that name is then left as it was.  If ``table`` is neither a law nor a
        grid, is incomplete, of another major version of the schema, or a law whose numbers differ from their checksum.

    Examples
    --------
    >>> import viscoroll as vr
    >>> vr.tables.save(vr.tables.law(11.0), "law.nc")

    Notes
    -----
    :func:`load` returns the same values, bit for bit (``tests/tables/test_grids.py``, ``tests/tables/test_law.py``).
    """
    check(table, path)
    plain = table.copy()
    for variable in plain.variables.values():
        variable.encoding = {}
    # Compression does not make the coefficients of a law smaller: their last digits are noise.
    encoding = {str(name): {"_FillValue": None} for name in plain.variables} if is_law(plain) else None
    write_dataset(plain, path, encoding, sealed=True)


def load(path: str | PathLike[str]) -> xr.Dataset:
    """Read a law or a grid of the schema 1.x (all versions since 0.1.0) into memory, check it and close the file.

    Parameters
    ----------
    path : file written by :func:`save`.  The SHA-256 at its end is compared before the file is parsed; a file that
        another program has written or edited has none, and its content alone is checked.

    Returns
    -------
    xarray.Dataset
        As it was saved, bit for bit.

    Raises
    ------
    FileError
        A file that is missing, truncated or damaged, larger than 2 GiB, of another major schema version, or no table; a
        law whose numbers differ from their checksum.

    Examples
    --------
    >>> import viscoroll as vr
    >>> vr.tables.save(vr.tables.law(11.0), "law.nc")
    >>> table = vr.tables.load("law.nc")
    """
    import xarray as xr

    content = read_sealed(path, _MAX_BYTES, "table of viscoroll", "build it again")
    try:
        table = xr.load_dataset(io.BytesIO(content), engine="h5netcdf", mask_and_scale=False, decode_times=False)
    except Exception as error:  # libraries raise errors of many kinds
        problem = f"is damaged or is not a table of viscoroll ({' '.join(str(error).split()):.120}): build it again"
        raise FileError(path, problem) from error
    check(table, path)
    table.encoding["source"] = str(path)  # for messages, as where xarray reads a file
    return table


def info(path: str | PathLike[str]) -> str:
    """Return the summary of a law or a grid: its functions or fields, their stated errors, its origin.

    Parameters
    ----------
    path : file of a law or a grid.

    Returns
    -------
    str
        Lines to print, joined by newlines: path, kind and size of the file; title; of a law a line for each function
        with its largest error; of a grid a line for each axis with its nodes and range, then one for each
        field with its axes and the absolute errors that it states ("spline", "linear", "stated" in old files); at the
        end those of the attributes material, comment, source, history and checksum that the file has.

    Raises
    ------
    FileError
        As :func:`load`.
    KeyError
        A table of another program without the attribute title, or a law without its errors.

    Examples
    --------
    >>> import viscoroll as vr
    >>> vr.tables.save(vr.tables.law(11.0), "law.nc")
    >>> text = vr.tables.info("law.nc")
    """
    table = load(path)
    about, size = table.attrs, Path(path).stat().st_size / 1e3
    lines = [f"{path}: {about[schema.KIND]}, {size:.0f} kB", about["title"], ""]
    if is_law(table):
        lines += [f"  {'function':<14}largest error"]
        lines += [f"  {name:<14}{error:.1e}" for name, error in law_file.stated_errors(table).items()]
    else:
        axes = {axis: table[axis].values for axis in schema.axes_of(table)}
        lines += [f"  {name:<8} {nodes.size:>5} nodes in [{nodes[0]:g}, {nodes[-1]:g}]" for name, nodes in axes.items()]
        lines += ["", f"  {'field':<26}{'axes':<18}error between the nodes"]
        for name in schema.fields_of(table):
            field = table[name]
            errors = ", ".join(
                f"{word} {field.attrs[key]:.2g}" for key, word in _ERROR_NAMES.items() if key in field.attrs
            )
            lines.append(f"  {name:<26}{', '.join(map(str, field.dims)):<18}{errors}")
    keys = ("material", "comment", "source", "history", law_file.CHECKSUM)
    return "\n".join([*lines, "", *(f"{key}: {about[key]}" for key in keys if key in about)])
