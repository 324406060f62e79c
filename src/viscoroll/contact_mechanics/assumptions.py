"""The assumptions of the model and their limits: :class:`Assumption`, and :class:`Validity`, which
lists them all.

An assumption has ``value``, the number that decides, ``holds``, a bool or booleans in the shape of
the value, and ``sentence``, which says it in words; the first two are None where no number decides.
"""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from ..core import Floats, SummaryRow, as_html, as_text
from ..laws import evaluate_by_modes
from ..materials import HIGHEST_RATE, Measured, Prony

#: Largest distance from the axis to the far end of the contact, divided by R.  The parabola of the
#: theory lies (x/R)^2/4 = 1 % below the circle there.
REACH_LIMIT = 0.2
#: Largest speed divided by the shear wave speed, dimensionless: below it the load is within 10 % of
#: the static one (the paper's ref. [31], Table 1).
WAVE_LIMIT = 0.2
#: Largest Dundurs' constant, dimensionless.  The normal slope of the surface contains that constant
#: times the shear traction beside the pressure, and the shear traction is at most mu times the
#: pressure.
DUNDURS_LIMIT = 0.05
#: Largest creepage in full slip, dimensionless: the surface speeds of the two bodies differ by this
#: ratio there, and M is computed with the speed of the axis for both.
CREEP_LIMIT = 0.3
#: Largest contact length divided by the thickness of a layer at which the length is within 5 % of
#: that on a half-space for every Poisson's ratio (measured by pipeline/evidence/prove/layer.py).
THICK_LIMIT = 2.0 / 3.0
#: Smallest kappa = R/l0, dimensionless: the contact at rest then ends half a radius from the axis.
#: Below it contacts and motions warn.
LEAST_KAPPA = 1.0
#: Sentence of the warning for a kappa below :data:`LEAST_KAPPA`.
NOT_SMALL = (
    "kappa = R/l0 is below 1: the contact at rest (length l0) is longer than the radius R, too "
    "long for the model (of a Cylinder: are moduli in Pa and the load in N/m?)"
)
#: Largest rise of temperature by a motion, K: a_T of rubber changes by 10 % a kelvin at the most.
HEAT_LIMIT = 1.0
#: Largest root mean square of the relative errors of a fit, dimensionless, at which the fitted
#: material counts as the measured one.
MISFIT_LIMIT = 0.05


class Assumption(NamedTuple):
    """One assumption of the model.

    Attributes
    ----------
    holds : whether it holds, a bool or an array in the shape of V; None where no number here can
        decide.
    value : the number that decides, in the shape of V, of an assumption about the bodies alone a
        single number; None likewise.
    sentence : the largest value, the allowed one, and what to do, in words.
    """

    holds: Any
    value: Any
    sentence: str

    @property
    def word(self) -> str:
        """ "yes" if it holds at every V, "no" if not, "?" where no number can decide."""
        return "?" if self.holds is None else "yes" if np.all(self.holds) else "no"

    def worst_of_parts(self, last: Any) -> "Assumption":
        """Return the assumption with one state for each part of a sequence of states, and the same
        sentence.

        ``holds`` and ``value`` must be arrays over the states, (states,).

        Parameters
        ----------
        last : index of the last state of each part, an array (parts,), ascending; a part begins
            after the one before.

        Returns
        -------
        Assumption
            With holds and value of shape (parts,): those of the first state of the part that
            violates it, else those of its last state.

        Examples
        --------
        >>> import numpy as np
        >>> import viscoroll as vr
        >>> creep = vr.presets.RUBBER_CYLINDER.validity(1.0, omega=[10.0, 20.0, 10.0]).creep
        >>> creep.worst_of_parts(np.array([0, 2])).holds  # the second state slips fully
        array([ True, False])
        """
        faults = np.flatnonzero(~self.holds)
        # the first violation from the begin of each part on, or the number of states if there is
        # none
        next_fault = np.append(faults, self.holds.size)[
            np.searchsorted(faults, np.append(0, last[:-1] + 1))
        ]
        index = np.minimum(next_fault, last)
        return self._replace(holds=self.holds[index], value=self.value[index])

    def __repr__(self) -> str:
        return f"{self.word}: {self.sentence}"


