"""
A rubber of many relaxation times
=================================

Real rubbers relax over many decades of time.  Each relaxation time far from the others
gives rolling resistance a hump of its own; many of them close together give a plateau.
"""

import matplotlib.pyplot as plt
import numpy as np

import viscoroll as vr


def broad(modes: int, decades: float) -> vr.Prony:
    """Ten times stiffer at once than at rest; equal modes, times even over decades."""
    return vr.Prony(np.full(modes, 10.0 / modes), np.logspace(0.0, -decades, modes))


materials = {
    "1 mode": vr.Prony([10.0], [1.0]),
    "2 modes, 5 decades": broad(2, 5.0),
    "5 modes, 5 decades": broad(5, 5.0),
    "10 modes, 10 decades": broad(10, 10.0),
}
V = np.logspace(-3.0, 9.0, 601)
figure, panels = plt.subplots(2, 2, figsize=(9.0, 6.4), sharex=True, layout="constrained")
for (name, material), style in zip(materials.items(), ("k-", "--", "-.", ":"), strict=True):
    c = vr.contact(vr.Scene(material=material, kappa=1.0, mu=1.0), V, delta=0.0)
    for axes, field in zip(panels.flat, ("lam", "epsilon", "delta_star", "M"), strict=True):
        axes.semilogx(V, getattr(c, field), style, label=name)
        axes.set(ylabel=field, ylim=(0.0, None))
for axes in panels[1]:
    axes.set(xlabel="kappa V", xlim=(V[0], V[-1]))
panels[0, 1].legend(frameon=False, fontsize="small")

# %%
# All four materials have the same modulus at rest and the same at once.  ``lam`` is the
# contact length, ``epsilon`` its shift ahead of the axis.
#
# The stresses of the broadest of them, ten relaxation times over ten decades, at four
# speeds and half the critical creep:
scene = vr.Scene(material=materials["10 modes, 10 decades"], kappa=1.0, mu=1.0)
stresses, (pressure, shear) = plt.subplots(1, 2, figsize=(9.0, 4.0), layout="constrained")
for speed, style in zip((1e-2, 1.0, 1e3, 1e7), ("k-", "--", "-.", ":"), strict=True):
    c = vr.contact(scene, speed, delta=0.0)
    x = 0.5 * c.lam * (c.epsilon - np.cos(np.linspace(0.0, np.pi, 801)))
    s = vr.stress(scene, x, speed, delta=0.5 * c.delta_star)
    for axes, values in ((pressure, s.p), (shear, s.tau)):
        axes.plot(x, 8.0 * np.pi * values, style, label=f"kappa V = {speed:g}")
pressure.set(xlabel="x / l0", ylabel="p over that of the middle at rest", ylim=(0.0, None))
shear.set(xlabel="x / l0", ylabel="tau over mu times the same", ylim=(0.0, None))
pressure.legend(frameon=False, fontsize="small")
