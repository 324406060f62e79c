"""Figures of the benchmark, from data/results/bench-*.json -> docs/figures/.

    python -m pipeline.evidence.bench.figures

A part without results is left out.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from matplotlib.figure import Figure

from viscoroll.core.files import replacing
from viscoroll.core.plots.style import log_ticks

from ...stage import ROOT
from ..document.blocks import finished, moving, paper_rows
from ..results import RESULTS, Results

#: line and marker by method: told apart without colour
_STYLES = {
    "flow": "*-k", "table": "o-k", "direct": "s--b", "atlas": "^--r", "lsoda": "D-.g", "gsl-adams": "x:c",
    "gsl-bdf": "+:c", "scipy-lsoda": "v:m", "scipy-radau": "<:m",
}  # fmt: skip
#: key of a row -> what it is, over all outputs of the motions
_ERRORS = {"max": "max", "p99": "99th percentile"}


def _panels(result: dict[str, Any], shown: dict[str, tuple[list[dict[str, Any]], str]]) -> Figure:
    """Error over time of each panel's rows by a key, a line for each method."""
    figure = Figure((4 * len(shown), 4.2), layout="constrained")
    panels = figure.subplots(1, len(shown), sharey=True)
    for axes, (title, (rows, key)) in zip(panels, shown.items(), strict=True):
        for name, method in result["measured"]["methods"].items():
            points = [(r["us"], r[key]) for r in rows if r["method"] == name and r.get(key) and finished(r)]
            if points:
                axes.loglog(*zip(*points), _STYLES[name], label=method["label"], ms=5, lw=1.2)
        axes.grid(True, which="major", color="0.9")
        axes.set(xlabel="time of a motion, µs, one core", ylim=(1e-12, 10.0))
        axes.set_title(title, fontsize=9)
        log_ticks(axes.xaxis)
    panels[0].set_ylabel("relative error of V and ω")
    figure.legend(
        *panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=4, fontsize=8, frameon=False
    )
    return figure


def work_precision(result: dict[str, Any]) -> Figure:
    """IC1-IC3 with every peer, and the random starts."""
    rows, count = result["measured"]["results"], result["sizes"]["motions"]
    random = moving(row for row in rows if row["group"] == "random")
    few = {"IC1-IC3, down to a speed of 1e-3: max error": (paper_rows(rows), "max")}
    many = {f"{count} random starts, down to 1e-3: {text}": (random, key) for key, text in _ERRORS.items()}
    return _panels(result, few | many)


def own_parameters(result: dict[str, Any]) -> Figure:
    """Max and 99th percentile where every motion has its own scene."""
    rows = moving(result["measured"]["results"])
    title = "every motion its own scene, down to 1e-3"
    return _panels(result, {f"{title}: {text}": (rows, key) for key, text in _ERRORS.items()})


def draw(results: Path, folder: Path) -> None:
    """The figures of all parts whose results are there."""
    folder.mkdir(parents=True, exist_ok=True)
    found = Results(results)
    for name, figure_of in {"work-precision": work_precision, "bench-own-parameters": own_parameters}.items():
        if (result := found.found(f"bench-{name.removeprefix('bench-')}")) is not None:
            with replacing(folder / f"{name}.png") as temporary:
                figure_of(result).savefig(temporary, dpi=110, metadata={"Software": None})


if __name__ == "__main__":
    draw(RESULTS, ROOT / "docs/figures")
