"""The arguments of the functions of heat, checked and flattened, and the heat of the body in each
state: :class:`HeatStates`.

A body has one temperature theta: capacity dtheta/dt = w(V, theta) - conductance (theta - ambient),
with w the part of the loss that heats it, W per m of length.

The reference is the material at its own ``temperature``.  At theta all its times are multiplied by
a_T and all its moduli by b_T, so that the law at theta is that of the reference at the speed V a_T
and, since the contact length at rest changes, at kappa sqrt(b_T) (:class:`ShiftCurve`).  This fails
for a body with b_T beside an elastic one, whose modulus stays: their law at theta is made where it
is read.
"""

import math
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from ..contact_mechanics import (
    Field,
    Roller,
    evaluate_law,
    loads_of,
    pure_rolling_fields,
    refuse_arrays,
    resolve_model,
    states_at,
)
from ..core import (
    Floats,
    Integers,
    ModelWarning,
    ParameterError,
    ViscorollError,
    broadcast_rows,
    broadcast_shape,
    check_array,
    check_array_extent,
    check_number,
    described_error,
    make_dimensionless,
)
from ..laws import LawTable
from ..materials import (
    ABSOLUTE_ZERO,
    WLF,
    Arrhenius,
    Material,
    Pair,
    Solid,
    check_celsius,
    relative_shift,
    vertical_factor,
)

# --- The shift of a body over the temperature ---

#: nodes in an octave of a_T, as of the scan over speed of ``steady``: kappa M has at most one
#: extremum between two
NODES = 16
#: size of log2 of a_T and of kappa V a_T beyond which no contact is evaluated
FARTHEST = 900
#: temperatures, degrees Celsius, between which a function without a ``range`` is sampled: from the
#: coldest at which rubbers are measured to far beyond the hottest at which one lasts
_SAMPLED_RANGE = -150.0, 1000.0
#: samples of such a function; a step is then 0.23 K, over which ln a_T is straight to 1e-3
_SAMPLES = 5001
#: rise of log2 a_T between samples that is rounding
_ROUNDING = 1e-12
#: dimensionless speed at which the moments are those of the limit of low speed, to rounding
_SLOWEST = 1e-30
#: smallest divisor: the quotient for a divisor <= 0 is then larger than any other
_LEAST = 1e-300
#: a_T and sqrt(b_T) at m temperatures, (m,) each, dimensionless; the second may be a number
Factors = tuple[Floats, Any]


