"""Bad input of calls that no range alone tells: what contradicts, is missing, does not fit
together, or is beyond what the model or doubles hold.
"""

import math
from dataclasses import replace
from functools import partial

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from calls import (
    COVERED,
    FRAME,
    LABELLED,
    MANY,
    ONE,
    PAPER,
    ROLLER,
    RUBBER_COVER,
    SERIES,
    SI,
    SOFT,
    STEEL,
    THIN,
    pair,
)
from refusals import each, refused
from scipy import stats

import viscoroll as vr
from viscoroll import fmu
from viscoroll.laws.law_netcdf import law_table_of
from viscoroll.laws.law_table import law_table
from viscoroll.presets import PAPER_CYLINDER
from viscoroll.sampling import sample

inf, nan = math.inf, math.nan
pytestmark = pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")
RUBBER_ROLLER = vr.presets.RUBBER_ROLLER
MANY_SCENES = vr.Scene(material=MANY, kappa=2.91, mu=0.2, gamma=700.0)
PAIRS = MANY_SCENES.replace(material=vr.Bodies(MANY, MANY, 0.4))
BODIES = RUBBER_ROLLER.replace(material=vr.Bodies(vr.Prony([2.0], [1.0]), SERIES, 0.7))
TWO_RADII = PAPER_CYLINDER.replace(R=[0.1, 0.2])
TWO_MASSES = PAPER_CYLINDER.replace(m=[30.0, 40.0])
THREE_TIMES = {"T_epsilon": [1e-3, 1e-2, 2e-2], "T_sigma": [1e-3, 1e-3, 5e-3]}
THREE = vr.Cylinder(**SI | THREE_TIMES)
#: a cylinder that is made of a material
MADE = {"R": 0.1, "m": 35.5, "mu": 0.2, "material": SOFT}
ROLL = {"roller": PAPER, "V0": 1.0, "omega0": 1.0, "t": 1e-3}
FREE = {"roller": PAPER, "V0": [1.0, 1.0], "omega0": [1.0, 1.0], "t": 1e-3}
UNSTEADY = ROLL | {"roller": RUBBER_ROLLER, "V0": 30.0, "omega0": 30.0}


def unit(words, value=1.0):
    """A number with a unit, as xarray has it."""
    return xr.DataArray(value, attrs={"units": words})


