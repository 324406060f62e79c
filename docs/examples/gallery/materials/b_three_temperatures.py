"""
Rolling resistance at three temperatures
========================================

If the temperature changes, all relaxation times of a rubber are multiplied by one factor a_T (here
by the equation of Williams, Landel and Ferry).  The curve of rolling resistance over the logarithm
of the speed keeps its shape and is shifted: to lower speeds if it is colder, to higher speeds if it
is warmer.
"""

import matplotlib.pyplot as plt
import numpy as np

import viscoroll as vr

rubber = vr.Material(
    E=3e6,
    nu=0.5,
    prony=vr.Prony(
        E=[0.3, 0.5, 0.9, 1.6, 3.0], tau=[1e-1, 1e-2, 1e-3, 1e-4, 1e-5]
    ),
    name="rubber",
)
shift = vr.WLF(C1=8.86, C2=101.6, T0=20.0)
speed = np.geomspace(1e-3, 1e3, 300)  # m/s
figure, axes = plt.subplots(figsize=(6.4, 4.0), layout="constrained")
for temperature, style in ((-10.0, "--"), (20.0, "-"), (60.0, "-.")):
    roller = vr.Cylinder(
        R=0.05,
        m=9.0,
        material=rubber.at(temperature, shift=shift),
        mu=0.6,
        load=2000.0,
    )
    # N m per m of length
    M = roller.contact(speed, delta=0.0, fields="M").M
    C_rr = M / (roller.R * roller.load)
    axes.semilogx(speed, 100.0 * C_rr, style, label=f"{temperature:g} °C")
axes.set(
    xlabel="speed, m/s",
    ylabel="rolling resistance $M/(PR)$, %",
    ylim=(0.0, None),
)
axes.legend(frameon=False)
