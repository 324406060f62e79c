"""Files that are whole or not there: temporary file, fsync, rename, fsync of the folder.

Files that are read again end with a seal, the SHA-256 of all before it.  It lies behind the end
that HDF5 and zip files state of themselves: other programs read them as ever, and this package
finds damage before a library parses a single byte of it.
"""

from __future__ import annotations

import hashlib
import os
import secrets
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .errors import FileError

if TYPE_CHECKING:
    import xarray as xr

_SEAL = b"\nSHA-256 of all before, by viscoroll: "
_SEAL_SIZE = len(_SEAL) + hashlib.sha256().digest_size * 2 + 1


@contextmanager
def replace_file(path: str | PathLike[str]) -> Iterator[Path]:
    """A temporary path beside ``path``, put in its place when the body ends well.

    The file and its folder are synced to disk; after any failure ``path`` is as it was and
    the temporary file is gone.  A process that is killed may leave a temporary file, named
    .PID-XXXXXXXX.tmp-NAME, which may be deleted.  A symbolic link is followed: what it points to
    is replaced, and the link stays.  The temporary name keeps the suffix of ``path``, by which
    writers choose a format.

    Raises
    ------
    FileError
        If it cannot be written there: no such folder, a full disk, a folder or file that is
        read-only, a directory, a device, a loop of links.
    """
    target = Path(os.path.realpath(path))
    temporary = target.with_name(f".{os.getpid()}-{secrets.token_hex(4)}.tmp-{target.name}")
    try:
        _require_replaceable(target, path)
        yield temporary
        _sync(temporary)
        os.replace(temporary, target)
        _sync(target.parent)
    except OSError as error:
        raise FileError(path, f"cannot be written ({error.strerror or error})") from error
    finally:
        with suppress(OSError):
            temporary.unlink()


def _require_replaceable(target: Path, path: str | PathLike[str]) -> None:
    """Refuse what a rename would replace without asking; ``target`` is where ``path`` leads."""
    if target.is_symlink():
        raise FileError(path, "cannot be written: it is a loop of symbolic links")
    if target.is_dir():
        raise FileError(path, "cannot be written: it is a directory")
    if target.exists() and not target.is_file():
        raise FileError(path, "cannot be written: it is not a regular file")
    if target.exists() and not os.access(target, os.W_OK):
        raise FileError(path, "cannot be written: it is read-only")


def _sync(path: Path) -> None:
    folder = path.is_dir()
    if folder and os.name == "nt":
        return  # Windows opens no folders
    descriptor = os.open(path, os.O_RDONLY if folder else os.O_RDWR)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def seal(content: bytes) -> bytes:
    """The bytes of a file with their seal behind them."""
    return content + _seal_of(content)


def seal_matches(content: bytes) -> bool | None:
    """Whether the bytes of a file are those that were sealed; None where there is no seal."""
    end = content[-_SEAL_SIZE:]
    return end == _seal_of(memoryview(content)[:-_SEAL_SIZE]) if end.startswith(_SEAL) else None


def read_sealed(path: str | PathLike[str], most: int, what: str, remedy: str) -> bytes:
    """The bytes of a file, at ``most`` so many, compared with the seal at their end where there is one.

    ``what`` the file should be, and the ``remedy`` where it is not, in words.  Raises FileError.
    """
    place = Path(path)
    try:
        if place.is_file() and place.stat().st_size > most:
            raise FileError(path, f"is no {what}: it is larger than {most} bytes")
        content = place.read_bytes()
    except OSError as error:
        raise FileError(path, f"cannot be read ({error.strerror or error}): it must be a {what}") from error
    if seal_matches(content) is False:
        raise FileError(path, f"is damaged: its bytes differ from the SHA-256 at their end; {remedy}")
    return content


def _seal_of(content: bytes | memoryview) -> bytes:
    return _SEAL + hashlib.sha256(content).hexdigest().encode() + b"\n"


def write_bytes(path: str | PathLike[str], content: bytes) -> None:
    """Write a file, whole or not at all; raises FileError."""
    with replace_file(path) as temporary:
        temporary.write_bytes(content)


def write_text(path: str | PathLike[str], text: str) -> None:
    """Write a text file in UTF-8, whole or not at all; raises FileError."""
    write_bytes(path, text.encode())


def write_dataset(
    dataset: xr.Dataset, path: str | PathLike[str], encoding: dict[str, Any] | None = None, *, sealed: bool = False
) -> None:
    """Write a dataset as netCDF-4/HDF5, whole or not at all; raises FileError.

    Coordinates get no fill value (CF forbids it); arrays are compressed and carry
    Fletcher-32 checksums unless ``encoding`` says otherwise (HDF5 has none for scalars and texts).
    """
    filters = {"zlib": True, "complevel": 4, "shuffle": True, "fletcher32": True}
    chosen = {
        str(name): {"_FillValue": None} | (filters if v.ndim and v.size and v.dtype.kind not in "OU" else {})
        for name, v in dataset.variables.items()
    }
    # composed in memory: on a full disk HDF5 2.0 crashes the process, see tests/test_files.py
    content = bytes(dataset.to_netcdf(engine="h5netcdf", format="NETCDF4", encoding=encoding or chosen))
    write_bytes(path, seal(content) if sealed else content)
