"""Least squares: residuals of all records over the coordinates of the unknowns, their slopes, and the least of chi2."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Mapping
from contextlib import suppress
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..cylinder import Cylinder
from ..errors import ViscorollError
from .records import Record
from .unknowns import Shift, Unknown, cylinder_of, of_record

#: of numbers, of coordinates mostly, or of residuals
Vector = NDArray[np.float64]
#: of central differences in a coordinate: their error is 1e-8 of the largest slope (1e-7 where motions are driven)
_STEP = 3e-4
#: of those to one side, which a search takes: 1e-6
_SIDE = 1e-6
#: a residual where there is no motion: as far off as it gets
FAR = 1e6
#: weight of a combination that is held, over what the data know of any
_STIFF = 1e6
#: a standard deviation that was not given, over that of the values, to begin with
_GUESS = 1e-3
#: norm of a column of slopes that counts as none: a factor of e moves all residuals by so small a part of sigma
_NONE = 1e-2
#: places beside the start at which slopes are looked at
_PLACES = 4
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

    is_noise : both within three standard deviations of what noise does; what is far below sigma may go together.
    """

    rms: float
    lag: float
    allowed: float
    is_noise: bool


class Found(NamedTuple):
    """A minimum: coordinates and chi2."""

    u: Vector
    chi2: float


class Prior(NamedTuple):
    """What is known beforehand of a coordinate."""

    which: int
    mean: float
    sd: float


def slopes(of: Callable[[Vector], Vector], u: Vector, low: Vector, high: Vector, at_u: Vector | None = None) -> Vector:
    """Of a vector over coordinates within a box: central differences, or to one side of what it is ``at_u``."""
    step, columns = _STEP if at_u is None else _SIDE, []
    for i in range(u.size):
        up, down = u.copy(), u.copy()
        up[i] = min(u[i] + step, high[i])
        if at_u is None or up[i] < u[i] + step:
            down[i] = max(u[i] - step, low[i])
        columns.append((of(up) - (of(down) if at_u is None or down[i] < u[i] else at_u)) / (up[i] - down[i]))
    return np.array(columns).T


