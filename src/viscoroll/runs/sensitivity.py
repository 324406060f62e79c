"""Sobol indices of a run, by which the variance of its motions is attributed to its uncertain
inputs.

Estimators are those of A. Saltelli et al., Computer Physics Communications 181 (2010) 259-270, on a
scrambled Sobol sequence; scipy.stats.sobol_indices, which has them too, fails for a single input
(SciPy 1.17).  The cost of a base point is one motion for every uncertain input and two more.
"""

import numpy as np

from ..core import (
    DataFrame,
    Dataset,
    Floats,
    MotionStatus,
    Names,
    NDArray,
    ParameterError,
    check_bool,
    check_integer,
    column_name,
    described_error,
    names_ending,
    run_blocks,
    unit_of,
)
from ..motion import QUANTITIES, column_attributes, provenance
from ..sampling import points
from .run_store import roll_inputs, warn_of_materials
from .runfile import Run
from .uncertain_inputs import Columns, Inputs, inputs_in

#: Level of the confidence intervals.
CONFIDENCE = 0.95
#: Number of bootstrap resamples: the standard deviation of a half-width is then 7 % of it.
_RESAMPLES = 100
#: Largest size of the outcomes of all motions, bytes.
_MOST_BYTES = 1 << 29
#: Largest number of motions of a block: about a second where they are integrated.
_BLOCK = 1 << 14
#: End of the name of an index or half-width -> its meaning.
_INDICES = {
    "S1": "first-order Sobol index",
    "S1_conf": (
        f"half-width of the {CONFIDENCE:.0%} confidence interval of the first-order Sobol index"
    ),
    "ST": "total Sobol index",
    "ST_conf": f"half-width of the {CONFIDENCE:.0%} confidence interval of the total Sobol index",
}


def sobol_indices(
    run: Run, n: int = 4096, *, threads: int | None = None, progress: bool = False
) -> Dataset:
    """Estimate first-order and total Sobol indices of the summarised quantities over all uncertain
    inputs.

    Parameters
    ----------
    run : a run of :func:`runs.read_run`; its inputs, seed, t, method, rtol, rest and summaries
        count, its n, design, keep and quantiles do not.
    n : number of base points in [16, 65536], rounded up to a power of two.
    threads : number of threads; None: ``$VISCOROLL_THREADS`` or the number of cores.  The bits do
        not depend on it.
    progress : whether to draw a progress bar on standard error if the call takes longer than a
        second.

    Returns
    -------
    xarray.Dataset
        For every quantity ``NAME_S1``, ``NAME_S1_conf``, ``NAME_ST``, ``NAME_ST_conf`` over (t,
        input), or over input if the quantity is one number per motion: the indices, dimensionless,
        and the half-widths of their bootstrap intervals of 95 %.  At a t at which some motions do
        not have the quantity, or at which its standard deviation is at most rtol times its largest
        magnitude at all t, it has no indices: its entries are NaN there, and the attribute
        ``refused`` states which quantity, at which t and why, a line each.  A quantity without
        indices at any t is left out.  Estimates may lie slightly outside of [0, 1].  Further
        attributes are those of the run, with ``motions`` their number here, ``asked_base_points``
        (n), ``base_points``, ``resamples``, ``confidence``, and for each way in which motions ended
        the number of these, as "ended: reached the last output time".

    Raises
    ------
    ParameterError
        Correlated inputs or a joint sample, which Sobol indices are not defined for; no uncertain
        input; n out of range, or so many output times that their values would take more than 0.5
        GB; no quantity left; ``threads`` that is no whole number >= 1, ``progress`` that is no
        truth value, inputs that a motion does not allow.
    FileError
        Inputs that a material does not allow.

    Warns
    -----
    ModelWarning
        Of motions beyond the model or the measured bands of the materials
        (:func:`.run_store.warn_of_materials`).

    Notes
    -----
    Variance shares in closed form lie inside the stated intervals
    (``tests/runs/test_sensitivity.py``).  The bootstrap treats the points as random ones, which are
    less even: intervals are rather too wide.

    Examples
    --------
    >>> import viscoroll as vr
    >>> from viscoroll.runs.sensitivity import sobol_indices
    >>> indices = sobol_indices(vr.runs.read_run(vr.datasets.path("run.toml")), n=16, threads=1)
    >>> indices["V_ST"].dims, indices["input"].values.tolist()
    (('t', 'input'), ['mu', 'V0'])
    """
    import xarray as xr

    from .run_records import about

    names = _independent_inputs(run.inputs)
    progress = check_bool("progress", progress)
    # Sobol's sequence is even over powers of two only
    base = 1 << (check_integer("n", n, 16, 1 << 16) - 1).bit_length()
    summaries = tuple(dict.fromkeys(run.settings.summaries))
    run = run._with_settings(n=base * (len(names) + 2), keep="summaries", summaries=summaries)
    settings = run.settings
    warn_of_materials(run)
    cube = _points(len(names), base, settings.seed)
    outcomes, status = _outcomes(run, cube, threads, progress)
    refused = []
    data = {}
    for name, values in outcomes.items():
        over = ("t",) * QUANTITIES[name].over_time
        # differences below it are those of the integrator, not of the inputs
        noise = settings.rtol * np.abs(values).max(where=np.isfinite(values), initial=0.0)
        # a row for each t: motions in the order of _points, base points of A, of B, of each mixture
        indices, reasons = zip(
            *(_indices(row.reshape(-1, base), noise, settings.seed) for row in values)
        )
        times = [f" at t = {t:g}" for t in run.t] if over else [""]
        refused += [f"{name}{time} ({why})" for time, why in zip(times, reasons) if why]
        if not np.isfinite(indices).any():
            continue
        meaning = QUANTITIES[name].about(run.si)["long_name"]
        for (key, text), rows in zip(_INDICES.items(), np.stack(indices, axis=1)):
            attrs = {"long_name": f"{text} of: {meaning}", "units": "1"}
            data[f"{name}_{key}"] = (*over, "input"), rows if over else rows[0], attrs
    if not data:
        found = "; ".join(refused)
        allowed = "quantities that every motion has and that vary, or other times in t"
        sentence = f"no quantity of summaries has Sobol indices: {found}; give {allowed}"
        raise ParameterError("summaries", found, allowed, sentence)
    coordinates = {
        "t": ("t", run.t, column_attributes("t", run.si)),
        "input": ("input", np.array(names, object), {"long_name": "uncertain input"}),
    }
    attrs = about(run) | provenance("Sobol indices of motions of a viscoelastic cylinder")
    del attrs["motions_a_block"], attrs["blocks"]  # those of the run, not of these motions
    ended = zip(*np.unique(status, return_counts=True))
    return xr.Dataset(data, coordinates, attrs).assign_attrs(
        design="Saltelli's, on a scrambled Sobol sequence",
        asked_base_points=n,
        base_points=base,
        resamples=_RESAMPLES,
        confidence=CONFIDENCE,
        refused="\n".join(refused),
        **{f"ended: {MotionStatus(code).message}": int(count) for code, count in ended},
    )


