"""The temperatures at which a roller runs: :func:`temperature`, all equilibria of heat with their
stability.
"""

from __future__ import annotations

import warnings
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ..contact_mechanics.contact_table import (
    complete,
    computed_fields,
    evaluate_law,
    pure_rolling_fields,
)
from ..contact_mechanics.model_warnings import warn_of_contact
from ..contact_mechanics.parameters import Roller, resolve_model
from ..contact_mechanics.steady import steady
from ..contact_mechanics.steady_loads import loads_of
from ..contact_mechanics.steady_result import Equilibria, pad
from ..contact_mechanics.steady_states import Field, states_at
from ..core.checks import Floats, Integers, Numbers
from ..core.drive_arguments import make_dimensionless
from ..core.errors import ModelWarning, described_error
from ..core.labels import Labels, strip_labels
from ..laws.law_table import LawTable
from .heat_balance import Balance, Zeros, zeros_of
from .heated_bodies import HeatStates, heat_states

if TYPE_CHECKING:
    import xarray as xr

#: Temperature up to which equilibria under a given load are looked for, degrees Celsius: rubbers
#: char below it.  At a given speed the loss bounds the temperature.
HOTTEST = 500.0
#: No kappa M exceeds this: the pressure acts at most half the contact length at rest ahead of the
#: axis.
_MOST = 0.5
_MOMENTS = "M", "M_half_space", "M_cylinder"


class Temperatures(Equilibria):
    """Equilibria of heat of a roller, the result of :func:`viscoroll.temperature`, in SI units per
    m of its length.

    The last axis counts the equilibria of a state by rising temperature; shorter lists are padded
    with NaN (``stable``: False).  The axes before it are those of the states; of one state there
    are none.

    Attributes
    ----------
    temperature : of the body that relaxes (of two of one material: of both), degrees Celsius.
    stable : whether the temperature returns after a small disturbance; under a given load also the
    speed.
    V : speed, m/s, given or of the load at that temperature.
    C_rr, M, M_half_space, M_cylinder : rolling resistance at that temperature.
    loss, loss_slip : power lost, W/m: all of it, and that in slip (0 of a freely rolling cylinder).
    measured : whether the material was measured at the rates of the contact; True without data.
    count : number of equilibria of each state, an int for one state.
    reason : "" where an equilibrium lies within the ranges of shift and data, else why not, for
    each state.

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

    def __init__(self, values: dict[str, Any], reason: Any, labels: Labels | None) -> None:
        """Keep the fields by name, their ``reason`` and the ``labels`` of the arguments."""
        super().__init__(values, title=self._heading, si=True)
        self.reason = reason
        self._labels = labels

    def to_xarray(self) -> xr.Dataset:
        """Return the equilibria as a dataset of xarray, with names and units as attributes.

        Returns
        -------
        xarray.Dataset
            Over the axes of the states (of one state none; named as in labelled arguments, else
            ``state``) and
            ``equilibrium``: the fields of this result, ``stable`` and ``measured`` as 0 or 1;
            ``count`` over the axes of the states alone.  ``reason`` is left out.

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
        one material; of such each loses half of M, and both have one temperature.
    V : speed, m/s, any sign.  Alone it is that of a freely rolling cylinder, without loss in slip;
        with one of force and torque (or a slope, which counts as the force) the loss in slip heats
        too.  None: the speed follows from the load at each temperature, as in :func:`steady`.
    ambient : temperature of the surroundings, degrees Celsius.
    conductance : heat that the body gives off per kelvin, W/(m K), > 0
    (:func:`viscoroll.conductance`).
    force, torque, slope : loads as in :func:`steady`, numbers or arrays.
    slip_share : part of the loss in slip that heats the cylinder, in [0, 1]; the rest heats the
    base.

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
        materials that relax, a vertical shift of a cover, beside an elastic body, or under a given
        load, neither V nor a load; and as :func:`steady`.

    Warns
    -----
    ModelWarning
        An equilibrium at which the transit frequency is outside the band in which the material was
        measured.

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
    (roller, scene, scale) = resolve_model(roller, "temperature", slope=slope)
    driven = {"force": force, "torque": torque, "slope": slope}
    plain, labels = strip_labels(
        {"V": V, "ambient": ambient, "conductance": conductance} | driven, scale
    )
    driven = {name: plain.pop(name) for name in driven}
    found = {name: value for name, value in driven.items() if value is not None}
    if plain["V"] is None and not found:
        raise described_error(
            "V", "is not given", "given, or a force, torque or slope from which it follows"
        )
    states = heat_states(roller, scene, "temperature", plain | found, slip_share)
    if states.V is None:
        rows, zeros = _under_load(level, states, driven)
    else:
        rows, zeros = _at_speed(states, driven if found else None)
    result = _pack(states, zeros, rows, labels)
    warn_of_contact(roller, rows["V"] * rows["a_T"])
    return result


