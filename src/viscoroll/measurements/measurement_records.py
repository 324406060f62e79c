"""Records of measurements in SI units: :class:`Resistance`, :class:`Traction` and
:class:`Coastdown`.

A record without values is a plan: the fit then says how well it would determine the unknowns.
"""

import math
from collections.abc import Mapping
from dataclasses import KW_ONLY, dataclass, field
from typing import Any, ClassVar

import numpy as np

from ..core import (
    DIMENSIONLESS,
    Floats,
    Labels,
    Numbers,
    ParameterError,
    broadcast_shape,
    check_array,
    check_names,
    check_number,
    described_error,
    shape_error,
    si_unit,
    strip_labels,
    to_unit,
)
from ..materials import ABSOLUTE_ZERO
from ..rollers import Cylinder

#: word for an initial angular velocity of V0/R
ROLLING = "rolling"
#: unknowns of a record
OF_RECORDS: tuple[str, ...] = ("V0", "omega0", "t0")
#: number of a record -> its lower bound
_LOWER = {"load": 0.0, "m": 0.0, "temperature": ABSOLUTE_ZERO, "V0": -math.inf, "omega0": -math.inf}
#: name -> initial value, and range (of t0 as an array of two) where the record leaves it open
InitialValues = dict[str, tuple[float, Any]]
#: relative tolerance of a free motion
_RTOL = 1e-8
#: relative tolerance of a driven motion: its outputs are smooth in the parameters to 2e-12 then
_RTOL_DRIVEN = 1e-10


