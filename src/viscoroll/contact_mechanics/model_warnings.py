"""Warnings of states and motions that the model does not describe: all :class:`ModelWarning` are
given here.

Worker processes never warn.  The texts of faults do not depend on the values of a call, though
fixed limits may occur in them, so that Python shows the same one once for each line of a program.
In a scene, which is dimensionless, kappa = R/l0 with the contact length at rest l0, mu is the
coefficient of friction, gamma = P T_ref^2/(m R), j the moment of inertia over m R^2, M the rolling
moment over P R.
"""

import bisect
import dataclasses
import functools
import operator
from collections.abc import Collection
from typing import Any

import numpy as np

from ..core import warn_of_model
from ..kernels.numerics.cache_folder import is_worker
from ..materials import Bodies, Cover, Measured, Prony
from .assumptions import (
    LEAST_KAPPA,
    MISFIT_LIMIT,
    NOT_SMALL,
    WAVE_LIMIT,
    assess_measured_band,
    transit_frequency,
)
from .body_data import BEYOND_SERIES, BodyData, extent_of, is_outside
from .free_rolling import FreeRolling, curve_of
from .model_validity import STEADY_LIMIT
from .parameters import PARAMETERS, Parameters, Roller

#: Creepage from which on a start in full slip has M in doubt, dimensionless: the surface speeds
#: then differ by V.
_CREEP = 1.0
#: Smallest M divided by mu, dimensionless, at which an M in doubt matters for a motion in full
#: slip.
_LEAST_M_OVER_MU = 0.1
#: Largest kappa M divided by 1 - 1/alpha at any speed, dimensionless, of one relaxation time, to a
#: fifth (docs/theory.md).
_LARGEST_M = 0.25
#: Part of the distance of free rolling, dimensionless, that may lie at speeds where the error of V
#: exceeds 10 %.  It is the whole distance where the motion starts below that speed.
_SLOW_PART = 0.1
#: (kappa V)^2 divided by gamma (1 - 1/alpha)/(1 + j), dimensionless, from which on that part is
#: below _SLOW_PART for every material: (kappa V)^2 |N| is at most 1.35/16 of 1 - 1/alpha
#: (docs/validity_low_speed.md), and the distance grows at least in proportion to V.
_FAST = 1.35 / 16.0 / STEADY_LIMIT / _SLOW_PART**2
#: kappa V, dimensionless, from which on (kappa V)^2 N of one relaxation time is at least 0.6/16 of
#: 1 - 1/alpha; at lower speeds N passes 0.  The least found is 0.64/16, at this speed and alpha
#: near 1.
_LEAST_FAST_ROLLING = 1.0
#: (kappa V)^2 divided by gamma (1 - 1/alpha)/(1 + j), dimensionless, below which the error of V
#: exceeds 10 % at the start already, for one relaxation time and kappa V above that speed.
_SLOW = 0.6 / 16.0 / STEADY_LIMIT
#: Fault of a motion or contact, where a density is known; M is doubtful from :data:`WAVE_LIMIT` on
#: already.
_FASTER_THAN_WAVES = (
    "|V| or R |omega| exceeds the shear wave speed sqrt(G/density) of a body (up to "
    f"{WAVE_LIMIT:g} times that speed is allowed)"
)
#: Fault of a motion or contact whose lengths were given in mm.
_MILLIMETRES = (
    "R is at least 5 m, or a layer is at least 0.5 m thick, and the contact of this load is much "
    "shorter: lengths must be in m; if they are in mm, divide them by 1000"
)
#: Fault of a motion or contact on a cover whose peak pressure exceeds the modulus.
_SOFT = (
    "the peak pressure on the layer exceeds its modulus E/(1 - nu^2): strains are not small "
    "(are moduli in Pa, the load in N/m and lengths in m?)"
)
#: Warning of a contact far above the rates of a series.
_BEYOND_SERIES = (
    "M is probably too small: at this V and temperature the transit frequency (V divided by the "
    f"contact length) is above {BEYOND_SERIES:g} divided by the shortest relaxation time of the "
    "Prony series, so that the series has almost no loss, which a rubber has; give a series with "
    "shorter times"
)
#: Calls that report the assumptions of a motion.
_REPORTS = "validity(V) of the roller, or validity() of the result,"
#: Largest number of motions of an ensemble that are examined, evenly spaced: some milliseconds.
_EXAMINED = 256
#: Data of materials for which this process has warned already.
_warned_records: set[Measured] = set()
#: Takes the numbers of a scene.
_numbers_of = operator.attrgetter(*PARAMETERS)


