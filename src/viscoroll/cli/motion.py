"""``viscoroll roll`` and ``viscoroll ensemble``."""

from __future__ import annotations

import math
import sys
import warnings
from argparse import Namespace
from typing import TYPE_CHECKING, Any

from ..errors import ParameterError
from .arguments import (
    DISTRIBUTIONS,
    FORMATS,
    PARAMETERS,
    add_output_option,
    add_scene_options,
    add_time_options,
    count,
    distribution,
    number,
    scene_of,
    scene_parameters,
    whole,
)

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from ..motion import Ensemble, Motion
    from .output import Sheet

#: Rows of a motion on the screen where --t-end leaves the output times to the steps taken.
_ROWS_SHOWN = 20


def add_commands(commands: Any) -> None:
    """Add both commands to the program."""
    parser = commands.add_parser(
        "roll",
        help="one motion from given start speeds",
        description="Motion of the cylinder from (V0, omega0), Eq. (22), through all regimes of slip.",
        epilog="example:\n  viscoroll roll --preset paper-section-5 --V0 1.5 --omega0 0.5 --times 0:3e-3:7",
    )
    parser.add_argument("--V0", type=number, help="start velocity of the axis")
    parser.add_argument("--omega0", type=number, help="start angular velocity")
    parser.add_argument("--ic", metavar="NAME", help="start of the paper's Sect. 5.1: IC1, IC2 or IC3")
    add_time_options(parser, "output falls on the steps taken")
    add_scene_options(parser)
    add_output_option(parser, *FORMATS)
    parser.set_defaults(run=_roll)

    parser = commands.add_parser(
        "ensemble",
        help="many motions with random starts and parameters",
        description="Motions with random starts and, if wanted, random parameters of the scene: each\n"
        f"{DISTRIBUTIONS}.  Prints a summary.\n"
        "-o FILE.nc keeps every motion, FILE.csv too (a row per motion and time), FILE.txt the summary.",
        epilog="example:\n  viscoroll ensemble --preset paper-section-5 -n 1000 --seed 1 "
        "--V0 uniform:-2:2 --omega0 normal:0:1 --mu uniform:0.1:0.3 --times 1e-3,3e-3",
    )
    parser.add_argument("-n", type=count, required=True, help="number of motions")
    parser.add_argument(
        "--seed", type=whole, default=0, help="seed of the random numbers, kept in the file (default 0)"
    )
    parser.add_argument("--design", default="random", help="random (default), latin or sobol")
    parser.add_argument(
        "--method", default="auto", help="auto (default): many motions of one scene from its flow map; flow; integrate"
    )
    for name in ("--V0", "--omega0"):
        parser.add_argument(name, type=distribution, required=True, help=DISTRIBUTIONS)
    add_time_options(parser, "the final state alone")
    add_scene_options(parser, distribution)
    add_output_option(parser, *FORMATS)
    parser.set_defaults(run=_ensemble)


def _start(arguments: Namespace) -> tuple[float, float]:
    from ..scene import PAPER_STARTS

    given = {f"--{name}": value for name in ("V0", "omega0", "ic") if (value := getattr(arguments, name)) is not None}
    if given.keys() == {"--V0", "--omega0"}:
        return arguments.V0, arguments.omega0
    if given.keys() != {"--ic"}:
        raise ParameterError("start", ", ".join(given) or "nothing", "--V0 and --omega0, or --ic")
    if arguments.ic not in PAPER_STARTS:
        raise ParameterError("ic", repr(arguments.ic), "out of " + ", ".join(PAPER_STARTS))
    return PAPER_STARTS[arguments.ic]


def _roll(arguments: Namespace) -> int:
    import numpy as np

    from ..motion import roll
    from .output import deliver

    start = _start(arguments)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # how it ended is printed
        motion = roll(scene_of(arguments), *start, arguments.t, arguments.rtol, rest=arguments.rest)
    rows = np.arange(motion.t.size)
    heading = _motion_heading(motion, start)
    if arguments.output is None and np.ndim(arguments.t) == 0 and rows.size > _ROWS_SHOWN:
        heading.append(f"{_ROWS_SHOWN} of {rows.size} output times are shown; -o FILE keeps all")
        rows = np.linspace(0, rows.size - 1, _ROWS_SHOWN).astype(int)
    deliver(arguments.output, lambda: _motion_sheet(motion, heading, rows), motion.to_xarray)
    if arguments.output is not None:
        print("\n".join(heading))
    return 0


