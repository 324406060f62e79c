"""
Terminal speeds on a slope
==========================

A slope pulls with sin(slope) of the weight.  The roller settles where rolling resistance
is as large.  Behind each hump there is a second speed of balance, which is unstable: from
there the roller either falls back or runs away.
"""

import numpy as np

import viscoroll as vr
from viscoroll.figures import rolling_equilibria

figure = rolling_equilibria()

# %%
# For one roller, in SI units:
s = vr.RUBBER_CYLINDER.steady(slope=np.radians(0.3))
for V, stable in zip(s.V, s.stable, strict=True):
    print(f"{V:10.3g} m/s, {'stable' if stable else 'unstable'}")
