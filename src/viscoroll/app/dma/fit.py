"""The fits of measured moduli, :func:`fit_prony` and :func:`fit_relaxation`, and what they hold."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, overload

import numpy as np
from numpy.typing import ArrayLike

from ...contact_law.assumptions import Assumption, measurement, passage
from ...contact_law.contact import contact
from ...core.checks import checked, number, whole
from ...core.errors import ParameterError, unknown
from ...core.plots.measured import fitted, relaxed
from ...core.results import Row, Shown
from ...core.typed import Booleans, Floats, Numbers
from ...materials.importers import poisson
from ...materials.material import Material
from ...materials.measured import Measured
from ...materials.prony import Prony
from ...materials.prony_forms import MOST_MODES, WIDEST
from ...materials.shift import celsius
from .choose import chosen
from .curve import Curve, KramersKronig, Relaxation, curve_of, data_of, kramers_kronig, thinned
from .record import DynamicModuli
from .report import card, of_dynamic, of_relaxation
from .shift import Shifts, master_curve
from .spectrum import FLOOR, Data, Spectrum, misfits

if TYPE_CHECKING:
    import xarray as xr

    from ...cylinder import Cylinder

#: highest over lowest frequency; times reach a decade beyond on either side
MOST_SPREAD = WIDEST / 100.0
Mode = Literal["tension", "shear"]
#: last over first relaxation modulus from which on it is none: noise on a plateau stays below
_RISES = 1.1


class Misfit(NamedTuple):
    """Root mean square of the relative errors of storage and loss modulus."""

    storage: float
    loss: float


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class SeriesFit(Shown):
    """A Prony series fitted to measured moduli: what :class:`Fit` and :class:`RelaxationFit` have in common.

    E : long-time modulus, in the unit of the data; of tension or of shear, as ``mode`` says.
    T_ref : the longest time, s; those of ``prony`` are counted in it.
    prony : the series, of either modulus, since Poisson's ratio is taken constant in time.
    mode : "tension" (E', E'', E(t)) or "shear" (G', G'', G(t)): which modulus the data, E and :meth:`modulus` are.
    target, reached : the misfit that was asked for, and whether it is reached.
    outside : for each mode of ``prony`` whether its time lies outside the data.
    band : first and last angular frequency of the data, rad/s; of relaxation 1 over the times.
    points : number of points that were measured; above 1000 the means of 500 logarithmic bins were fitted, and they
        are the data and the misfit here.
    grid : shortest and longest time that the fit was allowed, s.
    temperature : of the fit, degrees Celsius, where it is known.
    source : of the data, in words.
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

    @property
    def data(self) -> Data:
        """What was fitted."""
        raise NotImplementedError

    @property
    def largest_misfit(self) -> float:
        """The misfit, of storage and loss the larger one."""
        raise NotImplementedError

    @property
    def alpha(self) -> float:
        """Instantaneous over long-time modulus."""
        return self.prony.alpha

    @property
    def plateau(self) -> bool:
        """Whether E is what the data ask for, not the least that is allowed (1 % of the lowest modulus)."""
        return self.E > 1.001 * FLOOR * float(self.data.values[0].min())

    @cached_property
    def wider(self) -> tuple[Any, ...]:
        """What grids of times one and two decades wider on either side would change, no time left out.

        For each: ``decades``, ``E``, ``alpha``, ``prony`` and, at speeds ``V`` in R/T_ref whose contacts are passed
        in times that the data hold, ``M`` beside ``M_fit`` at the same load (see :class:`.wider.Wider`).
        Computed when first asked for.
        """
        from .wider import wider

        return tuple(wider(self.data, self.prony, self.E, self.T_ref, self.grid, decades) for decades in (1, 2))

    @property
    def measured(self) -> Measured:
        """The frequencies of the data, the larger misfit and the source: what a material keeps of them."""
        source = self.source or f"{self.points} points"
        return Measured(*self.band, self.largest_misfit, source)

    def material(
        self, nu: float = 0.49, *, name: str = "", density: float | None = None, thickness: float | None = None
    ) -> Material:
        """The fit as a :class:`viscoroll.Material`, ``measured`` and ``temperature`` with it; of data in Pa.

        A shear modulus becomes Young's by E = 2 (1 + nu) G; ``measured.source`` then says so.

        Parameters
        ----------
        nu : Poisson's ratio, constant in time.
        name, density, thickness : as there; density in kg/m^3, thickness in m.

        Raises
        ------
        ParameterError
            As there.
        """
        E, measured = self.E, self.measured
        if self.mode == "shear":
            factor = 2.0 * (1.0 + poisson(nu))
            E, source = E * factor, f"{measured.source}, shear: E = 2 (1 + nu) G = {factor:.4g} G"
            measured = Measured(measured.low, measured.high, measured.misfit, source)
        return Material(
            E, nu, self.prony, self.T_ref, name=name, density=density, thickness=thickness, measured=measured,
            temperature=self.temperature,
        )  # fmt: skip

    def validity(self, cylinder: Cylinder, V: Numbers) -> Assumption:
        """Whether a contact with this material sees frequencies that the data hold, and the fit is near them.

        A contact is passed in lam l0/V, which must lie within the times of the data; shifted to another temperature
        (``Material.at``), the data are shifted with it.  At its front edge every contact has a layer that is passed in
        less: modes faster than the passage act there as far as they go.

        Parameters
        ----------
        cylinder : one, or a series of them, whose material or base is ``material()`` of this fit, at any temperature.
        V : speed of the axis, m/s, any sign.

        Returns
        -------
        Assumption
            ``value``: |V|/(lam l0), 1/s, at the temperature of the data; ``holds``, of the shape of V.

        Raises
        ------
        ParameterError
            A cylinder of another series; NaN or infinite V.
        """
        bodies = cylinder.pair.cylinder, cylinder.pair.half_space
        body = next((body for body in bodies if body.prony == self.prony), None)
        if body is None:
            raise ParameterError("cylinder", "another", "with this fit's material for its material or base")
        speed = checked("V", V)
        lam = contact(cylinder.scene(), speed * (cylinder.T_ref / cylinder.R), delta=0.0, fields="lam").lam
        seen = passage(speed, lam * cylinder.l0) * (body.T_ref / self.T_ref)
        return measurement(seen, {"the material": self.measured})

    def _over_modes(self, place: str, unit: str, columns: dict[str, Floats]) -> xr.Dataset:
        """Columns over the place of the data, the series over ``mode``, and the constants as attributes."""
        import xarray as xr

        data: dict[str, Any] = {
            name: (place, values, {"units": "unit of the data"}) for name, values in columns.items()
        }
        data |= {"E": ("mode", self.prony.E, {"long_name": "strengths over the long-time modulus"})}
        data |= {"tau": ("mode", self.prony.tau * self.T_ref, {"units": "s"})}
        about = {"E_long": self.E, "T_ref": self.T_ref, "title": "Fit of a Prony series", "modulus": self.mode}
        return xr.Dataset(data, {place: (place, self.data[0], {"units": unit})}, about)

    _card = card

    def _rows(self) -> list[Row]:
        """The lines of the report on misfit and data."""
        raise NotImplementedError


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Fit(SeriesFit):
    """A Prony series fitted to a master curve, and what the data say and do not say about it.

    E, T_ref, prony, mode, ... : as of :class:`SeriesFit`; of shear E, storage and loss are G, G' and G''.
    misfit : root mean square of the relative errors, ``.storage`` and ``.loss``.
    kramers_kronig : measured over allowed loss modulus: ``.omega``, ``.ratio``, ``.median``.
    shifts : shift factors of curves at several temperatures, else None.
    omega, storage, loss : the data, sorted and shifted; rad/s and the unit given.
    """

    misfit: Misfit
    kramers_kronig: KramersKronig
    shifts: Shifts | None
    omega: Floats
    storage: Floats
    loss: Floats

    @property
    def data(self) -> Curve:
        return Curve(self.omega, self.storage, self.loss)

    @property
    def largest_misfit(self) -> float:
        return max(self.misfit)

    def modulus(self, omega: ArrayLike) -> tuple[Floats, Floats]:
        """Storage and loss modulus of the fit at angular frequencies in rad/s, in the unit of the data.

        E' and E'', or G' and G'' where ``mode`` is "shear".
        """
        own, given = Spectrum(self.E, self.prony.E * self.E, self.prony.tau * self.T_ref), np.asarray(omega, np.float64)
        storage, loss = own.modulus(Curve(given.ravel(), *2 * (np.empty(0),)))
        return storage.reshape(given.shape), loss.reshape(given.shape)

    def to_xarray(self) -> xr.Dataset:
        """Data and fit over omega, the series over ``mode``, and the constants as attributes."""
        of_fit = zip(("storage_fit", "loss_fit"), self.modulus(self.omega), strict=True)
        found = self._over_modes("omega", "rad s-1", {"storage": self.storage, "loss": self.loss, **dict(of_fit)})
        return found.assign_attrs({f"misfit_{name}": value for name, value in self.misfit._asdict().items()})

    _rows, _figure = of_dynamic, fitted


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class RelaxationFit(SeriesFit):
    """A Prony series fitted to a relaxation modulus: what :func:`fit_relaxation` returns.

    E, T_ref, prony, mode, ... : as of :class:`SeriesFit`.
    misfit : root mean square of the relative errors.
    t, relaxation : the data, sorted; s and the unit given.
    """

    misfit: float
    t: Floats
    relaxation: Floats

    @property
    def data(self) -> Relaxation:
        return Relaxation(self.t, self.relaxation)

    @property
    def largest_misfit(self) -> float:
        return self.misfit

    def modulus(self, t: ArrayLike) -> Floats:
        """Relaxation modulus of the fit at times in s, in the unit of the data: E(t), or G(t) of
        shear.
        """
        own, given = Spectrum(self.E, self.prony.E * self.E, self.prony.tau * self.T_ref), np.asarray(t, np.float64)
        return own.modulus(Relaxation(given.ravel(), np.empty(0)))[0].reshape(given.shape)

    def to_xarray(self) -> xr.Dataset:
        """Data and fit over t, the series over ``mode``, and the constants as attributes."""
        columns = {"relaxation": self.relaxation, "relaxation_fit": self.modulus(self.t)}
        return self._over_modes("t", "s", columns).assign_attrs(misfit=self.misfit)

    _rows, _figure = of_relaxation, relaxed


