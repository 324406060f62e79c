"""The temperatures at which a roller runs: :func:`temperature`, all equilibria of heat with their stability."""

from __future__ import annotations

import warnings
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ..contact_law.contact_fields import complete, computed_fields
from ..contact_law.contact_table import evaluate_law
from ..contact_law.equilibria.loads import Loads, loads_of
from ..contact_law.equilibria.states import Field, states_at
from ..contact_law.equilibria.steady import steady
from ..contact_law.parameters import Roller, resolve_model
from ..contact_law.validity.model_warnings import warn_of_contact
from ..core.array_types import Floats, Integers, Numbers
from ..core.drive import make_dimensionless
from ..core.errors import ModelWarning, described_error
from ..core.labels import Labels, dataset_axes, strip_labels
from ..core.results import SummaryRow, Values, format_value, unit_of
from ..materials.law.table import LawTable
from .balance import NODES, Balance, Curve, Zeros, hot_curve, peak_of, rolling_curve, zeros_of
from .bodies import HeatStates, heat_states

if TYPE_CHECKING:
    import xarray as xr

#: Temperature up to which equilibria under a given load are looked for, degrees Celsius: rubbers char below it.  At a
#: given speed the loss bounds the temperature.
HOTTEST = 500.0
#: Fields of the result over the equilibria.
_FIELDS = ("V", "temperature", "C_rr", "M", "M_half_space", "M_cylinder", "loss", "loss_slip")
#: Step of x = log2(kappa V) for the slope of a loss with slip.
_STEP = 1e-6


class Temperatures(Values):
    """Equilibria of heat of a roller, the result of :func:`viscoroll.temperature`, in SI units per m of its length.

    The last axis counts the equilibria of a state by rising temperature; shorter lists are padded with NaN
    (``stable``: False).  The axes before it are those of the states; of one state there are none.

    Attributes
    ----------
    temperature : of the body that relaxes (of two of one material: of both), degrees Celsius.
    stable : whether the temperature returns after a small disturbance; under a given load also the speed.
    V : speed, m/s, given or of the load at that temperature.
    C_rr, M, M_half_space, M_cylinder : rolling resistance at that temperature.
    loss, loss_slip : power lost, W/m: all of it, and that in slip (0 of a freely rolling cylinder).
    measured : whether the material was measured at the rates of the contact; True without data.
    count : number of equilibria of each state, an int for one state.
    reason : "" where an equilibrium lies within the ranges of shift and data, else why not, for each state.

    Examples
    --------
    >>> import viscoroll as vr
    >>> rubber = vr.Material(3e6, 0.49, vr.Prony([2.0], [1.0]), 0.01, temperature=20.0, shift=vr.WLF(T0=-50.0))
    >>> roller = vr.Cylinder(R=0.1, m=60.0, material=rubber, base=vr.Material.rigid(), mu=0.6, load=2e4)
    >>> found = roller.temperature([1.0, 5.0], ambient=20.0, conductance=6.0)
    >>> found.temperature.shape, bool(found.stable.all())
    ((2, 1), True)
    """

    def __init__(self, values: dict[str, Any], reason: Any, labels: Labels | None) -> None:
        """Keep the fields by name, their ``reason`` and the ``labels`` of the arguments."""
        super().__init__(values, title="Equilibria of heat", si=True)
        self.reason, self._labels = reason, labels

    def _summary(self) -> tuple[str, list[SummaryRow]]:
        """Return (title; rows): of one state the fields of each equilibrium, of several their number and ranges."""
        if np.ndim(self.count):
            stable = int(np.asarray(self.stable).sum())
            rows = [SummaryRow("equilibria", f"{int(np.sum(self.count))}, {stable} stable")]
            shown = ("V", "temperature", "C_rr")
            rows += [
                SummaryRow(name, format_value(np.asarray(self[name])), unit_of(self._attributes(name)))
                for name in shown
            ]
            return f"Equilibria of heat, {np.size(self.count)} states", rows
        rows = [SummaryRow("reason", self.reason)] if self.reason else []
        for n in range(self.count):
            rows.append(SummaryRow("equilibrium", "stable" if self.stable[n] else "unstable"))
            for name in _FIELDS:
                rows.append(SummaryRow(f"  {name}", f"{float(self[name][n]):.6g}", unit_of(self._attributes(name))))
        return "Equilibria of heat", rows

    def to_xarray(self) -> xr.Dataset:
        """Return the equilibria as a dataset of xarray, with names and units as attributes.

        Returns
        -------
        xarray.Dataset
            Over the axes of the states (of one state none; named as in labelled arguments, else ``state``) and
            ``equilibrium``: the fields of this result, ``stable`` and ``measured`` as 0 or 1; ``count`` over the axes
            of the states alone.  ``reason`` is left out.

        Examples
        --------
        >>> import viscoroll as vr
        >>> rubber = vr.Material(3e6, 0.49, vr.Prony([2.0], [1.0]), 0.01, temperature=20.0, shift=vr.WLF(T0=-50.0))
        >>> roller = vr.Cylinder(R=0.1, m=60.0, material=rubber, base=vr.Material.rigid(), mu=0.6, load=2e4)
        >>> roller.temperature(1.0, ambient=20.0, conductance=6.0).to_xarray()["temperature"].attrs["units"]
        'degC'
        """
        import xarray as xr

        found = {name: np.asarray(self[name]) for name in self.keys() if name != "count"}
        dims, coords = dataset_axes(self._labels, np.shape(self.count), (*found, "count", "equilibrium"))
        data: dict[str, Any] = {
            name: ((*dims, "equilibrium"), each.astype(np.int8) if each.dtype == bool else each, self._attributes(name))
            for name, each in found.items()
        }
        data["count"] = dims, np.asarray(self.count), self._attributes("count")
        return xr.Dataset(data, coords, attrs={"title": "Equilibria of heat of a viscoelastic cylinder"})


