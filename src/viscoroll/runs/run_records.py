"""Which blocks a store holds and of which run: records, identity, bytes of its files.

**Records** are small sealed files that state which parts of a store are complete.  A record holds
the SHA-256 of each file that belongs to it and is written after them.  So a part is complete
exactly if its record is undamaged and each file that it names has the digest that it states.

**Files** of a zarr hierarchy (format 2) are encoded by zarr in memory, and written by the store: so
each file is written whole, synced, and compared with the digest of its content.

**Identity** of a store: the run that it belongs to, and whether the same run with more motions may
extend it.

**Names**: long names and units of the columns of a store.
"""

import hashlib
import json
import os
import zlib
from pathlib import Path
from typing import Any

import msgspec
import numpy as np

from .. import __version__
from ..core import (
    SYMBOLS,
    Dataset,
    FileError,
    Named,
    as_file_error,
    import_extra,
    seal,
    seal_matches,
    si_unit,
    write_bytes,
)
from ..motion import Summary, column_attributes, provenance
from ..presets import CylinderSection
from .runfile import Run

# --- Records ---

#: Path below the store -> content of a file.
Files = dict[str, bytes]
#: Folder of the records in a store.
RECORDS = "records"


class Record(msgspec.Struct):
    """A complete part of a store: its metadata ("start"), a block, or its summaries ("end").

    Attributes
    ----------
    run : identity of the run, whatever its number of motions.
    files : path below the store -> SHA-256.
    motions : number of motions of the block, or, in the records "start" and "end", of the run.
    about : attributes of the run, in the record "start".
    summary : summary of the motions, in the record of a block.
    """

    run: str
    files: dict[str, str]
    motions: int = 0
    about: dict[str, str | int] = {}
    summary: Summary | None = None


def encoded(record: Record) -> bytes:
    """Return the bytes of the file of a ``record``, a :class:`Record`: MessagePack, compressed and
    sealed.
    """
    content = msgspec.msgpack.encode(record, enc_hook=_encode_array)
    return seal(zlib.compress(content, 4))  # the lowest level at which zlib matches lazily


def read_record(path: Path) -> Record | None:
    """Return the :class:`Record` in a file; None if it is missing, cannot be read, or is damaged in
    any way.

    The seal, the SHA-256 at the end of the file, must be there and agree.  Nothing is raised.

    path: path of the record.
    """
    try:
        stored = path.read_bytes()
        if not seal_matches(stored):
            return None
        content = zlib.decompressobj().decompress(stored)  # the seal after it is left over
        return msgspec.msgpack.decode(content, type=Record, dec_hook=_decode_array)
    except (OSError, ValueError, zlib.error, msgspec.DecodeError):
        return None


def _encode_array(array: np.ndarray) -> list:
    """Return [type as numpy writes it, as "<i8"; bytes] of an ``array``, which MessagePack has no
    type for.
    """
    return [array.dtype.str, array.tobytes()]


def _decode_array(kind: Any, value: Any) -> np.ndarray:
    """Return the array of which :func:`_encode_array` made a list.

    kind: type of the field, which msgspec passes; it is not used.
    value: [type as named by numpy, "<i4" or "<i8"; bytes].
    Returns a read-only vector of that type.
    Raises ValueError for another type, or a number of bytes that is no multiple of its size.
    """
    name, content = value
    if name not in ("<i4", "<i8"):
        raise ValueError("no such array in a record")
    return np.frombuffer(content, name)


def digest_of(path: Path) -> str | None:
    """Return the SHA-256 of a file, 64 hexadecimal digits; None if it is missing or cannot be read.

    path: path of the file.
    """
    try:
        with path.open("rb") as file:
            return hashlib.file_digest(file, "sha256").hexdigest()
    except OSError:
        return None


