"""``viscoroll plot``: a figure of what a file holds."""

from __future__ import annotations

import os
from argparse import Namespace
from pathlib import Path
from typing import Any

import viscoroll as vr

from .arguments import FIGURES, command, option, output

#: speeds of a scene's plot, over those of the first and the last extremum of M
_BEYOND = (1.0 / 30.0, 30.0)


@command(
    "plot", option("what", metavar="WHAT", help="FILE.nc, SCENE.toml, MATERIAL.toml or STORE.zarr"), output(*FIGURES)
)
def plot(given: Namespace) -> None:
    """A result file, a scene, a material, or the results of a run.

    The result in a netCDF file of this program, the contact law over speed of a scene file, moduli and relaxation of
    the [material] of a file that has none, or the summaries of a store.
    """
    from ...core.plots.style import save

    kinds = {".zarr": lambda path: vr.runs.open_run(path).plot(), ".nc": _of_file, ".toml": _of_toml}
    if (draw := kinds.get(Path(given.what).suffix.lower())) is None:
        sentence = f"{given.what!r} is no file to plot: give FILE.nc, SCENE.toml, MATERIAL.toml or STORE.zarr"
        raise vr.ParameterError("plot", given.what, "a file to plot", sentence)
    save(draw(given.what), given.output)


def _of_file(path: str) -> Any:
    import xarray as xr

    from ...core.plots import draw

    try:
        with xr.open_dataset(path, engine="h5netcdf", decode_times=False) as data:
            return vr.Material.from_netcdf(path).plot() if "schema" in data.attrs else draw(data)
    except OSError as error:
        if not Path(path).is_file():
            raise vr.FileError(path, "there is no such file") from error
        problem = "is damaged, or no netCDF file" if os.access(path, os.R_OK) else "cannot be read (Permission denied)"
        raise vr.FileError(path, problem) from error


def _of_toml(path: str) -> Any:
    """lam, epsilon, M and the others over speeds around the largest M; or a material."""
    import numpy as np

    from ...core.sections import read_toml
    from ...io.config import SCENES, read_roller
    from ...materials.file import read_materials

    if not read_toml(path).keys() & set(SCENES):
        return read_materials(path)["material"].plot()
    body = read_roller(path)
    found = body.resistance_extrema()
    low, high = (found.V[0], found.V[-1]) if found.V.size else (body.scale["V"],) * 2
    return body.contact(np.geomspace(_BEYOND[0] * low, _BEYOND[1] * high, 301), delta=0.0).plot()
