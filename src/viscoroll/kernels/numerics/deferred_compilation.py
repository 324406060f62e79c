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
from contextlib import ExitStack, contextmanager, nullcontext
from functools import lru_cache
from typing import Any, Callable
from unittest import mock

import numba
from numba.core import base, event, ir, lowering, typeinfer, types
from numba.core.compiler import Compiler

from .cache_folder import announce_compiling

#: Whether kernels are compiled in this way; False after a failure.
_deferring = True
#: Types of arguments of which the signature of a call is remembered; numba's ``Omitted`` are
#: constants.
_OF_NUMBERS = frozenset(
    (
        types.Float,
        types.Integer,
        types.Boolean,
        types.IntegerLiteral,
        types.BooleanLiteral,
        types.Omitted,
    )
)
#: numba's signatures of calls with such arguments, by function and types.  Some, as of ``min``,
#: stand for a function that numba compiles: it is compiled once in a process, not in each whole.
_signatures: dict[Any, Any] = {}
#: Values of numba's statements that contain variables; those of its class Inst alone have methods.
_WITH_VARIABLES = (ir.Inst, list, tuple, dict)
#: Passes of numba that search a kernel for what kernels do not have: closures, overloads to be
#: inlined, expressions of whole arrays.
_NOT_NEEDED = (
    "InlineClosureLikes",
    "InlineInlinables",
    "InlineOverloads",
    "WithLifting",
    "NopythonRewrites",
)


@contextmanager
def _shorter_front_end(typing, target):
    """Make numba type and lower kernels with less work within a ``with`` block, with the same
    result.

    Remembered are the types of operations on numbers and of fields, the sizes of LLVM's types, for
    each of which LLVM parses a module, and whether numba's own functions that lower a statement
    take its location: numba finds them again for each statement.  Left out are where variables live
    between two passes, the imports by which numba looks for new functions, the place in the source
    that numba adds to its errors (after an error numba's own compiler compiles the function again,
    see :class:`EntryPipeline`) and the timers that numba starts for each function.

    typing, target : numba's typing context and target context.
    Yields None.  All replaced functions are restored when the block ends, also by an exception.
    Within another block of this kind, where a kernel is compiled for another one, nothing is
    replaced.
    """
    if "resolve_getattr" in vars(typing):  # a kernel that is compiled for another one
        yield
        return
    from numba.core.postproc import PostProcessor, VariableLifetime
    from numba.core.transforms import canonicalize_cfg

    plain = types.Function.get_call_type
    every = PostProcessor.run

    def get_call_type(function, context, args, kws):
        """Return numba's signature of a call; a call of the same function with numbers of the same
        types is resolved once in a process.

        function : numba's type of the function or operator that is called.
        context : numba's typing context.
        args, kws : tuple and dict of numba's types of positional and named arguments.
        """
        if kws or not _OF_NUMBERS.issuperset(map(type, args)):
            return plain(function, context, args, kws)
        if (function, args) not in _signatures:
            _signatures[function, args] = plain(function, context, args, kws)
        return _signatures[function, args]

    def process(processor, emit_dels=False, extend_lifetimes=False):
        """Bring the blocks of a kernel into numba's canonical order, after a pass has changed them.

        numba computes after each pass where each variable lives.  Only what follows the last pass
        reads that, and asks for it by ``emit_dels``.

        processor : numba's PostProcessor, of the kernel ``func_ir``.
        emit_dels : whether numba marks the end of each variable.
        extend_lifetimes : whether it does so as late as possible.
        """
        if emit_dels or processor.func_ir.is_generator:
            return every(processor, emit_dels, extend_lifetimes)
        kernel = processor.func_ir
        kernel.blocks = canonicalize_cfg(kernel.blocks)
        kernel.variable_lifetime = VariableLifetime(kernel.blocks)
        kernel.generator_info = None

    def without_context(*text, **named):
        return nullcontext()

    def without_effect():
        pass

    def install_registries():
        """Make what was registered since the last time known to the target context, as numba does,
        without importing numba's modules again, all of which are imported already.
        """
        for registry in tuple(target._registries):
            target.install_registry(registry)

    once = lru_cache(maxsize=None)
    target.refresh()  # imports all modules of numba that register functions
    with ExitStack() as replaced:
        for owner, name, function in (
            (types.Function, "get_call_type", get_call_type),
            (PostProcessor, "run", process),
            (typing, "load_additional_registries", without_effect),
            (target, "load_additional_registries", install_registries),
            (typing, "resolve_getattr", once(typing.resolve_getattr)),
            (target, "get_abi_sizeof", once(target.get_abi_sizeof)),
            (base, "_has_loc", once(base._has_loc)),
            (ir.Inst, "_rec_list_vars", _variables_in),
            (lowering, "new_error_context", without_context),
            (typeinfer, "new_error_context", without_context),
            (event, "install_timer", without_context),
        ):
            replaced.enter_context(mock.patch.object(owner, name, function))
        yield


