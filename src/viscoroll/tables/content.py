"""What the bytes of a table file hold, checked while it is read, and its hash."""

from __future__ import annotations

import hashlib
import io
from os import PathLike
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import TableError
from . import schema
from .survey import one_line, survey

if TYPE_CHECKING:
    import xarray as xr

HASH = "content_sha256"


def read(content: bytes, path: str | PathLike[str], verify: bool) -> xr.Dataset:
    """Table that the bytes of a file hold; ``path`` is named in errors."""
    import xarray as xr

    survey(content, path)
    try:
        table = xr.load_dataset(io.BytesIO(content), engine="h5netcdf", mask_and_scale=False, decode_times=False)
        actual = content_hash(table) if verify else None
    except Exception as error:  # damaged chunks, headers or strings raise many kinds
        raise TableError(path, f"is damaged ({one_line(error)}): rebuild it") from error
    if verify and actual != table.attrs.get(HASH):
        raise TableError(path, f"is damaged or was edited: its content differs from its {HASH}; rebuild it")
    schema.check(table, path)
    return table


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
