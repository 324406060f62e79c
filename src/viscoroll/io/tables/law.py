"""The law of one material or pair, or of every alpha, as a dataset with its measured errors."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ...contact_law.contact_table import evaluate_law
from ...core.array_types import Floats
from ...core.errors import ParameterError, check_one_given
from ...cylinder import Cylinder
from ...materials.law import alpha_axis
from ...materials.law.cover_rows import solve_at_speed
from ...materials.law.evaluate import evaluate_by_modes
from ...materials.law.netcdf import law_as_dataset, law_table_of
from ...materials.law.pack import AXIS_FUNCTIONS, FUNCTIONS
from ...materials.law.table import LawTable

if TYPE_CHECKING:
    import xarray as xr

#: Fields of a cover that are compared with its solve.
_COVER_FIELDS = "lam", "delta_star", "delta_0", "epsilon", "M_half_space", "M_cylinder"
#: Speeds at which they are compared.
_COVER_SPEEDS = 40
#: Terms of the pressure in that solve: half as many again as for the rows.
_COVER_TERMS = 60
#: Number of functions of kappa |V|, the first in FUNCTIONS; the others are functions of v = 1/F(eta).
_SPEED_FUNCTIONS = 5
#: Points in every octave at which errors are measured.
_POINTS_PER_OCTAVE = 8
#: Random alphas in every octave of alpha at which errors are measured.
_ALPHAS_PER_OCTAVE = 16
#: Seed of these points and alphas, so that the errors can be reproduced.
_SEED = 20250701


def law(material: Any = None, base: Any = None, *, alpha: tuple[float, float] | None = None) -> xr.Dataset:
    r"""Return the contact law of one material or pair for other programs: polynomials, one for each octave of speed.

    Parameters
    ----------
    material : a :class:`viscoroll.Prony`, :class:`viscoroll.Bodies`, :class:`viscoroll.Material`, that of a
        :class:`viscoroll.Cylinder`, or alpha >= 1, of a solid with T_epsilon = 1.
    base : the :class:`viscoroll.Material` of the half-space where it is another.
    alpha : in place of a material, the lowest and the highest alpha of the law of every alpha between, of one
        relaxation time with T_epsilon = 1; whole octaves, within 1 and 1e12.

    Returns
    -------
    xarray.Dataset
        Coefficients of lam, epsilon, m_half_space, m_cylinder and N over ``kappa |V|``, of share and press over
        v = 1/F(eta), each with its ``largest_relative_error`` against the formulas of the modes, measured at eight
        random points of every octave (parts of M relative to M, N to its largest value); limits; both forms of the
        series; the material as TOML.  ``comment`` describes the evaluation.  The law holds for any speed, creepage,
        kappa, mu, load and radius.  For every alpha polynomials of ln alpha too, one for each octave, of lam,
        epsilon/c, M/V/c, N/c, share and press with c = (alpha - 1)/alpha, and errors of the laws of random alphas.

    Raises
    ------
    ParameterError
        An argument that is no material, alphas out of range, both or neither of ``material`` and ``alpha``.

    Examples
    --------
    >>> import viscoroll as vr
    >>> table = vr.tables.law(vr.presets.RUBBER_CYLINDER)
    >>> table.attrs["viscoroll_table"]
    'law'
    """
    check_one_given(material=material, alpha=alpha)
    table: LawTable | alpha_axis.LawAxis
    if alpha is not None:
        if base is not None or np.shape(alpha) != (2,):
            raise ParameterError("alpha", f"{alpha!r:.60}", "the lowest and the highest value, for example (1, 4096)")
        table = alpha_axis.law_axis(*alpha)
    elif isinstance(material, Cylinder):
        pair = material.pair
        table = law_table_of(pair if pair.covered is None else material.scene().material, base)
        if pair.covered is not None:  # a layer, which the scene of the cylinder has in units of its l0
            table = replace(table, T_ref=material.T_ref, pair=pair)
    else:
        table = law_table_of(material, base)
    return law_as_dataset(table, measured_errors(table))


def measured_errors(
    table: LawTable | alpha_axis.LawAxis, count: int | None = None, seed: int = _SEED
) -> dict[str, float]:
    """Return the largest relative error of every tabulated function at random points below its fast limit.

    For half-spaces no equation is solved: a random zeta (half the transit time of the contact) gives both a speed and,
    by the closed formulas of the modes, the functions there.  The law of a cover is compared with a solve with more
    terms at each speed.

    Parameters
    ----------
    table : :class:`LawTable` of half-spaces or of a cover; or :class:`.alpha_axis.LawAxis`, the law of every alpha, of
        which random alphas are tested.
    count : number of points, approximate for every alpha; default: :data:`_POINTS_PER_OCTAVE` in each octave, and
        :data:`_COVER_SPEEDS` speeds for the law of a layer.
    seed : seed of the points and alphas, >= 0.

    Returns
    -------
    dict of str to float
        Name of a function of the law -> largest relative error, dimensionless; of parts of M relative to M, of N to
        its largest value.  The names are :data:`FUNCTIONS` for half-spaces; :data:`AXIS_FUNCTIONS` for every alpha,
        where "m" has the sum of the errors of both parts of M; for a cover those of :func:`_measured_errors_of_cover`.
    """
    random = np.random.default_rng(seed)
    if isinstance(table, alpha_axis.LawAxis):
        octaves = len(table.rows)
        alphas = np.exp2(table.first + octaves * random.random(_ALPHAS_PER_OCTAVE * octaves)).tolist()
        found = [measured_errors(table.at(alpha), count and 1 + count // len(alphas), seed) for alpha in alphas]
        worst = {name: max(errors[name] for errors in found) for name in FUNCTIONS}
        worst["m"] = worst["m_half_space"] + worst["m_cylinder"]
        return {name: worst[name] for name in AXIS_FUNCTIONS}
    if table.cover is not None:
        return _measured_errors_of_cover(table, count or _COVER_SPEEDS, random)
    rows, e0 = table.coefficients.shape[0], table.e0
    # kappa |V| = 1/(2 sqrt(H)) and v = 1/F lie within [1/(2 zeta sqrt(alpha)), 1/zeta].
    octaves = rows + np.log2(table.alpha) / 2.0 + 3.0
    zeta = np.exp2(2.0 - e0 - octaves * random.random(count or int(_POINTS_PER_OCTAVE * octaves)))
    (shift, growth, half_space, cylinder), _, N = evaluate_by_modes(table.material, zeta)
    root, F, M = np.sqrt(1.0 + 2.0 * growth), 1.0 + shift, half_space + cylinder
    exact = 1.0 / root, shift, half_space, cylinder, N, 1.0 / F, (root / F) ** 2
    scales = exact[0], exact[1], M, M, np.full(zeta.size, np.abs(N).max()), exact[5], exact[6]
    errors = {}
    for n, name in enumerate(FUNCTIONS):
        x = 0.5 / (zeta * root) if n < _SPEED_FUNCTIONS else 1.0 / (zeta * F)
        inside = (x < np.ldexp(1.0, e0 + rows - 1)) & (scales[n] > 0.0)
        error = np.abs(_evaluate_polynomial(table, n, x[inside]) - exact[n][inside]) / scales[n][inside]
        errors[name] = float(np.max(error, initial=0.0))
    return errors


def _measured_errors_of_cover(table: LawTable, count: int, random: np.random.Generator) -> dict[str, float]:
    """Return the largest errors of the law of a layer against its solve with more terms, at random speeds.

    Errors of share and press follow from those of the other functions and of L = 2 kappa delta_star/mu.

    table: :class:`LawTable`, the law.
    count: number of speeds, from a tenth of the slowest rate of the layer to ten times the fastest.
    random: numpy Generator, which draws the speeds.
    Returns function -> largest relative error, dimensionless: "lam", "epsilon", "m_half_space", "m_cylinder" (both that
    of M), "share", "press", "limit" (of L), "free" (of delta_0, divided by L).
    """
    cover: Any = table.material
    slow, fast = 0.1 / table.retardation_time.max(initial=1.0), 10.0 / table.relaxation_time.min(initial=1.0)
    u = slow * (fast / slow) ** random.random(count)
    exact = np.array([solve_at_speed(cover, each, orders=_COVER_TERMS) for each in u.tolist()]).T
    found = evaluate_law(table, [1.0, 1.0, 1.0, u, 0.0], u.shape, False, _COVER_FIELDS)
    L, M = exact[1], u * exact[4]
    free = found[2] * (2.0 if cover.on == "base" else -2.0)
    moment = np.divide(found[4] + found[5], M, out=np.ones(count), where=M > 0.0) - 1.0
    errors = (
        found[0] / exact[0] - 1.0, 2.0 * found[1] / L - 1.0, (free - exact[2]) / L, found[3] / exact[3] - 1.0, moment,
    )  # fmt: skip
    lam, limit, free, epsilon, moment = (float(np.abs(error).max(initial=0.0)) for error in errors)
    return {
        "lam": lam, "epsilon": epsilon, "m_half_space": moment, "m_cylinder": moment, "share": lam + limit,
        "press": 2.0 * limit, "limit": limit, "free": free,
    }  # fmt: skip


def _evaluate_polynomial(table: LawTable, function: int, x: Floats) -> Floats:
    """Return a function of a law from its coefficients, at arguments before its fast limit.

    table: :class:`LawTable`, the law.
    function: index in :data:`FUNCTIONS`: 0 lam, 1 epsilon, 2 m_half_space, 3 m_cylinder, 4 N, 5 share, 6 press.
    x: kappa |V| for functions 0 to 4, v = 1/F(eta) for the others, (n,), dimensionless.
    Returns values, (n,), dimensionless.
    """
    m, e = np.frexp(x)
    row = np.maximum(e - table.e0, 0)
    t = np.where(row == 0, np.ldexp(x, -table.e0), 4.0 * m - 3.0)
    return np.asarray(np.polynomial.polynomial.polyval(t, table.coefficients[row, :, function].T, tensor=False))
