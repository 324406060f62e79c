"""Rollers: :class:`Scene`, dimensionless, and :class:`Cylinder`, in SI units.

:class:`Methods` has the methods of both.
"""

from __future__ import annotations

import importlib
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from .contact_mechanics import DUNDURS_LIMIT, BodyData, Parameters, Roller
from .core import (
    MEASURED,
    SI,
    ArrayLike,
    ParameterError,
    Result,
    Scale,
    SummaryRow,
    attributes,
    broadcast_shape,
    check_array,
    check_bool,
    check_choice,
    described_error,
    format_value,
    read_only,
    shape_error,
    slope_tan_cos,
    unit_of,
)
from .laws import LawTable
from .materials import (
    Cover,
    Material,
    Pair,
    Plane,
    Prony,
    contact_length,
    describe_body,
    effective_modulus,
    refuse_short_retardation,
)

if TYPE_CHECKING:
    from . import (
        contact,
        ensemble,
        heat_limit,
        law,
        pair_temperatures,
        resistance_extrema,
        roll,
        steady,
        stress,
        temperature,
        turning_points,
        validity,
        warming,
    )

# --- A dimensionless roller, Scene, and the methods that it shares with a cylinder ---


class Methods(Roller):
    """The functions of the package as methods of a scene and a cylinder: ``vr.contact(roller, V,
    ...)`` is ``roller.contact(V, ...)``, with the same arguments and results.
    """

    if TYPE_CHECKING:
        contact = contact
        stress = stress
        steady = steady
        resistance_extrema = resistance_extrema
        law = law
        roll = roll
        ensemble = ensemble
        validity = validity
        temperature = temperature
        warming = warming
        heat_limit = heat_limit
        turning_points = turning_points
        pair_temperatures = pair_temperatures


@dataclass
class _PublicFunction:
    """A public function of the package as a method, imported at its first use: a contact imports no
    motions and no heat.

    name : public name of a function whose first argument is a roller.
    """

    name: str

    def __get__(self, roller: Methods | None, owner: type[Methods]) -> Any:
        """Import the function, and put it in the place of this object in :class:`Methods`.

        roller, owner: scene or cylinder, None where the class is asked, and its class.
        Returns the method of the roller; the function of the class.
        Raises ImportError where a package that its module needs is missing.
        """
        function = getattr(importlib.import_module(__package__), self.name)
        setattr(Methods, self.name, function)
        return function.__get__(roller, owner)


#: names of these functions
_FUNCTIONS = (
    "contact stress steady resistance_extrema law roll ensemble validity temperature warming "
    "heat_limit turning_points pair_temperatures"
)
for _name in _FUNCTIONS.split():
    setattr(Methods, _name, _PublicFunction(_name))


class Scene(Methods, Parameters):
    """Dimensionless parameters of a cylinder that rolls on a half-space, as in Sect. 3.1 and Eq.
    (4) of the paper (Zobova and Goryacheva, 2020).

    Each number may be an array; they broadcast against each other and against speeds.  The
    functions of the package are its methods too.  The unit of time, T_ref, is T_epsilon where
    ``alpha`` is given, else that of the material; the unit of length in the contact is l0, the
    contact length at rest of half-spaces, and that of forces the load P.

    Parameters
    ----------
    alpha : T_epsilon/T_sigma, retardation time divided by relaxation time, in [1, 1e12] (1:
        elastic); the unit of time is T_epsilon.
    kappa : R/l0 = sqrt(E' R/(32 P)), radius divided by contact length at rest, > 0;
        the half-space theory requires kappa >> 1.
    mu : coefficient of friction, > 0.
    gamma : P T_ref^2/(m R), > 0; it sets the time scale of motions.  roll and ensemble need it,
        contact, stress and steady do not; validity without it does not check the quasi-steady
        assumption.
    j : moment of inertia divided by m R^2, > 0; 1/2 (default) for a solid cylinder.  Not used by
        contact or stress.
    material : a :class:`Prony` series, or two (:class:`Bodies`), or n of either, an array parameter
        (n,), in place of ``alpha``, which is then that of the material; the unit of time is T_ref,
        in which a series counts its times.  A law of :func:`viscoroll.load_law` stands for its
        material, or its alpha.  A :class:`viscoroll.Cover` is a layer of finite thickness.
    coupled : as in :class:`Cylinder`; :class:`Bodies` without ``poisson`` are uncoupled; of a grid
        it has no effect.

    Raises
    ------
    ParameterError
        Where a value is not finite or out of range, kappa or mu is missing, mu/kappa is outside
        1e-290 to 1e290, the shapes do not broadcast, or both or neither of ``alpha`` and
        ``material`` are given.

    Examples
    --------
    >>> import viscoroll as vr
    >>> scene = vr.Scene(alpha=11.0, kappa=10.0, mu=0.3)
    >>> bool(scene.contact(0.1, delta=0.5).full_slip)
    True
    """


