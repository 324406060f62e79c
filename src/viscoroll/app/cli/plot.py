"""``viscoroll plot``."""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Callable
from pathlib import Path
from typing import Any

from ...core.errors import FileError, ParameterError
from .arguments import add_output_option

FORMATS = (".png", ".pdf", ".svg")
#: speeds of a scene's plot, over those of the first and the last extremum of M
_BEYOND = (1.0 / 30.0, 30.0)


def add_commands(commands: Any) -> None:
    """Add the command to the program."""
    parser = commands.add_parser(
        "plot",
        help="a result file, a scene, or the results of a run",
        description="Draw the result in a netCDF file of this program, the contact law over speed of a scene file, or\n"
        "the summaries of a store.",
    )
    parser.add_argument("what", metavar="WHAT", help="FILE.nc, SCENE.toml or STORE.zarr")
    add_output_option(parser, *FORMATS, required=True)
    parser.set_defaults(run=_plot)


def _plot(arguments: Namespace) -> int:
    from ...core.plots.style import save

    kinds: dict[str, Callable[[str], Any]] = {".zarr": _of_store, ".nc": _of_file, ".toml": _of_scene}
    draw = kinds.get(Path(arguments.what).suffix.lower())
    if draw is None:
        sentence = f"{arguments.what!r} is no file to plot: give FILE.nc, SCENE.toml or STORE.zarr"
        raise ParameterError("plot", arguments.what, "a file to plot", sentence)
    save(draw(arguments.what), arguments.output)
    return 0


def _of_store(path: str) -> Any:
    from ...core.plots import draw
    from ...io.runs import open_summaries

    return draw(open_summaries(path))


def _of_file(path: str) -> Any:
    import xarray as xr

    from ...core.plots import draw

    try:
        with xr.open_dataset(path, engine="h5netcdf", decode_times=False) as data:
            return draw(data)
    except OSError as error:
        missing = "there is no such file" if not Path(path).exists() else f"cannot be read ({error.strerror or error})"
        raise FileError(path, missing) from error


def _of_scene(path: str) -> Any:
    """lam, epsilon, M and the others over speeds around the largest M."""
    import numpy as np

    from ...io.config import read_body

    body = read_body(path)
    found = body.humps()
    low, high = (found.V[0], found.V[-1]) if found.V.size else (body.scale["V"],) * 2
    return body.contact(np.geomspace(_BEYOND[0] * low, _BEYOND[1] * high, 301), delta=0.0).plot()
