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
from typing import Any

import numpy as np
import xarray as xr
from tqdm import tqdm

from viscoroll.core.files import write_dataset
from viscoroll.core.plots.style import labelled, new_figure, save
from viscoroll.core.symbols import SYMBOLS, meaning

from ...stage import ROOT, make_folder, told
from ..results import RESULTS, parser, read_sizes
from ..stamps import kernels_digest
from ..truth import contact_enclosure
from .states import by_axis, by_rows, relative_error

#: field and way of each map, over alpha and over s; what the fields over s are divided by, and their names
BY_ALPHA = [(name, "one by one") for name in ("lam", "epsilon", "delta_star", "M")]
BY_CREEP = [(name, way) for name in ("Q", "beta") for way in ("one by one", "slice")]
WAYS = {"one by one": by_axis, "slice": by_rows}
#: the figure: half a unit in the last place, and steps of shade in units of it, up to less than 1e-13
ROUNDING, LEVELS = 2.0**-53, (0.0, 1.0, 2.0, 3.0, 5.0, 10.0, 20.0, 40.0)
#: cells of the figure: single ones of few states are noise
POOLED = 4


def mapped(
    sizes: dict[str, Any],
    random: np.random.Generator,
    up: str,
    ends: Any,
    maps: list[tuple[str, str]],
    alpha: float = 0.0,
) -> xr.Dataset:
    """Over ``up``, even in its logarithm, at alpha, or over it where that is 0; kappa = mu = 1, which only scale."""
    edges = [np.linspace(*np.log10(pair), n + 1) for pair, n in zip((ends, sizes["kappa_V"]), sizes["cells"])]
    shape = (*sizes["cells"], sizes["states"])
    low, wide = (np.meshgrid(*each, indexing="ij") for each in ([e[:-1] for e in edges], map(np.diff, edges)))
    rise, V = (10.0 ** (a[..., None] + b[..., None] * random.random(shape)).ravel() for a, b in zip(low, wide))
    states = [(alpha or 1.0 + each, 1.0, 1.0, v, 0.0) for each, v in zip(rise.tolist(), V.tolist())]
    if alpha:  # up is s/(1 - s)
        s = (rise / (1.0 + rise)).tolist()
        states = [(*one[:4], part * float(contact_enclosure(*one)["delta_star"])) for one, part in zip(states, s)]
    found = {way: WAYS[way](states).as_dict() for _, way in maps}
    errors = {each: np.empty(len(states)) for each in maps}
    for i, state in enumerate(tqdm(states, desc="error maps", delay=1.0, leave=False)):
        exact = contact_enclosure(*state)
        for (name, way), values in errors.items():
            values[i] = relative_error(float(found[way][name][i]), exact[name]) / (1.0 + (name == "beta") * rise[i])
    data = {}
    for (name, way), values in errors.items():
        about = {"long_name": f"largest relative error in a cell of: {meaning(name)}", "units": "1", "way": way}
        about |= {"comment": "times 1 - s"} if name == "beta" else {}
        cells = values.reshape(shape).max(axis=-1).astype(np.float32)  # three digits are enough
        data[variable(name, way, alpha)] = ((f"{up}_cell", "kappa_V_cell"), cells, about)
    return xr.Dataset(data, {f"{up}_edge": 10.0 ** edges[0], "kappa_V_edge": 10.0 ** edges[1]})


def variable(name: str, way: str, alpha: float = 1.0) -> str:
    return f"{name}_{way.replace(' ', '_')}" if alpha else name


def drawn(maps: xr.Dataset) -> Any:
    """lam, epsilon, delta_star, M above; Q and beta by both ways below; one scale, in roundings."""
    from matplotlib import colormaps
    from matplotlib.colors import BoundaryNorm

    title = f"Largest relative error, in roundings of {ROUNDING:.2g}; {POOLED} by {POOLED} cells of the data together"
    figure, panels = new_figure(title, 2, 4, (12.0, 6.0), sharex=True)
    style = {
        "norm": BoundaryNorm(LEVELS, len(LEVELS), extend="max"),
        "cmap": colormaps["YlGnBu"].resampled(len(LEVELS)),
    }
    below = [
        (variable(*each), f"{labelled(each[0])}{' times $1 - s$' * (each[0] == 'beta')}, {each[1]}")
        for each in BY_CREEP
    ]
    rows = [(name, labelled(name)) for name, _ in BY_ALPHA], below
    for axes, (name, text) in zip(panels.ravel(), [*rows[0], *rows[1]], strict=True):
        errors, edges = maps[name] / ROUNDING, [maps[dim.replace("cell", "edge")].values for dim in maps[name].dims]
        pooled = errors.coarsen(dict.fromkeys(errors.dims, POOLED), boundary="trim").max().values
        up, across = (edge[: POOLED * n + 1 : POOLED] for edge, n in zip(edges, pooled.shape))
        mesh = axes.pcolormesh(across, up, pooled, **style)
        axes.set(xscale="log", yscale="log")
        axes.set_title(f"{text}: up to {float(errors.max()):.2g}", fontsize="medium")
    for axes in panels[1]:
        axes.set_xlabel(labelled("kappa_V"))
    panels[0, 0].set_ylabel(rf"${SYMBOLS['alpha'].latex} - 1$")
    panels[1, 0].set_ylabel(r"$s/(1 - s)$")
    figure.colorbar(mesh, ax=panels, ticks=LEVELS).set_label("roundings")
    return figure


def main() -> int:
    options = parser(__doc__, RESULTS / "error-maps.nc")
    options.add_argument("--figure", type=Path, default=ROOT / "docs/figures/error-maps.png")
    options.add_argument("--draw", action="store_true", help="draw the figure from the file alone")
    given = options.parse_args()

    def work() -> None:
        if not given.draw:
            sizes = read_sizes(given.config, "error_maps", given.quick)
            random, far = np.random.default_rng(sizes["seed"]), (1.0 - sizes["s_least"]) / sizes["s_least"]
            over_alpha = mapped(sizes, random, "alpha_less_1", sizes["alpha_less_1"], BY_ALPHA)
            over_creep = mapped(sizes, random, "s_over_1_less_s", (1.0 / far, far), BY_CREEP, sizes["alpha"])
            maps = xr.merge([over_alpha, over_creep])
            title = "Relative error of the contact law in double precision, largest in a cell"
            maps.attrs = {"title": title, "alpha": sizes["alpha"], "kernels": kernels_digest()}
            make_folder(given.output.parent)
            write_dataset(maps, given.output)
        save(drawn(xr.load_dataset(given.output)), given.figure)
        print(f"{given.output}, {given.figure}: written")

    return told("error_maps", work)


if __name__ == "__main__":
    sys.exit(main())
