"""A user's script with ten mistakes, one a line: ``tests/test_typing.py``."""

import numpy as np

import viscoroll as vr

scene = vr.Scene(alpha=11.0, kappa=2.91, mu=0.2, gamma=1.1e4)
x = np.linspace(-1.0, 1.0, 5)
vr.contakt(scene, 0.5, delta=0.01)  # wrong: a name
vr.roll("hello", 1.5, 0.5, 1e-3)  # wrong: no scene
vr.contact(scene, "fast", delta=0.01)  # wrong: no number
vr.contact(scene, x, delta=0.01, omega=x)  # wrong: creep twice
vr.stress(scene, x, 0.5)  # wrong: no creep
vr.ensemble(scene, x, 0.5, 1e-3, method="map")  # wrong: no such method
vr.steady(scene, 0.01)  # wrong: force or torque?
vr.presets.PAPER_CYLINDER.contact(0.5, 0.01)  # wrong: creep or angular velocity?
vr.fit_prony(x, x)  # wrong: one modulus alone
print(vr.law(scene)(0.3, 0.3).dQ_dV)  # wrong: slopes were not asked for
