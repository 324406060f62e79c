"""The program ``viscoroll``: arguments -> one call of the library -> text, CSV or netCDF.

This file has the parser, the exit codes (0 success, 1 a check failed, 2 an error, printed in one
line), and the commands of the installation:

- ``viscoroll samples`` copies the sample files of the documentation into a folder of the user.
- ``viscoroll warmup`` compiles all kernels into the cache.
- ``viscoroll doctor`` prints the contents of a problem report.

:mod:`.arguments` has what all commands share: numbers, ranges, scenes, formats.  The other files
have a group of commands each: each command is a function.
"""

import argparse
import gc
import inspect
import io
import os
import platform
import re
import sys
import time
import warnings
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from importlib import metadata
from pathlib import Path
from typing import Any, NoReturn, TextIO

import viscoroll as vr

from ..core import Interrupted, ViscorollError
from .arguments import COMMANDS, command, option

# each of these modules adds its commands to the table, in this order
from . import motion_commands, file_commands  # noqa: F401  # isort: skip

# --- viscoroll samples ---


@command(
    "samples",
    option(
        "folder",
        metavar="FOLDER",
        nargs="?",
        default="samples",
        help="folder for the files (default: samples)",
    ),
)
def samples(arguments: argparse.Namespace) -> None:
    """Copy the sample files of the documentation into a folder.

    They are scene files, run files and measurements, which the examples of other commands read.

    example:
      viscoroll samples
      viscoroll contact samples/rubber.toml --V 0.5 --delta 0.01

    arguments: parsed command line with folder, path of the folder, which is made if it does not
        exist; "samples" if not given.
    Returns None; a path is printed on each line, in the order of their names, also of files that
    were there already.
    Raises FileError for a file there of the same name with other content, before any is written,
    and where the folder cannot be written to.
    """
    for file in vr.datasets.copy_files(arguments.folder):
        print(file)


# --- viscoroll warmup ---


@command("warmup")
def warm_up(arguments: argparse.Namespace) -> None:
    """Compile all functions in advance, so that the first calls do not wait.

    The compiled functions go into the cache, once for each machine and version of the package.  If they are there
    already, the command takes some seconds.

    example:
      viscoroll warmup

    arguments: parsed command line, not used.
    Returns None, exit code 0.

    A line with the number of calls, the folder of the cache and the time in s is printed at the
    end.  Kernels that the cache has are loaded only.  A cache that cannot be written causes a
    RuntimeWarning, and the line all the same.
    """  # noqa: E501
    from tqdm import tqdm

    from ..kernels.numerics import cache_folder

    cache_folder.announced = True  # the bar takes the place of the notice
    start = time.perf_counter()
    calls = _calls()
    bar = tqdm(calls.items(), leave=False, disable=None)  # drawn on a terminal alone
    for count, (name, call) in enumerate(bar):
        bar.set_description(name)
        if count % 6 == 5:  # the compiler leaves some 30 MB a call behind; collecting takes 0.7 s
            gc.collect()
        call()
    done = f"{len(calls)} kinds of calls (this took {time.perf_counter() - start:.1f} s)"
    print(f"functions are compiled for {done}; cache folder: {cache_folder.cache_root()}")


def _calls() -> dict[str, Callable[[], Any]]:
    """Return small calls that together use all kernels.

    Motions use the kernels of contacts, and all motions have one integrator.  Half-spaces, lists of
    alphas and of series, and layers have kernels of their own.

    Returns a dict, name for the progress bar -> function without arguments, whose result is not
    used; each makes its call when it is called, and nothing is written but the cache.
    """
    from ..contact_mechanics import coupled_law
    from ..motion import flow

    scene = vr.presets.PAPER_SECTION_5
    modes = vr.Prony([1.0, 2.0], [1.0, 0.1])
    series = vr.Scene(material=modes, kappa=2.91, mu=0.2, gamma=1.0)
    many = series.replace(material=vr.Prony([[1.0, 2.0], [2.0, 1.0]], [1.0, 0.1]))
    covered = series.replace(material=vr.Cover(modes, nu=0.5, thickness=1.0))
    fast = covered.replace(coupled=False)
    thick = fast.replace(material=vr.Cover(1.0, nu=0.5, thickness=[1.0, 1.5]))
    state = partial(vr.contact, V=0.5, delta=0.01)
    return {
        # build_map computes a map; ensemble might find one on disk
        "motions and flow maps": lambda: flow.build_map(
            (scene.alpha, scene.kappa, scene.mu, scene.j), 1
        ),
        "contact by root solves": lambda: state(scene, method="direct"),
        "contact with an array of alpha": lambda: state(vr.Scene([3.0, 4.0], 2.91, 0.2)),
        "contact with an array of Prony series": lambda: state(many),
        "unsteady rolling": lambda: state(series, fields="N"),
        "bound law": lambda: vr.law(scene),
        # a table of few nodes, also where that of the scene is on disk
        "table of the coupled solution": lambda: coupled_law(covered, nodes=(4, 9)),
        "contact on a cover": lambda: state(covered),
        "motions on a cover": lambda: vr.roll(covered, 0.5, 0.5, 0.1),
        "steady rolling on a cover": lambda: vr.steady(covered, force=0.01),
        "bound law of a cover": lambda: vr.law(covered),
        "fast law of a cover": lambda: state(fast),
        "motions by the fast law": lambda: vr.roll(fast, 0.5, 0.5, 0.1),
        "contact with an array of thicknesses": lambda: state(thick),
        "steady rolling": lambda: vr.steady(scene, force=0.01),
        "stress": lambda: vr.stress(scene, 0.5, 0.5, delta=0.01),
    }