class Problem:
    """What is minimised.

    cylinder, unknowns, records, priors, shifts : what is known; y, sigma : all data, one after the other, by
    ``columns``; live : which unknowns are searched, the others stay at their start.
    """

    def __init__(
        self, cylinder: Cylinder, unknowns: list[Unknown], records: dict[str, Record], priors: list[Prior],
        robust: bool, shifts: Mapping[str, Shift],
    ) -> None:  # fmt: skip
        self.cylinder, self.unknowns, self.records, self.priors = cylinder, unknowns, records, priors
        self.robust, self.shifts = robust, shifts
        self.names = [one.name for one in unknowns]
        self.start, self.low, self.high = np.array([one.to_u(np.array(one[1:4])) for one in unknowns]).T
        self.live = list(range(len(unknowns)))
        self.planned = all(record.planned for record in records.values())
        self.columns: list[Column] = []
        y, sigma, size = [], [], 0
        for called, record in records.items():
            values = self.predicted(record, called, self.start) if record.planned else vars(record)
            for quantity, given in record.sigma.items():
                own = np.ravel(values[quantity])
                spread = max(_GUESS * float(np.std(own)), 1e-300) if given is None else np.ravel(given)
                y.append(own)
                sigma.append(np.broadcast_to(spread, own.shape))
                self.columns.append(Column(called, quantity, slice(size, size + own.size), given is None))
                size += own.size
        self.y, self.sigma = np.concatenate(y), np.concatenate(sigma)

    def values(self, u: Vector) -> dict[str, float]:
        """By name, at coordinates."""
        return {one.name: float(one.to_value(x)) for one, x in zip(self.unknowns, u, strict=True)}

    def coordinates(self, values: Mapping[str, float]) -> Vector:
        """The other way; what is not given is at its start."""
        return np.array([one.to_u(values.get(one.name, one.start)) for one in self.unknowns], float)

    def predicted(self, record: Record, called: str, u: Vector) -> dict[str, Vector]:
        """What would be seen of a record."""
        values = self.values(u)
        return record.model(self.cylinder_of(record, values), of_record(values, called))

    def cylinder_of(self, record: Record, values: Mapping[str, float]) -> Cylinder:
        """The cylinder of these values as a record had it."""
        return cylinder_of(self.cylinder, values, record, self.shifts)

    def residuals(self, u: Vector) -> Vector:
        """Of data and prior, over their sigma; of values that make no cylinder or no motion as far off as it gets."""
        r = np.full(self.y.size, FAR)
        # warnings: of what the search passes through
        with np.errstate(all="ignore"), warnings.catch_warnings(), suppress(ViscorollError, ArithmeticError):
            warnings.simplefilter("ignore")
            seen = {called: self.predicted(record, called, u) for called, record in self.records.items()}
            model = np.concatenate([np.ravel(seen[one.record][one.quantity]) for one in self.columns])
            r = np.clip(np.nan_to_num((model - self.y) / self.sigma, nan=FAR), -FAR, FAR)
        return np.append(r, [(u[i] - mean) / sd for i, mean, sd in self.priors])

    def jacobian(self, u: Vector) -> Vector:
        """Slopes of the residuals over the coordinates."""
        return slopes(self.residuals, u, self.low, self.high)

    def cost(self, r: Vector) -> float:
        """chi2 of residuals: their squares, or what outliers count less in."""
        return float(self._rho(r * r)[0].sum())

    def weighed(self, u: Vector) -> tuple[Vector, Vector]:
        """Residuals and slopes by the weight that each has in chi2."""
        r = self.residuals(u)
        weight = np.sqrt(self._rho(r * r)[1])
        return r * weight, self.jacobian(u) * weight[:, np.newaxis]

    def _rho(self, z: Vector) -> Vector:
        """Of squares z what chi2 adds up, and its derivatives: z, or of robust data 2 (sqrt(1 + z) - 1)."""
        rho = np.array([z, np.ones_like(z), np.zeros_like(z)])
        if self.robust:
            root = np.sqrt(1.0 + z[: self.y.size])
            rho[:, : self.y.size] = 2.0 * (root - 1.0), 1.0 / root, -0.5 / root**3
        return rho

    def least(self, u: Vector, held: Vector | None = None, tolerance: float = 1e-10, steps: int = 200) -> Found:
        """The least chi2 near ``u``, perhaps with a combination of coordinates, of powers ``held``, as it is there."""
        from scipy.optimize import least_squares

        single = held is not None and np.count_nonzero(held) == 1
        free = [i for i in self.live if not (single and held is not None and held[i])]
        rule = np.empty(0) if held is None or single else _STIFF * held
        whole = np.clip(u, self.low, self.high)
        seen: dict[bytes, Vector] = {}

        def at(v: Vector) -> Vector:
            inside = whole.copy()
            inside[free] = v
            return inside

        def residuals(v: Vector) -> Vector:
            r = np.append(self.residuals(at(v)), rule @ (at(v) - u) if rule.size else [])
            return seen.setdefault(v.tobytes(), r)

        def jacobian(v: Vector) -> Vector:
            return slopes(residuals, v, self.low[free], self.high[free], seen[v.tobytes()])

        if free:
            narrow = 1e-9 * (self.high - self.low)
            first = np.clip(whole, self.low + narrow, self.high - narrow)[free]
            found = least_squares(
                residuals, first, jacobian, (self.low[free], self.high[free]), x_scale="jac", ftol=tolerance,
                xtol=tolerance, gtol=tolerance, loss=self._rho if self.robust else "linear", max_nfev=steps,
            )  # fmt: skip
            whole = at(found.x)
        return Found(whole, self.cost(self.residuals(whole)))

    def noise(self, u: Vector) -> dict[str, Noise]:
        """Of each column, by record and quantity; lag by the order of its places."""
        found, r = {}, self.residuals(u)
        for one in self.columns:
            record = self.records[one.record]
            part = r[one.at][np.lexsort([np.ravel(getattr(record, name)) for name in reversed(record.PLACES)])]
            rms, allowed = math.sqrt(np.mean(part**2)), 3.0 / math.sqrt(part.size)
            lag = float(part[1:] @ part[:-1]) / max(float(part @ part), 1e-300)
            large = not one.estimated and rms > 1.0 + allowed / math.sqrt(2.0)
            found[str(one)] = Noise(rms, lag, allowed, lag * rms**2 <= allowed and not large)
        return found

    def flat(self) -> list[int]:
        """Unknowns that act nowhere: at the start one may have ceased to, so that other places are asked too."""
        rng, middle = np.random.default_rng(0), 0.5 * (self.low + self.high)
        others = middle + 0.25 * (self.high - self.low) * rng.uniform(-1.0, 1.0, (_PLACES, middle.size))
        sizes = [np.linalg.norm(self.jacobian(u), axis=0) for u in (self.start, *others)]
        return np.flatnonzero(np.max(sizes, axis=0) < _NONE).tolist()

    def at_end(self, u: Vector) -> list[int]:
        """Unknowns that lie at an end of their range."""
        return np.flatnonzero(np.minimum(u - self.low, self.high - u) <= _AT_END * (self.high - self.low)).tolist()

    def pushes(self, u: Vector, powers: Vector) -> dict[str, float]:
        """What chi2 would gain, by slopes, if an unknown at an end of its range went beyond, the combination held."""
        at = [i for i in self.at_end(u) if not powers[i]]
        if not at:
            return {}
        r, J = self.weighed(u)
        rest = [i for i in self.live if i not in at and i != np.flatnonzero(powers)[0]]
        own = J[:, at] - J[:, rest] @ np.linalg.lstsq(J[:, rest], J[:, at], rcond=None)[0]
        gains = (r @ own) ** 2 / np.maximum((own**2).sum(axis=0), 1e-300)
        return {self.names[i]: float(gain) for i, gain in zip(at, gains, strict=True)}
