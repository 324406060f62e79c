"""The law of one material or pair as a table: :class:`LawTable`, made once a process by :func:`law_table`."""

from __future__ import annotations

import math
import threading
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import Any

import numpy as np

from ..core.errors import ParameterError
from .bodies import Bodies, one_series
from .cover import Cover
from .cover_rows import CoverRows
from .law_build import FUNCTIONS, TERMS, Floats, Rows, added, arranged, build, octaves, paired, with_unsteady
from .law_modes import by_modes, refuse_far
from .pair import Pair
from .prony import Prony, read_only

#: tables kept, of some 0.2 MB
_KEPT = 32


@dataclass(frozen=True, eq=False, repr=False)
class LawTable:
    """The law of one material or pair, whatever the load, speed, creep, radius and friction; arrays are read only.

    Attributes
    ----------
    material : what it is the law of, with times over ``T_ref``.
    given_coefficients : as :attr:`coefficients`, with NaN where N was not made yet.
    e0 : the first row holds [0, 2^e0).
    alpha : instantaneous over long-time modulus.
    T_mean : M/V as V -> 0, which is the sum of J_j T_j but for a cover against a body that deforms; over ``T_ref``.
    unlike : whether the bodies differ.
    fast_limit : (3, 2), W = sum J_j/T_j and C = sum J_j/T_j (ln(2 T_j) - 0.5772...) of all, half-space and cylinder.
    relaxation_strength, relaxation_time, creep_strength, retardation_time : both forms of the series, slowest first.
    half_space_weight : what of every creep strength is the half-space's.
    T_ref : what times are counted in, s.
    pair : the bodies in SI units, where it was made of such.
    cover : the rows that a cover of finite thickness has beside these, and None of half-spaces.
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
    cover: CoverRows | None = None

    def __repr__(self) -> str:
        return f"LawTable({self.pair or self.material!r})"

    @cached_property
    def coefficients(self) -> Floats:
        """(rows, 24 powers, 7 functions), the functions in the order of :data:`.law_build.FUNCTIONS`.

        Of a cover N is not known: its column is NaN.
        """
        table = self.given_coefficients
        if self.cover is not None or not np.isnan(table[0, 0, FUNCTIONS.index("N")]):
            return table
        return read_only(with_unsteady(table, self.e0, lambda z: by_modes(self.material, z).N))

    @cached_property
    def record(self) -> Any:
        """What kernels take, derived from this table and from nothing else."""
        from ..kernels.rows.record import E0, PARTS_PER_ROW, ROW_COUNT, ROW_SIZE, Law

        count, front = (
            len(self.given_coefficients),
            np.append([self.alpha, 1.0 / math.sqrt(self.alpha)], self.fast_limit),
        )
        lengths = free = None
        if self.cover is not None:
            front, free, lengths = cover_front(self.cover), read_only(cover_numbers(self.cover)), self.cover.creep[0]
        rows, marks = np.zeros((count + 1) * ROW_SIZE), np.zeros((count + 1) * PARTS_PER_ROW, np.int64)
        rows[:8] = front
        rows[ROW_SIZE:] = arranged(self.given_coefficients, self.e0, front[0], front[2:4], lengths).ravel()
        marks[[ROW_COUNT, E0]] = count, self.e0
        return Law(read_only(rows), read_only(marks), read_only(np.empty(0)), 0, 0, 0, free)

    @cached_property
    def unsteady_record(self) -> Any:
        """As :attr:`record`, with N."""
        N = self.coefficients[:, :, FUNCTIONS.index("N")]
        return self.record._replace(N_rows=read_only(added(N, self.e0, self.alpha)))


def law_table(given: float | Prony | Bodies | LawTable, coefficients: Floats | None = None) -> LawTable:
    """The table of a material, made once a process and shared by all its threads.

    Parameters
    ----------
    given : alpha >= 1, with T_epsilon for the unit of time; a series; two bodies, of which those that are alike, or
        both elastic, are one material; or a table.
    coefficients : that are known of it, as of a file.

    Raises
    ------
    ParameterError
        Many materials; times beyond 1e-100 to 1e100 of their unit.
    """
    if isinstance(given, LawTable):
        return given
    if isinstance(given, Prony | Bodies) and given.shape:
        raise ParameterError("material", repr(given), "one material, as material[i]")
    if isinstance(given, Bodies) and not isinstance(given, Cover) and (given.like or given.alpha == 1.0):
        given = given.total if given.total.E.size else 1.0
    given = given if isinstance(given, Prony | Bodies) else float(given)
    if coefficients is not None:
        return made(given, coefficients)
    with _lock:
        return _made(given)


_lock = threading.Lock()


@lru_cache(maxsize=_KEPT)
def _made(given: float | Prony | Bodies) -> LawTable:
    return made(given)


def made(given: float | Prony | Bodies, coefficients: Floats | None = None, cover: CoverRows | None = None) -> LawTable:
    """A table made anew, or of ``coefficients`` or rows of a cover that are known."""
    total, unlike = one_series(given), isinstance(given, Bodies)
    modes, alpha = total.modes, total.alpha
    weights = given.half_space_weights if isinstance(given, Bodies) else np.full(modes.J.size, 0.5)
    W, shares = modes.J * modes.b, (1.0, weights, 1.0 - weights)
    terms = W, W * (math.log(2.0) - np.log(modes.b) - np.euler_gamma), modes.J / modes.b
    sums = np.array([[math.fsum(share * row) for row in terms] for share in shares])
    table, e0 = _elastic(), 0
    if isinstance(given, Cover):
        cover = cover or given.rows()
        table, e0 = cover.coefficients, cover.e0
    elif modes.a.size:
        refuse_far(modes.b[0], modes.a[-1])
        e0, count = map(int, octaves(modes.b[0], modes.a[-1]))
        if coefficients is None:
            coefficients = build(lambda z: by_modes(given, z), Rows(e0, count), alpha, sums[1:, 2])
        table = coefficients
    arrays = map(read_only, (sums[:, :2], modes.E, 1.0 / modes.a, modes.J, 1.0 / modes.b, weights))
    found = LawTable(given, read_only(table), e0, alpha, total.T_mean, unlike, *arrays)
    if cover is None:
        return found
    return replace(found, cover=cover, T_mean=float(cover.coefficients[0, 0, 2:4].sum()))


def cover_front(cover: CoverRows) -> Floats:
    """The numbers in front of a cover's rows (:mod:`..kernels.rows.record`), by which the fast limit of the half-space
    says that of the cover: L = L_1 (1 + a/u) and M = b V/u^2, without logarithms."""
    L, _, _, L_slope, _, _, _, moment = cover.limits
    on_base = bool(cover.coefficients[0, 0, FUNCTIONS.index("m_half_space")])
    parts = (moment, 0.0) if on_base else (0.0, moment)
    return np.array([1.0 / (L * L), L, 0.0, 4.0 * L_slope, 0.0, 8.0 * parts[0], 0.0, 8.0 * parts[1]])


def cover_numbers(cover: CoverRows) -> Floats:
    """What kernels read of a cover beside its rows (:mod:`..kernels.rows.cover`)."""
    from ..kernels.rows.cover import COVER_FRONT_SIZE

    L, lam, free, L_slope, lam_slope, free_slope, epsilon, moment = cover.limits
    share_slope = 2.0 * (lam_slope * L - lam * L_slope) / L**3
    front = [lam, lam_slope, free, free_slope, epsilon, 2.0 * moment / L, lam / L, share_slope]
    assert len(front) == COVER_FRONT_SIZE
    own = cover.creep[1]
    return np.append(front, np.concatenate([own, paired(own, own)], axis=1))


def _elastic() -> Floats:
    """lam = eta/F = H/F^2 = 1, and no shift or moment: closed forms."""
    table = np.zeros((1, TERMS, len(FUNCTIONS)))
    table[0, 0] = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0]
    return table