# --- viscoroll doctor ---

#: Extra of the package -> the library that it installs.
_EXTRAS = {"runs": "zarr", "cluster": "distributed"}


@command("doctor")
def doctor(arguments: argparse.Namespace) -> int:
    """Report versions, cache, threads, compiled functions and missing packages.

    Send this output with a report of a problem.  The exit code is 1 if a required package is missing.

    example:
      viscoroll doctor

    arguments: parsed command line, not used.
    Returns True, exit code 1, if a required package or llvmlite is missing, else False, exit code
    0; a faulty cache and missing optional libraries are only printed.  Of a viscoroll that is not
    installed as a package, whose requirements are not known, llvmlite alone is examined.
    Raises ParameterError for a wrong $VISCOROLL_THREADS.
    """  # noqa: E501
    required = (_version("viscoroll") and metadata.requires("viscoroll")) or ()
    names = [
        # the name before the version, as of "numpy>=2.0"
        re.split(r"[^\w-]", requirement)[0]
        for requirement in required
        if "extra ==" not in requirement
    ]
    versions = {name: _version(name) for name in (*names, "llvmlite")}
    for name, value in _lines():
        print(f"{name:<12} {value}")
    print(
        "packages    ",
        ", ".join(f"{name} {version or 'MISSING'}" for name, version in versions.items()),
    )
    return None in versions.values()


def _lines() -> Iterator[tuple[str, str]]:
    """Yield (name, text) of each line of the problem report but the last, which :func:`doctor`
    prints.

    They are: "viscoroll", version and folder of the package; "python", version and program;
    "system"; "[runs]" and "[cluster]", version of the optional library, or how it is installed;
    "threads", their number and where it is from; "cache", folder of compiled functions, their
    number and size in MB, and its faults (:func:`_fault_of_cache`); "check", a call
    (:func:`_check`).
    Raises ParameterError for a wrong $VISCOROLL_THREADS.
    """
    from ..core.arrays import thread_count
    from ..kernels.numerics.cache_folder import cache_root
    from ..kernels.numerics.jit import sources_digest

    yield "viscoroll", f"{vr.__version__}, in {Path(__file__).parents[2]}"
    yield "python", f"{platform.python_version()} ({sys.executable})"
    yield "system", f"{platform.system()} {platform.release()}, {platform.machine()}"
    for extra, name in _EXTRAS.items():
        version = _version(name)
        yield (
            f"[{extra}]",
            f"{name} {version}"
            if version
            else f"{name} is not installed: pip install 'viscoroll[{extra}]'",
        )
    source = "VISCOROLL_THREADS" if os.environ.get("VISCOROLL_THREADS") else "the cores available"
    yield "threads", f"{thread_count(None)} ({source})"
    folder = cache_root() / f"kernels-{sources_digest()}"
    sizes = [path.stat().st_size for path in folder.glob("*") if path.is_file()]
    state = (
        f"{len(sizes)} compiled functions, {sum(sizes) / 1e6:.1f} MB"
        if sizes
        else "no compiled functions; `viscoroll warmup` compiles them"
    )
    yield "cache", f"{folder}: {state}{_fault_of_cache(folder)}"
    yield "check", _check()


def _check() -> str:
    """Evaluate one state of the contact, as a check that the package works.

    The time is mostly that of compiling or loading the kernels, where they have not been used
    before.

    Returns a line of text: Q of the state, dimensionless, the time that the call took in s, and the
    warnings that it gave.
    """
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        start = time.perf_counter()
        Q = vr.contact(vr.presets.PAPER_SECTION_5, 0.5, delta=-0.01, fields="Q").Q
        seconds = time.perf_counter() - start
    texts = "".join(f"; {warning.message}" for warning in caught)
    state = "contact of paper-section-5 at V = 0.5, delta = -0.01"
    return f"{state}: Q = {Q:.12g}, {seconds:.1f} s{texts}"


