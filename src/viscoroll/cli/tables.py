"""``viscoroll tables build|export|info|validate``."""

from __future__ import annotations

import sys
import time
from argparse import Namespace
from pathlib import Path
from typing import Any

from .arguments import NUMBERS, add_output_option, count, number, numbers, whole


def add_commands(commands: Any) -> None:
    """Add the group to the program."""
    group = commands.add_parser(
        "tables",
        help="build, export, look into and validate table files",
        description="Tables of the contact law as netCDF-4/HDF5 files.",
        epilog="example:\n  viscoroll tables build -o data/tables",
    ).add_subparsers(metavar="COMMAND", required=True)
    for add in (_add_build, _add_export, _add_info, _add_validate):
        add(group)


def _add_build(group: Any) -> None:
    parser = group.add_parser(
        "build",
        help="atlas.nc (universal) and paper.nc (the paper's Sect. 5)",
        description="Build atlas.nc, the universal table in similarity variables, paper.nc, the table at the paper's\n"
        "kappa and mu, and NAME.nc for every section [tables.NAME] of a material.",
        epilog="example:\n  viscoroll tables build -o data/tables",
    )
    parser.add_argument(
        "--config",
        metavar="FILE",
        help="TOML with [tables.atlas], [tables.paper] and others of a material; default: built in",
    )
    parser.add_argument("-o", dest="folder", metavar="FOLDER", type=Path, default=Path(), help="default: this folder")
    parser.set_defaults(run=_build)


def _add_export(group: Any) -> None:
    parser = group.add_parser(
        "export",
        help="a table in the format of another program",
        description="Write a table file, or one made now over (V, delta, alpha) at one kappa and mu, in the format of\n"
        f"another program.  An axis is {NUMBERS}.",
        epilog="example:\n  viscoroll tables export data/tables/paper.nc --format modelica --alpha 11 -o q.txt",
    )
    parser.add_argument("file", metavar="FILE", nargs="?", help="table file; without it: give all of the options below")
    parser.add_argument(
        "--format", default="netcdf4", help="netcdf4 (default), netcdf3, csv, modelica (.txt) or matlab (.mat)"
    )
    for name in ("--kappa", "--mu"):
        parser.add_argument(name, type=number)
    for name, meaning in (
        ("--V", "speeds of the axis, > 0"),
        ("--delta", "creep ratios"),
        ("--alpha", "alphas, >= 1; of a FILE: those to keep (default all)"),
    ):
        parser.add_argument(name, type=numbers, help=meaning)
    add_output_option(parser, ".nc", ".csv", ".txt", ".mat", required=True)
    parser.set_defaults(run=_export)


def _add_info(group: Any) -> None:
    parser = group.add_parser(
        "info",
        help="what a table file holds",
        description="Grid, fields, stated errors and provenance of a table file, once its content is verified.",
        epilog="example:\n  viscoroll tables info data/tables/atlas.nc",
    )
    parser.add_argument("file", metavar="FILE")
    parser.set_defaults(run=_info)


def _add_validate(group: Any) -> None:
    parser = group.add_parser(
        "validate",
        help="compare a table file with direct solves",
        description="Solve the printed equations at random nodes and between nodes of a table and compare with the\n"
        "errors that the file states; exit code 1 where one is exceeded.",
        epilog="example:\n  viscoroll tables validate data/tables/atlas.nc",
    )
    parser.add_argument("file", metavar="FILE")
    parser.add_argument("-n", type=count, default=10_000, help="points at nodes, and as many between (default 10000)")
    parser.add_argument("--seed", type=whole, default=0, help="seed of the random points (default 0)")
    parser.set_defaults(run=_validate)


def _build(arguments: Namespace) -> int:
    from .. import tables
    from ..config import read_grids
    from ..errors import OutputError

    grids = read_grids(arguments.config)
    try:
        arguments.folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(arguments.folder, f"cannot be made a folder ({error.strerror or error})") from error
    for name, grid in grids.items():
        began, path = time.perf_counter(), arguments.folder / f"{name}.nc"
        tables.save(tables.build(grid, progress=sys.stderr.isatty()), path)
        print(f"{path}: {path.stat().st_size / 1e6:.1f} MB in {time.perf_counter() - began:.1f} s")
    return 0


def _export(arguments: Namespace) -> int:
    from .. import tables
    from ..errors import ParameterError

    tables.check_format(arguments.format, arguments.output)
    axes = {name: getattr(arguments, name) for name in ("kappa", "mu", "V", "delta", "alpha")}
    given = {name for name, value in axes.items() if value is not None}
    if arguments.file is None and given == axes.keys():
        table = tables.build(tables.LiteralGrid(**axes), progress=sys.stderr.isatty())
        tables.export(table, arguments.output, arguments.format)
    elif arguments.file is not None and given <= {"alpha"}:
        tables.export(tables.load(arguments.file), arguments.output, arguments.format, alpha=arguments.alpha)
    else:
        found = ["FILE"] * (arguments.file is not None) + [f"--{name}" for name in axes if name in given]
        allowed = "FILE, with or without --alpha, or all of --kappa, --mu, --V, --delta and --alpha"
        raise ParameterError("table", ", ".join(found) or "nothing", allowed)
    return 0


def _info(arguments: Namespace) -> int:
    from .. import tables

    print(tables.info(arguments.file))
    return 0


def _validate(arguments: Namespace) -> int:
    from .. import tables
    from ..validation import Report
    from ..validation.table_check import check_table

    checks = check_table(tables.load(arguments.file), arguments.n, arguments.seed)
    report = Report(tuple(checks), {"file": arguments.file, "points": arguments.n, "seed": arguments.seed})
    print(report)
    return 0 if report.ok else 1
