"""``viscoroll tables law|build|export|info|validate``."""

from __future__ import annotations

from argparse import Namespace
from typing import Any

from .arguments import NUMBERS, add_output_option, add_scene, body_of, count, number, numbers, whole

_LAW, _GRID = (".nc", ".h", ".json"), (".nc", ".csv", ".txt", ".mat")


def add_commands(commands: Any) -> None:
    """Add the group to the program."""
    group = commands.add_parser(
        "tables",
        help="the law of a material as a file, grids for other programs",
        description="The contact law of a material as a file or a header of C, and on grids.",
        epilog="example:\n  viscoroll tables law docs/examples/rubber.toml -o rubber.nc",
    ).add_subparsers(metavar="COMMAND", required=True)
    for add in (_add_law, _add_build, _add_export, _add_info, _add_validate):
        add(group)


def _add_law(group: Any) -> None:
    parser = group.add_parser(
        "law",
        help="the law of a material or pair, or of every alpha, as a file, exact",
        description="Write the contact law of a material, or of a pair: for vr.load_law, run files and every program\n"
        "that reads netCDF (.nc), as table and evaluator in one header of C99 or C++ (.h), or as .json.  Without a\n"
        "material, of every alpha of one relaxation time (.nc).",
        epilog="example:\n  viscoroll tables law docs/examples/rubber.toml -o rubber.h",
    )
    parser.add_argument(
        "file", metavar="MATERIAL", nargs="?",
        help="TOML with [material], perhaps [base], or with [scene] or [cylinder]; or the netCDF of a material",
    )  # fmt: skip
    parser.add_argument(
        "--temperature", type=number, metavar="T", help="degrees Celsius, by the wlf or arrhenius of the file"
    )
    parser.add_argument(
        "--alpha", type=_low_high, metavar="LOW:HIGH", help="in place of MATERIAL: from which alpha to which, as 1:4096"
    )
    add_output_option(parser, *_LAW, required=True)
    parser.set_defaults(run=_law)


def _add_build(group: Any) -> None:
    parser = group.add_parser(
        "build",
        help="a grid over V, delta and perhaps alpha, for programs that look up tables",
        description="Write the contact of a scene, or of a cylinder in SI units, on a grid: .nc, .csv, .txt (for\n"
        f"Modelica) or .mat (MATLAB).  An axis is {NUMBERS}.",
        epilog="example:\n  viscoroll tables build paper-section-5 --V 1e-3:2:201:log --delta -0.04:0.04:401 -o t.nc",
    )
    add_scene(parser)
    parser.add_argument("--V", type=numbers, required=True, help="speeds of the axis, > 0")
    parser.add_argument("--delta", type=numbers, required=True, help="creep ratios")
    parser.add_argument("--alpha", type=numbers, help="a third axis, of a scene")
    add_output_option(parser, *_GRID, required=True)
    parser.set_defaults(run=_build)


def _add_export(group: Any) -> None:
    parser = group.add_parser(
        "export",
        help="a table file in the format of another program",
        description="Write the file of a law (.h, .json) or of a grid (.csv, .txt, .mat) for another program.",
        epilog="example:\n  viscoroll tables export data/tables/rubber.nc -o rubber.h",
    )
    parser.add_argument("file", metavar="FILE")
    parser.add_argument("--format", help="netcdf3, of an .nc for readers without HDF5")
    add_output_option(parser, *dict.fromkeys(_LAW + _GRID), required=True)
    parser.set_defaults(run=_export)


def _add_info(group: Any) -> None:
    parser = group.add_parser(
        "info",
        help="what a table file holds",
        description="Functions or grid, stated errors, material and provenance of a table file, verified.",
        epilog="example:\n  viscoroll tables info data/tables/rubber.nc",
    )
    parser.add_argument("file", metavar="FILE")
    parser.set_defaults(run=_info)


def _add_validate(group: Any) -> None:
    parser = group.add_parser(
        "validate",
        help="compare the file of a law with the formulas of its modes",
        description="Compare the file of a law with the formulas of its relaxation modes at random speeds; exit\n"
        "code 1 where an error exceeds that which the file states.",
        epilog="example:\n  viscoroll tables validate data/tables/rubber.nc",
    )
    parser.add_argument("file", metavar="FILE")
    parser.add_argument("-n", type=count, default=10_000, help="random places (default 10000)")
    parser.add_argument("--seed", type=whole, default=0, help="seed of the random places (default 0)")
    parser.set_defaults(run=_validate)


def _law(arguments: Namespace) -> int:
    from ...core.errors import ParameterError
    from ...io import tables
    from ...io.config import read_bodies

    if arguments.alpha is not None and arguments.temperature is not None:
        raise ParameterError("temperature", arguments.temperature, "left out beside --alpha")
    given = None if arguments.file is None else read_bodies(arguments.file, arguments.temperature)
    _deliver(tables.law(given, alpha=arguments.alpha), arguments)
    return 0


def _low_high(text: str) -> tuple[float, float]:
    """Two numbers."""
    low, _, high = text.partition(":")
    return number(low), number(high)


def _build(arguments: Namespace) -> int:
    from ...io import tables

    what = body_of(arguments.scene)
    _deliver(tables.build(what, arguments.V, arguments.delta, arguments.alpha), arguments)
    return 0


def _export(arguments: Namespace) -> int:
    from ...io import tables

    _deliver(tables.load(arguments.file), arguments, arguments.format)
    return 0


def _deliver(table: Any, arguments: Namespace, format: str | None = None) -> None:
    from ...io import tables

    tables.export(table, arguments.output, format)
    print(f"{arguments.output}: {arguments.output.stat().st_size / 1e3:.0f} kB")


def _info(arguments: Namespace) -> int:
    from ...io import tables

    print(tables.info(arguments.file))
    return 0


def _validate(arguments: Namespace) -> int:
    from ...io import tables
    from ...io.tables.check import Report, check_table

    checks = check_table(tables.load(arguments.file), arguments.n, arguments.seed)
    report = Report(tuple(checks), {"file": arguments.file, "points": arguments.n, "seed": arguments.seed})
    print(report)
    return 0 if report.ok else 1
