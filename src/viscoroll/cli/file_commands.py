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

from ..core import write_dataset, write_text
from .arguments import FIGURES, FILE, SCENE, command, numbers, option, output, roller_of_argument

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
    """Print the moduli, relaxation modes and creep modes of each material of a file.

    Moduli are in Pa, times in s.  Relaxation modes are printed as strengths E_i, divided by the
    long-time modulus, and times tau_i, creep modes as strengths J_i, divided by the long-time
    compliance, and times T_i; above them stands T_mean = sum J_i T_i, with M/P = V T_mean at low
    speeds.  An elastic material has none of these.

    arguments: parsed command line with file, path of a TOML file with [material] or [base], or of
        the netCDF (.nc) of a material.
    Returns None.
    Raises FileError for a file that cannot be read, that has no material, or with a value that is
    not allowed.
    """
    import pandas as pd

    from ..core import as_text
    from ..materials import read_materials

    for section, material in read_materials(arguments.file).items():
        print(f"[{section}] {as_text(*material._summary())}\n")
        series = material.prony
        T = material.T_ref
        if series.E.size:
            columns = {
                "E_i": series.E,
                "tau_i [s]": series.tau * T,
                "J_i": series.J,
                "T_i [s]": series.T * T,
            }
            mean = f"T_mean = {series.T_mean * T:.6g} s"
            print(f"Low speeds, identical materials: M/P = V T_mean with V in m/s, {mean}\n")
            print(
                pd.DataFrame(columns).to_string(index=False, float_format="{:.10g}".format),
                end="\n\n",
            )


def _named_heading(text: str) -> tuple[str, str]:
    """Convert an argument NAME=HEADING to (quantity, heading); :func:`viscoroll.read_dma` checks
    the quantity.

    text: the argument, for example "storage=Module 1"; the heading may have further equals signs.
    Returns (text before the first equals sign, text after it), both without blanks at their ends.
    Raises ArgumentTypeError where there is no equals sign or no heading.
    """
    name, _, heading = map(str.strip, text.partition("="))
    if not heading:
        raise ArgumentTypeError(f"{text!r} must be NAME=HEADING, for example storage=Module 1")
    return name, heading


