"""
4. A roller from a drum test and a throw
========================================

Nobody has a DMA of this rubber.  A roller of it was run on a drum of the same rubber, which
gave the moment M over V, and thrown without spin at some 4 m/s, which gave V over t.  Both
hold the friction of its bearing.  What are modulus, relaxation, friction and bearing?
"""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import viscoroll as vr

examples = Path("..")  # docs/examples of the source tree
V, M = np.loadtxt(examples / "drum.csv", delimiter=",", skiprows=1).T  # m/s, N m/m
t, speed = np.loadtxt(examples / "throw.csv", delimiter=",", skiprows=1).T  # s, m/s
data = [
    vr.Resistance(V, M, sigma=0.01, name="drum"),
    vr.Coastdown(t, speed, omega0=0.0, sigma=5e-3, name="throw"),
]

# %%
# What is known, and a guess of the rest: one relaxation time.  ``unknown`` names what to
# find and the range of each.
rubber = vr.Material(E=2e6, nu=0.49, prony=vr.Prony([5.0], [1.0]), T_ref=2e-3)
guess = vr.Cylinder(R=0.1, m=35.5, material=rubber, mu=0.4)
of_rubber = {"mu": (0.1, 1.0), "E": (3e5, 3e7), "E_1": (0.9, 90.0), "T_ref": (1e-4, 1e-2)}

# %%
# First without the bearing.  Read the report from its top.
wrong = vr.identify(guess, of_rubber, data, starts=1)
print(wrong)

# %%
# The residuals are no noise: neighbours lie on the same side, and they are many standard
# deviations large.  So the model misses something, and the values below mean nothing, how
# narrow their intervals may be.  With the bearing, a constant torque and a drag:
bearing = {"brake": (0.0, 0.5), "drag": (0.0, 0.05)}
fit = vr.identify(guess, of_rubber | bearing, data, starts=2)
print(fit)

# %%
# Now they are noise.  The data were computed with mu = 0.3, E = 3 MPa, E_1 = 9,
# T_ref = 1 ms, brake = 0.05 N m/m and drag = 0.003 N m s/m, so here one can look.
# The standard deviations of E, E_1 and T_ref go together: correlations of 0.99.
fit.plot()

# %%
# What the fit says of rolling resistance without the bearing, which nobody has measured,
# with its band; and that of the wrong model.
fine = np.geomspace(0.01, 30.0, 200)
figure, axes = plt.subplots(figsize=(6.4, 3.8), layout="constrained")
axes.semilogx(V, M, "k.", markersize=4, label="measured, with bearing")
bare = fit.cylinder.contact(fine, delta=0.0, fields="M").M
with_bearing = fit.predict(vr.Resistance(fine)).M
axes.fill_between(fine, with_bearing.low, with_bearing.high, color="0.8", label="95 % band")
axes.semilogx(fine, with_bearing.value, "C0", label="fit")
axes.semilogx(fine, bare, "C0--", label="fit, rubber alone")
axes.semilogx(fine, wrong.predict(vr.Resistance(fine)).M.value, "C1:", label="wrong model")
axes.set(xlabel="speed, m/s", ylabel="moment, N m/m", ylim=(0.0, 1.3))
axes.legend(frameon=False)

# %%
# ``fit.cylinder`` rolls on.  How far does it roll from 2 m/s, and how well is that known?
# The bearing is part of the prediction.
later = np.linspace(0.0, 30.0, 61)
way = fit.predict(vr.Coastdown(later, V0=2.0)).x
print(f"{way.value[-1]:.2f} m, 95 %: {way.low[-1]:.2f} to {way.high[-1]:.2f}")

# %%
# What would a coast-down alone have told?  A record without values is a plan.
plan = vr.identify(
    fit.cylinder,
    of_rubber,
    [vr.Coastdown(later, V0=2.0, sigma={"V": 5e-3}, name="coast-down")],
)
print(plan)

# %%
# Nothing of friction, and little of the rest: :doc:`/identify` has a table of what each
# experiment tells, and what to measure.