def _version(name: str) -> str | None:
    """Return the version of a package; None if it is not installed.

    name: name of the package.
    """
    try:
        return metadata.version(name)
    except metadata.PackageNotFoundError:
        return None


def _fault_of_cache(folder: Path) -> str:
    """Return why the cache of compiled functions is not used or cannot be written, as the end of a
    line of the report.

    It is not used where others could write into it, or a folder is another user's.  It cannot be
    written where the folder, or if it does not exist the nearest folder above it that does, is not
    writable.

    folder: folder of the compiled functions, which need not exist.
    Returns a text that begins with ";", or "" if the cache is in order.
    """
    from ..kernels.numerics.cache_folder import refuse_writable_by_others

    try:
        refuse_writable_by_others(folder)
    except PermissionError as error:
        return f"; it is NOT USED: {error.strerror}"
    # a folder that is missing would be made in the nearest one above it
    existing = next((path for path in (folder, *folder.parents) if path.exists()), folder)
    return "" if os.access(existing, os.W_OK) else "; it CANNOT be written"


# --- Parser and exit codes of the program ---


#: First word of several commands -> its help.
_GROUPS = {
    "material": "Show a material, or fit one to measurements",
    "tables": "Write the contact law to a file, or to a grid for other programs",
}


class UsageError(ViscorollError):
    """The command line does not parse."""


class Parser(argparse.ArgumentParser):
    """A parser that raises UsageError instead of exiting, and prints help texts as they are
    written.
    """

    def __init__(self, **options: Any) -> None:
        """Set up the parser; abbreviations of options are refused.

        options: keywords of ``argparse.ArgumentParser``.
        """
        super().__init__(
            **options, allow_abbrev=False, formatter_class=argparse.RawDescriptionHelpFormatter
        )
        # argparse takes a value like -1:1:5 or -1e-3 for an option unless it matches this
        self._negative_number_matcher = re.compile(r"-\.?(\d|inf|nan)")
        for kind, words in ((float, "a number"), (int, "a whole number")):
            self.register("type", kind, partial(_convert_argument, kind, words))
        self.register("action", None, _StoreOnce)

    def error(self, message: str) -> NoReturn:
        """Raise UsageError, with a hint at --help, in place of an exit.

        message: what does not parse.
        """
        raise UsageError(f"{message} (see {self.prog} --help)")


class _StoreOnce(argparse.Action):
    """Stores a value; an option that is given twice is an error, while argparse takes the last."""

    def __call__(
        self, parser: Any, namespace: argparse.Namespace, values: Any, name: str | None = None
    ) -> None:
        """Store the value of an option or a positional argument; an option that had one before is
        an error.

        The signature is that of ``argparse.Action``.

        parser: not used.
        namespace: values of all arguments, which is changed: the value becomes its attribute
            ``self.dest``, whose name is added to its set ``stored``.
        values: the value, after its conversion.
        name: name of the option; None of a positional argument, which may be stored again.
        Raises ArgumentError for the second value of an option.
        """
        stored = vars(namespace).setdefault("stored", set())
        if name is not None and self.dest in stored:
            raise argparse.ArgumentError(self, "is given twice")
        stored.add(self.dest)
        setattr(namespace, self.dest, values)


def _convert_argument(kind: type, words: str, text: str) -> Any:
    """Convert the text of an argument to a number; it is the type of numeric arguments in argparse.

    kind: ``float`` or ``int``, which is called with the text.
    words: the type in words, for the error, as "a number".
    text: the argument.
    Returns the value, of the type ``kind``.
    Raises ArgumentTypeError where the text is no such value.
    """
    try:
        return kind(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} must be {words}") from None


def parser() -> Parser:
    """Return the parser of the whole command line, with a subparser for each command of
    :data:`.arguments.COMMANDS`.

    A command of two words, as "tables law", has a subparser below that of its first word.  The help
    of a command is the docstring of its function up to the paragraph on ``arguments``: a first
    sentence, which ends its line and is the line of the command in ``viscoroll --help``, text, and
    an example.

    Returns a :class:`Parser`.  The namespace that its ``parse_args`` returns has the arguments of
    the command, and ``run``, the function that takes the namespace and returns an exit code or
    None.
    """
    program = Parser(
        prog="viscoroll",
        description="Contact and motion of a viscoelastic cylinder rolling with partial slip on a\n"
        "half-space of its material or of another.\n\n"
        "If the scene or run file has a [cylinder] section, all inputs and outputs are in SI\n"
        "units.  Otherwise all are dimensionless.",
        epilog="example:\n  viscoroll roll paper-section-5 --V0 1.5 --omega0 0.5 --t 3e-3",
    )
    program.add_argument("--version", action="version", version=f"viscoroll {vr.__version__}")
    groups = {"": program.add_subparsers(metavar="COMMAND", required=True)}
    for words, (run, options) in COMMANDS.items():
        # of a single word the group is "", whose subparsers are those of the program
        group, _, name = words.rpartition(" ")
        if group not in groups:
            subparser = groups[""].add_parser(group, help=_GROUPS[group])
            groups[group] = subparser.add_subparsers(metavar="COMMAND", required=True)
        help_text = (inspect.getdoc(run) or "").partition("\n\narguments:")[0]
        text, word, example = help_text.partition("\n\nexample:")
        # the first sentence, which ends its line
        summary = text.partition(".\n")[0].rstrip(".")
        epilog = word.lstrip() + example
        subparser = groups[group].add_parser(name, help=summary, description=text, epilog=epilog)
        for add_to in options:
            add_to(subparser)
        subparser.set_defaults(run=run)
    return program