@command(
    "material fit",
    option("data", metavar="DATA", help="text file with columns"),
    option(
        "--units",
        metavar="F,M",
        help="units of frequency and moduli, if the file states none, for "
        "example Hz,MPa; or in place of those of the file NAME=UNIT,..., for example storage=MPa",
    ),
    option(
        "--column",
        type=_named_heading,
        metavar="NAME=HEADING",
        action="append",
        default=[],
        help="quantity and heading of a column, for example storage=Module 1; may be repeated",
    ),
    option("--decimal", choices=(".", ","), help="decimal mark (default: as the numbers have it)"),
    option("--encoding", help="encoding of the file (default: by its first bytes)"),
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
        help="reference temperature of the master curve, for data at several temperatures",
    ),
    option(
        "--wlf",
        metavar="C1,C2,T0",
        help="WLF parameters of the shift factors (default: shifts from the overlap of the curves)",
    ),
    option(
        "--on",
        choices=("both", "storage"),
        default="both",
        help="moduli whose overlap determines the shift (default: both)",
    ),
    option(
        "--modes", type=int, help="largest number of modes (default: as few as the misfit needs)"
    ),
    option(
        "--misfit",
        type=float,
        default=0.01,
        help="required rms of the relative errors (default: 0.01)",
    ),
    option(
        "--nu", type=float, default=0.49, help="Poisson's ratio, constant in time (default: 0.49)"
    ),
    option("--name", default="", help="name of the material"),
    option(
        "--force",
        action="store_true",
        help="write the file even if the fit misses the misfit, and mark it",
    ),
    output(".toml", ".nc", required=False),
)
def fit(arguments: Namespace) -> int:
    """Fit a Prony series to a DMA, print the fit, and write its material if a path is given.

    A fit is faulty if it misses the required misfit, or if its misfit is above 5 %; standard error
    then says so, with a path and without.

    arguments: parsed command line with
        data, path of the text file;
        decimal, "." or ",", or None: as the numbers have it;
        encoding, name of an encoding, or None: by the first bytes of the file;
        units, "F,M", units of frequency and of moduli, or "NAME=UNIT,...", or None;
        column, a list of (quantity, heading), perhaps empty;
        mode, "tension" or "shear" in place of what the headings say, or None: as they say, else
        tension; temperature of all points, degrees Celsius, in place of those of the file, or None;
        reference, temperature of the master curve, degrees Celsius, or None;
        wlf, "C1,C2,T0", or None: shifts from the overlap of the curves;
        on, "both" (if not given) or "storage", the moduli whose overlap gives the shifts;
        modes, largest number of modes, or None: as few as the misfit needs;
        misfit, required root mean square of relative errors, dimensionless, 0.01 if not given;
        nu, Poisson's ratio, in (-1, 0.5], 0.49 if not given;
        name of the material, perhaps "";
        output, path that is written, .toml or .nc, or None: nothing is written;
        force, whether a faulty fit is written too, with a mark in its source.
    Returns 1, and writes nothing, if the fit is faulty and force is not given; else 0.
    Raises ParameterError for values that are not allowed, FileError for a file that cannot be read
    or written.
    """
    from ..contact_mechanics import MISFIT_LIMIT
    from ..materials import material_as_toml

    # NAME=UNIT,... becomes a dict, F,M a pair; without the option neither is used
    parts = (arguments.units or "").split(",")
    units: Any = dict(_named_heading(part) for part in parts) if "=" in parts[0] else tuple(parts)
    record = vr.read_dma(
        arguments.data,
        columns=dict(arguments.column),
        decimal=arguments.decimal,
        encoding=arguments.encoding,
        units=units if arguments.units else None,
    )
    if arguments.mode is not None:
        record = replace(record, mode=arguments.mode)
    options = {
        name: getattr(arguments, name)
        for name in ("modes", "misfit", "temperature", "reference", "on")
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
    if path is not None and path.suffix.lower() == ".nc":
        material.to_netcdf(path)
    elif path is not None:
        write_text(path, material_as_toml(material))
    return 0


def _wlf(text: str) -> vr.WLF:
    """Return the time-temperature shift of the option --wlf, a :class:`viscoroll.WLF`.

    text: "C1,C2,T0": C1 dimensionless, C2 in K, T0 in degrees Celsius.
    Raises ParameterError for another form, and for values that :class:`viscoroll.WLF` refuses.
    """
    try:
        C1, C2, T0 = (float(part) for part in text.split(","))
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
        help="known and unknown parameters, and files of the measurements",
    ),
    option(
        "--starts",
        type=int,
        default=8,
        help="number of searches from random points in the ranges (default: 8)",
    ),
    option("--seed", type=int, default=0, help="seed of the random points (default: 0)"),
    option("--robust", action="store_true", help="give outliers less weight"),
    output(*FIGURES, name="--plot", required=False, more=": data, fit and residuals"),
    output(".txt", ".json", ".nc", required=False, more="; the report is printed too"),
)
def identify(arguments: Namespace) -> None:
    """Fit the unknowns of a cylinder to measurements, print the report, and write report and figure
    if paths are given.

    arguments: parsed command line with
        file, path of a TOML file of measurements;
        starts, number of searches, >= 1, 8 if not given;
        seed of their random points, >= 0, 0 if not given;
        robust, whether outliers count less, False if not given;
        output, path of the report that is written, .txt (the text printed), .json or .nc, or None;
        plot, path of the figure that is written, .png, .pdf or .svg, or None.
    Returns None, exit code 0, also where the report warns of the model or the data.  A progress bar
    is drawn on standard error if that is a terminal.
    Raises ParameterError for values that are not allowed, FileError for a file that cannot be read
    or written.
    """
    from ..measurements.identification_report import as_json
    from ..measurements.identify import read_measurements

    options = {name: getattr(arguments, name) for name in ("robust", "starts", "seed")}
    result = vr.identify(
        **read_measurements(arguments.file), **options, progress=sys.stderr.isatty()
    )
    print(result)
    path = arguments.output
    suffix = arguments.output and arguments.output.suffix.lower()  # None without a path
    if suffix == ".nc":
        write_dataset(result.to_xarray(), path)
    elif path is not None:
        text = (
            json.dumps(as_json(result), indent=1, allow_nan=False)
            if suffix == ".json"
            else str(result)
        )
        write_text(path, f"{text}\n")
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


