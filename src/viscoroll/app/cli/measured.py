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
    option("file", metavar="FILE", help="TOML file with [material], [base] or both, or netCDF file of a material"),
)
def show(given: Namespace) -> None:
    """Print moduli and modes, in relaxation and creep form, of the materials of a file.

    The values are those at the temperature stated in the file.

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
            print(f"Low speeds, identical materials: M/P = V T_mean with V in m/s, {mean}\n")
            print(pd.DataFrame(columns).to_string(index=False, float_format="{:.10g}".format), end="\n\n")


@command(
    "material fit",
    option("data", metavar="DATA", help="text file with columns"),
    option("--units", metavar="F,M", help="units of frequency and moduli, if the file states none: for example Hz,MPa"),
    option(
        "--column", metavar="NAME=HEADING", action="append", help="heading of the column of a quantity, for example storage=Module 1; may be repeated"
    ),
    option("--decimal", choices=(".", ","), help="decimal mark (default: as found in the numbers)"),
    option("--encoding", help="text encoding of the file (default: by its first bytes)"),
    option("--mode", choices=("tension", "shear"), help="type of the moduli, if the headings do not state it (default: tension)"),
    option("--temperature", type=float, metavar="T", help="temperature of all points, degrees Celsius (default: as in the file)"),
    option("--reference", type=float, metavar="T", help="reference temperature of the master curve, degrees Celsius"),
    option("--wlf", metavar="C1,C2,T0", help="WLF parameters of the shift factors (default: shifts by the overlap of the curves)"),
    option("--on", choices=("both", "storage"), default="both", help="moduli whose overlap determines the shift (default: both)"),
    option("--modes", type=int, help="largest number of modes (default: as few as --misfit needs)"),
    option("--misfit", type=float, default=0.01, help="target rms of the relative errors (default: 0.01)"),
    option("--nu", type=float, default=0.49, help="Poisson's ratio, constant in time (default: 0.49)"),
    option("--name", default="", help="name of the material"),
    option("--force", action="store_true", help="write the file even if the fit misses --misfit; the file then states it"),
    output(".toml", ".nc", required=False),
)
def fit(given: Namespace) -> int:
    """Fit a material to DMA data.

    The command fits a Prony series to columns of frequency, storage and loss modulus with units in their headings,
    and prints the result with its uncertainties.  With -o it writes a section [material] of a TOML file, or netCDF.

    If the misfit exceeds --misfit or 5 %, the exit code is 1 and no file is written.  --force writes it all the same:
    the file then states the misfit beside the source of the data.

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
        unless = f"; {given.output} is not written: raise --misfit, or write it with --force" if given.output else ""
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
            raise vr.ParameterError("--column", repr(name), "NAME=HEADING, for example storage=Module 1")
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
    option("file", metavar="DATA.toml", help="TOML file with given parameters, unknown parameters and data files"),
    option("--starts", type=int, default=8, help="number of searches from random starts in the ranges (default: 8)"),
    option("--seed", type=int, default=0, help="seed of the random starts (default: 0)"),
    option("--robust", action="store_true", help="reduce the influence of outliers"),
    output(*FIGURES, name="--plot", required=False, more=": data, fit and residuals"),
    output(".txt", ".json", ".nc", required=False, more="; the report is printed too"),
)  # fmt: skip
def identify(given: Namespace) -> None:
    """Identify friction, modulus, relaxation times, strengths and bearing from measurements.

    The command fits unknown parameters of a cylinder to measured rolling resistance, traction and motions, and
    reports which parameters the data do not determine.  The file has [cylinder], perhaps [material], [base], and
      [unknown]  NAME = [LOW, HIGH]: bounds; [cylinder] has the initial guess
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
