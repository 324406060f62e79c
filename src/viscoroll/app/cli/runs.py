"""Run files: ``viscoroll ensemble``, ``verify`` and ``sensitivity``."""

from __future__ import annotations

import os
import sys
from argparse import Namespace

import viscoroll as vr

from .arguments import TABLE, command, option, output
from .output import as_text, deliver

#: The run file of a command.
_RUN = option("run_file", metavar="RUN.toml", help="a run file")


@command(
    "ensemble", _RUN,
    output(".zarr", required=False, more=": the results store; without it: estimate of time and memory, by a trial"),
    option("--cluster", metavar="WHERE", help="local (processes of this machine), or the address "
        "tcp://host:port of a dask scheduler"),
    option("--threads", type=int, help="number of threads, or of local processes (default: number of cores)"),
)  # fmt: skip
def ensemble(arguments: Namespace) -> None:
    """Roll the motions of a run file and print the summary of all; without a store estimate time and memory.

    Blocks of motions that the store already has are not computed again; where there are any, their number is printed.

    arguments: parsed command line with
        run_file, path of a TOML file;
        output, folder of the results (.zarr), which is made or completed, or None: a few motions are rolled as a trial,
        the estimate is printed, and nothing is written;
        cluster, "local" for processes of this machine, "tcp://host:port" of a dask scheduler, or None for threads of
        this process;
        threads, number of threads or of local processes, >= 1, not used with a scheduler; None: $VISCOROLL_THREADS, or
        where that is not set the cores available.
    Motions beyond the model or the measured bands of the materials give a ModelWarning.
    With output standard error has a progress bar if it is a terminal, else lines of progress unless $VISCOROLL_QUIET is
    "1".
    Returns None, exit code 0, also where motions ended early.
    Raises ParameterError for values that are not allowed, as cluster without output; FileError for a file that cannot
    be read or written, a store in use or a lost cluster; MissingDependencyError without zarr, dask for a cluster, or
    pyarrow for a sample in .parquet; Interrupted at Ctrl-C, finished blocks being kept.
    """
    run = vr.runs.read_run(arguments.run_file)
    if arguments.output is None:
        if arguments.cluster is not None:
            raise vr.ParameterError(
                "--cluster", arguments.cluster, "left out without -o: the trial runs on this machine"
            )
        print(vr.runs.estimate(run, arguments.threads))
        return
    evaluated = vr.runs.run_ensemble(
        run, arguments.output, cluster=arguments.cluster, threads=arguments.threads,
        progress=sys.stderr.isatty() or (False if os.environ.get("VISCOROLL_QUIET") == "1" else "lines"),
    )  # fmt: skip
    if evaluated < run.blocks:
        print(f"{run.blocks - evaluated} of {run.blocks} blocks were complete already")
    results = vr.runs.open_run(arguments.output)
    print(as_text(results.to_pandas().reset_index(), str(results)), end="")


@command("verify", option("store", metavar="STORE.zarr", help="results of viscoroll ensemble"))
def verify(arguments: Namespace) -> int:
    """Compare the files of a results store with their SHA-256 and print the verdict.

    arguments: parsed command line with store, path of the folder of the results.
    Returns True, exit code 1, if a file differs or is missing, else False, exit code 0, also for a run that is not
    finished; the verdict is printed in both cases.
    Raises FileError for a folder that is no store, or where the record of its start is damaged.
    """
    verdict = vr.runs.verify(arguments.store)
    print(f"{arguments.store}: {verdict}")
    return not verdict.ok


@command(
    "sensitivity", _RUN,
    option("-n", type=int, default=4096, help="base points, rounded up to a power of two (default: 4096); a base point "
           "takes a motion for every uncertain input and two more"),
    TABLE,
)  # fmt: skip
def sensitivity(arguments: Namespace) -> None:
    """Compute the Sobol indices of a run file, and print or write them.

    A heading, of text alone, has the numbers of base points and motions, the seed, the number of motions for each way
    in which they ended, and the reasons why a quantity has no indices.

    arguments: parsed command line with
        run_file, path of a TOML file;
        n, number of base points in [16, 65536], 4096 if not given, which is rounded up to a power of two;
        output, path of a .txt or .csv file to which the table, or of a .nc file to which the dataset of
        :func:`.sensitivity.sobol_indices` is written; or None: standard output; beside a file the table is printed as
        text too;
        format of standard output without a file, "text", "csv" or "json".
    Standard error has a progress bar if it is a terminal.  Motions beyond the model or the measured bands of the
    materials give a ModelWarning.
    Returns None.  The table has a row for each quantity, time and input that has indices, with the columns quantity, t
    with its unit as "t [s]" (missing if every quantity is one number for each motion), input, S1, S1_conf, ST and
    ST_conf: first-order and total index, dimensionless, and the half-widths of their 95 % confidence intervals.
    Quantities are in the order of the run file, times ascending, and at each time the largest ST is first.
    Raises ParameterError for values that are not allowed, as correlated inputs, and where no quantity has indices;
    FileError for a file that cannot be read or written; MissingDependencyError for a sample in .parquet without
    pyarrow.
    """
    from ...io.runs.sensitivity import sobol_indices, table

    indices = sobol_indices(vr.runs.read_run(arguments.run_file), arguments.n, progress=sys.stderr.isatty())
    frame, about = table(indices), indices.attrs
    n, base = about["asked_base_points"], about["base_points"]
    rounded = "" if base == n else f" ({n}, rounded up to a power of two)"
    heading = "\n".join((
        f"Sobol indices from {base} base points{rounded}, {about['motions']} motions, seed {about['seed']}",
        *(f"{about[key]} motions {key.removeprefix('ended: ')}" for key in about if key.startswith("ended: ")),
        *(f"no indices for {reason}" for reason in about["refused"].splitlines()),
    ))  # fmt: skip
    deliver(arguments, indices, frame, heading)
    if arguments.output is not None:
        print(as_text(frame, heading), end="")
