"""A disk cache of machine code that cannot go stale.

numba's own cache stamps a function with the file it is defined in and does not notice a change in a
function it calls from another module.  Here the cache folder is named after a hash of *all* kernel
sources, their coefficient table and the versions of numba and llvmlite.  It holds one file for each function,
signature and choice of numba's settings, behind a SHA-256 of itself.  Anything unreadable, or that others may have
written (:mod:`folder`), is compiled anew and replaced, never trusted and never fatal.
"""

from __future__ import annotations

import hashlib
import pickle
import sys
import warnings
import zlib
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from functools import lru_cache
from pathlib import Path
from typing import Any, Callable

import llvmlite
import numba
from numba.core.compiler import CompileResult
from numba.core.serialize import dumps

from .folder import cache_root, make_private_folder, read_private, write_private

#: where all kernels lie
KERNELS = Path(__file__).parents[1]
#: settings of numba (environment: NUMBA_...) that its machine code follows, beside those of the processor
_SETTINGS = (
    "BOUNDSCHECK", "OPT", "LOOP_VECTORIZE", "SLP_VECTORIZE", "DISABLE_INTEL_SVML", "DEBUGINFO_DEFAULT",
    "EXTEND_VARIABLE_LIFETIMES", "ENABLE_PROFILING", "NRT_STATS", "DEBUG_NRT", "LLVM_REFPRUNE_PASS",
    "LLVM_REFPRUNE_FLAGS",
)  # fmt: skip
#: Seconds after which a process compiles what another one seems to: more than any kernel takes on a busy machine.
PATIENCE = 120.0
_DIGEST_SIZE = hashlib.sha256().digest_size


@lru_cache(maxsize=1)
def sources_digest() -> str:
    """Hash of the kernel sources, of their coefficients and of the versions of numba and llvmlite."""
    digest = hashlib.sha256(f"{numba.__version__} {llvmlite.__version__}".encode())
    for path in sorted((*KERNELS.rglob("*.py"), *KERNELS.rglob("*.npy"))):
        digest.update(path.relative_to(KERNELS).as_posix().encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()[:16]


@lru_cache(maxsize=2)
def warn_once(trouble: str) -> None:
    """Once for each kind of trouble."""
    warnings.warn(f"{trouble}; kernels are compiled anew instead", RuntimeWarning, stacklevel=2)


class DiskCache:
    """What numba's dispatcher of one function asks for its machine code before it compiles."""

    def __init__(self, function: Callable) -> None:
        self._function = function
        self._folder = cache_root() / f"kernels-{sources_digest()}"
        self.cache_path = str(self._folder)

    @contextmanager
    def alone(self, signature: Any, codegen: Any) -> Iterator[None]:
        """Have other processes wait for the machine code that this one is about to store, at most :data:`PATIENCE`.

        Where it is stored already, or no lock can be had, nobody waits.
        """
        path = self._path(signature, codegen)
        if path.exists():
            yield
            return
        from filelock import FileLock

        lock = FileLock(f"{path}.lock", timeout=PATIENCE)
        with suppress(OSError):  # also of the time being over
            make_private_folder(path.parent)
            lock.acquire()
        try:
            yield
        finally:
            if lock.is_locked:
                Path(lock.lock_file).unlink(missing_ok=True)
            lock.release()

    def load_overload(self, signature: Any, target: Any) -> CompileResult | None:
        """The machine code for this signature, or None."""
        target.refresh()
        try:
            stored = read_private(self._path(signature, target.codegen()))
        except OSError:  # not there, not to be read or not ours alone: saving will say so
            return None
        digest, content = stored[:_DIGEST_SIZE], stored[_DIGEST_SIZE:]
        if hashlib.sha256(content).digest() == digest:
            with suppress(Exception):  # written by whatever calls itself the same numba
                return CompileResult._rebuild(target, *pickle.loads(zlib.decompress(content)))
        warn_once(f"the cache of compiled kernels is damaged ({self._folder})")
        return None  # save_overload then replaces the file

    def save_overload(self, signature: Any, compiled: CompileResult) -> None:
        """Store machine code."""
        if compiled.library.has_dynamic_globals:
            return  # addresses of this process
        content = zlib.compress(dumps(compiled._reduce()), 1)
        try:
            write_private(self._path(signature, compiled.codegen), hashlib.sha256(content).digest() + content)
        except OSError as error:
            warn_once(f"compiled kernels are not cached ({self._folder}: {error.strerror})")

    def flush(self) -> None:
        """``recompile`` of numba's dispatcher wants this: nothing is held in memory."""

    def _path(self, signature: Any, codegen: Any) -> Path:
        """Named for people after the function, for certain after all that the machine code depends on."""
        function = self._function
        name = f"{function.__module__}.{function.__qualname__}"
        settings = [str(getattr(numba.config, setting, None)) for setting in _SETTINGS]
        key = (name, function.__code__.co_firstlineno, str(signature), codegen.magic_tuple(), sys.version_info[:2])
        digest = hashlib.sha256(repr((*key, settings)).encode()).hexdigest()[:16]
        return self._folder / f"{function.__module__.rpartition('kernels.')[2]}.{function.__name__}-{digest}.nbc"