@dataclass(frozen=True, eq=False)
class Record:
    """A record of measurements: coordinates of points, values at them, and standard deviations,
    each an array or one number for all.

    It is the base of :class:`Resistance`, :class:`Traction` and :class:`Coastdown`.

    COORDINATES : names of the coordinates of the points, as V or t.
    QUANTITIES : names of what may be measured at the points; a record that has none of them is a
        plan: a test that is to be made, whose accuracy is computed before.
    LABEL : kind of record, its name in messages.
    sigma : as given by the caller a number, an array, a dict or None; after ``__post_init__`` a
        dict, quantity -> standard deviations in its SI unit, in the shape of the points, or None
        where they are to be estimated.
    load, temperature, name : as in :class:`Resistance`.
    labels : :class:`Labels` of xarray or pandas of the arrays that were given; None without.
    """

    #: names of coordinates, and of what may be measured at them, the first what a plan is about
    COORDINATES: ClassVar[tuple[str, ...]]
    QUANTITIES: ClassVar[tuple[str, ...]]
    LABEL: ClassVar[str]

    _: KW_ONLY
    sigma: Any = None
    load: float | None = None
    temperature: float | None = None
    name: str = ""
    labels: Labels | None = field(default=None, init=False, repr=False)

    def __post_init__(self) -> None:
        """Check the fields, convert them to SI units, and replace them by the results.

        Coordinates and values become float64 arrays of one shape, at least one-dimensional, which
        may be read-only views; quantities that were not measured stay None.  ``sigma`` is given as
        a number or an array, of the one quantity that was measured, as a dict, quantity -> number
        or array, or as None.  It becomes a dict: of data quantity -> array of that shape, or None
        where the standard deviation is to be estimated, for every quantity measured; of a plan for
        those given alone, so that it is {} where none is.  ``load`` (N/m), ``temperature`` (degrees
        Celsius), and ``m`` (kg/m), ``V0`` (m/s), ``omega0`` (rad/s) of a :class:`Coastdown`, become
        floats; None and omega0 = "rolling" stay.  ``labels`` is set to those of the arrays, or
        None.

        Raises ParameterError for values that are not numbers, not finite, of another unit, of no
        points, or of shapes that do not broadcast; for values or sigma at more points than the
        coordinates have; for sigma, load or m that are not > 0; for temperature, V0 or omega0 that
        is no finite number; for one sigma where several quantities are measured, and for a quantity
        in sigma that the record does not have or did not measure; for a name that is no text or has
        a colon.
        """
        if not isinstance(self.name, str) or ":" in self.name:
            raise ParameterError("name", f"{self.name!r:.60}", "a text without a colon")
        given = {
            name: to_unit(self.label(name), getattr(self, name), self.unit(name))
            for name in (*self.COORDINATES, *self.measured)
        }
        plain, labels = strip_labels(given, DIMENSIONLESS)
        arrays = {
            name: np.atleast_1d(check_array(self.label(name), value))
            for name, value in plain.items()
        }
        # a single sigma is of the quantity that was measured or, in a plan, of the first one
        among = self.measured or self.QUANTITIES
        sigma = self.sigma
        if not isinstance(sigma, Mapping):
            if sigma is not None and len(self.measured) > 1:
                raise ParameterError(
                    self.label("sigma"),
                    f"{sigma!r:.40}",
                    f"one per quantity in a dict, as {{{': ..., '.join(map(repr, among))}: ...}}",
                )
            sigma = {among[0]: sigma}
        kind = f"a {'measured ' * bool(self.measured)}quantity of the record"
        check_names(self.label("sigma"), sigma, among, kind)
        sigma = {name: value for name, value in sigma.items() if value is not None}
        for name, value in sigma.items():
            label = f"sigma of {name}"
            arrays[label] = check_array(self.label(label), value, unit=self.unit(name), above=0.0)
        for name, array in arrays.items():
            if not array.size:
                raise described_error(self.label(name), "is empty", "at least one number")
        shape = broadcast_shape(**{self.label(name): array for name, array in arrays.items()})
        points = broadcast_shape(**{name: arrays[name] for name in self.COORDINATES})
        for name, array in arrays.items():
            if np.broadcast_shapes(array.shape, points) != points:
                raise shape_error(
                    self.label(name),
                    array.shape,
                    f"one value for each point, in the shape {points} of "
                    f"{' and '.join(self.COORDINATES)}",
                )
        whole = {name: np.broadcast_to(array, shape) for name, array in arrays.items()}
        sigmas = {name: whole.pop(f"sigma of {name}", None) for name in self.measured or sigma}
        # by ``vars``, as the class is frozen
        vars(self).update(whole, labels=labels, sigma=sigmas)
        for name, low in _LOWER.items():
            value = getattr(self, name, None)
            rolling = name == "omega0" and isinstance(value, str) and value == ROLLING
            if value is not None and not rolling:
                vars(self)[name] = check_number(
                    self.label(name), value, unit=self.unit(name), above=low
                )

    @staticmethod
    def unit(name: str) -> str:
        """Return the SI unit in which records keep a field, and to which a value with a unit is
        converted.

        Parameters
        ----------
        name : name of a field: a measured quantity as "F", what it was measured at as "V", or a
            number of the whole record as "load".  It is not checked.

        Returns
        -------
        str
            The unit, as "m s-1"; forces and loads are per length of the cylinder, "N m-1".  "1" for
            fields without dimension, as the creepage "delta".

        Examples
        --------
        >>> import viscoroll as vr
        >>> vr.Resistance.unit("F"), vr.Traction.unit("delta")
        ('N m-1', '1')
        """
        return si_unit(name)

    def label(self, name: str) -> str:
        """Return the name of a field as messages have it.

        Parameters
        ----------
        name : name of the field, as "V"; not checked.

        Returns
        -------
        str
            "RECORD: FIELD"; an unnamed record has the name of its kind.

        Examples
        --------
        >>> import viscoroll as vr
        >>> vr.Traction(V=1.0, delta=0.02).label("Q")
        'traction: Q'
        """
        return f"{self.name or self.LABEL}: {name}"

    @property
    def measured(self) -> tuple[str, ...]:
        """Names of the quantities that the record has values of; none of a plan."""
        return tuple(name for name in self.QUANTITIES if getattr(self, name) is not None)

    @property
    def overrides(self) -> dict[str, float]:
        """Inputs of the cylinder that the record replaces: "load" in N/m and "m" in kg/m -> number;
        {} where it has neither.
        """
        given = (("load", self.load), ("m", getattr(self, "m", None)))
        return {name: value for name, value in given if value is not None}

    def initial_values(self, R: float) -> InitialValues:
        """Return the start values V0, omega0 and t0 of the motion, which a fit may need;
        :class:`Coastdown` has them.

        Parameters
        ----------
        R : radius of the cylinder, m; not used here.

        Returns
        -------
        dict
            Empty: other records have no motion.  :meth:`Coastdown.initial_values` returns name ->
            (initial value, limits), in SI units; limits are (low, high) where the record does not
            give the value, else None.

        Examples
        --------
        >>> import viscoroll as vr
        >>> vr.Traction(V=1.0, delta=0.02).initial_values(R=0.1)
        {}
        """
        return {}

    def model(self, cylinder: Cylinder, values: Mapping[str, Any]) -> dict[str, Floats]:
        """Return all :attr:`QUANTITIES` as the model predicts them, which each kind does itself.

        cylinder : :class:`Cylinder` with the present values of the unknowns, which has the load,
            the mass and the temperature of this record already.
        values : name -> value of the unknowns of bearing and record, without the name of the
            record: "brake" in N m/m, "drag" in N m s/m, "V0" in m/s, "omega0" in rad/s, "t0" in s;
            those that are missing are 0 or as the record has them.
        Returns a dict, quantity -> values in SI units, in the shape of the points of the record.
        Raises NotImplementedError here, in the base class; in the kinds of records ViscorollError,
        where the values make no contact or no motion.
        """
        raise NotImplementedError


