"""The law of one material or pair as a table: :class:`LawTable`, made once a process by :func:`law_table`.

Its functions, in the order of the coefficients (:data:`.pack.FUNCTIONS`), are lam, epsilon, M/V of half-space and of
cylinder, N, eta/F and H/F^2.
"""

from __future__ import annotations

import math
import threading
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import Any

import numpy as np

from ...core.array_types import Floats
from ...core.errors import ParameterError
from ..bodies import Bodies, total_series
from ..cover import Cover
from ..pair import Pair
from ..prony import Prony, lock_array
from .coupled_rows import CoupledRows
from .cover_rows import cover_rows
from .evaluate import refuse_distant_times
from .fit import fit_rows, fit_unsteady
from .pack import FUNCTIONS, CoverRows, constant_rows, pack_record, pack_unsteady, steady_table
from .rows import Rows, row_range

#: number of tables that a process keeps; each takes about 0.2 MB
_KEPT_TABLES = 32


@dataclass(frozen=True, eq=False, repr=False)
class LawTable:
    """The law of one material or pair for any load, speed, creep, radius and friction; arrays are read only.

    The variables are u = kappa |V| and v = 1/F(eta) (:mod:`.pack`).  All numbers are dimensionless, with times in units
    of ``T_ref``.

    Attributes
    ----------
    material : material whose law this is: alpha as a float, with T_epsilon for the unit of time; a
        :class:`..prony.Prony` series; or :class:`..bodies.Bodies`, of which :class:`..cover.Cover` is one.  Like bodies
        and elastic ones are stored as one series or as 1.0.
    steady_coefficients : as :attr:`coefficients`, with NaN where N was not computed yet.
    e0 : exponent of the end of the first row, which is the interval [0, 2^e0); 0 for elastic bodies, which have one
        row.
    alpha : instantaneous divided by long-time stiffness, dimensionless.
    T_mean : limit of M/V for V -> 0, in units of P ``T_ref``: the sum of J_j T_j, except for a cover against a body
        that deforms.
    unlike : whether the bodies differ; True for a cover.
    fast_limit : W = sum J_j/T_j and C = sum J_j/T_j (ln(2 T_j) - 0.5772...) of both bodies together, of the half-space
        and of the cylinder, shape (3, 2); of a cover those of the bodies as half-spaces, which its law does not use.
    relaxation_strength, relaxation_time, creep_strength, retardation_time : both forms of the series of both bodies
        together, (modes,), slowest mode first, times in units of ``T_ref``.
    half_space_weight : part of each creep strength that is the half-space's, dimensionless, (modes,); 0.5 of like
        bodies.
    T_ref : unit of time, s; 1 where the material was given without units.
    pair : the bodies in SI units, if the table was made of such; else None.
    cover : rows that a cover of finite thickness has in addition, :class:`.pack.CoverRows`; None for half-spaces.
    coupled : the solution in which shear acts on pressure, at one mu, :class:`.coupled_rows.CoupledRows`, which is then
        the law; None without.  All but ``material``, ``unlike``, ``pair`` and ``T_ref`` are those of half-spaces then.
    """

    material: float | Prony | Bodies
    steady_coefficients: Floats
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
    coupled: CoupledRows | None = None

    def __repr__(self) -> str:
        return f"LawTable({self.pair or self.material!r})"

    @cached_property
    def coefficients(self) -> Floats:
        """Return the coefficients (rows, 24 powers, 7 functions), functions in the order of :data:`.pack.FUNCTIONS`.

        Those of N, in units of P T_ref^2, are computed at the first use.  For a cover N is not known: its column is
        NaN.
        """
        table = self.steady_coefficients
        if self.cover is not None or not np.isnan(table[0, 0, FUNCTIONS.index("N")]):
            return table
        return lock_array(fit_unsteady(self.material, table, self.e0))

    @cached_property
    def record(self) -> Any:
        """Record of the law that kernels read (:class:`...kernels.rows.record.Law`)."""
        made = pack_record(self.steady_coefficients, self.e0, self.alpha, self.fast_limit, self.cover)
        return made if self.coupled is None else made._replace(table=self.coupled.vector)

    @cached_property
    def unsteady_record(self) -> Any:
        """As :attr:`record`, with the rows of N (:func:`.pack.pack_unsteady`), which are NaN for a cover."""
        return self.record._replace(N_rows=lock_array(pack_unsteady(self.coefficients, self.e0, self.alpha)))