class Validity(NamedTuple):
    """All assumptions of the model, each an :class:`Assumption` with its value and whether it
    holds.

    Values are dimensionless unless a unit is named, and in the shape of V (and omega); where the
    data that an entry needs are missing, ``holds`` and ``value`` are None.

    Attributes
    ----------
    small_contact : value: distance from the axis to the far end of the contact divided by R,
        lam (1 + epsilon)/(2 kappa).
    under_axis : value: epsilon.  Above 1 the whole contact lies ahead of the axis, which the theory
        allows.
    quasistatic : value: speed divided by the shear wave speed; needs a density.
    steady : a :class:`.model_validity.Steadiness`; value: the unsteadiness gamma |N(V)|/(1 + j),
        where M = M(V) + N V' for slow changes of speed.  It decides whether the law of steady
        rolling may drive a motion, and down to which speed; contact states and rolling at constant
        speed do not depend on it.
    creep : value: |delta|.  In full slip the two bodies pass the contact at different speeds, and
        the rolling moment is computed with the speed of the axis for both.  Needs omega.
    bodies : value: Dundurs' constant of the pair, of long times or of the instantaneous moduli,
        whichever is larger in size; needs the materials.
    measured : value: :func:`transit_frequency`, 1/s, compared with
        :attr:`viscoroll.Measured.transit_band` of each body; needs a material's ``measured``.
    thick : for a layer of known thickness; value: half the contact length divided by the thickness.
        Up to its limit one stick zone in front with slip behind is right.
    traction : for a layer, where shear acts back on the pressure; value: 2 |delta_0* -
        delta_0|/delta_star, with the mean strain delta_0* of full slip.  Up to 1 one end of the
        contact slips, as the law assumes.
    plane : plane strain or plane stress, which V does not decide.
    strain : of a Cylinder; value: amplitude of engineering shear strain at the axis, of the softest
        body, compared with the strain of the data, of which a third to three times is allowed.
        ``holds`` is None without the latter.
    heat : of a Motion; value: rise of the temperature by its losses since t = 0, K, if all of them
        stay in one body of the capacity that was given; up to 1 K one temperature stands for the
        motion.

    Examples
    --------
    Printed, each line says yes, no or, where no number can decide, "?".

    >>> import viscoroll as vr
    >>> vr.presets.RUBBER_CYLINDER.validity(2.0).failed
    ()
    """

    small_contact: Assumption
    under_axis: Assumption
    quasistatic: Assumption
    steady: Assumption
    creep: Assumption
    bodies: Assumption
    measured: Assumption
    thick: Assumption
    traction: Assumption
    plane: Assumption
    strain: Assumption
    heat: Assumption

    @property
    def failed(self) -> tuple[str, ...]:
        """Names of the assumptions that fail for at least one V; empty if none is known to fail."""
        return tuple(name for name, assumption in self._asdict().items() if assumption.word == "no")

    def _summary(self) -> tuple[str, list[SummaryRow]]:
        """Return (title, rows) of the printed report."""
        rows = [
            SummaryRow(name, f"{assumption.word:<4} {assumption.sentence}")
            for name, assumption in self._asdict().items()
        ]
        return "Assumptions of the model, and whether they hold", rows

    def __repr__(self) -> str:
        return as_text(*self._summary())

    def _repr_html_(self) -> str:
        return as_html(*self._summary())


