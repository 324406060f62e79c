"""Which run a store belongs to, and whether the same run with more motions may go on with its blocks."""

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

ADVICE = "give another folder with -o, or delete this one"


def about(run: Run) -> dict[str, Any]:
    """What a store says of itself: run file, seed, versions."""
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
    """What decides about the bits, beside the run and the processor."""
    import numba
    import scipy

    from ...kernels.compile.cache import sources_digest

    return {
        "viscoroll": __version__, "kernels": sources_digest(), "numpy": np.__version__, "scipy": scipy.__version__,
        "numba": numba.__version__,
    }  # fmt: skip


def identity(run: Run) -> str:
    """SHA-256 of what all blocks of a run have in common, whatever their number, and of the software.

    Two runs that differ in ``n`` alone share it, unless they draw a Latin hypercube, whose strata are of all motions,
    or ``n`` changes their method or the size of their blocks.
    """
    of_all = run.settings.n if run.settings.design == "latin" else None
    text = json.dumps([run.digest, run.method, run.block, of_all, _software()])
    return hashlib.sha256(text.encode()).hexdigest()


def refuse_another(root: Path, run: Run, record: Record) -> None:
    """Refuse a store that is neither of this run nor of the same with fewer motions.

    Parameters
    ----------
    root : the folder.
    run : that is to be worked on.
    record : of the store: "start", or "end", or, where both are lost, of any block, which does not tell ``n``.

    Raises
    ------
    FileError
        Another run file, other versions of the software, or a change of ``n`` that the blocks do not allow.
    """
    of_a_block = record.summary is not None
    if record.run == identity(run) and (of_a_block or record.motions == run.settings.n):
        return
    versions = record.about.get("versions", json.dumps(_software()))
    if versions != json.dumps(_software()):
        raise FileError(root, f"was begun with other versions, {versions}: finish it with those, or {ADVICE}")
    before = replace(run, settings=msgspec.structs.replace(run.settings, n=max(record.motions, 1)))
    if of_a_block or record.run != identity(before):
        raise FileError(root, f"holds the results of another run file: {ADVICE}")
    if problem := _no_growth(before, run):
        raise FileError(root, f"holds {record.motions} motions of this run file, {problem}, or {ADVICE}")


def _no_growth(before: Run, run: Run) -> str:
    """Why a store of the one run does not become one of the other, and what to do; "" where it does."""
    n, design = run.settings.n, run.settings.design
    if n < before.settings.n:
        return f"which may become more, not fewer: set n >= {before.settings.n}"
    if design == "latin":
        return f"a Latin hypercube, whose strata are of all motions: keep n = {before.settings.n}"
    if design == "sobol" and n & (n - 1):
        return f"along Sobol's sequence, which is even where n is a power of two: set n = {1 << n.bit_length()}"
    if run.block != before.block:
        return f"in blocks of {before.block}: add block = {before.block} to [run]"
    if run.method != before.method:
        return f"found by method {before.method!r}: add method = {before.method!r} to [run]"
    return ""
