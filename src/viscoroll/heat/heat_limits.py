"""Limits that heat sets: :func:`heat_limit`, :func:`turning_points`, and the conductance of a body.

A roller that starts cold takes the coldest equilibrium of its speed and load, whose temperature
rises with both and jumps where the cold branch ends: the limit is where it passes the allowed one.
At a given temperature the speed of a balance is unique, since V M(V) does not fall; turning points
are the extrema of that speed over the temperature.  :func:`warming` integrates the balance of heat.
"""

import itertools
import math
from collections.abc import Callable
from typing import Any, Literal, NamedTuple

import numpy as np

from ..contact_mechanics import (
    Assumption,
    Roller,
    refuse_arrays,
    resolve_model,
    scale_of,
    warn_of_contact,
)
from ..core import (
    SI,
    Booleans,
    Floats,
    Integers,
    Numbers,
    ParameterError,
    Schedule,
    Values,
    broadcast_shape,
    check_array,
    check_choice,
    check_number,
    check_one_given,
    described_error,
    format_value,
    shape_error,
    strip_labels,
)
from . import HOTTEST, zeros_at_speed
from .heated_bodies import NODES, check_ambient, heat_states, heated_body, shift_curve

# --- Limits ---

#: Film coefficient of a turning roller, W/(m2 K), near the geometric mean of 10 to 50, its range at
#: surface speeds of 0.5 to 10 m/s by forced convection and radiation.
DEFAULT_FILM = 20.0
#: Largest Biot number, film times thickness over conductivity, at which the hottest point of a slab
#: with an insulated side is at most 10 % of the rise above its mean: (1 + B/2)/(1 + B/3) = 1.1.
BIOT_LIMIT = 0.75
#: Speed up to which turning points are returned, m/s: beyond it a cold rubber's loss is constant.
FASTEST = 1e4
#: ln of V, m/s, and of the load over that given, where limits are sought: beyond no roller runs.
_LN_RANGE = -70.0, 70.0
#: Distance of ln V and of ln of a load from a limit at which it is found.
_TOLERANCE = {"xatol": 1e-13, "xrtol": 1e-15}
#: Part of the allowed rise by which a runaway misses it: its error is the root of that of ln V.
_SHORT = 1e-5
#: Steps of ln of a load of a cover after which its limit is found, by the fast law and that of the
#: roller: a hundredth of a step is left.
_COVER_STEPS = 1e-2, 1e-4
#: Slope of ln heat over ln of the load by which the secant method starts: that of half-spaces.
_RISE = 1.5


class TurningPoints(NamedTuple):
    """The speeds at which two equilibria of heat meet, by rising temperature.

    V : speeds, m/s, (n,).
    temperature : degrees Celsius, (n,).
    is_runaway : whether the colder branch ends there as V rises, else the hotter as V falls, (n,).
    """

    V: Floats
    temperature: Floats
    is_runaway: Booleans


