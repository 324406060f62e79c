"""``viscoroll fmu``."""

from __future__ import annotations

from argparse import Namespace
from pathlib import Path
from typing import Any

from .arguments import add_output_option, number

#: as in :mod:`viscoroll.app.fmu`, which takes long to import
_MODELS, _VERSIONS = ("Roller", "ContactElement"), (2, 3)


def add_commands(commands: Any) -> None:
    """Add the command to the program."""
    parser = commands.add_parser(
        "fmu",
        help="a cylinder as an FMU, for Modelica tools and others",
        description="An FMU by the law of a material or pair, with its sources, compiled for this machine by cc.\n"
        "Roller: drive force and torque -> v, omega, x; co-simulation and model exchange.\n"
        "ContactElement: v, omega, load -> force, torque, moments; model exchange.  Both have exact slopes.",
        epilog="example:\n  viscoroll fmu docs/examples/rubber.toml -o roller.fmu",
    )
    parser.add_argument(
        "file", metavar="MATERIAL_OR_LAW",
        help="TOML with [material], perhaps [base] and a [cylinder], whose numbers are those at the start;\n"
        "the file of `viscoroll tables law`; or the netCDF of a material",
    )  # fmt: skip
    parser.add_argument("--model", choices=_MODELS, default=_MODELS[0], help="default: Roller")
    parser.add_argument("--fmi", type=int, choices=_VERSIONS, default=2, help="version of the standard; default: 2")
    parser.add_argument(
        "--temperature", type=number, metavar="T", help="degrees Celsius, by the wlf or arrhenius of the file"
    )
    add_output_option(parser, ".fmu", required=True)
    parser.set_defaults(run=_fmu)


def _fmu(arguments: Namespace) -> int:
    from .. import fmu

    fmu.build(_given(arguments.file, arguments.temperature), arguments.output, arguments.model, arguments.fmi)
    print(f"{arguments.output}: {arguments.output.stat().st_size / 1e3:.0f} kB")
    return 0


def _given(path: str, temperature: float | None) -> Any:
    """The cylinder, material, pair or law of a file."""
    from ...core.sections import read
    from ...io.config import read_bodies, read_body
    from ...materials.file import read_materials
    from ...materials.law_file import load_law
    from ...materials.law_store import is_law

    if Path(path).suffix == ".nc" and is_law(path):
        return load_law(path)
    if Path(path).suffix == ".nc" or "cylinder" not in read(path):
        return read_bodies(path, temperature)
    body: Any = read_body(path)
    return body if temperature is None else body.replace(**read_materials(path, temperature))