#: The report where no number can decide; :func:`.model_validity.validity` replaces what is known.
UNKNOWN = Validity(
    *(
        Assumption(None, None, sentence)
        for sentence in (
            "",
            "",
            "inertia of the bodies is neglected, which is not checked: give density= to a "
            "Material, or to validity of a Cylinder, to find the shear wave speed",
            "whether a motion changes its speed slowly enough for the law of steady rolling is not "
            "checked: give the Scene gamma=",
            "the surface speeds of both bodies are not compared: give the angular velocity omega=",
            "Dundurs' constant, the measure of how shear changes the pressure, is not computed for "
            f"a Scene: use a Cylinder.  Up to {DUNDURS_LIMIT} in magnitude is allowed where "
            "pressure and shear are not solved together; it is 0 for equal materials",
            "the transit frequency (speed divided by contact length) is not compared with the "
            "frequencies of the measurements: use a Cylinder whose Material has measured=",
            "no thickness is given: the law is that of a half-space.  It applies to a layer too, "
            "with an error of the contact length up to 5 %, if the contact is at most "
            f"{THICK_LIMIT:.2g} times as long as the layer is thick",
            "the effect of shear on the pressure is estimated for layers only; for half-spaces see "
            "Dundurs' constant in the line 'bodies'",
            "the state must be plane strain (a long cylinder, or one between walls) or plane "
            "stress (a thin disc)",
            "the strain of the contact is not compared with that of the measurements, as it is not "
            "computed for a Scene: use a Cylinder",
            "each body is taken to have one temperature.  Cylinder.temperature computes that of "
            "long rolling, vr.uniform_temperature whether it is nearly the same throughout a body, "
            "and validity(capacity=) of a motion its rise (capacity: heat stored, J/K per metre)",
        )
    )
)

#: The assumption ``steady`` of a cover.
UNKNOWN_OF_COVERS = Assumption(
    None,
    None,
    "whether a motion changes its speed slowly enough for the law of steady rolling is not checked "
    "on a layer of finite thickness; rolling at constant speed does not need this check",
)


def transit_frequency(V: Any, length: Any) -> Any:
    """Return the transit frequency, the rate at which a point passes the contact: |V| divided by
    the contact length.

    The rolling moment needs the moduli at angular frequencies of this size: half of the loss is
    above 1.8 times it and nine tenths below 4.4 times it, where the loss modulus is constant and
    the pressure that of Hertz.

    V: speed of the axis, any sign, any unit, any shape.
    length: contact length, > 0, not checked, in the unit of length of V; broadcasts with V.
    Returns the rate, >= 0, in the broadcast shape, in the inverse of the unit of time of V: 1/s for
    SI units.
    """
    return np.abs(V) / length


def transit_speeds(series: Prony, rates: Floats) -> Floats:
    """Return kappa V at which the transit frequency has given values, for half-spaces.

    It follows from the transit time 2 zeta by Eq. (6) of the paper, without a root.
    series: :class:`Prony` series of the material, of both bodies together; it may be elastic.
    rates: transit frequencies, multiplied by T_ref of the series, dimensionless, > 0, (n,).
    Returns kappa V at them, dimensionless, (n,).
    """
    h_over_zeta = evaluate_by_modes(series, 0.5 / rates).values[1]
    found: Floats = rates / np.sqrt(1.0 + 2.0 * h_over_zeta)  # 1/lam^2 = 1 + 2 h/zeta, Eq. (6)
    return found


def largest(values: Any) -> float:
    """Return the largest of ``values``, any shape, as a float; 0.0 if there are none, or all are
    negative.
    """
    return float(np.max(values, initial=0.0))


def assess_small_contact(reach: Any) -> Assumption:
    """Compare the far end of the contact with :data:`REACH_LIMIT`.

    reach: distance from the axis to the far end of the contact divided by R, > 0, a number or an
        array of any shape, which may be empty.
    Returns the assumption ``small_contact``, whose value is ``reach``; it holds where that is at
    most 0.2.
    """
    far = largest(reach)
    return Assumption(
        reach <= REACH_LIMIT,
        reach,
        f"the contact reaches {far:.3g} R from the axis; up to {REACH_LIMIT} R is allowed, as the "
        f"model replaces the circle by a parabola (error of its height {25.0 * far * far:.2g} %)"
        + "; reduce the load, or take a stiffer material"
        * (far > REACH_LIMIT),
    )


