"""What measurements say: ``viscoroll material`` and ``identify``."""

from __future__ import annotations

import json
import sys
from argparse import Namespace
from dataclasses import replace

import viscoroll as vr

from ...core.files import write_dataset, write_text
from .arguments import FIGURES, command, option, output


@command(
    "material show",
    option("file", metavar="FILE", help="TOML with [material], [base] or both, or the netCDF of a material"),
)
def show(given: Namespace) -> None:
    """Moduli, and the modes in relaxation and in creep.

    Of each material of the file, at the temperature that it states.

    example:
      viscoroll material show docs/examples/rubber.toml
    """
    import pandas as pd

    from ...core.results import as_text
    from ...materials.file import read_materials

    for section, material in read_materials(given.file).items():
        print(f"[{section}] {as_text(*material._summary())}\n")
        series, T = material.prony, material.T_ref
        if series.E.size:
            columns = {"E_i": series.E, "tau_i [s]": series.tau * T, "J_i": series.J, "T_i [s]": series.T * T}
            mean = f"T_mean = {series.T_mean * T:.6g} s"
            print(f"M = V T_mean/R at low speeds V in m/s of like bodies, {mean}\n")
            print(pd.DataFrame(columns).to_string(index=False, float_format="{:.10g}".format), end="\n\n")


@command(
    "material fit",
    option("data", metavar="DATA", help="a text file of columns"),
    option("--units", metavar="F,M", help="of frequency and moduli where the file gives none: Hz,MPa"),
    option(
        "--column", metavar="NAME=HEADING", action="append", help="which column is which, as storage=Module 1; again"
    ),
    option("--decimal", choices=(".", ","), help="default: the one that the numbers have"),
    option("--encoding", help="of the file; default: by its first bytes"),
    option("--mode", choices=("tension", "shear"), help="of columns that do not say it (default tension)"),
    option("--temperature", type=float, metavar="T", help="of all points, degrees Celsius; default: as in the file"),
    option("--reference", type=float, metavar="T", help="at which the times shall be, of several temperatures"),
    option("--wlf", metavar="C1,C2,T0", help="the shift between temperatures; default: by their overlap"),
    option("--on", choices=("both", "storage"), default="both", help="moduli by whose overlap it is (default both)"),
    option("--modes", type=int, help="largest number of modes; default: as few as the misfit needs"),
    option("--misfit", type=float, default=0.01, help="rms of the relative errors asked for (default 0.01)"),
    option("--nu", type=float, default=0.49, help="Poisson's ratio, constant in time (default 0.49)"),
    option("--name", default="", help="of the material"),
    option("--force", action="store_true", help="write the file though the fit missed the misfit, and mark it"),
    output(".toml", ".nc", required=False),
)
def fit(given: Namespace) -> int:
    """A material from the master curve of a DMA.

    Fits a Prony series to columns of frequency, storage and loss modulus, with units in their heading; prints what
    the data say of it and what they do not, and with -o writes it as a section [material] of a TOML file, or as netCDF.

    A fit that misses --misfit, or is off by more than 5 %, ends with exit code 1 and writes no file, unless --force:
    the source of the data in the file then says so.

    example:
      viscoroll material fit src/viscoroll/datasets/dma.csv --nu 0.49 -o rubber.toml
    """
    from ...contact_law.validity.assumptions import MISFIT_LIMIT
    from ...materials.file import as_toml

    record = vr.read_dma(
        given.data, columns=_columns(given.column), decimal=given.decimal, encoding=given.encoding,
        units=given.units and tuple(given.units.split(",")),
    )  # fmt: skip
    found = vr.fit_prony(
        record if given.mode is None else replace(record, mode=given.mode), modes=given.modes, misfit=given.misfit,
        temperature=given.temperature, reference=given.reference, shift=given.wlf and _wlf(given.wlf), on=given.on,
    )  # fmt: skip
    print(found)
    material, missed = found.material(given.nu, name=given.name), ""
    if not found.reached:
        missed = f"the misfit of {given.misfit:.2%} was not reached ({found.largest_misfit:.2%})"
    elif found.largest_misfit > MISFIT_LIMIT:
        missed = f"the misfit of {found.largest_misfit:.2%} is above {MISFIT_LIMIT:.0%}"
    if missed:
        unless = f"; {given.output} is not written: ask for another --misfit, or --force it" if given.output else ""
        print(f"viscoroll: {missed}{'' if given.force else unless}", file=sys.stderr)
        if not given.force:
            return 1
        assert material.measured is not None
        marked = replace(material.measured, source=f"{material.measured.source}; forced: {missed}")
        material = replace(material, measured=marked)
    if given.output is not None and given.output.suffix.lower() == ".nc":
        material.to_netcdf(given.output)
    elif given.output is not None:
        write_text(given.output, as_toml(material))
    return 0


def _columns(given: list[str] | None) -> dict[str, str]:
    """Meaning -> heading of the options --column; raises ParameterError."""
    pairs = [text.partition("=") for text in given or ()]
    for name, sign, heading in pairs:
        if not (sign and heading):
            raise vr.ParameterError("--column", repr(name), "NAME=HEADING, as storage=Module 1")
    return {name.strip(): heading.strip() for name, _, heading in pairs}


def _wlf(text: str) -> vr.WLF:
    """The shift of --wlf C1,C2,T0; raises ParameterError."""
    try:
        C1, C2, T0 = (float(part) for part in text.split(","))
    except ValueError:
        raise vr.ParameterError("--wlf", repr(text), "C1,C2,T0: three numbers, T0 in degrees Celsius") from None
    return vr.WLF(C1=C1, C2=C2, T0=T0)


@command(
    "identify",
    option("file", metavar="DATA.toml", help="what is known, what is not, and where the data are"),
    option("--starts", type=int, default=8, help="searches from all over the ranges (default 8)"),
    option("--seed", type=int, default=0, help="of their starts (default 0)"),
    option("--robust", action="store_true", help="let outliers count less"),
    output(*FIGURES, name="--plot", required=False, more=": data, fit and residuals"),
    output(".txt", ".json", ".nc", required=False, more="; the report is printed too"),
)  # fmt: skip
def identify(given: Namespace) -> None:
    """Friction, modulus, times, strengths and bearing from measurements.

    Fits what is unknown of a cylinder to measured rolling resistance, traction and motions, and says what the data do
    not tell.  The file has [cylinder], perhaps [material] and [base], and
      [unknown]  NAME = [LOW, HIGH], with the start of the cylinder between
      [prior]    NAME = [VALUE, SD]
      [[data]]   kind = resistance, traction or coastdown; file = a CSV whose columns are named as V, M, delta,
                 Q, t, omega, x, or by columns = { M = NAME }; sigma, load, temperature, name; V0, omega0, t0, m

    example:
      viscoroll identify docs/examples/measured.toml --plot fit.png
    """
    from ..identification.measurements_toml import read_measurements
    from ..identification.report import as_json

    options = {"robust": given.robust, "starts": given.starts, "seed": given.seed}
    found = vr.identify(**read_measurements(given.file), **options, progress=sys.stderr.isatty())
    print(found)
    if (path := given.output) is not None and path.suffix == ".nc":
        write_dataset(found.to_xarray(), path)
    elif path is not None:
        as_file = json.dumps(as_json(found), indent=1, allow_nan=False) if path.suffix == ".json" else str(found)
        write_text(path, f"{as_file}\n")
    if given.plot is not None:
        found.plot(given.plot)
