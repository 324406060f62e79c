"""The units of a cylinder: what each dimensionless quantity is multiplied by, and drives over their units."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..checks import checked
from ..drive import Feedback, refuse_more_than_t, slope_factor
from ..errors import ParameterError
from ..scale import Scale

#: of ``viscoroll.cylinder``, which stands above this room
Cylinder = Any


def units_of(cylinder: Cylinder, slope: Any = None) -> Scale:
    """Those of a cylinder; on a slope the load is P cos(slope), over which kappa and l0 are too.

    Raises
    ------
    ParameterError
        A slope that is too steep.
    """
    _, share = slope_factor(slope)
    load, l0 = cylinder.load * share, cylinder.l0 * np.sqrt(share)
    return Scale(cylinder.R, cylinder.T_ref, load, cylinder.m, l0, cylinder.E_prime)


def over(name: str, given: Any, one: Scale) -> Any:
    """A number, an array, a schedule or a feedback in SI units, over its unit and that of time.

    Raises
    ------
    ParameterError
        What is not numeric or not finite, a brake or a time below 0, arrays where numbers belong.
    """
    if given is None:
        return None
    unit, low = np.asarray(one[name]), 0.0 if name == "brake" else -np.inf
    if isinstance(given, Feedback):
        return Feedback(over(name, given.value, one), given.V * one["V"] / unit, given.omega * one["omega"] / unit)
    if callable(given):
        if unit.ndim:
            raise ParameterError(name, "a function", "a number", f"{name} is a function: the cylinder must be one then")
        refuse_more_than_t(name, given)
        return lambda t: checked(f"{name}(t)", given(t * one["t"]), low=low) / unit
    if isinstance(given, tuple) and len(given) == 2:
        times, values = checked(f"times of {name}", given[0], low=0.0), checked(f"values of {name}", given[1], low=low)
        return times / one["t"], values / (unit[:, np.newaxis] if unit.ndim else unit)
    value = checked(name, given, low=low) / unit
    return value if value.ndim else float(value)


def in_words(error: ParameterError, one: Scale) -> ParameterError:
    """A refusal of the dimensionless call, with what its values are over."""
    if np.ndim(one["V"]) or np.ndim(one["force"]):
        about = "(dimensionless)"
    else:
        units = f"times over {one['t']:.6g} s, speeds over {one['V']:.6g} m/s, forces over {one['force']:.6g} N/m"
        about = f"(dimensionless: {units})"
    return ParameterError(error.name, error.value, error.allowed, f"{error} {about}")
