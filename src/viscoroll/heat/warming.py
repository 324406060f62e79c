"""Warming of a roller over time: :func:`warming` integrates the balance of heat."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from ..contact_mechanics.parameters import Roller, resolve_model
from ..core.checks import Floats, Numbers, check_array, check_number
from ..core.drive_arguments import Schedule
from ..core.errors import ParameterError, described_error, shape_error
from ..core.labels import strip_labels
from ..core.results import Values
from .heated_bodies import HeatStates, check_ambient, heat_states
from .temperature import free_balance, rolling_rows

#: Tolerance of the integrator beside which its own default is loose: the energy then balances to
#: 1e-6 of itself.
RTOL = 1e-9


def warming(
    roller: Roller,
    V: Any,
    t: Numbers,
    *,
    ambient: Numbers,
    conductance: Numbers,
    capacity: Numbers,
    start: Numbers | None = None,
    rtol: float = RTOL,
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
    rtol : relative tolerance of the integrator, in [1e-12, 1e-3]; the absolute one is as many
        kelvin.

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
    from scipy.integrate import solve_ivp

    roller, scene, scale = resolve_model(roller, "warming")
    given = {"ambient": ambient, "conductance": conductance, "capacity": capacity, "start": start}
    plain, labels = strip_labels(
        {name: value for name, value in given.items() if value is not None}, scale
    )
    states = heat_states(roller, scene, "warming", plain)
    capacity, start = (
        _spread(states, check_array(name, plain.get(name, plain["ambient"]), above=low))
        for name, low in (("capacity", 0.0), ("start", -np.inf))
    )
    check_ambient(start, states.curve, "start")
    times = check_array("t", t, unit=scale, low=0.0)
    if times.ndim != 1 or not times.size:
        raise shape_error("t", times.shape, "a vector (t,) of at least one time")
    if (np.diff(times) <= 0.0).any():
        raise described_error("t", "does not ascend", "in ascending order")
    rtol = check_number("rtol", rtol, low=1e-12, high=1e-3)
    speed, corners = _speed_of(V, scale)
    every = np.arange(start.size)

    def rates(time: float, y: Floats) -> Floats:
        """Return dtheta/dt of each state, then the heat per time and the heat given off, W/m."""
        theta = y[: start.size]
        off = states.conductance * (theta - states.ambient)
        heat = free_balance(states, speed(time)).heat(every, theta)
        return np.concatenate([(heat - off) / capacity, heat, off])

    y = np.concatenate([start, np.zeros(2 * start.size)])
    found = []
    time = 0.0
    for stop in np.unique(np.append(corners[(corners > 0.0) & (corners < times[-1])], times[-1])):
        own = times[(times > time) & (times <= stop)] if time else times[times <= stop]
        y, outputs = _integrate(solve_ivp, rates, (time, float(stop)), y, own, rtol)
        found.append(outputs)
        time = float(stop)
    theta, heat, off = np.split(np.concatenate(found, axis=1), 3)
    if (hot := theta.max(initial=-np.inf)) > states.curve.high:
        sentence = (
            f"the roller warms to {hot:.5g} degrees Celsius, beyond the shift's "
            f"{states.curve.high:g}"
        )
        raise ParameterError("temperature", hot, f"at most {states.curve.high:g}", sentence)
    n = np.repeat(np.arange(start.size), times.size)
    V_t = np.tile([float(speed(time)) for time in times.tolist()], start.size)
    rows = rolling_rows(states, n, V_t, theta.ravel())
    values = {name: rows[name] for name in ("temperature", "V", "C_rr", "M", "loss")}
    values |= {"heat": heat.ravel(), "given_off": off.ravel()}
    shape = *states.shape, times.size
    about: dict[str, Any] = {"t": times} | {
        name: np.asarray(plain[name])[..., np.newaxis]
        for name in ("ambient", "conductance")
        if np.ndim(plain[name])
    }
    found_values = {name: each.reshape(shape) for name, each in values.items()}
    return Values(found_values, about, si=True, title="Warming of a roller", labels=labels)


def _spread(states: HeatStates, array: Floats) -> Floats:
    """Return an array in the shape of the states, flattened, (n,)."""
    return np.broadcast_to(array, states.shape or (1,)).ravel()


def _speed_of(V: Any, scale: Any) -> tuple[Callable[[float], float], Floats]:
    """Return the speed as a function of time, m/s, and the times of its corners, at which the
    integrator stops.

    V: speed: a number, a :class:`Schedule` of one motion, or a function of t.
    scale: units of the roller, for quantities with a unit.
    Raises ParameterError for a Schedule of several motions, and values that are no finite number.
    """
    if isinstance(V, Schedule):
        if V.values.ndim > 1 or V.times.ndim > 1:
            raise shape_error("V", V.values.shape, "a Schedule of one motion")
        return lambda time: float(
            np.interp(time, V.times, V.values)
        ), V.times  # at a jump the value after it
    if callable(V):
        return lambda time: check_number("V", V(time), unit=scale), np.empty(0)
    speed = check_number("V", V, unit=scale)
    return lambda time: speed, np.empty(0)


def _integrate(
    solver: Any, rates: Any, span: tuple[float, float], y: Floats, times: Floats, rtol: float
) -> tuple[Floats, Floats]:
    """Integrate over one stretch without corners.

    solver: ``scipy.integrate.solve_ivp``.
    rates: function of time and y; span: begin and end, s; y: values at its begin, (k,); times:
        outputs within it.
    rtol: relative tolerance.
    Returns (y at the end, (k,); y at the times, (k, outputs)).
    Raises ParameterError where the integrator finds no step that is small enough.
    """
    if span[1] == span[0]:
        return y, np.repeat(y[:, np.newaxis], times.size, axis=1)
    found = solver(rates, span, y, "DOP853", np.union1d(times, span[1]), rtol=rtol, atol=rtol)
    if not found.success:
        raise described_error(
            "temperature", f"cannot be integrated ({found.message})", "one that a balance has"
        )
    return found.y[:, -1], found.y[:, : times.size]
