"""The size of the code, in tokens: by folder, and by capability; nothing is measured.

A token is a name, a number, an operator or a string of Python.  Comments, docstrings, line ends and
indentation count nothing, so that an explanation makes no file larger.
"""

from __future__ import annotations

import tokenize
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

from ...stage import ROOT
from ..results import Results

COUNTED = (tokenize.NAME, tokenize.NUMBER, tokenize.OP, tokenize.STRING)
#: Tokens before the first one of a statement: a string that follows them, alone, is a docstring.
STARTS = (tokenize.ENCODING, tokenize.NEWLINE, tokenize.INDENT, tokenize.DEDENT)
#: Columns of the second table, and the folders that each of them counts.
KINDS = {"source": ("src",), "tests": ("tests",), "evidence": ("pipeline",)}


def count_tokens(path: Path) -> int:
    """Return the number of tokens of code in a Python file, without those of docstrings.

    path: of the file.
    """
    with path.open("rb") as file:
        kinds = [
            t.type
            for t in tokenize.tokenize(file.readline)
            if t.type not in (tokenize.COMMENT, tokenize.NL)
        ]
    pairs = zip([tokenize.NEWLINE, *kinds], kinds)
    return sum(
        kind in COUNTED and not (kind == tokenize.STRING and before in STARTS)
        for before, kind in pairs
    )


@cache
def sizes() -> dict[str, int]:
    """Return the tokens of every Python file of the tree by its path below the root."""
    folders = [ROOT / folder for kind in KINDS.values() for folder in kind]
    paths = (path for folder in folders for path in sorted(folder.rglob("*.py")))
    return {path.relative_to(ROOT).as_posix(): count_tokens(path) for path in paths}


def folder_costs(_: Results, folders: dict[str, str]) -> Iterator[dict[str, Any]]:
    """Yield a row for each folder: its files, its tokens, and these over those of the first, which
    is what users call.

    folders: path below the root -> what it contains.
    """
    counts = {
        folder: [size for path, size in sizes().items() if path.startswith(folder)]
        for folder in folders
    }
    called = sum(counts[next(iter(folders))])
    for folder, own in counts.items():
        row = {"folder": folder, "content": folders[folder], "files": len(own), "tokens": sum(own)}
        yield row | {"share": sum(own) / called}


def capability_costs(_: Results, capabilities: dict[str, list[str]]) -> Iterator[dict[str, Any]]:
    """Yield a row for each capability: tokens of what users call, of tests and of evidence.

    A file belongs to the first capability that has a word of its path; the last one has the empty
    word.

    capabilities: name -> words.
    """
    rows = {name: dict.fromkeys(KINDS, 0) for name in capabilities}
    for path, size in sizes().items():
        owner = next(
            name for name, words in capabilities.items() if any(word in path for word in words)
        )
        rows[owner][next(kind for kind, folders in KINDS.items() if path.startswith(folders))] += (
            size
        )
    for name, row in rows.items():
        yield row | {"name": name, "ratio": (row["tests"] + row["evidence"]) / row["source"]}
