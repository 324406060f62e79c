"""Rolling resistance over speed, and where the pull of a slope meets it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..equilibria import humps, steady
from ..materials.prony import Prony
from ..plots.style import LINES, THIN, describe, new_figure
from ..presets import PAPER_SECTION_5
from ..rolling_contact import contact
from ..scene import Scene
from ..symbols import label

if TYPE_CHECKING:
    from matplotlib.figure import Figure

#: times two decades apart: a hump each
_RUBBER = Scene(material=Prony(2.0 ** np.arange(5), 100.0 ** -np.arange(5.0)), kappa=10.0, mu=0.2)
#: of the largest M that the slopes pull with
_PULLS = (0.35, 0.7, 0.95)


def rolling_equilibria(
    scene: Scene = PAPER_SECTION_5, rubber: Scene = _RUBBER, pulls: Sequence[float] = _PULLS
) -> Figure:
    """M over V with the equilibria of some slopes: (a) one relaxation time, (b) a rubber of several humps.

    Parameters
    ----------
    scene, rubber : what rolls in either panel.
    pulls : pull of the slopes over the largest M of each.
    """
    title = "Rolling resistance, and the equilibria on a slope: stable (filled) and not (open)"
    figure, (left, right) = new_figure(title, 1, 2, (9.5, 4.2))
    _panel(left, scene, pulls, f"a) {describe(scene, 'alpha', 'kappa', 'mu')}")
    _panel(right, rubber, pulls, f"b) several relaxation times, {describe(rubber, 'kappa', 'mu')}")
    return figure


def _panel(axes: Any, scene: Scene, pulls: Sequence[float], title: str) -> None:
    found = humps(scene)
    V = np.geomspace(found.V[0] / 30.0, 30.0 * found.V[-1], 801)
    axes.semilogx(V, contact(scene, V, delta=0.0, fields="M").M, label=label("M"), **LINES[0])
    theta = np.arctan(np.asarray(pulls) * found.M.max())
    s = steady(scene, slope=theta)
    for n, angle in enumerate(theta):
        axes.axhline(np.tan(angle), **THIN)
        axes.annotate(f"${np.degrees(angle):.2g}^\\circ$", (V[0], np.tan(angle)), fontsize="small", va="bottom")
        for stable, face in ((True, LINES[1]["color"]), (False, "white")):
            at = s.stable[n] if stable else np.isfinite(s.V[n]) & ~s.stable[n]
            name = "" if n else "stable" if stable else "saddle"
            axes.plot(
                s.V[n][at], s.M[n][at], "o", color=LINES[1]["color"], markerfacecolor=face, markersize=5,
                label=name or "_",
            )  # fmt: skip
    axes.set(xlabel=label("V"), ylabel=f"{label('M')}, pull of the slope", title=title)
    axes.set(xlim=(V[0], V[-1]), ylim=(0.0, None))
    axes.legend(frameon=False)
