"""Files that are whole or not there: temporary file, fsync, rename, fsync of the folder."""

from __future__ import annotations

import os
import secrets
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .errors import OutputError

if TYPE_CHECKING:
    import xarray as xr


@contextmanager
def replacing(path: str | PathLike[str]) -> Iterator[Path]:
    """A temporary path beside ``path``, put in its place when the body ends well.

    The file and its folder are synced to disk; after any failure ``path`` is as it was and
    the temporary file is gone.  A symbolic link is followed.  The temporary name keeps the
    suffix of ``path``, by which writers choose a format.

    Raises
    ------
    OutputError
        If it cannot be written there.
    """
    target = Path(os.path.realpath(path))
    temporary = target.with_name(f".{os.getpid()}-{secrets.token_hex(4)}.tmp-{target.name}")
    try:
        if target.is_dir():
            raise OutputError(path, "cannot be written: it is a directory")
        yield temporary
        _sync(temporary)
        os.replace(temporary, target)
        _sync(target.parent)
    except OSError as error:
        raise OutputError(path, f"cannot be written ({error.strerror or error})") from error
    finally:
        with suppress(OSError):
            temporary.unlink()


def _sync(path: Path) -> None:
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def write_text(path: str | PathLike[str], text: str) -> None:
    """Write a text file, whole or not at all; raises OutputError."""
    with replacing(path) as temporary:
        temporary.write_text(text, encoding="utf-8")


def write_dataset(dataset: xr.Dataset, path: str | PathLike[str], encoding: dict[str, Any] | None = None) -> None:
    """Write a dataset as netCDF-4/HDF5, whole or not at all; raises OutputError.

    Coordinates get no fill value (CF forbids it); arrays are compressed and carry
    Fletcher-32 checksums unless ``encoding`` says otherwise.
    """
    filters = {"zlib": True, "complevel": 4, "shuffle": True, "fletcher32": True}
    chosen = {
        str(name): {"_FillValue": None} | (filters if v.ndim and v.size else {})
        for name, v in dataset.variables.items()
    }
    with replacing(path) as temporary:
        try:
            dataset.to_netcdf(temporary, engine="h5netcdf", format="NETCDF4", encoding=encoding or chosen)
        except RuntimeError as error:  # HDF5's way to report a full disk while closing
            raise OutputError(path, f"cannot be written ({error})") from error
