"""Linear viscoelastic materials as Prony series: :class:`Prony`, one or many, in relaxation and in
creep form.

With moduli divided by the long-time modulus, and times in units of T_ref, which the user chooses,

    E(t) = 1 + sum E_i exp(-a_i t)   a_i = 1/tau_i     alpha = 1 + sum E_i
    J(t) = 1 - sum J_j exp(-b_j t)   b_j = 1/T_j       1/alpha = 1 - sum J_j

with b_1 < a_1 < b_2 < ... < b_N < a_N (:mod:`prony_forms`).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from ..core import (
    ArrayLike,
    Floats,
    Integers,
    NDArray,
    ParameterError,
    broadcast_shape,
    check_array,
    described_error,
    read_only,
    shape_error,
)
from .prony_forms import (
    HIGHEST_ALPHA,
    LARGEST_TIME_RATIO,
    LONGEST_TIME,
    MOST_MODES,
    Modes,
    lock_array,
    modes_of_creep,
    modes_of_relaxation,
)

#: difference of 1/alpha and 1 - sum J by rounding of the strengths, for each mode and one more
_AGREEMENT = 1e-14


class Block(NamedTuple):
    """Those of many materials that have the same number of modes.

    rows : positions of these materials in the list of indices that was given, (materials,).
    modes : :class:`.prony_forms.Modes`, strengths and rates of relaxation and creep, arrays
        (materials, modes).
    weights : for pairs the part of each creep mode that is the half-space's, 0 to 1, (materials,
        modes); None of series.
    """

    rows: Integers
    modes: Modes
    weights: Floats | None = None


class OneOrMany:
    """A material, of shape (), or materials 0 ... n - 1, of shape (n,), by index and iteration.

    Two are equal, and have one hash, if their ``_key`` are equal.
    """

    #: () or (n,)
    shape: tuple[int, ...]
    #: method that returns one of n materials for an index, some for a slice
    __getitem__: Any
    #: names of the attributes that determine the material
    _determined_by: tuple[str, ...]

    @cached_property
    def _key(self) -> tuple[Any, ...]:
        """Values that determine the material, arrays by their shape and bytes."""
        values = (getattr(self, name) for name in self._determined_by)
        return tuple((x.shape, x.tobytes()) if isinstance(x, np.ndarray) else x for x in values)

    def __len__(self) -> int:
        if not self.shape:
            raise TypeError(f"a single {type(self).__name__} has no length and no index")
        return self.shape[0]

    def __bool__(self) -> bool:
        return True

    def __iter__(self) -> Iterator[Any]:
        return (self[i] for i in range(len(self)))

    def __eq__(self, other: object) -> bool:
        return self._key == other._key if isinstance(other, OneOrMany) else NotImplemented

    def __hash__(self) -> int:
        return hash(self._key)


class Prony(OneOrMany):
    """A linear viscoelastic material by its relaxation modulus, a Prony series; or n of them.

    Parameters
    ----------
    E : strengths of the modes divided by the long-time modulus, >= 0, dimensionless; zeros are
        dropped.
    tau : their relaxation times in units of T_ref, > 0; strengths of equal times are added.
        Arrays (n, N), one of which may be (N,), are n materials: ``p[i]`` is one of them,
        ``p[i:k]`` are some.  Where they differ in the number of modes, those of strength 0 stand
        after the others.

    Attributes
    ----------
    shape : (), or (n,).
    alpha : instantaneous divided by long-time modulus, >= 1, a float, or (n,).
    E, tau : strengths and times of relaxation, slowest mode first, (modes,) or (n, modes).
    J, T : strengths and times of creep, likewise; each form is computed from the given one at its
        first use.
    by_creep : whether it was given by its creep compliance.

    Raises
    ------
    ParameterError
        Negative strengths, times that are not positive, more than 64 modes, times outside 1e-140 to
        1e140 or that span more than 32 decades, or a sum of E above 1e12; for any of them.

    Notes
    -----
    Immutable, hashable, equal where modes and ``alpha`` are, and both were given in the same form.
    Values are not rescaled.

    Examples
    --------
    >>> import viscoroll as vr
    >>> vr.Prony(E=[2.0, 6.0], tau=[1.0, 0.1]).alpha
    9.0
    """

    alpha: Any
    by_creep: bool
    _determined_by = "by_creep", "_strengths", "_times", "alpha"

    def __init__(self, E: ArrayLike = (), tau: ArrayLike = ()) -> None:
        """Make one or many materials from their relaxation modulus, divided by its long-time value.

        E: strengths, >= 0, dimensionless, (modes,) or (n, modes); empty (default): elastic.
        tau: relaxation times in units of T_ref, > 0, in the shape of E; one of the two may be
            (modes,) where the other is (n, modes), or one number for all modes.
        Raises ParameterError as the class states, and for shapes that do not fit, also for two
        single numbers.
        """
        strengths, times = _check_modes(E=E, tau=tau)
        alpha = 1.0 + _exact_sums(strengths)
        if (np.asarray(alpha) > HIGHEST_ALPHA).any():
            allowed = f"at most {HIGHEST_ALPHA:g}; give each E divided by the long-time modulus"
            raise ParameterError("sum of E", f"{np.max(alpha) - 1.0:g}", allowed)
        self._set(False, strengths, times, alpha)

    @classmethod
    def creep(cls, J: ArrayLike, T: ArrayLike, *, alpha: Any = None) -> Prony:
        """Make one material, or n of them, from the creep compliance.

        Parameters
        ----------
        J : strengths divided by the long-time compliance, >= 0, of a sum below 1, dimensionless,
            (modes,) or (n, modes).
        T : retardation times in units of T_ref, > 0, in the shape of J; one of the two may be
            (modes,) where the other is (n, modes), or one number for all modes.
        alpha : instantaneous divided by long-time modulus, 1/(1 - sum J), in [1, 1e12]; a number
            or, for arrays (n, modes), (n,). That difference loses digits where the sum is near 1: a
            value given here replaces it, and must agree with it to rounding of J: |1/alpha - (1 -
            sum J)| <= 1e-14 (1 + modes).  None: it is computed.

        Returns
        -------
        Prony
            With these modes of creep; those of relaxation, ``E`` and ``tau``, are computed at their
            first use.

        Raises
        ------
        ParameterError
            As for the class, for shapes that do not fit, and where the sum of J is not below 1,
            1/(1 - sum J) exceeds 1e12, or ``alpha`` does not agree with it.

        Examples
        --------
        >>> import viscoroll as vr
        >>> vr.Prony.creep(J=[0.75], T=[1.0]).alpha
        4.0
        """
        strengths, times = _check_modes(J=J, T=T)
        rest = np.asarray(1.0 - _exact_sums(strengths))
        if not (rest > 0.0).all():
            raise ParameterError(
                "sum of J",
                f"{1.0 - rest.min()!s}",
                "below 1; give each J divided by the long-time compliance (t = infinity)",
            )
        given = (
            1.0 / rest
            if alpha is None
            else check_array("alpha", alpha, low=1.0, high=HIGHEST_ALPHA)
        )
        if given.shape not in ((), rest.shape):
            allowed = "a number" + f", or of shape {rest.shape}, one for each material" * rest.ndim
            raise shape_error("alpha", given.shape, allowed)
        given = np.broadcast_to(given, rest.shape)
        off = np.abs(1.0 / given - rest) > _AGREEMENT * (1.0 + np.count_nonzero(strengths, axis=-1))
        if off.any():
            raise ParameterError(
                "alpha",
                given[off].flat[0],
                f"left out, or 1/(1 - sum of J) = {1.0 / rest[off].flat[0]!s}",
            )
        if (given > HIGHEST_ALPHA).any():
            raise ParameterError(
                "J", strengths.tolist(), f"such that 1/(1 - sum of J) is at most {HIGHEST_ALPHA:g}"
            )
        return cls._make(True, strengths, times, given)

    @classmethod
    def elastic(cls) -> Prony:
        """Make a material without modes: alpha = 1.

        Returns
        -------
        Prony
            One material, with empty ``E``, ``tau``, ``J`` and ``T``.

        Examples
        --------
        >>> import viscoroll as vr
        >>> vr.Prony.elastic().alpha
        1.0
        """
        return cls([], [])

    @classmethod
    def _make(cls, by_creep: bool, strengths: NDArray, times: NDArray, alpha: Any) -> Prony:
        """Return a new :class:`Prony` of checked values; arguments as in :meth:`_set`."""
        series = cls.__new__(cls)
        series._set(by_creep, strengths, times, alpha)
        return series

    def _set(self, by_creep: bool, strengths: NDArray, times: NDArray, alpha: Any) -> None:
        """Set all attributes of a new object to checked values, and make the arrays read-only.

        by_creep: whether the modes are those of creep, else of relaxation.
        strengths, times: modes, longest time first, (modes,) or (n, modes), those without strength
            last; dimensionless, times in units of T_ref.  Contiguous arrays are kept and locked
            themselves, of others a copy.
        alpha: instantaneous divided by long-time modulus, a number, or an array () or (n,), which
            is copied.
        These are ``by_creep``, ``shape``, ``alpha``, ``_strengths`` and ``_times``.
        """
        self.by_creep = by_creep
        self.shape = strengths.shape[:-1]
        self._strengths, self._times = map(lock_array, (strengths, times))
        self.alpha = read_only(np.asarray(alpha))

    def __getitem__(self, which: Any) -> Prony:
        """Return one of n materials for an index, or some for a slice or an array of indices; as a
        new :class:`Prony`.

        which: what numpy accepts along the first axis; of a single material nothing is accepted.
        Returns one material, of shape (), for an integer, without the modes that have no strength;
        else some, (k,), whose arrays keep their number of modes.
        Raises TypeError or IndexError for a single material, IndexError for an index beyond the n
        materials.
        """
        len(self)  # refuses a single material
        strengths = self._strengths[which]
        times = self._times[which]
        alpha = self.alpha[which]
        if strengths.ndim == 1:
            count = np.count_nonzero(strengths)
            strengths = strengths[:count]
            times = times[:count]
        return Prony._make(self.by_creep, strengths, times, alpha)

    def repeated(self, count: int) -> Prony:
        """Return several materials that are equal to this single one.

        Parameters
        ----------
        count : number of materials, an int >= 1.

        Returns
        -------
        Prony
            A new one, of shape (count,), in the same form.

        Examples
        --------
        >>> import viscoroll as vr
        >>> vr.Prony([2.0], [1.0]).repeated(3).alpha
        array([3., 3., 3.])
        """
        return self.slower(np.ones(count))

    @property
    def _convert(self) -> Any:
        """Function that computes both forms from the given one."""
        return modes_of_creep if self.by_creep else modes_of_relaxation

    @cached_property
    def modes(self) -> Modes:
        """Both forms of a single series, and the gaps between their rates, as
        :class:`.prony_forms.Modes` with rates in 1/T_ref.
        """
        return self._convert(self._strengths, self._times, self.alpha)

    def blocks(self, which: Integers) -> Iterator[Block]:
        """Group materials by their number of modes, and yield one block of arrays for each number.

        Only for n materials, not for a single one, which has :attr:`modes`.

        Parameters
        ----------
        which : indices of the materials, (m,), int; empty: nothing is yielded.

        Yields
        ------
        Block
            With ascending numbers of modes, without weights: ``rows``, positions in ``which``,
            ascending, and ``modes``, relaxation and creep form of the series, (rows, modes).
            Elastic materials make a block of 0 modes.

        Raises
        ------
        IndexError
            A single material, an index beyond the n materials.

        Examples
        --------
        >>> import numpy as np
        >>> import viscoroll as vr
        >>> materials = vr.Prony([[2.0, 6.0], [3.0, 0.0]], [1.0, 0.1])
        >>> [
        ...     (block.rows.tolist(), block.modes.E.tolist())
        ...     for block in materials.blocks(np.arange(2))
        ... ]
        [([1], [[3.0]]), ([0], [[2.0, 6.0]])]
        """
        counts = np.count_nonzero(self._strengths[which], axis=-1)
        for count in np.unique(counts).tolist():
            rows = np.flatnonzero(counts == count)
            index = which[rows]
            form = (
                np.ascontiguousarray(values[index, :count])
                for values in (self._strengths, self._times)
            )
            yield Block(rows, self._convert(*form, self.alpha[index]))

    @cached_property
    def _other_form(self) -> tuple[NDArray, NDArray]:
        """Return the modes of the form that was not given: creep if relaxation was given, and the
        reverse.

        Returns read-only arrays (strengths, dimensionless; times in units of T_ref), (modes,) each;
        for many materials (n, modes), with strength 0 and time 1 after the last mode.
        """
        names = ("E", "a") if self.by_creep else ("J", "b")
        if not self.shape:
            strengths, rates = (getattr(self.modes, name) for name in names)
        else:
            # a material with fewer modes than others keeps strength 0 and rate 1 behind its own
            strengths = np.zeros_like(self._strengths)
            rates = np.ones_like(strengths)
            for rows, modes, _ in self.blocks(np.arange(len(self))):
                count = modes.a.shape[-1]
                strengths[rows, :count], rates[rows, :count] = (
                    getattr(modes, name) for name in names
                )
        return lock_array(strengths), lock_array(1.0 / rates)

    def _form(self, by_creep: bool) -> tuple[NDArray, NDArray]:
        """Return strengths and times of creep or, with ``by_creep`` False, of relaxation."""
        return (self._strengths, self._times) if by_creep == self.by_creep else self._other_form

    @property
    def E(self) -> Floats:
        """Strengths of relaxation divided by the long-time modulus, slowest mode first."""
        return self._form(False)[0]

    @property
    def tau(self) -> Floats:
        """Relaxation times in units of T_ref, longest first."""
        return self._form(False)[1]

    @property
    def J(self) -> Floats:
        """Strengths of creep divided by the long-time compliance, slowest mode first."""
        return self._form(True)[0]

    @property
    def T(self) -> Floats:
        """Retardation times in units of T_ref, longest first."""
        return self._form(True)[1]

    @property
    def T_mean(self) -> Any:
        """sum J_j T_j = sum E_i tau_i in units of T_ref, a float or (n,): M = V T_mean at low
        speed; 0 of elastic materials.
        """
        return _exact_sums(self._strengths * self._times)

    @property
    def slow_time(self) -> float:
        """Mean time of slow rolling, (sum E_i tau_i^2 + sum J_j T_j^2)/T_mean, in units of T_ref, a
        float or (n,).

        Rolling is slow, M nearly proportional to V, where kappa V is far below its inverse, with V
        in units of R/T_ref.  It is 1.0 for elastic materials.
        """
        # 1 where nothing relaxes, which makes 0/0 there 1/1
        elastic = self.T_mean == 0.0
        return (_exact_sums(self.E * self.tau**2) + _exact_sums(self.J * self.T**2) + elastic) / (
            self.T_mean + elastic
        )

    def slower(self, factor: ArrayLike) -> Prony:
        """Return the material with all times multiplied by a factor, as for a colder rubber.

        Parameters
        ----------
        factor : dimensionless, > 0, a number, or (n,), one for each of n materials; of a single
            material (n,) makes n.

        Returns
        -------
        Prony
            A new one in the same form, with the same strengths.

        Raises
        ------
        ParameterError
            A factor that is not positive or not finite, or with which a time leaves 1e-140 to
            1e140; several factors of another number than that of several materials, factors of more
            than one axis.

        Examples
        --------
        >>> import viscoroll as vr
        >>> vr.Prony([2.0], [1.0]).slower(10.0).tau
        array([10.])
        """
        factors = check_array("factor", factor, above=0.0)
        broadcast_shape(factor=factors, materials=self)
        times = self._times * factors[..., None]
        if self.by_creep:
            # with alpha, which 1 - sum J would give with fewer digits
            return Prony.creep(self._strengths, times, alpha=self.alpha)
        return Prony(self._strengths, times)

    def in_own_time(self) -> tuple[Prony, float]:
        """Return a single series with its :attr:`slow_time` near 1, and the unit of time that this
        takes.

        Returns
        -------
        series : the :class:`Prony` with times divided by the unit, so that its slow time is within
            a factor of 2^(1/2) of 1; with a unit of 1, as for an elastic series, the series itself.
        unit : the unit in T_ref, a float, a power of two, so that no time is rounded.

        Raises
        ------
        TypeError
            Several materials.

        Examples
        --------
        >>> import viscoroll as vr
        >>> series, unit = vr.Prony([2.0], [8.0]).in_own_time()
        >>> series.tau, unit
        (array([0.25]), 32.0)
        """
        return self._in_own_time

    @cached_property
    def _in_own_time(self) -> tuple[Prony, float]:
        unit = 2.0 ** round(math.log2(self.slow_time))  # 1 without modes
        return (self, 1.0) if unit == 1.0 else (self.slower(1.0 / unit), unit)

    def __repr__(self) -> str:
        """Return the call that makes the series, with numbers to the bit; of many materials their
        number and form.
        """
        if self.shape:
            form = "creep" if self.by_creep else "relaxation"
            return f"<{len(self)} Prony series in {form} form, terms: {self._strengths.shape[-1]}>"
        strengths = self._strengths.tolist()
        times = self._times.tolist()
        if self.by_creep:
            return f"Prony.creep(J={strengths}, T={times}, alpha={self.alpha!r})"
        return f"Prony(E={strengths}, tau={times})"


def _check_modes(**given: ArrayLike) -> tuple[NDArray, NDArray]:
    """Check modes, sort them, and add those of equal times.

    given: by the names that errors state first the strengths, >= 0, then the times, > 0, of the
        modes, (modes,) or (n, modes), or one of them a number; dimensionless, times in units of
        T_ref.  No modes, and no materials, are allowed; not changed.
    Returns (strengths, times) by descending time, (modes,) or (n, modes) with as many modes as the
    material with most has; modes without strength are dropped or, of many materials, put after the
    others, where the times have no meaning.  Modes of equal times are one, with the sum of their
    strengths.
    Raises ParameterError for what :class:`Prony` refuses, except for the sum of the strengths.
    """
    (of_strengths, strengths), (of_times, times) = given.items()
    values = check_array(of_strengths, strengths, low=0.0)
    values = np.minimum(values, 1e300)  # sums stay finite, and are refused
    each = check_array(of_times, times, low=1.0 / LONGEST_TIME, high=LONGEST_TIME)
    if values.ndim == each.ndim == 1 and values.shape != each.shape:
        allowed = f"one time for each {of_strengths}, which has shape {values.shape}"
        raise shape_error(of_times, each.shape, allowed)
    shape = broadcast_shape(**{of_strengths: values, of_times: each})
    if len(shape) not in (1, 2):
        raise described_error(
            f"{of_strengths} and {of_times}",
            f"have shape {shape}",
            "lists, as [2.0] and [0.1], or arrays with axes (materials, terms of the series)",
        )
    values, each = sort_modes(*np.broadcast_arrays(values, each))
    present = values > 0.0
    most = int(present.sum(axis=-1).max(initial=0))
    if most > MOST_MODES:
        raise described_error(
            of_times,
            f"has {most} different times (two bodies, or shear and bulk, count together)",
            f"a list of at most {MOST_MODES}",
        )
    longest = each.max(axis=-1, initial=0.0, where=present)
    shortest = each.min(axis=-1, initial=np.inf, where=present)
    wide = longest > LARGEST_TIME_RATIO * shortest
    if wide.any():
        raise described_error(
            of_times,
            f"ranges from {shortest[wide].flat[0]:g} to {longest[wide].flat[0]:g}",
            f"times within a factor of {LARGEST_TIME_RATIO:g}",
        )
    # modes without strength are last (sort_modes); those that no material has are cut off
    return values[..., :most], each[..., :most]


def series_of_alpha(alpha: float) -> Prony:
    """Return the standard linear solid of the paper, a series of one mode.

    Both forms of the series are known in closed form, so that none is converted to the other:

        creep      J = 1 - 1/alpha    T = 1            rate b = 1
        relaxation E = alpha - 1      tau = 1/alpha    rate a = alpha    gap a - b = alpha - 1

    alpha: instantaneous divided by long-time modulus, >= 1, a float, not checked.
    Returns a :class:`Prony` in creep form, with times in units of T_epsilon; for alpha = 1 it is
    elastic, without a mode.
    """
    c = np.array([(alpha - 1.0) / alpha] if alpha > 1.0 else [])  # no mode of an elastic material
    one = np.ones(c.shape)
    series = Prony._make(True, c, one, alpha)
    # in place of the cached property, which would convert the series
    series.modes = Modes(
        alpha=alpha, a=alpha * one, b=1.0 * one, E=alpha * c, J=c, gap=(alpha * c)[:, None]
    )
    return series


def sort_modes(strengths: NDArray, times: NDArray, *parts: NDArray) -> list[Floats]:
    """Sort modes by descending time, add those of equal times, and put those without strength after
    the others.

    strengths, times: strengths and times of the modes, (..., modes), any unit; not changed.
    parts: parts of the strengths, (..., modes) each, which are sorted and added like them.
    Returns a list of new arrays [strengths, times, *parts], each (..., modes).  Of modes of equal
    times one has the sum of the strengths; the others have strength 0 and stand last.
    """
    order = np.argsort(-times, axis=-1, kind="stable")
    values, each, *rest = (
        np.take_along_axis(given, order, axis=-1) for given in (strengths, times, *parts)
    )
    for n in range(each.shape[-1] - 1):
        # of equal times each passes its strength on to the next, so that the last one has the sum
        equal = each[..., n] == each[..., n + 1]
        for given in (values, *rest):
            given[..., n + 1] += np.where(equal, given[..., n], 0.0)
            given[..., n] *= ~equal
    order = np.argsort(values == 0.0, axis=-1, kind="stable")
    return [np.take_along_axis(given, order, axis=-1) for given in (values, each, *rest)]


def _exact_sums(values: NDArray) -> Any:
    """Return sums over the modes, correctly rounded.

    values: one number for each mode, finite, (modes,) or (n, modes).
    Returns a float, or an array (n,); 0 without modes.
    """
    rows = values.tolist()
    return math.fsum(rows) if values.ndim == 1 else np.array([math.fsum(row) for row in rows])
