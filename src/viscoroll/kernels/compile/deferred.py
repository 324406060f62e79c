"""LLVM once for each call from Python, not once for each function and all those above it.

numba optimises a function, links it into each of its callers, and optimises it there again, level
by level.  Here a kernel that another one calls, a *part*, is typed and lowered to LLVM's intermediate
representation (IR) only; a kernel called from Python, the *whole*, links the IR of all parts below it,
and LLVM works on that once.

This leans on names inside numba.  Where one of them fails, numba compiles in its own way: the same
kernels, the same bits, some three times the time.
"""

from __future__ import annotations

import gc
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from functools import lru_cache
from typing import Any, Callable

import numba
from numba.core import types
from numba.core.compiler import Compiler

from .notice import announce_compiling

_deferring = True
#: passes of numba that look through all of a kernel for what kernels do not have: closures, overloads to be inlined
_NOT_NEEDED = ("InlineClosureLikes", "InlineInlinables", "InlineOverloads", "WithLift")


class EntryPipeline:
    """What numba calls to compile a kernel that Python calls."""

    def __init__(self, *given: Any) -> None:
        self._given = given

    def compile_extra(self, function: Callable) -> Any:
        """What numba makes of the function."""
        announce_compiling()
        with _garbage_kept():
            return self._compiled(function)

    def _compiled(self, function: Callable) -> Any:
        """The one guard of the names inside numba."""
        global _deferring
        if not _deferring:
            return Compiler(*self._given).compile_extra(function)
        try:
            with _types_kept(self._given[0]):
                return _pipelines()[1](*self._given).compile_extra(function)
        except Exception as error:
            reason = error
        _deferring = False
        try:
            compiled = Compiler(*self._given).compile_extra(function)
        except Exception:  # numba was right
            _deferring = True
            raise
        told = f"{type(reason).__name__}: {' '.join(str(reason).split())}"
        warnings.warn(
            f"numba {numba.__version__} does not compile {function.__name__} with what it calls ({told}); "
            "kernels are compiled one by one, which takes longer",
            RuntimeWarning,
            stacklevel=2,
        )
        return compiled


@contextmanager
def _types_kept(typing: Any) -> Iterator[None]:
    """numba asks every candidate anew at each sum of two floats: here the first answer is kept."""
    if "resolve_function_type" in vars(typing):  # compiled for a function that is being compiled
        yield
        return
    known: dict[Any, Any] = {}
    plain = typing.resolve_function_type

    def resolve_function_type(function: Any, given: tuple, named: dict[str, Any]) -> Any:
        if named or not all(isinstance(kind, (types.Float, types.Integer, types.Boolean)) for kind in given):
            return plain(function, given, named)
        if (function, given) not in known:
            known[function, given] = plain(function, given, named)
        return known[function, given]

    typing.resolve_function_type = resolve_function_type
    try:
        yield
    finally:
        del typing.resolve_function_type


@contextmanager
def _garbage_kept() -> Iterator[None]:
    """numba makes millions of small objects that live until it is done: to look for dead ones takes a tenth."""
    collects = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if collects:
            gc.enable()


def defer(whole: Any, options: dict[str, Any]) -> None:
    """Let other kernels that call this one see its part."""
    plain = type(whole)

    @lru_cache(maxsize=1)
    def part() -> Any:
        return numba.njit(
            whole.py_func, pipeline_class=_pipelines()[0], no_cpython_wrapper=True, no_cfunc_wrapper=True, **options
        )

    def get_call_template(given: tuple, named: dict[str, Any]) -> Any:
        # numba compiles anew for every literal integer among the arguments
        given = tuple(map(types.unliteral, given))
        named = {name: types.unliteral(kind) for name, kind in named.items()}
        return plain.get_call_template(part() if _deferring else whole, given, named)

    def get_overload(signature: Any) -> Any:
        return plain.get_overload(part() if _deferring else whole, signature)

    whole.get_call_template, whole.get_overload = get_call_template, get_overload


