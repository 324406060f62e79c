"""``viscoroll steady``."""

from __future__ import annotations

from argparse import Namespace
from typing import Any

from .arguments import FORMATS, NUMBERS, add_output_option, add_scene, body_of, numbers

#: loads without an equilibrium that are told of
_LINES = 3


def add_commands(commands: Any) -> None:
    """Add the command to the program."""
    parser = commands.add_parser(
        "steady",
        help="steady rolling under force, torque or slope",
        description="Every equilibrium of rolling under each load, a row each; where there is none, why.\n"
        f"Options are {NUMBERS}, all of one length or single.",
        epilog="example:\n  viscoroll steady paper-section-5-rounded --slope 0:0.1:6",
    )
    add_scene(parser)
    parser.add_argument("--force", type=numbers, help="along V (default 0)")
    parser.add_argument("--torque", type=numbers, help="along omega (default 0)")
    parser.add_argument("--slope", type=numbers, help="rad, positive downhill along +V; the load is P cos(slope)")
    parser.add_argument("--V", type=numbers, help="the speed, in place of --force or --torque, which is found")
    add_output_option(parser, *FORMATS)
    parser.set_defaults(run=_steady)


def _steady(arguments: Namespace) -> int:
    import numpy as np

    from .output import show

    given = {name: getattr(arguments, name) for name in ("force", "torque", "slope", "V")}
    loads = {name: np.atleast_1d(value) for name, value in given.items() if value is not None}
    found = body_of(arguments.scene).steady(**loads)
    lines = [f"load {n}: {reason}" for n, reason in enumerate(found.reason) if reason]
    if len(lines) > _LINES:
        lines[_LINES:] = [f"{len(lines) - _LINES} more loads have none"]
    show(arguments, found, "\n".join(lines))
    return 0