def main(argv: Sequence[str] | None = None) -> int:
    """Run the program; its errors and warnings are printed, each in one line, on standard error.

    argv: arguments, without the name of the program; None: those of the process.
    Returns the exit code: 0 success, 1 a check failed, 2 an error (of the package, a missing
    library, memory, or a file or standard output that cannot be written), 130 an interrupt by
    SIGINT, 141 a standard output that was closed by its reader.  Other exceptions are faults of the
    program, and go on.
    """
    for name in ("stdout", "stderr"):
        stream = getattr(sys, name)
        if stream is None:  # closed by the shell; prints and progress bars need an object
            setattr(sys, name, io.StringIO())
        elif isinstance(stream, io.TextIOWrapper):
            # a text that the encoding of the terminal lacks, as a Greek letter, is no failure
            stream.reconfigure(errors="backslashreplace")
    try:
        with warnings.catch_warnings():
            warnings.showwarning = partial(_print_warning, set())
            return _run(sys.argv[1:] if argv is None else argv)
    except (ViscorollError, ImportError) as error:
        return _print_error(error)
    except MemoryError as error:
        found = f" ({error})" if str(error) else ""
        return _print_error(
            f"not enough memory{found}: ask for fewer speeds, times, nodes or motions at once"
        )
    except KeyboardInterrupt as interrupt:
        if isinstance(interrupt, Interrupted):
            _print_line(interrupt)
        return 130  # as shells report a program that SIGINT ended
    except OSError as error:
        # a file that may fail raises FileError; an OSError without a name is of standard output
        if error.filename is not None:
            return _print_error(f"{error.filename}: {error.strerror}")
        _discard(sys.stdout)
        if isinstance(error, BrokenPipeError):
            return 141  # as shells report a program that SIGPIPE ended
        return _print_error(f"standard output: {error.strerror}")


def _run(argv: Sequence[str]) -> int:
    """Parse the arguments and run the command.

    argv: the words of the command line without the name of the program.
    Returns the exit code of the command, 0 or 1 (perhaps as a truth value); 0 after --help
    and --version.
    Raises what the command raises; UsageError where the line does not parse; ParameterError for a
    wrong $VISCOROLL_THREADS.
    """
    try:
        arguments = parser().parse_args(argv)
        from ..core import thread_count

        thread_count()  # refuses a wrong $VISCOROLL_THREADS for every command
        code = arguments.run(arguments) or 0
    except SystemExit as end:  # argparse ends so after --help and --version
        code = int(end.code or 0)
    # here, so that a full disk or a closed pipe is an error of main, not of the interpreter's end
    sys.stdout.flush()
    return code


def _print_warning(printed: set[str], message: Warning | str, *_: Any, **__: Any) -> None:
    """Print a warning in one line on standard error, unless it was printed.

    Python forgets that it has shown a warning where a filter is set, as imports of SciPy do.  Other
    arguments are not
    used: the signature, without the first argument, is that of ``warnings.showwarning``.

    printed: texts of the warnings that were printed; that of the message is added.
    message: the warning.
    """
    if str(message) not in printed:
        printed.add(str(message))
        _print_line(f"warning: {message}")


def _print_error(error: object) -> int:
    """Print an error in one line on standard error, after "viscoroll: error:", and return its exit
    code, 2.

    error: an exception, or its text.
    """
    _print_line(f"error: {error}")
    return 2


def _print_line(message: object) -> None:
    """Print a message in one line on standard error, after "viscoroll:"; nothing if that is full.

    message: an object whose text is printed, its line breaks as blanks.
    """
    try:
        print("viscoroll:", " ".join(str(message).split()), file=sys.stderr, flush=True)
    except OSError:
        _discard(sys.stderr)


def _discard(stream: TextIO) -> None:
    """Discard the buffer and all further text of a stream that cannot be written.

    The interpreter would try to write it at its end, and exit with its own code.

    stream: :class:`TextIO`, standard output or standard error.
    """
    os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())
