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
        description="Build atlas.nc, the universal table in similarity variables, and paper.nc, the table at the\n"
        "paper's kappa and mu.",
        epilog="example:\n  viscoroll tables build -o data/tables",
    )
    parser.add_argument(
        "--config", metavar="FILE", help="TOML with [tables.atlas] and [tables.paper]; default: built in"
    )
    parser.add_argument("-o", dest="folder", metavar="FOLDER", type=Path, default=Path(), help="default: this folder")
    parser.set_defaults(run=_build)


def _add_export(group: Any) -> None:
    parser = group.add_parser(
        "export",
        help="a table over (V, delta, alpha) at any kappa and mu",
        description=f"Build a table over (V, delta, alpha) at one kappa and mu; an axis is\n{NUMBERS}.",
        epilog="example:\n  viscoroll tables export --kappa 29.1 --mu 0.3 --V 1e-3:2:40:log --delta -0.01:0.01:41"
        " --alpha 1,11 -o steel.nc",
    )
    for name in ("--kappa", "--mu"):
        parser.add_argument(name, type=number, required=True)
    for name, meaning in (("--V", "speeds of the axis, > 0"), ("--delta", "creep ratios"), ("--alpha", "alphas, >= 1")):
        parser.add_argument(name, type=numbers, required=True, help=f"{meaning}, increasing")
    add_output_option(parser, ".nc", required=True)
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

    axes = {name: getattr(arguments, name) for name in ("kappa", "mu", "V", "delta", "alpha")}
    tables.save(tables.build(tables.LiteralGrid(**axes), progress=sys.stderr.isatty()), arguments.output)
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
