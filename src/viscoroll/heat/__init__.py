"""Heat of rolling: temperatures of a roller, its warming, and the limits of load and speed.

Here are :func:`temperature`, all equilibria of heat with their stability, and
:func:`pair_temperatures` of two bodies with a temperature each; :mod:`.heat_limits` has the others.

Equilibria are zeros of the balance of heat: loss less heat given off, over the temperature.  With
the rise r = theta - ambient they are those of f(r) = w(ambient + r)/conductance - r, which is > 0
below ambient.  w changes with log2 a_T, so that nodes of the temperature are even in it.

The law of a pair depends on kappa V a_T of one body and on the ratio of both times, so that each
pair of temperatures has a law of its own, of which the rows are made where they are read.
"""

import functools
import warnings
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from ..contact_mechanics import (
    Equilibria,
    Roller,
    evaluate_law,
    pad,
    resolve_model,
    steady,
    warn_of_contact,
    zeros_between,
)
from ..core import (
    Booleans,
    Dataset,
    Floats,
    Integers,
    Labels,
    ModelWarning,
    Numbers,
    check_number,
    described_error,
    strip_labels,
)
from ..laws import LawTable
from ..materials import check_both
from .heated_bodies import (
    FARTHEST,
    MOMENTS,
    NODES,
    HeatStates,
    ShiftCurve,
    check_ambient,
    curve_of_moments,
    heat_states,
    shift_curve,
    warm_pair,
)

# --- Zeros of the balance of heat ---

#: states of a block: arrays over nodes and states then stay in the cache
_BLOCK = 256


class Zeros(NamedTuple):
    """Zeros of balances f (module), one after another.

    state : index of the state, (m,).
    theta : temperature, degrees Celsius, (m,).
    stable : whether f falls with temperature there, (m,).
    """

    state: Integers
    theta: Floats
    stable: Booleans


def zeros_at_speed(
    states: HeatStates, n: Integers, V: Floats, more: Any = 1.0, hottest: float | None = None
) -> Zeros:
    """Find all equilibria of states at given speeds.

    n: indices of the states, (m,).
    V: their speeds, m/s, any sign, (m,).
    more: factor of their loads, as in :meth:`.HeatStates.heat`, a number or (m,).
    hottest: temperature up to which equilibria are sought, degrees Celsius; None: that which the
        largest loss of free rolling can reach.
    Returns the :class:`Zeros`, whose ``state`` is an index into n.
    """
    # l0 grows as the root of the load
    kappa = states.kappa[n] / np.sqrt(more)
    ambient = states.ambient[n]
    conductance = states.conductance[n]
    speed = np.abs(V)
    # for kappa M = 1, which none exceeds: the pressure acts at most half the contact length at rest
    # ahead of the axis; twice that, for b_T down to 1/4.  The loss is P |V| M
    rise = states.body.part * states.load[n] * more * speed / (kappa * conductance)
    top = ambient + rise if hottest is None else np.full(n.size, hottest)
    curve = states.curve
    if isinstance(states.law, LawTable) and states.loads is None and curve.slope:
        from ..kernels.law.heat_zeros import HeatRequest

        # at rest any speed will do, as the rise is 0
        x = kappa * np.where(speed == 0.0, 1.0, speed * states.roller.T_ref / states.R[n])
        # log2 of kappa V a_T is log2 x - own + slope/(theta - pole): x_hot is its limit at high
        # theta; the loss is conductance times power times kappa M
        request = HeatRequest(
            x_hot=np.log2(x) - curve.own,
            ambient=ambient,
            power=rise,
            hottest=top,
            pole=curve.pole,
            slope=curve.slope,
            curve=curve_of_moments(states.law),
            density=NODES,
            farthest=FARTHEST,
        )
        return _zeros_by_kernel(states.law, request)

    def heat(k: Integers, theta: Floats) -> Floats:
        return states.heat(n[k], theta, V[k], more if np.ndim(more) == 0 else more[k])

    return zeros_of(heat, curve, ambient, conductance, top)


def _zeros_by_kernel(law: LawTable, request: Any) -> Zeros:
    """Return the zeros of half-spaces of one law that roll freely, whose shift is a WLF or an
    Arrhenius.

    law: the law at the reference.
    request: what the kernel reads of the n states, a :class:`.heat_zeros.HeatRequest`.
    """
    from ..kernels.law.heat_zeros import heat_loop

    size = count = 3 * request.ambient.size
    # the kernel counts all zeros, and writes those for which there is room
    while count >= size:  # some states have more zeros than three
        size = count + 1
        number = np.empty(size, np.int64)
        above = np.empty(size)
        stable = np.empty(size, bool)
        count = heat_loop(law.record, request, number, above, stable)
    n = number[:count]
    return Zeros(n, request.ambient[n] + above[:count], stable[:count])


