"""Results of a finished run: its store checked against its records (:func:`verify`), opened as a
result that prints itself and gives datasets, tables and figures (:func:`open_run`), and exported to
one netCDF-4 file (:func:`export_netcdf`).
"""

import dataclasses
import math
import os
from pathlib import Path
from typing import Any

import numpy as np

from ..core import (
    DataFrame,
    Dataset,
    FileError,
    FilePath,
    MotionStatus,
    Names,
    Result,
    SummaryRow,
    as_path,
    column_name,
    fix_texts,
    import_extra,
    names_ending,
    replace_file,
    unit_of,
)
from .run_records import RECORDS, Record, read_record, refuse_unreadable
from .run_store import MOTIONS, problems

# --- Check of a results store against its records ---


@dataclasses.dataclass(frozen=True)
class Verdict:
    """Result of :func:`verify`; ``str`` states it in words.

    Attributes
    ----------
    blocks : number of blocks of the run.
    missing : numbers of the blocks that are missing or damaged, ascending.
    damaged : paths, below the store, of files that are damaged, and of files of the start that are
        missing.
    finished : whether the summaries are complete and undamaged.
    """

    blocks: int
    missing: tuple[int, ...]
    damaged: Names
    finished: bool

    @property
    def ok(self) -> bool:
        """Whether the store is complete and undamaged."""
        return self.finished and not self.missing and not self.damaged

    def __str__(self) -> str:
        """Return the verdict in words.

        It is one line if all is well.  Else there are a line for each damaged file, one with the
        number of missing blocks, one if the summaries are missing or incomplete, and a last one
        that names the remedy.
        """
        if self.ok:
            blocks = f"{self.blocks} block{'s' * (self.blocks != 1)}"
            return f"complete: {blocks} and the summaries match their checksums (SHA-256)"
        lines = [f"damaged or missing: {name}" for name in self.damaged]
        if self.missing:
            lines += [
                f"missing or incomplete blocks of motions: {len(self.missing)} of {self.blocks}"
            ]
        if not self.finished:
            lines += ["the summaries are missing or incomplete"]
        remedy = "to complete or repair the store, repeat the run (`viscoroll ensemble`)"
        return "\n".join([*lines, remedy])


def verify(path: FilePath) -> Verdict:
    """Read every file of a store and compare it with its SHA-256.

    Parameters
    ----------
    path : folder of the results.

    Returns
    -------
    Verdict
        Damaged files, missing blocks, and whether the summaries are complete; its ``ok`` is True if
        nothing is missing or damaged, ``str`` gives it in words.  A run that is not finished is no
        error.

    Raises
    ------
    FileError
        If the folder is no results store or may not be read, or the record of its start is damaged.

    Notes
    -----
    One flipped bit in any file is found (``tests/runs/test_run_store.py``).

    Examples
    --------
    >>> import viscoroll as vr
    >>> _ = vr.runs.run_ensemble(
    ...     vr.runs.read_run(vr.datasets.path("run.toml")), "results.zarr", threads=1
    ... )
    >>> print(vr.runs.verify("results.zarr"))
    complete: 1 block and the summaries match their checksums (SHA-256)
    """
    root = as_path(path)
    start = start_of(root)
    motions, size, blocks = (
        int(start.about[name]) for name in ("motions", "motions_a_block", "blocks")
    )
    of_blocks: dict[str | int, int] = {
        block: min(size, motions - block * size) for block in range(blocks)
    }
    parts = {"start": motions, **of_blocks, "end": motions}
    faults = {part: problems(root, part, start.run, count) for part, count in parts.items()}
    missing = tuple(block for block in range(blocks) if faults[block])
    # a block or an end without files was not evaluated yet: it is missing, not damaged
    damaged = (
        name
        for part, names in faults.items()
        for name in names
        if part == "start" or (root / name).exists()
    )
    return Verdict(blocks, missing, tuple(damaged), not faults["end"])


def start_of(root: Path) -> Record:
    """Return the record "start" of a store, a :class:`Record` that states identity, motions and
    attributes of the run.

    root: path of the folder of the store.
    Raises FileError if the folder does not exist, may not be read, or has no such record or a
    damaged one.
    """
    if not root.is_dir():
        raise FileError(root, "is not a results store: no folder of this name exists")
    refuse_unreadable(root)
    if start := read_record(root / RECORDS / "start"):
        return start
    raise FileError(
        root,
        "its file records/start is missing or damaged: repeat the run that wrote it to repair it"
        if (root / RECORDS).is_dir()
        else "is not a results store (it contains no folder 'records'): give the folder that "
        "`viscoroll ensemble` wrote, such as results.zarr",
    )


