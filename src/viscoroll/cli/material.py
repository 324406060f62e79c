"""``viscoroll material show|plot``."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from typing import TYPE_CHECKING, Any

from .arguments import add_output_option, number
from .plot import FORMATS

if TYPE_CHECKING:
    from ..material import Material


def add_commands(commands: Any) -> None:
    """Add the group to the program."""
    group = commands.add_parser(
        "material",
        help="show and draw a material of several relaxation times",
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


def _add_file(parser: ArgumentParser) -> None:
    parser.add_argument("file", metavar="FILE.toml", help="a file with [material], [base] or both")
    parser.add_argument(
        "--temperature", type=number, metavar="T", help="degrees Celsius, by the wlf or arrhenius of the file"
    )


def _show(arguments: Namespace) -> int:
    from ..material_file import read_materials

    found = read_materials(arguments.file, arguments.temperature)
    print("\n".join(_text(section, material) for section, material in found.items()), end="")
    return 0


def _plot(arguments: Namespace) -> int:
    from ..errors import ParameterError
    from ..material_file import read_materials

    found = read_materials(arguments.file, arguments.temperature)
    if arguments.section not in found:
        raise ParameterError("section", repr(arguments.section), f"out of {', '.join(found)}, which the file has")
    found[arguments.section].plot(arguments.output)
    return 0


def _text(section: str, material: Material) -> str:
    from .output import Sheet

    series, T = material.prony, material.T_ref
    heading = [f"[{section}] {material.name}".rstrip()]
    constants = {"E": material.E, "nu": material.nu}
    constants |= {} if material.density is None else {"density": material.density}
    if not series.E.size:
        heading.append("rigid" if material.is_rigid else "elastic")
        return "\n".join([*heading, ", ".join(f"{name} = {value:.10g}" for name, value in constants.items()), ""])
    heading.append(f"E(0) = {material.instant:.6g} Pa at once, E = {material.E:.6g} Pa for long times")
    heading.append(f"M = V T_mean/R at low speeds V in m/s of like bodies, T_mean = {series.T_mean * T:.6g} s")
    columns = {"E_i": series.E, "tau_i, s": series.tau * T, "J_i": series.J, "T_i, s": series.T * T}
    return Sheet(tuple(heading), constants | {"alpha": series.alpha, "T_ref": T}, columns).text()
