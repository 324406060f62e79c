"""Figures of the benchmark, from data/results/bench-*.json -> docs/figures/.

    python -m pipeline.evidence.bench.figures

A part without results is left out.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure

from viscoroll.files import replacing
from viscoroll.plots.style import log_ticks

from ...stage import ROOT
from ..document.bench import finished, paper_rows, random_rows
from ..results import RESULTS, Results

#: line and marker by method: told apart without colour
_STYLES = {
    "flow": ("#000000", "*", "-"), "table": ("#000000", "o", "-"), "direct": ("#0072b2", "s", "--"),
    "atlas": ("#d55e00", "^", "--"), "lsoda": ("#009e73", "D", "-."), "gsl-adams": ("#666666", "x", ":"),
    "gsl-bdf": ("#666666", "+", ":"), "scipy-lsoda": ("#aa4499", "v", ":"), "scipy-radau": ("#aa4499", "<", ":"),
    "shipped ratios": ("#000000", "*", "-"), "1-D ratio splines": ("#0072b2", "s", "-"),
    "3-D atlas": ("#d55e00", "^", "-"),
}  # fmt: skip
_OTHER = ("#999999", "p", ":")
#: key of a row -> what it is, over all outputs of the motions
_ERRORS = {"max": "max", "p99": "99th percentile"}


def _line(axes: Any, name: str, points: list[tuple[float, float]], label: str, **options: Any) -> None:
    colour, marker, dashes = _STYLES.get(name, _OTHER)
    style = {"color": colour, "marker": marker, "ls": dashes, "ms": 5, "lw": 1.2} | options
    axes.loglog(*zip(*points), label=label, **style)


def _work(axes: Any, rows: list[dict[str, Any]], key: str, methods: dict[str, Any], title: str) -> None:
    """Error over time, a line for each method."""
    for name, method in methods.items():
        points = [(r["us"], r[key]) for r in rows if r["method"] == name and r.get(key) and finished(r)]
        if points:
            _line(axes, name, points, method["label"])
    axes.grid(True, which="major", color="0.9")
    axes.set_xlabel("time of a motion, µs, one core")
    axes.set_ylim(1e-12, 10.0)
    axes.set_title(title, fontsize=9)
    log_ticks(axes.xaxis)


def work_precision(result: dict[str, Any]) -> Figure:
    """IC1-IC3 with every peer, and the random starts."""
    rows, methods = result["measured"]["results"], result["measured"]["methods"]
    figure = Figure((12, 4.2), layout="constrained")
    panels = figure.subplots(1, 3, sharey=True)
    _work(panels[0], paper_rows(rows), "max", methods, "IC1-IC3, down to a speed of 1e-3: max error")
    panels[0].set_ylabel("relative error of V and ω")
    random = [row | {"p99": row.get("p99_moving")} for row in random_rows(rows)]
    for panel, (key, text) in zip(panels[1:], _ERRORS.items(), strict=True):
        _work(panel, random, key, methods, f"{result['sizes']['motions']} random starts, down to 1e-3: {text}")
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=4, fontsize=8, frameon=False)
    return figure


def own_parameters(result: dict[str, Any]) -> Figure:
    """Max and 99th percentile where every motion has its own scene."""
    figure = Figure((8, 3.6), layout="constrained")
    panels, measured = figure.subplots(1, 2, sharey=True), result["measured"]
    for panel, (key, text) in zip(panels, _ERRORS.items(), strict=True):
        _work(panel, measured["results"], key, measured["methods"], f"every motion its own scene: {text}")
    panels[0].set_ylabel("relative error of V and ω")
    panels[0].legend(fontsize=8, frameon=False)
    return figure


def tables(result: dict[str, Any]) -> Figure:
    """Error of Q/mu against size and against look-up time."""
    figure = Figure((8, 3.6), layout="constrained")
    panels, rows = figure.subplots(1, 2, sharey=True), result["measured"]["rows"]
    for panel, (key, text) in zip(panels, {"bytes": "bytes of the table", "ns": "ns for Q and M"}.items(), strict=True):
        for kind in dict.fromkeys(row["kind"] for row in rows):
            points = [(row[key], max(row["error"]["Q_over_mu"], 1e-17)) for row in rows if row["kind"] == kind]
            _line(panel, kind, points, kind, lw=1, ms=6)
        panel.grid(True, color="0.9")
        panel.set_xlabel(text)
        log_ticks(panel.xaxis)
    panels[0].set_ylabel(r"max error of $Q/\mu$")
    panels[0].legend(fontsize=8, frameon=False)
    return figure


def scaling(result: dict[str, Any]) -> Figure:
    """Time of a motion and peak memory over the number of motions."""
    figure = Figure((8, 3.4), layout="constrained")
    panels, rows = figure.subplots(1, 2), result["measured"]["rows"]
    shown = {"us": "time of a motion, µs", "peak_mb": "peak memory, MB"}
    for panel, (key, text) in zip(panels, shown.items(), strict=True):
        for name, threads in sorted({(row["method"], row["threads"]) for row in rows}):
            points = [(r["motions"], r[key]) for r in rows if (r["method"], r["threads"]) == (name, threads)]
            style = {"marker": "o" if threads == 1 else "s", "mfc": "k" if threads == 1 else "w"}
            style |= {"ls": "-" if name == "flow" else "--", "color": "k", "lw": 1}
            _line(panel, name, points, f"{name}, {threads} thread{'s' * (threads > 1)}", **style)
        panel.set(xlabel="motions", ylabel=text)
        panel.grid(True, color="0.9")
    panels[0].legend(fontsize=8, frameon=False, loc="center right")
    panels[1].set_yscale("linear")
    panels[1].set_ylim(0.0, None)
    return figure


FIGURES: dict[str, Callable[[dict[str, Any]], Figure]] = {
    "work-precision": work_precision, "own-parameters": own_parameters, "tables": tables, "scaling": scaling,
}  # fmt: skip


def draw(results: Path, folder: Path) -> None:
    """The figures of all parts whose results are there."""
    folder.mkdir(parents=True, exist_ok=True)
    found = Results(results)
    for part, figure_of in FIGURES.items():
        if (result := found.found(f"bench-{part}")) is not None:
            name = part if part == "work-precision" else f"bench-{part}"
            with replacing(folder / f"{name}.png") as temporary:
                figure_of(result).savefig(temporary, dpi=110, metadata={"Software": None})


if __name__ == "__main__":
    draw(RESULTS, ROOT / "docs/figures")