@lru_cache(maxsize=1)
def _pipelines() -> tuple[type, type]:
    """numba's pipelines for parts and for wholes."""
    from numba.core.codegen import JITCodeLibrary

    class Part(JITCodeLibrary):
        """IR alone."""

        is_part = True

        def finalize(self) -> None:
            self._finalized = True

        def get_pointer_to_function(self, name: str) -> int:
            return 1  # never called: the whole of the same function is what Python calls

        @property
        def codegen(self) -> Part:
            return self

        def set_env(self, name: str, environment: Any) -> None:
            """Nothing to set before there is code."""

        def _optimize_functions(self, module: Any) -> None:
            """Nothing: LLVM works on the whole alone."""
            module.data_layout = self._codegen._data_layout

        def _get_module_for_linking(self) -> Any:
            """For an ordinary jitted function between two kernels, which LLVM compiles by itself: all below."""
            module = super()._get_module_for_linking().clone()
            _link(self, module)
            return module

    class Whole(JITCodeLibrary):
        """IR of all parts below, optimised and compiled together."""

        def finalize(self) -> None:
            module = self._final_module
            own = {function.name for function in module.functions if not function.is_declaration}
            _link(self, module)
            for function in module.functions:  # nobody else calls the parts: what they are not asked for is left out
                if not function.is_declaration and function.name not in own:
                    function.linkage = "internal"
            self._linking_libraries = []
            super().finalize()

        def _optimize_final_module(self) -> None:
            """Once: numba works twice through a module, to find references to leave out, which parts do not count."""
            manager, builder = self._codegen._module_pass_manager(opt=2)
            manager.run(self._final_module, builder)

        def _verify_declare_only_symbols(self) -> None:
            """What is missing ends the process when LLVM links; _ZN begins the names of all that numba compiles."""
            for function in self._final_module.functions:
                if function.is_declaration and function.name.startswith("_ZN"):
                    raise RuntimeError(f"{self.name} calls {function.name}, which was not compiled with it")
            super()._verify_declare_only_symbols()

    return _pipeline(Part), _pipeline(Whole)


def _link(library: Any, module: Any) -> None:
    """Put into a module what this library and the parts below it call, each library once."""
    from numba.core.codegen import JITCodeLibrary

    known, ahead = [], list(library._linking_libraries)
    while ahead:
        library = ahead.pop(0)
        if library not in known:
            known.append(library)
            # without what a part links by itself
            module.link_in(JITCodeLibrary._get_module_for_linking(library), preserve=True)
            ahead.extend(library._linking_libraries if hasattr(library, "is_part") else ())


def _pipeline(library_class: type) -> type:
    """numba's default pipeline, lowering into this class of library."""
    from numba.core.compiler import CompilerBase, DefaultPassBuilder, Flags
    from numba.core.compiler_machinery import register_pass
    from numba.core.typed_passes import NativeLowering

    @register_pass(mutates_CFG=True, analysis_only=False)
    class Lowering(NativeLowering):
        _name = f"lowering into {library_class.__name__}"

        def run_pass(self, state: Any) -> bool:
            state.library = library_class(state.targetctx.codegen(), state.func_id.func_qualname)
            state.library.enable_object_caching()
            return super().run_pass(state)

    class ShortFlags(Flags):
        """numba looks its flags up at every call that it types, all forty of them: here those that are set."""

        def __hash__(self) -> int:
            return hash(frozenset(self._values))

        def __eq__(self, other: object) -> bool:
            return isinstance(other, ShortFlags) and self._values == other._values

    class Compiler(CompilerBase):
        def __init__(self, typing: Any, target: Any, library: Any, args: tuple, returns: Any, flags: Any, known: dict):
            super().__init__(typing, target, library, args, returns, ShortFlags(flags), known)

        def define_pipelines(self) -> list[Any]:
            passes = DefaultPassBuilder.define_nopython_pipeline(self.state)
            steps = [(step, why) for step, why in passes.passes if step.__name__ not in _NOT_NEEDED]
            passes.passes = [(Lowering if step is NativeLowering else step, why) for step, why in steps]
            passes.finalize()
            return [passes]

    return Compiler
