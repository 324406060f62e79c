"""Parser and exit codes of the program: 0 success, 1 a check failed, 2 an error in one line."""

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

from ... import __version__
from ...core.errors import Interrupted, ViscorollError

# each of these modules adds its commands to the table, in this order
from . import scenes, runs, measured, tables, plot, samples, warmup, doctor  # noqa: F401  # isort: skip
from .arguments import COMMANDS
from .help_texts import HELP

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
    """A parser that raises UsageError instead of exiting, and prints help texts as they are written."""

    def __init__(self, **options: Any) -> None:
        """Set up the parser; abbreviations of options are refused.

        options: keywords of ``argparse.ArgumentParser``.
        """
        super().__init__(**options, allow_abbrev=False, formatter_class=argparse.RawDescriptionHelpFormatter)
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
        self, parser: argparse.ArgumentParser, namespace: argparse.Namespace, values: Any, name: str | None = None
    ) -> None:
        """Store the value of an option or a positional argument; an option that had one before is an error.

        The signature is that of ``argparse.Action``.

        parser: not used.
        namespace: values of all arguments, which is changed: the value becomes its attribute ``self.dest``, whose name
            is added to its set ``stored``.
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
    """Return the parser of the whole command line, with a subparser for each command of :data:`.arguments.COMMANDS`.

    A command of two words, as "tables law", has a subparser below that of its first word.  The help of each command is
    that of :data:`.help_texts.HELP`.

    Returns a :class:`Parser`.  The namespace that its ``parse_args`` returns has the arguments of the command, and
    ``run``, the function that takes the namespace and returns an exit code or None.
    """
    program = Parser(
        prog="viscoroll",
        description="Contact and motion of a viscoelastic cylinder rolling with partial slip on a half-space of its\n"
        "material or of another.\n\n"
        "If the scene or run file has a [cylinder] section, all inputs and outputs are in SI units.\n"
        "Otherwise all are dimensionless.",
        epilog="example:\n  viscoroll roll paper-section-5 --V0 1.5 --omega0 0.5 --t 3e-3",
    )
    program.add_argument("--version", action="version", version=f"viscoroll {__version__}")
    groups = {"": program.add_subparsers(metavar="COMMAND", required=True)}
    for words, (run, options) in COMMANDS.items():
        group, _, name = words.rpartition(" ")
        if group not in groups:
            subparser = groups[""].add_parser(group, help=_GROUPS[group])
            groups[group] = subparser.add_subparsers(metavar="COMMAND", required=True)
        text, _, example = HELP[words].partition("\n\nexample:")
        summary, epilog = text.partition(".\n")[0].rstrip("."), f"example:{example}" if example else None
        subparser = groups[group].add_parser(name, help=summary, description=text, epilog=epilog)
        for option in options:
            alternatives = option if isinstance(option, list) else [option]
            target = subparser.add_mutually_exclusive_group() if alternatives is option else subparser
            for add_to in alternatives:
                add_to(target)
        subparser.set_defaults(run=run)
    return program


def main(argv: Sequence[str] | None = None) -> int:
    """Run the program; its errors and warnings are printed, each in one line, on standard error.

    argv: arguments, without the name of the program; None: those of the process.
    Returns the exit code: 0 success, 1 a check failed, 2 an error (of the package, a missing library, memory, or a file
    or standard output that cannot be written), 130 an interrupt by SIGINT, 141 a standard output that was closed by its
    reader.  Other exceptions are faults of the program, and go on.
    """
    if sys.stdout is None:  # closed by the shell
        sys.stdout = io.StringIO()
    try:
        with warnings.catch_warnings():
            warnings.showwarning = partial(_print_warning, set())
            return _run(sys.argv[1:] if argv is None else argv)
    except (ViscorollError, ImportError) as error:
        return _print_error(error)
    except MemoryError as error:
        return _print_error(f"not enough memory{f' ({error})' if str(error) else ''}")
    except KeyboardInterrupt as interrupt:
        if isinstance(interrupt, Interrupted):
            _print_line(interrupt)
        return _INTERRUPTED
    except OSError as error:  # a file that may fail raises FileError; an OSError without a name is of standard output
        if error.filename is not None:
            return _print_error(f"{error.filename}: {error.strerror}")
        _discard(sys.stdout)
        if isinstance(error, BrokenPipeError):
            return _BROKEN_PIPE
        return _print_error(f"standard output: {error.strerror}")


def _run(argv: Sequence[str]) -> int:
    """Parse the arguments and run the command.

    argv: the words of the command line without the name of the program.
    Returns the exit code of the command, 0 or 1 (perhaps as a truth value); 0 after --help and --version.
    Raises what the command raises; UsageError where the line does not parse; ParameterError for a wrong
    $VISCOROLL_THREADS.
    """
    try:
        arguments = parser().parse_args(argv)
        from ...core.blocks import thread_count

        thread_count()  # refuses a wrong $VISCOROLL_THREADS for every command
        code = arguments.run(arguments) or 0
    except SystemExit as end:  # argparse ends so after --help and --version
        code = int(end.code or 0)
    sys.stdout.flush()
    return code


def _print_warning(printed: set[str], message: Warning | str, *_: Any, **__: Any) -> None:
    """Print a warning in one line on standard error, unless it was printed.

    Python forgets that it has shown a warning where a filter is set, as imports of SciPy do.  Other arguments are not
    used: the signature, without the first argument, is that of ``warnings.showwarning``.

    printed: texts of the warnings that were printed; that of the message is added.
    message: the warning.
    """
    if str(message) not in printed:
        printed.add(str(message))
        _print_line(f"warning: {message}")


def _print_error(error: object) -> int:
    """Print an error in one line on standard error, after "viscoroll: error:", and return its exit code, 2.

    error: an exception, or its text.
    """
    _print_line(f"error: {error}")
    return 2


def _print_line(message: object) -> None:
    """Print a message in one line on standard error, after "viscoroll:"; nothing if that is closed or full.

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
