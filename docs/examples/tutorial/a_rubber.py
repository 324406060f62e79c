"""
1. From a measured rubber to rolling resistance
===============================================

A rubber was measured in a dynamic test (DMA): storage and loss modulus at 25 frequencies
from 0.01 to 100 Hz.  The file has three columns, and its heading names their units.
"""

import matplotlib.pyplot as plt
import numpy as np

import viscoroll as vr

# a sample file that is installed with the package
data = vr.datasets.path("dma.csv")
print("\n".join(data.read_text().splitlines()[:5]))
omega, storage, loss = vr.read_dma(data)  # rad/s, Pa, Pa

# %%
# The rubber is described by a Prony series, that is relaxation times and strengths.  ``fit_prony``
# fits the series to the data.  It takes the fewest relaxation times for which the misfit (the
# relative error of the moduli, root mean square) is at most 1 %.
fit = vr.fit_prony(omega, storage, loss, source="dma.csv")
print(fit)

# %%
# Read the report first.  The misfit is below its limit.  The loss modulus agrees with the value
# that follows from the slope of the storage modulus (Kramers-Kronig relation), so the two curves
# are consistent.  "Accuracy" says how far the data determine the rolling resistance M: other
# relaxation times and strengths that fit the data as well give an M that differs by 2 % at most,
# at speeds that the data cover.
fine = np.geomspace(omega[0], omega[-1], 300)
figure, axes = plt.subplots(figsize=(6.4, 3.8), layout="constrained")
axes.loglog(omega, storage, "C0o", omega, loss, "C1s", markersize=4)
for fitted, name, color in zip(
    fit.modulus(fine), ("storage", "loss"), ("C0", "C1"), strict=True
):
    axes.loglog(fine, fitted, color=color, label=name)
axes.set(xlabel="angular frequency, rad/s", ylabel="modulus, Pa")
axes.legend(frameon=False)

# %%
# The roller is of solid steel, 20 cm in diameter, and rolls on this rubber.  All quantities are in
# SI units; mass and load are per metre of length.
rubber = fit.material(nu=0.49, name="rubber", density=1100.0)
steel = vr.Material.elastic(E=2.1e11, nu=0.3, density=7850.0)
roller = vr.Cylinder(R=0.1, m=247.0, material=steel, base=rubber, mu=0.5)
print(f"contact length at rest: {1e3 * roller.l0:.1f} mm")

# %%
# The next figure shows the rolling resistance over speed, at three temperatures.  A change of
# temperature multiplies all relaxation times by one shift factor, here by the equation of Williams,
# Landel and Ferry.
#
# A point of the surface passes through the contact in the transit time, the contact length divided
# by the speed.  Let f be the inverse of this time, in 1/s.  The data must contain the frequencies
# from f to 3 f, in rad/s.  At other speeds the moduli are extrapolated: ``contact`` warns,
# ``validity`` reports it, and the curves in the figure are dotted.
shift = vr.WLF(C1=8.86, C2=101.6, T0=20.0)
speed = np.geomspace(1e-4, 1e3, 300)  # m/s
figure_2, axes = plt.subplots(figsize=(6.4, 3.8), layout="constrained")
for temperature, style in ((20.0, "-"), (40.0, "--"), (60.0, "-.")):
    warm = roller.replace(base=rubber.at(temperature, shift=shift))
    share = warm.contact(speed, delta=0.0, fields="C_rr").C_rr  # M/(P R)
    inside = warm.validity(speed).measured.holds
    name, band = f"{temperature:g} °C", speed[inside]
    (line,) = axes.semilogx(speed, 100.0 * share, ":")
    color = line.get_color()
    axes.semilogx(
        band, 100.0 * share[inside], style, color=color, label=name
    )
    print(f"{name}: measured from {band[0]:.1g} to {band[-1]:.1g} m/s")
axes.set(
    xlabel="speed, m/s",
    ylabel="rolling resistance, % of the load",
    ylim=(0.0, None),
)
axes.legend(frameon=False)

# %%
# Each small maximum belongs to one relaxation time of the series.  The real rubber has very many
# relaxation times, close together, so its curve is smooth.  Here the rubber is a half-space.  For a
# rubber layer of finite thickness give ``fit.material(thickness=...)``: :doc:`/howto/covers`.
