"""What measurements say: ``viscoroll material`` and ``identify``."""

from __future__ import annotations

import json
import sys
from argparse import Namespace
from pathlib import Path

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
        print(f"[{section}] {as_text(*material._card())}\n")
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
    option("--modes", type=int, help="largest number of modes; default: as few as the misfit needs"),
    option("--misfit", type=float, default=0.01, help="rms of the relative errors asked for (default 0.01)"),
    option("--nu", type=float, default=0.49, help="Poisson's ratio, constant in time (default 0.49)"),
    option("--name", default="", help="of the material"),
    output(".toml", ".nc", required=False),
)
def fit(given: Namespace) -> None:
    """A material from the master curve of a DMA.

    Fits a Prony series to columns of frequency, storage and loss modulus, with units in their heading; prints what
    the data say of it and what they do not, and with -o writes it as a section [material] of a TOML file, or as netCDF.

    example:
      viscoroll material fit src/viscoroll/datasets/dma.csv --nu 0.49 -o rubber.toml
    """
    from ...materials.file import as_toml

    columns = vr.read_dma(given.data, units=given.units and tuple(given.units.split(",")))
    found = vr.fit_prony(*columns, given.modes, misfit=given.misfit, source=Path(given.data).name)
    material = found.material(given.nu, name=given.name)
    if given.output is not None and given.output.suffix == ".nc":
        material.to_netcdf(given.output)
    elif given.output is not None:
        write_text(given.output, as_toml(material))
    print(found)


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
    from ..identification.file import read_measurements
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
