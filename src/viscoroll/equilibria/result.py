"""Equilibria as they are given back: :class:`Steady`, from the flat :class:`States` that were found."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..labels import Labels
from ..results import Row, Shown, short, unit_of
from ..scale import DIMENSIONLESS, DIMENSIONS, Scale
from ..symbols import attributes
from . import row
from .loads import Loads
from .reason import Reasons

if TYPE_CHECKING:
    import xarray as xr


_FIELDS = (
    "V", "omega", "delta", "Q", "M", "M_half_space", "M_cylinder", "beta", "grip", "force", "torque",
)  # fmt: skip


@dataclass(frozen=True, eq=False)
class Loss:
    """Where the power goes, over P R/T_ref (W per m of length where the call was in SI units).

    Attributes
    ----------
    slip : in the contact, (omega - V) Q.
    half_space, cylinder : in rolling, V M_half_space and omega M_cylinder; their sum with ``slip`` is what force and
        torque put in.
    coefficient : of rolling resistance, all of that over P |V|: M and what slip adds; at V = 0 the limit of V -> 0.
    efficiency : power taken out over power put in, -force V/(torque omega) of a driving roller, its inverse of
        a towed one that drives; 0 where nothing is taken out, NaN at rest.
    """

    slip: NDArray[np.float64]
    half_space: NDArray[np.float64]
    cylinder: NDArray[np.float64]
    coefficient: NDArray[np.float64]
    efficiency: NDArray[np.float64]


@dataclass(frozen=True, eq=False, repr=False)
class Steady(Shown):
    """Equilibria of rolling under load; what :func:`viscoroll.steady` gives back.

    The last axis counts the equilibria of a load by rising |V| (of one speed: V > 0 first); where they are fewer, it is
    padded with NaN (``stable``: False).

    Attributes
    ----------
    V, omega, delta : speeds and creep ratio (omega - V)/V, infinite where the cylinder spins on the spot.
    Q, M : traction and rolling moment, over P and P R; M_half_space, M_cylinder : the parts of M.
    beta : stick zone over contact length.  grip : 1 - |Q|/mu, 0 in full slip.
    stable : whether (V, omega) returns after any small disturbance; False too where an eigenvalue is 0.
    eigenvalues : two more entries, complex, fast and slow: rates over gamma t of small disturbances.
    force, torque : what acts, with slope and feedback; found where V was given.
    loss : powers, coefficient of rolling resistance, efficiency (:class:`Loss`).
    count : number of equilibria, of each load.
    """

    V: NDArray[np.float64]
    omega: NDArray[np.float64]
    delta: NDArray[np.float64]
    Q: NDArray[np.float64]
    M: NDArray[np.float64]
    M_half_space: NDArray[np.float64]
    M_cylinder: NDArray[np.float64]
    beta: NDArray[np.float64]
    grip: NDArray[np.float64]
    stable: NDArray[np.bool_]
    eigenvalues: NDArray[np.complex128]
    force: NDArray[np.float64]
    torque: NDArray[np.float64]
    loss: Loss
    count: Any
    reasons: Reasons
    scale: Scale = DIMENSIONLESS
    #: of the loads, where they came as arrays of xarray or pandas: all above but ``reasons`` have them then
    labels: Labels | None = None

    def scaled(self, scale: Scale) -> Steady:
        """The same in these units."""

        def of(name: str, value: Any, behind: int = 1) -> Any:
            """Units of loads, beside the axes of equilibria."""
            unit = np.asarray(scale[name])
            return value * (unit.reshape(unit.shape + (1,) * behind) if unit.ndim else unit)

        found = {name: of(name, getattr(self, name)) for name in _FIELDS if name in DIMENSIONS}
        powers = {name: of(f"loss_{name}", getattr(self.loss, name)) for name in ("slip", "half_space", "cylinder")}
        rates = of("rate_fast", self.eigenvalues, 2)
        return replace(
            self, **found, eigenvalues=rates, loss=replace(self.loss, **powers), scale=scale,
            reasons=replace(self.reasons, scale=scale),
        )  # fmt: skip

    def labelled(self, labels: Labels | None) -> Steady:
        """The same with the labels of its loads."""
        if labels is None or labels.shape != np.shape(self.count):
            return self
        names = (*_FIELDS, "stable")
        found = {name: labels.of(name, getattr(self, name), "equilibrium") for name in names}
        found["eigenvalues"] = labels.of("eigenvalues", self.eigenvalues, "equilibrium", "rate")
        found["count"] = labels.of("count", self.count)
        loss = Loss(*(labels.of(f.name, getattr(self.loss, f.name), "equilibrium") for f in fields(Loss)))
        return replace(self, **found, loss=loss, labels=labels)

    @property
    def reason(self) -> Any:
        """Why there is no equilibrium; "" where there is one.  Of arrays of loads an array of strings."""
        return self.reasons.text()

    def _card(self) -> tuple[str, list[Row]]:
        if np.ndim(self.count):
            loads = f"{np.size(self.count)} loads"
            found = f"{int(np.sum(self.count))}, {int(np.asarray(self.stable).sum())} of them stable"
            speeds = Row("V", short(np.asarray(self.V)), self._unit("V"))
            return f"Steady rolling under {loads}", [Row("equilibria", found), speeds]
        if not self.count:
            return "Steady rolling: no equilibrium", [Row("reason", str(self.reason))]
        rows = []
        for n in range(self.count):
            rows.append(Row("equilibrium", "stable" if self.stable[n] else "not stable"))
            for name in ("V", "omega", "delta", "force", "torque", "Q", "M", "beta", "grip"):
                rows.append(Row(f"  {name}", f"{getattr(self, name)[n]:.6g}", self._unit(name)))
        return "Steady rolling", rows

    def _unit(self, name: str) -> str:
        return unit_of(attributes(name, self.scale.si))

    def to_xarray(self) -> xr.Dataset:
        """Dataset over loads and ``equilibrium``, with names and units; ``loss_...`` holds the powers."""
        import xarray as xr

        shape = np.shape(self.count)
        dims = ("load",) if len(shape) == 1 else tuple(f"load_{n}" for n in range(len(shape)))
        dims, coords = self.labels.beside((*_FIELDS, "count"), "load") if self.labels else (dims, {})
        over = (*dims, "equilibrium")

        def described(name: str) -> dict[str, str]:
            return attributes(name, self.scale.si)

        def variable(values: Any, about: dict[str, Any]) -> xr.Variable:
            return xr.Variable(over, np.asarray(values), about)

        data = {name: variable(getattr(self, name), described(name)) for name in _FIELDS}
        data["stable"] = variable(np.asarray(self.stable).astype(np.int8), described("stable"))
        for n, name in enumerate(("rate_fast", "rate_slow")):
            data[name] = variable(np.asarray(self.eigenvalues)[..., n].real, described(name))
        for name in ("slip", "half_space", "cylinder"):
            data[f"loss_{name}"] = variable(getattr(self.loss, name), described(f"loss_{name}"))
        for name, words in (("coefficient", "rolling resistance over load"), ("efficiency", "power out over power in")):
            data[name] = variable(getattr(self.loss, name), {"long_name": words, "units": "1"})
        about = {"long_name": "number of equilibria", "units": "1"}
        data["count"] = xr.Variable(dims, np.asarray(self.count), about)
        apart = {name: values for name, values in coords.items() if name not in data}
        return xr.Dataset(data, apart, attrs={"title": "Steady rolling of a viscoelastic cylinder"})


@dataclass(frozen=True)
class States:
    """Steady states one after another: which load each belongs to, and what was found; speeds in R/T_ref.

    Where friction does not suffice, delta and omega are NaN.
    """

    load: NDArray[np.int64]
    V: NDArray[np.float64]
    omega: NDArray[np.float64]
    delta: NDArray[np.float64]
    Q: NDArray[np.float64]
    M_half_space: NDArray[np.float64]
    M_cylinder: NDArray[np.float64]
    beta: NDArray[np.float64]
    eigenvalues: NDArray[np.complex128]

    @classmethod
    def of(cls, loads: Loads, load: NDArray, sign: NDArray, rows: NDArray) -> States:
        """From the rows of :mod:`row`."""
        slopes = rows[[row.DQ_DV, row.DQ_DOMEGA, row.DM_HALF_SPACE, row.DM_CYLINDER]]
        V, delta = sign * rows[row.V], rows[row.DELTA]
        return cls(
            load, V, V * (1.0 + delta), delta, sign * rows[row.Q], sign * rows[row.M_HALF_SPACE],
            sign * rows[row.M_CYLINDER], rows[row.BETA], _eigenvalues(slopes, loads, loads.j[load]),
        )  # fmt: skip

    @classmethod
    def at_rest(cls, loads: Loads, load: NDArray, T_mean: float) -> States:
        """V = omega = 0, the limit of slow rolling: Carter's contact, and V' = -rate V with omega in step with it."""
        Q, kappa, mu, j = (values[load] for values in (loads.torque, loads.kappa, loads.mu, loads.j))
        if loads.given == "force":
            Q = -loads.force[load]
        part = np.abs(Q) / mu
        beta = np.sqrt(np.where(part < 1.0, 1.0 - part, np.nan))
        delta = 0.5 * mu / kappa * part / (1.0 + beta)
        gains, slow = loads.gains, np.full(load.size, -np.inf)
        for creep in (delta, -delta):  # to either side omega = V (1 + delta) or V (1 - delta)
            rate = T_mean - gains.V - (gains.force_omega + gains.torque_omega) * (1.0 + creep)
            slow = np.maximum(slow, -rate / (1.0 + j * (1.0 + creep)))
        zero = np.zeros(load.size)
        eigenvalues = np.stack([np.full(load.size, -np.inf), slow], axis=-1).astype(np.complex128)
        return cls(load, zero, 0.0 * beta, np.sign(Q) * delta, Q, zero, zero, beta, eigenvalues)

    @classmethod
    def none(cls) -> States:
        """No state."""
        empty = np.empty(0)
        return cls(
            np.empty(0, np.int64), empty, empty, empty, empty, empty, empty, empty, np.empty((0, 2), np.complex128)
        )

    @classmethod
    def joined(cls, *parts: States) -> States:
        """All of them, one after another."""
        return cls(*(np.concatenate(values) for values in zip(*(part._values() for part in parts), strict=True)))

    def held(self) -> States:
        """Those that friction holds, by load and rising |V|."""
        held = np.flatnonzero(np.isfinite(self.omega))
        held = held[np.lexsort((np.abs(self.V[held]), self.load[held]))]
        return States(*(values[held] for values in self._values()))

    def _values(self) -> tuple[NDArray, ...]:
        return (
            self.load, self.V, self.omega, self.delta, self.Q, self.M_half_space, self.M_cylinder, self.beta,
            self.eigenvalues,
        )  # fmt: skip


def _eigenvalues(slopes: NDArray, loads: Loads, j: NDArray) -> NDArray[np.complex128]:
    """Of (V, omega) over gamma t, the faster first.

    slopes : a, b of Q over V and omega, then those of both moments over V.

    The determinant is put together so that a and b, which are large, do not cancel: b (M'(V) - gain)/j without a gain
    on omega.
    """
    a, b, d_half_space, d_cylinder = slopes
    gains = loads.gains
    with np.errstate(invalid="ignore"):
        det = b * (d_half_space + d_cylinder - gains.V)
        det += gains.torque_omega * (a - d_half_space + gains.force_V)
        det = (det + gains.force_omega * (a + d_cylinder - gains.torque_V)) / j
        half = 0.5 * (a - d_half_space + gains.force_V + (gains.torque_omega - b) / j)
        spread = half * half - det
        root = np.sqrt(np.abs(spread))
        larger = half + np.copysign(root, half)
        other = np.divide(det, larger, out=np.zeros_like(det), where=larger != 0.0)
        real = spread >= 0.0
        first = np.where(real, np.minimum(larger, other), half) - 1j * np.where(real, 0.0, root)
        second = np.where(real, np.maximum(larger, other), half) + 1j * np.where(real, 0.0, root)
    return np.stack([first, second], axis=-1)


def packed(loads: Loads, states: States, count: NDArray, reasons: Reasons) -> Steady:
    """States in order as arrays over loads and equilibria."""
    number = states.load
    place = np.arange(number.size) - (np.cumsum(count) - count)[number]
    most = int(count.max(initial=0))
    shape = (*loads.shape, most)
    at = number * most + place

    def spread(values: NDArray, empty: Any = np.nan) -> NDArray:
        out = np.full((loads.mu.size * most, *values.shape[1:]), empty, dtype=values.dtype)
        out[at] = values
        return out.reshape(shape + values.shape[1:])

    V, omega, Q = states.V, states.omega, states.Q
    M = states.M_half_space + states.M_cylinder
    force, torque = _acting(loads, states)
    loss = Loss(*map(spread, _losses(states, force * V, torque * omega)))
    stable = np.all(states.eigenvalues.real < 0.0, axis=-1)
    grip = 1.0 - np.abs(Q) / loads.mu[number]
    return Steady(
        V=spread(V), omega=spread(omega), delta=spread(states.delta), Q=spread(Q), M=spread(M),
        M_half_space=spread(states.M_half_space), M_cylinder=spread(states.M_cylinder), beta=spread(states.beta),
        grip=spread(grip), stable=spread(stable, False), eigenvalues=spread(states.eigenvalues), force=spread(force),
        torque=spread(torque), loss=loss, count=count.reshape(loads.shape) if loads.shape else int(count[0]),
        reasons=reasons,
    )  # fmt: skip


def _losses(states: States, by_force: NDArray, by_torque: NDArray) -> tuple[NDArray, ...]:
    """What :class:`Loss` holds, from the powers put in by force and torque."""
    V, omega, Q, delta = states.V, states.omega, states.Q, states.delta
    moving = V != 0.0
    slip = np.where(moving, V, omega) * np.where(moving, delta, 1.0) * Q
    half_space, cylinder = V * states.M_half_space, omega * states.M_cylinder
    speed = np.where(moving, np.abs(V), 1.0)
    coefficient = np.where(moving, (slip + half_space + cylinder) / speed, np.abs(Q * delta))
    taken = np.maximum(-by_force, 0.0) + np.maximum(-by_torque, 0.0)
    put_in = np.maximum(by_force, 0.0) + np.maximum(by_torque, 0.0)
    efficiency = np.divide(taken, put_in, out=np.full(V.size, np.nan), where=put_in > 0.0)
    return slip, half_space, cylinder, coefficient, efficiency


def _acting(loads: Loads, states: States) -> tuple[NDArray, NDArray]:
    """Force and torque of each state."""
    gains, V, omega = loads.gains, states.V, states.omega
    force = loads.force[states.load] + gains.force_V * V + gains.force_omega * omega
    torque = loads.torque[states.load] + gains.torque_V * V + gains.torque_omega * omega
    if loads.given == "torque":
        force = states.M_half_space - states.Q
    elif loads.given == "force":
        torque = states.M_cylinder + states.Q
    return force, torque
