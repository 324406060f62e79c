"""Commands that make and convert files: of materials and measurements (``viscoroll material`` and
``identify``), of laws and grids, and FMUs (``viscoroll tables``, ``export`` and ``fmu``).
"""

from __future__ import annotations

import json
import sys
import warnings
from argparse import ArgumentTypeError, Namespace
from dataclasses import replace
from pathlib import Path
from typing import Any

import viscoroll as vr

from ..core import described_error, write_dataset, write_text
from .arguments import (
    FIGURES,
    FILE,
    SCENE,
    as_text,
    command,
    numbers,
    option,
    output,
    roller_of_argument,
)

# --- Materials and measurements ---


@command(
    "material show",
    option(
        "file",
        metavar="FILE",
        help="TOML file with [material], [base] or both, or netCDF file of a material",
    ),
)
def show(arguments: Namespace) -> None:
    """Print moduli, relaxation modes and creep modes of the materials of a file.

    The values are those at the temperature that the file states, if it states one.

    example:
      viscoroll samples
      viscoroll material show samples/rubber.toml

    arguments: parsed command line with file, path of a TOML file with [material] or [base], or of
        the netCDF (.nc) of a material.
    Raises FileError for a file that cannot be read, that has no material, or with a value that is
    not allowed.

    Moduli are in Pa, times in s.  Relaxation modes are printed as strengths E_i, divided by the
    long-time modulus, and times tau_i, creep modes as strengths J_i, divided by the long-time
    compliance, and times T_i; above them stands T_mean = sum J_i T_i, with M/P = V T_mean at low
    speeds.  An elastic material has none of these.
    """
    import pandas as pd

    from ..core import as_text as summary_text
    from ..materials import read_materials

    for section, material in read_materials(arguments.file).items():
        print(f"[{section}] {summary_text(*material._summary())}\n")
        series = material.prony
        T = material.T_ref
        if series.E.size:
            columns = {
                "E_i": series.E,
                "tau_i [s]": series.tau * T,
                "J_i": series.J,
                "T_i [s]": series.T * T,
            }
            heading = "Slow rolling on a half-space of this material: M/P = V T_mean (M: rolling "
            heading += f"moment, P: load), with T_mean = {series.T_mean * T:.6g} s"
            print(as_text(pd.DataFrame(columns), heading))


def _named_heading(text: str, form: str = "NAME=HEADING, as 'storage=Module 1'") -> tuple[str, str]:
    """Convert an argument NAME=HEADING to (quantity, heading); :func:`viscoroll.read_dma` checks
    the quantity.

    text: the argument, as "storage=Module 1"; the heading may have further equals signs.
    form: form of the argument, for the error.
    Returns (text before the first equals sign, text after it), both without blanks at their ends.
    Raises ArgumentTypeError where there is no equals sign or no heading.
    """
    name, _, heading = map(str.strip, text.partition("="))
    if not heading:
        raise ArgumentTypeError(f"{text!r} must be {form}")
    return name, heading


def _units(text: str) -> Any:
    """Convert the argument of --units to the units of :func:`viscoroll.read_dma`.

    text: "F,M", which becomes a tuple, or "NAME=UNIT,...", a dict name -> unit.
    Raises ArgumentTypeError for a part without "=" behind a first one with it.
    """
    parts = text.split(",")
    units = (_named_heading(part, "NAME=UNIT, as storage=MPa") for part in parts)
    return dict(units) if "=" in parts[0] else tuple(parts)


