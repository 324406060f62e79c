"""
A roller with two temperatures
==============================

In the cold this rubber is stiff: the roller has little loss and stays cold.  When it is warm, it
has a large loss and stays warm.  So there are speeds at which the same roller may run at a low or
at a high temperature; between these two temperatures lies a third one, which is unstable.  If the
speed rises slowly, the cold roller suddenly becomes warm at a certain speed.  If the speed then
falls, the roller becomes cold again only at a lower speed (hysteresis).
"""

import matplotlib.pyplot as plt
import numpy as np

import viscoroll as vr

rubber = vr.Material(
    E=3e6,
    nu=0.49,
    prony=vr.Prony(E=[2.0, 40.0, 60.0, 100.0], tau=[1.0, 1e-2, 1e-4, 1e-6]),
    T_ref=0.02,
    temperature=20.0,
    shift=vr.WLF(C1=8.86, C2=101.6, T0=0.0),
)
roller = vr.Cylinder(
    R=0.1,
    m=60.0,
    material=rubber,
    base=vr.Material.rigid(),
    mu=0.6,
    load=20e3,
)

V = np.geomspace(0.02, 10.0, 400)  # m/s
found = roller.temperature(V, ambient=-20.0, conductance=6.0)
ends = roller.turning_points(ambient=-20.0, conductance=6.0)

figure, axes = plt.subplots(figsize=(6.4, 3.6), layout="constrained")
speed = np.broadcast_to(V[:, np.newaxis], found.temperature.shape)
for stable, style, label in (
    (True, "C0.", "stable"),
    (False, "C1.", "unstable"),
):
    shown = found.stable == stable
    axes.semilogx(
        speed[shown],
        found.temperature[shown],
        style,
        markersize=2.0,
        label=label,
    )
axes.plot(ends.V, ends.temperature, "ko", label="a branch ends")
axes.set(xlabel="speed, m/s", ylabel="temperature, °C")
axes.legend()
