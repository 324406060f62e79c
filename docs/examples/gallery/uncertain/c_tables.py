"""
The contact law as a table
==========================

For programs that only interpolate, the law is written into a netCDF file with units,
equations and the measured error of interpolation.  Here a table of one rubber roller, and
what linear look-up in it is worth.
"""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import viscoroll as vr

rubber = vr.Material(
    E=3e6, nu=0.5, prony=vr.Prony(E=[0.4, 0.6, 1.5], tau=[1e-1, 1e-3, 1e-5])
)
grid = vr.tables.MaterialGrid(
    rubber,
    kappa=20.0,
    mu=0.5,
    V=vr.tables.spread(1e-2, 1e4, 60, "log"),
    delta=np.linspace(-0.03, 0.03, 61),
)
vr.tables.save(vr.tables.build(grid), "rubber.nc")
table = vr.tables.load("rubber.nc")

V = np.geomspace(1e-2, 1e4, 400)
scene = vr.Scene(material=rubber.prony, kappa=20.0, mu=0.5)
looked_up = table.Q.interp(V=V, delta=0.0053)
exact = vr.contact(scene, V, delta=0.0053, fields="Q").Q

figure, (top, bottom) = plt.subplots(
    2, 1, figsize=(6.4, 5.0), sharex=True, layout="constrained"
)
top.semilogx(V, exact, label="law")
top.semilogx(V, looked_up, "--", label="linear in the table")
bottom.loglog(V, np.abs(looked_up - exact), color="0.3")
top.set(ylabel="Q, over load")
top.legend(frameon=False)
bottom.set(xlabel="V, in R/T_ref", ylabel="error of Q")
Path("rubber.nc").unlink()

# %%
# Tables are made for C, Modelica, MATLAB and others (:doc:`/loading/README`).  In Python
# ``vr.contact`` is exact and needs no file.
