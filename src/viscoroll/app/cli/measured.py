"""Materials and measurements: ``viscoroll material`` and ``identify``."""

from __future__ import annotations

import json
import sys
from argparse import ArgumentTypeError, Namespace
from dataclasses import replace
from typing import Any

import viscoroll as vr

from ...core.files import write_dataset, write_text
from .arguments import FIGURES, command, option, output


@command(
    "material show",
    option("file", metavar="FILE", help="TOML file with [material], [base] or both, or netCDF file of a material"),
)
def show(arguments: Namespace) -> None:
    """Print the moduli, relaxation modes and creep modes of each material of a file.

    Moduli are in Pa, times in s; creep modes are printed as strengths J_i, divided by the long-time compliance, and
    times T_i.  An elastic material has no table of modes.

    arguments: parsed command line with file, path of a TOML file with [material] or [base], or of the netCDF (.nc) of a
        material.
    Returns None.
    Raises FileError for a file that cannot be read, that has no material, or with a value that is not allowed.
    """
    import pandas as pd

    from ...core.results import as_text
    from ...materials.material_toml import read_materials

    for section, material in read_materials(arguments.file).items():
        print(f"[{section}] {as_text(*material._summary())}\n")
        series, T = material.prony, material.T_ref
        if series.E.size:
            columns = {"E_i": series.E, "tau_i [s]": series.tau * T, "J_i": series.J, "T_i [s]": series.T * T}
            mean = f"T_mean = {series.T_mean * T:.6g} s"
            print(f"Low speeds, identical materials: M/P = V T_mean with V in m/s, {mean}\n")
            print(pd.DataFrame(columns).to_string(index=False, float_format="{:.10g}".format), end="\n\n")


def _named_heading(text: str) -> tuple[str, str]:
    """Convert an argument NAME=HEADING to (quantity, heading); :func:`viscoroll.read_dma` checks the quantity.

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
    option("--units", metavar="F,M", help="units of frequency and moduli, if the file states none, for "
        "example Hz,MPa; or in place of those of the file NAME=UNIT,..., for example storage=MPa"),
    option(
        "--column", type=_named_heading, metavar="NAME=HEADING", action="append", default=[],
        help="quantity and heading of a column, for example storage=Module 1; may be repeated"
    ),
    option("--decimal", choices=(".", ","), help="decimal mark (default: as the numbers have it)"),
    option("--encoding", help="encoding of the file (default: by its first bytes)"),
    option("--mode", choices=("tension", "shear"), help="type of the moduli, if the headings do not state it "
        "(default: tension)"),
    option("--temperature", type=float, metavar="T", help="temperature of all points, degrees Celsius "
        "(default: as in the file)"),
    option("--reference", type=float, metavar="T", help="reference temperature of the master curve, for data "
        "at several temperatures"),
    option("--wlf", metavar="C1,C2,T0", help="WLF parameters of the shift factors (default: shifts from the "
        "overlap of the curves)"),
    option("--on", choices=("both", "storage"), default="both", help="moduli whose overlap determines the "
        "shift (default: both)"),
    option("--modes", type=int, help="largest number of modes (default: as few as the misfit needs)"),
    option("--misfit", type=float, default=0.01, help="required rms of the relative errors (default: 0.01)"),
    option("--nu", type=float, default=0.49, help="Poisson's ratio, constant in time (default: 0.49)"),
    option("--name", default="", help="name of the material"),
    option("--force", action="store_true", help="write the file even if the fit misses the misfit, and mark it"),
    output(".toml", ".nc", required=False),
)  # fmt: skip
def fit(arguments: Namespace) -> int:
    """Fit a Prony series to a DMA, print the fit, and write its material if a path is given.

    A fit is faulty if it misses the required misfit, or if its misfit is above 5 %; standard error then says so, with a
    path and without.

    arguments: parsed command line with
        data, path of the text file;
        decimal, "." or ",", or None: as the numbers have it;
        encoding, name of an encoding, or None: by the first bytes of the file;
        units, "F,M", units of frequency and of moduli, or "NAME=UNIT,...", or None;
        column, a list of (quantity, heading), perhaps empty;
        mode, "tension" or "shear" in place of what the headings say, or None: as they say, else tension;
        temperature of all points, degrees Celsius, in place of those of the file, or None;
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
    Raises ParameterError for values that are not allowed, FileError for a file that cannot be read or written.
    """
    from ...contact_law.validity.assumptions import MISFIT_LIMIT
    from ...materials.material_toml import material_as_toml

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
    options = {name: getattr(arguments, name) for name in ("modes", "misfit", "temperature", "reference", "on")}
    result = vr.fit_prony(record, **options, shift=arguments.wlf and _wlf(arguments.wlf))
    print(record, result, sep="\n")
    path, fault = arguments.output, result._fault
    if fault and not arguments.force:
        advice = "raise --misfit, or " * (result.largest_misfit <= MISFIT_LIMIT)
        refusal = f"; {path} is not written: {advice}write it with --force" if path else ""
        print(f"viscoroll: {fault}{refusal}", file=sys.stderr)
        return 1
    material = result.material(arguments.nu, name=arguments.name)
    if fault:
        measured: Any = material.measured
        material = replace(material, measured=replace(measured, source=f"{measured.source}; forced: {fault}"))
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
        raise vr.ParameterError("--wlf", repr(text), "C1,C2,T0: three numbers, T0 in degrees Celsius") from None
    return vr.WLF(C1=C1, C2=C2, T0=T0)


@command(
    "identify",
    option("file", metavar="DATA.toml", help="known and unknown parameters, and files of the measurements"),
    option("--starts", type=int, default=8, help="number of searches from random points in the ranges (default: 8)"),
    option("--seed", type=int, default=0, help="seed of the random points (default: 0)"),
    option("--robust", action="store_true", help="give outliers less weight"),
    output(*FIGURES, name="--plot", required=False, more=": data, fit and residuals"),
    output(".txt", ".json", ".nc", required=False, more="; the report is printed too"),
)  # fmt: skip
def identify(arguments: Namespace) -> None:
    """Fit the unknowns of a cylinder to measurements, print the report, and write report and figure if paths are given.

    arguments: parsed command line with
        file, path of a TOML file of measurements;
        starts, number of searches, >= 1, 8 if not given;
        seed of their random points, >= 0, 0 if not given;
        robust, whether outliers count less, False if not given;
        output, path of the report that is written, .txt (the text printed), .json or .nc, or None;
        plot, path of the figure that is written, .png, .pdf or .svg, or None.
    Returns None, exit code 0, also where the report warns of the model or the data.  A progress bar is drawn on
    standard error if that is a terminal.
    Raises ParameterError for values that are not allowed, FileError for a file that cannot be read or written.
    """
    from ..identification.measurements_toml import read_measurements
    from ..identification.report import as_json

    options = {name: getattr(arguments, name) for name in ("robust", "starts", "seed")}
    result = vr.identify(**read_measurements(arguments.file), **options, progress=sys.stderr.isatty())
    print(result)
    path, suffix = arguments.output, arguments.output and arguments.output.suffix.lower()
    if suffix == ".nc":
        write_dataset(result.to_xarray(), path)
    elif path is not None:
        text = json.dumps(as_json(result), indent=1, allow_nan=False) if suffix == ".json" else str(result)
        write_text(path, f"{text}\n")
    if arguments.plot is not None:
        result.plot(arguments.plot)