def _print_size(path: Path) -> None:
    """Print the name and the size of a written file, in kB of 1000 bytes, on standard output.

    path: path of the file.
    """
    print(f"{path}: {path.stat().st_size / 1e3:.0f} kB")


@command(
    "tables law",
    option(
        "file",
        metavar="MATERIAL",
        nargs="?",
        help="TOML file with [material] (and [base]), [scene] or [cylinder], netCDF file of a "
        "material, or name "
        "of a preset",
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
    """Write the law of a material, pair or cover, or of every alpha of a range, and print the size
    of the file.

    arguments: parsed command line with
        file, path of a TOML file or of the netCDF of a material, name of a preset, or None;
        alpha, (low, high) of alpha, dimensionless, for the law of every alpha between, or None;
        output, path that is written; its suffix is the format: .nc, .cdf, .h or .json.
    Exactly one of file and alpha must be given.
    Raises ParameterError for both or none of file and alpha, a range out of bounds, a suffix in
    capital letters, and a name of a .h file that is no identifier of C; FileError for a file that
    cannot be read or written, and for .h of a range of alpha.
    """
    from ..presets import read_law_source

    material = None if arguments.file is None else read_law_source(arguments.file)
    vr.tables.export(vr.tables.law(material, alpha=arguments.alpha), arguments.output)
    _print_size(arguments.output)


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
        help="table (default): the law of the scene; direct: numerical roots "
        "of the equations of the paper",
    ),
    output(*_GRID),
)
def build(arguments: Namespace) -> None:
    """Compute a grid of the contact over speed and creepage, write it, and print the size of the
    file.

    arguments: parsed command line with
        scene, path of a TOML file or name of a preset;
        V, nodes of the axis of speed, > 0, a number or (n,), in m/s of a cylinder, dimensionless of
        a scene; delta, nodes of the axis of creepage, a number or (m,), dimensionless;
        alpha, nodes of a third axis, a number or (k,), dimensionless, of a scene only, or None: two
        axes; method, "table" (if not given), the law of the scene, or "direct", roots of the
        equations of the paper; output, path that is written; its suffix is the format: .nc, .cdf,
        .csv, .txt or .mat.
    Raises ParameterError for nodes or a method that are not allowed, for .txt of a grid over
    several alphas, and for a suffix in capital letters; FileError for a file that cannot be read or
    written.
    """
    axes = {name: getattr(arguments, name) for name in ("V", "delta", "alpha", "method")}
    vr.tables.export(vr.tables.build(roller_of_argument(arguments.scene), **axes), arguments.output)
    _print_size(arguments.output)


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
        help="numbers of nodes (default: 5 to 13 a decade of speed, 27)",
    ),
    output(".nc", ".cdf", ".h"),
)
def grid(arguments: Namespace) -> None:
    """Compute the coupled solution of a roller over speed and creep as a law, write it, and print
    the size of the file.

    arguments: parsed command line with
        scene, path of a TOML file or name of a preset;
        method, "coupled";
        nodes, [over speed, over creep], or None;
        output, path that is written; its suffix is the format: .nc, .cdf or .h.
    Raises ParameterError for numbers of nodes, FileError for a file that cannot be read or written.
    """
    nodes = None if arguments.nodes is None else tuple(arguments.nodes)
    roller = roller_of_argument(arguments.scene)
    table = vr.tables.build(roller, method="coupled", nodes=nodes, progress=sys.stderr.isatty())
    vr.tables.export(table, arguments.output)
    _print_size(arguments.output)


