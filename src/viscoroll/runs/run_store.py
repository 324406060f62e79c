"""Results store: a zarr hierarchy that any number of processes fill block by block.

    results.zarr/
      V_mean, V_quantiles, V_histogram, ...             the summaries: xarray.open_zarr(path)
      motions/V, omega, x, onset_time, status, ...      motions (keep = "all"): a block is a chunk
      records/start, 000000000, 000000001, ..., end     the complete parts (see :mod:`run_records`)

Each file is written whole or not at all, its record after it, and no file depends on when, where or
in which order the blocks were evaluated: two stores of one run consist of the same bytes.

A block is a range of the motions of a run: :func:`block_inputs` draws its random inputs,
:func:`roll_block` makes the motions.
"""

import contextlib
import dataclasses
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ..contact_mechanics import (
    contact,
    transit_frequency,
    warn_of_contact,
    warn_of_unmeasured_starts,
)
from ..core import FileError, Named, NDArray, as_file_error, shape_error, write_bytes
from ..motion import Ensemble, Summary, ensemble, merge_summaries, summarise, summary_dataset
from ..sampling import points
from .run_records import (
    ADVICE,
    RECORDS,
    Files,
    Record,
    about,
    attributes,
    consolidated,
    dataset_files,
    digest_of,
    encoded,
    identity,
    make_folder,
    motion_files,
    read_record,
    refuse_another,
    refuse_unreadable,
    write_files,
)
from .run_rollers import drive_of, measured_bands, roller_of
from .runfile import START, Run
from .uncertain_inputs import Columns

# --- One block of a run, a range of its motions ---


def block_inputs(run: Run, block: int, most: int | None = None) -> Columns:
    """Draw the inputs of the motions of a block: the same run, block and ``most`` give the same
    bits, whatever blocks were drawn before.

    run: :class:`runs.Run`, of which the inputs, the block size, and seed, design and n of the
    settings are read.
    block: number of the block, from 0 to ``run.blocks - 1``, which is not checked.
    most: number of motions at most, >= 1; None: all of the block.  The inputs of a smaller number
        are a sample of the same distributions, but only with "sobol" are they surely the first ones
        of the whole block.
    Returns name of each uncertain input -> values, float64, (motions,), in the units of the run
    file, where motions is their number in the block, or ``most`` if that is smaller; {} without
    uncertain inputs.  A draw may be infinite where its distribution overflows, which a motion
    refuses.
    """
    start, stop = run.edges(block)
    if most is not None:
        stop = min(stop, start + most)
    settings = run.settings
    of_all = settings.design, settings.seed, settings.n, len(run.inputs.dimensions)
    return run.inputs.values(points(*of_all, start, stop, block))


def roll_inputs(
    run: Run, values: Mapping[str, Any], count: int = 1, threads: int | None = 1
) -> Ensemble:
    """Roll motions of a run from given inputs, in the units of its file.

    Parameters
    ----------
    run : a run of :func:`runs.read_run`.
    values : name of each uncertain input -> a number, (1,) or (count,), in the units of the file;
        other names have no effect.
    count : number of motions, >= 1.
    threads : number of threads; None: ``$VISCOROLL_THREADS``, else all cores available.

    Returns
    -------
    Ensemble
        The motions, ``count`` of them, at the output times of the run, in the units of its file,
        with the fields that the run keeps or summarises (``run.fields``); the other fields are
        None.  A motion that cannot be rolled to its end raises nothing: its ``status`` says so, and
        its outputs from there on are NaN.

    Raises
    ------
    ParameterError
        Inputs that a motion does not allow or that are arrays of another length than ``count``, or
        ``threads`` that is no whole number >= 1.
    FileError
        A material that these inputs do not allow.
    KeyError
        An uncertain input that ``values`` does not have.

    Warns
    -----
    ModelWarning
        As :func:`viscoroll.ensemble`, of motions beyond the model or the measured band of their
        material.

    Examples
    --------
    >>> import viscoroll as vr
    >>> run = vr.runs.read_run(vr.datasets.path("run.toml"))
    >>> vr.runs.roll_inputs(run, run.inputs.medians).V.shape
    (1, 2)
    """
    for name in run.inputs.uncertain:
        if np.shape(values[name]) not in ((), (1,), (count,)):
            raise shape_error(
                name,
                np.shape(values[name]),
                f"a number, or one for each motion; their number, the argument count, is {count}",
            )
    content = run.inputs.filled(values)
    settings = run.settings
    start = content["start"]
    V0, omega0 = (np.broadcast_to(start[name], count) if name in start else None for name in START)
    return ensemble(
        roller_of(run.path, content),
        V0,
        omega0,
        run.t,
        **drive_of(content),
        method=run.method,
        rtol=settings.rtol,
        rest=settings.rest,
        unsteady=settings.unsteady,
        rested=settings.rested,
        fields=run.fields,
        # one flow map for all calls, so that bits do not depend on them; None if all starts are 0
        speed=run.fastest or None if run.method == "flow" else None,
        threads=threads,
    )