@dataclass(frozen=True, eq=False)
class ShiftCurve:
    """a_T and sqrt(b_T), relative to the reference, at many temperatures.

    material : the material at its reference.
    low, high : temperatures between which the shift is defined and a double holds a_T, degrees
        Celsius; high is inf of a WLF and an Arrhenius.
    temperature_of : function of log2 a_T, (n,), that returns temperatures between low and high; of
        a function interpolated between samples.
    slope, pole, own : log2 a_T = slope/(theta - pole) - own, K, degrees Celsius and dimensionless,
        of a WLF or Arrhenius without vertical shift; slope is 0 of others.
    ends : slopes of log2 a_T at low and high, 1/K, with which others are extrapolated.
    """

    material: Material
    low: float
    high: float
    temperature_of: Callable[[Floats], Floats]
    slope: float = 0.0
    pole: float = 0.0
    own: float = 0.0
    ends: Any = (0.0, 0.0)

    def factors(self, theta: Floats) -> Factors:
        """Return a_T and sqrt(b_T), (n,) each, relative to the reference, dimensionless.

        They have the bits of ``Material.at``, which calls the shift for each temperature.

        theta: temperatures, degrees Celsius, (n,); outside of low to high the nearer end is taken.
        """
        shift: Any = self.material.shift
        vertical = self.material.vertical_shift
        reference = self.material.temperature
        inside = theta.clip(self.low, self.high)
        # each temperature once, as a shift is a slow function of one number
        different, index = np.unique(inside, return_inverse=True)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ModelWarning)  # of temperatures that look like kelvin
            unit = 1.0 if reference is None else shift(reference)
            found = [
                (shift(at) / unit, math.sqrt(vertical_factor(vertical, at, reference)))
                for at in different.tolist()
            ]
        a_T, root_b = np.reshape(found, (-1, 2)).T
        return a_T[index], root_b[index]

    def at(self, theta: Floats) -> Factors:
        """Return a_T and sqrt(b_T) as :meth:`factors`, but fast and at any temperature.

        A WLF or Arrhenius is evaluated by its formula, which agrees to rounding.  Beyond the range
        of other shifts log2 a_T goes on as a straight line, and b_T as a constant.

        theta: temperatures, degrees Celsius, (n,).
        """
        if self.slope:
            log2 = self.slope / np.maximum(theta - self.pole, _LEAST) - self.own
            return np.exp2(log2.clip(-FARTHEST, FARTHEST)), 1.0
        a_T, root_b = self.factors(theta)
        below = self.ends[0] * np.minimum(theta - self.low, 0.0)
        above = self.ends[1] * np.maximum(theta - self.high, 0.0)
        return np.exp2((np.log2(a_T) + below + above).clip(-FARTHEST, FARTHEST)), root_b

    def nodes(self, cold: float, hot: float) -> Floats:
        """Return temperatures from ``cold`` to ``hot``, ascending, between which log2 a_T falls by
        at most 1/16 within the range of the shift, (m,).
        """
        # a_T falls with temperature: least at the hot end
        least, most = NODES * np.log2(self.at(np.array([hot, cold]))[0])
        inner = self.temperature_of(np.arange(math.floor(least), math.ceil(most) + 1) / NODES)
        return np.unique(np.concatenate([[cold, hot], inner[(inner > cold) & (inner < hot)]]))


def shift_curve(material: Material) -> ShiftCurve:
    """Return the curve of a material's shift, which is kept.

    Raises ParameterError for a material without a shift, for a shift that is not defined at the
    reference or does not fall with temperature.
    """
    return _make_curve(material, id(material.shift), id(material.vertical_shift))


@lru_cache(maxsize=64)
def _make_curve(material: Material, *shifts: int) -> ShiftCurve:
    """Return the :class:`ShiftCurve` of a material, kept for equal arguments.

    material: the material.
    shifts: what tells its shifts from others, since materials compare equal without them, and a
        function need not have a hash; the material that is kept keeps its shifts too.
    Raises ParameterError for a missing shift, and for one that rises with temperature or is not
    defined at the reference.
    """
    reference = material.temperature
    shift: Any = material.shift
    vertical = material.vertical_shift
    if shift is None:
        raise ParameterError(
            "shift",
            None,
            "given to the viscoelastic Material, as shift=vr.WLF(T0=20.0); in a file as key wlf or "
            "arrhenius",
        )
    if isinstance(shift, WLF | Arrhenius) and vertical is None:
        pole = shift.pole
        slope = shift.slope / math.log(2.0)
        own = slope / ((shift.T0 if reference is None else reference) - pole)

        def temperature_of(x: Floats) -> Floats:
            return pole + slope / np.maximum(x + own, _LEAST)

        # where log2 a_T reaches the largest that is evaluated
        low = pole + slope / (FARTHEST + own)
        return ShiftCurve(
            material=material,
            low=low,
            high=math.inf,
            temperature_of=temperature_of,
            slope=slope,
            pole=pole,
            own=own,
        )
    theta, a_T = _sampled(shift, reference, vertical)
    log2 = np.log2(a_T)
    if (rises := np.flatnonzero(np.diff(log2) > _ROUNDING)).size:
        raise described_error(
            "shift",
            f"rises with the temperature at {theta[rises[0]]:.4g} degrees Celsius",
            "a function that returns shift factors a_T, which do not rise with the temperature",
        )
    # log2 a_T falls: reversed it ascends, as interpolation requires
    slopes = np.diff(log2) / np.diff(theta)
    return ShiftCurve(
        material,
        low=float(theta[0]),
        high=float(theta[-1]),
        temperature_of=lambda x: np.interp(x, log2[::-1], theta[::-1]),
        ends=slopes[[0, -1]],
    )


