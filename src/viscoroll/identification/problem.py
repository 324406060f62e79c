"""Least squares: residuals of all records over the coordinates of the unknowns, their slopes, and the least of chi2."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..cylinder import Cylinder
from ..errors import ViscorollError
from .records import Record
from .unknowns import Shift, Unknown, coordinates, cylinder_of, named

#: of central differences in a coordinate: their error is 1e-8 of the largest slope (1e-7 where motions are driven)
STEP = 3e-4
#: a residual where there is no motion: as far off as it gets
FAR = 1e6
#: how much stiffer than the data a combination is held
_STIFF = 1e3
#: a standard deviation that was not given, over that of the values, to begin with
_GUESS = 1e-3
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


class Found(NamedTuple):
    """A minimum: coordinates and chi2."""

    u: NDArray[np.float64]
    chi2: float


class Held(NamedTuple):
    """A combination of coordinates that is held at ``target``; ``sd`` says how well the data know it."""

    powers: NDArray[np.float64]
    target: float
    sd: float

    @property
    def single(self) -> int | None:
        """The one unknown that it is, None of a combination."""
        (which,) = np.nonzero(self.powers)
        return int(which[0]) if which.size == 1 else None


@dataclass(eq=False)
class Problem:
    """What is minimised.  ``evaluations`` counts residuals.  y and sigma: all data, one after the other."""

    cylinder: Cylinder
    unknowns: list[Unknown]
    records: dict[str, Record]
    prior: list[tuple[int, float, float]]
    robust: bool
    shifts: Mapping[str, Shift]
    evaluations: int = 0
    columns: list[Column] = field(init=False)
    #: which unknowns are searched; the others stay at their start
    live: list[int] = field(init=False)
    y: NDArray[np.float64] = field(init=False)
    sigma: NDArray[np.float64] = field(init=False)

    def __post_init__(self) -> None:
        self.start, self.low, self.high = (coordinates(self.unknowns, end) for end in ("start", "low", "high"))
        self.names = [one.name for one in self.unknowns]
        self.live = list(range(len(self.names)))
        self.columns, y, sigma, size = [], [], [], 0
        plan = self.model(self.start, planned=True)
        for called, record in self.records.items():
            for quantity, given in record.sigma.items():
                values = plan[called][quantity] if record.planned else getattr(record, quantity)
                y.append(np.ravel(values))
                spread = np.full(values.size, max(_GUESS * float(np.std(values)), 1e-300))
                sigma.append(spread if given is None else np.ravel(given))
                self.columns.append(Column(called, quantity, slice(size, size + values.size), given is None))
                size += values.size
        self.y, self.sigma = np.concatenate(y), np.concatenate(sigma)

    def values(self, u: NDArray[np.float64]) -> dict[str, float]:
        """By name, at coordinates."""
        return {one.name: float(one.to_value(x)) for one, x in zip(self.unknowns, u, strict=True)}

    def coordinates(self, values: Mapping[str, float]) -> NDArray[np.float64]:
        """The other way; what is not given is at its start."""
        return np.array([one.to_u(values.get(one.name, one.start)) for one in self.unknowns], float)

    def predicted(self, record: Record, called: str, values: Mapping[str, float]) -> dict[str, NDArray[np.float64]]:
        """What the cylinder of these values would show of a record."""
        return record.model(self.cylinder_of(record, values), named(values, called))

    def cylinder_of(self, record: Record, values: Mapping[str, float]) -> Cylinder:
        """The cylinder of these values as a record had it."""
        return cylinder_of(self.cylinder, values, record, self.shifts)

    def model(self, u: NDArray[np.float64], planned: bool = False) -> dict[str, dict[str, NDArray[np.float64]]]:
        """That of all records, or of those that are planned."""
        values = self.values(u)
        some = {name: one for name, one in self.records.items() if one.planned or not planned}
        return {name: self.predicted(record, name, values) for name, record in some.items()}

    def residuals(self, u: NDArray[np.float64]) -> NDArray[np.float64]:
        """Of data and prior, over their sigma."""
        self.evaluations += 1
        r = np.full(self.y.size, FAR)
        try:
            with np.errstate(all="ignore"), warnings.catch_warnings():
                warnings.simplefilter("ignore")  # of what the search passes through
                found = self.model(u)
        except (ViscorollError, ArithmeticError):
            pass  # no such cylinder
        else:
            for one in self.columns:
                r[one.at] = (np.ravel(found[one.record][one.quantity]) - self.y[one.at]) / self.sigma[one.at]
            r = np.clip(np.where(np.isfinite(r), r, FAR), -FAR, FAR)
        return np.append(r, [(u[i] - mean) / sd for i, mean, sd in self.prior])

    def jacobian(self, u: NDArray[np.float64], free: Any = None) -> NDArray[np.float64]:
        """Slopes of the residuals over the coordinates, or over those that are ``free``."""
        columns = []
        for i in range(u.size) if free is None else free:
            up, down = u.copy(), u.copy()
            up[i], down[i] = min(u[i] + STEP, self.high[i]), max(u[i] - STEP, self.low[i])
            columns.append((self.residuals(up) - self.residuals(down)) / (up[i] - down[i]))
        return np.array(columns).T

    def cost(self, r: NDArray[np.float64]) -> float:
        """chi2 of residuals: their squares, or what outliers count less in."""
        return float(self._rho(r * r)[0].sum())

    def weighed(self, r: NDArray[np.float64], J: NDArray[np.float64]) -> NDArray[np.float64]:
        """Slopes by the weight that each residual has in chi2."""
        return J * np.sqrt(self._rho(r * r)[1])[:, np.newaxis]

    def _rho(self, z: NDArray[np.float64]) -> NDArray[np.float64]:
        """Of squares z what chi2 adds up, and its derivatives: z, or of robust data 2 (sqrt(1 + z) - 1)."""
        rho = np.array([z, np.ones_like(z), np.zeros_like(z)])
        if self.robust:
            root = np.sqrt(1.0 + z[: self.y.size])
            rho[:, : self.y.size] = 2.0 * (root - 1.0), 1.0 / root, -0.5 / root**3
        return rho

    def least(
        self, u: NDArray[np.float64], held: Held | None = None, tolerance: float = 1e-10, steps: int = 200
    ) -> Found:
        """The least chi2 near ``u``, perhaps with a combination held."""
        from scipy.optimize import least_squares

        single = None if held is None else held.single
        free = [i for i in self.live if i != single]
        whole = np.clip(u, self.low, self.high)
        stiff = held if single is None else None
        weight = _STIFF / stiff.sd if stiff else 0.0

        def at(v: NDArray[np.float64]) -> NDArray[np.float64]:
            inside = whole.copy()
            inside[free] = v
            return inside

        def residuals(v: NDArray[np.float64]) -> NDArray[np.float64]:
            r = self.residuals(at(v))
            return np.append(r, weight * (stiff.powers @ at(v) - stiff.target)) if stiff else r

        def jacobian(v: NDArray[np.float64]) -> NDArray[np.float64]:
            J = self.jacobian(at(v), free)
            return np.vstack([J, weight * stiff.powers[free]]) if stiff else J

        if held is not None and single is not None:
            whole[single] = held.target / held.powers[single]
        if free:
            narrow = 1e-9 * (self.high - self.low)
            first = np.clip(whole, self.low + narrow, self.high - narrow)[free]
            found = least_squares(
                residuals, first, jacobian, (self.low[free], self.high[free]), x_scale="jac", ftol=tolerance,
                xtol=tolerance, gtol=tolerance, loss=self._rho if self.robust else "linear", max_nfev=steps,
            )  # fmt: skip
            whole = at(found.x)
        return Found(whole, self.cost(self.residuals(whole)))

    def at_end(self, u: NDArray[np.float64]) -> list[str]:
        """Unknowns that lie at an end of their range."""
        near = _AT_END * (self.high - self.low)
        return [self.names[i] for i in np.flatnonzero((u - self.low <= near) | (self.high - u <= near))]

    def pushes(self, u: NDArray[np.float64], powers: NDArray[np.float64]) -> dict[str, float]:
        """What chi2 would gain, by slopes, if an unknown at an end of its range went beyond, the combination held."""
        at = [name for name in self.at_end(u) if not powers[self.names.index(name)]]
        if not at:
            return {}
        r = self.residuals(u)
        J, (which,) = self.weighed(r, self.jacobian(u)), np.nonzero(powers)
        r = self.weighed(r, r[:, np.newaxis])[:, 0]
        rest = [i for i in self.live if self.names[i] not in at and i != which[0]]
        gains = {}
        for name in at:
            column = J[:, self.names.index(name)]
            column = column - J[:, rest] @ np.linalg.lstsq(J[:, rest], column, rcond=None)[0] if rest else column
            gains[name] = float((column @ r) ** 2 / max(float(column @ column), 1e-300))
        return gains
