"""
From which speed on?
====================

The law of steady rolling knows the speed, not its past.  Where the speed changes slowly,
the next term is known too: M = M(V) + N(V) V'.  N acts like an added mass, and its share
at the speed itself, gamma N/(1 + j), is about the error of V.  Slow relaxation times do not
make it large: low speeds do.
"""

import matplotlib.pyplot as plt
import numpy as np
from scipy.integrate import cumulative_trapezoid

import viscoroll as vr

rubber = vr.fit_prony(vr.read_dma(vr.datasets.path("dma.csv"))).material(
    nu=0.49, density=1100.0
)
roller = vr.Cylinder(R=0.1, m=35.5, material=rubber, mu=0.5)
scene, V = roller.scene(), np.geomspace(1e-4, 10.0, 4000)  # m/s
c = vr.contact(scene, V / roller.scale["V"], delta=0.0, fields=("M", "N"))
unsteady = scene.gamma * c.N / (1.0 + scene.j)
bound = 0.084 * (1.0 - 1.0 / scene.alpha) * roller.g * roller.l0**2 / (roller.R * 1.5)

figure, (left, right) = plt.subplots(1, 2, figsize=(9.0, 3.8), layout="constrained")
(line,) = left.loglog(V, abs(unsteady), label=f"slowest time {rubber.T_ref:.2g} s")
cold = roller.replace(material=rubber.at(0.0, lambda temperature: 1e3))
colder = cold.validity(V).steady
left.loglog(V, colder.value, label=f"{cold.T_ref * cold.scene().material.tau[0]:.2g} s")
left.loglog(V, bound / V**2, "0.6", linewidth=0.8, label="bound of all rubbers")
for reach, height in ((roller.validity(1.0).steady.ten_percent, 0.1),
                      (roller.validity(1.0).steady.one_percent, 0.01)):  # fmt: skip
    left.plot(reach.speed, height, "o", color=line.get_color())
left.set(xlabel="speed, m/s", ylabel="unsteadiness", ylim=(1e-6, 1e3))
left.legend(frameon=False, fontsize="small")

# right: gamma M dt = -(1 + j + gamma N) dV from 1 m/s on, without N and with it
start = np.searchsorted(V, 1.0)
for inertia, style in ((0.0, "-"), (1.0, ":")):
    rate = (1.0 + inertia * unsteady) * (1.0 + scene.j) / (scene.gamma * c.M)
    t = cumulative_trapezoid(rate[:start], V[:start] / roller.scale["V"], initial=0.0)
    fast = V[:start] > roller.validity(1.0).steady.ten_percent.speed
    right.semilogy(
        (t[-1] - t)[fast] * roller.scale["t"], V[:start][fast], style, color="C0"
    )
right.set(xlabel="t, s", ylabel="speed, m/s", title="rolling from 1 m/s; dotted: with N")
print(roller.validity(1.0).steady.sentence)
print(cold.validity(1.0).steady.sentence)

# %%
# Left: the dots are where the error of V reaches 1 % and 10 %.  Right: what N does to rolling from
# 1 m/s down to the speed where the error of V reaches 10 %; it ends soon after.  A thousand
# times slower rubber is as right.  What is known of lower speeds: :doc:`/validity`.