@overload
def fit_prony(
    omega: DynamicModuli,
    *,
    modes: int | None = None,
    misfit: float = 0.01,
    temperature: Numbers | None = None,
    reference: float | None = None,
    shift: Numbers | Callable[[float], float] | None = None,
    on: Literal["both", "storage"] = "both",
    mode: Mode | None = None,
    source: str = "",
) -> Fit: ...
@overload
def fit_prony(
    omega: Numbers,
    storage: Numbers,
    loss: Numbers,
    modes: int | None = None,
    *,
    misfit: float = 0.01,
    temperature: Numbers | None = None,
    reference: float | None = None,
    shift: Numbers | Callable[[float], float] | None = None,
    on: Literal["both", "storage"] = "both",
    mode: Mode | None = None,
    source: str = "",
) -> Fit: ...
def fit_prony(
    omega: Numbers | DynamicModuli,
    storage: Numbers | None = None,
    loss: Numbers | None = None,
    modes: int | None = None,
    *,
    misfit: float = 0.01,
    temperature: Numbers | None = None,
    reference: float | None = None,
    shift: Numbers | Callable[[float], float] | None = None,
    on: Literal["both", "storage"] = "both",
    mode: Mode | None = None,
    source: str = "",
) -> Fit:
    """Fit a Prony series to storage and loss modulus.

    Non-negative least squares of the relative errors of both, on times from half a decade to a decade beyond the
    data; as few modes as the misfit needs, then their times are moved too.

    Parameters
    ----------
    omega : angular frequencies, rad/s, in any order, repeated or not; or what :func:`viscoroll.read_dma` returns,
        alone: its moduli, temperatures, mode and source are then taken.
    storage, loss : storage and loss modulus at them, > 0, both in one unit.
    modes : largest number of modes; fewer are returned only where non-negative strengths have no use for more.
        Default: as few as ``misfit`` needs, or, where it cannot be reached, as few as come within 5 % of the best.
    misfit : root mean square of the relative errors that E' and E'' may each have.
    temperature : degrees Celsius: one of all points, one a point as measured (those within 0.5 K of one another are one
        curve), or one a curve where the columns are lists of curves.  The curves are shifted to ``reference`` first.
    reference : temperature of the master curve, at which its times are.  Default: where a given shift is 1 (T0 of a
        :class:`WLF`, the temperature of a factor of 1), if it is among the temperatures; else the middle one of the
        curves.  With a list of factors it must be one of the curves' temperatures.
    shift : factors a_T, one a curve in the order of the curves (of points: in the order in which the temperatures
        come), or a function of the temperature.  They are divided by that of the reference, so that constants may be
        those of another temperature.  Default: found from the overlap of neighbouring curves.
    on : "both", or "storage" to find the shifts from the overlap of the storage modulus alone, where the loss modulus
        is noisy or does not shift alike.
    mode : "tension" (default) or "shear", where the moduli are G' and G''; :meth:`Fit.material` makes E of them.
    source : of the data, in words; it stays with the material.

    Returns
    -------
    Fit
        ``print`` shows a report.

    Raises
    ------
    ParameterError
        Fewer than 3 points; values that are not positive or not finite; columns of other shapes; a curve that does
        not level off at low frequencies; neighbouring curves that do not overlap; factors that rise with the
        temperature; a reference of which the factors say nothing.

    Warns
    -----
    ModelWarning
        Where the curves are so flat that their overlap does not fix the shifts; temperatures that look like kelvin.

    Examples
    --------
    >>> import viscoroll as vr
    >>> fit = vr.fit_prony(vr.read_dma(vr.datasets.path("dma.csv")))
    >>> fit.reached, fit.mode
    (True, 'tension')

    Notes
    -----
    More than 1000 points are thinned to the means of 500 logarithmic bins; ``points`` and the report say so.
    """
    if isinstance(omega, DynamicModuli):
        record = omega
        for name, given in (("storage", storage), ("loss", loss)):
            if given is not None:
                raise ParameterError(name, "given", "left out: the record has it (modes=, if that is meant)")
        if mode is not None and mode != record.mode:
            raise ParameterError("mode", repr(mode), f"{record.mode!r}, as of {record.source or 'the record'}")
        omega, storage, loss, mode = record.omega, record.storage, record.loss, _mode(record.mode)
        temperature, source = record.temperature if temperature is None else temperature, source or record.source
    elif storage is None or loss is None:
        raise ParameterError("storage and loss", None, "given, as columns beside omega, or a record of read_dma alone")
    if on not in ("both", "storage"):
        raise unknown("on", on, ("both", "storage"), "what shifts are found from")
    mode, shifts = _mode("tension" if mode is None else mode), None
    if temperature is None:
        for name, value in (("reference", reference), ("shift", shift)):
            if value is not None:
                raise ParameterError(name, f"{value!r:.60}", "given with temperature only")
        curve = curve_of(omega, storage, loss)
    else:
        curve, shifts = master_curve(omega, storage, loss, temperature, reference, shift, on)
    data = thinned(curve)
    series = _series(curve, data, modes, misfit)
    return Fit(
        **series, misfit=Misfit(*misfits(data, _spectrum(series))), kramers_kronig=kramers_kronig(data), shifts=shifts,
        temperature=None if shifts is None else shifts.reference, mode=mode, source=source,
        **data._asdict(),
    )  # fmt: skip