def _at_speed(states: HeatStates, driven: dict[str, Any] | None) -> tuple[dict[str, Floats], Zeros]:
    """Return the fields of the equilibria at given speeds, and where they are.

    states: the states, with V.
    driven: force, torque and slope as :func:`temperature` has them; None: the cylinder rolls
    freely.
    Returns (name -> values, (m,), in SI units, with a_T, which is NaN beyond the range of the
    shift; the zeros).
    """
    V: Any = states.V
    balance = free_balance(states, V)
    if driven is None:
        zeros = zeros_of(balance)
        return rolling_rows(states, zeros.state, V[zeros.state], zeros.theta), zeros
    scale = states.roller.scale
    force, torque = (make_dimensionless(name, driven[name], scale) for name in ("force", "torque"))
    loads = loads_of(states.scene, force, torque, driven["slope"], np.ones(states.shape))

    def curve(n: Integers, x: Floats) -> Floats:
        """Return kappa times the parts of M and of |delta Q| that heat the body, divided by P V.

        n: indices of the states, (m,).
        x: log2(kappa V a_T) of each, (m,).
        Returns (m,), dimensionless.  The slip is left out where the friction does not suffice; an
        equilibrium there is dropped later.
        """
        found = states_at(states.law, loads, n, np.sign(V[n]), np.exp2(x) / loads.kappa[n]).rows
        delta = np.nan_to_num(found[Field.DELTA])
        rolling = np.abs(found[Field.M_HALF_SPACE] + (1.0 + delta) * found[Field.M_CYLINDER])
        return loads.kappa[n] * (
            states.body.part * rolling + states.body.slip * np.abs(delta * found[Field.Q])
        )

    power = balance.power / states.body.part
    hottest = np.full(V.size, HOTTEST)
    zeros = zeros_of(replace(balance, curve=curve, law=None, power=power, hottest=hottest))
    n = zeros.state
    rows = rolling_rows(states, n, V[n], zeros.theta)
    # a cylinder at rest has no slip; a speed of 1 stands for it
    speed = np.abs(V[n]) * np.nan_to_num(rows["a_T"], nan=1.0) / states.unit[n]
    found = states_at(states.law, loads, n, np.sign(V[n]), np.where(V[n] == 0.0, 1.0, speed)).rows
    power = np.where(V[n] == 0.0, 0.0, found[Field.DELTA]) * V[n] * states.load[n]
    slip = np.abs(found[Field.Q] * power)
    # the cylinder turns at omega = V (1 + delta)/R
    return rows | {
        "loss": rows["loss"] + found[Field.M_CYLINDER] * power + slip,
        "loss_slip": slip,
    }, zeros


