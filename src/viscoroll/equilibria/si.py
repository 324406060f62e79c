"""Steady rolling in SI units, for a cylinder."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..checks import checked
from ..drive import Feedback, slope_factor
from ..errors import ParameterError
from .result import Loss, Steady
from .rolling import steady


def steady_of(
    cylinder: Any,
    force: ArrayLike | Feedback | None,
    torque: ArrayLike | Feedback | None,
    slope: ArrayLike | None,
    V: ArrayLike | None,
) -> Steady:
    """``Cylinder.steady``."""
    scene, R, T = cylinder.scene(), cylinder.R, cylinder.T_ref
    angle: Any = slope
    load = np.asarray(cylinder.load * slope_factor(slope)[1])
    found = steady(
        scene,
        force=_over("force", force, load, cylinder),
        torque=_over("torque", torque, load * R, cylinder),
        slope=angle,
        V=None if V is None else cylinder.V_from_si(V),
    )
    each = load[..., np.newaxis] if load.ndim else load  # beside the axis of equilibria
    power = each * R / T
    loss = found.loss
    words = "force + torque/R", "rolling moment over R", " N/m", " m/s"
    factors = np.broadcast_to(load, found.reasons.shape).ravel(), R / T
    return replace(
        found,
        V=cylinder.V_to_si(found.V),
        omega=cylinder.omega_to_si(found.omega),
        force=found.force * each,
        torque=found.torque * each * R,
        eigenvalues=found.eigenvalues * (scene.gamma / T * (each / cylinder.load))[..., np.newaxis],
        loss=Loss(loss.slip * power, loss.half_space * power, loss.cylinder * power, loss.coefficient, loss.efficiency),
        reasons=replace(found.reasons, words=words, factors=factors),
    )


def _over(name: str, value: ArrayLike | Feedback | None, unit: NDArray, cylinder: Any) -> Any:
    """A force or torque over its unit, gains without dimension.

    Raises
    ------
    ParameterError
        What is not numeric, or a feedback beside an array of slopes.
    """
    if not isinstance(value, Feedback):
        return None if value is None else checked(name, value) / unit
    if unit.ndim:
        raise ParameterError("slope", "an array", f"a number where the {name} is a feedback")
    one = float(unit)
    return Feedback(value.value / one, cylinder.V_to_si(value.V) / one, value.omega / (one * cylinder.T_ref))