@command(
    "material fit",
    option("data", metavar="DATA", help="text file with columns"),
    option(
        "--units",
        type=_units,
        metavar="F,M",
        help="units of frequency and moduli, if the file states none, for example Hz,MPa; "
        "or NAME=UNIT,... in place of units that the file states, for example storage=MPa",
    ),
    option(
        "--column",
        type=_named_heading,
        metavar="NAME=HEADING",
        action="append",
        default=[],
        help="quantity and heading of a column, for example 'storage=Module 1'; may be repeated",
    ),
    option("--decimal", choices=(".", ","), help="decimal mark (default: found from the numbers)"),
    option("--encoding", help="encoding of the file (default: found from its first bytes)"),
    option(
        "--mode",
        choices=("tension", "shear"),
        help="type of the moduli, if the headings do not state it (default: tension)",
    ),
    option(
        "--temperature",
        type=float,
        metavar="T",
        help="temperature of all points, degrees Celsius (default: as in the file)",
    ),
    option(
        "--reference",
        type=float,
        metavar="T",
        help="reference temperature of data at several temperatures, degrees Celsius",
    ),
    option(
        "--wlf",
        metavar="C1,C2,T0",
        help="WLF parameters, T0 in degrees Celsius (default: the curves are shifted to overlap)",
    ),
    option(
        "--on",
        choices=("both", "storage"),
        default="both",
        help="moduli whose overlap determines the shift of the curves (default: both)",
    ),
    option("--modes", type=int, help="most Prony terms (default: as few as --misfit needs)"),
    option(
        "--misfit",
        type=float,
        default=0.01,
        help="allowed root mean square of the relative errors of the fit (default: 0.01)",
    ),
    option(
        "--nu", type=float, default=0.49, help="Poisson's ratio, constant in time (default: 0.49)"
    ),
    option("--name", default="", help="name of the material"),
    option(
        "--force",
        action="store_true",
        help="write the file even if the misfit exceeds --misfit, and state that in the file",
    ),
    output(".toml", ".nc", required=False),
)
def fit(arguments: Namespace) -> int:
    """Fit a material to DMA data.

    The command fits a Prony series to columns of frequency, storage modulus and loss modulus, with units in their
    headings, and prints how well the data determine it.  With -o it writes a [material] of a TOML file, or netCDF.

    The exit code is 1 and no file is written if the misfit exceeds --misfit or 5 %.
    With --force the exit code is 0 and the file is written; the source of the data in it states the misfit.

    example:
      viscoroll samples
      viscoroll material fit samples/dma.csv --nu 0.49 -o rubber.toml

    arguments: parsed command line with the options above, None where they are not given and have no
        default; units as :func:`_units` returns them; column, a list of (quantity, heading),
        perhaps empty; wlf, "C1,C2,T0"; output, path that is written, .toml or .nc, or None: nothing
        is written; force, whether a faulty fit is written too, with a mark in its source.
    Returns 1, and writes nothing, if the fit is faulty and force is not given; else 0.
    Raises ParameterError for values that are not allowed, FileError for a file that cannot be read
    or written.

    A fit is faulty if its misfit is above the required one or 5 %; standard error then says so.
    """  # noqa: E501
    from ..contact_mechanics import MISFIT_LIMIT
    from ..materials import material_as_toml

    record = vr.read_dma(
        arguments.data,
        columns=dict(arguments.column),
        decimal=arguments.decimal,
        encoding=arguments.encoding,
        units=arguments.units,
    )
    stated = tuple(note for note in record.notes if "is assumed, since" not in note)
    if arguments.mode and stated != record.notes:
        record = replace(record, mode=arguments.mode, notes=stated)
    options = {
        name: getattr(arguments, name)
        for name in ("modes", "misfit", "temperature", "reference", "on", "mode")
    }
    result = vr.fit_prony(record, **options, shift=arguments.wlf and _wlf(arguments.wlf))
    print(record, result, sep="\n")
    path = arguments.output
    fault = result._fault
    if fault and not arguments.force:
        # a misfit above 5 % is a fault with any --misfit
        advice = "raise --misfit, or " * (result.largest_misfit <= MISFIT_LIMIT)
        refusal = f"; {path} is not written: {advice}write it with --force" if path else ""
        print(f"viscoroll: {fault}{refusal}", file=sys.stderr)
        return 1
    material = result.material(arguments.nu, name=arguments.name)
    if fault:
        measured: Any = material.measured
        material = replace(
            material, measured=replace(measured, source=f"{measured.source}; forced: {fault}")
        )
    if path and path.suffix.lower() == ".nc":
        material.to_netcdf(path)
    elif path:
        write_text(path, material_as_toml(material))
    return 0


