"""The models that the functions of the package take: :class:`Roller`, and its dimensionless
:class:`Parameters`.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable
from functools import cached_property
from typing import Any, ClassVar, Self

import numpy as np

from ..core import (
    DIMENSIONLESS,
    Floats,
    Integers,
    ParameterError,
    Scale,
    broadcast_shape,
    check_array,
    check_array_extent,
    check_bool,
    check_number,
    check_one_given,
    describe_value,
    format_value,
    read_only,
    shape_error,
    slope_tan_cos,
)
from ..laws import LawGrid, LawTable, law_table
from ..materials import HIGHEST_ALPHA, Bodies, Cover, Prony

#: Names of the dimensionless numbers of a scene.
PARAMETERS = ("alpha", "kappa", "mu", "gamma", "j")
#: Relative difference of two coefficients of friction that count as one, as mu P/P.
_SAME_MU = 1e-12
#: Smallest and largest mu/kappa, dimensionless, the unit of delta_star: beyond them it leaves the
#: range of doubles.
RATIO_RANGE = (1e-290, 1e290)


class Roller:
    """Base of a scene and a cylinder: data by which functions compute, and the scale of their
    arguments and results.

    Its subclasses are dataclasses, whose fields may be arrays.  Two rollers are equal, and have one
    hash, if they are of one class and all fields are equal.

    Attributes
    ----------
    scale : :class:`.Scale`, which gives the unit of each quantity by name, of a cylinder in SI
        units; 1 of a scene.
    material : the material, None where numbers stand for it.
    body_data : data of the bodies in SI units; None of a scene.
    about : attributes that datasets of results get, by name; empty of a scene.
    """

    scale: Scale
    material: Any
    #: names of the parameters that are numbers
    _names: tuple[str, ...]
    #: data of the bodies for assessments, a :class:`.body_data.BodyData`; None of a scene
    body_data: Any = None
    about: ClassVar[dict[str, Any]] = {}

    def scene(self) -> Parameters:
        """Return the dimensionless parameters."""
        raise NotImplementedError

    @property
    def numbers(self) -> dict[str, Any]:
        """Parameters that were given as numbers or arrays, by name, in the units of the roller."""
        values = {name: getattr(self, name) for name in self._names}
        return {name: value for name, value in values.items() if value is not None}

    def on_slope(self, slope: Any) -> Self:
        """Return the same roller on a slope, rad, under the load P cos(slope), as a new object."""
        raise NotImplementedError

    def replace(self, **changes: Any) -> Self:
        """Return a copy with some parameters changed; ``changes``: new values by name."""
        raise NotImplementedError

    def take(self, index: Integers, count: int) -> Self:
        """Select some of the ``count`` rollers that this object with array parameters stands for.

        Parameters
        ----------
        index : index of numpy into an array (count,): an integer for one roller, a slice, a mask,
            or integers (k,).
        count : number of rollers; numbers and materials of shape (count,) are indexed, all others
            stay as they are.

        Returns
        -------
        Scene or Cylinder
            A roller of the same class whose indexed parameters are numbers, or arrays (k,), in the
            order of the index; this object itself if no parameter has that shape.

        Raises
        ------
        IndexError
            An index beyond ``count``, if a parameter has that shape.

        Examples
        --------
        >>> import viscoroll as vr
        >>> rollers = vr.presets.RUBBER_CYLINDER.replace(mu=[0.2, 0.3, 0.4])
        >>> rollers.take(slice(0, 2), 3).mu
        array([0.2, 0.3])
        """
        parts = {
            name: value[index]
            for name, value in self._arrays.items()
            if getattr(value, "shape", ()) == (count,)
        }
        return self.replace(**parts) if parts else self

    @property
    def _arrays(self) -> dict[str, Any]:
        """Parameters that may be arrays of several rollers, by name."""
        return self.numbers

    def _key(self) -> tuple[Any, ...]:
        """All fields in a form that compares and hashes."""
        values = (getattr(self, field.name) for field in dataclasses.fields(self))  # type: ignore[arg-type]
        # + 0.0: -0 and 0 are equal
        return tuple(
            (x.shape, (x + 0.0).tobytes()) if isinstance(x, np.ndarray) else x for x in values
        )

    def __eq__(self, other: object) -> bool:
        same_type = type(other) is type(self)
        return self._key() == other._key() if same_type else NotImplemented  # type: ignore[attr-defined]

    def __hash__(self) -> int:
        return hash(self._key())


@dataclasses.dataclass(frozen=True, eq=False, repr=False)
class Parameters(Roller):
    """Dimensionless parameters, as a :class:`viscoroll.Scene` takes them; each a number or an
    array, and they broadcast.

    The unit of time, T_ref, is T_epsilon where alpha is given, else the time in units of which the
    material counts.

    alpha : T_epsilon/T_sigma, in [1, :data:`HIGHEST_ALPHA`]; that of a material is set.
    kappa : slenderness R/l0, > 0.
    mu : coefficient of friction, > 0.
    gamma : P T_ref^2/(m R), > 0; None where the roller does not move.
    j : moment of inertia divided by m R^2, > 0.
    material : in place of alpha: a series, two bodies, or the rows of a law, whose material it
    becomes; None of an alpha. ``shape`` is what the parameters broadcast to; () for one scene.
    coupled : whether states with traction are those of the coupled solution (:attr:`rolling_law`);
    None (default): where shear acts on pressure.
    """

    alpha: Any = None
    kappa: Any = None
    mu: Any = None
    gamma: Any = None
    j: Any = 0.5
    material: Prony | Bodies | LawTable | None = None
    coupled: bool | None = None
    _law: ClassVar[LawTable | None] = None
    #: the law as it was given: that of a grid is made for one kappa
    _given_law: ClassVar[LawGrid | LawTable | None] = None
    _names = PARAMETERS
    shape: ClassVar[tuple[int, ...]] = ()
    scale: ClassVar[Scale] = DIMENSIONLESS  # type: ignore[misc]

    def __post_init__(self) -> None:
        """Check the parameters, and replace them by floats or read-only arrays; set ``shape``,
        their broadcast shape.

        A gamma of None stays None.  With a material ``alpha`` becomes that of the material, a float
        or an array (n,).  A :class:`LawTable` is replaced by its material (or by its alpha, with
        None for the material), and kept as ``_law`` for :attr:`table` unless ``coupled`` asks for
        the other kind of law of its bodies.
        Raises ParameterError: both or neither of alpha and material, a material of another type,
        kappa, mu or j that is None, values out of range, NaN or infinite, shapes that do not
        broadcast, mu/kappa outside :data:`RATIO_RANGE`.
        """
        values: dict[str, Any] = {name: getattr(self, name) for name in PARAMETERS}
        material: Any = self.material
        check_one_given(alpha=values["alpha"], material=material)
        if self.coupled is not None:
            check_bool("coupled", self.coupled)
        if isinstance(material, LawGrid | LawTable):
            # as given, for replace(): the table of a grid holds at one kappa
            vars(self)["_given_law"] = material
        if isinstance(material, LawGrid):
            material = material.table(check_number("kappa", values["kappa"], above=0.0))
        if isinstance(material, LawTable):
            if material.gridded or self.coupled in (None, material.coupled is not None):
                vars(self)["_law"] = material
                refuse_other_friction(material, values["mu"])
            material = material.material
        if isinstance(material, Prony | Bodies):
            values["alpha"] = material.alpha
        elif self._given_law is not None:
            values["alpha"] = material
            material = None
        elif material is not None:
            allowed = "a Prony, Bodies, Cover or law of vr.load_law (a Material is for a Cylinder)"
            raise ParameterError("material", describe_value(material), allowed)
        arrays = {"alpha": check_array("alpha", values.pop("alpha"), low=1.0, high=HIGHEST_ALPHA)}
        extents = {}
        for name, value in values.items():
            if name != "gamma" or value is not None:
                arrays[name], extents[name] = check_array_extent(name, value, above=0.0)
        shape = broadcast_shape(**arrays)
        low, high = RATIO_RANGE
        least_mu, most_mu = extents["mu"]
        least_kappa, most_kappa = extents["kappa"]
        # bounds of all ratios first: arrays of many are divided only if these do not suffice
        if not (least_mu >= low * most_kappa and most_mu <= high * least_kappa):
            _refuse_ratio(arrays["mu"], arrays["kappa"])
        # by ``vars``, as the class is frozen
        numbers = {name: read_only(array) for name, array in arrays.items()}
        vars(self).update(numbers, shape=shape, material=material)

    @property
    def table(self) -> LawTable | None:
        """Return the :class:`LawTable` of the scene, from which all its contact states are
        computed.

        It is the one that was given as ``material``, else it is computed at first use and kept for
        later calls (the last 32 laws).  None for several materials (also of shape (1,)) and for an
        array of alphas, unless that has a single element.
        Raises ParameterError for a material with times outside 1e-100 to 1e100 of their unit, or a
        layer too thin.
        """
        if self._law is not None:
            return self._law
        if self.material is not None:
            return law_table(self.material) if self.material_array is None else None
        if type(self.alpha) is float:
            return law_table(self.alpha)
        return law_table(self.alpha.item()) if self.alpha.size == 1 else None

    def scene(self) -> Self:
        """Return the scene itself, so that functions may call it for a scene as for a cylinder.

        Returns
        -------
        Scene
            This object.

        Examples
        --------
        >>> import viscoroll as vr
        >>> vr.presets.RUBBER_ROLLER.scene() is vr.presets.RUBBER_ROLLER
        True
        """
        return self

    def replace(self, **changes: Any) -> Self:
        """Return a copy of the same class with some parameters changed.

        Parameters
        ----------
        changes : new values of alpha, kappa, mu, gamma, j and material by name; an alpha takes the
            place of a material, and the reverse.  Without both the material stays, with its
            :class:`LawTable` if it was given as one.

        Returns
        -------
        Scene
            A new one.

        Raises
        ------
        ParameterError
            As the class does: for values out of range, and for alpha and material together.
        TypeError
            For an unknown name.

        Examples
        --------
        >>> import viscoroll as vr
        >>> vr.presets.RUBBER_ROLLER.replace(alpha=11.0, mu=0.4).alpha
        11.0
        """
        given = self._given_law or self.material
        if changes.keys() & {"alpha", "material"}:
            changes = {"alpha": None, "material": None} | changes
        elif given is not None:
            changes = {"alpha": None, "material": given} | changes
        return dataclasses.replace(self, **changes)

    @property
    def series(self) -> Prony | None:
        """The :class:`Prony` series of the one material, of both bodies together where they differ
        (also of a cover); None where alpha was given, and of several materials.
        """
        one: Any = None if self.material_array is not None else self.material
        return one.total if isinstance(one, Bodies) else one

    @property
    def material_array(self) -> Prony | Bodies | None:
        """The n materials, if the parameter ``material`` holds several; None of one material and of
        alpha.

        A :class:`Prony` of n series is returned as it is.  Of n pairs of bodies whose two bodies
        are alike in each pair, the series of the cylinders, a Prony of n; else the pairs or covers,
        a :class:`Bodies`.  An array of a single material, of shape (1,), counts as several.
        """
        several: Any = self.material
        if several is None or not several.shape:
            return None
        return several.cylinder if isinstance(several, Bodies) and several.like else several

    def in_own_time(self) -> tuple[Any, float]:
        """Return the one material of the scene in its own unit of time, a power of two near its
        slow time.

        The slow time (:attr:`viscoroll.Prony.slow_time`) is that below whose inverse kappa V counts
        as slow.  Curves of a material are kept in that time, so that scenes with one material in
        two units share them.

        Returns
        -------
        material, unit : the series, with times divided by the unit, and the unit divided by T_ref.
            For alpha (alpha, 1.0), where alpha may be an array; for an elastic series (1.0, 1.0);
            for a cover (the cover, 1.0), since its law is not that of the series alone.  Not for
            several materials, of which (their alphas, 1.0) is returned.

        Examples
        --------
        >>> import viscoroll as vr
        >>> vr.Scene(material=vr.Prony([2.0], [8.0]), kappa=10.0, mu=0.3).in_own_time()[1]
        32.0
        """
        if self.cover is not None:
            return self.cover, 1.0
        return (self.alpha, 1.0) if self.series is None else series_in_own_time(self.series)

    @property
    def cover(self) -> Cover | None:
        """The layer of finite thickness on either body; None of half-spaces."""
        return self.material if isinstance(self.material, Cover) else None

    @cached_property
    def tabulated(self) -> bool:
        """Whether the law with traction is a table of the coupled solution: one was given, or shear
        acts on pressure.

        False where ``coupled`` is False, and no table was given.  Of several materials it is that
        of the first one.
        """
        if self._law is not None:
            return self._law.coupled is not None
        if self.coupled is False or not isinstance(self.material, Bodies):
            return False
        from .coupled_tables import is_coupled

        firsts = [self]
        if self.material.shape:
            # a slice: an array of no materials has no first one
            firsts = [self.replace(material=one) for one in self.material[:1]]
        return any(map(is_coupled, firsts))

    @property
    def rolling_law(self) -> LawTable | None:
        """Return the law of states with traction: :attr:`table`, or where :attr:`tabulated` a table
        of the coupled solution, which is made at first use and kept (:mod:`.coupled_tables`).

        Raises ParameterError where there would be a table for each of several bodies or mu, and as
        :attr:`table`.
        """
        return self._made if self.tabulated and self._law is None else self.table

    @cached_property
    def _made(self) -> LawTable:
        """The table of the coupled solution of :attr:`rolling_law`; errors as there."""
        from .coupled_tables import stored_law

        return stored_law(self)

    @property
    def gridded(self) -> bool:
        """Whether the law that was given is a grid (:attr:`.LawTable.gridded`)."""
        return self._law is not None and self._law.gridded

    @property
    def uncoupled(self) -> Self:
        """The scene by the law of its bodies without a table; the scene itself where that is its
        law, or where a grid was given.
        """
        return self.replace(coupled=False) if self.tabulated and not self.gridded else self

    @property
    def like_bodies(self) -> bool:
        """Whether cylinder and half-space deform alike, each taking half of M."""
        return not isinstance(self.material, Bodies) or self.material.like

    def on_slope(self, slope: Any) -> Self:
        """Return the scene under the load P cos(slope), the normal part of the weight on a slope.

        Parameters
        ----------
        slope : angle, rad, in (-pi/2, pi/2), a number or an array, which broadcasts with the
            parameters; None: level.

        Returns
        -------
        Scene
            A new one, whose kappa is divided by sqrt(cos(slope)) and whose gamma, if there is one,
            is multiplied by cos(slope).  The thickness of a cover, which is divided by l0, is
            divided by sqrt(cos(slope)) too; an array of slopes gives as many covers.

        Raises
        ------
        ParameterError
            A slope out of this range, not numeric or with a unit that is no angle; shapes that do
            not broadcast; parameters that the class refuses, as mu/kappa out of its range.

        Examples
        --------
        >>> import viscoroll as vr
        >>> level = vr.presets.RUBBER_ROLLER
        >>> bool(level.on_slope(0.1).gamma < level.gamma)
        True
        """
        cosine = slope_tan_cos(slope)[1]
        cover = self.cover
        thickness = None if cover is None else cover.thickness
        broadcast_shape(slope=cosine, **self.numbers, thickness=thickness)
        changes = {
            "kappa": self.kappa / np.sqrt(cosine),
            "gamma": None if self.gamma is None else self.gamma * cosine,
        }
        if cover is not None:  # its thickness is divided by the l0 of that load
            changes["material"] = cover.of_thickness(thickness / np.sqrt(cosine))
        return self.replace(**changes)

    @property
    def _arrays(self) -> dict[str, Any]:
        """The parameters by name, as they were given: the material in place of its alpha."""
        given = {"material": self.material} | self.numbers
        del given["material" if self.material is None else "alpha"]
        return given

    def __repr__(self) -> str:
        return f"Scene({', '.join(f'{name}={format_value(value)}' for name, value in self._arrays.items())})"  # noqa: E501


def series_in_own_time(series: Prony) -> tuple[float | Prony, float]:
    """Return a series in its own unit of time, in which its slow time is near 1.

    series: one series, with times in units of T_ref.
    Returns (the series with times divided by the unit; the unit in T_ref, a power of two); (1.0,
    1.0), an alpha and a unit, of an elastic series, which has no modes.
    """
    return series.in_own_time() if series.E.size else (1.0, 1.0)


def refuse_other_friction(law: LawTable, mu: Any) -> None:
    """Raise ParameterError where a table of the coupled solution has another mu than the scene.

    law: the law; one without a table holds for every mu.
    mu: coefficient of friction of the scene, a number or an array.
    """
    table = law.coupled
    if table is not None and np.abs(np.asarray(mu) / table.mu - 1.0).max(initial=0.0) > _SAME_MU:
        allowed = f"{table.mu!r}, the mu of the table that is given as material="
        raise ParameterError("mu", format_value(mu), allowed)


def scale_of(roller: Any) -> Scale:
    """Return the scale of a roller; for other objects, which are refused elsewhere, that of a
    scene.
    """
    return roller.scale if isinstance(roller, Roller) else DIMENSIONLESS


def resolve_model(
    roller: Any, call: str, *, moves: bool = False, slope: Any = None
) -> tuple[Roller, Parameters, Scale]:
    """Check the first argument of a call, and return the roller on its slope with its parameters
    and its scale.

    roller: the first argument of the call, of any type.
    call: name of the function that is called, for errors.
    moves: whether the function needs gamma, which a scene may lack.
    slope: angle, rad, in (-pi/2, pi/2), a number or an array that broadcasts with the parameters;
    None: level.
    Returns (the Scene or Cylinder under the load on the slope, the argument itself if ``slope`` is
    None; its dimensionless parameters; its :class:`Scale`: the factor by which each dimensionless
    quantity is multiplied to get the units of the roller, 1 for a Scene).
    Raises ParameterError for what is no scene and no cylinder (for a LawGrid with a message of its
    own), a slope out of range, a scene without gamma where ``moves``, a slope of a shape that does
    not broadcast, and what the scene of a Cylinder does not allow.
    """
    if not isinstance(roller, Roller):
        sentence = f"{call} takes a Scene or a Cylinder, not {describe_value(roller)}"
        if isinstance(roller, LawGrid):
            sentence = (
                f"{call} takes a Scene or a Cylinder, not a grid: give the grid as the material= "
                "of a Scene, or evaluate it by vr.law(grid)"
            )
        raise ParameterError("roller", type(roller).__name__, "a Scene or a Cylinder", sentence)
    if slope is not None:
        roller = roller.on_slope(slope)
    scene = roller.scene()
    if moves and scene.gamma is None:
        sentence = (
            f"{call} needs the scene's gamma = P T^2/(m R) (P, m: load and mass per metre; T: "
            "T_epsilon, or the unit of time of the material), but gamma is not given: give "
            "Scene(..., gamma=), or gamma in the section [scene] of a file"
        )
        raise ParameterError("gamma", None, "a number > 0", sentence)
    return roller, scene, roller.scale


def refuse_cover(scene: Parameters, why: str) -> None:
    """Raise ParameterError where a body of ``scene`` is a layer, or its law a table or a grid.

    ``why``: end of the message, the reason why the function does not take one.
    """
    if scene.cover is not None:
        sentence = f"thickness is given: for a layer of finite thickness {why}"
        raise ParameterError("thickness", scene.cover.thickness, "left out", sentence)
    if scene.tabulated:
        law = "a table of pressure and shear solved together"
        instead = ""
        if scene._law is not None:
            law = "the table or grid given as material="
            instead = " and the materials of the bodies in place of that table or grid"
        raise ParameterError(
            "coupled",
            True,
            "False",
            f"the law of this roller is {law}: {why}.  The call is possible as it stands with "
            f"coupled=False{instead}; the effect of shear on the pressure is then neglected",
        )


#: Arguments from which alpha and kappa may have their shape, each before those that it makes
#: superfluous.
_CAUSES = ("material", "T_epsilon", "T_sigma", "slope", "R", "E", "nu", "load", "m", "g")


def refuse_arrays(
    roller: Roller,
    scene: Parameters,
    names: Iterable[str],
    allowed: str = "a single number in one call: make a call for each",
    slope: Any = None,
) -> None:
    """Raise ParameterError for the first of some parameters that is an array, also of shape (1,).

    roller: as the caller gave it, on no slope.
    scene: its dimensionless parameters, on the slope.
    names: names of the parameters that must be numbers, "alpha", "kappa" or "mu".
    allowed: words of the message that follow "must be", for numbers.
    slope: angle, rad, a number or an array; None: level.
    Returns nothing.  The message names what the caller gave: the load, say, of a cylinder whose
    kappa is an array.
    """
    given = roller._arrays | {"slope": slope}
    for name in names:
        if np.shape(getattr(scene, name)):
            cause = next(each for each in (name, *_CAUSES) if np.shape(given.get(each, 0.0)))
            if cause == "material":
                raise ParameterError(
                    cause, describe_value(given[cause]), "a single material: make a call for each"
                )
            raise shape_error(cause, np.shape(given[cause]), allowed)


def _refuse_ratio(mu: Floats, kappa: Floats) -> None:
    """Raise ParameterError for the first mu/kappa outside :data:`RATIO_RANGE`, if there is one.

    mu, kappa: coefficient of friction and slenderness, > 0, arrays that broadcast.
    """
    low, high = RATIO_RANGE
    with np.errstate(over="ignore", under="ignore"):
        ratio = np.asarray(mu / kappa)
    wrong = ratio[~((low <= ratio) & (ratio <= high))]
    if wrong.size:
        raise ParameterError(
            "mu/kappa (kappa = R/l0, l0: contact length at rest)",
            f"{wrong.flat[0]}",
            f"in [{low:g}, {high:g}]",
        )
