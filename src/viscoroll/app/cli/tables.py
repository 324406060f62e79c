"""Files of laws and grids, and FMUs: ``viscoroll tables``, ``export`` and ``fmu``."""

from __future__ import annotations

import sys
import warnings
from argparse import ArgumentTypeError, Namespace
from pathlib import Path

import viscoroll as vr

from .arguments import FILE, SCENE, command, numbers, option, output, roller_of_argument

#: Suffixes of the formats of a law.
_LAW = (".nc", ".cdf", ".h", ".json")
#: Suffixes of the formats of a grid.
_GRID = (".nc", ".cdf", ".csv", ".txt", ".mat")


def _low_high(text: str) -> tuple[float, ...]:
    """Convert an argument LOW:HIGH to a tuple of its numbers; :func:`viscoroll.tables.law` checks count and order.

    text: the argument.
    Returns the numbers between the colons, of which there may be more or fewer than two.
    Raises ArgumentTypeError for a part that is no number.
    """
    try:
        return tuple(map(float, text.split(":")))
    except ValueError:
        raise ArgumentTypeError(f"{text!r} must be LOW:HIGH, for example 1:4096") from None


def _print_size(path: Path) -> None:
    """Print the name and the size of a written file, in kB of 1000 bytes, on standard output.

    path: path of the file.
    """
    print(f"{path}: {path.stat().st_size / 1e3:.0f} kB")


@command(
    "tables law",
    option("file", metavar="MATERIAL", nargs="?",
           help="TOML file with [material] (and [base]), [scene] or [cylinder], netCDF file of a material, or name "
           "of a preset"),
    option("--alpha", type=_low_high, metavar="LOW:HIGH", help="range of alpha, for example 1:4096; it takes "
        "the place of MATERIAL"),
    output(*_LAW),
)  # fmt: skip
def law(arguments: Namespace) -> None:
    """Write the law of a material, pair or cover, or of every alpha of a range, and print the size of the file.

    arguments: parsed command line with
        file, path of a TOML file or of the netCDF of a material, name of a preset, or None;
        alpha, (low, high) of alpha, dimensionless, for the law of every alpha between, or None;
        output, path that is written; its suffix is the format: .nc, .cdf, .h or .json.
    Exactly one of file and alpha must be given.
    Raises ParameterError for both or none of file and alpha, a range out of bounds, a suffix in capital letters, and a
    name of a .h file that is no identifier of C; FileError for a file that cannot be read or written, and for .h of a
    range of alpha.
    """
    from ...io.config import read_law_source

    material = None if arguments.file is None else read_law_source(arguments.file)
    vr.tables.export(vr.tables.law(material, alpha=arguments.alpha), arguments.output)
    _print_size(arguments.output)


@command(
    "tables build", SCENE,
    option("--V", type=numbers, required=True, help="speeds of the grid, > 0, in m/s for a cylinder, as "
        "LOW:HIGH:COUNT[:log] or 0.1,0.2,0.4"),
    option("--delta", type=numbers, required=True, help="creepages of the grid, in the same form"),
    option("--alpha", type=numbers, help="values of alpha for a third axis of the grid, only for a scene"),
    option("--method", default="table", help="table (default): the law of the scene; direct: numerical roots "
        "of the equations of the paper"),
    output(*_GRID),
)  # fmt: skip
def build(arguments: Namespace) -> None:
    """Compute a grid of the contact over speed and creepage, write it, and print the size of the file.

    arguments: parsed command line with
        scene, path of a TOML file or name of a preset;
        V, nodes of the axis of speed, > 0, a number or (n,), in m/s of a cylinder, dimensionless of a scene;
        delta, nodes of the axis of creepage, a number or (m,), dimensionless;
        alpha, nodes of a third axis, a number or (k,), dimensionless, of a scene only, or None: two axes;
        method, "table" (if not given), the law of the scene, or "direct", roots of the equations of the paper;
        output, path that is written; its suffix is the format: .nc, .cdf, .csv, .txt or .mat.
    Raises ParameterError for nodes or a method that are not allowed, for .txt of a grid over several alphas, and for a
    suffix in capital letters; FileError for a file that cannot be read or written.
    """
    axes = {name: getattr(arguments, name) for name in ("V", "delta", "alpha", "method")}
    vr.tables.export(vr.tables.build(roller_of_argument(arguments.scene), **axes), arguments.output)
    _print_size(arguments.output)


