"""``viscoroll sensitivity``."""

from __future__ import annotations

import sys
from argparse import Namespace
from typing import Any

from . import plot
from .arguments import FORMATS, add_output_option, count, output_path


def add_commands(commands: Any) -> None:
    """Add the command to the program."""
    parser = commands.add_parser(
        "sensitivity",
        help="Sobol indices over the uncertain inputs of a run file",
        description="First-order (S1) and total (ST) Sobol indices of the summarised quantities of a run file, each\n"
        "with the half-width of its 95 % confidence interval (S1_conf, ST_conf), the largest total first.",
        epilog="example:\n  viscoroll sensitivity run.toml -n 4096 -o sensitivity.nc --plot sensitivity.png",
    )
    parser.add_argument("file", metavar="RUN.toml", help="a run file, as for viscoroll ensemble")
    parser.add_argument(
        "-n", type=count, default=4096, help="base points, rounded up to a power of two (default 4096); each costs a "
        "motion for every uncertain input and two more",
    )  # fmt: skip
    parser.add_argument("--plot", metavar="FILE", type=output_path(*plot.FORMATS), help="bars, as .png, .pdf or .svg")
    add_output_option(parser, *FORMATS)
    parser.set_defaults(run=_sensitivity)


def _sensitivity(arguments: Namespace) -> int:
    from ...io.runs import read_run
    from ...io.runs.sensitivity import sobol_indices, table
    from .output import as_text, deliver

    indices = sobol_indices(read_run(arguments.file), arguments.n, progress=sys.stderr.isatty())
    frame, about = table(indices), indices.attrs
    asked, base = about["asked_base_points"], about["base_points"]
    rounded = "" if base == asked else f" ({asked}, rounded up to a power of two)"
    heading = "\n".join((
        f"Sobol indices from {base} base points{rounded}, {about['motions']} motions, seed {about['seed']}",
        *(f"{n} motions {key.removeprefix('ended: ')}" for key, n in about.items() if key.startswith("ended: ")),
        *(f"no indices of {reason}" for reason in about["refused"].splitlines()),
    ))  # fmt: skip
    deliver(arguments, indices, frame, heading)
    if arguments.output is not None:
        print(as_text(frame, heading), end="")
    if arguments.plot is not None:
        from ...core.plots import draw
        from ...core.plots.style import save

        save(draw(indices), arguments.plot)
    return 0
