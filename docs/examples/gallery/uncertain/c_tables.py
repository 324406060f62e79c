"""
The law in C, Octave and on grids
=================================

Programs in other languages can evaluate the contact law from a file.  Here this file is a header
for C, and a netCDF file for Octave.  Both give the same results as viscoroll, to rounding.  For
programs that can only interpolate in tables there is a grid, which is less accurate.
"""

import shutil
import subprocess
import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import viscoroll as vr

rubber = vr.Prony(E=[0.4, 0.6, 1.5], tau=[1e-1, 1e-3, 1e-5])
law, folder = vr.tables.law(rubber), Path(tempfile.mkdtemp())
scene = vr.Scene(material=rubber, kappa=20.0, mu=0.5)
exact = vr.contact(scene, 3.0, omega=3.01, slopes=True)
print(f"{exact.Q:.15f} {exact.M:.15f} {exact.dQ_dV:.12f}")

# %%
# In C: the header ``rubber.h`` contains the law of the rubber and the functions to evaluate it.
vr.tables.export(law, folder / "rubber.h")
(folder / "state.c").write_text(
    """
#include <stdio.h>
#include "rubber.h"
int main(void) {
  vr_state s;
  vr_slopes d;
  vr_contact_slopes(&rubber, 20.0, 0.5, 3.0, 3.01 - 3.0, &s, &d);
  printf("%.15f %.15f %.12f\\n", s.Q, s.M, d.dQ_dV);
  return 0;
}
"""
)
for command in (
    ["cc", "-std=c99", "-O2", "state.c", "-o", "state", "-lm"],
    ["./state"],
):
    result = subprocess.run(
        command, cwd=folder, capture_output=True, text=True, check=True
    )
print(result.stdout)

# %%
# In Octave, by ``read_law.m`` (:doc:`/loading/README`).
vr.tables.save(law, folder / "rubber.nc")
here = Path.cwd().resolve()
root = next(
    path
    for path in (here, *here.parents)
    if (path / "docs/loading").exists()
)
shutil.copy(root / "docs/loading/read_law.m", folder)
code = (
    "s = read_law('rubber.nc')(20, 0.5, 3, 3.01 - 3); "
    "printf('%.15f %.15f', s.Q, s.M)"
)
if shutil.which("octave-cli"):
    result = subprocess.run(
        ["octave-cli", "--eval", code],
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
    )
    print(result.stdout)

# %%
# A grid is a table of the creep force over speed and creepage.  The figure shows the error of
# linear interpolation in it.
V = vr.tables.spread(1e-2, 1e4, 60, "log")
grid = vr.tables.build(scene, V, delta=np.linspace(-0.03, 0.03, 61))
speeds = np.geomspace(1e-2, 1e4, 400)
looked_up = grid.Q.interp(V=speeds, delta=0.0053)
truth = vr.contact(scene, speeds, delta=0.0053, fields="Q").Q

figure, (top, bottom) = plt.subplots(
    2, 1, figsize=(6.4, 5.0), sharex=True, layout="constrained"
)
top.semilogx(speeds, truth, label="law")
top.semilogx(
    speeds, looked_up, "--", label="linear interpolation in the grid"
)
bottom.loglog(speeds, np.abs(looked_up - truth), color="0.3")
top.set(ylabel="$Q/P$")
top.legend(frameon=False)
bottom.set(xlabel=r"$V\,T_\mathrm{ref}/R$", ylabel="error of $Q/P$")
shutil.rmtree(folder)
