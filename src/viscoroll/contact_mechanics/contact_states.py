"""The contact law: :func:`contact`, the state of the contact at given speeds and creepages,
and :func:`law`, the same of one scene as a function for integrators.

Numbers of equations are those of the paper: A. A. Zobova and I. G. Goryacheva, Dynamics of a
viscoelastic cylinder on a viscoelastic half-space, Acta Mechanica (2020),
doi:10.1007/s00707-020-02643-5.
"""

import ctypes
from collections.abc import Callable, Iterable
from functools import partial
from typing import Any, Literal, overload

import numpy as np

from ..core import (
    DIMENSIONS,
    Floats,
    Numbers,
    ParameterError,
    Values,
    broadcast_shape,
    check_array,
    check_array_extent,
    check_bool,
    check_one_given,
    divide_by_unit,
    strip_labels,
)
from ..kernels.records import Loads, LoadsAndSlopes
from ..laws import LawGrid
from .assumptions import moment_error, transit_frequency
from .contact_table import evaluate_contact, field_names, refuse_overflow
from .model_warnings import warn_of_contact
from .parameters import Roller, refuse_arrays, resolve_model

# --- The state of the contact ---

Method = Literal["table", "direct", "coupled"]


@overload
def contact(
    roller: Roller,
    V: Numbers,
    *,
    delta: Numbers,
    fields: Iterable[str] | None = None,
    slopes: bool = False,
    method: Method = "table",
) -> Values: ...
@overload
def contact(
    roller: Roller,
    V: Numbers,
    *,
    omega: Numbers,
    fields: Iterable[str] | None = None,
    slopes: bool = False,
    method: Method = "table",
) -> Values: ...
def contact(
    roller: Roller,
    V: Numbers,
    *,
    delta: Numbers | None = None,
    omega: Numbers | None = None,
    fields: Iterable[str] | None = None,
    slopes: bool = False,
    method: Method = "table",
) -> Values:
    """Compute contact length, creep force and rolling moment of a viscoelastic cylinder that rolls
    on a half-space.

    Both bodies are viscoelastic, or one of them is elastic, rigid, or a layer of finite thickness.
    The contact is that of steady rolling with partial or full slip at a given speed and creepage:
    Eqs. (6)-(10) and (15)-(18) of Zobova and Goryacheva (2020).  For bodies that their paper does
    not treat (a Prony series, two materials, a layer) the equations are theirs with the functions
    of these bodies (docs/theory.md).

    V, delta and omega broadcast against each other and against array parameters of the roller.

    Parameters
    ----------
    roller : a :class:`Scene`, of which alpha or material, kappa and mu are used, everything
        dimensionless; or a :class:`Cylinder`, in SI units per m of its length.
    V : velocity of the axis, any sign; of a Cylinder in m/s, of a Scene divided by R/T_ref.  T_ref
        is the unit of time: T_epsilon of a Scene with ``alpha``, else the time in which the
        material counts.
    delta, omega : exactly one of the two, any sign: the creepage (omega R - V)/V, dimensionless; or
        the angular velocity, of a Cylinder in rad/s, of a Scene multiplied by T_ref.
        At V = 0 a given ``delta`` means the limit V -> 0+; a given ``omega`` other than 0 means
        full slip, and 0 means delta = 0.
    fields : a name or several names of fields to compute; None: the default fields.  A unit in
        parentheses is that of a Scene, then that of a Cylinder; other fields are dimensionless.

        Default fields of every roller:

        - ``lam``: contact length divided by l0, the contact length at rest of half-spaces;
        - ``epsilon``: shift of the contact towards the leading edge in half contact lengths, 0 at
          V = 0;
        - ``delta_star``: critical creepage, > 0: half the distance of ``delta_minus`` and
          ``delta_plus``;
        - ``delta``: creepage; infinite with the sign of omega at V = 0 with omega other than 0,
          and where omega R/V exceeds the doubles;
        - ``full_slip``: whether delta is beyond ``delta_minus`` or ``delta_plus``;
        - ``beta``: length of the stick zone divided by the contact length, 0 in full slip, 1 where
          Q = 0;
        - ``zeta``: half the transit time (T_ref; s); infinite at V = 0, and where lam/V exceeds
          the doubles;
        - ``Q``: force on the cylinder by friction (P; N/m), positive in the direction of a positive
          V, of the sign of delta V, at V = 0 of delta (of a layer with delta - delta_0 for delta);
          in full slip its size is mu P;
        - ``M``: rolling resistance moment (P R; N m/m), of the sign of V, 0 at V = 0 and of elastic
          bodies.  Of a layer, and of half-spaces with Dundurs' constant above 0.05, it has a part
          by Q too, of either sign, as shear acts back on the pressure; so have lam and epsilon;

        Further default fields of some rollers:

        - ``M_half_space``, ``M_cylinder``: the parts of M by the losses in either body, of bodies
          that differ, and of every Cylinder;
        - ``length``: contact length, m, and ``C_rr`` = M/(P R): coefficient of rolling resistance,
          of a Cylinder;
        - ``delta_0``: creepage at which Q = 0, caused by the strain under the pressure, of a layer.

        Fields that are computed only if they are named:

        - ``delta_minus``, ``delta_plus``: creepages at and beyond which the whole contact slips
          backwards or forwards; -delta_star and delta_star but for layers;
        - ``grip``: friction reserve 1 - Q/(mu P) with the size of Q, without loss of digits, 0 in
          full slip;
        - ``N``: added mass in slow changes of speed, in which the moment is M(V) + N dV/dt (P
          T_ref^2; N s^2/m); not known of layers and of arrays of materials;
        - ``M_error``: of a Cylinder, accuracy of M by the data of its materials as +-, relative,
          infinite outside their band, NaN where not known
          (:meth:`viscoroll.Measured.moment_error`);
        - each slope below.
    slopes : whether ``dQ_dV``, ``dQ_ddelta``, ``dQ_domega`` and ``dM_dV`` are computed in addition,
        and of bodies that differ ``dM_half_space_dV`` and ``dM_cylinder_dV``; of a layer also
        ``dM_ddelta``, ``dM_domega`` and those over omega of either body.  ``dQ_dV``, and of a layer
        slopes of M over V, are at fixed delta or fixed omega, whichever was given, the others are
        at fixed V.  In full slip the slopes of Q are 0.  Where full slip begins Q has a corner over
        V, and the slopes there are those of full slip.  In partial slip at V = 0 ``dQ_domega`` is
        infinite, and where omega = 0 was given ``dQ_dV`` is -infinite.
    method : how the fields are computed:

        - "table": from the rows of the law; no equation is solved.
        - "direct": by the equations as the paper prints them, solved by Brent-Dekker.  It has no
          slopes, N, grip, delta_0, delta_minus and delta_plus, and takes alpha, no material.
        - "coupled": pressure and shear are solved together by boundary elements, and zones of
          stick and slip are found, not assumed.  The bodies are any two, layers or half-spaces,
          each rigid, elastic or relaxing; one pair in a call.  It has no slopes and no N.  Further
          default fields are ``delta_minus``, ``delta_plus``, and the powers lost ``loss_slip``,
          ``loss_half_space`` and ``loss_cylinder`` (P R/T_ref; W/m), whose sum is V (M + delta Q).
          By name alone it has ``depth`` (l0; m), the approach of bodies each of which is a layer
          or rigid.

    Returns
    -------
    Values
        The fields as attributes and by ``[name]``: those of ``fields`` in their order, then the
        slopes.  Each is an array of the broadcast shape; if all inputs are numbers it is a float,
        ``full_slip`` a bool.  Arguments of xarray or pandas give results with their labels.  Of a
        Cylinder slopes have the unit of Q or M divided by m/s, by rad/s, or by 1.  Force and moment
        on the cylinder, Eqs. (20) and (21), are Q - M_half_space/R and Q R + M_cylinder.
        ``epsilon`` may exceed 1: the contact then lies wholly ahead of the axis.

    Raises
    ------
    ParameterError
        NaN or infinite input, kappa |V| above 1e300 (for Q by method "direct" above 1e12), both or
        neither of delta and omega, an unknown field or method, a field or method that these bodies
        do not have, a ``slopes`` that is no truth value, shapes that do not broadcast, labelled
        arrays beside plain ones or with other coordinates, a unit of another dimension; what is no
        scene and no cylinder; a layer too thin for its law (half the contact at rest longer than
        six thicknesses), times of a material beyond 1e-100 to 1e100 T_ref; ``$VISCOROLL_THREADS``
        that is no whole number >= 1.
    ConvergenceError
        Method "direct": an iteration reached its limit.  Method "coupled": a state has no solution,
        which is named.

    Warns
    -----
    ModelWarning
        Of a Cylinder: its contact at rest is longer than its radius, or the transit frequency is
        outside the band in which its material was measured.

    Examples
    --------
    >>> import viscoroll as vr
    >>> roller = vr.Cylinder(
    ...     R=0.1, m=35.5, E=2.3e5, nu=0.49, T_epsilon=10.7, T_sigma=0.97, mu=0.2
    ... )
    >>> state = roller.contact(0.01, omega=0.099)
    >>> traction, moment = state.Q, state.M

    Notes
    -----
    Accuracy of method "table" for one material (one alpha, a series or two bodies): the relative
    error of delta_star, M and Q is below 5e-15, that of the parts of M too, relative to M.  For lam
    and epsilon it is 5e-15, and 1.5e-14 and 3e-14 in one octave of speed at alpha above 15.
    This holds for any speed and creepage (``tests/test_claims.py``).  Where each state
    has its own alpha or material it is 1e-13 for alpha in [1, 1e4] and kappa V in [1e-7, 1e5].  The
    error of beta is that of lam times 1/(1 - |delta|/delta_star), its condition number, and the
    error of grip twice that.  The error of N is 2e-14 of its largest value
    (``tests/kernels/rows/test_unsteady.py``).

    The law of one material is evaluated from polynomials of one variable
    (:mod:`.law_tables`), which are computed at first use, in some milliseconds for
    half-spaces, and kept.  The result of a state does not depend on other states of the call.

    Method "coupled" is good to 3e-4 mu P in Q, 2e-5 in kappa M and 1e-4 in lam and epsilon, where
    alpha is above 100 and u T/alpha is short beside the contact to 5e-5 and 5e-4
    (``tests/contact_law/test_coupled.py``).  It takes some 2 ms a state, and 50 ms for each
    kappa |V|.

    Beside float64 input and its result a call takes a few megabytes, for any sizes and any
    broadcasting (``tests/test_invariance.py``).
    """
    _, scene, scale = resolve_model(roller, "contact")
    creep_name = check_one_given(delta=delta, omega=omega)
    if slopes is not False:
        slopes = check_bool("slopes", slopes)
    names = field_names(fields, slopes, method, scene, scale.si)
    given, labels = strip_labels({"V": V, creep_name: omega if delta is None else delta}, scale)
    speed, ends = check_array_extent("V", given["V"])
    creep, _ = check_array_extent(creep_name, given[creep_name])
    given = {"V": speed, creep_name: creep}
    if scale.si:
        warn_of_contact(roller, speed, ends)
        speed = divide_by_unit("V", speed, scale["V"])
        creep = divide_by_unit(creep_name, creep, scale[creep_name])
    if method == "coupled":
        from .stress import evaluate_coupled

        found = evaluate_coupled(scene, speed, creep, delta is None, names)
    else:
        found = evaluate_contact(scene, speed, creep, delta is None, names, method)
    if scale.si:
        if "M_error" in found:
            # until here M_error has the values of lam
            frequency = transit_frequency(given["V"], found["M_error"] * scale["length"])
            found["M_error"] = moment_error(frequency, roller.body_data.records)[()]
        found = {
            name: value * scale[name] if name in DIMENSIONS else value
            for name, value in found.items()
        }
    return Values(found, given, si=scale.si, labels=labels, about=roller.about)


