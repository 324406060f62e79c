"""Whole processes: import, one motion from the command line, the first contact; kernels cached on disk."""

from __future__ import annotations

import subprocess
import sys
from typing import Any

from ..timing import alternating

_PROCESSES = {
    "bare_python": ("-c", "pass"),
    "numpy": ("-c", "import numpy"),
    "import": ("-c", "import viscoroll"),
    "cli_help": ("-m", "viscoroll", "--help"),
    "cli_roll": ("-m", "viscoroll", "roll", "--preset", "paper-section-5", "--ic", "IC1", "--t-end", "3e-3"),
    "first_contact": ("-c", "import viscoroll as vr; vr.contact(vr.PAPER_SECTION_5, 0.5, delta=-0.01)"),
    "first_contact_alpha_1": ("-c", "import viscoroll as vr; vr.contact(vr.Scene(1.0, 2.91, 0.2), 0.5, delta=-0.01)"),
    "first_roll": ("-c", "import viscoroll as vr; vr.roll(vr.PAPER_SECTION_5, 1.5, 0.5, 3e-3)"),
    "first_ensemble": ("-c", "import viscoroll as vr; vr.ensemble(vr.PAPER_SECTION_5, [1.5] * 9, 0.5, 3e-3)"),
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