def _wlf(text: str) -> vr.WLF:
    """Return the time-temperature shift of the option --wlf, a :class:`viscoroll.WLF`.

    text: "C1,C2,T0": C1 dimensionless, C2 in K, T0 in degrees Celsius.
    Raises ParameterError for another form, and for values that :class:`viscoroll.WLF` refuses.
    """
    try:
        C1, C2, T0 = map(float, text.split(","))
    except ValueError:
        raise vr.ParameterError(
            "--wlf", repr(text), "C1,C2,T0: three numbers, T0 in degrees Celsius"
        ) from None
    return vr.WLF(C1=C1, C2=C2, T0=T0)


@command(
    "identify",
    option(
        "file",
        metavar="DATA.toml",
        help="TOML file that states known and unknown parameters and the files of measurements",
    ),
    option(
        "--starts",
        type=int,
        default=8,
        help="number of searches: from the given values, and from random points (default: 8)",
    ),
    option("--seed", type=int, default=0, help="seed of the random points (default: 0)"),
    option("--robust", action="store_true", help="give outliers less weight"),
    output(*FIGURES, name="--plot", required=False, more=": data, fit and their differences"),
    output(".txt", ".json", ".nc", required=False, more="; the report is printed too"),
)
def identify(arguments: Namespace) -> None:
    """Identify friction, modulus, relaxation times and moduli, and bearing friction, from measurements.

    The command fits unknown parameters of a cylinder to measured rolling resistance, traction and motions, and states
    which of the parameters the data do not determine.  The file has [cylinder], perhaps [material] and [base], and
      [unknown]  NAME = [LOW, HIGH]: limits of an unknown; [cylinder] and [material] have the initial values
      [prior]    optional, NAME = [VALUE, STANDARD DEVIATION]: what is known of an unknown beforehand
      [[data]]   a test: kind = "resistance", "traction" or "coastdown"; file = a CSV with columns V, M, F, delta, Q, t,
                 omega, x, or named by columns = { M = "HEADING" }; optional: sigma, load, temperature, name, V0, ...

    example:
      viscoroll samples
      viscoroll identify samples/measured.toml --plot fit.png

    arguments: parsed command line with the options above; output, path of the report that is
        written, .txt (the text printed), .json or .nc, or None; plot, path of the figure, or None.
    Returns None, exit code 0, also where the report warns of the model or the data.  A progress bar
    is drawn on standard error if that is a terminal.
    Raises ParameterError for values that are not allowed, FileError for a file that cannot be read
    or written.
    """  # noqa: E501
    from ..measurements.identification_report import as_json
    from ..measurements.identify import read_measurements

    options = {name: getattr(arguments, name) for name in ("robust", "starts", "seed")}
    result = vr.identify(
        **read_measurements(arguments.file), **options, progress=sys.stderr.isatty()
    )
    print(result)
    path = arguments.output
    suffix = path and path.suffix.lower()  # None without a path
    if suffix == ".nc":
        write_dataset(result.to_xarray(), path)
    elif suffix == ".json":
        write_text(path, json.dumps(as_json(result), indent=1, allow_nan=False) + "\n")
    elif path:
        write_text(path, f"{result}\n")
    if arguments.plot is not None:
        result.plot(arguments.plot)


# --- Files of laws and grids, and FMUs ---

#: Suffixes of the formats of a law.
_LAW = (".nc", ".cdf", ".h", ".json")
#: Suffixes of the formats of a grid.
_GRID = (".nc", ".cdf", ".csv", ".txt", ".mat")


