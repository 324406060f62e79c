"""The files of a zarr hierarchy (format 2) as bytes: zarr encodes in memory, the store writes.

So every file can be written whole, synced, and held against the digest of what was meant.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from ...core.extras import import_extra

if TYPE_CHECKING:
    import xarray as xr

_METADATA = (".zgroup", ".zarray", ".zattrs")


def motion_files(motions: xr.Dataset, count: int, block: int, number: int | None = None) -> dict[str, bytes]:
    """The group of all ``count`` motions without their chunks, or the chunks of block ``number``, whose they are."""
    zarr = import_extra("zarr", "zarr", "runs")

    files: dict[str, Any] = {}
    group = zarr.open_group(zarr.storage.MemoryStore(files), mode="w", zarr_format=2, attributes=motions.attrs)
    start = 0 if number is None else number * block
    for name, one in motions.variables.items():
        of_each = "motion" in one.dims
        more = one.shape[1:] if of_each else one.shape
        array = group.create_array(
            name, shape=(*(count,) * of_each, *more), chunks=(*(block,) * of_each, *more), dtype=one.dtype,
            # with zarr's own fill value, 0, xarray would take t = 0 for missing
            fill_value=np.nan if one.dtype.kind == "f" else None, config={"write_empty_chunks": True},
            attributes=one.attrs | {"_ARRAY_DIMENSIONS": list(one.dims)},
        )  # fmt: skip
        if of_each == (number is not None):
            array[start : start + len(one)] = one.values
    content = _as_bytes(files)
    return content if number is None else {key: each for key, each in content.items() if not _is_metadata(key)}


def dataset_files(dataset: xr.Dataset) -> dict[str, bytes]:
    """All files of a small dataset."""
    zarr = import_extra("zarr", "zarr", "runs")

    files: dict[str, Any] = {}
    dataset.to_zarr(zarr.storage.MemoryStore(files), zarr_format=2, consolidated=False)
    return _as_bytes(files)


def consolidated(files: dict[str, bytes]) -> bytes:
    """The file .zmetadata of a hierarchy, by which readers find everything at once."""
    found = {key: json.loads(text) for key, text in sorted(files.items()) if _is_metadata(key)}
    return json.dumps({"metadata": found, "zarr_consolidated_format": 1}, indent=1).encode()


def _is_metadata(key: str) -> bool:
    return key.rpartition("/")[2] in _METADATA


def _as_bytes(files: Mapping[str, Any]) -> dict[str, bytes]:
    return {key: buffer.to_bytes() for key, buffer in files.items()}
