"""The units of a cylinder: what each dimensionless quantity is multiplied by, and drives over their units."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from ..checks import checked
from ..drive import Feedback, refuse_more_than_t, slope_factor
from ..errors import ParameterError
from ..symbols import attributes as dimensionless

#: of ``viscoroll.cylinder``, which stands above this room
Cylinder = Any


class Units(NamedTuple):
    """What is 1 of a cylinder: radius (m), time (s), load P (N/m), mass (kg/m), l0 (m), E' (Pa); numbers or arrays."""

    R: Any
    T: Any
    P: Any
    m: Any
    l0: Any
    E_prime: Any

    @property
    def speed(self) -> Any:
        """m/s."""
        return self.R / self.T

    @property
    def torque(self) -> Any:
        """N m/m."""
        return self.P * self.R

    @property
    def energy(self) -> Any:
        """J/m."""
        return self.m * self.speed**2


class Quantity(NamedTuple):
    """What a quantity is in SI units, and its unit from those of a cylinder."""

    long_name: str
    units: str
    of: Callable[[Units], Any]


def _energy(long_name: str) -> Quantity:
    return Quantity(f"{long_name} since t = 0, per length of the cylinder", "J m-1", lambda one: one.energy)


def _moment(long_name: str) -> Quantity:
    return Quantity(f"{long_name}, per length of the cylinder", "N m m-1", lambda one: one.torque)


def _power(long_name: str) -> Quantity:
    return Quantity(long_name, "W m-1", lambda one: one.P * one.speed)


QUANTITIES = {
    "t": Quantity("time", "s", lambda one: one.T),
    "V0": Quantity("initial velocity of the axis", "m s-1", lambda one: one.speed),
    "omega0": Quantity("initial angular velocity", "rad s-1", lambda one: 1.0 / one.T),
    "V": Quantity("velocity of the axis", "m s-1", lambda one: one.speed),
    "omega": Quantity("angular velocity", "rad s-1", lambda one: 1.0 / one.T),
    "x": Quantity("distance travelled", "m", lambda one: one.R),
    "angle": Quantity("angle turned", "rad", lambda one: 1.0),
    "slope": Quantity("angle of the slope", "rad", lambda one: 1.0),
    "force": Quantity("force along V, per length of the cylinder", "N m-1", lambda one: one.P),
    "torque": _moment("torque along omega"),
    "brake": _moment("most torque that a brake takes"),
    "work_force": _energy("work of the force"),
    "work_torque": _energy("work of the torque"),
    "brake_loss": _energy("energy lost in the brake"),
    "slip_loss": _energy("energy lost in slip"),
    "rolling_loss": _energy("energy lost in rolling"),
    "onset_time": Quantity("time of the first change from full to partial slip", "s", lambda one: one.T),
    "rest_time": Quantity("time at which the rest threshold was crossed", "s", lambda one: one.T),
    "length": Quantity("contact length", "m", lambda one: one.l0),
    "Q": Quantity("traction, per length of the cylinder", "N m-1", lambda one: one.P),
    "M": _moment("rolling resistance moment"),
    "M_half_space": _moment("part of M in the half-space"),
    "M_cylinder": _moment("part of M in the cylinder"),
    "N": Quantity("M for each m/s^2 of V', per length of the cylinder", "N s2 m-1", lambda one: one.P * one.T**2),
    "dQ_dV": Quantity("dQ/dV", "N s m-2", lambda one: one.P / one.speed),
    "dQ_ddelta": Quantity("dQ/ddelta", "N m-1", lambda one: one.P),
    "dQ_domega": Quantity("dQ/domega", "N s m-1", lambda one: one.P * one.T),
    "dM_dV": Quantity("dM/dV", "N s m-1", lambda one: one.P * one.T),
    "dM_half_space_dV": Quantity("dM_half_space/dV", "N s m-1", lambda one: one.P * one.T),
    "dM_cylinder_dV": Quantity("dM_cylinder/dV", "N s m-1", lambda one: one.P * one.T),
    "p": Quantity("contact pressure", "Pa", lambda one: one.E_prime),
    "tau": Quantity("shear stress on the cylinder", "Pa", lambda one: one.E_prime),
    "rate_fast": Quantity("rate_fast, of disturbances", "s-1", lambda one: 1.0 / one.T),
    "rate_slow": Quantity("rate_slow, of disturbances", "s-1", lambda one: 1.0 / one.T),
    "loss_slip": _power("power lost: slip"),
    "loss_half_space": _power("power lost: half space"),
    "loss_cylinder": _power("power lost: cylinder"),
}