def _motion_heading(motion: Motion, start: tuple[float, float]) -> list[str]:
    heading = [
        f"Motion from V = {start[0]:g}, omega = {start[1]:g}",
        f"onset of partial slip: t = {motion.onset_time:.12g}",
    ]
    heading += [f"{switch.regime} from t = {switch.t:.12g}" for switch in motion.switches]
    if not math.isnan(motion.rest_time):
        heading.append(f"rest threshold crossed: t = {motion.rest_time:.12g}")
    return [*heading, f"ended: {motion.message} ({motion.steps} steps)"]


def _motion_sheet(motion: Motion, heading: list[str], rows: NDArray[np.intp]) -> Sheet:
    import numpy as np

    from ..motion.single import REGIMES
    from .output import Sheet

    columns = {name: getattr(motion, name)[rows] for name in ("t", "V", "omega", "x", "angle", "delta")}
    columns["regime"] = np.array([REGIMES[code] if code >= 0 else "not reached" for code in motion.regime[rows]])
    constants = {name: getattr(motion.scene, name) for name in PARAMETERS}
    return Sheet(tuple(heading), constants, columns)


def _ensemble(arguments: Namespace) -> int:
    from ..motion import ensemble
    from ..sampling import sample
    from ..scene import Scene
    from .output import deliver

    parameters = scene_parameters(arguments)
    random = {name: value for name, value in parameters.items() if hasattr(value, "ppf")}
    drawn = {"V0": arguments.V0, "omega0": arguments.omega0, **random}
    columns = sample(arguments.n, arguments.seed, arguments.design, **drawn)
    scene = Scene(**{name: columns.columns.get(name, value) for name, value in parameters.items()})
    result = ensemble(
        scene, columns["V0"], columns["omega0"], arguments.t,
        method=arguments.method, rtol=arguments.rtol, rest=arguments.rest, progress=sys.stderr.isatty(),
    )  # fmt: skip
    record = {"seed": arguments.seed, "design": arguments.design}
    record |= {f"drawn_{name}": _formula(value) for name, value in drawn.items()}
    path, summary = arguments.output, _summary_sheet(result, record)
    deliver(
        path,
        lambda: _motions_sheet(result) if path is not None and path.suffix == ".csv" else summary,
        lambda: result.to_xarray().assign_attrs(record),
    )
    if path is not None and path.suffix != ".txt":
        print(summary.text(), end="")
    return 0


def _formula(value: Any) -> str:
    if not hasattr(value, "ppf"):
        return repr(value)
    return f"scipy.stats.{value.dist.name}({', '.join(f'{v:g}' for v in value.args)})"


def _constants(result: Ensemble) -> dict[str, float]:
    values = {name: getattr(result.scene, name) for name in PARAMETERS}
    return {name: value for name, value in values.items() if isinstance(value, float)}


def _summary_sheet(result: Ensemble, record: dict[str, Any]) -> Sheet:
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
    names = [name for name in ("V", "omega", "x") if f"{name}_mean" in summary]
    levels = {f"{level:.0%}": n for n, level in enumerate(summary["quantile"].values)}
    columns = {"quantity": np.repeat(names, result.t.size), "t": np.tile(result.t, len(names))}
    columns |= {part: np.concatenate([summary[f"{name}_{part}"].values for name in names]) for part in ("mean", "std")}
    for level, n in levels.items():
        columns[level] = np.concatenate([summary[f"{name}_quantiles"].values[n] for name in names])
    if "onset_time_quantiles" in summary:
        onset = ", ".join(
            f"{v:.6g} ({level})" for level, v in zip(levels, summary["onset_time_quantiles"].values, strict=True)
        )
        heading.append(f"onset of partial slip: t = {onset}")
    return Sheet(tuple(heading), _constants(result), columns)


def _motions_sheet(result: Ensemble) -> Sheet:
    """A row per motion and output time."""
    import numpy as np

    from .output import Sheet

    each = {"motion": np.arange(len(result)), "V0": result.V0, "omega0": result.omega0}
    each |= {name: getattr(result.scene, name) for name in PARAMETERS if np.ndim(getattr(result.scene, name))}
    each |= {name: getattr(result, name) for name in ("onset_time", "rest_time", "status")}
    columns = {name: np.repeat(value, result.t.size) for name, value in each.items()}
    columns["t"] = np.tile(result.t, len(result))
    columns |= {name: getattr(result, name).ravel() for name in ("V", "omega", "x")}
    return Sheet((), _constants(result), columns)
