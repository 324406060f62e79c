"""
From a DMA curve to a Prony series
==================================

A dynamic mechanical analysis (DMA) measures storage and loss modulus over frequency.
``fit_prony`` fits a Prony series to the data, with the fewest relaxation times for which the misfit
is at most 1 %.  Its report also says what the data do not determine.
"""

import matplotlib.pyplot as plt
import numpy as np

import viscoroll as vr

tau = np.logspace(2, -7, 19)  # a synthetic rubber in place of a measurement
strength = 2e6 * np.logspace(-2, 2, 19)
omega = np.logspace(-3, 7, 51)  # rad/s
z = np.multiply.outer(omega, tau)
noise = 1.0 + 0.005 * np.random.default_rng(1).standard_normal(
    (2, omega.size)
)
storage = (2e6 + (z**2 / (1.0 + z**2)) @ strength) * noise[0]  # Pa
loss = (z / (1.0 + z**2)) @ strength * noise[1]

fit = vr.fit_prony(omega, storage, loss)
print(fit)

# %%
fine = np.geomspace(omega[0], omega[-1], 400)
figure, axes = plt.subplots(figsize=(6.4, 4.2), layout="constrained")
axes.loglog(
    omega, storage, "o", color="C0", markersize=3, label="storage modulus"
)
axes.loglog(
    omega, loss, "s", color="C1", markersize=3, label="loss modulus"
)
for values, color in zip(fit.modulus(fine), ("C0", "C1"), strict=True):
    axes.loglog(fine, values, color=color)
axes.set(
    xlabel="angular frequency, rad/s",
    ylabel="modulus, Pa",
    title=f"{fit.prony.E.size} relaxation times",
)
axes.legend(frameon=False)
