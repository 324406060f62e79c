"""Rise of chi2 about the best fit: intervals by profiles, and products of unknowns that the data
determine.
"""

import math
import operator
from collections.abc import Iterable, Iterator
from functools import cache
from typing import Any, NamedTuple

import numpy as np

from ..core import Floats
from .least_squares import Minimum, Problem

#: longest first step of a coordinate
_FIRST_STEP = 0.25
#: longest step of a coordinate: longer ones land in other minima
_LONGEST_STEP = 0.7
#: relative tolerance of the delta_chi2 at an end
_CLOSE = 3e-3
#: points beyond an end where another branch is sought, as parts of the distance to the bound
_BEYOND = (0.0, 0.15, 0.4, 0.8)
#: most branches beyond an end
_BRANCHES = 3
#: relative tolerance of a minimum along a profile
_TOLERANCE = 1e-5
#: evaluations of a minimum along a profile
_EVALUATIONS = 30
#: ratio of the delta_chi2 at a point to that at an end below which the point is on another branch
_LOWER = 0.98
#: ratio of the delta_chi2 at a point to that at an end above which no search from there leads to
#: another branch
_HOPELESS = 1e3
#: part of the delta_chi2 by which chi2 must fall beyond a bound for the bound to limit the interval
_LIMITS = 0.02
#: distance of coordinates up to which two points are one
_SAME = 1e-6
#: width of an interval of a coordinate from which on an unknown is undetermined: a factor of e^2
_WIDE = 2.0
#: correlation with an undetermined unknown from which on another is undetermined too
_TOGETHER = 0.95
#: largest width of the interval of a product that is determined: a factor of e
_NARROW = 1.0
#: parts of 1 to which exponents are rounded, the coarsest first
_PARTS = (1, 2, 10, 100)
#: factor by which rounding of exponents may widen the range of a product over all points that fit
_ROUNDING = 2.0
#: ratio of the width of a product near the best values to the least width over whole intervals
#: below which the report has it
_SHARPER = 1.0 / 3.0


class Profile(NamedTuple):
    """The confidence interval of a combination of coordinates, sum(powers u), by a profile of chi2.

    ends : [lower, upper end] of the combination itself, not of its distance from the best;
        dimensionless.  None on a side that is open: chi2 stays below the bound up to the end of the
        ranges.
    limited_by : two lists, one for each end, of the names of unknowns whose range, not the data,
        limits that end; [] of an open side, and where the data alone limit it.
    pieces : whether another branch continued the interval, inside which chi2 may exceed the bound.
    best : :class:`.least_squares.Minimum`, the point with the least chi2 that was met, perhaps
    below that of the best fit.
    within : coordinates of all points met whose chi2 is less than the bound above that of the best
        fit, shape (k, unknowns), k >= 1, since the best fit is one of them.
    """

    ends: list[float | None]
    limited_by: list[list[str]]
    pieces: bool
    best: Minimum
    within: Floats


class Product(NamedTuple):
    """A product of powers of unknowns that the data determine where they cannot tell these apart.

    Attributes
    ----------
    powers : name of unknown -> exponent, of the unknowns whose power of the coordinate is not 0.
        Exponents of unknowns with a linear coordinate (brake, drag, nu, V0, omega0 and t0) hold
        near the values found only; such an exponent is 0 where the best value is 0.
    value : value of the product at the best fit, of the magnitudes of SI values, as V0 may be
        negative.
    low, high : ends of its interval, divided by ``value``, dimensionless: low <= 1 <= high.
    near : True: the interval is by the slopes at the best fit, and the product holds within about a
        fifth of the values found; farther off other exponents hold.  False: the interval is a
        profile.
    limited_by : two lists, for the lower and the upper end, of the names of unknowns whose range,
        not the data, limits that end; [] where the data alone do, and where ``near`` is True.
    """

    powers: dict[str, float]
    value: float
    low: float
    high: float
    near: bool
    limited_by: list[list[str]]