def temperature(
    roller: Roller, V: Numbers | None = None, *, ambient: Numbers, conductance: Numbers,
    force: Numbers | None = None, torque: Numbers | None = None, slope: Numbers | None = None,
    slip_share: float = 0.5,
) -> Temperatures:  # fmt: skip
    """Find the temperatures at which a roller runs: every one at which its loss equals the heat that it gives off.

    For each equilibrium the result says whether it is stable.  The arguments broadcast against each other and against
    array parameters of the roller.

    Parameters
    ----------
    roller : a :class:`Cylinder` whose material has a ``shift``.  One body relaxes, or both are of one material; of
        such each loses half of M, and both have one temperature.
    V : speed, m/s, any sign.  Alone it is that of a freely rolling cylinder, without loss in slip; with one of
        force and torque (or a slope, which counts as the force) the loss in slip heats too.  None: the speed
        follows from the load at each temperature, as of :func:`steady`.
    ambient : temperature of the surroundings, degrees Celsius.
    conductance : heat that the body gives off per kelvin, W/(m K), > 0 (:func:`viscoroll.conductance`).
    force, torque, slope : loads as of :func:`steady`, numbers or arrays.
    slip_share : part of the loss in slip that heats the cylinder, in [0, 1]; the rest heats the base.

    Returns
    -------
    Temperatures
        Of one state ``temperature``, ``stable``, ``V``, ``C_rr``, ``M``, ``loss`` and the other fields as arrays of
        exactly its equilibria by rising temperature.  Arrays of states have that axis after their own, padded with
        NaN, and the ``count`` of equilibria.

    Raises
    ------
    ParameterError
        A conductance <= 0, an ambient outside the range of the shift, a roller without material, shift or relaxation,
        a shift that does not fall with temperature, two bodies of different materials that relax, a vertical shift
        of a cover, beside an elastic body, or under a given load, neither V nor a load; and as :func:`steady`.

    Warns
    -----
    ModelWarning
        An equilibrium at which the transit frequency is outside the band in which the material was measured.

    Examples
    --------
    >>> import viscoroll as vr
    >>> rubber = vr.Material(3e6, 0.49, vr.Prony([2.0], [1.0]), 0.01, temperature=20.0, shift=vr.WLF(T0=-50.0))
    >>> roller = vr.Cylinder(R=0.1, m=60.0, material=rubber, base=vr.Material.rigid(), mu=0.6, load=2e4)
    >>> found = vr.temperature(roller, 5.0, ambient=20.0, conductance=6.0)
    >>> bool(abs(found.loss[0] - 6.0 * (found.temperature[0] - 20.0)) < 1e-10 * found.loss[0])
    True

    Notes
    -----
    At a given speed the number of equilibria is odd, and they are alternately stable and unstable; two whose kappa
    V a_T differ by less than rounding may be missed.  The balance holds to 1e-10 (``tests/test_heat.py``).  One
    temperature for the body is right where its Biot number is small (:func:`viscoroll.uniform_temperature`).
    """
    level, (roller, scene, scale) = roller, resolve_model(roller, "temperature", slope=slope)
    loads = {"force": force, "torque": torque, "slope": slope}
    plain, labels = strip_labels({"V": V, "ambient": ambient, "conductance": conductance} | loads, scale)
    driven = {name: plain.pop(name) for name in loads}
    loaded = any(load is not None for load in driven.values())
    if plain["V"] is None and not loaded:
        raise described_error("V", "is not given", "given, or a force, torque or slope from which it follows")
    found = {name: value for name, value in driven.items() if value is not None and loaded}
    states = heat_states(roller, scene, "temperature", plain | found, slip_share)
    if states.V is None:
        rows, zeros = _under_load(level, states, driven)
    else:
        rows, zeros = _at_speed(states, driven if loaded else None)
    result = _pack(states, zeros, rows, labels)
    warn_of_contact(roller, rows["V"] * rows.pop("a_T"))
    return result


