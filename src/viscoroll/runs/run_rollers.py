"""Roller and drive of the motions of a block, from sections of a run file whose numbers may be
arrays.
"""

from functools import cached_property
from pathlib import Path
from typing import Annotated, Any, ClassVar

import msgspec
import numpy as np

from ..core import Named, ParameterError, Scale, Schedule, check_array, section_error
from ..materials import (
    SECTIONS,
    Material,
    Measured,
    Solid,
    parse_materials,
    parse_series,
    relative_shift,
    vertical_factor,
)
from ..presets import make_roller
from ..rollers import Cylinder, Scene

# --- Sections of a run file beside the roller's and [run] ---

#: A list of numbers that is not empty.
Numbers = Annotated[list[float], msgspec.Meta(min_length=1)]


class StartSection(msgspec.Struct):
    """[start]: start speeds; an omega0 "rolling" is replaced before.

    V0 : initial speed of the axis, of any sign, in m/s or divided by R/T_ref; left out if [drive]
        has V.
    omega0 : initial angular velocity, of any sign, in rad/s or divided by 1/T_ref, or "rolling" for
        V0/R; left out if [drive] has omega.
    """

    V0: float | None = None
    omega0: float | None = None


class ScheduleSection(msgspec.Struct):
    """{ times = [...], values = [...] }: a piecewise linear load."""

    times: Numbers
    values: Numbers


#: A load or a prescribed speed: a number, a function of time, or none.
Load = float | ScheduleSection | None


class DriveSection(msgspec.Struct):
    """[drive]: loads, and prescribed speeds.

    force : force on the axis in the direction of V, in N/m or divided by P.
    torque : torque on the cylinder in the direction of omega, in N m/m or divided by P R.
    brake : largest torque of a brake, >= 0, in N m/m or divided by P R.  It acts against omega, and
        keeps omega = 0 while the torque that it must hold does not exceed it.
    slope : angle of the slope, rad, > 0 if +V points downhill: P sin(slope) is added to ``force``.
        The normal load is then P cos(slope), by which dimensionless forces and torques are divided.
    drag : torque of the bearing against omega, divided by omega, >= 0, in N m s/m or divided by
        P R T_ref.  It is part of ``torque`` of the result.
    V : prescribed speed of the axis, in place of ``force``; it must not jump.  V0 of [start] is
        then left out, or the value of V at t = 0.
    omega : prescribed angular velocity, in place of ``torque``; it must not jump.  omega0 of
        [start] is then left out, or the value of omega at t = 0.
    """

    force: Load = None
    torque: Load = None
    brake: Load = None
    slope: float | None = None
    drag: float | None = None
    V: Load = None
    omega: Load = None


class HeatSection(msgspec.Struct):
    """[heat]: the material of a motion is at the temperature at which its cylinder, from cold,
    rolls at a speed.

    ambient : temperature of the surroundings, degrees Celsius.
    conductance : heat that a metre of the roller gives off for each kelvin above ambient, W/(m K).
    speed : speed of the long rolling that warms the roller, m/s; default: V0 of the motion.
    """

    ambient: float
    conductance: float
    speed: float | None = None


#: Sections whose numbers may be uncertain -> their keys, in the order in which inputs are drawn.
RUN_SECTIONS: Named = {"start": StartSection, "drive": DriveSection, "heat": HeatSection}


# --- The motions that they describe ---


