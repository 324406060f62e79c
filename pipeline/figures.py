"""Figures: the paper's, the drawing behind the symbols, the site's gallery and that of the ensemble
-> out/figures/*.png.

python -m pipeline.figures [--config FILE] [-o FOLDER]

:data:`FIGURES` has them by name; report_captions.toml has what the page of all results says of
each, in order.  A picture of the gallery is the code of its page: it is run here as a reader runs
it.
"""

import runpy
import sys
import warnings
from functools import partial

import matplotlib as mpl
import matplotlib.pyplot as plt
import msgspec
import numpy as np
from tqdm import tqdm

from viscoroll import ModelWarning, Scene
from viscoroll.contact_mechanics.contact_states import contact
from viscoroll.contact_mechanics.stress import stress
from viscoroll.core.plots import LINES, THIN, axis_label, draw, new_figure, save
from viscoroll.core.quantities import SYMBOLS
from viscoroll.motion.roll import roll
from viscoroll.motion.summaries import drawn_summary
from viscoroll.presets import PAPER_FIGURES_2_3, PAPER_SECTION_5, PAPER_STARTS, RUBBER_CYLINDER

from . import stage
from .validate import loaded

# --- titles and labels ---


def describe(scene: Scene, *names: str) -> str:
    """The named parameters of a scene, for a title line."""
    return ", ".join(f"${SYMBOLS[name].latex} = {number(getattr(scene, name))}$" for name in names)


def number(value: float, digits: int = 4) -> str:
    """A number as mathematics, to stand between dollar signs."""
    mantissa, _, exponent = f"{value:.{digits}g}".partition("e")
    if not exponent:
        return mantissa
    power = f"10^{{{int(exponent)}}}"
    return power if mantissa == "1" else rf"{mantissa}\times {power}"


def scaled(name: str, exponent: int) -> str:
    """Axis label of a quantity whose values are shown times 10^exponent."""
    return rf"${SYMBOLS[name].latex}\times 10^{{{exponent}}}$"


# --- the cylinder with what acts on it, and its contact enlarged ---

#: a driven cylinder at the hump of M; half the critical creep
_DRAWN = Scene(alpha=11.0, kappa=1.0, mu=0.6)
_V = 0.35
_SHARE = 0.55
#: height of the axis over R, so that the contact can be seen
_HEIGHT = 0.955
_GROUND = "0.88"
_BODY = "0.96"
_EDGE = "0.35"
_SPAN = {"arrowstyle": "<|-|>", "color": "black", "shrinkA": 0, "shrinkB": 0, "linewidth": 0.8}
_ARROW = _SPAN | {"arrowstyle": "-|>", "linewidth": 1.3, "mutation_scale": 14}
_TEXT = {"textcoords": "offset points", "fontsize": "large"}
_SMALL = _TEXT | {"fontsize": "small"}


def geometry():
    """Above: the cylinder on the half-space; below: its contact with lam, epsilon, beta, pressure
    and shear.
    """
    figure, (top, bottom) = new_figure(
        "Cylinder and half-space, and the contact between them, enlarged",
        2,
        1,
        6.0,
        height_ratios=(1.0, 1.1),
    )
    _body(top)
    _enlarged(bottom, _DRAWN, _V, _SHARE * contact(_DRAWN, _V, delta=0.0).delta_star)
    return figure


def _arrow(axes, start, end, text="", **style):
    axes.annotate("", end, start, arrowprops=_ARROW, **style)
    axes.annotate(text, end, (5, 3), **_TEXT, **style)