def _warn_of_faults(faults: list[str], subject: str, report: str) -> None:
    """Give one :class:`ModelWarning` of several faults, at the caller's line outside the package;
    none in worker processes.

    faults: sentences without a full stop, whose text does not depend on the values of the call
        (fixed limits may occur); [] gives no warning.
    subject: "motion" or "contact".
    report: the call that reports each assumption, as "validity(V).small_contact", for the message.
    Returns None.
    """
    if faults and not is_worker():
        warn_of_model(
            f"the model does not hold for this {subject}: {'; '.join(faults)}.  {report} reports "
            "each assumption"
        )


def warn_of_contact(
    roller: Roller,
    V: Any,
    extent: tuple[float, float] | None = None,
    *,
    motion: bool = False,
    a_T: Any = None,
) -> None:
    """Warn of contacts at rest longer than the radius, speeds above the shear wave speed, and
    unmeasured frequencies.

    These are at most two warnings, of :func:`_warn_of_faults` and :func:`_warn_of_band`.  Only the
    extreme speeds are examined; rest is passed over, since M = 0 there, and speeds on both sides of
    0 are compared with the upper end of the band alone.
    roller: scene or cylinder; a scene has no data to compare with, and never warns.
    V: speeds, m/s, any sign and shape, NaN where they are not known; None, for prescribed ones that
        are not known, gives no warning.
    extent: (smallest, largest) of the speeds, m/s, signed, where the caller knows them; None: they
        are found.
    motion: whether the speeds are of a motion, which :func:`warn_of_start` has examined, so that
        neither the length at rest nor the shear wave speed gives a warning here.
    a_T: shift factor of each speed: rates at V are those at V a_T at the reference temperature, for
        which the band is known; None: 1.
    """
    data = roller.body_data
    if data is None or data.covered_speeds is None or V is None:
        return
    ends = extent or extent_of(V)
    reduced = V if a_T is None else V * a_T
    of_band = ends if a_T is None else extent_of(reduced)
    if not (is_outside(ends, data.covered_speeds) or is_outside(of_band, data.covered_speeds)):
        return
    if not motion:
        waves = data.wave_speed
        # speeds have signs: the lowest may be the fastest
        too_fast = waves is not None and bool(ends[1] > waves or -ends[0] > waves)
        _warn_of_faults(
            [NOT_SMALL] * (not data.small_at_rest)
            + _absurd_sizes(data)
            + [_FASTER_THAN_WAVES] * too_fast,
            "contact",
            "validity(V) of the roller",
        )
    if data.measured_speeds is not None and is_outside(of_band, data.measured_speeds):
        _warn_of_band(data, reduced)
    if data.series_speeds and is_outside(of_band, data.series_speeds) and not is_worker():
        warn_of_model(_BEYOND_SERIES)


def _absurd_sizes(data: BodyData) -> list[str]:
    """Return the faults of lengths as if in mm, and of a layer too soft for the load."""
    return [_MILLIMETRES] * (not data.in_metres) + [_SOFT] * data.soft_for_load


