"""Results as one netCDF-4 file: the summaries, and every motion where they are kept, block by block."""

from __future__ import annotations

import math
import os
from os import PathLike
from pathlib import Path
from typing import Any

from ...core.errors import FileError
from ...core.extras import import_extra
from ...core.files import replace_file
from .results import open_run
from .store import MOTIONS
from .verify import verify

#: most that deflate makes of incompressible bytes, and room for a chunk in the index and for the head of an array
_LARGER, _ENTRY, _HEAD = 1.002, 512, 1 << 16
#: bytes at a time where the system reserves no room by itself
_PIECE = 1 << 24


def export_netcdf(store: str | PathLike[str], path: str | PathLike[str]) -> None:
    """Write a finished store as netCDF-4: summaries at the root, all motions in the group "motions".

    Memory does not grow with the number of motions.  While it is written, the file takes the room of its
    content uncompressed, which is reserved first.

    Parameters
    ----------
    store : folder of the results.
    path : file to write; a file of that name is replaced when the new one is whole.

    Raises
    ------
    FileError
        There is no finished store, or anything in it is damaged.
        The file cannot be written, or there is no room for it.

    Notes
    -----
    Values are those of the store, bit for bit (``tests/runs/test_run_store.py``).
    """
    summaries, verdict = open_run(store).summaries, verify(store)
    if not verdict.ok:
        raise FileError(store, "; ".join(str(verdict).splitlines()[-2:]))
    with replace_file(path) as temporary:
        temporary.write_bytes(bytes(summaries.to_netcdf(engine="h5netcdf")))
        if (Path(store) / MOTIONS).is_dir():
            _append_motions(Path(store), temporary)


def _append_motions(store: Path, path: Path) -> None:
    import h5netcdf

    zarr = import_extra("zarr", "zarr", "runs")

    source = zarr.open_group(store, mode="r", path=MOTIONS, use_consolidated=False)
    arrays = dict(source.arrays())
    _reserve(path, sum(map(_room, arrays.values())) + _HEAD)
    with h5netcdf.File(path, "a") as file:
        target = file.create_group(MOTIONS)
        target.attrs.update(dict(source.attrs))
        target.dimensions = {"motion": arrays["status"].shape[0], "t": arrays["t"].shape[0]}
        for name, array in arrays.items():
            attrs: dict[str, Any] = dict(array.attrs)
            dims = attrs.pop("_ARRAY_DIMENSIONS")
            variable = target.create_variable(
                name, dims, array.dtype, chunks=array.chunks, compression="gzip", compression_opts=1, shuffle=True,
                fletcher32=True,
            )  # fmt: skip
            variable.attrs.update(attrs)
            for start in range(0, array.shape[0], array.chunks[0]):
                variable[start : start + array.chunks[0]] = array[start : start + array.chunks[0]]


def _room(array: Any) -> int:
    """Bytes that an array takes at most, whatever its values."""
    chunk = array.dtype.itemsize * math.prod(array.chunks)
    return array.nchunks * int(_LARGER * chunk + _ENTRY) + _HEAD


def _reserve(path: Path, room: int) -> None:
    """Lengthen a file: HDF5 2.0 may crash on a full disk, so it must not meet one.  It cuts off what it leaves."""
    with path.open("r+b") as file:
        start = file.seek(0, os.SEEK_END)
        if hasattr(os, "posix_fallocate"):
            os.posix_fallocate(file.fileno(), start, room)
            return
        for written in range(0, room, _PIECE):
            file.write(bytes(min(_PIECE, room - written)))
