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
        raise ArgumentTypeError(f"{text!r} must be LOW:HIGH, as 1:4096") from None


def _size(path: Path) -> None:
    print(f"{path}: {path.stat().st_size / 1e3:.0f} kB")


@command(
    "tables law",
    option("file", metavar="MATERIAL", nargs="?",
           help="TOML with [material], perhaps [base], or with [scene] or [cylinder]; or the netCDF of a material"),
    option("--alpha", type=_low_high, metavar="LOW:HIGH", help="in place of MATERIAL: from alpha to alpha, as 1:4096"),
    output(*_LAW),
)  # fmt: skip
def law(given: Namespace) -> None:
    """The law of a material or pair, or of every alpha, as a file, exact.

    For vr.load_law, run files and every program that reads netCDF (.nc; .cdf without HDF5), as table and evaluator in
    one header of C99 or C++ (.h), or as .json.  Without a material, of every alpha of one relaxation time.

    example:
      viscoroll tables law docs/examples/rubber.toml -o rubber.h
    """
    from ...io.config import read_law_source

    material = None if given.file is None else read_law_source(given.file)
    vr.tables.export(vr.tables.law(material, alpha=given.alpha), given.output)
    _size(given.output)


@command(
    "tables build", SCENE,
    option("--V", type=numbers, required=True, help="speeds of the axis, > 0"),
    option("--delta", type=numbers, required=True, help="creep ratios"),
    option("--alpha", type=numbers, help="a third axis, of a scene"),
    option("--method", default="table", help="table (default) or direct: root solves of the printed equations"),
    output(*_GRID),
)  # fmt: skip
def build(given: Namespace) -> None:
    """A grid over V, delta and perhaps alpha, for programs that look up tables.

    Of the contact of a scene, or of a cylinder in SI units: .nc, .cdf (without HDF5), .csv, .txt (for Modelica) or
    .mat (MATLAB).  Axes are numbers, as of `viscoroll contact`.

    example:
      viscoroll tables build paper-section-5 --V 1e-3:2:201:log --delta -0.04:0.04:401 -o t.nc
    """
    axes = {"delta": given.delta, "alpha": given.alpha}
    vr.tables.export(vr.tables.build(body_of(given.scene), given.V, **axes, method=given.method), given.output)
    _size(given.output)


@command("tables info", FILE)
def info(given: Namespace) -> None:
    """What a table file holds: functions or grid, stated errors, material and provenance.

    example:
      viscoroll tables info data/tables/rubber.nc
    """
    print(vr.tables.info(given.file))


@command("tables validate", FILE, option("-n", type=int, default=10_000, help="random speeds (default 10000)"))
def validate(given: Namespace) -> int:
    """The file of a law against the formulas of its relaxation modes, at random speeds; a grid against the law.

    Exit code 1 where an error exceeds that which the file states.

    example:
      viscoroll tables validate data/tables/rubber.nc
    """
    from ...io.tables.check import Report, check_table

    report = Report(tuple(check_table(vr.tables.load(given.file), given.n, 0)), {"file": given.file, "points": given.n})
    print(report)
    return not report.ok


@command("export", FILE, output(*dict.fromkeys(_LAW + _GRID)))
def export(given: Namespace) -> None:
    """The results of a run or a table in a file for other programs.

    Of STORE.zarr the summaries, and all motions that it keeps, as .nc; of a law .nc, .cdf, .h or .json; of a grid .nc,
    .cdf, .csv, .txt or .mat.

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
           help="TOML with [material], perhaps [base] and a [cylinder], whose numbers are those at the start; the file "
           "of `viscoroll tables law`; or the netCDF of a material"),
    option("--model", default="Roller", help="Roller (default) or ContactElement"),
    option("--fmi", type=int, default=2, help="version of the standard: 2 (default) or 3"),
    output(".fmu"),
)  # fmt: skip
def fmu(given: Namespace) -> None:
    """A cylinder as an FMU, for Modelica tools and others.

    By the law of a material or pair, with its sources, compiled for this machine by cc.
    Roller: drive force and torque -> v, omega, x; co-simulation and model exchange.
    ContactElement: v, omega, load -> force, torque, moments; model exchange.  Both have exact slopes.

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