def free_balance(states: HeatStates, V: Any) -> Balance:
    """Return the balance of freely rolling states at speeds V, m/s, any sign, a number or (n,)."""
    speed = np.abs(V)
    power = states.body.part * states.load * speed / states.kappa
    # at rest no power depends on x
    x_0 = np.log2(states.kappa * np.where(speed == 0.0, 1.0, speed / states.unit))
    hottest = states.ambient + _MOST * power / states.conductance
    law = states.law

    def curve(n: Integers, x: Floats) -> Floats:
        if isinstance(law, LawTable):
            return pure_rolling_fields(law, np.exp2(x), "M")[0]
        return evaluate_law(
            law, [states.materials[n], 1.0, 1.0, np.exp2(x), 0.0], x.shape, False, ("M",)
        )[0]

    kept = law if isinstance(law, LawTable) else None
    return Balance(
        curve=curve,
        law=kept,
        shift=states.curve,
        x_0=x_0,
        power=power,
        conductance=states.conductance,
        ambient=states.ambient,
        hottest=hottest,
    )


def rolling_rows(states: HeatStates, n: Integers, V: Floats, theta: Floats) -> dict[str, Floats]:
    """Return the fields of freely rolling states at given speeds and temperatures.

    states: all states.
    n: indices of the states that are computed, (m,).
    V: speeds, m/s, any sign, (m,).
    theta: temperatures, degrees Celsius, (m,).
    Returns name -> values, (m,), in SI units: V, temperature, C_rr, M and its parts, loss,
    loss_slip (0) and a_T, which is NaN, as are the fields of the contact, outside the range of the
    shift.
    """
    a_T, root_b = states.curve.factors(theta)
    law = states.law
    known = np.isfinite(a_T)
    unit = states.R[n] / (
        states.roller.T_ref * np.where(known, a_T, 1.0)
    )  # as for the Cylinder of this temperature
    kappa = states.kappa[n] * np.where(known, root_b, 1.0)
    computed = computed_fields(_MOMENTS, law.unlike if isinstance(law, LawTable) else True)
    arrays = [states.materials[n], kappa, states.mu[n], V / unit, 0.0]
    contact = complete(
        _MOMENTS, computed, evaluate_law(law, arrays, n.shape, False, computed), n.shape
    )
    M = np.where(known, contact["M"], np.nan)
    rows = {
        name: np.where(known, each, np.nan) * (states.load[n] * states.R[n])
        for name, each in contact.items()
    }
    more = {"V": V, "temperature": theta, "C_rr": M, "a_T": a_T, "loss": states.load[n] * V * M}
    return rows | more | {"loss_slip": np.zeros(n.size)}


def _under_load(
    level: Any, states: HeatStates, driven: dict[str, Any]
) -> tuple[dict[str, Floats], Zeros]:
    """Return the fields of the equilibria under given loads, where the speed follows from the
    temperature.

    level: the roller on no slope.
    states: the states, without V.
    driven: force, torque and slope as :func:`temperature` has them.
    Each branch of M(V) = force + torque/R at the reference is a balance of its own, in which the
    speed is V_0/a_T.
    Returns the fields and the zeros as :func:`_at_speed`; stable are those of a stable speed alone.
    """
    if states.body.material.vertical_shift is not None:
        raise described_error(
            "vertical_shift", "is given", "left out where the speed follows from the load: give V"
        )
    force = 0.0 if driven["force"] is None else driven["force"]
    driven = driven | {"force": np.broadcast_to(force, states.shape)}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)  # of speeds at the reference
        found = steady(level, **driven)
    fields = {name: found[name] for name in ("V", "stable", *_MOMENTS)} | vars(found.loss)
    n, branch = np.nonzero(np.nan_to_num(found.V).reshape(states.load.size, -1))
    at = {name: np.reshape(x, (states.load.size, -1))[n, branch] for name, x in fields.items()}
    rolling = at["half_space"] + at["cylinder"]
    power = states.body.part * rolling + states.body.slip * at["slip"]
    zeros = zeros_of(
        Balance(
            curve=lambda _, x: np.exp2(-x),
            law=None,
            shift=states.curve,
            x_0=0.0 * power,
            power=power,
            conductance=states.conductance[n],
            ambient=states.ambient[n],
            hottest=np.full(n.size, HOTTEST),
        )
    )
    a_T = states.curve.factors(zeros.theta)[0]
    at |= {
        "loss": rolling + at["slip"],
        "loss_slip": at["slip"],
        "C_rr": at["M"] / (states.load * states.R)[n],
    }
    rows = {name: at[name][zeros.state] for name in ("C_rr", *_MOMENTS)}
    rows |= {name: at[name][zeros.state] / a_T for name in ("V", "loss", "loss_slip")}
    rows |= {"temperature": zeros.theta, "a_T": a_T}
    return rows, Zeros(n[zeros.state], zeros.theta, zeros.stable & at["stable"][zeros.state])


