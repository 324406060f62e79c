"""Bodies in contact, dimensionless: pairs of half-spaces (:class:`Bodies`), and layers of finite
thickness (:class:`Cover`).

Two half-spaces: the contact law depends only on the sum of their compliances, J = share J_1 + (1 -
share) J_2, where J_1 is that of the cylinder and J_2 that of the base, each divided by its
long-time value.  This sum is one series again.  The rolling resistance M is a sum over its creep
modes, and the part of M that a body has is the part that its compliance has in each mode.

A layer may be the cover of a roller, or a belt or lining on which a roller runs.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal

import numpy as np

from ..core import (
    ArrayLike,
    Floats,
    Integers,
    ParameterError,
    broadcast_shape,
    check_array,
    check_choice,
    check_number,
    describe_value,
    described_error,
    format_value,
    is_real,
    read_only,
    shape_error,
)
from .prony import Block, OneOrMany, Prony, series_of_alpha, sort_modes
from .prony_forms import HIGHEST_ALPHA, MOST_MODES

# --- Two bodies in contact ---


@dataclass(frozen=True, eq=False, repr=False)
class Bodies(OneOrMany):
    """A cylinder of one material on a half-space of another; or n such pairs.

    Shear acts on the pressure only if ``poisson`` gives a Dundurs' constant above 0.05.

    Parameters
    ----------
    cylinder, base : :class:`Prony` series of the two bodies, with times in one unit T_ref.
    share : the cylinder's part of the long-time compliance, (1/E'_1)/(1/E'_1 + 1/E'_2),
        dimensionless, in [0, 1]; 0: the cylinder is rigid, 1: the half-space is rigid.
        If a body is n series, or ``share`` is an array (n,), these are n pairs: ``p[i]`` is one of
        them, ``p[i:k]`` are some; a single series or number is that of all pairs.
    poisson : Poisson's ratios (nu_1, nu_2) of cylinder and base in plane strain, each in (-1, 0.5].
        By them contact, steady rolling and motions consider that shear acts on the pressure, unless
        the scene has ``coupled=False``.  None (default): ratios with which shear does not act.

    Attributes
    ----------
    shape : (), or (n,).
    alpha : instantaneous divided by long-time stiffness of the pair, a number, or (n,).
    total : the :class:`Prony` series of both bodies together, which the contact law depends on.

    Raises
    ------
    ParameterError
        A body that is no series, different numbers of series, a share outside [0, 1], n pairs of
        more than 64 modes.

    Notes
    -----
    Plane strain, constant Poisson ratios.  No coupling: like bodies, both incompressible, or an
    incompressible body on a rigid one.  Immutable, hashable, equal where the parameters are.

    Examples
    --------
    >>> import viscoroll as vr
    >>> vr.Bodies(vr.Prony([4.0], [1.0]), vr.Prony.elastic(), share=0.5).alpha
    1.6666666666666667
    """

    cylinder: Prony
    base: Prony
    share: Any = 0.5
    poisson: tuple[float, float] | None = None
    _determined_by = "cylinder", "base", "share", "poisson"

    def __post_init__(self) -> None:
        """Check the bodies, set ``shape``, and replace ``share`` by a float or a read-only copy of
        the array.

        The number of modes is checked here for n pairs alone, as the sum of those of both bodies; a
        single pair of more than 64 modes is refused where :attr:`total` is computed.
        Raises ParameterError as the class states.
        """
        bodies = {"cylinder": self.cylinder, "base": self.base}
        for name, body in bodies.items():
            if not isinstance(body, Prony):
                raise ParameterError(
                    name,
                    describe_value(body),
                    "a Prony series, as vr.Prony([2.0], [0.1]); a Material is for vr.Cylinder",
                )
        if self.poisson is not None:
            values = check_both("poisson", self.poisson, above=-1.0, high=0.5)
            vars(self)["poisson"] = tuple(values.tolist())
        share = check_array("share", self.share, low=0.0, high=1.0)
        if share.ndim > 1:
            raise shape_error(
                "share", share.shape, "a number, or a list with one number for each pair of bodies"
            )
        vars(self)["shape"] = broadcast_shape(**bodies, share=share)
        modes = sum(body.E.shape[-1] for body in bodies.values())
        if self.shape and modes > MOST_MODES:
            raise described_error(
                "cylinder and base",
                f"have {modes} Prony terms together",
                f"series of at most {MOST_MODES} terms together",
            )
        vars(self)["share"] = read_only(share)

    @property
    def _same(self) -> bool:
        return self.cylinder == self.base

    @property
    def like(self) -> bool:
        """Whether both bodies deform alike in every pair: then each has half of M, as in the paper,
        and one series is that of both.
        """
        return self.cylinder.shape == self.shape and self._same and bool(np.all(self.share == 0.5))

    @cached_property
    def alpha(self) -> Any:
        """Instantaneous stiffness divided by long-time stiffness, of both bodies together.

        A float >= 1 for a pair, a read-only vector (n,) for n pairs; dimensionless.
        """
        first = self.cylinder.alpha
        second = self.base.alpha
        found = first if self._same else 1.0 / (self.share / first + (1.0 - self.share) / second)
        return np.broadcast_to(found, self.shape) if self.shape else found

    def __getitem__(self, which: Any) -> Bodies:
        parts = (self.cylinder, self.base, self.share)
        cylinder, base, share = (each[which] if np.shape(each) else each for each in parts)
        return Bodies(cylinder, base, share, self.poisson)

    @cached_property
    def _creep(self) -> tuple[Floats, ...]:
        """Return the creep modes of both bodies together; those of equal times are added.

        Returns (strengths divided by the long-time compliance of the pair; retardation times in
        units of T_ref; that part of each strength which is the half-space's, between 0 and the
        strength), (..., modes) each, slowest first, modes without strength last, as those of a
        rigid body.
        """
        share = np.asarray(self.share)[..., None]
        parts = share * self.cylinder.J, (1.0 - share) * self.base.J
        # the half-space's part of each strength: none of the cylinder's modes, all of the base's
        bodies = (0.0 * parts[0], parts[1]), parts, (self.cylinder.T, self.base.T)
        own, J, T = (
            np.concatenate(
                [np.broadcast_to(body, (*self.shape, body.shape[-1])) for body in both], -1
            )
            for both in bodies
        )
        return tuple(sort_modes(J, T, own))

    @cached_property
    def total(self) -> Prony:
        """The :class:`Prony` series of both bodies in the contact law, of the shape of the pairs.

        Of two equal series it is that series, whatever the share is; else a series in creep form.
        Raises ParameterError for a pair of more than 64 modes, or times over more than 32 decades.
        """
        if not self._same:
            return Prony.creep(*self._creep[:2], alpha=self.alpha)
        one = self.cylinder
        return one if one.shape == self.shape else one.repeated(len(self))

    def body(self, name: str) -> tuple[Prony, Any, Any]:
        """Return the series of one body of a pair, its Poisson's ratio, and None: a half-space.

        Parameters
        ----------
        name : "cylinder" or "base".

        Returns
        -------
        tuple
            The :class:`Prony`; Poisson's ratio, 0.5 where ``poisson`` is None; None, in place of a
            thickness.

        Examples
        --------
        >>> vr.Bodies(vr.Prony.elastic(), vr.Prony([2.0], [1.0]), poisson=(0.3, 0.5)).body(
        ...     "cylinder"
        ... )[1]
        0.3
        """
        nu = 0.5 if self.poisson is None else self.poisson[name == "base"]
        return getattr(self, name), nu, None

    @cached_property
    def half_space_weights(self) -> Floats:
        """Return the half-space's part of each creep mode of :attr:`total`, slowest mode first.

        Returns an array (..., modes), kept for later calls, of fractions from 0 to 1 of strengths:
        1 - share for two equal series, else 0 for a mode without strength.
        Raises ParameterError as :attr:`total` does.
        """
        J = self.total.J
        if self._same:
            return np.broadcast_to(1.0 - np.asarray(self.share)[..., None], J.shape).copy()
        # the series leaves out the last modes, which have no strength
        own = self._creep[2][..., : J.shape[-1]]
        return np.divide(own, J, out=np.zeros(J.shape), where=J > 0.0)

    def blocks(self, which: Integers) -> Iterator[Block]:
        """Group the pairs by the number of creep modes of their summed compliance, and yield one
        block of arrays for each number.  Only for n pairs, not for a single one.

        Parameters
        ----------
        which : indices of the pairs, (m,), int; empty: nothing is yielded.

        Yields
        ------
        Block
            With ascending numbers of modes: ``rows``, positions in ``which``, ascending, ``modes``,
            those of both bodies together, and ``weights``, fraction of each creep mode that is the
            half-space's, 0 to 1, (rows, modes).

        Raises
        ------
        TypeError
            A single pair.
        IndexError
            An index beyond the n pairs.

        Examples
        --------
        >>> import numpy as np
        >>> import viscoroll as vr
        >>> pairs = vr.Bodies(vr.Prony([4.0], [1.0]), vr.Prony.elastic(), share=[0.5, 0.8])
        >>> [block.modes.J.shape for block in pairs.blocks(np.arange(2))]
        [(2, 1)]
        """
        selected = self[which]
        for block in selected.total.blocks(np.arange(len(selected))):
            # weights have the columns of the pair with most modes; those of this block come first
            yield block._replace(
                weights=selected.half_space_weights[block.rows, : block.modes.J.shape[-1]]
            )

    def __repr__(self) -> str:
        """Return the call that makes the pair; of many pairs their number and those of modes."""
        if self.shape:
            one, other = (body.E.shape[-1] for body in (self.cylinder, self.base))
            return f"<{len(self)} pairs, Prony terms of the cylinder: {one}, of the base: {other}>"
        poisson = "" if self.poisson is None else f", poisson={self.poisson!r}"
        return (
            f"Bodies(cylinder={self.cylinder!r}, base={self.base!r}, share={self.share!r}{poisson})"
        )


def check_both(name: str, value: ArrayLike, **bounds: Any) -> Floats:
    """Check an argument that is two numbers, of cylinder and base, and return them, (2,).

    name, value, bounds: as in :func:`.arrays.check_array`, whose errors are raised too.
    """
    array = check_array(name, value, **bounds)
    if array.shape != (2,):
        raise shape_error(name, array.shape, "two numbers, of cylinder and base")
    return array


def total_series(material: float | Prony | Bodies) -> Prony:
    """Return the series of a material: that of an alpha, a series itself, or that of both bodies
    together.

    material: alpha >= 1 as a float, not checked, with T_epsilon for the unit of time; a
        :class:`Prony`; or :class:`Bodies`.
    Returns a :class:`Prony`, of the shape of the material, () for an alpha, times in the unit of
    the material.
    Raises ParameterError as :attr:`Bodies.total` does.
    """
    if isinstance(material, Bodies):
        return material.total
    return material if isinstance(material, Prony) else series_of_alpha(material)


# --- A cover, belt or lining of finite thickness under or on a roller, dimensionless ---

#: thickness divided by l0 beyond which a body is a half-space to rounding at any speed of interest
_THICKEST = 1e15
#: largest relative difference of the proportions of two thicknesses that count as one
_SAME_RATIO = 1e-9


@dataclass(frozen=True, eq=False, repr=False, init=False)
class Cover(Bodies):
    """A viscoelastic layer bonded to a rigid core or bed, rolling against a rigid body, a
    half-space or another layer.

    It is the ``material`` of a :class:`viscoroll.Scene`.  In SI units a :class:`viscoroll.Material`
    has a ``thickness`` instead.

    Parameters
    ----------
    series : the layer's :class:`Prony` series, times in units of T_ref; or its alpha >= 1, with
        T_epsilon for the unit of time.
    nu : Poisson's ratio of the layer, in [0, 0.5], constant in time; a number, or one for each
        thickness, (n,).  Laws are then interpolated: with an error of 1e-9 from h/l0 = 0.25 up, of
        5e-9 down to 0.13.
    thickness : h/l0, dimensionless, > 0; l0 is the contact length at rest that the same bodies
        would have as half-spaces.  Half the contact at rest may be at most six thicknesses long.
        An array (n,) makes n covers, of which ``cover[i]`` is one, for an array parameter of a
        scene or for the motions of an ensemble.
    on : "cylinder" (a covered roller; default) or "base" (a belt or lining that a roller runs on).
    part : the layer's part of the long-time compliance of both bodies as half-spaces, in (0, 1]; 1
        (default): the other body is rigid.
    other_nu : Poisson's ratio of the other body; only where ``part`` < 1.
    other : series of the other body if it relaxes too, times in units of T_ref; default: elastic.
    other_thickness : h/l0 of the other body if it is a layer too, as in a nip of two covered
        rollers; default: it is a half-space.  Only where ``part`` < 1; of n covers (n,), in one
        proportion to ``thickness``.

    Raises
    ------
    ParameterError
        A value out of range, a series of many materials; where the law is computed, a thin cover.

    Examples
    --------
    >>> import viscoroll as vr
    >>> cover = vr.Cover(vr.Prony([10.0], [1 / 11.0]), nu=0.5, thickness=1.0)
    >>> scene = vr.Scene(material=cover, kappa=10.0, mu=0.5)
    >>> state = vr.contact(scene, 0.03, delta=0.0)

    Notes
    -----
    Without traction lam, epsilon, M and delta_star solve the normal and the full-slip problem of
    the layers to 1e-11; boundary elements agree to 2e-6 (``pipeline/evidence/prove/states.py``).
    Beside a half-space that relaxes too, epsilon and M are good to 1e-7 where kappa |V| is 16 to
    1e8 times the fastest rate (``tests/test_covers.py``).  Shear acts back to first order
    (docs/theory_covers.md), with coefficients to 1e-8 of delta_star/mu where nu = 1/2, else to
    5e-5; :func:`viscoroll.validity` states the error by it.

    Q follows Eq. (15) with the contact of the cover in place of that of half-spaces: what the
    stick zone takes from the traction of full slip is that of a whole contact on the same cover,
    at the speed V' with delta_star(V')/V' = (delta_star(V) - |delta - delta_0|)/V.  Beside the
    exact solution without coupling Q/mu is off by at most 1, 3, 4.5 and 6.5 % at h/l0 = 5, 1, 0.5
    and 0.2, and a third less where nu is near 1/2 (``make prove``; :func:`viscoroll.validity`
    states it).
    """

    nu: Any = 0.5
    thickness: Any = 1.0
    on: Literal["cylinder", "base"] = "cylinder"
    other_nu: float = 0.5
    other_thickness: Any = None
    _determined_by = (  # type: ignore[assignment]
        *Bodies._determined_by,
        "on",
        "nu",
        "thickness",
        "other_nu",
        "other_thickness",
    )

    def __init__(
        self,
        series: Prony | float,
        *,
        nu: ArrayLike,
        thickness: ArrayLike,
        on: Literal["cylinder", "base"] = "cylinder",
        part: float = 1.0,
        other_nu: float = 0.5,
        other: Prony | None = None,
        other_thickness: ArrayLike | None = None,
    ) -> None:
        """Check the parameters and make one or many covers.

        series: :class:`Prony` series of the layer, times in units of T_ref, or its alpha, a number
            in [1, 1e12], with T_epsilon for the unit of time.
        nu: Poisson's ratio of the layer, in [0, 0.5], a number, or (n,) if ``thickness`` is (n,).
        thickness: thickness divided by l0, in (0, 1e15], a number or (n,).
        on: body that has the layer, "cylinder" or "base".
        part: part of the layer in the long-time compliance of both bodies as half-spaces, in (0,
            1].
        other_nu: Poisson's ratio of the other body, in [0, 0.5]; without effect if ``part`` is 1.
        other: series of the other body, times in units of T_ref; None: elastic.
        other_thickness: thickness of the other body divided by l0, in (0, 1e15], of the shape of
            ``thickness``; None: a half-space.
        Sets the fields of :class:`Bodies` (cylinder, base, share), nu, thickness, on, other_nu,
        other_thickness, and ``shape``.
        Raises ParameterError for a value out of range, a ``series`` or ``other`` of many materials
        or of another type, shapes that do not agree, and an ``other_thickness`` of a rigid body or
        in several proportions to ``thickness``.  A cover that is too thin for its law is refused
        where the law is computed.
        """
        if is_real(series):
            series = series_of_alpha(check_number("series", series, low=1.0, high=HIGHEST_ALPHA))
        other = Prony.elastic() if other is None else other
        for name, body, also in (("series", series, "a number alpha"), ("other", other, "None")):
            if not isinstance(body, Prony) or body.shape:
                raise ParameterError(
                    name,
                    describe_value(body),
                    f"a Prony series of one material, as vr.Prony([2.0], [0.1]), or {also}",
                )
        check_choice("on", on, "cylinder", "base")
        ratio = check_array("nu", nu, low=0.0, high=0.5)
        other_nu = check_number("other_nu", other_nu, low=0.0, high=0.5)
        part = check_number("part", part, above=0.0, high=1.0)
        given = check_array("thickness", thickness, above=0.0, high=_THICKEST)
        if given.ndim > 1:
            raise shape_error("thickness", given.shape, "a number, or one number for each cover")
        like = f"of shape {given.shape}, as thickness" if given.ndim else "a number, as thickness"
        if ratio.shape not in ((), given.shape):
            raise shape_error("nu", ratio.shape, "a number or " * given.ndim + like)
        if other_thickness is not None:
            second = check_array("other_thickness", other_thickness, above=0.0, high=_THICKEST)
            if part == 1.0:
                raise ParameterError(
                    "other_thickness",
                    second,
                    "left out, or given with part < 1 (part of the layer in the compliance of both "
                    "bodies); part = 1, the default, means that the other body is rigid",
                )
            if second.shape != given.shape:
                raise shape_error("other_thickness", second.shape, like)
            # laws are interpolated as functions of one thickness
            proportion = second / given
            if np.ptp(proportion) > _SAME_RATIO * np.max(proportion):
                raise described_error(
                    "other_thickness",
                    f"is {proportion.min():.9g} to {proportion.max():.9g} times thickness",
                    "the same multiple of thickness for all covers",
                )
            other_thickness = read_only(second)
        cylinder, base = (series, other) if on == "cylinder" else (other, series)
        vars(self).update(
            cylinder=cylinder,
            base=base,
            share=part if on == "cylinder" else 1.0 - part,
            on=on,
            other_nu=other_nu,
            other_thickness=other_thickness,
            thickness=read_only(given),
            nu=read_only(ratio),
        )
        super().__post_init__()
        # of the series and the share, which are single, the shape would be ()
        vars(self)["shape"] = given.shape

    @property
    def like(self) -> bool:
        """False: all of M is the layer's."""
        return False

    @property
    def layer(self) -> Prony:
        """Series of the layer alone."""
        return self.cylinder if self.on == "cylinder" else self.base

    @property
    def other(self) -> Prony:
        """Series of the other body."""
        return self.base if self.on == "cylinder" else self.cylinder

    @property
    def part(self) -> float:
        """The layer's part of the long-time compliance, in (0, 1]."""
        return float(self.share if self.on == "cylinder" else 1.0 - self.share)

    @property
    def thinnest(self) -> Any:
        """Thickness of the thinner layer divided by l0, a number or (n,)."""
        return (
            self.thickness
            if self.other_thickness is None
            else np.minimum(self.thickness, self.other_thickness)
        )

    def body(self, name: str) -> tuple[Prony, Any, Any]:
        """Return the series of one body, its Poisson's ratio, and its thickness divided by l0, None
        of a half-space.

        Parameters
        ----------
        name : "cylinder" or "base"; of a rigid body series and Poisson's ratio have no meaning.

        Returns
        -------
        tuple
            The :class:`Prony`; Poisson's ratio, dimensionless; thickness divided by l0, or None.

        Examples
        --------
        >>> vr.Cover(11.0, nu=0.5, thickness=2.0, on="base").body("base")[1:]
        (0.5, 2.0)
        """
        if name == self.on:
            return self.layer, self.nu, self.thickness
        return self.other, self.other_nu, self.other_thickness

    def elastic(self, share: float) -> Cover:
        """Return the same bodies without relaxation.

        Parameters
        ----------
        share : compliance of the cylinder divided by the sum of both compliances, each as a
            half-space, in [0, 1]; such that the compliance of the layer is not 0.

        Returns
        -------
        Cover
            Elastic bodies of the same thicknesses and Poisson's ratios.  If the share of the other
            body is 0, it is rigid, and its thickness is None.

        Examples
        --------
        >>> vr.Cover(11.0, nu=0.5, thickness=2.0, on="base").elastic(0.0).alpha
        1.0
        """
        part = share if self.on == "cylinder" else 1.0 - share  # of the layer
        thickness = self.other_thickness if part < 1.0 else None
        return Cover(
            1.0,
            nu=self.nu,
            thickness=self.thickness,
            on=self.on,
            part=part,
            other_nu=self.other_nu,
            other_thickness=thickness,
        )

    def of_thickness(self, thickness: ArrayLike, nu: ArrayLike | None = None) -> Cover:
        """Return a :class:`Cover` of the same bodies with other thicknesses and Poisson's ratios.

        Parameters
        ----------
        thickness : thickness divided by l0, in (0, 1e15], a number or (n,); that of another layer
            stays in proportion.
        nu : Poisson's ratio of the layer, in [0, 0.5], a number or, beside an array of thicknesses,
            (n,); None: the nu of this cover, whose shape must then fit that of ``thickness``.

        Returns
        -------
        Cover
            New, of shape (), or (n,) of n thicknesses.

        Raises
        ------
        ParameterError
            For values out of range, and shapes that do not agree.

        Examples
        --------
        >>> import viscoroll as vr
        >>> vr.Cover(1.0, nu=0.3, thickness=0.5).of_thickness([0.2, 0.4]).thickness
        array([0.2, 0.4])
        """
        other = self.other_thickness
        if other is not None:
            # all covers have the same ratio of both thicknesses, so that the first elements suffice
            other = np.ravel(other)[0] / np.ravel(self.thickness)[0] * np.asarray(thickness)
        return Cover(
            self.layer,
            nu=self.nu if nu is None else nu,
            thickness=thickness,
            on=self.on,
            part=self.part,
            other_nu=self.other_nu,
            other=self.other,
            other_thickness=other,
        )

    def __getitem__(self, which: Any) -> Cover:
        return self.of_thickness(
            self.thickness[which], self.nu[which] if np.ndim(self.nu) else None
        )

    def __repr__(self) -> str:
        """Return the call that makes the cover, without parameters that have no effect."""
        text = f"Cover({self.layer!r}, nu={format_value(self.nu)}"
        text += f", thickness={format_value(self.thickness)}, on={self.on!r}"
        if self.part < 1.0:
            text += f", part={self.part!r}, other_nu={self.other_nu!r}"
        if self.other.alpha > 1.0:
            text += f", other={self.other!r}"
        if self.other_thickness is not None:
            text += f", other_thickness={format_value(self.other_thickness)}"
        return f"{text})"
