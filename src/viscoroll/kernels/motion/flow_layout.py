"""The layout of a flow map and of its outputs, and the contact states from which it is made.

A flow map (docs/internals_motion.md, Flow map) consists of polynomials of 24 powers, one for each
octave of their variable, as in the rows of the law.  All tables form one vector; pairs of functions
are interleaved (:mod:`.simd`).  Motions are mirrored so that omega > V in full slip and V > 0 in
partial slip.  Times are tau = gamma t.

All quantities are dimensionless (docs/symbols.md); an argument of which no shape is stated is a
number.
"""

from math import prod
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..law.law_functions import H_over_F2, length_and_moment, locate_row
from ..numerics.jit import inline_kernel, kernel
from ..numerics.simd import TERMS
from ..records import AT_REST, Output

# --- Layout of a flow map ---

#: binary exponent of the lowest kappa V in the tables: below it the law equals its limit V -> 0 to
#: 2e-11
LOW = -36
#: binary exponent of the highest kappa V in the tables
HIGH = 16
#: bins of the slow logarithm below 0
SLOW_BINS = 9
#: width of such a bin
SLOW_WIDTH = 3.0
#: octaves of 1 + slow logarithm, from 1 on
SLOW_OCTAVES = 40
#: octaves of kappa V at stick onset, down from the highest
OCTAVES = 20
#: highest octave of kappa V at onset that the tables of full slip and of the slow manifold allow
#: for
OCTAVE_RANGE = LOW + OCTAVES, HIGH - 2
#: powers of a layer in its two variables, in kappa V at onset and in u
LAYER_TERMS = 12
#: binary exponent of the lowest layer coordinate u; u < 1 before the split
LAYER_LOW = -6
#: binary exponent of the highest layer coordinate u; u >= 1 after the split
LAYER_HIGH = 5
#: E beyond which the boundary layer has decayed to e^-E
LAYER_END = 28.0
#: coefficients of one polynomial of the layer
BLOCK = LAYER_TERMS * LAYER_TERMS
#: column of the layer: ln(V/V0), V0 the speed at onset
LAYER_LN_V = 0
#: column of the layer: creepage delta
LAYER_CREEP = 1
#: column of the layer: distance beyond that at constant speed V0, in units of V0/k0
LAYER_X = 2
#: column of the layer: angle beyond that at constant speed V0, in units of V0/k0
LAYER_ANGLE = 3
#: column of the layer: slip loss, in units of V0^2
LAYER_LOSS = 4
#: family of motions with omega > V at the onset of partial slip
PLUS = 0
#: family of motions with omega < V at the onset of partial slip
MINUS = 1
#: offset of X in a row of the tables of full slip and of onset
SLIDE_X = ONSET_X = 2 * TERMS
#: offset of distance and angle in a row of the slow manifold
SLOW_PATH = 2 * TERMS
#: offset of the slip loss in a row of the slow manifold
SLOW_LOSS = 4 * TERMS
#: offset of the split in a row of the asymptotes
ASYMPTOTE_SPLIT = 2 * TERMS
#: offset of distance and angle in a row of the asymptotes
ASYMPTOTE_PATH = 3 * TERMS
#: offset of the slip loss in a row of the asymptotes
ASYMPTOTE_LOSS = 5 * TERMS


class FlowTables(NamedTuple):
    """The tables of one scene: polynomials of 24 coefficients, or of 12 by 12 in the layer;
    :data:`SHAPES` has the shapes.

    The slow logarithm of V falls linearly in time along the slow manifold, at the rate T_mean/(1 +
    j).  It tends to ln V plus a constant as V -> 0 and is 0 at about kappa V = 1/4.  E = k0 (tau -
    tau_onset) is the stiff time since the onset of partial slip, with the relaxation rate k0 of
    omega - V at onset.  A motion may pass delta = 0, where the law has a kink: the split, a value
    of E near there, or 1, divides its layer.  The layer coordinate is u = 2^LAYER_LOW + (1 -
    2^LAYER_LOW) E/split before the split and 1 + E - split after.

    Attributes
    ----------
    slide : two tables, V > 0 and V < 0 in full slip, over kappa |V|: (T = integral of dV/V' from
        rest, delta_star |V|), X = integral of V dT.
    after : two tables, T > 0 and T < 0, over kappa mu |T|: |V|.
    onset : two tables by the sign of V at onset, over kappa |I|/(1 + j), I = V - j omega - 2 mu T:
        (V, T), X at onset.
    slow : over the slow logarithm: (V, delta), remaining (distance, angle) to rest, remaining slip
        loss, on the manifold.
    manifold : over kappa V: (slow logarithm, delta) on the slow manifold.
    asymptote : PLUS and MINUS, over kappa V at onset, the motion on the slow manifold that the
        motion approaches: (slow logarithm at onset, k0), split, (distance, angle) and slip loss in
        excess of the motion on the manifold.
    layer : (family, octave of kappa V, octave of u, column, power of u and power of kappa V):
        ln(V/V0), delta, integral of (V/V0 - 1) dE, integral of (omega/V0 - 1) dE, slip loss divided
        by V0^2.
    """

    slide: Any
    after: Any
    onset: Any
    slow: Any
    manifold: Any
    asymptote: Any
    layer: Any


