"""What is known of the bodies of a cylinder: density, thickness, the frequencies they were measured at."""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ..core.checks import number
from ..core.errors import ModelWarning, outside
from ..kernels.compile.notice import is_worker
from ..materials.law_table import law_table
from ..materials.material import Material
from ..materials.measured import Measured
from ..materials.pair import Pair
from .assumptions import (
    MISFIT_LIMIT,
    Assumption,
    Validity,
    coupling,
    held_speeds,
    inertia,
    measurement,
    passage,
)  # fmt: skip
from .contact_table import rolling
from .parameters import Parameters

#: of the compliance, a part below which a body may be as thin and as little known as it likes
_LEAST_PART = 0.01
#: log2 of kappa V at which the speeds of a cover are looked at: what lies between is off by less than 1 %
_OCTAVES_OF_SPEED = np.arange(-80.0, 80.0, 0.25)
#: said once a process for each
_told: set[Measured] = set()


@dataclass(frozen=True, eq=False)
class Known:
    """What is known of the bodies of a cylinder, or of many: how fast waves are in them, where they were measured.

    pair : both, or None where both are the paper's, of shear modulus ``G``.  R, l0, T_ref, scene : the cylinder's.
    """

    pair: Pair | None
    G: Any
    R: Any
    l0: Any
    T_ref: float
    scene: Parameters

    @cached_property
    def bodies(self) -> dict[str, Material]:
        """The different ones whose part of the compliance counts; none where none is known."""
        if (pair := self.pair) is None:
            return {}
        if pair.like:
            return {"the material": pair.half_space}
        bodies = {"the cylinder": (pair.cylinder, pair.share), "the base": (pair.half_space, 1.0 - pair.share)}
        return {name: body for name, (body, part) in bodies.items() if part >= _LEAST_PART}

    @cached_property
    def measured(self) -> dict[str, Measured]:
        """What they were measured by, where they tell."""
        return {name: body.measured for name, body in self.bodies.items() if body.measured is not None}

    @cached_property
    def held(self) -> tuple[float, float] | None:
        """|V|/l0 between which the contact asks for what all bodies' data hold, 1/s; None where nothing is known."""
        records, series = self.measured.values(), self.scene.series
        if not records or series is None:
            return None
        ends = max(data.low for data in records), min(data.high for data in records)
        low, high = (rate * self.T_ref for rate in ends)
        if self.scene.cover is not None:
            u = np.exp2(_OCTAVES_OF_SPEED)
            (lam,) = rolling(law_table(self.scene.cover), u, "lam")
            low, high = np.exp(np.interp(np.log([low, high]), np.log(u / lam), np.log(u))).tolist()
        else:
            low, high = held_speeds(series, low, high)
        return low / self.T_ref, high / self.T_ref

    @cached_property
    def speeds(self) -> tuple[float, float] | None:
        """|V| between which every one of the cylinders is held by data, m/s; (inf, 0) of a fit that misses them."""
        if self.held is None:
            return None
        if any(data.misfit > MISFIT_LIMIT for data in self.measured.values()):
            return math.inf, 0.0
        return self.held[0] * float(np.max(self.l0)), self.held[1] * float(np.min(self.l0))

    @cached_property
    def wave_speed(self) -> float | None:
        """That of the slowest shear wave in any of the cylinders, m/s; None where no density is known."""
        per_speed = self._slowness(np.ones(()), None)[0]
        return None if per_speed is None else 1.0 / float(np.max(per_speed))

    def judge(self, found: Validity, lam: Any, V: Any, omega: Any, density: float | None, plane: str) -> Validity:
        """What is added to the validity of a state, of which ``lam`` is."""
        if density is not None:
            density = number("density", density, low=0.0, strict=True)
        fastest = np.abs(V) if omega is None else np.maximum(np.abs(V), np.abs(omega) * self.R)
        pair, length = self.pair, lam * self.l0
        long = "a long cylinder, or one held between walls (plane strain)"
        return found._replace(
            quasistatic=inertia(*self._slowness(fastest, density)),
            bodies=coupling(*(pair.dundurs if pair else (0.0, 0.0)), like=pair is None or pair.like),
            measured=measurement(passage(V, length), self.measured),
            plane=Assumption(None, None, long if plane == "strain" else "a thin disc (plane stress)"),
        )

    def look(self, V: Any, extent: tuple[float, float] | None) -> None:
        """Warn where a contact at V asks for frequencies that the data do not hold; where :attr:`speeds` are known.

        Only extremes are looked at, and rest is passed over: M is 0 there.
        """
        assert self.speeds is not None
        assert self.held is not None
        if not beyond(extent or extent_of(V), self.speeds) or _told.issuperset(self.measured.values()) or is_worker():
            return
        # the extremes of V and of l0 may be of different cylinders
        l0 = np.reshape(self.l0, np.shape(self.l0) + (1,) * (np.ndim(V) - np.ndim(self.l0)))
        rates = extent_of(np.abs(V) / l0)
        if self.speeds != (math.inf, 0.0) and not beyond(rates, self.held):
            return
        material, unit = self.scene.in_own_time()
        (lam,) = rolling(law_table(material), np.array(rates) * unit * self.T_ref, "lam")
        _told.update(self.measured.values())
        sentence = measurement(passage(np.array(rates), lam), self.measured).sentence
        text = f"the material is not known here as measured: {sentence}.  M and the contact length are a guess of the "
        warnings.warn(text + "fit then; validity(V).measured tells where", ModelWarning, stacklevel=outside())

    def _slowness(self, speed: Any, density: float | None) -> tuple[Any, list[str]]:
        """(Speed over that of the slowest shear wave, or None; bodies whose density is not known)."""
        bodies: list[tuple[str, Any, float | None]] = [("the material", self.G, density)]
        if self.pair is not None:
            first, second = self.pair.cylinder, self.pair.half_space
            own = first.density if density is None else density
            bodies = [("the cylinder", first.G, own), ("the base", second.G, second.density)]
            if self.pair.like:
                bodies = [("the material", first.G, second.density if own is None else own)]
        # in this order V = 0 gives 0 at any density
        with np.errstate(over="ignore"):
            ratios = [speed * np.sqrt(1.0 / own) * math.sqrt(weight) for _, own, weight in bodies if weight is not None]
        unknown = [name for name, own, weight in bodies if weight is None and not np.all(np.isinf(own))]
        return (np.max(np.broadcast_arrays(*ratios), axis=0) if ratios else None), unknown


def beyond(extent: tuple[float, float], ends: tuple[float, float]) -> bool:
    """Whether speeds leave what is held; rest is passed over: M is 0 there."""
    slowest, fastest = max(extent[0], -extent[1], 0.0), max(extent[1], -extent[0])
    return fastest > ends[1] or 0.0 < slowest < ends[0]


def extent_of(values: Any) -> tuple[float, float]:
    """Least and largest but for NaN; (0, 0) of nothing."""
    ends = (end.reduce(values, axis=None, initial=np.nan) for end in (np.fmin, np.fmax))
    return tuple(0.0 if np.isnan(end) else float(end) for end in ends)  # type: ignore[return-value]
