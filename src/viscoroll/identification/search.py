"""The search: starts over the ranges, the minima that they lead to, and standard deviations that were not given."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from .problem import Found, Problem
from .unknowns import OF_RECORDS

#: minima so far above the best are not told of: they are no alternatives
ALTERNATIVE = 15.0
#: what chi2 may rise by between two places of one minimum
_RIDGE = 0.5
#: rounds in which standard deviations settle, and to what share
_ROUNDS, _SETTLED = 20, 1e-3
#: median of |normal| over its s.d.
_MEDIAN = 0.6745


def starts(problem: Problem, count: int, seed: int) -> Iterator[NDArray[np.float64]]:
    """The cylinder's own values, then a Latin hypercube over the ranges; what data start, as V0, stays there."""
    from scipy.stats import qmc

    yield problem.start
    free = [i for i, name in enumerate(problem.names) if name.split(":")[0] not in OF_RECORDS]
    if count > 1 and free:
        for point in qmc.LatinHypercube(len(free), rng=np.random.default_rng(seed)).random(count - 1):
            u = problem.start.copy()
            u[free] = problem.low[free] + point * (problem.high - problem.low)[free]
            yield u


def minima(problem: Problem, count: int, seed: int, progress: bool) -> list[Found]:
    """All that the starts lead to and that are parted by a ridge, the best first."""
    from tqdm import tqdm

    bar = tqdm(starts(problem, count, seed), "identify", count, delay=1.0, leave=False, disable=not progress)
    tries = sorted((problem.least(u) for u in bar), key=lambda found: found.chi2)
    kept = tries[:1]
    for one in tries[1:]:
        if one.chi2 - kept[0].chi2 < ALTERNATIVE and not any(_joined(problem, one, other) for other in kept):
            kept.append(one)
    return kept


def _joined(problem: Problem, one: Found, other: Found) -> bool:
    """Whether the straight way between two places passes no ridge."""
    top = max(one.chi2, other.chi2) + _RIDGE
    ways = (one.u + share * (other.u - one.u) for share in (0.5, 0.25, 0.75))
    return all(problem.cost(problem.residuals(u)) < top for u in ways)


def settle(problem: Problem, best: Found) -> Found:
    """Estimate each sigma that was not given from its residuals, and fit again, until both stay."""
    estimated = [one for one in problem.columns if one.estimated]
    for _ in range(_ROUNDS if estimated else 0):
        r, J = problem.residuals(best.u), problem.jacobian(best.u)
        before = problem.sigma.copy()
        share = 1.0 - min(np.linalg.matrix_rank(J) / r.size, 0.9)
        for one in estimated:
            own = r[one.at]
            size = np.median(np.abs(own)) / _MEDIAN if problem.robust else np.sqrt(np.mean(own**2) / share)
            problem.sigma[one.at] *= max(float(size), 1e-12)
        best = problem.least(best.u)
        if np.abs(problem.sigma / before - 1.0).max() < _SETTLED:
            break
    return best
