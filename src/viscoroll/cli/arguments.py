"""What commands have in common: the table of commands; the types of their arguments, as numbers,
ranges, the scene, the output file; and the output of results, as a table on standard output, or as
a complete file of a table or dataset.
"""

import functools
import json
import operator
import os
from argparse import ArgumentTypeError, Namespace
from collections.abc import Callable
from pathlib import Path
from typing import Any

import viscoroll as vr

from ..core import DataFrame, Dataset, write_dataset, write_text

# --- The table of commands, and the types of their arguments ---

#: Suffixes of figures.
FIGURES = (".png", ".pdf", ".svg")

#: A command: takes the parsed arguments, returns an exit code other than 0, or None.
CommandFunction = Callable[[Namespace], int | None]


#: Argument of a command: a function that adds it to a parser of argparse, or to a group of one.
Option = Callable[[Any], Any]
#: Words of a command -> (function that runs it, its arguments), in the order of ``--help``.
COMMANDS: dict[str, tuple[CommandFunction, tuple[Option, ...]]] = {}


def command(words: str, *options: Option) -> Callable[[CommandFunction], CommandFunction]:
    """Return a decorator that adds a function to :data:`COMMANDS`, so that the program has it as a
    command.

    words: words of the command, as "tables law"; its help is the docstring of its function.
    options: options of the command, in the order of its help, each as :func:`option` or
        :func:`output` returns it, or :func:`add_table`.
    Returns a decorator that takes the function of the command and returns it unchanged.
    """

    def add(run: CommandFunction) -> CommandFunction:
        COMMANDS[words] = run, options
        return run

    return add


#: option(*names, **settings) -> an argument of a command, in the form of :func:`command`: a
#: function that takes a parser of argparse, or a group of one, and adds the argument.  Names and
#: settings are those of ``ArgumentParser.add_argument``.
option: Callable[..., Option] = functools.partial(operator.methodcaller, "add_argument")


def numbers(text: str) -> Any:
    """Convert an argument to a float or an array: NUMBER, LOW:HIGH:COUNT, LOW:HIGH:COUNT:log, or a
    list of these.

    text: the argument; the members of a list are separated by commas.
    Returns a float for one NUMBER, else an array (n,) of the numbers of all members in their order;
    ranges have both ends.  A single NUMBER may be infinite or NaN here: the library refuses it.
    Raises ArgumentTypeError for any other form, and for a range that does not ascend.
    """
    import numpy as np

    members = [_numbers_of_member(member) for member in text.split(",")]
    # hstack takes numbers and vectors side by side
    return members[0] if len(members) == 1 else np.hstack(members)


def _numbers_of_member(text: str) -> Any:
    """Convert one member of the list of :func:`numbers`.

    text: NUMBER, LOW:HIGH:COUNT or LOW:HIGH:COUNT:log.
    Returns a float, or of a range an array (COUNT,) in equal steps or, with log, equal ratios.
    Raises ArgumentTypeError for any other form, for a range that does not ascend or whose ends are
    not finite, for a COUNT outside 2 ... 5e7 or no whole number, and with log for a LOW that is not
    > 0.
    """
    try:
        low, *rest = text.split(":")
        if not rest:
            return float(low)
        # without a spacing that of the library, linear; a second one is a TypeError of the call
        high, count, *spacing = rest
        return vr.tables.spread(float(low), float(high), int(count), *spacing)  # type: ignore[arg-type]
    except vr.ParameterError as error:
        raise ArgumentTypeError(f"{text!r}: {error}") from None
    except (ValueError, TypeError):
        raise ArgumentTypeError(
            f"{text!r} must be a number, LOW:HIGH:COUNT, LOW:HIGH:COUNT:log, or several of these, "
            "separated by commas"
        ) from None


def roller_of_argument(text: str) -> Any:
    """Return the roller of an argument: the scene or the cylinder of a TOML file, or the preset of
    a name.

    text: path of the file, which ends in .toml (in any case), or the name, as "paper-section-5".
    Returns a :class:`viscoroll.Scene`, dimensionless, or a :class:`viscoroll.Cylinder`, in SI
    units.
    Raises ParameterError for an unknown preset; FileError for a .toml file that cannot be read or
    describes no roller, and for an existing file whose name does not end in .toml.
    """
    from ..presets import preset, read_roller

    if text.lower().endswith(".toml"):
        return read_roller(text)
    if os.path.exists(text):
        raise vr.FileError(text, "is not a scene file: its name must end in .toml")
    return preset(text)


def output(*suffixes: str, name: str = "-o", required: bool = True, more: str = "") -> Option:
    """Return the option of an output file; a path that cannot be written is refused before any
    work.

    suffixes: allowed suffixes, with the dot and in lower case.
    name: name of the option; without its dashes it names the argument, "output" for -o.
    required: whether it must be given; if it need not and is not, the argument is None.
    more: text after the suffixes in the help.
    Returns an :class:`Option`, whose argument becomes a Path; nothing is written.
    """

    def path(text: str) -> Path:
        """Convert an argument to the path of the output file, which is not created.

        text: the argument; of a .zarr folder a "/" at its end is left out.
        Returns the Path; a file that exists is allowed.
        Raises ArgumentTypeError for another suffix, a folder that does not exist, and a directory
        other than a .zarr.
        """
        if text.endswith(".zarr/"):  # as shells complete the name of a folder
            text = text.rstrip("/")
        problem = ""
        if Path(text).suffix.lower() not in suffixes:
            problem = f"must end in {allowed}"
        elif not os.path.isdir(os.path.dirname(text) or "."):
            problem = "cannot be written: its folder does not exist, make the folder first"
        elif os.path.isdir(text) and not text.endswith(".zarr"):
            problem = "cannot be written: it is a directory"
        if problem:
            raise ArgumentTypeError(f"{text!r} {problem}")
        return Path(text)

    allowed = " or ".join(suffixes)
    return option(
        name,
        # argparse would call the argument of -o by its letter
        dest="output" if name == "-o" else name[2:],
        metavar="FILE",
        type=path,
        required=required,
        help=allowed + more,
    )