def attributes(name: str) -> dict[str, Any]:
    """long_name, units, symbol of a quantity in SI units; a ratio as it is everywhere."""
    if name not in QUANTITIES:
        return dict(dimensionless(name))
    return {"long_name": QUANTITIES[name].long_name, "units": QUANTITIES[name].units}


def units_of(cylinder: Cylinder, slope: Any = None) -> Units:
    """Those of a cylinder; on a slope the load is P cos(slope), over which kappa and l0 are too.

    Raises
    ------
    ParameterError
        A slope that is too steep.
    """
    _, share = slope_factor(slope)
    load, l0 = cylinder.load * share, cylinder.l0 * np.sqrt(share)
    return Units(cylinder.R, cylinder.T_ref, load, cylinder.m, l0, cylinder.E_prime)


def to_si(name: str, value: Any, one: Units) -> Any:
    """A dimensionless quantity in its SI unit; what has none, as ratios, as it is."""
    if name not in QUANTITIES:
        return value
    found = np.asarray(value) * QUANTITIES[name].of(one)
    return found if found.ndim else float(found)


def over(name: str, given: Any, one: Units) -> Any:
    """A number, an array, a schedule or a feedback in SI units, over its unit and that of time.

    Raises
    ------
    ParameterError
        What is not numeric or not finite, a brake or a time below 0, arrays where numbers belong.
    """
    if given is None:
        return None
    unit, low = np.asarray(QUANTITIES[name].of(one)), 0.0 if name == "brake" else -np.inf
    if isinstance(given, Feedback):
        return Feedback(over(name, given.value, one), given.V * one.speed / unit, given.omega / one.T / unit)
    if callable(given):
        if unit.ndim:
            raise ParameterError(name, "a function", "a number", f"{name} is a function: the cylinder must be one then")
        refuse_more_than_t(name, given)
        return lambda t: checked(f"{name}(t)", given(t * one.T), low=low) / unit
    if isinstance(given, tuple) and len(given) == 2:
        times, values = checked(f"times of {name}", given[0], low=0.0), checked(f"values of {name}", given[1], low=low)
        return times / one.T, values / (unit[:, np.newaxis] if unit.ndim else unit)
    value = checked(name, given, low=low) / unit
    return value if value.ndim else float(value)


def refuse_other_unit(name: str, value: Any, unit: str) -> None:
    """Raise ParameterError for another unit, or an array of xarray or pandas that says it has one; "m/s" is "m s-1"."""
    given = value if isinstance(value, str) else getattr(value, "attrs", {}).get("units")
    if given is not None and _powers(str(given)) != _powers(unit):
        raise ParameterError(name, f"in {given!s:.40}", f"in {unit}")


def _powers(unit: str) -> dict[str, int]:
    """Powers of the units in "N m/m" or "N m m-1"."""
    found: dict[str, int] = {}
    for n, part in enumerate(unit.split("/")):
        for symbol, power in re.findall(r"([^\W\d_]+|%)\^?(-?\d+)?", part):
            found[symbol] = found.get(symbol, 0) + (-1 if n else 1) * int(power or 1)
    return {symbol: power for symbol, power in found.items() if power}


def in_words(error: ParameterError, one: Units) -> ParameterError:
    """A refusal of the dimensionless call, with what its values are over."""
    if np.ndim(one.R) or np.ndim(one.P):
        about = "(dimensionless)"
    else:
        about = (
            f"(dimensionless: times over {one.T:.6g} s, speeds over {one.speed:.6g} m/s, forces over {one.P:.6g} N/m)"
        )
    return ParameterError(error.name, error.value, error.allowed, f"{error} {about}")
