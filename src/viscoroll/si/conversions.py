"""Numbers of a cylinder to and from SI units: :class:`Conversions`."""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..errors import ParameterError, one_of
from ..materials.pair import Pair


class Conversions:
    """``*_from_si`` and ``*_to_si`` of a cylinder: numbers or arrays, good to a few roundings."""

    R: Any

    @property
    def T_ref(self) -> float:
        """What dimensionless times are counted in, s."""
        raise NotImplementedError

    @property
    def load(self) -> Any:
        """P, N/m."""
        raise NotImplementedError

    @cached_property
    def pair(self) -> Pair:
        """Both materials."""
        raise NotImplementedError

    def V_from_si(self, V_si: ArrayLike) -> Any:
        """Dimensionless V = T_ref V_si/R from m/s."""
        return np.asarray(V_si, float)[()] * (self.T_ref / self.R)

    def V_to_si(self, V: ArrayLike) -> Any:
        """Speed in m/s."""
        return np.asarray(V, float)[()] * (self.R / self.T_ref)

    def omega_from_si(self, omega_si: ArrayLike) -> Any:
        """Dimensionless omega = T_ref omega_si from rad/s."""
        return np.asarray(omega_si, float)[()] * self.T_ref

    def omega_to_si(self, omega: ArrayLike) -> Any:
        """Angular velocity in rad/s."""
        return np.asarray(omega, float)[()] / self.T_ref

    def t_from_si(self, t_si: ArrayLike) -> Any:
        """Dimensionless time t_si/T_ref from s."""
        return np.asarray(t_si, float)[()] / self.T_ref

    def t_to_si(self, t: ArrayLike) -> Any:
        """Time in s."""
        return np.asarray(t, float)[()] * self.T_ref

    def x_to_si(self, x: ArrayLike) -> Any:
        """Distance travelled in m, from units of R."""
        return np.asarray(x, float)[()] * self.R

    def traction_to_si(self, Q: ArrayLike, M: ArrayLike | None = None, *, M_half_space: ArrayLike | None = None) -> Any:
        """Horizontal force F_xi = P (Q - M_half_space), N per m of length; of like bodies by M/2, Eq. (20).

        Raises
        ------
        ParameterError
            Both or neither moment, or M alone where the bodies differ: the half-space's part is needed.
        """
        return self.load * (np.asarray(Q, float) - self._part(M, M_half_space, "M_half_space"))[()]

    def torque_to_si(self, Q: ArrayLike, M: ArrayLike | None = None, *, M_cylinder: ArrayLike | None = None) -> Any:
        """Moment about the axis M_zeta = P R (Q + M_cylinder), N m per m of length; of like bodies by M/2, Eq. (21).

        Raises
        ------
        ParameterError
            Both or neither moment, or M alone where the bodies differ: the cylinder's part is needed.
        """
        return self.load * self.R * (np.asarray(Q, float) + self._part(M, M_cylinder, "M_cylinder"))[()]

    def _part(self, M: ArrayLike | None, own: ArrayLike | None, name: str) -> Any:
        """The moment of one body."""
        if (M is None) == (own is None):
            raise one_of("M", name, both=M is not None)
        if own is not None:
            return np.asarray(own, float)
        if not self.pair.like:
            sentence = f"give {name} in place of M: the bodies differ, and with them their parts"
            raise ParameterError("M", "of both bodies", f"left out for {name}", sentence)
        return 0.5 * np.asarray(M, float)
