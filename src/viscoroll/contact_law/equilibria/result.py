"""Equilibria as they are given back: :class:`Steady`, from the flat :class:`States` that were found."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core.labels import Labels
from ...core.results import Row, Shown, short, unit_of
from ...core.scale import DIMENSIONLESS, DIMENSIONS, Scale
from ...core.symbols import attributes
from . import row
from .loads import Gains, Loads
from .reason import Reasons

if TYPE_CHECKING:
    import xarray as xr


_FIELDS = (
    "V", "delta", "Q", "M_half_space", "M_cylinder", "beta", "omega", "M", "grip", "force", "torque",
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
    count: Any
    reasons: Reasons
    scale: Scale = DIMENSIONLESS
    #: of the loads, where they came as arrays of xarray or pandas: all above but ``reasons`` have them then
    labels: Labels | None = None

    def keys(self) -> Iterable[str]:
        return [*super().keys(), "loss", "reason"]

    def labelled(self, labels: Labels | None) -> Steady:
        """The same with the labels of its loads."""
        if labels is None or labels.shape != np.shape(self.count):
            return self
        found = {name: labels.of(name, getattr(self, name), "equilibrium") for name in (*_FIELDS, "stable")}
        found["eigenvalues"] = labels.of("eigenvalues", self.eigenvalues, "equilibrium", "rate")
        return replace(self, **found, count=labels.of("count", self.count), labels=labels)

    @cached_property
    def loss(self) -> Loss:
        """Powers, coefficient of rolling resistance, efficiency."""
        V, delta, Q, M_half_space, M_cylinder, _, omega, _, _, force, torque = (
            np.asarray(getattr(self, name)) for name in _FIELDS
        )
        R, P = (behind(self.scale[name]) for name in ("R", "P"))
        moving = V != 0.0
        slip = np.where(moving, V, R * omega) * np.where(moving, delta, 1.0) * Q
        half_space, cylinder = V * M_half_space / R, omega * M_cylinder
        whole, speed = slip + half_space + cylinder, np.where(moving, np.abs(V), 1.0)
        with np.errstate(invalid="ignore"):
            coefficient = np.where(moving, whole / speed, np.abs(Q * delta)) / P
        by_force, by_torque = force * V, torque * omega
        taken = np.maximum(-by_force, 0.0) + np.maximum(-by_torque, 0.0)
        put_in = np.maximum(by_force, 0.0) + np.maximum(by_torque, 0.0)
        efficiency = np.divide(taken, put_in, out=np.full(V.shape, np.nan), where=put_in > 0.0)
        found = slip, half_space, cylinder, coefficient, efficiency
        if self.labels is None:
            return Loss(*found)
        names = (field.name for field in fields(Loss))
        return Loss(*(self.labels.of(*each, "equilibrium") for each in zip(names, found, strict=True)))

    @property
    def success(self) -> Any:
        """Whether there is an equilibrium, of each load."""
        return np.asarray(self.count)[()] > 0

    @property
    def status(self) -> Any:
        """0 where there is one, else 1."""
        return np.where(self.success, 0, 1)[()]

    @property
    def message(self) -> Any:
        """As :attr:`reason`."""
        return self.reason

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


def behind(unit: Any) -> Any:
    """A unit of each load, as of all its equilibria."""
    return unit[..., np.newaxis] if isinstance(unit, np.ndarray) else unit


class States(NamedTuple):
    """Steady states one after another: which load each belongs to, and the rows of :mod:`row`; speeds in R/T_ref.

    Where friction does not suffice, delta and omega are NaN.
    """

    load: NDArray[np.int64]
    rows: NDArray[np.float64]

    @classmethod
    def of(cls, loads: Loads, load: NDArray, sign: NDArray, answers: NDArray) -> States:
        """From rows with answers."""
        rows = answers.copy()
        rows[[row.V, row.Q, row.M_HALF_SPACE, row.M_CYLINDER]] *= sign
        rows[row.OMEGA] = rows[row.V] * (1.0 + rows[row.DELTA])
        rows[row.FAST :] = _eigenvalues(answers[row.DQ_DV :], loads.gains, loads.j[load])
        return cls(load, rows)

    @classmethod
    def at_rest(cls, loads: Loads, load: NDArray, T_mean: float) -> States:
        """V = omega = 0, the limit of slow rolling: Carter's contact, and V' = -rate V with omega in step with it."""
        Q, kappa, mu, j = (values[load] for values in (loads.torque, loads.kappa, loads.mu, loads.j))
        if loads.given == "force":
            Q = -loads.force[load]
        part, rows = np.abs(Q) / mu, np.zeros((row.IMAGINARY + 1, load.size))
        rows[row.BETA] = beta = np.sqrt(np.where(part < 1.0, 1.0 - part, np.nan))
        delta = 0.5 * mu / kappa * part / (1.0 + beta)
        rows[row.OMEGA], rows[row.DELTA], rows[row.Q] = 0.0 * beta, np.sign(Q) * delta, Q
        rows[row.FAST] = rows[row.SLOW] = -np.inf
        gains = loads.gains
        for creep in (delta, -delta):  # to either side omega = V (1 + delta) or V (1 - delta)
            rate = T_mean - gains.V - (gains.force_omega + gains.torque_omega) * (1.0 + creep)
            rows[row.SLOW] = np.maximum(rows[row.SLOW], -rate / (1.0 + j * (1.0 + creep)))
        return cls(load, rows)

    @classmethod
    def none(cls) -> States:
        """No state."""
        return cls(np.empty(0, np.int64), np.empty((row.IMAGINARY + 1, 0)))

    @classmethod
    def joined(cls, *parts: States) -> States:
        """All of them, one after another."""
        return cls(np.concatenate([each.load for each in parts]), np.concatenate([each.rows for each in parts], axis=1))

    def held(self) -> States:
        """Those that friction holds, by load and rising |V|."""
        held = np.isfinite(self.rows[row.OMEGA]).nonzero()[0]
        held = held[np.lexsort((np.abs(self.rows[row.V, held]), self.load[held]))]
        return States(self.load[held], self.rows[:, held])


def _eigenvalues(slopes: NDArray, gains: Gains, j: NDArray) -> NDArray[np.float64]:
    """Of (V, omega) over gamma t: real parts of the faster and of the other, and the imaginary part of the other.

    slopes : a, b of Q over V and omega, then those of both moments over V.

    The determinant is put together so that a and b, which are large, do not cancel: b (M'(V) - gain)/j without a gain
    on omega.
    """
    a, b, d_half_space, d_cylinder = slopes
    with np.errstate(invalid="ignore"):
        det = b * (d_half_space + d_cylinder - gains.V)
        det += gains.torque_omega * (a - d_half_space + gains.force_V)
        det = (det + gains.force_omega * (a + d_cylinder - gains.torque_V)) / j
        half = 0.5 * (a - d_half_space + gains.force_V + (gains.torque_omega - b) / j)
        spread = half * half - det
        root = np.sqrt(np.abs(spread))
        larger = half + np.copysign(root, half)
        other = np.divide(det, larger, out=0.0 * det, where=larger != 0.0)
        real = spread >= 0.0
        return np.array([
            np.where(real, np.minimum(larger, other), half), np.where(real, np.maximum(larger, other), half),
            np.where(real, 0.0, root),
        ])  # fmt: skip


def packed(loads: Loads, states: States, reasons: Reasons, scale: Scale) -> Steady:
    """States in order as arrays over loads and equilibria, in these units."""
    number, count, gains = states.load, reasons.number, loads.gains
    V, _, Q, M_half_space, M_cylinder, _, omega, fast, slow, imaginary = states.rows
    force = loads.force[number] + gains.force_V * V + gains.force_omega * omega
    torque = loads.torque[number] + gains.torque_V * V + gains.torque_omega * omega
    if loads.given == "torque":
        force = M_half_space - Q
    elif loads.given == "force":
        torque = M_cylinder + Q
    grip = 1.0 - np.abs(Q) / loads.mu[number]
    more = np.array([M_half_space + M_cylinder, grip, force, torque, fast, slow, imaginary])
    rows = np.concatenate([states.rows[: row.FAST], more])
    most = int(count.max(initial=0))
    if most * count.size > number.size:  # some have fewer
        place = np.arange(number.size) - (np.cumsum(count) - count)[number]
        padded = np.full((len(rows), count.size * most), np.nan)
        padded[:, number * most + place] = rows
        rows = padded
    rows = rows.reshape(len(rows), *loads.shape, most)
    found: dict[str, Any] = {
        name: values * behind(scale[name]) if name in DIMENSIONS else values
        for name, values in zip(_FIELDS, rows, strict=False)
    }
    fast, slow, imaginary = rows[-3:] * behind(scale["rate_fast"])
    eigenvalues = np.empty((*fast.shape, 2), np.complex128)
    eigenvalues.real[..., 0], eigenvalues.real[..., 1] = fast, slow
    eigenvalues.imag[..., 0], eigenvalues.imag[..., 1] = -imaginary, imaginary
    return Steady(
        **found, stable=(fast < 0.0) & (slow < 0.0), eigenvalues=eigenvalues,
        count=count.reshape(loads.shape) if loads.shape else int(count[0]), reasons=reasons, scale=scale,
    )  # fmt: skip
