"""The law of one material or pair, or of every alpha, as a dataset with its measured errors."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ...contact_law.contact_table import evaluate_law
from ...core.array_types import Floats
from ...core.errors import ParameterError, exactly_one_error
from ...cylinder import Cylinder
from ...materials.law import alpha_axis
from ...materials.law.cover_rows import solve_at_speed
from ...materials.law.evaluate import evaluate_by_modes
from ...materials.law.netcdf import law_as_dataset, law_table_of
from ...materials.law.pack import AXIS_FUNCTIONS, FUNCTIONS
from ...materials.law.table import LawTable

if TYPE_CHECKING:
    import xarray as xr

#: Of a cover: what is compared with its solve, at so many speeds, by so many terms of the pressure.
_OF_COVER = "lam", "delta_star", "delta_0", "epsilon", "M_half_space", "M_cylinder"
_SOLVES, _TERMS = 40, 60
#: Functions of kappa |V|; the others are of v = 1/F(eta).
_OF_SPEED = 5
#: Places in every octave at which errors are measured, and alphas in every octave of alpha, at random with this seed.
_PLACES, _ALPHAS, _SEED = 8, 16, 20250701


def law(material: Any = None, base: Any = None, *, alpha: tuple[float, float] | None = None) -> xr.Dataset:
    """The contact law of one material or pair: polynomials, one an octave of speed, for files and other programs.

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
        Coefficients of lam, epsilon, m_half_space, m_cylinder and N over kappa \\|V\\|, of share and press over
        v = 1/F(eta), each with its ``largest_relative_error`` against the modes' formulas, measured at eight random
        places of every octave (parts of M over M, N over its largest); numbers of the limits; both forms of the series;
        the material as TOML.  ``comment`` has the evaluator in words.  Any speed, creep, kappa, mu, load and radius.
        Of every alpha polynomials of ln alpha too, an octave a piece, of lam, epsilon/c, M/V/c, N/c, share and press
        with c = (alpha - 1)/alpha, and errors of the laws of random alphas.

    Raises
    ------
    ParameterError
        What is no material, alphas out of range, both or neither.
    """
    if (alpha is None) == (material is None):
        raise exactly_one_error("material", "alpha", both=alpha is not None)
    if alpha is not None:
        if base is not None or np.shape(alpha) != (2,):
            raise ParameterError("alpha", f"{alpha!r:.60}", "the lowest and the highest alone, as (1, 4096)")
        found: LawTable | alpha_axis.LawAxis = alpha_axis.law_axis(*alpha)
    else:
        found = (_of_cylinder if isinstance(material, Cylinder) else law_table_of)(material, base)
    return law_as_dataset(found, measured_errors(found))


def _of_cylinder(given: Cylinder, base: Any) -> LawTable:
    """That of its bodies; of a layer at its l0."""
    if given.pair.covered is None:
        return law_table_of(given.pair, base)
    return replace(law_table_of(given.scene().material, base), T_ref=given.T_ref, pair=given.pair)


def measured_errors(
    table: LawTable | alpha_axis.LawAxis, count: int | None = None, seed: int = _SEED
) -> dict[str, float]:
    """Largest relative error of every function at random places before its fast limit.

    No equation is solved: a random zeta gives both a speed and, by the modes' formulas, the functions there.

    Parameters
    ----------
    table : a law, or that of every alpha, which is looked at for random ones.
    count : of places, of every alpha or so; default: eight an octave.
    seed : of the places.
    """
    if isinstance(table, alpha_axis.LawAxis):
        octaves, random = len(table.rows), np.random.default_rng(seed)
        alphas = np.exp2(table.first + octaves * random.random(_ALPHAS * octaves)).tolist()
        each = [measured_errors(table.at(alpha), count and 1 + count // len(alphas), seed) for alpha in alphas]
        worst = {name: max(one[name] for one in each) for name in FUNCTIONS}
        worst["m"] = worst["m_half_space"] + worst["m_cylinder"]
        return {name: worst[name] for name in AXIS_FUNCTIONS}
    if table.cover is not None:
        return _errors_of_cover(table, count or _SOLVES, seed)
    rows, e0 = table.coefficients.shape[0], table.e0
    # kappa |V| = 1/(2 sqrt(H)) and v = 1/F lie within [1/(2 zeta sqrt(alpha)), 1/zeta]
    octaves = rows + np.log2(table.alpha) / 2.0 + 3.0
    random = np.random.default_rng(seed)
    zeta = np.exp2(2.0 - e0 - octaves * random.random(count or int(_PLACES * octaves)))
    (shift, rise, half_space, cylinder), _, N = evaluate_by_modes(table.material, zeta)
    root, F, M = np.sqrt(1.0 + 2.0 * rise), 1.0 + shift, half_space + cylinder
    exact = 1.0 / root, shift, half_space, cylinder, N, 1.0 / F, (root / F) ** 2
    scales = exact[0], exact[1], M, M, np.full(zeta.size, np.abs(N).max()), exact[5], exact[6]
    errors = {}
    for n, name in enumerate(FUNCTIONS):
        x = 0.5 / (zeta * root) if n < _OF_SPEED else 1.0 / (zeta * F)
        inside = (x < np.ldexp(1.0, e0 + rows - 1)) & (scales[n] > 0.0)
        error = np.abs(_polynomial(table, n, x[inside]) - exact[n][inside]) / scales[n][inside]
        errors[name] = float(np.max(error, initial=0.0))
    return errors


def _errors_of_cover(table: LawTable, count: int, seed: int) -> dict[str, float]:
    """Those of a layer against its solve with half as many terms again, at speeds around its rates; share and press
    against what they are of the others, L."""
    cover: Any = table.material
    slow, fast = 0.1 / table.retardation_time.max(initial=1.0), 10.0 / table.relaxation_time.min(initial=1.0)
    u = slow * (fast / slow) ** np.random.default_rng(seed).random(count)
    exact = np.array([solve_at_speed(cover, each, orders=_TERMS) for each in u.tolist()]).T
    found = evaluate_law(table, [1.0, 1.0, 1.0, u, 0.0], u.shape, False, _OF_COVER)
    L, M = exact[1], u * exact[4]
    free = found[2] * (2.0 if cover.on == "base" else -2.0)
    errors = found[0] / exact[0] - 1.0, 2.0 * found[1] / L - 1.0, (free - exact[2]) / L, found[3] / exact[3] - 1.0
    lam, limit, free, epsilon = (float(np.abs(each).max(initial=0.0)) for each in errors)
    moment = float(np.abs(np.divide(found[4] + found[5], M, out=np.ones(count), where=M > 0.0) - 1.0).max())
    return {
        "lam": lam, "epsilon": epsilon, "m_half_space": moment, "m_cylinder": moment, "share": lam + limit,
        "press": 2.0 * limit, "limit": limit, "free": free,
    }  # fmt: skip


def _polynomial(table: LawTable, function: int, x: Floats) -> Floats:
    """A function at places before its fast limit, by its coefficients."""
    m, e = np.frexp(x)
    row = np.maximum(e - table.e0, 0)
    t = np.where(row == 0, np.ldexp(x, -table.e0), 4.0 * m - 3.0)
    return np.asarray(np.polynomial.polynomial.polyval(t, table.coefficients[row, :, function].T, tensor=False))
