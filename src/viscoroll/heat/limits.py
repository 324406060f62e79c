"""Limits that heat sets: :func:`heat_limit`, :func:`turning_points`, and the conductance of a body.

At a temperature theta the balance w = conductance (theta - ambient) determines the speed of a given
load, or the load of a given speed.  With u = kappa V a_T T_ref/R and C(u) = kappa M, w = part P V
C/kappa, and kappa is proportional to P^(-1/2), so that with the u_0 of the load P_0

    C(u) u = conductance (theta - ambient) a_T kappa^2/(part P) T_ref/R            at a given load
    C(u)/u^3 = conductance (theta - ambient) kappa_0/(part P_0 V u_0^3)            at a given speed, P = P_0 (u_0/u)^2

Both left sides are monotone, as d ln C/d ln u lies between -1 and 1 for every material.  A roller
that starts cold reaches theta at the largest of these loads or speeds over the temperatures up to
theta.
"""  # noqa: E501

from __future__ import annotations

import math
from typing import Any, Literal, NamedTuple

import numpy as np

from ..contact_mechanics.assumptions import Assumption
from ..contact_mechanics.contact_table import pure_rolling_fields
from ..contact_mechanics.parameters import Roller, resolve_model
from ..contact_mechanics.rolling_resistance import find_zeros
from ..core.checks import (
    Booleans,
    Floats,
    Integers,
    Numbers,
    broadcast_shape,
    check_array,
    check_choice,
    check_number,
)
from ..core.errors import ParameterError, check_one_given, described_error, shape_error
from ..core.labels import strip_labels
from ..core.results import Values
from ..core.scale import SI
from .heat_balance import FARTHEST, NODES, kept_curve, refine
from .heated_bodies import HeatStates, check_ambient, heat_states
from .temperature import HOTTEST

#: Film coefficient of a turning roller in still to moving air, W/(m2 K): near the geometric mean of
#: 10 to 50, the range of forced convection and radiation at surface speeds of 0.5 to 10 m/s.
DEFAULT_FILM = 20.0
#: Largest Biot number, film times thickness over conductivity, at which the hottest point of a slab
#: with an insulated side is at most 10 % of the rise above its mean: (1 + B/2)/(1 + B/3) = 1.1.
BIOT_LIMIT = 0.75
#: Temperatures between ambient and the allowed one at which the limit is computed before it is
#: refined, and the least part of the rise at which it is.
_TEMPERATURES = 64
_LEAST_PART = 1e-9
#: Half the step of the difference quotient of ln V, in log2 a_T: its zero is displaced by the
#: square of it.
_HALF_STEP = 1e-3
#: Speed up to which turning points are returned, m/s: beyond it no roller runs, and the loss of a
#: cold rubber no longer depends on the speed to rounding.
FASTEST = 1e4
#: ln V from which on the speed of a balance is of no account: a number, of which differences exist
_MOST_LN_V = 100.0
#: Step that tells a maximum of ln V from a minimum.
_BEND = 1e-2


class TurningPoints(NamedTuple):
    """The speeds at which two equilibria of heat meet, by rising temperature.

    V : speeds, m/s, (n,).
    temperature : degrees Celsius, (n,).
    is_runaway : whether the colder branch ends there as the speed rises; else the hotter one ends
    as it falls, (n,).
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
    """Find the largest load at each speed, or the largest speed at each load, at which a roller
    stays cool enough.

    It starts at ambient temperature, rolls freely, and must not pass the allowed temperature at any
    time.

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
        allowed one, or below it the one at which the cold branch ends; ``runaway``, whether that is
        so.

    Raises
    ------
    ParameterError
        As in :func:`temperature`; both or neither of V and load, V = 0, V of a cover, an allowed
        temperature that is not above ambient or beyond the range of the shift, a load of a cover
        that is too thin for its law.

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
    from scipy.optimize.elementwise import find_minimum

    _, _, scale = resolve_model(roller, "heat_limit")
    name = check_one_given(V=V, load=load)
    given = {name: V if load is None else load, "ambient": ambient, "conductance": conductance}
    plain, labels = strip_labels(given, scale)
    allowed = check_number("allowed", allowed, unit=SI)
    value = check_array(name, plain[name], above=0.0 if name == "load" else -math.inf)
    if name == "V" and not value.all():
        raise described_error("V", "is 0, where no load heats,", "other than 0")
    if not allowed > np.max(check_array("ambient", plain["ambient"]), initial=-math.inf):
        raise ParameterError("allowed", allowed, f"above ambient = {np.max(plain['ambient']):g}")
    cylinder: Any = roller
    if name == "load":
        cylinder = cylinder.replace(load=value)
    scene = cylinder.scene()
    if scene.cover is not None:
        if name == "V":
            raise described_error(
                "V", "is given", "left out for a cover, whose law depends on the load: give load="
            )
        if scene.cover.shape:  # one law after another
            return _for_each_load(roller, allowed, value, plain, labels)
    given = {"V": value if name == "V" else None} | {
        key: plain[key] for key in ("ambient", "conductance")
    }
    states = heat_states(cylinder, scene, "heat_limit", given)
    check_ambient(np.asarray(allowed), states.curve, "allowed")
    sought = "load" if name == "V" else "V"
    whole = allowed - states.ambient
    s = np.append(
        _LEAST_PART, np.arange(1.0, _TEMPERATURES + 2.0) / _TEMPERATURES
    )  # parts of the whole rise
    every = np.arange(whole.size)
    ln = _ln_limit(states, sought, np.repeat(every, s.size), np.outer(whole, s).ravel()).reshape(
        whole.size, s.size
    )
    best = 1 + np.argmax(ln[:, 1:-1], axis=1)
    found = find_minimum(
        lambda part, n: -_ln_limit(states, sought, n, whole[n] * part),
        (s[best - 1], s[best], s[best + 1]),
        args=(every,),
    )
    runaway = found.success & (found.x < 1.0) & (-found.f_x > ln[:, -2])
    rows: dict[str, Any] = {
        sought: np.exp(np.where(runaway, -found.f_x, ln[:, -2])),
        "runaway": runaway,
    }
    rows["temperature"] = states.ambient + np.where(runaway, found.x, 1.0) * whole
    found = {
        key: each.reshape(states.shape) if states.shape else each[0].item()
        for key, each in rows.items()
    }
    about = {name: value} | {key: np.asarray(plain[key]) for key in ("ambient", "conductance")}
    return Values(found, about, si=True, title="Limits by heat", labels=labels)


