"""Check of a results store against its records: :func:`verify`."""

from __future__ import annotations

from dataclasses import dataclass
from os import PathLike
from pathlib import Path

from ...core.errors import FileError
from .records import RECORDS, Record, read_record, refuse_unreadable
from .store import problems


@dataclass(frozen=True)
class Verdict:
    """Result of :func:`verify`; ``str`` states it in words.

    Attributes
    ----------
    blocks : number of blocks of the run.
    missing : numbers of the blocks that are missing or damaged, ascending.
    damaged : paths, below the store, of files that are damaged, and of files of the start that are missing.
    finished : whether the summaries are complete and undamaged.
    """

    blocks: int
    missing: tuple[int, ...]
    damaged: tuple[str, ...]
    finished: bool

    @property
    def ok(self) -> bool:
        """Whether the store is complete and undamaged."""
        return self.finished and not self.missing and not self.damaged

    def __str__(self) -> str:
        """Return the verdict in words.

        It is one line if all is well.  Else there are a line for each damaged file, one with the number of missing
        blocks, one if the summaries are missing or incomplete, and a last one that names the remedy.
        """
        if self.ok:
            blocks = f"{self.blocks} block" + "s" * (self.blocks != 1)
            return f"complete: {blocks} and the summaries match their SHA-256"
        lines = [f"damaged or missing: {name}" for name in self.damaged]
        lines += [f"{len(self.missing)} of {self.blocks} blocks are missing or incomplete"] * bool(self.missing)
        lines += ["the summaries are missing or incomplete"] * (not self.finished)
        return "\n".join([*lines, "the same `viscoroll ensemble` command repairs it"])


def verify(path: str | PathLike[str]) -> Verdict:
    """Read every file of a store and compare it with its SHA-256.

    Parameters
    ----------
    path : folder of the results.

    Returns
    -------
    Verdict
        Damaged files, missing blocks, and whether the summaries are complete; its ``ok`` is True if nothing is missing
        or damaged, ``str`` gives it in words.  A run that is not finished is no error.

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
    >>> _ = vr.runs.run_ensemble(vr.runs.read_run(vr.datasets.path("run.toml")), "results.zarr", threads=1)
    >>> print(vr.runs.verify("results.zarr"))
    complete: 1 block and the summaries match their SHA-256
    """
    root, start = Path(path), start_of(path)
    motions, size, blocks = (int(start.about[name]) for name in ("motions", "motions_a_block", "blocks"))
    parts: dict[str | int, int] = {"start": motions}
    parts |= {block: min(size, motions - block * size) for block in range(blocks)} | {"end": motions}
    faults = {part: problems(root, part, start.run, count) for part, count in parts.items()}
    missing = tuple(block for block in range(blocks) if faults[block])
    # a block or an end without files was not evaluated yet: it is missing, not damaged
    damaged = (name for part, names in faults.items() for name in names if part == "start" or (root / name).exists())
    return Verdict(blocks, missing, tuple(damaged), not faults["end"])


def start_of(path: str | PathLike[str]) -> Record:
    """Return the record "start" of a store, a :class:`Record` that states identity, motions and attributes of the run.

    path: folder of the store.
    Raises FileError if the folder does not exist, may not be read, or has no such record or a damaged one.
    """
    if not Path(path).is_dir():
        raise FileError(path, "is not a results store: the folder does not exist")
    refuse_unreadable(Path(path))
    start = read_record(Path(path) / RECORDS / "start")
    if start is None:
        raise FileError(
            path, "is not a results store, or its record `start` is damaged: run the command that wrote it again"
        )
    return start
