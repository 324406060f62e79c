"""The law of a material, a pair or every alpha as a dataset with its measured errors (:func:`law`),
and checks of tables: a law against the formulas of its modes, a grid against the rows of the law
(:func:`check_table`).

The rows of a law are its polynomials, one for each octave of speed.

kappa is the radius divided by the contact length at rest; zeta is the time in which a point passes
through half the contact, eta that through half the stick zone, in units of T_ref.  At a speed V:
lam = 2 kappa V zeta is the contact length divided by that at rest, epsilon the shift of the contact
in half contact lengths, H(zeta) = (zeta/lam)^2 and F(zeta) = zeta (1 + epsilon).  M is the rolling
moment, N that of M + N dV/dt at slow speed changes, delta_star the creepage at which full slip
begins, and delta_0 that of free rolling, which is 0 but for a layer.
"""

import dataclasses
from typing import Any, NamedTuple

import numpy as np

from .. import __version__
from ..contact_mechanics import Contacts, measure_errors, pair_of_scene
from ..core import (
    Dataset,
    FileError,
    ParameterError,
    check_integer,
    check_one_given,
    describe_value,
    warn_of_model,
)
from ..laws import (
    AXIS_FUNCTIONS,
    COVER_FUNCTIONS,
    FUNCTIONS,
    LawAxis,
    LawTable,
    Rows,
    evaluate_by_modes,
    law_as_dataset,
    law_axis,
    law_table_of,
    parse_axis,
    parse_law,
    solve_at_speed,
)
from ..materials import AXIS, COUPLED, COVER, KIND, LAW, dataset_content, stated_errors
from ..rollers import Cylinder, Scene
from .grid_build import RELATIVE_FIELDS, differences, errors_at, random_points
from .table_files import check_grid, fields_of, is_law

# --- The law of one material or pair, or of every alpha ---

#: Points at which a table of the coupled solution is compared with states.
COUPLED_POINTS = 80
#: Fields of a cover that are compared with its solve.
_COVER_FIELDS = "lam", "delta_star", "epsilon", "M_half_space", "M_cylinder"
#: Speeds at which they are compared.
_COVER_SPEEDS = 40
#: Terms of the pressure in that solve: half as many again as for the rows.
_COVER_TERMS = 60
#: Points in every octave at which errors are measured.
_POINTS_PER_OCTAVE = 8
#: Random alphas in every octave of alpha at which errors are measured.
_ALPHAS_PER_OCTAVE = 16
#: Seed of these points and alphas, so that the errors can be reproduced.
_SEED = 20250701


