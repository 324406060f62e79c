"""The decorator of all kernels, and the disk cache of their machine code.

:func:`kernel` is numba's compilation, deferred (:mod:`.deferred_compilation`) and cached on disk
(:class:`DiskCache`) so that stored code cannot go stale.

numba's own cache stamps a function with the file it is defined in and does not notice a change in a
function it calls from another module.  Here the cache folder is named after a hash of *all* kernel
sources, their coefficient table and the versions of numba and llvmlite (:func:`sources_digest`).
It holds one file for each function, signature and choice of numba's settings, which begins with a
SHA-256 of what follows.  Anything unreadable, or that others may have written
(:mod:`.cache_folder`), is compiled again and replaced: it is never trusted and never ends the
process.
"""

import hashlib
import pickle
import sys
import warnings
import zlib
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from functools import lru_cache
from os.path import exists
from pathlib import Path
from typing import Callable

import llvmlite
import numba
from numba.core.compiler import CompileResult
from numba.core.serialize import dumps

from .cache_folder import cache_root, make_private_folder, read_private, write_private
from .deferred_compilation import EntryPipeline, defer

# --- A disk cache of machine code that cannot go stale ---

#: Folder of all kernels.
KERNELS = Path(__file__).parents[1]
#: Settings of numba (environment: NUMBA_...) on which its machine code depends, beside those of the
#: processor.
_SETTINGS = [
    "BOUNDSCHECK",
    "OPT",
    "LOOP_VECTORIZE",
    "SLP_VECTORIZE",
    "DISABLE_INTEL_SVML",
    "DEBUGINFO_DEFAULT",
    "EXTEND_VARIABLE_LIFETIMES",
    "ENABLE_PROFILING",
    "NRT_STATS",
    "DEBUG_NRT",
    "LLVM_REFPRUNE_PASS",
    "LLVM_REFPRUNE_FLAGS",
]
#: Seconds after which a process no longer waits for another one to compile: more than a kernel
#: takes on a busy machine.
PATIENCE = 120.0
#: Bytes of the checksum in front of a file.
_DIGEST_SIZE = hashlib.sha256().digest_size


