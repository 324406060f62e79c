"""``viscoroll steady``."""

from __future__ import annotations

from argparse import Namespace
from typing import Any

from .arguments import FORMATS, NUMBERS, add_output_option, add_scene_options, angles, numbers
from .body import body_of

#: columns, as of :class:`viscoroll.equilibria.Steady`
_COLUMNS = ("force", "torque", "V", "omega", "delta", "Q", "M", "beta", "grip", "stable")
_TITLE = "Steady rolling of a viscoelastic cylinder"
#: loads without an equilibrium that are told of
_LINES = 3


def add_commands(commands: Any) -> None:
    """Add the command to the program."""
    parser = commands.add_parser(
        "steady",
        help="steady rolling under force, torque or slope",
        description="Every equilibrium of rolling under each load, a row each; where there is none, why.\n"
        f"Options are {NUMBERS}, all of one length or single.",
        epilog="example:\n  viscoroll steady --preset paper-section-5-rounded --slope 0deg:6deg:61",
    )
    parser.add_argument("--force", type=numbers, help="over P, along V (default 0)")
    parser.add_argument("--torque", type=numbers, help="over P R, along omega (default 0)")
    slope = (
        "slope angle (rad, or e.g. 3deg or 0deg:6deg:61), positive downhill along +V; the normal load is P cos(slope)"
    )
    parser.add_argument("--slope", type=angles, help=slope)
    parser.add_argument("--V", type=numbers, help="the speed, in place of --force or --torque, which is found")
    add_scene_options(parser)
    add_output_option(parser, *FORMATS)
    parser.set_defaults(run=_steady)


def _steady(arguments: Namespace) -> int:
    import numpy as np

    from .output import Sheet, as_dataset, deliver

    body = body_of(arguments)
    given = {name: getattr(arguments, name) for name in ("force", "torque", "slope", "V")}
    given = {name: np.atleast_1d(value) for name, value in given.items() if value is not None}
    found = body.steady(**given)
    held = np.isfinite(found.V)
    columns: dict[str, Any] = {}
    if "slope" in given:
        columns["slope"] = np.broadcast_to(given["slope"], np.shape(found.count))[np.nonzero(held)[0]]
    columns |= {name: getattr(found, name)[held] for name in _COLUMNS}
    rates = found.eigenvalues[held].real
    columns |= {"rate_fast": rates[:, 0], "rate_slow": rates[:, 1]}
    constants = {name: value for name, value in body.constants.items() if name != "gamma"}
    deliver(
        arguments,
        lambda: Sheet((_TITLE, *_without(found.reason)), constants, columns, body.units),
        lambda: as_dataset(_TITLE, {"row": np.arange(rates.shape[0])}, columns, constants, body.units),
    )
    return 0


def _without(reasons: Any) -> list[str]:
    """A line for the first loads without an equilibrium, and how many more there are."""
    lines = [f"load {n + 1}: {reason}" for n, reason in enumerate(reasons) if reason]
    more = len(lines) - _LINES
    return lines if more <= 0 else [*lines[:_LINES], f"{more} more loads have none"]