def law(
    material: Any = None, base: Any = None, *, alpha: tuple[float, float] | None = None
) -> Dataset:
    r"""Return the contact law of one material or pair for other programs: polynomials, one for each
    octave of speed.

    Parameters
    ----------
    material : a :class:`viscoroll.Prony`, a :class:`viscoroll.Bodies`, a
        :class:`viscoroll.Material` without a thickness, a :class:`viscoroll.Cylinder`, of which the
        bodies are taken, or a number alpha in [1, 1e12], of a solid with T_epsilon = 1.
    base : the :class:`viscoroll.Material` of the half-space where it differs from that of the
        cylinder; only beside a Material.
    alpha : in place of a material, (lowest, highest) alpha of the law of every alpha between, of
        one relaxation time with T_epsilon = 1; both in [1, 1e12], the first below the second.  The
        range is extended to whole octaves [2^n, 2^(n+1)).

    Returns
    -------
    xarray.Dataset
        Of half-spaces the coefficients of lam, epsilon, m_half_space, m_cylinder (M of either body
        divided by V) and N over ``kappa |V|``, of share = eta/F(eta) and press = H(eta)/F(eta)^2
        over v = 1/F(eta), where eta is half the transit time of the stick zone; each is a variable
        over (octave, power), and has its ``largest_relative_error`` as an attribute
        (:func:`measured_errors`).  Further variables are the fast limits and both forms of the
        series; attributes are the material as TOML and ``comment``, which describes the evaluation.
        The law holds for any speed, creepage, kappa, mu, load and radius.

        Of a cylinder with a layer (a thickness) the law holds at its ratio of l0 to thickness
        alone, that is at its load and radius, and at any speed, creepage and mu.  It has no N and
        no series, and in addition functions of ``kappa |V|`` alone: limit = 2 kappa delta_star/mu,
        and what shear does (``comment``).

        With ``alpha`` the polynomials are of ln alpha too, one for each octave of alpha, of lam,
        epsilon/c, M/(V c), N/c, share and press with c = (alpha - 1)/alpha, over (octave_of_alpha,
        degree, octave, power).

    Raises
    ------
    ParameterError
        An argument that is no material, or materials in an array; alphas out of range, or not two
        in ascending order; both or neither of ``material`` and ``alpha``; a ``base`` beside
        anything but a Material; a Material with a thickness, as its law depends on load and radius:
        give the Cylinder; a layer too thin for its law.

    Warns
    -----
    ModelWarning
        Of a Cylinder with a layer, or on a half-space with Dundurs' constant above 0.05, unless it
        has ``coupled=False``: the law is the one without a table of the coupled solution.

    Examples
    --------
    >>> import viscoroll as vr
    >>> table = vr.tables.law(vr.presets.RUBBER_CYLINDER)
    >>> table.attrs["viscoroll_table"]
    'law'
    """
    check_one_given(material=material, alpha=alpha)
    table: LawTable | LawAxis
    if alpha is not None:
        if base is not None:
            raise ParameterError("base", describe_value(base), "left out if alpha is given")
        if np.shape(alpha) != (2,):
            raise ParameterError(
                "alpha",
                describe_value(alpha),
                "a range (lowest, highest), for example (1, 4096); for a single alpha give that "
                "number as material",
            )
        table = law_axis(*alpha)
    elif isinstance(material, Cylinder):
        pair = material.pair
        covered = pair.covered is not None
        # of a layer that of the scene, which has the thickness in units of its l0
        table = law_table_of(material.scene().material if covered else pair, base)
        if covered:
            table = dataclasses.replace(table, T_ref=material.T_ref, pair=pair)
        if material.body_data.scene.tabulated:
            # the largest error of six decades of speed
            speeds = material.l0 / material.T_ref * np.logspace(-3.0, 3.0, 61)
            report = material.replace(coupled=False).validity(speeds)
            warn_of_model(
                "the table has the law with coupled=False, while contact solves pressure and shear "
                "together (vr.tables.build(cylinder, method='coupled') makes a table of that): "
                + (report.traction if covered else report.bodies).sentence
            )
    else:
        table = law_table_of(material, base)
    return law_as_dataset(table, measured_errors(table))