def _low_high(text: str) -> tuple[float, ...]:
    """Convert an argument LOW:HIGH to a tuple of its numbers; :func:`viscoroll.tables.law` checks
    count and order.

    text: the argument.
    Returns the numbers between the colons, of which there may be more or fewer than two.
    Raises ArgumentTypeError for a part that is no number.
    """
    try:
        return tuple(map(float, text.split(":")))
    except ValueError:
        raise ArgumentTypeError(f"{text!r} must be LOW:HIGH, for example 1:4096") from None


def _export(table: Any, path: Path) -> None:
    """Write a law or a grid, a dataset ``table``, in the format of the suffix of a ``path``, and
    print the size of the file.
    """
    vr.tables.export(table, path)
    _print_size(path)


def _print_size(path: Path) -> None:
    """Print the name and the size of the written file at ``path``, in kB of 1000 bytes."""
    print(f"{path}: {path.stat().st_size / 1e3:.0f} kB")


@command(
    "tables law",
    option(
        "file",
        metavar="MATERIAL",
        nargs="?",
        help="TOML file with [material] (and [base]), [scene] or [cylinder], netCDF file of a "
        "material, or name of a preset",
    ),
    option(
        "--alpha",
        type=_low_high,
        metavar="LOW:HIGH",
        help="range of alpha, for example 1:4096; it takes the place of MATERIAL",
    ),
    output(*_LAW),
)
def law(arguments: Namespace) -> None:
    """Write the contact law of a material, pair, cover or range of alpha to a file.

    .nc is read by vr.load_law, run files and every netCDF reader; .cdf is the same without HDF5; .h is a header of C99
    or C++; .json is for JavaScript.  --alpha writes the law of one relaxation time for every alpha of a range.  For a
    cover, and for half-spaces with Dundurs' constant above 0.05, it is the fast law (coupled = false).

    example:
      viscoroll samples
      viscoroll tables law samples/rubber.toml -o rubber.h

    arguments: parsed command line with either file, path of a TOML file or of the netCDF of a
        material, or name of a preset, or alpha, (low, high), for the law of every alpha between;
        and output, path that is written; its suffix is the format.
    Raises ParameterError for both or none of file and alpha, a range out of bounds, and a name of a
    .h file that is no identifier of C or in capitals; FileError for a file that fails.
    """  # noqa: E501
    from ..presets import read_law_source

    file = arguments.file
    if file and arguments.alpha:
        found = f"is given beside {file}, which has a material of its own"
        raise described_error("--alpha", found, "left out")
    material = None if file is None else read_law_source(file)
    _export(vr.tables.law(material, alpha=arguments.alpha), arguments.output)


@command(
    "tables build",
    SCENE,
    option(
        "--V",
        type=numbers,
        required=True,
        help="speeds of the grid, > 0, in m/s for a cylinder, as "
        "LOW:HIGH:COUNT[:log] or 0.1,0.2,0.4",
    ),
    option("--delta", type=numbers, required=True, help="creepages of the grid, in the same form"),
    option(
        "--alpha",
        type=numbers,
        help="values of alpha for a third axis of the grid, only for a scene",
    ),
    option(
        "--method",
        default="table",
        help="table (default): the law of the roller; direct: numerical solution "
        "of the equations at each point of the grid, for half-spaces of one relaxation time",
    ),
    output(*_GRID),
)
def build(arguments: Namespace) -> None:
    """Write a grid of the contact law on axes V, delta (and alpha) for look-up in other programs.

    The grid of a scene is dimensionless, the grid of a cylinder is in SI units.  Formats: .nc, .cdf (without HDF5),
    .csv, .txt (for Modelica) and .mat (MATLAB).  Axes are written as the numbers of `viscoroll contact`.  Covers, and
    half-spaces with Dundurs' constant above 0.05, are those of the coupled solution, unless the file has coupled = false.

    example:
      viscoroll tables build paper-section-5 --V 1e-3:2:201:log --delta -0.04:0.04:401 -o t.nc

    arguments: parsed command line with
        scene, path of a TOML file or name of a preset;
        V, delta, alpha, nodes of the axes, a number or a vector each, alpha perhaps None;
        method, "table" or "direct";
        output, path that is written; its suffix is the format.
    Raises ParameterError for nodes or a method that are not allowed, for .txt of a grid over
    several alphas, and for a suffix in capital letters; FileError for a file that fails.
    """  # noqa: E501
    axes = {name: getattr(arguments, name) for name in ("V", "delta", "alpha", "method")}
    _export(vr.tables.build(roller_of_argument(arguments.scene), **axes), arguments.output)


