"""Ensemble: the Monte Carlo of random starts -> out/ensemble.nc: their summary, and some of them.

python -m pipeline.ensemble [--config FILE] [-o FOLDER]
"""

import sys
import time

import msgspec
import numpy as np
import xarray as xr
from scipy.stats import uniform

import viscoroll as vr
from viscoroll.core.arrays import thread_count
from viscoroll.core.errors import ParameterError
from viscoroll.core.files import write_dataset
from viscoroll.presets import preset
from viscoroll.sampling import sample

from . import stage


class Ensemble(msgspec.Struct, forbid_unknown_fields=True):
    """[ensemble]: ``motions`` of them, V0 and omega0 uniform in [-speed, speed], ``kept`` of them
    one by one.
    """

    preset: str
    motions: int
    speed: float
    t: list[float]
    rtol: float
    seed: int
    kept: int


def work(settings, out):
    if not 1 <= settings.kept <= settings.motions:
        raise ParameterError(
            "kept", settings.kept, f"in [1, {settings.motions}], the number of motions"
        )
    scene = preset(settings.preset)
    spread = uniform(-settings.speed, 2.0 * settings.speed)
    starts = sample(settings.motions, settings.seed, V0=spread, omega0=spread)
    few = (starts[name][:100] for name in ("V0", "omega0"))
    vr.ensemble(
        scene, *few, settings.t, rtol=settings.rtol, method="flow"
    )  # so that compilation is not timed
    begun = time.perf_counter()
    result = vr.ensemble(
        scene, starts["V0"], starts["omega0"], settings.t, rtol=settings.rtol, progress=True
    )
    seconds = time.perf_counter() - begun
    thinned = result.to_xarray().isel(
        motion=slice(0, settings.kept)
    )  # the starts are independent: any will do
    summary = (
        result.summary()
        .drop_dims("status")
        .filter_by_attrs(long_name=lambda text: "bin" not in text)
    )
    dataset = xr.merge([summary, thinned], combine_attrs="override", join="exact", compat="equals")
    dataset.attrs |= {
        "preset": settings.preset,
        "seed": starts.seed,
        "design": starts.design,
        "rtol": settings.rtol,
        "comment": (
            "V_mean, V_quantiles, ... are over all motions; V, omega, ... are "
            f"{settings.kept} of them"
        ),
    }
    path = out / "ensemble.nc"
    write_dataset(dataset, path)
    microseconds = 1e6 * seconds / settings.motions
    headline = {
        "preset": settings.preset,
        "motions": settings.motions,
        f"time on {thread_count()} threads, s": seconds,
        "time per motion, us": microseconds,
        "motions from the flow map": int(result.flow.sum()),
        "stated error of the flow map": result.flow_error,
        "mean distance |x| at the end": float(np.nanmean(np.abs(result.x[:, -1]))),  # type: ignore[index]
    }
    headline |= {f"motions that {text}": count for text, count in result.messages().items()}
    return stage.Outcome([path], headline)


if __name__ == "__main__":
    sys.exit(stage.run("ensemble", Ensemble, work, __doc__))