class Likelihood:
    """chi2 about the best of the minima: covariance, intervals, and products of unknowns.

    Coordinates are those of :class:`.unknowns.Unknown`, dimensionless: logarithms of values, or
    values in a unit.

    problem : :class:`.least_squares.Problem`, the least squares.
    best : :class:`.least_squares.Minimum`, the best minimum.
    cov : covariance of the coordinates by the slopes there, limited by the ranges, shape (unknowns,
        unknowns); where residuals are autocorrelated that of the effective number of points.
    points : effective number of points: fewer than there are where residuals are autocorrelated.
    sd : standard deviations of the coordinates, shape (unknowns,); of an unknown that does not act
        nearly that of a uniform distribution over its range.
    correlations : correlations of the coordinates, shape (unknowns, unknowns), 1 on the diagonal.
    others : coordinates of other minima and of the start of the fit, (unknowns,) each, from which
        other branches of the fit are searched; those within 1e-6 of the best are left out.
    ends : coordinates of points at the ends of all intervals, (unknowns,) each, further starts of
        that search; empty until :meth:`unknown_profiles` meets an open interval.
    minimize : a function of coordinates and powers, as bytes of float64 arrays, that returns the
        :class:`.least_squares.Minimum` from there with the combination of these powers fixed, and
        keeps it, as profiles that are computed again with further starts begin with the same
        searches.
    """

    def __init__(self, problem: Problem, found: list[Minimum]) -> None:
        """Compute the covariance at the best minimum.

        To the inverse covariance of the data, J^T J of the weighted slopes, the inverse variance
        12/(high - low)^2 of a uniform distribution over the range of each coordinate is added: it
        bounds the standard deviation of what the data leave open.  Where the residuals of a column
        are autocorrelated, :attr:`.least_squares.Noise.repeats` of its points count as one: ``cov``
        is then that of the same estimate with so much larger variances.

        problem : :class:`Problem`, the least squares.
        found : list of :class:`Minimum`, the best first, at least one.
        """
        self.problem = problem
        self.best = found[0]
        u = self.best.u
        _, J = problem.weighted(u)
        noise = problem.noise(u)
        repeats = np.ones(problem.points)
        for column in problem.columns:
            repeats[column.at] = noise[str(column)].repeats
        self.points = float((1.0 / repeats).sum())
        within = np.diag(12.0 / (problem.high - problem.low) ** 2)
        self._cov = np.linalg.inv(J.T @ J + within)
        # the estimate has the weights of _cov, while the variance of each point is larger by its
        # repeats: the covariance of a linear estimate with other weights than the best ones
        self.cov = self._cov @ ((J.T * repeats) @ J + within) @ self._cov
        self.sd = np.sqrt(np.diag(self.cov))
        self.correlations = self.cov / np.outer(self.sd, self.sd)
        self.others = [
            v
            for v in (*(minimum.u for minimum in found[1:]), problem.start)
            if np.abs(v - u).max() > _SAME
        ]
        self.ends: list[Floats] = []
        # a row of it: the combination of one coordinate alone
        self._unit = np.eye(u.size)
        self._profiles = cache(
            lambda delta_chi2, *powers: ProfileWalk(self, np.array(powers), delta_chi2).profile()
        )
        # coordinates and powers are given as bytes, which a cache can compare
        self.minimize = cache(
            lambda u, powers: problem.minimize(
                np.frombuffer(u), np.frombuffer(powers), _TOLERANCE, _EVALUATIONS
            )
        )

    def profile(self, powers: Floats, delta_chi2: float) -> Profile:
        """Return the interval of a combination of coordinates within which chi2 rises by no more
        than a bound.

        The combination is the sum of the coordinates, each times its power.  As most coordinates
        are logarithms of unknowns, it is the logarithm of a product of powers.  chi2 at a value of
        the combination is its minimum over everything else.  The range in which chi2 is below the
        bound may consist of several pieces, so that an end of the first piece need not be the end
        of the interval: :meth:`ProfileWalk.profile` therefore searches beyond it, from ``others``
        and ``ends``.  A result is kept for the next call with the same arguments, until ``ends``
        changes.

        powers : powers of the coordinates, shape (unknowns,), at least one of them not 0; those of
            unknowns that do not act are 0.
        delta_chi2 : the bound: chi2 at an end of the interval minus chi2 of the best minimum,
            dimensionless, > 0; where residuals are autocorrelated it is multiplied by the rise of
            the variance of the combination.
        Returns the :class:`Profile`.
        """
        rise = float((powers @ self.cov @ powers) / (powers @ self._cov @ powers))
        return self._profiles(delta_chi2 * rise, *powers.tolist())

    def unknown_profiles(self, delta_chi2: float) -> dict[int, Profile]:
        """Return the profile of each active unknown by itself.

        The first time that any side of any interval is open, the two outermost points of each
        interval are added to ``ends``: of ``Profile.within`` those with the smallest and the
        largest coordinate of the unknown.  Then all profiles are computed again with these further
        starts; later calls, also with another bound, do not repeat this.

        delta_chi2 : bound of the rise of chi2 above that of the best minimum, dimensionless, > 0.
        Returns a dict, index of the unknown -> :class:`Profile`, whose ends are values of the
        coordinate of this unknown, in ascending order of the indices; unknowns that do not act are
        not in it, so that it is {} where none acts.
        """
        profiles = {i: self.profile(self._unit[i], delta_chi2) for i in self.problem.active}
        # None: open
        if self.ends or not any(None in profile.ends for profile in profiles.values()):
            return profiles
        for i, profile in profiles.items():
            along = profile.within[:, i]
            self.ends.extend(profile.within[[along.argmin(), along.argmax()]])
        self._profiles.cache_clear()  # they were made without the starts in ends
        return self.unknown_profiles(delta_chi2)

    def undetermined(self, delta_chi2: float) -> list[int]:
        """Return the indices of unknowns with a wide interval, and of those correlated with them.

        An interval of a coordinate is wide if it is longer than 2 (a factor of e^2 of a value whose
        coordinate is a logarithm) or than half of the range; an open side counts up to the end of
        the range.  Two unknowns are correlated if the absolute value of their correlation is above
        0.95.

        delta_chi2 : bound of the rise of chi2 above that of the best minimum, dimensionless, > 0.
        Returns a list of indices, ascending, without unknowns that do not act; [] where no interval
        is wide.
        """
        wide = []
        for i, profile in self.unknown_profiles(delta_chi2).items():
            bounds = self.problem.low[i], self.problem.high[i]
            # an open side reaches to the end of the range
            low, high = (bound if end is None else end for end, bound in zip(profile.ends, bounds))
            if high - low > min(_WIDE, 0.5 * (bounds[1] - bounds[0])):
                wide.append(i)
        # the wide ones themselves too, whose correlation with themselves is 1
        return [
            i for i in self.problem.active if (np.abs(self.correlations[i, wide]) > _TOGETHER).any()
        ]

    def products(self, which: list[int], delta_chi2: float) -> list[Product]:
        """Return the products of powers of undetermined unknowns that the data determine.

        A product is determined if its interval has two ends whose ratio is at most e.  Combinations
        are tried from the best determined one on, up to the first that is not determined.  Their
        exponents are those along which the points with chi2 below the bound (of all searches)
        differ least, or, if those give no product, those of the slopes at the best fit; the
        intervals are profiles of chi2.  Then products are added whose exponents and intervals both
        follow from the slopes: they hold near the best fit alone.  Of these only such are kept
        whose relative interval, ``high - low``, is below a third of the narrowest one found before
        (all, if none was found).

        which : indices of the undetermined unknowns, ascending, as in :meth:`undetermined`.
        delta_chi2 : bound of the rise of chi2 above that of the best minimum, dimensionless, > 0.
        Returns a list of :class:`Product`, those with ``near`` False first, each part in the order
        in which the combinations are tried; [] for fewer than two unknowns, or where no product is
        determined.
        """
        if len(which) < 2:
            return []
        # the principal axes of the covariance, rounded to 0.01, that of the least variance first
        by_slopes = [
            np.round(v / v[np.abs(v).argmax()], 2) @ self._unit[which]
            for v in np.linalg.eigh(self.cov[np.ix_(which, which)])[1].T
        ]
        found = self._bounded_products(
            self._combinations_by_points(which, delta_chi2), delta_chi2
        ) or self._bounded_products(by_slopes, delta_chi2)
        least = min((product.high - product.low for product in found), default=math.inf)
        return found + [
            product
            for product in self._bounded_products(by_slopes, delta_chi2, near=True)
            if product.high - product.low < _SHARPER * least
        ]

    def _bounded_products(
        self, family: Iterable[Floats], delta_chi2: float, near: bool = False
    ) -> list[Product]:
        """Return the products of a family whose intervals are narrow, up to the first product with
        an open or wide interval.

        family : powers of the coordinates of each product, shape (unknowns,) each, the best
            determined first; those of unknowns that do not act are 0.
        delta_chi2 : bound of the rise of chi2 above that of the best minimum, dimensionless, > 0.
        near : True: an interval is the best value -+ sqrt(delta_chi2) standard deviations by the
            slopes at the best fit; False: it is a profile.  The products get the same ``near``.
        Returns a list of :class:`Product`, in the order of the family, whose intervals are closed
        and at most 1 long in the combination of coordinates, a factor of e of the product; [] where
        that of the first is open or longer.  An exponent is the power divided by d ln(value)/du at
        the best fit; 0 where the value is 0.
        """
        found = []
        values = self.problem.values(self.best.u)
        for powers in family:
            half = math.sqrt(delta_chi2 * (powers @ self.cov @ powers))
            centre = powers @ self.best.u
            interval: Any = (
                ([centre - half, centre + half], [[], []])
                if near
                else self.profile(powers, delta_chi2)
            )
            (low, high), limits, *_ = interval
            if None in (low, high) or high - low > _NARROW:  # None: open
                break
            exponents = {
                unknown.name: p * (value / unknown.slope(value))
                for unknown, value, p in zip(
                    self.problem.unknowns, values.values(), powers.tolist()
                )
                if p
            }
            # low and high are factors of this value: the combination is ln(product) but for a
            # constant, to first order where a coordinate is no logarithm
            value = math.prod(abs(values[name]) ** p for name, p in exponents.items())
            found.append(
                Product(
                    powers=exponents,
                    value=value,
                    low=math.exp(low - centre),
                    high=math.exp(high - centre),
                    near=near,
                    limited_by=limits,
                )
            )
        return found

    def _combinations_by_points(self, which: list[int], delta_chi2: float) -> Iterator[Floats]:
        """Yield combinations of unknowns on which the points that fit agree best, by their
        principal axes.

        The points are those of ``Profile.within`` of the profiles of the unknowns ``which``.

        A simple exponent is easier to read than an exact one: powers are rounded to whole numbers,
        halves, tenths or hundredths, the coarsest with which the range (largest minus smallest
        value) of the combination over the points is at most twice that of the exact powers, or to
        hundredths where it is so with none.

        which : indices of the unknowns among all, ascending.
        delta_chi2 : bound of the rise of chi2 within which points fit, dimensionless, > 0.
        Yields as many combinations as ``which`` has indices, the best determined first: powers of
        the coordinates, shape (unknowns,), that of largest absolute value 1, and those of unknowns
        outside of ``which`` 0.
        """
        profiles = self.unknown_profiles(delta_chi2)
        within = np.concatenate([profiles[i].within for i in which])[:, which]
        # rows from the least singular value on: along these the points differ least
        for v in np.linalg.svd(within - within.mean(axis=0))[2][::-1]:
            exact = v / v[np.abs(v).argmax()]
            rounded = (np.round(exact * parts) / parts for parts in _PARTS)
            width = _ROUNDING * np.ptp(within @ exact)
            powers = next((p for p in rounded if np.ptp(within @ p) <= width), np.round(exact, 2))
            yield powers @ self._unit[which]


