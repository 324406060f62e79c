"""Two bodies in contact: :class:`Bodies`, a cylinder of one linear viscoelastic material on a half-space of another.

The contact law depends on the sum of their compliances alone, J = share J_1 + (1 - share) J_2, which is one series
again.  The part of the rolling resistance M that a body has is that of its creep modes.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core.array_types import Floats, Integers
from ..core.checks import broadcast_shape, check_array, check_number, read_only
from ..core.errors import ParameterError, described_error, shape_error
from .prony import Block, OneOrMany, Prony, series_of_alpha, sort_modes
from .prony_forms import MOST_MODES


@dataclass(frozen=True, eq=False, repr=False)
class Bodies(OneOrMany):
    """A pair of materials whose tangential and normal contact do not couple (Dundurs' second constant is 0); or n.

    Parameters
    ----------
    cylinder, base : :class:`Prony` series of the two bodies, with times in one unit T_ref.
    share : the cylinder's part of the long-time compliance, (1/E'_1)/(1/E'_1 + 1/E'_2), dimensionless, in [0, 1]; 0:
        the cylinder is rigid, 1: the half-space is rigid.
        If a body is n series, or ``share`` is an array (n,), these are n pairs: ``p[i]`` is one of them, ``p[i:k]`` are
        some; a single series or number is that of all pairs.
    poisson : Poisson's ratios of cylinder and base in plane strain, each in (-1, 0.5], of which
        ``contact(method="coupled")`` computes how shear and pressure couple; other calls take them as uncoupled.
        None (default): like ratios, of bodies that do not couple.

    Attributes
    ----------
    shape : (), or (n,).
    alpha : instantaneous divided by long-time stiffness of the pair, a number, or (n,).
    total : the :class:`Prony` series of both bodies together, which the contact law depends on.

    Raises
    ------
    ParameterError
        A body that is no series, different numbers of series, a share outside [0, 1], n pairs of more than 64 modes.

    Notes
    -----
    Plane strain, constant Poisson ratios.  No coupling: like bodies, both incompressible, or an incompressible body on
    a rigid one.  Immutable, hashable, equal where the parameters are.

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

    def __post_init__(self) -> None:
        """Check the bodies, set ``shape``, and replace ``share`` by a float or a read-only copy of the array.

        The number of modes is checked here for n pairs alone, as the sum of those of both bodies; a single pair of more
        than 64 modes is refused where :attr:`total` is computed.
        Raises ParameterError as the class states.
        """
        bodies = {"cylinder": self.cylinder, "base": self.base}
        for name, body in bodies.items():
            if not isinstance(body, Prony):
                raise ParameterError(name, f"{body!r:.60}", "a Prony series, or one for each pair")
        if self.poisson is not None:
            values = [check_number("poisson", value, above=-1.0, high=0.5) for value in self.poisson]
            object.__setattr__(self, "poisson", tuple(values))
        share = check_array("share", self.share, low=0.0, high=1.0)
        if share.ndim > 1:
            raise shape_error("share", share.shape, "a number, or one for each pair, (n,)")
        many = {name: np.empty(body.shape) for name, body in bodies.items()}
        object.__setattr__(self, "shape", broadcast_shape(**many, share=share))
        modes = sum(body.E.shape[-1] for body in bodies.values()) if self.shape else 0
        if modes > MOST_MODES:
            raise described_error("the pair", f"has {modes} modes", f"a pair of at most {MOST_MODES} modes")
        object.__setattr__(self, "share", read_only(share))

    @property
    def _same(self) -> bool:
        return self.cylinder == self.base

    @property
    def like(self) -> bool:
        """Whether both bodies deform alike in every pair: then each has half of M, as in the paper, and one series
        is that of both.
        """
        return self.cylinder.shape == self.shape and self._same and bool(np.all(self.share == 0.5))

    @cached_property
    def alpha(self) -> Any:
        """Instantaneous divided by long-time stiffness, >= 1, of the pair a float, of n pairs a read-only (n,)."""
        first, second = self.cylinder.alpha, self.base.alpha
        found = first if self._same else 1.0 / (self.share / first + (1.0 - self.share) / second)
        return np.broadcast_to(found, self.shape) if self.shape else found

    def __getitem__(self, which: Any) -> Bodies:
        parts = (self.cylinder, self.base, self.share)
        cylinder, base, share = (each[which] if np.shape(each) else each for each in parts)
        return Bodies(cylinder, base, share, self.poisson)

    @cached_property
    def _creep(self) -> tuple[NDArray, ...]:
        """Return the creep modes of both bodies together; those of equal times are added.

        Returns (strengths divided by the long-time compliance of the pair; retardation times in units of T_ref; that
        part of each strength which is the half-space's, between 0 and the strength), (..., modes) each, slowest first,
        modes without strength last, as those of a rigid body.
        """
        share = np.asarray(self.share)[..., np.newaxis]
        parts = share * self.cylinder.J, (1.0 - share) * self.base.J
        bodies = (0.0 * parts[0], parts[1]), parts, (self.cylinder.T, self.base.T)
        own, J, T = (
            np.concatenate([np.broadcast_to(body, (*self.shape, body.shape[-1])) for body in both], -1)
            for both in bodies
        )
        return tuple(sort_modes(J, T, own))

    @cached_property
    def total(self) -> Prony:
        """The :class:`Prony` series that stands for both in the contact law, of the shape of the pairs.

        Of two equal series it is that series, whatever the share is; else a series in creep form.
        Raises ParameterError for a single pair of more than 64 modes, or times that span more than 32 decades.
        """
        if not self._same:
            return Prony.creep(*self._creep[:2], alpha=self.alpha)
        one = self.cylinder
        return one if one.shape == self.shape else one.repeated(len(self))

    def body(self, name: str) -> tuple[Prony, Any, Any]:
        """Return the series of one body of a single pair, its Poisson's ratio, and None: it is a half-space.

        name : "cylinder" or "base".
        """
        nu = 0.5 if self.poisson is None else self.poisson[name == "base"]
        return getattr(self, name), nu, None

    @cached_property
    def half_space_weights(self) -> Floats:
        """Return the half-space's part of each creep mode of :attr:`total`, divided by the mode's strength, slowest
        mode first.

        Returns an array (..., modes), kept for later calls, of numbers from 0 to 1, dimensionless: 1 - share for two
        equal series, else 0 for a mode without strength.
        Raises ParameterError as :attr:`total` does.
        """
        J = self.total.J
        if self._same:
            return np.broadcast_to(1.0 - np.asarray(self.share)[..., np.newaxis], J.shape).copy()
        own = self._creep[2][..., : J.shape[-1]]
        return np.divide(own, J, out=np.zeros(J.shape), where=J > 0.0)

    def blocks(self, which: Integers) -> Iterator[Block]:
        """Yield pairs in blocks of equal numbers of modes of both bodies together, for computations on whole arrays.

        It is for n pairs, not for a single one.

        Parameters
        ----------
        which : indices of the pairs, (m,), int; empty: nothing is yielded.

        Yields
        ------
        Block
            One with weights for each number of modes that occurs, ascending: ``rows``, places in ``which``, ascending,
            ``modes``, the modes of both bodies together, and ``weights``, the half-space's part of each, (rows, modes).

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
        some = self[which]
        for block in some.total.blocks(np.arange(len(some))):
            yield block._replace(weights=some.half_space_weights[block.rows, : block.modes.J.shape[-1]])

    @cached_property
    def _key(self) -> tuple[Any, ...]:
        return self.cylinder, self.base, np.shape(self.share), np.asarray(self.share).tobytes(), self.poisson

    def __repr__(self) -> str:
        if self.shape:
            modes = (body.E.shape[-1] for body in (self.cylinder, self.base))
            return f"<{len(self)} pairs of {' and '.join(map(str, modes))} modes>"
        poisson = "" if self.poisson is None else f", poisson={self.poisson!r}"
        return f"Bodies(cylinder={self.cylinder!r}, base={self.base!r}, share={self.share!r}{poisson})"


def total_series(material: float | Prony | Bodies) -> Prony:
    """Return the series of a material: that of an alpha, a series itself, or that of both bodies together.

    material: alpha >= 1 as a float, not checked, with T_epsilon for the unit of time; a :class:`Prony`; or
        :class:`Bodies`.
    Returns a :class:`Prony`, of the shape of the material, () for an alpha, times in the unit of the material.
    Raises ParameterError as :attr:`Bodies.total` does.
    """
    if isinstance(material, Bodies):
        return material.total
    return material if isinstance(material, Prony) else series_of_alpha(material)