def _sampled(shift: Any, reference: float | None, vertical: Any) -> tuple[Floats, Floats]:
    """Sample a shift in the range around the reference in which it and a vertical one are defined.

    shift: function of a temperature in degrees Celsius, whose attribute ``range``, if it has one,
        is (lowest, highest) temperature.
    reference: temperature of the material, degrees Celsius; None: that at which a_T is 1.
    vertical: vertical shift, as in :func:`vertical_factor`.
    Returns (temperatures, degrees Celsius, ascending and evenly spaced; a_T there), (n,) each.
    Raises ParameterError for a shift that is not defined at the reference, and a vertical one
    without a reference.
    """
    vertical_factor(vertical, reference or 0.0, reference)  # which is needed beside it
    low, high = getattr(shift, "range", _SAMPLED_RANGE)
    theta = np.linspace(low, high, _SAMPLES)
    a_T = np.full(theta.size, np.nan)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        for n, at in enumerate(theta.tolist()):
            try:
                vertical_factor(vertical, at, reference)
                a_T[n] = relative_shift(shift, at, reference)
            except (ViscorollError, ArithmeticError, ValueError):
                continue
    unknown = np.flatnonzero(np.isnan(a_T))
    if unknown.size == theta.size:
        raise described_error(
            "shift",
            "gives no number > 0 at the reference temperature of the material"
            + f", {reference} degrees Celsius" * (reference is not None),
            "a function that returns shift factors a_T, numbers > 0, there and around it",
        )
    own = np.nanargmin(np.abs(np.log(a_T)))  # at the reference a_T is 1
    first = unknown[unknown < own].max(initial=-1) + 1
    last = unknown[unknown > own].min(initial=theta.size)
    return theta[first:last], a_T[first:last]


# --- Bodies that are heated ---

#: M and its parts, fields of a result.
MOMENTS = "M", "M_half_space", "M_cylinder"


class Heated(NamedTuple):
    """The body of a roller that has a temperature, or both of one material, which then have one.

    material : its material.
    part : its part of the loss in rolling.
    slip : its part of the loss in slip.
    """

    material: Material
    part: float
    slip: float


