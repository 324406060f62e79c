"""What is known of the bodies of a cylinder: density, thickness, the frequencies they were measured at."""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ..core.checks import check_number
from ..core.errors import ModelWarning, caller_level
from ..core.scale import SI
from ..kernels.compile.notice import is_worker
from ..materials.law.table import law_table
from ..materials.material import Material
from ..materials.measured import Measured
from ..materials.pair import Pair
from .assumptions import (
    LEAST_KAPPA,
    MISFIT_LIMIT,
    NOT_SMALL,
    Assumption,
    Validity,
    coupling,
    held_speeds,
    inertia,
    measurement,
    passage,
)  # fmt: skip
from .contact_table import pure_rolling_fields
from .parameters import Parameters

#: of the compliance, a part below which a body may be as thin and as little known as it likes
_LEAST_PART = 0.01
#: speeds of what no speed makes right
NOWHERE = math.inf, 0.0
#: log2 of kappa V at which the speeds of a cover are evaluated: interpolation between them has an error below 1 %
_OCTAVES_OF_SPEED = np.arange(-80.0, 80.0, 0.25)
#: data of materials of which a warning was given in this process
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
            (lam,) = pure_rolling_fields(law_table(self.scene.cover), u, "lam")
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
            return NOWHERE
        return self.held[0] * float(np.max(self.l0)), self.held[1] * float(np.min(self.l0))

    @cached_property
    def wave_speed(self) -> float | None:
        """That of the slowest shear wave in any of the cylinders, m/s; None where no density is known."""
        per_speed = self._slowness(np.ones(()), None)[0]
        return None if per_speed is None else 1.0 / float(np.max(per_speed))

    def judge(self, found: Validity, lam: Any, V: Any, omega: Any, density: float | None, plane: str) -> Validity:
        """What is added to the validity of a state, of which ``lam`` is."""
        if density is not None:
            density = check_number("density", density, unit=SI, low=0.0, strict=True)
        fastest = np.abs(V) if omega is None else np.maximum(np.abs(V), np.abs(omega) * self.R)
        pair, length = self.pair, lam * self.l0
        long = "a long cylinder, or one held between walls (plane strain)"
        return found._replace(
            quasistatic=inertia(*self._slowness(fastest, density)),
            bodies=coupling(*(pair.dundurs if pair else (0.0, 0.0)), like=pair is None or pair.like),
            measured=measurement(passage(V, length), self.measured),
            plane=Assumption(None, None, long if plane == "strain" else "a thin disc (plane stress)"),
        )

    @cached_property
    def small(self) -> bool:
        """Whether the contact at rest is no longer than the radius, of every one of the cylinders."""
        return float(np.min(self.scene.kappa, initial=math.inf)) >= LEAST_KAPPA

    @cached_property
    def silent(self) -> tuple[float, float] | None:
        """|V| between which :meth:`look` has nothing to say, m/s; None where it has nothing at any speed."""
        bands = [band for band in (self.speeds, None if self.small else NOWHERE) if band is not None]
        return (max(low for low, _ in bands), min(high for _, high in bands)) if bands else None

    def look(self, V: Any, extent: tuple[float, float] | None, *, motion: bool = False) -> None:
        """Warn where contacts at V are outside of what the model or the data hold; where :attr:`silent` is not None.

        Only extremes are looked at, and rest is passed over: M is 0 there.

        Parameters
        ----------
        V : speeds, m/s.
        extent : the least and the largest of them, where they are known.
        motion : whether they are of a motion, whose start was judged by ``motion/warned.py`` already.
        """
        assert self.silent is not None
        ends = extent or extent_of(V)
        if not beyond(ends, self.silent) or is_worker():
            return
        if not (self.small or motion):
            say([NOT_SMALL], "contact", "validity(V).small_contact")
        if self.speeds is not None and beyond(ends, self.speeds) and not _told.issuperset(self.measured.values()):
            self._look_at_data(V)

    def _look_at_data(self, V: Any) -> None:
        """Warn of speeds at which a contact asks for what was not measured, once for each material."""
        assert self.held is not None
        # the extremes of V and of l0 may be of different cylinders
        l0 = np.reshape(self.l0, np.shape(self.l0) + (1,) * (np.ndim(V) - np.ndim(self.l0)))
        rates = extent_of(np.abs(V) / l0)
        if self.speeds != NOWHERE and not beyond(rates, self.held):
            return
        _told.update(self.measured.values())
        sentence = measurement(passage(np.array(rates), self._lam(np.array(rates))), self.measured).sentence
        text = f"M and the contact length are not backed by measurements here: {sentence}"
        warnings.warn(
            f"{text}; validity(V).measured tells at which V they are", ModelWarning, stacklevel=caller_level()
        )

    def _lam(self, rate: Any) -> Any:
        """Contact length over that at rest, of |V|/l0 in 1/s, for the one material."""
        material, unit = self.scene.in_own_time()
        (lam,) = pure_rolling_fields(law_table(material), np.atleast_1d(rate) * unit * self.T_ref, "lam")
        return lam

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


def say(faults: list[str], of: str, where: str) -> None:
    """Warn of faults of the model, in workers never.

    Without numbers: Python says the same words once for each line of a program.

    Parameters
    ----------
    faults : sentences; none: no warning.
    of : what the model is not good for, "motion" or "contact".
    where : what tells more.
    """
    if faults and not is_worker():
        text = f"the model is not good for this {of}: {'; '.join(faults)}.  See {where}"
        warnings.warn(text, ModelWarning, stacklevel=caller_level())


def warn_of_share(share: float, records: Iterable[Measured]) -> bool:
    """Warn of the share of motions that start where a material was not measured; returns whether it did.

    Parameters
    ----------
    share : of the motions, 0 to 1; none: no warning.
    records : what was measured of the bodies; contacts do not warn of them any more.
    """
    known = list(records)
    if share <= 0.0 or is_worker() or _told.issuperset(known):
        return False
    _told.update(known)
    said = "; ".join(map(str, known))
    text = f"for {share:.1%} of the motions the material is not known as measured at the start (measured from {said}, "
    warnings.warn(
        f"{text}at the medians of the inputs): M is a guess of the fit there", ModelWarning, stacklevel=caller_level()
    )
    return True


def slowest_of(extent: tuple[float, float]) -> float:
    """The least |V| of speeds between these."""
    return max(extent[0], -extent[1], 0.0)


def beyond(extent: tuple[float, float], ends: tuple[float, float]) -> bool:
    """Whether speeds leave what is held; rest is passed over: M is 0 there."""
    slowest, fastest = slowest_of(extent), max(extent[1], -extent[0])
    return fastest > ends[1] or 0.0 < slowest < ends[0]


def extent_of(values: Any) -> tuple[float, float]:
    """Least and largest but for NaN; (0, 0) of nothing."""
    ends = (end.reduce(values, axis=None, initial=np.nan) for end in (np.fmin, np.fmax))
    return tuple(0.0 if np.isnan(end) else float(end) for end in ends)  # type: ignore[return-value]
