"""``viscoroll ensemble RUN.toml``, ``... verify STORE`` and ``... export STORE``."""

from __future__ import annotations

import os
import sys
from argparse import Namespace
from pathlib import Path
from typing import Any

from ...core.errors import ParameterError
from .arguments import count, output_path

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
    from ...io.runs import estimate, open_run, read_run, run_ensemble
    from .output import as_text

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
    found = open_run(arguments.output)
    print(as_text(found.to_pandas().reset_index(), str(found)), end="")
    return 0


def _verify(store: str) -> int:
    from ...io.runs import verify

    verdict = verify(store)
    print(f"{store}: {verdict}")
    return 0 if verdict.ok else 1


def _export(store: str, output: Path | None) -> int:
    from ...io.runs import export_netcdf

    if output is None or output.suffix != ".nc":
        raise ParameterError("-o", output, "a file FILE.nc")
    export_netcdf(store, output)
    return 0