def zeros_of(
    heat: Callable[[Integers, Floats], Floats],
    curve: ShiftCurve,
    ambient: Floats,
    conductance: Floats,
    hottest: Floats,
) -> Zeros:
    """Find all zeros of the balances of states (:func:`.rolling_resistance.zeros_between`).

    heat: function (indices of states, temperatures) -> heat of the body, W/m, (m,) each.
    curve: shift of the body, which places the nodes.
    ambient, conductance: of the states, degrees Celsius and W/(m K), (n,) each; n may be 0.
    hottest: temperature up to which zeros are sought, degrees Celsius, (n,).
    Returns the :class:`Zeros`, to the rounding of f.
    """

    def rest(first: int, rise: Floats, k: Integers) -> Floats:
        n = first + k
        return heat(n, ambient[n] + rise) / conductance[n] - rise

    parts = [(np.empty(0, np.int64), np.empty(0), np.empty(0, bool))]
    for first in range(0, ambient.size, _BLOCK):
        balance = functools.partial(rest, first)
        around = ambient[first : first + _BLOCK]
        # a margin of 1 K, so that a zero at either end lies between nodes
        nodes = curve.nodes(around.min() - 1.0, hottest[first : first + _BLOCK].max() + 1.0)
        rise = nodes - around[:, None]
        k = np.repeat(np.arange(around.size), nodes.size)
        f = balance(rise.ravel(), k).reshape(rise.shape)
        # stable where f falls
        n, zero, stable = zeros_between(balance, rise, f)
        parts.append((first + n, around[n] + zero, stable))
    n, theta, stable = (np.concatenate(each) for each in zip(*parts))
    found = theta <= hottest[n]
    return Zeros(n[found], theta[found], stable[found])


# --- Temperatures at which a roller runs ---

#: Temperature up to which equilibria under a given load are looked for, degrees Celsius: rubbers
#: char below it.  At a given speed the loss bounds the temperature.
HOTTEST = 500.0