@dataclass(frozen=True, eq=False)
class Resistance(Record):
    """Rolling resistance over speed: of a drum, or of a roller that is pulled.

    Parameters
    ----------
    V : speeds, m/s, any sign, (n,) or one number.
    M : rolling moments, N m per m of length, (n,), the torque of the bearing included, as on the
        shaft of a drum; its sign is that of V where it resists.
    F : pulling forces M/R, N/m, of the sign of M, in place of M or beside it.  A record without
        both is a plan.
    sigma : standard deviation of M or F, in its unit, a number or one for each point; of both {"M":
        ..., "F": ...}.  None: estimated from the residuals.
    load : load of this record, N/m; None: the cylinder's.
    temperature : temperature of this record, degrees Celsius, see ``shift`` of
        :func:`viscoroll.identify`; None: that of the cylinder's materials.
    name : by which the report calls it, without a colon; "": its kind, "resistance".

    Raises
    ------
    ParameterError
        Values that are not finite, with their row, or of another unit (``attrs["units"]``), sigma
        <= 0, a load that is not > 0; M or F of which all values drive, by more than three sigma
        where it is given.

    Examples
    --------
    >>> import viscoroll as vr
    >>> drum = vr.Resistance(V=[0.5, 1.0, 2.0], M=[0.31, 0.33, 0.36], sigma=0.01)
    >>> drum.M
    array([0.31, 0.33, 0.36])
    """

    COORDINATES = ("V",)
    QUANTITIES = ("M", "F")
    LABEL = "resistance"

    V: Numbers
    M: Numbers | None = None
    _: KW_ONLY
    F: Numbers | None = None

    def __post_init__(self) -> None:
        """Check the sign of M and F beside all that every record checks.

        Raises ParameterError as :meth:`Record.__post_init__` does, and as the class states.
        """
        super().__post_init__()
        for name in self.measured:
            noise = 0.0 if self.sigma[name] is None else 3.0 * self.sigma[name]
            if (getattr(self, name) * np.sign(self.V) < -noise).all():
                raise described_error(
                    self.label(name),
                    "has at all points the sign opposite to V",
                    "of the sign of V, since it resists; reverse its sign in the data",
                )

    def model(self, cylinder: Cylinder, values: Mapping[str, Any]) -> dict[str, Floats]:
        """Predict rolling moment and pulling force, the torque of the bearing included.

        The force is that of :func:`viscoroll.steady` with the bearing's torque, sign(V) brake +
        drag V/R; the moment is force times R.  Both are NaN where friction does not turn it.

        Parameters
        ----------
        cylinder : :class:`Cylinder` with the present values of the unknowns, already with the load
            and the temperature of this record, which are not read here; nor are M and F, so that a
            plan is predicted too.
        values : name -> value of "brake", N m/m, and "drag", N m s/m, each 0 where it is missing;
            other names are not used.

        Returns
        -------
        dict[str, Floats]
            {"M": moments, N m/m; "F": forces, N/m}, in the shape of the speeds of the record.

        Raises
        ------
        ParameterError
            Values that make no contact, as speeds beyond the range of the law.

        Warns
        -----
        ModelWarning
            As :func:`viscoroll.steady`; a fit suppresses it.

        Examples
        --------
        >>> import viscoroll as vr
        >>> drum = vr.Resistance(V=[0.5, 1.0])
        >>> free, braked = (
        ...     drum.model(vr.presets.RUBBER_CYLINDER, {"brake": brake})["M"]
        ...     for brake in (0.0, 0.1)
        ... )
        >>> (braked - free).round(6)
        array([0.1, 0.1])
        """
        V = np.asarray(self.V)
        drag = values.get("drag", 0.0) * V / cylinder.R
        force = cylinder.steady(V=V, torque=-np.sign(V) * values.get("brake", 0.0) - drag).force
        # one equilibrium a speed; none where the bearing takes more torque than friction
        F = force.reshape(V.shape) if force.size else np.full(V.shape, np.nan)
        return {"M": F * cylinder.R, "F": F}


