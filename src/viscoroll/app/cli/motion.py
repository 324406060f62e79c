"""``viscoroll roll``."""

from __future__ import annotations

import warnings
from argparse import Namespace
from typing import Any

from .arguments import FORMATS, NUMBERS, add_output_option, add_scene, body_of, number, numbers


def add_commands(commands: Any) -> None:
    """Add the command to the program."""
    parser = commands.add_parser(
        "roll",
        help="one motion from given start speeds",
        description="Free motion of the cylinder from (V0, omega0), Eq. (22), through all regimes of slip.\n"
        "Driven, braked, prescribed motions: vr.roll in Python, or a run file (viscoroll ensemble).",
        epilog="example:\n  viscoroll roll paper-section-5 --V0 1.5 --omega0 0.5 --t 0:3e-3:7",
    )
    add_scene(parser)
    parser.add_argument("--V0", type=number, required=True, help="start velocity of the axis")
    parser.add_argument("--omega0", type=number, required=True, help="start angular velocity")
    parser.add_argument("--t", type=numbers, required=True, help=f"output times: {NUMBERS}")
    parser.add_argument("--rtol", type=number, default=1e-8, help="relative tolerance in [1e-12, 1e-2] (default 1e-8)")
    parser.add_argument("--unsteady", action="store_true", help="with the added mass of rolling that is not steady")
    parser.add_argument(
        "--rested", type=number, nargs="?", const=True, default=False, metavar="TIME",
        help="start from a contact that rested: for so long, or, without a time, long",
    )  # fmt: skip
    add_output_option(parser, *FORMATS)
    parser.set_defaults(run=_roll)


def _roll(arguments: Namespace) -> int:
    from .output import show

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # how it ended is printed
        options = {name: getattr(arguments, name) for name in ("rtol", "unsteady", "rested")}
        motion = body_of(arguments.scene).roll(arguments.V0, arguments.omega0, arguments.t, **options)
    show(arguments, motion, str(motion))
    if arguments.output is not None:
        print(motion)
    return 0
