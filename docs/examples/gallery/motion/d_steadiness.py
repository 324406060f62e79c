"""
Validity of the quasi-steady assumption
=======================================

``roll`` uses the rolling resistance moment M(V) of steady rolling at each instant.  If the speed V
changes slowly, the moment is in fact M(V) + N(V) V', with V' = dV/dt.  The term N V' acts as an
added mass.  Its ratio to the inertia of the cylinder, the unsteadiness gamma N/(1 + j), is about
the relative error of V (gamma and j: :doc:`/validity`).  The unsteadiness is large
at low speeds.  It hardly depends on the longest relaxation time.
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
bound = (
    0.084
    * (1.0 - 1.0 / scene.alpha)
    * roller.g
    * roller.l0**2
    / (roller.R * 1.5)
)

figure, (left, right) = plt.subplots(
    1, 2, figsize=(6.4, 3.4), layout="constrained"
)
(line,) = left.loglog(
    V, abs(unsteady), label=f"longest time {rubber.T_ref:.0f} s"
)
cold = roller.replace(material=rubber.at(0.0, lambda temperature: 1e3))
colder = cold.validity(V).steady
slow = cold.T_ref * cold.scene().material.tau[0]
left.loglog(V, colder.value, "--", label=f"longest time {slow:.0f} s")
left.loglog(
    V, bound / V**2, color="0.5", linestyle=":", label="upper bound"
)
for reach, height in (
    (roller.validity(1.0).steady.ten_percent, 0.1),
    (roller.validity(1.0).steady.one_percent, 0.01),
):
    left.plot(reach.speed, height, "o", color=line.get_color())
left.set(xlabel="speed, m/s", ylabel="unsteadiness", ylim=(1e-6, 1e3))
left.legend(frameon=False, fontsize="small")

# right: gamma M dt = -(1 + j + gamma N) dV from 1 m/s on, without N and with it
start = np.searchsorted(V, 1.0)
for inertia, style, name in (
    (0.0, "-", "quasi-steady law"),
    (1.0, "k--", "with the correction N"),
):
    rate = (
        (1.0 + inertia * unsteady) * (1.0 + scene.j) / (scene.gamma * c.M)
    )
    t = cumulative_trapezoid(
        rate[:start], V[:start] / roller.scale["V"], initial=0.0
    )
    fast = V[:start] > roller.validity(1.0).steady.ten_percent.speed
    right.semilogy(
        (t[-1] - t)[fast] * roller.scale["t"],
        V[:start][fast],
        style,
        label=name,
    )
right.set(
    xlabel="$t$, s", ylabel="speed, m/s", title="free rolling from 1 m/s"
)
right.legend(frameon=False)
print(roller.validity(1.0).steady.sentence)
print(cold.validity(1.0).steady.sentence)

# %%
# Left: the dots mark the speeds at which the error of V reaches 1 % and 10 %.  For a rubber with
# relaxation times a thousand times longer they are the same.  Right: free rolling from 1 m/s,
# computed without N and with it, down to the speed at which the error is 10 %; the two curves
# nearly coincide. For lower speeds see :doc:`/validity_low_speed`.
