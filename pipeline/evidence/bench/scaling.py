"""Time a motion and peak memory against the number of motions, with one and two threads."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..timing import printed

#: one size in a process of its own, so that the peak is its own: prints {"seconds", "peak_mb", "before_mb"}.  Starts
#: are drawn and distances added up block by block, which is part of the time: nothing is kept of a block
_CHILD = """
count, threads, rtol, end, seed, block, options = given
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
    return printed(_CHILD, count, threads, *(sizes[name] for name in ("rtol", "end", "seed", "block")), options)