def write_files(root: Path, files: Files) -> dict[str, str]:
    """Write files below a folder, each whole or not at all, and return their digests.

    A file that has this content already is left alone; folders are created.

    root: path of the folder.
    files: path below root -> content, bytes; {} writes nothing.
    Returns path below root -> SHA-256 in hexadecimal digits, sorted by path.
    Raises FileError if one, or its folder, cannot be written; the files before it stay.
    """
    digests = {name: hashlib.sha256(content).hexdigest() for name, content in sorted(files.items())}
    for name, content in files.items():
        if digest_of(root / name) != digests[name]:
            make_folder((root / name).parent)
            write_bytes(root / name, content)
    return digests


def refuse_unreadable(root: Path) -> None:
    """Raise FileError if the folder of a store, or that of its records, exists and may not be read.

    Without this check unreadable records would look like missing ones, and blocks would be
    evaluated again.

    root: path of the folder of the store.
    """
    for folder in (root, root / RECORDS):
        if folder.is_dir() and not os.access(folder, os.R_OK | os.X_OK):
            raise FileError(folder, "cannot be read (Permission denied)")


def make_folder(path: Path) -> None:
    """Create a folder, and those above it, unless they exist.

    path: path of the folder.
    Raises FileError if that fails, as where a file of that name exists.
    """
    with as_file_error(path, "cannot be created as a folder"):
        path.mkdir(parents=True, exist_ok=True)


# --- Files of a zarr hierarchy (format 2) as bytes ---

#: Names of the metadata files of zarr format 2.
_METADATA = (".zgroup", ".zarray", ".zattrs")


def motion_files(motions: Dataset, count: int, block: int, number: int | None) -> Files:
    """Return files of the group of all motions, as zarr encodes them in memory; nothing is written
    to disk.

    motions: dataset over (motion, t) with the motions of one block, whose last one may be short;
        for the metadata the number of its motions has no effect.
    count: number of motions of the run, the length of all arrays over motion.
    block: number of motions of a full block, >= 1, which is one chunk.
    number: number of the block whose chunks are returned, from 0; None: return the metadata
        (.zgroup, .zarray, .zattrs) and the arrays without the axis motion, as t.
    Returns path below the group -> content; of block 3 "V/3.0" for an array over (motion, t),
    "mu/3" for one over (motion,).
    Raises MissingDependencyError without zarr.
    """
    zarr = import_extra("zarr", "runs")

    files: Named = {}
    group = zarr.open_group(
        zarr.storage.MemoryStore(files), mode="w", zarr_format=2, attributes=motions.attrs
    )
    start = 0 if number is None else number * block
    for name, variable in motions.variables.items():
        of_motions = "motion" in variable.dims
        # a tuple times False is empty: arrays without motions have neither that axis nor its chunks
        further = variable.shape[of_motions:]
        array = group.create_array(
            name,
            shape=(count,) * of_motions + further,
            chunks=(block,) * of_motions + further,
            dtype=variable.dtype,
            # with zarr's own fill value, 0, xarray would take t = 0 for missing
            fill_value=np.nan if variable.dtype.kind == "f" else None,
            config={"write_empty_chunks": True},
            attributes=variable.attrs | {"_ARRAY_DIMENSIONS": list(variable.dims)},
        )
        # for a block the arrays over motions, for the metadata the values of all others
        if of_motions == (number is not None):
            array[start : start + len(variable)] = variable.values
    return {
        key: chunk
        for key, chunk in _as_bytes(files).items()
        if number is None or not key.endswith(_METADATA)
    }


def dataset_files(dataset: Dataset) -> Files:
    """Return all files of a small dataset as zarr writes them: path below its group -> content;
    nothing is written.

    The metadata of all arrays together (.zmetadata) are left out; :func:`consolidated` makes them.

    dataset: :class:`xr.Dataset` that fits the memory.
    """
    import zarr

    files: Named = {}
    dataset.to_zarr(zarr.storage.MemoryStore(files), zarr_format=2, consolidated=False)
    return _as_bytes(files)