# --- A roller in SI units ---

#: Names of the parameters of the material of the paper, the standard linear solid (SLS).
_SLS = ("E", "nu", "T_epsilon", "T_sigma")
#: Names of the fields that are numbers.
_NUMBERS = ("R", "m", *_SLS, "mu", "j", "g", "pressed")


@dataclass(frozen=True, init=False, eq=False, repr=False)
class Cylinder(Methods):
    """A viscoelastic cylinder on a half-space (or on or under a layer of finite thickness), in SI
    units.

    The functions of the package, and its methods of the same names, take and give SI units, per m
    of its length.  Arguments that carry another unit are converted, or refused
    (``docs/howto/contact.md``).  :meth:`scene` gives its dimensionless counterpart; ``scale`` gives
    the SI unit of each quantity of that scene.

    Parameters
    ----------
    R : radius, m, > 0.  Each number may be an array (n,) with one value for each cylinder; arrays
        broadcast.
    m : mass per unit length, kg/m, > 0.
    E : long-time Young's modulus of both bodies, Pa, > 0.  E, nu, T_epsilon and T_sigma take the
        place of ``material``.
    nu : Poisson's ratio, in (-1, 0.5].
    T_epsilon : retardation time, s, at least T_sigma.  If it is an array (n,), each cylinder has
        its own material, and T_ref is the largest T_epsilon.
    T_sigma : relaxation time, s, > 0.
    mu : coefficient of friction, > 0; it must be given.
    j : moment of inertia divided by m R^2, > 0; 1/2 for a solid cylinder.
    g : gravitational acceleration, m/s^2, > 0; used for the weight.
    plane : "strain" of a long roller, or "stress" of a thin disc (then E' = pi E).
    material : a :class:`Material`, in place of E, nu, T_epsilon and T_sigma; or a law of
        :func:`viscoroll.load_law` of such a material, which brings its ``base`` with it.
    base : the :class:`Material` of the half-space; default: that of the cylinder.
    load : normal force P, N/m, > 0; default: the weight m g.
    coupled : whether states with traction of a layer, and of half-spaces with Dundurs' constant
        above 0.05, are those of the coupled solution, by a table that is made at first use; None
        (default): they are, or those of the law that was given as ``material``.  False: those of
        the fast law, which takes coupling to first order (:func:`viscoroll.validity` states its
        error).

    Raises
    ------
    ParameterError
        Where a value is not finite or out of range, has a unit of another dimension, both or
        neither of material and E, nu, T_epsilon, T_sigma are given, shapes do not broadcast, or the
        bodies do not go together: both are rigid or layers, a layer on the cylinder is thicker than
        R, or ``material`` is a dimensionless law.  What the scene does not allow is refused at its
        first use.

    Notes
    -----
    Dimensionless times are divided by ``T_ref``: T_epsilon, or T_ref of the materials.

    Examples
    --------
    >>> import viscoroll as vr
    >>> roller = vr.Cylinder(
    ...     R=0.1, m=35.5, E=2.3e5, nu=0.49, T_epsilon=10.7, T_sigma=0.97, mu=0.2
    ... )
    >>> round(roller.load, 3), round(float(roller.scene().kappa), 4)
    (348.255, 2.921)
    """

    R: Any
    m: Any
    E: Any
    nu: Any
    T_epsilon: Any
    T_sigma: Any
    mu: Any
    j: Any
    g: Any
    plane: Plane
    material: Material | LawTable | None
    base: Material | None
    #: the load as it was given; None: it is the weight, which :meth:`replace` with another m or g
    #: computes anew
    pressed: Any
    coupled: bool | None
    _names = _NUMBERS

    def __init__(
        self,
        R: ArrayLike,
        m: ArrayLike,
        E: ArrayLike | None = None,
        nu: ArrayLike | None = None,
        T_epsilon: ArrayLike | None = None,
        T_sigma: ArrayLike | None = None,
        mu: ArrayLike | None = None,
        j: ArrayLike = 0.5,
        g: ArrayLike = 9.81,
        plane: Plane = "strain",
        *,
        material: Material | LawTable | None = None,
        base: Material | None = None,
        load: ArrayLike | None = None,
        pressed: ArrayLike | None = None,
        coupled: bool | None = None,
    ) -> None:
        """Check and freeze the parameters, which the class describes; each number may be an array
        (n,), or have a unit.

        They become floats or read-only arrays in SI units.

        pressed: the load P, as ``load``, N/m; not used where ``load`` is given.  Callers give
            ``load``.  :func:`dataclasses.replace` gives ``pressed``, the field in which the load is
            kept, as ``load`` is a property.
        All others are parameters of the class.
        Raises ParameterError as the class says.
        """
        values = vars(self)  # fields are set through ``__dict__``, as the class is frozen
        values.update(R=R, m=m, E=E, nu=nu, T_epsilon=T_epsilon, T_sigma=T_sigma, mu=mu, j=j, g=g)
        values.update(plane=plane, material=material, base=base)
        values["pressed"] = pressed if load is None else load
        values["coupled"] = coupled if coupled is None else check_bool("coupled", coupled)
        missing = ", ".join(name for name in _SLS if values[name] is None)
        given = ", ".join(name for name in _SLS if values[name] is not None)
        if material is not None and given:
            raise described_error(
                given, "given beside material", "left out, or material left out instead"
            )
        if material is None and missing:
            sentence = (
                f"{missing} not given: give all of E, nu, T_epsilon and T_sigma, or a material"
            )
            raise ParameterError(missing, None, "given, or material", sentence)
        for name in _NUMBERS:
            if values[name] is None and name in (*_SLS, "pressed"):
                continue
            low, high = (-1.0, 0.5) if name == "nu" else (0.0, np.inf)
            called = "load" if name == "pressed" else name
            array = check_array(called, values[name], unit=SI, above=low, high=high)
            values[name] = read_only(array)
        broadcast_shape(**self.numbers)  # refuses shapes that do not broadcast
        check_choice("plane", plane, "strain", "stress")
        if material is None:
            if np.ndim(self.T_epsilon) > 1:
                raise shape_error("T_epsilon", self.T_epsilon.shape, "a number or a vector (n,)")
            refuse_short_retardation(self.T_epsilon, self.T_sigma)
        if material is not None or base is not None:
            # the pair refuses what the materials do not allow
            self.pair.refuse_thick_layer(self.R)

    @property
    def _sls_parameters(self) -> bool:
        """Whether both bodies are of the paper's material, by its own parameters."""
        return self.material is None and (self.base is None or self.pair.like)

    @cached_property
    def pair(self) -> Pair:
        """Both bodies as :class:`.pair.Pair`, in SI units.

        The cylinder's material is ``material``, or that of the law given in its place, or is made
        of E to T_sigma; the half-space has ``base``, or that of the law, or the same material.
        Raises ParameterError where they do not go together: a dimensionless law as ``material``, a
        ``base`` beside a law that contains one, another ``plane`` than that of a law of two
        different bodies, two rigid bodies or two layers, a layer in plane stress, a body that is no
        :class:`Material`; and for arrays among E to T_sigma, of which no Material can be made.
        """
        law = self.material
        if isinstance(law, LawTable):
            return law.pair_with(self.base, self.plane)
        sls = {name: getattr(self, name) for name in _SLS}
        return Pair(Material.sls(**sls) if law is None else law, self.base, self.plane)

    @property
    def T_ref(self) -> float:
        """Unit of dimensionless times, s, a float: T_epsilon (of an array the largest), or T_ref of
        the materials.
        """
        if self.T_epsilon is None or not self._sls_parameters:
            return self.pair.T_ref
        # 1 s without cylinders
        return float(np.max(self.T_epsilon, initial=0.0)) or 1.0

    def replace(self, **changes: Any) -> Cylinder:
        """Return a copy of the cylinder with some parameters changed.

        Parameters
        ----------
        changes : arguments of :class:`Cylinder` by name, in SI units; all others keep their values,
            with two exceptions.  A new ``material`` removes E, nu, T_epsilon and T_sigma.  One of
            these four removes the ``material``; all four must be given if the cylinder had one.

        Returns
        -------
        Cylinder
            The new cylinder.  A load that was given stays.  Without a given load, or with
            ``load=None``, it is the weight m g, by the new m and g.

        Raises
        ------
        ParameterError
            As the class does.
        TypeError
            For an unknown name.

        Examples
        --------
        >>> import viscoroll as vr
        >>> vr.presets.RUBBER_CYLINDER.replace(mu=0.4, load=500.0).load
        500.0
        """
        if "load" in changes:
            changes["pressed"] = changes.pop("load")
        if changes.get("material") is not None:
            changes = dict.fromkeys(_SLS) | changes
        elif changes.keys() & set(_SLS):
            changes = {"material": None} | changes
        return replace(self, **changes)

    @property
    def numbers(self) -> dict[str, Any]:
        """The parameters that were given as numbers or arrays, by name, in SI units; "load" only if
        it was given.
        """
        values = super().numbers
        if self.pressed is not None:
            values["load"] = values.pop("pressed")
        return values

    def on_slope(self, slope: Any) -> Cylinder:
        """Return the same cylinder under the load P cos(slope), the part of the load normal to a
        slope.

        Parameters
        ----------
        slope : angle in rad, a number or (n,), in (-pi/2, pi/2); None: level.

        Returns
        -------
        Cylinder
            A new one, whose ``load`` is fixed at this value: :meth:`replace` with another m or g
            does not compute it anew.  The force along the slope, P sin(slope), is not in it.

        Raises
        ------
        ParameterError
            A slope out of this range, not numeric or with a unit that is no angle, or of a shape
            that does not broadcast with the numbers of the cylinder.

        Examples
        --------
        >>> import viscoroll as vr
        >>> roller = vr.presets.RUBBER_CYLINDER
        >>> bool(roller.on_slope(0.1).load < roller.load)
        True
        """
        cosine = slope_tan_cos(slope)[1]
        broadcast_shape(slope=cosine, **self.numbers)  # refuses shapes that do not broadcast
        return self.replace(load=self.load * cosine)

    def _summary(self) -> tuple[str, list[SummaryRow]]:
        """Return (the title; a list of :class:`SummaryRow`) of the printed report.

        The rows are, in this order, the numbers that were given, with their SI units, the load, the
        plane, "material" if ``material`` was given, and "base" if ``base`` or a :class:`Material`
        was: each body by its name, or by modulus and number of modes if it has none, with the
        thickness of a layer.
        """
        values = self.numbers | {"load": self.load, "plane": self.plane}
        rows = [
            SummaryRow(name, format_value(value), unit_of(attributes(name, si=True)))
            for name, value in values.items()
        ]
        if self.material is not None:
            rows.append(SummaryRow("material", describe_body(self.material)))
        if self.base is not None or isinstance(self.material, Material):
            same = "of the same material as the cylinder"
            rows.append(SummaryRow("base", describe_body(self.base) if self.base else same))
        return "Cylinder, SI units, per m of length", rows

    __repr__ = Result.__repr__
    _repr_html_ = Result._repr_html_

    @property
    def load(self) -> Any:
        """Force P that presses the cylinder on the base, N/m, a number or (n,): as given, or the
        weight m g.
        """
        return self.m * self.g if self.pressed is None else self.pressed

    @property
    def E_prime(self) -> Any:
        """Contact modulus E' of long times, Pa, a number or (n,), of which l0 = sqrt(32 R P/E')
        (Sect. 3.1 of the paper).

        Of one material it is pi E/(1 - nu^2), in plane stress pi E; of two their harmonic
        mean 2/(1/E'_1 + 1/E'_2), thus 2 E'_1 on a rigid base.
        """
        if not self._sls_parameters:
            return self.pair.E_prime
        return effective_modulus(self.E, self.nu, self.plane)

    @property
    def l0(self) -> Any:
        """Contact length at rest, sqrt(32 R P/E'), m, a number or (n,); of a layer that of
        half-spaces in its place.
        """
        return contact_length(self.R, self.load, self.E_prime)

    @cached_property
    def scale(self) -> Scale:  # type: ignore[override]
        """:class:`.Scale`: the SI value of 1 of each quantity of the scene, by name, as
        ``scale["V"]`` in m/s; a float, or an array (n,) where a parameter in it is one.
        """
        return Scale(self.R, self.T_ref, P=self.load, m=self.m, l0=self.l0, E_prime=self.E_prime)

    def scene(self) -> Scene:
        """Return the dimensionless scene of this cylinder: alpha or material, kappa, mu, gamma and
        j.

        Returns
        -------
        Scene
            Its kappa is R/l0 (Sect. 3.1 of the paper) and its gamma P T_ref^2/(m R) (Eq. (4)), with
            the load P and l0 = sqrt(32 R P/E'); kappa, gamma, mu and j are numbers or (n,).  E, nu,
            T_epsilon and T_sigma give alpha = T_epsilon/T_sigma; with an array T_epsilon the scene
            has a material instead, a series for each cylinder.  Other cylinders have a material
            too: a series, :class:`Bodies`, a :class:`Cover` or that of the law that was given.  The
            object is the same at each call.

        Raises
        ------
        ParameterError
            The law of a layer that was computed for another load or radius, a layer too thin, a
            scene out of range, or materials that have no common law, as one whose times no double
            holds in units of ``T_ref``.

        Examples
        --------
        >>> import viscoroll as vr
        >>> vr.presets.RUBBER_CYLINDER.scene().mu
        0.3
        """
        return self._scene

    @cached_property
    def _scene(self) -> Scene:
        """The result of :meth:`scene`, made at first use and kept; errors as there.

        Where T_epsilon is an array, times differ relative to T_ref too, and the law is a creep
        series of one mode, J = 1 - T_sigma/T_epsilon and T = T_epsilon/T_ref, for each cylinder.
        """
        if isinstance(self.material, LawTable):
            law: Any = self.material
            if isinstance(law.material, Cover):
                self.pair.refuse_other_cover(law.material, self.l0)
        elif self._sls_parameters:
            # alpha = T_epsilon/T_sigma; one out of range is refused by the scene
            with np.errstate(all="ignore"):
                law = self.T_epsilon / self.T_sigma
            if np.ndim(self.T_epsilon):
                slow, fast = np.broadcast_arrays(self.T_epsilon, self.T_sigma)
                law = Prony.creep(
                    (1.0 - fast / slow)[:, None], (slow / self.T_ref)[:, None], alpha=law
                )
        else:
            law = self.pair.law if self.pair.covered is None else self.pair.cover(self.l0)
            if self.coupled is not False:
                self.pair.refuse_coupled_ratios(law, DUNDURS_LIMIT)
        return self._scene_of(law)

    def _scene_of(self, law: Any) -> Scene:
        """Return the scene with a law, whose kappa is R/l0 and whose gamma is P T_ref^2/(m R).

        law: alpha, a float or an array (n,), no int, or a material of a scene (series, bodies,
            cover or :class:`LawTable`), with times divided by ``T_ref``, which in
            :class:`.run_rollers.Rollers` may be an array (n,).
        Raises ParameterError, by the names of the scene's parameters, where these are out of range
        or overflow, or their shapes do not broadcast; ValueError of numpy where those of R, load
        and E_prime, or of R, m, load and T_ref, do not.
        """
        # values beyond the range of doubles become 0 or infinite, as numbers of numpy do, and are
        # refused with the formula
        T = np.float64(self.T_ref)
        with np.errstate(all="ignore"):
            kappa = self.R / self.l0
            gamma = self.load * T**2 / (self.m * self.R)
        check_array(
            "kappa (R divided by l0, the contact length at rest by load, R, E and nu)",
            kappa,
            above=0.0,
        )
        check_array(
            "gamma (load times T_ref^2, divided by m R; T_ref: time of the material)",
            gamma,
            above=0.0,
        )
        material = "alpha" if isinstance(law, float | np.ndarray) else "material"
        return Scene(
            kappa=kappa, gamma=gamma, mu=self.mu, j=self.j, coupled=self.coupled, **{material: law}
        )

    @cached_property
    def body_data(self) -> BodyData:
        """Data of the bodies in SI units, from which validity and warnings are computed, a
        :class:`.BodyData`.
        """
        return BodyData(
            # E to T_sigma may be arrays, of which no pair can be made
            pair=None if self._sls_parameters else self.pair,
            E=self.E,
            nu=self.nu,
            R=self.R,
            l0=self.l0,
            T_ref=self.T_ref,
            plane=self.plane,
            scene=self._scene,
            load=self.load,
        )

    @cached_property
    def about(self) -> dict[str, Any]:  # type: ignore[override]
        """Attributes that datasets of results get: "measured_V" -> [lowest, highest speed at which
        the materials were measured], floats in m/s; {} without measured data, and for an array of
        l0.
        """
        rates = self.body_data.measured_rates
        if rates is None or np.ndim(self.l0):
            return {}
        return {MEASURED: [rate * self.l0 for rate in rates]}