# --- A finished store as a result that prints itself and gives datasets ---


class RunResults(Result):
    """Results of a run in a folder, as :func:`runs.open_run` returns them.

    Attributes
    ----------
    path : path of the folder.
    summaries : dataset over t, quantile and the bins of each quantity, as
        ``xarray.open_zarr(path)`` gives it (:func:`.summaries.summary_dataset`).

    Examples
    --------
    >>> import viscoroll as vr
    >>> _ = vr.runs.run_ensemble(
    ...     vr.runs.read_run(vr.datasets.path("run.toml")), "results.zarr", threads=1
    ... )
    >>> results = vr.runs.open_run("results.zarr")
    >>> len(results), results.to_pandas().shape[0]
    (16, 7)
    """

    def __init__(self, path: Path, summaries: Dataset) -> None:
        self.path = path
        self.summaries = summaries

    def __len__(self) -> int:
        """Number of motions."""
        return int(self.summaries.attrs["motions"])

    @property
    def names(self) -> Names:
        """Names of the summarised quantities."""
        return (*names_ending(self.summaries, "_mean"),)

    @property
    def run_file(self) -> str:
        """Text of the run file."""
        return str(self.summaries.attrs["run_file"])

    def motions(self) -> Dataset:
        """Open the dataset of every motion with its inputs, over (motion, t); values are read when
        they are needed.

        Returns
        -------
        xarray.Dataset
            Over (motion, t) the quantities that ``fields`` of the section [run] names, by default V
            (speed of the axis), omega (angular velocity) and x (distance travelled); an output that
            a motion did not reach is NaN.  Over (motion,) each uncertain input by its name,
            onset_time of partial slip and rest_time (NaN of a motion without), status (code of
            :class:`MotionStatus`: 0 DONE, 1 RESTED, 2 to 6 stopped before the last output) and flow
            (1 if the motion was looked up in a flow map, tables of the motions of one scene, 0 if
            it was integrated).  t is a coordinate, motion has none: motion k is the k-th of the
            run, from 0.  All are in the units of the run file.

        Raises
        ------
        FileError
            If the run kept summaries alone.

        Examples
        --------
        >>> import viscoroll as vr
        >>> _ = vr.runs.run_ensemble(
        ...     vr.runs.read_run(vr.datasets.path("run.toml")), "results.zarr", threads=1
        ... )
        >>> try:
        ...     vr.runs.open_run("results.zarr").motions()
        ... except vr.FileError as error:
        ...     print(error.problem)
        contains summaries but no motions: set keep = "all" in [run] and run it into a new folder
        """
        import xarray as xr

        if not (self.path / MOTIONS).is_dir():
            raise FileError(
                self.path,
                'contains summaries but no motions: set keep = "all" in [run] and run it into a '
                "new folder",
            )
        return xr.open_zarr(self.path, group=MOTIONS, chunks=None)

    def to_xarray(self) -> Dataset:
        """Return the summaries: moments, quantiles, histograms, and how the motions ended.

        Returns
        -------
        xarray.Dataset
            The dataset ``summaries`` itself, not a copy, in the units of the run file.  For each
            quantity NAME it has NAME_counted, NAME_mean, NAME_std, NAME_min and NAME_max over t,
            NAME_quantiles over (quantile, t), NAME_histogram, numbers of motions, over (NAME_bin,
            t), and the edges NAME_bin_low and NAME_bin_high of the bins; of a quantity that is one
            number for each motion all are without the axis t.  ``ended`` over status is the number
            of motions with each :class:`MotionStatus`.  Values that are not finite do not count; at
            a time without values the moments and quantiles are NaN, and counts 0.  Attributes are
            failed_motions, motions_from_the_flow_map, and how the run was made
            (:func:`.run_records.about`): motions, motions_a_block, blocks, seed, design, method,
            quantities, versions, run_file, title, source and Conventions.

        Examples
        --------
        >>> import viscoroll as vr
        >>> _ = vr.runs.run_ensemble(
        ...     vr.runs.read_run(vr.datasets.path("run.toml")), "results.zarr", threads=1
        ... )
        >>> vr.runs.open_run("results.zarr").to_xarray()["V_mean"].dims
        ('t',)
        """
        return self.summaries

    def to_pandas(self) -> DataFrame:
        """Return a row for each quantity and time: mean, std, min, max, and a column for each
        quantile.

        All are over the motions of the run; values that are not finite do not count.

        Returns
        -------
        pandas.DataFrame
            A table of float64, the quantities in the order of ``names`` and the times ascending.
            The levels of its index are "quantity", the name with its unit as in "V [m s-1]", and
            the time, named "t" or "t [s]" and NaN for a quantity that is one number per motion.
            Columns are "mean", "std", "min", "max", then the quantiles in the order of the run
            file, each labelled by its level, a float in [0, 1].  std is the root of the mean
            squared difference from the mean (divided by the number of values, not by one less).
            Quantiles are known to the width of a bin, at most 2^-8 of the value.  At a time at
            which no motion has a value all entries are NaN.

        Examples
        --------
        >>> import viscoroll as vr
        >>> _ = vr.runs.run_ensemble(
        ...     vr.runs.read_run(vr.datasets.path("run.toml")), "results.zarr", threads=1
        ... )
        >>> list(vr.runs.open_run("results.zarr").to_pandas().index.names)
        ['quantity', 't']
        """
        import pandas as pd

        data = self.summaries
        tables = []
        time = column_name("t", unit_of(data["t"].attrs))
        for name in self.names:
            columns: dict = {
                moment: data[f"{name}_{moment}"].values for moment in ("mean", "std", "min", "max")
            }
            columns |= zip(data["quantile"].values.tolist(), data[f"{name}_quantiles"].values)
            columns = {column: np.atleast_1d(values) for column, values in columns.items()}
            mean = data[f"{name}_mean"]
            # one number per motion: one row, without a time
            t = data["t"].values if mean.ndim else [np.nan]
            rows = [[column_name(name, unit_of(mean.attrs))], t]
            index = pd.MultiIndex.from_product(rows, names=["quantity", time])
            tables.append(pd.DataFrame(columns, index))
        return pd.concat(tables)

    def _summary(self) -> tuple[str, list[SummaryRow]]:
        """Return the title, with the number of motions and units of a dimensionless run, and the
        rows that print it.

        Returns (title; list of :class:`SummaryRow`, in this order: "path", the folder; "drawn by",
        design and seed of the draws; "t", the number of output times and the last one, with its
        unit; a row for each summarised quantity by its name, with mean, standard deviation and
        unit, of a quantity over time "at the end", that is at the last output time, nan where no
        motion has a value; a row "ended" for each status that some motions have, with their number
        and the status in words; "kept", "every motion" or "summaries").
        """
        data = self.summaries
        t = data["t"]
        about = data.attrs
        rows = [
            SummaryRow("path", str(self.path)),
            SummaryRow("drawn by", f"{about['design']}, seed {about['seed']}"),
            SummaryRow(
                "t", f"{t.size} output time(s), the last {float(t[-1]):.6g}", unit_of(t.attrs)
            ),
        ]
        for name in self.names:
            mean, std = (data[f"{name}_{moment}"] for moment in ("mean", "std"))
            at = "at the end: " * mean.ndim
            text = f"{at}mean {mean.values.flat[-1]:.6g}, std {std.values.flat[-1]:.3g}"
            rows.append(SummaryRow(name, text, unit_of(mean.attrs)))
        rows += [
            SummaryRow("ended", f"{count} of {len(self)} motions: {MotionStatus(code).message}")
            for code, count in zip(data["status"].values, data["ended"].values)
            if count
        ]
        kept = "every motion" if (self.path / MOTIONS).is_dir() else "summaries"
        title = f"Results of a run of {len(self)} motions"
        if not unit_of(t.attrs):
            title += ", dimensionless: speeds in R/T_ref, lengths in R, times in T_ref"
        return title, [*rows, SummaryRow("kept", kept)]


