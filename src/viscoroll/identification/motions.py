"""A measured motion: :class:`Coastdown`."""

from __future__ import annotations

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
        if t.ndim > 1:
            raise ParameterError(self._of("t"), f"of shape {t.shape}", "a vector")
        if (back := np.flatnonzero(np.diff(t) < 0.0)).size:
            n = int(back[0])
            raise ParameterError(self._of("t"), f"{t[n]:g}, {t[n + 1]:g} at rows {n}, {n + 1}", "in ascending order")
        if isinstance(self.omega0, str) and self.omega0 != ROLLING:
            raise ParameterError(self._of("omega0"), repr(self.omega0), f"a number, {ROLLING!r} or None")
        for name in ("V0", "omega0"):
            value = getattr(self, name)
            if value is not None and not (name == "omega0" and isinstance(value, str)):
                self._set(**{name: number(self._of(name), value)})
        ends = checked(self._of("t0"), self.t0)
        if ends.shape not in ((), (2,)) or (ends.ndim and not ends[0] < ends[1]):
            raise ParameterError(self._of("t0"), self.t0, "a number, or (low, high)")
        self._set(t0=tuple(ends.tolist()) if ends.ndim else float(ends))
        if self.V0 is None and self.planned:
            sentence = f"{self._of('V0')} is not given: a plan has no data to take it from"
            raise ParameterError(self._of("V0"), None, "a number", sentence)

    def starts(self, cylinder: Cylinder) -> dict[str, tuple[float, tuple[float, float] | None]]:
        found: dict[str, tuple[float, tuple[float, float] | None]] = {}
        for name, given in (("V", self.V0), ("omega", self.omega0)):
            if given is None:
                first, most = self._first(name, cylinder.R)
                found[f"{name}0"] = first, (first - most, first + most)
            elif not isinstance(given, str):
                found[f"{name}0"] = given, None
        found["t0"] = (float(np.clip(0.0, *self.t0)), self.t0) if isinstance(self.t0, tuple) else (self.t0, None)
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
        first, late, motion = self._rolled(cylinder, values)
        found = {name: np.full(late.shape, value) for name, value in first.items()}
        for name, column in found.items() if motion else ():
            column[late] = getattr(motion, name)
        return found

    def slipping(self, cylinder: Cylinder, values: Mapping[str, float]) -> int:
        """How many of its points fall into full slip."""
        motion = self._rolled(cylinder, values)[-1]
        return int((motion.regime == 0).sum()) if motion else 0

    def _rolled(self, cylinder: Cylinder, values: Mapping[str, float]) -> tuple[dict[str, Any], NDArray[np.bool_], Any]:
        """First speeds and way; which points lie behind the release; the motion from there, None without a point."""
        V0: Any = values.get("V0", self.V0)
        omega0: Any = values.get("omega0", self.omega0)
        first = {"V": V0, "omega": V0 / cylinder.R if omega0 == ROLLING else omega0, "x": 0.0}
        t = np.asarray(self.t) - values.get("t0", self.t0)
        late = t >= 0.0
        drive: dict[str, Any] = {}
        if values.get("brake", 0.0) > 0.0:
            drive["brake"] = values["brake"]
        if values.get("drag", 0.0) != 0.0:
            drive["torque"] = Feedback(0.0, omega=-values["drag"])
        rtol = _RTOL_DRIVEN if drive else _RTOL
        return first, late, cylinder.roll(V0, first["omega"], t[late], rtol=rtol, **drive) if late.any() else None
