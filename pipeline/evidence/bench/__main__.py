"""Run time against error, beside what people would use instead -> data/results/bench.json (kept in
git).

    python -m pipeline.evidence.bench [--config FILE] [--quick] [--only PART ...] [-o FILE]

Sizes are in [bench.PART] of the configuration, those of --quick in [bench.PART.quick].  Times are
of this machine at this moment, medians of alternating runs on one core: run it with nothing else
running.  A peer that is not installed is skipped with a printed reason
(README.md beside).  pipeline/evidence/figures.py draws it.
"""

import os
import sys
import tempfile
from pathlib import Path

import numpy as np

from ...stage import ROOT
from ..results import run_parts
from ..same import checked_out
from ..timing import printed
from .calls import bound_law, fixed_scene, series
from .motions import driven, own_parameters, work_precision

# --- whole processes: first calls, and calls beside the last release ---

#: the first calls of one process, in this order: a row behind each, all since the process began
_FIRST = """
import os
from pathlib import Path
cache, folder, calls, motions = given
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
        "cache": cache, "call": name, "cpu_s": time.process_time(), "wall_s": time.perf_counter() - start,
        "peak_mb": memory("VmHWM") / 1e6, "files": len(sizes), "cache_mb": sum(sizes) / 1e6,
    })
print(json.dumps(rows))
"""  # noqa: E501


def first_calls(sizes):
    """Rows of the first calls of a process whose kernel cache is empty, and of one that finds it
    full.
    """
    with tempfile.TemporaryDirectory() as folder:
        given = folder, sizes["calls"], sizes["motions"]
        return [row for cache in ("empty", "full") for row in printed(_FIRST, cache, *given)]


#: {case: [ns a state, the same of a few states whose tables are in no cache]} of the package that
#: is found, for Q and M at the paper's material, or at alphas of the case: least of some calls, of
#: the processor's time, since other programs only add to either
_STATES = """
seed, states, few, calls, cases = given
draw = np.random.default_rng(seed)
paper = getattr(vr, "presets", vr).PAPER_SECTION_5_ROUNDED  # in the root of 0.1.0
beyond_caches = np.ones(1 << 23)
def least(scene, V, delta, cold):
    seconds = []
    for _ in range(calls + 2):  # the first ones compile, and make the tables
        if cold:
            beyond_caches.sum()
        began = time.process_time()
        vr.contact(scene, V, delta=delta, fields=("Q", "M"))
        seconds.append(time.process_time() - began)
    return 1e9 * min(seconds[2:]) / V.size
found = {}
for name, case in cases.items():
    count = int(states * case.get("share", 1.0))
    V, s = (np.exp(draw.uniform(*np.log(case[axis]), count)) for axis in ("V", "s"))
    scenes = [paper, paper]
    if "alpha" in case:
        alpha = np.exp(draw.uniform(*np.log(case["alpha"]), count))
        scenes = [paper.replace(alpha=alpha), paper.replace(alpha=alpha[:few])]
    delta = s * vr.contact(scenes[0], V, delta=0.0, fields=("delta_star",)).delta_star
    found[name] = [least(scenes[0], V, delta, False), least(scenes[1], V[:few], delta[:few], True)]
print(json.dumps(found))
"""


def last_release(sizes):
    """``contact`` beside that of the last release, checked out into a folder, in processes that
    take turns.

    sizes: those of [bench.last-release] in the configuration.
    Returns a row a case: ns a state here and before, their ratio, and cold and cold_before of a few
    states whose tables are in no cache; each the least over the pairs of processes.  One thread
    each.  Prints a line for each case, in capitals where the ratio is beyond what is allowed.
    """
    given = [sizes[name] for name in ("seed", "states", "few", "calls", "cases")]
    pairs = []
    with tempfile.TemporaryDirectory() as name:
        trees = [ROOT / "src", checked_out(sizes["commit"], Path(name))]
        for turn in range(sizes["pairs"]):
            order = trees[:: 1 - 2 * (turn % 2)]
            pair = {
                tree: printed(_STATES, *given, PYTHONPATH=str(tree), VISCOROLL_THREADS="1")
                for tree in order
            }
            pairs.append([pair[tree] for tree in trees])
    rows = []
    allowed = sizes["allowed"]
    for case in sizes["cases"]:
        (here, cold), (before, cold_before) = np.min(
            [[times[case] for times in pair] for pair in pairs], axis=0
        ).tolist()
        ratio = here / before
        rows.append(
            {
                "case": case,
                "ns": here,
                "ns_before": before,
                "ratio": ratio,
                "cold": cold,
                "cold_before": cold_before,
            }
        )
        said = (
            f"{here:.3g} ns a state, {before:.3g} in {sizes['release']}: {ratio:.2f} times "
            f"(cold {cold:.3g})"
        )
        print(
            f"contact, {case}: {said}, {'BEYOND' if ratio > allowed else 'within'} {allowed}",
            flush=True,
        )
    return rows


# --- parts ---

PARTS = {
    part.__name__.replace("_", "-"): part
    for part in (
        work_precision,
        own_parameters,
        fixed_scene,
        bound_law,
        series,
        first_calls,
        driven,
        last_release,
    )
}


if __name__ == "__main__":
    os.environ["VISCOROLL_THREADS"] = (
        "1"  # every time is that of one core, where it does not say otherwise
    )
    sys.exit(run_parts("bench", PARTS, __doc__, "bench.json"))