def heat_limit(
    roller: Roller,
    allowed: float,
    *,
    V: Numbers | None = None,
    load: Numbers | None = None,
    ambient: Numbers,
    conductance: Numbers,
) -> Values:
    """Find the largest load at each speed, or speed at each load, at which a roller is cool enough.

    It starts at ambient temperature, rolls freely, and never passes the allowed temperature.

    Parameters
    ----------
    roller : a :class:`Cylinder` as in :func:`temperature`, of which the load is replaced.
    allowed : temperature of the body that is allowed, degrees Celsius.
    V : speeds, m/s, other than 0, of which the loads are found.
    load : loads, N/m, > 0, of which the speeds are found; exactly one of the two is given.
    ambient, conductance : as in :func:`temperature`.

    Returns
    -------
    Values
        ``load`` (N/m) of given V, or ``V`` (m/s, > 0; infinite where no speed is too fast) of given
        loads; ``temperature``, from which a larger one leads beyond the allowed temperature: the
        allowed one, or that at which the cold branch ends; ``runaway``, whether it is the latter.

    Raises
    ------
    ParameterError
        As in :func:`temperature`; both or neither of V and load, V = 0, an allowed temperature not
        above ambient or beyond the range of the shift, a load at which a cover is too thin.

    Examples
    --------
    >>> import viscoroll as vr
    >>> rubber = vr.Material(
    ...     3e6, 0.49, vr.Prony([2.0], [1.0]), 0.01, temperature=20.0, shift=vr.WLF(T0=-50.0)
    ... )
    >>> roller = vr.Cylinder(
    ...     R=0.1, m=60.0, material=rubber, base=vr.Material.rigid(), mu=0.6, load=2e4
    ... )
    >>> found = vr.heat_limit(roller, 70.0, V=[1.0, 2.0, 4.0], ambient=20.0, conductance=6.0)
    >>> bool((found.load[1:] < found.load[:-1]).all())
    True

    Notes
    -----
    The limits are those of :func:`temperature` to 1e-8, relative (``tests/test_heat.py``).
    """
    _, scene, scale = resolve_model(roller, "heat_limit")
    curve = shift_curve(heated_body(roller, "heat_limit", 0.5).material)
    name = check_one_given(V=V, load=load)
    given = {name: V if load is None else load, "ambient": ambient, "conductance": conductance}
    plain, labels = strip_labels(given, scale)
    allowed = check_number("allowed", allowed, unit=SI)
    check_ambient(allowed, curve, "allowed")
    value = check_array(name, plain[name])
    if name == "V" and not value.all():
        raise described_error("V", "has the value 0, where rolling makes no heat", "other than 0")
    if not allowed > np.max(check_array("ambient", plain["ambient"]), initial=-math.inf):
        raise ParameterError("allowed", allowed, f"above ambient = {np.max(plain['ambient']):g} °C")
    arrays = {name: value} | {key: np.asarray(plain[key]) for key in ("ambient", "conductance")}
    broadcast_shape(**arrays)
    if scene.cover is None:
        rows = _limits(roller, allowed, arrays)
    else:
        refuse_arrays(roller, scene, ("alpha",))
        # one state at a time: the load changes the contact length, and with it the law of a cover
        limits = np.vectorize(
            lambda *one: _limit_of_cover(roller, allowed, **dict(zip(arrays, one))),
            otypes=[float, float, bool],
        )
        rows = limits(*arrays.values())
    names = ("V" if name == "load" else "load", "temperature", "runaway")
    found = {key: each if each.ndim else each.item() for key, each in zip(names, rows)}
    return Values(found, arrays, si=True, title="Limits by heat", labels=labels)


def _limits(roller: Any, allowed: float, given: dict[str, Any]) -> tuple[Any, ...]:
    """Return the limits of :func:`heat_limit` for states with one law.

    roller: the cylinder.
    allowed: allowed temperature, degrees Celsius.
    given: name -> array, "ambient", "conductance", and "load" (V is sought) or "V" (load is).
    Returns (largest speed, m/s, or load, N/m; temperature from which a larger one leads beyond the
    allowed one; whether the cold branch ends there), arrays in the shape of the states.
    """
    from scipy.optimize import elementwise

    if "load" in given:
        roller = roller.replace(load=given["load"])
    states = heat_states(roller, "heat_limit", given)

    def above(ln: Floats, n: Integers) -> Floats:
        """Return the coldest equilibrium less the allowed temperature, K, (m,).

        ln: ln of the speed, m/s, or where V is given of the factor of the load, (m,).
        n: indices of the states, (m,).
        """
        given = (np.exp(ln),) if states.V is None else (states.V[n], np.exp(ln))
        zeros = zeros_at_speed(states, n, *given)
        # zeros.state counts within n; without an equilibrium the temperature runs away
        coldest = np.full(n.size, np.inf)
        np.minimum.at(coldest, zeros.state, zeros.theta)
        return coldest - allowed

    every = np.arange(states.load.size)
    found = elementwise.find_root(above, _LN_RANGE, args=(every,), tolerances=_TOLERANCE)
    # the last below the limit: at the end of a branch it misses the allowed temperature
    below = np.where(found.success, found.bracket[0], 0.0)
    short = -above(below, every)
    runaway = found.success & (short > _SHORT * (allowed - states.ambient))
    limit = np.where(found.success, np.exp(found.x), np.inf)
    rows = (
        limit if states.V is None else limit * states.load,
        allowed - np.where(runaway, short, 0.0),
        runaway,
    )
    return tuple(each.reshape(states.shape) for each in rows)


