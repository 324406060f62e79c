"""``viscoroll material show|plot|fit``."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .arguments import add_output_option, count, number
from .plot import FORMATS

if TYPE_CHECKING:
    from ...materials.material import Material


def add_commands(commands: Any) -> None:
    """Add the group to the program."""
    group = commands.add_parser(
        "material",
        help="show, draw and fit a material of several relaxation times",
        description="Materials by the sections [material] and [base] of a TOML file, in SI units.",
        epilog="example:\n  viscoroll material show docs/examples/rubber.toml",
    ).add_subparsers(metavar="COMMAND", required=True)
    parser = group.add_parser(
        "show",
        help="moduli, and the modes in relaxation and in creep",
        description="Moduli and times of each material of the file, with its modes in both forms.",
        epilog="example:\n  viscoroll material show docs/examples/rubber.toml --temperature 60",
    )
    _add_file(parser)
    parser.set_defaults(run=_show)
    parser = group.add_parser(
        "plot",
        help="master curve and relaxation",
        description="Draw storage and loss modulus and loss factor over frequency, and the relaxation modulus.",
        epilog="example:\n  viscoroll material plot docs/examples/rubber.toml --temperature 60 -o rubber.png",
    )
    _add_file(parser)
    parser.add_argument("--section", default="material", help="material (default) or base")
    add_output_option(parser, *FORMATS, required=True)
    parser.set_defaults(run=_plot)
    _add_fit(group)


def _add_fit(group: Any) -> None:
    parser = group.add_parser(
        "fit",
        help="a material from the master curve of a DMA",
        description="Fit a Prony series to columns of frequency, storage and loss modulus, with units in their\n"
        "heading; print what the data say of it and what they do not, and with -o write it as a section [material]\n"
        "of a TOML file, or as netCDF.",
        epilog="example:\n  viscoroll material fit docs/examples/dma.csv --nu 0.49 -o rubber.toml",
    )
    parser.add_argument("data", metavar="DATA", help="a text file of columns")
    parser.add_argument(
        "--units", metavar="F,M", type=lambda text: tuple(text.split(",")),
        help="of frequency and moduli where the file gives none: Hz,MPa"
    )  # fmt: skip
    parser.add_argument("--modes", type=count, help="largest number of modes; default: as few as the misfit needs")
    parser.add_argument(
        "--misfit", type=number, default=0.01, help="rms of the relative errors asked for (default 0.01)"
    )
    parser.add_argument("--nu", type=number, default=0.49, help="Poisson's ratio, constant in time (default 0.49)")
    parser.add_argument("--name", default="", help="of the material")
    add_output_option(parser, ".toml", ".nc")
    parser.set_defaults(run=_fit)


def _add_file(parser: ArgumentParser) -> None:
    parser.add_argument(
        "file", metavar="FILE", help="TOML with [material], [base] or both, or the netCDF of a material"
    )
    parser.add_argument(
        "--temperature", type=number, metavar="T", help="degrees Celsius, by the wlf or arrhenius of the file"
    )


def _show(arguments: Namespace) -> int:
    from ...materials.file import read_materials

    found = read_materials(arguments.file, arguments.temperature)
    print("\n".join(_text(section, material) for section, material in found.items()), end="")
    return 0


def _plot(arguments: Namespace) -> int:
    from ...core.errors import unknown
    from ...materials.file import read_materials

    found = read_materials(arguments.file, arguments.temperature)
    if arguments.section not in found:
        raise unknown("section", arguments.section, found, "in the file")
    found[arguments.section].plot(arguments.output)
    return 0


def _fit(arguments: Namespace) -> int:
    from ...core.files import write_text
    from ...materials.file import SUFFIX, as_toml
    from ..dma import fit_prony, read_dma

    columns = read_dma(arguments.data, units=arguments.units)
    found = fit_prony(*columns, arguments.modes, misfit=arguments.misfit, source=Path(arguments.data).name)
    material = found.material(arguments.nu, name=arguments.name)
    if arguments.output is not None and arguments.output.suffix == SUFFIX:
        material.to_netcdf(arguments.output)
    elif arguments.output is not None:
        write_text(arguments.output, as_toml(material))
    print(found)
    return 0


def _text(section: str, material: Material) -> str:
    import pandas as pd

    from ...core.results import as_text

    series, T = material.prony, material.T_ref
    card = f"[{section}] {as_text(*material._card())}\n"
    if not series.E.size:
        return card
    columns = {"E_i": series.E, "tau_i [s]": series.tau * T, "J_i": series.J, "T_i [s]": series.T * T}
    table = pd.DataFrame(columns).to_string(index=False, float_format="{:.10g}".format)
    slow = f"M = V T_mean/R at low speeds V in m/s of like bodies, T_mean = {series.T_mean * T:.6g} s"
    return f"{card}{slow}\n\n{table}\n"