def _at_speed(states: HeatStates, driven: dict[str, Any] | None) -> tuple[dict[str, Floats], Zeros]:
    """Return the fields of the equilibria at given speeds, and where they are.

    states: the states, with V.
    driven: force, torque and slope as :func:`temperature` has them; None: the cylinder rolls freely.
    Returns (name -> values, (m,), in SI units, with a_T, which is NaN beyond the range of the shift; the zeros).
    """
    V = states.V
    assert V is not None
    balance = balance_of(states)
    loads: Any = None
    if driven is not None:
        loads = _loads_of(states, driven)
        power, hottest = balance.power / states.body.part, np.full(V.size, HOTTEST)
        balance = replace(balance, curve=_driven_curve(states, loads), power=power, hottest=hottest)
    zeros = zeros_of(balance)
    resting = np.flatnonzero(V == 0.0)
    if resting.size:
        more = Zeros(resting, states.ambient[resting], resting >= 0)
        zeros = Zeros(*(np.append(*pair) for pair in zip(zeros, more, strict=True)))
    rows = rolling_rows(states, zeros.state, V[zeros.state], zeros.theta)
    return rows if driven is None else rows | _slip_rows(states, loads, zeros.state, rows), zeros


def balance_of(states: HeatStates) -> Balance:
    """Return the balance of freely rolling states at given speeds; of a speed of 0, which has no balance, x_0 is
    -inf, and no zero is found.
    """
    assert states.V is not None
    speed = np.abs(states.V)
    power = states.body.part * states.load * speed / states.kappa
    with np.errstate(divide="ignore"):
        x_0 = np.log2(states.kappa * (speed / states.unit))
    hottest = states.ambient + power * peak_of(states.law) / states.conductance
    curve = rolling_curve(states.law, states.materials)
    return Balance(curve, states.curve, x_0, power, states.conductance, states.ambient, hottest)


def rolling_rows(states: HeatStates, n: Integers, V: Floats, theta: Floats) -> dict[str, Floats]:
    """Return the fields of free rolling of states, by their indices, at speeds and temperatures.

    V: m/s, any sign; theta: degrees Celsius, (m,).
    Returns name -> values, (m,), in SI units: V, temperature, C_rr, M and its parts, loss, loss_slip (0) and a_T,
    which is NaN, as are the fields of the contact, outside the range of the shift.
    """
    a_T, root_b = states.curve.factors(theta)
    cylinder, law = states.roller, states.law
    known = np.isfinite(a_T)
    unit = states.R[n] / (cylinder.T_ref * np.where(known, a_T, 1.0))  # as of the Cylinder of this temperature
    kappa = states.kappa[n] * np.where(known, root_b, 1.0)
    names = ("M", "M_half_space", "M_cylinder")
    computed = computed_fields(names, law.unlike if isinstance(law, LawTable) else True)
    arrays = [states.materials[n], kappa, states.mu[n], V / unit, np.zeros(n.size)]
    contact = complete(names, computed, evaluate_law(law, arrays, n.shape, False, computed), n.shape)
    rows = {name: np.where(known, each, np.nan) * (states.load[n] * states.R[n]) for name, each in contact.items()}
    rows |= {"V": V, "temperature": theta, "C_rr": np.where(known, contact["M"], np.nan), "a_T": a_T}
    return rows | {"loss": states.load[n] * V * rows["C_rr"], "loss_slip": 0.0 * theta}


