"""Records: small sealed files that state which parts of a store are complete.

A record holds the SHA-256 of each file that belongs to it and is written after them.  So a part is complete exactly if
its record is undamaged and each file that it names has the digest that it states.
"""

from __future__ import annotations

import hashlib
import os
import zlib
from pathlib import Path
from typing import Any

import msgspec
import numpy as np

from ...core.errors import FileError
from ...core.files import as_file_error, seal, seal_matches, write_bytes
from ...motion.summaries import Summary

#: Folder of the records in a store.
RECORDS = "records"
#: Level of compression of records: the lowest one at which zlib matches lazily.
_LEVEL = 4


class Record(msgspec.Struct):
    """A complete part of a store: its metadata ("start"), a block, or its summaries ("end").

    Attributes
    ----------
    run : identity of the run, whatever its number of motions.
    files : path below the store -> SHA-256.
    motions : number of motions of the block, or, in the records "start" and "end", of the run.
    about : attributes of the run, in the record "start".
    summary : summary of the motions, in the record of a block.
    """

    run: str
    files: dict[str, str]
    motions: int = 0
    about: dict[str, str | int] = {}
    summary: Summary | None = None


def encoded(record: Record) -> bytes:
    """Return the bytes of the file of a ``record``, a :class:`Record`: MessagePack, compressed and sealed."""
    return seal(zlib.compress(msgspec.msgpack.encode(record, enc_hook=_encode_array), _LEVEL))


def read_record(path: Path) -> Record | None:
    """Return the :class:`Record` in a file; None if it is missing, cannot be read, or is damaged in any way.

    The seal, the SHA-256 at the end of the file, must be there and agree.  Nothing is raised.

    path: path of the record.
    """
    try:
        stored = path.read_bytes()
        if not seal_matches(stored):
            return None
        content = zlib.decompressobj().decompress(stored)  # the seal after it is left over
        return msgspec.msgpack.decode(content, type=Record, dec_hook=_decode_array)
    except (OSError, ValueError, zlib.error, msgspec.DecodeError):
        return None


def _encode_array(array: np.ndarray) -> list[Any]:
    """Return [type as numpy writes it, as "<i8"; bytes] of an ``array``, which MessagePack has no type for."""
    return [array.dtype.str, array.tobytes()]


def _decode_array(kind: Any, value: Any) -> np.ndarray:
    """Return the array of which :func:`_encode_array` made a list.

    kind: type of the field, which msgspec passes; it is not used.
    value: [type as of numpy, "<i4" or "<i8"; bytes].
    Returns a read-only vector of that type.
    Raises ValueError for another type, or a number of bytes that is no multiple of its size.
    """
    name, content = value
    if name not in ("<i4", "<i8"):
        raise ValueError("no such array in a record")
    return np.frombuffer(content, name)


def damaged(root: Path, record: Record) -> list[str]:
    """Return the files of a record that are missing or differ from their digest; [] if all is well.

    Whether the record itself is that of the run, :func:`.store.problems` examines before.

    root: path of the folder of the store.
    record: the :class:`Record`, whose ``files`` are paths below ``root`` with their SHA-256.
    Returns paths below ``root``, in the order of the record; a file that cannot be read counts as missing.
    """
    return [name for name, digest in record.files.items() if _digest(root / name) != digest]


def _digest(path: Path) -> str | None:
    """Return the SHA-256 of a file, 64 hexadecimal digits; None if it is missing or cannot be read.

    path: path of the file.
    """
    try:
        with path.open("rb") as file:
            return hashlib.file_digest(file, "sha256").hexdigest()
    except OSError:
        return None


def write_files(root: Path, files: dict[str, bytes]) -> dict[str, str]:
    """Write files below a folder, each whole or not at all, and return their digests.

    A file that has this content already is left alone; folders are created.

    root: path of the folder.
    files: path below root -> content, bytes; {} writes nothing.
    Returns path below root -> SHA-256 in hexadecimal digits, sorted by path.
    Raises FileError if one, or its folder, cannot be written; the files before it stay.
    """
    digests = {name: hashlib.sha256(content).hexdigest() for name, content in sorted(files.items())}
    for name, content in files.items():
        if _digest(root / name) != digests[name]:
            make_folder((root / name).parent)
            write_bytes(root / name, content)
    return digests


def refuse_unreadable(root: Path) -> None:
    """Raise FileError if the folder of a store, or that of its records, exists and may not be read.

    Without this check unreadable records would look like missing ones, and blocks would be evaluated again.

    root: path of the folder of the store.
    """
    for folder in (root, root / RECORDS):
        if folder.is_dir() and not os.access(folder, os.R_OK | os.X_OK):
            raise FileError(folder, "cannot be read (Permission denied)")


def make_folder(path: Path) -> None:
    """Create a folder, and those above it, unless they exist.

    path: path of the folder.
    Raises FileError if that fails, as where a file of that name exists.
    """
    with as_file_error(path, "cannot be created as a folder"):
        path.mkdir(parents=True, exist_ok=True)
