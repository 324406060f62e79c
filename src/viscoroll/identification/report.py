"""An identification in words: what the residuals say first, then values, then what the data do not tell."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from .motions import Coastdown
from .unknowns import named

#: points of a motion's phase below which it is told
_FEW = 5
_LEVEL = 0.95
#: correlation that is worth a word, and chi2 by which a profile's way must undercut the fit
_CLOSE, _BETTER = 0.9, 0.1


def report(fit: Any) -> str:
    """The report that ``print(fit)`` shows, of a :class:`viscoroll.identification.Identification`."""
    lines = [_heading(fit), *(f"  ! {line}" for line in noise_said(fit))]
    intervals = fit.intervals(_LEVEL)
    width = max(map(len, fit.values))
    for name, value in fit.values.items():
        lines.append(
            f"  {name:<{width}}  {value:<12.6g} +- {fit.stderr[name]:<9.2g} {_LEVEL:.0%}: {_interval(*intervals[name])}"
        )
    return "\n".join([*lines, *(f"  ! {line}" for line in sentences(fit))])


def sentences(fit: Any) -> list[str]:
    """All that the data do not say, and what to beware of, a sentence each."""
    return [*_flat(fit), *_loose(fit), *_sides(fit), *_minima(fit), *_phases(fit), *_close(fit)]


def _heading(fit: Any) -> str:
    from scipy import stats

    problem = fit._problem
    head = f"{len(fit.values)} unknowns, {problem.y.size} points"
    if fit.planned:
        return f"{head}, planned: what to expect if the cylinder is the truth"
    estimated = [str(one) for one in fit.columns if one.estimated]
    if estimated:
        return f"{head}; standard deviation estimated: " + ", ".join(
            f"{name} {fit.sigma[name][0]:.3g}" for name in estimated
        )
    chance = "" if problem.robust or not fit.dof else f" (p = {stats.chi2.sf(fit.chi2, fit.dof):.2g})"
    return f"{head}; chi2 {fit.chi2:.1f} of {fit.dof} degrees of freedom{chance}"


def noise_said(fit: Any) -> Iterator[str]:
    """Residuals that are no noise."""
    for name in fit.misfit:
        noise = fit.noise[name]
        lag = f"lag-1 correlation {noise.lag:.2f}, noise allows {noise.allowed:.2f}"
        yield (
            f"residuals of {name} are no noise ({lag}; rms {noise.rms:.2f} sigma): the model misses something, and "
            "intervals mean nothing"
        )


def _interval(low: float | None, high: float | None) -> str:
    return f"{'open' if low is None else f'{low:.6g}'} to {'open' if high is None else f'{high:.6g}'}"


def _flat(fit: Any) -> Iterator[str]:
    for name in fit.does_not_act:
        yield f"{name} does not act on these data"


def _loose(fit: Any) -> Iterator[str]:
    names = fit.undetermined
    if not names:
        return
    if len(names) == 1:
        yield f"{names[0]} is not determined by these data"
        return
    products = fit.products(_LEVEL)
    only = f"only {' and '.join(map(_product, products))} {'is' if len(products) == 1 else 'are'} determined"
    only += ", near these values" if products and products[0].near else ""
    yield f"{', '.join(names[:-1])} and {names[-1]} cannot be told apart by these data: " + (
        only if products else "no product of their powers is determined"
    )


def _product(one: Any) -> str:
    ordered = sorted(one.powers.items(), key=lambda item: -abs(item[1]))
    text = " ".join(name if p == 1.0 else f"{name}^{p:.3g}" for name, p in ordered)
    low, high = (f"{100.0 * (end - 1.0):+.2g} %" for end in (one.low, one.high))
    return f"{text} = {one.value:.4g} ({_LEVEL:.0%}: {low} to {high})"


def _sides(fit: Any) -> Iterator[str]:
    made: dict[str, list[str]] = {}
    for name in fit.values:
        if name in fit.does_not_act:
            continue
        found = fit.profile(name, _LEVEL)
        for side, end in (("lower", found.low), ("upper", found.high)):
            if end.at is None:
                yield f"{name} is open on its {side} side: chi2 has not risen enough at the end of its range"
            for bound in end.bounds:
                made.setdefault(bound, []).append(f"the {side} end of {name}")
        if found.pieces:
            yield f"the interval of {name} is not in one piece: chi2 rises within it above what its ends have"
        if found.best.chi2 < fit.chi2 - _BETTER:
            listed = _listed(fit._problem.values(found.best.u))
            yield f"a better fit was met, chi2 {found.best.chi2:.1f}, at {listed}: start there, or with more starts"
    for name in fit._problem.at_end(fit._best.u):
        yield f"the best fit has {name} at the end of its range"
    for bound, ends in made.items():
        yield f"the range of {bound}, not the data, makes {', '.join(ends)}"


def _minima(fit: Any) -> Iterator[str]:
    for chi2, values in fit.minima[1:]:
        yield f"another minimum has chi2 {chi2:.1f}, {chi2 - fit.chi2:.1f} above: {_listed(values)}"


def _listed(values: dict[str, float]) -> str:
    return ", ".join(f"{name} = {value:.4g}" for name, value in values.items())


def _phases(fit: Any) -> Iterator[str]:
    """Motions with too few points in a phase."""
    if "mu" not in fit.values:
        return
    for called, record in fit.records.items():
        if not isinstance(record, Coastdown):
            continue
        cylinder = fit._problem.cylinder_of(record, fit.values)
        slips = record.slipping(cylinder, named(fit.values, called))
        if 0 < slips < _FEW:
            yield f"{called} has {slips} points while it slips: mu rests on these; record that phase more densely"


def _close(fit: Any) -> Iterator[str]:
    loose = {*fit.does_not_act, *fit.undetermined}
    names, found = list(fit.values), fit.correlations
    for i, one in enumerate(names):
        for k, other in enumerate(names[:i]):
            if abs(found[i, k]) > _CLOSE and not {one, other} <= loose:
                yield f"{other} and {one} are correlated: {found[i, k]:+.4f}"
