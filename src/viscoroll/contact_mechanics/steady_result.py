"""Results of steady rolling: :class:`Steady`, with the reason where a load has no equilibrium.

P is the load that presses the cylinder on its base, R its radius, T_ref the unit of time, kappa =
R/l0 with the contact length at rest l0, and mu the coefficient of friction.
"""

import dataclasses
import functools
from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np

from ..core import (
    DIMENSIONS,
    Dataset,
    Floats,
    Integers,
    Labels,
    Scale,
    SummaryRow,
    Values,
    dataset_axes,
    format_value,
    unit_of,
)
from .steady_loads import Loads
from .steady_states import Field, States

#: Fields of the result in the order of the rows.
_FIELDS = (
    "V",
    "delta",
    "Q",
    "M_half_space",
    "M_cylinder",
    "beta",
    "omega",
    "M",
    "grip",
    "force",
    "torque",
)
#: Names of the fields of :class:`Loss` in datasets, in the order of these fields.
_LOSSES = "loss_slip", "loss_half_space", "loss_cylinder", "coefficient", "efficiency"


@dataclasses.dataclass(frozen=True, eq=False)
class Loss:
    """Power balance of steady rolling, in the shape of the equilibria, with NaN where the
    equilibria are padded.

    Powers are divided by P R/T_ref, of a Cylinder in W per m of length.

    Attributes
    ----------
    slip : power that friction takes, at least 0: (omega - V) Q of a scene, (omega R - V) Q of a
        Cylinder; on a cover less the power that the stretch of its surface takes, which is V Q
        delta_0 to first order in Q.
    half_space, cylinder : power that either body dissipates, at least 0: V M_half_space and omega
        M_cylinder (of a Cylinder the first divided by R), of a cover with its moments without
        traction.  The sum of all three is the power of force and torque.
    coefficient : coefficient of rolling resistance, dimensionless: all losses divided by P |V|; at
        rest the limit V -> 0, |Q delta|/P; infinite for a cylinder that spins at V = 0.
    efficiency : output power divided by input power, dimensionless.  Force V and torque omega are
        input where they are positive, output where they are negative.  0 without output; NaN
        without input, as at rest.
    """

    slip: Floats
    half_space: Floats
    cylinder: Floats
    coefficient: Floats
    efficiency: Floats


