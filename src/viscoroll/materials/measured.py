"""The data that a material was fitted to: :class:`Measured`."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..core.checks import check_array, check_number, check_text
from ..core.errors import ParameterError, described_error
from .shift import check_fields

#: Ratio of the highest angular frequency that a contact needs, rad/s, to its transit frequency, 1/s.  Data that end
#: there leave an error of M of 3 to 8 % (docs/validity.md), as data do that begin at the transit frequency.
HIGHEST_RATE = 3.0


@dataclass(frozen=True)
class Measured:
    """The data that a :class:`Material` was fitted to, and the misfit of the fit.

    Parameters
    ----------
    low, high : first and last angular frequency of the data at the temperature of the material, rad/s, 0 < low <= high.
    misfit : root mean square of the relative errors of storage or loss modulus, whichever is larger, dimensionless, >=
        0.
    source : text that names the source of the data.
    M_error : accuracy of the rolling moment by the data: pairs (transit frequency of a contact, 1/s, ascending;
        relative error of M as +-, dimensionless); fits give it, (): not known.
    strain : amplitude of engineering strain of the test, dimensionless, > 0 (0.001 is 0.1 %); None: it is not known.

    Raises
    ------
    ParameterError
        A value that is not finite or out of range, low above high, frequencies of ``M_error`` that do not ascend.

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
        """Check the fields, and replace the numbers by floats in rad/s; a value with a unit is converted.

        Raises ParameterError as the class states, and for a source that is no text, or has NUL or surrogates.
        """
        check_fields(self, "rad s-1", low=0.0, high=0.0)
        object.__setattr__(self, "misfit", check_number("misfit", self.misfit, low=0.0))
        if self.low > self.high:
            raise ParameterError("high", self.high, f">= low = {self.low:g}")
        check_text("source", self.source)
        pairs = check_array("M_error", self.M_error, low=0.0).reshape(-1, 2)
        if not (np.diff(pairs[:, 0]) > 0.0).all():
            raise described_error("M_error", "has frequencies that do not ascend", "pairs (transit frequency, +-)")
        object.__setattr__(self, "M_error", tuple(map(tuple, pairs.tolist())))
        if self.strain is not None:
            check_fields(self, "1", strain=0.0)

    @property
    def transit_band(self) -> tuple[float, float]:
        """(lowest, highest) transit frequency, 1/s, of a contact for which the data suffice: ``low``, and ``high``
        divided by :data:`HIGHEST_RATE`; the first is above the second of data over less than that ratio.

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
        rate : transit frequency |V|/length of a contact, 1/s, >= 0, of any shape, not checked: the ``value`` of
            ``validity(V).measured``.

        Returns
        -------
        array
            Relative error of M as +-, dimensionless, in that shape: infinite outside :attr:`transit_band`, NaN where
            ``M_error`` is not known.

        Examples
        --------
        >>> import viscoroll as vr
        >>> band = vr.Measured(low=0.1, high=300.0, misfit=0.004, M_error=((0.1, 0.1), (100.0, 0.04)))
        >>> band.moment_error([0.1, 100.0, 200.0])
        array([0.1 , 0.04,  inf])
        """
        low, high = self.transit_band
        rates = np.asarray(rate, np.float64)
        if not self.M_error:
            return np.full(rates.shape, np.nan)
        at, error = np.transpose(self.M_error)
        inside = (rates >= low) & (rates <= high)
        found = np.interp(np.log(np.where(inside, rates, low)), np.log(at), error)
        return np.where(inside, found, np.inf)

    def shifted(self, a_T: float) -> Measured:
        """Return the measured band at another temperature.

        Parameters
        ----------
        a_T : factor of all times from the temperature of the band to the other one, dimensionless, > 0.

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
        source = f" ({self.source})" if self.source else ""
        return f"{self.low:.3g} to {self.high:.3g} rad/s, misfit {100.0 * self.misfit:.2g} %{source}"
