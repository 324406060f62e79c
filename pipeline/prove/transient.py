"""Rolling that is not steady: a transient solver of the normal contact, beside the law of steady rolling.

Two like standard linear solids in two dimensions, quasistatic, constant load, rolling without slip.  Lengths in half
the contact length at rest, times in T_epsilon, the load pi/2.  With Phi = G p, G the logarithmic kernel,

    w = Phi/alpha + (1 - 1/alpha) m,   m' = Phi - m   at every point of the surface
    w = D - (X - Xc)^2/2 and p >= 0 in contact, the gap >= 0 outside, the integral of p is the load
    (1 + j) V' = -gamma M,   Xc' = 2 kappa V,   M = (mean X of the pressure - Xc)/(2 kappa)

Nothing of viscoroll enters but the curve that this is held against.

python -m pipeline.prove.transient [-o FILE] [--figure FILE] [--h H]: data/results/transient.json and
docs/figures/transient.png, in some minutes.
"""

from __future__ import annotations

import sys
from copy import deepcopy
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import matmul_toeplitz, toeplitz

import viscoroll as vr
from viscoroll.plots.style import LINES, THIN, new_figure, save

from ..results import RESULTS, machine, parser, write_results
from ..stage import ROOT, told

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Curves = dict[float, dict[str, tuple[NDArray[np.float64], NDArray[np.float64]]]]

ALPHA, KAPPA, J, V0 = 11.0, 2.91, 0.5, 1.5
GAMMAS = (0.32, 1.07, 3.2, 10.7, 32.0, 107.0)
#: those drawn, from where the law of steady rolling is good to where it is not
SHOWN = (3.2, 10.7, 32.0, 107.0)
STARTS = {"steady": "from steady contact", "rest": "from a contact at rest"}
#: of the window behind and ahead of the axis, and of the run-in
BEHIND, AHEAD, RUN_IN = 4.0, 40.0, 60.0
#: gamma t that motions are followed to
LAST = 60.0
#: steps of the contact's own swing, and of the memory
_SWING, _MEMORY = 0.1, 0.02


def kernel(h: float, count: int) -> NDArray[np.float64]:
    """Displacement by hats of pressure of width h, at distances 0, h, ...; a constant is free."""
    x = np.abs(np.arange(-1, count + 1) * h)
    twice = 0.5 * x * x * np.log(np.where(x == 0.0, 1.0, x)) - 0.75 * x * x
    second: NDArray[np.float64] = np.diff(twice, 2)
    return -second / (h * np.pi)


class Imprint:
    """A contact and the memory of the surface around it, on a grid that is fixed in the material."""

    def __init__(self, h: float) -> None:
        self.h, self.at = h, round(BEHIND / h)
        self.g = kernel(h, self.at + round(AHEAD / h))
        self.inverses: dict[int, NDArray[np.float64]] = {}
        self.first, self.Xc = -self.at, 0.0
        self.low, self.high = self.at - round(1.0 / h), self.at + round(1.0 / h) + 1
        self.M = 0.0
        self.p = self.pressure(1.0, np.zeros(self.g.size))
        self.phi = self.displacement()
        self.m = self.phi.copy()  # relaxed

    def displacement(self) -> NDArray[np.float64]:
        """Phi on the window."""
        whole = np.zeros(self.g.size)
        whole[self.low : self.high] = self.p
        found: NDArray[np.float64] = matmul_toeplitz(self.g, whole)
        return found

    def pressure(self, compliance: float, history: NDArray[np.float64]) -> NDArray[np.float64]:
        """p on the nodes in contact, which are found too; ``history``: what the surface keeps of the past."""
        x = (self.first + np.arange(self.g.size)) * self.h - self.Xc
        wanted = 0.5 * x * x + history
        for _ in range(1000):
            low, high = self.low, self.high
            inverse = self._inverse(high - low)
            rows, load = inverse.sum(axis=1), 0.5 * np.pi / self.h
            r = inverse @ wanted[low:high]
            D = (compliance * load + r.sum()) / rows.sum()
            p: NDArray[np.float64] = (D * rows - r) / compliance
            if p[0] < 0.0 or p[-1] < 0.0:
                self.low, self.high = low + (p[0] < 0.0), high - (p[-1] < 0.0)
                continue
            n = high - low
            behind = wanted[low - 1] + compliance * (self.g[1 : n + 1] @ p) - D
            ahead = wanted[high] + compliance * (self.g[n:0:-1] @ p) - D
            if behind >= 0.0 and ahead >= 0.0:
                self.M = float(x[low:high] @ p / p.sum()) / (2.0 * KAPPA)
                return p
            self.low, self.high = low - (behind < 0.0), high + (ahead < 0.0)
        raise RuntimeError("the contact was not found")

    def _inverse(self, n: int) -> NDArray[np.float64]:
        if n not in self.inverses:
            self.inverses[n] = np.linalg.inv(toeplitz(self.g[:n]))
        return self.inverses[n]

    def move(self, way: float, dt: float) -> None:
        """The axis goes on by ``way`` in ``dt``; the memory is exact where Phi is linear over the step."""
        self.Xc += way
        cells = round(self.Xc / self.h) - (self.first + self.at)
        if cells:
            self._shift(cells)
        c, kept = 1.0 - 1.0 / ALPHA, np.exp(-dt)
        new = 1.0 + np.expm1(-dt) / dt
        old = 1.0 - kept - new
        past = kept * self.m + old * self.phi
        self.p = self.pressure(1.0 / ALPHA + c * new, c * past)
        self.phi = self.displacement()
        self.m = past + new * self.phi

    def _shift(self, cells: int) -> None:
        """Keep the axis in its place on the window; beyond its ends the memory lags by as much as at them."""
        self.first, self.low, self.high = self.first + cells, self.low - cells, self.high - cells
        lag = self.m - self.phi
        lag = np.concatenate((lag[cells:], np.full(cells, lag[-1]))) if cells > 0 else np.roll(lag, -cells)
        if cells < 0:
            lag[:-cells] = lag[-cells]
        self.phi = self.displacement()
        self.m = self.phi + lag