@dataclass(frozen=True, eq=False)
class Traction(Record):
    """Traction over creepage, at one speed or several.

    Parameters
    ----------
    V : speeds of the axis, m/s, one for all or one a point, (n,).
    delta : creepages (omega R - V)/V, dimensionless, (n,) or one number.
    Q : traction, N/m, positive for delta > 0 and V > 0, (n,); None: a plan.
    sigma, load, temperature, name : as in :class:`Resistance`.

    Raises
    ------
    ParameterError
        As in :class:`Resistance`.

    Examples
    --------
    >>> import viscoroll as vr
    >>> traction = vr.Traction(V=1.0, delta=[-0.02, 0.0, 0.02], Q=[-60.0, 0.0, 60.0])
    >>> traction.V
    array([1., 1., 1.])
    """

    COORDINATES = ("V", "delta")
    QUANTITIES = ("Q",)
    LABEL = "traction"

    V: Numbers
    delta: Numbers
    Q: Numbers | None = None

    def model(self, cylinder: Cylinder, values: Mapping[str, Any]) -> dict[str, Floats]:
        """Predict the traction, the Q of the contact at the speeds and creepages of the record.

        Parameters
        ----------
        cylinder : :class:`Cylinder` with the present values of the unknowns, already with the load
            and the temperature of this record, which are not read here; nor is Q, so that a plan is
            predicted too.
        values : not used: bearing and record have no unknowns that change the traction.

        Returns
        -------
        dict[str, Floats]
            {"Q": tractions, N/m}, in the shape of the points of the record.

        Raises
        ------
        ParameterError
            As in :meth:`Resistance.model`.

        Warns
        -----
        ModelWarning
            As :func:`viscoroll.contact`; a fit suppresses it.

        Examples
        --------
        >>> import viscoroll as vr
        >>> found = vr.Traction(V=1.0, delta=[-0.02, 0.0, 0.02]).model(
        ...     vr.presets.RUBBER_CYLINDER, {}
        ... )
        >>> (found["Q"] > 0.0).tolist()
        [False, False, True]
        """
        return {"Q": cylinder.contact(self.V, delta=self.delta, fields="Q").Q}