class Rollers(Cylinder):
    """Cylinders that have a material each, in SI units; validity and warnings do not examine them.

    Its ``material`` and ``base`` may be a :class:`Solid`, whose numbers are arrays (n,).  If
    T_epsilon is an array, each motion has its own unit of time.  Times are counted in s then: gamma
    only scales time in the equations of motion of V and omega, Eq. (22) of the paper, and
    gamma/T_epsilon in place of gamma makes its unit the second for all motions.
    """

    body_data = None  # type: ignore[assignment]
    about: ClassVar[Named] = {}

    @property
    def seconds(self) -> bool:
        """Whether times are counted in s."""
        return np.ndim(self.T_epsilon) > 0

    @property
    def T_ref(self) -> Any:
        """Unit of time of the law, s: with ``seconds`` T_epsilon, (n,), else the float of a
        :class:`Cylinder`.
        """
        return self.T_epsilon if self.seconds else super().T_ref

    @cached_property
    def _scene(self) -> Scene:
        """The :class:`.Scene` of the motions, computed once.

        Without ``seconds`` it is that of a :class:`Cylinder`.  With ``seconds`` alpha is
        T_epsilon/T_sigma, (n,), and gamma is P T_epsilon/(m R), 1/s, (n,), so that its motions
        count time in s; kappa, mu and j are dimensionless.
        Raises ParameterError where one of them is out of range, or the bodies have no common law.
        """
        if not self.seconds:
            return super()._scene
        T = self.T_ref
        scene = self._scene_of(T / self.T_sigma)
        # gamma = P T_ref^2/(m R) of T_ref = T: over T it is 1/s, as the class counts time
        return scene.replace(gamma=scene.gamma / T)

    @cached_property
    def scale(self) -> Scale:  # type: ignore[override]
        """SI value of 1 of each dimensionless quantity, by its name, as a :class:`.scale.Scale`.

        With ``seconds`` those of t, onset_time and rest_time are the float 1.0, in s; that of x is
        R/T_epsilon times 1 s, in m, and that of angle 1/T_epsilon times 1 s, in rad, both (n,), as
        paths are integrals of speeds over s.  All others, and all without ``seconds``, are those of
        a :class:`Cylinder`: a float where everything in the unit is a number, as 1.0 of a ratio,
        else an array (n,).
        """
        scale = super().scale
        if self.seconds:
            in_seconds = dict.fromkeys(("t", "onset_time", "rest_time"), 1.0)
            scale.update(in_seconds, x=scale["V"], angle=scale["omega"])
        return scale


def roller_of(path: Path, content: Named) -> Scene | Cylinder:
    """Return the roller of the motions of a block.

    path: path of the run file, for errors and the files that it names.
    content: name of a section -> keys and values, with numbers or arrays (n,) in place of the
        uncertain numbers, and the top-level key "preset" -> name, if the file has it.  With
        "cylinder" that section and "material" and "base" are read (the last two may be a
        :class:`Material` already); without it "scene" and "preset".
    Returns a :class:`Scene` without a section [cylinder]; :class:`Rollers` if T_epsilon or the
    materials differ between motions; else a :class:`Cylinder`.  The other numbers of all three may
    be arrays (n,).
    Raises ParameterError for a value out of range or a missing one, shapes that do not broadcast,
    bodies that do not go together, or an unknown preset; FileError for a material or a series that
    cannot be read or is wrong; ValueError for arrays of different n in one list of a series,
    TypeError for an unknown or a missing key of [cylinder] or [scene].
    """
    if "cylinder" not in content:
        return make_roller(path, content, {})
    numbers = content["cylinder"]
    bodies = {name: _body(path, name, content[name]) for name in SECTIONS if name in content}
    if "heat" in content:
        bodies = _warm_bodies(path, content, numbers, bodies)
    solids = any(isinstance(body, Solid) for body in bodies.values())
    differ = solids or np.ndim(numbers.get("T_epsilon", 0.0))
    return (Rollers if differ else Cylinder)(**numbers, **bodies)


def _warm_bodies(path: Path, content: Named, numbers: Named, bodies: Named) -> Named:
    """Return the bodies of all motions at the temperatures at which their cylinders roll.

    path: path of the run file, for errors.
    content: sections as in :func:`roller_of`, of which [heat] and [start] are read.
    numbers: [cylinder], numbers or arrays (n,); bodies: "material" and "base", those that the file
        has.
    Returns the bodies, of which those that relax are at the coldest equilibrium: a
    :class:`Material` of one temperature, a :class:`Solid` of several.
    Raises FileError if no speed is given; ParameterError for a material that is uncertain itself,
    and as :func:`viscoroll.temperature`.
    """
    heat = content["heat"]
    speed = heat.get("speed", content["start"].get("V0"))
    if speed is None:
        problem = "speed is missing: give it in m/s, as [start] has no V0"
        raise section_error(path, "heat", "speed", problem)
    for name, body in bodies.items():
        if isinstance(body, Solid):
            sentence = (
                f"{name} has uncertain numbers, which [heat] refuses: fix them or remove [heat]"
            )
            raise ParameterError(name, "uncertain", "fixed", sentence)
    ambient = heat["ambient"]
    found = Cylinder(**numbers, **bodies).temperature(
        speed, ambient=ambient, conductance=heat["conductance"]
    )
    for reason, theta, V in np.broadcast(found.reason, ambient, speed):
        if reason:
            text = f"ambient = {theta:g} °C gives no allowed temperature at V = {V:g} m/s"
            # a roller too hot needs less; a frequency outside of the data may be too high or low
            text = f"{text} ({reason}): change ambient, speed, load or conductance"
            raise ParameterError("ambient", theta, "another temperature", text)
    # the coldest equilibrium, which a roller takes from cold
    theta = found.temperature[..., 0]
    warm = bodies.copy()
    for name, body in bodies.items():
        # a body that does not relax stays as it is
        if body.prony.alpha > 1.0 and not theta.ndim:
            warm[name] = body.at(float(theta))
        elif body.prony.alpha > 1.0:
            from ..heat.heated_bodies import shift_curve, warm_solid

            warm[name] = warm_solid(body, *shift_curve(body).factors(theta))
    return warm