def consolidated(files: Files) -> bytes:
    """Return the content of .zmetadata, JSON from which readers take all metadata at once.

    files: path -> content, of the hierarchy; of these only metadata (.zgroup, .zarray, .zattrs)
        count.
    Returns the content in UTF-8, with the paths in alphabetic order.
    """
    metadata = {
        key: json.loads(text) for key, text in sorted(files.items()) if key.endswith(_METADATA)
    }
    return json.dumps({"metadata": metadata, "zarr_consolidated_format": 1}, indent=1).encode()


def _as_bytes(files: Named) -> Files:
    """Return the content of zarr's buffers: path -> bytes."""
    return {key: buffer.to_bytes() for key, buffer in files.items()}


# --- Identity of a store ---

#: Last words of an error about the folder of a store.
ADVICE = "give another folder (option -o of the command), or delete this one"


def about(run: Run) -> Named:
    """Return the attributes of a store, by which a reader finds out how it was made.

    run: :class:`runs.Run`, whose results the store holds; text, method, block, blocks, si and
    settings are read.
    Returns name -> value: the texts Conventions, title, source, versions (JSON of
    :func:`_software`), design, method ("flow" or "integrate"), quantities ("in SI units" or
    "dimensionless") and run_file, the text of the file; the integers motions, motions_a_block,
    blocks and seed.
    """
    return provenance("Ensemble of motions of a viscoelastic cylinder") | {
        "versions": json.dumps(_software()),
        "motions": run.settings.n,
        "motions_a_block": run.block,
        "blocks": run.blocks,
        "seed": run.settings.seed,
        "design": run.settings.design,
        "method": run.method,
        "quantities": "in SI units" if run.si else "dimensionless",
        "run_file": run.text,
    }


def _software() -> dict[str, str]:
    """Return the versions of the packages that the bits of a result depend on, and a digest of the
    kernels.

    Returns a dict with the versions of "viscoroll", "numpy", "scipy" and "numba", and as "kernels"
    a hash of the sources of the compiled functions, 16 hexadecimal digits.
    """
    import numba
    import scipy

    from ..kernels.numerics.jit import sources_digest

    modules = {module.__name__: module.__version__ for module in (np, scipy, numba)}
    return {"viscoroll": __version__, "kernels": sources_digest()} | modules


def identity(run: Run) -> str:
    """Return a digest of all that the bits of a block depend on: inputs, settings, method, size of
    blocks, software.

    Two runs that differ in ``n`` alone have one identity, unless their design is a Latin hypercube,
    whose strata depend on the number of motions, or ``n`` changes their method or the size of their
    blocks.

    run: :class:`runs.Run`, of which digest, method, block and, of a Latin hypercube, n are read.
    Returns a SHA-256, 64 hexadecimal digits.
    """
    n = run.settings.n if run.settings.design == "latin" else None
    text = json.dumps([run.digest, run.method, run.block, n, _software()])
    return hashlib.sha256(text.encode()).hexdigest()


def refuse_another(root: Path, run: Run, record: Record) -> None:
    """Raise FileError if a store belongs neither to a run nor to the same run with fewer motions.

    The message states which of these it is: other versions of the software, another run file, more
    motions, or a run that cannot be extended, and what to change.

    root: path of the folder of the store, for the message.
    run: :class:`runs.Run` that is to be written there.
    record: a :class:`Record` of the store: "start", or "end", or, if both are lost, of any block.
        That of a block does not state the ``n`` of its run: it must have the identity of ``run``.
    """
    of_a_block = record.summary is not None
    if record.run == identity(run) and (of_a_block or record.motions == run.settings.n):
        return
    own = json.dumps(_software())
    if (versions := record.about.get("versions", own)) != own:
        other = sorted(json.loads(str(versions)).items() - _software().items())
        problem = f"was written with other software ({', '.join(map(' '.join, other))})"
        raise FileError(root, f"{problem}: finish it with that software, or {ADVICE}")
    # this run with the number of motions of the store: has it the identity of the store?
    before = run._with_settings(n=max(record.motions, 1))
    if of_a_block or record.run != identity(before):
        problem = "contains the results of another run file, or of this one before a change"
        raise FileError(root, f"{problem}: {ADVICE}")
    if problem := _no_extension(before, run):
        raise FileError(
            root, f"contains {record.motions} motions of this run file, {problem}, or {ADVICE}"
        )


