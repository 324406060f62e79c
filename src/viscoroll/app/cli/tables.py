"""Files of laws and grids, and FMUs: ``viscoroll tables``, ``export`` and ``fmu``."""

from __future__ import annotations

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
    """Return the numbers of LOW:HIGH; raise ArgumentTypeError."""
    try:
        return tuple(map(float, text.split(":")))
    except ValueError:
        raise ArgumentTypeError(f"{text!r} must be LOW:HIGH, as 1:4096") from None


def _print_size(path: Path) -> None:
    """Print the name and the size of a written file."""
    print(f"{path}: {path.stat().st_size / 1e3:.0f} kB")


@command(
    "tables law",
    option("file", metavar="MATERIAL", nargs="?",
           help="TOML with [material], perhaps [base], or with [scene] or [cylinder]; or the netCDF of a material"),
    option("--alpha", type=_low_high, metavar="LOW:HIGH", help="in place of MATERIAL: range of alpha, as 1:4096"),
    output(*_LAW),
)  # fmt: skip
def law(arguments: Namespace) -> None:
    """File of the law of a material, pair or cover, or of every alpha.

    For vr.load_law, run files and every program that reads netCDF (.nc; .cdf without HDF5); as table and evaluator in
    one header of C99 or C++ (.h); or as .json.  --alpha writes the law of every alpha of one relaxation time.

    example:
      viscoroll tables law docs/examples/rubber.toml -o rubber.h
    """
    from ...io.config import read_law_source

    material = None if arguments.file is None else read_law_source(arguments.file)
    vr.tables.export(vr.tables.law(material, alpha=arguments.alpha), arguments.output)
    _print_size(arguments.output)


@command(
    "tables build", SCENE,
    option("--V", type=numbers, required=True, help="speeds of the axis, > 0"),
    option("--delta", type=numbers, required=True, help="creepages"),
    option("--alpha", type=numbers, help="a third axis, of a scene"),
    option("--method", default="table", help="table (default), or direct: root solves of the printed equations"),
    output(*_GRID),
)  # fmt: skip
def build(arguments: Namespace) -> None:
    """Grid over V, delta and perhaps alpha, for programs that look up tables.

    The contact of a scene, or of a cylinder in SI units, as .nc, .cdf (without HDF5), .csv, .txt (for Modelica) or
    .mat (MATLAB).  Axes are numbers, as of `viscoroll contact`.

    example:
      viscoroll tables build paper-section-5 --V 1e-3:2:201:log --delta -0.04:0.04:401 -o t.nc
    """
    axes = {name: getattr(arguments, name) for name in ("V", "delta", "alpha", "method")}
    vr.tables.export(vr.tables.build(roller_of_argument(arguments.scene), **axes), arguments.output)
    _print_size(arguments.output)


@command("tables info", FILE)
def info(arguments: Namespace) -> None:
    """Content of a table file: functions or grid, stated errors, material and provenance.

    example:
      viscoroll tables info data/tables/rubber.nc
    """
    print(vr.tables.info(arguments.file))


@command("tables validate", FILE, option("-n", type=int, default=10_000, help="random speeds (default: 10000)"))
def validate(arguments: Namespace) -> int:
    """Check of a law file against the formulas of its relaxation modes at random speeds, or of a grid against the law.

    Exit code 1 if an error is larger than the file states.

    example:
      viscoroll tables validate data/tables/rubber.nc
    """
    from ...io.tables.check import Report, check_table

    about = {"file": arguments.file, "points": arguments.n}
    report = Report(tuple(check_table(vr.tables.load(arguments.file), arguments.n, 0)), about)
    print(report)
    return not report.ok


@command("export", FILE, output(*dict.fromkeys(_LAW + _GRID)))
def export(arguments: Namespace) -> None:
    """Results of a run, or a table, as a file for other programs.

    The summaries of STORE.zarr, and all motions that it keeps, as .nc; a law as .nc, .cdf, .h or .json; a grid as .nc,
    .cdf, .csv, .txt or .mat.

    example:
      viscoroll export data/tables/rubber.nc -o rubber.h
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
           "file of `viscoroll tables law`; or the netCDF of a material"),
    option("--model", default="Roller", help="Roller (default) or ContactElement"),
    option("--fmi", type=int, default=2, help="version of the standard: 2 (default) or 3"),
    output(".fmu"),
)  # fmt: skip
def fmu(arguments: Namespace) -> None:
    """Cylinder as an FMU, for Modelica tools and others.

    With the law of a material, pair or cover, and its sources, compiled for this machine by cc.
    Roller: drive force and torque -> v, omega, x; co-simulation and model exchange.
    ContactElement: v, omega, load -> force, torque, moments; model exchange.  Both have exact slopes.

    example:
      viscoroll fmu docs/examples/rubber.toml -o roller.fmu
    """
    from ...core.sections import read_toml
    from ...io.config import SCENES, read_law_source, read_roller
    from ...materials.law_file import is_law

    path = arguments.file
    content = {} if Path(path).suffix == ".nc" else read_toml(path)
    if not content and is_law(path):
        source = vr.load_law(path)
    else:
        source = read_roller(path) if "cylinder" in content else read_law_source(path)
    vr.fmu.build(source, arguments.output, arguments.model, arguments.fmi)
    if "cylinder" not in content and content.keys() & set(SCENES):
        text = "an FMU is in SI units: of a dimensionless scene it takes the law, not kappa, mu, gamma and j; set R, "
        warnings.warn(f"{text}E_prime, T_ref, mu, load and mass in the tool", vr.ModelWarning, stacklevel=2)
    _print_size(arguments.output)
