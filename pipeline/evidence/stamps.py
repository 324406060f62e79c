"""Of which kernels results are: a digest of what computes, which every file of data/results
carries.

Comments, docstrings and layout compute nothing, so a reworded docstring outdates no result.
Versions of Python and numba are not in it: the files name them beside it.
"""

from __future__ import annotations

import ast
import hashlib
import json
from collections.abc import Iterator
from functools import lru_cache
from pathlib import Path
from typing import Any

import viscoroll

KERNELS = Path(viscoroll.__file__).parent / "kernels"
#: digits of a digest in the text
SHORT = 8


@lru_cache(maxsize=1)
def kernels_digest(kernels: Path = KERNELS) -> str:
    """Hash of the syntax trees and of the coefficients below ``kernels``.

    It takes 0.3 s, as long as a first call from a full cache: what names the cache hashes the files
    as they are.
    """
    digest = hashlib.sha256()
    for path in sorted((*kernels.rglob("*.py"), *kernels.rglob("*.npy"))):
        content = path.read_bytes()
        if path.suffix == ".py":
            content = _plain(ast.parse(content)).encode()
        digest.update(path.relative_to(kernels).as_posix().encode() + b"\0" + content + b"\0")
    return digest.hexdigest()[:16]


def _plain(node: Any) -> str:
    """A syntax tree as text, the same in every version of Python; expressions that are constants
    alone, docstrings say, are left out, and fields that hold nothing, of which later versions have
    more.
    """
    if isinstance(node, ast.AST):
        fields = (
            f"{name}={_plain(value)}"
            for name, value in ast.iter_fields(node)
            if value not in (None, [])
        )
        return f"{type(node).__name__}({','.join(fields)})"
    if isinstance(node, list):
        bare = (
            each
            for each in node
            if not (isinstance(each, ast.Expr) and isinstance(each.value, ast.Constant))
        )
        return f"[{','.join(map(_plain, bare))}]"
    return repr(node)


def stamps(found: Any, name: str) -> dict[str, str]:
    """Part of a result -> digest of the kernels it is of; "unknown" where a result says none."""
    return dict(_stamps(found, name)) or {name: "unknown"}


def _stamps(found: Any, name: str) -> Iterator[tuple[str, str]]:
    if not isinstance(found, dict):
        return
    if "kernels" in found:
        yield name, found["kernels"]
    for key, value in found.items():
        yield from _stamps(value, name if key in ("machine", "parts") else f"{name} {key}")


def outdated(folder: Path) -> dict[str, list[str]]:
    """Results in ``folder`` of other kernels than this tree's -> the digests of those."""
    found = {}
    for path in sorted(folder.glob("*.json")):
        content = json.loads(path.read_text(encoding="utf-8"))
        if others := {*stamps(content, path.stem).values()} - {kernels_digest()}:
            found[path.name] = sorted(others)
    return found