def open_run(path: FilePath) -> RunResults:
    """Open the results of a finished run.

    Parameters
    ----------
    path : folder of the results, of :func:`runs.run_ensemble` or ``viscoroll ensemble``.

    Returns
    -------
    RunResults
        The results.  They print themselves, and have ``to_xarray``, ``to_pandas``, ``plot`` and
        ``motions``; arrays are read from the folder when they are needed.

    Raises
    ------
    FileError
        If the folder is no results store, is not finished, or its summaries are damaged; the files
        of the motions are not examined (:func:`verify` does that).
    MissingDependencyError
        If zarr is not installed.

    Examples
    --------
    >>> import viscoroll as vr
    >>> _ = vr.runs.run_ensemble(
    ...     vr.runs.read_run(vr.datasets.path("run.toml")), "results.zarr", threads=1
    ... )
    >>> vr.runs.open_run("results.zarr").names
    ('V', 'omega', 'onset_time', 'x')
    """
    import xarray as xr

    import_extra("zarr", "runs")
    root = as_path(path)
    start = start_of(root)
    if faults := problems(root, "end", start.run, start.motions):
        problem = f"the run is not finished, or the file {faults[0]} is missing or damaged"
        raise FileError(path, f"{problem}: repeat `viscoroll ensemble` to complete or repair it")
    # chunks=None: arrays of numpy, read at their use, without dask
    return RunResults(root, xr.open_zarr(root, chunks=None))