class Temperatures(Equilibria):
    """Equilibria of heat, the result of :func:`viscoroll.temperature`, in SI units per m of length.

    The last axis counts the equilibria of a state by rising temperature; shorter lists are padded
    with NaN (``stable``: False).  The axes before it are those of the states, none of one state.

    Attributes
    ----------
    temperature : of the body that relaxes (of two of one material: of both), degrees Celsius.
    stable : whether temperature (under a load also the speed) returns after a small disturbance.
    V : speed, m/s, given or of the load at that temperature.
    C_rr, M, M_half_space, M_cylinder : rolling resistance at that temperature.
    loss, loss_slip : power lost, W/m: all of it, and that in slip (0 of a freely rolling cylinder).
    measured : whether the material was measured at the rates of the contact; True without data.
    count : number of equilibria of each state, an int for one state.
    reason : of each state: "" with an equilibrium within ranges of shift and data, else why not.

    Examples
    --------
    >>> import viscoroll as vr
    >>> rubber = vr.Material(
    ...     3e6, 0.49, vr.Prony([2.0], [1.0]), 0.01, temperature=20.0, shift=vr.WLF(T0=-50.0)
    ... )
    >>> roller = vr.Cylinder(
    ...     R=0.1, m=60.0, material=rubber, base=vr.Material.rigid(), mu=0.6, load=2e4
    ... )
    >>> found = roller.temperature([1.0, 5.0], ambient=20.0, conductance=6.0)
    >>> found.temperature.shape, bool(found.stable.all())
    ((2, 1), True)
    """

    _heading = "Equilibria of heat"
    _rows = "V", "temperature", "C_rr", "M", "M_half_space", "M_cylinder", "loss", "loss_slip"
    _ranges = "V", "temperature", "C_rr"

    def __init__(
        self, states: HeatStates, zeros: Zeros, rows: dict[str, Floats], labels: Labels | None
    ) -> None:
        """Pad the equilibria of states to arrays (states..., equilibria).

        states, zeros: the states of the call, and the equilibria, (m,), unsorted.
        rows: their fields by name, (m,) each; an equilibrium with NaN in a_T or in M is
            dropped, and stated as the reason where no other one is left.
        labels: labels of the arguments, which the fields get; None without.
        """
        low, high = states.roller.body_data.measured_speeds or (0.0, np.inf)
        speed = np.abs(rows["V"] * rows["a_T"])  # reduced to the reference
        inside = (speed == 0.0) | (speed >= low) & (speed <= high)
        known = np.isfinite(rows["M"] + rows["a_T"])
        reason = _reasons(states, zeros, known, inside, rows)
        order = np.lexsort((zeros.theta, zeros.state))
        order = order[known[order]]
        state = zeros.state[order]
        count = np.bincount(state, minlength=states.load.size)
        table = np.array([*(rows[name] for name in self._rows), zeros.stable, inside])[:, order]
        *fields, stable, measured = pad(table, count, states.shape)
        found = dict(zip(self._rows, fields))
        found |= {"stable": stable == 1.0, "measured": measured == 1.0}
        found["count"] = count.reshape(states.shape) if states.shape else int(count[0])
        super().__init__(found, labels, si=True)
        self.reason = reason.reshape(states.shape)[()]

    def to_xarray(self) -> Dataset:
        """Return the equilibria as a dataset of xarray, with names and units as attributes.

        Returns
        -------
        xarray.Dataset
            Its last axis is ``equilibrium``; the axes before it are those of the states, of which
            one state has none.  They are named as in :meth:`viscoroll.Steady.to_xarray`.  Variables
            are the fields of this result, ``stable`` and ``measured`` as 0 or 1, and ``count``,
            over the axes of the states alone.  ``reason`` is left out.

        Examples
        --------
        >>> import viscoroll as vr
        >>> rubber = vr.Material(
        ...     3e6, 0.49, vr.Prony([2.0], [1.0]), 0.01, temperature=20.0, shift=vr.WLF(T0=-50.0)
        ... )
        >>> roller = vr.Cylinder(
        ...     R=0.1, m=60.0, material=rubber, base=vr.Material.rigid(), mu=0.6, load=2e4
        ... )
        >>> roller.temperature(1.0, ambient=20.0, conductance=6.0).to_xarray()["temperature"].attrs[
        ...     "units"
        ... ]
        'degC'
        """
        return self._dataset({name: self[name] for name in self.keys() if name != "count"})


