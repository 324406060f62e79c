"""``viscoroll ensemble``: a run file, or a few options and everything in memory."""

from __future__ import annotations

import sys
import warnings
from argparse import Namespace
from typing import TYPE_CHECKING, Any

from . import runs
from .arguments import (
    DISTRIBUTIONS,
    FORMATS,
    PARAMETERS,
    add_output_option,
    add_scene_options,
    add_time_options,
    count,
    distribution,
    whole,
)
from .body import parts_of
from .drive import add_drive_options, drive_of

if TYPE_CHECKING:
    from ..motion import Ensemble
    from .output import Sheet


def add_commands(commands: Any) -> None:
    """Add the command to the program."""
    parser = commands.add_parser(
        "ensemble",
        help="many motions with random starts and parameters",
        description="By a run file, into a store that an interrupted run can be continued from:\n"
        "  viscoroll ensemble RUN.toml -o STORE.zarr   roll what is missing in the store, and summarise\n"
        "  viscoroll ensemble verify STORE.zarr        every file against its SHA-256; exit code 1 if one differs\n"
        "  viscoroll ensemble export STORE.zarr -o FILE.nc\n"
        "Or, without a run file, in memory: random starts and, if wanted, random parameters of the scene: each\n"
        f"{DISTRIBUTIONS}.  Prints a summary.\n"
        "-o FILE.nc keeps every motion, FILE.csv too (a row per motion and time), FILE.txt the summary.",
        epilog="example:\n  viscoroll ensemble --preset paper-section-5 -n 1000 --seed 1 "
        "--V0 uniform:-2:2 --omega0 normal:0:1 --mu uniform:0.1:0.3 --times 1e-3,3e-3\n"
        "  viscoroll ensemble --preset paper-section-5 -n 1000 --V0 0 --omega0 0 --slope normal:0:0.01 "
        "--torque 0@0,0.02@3e-3,0@3e-3 --times 3e-3,6e-3",
    )
    parser.add_argument("what", nargs="*", metavar="RUN.toml", help="a run file; or verify or export, and a store")
    runs.add_options(parser)
    parser.add_argument("-n", type=count, help="number of motions")
    parser.add_argument(
        "--seed", type=whole, default=0, help="seed of the random numbers, kept in the file (default 0)"
    )
    parser.add_argument("--design", default="random", help="random (default), latin or sobol")
    parser.add_argument(
        "--method", default="auto", help="auto (default): many motions of one scene from its flow map; flow; integrate"
    )
    for name in ("--V0", "--omega0"):
        parser.add_argument(name, type=distribution, help=DISTRIBUTIONS)
    add_time_options(parser, "the final state alone", required=False)
    add_drive_options(parser, drawn=True)
    add_scene_options(parser, distribution)
    add_output_option(parser, *FORMATS, ".zarr")
    parser.set_defaults(run=_ensemble, parser=parser)


#: fields of its motions, and of driven ones
_FIELDS, _ACTING = ("V", "omega", "x"), ("force", "torque")
#: What an ensemble without a run file cannot do without, and where it is parsed to.
_NEEDED = {"-n": "n", "--V0": "V0", "--omega0": "omega0", "--t-end or --times": "t"}


def _ensemble(arguments: Namespace) -> int:
    if arguments.what:
        return runs.run(arguments)
    runs.refuse_options(arguments)
    prescribed = {f"{name}0" for name in ("V", "omega") if getattr(arguments, name) is not None}
    missing = [name for name, key in _NEEDED.items() if getattr(arguments, key) is None and key not in prescribed]
    if missing:
        arguments.parser.error(f"the following arguments are required: RUN.toml, or {', '.join(missing)}")
    return _in_memory(arguments)