def roll_block(run: Run, block: int) -> tuple[Columns, Ensemble]:
    """Draw the inputs of a block, and compute its motions, on one thread, as several blocks are
    rolled at a time.

    run: :class:`runs.Run`, with its inputs, settings and output times.
    block: number of the block, from 0 to ``run.blocks - 1``.
    Returns (name of an uncertain input -> values, (motions,), in the units of the run file, as in
    :func:`block_inputs`; the motions, an :class:`Ensemble` with ``run.fields``, as in
    :func:`runs.roll_inputs`).
    Raises ParameterError for inputs that a motion does not allow, FileError for inputs that a
    material does not allow, CancelledError if the run was interrupted
    (:func:`.arrays.cancel_with`).
    """
    start, stop = run.edges(block)
    values = block_inputs(run, block)
    return values, roll_inputs(run, values, stop - start)


def warn_of_materials(run: Run) -> None:
    """Warn of motions of a run outside the measured bands of its materials, judged by their starts
    and by their median.

    The band of a material is the range of angular frequencies in which it was measured.  If [start]
    gives V0 and a material has such a band, the transit frequencies of the first 1000 starts are
    compared with the bands.  If that gives no warning, also without bands, the contact of the
    median roller at the largest start speed is examined.  In any case the motion of the median
    inputs is integrated, which may warn too.

    run: :class:`runs.Run`, with its inputs, settings and output times.
    Returns None; each warning is a :class:`ModelWarning`, that of a band once for each material in
    a process.
    Raises ParameterError for medians that a motion does not allow, also for one of the first 1000
    draws; FileError for those that a material does not allow.
    """
    medians = run.inputs.medians
    content = run.inputs.filled(medians)
    if "V0" in content["start"]:
        bands = measured_bands(run.path, content)
        if not (bands and warn_of_unmeasured_starts(_fraction_outside(run), bands)):
            warn_of_contact(roller_of(run.path, content), run.inputs.largest("V0"))
    roll_inputs(run._with_settings(summaries=("V",), keep="summaries", method="integrate"), medians)


def _fraction_outside(run: Run) -> float:
    """Return the fraction of motions whose transit frequency at the start is outside a measured
    band of a material.

    The transit frequency is |V0| divided by the contact length in free rolling at that speed, in
    1/s; it is compared with angular frequencies in rad/s.  The ends of a band are inside, as is a
    start at rest, because the rolling moment M is 0 there.

    run: :class:`runs.Run` in SI units that gives V0; its first motions, at most 1000 of the first
    block, are examined.
    Returns the fraction of these motions that are outside the band of at least one material, a
    float in [0, 1].
    Raises ParameterError for inputs of these motions that a cylinder does not allow, FileError for
    a material.
    """
    # of 1000 starts the standard error of a share of 1 % is a third of it
    content = run.inputs.filled(block_inputs(run, 0, most=1000))
    roller: Any = roller_of(run.path, content)
    V0 = np.abs(content["start"]["V0"])
    scene = roller.scene()
    # lam l0 with l0 = R/kappa is the contact length
    lam = contact(scene, V0 / roller.scale["V"], delta=0.0, fields="lam").lam
    frequency = transit_frequency(V0, lam * roller.R / scene.kappa)
    bands = measured_bands(run.path, content).values()
    outside = np.any([(frequency < low) | (frequency > high) for low, high in bands], axis=0)
    return float(np.mean(outside & (V0 > 0.0)))