#: A file to read.
FILE = option("file", metavar="FILE")
#: A scene or cylinder.
SCENE = option(
    "scene",
    metavar="SCENE",
    help="TOML file with [cylinder] (all numbers are in SI units), or with [scene] or preset (all "
    "numbers are dimensionless); or the name of a preset (dimensionless)",
)


def add_table(parser: Any) -> None:
    """Add the options of the output of a table of numbers, of which one at most may be given: to a
    file, or to standard output in a format.

    parser: parser of argparse, to which they are added.
    """
    group = parser.add_mutually_exclusive_group()
    output(".txt", ".csv", ".nc", required=False, more="; default: standard output")(group)
    group.add_argument(
        "--format",
        choices=("text", "csv", "json"),
        default="text",
        help="format of standard output (default: text)",
    )


# --- Output of results ---


def show(arguments: Namespace, result: Any, heading: str = "") -> None:
    """Print or write a result by its ``to_xarray`` and ``to_pandas``.

    In the table codes, as those of regimes, are replaced by their meanings, and rows of equilibria
    that a load does not have (V is NaN) are left out; of a single row the column "state" is left
    out.  The dataset, for a .nc file, stays as it is.

    arguments: parsed command line with output and format, as in :func:`deliver`.
    result: a result of the library that has both methods, as in ``contact``, ``roll`` or
    ``steady``.
    heading: first lines of the text, which csv and json do not have; "": the title of the data.
    Raises FileError if the file cannot be written.
    """
    import numpy as np

    data = result.to_xarray()
    frame = result.to_pandas().reset_index()
    for name, variable in data.items():
        if "flag_meanings" in variable.attrs:  # codes and their meanings, by the CF conventions
            meanings = variable.attrs["flag_meanings"].split()
            frame[name] = frame[name].map(
                dict(zip(np.ravel(variable.attrs["flag_values"]), meanings))
            )
    if "equilibrium" in frame:  # a load with fewer equilibria than another has NaN in the rest
        # the one column "V" or "V [m s-1]"
        frame = frame[np.isfinite(frame.filter(regex=r"^V( |$)")).all(axis=1)]
    if len(frame) == 1:
        frame = frame.drop(columns="state", errors="ignore")
    deliver(arguments, data, frame, heading or data.attrs["title"])


def deliver(arguments: Namespace, data: Dataset, frame: DataFrame, heading: str) -> None:
    """Print a table in the required format, or write it or the dataset in the format of the suffix.

    In json, an object of column -> list, numbers that are not finite are null.

    arguments: parsed command line with
        output, a path that ends in .txt, .csv or .nc and is written, or None: standard output;
        format of standard output, "text", "csv" or "json"; not used with a path.
    data: dataset for netCDF, whose ``long_name`` are the meanings of the variables in the text.
    frame: pandas DataFrame, the same as a table, one row for each state.
    heading: first lines of the text; csv and json have none.
    Raises FileError if the file cannot be written.
    """
    path = arguments.output
    # of a path the suffix without its dot; .txt leads to the last case below, as "text" does
    suffix = arguments.format if path is None else path.suffix.lower()[1:]
    if suffix == "nc":
        write_dataset(data, path)
        return
    if suffix == "csv":
        text = frame.to_csv(index=False, lineterminator="\n")
    elif suffix == "json":
        # as objects, since a column of floats would keep NaN in place of None
        finite = frame.replace([float("inf"), -float("inf")], float("nan")).astype(object)
        columns = finite.where(finite.notna(), None).to_dict("list")
        text = json.dumps(columns, indent=1, allow_nan=False) + "\n"
    else:
        meanings = {
            str(name): variable.attrs.get("long_name", "") for name, variable in data.items()
        }
        text = as_text(frame, heading, meanings)
    if path is None:
        print(text, end="")
    else:
        write_text(path, text)


def as_text(frame: DataFrame, heading: str, meanings: dict[str, str] | None = None) -> str:
    """Return a table as aligned columns below a heading, or a single row as one line for each
    number.

    frame: pandas DataFrame, the table, whose columns are called "NAME [UNIT]"; without rows the
    heading stands alone.
    heading: first lines.
    meanings: name of a column without its unit -> meaning, which stands after its number where the
        table has a single row; None: a single row is written as columns too.
    Returns the text, which ends with a line break; numbers have ten digits, and missing ones of
    columns are blank.
    """
    if frame.empty:
        return f"{heading}\n"
    if meanings is None or len(frame) != 1:
        text = frame.to_string(index=False, float_format="{:.10g}".format, na_rep="")
        return f"{heading}\n\n{text}\n"
    lines = []
    for column, value in frame.iloc[0].items():
        name, _, unit = str(column).partition(" ")
        number = f"{value:.10g} {unit.strip('[]')}" if isinstance(value, float) else str(value)
        lines.append(f"{name:>11} = {number.rstrip():<20} {meanings.get(name, '')}".rstrip())
    return "\n".join([heading, "", *lines, ""])