def _warn_of_band(data: BodyData, V: Any) -> None:
    """Warn of transit frequencies outside the measured band, once for each material in a process;
    workers do not warn.

    The warning may still be left out: each speed is compared with the band of its own cylinder,
    while the caller compares the extremes of all of them.  A fit that misses its data gives it at
    every speed, with that cause.
    data: data of the bodies of a cylinder, of which at least one was measured.
    V: speeds, m/s, any sign; a number, or (n, ...) where ``data`` has n cylinders.
    With a warning the measurements of the bodies are entered into :data:`_warned_records`.
    """
    records = data.records.values()
    if is_worker() or _warned_records.issuperset(records):
        return
    assert data.measured_rates is not None
    # The extreme speeds and the extreme l0 may belong to different cylinders.
    l0 = np.reshape(data.l0, np.shape(data.l0) + (1,) * (np.ndim(V) - np.ndim(data.l0)))
    rates = extent_of(np.abs(V) / l0)
    causes = [
        f"the fit of {body} misses its data by more than {MISFIT_LIMIT:.0%}, so M is uncertain at "
        f"every speed: {record}"
        for body, record in data.records.items()
        if record.misfit > MISFIT_LIMIT
    ]
    if is_outside(rates, data.measured_rates):
        ends = np.array(rates)
        sentence = assess_measured_band(
            transit_frequency(ends, data.relative_length(ends)), data.records
        ).sentence
        causes.append(
            f"M and the contact length are extrapolated beyond the measurements: {sentence}; "
            "validity(V).measured reports which speeds are inside"
        )
    if causes:
        _warned_records.update(records)
        warn_of_model("; ".join(causes))


def warn_of_unmeasured_starts(share: float, records: Collection[Measured]) -> bool:
    """Warn of motions of a run that start outside the measured band of a material, once for each
    material in a process; workers do not warn.

    share: fraction of all motions that start outside, 0 to 1; 0 gives no warning.
    records: what was measured of the bodies, :class:`Measured` each; contacts do not warn of them
        again.  If all of them have given a warning before, also if there are none, there is no
        warning.
    Returns whether a warning was given, a bool.
    """
    if share <= 0.0 or is_worker() or _warned_records.issuperset(records):
        return False
    _warned_records.update(records)
    warn_of_model(
        f"the rolling moment M is extrapolated: {share:.1%} of the motions start at a V that needs "
        "moduli at frequencies at which the material was not measured "
        f"(at the medians of the inputs {'; '.join(map(str, records))})"
    )
    return True


def warn_of_speeds(roller: Roller, V0: Any, V: Any) -> None:
    """Warn where the fastest speed of a motion, or of each of several, is outside the measured band
    of a material.

    Slow speeds are not compared: a motion that ends at rest passes them.  The material has one
    warning in a process.
    roller: scene or cylinder; a scene has no data, and never warns.
    V0: start speeds, m/s, any sign, a number or (n,); None, for prescribed ones, counts as 0.
    V: speeds at the output times, m/s, (times,) or (n, times), NaN where a motion ended before;
        None where they were not computed: then the start speeds are compared alone.
    """
    if roller.body_data is None:
        return
    fastest = np.abs(0.0 if V0 is None else V0)
    if V is not None:
        fastest = np.fmax(fastest, np.fmax.reduce(np.abs(V), axis=-1))
    warn_of_contact(roller, fastest, motion=True)


