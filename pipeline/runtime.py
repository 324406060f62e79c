"""Runtime: Eq. (22) from the file of the law that `make tables` wrote -> out/runtime.nc, the
contact along with it.

    python -m pipeline.runtime [--config FILE] [-o FOLDER]

No equation of the contact is solved here: ``vr.roll`` looks the law up in what the file holds.
"""

import sys
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import xarray as xr
from numpy.typing import NDArray

import viscoroll as vr
from viscoroll.core.files import write_dataset
from viscoroll.core.quantities import attributes

from . import stage
from .validation import FIELDS

#: (V0, omega0) -> V and omega at the times of a stage
Way = Callable[[float, float], tuple[NDArray, NDArray]]
#: A call of so many seconds is timed once: it repeats what it times some hundred times by itself.
ENOUGH = 0.05


class Runtime(msgspec.Struct, forbid_unknown_fields=True):
    """[runtime]: a law of the paper's material, ``times`` even times up to ``end``, the tolerance
    of the integrator.
    """

    law: str
    end: float
    times: int
    rtol: float

    @property
    def t(self) -> NDArray:
        return np.linspace(0.0, self.end, self.times)


def least_seconds(call: Callable[[], Any], compiled: bool) -> tuple[Any, float]:
    """What a call gives, and the least seconds of three, or those of one above :data:`ENOUGH`;
    ``compiled``: whether that was compiled before, else by a call that does not count.
    """
    if not compiled:
        call()
    seconds = []
    while not seconds or (len(seconds) < 3 and min(seconds) < ENOUGH):
        began = time.perf_counter()
        found = call()
        seconds.append(time.perf_counter() - began)
    return found, min(seconds)


def motions(way: Way, t: NDArray, law: str) -> xr.Dataset:
    """The paper's IC1-IC3 with the seconds that each took, one way; ``law``: by what."""
    timed = [
        least_seconds(partial(way, *start), n > 0)
        for n, start in enumerate(vr.presets.PAPER_STARTS.values())
    ]
    found, seconds = zip(*timed, strict=True)
    speeds = {
        name: (("ic", "t"), [one[n] for one in found], attributes(name))
        for n, name in enumerate(("V", "omega"))
    }
    about = {
        "title": "Motions of the paper's Sect. 5.1",
        "law": law,
        "source": f"viscoroll {vr.__version__}",
    }
    data = speeds | {
        "seconds": ("ic", list(seconds), {"long_name": "time to integrate", "units": "s"})
    }
    names = np.array(list(vr.presets.PAPER_STARTS), dtype=object)
    return xr.Dataset(data, {"ic": names, "t": ("t", t, attributes("t"))}, about)


def by_roll(scene: vr.Scene, t: NDArray, rtol: float) -> Way:
    """Motions of a scene, whose material may be a file."""

    def way(V0, omega0):
        found = vr.roll(scene, V0, omega0, t, rtol=rtol)
        return found.V, found.omega

    return way


def work(settings, out):
    scene = vr.presets.PAPER_SECTION_5.replace(material=vr.load_law(stage.ROOT / settings.law))
    t = settings.t
    dataset = motions(by_roll(scene, t, settings.rtol), t, f"the file {Path(settings.law).name}")
    along = vr.contact(scene, dataset.V.values, omega=dataset.omega.values, fields=FIELDS)
    for name in FIELDS:
        dataset[name] = (("ic", "t"), getattr(along, name), attributes(name))
    path = out / "runtime.nc"
    write_dataset(dataset, path, stage.plain_encoding(dataset))
    headline = {f"{dataset.law}: seconds, IC1-IC3": float(dataset.seconds.sum())}
    for name, start in vr.presets.PAPER_STARTS.items():
        motion = vr.roll(scene, *start, t)
        if np.isfinite(onset := motion.onset_time):
            headline[f"{name}: stick begins"] = f"t = {onset:.6g}, V = {motion.at(onset).V[0]:.4f}"
    return stage.Outcome([path], headline)


if __name__ == "__main__":
    sys.exit(stage.run("runtime", Runtime, work, __doc__))
