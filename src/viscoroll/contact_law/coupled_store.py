"""Tables of the coupled solution that are made at first use, and their files beside the compiled kernels.

A table depends on the bodies over l0 and on mu alone: kappa, gamma, j, load and radius change it by the thickness over
l0 only.
"""

from __future__ import annotations

import hashlib
import io
import math
import threading
import warnings
from contextlib import suppress
from functools import lru_cache
from pathlib import Path

import numpy as np

from ..core.files import seal, seal_matches
from ..kernels.compile.cache import sources_digest
from ..kernels.compile.folder import cache_root, read_private, write_private
from ..kernels.compile.notice import is_quiet
from ..materials.law.coupled_rows import FIELDS, CoupledRows
from ..materials.prony import lock_array
from .coupled import CoupledPair
from .coupled_table import tabulate

#: files kept; the one that was used longest ago goes first
_KEPT = 256
#: Dundurs' constant above which half-spaces take the coupled solution
_COUPLED = 0.05
#: seconds that a table takes on two cores, for messages
SECONDS = 3
_lock = threading.Lock()


def is_coupled(pair: CoupledPair) -> bool:
    """Return whether shear acts on pressure so much that a pair needs the coupled solution.

    pair: the bodies.
    Returns True where one is a layer, or where Dundurs' constant of half-spaces exceeds 0.05 in modulus, at long times
    or at once.
    """
    if any(math.isfinite(body.thickness) for body in pair.bodies):
        return True
    for parts in ([1.0 for _ in pair.bodies], [1.0 - math.fsum(body.J) for body in pair.bodies]):
        shares = [part * body.share for part, body in zip(parts, pair.bodies, strict=True)]
        local = (
            (share if body.side == "base" else -share) * (1.0 - 2.0 * body.nu) / (2.0 - 2.0 * body.nu)
            for share, body in zip(shares, pair.bodies, strict=True)
        )
        if abs(math.fsum(local)) > _COUPLED * math.fsum(shares):
            return True
    return False


def stored_rows(pair: CoupledPair, mu: float) -> CoupledRows:
    """Return the table of a pair at one mu, from this process, from its file, or made now and kept in both.

    A process that a user started shows a progress bar after one second, unless $VISCOROLL_QUIET is 1.
    Raises ConvergenceError for a state that is not solved.
    """
    with _lock:
        return _rows(pair, mu)


@lru_cache(maxsize=32)
def _rows(pair: CoupledPair, mu: float) -> CoupledRows:
    key = hashlib.sha256(f"{_digest()} {pair!r} {mu!r}".encode()).hexdigest()[:20]
    path = cache_root() / "coupled" / f"{key}.npz"
    if (found := _load(path)) is None:
        found = tabulate(pair, mu, progress=not is_quiet())
        with suppress(OSError):
            _save(found, path)
    return found


@lru_cache(maxsize=1)
def _digest() -> str:
    """Return a digest of the sources on which the bits of a table depend."""
    digest = hashlib.sha256(sources_digest().encode())
    for path in sorted(Path(__file__).parent.glob("coupled*.py")):
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


def _load(path: Path) -> CoupledRows | None:
    """Return the table in a file; None without a private one, and with a RuntimeWarning for a damaged one."""
    try:
        content = read_private(path)
    except OSError:
        return None
    try:
        found = _read(content)
    except Exception as error:
        warnings.warn(f"{path}: coupled table is damaged ({error}) and is made again", RuntimeWarning, stacklevel=2)
        return None
    with suppress(OSError):  # a folder that is read-only
        path.touch()
    return found


def _read(content: bytes) -> CoupledRows:
    """Return the table in the bytes of a file; raises ValueError and errors of numpy for what is none."""
    if not seal_matches(content):
        raise ValueError("its bytes differ from the SHA-256 at their end")
    with np.load(io.BytesIO(content)) as data:
        u, t, edges, fields = (lock_array(data[name]) for name in ("u", "t", "edges", "fields"))
        errors = dict(zip(FIELDS, data["errors"].tolist(), strict=True))
        return CoupledRows(float(data["mu"]), u, t, edges, fields, errors=errors)


def _save(rows: CoupledRows, path: Path) -> None:
    """Write a table with a seal, and delete the oldest files beyond :data:`_KEPT`; OSError passes."""
    content = io.BytesIO()
    arrays = {name: getattr(rows, name) for name in ("mu", "u", "t", "edges", "fields")}
    np.savez(content, errors=[rows.errors[name] for name in FIELDS], **arrays)
    write_private(path, seal(content.getvalue()))
    for file in sorted(path.parent.glob("*.npz"), key=lambda file: file.stat().st_mtime)[:-_KEPT]:
        file.unlink()
