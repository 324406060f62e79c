"""What a flow map of one scene holds: polynomials of 24 powers, an octave of their variable each, as rows of a law are.

Times are tau = gamma t; everything is mirrored so that omega > V while sliding and V > 0 in partial slip.  Functions
lie in a row one after the other, pairs side by side (:mod:`..rows.lanes`).
"""

from __future__ import annotations

from math import prod
from typing import Any, NamedTuple

from numpy.typing import NDArray

from ..rows.lanes import TERMS

#: octaves of kappa V and of what grows with it: below, the law is its limit V -> 0 to 2e-11
LOW, HIGH = -36, 16
#: bins of lambda < 0 and their width; octaves of 1 + lambda from 1 on
SLOW_BINS, SLOW_WIDTH, SLOW_OCTAVES = 9, 3.0, 40
#: octaves of kappa V at stick onset, down from the highest
OCTAVES = 20
#: highest octave of kappa V at onset that the tables of full slip and of the slow manifold allow for
OCTAVE_RANGE = LOW + OCTAVES, HIGH - 2
#: powers of a layer in its two variables, in kappa V at onset and in u
LAYER_TERMS = 12
#: octaves of u in [2^LAYER_LOW, 1) up to the split, and in [1, 2^LAYER_HIGH) behind it
LAYER_LOW, LAYER_HIGH = -6, 5
#: E beyond which the boundary layer has decayed to e^-E
LAYER_END = 28.0
BLOCK = LAYER_TERMS * LAYER_TERMS
LAYER_LN_V, LAYER_CREEP, LAYER_X, LAYER_ANGLE, LAYER_LOSS = range(5)
#: families of motions by the sign of omega - V where they enter partial slip
PLUS, MINUS = range(2)
#: where what is over one variable begins in its row
SLIDE_X = ONSET_X = 2 * TERMS
SLOW_PATH, SLOW_LOSS = 2 * TERMS, 4 * TERMS
ENTRY_SPLIT, ENTRY_PATH, ENTRY_LOSS = 2 * TERMS, 3 * TERMS, 5 * TERMS


class FlowTables(NamedTuple):
    """The tables of one scene; those over one variable have shapes (rows, numbers of a row).

    Lambda is the slow logarithm of V: along the slow manifold it falls linearly in time, at the rate c/(1 + j); it
    tends to ln V plus a constant as V -> 0 and is 0 at about kappa V = 1/4.  E = k0 (tau - tau_onset) is the stiff time
    since onset, k0 the stiff rate at onset.  A motion may pass delta = 0, where the law bends: the split, some E near
    there or 1, parts its layer, u = 2^LAYER_LOW + (1 - 2^LAYER_LOW) E/split before it and 1 + E - split behind.

    Attributes
    ----------
    slide : two, V > 0 and V < 0 in full slip, over kappa |V|: (T = int dV/V' from rest, delta_star |V|), X = int V dT.
    after : likewise over kappa mu |T|: |V|.
    onset : likewise, V at onset being of that sign, over kappa |I|/(1 + j), I = V - j omega - 2 mu T: (V, T), X there.
    slow : over lambda: (V, delta), (distance, angle), slip loss to go to rest, on the slow manifold.
    manifold : over kappa V: (lambda, delta) there.
    entry : PLUS and MINUS, over kappa V at onset, of what the motion that enters partial slip there will have in common
        with the slow manifold: (lambda, k0), the split; (distance, angle), slip loss that it gains on that motion.
    layer : likewise, (family, octave, octave of u, column, power in u, in kappa V): ln(V/V0), delta,
        int (V/V0 - 1) dE, int (omega/V0 - 1) dE, slip loss over V0^2.
    """

    slide: Any
    after: Any
    onset: Any
    slow: Any
    manifold: Any
    entry: Any
    layer: Any


SHAPES = FlowTables(
    slide=(2, HIGH - LOW, 3 * TERMS), after=(2, HIGH - LOW, TERMS), onset=(2, HIGH - LOW, 3 * TERMS),
    slow=(SLOW_BINS + SLOW_OCTAVES, 5 * TERMS), manifold=(HIGH - LOW, 2 * TERMS), entry=(2, OCTAVES, 6 * TERMS),
    layer=(2, OCTAVES, LAYER_HIGH - LAYER_LOW, 5, BLOCK),
)  # fmt: skip
STARTS = FlowTables(*(sum(map(prod, SHAPES[:n])) for n in range(len(SHAPES))))
SIZE = sum(map(prod, SHAPES))


def views(table: NDArray) -> FlowTables:
    """The parts of a whole table of :data:`SIZE` numbers, in their shapes."""
    parts = zip(STARTS, SHAPES, strict=True)
    return FlowTables(*(table[start : start + prod(shape)].reshape(shape) for start, shape in parts))