@command(
    "tables grid", SCENE,
    option("--method", default="coupled", choices=("coupled",), help="coupled (default): pressure and shear are solved "
           "together"),
    option("--nodes", type=int, nargs=2, metavar=("SPEEDS", "CREEPS"), help="numbers of nodes (default: 32 for five "
           "decades of speed, 33)"),
    output(".nc", ".cdf"),
)  # fmt: skip
def grid(arguments: Namespace) -> None:
    """Compute the coupled solution of a roller over speed and creep as a law, write it, and print the size of the file.

    arguments: parsed command line with
        scene, path of a TOML file or name of a preset;
        method, "coupled";
        nodes, [over speed, over creep], or None;
        output, path that is written; its suffix is the format: .nc or .cdf.
    Raises ParameterError for numbers of nodes, FileError for a file that cannot be read or written.
    """
    nodes = None if arguments.nodes is None else tuple(arguments.nodes)
    roller = roller_of_argument(arguments.scene)
    table = vr.tables.build(roller, method="coupled", nodes=nodes, progress=sys.stderr.isatty())
    vr.tables.export(table, arguments.output)
    _print_size(arguments.output)


@command("tables info", FILE)
def info(arguments: Namespace) -> None:
    """Print the summary of a table file on standard output: its functions or axes and fields, their errors, its origin.

    arguments: parsed command line with file, path of a law or a grid.
    Returns None; the lines are those of :func:`viscoroll.tables.info`.
    Raises FileError for a file that cannot be read or is no table.
    """
    print(vr.tables.info(arguments.file))


@command(
    "tables validate", FILE, option("-n", type=int, default=10_000, help="number of random speeds (default: 10000)")
)
def validate(arguments: Namespace) -> int:
    """Check a table file at random points and print the differences.

    A law is compared with the formulas of its relaxation modes, that of a cover with solves of the contact, and a grid
    with the law.  The points are the same in every call: their seed is 0.

    arguments: parsed command line with
        file, path of a law or a grid;
        n, number of random points, a whole number >= 1, 10000 if not given.
    Returns True, exit code 1, if an error is larger than its check allows (twice the error that the file states,
    and rounding; of a grid at most half of the largest value of the field), else False, exit code 0.
    Raises ParameterError for n, FileError for a file that cannot be read or is no table, and for a grid of a material
    or a cylinder.
    """
    from ...io.tables.check import Report, check_table

    about = {"file": arguments.file, "points": arguments.n}
    report = Report(tuple(check_table(vr.tables.load(arguments.file), arguments.n, 0)), about)
    print(report)
    return not report.ok


@command("export", FILE, output(*dict.fromkeys(_LAW + _GRID)))
def export(arguments: Namespace) -> None:
    """Write the results of a run, or a table, in another format, and print the size of the new file.

    arguments: parsed command line with
        file, path of a folder with the results of a run, or of a law or a grid;
        output, path that is written; its suffix is the format: .nc of results, .nc, .cdf, .h or .json of a law, .nc,
        .cdf, .csv, .txt or .mat of a grid.
    Raises ParameterError for a suffix that the content does not have, and as :func:`law` and :func:`build` for .h and
    .txt; FileError for a file that cannot be read or written, is damaged, or for results that are not finished;
    MissingDependencyError for results without zarr.
    """
    path = arguments.output
    if not Path(arguments.file).is_dir():
        vr.tables.export(vr.tables.load(arguments.file), path)
    elif path.suffix.lower() == ".nc":
        vr.runs.export_netcdf(arguments.file, path)
    else:
        raise vr.ParameterError("-o", str(path), "a name that ends in .nc for the results of a run")
    _print_size(path)


@command(
    "fmu",
    option("file", metavar="MATERIAL_OR_LAW",
           help="TOML with [material], perhaps [base], and perhaps [cylinder], whose numbers are the start values; the "
           "file of `viscoroll tables law`; the netCDF of a material; or the name of a preset"),
    option("--model", default="Roller", help="Roller (default) or ContactElement"),
    option("--fmi", type=int, default=2, help="version of the standard: 2 (default) or 3"),
    output(".fmu"),
)  # fmt: skip
def fmu(arguments: Namespace) -> None:
    """Build an FMU of a cylinder or a law, and print the size of the file.

    The numbers of a cylinder become the start values of the FMU.  Of a dimensionless scene the FMU has the law alone,
    and a ModelWarning says that its other numbers are not used.

    arguments: parsed command line with
        file, path of a TOML file with a cylinder, a material or a scene, or of the netCDF (.nc) of a law or a material,
            or name of a preset;
        model, "Roller" (if not given) or "ContactElement";
        fmi, version of the standard, 2 (if not given) or 3;
        output, path of the FMU that is written.
    Raises ParameterError for another model or version, FileError for a file that cannot be read or written, and
    MissingDependencyError without fmpy or a C compiler.
    """
    from ...io.config import SCENES, read_law_source, read_sections
    from ...materials.law_file import is_law

    path = arguments.file
    content = read_sections(path)
    source = vr.load_law(path) if not content and is_law(path) else read_law_source(path)
    vr.fmu.build(source, arguments.output, arguments.model, arguments.fmi)
    if "cylinder" not in content and content.keys() & set(SCENES):
        text = "an FMU is in SI units: kappa, mu, gamma and j of the dimensionless scene are not used; set R, "
        warnings.warn(f"{text}E_prime, T_ref, mu, load and mass in the tool", vr.ModelWarning, stacklevel=2)
    _print_size(arguments.output)
