"""Parser and exit codes of the program: 0 done, 1 a validation failed, 2 an error in one line."""

from __future__ import annotations

import argparse
import inspect
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

# they fill the table of commands, in this order
from . import scenes, runs, measured, tables, plot, warmup, doctor  # noqa: F401  # isort: skip
from .arguments import COMMANDS

#: What a shell reports for a program ended by SIGINT or SIGPIPE.
_INTERRUPTED, _BROKEN_PIPE = 130, 141
#: first words of several commands
_GROUPS = {
    "material": "show and fit a material of several relaxation times",
    "tables": "the law of a material as a file, grids for other programs",
}


class UsageError(ViscorollError):
    """The command line does not parse."""


class Parser(argparse.ArgumentParser):
    """A parser that raises instead of exiting, and shows texts as they are written."""

    def __init__(self, **options: Any) -> None:
        super().__init__(**options, allow_abbrev=False, formatter_class=argparse.RawDescriptionHelpFormatter)
        # what is no option: argparse takes a value like -1:1:5 or -1e-3 for one
        self._negative_number_matcher = re.compile(r"-\.?(\d|inf|nan)")
        for kind, words in ((float, "a number"), (int, "a whole number")):
            self.register("type", kind, partial(_read, kind, words))
        self.register("action", None, _Once)

    def error(self, message: str) -> NoReturn:
        raise UsageError(f"{message} (see {self.prog} --help)")


class _Once(argparse.Action):
    """Stores a value; an option that is given twice is an error, where argparse takes the last."""

    def __call__(
        self, parser: argparse.ArgumentParser, namespace: argparse.Namespace, values: Any, name: str | None = None
    ) -> None:
        given = vars(namespace).setdefault("given", set())
        if name is not None and self.dest in given:
            raise argparse.ArgumentError(self, "is given twice")
        given.add(self.dest)
        setattr(namespace, self.dest, values)


def _read(kind: type, words: str, text: str) -> Any:
    try:
        return kind(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} must be {words}") from None


def parser() -> Parser:
    """The whole command line."""
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
            one = groups[""].add_parser(group, help=_GROUPS[group])
            groups[group] = one.add_subparsers(metavar="COMMAND", required=True)
        text, _, example = (inspect.getdoc(run) or "").partition("\n\nexample:")
        short, epilog = text.partition(".\n")[0].rstrip("."), f"example:{example}" if example else None
        one = groups[group].add_parser(name, help=short, description=text, epilog=epilog)
        either = one.add_mutually_exclusive_group() if any(each.exclusive for each in options) else one
        for names, about, exclusive in options:
            (either if exclusive else one).add_argument(*names, **about)
        one.set_defaults(run=run)
    return program


def main(argv: Sequence[str] | None = None) -> int:
    """Run the program on ``argv`` (default: that of the process); returns its exit code."""
    if sys.stdout is None:  # closed by the shell
        sys.stdout = io.StringIO()
    try:
        with warnings.catch_warnings():
            warnings.showwarning = _told
            return _run(sys.argv[1:] if argv is None else argv)
    except (ViscorollError, ImportError) as error:
        return _failed(error)
    except MemoryError as error:
        return _failed(f"not enough memory ({error})")
    except KeyboardInterrupt as end:
        if isinstance(end, Interrupted):
            _tell(end)
        return _INTERRUPTED
    except OSError as error:  # of files FileError is raised where they are known to fail: without a name, of output
        if error.filename is not None:
            return _failed(f"{error.filename}: {error.strerror}")
        _discard(sys.stdout)
        return _BROKEN_PIPE if isinstance(error, BrokenPipeError) else _failed(f"standard output: {error.strerror}")


def _run(argv: Sequence[str]) -> int:
    try:
        given = parser().parse_args(argv)
        from ...core.blocks import thread_count

        thread_count()  # refuses a wrong $VISCOROLL_THREADS, whatever the command
        code = given.run(given) or 0
    except SystemExit as finished:  # argparse's own way to end after --help and --version
        code = int(finished.code or 0)
    sys.stdout.flush()
    return code


def _told(message: Warning | str, *_: Any, **__: Any) -> None:
    """A warning in one line."""
    _tell(f"warning: {message}")


def _failed(error: object) -> int:
    """Tell an error in one line; returns the exit code of it."""
    _tell(f"error: {error}")
    return 2


def _tell(message: object) -> None:
    """Write one line to standard error, if it is open and can be written."""
    if sys.stderr is not None:
        try:
            print("viscoroll:", " ".join(str(message).split()), file=sys.stderr, flush=True)
        except OSError:
            _discard(sys.stderr)


def _discard(stream: TextIO) -> None:
    """Send buffered and further text of ``stream`` nowhere: the interpreter would fail to write it at its end, and exit
    with its own code.
    """
    os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())