@dataclass(frozen=True, eq=False)
class HeatStates:
    """States of a call, flattened to vectors of one length (n,), and the one body that is heated.

    roller : the cylinder, on its slope.
    law : the law of all states at the reference, under ``loads`` that with traction (as ``steady``
        has it), or the materials of which each state has one.
    loads : dimensionless, beside V: force or torque; None: half-spaces that roll freely.
    body, curve : the body and its shift.
    remade : whether the shape of the law changes with temperature: a vertical shift beside an
        elastic body.
    shape : shape of the states.
    ambient, conductance : of each state, degrees Celsius and W/(m K).
    R, load, kappa, mu : of each state, m, N/m, and dimensionless.
    material : index of the material of each state, a float as laws take it.
    V : speed of each state, m/s, any sign; None where the load gives it.
    capacity, start : of each state, J/(m K) and degrees Celsius; None but of a warming.
    """

    roller: Any
    law: Any
    loads: Any
    body: Heated
    curve: ShiftCurve
    remade: bool
    shape: tuple[int, ...]
    ambient: Floats
    conductance: Floats
    R: Floats
    load: Floats
    kappa: Floats
    mu: Floats
    material: Floats
    V: Any = None
    capacity: Any = None
    start: Any = None

    def heat(self, n: Integers, theta: Floats, V: Any, more: Any = 1.0) -> Floats:
        """Return the heat of the body, W/m, (m,).

        n: indices of states, (m,).
        theta: temperatures, degrees Celsius, (m,).
        V: speeds, m/s, any sign, a number or (m,).
        more: factor of the load of the state, a number or (m,); other than 1 only for half-spaces
            without force and torque.
        Where friction cannot carry the load, the heat is that without slip.
        """
        _, rolling, slip = self._roll(n, self.curve.at(theta), V, more)
        return self.body.part * rolling + self.body.slip * slip

    def fields(self, n: Integers, theta: Floats, V: Floats) -> dict[str, Floats]:
        """Return the fields of a result by name, in SI units, (m,) each.

        n, theta, V: indices of states, temperatures and speeds, as in :meth:`heat`.

        ``a_T`` is NaN outside of the range of the shift, and M where the friction does not suffice:
        the others mean nothing there.
        """
        factors = self.curve.factors(theta)
        moments, rolling, slip = self._roll(n, factors, V)
        return dict(zip(MOMENTS, moments * (self.load[n] * self.R[n]))) | {
            "C_rr": moments[0],
            "loss": rolling + slip,
            "loss_slip": slip,
            "V": V,
            "temperature": theta,
            "a_T": np.where(theta > self.curve.high, np.nan, factors[0]),
        }

    def _roll_freely(
        self, n: Integers, factors: Factors, V: Any, more: Any
    ) -> tuple[Floats, Floats, Floats]:
        """Return moments and losses of free rolling at temperatures, as :meth:`_roll`.

        factors, n, V, more: as in :meth:`_roll`.  A load that is ``more`` times as large divides
            kappa = R/l0 by the root of ``more``.
        """
        a_T, root_b = factors
        law = self.law
        index = self.material[n]
        kappa = self.kappa[n] * root_b
        unit = self.R[n] / (self.roller.T_ref * a_T)  # as of the Cylinder of this temperature
        if self.remade:
            pair = self.roller.body_data.pair
            heated = (body is self.body.material for body in pair.bodies)
            warm = warm_pair(pair, *(factors if warms else None for warms in heated))
            law = warm.law
            index = np.arange(float(n.size))
            kappa = self.kappa[n] * np.sqrt(warm.E_prime / pair.E_prime)
            unit = self.R[n] / warm.T_ref
        state = [index, kappa / np.sqrt(more), self.mu[n], V / unit, 0.0]
        moments = evaluate_law(law, state, shape=n.shape, creep_is_omega=False, names=MOMENTS)
        rolling = self.load[n] * more * np.abs(V) * np.abs(moments[0])
        return moments, rolling, np.zeros(n.size)

    def _roll(
        self, n: Integers, factors: Factors, V: Any, more: Any = 1.0
    ) -> tuple[Floats, Floats, Floats]:
        """Return the moments at temperatures, and the losses.

        factors: a_T and sqrt(b_T) at these temperatures, (m,) each, or a number.
        n, V, more: as in :meth:`heat`; at V = 0, where the losses are 0, the state under loads is
            that of the limit of low speed.
        Returns (the :data:`MOMENTS` divided by P R, (3, m), NaN where the friction does not
        suffice; loss in rolling and loss in slip, W/m, (m,) each).
        """
        if self.loads is None:
            return self._roll_freely(n, factors, V, more)
        a_T, root_b = factors
        # over R/T_ref at the temperature, whose T_ref is a_T times that of the reference
        speed = np.abs(V) * self.roller.T_ref * a_T / self.R[n]
        # one for each state, also where V is a number
        sign = np.where(V < 0.0, -1.0, 1.0) + np.zeros(n.size)
        vectors = {name: getattr(self.loads, name)[n] for name in ("force", "torque", "mu", "j")}
        kappa = self.loads.kappa[n] * root_b / np.sqrt(more)
        loads = self.loads._replace(kappa=kappa, **vectors)
        moving = np.where(speed == 0.0, _SLOWEST, speed)
        rows = states_at(self.law, loads, np.arange(n.size), sign, moving).rows
        half_space, cylinder, delta = rows[[Field.M_HALF_SPACE, Field.M_CYLINDER, Field.DELTA]]
        moments = np.where(np.isnan(delta), np.nan, [half_space + cylinder, half_space, cylinder])
        delta = np.nan_to_num(delta)
        # as Steady.loss: what shear changes in the moments is taken from friction
        rolling = rows[Field.FREE_HALF_SPACE] + (1.0 + delta) * rows[Field.FREE_CYLINDER]
        slip = delta * rows[Field.Q] + half_space + (1.0 + delta) * cylinder - rolling
        power = V * self.load[n] * more
        return moments, np.abs(rolling * power), np.abs(slip * power)


