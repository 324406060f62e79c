"""A user's script without a mistake: mypy finds none (`make check`)."""

import numpy as np
import xarray as xr

import viscoroll as vr

scene = vr.Scene(alpha=11.0, kappa=2.91, mu=0.2, gamma=1.1e4)
V = np.geomspace(1e-3, 2.0, 20)
print(vr.contact(scene, 0.5, omega=[0.4, 0.5], slopes=True).M)
print(vr.contact(scene, xr.DataArray(V), delta=0, fields="Q", method="direct").Q)
print(vr.stress(scene, x=[[0.1], [0.2]], V=np.float32(0.3), delta=np.arange(3)).p)
motion = vr.roll(scene, 1.5, 0.5, V, force=0.01, torque=vr.Schedule([0.0, 1e-3], [0.0, 0.1]))
print(motion.onset_time, motion.V[-1], motion.contact().beta)
gains = vr.Feedback(0.01, V=-0.1)
vr.ensemble(scene, V, 0.0, 1e-3, force=V, torque=gains, brake=abs, fields=("V",))
law = vr.law(scene)
print(law(0.3, 0.3).Q + 1.0, law(V, V, slopes=True).dQ_dV.shape, law.jitted(0.3, 0.3).dQ_domega)
fit = vr.fit_prony(V, V + 1.0, V, modes=3)
print(law.address, vr.tables.load, vr.Scene(material=fit.prony, kappa=20.0, mu=0.3))
try:
    vr.contact(scene, np.nan, delta=0.1)
except vr.ParameterError as error:
    print(error.name)