@lru_cache(maxsize=1)
def sources_digest() -> str:
    """Return a hash of the kernel sources, of their coefficients and of the versions of numba and
    llvmlite.

    It covers the names and all bytes of the files ``*.py`` and ``*.npy`` in and below
    :data:`KERNELS`, comments included, and is computed once in a process.
    Returns a str of 16 hexadecimal digits.  Raises OSError if one of the files cannot be read.
    """
    digest = hashlib.sha256(f"{numba.__version__} {llvmlite.__version__}".encode())
    # sorted, as the order of a folder is that of the file system; names, so that a file that moves
    # counts as another one
    for path in sorted((*KERNELS.rglob("*.py"), *KERNELS.rglob("*.npy"))):
        digest.update(path.relative_to(KERNELS).as_posix().encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()[:16]


@lru_cache(maxsize=2)
def warn_once(trouble: str) -> None:
    """Give a RuntimeWarning of a problem with the cache; not again if it is one of the last two
    that were warned of.

    trouble : str, the first part of the message, which says what is wrong.
    Returns None.  Where warnings are turned into errors it raises RuntimeWarning.
    """
    warnings.warn(f"{trouble}; kernels are compiled anew instead", RuntimeWarning, stacklevel=2)


class DiskCache:
    """The machine code of one function on disk, in the interface of the caches of numba's
    dispatchers.

    function : the Python function.  Its code is in the folder ``cache_path``, a str, which may not
    exist yet.
    """

    def __init__(self, function: Callable) -> None:
        self._function = function
        self._folder = cache_root() / f"kernels-{sources_digest()}"
        self.cache_path = str(self._folder)

    @contextmanager
    def exclusive(self, signature, codegen) -> Iterator[None]:
        """Make other processes wait for the machine code that this one will store, at most
        :data:`PATIENCE` seconds.

        Within the ``with`` block this process holds a lock, a file beside that of the code, which
        is removed when the block ends.  If another process holds it, this one waits in front of the
        block, for at most the same time.  The block runs without a lock if the code is stored
        already, if the lock cannot be made, or if the time is over.

        signature : tuple of numba's types of the arguments of the kernel.
        codegen : numba's code generator, which knows the processor.
        Yields None.  Raises the exceptions of the block.
        """
        path = self._path(signature, codegen)
        if exists(path):  # False too where the folder cannot be searched, unlike path.exists()
            yield
            return
        from filelock import FileLock

        lock = FileLock(f"{path}.lock", timeout=PATIENCE)
        with suppress(OSError):  # also when the time is over
            make_private_folder(path.parent)
            lock.acquire()
        try:
            yield
        finally:
            # only the process that holds the lock removes its file, and before it lets go
            if lock.is_locked:
                Path(lock.lock_file).unlink(missing_ok=True)
            lock.release()

    def load_overload(self, signature, target) -> CompileResult | None:
        """Return the stored machine code for a signature, or None if there is none that can be
        used.

        signature : tuple of numba's types of the arguments of the kernel.
        target : numba's target context, which the code is linked into; it is refreshed in any case.
        Returns numba's ``CompileResult``.  None without a warning if the file does not exist,
        cannot be read, or may have been written by others; None with a RuntimeWarning
        (:func:`warn_once`) if its checksum is wrong or numba cannot rebuild the code from it.
        """
        target.refresh()  # numba's own cache does so before it rebuilds code
        try:
            stored = read_private(self._path(signature, target.codegen()))
        except OSError:  # it does not exist, cannot be read or is not ours alone: saving will warn
            return None
        digest = stored[:_DIGEST_SIZE]
        content = stored[_DIGEST_SIZE:]
        if hashlib.sha256(content).digest() == digest:
            with suppress(Exception):  # it was written by another numba of the same version
                return CompileResult._rebuild(target, *pickle.loads(zlib.decompress(content)))
        warn_once(f"the cache of compiled kernels is damaged ({self._folder})")
        return None  # save_overload then replaces the file

    def save_overload(self, signature, compiled: CompileResult) -> None:
        """Store machine code for a signature, unless it contains addresses of this process.

        signature : tuple of numba's types of the arguments of the kernel; a hash of their text is
            part of the name of the file.
        compiled : numba's ``CompileResult``; one with addresses of this process
            (``has_dynamic_globals``) is not stored, without a warning.
        Returns None.  A file that cannot be written causes a RuntimeWarning (:func:`warn_once`),
        not an error.
        """
        if compiled.library.has_dynamic_globals:
            return
        # level 1, the fastest; the checksum of the compressed code is in front of it
        content = zlib.compress(dumps(compiled._reduce()), 1)
        try:
            write_private(
                self._path(signature, compiled.codegen), hashlib.sha256(content).digest() + content
            )
        except OSError as error:
            warn_once(f"compiled kernels are not cached ({self._folder}: {error.strerror})")

    def flush(self) -> None:
        """Do nothing: ``recompile`` of numba's dispatcher calls this, and no code is kept in
        memory.
        """

    def _path(self, signature, codegen) -> Path:
        """Return the path of the machine code: the name of the function, and a hash of all that the
        code depends on.

        That is the name and place of the function, the signature, the processor, the version of
        Python and numba's settings; the sources are in the name of the folder.

        signature : tuple of numba's types of the arguments of the kernel.
        codegen : numba's code generator, which knows the processor.
        Returns the path of a file that may not exist.
        """
        function = self._function
        name = f"{function.__module__}.{function.__qualname__}"
        # None for a setting that this version of numba does not have; the line below tells
        # functions of one name apart
        settings = [str(getattr(numba.config, setting, None)) for setting in _SETTINGS]
        key = (
            name,
            function.__code__.co_firstlineno,
            str(signature),
            codegen.magic_tuple(),
            sys.version_info[:2],
        )
        digest = hashlib.sha256(repr((*key, settings)).encode()).hexdigest()[:16]
        return (
            self._folder
            / f"{function.__module__.rpartition('kernels.')[2]}.{function.__name__}-{digest}.nbc"
        )


# --- One decorator, kernel ---

if numba.config.DISABLE_JIT:
    raise ImportError("NUMBA_DISABLE_JIT = 1: must be 0, the kernels of viscoroll are machine code")


def kernel(
    function: Callable | None = None, *, inline: bool = False, allocates: bool = False
) -> Callable:
    """Compile a function with numba, when it is first called, and keep the machine code on disk.

    LLVM is granted no numerical freedom: a result then depends on the source alone, not on what was
    compiled together (see :mod:`.intrinsics`).  In a kernel a division by zero gives inf or NaN as
    in numpy, and indices of arrays are not checked; the GIL is released.

    Parameters
    ----------
    function : the function; None, for a decorator with the other arguments.
    inline : bool, whether every call of the function by another kernel is replaced by its body, for
        the few short functions at the bottom of every loop: a call of a numba function costs as
        much as a polynomial, and LLVM by itself does not always spare it.
    allocates : bool, whether the function makes arrays, or assigns to them as a whole.  Without it
        no references are counted; numba counts those of constant tables too, which took a fifth of
        the time of a motion.

    Returns
    -------
    numba's dispatcher of the function, which is called like the function; without ``function``, a
    decorator that returns it.  Errors of compilation come with the first call; OSError is raised
    here if the sources of the kernels, of which the cache needs a hash, cannot be read.
    """
    if function is None:
        return lambda f: kernel(f, inline=inline, allocates=allocates)
    options = {"error_model": "numpy", "nogil": True, "forceinline": inline, "_nrt": allocates}
    dispatcher = numba.njit(function, pipeline_class=EntryPipeline, **options)
    # in place of ``cache=True``, whose cache is numba's own (the module says why not)
    dispatcher._cache = DiskCache(function)
    defer(dispatcher, options)
    _compile_exclusively(dispatcher)
    return dispatcher


def _compile_exclusively(dispatcher) -> None:
    """Let a kernel wait, before it compiles itself for a signature, while another process does that
    already.

    The code of the other process is then read from the disk instead of being compiled again.

    dispatcher : numba's dispatcher of the kernel, whose method ``compile`` is replaced; it waits
        for at most :data:`PATIENCE` seconds.
    Returns None.
    """
    plain = dispatcher.compile

    def compile_exclusively(signature):
        with dispatcher._cache.exclusive(signature, dispatcher.targetctx.codegen()):
            return plain(signature)

    dispatcher.compile = compile_exclusively


#: Decorator of short functions that are inlined wherever they are called: ``kernel(inline=True)``.
inline_kernel = kernel(inline=True)