# --- Export of a store to one netCDF-4 file ---


#: Bytes of the head of an array, and of the file, at most.
_HEAD = 1 << 16
#: Bytes written at a time where the system cannot reserve disk space.
_PIECE = 1 << 24


def export_netcdf(store: FilePath, path: FilePath) -> None:
    """Write a finished store as netCDF-4: summaries at the root, all motions in the group
    "motions".

    Memory does not grow with the number of motions.  While the file is written it takes the disk
    space of its uncompressed content, which is reserved first.

    Parameters
    ----------
    store : folder of the results.
    path : file to write; a file of that name is replaced when the new one is complete.

    Raises
    ------
    FileError
        There is no finished store, or a file in it is damaged; the netCDF file cannot be written,
        or the disk is full.  A file of that name then stays as it was.
    MissingDependencyError
        If zarr is not installed.

    Notes
    -----
    Values are those of the store, bit for bit (``tests/runs/test_run_store.py``).

    Examples
    --------
    >>> import viscoroll as vr
    >>> _ = vr.runs.run_ensemble(
    ...     vr.runs.read_run(vr.datasets.path("run.toml")), "results.zarr", threads=1
    ... )
    >>> vr.runs.export_netcdf("results.zarr", "results.nc")
    """
    summaries = open_run(store).summaries
    verdict = verify(store)
    if not verdict.ok:
        raise FileError(store, "; ".join(str(verdict).splitlines()[-2:]))
    with replace_file(path) as temporary:
        temporary.write_bytes(bytes(fix_texts(summaries).to_netcdf(engine="h5netcdf")))
        if (Path(store) / MOTIONS).is_dir():
            _append_motions(Path(store), temporary)


def _append_motions(store: Path, path: Path) -> None:
    """Copy the motions, chunk by chunk, into the group "motions" of a netCDF-4 file.

    The file is first lengthened by the largest size that the group can take.  Numbers are
    compressed (gzip), with checksums (Fletcher-32), in the chunks of the store.

    store: path of the folder of the results, which has every motion.
    path: path of the netCDF-4 file, which is there already.
    Raises OSError if the disk is full (the file is then incomplete); MissingDependencyError without
    zarr, which the caller has met before.
    """
    import h5netcdf
    import zarr

    source = zarr.open_group(store, mode="r", path=MOTIONS, use_consolidated=False)
    arrays = dict(source.arrays())
    _reserve(path, sum(map(_largest_size, arrays.values())) + _HEAD)
    with h5netcdf.File(path, "a") as file:
        target = file.create_group(MOTIONS)
        target.attrs.update(dict(source.attrs))
        target.dimensions = {"motion": arrays["status"].shape[0], "t": arrays["t"].shape[0]}
        for name, array in arrays.items():
            attrs = dict(array.attrs)
            variable = target.create_variable(
                name,
                # names of the axes, which zarr has as an attribute and netCDF by itself
                attrs.pop("_ARRAY_DIMENSIONS"),
                array.dtype,
                chunks=array.chunks,
                compression="gzip",
                compression_opts=1,
                shuffle=True,
                fletcher32=True,
            )
            variable.attrs.update(attrs)
            count = array.chunks[0]
            for start in range(0, array.shape[0], count):
                variable[start : start + count] = array[start : start + count]


def _largest_size(array: Any) -> int:
    """Return the bytes that an array of zarr takes in the file at most, whatever its values."""
    chunk = array.dtype.itemsize * math.prod(array.chunks)
    # bytes that cannot be compressed grow by 0.2 %, and a chunk takes 512 bytes in the index
    return array.nchunks * int(1.002 * chunk + 512) + _HEAD


def _reserve(path: Path, size: int) -> None:
    """Lengthen a file, so that HDF5, which may crash on a full disk, does not meet one.

    When HDF5 closes the file it cuts off the bytes that it did not use.  Where the system cannot
    reserve disk space, zeros are written.

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