def steadily(imprint: Imprint, V: float) -> Imprint:
    """Run in at a constant speed, a cell a step."""
    for _ in range(round(RUN_IN / imprint.h)):
        imprint.move(imprint.h, imprint.h / (2.0 * KAPPA * V))
    return imprint


def rolled(imprint: Imprint, gamma: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """t and V of a cylinder that is let go at V0."""
    t, V, pull = [0.0], [V0], -gamma * imprint.M / (1.0 + J)
    longest = min(_SWING / np.sqrt(gamma * (ALPHA - 1.0) / (1.0 + J)), _MEMORY)
    while gamma * t[-1] < LAST:
        dt = min(imprint.h / (2.0 * KAPPA * max(abs(V[-1]), 1e-9)), longest)
        imprint.move(2.0 * KAPPA * dt * (V[-1] + 0.5 * dt * pull), dt)
        before, pull = pull, -gamma * imprint.M / (1.0 + J)
        t.append(t[-1] + dt)
        V.append(V[-1] + 0.5 * dt * (before + pull))
    return np.array(t), np.array(V)


def scene_of(gamma: float) -> vr.Scene:
    """The cylinder."""
    return vr.Scene(alpha=ALPHA, kappa=KAPPA, mu=0.2, gamma=gamma, j=J)


def by_steady_rolling(gamma: float, t: NDArray[np.float64]) -> NDArray[np.float64]:
    """V by the law of steady rolling."""
    return vr.roll(scene_of(gamma), V0, V0, t).V


def curves(h: float, gammas: tuple[float, ...] = GAMMAS) -> Curves:
    """t and V by gamma and by start."""
    run_in = steadily(Imprint(h), V0)
    return {gamma: {"steady": rolled(deepcopy(run_in), gamma), "rest": rolled(Imprint(h), gamma)} for gamma in gammas}


def rows_of(found: Curves) -> list[dict[str, float]]:
    """nu of each gamma, and the largest error of V over the first speed from either start."""
    rows = []
    for gamma, starts in found.items():
        row = {"gamma": gamma, "nu": float(scene_of(gamma).validity(V0).steady.value)}
        for start, (t, V) in starts.items():
            row[start] = float(np.abs(V - by_steady_rolling(gamma, t)).max() / V0)
        rows.append(row)
        print(", ".join(f"{name} {value:.3g}" for name, value in row.items()))
    return rows


def drawn(found: Curves) -> Figure:
    """V/V0 over gamma t: one curve by steady rolling, and the transient ones."""
    title = "A cylinder rolls to rest: by the law of steady rolling (grey) and by a transient solver"
    figure, panels = new_figure(title, 1, 2, (9.6, 3.8), sharey=True)
    s = np.linspace(0.0, LAST, 301)
    for axes, (start, words) in zip(panels, STARTS.items(), strict=True):
        axes.plot(s, by_steady_rolling(1.0, s) / V0, color="0.75", linewidth=5.0)
        for gamma, line in zip(SHOWN, LINES, strict=True):
            t, V = found[gamma][start]
            nu = float(scene_of(gamma).validity(V0).steady.value)
            axes.plot(gamma * t, V / V0, **line, label=rf"$\gamma$ = {gamma:g}, nu = {nu:.2g}")
        axes.axhline(0.0, **THIN)
        axes.set(title=words, xlabel=r"$\gamma t$", xlim=(0.0, LAST))
    panels[0].set_ylabel("$V/V_0$")
    panels[0].legend(fontsize="small", frameon=False)
    return figure


def main() -> int:
    options = parser(__doc__, RESULTS / "transient.json", sizes=False)
    options.add_argument("--figure", type=Path, default=ROOT / "docs/figures/transient.png")
    options.add_argument("--h", type=float, default=0.04, help="cell of the grid, over half the contact length at rest")
    arguments = options.parse_args()

    def measured() -> None:
        found = curves(arguments.h)
        write_results(arguments.output, {"rows": rows_of(found), "h": arguments.h, "machine": machine()})
        save(drawn(found), arguments.figure)
        print(f"{arguments.output}, {arguments.figure}: written")

    return told("transient", measured)


if __name__ == "__main__":
    sys.exit(main())
