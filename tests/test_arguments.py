"""Numbers, truth values, counts and choices that no call takes: every argument of the calls below
is given what is none, what is outside its range, and what is in another dimension.
"""

from functools import partial

import numpy as np
import pytest
import xarray as xr
from calls import DMA, ONE, PAPER, ROLLER, SERIES, SI, SOFT, T
from experiments import ranges, resistance, roller
from refusals import refused
from scipy import stats

import viscoroll as vr
from viscoroll import fmu
from viscoroll.core.scale import SYMBOLS
from viscoroll.sampling import sample

inf, nan = np.inf, np.nan
MOTION = {"V0": 1.0, "omega0": 0.5, "t": [1e-4], "rtol": 1e-6, "max_steps": 99}
PUSHED = MOTION | {"force": 0.1, "torque": 0.1, "slope": 0.1, "brake": 0.1, "drag": 0.1}
RUBBER = {"E": 1e6, "nu": 0.4}
TERMS = {"nu": 0.4, "tau": [1.0]}
#: each call with arguments that it takes
CALLS = [
    (vr.Scene, {"alpha": 2.0, "kappa": 2.0, "mu": 0.2, "gamma": 1.0, "j": 0.5, "coupled": False}),
    (vr.Cylinder, SI | {"load": 300.0, "g": 9.81, "j": 0.5, "plane": "strain"}),
    (vr.Material, RUBBER | {"prony": SERIES, "T_ref": 1.0, "density": 1e3, "temperature": 20.0}),
    (partial(vr.Material, 1e6), {"nu": 0.4, "thickness": 0.01}),
    (vr.Material.sls, RUBBER | {"T_epsilon": 2.0, "T_sigma": 1.0}),
    (vr.Material.abaqus, TERMS | {"E0": 1e6, "g": [0.2], "k": [0.2], "long_term": False}),
    (vr.Material.comsol, TERMS | {"E": 1e6, "G": [1e6]}),
    (vr.Material.lsdyna, {"G": [1e6], "beta": [1.0], "G_inf": 1e6, "nu": 0.4}),
    (vr.Material.lsdyna, {"G": [1e6], "beta": [1.0], "G_inf": 1e6, "bulk": 1e9}),
    (SOFT.storage, {"omega": [1.0]}),
    (SOFT.creep, {"t": [1.0]}),
    (vr.WLF, {"T0": 20.0, "C1": 17.44, "C2": 51.6}),
    (vr.Arrhenius, {"energy": 1e5, "T0": 20.0}),
    (vr.WLF(T0=20.0), {"temperature": 20.0}),
    (vr.Arrhenius(energy=1e5, T0=20.0), {"temperature": 20.0}),
    (vr.Measured, {"low": 1.0, "high": 2.0, "misfit": 0.1}),
    (vr.Prony, {"E": [1.0, 2.0], "tau": [1.0, 0.1]}),
    (vr.Prony.creep, {"J": [0.5], "T": [1.0]}),
    (vr.Bodies, {"cylinder": SERIES, "base": SERIES, "share": 0.5}),
    (vr.Cover, {"series": SERIES, "nu": 0.4, "thickness": 1.0, "part": 1.0, "on": "base"}),
    (vr.contact, {"roller": PAPER, "V": [1.0], "delta": 0.1, "method": "table", "slopes": False}),
    (vr.contact, {"roller": ROLLER, "V": 1.0, "omega": 10.0}),
    (vr.stress, {"roller": PAPER, "x": [0.0], "V": 1.0, "delta": 0.1}),
    (vr.law(ONE), {"V": 1.0, "omega": 1.0}),
    (vr.steady, {"roller": PAPER, "force": [0.01], "torque": 0.01}),
    (vr.steady, {"roller": PAPER, "V": [0.1], "slope": 0.01}),
    (vr.validity, {"roller": ROLLER, "V": [1.0], "omega": 10.0, "density": 1e3}),
    (vr.roll, MOTION | {"roller": PAPER, "rest": 1e-3, "unsteady": False}),
    (vr.roll, PUSHED | {"roller": PAPER}),
    (vr.roll, PUSHED | {"roller": ROLLER}),
    (vr.ensemble, PUSHED | {"roller": PAPER, "method": "auto", "unsteady": False}),
    (vr.ensemble, MOTION | {"roller": PAPER, "threads": 1, "speed": 1.0, "progress": False}),
    (
        vr.fit_prony,
        dict(zip(("omega", "storage", "loss"), DMA, strict=True))
        | {"modes": 3, "misfit": 0.5, "temperature": 20.0, "mode": "shear"},
    ),
    (vr.fit_relaxation, {"t": T + 1.0, "relaxation": 1.0 + np.exp(-T), "mode": "shear"}),
    (vr.tables.spread, {"low": 1.0, "high": 2.0, "count": 3, "spacing": "log"}),
    (vr.tables.build, {"what": PAPER, "V": [0.1], "delta": [0.0, 0.1], "alpha": [2.0, 3.0]}),
    (sample, {"n": 4, "seed": 0, "V0": stats.uniform()}),
    (fmu.build, {"given": 11.0, "path": "a.fmu", "model": "Roller", "version": 2}),
    (
        vr.identify,
        {"cylinder": roller(), "unknown": ranges("E"), "data": [resistance()], "starts": 1},
    ),
]
POSITIVE = "R m T_epsilon T_sigma load g T_ref density thickness energy C1 C2 low high T E0 G0 "
POSITIVE += "G_inf bulk rtol rest speed storage loss relaxation tau part count max_steps"
#: range in words -> what is outside of it
OUTSIDE = {
    "finite": (),
    "> 0": (0.0, -1.0),
    ">= 0": (-1.0,),
    ">= 1": (0.5, 0.0, -2.0),
    "(-pi/2, pi/2)": (1.6, -2.0),
    "(-1, 0.5]": (-1.0, 0.51),
    "[0, 1]": (-0.1, 1.5),
    "temperature": (-300.0,),
}
RANGES = (
    {name: symbol.range for name, symbol in SYMBOLS.items()}
    | dict.fromkeys(POSITIVE.split(), "> 0")
    | dict.fromkeys(["g", "k", "K", "G", "beta", "E"], ">= 0")
)


def wrong(name, good):
    """What the argument ``name`` of the kind of ``good`` cannot be."""
    if isinstance(good, bool):
        return "no", nan, 1, [True, False], np.array([True, False])
    if isinstance(good, str):
        return "magic", 3, [good], np.array([1.0, 2.0])
    if isinstance(good, int):
        return -5, 1.5, "2", True, np.timedelta64(5)
    odd = (nan, inf, "fast", 1j, True, {}, 10**400, *OUTSIDE.get(RANGES.get(name), ()))
    if isinstance(good, float):
        return *odd, xr.DataArray(1.0, attrs={"units": "kat"})
    return [*([one, *good[1:]] for one in odd), xr.DataArray(good, attrs={"units": "kat"})]


@pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")
@pytest.mark.parametrize(("call", "given"), CALLS)
def test_what_an_argument_cannot_be(call, given, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    if call is not fmu.build:
        call(**given)
    for name, good in given.items():
        if isinstance(good, bool | str | float | int | list) and name not in (
            "data",
            "path",
            "given",
        ):
            for bad in wrong(name, good):
                refused(partial(call, **given | {name: bad}), name, "must be")
