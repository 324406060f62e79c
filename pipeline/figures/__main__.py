"""Figures: the paper's, the gallery's and that of the ensemble -> out/figures/*.png.

python -m pipeline.figures [--config FILE] [-o FOLDER]
"""

from __future__ import annotations

import sys
import warnings
from pathlib import Path
from typing import Any

import matplotlib as mpl
import matplotlib.pyplot as plt
import msgspec
from tqdm import tqdm

from viscoroll import ModelWarning
from viscoroll.core.plots import save

from .. import stage
from ..validate import loaded
from . import FIGURES


class Figures(msgspec.Struct, forbid_unknown_fields=True):
    """[figures]: the file of the grid."""

    grid: str


def work(settings: Figures, out: Path) -> stage.Outcome:
    files_of = {"ensemble": out / "ensemble.nc", "grid": stage.ROOT / settings.grid}
    shown: dict[str, tuple[Any, ...]] = {name: (loaded(path),) for name, path in files_of.items()}
    folder = stage.make_folder(out / "figures")
    files = []
    for name, draw in tqdm(FIGURES.items(), desc="figures", delay=1.0, leave=False):
        files.append(folder / f"{name}.png")
        save(draw(*shown.get(name, ())), files[-1])
    return stage.Outcome(files)


if __name__ == "__main__":
    mpl.use("agg")
    plt.style.use(stage.ROOT / "docs/viscoroll.mplstyle")
    warnings.simplefilter("ignore", ModelWarning)  # the paper's cylinder, of which its pages say so
    sys.exit(stage.run("figures", Figures, work, __doc__))