def assess_position(epsilon: Any) -> Assumption:
    """State whether the axis is above the contact, which the theory does not require.

    epsilon: shift of the contact towards the leading edge in half contact lengths, a number or an
        array of any shape, which may be empty.
    Returns the assumption ``under_axis``, whose value is ``epsilon``; it holds where that is at
    most 1.
    """
    ahead = largest(epsilon)
    where = (
        "the whole contact lies ahead of the axis, which the theory allows: this is no fault"
        if ahead > 1.0
        else "the axis is above the contact"
    )
    return Assumption(
        epsilon <= 1.0,
        epsilon,
        f"shift of the contact epsilon = {ahead:.2g} half contact lengths: {where}",
    )


def assess_heat(losses: Any, capacity: float) -> Assumption:
    """Compare the rise of temperature by the losses of a motion with :data:`HEAT_LIMIT`.

    losses: energy lost since t = 0, J/m, >= 0, any shape; capacity: J/(m K), > 0.
    Returns the assumption ``heat``, whose value is the rise, K; it holds where that is at most 1 K.
    """
    rise = losses / capacity
    return Assumption(
        rise <= HEAT_LIMIT,
        rise,
        f"the losses of the motion warm a body by up to {largest(rise):.2g} K; up to "
        f"{HEAT_LIMIT:g} K is allowed, as a motion is computed at one temperature",
    )


def assess_creep(delta: Any, full_slip: Any) -> Assumption:
    """Compare the creepage in full slip with :data:`CREEP_LIMIT`.

    delta: creepage, dimensionless, any sign and shape, infinite for a cylinder that spins at V = 0.
    full_slip: whether the contact slips fully; broadcasts with delta.
    Returns the assumption ``creep``, whose value is |delta| in the broadcast shape; it holds in
    partial slip at any creepage, and in full slip where |delta| is at most 0.3.
    """
    size, full_slip = np.broadcast_arrays(np.abs(delta), full_slip)
    most = float(np.max(size, initial=0.0, where=full_slip))
    return Assumption(
        ~full_slip | (size <= CREEP_LIMIT),
        size,
        f"in full slip the surface speeds of the two bodies differ by {100.0 * most:.4g} % of V; "
        f"up to {100.0 * CREEP_LIMIT:g} % is allowed, since the rolling moment is computed with "
        "V for both"
        if most > 0.0
        else (
            "the surface speeds of both bodies are nearly equal, since the contact is in partial "
            "slip"
        ),
    )


def assess_inertia(wave_ratio: Any, unknown: Sequence[str], decides: bool) -> Assumption:
    """Compare the speed with the shear wave speed: far below it the inertia of the deforming bodies
    is negligible.

    wave_ratio: speed divided by the shear wave speed, >= 0, any shape; None where no density is
        known.
    unknown: names of the bodies without a density, for the sentence.
    decides: whether the density of the softest body is known; if not, waves in it may be slower
        than the known ones.
    Returns the assumption ``quasistatic``, whose value is the ratio; it holds where that is at most
    0.2.  It is undecided for None, and without ``decides`` unless every ratio is above 0.2.
    """
    missing = "".join(f"; the density of {body} is not known" for body in unknown)
    if wave_ratio is None or not (decides or np.all(wave_ratio > WAVE_LIMIT)):
        return UNKNOWN.quasistatic._replace(sentence=UNKNOWN.quasistatic.sentence + missing)
    return Assumption(
        wave_ratio <= WAVE_LIMIT,
        wave_ratio,
        f"the speed is {100.0 * largest(wave_ratio):.3g} % of the shear wave speed; up to "
        f"{100.0 * WAVE_LIMIT:g} % is allowed, at which inertia changes the load by at most 10 %"
        + missing,
    )


