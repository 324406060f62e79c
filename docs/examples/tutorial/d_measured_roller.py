"""
4. Parameters from a drum test and a coast-down
===============================================

There are no DMA data of this rubber.  A drum test of a roller gave the rolling resistance moment M
at several speeds V.  In a coast-down test the roller was launched at some 4 m/s without rotation,
and V was measured over the time t.  In both tests the friction of the bearing acts too.
``identify`` estimates modulus, relaxation time, coefficient of friction and friction of the
bearing.
"""

import matplotlib.pyplot as plt
import numpy as np

import viscoroll as vr

# m/s, N m/m
V, M = np.loadtxt(vr.datasets.path("drum.csv"), delimiter=",", skiprows=1).T
# s, m/s
t, speed = np.loadtxt(
    vr.datasets.path("launch.csv"), delimiter=",", skiprows=1
).T
data = [
    vr.Resistance(V, M, sigma=0.01, name="drum"),
    vr.Coastdown(t, speed, omega0=0.0, sigma=5e-3, name="coast-down"),
]

# %%
# ``guess`` is the cylinder with its known parameters (radius and mass), and with a guess of the
# unknown ones, from which the search starts.  The rubber has one relaxation time.  ``of_rubber``
# names the unknown parameters and the ranges in which they are searched: the coefficient of
# friction mu, the long-time modulus E (Pa), the part E_1 of the modulus that relaxes, divided by E,
# and the relaxation time T_ref (s).
rubber = vr.Material(
    E=2e6, nu=0.49, prony=vr.Prony([5.0], [1.0]), T_ref=2e-3
)
guess = vr.Cylinder(R=0.1, m=35.5, material=rubber, mu=0.4)
of_rubber = {
    "mu": (0.1, 1.0),
    "E": (3e5, 3e7),
    "E_1": (0.9, 90.0),
    "T_ref": (1e-4, 1e-2),
}

# %%
# First a fit without the bearing.  Read its report from the top.
wrong = vr.identify(guess, of_rubber, data, starts=1)
print(wrong)

# %%
# The residuals (measured minus fitted values) are much larger than the standard deviation of the
# measurements, and neighbouring ones are similar (autocorrelated).  So the model does not describe
# the tests, and the values in the report are meaningless.  The second fit includes the bearing: a
# constant torque (``brake``) and a torque in proportion to the angular velocity (``drag``):
bearing = {"brake": (0.0, 0.5), "drag": (0.0, 0.05)}
fit = vr.identify(guess, of_rubber | bearing, data, starts=2)
print(fit)

# %%
# Now the residuals are as random measurement errors are.  The true values are known, since the data
# of this example were computed: mu = 0.3, E = 3 MPa, E_1 = 9, T_ref = 1 ms, brake = 0.05 N m/m and
# drag = 0.003 N m s/m.  The estimates of E, E_1 and T_ref are correlated (0.99): errors of one are
# compensated by errors of the others.
fit.plot()

# %%
# The figure shows the moment over the speed: as measured, by the second fit (with its 95 %
# confidence band), the part of the rubber alone in this fit, and by the first fit, which left out
# the bearing.
fine = np.geomspace(0.01, 30.0, 200)
figure, axes = plt.subplots(figsize=(6.4, 3.8), layout="constrained")
axes.semilogx(V, M, "k.", markersize=4, label="measured, with bearing")
bare = fit.cylinder.contact(fine, delta=0.0, fields="M").M
with_bearing = fit.predict(vr.Resistance(fine)).M
axes.fill_between(
    fine,
    with_bearing.low,
    with_bearing.high,
    color="0.8",
    label="95 % band",
)
axes.semilogx(fine, with_bearing.value, "C0", label="fit")
axes.semilogx(fine, bare, "C0--", label="fit, without bearing")
axes.semilogx(
    fine,
    wrong.predict(vr.Resistance(fine)).M.value,
    "C1:",
    label="model without bearing",
)
axes.set(xlabel="speed, m/s", ylabel="moment, N m/m", ylim=(0.0, 1.3))
axes.legend(frameon=False)

# %%
# The fit predicts the distance that the roller rolls in 30 s from 2 m/s, with its bearing, and the
# confidence interval of this distance.
later = np.linspace(0.0, 30.0, 61)
distance = fit.predict(vr.Coastdown(later, V0=2.0)).x
low, high = distance.low[-1], distance.high[-1]
print(f"{distance.value[-1]:.2f} m, 95 %: {low:.2f} to {high:.2f}")

# %%
# Which parameters would a coast-down test alone determine?  A record without measured values is a
# planned test:
plan = vr.identify(
    fit.cylinder,
    of_rubber,
    [vr.Coastdown(later, V0=2.0, sigma={"V": 5e-3}, name="coast-down")],
)
print(plan)

# %%
# A coast-down alone would not determine the coefficient of friction, and the other parameters only
# poorly.  :doc:`/identify_design` compares experiments.