def temperature(
    roller: Roller,
    V: Numbers | None = None,
    *,
    ambient: Numbers,
    conductance: Numbers,
    force: Numbers | None = None,
    torque: Numbers | None = None,
    slope: Numbers | None = None,
    slip_share: float = 0.5,
) -> Temperatures:
    """Find the temperatures at which a roller runs: every one at which its loss equals the heat
    that it gives off.

    For each equilibrium the result says whether it is stable.  The arguments broadcast against each
    other and against array parameters of the roller.

    Parameters
    ----------
    roller : a :class:`Cylinder` whose material has a ``shift``.  One body relaxes, or both are of
        one material and thickness: each has half of the loss, and both have one temperature.
    V : speed, m/s, any sign.  Alone it is that of a freely rolling cylinder, without loss in slip
        where shear does not act on the pressure; with one of force and torque (or a slope, which
        counts as the force) the loss in slip heats too.  None: the speed follows from the load at
        each temperature, as in :func:`steady`.
    ambient : temperature of the surroundings, degrees Celsius.
    conductance : heat given off per kelvin, W/(m K), > 0 (:func:`viscoroll.conductance`).
    force, torque, slope : loads as in :func:`steady`, numbers or arrays.
    slip_share : part of the loss in slip, in [0, 1], that heats the cylinder, not the base.

    Returns
    -------
    Temperatures
        Of one state ``temperature``, ``stable``, ``V``, ``C_rr``, ``M``, ``loss`` and the other
        fields as arrays of exactly its equilibria by rising temperature.  Arrays of states have
        that axis after their own, padded with NaN, and the ``count`` of equilibria.

    Raises
    ------
    ParameterError
        A conductance <= 0, an ambient outside the range of the shift, a roller without material,
        shift or relaxation, a shift that does not fall with temperature, two bodies of different
        materials, thicknesses, reference temperatures or shifts that relax, a vertical shift of a
        cover, under a load beside an elastic body, or where V follows from the load, neither V nor
        a load; and as :func:`steady`.

    Warns
    -----
    ModelWarning
        An equilibrium whose transit frequency is outside the band of the material's data.

    Examples
    --------
    >>> import viscoroll as vr
    >>> rubber = vr.Material(
    ...     3e6, 0.49, vr.Prony([2.0], [1.0]), 0.01, temperature=20.0, shift=vr.WLF(T0=-50.0)
    ... )
    >>> roller = vr.Cylinder(
    ...     R=0.1, m=60.0, material=rubber, base=vr.Material.rigid(), mu=0.6, load=2e4
    ... )
    >>> found = vr.temperature(roller, 5.0, ambient=20.0, conductance=6.0)
    >>> bool(abs(found.loss[0] - 6.0 * (found.temperature[0] - 20.0)) < 1e-10 * found.loss[0])
    True

    Notes
    -----
    At a given speed the number of equilibria is odd, and they are alternately stable and unstable;
    two whose kappa V a_T differ by less than rounding may be missed.  The balance holds to 1e-10
    (``tests/test_heat.py``).  One temperature for the body is right where its Biot number is small
    (:func:`viscoroll.uniform_temperature`).
    """
    level = roller
    roller, _, scale = resolve_model(roller, "temperature", slope=slope)
    driven = {"force": force, "torque": torque, "slope": slope}
    given = {"V": V, "ambient": ambient, "conductance": conductance} | driven
    plain, labels = strip_labels(given, scale)
    driven = {name: plain[name] for name in driven}
    loaded = any(value is not None for value in driven.values())
    if V is None and not loaded:
        raise described_error(
            "V",
            "is not given, and neither is a force, torque or slope",
            "given, or one of these three instead",
        )
    beside = driven if loaded and V is not None else None
    states = heat_states(roller, "temperature", plain, slip_share, beside)
    if states.V is None:
        rows, zeros = _under_load(level, states, driven)
    else:
        every = np.arange(states.load.size)
        zeros = zeros_at_speed(states, every, states.V, hottest=HOTTEST if loaded else None)
        rows = states.fields(zeros.state, zeros.theta, states.V[zeros.state])
    warn_of_contact(roller, rows["V"], a_T=rows["a_T"])
    return Temperatures(states, zeros, rows, labels)


def _under_load(
    level: Any, states: HeatStates, driven: dict[str, Any]
) -> tuple[dict[str, Floats], Zeros]:
    """Return the equilibria under given loads, where the speed follows from the temperature.

    level, states: the roller on no slope; the states, without V.
    driven: force, torque and slope as :func:`temperature` has them.
    Each branch of M(V) = force + torque/R at the reference, with speed V_0 and loss w_0, is a
    balance of its own, in which the speed is V_0/a_T and the loss w_0/a_T.
    Returns (fields, as :meth:`.HeatStates.fields`, with the number of "branches" of each state, of
    a speed other than 0; the zeros, stable only where the speed is too).
    Raises ParameterError for a material with a vertical shift, and as :func:`viscoroll.steady`.
    """
    if states.body.material.vertical_shift is not None:
        raise described_error(
            "vertical_shift", "of the Material is given, but V is not", "left out, or V given too"
        )
    # in the shape of all states, as ambient and conductance may have axes that the loads lack
    force = np.broadcast_to(0.0 if driven["force"] is None else driven["force"], states.shape)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)  # of speeds at the reference
        found = steady(level, **driven | {"force": force})
    fields = {name: found[name] for name in ("V", "stable", *MOMENTS)} | vars(found.loss)
    # without padding, which is NaN, and rest, which does not heat
    n, branch = np.nonzero(np.nan_to_num(found.V).reshape(states.load.size, -1))
    at = {name: np.reshape(x, (states.load.size, -1))[n, branch] for name, x in fields.items()}
    rolling = at["half_space"] + at["cylinder"]
    at |= {"loss": rolling + at["slip"], "loss_slip": at["slip"]}
    power = states.body.part * rolling + states.body.slip * at["slip"]
    zeros = zeros_of(
        lambda k, theta: power[k] / states.curve.at(theta)[0],
        states.curve,
        states.ambient[n],
        states.conductance[n],
        hottest=np.full(n.size, HOTTEST),
    )
    k = zeros.state
    a_T = states.curve.factors(zeros.theta)[0]
    rows = {name: at[name][k] for name in MOMENTS}
    rows |= {name: at[name][k] / a_T for name in ("V", "loss", "loss_slip")}
    rows |= {
        "temperature": zeros.theta,
        "a_T": np.where(zeros.theta > states.curve.high, np.nan, a_T),
        "C_rr": rows["M"] / (states.load * states.R)[n[k]],
        "branches": 1.0 * np.bincount(n, minlength=states.load.size),
    }
    return rows, Zeros(n[k], zeros.theta, zeros.stable & at["stable"][k])


