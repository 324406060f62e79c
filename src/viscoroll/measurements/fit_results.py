"""Results of the fits of measured moduli: :class:`Fit`, :class:`RelaxationFit`, and their base
:class:`SeriesFit`.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass, replace
from typing import Any, Literal, NamedTuple

import numpy as np

from ..contact_mechanics import (
    MISFIT_LIMIT,
    Assumption,
    assess_measured_band,
    contact,
    transit_frequency,
)
from ..core import (
    ArrayLike,
    Booleans,
    Dataset,
    Floats,
    Numbers,
    Result,
    check_array,
    described_error,
    warn_of_model,
)
from ..core.plots.result_figures import series_fit
from ..materials import WLF, Material, Measured, Prony, VerticalShift, check_poisson
from ..rollers import Cylinder
from .dynamic_moduli import UNITS, Curve, Data, KramersKronig, Relaxation, spectrum_of
from .identification_report import summarize_fit
from .master_curve import Shifts
from .spectrum import admissible_spectra, has_plateau

# --- Results of the fits of measured moduli ---

#: which modulus was measured
Mode = Literal["tension", "shear"]


class Misfit(NamedTuple):
    """Root mean square of the relative errors of storage and loss modulus, dimensionless (0.01 is 1
    %).
    """

    storage: float
    loss: float


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class SeriesFit(Result):
    """A Prony series fitted to measured moduli: the base of :class:`Fit` and
    :class:`RelaxationFit`.

    E : long-time modulus, in the unit of the data; of tension or of shear, as ``mode`` says.
    T_ref : the longest time, s; times of ``prony`` are in units of it.  1 where the series has no
    mode.
    prony : the series, strengths divided by E, the same for both moduli, since Poisson's ratio is
        taken constant in time.
    mode : "tension" (E', E'', E(t)) or "shear" (G', G'', G(t)): the modulus of the data, of E and
        of :meth:`modulus`.
    target : the misfit that was requested, a root mean square of relative errors, dimensionless.
    reached : whether it is reached.
    outside : for each mode of ``prony`` whether its time lies outside of 1/omega, or of t, of the
    data, shape (modes,).
    band : (lowest, highest) angular frequency of the data, rad/s; of relaxation (1/last time,
    1/first time).
    points : number of points that were measured; above 1000 the means of 500 logarithmic bins were
        fitted, and they are the data and the misfit here.
    grid : shortest and longest time that the fit was allowed, s.
    temperature : temperature of the fit, degrees Celsius, None where it is not known.
    source : source of the data, in words.
    misfit : root mean square of the relative errors, dimensionless: a :class:`Misfit` of storage
        and loss, or one number of relaxation.
    """

    E: float
    T_ref: float
    prony: Prony
    mode: Mode
    target: float
    reached: bool
    outside: Booleans
    band: tuple[float, float]
    points: int
    grid: tuple[float, float]
    temperature: float | None = None
    source: str = ""

    misfit: Any = None

    @property
    def data(self) -> Data:
        """The data that were fitted, a :class:`.dynamic_moduli.Curve` or a
        :class:`.dynamic_moduli.Relaxation`.
        """
        raise NotImplementedError

    @property
    def symbols(self) -> list[str]:
        """Symbols of the measured moduli: ["E'", "E''"] or ["E(t)"]; G in place of E where they are
        of shear.
        """
        signs = ["(t)"] if hasattr(self, "t") else ["'", "''"]
        symbol = "G" if self.mode == "shear" else "E"
        return [symbol + sign for sign in signs]

    def misfit_text(self, digits: int) -> str:
        """Return the misfit of each modulus in words, as "0.35% in E', 0.80% in E''".

        Parameters
        ----------
        digits : number of digits after the decimal point of the per cent, an int >= 0.

        Returns
        -------
        str
            Two parts for storage and loss, separated by a comma; one part for relaxation.

        Examples
        --------
        >>> import viscoroll as vr
        >>> vr.fit_prony(vr.read_dma(vr.datasets.path("dma.csv"))).misfit_text(1)
        "0.4% in E', 0.4% in E''"
        """
        return ", ".join(
            f"{misfit:.{digits}%} in {symbol}"
            for misfit, symbol in zip(np.atleast_1d(self.misfit), self.symbols)
        )

    @property
    def largest_misfit(self) -> float:
        """The misfit, a root mean square of relative errors, dimensionless; of storage and loss the
        larger one.
        """
        return float(np.max(self.misfit))

    @property
    def _fault(self) -> str:
        """Words on a misfit that misses the target or is above 5 %; "" where it does neither."""
        limit = f"{MISFIT_LIMIT:.0%}" if self.reached else f"the target of {self.target:.2%}"
        if self.reached and self.largest_misfit <= MISFIT_LIMIT:
            return ""
        return (
            f"the misfit of {self.largest_misfit:.2%} (rms relative error of the moduli) is above "
            f"{limit}"
        )

    @property
    def alpha(self) -> float:
        """Instantaneous divided by long-time modulus, dimensionless."""
        return self.prony.alpha

    @property
    def plateau(self) -> bool:
        """Whether the data determine E, which is then above the least that is allowed (1 % of the
        lowest modulus).
        """
        return has_plateau(self.data, self.E)

    @functools.cached_property
    def admissible(self) -> Any:
        """Spectra that meet the data as well as this fit, with the smallest and the largest M at
        each speed.

        They show what the data leave open: a property in which they differ is not determined.  It
        is of type :class:`.spectrum.AdmissibleSpectra`, with n speeds, about two a
        decade, and the fields:

        - ``rate``: transit frequencies of the contact, 1/s, (n,), over
          :attr:`viscoroll.Measured.transit_band`;
        - ``error``: accuracy of M at them as +-, relative, (n,): the largest of ``M_changes``;
        - ``M_changes``: relative change of M by each spectrum, (2 n, n);
        - ``V``, ``M``: kappa V and kappa M of this fit, dimensionless, (n,);
        - ``E``, ``alpha``: long-time modulus of each spectrum, in the unit of the data, and its
          instantaneous divided by its long-time modulus, (2 n,).

        They are computed at the first access, in some tenths of a second; n is 0 where the data
        span less than a factor of three, or nothing relaxes.
        """
        return admissible_spectra(self.data, spectrum_of(self.prony, self.E, self.T_ref))

    @property
    def measured(self) -> Measured:
        """What a material keeps of the data, a :class:`Measured`.

        It has the lowest and the highest frequency, rad/s, the misfit (of storage and loss the
        larger one), the source, or where there is none the number of points, as "25 points", and
        the accuracy of M (:attr:`admissible`).
        """
        source = self.source or f"{self.points} points"
        errors = tuple(zip(self.admissible.rate, self.admissible.error))
        low, high = self.band
        return Measured(
            low=low,
            high=high,
            misfit=self.largest_misfit,
            source=source,
            M_error=errors,
            strain=getattr(self, "strain", None),
        )

    def material(
        self,
        nu: float = 0.49,
        *,
        name: str = "",
        density: float | None = None,
        thickness: float | None = None,
    ) -> Material:
        """Return the fit as a :class:`viscoroll.Material` with its ``measured`` band and
        ``temperature``; the data must be in Pa.

        A shear modulus becomes Young's by E = 2 (1 + nu) G; ``measured.source`` then says so.

        Parameters
        ----------
        nu : Poisson's ratio, in (-1, 0.5], constant in time.
        name : name of the material, free text.
        density : density, kg/m^3, > 0; None: not known.
        thickness : thickness of the layer, m, > 0; None for a half-space.

        Returns
        -------
        viscoroll.Material
            E in Pa, times in units of ``T_ref``, s, as the fit has them.

        Raises
        ------
        ParameterError
            A value that is not finite or out of the range of :class:`viscoroll.Material`.

        Warns
        -----
        ModelWarning
            A fit that misses its target, or whose misfit is above 5 %; a ``temperature`` that looks
            like kelvin.

        Examples
        --------
        >>> import viscoroll as vr
        >>> fit = vr.fit_prony(vr.read_dma(vr.datasets.path("dma.csv")))
        >>> fit.material(nu=0.49).E == fit.E
        True
        """
        if self._fault:
            warn_of_model(
                f"{self._fault}: plot() of the fit shows fit and data, and the page 'From DMA data "
                "to rolling resistance' of the documentation lists causes"
            )
        E = self.E
        measured = self.measured
        if self.mode == "shear":
            # checked here, before Material refuses it, so that E is not made with a wrong one
            factor = 2.0 * (1.0 + check_poisson(nu))
            E *= factor
            measured = replace(
                measured, source=f"{measured.source}, shear: E = 2 (1 + nu) G = {factor:.4g} G"
            )
        return Material(
            E,
            nu,
            self.prony,
            self.T_ref,
            name=name,
            density=density,
            thickness=thickness,
            measured=measured,
            temperature=self.temperature,
            vertical_shift=getattr(self, "vertical_shift", None),
        )

    def validity(self, cylinder: Cylinder, V: Numbers) -> Assumption:
        """Return whether the data hold the frequencies that a contact with this material needs, and
        the misfit of the fit is at most 5 %.

        The transit frequency |V|/(lam l0) must lie in :attr:`viscoroll.Measured.transit_band` of
        the data, ends included, so that it does not at V = 0.  Where the material was shifted to
        another temperature (``Material.at``), the frequency is converted to that of the data.

        Parameters
        ----------
        cylinder : a :class:`viscoroll.Cylinder`, one or, with arrays, several, whose material or
            base is ``material()`` of this fit, at any temperature.
        V : speed of the axis, m/s, any sign, a number or an array of any shape.

        Returns
        -------
        Assumption
            ``value``: |V|/(lam l0), 1/s, at the temperature of the data; ``holds``: whether it lies
            in that band and the larger misfit is at most 0.05; ``sentence``: both in words.  The
            first two have the shape of V, broadcast with that of the cylinder's parameters.

        Raises
        ------
        ParameterError
            A cylinder neither of whose bodies has the series of this fit; V that is not numeric,
            NaN, infinite, of another dimension, or of a shape that does not broadcast with that of
            the cylinder.

        Examples
        --------
        >>> import viscoroll as vr
        >>> fit = vr.fit_prony(vr.read_dma(vr.datasets.path("dma.csv")))
        >>> roller = vr.Cylinder(R=0.1, m=35.5, mu=0.3, material=fit.material(nu=0.49))
        >>> fit.validity(roller, [0.1, 1.0]).holds
        array([ True,  True])
        """
        pair = getattr(cylinder, "pair", None)
        bodies = (pair.cylinder, pair.half_space) if pair else ()
        body = next((body for body in bodies if body.prony == self.prony), None)
        if body is None:
            raise described_error(
                "cylinder",
                "has no material of this fit",
                "a Cylinder with material=fit.material(nu=...)",
            )
        speed = check_array("V", V, unit="m s-1")
        lam = contact(
            cylinder.scene(), speed * (cylinder.T_ref / cylinder.R), delta=0.0, fields="lam"
        ).lam
        # times of a material at another temperature are a_T = T_ref/T_ref of the fit times as long
        seen = transit_frequency(speed, lam * cylinder.l0) * (body.T_ref / self.T_ref)
        return assess_measured_band(seen, {"the material": self.measured})

    def _moduli(self, x: ArrayLike) -> Floats:
        """Return the moduli of the fit, in the unit of the data.

        x : angular frequencies, rad/s, or of a fit of relaxation times, s, > 0, of any shape;
            perhaps with a unit; the sign is not checked.
        Returns shape (2, *x.shape), storage and loss, or (1, *x.shape), relaxation.
        Raises ParameterError for what is not numeric or not finite.
        """
        name, *moduli = self.data._fields
        points = check_array(name, x, unit=UNITS[name])
        # the spectrum reads omega or t of the data, not the moduli
        found = spectrum_of(self.prony, self.E, self.T_ref).modulus(
            self.data._replace(**{name: points.ravel()})
        )
        return found.reshape(len(moduli), *points.shape)

    def to_xarray(self) -> Dataset:
        """Return the data, the fit and its series as a dataset.

        Returns
        -------
        xarray.Dataset
            Over omega (rad/s) or t (s): the data that were fitted, storage and loss or relaxation,
            and the fit at the same points, storage_fit and loss_fit or relaxation_fit, in the unit
            of the data.  Over ``mode``: E, strengths divided by the long-time modulus, and tau, s.
            Attributes: E_long, long-time modulus in the unit of the data; T_ref, s; title; modulus,
            "tension" or "shear"; temperature of the fit, degrees Celsius, where it is known; and
            misfit_storage and misfit_loss, or misfit, root mean squares of relative errors,
            dimensionless.  The attribute ``units`` of the moduli is the text
            "unit of the data".

        Examples
        --------
        >>> import viscoroll as vr
        >>> data = vr.fit_prony(vr.read_dma(vr.datasets.path("dma.csv"))).to_xarray()
        >>> data["storage_fit"].dims, data["tau"].dims
        (('omega',), ('mode',))
        """
        import xarray as xr

        x, *names = self.data._fields
        of_data = zip(
            (*names, *(f"{name}_fit" for name in names)),
            (*self.data[1:], *self._moduli(self.data[0])),
        )
        data = {name: (x, values, {"units": "unit of the data"}) for name, values in of_data}
        data |= {
            "E": (
                "mode",
                self.prony.E,
                {"long_name": "strengths divided by the long-time modulus"},
            ),
            "tau": ("mode", self.prony.tau * self.T_ref, {"units": "s"}),
        }
        about = {
            "E_long": self.E,
            "T_ref": self.T_ref,
            "title": "Fit of a Prony series",
            "modulus": self.mode,
        }
        misfits = [f"misfit_{name}" for name in names] if len(names) > 1 else ["misfit"]
        about |= dict(zip(misfits, np.atleast_1d(self.misfit).tolist()))
        if self.temperature is not None:
            about["temperature"] = self.temperature
        return xr.Dataset(data, {x: (x, self.data[0], {"units": UNITS[x]})}, about)

    _summary = summarize_fit
    _figure = series_fit


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Fit(SeriesFit):
    """A Prony series fitted to a master curve, with its misfit and the consistency of the data.

    Attributes
    ----------
        E, T_ref, prony, mode, target, reached, outside, band, points, grid, temperature, source :
        as in ``SeriesFit``, the base class; in shear E, storage and loss are G, G' and G''.
    misfit : root mean square of the relative errors, dimensionless, ``.storage`` and ``.loss``.
    kramers_kronig : ratio of the measured loss modulus to that of the slope of the storage modulus:
        ``.omega``, rad/s, ``.ratio`` at these, dimensionless, and ``.median``, near 1 for sound
        data.
    shifts : shift factors (:class:`.master_curve.Shifts`) where temperatures were given, else None.
    omega, storage, loss : the data, sorted and shifted, (n,) each; rad/s and the unit given.
    strain : amplitude of the strain of the test, dimensionless, of a record the geometric mean;
        None: not known.
    vertical_shift : b_T by which the moduli were divided, as in :class:`viscoroll.Material`; None:
        they were not.

    Examples
    --------
    >>> import viscoroll as vr
    >>> fit = vr.fit_prony(vr.read_dma(vr.datasets.path("dma.csv")))
    >>> fit.prony.E.size, fit.misfit.loss < 0.01
    (4, True)
    >>> rubber = fit.material(nu=0.49, name="rubber")
    """

    misfit: Misfit
    kramers_kronig: KramersKronig
    shifts: Shifts | None
    omega: Floats
    storage: Floats
    loss: Floats
    strain: float | None = None
    vertical_shift: VerticalShift = None

    @property
    def data(self) -> Curve:
        """The data that were fitted, as a :class:`.dynamic_moduli.Curve`."""
        return Curve(self.omega, self.storage, self.loss)

    def wlf(self) -> WLF:
        """Fit the law of Williams, Landel and Ferry to the shift factors of the fit.

        It is :meth:`viscoroll.ShiftFactors.wlf` of ``shifts``, which has ``arrhenius()`` too, and
        is itself a shift for :meth:`Material.at` between the temperatures of the curves.

        Returns
        -------
        WLF
            A shift for any temperature, with a_T = 1 at the reference of the fit.

        Raises
        ------
        ParameterError
            A fit of fewer than three temperatures; factors that rise with temperature.

        Warns
        -----
        ModelWarning
            Where the law misses a factor by more than 0.1 decades.

        Examples
        --------
        >>> import numpy as np
        >>> import viscoroll as vr
        >>> rubber = vr.Material(
        ...     2e6, 0.5, vr.Prony([1.0, 2.0, 8.0], [1.0, 1e-2, 1e-4]), temperature=20.0
        ... )
        >>> shift, omega = vr.WLF(C1=8.86, C2=101.6, T0=20.0), np.geomspace(0.1, 100.0, 20)
        >>> curves = [rubber.at(T, shift) for T in (10.0, 20.0, 30.0)]
        >>> moduli = [m.storage(omega) for m in curves], [m.loss(omega) for m in curves]
        >>> fit = vr.fit_prony([omega] * 3, *moduli, temperature=[10.0, 20.0, 30.0])
        >>> bool(abs(fit.wlf()(0.0) / shift(0.0) - 1.0) < 0.05)
        True
        """
        if self.shifts is None:
            raise described_error(
                "temperature",
                "was not given to fit_prony, so that there are no shift factors",
                "given to it, one for each curve",
            )
        return self.shifts.wlf()

    def modulus(self, omega: ArrayLike) -> tuple[Floats, Floats]:
        """Return storage and loss modulus of the fit in the unit of the data.

        They are E' and E'', or G' and G'' where ``mode`` is "shear".

        Parameters
        ----------
        omega : angular frequencies, rad/s, > 0, finite, of any shape, also outside of the
            data.

        Returns
        -------
        storage, loss : the moduli, each of the shape of ``omega``.

        Examples
        --------
        >>> import viscoroll as vr
        >>> fit = vr.fit_prony(vr.read_dma(vr.datasets.path("dma.csv")))
        >>> storage, loss = fit.modulus([1.0, 10.0])
        >>> storage.shape
        (2,)
        """
        return tuple(self._moduli(omega))


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class RelaxationFit(SeriesFit):
    """A Prony series fitted to a relaxation modulus: the result of
    :func:`fit_series.fit_relaxation`.

    Attributes
    ----------
        E, T_ref, prony, mode, target, reached, outside, band, points, grid, temperature, source :
        as in ``SeriesFit``, the base class.
    misfit : root mean square of the relative errors, dimensionless.
    t : times of the data, ascending, s, (n,).
    relaxation : relaxation modulus of the data, in the unit given, (n,).

    Examples
    --------
    >>> import numpy as np
    >>> import viscoroll as vr
    >>> t = np.geomspace(0.01, 100.0, 30)
    >>> fit = vr.fit_relaxation(t, 1e6 * (1.0 + 2.0 * np.exp(-t / 0.5)))
    >>> fit.prony.E.round(6)
    array([2.])
    """

    misfit: float
    t: Floats
    relaxation: Floats

    @property
    def data(self) -> Relaxation:
        """The data that were fitted, as a :class:`.dynamic_moduli.Relaxation`."""
        return Relaxation(self.t, self.relaxation)

    def modulus(self, t: ArrayLike) -> Floats:
        """Return the relaxation modulus of the fit, E(t) or of shear G(t), in the unit of the data.

        Parameters
        ----------
        t : times, s, > 0, finite, of any shape, also outside of the data.

        Returns
        -------
        array
            The modulus, of the shape of ``t``.

        Examples
        --------
        >>> import numpy as np
        >>> import viscoroll as vr
        >>> t = np.geomspace(0.01, 100.0, 30)
        >>> fit = vr.fit_relaxation(t, 1e6 * (1.0 + 2.0 * np.exp(-t / 0.5)))
        >>> round(float(fit.modulus(1000.0)))
        1000000
        """
        return self._moduli(t)[0]
