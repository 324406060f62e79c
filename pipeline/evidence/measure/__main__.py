"""Measure the times that README.md and docs/ state -> data/results/measured.json (kept in git).

    python -m pipeline.evidence.measure [--config FILE] [--quick] [-o FILE]

Of everything a user waits for.  Sizes and seeds are in [measure] of the configuration, those
of --quick in [measure.quick].  Times are of this machine, at this moment: run it with nothing else
running.  pipeline/evidence/document/ puts the numbers into the text.
"""

import os
import subprocess
import sys
from functools import partial

import numpy as np

import viscoroll as vr

from ..bench.calls import creep, ensemble, speeds_and_creep, starts
from ..results import run
from ..timing import timed


def measure(sizes):
    """Everything that measured.json holds beside the machine."""
    os.environ["VISCOROLL_THREADS"] = "1"  # every time is that of one core
    return {"time": call_times(sizes) | process_times(sizes), "sizes": sizes}


def call_times(sizes):
    """Median times on one core: of a state or motion in arrays, and of single calls; motions end at
    t = 3e-3.
    """
    random = np.random.default_rng(sizes["seed"])
    n = sizes["timed_states"]
    m = sizes["timed_motions"]
    scene = vr.presets.PAPER_SECTION_5
    end = np.array([3e-3])
    each = scene.replace(alpha=np.exp(random.uniform(0.0, np.log(100.0), n)))
    V, s = speeds_and_creep(random, n)
    start = starts(random, m)
    many = starts(random, 50 * m)

    def contact(own, count, **how):
        delta = creep(own, V[:count], 1.2 * s[:count])
        return count, partial(vr.contact, own, V[:count], delta=delta, fields=("Q", "M"), **how)

    calls = {
        "contact_one_alpha_ns": contact(scene, n),
        "contact_an_alpha_each_ns": contact(each, n),
        "contact_direct_ns": contact(scene, max(n // 20, 1), method="direct"),
        "contact_single_us": (1e3, partial(vr.contact, scene, 0.5, delta=-0.01)),
        "flow_us": (
            1e3 * many[0].size,
            ensemble(scene, many, end, ("V", "omega", "x"), method="flow"),
        ),
    }
    for rtol in (1e-6, 1e-8):
        calls[f"roll_{rtol:.0e}_us"] = 1e3, partial(vr.roll, scene, 1.5, 0.5, end, rtol=rtol)
        calls[f"ensemble_{rtol:.0e}_us"] = (
            1e3 * m,
            ensemble(scene, start, end, ("V", "omega", "x"), rtol=rtol),
        )
    return {name: row["ns"] for name, row in timed(calls, sizes["repeats"]).items()}


def process_times(sizes):
    """Whole processes: import over a bare python, and the program rolling IC1; kernels cached."""
    motion = "paper-section-5", "--V0", "1.5", "--omega0", "0.5", "--t", "3e-3"
    commands = {
        "bare_python_s": ("-c", "pass"),
        "import_s": ("-c", "import viscoroll"),
        "cli_roll_s": ("-m", "viscoroll", "roll", *motion),
    }
    run = partial(subprocess.run, check=True, stdout=subprocess.DEVNULL)
    calls = {
        name: (1e9, partial(run, [sys.executable, *command])) for name, command in commands.items()
    }
    found = {name: row["ns"] for name, row in timed(calls, sizes["processes"]).items()}
    return found | {"import_s": found["import_s"] - found["bare_python_s"]}


if __name__ == "__main__":
    sys.exit(run("measure", measure, __doc__, "measured.json"))
