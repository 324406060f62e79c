"""``viscoroll plot``."""

from __future__ import annotations

from argparse import Namespace
from pathlib import Path
from typing import Any

from ..errors import ParameterError
from .arguments import add_output_option

FORMATS = (".png", ".pdf", ".svg")


def add_commands(commands: Any) -> None:
    """Add the command to the program."""
    parser = commands.add_parser(
        "plot",
        help="one of the figures, or the results of a run",
        description="Draw one of the figures of viscoroll.figures (a wrong name gets the list of names), or the\n"
        "summaries of a results store: quantile bands and histograms.",
        epilog="example:\n  viscoroll plot figure-5 -o figure-5.png",
    )
    parser.add_argument("what", metavar="WHAT", help="name of the figure, or STORE.zarr")
    add_output_option(parser, *FORMATS, required=True)
    parser.set_defaults(run=_plot)


def _plot(arguments: Namespace) -> int:
    from ..figures import FIGURES, save

    if Path(arguments.what).suffix == ".zarr":
        from ..figures import run_distributions
        from ..runs import open_summaries

        save(run_distributions(open_summaries(arguments.what)), arguments.output)
        return 0
    if arguments.what not in FIGURES:
        raise ParameterError("plot", repr(arguments.what), f"out of {', '.join(FIGURES)}, or a store STORE.zarr")
    save(FIGURES[arguments.what](), arguments.output)
    return 0
