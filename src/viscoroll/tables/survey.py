"""Plain checks of an HDF5 file before any array of it is read: what it holds, how large, stored how."""

from __future__ import annotations

import io
import math
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import TableError
from . import schema

if TYPE_CHECKING:
    import h5py

#: No table is larger, in the file or in memory.
MAX_BYTES = 1 << 31
#: zlib makes no byte stand for more than 1032, https://zlib.net/zlib_tech.html
_MOST_PER_BYTE = 1032
_MAX_CHUNK = 1 << 26
_MAX_VARIABLES, _MAX_ATTRIBUTES, _MAX_ATTRIBUTE = 100, 100, 1 << 15
#: Codes of zlib, shuffle and Fletcher-32, the filters that a table may use.
_FILTERS = {1, 2, 3}
EXPECTED = f"expected a viscoroll table of schema {schema.SCHEMA_VERSION.partition('.')[0]}.x (see `make tables`)"


def most_bytes(content: bytes) -> int:
    """Bytes in memory that arrays stored in ``content`` can take."""
    return min(MAX_BYTES, _MOST_PER_BYTE * len(content))


def require_whole(content: bytes, path: Any) -> None:
    """Refuse a file that is shorter than its superblock states (HDF5 File Format Specification, II.A).

    Raises
    ------
    TableError
        Naming both sizes.
    """
    version, end = content[8:9], {b"\0": 40, b"\1": 44, b"\2": 28, b"\3": 28}
    stated = int.from_bytes(content[end[version] :][:8], "little") if version in end else 0
    if len(content) < max(stated, 48):
        raise TableError(path, f"is truncated or damaged ({len(content)} bytes of {stated}): rebuild it")


def survey(content: bytes, path: Any) -> None:
    """Refuse a file that is not laid out as a table is; ``path`` is where ``content`` came from.

    A table is one group of arrays of doubles, stored in the file itself, of bounded size, with
    attributes of bounded number and size, of a known schema version.

    Raises
    ------
    TableError
        Naming what was found and what is expected.
    """
    import h5py

    try:
        with h5py.File(io.BytesIO(content), "r") as file:
            size = _checked_size(file, path)
    except TableError:
        raise
    except Exception as error:  # h5py raises many kinds on damaged files
        raise TableError(path, f"is truncated or damaged ({one_line(error)}): rebuild it") from error
    if size > most_bytes(content):
        raise TableError(path, f"its arrays claim {size} bytes, more than {most_bytes(content)}: {EXPECTED}")


def _checked_size(file: h5py.File, path: Any) -> int:
    """Bytes in memory of all variables, once the file is found to be a table of our schema in its outline."""
    _check_attributes(file, path)
    if schema.KIND not in file.attrs:
        raise TableError(path, f"is not a viscoroll table: attribute {schema.KIND} is missing; {EXPECTED}")
    schema.check_version(_one(file.attrs.get("schema_version")), path)
    if len(file) > _MAX_VARIABLES:
        raise TableError(path, f"holds {len(file)} variables, more than {_MAX_VARIABLES}: {EXPECTED}")
    return sum(_checked_bytes(file, name, path) for name in file)


def _one(value: Any) -> Any:
    """An attribute as it was given: other programs make texts arrays of one text, or bytes."""
    if np.size(value) == 1:
        value = np.ravel(value)[0]
    return value.decode(errors="replace") if isinstance(value, bytes) else value


def _check_attributes(item: h5py.HLObject, path: Any) -> None:
    name = item.name.removeprefix("/") or "the file"
    if len(item.attrs) > _MAX_ATTRIBUTES:
        raise TableError(path, f"{name} has {len(item.attrs)} attributes, more than {_MAX_ATTRIBUTES}: {EXPECTED}")
    for key in item.attrs:
        if item.attrs.get_id(key).get_storage_size() > _MAX_ATTRIBUTE:
            raise TableError(path, f"attribute {key!r:.40} of {name} is larger than {_MAX_ATTRIBUTE} bytes: {EXPECTED}")


def _checked_bytes(file: h5py.File, name: str, path: Any) -> int:
    """Bytes in memory of one variable, once it is found to be an array of doubles in this very file."""
    import h5py

    def refuse(what: str) -> TableError:
        return TableError(path, f"variable {name!r:.40} {what}: {EXPECTED}")

    if not isinstance(file.get(name, getlink=True), h5py.HardLink):  # others lead out of the file, or nowhere
        raise refuse("is a link")
    item = file[name]
    if not isinstance(item, h5py.Dataset):
        raise refuse("is not an array")
    if item.dtype != "f8":
        raise refuse(f"is of type {item.dtype!s:.40}, not 64-bit float")
    _check_attributes(item, path)
    layout = item.id.get_create_plist()
    if layout.get_layout() == h5py.h5d.VIRTUAL or layout.get_external_count():
        raise refuse("is stored in other files")
    if not {layout.get_filter(n)[0] for n in range(layout.get_nfilters())} <= _FILTERS:
        raise refuse("is compressed by an unknown filter")
    if item.chunks and _bytes(item.chunks) > _MAX_CHUNK:
        raise refuse(f"is stored in chunks of {_bytes(item.chunks)} bytes, more than {_MAX_CHUNK}")
    return _bytes(item.shape)


def _bytes(shape: tuple[int, ...]) -> int:
    return 8 * math.prod(int(length) for length in shape)  # Python integers: a damaged shape cannot overflow


def one_line(error: Exception) -> str:
    """Kind and text of an error of a library, shortened."""
    return f"{type(error).__name__}: {' '.join(str(error).split())[:120]}"
