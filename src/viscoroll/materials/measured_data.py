"""Data that a material was fitted to (:class:`Measured`), and its time-temperature shifts.

A shift is a function of the temperature in degrees Celsius, :class:`WLF`, :class:`Arrhenius` or
:class:`ShiftFactors`.  It returns a_T, dimensionless: from the reference temperature T0, where a_T
is 1, to this temperature all times of the material are multiplied by a_T.  A vertical shift b_T
multiplies all moduli in the same way.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, Literal, TypeVar

import numpy as np

from ..core import (
    SI,
    ParameterError,
    Units,
    check_array,
    check_number,
    check_text,
    describe_value,
    described_error,
    warn_of_model,
)

# --- Time-temperature shifts ---

#: molar gas constant, J/(mol K); exact since the SI of 2019
GAS_CONSTANT = 8.31446261815324
#: absolute zero, degrees Celsius; exact
ABSOLUTE_ZERO = -273.15
#: temperatures between which rubbers and polymers are measured and used, degrees Celsius.  300 K
#: lies above; room temperature converted twice, 27 - 273 = -246, lies below; 200 K is below nearly
#: every glass transition, so that a number above 200 is more likely in kelvin
USUAL_RANGE = -150.0, 200.0
#: K; distance from the temperatures of found factors up to which they are used: that within which
#: sweeps are one
NEAR = 0.5
#: decades by which a fitted law may miss a found factor before it warns: a quarter of the speed
_FAR_OFF = 0.1
#: K; bounds of C2 - (T0 - lowest temperature) of a fitted WLF: at the lower one the pole is beside
#: the data, at the upper one log a_T is a straight line
_GAP = 1.0, 1e4


class _ShiftLaw:
    """A time-temperature shift with a pole: ln a_T = slope (1/(T - pole) - 1/(T0 - pole)).

    The law of Arrhenius is that of Williams, Landel and Ferry with its pole at absolute zero.
    """

    def __post_init__(self: Any) -> None:
        """Check T0, degrees Celsius, and the other fields, which must be > 0."""
        check_fields(self, *(name for name in vars(self) if name != "T0"))
        vars(self)["T0"] = check_celsius("T0", self.T0)

    def __call__(self: Any, temperature: float) -> float:
        """Return a_T, a float, dimensionless, > 0, which is 1 at T0.

        temperature: a number in degrees Celsius, or a value with a unit of temperature, which is
        converted.
        Raises ParameterError and warns as the class states.
        """
        found = check_celsius("temperature", temperature)
        above = found - self.pole
        if above <= 0.0:
            raise ParameterError(
                "temperature",
                temperature,
                f"above T0 - C2 = {self.pole:g} °C, where the WLF shift is infinite",
            )
        # the difference of the reciprocals, without cancellation near T0
        exponent = self.slope * (self.T0 - found) / (above * (self.T0 - self.pole))
        if not abs(exponent) < 700.0:
            allowed = f"nearer to T0 = {self.T0} °C: a_T = exp({exponent:.3g}) is out of range"
            raise ParameterError("temperature", temperature, allowed)
        return math.exp(exponent)


@dataclass(frozen=True, kw_only=True)
class WLF(_ShiftLaw):
    """log10 a_T = -C1 (T - T0)/(C2 + T - T0), of M. Williams, R. Landel and J. Ferry (1955).

    Parameters
    ----------
    T0 : reference temperature, degrees Celsius, at which a_T = 1.
    C1 : > 0; the defaults are the "universal" pair, which holds at the glass transition.
    C2 : K, > 0.

    Raises
    ------
    ParameterError
        A value that is not finite or out of range; when called, a temperature at or below the pole
        T0 - C2, or so near that no double holds a_T.

    Warns
    -----
    ModelWarning
        A temperature outside -150 to 200: it looks like one in kelvin (:data:`USUAL_RANGE`).

    Examples
    --------
    >>> import viscoroll as vr
    >>> shift = vr.WLF(C1=8.86, C2=101.6, T0=20.0)
    >>> shift(20.0), shift(0.0) > 1.0
    (1.0, True)
    """

    T0: float
    C1: float = 17.44
    C2: float = 51.6

    @property
    def pole(self) -> float:
        """Temperature T0 - C2 at which a_T is infinite, degrees Celsius."""
        return self.T0 - self.C2

    @property
    def slope(self) -> float:
        """Slope of ln a_T over 1/(T - pole), K, > 0."""
        return math.log(10.0) * self.C1 * self.C2


@dataclass(frozen=True, kw_only=True)
class Arrhenius(_ShiftLaw):
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

    Warns
    -----
    ModelWarning
        A temperature outside -150 to 200: it looks like one in kelvin (:data:`USUAL_RANGE`).

    Examples
    --------
    >>> import viscoroll as vr
    >>> shift = vr.Arrhenius(energy=5e4, T0=20.0)
    >>> shift(20.0), shift(60.0) < 1.0
    (1.0, True)
    """

    energy: float
    T0: float

    @property
    def pole(self) -> float:
        """Temperature at which a_T is infinite, absolute zero, degrees Celsius."""
        return ABSOLUTE_ZERO

    @property
    def slope(self) -> float:
        """Slope of ln a_T over 1/(T - pole), K, > 0."""
        return self.energy / GAS_CONSTANT


