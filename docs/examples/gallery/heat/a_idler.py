"""
A cold conveyor idler warms
===========================

A rubber idler starts at the temperature of its surroundings, and its losses warm it.  The figure
shows three ambient temperatures.  At -20 °C the rubber is stiff and dissipates little at first.
When it is warm enough, its losses rise, and it warms rapidly.  In the end the loss is equal to the
heat given off, and the temperature stays constant.
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
idler = vr.Cylinder(
    R=0.1,
    m=60.0,
    material=rubber,
    base=vr.Material.rigid(),
    mu=0.6,
    load=20e3,
)

ambient = np.array([-20.0, 0.0, 20.0])  # degrees Celsius
t = np.linspace(0.0, 9000.0, 181)
course = idler.warming(
    5.0, t, ambient=ambient, conductance=6.0, capacity=9e3
)

figure, panels = plt.subplots(
    1, 2, figsize=(6.4, 3.2), layout="constrained"
)
for n, start in enumerate(ambient):
    panels[0].plot(t / 60.0, course.temperature[n], label=f"{start:g} °C")
    panels[1].plot(t / 60.0, 100.0 * course.C_rr[n])
panels[0].set(xlabel="time, min", ylabel="temperature, °C")
panels[0].legend(title="ambient")
panels[1].set(xlabel="time, min", ylabel="$C_{rr}$, %")
