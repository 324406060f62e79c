"""Files of laws and grids, and FMUs: ``viscoroll tables``, ``export`` and ``fmu``."""

from __future__ import annotations

from argparse import ArgumentTypeError, Namespace
from pathlib import Path

import viscoroll as vr

from .arguments import FILE, SCENE, body_of, command, numbers, option, output

_LAW, _GRID = (".nc", ".cdf", ".h", ".json"), (".nc", ".cdf", ".csv", ".txt", ".mat")


def _low_high(text: str) -> tuple[float, ...]:
    """The numbers of LOW:HIGH."""
    try:
        return tuple(map(float, text.split(":")))
    except ValueError:
        raise ArgumentTypeError(f"{text!r} must be LOW:HIGH, for example 1:4096") from None


def _size(path: Path) -> None:
    print(f"{path}: {path.stat().st_size / 1e3:.0f} kB")


@command(
    "tables law",
    option("file", metavar="MATERIAL", nargs="?",
           help="TOML file with [material] (and [base]), [scene] or [cylinder], or netCDF file of a material"),
    option("--alpha", type=_low_high, metavar="LOW:HIGH", help="range of alpha, for example 1:4096; give it instead of MATERIAL"),
    output(*_LAW),
)  # fmt: skip
def law(given: Namespace) -> None:
    """Write the contact law of a material, of a pair, or of a range of alpha to a file.

    .nc is read by vr.load_law, by run files and by every netCDF reader; .cdf is the same without HDF5; .h is a header
    of C99 or C++ with table and evaluator; .json is read by JavaScript.  --alpha writes the law of one relaxation
    time for every alpha of the range.

    example:
      viscoroll tables law docs/examples/rubber.toml -o rubber.h
    """
    from ...io.config import read_law_source

    material = None if given.file is None else read_law_source(given.file)
    vr.tables.export(vr.tables.law(material, alpha=given.alpha), given.output)
    _size(given.output)


@command(
    "tables build", SCENE,
    option("--V", type=numbers, required=True, help="velocities of the axis, > 0"),
    option("--delta", type=numbers, required=True, help="values of the creepage"),
    option("--alpha", type=numbers, help="values of a third axis, only for a scene"),
    option("--method", default="table", help="table (default): law of the scene; direct: numerical roots of the equations of the paper"),
    output(*_GRID),
)  # fmt: skip
def build(given: Namespace) -> None:
    """Write a grid of the contact law on axes V, delta (and alpha) for look-up in other programs.

    The grid of a scene is dimensionless, the grid of a cylinder is in SI units.  Formats: .nc, .cdf (without HDF5),
    .csv, .txt (for Modelica) and .mat (MATLAB).  Axes are written as the numbers of `viscoroll contact`.

    example:
      viscoroll tables build paper-section-5 --V 1e-3:2:201:log --delta -0.04:0.04:401 -o t.nc
    """
    axes = {"delta": given.delta, "alpha": given.alpha}
    vr.tables.export(vr.tables.build(body_of(given.scene), given.V, **axes, method=given.method), given.output)
    _size(given.output)


@command("tables info", FILE)
def info(given: Namespace) -> None:
    """Print the contents of a table file: functions or grid, stated errors, material and provenance.

    example:
      viscoroll tables info data/tables/rubber.nc
    """
    print(vr.tables.info(given.file))


@command("tables validate", FILE, option("-n", type=int, default=10_000, help="number of random speeds (default 10000)"))
def validate(given: Namespace) -> int:
    """Compare a law file with the formulas of its relaxation modes at random speeds, or a grid with the law.

    The exit code is 1 if an error exceeds the error stated in the file.

    example:
      viscoroll tables validate data/tables/rubber.nc
    """
    from ...io.tables.check import Report, check_table

    report = Report(tuple(check_table(vr.tables.load(given.file), given.n, 0)), {"file": given.file, "points": given.n})
    print(report)
    return not report.ok


@command("export", FILE, output(*dict.fromkeys(_LAW + _GRID)))
def export(given: Namespace) -> None:
    """Convert the results of a run, or a table, to another file format.

    A results store (STORE.zarr) becomes .nc with summaries and stored motions.  A law becomes .nc, .cdf, .h or .json.
    A grid becomes .nc, .cdf, .csv, .txt or .mat.

    example:
      viscoroll export data/tables/rubber.nc -o rubber.h
    """
    if Path(given.file).is_dir():
        if given.output.suffix.lower() != ".nc":
            allowed = "a name that ends in .nc for the results of a run"
            raise vr.ParameterError("-o", str(given.output), allowed)
        vr.runs.export_netcdf(given.file, given.output)
    else:
        vr.tables.export(vr.tables.load(given.file), given.output)
    _size(given.output)


@command(
    "fmu",
    option("file", metavar="MATERIAL_OR_LAW",
           help="TOML file with [material] (and [base]), and perhaps [cylinder] with the default parameters; or a law file "
           "of `viscoroll tables law`; or the netCDF file of a material"),
    option("--model", default="Roller", help="Roller (default) or ContactElement"),
    option("--fmi", type=int, default=2, help="version of the standard: 2 (default) or 3"),
    output(".fmu"),
)  # fmt: skip
def fmu(given: Namespace) -> None:
    """Build an FMU of a cylinder, for Modelica tools and others.

    The FMU contains the law of a material or pair and its C sources, and is compiled for this machine by cc.
    Roller: inputs drive force and torque, outputs v, omega, x; for co-simulation and model exchange.
    ContactElement: inputs v, omega, load, outputs force, torque, moments; for model exchange.
    Both provide exact directional derivatives.

    example:
      viscoroll fmu docs/examples/rubber.toml -o roller.fmu
    """
    from ...core.sections import read_toml
    from ...io.config import read_law_source, read_roller
    from ...materials.law_store import is_law

    path = given.file
    if Path(path).suffix == ".nc":
        what = vr.load_law(path) if is_law(path) else read_law_source(path)
    else:
        what = read_roller(path) if "cylinder" in read_toml(path) else read_law_source(path)
    vr.fmu.build(what, given.output, given.model, given.fmi)
    _size(given.output)
