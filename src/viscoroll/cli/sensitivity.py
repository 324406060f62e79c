"""``viscoroll sensitivity``."""

from __future__ import annotations

import sys
from argparse import Namespace
from typing import TYPE_CHECKING, Any

from . import plot
from .arguments import FORMATS, add_output_option, count, output_path

if TYPE_CHECKING:
    import xarray as xr

    from .output import Sheet

_INDICES = ("S1", "S1_conf", "ST", "ST_conf")


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
    from ..runs import read_run
    from ..runs.sensitivity import sobol_indices
    from .output import is_csv, put

    indices = sobol_indices(read_run(arguments.file), arguments.n, progress=sys.stderr.isatty())
    path = arguments.output
    as_csv = path is not None and is_csv(path)
    put(arguments, lambda: _sheet(indices, provenance=as_csv), lambda: indices)
    if path is not None and path.suffix.lower() != ".txt":
        print(_sheet(indices).text(), end="")
    if arguments.plot is not None:
        from ..plots.sensitivity import sobol_bars
        from ..plots.style import save

        save(sobol_bars(indices), arguments.plot)
    return 0


def _sheet(indices: xr.Dataset, *, provenance: bool = False) -> Sheet:
    """A row for each quantity, time and input: to four decimals, or in full with seed, versions and run file."""
    import numpy as np

    from ..results import unit_of
    from .output import Sheet

    rows = [row for name in indices if str(name).endswith("_S1") for row in _rows(indices, str(name)[: -len("_S1")])]
    names = ("quantity", "t", "input", *_INDICES)
    columns = {name: np.array(column, object) for name, column in zip(names, zip(*rows), strict=True)}
    about = indices.attrs
    if not provenance:
        columns |= {name: np.array([f"{round(value, 4) + 0.0:.4f}" for value in columns[name]]) for name in _INDICES}
    else:
        for key in ("base_points", "seed", "source", "versions", "run_file"):
            columns[key] = np.full(len(rows), about[key], object)
    unit = unit_of(indices["t"].attrs)
    return Sheet(_heading(about), {"confidence": about["confidence"]}, columns, {"t": unit} if unit else {})


def _heading(about: dict[str, Any]) -> tuple[str, ...]:
    base, asked = about["base_points"], about["asked_base_points"]
    rounded = "" if base == asked else f" ({asked}, rounded up to a power of two)"
    ended = [f"{n} motions {key.removeprefix('ended: ')}" for key, n in about.items() if key.startswith("ended: ")]
    refused = [f"no indices of {reason}" for reason in about["refused"].splitlines()]
    return (
        f"Sobol indices from {base} base points{rounded}, {about['motions']} motions, seed {about['seed']}",
        about["source"], *ended, *refused,
    )  # fmt: skip


def _rows(indices: xr.Dataset, name: str) -> list[tuple]:
    """(quantity, t, input, indices) of a quantity, the largest total index first at each t; t is "" if it has none."""
    import numpy as np

    inputs = indices["input"].values
    tables = [np.atleast_2d(indices[f"{name}_{key}"].values) for key in _INDICES]
    times = indices["t"].values.tolist() if indices[f"{name}_S1"].ndim == 2 else [""]
    rows = []
    for t, *columns in zip(times, *tables, strict=True):
        for i in np.argsort(-columns[_INDICES.index("ST")], kind="stable"):
            if np.isfinite(columns[0][i]):  # what was refused stands in the heading
                rows.append((name, t, inputs[i], *(float(column[i]) for column in columns)))
    return rows
