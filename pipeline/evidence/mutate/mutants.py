"""The defects of mutants.toml, and the tests that should notice each."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

from ...stage import read_toml


class Mutant(NamedTuple):
    """``old`` occurs once in the kernel ``file`` and becomes ``new``; for a table, ``old`` is the
    coefficient's number.

    ``tests`` : files of tests, or tests of one, with spaces between.
    """

    file: str
    old: str
    new: str
    tests: str


def read_mutants() -> list[Mutant]:
    """Return all mutants of the file, its names of tests replaced by their paths."""
    content = read_toml(Path(__file__).with_suffix(".toml"))
    rows = (row for group in content["mutants"].values() for row in group)
    return [
        Mutant(file, old, new, content["tests"].get(tests, tests)) for file, old, new, tests in rows
    ]


MUTANTS = read_mutants()
