"""Every proof: the one table that `make prove`, the tests and the accuracy page read."""

from __future__ import annotations

from . import cover, motion, ratios, series, shape, states
from .claim import Proof

TABLE: list[Proof] = [
    *ratios.PROOFS,
    *states.PROOFS,
    *shape.PROOFS,
    *series.PROOFS,
    *motion.PROOFS,
    *cover.PROOFS,
]
