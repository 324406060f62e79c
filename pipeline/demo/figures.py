"""Stage 8: every figure -> out/figures/*.png; the distribution from the ensemble.

python -m pipeline.demo.figures [--config FILE] [-o FOLDER]
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import xarray as xr
from tqdm import tqdm

from viscoroll.errors import FileProblem
from viscoroll.plots.style import save

from .. import stage
from ..figures import FIGURES


def load_ensemble(path: Path) -> xr.Dataset:
    """What pipeline/demo/ensemble.py wrote.

    Raises
    ------
    FileProblem
        If it is not there or cannot be read.
    """
    try:
        return xr.load_dataset(path, engine="h5netcdf")
    except (OSError, ValueError) as error:
        raise FileProblem(path, f"cannot be read ({error}); run pipeline.demo.ensemble first") from error


def work(config: Path, out: Path) -> stage.Outcome:
    del config  # nothing of it
    ensemble = load_ensemble(out / "ensemble.nc")
    shown: dict[str, tuple[Any, ...]] = {"ensemble": (ensemble, ensemble)}
    folder, files = stage.make_folder(out / "figures"), []
    for name, draw in tqdm(FIGURES.items(), desc="figures", delay=1.0, leave=False):
        files.append(folder / f"{name}.png")
        save(draw(*shown.get(name, ())), files[-1])
    return stage.Outcome(files)


if __name__ == "__main__":
    sys.exit(stage.run("figures", None, work, __doc__))