def _for_each_load(
    roller: Any, allowed: float, load: Floats, plain: dict[str, Any], labels: Any
) -> Values:
    """Return the result of :func:`heat_limit` for several loads of a cover, each of which has its
    own law.

    roller: the Cylinder with a cover.
    allowed: highest temperature allowed, degrees Celsius.
    load: loads, N/m, an array.
    plain: "ambient" and "conductance" -> number or array that broadcasts with ``load``.
    labels: axes and coordinates of the arguments; None without.
    Returns the :class:`Values` V, temperature and runaway, in the broadcast shape.
    """
    names = ("V", "temperature", "runaway")

    def limits(P: Any, at: Any, G: Any) -> tuple[Any, ...]:
        found = heat_limit(roller, allowed, load=P, ambient=at, conductance=G)
        return tuple(found[name] for name in names)

    given = {"load": load} | {name: np.asarray(plain[name]) for name in ("ambient", "conductance")}
    broadcast_shape(**given)
    found = np.vectorize(limits, otypes=[float, float, bool])(*given.values())
    found = dict(zip(names, found, strict=True))
    return Values(found, given, si=True, title="Limits by heat", labels=labels)


def _ln_limit(states: HeatStates, name: str, n: Integers, rise: Floats) -> Floats:
    """Return ln of the load or speed at which heat balances at temperatures above ambient.

    states: the states; name: the quantity that is sought, "load" or "V".
    n, rise: indices of states, and temperatures less ambient, K, > 0, (m,) each.
    Returns (m,); +inf where no speed loses as much.
    """
    log2, root_b = states.curve.exactly(states.ambient[n] + rise)
    kappa = states.kappa[n]
    ln_off = np.log(states.conductance[n] * rise / (states.body.part * states.load[n]))
    if name == "V":
        # log2 of u/(kappa V)
        power = 1.0
        unit = log2 - np.log2(states.unit[n])
        target = ln_off - np.log(root_b) + 2.0 * np.log(kappa * root_b) + math.log(2.0) * unit
    else:
        V = np.abs(states.V[n])  # type: ignore[index]
        power = -3.0
        x_0 = np.log2(kappa * V / states.unit[n]) + log2
        target = ln_off + np.log(kappa * root_b / V) - 3.0 * math.log(2.0) * x_0
    x = np.arange(2 * FARTHEST * NODES + 1) / NODES - FARTHEST
    curve = np.log(kept_curve(states.law)) + power * math.log(2.0) * x  # monotone
    k = (np.searchsorted(curve, target) if power > 0.0 else np.searchsorted(-curve, -target)).clip(
        1, x.size - 1
    ) - 1

    def rest(own: Integers, x: Floats) -> Floats:
        C = pure_rolling_fields(states.law, np.exp2(x), "M")[0]
        return np.log(C) + power * math.log(2.0) * x - target[own]

    with np.errstate(divide="ignore", invalid="ignore"):  # in a limit the curve is flat to rounding
        secant = x[k] + (target - curve[k]) / (curve[k + 1] - curve[k]) / NODES
    u = refine(rest, np.arange(n.size), x[k], x[k + 1], secant, np.full(n.size, power > 0.0))
    if name == "V":
        return np.where(target > curve[-1], np.inf, math.log(2.0) * (u - unit) - np.log(kappa))
    return np.log(states.load[n]) + 2.0 * math.log(2.0) * (x_0 - u)


