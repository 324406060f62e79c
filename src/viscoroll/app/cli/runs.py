"""Run files: ``viscoroll ensemble``, ``verify`` and ``sensitivity``."""

from __future__ import annotations

import os
import sys
from argparse import Namespace

import viscoroll as vr

from .arguments import TABLE, command, option, output
from .output import as_text, deliver

_RUN = option("run_file", metavar="RUN.toml", help="a run file")


@command(
    "ensemble", _RUN,
    output(".zarr", required=False, more=": the results store; without this option the size, memory and time of the run are estimated"),
    option("--cluster", metavar="WHERE", help="local (processes of this machine), or the address tcp://host:port of a dask scheduler"),
    option("--threads", type=int, help="number of threads or local processes (default: number of cores)"),
)  # fmt: skip
def ensemble(given: Namespace) -> None:
    """Compute the motions of a run file with random initial speeds and parameters.

    The command computes the motions that are missing in the store, and their summaries.  Call it again to
    resume an interrupted run, or to add motions after n was raised in the run file.
    Without -o it estimates size, memory and time from a short trial.

    example:
      viscoroll ensemble docs/examples/ensemble.toml
    """
    run = vr.runs.read_run(given.run_file)
    if given.output is None:
        if given.cluster is not None:
            raise vr.ParameterError("--cluster", given.cluster, "left out without -o: the trial runs on this machine")
        print(vr.runs.estimate(run, given.threads))
        return
    made = vr.runs.run_ensemble(
        run, given.output, cluster=given.cluster, threads=given.threads,
        progress=sys.stderr.isatty() or (False if os.environ.get("VISCOROLL_QUIET") == "1" else "lines"),
    )  # fmt: skip
    if made < run.blocks:
        print(f"{run.blocks - made} of {run.blocks} blocks were complete already")
    found = vr.runs.open_run(given.output)
    print(as_text(found.to_pandas().reset_index(), str(found)), end="")


@command("verify", option("store", metavar="STORE.zarr", help="results store of viscoroll ensemble"))
def verify(given: Namespace) -> int:
    """Compare every file of a results store with its SHA-256.

    The exit code is 1 if a file differs or is missing.
    """
    verdict = vr.runs.verify(given.store)
    print(f"{given.store}: {verdict}")
    return not verdict.ok


@command(
    "sensitivity", _RUN,
    option("-n", type=int, default=4096, help="number of base points, rounded up to a power of two (default 4096); each needs one "
           "motion for every uncertain input, and two more"),
    *TABLE,
)  # fmt: skip
def sensitivity(given: Namespace) -> None:
    """Compute Sobol indices of the uncertain inputs of a run file.

    The table has first-order (S1) and total (ST) indices of the summarised quantities, with the half-width of the
    95 % confidence interval (S1_conf, ST_conf), sorted by ST.  `viscoroll plot` draws the .nc file as bars.

    example:
      viscoroll sensitivity run.toml -n 4096 -o sensitivity.nc
    """
    from ...io.runs.sensitivity import sobol_indices, table

    indices = sobol_indices(vr.runs.read_run(given.run_file), given.n, progress=sys.stderr.isatty())
    frame, about = table(indices), indices.attrs
    asked, base = about["asked_base_points"], about["base_points"]
    rounded = "" if base == asked else f" ({asked}, rounded up to a power of two)"
    heading = "\n".join((
        f"Sobol indices from {base} base points{rounded}, {about['motions']} motions, seed {about['seed']}",
        *(f"{n} motions {key.removeprefix('ended: ')}" for key, n in about.items() if key.startswith("ended: ")),
        *(f"no indices for {reason}" for reason in about["refused"].splitlines()),
    ))  # fmt: skip
    deliver(given, indices, frame, heading)
    if given.output is not None:
        print(as_text(frame, heading), end="")