@command(
    "tables grid",
    SCENE,
    option(
        "--method",
        default="coupled",
        choices=("coupled",),
        help="coupled (default): pressure and shear are solved together",
    ),
    option(
        "--nodes",
        type=int,
        nargs=2,
        metavar=("SPEEDS", "CREEPS"),
        help="numbers of speeds and of creepages (default: 5 to 13 in a decade of speed, and 27)",
    ),
    output(".nc", ".cdf", ".h"),
)
def grid(arguments: Namespace) -> None:
    """Write the coupled solution of a roller as a table over speed and creepage.

    Pressure and shear are solved together.  The table is that of one mu and one thickness over contact length at rest.
    It states the largest errors of interpolation.  vr.load_law reads it.  Formats: .nc, .cdf (without HDF5), .h (for C).

    example:
      viscoroll samples
      viscoroll tables grid samples/rubber.toml --method coupled -o rubber.nc

    arguments: parsed command line with scene, path of a TOML file or name of a preset; nodes, [over
        speed, over creep], or None; output, path that is written; its suffix is the format.
    Raises ParameterError for numbers of nodes, FileError for a file that cannot be read or written.
    """  # noqa: E501
    nodes = arguments.nodes and tuple(arguments.nodes)
    roller = roller_of_argument(arguments.scene)
    table = vr.tables.build(roller, method="coupled", nodes=nodes, progress=sys.stderr.isatty())
    _export(table, arguments.output)


@command("tables info", FILE)
def info(arguments: Namespace) -> None:
    """Print the contents of a table file: functions or grid, stated errors, material and provenance.

    example:
      viscoroll samples
      viscoroll tables law samples/rubber.toml -o rubber.nc
      viscoroll tables info rubber.nc

    arguments: parsed command line with file, path of a law or a grid.
    Raises FileError for a file that cannot be read or is no table.
    """  # noqa: E501
    print(vr.tables.info(arguments.file))


@command(
    "tables validate",
    FILE,
    option("-n", type=int, default=10_000, help="number of random points (default: 10000)"),
)
def validate(arguments: Namespace) -> int:
    """Compare a law file with the formulas of its relaxation modes at random speeds, or a grid with the law of its scene.

    A grid must be that of a scene with alpha.  The law of a cover is compared with solutions of the contact at no
    more than 400 speeds, a table of the coupled solution at no more than 80 states.  The exit code is 1 if an error is
    larger than its limit.  The limit is twice the stated error, and eight times the stated error for a cover or a table
    of the coupled solution; for the functions of a cover that describe the effect of shear 1e-8 is added.  For a grid the
    limit is at most half of the largest value, and a stored value must not differ from the law by more than 1e-12.

    example:
      viscoroll samples
      viscoroll tables law samples/rubber.toml -o rubber.nc
      viscoroll tables validate rubber.nc

    arguments: parsed command line with file, path of a law or a grid; n, number of random points.
    Returns the exit code as a truth value, True for 1.  For rounding 2e-15 is added to each limit,
    except where 1e-8 is added or the limit is 1e-12.  The random points are always those of seed 0.
    Raises ParameterError for n, FileError for a file that cannot be read or is no table, and for a
    grid of a material or a cylinder.
    """  # noqa: E501
    from ..tables.law_dataset import Report, check_table

    about = {"file": arguments.file, "points": arguments.n}
    # seed 0, which is none of those by which the stated errors were measured
    report = Report(tuple(check_table(vr.tables.load(arguments.file), arguments.n, 0)), about)
    print(report)
    return not report.ok


