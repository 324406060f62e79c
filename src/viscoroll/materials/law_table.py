"""The law of one material or pair as a table: :class:`LawTable`, made once a process by :func:`law_table`."""

from __future__ import annotations

import math
import threading
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import ParameterError
from .bodies import Bodies
from .pair import Pair
from .prony import Prony
from .prony_forms import Modes
from .tables import series_of

#: functions of a table in their order: the first five are of kappa |V|, the others of 1/F(eta)
FUNCTIONS = ("lam", "epsilon", "m_half_space", "m_cylinder", "N", "share", "press")
#: powers of a polynomial; octaves from that of the slowest rate of creep down to the first row
TERMS, _SLOW_OCTAVES = 24, 5
#: times in T_ref beyond which numbers of a table leave the doubles
_LONGEST = 1e100
#: tables kept, of some 0.2 MB
_KEPT = 32

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False, repr=False)
class LawTable:
    """The law of one material or pair, whatever the load, speed, creep, radius and friction; arrays are read only.

    Attributes
    ----------
    material : what it is the law of, with times over ``T_ref``.
    given_coefficients : as :attr:`coefficients`, with NaN where N was not made yet.
    e0 : the first row holds [0, 2^e0).
    alpha : instantaneous over long-time modulus.
    T_mean : sum of J_j T_j, over ``T_ref``.
    unlike : whether the bodies differ.
    fast_limit : (3, 2), W = sum J_j/T_j and C = sum J_j/T_j (ln(2 T_j) - 0.5772...) of all, half-space and cylinder.
    relaxation_strength, relaxation_time, creep_strength, retardation_time : both forms of the series, slowest first.
    half_space_weight : what of every creep strength is the half-space's.
    T_ref : what times are counted in, s.
    pair : the bodies in SI units, where it was made of such.
    """

    material: float | Prony | Bodies
    given_coefficients: Floats
    e0: int
    alpha: float
    T_mean: float
    unlike: bool
    fast_limit: Floats
    relaxation_strength: Floats
    relaxation_time: Floats
    creep_strength: Floats
    retardation_time: Floats
    half_space_weight: Floats
    T_ref: float = 1.0
    pair: Pair | None = None

    def __repr__(self) -> str:
        return f"LawTable({self.pair or self.material!r})"

    @cached_property
    def coefficients(self) -> Floats:
        """(rows, 24 powers, 7 functions), the functions in the order of :data:`FUNCTIONS`."""
        at = FUNCTIONS.index("N")
        if not np.isnan(self.given_coefficients[0, 0, at]):
            return self.given_coefficients
        table = self.given_coefficients.copy()
        _make_unsteady(self.material, self.e0, table)
        return _read_only(table)

    @cached_property
    def record(self) -> Any:
        """What kernels take, derived from this table and from nothing else."""
        from ..kernels.rows.arrange import arrange
        from ..kernels.rows.law import Law

        rows, low = _read_only(arrange(self.given_coefficients)), 1.0 / math.sqrt(self.alpha)
        limits = map(float, self.fast_limit.ravel())
        return Law(rows, len(self.given_coefficients), self.e0, self.alpha, low, *limits)


def law_table(given: float | Prony | Bodies | LawTable) -> LawTable:
    """The table of a material, made once a process and shared by all its threads.

    Parameters
    ----------
    given : alpha >= 1, with T_epsilon for the unit of time; a series; two bodies, of which those that are alike, or
        both elastic, are one material; or a table.

    Raises
    ------
    ParameterError
        Times beyond 1e-100 to 1e100 of their unit.
    """
    if isinstance(given, LawTable):
        return given
    if isinstance(given, Bodies) and (given.like or given.alpha == 1.0):
        given = given.total if given.total.E.size else 1.0
    with _lock:
        return _made(given if isinstance(given, Prony | Bodies) else float(given))


_lock = threading.Lock()