# --- The law of one scene for integrators ---

#: Types that the compiled function takes; others go through :func:`contact`.
_NUMBERS = frozenset({float, int, np.float64})
#: Makes :class:`Loads` from four numbers, faster than its constructor.
_loads = partial(tuple.__new__, Loads)
#: Makes :class:`LoadsAndSlopes` from ten numbers.
_loads_and_slopes = partial(tuple.__new__, LoadsAndSlopes)


class Law:
    """The law of a scene or a cylinder as a function of V and omega: the result of :func:`law`.

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

    #: (lowest, highest) |V| between which nothing is warned of, in the unit of V.  Where nothing is
    #: known of the bodies these are all speeds.
    _covered = 0.0, np.inf
    _jitted: Any

    def __init__(self, roller: Roller) -> None:
        """Check that ``roller`` is one scene or cylinder of one material, and compile its law.

        roller: a scene or a cylinder whose alpha or material, kappa and mu are single; gamma and j
        are not used.
        Raises ParameterError for what is neither, for arrays in alpha, kappa or mu (also of shape
        (1,)), for an array of materials, for times of a material beyond 1e-100 to 1e100 T_ref, and
        for a layer too thin for its law.  Sets ``roller``, ``scene``, ``_kappa`` (kappa over the
        unit of V), ``_covered``, ``_jitted`` (the compiled law, a :class:`.Jitted`), and
        ``_output``, the type of the buffer of ten doubles for its results.
        """
        from ..kernels.law.law_callables import Jitted, ResultBuffer, pack_scenes

        _, scene, scale = resolve_model(roller, "law")
        refuse_arrays(
            roller, scene, ("alpha", "kappa", "mu"), "one number: vr.law is for one roller"
        )
        table = scene.rolling_law
        assert table is not None
        self.roller = roller
        self.scene = scene
        self._kappa = scene.kappa / scale["V"]
        self._covered = (roller.body_data and roller.body_data.covered_speeds) or self._covered
        self._output = ResultBuffer
        if table.coupled is None:
            scenes = pack_scenes(table.record, table.unlike, scene.kappa, scene.mu, scale)
            self._jitted = Jitted(scenes, table)
        else:
            from ..kernels.law.spline_law import jitted_table

            self._jitted = jitted_table(table.record.table, table, scene.kappa, scene.mu, scale)

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
        jitted = self._jitted
        out = self._output()
        try:
            status = jitted.function(V, omega, out, jitted.address if slopes else jitted.plain)
        except ctypes.ArgumentError:  # an integer beyond the doubles
            status = 1
        if status:
            self._refuse(check_array("V", V), check_array("omega", omega))
        low, high = self._covered
        if not low <= abs(V) <= high:
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
        allowed = "smaller in magnitude: omega T_ref exceeds the largest number, 1.8e308"
        raise ParameterError("omega", f"{float(omega):g}", allowed)

    @property
    def jitted(self) -> Callable[[float, float], LoadsAndSlopes[float]]:
        """The law for functions that numba compiles, which take it as an argument or use it as a
        global variable.

        It is called as (V, omega) with two numbers in the units of the roller, and returns
        :class:`LoadsAndSlopes` of ten floats; all of them are NaN where the law would raise an
        error.  It does not warn.
        """
        return self._jitted  # type: ignore[no-any-return]

    @property
    def address(self) -> tuple[int, int]:
        """Return two addresses for programs in C, as integers: that of a function and that of its
        user data.

        The function is ``int law(double V, double omega, double out[10], void *user_data)``.  It
        takes V and omega in the units of the roller, fills ``out`` with the ten numbers of
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
        return self._jitted.ctypes  # type: ignore[no-any-return]

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

        Of the :class:`LawGrid`, which becomes ``roller``, ``rows`` and ``R`` are read.
        """
        from ..kernels.law.law_callables import ResultBuffer
        from ..kernels.law.spline_law import jitted_table

        self.roller: Any = grid
        scale = {"V": 1.0, "omega": 1.0 / grid.R, "Q": 1.0, "M": 1.0}
        self._output = ResultBuffer
        self._jitted = jitted_table(grid.rows.vector, grid, 1.0, grid.rows.mu, scale)

    def _of_arrays(self, V: Any, omega: Any, kind: Any) -> Any:
        """Return the law at arrays, one state after another, because the compiled law takes one
        state.

        V, omega: speeds in the units of the grid, of any shapes that broadcast; they may have
        labels or units.
        kind: class of the result, :class:`Loads`, without slopes, or :class:`LoadsAndSlopes`.
        Returns a ``kind`` of arrays of the broadcast shape, with the labels of the speeds, of
        numbers for numbers; empty ones for empty input.
        Raises OutOfTableError for the first state outside of the axes, ParameterError for NaN or
        infinite input, and for shapes that do not broadcast.
        """
        evaluate = np.vectorize(partial(self, slopes=True), otypes=[float] * 10)
        plain, labels = strip_labels({"V": V, "omega": omega}, self.roller.scale)
        speeds = {name: check_array(name, each) for name, each in plain.items()}
        broadcast_shape(**speeds)
        rows = (each[()] for each in evaluate(*speeds.values()))
        found = dict(zip(kind._fields, rows))
        return kind(**Values(found, labels=labels).as_dict())

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
        also of six derivatives (:meth:`Law.__call__`).  Threads may share it; pickled, it binds
        its scene anew.

    Raises
    ------
    ParameterError
        What is no scene, cylinder or grid; arrays for alpha, kappa or mu; an array of materials;
        times of a material beyond 1e-100 to 1e100 T_ref; a layer too thin for its law.

    Notes
    -----
    For numbers the bits of Q, M and their slopes are those of :func:`contact`
    (``tests/test_bound_law.py``); the slopes of a Cylinder, and its M by a table of the coupled
    solution, agree to two units in the last place.  For arrays :func:`contact` is called.  At rest,
    V = omega = 0, dQ_domega is infinite and dQ_dV is -infinite.  Where full slip begins, Q has a
    corner in V only; the slopes there are those of full slip, 0.  A call without slopes does not
    compute them.

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
    return _LawOfGrid(roller) if isinstance(roller, LawGrid) else Law(roller)
