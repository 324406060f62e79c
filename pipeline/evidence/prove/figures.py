"""Tolerance against achieved error of motions, from data/results/proofs.json -> docs/figures/motion-errors.png.

python -m pipeline.evidence.prove.figures [--results FILE] [-o FILE]
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from viscoroll.plots.style import LINES, THIN, new_figure, save

from ...stage import ROOT, told
from ..results import RESULTS, parser
from .motion import FACTOR

if TYPE_CHECKING:
    from matplotlib.figure import Figure

#: begin of a claim -> title of its panel; what is below this is drawn there
PANELS = {
    "V, omega: error over rtol, condition below": rf"$V$, $\omega$, condition below {FACTOR:g}",
    "x: error": "$x$",
    "time of onset: error": "time of onset",
}
_LEAST = 1e-17


def drawn(rows: list[dict[str, Any]]) -> Figure:
    """Worst and median over the motions, with the bound and rtol itself."""
    figure, panels = new_figure(
        "Relative error of random motions over the tolerance asked for", 1, len(PANELS), (9.6, 3.8), sharey=True
    )
    for axes, (begin, title) in zip(panels, PANELS.items(), strict=True):
        row = next(row for row in rows if row["claim"].startswith(begin) and "by_rtol" in row)
        rtol = np.array(sorted(map(float, row["by_rtol"])))
        values = {float(name): found for name, found in row["by_rtol"].items()}
        for name, line, marker in (("worst", LINES[0], "o"), ("median", LINES[1], "s")):
            shown = [max(values[one][name], _LEAST) for one in rtol]
            axes.loglog(rtol, shown, **line, marker=marker, markersize=4, label=f"{name} of the motions")
        axes.loglog(rtol, FACTOR * rtol, **LINES[2], label=f"{FACTOR:g} rtol")
        axes.loglog(rtol, rtol, **THIN, label="rtol")
        axes.set(title=title, xlabel="rtol")
        axes.invert_xaxis()
    panels[0].set_ylabel("relative error")
    panels[0].legend(fontsize="x-small", frameon=False)
    return figure


def draw(results: Path, output: Path) -> None:
    """The figure of the motion proof."""
    save(drawn(json.loads(results.read_text(encoding="utf-8"))["parts"]["motion"]["rows"]), output)
    print(f"{output}: drawn")


def main() -> int:
    options = parser(__doc__, ROOT / "docs/figures/motion-errors.png", sizes=False)
    options.add_argument("--results", type=Path, default=RESULTS / "proofs.json")
    arguments = options.parse_args()
    return told("proof_figures", lambda: draw(arguments.results, arguments.output))


if __name__ == "__main__":
    sys.exit(main())