def warn_of_start(
    roller: Roller, scene: Parameters, start: tuple[Any, Any], V0: Any, omega0: Any, driven: bool
) -> None:
    """Warn of motions for which the model fails grossly, judged by their start.

    There is one warning of speeds above the shear wave speed, where a density is known, and one of
    all other faults: a contact longer than the radius, a creepage of order 1 in full slip, a free
    motion too slow for the quasi-steady assumption.  One motion from two floats costs one or two
    microseconds; of an ensemble at most three are examined (:func:`_worst_start_faults`).
    roller: scene or cylinder, on its slope.
    scene: dimensionless parameters of the roller, with gamma.
    start: (V, omega) at the start as the caller gave them, m/s and rad/s for a cylinder, numbers or
        (n,); None for a prescribed one, which counts as 0; of a scene not used.
    V0, omega0: the start speeds, dimensionless; floats or arrays (n,).
    driven: whether something drives the motions, or they are rolled with the added mass N; slowness
        is not a fault then.
    """
    data = roller.body_data
    if data is not None and data.wave_speed is not None:
        V, omega = (0.0 if speed is None else np.abs(speed) for speed in start)
        if np.max(np.maximum(V, omega * data.R), initial=0.0) > data.wave_speed:
            _warn_of_faults([_FASTER_THAN_WAVES], "motion", _REPORTS)
    numbers = [*_numbers_of(scene), V0, omega0]
    if type(V0) is type(omega0) is float and not scene.shape:
        faults = _start_faults(scene.material, driven, *numbers)
    else:
        faults = _worst_start_faults(scene, numbers, driven)
    if data is not None:
        faults += _absurd_sizes(data)
    _warn_of_faults(faults, "motion", _REPORTS)


def _start_faults(
    material: Any,
    driven: bool,
    alpha: float,
    kappa: float,
    mu: float,
    gamma: float,
    j: float,
    V0: float,
    omega0: float,
) -> list[str]:
    """Return sentences on what the model does not describe in one motion, judged by its start.

    The faults are kappa below 1; full slip with |omega0 - V0| >= |V0| where M is not small beside
    the friction; and a free motion whose error of V exceeds 10 % on more than a tenth of its
    distance, judged at the start speed or at that at which it begins to roll, whichever is larger.
    material: Prony series, bodies or cover of the roller, None of one relaxation time; a cover is
        never too slow, since its N is not known.
    alpha, kappa, mu, gamma, j: parameters of the scene, dimensionless.
    V0, omega0: start speeds, dimensionless, any sign; rest is no fault.
    driven: whether something drives the motion, or it is rolled with the added mass N; it may be
        slow then.
    Returns the sentences, without full stops, three at most, whose text does not depend on the
    arguments; an empty list where there is no fault.
    """
    faults: list[str] = []
    part = 1.0 - 1.0 / alpha
    if kappa < LEAST_KAPPA:
        faults.append(NOT_SMALL)
    if abs(omega0 - V0) >= _CREEP * abs(V0) and _LARGEST_M * part > _LEAST_M_OVER_MU * mu * kappa:
        fastest = max(abs(V0), abs(omega0))
        if fastest > 0.0 and (material is not None or part * fastest > _LEAST_M_OVER_MU * mu):
            faults.append(
                "the cylinder starts in full slip with a creepage (omega R - V)/V of 1 or more in "
                "magnitude: until it is in partial slip its rolling moment is uncertain, as it is "
                "computed with V for both surfaces"
            )
    # the speed at the start, or that at which it begins to roll
    u = kappa * max(abs(V0), abs(V0 + j * omega0) / (1.0 + j))
    if (
        not driven
        and type(material) is not Cover
        and u > 0.0
        and _is_too_slow(material, alpha, u, gamma, j)
    ):
        faults.append(
            "the cylinder is too slow for the law of steady rolling: the computed speed has an "
            "error above 10 % on more than a tenth of the distance to rest (unsteady=True reduces "
            "the error; it needs half-spaces of one material)"
        )
    return faults


def _is_too_slow(material: Any, alpha: float, u: float, gamma: float, j: float) -> bool:
    """Return whether a free motion from a speed is too slow for the law of steady rolling.

    It is where the error of V exceeds 10 % on more than a tenth of its distance.  Bounds of N
    decide most motions: the table of :func:`_slow_starts` takes a second where its kernels are not
    compiled yet.
    material: Prony series or bodies, no cover, None of one relaxation time; an elastic one is never
        too slow.
    u: kappa |V| at the start, dimensionless, > 0.
    alpha, gamma, j: parameters of the scene, dimensionless.
    Returns a bool; where the bounds do not decide, that of the next lower speed of the table, 16 to
    an octave.
    """
    ratio = u * u * (1.0 + j)
    scale = gamma * (1.0 - 1.0 / alpha)
    if ratio >= _FAST * scale:
        return False
    if material is None and u >= _LEAST_FAST_ROLLING and ratio < _SLOW * scale:
        return True
    lower_ends, slow = _slow_starts(alpha if material is None else None, material, gamma, j)
    # the entry at or below u; below the table the first one
    return slow[max(bisect.bisect(lower_ends, u) - 1, 0)]


