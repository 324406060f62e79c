"""Least squares: residuals of all records over the coordinates of the unknowns, their slopes, and the least of chi2."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from ...core.array_types import Floats
from ...core.errors import ViscorollError
from ...cylinder import Cylinder
from .records import Record
from .unknowns import Shift, Unknown, cylinder_of

#: of central differences in a coordinate: their error is 1e-8 of the largest slope (1e-7 where motions are driven)
_STEP = 3e-4
#: of those to one side, which a search takes: 1e-5; at less the last digits of a motion show, and it stops early
_SIDE = 1e-5
#: a residual where there is no motion: as far off as it gets
FAR = 1e6
#: weight of a combination that is held, over what the data know of any
_STIFF = 1e6
#: a standard deviation that was not given, over that of the values, to begin with; rounds in which it settles, to what
#: share
_GUESS, _ROUNDS, _SETTLED = 1e-3, 20, 1e-3
#: median of |x| of the normal law of standard deviation 1
_MEDIAN = 0.6745
#: outliers are up to a tenth of the points: the median of |x| of all is then that of the noise at 0.5/0.9, which is so
#: many times its own
_BY_OUTLIERS = 1.134
#: three standard deviations of the median of |x|, over that median, times sqrt(points)
_BY_CHANCE = 3.5
#: norm of a column of slopes that counts as none: a factor of e moves all residuals by so small a part of sigma
_NONE = 1e-2
#: of a range, how near to an end counts as at it
_AT_END = 1e-6


class Column(NamedTuple):
    """Where the residuals of one quantity of a record lie; ``estimated``: its sigma is."""

    record: str
    quantity: str
    at: slice
    estimated: bool

    def __str__(self) -> str:
        return f"{self.quantity} of {self.record}"


class Noise(NamedTuple):
    """Residuals of a column: rms over sigma, lag-1 correlation in the order of its places, what noise allows of it.

    Of a robust fit ``rms`` is the median of the absolute residuals over that of normal noise, and ``lag`` is the
    correlation of the weighted residuals, which are below 1: few outliers change neither much.

    is_noise : both within three standard deviations of what noise does; what is far below sigma may go together.
    """

    rms: float
    lag: float
    allowed: float
    is_noise: bool


class Found(NamedTuple):
    """A minimum: coordinates and chi2."""

    u: Floats
    chi2: float


class Problem:
    """What is minimised.

    cylinder, unknowns, records, shifts : what is known; y, sigma : all data, one after the other, by ``columns``, those
    of a plan as they are at the start; points : how many, and priors; live : which unknowns are searched, the others
    act nowhere and stay at their start.
    """

    def __init__(
        self, cylinder: Cylinder, unknowns: list[Unknown], records: dict[str, Record], robust: bool,
        shifts: Mapping[str, Shift],
    ) -> None:  # fmt: skip
        self.cylinder, self.unknowns, self.records, self.shifts = cylinder, unknowns, records, shifts
        self.robust, self.names = robust, [one.name for one in unknowns]
        self.start, self.low, self.high = np.array([one.to_u(np.array(one[1:4])) for one in unknowns]).T
        self._mean, self._sd = np.array([(one.mean, one.sd) for one in unknowns]).T
        self._known, self._model = np.isfinite(self._sd), lru_cache(16)(self._modelled)
        self.columns: list[Column] = []
        y, sigma, size = [], [], 0
        for called, record in records.items():
            values = vars(record) if record.measured else self.predicted(record, self.start, called)
            for quantity, given in record.sigma.items():
                own = np.ravel(values[quantity])
                spread = max(_GUESS * float(np.std(own)), 1e-300) if given is None else np.ravel(given)
                y.append(own)
                sigma.append(np.broadcast_to(spread, own.shape))
                self.columns.append(Column(called, quantity, slice(size, size + own.size), given is None))
                size += own.size
        self.y, self.sigma, self.points = np.concatenate(y), np.concatenate(sigma), size + int(self._known.sum())
        self.live = self._acting()

    def _acting(self) -> list[int]:
        """Unknowns that act anywhere: at the start one may have ceased to, so that other places are asked too."""
        rng, middle = np.random.default_rng(0), 0.5 * (self.low + self.high)
        others = middle + 0.25 * (self.high - self.low) * rng.uniform(-1.0, 1.0, (4, middle.size))
        idle = [*range(middle.size)]
        for u in (self.start, *others):
            J = self.slopes(self.residuals, u, idle)
            idle = [i for i, column in zip(idle, J.T, strict=True) if np.linalg.norm(column) < _NONE]
        return [i for i in range(middle.size) if i not in idle]

    def values(self, u: Floats) -> dict[str, float]:
        """By name, at coordinates."""
        return {one.name: float(one.to_value(x)) for one, x in zip(self.unknowns, u, strict=True)}

    def predicted(self, record: Record, u: Floats, called: str = "") -> dict[str, Floats]:
        """What would be seen of a record."""
        values = self.values(u)
        own = {name.removesuffix(f":{called}"): value for name, value in values.items()}
        return record.model(cylinder_of(self.cylinder, values, record, self.shifts), own)

    def _modelled(self, u: bytes) -> Floats:
        """All data as predicted; of values that make no cylinder or no motion NaN."""
        # warnings: of what the search passes through
        with np.errstate(all="ignore"), warnings.catch_warnings(), suppress(ViscorollError, ArithmeticError):
            warnings.simplefilter("ignore")
            seen = {called: self.predicted(one, np.frombuffer(u), called) for called, one in self.records.items()}
            return np.concatenate([np.ravel(seen[one.record][one.quantity]) for one in self.columns])
        return np.full(self.y.size, np.nan)

    def residuals(self, u: Floats) -> Floats:
        """Of data and what is known beforehand, over their sigma; where there is no motion as far off as it gets."""
        r = np.clip(np.nan_to_num((self._model(u.tobytes()) - self.y) / self.sigma, nan=FAR), -FAR, FAR)
        return np.append(r, ((u - self._mean) / self._sd)[self._known])

    def slopes(self, of: Callable[[Floats], Floats], u: Floats, which: Sequence[int], step: float = _STEP) -> Floats:
        """Of a vector over some coordinates within their ranges: central differences, or of ``_SIDE`` to one side."""
        columns = []
        for i in which:
            up, down = u.copy(), u.copy()
            up[i] = min(u[i] + step, self.high[i])
            if step == _STEP or up[i] < u[i] + step:
                down[i] = max(u[i] - step, self.low[i])
            columns.append((of(up) - of(down)) / (up[i] - down[i]))
        return np.array(columns).T

    def jacobian(self, u: Floats) -> Floats:
        """Slopes of the residuals over the coordinates."""
        return self.slopes(self.residuals, u, range(u.size))

    def cost(self, u: Floats) -> float:
        """chi2: squares of the residuals, or what outliers count less in."""
        z = self.residuals(u) ** 2
        return float((2.0 * (np.sqrt(1.0 + z) - 1.0) if self.robust else z).sum())

    def weighed(self, u: Floats) -> tuple[Floats, Floats]:
        """Residuals and slopes by the weight that each has in chi2."""
        r, J = self.residuals(u), self.jacobian(u)
        weight = (1.0 + r * r) ** -0.25 if self.robust else np.ones_like(r)
        return r * weight, J * weight[:, np.newaxis]

    def least(self, u: Floats, held: Floats | None = None, tolerance: float = 1e-10, steps: int = 200) -> Found:
        """The least chi2 near ``u``, perhaps with a combination of coordinates, of powers ``held``, as it is there."""
        from scipy.optimize import least_squares

        powers = np.zeros_like(u) if held is None else held
        fixed = np.count_nonzero(powers) == 1
        free = [i for i in self.live if not (fixed and powers[i])]
        rule = _STIFF * powers[np.newaxis, free] if powers[free].any() else np.empty((0, len(free)))
        whole = np.clip(u, self.low, self.high)

        def at(v: Floats) -> Floats:
            inside = whole.copy()
            inside[free] = v
            return inside

        def residuals(v: Floats) -> Floats:
            return np.append(self.residuals(at(v)), rule @ (v - u[free]))

        def jacobian(v: Floats) -> Floats:
            return np.vstack([self.slopes(self.residuals, at(v), free, _SIDE), rule])

        if free:
            found = least_squares(
                residuals, whole[free], jacobian, (self.low[free], self.high[free]), x_scale="jac", ftol=tolerance,
                xtol=tolerance, gtol=tolerance, loss="soft_l1" if self.robust else "linear", max_nfev=steps,
            )  # fmt: skip
            whole = at(found.x)
        return Found(whole, self.cost(whole))

    def settled(self, best: Found) -> Found:
        """Each sigma that was not given estimated from its residuals, and fitted again, until both stay."""
        estimated = [one for one in self.columns if one.estimated]
        for _ in range(_ROUNDS if estimated else 0):
            r, before = self.residuals(best.u), self.sigma.copy()
            share = 1.0 - min(len(self.live) / r.size, 0.9)
            for one in estimated:
                own = r[one.at]
                size = np.median(np.abs(own)) / _MEDIAN if self.robust else np.sqrt(np.mean(own**2) / share)
                self.sigma[one.at] *= max(float(size), 1e-12)
            best = self.least(best.u)
            if np.abs(self.sigma / before - 1.0).max() < _SETTLED:
                break
        return best

    def noise(self, u: Floats) -> dict[str, Noise]:
        """Of each column, by record and quantity; lag by the order of its places."""
        found, r = {}, self.residuals(u)
        for one in self.columns:
            record = self.records[one.record]
            part = r[one.at][np.lexsort([np.ravel(getattr(record, name)) for name in reversed(record.PLACES)])]
            allowed = 3.0 / math.sqrt(part.size)
            if self.robust:
                rms, most = float(np.median(np.abs(part))) / _MEDIAN, _BY_OUTLIERS + _BY_CHANCE / math.sqrt(part.size)
                part = part / np.sqrt(1.0 + part**2)
            else:
                rms, most = math.sqrt(np.mean(part**2)), 1.0 + allowed / math.sqrt(2.0)
            lag = float(part[1:] @ part[:-1]) / max(float(part @ part), 1e-300)
            large = not one.estimated and rms > most
            found[str(one)] = Noise(rms, lag, allowed, lag * rms**2 <= allowed and not large)
        return found

    def at_end(self, u: Floats) -> list[int]:
        """Unknowns that lie at an end of their range."""
        width = self.high - self.low
        return np.flatnonzero(np.minimum(u - self.low, self.high - u) <= _AT_END * width).tolist()
