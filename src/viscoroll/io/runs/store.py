"""A results store: a zarr hierarchy that any number of processes fill block by block.

    results.zarr/
      V_mean, V_quantiles, V_histogram, ...             the summaries: xarray.open_zarr(path)
      motions/V, omega, x, onset_time, status, ...      every motion (keep = "all"): one block = one chunk
      records/start, 000000000, 000000001, ..., end     what is done (see :mod:`records`)

Every file is written whole or not at all, its record after it, and nothing in it depends on when,
where or in which order the blocks were worked on: two stores of one run are the same files.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...core.errors import FileError
from ...core.files import write_bytes
from ...motion.ensemble_result import Ensemble
from ...motion.summaries import Summary, merge_summaries, summarise, summary_dataset
from . import zarr_files
from .columns import attributes
from .evaluate import roll_block, roll_inputs
from .identity import ADVICE, about, identity, refuse_another
from .records import RECORDS, Record, damaged, encoded, make_folder, put, read_record, refuse_unreadable
from .runfile import Run

MOTIONS = "motions"
_LOCK = ".lock"
_EACH = ("onset_time", "rest_time", "status", "flow")


@dataclass(frozen=True)
class Store:
    """Results of ``run`` in the folder ``root``."""

    root: Path
    run: Run

    def begin(self) -> None:
        """Make the folder and the metadata of all motions, or check that it is this run's, perhaps with fewer motions.

        Raises
        ------
        FileError
            A folder that holds anything else, or cannot be written.
        """
        self.refuse_other()
        make_folder(self.root / RECORDS)
        self._sweep()
        self._drop_end()
        self._keep("start", metadata(self.run), about=about(self.run))

    def _keep(self, name: str | int, files: dict[str, bytes], **more: Any) -> None:
        """Write files, then the record of them; raises FileError."""
        record = Record(identity(self.run), put(self.root, files), self._motions(name), **more)
        write_bytes(_path(self.root, name), encoded(record))

    def _motions(self, name: str | int) -> int:
        """How many motions a record is of: of a block its own, else all."""
        if isinstance(name, str):
            return self.run.settings.n
        start, stop = self.run.edges(name)
        return stop - start

    def _drop_end(self) -> None:
        """Remove the summaries of fewer motions, their record first: from then on the store is not finished."""
        end = read_record(_path(self.root, "end"))
        if end is None or end.motions == self.run.settings.n:
            return
        try:
            for path in (_path(self.root, "end"), *(self.root / name for name in end.files)):
                path.unlink(missing_ok=True)
        except OSError as error:
            raise FileError(path, f"cannot be removed ({error.strerror or error})") from error

    def refuse_other(self) -> None:
        """Raise FileError unless the folder is new, or begun by the same run, perhaps with fewer motions."""
        root = self.root
        if not root.exists():
            return
        if not root.is_dir():
            raise FileError(root, f"is a file: {ADVICE}")
        refuse_unreadable(root)
        blocks = sorted((root / RECORDS).glob("[0-9]*"))
        whole = map(read_record, (_path(root, "start"), _path(root, "end"), *blocks))
        record = next((found for found in whole if found is not None), None)
        if record is not None:
            refuse_another(root, self.run, record)
            return
        others = sorted(path.name for path in root.iterdir() if path.name not in (RECORDS, MOTIONS))
        if others:
            raise FileError(root, f"is no results store, it holds {', '.join(others[:3])}: {ADVICE}")

    def missing(self) -> Iterator[int]:
        """Blocks that are not there, or not whole: their records and all their files are read."""
        own = identity(self.run)
        for block in range(self.run.blocks):
            if problems(self.root, block, own, self._motions(block)):
                yield block

    def work(self, block: int) -> int:
        """Roll a block and store it; returns its number of motions.  Raises FileError."""
        files, summary, count = made(self.run, block)
        self._keep(block, files, summary=summary)
        return count

    def end(self) -> None:
        """Merge the summaries of all blocks and write them; raises FileError."""
        dataset = summary_dataset(
            merge_summaries(self._summaries()), self.run.t, self.run.settings.quantiles, self.run.si
        )
        files = zarr_files.dataset_files(dataset.assign_attrs(about(self.run)))
        files[".zmetadata"] = zarr_files.consolidated(files | metadata(self.run))
        self._keep("end", files)
        self._sweep()

    def _sweep(self) -> None:
        """Remove what processes that were killed in a write left behind, before this start or, workers, since."""
        for left_over in self.root.rglob(".*.tmp-*"):
            with suppress(OSError):
                left_over.unlink()

    def _summaries(self) -> Iterator[Summary]:
        for block in range(self.run.blocks):
            record = read_record(_path(self.root, block))
            if record is None or record.summary is None:
                raise FileError(self.root, f"block {block} was damaged meanwhile: the same command goes on")
            yield record.summary


def made(run: Run, block: int) -> tuple[dict[str, bytes], Summary, int]:
    """What there is to store of a block: files, summary, number of motions."""
    values, motions = roll_block(run, block)
    files = _motion_files(run, columns_of(run, values, motions), block) if run.settings.keep == "all" else {}
    return files, summarise(motions, run.settings.summaries), len(motions)


def metadata(run: Run) -> dict[str, bytes]:
    """Metadata of the group of all motions, if they are kept; a single motion tells names and types."""
    if run.settings.keep == "summaries":
        return {}
    values = {name: np.atleast_1d(value) for name, value in run.inputs.medians.items()}
    return _motion_files(run, columns_of(run, values, roll_inputs(run, values)))


def _motion_files(run: Run, columns: dict[str, NDArray], block: int | None = None) -> dict[str, bytes]:
    import xarray as xr

    described: dict[str, Any] = {
        name: (("motion", "t")[: values.ndim], values, attributes(name, run.si)) for name, values in columns.items()
    }
    motions = xr.Dataset(described, {"t": ("t", run.t, attributes("t", run.si))}, about(run))
    files = zarr_files.motion_files(motions, run.settings.n, run.block, block)
    return {f"{MOTIONS}/{name}": content for name, content in files.items()}


def columns_of(run: Run, values: dict[str, Any], motions: Ensemble) -> dict[str, NDArray]:
    """What is kept of every motion."""
    columns = {name: values[name] for name in run.inputs.uncertain}
    columns |= {name: getattr(motions, name) for name in (*run.settings.fields, *_EACH)}
    return columns | {"flow": columns["flow"].astype(np.int8)}


def problems(root: Path, name: str | int, run: str, motions: int) -> list[str]:
    """What is damaged or missing of a record "start", "end" or a block: its own path, or those of its files.

    run, motions : what the record has to be of.
    """
    record = read_record(_path(root, name))
    if record is None or (record.run, record.motions) != (run, motions):
        return [str(_path(root, name).relative_to(root))]
    return damaged(root, record)


def _path(root: Path, name: str | int) -> Path:
    return root / RECORDS / (name if isinstance(name, str) else f"{name:09d}")


@contextmanager
def locked(root: Path) -> Iterator[None]:
    """Keep other processes from starting to work on the store.

    Raises
    ------
    FileError
        If another process has it.
    """
    from filelock import FileLock, Timeout

    make_folder(root / RECORDS)
    lock = FileLock(root / RECORDS / _LOCK, timeout=0)
    try:
        lock.acquire()
    except Timeout:
        raise FileError(root, "another process is writing to it") from None
    except (OSError, NotImplementedError) as error:  # some network disks
        raise FileError(root, f"cannot be locked ({getattr(error, 'strerror', None) or error})") from error
    try:
        yield
    finally:
        lock.release()