# --- The store ---

#: Group of the motions in a store.
MOTIONS = "motions"


@dataclasses.dataclass(frozen=True)
class Store:
    """Results of a run in a folder; a part is the start (metadata), a block of motions, or the end
    (summaries).

    Attributes
    ----------
    root : path of the folder, which need not exist yet.
    run : the :class:`runs.Run` whose results it holds.
    """

    root: Path
    run: Run

    def start(self) -> None:
        """Write the metadata of all motions; a store of this run stays as it is.

        The folder of the records must exist (:func:`locked`).  The store of the same run with fewer
        motions is extended: its metadata are written anew, its summaries are removed.  Temporary
        files of killed processes are removed.  Metadata are those of :func:`metadata`, none if
        motions are not kept; the record "start" is written in any case.

        Raises
        ------
        FileError
            A folder that holds anything else, or cannot be written; as :func:`metadata`.
        ParameterError, MissingDependencyError
            As :func:`metadata`, for medians that a motion does not allow and, with keep = "all",
            without zarr.
        """
        self.refuse_other()
        self._remove_temporary_files()
        self._remove_old_end()
        self._write_part("start", metadata(self.run), about=about(self.run))

    def _write_part(self, name: str | int, files: Files, **more: Any) -> None:
        """Write the files of a part, then its record, which makes the part complete.

        name: "start", "end" or the number of a block, from 0.
        files: path below the store -> content; {} of a part without files.
        more: other fields of the :class:`Record`: ``about`` of the start, ``summary`` of a block.
        Raises FileError if a file cannot be written; the part is then not complete.
        """
        # the files first: a record that is there states that they are complete
        record = Record(
            identity(self.run), write_files(self.root, files), self._motions(name), **more
        )
        write_bytes(_record_path(self.root, name), encoded(record))

    def _motions(self, name: str | int) -> int:
        """Return the number of motions of a part.

        name: number of a block, of which the last may have fewer motions; "start" and "end" have
            those of the whole run.
        """
        if isinstance(name, str):
            return self.run.settings.n
        start, stop = self.run.edges(name)
        return stop - start

    def _remove_old_end(self) -> None:
        """Remove the summaries of another number of motions, their record first: the store is then
        not finished.

        Nothing is removed if there is no readable record of summaries, or it states the number of
        motions of this run.
        Raises FileError if a file cannot be removed.
        """
        own = _record_path(self.root, "end")
        end = read_record(own)
        if end is None or end.motions == self.run.settings.n:
            return
        for path in (own, *(self.root / name for name in end.files)):
            with as_file_error(path, "cannot be removed"):
                path.unlink(missing_ok=True)

    def refuse_other(self) -> None:
        """Raise FileError unless the folder is new, or the store of this run, perhaps with fewer
        motions.

        A folder is new if it does not exist, or has nothing but the folders of records and motions,
        without a readable record.  Refused are a file, a folder that cannot be read, one with other
        files, and the store of another run, of a run with more motions, or of one that cannot be
        extended (:func:`.run_records.refuse_another`).
        """
        root = self.root
        if not root.exists():
            return
        if not root.is_dir():
            raise FileError(root, f"is a file: {ADVICE}")
        refuse_unreadable(root)
        # any readable record tells the run: start and end first, since a block does not state n
        blocks = sorted((root / RECORDS).glob("[0-9]*"))
        records = map(
            read_record, (_record_path(root, "start"), _record_path(root, "end"), *blocks)
        )
        if record := next(filter(None, records), None):
            refuse_another(root, self.run, record)
        elif others := {path.name for path in root.iterdir()} - {RECORDS, MOTIONS}:
            names = ", ".join(sorted(others)[:3])
            raise FileError(root, f"is no results store (it contains {names}): give another folder")

    def missing(self) -> Iterator[int]:
        """Yield the numbers of the blocks that are missing or damaged, ascending.

        A block is read, its record and all its files, when its turn comes, so that the caller may
        evaluate blocks while it iterates.  Nothing is raised for files that cannot be read: their
        block counts as missing.
        """
        own = identity(self.run)
        for block in range(self.run.blocks):
            if problems(self.root, block, own, self._motions(block)):
                yield block

    def evaluate(self, block: int) -> int:
        """Roll the motions of a block and store them.

        block: number of the block, from 0 to ``run.blocks - 1``, which is not checked.
        Returns the number of its motions.
        Raises what :func:`block_content` raises, and FileError if writing fails; nothing of the
        block counts as stored then.
        """
        files, summary = block_content(self.run, block)
        self._write_part(block, files, summary=summary)
        return self._motions(block)

    def finish(self) -> None:
        """Merge the summaries of all blocks and write them with the consolidated metadata; the
        store is then finished.

        All blocks must be stored.  Their records are read, not their motions, so that memory does
        not grow with the number of motions.  Temporary files of killed processes are removed.
        Raises FileError if the record of a block is missing or damaged, or writing fails;
        MissingDependencyError without zarr; what :func:`metadata` raises.
        """
        dataset = summary_dataset(
            merge_summaries(self._summaries()), self.run.t, self.run.settings.quantiles, self.run.si
        )
        files = dataset_files(dataset.assign_attrs(about(self.run)))
        files[".zmetadata"] = consolidated(files | metadata(self.run))
        self._write_part("end", files)
        self._remove_temporary_files()

    def _remove_temporary_files(self) -> None:
        """Remove the files that killed processes, of this call or an earlier one, did not finish
        writing.
        """
        for path in self.root.rglob(".*.tmp-*"):
            with contextlib.suppress(OSError):
                path.unlink()

    def _summaries(self) -> Iterator[Summary]:
        """Yield the :class:`Summary` of each block in order; raise FileError if its record is
        missing or damaged.
        """
        for block in range(self.run.blocks):
            record = read_record(_record_path(self.root, block))
            if record is None or record.summary is None:
                problem = "was damaged or removed during the run"
                path = _record_path(self.root, block)
                raise FileError(path, f"{problem}: repeat the run to repair it")
            yield record.summary