def warm_pair(pair: Pair, *factors: Factors | None) -> Pair:
    """Return m pairs of half-spaces, one for each state of temperature.

    pair: both bodies at the reference.
    factors: for the cylinder, then for the base, (a_T, sqrt(b_T)) at the m temperatures, (m,) each,
        dimensionless; None: that body does not change.
    """
    cylinder, base = (
        warm_solid(body, *each) if each else body for body, each in zip(pair.bodies, factors)
    )
    return Pair(cylinder, base, pair.plane)


def warm_solid(body: Any, a_T: Floats, root_b: Any) -> Solid:
    """Return m bodies, one for each state of temperature, as a :class:`Solid`.

    body: a Material or a Solid at the reference.
    a_T, root_b: a_T and sqrt(b_T) at the m temperatures, (m,) each, dimensionless.
    """
    prony = body.prony.slower(a_T.clip(1e-90, 1e90))  # beyond, M is 0 and times are refused
    return Solid(
        E=body.E * root_b**2, nu=body.nu, prony=prony, T_ref=body.T_ref, thickness=body.thickness
    )


def heated_body(roller: Roller, call: str, slip_share: float) -> Heated:
    """Return the body of a roller that loses heat, or both as one of one material.

    roller: a Cylinder whose material has a shift; what else is refused.
    call: name of the function, for errors.
    slip_share: the cylinder's part of the loss in slip, in [0, 1].
    Raises ParameterError for a Scene, for a cylinder by E to T_sigma, for bodies that do not relax
    and for two that do and differ in material, thickness, reference temperature or shift.
    """
    slip_share = check_number("slip_share", slip_share, low=0.0, high=1.0)
    pair = roller.body_data and roller.body_data.pair
    if pair is None:
        raise described_error(
            "roller",
            f"given to vr.{call} has no Material",
            "a Cylinder(material=Material(..., shift=...)), since a Scene, or a Cylinder made of "
            "E, nu, T_epsilon and T_sigma, has no temperature",
        )
    bodies = (pair.cylinder, slip_share), (pair.half_space, 1.0 - slip_share)
    # all loss in rolling is that of the body that relaxes, if there is one alone
    found = [Heated(body, 1.0, slip) for body, slip in bodies if body.prony.alpha > 1.0]
    if not found:
        raise described_error(
            "material",
            "and base are elastic or rigid, and roll without loss",
            "viscoelastic, at least one of the two",
        )
    # each has half of both losses, at one temperature; equal series are not enough for that
    same = "thickness", "temperature", "shift", "vertical_shift"
    one, other = ([getattr(body, name) for name in same] for body in pair.bodies)
    if pair.like and one == other:
        return Heated(pair.cylinder, 0.5, 0.5)
    if len(found) > 1:
        raise described_error(
            "base",
            "is viscoelastic too, and differs from material",
            "elastic, rigid, or the same material with equal thickness, temperature and shift; "
            "for the temperatures of two different half-spaces call vr.pair_temperatures",
        )
    return found[0]