class ProfileWalk:
    """A profile of chi2: minima with a combination of coordinates fixed, each from the one before.

    The combination at a point u is sum(powers u); its distance is this minus the same at the best
    minimum, signed.  Coordinates, combination and distance are dimensionless.

    likelihood, problem, best : :class:`Likelihood`, chi2 about the best minimum;
        :class:`.least_squares.Problem`, the least squares; :class:`.least_squares.Minimum`, the
        best minimum.
    powers : powers of the combination, shape (unknowns,), not all 0; 0 of unknowns that do not act.
    delta_chi2 : bound of the rise of chi2 above that of the best minimum, dimensionless, > 0.
    sd : standard deviation of the combination by slopes, sqrt(powers cov powers) with the
    covariance of ``likelihood``.
    slope : change of the coordinates with the combination, (cov powers)/sd^2, shape (unknowns,).
    visited : list of :class:`.least_squares.Minimum`, all minima that were found, the best one
    first.
    """

    def __init__(self, likelihood: Likelihood, powers: Floats, delta_chi2: float) -> None:
        """Begin at the best minimum.  Nothing is minimised yet; :meth:`profile` does that.

        likelihood, powers, delta_chi2 : as of the class, whose attributes are all set; ``visited``
            holds the best minimum alone.
        """
        self.likelihood = likelihood
        self.problem = likelihood.problem
        self.best = likelihood.best
        self.powers = powers
        self.delta_chi2 = delta_chi2
        along = likelihood.cov @ powers
        variance = powers @ along
        self.sd = math.sqrt(variance)
        self.slope = along / variance
        self.visited = [self.best]

    def distance(self, u: Floats) -> float:
        """Return the combination at a point minus that at the best minimum, signed.

        u : coordinates of the point, (unknowns,).
        """
        return float(self.powers @ (u - self.best.u))

    def shift_to(self, d: float, u: Floats) -> Floats:
        """Return u + slope (d - distance(u)), a point whose combination has the distance d.

        Of all points at that distance it is nearest to u in the metric of the inverse covariance,
        by which chi2 rises about the best minimum.

        d : the wanted :meth:`distance` of the combination from that at the best minimum, signed,
            dimensionless.
        u : coordinates of a point, (unknowns,), dimensionless.
        Returns its coordinates, (unknowns,), perhaps outside of the ranges of the unknowns.
        """
        return u + self.slope * (d - self.distance(u))

    def minimum_at(self, d: float, u: Floats) -> Minimum:
        """Return the minimum of chi2 with the combination fixed, and add it to ``visited``.

        d : distance of the combination from that at the best minimum, signed.
        u : coordinates of the start, (unknowns,); they are moved to that distance first.
        Returns the :class:`.least_squares.Minimum`, within the ranges, to a relative tolerance of
        1e-5, or the best point that 30 evaluations found; its distance may differ from d where the
        ranges do not allow d.
        """
        # bytes: keys of the cache
        minimum = self.likelihood.minimize(self.shift_to(d, u).tobytes(), self.powers.tobytes())
        self.visited.append(minimum)
        return minimum

    def is_below(self, chi2: float, part: float) -> bool:
        """Return whether the rise of chi2 from the best minimum to another point is below part *
        ``delta_chi2``.

        chi2 : that of the other point.
        part : factor of the bound, dimensionless, > 0.
        """
        return chi2 - self.best.chi2 < part * self.delta_chi2

    def profile(self) -> Profile:
        """Find both ends of the interval, by minima of chi2 with the combination fixed.

        On each side the search goes on beyond the end where another branch of the fit continues the
        interval, at most three times: after three branches no further one is sought.  The end is
        then that of the last branch.  All minima that are found are appended to ``visited``.

        Returns the :class:`Profile`, which describes the fields.  A side on which chi2 stays below
        the bound up to the end of the ranges has the end None, also where the best fit is at that
        end; ``within`` has the points in the order in which they were found, the best fit first.
        """
        problem = self.problem
        ends = []
        limits = []
        pieces = False
        for near, far in ((problem.low, problem.high), (problem.high, problem.low)):
            # the corner of the ranges at which the combination is least, then largest
            reach = self.distance(np.where(self.powers > 0.0, near, far))
            d, last = self.find_end(reach, self.best)
            for _ in range(_BRANCHES):
                if d is None or not (lower := self.search_beyond(d, reach)):
                    break
                pieces = True
                d, last = self.find_end(reach, lower[-1])
            ends.append(None if d is None else float(self.powers @ self.best.u) + d)
            limits.append([] if d is None else self.limiting_bounds(last.u))
        within = np.array([each.u for each in self.visited if self.is_below(each.chi2, 1.0)])
        return Profile(
            ends=ends,
            limited_by=limits,
            pieces=pieces,
            best=min(self.visited, key=operator.attrgetter("chi2")),
            within=within,
        )

    def find_end(self, reach: float, start: Minimum) -> tuple[float | None, Minimum]:
        """Find the distance of the combination at which chi2 has risen to the bound.

        The search goes from the start in steps until chi2 is above the bound, then by Brent's
        method; the root of the rise of chi2 meets that of the bound to about 0.3 %.  All minima on
        the way are added to ``visited``.

        reach : distance of the end of the ranges from the best minimum, signed: the search goes
        towards it.
        start : :class:`Minimum`, a minimum at which the root of the rise of chi2 is more than 0.3 %
            below that of the bound, which is not checked.
        Returns (the signed distance, or None if chi2 is still below the bound at ``reach``; of the
        minima found the :class:`Minimum` nearest to that distance, or that at ``reach``).
        """
        from scipy import optimize

        goal = math.sqrt(self.delta_chi2)
        d = self.distance(start.u)
        step = min(goal * self.sd, _FIRST_STEP)
        found = {d: start}

        def excess(d: float) -> float:
            """Return the root of the rise of chi2 at the distance d minus the root of the bound,
            dimensionless; near the best it is proportional to the distance.

            A minimum that is not in ``found`` yet is computed and added to ``found``; its search
            starts on the line through the two nearest ones, or from the only one.  A rise below 0
            counts as 0; the result is 0.0 where the two roots are equal to 0.3 %.

            d : signed distance of the combination from that at the best minimum.
            """
            if d not in found:
                b, *more = sorted(found, key=lambda b: abs(d - b))
                u = found[b].u
                found[d] = self.minimum_at(
                    d, u + (u - found[more[0]].u) * ((d - b) / (b - more[0])) if more else u
                )
            f = math.sqrt(max(found[d].chi2 - self.best.chi2, 0.0)) - goal
            return 0.0 if abs(f) < _CLOSE * goal else f

        f = excess(d)
        while f < 0.0:
            if abs(reach - d) < 1e-9:
                return None, found[d]
            a = d
            fa = f
            d = a + math.copysign(min(step, abs(reach - a)), reach)
            f = excess(d)
            # the next step goes 5 % beyond the zero of the line through both points, but is at most
            # three times and at least 0.3 times this one
            rise = max(f - fa, -0.35 * f)
            step = min(max(-1.05 * f / rise, 0.3) * step, _LONGEST_STEP)
        end = optimize.brentq(excess, a, d, xtol=_CLOSE * min(self.sd, 1.0))
        return end, found[min(found, key=lambda d: abs(d - end))]

    def search_beyond(self, d: float, reach: float) -> list[Minimum]:
        """Search other minima of chi2 that continue the interval between one of its ends and the
        end of the ranges.

        Starts are the points of ``likelihood.others``, moved to the end of the interval and to 15,
        40 and 80 % of the way from there to the end of the ranges, and those of
        ``likelihood.ends``, moved to the end of the interval; each point that lies beyond the end
        of the interval is also a start as it is.  Starts at which chi2 is 1000 bounds or more above
        the best are left out.  All minima found are added to ``visited``.

        d : signed distance of the combination at the end of the interval from that at the best
        minimum.
        reach : the same at the end of the ranges.
        Returns a list of :class:`Minimum` whose rise of chi2 is below 0.98 of the bound, in
        ascending order of the absolute distance of the combination, so that the farthest from the
        best is last; [] if there is none.
        """
        found = []
        problem = self.problem
        starts = [(u, _BEYOND) for u in self.likelihood.others] + [
            (u, _BEYOND[:1]) for u in self.likelihood.ends
        ]
        for u, parts in starts:
            # own too, if it lies beyond d, on the side of reach
            own = self.distance(u)
            for target in [d + part * (reach - d) for part in parts] + [own] * (
                (own - d) * (reach - d) > 0.0
            ):
                cost = problem.cost(np.clip(self.shift_to(target, u), problem.low, problem.high))
                if self.is_below(cost, _HOPELESS):
                    found.append(self.minimum_at(target, u))
        lower = (minimum for minimum in found if self.is_below(minimum.chi2, _LOWER))
        return sorted(lower, key=lambda minimum: abs(self.distance(minimum.u)))

    def limiting_bounds(self, u: Floats) -> list[str]:
        """Return the names of unknowns at a bound beyond which chi2 would fall, with the
        combination fixed.

        Such a bound, not the data, limits the interval.  The unknown of a combination of one is
        left out.

        u : coordinates at the end of an interval, (unknowns,).
        Returns a list of names, ascending by index, of those unknowns without whose bound chi2
        would fall by more than 2 % of ``delta_chi2``, by the slopes at u.  Each is tried by itself:
        the unknowns that act and lie at no bound are free, but for one of the combination, which
        follows from the others.  [] where no such unknown lies at a bound, or none limits the
        interval.
        """
        problem = self.problem
        together = np.flatnonzero(self.powers)
        bounds = problem.at_bounds(u)
        follows = next((i for i in together if i not in bounds), together[0])
        if not (at := [i for i in bounds if i in problem.active and i != follows]):
            return []
        r, J = problem.weighted(u)
        others = [i for i in problem.active if i not in (*at, follows)]
        # slopes while the combination stays: ``follows`` changes by -powers/powers[follows]; then
        # the part of the slope of each bound that the free unknowns cannot make, along which chi2
        # falls by the square of the residuals' component
        J = J - np.outer(J[:, follows], self.powers / self.powers[follows])
        own = J[:, at] - J[:, others] @ np.linalg.lstsq(J[:, others], J[:, at], rcond=None)[0]
        gains = (r @ own) ** 2 / np.maximum((own**2).sum(axis=0), 1e-300)
        return [problem.names[i] for i, gain in zip(at, gains) if gain > _LIMITS * self.delta_chi2]