class Diagnosis(NamedTuple):
    """Data for the explanation why a load has no equilibrium.

    loads : the loads, n of them, dimensionless.
    scale : units of the roller, in which the sentences state their numbers.
    states : all states, whether or not the friction suffices.
    number : equilibria of each load, (n,).
    maximum : (largest kappa M, kappa V there), dimensionless; None with feedback, for elastic
        bodies, on a table of the coupled solution, and where every load has an equilibrium.
    elastic : whether the bodies are elastic and no gain and no given V determines the speed, so
        that M = 0 at every speed.
    """

    loads: Loads
    scale: Scale
    states: States
    number: Integers
    maximum: tuple[float, float] | None
    elastic: bool

    def text(self) -> Any:
        """Return for each load the reason why it has no equilibrium, "" where it has one.

        Returns a str for one load, else an array of str (dtype object) in the shape of the loads.
        """
        shape = self.loads.shape
        found = ["" if number else self._reason(n) for n, number in enumerate(self.number)]
        return np.array(found, dtype=object).reshape(shape) if shape else found[0]

    def _reason(self, n: int) -> str:
        """Return why a load has no equilibrium, as a sentence without a full stop.

        It is the first of these that applies: friction (the balance needs more than mu, or mu
        exactly; of several states that with the smallest |Q| is named); elastic bodies, which roll
        without resistance; a feedback that balances the moment at no speed; a load above the
        largest moment.
        n : index of a load without equilibrium in the flattened loads.
        The numbers are in the units of the roller but Q and mu, which are dimensionless; of a scene
        all are.
        """
        name, moment, of_load, of_speed = (
            ("force + torque/R", "rolling moment divided by R", " N/m", " m/s")
            if self.scale.si
            else ("force + torque", "rolling moment", "", "")
        )
        loads = self.loads
        load, speed = (
            np.broadcast_to(self.scale[of], loads.shape).ravel()[n] for of in ("force", "V")
        )
        mu = loads.mu[n]
        total = (loads.force[n] + loads.torque[n]) * load
        states = self.states.rows[:, self.states.load == n]
        if states.size:  # the state that asks for the least friction
            V, Q = states[[Field.V, Field.Q], np.abs(states[Field.Q]).argmin()]
            at = f"at V = {V * speed:.6g}{of_speed}"
            if abs(Q) == mu:
                return (
                    f"no single steady state: |Q|/load = {mu:.6g} equals mu, so that {at} every "
                    "omega beyond a limit is steady, in full slip (Q: creep force); lower force, "
                    "torque or slope, or raise mu"
                )
            return (
                f"steady rolling {at} needs a creep force Q with |Q|/load = {abs(Q):.6g}, above "
                f"the friction mu = {mu:.6g}: lower force, torque or slope"
            )
        if self.elastic:
            if total == 0.0:
                return (
                    "no isolated steady speed: elastic bodies roll without resistance, so "
                    "every V is steady"
                )
            return (
                f"{name} = {total:.6g}{of_load} (a slope counts as force) is not 0, but elastic "
                "bodies roll without resistance: no speed is steady"
            )
        if self.maximum is None:
            return (
                f"the {moment} equals {name} at no speed that was searched ({name} at V = omega = "
                f"0: {total:.6g}{of_load}; a slope counts as force)"
            )
        M, V = np.divide(self.maximum, loads.kappa[n])
        return (
            f"no steady speed: |{name}| = {abs(total):.6g}{of_load} exceeds "
            f"{M * load:.6g}{of_load}, the largest {moment} (at V = {V * speed:.6g}{of_speed}): "
            "lower force, torque or slope, which counts as force"
        )


class Equilibria(Values):
    """Base of results whose last axis counts the equilibria of a state, padded with NaN, with their
    ``count``, ``stable`` and ``reason``.

    A subclass has ``_heading``, the title; ``_rows``, names of the fields that the report of one
    state has, and ``_ranges``, of those of which the report of several states has the ranges.
    """

    _heading: str
    #: word of the report for an equilibrium that is not stable
    _unstable = "unstable"
    _rows: tuple[str, ...]
    _ranges: tuple[str, ...]

    def __init__(self, values: dict[str, Any], labels: Labels | None, *, si: bool) -> None:
        """Store the equilibria.

        values: field -> array (states..., equilibria), ``count`` without that axis and
            ``eigenvalues`` with one more.
        labels: axes and coordinates of the arguments, which the values then get; None without.
        si: whether the values have SI units.
        """
        if labels is not None:
            axes = {"count": (), "eigenvalues": ("equilibrium", "rate")}
            values = {
                name: labels.apply(name, each, *axes.get(name, ("equilibrium",)))
                for name, each in values.items()
            }
        super().__init__(values, title=self._heading, si=si)
        self._labels = labels

    def _summary(self) -> tuple[str, list[SummaryRow]]:
        """Return the title and the rows of the printed report.

        Returns (title; list of :class:`SummaryRow`).  Of one state the rows are its equilibria one
        after another, each with "stable" or "unstable" and fields to six digits, after the reason
        why there is none; of several states the number of all equilibria and of the stable ones,
        and the ranges of fields.
        """
        if np.ndim(self.count):
            ranges = [
                SummaryRow(
                    name, format_value(np.asarray(self[name])), unit_of(self._attributes(name))
                )
                for name in self._ranges
            ]
            return f"{self._heading}, {np.size(self.count)} states", [
                SummaryRow(
                    "equilibria",
                    f"{int(np.sum(self.count))}, {int(np.asarray(self.stable).sum())} of them "
                    "stable",
                ),
                *ranges,
            ]
        rows = [SummaryRow("reason", str(self.reason))] if self.reason else []
        for n in range(int(self.count)):
            rows.append(SummaryRow("equilibrium", "stable" if self.stable[n] else self._unstable))
            rows += [
                SummaryRow(
                    f"  {name}", f"{float(self[name][n]):.6g}", unit_of(self._attributes(name))
                )
                for name in self._rows
            ]
        return self._heading + ("" if self.count else ": no equilibrium"), rows

    def _dataset(self, fields: dict[str, Any]) -> Dataset:
        """Return a dataset of fields over states and equilibria, truth values as 0 or 1, and of
        ``count``.

        fields: name -> array (states..., equilibria).
        """
        import xarray as xr

        dims, coords = dataset_axes(
            self._labels, np.shape(self.count), (*fields, "count", "equilibrium")
        )
        data = {}
        for name, each in fields.items():
            array = np.asarray(each)
            numbers = array.astype(np.int8) if array.dtype == bool else array
            data[name] = (*dims, "equilibrium"), numbers, self._attributes(name)
        data["count"] = dims, np.asarray(self.count), self._attributes("count")
        return xr.Dataset(
            data, coords, attrs={"title": f"{self._heading} of a viscoelastic cylinder"}
        )


