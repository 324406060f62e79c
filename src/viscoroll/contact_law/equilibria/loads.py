"""Loads of steady rolling, checked and flattened: :class:`Loads`.

P is the load that presses the cylinder on its base, R its radius, kappa = R/l0 with the contact length at rest l0, mu
the coefficient of friction, and j the moment of inertia divided by m R^2.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ...core.array_types import Floats
from ...core.checks import broadcast_shape, check_array
from ...core.drive import Feedback, slope_tan_cos
from ...core.errors import ParameterError, described_error
from ..contact_table import refuse_overflow
from ..parameters import Parameters

#: largest kappa |V| of a given speed
FASTEST = 1e100


class Gains(NamedTuple):
    """Gains of force and torque on V and omega, dimensionless: force = value + force_V V + force_omega omega, and
    torque likewise.
    """

    force_V: float = 0.0
    force_omega: float = 0.0
    torque_V: float = 0.0
    torque_omega: float = 0.0

    @property
    def V(self) -> float:
        """Gain of force + torque on V."""
        return self.force_V + self.torque_V

    @property
    def omega(self) -> bool:
        """Whether any gain acts on omega."""
        return self.force_omega != 0.0 or self.torque_omega != 0.0


class Loads(NamedTuple):
    """Loads of one material as vectors of one length, dimensionless.

    shape : shape to which the loads and the parameters of the scene broadcast, () for one load; vectors are (n,), with
    n the product of the shape.
    gains : gains of a feedback, one set for all loads; 0 without feedback.
    given : where V is given, the name of the load that is given with it ("force" or "torque"), else None.
    force, torque : values at V = omega = 0, divided by P and P R, (n,); a slope is in the force.  Of the load that is
    to be found beside a given V the number here has no meaning.
    kappa, mu, j : parameters, (n,), kappa with the load on the slope.
    V : given speeds, (n,), or None.
    """

    shape: tuple[int, ...]
    gains: Gains
    given: str | None
    force: Floats
    torque: Floats
    kappa: Floats
    mu: Floats
    j: Floats
    V: Floats | None = None


def loads_of(
    scene: Parameters,
    force: ArrayLike | Feedback | None,
    torque: ArrayLike | Feedback | None,
    slope: ArrayLike | None,
    V: ArrayLike | None,
) -> Loads:
    """Check the loads of a call of :func:`.steady.steady`, and broadcast them with the parameters of the scene.

    scene : dimensionless parameters of the roller, on the slope, of which alpha, kappa, mu and j are read; one alpha or
        one material, the others numbers or arrays.
    force, torque : numbers, arrays or :class:`Feedback`, divided by P and by P R, where P is the load that presses the
        cylinder on the slope, its weight times cos(slope); None: 0.
    slope : angle, rad, a number or an array; tan(slope), the part of the weight along the slope divided by P, is added
        to the force.  None: level.
    V : given speeds, dimensionless, any sign, a number or an array; None where the speed is to be found.
    Returns the :class:`Loads`: the broadcast ``shape``; ``gains``; ``given``, the name of the load beside V or None;
    and force, torque, kappa, mu, j and V (None where it is to be found), flattened to (n,), (1,) where all are numbers.
    Raises ParameterError: NaN or infinite input; a slope outside (-pi/2, pi/2); shapes
    that do not broadcast; kappa |V| above :data:`FASTEST`; a feedback that changes with time or has arrays of gains;
    with V both or neither of force and torque (a slope alone counts as the force), or a feedback.
    """
    given = None if V is None else _given_load(slope, force=force, torque=torque)
    tangent = slope_tan_cos(slope)[0]
    push, *of_force = _split_feedback("force", force)
    turn, *of_torque = _split_feedback("torque", torque)
    arrays = {"force": push, "torque": turn, "kappa": scene.kappa, "mu": scene.mu, "j": scene.j, "slope": tangent}
    if V is not None:
        arrays["V"] = check_array("V", V)
        refuse_overflow(np.asarray(scene.kappa), arrays["V"], FASTEST)
    shape = broadcast_shape(**{name: np.asarray(each) for name, each in arrays.items()})
    arrays["force"] = push + arrays.pop("slope")
    rows = np.empty((len(arrays), *(shape or (1,))))
    for row, array in zip(rows, arrays.values(), strict=True):
        row[...] = array
    return Loads(shape, Gains(*of_force, *of_torque), given, *rows.reshape(len(arrays), math.prod(shape)))


def _split_feedback(name: str, value: ArrayLike | Feedback | None) -> tuple[Any, float, float]:
    """Split a load into its value at rest and the gains of its feedback.

    name: name of the load, "force" or "torque", for errors.
    value: a number, an array or a :class:`Feedback`, whose value may be an array too; None: no load.
    Returns (value at V = omega = 0, a number or an array; gain on V; gain on omega, floats), in the unit of ``value``;
    (0, 0.0, 0.0) for None, gains of 0.0 without feedback.
    Raises ParameterError for NaN or infinite values, a feedback that changes with time, or arrays of gains.
    """
    if not isinstance(value, Feedback):
        return check_array(name, 0.0 if value is None else value), 0.0, 0.0
    if not isinstance(value.value, float | np.ndarray):
        raise described_error(name, "is a Feedback of a Schedule or function", "constant in time")
    if value.shape:
        raise described_error(name, f"is a Feedback with gains of shape {value.shape}", "one whose gains are numbers")
    return value.value, value.V, value.omega


def _given_load(slope: ArrayLike | None, **loads: ArrayLike | Feedback | None) -> str:
    """Return the name of the load that is given beside V, "force" or "torque"; the other one is to be found.

    slope: angle, rad, or None; without force and torque a slope counts as the force given, and the result is "force".
    loads: ``force`` and ``torque``, each a number or an array, None where it is not given.
    Raises ParameterError for a feedback, where both are given, and where neither of the two and no slope is given.
    """
    names = [name for name, value in loads.items() if value is not None]
    for name in names:
        if isinstance(loads[name], Feedback):
            raise described_error(name, "is a Feedback", "a number or an array where V is given")
    if len(names) == 2:
        sentence = "V, force and torque are all given: give two of them, the third is computed"
        raise ParameterError("V, force, torque", "all", "two of them", sentence)
    if not names and slope is None:
        sentence = "V is given without force, torque or slope: give one of them too"
        raise ParameterError("V", "alone", "with one of force, torque, slope", sentence)
    return names[0] if names else "force"
