"""``viscoroll validity``."""

from __future__ import annotations

from argparse import Namespace
from typing import Any

from .arguments import add_scene_options, number
from .body import body_of


def add_commands(commands: Any) -> None:
    """Add the command to the program."""
    parser = commands.add_parser(
        "validity",
        help="which assumptions of the model a speed strains",
        description="A line for each assumption of the model: whether it holds (yes, no, ?: not known) and why.",
        epilog="example:\n  viscoroll validity --preset rubber-roller --V 5 --omega 4.9",
    )
    parser.add_argument("--V", type=number, required=True, help="velocity of the axis, any sign")
    parser.add_argument("--omega", type=number, help="angular velocity; without it the creep is not known")
    add_scene_options(parser)
    parser.set_defaults(run=_validity)


def _validity(arguments: Namespace) -> int:
    print(body_of(arguments).validity(arguments.V, omega=arguments.omega))
    return 0