def _variables_in(statement, value):
    """Return the variables of numba in a value of a statement, in numba's own order.

    numba's own function asks of every value, most of which are names and places in the source,
    whether it is of any of six classes.

    statement : numba's statement; not used.
    value : a variable, an instruction, a list, tuple or dict of values, or something else, which
        contains no variable.
    """
    kind = type(value)
    if kind is dict:
        value = value.values()
    elif kind is not list and kind is not tuple:
        if isinstance(value, ir.Inst):
            return value.list_vars()
        value = (value,)
    found = []
    for part in value:
        kind = type(part)
        if kind is ir.Var:
            found.append(part)
        elif isinstance(part, _WITH_VARIABLES):
            found.extend(_variables_in(statement, part))
    return found


@contextmanager
def _without_garbage_collection():
    """Switch Python's garbage collection off within a ``with`` block, or leave it off if it is off
    already.

    numba makes millions of objects that live until the compilation ends; collecting took a tenth of
    its time.  At the end all objects are put into the oldest generation, which Python collects
    seldom: the next collection would go through all of them.

    Yields None.  The state before the block is restored when it ends, also by an exception.
    """
    enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if not gc.get_freeze_count():  # else unfreezing would change what the user has frozen
            gc.freeze()
            gc.unfreeze()
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
            with _shorter_front_end(*self._context[:2]):
                return _pipelines()[1](*self._context).compile_extra(function)
        except Exception as error:
            reason = error  # ``error`` ends with the except clause
        # read by :func:`defer` too: called kernels are then compiled in numba's way
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
            # empty: no function yet
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
            # nobody else calls the parts: LLVM leaves out what is not used
            for function in module.functions:
                if not function.is_declaration and function.name not in own:
                    function.linkage = "internal"
            self._linking_libraries = []  # all are linked already; numba would link them again
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
            # a declaration that is left has no body in any of the linked libraries
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
        if library not in linked:  # a function that is linked twice would be defined twice
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
    from numba.core.compiler_machinery import PassManager, register_pass
    from numba.core.typed_passes import IRLegalization, NativeLowering

    class Lower(lowering.Lower):
        """numba's lowering of statements to LLVM.  Where no references are counted it does not load
        the old value of a variable, which it would give back, nor overwrite it at its end.
        """

        def delvar(self, name):
            """Do what numba does at the end of a variable: nothing where no references are counted.

            name : the name of the variable, a str.
            """
            if self.context.enable_nrt:
                super().delvar(name)

        def storevar(self, value, name, argidx=None):
            """Store a value into a variable.

            value : the value, of LLVM.  name : the name of the variable, a str.
            argidx : index of the argument of the kernel that is stored, or None.
            """
            if self.context.enable_nrt or name in self._singly_assigned_vars:
                super().storevar(value, name, argidx)
            else:
                self._alloca_var(name, self.typeof(name))
                self.builder.store(value, self.getvar(name))

    @register_pass(mutates_CFG=True, analysis_only=False)
    class Lowering(NativeLowering):
        """The pass of numba that lowers a kernel to LLVM, into a library of ``library_class``.

        numba reads the name of the pass from ``_name``; ``run_pass`` returns whether the state was
        changed.
        """

        _name = f"lowering into {library_class.__name__}"

        @property
        def lowering_class(self):
            return Lower

        def run_pass(self, state):
            # numba makes a library where there is none yet, and enables the same for its cache
            state.library = library_class(state.targetctx.codegen(), state.func_id.func_qualname)
            state.library.enable_object_caching()
            return super().run_pass(state)

    class ShortFlags(Flags):
        """Flags that are compared and hashed by those that are set; numba compares all forty at
        every call that it types.

        Other kinds of numba's flags are never equal to them.
        """

        # ``_values``, private to numba: the flags that are set, by name
        def __hash__(self):
            return hash(frozenset(self._values))

        def __eq__(self, other):
            return isinstance(other, ShortFlags) and self._values == other._values

        def values(self):
            """Return the flags that are set, for the events of numba, to which nobody listens."""
            return self._values

    class Passes(PassManager):
        """numba's list of passes, without its search for faults of each pass, its times and its
        events.
        """

        def _runPass(self, index, step, state):
            """Run one pass.

            index : place of the pass in the list; not used.
            step : the pass.
            state : numba's state of the compilation, which the pass changes.
            """
            step.analysis = self._analysis
            step.run_initialization(state)
            step.run_pass(state)
            step.run_finalizer(state)

    lists: dict[bool, Passes] = {}

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
            passes; made once for kernels that allocate and once for the others.
            """
            # passes are named by their classes; ``why`` is numba's description of each
            counting = self.state.flags.nrt  # whether numba counts references
            if counting not in lists:
                passes = Passes("nopython")
                passes.passes = [
                    (Lowering if step is NativeLowering else step, why)
                    for step, why in DefaultPassBuilder.define_nopython_pipeline(self.state).passes
                    if step.__name__ not in _NOT_NEEDED
                    # it writes where a variable ends, for the counts of references alone
                    and (counting or step is not IRLegalization)
                ]
                passes.finalize()
                lists[counting] = passes
            return [lists[counting]]

    return Compiler
