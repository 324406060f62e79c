"""Files of a zarr hierarchy (format 2) as bytes: zarr encodes in memory, and the store writes.

So each file is written whole, synced, and compared with the digest of its content.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from ...core.extras import import_extra

if TYPE_CHECKING:
    import xarray as xr

#: Names of the metadata files of zarr format 2.
_METADATA = (".zgroup", ".zarray", ".zattrs")


def motion_files(motions: xr.Dataset, count: int, block: int, number: int | None = None) -> dict[str, bytes]:
    """Return files of the group of all motions, as zarr encodes them in memory; nothing is written to disk.

    motions: dataset over (motion, t) with the motions of one block, whose last one may be short; for the metadata the
        number of its motions has no effect.
    count: number of motions of the run, the length of all arrays over motion.
    block: number of motions of a full block, >= 1, which is one chunk.
    number: number of the block whose chunks are returned, from 0; None: return the metadata (.zgroup, .zarray, .zattrs)
        and the arrays without the axis motion, as t.
    Returns path below the group -> content; of block 3 "V/3.0" for an array over (motion, t), "mu/3" for one over
    (motion,).
    Raises MissingDependencyError without zarr.
    """
    zarr = import_extra("zarr", "runs")

    files: dict[str, Any] = {}
    group = zarr.open_group(zarr.storage.MemoryStore(files), mode="w", zarr_format=2, attributes=motions.attrs)
    start = 0 if number is None else number * block
    for name, variable in motions.variables.items():
        of_motions = "motion" in variable.dims
        shape = variable.shape[of_motions:]
        array = group.create_array(
            name, shape=(*(count,) * of_motions, *shape), chunks=(*(block,) * of_motions, *shape), dtype=variable.dtype,
            # with zarr's own fill value, 0, xarray would take t = 0 for missing
            fill_value=np.nan if variable.dtype.kind == "f" else None, config={"write_empty_chunks": True},
            attributes=variable.attrs | {"_ARRAY_DIMENSIONS": list(variable.dims)},
        )  # fmt: skip
        if of_motions == (number is not None):
            array[start : start + len(variable)] = variable.values
    content = _as_bytes(files)
    return content if number is None else {key: chunk for key, chunk in content.items() if not _is_metadata(key)}


def dataset_files(dataset: xr.Dataset) -> dict[str, bytes]:
    """Return all files of a small dataset as zarr writes them: path below its group -> content; nothing is written.

    The metadata of all arrays together (.zmetadata) are left out; :func:`consolidated` makes them.

    dataset: :class:`xr.Dataset` that fits the memory.
    Raises MissingDependencyError without zarr.
    """
    zarr = import_extra("zarr", "runs")

    files: dict[str, Any] = {}
    dataset.to_zarr(zarr.storage.MemoryStore(files), zarr_format=2, consolidated=False)
    return _as_bytes(files)


def consolidated(files: dict[str, bytes]) -> bytes:
    """Return the content of .zmetadata, JSON from which readers take all metadata at once.

    files: path -> content, of the hierarchy; of these only metadata (.zgroup, .zarray, .zattrs) count.
    Returns the content in UTF-8, with the paths in alphabetic order.
    """
    metadata = {key: json.loads(text) for key, text in sorted(files.items()) if _is_metadata(key)}
    return json.dumps({"metadata": metadata, "zarr_consolidated_format": 1}, indent=1).encode()


def _is_metadata(key: str) -> bool:
    """Whether a path is that of a metadata file."""
    return key.rpartition("/")[2] in _METADATA


def _as_bytes(files: Mapping[str, Any]) -> dict[str, bytes]:
    """Return the content of zarr's buffers: path -> bytes."""
    return {key: buffer.to_bytes() for key, buffer in files.items()}