def heat_states(
    roller: Any,
    call: str,
    given: dict[str, Any],
    slip_share: float = 0.5,
    driven: dict[str, Any] | None = None,
) -> HeatStates:
    """Check the arguments of a call, and flatten the states of the one body that is heated.

    roller: the first argument of the call, on its slope.
    call: name of the function, for errors.
    given: "ambient", "conductance", and others that take part in the shape, as "V": numbers or
        arrays without labels; None: not given.
    slip_share: as in :func:`heated_body`.
    driven: force, torque and slope beside V, by name; None: the cylinder rolls freely, which of a
        table of the coupled solution and of a cover is the torque 0.
    Returns the :class:`HeatStates`, n states as the shape of all arguments and of the roller has.
    Raises ParameterError for values out of range, shapes that do not broadcast, several laws of
    covers or under a load, an ambient outside the range of the shift, two bodies with a temperature
    each, a vertical shift of a cover or beside an elastic body under a load.
    """
    roller, scene, scale = resolve_model(roller, call)
    body = heated_body(roller, call, slip_share)
    curve = shift_curve(body.material)
    # those that a call needs: None is refused too; others are left out then
    lows = {"conductance": 0.0, "capacity": 0.0, "ambient": -math.inf}
    arrays = {
        name: check_array(name, value, above=lows.get(name, -math.inf))
        for name, value in given.items()
        if value is not None or name in lows
    }
    for name in ("ambient", "start"):
        if name in arrays:
            check_ambient(arrays[name], curve, name)
    vertical = body.material.vertical_shift is not None
    pair = roller.body_data.pair
    # the law keeps its shape beside a rigid body, of share 0 or 1 of the other, and of like bodies
    remade = vertical and not pair.like and pair.share not in (0.0, 1.0)
    covered = scene.cover is not None
    if driven is None and (covered or (scene.tabulated and not remade)):
        driven = {"force": None, "torque": 0.0, "slope": None}
    if driven is not None:
        refuse_arrays(roller, scene, ("alpha",))
    if vertical and (covered or (remade and driven is not None)):
        raise described_error(
            "vertical_shift",
            "of the Material is given "
            + (
                "for a cover" if covered else "beside an elastic body, under force, torque or slope"
            ),
            "left out there, as the contact law would differ at each temperature",
        )
    several = scene.material_array
    index: Any = 0.0 if several is None else np.arange(float(len(several)))
    arrays |= {
        "R": roller.R,
        "load": roller.load,
        "kappa": scene.kappa,
        "mu": scene.mu,
        "material": index,
    }
    shape = broadcast_shape(**arrays)
    flat = dict(zip(arrays, broadcast_rows(arrays.values(), shape)))
    for name in ("force", "torque", "slope"):  # take part in the shape alone
        flat.pop(name, None)
    loads = None
    if driven is not None:
        force, torque = (
            make_dimensionless(name, driven[name], scale) for name in ("force", "torque")
        )
        # a V of 1 says that the speed is given and one load is found; speeds come with each call
        loads = loads_of(scene, force, torque, driven["slope"], V=np.ones(shape))
    return HeatStates(
        roller=roller,
        law=(scene.table if loads is None else scene.rolling_law) or several,
        loads=loads,
        body=body,
        curve=curve,
        remade=remade,
        shape=shape,
        **flat,
    )


def check_ambient(ambient: Any, curve: ShiftCurve, name: str) -> None:
    """Raise ParameterError for a temperature outside the range of a shift, and warn of one that
    looks like kelvin.

    ambient: temperatures, degrees Celsius, a number or an array.
    curve: shift of the body that has it.
    name: name of the argument.
    """
    array, ends = check_array_extent(name, ambient, above=ABSOLUTE_ZERO)
    for at in dict.fromkeys(ends if array.size else ()):
        check_celsius(name, at)
        if not curve.low <= at <= curve.high:
            raise described_error(
                name,
                f"= {at:g} degrees Celsius is outside the range of the material's shift factors",
                f"at least {curve.low:g} degrees Celsius"
                + f" and at most {curve.high:g}" * math.isfinite(curve.high),
            )


@lru_cache(maxsize=16)
def curve_of_moments(law: LawTable) -> Floats:
    """Return kappa M of a law at log2 kappa V = n/16 - 900, all of them."""
    x = np.arange(2 * FARTHEST * NODES + 1) / NODES - FARTHEST
    return pure_rolling_fields(law, np.exp2(x), "M")[0]
