"""Stage 6: the paper's motions IC1-IC3 with their contact state -> out/motions.nc.

python -m pipeline.demo.motions [--config FILE] [-o FOLDER]
"""

from __future__ import annotations

import sys
import time
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import xarray as xr

import viscoroll as vr
from viscoroll.config import preset
from viscoroll.files import write_dataset
from viscoroll.symbols import attributes

from .. import stage

CONTACT = ("lam", "epsilon", "delta_star", "beta", "Q", "M")


class Motions(msgspec.Struct, forbid_unknown_fields=True):
    """[motions]: the scene by name, and ``times`` even output times up to ``end``."""

    preset: str
    end: float
    times: int
    rtol: float


def with_contact(motion: Any) -> xr.Dataset:
    """A motion's dataset with the contact state along it; the onset as a variable."""
    dataset, state = motion.to_xarray(), motion.contact(CONTACT)
    for name in CONTACT:
        dataset[name] = ("t", getattr(state, name), attributes(name))
    dataset["onset_time"] = ((), motion.onset_time, attributes("onset_time"))
    # what differs from motion to motion would be wrong as an attribute of all three
    for name in ("onset_time", "rest_time", "switches", "status", "steps"):
        del dataset.attrs[name]
    return dataset


def work(settings: Motions, out: Path) -> stage.Outcome:
    scene, t = preset(settings.preset), np.linspace(0.0, settings.end, settings.times)
    motions = {}
    for name, start in vr.PAPER_STARTS.items():
        vr.roll(scene, *start, t[-1:], settings.rtol)  # so that the first is not timed with its compilation
        begun = time.perf_counter()
        motions[name] = vr.roll(scene, *start, t, settings.rtol), time.perf_counter() - begun
    names = xr.Variable("ic", np.array(list(motions), dtype=object), {"long_name": "initial conditions of Sect. 5.1"})
    parts = [with_contact(motion) for motion, _ in motions.values()]
    dataset = xr.concat(parts, "ic", combine_attrs="override").assign_coords(ic=names)
    dataset.attrs |= {"title": "Motions of the paper's Sect. 5.1", "preset": settings.preset, "rtol": settings.rtol}
    path = out / "motions.nc"
    write_dataset(dataset, path, stage.plain_encoding(dataset))
    headline: dict[str, float | int | str] = {"preset": settings.preset}
    headline |= {
        f"{name}: onset of stick": f"t = {motion.onset_time:.6g}, V = {motion.at(motion.onset_time).V[0]:.4f}"
        for name, (motion, _) in motions.items()
    }
    slowest = max(seconds for _, seconds in motions.values())
    headline[f"time of one motion with {t.size} outputs, rtol {settings.rtol:g}, ms"] = 1e3 * slowest
    return stage.Outcome([path], headline)


if __name__ == "__main__":
    sys.exit(stage.run("motions", Motions, work, __doc__))
