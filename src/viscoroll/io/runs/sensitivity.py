"""Sobol indices of a run: which uncertain input the spread of its motions comes from.

Estimators are those of A. Saltelli et al., Computer Physics Communications 181 (2010) 259-270, on a scrambled Sobol
sequence; scipy.stats.sobol_indices, which has them too, fails at one input (SciPy 1.17).  A base point costs a motion
for every uncertain input and two more.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from ...core.array_types import Floats
from ...core.blocks import run_blocks
from ...core.checks import check_bool, check_integer
from ...core.errors import MotionStatus, ParameterError
from ...core.results import column_name, unit_of
from ...motion.export import column_attributes, provenance
from ...motion.summaries import QUANTITIES
from ..sampling import points
from .evaluate import look_at_materials, roll_inputs
from .inputs import Inputs, inputs_in
from .runfile import Run

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

CONFIDENCE = 0.95
_RESAMPLES = 100
#: bytes that the outcomes of all motions may take
_BYTES = 1 << 29
#: motions a block: about a second where they are integrated
_BLOCK = 1 << 14
_INDICES = {
    "S1": "first-order Sobol index",
    "S1_conf": f"half-width of the {CONFIDENCE:.0%} confidence interval of the first-order Sobol index",
    "ST": "total Sobol index",
    "ST_conf": f"half-width of the {CONFIDENCE:.0%} confidence interval of the total Sobol index",
}


def sobol_indices(run: Run, n: int = 4096, *, threads: int | None = None, progress: bool = False) -> xr.Dataset:
    """First-order and total Sobol indices of the summarised quantities over all uncertain inputs.

    Parameters
    ----------
    run : see :func:`read_run`; its seed, t, rtol, rest and summaries count, its n, design and quantiles do not.
    n : base points in [16, 65536], rounded up to a power of two.
    threads : default ``$VISCOROLL_THREADS`` or the cores available; the bits do not depend on it.
    progress : draw a progress bar if it takes longer than a second.

    Returns
    -------
    xarray.Dataset
        For every quantity ``NAME_S1``, ``NAME_S1_conf``, ``NAME_ST``, ``NAME_ST_conf`` over (t, input), or over
        input where it is one number a motion: the indices, dimensionless, and the half-widths of
        their bootstrap intervals of 95 %.  A quantity that some motions do not have, or that
        varies by no more than rtol of its largest value at any t, has no indices: the attribute
        ``refused`` says which, at which t and why.  There its entries are NaN, and where it has
        none at any t it is left out.

    Raises
    ------
    ParameterError
        Correlated inputs or a joint sample, which Sobol indices are not defined for; no uncertain
        input; n out of range, or so many output times that their values would take more than 0.5 GB; no
        quantity left.

    Notes
    -----
    Variance shares known in closed form lie inside the stated intervals (``tests/runs/test_sensitivity.py``).
    The bootstrap takes the points for random ones, which are less even: intervals err on the wide side.
    """
    import xarray as xr

    from .store import about

    names = _independent(run.inputs)
    progress = check_bool("progress", progress)
    base = (
        1 << (check_integer("n", n, 16, 1 << 16) - 1).bit_length()
    )  # a Sobol sequence is even only over so many points
    rows = base * (len(names) + 2)
    summaries = tuple(dict.fromkeys(run.settings.summaries))
    settings = msgspec.structs.replace(run.settings, n=rows, keep="summaries", summaries=summaries)
    rolled = replace(run, settings=settings)
    look_at_materials(rolled)
    outcomes, status = _outcomes(rolled, _points(len(names), base, run.settings.seed), threads, progress)
    refused: list[str] = []
    data: dict[str, Any] = {}
    for name, values in outcomes.items():
        over = ("t",) * QUANTITIES[name].over_time
        noise = settings.rtol * np.abs(values, where=np.isfinite(values), out=np.zeros_like(values)).max()
        each = [_indices(one.reshape(-1, base), noise, settings.seed) for one in values]
        times = [f" at t = {t:g}" for t in run.t] if over else [""]
        refused += [f"{name}{at}: {reason}" for at, (_, reason) in zip(times, each, strict=True) if reason]
        found = np.stack([rows for rows, _ in each], axis=1)
        of = QUANTITIES[name].about(run.si)["long_name"]
        for (key, text), one in zip(_INDICES.items(), found if np.isfinite(found).any() else (), strict=False):
            told = {"long_name": f"{text} of: {of}", "units": "1"}
            data[f"{name}_{key}"] = (*over, "input"), one if over else one[0], told
    if not data:
        raise ParameterError("summaries", "; ".join(refused), "quantities that vary and that every motion has")
    coordinates = {
        "t": ("t", run.t, column_attributes("t", run.si)),
        "input": ("input", np.array(names, object), {"long_name": "uncertain input"}),
    }
    described = about(rolled) | provenance("Sobol indices of motions of a viscoelastic cylinder")
    for of_blocks in ("motions_a_block", "blocks"):
        del described[of_blocks]
    ended = zip(*np.unique(status, return_counts=True), strict=True)
    return xr.Dataset(data, coordinates, described).assign_attrs(
        design="Saltelli's, on a scrambled Sobol sequence", asked_base_points=n, base_points=base,
        resamples=_RESAMPLES, confidence=CONFIDENCE, refused="\n".join(refused),
        **{f"ended: {MotionStatus(code).message}": int(count) for code, count in ended},
    )  # fmt: skip


def _independent(inputs: Inputs) -> tuple[str, ...]:
    """Names of the uncertain inputs, each a dimension of its own; raises ParameterError if they are not."""
    if not inputs.uncertain:
        raise ParameterError("run file", "no uncertain input", "one with a distribution")
    if inputs.correlated:
        allowed = "left out: Sobol indices are defined for independent inputs only"
        raise ParameterError("[correlation]", ", ".join(inputs.correlated), allowed)
    places = {at.name: f"[{at.section}] {at.name}" for at in inputs_in(inputs.content)}
    for file, columns in inputs.joint.items():
        if len(columns) > 1:
            allowed = "distributions, or columns of a file each: Sobol indices are defined for independent inputs only"
            raise ParameterError(", ".join(map(places.__getitem__, columns)), f"rows of {file}", allowed)
    return inputs.uncertain


def _points(count: int, base: int, seed: int) -> Floats:
    """Points (input, motion) of the unit cube: base points, as many others, and the first with each of the second."""
    one, other = np.split(points("sobol", seed, base, 2 * count, 0, base, 0), 2)
    mixed = [np.where(np.arange(count)[:, np.newaxis] == n, other, one) for n in range(count)]
    return np.hstack([one, other, *mixed])


def _outcomes(
    run: Run, places: Floats, threads: int | None, progress: bool
) -> tuple[dict[str, Floats], NDArray[np.int8]]:
    """(values of each quantity over (t, motion), how the motions ended): block by block, no motion is kept."""
    rows = places.shape[1]
    times = {name: run.t.size if QUANTITIES[name].over_time else 1 for name in run.settings.summaries}
    size = 8 * rows * sum(times.values())
    if size > _BYTES:
        allowed = f"less, or t shorter: {sum(times.values())} quantities and times would take {size / 1e9:.1f} GB"
        raise ParameterError("n", rows // (len(places) + 2), allowed)
    outcomes = {name: np.empty((count, rows)) for name, count in times.items()}
    status = np.empty(rows, np.int8)

    def work(start: int, stop: int) -> None:
        motions = roll_inputs(run, run.inputs.values(places[:, start:stop]), stop - start, threads)
        status[start:stop] = motions.status
        for name, values in outcomes.items():
            for k, row in enumerate(values):
                row[start:stop] = QUANTITIES[name].values(motions, k)

    # one block at a time, its motions on all threads: a flow map is then made once
    run_blocks(work, rows, min(_BLOCK, run.block), threads=1, progress="sensitivity" if progress else None)
    return outcomes, status


def _indices(values: Floats, noise: float, seed: int) -> tuple[Floats, str]:
    """(The rows of ``_INDICES`` over inputs from outcomes (point, base), ""); or NaN, and why there are none.

    ``noise`` : what rtol leaves open of the largest outcome at any t.
    """
    from scipy.special import ndtri

    found = np.full((len(_INDICES), len(values) - 2), np.nan)
    if missing := np.count_nonzero(~np.isfinite(values)):
        return found, f"{missing} of {values.size} motions have no value"
    if not values.std() > noise:
        return found, "it varies by no more than rtol of its largest value"
    random, base = np.random.default_rng(seed), values.shape[1]
    again = [_estimated(values[:, random.integers(base, size=base)]) for _ in range(_RESAMPLES)]
    found[0::2] = _estimated(values)
    found[1::2] = ndtri(0.5 + 0.5 * CONFIDENCE) * np.std(again, axis=0, ddof=1)
    return found, ""


def _estimated(values: Floats) -> Floats:
    """First-order and total indices of outcomes (point, base)."""
    one, other, *others = values - values[:2].mean()
    mixed = np.array(others)
    return np.array([(other * (mixed - one)).mean(axis=1), 0.5 * ((mixed - one) ** 2).mean(axis=1)]) / values[:2].var()


def table(indices: xr.Dataset) -> pd.DataFrame:
    """A row for each quantity, time and input that has indices, the largest total index first at each t."""
    import pandas as pd

    tables = []
    for name in (str(each).removesuffix("_S1") for each in indices if str(each).endswith("_S1")):
        frame = pd.DataFrame({key: indices[f"{name}_{key}"].to_series() for key in _INDICES}).dropna().reset_index()
        frame.insert(0, "quantity", name)
        over = ["t"] * ("t" in frame)
        tables.append(frame.sort_values([*over, "ST"], ascending=[True] * len(over) + [False], kind="stable"))
    return pd.concat(tables).rename(columns={"t": column_name("t", unit_of(indices["t"].attrs))})
