"""Tables on disk: atomic save, and a load that trusts nothing it has not checked."""

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

#: No table is larger.
_MOST_BYTES = 1 << 31


def is_law(table: Any) -> bool:
    """Whether a dataset is the law of a material or of every alpha, and no grid."""
    return getattr(table, "attrs", {}).get(schema.KIND) in law_file.KINDS


def check(table: Any, path: Any) -> None:
    """Refuse what is neither a law nor a grid; raises FileError."""
    if is_law(table):
        law_file.check_law(law_file.dataset_content(table), path)
    else:
        schema.check(table, path)


def save(table: xr.Dataset, path: str | PathLike[str]) -> None:
    """Write a law or a grid as netCDF-4/HDF5: whole and synced, or not at all.

    Behind its end the file carries a SHA-256 over its bytes, which other programs do not see.

    Parameters
    ----------
    table : a Dataset of :func:`law`, :func:`build` or :func:`load`.
    path : file to write; a file of that name is replaced.

    Raises
    ------
    FileError
        If it cannot be written there; a file of that name is left as it was.
        If ``table`` is neither.

    Notes
    -----
    :func:`load` gives back the same values, bit for bit (``tests/tables/test_grids.py``, ``tests/tables/test_law.py``).
    """
    check(table, path)
    plain = table.copy()
    for variable in plain.variables.values():
        variable.encoding = {}
    # the noise of coefficients does not compress
    encoding = {str(name): {"_FillValue": None} for name in plain.variables} if is_law(plain) else None
    write_dataset(plain, path, encoding, sealed=True)


def load(path: str | PathLike[str]) -> xr.Dataset:
    """Read a law or a grid, of any version since 0.1.0, into memory and close the file.

    Parameters
    ----------
    path : file written by :func:`save`.  The SHA-256 at its end is compared before anything is parsed; a file that
        another program has written or edited has none, and is read for what it holds.

    Returns
    -------
    xarray.Dataset
        As it was saved, bit for bit.

    Raises
    ------
    FileError
        A file that is missing, cut or damaged, of another major schema version, or no table.
    """
    import xarray as xr

    content = read_sealed(path, _MOST_BYTES, "table of viscoroll", "build it again")
    try:
        table = xr.load_dataset(io.BytesIO(content), engine="h5netcdf", mask_and_scale=False, decode_times=False)
    except Exception as error:  # libraries raise many kinds
        problem = f"is damaged, or no table of viscoroll ({' '.join(str(error).split()):.120}): build it again"
        raise FileError(path, problem) from error
    check(table, path)
    return table


def info(path: str | PathLike[str]) -> str:
    """What the law or the grid at ``path`` holds, its stated errors, who made it with what.

    Raises
    ------
    FileError
        As :func:`load`.
    """
    table = load(path)
    about, size = table.attrs, Path(path).stat().st_size / 1e3
    lines = [f"{path}: {about[schema.KIND]}, {size:.0f} kB", about["title"], ""]
    if is_law(table):
        lines += [f"  {'function':<14}largest relative error"]
        lines += [f"  {name:<14}{error:.1e}" for name, error in law_file.stated_errors(table).items()]
    else:
        axes = {axis: table[axis].values for axis in schema.axes_of(table)}
        lines += [f"  {name:<8} {nodes.size:>5} nodes in [{nodes[0]:g}, {nodes[-1]:g}]" for name, nodes in axes.items()]
        lines += ["", f"  {'field':<26}{'over':<18}error between the nodes"]
        lines += [_field_line(table[name]) for name in schema.fields_of(table)]
    keys = ("material", "comment", "source", "history", law_file.CHECKSUM)
    return "\n".join([*lines, "", *(f"{key}: {about[key]}" for key in keys if key in about)])


def _field_line(field: xr.DataArray) -> str:
    names = {"spline_error": "spline", "linear_error": "linear", "interpolation_error": "stated"}
    errors = ", ".join(f"{word} {field.attrs[key]:.2g}" for key, word in names.items() if key in field.attrs)
    return f"  {field.name!s:<26}{', '.join(map(str, field.dims)):<18}{errors}"
