"""The arguments of the functions of heat, checked and flattened: which body is heated, how, in
which states.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal, NamedTuple

import numpy as np

from ..contact_mechanics.parameters import Parameters, Roller
from ..core.checks import Floats, broadcast_shape, check_array, check_array_extent, check_number
from ..core.errors import ParameterError, described_error
from ..materials.material import Material
from ..materials.measured_data import ABSOLUTE_ZERO, check_celsius
from .shift_curve import ShiftCurve, shift_curve

#: size of log2 a_T beyond which a shift has no double, e^700
_FARTHEST = 1000.0


class Heated(NamedTuple):
    """A body of a roller that has a temperature.

    on : "cylinder", "base", or "both" of one material, which then have one temperature.
    material : its material.
    part : its part of the loss in rolling.
    slip : its part of the loss in slip.
    """

    on: Literal["cylinder", "base", "both"]
    material: Material
    part: float
    slip: float


@dataclass(frozen=True, eq=False)
class HeatStates:
    """States of a call, flattened to vectors of one length (n,), and the one body that is heated.

    roller, scene : the cylinder, on its slope, and its dimensionless parameters.
    body, curve : the body and its shift.
    shape : shape of the states.
    V : speed of each state, m/s, any sign; None where the load gives it.
    R, load, kappa, mu : of each state, m, N/m, and dimensionless.
    unit : m/s of one unit of speed of the scene, at the reference temperature.
    ambient, conductance : degrees Celsius and W/(m K).
    """

    roller: Any
    scene: Parameters
    body: Heated
    curve: ShiftCurve
    shape: tuple[int, ...]
    V: Floats | None
    R: Floats
    load: Floats
    kappa: Floats
    mu: Floats
    unit: Floats
    ambient: Floats
    conductance: Floats

    @cached_property
    def law(self) -> Any:
        """The law of all states, or the materials of which each state has one."""
        return self.scene.table or self.scene.material_array

    @cached_property
    def materials(self) -> Floats:
        """Index of the material of each state, a float as laws take it, (n,)."""
        several = self.scene.material_array
        if several is None:
            return np.zeros(self.load.size)
        return np.broadcast_to(np.arange(float(len(several))), self.shape).ravel()


def heated_bodies(roller: Roller, call: str, slip_share: float) -> list[Heated]:
    """Return the bodies of a roller that lose heat: one, two of different materials, or both as one
    of one material.

    roller: a Cylinder whose materials have a shift; what else is refused.
    call: name of the function, for errors.
    slip_share: the cylinder's part of the loss in slip, in [0, 1].
    Raises ParameterError for a Scene, for a cylinder by E to T_sigma, and for two bodies that do
    not relax.
    """
    slip_share = check_number("slip_share", slip_share, low=0.0, high=1.0)
    if not roller.scale.si:
        raise described_error(
            "roller", f"of {call} is a Scene, which has no temperature", "a Cylinder"
        )
    pair = roller.body_data and roller.body_data.pair
    if pair is None:
        allowed = "a Material with a shift=, in place of E, nu, T_epsilon and T_sigma"
        raise described_error("material", f"of {call} is given as numbers", allowed)
    found = [
        Heated("cylinder", pair.cylinder, 1.0, slip_share),
        Heated("base", pair.half_space, 1.0, 1.0 - slip_share),
    ]
    found = [body for body in found if body.material.prony.alpha > 1.0]
    if not found:
        raise described_error(
            "material", "does not relax, and rolls without loss", "one that relaxes"
        )
    if pair.like:
        return [Heated("both", pair.cylinder, 0.5, 0.5)]
    return found


def heat_states(
    roller: Roller, scene: Parameters, call: str, given: dict[str, Any], slip_share: float = 0.5
) -> HeatStates:
    """Check the arguments of a call, and flatten the states of the one body that is heated.

    roller, scene: as in :func:`.parameters.resolve_model`.
    call: name of the function, for errors.
    given: "V" (None: not given), "ambient", "conductance": numbers or arrays without labels, and
        further arrays that take part in the shape.
    slip_share: as in :func:`heated_bodies`.
    Returns the :class:`HeatStates`, flattened to (n,), in SI units.
    Raises ParameterError for values out of range, shapes that do not broadcast, an ambient outside
    the range of the shift, two bodies that both relax and are of different materials, and a
    vertical shift that changes the shape of the law with temperature.
    """
    heated = heated_bodies(roller, call, slip_share)
    if len(heated) > 1:
        allowed = (
            "elastic, rigid or of the same material; pair_temperatures has a temperature "
            "for each body"
        )
        raise described_error("base", "relaxes too", allowed)
    (body,) = heated
    curve = shift_curve(body.material)
    lows = {"conductance": 0.0}
    arrays = {
        name: check_array(name, value, above=lows.get(name, -math.inf))
        for name, value in given.items()
        if value is not None
    }
    check_ambient(arrays["ambient"], curve)
    pair = roller.body_data.pair
    if body.material.vertical_shift is not None and (
        pair.covered or pair.share not in (0.0, 0.5, 1.0)
    ):
        allowed = (
            "left out for a cover, and beside an elastic body: the shape of the law changes "
            "with temperature"
        )
        raise described_error("vertical_shift", "is given", allowed)
    cylinder: Any = roller
    arrays |= {"R": np.asarray(cylinder.R), "load": np.asarray(cylinder.load)}
    arrays |= {"kappa": np.asarray(scene.kappa), "mu": np.asarray(scene.mu)}
    several = scene.material_array
    shape = broadcast_shape(**arrays, material=np.empty(() if several is None else several.shape))
    arrays["unit"] = np.asarray(roller.scale["V"])
    rows = np.empty((len(arrays), *(shape or (1,))))
    for row, array in zip(rows, arrays.values(), strict=True):
        row[...] = array
    flat = dict(zip(arrays, rows.reshape(len(arrays), math.prod(shape)), strict=True))
    names = ("R", "load", "kappa", "mu", "unit", "ambient", "conductance")
    return HeatStates(
        roller, scene, body, curve, shape, flat.get("V"), *(flat[name] for name in names)
    )


def check_ambient(ambient: Floats, curve: ShiftCurve, name: str = "ambient") -> None:
    """Raise ParameterError for a temperature outside the range of a shift, and warn of one that
    looks like kelvin.

    ambient: temperatures, degrees Celsius, any shape.
    curve: shift of the body that has it.
    name: name of the argument.
    """
    _, ends = check_array_extent(name, ambient, above=ABSOLUTE_ZERO)
    for at in dict.fromkeys(ends if ambient.size else ()):
        check_celsius(name, at)
        allowed = f"above {curve.low:g} and at most {curve.high:g}"
        if not curve.low <= at <= curve.high:
            sentence = (
                f"{name} = {at:g} degrees Celsius is outside the range of the shift: must "
                f"be {allowed}"
            )
            raise ParameterError(name, at, allowed, sentence)
        if not abs(curve.log2_of(np.asarray(at))) < _FARTHEST:
            sentence = (
                f"{name} = {at:g} degrees Celsius: no double holds a_T there: must be "
                f"{allowed}, and nearer to T0"
            )
            raise ParameterError(name, at, allowed, sentence)