def _independent_inputs(inputs: Inputs) -> Names:
    """Return the names of the uncertain inputs of a run, if Sobol indices are defined for them.

    inputs: :class:`Inputs` of the run.
    Returns the names, distributions before columns, in the order of the rows of the cube.
    Raises ParameterError if there are none, or they are not independent: correlated, or several
    columns of one file.
    """
    if not inputs.uncertain:
        raise described_error(
            "the run file", "has no uncertain input", "one with distributions or columns of files"
        )
    if inputs.correlated:
        raise described_error(
            "[correlation]",
            f"relates the inputs {', '.join(inputs.correlated)}",
            "left out: Sobol indices are defined for independent inputs only",
        )
    for file, columns in inputs.joint.items():
        if len(columns) > 1:
            names = (
                f"[{number.section}] {number.name}"
                for number in inputs_in(inputs.content)
                if number.name in columns
            )
            allowed = "distributions, or columns of different files: Sobol indices are defined for "
            allowed += "independent inputs only"
            raise described_error(", ".join(names), f"are columns of one file, {file}", allowed)
    return inputs.uncertain


def _points(count: int, base: int, seed: int) -> Floats:
    """Return the points of the unit cube at which Saltelli's estimators need the motions.

    A and B are the two halves of the coordinates of one scrambled Sobol sequence of 2 count
    dimensions.

    count: number of inputs, >= 1.
    base: number of points of A and of B, a power of two.
    seed: seed of the sequence, in [0, 2^63).
    Returns an array (count, (count + 2) base), in (0, 1), a row for each input and a column for
    each motion: the points of A, those of B, then for each input n the points of A with row n taken
    from B.
    """
    # halves of the coordinates of one sequence, so that A and B are even together
    A, B = np.split(points("sobol", seed, base, 2 * count, start=0, stop=base, block=0), 2)
    mixed = [np.where(np.arange(count)[:, None] == n, B, A) for n in range(count)]
    return np.hstack([A, B, *mixed])