def measured_errors(
    table: LawTable | LawAxis, count: int = 0, seed: int = _SEED
) -> dict[str, float]:
    """Compare a tabulated law with exact values at random points, and return the largest error of
    each function.

    There are four cases:

    - Half-spaces: no equation is solved.  A random zeta (half the transit time of the contact, in
      T_ref) gives, by the closed formulas of the modes, the functions and the speed ``kappa |V|``
      or v = 1/F at which they have these values.  Points in the fast limit, beyond the last row of
      the table, are left out.
    - Every alpha: 16 random alphas for each octave of alpha; the law of each is compared as one of
      half-spaces.
    - A table of the coupled solution: states that are no nodes are solved, and errors are absolute.
    - A cover, a layer of finite thickness: at each random speed the contact is solved with more
      terms of the pressure than the table was made with (:func:`_measured_errors_of_cover`).

    Parameters
    ----------
    table : :class:`LawTable` of half-spaces or of a cover; or :class:`.law_tables.LawAxis`, the law
        of every alpha.
    count : number of points.  Of every alpha the laws of the random alphas share it, with at least
        one point each.
        0: eight for each octave of zeta (of each alpha), or 40 speeds for a cover.
    seed : seed of the points and alphas, >= 0.

    Returns
    -------
    dict of str to float
        Name of a function -> largest error, >= 0, dimensionless; 0.0 of a function that is 0 at all
        points, as epsilon of elastic bodies.

        - Half-spaces, names :data:`FUNCTIONS`: relative to the exact value at the point; of
          m_half_space and m_cylinder relative to their sum there, of N to the largest |N| at one
          zeta in each octave.
        - Every alpha, names :data:`AXIS_FUNCTIONS`: the largest of these over the alphas; "m" has
          the sum of the largest errors of both parts of M.
        - A cover: names and scales of :func:`_measured_errors_of_cover`, without N.

    Raises
    ------
    ParameterError
        A cover whose solve at one of the speeds finds no contact length that carries the load.
    """
    if isinstance(table, LawTable) and table.coupled is not None:
        pair = pair_of_scene(Scene(material=table, kappa=1.0, mu=table.coupled.mu))
        return measure_errors(table.coupled, pair, count or COUPLED_POINTS, seed)
    random = np.random.default_rng(seed)
    if isinstance(table, LawAxis):
        octaves = len(table.rows)
        alphas = np.exp2(
            table.first + octaves * random.random(_ALPHAS_PER_OCTAVE * octaves)
        ).tolist()
        found = [
            # at least one point each; 0 stays, the number by octaves
            measured_errors(table.at(alpha), count and 1 + count // len(alphas), seed)
            for alpha in alphas
        ]
        worst = {name: max(errors[name] for errors in found) for name in FUNCTIONS}
        worst["m"] = worst["m_half_space"] + worst["m_cylinder"]
        return {name: worst[name] for name in AXIS_FUNCTIONS}
    if table.cover is not None:
        return _measured_errors_of_cover(table, count or _COVER_SPEEDS, random)
    e0 = table.e0
    rows = Rows(e0, len(table.coefficients))
    # kappa |V| = 1/(2 sqrt(H)) and v = 1/F lie within [1/(2 zeta sqrt(alpha)), 1/zeta].
    octaves = rows.count + np.log2(table.alpha) / 2.0 + 3.0
    # from 4 2^-e0, whose x is in row 0, down to where x is beyond the last row for every alpha
    zeta = np.exp2(2.0 - e0 - octaves * random.random(count or int(_POINTS_PER_OCTAVE * octaves)))
    (shift, growth, half_space, cylinder), _, N = evaluate_by_modes(table.material, zeta)
    # H = zeta^2 (1 + 2 growth) and F = zeta (1 + shift), in closed form
    root = np.sqrt(1.0 + 2.0 * growth)
    F = 1.0 + shift
    lam = 1.0 / root
    share = 1.0 / F
    press = (root / F) ** 2
    M = half_space + cylinder
    # of a few points the largest |N| may be far below that of the law
    largest = np.abs(
        evaluate_by_modes(table.material, np.exp2(2.0 - e0 - np.arange(octaves))).N
    ).max()
    u = 0.5 / (zeta * root)
    v = 1.0 / (zeta * F)
    # variable, exact value and scale of each function, in the order of FUNCTIONS
    compared = [
        (u, lam, lam),
        (u, shift, shift),
        (u, half_space, M),
        (u, cylinder, M),
        (u, N, np.full(zeta.size, largest)),
        (v, share, share),
        (v, press, press),
    ]
    errors = {}
    for n, (x, exact, scale) in enumerate(compared):
        # where the scale is 0 the function is 0 by construction
        inside = (x <= rows.last) & (scale > 0.0)
        (found,), _ = rows.read(table.coefficients[None, ..., n], x[inside])
        error = np.abs(found - exact[inside]) / scale[inside]
        errors[FUNCTIONS[n]] = float(np.max(error, initial=0.0))
    return errors


def _measured_errors_of_cover(
    table: Any, count: int, random: np.random.Generator
) -> dict[str, float]:
    """Compare the law of a layer at random speeds with solutions of the contact that have 60 terms
    of the pressure (:func:`.cover_rows.solve_at_speed`).

    table: :class:`LawTable` of a cover.
    count: number of speeds u = kappa |V|, >= 1, drawn evenly in ln u at random, from a tenth of the
        slowest rate of the bodies (at most 0.1) to ten times the fastest (at least 10), rates
        multiplied by T_ref.
    random: numpy Generator, which draws the speeds and is advanced.
    Returns function -> largest error of all speeds, >= 0, dimensionless:

    - "lam", "epsilon", "limit" (of L = 2 kappa delta_star/mu): relative errors;
    - "m_half_space", "m_cylinder": errors divided by their sum M, 0 where M = 0;
    - each of :data:`COVER_FUNCTIONS` from the second on, which describe the effect of shear: errors
      divided by L;
    - "share" = lam/L and "press" = 1/L^2: not compared, but bounded to first order, "share" by the
      sum of the errors of lam and L, "press" by twice the error of L.
    Raises ParameterError where a solution finds no contact length that carries the load.
    """
    slow = 0.1 / table.retardation_time.max(initial=1.0)
    fast = 10.0 / table.relaxation_time.min(initial=1.0)
    u = slow * (fast / slow) ** random.random(count)
    solved = [solve_at_speed(table.material, each, orders=_COVER_TERMS) for each in u.tolist()]
    # M of both bodies divided by u
    lam, L, epsilon, half_space, cylinder, *by_shear = np.transpose(solved)
    M = u * (half_space + cylinder)
    # an elastic layer has one row, of constants
    if len(table.steady_coefficients) > 1:
        found = Rows(table.e0, len(table.steady_coefficients)).read(table.cover.creep[1:], u)[0]
    else:
        found = table.cover.creep[1:, 0, :1]
    errors = dict(zip(COVER_FUNCTIONS[1:], (found - by_shear) / L))
    # at the creepage without creep force there is no traction
    free = 0.5 * (found[0] + found[1])  # kappa delta, from the parts of both bodies
    values = Contacts(table, 1.0, 1.0).fields(u, free, *_COVER_FIELDS)
    # at kappa = mu = 1 the limit L is 2 delta_star
    errors |= {"lam": values[0] / lam - 1.0, "limit": 2.0 * values[1] / L - 1.0}
    # of elastic bodies both epsilon and M are 0
    errors["epsilon"] = (values[2] - epsilon) / np.where(epsilon > 0.0, epsilon, 1.0)
    scale = np.where(M > 0.0, M, 1.0)
    errors["m_half_space"] = (values[3] - u * half_space) / scale
    errors["m_cylinder"] = (values[4] - u * cylinder) / scale
    largest = {name: float(np.abs(error).max(initial=0.0)) for name, error in errors.items()}
    return largest | {"share": largest["lam"] + largest["limit"], "press": 2.0 * largest["limit"]}


# --- Checks of tables ---

#: Largest allowed difference of a node of a grid from the rows, relative or divided by the largest
#: value of its field: M as printed has an error of 9e-14 at kappa V = 100
#: (kernels/law/printed_law.py).
NODES_ALLOWED = 1e-12
#: Ratio by which the error in a random sample may exceed the stated error, which is the largest of
#: another sample.
SAMPLE_RATIO = 2.0
#: Largest allowed error of the splines of a grid, divided by the largest value of the field,
#: whatever the grid states: a bound beyond the range of the field would allow anything.
_MOST_ALLOWED = 0.5
#: The same as :data:`SAMPLE_RATIO` of laws whose stated errors are those of some tens of points.
_FEW_RATIO = 8.0
#: Largest number of points of laws whose points are solved, some seconds of work, by kind.
_MOST_POINTS = {COUPLED: COUPLED_POINTS, COVER: 400}
#: Kind of the file of a law -> points at which it is checked, and the reference.
_REFERENCES = {
    LAW: "random speeds, against the exact formulas",
    AXIS: "random speeds and alphas, against the exact formulas",
    COVER: "random speeds, against a more accurate solution (a longer series for the pressure)",
    COUPLED: "random speeds and creepages, against the coupled solution there",
}
#: Rounding error of a value, added to the stated error.
ROUNDING = 2e-15
#: The same of what shear does in the contact of a cover, relative to L.  It is that of the last
#: length solved, which may differ from the length found by the least step of the solve, 1e-8 in
#: ln z (laws/cover_rows.py).  At most speeds it differs by 1e-11, so that the errors at 40 speeds,
#: which a file states, do not show the largest.
_LENGTH_ERROR = 1e-8


class Check(NamedTuple):
    """A largest difference and its bound.

    name : name of the check.
    measured, allowed : largest difference and its bound, in the unit that ``meaning`` states.
    meaning : words: relative or absolute, at which points, against which reference.
    """

    name: str
    measured: float
    allowed: float
    meaning: str

    @property
    def passed(self) -> bool:
        """Whether the difference is within the bound; a NaN is not."""
        return bool(self.measured <= self.allowed)


@dataclasses.dataclass(frozen=True)
class Report:
    """All checks of a validation, and the settings it ran with.

    checks : the checks, :class:`Check` each, at least one.
    settings : name of a setting, as "seed" -> number; only printed.
    """

    checks: tuple[Check, ...]
    settings: dict[str, int]

    @property
    def ok(self) -> bool:
        """Whether every check passed."""
        return all(check.passed for check in self.checks)

    def __str__(self) -> str:
        """Return a table in words: a heading, a line for each check, a blank line, the verdict,
        version and settings.

        The line of a check has its name, the measured and the allowed difference, "ok" or
        "EXCEEDED", and the meaning.  The verdict is the number of checks whose difference is beyond
        what is allowed or NaN, or that there is none.
        Raises ValueError without checks.
        """
        width = max(len(check.name) for check in self.checks)
        lines = [
            f"{c.name:<{width}} {c.measured:9.2e} {c.allowed:9.2e}  "
            f"{'ok' if c.passed else 'EXCEEDED':<8}  {c.meaning}"
            for c in self.checks
        ]
        failed = sum(not check.passed for check in self.checks)
        verdict = (
            f"{failed} with a difference larger than allowed"
            if failed
            else "no difference is larger than allowed"
        )
        settings = ", ".join(f"{name} {value}" for name, value in self.settings.items())
        return "\n".join(
            [
                f"{'check':<{width}} difference  allowed            what is compared",
                *lines,
                "",
                f"{len(self.checks)} checks: {verdict}.",
                f"viscoroll {__version__}; {settings}",
            ]
        )


def check_table(table: Dataset, count: int, seed: int) -> list[Check]:
    """Check a table by numbers that were not used to make it, and return a :class:`Check` for each
    difference.

    The law of half-spaces, or the laws of random alphas, are compared with the formulas of the
    modes at random speeds; the law of a layer with solves of the contact
    (:func:`measured_errors`).  Of a grid every node is compared with the rows of the law, and
    the splines at random points in random cells.

    Parameters
    ----------
    table : dataset of :func:`viscoroll.tables.law`, of :func:`viscoroll.tables.build`
        for a scene of one relaxation time, or of :func:`viscoroll.tables.load`.
    count : number of random points, >= 1; of a layer that of the speeds, at most 400, of a table
        of the coupled solution at most 80, of every alpha as in :func:`measured_errors`.
    seed : seed of the random points, >= 0.

    Returns
    -------
    list of Check
        Of a law one for each function: the largest error, dimensionless, of the kind that
        :func:`measured_errors` states; allowed are the error that the file states times
        2 (of a layer and of a table of the coupled solution 8) plus :data:`ROUNDING`, of functions
        of the effect of shear plus 1e-8.  Of a grid two for each field: its nodes, then its splines
        (:func:`_check_grid`).

    Raises
    ------
    ParameterError
        A count or seed out of range or no whole number; the law of a layer whose solve finds no
        contact length.
    FileError
        A grid of a material or a cylinder, a dataset that is no table, or a law that is incomplete.
    """
    count = check_integer("n", count, 1)
    seed = check_integer("seed", seed, 0)
    source = table.encoding.get("source", "the dataset")
    if not is_law(table):
        return _check_grid(table, count, seed, source)
    content = dataset_content(table)
    kind = content.attributes[KIND]
    read = parse_axis if kind == AXIS else parse_law
    count = min(count, _MOST_POINTS.get(kind, count))
    ratio = _FEW_RATIO if kind in _MOST_POINTS else SAMPLE_RATIO
    errors = measured_errors(read(content, source), count, seed)
    return [
        Check(
            f"{table.attrs['title']}: {name}",
            errors[name],
            ratio * stated + (_LENGTH_ERROR if name in COVER_FUNCTIONS[1:] else ROUNDING),
            f"{'absolute' if kind == COUPLED else 'relative'}; at {count} {_REFERENCES[kind]}",
        )
        for name, stated in stated_errors(table).items()
    ]


def _check_grid(table: Dataset, count: int, seed: int, source: str) -> list[Check]:
    """Compare a grid with the rows of the law: two checks for each field, of its nodes and of the
    splines between them.

    table: dataset of a grid; attributes kappa and mu, and alpha unless it is an axis.
    count: number of random points, >= 1.
    seed: seed of these points, >= 0.
    source: path of the grid, for messages.
    Returns a flat list of 2 times as many :class:`Check` as the grid has fields: nodes and splines
    of the first field ("beta"), nodes and splines of the second, and so on.

    - "grid: NAME, nodes": the largest difference over all nodes (:func:`.grid_build.differences`),
      dimensionless: of lam, zeta and delta_star relative at each node, of the other fields divided
      by their largest magnitude.  Allowed are 1e-12.
    - "grid: NAME, splines": the largest error at ``count`` random points, absolute, in the unit of
      the field.  Allowed are 2 times the ``spline_error`` that the grid states, plus 2e-15, and at
      most half of the largest magnitude of the field at the nodes, unless that is 0.

    Where the grid states no ``spline_error``, NaN is allowed, and the check fails.
    Raises FileError for what is no grid, and for a grid that is not of a scene with an alpha (of a
    cylinder or a material).
    """
    check_grid(table, source)
    if not {"kappa", "mu"} <= table.attrs.keys() or "material" in table.attrs:
        raise FileError(
            source,
            "is a grid of a cylinder or a material, but only a grid of a Scene with alpha can be "
            "checked: make the law of that material (vr.tables.law), and check this law",
        )
    scene = Scene(
        alpha=table.attrs.get("alpha", 1.0), kappa=table.attrs["kappa"], mu=table.attrs["mu"]
    )
    nodes = differences(table, scene)
    splines = errors_at(table, scene, random_points(table, count, seed))
    checks = []
    for name in fields_of(table):
        kind = "relative" if name in RELATIVE_FIELDS else "divided by the largest value"
        # a field of zeros, as M of elastic bodies, has no such bound
        most = _MOST_ALLOWED * float(np.abs(table[name]).max()) or np.inf
        stated = float(table[name].attrs.get("spline_error", np.nan))
        checks += [
            Check(
                f"grid: {name}, nodes",
                nodes[name],
                NODES_ALLOWED,
                f"{kind}; all nodes, compared with the law",
            ),
            Check(
                f"grid: {name}, splines",
                float(np.max(splines[name])),
                min(SAMPLE_RATIO * stated + ROUNDING, most),
                f"absolute; {count} random points, compared with the law",
            ),
        ]
    return checks