_Law = TypeVar("_Law", WLF, Arrhenius)
#: b_T, by which moduli are multiplied: a function of a temperature in degrees Celsius, or the
#: absolute temperature
VerticalShift = Callable[[float], float] | Literal["entropic"] | None


@dataclass(frozen=True, kw_only=True)
class ShiftFactors:
    """Factors a_T found at some temperatures, as a function between them.

    ln a_T is interpolated in the temperature, by a monotone piecewise cubic (PCHIP).

    Parameters
    ----------
    temperature : temperatures, ascending, degrees Celsius, (n,).
    a_T : factor of all times at each of them, dimensionless, > 0, (n,).
    T0 : reference temperature, degrees Celsius, at which a_T = 1.

    Raises
    ------
    ParameterError
        Values out of range, temperatures that do not ascend or lack a factor; when called, one
        that is more than 0.5 K outside of the found ones.

    Warns
    -----
    ModelWarning
        A temperature outside -150 to 200: it looks like one in kelvin (:data:`USUAL_RANGE`).

    Examples
    --------
    >>> import viscoroll as vr
    >>> found = vr.ShiftFactors(temperature=(0.0, 20.0, 40.0), a_T=(100.0, 1.0, 0.05), T0=20.0)
    >>> round(found(20.0), 12), 1.0 < found(10.0) < 100.0
    (1.0, True)

    Factors that follow a WLF law are within 3 % of it half way between temperatures 10 K apart
    (``tests/test_dma.py``).
    """

    temperature: tuple[float, ...]
    a_T: tuple[float, ...]
    T0: float

    def __post_init__(self) -> None:
        """Check the fields, and replace them by floats and tuples of floats."""
        T = check_array("temperature", self.temperature, unit="degC", above=ABSOLUTE_ZERO)
        a_T = check_array("a_T", self.a_T, above=0.0)
        if T.ndim != 1 or not T.size or T.shape != a_T.shape or (np.diff(T) <= 0.0).any():
            found = f"= {T}, and a_T has shape {a_T.shape}"
            raise described_error("temperature", found, "an ascending list with one a_T for each")
        T0 = check_number("T0", self.T0, unit="degC", above=ABSOLUTE_ZERO)
        vars(self).update(temperature=tuple(T.tolist()), a_T=tuple(a_T.tolist()), T0=T0)

    def __call__(self, temperature: float) -> float:
        """Return a_T as :meth:`_ShiftLaw.__call__` does, with the errors that the class states."""
        found = check_celsius("temperature", temperature)
        low = self.temperature[0]
        high = self.temperature[-1]
        if not low - NEAR <= found <= high + NEAR:
            raise ParameterError(
                "temperature",
                temperature,
                f"from {low - NEAR} to {high + NEAR} °C, the range of these factors; beyond, use "
                "the WLF or Arrhenius law that .wlf() or .arrhenius() of these ShiftFactors fits",
            )
        if low == high:
            return self.a_T[0]
        return math.exp(self._ln(found))

    @functools.cached_property
    def _ln(self) -> Any:
        """The interpolated ln a_T, a function of the temperature."""
        from scipy import interpolate

        return interpolate.PchipInterpolator(self.temperature, np.log(self.a_T))

    def wlf(self) -> WLF:
        """Fit the law of Williams, Landel and Ferry to the factors, so that other temperatures need
        no new fit.

        The least squares are those of log10 a_T, which is 0 at T0.

        Returns
        -------
        WLF
            With the T0 of the factors.

        Raises
        ------
        ParameterError
            Fewer than three temperatures; factors that rise with temperature.

        Warns
        -----
        ModelWarning
            Where the law misses a factor by more than 0.1 decades.

        Examples
        --------
        >>> import viscoroll as vr
        >>> shift = vr.WLF(C1=8.86, C2=101.6, T0=20.0)
        >>> at = 0.0, 10.0, 20.0, 30.0
        >>> law = vr.ShiftFactors(temperature=at, a_T=tuple(map(shift, at)), T0=20.0).wlf()
        >>> round(law.C1, 4), round(law.C2, 3)
        (8.86, 101.6)
        """
        from scipy import optimize

        above, logs = self._points(3)
        # C2 must exceed it, so that C2 + T - T0 is > 0 at the lowest temperature
        gap = max(0.0, float(-above.min()))

        def constants(free: Any) -> Any:
            """Return (C1, C2) from [ln(C1/C2), ln(C2 - gap)]."""
            C2 = gap + np.exp(free[1])
            return C2 * np.exp(free[0]), C2

        def errors(free: Any) -> Any:
            """Return the errors of log10 a_T, (n,)."""
            C1, C2 = constants(free)
            return -C1 * above / (C2 + above) - logs

        low, high = np.log(_GAP)
        # C1/C2 is the slope of -log10 a_T at T0, here the mean slope over the temperatures
        start = math.log((logs[0] - logs[-1]) / (above[-1] - above[0])), 0.5 * (low + high)
        found = optimize.least_squares(
            errors, start, bounds=([-np.inf, low], [np.inf, high]), xtol=1e-12, ftol=1e-12
        )
        C1, C2 = constants(found.x)
        return self._told(WLF(C1=C1, C2=C2, T0=self.T0))

    def arrhenius(self) -> Arrhenius:
        """Fit the law of Arrhenius to the factors, as :meth:`wlf` does its own.

        Returns
        -------
        Arrhenius
            With the T0 of the factors.

        Raises
        ------
        ParameterError
            Fewer than two temperatures; factors that rise with temperature.

        Warns
        -----
        ModelWarning
            Where the law misses a factor by more than 0.1 decades.

        Examples
        --------
        >>> import viscoroll as vr
        >>> shift = vr.Arrhenius(energy=5e4, T0=20.0)
        >>> found = vr.ShiftFactors(temperature=(0.0, 20.0), a_T=(shift(0.0), 1.0), T0=20.0)
        >>> round(found.arrhenius().energy, 3)
        50000.0
        """
        above, logs = self._points(2)
        kelvin = self.T0 - ABSOLUTE_ZERO
        slower = 1.0 / (kelvin + above) - 1.0 / kelvin
        energy = GAS_CONSTANT * math.log(10.0) * (slower @ logs) / (slower @ slower)
        return self._told(Arrhenius(energy=energy, T0=self.T0))

    def _points(self, fewest: int) -> tuple[Any, Any]:
        """Return (temperature - T0, K; log10 a_T), (n,) each, to which a law can be fitted.

        fewest: least number of temperatures.
        Raises ParameterError for fewer temperatures, and for factors that do not fall from the
        first to the last.
        """
        if len(self.a_T) < fewest:
            allowed = f"a list of at least {fewest} (WLF needs 3 temperatures, Arrhenius 2)"
            raise described_error("temperature", f"has length {len(self.a_T)}", allowed)
        if not self.a_T[-1] < self.a_T[0]:
            low, *_, high = (f"{a_T:.3g} at {T:g} °C" for T, a_T in zip(self.temperature, self.a_T))
            found = f"{low}, {high}"
            raise ParameterError("a_T", found, "shift factors that fall with temperature")
        return np.subtract(self.temperature, self.T0), np.log10(self.a_T)

    def _told(self, law: _Law) -> _Law:
        """Return a fitted ``law`` as it is; give a ModelWarning if it misses one of the factors
        a_T by more than :data:`_FAR_OFF`, 0.1 decades.
        """
        errors = [math.log10(law(T) / a_T) for T, a_T in zip(self.temperature, self.a_T)]
        worst = int(np.argmax(np.abs(errors)))
        if abs(errors[worst]) > _FAR_OFF:
            warn_of_model(
                f"the fitted {law} gives {10.0 ** errors[worst]:.3g} times the factor found at "
                f"{self.temperature[worst]:g} °C: use the ShiftFactors themselves as shift"
            )
        return law


