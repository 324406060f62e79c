"""Bad input of calls that no range alone tells: what contradicts, is missing, does not fit
together, or is beyond what the model or doubles hold.
"""

import math
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from calls import (
    BARE,
    COVERED,
    FRAME,
    LABELLED,
    MANY,
    PAPER,
    RUBBER_COVER,
    SERIES,
    SI,
    SOFT,
    STEEL,
    THIN,
)
from refusals import each, refusals
from scipy import stats

import viscoroll as vr
from viscoroll.laws.law_netcdf import law_table_of
from viscoroll.presets import PAPER_CYLINDER
from viscoroll.sampling import points, sample

pytestmark = pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")
RUBBER_ROLLER = vr.presets.RUBBER_ROLLER
MANY_SCENES = vr.Scene(material=MANY, kappa=2.91, mu=0.2, gamma=700.0)
BODIES = RUBBER_ROLLER.replace(material=vr.Bodies(vr.Prony([2.0], [1.0]), SERIES, 0.7))
ROLL = {"roller": PAPER, "V0": 1.0, "omega0": 1.0, "t": 1e-3}
FREE = {"roller": PAPER, "V0": [1.0, 1.0], "omega0": [1.0, 1.0], "t": 1e-3}
ARRAY = np.array([1, 2])
UNSTEADY = ROLL | {"roller": RUBBER_ROLLER, "V0": 30.0, "omega0": 30.0}


