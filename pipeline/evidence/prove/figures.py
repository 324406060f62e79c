"""Tolerance against achieved error of motions, from data/results/proofs.json -> docs/figures/motion-errors.png.

python -m pipeline.evidence.prove.figures [-o FILE]
"""

from __future__ import annotations

import sys
from typing import Any

import numpy as np

from viscoroll.core.plots.style import LINES, THIN, new_figure, save

from ...stage import ROOT, told
from ..results import RESULTS, Results, parser
from .motion import FACTOR

#: begin of a claim -> title of its panel; what is below the least is drawn there
PANELS = {
    f"V, omega, condition below {FACTOR:g}": rf"$V$, $\omega$, condition below {FACTOR:g}", "x": "$x$",
    "time of onset": "time of onset",
}  # fmt: skip
_LEAST = 1e-17


def drawn(rows: list[dict[str, Any]]) -> Any:
    """Worst and mean over the motions, with the bound and rtol itself."""
    title = "Relative error of random motions over the tolerance asked for"
    figure, panels = new_figure(title, 1, len(PANELS), (9.6, 3.8), sharey=True)
    for axes, (begin, title) in zip(panels, PANELS.items(), strict=True):
        own = [row for row in rows if row["claim"].startswith(f"{begin}, rtol 1e-")]
        rtol = np.array([float(row["claim"].split("rtol ")[1].split(",")[0]) for row in own])
        for name, line, marker in (("worst", LINES[0], "o"), ("mean", LINES[1], "s")):
            shown = np.maximum(rtol * [row[name] for row in own], _LEAST)
            axes.loglog(rtol, shown, **line, marker=marker, markersize=4, label=f"{name} of the motions")
        axes.loglog(rtol, FACTOR * rtol, **LINES[2], label=f"{FACTOR:g} rtol")
        axes.loglog(rtol, rtol, **THIN, label="rtol")
        axes.set(title=title, xlabel="rtol")
        axes.invert_xaxis()
    panels[0].set_ylabel("relative error")
    panels[0].legend(fontsize="x-small", frameon=False)
    return figure


if __name__ == "__main__":
    output = parser(__doc__, ROOT / "docs/figures/motion-errors.png", sizes=False).parse_args().output
    rows = Results(RESULTS)["proofs"]["parts"]["motion"]["rows"]
    sys.exit(told("proof_figures", lambda: save(drawn(rows), output)))
