"""Whole processes: import, one motion from the command line, first calls, memory of many motions, the last release."""

from __future__ import annotations

import subprocess
import sys
import tempfile
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from ...stage import ROOT
from ..same import checked_out
from ..timing import printed, timed

_PROCESSES = {
    "bare_python": ("-c", "pass"),
    "numpy": ("-c", "import numpy"),
    "import": ("-c", "import viscoroll"),
    "cli_help": ("-m", "viscoroll", "--help"),
    "cli_roll": ("-m", "viscoroll", "roll", "paper-section-5", "--V0", "1.5", "--omega0", "0.5", "--t", "3e-3"),
    "first_contact": ("-c", "import viscoroll as vr; vr.contact(vr.presets.PAPER_SECTION_5, 0.5, delta=-0.01)"),
    "first_contact_alpha_1": ("-c", "import viscoroll as vr; vr.contact(vr.Scene(1.0, 2.91, 0.2), 0.5, delta=-0.01)"),
    "first_roll": ("-c", "import viscoroll as vr; vr.roll(vr.presets.PAPER_SECTION_5, 1.5, 0.5, 3e-3)"),
    "first_ensemble": ("-c", "import viscoroll as vr; vr.ensemble(vr.presets.PAPER_SECTION_5, [1.5] * 9, 0.5, 3e-3)"),
}


def cold_start(sizes: dict[str, Any]) -> dict[str, Any]:
    """Median seconds of each of ``processes``, and those over a bare Python (``over_bare_s``)."""
    run = partial(subprocess.run, check=True, stdout=subprocess.DEVNULL)
    calls = {name: (1e9, partial(run, [sys.executable, *_PROCESSES[name]])) for name in sizes["processes"]}
    seconds = {name: row["ns"] for name, row in timed(calls, sizes["repeats"]).items()}
    return {name: {"s": value, "over_bare_s": value - seconds["bare_python"]} for name, value in seconds.items()}


#: the first calls of one process, in this order: a row behind each, all since the process began
_FIRST = """
import os
from pathlib import Path
folder, calls, motions = given
os.environ["VISCOROLL_CACHE_DIR"] = folder
scene, t = vr.presets.PAPER_SECTION_5, np.linspace(0.0, 3e-3, 30)
V0 = np.random.default_rng(12).uniform(-2.0, 2.0, motions)
run = {
    "contact": lambda: vr.contact(scene, 0.5, delta=-0.01),
    "roll": lambda: vr.roll(scene, 1.5, 0.5, t),
    "ensemble": lambda: vr.ensemble(scene, V0, 0.5, t),
}
rows, start = [], time.perf_counter()
for name in calls:
    run[name]()
    sizes = [path.stat().st_size for path in Path(folder).glob("kernels-*/*")]
    rows.append({
        "call": name, "cpu_s": time.process_time(), "wall_s": time.perf_counter() - start,
        "peak_mb": memory("VmHWM") / 1e6, "files": len(sizes), "cache_mb": sum(sizes) / 1e6,
    })
print(json.dumps(rows))
"""


def first_calls(sizes: dict[str, Any]) -> dict[str, Any]:
    """Rows of the first calls of a process whose kernel cache is empty, and of one that finds it full."""
    with tempfile.TemporaryDirectory() as folder:
        return {cache: printed(_FIRST, folder, sizes["calls"], sizes["motions"]) for cache in ("empty", "full")}


