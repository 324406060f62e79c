"""Which assumptions of the model a state violates: :func:`validity`."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...core.array_types import Numbers
from ...core.checks import broadcast_shape, check_array, divide_by_unit
from ...core.errors import ParameterError
from ..contact_table import evaluate_contact
from ..parameters import Roller, resolve_model
from .assumptions import (
    UNKNOWN,
    UNKNOWN_OF_COVERS,
    Validity,
    assess_creep,
    assess_position,
    assess_small_contact,
)  # fmt: skip
from .cover import assess_cover, assess_traction
from .free_rolling import FreeRolling
from .steadiness import Steadiness


def validity(roller: Roller, V: Numbers, *, omega: Numbers | None = None, density: float | None = None) -> Validity:
    """Report which assumptions of the model the contact of a rolling cylinder at speed V violates.

    Parameters
    ----------
    roller : a :class:`Scene`, or a :class:`Cylinder` with V in m/s and omega in rad/s.
    V : speed of the axis, any sign, a number or an array that broadcasts with array parameters; of a Scene divided by
        R/T_ref, where T_ref is its unit of time.
    omega : angular velocity, any sign, broadcasts with V; of a Scene multiplied by T_ref; None: the creepage is not
        known, and ``creep`` is not decided.
    density : density of a Cylinder, and of the base where they are alike or the cylinder is rigid, kg/m^3; default: as
        the materials have it; without that of the softer body the slowest shear wave is not known.

    Returns
    -------
    Validity
        For each assumption a number, whether it holds (both in the broadcast shape, None where nothing decides), and a
        sentence; ``print`` shows them, and ``failed`` names those that fail.  A Scene decides ``small_contact`` and
        ``under_axis``; ``steady`` if it has a gamma, a V other than 0 and no layer of finite thickness; ``creep`` with
        omega; of a layer ``thick``, with half the contact length divided by its thickness, and ``traction``.  For a
        Cylinder ``quasistatic`` compares the speed of the axis, and that of the circumference where omega is given,
        with the slowest shear wave, sqrt(G/density), G = E/(2 (1 + nu)) of long times, of the bodies whose density is
        known, and is undecided without that of the softer one; ``bodies`` has Dundurs' constant, ``measured`` the
        transit frequency in 1/s if a material has measured data.  ``plane`` is not decided.

    Raises
    ------
    ParameterError
        NaN or infinite speeds, a density that is not one positive number, a density for a Scene, shapes that do not
        broadcast, what is no scene and no cylinder, a layer too thin for its law, of a layer also kappa |V| above
        1e300; times of a material beyond 1e-100 to 1e100 T_ref.

    Examples
    --------
    >>> import viscoroll as vr
    >>> report = vr.validity(vr.presets.RUBBER_CYLINDER, 2.0, omega=20.0)
    >>> bool(report.small_contact.holds)
    True
    """
    _, scene, scale = resolve_model(roller, "validity")
    speeds = {"V": V} if omega is None else {"V": V, "omega": omega}
    given = {name: check_array(name, value, unit=scale) for name, value in speeds.items()}
    with np.errstate(over="ignore"):
        scaled = {name: divide_by_unit(name, array, scale[name]) for name, array in given.items()}
    speed, spin = scaled["V"], scaled.get("omega")
    broadcast_shape(**given, **{name: np.asarray(value) for name, value in scene.numbers.items()})
    if scene.cover is None:
        free = FreeRolling.of_scene(scene, speed)
        lengths = free.contact_lengths(scene.kappa)
        steady = UNKNOWN.steady if scene.gamma is None else Steadiness.of(free.scaled(scale))
        report = UNKNOWN._replace(steady=steady)
    else:
        lengths, thick = assess_cover(scene, speed)
        report = UNKNOWN._replace(steady=UNKNOWN_OF_COVERS, thick=thick, traction=assess_traction(scene, speed))
    report = report._replace(
        small_contact=assess_small_contact(lengths.reach), under_axis=assess_position(lengths.epsilon)
    )
    if spin is not None:
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            delta = np.where(spin == speed, 0.0, (spin - speed) / speed)
        full: Any = np.abs(delta) >= scene.mu * np.asarray(lengths.reach)
        if scene.cover is not None:
            full = evaluate_contact(scene, speed, spin, True, ("full_slip",))["full_slip"]
        report = report._replace(creep=assess_creep(delta, full))
    if roller.body_data is not None:
        return roller.body_data.extend_validity(report, lengths.lam, given["V"], given.get("omega"), density)
    if density is not None:
        sentence = "density needs a Cylinder: a Scene has no wave speed"
        raise ParameterError("density", density, "None", sentence)
    return report