def law_table(material: float | Prony | Bodies | LawTable, coefficients: Floats | None = None) -> LawTable:
    """Return the table of the law of a material; it is made once a process and shared by all its threads.

    The last 32 tables are kept.

    Parameters
    ----------
    material : alpha >= 1 as a number, with T_epsilon for the unit of time; a :class:`..prony.Prony` series;
        :class:`..bodies.Bodies`, which are one material if they are alike or both elastic, or a :class:`..cover.Cover`;
        or a :class:`LawTable`, which is returned.
    coefficients : rows of the law, as read from a file, (rows, 24 powers, 7 functions), from which a new table is made,
        which is not kept; None: they are computed.  Ignored for a table, a cover and elastic bodies.

    Returns
    -------
    LawTable
        With times in the unit of the material, T_ref = 1 and no ``pair``.

    Raises
    ------
    ParameterError
        Many materials; times beyond 1e-100 to 1e100 of their unit (of half-spaces), which is also the message for an
        alpha in (0, 1) or NaN; a pair of more than 64 modes; a cover that is too thin.  :func:`.netcdf.law_table_of`
        refuses an alpha by its range.
    """
    if isinstance(material, LawTable):
        return material
    if isinstance(material, Prony | Bodies) and material.shape:
        raise ParameterError("material", repr(material), "one material, as material[i]")
    if isinstance(material, Bodies) and not isinstance(material, Cover) and (material.like or material.alpha == 1.0):
        material = material.total if material.total.E.size else 1.0
    material = material if isinstance(material, Prony | Bodies) else float(material)
    if coefficients is not None:
        return make_table(material, coefficients)
    with _lock:
        return _made(material)


def coupled_table(material: Any, rows: CoupledRows) -> LawTable:
    """Return the law of coupled rows as a :class:`LawTable`.

    material: alpha, a series, bodies or a cover, of one scene.
    rows: :class:`.coupled_rows.CoupledRows` of it.
    """
    total = total_series(material)
    base = law_table(total if total.E.size else 1.0)
    return replace(base, material=material, unlike=True, coupled=rows)


_lock = threading.Lock()


@lru_cache(maxsize=_KEPT_TABLES)
def _made(material: float | Prony | Bodies) -> LawTable:
    return make_table(material)


def make_table(
    material: float | Prony | Bodies, coefficients: Floats | None = None, cover: CoverRows | None = None
) -> LawTable:
    """Make the table of the law of a material, without looking for one that was kept; rows that are not given are
    computed.

    material: alpha >= 1 as a float, a :class:`..prony.Prony` of one material, :class:`..bodies.Bodies` of one pair, or
        one :class:`..cover.Cover`.  Bodies are taken as unlike: :func:`law_table` replaces alike or elastic ones.
    coefficients: rows of the law, (rows, 24 powers, 7 functions); None: they are computed.  Ignored for a cover and for
        elastic bodies, whose functions are the constants 1 and 0.
    cover: :class:`.pack.CoverRows`, rows of the law of a cover; None: they are computed if ``material`` is one.
        Ignored for other materials.
    Returns the :class:`LawTable`, whose arrays are read-only, with T_ref = 1; N is computed at first use, but of
    elastic bodies it is 0.
    Raises ParameterError for times of half-spaces beyond 1e-100 to 1e100 of their unit, for a pair of more than 64
    modes, and for a cover that is too thin.
    """
    total, unlike = total_series(material), isinstance(material, Bodies)
    modes, alpha = total.modes, total.alpha
    weights = material.half_space_weights if isinstance(material, Bodies) else np.full(modes.J.size, 0.5)
    W = modes.J * modes.b
    terms = W, W * (math.log(2.0) - np.log(modes.b) - np.euler_gamma), modes.J / modes.b
    sums = np.array([[math.fsum(part * term) for term in terms] for part in (1.0, weights, 1.0 - weights)])
    e0, T_mean = 0, total.T_mean
    if isinstance(material, Cover):
        cover = cover or cover_rows(material)
        coefficients, e0, T_mean = cover.coefficients, cover.e0, float(cover.coefficients[0, 0, 2:4].sum())
    elif modes.a.size:
        refuse_distant_times(modes.b[0], modes.a[-1])
        e0, count = map(int, row_range(modes.b[0], modes.a[-1]))
        if coefficients is None:
            coefficients = fit_rows(material, Rows(e0, count), alpha, sums[1:, 2])
    else:  # elastic bodies: lam = eta/F = H/F^2 = 1, and neither shift nor moment
        coefficients = steady_table(constant_rows(1.0, 0.0, 0.0, 0.0, 1.0, 1.0), N=0.0)
    arrays = (coefficients, sums[:, :2], modes.E, 1.0 / modes.a, modes.J, 1.0 / modes.b, weights)
    coefficients, fast_limit, E, tau, J, T, weights = map(lock_array, arrays)
    return LawTable(material, coefficients, e0, alpha, T_mean, unlike, fast_limit, E, tau, J, T, weights, cover=cover)
