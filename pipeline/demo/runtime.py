"""Stage 3: Eq. (22) from the file of the law that `make tables` wrote -> out/runtime.nc.

    python -m pipeline.demo.runtime [--config FILE] [-o FOLDER]

No equation of the contact is solved here: the law is what the file holds, the integrator a few lines of numba.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from pathlib import Path

import msgspec
import numpy as np
import xarray as xr
from numpy.typing import NDArray

import viscoroll as vr
from viscoroll.files import write_dataset
from viscoroll.symbols import attributes

from .. import stage
from .rodas import rolled

#: (V0, omega0) -> V and omega at the times of a stage
Way = Callable[[float, float], tuple[NDArray, NDArray]]


class Runtime(msgspec.Struct, forbid_unknown_fields=True):
    """[runtime]: a law of the paper's material, ``times`` even times up to ``end``, the tolerance of the integrator."""

    law: str
    end: float
    times: int
    rtol: float

    @property
    def t(self) -> NDArray:
        return np.linspace(0.0, self.end, self.times)


def motions(way: Way, t: NDArray, law: str) -> xr.Dataset:
    """The paper's IC1-IC3 with the seconds that each took, one way; ``law``: by what."""
    way(*vr.PAPER_STARTS["IC1"])  # compiles
    found, seconds = [], []
    for start in vr.PAPER_STARTS.values():
        began = time.perf_counter()
        found.append(way(*start))
        seconds.append(time.perf_counter() - began)
    speeds = {name: (("ic", "t"), [one[n] for one in found], attributes(name)) for n, name in enumerate(("V", "omega"))}
    about = {"title": "Motions of the paper's Sect. 5.1", "law": law, "source": f"viscoroll {vr.__version__}"}
    data = speeds | {"seconds": ("ic", seconds, {"long_name": "time to integrate", "units": "s"})}
    names = np.array(list(vr.PAPER_STARTS), dtype=object)
    return xr.Dataset(data, {"ic": names, "t": ("t", t, attributes("t"))}, about)


def left(dataset: xr.Dataset, path: Path) -> stage.Outcome:
    """Motions as a file of a stage."""
    write_dataset(dataset, path, stage.plain_encoding(dataset))
    return stage.Outcome([path], {f"{dataset.law}: seconds, IC1-IC3": float(dataset.seconds.sum())})


def work(settings: Runtime, out: Path) -> stage.Outcome:
    scene = vr.PAPER_SECTION_5.replace(material=vr.load_law(stage.ROOT / settings.law))
    law, star = vr.law(scene).jitted, 0.5 * scene.mu / scene.kappa

    def way(V0: float, omega0: float) -> tuple[NDArray, NDArray]:
        V, omega = rolled(law, scene.gamma, scene.j, star, (V0, omega0), settings.t, settings.rtol)
        return V, omega

    return left(motions(way, settings.t, f"the file {Path(settings.law).name}"), out / "runtime.nc")


if __name__ == "__main__":
    sys.exit(stage.run("runtime", Runtime, work, __doc__))
