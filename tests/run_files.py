"""Run files of every kind: presets, series, SI units, materials, drives and prescribed speeds."""

import re
from pathlib import Path

import viscoroll as vr
from viscoroll.runs import read_run

PAPER = 'preset = "paper-section-5"\n'
FULL = (
    PAPER
    + """
[scene]
mu = { distribution = "lognorm", s = 0.3, scale = 0.2, truncate = [0.05, 0.6] }
j = 0.4
[start]
V0 = U(-2.0, 4.0)
omega0 = { distribution = "norm", scale = 0.5 }
[correlation]
V0.mu = 0.7
[run]
n = 30
seed = 5
t = { low = 0.0, high = 3e-3, count = 3 }
rtol = 1e-6
block = 12
keep = "all"
summaries = ["V", "x"]
"""
)
STRENGTHS = """
[scene]
prony = { E = [0.5, U(1.0, 2.0)], tau = [1.0, 1e-2] }
kappa = 10.0
mu = 0.3
gamma = 4.0
[start]
V0 = 1.0
omega0 = U(0.0, 0.5)
[correlation]
E_2.omega0 = 0.5
[run]
n = 20
t = [0.5, 2.0]
"""
COMPLIANCES = (
    STRENGTHS.replace("prony", "creep")
    .replace("E = [0.5, U(1.0, 2.0)]", "J = [0.2, U(0.3, 0.2)]")
    .replace("tau =", "T =")
    .replace("E_2", "J_2")
)
PAPER_ROLLER = "[cylinder]\nR = U(0.08, 0.04)\nm = 35.5\nmu = 0.2\n"
PAPER_RUBBER = "E = 2.3e5\nnu = 0.49\nT_epsilon = U(9.0, 3.0)\nT_sigma = 0.97\n"
SLOW = """
[start]
V0 = U(-0.02, 0.04)
omega0 = { distribution = "norm", loc = 0.05, scale = 0.1 }
[run]
n = 20
t = [1e-4, 2e-3, 0.03]
rtol = 1e-10
keep = "all"
fields = ["V", "omega", "x", "angle", "delta", "regime", "slip_loss", "rolling_loss"]
summaries = ["V", "omega", "x", "distance", "angle", "delta", "translation", "lost", "lost_to_slip", "onset_time"]
"""  # noqa: E501
NUMBERS = PAPER_ROLLER + PAPER_RUBBER + SLOW
SERIES = """
[material]
E = 2.3e5
nu = 0.49
prony = { E = [2.0, 6.0], tau = [1.0, 1e-3] }
T_ref = 3.0
"""
LOADED = SERIES + PAPER_ROLLER + "load = U(300.0, 100.0)\n" + SLOW
RUBBER = vr.datasets.path("rubber-sensitivity.toml").read_text().replace("20_000", "12")
RUBBER = re.sub("#.*", "", RUBBER).replace(
    "rtol =", 'fields = ["V", "omega", "x"]\nkeep = "all"\nrtol ='
)
CERTAIN = (
    RUBBER[: RUBBER.index("[material]")]
    + "[material]\nE = 3e6\nnu = 0.5\n"
    + RUBBER[RUBBER.index("[start]") :]
)
SOFT_BASE = """
[base]
E = { distribution = "lognorm", s = 0.2, scale = 3e6 }
nu = 0.5
T_ref = 0.02
[base.prony]
E = [{ distribution = "lognorm", s = 0.3, scale = 0.5 }]
tau = [U(1.0, 1.0)]
"""
HARD_BASE = '[base]\nE = { distribution = "lognorm", s = 0.2, scale = 3e7 }\nnu = U(0.3, 0.2)\n'
RIGID_BASE = "[base]\nE = inf\nnu = 0.5\n"
DRIVEN = (
    PAPER
    + """
[start]
V0 = 0.0
omega0 = 0.0
[drive]
torque = { times = [0.0, 1e-3, 1e-3], values = [0.0, U(0.1, 0.2), 0.0] }
slope = { distribution = "norm", scale = 0.01, truncate = [-0.1, 0.1] }
force = { distribution = "norm", scale = 0.02 }
brake = 0.01
[correlation]
drive_torque_2.drive_force = 0.5
[run]
n = 12
t = [1e-3, 3e-3]
keep = "all"
fields = ["V", "force", "torque", "work_torque", "slip_loss"]
summaries = ["V", "force", "work_force", "work_torque", "brake_loss", "slip_loss", "rolling_loss", "lost_to_slip"]
"""  # noqa: E501
)
OWN_TIMES = (
    PAPER
    + """
[start]
V0 = 0.0
omega0 = 0.0
[drive]
torque = { times = [0.0, U(1e-3, 5e-4), "same", U(2e-3, 1e-3)], values = [0.0, U(0.0, 0.3), 0.05, -0.1] }
force = { times = [5e-4, 5e-4], values = [0.0, 0.01] }
[run]
n = 12
t = [1e-3, 3e-3]
"""  # noqa: E501
)
GIVEN_V = (
    OWN_TIMES.replace("torque", "V")
    .replace('"same", ', "")
    .replace("0.05, ", "")
    .replace("force", "torque")
    .replace("V0 = 0.0\n", "")
)
GIVEN_OMEGA = (
    GIVEN_V.replace("V =", "omega =").replace("omega0 =", "V0 =").replace("torque =", "force =")
)
DRIVEN_ROLLER = """
[cylinder]
R = U(0.1, 0.05)
m = U(30.0, 10.0)
E = 2.3e5
nu = 0.49
T_epsilon = U(9.0, 3.0)
T_sigma = 0.97
mu = 0.2
[start]
V0 = 0.014
omega0 = 0.05
[drive]
torque = U(1.0, 0.5)
force = { times = [0.0, 1.0], values = [10.0, U(-20.0, 5.0)] }
slope = U(-0.05, 0.1)
brake = { times = [1.5, 1.5], values = [0.0, 3.0] }
[run]
n = 8
t = [0.5, 1.0, 2.0]
keep = "all"
fields = ["V", "omega", "x", "force", "torque", "work_force", "work_torque", "brake_loss", "slip_loss", "rolling_loss"]
summaries = ["force", "torque", "work_force", "slip_loss"]
"""  # noqa: E501
UNSTEADY = """[cylinder]
R = 0.1
m = 35.5
E = 2.3e6
nu = 0.49
T_epsilon = 0.5
T_sigma = 0.1
mu = U(0.2, 0.3)
[start]
V0 = 1.0
omega0 = 10.0
[drive]
torque = { times = [0.0, 2.0], values = [0.0, 0.5] }
[run]
n = 8
t = [1.0, 3.0]
unsteady = true
rested = 60.0
keep = "all"
fields = ["V", "omega", "x", "work_torque"]
"""
WARM = CERTAIN.replace(
    "3e6\nnu = 0.5\n",
    """U(3e6, 1e6)
nu = 0.5
reference = 30.0
vertical_shift = "entropic"
prony = { E = [U(1.0, 1.0), 2.0], tau = [1.0, 0.1] }
T_ref = 0.01
wlf = { T0 = 20.0, C1 = 8.86, C2 = 101.6 }
temperature = U(10.0, 30.0)
""",
    1,
)
FILES = {
    "a preset": FULL,
    "a temperature each": WARM,
    "strengths": STRENGTHS,
    "compliances": COMPLIANCES,
    "numbers": NUMBERS,
    "a series": LOADED,
    "rubber": RUBBER,
    "rubber on rubber": RUBBER + SOFT_BASE,
    "rubber on steel": RUBBER.replace("m = 35.5", "m = 35.5\ncoupled = false") + HARD_BASE,
    "on what is rigid": RUBBER + RIGID_BASE,
    "a rigid roller": CERTAIN.replace("3e6", "inf") + SOFT_BASE,
    "driven": DRIVEN,
    "own times": OWN_TIMES,
    "given V": GIVEN_V,
    "given omega": GIVEN_OMEGA,
    "a driven roller": DRIVEN_ROLLER,
    "unsteady": UNSTEADY,
}
FILES = {
    name: re.sub(
        r"U\(([^ ]*), ([^ ]*)\)", r'{ distribution = "uniform", loc = \1, scale = \2 }', text
    )
    for name, text in FILES.items()
}


def run_of(text, folder="."):
    """A run file of this text, read."""
    path = Path(folder) / "run.toml"
    path.write_text(text)
    return read_run(path)
