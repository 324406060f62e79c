"""Which assumptions of the model a state strains: :func:`validity`."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..core.array_types import Numbers
from ..core.checks import broadcast_shape, check_array
from .assumptions import UNKNOWN, UNKNOWN_OF_COVERS, Validity, place, smallness, unlike_speeds
from .contact import evaluate_contact
from .cover_validity import layer
from .parameters import Rolls, framed
from .steadiness import Steadiness


def validity(roller: Rolls, V: Numbers, *, omega: Numbers | None = None, density: float | None = None) -> Validity:
    """Which assumptions of the model the contact at speed V strains.

    Parameters
    ----------
    roller : a :class:`Scene`, or a :class:`Cylinder` with V in m/s and omega in rad/s.
    V : speed of the axis, any sign.
    omega : angular velocity; without it the creep is not known.
    density : of a Cylinder, and of the base where they are alike, kg/m^3; default: as the materials have it; without it
        the speed of shear waves is not known.

    Returns
    -------
    Validity
        For each assumption a number, whether it holds, and a sentence; ``print`` shows them.  Of a Cylinder
        ``quasistatic`` compares the speed of the axis, and that of the circumference where omega is given, with the
        slowest shear wave, sqrt(G/density), G = E/(2 (1 + nu)) of long times, of the bodies whose density is known;
        ``bodies`` holds Dundurs' constant, ``measured`` 1/s at which the contact is passed, and ``thick`` its length
        over the thickness of the layer.

    Raises
    ------
    ParameterError
        NaN or infinite speeds, a density that is not one positive number, shapes that do not broadcast.
    """
    _, scene, scale = framed(roller, "validity")
    speeds = {"V": V} if omega is None else {"V": V, "omega": omega}
    given = {name: check_array(name, each, unit=scale) for name, each in speeds.items()}
    with np.errstate(over="ignore"):
        speed, spin = given["V"] / scale["V"], given["omega"] / scale["omega"] if omega is not None else None
    broadcast_shape(**given, **{name: np.asarray(value) for name, value in scene.numbers.items()})
    if scene.cover is None:
        free = scene.freely(speed)
        found = free.strained(scene.kappa)
        steady = UNKNOWN.steady if scene.gamma is None else Steadiness.of(free.scaled(scale))
        judged = UNKNOWN._replace(small_contact=smallness(found.reach), under_axis=place(found.epsilon), steady=steady)
    else:
        found, thick = layer(scene, speed)
        judged = UNKNOWN._replace(
            small_contact=smallness(found.reach), under_axis=place(found.epsilon), steady=UNKNOWN_OF_COVERS, thick=thick
        )
    if spin is not None:
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            delta = np.where(spin == speed, 0.0, (spin - speed) / speed)
        full: Any = np.abs(delta) >= scene.mu * np.asarray(found.reach)
        if scene.cover is not None:
            full = evaluate_contact(scene, speed, spin, True, ("full_slip",))["full_slip"]
        judged = judged._replace(creep=unlike_speeds(delta, full))
    return roller.known(judged, found.lam, given["V"], given.get("omega"), density)