def _body(axes):
    """Circle, half-space, the speeds and the loads."""
    from matplotlib.patches import Circle

    axes.add_patch(Circle((0.0, _HEIGHT), 1.0, facecolor=_BODY, edgecolor=_EDGE, linewidth=1.2))
    axes.fill_between([-1.7, 1.9], [-0.45, -0.45], [0.0, 0.0], color=_GROUND, zorder=2)
    half = np.sqrt(1.0 - _HEIGHT**2)
    turn = np.radians(np.linspace(150.0, 60.0, 60))
    down = np.radians(215.0)
    x = 0.62 * np.cos(turn)
    y = _HEIGHT + 0.62 * np.sin(turn)
    axes.plot([-1.7, 1.9], [0.0, 0.0], color=_EDGE, linewidth=1.2, zorder=3)
    axes.plot(
        [-half, half],
        [0.0, 0.0],
        color=LINES[2]["color"],
        linewidth=3.5,
        zorder=4,
        solid_capstyle="butt",
    )
    axes.plot(0.0, _HEIGHT, "o", color="black", markersize=4)
    axes.plot(x[:-3], y[:-3], color="black", linewidth=1.3)
    axes.plot([0.0, np.cos(down)], [_HEIGHT, _HEIGHT + np.sin(down)], color="0.5", linewidth=0.8)
    _arrow(axes, (0.0, _HEIGHT), (1.45, _HEIGHT), axis_label("V"))
    _arrow(axes, (0.0, 2.45), (0.0, 2.0), "load $P$")
    _arrow(axes, (x[-4], y[-4]), (x[-1], y[-1]), axis_label("omega"))
    _arrow(axes, (half + 0.12, -0.17), (half + 0.75, -0.17), "$QP$", zorder=6)
    axes.annotate("$R$", (0.5 * np.cos(down), _HEIGHT + 0.5 * np.sin(down)), (-3, 5), **_TEXT)
    axes.annotate(
        "contact", (0.0, 0.0), (0, -16), textcoords="offset points", ha="center", zorder=5
    )
    axes.set(xlim=(-1.7, 1.9), ylim=(-0.45, 2.55), aspect="equal")
    axes.set_axis_off()


def _positions(lam, epsilon):
    """Rear edge, front edge and 801 positions between them, dense at both, in units of l0."""
    rear = 0.5 * lam * (epsilon - 1.0)
    front = 0.5 * lam * (epsilon + 1.0)
    x = 0.5 * (rear + front) - 0.5 * (front - rear) * np.cos(np.linspace(0.0, np.pi, 801))
    return rear, front, x


def _enlarged(axes, scene, V, delta):
    """Pressure, its share mu, and shear, over x/l0, with the lengths that the law speaks of."""
    c = contact(scene, V, delta=delta)
    rear, front, x = _positions(c.lam, c.epsilon)
    s = stress(scene, x, V, delta=delta)
    top = float(s.p.max())
    edge = front - c.beta * c.lam
    middle = 0.5 * (rear + front)
    axes.axvspan(edge, front, color="0.92", linewidth=0.0)
    axes.plot(x, s.p / top, label="pressure $p$", **LINES[0])
    axes.plot(x, scene.mu * s.p / top, label=rf"{axis_label('mu')} $p$", **LINES[1])
    axes.plot(x, s.tau / top, label=r"shear $\tau$", **LINES[2])
    axes.axvline(0.0, **THIN | {"linestyle": "--"})
    axes.annotate("below the axis", (0.0, 1.3), (-4, 0), **_SMALL, ha="right")
    for n, (low, high, text) in enumerate(
        (
            (rear, front, f"{axis_label('lam')} $l_0$: contact"),
            (edge, front, f"{axis_label('beta')} {axis_label('lam')} $l_0$: stick"),
            (0.0, middle, f"{axis_label('epsilon')} {axis_label('lam')} $l_0/2$: shift"),
        )
    ):
        height = -0.12 - 0.2 * n
        axes.annotate("", (high, height), (low, height), arrowprops=_SPAN)
        axes.annotate(text, (front, height), (8, 0), **_SMALL, va="center")
    for place in (rear, front, edge, middle):
        axes.plot([place, place], [-0.58, 0.0], **THIN)
    axes.annotate("slip", (0.5 * (rear + edge), 0.08), ha="center", fontsize="small")
    axes.annotate("stick", (0.5 * (edge + front), 0.08), ha="center", fontsize="small")
    axes.set(xlim=(rear - 0.06, front + 0.34), ylim=(-0.62, 1.4), yticks=[])
    axes.set_xticks(np.arange(np.ceil(5.0 * rear), np.floor(5.0 * front) + 1.0) / 5.0)
    axes.set_xlabel("$x/l_0$, along the motion", x=0.38)
    axes.set_ylabel("stress", y=0.6)
    axes.legend(frameon=False, loc="upper right")
    for side in ("left", "right", "top"):
        axes.spines[side].set_visible(False)


# --- the contact law: Figs. 2 and 3 of the paper, the grid of make tables, a rubber roller ---

