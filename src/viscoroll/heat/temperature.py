"""The temperatures at which a roller runs: :func:`temperature`, all equilibria of heat with their
stability.
"""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any

import numpy as np

from ..contact_mechanics.model_warnings import warn_of_contact
from ..contact_mechanics.parameters import Roller, resolve_model
from ..contact_mechanics.steady import steady
from ..contact_mechanics.steady_result import Equilibria, pad
from ..core import Floats, Labels, ModelWarning, Numbers, described_error, strip_labels
from .heat_balance import Zeros, zeros_at_speed, zeros_of
from .heated_bodies import MOMENTS, HeatStates, heat_states

if TYPE_CHECKING:
    import xarray as xr

#: Temperature up to which equilibria under a given load are looked for, degrees Celsius: rubbers
#: char below it.  At a given speed the loss bounds the temperature.
HOTTEST = 500.0
#: Fields that are divided by a_T under a given load -> those of ``steady`` at the reference.
_PER_TIME = {"V": "V", "loss": "loss", "loss_slip": "slip"}


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
    V : speed, m/s, any sign.  Alone it is that of a freely rolling cylinder, of half-spaces without
        loss in slip; with one of force and torque (or a slope, which counts as the force) the loss
        in slip heats too.  None: the speed follows from the load at each temperature, as in
        :func:`steady`.
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
        materials that relax, a vertical shift of a cover, under a load beside an elastic body,
        or where V follows from the load, neither V nor a load; and as :func:`steady`.

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
    driven = {name: plain[name] for name in driven}
    loaded = any(value is not None for value in driven.values())
    if V is None and not loaded:
        raise described_error(
            "V", "is not given", "given, or a force, torque or slope from which it follows"
        )
    beside = driven if loaded and V is not None else None
    states = heat_states(roller, scene, "temperature", plain, slip_share, beside)
    if states.V is None:
        rows, zeros = _under_load(level, states, driven)
    else:
        every = np.arange(states.load.size)
        zeros = zeros_at_speed(states, every, states.V, hottest=HOTTEST if loaded else None)
        rows = states.fields(zeros.state, zeros.theta, states.V[zeros.state])
    warn_of_contact(roller, rows["V"] * rows["a_T"])
    return _pack(states, zeros, rows, labels)


def _under_load(
    level: Any, states: HeatStates, driven: dict[str, Any]
) -> tuple[dict[str, Floats], Zeros]:
    """Return the fields of the equilibria under given loads, where the speed follows from the
    temperature.

    level: the roller on no slope.
    states: the states, without V.
    driven: force, torque and slope as :func:`temperature` has them.
    Each branch of M(V) = force + torque/R at the reference is a balance of its own, in which the
    speed is V_0/a_T and the loss w_0/a_T.
    Returns the fields, as :meth:`.HeatStates.fields`, and the zeros; stable are those of a stable
    speed alone.
    """
    if states.body.material.vertical_shift is not None:
        allowed = "left out where the speed follows from the load, whose branches b_T moves: give V"
        raise described_error("vertical_shift", "is given", allowed)
    force = 0.0 if driven["force"] is None else driven["force"]
    driven = driven | {"force": np.broadcast_to(force, states.shape)}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)  # of speeds at the reference
        found = steady(level, **driven)
    fields = {name: found[name] for name in ("V", "stable", *MOMENTS)} | vars(found.loss)
    n, branch = np.nonzero(np.nan_to_num(found.V).reshape(states.load.size, -1))
    at = {name: np.reshape(x, (states.load.size, -1))[n, branch] for name, x in fields.items()}
    rolling = at["half_space"] + at["cylinder"]
    at["loss"] = rolling + at["slip"]
    power = states.body.part * rolling + states.body.slip * at["slip"]
    zeros = zeros_of(
        lambda k, theta: power[k] / states.curve.at(theta)[0],
        states.curve,
        states.ambient[n],
        states.conductance[n],
        np.full(n.size, HOTTEST),
    )
    k = zeros.state
    a_T = states.curve.factors(zeros.theta)[0]
    rows = {name: at[name][k] for name in MOMENTS}
    rows |= {name: at[of][k] / a_T for name, of in _PER_TIME.items()}
    rows["temperature"] = zeros.theta
    rows["a_T"] = np.where(zeros.theta > states.curve.high, np.nan, a_T)
    rows["C_rr"] = rows["M"] / (states.load * states.R)[n[k]]
    return rows, Zeros(n[k], zeros.theta, zeros.stable & at["stable"][k])


def _pack(
    states: HeatStates, zeros: Zeros, rows: dict[str, Floats], labels: Labels | None
) -> Temperatures:
    """Return the result of the equilibria of states, padded to arrays (states..., equilibria).

    zeros, rows: the equilibria and their fields, unsorted; those with a NaN in the loss are named
    and dropped.
    """
    low, high = states.roller.body_data.measured_speeds or (0.0, np.inf)
    speed = np.abs(rows["V"] * rows["a_T"])  # reduced to the reference
    inside = (speed == 0.0) | (speed >= low) & (speed <= high)
    known = np.isfinite(rows["loss"] + rows["a_T"])
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
        found = {
            name: labels.apply(name, each, *(() if name == "count" else ("equilibrium",)))
            for name, each in found.items()
        }
    return Temperatures(found, reason.reshape(states.shape) if states.shape else reason[0], labels)


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