#: one size in a process of its own, so that the peak is its own: prints {"seconds", "peak_mb", "before_mb"}.  Starts
#: are drawn and distances added up block by block, which is part of the time: nothing is kept of a block
_MANY = """
count, threads, options, rtol, end, seed, block = given
scene = vr.presets.PAPER_SECTION_5_ROUNDED
def run(count):
    total = 0.0
    for first in range(0, count, block):
        n = min(block, count - first)
        V0, omega0 = np.random.default_rng([seed, first]).uniform(-2.0, 2.0, (2, n))
        result = vr.ensemble(
            scene, V0, omega0, end, rtol=rtol, fields=("V", "omega", "x"), threads=threads, **options)
        total += result.x.sum()
    return total
run(10)
vr.ensemble(scene, [1.0], [0.5], end, method="integrate")  # compiles what the map's few others need
before, start = memory("VmHWM"), time.perf_counter()
run(count)
seconds = time.perf_counter() - start
print(json.dumps({"seconds": seconds, "peak_mb": memory("VmHWM") / 1e6, "before_mb": before / 1e6}))
"""


def scaling(sizes: dict[str, Any]) -> dict[str, Any]:
    """Rows of motions, threads, us a motion, peak MB; a size that would take too long is skipped and says so."""
    rows, skipped = [], []
    for name, options in sizes["methods"].items():
        for threads in sizes["threads"]:
            each = 0.0
            for count in sizes["motions"]:
                row = {"method": name, "threads": threads, "motions": count}
                if each * count > sizes["longest_s"]:
                    skipped.append(row | {"expected_s": each * count})
                    print(f"benchmark: {count} motions skipped: {each * count:.0f} s > {sizes['longest_s']} s")
                    continue
                found = printed(
                    _MANY, count, threads, options, *(sizes[key] for key in ("rtol", "end", "seed", "block"))
                )
                each = found.pop("seconds") / count
                rows.append(row | {"us": 1e6 * each} | found)
    return {"rows": rows, "skipped": skipped}


#: {case: ns a state} of the package that is found: Q and M at the paper's material, median of some calls; of the
#: processor's time, which follows less what else the machine does
_STATES = """
seed, states, calls, cases = given
draw, scene = np.random.default_rng(seed), vr.presets.PAPER_SECTION_5_ROUNDED
found = {}
for name, case in cases.items():
    count = int(states * case.get("share", 1.0))
    V, s = (np.exp(draw.uniform(*np.log(case[axis]), count)) for axis in ("V", "s"))
    delta = s * vr.contact(scene, V, delta=0.0, fields=("delta_star",)).delta_star
    seconds = []
    for _ in range(calls + 2):  # the first ones compile, and make what is kept
        began = time.process_time()
        vr.contact(scene, V, delta=delta, fields=("Q", "M"))
        seconds.append(time.process_time() - began)
    found[name] = 1e9 * float(np.median(seconds[2:])) / count
print(json.dumps(found))
"""


def last_release(sizes: dict[str, Any]) -> dict[str, Any]:
    """``contact`` beside that of the last release, checked out into a folder, in processes that take turns.

    For each case: ns a state here and there, the median of their ratios over the pairs.  One thread each.  Prints a
    line a case, that of a ratio beyond what is allowed in capitals.
    """
    given, pairs = [sizes[name] for name in ("seed", "states", "calls", "cases")], []
    with tempfile.TemporaryDirectory() as name:
        trees = [ROOT / "src", checked_out(sizes["commit"], Path(name))]
        for turn in range(sizes["pairs"]):
            order = trees[:: 1 - 2 * (turn % 2)]
            pair = {tree: printed(_STATES, *given, PYTHONPATH=str(tree), VISCOROLL_THREADS="1") for tree in order}
            pairs.append([pair[tree] for tree in trees])
    found, allowed = {}, sizes["allowed"]
    for case in sizes["cases"]:
        ns = np.array([[times[case] for times in pair] for pair in pairs])
        here, before, ratio = np.median([*ns.T, ns[:, 0] / ns[:, 1]], axis=1).tolist()
        found[case] = {"ns": here, "ns_before": before, "ratio": ratio}
        said = f"{here:.3g} ns a state, {before:.3g} in {sizes['release']}: {ratio:.2f} times"
        print(f"contact, {case}: {said}, {'BEYOND' if ratio > allowed else 'within'} {allowed}", flush=True)
    return found
