"""A measured motion: :class:`Coastdown`."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import KW_ONLY, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..checks import checked, number
from ..cylinder import Cylinder
from ..drive import Feedback
from ..errors import ParameterError
from ..typed import Numbers
from .records import Record

#: of a motion: free, and driven, whose outputs are smooth in the parameters to 2e-12 at this one
_RTOL, _RTOL_DRIVEN = 1e-8, 1e-10
#: what a start may be in place of a number: V0/R
ROLLING = "rolling"


@dataclass(frozen=True, eq=False)
class Coastdown(Record):
    """Speeds or way over time of a roller that was thrown or let go.

    Parameters
    ----------
    t : times, s, ascending.
    V, omega, x : speed of the axis, m/s, angular velocity, rad/s, way since the release, m; at least one, of a plan
        none.
    V0 : speed at the release, m/s; default: unknown, about what the first values say.
    omega0 : angular velocity at the release, rad/s; "rolling" (default): V0/R; None: unknown, likewise.
    t0 : time of the release, s, before which the roller has its first speeds; (low, high): unknown.
    m : mass with which it rolled, kg/m, in place of the cylinder's.
    sigma : as of :class:`Resistance`; of several quantities {"V": ..., "omega": ...}, which of a plan says what is
        measured.
    load, temperature, name : as of :class:`Resistance`.

    Raises
    ------
    ParameterError
        As there; times that fall.
    """

    PLACES, KINDS, KIND = ("t",), ("V", "omega", "x"), "run"

    t: Numbers
    V: Numbers | None = None
    omega: Numbers | None = None
    x: Numbers | None = None
    _: KW_ONLY
    V0: float | None = None
    omega0: float | str | None = ROLLING
    t0: float | tuple[float, float] = 0.0
    m: float | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        t = np.asarray(self.t)
        if t.ndim != 1 or (back := np.flatnonzero(np.diff(t) < 0.0)).size:
            at = (
                f"{t[back[0]]:g}, {t[back[0] + 1]:g} at rows {back[0]}, {back[0] + 1}"
                if t.ndim == 1
                else f"of shape {t.shape}"
            )
            raise ParameterError(self._of("t"), at, "a vector in ascending order")
        if isinstance(self.omega0, str) and self.omega0 != ROLLING:
            raise ParameterError(self._of("omega0"), repr(self.omega0), f"a number, {ROLLING!r} or None")
        for name in ("V0", "omega0", "m"):
            if isinstance(value := getattr(self, name), (str, type(None))):
                continue
            low = 0.0 if name == "m" else -math.inf
            self._set(name, number(self._of(name), value, low=low, strict=True))
        ends = checked(self._of("t0"), self.t0)
        if ends.shape not in ((), (2,)) or (ends.ndim and not ends[0] < ends[1]):
            raise ParameterError(self._of("t0"), self.t0, "a number, or (low, high)")
        self._set("t0", tuple(ends.tolist()) if ends.ndim else float(ends))
        if self.V0 is None and self.planned:
            raise ParameterError(
                self._of("V0"), None, "a number", f"{self._of('V0')} is not given: a plan has no data to take it from"
            )

    @property
    def own(self) -> dict[str, float]:
        return super().own | ({} if self.m is None else {"m": self.m})

    def starts(self, cylinder: Cylinder) -> dict[str, tuple[float, float, float]]:
        found = {}
        for name, given in (("V", self.V0), ("omega", self.omega0)):
            if given is None:
                first, most = self._first(name, cylinder.R)
                found[f"{name}0"] = (first, first - most, first + most)
        if isinstance(self.t0, tuple):
            found["t0"] = (min(max(0.0, self.t0[0]), self.t0[1]), *self.t0)
        return found

    def _first(self, name: str, R: float) -> tuple[float, float]:
        """A speed at the release by the data, and the largest of it."""
        given = getattr(self, name)
        if given is None and name == "V" and self.omega0 == ROLLING and self.omega is not None:
            given = R * np.asarray(self.omega)
        if given is None and name == "V" and self.x is not None:
            some = slice(0, max(3, np.size(self.t) // 10))
            given = np.polyfit(np.asarray(self.t)[some], np.asarray(self.x)[some], 1)[:1]
        if given is None:
            sentence = f"{self._of(name)}0 is not given, and the data do not show it: give a number"
            raise ParameterError(self._of(f"{name}0"), None, "a number", sentence)
        return float(given[0]), float(np.max(np.abs(given)))

    def model(self, cylinder: Cylinder, values: Mapping[str, float]) -> dict[str, NDArray[np.float64]]:
        first, t = self._release(cylinder, values)
        found = {name: np.full(t.shape, value) for name, value in first.items()}
        if (late := t >= 0.0).any():
            motion = self._rolled(cylinder, first, t[late], values)
            for name, column in found.items():
                column[late] = getattr(motion, name)
        return found

    def slipping(self, cylinder: Cylinder, values: Mapping[str, float]) -> int:
        """How many of its points fall into full slip."""
        first, t = self._release(cylinder, values)
        late = t[t >= 0.0]
        return int((self._rolled(cylinder, first, late, values).regime == 0).sum()) if late.size else 0

    def _release(self, cylinder: Cylinder, values: Mapping[str, float]) -> tuple[dict[str, Any], NDArray[np.float64]]:
        """First speeds and way, and times since then."""
        V0, omega0 = values.get("V0", self.V0), values.get("omega0", self.omega0)
        omega0 = V0 / cylinder.R if omega0 == ROLLING else omega0
        return {"V": V0, "omega": omega0, "x": 0.0}, np.asarray(self.t) - values.get("t0", self.t0)

    @staticmethod
    def _rolled(cylinder: Cylinder, first: dict[str, Any], t: NDArray[np.float64], values: Mapping[str, float]) -> Any:
        """The motion from the release on, with the bearing of ``values``."""
        drive: dict[str, Any] = {}
        if values.get("brake", 0.0) > 0.0:
            drive["brake"] = values["brake"]
        if values.get("drag", 0.0) != 0.0:
            drive["torque"] = Feedback(0.0, omega=-values["drag"])
        return cylinder.roll(first["V"], first["omega"], t, _RTOL_DRIVEN if drive else _RTOL, **drive)
