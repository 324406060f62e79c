"""``viscoroll identify``."""

from __future__ import annotations

import json
import sys
from argparse import Namespace
from typing import Any

from . import plot
from .arguments import count, output_path, whole


def add_commands(commands: Any) -> None:
    """Add the command to the program."""
    parser = commands.add_parser(
        "identify",
        help="friction, modulus, times, strengths and bearing from measurements",
        description="Fit what is unknown of a cylinder to measured rolling resistance, traction and motions, and say\n"
        "what the data do not tell.  The file has [cylinder], perhaps [material] and [base], and\n"
        "  [unknown]  NAME = [LOW, HIGH], with the start of the cylinder between\n"
        "  [prior]    NAME = [VALUE, SD]\n"
        "  [[data]]   kind = resistance, traction or coastdown; file = a CSV whose columns are named as V, M, delta,\n"
        "             Q, t, omega, x, or by columns = { M = NAME }; sigma, load, temperature, name; V0, omega0, t0, m",
        epilog="example:\n  viscoroll identify docs/examples/measured.toml --plot fit.png",
    )
    parser.add_argument("file", metavar="DATA.toml", help="what is known, what is not, and where the data are")
    parser.add_argument("--starts", type=count, default=8, help="searches from all over the ranges (default 8)")
    parser.add_argument("--seed", type=whole, default=0, help="of their starts (default 0)")
    parser.add_argument("--robust", action="store_true", help="let outliers count less")
    parser.add_argument("--plot", metavar="FILE", type=output_path(*plot.FORMATS), help="data, fit and residuals")
    parser.add_argument(
        "-o", dest="output", metavar="FILE", type=output_path(".txt", ".json", ".nc"),
        help=".txt, .json or .nc; the report is printed too",
    )  # fmt: skip
    parser.add_argument("--format", choices=("text", "json"), default="text", help="of standard output (default: text)")
    parser.set_defaults(run=_identify)


def _identify(arguments: Namespace) -> int:
    from ...core.files import write_dataset, write_text
    from ..identification import identify
    from ..identification.file import read_measurements
    from ..identification.report import as_json

    fit = identify(
        **read_measurements(arguments.file), robust=arguments.robust, starts=arguments.starts, seed=arguments.seed,
        progress=sys.stderr.isatty(),
    )  # fmt: skip
    texts = {"text": lambda: f"{fit}\n", "json": lambda: json.dumps(as_json(fit), indent=1, allow_nan=False) + "\n"}
    print(texts[arguments.format](), end="")
    if (path := arguments.output) is not None and path.suffix == ".nc":
        write_dataset(fit.to_xarray(), path)
    elif path is not None:
        write_text(path, texts["json" if path.suffix == ".json" else "text"]())
    if arguments.plot is not None:
        fit.plot(arguments.plot)
    return 0