def drive_of(content: Named) -> Named:
    """Return the loads and prescribed speeds of the section [drive] as keywords of
    :func:`viscoroll.ensemble`.

    content: name of a section -> keys and values, in the units of the file, of which "drive" is
        read: numbers, or arrays (n,) for n motions; a table within it has the keys times and
        values, lists of k corners, each a number or (n,).
    Returns name of the load or speed ("force", "torque", "brake", "slope", "drag", "V" or
    "omega") -> number, array (n,) or, of a table, :class:`Schedule`, in the units of the file; {}
    without [drive].  Numbers and arrays are returned themselves and are not checked, nor are the
    names.
    Raises ParameterError, which names the load, for a wrong schedule; ValueError as
    :func:`_schedule` (an empty list, or arrays of different n in one list); TypeError for a table
    with a key missing or unknown.
    """
    return {
        name: _schedule(name, **load) if isinstance(load, dict) else load
        for name, load in content.get("drive", {}).items()
    }


def _schedule(name: str, times: list, values: list) -> Schedule:
    """Make a load, or a prescribed speed, that is piecewise linear in time, from lists by corner.

    name: name of the load or speed, for errors.
    times, values: times and values of its k >= 1 corners, as many of each, a number or (n,) each,
        in the units of the file; times >= 0, not descending, none more than twice.
    Returns the :class:`Schedule`; its times, and likewise its values, are (k,) if all are numbers,
    else (n, k).
    Raises ParameterError, which names the load, for what a Schedule refuses; ValueError for an
    empty list, and for arrays of different n in one list.
    """
    try:
        return Schedule(
            *(np.stack(np.broadcast_arrays(*each), axis=-1) for each in (times, values))
        )
    except ParameterError as error:
        raise ParameterError(name, error.value, error.allowed, f"{name}: {error}") from error


def _first_material(path: Path, name: str, section: Any) -> Material:
    """Return the :class:`Material` of the first motion, which has what does not differ between
    motions, as T_ref.

    path: path of the run file, for errors, and to which files that the section names are relative.
    name: "material" or "base".
    section: dict, the content of that section, SI numbers or arrays (n,), of which the first
        elements are taken, temperatures in degrees Celsius; or the Material if all of it is
        certain.
    Returns that Material itself, else a new one.
    Raises FileError for a section with a wrong key, a value out of range or a temperature without a
    shift, and for a file that it names and that cannot be read.
    """
    return (
        section
        if isinstance(section, Material)
        else parse_materials(path, {name: _first(section)})[name]
    )