@dataclass(frozen=True, eq=False)
class Coastdown(Record):
    """Speeds or distance over time of a roller that was launched or released.

    Parameters
    ----------
    t : times, s, ascending, (n,); they may repeat.
    V, omega, x : speed of the axis, m/s, angular velocity, rad/s, distance since the release, m,
        (n,) each; at least one, of a plan none.
    V0 : speed at the release, m/s; None: unknown, near the first values.
    omega0 : angular velocity at the release, rad/s; "rolling": V0/R; None: unknown, near the first
        values.
    t0 : time of the release, s, before which the roller has its first speeds; (low, high): unknown.
    m : mass with which it rolled, kg/m; None: the cylinder's.
    sigma : as in :class:`Resistance`; of several quantities {"V": ..., "omega": ...}, whose names
        are those that a plan measures.
    load, temperature, name : as in :class:`Resistance`; without a name it is called "run".

    Raises
    ------
    ParameterError
        As in :class:`Resistance`; times that fall or are no vector; t0 of another form.

    Examples
    --------
    >>> import viscoroll as vr
    >>> run = vr.Coastdown(t=[0.0, 1.0, 2.0], V=[2.0, 1.7, 1.5], sigma=0.01, V0=2.0)
    >>> run.omega0
    'rolling'
    """

    COORDINATES = ("t",)
    QUANTITIES = ("V", "omega", "x")
    LABEL = "run"

    t: Numbers
    V: Numbers | None = None
    omega: Numbers | None = None
    x: Numbers | None = None
    _: KW_ONLY
    V0: float | None = None
    omega0: float | str | None = ROLLING
    t0: float | tuple[float, float] = 0.0
    m: float | None = None

    def __post_init__(self) -> None:
        """Check times and t0 beside all that every record checks; t0 becomes a float or a pair of
        floats, s.

        Raises ParameterError as :meth:`Record.__post_init__` does, for times that fall (equal ones
        are allowed) or are no vector, and for a t0 that is neither one finite number nor two;
        whether two ascend is checked by the fit.
        """
        super().__post_init__()
        t: Any = self.t
        if t.ndim > 1:
            raise shape_error(self.label("t"), t.shape, "one list of times in ascending order")
        if (falls := np.flatnonzero(np.diff(t) < 0.0)).size:
            n = falls[0]
            raise ParameterError(
                self.label("t"), f"{t[n]}, {t[n + 1]} at indices {n}, {n + 1}", "in ascending order"
            )
        t0 = check_array(self.label("t0"), self.t0, unit="s")
        if t0.shape not in ((), (2,)):
            raise ParameterError(
                self.label("t0"), self.t0, "a number, or a range (low, high), in s"
            )
        vars(self)["t0"] = tuple(t0.tolist()) if t0.ndim else float(t0)

    def initial_values(self, R: float) -> InitialValues:
        """Return the unknowns of the release with their initial values.

        Parameters
        ----------
        R : radius of the cylinder, m.

        Returns
        -------
        dict
            Name ("t0", "V0", and "omega0" unless it is "rolling") -> (initial value; (low, high)
            where the record leaves it open, None where it gives it), in s, m/s and rad/s.  The
            (low, high) of V0 and omega0 is a tuple, that of t0 an array, (2,), whose order is not
            checked here.  A t0 that is open starts at 0 limited to its range: low where low > 0,
            high where high < 0.  V0 and omega0 that are open start at the first measured value,
            within the largest magnitude measured to either side.  Where V was not measured, V0 is
            R times the first omega, if omega0 is "rolling" and omega was measured, else the slope
            of the first tenth of x (at least three points, or all), within its magnitude.

        Raises
        ------
        ParameterError
            V0 or omega0 is open and the record has no data that show it.

        Examples
        --------
        >>> import viscoroll as vr
        >>> run = vr.Coastdown(t=[0.0, 1.0, 2.0], V=[2.0, 1.7, 1.5])
        >>> run.initial_values(R=0.1)
        {'t0': (0.0, None), 'V0': (2.0, (0.0, 4.0))}
        """
        record: Any = self
        ends = np.ravel(record.t0)
        found: InitialValues = {
            "t0": (float(np.clip(0.0, ends[0], ends[-1])), ends if ends.size > 1 else None)
        }
        speeds = record.V
        if self.V0 is None and speeds is None:
            if record.omega is not None and self.omega0 == ROLLING:
                speeds = R * record.omega
            elif record.x is not None:
                some = slice(max(3, record.t.size // 10))
                # [:1]: the slope, before the constant
                speeds = np.polyfit(record.t[some], record.x[some], 1)[:1]
        for name, value, data in (("V0", self.V0, speeds), ("omega0", self.omega0, record.omega)):
            if value is None:
                if data is None:
                    shown = "V or x" if name == "V0" else name.removesuffix("0")
                    raise ParameterError(
                        self.label(name), None, f"given, as the record has no values of {shown}"
                    )
                first = float(data[0])
                most = float(np.abs(data).max())
                found[name] = (first, (first - most, first + most))
            elif not isinstance(value, str):
                found[name] = (value, None)
        return found

    def model(self, cylinder: Cylinder, values: Mapping[str, Any]) -> dict[str, Floats]:
        """Predict V, omega and x, and for each point whether it is in full slip.

        Before the time t0 of the release V and omega are those at the release, and x is 0.

        Parameters
        ----------
        cylinder : :class:`Cylinder` with the present values of the unknowns, already with the load,
            the mass and the temperature of this record, which are not read here; nor are V, omega
            and x, so that a plan is predicted too.
        values : name -> value of "brake", N m/m, and "drag", N m s/m, which are 0 where they are
            missing, and of "V0", "omega0" and "t0" in place of those of the record; where these are
            missing the record must have numbers, or "rolling" as omega0, which is V0/R.  Other
            names are not used.

        Returns
        -------
        dict[str, Floats]
            Arrays over the times, (n,), by name: "V" in m/s, "omega" in rad/s, "x" in m, "slips" as
            truth values, False before the release.  V, omega and x are NaN, and slips False, at
            times that the motion did not reach.

        Raises
        ------
        ParameterError
            Values that make no motion, as infinite ones.

        Warns
        -----
        ModelWarning, RuntimeWarning
            As :func:`viscoroll.roll`, the latter where the motion is given up; a fit suppresses
            both.

        Examples
        --------
        >>> import viscoroll as vr
        >>> run = vr.Coastdown(t=[0.0, 1.0, 2.0], V0=2.0)
        >>> found = run.model(vr.presets.RUBBER_CYLINDER, {})
        >>> float(found["V"][0]), bool(found["x"][2] > found["x"][1])
        (2.0, True)
        """
        V0, omega0, t0 = (values.get(name, getattr(self, name)) for name in OF_RECORDS)
        t = np.asarray(self.t) - t0
        if omega0 == ROLLING:
            omega0 = V0 and V0 / cylinder.R  # None, an unknown V0, stays None
        drive = {name: values[name] for name in ("brake", "drag") if values.get(name)}
        motion = cylinder.roll(
            V0, omega0, np.maximum(t, 0.0), rtol=_RTOL_DRIVEN if drive else _RTOL, **drive
        )
        return {
            "V": motion.V,
            "omega": motion.omega,
            "x": motion.x,
            "slips": (motion.regime == 0) & (t >= 0.0),
        }