def check_celsius(name: str, temperature: Any) -> float:
    """Return a temperature as a number of degrees Celsius, and warn of one that looks like kelvin.

    name: name of the parameter, for the error and the warning.
    temperature: number of degrees Celsius, or a value with a unit of temperature, which is
        converted; above absolute zero.
    Returns a float, degrees Celsius.  Raises ParameterError for what is no number above -273.15.
    Warns with ModelWarning outside :data:`USUAL_RANGE`, by a text without the value.
    """
    found = check_number(name, temperature, unit="degC", above=ABSOLUTE_ZERO)
    low, high = USUAL_RANGE
    if not low <= found <= high:
        warn_of_model(
            f"{name} is outside {low:g} to {high:g} degrees Celsius: the number looks "
            "like kelvin, or like a value that was converted twice, but is taken as it is"
        )
    return found


def relative_shift(
    shift: Callable[[float], float], temperature: float, reference: float | None
) -> float:
    """Return the ratio of times at a temperature to those at a reference,
    a_T(temperature)/a_T(reference).

    The ratio is the same whatever temperature the constants of a shift refer to: WLF and Arrhenius
    keep their form (J. D. Ferry, Viscoelastic Properties of Polymers, 3rd ed., 1980, Ch. 11).

    shift: function of a temperature in degrees Celsius that returns a_T, a number, dimensionless,
        > 0.
    temperature, reference: degrees Celsius; None: the temperature at which the shift is 1.
    Returns the ratio, a float, dimensionless, > 0; 1.0 if both temperatures are None.
    Raises ParameterError for a temperature that the shift does not allow, a shift that returns no
    finite positive number, and a ratio that no double holds.  Other exceptions of the shift, and
    its warnings, pass.
    """
    factor, unit = (
        1.0 if at is None else check_number(f"shift({at})", shift(at), above=0.0)
        for at in (temperature, reference)
    )
    return check_number(f"shift({temperature})/shift({reference})", factor / unit, above=0.0)