def _in_memory(arguments: Namespace) -> int:
    from ..sampling import sample
    from .output import deliver, is_csv

    parameters, made = parts_of(arguments)
    random = {name: value for name, value in parameters.items() if hasattr(value, "ppf")}
    starts = {name: getattr(arguments, name) for name in ("V0", "omega0")}
    drive = drive_of(arguments)
    random |= {f"drive_{name}": value for name, value in drive.items() if hasattr(value, "ppf")}
    drawn = {name: value for name, value in starts.items() if value is not None} | random
    columns = sample(arguments.n, arguments.seed, arguments.design, **drawn)
    body = made({name: columns.columns.get(name, value) for name, value in parameters.items()})
    result = body.ensemble(
        columns.columns.get("V0"), columns.columns.get("omega0"), arguments.t,
        method=arguments.method, rtol=arguments.rtol, rest=arguments.rest, progress=sys.stderr.isatty(),
        fields=_FIELDS + _ACTING * bool(drive),
        **{name: columns.columns.get(f"drive_{name}", value) for name, value in drive.items()},
    )  # fmt: skip
    record = {"seed": arguments.seed, "design": arguments.design}
    record |= {f"drawn_{name}": _formula(value) for name, value in drawn.items()}
    path, summary = arguments.output, _summary_sheet(result, record, body.units)
    deliver(
        arguments,
        lambda: _motions_sheet(result, body.units) if path is not None and is_csv(path) else summary,
        lambda: result.to_xarray().assign_attrs(record),
    )
    if path is not None and path.suffix.lower() != ".txt":
        print(summary.text(), end="")
    return 0


def _formula(value: Any) -> str:
    if not hasattr(value, "ppf"):
        return repr(value)
    return f"scipy.stats.{value.dist.name}({', '.join(f'{v:g}' for v in value.args)})"


def _constants(result: Ensemble) -> dict[str, float]:
    values = {name: getattr(result.scene, name) for name in PARAMETERS}
    return {name: value for name, value in values.items() if isinstance(value, float)}


def _summary_sheet(result: Ensemble, record: dict[str, Any], units: dict[str, str]) -> Sheet:
    import numpy as np

    from .output import Sheet

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # of a time that no motion reached: NaN says it
        summary = result.summary()
    heading = [f"Ensemble of {len(result)} motions: " + ", ".join(f"{name} {value}" for name, value in record.items())]
    heading += [f"{n} motions {text}" for text, n in result.messages().items()]
    if result.flow.any():
        heading.append(f"{result.flow.sum()} motions from the flow map, stated error {result.flow_error:.1e}")
    elif result.flow_problem:
        heading.append(f"no flow map: {result.flow_problem}")
    names = [name for name in _FIELDS + _ACTING if f"{name}_mean" in summary]
    levels = {f"{level:.0%}": n for n, level in enumerate(summary["quantile"].values)}
    shown = [f"{name}, {units[name]}" if name in units else name for name in names]
    columns = {"quantity": np.repeat(shown, result.t.size), "t": np.tile(result.t, len(names))}
    columns |= {part: np.concatenate([summary[f"{name}_{part}"].values for name in names]) for part in ("mean", "std")}
    for level, n in levels.items():
        columns[level] = np.concatenate([summary[f"{name}_quantiles"].values[n] for name in names])
    if "onset_time_quantiles" in summary:
        onset = ", ".join(
            f"{v:.6g} ({level})" for level, v in zip(levels, summary["onset_time_quantiles"].values, strict=True)
        )
        heading.append(f"onset of partial slip: t = {onset}")
    return Sheet(tuple(heading), _constants(result), columns, {"t": units["t"]} if units else {})


def _motions_sheet(result: Ensemble, units: dict[str, str]) -> Sheet:
    """A row per motion and output time."""
    import numpy as np

    from .output import Sheet

    each = {"motion": np.arange(len(result)), "V0": result.V0, "omega0": result.omega0}
    each |= {name: getattr(result.scene, name) for name in PARAMETERS if np.ndim(getattr(result.scene, name))}
    each |= {name: getattr(result, name) for name in ("onset_time", "rest_time", "status")}
    columns = {name: np.repeat(value, result.t.size) for name, value in each.items()}
    columns["t"] = np.tile(result.t, len(result))
    found = {name: getattr(result, name) for name in _FIELDS + _ACTING}
    columns |= {name: values.ravel() for name, values in found.items() if values is not None}
    return Sheet((), _constants(result), columns, units)