def _reasons(
    states: HeatStates, zeros: Zeros, known: Any, inside: Any, rows: dict[str, Floats]
) -> Any:
    """Return the reasons why states have no equilibrium within the ranges of shift and data.

    states, zeros: the states, and the equilibria found, (m,).
    rows: their fields, (m,) each, and under loads "branches", the number of speeds of each state.
    known, inside: whether their a_T and M are numbers, and their speed within the data, (m,).
    Returns texts, (states,), objects; "" for a state that has an equilibrium.
    """
    found = np.full(states.load.size, "", object)
    good = np.bincount(zeros.state[known & inside], minlength=found.size)
    for n in (good == 0).nonzero()[0].tolist():
        own = np.flatnonzero(zeros.state == n)
        if not own.size:
            found[n] = (
                "with this force, torque or slope there is no steady speed other than 0"
                if "branches" in rows and not rows["branches"][n]
                else "the loss exceeds the heat given off at every temperature up to "
                f"{HOTTEST:g} °C: raise conductance, or lower the load or the speed"
            )
            continue
        at = own[np.argmin(zeros.theta[own])]
        where = (
            f"but the shift of the material is defined only up to {states.curve.high:g} °C"
            if not np.isfinite(rows["a_T"][at])
            else "but mu is too small there for the force, torque or slope"
            if not known[at]
            else "but the material was not measured at the transit frequency of that state (speed "
            "divided by contact length)"
        )
        found[n] = f"the heat given off equals the loss at {zeros.theta[at]:.5g} °C, {where}"
    return found


# --- Two bodies with a temperature each ---

#: Nodes of each temperature, evenly spaced in ln a_T: some 0.05 s of contacts at 40 us each.
_NODES = 41
#: Step of difference quotients, K.
_DIFFERENCE = 1e-4
#: Largest residual of a zero over the larger rise, and distance in K within which zeros are one.
_RESIDUAL = 1e-9
_SAME = 1e-5


class PairTemperatures(NamedTuple):
    """Equilibria of heat of two bodies, by rising temperature of the cylinder.

    temperature : of the cylinder and of the base, degrees Celsius, (n, 2).
    stable : whether both return after small disturbances, of bodies of one capacity, (n,).
    C_rr : coefficient of rolling resistance, of the sign of V, (n,).
    loss : of the cylinder and of the base, W/m, (n, 2).
    """

    temperature: Floats
    stable: Booleans
    C_rr: Floats
    loss: Floats


