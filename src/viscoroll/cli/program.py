"""The program: its parser, the help of each command, and its exit codes: 0 success, 1 a check
failed, 2 an error, printed in one line.

The first sentence of a help is the line of the command in ``viscoroll --help``; an example follows
the text.
"""

from __future__ import annotations

import argparse
import io
import os
import re
import sys
import warnings
from collections.abc import Sequence
from functools import partial
from typing import Any, NoReturn, TextIO

from .. import __version__
from ..core import Interrupted, ViscorollError
from .arguments import COMMANDS

# each of these modules adds its commands to the table, in this order
from . import motion_commands, file_commands, installation_commands  # noqa: F401  # isort: skip


# --- Help of each command, as viscoroll COMMAND --help prints it ---

#: Words of a command -> its help.
HELP = {
    "contact": """\
Compute the contact at constant speed: lam, epsilon, delta_star, beta, Q, M.

The result has a row for every pair of V and delta (or omega).  Each option is a number, LOW:HIGH:COUNT,
LOW:HIGH:COUNT:log, or several of these, separated by commas.

example:
  viscoroll contact paper-section-5 --V 0.5,1 --delta -0.04:0.04:5""",  # noqa: E501
    "stress": """\
Compute pressure and shear stress along the contact.

The stresses are given at 101 points of the contact, for one V and one delta (or omega).

example:
  viscoroll stress paper-section-5 --V 0.5 --delta -0.01""",
    "roll": """\
Integrate one free motion from given initial speeds.

The motion obeys Eq. (22), and may change between full slip and partial slip.
For driven, braked and unsteady motions use vr.roll in Python, or a run file (viscoroll ensemble).

example:
  viscoroll roll paper-section-5 --V0 1.5 --omega0 0.5 --t 0:3e-3:7""",
    "steady": """\
Find the steady speeds under force, torque or slope.

Each equilibrium of each load is a row.  If a load has no equilibrium, the reason is printed.
Options are written as the numbers of `viscoroll contact`: single numbers, or lists of equal length.

example:
  viscoroll steady paper-section-5-rounded --slope 0:0.1:6""",
    "heat": """\
Find the temperatures at which a cylinder runs.

Each equilibrium of loss and heat given off is a row; unstable ones lie between two stable ones.
The [material] needs wlf or arrhenius.  Options are written as the numbers of `viscoroll contact`.

example:
  viscoroll samples
  viscoroll heat samples/rubber.toml --V 0.5:4:8 --ambient 20 --conductance 2.5""",
    "validity": """\
Check the assumptions of the model at one speed.

Each line has the name of an assumption, whether it holds (yes, no, or ? if data are missing), and the reason.

example:
  viscoroll validity rubber-roller --V 5 --omega 4.9""",  # noqa: E501
    "ensemble": """\
Compute the motions of a run file with random initial speeds and parameters.

The command computes the motions that the store does not contain yet, and summarises all motions.
Call it again to complete an interrupted run, or to extend the store after n was raised in the run file.
Without -o it prints the estimated size, memory and time of the run.

example:
  viscoroll samples
  viscoroll ensemble samples/ensemble.toml""",  # noqa: E501
    "verify": """\
Check every file of a results store against its SHA-256.

The exit code is 1 if a file differs or is missing.""",
    "sensitivity": """\
Compute Sobol indices of the uncertain inputs of a run file.

The table has first-order (S1) and total (ST) indices of the summarised quantities, with the half-width of the
95 % confidence interval (S1_conf, ST_conf), sorted by ST.  `viscoroll plot` draws the .nc file as bars.

example:
  viscoroll sensitivity run.toml -n 4096 -o sensitivity.nc""",  # noqa: E501
    "material show": """\
Print moduli, relaxation modes and creep modes of the materials of a file.

The values are those at the temperature that the file states.

example:
  viscoroll samples
  viscoroll material show samples/rubber.toml""",
    "material fit": """\
Fit a material to DMA data.

The command fits a Prony series to columns of frequency, storage modulus and loss modulus, with units in their
headings, and prints how well the data determine it.  With -o it writes a [material] of a TOML file, or netCDF.

The exit code is 1 and no file is written if the misfit exceeds --misfit, or if it exceeds 5 % with any --misfit.
With --force the exit code is 0 and the file is written; the source of the data in it states the misfit.

example:
  viscoroll samples
  viscoroll material fit samples/dma.csv --nu 0.49 -o rubber.toml""",  # noqa: E501
    "identify": """\
Identify friction, modulus, relaxation times and moduli, and bearing friction, from measurements.

The command fits unknown parameters of a cylinder to measured rolling resistance, traction and motions, and states
which of them the data do not determine.  The file has [cylinder], perhaps [material] and [base], and
  [unknown]  NAME = [LOW, HIGH]: bounds; [cylinder] has the initial guess
  [prior]    NAME = [VALUE, SD]
  [[data]]   kind = resistance, traction or coastdown; file = a CSV whose columns are named as V, M, delta,
             Q, t, omega, x, or by columns = { M = NAME }; sigma, load, temperature, name; V0, omega0, t0, m

example:
  viscoroll samples
  viscoroll identify samples/measured.toml --plot fit.png""",  # noqa: E501
    "tables law": """\
Write the contact law of a material, pair, cover or range of alpha to a file.

.nc is read by vr.load_law, run files and every netCDF reader; .cdf is the same without HDF5; .h is a header of C99
or C++ with table and evaluator; .json is for JavaScript.  --alpha writes the law of one relaxation time for
every alpha of a range.  Of a cover it is the fast law (coupled = false); viscoroll tables grid writes the coupled one.

example:
  viscoroll samples
  viscoroll tables law samples/rubber.toml -o rubber.h""",  # noqa: E501
    "tables build": """\
Write a grid of the contact law on axes V, delta (and alpha) for look-up in other programs.

The grid of a scene is dimensionless, the grid of a cylinder is in SI units.  Formats: .nc, .cdf (without HDF5),
.csv, .txt (for Modelica) and .mat (MATLAB).  Axes are written as the numbers of `viscoroll contact`.

example:
  viscoroll tables build paper-section-5 --V 1e-3:2:201:log --delta -0.04:0.04:401 -o t.nc""",  # noqa: E501
    "tables grid": """\
Write the coupled solution of a roller over speed and creep as a law, for one mu and one thickness over l0.

Pressure and shear are solved together.  The file is loaded by vr.load_law, as the material of the roller, and states
the largest errors beside its nodes.  Formats: .nc, .cdf (without HDF5) and .h (a header of C).

example:
  viscoroll samples
  viscoroll tables grid samples/rubber.toml --method coupled -o rubber.nc""",  # noqa: E501
    "tables info": """\
Print the contents of a table file: functions or grid, stated errors, material and provenance.

example:
  viscoroll samples
  viscoroll tables law samples/rubber.toml -o rubber.nc
  viscoroll tables info rubber.nc""",
    "tables validate": """\
Compare a law file with the formulas of its relaxation modes at random speeds, or a grid with the law.

The exit code is 1 if an error is larger than twice the one that the file states, or than half of the largest value
of a field of a grid.

example:
  viscoroll samples
  viscoroll tables law samples/rubber.toml -o rubber.nc
  viscoroll tables validate rubber.nc""",  # noqa: E501
    "export": """\
Convert the results of a run, or a table, to another file format.

A results store (STORE.zarr) becomes .nc with summaries and stored motions.  A law becomes .nc, .cdf, .h or .json.
A grid becomes .nc, .cdf, .csv, .txt or .mat.

example:
  viscoroll samples
  viscoroll tables law samples/rubber.toml -o rubber.nc
  viscoroll export rubber.nc -o rubber.h""",  # noqa: E501
    "fmu": """\
Build an FMU of a cylinder, for Modelica tools and others.

The FMU contains the law of a material, pair or cover and its C sources, compiled for this machine by cc.
Of a cover it is the fast law, as with coupled = false.
Roller: inputs drive force and torque, outputs v, omega, x; for co-simulation and model exchange.
ContactElement: inputs v, omega, load, outputs force, torque, moments; for model exchange.
Both provide exact directional derivatives.

example:
  viscoroll samples
  viscoroll fmu samples/rubber.toml -o roller.fmu""",  # noqa: E501
    "plot": """\
Draw a result file, a scene, a material, or the results of a run.

For a netCDF file the command draws its result, for a scene file the contact law over speed, for a file with only
a [material] moduli and relaxation, and for a results store the summaries.""",  # noqa: E501
    "samples": """\
Copy the sample files of the documentation into a folder.

They are scene files, run files and measurements, which the examples of other commands read.

example:
  viscoroll samples
  viscoroll contact samples/rubber.toml --V 0.5 --delta 0.01""",
    "warmup": """\
Compile all kernels in advance, so that the first calls do not wait.

The compiled kernels go into the cache, once for each machine and version of the package.  If they are there
already, the command takes a second.

example:
  viscoroll warmup""",  # noqa: E501
    "doctor": """\
Report versions, cache, threads, compiled functions and missing packages.

Send this output with a report of a problem.  The exit code is 1 if a required package is missing.

example:
  viscoroll doctor""",
}


