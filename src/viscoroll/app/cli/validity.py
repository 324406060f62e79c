"""``viscoroll validity``."""

from __future__ import annotations

from argparse import Namespace
from typing import Any

from .arguments import add_scene, body_of, number


def add_commands(commands: Any) -> None:
    """Add the command to the program."""
    parser = commands.add_parser(
        "validity",
        help="which assumptions of the model a speed strains",
        description="A line for each assumption of the model: whether it holds (yes, no, ?: not known) and why.",
        epilog="example:\n  viscoroll validity rubber-roller --V 5 --omega 4.9",
    )
    add_scene(parser)
    parser.add_argument("--V", type=number, required=True, help="velocity of the axis, any sign")
    parser.add_argument("--omega", type=number, help="angular velocity; without it the creep is not known")
    parser.set_defaults(run=_validity)


def _validity(arguments: Namespace) -> int:
    print(body_of(arguments.scene).validity(arguments.V, omega=arguments.omega))
    return 0
