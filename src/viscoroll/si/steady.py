"""Steady rolling of a cylinder in SI units."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from ..drive import Feedback
from ..equilibria import Loss, Steady, steady
from ..labels import unlabelled
from ..symbols import attributes
from ..typed import Numbers
from .units import Cylinder, over, units_of
from .warned import look_at_motion


def steady_of(
    cylinder: Cylinder,
    force: Numbers | Feedback | None,
    torque: Numbers | Feedback | None,
    slope: Numbers | None,
    V: Numbers | None,
) -> Steady:
    """``Cylinder.steady``."""
    plain, labels = unlabelled({"force": force, "torque": torque, "slope": slope, "V": V})
    force, torque, slope, V = plain.values()
    scene, one = cylinder.scene(), units_of(cylinder, slope)
    given = {name: over(name, value, one) for name, value in (("force", force), ("torque", torque), ("V", V))}
    found = steady(scene, **given, slope=slope)
    load = np.asarray(one["force"])
    each, R, T, speed = (_beside(unit) for unit in (load, one["x"], one["t"], one["V"]))
    loss, power = found.loss, each * speed
    look_at_motion(cylinder, None, found.V, one["V"])
    words = "force + torque/R", "rolling moment over R", " N/m", " m/s"
    shape = found.reasons.shape
    factors = np.broadcast_to(load, shape).ravel(), np.broadcast_to(one["V"], shape).ravel()
    moments = {name: getattr(found, name) * each * R for name in ("M", "M_half_space", "M_cylinder")}
    return replace(
        found,
        V=found.V * speed,
        omega=found.omega / T,
        Q=found.Q * each,
        **moments,
        force=found.force * each,
        torque=found.torque * each * R,
        eigenvalues=found.eigenvalues * (_beside(scene.gamma) / T * (each / _beside(cylinder.load)))[..., np.newaxis],
        loss=Loss(loss.slip * power, loss.half_space * power, loss.cylinder * power, loss.coefficient, loss.efficiency),
        reasons=replace(found.reasons, words=words, factors=factors),
        described=partial(attributes, si=True),
    ).labelled(labels)


def _beside(unit: Numbers) -> NDArray[np.float64]:
    """A unit beside the axis of equilibria."""
    array = np.asarray(unit, np.float64)
    return array[..., np.newaxis] if array.ndim else array
