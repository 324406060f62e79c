"""A roller of known truth, and experiments on it: a standard linear solid whose M has its hump at
0.64 m/s.
"""

import numpy as np

import viscoroll as vr

TRUTH = {"mu": 0.3, "E": 3e6, "E_1": 9.0, "T_ref": 1e-3}
RANGES = {"mu": (0.03, 3.0), "E": (3e5, 3e7), "E_1": (0.9, 90.0), "T_ref": (1e-4, 1e-2)}
BRAKE = 0.05
DRAG = 0.003
SLOW = np.geomspace(0.02, 0.2, 40)
HUMP = np.geomspace(0.02, 20.0, 40)
TIMES = np.linspace(0.0, 20.0, 200)


def roller(**changes):
    """The truth, or another."""
    value = TRUTH | changes
    rubber = vr.Material(value["E"], 0.5, vr.Prony([value["E_1"]], [1.0]), value["T_ref"])
    return vr.Cylinder(R=0.1, m=35.5, mu=value["mu"], material=rubber)


def ranges(*names):
    return {name: RANGES[name] for name in names}


def noise(seed, values, sigma):
    """Values with noise; without a seed as they are."""
    return (
        values
        if seed is None
        else values + sigma * np.random.default_rng(seed).standard_normal(values.shape)
    )


def resistance(V=HUMP, seed=None):
    """M over speed."""
    M = roller().contact(V, delta=0.0).M
    return vr.Resistance(V, noise(seed, M, 0.01), sigma=0.01)


def traction(seed=None):
    """Q over creep at 0.1 m/s."""
    delta = np.linspace(-0.06, 0.06, 21)
    Q = roller().contact(0.1, delta=delta).Q
    return vr.Traction(0.1, delta, noise(seed, Q, 1.0), sigma=1.0)


def thrown(seed=None, t=TIMES):
    """V of a roller thrown at 4 m/s without spin."""
    V = roller().roll(4.0, 0.0, t, rtol=1e-10).V
    return vr.Coastdown(t, noise(seed, V, 5e-3), sigma=5e-3, name="throw", omega0=0.0)


#: of the drum's resistance, in files
FILE = """
[cylinder]
R = 0.1
m = 35.5
mu = 0.3

[material]
E = 3e6
nu = 0.5
prony = { E = [9.0], tau = [1.0] }
T_ref = 1e-3
temperature = 20.0
wlf = { T0 = 20.0 }

[unknown]
E = [3e5, 3e7]
T_ref = [1e-4, 1e-2]

[[data]]
kind = "resistance"
file = "drum.csv"
columns = { V = "speed", M = "moment" }
sigma = 0.01
temperature = 20.0
"""


def measurements(folder, old="", new=""):
    """A TOML file and its CSV, with this for that in both."""
    data = resistance(SLOW, seed=1)
    rows = [f"{V!r},{M!r}" for V, M in zip(data.V.tolist(), data.M.tolist())]
    drum = "\n".join(["speed [m/s],moment [N m/m]", "# a remark", *rows])
    for name, text in (("drum.csv", drum), ("data.toml", FILE)):
        (folder / name).write_text(text.replace(old, new) if old else text)
    return folder / "data.toml"
