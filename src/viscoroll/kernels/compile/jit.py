"""One decorator, :func:`kernel`: numba compilation, deferred (:mod:`deferred`) and cached on disk (:mod:`cache`)."""

from __future__ import annotations

from typing import Any, Callable

import numba

from .cache import DiskCache
from .deferred import EntryPipeline, defer

if numba.config.DISABLE_JIT:
    raise ImportError("NUMBA_DISABLE_JIT = 1: must be 0, the kernels of viscoroll are machine code")


def kernel(function: Callable | None = None, *, inline: bool = False, allocates: bool = False) -> Callable:
    """Compile ``function`` with numba, lazily, cached on disk.

    LLVM is granted no numerical freedom: a result then depends on the source alone, not on what
    was compiled together (see :mod:`.intrinsics`).

    ``inline`` is for the few short functions at the bottom of every loop: a call of a numba
    function costs as much as a polynomial, and LLVM by itself does not always spare it.
    ``allocates`` says that arrays are made or assigned as a whole.  Without it no references are
    counted; numba counts those of constant tables too, which took a fifth of the time of a motion.
    """
    if function is None:
        return lambda f: kernel(f, inline=inline, allocates=allocates)
    options = {"error_model": "numpy", "nogil": True, "forceinline": inline, "_nrt": allocates}
    whole = numba.njit(function, pipeline_class=EntryPipeline, **options)
    whole._cache = DiskCache(function)
    defer(whole, options)
    _compile_alone(whole)
    return whole


def _compile_alone(whole: Any) -> None:
    """Let no two processes compile the same at the same time."""
    plain = whole.compile

    def compile_alone(signature: Any) -> Any:
        with whole._cache.alone(signature, whole.targetctx.codegen()):
            return plain(signature)

    whole.compile = compile_alone
