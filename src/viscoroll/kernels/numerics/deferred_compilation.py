"""LLVM runs once for each kernel that Python calls, not once for each function and each of its
callers.

numba optimises a function, links it into each of its callers, and optimises it there again, level
by level.  Here a kernel that another one calls, a *part*, is typed and lowered to LLVM's
intermediate representation (IR) only; a kernel called from Python, the *whole*, links the IR of all
parts below it, and LLVM works on that once.

This uses private names of numba.  If one of them fails, numba compiles in its own way: the same
kernels, the same bits, in some three times the time.
"""

import gc
import warnings
from contextlib import contextmanager
from functools import lru_cache
from typing import Any, Callable

import numba
from numba.core import base, types
from numba.core.compiler import Compiler

from .cache_folder import announce_compiling

#: Whether kernels are compiled in this way; False after a failure.
_deferring = True
#: Passes of numba that search a kernel for what kernels do not have: closures, overloads to be
#: inlined, expressions of whole arrays.
_NOT_NEEDED = (
    "InlineClosureLikes",
    "InlineInlinables",
    "InlineOverloads",
    "WithLift",
    "NopythonRewrites",
)


@contextmanager
def _memoized_types(typing, target):
    """Make numba remember, within a ``with`` block, results that it otherwise computes again for
    each statement.

    These are the types of operations on numbers and of fields, the sizes of LLVM's types, for each
    of which LLVM parses a module, and whether numba's own functions that lower a statement take its
    location.

    typing, target : numba's typing context and target context.  Methods of both are replaced within
        the block and restored when it ends, also by an exception.
    Yields None.  Within another block of this kind, where a kernel is compiled for another one,
    nothing is replaced.
    """
    if "resolve_function_type" in vars(typing):  # a kernel that is compiled for another one
        yield
        return
    resolved: dict[Any, Any] = {}
    plain = typing.resolve_function_type

    def resolve_function_type(function, args, kws):
        """Return numba's signature of a call; a call of the same function with the same types is
        resolved once.

        function : numba's type of the function, or the operator of Python, that is called.
        args : tuple of numba's types of the positional arguments.  Literals among them count as
            their types, unless all arguments are literals.
        kws : dict of numba's types of the named arguments.
        Returns what numba's own method returns.  That method is called each time, and nothing is
        remembered, if an argument is named or is not a float, an integer or a boolean.
        """
        if kws or not all(
            isinstance(kind, (types.Float, types.Integer, types.Boolean)) for kind in args
        ):
            return plain(function, args, kws)
        if not all(
            isinstance(kind, types.Literal) for kind in args
        ):  # numba resolves again for every literal integer
            args = tuple(map(types.unliteral, args))
        if (function, args) not in resolved:
            resolved[function, args] = plain(function, args, kws)
        return resolved[function, args]

    typing.resolve_function_type = resolve_function_type
    typing.resolve_getattr = lru_cache(maxsize=None)(typing.resolve_getattr)
    target.get_abi_sizeof = lru_cache(maxsize=None)(target.get_abi_sizeof)
    has_location = base._has_loc
    base._has_loc = lru_cache(maxsize=None)(base._has_loc)
    try:
        yield
    finally:
        del typing.resolve_function_type, typing.resolve_getattr, target.get_abi_sizeof
        base._has_loc = has_location


@contextmanager
def _without_garbage_collection():
    """Switch Python's garbage collection off within a ``with`` block, or leave it off if it is off
    already.

    numba makes millions of objects that live until the compilation ends; collecting took a tenth of
    its time.

    Yields None.  The state before the block is restored when it ends, also by an exception.
    """
    enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if enabled:
            gc.enable()