def pair_temperatures(
    roller: Roller, V: float, *, ambient: tuple[float, float], conductance: tuple[float, float]
) -> PairTemperatures:
    """Find the temperatures of two half-spaces that both relax, in free rolling.

    Parameters
    ----------
    roller : a :class:`Cylinder` without arrays and thicknesses; both materials have a ``shift``.
    V : speed, m/s, other than 0.
    ambient, conductance : of the cylinder and of the base, degrees Celsius and W/(m K), as in
        :func:`temperature`.

    Returns
    -------
    PairTemperatures
        Named tuple of ``temperature``, ``stable``, ``C_rr`` and ``loss``.

    Raises
    ------
    ParameterError
        As in :func:`temperature`; a layer, a body that does not relax, arrays.

    Examples
    --------
    >>> import viscoroll as vr
    >>> rubber = vr.Material(
    ...     3e6, 0.49, vr.Prony([2.0], [1.0]), 0.01, temperature=20.0, shift=vr.WLF(T0=-50.0)
    ... )
    >>> roller = vr.Cylinder(R=0.1, m=60.0, material=rubber, mu=0.6, load=2e4)
    >>> found = vr.pair_temperatures(roller, 2.0, ambient=(20.0, 20.0), conductance=(6.0, 30.0))
    >>> bool(found.temperature[0, 0] > found.temperature[0, 1])
    True

    Notes
    -----
    Zeros are sought from the cells of a grid of 41 by 41 temperatures in which both balances change
    their sign; the balances hold to 1e-9 (``tests/test_heat.py``).
    """
    from scipy import optimize

    _, scene, scale = resolve_model(roller, "pair_temperatures")
    pair = roller.body_data and roller.body_data.pair
    fault = ""
    if pair is None:
        fault = "has no Material"
    elif scene.shape:
        fault = f"has arrays of shape {scene.shape}"
    elif pair.covered:
        fault = f"has a thickness of the {pair.covered}"
    elif 1.0 in [body.prony.alpha for body in pair.bodies]:
        fault = "has an elastic or rigid body"
    if fault:
        allowed = "a Cylinder with two viscoelastic Materials without thickness, and no arrays; "
        allowed += "if only one body is viscoelastic, call vr.temperature"
        raise described_error("roller", fault, allowed)
    V = check_number("V", V, unit=scale)
    speed = abs(V)
    around = check_both("ambient", ambient, unit="degC")
    off = check_both("conductance", conductance, unit="W m-1 K-1", above=0.0)
    if not speed:
        raise described_error("V", "is 0, so that rolling makes no heat", "other than 0")
    curves = [shift_curve(body) for body in pair.bodies]
    for at, curve in zip(around, curves):
        check_ambient(at, curve, "ambient")
    load = roller.load  # type: ignore[attr-defined]
    kappa = scene.kappa

    def losses(theta: Floats) -> Floats:
        """Return the loss P |V| M_b/(P R) of each body b, W/m, (2, m), with M_b its part of the
        moment of free rolling without creepage; no shear acts, so that any mu, here 1, will do.

        theta: temperatures of cylinder and base, degrees Celsius, (2, m), which change E' and the
            times: kappa = R/l0 grows like the root of E', and V is divided by R/T_ref of the warm
            pair.
        """
        warm = warm_pair(pair, *(curve.at(at) for curve, at in zip(curves, theta)))
        own = kappa * np.sqrt(warm.E_prime / pair.E_prime)
        index = np.arange(float(theta.shape[1]))
        fields = ("M_cylinder", "M_half_space")
        # index of the pair, kappa, mu, V and delta
        state = [index, own, 1.0, speed * warm.T_ref / scale["R"], 0.0]
        M = evaluate_law(warm.law, state, shape=index.shape, creep_is_omega=False, names=fields)
        return load * speed * M

    def rest(theta: Any) -> Floats:
        """Return ambient + loss/conductance - theta of each body, K, (2, m): 0 in balance."""
        return around[:, None] + losses(theta) / off[:, None] - theta

    def slopes(theta: Any) -> Floats:
        """Return the Jacobian of ``rest`` at temperatures of both, (2, 2)."""
        values = rest(theta[:, None] + _DIFFERENCE * np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]))
        return (values[:, 1:] - values[:, :1]) / _DIFFERENCE

    axes = []
    for at, G, curve in zip(around, off, curves):
        # the loss of a body is at most P |V|/(2 kappa)
        hottest = min(at + 0.5 * load * speed / kappa / G, curve.high)
        ends = np.log2(curve.at(np.array([at, hottest]))[0])
        axes.append(curve.temperature_of(np.linspace(ends[0], ends[1], _NODES)))
    grid = np.array(np.meshgrid(*axes, indexing="ij"))
    F = rest(grid.reshape(2, -1)).reshape(grid.shape) > 0.0
    # (2 balances, cells, cells, 2, 2): cells in which each balance has both signs at the corners
    corners = np.lib.stride_tricks.sliding_window_view(F, (2, 2), axis=(1, 2))
    cells = (corners.any(axis=(3, 4)) & ~corners.all(axis=(3, 4))).all(axis=0)
    found: list[Any] = []
    for start in 0.5 * (grid[:, :-1, :-1] + grid[:, 1:, 1:])[:, cells].T:
        at = optimize.root(lambda theta: rest(theta[:, None])[:, 0], start, jac=slopes, tol=1e-14).x
        good = np.abs(rest(at[:, None])).max() <= _RESIDUAL * np.abs(at - around).max()
        if good and all(np.abs(at - other).max() > _SAME for other in found):
            found.append(at)
    theta = np.array(sorted(found, key=tuple)).reshape(-1, 2)
    loss = losses(theta.T).T
    # capacity dtheta/dt is conductance times ``rest``, of both bodies with one capacity
    rates = [np.linalg.eigvals(off[:, None] * slopes(at)).real.max() for at in theta]
    return PairTemperatures(theta, np.array(rates) < 0.0, loss.sum(axis=1) / (load * V), loss)