_MOST_SPEED = 0.4
_MOST_CREEP = 4e-3
#: label of the axis of speeds, dimensionless
_SPEED = r"speed $V T_\varepsilon/R$"
#: alphas of the grid that are drawn
_GRID_ALPHAS = (1.5, 11.0, 81.5)
#: levels of Q/P, up to mu of the grid
_LEVELS = np.linspace(-0.2, 0.2, 17)


def figure_2():
    """Critical creepage delta_star as a function of V, one line an alpha."""
    scene = PAPER_FIGURES_2_3
    V = np.linspace(0.0, _MOST_SPEED, 401)
    figure, axes = new_figure(f"Critical creepage, Eq. (9), for {describe(scene, 'mu', 'kappa')}")
    for alpha, line in zip((1.0, 1.5, 21.5, 81.5), LINES, strict=True):
        star = contact(scene.replace(alpha=alpha), V, delta=0.0, fields="delta_star").delta_star
        axes.plot(V, 1e3 * star, label=rf"{axis_label('alpha')} = {alpha:g}", **line)
    axes.set(
        xlabel=_SPEED,
        ylabel=r"$\delta^*_\alpha\times 10^3$",
        xlim=(0.0, _MOST_SPEED),
        ylim=(0.0, None),
    )
    axes.legend(frameon=False)
    return figure


def figure_3():
    """(a) traction Q over delta at some speeds; (b) moment M over V at some alphas."""
    scene = PAPER_FIGURES_2_3
    figure, (left, right) = new_figure(
        f"Traction and rolling resistance, Eqs. (17), (18), for {describe(scene, 'mu', 'kappa')}",
        1,
        2,
        3.6,
    )
    delta = np.linspace(-_MOST_CREEP, _MOST_CREEP, 801)
    V = np.linspace(-_MOST_SPEED, _MOST_SPEED, 801)
    for speed, line in zip((0.1, 0.2, 0.4), LINES, strict=False):
        Q = contact(scene, speed, delta=delta, fields="Q").Q
        left.plot(1e3 * delta, Q, label=f"{axis_label('V')} = {speed:g}", **line)
    for alpha, line in zip((1.5, 21.5, 81.5), LINES, strict=False):
        M = contact(scene.replace(alpha=alpha), V, delta=0.0, fields="M").M
        right.plot(V, 1e3 * M, label=f"{axis_label('alpha')} = {alpha:g}", **line)
    left.set(
        xlabel=scaled("delta", 3),
        ylabel="creep force $Q/P$",
        title=f"a) {describe(scene, 'alpha')}",
    )
    right.set(
        xlabel=_SPEED,
        ylabel=r"rolling resistance $M/(PR)\times 10^3$",
        title=f"b) any {axis_label('delta')}",
    )
    for axes in (left, right):
        axes.axhline(0.0, **THIN)
        axes.axvline(0.0, **THIN)
        axes.legend(frameon=False, loc="upper left")
    return figure


def grid(table):
    """Q over V and delta as ``make tables`` wrote it, at three alphas: the surface whose slices are
    Fig. 3a.
    """
    figure, panels = new_figure(
        "Creep force of the grid; dashed: critical creepage", 1, 3, 3.2, sharey=True
    )
    for axes, alpha in zip(panels, _GRID_ALPHAS, strict=True):
        plane = table.sel(alpha=alpha)
        filled = axes.contourf(
            plane.V, plane.delta, plane.Q.transpose("delta", "V"), _LEVELS, cmap="cividis"
        )
        for sign, color in ((1.0, "black"), (-1.0, "white")):
            axes.plot(plane.V, sign * plane.delta_star, color=color, linestyle="--", linewidth=1.2)
        axes.set(xscale="log", xlabel=r"speed $V T_\varepsilon/R$", title=rf"$\alpha = {alpha:g}$")
        axes.set_ylim(float(plane.delta[0]), float(plane.delta[-1]))
    panels[0].set_ylabel(rf"creepage {axis_label('delta')}")
    figure.colorbar(filled, ax=panels, label="creep force $Q/P$")
    return figure


def rubber_roller():
    """A rubber roller in SI units, launched without rotation."""
    return RUBBER_CYLINDER.roll(2.0, 0.0, np.linspace(0.0, 0.4, 401)).plot()


# --- the contact during a deceleration: Fig. 7 of the paper ---

#: The times of the paper's Fig. 7.
PAPER_TIMES = (1.52e-4, 4e-4, 24e-4, 30e-4)
_NAMED = ("alpha", "kappa", "mu", "gamma")
#: Times are shown in units of 1e-4.
_UNIT = 1e4


