"""Identity of a store: the run that it belongs to, and whether the same run with more motions may extend it."""

from __future__ import annotations

import hashlib
import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import msgspec
import numpy as np

from ... import __version__
from ...core.errors import FileError
from ...motion.export import provenance
from .records import Record
from .runfile import Run

#: Last words of an error about the folder of a store.
ADVICE = "give another folder with -o, or delete this one"


def about(run: Run) -> dict[str, Any]:
    """Return the attributes of a store, by which a reader finds out how it was made.

    run: :class:`Run`, whose results the store holds; text, method, block, blocks, si and settings are read.
    Returns name -> value: the texts Conventions, title, source, versions (JSON of :func:`_software`), design, method
    ("flow" or "integrate"), quantities ("in SI units" or "dimensionless") and run_file, the text of the file; the
    integers motions, motions_a_block, blocks and seed.
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
    """Return the versions of the packages that the bits of a result depend on, and a digest of the kernels.

    Returns a dict with the versions of "viscoroll", "numpy", "scipy" and "numba", and as "kernels" a hash of the
    sources of the compiled functions, 16 hexadecimal digits.
    """
    import numba
    import scipy

    from ...kernels.compile.cache import sources_digest

    modules = {module.__name__: module.__version__ for module in (np, scipy, numba)}
    return {"viscoroll": __version__, "kernels": sources_digest()} | modules


def identity(run: Run) -> str:
    """Return a digest of all that the bits of a block depend on: inputs, settings, method, size of blocks, software.

    Two runs that differ in ``n`` alone have one identity, unless their design is a Latin hypercube, whose strata depend
    on the number of motions, or ``n`` changes their method or the size of their blocks.

    run: :class:`Run`, of which digest, method, block and, of a Latin hypercube, n are read.
    Returns a SHA-256, 64 hexadecimal digits.
    """
    n = run.settings.n if run.settings.design == "latin" else None
    text = json.dumps([run.digest, run.method, run.block, n, _software()])
    return hashlib.sha256(text.encode()).hexdigest()


def refuse_another(root: Path, run: Run, record: Record) -> None:
    """Raise FileError if a store belongs neither to a run nor to the same run with fewer motions.

    The message states which of these it is: other versions of the software, another run file, more motions, or a run
    that cannot be extended, and what to change.

    root: path of the folder of the store, for the message.
    run: :class:`Run` that is to be written there.
    record: a :class:`Record` of the store: "start", or "end", or, if both are lost, of any block.  That of a block does
        not state the ``n`` of its run: it must have the identity of ``run``.
    """
    of_a_block = record.summary is not None
    if record.run == identity(run) and (of_a_block or record.motions == run.settings.n):
        return
    versions = record.about.get("versions", json.dumps(_software()))
    if versions != json.dumps(_software()):
        raise FileError(root, f"was written with other versions, {versions}: finish it with these, or {ADVICE}")
    before = replace(run, settings=msgspec.structs.replace(run.settings, n=max(record.motions, 1)))
    if of_a_block or record.run != identity(before):
        raise FileError(root, f"contains the results of another run file: {ADVICE}")
    if problem := _no_extension(before, run):
        raise FileError(root, f"contains {record.motions} motions of this run file, {problem}, or {ADVICE}")


def _no_extension(before: Run, run: Run) -> str:
    """Return why a store cannot be extended, and what to change in the run file, as words of a message; "" if it can.

    The first of these that holds counts: fewer motions than the store has; a Latin hypercube; a Sobol sequence of a
    number that is no power of two; another size of blocks; another method.

    before: :class:`Run` of the store; n, block and method of both are read.
    run: :class:`Run`, the same run with another ``n``; its design is read.
    """
    n, design = run.settings.n, run.settings.design
    if n < before.settings.n:
        return f"and n must not be reduced: set n >= {before.settings.n}"
    if design == "latin":
        return f"a Latin hypercube, whose strata depend on n: keep n = {before.settings.n}"
    if design == "sobol" and n & (n - 1):
        return f"along Sobol's sequence, which is balanced only for a power of two: set n = {1 << n.bit_length()}"
    if run.block != before.block:
        return f"in blocks of {before.block}: add block = {before.block} to [run]"
    if run.method != before.method:
        return f"computed by method {before.method!r}: add method = {before.method!r} to [run]"
    return ""
