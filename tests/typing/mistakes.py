"""A user's script with ten mistakes, one a line: mypy tells of each, else of what is ignored for
nothing.
"""

import numpy as np

import viscoroll as vr

scene = vr.Scene(alpha=11.0, kappa=2.91, mu=0.2, gamma=1.1e4)
x = np.linspace(-1.0, 1.0, 5)
vr.contakt(scene, 0.5, delta=0.01)  # type: ignore[attr-defined]  # wrong: a name
vr.roll("hello", 1.5, 0.5, 1e-3)  # type: ignore[arg-type]  # wrong: no scene
vr.contact(scene, "fast", delta=0.01)  # type: ignore[arg-type]  # wrong: no number
vr.contact(scene, x, delta=0.01, omega=x)  # type: ignore[call-overload]  # wrong: creep twice
vr.stress(scene, x, 0.5)  # type: ignore[call-overload]  # wrong: no creep
vr.ensemble(scene, x, 0.5, 1e-3, method="map")  # type: ignore[arg-type]  # wrong: no such method
vr.steady(scene, 0.01)  # type: ignore[call-arg]  # wrong: force or torque?
vr.presets.PAPER_CYLINDER.contact(0.5, 0.01)  # type: ignore[call-overload]  # wrong: creep or angular velocity?
vr.fit_prony(x, x)  # type: ignore[call-overload]  # wrong: one modulus alone
print(vr.law(scene)(0.3, 0.3).dQ_dV)  # type: ignore[attr-defined]  # wrong: slopes were not asked for
