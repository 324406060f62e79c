"""
Rubber on steel
===============

If a rubber roller rolls on steel, only the rubber deforms and dissipates energy.  At the same load
the contact is shorter than that of rubber on rubber, and rolling resistance is smaller.
"""

import matplotlib.pyplot as plt
import numpy as np

import viscoroll as vr

rubber = vr.Material(
    E=3e6,
    nu=0.5,
    prony=vr.Prony(E=[0.4, 0.6, 1.5], tau=[1e-1, 1e-3, 1e-5]),
    name="rubber",
)
steel = vr.Material.elastic(E=2.1e11, nu=0.3)
speed = np.geomspace(1e-3, 1e3, 300)  # m/s
figure, axes = plt.subplots(figsize=(6.4, 4.0), layout="constrained")
for name, base in {
    "rubber on rubber": rubber,
    "rubber on steel": steel,
}.items():
    roller = vr.Cylinder(
        R=0.05, m=9.0, material=rubber, base=base, mu=0.6, load=2000.0
    )
    c = roller.contact(
        speed, delta=0.0, fields=("M", "M_half_space")
    )  # N m per m of length
    (line,) = axes.semilogx(
        speed,
        100.0 * c.M / (roller.R * roller.load),
        "-" if base is rubber else "-.",
        label=f"{name}: contact {1e3 * roller.l0:.1f} mm at rest",
    )
    if base is rubber:  # steel dissipates nothing
        half = 100.0 * c.M_half_space / (roller.R * roller.load)
        axes.semilogx(
            speed,
            half,
            "--",
            color=line.get_color(),
            label="rubber on rubber: part of the base alone",
        )
axes.set(
    xlabel="speed, m/s",
    ylabel="rolling resistance $M/(PR)$, %",
    ylim=(0.0, None),
)
axes.legend(frameon=False, fontsize="small")

# %%
# The theory assumes that shear does not change the pressure.  This is so if Dundurs' constant is 0.
# For rubber on steel it is close to 0, since rubber is nearly incompressible:
print(roller.validity(1.0).bodies.sentence)