def block_content(run: Run, block: int) -> tuple[Files, Summary]:
    """Roll the motions of a block, and make the files and the summary that the store keeps of it;
    nothing is written.

    run: :class:`runs.Run`, with inputs and settings; files of motions are made if ``settings.keep``
    is "all".
    block: number of the block, from 0 to ``run.blocks - 1``.
    Returns (files: path below the store -> content of the chunks of its motions, {} if
    ``settings.keep`` is "summaries"; summary of its motions).
    Raises ParameterError for inputs that a motion does not allow, FileError for inputs that a
    material does not allow, CancelledError if the run was interrupted
    (:func:`.arrays.cancel_with`), MissingDependencyError if motions are kept and zarr is not
    installed.
    """
    values, motions = roll_block(run, block)
    files = {}
    if run.settings.keep == "all":
        files = _motion_files(run, columns_of(run, values, motions), block)
    return files, summarise(motions, run.settings.summaries)


def metadata(run: Run) -> Files:
    """Return the metadata of the group of all motions: path below the store -> content; {} if
    motions are not kept.

    Names and types of the columns are those of one motion, which is rolled for that, with each
    input at its median.

    run: :class:`runs.Run`, with its inputs and settings.
    Raises, if motions are kept, ParameterError for medians that a motion does not allow, FileError
    for those that a material does not allow, MissingDependencyError if zarr is not installed.
    """
    if run.settings.keep == "summaries":
        return {}
    values = {name: np.atleast_1d(value) for name, value in run.inputs.medians.items()}
    return _motion_files(run, columns_of(run, values, roll_inputs(run, values)))


