"""Error maps of the atlas."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..plots.style import new_figure, number
from ..symbols import label

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

_FIELDS = {"error_beta": r"\beta", "error_Q_over_mu": r"(Q/\mu)"}
_DECADES = 4


def atlas_errors(table: xr.Dataset | None = None) -> Figure:
    """Largest interpolation error by block of cells: over (kappa V, alpha) and over (kappa V, s).

    Parameters
    ----------
    table : the atlas, of ``tables.load``; default: one built now on the grid of production,
        which takes some seconds.
    """
    from matplotlib.colors import LogNorm

    from ..tables import AtlasGrid, build
    from ..tables.grid import u_of_s

    table = build(AtlasGrid()) if table is None else table
    figure, panels = new_figure("Largest error of the atlas' cubic splines off the nodes", 2, 2, (9.0, 6.6))
    across = table["block_kappa_V_edge"].values
    heights = {"alpha": table["block_alpha_edge"].values, "s": u_of_s(table["block_s_edge"].values)}
    for row, (field, latex) in zip(panels, _FIELDS.items(), strict=True):
        errors = table[field]
        top = float(errors.max())
        scale = LogNorm(top * 10.0**-_DECADES, top)
        for axes, (kept, other) in zip(row, (("alpha", "s"), ("s", "alpha")), strict=True):
            values = errors.max(f"block_{other}").transpose(f"block_{kept}", "block_kappa_V").values
            mesh = axes.pcolormesh(across, heights[kept], values, norm=scale, cmap="Greys")
            axes.set(xscale="log", xlabel=label("kappa_V"), title=f"worst over {label(other)}")
            axes.set_ylabel(label("alpha") if kept == "alpha" else r"$1 - \sqrt{1 - s}$")
            if kept == "alpha":
                axes.set_yscale("log")
        bar = figure.colorbar(mesh, ax=row, extend="min")
        bar.set_label(rf"$\max|\Delta{latex}|$, largest ${number(top, 2)}$")
    return figure
