"""
The load-speed curve of a wheel
===============================

A wheel has a cover of polyurethane, 15 mm thick and 40 mm wide.  The mean temperature of the cover
must not exceed 70 °C.  The curves show the highest allowed speed at each load, for three ambient
temperatures.  The wheel starts at the ambient temperature, and its losses warm it.  Manufacturers
of wheels state such a curve, or one point of the curve.
"""

import matplotlib.pyplot as plt
import numpy as np

import viscoroll as vr

WIDTH = 0.04  # m
polyurethane = vr.Material(
    E=25e6,
    nu=0.49,
    prony=vr.Prony(E=[0.08, 0.12, 0.25, 0.8], tau=[1.0, 3e-2, 1e-3, 3e-5]),
    thickness=0.015,
    temperature=20.0,
    shift=vr.WLF(C1=8.86, C2=101.6, T0=0.0),
)
wheel = vr.Cylinder(
    R=0.1,
    m=30.0,
    material=polyurethane,
    base=vr.Material.rigid(),
    mu=0.5,
    load=1500.0 / WIDTH,
)
conductance = vr.conductance(
    R=0.1, film=20.0, thickness=0.015, conductivity=0.22
)

load = np.linspace(500.0, 3000.0, 6)  # N
ambient = np.array([[10.0], [20.0], [35.0]])  # degrees Celsius
limit = wheel.heat_limit(
    70.0, load=load / WIDTH, ambient=ambient, conductance=conductance
)

figure, axes = plt.subplots(figsize=(6.4, 3.6), layout="constrained")
for at, V in zip(ambient.ravel(), limit.V, strict=True):
    axes.plot(V, load, "o-", label=f"{at:g} °C")
axes.set(
    xlabel="speed, m/s",
    ylabel="load, N",
    xlim=(0.0, None),
    ylim=(0.0, None),
)
axes.legend(title="ambient")