def _outcomes(
    run: Run, cube: Floats, threads: int | None, progress: bool
) -> tuple[Columns, NDArray[np.int8]]:
    """Roll all motions at points of the unit cube, block by block.

    run: :class:`runs.Run`, whose ``settings.summaries`` name the quantities, each once; inputs, t
    and block are read too.
    cube: points of the unit cube, (input, motion), of :func:`_points`.
    threads: number of threads, on which the motions of one block run; None: ``$VISCOROLL_THREADS``,
        else all cores available.
    progress: whether a progress bar is drawn.
    Raises ParameterError if the values of all motions would take more than 0.5 GB, for a wrong
    ``threads``, and for inputs that a motion does not allow; FileError for inputs that a material
    does not allow.
    Returns (name of a quantity -> values, (t, motion), or (1, motion) of one number per motion, in
    the units of the run, NaN where a motion does not have it; status of each motion, a code of
    :class:`MotionStatus` (0 DONE, 1 RESTED, 2 to 6 stopped before), (motion,), int8).
    """
    motions = run.settings.n
    times = {
        name: run.t.size if QUANTITIES[name].over_time else 1 for name in run.settings.summaries
    }
    numbers = sum(times.values())
    size = 8 * motions * numbers
    if size > _MOST_BYTES:
        each = motions // (len(cube) + 2)
        sentence = (
            f"n = {each} (n is rounded up to a power of two): {motions} motions of {numbers} "
            f"numbers each would take {size / 1e9:.1f} GB, but only {_MOST_BYTES / 1e9:.1f} GB are "
            "allowed: take a smaller n, fewer times in t or fewer summaries"
        )
        raise ParameterError("n", each, "smaller", sentence)
    outcomes = {name: np.empty((count, motions)) for name, count in times.items()}
    status = np.empty(motions, np.int8)

    def work(start: int, stop: int) -> None:
        """Roll the motions ``start`` to ``stop`` - 1 of the cube, and write their values into the
        columns of ``outcomes`` and their codes into ``status``.
        """
        rolled = roll_inputs(run, run.inputs.values(cube[:, start:stop]), stop - start, threads)
        status[start:stop] = rolled.status
        for name, values in outcomes.items():
            for k, row in enumerate(values):
                row[start:stop] = QUANTITIES[name].values(rolled, k)

    # one block at a time, its motions on all threads: a flow map is then made once
    title = "sensitivity" if progress else None
    run_blocks(work, motions, min(_BLOCK, run.block), threads=1, progress=title)
    return outcomes, status


def _indices(values: Floats, noise: float, seed: int) -> tuple[Floats, str]:
    """Estimate the Sobol indices of one quantity at one time, with their bootstrap intervals.

    values: outcomes, (2 + inputs, base points): of the points A, of B, and of A with one input from
    B each.
    noise: standard deviation, in the unit of the quantity, up to which the values count as equal:
    their error by rtol.
    seed: seed of the bootstrap, whose 100 resamples draw base points with replacement.
    Returns (array (4, inputs), dimensionless, whose rows are the first-order indices, the
    half-widths of their 95 % intervals, the total indices and their half-widths; ""), or, where a
    value is not finite or the values are equal, (such an array of NaN; the reason, in words).
    """
    from scipy import special

    found = np.full((len(_INDICES), len(values) - 2), np.nan)
    if missing := np.count_nonzero(~np.isfinite(values)):
        return found, f"no value in {missing} of {values.size} motions"
    if not values.std() > noise:
        return found, "varies by no more than the error of integration, which rtol limits"
    random = np.random.default_rng(seed)
    base = values.shape[1]
    resampled = [_estimated(values[:, random.integers(base, size=base)]) for _ in range(_RESAMPLES)]
    found[0::2] = _estimated(values)
    # rows: S1, its half-width, ST, its half-width; that of a normal distribution is 1.96 deviations
    found[1::2] = special.ndtri(0.5 + 0.5 * CONFIDENCE) * np.std(resampled, axis=0, ddof=1)
    return found, ""


def _estimated(values: Floats) -> Floats:
    """Return the Sobol indices, dimensionless, (2, inputs): first-order indices in row 0, total
    ones in row 1.

    :func:`_indices` calls it for all base points and for each resample.
    With A, B and the mixed outcomes AB_n less the mean of A and B, and the variance v of A and B
    together, they are mean(B (AB_n - A))/v and mean((AB_n - A)^2)/(2 v), the estimators (b) and (f)
    of Table 2 of Saltelli et al. (2010).  scipy.stats.sobol_indices gives the same bits, but up to
    scipy 1.17 it fails for a single input.

    values: outcomes, (2 + inputs, base points), as in :func:`_indices`, finite.  Where those of A
        and B are all equal the indices are NaN or infinite.
    """
    A, B, *mixed = values - values[:2].mean()
    change = np.array(mixed) - A
    indices = np.array([(B * change).mean(axis=1), 0.5 * (change**2).mean(axis=1)])
    return indices / values[:2].var()


def table(indices: Dataset) -> DataFrame:
    """Return a row for each quantity, time and input that has indices, the largest total index
    first at each t.

    indices: dataset of :func:`sobol_indices`.
    Returns a :class:`pandas.DataFrame` with the columns "quantity", "t" with its unit as "t [s]",
    "input", "S1", "S1_conf", "ST", "ST_conf", quantities in the order of ``indices`` and times
    ascending; equal total indices stay in the order of the inputs.  "t" is NaN in the rows of a
    quantity that is one number per motion, and the column is missing if all are.  The labels of the
    rows are numbers that repeat from one quantity to the next.
    Raises ValueError for a dataset without indices.
    """
    import pandas as pd

    tables = []
    for name in names_ending(indices, "_S1"):
        frame = (
            pd.DataFrame({key: indices[f"{name}_{key}"].to_series() for key in _INDICES})
            .dropna()
            .reset_index()
        )
        frame.insert(0, "quantity", name)
        # a quantity of one number per motion has no column t
        keys = {"t": True, "ST": False} if "t" in frame else {"ST": False}
        tables.append(frame.sort_values([*keys], ascending=[*keys.values()], kind="stable"))
    return pd.concat(tables).rename(columns={"t": column_name("t", unit_of(indices["t"].attrs))})
