"""What is kept of proofs, as figures: motion-errors.png and transient.png in docs/figures.

python -m pipeline.evidence.prove.figures [-o FOLDER]
"""

from __future__ import annotations

import sys
from typing import Any

import numpy as np

from viscoroll.core.plots import LINES, THIN, new_figure, save

from ...stage import ROOT, make_folder, told
from ..results import RESULTS, Results, parser
from .motion import FACTOR
from .unsteady import LEVELS

#: begin of a claim -> title of its panel; what is below the least is drawn there
PANELS = {
    f"V, omega, condition below {FACTOR:g}": rf"$V$, $\omega$, condition below {FACTOR:g}",
    "x": "$x$",
    "time of onset": "time of onset",
}
_LEAST = 1e-17


def motion_errors(results: Results) -> Any:
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


def transient(results: Results) -> Any:
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


def draw() -> None:
    folder = make_folder(parser(__doc__, ROOT / "docs/figures", sizes=False).parse_args().output)
    for name, drawn in (("motion-errors", motion_errors), ("transient", transient)):
        save(drawn(Results(RESULTS)), folder / f"{name}.png")


if __name__ == "__main__":
    sys.exit(told("proof_figures", draw))
