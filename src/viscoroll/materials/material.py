"""A material in SI units: :class:`Material`."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any, Literal

import numpy as np

from ..core import (
    SI,
    ArrayLike,
    Dataset,
    Figure,
    FilePath,
    Floats,
    ParameterError,
    Result,
    SummaryRow,
    check_array,
    check_number,
    check_text,
    describe_value,
    shape_error,
)
from .importers import FromPrograms, check_poisson
from .measured_data import Measured, check_celsius, check_fields, relative_shift, vertical_factor
from .prony import Prony
from .prony_forms import refuse_short_retardation


@dataclass(frozen=True)
class Material(FromPrograms):
    """An isotropic linear viscoelastic material, in SI units.

    E(t) = E (1 + sum E_i exp(-t/(tau_i T_ref))), with strengths and times of ``prony``.  A material
    that was imported with bulk terms unlike those of shear, as by :meth:`abaqus`, has the series of
    E/(1 - nu^2) in plane strain in place of that of E: its methods then give E times this series as
    the moduli, and the compliance that belongs to it.

    Parameters
    ----------
    E : long-time Young's modulus, Pa, > 0; infinite for a rigid body.
    nu : Poisson's ratio, in (-1, 0.5], constant in time: shear, bulk and tensile modulus relax
        alike; of a material imported with other bulk terms that of long times.
    prony : strengths divided by E, and times in units of T_ref; default: elastic.
    T_ref : unit of the times of ``prony``, s.
    name : name in tables and figures.
    density : kg/m^3, for the comparison of the speed with the shear wave speed.
    thickness : thickness of a layer, m, that is bonded to a rigid core (covered roller) or bed
        (belt, lining); the other body may be one too.  Default: a half-space.
    measured : :class:`Measured` range of frequencies of the data; outside of it functions warn.
    temperature : temperature at which moduli and times are as given, degrees Celsius; :meth:`at`
        starts there.  Outside -150 to 200 it gives a ModelWarning: it looks like one in kelvin.
    nu_instant : Poisson's ratio at t = 0, in (-1, 0.5], of a material imported with bulk terms
        unlike those of shear, a half-space in plane strain; None: nu is constant in time.
    shift : :class:`WLF`, :class:`Arrhenius`, or a function of the temperature in degrees Celsius
        that returns a_T; it is the default of :meth:`at`, and what :meth:`Cylinder.temperature`
        needs.  Default: none.
    vertical_shift : b_T, by which all moduli are multiplied: "entropic", the absolute temperature,
        or a function of the temperature in degrees Celsius, dimensionless, > 0.  It needs a
        ``temperature``.  Default: moduli stay.

    Raises
    ------
    ParameterError
        A value that is not finite or out of range, a rigid body that relaxes, a name with NUL or
        surrogates, a shift that is no function or is a class.

    Notes
    -----
    Immutable, hashable, equal where all fields but the shifts are.

    Examples
    --------
    >>> import viscoroll as vr
    >>> rubber = vr.Material(E=3e6, nu=0.49, prony=vr.Prony([2.0], [1.0]), T_ref=0.01)
    >>> rubber.instant
    9000000.0
    """

    E: float
    nu: float
    prony: Prony = field(default_factory=Prony.elastic)
    T_ref: float = 1.0
    name: str = ""
    density: float | None = None
    thickness: float | None = None
    measured: Measured | None = None
    temperature: float | None = None
    nu_instant: float | None = None
    shift: Callable[[float], float] | None = field(default=None, compare=False)
    vertical_shift: Callable[[float], float] | Literal["entropic"] | None = field(
        default=None, compare=False
    )

    def __post_init__(self) -> None:
        """Check the fields, and replace numbers by floats in SI units (``temperature`` in degrees
        Celsius).

        E (unless infinite), T_ref, density and thickness must be finite and > 0, nu in (-1, 0.5];
        ``prony`` must be one series; a rigid body must neither relax nor have a thickness.
        Raises ParameterError for the first field that is not allowed, and warns as the class says.
        """
        if not isinstance(self.prony, Prony) or self.prony.shape:
            raise ParameterError(
                "prony", describe_value(self.prony), "one Prony series, as vr.Prony([2.0], [0.1])"
            )
        values = vars(self)  # fields are set through ``__dict__``, as the class is frozen
        if isinstance(self.E, float | np.floating) and self.E == math.inf:
            values["E"] = math.inf
            if self.prony.alpha > 1.0:
                raise ParameterError(
                    "E",
                    self.E,
                    "finite for a viscoelastic body; give a rigid one no series or times",
                )
            if self.thickness is not None:
                raise ParameterError("thickness", self.thickness, "left out for a rigid body")
        else:
            check_fields(self, "E")
        values["nu"] = check_poisson(self.nu)
        if self.nu_instant is not None:
            values["nu_instant"] = check_poisson(self.nu_instant, "nu_instant")
        check_text("name", self.name)
        given = [name for name in ("density", "thickness") if getattr(self, name) is not None]
        check_fields(self, "T_ref", *given)
        if not isinstance(self.measured, Measured | None):
            raise ParameterError("measured", describe_value(self.measured), "a vr.Measured")
        if self.temperature is not None:
            values["temperature"] = check_celsius("temperature", self.temperature)
        if self.shift is not None:
            _check_shift("shift", self.shift, "vr.WLF(...), vr.Arrhenius(...)")
        vertical = self.vertical_shift
        if not (isinstance(vertical, str | None) and vertical in (None, "entropic")):
            _check_shift("vertical_shift", vertical, "'entropic'")

    @classmethod
    def sls(cls, E: float, nu: float, T_epsilon: float, T_sigma: float, **more: Any) -> Material:
        """Make a standard linear solid, the material of the paper.

        Parameters
        ----------
        E : long-time Young's modulus, Pa, > 0.
        nu : Poisson's ratio, in (-1, 0.5].
        T_epsilon, T_sigma : retardation and relaxation time, s, T_epsilon >= T_sigma > 0; T_ref is
            T_epsilon.  Where they are equal, or their ratio rounds to 1, the material is elastic.
        more : further parameters of :class:`Material` by name: ``name``, ``density``,
            ``thickness``, ``measured``, ``temperature``.

        Returns
        -------
        Material
            With one relaxation time T_sigma and ``instant`` = E T_epsilon/T_sigma.

        Raises
        ------
        ParameterError
            A value out of range, T_epsilon below T_sigma, T_epsilon/T_sigma above 1e12.
        TypeError
            A name in ``more`` that :class:`Material` does not have, or E, nu, ``prony`` or
            ``T_ref``.

        Examples
        --------
        >>> import viscoroll as vr
        >>> vr.Material.sls(1e6, 0.5, T_epsilon=0.1, T_sigma=0.02).instant
        5000000.0
        """
        T_epsilon = check_number("T_epsilon", T_epsilon, unit=SI, above=0.0)
        T_sigma = check_number("T_sigma", T_sigma, unit=SI, above=0.0)
        refuse_short_retardation(T_epsilon, T_sigma)
        ratio = T_sigma / T_epsilon
        prony = (
            Prony.creep([1.0 - ratio], [1.0], alpha=T_epsilon / T_sigma)
            if ratio < 1.0
            else Prony.elastic()
        )
        return cls(E, nu, prony, T_epsilon, **more)

    @classmethod
    def elastic(cls, E: float, nu: float, **more: Any) -> Material:
        """Make a material that does not relax.

        Parameters
        ----------
        E : Young's modulus, Pa, > 0; infinite for a rigid body.
        nu : Poisson's ratio, in (-1, 0.5].
        more : further parameters of :class:`Material` by name: ``name``, ``density``,
            ``thickness``, ``measured``, ``temperature``, ``T_ref``.

        Returns
        -------
        Material
            With ``T_ref`` = 1 s, unless it is given.

        Raises
        ------
        ParameterError
            A value out of range.
        TypeError
            A name in ``more`` that :class:`Material` does not have, and ``prony``.

        Examples
        --------
        >>> import viscoroll as vr
        >>> vr.Material.elastic(2.1e11, 0.3, name="steel").prony.alpha
        1.0
        """
        return cls(E, nu, Prony.elastic(), **more)

    @classmethod
    def rigid(cls, **more: Any) -> Material:
        """Make a body that does not deform, with infinite E; its Poisson's ratio, 0.5, has no
        effect.

        Parameters
        ----------
        more : ``name`` and ``density``, and other parameters of :class:`Material` but E, nu and
            ``thickness``.

        Returns
        -------
        Material
            With E infinite, nu = 0.5 and no modes.

        Raises
        ------
        ParameterError
            A value out of range, a thickness, a series that relaxes.
        TypeError
            A name in ``more`` that :class:`Material` does not have, or E or nu.

        Examples
        --------
        >>> import viscoroll as vr
        >>> vr.Material.rigid(name="drum").is_rigid
        True
        """
        return cls(math.inf, 0.5, **more)

    @property
    def is_rigid(self) -> bool:
        """Whether E is infinite."""
        return math.isinf(self.E)

    @property
    def instant(self) -> float:
        """Instantaneous Young's modulus, Pa.

        Of a material with ``nu_instant`` alpha is that of E/(1 - nu^2), so that the modulus is E
        alpha (1 - nu_instant^2)/(1 - nu^2).
        """
        early = self.nu if self.nu_instant is None else self.nu_instant
        return self.E * self.prony.alpha * (1.0 - early**2) / (1.0 - self.nu**2)

    @property
    def G(self) -> float:
        """Long-time shear modulus E/(2 (1 + nu)), Pa."""
        return self.E / (2.0 * (1.0 + self.nu))

    def at(self, temperature: float, shift: Callable[[float], float] | None = None) -> Material:
        """Return the material at another temperature: T_ref and all times are multiplied by a_T.

        The measured band moves with it.  E is multiplied by b_T of ``vertical_shift``, or stays;
        all other fields stay.

        Parameters
        ----------
        temperature : degrees Celsius, one number.
        shift : :class:`WLF`, :class:`Arrhenius`, or any function of the temperature in degrees
            Celsius that returns a_T, dimensionless, > 0, as a number.  Where the material has a
            ``temperature``, times are multiplied by a_T(temperature)/a_T(its own), so that
            constants that refer to another temperature (T0 of the glass transition, say) are
            converted; where it has none, it is taken to be at the temperature where the shift is
            1.  Default: the material's own ``shift``.

        Returns
        -------
        Material
            With the new ``temperature``, and this shift.

        Raises
        ------
        ParameterError
            A temperature that the shift does not allow, an array of temperatures, one at or below
            absolute zero; a shift that is no function, is a class, or does not return a finite
            positive number; a ratio of shifts, a time or a frequency of the measured band that no
            double holds.  Other exceptions of the shift pass.

        Warns
        -----
        ModelWarning
            A temperature outside -150 to 200: it looks like one in kelvin.

        Examples
        --------
        >>> import viscoroll as vr
        >>> rubber = vr.Material(3e6, 0.49, vr.Prony([2.0], [1.0]), temperature=20.0)
        >>> rubber.at(20.0, shift=vr.WLF(C1=8.86, C2=101.6, T0=-10.0)) == rubber
        True
        """
        allowed = "vr.WLF(...) or vr.Arrhenius(...), given to at() or to the Material,"
        shift = _check_shift("shift", self.shift if shift is None else shift, allowed)
        given = check_array("temperature", temperature, unit="degC")
        if given.ndim:
            raise shape_error(
                "temperature",
                given.shape,
                "one number, as a material has one temperature: make a list of materials, as "
                "[rubber.at(T, shift) for T in temperatures], or write a run file, where "
                "temperature in [material] may be a column or a distribution (docs/ensembles.md)",
            )
        temperature = check_celsius("temperature", float(given))
        factor = relative_shift(shift, temperature, self.temperature)
        measured = None if self.measured is None else self.measured.shifted(factor)
        E = self.E * vertical_factor(self.vertical_shift, temperature, self.temperature)
        T_ref = self.T_ref * factor
        return replace(
            self, E=E, T_ref=T_ref, measured=measured, temperature=temperature, shift=shift
        )

    def storage(self, omega: ArrayLike) -> Any:
        """Return the storage modulus E' in tension, from E at omega = 0 to the instantaneous one.

        It is E (1 + sum E_i x_i^2/(1 + x_i^2)) with x_i = omega tau_i T_ref.  Of a material
        imported with bulk terms unlike those of shear the series is that of E/(1 - nu^2).

        Parameters
        ----------
        omega : angular frequencies, rad/s, >= 0, of any shape.

        Returns
        -------
        number or array, Pa, of the shape of ``omega``; infinite for a rigid body

        Raises
        ------
        ParameterError
            A frequency that is negative, NaN, infinite or no number, or has a unit of another
            dimension.

        Examples
        --------
        >>> import viscoroll as vr
        >>> rubber = vr.Material(3e6, 0.49, vr.Prony([2.0], [1.0]), T_ref=0.01)
        >>> float(rubber.storage(100.0))
        6000000.0
        """
        return self.E * self._moduli(omega)[0]

    def loss(self, omega: ArrayLike) -> Any:
        """Return the loss modulus E'' in tension, E sum E_i x_i/(1 + x_i^2) with x_i = omega tau_i
        T_ref.

        Of a material imported with bulk terms unlike those of shear the series is that of E/(1 -
        nu^2).

        Parameters
        ----------
        omega : angular frequencies, rad/s, >= 0, of any shape.

        Returns
        -------
        number or array, Pa, >= 0, of the shape of ``omega``; 0 of an elastic and of a rigid body

        Raises
        ------
        ParameterError
            A frequency that is negative, NaN, infinite or no number, or has a unit of another
            dimension.

        Examples
        --------
        >>> import viscoroll as vr
        >>> rubber = vr.Material(3e6, 0.49, vr.Prony([2.0], [1.0]), T_ref=0.01)
        >>> float(rubber.loss(100.0))
        3000000.0
        """
        # a rigid body has no loss, which infinite E times 0 would make NaN
        return self._moduli(omega)[1] * (0.0 if self.is_rigid else self.E)

    def tan_delta(self, omega: ArrayLike) -> Any:
        """Return the loss factor E''/E' in tension, of :meth:`loss` and :meth:`storage`.

        Of a material imported with bulk terms unlike those of shear it is that of E/(1 - nu^2).

        Parameters
        ----------
        omega : angular frequencies, rad/s, >= 0, of any shape.

        Returns
        -------
        number or array, dimensionless, >= 0, of the shape of ``omega``; 0 of an elastic and of a
        rigid body

        Raises
        ------
        ParameterError
            A frequency that is negative, NaN, infinite or no number, or has a unit of another
            dimension.

        Examples
        --------
        >>> import viscoroll as vr
        >>> rubber = vr.Material(3e6, 0.49, vr.Prony([2.0], [1.0]), T_ref=0.01)
        >>> float(rubber.tan_delta(100.0))
        0.5
        """
        storage, loss = self._moduli(omega)
        return loss / storage

    def relaxation(self, t: ArrayLike) -> Any:
        """Return the tensile relaxation modulus E(t), from the instantaneous one at t = 0 to E.

        Of a material imported with bulk terms unlike those of shear it is E times the series of
        E/(1 - nu^2).

        Parameters
        ----------
        t : times, s, >= 0, of any shape.

        Returns
        -------
        number or array, Pa, of the shape of ``t``; E at all times for an elastic and infinite for a
        rigid body

        Raises
        ------
        ParameterError
            A time that is negative, NaN, infinite or no number, or has a unit of another dimension.

        Examples
        --------
        >>> import viscoroll as vr
        >>> rubber = vr.Material(3e6, 0.49, vr.Prony([2.0], [1.0]), T_ref=0.01)
        >>> rubber.relaxation([0.0, 1.0])
        array([9000000., 3000000.])
        """
        # [()] makes a number of an array without axes
        decay = np.exp(-self._divide_time(t, self.prony.tau))
        return self.E * (1.0 + (self.prony.E * decay).sum(axis=-1))[()]

    def creep(self, t: ArrayLike) -> Any:
        """Return the creep compliance in tension times E, 1 - sum J_j exp(-t/(T_j T_ref)), with the
        creep form of ``prony``.

        It rises from E/E(0) at t = 0 to 1.  Of a material imported with bulk terms unlike those of
        shear it is that of (1 - nu^2)/E, divided by its long-time value.

        Parameters
        ----------
        t : times, s, >= 0, of any shape.

        Returns
        -------
        number or array, dimensionless, of the shape of ``t``; 1 at all times for an elastic and a
        rigid body

        Raises
        ------
        ParameterError
            A time that is negative, NaN, infinite or no number, or has a unit of another dimension.

        Examples
        --------
        >>> import viscoroll as vr
        >>> rubber = vr.Material(3e6, 0.49, vr.Prony([3.0], [1.0]), T_ref=0.01)
        >>> rubber.creep([0.0, 10.0])
        array([0.25, 1.  ])
        """
        growth = -np.expm1(-self._divide_time(t, self.prony.T))
        return (1.0 / self.prony.alpha + (self.prony.J * growth).sum(axis=-1))[()]

    def to_xarray(self) -> Dataset:
        """Return the Prony series in relaxation and creep form and the constants as a dataset.

        Returns
        -------
        xarray.Dataset
            E, tau, J, T over "mode" (of length 0 if elastic), slowest first, strengths
            dimensionless and times in units of T_ref; E_long (Pa), nu, T_ref (s), alpha, and of
            density (kg/m^3), thickness (m), temperature (degrees Celsius) and the measured band
            (measured_low and measured_high in rad/s, measured_misfit) those that are given.  Its
            attributes are those of :func:`.checked_netcdf.material_as_dataset`.

        Examples
        --------
        >>> import viscoroll as vr
        >>> vr.Material(3e6, 0.49, vr.Prony([2.0], [1.0])).to_xarray().sizes["mode"]
        1
        """
        from .checked_netcdf import material_as_dataset

        return material_as_dataset(self)

    def _summary(self) -> tuple[str, list[SummaryRow]]:
        """Return what the HTML of a notebook shows: a title, and a line for each property.

        Returns (the name, or "Material" without one; a list of :class:`SummaryRow` with name, value
        and unit as texts, numbers to six digits).  Properties that are None are left out, as are
        the relaxation times of an elastic material; of these the longest and the shortest are
        shown, in this order, to three digits.
        """
        times = self.prony.tau * self.T_ref
        values = [
            ("long-time modulus E", self.E, "Pa"),
            ("instantaneous modulus", self.instant, "Pa"),
            ("Poisson's ratio nu", self.nu, ""),
            ("nu at t = 0", self.nu_instant, ""),
            ("terms of the series", times.size, ""),
            ("unit of time T_ref", self.T_ref, "s"),
            ("relaxation times", f"{times[0]:.3g} to {times[-1]:.3g}" if times.size else None, "s"),
            ("density", self.density, "kg m-3"),
            ("thickness", self.thickness, "m"),
            ("temperature", self.temperature, "degrees Celsius"),
            ("measured from", self.measured and str(self.measured), ""),
        ]
        return self.name or "Material", [
            SummaryRow(name, value if isinstance(value, str) else f"{value:g}", unit)
            for name, value, unit in values
            if value is not None
        ]

    _repr_html_ = Result._repr_html_
    plot = Result.plot

    def _figure(self) -> Figure:
        """Return a figure of E', E'' and tan delta over frequency, and of E(t)."""
        from ..core.plots.result_figures import master_curve

        return master_curve(self)

    def to_netcdf(self, path: FilePath) -> None:
        """Write the material as netCDF-4, with its Prony series in relaxation and in creep form and
        a SHA-256 checksum.  ModelWarning of what it leaves out: a shift other than WLF and
        Arrhenius (as ShiftFactors); a function as vertical shift, and any shift beside it.

        Parameters
        ----------
        path : file to write; a file of that name is replaced once the new one is complete.

        Raises
        ------
        FileError
            If it cannot be written there; a file of that name is left as it was.

        Examples
        --------
        >>> import viscoroll as vr
        >>> vr.Material.elastic(2.1e11, 0.3).to_netcdf("steel.nc")
        """
        from .checked_netcdf import write_material

        write_material(self, path)

    def _moduli(self, omega: ArrayLike) -> tuple[Any, Any]:
        """Return storage and loss modulus divided by E, (E'/E, E''/E), (1, 0) of an elastic body.

        omega: as in :meth:`storage`, of which result and errors are; a product of omega and a
            relaxation time that overflows is taken as infinite.
        """
        with np.errstate(over="ignore"):
            product = check_array("omega", omega, unit=SI, low=0.0)[..., None] * (
                self.T_ref * self.prony.tau
            )
        # with z > 1 by 1/z, so that z^2 cannot overflow: z^2/(1 + z^2) = 1/(1 + 1/z^2)
        fast = product > 1.0
        ratio = np.where(fast, 1.0 / np.maximum(product, 1.0), product)
        whole = 1.0 + ratio * ratio
        E = self.prony.E
        storage = 1.0 + (E * (np.where(fast, 1.0, ratio * ratio) / whole)).sum(axis=-1)
        return storage[()], (E * (ratio / whole)).sum(axis=-1)[()]

    def _divide_time(self, t: ArrayLike, times: Floats) -> Floats:
        """Return t divided by each of several times of the material.

        t: s, >= 0, of any shape.
        times: relaxation or retardation times in units of T_ref, > 0, (times,); may be empty.
        Returns the ratios, dimensionless, of the shape of t with a last axis of the times; infinite
        where the quotient overflows.
        Raises ParameterError for a time t that is negative, NaN, infinite or no number, or of
        another dimension.
        """
        with np.errstate(over="ignore"):
            return check_array("t", t, unit=SI, low=0.0)[..., None] / (self.T_ref * times)


def _check_shift(name: str, shift: Any, allowed: str) -> Any:
    """Return the ``shift`` of the argument ``name``; raise ParameterError if it cannot be called or
    is a class.  The words ``allowed`` say what is allowed beside a function."""
    if not callable(shift) or isinstance(shift, type):  # a class, as vr.WLF without (...)
        raise ParameterError(
            name,
            describe_value(shift),
            f"{allowed} or a function of the temperature in degrees Celsius",
        )
    return shift
