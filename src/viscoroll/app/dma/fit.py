"""The fit of a master curve, :func:`fit_prony`, and what it holds, :class:`Fit`."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ...contact_law.assumptions import Assumption, measurement, passage
from ...contact_law.contact import contact
from ...core.checks import checked, number, whole
from ...core.errors import ParameterError
from ...core.plots.measured import fitted
from ...core.results import Shown
from ...core.typed import Booleans, Floats, Numbers
from ...materials.material import Material
from ...materials.measured import Measured
from ...materials.prony import Prony
from ...materials.prony_forms import MOST_MODES, WIDEST
from .choose import chosen
from .curve import Curve, KramersKronig, curve_of, kramers_kronig
from .report import card
from .shift import Shifts, master_curve
from .spectrum import FLOOR, Spectrum, misfits

if TYPE_CHECKING:
    import xarray as xr

    from ...cylinder import Cylinder

#: highest over lowest frequency; times reach a decade beyond on either side
MOST_SPREAD = WIDEST / 100.0


class Misfit(NamedTuple):
    """Root mean square of the relative errors of storage and loss modulus."""

    storage: float
    loss: float


@dataclass(frozen=True, eq=False, repr=False)
class Fit(Shown):
    """A Prony series fitted to a master curve, and what the data say and do not say about it.

    E : long-time modulus, in the unit of the data.
    T_ref : the longest time, s; those of ``prony`` are counted in it.
    prony : the material.
    misfit : root mean square of the relative errors, ``.storage`` and ``.loss``.
    target, reached : the misfit that was asked for, and whether both are within it.
    kramers_kronig : measured over allowed loss modulus: ``.omega``, ``.ratio``, ``.median``.
    outside : for each mode of ``prony`` whether its time lies outside the range of 1/omega.
    shifts : shift factors of curves at several temperatures, else None.
    omega, storage, loss : the data, sorted and shifted; rad/s and the unit given.
    grid : shortest and longest time that the fit was allowed, s.
    source : of the data, in words.
    """

    E: float
    T_ref: float
    prony: Prony
    misfit: Misfit
    target: float
    reached: bool
    kramers_kronig: KramersKronig
    outside: Booleans
    shifts: Shifts | None
    omega: Floats
    storage: Floats
    loss: Floats
    grid: tuple[float, float]
    source: str = ""

    @property
    def alpha(self) -> float:
        """Instantaneous over long-time modulus."""
        return self.prony.alpha

    @property
    def plateau(self) -> bool:
        """Whether E is what the data ask for, not the least that is allowed (1 % of the lowest storage modulus)."""
        return self.E > 1.001 * FLOOR * float(self.storage.min())

    def modulus(self, omega: ArrayLike) -> tuple[Floats, Floats]:
        """Storage and loss modulus of the fit at angular frequencies in rad/s, in the unit of the data."""
        own, given = Spectrum(self.E, self.prony.E * self.E, self.prony.tau * self.T_ref), np.asarray(omega, np.float64)
        storage, loss = own.modulus(given.ravel())
        return storage.reshape(given.shape), loss.reshape(given.shape)

    @cached_property
    def wider(self) -> tuple[Any, ...]:
        """What grids of times one and two decades wider on either side would change, no time left out.

        For each: ``decades``, ``E``, ``alpha``, ``prony`` and, at speeds ``V`` in R/T_ref whose contacts are passed
        in times that the data hold, ``M`` beside ``M_fit`` at the same load (see :class:`.wider.Wider`).
        Computed when first asked for.
        """
        from .wider import wider

        curve = Curve(self.omega, self.storage, self.loss)
        return tuple(wider(curve, self.prony, self.E, self.T_ref, self.grid, decades) for decades in (1, 2))

    @property
    def measured(self) -> Measured:
        """The frequencies of the data, the larger misfit and the source: what a material keeps of them."""
        source = self.source or f"{self.omega.size} points"
        return Measured(float(self.omega[0]), float(self.omega[-1]), max(self.misfit), source)

    def material(
        self, nu: float = 0.49, *, name: str = "", density: float | None = None, thickness: float | None = None
    ) -> Material:
        """The fit as a :class:`viscoroll.Material`, ``measured`` with it; the data must have been in Pa.

        Parameters
        ----------
        nu : Poisson's ratio, constant in time.
        name, density, thickness : as there; density in kg/m^3, thickness in m.

        Raises
        ------
        ParameterError
            As there.
        """
        own = self.E, nu, self.prony, self.T_ref
        return Material(*own, name=name, density=density, thickness=thickness, measured=self.measured)

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
        speed = checked("V", V, unit="m s-1")
        lam = contact(cylinder.scene(), speed * (cylinder.T_ref / cylinder.R), delta=0.0, fields="lam").lam
        seen = passage(speed, lam * cylinder.l0) * (body.T_ref / self.T_ref)
        return measurement(seen, {"the material": self.measured})

    def to_xarray(self) -> xr.Dataset:
        """Data and fit over omega, the series over ``mode``, and the constants as attributes."""
        import xarray as xr

        fitted = zip(("storage_fit", "loss_fit"), self.modulus(self.omega), strict=True)
        columns = {"storage": self.storage, "loss": self.loss, **dict(fitted)}
        data = {name: ("omega", values, {"units": "unit of the data"}) for name, values in columns.items()}
        data |= {"E": ("mode", self.prony.E, {"long_name": "strengths over the long-time modulus"})}
        data |= {"tau": ("mode", self.prony.tau * self.T_ref, {"units": "s"})}
        about = {"E_long": self.E, "T_ref": self.T_ref, "title": "Fit of a Prony series"}
        about |= {f"misfit_{name}": value for name, value in self.misfit._asdict().items()}
        return xr.Dataset(data, {"omega": ("omega", self.omega, {"units": "rad s-1"})}, about)

    _card, _figure = card, fitted


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
    source: str = "",
) -> Fit:
    """Fit a Prony series to storage and loss modulus.

    Non-negative least squares of the relative errors of both, on times from half a decade to a decade beyond the
    data; as few modes as the misfit needs, then their times are moved too.

    Parameters
    ----------
    omega : angular frequencies, rad/s, in any order, repeated or not.
    storage, loss : storage and loss modulus at them, > 0, both in one unit.
    modes : largest number of modes; fewer are returned only where non-negative strengths have no use for more.
        Default: as few as ``misfit`` needs, or, where it cannot be reached, as few as come within 5 % of the best.
    misfit : root mean square of the relative errors that E' and E'' may each have.
    temperature : degrees Celsius, one a point (equal ones are a curve: round measured ones), or one a curve where
        the columns are lists of curves.  The curves are shifted to ``reference`` first.
    reference : temperature of the master curve; default the middle one of the curves.
    shift : factors a_T, one a temperature in ascending order, or a function of the temperature; times are a_T times
        those at the reference.  Default: found from the overlap of neighbouring curves.
    source : of the data, in words; it stays with the material.

    Returns
    -------
    Fit
        ``print`` shows a report.

    Raises
    ------
    ParameterError
        Fewer than 3 points; values that are not positive or not finite; columns of other shapes; a curve that does
        not level off at low frequencies; neighbouring curves that do not overlap.
    """
    target = number("misfit", misfit, low=0.0, strict=True)
    modes = None if modes is None else whole("modes", modes, 1, MOST_MODES)
    if temperature is None:
        for name, value in (("reference", reference), ("shift", shift)):
            if value is not None:
                raise ParameterError(name, f"{value!r:.60}", "given with temperature only")
        curve, shifts = curve_of(omega, storage, loss), None
    else:
        curve, shifts = master_curve(omega, storage, loss, temperature, reference, shift)
    if curve.omega[-1] > MOST_SPREAD * curve.omega[0]:
        span = f"from {curve.omega[0]:g} to {curve.omega[-1]:g}"
        raise ParameterError("omega", span, f"within a factor of {MOST_SPREAD:g}")
    spectrum, grid, reached = chosen(curve, target, modes)
    T_ref = float(spectrum.tau[0]) if spectrum.tau.size else 1.0
    outside = (spectrum.tau < 1.0 / curve.omega[-1]) | (spectrum.tau > 1.0 / curve.omega[0])
    return Fit(
        E=spectrum.E, T_ref=T_ref, prony=Prony(spectrum.strength / spectrum.E, spectrum.tau / T_ref),
        misfit=Misfit(*misfits(curve, spectrum)), target=target, reached=reached,
        kramers_kronig=kramers_kronig(curve), outside=outside, shifts=shifts,
        omega=curve.omega, storage=curve.storage, loss=curve.loss, grid=grid, source=source,
    )  # fmt: skip
