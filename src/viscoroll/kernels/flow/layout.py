"""What a flow map of one scene holds, and how its polynomials are found without a logarithm.

Every table is a stack of bins: octaves of its index variable cut into equal parts of the
mantissa m in [1, 2).  A bin holds for each column the coefficients of a polynomial in
t = m - (centre of the bin), constant term first.  Times are tau = gamma t; everything is
mirrored so that omega > V while sliding and V > 0 in partial slip.
"""

from __future__ import annotations

from math import prod
from typing import Any, NamedTuple

from numpy.typing import NDArray

#: bins an octave (as a power of two), and coefficients, of the tables over one variable
BIN_BITS, COEFFICIENTS = 3, 8
BINS = 1 << BIN_BITS
#: octaves of kappa V and of what grows with it: below, the law is its limit V -> 0 to 2e-11
LOW, HIGH = -36, 16
#: octaves of 1 + lambda in ``early``
EARLY_HIGH = 40
#: lambda in ``late``, by bins of equal width
LATE_LOW, LATE_HIGH, LATE_WIDTH = -26.0, 1.0, 0.25
#: octaves of kappa V at stick onset, down from the highest; those with a table of the boundary layer
ENTRY_OCTAVES, LAYER_OCTAVES = 20, 10
#: coefficients of the tables over two variables: in kappa V at onset (an octave a bin), in E
SPEED_COEFFICIENTS, FAST_COEFFICIENTS = 12, 8
#: bins of E: [0, 2^E_LOW), an octave each to 1, then half octaves to 2^E_HIGH
E_LOW, E_HIGH = -8, 5
#: E beyond which the boundary layer has decayed to e^-E
LAYER_END = 28.0

(T, X, I, L), (ONSET_V, ONSET_T, ONSET_X) = range(4), range(3)
LAMBDA, X_TO_GO, ANGLE_TO_GO, LOSS_TO_GO, DELTA = range(5)
SPEED = LAMBDA  # in its place in ``late`` and ``early``
ENTRY_COLUMNS, LAYER_COLUMNS = 10, 5
ENTRY_LAMBDA, ENTRY_X, ENTRY_ANGLE, ENTRY_LOSS = range(4)
CROSSING, CROSSING_SPEED, CROSSING_X, CROSSING_ANGLE, CROSSING_LOSS, RATE = range(4, 10)
LAYER_LN_V, LAYER_CREEP, LAYER_X, LAYER_ANGLE, LAYER_LOSS = range(5)


class FlowTables(NamedTuple):
    """The tables of one scene; shapes (bins, columns, coefficients) but for the layers.

    Lambda is the slow logarithm of V: along the slow manifold it falls linearly in time, at
    the rate c/(1 + j); it tends to ln V plus a constant as V -> 0 and is 0 at kappa V = 1/4.
    E = k0 (tau - tau_onset) is the stiff time since onset, k0 the stiff rate at onset.

    Attributes
    ----------
    slide_up, slide_down : kappa |V| -> T = int dV/V' from rest, X = int V dT, I and L in full
        slip for V > 0 and V < 0.  I = w - 2 mu T, constant while sliding, is that of an
        onset at V; L = delta_star |V|.
    time_up, time_down : kappa mu |T| -> V.
    onset_up, onset_down : kappa |I|/(1 + j) -> V, T, X at stick onset.
    slow : kappa V -> lambda, distance, angle and slip loss to go to rest, delta, on the slow manifold.
    late, early : lambda or 1 + lambda -> V, distance, angle and slip loss to go, delta.
    entry_plus, entry_minus, entry_cross : kappa V at onset -> what the motion that enters
        partial slip there with omega > V, with omega < V, or that passes delta = 0 there, will
        have in common with the slow manifold: its lambda, and the distance, angle and slip loss that
        it gains on that motion; E, ln(V/V0), distance, angle and slip loss at delta = 0; k0.
    layer_plus, layer_minus, layer_cross : the boundary layer behind such an onset, and that
        behind delta = 0; shape (octave, bin of E, column, SPEED_COEFFICIENTS,
        FAST_COEFFICIENTS): ln(V/V0), delta, int (V/V0 - 1) dE, int (omega/V0 - 1) dE, slip
        loss over V0^2.
    """

    slide_up: Any
    slide_down: Any
    time_up: Any
    time_down: Any
    onset_up: Any
    onset_down: Any
    slow: Any
    late: Any
    early: Any
    entry_plus: Any
    entry_minus: Any
    entry_cross: Any
    layer_plus: Any
    layer_minus: Any
    layer_cross: Any


def fast_bins(low: int) -> int:
    """Number of bins of E in a layer whose first is [0, 2**low)."""
    return 1 - low + 2 * E_HIGH


def _fine(octaves: int, columns: int) -> tuple[int, int, int]:
    return octaves * BINS, columns, COEFFICIENTS


def _layer(octaves: int, low: int) -> tuple[int, ...]:
    return octaves, fast_bins(low), LAYER_COLUMNS, SPEED_COEFFICIENTS, FAST_COEFFICIENTS


#: one octave more at either end, for motions that pass delta = 0 faster or slower than they entered
CROSS_MARGIN = 1
#: highest octave of kappa V at onset that the tables of full slip and of the slow manifold allow for
OCTAVE_RANGE = LOW + ENTRY_OCTAVES + CROSS_MARGIN, HIGH - 2
SHAPES = FlowTables(
    slide_up=_fine(HIGH - LOW, 4), slide_down=_fine(HIGH - LOW, 4),
    time_up=_fine(HIGH - LOW, 1), time_down=_fine(HIGH - LOW, 1),
    onset_up=_fine(HIGH - LOW, 3), onset_down=_fine(HIGH - LOW, 3),
    slow=_fine(HIGH - LOW, 5),
    late=(int((LATE_HIGH - LATE_LOW) / LATE_WIDTH), 5, COEFFICIENTS), early=_fine(EARLY_HIGH, 5),
    entry_plus=_fine(ENTRY_OCTAVES, ENTRY_COLUMNS), entry_minus=_fine(ENTRY_OCTAVES, ENTRY_COLUMNS),
    entry_cross=_fine(ENTRY_OCTAVES + 2 * CROSS_MARGIN, ENTRY_COLUMNS),
    layer_plus=_layer(LAYER_OCTAVES, E_LOW), layer_minus=_layer(LAYER_OCTAVES, E_LOW),
    layer_cross=_layer(LAYER_OCTAVES + 2 * CROSS_MARGIN, 0),
)  # fmt: skip
STARTS = FlowTables(*(sum(map(prod, SHAPES[:n])) for n in range(len(SHAPES))))
SIZE = sum(map(prod, SHAPES))


def views(table: NDArray) -> FlowTables:
    """The parts of a whole table of :data:`SIZE` numbers, in their shapes."""
    parts = zip(STARTS, SHAPES, strict=True)
    return FlowTables(*(table[start : start + prod(shape)].reshape(shape) for start, shape in parts))