def turning_points(roller: Roller, *, ambient: float, conductance: float) -> TurningPoints:
    """Find the speeds at which equilibria of heat appear or vanish: where a cold branch ends, and
    where a hot one does.

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
    _, scene, _ = resolve_model(roller, "turning_points")
    given = {
        "ambient": check_number("ambient", ambient, unit="degC"),
        "conductance": check_number("conductance", conductance, unit="W m-1 K-1", above=0.0),
    }
    states = heat_states(roller, scene, "turning_points", given)
    if states.shape:
        raise shape_error("roller", states.shape, "one without arrays")

    def ln_V(y: Floats) -> Floats:
        theta = states.curve.temperature_of(y)
        found = _ln_limit(states, "V", np.zeros(y.size, np.int64), theta - given["ambient"])
        return np.minimum(found, _MOST_LN_V)

    hottest = np.float64(min(HOTTEST, states.curve.high))
    ends = states.curve.log2_of(np.array([hottest, given["ambient"]]))
    # from the hottest to ambient; nearer to it than two steps V only rises with the temperature
    low = float(ends[0]) + 2.0 * _HALF_STEP
    high = float(ends[1]) - 2.0 * _HALF_STEP
    y = np.linspace(low, high, 2 + math.ceil(NODES * (high - low)))
    flat = find_zeros(lambda at: ln_V(at + _HALF_STEP) - ln_V(at - _HALF_STEP), y)[::-1]
    V = ln_V(flat)
    flat = flat[V < math.log(FASTEST)]
    V = V[V < math.log(FASTEST)]
    bends = ln_V(flat + _BEND) + ln_V(flat - _BEND) - 2.0 * V
    return TurningPoints(np.exp(V), states.curve.temperature_of(flat), bends < 0.0)


def conductance(
    R: Numbers,
    *,
    film: Numbers = DEFAULT_FILM,
    thickness: Numbers | None = None,
    conductivity: Numbers | None = None,
    core: Literal["cooled", "insulated"] = "insulated",
) -> Any:
    """Return the heat that a cylinder gives off per kelvin of its mean temperature, from film and
    conduction.

    Heat arises evenly in a solid cylinder, or in a cover of which the other side is at a core; it
    is conducted to the surface (in series with the film) and, of a cooled core, to the core too (in
    parallel).  The mean temperature follows in closed form, of a cover as of a slab of mean radius
    R - thickness/2.

    Parameters
    ----------
    R : radius of the surface, m, > 0; each number may be an array, and they broadcast.
    film : film coefficient of the surface, W/(m2 K), > 0; default 20, of a roller that turns in
        air: from 10 (slow, in still air) to 50 (10 m/s).
    thickness : of the cover, m, > 0, below R; None: a solid cylinder.
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
        Values out of range, a thickness of R or more, a cooled core without thickness and
        conductivity.

    Examples
    --------
    >>> import viscoroll as vr
    >>> round(vr.conductance(0.1, film=20.0), 3)  # 2 pi R film
    12.566
    """
    check_choice("core", core, "cooled", "insulated")
    given: dict[str, Any] = {
        "R": R,
        "film": film,
        "thickness": thickness,
        "conductivity": conductivity,
    }
    arrays = {
        name: check_array(name, x, unit=SI, above=0.0)[()]
        for name, x in given.items()
        if x is not None
    }
    broadcast_shape(**{name: np.asarray(array) for name, array in arrays.items()})
    R = arrays["R"]
    film = arrays["film"]
    h: Any = arrays.get("thickness")
    k: Any = arrays.get("conductivity")
    if core == "cooled" and (h is None or k is None):
        raise described_error(
            "core", "is 'cooled'", "'insulated' without a thickness and a conductivity"
        )
    if h is not None and np.any(h >= R):
        raise ParameterError("thickness", h, f"below R = {R}")
    width = 2.0 * math.pi * (R if h is None else R - 0.5 * h)
    found = width * film
    if h is None and k is not None:
        found = 1.0 / (1.0 / found + 1.0 / (8.0 * math.pi * k))
    elif k is not None:
        biot = film * h / k
        insulated = found / (1.0 + biot / 3.0)
        found = (
            insulated if core == "insulated" else width * 12.0 * k / h * (1.0 + biot) / (4.0 + biot)
        )
    return found if np.ndim(found) else float(found)


def uniform_temperature(film: float, thickness: float, conductivity: float) -> Assumption:
    """State whether one temperature stands for a cover: whether heat is conducted in it faster than
    it leaves it.

    Parameters
    ----------
    film : film coefficient, W/(m2 K), > 0.
    thickness : of the cover, m, > 0, on a core that takes no heat; of a solid cylinder its radius.
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
    given = {"film": film, "thickness": thickness, "conductivity": conductivity}
    film, thickness, conductivity = (
        check_number(name, x, unit=SI, above=0.0) for name, x in given.items()
    )
    biot = film * thickness / conductivity
    above = 100.0 * ((1.0 + 0.5 * biot) / (1.0 + biot / 3.0) - 1.0)
    return Assumption(
        biot <= BIOT_LIMIT,
        biot,
        f"the Biot number is {biot:.2g}: the hottest point is {above:.2g} % of the rise above the "
        "mean temperature; "
        f"up to {BIOT_LIMIT} (10 %) one temperature stands for the body",
    )
