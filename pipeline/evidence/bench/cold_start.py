"""Whole processes: import, one motion from the command line, the first calls; kernels cached on disk, or not yet."""

from __future__ import annotations

import subprocess
import sys
import tempfile
from typing import Any

from ..timing import alternating, printed

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

    def run(arguments: tuple[str, ...]) -> None:
        subprocess.run([sys.executable, *arguments], check=True, stdout=subprocess.DEVNULL)

    calls = {name: lambda arguments=_PROCESSES[name]: run(arguments) for name in sizes["processes"]}
    for call in calls.values():
        call()
    seconds = alternating(calls, sizes["repeats"])
    bare = seconds["bare_python"]
    return {name: {"s": value, "over_bare_s": value - bare} for name, value in seconds.items()}


#: the first calls of one process, in this order: a row behind each, all since the process began
_CHILD = """
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
        return {cache: printed(_CHILD, folder, sizes["calls"], sizes["motions"]) for cache in ("empty", "full")}