def _no_extension(before: Run, run: Run) -> str:
    """Return why a store cannot be extended, and what to change in the run file, as words of a
    message; "" if it can.

    The first of these that holds counts: fewer motions than the store has; a Latin hypercube; a
    Sobol sequence of a number that is no power of two; another size of blocks; another method.

    before: :class:`runs.Run` of the store; n, block and method of both are read.
    run: :class:`runs.Run`, the same run with another ``n``; its design is read.
    """
    n = run.settings.n
    design = run.settings.design
    if n < before.settings.n:
        return f"and n = {n} is smaller: set n >= {before.settings.n}"
    if design == "latin":
        return f"a Latin hypercube, whose points depend on n: keep n = {before.settings.n}"
    if design == "sobol" and n & (n - 1):
        even = 1 << n.bit_length()
        return f"drawn by Sobol's sequence, and n = {n} is no power of two: set n = {even}"
    if run.block != before.block:
        found = f"in blocks of {before.block} motions, not of {run.block} as now"
        return f"{found}: set block = {before.block} in [run]"
    if run.method != before.method:
        found = f"computed by method {before.method!r}, not {run.method!r} as now"
        return f"{found}: set method = {before.method!r} in [run]"
    return ""


# --- Long names and units of the columns of a store ---

#: Letter of a Prony series in the name of an input, as in tau_2 -> meaning of the number, with its
#: index.
_SERIES = {
    "E": "strength of relaxation mode {}, divided by the long-time modulus",
    "tau": "relaxation time of mode {}, divided by T_ref",
    "J": "strength of creep mode {}, divided by the long-time compliance",
    "T": "retardation time of mode {}, divided by T_ref",
}


def attributes(name: str, si: bool) -> Named:
    """Return the attributes of a column of a store, of types that JSON has.

    name: name of an input (as base_E, tau_2, drive_torque_time_1), of a field or an end of a motion
        (as V, rest_time, status), or "t".
    si: whether the run is in SI units, else dimensionless.
    Returns a dict with long_name and units ("1" of a dimensionless quantity); of a quantity in the
    table of symbols also symbol and equation, unless it has a dimension and the run is in SI units;
    of the codes regime, status and flow no units, but the list flag_values and the text
    flag_meanings, a word for each code.  The long_name is "" of a name that is none of these.
    """
    first, _, rest = name.partition("_")
    if first == "drive":
        # drive_torque, drive_torque_2 (its second value) or drive_torque_time_2
        load, _, corner = rest.partition("_")
        if corner.startswith("time_"):
            times = f"time {corner.removeprefix('time_')} of the given {load}"
            return {"long_name": times, "units": attributes("t", si)["units"]}
        known = attributes(load, si)
        value = f", value {corner}" * bool(corner)
        return known | {"long_name": f"given: {known['long_name']}{value}"}
    if first == "base":
        # a number of the base is named as that of the cylinder, whose words are exchanged
        known = attributes(rest, si)
        return known | {"long_name": f"base: {known['long_name'].removesuffix(' of the cylinder')}"}
    if first in _SERIES and rest.isdecimal():
        return {"long_name": _SERIES[first].format(rest), "units": "1"}
    if name in CylinderSection.__annotations__ and name not in SYMBOLS:
        return {"long_name": f"{name} of the cylinder", "units": si_unit(name)}
    known = column_attributes(name, si)
    return {
        key: value.tolist() if isinstance(value, np.ndarray) else value
        for key, value in known.items()
    }
