"""Two bodies in contact: :class:`Bodies`, a cylinder of one linear viscoelastic material on a half-space of another.

The contact law knows the sum of their compliances alone, J = share J_1 + (1 - share) J_2, one series again.  What the
rolling resistance M takes of each body is the share of its creep modes in M.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..checks import number
from ..errors import ParameterError
from .bodies_array import BodiesArray
from .prony import Prony
from .prony_array import PronyArray


@dataclass(frozen=True)
class Bodies:
    """A pair of materials whose tangential and normal contact do not couple (Dundurs' second constant is 0).

    Parameters
    ----------
    cylinder, half_space : their series, times over one T_ref.
    share : the cylinder's part of the long-time compliance, (1/E'_1)/(1/E'_1 + 1/E'_2), in [0, 1]; 0: the cylinder is
        rigid, 1: the half-space is.
        Where a body is n series (a :class:`PronyArray`), or ``share`` is an array (n,), these are n pairs, a
        :class:`BodiesArray`; what is single is that of all.

    Raises
    ------
    ParameterError
        What is no series, or a share outside [0, 1].

    Notes
    -----
    Plane strain, constant Poisson ratios.  No coupling: like bodies, both incompressible, or an incompressible body on
    a rigid one.
    """

    cylinder: Prony
    half_space: Prony
    share: Any = 0.5  # a number: arrays make a BodiesArray

    def __new__(cls, cylinder: Any = None, half_space: Any = None, share: Any = 0.5) -> Any:
        if not any(isinstance(body, PronyArray) for body in (cylinder, half_space)) and not np.ndim(share):
            return super().__new__(cls)
        return BodiesArray(cylinder, half_space, share, one=cls)

    def __post_init__(self) -> None:
        for name in ("cylinder", "half_space"):
            if not isinstance(getattr(self, name), Prony):
                raise ParameterError(name, f"{getattr(self, name)!r:.60}", "a Prony series, or one for each pair")
        share = number("share", self.share, low=0.0)
        if share > 1.0:
            raise ParameterError("share", share, "in [0, 1]")
        object.__setattr__(self, "share", share)

    @property
    def like(self) -> bool:
        """Whether the two deform alike: M is shared evenly, as the paper has it."""
        return self.cylinder == self.half_space and self.share == 0.5

    @cached_property
    def total(self) -> Prony:
        """The series that stands for both in the contact law."""
        if self.cylinder == self.half_space:
            return self.cylinder
        first, second = self.cylinder, self.half_space
        J = np.concatenate([self.share * first.J, (1.0 - self.share) * second.J])
        alpha = 1.0 / (self.share / first.alpha + (1.0 - self.share) / second.alpha)
        return Prony.creep(J, np.concatenate([first.T, second.T]), alpha=alpha)

    @cached_property
    def half_space_weights(self) -> NDArray[np.float64]:
        """What of the strength of each creep mode of ``total``, slowest first, is the half-space's."""
        own = dict(zip(self.half_space.T.tolist(), ((1.0 - self.share) * self.half_space.J).tolist(), strict=True))
        if self.cylinder == self.half_space:
            return np.full(self.total.T.size, 1.0 - self.share)
        return np.array([own.get(T, 0.0) for T in self.total.T.tolist()]) / self.total.J

    @property
    def alpha(self) -> float:
        """Instantaneous over long-time stiffness of the pair."""
        return self.total.alpha