def vertical_factor(shift: VerticalShift, temperature: float, reference: float | None) -> float:
    """Return the ratio of moduli at a temperature to those at a reference,
    b_T(temperature)/b_T(reference).

    shift: a function of a temperature in degrees Celsius that returns b_T, a number, dimensionless,
        > 0; "entropic": b_T is the absolute temperature, as for an ideal network; None: moduli do
        not depend on the temperature.
    temperature, reference: degrees Celsius; a reference of None is allowed only without a vertical
        shift.
    Returns the ratio, a float, dimensionless, > 0; 1.0 for None.
    Raises ParameterError for a reference of None, and a shift that returns no finite number > 0.
    """
    if shift is None:
        return 1.0
    if reference is None:
        raise ParameterError(
            "temperature",
            None,
            "given",
            "a Material with vertical_shift needs temperature= (in a file: reference =), in °C, at "
            "which E was measured",
        )
    b_T = (lambda at: at - ABSOLUTE_ZERO) if shift == "entropic" else shift
    factor, unit = (
        check_number(f"vertical_shift({at})", b_T(at), above=0.0) for at in (temperature, reference)
    )
    return factor / unit


def check_fields(instance: Any, *names: str, unit: Units = SI) -> None:
    """Check that fields of a frozen dataclass are numbers > 0, and replace them by floats in their
    unit.

    instance: the dataclass, whose fields are changed in place, one after another up to an error.
    names: names of the fields.
    unit: unit of all these fields, as "rad s-1", or an object with units by name, as SI (default).
    Raises ParameterError for the first field that is no such finite number (also None, an array).
    """
    for name in names:
        vars(instance)[name] = check_number(name, getattr(instance, name), unit=unit, above=0.0)


# --- The data that a material was fitted to ---

#: Ratio of the highest angular frequency that a contact needs, rad/s, to its transit frequency,
#: 1/s.  Data that end there leave an error of M of 3 to 8 % (docs/validity.md), as data do that
#: begin at the transit frequency.
HIGHEST_RATE = 3.0


