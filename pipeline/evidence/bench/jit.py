"""Compilation of the benchmark's own code, cached under a hash of everything that it is made of."""

from __future__ import annotations

import hashlib
from pathlib import Path

import numba

from viscoroll.kernels.compile.cache import sources_digest
from viscoroll.kernels.compile.folder import cache_root

PIPELINE = Path(__file__).parents[1]


def _digest() -> str:
    digest = hashlib.sha256(sources_digest().encode())
    for path in sorted((*PIPELINE.glob("bench/*.py"), *PIPELINE.glob("peers/*.py"))):
        digest.update(path.name.encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()[:16]


# numba's own cache looks at the file of a function only, not at what it calls: another folder for each state of both
numba.config.CACHE_DIR = str(cache_root() / f"bench-{_digest()}")

#: decorator: as the package's kernels, and what may be fused is, which those forgo
compiled = numba.njit(nogil=True, error_model="numpy", fastmath={"contract"}, cache=True)