# --- Parser and exit codes of the program ---

#: Exit code of a program that SIGINT ended, as shells report it.
_INTERRUPTED = 130
#: Exit code of a program that SIGPIPE ended, as shells report it.
_BROKEN_PIPE = 141
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
        self,
        parser: argparse.ArgumentParser,
        namespace: argparse.Namespace,
        values: Any,
        name: str | None = None,
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
    of each command is that of :data:`HELP`.

    Returns a :class:`Parser`.  The namespace that its ``parse_args`` returns has the arguments of
    the command, and ``run``, the function that takes the namespace and returns an exit code or
    None.
    """
    program = Parser(
        prog="viscoroll",
        description="Contact and motion of a viscoelastic cylinder rolling with partial slip on a "
        "half-space of its\n"
        "material or of another.\n\n"
        "If the scene or run file has a [cylinder] section, all inputs and outputs are in SI "
        "units.\n"
        "Otherwise all are dimensionless.",
        epilog="example:\n  viscoroll roll paper-section-5 --V0 1.5 --omega0 0.5 --t 3e-3",
    )
    program.add_argument("--version", action="version", version=f"viscoroll {__version__}")
    groups = {"": program.add_subparsers(metavar="COMMAND", required=True)}
    for words, (run, options) in COMMANDS.items():
        # of a single word the group is "", whose subparsers are those of the program
        group, _, name = words.rpartition(" ")
        if group not in groups:
            subparser = groups[""].add_parser(group, help=_GROUPS[group])
            groups[group] = subparser.add_subparsers(metavar="COMMAND", required=True)
        text, _, example = HELP[words].partition("\n\nexample:")
        # the first sentence, which ends its line
        summary = text.partition(".\n")[0].rstrip(".")
        epilog = f"example:{example}" if example else None
        subparser = groups[group].add_parser(name, help=summary, description=text, epilog=epilog)
        for option in options:
            # a list is a group of which one at most may be given
            alternatives = option if isinstance(option, list) else [option]
            target = (
                subparser.add_mutually_exclusive_group() if alternatives is option else subparser
            )
            for add_to in alternatives:
                add_to(target)
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
    if sys.stdout is None:  # closed by the shell
        # prints need an object to write to
        sys.stdout = io.StringIO()
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
        return _INTERRUPTED
    except OSError as error:
        # a file that may fail raises FileError; an OSError without a name is of standard output
        if error.filename is not None:
            return _print_error(f"{error.filename}: {error.strerror}")
        _discard(sys.stdout)
        if isinstance(error, BrokenPipeError):
            return _BROKEN_PIPE
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
    """Print a message in one line on standard error, after "viscoroll:"; nothing if that is closed
    or full.

    message: an object whose text is printed, its line breaks as blanks.
    """
    if sys.stderr is not None:
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
