"""Contact states from which a flow map is made.

All quantities are dimensionless (docs/symbols.md); an argument of which no shape is stated is a number.
"""

import numpy as np

from ..compile.jit import kernel
from ..rows.evaluate import H_over_F2, length_and_moment, locate_row

#: row of delta_star in the array of states
DELTA_STAR = 0
#: row of M
MOMENT = 1
#: row of Q
TRACTION = 2
#: row of dQ/d delta
STIFFNESS = 3


@kernel
def states(V, delta, kappa, mu, law, out):
    """Evaluate critical creepage, moment and traction at states in partial slip, to which a flow map is fitted.

    V : speeds of the axis, > 0, (n,).
    delta : creepage, |delta| < delta_star, (n,).  From delta_star on Q is +-mu and its slope 0, nearly.
    kappa, mu : float, slenderness R/l0 and coefficient of friction, > 0.
    law : :class:`..rows.record.Law` of one material, without a cover.
    out : (4, n) floats, written: delta_star; M divided by P R; Q divided by P, with the sign of delta, 0 at delta = 0;
        dQ/d delta at fixed V.  Returns nothing.
    """
    for i in range(V.size):
        u = kappa * V[i]
        found = length_and_moment(locate_row(u, law), u, law)
        edge = 0.5 * mu / kappa * found.L
        w = found.L * max(1.0 - abs(delta[i]) / edge, 1e-300)
        v = 2.0 * u / w
        value, slope = H_over_F2(locate_row(v, law), v, law)
        out[DELTA_STAR, i], out[MOMENT, i] = edge, V[i] * found.scale * found.m
        out[TRACTION, i] = np.sign(delta[i]) * mu * (1.0 - w * w * value)
        out[STIFFNESS, i] = 4.0 * kappa * w * (value - 0.5 * v * slope)
