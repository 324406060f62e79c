"""Time a motion and peak memory against the number of motions, with one and two threads."""

from __future__ import annotations

import json
import subprocess
import sys
from typing import Any

import numpy as np

#: one size in a process of its own, so that the peak is its own: prints {"seconds", "peak_mb", "before_mb"}
_CHILD = """
import json, resource, sys, time
import numpy as np
import viscoroll as vr
count, threads, rtol, end, seed, options = json.loads(sys.argv[1])
V0, omega0 = np.random.default_rng(seed).uniform(-2.0, 2.0, (2, count))
scene = vr.PAPER_SECTION_5_ROUNDED
def run(n):
    return vr.ensemble(scene, V0[:n], omega0[:n], end, rtol=rtol, fields=("V", "omega"), threads=threads, **options)
run(10)
peak = lambda: resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
before, start = peak(), time.perf_counter()
result = run(count)
print(json.dumps({"seconds": time.perf_counter() - start, "peak_mb": peak(), "before_mb": before}))
"""


def scaling(sizes: dict[str, Any]) -> dict[str, Any]:
    """Rows of motions, threads, us a motion, peak MB; a size that would take too long is skipped and says so."""
    rows, skipped = [], []
    for name, options in sizes["methods"].items():
        for threads in sizes["threads"]:
            rate = 0.0
            for count in sizes["motions"]:
                if rate * count > sizes["longest_s"]:
                    skipped.append({"method": name, "threads": threads, "motions": count, "expected_s": rate * count})
                    continue
                runs = [_child(count, threads, sizes, options) for _ in range(sizes["repeats"])]
                seconds = float(np.median([run["seconds"] for run in runs]))
                rate = seconds / count
                memory = {key: max(run[key] for run in runs) for key in ("peak_mb", "before_mb")}
                rows.append({"method": name, "threads": threads, "motions": count, "us": 1e6 * rate} | memory)
    for row in skipped:
        print(f"benchmark: {row['motions']} motions skipped: {row['expected_s']:.0f} s > {sizes['longest_s']} s")
    return {"rows": rows, "skipped": skipped}


def _child(count: int, threads: int, sizes: dict[str, Any], options: dict[str, Any]) -> dict[str, float]:
    given = json.dumps([count, threads, sizes["rtol"], sizes["end"], sizes["seed"], options])
    result = subprocess.run([sys.executable, "-c", _CHILD, given], check=True, capture_output=True, text=True)
    return json.loads(result.stdout)
