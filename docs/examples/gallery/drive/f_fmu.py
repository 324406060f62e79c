"""
A roller in another tool
========================

``viscoroll fmu`` exports a roller as an FMU, a model in one file that Modelica tools, Simulink and
other programs run.  Here the program fmpy runs one: a motor drives a roller from rest for one
second.
"""

import tempfile
from pathlib import Path

import fmpy
import matplotlib.pyplot as plt
import numpy as np

import viscoroll as vr
from viscoroll import fmu

roller = vr.presets.RUBBER_CYLINDER
drive = np.array(
    [(0.0, 0.0, 5.0), (1.0, 0.0, 5.0), (1.0, 0.0, 0.0), (3.0, 0.0, 0.0)],
    dtype=[
        ("time", float),
        ("drive_force", float),
        ("drive_torque", float),
    ],
)  # s, N, N m
with tempfile.TemporaryDirectory() as folder:
    path = Path(folder) / "roller.fmu"
    fmu.build(roller, path)  # or: viscoroll fmu rubber.toml -o roller.fmu
    found = fmpy.simulate_fmu(
        str(path),
        stop_time=3.0,
        output_interval=0.02,
        fmi_type="CoSimulation",
        input=drive,
        start_values={"v0": 0.0},
        output=["v", "omega", "traction"],
    )

figure, axes = plt.subplots(figsize=(6.4, 3.6), layout="constrained")
axes.plot(found["time"], found["v"], label="$v$")
axes.plot(
    found["time"], roller.R * found["omega"], "--", label=r"$\omega R$"
)
axes.set(xlabel="$t$, s", ylabel="speed, m/s")
axes.legend(frameon=False)
print(f"v = {found['v'][-1]:.6f} m/s after 3 s")

# %%
# This FMU contains the whole roller and computes its motion.  If the other program itself computes
# the motion of the cylinder, as a part of a mechanism, export the contact alone by
# ``--model ContactElement``.  From the speed v, the angular velocity omega and the load it computes
# force and torque on the cylinder, with their derivatives.
