"""Results as one netCDF-4 file: the summaries, and every motion where they are kept, block by block."""

from __future__ import annotations

from os import PathLike
from pathlib import Path
from typing import Any

from ..files import replacing
from .store import MOTIONS
from .verify import open_summaries


def export_netcdf(store: str | PathLike[str], path: str | PathLike[str]) -> None:
    """Write a finished store as netCDF-4: summaries at the root, all motions in the group "motions".

    Memory does not grow with the number of motions.

    Raises
    ------
    TableError
        There is no finished store, or its summaries are damaged.
    OutputError
        The file cannot be written.
    """
    summaries = open_summaries(store)
    with replacing(path) as temporary:
        temporary.write_bytes(bytes(summaries.to_netcdf(engine="h5netcdf")))
        if (Path(store) / MOTIONS).is_dir():
            _append_motions(Path(store), temporary)


def _append_motions(store: Path, path: Path) -> None:
    import h5netcdf
    import zarr

    source = zarr.open_group(store, mode="r", path=MOTIONS, use_consolidated=False)
    with h5netcdf.File(path, "a") as file:
        target = file.create_group(MOTIONS)
        arrays = dict(source.arrays())
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