class EntryPipeline:
    """The compiler of kernels that Python calls, in the interface of numba's compiler classes.

    context : tuple of what numba passes to the constructor of a compiler: first its typing and
    target context.
    """

    def __init__(self, *context):
        self._context = context

    @_without_garbage_collection()
    def compile_extra(self, function: Callable):
        """Compile a kernel that Python calls as a whole, with the parts below it; by numba's own
        compiler if that fails.

        If it fails and numba's own compiler succeeds, a private name of numba has changed.  Then
        one RuntimeWarning is given, and numba's own compiler compiles all later kernels of the
        process too, without a further warning.  If both fail, the function itself cannot be
        compiled, and later kernels are compiled as before.

        function : the Python function, undecorated.
        Returns numba's ``CompileResult``.  Raises the error of numba's own compiler if that fails
        too.  The first call in a process prints a line on standard error
        (:func:`.cache_folder.announce_compiling`).
        """
        announce_compiling()
        global _deferring
        if not _deferring:
            return Compiler(*self._context).compile_extra(function)
        try:
            with _memoized_types(*self._context[:2]):
                return _pipelines()[1](*self._context).compile_extra(function)
        except Exception as error:
            reason = error
        _deferring = False
        try:
            compiled = Compiler(*self._context).compile_extra(function)
        except Exception:  # the error is that of the function
            _deferring = True
            raise
        text = f"{type(reason).__name__}: {' '.join(str(reason).split())}"
        warnings.warn(
            f"numba {numba.__version__} does not compile {function.__name__} with what it calls "
            f"({text}); "
            "kernels are compiled one by one, which takes longer",
            RuntimeWarning,
            stacklevel=2,
        )
        return compiled


def defer(whole, options: dict[str, Any]):
    """Let other kernels that call this one compile against its separately compiled part, instead of
    compiling it again.

    whole : numba's dispatcher of the kernel, whose methods get_call_template and get_overload, by
        which numba compiles a call from another kernel, are replaced.
    options : options of ``numba.njit`` by name, those of the kernel, for the part.
    Returns None.  The part is compiled when another kernel that calls this one is.  After a failure
    of this way of compiling (:meth:`EntryPipeline.compile_extra`) other kernels compile against
    ``whole`` itself, as numba does.
    """
    plain = type(whole)

    @lru_cache(maxsize=1)
    def part():
        """Return numba's dispatcher of the part, made once."""
        return numba.njit(
            whole.py_func,
            pipeline_class=_pipelines()[0],
            no_cpython_wrapper=True,
            no_cfunc_wrapper=True,
            **options,
        )

    def get_call_template(args, kws):
        """Return numba's template of a call of the part, or of ``whole`` after a failure.

        args, kws : tuple and dict of numba's types of positional and named arguments; literals
        count as their types.
        """
        # numba compiles again for every literal integer among the arguments
        args = tuple(map(types.unliteral, args))
        kws = {name: types.unliteral(kind) for name, kind in kws.items()}
        return plain.get_call_template(part() if _deferring else whole, args, kws)

    def get_overload(signature):
        return plain.get_overload(part() if _deferring else whole, signature)

    whole.get_call_template = get_call_template
    whole.get_overload = get_overload


@lru_cache(maxsize=1)
def _pipelines():
    """Make numba's compiler classes for the part of a kernel that others call and for the whole
    that Python calls.

    Parts are lowered to LLVM's intermediate representation only; wholes link that of all parts and
    are optimised once.

    Returns (compiler of parts, compiler of wholes), subclasses of numba's ``CompilerBase``, made
    once in a process.  They use private names of numba: if a version of numba lacks one,
    ImportError or AttributeError is raised.
    """
    from numba.core.codegen import JITCodeLibrary

    class Part(JITCodeLibrary):
        """A library of IR alone, for a kernel that other kernels call: it is neither optimised nor
        compiled to machine code.
        """

        is_part = True  # read by _link

        def finalize(self):
            self._finalized = True

        def get_pointer_to_function(self, name):
            return 1  # never called: Python calls the whole of the same function

        @property
        def codegen(self):
            return self

        def set_env(self, name, environment):
            """Do nothing: there is no code yet."""

        def add_llvm_module(self, module):
            """Take a module of LLVM over, which numba would link into an empty one; further ones
            are linked into it.

            module : the module, which belongs to the library from then on.  Returns nothing.
            """
            if next(iter(self._final_module.functions), None) is None:
                self._optimize_functions(module)
                self._final_module = module
            else:
                super().add_llvm_module(module)

        def _optimize_functions(self, module):
            """Optimise nothing: LLVM works on the whole alone."""
            module.data_layout = self._codegen._data_layout

        def _get_module_for_linking(self):
            """Return the IR with that of all parts below, for an ordinary jitted function between
            two kernels.
            """
            module = super()._get_module_for_linking().clone()
            _link(self, module)
            return module

    class Whole(JITCodeLibrary):
        """A library with the IR of all parts below, optimised and compiled together."""

        def finalize(self):
            """Link the IR of all called libraries into the module of LLVM, optimise it once, and
            turn it into machine code.

            Functions of the called libraries become internal, so that LLVM leaves out those that
            are not used.  Returns None.
            """
            module = self._final_module
            own = {function.name for function in module.functions if not function.is_declaration}
            _link(self, module)
            for (
                function
            ) in module.functions:  # nobody else calls the parts: LLVM leaves out what is not used
                if not function.is_declaration and function.name not in own:
                    function.linkage = "internal"
            self._linking_libraries = []
            super().finalize()

        def _optimize_final_module(self):
            """Optimise once: numba does it twice, to remove counts of references, which parts do
            not have.
            """
            manager, builder = self._codegen._module_pass_manager(opt=2)
            manager.run(self._final_module, builder)

        def _verify_declare_only_symbols(self):
            """Raise RuntimeError if a function that the module calls is missing, where LLVM would
            end the process.

            Names of numba's functions begin with _ZN; others, of the C library, may be missing
            here.  Returns nothing.
            """
            for function in self._final_module.functions:
                if function.is_declaration and function.name.startswith("_ZN"):
                    raise RuntimeError(
                        f"{self.name} calls {function.name}, which was not compiled with it"
                    )
            super()._verify_declare_only_symbols()

    return _pipeline(Part), _pipeline(Whole)


