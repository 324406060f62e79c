"""``viscoroll ensemble RUN.toml``, ``... verify STORE`` and ``... export STORE``."""

from __future__ import annotations

import os
import sys
from argparse import Namespace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..errors import ParameterError
from .arguments import count, output_path

if TYPE_CHECKING:
    import xarray as xr

    from .output import Sheet

#: options of a run, with what they are if not given
_OPTIONS = {"cluster": None, "threads": None, "dry_run": False}


def add_commands(commands: Any) -> None:
    """Add the command to the program."""
    parser = commands.add_parser(
        "ensemble",
        help="many motions with random starts and parameters, by a run file",
        description="Into a store that an interrupted run can be continued from:\n"
        "  viscoroll ensemble RUN.toml -o STORE.zarr   roll what is missing in the store, and summarise\n"
        "  viscoroll ensemble verify STORE.zarr        every file against its SHA-256; exit code 1 if one differs\n"
        "  viscoroll ensemble export STORE.zarr -o FILE.nc",
        epilog="example:\n  viscoroll ensemble docs/examples/ensemble.toml --dry-run",
    )
    parser.add_argument("what", nargs="+", metavar="RUN.toml", help="a run file; or verify or export, and a store")
    parser.add_argument("--dry-run", action="store_true", help="state size, memory and time, from a short trial")
    parser.add_argument(
        "--cluster", metavar="WHERE", help="local (processes), or tcp://host:port of a dask scheduler; default: threads"
    )
    parser.add_argument(
        "--threads", type=count, help="threads, or local processes; default: as many as there are cores"
    )
    parser.add_argument("-o", dest="output", metavar="FILE", type=output_path(".zarr", ".nc"), help=".zarr or .nc")
    parser.set_defaults(run=_ensemble)


def _ensemble(arguments: Namespace) -> int:
    words = arguments.what
    if words[0] in ("verify", "export"):
        for key, default in _OPTIONS.items():
            if getattr(arguments, key) != default:
                raise ParameterError(
                    f"--{key.replace('_', '-')}", getattr(arguments, key), "given with a run file only"
                )
        if len(words) != 2:
            raise ParameterError("ensemble", " ".join(words), f"{words[0]} STORE.zarr")
        return _verify(words[1]) if words[0] == "verify" else _export(words[1], arguments.output)
    if len(words) != 1:
        raise ParameterError("ensemble", " ".join(words), "one run file, verify STORE.zarr or export STORE.zarr")
    if words[0].endswith(".zarr"):
        sentence = f"{words[0]} holds results: verify {words[0]}, export {words[0]}, or viscoroll plot {words[0]}"
        raise ParameterError("ensemble", words[0], "a run file", sentence)
    return _run(words[0], arguments)


def _run(path: str, arguments: Namespace) -> int:
    from ..runs import estimate, open_summaries, read_run, run_ensemble

    asked = read_run(path)
    if arguments.dry_run:
        print(estimate(asked, arguments.threads))
        return 0
    if arguments.output is None or arguments.output.suffix != ".zarr":
        raise ParameterError("-o", arguments.output, "a folder STORE.zarr for the results (or give --dry-run)")
    made = run_ensemble(
        asked, arguments.output, cluster=arguments.cluster, threads=arguments.threads,
        progress=sys.stderr.isatty() or (False if os.environ.get("VISCOROLL_QUIET") == "1" else "lines"),
    )  # fmt: skip
    if made < asked.blocks:
        print(f"{asked.blocks - made} of {asked.blocks} blocks were there and whole")
    print(_sheet(open_summaries(arguments.output)).text(), end="")
    return 0


def _verify(store: str) -> int:
    from ..runs import verify

    verdict = verify(store)
    print(f"{store}: {verdict}")
    return 0 if verdict.ok else 1


def _export(store: str, output: Path | None) -> int:
    from ..runs import export_netcdf

    if output is None or output.suffix != ".nc":
        raise ParameterError("-o", output, "a file FILE.nc")
    export_netcdf(store, output)
    return 0


def _sheet(summary: xr.Dataset) -> Sheet:
    """Quantiles of every quantity: a row a time."""
    import numpy as np

    from ..errors import MotionStatus
    from .output import Sheet

    heading = ["Ensemble of {motions} motions: design {design}, seed {seed}".format(**summary.attrs)]
    counts = zip(summary["status"].values, summary["ended"].values, strict=True)
    heading += [f"{count} motions {MotionStatus(code).message}" for code, count in counts if count]
    heading.append("quantiles are known to the bin that they lie in, at most 0.4 % wide")
    names = [str(name).removesuffix("_mean") for name in summary if str(name).endswith("_mean")]
    units = {name: summary[f"{name}_mean"].attrs["units"] for name in names} | {"t": summary["t"].attrs["units"]}
    if summary["t"].attrs["units"] != "1":
        heading.append("in SI units: " + ", ".join(f"{name} {unit}" for name, unit in units.items() if unit != "1"))
    size = {name: summary[f"{name}_mean"].size for name in names}
    shown = [f"{t:.10g}" for t in summary["t"].values]
    times = {name: shown if summary[f"{name}_mean"].ndim else [""] for name in names}
    columns = {
        "quantity": np.repeat(names, [size[name] for name in names]),
        "t": np.concatenate([times[name] for name in names]),
    }
    for part in ("mean", "std"):
        columns[part] = np.concatenate([summary[f"{name}_{part}"].values.ravel() for name in names])
    for n, level in enumerate(summary["quantile"].values):
        columns[f"{level:.6g}"] = np.concatenate([summary[f"{name}_quantiles"].values[n].ravel() for name in names])
    return Sheet(tuple(heading), {}, columns)
