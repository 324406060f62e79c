"""
Covers of finite thickness
==========================

A rubber layer on steel is stiffer than a half-space of the same rubber.  Its contact is shorter,
its rolling resistance smaller, and the maximum lies at a lower speed.
"""

from dataclasses import replace

import matplotlib.pyplot as plt
import numpy as np

import viscoroll as vr

rubber = vr.Material(
    E=3e6,
    nu=0.5,
    prony=vr.Prony(E=[0.4, 0.6, 1.5], tau=[1e-1, 1e-3, 1e-5]),
    name="rubber",
)
steel = vr.Material.rigid()
roller = vr.Cylinder(
    R=0.05, m=9.0, material=rubber, base=steel, mu=0.6, load=2000.0
)
speed = np.geomspace(1e-3, 1e3, 300)  # m/s
figure, (left, right) = plt.subplots(
    1, 2, figsize=(6.4, 3.4), sharex=True, layout="constrained"
)
styles = {None: "-", 10e-3: "--", 5e-3: "-.", 2.5e-3: ":"}  # thickness in m
for thickness, style in styles.items():
    covered = roller.replace(material=replace(rubber, thickness=thickness))
    c = covered.contact(speed, delta=0.0, fields=("C_rr", "length"))
    name = "half-space" if thickness is None else f"{1e3 * thickness:g} mm"
    left.semilogx(speed, 100.0 * c.C_rr, style, label=name)
    right.semilogx(speed, 1e3 * c.length, style, label=name)
left.set(
    xlabel="speed, m/s",
    ylabel="rolling resistance $M/(PR)$, %",
    ylim=(0.0, None),
)
right.set(
    xlabel="speed, m/s", ylabel="contact length, mm", ylim=(0.0, None)
)
right.legend(frameon=False, title="cover", loc="lower left")

# %%
# Rubber is nearly incompressible, so its surface is stretched under the pressure.  Therefore a
# covered roller travels faster than ``omega R``.  ``delta_0`` is its creepage without
# creep force (Q = 0):
for thickness in (10e-3, 5e-3, 2.5e-3):
    covered = roller.replace(material=replace(rubber, thickness=thickness))
    c = covered.contact(1.0, delta=0.0)
    print(
        f"{1e3 * thickness:4g} mm: delta_0 = {100 * c.delta_0:.2f} %, "
        "delta_star = "
        f"{100 * c.delta_star:.2f} %"
    )