def assess_coupling(long: float, instant: float, *, like: bool, solved: bool) -> Assumption:
    """Compare Dundurs' constant of two bodies with :data:`DUNDURS_LIMIT`.

    long, instant: the constant by the long-time and by the instantaneous moduli, dimensionless, any
        sign.
    like: whether the bodies are alike, so that the constant is 0 at all times; the numbers are not
        used then.
    solved: whether the law is a table of the coupled solution, with which any constant holds.
    Returns the assumption ``bodies``; its value is that of the two constants which is larger in
    size, with its sign, a float, 0.0 for like bodies; it holds, a bool, where its size is at most
    0.05.
    """
    worst = max(long, instant, key=abs)
    if like:
        return Assumption(
            True, 0.0, "cylinder and half-space have the same material: Dundurs' constant is 0"
        )
    if worst == 0.0:
        return Assumption(True, 0.0, "Dundurs' constant is 0: shear does not change the pressure")
    sentence = f"Dundurs' constant is {long:.2g} for slow and {instant:.2g} for sudden loading; "
    if solved:
        sentence += "this is allowed, as pressure and shear are solved together (coupled solution)"
        return Assumption(True, worst, sentence)
    sentence += (
        f"up to {DUNDURS_LIMIT} in magnitude is allowed, as pressure caused by shear is neglected"
    )
    allowed = abs(worst) <= DUNDURS_LIMIT
    return Assumption(allowed, worst, sentence + " with coupled=False" * (not allowed))


def assess_measured_band(frequency: Any, records: Mapping[str, Measured]) -> Assumption:
    """State whether every body was measured at the frequencies that the contact needs: from the
    transit frequency to :data:`HIGHEST_RATE` times it.

    frequency: transit frequency, 1/s, >= 0, any shape.
    records: name of a body -> :class:`Measured`, the band of angular frequencies, rad/s, at which
        it was measured, and the misfit of the fit; for the bodies that have data.
    Returns the assumption ``measured``, whose value is the frequency.  It holds, in that shape,
    where the frequency lies in the ``transit_band`` of every body, ends included, and every fit
    meets its data to :data:`MISFIT_LIMIT`; at V = 0 it does not hold, though M = 0 there.  Without
    records it is undecided.
    """
    if not records:
        return UNKNOWN.measured
    least = np.min(frequency, initial=np.inf)
    most = HIGHEST_RATE * np.max(frequency, initial=0.0)
    sentence = f"the contact needs the moduli from {least:.2g} to {most:.2g} rad/s"
    holds: Any = True
    error = moment_error(frequency, records)
    for body, data in records.items():
        low, high = data.transit_band
        holds = holds & (low <= frequency) & (frequency <= high) & (data.misfit <= MISFIT_LIMIT)
        sentence += f"; {body} was measured from {data}"
        sentence += f"; this misfit is above the allowed {MISFIT_LIMIT:.0%}" * (
            data.misfit > MISFIT_LIMIT
        )
    if (known := error[np.isfinite(error)]).size:
        sentence += "; at the measured frequencies the rolling moment M is accurate to "
        sentence += f"+-{100.0 * known.max():.3g} %"
    return Assumption(holds, frequency, sentence)


def moment_error(frequency: Any, records: Mapping[str, Measured]) -> Any:
    """Return the accuracy of M by the data of the bodies: the largest of their
    :meth:`viscoroll.Measured.moment_error`.

    frequency: transit frequency, 1/s, >= 0, any shape.
    records: name of a body -> :class:`Measured`, of the bodies that have data.
    Returns it as +-, relative, in that shape: infinite outside the band of a body, NaN where it is
    not known of any.
    """
    errors = [data.moment_error(frequency) for data in records.values()]
    return np.fmax.reduce([np.full(np.shape(frequency), np.nan), *errors])
