"""The fits of measured moduli: :func:`fit_prony`, :func:`fit_relaxation`, and of moduli measured at
several strains :func:`fit_at_strain`.

Filled rubbers soften with the strain (Payne).  The contact depends on the moduli, and its strain on
the contact, so that the strain is a fixed point: contact -> strain -> moduli -> contact.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any, Literal, TypedDict, Unpack, overload

import numpy as np

from ..core import (
    ConvergenceError,
    Numbers,
    ParameterError,
    check_choice,
    check_integer,
    check_number,
    describe_value,
    described_error,
)
from ..materials import (
    LARGEST_TIME_RATIO,
    MOST_MODES,
    Material,
    Prony,
    VerticalShift,
    check_celsius,
)
from .dma_reader import RelaxationModulus
from .dynamic_moduli import (
    SAME_TEMPERATURE,
    UNITS,
    Curve,
    DynamicModuli,
    Relaxation,
    data_of,
    kramers_kronig,
    misfits,
    spectrum_of,
    thinned,
)
from .fit_results import Fit, Misfit, Mode, RelaxationFit
from .master_curve import master_curve
from .spectrum import fewest_modes

# --- Fits of moduli of one set ---

#: ratio of the highest to the lowest frequency that a fit may have; times reach a decade beyond on
#: either side
MOST_SPREAD = LARGEST_TIME_RATIO / 100.0
#: ratio of the last to the first relaxation modulus above which it is none: noise on a plateau
#: stays below
_RISES = 1.1


class _Options(TypedDict, total=False):
    """Options of :func:`fit_prony`, described there, that hold for columns and for records
    alike.
    """

    misfit: float
    temperature: Numbers | None
    reference: float | None
    shift: Numbers | Callable[[float], float] | None
    on: Literal["both", "storage"]
    mode: Mode | None
    source: str
    vertical_shift: VerticalShift


@overload
def fit_prony(
    omega: DynamicModuli, *, modes: int | None = None, **options: Unpack[_Options]
) -> Fit: ...
@overload
def fit_prony(
    omega: Numbers,
    storage: Numbers,
    loss: Numbers,
    modes: int | None = None,
    **options: Unpack[_Options],
) -> Fit: ...
def fit_prony(
    omega: Numbers | DynamicModuli,
    storage: Numbers | None = None,
    loss: Numbers | None = None,
    modes: int | None = None,
    *,
    misfit: float = 0.01,
    temperature: Numbers | None = None,
    reference: float | None = None,
    shift: Numbers | Callable[[float], float] | None = None,
    on: Literal["both", "storage"] = "both",
    mode: Mode | None = None,
    source: str = "",
    vertical_shift: VerticalShift = None,
) -> Fit:
    """Fit a Prony series to storage and loss modulus.

    The strengths are those of non-negative least squares of the relative errors of both moduli, on
    times that reach half a decade or a decade beyond the data (at the slow end less, down to half a
    decade inside, where else no long-time modulus is left).  Then modes are left out until there
    are as few as the misfit needs, and their times are refined too.

    Parameters
    ----------
    omega : angular frequencies, rad/s, > 0, (n,), in any order, repeated or not; or what
        :func:`viscoroll.read_dma`
        returns, alone: its moduli, temperatures, mode and source are then taken.  With
        ``temperature`` a list of curves, one vector each, or a 2-D array of one a row, is allowed
        too.
    storage, loss : storage and loss modulus at them, > 0, (n,), both in one unit; lists where
        ``omega`` is one.
    modes : number of modes, an int from 1 to 64; fewer are returned only where the least squares
        give no more modes a strength > 0.  Default: as few as ``misfit`` needs, or, where no grid
        reaches it, as few as come within 5 % of the least misfit.
    misfit : root mean square of the relative errors that E' and E'' may each have, dimensionless, >
        0 (0.01 is 1 %).  With ``modes`` it decides ``reached`` of the result alone.
    temperature : degrees Celsius: one number of all points; one a point, (n,), as measured (those
        within 0.5 K of one another are one curve); or one a curve, (curves,), where the columns are
        lists of curves.  None: not known, the points are of one curve.  The curves are shifted to
        ``reference`` first.
    reference : temperature of the master curve, degrees Celsius, at which its times are.  Default:
        where a given shift is 1 (T0 of a :class:`WLF`, the temperature of a factor of 1), if it is
        within the temperatures; else the middle one of the curves.  With a list of factors it must
        be one of the curves' temperatures, to 0.5 K.
    shift : factors a_T > 0, dimensionless, (curves,), in the order of the curves (of points: in the
        order in which the temperatures come), or a function that takes a temperature in degrees
        Celsius and returns a_T.  They are divided by that of the reference, so that constants may
        be those of another temperature.  None: found from the overlap of neighbouring curves.
    on : "both", or "storage" to find the shifts from the overlap of the storage modulus alone,
        where the loss modulus is noisy or does not shift alike.
    mode : "tension" (default) or "shear", where the moduli are G' and G'';
        :meth:`fit_results.Fit.material` makes E of them.
    source : source of the data, in words; it stays with the material.
    vertical_shift : b_T by which the moduli of each curve are divided, relative to the reference,
        before they are
        shifted: "entropic", the absolute temperature, or a function of a temperature in degrees
        Celsius; it stays with the material.  None: moduli are not changed.

    Returns
    -------
    Fit
        ``print`` shows a report; E, storage and loss are in the unit of the data, times in s, at
        the reference temperature.  Where the misfit cannot be reached, ``reached`` is False, and
        nothing is raised.

    Raises
    ------
    ParameterError
        Fewer than 3 points, or a curve of fewer than 2 frequencies; values outside of 1e-100 to
        1e100; columns of other shapes; frequencies that span more than 30 decades; a curve that
        does not level off at low frequencies; neighbouring curves that do not overlap; factors
        larger at the highest temperature than at the lowest; a reference outside of the curves, or
        of which the factors say nothing; ``modes``, ``misfit``, ``on`` or ``mode`` that are not
        allowed; ``reference`` or ``shift`` without ``temperature``; ``omega`` without ``storage``
        and ``loss``, or a record with them; another ``mode`` than that of the record; a unit of
        another dimension.
    RuntimeError
        The non-negative least squares of SciPy do not end.

    Warns
    -----
    ModelWarning
        Where the curves are so flat that their overlap does not fix the shifts; temperatures that
        look like kelvin.

    Examples
    --------
    >>> import viscoroll as vr
    >>> fit = vr.fit_prony(vr.read_dma(vr.datasets.path("dma.csv")))
    >>> fit.reached, fit.mode
    (True, 'tension')

    Notes
    -----
    More than 1000 points are thinned to the means of 500 logarithmic bins; ``points`` and the
    report say so.
    """
    strain = None
    if isinstance(omega, DynamicModuli):
        record = omega
        strain = record.mean_strain
        _refuse_beside(record, "read_dma", mode, storage=storage, loss=loss)
        omega = record.omega
        storage = record.storage
        loss = record.loss
        mode = _mode(record.mode)
        temperature = record.temperature if temperature is None else temperature
        source = source or record.source
    elif storage is None or loss is None:
        raise described_error(
            "storage" if storage is None else "loss",
            "is not given",
            "given, as fit_prony(omega, storage, loss); or give the result of read_dma alone, as "
            "fit_prony(vr.read_dma('dma.csv'))",
        )
    check_choice("on", on, "both", "storage")
    if not (vertical_shift in (None, "entropic") or callable(vertical_shift)):
        raise ParameterError(
            "vertical_shift", describe_value(vertical_shift), "'entropic' or a function of T in °C"
        )
    mode = _mode(mode)
    if temperature is None:
        for name, value in {
            "reference": reference,
            "shift": shift,
            "vertical_shift": vertical_shift,
        }.items():
            if value is not None:
                raise described_error(
                    name, "is given, but temperature is not", "left out, or temperature given too"
                )
        curve = data_of(Curve, omega, storage, loss)
        shifts = None
    else:
        curve, shifts = master_curve(
            omega, storage, loss, temperature, reference, shift, on, vertical_shift
        )
    data, fields, errors = _fit_series(curve, modes, misfit)
    return Fit(
        **fields,
        misfit=Misfit(*errors),
        kramers_kronig=kramers_kronig(data),
        shifts=shifts,
        mode=mode,
        temperature=shifts.reference if shifts else None,
        source=source,
        strain=strain,
        vertical_shift=vertical_shift,
    )


def fit_relaxation(
    t: Numbers | RelaxationModulus,
    relaxation: Numbers | None = None,
    modes: int | None = None,
    *,
    misfit: float = 0.003,
    temperature: float | None = None,
    mode: Mode | None = None,
    source: str = "",
) -> RelaxationFit:
    """Fit a Prony series to a relaxation modulus: what a test at constant strain gives.

    The fit is by non-negative least squares of the relative errors, as in :func:`fit_prony`, on
    times that reach half a decade or a decade beyond the data, but not below half the first time,
    and at the slow end less, down to half a decade inside, where else no long-time modulus is left.

    Parameters
    ----------
    t : times since the strain was applied, s, > 0, (n,), in any order.  Leave out those of the
        ramp: E(t) is that of a step.  Or what :func:`viscoroll.read_relaxation` returns, alone: its
        modulus, temperature, mode and source are then taken.
    relaxation : relaxation modulus at them, stress over strain, > 0, (n,), in one unit.
    modes : number of modes, an int from 1 to 64; fewer are returned only where the least squares
        give no more modes a strength > 0.  None: as few as ``misfit`` needs or, where no grid
        reaches it, as few as come within 5 % of the least misfit.
    misfit : root mean square of the relative errors that E(t) may have, dimensionless, > 0 (0.003
        is 0.3 %).  Rolling resistance is made of E'', which follows from the slope of E(t).  If
        E(t) falls by 10 to 20 % per decade of time, an error of 1 % in E(t) that changes its sign
        within half a decade means 10 to 30 % in E'', one of 0.3 % means 3 to 9 %.  With ``modes``
        it decides ``reached`` of the result alone.
    temperature : temperature of the test, degrees Celsius, or None where it is not known; it stays
        with the material.
    mode : "tension" (default) or "shear", where the modulus is G(t); ``material`` makes E of it.
    source : source of the data, in words; it stays with the material.

    Returns
    -------
    RelaxationFit
        ``print`` shows a report.  Its E is in the unit of the data, its times are in s.  The
        material is taken as measured at rates between 1 over the last and 1 over the first time.
        More than 1000 points are thinned to the means of 500 logarithmic bins first, to which the
        misfit then belongs.  Where the misfit cannot be reached, ``reached`` is False, and nothing
        is raised.

    Raises
    ------
    ParameterError
        Fewer than 3 points; values outside of 1e-100 to 1e100; columns of other shapes; times that
        span more than 30 decades; a modulus whose last value is above 1.1 times the first, or that
        does not level off at long times; ``modes``, ``misfit``, ``mode`` or ``temperature`` that
        are not allowed; a unit of another dimension.
    RuntimeError
        The non-negative least squares of SciPy do not end.

    Warns
    -----
    ModelWarning
        A temperature that looks like kelvin.

    Examples
    --------
    >>> import numpy as np
    >>> import viscoroll as vr
    >>> t = np.geomspace(0.01, 100.0, 30)
    >>> fit = vr.fit_relaxation(t, 1e6 * (1.0 + 2.0 * np.exp(-t / 0.5)))
    >>> round(fit.T_ref, 6), fit.material(nu=0.49).measured.high
    (0.5, 100.0)
    """
    if isinstance(t, RelaxationModulus):
        _refuse_beside(t, "read_relaxation", mode, relaxation=relaxation)
        mode = _mode(t.mode)
        source = source or t.source
        temperature = t.temperature if temperature is None else temperature
        t, relaxation = t
    elif relaxation is None:
        raise described_error(
            "relaxation",
            "is not given",
            "the second argument, fit_relaxation(t, relaxation); or give the result of "
            "read_relaxation alone, as fit_relaxation(vr.read_relaxation('relax.csv'))",
        )
    curve = data_of(Relaxation, t, relaxation)
    first, *_, last = curve.relaxation.tolist()  # data_of has sorted them by time
    if last > _RISES * first:
        raise described_error(
            "relaxation",
            f"rises from {first:g} at the first time to {last:g} at the last",
            "a relaxation modulus, which falls with time (a creep compliance rises)",
        )
    _, fields, errors = _fit_series(curve, modes, misfit)
    temperature = None if temperature is None else check_celsius("temperature", temperature)
    return RelaxationFit(
        **fields,
        misfit=errors[0],
        mode=_mode(mode),
        source=source,
        temperature=temperature,
    )


def _refuse_beside(record: Any, reader: str, mode: Any, **columns: Any) -> None:
    """Raise ParameterError for arguments that contradict or repeat a record, of ``reader``.

    mode, columns : arguments of the fit, None where they are not given.
    """
    for name, given in columns.items():
        if given is not None:
            raise described_error(
                name,
                f"is given beside the result of {reader}",
                "left out, since that result contains it; give a number of terms by name, as "
                "modes=5",
            )
    if mode not in (None, record.mode):
        raise ParameterError(
            "mode",
            repr(mode),
            f"{record.mode!r}, as read from {record.source or 'the data'} (or assumed, if no "
            "heading says it), or left out; to change it, in Python: dataclasses.replace(record, "
            "mode=...)",
        )


def _mode(mode: Any) -> Mode:
    """Check which modulus was measured and return it, "tension" of None; raise ParameterError for
    anything but "tension" or "shear".
    """
    mode = "tension" if mode is None else mode
    check_choice("mode", mode, "tension", "shear")
    return mode


def _fit_series(
    curve: Any, modes: int | None, misfit: float
) -> tuple[Any, dict[str, Any], tuple[float, ...]]:
    """Fit a series to measured moduli: the part that :func:`fit_prony` and :func:`fit_relaxation`
    have in common.

    curve : a :class:`Curve` or :class:`Relaxation`, all points that were measured.
    modes : number of modes, 1 to 64, with which ``misfit`` decides "reached" alone; None: as few as
        the misfit needs (:func:`.spectrum.fewest_modes`).
    misfit : root mean square of the relative errors that each modulus may have, dimensionless, > 0.
    Returns (the data that were fitted, of the class of ``curve``, thinned if it has more than 1000
    points; a dict of arguments of :class:`.fit_results.Fit` or :class:`.fit_results.RelaxationFit`:
    E, T_ref, prony, target, reached, grid, band and points (both of ``curve``), outside, and the
    columns of the data; the root mean square of the relative errors of each modulus, dimensionless,
    (storage, loss) or (relaxation,)).  A series without modes has T_ref
    = 1.
    Raises ParameterError for ``misfit`` or ``modes`` out of range, frequencies or times whose
    largest ratio is above :data:`MOST_SPREAD`, 1e30, and data without a long-time modulus;
    RuntimeError as :func:`.spectrum.on_times`.
    """
    target = check_number("misfit", misfit, above=0.0)
    modes = None if modes is None else check_integer("modes", modes, 1, MOST_MODES)
    low, high = curve.band
    data = thinned(curve)
    if high > MOST_SPREAD * low:
        shifted = ", or correct the shift, if curves were shifted" * isinstance(data, Curve)
        raise described_error(
            data._fields[0],
            f"extends from {data[0][0]:g} to {data[0][-1]:g} {UNITS[data._fields[0]]}",
            f"within a factor of {MOST_SPREAD:g}; leave out points at either end{shifted}",
        )
    spectrum, grid, reached = fewest_modes(data, target, modes)
    T_ref = float(spectrum.tau.max(initial=0.0)) or 1.0  # 1 without modes
    prony = Prony(spectrum.strength / spectrum.E, spectrum.tau / T_ref)
    fields = {
        "E": spectrum.E,
        "T_ref": T_ref,
        "prony": prony,
        "target": target,
        "reached": reached,
        "grid": grid,
        "band": (low, high),
        "points": curve[0].size,
        # a time belongs to the rate that is its inverse
        "outside": (spectrum.tau < 1.0 / high) | (spectrum.tau > 1.0 / low),
    }
    return data, fields | data._asdict(), misfits(data, spectrum_of(prony, spectrum.E, T_ref))


# --- Moduli at several strains ---

#: ln of the ratio of two strains from which on they are of two sets: tests hold theirs to some per
#: cent
_GAP = math.log(1.2)
#: largest change of ln(strain) of the fixed point, far below what changes moduli by a per cent
_CHANGE = 1e-3
#: fits of the fixed point: each changes the strain by some tenth of the change before
_FITS = 30


def fit_at_strain(
    records: DynamicModuli | Sequence[DynamicModuli], cylinder: Any, V: float, **options: Any
) -> Fit:
    """Fit a Prony series to moduli measured at several strains, at the strain of a contact.

    Parameters
    ----------
    records : what :func:`viscoroll.read_dma` returns, one record or several, of which each point
        has its ``strain``; points whose strains differ by less than a fifth are one set.  A file of
        one temperature must have one strain: read a file for each.
    cylinder : a :class:`viscoroll.Cylinder` without arrays, whose ``material`` is replaced by that
        of each fit; its nu, name, density, thickness and shift stay.
    V : speed, m/s.
    **options : of :func:`viscoroll.fit_prony`.

    Returns
    -------
    Fit
        Of log E' and log E'' interpolated in log strain between two sets of one temperature, or of
        the set nearest to the strain, where it is beyond all sets or they have several
        temperatures;
        ``strain`` is that of these moduli, and ``source`` says which sets they are.  Of one set it
        is ``fit_prony(record)``.

    Raises
    ------
    ParameterError
        A record without strain, no record, two records of one strain or of tension and shear, a
        cylinder without a Material, and as :func:`viscoroll.fit_prony` and
        :func:`viscoroll.validity`.
    ConvergenceError
        A strain that does not settle, as where the nearest of two sets depends on the moduli of
        each.

    Examples
    --------
    >>> from dataclasses import replace
    >>> import numpy as np
    >>> import viscoroll as vr
    >>> soft = vr.read_dma(vr.datasets.path("dma.csv"))
    >>> soft = replace(soft, strain=np.full(soft.omega.size, 0.1))
    >>> stiff = replace(
    ...     soft, storage=2.0 * soft.storage, loss=2.0 * soft.loss, strain=0.01 * soft.strain
    ... )
    >>> roller = vr.Cylinder(
    ...     R=0.1, m=60.0, material=vr.Material(3e6, 0.49, vr.Prony([2.0], [1.0]), 0.01), mu=0.6
    ... )
    >>> fit = vr.fit_at_strain([soft, stiff], roller, 1.0)
    >>> 0.001 < fit.strain < 0.1
    True

    Notes
    -----
    The strain of the contact with the material of the fit is ``strain`` to 1e-3
    (``tests/test_heat.py``).
    """
    sets = _sets_of(records if isinstance(records, (list, tuple)) else [records])
    if len(sets) == 1:
        return fit_prony(sets[0], **options)
    if not isinstance(getattr(cylinder, "material", None), Material):
        raise described_error("cylinder", "has no Material", "a Cylinder with material=...")
    strain = math.exp(np.mean([math.log(each.mean_strain) for each in sets]))
    for _ in range(_FITS):
        # moduli at the strain, the material of them, and the strain of its contact at that speed
        fit = fit_prony(_at_strain(sets, strain), **options)
        body = fit.material(cylinder.material.nu)
        own = {
            name: getattr(body, name) for name in ("E", "prony", "T_ref", "measured", "temperature")
        }
        roller = cylinder.replace(material=replace(cylinder.material, **own))
        last = strain
        strain = float(np.max(roller.validity(V).strain.value))
        if abs(math.log(strain / last)) <= _CHANGE:
            return fit
    raise ConvergenceError(
        "fit_at_strain: the strain of the contact does not converge (its last two values are "
        f"{last:.6g} and {strain:.6g}); fit the data of one strain by fit_prony"
    )


def _sets_of(records: Sequence[Any]) -> list[Any]:
    """Divide records into records of one strain each, by rising strain.

    Two neighbouring strains of a record are of one set if they differ by less than a fifth.

    records : as in :func:`fit_at_strain`.
    Returns a list of :class:`DynamicModuli`.
    Raises ParameterError for what is no record, no record, a record without strain, two of one
    strain, and records of tension beside those of shear.
    """
    found: list[Any] = []
    for record in records:
        if not isinstance(record, DynamicModuli):
            raise ParameterError("records", describe_value(record), "what vr.read_dma returns")
        if record.mean_strain is None:
            raise described_error(
                "records",
                "contain one without a strain above 0 at each point"
                f"{f' ({record.source})' * bool(record.source)}",
                "of files with a column of strain and its unit; fit_prony(record) needs no strains",
            )
        strains = np.asarray(record.strain)
        order = np.argsort(strains, kind="stable")
        # cut behind each strain that the next one exceeds by more than the gap
        parts = np.split(order, np.flatnonzero(np.diff(np.log(strains[order])) > _GAP) + 1)
        # sorted indices: points stay in the order of the record
        found += [_points(record, np.sort(part)) for part in parts]
    means = [each.mean_strain for each in found]
    if not means:
        raise described_error("records", "are empty", "at least one result of vr.read_dma")
    if len({*means}) < len(means):
        given = ", ".join(f"{mean:.4g}" for mean in means)
        raise described_error(
            "records",
            f"have the strains {given}, some of them equal",
            "of different strains; leave out all but one of each, or write data of one strain at "
            "several temperatures into one file",
        )
    if len({each.mode for each in found}) > 1:
        raise described_error(
            "records", "are of tension and of shear", "all of tension or all of shear"
        )
    return sorted(found, key=lambda each: each.mean_strain)


def _points(record: DynamicModuli, at: Any) -> DynamicModuli:
    """Return a record of the points ``at`` of another."""
    columns = {
        name: each[at] for name, each in vars(record).items() if isinstance(each, np.ndarray)
    }
    return replace(record, **columns)


def _at_strain(sets: list[Any], strain: float) -> DynamicModuli:
    """Return the moduli at a strain.

    Between two sets of one temperature the logarithms of both moduli are interpolated in that of
    the strain, at the frequencies that both sets cover; else the moduli are those of the nearest
    set.

    sets : at least two, of :func:`_sets_of`.
    strain : amplitude of strain, dimensionless, > 0.
    Returns a :class:`DynamicModuli`, whose ``source`` names the sets.
    """
    strains = np.array([each.mean_strain for each in sets])
    # sets n - 1 and n are the neighbours, beyond the ends the two nearest
    n = np.searchsorted(strains, strain).clip(1, strains.size - 1)
    part = math.log(strain / strains[n - 1]) / math.log(strains[n] / strains[n - 1])
    less, more = sets[n - 1 : n + 1]
    known = [each.temperature for each in (less, more) if each.temperature is not None]
    isothermal = not known or np.ptp(np.concatenate(known)) <= SAME_TEMPERATURE
    if not (0.0 < part < 1.0 and isothermal):
        near = less if part < 0.5 else more
        return replace(
            near, source=f"{near.source or 'record'}, data at a strain of {near.mean_strain:.3g}"
        )
    both = (less.omega >= more.omega.min()) & (less.omega <= more.omega.max())
    low = _points(less, both)
    more = _points(more, np.argsort(more.omega))
    moduli = {}
    for name in ("storage", "loss"):
        other = np.interp(np.log(low.omega), np.log(more.omega), np.log(getattr(more, name)))
        moduli[name] = np.exp((1.0 - part) * np.log(getattr(low, name)) + part * other)
    source = (
        f"{low.source or 'record'}, interpolated at a strain of {strain:.3g} between data at "
        f"{strains[n - 1]:.3g} and {strains[n]:.3g}"
    )
    strain_of_points = np.full(low.omega.size, strain)
    return replace(low, strain=strain_of_points, source=source, **moduli)