def _body(path: Path, name: str, section: Any) -> Any:
    """Return the material of all motions: a :class:`Material`, or a :class:`Solid` if it differs
    between motions.

    A Solid has arrays, so that one call serves all motions.

    path: path of the run file, for errors, and to which files that the section names are relative.
    name: "material" or "base".
    section: dict, the content of that section, SI numbers or arrays (n,), temperatures in degrees
        Celsius; or a Material, which is returned itself.
    Returns the Material of the first motion if no key of E, nu, thickness, series and temperature
    is an array; else a Solid, in which those of E, nu, thickness and series that differ have the
    shape (n,), the others (), and thickness is None of a half-space.  Its T_ref, in s, is that of
    the first motion; a temperature that differs multiplies the relaxation times, and with a
    vertical shift E, by one factor for each motion.  Whether E, nu, thickness and series have one n
    is not compared.
    Raises ParameterError for E or thickness <= 0, E infinite, nu out of (-1, 0.5] or a temperature
    that the shift does not allow, in an array, and where temperatures and series have different n;
    FileError as :func:`_first_material`, and for a series out of range; ValueError for arrays of
    different n in one list of the series.
    """
    typical = _first_material(path, name, section)
    if typical is section:
        return section
    series = parse_series(path, name, section) or typical.prony
    # the series, and T_ref, are those at the temperature of the first motion
    factors = _time_factors(typical, section)
    if np.ndim(factors):
        series = series.slower(factors)
    E, nu, thickness = (section.get(key, getattr(typical, key)) for key in ("E", "nu", "thickness"))
    if not (series.shape or any(map(np.ndim, (E, nu, thickness)))):
        return typical
    if thickness is not None:
        thickness = check_array("thickness", thickness, above=0.0)
    # a given E is that at the reference temperature, that of ``typical`` at its temperature
    E = check_array("E", E, above=0.0) * (typical.E / E[0]) if np.ndim(E) else typical.E
    if np.ndim(factors) and typical.vertical_shift:
        shift, base = typical.vertical_shift, typical.temperature
        E = E * np.array([vertical_factor(shift, at, base) for at in section["temperature"]])
    return Solid(
        E=E,
        nu=check_array("nu", nu, above=-1.0, high=0.5),
        prony=series,
        T_ref=typical.T_ref,
        thickness=thickness,
    )


def measured_bands(path: Path, content: Named) -> dict[Measured, tuple[Any, Any]]:
    """Return the transit frequencies for which the data of each body suffice, at the temperature of
    each motion.

    path : path of the run file, for errors, and to which files that a section names are relative.
    content : name of a section -> keys and values, with numbers or arrays (n,) in place of the
        inputs, of which the sections "material" and "base" are read; either may be a
        :class:`Material`.
    Returns record of a measurement, a :class:`Measured` -> its ``transit_band``, lowest and highest
    transit frequency, 1/s, arrays (n,) where the temperature differs between motions, else floats.
    Bodies without a record, as a given series is, are left out; of two bodies with equal records
    the band of "base" is returned; {} if there is no record.
    Raises FileError as :func:`_first_material`, ParameterError for a temperature that the shift
    does not allow.
    """
    bands: dict[Measured, Any] = {}
    if "heat" in content:  # the temperatures are known when the rollers are made, which warns
        return bands
    for name in (name for name in SECTIONS if name in content):
        section = content[name]
        typical = _first_material(path, name, section)
        if record := typical.measured:
            factors = 1.0 if typical is section else _time_factors(typical, section)
            low, high = record.transit_band
            bands[record] = low / factors, high / factors
    return bands


def _time_factors(typical: Material, section: Named) -> Any:
    """Return the factors of the relaxation times at the temperature of each motion, relative to
    those of the first.

    typical: material of the first motion, at its temperature.  Where temperatures differ it has a
        shift, of the section or of the file that the section names.
    section: content of the section [material] or [base], whose "temperature", in degrees Celsius,
        may be an array (n,).
    Returns the factors, dimensionless, > 0, (n,), of which the first is 1: below 1 where a motion
    is hotter than the first, so that its material relaxes faster; the number 1.0 if the temperature
    is a number or not given.
    Raises ParameterError for a temperature that the shift does not allow.
    """
    if not np.ndim(section.get("temperature", 0.0)):
        return 1.0
    shift: Any = typical.shift
    return np.array(
        [relative_shift(shift, at, typical.temperature) for at in section["temperature"]]
    )


def _first(part: Any) -> Any:
    """Return a part of a section with the first element of each of its arrays, a float, in place of
    the array.

    part: a table, list, number or text of the section; arrays are (n,).
    Returns a new dict or list of a table or list, a float of an array, any other part itself.
    """
    if isinstance(part, dict):
        return {key: _first(member) for key, member in part.items()}
    if isinstance(part, list):
        return [_first(member) for member in part]
    return float(part[0]) if isinstance(part, np.ndarray) else part