def _motion_files(run: Run, columns: dict[str, NDArray], block: int | None = None) -> Files:
    """Return files of the group of all motions: the chunks of a block, or the metadata.

    It makes the dataset, with attributes and times, that :func:`.run_records.motion_files` encodes.

    run: :class:`runs.Run`, which gives output times, units, number of motions and size of blocks.
    columns: name -> values over (motion,) or (motion, t), in the units of the run; for the metadata
        those of any number of motions, of which names, types and the number of times count.
    block: number of the block whose chunks are returned; None: return the metadata, and the array
        t, which all motions share.
    Returns path below the store, as "motions/V/3.0" -> content.
    Raises MissingDependencyError without zarr.
    """
    import xarray as xr

    variables = {
        name: (("motion", "t")[: values.ndim], values, attributes(name, run.si))
        for name, values in columns.items()
    }
    motions = xr.Dataset(variables, {"t": ("t", run.t, attributes("t", run.si))}, about(run))
    files = motion_files(motions, run.settings.n, run.block, block)
    return {f"{MOTIONS}/{name}": content for name, content in files.items()}


def columns_of(run: Run, values: Named, motions: Ensemble) -> dict[str, NDArray]:
    """Return the columns that are kept of motions: inputs, fields and how they ended.

    run: :class:`runs.Run`, whose settings name the fields.
    values: name of each uncertain input -> values, (n,), in the units of the run file; other names
    have no effect.
    motions: :class:`Ensemble`, n motions with these inputs, which have the fields.
    Returns name -> values in the units of the run: the inputs over (motion,), the fields of
    ``run.settings.fields`` over (motion, t), then onset_time and rest_time (NaN of a motion
    without), status (codes of :class:`MotionStatus`: 0 DONE, 1 RESTED, 2 to 6 stopped before) and
    flow (int8, 1 of a motion from a flow map, else 0) over (motion,).  Outputs that a motion did
    not reach are NaN.
    Raises KeyError for an input that ``values`` does not have.
    """
    columns = {name: values[name] for name in run.inputs.uncertain}
    kept = (*run.settings.fields, "onset_time", "rest_time", "status")
    columns |= {name: getattr(motions, name) for name in kept}
    return columns | {"flow": motions.flow.astype(np.int8)}


def problems(root: Path, name: str | int, run: str, motions: int) -> list[str]:
    """Return the paths, below the store, of a part that are missing or damaged: its record, or
    files that it names.

    root: path of the folder of the store.
    name: "start", "end" or the number of a block, from 0.
    run, motions: identity of the run (:func:`.run_records.identity`) and number of motions of the
        part that the record must state.
    Returns [] if the part is complete; the path of the record alone if that is missing, damaged, of
    another run or of another number of motions; else the paths of files that are missing, cannot be
    read, or differ from their digest.
    """
    path = _record_path(root, name)
    record = read_record(path)
    if record is None or (record.run, record.motions) != (run, motions):
        return [str(path.relative_to(root))]
    return [file for file, digest in record.files.items() if digest_of(root / file) != digest]


def _record_path(root: Path, name: str | int) -> Path:
    """Return the path of the record of a part; name: "start", "end" or the number of a block."""
    return root / RECORDS / (name if isinstance(name, str) else f"{name:09d}")


@contextlib.contextmanager
def locked(root: Path) -> Iterator[None]:
    """Keep other processes from writing to a store; a context manager, which creates the folder.

    The lock ends with the body of the ``with``, or with the process.  The file records/.lock stays.

    root: path of the folder of the store.
    Yields None.
    Raises FileError if another process writes to it, the folder cannot be created, or the disk does
    not allow locks; it does not wait.
    """
    from filelock import FileLock, Timeout

    make_folder(root / RECORDS)
    lock = FileLock(root / RECORDS / ".lock", timeout=0)
    try:
        lock.acquire()
    except Timeout:
        raise FileError(root, "is in use by another process: wait until it ends") from None
    except (OSError, NotImplementedError) as error:  # some network disks
        reason = getattr(error, "strerror", None) or error
        raise FileError(root, f"cannot be locked ({reason}): use a local disk") from error
    try:
        yield
    finally:
        lock.release()