REFUSED = each(
    vr.contact,
    {
        "method = 'direct': must be 'table' if slopes=True": {"method": "direct", "slopes": True},
        "method = 'direct' | one relaxation time": {"roller": RUBBER_ROLLER, "method": "direct"},
        "delta and omega are both given: give only one of the two": {"omega": 1.1},
        "V is a table: must be one column of it": {"V": pd.DataFrame({"V [km/h]": [3.6, 7.2]})},
        "thickness/l0 = 0.04: must be at least 0.0625 in a call with several thick": {
            "roller": THIN.replace(material=vr.Cover(1.0, nu=0.0, thickness=[0.04, 0.1]))
        },
        "thickness/l0 = 0.005: must be larger: half the contact at rest": {
            "roller": THIN.replace(material=vr.Cover(1.0, nu=0.0, thickness=[0.005, 0.1]))
        },
    },
    roller=PAPER,
    V=1.0,
    delta=0.1,
)
REFUSED += each(
    vr.roll,
    {
        "t = 0.002, 0.001 at index 0, 1: must be in ascending order": {"t": [2e-3, 1e-3]},
        "force is given together with V=": {"V": 1.0, "force": 1.0},
        "V and omega are both given": {"V": 1.0, "omega": 1.0},
        "brake is a Feedback": {"brake": vr.Feedback(0.1, V=10.0)},
        "V jumps at t = 0.3: must be continuous, as it is a prescribed speed": {
            "V0": None,
            "V": lambda t: float(t > 0.3),
            "t": 8.0,
        },
        "one motion, but a gain, V or omega of a Feedback, has shape (3,): use ensemble": {
            "torque": vr.Feedback(0.01, omega=[0.0, -0.1, 0.1])
        },
        "one motion, but torque has shape (2,): use ensemble": {
            "torque": vr.Schedule([0.0, 1.0], [[0.0, 1.0], [0.0, 2.0]])
        },
        "torque must be a function of t alone, but this function has the parameters (t, V, w): for "
        "a force or torque that is linear": {"torque": lambda t, V, w: -V},
        "thickness is given | leave rested out": {"roller": COVERED, "rested": True},
    },
    **ROLL,
)
#: of one motion and of many
BOTH_KINDS = {
    "unsteady = True: motions with the added mass N are computed for two bodies of one material"
    " only": UNSTEADY | {"roller": BODIES, "unsteady": True},
    "needs the scene's gamma": {"roller": PAPER.replace(gamma=None), "unsteady": True},
    "one time >= 0, or True": UNSTEADY | {"rested": [1.0, 2.0]},
    "the cylinder starts in full slip": UNSTEADY | {"omega0": 0.0, "rested": True},
    "a speed is prescribed": UNSTEADY | {"omega0": None, "omega": 30.0, "rested": True},
}
REFUSED += each(vr.roll, BOTH_KINDS, **ROLL) + each(vr.ensemble, BOTH_KINDS, **ROLL)
REFUSED += each(
    vr.ensemble,
    {
        "V0 has shape (1, 2): must be a number or a vector (n,)": {"V0": [[1.0, 2.0]]},
        "V0 = 1: must be left out (in Python None), or 2, the prescribed V at t = 0": {"V": 2.0},
        "V is empty: must be": {"V0": None, "V": []},
        "coordinates": {"V0": LABELLED, "omega0": LABELLED.assign_coords(run=["a", "c"])},
    },
    **FREE,
)
#: numbers of a motion in its own unit of speed
REFUSED += each(
    vr.ensemble,
    {
        "V0 = 1 m s-1 of motion 1: must be left out (in Python None), or 3 m s-1, the": {
            "V": [1.0, 3.0]
        },
        "V0 = 1e+121 m s-1 of motion 1: must be at most 1.": {"V0": [1.0, 1e121]},
        "R |omega0|) = 9.99989e-321 m s-1 of motion 0: must be 0, or": {"V0": [1e-320, 1.0]},
    },
    roller=PAPER_CYLINDER.replace(R=[0.1, 0.2]),
    V0=1.0,
    omega0=0.0,
    t=1.0,
)
REFUSED += each(
    PAPER_CYLINDER.roll,
    {
        "omega jumps at t = 1 s: must be continuous, as it is a prescribed speed": {
            "omega": vr.Schedule([1.0, 1.0], [0.0, 1.0])
        },
        "resolve = 1e-09 s: must be at least 2e-06 s: at most 500000 samples up to t = 1 s": {
            "torque": math.sin,
            "resolve": 1e-9,
        },
    },
    V0=0.0,
    omega0=0.0,
    t=1.0,
)
REFUSED += each(
    vr.steady,
    {
        "V is given without force, torque or slope: give one of them too": {"V": 0.1},
        "torque is a Feedback: must be a number or an array where V is given": {
            "V": 0.1,
            "torque": vr.Feedback(0.0, V=1.0),
        },
        "force is a function: must be a number, an array or a Feedback": {"force": math.sin},
        "force is a Schedule: must be": {"force": vr.Schedule([0.0, 1.0], [1.0, 2.0])},
        "torque is a Feedback that varies with time: must be constant in time": {
            "torque": vr.Feedback(math.sin, V=-1.0)
        },
        "index": {"slope": FRAME["V"], "torque": FRAME["delta"].iloc[::-1]},
    },
    roller=PAPER,
)
REFUSED += each(
    vr.Scene,
    {
        "neither alpha nor material is given": {"alpha": None},
        "material = 2.0 | Prony": {"alpha": None, "material": 2.0},
    },
    alpha=2.0,
    kappa=2.0,
    mu=0.2,
)
REFUSED += each(
    vr.Cylinder,
    {
        "T_epsilon = 0.5: must be >= T_sigma": {"T_epsilon": 0.5},
        "E, nu, T_epsilon, T_sigma given beside material: must be left out": {"material": SOFT},
        "shapes R (2,), load (3,) do": {"R": [0.1, 0.2], "load": [1.0, 2.0, 3.0]},
        "T_sigma not given: give all of E, nu, T_epsilon and T_sigma, or a material": {
            "T_sigma": None
        },
    },
    **SI,
) + each(
    vr.Cylinder,
    {
        "material = 'rubber' (a text): must be a Material": {"material": "rubber"},
        "base = rigid: must be a deformable body": {"material": vr.Material.rigid()},
        "thickness of the layer on the cylinder is 20 m: must be at most R = 0.1 m": {
            "material": replace(RUBBER_COVER, thickness=20.0)
        },
        "base is given: must be left out: the law already contains both bodies": {
            "material": law_table_of(SOFT, STEEL),
            "base": STEEL,
        },
    },
    **BARE,
    material=SOFT,
)
REFUSED += each(
    sample,
    {
        "neither seed nor rng is given": {"seed": None},
        "design = 'grid' (a text): must be 'random', 'latin' or 'sobol'": {"design": "grid"},
        "rng = -1: must be a Generator of numpy": {"seed": None, "rng": -1},
    },
    n=4,
    seed=0,
    V0=stats.uniform(),
)
REFUSED += each(
    None,
    {
        "shapes of a Schedule = times (), values ()": lambda: vr.Schedule(0.0, 1.0),
        "material": MANY_SCENES.law,
        "m has shape (2,): must be one number": PAPER_CYLINDER.replace(m=[30.0, 40.0]).law,
        "at most": lambda: vr.tables.build(
            PAPER, np.arange(1.0, 10000.0), delta=np.arange(10000.0)
        ),
        "count = 10 | odd": lambda: vr.tables.creep_nodes(PAPER, [0.1, 1.0], count=10),
        "density is given for a Scene: leave it out, or use a Cylinder": lambda: PAPER.validity(
            1.0, density=1130.0
        ),
        "within the motion": lambda: PAPER.roll(1.5, 0.5, 3e-3).at(3.1e-3),
        "quantiles = 0.5: must be a list of numbers": lambda: vr.ensemble(**FREE).summary(
            quantiles=0.5
        ),
        "run = 'run.toml' (a text): must be a Run, as runs.read_run(path) returns it": [
            lambda: vr.runs.run_ensemble("run.toml", "s.zarr"),
            lambda: vr.runs.estimate("run.toml"),
        ],
        "progress = array([1, 2]) | must be": lambda: vr.runs.run_ensemble("", "", progress=ARRAY),
        "cluster = array([1, 2]) | must be": lambda: vr.runs.run_ensemble(
            vr.runs.read_run(vr.datasets.path("run.toml")), "s.zarr", cluster=ARRAY
        ),
        "name = array([1, 2]) | must be 'dma.csv', ": lambda: vr.datasets.path(ARRAY),
        "design 'sobol' = 21202: must be": lambda: points("sobol", 0, 9, 21_202, 0, 9, 0),
    },
)
test_refused = refusals(REFUSED)


def test_errors_of_input_are_value_errors():
    assert issubclass(vr.ParameterError, ValueError)


@pytest.mark.parametrize(
    "roller, name", [(PAPER.replace(alpha=[2.0, 3.0]), "alpha"), (MANY_SCENES, "material")]
)
def test_an_error_has_the_name_of_the_argument(roller, name):
    words = "^alpha, T_epsilon, .* has shape .*: must be one number each with method='coupled'"
    with pytest.raises(vr.ParameterError, match=words) as raised:
        roller.contact(0.5, delta=0.01, method="coupled")
    assert raised.value.name == name