def _loads_of(states: HeatStates, driven: dict[str, Any]) -> Loads:
    """Return the loads of states at given speeds, dimensionless; their V is not used.

    driven: force, torque and slope as :func:`temperature` has them.
    """
    scale = states.roller.scale
    given = {name: make_dimensionless(name, load, scale) for name, load in driven.items() if name != "slope"}
    whole = {name: None if load is None else np.broadcast_to(load, states.shape) for name, load in given.items()}
    slope = driven["slope"]
    slope = None if slope is None else np.broadcast_to(slope, states.shape)
    return loads_of(states.scene, whole["force"], whole["torque"], slope, np.ones(states.shape))


def _driven_curve(states: HeatStates, loads: Loads) -> Curve:
    """Return the curve C of states under loads at given speeds: kappa times (part of M, and of |delta Q|).

    Where the friction does not suffice the loss in slip is left out; such an equilibrium is no state, and is dropped.
    """
    assert states.V is not None
    sign, law = np.sign(states.V), states.law

    def loss(n: Integers, x: Floats) -> Floats:
        V = np.exp2(x) / loads.kappa[n]
        rows = states_at(law, loads, n, sign[n], V).rows
        delta = np.nan_to_num(rows[Field.DELTA])
        rolling = np.abs(rows[Field.M_HALF_SPACE] + (1.0 + delta) * rows[Field.M_CYLINDER])
        slip = np.abs(delta * rows[Field.Q])
        return loads.kappa[n] * (states.body.part * rolling + states.body.slip * slip)

    def values(n: Integers, x: Floats) -> tuple[Floats, Floats]:
        C = loss(n, x)
        return C, (loss(n, x + _STEP) - C) / _STEP

    def nodes(first: int, stop: int, n: Integers) -> Floats:
        x = np.arange(first, stop) / NODES
        return loss(np.repeat(n, x.size), np.tile(x, n.size)).reshape(n.size, x.size)

    return Curve(values, nodes)


def _slip_rows(states: HeatStates, loads: Loads, n: Integers, rows: dict[str, Floats]) -> dict[str, Floats]:
    """Return the loss and its part in slip of equilibria under loads, NaN where the friction does not suffice.

    n: indices of the states; rows: as of :func:`rolling_rows`.
    """
    V, a_T = rows["V"], np.where(np.isfinite(rows["a_T"]), rows["a_T"], 1.0)
    speed = np.abs(V) * a_T / states.unit[n]
    moving = np.flatnonzero(speed)
    slip, spin = np.zeros((2, n.size))
    found = states_at(states.law, loads, n[moving], np.sign(V[moving]), speed[moving]).rows
    power = found[Field.DELTA] * V[moving] * states.load[n[moving]]
    slip[moving] = np.abs(found[Field.Q] * power)
    spin[moving] = found[Field.M_CYLINDER] * power  # the cylinder turns at omega = V (1 + delta)/R
    return {"loss": rows["loss"] + spin + slip, "loss_slip": slip}


def _under_load(level: Any, states: HeatStates, driven: dict[str, Any]) -> tuple[dict[str, Floats], Zeros]:
    """Return the fields of the equilibria under given loads, where the speed follows from the temperature.

    level: the roller on no slope.
    states: the states, without V.
    driven: force, torque and slope as :func:`temperature` has them.
    Each branch of M(V) = force + torque/R at the reference is a balance of its own, in which the speed is V_0/a_T.
    Returns the fields and the zeros as :func:`_at_speed`; stable are those of a stable speed alone.
    """
    if states.body.material.vertical_shift is not None:
        raise described_error("vertical_shift", "is given", "left out where the speed follows from the load: give V")
    whole = {name: None if load is None else np.broadcast_to(load, states.shape) for name, load in driven.items()}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)  # of speeds at the reference
        found = steady(level, **whole)
    V, stable = (np.asarray(found[name]).reshape(states.load.size, -1) for name in ("V", "stable"))
    n, k = np.nonzero(np.nan_to_num(V))
    flat = {name: np.asarray(found[name]).reshape(V.shape)[n, k] for name in ("M", "M_half_space", "M_cylinder")}
    slip, half_space, cylinder = (
        np.asarray(getattr(found.loss, name)).reshape(V.shape)[n, k] for name in ("slip", "half_space", "cylinder")
    )
    power = states.body.part * (half_space + cylinder) + states.body.slip * slip
    balance = Balance(
        hot_curve(), states.curve, np.zeros(n.size), power, states.conductance[n], states.ambient[n],
        np.full(n.size, HOTTEST),
    )  # fmt: skip
    zeros = zeros_of(balance)
    k, n, a_T = zeros.state, n[zeros.state], states.curve.factors(zeros.theta)[0]
    speed = V[np.nonzero(np.nan_to_num(V))][k] / states.unit[n] * (states.R[n] / (states.roller.T_ref * a_T))
    rows = {name: each[k] for name, each in flat.items()}
    rows |= {"V": speed, "temperature": zeros.theta, "a_T": a_T, "C_rr": rows["M"] / (states.load[n] * states.R[n])}
    rows |= {"loss": (slip + half_space + cylinder)[k] / a_T, "loss_slip": slip[k] / a_T}
    of_speed = stable[np.nonzero(np.nan_to_num(V))][k]
    return rows, Zeros(n, zeros.theta, zeros.stable & of_speed)