def figure_7():
    """Shear stress and mu p along the contact at four times of the paper's first motion."""
    scene = PAPER_SECTION_5
    start = PAPER_STARTS["IC1"]
    figure, panels = new_figure(
        f"Stresses during IC1, Eqs. (11)-(13), {describe(scene, *_NAMED)}",
        2,
        2,
        5.4,
        sharex=True,
        sharey=True,
    )
    motion = roll(scene, *start, PAPER_TIMES)
    state = motion.contact(("lam", "epsilon", "beta"))
    for n, axes in enumerate(panels.flat):
        _, front, x = _positions(state.lam[n], state.epsilon[n])
        found = stress(scene, x, motion.V[n], delta=motion.delta[n])
        axes.plot(x, 1e3 * np.abs(found.tau), label=r"$|\tau|/E'$", **LINES[0])
        axes.plot(x, 1e3 * scene.mu * found.p, label=r"$\mu p/E'$", **LINES[1])
        axes.axvline(front - state.lam[n] * state.beta[n], **THIN, label="slip | stick")
        axes.axvline(0.0, color="0.7", linewidth=0.6, linestyle=":")
        text = (
            f"{axis_label('delta')} = ${number(motion.delta[n], 2)}$, {axis_label('beta')} = "
            f"{state.beta[n]:.3f}"
        )
        time = rf"{axis_label('t')} = ${_UNIT * motion.t[n]:.3g}\times 10^{{-4}}$"
        axes.set_title(f"{time}:\n{text}", fontsize="medium")
    for axes in panels[1]:
        axes.set_xlabel("$x/l_0$")
    for axes in panels[:, 0]:
        axes.set_ylabel(r"$|\tau|/E'$, $\mu p/E'$  ($\times 10^3$)")
    figure.legend(
        *panels[0, 0].get_legend_handles_labels(),
        loc="outside lower center",
        ncols=3,
        frameon=False,
    )
    return figure


# --- all of them, by name ---

GALLERY = stage.ROOT / "docs/examples/gallery"


def of_page(page, name="figure"):
    """The figure that a page of the gallery gives this name."""
    return runpy.run_path(str(GALLERY / f"{page}.py"))[name]


#: picture -> page of the gallery, and the name of its figure there if it is another
PAGES = {
    "figure-5": "motion/b_section_5",
    "figure-6": "motion/b_section_5 contact",
    "phase-portrait": "motion/c_phase_portrait",
    "rolling-resistance": "materials/b_three_temperatures",
    "rolling-equilibria": "drive/a_equilibria",
    "wheel-spin": "drive/b_wheel_spin",
    "reversal": "drive/c_reversal",
    "slope": "drive/d_slope",
    "law-of-modes": "contact/d_broad_rubber",
    "law-of-pairs": "materials/c_rubber_on_steel",
    "broad-stresses": "contact/d_broad_rubber stresses",
    "load-speed": "heat/c_load_speed",
}
FIGURES = {
    "rubber-roller": rubber_roller,
    "grid": grid,
    "geometry": geometry,
    "figure-2": figure_2,
    "figure-3": figure_3,
    "figure-7": figure_7,
    "ensemble": lambda motions: draw(drawn_summary(motions)),
} | {name: partial(of_page, *page.split()) for name, page in PAGES.items()}


class Figures(msgspec.Struct, forbid_unknown_fields=True):
    """[figures]: the file of the grid."""

    grid: str


def work(settings, out):
    files_of = {"ensemble": out / "ensemble.nc", "grid": stage.ROOT / settings.grid}
    shown = {name: (loaded(path),) for name, path in files_of.items()}
    folder = stage.make_folder(out / "figures")
    files = []
    for name, drawn in tqdm(FIGURES.items(), desc="figures", delay=1.0, leave=False):
        files.append(folder / f"{name}.png")
        save(drawn(*shown.get(name, ())), files[-1])
    return stage.Outcome(files)


if __name__ == "__main__":
    mpl.use("agg")
    plt.style.use(stage.ROOT / "docs/viscoroll.mplstyle")
    warnings.simplefilter("ignore", ModelWarning)  # the paper's cylinder, of which its pages say so
    sys.exit(stage.run("figures", Figures, work, __doc__))
