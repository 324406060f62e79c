"""``contact`` beside that of the last release, in processes that take turns: what a version costs those who update.

    python -m pipeline.evidence.bench last-release [--quick] -o out

The release is a commit, checked out into a temporary folder; each process imports one of the two.
"""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from ...stage import ROOT
from ..same import checked_out
from ..timing import printed

#: {case: ns a state} of the package that is found: Q and M at the paper's material, median of some calls; of the
#: processor's time, which follows less what else the machine does
_TIMES = """
seed, states, calls, cases = given
draw, scene = np.random.default_rng(seed), vr.Scene(alpha=11.0, kappa=2.91, mu=0.2, gamma=1.1e4, j=0.5)
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
    """For each case: ns a state here and there, the median of their ratios over the pairs, and whether that is allowed.

    One thread each.  Prints a line a case, that of a ratio beyond what is allowed in capitals.
    """
    given, rounds = [sizes[name] for name in ("seed", "states", "calls", "cases")], []
    with tempfile.TemporaryDirectory() as name:
        there = checked_out(sizes["commit"], Path(name))
        for turn in range(sizes["pairs"]):
            pair = {}
            for tree in (ROOT / "src", there)[:: 1 - 2 * (turn % 2)]:
                pair[tree] = printed(_TIMES, *given, PYTHONPATH=str(tree), VISCOROLL_THREADS="1")
            rounds.append((pair[ROOT / "src"], pair[there]))
    found, allowed = {}, sizes["allowed"]
    for case in sizes["cases"]:
        here, before = (np.array([times[case] for times in side]) for side in zip(*rounds, strict=True))
        ns, ns_before, ratio = (float(np.median(each)) for each in (here, before, here / before))
        found[case] = {"ns": ns, "ns_before": ns_before, "ratio": ratio}
        said = f"{ns:.3g} ns a state, {ns_before:.3g} in {sizes['release']}: {ratio:.2f} times"
        print(f"contact, {case}: {said}, {'BEYOND' if ratio > allowed else 'within'} {allowed}", flush=True)
    return found
