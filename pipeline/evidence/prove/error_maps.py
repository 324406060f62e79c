"""Where the contact law is how accurate -> data/results/error-maps.nc and docs/figures/error-maps.png (kept in git).

    python -m pipeline.evidence.prove.error_maps [--config FILE] [--quick] [-o FILE] [--figure FILE] [--draw]

Largest relative error in each cell of a grid, over random states in it, against certified enclosures: of lam,
epsilon, delta_star and M over (kappa V, alpha), of Q and beta over (kappa V, s) at one alpha, where there are
two ways: by the axis of alpha, as of states with an alpha each, and by the rows of that alpha.  beta's is times
1 - s, over its condition number.
Grid, states a cell and seed are in [error_maps] of the configuration, those of --quick in [error_maps.quick].
With --draw nothing is computed: the figure is drawn from the file.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from tqdm import tqdm

from viscoroll.files import write_dataset
from viscoroll.plots.style import new_figure, save
from viscoroll.symbols import SYMBOLS, label, meaning

from ...stage import ROOT, told
from ..results import RESULTS, parser, read_sizes
from ..stamps import kernels_digest
from ..truth import contact_enclosure
from .contact import by_axis, by_rows, relative_error

if TYPE_CHECKING:
    from matplotlib.figure import Figure

BY_ALPHA = ("lam", "epsilon", "delta_star", "M")
BY_CREEP = ("Q", "beta")
WAYS = {"one by one": by_axis, "slice": by_rows}
#: the figure: half a unit in the last place, and steps of shade in units of it, up to less than 1e-13
ROUNDING = 2.0**-53
LEVELS = (0.0, 1.0, 2.0, 3.0, 5.0, 10.0, 20.0, 40.0)
POOLED = 4
State = tuple[float, float, float, float, float]


def log_edges(low: float, high: float, cells: int) -> NDArray:
    return np.linspace(np.log10(low), np.log10(high), cells + 1)


def errors_of(states: list[State], ways: dict[str, Any], fields: tuple[str, ...]) -> dict[tuple[str, str], NDArray]:
    """(field, way) -> relative error of every state."""
    found = {way: method(states).as_dict() for way, method in ways.items()}
    errors = {(name, way): np.empty(len(states)) for name in fields for way in ways}
    for i, state in enumerate(tqdm(states, desc="error maps", delay=1.0, leave=False)):
        exact = contact_enclosure(*state)
        for name, way in errors:
            errors[name, way][i] = relative_error(float(found[way][name][i]), exact[name])
    return errors


def cells(errors: NDArray, shape: tuple[int, ...]) -> NDArray:
    """Largest over the last axis of ``shape``, the states of a cell; three digits of it are enough."""
    return errors.reshape(shape).max(axis=-1).astype(np.float32)


def within(edges: NDArray, shape: tuple[int, ...], axis: int, rng: np.random.Generator) -> NDArray:
    """A random point of its cell for each of ``shape``."""
    low, width = edges[:-1], np.diff(edges)
    along = [1] * len(shape)
    along[axis] = low.size
    return low.reshape(along) + width.reshape(along) * rng.random(shape)


def over_alpha(sizes: dict[str, Any], rng: np.random.Generator) -> xr.Dataset:
    """Without creep; kappa = mu = 1, which only scale."""
    rows, across = sizes["cells"]
    edges = log_edges(*sizes["alpha_less_1"], rows), log_edges(*sizes["kappa_V"], across)
    shape = (rows, across, sizes["states"])
    alpha, V = 1.0 + 10.0 ** within(edges[0], shape, 0, rng), 10.0 ** within(edges[1], shape, 1, rng)
    states = [(a, 1.0, 1.0, v, 0.0) for a, v in zip(alpha.ravel().tolist(), V.ravel().tolist(), strict=True)]
    errors = errors_of(states, {"one by one": by_axis}, BY_ALPHA)
    return xr.Dataset(
        {n: (("alpha_cell", "kappa_V_cell"), cells(off, shape), described(n)) for (n, _), off in errors.items()},
        coords={"alpha_less_1_edge": 10.0 ** edges[0], "kappa_V_edge": 10.0 ** edges[1]},
    )


def over_creep(sizes: dict[str, Any], rng: np.random.Generator) -> xr.Dataset:
    """At one alpha, even in log(s/(1 - s)): fine toward s = 0 and toward s = 1."""
    rows, across = sizes["cells"]
    end = sizes["s_least"] / (1.0 - sizes["s_least"])
    edges = log_edges(end, 1.0 / end, rows), log_edges(*sizes["kappa_V"], across)
    shape = (rows, across, sizes["states"])
    odds, V = 10.0 ** within(edges[0], shape, 0, rng), 10.0 ** within(edges[1], shape, 1, rng)
    alpha = sizes["alpha"]
    limit = [float(contact_enclosure(alpha, 1.0, 1.0, v, 0.0)["delta_star"]) for v in V.ravel().tolist()]
    delta = np.array(limit) * (odds / (1.0 + odds)).ravel()
    states = [(alpha, 1.0, 1.0, v, d) for v, d in zip(V.ravel().tolist(), delta.tolist(), strict=True)]
    data = {}
    for (name, way), errors in errors_of(states, WAYS, BY_CREEP).items():
        conditioned = errors / (1.0 + odds.ravel()) if name == "beta" else errors
        about = described(name) | {"way": way} | ({"comment": "times 1 - s"} if name == "beta" else {})
        data[variable(name, way)] = (("s_cell", "kappa_V_cell"), cells(conditioned, shape), about)
    return xr.Dataset(data, coords={"s_over_1_less_s_edge": 10.0 ** edges[0]}, attrs={"alpha": alpha})


def variable(name: str, way: str) -> str:
    return f"{name}_{way.replace(' ', '_')}"


def described(name: str) -> dict[str, str]:
    return {"long_name": f"largest relative error in a cell of: {meaning(name)}", "units": "1"}


def drawn(maps: xr.Dataset) -> Figure:
    """lam, epsilon, delta_star, M above; Q and beta by both ways below; one scale, in roundings."""
    from matplotlib import colormaps
    from matplotlib.colors import BoundaryNorm

    title = f"Largest relative error, in roundings of {ROUNDING:.2g}; {POOLED} by {POOLED} cells of the data together"
    figure, panels = new_figure(title, 2, 4, (12.0, 6.0), sharex=True)
    shades = colormaps["YlGnBu"].resampled(len(LEVELS))
    scale = BoundaryNorm(LEVELS, len(LEVELS), extend="max")
    across = maps["kappa_V_edge"].values
    below = [(name, way) for name in BY_CREEP for way in WAYS]
    for axes, name in zip(panels[0], BY_ALPHA, strict=True):
        _map(axes, across, maps["alpha_less_1_edge"].values, maps[name].values, norm=scale, cmap=shades)
        axes.set_title(f"{label(name)}: up to {float(maps[name].max()) / ROUNDING:.2g}", fontsize="medium")
    for axes, (name, way) in zip(panels[1], below, strict=True):
        errors = maps[variable(name, way)]
        mesh = _map(axes, across, maps["s_over_1_less_s_edge"].values, errors.values, norm=scale, cmap=shades)
        shown = label(name) + (" times $1 - s$" if name == "beta" else "")
        axes.set_title(f"{shown}, {way}: up to {float(errors.max()) / ROUNDING:.2g}", fontsize="medium")
        axes.set_xlabel(label("kappa_V"))
    panels[0, 0].set_ylabel(rf"${SYMBOLS['alpha'].latex} - 1$")
    panels[1, 0].set_ylabel(r"$s/(1 - s)$")
    figure.colorbar(mesh, ax=panels, ticks=LEVELS).set_label("roundings")
    return figure


def _map(axes: Any, across: NDArray, up: NDArray, errors: NDArray, **style: Any) -> Any:
    """Errors in roundings, the largest of POOLED by POOLED cells: single cells of few states are noise."""
    kept = [(n // POOLED) * POOLED for n in errors.shape]
    blocks = errors[: kept[0], : kept[1]].reshape(kept[0] // POOLED, POOLED, kept[1] // POOLED, POOLED)
    values = blocks.max(axis=(1, 3)) / ROUNDING
    axes.set(xscale="log", yscale="log")
    return axes.pcolormesh(across[: kept[1] + 1 : POOLED], up[: kept[0] + 1 : POOLED], values, **style)


def main() -> int:
    options = parser(__doc__, RESULTS / "error-maps.nc")
    options.add_argument("--figure", type=Path, default=ROOT / "docs/figures/error-maps.png")
    options.add_argument("--draw", action="store_true", help="draw the figure from the file alone")
    arguments = options.parse_args()
    if arguments.draw:
        return told("error_maps", lambda: save(drawn(xr.load_dataset(arguments.output)), arguments.figure))
    return told("error_maps", lambda: make(arguments.config, arguments.quick, arguments.output, arguments.figure))


def make(config: Path, quick: bool, output: Path, figure: Path) -> None:
    """The maps and their picture."""
    sizes = read_sizes(config, "error_maps", quick)
    rng = np.random.default_rng(sizes["seed"])
    maps = xr.merge([over_alpha(sizes, rng), over_creep(sizes, rng)], combine_attrs="no_conflicts")
    maps.attrs |= {
        "title": "Relative error of the contact law in double precision, largest in a cell",
        "kernels": kernels_digest(),
    }
    for path in (output, figure):
        path.parent.mkdir(parents=True, exist_ok=True)
    write_dataset(maps, output)
    save(drawn(maps), figure)
    print(f"{output}, {figure}: written")


if __name__ == "__main__":
    sys.exit(main())
