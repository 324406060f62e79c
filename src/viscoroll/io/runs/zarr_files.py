"""The files of a zarr hierarchy (format 2) as bytes: zarr encodes in memory, the store writes.

So every file can be written whole, synced, and held against the digest of what was meant.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ...core.extras import imported

if TYPE_CHECKING:
    import xarray as xr

_METADATA = (".zgroup", ".zarray", ".zattrs")


def metadata(
    columns: Mapping[str, NDArray], count: int, block: int, t: NDArray, described: dict[str, dict[str, Any]],
    about: dict[str, Any],
) -> dict[str, bytes]:  # fmt: skip
    """The group of all motions without its chunks; ``columns`` show names, types and dimensions."""
    zarr = imported("zarr", "zarr", "runs")

    files: dict[str, Any] = {}
    group = zarr.open_group(zarr.storage.MemoryStore(files), mode="w", zarr_format=2, attributes=about)
    for name, values in columns.items():
        _create(group, name, values, count, block, described[name])
    # with zarr's own fill value, 0, xarray would take t = 0 for missing
    about_t = described["t"] | {"_ARRAY_DIMENSIONS": ["t"]}
    group.create_array("t", shape=t.shape, dtype=t.dtype, chunks=t.shape, fill_value=np.nan, attributes=about_t)[:] = t
    return _as_bytes(files)


def chunks(columns: Mapping[str, NDArray], number: int, count: int, block: int) -> dict[str, bytes]:
    """The chunks of one block, by their path in the group."""
    zarr = imported("zarr", "zarr", "runs")

    files: dict[str, Any] = {}
    group = zarr.open_group(zarr.storage.MemoryStore(files), mode="w", zarr_format=2)
    for name, values in columns.items():
        _create(group, name, values, count, block, {})[number * block : number * block + values.shape[0]] = values
    return {key: content for key, content in _as_bytes(files).items() if key.rpartition("/")[2] not in _METADATA}


def dataset_files(dataset: xr.Dataset) -> dict[str, bytes]:
    """All files of a small dataset."""
    zarr = imported("zarr", "zarr", "runs")

    files: dict[str, Any] = {}
    dataset.to_zarr(zarr.storage.MemoryStore(files), zarr_format=2, consolidated=False)
    return _as_bytes(files)


def consolidated(files: dict[str, bytes]) -> bytes:
    """The file .zmetadata of a hierarchy, by which readers find everything at once."""
    found = {key: json.loads(text) for key, text in sorted(files.items()) if key.rpartition("/")[2] in _METADATA}
    return json.dumps({"metadata": found, "zarr_consolidated_format": 1}, indent=1).encode()


def _create(group: Any, name: str, values: NDArray, count: int, block: int, described: dict[str, Any]) -> Any:
    dims = ["motion", "t"][: values.ndim]
    return group.create_array(
        name, shape=(count, *values.shape[1:]), chunks=(block, *values.shape[1:]), dtype=values.dtype,
        fill_value=np.nan if values.dtype.kind == "f" else None, config={"write_empty_chunks": True},
        attributes=described | {"_ARRAY_DIMENSIONS": dims},
    )  # fmt: skip


def _as_bytes(files: Mapping[str, Any]) -> dict[str, bytes]:
    return {key: buffer.to_bytes() for key, buffer in files.items()}