def _pack(states: HeatStates, zeros: Zeros, rows: dict[str, Floats], labels: Labels | None) -> Temperatures:
    """Return the result of the equilibria of states, padded to arrays (states..., equilibria).

    zeros, rows: the equilibria and their fields, unsorted; those with a NaN in a_T or the loss are named and dropped.
    """
    size = states.load.size
    inside = within_data(states, rows["V"] * rows["a_T"])
    known = np.isfinite(rows["a_T"]) & np.isfinite(rows["loss"])
    reason = _reasons(states, zeros, known, inside, rows)
    order = np.lexsort((zeros.theta, zeros.state))
    order = order[known[order]]
    state = zeros.state[order]
    count = np.bincount(state, minlength=size)
    most = int(count.max(initial=0))
    place = state, np.arange(state.size) - (np.cumsum(count) - count)[state]
    found: dict[str, Any] = {}
    for name in _FIELDS:
        found[name] = np.full((size, most), np.nan)
        found[name][place] = rows[name][order]
    for name, truth in (("stable", zeros.stable), ("measured", inside)):
        found[name] = np.zeros((size, most), bool)
        found[name][place] = truth[order]
    found = {name: each.reshape(*states.shape, most) for name, each in found.items()}
    found["count"] = count.reshape(states.shape) if states.shape else int(count[0])
    if labels is not None:
        found = {
            name: labels.apply(name, each, *(() if name == "count" else ("equilibrium",)))
            for name, each in found.items()
        }
    return Temperatures(found, reason.reshape(states.shape) if states.shape else reason[0], labels)


def within_data(states: HeatStates, speed: Floats) -> Any:
    """Return whether the material was measured at speeds, m/s, reduced to the reference; True without data."""
    band = states.roller.body_data.measured_speeds
    size = np.abs(speed)
    return np.full(size.shape, True) if band is None else (size == 0.0) | (size >= band[0]) & (size <= band[1])


def _reasons(states: HeatStates, zeros: Zeros, known: Any, inside: Any, rows: dict[str, Floats]) -> Any:
    """Return for each state "" or why no equilibrium lies within the ranges of shift and data, (states,), objects."""
    found = np.full(states.load.size, "", object)
    if known.all() and inside.all() and zeros.state.size >= found.size:
        good = np.bincount(zeros.state, minlength=found.size) > 0
        if good.all():
            return found
    good = np.zeros(found.size, bool)
    good[zeros.state[known & inside]] = True
    for n in np.flatnonzero(~good).tolist():
        own = np.flatnonzero(zeros.state == n)
        at = own[np.argmin(zeros.theta[own])] if own.size else None
        if at is None:
            found[n] = f"no temperature up to {HOTTEST:g} degrees Celsius balances: it runs away, or none is steady"
        elif not np.isfinite(rows["a_T"][at]):
            found[n] = f"only {zeros.theta[at]:.5g} degrees Celsius balances, beyond the shift's {states.curve.high:g}"
        elif not known[at]:
            found[n] = f"the friction does not suffice at {zeros.theta[at]:.5g} degrees Celsius, which balances"
        else:
            found[n] = (
                f"only {zeros.theta[at]:.5g} degrees Celsius balances, where the rates of the contact lie outside "
                "the measured band"
            )
    return found