@command("tables info", FILE)
def info(arguments: Namespace) -> None:
    """Print the summary of a table file on standard output: its functions or axes and fields, their
    errors, its origin.

    arguments: parsed command line with file, path of a law or a grid.
    Returns None; the lines are those of :func:`viscoroll.tables.info`.
    Raises FileError for a file that cannot be read or is no table.
    """
    print(vr.tables.info(arguments.file))


@command(
    "tables validate",
    FILE,
    option("-n", type=int, default=10_000, help="number of random speeds (default: 10000)"),
)
def validate(arguments: Namespace) -> int:
    """Check a table file at random points and print the differences.

    A law is compared with the formulas of its relaxation modes, that of a cover with solves of the
    contact, and a grid with the law.  The points are the same in every call: their seed is 0.

    arguments: parsed command line with
        file, path of a law or a grid;
        n, number of random points, a whole number >= 1, 10000 if not given.
    Returns True, exit code 1, if an error is larger than its check allows (twice the error that the
    file states, and rounding; of a grid at most half of the largest value of the field), else
    False, exit code 0.
    Raises ParameterError for n, FileError for a file that cannot be read or is no table, and for a
    grid of a material or a cylinder.
    """
    from ..tables.law_dataset import Report, check_table

    about = {"file": arguments.file, "points": arguments.n}
    # seed 0, which is none of those by which the stated errors were measured
    report = Report(tuple(check_table(vr.tables.load(arguments.file), arguments.n, 0)), about)
    print(report)
    return not report.ok


# a dict, since both lists have .nc and .cdf
@command("export", FILE, output(*dict.fromkeys(_LAW + _GRID)))
def export(arguments: Namespace) -> None:
    """Write the results of a run, or a table, in another format, and print the size of the new
    file.

    arguments: parsed command line with
        file, path of a folder with the results of a run, or of a law or a grid;
        output, path that is written; its suffix is the format: .nc of results, .nc, .cdf, .h or
        .json of a law, .nc, .cdf, .csv, .txt or .mat of a grid.
    Raises ParameterError for a suffix that the content does not have, and as :func:`law` and
    :func:`build` for .h and .txt; FileError for a file that cannot be read or written, is damaged,
    or for results that are not finished; MissingDependencyError for results without zarr.
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
    option(
        "file",
        metavar="MATERIAL_OR_LAW",
        help="TOML with [material], perhaps [base], and perhaps [cylinder], whose numbers are the "
        "start values; the "
        "file of `viscoroll tables law`; the netCDF of a material; or the name of a preset",
    ),
    option("--model", default="Roller", help="Roller (default) or ContactElement"),
    option("--fmi", type=int, default=2, help="version of the standard: 2 (default) or 3"),
    output(".fmu"),
)
def fmu(arguments: Namespace) -> None:
    """Build an FMU of a cylinder or a law, and print the size of the file.

    The numbers of a cylinder become the start values of the FMU.  Of a dimensionless scene the FMU
    has the law alone, and a ModelWarning says that its other numbers are not used.

    arguments: parsed command line with
        file, path of a TOML file with a cylinder, a material or a scene, or of the netCDF (.nc) of
            a law or a material, or name of a preset;
        model, "Roller" (if not given) or "ContactElement";
        fmi, version of the standard, 2 (if not given) or 3;
        output, path of the FMU that is written.
    Raises ParameterError for another model or version, FileError for a file that cannot be read or
    written, and MissingDependencyError without fmpy or a C compiler.
    """
    from ..materials import is_law
    from ..presets import SCENES, read_law_source, read_sections

    path = arguments.file
    content = read_sections(path)
    # only a TOML file has sections; a netCDF is a law or a material
    source = vr.load_law(path) if not content and is_law(path) else read_law_source(path)
    vr.fmu.build(source, arguments.output, arguments.model, arguments.fmi)
    if "cylinder" not in content and content.keys() & set(SCENES):
        text = (
            "an FMU is in SI units: kappa, mu, gamma and j of the dimensionless scene are not "
            "used; set R, "
        )
        warnings.warn(
            f"{text}E_prime, T_ref, mu, load and mass in the tool", vr.ModelWarning, stacklevel=2
        )
    _print_size(arguments.output)
