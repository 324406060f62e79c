"""Flow map: its tables over one variable, in the order in which they need one another."""

from __future__ import annotations

from ..compile.jit import kernel
from .slide import onset_table, slide_table, time_table
from .slow import lambda_table, slow_table

#: what stands against a map
FILLED, HELD, SLIPS = range(3)


@kernel
def fill_curves(parts, scene):
    """Fill all ``parts`` of a map but entries and layers; FILLED, or what stands against it."""
    if not (slide_table(1.0, scene, parts.slide_up) and slide_table(-1.0, scene, parts.slide_down)):
        return HELD
    if not slow_table(scene, parts.slow):
        return SLIPS
    time_table(parts.slide_up, scene, parts.time_up)
    time_table(parts.slide_down, scene, parts.time_down)
    onset_table(parts.slide_up, scene, parts.onset_up)
    onset_table(parts.slide_down, scene, parts.onset_down)
    lambda_table(parts.slow, scene.kappa, True, parts.late)
    lambda_table(parts.slow, scene.kappa, False, parts.early)
    return FILLED