CONTACT = each(
    vr.contact,
    {
        "V = inf at row 1 | finite": {"V": [1.0, inf]},
        "kappa |V| = 2.91e+300 | at most 1e+300": {"V": [1.0, -1e300]},
        "shapes | V (2,), delta (3,) | broadcast": {"V": [1.0, 2.0], "delta": [0.1, 0.2, 0.3]},
        "fields: 'tau' | delta_star": {"fields": ("Q", "tau")},
        "fields: 3 is not a field; choose from lam": {"fields": 3},
        "fields: 1.0 is not a field": {"fields": [1.0]},
        "'Crr' is not a field | length, C_rr": {"roller": ROLLER, "fields": "Crr"},
        "method = 'direct': must be 'table' for slopes": {"method": "direct", "slopes": True},
        "fields | 'N' | table": {"fields": "N", "method": "direct"},
        "fields | 'grip' | table": {"fields": "grip", "method": "direct"},
        "kappa |V| = 1e+13: must be at most 1e+12": {"V": 1e13 / 2.91, "method": "direct"},
        "method = 'direct' | one relaxation time": {"roller": RUBBER_ROLLER, "method": "direct"},
        "method = 'direct'": {"roller": COVERED, "method": "direct"},
        "delta and omega are both given: give one of the two": {"omega": 1.1},
        "give delta or omega": {"delta": None},
        "V is in units of 1, without dimension: must be in m s-1": {
            "roller": ROLLER,
            "V": unit("1"),
        },
        "V is a table: must be a column of it": {"V": pd.DataFrame({"V [km/h]": [3.6, 7.2]})},
        "V is a row of a table, with units in its index: must be a column of it": {
            "V": pd.DataFrame({"V [km/h]": [3.6], "delta": [0.0]}).iloc[0]
        },
        "labels": {"V": LABELLED, "delta": (0.0, 0.1)},
        "fields = 'N' | many materials": {"roller": PAIRS, "fields": "N"},
        "times | 1e-100 to 1e+100": {
            "roller": PAIRS.replace(material=vr.Prony([[1.0], [2.0]], [1e-120]))
        },
        "times = 1e-120 to": {"roller": PAIRS.replace(material=vr.Prony([1.0], [1e-120]))},
        "fields = 'N' | left out for a cover: N of a layer of finite thickness is not available": {
            "roller": COVERED,
            "fields": "N",
        },
        "thickness/l0 = 0.02: must be larger: half the contact at rest may be at most 6 thicknesses"
        " long": {"roller": THIN},
        "thickness/l0 = 1e-06: must be larger": {
            "roller": THIN.replace(material=vr.Cover(11.0, nu=0.0, thickness=1e-6))
        },
        "thickness/l0 = 0.04: must be at least 0.0625 where covers differ": {
            "roller": THIN.replace(material=vr.Cover(11.0, nu=0.0, thickness=[0.04, 0.1]))
        },
        "shapes V (3,), cylinders (2,)": {"roller": TWO_RADII, "V": [1.0, 2.0, 3.0]},
    },
    roller=PAPER,
    V=1.0,
    delta=0.1,
)
ROLLS = each(
    vr.roll,
    {
        "V0 = 1e+200: must be at most 1e+100": {"V0": 1e200},
        "max(|V0|, |omega0|) = 5e-324: must be 0, or at least 1e-300": {
            "V0": 5e-324,
            "omega0": 0.0,
        },
        "but V0 has shape (2,): use ensemble": {"V0": [1.0, 2.0]},
        "omega0 = [[1.0], [1.0, 2.0]] (a list): must be a finite number": {
            "omega0": [[1.0], [1.0, 2.0]]
        },
        "t = 0.002, 0.001 at rows 0, 1: must be in ascending order": {"t": [2e-3, 1e-3]},
        "t | one end time or a vector": {"t": []},
        "one end time or a vector": {"t": [[1e-3]]},
        "rtol = 0.1: must be a number in [1e-12, 0.01]": {"rtol": 0.1},
        "rtol = 1e-13": {"rtol": 1e-13},
        "max_steps = 0: must be a whole number in [1, 10000000]": {"max_steps": 0},
        "max_steps | must be a whole number in [1, 10000000]": {"max_steps": 10**30},
        "mu has shape (2,): use ensemble": {"roller": PAPER.replace(mu=[0.1, 0.2])},
        "roll needs the scene's gamma": {"roller": PAPER.replace(gamma=None)},
        "material | one motion": {"roller": MANY_SCENES},
        "roll computes one motion, but T_epsilon has shape (3,): use ensemble": {"roller": THREE},
        "V0": {"V0": None},
        "resolve = 1e-09: must be at least 2e-06: 500000 samples up to t = 1": {
            "torque": math.sin,
            "resolve": 1e-9,
            "t": 1.0,
        },
        "resolve = 0.0 | finite and > 0": {"torque": math.sin, "resolve": 0.0},
        "resolve = [0.1, 0.2] | single number": {"torque": math.sin, "resolve": [0.1, 0.2]},
        "resolve = fine is given, but no load or speed is a function of t": {"resolve": "fine"},
        "V and omega are both given": {"V": 1.0, "omega": 1.0},
        "force is given together with V=": {"V": 1.0, "force": 1.0},
        "torque": {"omega": 1.0, "torque": 0.1},
        "omega0 = 2": {"omega0": 2.0, "omega": 1.0},
        "omega jumps at t = 1: must be continuous, as it is a prescribed speed": {
            "omega0": None,
            "omega": vr.Schedule([0.0, 1.0, 1.0], [1.0, 1.0, 2.0]),
        },
        "V jumps at t = 0.3: must be continuous, as it is a prescribed speed": {
            "V0": None,
            "V": lambda t: float(t > 0.3),
            "t": 8.0,
        },
        "force has shape (2, 2)": {"force": ([0.0, 1.0], [0.0, 0.1])},
        "force has shape (3,)": {"force": np.zeros(3)},
        "drive has values for 2 motions: must be the drive of one motion: for many use ensemble": {
            "force": vr.Schedule([0.0, 1.0], [[0.0, 1.0], [0.0, 2.0]])
        },
        "drive has values for 3 motions": {"torque": vr.Feedback(0.01, omega=[0.0, -0.1, 0.1])},
        "torque(t) = nan": {"torque": lambda t: nan},
        "torque must be a function of t alone, but this function has the parameters (t, V, w): for "
        "feedback": {"torque": lambda t, V, w: -V},
        "force must be a function of t alone, but this function has the parameters (): for feedback"
        " of the": {"force": vr.Feedback(lambda: 0.1, V=-1.0)},
        "rest = 0.001 is given": {"force": 0.1, "rest": 1e-3},
        "brake is a Feedback | which can only be given as force= or torque=": {
            "brake": vr.Feedback(0.1, V=10.0)
        },
        "omega is a Feedback | which can only be given as force= or torque=": {
            "omega0": None,
            "omega": vr.Feedback(0.1, V=-0.1),
        },
        "thickness = 1 (divided by l0) | leave unsteady=True out": {
            "roller": COVERED,
            "unsteady": True,
        },
        "thickness = 1 (divided by l0) | leave rested out": {"roller": COVERED, "rested": True},
    },
    **ROLL,
)
#: of one motion and of many
BOTH_KINDS = {
    "unsteady = True: motions with the added mass N are computed for two bodies of one material"
    " only": UNSTEADY | {"roller": BODIES, "unsteady": True},
    "needs the scene's gamma": {"roller": PAPER.replace(gamma=None), "unsteady": True},
    "rested = -1.0: must be finite and >= 0": UNSTEADY | {"rested": -1.0},
    "one time >= 0, or True": UNSTEADY | {"rested": [1.0, 2.0]},
    "it starts in full slip": UNSTEADY | {"omega0": 0.0, "rested": True},
    "a speed is prescribed": UNSTEADY | {"omega0": None, "omega": 30.0, "rested": True},
}
MOTIONS = [*each(vr.roll, BOTH_KINDS, **ROLL), *each(vr.ensemble, BOTH_KINDS, **ROLL)]
ENSEMBLES = each(
    vr.ensemble,
    {
        "V0 = nan at row 1: must be a finite number": {"V0": [1.0, nan]},
        "V0 (2,), omega0 (3,) do not fit together: must be equal, or broadcast": {
            "omega0": [1.0, 2.0, 3.0]
        },
        "mu (3,), V0 (2,)": {"roller": PAPER.replace(mu=[0.1, 0.2, 0.3])},
        "V0 or omega0 has shape (1, 2): must be a number or a vector (n,)": {"V0": [[1.0, 2.0]]},
        "t = 1, 0.5 at rows 0, 1: must be in ascending order": {"t": [1.0, 0.5]},
        "t has shape (0,): must be one end time or a vector of output times": {"t": []},
        "fields: 'speed' is not a field; choose from V, omega": {"fields": ("V", "speed")},
        "threads = 0: must be a whole number >= 1": {"threads": 0},
        "V is empty: must be": {"V0": None, "V": []},
        "V is a Feedback | which can only be given as force= or torque=": {
            "V0": None,
            "V": vr.Feedback(0.1, omega=-0.5),
        },
        "torque (2,), brake (3,) | broadcast": {
            "torque": vr.Schedule([0.0], np.ones((2, 1))),
            "brake": vr.Schedule([0.0], np.ones((3, 1))),
        },
        "shapes omega0 (2,), omega (3,) do not fit together": {"omega": [1.0, 2.0, 3.0]},
        "shapes slope (3,), m (2,)": {"roller": TWO_MASSES, "slope": [0.1, 0.2, 0.3]},
        "shapes brake (3,), cylinders (2,)": {"roller": TWO_MASSES, "brake": [0.1, 0.2, 0.3]},
        "shapes force (3, 2), cylinders (2, 1)": {
            "roller": TWO_MASSES,
            "force": vr.Schedule([0.0, 1.0], np.ones((3, 2))),
        },
        "shapes gain on V (3,), cylinders (2,)": {
            "roller": TWO_RADII,
            "force": vr.Feedback(0.1, V=[0.1, 0.2, 0.3]),
        },
        "ensemble needs the scene's gamma": {"roller": PAPER.replace(gamma=None)},
        "V0 = [1.0, 1.0]: must be None, or 2, the prescribed speed at t = 0": {"V": 2.0},
        "labels": {"V0": LABELLED, "omega0": np.zeros(2)},
        "coordinates": {"V0": LABELLED, "omega0": LABELLED.assign_coords(run=["a", "c"])},
        "V0 or omega0 has shape (2, 2): must be a number or a vector (n,)": {
            "V0": LABELLED,
            "omega0": LABELLED.rename(run="walk"),
        },
    },
    **FREE,
)
FLOWS = each(
    partial(vr.ensemble, method="flow"),
    {
        "V0 = 1e+308: must be at most 1e+100": {"V0": [1.0, 1e308]},
        "omega0 = -1e+308: must be at most 1e+100": {"omega0": [1.0, -1e308]},
        "max(|V0|, |omega0|) = 5e-324: must be 0, or at least 1e-300": {
            "V0": [1.0, 5e-324],
            "omega0": [1.0, 5e-324],
        },
        "max(|V0|, |omega0|) = 1e-310: must be 0, or at least 1e-300": {
            "V0": [1.0, 0.0],
            "omega0": [1.0, -1e-310],
        },
        "V0 = inf at row 1: must be a finite number": {"V0": [1.0, inf]},
        "motions have different scenes": {"roller": PAPER.replace(mu=[0.2, 0.3])},
        "driven": {"force": 0.1},
        "method = 'flow' | or bodies differ": [
            {"roller": PAIRS},
            {"roller": COVERED},
            {"roller": BODIES},
        ],
        "'auto' or 'integrate' where motions are driven or unsteady": UNSTEADY | {"unsteady": True},
    },
    **FREE,
)
DRIVES = each(
    vr.Schedule,
    {
        "times fall after 2: must be in ascending order": ([0.0, 2.0, 1.0], [0.0, 0.0, 0.0]),
        "given once, or twice for a jump": ([0.0, 1.0, 1.0, 1.0], [0.0, 0.0, 1.0, 2.0]),
        "shapes of a Schedule = times (2,), values (3,): must be (k,) for both, or (n, k) for n "
        "motions": ([0.0, 1.0], [0.0, 0.0, 1.0]),
        "shapes of a Schedule = times (), values ()": (0.0, 1.0),
        "times = -1.0 at row 0": ([-1.0, 1.0], [0.0, 0.0]),
        "values = nan at row 1": ([0.0, 1.0], [0.0, nan]),
    },
) + each(
    vr.Feedback,
    {
        "value = nan": nan,
        "omega = inf": {"value": 0.0, "omega": inf},
        "V has shape (1, 2): must be a number, or an array (n,) with one for each motion": {
            "value": 0.0,
            "V": [[1.0, 2.0]],
        },
    },
)
IN_SI = each(
    PAPER_CYLINDER.roll,
    {
        "slope = 1.6: must be in (-pi/2, pi/2), in radians; 1.6 degrees are 0.02793": {
            "slope": 1.6
        },
        "slope has shape (2,): use ensemble": {"slope": [0.1, 0.2]},
        "values of brake = -1.0 at row 1": {"brake": vr.Schedule([1.0, 2.0], [0.0, -1.0])},
        "omega jumps at t = 0.0934579: must be continuous, as it is a prescribed speed | "
        "(dimensionless: times divided by 10.7 s": {"omega": vr.Schedule([1.0, 1.0], [0.0, 1.0])},
        "brake = -1.0: must be finite and >= 0": {"brake": -1.0},
        "rest = -0.1: must be finite and > 0": {"rest": -0.1},
        "resolve = 0.1 is given": {"resolve": 0.1},
    },
    V0=0.0,
    omega0=0.0,
    t=1.0,
)
STEADY = each(
    vr.steady,
    {
        "slope = 1.5708 | (-pi/2, pi/2)": {"slope": [0.1, 0.5 * math.pi]},
        "V is given without force, torque or slope: give one of them too": {"V": 0.1},
        "V, force and torque are all given | two of them": {"V": 0.1, "force": 0.0, "torque": 0.0},
        "torque is a Feedback: must be a number or an array where V is given": {
            "V": 0.1,
            "torque": vr.Feedback(0.0, V=1.0),
        },
        "V is a Feedback": {"torque": 0.0, "V": vr.Feedback(0.1)},
        "torque is a Feedback of a Schedule or function: must be constant in time": {
            "torque": vr.Feedback(math.sin, V=-1.0)
        },
        "kappa |V| = 2.91e+200": {"V": 1e200, "torque": 0.0},
        "force (2,) | torque (3,)": {"force": [0.1, 0.2], "torque": [0.1, 0.2, 0.3]},
        "kappa (force + torque) | 1e-120": {"force": 1e-200},
        "gain on V = 1e+20": {"torque": vr.Feedback(0.1, V=1e20)},
        "alpha has shape (2,): must be a single number": {"roller": vr.Scene([2.0, 3.0], 3.0, 0.2)},
        "a Feedback with gains of shape": {"torque": vr.Feedback(0.0, V=[1.0, 2.0])},
        "torque is a Feedback with gains of shape (2,): must be one whose gains are numbers": {
            "roller": PAPER_CYLINDER,
            "torque": vr.Feedback(1.0, V=[-1.0, 2.0]),
            "slope": [0.0, 0.1],
        },
        "shapes slope (3,), kappa (2,)": {
            "roller": PAPER.replace(kappa=[1.0, 2.0]),
            "slope": [0.1, 0.2, 0.3],
        },
        "shapes force (3,), cylinders (2,)": {"roller": TWO_MASSES, "force": [0.1, 0.2, 0.3]},
        "slope is in percent: must be in rad": {"roller": ROLLER, "slope": unit("percent", 5.0)},
        "slope has shape (2,): must be a single number": {
            "roller": pair(RUBBER_COVER, STEEL),
            "slope": [0.01, 0.02],
        },
        "load has shape (2,)": {"roller": pair(RUBBER_COVER, STEEL, load=[500.0, 600.0])},
        "material = <2 series | one material, as material[i]": {"roller": MANY_SCENES},
        "T_sigma has shape (2,)": {
            "roller": vr.Cylinder(**SI | {"T_sigma": [0.9, 0.97]}, load=[300.0, 400.0])
        },
        "material = Cover( | one material, as material[i]": {
            "roller": COVERED.replace(material=vr.Cover(11.0, nu=0.5, thickness=[1.0, 2.0])),
            "force": 0.01,
        },
        "index": {"slope": FRAME["V"], "torque": FRAME["delta"].iloc[::-1]},
    },
    roller=PAPER,
)
SCENES = each(
    vr.Scene,
    {
        "alpha = 0.999999999999999: must be in [1, 1e+12]": {"alpha": 1.0 - 1e-15},
        "alpha = 1100000000000.0": {"alpha": 1.1e12},
        "alpha = 0.5 at row 1: must be in [1, 1e+12]": {"alpha": [2.0, 0.5]},
        "kappa = nan at (0, 1)": {"kappa": [[1.0, nan]]},
        "mu = nan at row 12345, and 3 more: must be finite and > 0": {
            "mu": np.where(np.isin(np.arange(20000), [12345, 13000, 14000, 19999]), nan, 0.2)
        },
        "mu is a masked array: give mu.compressed()": {"mu": np.ma.masked_less([0.2, -1.0], 0.0)},
        "give alpha or material": {"alpha": None},
        "alpha (2,), kappa (3,) do not fit together: must be equal, or broadcast": {
            "alpha": [1.0, 2.0],
            "kappa": [1.0, 2.0, 3.0],
        },
        "mu/kappa =": {"mu": 1e-200, "kappa": 1e150},
        "mu/kappa = inf": {"mu": [0.2, 1e200], "kappa": 1e-150},
        "alpha and material are both given": {"material": SERIES},
        "alpha and material are both given: give": {"material": law_table(SERIES)},
        "material = 2.0 | Prony": {"alpha": None, "material": 2.0},
        "shapes | alpha (2,), kappa (3,)": {
            "alpha": None,
            "material": MANY,
            "kappa": [1.0, 2.0, 3.0],
        },
    },
    alpha=2.0,
    kappa=2.0,
    mu=0.2,
)
CYLINDERS = each(
    vr.Cylinder,
    {
        "T_epsilon = 0.5: must be >= T_sigma": {"T_epsilon": 0.5},
        "T_epsilon = 0.5 | >= T_sigma": {"T_epsilon": [10.0, 0.5]},
        "T_epsilon has shape (1, 2): must be a number or a vector (n,)": {
            "T_epsilon": [[10.0, 11.0]]
        },
        "R = 0.0 at row 1": {"R": [0.1, 0.0]},
        "R = True (a truth value): must be a number": {"R": True},
        "R = <built-in function len> (a function): must be a number, finite and > 0": {"R": len},
        ", or in another unit of that dimension": {"R": np.timedelta64(5, "s")},
        "R is in furlongz, a unit that is not known: must be in m": {"R": unit("furlongz")},
        "R is a table: must be a column of it": {"R": pd.DataFrame({"R [mm]": [100.0]})},
        "material and E, nu, T_epsilon, T_sigma are both given": {"material": SOFT},
        "give material=, or all of E, nu, T_epsilon and T_sigma: T_sigma not given": {
            "T_sigma": None
        },
    },
    **SI,
) + each(
    vr.Cylinder,
    {
        "material = 'rubber': must be a Material": {"material": "rubber"},
        "base = 200000000000.0: must be a Material": {"base": 2e11},
        "base = rigid: must be a deformable body": {"material": vr.Material.rigid()},
        "base = rigid": {"material": vr.Material.rigid(), "base": vr.Material.rigid()},
        "load = -2.0 at row 1": {"load": [1.0, -2.0]},
        "m (3,)": {"m": [1.0, 2.0, 3.0], "load": [1.0, 2.0]},
        "mu = None": {"mu": None},
        "thickness of the layer on the cylinder is 20 m: must be at most R = 0.1 m": {
            "material": replace(RUBBER_COVER, thickness=20.0)
        },
        "thickness of the layer on the cylinder is 0.09 m: must be at most R = [0.1 , 0.08] m": {
            "material": replace(RUBBER_COVER, thickness=0.09),
            "R": [0.1, 0.08],
        },
        "plane = 'stress' | 'strain' beside a layer": {
            "material": RUBBER_COVER,
            "base": STEEL,
            "plane": "stress",
        },
        "material is a dimensionless law: must be the law of a Material, in SI units": {
            "material": law_table(SERIES)
        },
        "base is given: must be left out: the law already contains both bodies": {
            "material": law_table_of(SOFT, STEEL),
            "base": STEEL,
        },
        "plane = 'stress'": {"material": law_table_of(SOFT, STEEL), "plane": "stress"},
    },
    **MADE,
)
#: products of parameters that no double holds
SCALES = each(
    lambda **given: vr.Cylinder(**SI | given).scene(),
    {
        "kappa": {"R": 1e-172, "m": 1e-172},
        "kappa = R/sqrt(32 R P/E') = 0.0: must be finite and > 0": {
            "R": 1e-300,
            "m": 1e300,
            "E": 1e-300,
        },
        "gamma": {"T_epsilon": 1e200, "T_sigma": 1e199},
        "gamma = P T_ref^2/(m R) = inf": {"T_epsilon": 1e300, "T_sigma": 1e-300},
    },
)
SAMPLES = each(
    sample,
    {
        "give seed or rng": {"seed": None},
        "seed and rng are both given": {"rng": 2},
        "n = 10000000000000: must be a whole number in [1, 1000000000000]": {"n": 10**13},
        "seed = 9223372036854775808: must be a whole number in [0, 9223372036854775807]": {
            "seed": 2**63
        },
        "design: 'grid' is not a design; choose from random, latin, sobol": {"design": "grid"},
        "V0 = nan: must be a finite number or a frozen scipy.stats distribution": {"V0": nan},
        "V0 = [1.0, 2.0]": {"V0": [1.0, 2.0]},
        "V0 = True": {"V0": True},
        "V0 = <scipy | must be a finite number or a frozen scipy.stats distribution with a finite "
        "median (scale > 0)": {"V0": stats.norm(2.0, -1.0)},
        "V0 = <scipy | distribution": {"V0": stats.uniform([0.0, 1.0], 1.0)},
        "V0 = <scipy": {"V0": stats.gamma},
        ": must be a finite number": {"n": 64, "V0": stats.norm(0.0, 1e308)},
    },
    n=4,
    seed=0,
    V0=stats.uniform(),
)
LAWS = each(
    vr.law,
    {
        "alpha": vr.Scene([2.0, 3.0], 50.0, 0.2),
        "kappa": vr.Scene(2.0, [50.0], 0.2),
        "mu": vr.Scene(2.0, 50.0, np.full((2, 2), 0.2)),
        "material": MANY_SCENES,
        "material = <2 pairs | one material": PAIRS,
        "load has shape (2,): must be one number": PAPER_CYLINDER.replace(load=[1.0, 2.0]),
        "m has shape (2,): must be one number": TWO_MASSES,
        "2.0": 2.0,
    },
)
GRIDS = each(
    vr.tables.build,
    {
        "what = 11.0: must be a Scene, a Cylinder or a law of half-spaces": {"what": 11.0},
        "what has shape (2,): must be one scene or cylinder whose parameters are numbers": {
            "what": PAPER.replace(mu=[0.1, 0.2])
        },
        "alpha is given: must be left out: the material determines alpha": {
            "what": ROLLER,
            "alpha": [1.0, 2.0],
        },
        "alpha = 0.5": {"alpha": [0.5]},
        "V = 0": {"V": [0.0, 1.0]},
        "V has shape (1, 1): must be a number, or a vector that increases strictly": {"V": [[1.0]]},
        "V is empty: must be a number, or a vector that increases strictly": {"V": []},
        "kappa |V|": {"V": [1e300]},
        "delta": {"delta": [0.1, 0.0]},
        "at most": {"V": np.arange(1.0, 10000.0), "delta": np.arange(10000.0)},
        "method = 'direct' | one relaxation time": {"what": RUBBER_ROLLER, "method": "direct"},
    },
    what=PAPER,
    V=[0.1, 1.0],
    delta=[0.0, 0.01],
)
NODES = each(
    vr.tables.creep_nodes,
    {
        "what = None: must be a Scene, a Cylinder or a law of half-spaces": {"what": None},
        "count = 10 | odd": {"count": 10},
        "count = 3 | in [5,": {"count": 3},
        "V = 0 | > 0": {"V": [0.0, 1.0]},
        "alpha is given: must be left out: the material determines alpha": {
            "what": RUBBER_ROLLER,
            "alpha": [2.0, 3.0],
        },
        "alpha is given: must be left out": {"what": PAPER_CYLINDER, "alpha": [2.0, 3.0]},
    },
    what=PAPER,
    V=[0.1, 1.0],
    count=11,
) + each(
    vr.tables.spread,
    {
        "high = 5.0: must be > low = 5": (5.0, 5.0, 3),
        "low = 0.0: must be finite and > 0": (0.0, 1.0, 3, "log"),
        "count = 1": (1.0, 2.0, 1),
    },
)
OTHERS = each(
    None,
    {
        "labels": lambda: vr.stress(PAPER, np.zeros(2), LABELLED, delta=0.0),
        "shapes x (3,), cylinders (2,)": lambda: TWO_RADII.stress([0.0] * 3, 1.0, delta=0.0),
        "shapes V (3,), cylinders (2,)": lambda: TWO_RADII.validity([1.0, 2.0, 3.0]),
        "density needs a Cylinder: a Scene has no wave speed": lambda: PAPER.validity(
            1.0, density=1130.0
        ),
        "broadcast": lambda: PAPER.replace(alpha=[1.0, 2.0]).validity([1.0, 2.0, 3.0]),
        "shapes | broadcast": lambda: MANY_SCENES.validity([0.3, 0.2, 0.1]),
        "kappa has shape (2,): must be a single number": lambda: vr.resistance_extrema(
            PAPER.replace(kappa=np.ones(2))
        ),
        "R has shape (2,)": lambda: (
            pair(RUBBER_COVER, STEEL).replace(R=[0.1, 0.2]).resistance_extrema()
        ),
        "a plot needs several speeds or creepages: the result contains": lambda: PAPER.contact(
            1.0, delta=0.01
        ).plot(),
        "within the motion": lambda: vr.roll(PAPER, 1.5, 0.5, 3e-3).at(3.1e-3),
        "ascending": lambda: vr.roll(PAPER, 1.5, 0.5, 3e-3).at([2e-3, 1e-3]),
        "quantiles = 2.0 at row 1: must be in [0, 1]": lambda: vr.ensemble(**FREE).summary(
            quantiles=[0.5, 2.0]
        ),
        "quantiles = 0.5: must be a list of numbers": lambda: vr.ensemble(**FREE).summary(
            quantiles=0.5
        ),
        "motions = 0: must be at least 1": lambda: vr.ensemble(PAPER, [], 2.0, 1e-3).summary(),
        "omega = 1e+308: must be smaller in magnitude": lambda: vr.law(PAPER_CYLINDER)(1.0, 1e308),
        "V = 10": lambda: vr.law(ONE)(10**400, 1.0),
        "V = [1.0, 'x']": lambda: vr.law(ONE)([1.0, "x"], 1.0),
        "T_epsilon = 0.001: must be >= T_sigma = 0.005": lambda: THREE.replace(T_sigma=5e-3),
        "T_epsilon | a vector (n,)": lambda: THREE.replace(T_epsilon=[[1e-3], [1e-2], [2e-2]]),
        "T_epsilon | single number": lambda: THREE.replace(base=vr.Material.rigid()).scene(),
        "mu has shape (2,): must be one number: an FMU contains one cylinder": lambda: fmu.build(
            ROLLER.replace(mu=[0.2, 0.3]), "a.fmu"
        ),
        "version = 1 | a whole number in [2, 3]": lambda: fmu.build(ROLLER, "a.fmu", version=1),
        "material is of type bool": lambda: fmu.build(True, "b.fmu"),
    },
)


@pytest.mark.parametrize(
    ("call", "words", "error"),
    [
        *CONTACT,
        *ROLLS,
        *MOTIONS,
        *ENSEMBLES,
        *FLOWS,
        *DRIVES,
        *IN_SI,
        *STEADY,
        *SCENES,
        *CYLINDERS,
        *SCALES,
        *SAMPLES,
        *LAWS,
        *GRIDS,
        *NODES,
        *OTHERS,
    ],
)
def test_refused(call, words, error):
    refused(call, *words, error=error)


def test_errors_of_input_are_value_errors():
    assert issubclass(vr.ParameterError, ValueError)
