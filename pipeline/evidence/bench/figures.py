"""Figures of the benchmark, from data/results/bench.json -> docs/figures/.

python -m pipeline.evidence.bench.figures [-o FOLDER]
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

from viscoroll.core.plots import log_ticks, new_panels, save

from ...stage import ROOT, make_folder, told
from ..document.blocks import finished, paper_rows
from ..results import RESULTS, Results, parser

#: line and marker by method: told apart without colour
_STYLES = {"flow": "*-k", "table": "o-k", "lsoda": "D-.g", "gsl-adams": "x:C3", "gsl-bdf": "+:C4"}
#: key of a row -> what it is, over all outputs of the motions
_ERRORS = {"max": "largest error", "p99": "99th percentile of the errors"}


def panels(methods: dict[str, str], shown: dict[str, tuple[list[dict[str, Any]], str]]) -> Any:
    """Error over time of each panel's rows by a key, a line for each method."""
    title = "Relative error of V and ω and computing time, for speeds above 1e-3"
    figure, drawn = new_panels(title, len(shown), 2.6, sharey=True)
    for axes, (title, (rows, key)) in zip(drawn, shown.items(), strict=True):
        for name, label in methods.items():
            points = [
                (r["us"], r[key])
                for r in rows
                if r["method"] == name and r.get(key) and finished(r)
            ]
            if points:
                axes.loglog(*zip(*points), _STYLES[name], label=label, ms=5, lw=1.2)
        axes.grid(True, which="major", color="0.9")
        axes.set(xlabel="time of a motion, µs, one core", ylim=(1e-12, 10.0))
        axes.set_title(title.replace(": ", ":\n"), fontsize="small")
        log_ticks(axes.xaxis)
    for axes in drawn[::2]:
        axes.set_ylabel("relative error")
    legend = drawn[0].get_legend_handles_labels()
    figure.legend(*legend, loc="outside lower center", ncols=2, fontsize="small", frameon=False)
    return figure


def draw(found: Results, folder: Path) -> None:
    """IC1-IC3 and random starts with every peer; and motions whose scenes are their own."""
    work = found["bench work-precision"]
    own = found["bench own-parameters"]
    random = [row for row in work["rows"] if row["group"] == "random"]
    few = {"motions IC1-IC3 of the paper: largest error": (paper_rows(work["rows"]), "max")}
    many = {
        f"{work['sizes']['motions']} random initial speeds: {text}": (random, key)
        for key, text in _ERRORS.items()
    }
    each = {f"a scene for each motion: {text}": (own["rows"], key) for key, text in _ERRORS.items()}
    save(panels(work["methods"], few | many), folder / "work-precision.png")
    save(panels(own["methods"], each), folder / "bench-own-parameters.png")


if __name__ == "__main__":
    output = parser(__doc__, ROOT / "docs/figures", sizes=False).parse_args().output
    sys.exit(told("bench_figures", lambda: draw(Results(RESULTS), make_folder(output))))