def fit_relaxation(
    t: Numbers,
    relaxation: Numbers,
    modes: int | None = None,
    *,
    misfit: float = 0.003,
    temperature: float | None = None,
    mode: Mode = "tension",
    source: str = "",
) -> RelaxationFit:
    """Fit a Prony series to a relaxation modulus: what a test at constant strain gives.

    Non-negative least squares of the relative errors, as of :func:`fit_prony`, on times from half the first of the data
    to half a decade or a decade beyond the last.

    Parameters
    ----------
    t : times since the strain was applied, s, > 0, in any order.  Leave out those of the ramp: E(t) is that of a step.
    relaxation : relaxation modulus, stress over strain, > 0, in one unit.
    modes, source : as of :func:`fit_prony`.
    misfit : root mean square of the relative errors that E(t) may have.  Rolling resistance is made of E'', which
        follows from the slope of E(t): of the usual slopes 1 % of E(t) leaves 10 to 30 % of E'' open, 0.3 % some 5 %.
    temperature : of the test, degrees Celsius; it stays with the material.
    mode : "tension" (default) or "shear", where the modulus is G(t); ``material`` makes E of it.

    Returns
    -------
    RelaxationFit
        ``print`` shows a report.  The material is taken as measured at rates between 1 over the last and 1 over the
        first time.

    Raises
    ------
    ParameterError
        Fewer than 3 points; values that are not positive or not finite; columns of other shapes; a modulus that rises,
        or does not level off at long times.

    Examples
    --------
    >>> import numpy as np
    >>> import viscoroll as vr
    >>> t = np.geomspace(0.01, 100.0, 30)
    >>> fit = vr.fit_relaxation(t, 1e6 * (1.0 + 2.0 * np.exp(-t / 0.5)))
    >>> round(fit.T_ref, 6), fit.material(nu=0.49).measured.high
    (0.5, 100.0)
    """
    whole_data = data_of(Relaxation, {"t": t, "relaxation": relaxation})
    first, *_, last = whole_data.relaxation.tolist()
    if last > _RISES * first:
        found = f"from {first:g} to {last:g} as time goes on"
        raise ParameterError("relaxation", found, "a modulus, which falls (a creep compliance rises)")
    data = thinned(whole_data)
    series = _series(whole_data, data, modes, misfit)
    return RelaxationFit(
        **series, misfit=misfits(data, _spectrum(series))[0], mode=_mode(mode), source=source,
        temperature=None if temperature is None else celsius("temperature", temperature), **data._asdict(),
    )  # fmt: skip


