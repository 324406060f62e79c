"""``viscoroll roll``."""

from __future__ import annotations

import math
import warnings
from argparse import Namespace
from typing import TYPE_CHECKING, Any

from ..errors import ParameterError, unknown
from .arguments import (
    FORMATS,
    add_output_option,
    add_scene_options,
    add_time_options,
    number,
)
from .body import body_of
from .drive import add_drive_options, drive_of

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from ..motion import Motion
    from .output import Sheet

#: Rows of a motion on the screen where --t-end leaves the output times to the steps taken.
_ROWS_SHOWN = 20
_COLUMNS, _ACTING = ("t", "V", "omega", "x", "angle", "delta"), ("force", "torque")


def add_commands(commands: Any) -> None:
    """Add the command to the program."""
    parser = commands.add_parser(
        "roll",
        help="one motion from given start speeds",
        description="Motion of the cylinder from (V0, omega0), Eq. (22), through all regimes of slip; free, or\n"
        "pushed, driven and braked.",
        epilog="example:\n  viscoroll roll --preset paper-section-5 --V0 1.5 --omega0 0.5 --times 0:3e-3:7\n"
        "  viscoroll roll --preset paper-section-5 --V0 0 --omega0 0 --times 0:6e-3:7 "
        "--slope 3deg --torque 0@0,0.02@3e-3,0@3e-3",
    )
    parser.add_argument("--V0", type=number, help="start velocity of the axis")
    parser.add_argument("--omega0", type=number, help="start angular velocity")
    parser.add_argument("--ic", metavar="NAME", help="start of the paper's Sect. 5.1: IC1, IC2 or IC3")
    add_time_options(parser, "output falls on the steps taken")
    add_drive_options(parser)
    add_scene_options(parser)
    add_output_option(parser, *FORMATS)
    parser.set_defaults(run=_roll)


def _start(arguments: Namespace, drive: dict[str, Any]) -> tuple[float | None, float | None]:
    """Start speeds; None for one that is prescribed."""
    from ..presets import PAPER_STARTS

    prescribed = drive.keys() & {"V", "omega"}
    if prescribed:
        free = [name for name in ("V", "omega") if name not in prescribed and getattr(arguments, f"{name}0") is None]
        if arguments.ic is not None or free:
            needed = " and ".join(f"--{name}0" for name in free) or "--V0 and --omega0"
            raise ParameterError(
                "start", "--ic" if arguments.ic else "nothing", f"{needed} where a speed is prescribed"
            )
        return arguments.V0, arguments.omega0
    starts = [f"--{name}" for name in ("V0", "omega0", "ic") if getattr(arguments, name) is not None]
    if starts == ["--V0", "--omega0"]:
        return arguments.V0, arguments.omega0
    if starts != ["--ic"]:
        raise ParameterError("start", ", ".join(starts) or "nothing", "--V0 and --omega0, or --ic")
    if arguments.ic not in PAPER_STARTS:
        raise unknown("ic", arguments.ic, PAPER_STARTS, "a start of the paper")
    return PAPER_STARTS[arguments.ic]


def _roll(arguments: Namespace) -> int:
    import numpy as np

    from .output import deliver

    drive, body = drive_of(arguments), body_of(arguments)
    start = _start(arguments, drive)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # how it ended is printed
        motion = body.roll(*start, arguments.t, arguments.rtol, rest=arguments.rest, **drive)
    rows = np.arange(motion.t.size)
    heading = _motion_heading(motion, start, drive)
    if arguments.output is None and np.ndim(arguments.t) == 0 and rows.size > _ROWS_SHOWN:
        heading.append(f"{_ROWS_SHOWN} of {rows.size} output times are shown; -o FILE keeps all")
        rows = np.linspace(0, rows.size - 1, _ROWS_SHOWN).astype(int)
    deliver(
        arguments,
        lambda: _motion_sheet(motion, heading, rows, _COLUMNS + _ACTING * bool(drive), body),
        motion.to_xarray,
    )
    if arguments.output is not None:
        print("\n".join(heading))
    return 0


def _motion_heading(motion: Motion, start: tuple[float | None, ...], drive: dict[str, Any]) -> list[str]:
    V0, omega0 = ("as prescribed" if speed is None else f"{speed:g}" for speed in start)
    heading = [f"Motion from V = {V0}, omega = {omega0}"]
    if "slope" in drive:
        heading.append(f"slope {drive['slope']:.12g} rad: kappa, gamma, force and torque are those of P cos(slope)")
    if math.isnan(motion.onset_time):
        heading.append(f"no onset of partial slip by t = {motion.t[-1]:.12g}")
    else:
        heading.append(f"onset of partial slip: t = {motion.onset_time:.12g}")
    events = [(switch.t, f"{switch.regime} from") for switch in motion.switches]
    events += [(t, "V changes its sign at") for t in motion.reversals.tolist()]
    heading += [f"{what} t = {t:.12g}" for t, what in sorted(events)]
    if not math.isnan(motion.rest_time):
        heading.append(f"rest threshold crossed: t = {motion.rest_time:.12g}")
    return [*heading, f"ended: {motion.message} ({motion.steps} steps)"]


def _motion_sheet(
    motion: Motion, heading: list[str], rows: NDArray[np.intp], names: tuple[str, ...], body: Any
) -> Sheet:
    import numpy as np

    from ..motion.one import REGIMES
    from .output import Sheet

    columns = {name: getattr(motion, name)[rows] for name in names}
    columns["regime"] = np.array([REGIMES[code] if code >= 0 else "not reached" for code in motion.regime[rows]])
    constants = body.constants if body.units else motion.scene.numbers
    return Sheet(tuple(heading), constants, columns, body.units)
