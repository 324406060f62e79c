"""The search: starts over the ranges, the minima that they lead to, and standard deviations that were not given."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from .problem import Found, Held, Problem
from .unknowns import OF_RECORDS

#: minima so far above the best are not told of: they are no alternatives
_ALTERNATIVE = 15.0
#: tolerance and steps of a search before it is known to be worth more, and the chi2 above the best of one that is not
_ROUGH, _STEPS, _HOPELESS = 1e-4, 60, 60.0
#: what chi2 may rise by between two places of one minimum, and how near they are one place
_RIDGE, _SAME = 0.5, 1e-2
#: rounds in which standard deviations settle, and to what share
_ROUNDS, _SETTLED = 20, 1e-3
#: median of |normal| over its s.d.
_MEDIAN = 0.6745


def minima(problem: Problem, count: int, seed: int, progress: bool) -> list[Found]:
    """All that the starts lead to and that are parted by a ridge, the best first."""
    from tqdm import tqdm

    tries = [_settled(problem, problem.least(problem.start))]
    others = tqdm(_starts(problem, count, seed), "identify", count - 1, delay=1.0, leave=False, disable=not progress)
    tries += [problem.least(u, None, _ROUGH, _STEPS) for u in others]
    tries.sort(key=lambda found: found.chi2)
    near = [problem.least(one.u) for one in tries if one.chi2 < tries[0].chi2 + _HOPELESS]
    best = _settled(problem, min(near, key=lambda found: found.chi2))
    kept = [best]
    for one in sorted((Found(one.u, problem.cost(problem.residuals(one.u))) for one in near), key=lambda one: one.chi2):
        if one.chi2 - best.chi2 < _ALTERNATIVE and not any(_joined(problem, one, other) for other in kept):
            kept.append(one)
    return kept


def _starts(problem: Problem, count: int, seed: int) -> Iterator[NDArray[np.float64]]:
    """A Latin hypercube over the ranges, but one place; what data start, as V0, stays there."""
    from scipy.stats import qmc

    free = [i for i in problem.live if problem.names[i].split(":")[0] not in OF_RECORDS]
    if count > 1 and free:
        for point in qmc.LatinHypercube(len(free), rng=np.random.default_rng(seed)).random(count - 1):
            u = problem.start.copy()
            u[free] = problem.low[free] + point * (problem.high - problem.low)[free]
            yield u


def _joined(problem: Problem, one: Found, other: Found) -> bool:
    """Whether a way leads from one place to the other without a ridge: along what differs most, all else following."""
    apart = other.u - one.u
    which = int(np.argmax(np.abs(apart)))
    if abs(apart[which]) < _SAME:
        return True
    powers = np.zeros(apart.size)
    powers[which] = 1.0
    top = max(one.chi2, other.chi2) + _RIDGE
    ways = (one.u + share * apart for share in (0.5, 0.25, 0.75))
    return all(problem.least(u, Held(powers, float(u[which]), 1.0), _ROUGH, _STEPS).chi2 < top for u in ways)


def _settled(problem: Problem, best: Found) -> Found:
    """Estimate each sigma that was not given from its residuals, and fit again, until both stay."""
    estimated = [one for one in problem.columns if one.estimated]
    for _ in range(_ROUNDS if estimated else 0):
        r, before = problem.residuals(best.u), problem.sigma.copy()
        share = 1.0 - min(len(problem.live) / r.size, 0.9)
        for one in estimated:
            own = r[one.at]
            size = np.median(np.abs(own)) / _MEDIAN if problem.robust else np.sqrt(np.mean(own**2) / share)
            problem.sigma[one.at] *= max(float(size), 1e-12)
        best = problem.least(best.u)
        if np.abs(problem.sigma / before - 1.0).max() < _SETTLED:
            break
    return best