def _mode(mode: Any) -> Mode:
    """Which modulus; raises ParameterError."""
    if mode not in ("tension", "shear"):
        raise unknown("mode", mode, ("tension", "shear"), "a kind of modulus")
    return mode


def _series(whole_data: Data, data: Data, modes: int | None, misfit: float) -> dict[str, Any]:
    """The fields of a fit that are those of its series; arguments and errors of :func:`fit_prony`.

    whole_data, data : what was measured, and what stands for it in the fit.
    """
    target = number("misfit", misfit, low=0.0, strict=True)
    modes = None if modes is None else whole("modes", modes, 1, MOST_MODES)
    low, high = whole_data.band
    if high > MOST_SPREAD * low:
        first = data._fields[0]
        span = f"from {data[0][0]:g} to {data[0][-1]:g}"
        raise ParameterError(first, span, f"within a factor of {MOST_SPREAD:g}")
    spectrum, grid, reached = chosen(data, target, modes)
    T_ref = float(spectrum.tau[0]) if spectrum.tau.size else 1.0
    return {
        "E": spectrum.E, "T_ref": T_ref, "prony": Prony(spectrum.strength / spectrum.E, spectrum.tau / T_ref),
        "target": target, "reached": reached, "grid": grid, "band": (low, high), "points": whole_data[0].size,
        "outside": (spectrum.tau < 1.0 / high) | (spectrum.tau > 1.0 / low),
    }  # fmt: skip


def _spectrum(series: dict[str, Any]) -> Spectrum:
    """The spectrum of these fields, in the unit of the data."""
    prony = series["prony"]
    return Spectrum(series["E"], prony.E * series["E"], prony.tau * series["T_ref"])