class Steady(Equilibria):
    """Equilibria of rolling under load, the result of :func:`viscoroll.steady`.

    The last axis counts the equilibria of a load by rising |V| (of one speed: V > 0 first); shorter
    lists are padded with NaN (``stable``: False).  The axes before it are those of the loads; of
    one load there are none.  Without an equilibrium that axis has length 0.  Quantities of a Scene
    are dimensionless; those of a Cylinder are in SI units, per m of its length: m/s, rad/s, N/m, N
    m/m, 1/s, W/m.

    Attributes
    ----------
    V, omega, delta : speeds, divided by R/T_ref and multiplied by T_ref, and creepage (omega R -
        V)/V, +infinite for a cylinder that spins at V = 0 in either sense; at rest, V = omega = 0,
        its limit V -> 0+.
    Q, M : creep force and rolling resistance moment, divided by P and P R.
    M_half_space, M_cylinder : the parts of M by the losses in either body.
    beta : stick zone divided by contact length, 0 in full slip, NaN of a grid.
    grip : friction reserve 1 - |Q|/(mu P), 0 in full slip.
    stable : whether (V, omega) returns after any small disturbance at constant force and torque:
        both eigenvalues have a real part < 0.  A drive that prescribes V holds an unstable one too.
    eigenvalues : complex, on a last axis of two, the one of the smaller real part first: growth
        rates of small disturbances of (V, omega), in units of gamma/T_ref.  At rest the first
        is -infinite.
    force, torque : the loads of the equilibrium, with slope and feedback; where V was given one of
        them is found.
    loss : powers, coefficient of rolling resistance, efficiency (:class:`Loss`).
    count : number of equilibria of each load, an int for one load.
    success, status : whether there is an equilibrium, and 0 or 1 if there is one or none, for each
        load.
    reason, message : why there is none, "" where there is one, for each load.

    Examples
    --------
    >>> import viscoroll as vr
    >>> found = vr.steady(vr.presets.RUBBER_CYLINDER, slope=[0.005, 0.01])
    >>> (
    ...     bool(found.V[0, 0] > 0.0),
    ...     [bool(reason) for reason in found.reason],
    ... )  # the second slope is too steep
    (True, [False, True])
    """

    _heading = "Steady rolling"
    _unstable = "unstable if force and torque are held constant"
    _rows = "V", "omega", "delta", "force", "torque", "Q", "M", "beta", "grip"
    _ranges = ("V",)

    def __init__(self, states: States, reasons: Diagnosis, labels: Labels | None) -> None:
        """Pack steady states, one after another, into arrays over loads and equilibria, in the
        units of the roller.

        The fields V, delta, Q, M_half_space, M_cylinder, beta, omega, M, grip, force, torque and
        ``stable`` have the shape (loads..., equilibria), of one load (equilibria,), padded with NaN
        (``stable``: False) where loads have fewer equilibria than others; ``eigenvalues`` have a
        further axis of two, ``count`` has the axes of the loads alone, an int for one load.  With V
        given, force or torque is what the balance needs.

        states : :class:`.steady_states.States` that exist, sorted by load and |V|, dimensionless.
        reasons : :class:`Diagnosis`, data of the loads without equilibrium; its ``number`` is the
            number of states of each load, its ``loads`` are the loads, dimensionless, and its
            ``scale`` the units of the roller, which the result has.
        labels : labels of the arguments of the call, or None; arrays of the scene may add axes in
            front of them.
        """
        loads, scale, _, count, *_ = reasons
        fields = states.rows[: Field.FAST]
        V, _, Q, M_half_space, M_cylinder, _, omega = fields
        force, torque = loads.at_speed(states.load, V, omega)
        # with V given: the balance of the axis, and that of the cylinder
        if loads.given == "torque":
            force = M_half_space - Q
        elif loads.given == "force":
            torque = M_cylinder + Q
        grip = 1.0 - np.abs(Q) / loads.mu[states.load]
        # those of _FIELDS, V to omega from the states, then those of the states from FAST on
        rows = [*fields, M_half_space + M_cylinder, grip, force, torque, *states.rows[Field.FAST :]]
        padded = pad(rows, count, loads.shape)
        found = dict(zip(_FIELDS, padded))
        for name in (found.keys() & DIMENSIONS.keys()) if scale.si else ():
            unit = scale[name]
            # in place of append_axis, whose calls take longer here than the rest
            found[name] = found[name] * (unit[..., None] if isinstance(unit, np.ndarray) else unit)
        # the unit of all three, 1/s of a cylinder
        fast, slow, imaginary = padded[-5:-2] * append_axis(scale["rate_fast"])
        eigenvalues = np.empty((*fast.shape, 2), complex)
        eigenvalues[..., 0] = fast - 1j * imaginary
        eigenvalues[..., 1] = slow + 1j * imaginary
        found |= {
            "stable": (fast < 0.0) & (slow < 0.0),
            "eigenvalues": eigenvalues,
            "count": count.reshape(loads.shape) if loads.shape else int(count[0]),
        }
        super().__init__(found, labels, si=scale.si)
        # without traction, divided by P R
        self._free = padded[-2:]
        self.reasons = reasons

    def keys(self) -> Iterable[str]:
        """Return the names of the fields, which are attributes and are read by ``result[name]``
        too.

        Returns
        -------
        list of str
            The names of the arrays, then "loss" and "reason".

        Examples
        --------
        >>> import viscoroll as vr
        >>> list(vr.steady(vr.presets.RUBBER_CYLINDER, slope=0.005).keys())[-2:]
        ['loss', 'reason']
        """
        return [*self._values, "loss", "reason"]

    @functools.cached_property
    @np.errstate(invalid="ignore", divide="ignore")  # where V or the input is 0
    def loss(self) -> Loss:
        """Return the powers of each equilibrium, its coefficient of rolling resistance and its
        efficiency.

        Returns a :class:`Loss` (powers slip, half_space and cylinder; coefficient; efficiency),
        whose fields have the shape of ``V``, (loads..., equilibria), with the labels of the
        arguments where they fit the loads; powers divided by P R/T_ref, of a Cylinder in W per m of
        its length.  Padding is NaN; at V = 0 the coefficient is the limit V -> 0, infinite for a
        cylinder that spins; without input the efficiency is NaN.
        """
        V, delta, Q, M_half_space, M_cylinder, _, omega, _, _, force, torque = (
            np.asarray(self[name]) for name in _FIELDS
        )
        R, P, P_R = (append_axis(self.reasons.scale[name]) for name in ("R", "P", "M"))
        moving = V != 0.0
        # (omega R - V) Q = V delta Q; at V = 0, where delta is infinite or a limit, omega R Q
        slip = np.where(moving, V * delta, R * omega) * Q
        free_half_space, free_cylinder = self._free * P_R
        half_space = V * free_half_space / R
        cylinder = omega * free_cylinder
        # what shear changes in the moments is taken from friction
        slip += V * (M_half_space - free_half_space) / R + omega * (M_cylinder - free_cylinder)
        powers = np.stack([force * V, torque * omega])
        output, input_ = (np.maximum(signed, 0.0).sum(axis=0) for signed in (-powers, powers))
        lost = slip + half_space + cylinder
        coefficient = np.where(moving, lost / np.abs(V), np.abs(Q * delta)) / P
        efficiency = np.where(input_ > 0.0, output / input_, np.nan)
        # in the order of the fields of Loss, as _LOSSES
        fields: Any = slip, half_space, cylinder, coefficient, efficiency
        if self._labels is not None:
            fields = map(self._labels.apply, _LOSSES, fields, ("equilibrium",) * len(_LOSSES))
        return Loss(*fields)

    @property
    def success(self) -> Any:  # type: ignore[override]
        """Whether there is an equilibrium, of each load."""
        return np.asarray(self.count)[()] > 0

    @property
    def status(self) -> Any:  # type: ignore[override]
        """0 where there is an equilibrium, else 1; an int, or an array in the shape of the
        loads.
        """
        return 1 - self.success

    @property
    def reason(self) -> Any:
        """Why there is no equilibrium; "" where there is one.  Of arrays of loads an array of
        strings.
        """
        return self.reasons.text()

    #: as :attr:`reason`
    message = reason

    def to_xarray(self) -> Dataset:
        """Return the equilibria as a dataset of xarray, with names and units as attributes.

        Returns
        -------
        xarray.Dataset
            Its last axis is ``equilibrium``; the axes before it are those of the loads, of which
            one load has none.  They have the names that labelled arguments give them.  Without
            labels a single axis is called ``state``, and several are called ``state_0``,
            ``state_1`` and so on.  An axis or a coordinate of the labels that has the name NAME of
            a variable, or "equilibrium", is called given_NAME.

            Variables are V, delta, Q, M_half_space, M_cylinder, beta, omega, M, grip, force and
            torque of this result; ``stable``, int8, 0 or 1; ``rate_fast`` and ``rate_slow``, the
            real parts of the eigenvalues, whose imaginary parts are left out; ``loss_slip``,
            ``loss_half_space``, ``loss_cylinder``, ``coefficient`` and ``efficiency``, the fields
            of :class:`Loss`; and ``count``, over the axes of the loads alone.  Padding is NaN, of
            ``stable`` 0.  Units are those of the result; ``reason`` is left out.

        Examples
        --------
        >>> import viscoroll as vr
        >>> vr.steady(vr.presets.RUBBER_CYLINDER, slope=0.005).to_xarray()["V"].attrs["units"]
        'm s-1'
        """
        rates = np.asarray(self.eigenvalues).real
        variables = {name: self[name] for name in (*_FIELDS, "stable")}
        variables |= {"rate_fast": rates[..., 0], "rate_slow": rates[..., 1]}
        # _LOSSES are in the order of the fields of Loss
        return self._dataset(variables | dict(zip(_LOSSES, vars(self.loss).values(), strict=True)))


def append_axis(unit: Any) -> Any:
    """Return the ``unit`` of each load, (loads...), with a last axis of length 1 for its
    equilibria; a number as it is.
    """
    return unit[..., None] if isinstance(unit, np.ndarray) else unit


def pad(rows: Any, count: Integers, shape: tuple[int, ...]) -> Floats:
    """Arrange equilibria, one after another, as arrays over states and equilibria, padded with NaN.

    rows: fields of the equilibria, sorted by state, (m,) each.
    count: number of equilibria of each state, (n,).
    shape: shape of the n states.
    Returns the fields, (fields, states..., equilibria).
    """
    most = int(count.max(initial=0))
    found = np.asarray(rows)
    if most * count.size > found.shape[1]:  # some have fewer
        found = np.full((len(rows), count.size, most), np.nan)
        found[:, np.arange(most) < count[:, None]] = rows
    return found.reshape(len(rows), *shape, most)
