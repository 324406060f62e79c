"""What was measured, in SI units: :class:`Resistance`, :class:`Traction`; motions are in :mod:`motions`.

A record without values is a plan: what would be learnt from it is told before it is made.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import KW_ONLY, dataclass, field
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ..checks import broadcast_shape, checked, number
from ..cylinder import Cylinder
from ..errors import ParameterError, one_of, unknown
from ..labels import Labels, unlabelled
from ..scale import refuse_other_unit, si_unit
from ..typed import Numbers

#: quantity -> what it is called where units are
_CALLED = {"F": "force"}


@dataclass(frozen=True, eq=False)
class Record:
    """What all records have: places, values and their standard deviations, each one a place or one for all."""

    #: names of places and of what may be measured there, the first what a plan is about
    PLACES: ClassVar[tuple[str, ...]] = ()
    KINDS: ClassVar[tuple[str, ...]] = ()
    KIND: ClassVar[str] = ""

    sigma: Any = field(default=None, kw_only=True)
    load: float | None = field(default=None, kw_only=True)
    temperature: float | None = field(default=None, kw_only=True)
    name: str = field(default="", kw_only=True)
    labels: Labels | None = field(default=None, init=False, repr=False)

    def __post_init__(self) -> None:
        if not isinstance(self.name, str) or ":" in self.name:
            raise ParameterError("name", f"{self.name!r:.60}", "a text without a colon")
        given = {name: getattr(self, name) for name in (*self.PLACES, *self.measured)}
        for name, value in given.items():
            refuse_other_unit(self._of(name), value, self.unit(name))
        plain, labels = unlabelled(given)
        arrays = {name: np.atleast_1d(checked(self._of(name), value)) for name, value in plain.items()}
        shape = broadcast_shape(**{self._of(name): array for name, array in arrays.items()})
        if broadcast_shape(**{name: arrays[name] for name in self.PLACES}) != shape:
            raise ParameterError(self._of(self.KINDS[0]), f"of shape {shape}", "a value a place")
        if 0 in shape:
            raise ParameterError(self._of(self.PLACES[0]), "empty", "at least one place")
        self._set(labels=labels, **{name: np.broadcast_to(array, shape) for name, array in arrays.items()})
        self._set(sigma=self._sigmas(shape))
        for name, low in (("load", 0.0), ("m", 0.0), ("temperature", -math.inf)):
            if (value := getattr(self, name, None)) is not None:
                self._set(**{name: number(self._of(name), value, low=low, strict=True)})

    @staticmethod
    def unit(name: str) -> str:
        """SI unit of a place or quantity; a creep has none."""
        name = _CALLED.get(name, name)
        return si_unit(name)

    def _set(self, **values: Any) -> None:
        for name, value in values.items():
            object.__setattr__(self, name, value)

    def _of(self, name: str) -> str:
        return f"{self.name or self.KIND}: {name}"

    def _sigmas(self, shape: tuple[int, ...]) -> dict[str, NDArray[np.float64] | None]:
        """Standard deviation of each quantity, None where it is to be estimated; of a plan it says what is measured."""
        among, given = self.measured or self.KINDS[:1], self.sigma
        if given is None:
            return dict.fromkeys(self.measured)
        if not isinstance(given, Mapping):
            if len(among) > 1:
                allowed = f"one a quantity, as {{{', '.join(f'{name!r}: ...' for name in among)}}}"
                raise ParameterError(self._of("sigma"), f"{given!r:.40}", allowed)
            given = {among[0]: given}
        found: dict[str, NDArray[np.float64] | None] = dict.fromkeys(self.measured)
        for name, value in given.items():
            if name not in (self.measured or self.KINDS):
                raise unknown(self._of("sigma"), name, self.measured or self.KINDS, "a quantity of it")
            sigma = checked(self._of(f"sigma of {name}"), value, low=0.0, strict=True)
            if sigma.shape not in ((), shape):
                raise ParameterError(self._of("sigma"), f"of shape {sigma.shape}", f"a number, or of shape {shape}")
            found[name] = np.broadcast_to(sigma, shape)
        return found

    @property
    def measured(self) -> tuple[str, ...]:
        """Quantities that it has values of."""
        return tuple(name for name in self.KINDS if getattr(self, name) is not None)

    @property
    def planned(self) -> bool:
        """Whether it holds no values."""
        return not self.measured

    @property
    def shape(self) -> tuple[int, ...]:
        """Of its places."""
        return np.shape(getattr(self, self.PLACES[0]))

    @property
    def own(self) -> dict[str, float]:
        """What it has in place of the cylinder's."""
        given = {name: getattr(self, name, None) for name in ("load", "m")}
        return {name: value for name, value in given.items() if value is not None}

    def starts(self, cylinder: Cylinder) -> dict[str, tuple[float, tuple[float, float] | None]]:
        """What it may have unknown: where that starts, and the range of what is unknown without being asked for."""
        return {}

    def model(self, cylinder: Cylinder, values: Mapping[str, float]) -> dict[str, NDArray[np.float64]]:
        """What the ``cylinder`` would show of all :attr:`KINDS`; ``values`` of bearing and record by their names."""
        raise NotImplementedError


@dataclass(frozen=True, eq=False)
class Resistance(Record):
    """Rolling resistance over speed: of a drum, or of a roller that is pulled.

    Parameters
    ----------
    V : speeds, m/s.
    M : moments that rolling takes, N m per m of length, with that of the bearing: what a drum's shaft bears.
    F : in its place the forces that pull, M/R, N/m.  Neither: a plan.
    sigma : their standard deviation, a number or one a point; default: estimated.
    load : of this record, N/m, in place of the cylinder's.
    temperature : of this record, degrees Celsius, see ``shift`` of :func:`viscoroll.identify`.
    name : by which the report calls it.

    Raises
    ------
    ParameterError
        Values that are not finite, with their row, or of another unit (``attrs["units"]``), both M and F, sigma <= 0.
    """

    PLACES, KINDS, KIND = ("V",), ("M", "F"), "resistance"

    V: Numbers
    M: Numbers | None = None
    _: KW_ONLY
    F: Numbers | None = None

    def __post_init__(self) -> None:
        if self.M is not None and self.F is not None:
            raise one_of("M", "F", both=True)
        super().__post_init__()

    def model(self, cylinder: Cylinder, values: Mapping[str, float]) -> dict[str, NDArray[np.float64]]:
        V = np.asarray(self.V)
        M = cylinder.contact(V, delta=0.0, fields="M").M
        M = M + np.sign(V) * values.get("brake", 0.0) + values.get("drag", 0.0) * V / cylinder.R
        return {"M": M, "F": M / cylinder.R}


@dataclass(frozen=True, eq=False)
class Traction(Record):
    """Traction over creep, at one speed or several.

    Parameters
    ----------
    V : speeds of the axis, m/s, one for all or one a point.
    delta : creep ratios (omega R - V)/V.
    Q : traction, N/m; None: a plan.
    sigma, load, temperature, name : as of :class:`Resistance`.

    Raises
    ------
    ParameterError
        As there.
    """

    PLACES, KINDS, KIND = ("V", "delta"), ("Q",), "traction"

    V: Numbers
    delta: Numbers
    Q: Numbers | None = None

    def model(self, cylinder: Cylinder, values: Mapping[str, float]) -> dict[str, NDArray[np.float64]]:
        return {"Q": cylinder.contact(self.V, delta=self.delta, fields="Q").Q}