# a dict, since both lists have .nc and .cdf
@command("export", FILE, output(*dict.fromkeys(_LAW + _GRID)))
def export(arguments: Namespace) -> None:
    """Convert the results of a run, or a table, to another file format.

    A results store (STORE.zarr) becomes .nc with summaries and stored motions.  A law becomes .nc, .cdf, .h or .json.
    A grid becomes .nc, .cdf, .csv, .txt or .mat.

    example:
      viscoroll samples
      viscoroll tables law samples/rubber.toml -o rubber.nc
      viscoroll export rubber.nc -o rubber.h

    arguments: parsed command line with file, path of a folder with the results of a run, or of a
        law or a grid; output, path that is written; its suffix is the format.
    Raises ParameterError for a suffix that the content does not have, and as :func:`law` and
    :func:`build` for .h and .txt; FileError for a file that cannot be read or written, is damaged,
    or for results that are not finished; MissingDependencyError for results without zarr.
    """  # noqa: E501
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
    option(
        "file",
        metavar="MATERIAL_OR_LAW",
        help="TOML file with [material], perhaps [base], and perhaps [cylinder], whose R, m, mu, "
        "j and load become default values of the FMU; the file of `viscoroll tables law`; the "
        "netCDF of a material; or the name of a preset",
    ),
    option("--model", default="Roller", help="Roller (default) or ContactElement"),
    option("--fmi", type=int, default=2, help="version of the FMI standard: 2 (default) or 3"),
    output(".fmu"),
)
def fmu(arguments: Namespace) -> None:
    """Build an FMU of a cylinder, for Modelica tools and others.

    The FMU contains the law of a material, pair or cover and its C sources, compiled for this machine by cc.
    For a cover, and for half-spaces with Dundurs' constant above 0.05, it is the fast law, as with coupled = false.
    Roller: inputs drive force and torque, outputs v, slip, omega, x; for co-simulation and model exchange.
    ContactElement: inputs v, omega, load, outputs force, torque, moments; for model exchange.
    Both provide directional derivatives, which are exact except those with respect to the load of a cover.

    example:
      viscoroll samples
      viscoroll fmu samples/rubber.toml -o roller.fmu

    arguments: parsed command line with
        file, path of a TOML file with a cylinder, a material or a scene, or of the netCDF (.nc) of
        a law or a material, or name of a preset;
        model, fmi, output.
    Raises ParameterError for another model or version, FileError for a file that cannot be read or
    written, and MissingDependencyError without fmpy or a C compiler.

    The numbers of a cylinder become the start values of the FMU.  Of a dimensionless scene the FMU
    has the law alone, and a ModelWarning says that its other numbers are not used.
    """  # noqa: E501
    from ..materials import is_law
    from ..presets import SCENES, read_law_source, read_sections

    path = arguments.file
    content = read_sections(path)
    # only a TOML file has sections; a netCDF is a law or a material
    source = vr.load_law(path) if not content and is_law(path) else read_law_source(path)
    vr.fmu.build(source, arguments.output, arguments.model, arguments.fmi)
    if "cylinder" not in content and content.keys() & set(SCENES):
        text = "an FMU is in SI units: kappa, mu, gamma and j of the dimensionless scene are not "
        text += "used; set the parameters of the FMU (R, T_ref, mu, load, mass, and inertia, which "
        text += "is j) in the program that imports it"
        warnings.warn(text, vr.ModelWarning, stacklevel=2)
    _print_size(arguments.output)