def _limit_of_cover(
    roller: Any, allowed: float, load: Any = None, V: Any = None, **given: float
) -> tuple[Any, ...]:
    """Return :func:`_limits` of one state of a cover, of which every load has a law of its own.

    A load is below the limit if the body gets less heat than it gives off at some temperature up to
    the allowed one.  The secant method has the fast law first, as a table takes seconds.

    roller, allowed: as in :func:`_limits`.
    load, V: N/m and m/s, one of the two, a number; None: it is sought.
    given: ambient and conductance, numbers.
    Raises ParameterError for a load on the way at which the cover is too thin.
    """
    if load is not None:
        return _limits(roller, allowed, given | {"load": load})
    ln = math.log(roller.load)
    slope = _RISE
    value = 0.0
    for coupled, last in zip((False, roller.coupled), _COVER_STEPS):
        step = math.inf
        while abs(step) > last:
            at = roller.replace(load=math.exp(ln), coupled=coupled)
            states = heat_states(at, "heat_limit", given | {"V": V})
            # without ambient, where no heat is given off
            theta = states.curve.nodes(given["ambient"], allowed)[1:]
            for _ in range(4):
                heat = states.heat(np.zeros(theta.size, np.int64), theta, V)
                ratio = heat / (given["conductance"] * (theta - given["ambient"]))
                k = int(ratio.argmin())
                worst = float(theta[k])
                low, high = theta[max(k - 1, 0) : k + 2][[0, -1]]
                theta = np.linspace(low, high, 65)
            before = value
            value = math.log(ratio[k])
            slope = slope if step == math.inf else (value - before) / step
            # by a factor e at most
            step = min(max(-value / slope, -1.0), 1.0)
            ln += step
    return math.exp(ln), worst, worst < allowed


def turning_points(roller: Roller, *, ambient: float, conductance: float) -> TurningPoints:
    """Find the speeds at which equilibria of heat appear or vanish: ends of cold or hot branches.

    Parameters
    ----------
    roller : a :class:`Cylinder` as in :func:`temperature`, without arrays; it rolls freely.
    ambient, conductance : numbers as in :func:`temperature`.

    Returns
    -------
    TurningPoints
        Named tuple of ``V``, ``temperature`` and ``is_runaway``, arrays of one length by rising
        temperature; empty where each speed has one equilibrium; up to 1e4 m/s.  Above a speed of
        runaway, up to 500 degrees Celsius, the roller warms to a hotter branch.

    Raises
    ------
    ParameterError
        As in :func:`temperature`; arrays.

    Examples
    --------
    >>> import viscoroll as vr
    >>> rubber = vr.Material(
    ...     3e6,
    ...     0.49,
    ...     vr.Prony([2.0, 40.0], [1.0, 0.01]),
    ...     0.02,
    ...     temperature=20.0,
    ...     shift=vr.WLF(C1=8.86, C2=101.6, T0=0.0),
    ... )
    >>> roller = vr.Cylinder(
    ...     R=0.1, m=60.0, material=rubber, base=vr.Material.rigid(), mu=0.6, load=2e4
    ... )
    >>> vr.turning_points(roller, ambient=-20.0, conductance=6.0).is_runaway.tolist()
    [True, False]

    Notes
    -----
    The speeds have a relative error below 1e-8 (``tests/test_heat.py``).
    """
    from scipy.optimize import elementwise

    ambient = check_number("ambient", ambient, unit="degC")
    conductance = check_number("conductance", conductance, unit="W m-1 K-1", above=0.0)
    given = {"ambient": ambient, "conductance": conductance}
    states = heat_states(roller, "turning_points", given)
    if states.shape:
        raise shape_error("roller", states.shape, "a Cylinder of single numbers, without arrays")

    curve = states.curve

    def ln_V(x: Floats) -> Floats:
        """Return ln of the speed, m/s, of which log2 a_T of the equilibrium is x, (m,)."""
        theta = curve.temperature_of(x)
        off = conductance * (theta - ambient)

        def rest(ln: Floats, theta: Floats, off: Floats) -> Floats:
            return states.heat(np.zeros(ln.size, np.int64), theta, np.exp(ln)) - off

        found = elementwise.find_root(rest, _LN_RANGE, args=(theta, off), tolerances=_TOLERANCE)
        return np.where(found.success, found.x, _LN_RANGE[1])

    # from the hottest to ambient, near which V rises with the temperature
    ends = np.array([min(HOTTEST, curve.high), ambient])
    low, high = np.log2(curve.at(ends)[0]).tolist()
    # without ambient itself, where no heat is given off and V is 0
    x = np.linspace(low, high, 2 + math.ceil(NODES * (high - low)))[:-1]
    y = ln_V(x)
    bend = np.diff(np.sign(np.diff(y)))
    k = 1 + np.flatnonzero(bend * (y[1:-1] < math.log(FASTEST)))
    sign = np.sign(bend[k - 1])  # -1 at a maximum
    triple = x[k - 1], x[k], x[k + 1]
    found = elementwise.find_minimum(lambda x, sign: sign * ln_V(x), triple, args=(sign,))
    # log2 a_T falls with temperature
    order = np.argsort(-found.x)
    V = np.exp(sign * found.f_x)
    return TurningPoints(V[order], curve.temperature_of(found.x)[order], sign[order] < 0.0)