#: Shapes of the tables.
SHAPES = FlowTables(
    slide=(2, HIGH - LOW, 3 * TERMS),
    after=(2, HIGH - LOW, TERMS),
    onset=(2, HIGH - LOW, 3 * TERMS),
    slow=(SLOW_BINS + SLOW_OCTAVES, 5 * TERMS),
    manifold=(HIGH - LOW, 2 * TERMS),
    asymptote=(2, OCTAVES, 6 * TERMS),
    layer=(2, OCTAVES, LAYER_HIGH - LAYER_LOW, 5, BLOCK),
)
#: Index in the vector at which each table begins.
STARTS = FlowTables(*(sum(map(prod, SHAPES[:n])) for n in range(len(SHAPES))))
#: Numbers of a row of each table: of the polynomials over one octave, or of one in the layer.
ROW_SIZES = FlowTables(*(shape[-1] for shape in SHAPES))
#: Number of doubles of the vector.
SIZE = sum(map(prod, SHAPES))


def views(table: NDArray) -> FlowTables:
    """Return the tables in one vector as views in their shapes.

    table : vector of :data:`SIZE` doubles.
    Returns :class:`FlowTables` of arrays in the shapes :data:`SHAPES`, which follow each other in
    the vector; what is written to them is written to ``table``.  Raises ValueError if ``table`` is
    shorter.
    """
    parts = zip(STARTS, SHAPES, strict=True)
    return FlowTables(
        *(table[start : start + prod(shape)].reshape(shape) for start, shape in parts)
    )


# --- Contact states from which a flow map is made ---

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
    """Evaluate critical creepage, moment and traction at states in partial slip, to which a flow
    map is fitted.

    V : speeds of the axis, > 0, (n,).
    delta : creepage, |delta| < delta_star, (n,).  From delta_star on Q is +-mu and its slope 0,
    nearly.
    kappa, mu : float, slenderness R/l0 and coefficient of friction, > 0.
    law : :class:`.law_record.Law` of one material, without a cover.
    out : (4, n) floats, written: delta_star; M divided by P R; Q divided by P, with the sign of
        delta, 0 at delta = 0; dQ/d delta at fixed V.  Returns nothing.
    """
    for i in range(V.size):
        u = kappa * V[i]
        found = length_and_moment(locate_row(u, law), u, law)
        edge = 0.5 * mu / kappa * found.L  # delta_star, Eq. (9)
        # L (1 - |delta|/delta_star); in full slip 1e-300 in place of 0 keeps v finite or inf, not
        # NaN.
        w = found.L * max(1.0 - abs(delta[i]) / edge, 1e-300)
        v = 2.0 * u / w
        # |Q| = mu (1 - w^2 H(v)), with H = H/F^2 and v = 2 u/w: dQ/dw = -2 mu w (H - v H'/2), and
        # dw/d delta = -2 kappa/mu for delta > 0.
        value, slope = H_over_F2(locate_row(v, law), v, law)
        out[DELTA_STAR, i] = edge
        out[MOMENT, i] = V[i] * found.scale * found.m
        out[TRACTION, i] = np.sign(delta[i]) * mu * (1.0 - w * w * value)
        out[STIFFNESS, i] = 4.0 * kappa * w * (value - 0.5 * v * slope)


# --- Outputs of a motion that is looked up ---

#: row of the speed of the axis; rows are those of :class:`.records.Output`, and one more
OUT_V = 0
#: row of the angular velocity
OUT_OMEGA = 1
#: row of the distance
OUT_X = 2
#: row of the angle
OUT_ANGLE = 3
#: row of the energy lost by slip
SLIP_LOSS = 6
#: row of the energy lost by rolling resistance
ROLLING_LOSS = 7
#: number of these rows
ROWS = 8


@inline_kernel
def write_rest(at, x, angle, loss, out):
    """Write outputs at rest, V = omega = delta = 0 and regime AT_REST, from a column to the last.

    at : int, first column to write; nothing is written if it is the number of columns.
    x, angle : float, distance and angle, times gamma, of all of them, in the frame of the caller.
    loss : float, slip loss of all of them.
    out : outputs (ROWS, times), written but for the row ROLLING_LOSS.  Returns nothing.
    """
    state = Output(V=0.0, omega=0.0, x=x, angle=angle, delta=0.0, regime=float(AT_REST), loss=loss)
    for column in range(at, out.shape[1]):
        for row in range(len(state)):
            out[row, column] = state[row]
