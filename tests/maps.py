"""Motions by the flow map beside those of the integrator."""

import numpy as np
from closeness import close


def decay_time(scene):
    """1/rate of V at low speed; of the sliding phase where alpha = 1."""
    rate = (scene.alpha - 1.0) / scene.alpha if scene.series is None else scene.series.T_mean
    return (1.0 + scene.j) / (scene.gamma * rate) if rate > 1e-9 else 1.0 / (scene.gamma * scene.mu)


def beside(scene, V0, omega0, t, rtol=1e-6):
    """Motions by the map, whose speeds are those of the integrator to the error that it states."""
    mapped, exact = (
        scene.ensemble(V0, omega0, t, method=method, rtol=rtol, fields=("V", "omega"))
        for method, rtol in (("flow", rtol), ("integrate", 1e-11))
    )
    by = mapped.flow
    size = np.maximum(abs(exact.V), abs(exact.omega))
    for name in ("V", "omega") if by.any() else ():
        pair = getattr(mapped, name)[by], getattr(exact, name)[by]
        assert close(*pair, mapped.flow_error, scale=size[by], what=name)
    return mapped
