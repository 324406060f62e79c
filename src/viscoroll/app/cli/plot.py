"""``viscoroll plot``: a figure of the content of a file."""

from __future__ import annotations

import os
from argparse import Namespace
from pathlib import Path
from typing import Any

import viscoroll as vr

from .arguments import FIGURES, command, option, output

#: The figure of a scene reaches from the speed of the first extremum of M divided by this number to that of the last
#: times it.
_MARGIN = 30.0
#: Number of speeds in the figure of a scene.
_SPEEDS = 301


@command(
    "plot", option("what", metavar="WHAT", help="FILE.nc, SCENE.toml, MATERIAL.toml or STORE.zarr"), output(*FIGURES)
)
def plot(arguments: Namespace) -> None:
    """Draw the content of a file and write the figure.

    arguments: parsed command line with
        what, path of a .nc (result, table, material), a .toml (scene, cylinder, material) or a .zarr (results of a
        run);
        output, path of the figure that is written; its suffix is the format: .png, .pdf or .svg.
    Returns None.
    Raises ParameterError for another suffix of what, and for content without a figure, as a single state; FileError for
    a file that cannot be read or written; MissingDependencyError for a .zarr without zarr.
    """
    from ...core.plots.style import save

    kinds = {".zarr": lambda path: vr.runs.open_run(path).plot(), ".nc": _figure_of_netcdf, ".toml": _figure_of_toml}
    path = arguments.what
    if (draw := kinds.get(Path(path).suffix.lower())) is None:
        sentence = f"{path!r} is not a file that can be plotted: give FILE.nc, SCENE.toml, MATERIAL.toml or STORE.zarr"
        raise vr.ParameterError("plot", path, "a file to plot", sentence)
    save(draw(path), arguments.output)


def _figure_of_netcdf(path: str) -> Any:
    """Return the matplotlib figure of the content of a netCDF file.

    Of a material, which has an attribute ``schema``, it shows the moduli; of the results of many motions, which have a
    dimension ``motion``, a summary; else the result itself.

    path: path of a netCDF-4 file; one of netCDF-3 counts as no netCDF file.
    Raises FileError for a file that does not exist, cannot be read, or is no netCDF-4, also for a material that is
    damaged, as one whose SHA-256 does not fit, and for what looks like a result but lacks a variable or an attribute;
    ParameterError for a dataset that is no result, or has a single state.
    """
    import xarray as xr

    from ...core.plots import draw
    from ...motion.summaries import drawn_summary

    try:
        with xr.open_dataset(path, engine="h5netcdf", decode_times=False) as data:
            if "schema" in data.attrs:
                return vr.Material.from_netcdf(path).plot()
            return draw(drawn_summary(data.load()) if "motion" in data.dims else data)
    except OSError as error:
        if not Path(path).is_file():
            raise vr.FileError(path, "the file does not exist") from error
        problem = (
            "is damaged or is not a netCDF file" if os.access(path, os.R_OK) else "cannot be read (Permission denied)"
        )
        raise vr.FileError(path, problem) from error
    except vr.ParameterError:
        raise
    except (AttributeError, KeyError, ValueError) as error:
        raise vr.FileError(path, f"lacks a part of the result that its axes announce ({error})") from error


def _figure_of_toml(path: str) -> Any:
    """Return the matplotlib figure of what a TOML file describes.

    Of a scene or cylinder it is the contact in free rolling at 301 speeds, from a thirtieth of the speed of the first
    extremum of M to thirty times that of the last; where M has no extremum, as of elastic bodies, from a thirtieth of
    the unit of speed (R/T_ref, 1 of a scene) to thirty times it.  Of a file without them it is the material, else the
    base.

    path: path of a TOML file with [scene], [cylinder], preset, [material] or [base].
    Raises FileError for a file that cannot be read or has none of these, or a value that is not allowed;
    ParameterError for a layer too thin for its law.
    """
    import numpy as np

    from ...core.sections import read_toml
    from ...io.config import SCENES, read_roller
    from ...materials.material_toml import read_materials

    if not read_toml(path).keys() & set(SCENES):
        return next(iter(read_materials(path).values())).plot()
    roller = read_roller(path)
    extrema = roller.resistance_extrema().V
    low, high = (extrema[0], extrema[-1]) if extrema.size else (roller.scale["V"],) * 2
    return roller.contact(np.geomspace(low / _MARGIN, high * _MARGIN, _SPEEDS), delta=0.0).plot()
