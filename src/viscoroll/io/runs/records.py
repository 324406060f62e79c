"""Records: small sealed files that say what is done.

A record holds the SHA-256 of every file that belongs to it and is written after them.  So a piece of
work is done exactly where its record is whole and every file that it names has the digest it states.
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
from ...core.files import seal, seal_matches, write_bytes
from ...motion.summaries import Summary

#: folder of the records in a store
RECORDS = "records"


class Record(msgspec.Struct):
    """What was done.

    Attributes
    ----------
    run : digest of the run that it is a part of, whatever its number of motions.
    files : path below the store -> SHA-256.
    motions : of the block, or, in the records "start" and "end", of the run.
    about : what the run is, in the record "start".
    summary : of the motions, in the record of a block.
    """

    run: str
    files: dict[str, str]
    motions: int = 0
    about: dict[str, str | int] = {}
    summary: Summary | None = None


def encoded(record: Record) -> bytes:
    """The bytes of a record."""
    return seal(zlib.compress(msgspec.msgpack.encode(record, enc_hook=_from_array), 4))


def read_record(path: Path) -> Record | None:
    """The record, or None where it is missing or damaged in any way."""
    try:
        stored = path.read_bytes()
        if not seal_matches(stored):
            return None
        content = zlib.decompressobj().decompress(stored)  # the seal is what it leaves over
        return msgspec.msgpack.decode(content, type=Record, dec_hook=_to_array)
    except (OSError, ValueError, zlib.error, msgspec.DecodeError):
        return None


def _from_array(array: np.ndarray) -> list[Any]:
    return [array.dtype.str, array.tobytes()]


def _to_array(kind: Any, value: Any) -> np.ndarray:
    name, content = value
    if name not in ("<i4", "<i8"):
        raise ValueError("no such array in a record")
    return np.frombuffer(content, name)


def damaged(root: Path, record: Record) -> list[str]:
    """Files of a record that are missing or differ from what it states."""
    return [name for name, digest in record.files.items() if _digest(root / name) != digest]


def _digest(path: Path) -> str | None:
    """SHA-256 of a file; None where it cannot be read."""
    try:
        with path.open("rb") as file:
            return hashlib.file_digest(file, "sha256").hexdigest()
    except OSError:
        return None


def put(root: Path, files: dict[str, bytes]) -> dict[str, str]:
    """Write files below ``root``, each whole or not at all, and return the digests of what was meant.

    A file that is there with this content is left alone.  Raises FileError.
    """
    digests = {name: hashlib.sha256(content).hexdigest() for name, content in sorted(files.items())}
    for name, content in files.items():
        if _digest(root / name) != digests[name]:
            make_folder((root / name).parent)
            write_bytes(root / name, content)
    return digests


def refuse_unreadable(root: Path) -> None:
    """Raise FileError where the folder of a store, or that of its records, may not be read."""
    for folder in (root, root / RECORDS):
        if folder.is_dir() and not os.access(folder, os.R_OK | os.X_OK):
            raise FileError(folder, "cannot be read (Permission denied)")


def make_folder(path: Path) -> None:
    """Make a folder, and those above it, unless they are there; raises FileError."""
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise FileError(path, f"cannot be made a folder ({error.strerror or error})") from error
