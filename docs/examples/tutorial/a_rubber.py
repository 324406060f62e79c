"""
1. From a measured rubber to rolling resistance
===============================================

A rubber was measured in a dynamic test (DMA): storage and loss modulus at 25 frequencies
from 0.01 to 100 Hz.  The file has three columns, and its heading names their units.
"""

import matplotlib.pyplot as plt
import numpy as np

import viscoroll as vr

data = vr.datasets.path("dma.csv")  # a sample file that is installed with the package
print("\n".join(data.read_text().splitlines()[:5]))
omega, storage, loss = vr.read_dma(data)  # rad/s, Pa, Pa

# %%
# The contact law wants relaxation times and strengths, a Prony series.  ``fit_prony``
# takes as few of them as the data need, here to 1 %.
fit = vr.fit_prony(omega, storage, loss, source="dma.csv")
print(fit)

# %%
# Read the report before you go on.  The misfit was reached.  The loss modulus fits the
# slope of the storage modulus, so the two curves belong to one material.  And modes
# outside the measured frequencies would move rolling resistance by 2 % at most, at speeds
# that the data cover.
fine = np.geomspace(omega[0], omega[-1], 300)
figure, axes = plt.subplots(figsize=(6.4, 3.8), layout="constrained")
axes.loglog(omega, storage, "C0o", omega, loss, "C1o", markersize=4)
for fitted, name, color in zip(
    fit.modulus(fine), ("storage", "loss"), ("C0", "C1"), strict=True
):
    axes.loglog(fine, fitted, color=color, label=name)
axes.set(xlabel="frequency, rad/s", ylabel="modulus, Pa")
axes.legend(frameon=False)

# %%
# Now the roller: solid steel, 20 cm thick, on this rubber.  All in SI units; mass and load
# count per metre of length.
rubber = fit.material(nu=0.49, name="rubber", density=1100.0)
steel = vr.Material.elastic(E=2.1e11, nu=0.3, density=7850.0)
roller = vr.Cylinder(R=0.1, m=247.0, material=steel, base=rubber, mu=0.5)
print(f"contact length at rest: {1e3 * roller.l0:.1f} mm")

# %%
# Rolling resistance over speed, at three temperatures.  Temperature multiplies all
# relaxation times by one factor; here it is that of Williams, Landel and Ferry, which such
# a test gives too.
#
# Which part of a curve rests on data?  The rubber feels a roller pass in the time that
# contact length and speed make, and the inverse of that has to lie among the measured
# frequencies.  The material keeps these, ``contact`` warns beyond them, and ``validity``
# says where: dotted here.
shift = vr.WLF(C1=8.86, C2=101.6, T0=20.0)
speed = np.geomspace(1e-4, 1e3, 300)  # m/s
figure_2, axes = plt.subplots(figsize=(6.4, 3.8), layout="constrained")
for temperature in (20.0, 40.0, 60.0):
    warm = roller.replace(base=rubber.at(temperature, shift=shift))
    share = warm.contact(speed, delta=0.0, fields="C_rr").C_rr  # M/(P R)
    held = warm.validity(speed).measured.holds
    name, seen = f"{temperature:g} °C", speed[held]
    (line,) = axes.semilogx(speed, 100.0 * share, ":")
    axes.semilogx(seen, 100.0 * share[held], color=line.get_color(), label=name)
    print(f"{name}: measured for {seen[0]:.1g} to {seen[-1]:.1g} m/s")
axes.set(xlabel="speed, m/s", ylabel="rolling resistance, % of the load", ylim=(0.0, None))
axes.legend(frameon=False)

# %%
# The bumps are the four relaxation times of the fit; the measured rubber has a smooth
# curve through them.  A layer of rubber has a thickness, too: ``fit.material(thickness=...)``
# lets ``validity`` compare it with the contact.
