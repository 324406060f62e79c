"""The contact law of one scene as a function for integrators: :func:`bound_law`.

Numbers of equations are those of A. A. Zobova and I. G. Goryacheva, Acta Mechanica (2020),
doi:10.1007/s00707-020-02643-5.
"""

from __future__ import annotations

import ctypes
import math
from collections.abc import Callable
from functools import partial
from typing import Any, Literal, overload

import numpy as np

from ..core import Floats, Numbers, ParameterError, check_array, check_bool
from ..kernels.records import Loads, LoadsAndSlopes
from ..laws import LawGrid
from .contact import contact
from .contact_table import refuse_overflow
from .model_warnings import warn_of_contact
from .parameters import Roller, refuse_arrays, resolve_model

#: Types that the compiled function takes; others go through :func:`contact`.
_NUMBERS = frozenset({float, int, np.float64})
#: (lowest, highest) |V| between which nothing is warned of, where nothing is known of the bodies.
_EVERY_SPEED = 0.0, math.inf
#: Makes :class:`Loads` from four numbers, faster than its constructor.
_loads = partial(tuple.__new__, Loads)
#: Makes :class:`LoadsAndSlopes` from eight numbers.
_loads_and_slopes = partial(tuple.__new__, LoadsAndSlopes)


class Law:
    """The law of a scene or a cylinder as a function of V and omega: the result of
    :func:`bound_law`.

    Attributes
    ----------
    roller : the scene or cylinder, of the law of a grid that grid.
    scene : its dimensionless parameters; the law of a grid has none.

    Examples
    --------
    >>> import viscoroll as vr
    >>> law = vr.law(vr.presets.RUBBER_CYLINDER)
    >>> loads = law(1.0, 10.2)  # m/s, rad/s
    >>> loads.Q > 0.0 and loads.M == loads.M_half_space + loads.M_cylinder
    True
    >>> law(1.0, 10.2, slopes=True).dQ_domega >= 0.0
    True
    """

    def __init__(self, roller: Roller) -> None:
        """Check that ``roller`` is one scene or cylinder of one material, and compile its law.

        roller: a scene or a cylinder whose alpha or material, kappa and mu are single; gamma and j
        are not used.
        Raises ParameterError for what is neither, for arrays in alpha, kappa or mu (also of shape
        (1,)), for an array of materials, for times of a material beyond 1e-100 to 1e100 T_ref, and
        for a layer too thin for its law.  Sets ``roller``, ``scene``, ``_kappa`` (kappa over the
        unit of V), ``_covered``,
        and the attributes of :meth:`_use`.
        """
        from ..kernels.law.law_callables import Jitted, pack_scenes

        _, scene, scale = resolve_model(roller, "law")
        refuse_arrays(
            roller, scene, ("alpha", "kappa", "mu"), "one number: a law belongs to one scene"
        )
        table = scene.rolling_law
        assert table is not None
        self.roller = roller
        self.scene = scene
        self._kappa = np.asarray(scene.kappa / scale["V"])
        #: (lowest, highest) |V| between which nothing is warned of, in the unit of V
        self._covered = (roller.body_data and roller.body_data.covered_speeds) or _EVERY_SPEED
        if table.coupled is not None:
            from ..kernels.law.spline_law import jitted_table

            self._use(jitted_table(table.record.table, table, scene.kappa, scene.mu, scale))
            return
        scenes = pack_scenes(table.record, table.unlike, scene.kappa, scene.mu, scale)
        self._use(Jitted(scenes, table))

    def _use(self, jitted: Any) -> None:
        """Keep the compiled law for calls, as attributes of this object; for the constructors of a
        scene and of a grid.

        jitted: the :class:`.Jitted` law, of a scene or a grid, which has the C function
            (``function``) and the addresses of its user data for results without slopes (``plain``)
            and with slopes (``address``).
        Sets ``_jitted`` (the law), ``_function``, ``_plain`` and ``_sloped`` (these three), and
        ``_output``, the type of the buffer of eight doubles for the results.  Returns None.
        """
        from ..kernels.law.law_callables import ResultBuffer

        self._jitted = jitted
        self._output = ResultBuffer
        self._function = jitted.function
        self._plain = jitted.plain
        self._sloped = jitted.address

    @overload
    def __call__(  # type: ignore[overload-overlap]
        self, V: float, omega: float, *, slopes: Literal[False] = False
    ) -> Loads[float]: ...
    @overload
    def __call__(  # type: ignore[overload-overlap]
        self, V: float, omega: float, *, slopes: Literal[True]
    ) -> LoadsAndSlopes[float]: ...
    @overload
    def __call__(
        self, V: Numbers, omega: Numbers, *, slopes: Literal[False] = False
    ) -> Loads[Floats]: ...
    @overload
    def __call__(
        self, V: Numbers, omega: Numbers, *, slopes: Literal[True]
    ) -> LoadsAndSlopes[Floats]: ...
    def __call__(self, V: Any, omega: Any, *, slopes: bool = False) -> Any:
        """Compute friction force Q and rolling moment M of the cylinder on its base at speed V and
        spin omega.

        These are Eqs. (15)-(18) of Zobova and Goryacheva (2020).

        Parameters
        ----------
        V : velocity of the axis, any sign, a number or an array; of a Cylinder in m/s, of a Scene
            divided by R/T_ref, where T_ref is its unit of time (T_epsilon where alpha is given).
        omega : angular velocity, any sign, broadcasts with V; of a Cylinder in rad/s, of a Scene
            multiplied by T_ref.  At V = 0 a value other than 0 means full slip; 0 is the limit V ->
            0+ with the creepage 0.
        slopes : whether the derivatives are computed too.

        Returns
        -------
        Loads or LoadsAndSlopes
            Named tuple of Q, M, M_half_space and M_cylinder (the parts of M by the losses in either
            body); with slopes also dQ_dV at fixed omega, dQ_domega at fixed V, dM_half_space_dV,
            dM_cylinder_dV and both slopes over omega.  Each is a float if V
            and omega are numbers, else an array of the broadcast shape.  Of a Cylinder Q is in N/m
            and M in N m/m, of a Scene they are divided by P and P R; slopes have these units
            divided by that of V or omega.  In full slip
            |Q| = mu P, and the slopes of Q are 0; at V = omega = 0 dQ_domega is infinite and
            dQ_dV -infinite.

        Raises
        ------
        ParameterError
            NaN or infinite input, kappa |V| above 1e300, an omega T_ref beyond the doubles, shapes
            that do not broadcast, a unit of another dimension, a ``slopes`` that is no truth value.
        OutOfTableError
            The law of a grid: a state outside of its axes.

        Warns
        -----
        ModelWarning
            Of a Cylinder, as :func:`contact`: a contact longer than the radius, or outside of the
            measured band.
        """
        if slopes is not False:
            slopes = check_bool("slopes", slopes)
        if type(V) not in _NUMBERS or type(omega) not in _NUMBERS:
            return self._of_arrays(V, omega, LoadsAndSlopes if slopes else Loads)
        out = self._output()
        try:
            status = self._function(V, omega, out, self._sloped if slopes else self._plain)
        except ctypes.ArgumentError:  # an integer beyond the doubles
            status = 1
        if status:
            self._refuse(check_array("V", V), check_array("omega", omega))
        low, high = self._covered
        if abs(V) < low or abs(V) > high:
            warn_of_contact(self.roller, V, (V, V))
        return _loads_and_slopes(out) if slopes else _loads(out[:4])

    def _of_arrays(self, V: Any, omega: Any, kind: Any) -> Any:
        """Return the law at arrays, by :func:`contact`, because the compiled law takes one state.

        V, omega: speeds in the units of the roller, of any shapes that broadcast; they may have
        labels or units.
        kind: class of the result, :class:`Loads`, without slopes, or :class:`LoadsAndSlopes`.
        Returns a ``kind`` of arrays of the broadcast shape; empty ones for empty input.
        Raises and warns as :func:`contact` does.
        """
        return kind(**contact(self.roller, V, omega=omega, fields=kind._fields).as_dict())

    def _refuse(self, V: Floats, omega: Floats) -> None:
        """Raise ParameterError: kappa |V| exceeds 1e300, or omega T_ref overflows.

        V, omega: finite, arrays of shape (), in the units of the roller.
        """
        refuse_overflow(self._kappa, V)
        raise ParameterError(
            "omega", f"{float(omega):g}", "smaller in magnitude: omega T_ref overflows"
        )

    @property
    def jitted(self) -> Callable[[float, float], LoadsAndSlopes[float]]:
        """The law for functions that numba compiles, which take it as an argument or use it as a
        global variable.

        It is called as (V, omega) with two numbers in the units of the roller, and returns
        :class:`LoadsAndSlopes` of eight floats; all of them are NaN where the law would raise an
        error.  It does not warn.
        """
        return self._jitted

    @property
    def address(self) -> tuple[int, int]:
        """Return two addresses for programs in C, as integers: that of a function and that of its
        user data.

        The function is ``int law(double V, double omega, double out[10], void *user_data)``.  It
        takes V and omega in the units of the roller, fills ``out`` with the eight numbers of
        :class:`LoadsAndSlopes` in their order (Q, M, M_half_space, M_cylinder, dQ_dV, dQ_domega,
        dM_half_space_dV, dM_cylinder_dV, dM_half_space_domega, dM_cylinder_domega) and returns 0;
        where the law
        would raise an error, it fills ``out`` with NaN and returns another number.  Any number of
        threads may call it, while this law exists.  All laws of half-spaces share the function, all
        laws of covers another one, and all laws of grids a third.
        """
        return self._jitted.function_address, self._jitted.address

    @property
    def ctypes(self) -> tuple[Any, Any]:
        """Function and user data of :attr:`address` for ctypes, as
        ``scipy.LowLevelCallable(*law.ctypes)`` takes them.

        Each of the two keeps the law alive.
        """
        return self._jitted.ctypes

    def __reduce__(self) -> tuple[Any, ...]:
        return law, (self.roller,)

    def __repr__(self) -> str:
        return f"law of {self.roller!r}"


