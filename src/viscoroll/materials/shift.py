"""Time-temperature shifts: :class:`WLF` and :class:`Arrhenius`, temperature in degrees Celsius -> a_T.

Every time of a material is a_T times that at the reference temperature T0.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from ..core.checks import number
from ..core.errors import ParameterError
from ..core.scale import SI, Units

#: J/(mol K), exact since 2019
GAS_CONSTANT = 8.31446261815324
#: degrees Celsius
ABSOLUTE_ZERO = -273.15


@dataclass(frozen=True, kw_only=True)
class WLF:
    """log10 a_T = -C1 (T - T0)/(C2 + T - T0), of M. Williams, R. Landel and J. Ferry (1955).

    Parameters
    ----------
    T0 : reference temperature, degrees Celsius, at which a_T = 1.
    C1 : > 0; the defaults are the "universal" pair, which holds at the glass transition.
    C2 : K, > 0.

    Raises
    ------
    ParameterError
        A value that is not finite or out of range; when called, a temperature at or below the pole T0 - C2,
        or so near that no double holds a_T.
    """

    T0: float
    C1: float = 17.44
    C2: float = 51.6

    def __post_init__(self) -> None:
        keep(self, T0=-math.inf, C1=0.0, C2=0.0)

    def __call__(self, temperature: float) -> float:
        """a_T at a temperature in degrees Celsius."""
        above = number("temperature", temperature, unit=SI) - self.T0
        if self.C2 + above <= 0.0:
            allowed = f"> T0 - C2 = {self.T0 - self.C2:g}, the pole of WLF, in degrees Celsius"
            raise ParameterError("temperature", temperature, allowed)
        return _shift(temperature, -math.log(10.0) * self.C1 * above / (self.C2 + above))


@dataclass(frozen=True, kw_only=True)
class Arrhenius:
    """ln a_T = (energy/R_gas) (1/T - 1/T0), with both temperatures in kelvin.

    Parameters
    ----------
    energy : activation energy, J/mol, > 0.
    T0 : reference temperature, degrees Celsius, at which a_T = 1.

    Raises
    ------
    ParameterError
        A value that is not finite or out of range; when called, a temperature at or below -273.15,
        or so low that no double holds a_T.
    """

    energy: float
    T0: float

    def __post_init__(self) -> None:
        keep(self, energy=0.0, T0=ABSOLUTE_ZERO)

    def __call__(self, temperature: float) -> float:
        """a_T at a temperature in degrees Celsius."""
        kelvin = number("temperature", temperature, unit=SI, low=ABSOLUTE_ZERO, strict=True) - ABSOLUTE_ZERO
        return _shift(temperature, self.energy / GAS_CONSTANT * (1.0 / kelvin - 1.0 / (self.T0 - ABSOLUTE_ZERO)))


def keep(given: Any, unit: Units = SI, **lows: float) -> None:
    """Have numbers above these in place of what a frozen dataclass was given for its fields; raises ParameterError.

    ``unit`` : of all of them, or what has units by name.
    """
    for name, low in lows.items():
        object.__setattr__(given, name, number(name, getattr(given, name), unit=unit, low=low, strict=low > -math.inf))


def _shift(temperature: float, exponent: float) -> float:
    if not abs(exponent) < 700.0:
        raise ParameterError("temperature", temperature, f"nearer to T0: a_T = exp({exponent:.3g}) is no double")
    return math.exp(exponent)
