"""Figures of the benchmark, from data/results/bench-*.json -> docs/figures/.

    python -m pipeline.bench.figures

A part without results is left out.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import matplotlib as mpl

mpl.use("Agg")
import matplotlib.pyplot as plt

from viscoroll.files import replacing

from ..document.bench import finished, paper_rows
from ..results import Results
from ..stage import ROOT

#: line and marker by method: told apart without colour
_STYLES = {
    "flow": ("#000000", "*", "-"), "table": ("#000000", "o", "-"), "direct": ("#0072b2", "s", "--"),
    "atlas": ("#d55e00", "^", "--"), "lsoda": ("#009e73", "D", "-."), "gsl-adams": ("#666666", "x", ":"),
    "gsl-bdf": ("#666666", "+", ":"), "scipy-lsoda": ("#aa4499", "v", ":"), "scipy-radau": ("#aa4499", "<", ":"),
}  # fmt: skip
_OTHER = ("#999999", "p", ":")


def _lines(axes: Any, rows: list[dict[str, Any]], key: str, methods: dict[str, Any]) -> None:
    """One line for each method: error over time."""
    for name in methods:
        points = [(r["us"], r[key]) for r in rows if r["method"] == name and r.get(key) and finished(r)]
        if points:
            colour, marker, dashes = _STYLES.get(name, _OTHER)
            us, error = zip(*points)
            axes.loglog(us, error, color=colour, marker=marker, ls=dashes, ms=5, lw=1.2, label=methods[name]["label"])
    axes.grid(True, which="major", color="0.9")
    axes.set_xlabel("time of a motion, µs, one core")
    axes.set_ylim(1e-12, 10.0)


def work_precision(result: dict[str, Any]) -> Any:
    """IC1-IC3 with every peer, and the random starts."""
    rows, methods = result["measured"]["results"], result["measured"]["methods"]
    motions = result["sizes"]["motions"]
    figure, panels = plt.subplots(1, 3, figsize=(12, 4.2), sharey=True, layout="constrained")
    _lines(panels[0], paper_rows(rows), "max", methods)
    panels[0].set_title("IC1-IC3, down to a speed of 1e-3: max error", fontsize=9)
    panels[0].set_ylabel("relative error of V and ω")
    random = [row for row in rows if row["group"] == "random"]
    for panel, key, text in ((panels[1], "max", "max"), (panels[2], "p99", "99th percentile")):
        _lines(panel, random, key, methods)
        panel.set_title(f"{motions} random starts (peers: fewer): {text}", fontsize=9)
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=4, fontsize=8, frameon=False)
    return figure


def own_parameters(result: dict[str, Any]) -> Any:
    """Max and 99th percentile where every motion has its own scene."""
    rows, methods = result["measured"]["results"], result["measured"]["methods"]
    figure, panels = plt.subplots(1, 2, figsize=(8, 3.6), sharey=True, layout="constrained")
    for panel, key, text in ((panels[0], "max", "max"), (panels[1], "p99", "99th percentile")):
        _lines(panel, rows, key, methods)
        panel.set_title(f"every motion its own scene: {text}", fontsize=9)
    panels[0].set_ylabel("relative error of V and ω")
    panels[0].legend(fontsize=8, frameon=False)
    return figure


def tables(result: dict[str, Any]) -> Any:
    """Error of Q/mu against size and against look-up time."""
    figure, panels = plt.subplots(1, 2, figsize=(8, 3.6), sharey=True, layout="constrained")
    kinds = {"shipped ratios": ("#000000", "*"), "1-D ratio splines": ("#0072b2", "s"), "3-D atlas": ("#d55e00", "^")}
    for kind, (colour, marker) in kinds.items():
        rows = [row for row in result["measured"]["rows"] if row["kind"] == kind]
        for panel, key in zip(panels, ("bytes", "ns")):
            values = [row[key] for row in rows]
            error = [max(row["error"]["Q_over_mu"], 1e-17) for row in rows]
            panel.loglog(values, error, color=colour, marker=marker, ls="-", lw=1, ms=6, label=kind)
            panel.grid(True, color="0.9")
    panels[0].set_xlabel("bytes of the table")
    panels[1].set_xlabel("ns for Q and M")
    panels[0].set_ylabel(r"max error of $Q/\mu$")
    panels[0].legend(fontsize=8, frameon=False)
    return figure


def scaling(result: dict[str, Any]) -> Any:
    """Time of a motion and peak memory over the number of motions."""
    figure, panels = plt.subplots(1, 2, figsize=(8, 3.4), layout="constrained")
    rows = result["measured"]["rows"]
    for name, threads in sorted({(row["method"], row["threads"]) for row in rows}):
        part = [row for row in rows if (row["method"], row["threads"]) == (name, threads)]
        style = {"marker": "o" if threads == 1 else "s", "ls": "-" if name == "flow" else "--", "color": "k", "lw": 1}
        style |= {"mfc": "k" if threads == 1 else "w", "label": f"{name}, {threads} thread{'s' * (threads > 1)}"}
        for panel, key in zip(panels, ("us", "peak_mb")):
            panel.loglog([row["motions"] for row in part], [row[key] for row in part], **style)
    for panel, text in zip(panels, ("time of a motion, µs", "peak memory, MB")):
        panel.set_xlabel("motions")
        panel.set_ylabel(text)
        panel.grid(True, color="0.9")
    panels[0].legend(fontsize=8, frameon=False)
    return figure


FIGURES: dict[str, Callable[[dict[str, Any]], Any]] = {
    "work-precision": work_precision,
    "own-parameters": own_parameters,
    "tables": tables,
    "scaling": scaling,
}


def draw(results: Path, folder: Path) -> None:
    """The figures of all parts whose results are there."""
    folder.mkdir(parents=True, exist_ok=True)
    found = Results(results)
    for part, figure_of in FIGURES.items():
        if (result := found.found(f"bench-{part}")) is not None:
            figure = figure_of(result)
            name = part if part == "work-precision" else f"bench-{part}"
            with replacing(folder / f"{name}.png") as temporary:
                figure.savefig(temporary, dpi=110, metadata={"Software": None})
            plt.close(figure)


if __name__ == "__main__":
    draw(ROOT / "data/results", ROOT / "docs/figures")
    sys.exit(0)