class _LawOfGrid(Law):
    """The law of a grid of loads over V and delta, as read from a file: a :class:`Law` whose
    numbers are those of splines.

    Its ``roller`` is the :class:`LawGrid`; it has no ``scene``, and never warns.  Slopes of Q are 0
    also where the grid gives |Q| = mu P.
    """

    def __init__(self, grid: LawGrid) -> None:
        """Compile the splines of a ``grid`` of loads over V and delta; V and omega then have the
        units of the grid.

        Of the :class:`LawGrid`, which becomes ``roller``, ``rows``, ``most`` and ``R`` are read.
        """
        from ..kernels.law.spline_law import jitted_table

        self.roller: Any = grid
        self._covered = _EVERY_SPEED
        scale = {"V": 1.0, "omega": 1.0 / grid.R, "Q": 1.0, "M": 1.0}
        self._use(jitted_table(grid.rows.vector, grid, 1.0, grid.most, scale))

    def _of_arrays(self, V: Any, omega: Any, kind: Any) -> Any:
        """Return the law at arrays, one state after another, because the compiled law takes one
        state.

        V, omega: speeds in the units of the grid, of any shapes that broadcast.
        kind: class of the result, :class:`Loads`, without slopes, or :class:`LoadsAndSlopes`.
        Returns a ``kind`` of arrays of the broadcast shape, which is () for numbers; empty ones for
        empty input.
        Raises OutOfTableError for the first state outside of the axes, ParameterError for NaN or
        infinite input, and ValueError of numpy for shapes that do not broadcast.
        """
        evaluate = np.vectorize(
            lambda *state: tuple(self(*state, slopes=True)), otypes=[float] * 10
        )
        return kind(
            *evaluate(check_array("V", V), check_array("omega", omega))[: len(kind._fields)]
        )

    def _refuse(self, V: Floats, omega: Floats) -> None:
        """Raise OutOfTableError for a state that the splines found to be outside; V, omega: in
        units of the grid.
        """
        self.roller.refuse_outside(V, omega)


