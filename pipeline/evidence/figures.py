"""What is kept of benchmark and proofs, as figures: work-precision.png, bench-own-parameters.png,
motion-errors.png and transient.png in docs/figures.

python -m pipeline.evidence.figures [-o FOLDER]
"""

import sys
from pathlib import Path
from typing import Any

import numpy as np

from viscoroll.core.plots import LINES, THIN, log_ticks, new_figure, new_panels, save

from ..stage import ROOT, make_folder, told
from .document.blocks import finished, paper_rows
from .prove.motion import FACTOR
from .prove.unsteady import LEVELS
from .results import RESULTS, Results, parser

# --- the benchmark ---

#: line and marker by method: told apart without colour
_STYLES = {"flow": "*-k", "table": "o-k", "lsoda": "D-.g", "gsl-adams": "x:C3", "gsl-bdf": "+:C4"}
#: key of a row -> what it is, over all outputs of the motions
_ERRORS = {"max": "largest error", "p99": "99th percentile of the errors"}


def panels(methods: dict[str, str], shown: dict[str, tuple[list[dict[str, Any]], str]]):
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


def work_precision(results):
    """IC1-IC3 and random starts with every peer."""
    work = results["bench work-precision"]
    random = [row for row in work["rows"] if row["group"] == "random"]
    few = {"motions IC1-IC3 of the paper: largest error": (paper_rows(work["rows"]), "max")}
    many = {
        f"{work['sizes']['motions']} random initial speeds: {text}": (random, key)
        for key, text in _ERRORS.items()
    }
    return panels(work["methods"], few | many)


def own_parameters(results):
    """Motions whose scenes are their own."""
    own = results["bench own-parameters"]
    each = {f"a scene for each motion: {text}": (own["rows"], key) for key, text in _ERRORS.items()}
    return panels(own["methods"], each)


# --- proofs ---

#: begin of a claim -> title of its panel; what is below the least is drawn there
PANELS = {
    f"V, omega, condition below {FACTOR:g}": rf"$V$, $\omega$, condition below {FACTOR:g}",
    "x": "$x$",
    "time of onset": "time of onset",
}
_LEAST = 1e-17


def motion_errors(results):
    """Tolerance against achieved error: worst and mean over the motions, with the bound and rtol
    itself.
    """
    rows = results["proofs motion"]["rows"]
    title = "Relative error of random motions against the tolerance rtol"
    figure, panels = new_figure(title, 1, len(PANELS), 3.6, sharey=True)
    for axes, (begin, title) in zip(panels, PANELS.items(), strict=True):
        own = [row for row in rows if row["claim"].startswith(f"{begin}, rtol 1e-")]
        rtol = np.array([float(row["claim"].split("rtol ")[1].split(",")[0]) for row in own])
        for name, line, marker in (("worst", LINES[0], "o"), ("mean", LINES[1], "s")):
            shown = np.maximum(rtol * [row[name] for row in own], _LEAST)
            axes.loglog(
                rtol, shown, **line, marker=marker, markersize=4, label=f"{name} of the motions"
            )
        axes.loglog(rtol, FACTOR * rtol, **LINES[2], label=f"{FACTOR:g} rtol")
        axes.loglog(rtol, rtol, **THIN, label="rtol")
        axes.set(title=title, xlabel="rtol")
        axes.invert_xaxis()
    panels[0].set_ylabel("relative error")
    figure.legend(
        *panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=4, frameon=False
    )
    return figure


def transient(results):
    """The size of e over the unsteadiness, by the law and with N."""
    title = "Relative error of V of free motions, against a transient solver"
    figure, panels = new_figure(title, 1, 2, 4.2, sharey=True)
    words = {"steady": "after a steady contact", "rest": "after a long standstill"}
    colours = {1: LINES[0], 2: LINES[1], 4: LINES[2]}
    for axes, (start, name) in zip(panels, words.items(), strict=True):
        for row in results["transient"]["rows"]:
            for which, style in ((1, "-"), (2, ":")):
                line = colours[row["modes"]] | {"linestyle": style, "linewidth": 1.0}
                places = [
                    (e[0], max(abs(e[which]), 1e-5))
                    for e in row[start]["e"]
                    if e[which] is not None
                ]
                axes.loglog(*zip(*places, strict=True) if places else ((), ()), **line)
        axes.loglog(LEVELS, LEVELS, **THIN, label="error = unsteadiness")
        axes.set(title=name, xlabel="unsteadiness", ylim=(1e-5, 3.0))
    for modes, line in colours.items():
        panels[0].plot(
            [],
            [],
            **(line | {"linestyle": "-"}),
            label=f"{modes} relaxation time{'s' * (modes > 1)}",
        )
    panels[0].plot([], [], color="black", linestyle=":", label="with the correction N")
    panels[0].set_ylabel("relative error of V")
    figure.legend(
        *panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=3, frameon=False
    )
    return figure


FIGURES = {
    "work-precision": work_precision,
    "bench-own-parameters": own_parameters,
    "motion-errors": motion_errors,
    "transient": transient,
}


def draw(results: Results, folder: Path) -> None:
    """Draw all of them into a folder."""
    for name, drawn in FIGURES.items():
        save(drawn(results), folder / f"{name}.png")


if __name__ == "__main__":
    output = parser(__doc__, ROOT / "docs/figures", sizes=False).parse_args().output
    sys.exit(told("figures", lambda: draw(Results(RESULTS), make_folder(output))))