def conductance(
    R: Numbers,
    *,
    film: Numbers = DEFAULT_FILM,
    thickness: Numbers | None = None,
    conductivity: Numbers | None = None,
    core: Literal["cooled", "insulated"] = "insulated",
) -> Any:
    """Return the heat that a cylinder gives off per kelvin of its mean temperature above ambient,
    from film and conduction.

    Heat arises evenly in a solid cylinder, or in a cover (a ring on a core).  It is conducted to
    the surface, and to the core if that is cooled; the mean temperature follows in closed form.

    Parameters
    ----------
    R : radius of the surface, m, > 0; each number may be an array, and they broadcast.
    film : film coefficient of the surface, W/(m2 K), > 0; default 20, of a roller that turns in
        air: from 10 (slow, in still air) to 50 (10 m/s).
    thickness : of the cover, m, > 0, at most 0.999 R; None: a solid cylinder.
    conductivity : of the rubber, W/(m K), > 0 (0.15 to 0.3); None: the film alone counts.
    core : "insulated", a core that takes no heat, or "cooled", one at ambient temperature (with a
        thickness and a conductivity).

    Returns
    -------
    float or array
        W/(m K), per m of length.

    Raises
    ------
    ParameterError
        Values out of range, a thickness above 0.999 R, a cooled core without thickness and
        conductivity.

    Examples
    --------
    >>> import viscoroll as vr
    >>> round(vr.conductance(0.1, film=20.0), 3)  # 2 pi R film
    12.566
    """
    from scipy.special import hyp2f1

    check_choice("core", core, "cooled", "insulated")
    given: Any = {"R": R, "film": film, "thickness": thickness, "conductivity": conductivity}
    arrays: Any = {
        name: check_array(name, x, unit=SI, above=0.0) for name, x in given.items() if x is not None
    }
    broadcast_shape(**arrays)
    h = arrays.get("thickness")
    k = arrays.get("conductivity")
    is_conducting = h is not None and k is not None
    if core == "cooled" and not is_conducting:
        raise described_error(
            "core",
            "is 'cooled', but thickness and conductivity of the cover are not both given",
            "'insulated', or given with both",
        )
    if h is not None and np.any(h > 0.999 * arrays["R"]):  # beyond, 2F1 loses its digits
        raise ParameterError(
            "thickness",
            format_value(h),
            f"at most 0.999 R, with R = {format_value(R)}, the outer radius of the cover (in m)",
        )
    outer = arrays["R"]
    y: Any = h * (2.0 * outer - h) / (outer - h) ** 2 if is_conducting else None
    # y = (R/a)^2 - 1, a = R - h; 2F1 in place of logarithms, so that thin rings lose no digits
    if core == "cooled":
        biot = arrays["film"] * outer / k
        rise = y * (hyp2f1(1, 1, 4, -y) + 0.125 * biot * y * hyp2f1(2, 2, 4, -y)) / 12.0
        found = math.pi * k * (1.0 + 0.5 * biot * np.log1p(y)) / rise
    else:
        # mean rise above the surface; 1/8 of a solid cylinder
        rise = 0.125 if y is None else y * hyp2f1(1, 3, 4, -y) / 12.0
        within = 0.0 if k is None else rise / (math.pi * k)
        found = 1.0 / (1.0 / (2.0 * math.pi * outer * arrays["film"]) + within)
    return found if np.ndim(found) else float(found)


