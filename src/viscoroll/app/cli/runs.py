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
    output(".zarr", required=False, more=": the store; without it: what the run will take, from a short trial"),
    option("--cluster", metavar="WHERE", help="local (processes), or tcp://host:port of a dask scheduler"),
    option("--threads", type=int, help="threads, or local processes; default: as many as there are cores"),
)  # fmt: skip
def ensemble(given: Namespace) -> None:
    """Many motions with random starts and parameters, by a run file.

    Rolls what is missing in the store and summarises it: the same command continues an interrupted run, or one whose
    file has a larger n now.
    Without -o it states size, memory and time.

    example:
      viscoroll ensemble docs/examples/ensemble.toml
    """
    run = vr.runs.read_run(given.run_file)
    if given.output is None:
        if given.cluster is not None:
            raise vr.ParameterError("--cluster", given.cluster, "left out without -o: the trial is of this machine")
        print(vr.runs.estimate(run, given.threads))
        return
    made = vr.runs.run_ensemble(
        run, given.output, cluster=given.cluster, threads=given.threads,
        progress=sys.stderr.isatty() or (False if os.environ.get("VISCOROLL_QUIET") == "1" else "lines"),
    )  # fmt: skip
    if made < run.blocks:
        print(f"{run.blocks - made} of {run.blocks} blocks were there and whole")
    found = vr.runs.open_run(given.output)
    print(as_text(found.to_pandas().reset_index(), str(found)), end="")


@command("verify", option("store", metavar="STORE.zarr", help="the results of viscoroll ensemble"))
def verify(given: Namespace) -> int:
    """Every file of a store against its SHA-256.

    Exit code 1 if one differs or is missing.
    """
    verdict = vr.runs.verify(given.store)
    print(f"{given.store}: {verdict}")
    return not verdict.ok


@command(
    "sensitivity", _RUN,
    option("-n", type=int, default=4096, help="base points, rounded up to a power of two (default 4096); each costs a "
           "motion for every uncertain input and two more"),
    *TABLE,
)  # fmt: skip
def sensitivity(given: Namespace) -> None:
    """Sobol indices over the uncertain inputs of a run file.

    First-order (S1) and total (ST) indices of the summarised quantities, each with the half-width of its 95 %
    confidence interval (S1_conf, ST_conf), the largest total first.  `viscoroll plot` draws the .nc as bars.

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
        *(f"no indices of {reason}" for reason in about["refused"].splitlines()),
    ))  # fmt: skip
    deliver(given, indices, frame, heading)
    if given.output is not None:
        print(as_text(frame, heading), end="")