@dataclass(frozen=True)
class Measured:
    """The data that a :class:`Material` was fitted to, and the misfit of the fit.

    Parameters
    ----------
    low, high : first and last angular frequency of the data at the temperature of the material,
        rad/s, 0 < low <= high.
    misfit : root mean square of the relative errors of storage or loss modulus, whichever is
        larger, dimensionless, >= 0.
    source : text that names the source of the data.
    M_error : accuracy of the rolling moment by the data: pairs (transit frequency of a contact,
        1/s, ascending; relative error of M as +-, dimensionless); fits give it, (): not known.
    strain : amplitude of engineering strain of the test, > 0 (0.001 is 0.1 %); None: not known.

    Raises
    ------
    ParameterError
        A value that is not finite or out of range, low above high, frequencies of ``M_error`` that
        do not ascend.

    Examples
    --------
    >>> import viscoroll as vr
    >>> band = vr.Measured(low=0.06, high=630.0, misfit=0.004, source="dma.csv")
    >>> print(band)
    0.06 to 630 rad/s, misfit 0.4 % (dma.csv)
    """

    low: float
    high: float
    misfit: float
    source: str = ""
    M_error: tuple[tuple[float, float], ...] = ()
    strain: float | None = None

    def __post_init__(self) -> None:
        """Check the fields, and replace the numbers by floats, converted to rad/s; a source that is
        no text, or has NUL or surrogates, is refused too.
        """
        check_fields(self, "low", "high", unit="rad s-1")
        vars(self)["misfit"] = check_number("misfit", self.misfit, low=0.0)
        if self.low > self.high:
            raise ParameterError("high", self.high, f">= low = {self.low} (both in rad/s)")
        check_text("source", self.source)
        pairs = check_array("M_error", self.M_error, low=0.0)
        if pairs.size % 2 or not (np.diff(pairs.ravel()[::2]) > 0.0).all():
            allowed = "pairs (transit frequency in 1/s, relative error of M), frequencies ascending"
            raise ParameterError("M_error", describe_value(self.M_error), allowed)
        vars(self)["M_error"] = tuple(map(tuple, pairs.reshape(-1, 2).tolist()))
        if self.strain is not None:
            check_fields(self, "strain", unit="1")

    @property
    def transit_band(self) -> tuple[float, float]:
        """(Lowest, highest) transit frequency, 1/s, of a contact for which the data suffice.

        They are ``low``, and ``high`` divided by :data:`HIGHEST_RATE`, since M depends on moduli at
        frequencies up to that many times the transit frequency.  Where the data span a smaller
        ratio, the first exceeds the second, and they suffice for no contact.

        Examples
        --------
        >>> import viscoroll as vr
        >>> vr.Measured(low=0.1, high=150.0, misfit=0.004).transit_band
        (0.1, 50.0)
        """
        return self.low, self.high / HIGHEST_RATE

    def moment_error(self, rate: Any) -> Any:
        """Return the accuracy of the rolling moment at transit frequencies, by the data alone.

        It is the largest change of M by any spectrum that meets the data as well as the fit does
        (:attr:`viscoroll.Fit.admissible`), interpolated in ln(rate).

        Parameters
        ----------
        rate : transit frequency |V|/length of a contact, 1/s, >= 0, of any shape, not checked: the
            ``value`` of ``validity(V).measured``.

        Returns
        -------
        array
            Relative error of M as +-, dimensionless, in that shape: infinite outside
            :attr:`transit_band`, NaN where ``M_error`` is not known.

        Examples
        --------
        >>> import viscoroll as vr
        >>> band = vr.Measured(
        ...     low=0.1, high=300.0, misfit=0.004, M_error=((0.1, 0.1), (100.0, 0.04))
        ... )
        >>> band.moment_error([0.1, 100.0, 200.0])
        array([0.1 , 0.04,  inf])
        """
        low, high = self.transit_band
        rates = np.asarray(rate, np.float64)
        if not self.M_error:
            return np.full(rates.shape, np.nan)
        at, error = np.transpose(self.M_error)
        inside = (rates >= low) & (rates <= high)
        # ``low`` in place of rates outside, whose logarithm may be infinite
        found = np.interp(np.log(np.where(inside, rates, low)), np.log(at), error)
        return np.where(inside, found, np.inf)

    def shifted(self, a_T: float) -> Measured:
        """Return the measured band at another temperature.

        Parameters
        ----------
        a_T : factor of all times from the temperature of the band to the other one, dimensionless,
            > 0.

        Returns
        -------
        Measured
            A new one, whose frequencies are divided by ``a_T``; misfit, source and errors stay.

        Raises
        ------
        ParameterError
            A factor with which a frequency is 0, negative, infinite or NaN.
        ZeroDivisionError
            The float 0.0.

        Examples
        --------
        >>> import viscoroll as vr
        >>> vr.Measured(low=0.1, high=100.0, misfit=0.004).shifted(10.0).high
        10.0
        """
        moved = tuple((rate / a_T, error) for rate, error in self.M_error)
        return replace(self, low=self.low / a_T, high=self.high / a_T, M_error=moved)

    def __str__(self) -> str:
        """Return band, misfit, accuracy of M and source in one line."""
        source = f" ({self.source})" if self.source else ""
        errors = [100.0 * error for _, error in self.M_error]
        M = f", error of moment M +-{min(errors):.3g} to +-{max(errors):.3g} %" if errors else ""
        return (
            f"{self.low:.3g} to {self.high:.3g} rad/s, misfit {100.0 * self.misfit:.2g} %"
            f"{M}{source}"
        )