def uniform_temperature(film: float, thickness: float, conductivity: float) -> Assumption:
    """State whether one temperature stands for a cover: whether heat is conducted in it faster than
    it leaves it.

    Parameters
    ----------
    film : film coefficient, W/(m2 K), > 0.
    thickness : of the cover, m, > 0, on a core that takes no heat; of a solid cylinder 1.5 radii.
    conductivity : of the rubber, W/(m K), > 0.

    Returns
    -------
    Assumption
        Its ``value`` is the Biot number film thickness/conductivity; it holds up to 0.75, where the
        hottest point of a slab with even sources is 10 % of the rise above the mean; the sentence
        states that part.

    Raises
    ------
    ParameterError
        A value that is not one finite number > 0.

    Examples
    --------
    >>> import viscoroll as vr
    >>> vr.uniform_temperature(film=10.0, thickness=0.01, conductivity=0.25).holds
    True
    """
    given = {"film": film, "thickness": thickness, "conductivity": conductivity}.items()
    film, thickness, conductivity = (check_number(name, x, unit=SI, above=0.0) for name, x in given)
    biot = film * thickness / conductivity
    # a slab with even sources, cooled on one side: the rise of the hottest point and the mean,
    # both divided by that of the surface
    above = 100.0 * ((1.0 + 0.5 * biot) / (1.0 + biot / 3.0) - 1.0)
    return Assumption(
        biot <= BIOT_LIMIT,
        biot,
        f"the Biot number (film times thickness divided by conductivity) is {biot:.2g}, so that "
        f"the hottest point warms {above:.2g} % more than the mean.  One temperature is enough for "
        f"the cover up to a Biot number of {BIOT_LIMIT}, which means 10 % more",
    )


# --- Warming over time ---

#: Relative tolerance of the integrator, and the absolute one in K: the energy then balances to 1e-6
#: of itself.
_TIME_TOLERANCE = 1e-9