def _pack(
    states: HeatStates, zeros: Zeros, rows: dict[str, Floats], labels: Labels | None
) -> Temperatures:
    """Return the result of the equilibria of states, padded to arrays (states..., equilibria).

    states: the states.
    zeros, rows: the equilibria, in any order, and their fields, (m,) each.  Equilibria with a NaN
    in a_T or the loss are dropped, and named in the reason of a state that has no other.
    labels: axes and coordinates of the arguments; None without.
    Returns the :class:`Temperatures`, each row ascending in temperature, padded with NaN.
    """
    inside = within_data(states, rows["V"] * rows["a_T"])
    known = np.isfinite(rows["a_T"] + rows["loss"])
    reason = _reasons(states, zeros, known, inside, rows)
    order = np.lexsort((zeros.theta, zeros.state))
    order = order[known[order]]
    state = zeros.state[order]
    count = np.bincount(state, minlength=states.load.size)
    table = np.array([*(rows[name] for name in Temperatures._rows), zeros.stable, inside])[:, order]
    *fields, stable, measured = pad(table, state, count, states.shape)
    found: dict[str, Any] = dict(zip(Temperatures._rows, fields, strict=True))
    found |= {"stable": stable == 1.0, "measured": measured == 1.0}
    found["count"] = count.reshape(states.shape) if states.shape else int(count[0])
    if labels is not None:
        axes = {"count": ()}
        found = {
            name: labels.apply(name, each, *axes.get(name, ("equilibrium",)))
            for name, each in found.items()
        }
    return Temperatures(found, reason.reshape(states.shape) if states.shape else reason[0], labels)


def within_data(states: HeatStates, speed: Floats) -> Any:
    """Return whether the speeds lie in the range of the data of the material.

    speed: V a_T, speeds reduced to the reference temperature, m/s, (n,).
    Returns booleans, (n,); True at V = 0 and for a material without data.
    """
    low, high = states.roller.body_data.measured_speeds or (0.0, np.inf)
    size = np.abs(speed)
    return (size == 0.0) | (size >= low) & (size <= high)


def _reasons(
    states: HeatStates, zeros: Zeros, known: Any, inside: Any, rows: dict[str, Floats]
) -> Any:
    """Return the reasons why states have no equilibrium within the ranges of shift and data.

    states: the states.
    zeros, rows: the equilibria found and their fields, (m,) each.
    known: whether a_T and the loss of each equilibrium are numbers, (m,).
    inside: whether its speed lies within the data, (m,).
    Returns texts, (states,), objects; "" for a state that has an equilibrium.
    """
    found = np.full(states.load.size, "", object)
    good = np.bincount(zeros.state[known & inside], minlength=found.size)
    for n in (good == 0).nonzero()[0].tolist():
        own = np.flatnonzero(zeros.state == n)
        if not own.size:
            found[n] = (
                f"no temperature up to {HOTTEST:g} degrees Celsius balances: it runs away, or none "
                "is steady"
            )
            continue
        at = own[np.argmin(zeros.theta[own])]
        theta = f"{zeros.theta[at]:.5g} degrees Celsius"
        if not np.isfinite(rows["a_T"][at]):
            found[n] = f"only {theta} balances, beyond the shift's {states.curve.high:g}"
        elif not known[at]:
            found[n] = f"the friction does not suffice at {theta}, which balances"
        else:
            found[n] = (
                f"only {theta} balances, where the rates of the contact lie outside the measured "
                "band"
            )
    return found
