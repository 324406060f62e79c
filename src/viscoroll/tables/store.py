"""Tables on disk: atomic save, and a load that trusts nothing it has not checked."""

from __future__ import annotations

import hashlib
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import TableError
from ..files import write_dataset
from . import schema

if TYPE_CHECKING:
    import xarray as xr

HASH = "content_sha256"
_SIGNATURE = b"\x89HDF\r\n\x1a\n"
#: No table is larger, in the file or in memory; anything larger is refused before it is read.
_MAX_BYTES = 1 << 31
_EXPECTED = f"expected a viscoroll table of schema {schema.SCHEMA_VERSION.partition('.')[0]}.x (see `make tables`)"


def content_hash(table: xr.Dataset) -> str:
    """SHA-256 over names, dimensions, types, values and attributes, whatever their order."""
    digest = hashlib.sha256()

    def add(*parts: Any) -> None:
        for part in parts:
            data = part if isinstance(part, bytes) else str(part).encode()
            digest.update(len(data).to_bytes(8, "little") + data)

    def add_attributes(attributes: dict) -> None:
        for key in sorted(attributes.keys() - {HASH}):
            value = attributes[key]
            # files give numbers back as numpy scalars: compare what they print
            add(key, value if isinstance(value, str) else repr(np.asarray(value).tolist()))

    add_attributes(table.attrs)
    for name in sorted(map(str, table.variables)):
        variable = table.variables[name]
        values = np.ascontiguousarray(variable.values)
        little = values.astype(values.dtype.newbyteorder("<"), copy=False)
        add(name, repr(variable.dims), repr(values.shape), little.dtype.str, little.tobytes())
        add_attributes(variable.attrs)
    return digest.hexdigest()


def save(table: xr.Dataset, path: str | PathLike[str]) -> None:
    """Write a table as netCDF-4/HDF5: whole and synced, or not at all.

    Every array carries Fletcher-32 checksums, the file a SHA-256 over its content.

    Raises
    ------
    OutputError
        If it cannot be written there; a file of that name is left as it was.
    TableError
        If ``table`` is not a table.
    """
    schema.check(table, path)
    stamped = table.copy()
    for variable in stamped.variables.values():
        variable.encoding = {}
    stamped.attrs[HASH] = content_hash(table)
    write_dataset(stamped, path)


def _require_table(path: Path) -> None:
    """Plain checks before any array is read: a file, HDF5, of bounded size, a table, our schema.

    Raises
    ------
    TableError
        Naming what was found and what is expected.
    """
    try:
        if not path.is_file():
            raise TableError(path, f"{'is not a file' if path.exists() else 'does not exist'}: {_EXPECTED}")
        with path.open("rb") as file:
            signature = file.read(len(_SIGNATURE))
        size = path.stat().st_size
    except OSError as error:
        raise TableError(path, f"cannot be read ({error.strerror}): {_EXPECTED}") from error
    if signature != _SIGNATURE:
        raise TableError(path, f"is not an HDF5 file: {_EXPECTED}")
    if size > _MAX_BYTES:
        raise TableError(path, f"is larger than {_MAX_BYTES} bytes: {_EXPECTED}")
    try:
        attributes, size = _survey(path)
    except Exception as error:  # h5py raises many kinds on damaged files
        raise TableError(path, f"is truncated or damaged ({_one_line(error)}): rebuild it") from error
    if schema.KIND not in attributes:
        raise TableError(path, f"is not a viscoroll table: attribute {schema.KIND} is missing; {_EXPECTED}")
    schema.check_version(attributes.get("schema_version"), path)
    if size > _MAX_BYTES:
        raise TableError(path, f"its arrays claim {size} bytes, more than {_MAX_BYTES}: {_EXPECTED}")


def _survey(path: Path) -> tuple[dict[str, Any], int]:
    """Global attributes of an HDF5 file, and the bytes that its arrays will take in memory."""
    import h5py

    with h5py.File(path, "r") as file:
        attributes = {name: file.attrs[name] for name in (schema.KIND, "schema_version") if name in file.attrs}
        # sizes as Python integers: a damaged shape must not overflow
        size = sum(int(np.prod([int(n) for n in item.shape], dtype=object)) * item.dtype.itemsize
                   for item in file.values() if isinstance(item, h5py.Dataset))  # fmt: skip
        return attributes, size


def _one_line(error: Exception) -> str:
    return f"{type(error).__name__}: {' '.join(str(error).split())[:120]}"


def load(path: str | PathLike[str], *, verify: bool = True) -> xr.Dataset:
    """Read a table into memory and close the file.

    Parameters
    ----------
    path : file written by :func:`save`.
    verify : compare the content with the SHA-256 stored in the file.

    Raises
    ------
    TableError
        A file that is missing, not HDF5, truncated or damaged, of another major schema
        version, not a table, or whose content differs from its hash.
    """
    import xarray as xr

    path = Path(path)
    _require_table(path)
    try:
        table = xr.load_dataset(path, engine="h5netcdf", mask_and_scale=False, decode_times=False)
        actual = content_hash(table) if verify else None
    except Exception as error:  # damaged chunks, headers or strings raise many kinds
        raise TableError(path, f"is damaged ({_one_line(error)}): rebuild it") from error
    if verify and actual != table.attrs.get(HASH):
        raise TableError(path, f"is damaged or was edited: its content differs from its {HASH}; rebuild it")
    schema.check(table, path)
    return table


def info(path: str | PathLike[str]) -> str:
    """What the table at ``path`` holds: grid, fields, stated errors, who made it with what.

    Raises
    ------
    TableError
        As :func:`load`.
    """
    table = load(path)
    kind, about, size = table.attrs[schema.KIND], table.attrs, Path(path).stat().st_size / 1e6
    lines = [
        f"{path}: {kind} table, schema {about['schema_version']}, {size:.2f} MB, content verified",
        about["title"],
        "",
        *(f"  {axis:<8} {table[axis].size:>5} nodes in [{table[axis].values[0]:g}, {table[axis].values[-1]:g}]"
          for axis in schema.AXES[kind]),
        *(f"  {name:<8} = {table[name].item():g}" for name in ("kappa", "mu") if name in table.coords),
        "",
        f"  {'field':<25}{'over':<22}{'equation':<18}interpolation error (allowed)",
        *(_field_line(table[name]) for name in schema.FIELDS[kind]),
        "",
    ]  # fmt: skip
    lines += [
        f"{key}: {about[key]}" for key in ("grid", "tolerances", "comment", "source", "software", "history", HASH)
    ]
    return "\n".join(lines)


def _field_line(field: xr.DataArray) -> str:
    error, allowed = (field.attrs.get(key) for key in ("interpolation_error", "interpolation_error_allowed"))
    stated = "" if error is None else f"{error:.2g}" + ("" if allowed is None else f" ({allowed:.2g})")
    return f"  {field.name!s:<25}{', '.join(map(str, field.dims)):<22}{field.attrs['equation']:<18}{stated}"