@lru_cache(maxsize=_KEPT)
def _made(given: float | Prony | Bodies) -> LawTable:
    return made(given)


def made(given: float | Prony | Bodies, least: int = 0, coefficients: Floats | None = None) -> LawTable:
    """A table made anew, of no fewer rows than ``least``, or of ``coefficients`` that are known."""
    alpha, T_mean, modes = _numbers(given)
    unlike = isinstance(given, Bodies)
    weights = given.half_space_weights if isinstance(given, Bodies) else np.full(modes.J.size, 0.5)
    fast = modes.J * modes.b, modes.J * modes.b * (math.log(2.0) - np.log(modes.b) - np.euler_gamma)
    limits = np.array(
        [[math.fsum(share * term) for term in fast] for share in (np.ones(weights.size), weights, 1.0 - weights)]
    )
    table, e0 = _elastic(), 0
    if modes.a.size:
        from ..kernels.rows.build import Ends, build

        if not 1.0 / _LONGEST <= modes.b[0] <= modes.a[-1] <= _LONGEST:
            allowed = f"within {1.0 / _LONGEST:g} to {_LONGEST:g} of their unit"
            raise ParameterError("times", f"{1.0 / modes.a[-1]:g} to {1.0 / modes.b[0]:g}", allowed)
        e0 = math.frexp(modes.b[0])[1] - _SLOW_OCTAVES
        means = [math.fsum(share * modes.J / modes.b) for share in (weights, 1.0 - weights)]
        ends = Ends(alpha, *means, *map(float, limits[1:].ravel()))
        if coefficients is None:
            coefficients = build(_parts(modes, weights if unlike else np.empty(0)), e0, ends, least)
        table = coefficients
    table, limits, weights = map(_read_only, (table, limits, weights))
    E, tau, J, T = map(_read_only, (modes.E, 1.0 / modes.a, modes.J, 1.0 / modes.b))
    return LawTable(given, table, e0, alpha, T_mean, unlike, limits, E, tau, J, T, weights)


def _numbers(given: float | Prony | Bodies) -> tuple[float, float, Modes]:
    """(alpha, T_mean, both forms of the series)."""
    if isinstance(given, float):
        c, one = np.array([(given - 1.0) / given]), np.ones(1)
        c, one = (c, one) if given > 1.0 else (c[:0], one[:0])
        modes = Modes(given, given * one, one, given * c, c, (given * c)[:, None])
        return given, (given - 1.0) / given, modes
    total = given.total if isinstance(given, Bodies) else given
    return total.alpha, total.T_mean, total.modes


def by_modes(given: float | Prony | Bodies, z: Floats) -> Floats:
    """(5, n): g/z, h/z, the parts of m in half-space and cylinder, and N at every z > 0, by no table."""
    from ..kernels.rows.build import by_modes

    modes, found = _numbers(given)[2], np.zeros((5, z.size))
    if modes.a.size:
        weights = given.half_space_weights if isinstance(given, Bodies) else np.empty(0)
        by_modes(_parts(modes, weights), z, found)
    return found


def _parts(modes: Modes, weights: Floats) -> Any:
    """The record of a series of two bodies, of which the half-space has these parts; none where they are alike."""
    from ..kernels.material.series import Parts

    return Parts(**series_of(modes)._asdict(), weights=weights)


def _elastic() -> Floats:
    """lam = eta/F = H/F^2 = 1, and no shift or moment: closed forms."""
    table = np.zeros((1, TERMS, len(FUNCTIONS)))
    table[0, 0] = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0]
    return table


def _make_unsteady(given: float | Prony | Bodies, e0: int, table: Floats) -> None:
    from ..kernels.rows.build import build_unsteady

    build_unsteady(_parts(_numbers(given)[2], np.empty(0)), e0, table)


def _read_only(values: Floats) -> Floats:
    values = np.ascontiguousarray(values)
    values.flags.writeable = False
    return values
