"""One decorator, :func:`kernel`: numba compilation, deferred (:mod:`deferred`) and cached on disk (:mod:`cache`)."""

from typing import Callable

import numba

from .cache import DiskCache
from .deferred import EntryPipeline, defer

if numba.config.DISABLE_JIT:
    raise ImportError("NUMBA_DISABLE_JIT = 1: must be 0, the kernels of viscoroll are machine code")


def kernel(function: Callable | None = None, *, inline: bool = False, allocates: bool = False) -> Callable:
    """Compile a function with numba, when it is first called, and keep the machine code on disk.

    LLVM is granted no numerical freedom: a result then depends on the source alone, not on what was compiled together
    (see :mod:`.intrinsics`).  In a kernel a division by zero gives inf or NaN as in numpy, and indices of arrays are
    not checked; the GIL is released.

    Parameters
    ----------
    function : the function; None, for a decorator with the other arguments.
    inline : bool, whether every call of the function by another kernel is replaced by its body, for the few short
        functions at the bottom of every loop: a call of a numba function costs as much as a polynomial, and LLVM by
        itself does not always spare it.
    allocates : bool, whether the function makes arrays, or assigns to them as a whole.  Without it no references are
        counted; numba counts those of constant tables too, which took a fifth of the time of a motion.

    Returns
    -------
    numba's dispatcher of the function, which is called like the function; without ``function``, a decorator that
    returns it.  Errors of compilation come with the first call; OSError is raised here if the sources of the kernels,
    of which the cache needs a hash, cannot be read.
    """
    if function is None:
        return lambda f: kernel(f, inline=inline, allocates=allocates)
    options = {"error_model": "numpy", "nogil": True, "forceinline": inline, "_nrt": allocates}
    dispatcher = numba.njit(function, pipeline_class=EntryPipeline, **options)
    dispatcher._cache = DiskCache(function)
    defer(dispatcher, options)
    _compile_exclusively(dispatcher)
    return dispatcher


def _compile_exclusively(dispatcher) -> None:
    """Let a kernel wait, before it compiles itself for a signature, while another process does that already.

    The code of the other process is then read from the disk instead of being compiled again.

    dispatcher : numba's dispatcher of the kernel, whose method ``compile`` is replaced; it waits for at most
        :data:`.cache.PATIENCE` seconds.
    Returns None.
    """
    plain = dispatcher.compile

    def compile_exclusively(signature):
        with dispatcher._cache.exclusive(signature, dispatcher.targetctx.codegen()):
            return plain(signature)

    dispatcher.compile = compile_exclusively


#: Decorator of short functions that are inlined wherever they are called: ``kernel(inline=True)``.
inline_kernel = kernel(inline=True)
