"""Time and memory of ensembles from run files -> data/results/ensembles.json (kept in git).

    python -m pipeline.evidence.measure.ensembles [--config FILE] [--quick] [-o FILE]

Every run is a process of its own, timed with its files and its summaries, but without the start of
Python.  Beside the time on the clock stands that of the processors, which other work on the machine
does not change as much.  Sizes are in [ensembles] of the configuration, those of --quick in
[ensembles.quick].  pipeline/evidence/document/ puts the numbers into docs/ensembles.md.
"""

import os
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

import viscoroll as vr
from viscoroll.core.arrays import run_blocks, thread_count
from viscoroll.runs import read_run, run_ensemble, verify
from viscoroll.runs.run_store import Store

from ...stage import Row
from ..results import run
from ..timing import forked, peak_mb, processor_time

START = """
V0 = { distribution = "uniform", loc = -2.0, scale = 4.0 }
omega0 = { distribution = "uniform", loc = -2.0, scale = 4.0 }
"""
FIXED = 'preset = "paper-section-5"\n[start]' + START
UNCERTAIN = f"""
[scene]
alpha = {{ distribution = "uniform", loc = 9.0, scale = 4.0 }}
kappa = {{ distribution = "norm", loc = 2.9, scale = 0.2, truncate = [2.0, 4.0] }}
mu = {{ distribution = "lognorm", s = 0.2, scale = 0.2, truncate = [0.1, 0.5] }}
gamma = {{ distribution = "norm", loc = 1.1e4, scale = 500.0, truncate = [8e3, 1.4e4] }}
j = {{ distribution = "uniform", loc = 0.4, scale = 0.2 }}
[start]{START}
"""
RUN = """
[run]
n = {n}
seed = 1
t = 3e-3
rtol = 1e-6
design = "{design}"
keep = "{keep}"
block = {block}
"""


def measure(sizes):
    """All rows, in a folder of their own."""
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        return measured(sizes) | {"threads": thread_count(), "sizes": sizes}


def measured(sizes):
    block = sizes["block"]
    designs = sizes["designs"]
    rolled(FIXED, 4 * block, "warm", block)  # compiles, and builds the flow map
    rows = {
        f"{n} motions of a scene": rolled(FIXED, n, f"fixed-{n}", block) for n in sizes["fixed"]
    }
    for design in ("latin", "sobol"):
        rows[f"{designs} motions of a scene, {design}"] = rolled(
            FIXED, designs, design, block, design=design
        )
    rows[f"{designs} motions of a scene, all kept"] = rolled(
        FIXED, designs, "kept", block, keep="all"
    )
    uncertain = sizes["uncertain"]
    rows[f"{uncertain} motions, seven uncertain inputs"] = rolled(
        UNCERTAIN, uncertain, "uncertain", max(uncertain // 16, 1)
    )
    return {
        "rows": rows,
        "loop": loop(designs, block),
        "cluster": cluster(sizes["cluster"], sizes["rounds"], block),
        "verify_mb_per_s": verified(Path("kept.zarr")),
        **merged(f"fixed-{sizes['fixed'][-1]}"),
    }


def rolled(
    text: str,
    n: int,
    name: str,
    block: int,
    *,
    design: str = "random",
    keep: str = "summaries",
    cluster: str | None = None,
) -> Row:
    """Seconds, peak memory and bytes on disk of a run."""
    path = Path(f"{name}.toml")
    path.write_text(text + RUN.format(n=n, design=design, keep=keep, block=block), encoding="utf-8")
    (taken,) = forked(spent, lambda: run_ensemble(read_run(path), f"{name}.zarr", cluster=cluster))
    if isinstance(taken, str):
        raise vr.ParameterError("ensembles", taken, "one that ends well")
    stored = sum(path.stat().st_size for path in Path(f"{name}.zarr").rglob("*") if path.is_file())
    return {"motions": n, "block": block, "stored_mb": stored / 1e6} | taken


def spent(work: Callable[[], Any]) -> Iterator[dict[str, float]]:
    """Seconds, seconds of processors and peak memory of ``work``."""
    begun = time.perf_counter()
    work()
    yield {"seconds": time.perf_counter() - begun, "cpu_s": processor_time(), "peak_mb": peak_mb()}


def loop(n: int, block: int) -> dict[str, float]:
    """Time of the bare loop over ``vr.ensemble``, on all threads: starts drawn before, nothing
    summarised.
    """
    scene = vr.presets.PAPER_SECTION_5
    t = np.array([3e-3])
    V0, omega0 = np.random.default_rng(1).uniform(-2.0, 2.0, (2, block))

    def work(start, stop):
        vr.ensemble(scene, V0, omega0, t, method="flow", rtol=1e-6, threads=1)

    work(0, 1)
    begun = time.perf_counter()
    begun_cpu = time.process_time()
    run_blocks(work, -(-n // block), 1)
    return {
        "seconds": time.perf_counter() - begun,
        "cpu_s": time.process_time() - begun_cpu,
        "motions": n,
    }


def cluster(blocks: list[int], rounds: int, block: int) -> dict[str, float]:
    """Time a block by threads and by dask: of the blocks between the two numbers; and of dask's
    start.

    Rounds alternate and the least of each counts, so that other work on the machine hits both
    alike.
    """
    if not rounds:
        return {}
    few, many = blocks
    results = {}
    least = {}
    for attempt in range(rounds):
        for count in blocks:
            for where, asked in (("threads", None), ("dask", "local")):
                taken = rolled(
                    FIXED, count * block, f"{where}-{count}-{attempt}", block, cluster=asked
                )
                for clock in ("seconds", "cpu_s"):
                    least[where, count, clock] = min(
                        taken[clock], least.get((where, count, clock), np.inf)
                    )
    for clock in ("seconds", "cpu_s"):
        a_block = {
            w: (least[w, many, clock] - least[w, few, clock]) / (many - few)
            for w in ("threads", "dask")
        }
        results |= {f"{where}_{clock}_a_block": value for where, value in a_block.items()}
        results[f"overhead_{clock}"] = a_block["dask"] / a_block["threads"] - 1.0
    results["dask_start_s"] = least["dask", few, "seconds"] - least["threads", few, "seconds"]
    return results


def merged(name: str) -> dict[str, float]:
    """Bytes of a record, and processor seconds to read and merge one."""
    store = Store(Path(f"{name}.zarr").absolute(), read_run(f"{name}.toml"))
    size = max(path.stat().st_size for path in store.root.glob("records/0*"))
    begun = time.process_time()
    store.finish()
    return {
        "record_bytes": size,
        "merge_s_a_block": (time.process_time() - begun) / store.run.blocks,
    }


def verified(store: Path) -> float:
    """MB/s at which a store is read and compared."""
    size = sum(path.stat().st_size for path in store.rglob("*") if path.is_file())
    begun = time.perf_counter()
    if not verify(store).ok:
        raise vr.ParameterError("verify", store, "whole")
    return size / 1e6 / (time.perf_counter() - begun)


if __name__ == "__main__":
    sys.exit(run("ensembles", measure, __doc__))