def _worst_start_faults(scene: Parameters, numbers: list[Any], driven: bool) -> list[str]:
    """Return the faults of the model in those motions of an ensemble, three at most, that are worst
    by simple bounds: of the smallest kappa, of the largest loss in full slip, and of the largest
    unsteadiness.

    scene: dimensionless parameters of the roller, of which the material is read.
    numbers: alpha, kappa, mu, gamma and j of the scene, and the start speeds V0 and omega0,
        dimensionless, any sign, numbers or arrays (n,); n may be 0.
    driven: whether something drives the motions, or they are rolled with the added mass N; slowness
        is not a fault then.
    Returns the sentences of :func:`_start_faults`, each once; an empty list where these motions
    have no fault, or there are none.  Of more than :data:`_EXAMINED` motions that many, evenly
    spaced, are compared by the bounds.
    """
    arrays = np.broadcast_arrays(*np.atleast_1d(*numbers))
    count = arrays[0].size
    if not count:
        return []
    examined = np.linspace(0, count - 1, min(count, _EXAMINED), dtype=int)
    columns = np.array([array[examined] for array in arrays])
    alpha, kappa, mu, gamma, j, V0, omega0 = columns
    part = 1.0 - 1.0 / alpha
    with np.errstate(over="ignore", divide="ignore", invalid="ignore"):
        # the speed at the start, or that at which slip ends, by the momentum that Q cannot change;
        # then N as at high speeds, where it falls as u^-2, and the loss of full slip
        u = kappa * np.maximum(np.abs(V0), np.abs(V0 + j * omega0) / (1.0 + j))
        unsteady = np.where(u > 0.0, gamma * part / (1.0 + j) / u**2, 0.0)
        slips = np.where(np.abs(omega0 - V0) >= _CREEP * np.abs(V0), part / (mu * kappa), 0.0)
    several = scene.material_array
    faults: list[str] = []
    for worst in {np.argmax(measure) for measure in (-kappa, slips, unsteady)}:
        material = scene.material if several is None else several[examined[worst]]
        faults += _start_faults(material, driven, *columns[:, worst].tolist())
    return list(dict.fromkeys(faults))


@functools.lru_cache(maxsize=64)
def _slow_starts(
    alpha: float | None, material: Prony | Bodies | None, gamma: float, j: float
) -> tuple[list[float], list[bool]]:
    """Tabulate whether a free motion that starts at kappa V is too slow for the law of steady
    rolling.

    The table is kept for the next call.
    alpha, material: one of both, not elastic, no cover; None for the other.
    gamma, j: parameters of the scene, dimensionless, > 0.
    Returns (kappa V, ascending, floats, dimensionless, 16 to an octave over all speeds at which the
    material relaxes; whether more than a tenth of the distance from there to rest has an error of V
    above 10 %, bools), two lists of one length.
    """
    scene = Parameters(alpha, kappa=1.0, mu=1.0, gamma=gamma, j=j, material=material)
    free = FreeRolling.of_scene(scene, 0.0)
    curve: Any = curve_of(free.materials[0])  # an elastic one, without a curve, is never slow
    free = dataclasses.replace(free, u=np.exp(curve.ln_u))
    slow = free.reach(STEADY_LIMIT).left > _SLOW_PART * free.distance()
    return (free.u * free.speed).tolist(), slow.tolist()
