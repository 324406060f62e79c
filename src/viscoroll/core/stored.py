"""What takes long to make, on disk beside the compiled kernels: arrays, sealed, those used last."""

from __future__ import annotations

import hashlib
import io
import warnings
from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import lru_cache
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from ..kernels.compile.folder import cache_root, read_own, write_own
from .files import seal, seal_holds
from .typed import Floats

#: files kept of each kind; the one that was used longest ago goes first
KEPT = 64

Made = TypeVar("Made")
Numbers = Sequence[float] | Floats


def folder(kind: str) -> Path:
    """Where things of a kind are kept: they are worth no more than the kernels and modules that fill and read them."""
    return cache_root() / f"{kind}-{_digest(Path(__file__).parents[1])}"


@lru_cache(maxsize=1)
def _digest(package: Path) -> str:
    """Hash of the sources of kernels, materials and motions."""
    from ..kernels.compile.cache import sources_digest

    digest = hashlib.sha256(sources_digest().encode())
    for part in ("materials", "motion"):
        for path in sorted((package / part).rglob("*.py")):
            digest.update(path.name.encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()[:16]


def file_name(numbers: Numbers) -> str:
    """Name of the file of what these numbers determine."""
    return hashlib.sha256(b"sealed" + np.array(numbers).tobytes()).hexdigest()[:20] + ".npz"


def load(path: Path, what: str, numbers: Numbers, read: Callable[[Any], Made]) -> Made | None:
    """What ``read`` makes of the arrays in a file; None if there is none, or after a warning, none that is whole.

    ``numbers`` are the parameters that it was saved with.
    """
    try:
        content = read_own(path)
    except OSError:
        return None
    try:
        found = _checked(content, numbers, read)
    except Exception as error:
        warnings.warn(f"{path}: {what} is damaged ({error}); it is built anew", RuntimeWarning, stacklevel=3)
        return None
    with suppress(OSError):  # a folder that is read-only
        path.touch()
    return found


def _checked(content: bytes, numbers: Numbers, read: Callable[[Any], Made]) -> Made:
    if not seal_holds(content):
        raise ValueError("its bytes differ from the SHA-256 at their end")
    with np.load(io.BytesIO(content)) as arrays:
        if not np.array_equal(arrays["parameters"], numbers):
            raise ValueError("its parameters are others")
        return read(arrays)


def save(path: Path, numbers: Numbers, **arrays: Any) -> None:
    """Keep arrays, sealed; where they cannot be written they are made anew next time."""
    try:
        content = io.BytesIO()
        np.savez(content, parameters=numbers, **arrays)
        write_own(path, seal(content.getvalue()))
        oldest = sorted(path.parent.glob("*.npz"), key=lambda file: file.stat().st_mtime)
        for file in oldest[:-KEPT]:
            file.unlink()
    except OSError:
        pass
