"""Export of a store to one netCDF-4 file: :func:`export_netcdf`."""

from __future__ import annotations

import math
import os
from os import PathLike
from pathlib import Path
from typing import Any

from ...core.errors import FileError
from ...core.extras import import_extra
from ...core.files import fix_texts, replace_file
from .results import open_run
from .store import MOTIONS
from .verify import verify

#: Largest ratio of deflated to plain size, of bytes that cannot be compressed.
_DEFLATE_RATIO = 1.002
#: Bytes of a chunk in the index of an array, at most.
_INDEX_ENTRY = 512
#: Bytes of the head of an array, and of the file, at most.
_HEAD = 1 << 16
#: Bytes written at a time where the system cannot reserve disk space.
_PIECE = 1 << 24


def export_netcdf(store: str | PathLike[str], path: str | PathLike[str]) -> None:
    """Write a finished store as netCDF-4: summaries at the root, all motions in the group "motions".

    Memory does not grow with the number of motions.  While the file is written it takes the disk space of its
    uncompressed content, which is reserved first.

    Parameters
    ----------
    store : folder of the results.
    path : file to write; a file of that name is replaced when the new one is complete.

    Raises
    ------
    FileError
        There is no finished store, or a file in it is damaged; the netCDF file cannot be written, or the disk is full.
        A file of that name then stays as it was.
    MissingDependencyError
        If zarr is not installed.

    Notes
    -----
    Values are those of the store, bit for bit (``tests/runs/test_run_store.py``).

    Examples
    --------
    >>> import viscoroll as vr
    >>> _ = vr.runs.run_ensemble(vr.runs.read_run(vr.datasets.path("run.toml")), "results.zarr", threads=1)
    >>> vr.runs.export_netcdf("results.zarr", "results.nc")
    """
    summaries, verdict = open_run(store).summaries, verify(store)
    if not verdict.ok:
        raise FileError(store, "; ".join(str(verdict).splitlines()[-2:]))
    with replace_file(path) as temporary:
        temporary.write_bytes(bytes(fix_texts(summaries).to_netcdf(engine="h5netcdf")))
        if (Path(store) / MOTIONS).is_dir():
            _append_motions(Path(store), temporary)


def _append_motions(store: Path, path: Path) -> None:
    """Copy the motions, chunk by chunk, into the group "motions" of a netCDF-4 file.

    The file is first lengthened by the largest size that the group can take.  Numbers are compressed (gzip), with
    checksums (Fletcher-32), in the chunks of the store.

    store: path of the folder of the results, which has every motion.
    path: path of the netCDF-4 file, which is there already.
    Raises OSError if the disk is full (the file is then incomplete); MissingDependencyError without zarr, which the
    caller has met before.
    """
    import h5netcdf

    zarr = import_extra("zarr", "runs")

    source = zarr.open_group(store, mode="r", path=MOTIONS, use_consolidated=False)
    arrays = dict(source.arrays())
    _reserve(path, sum(map(_largest_size, arrays.values())) + _HEAD)
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
                rows = slice(start, start + array.chunks[0])
                variable[rows] = array[rows]


def _largest_size(array: Any) -> int:
    """Return the bytes that an array of zarr takes in the file at most, whatever its values."""
    chunk = array.dtype.itemsize * math.prod(array.chunks)
    return array.nchunks * int(_DEFLATE_RATIO * chunk + _INDEX_ENTRY) + _HEAD


def _reserve(path: Path, size: int) -> None:
    """Lengthen a file, so that HDF5, which may crash on a full disk, does not meet one.

    When HDF5 closes the file it cuts off the bytes that it did not use.  Where the system cannot reserve disk space,
    zeros are written.

    path: path of the file, which must exist.
    size: number of bytes to add at its end, > 0.
    Raises OSError if the disk is full.
    """
    with path.open("r+b") as file:
        start = file.seek(0, os.SEEK_END)
        if hasattr(os, "posix_fallocate"):
            os.posix_fallocate(file.fileno(), start, size)
            return
        for written in range(0, size, _PIECE):
            file.write(bytes(min(_PIECE, size - written)))