def law(roller: Roller | LawGrid) -> Law:
    """Return the contact law of one cylinder on its base as a fast function of V and omega, for
    your own integrator.

    ``law(V, omega)`` gives the friction force and the rolling moment that :func:`contact` gives at
    a given omega, Eqs. (6)-(10) and (15)-(18) of Zobova and Goryacheva (2020); the parameters of
    the roller are checked once, here.  ``law.jitted`` and ``law.address`` are the same function for
    numba and C.

    Parameters
    ----------
    roller : a :class:`Scene`, of which alpha or material, kappa and mu are used, or a
        :class:`Cylinder`, whose law takes and gives SI units: one number each, one material or two
        bodies; or the grid of :func:`viscoroll.load_law`, in its units.

    Returns
    -------
    Law
        A function (V, omega) -> named tuple of Q, M, M_half_space, M_cylinder; with ``slopes=True``
        also of four derivatives (:meth:`Law.__call__`).  Threads may share it; pickled, it binds
        its scene anew.

    Raises
    ------
    ParameterError
        What is no scene, cylinder or grid; arrays for alpha, kappa or mu; an array of materials;
        times of a material beyond 1e-100 to 1e100 T_ref; a layer too thin for its law.

    Notes
    -----
    For numbers the bits of Q and M are those of :func:`contact`, of a Scene also those of the
    slopes; those of a Cylinder agree to two units in the last place.  For arrays :func:`contact` is
    called (``tests/test_bound_law.py``).  At rest, V = omega = 0, dQ_domega is infinite and dQ_dV
    is -infinite.  Where full slip begins, Q has a corner in V only; the slopes there are those of
    full slip, 0.  A call without slopes does not compute them.

    Calls of the law warn as :func:`contact` does; ``law.jitted`` and ``law.address`` cannot.

    For a grid the numbers are those of its splines in ln \\|V\\| and delta, as good as the file
    states (``tests/tables/test_splines.py``): clipped to \\|Q\\| <= mu P; below the slowest speed Q
    is that at the slowest, and M in proportion to V; beyond both ends of delta \\|Q\\| is mu P
    where the grid slips fully there.  Other states outside of the axes raise OutOfTableError.
    Arrays are looked up one state after another.

    Examples
    --------
    >>> import viscoroll as vr
    >>> law = vr.law(vr.Scene(alpha=11.0, kappa=10.0, mu=0.3))
    >>> loads = law(0.5, 0.51)
    >>> loads.Q > 0.0
    True
    """
    if isinstance(roller, LawGrid):
        return _LawOfGrid(roller)
    return Law(roller)
