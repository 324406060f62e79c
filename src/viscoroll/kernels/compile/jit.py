"""One decorator, :func:`kernel`: numba compilation with a disk cache that cannot go stale.

numba's own ``cache=True`` stamps a cached function with the file it is defined in and
does not notice a change in a function it calls from another module.  Here the cache
folder is named after a hash of *all* kernel sources, their coefficient table and the
numba version, every file in it carries a SHA-256 of its content, and anything unreadable
is recompiled and replaced, never trusted and never fatal.

The cache lives in ``$VISCOROLL_CACHE_DIR``, else in ``$XDG_CACHE_HOME/viscoroll``, else in
``~/.cache/viscoroll``.
"""

from __future__ import annotations

import hashlib
import os
import warnings
from functools import lru_cache
from pathlib import Path
from typing import Any, Callable

import numba
from numba.core import caching

#: where all kernels lie
HERE = Path(__file__).parents[1]


def cache_root() -> Path:
    """Folder that holds every cache of the package."""
    if chosen := os.environ.get("VISCOROLL_CACHE_DIR"):
        return Path(chosen)
    base = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    return Path(base) / "viscoroll"


@lru_cache(maxsize=1)
def sources_digest() -> str:
    """Hash of the kernel sources, of their coefficients and of numba's version."""
    digest = hashlib.sha256(f"{numba.__version__}".encode())
    for path in sorted((*HERE.rglob("*.py"), *HERE.rglob("*.npy"))):
        digest.update(path.relative_to(HERE).as_posix().encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()[:16]


@lru_cache(maxsize=2)
def _note_cache_trouble(trouble: str) -> None:
    """Once for each kind of trouble."""
    warnings.warn(f"{trouble}; kernels are compiled anew instead", RuntimeWarning, stacklevel=2)


class _Locator(caching.UserProvidedCacheLocator):
    def __init__(self, py_func: Callable, py_file: str) -> None:
        self._py_file = py_file
        self._lineno = py_func.__code__.co_firstlineno
        self._cache_path = str(cache_root() / f"kernels-{sources_digest()}")

    @classmethod
    def from_function(cls, py_func: Callable, py_file: str) -> _Locator:
        return cls(py_func, py_file)


class _Implementation(caching.CompileResultCacheImpl):
    _locator_classes = (_Locator,)


class _CheckedFile(caching.IndexDataCacheFile):
    """numba's index and data files, each data file behind a SHA-256 of itself."""

    def _save_data(self, name: str, data: Any) -> None:
        content = self._dump(data)
        with self._open_for_write(self._data_path(name)) as file:
            file.write(hashlib.sha256(content).digest() + content)

    def _load_data(self, name: str) -> Any:
        stored = Path(self._data_path(name)).read_bytes()
        if hashlib.sha256(stored[32:]).digest() != stored[:32]:
            raise ValueError(f"{name} is damaged")
        return caching.pickle.loads(stored[32:])


class _Cache(caching.FunctionCache):
    _impl_class = _Implementation

    def __init__(self, py_func: Callable) -> None:
        super().__init__(py_func)
        plain = self._cache_file
        self._cache_file = _CheckedFile(
            cache_path=plain._cache_path,
            filename_base=self._impl.filename_base,
            source_stamp=plain._source_stamp,
        )

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        try:
            return super().load_overload(sig, target_context)
        except OSError:  # cannot be read: saving will say so
            return None
        except Exception:  # any damage: compile again, save_overload then replaces the files
            _note_cache_trouble(f"the cache of compiled kernels is damaged ({self._impl.locator.get_cache_path()})")
            return None

    def save_overload(self, sig: Any, data: Any) -> None:
        try:
            super().save_overload(sig, data)
        except OSError as error:
            _note_cache_trouble(f"compiled kernels are not cached ({error})")
        except Exception:  # a damaged index: start a new one
            self._cache_file.flush()
            super().save_overload(sig, data)


def kernel(function: Callable | None = None, *, inline: bool = False, allocates: bool = False) -> Callable:
    """Compile ``function`` with numba, lazily, cached on disk (see the module docstring).

    LLVM is granted no numerical freedom: a result then depends on the source alone, not on what
    was compiled together (see :mod:`fma`).

    ``inline`` is for the few short functions at the bottom of every loop: a call of a numba
    function costs as much as a polynomial, and LLVM by itself does not always spare it.
    ``allocates`` says that arrays are made or assigned as a whole.  Without it no references are
    counted; numba counts those of constant tables too, which took a fifth of the time of a motion.
    """
    if function is None:
        return lambda f: kernel(f, inline=inline, allocates=allocates)
    compiled = numba.njit(function, error_model="numpy", nogil=True, forceinline=inline, _nrt=allocates)
    if not numba.config.DISABLE_JIT:
        compiled._cache = _Cache(function)
    return compiled
