"""What the fits of measured moduli hold: :class:`Fit`, :class:`RelaxationFit`, and what they have in common."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ...contact_law.assumptions import Assumption, measurement, passage
from ...contact_law.contact import contact
from ...core.array_types import Booleans, Floats, Numbers
from ...core.checks import check_array
from ...core.errors import ParameterError
from ...core.plots.measurements import moduli_fit, relaxation_fit
from ...core.results import Result, SummaryRow
from ...materials.importers import check_poisson
from ...materials.material import Material
from ...materials.measured import Measured
from ...materials.prony import Prony
from .curve import Curve, KramersKronig, Relaxation
from .report import card, of_dynamic, of_relaxation
from .shift import Shifts
from .spectrum import FLOOR, Data, Spectrum

if TYPE_CHECKING:
    import xarray as xr

    from ...cylinder import Cylinder

#: which modulus was measured
Mode = Literal["tension", "shear"]


class Misfit(NamedTuple):
    """Root mean square of the relative errors of storage and loss modulus."""

    storage: float
    loss: float


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class SeriesFit(Result):
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
            factor = 2.0 * (1.0 + check_poisson(nu))
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
        speed = check_array("V", V, unit="m s-1")
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

    _summary = card

    def _rows(self) -> list[SummaryRow]:
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

    _rows, _figure = of_dynamic, moduli_fit


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

    _rows, _figure = of_relaxation, relaxation_fit