def _link(library, module):
    """Add to a module of LLVM the libraries that a library calls, directly or through parts, each
    once.

    library : numba's library, a Part or a Whole of :func:`_pipelines`.
    module : LLVM's module, into which copies of their modules are linked.
    Returns None.  The libraries that a Part calls are linked too; those that another library calls
    are not, because its own module contains them already.
    """
    from numba.core.codegen import JITCodeLibrary

    linked: list[Any] = []
    waiting = list(library._linking_libraries)
    while waiting:
        library = waiting.pop(0)
        if library not in linked:
            linked.append(library)
            # the module without what a part links by itself
            module.link_in(JITCodeLibrary._get_module_for_linking(library), preserve=True)
            waiting.extend(library._linking_libraries if hasattr(library, "is_part") else ())


def _pipeline(library_class: type):
    """Return a compiler class with numba's default passes but those of ``_NOT_NEEDED``, for one
    class of libraries.

    library_class : subclass of numba's ``JITCodeLibrary``, Part or Whole of :func:`_pipelines`: the
        library that the machine code, or the representation of LLVM, of each compiled function is
        put into.
    Returns a new subclass of numba's ``CompilerBase``.
    """
    from numba.core.compiler import CompilerBase, DefaultPassBuilder, Flags
    from numba.core.compiler_machinery import register_pass
    from numba.core.typed_passes import NativeLowering

    @register_pass(mutates_CFG=True, analysis_only=False)
    class Lowering(NativeLowering):
        """The pass of numba that lowers a kernel to LLVM, into a library of ``library_class``.

        numba reads the name of the pass from ``_name``; ``run_pass`` returns whether the state was
        changed.
        """

        _name = f"lowering into {library_class.__name__}"

        def run_pass(self, state):
            state.library = library_class(state.targetctx.codegen(), state.func_id.func_qualname)
            state.library.enable_object_caching()
            return super().run_pass(state)

    class ShortFlags(Flags):
        """Flags that are compared and hashed by those that are set; numba compares all forty at
        every call that it types.

        Other kinds of numba's flags are never equal to them.
        """

        def __hash__(self):
            return hash(frozenset(self._values))

        def __eq__(self, other):
            return isinstance(other, ShortFlags) and self._values == other._values

        def values(self):
            """Return the flags that are set, for the events of numba, to which nobody listens."""
            return self._values

    class Compiler(CompilerBase):
        """numba's default compiler in nopython mode, with :class:`ShortFlags`, without the passes
        of :data:`_NOT_NEEDED`.

        Its arguments are those of numba's ``CompilerBase``.  ``define_pipelines`` returns a list of
        one pass manager.
        """

        def __init__(self, typing, target, library, args, returns, flags, types_):
            super().__init__(typing, target, library, args, returns, ShortFlags(flags), types_)

        def define_pipelines(self):
            """Return a list of one pass manager: numba's, with :class:`Lowering` and without some
            passes.
            """
            passes = DefaultPassBuilder.define_nopython_pipeline(self.state)
            steps = [(step, why) for step, why in passes.passes if step.__name__ not in _NOT_NEEDED]
            passes.passes = [
                (Lowering if step is NativeLowering else step, why) for step, why in steps
            ]
            passes.finalize()
            return [passes]

    return Compiler
