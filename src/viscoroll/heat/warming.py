"""Warming of a roller over time: :func:`warming` integrates the balance of heat."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np

from ..contact_mechanics.model_warnings import warn_of_contact
from ..contact_mechanics.parameters import Roller, resolve_model
from ..core import (
    Floats,
    Numbers,
    ParameterError,
    Schedule,
    Values,
    check_array,
    check_number,
    described_error,
    shape_error,
    strip_labels,
)
from .heated_bodies import heat_states

#: Relative tolerance of the integrator, and the absolute one in K: the energy then balances to 1e-6
#: of itself.
_TOLERANCE = 1e-9


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
    from scipy.integrate import solve_ivp

    roller, scene, scale = resolve_model(roller, "warming")
    start = ambient if start is None else start
    given = {"ambient": ambient, "conductance": conductance, "capacity": capacity, "start": start}
    plain, labels = strip_labels(given, scale)
    states = heat_states(roller, scene, "warming", plain)
    heat_capacity, theta = (
        np.broadcast_to(plain[name], states.shape or (1,)).ravel() for name in ("capacity", "start")
    )
    times = check_array("t", t, unit=scale, low=0.0)
    if times.ndim != 1 or not times.size:
        raise shape_error("t", times.shape, "a vector (t,) of at least one time")
    if (np.diff(times) <= 0.0).any():
        raise described_error("t", "does not ascend", "in ascending order")
    speed, corners = _speed_of(V, scale)
    every = np.arange(theta.size)

    def rates(time: float, y: Floats) -> Floats:
        """Return dtheta/dt of each state, then the heat per time and the heat given off, W/m."""
        off = states.conductance * (y[: theta.size] - states.ambient)
        heat = states.heat(every, y[: theta.size], speed(time))
        return np.concatenate([(heat - off) / heat_capacity, heat, off])

    y = np.concatenate([theta, np.zeros(2 * theta.size)])
    parts = [y[:, np.newaxis]] if times[0] == 0.0 else []
    last = times[-1]
    for span in pairwise(np.unique([0.0, *corners[corners < last], last]).tolist()):
        own = times[(times > span[0]) & (times <= span[1])]
        stops = np.union1d(own, span[1])
        found = solve_ivp(rates, span, y, "DOP853", stops, rtol=_TOLERANCE, atol=_TOLERANCE)
        if not found.success:
            what = f"cannot be integrated ({found.message})"
            raise described_error("temperature", what, "one that a balance has")
        y = found.y[:, -1]
        parts.append(found.y[:, : own.size])
    course, heat, off = np.split(np.concatenate(parts, axis=1), 3)
    if (hot := course.max(initial=-np.inf)) > states.curve.high:
        sentence = (
            f"the roller warms to {hot:.5g} degrees Celsius, beyond the shift's "
            f"{states.curve.high:g}"
        )
        raise ParameterError("temperature", hot, f"at most {states.curve.high:g}", sentence)
    V_t = np.tile([speed(time) for time in times.tolist()], theta.size)
    rows = states.fields(np.repeat(every, times.size), course.ravel(), V_t)
    warn_of_contact(roller, V_t * rows["a_T"])
    values = {name: rows[name] for name in ("temperature", "V", "C_rr", "M", "loss")}
    values |= {"heat": heat, "given_off": off}
    about: dict[str, Any] = {"t": times} | {
        name: np.asarray(plain[name])[..., np.newaxis]
        for name in ("ambient", "conductance")
        if np.ndim(plain[name])
    }
    shape = *states.shape, times.size
    found_values = {name: each.reshape(shape) for name, each in values.items()}
    return Values(found_values, about, si=True, title="Warming of a roller", labels=labels)


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
        # at a jump the value after it
        return lambda time: float(np.interp(time, V.times, V.values)), V.times
    if callable(V):
        return lambda time: check_number("V", V(time), unit=scale), np.empty(0)
    speed = check_number("V", V, unit=scale)
    return lambda time: speed, np.empty(0)