def warming(
    roller: Roller,
    V: Any,
    t: Numbers,
    *,
    ambient: Numbers,
    conductance: Numbers,
    capacity: Numbers,
    start: Numbers | None = None,
) -> Values:
    """Integrate the temperature of a freely rolling cylinder over time, with the law at the
    temperature of each time.

    Parameters
    ----------
    roller : a :class:`Cylinder` as in :func:`temperature`.
    V : speed, m/s, any sign: a number, a :class:`Schedule`, or a function of t.
    t : times of the output, s, (t,), ascending, >= 0.
    ambient, conductance : as in :func:`temperature`; these, ``capacity`` and ``start`` broadcast to
        the shape of states.
    capacity : heat that the body stores per kelvin, J/(m K), > 0: the sum of density, specific heat
        and cross section of all parts that warm together.
    start : temperature at t = 0, degrees Celsius; default: ``ambient``.

    Returns
    -------
    Values
        Over (states..., t): ``temperature``, ``V``, ``C_rr``, ``M``, ``loss`` (W/m, of both
        bodies), ``heat``, the energy that heated the body since t = 0, and ``given_off``, the part
        of it that it gave off, J/m.  What is stored, capacity times the rise of temperature, is the
        difference.

    Raises
    ------
    ParameterError
        As in :func:`temperature`; a capacity <= 0, times that do not ascend, an array V, a function
        V that returns no finite number, a temperature that leaves the range of the shift.

    Examples
    --------
    >>> import numpy as np
    >>> import viscoroll as vr
    >>> rubber = vr.Material(
    ...     3e6, 0.49, vr.Prony([2.0], [1.0]), 0.01, temperature=20.0, shift=vr.WLF(T0=-50.0)
    ... )
    >>> roller = vr.Cylinder(
    ...     R=0.1, m=60.0, material=rubber, base=vr.Material.rigid(), mu=0.6, load=2e4
    ... )
    >>> t = np.linspace(0.0, 3600.0, 61)
    >>> course = vr.warming(roller, 5.0, t, ambient=20.0, conductance=6.0, capacity=9e3)
    >>> course.to_xarray()["temperature"].dims
    ('t',)

    Notes
    -----
    heat less given_off is what is stored to 1e-6, and the end of a long warming is a stable
    equilibrium (``tests/test_heat.py``).
    """
    from scipy import integrate

    scale = scale_of(roller)
    start = ambient if start is None else start
    given = {"ambient": ambient, "conductance": conductance, "capacity": capacity, "start": start}
    plain, labels = strip_labels(given, scale)
    states = heat_states(roller, "warming", plain)
    theta = states.start
    times = check_array("t", t, unit=scale, low=0.0)
    if times.ndim != 1 or not times.size:
        raise shape_error("t", times.shape, "a list of at least one time")
    if (falls := np.flatnonzero(np.diff(times) <= 0.0)).size:
        n = falls[0]
        order = f"has {times[n]:g} s and then {times[n + 1]:g} s"
        raise described_error("t", order, "in ascending order, with no time twice")
    speed, corners = _speed_of(V, scale)
    every = np.arange(theta.size)

    def rates(time: float, y: Floats) -> Floats:
        """Return dtheta/dt of each state, then the heat per time and the heat given off, W/m."""
        off = states.conductance * (y[: theta.size] - states.ambient)
        heat = states.heat(every, y[: theta.size], speed(time))
        return np.concatenate([(heat - off) / states.capacity, heat, off])

    # temperatures, then heat and heat given off since t = 0, of all states
    y = np.concatenate([theta, np.zeros(2 * theta.size)])
    parts = [y[:, None]] if times[0] == 0.0 else []
    last = times[-1]
    for span in itertools.pairwise(np.unique([0.0, *corners[corners < last], last]).tolist()):
        own = times[(times > span[0]) & (times <= span[1])]
        # the end of the span too, where the next one starts; it is no output unless it is in
        # ``own``
        stops = np.union1d(own, span[1])
        found = integrate.solve_ivp(
            rates, span, y, "DOP853", stops, rtol=_TIME_TOLERANCE, atol=_TIME_TOLERANCE
        )
        if not found.success:
            raise described_error(
                "V",
                f"makes the temperature rise without limit after t = {[span[0], *found.t][-1]:g} s",
                "lower; or lower the load, or end t earlier",
            )
        y = found.y[:, -1]
        parts.append(found.y[:, : own.size])
    # (states, times) each, in the order of y
    course, heat, off = np.split(np.concatenate(parts, axis=1), 3)
    if (hot := course.max(initial=-np.inf)) > states.curve.high:
        raise described_error(
            "temperature",
            f"of the roller rises to {hot:.5g} degrees Celsius",
            f"at most {states.curve.high:g}, up to which the shift of its material is defined; "
            "lower V or the load, or end t earlier",
        )
    V_t = np.tile([speed(time) for time in times.tolist()], theta.size)
    rows = states.fields(np.repeat(every, times.size), course.ravel(), V_t)
    warn_of_contact(roller, V_t, a_T=rows["a_T"])
    values = {name: rows[name] for name in ("temperature", "V", "C_rr", "M", "loss")}
    values |= {"heat": heat, "given_off": off}
    about = {"t": times} | {
        name: np.asarray(plain[name])[..., None]
        for name in ("ambient", "conductance")
        if np.ndim(plain[name])
    }
    shape = *states.shape, times.size
    rows = {name: each.reshape(shape) for name, each in values.items()}
    return Values(rows, about, si=True, title="Warming of a roller", labels=labels, further=("t",))


def _speed_of(V: Any, scale: Any) -> tuple[Callable[[float], float], Floats]:
    """Return the speed as a function of time, m/s, and the times of its corners, at which the
    integrator stops.

    V: speed: a number, a :class:`Schedule` of one motion, or a function of t.
    scale: units of the roller, for quantities with a unit.
    Raises ParameterError for a Schedule of several motions, and values that are no finite number.
    """
    V = strip_labels({"V": V}, scale)[0]["V"]
    if isinstance(V, Schedule):
        if V.values.ndim > 1 or V.times.ndim > 1:
            found = f"is a Schedule with values of shape {V.values.shape}, times {V.times.shape}"
            raise described_error("V", found, "a Schedule with one list of each")
        # at a jump the value after it
        return lambda time: float(np.interp(time, V.times, V.values)), V.times
    if callable(V):
        return lambda time: check_number(f"V({time:g})", V(time), unit="m s-1"), np.empty(0)
    speed = check_number("V", V)
    return lambda time: speed, np.empty(0)
