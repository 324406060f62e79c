"""Rollers by name and in TOML files, and files of a material or pair that has a contact law.

By name: the cylinder, the scenes and the starts of the paper, and a rubber roller.  All files have
one schema: a run file is a scene file in which any number may be uncertain, with a
start and [run].  :mod:`.core.files` refuses unknown keys and wrong types; the objects that a
section describes refuse values out of range.
"""

import pathlib
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from .core import (
    FileError,
    FilePath,
    ParameterError,
    as_section_error,
    as_struct,
    check_keys,
    check_one_given,
    read_toml,
    section_error,
    unknown_name_error,
)
from .materials import (
    SECTIONS,
    SUFFIX,
    CreepSection,
    Material,
    Pair,
    Plane,
    Prony,
    PronySection,
    parse_materials,
    parse_series,
    read_materials,
)
from .rollers import Cylinder, Scene

__all__ = [
    "PAPER_CYLINDER",
    "PAPER_FIGURES_2_3",
    "PAPER_SECTION_5",
    "PAPER_SECTION_5_ROUNDED",
    "PAPER_STARTS",
    "RUBBER_CYLINDER",
    "RUBBER_ROLLER",
]

# --- Rollers by name ---

#: Cylinder of Sect. 5 as computed in the paper: from the dimensional list of Sect. 4 with g = 9.81
#: m/s^2 and mu = 0.2, SI units.  Gives alpha = 11.031, kappa = 2.9210, gamma = 11231 and the
#: paper's numbers.
PAPER_CYLINDER = Cylinder(R=0.1, m=35.5, E=2.3e5, nu=0.49, T_epsilon=10.7, T_sigma=0.97, mu=0.2)
#: Its dimensionless scene.
PAPER_SECTION_5 = PAPER_CYLINDER.scene()
#: The rounded parameters printed at the end of Sect. 4; stick onset of IC1 moves 2 % later.
PAPER_SECTION_5_ROUNDED = Scene(alpha=11.0, kappa=2.91, mu=0.2, gamma=1.1e4)
#: Figs. 2 and 3 use kappa = 29.1, ten times that of Sects. 4-5; alpha is varied there
#: (1, 1.5, 21.5, 81.5 in Figs. 2 and 3b, 11 in Fig. 3a).
PAPER_FIGURES_2_3 = PAPER_SECTION_5_ROUNDED.replace(kappa=29.1)
#: The paper's cylinder made of a rubber with short times, so that the law of steady rolling may
#: drive its motion at any speed (:meth:`Scene.validity`): R = 0.1 m, m = 35.5 kg/m, mu = 0.3, j =
#: 0.5, load m g = 348 N/m; long-time modulus E = 3 MPa, nu = 0.5, density 1130 kg/m^3, and a Prony
#: series with the strengths (divided by E) 0.3, 0.6, 1.5 and the times 20 ms, 1 ms, 10 us, also of
#: the half-space.
#: T_ref is 1 s: V of its scene is in radii a second.
#: ``rubber.toml`` of the sample files holds another rubber.
RUBBER_CYLINDER = Cylinder(
    R=0.1,
    m=35.5,
    mu=0.3,
    material=Material(
        3e6, 0.5, Prony([0.3, 0.6, 1.5], [2e-2, 1e-3, 1e-5]), name="rubber", density=1130.0
    ),
)
#: Its dimensionless scene: kappa = 10.62, mu = 0.3, gamma = 98.1, j = 0.5.
RUBBER_ROLLER = RUBBER_CYLINDER.scene()
#: Scenes by the names of the command line.
PRESETS = {
    "paper-section-5": PAPER_SECTION_5,
    "paper-section-5-rounded": PAPER_SECTION_5_ROUNDED,
    "paper-figures-2-3": PAPER_FIGURES_2_3,
    "rubber-roller": RUBBER_ROLLER,
}
#: Initial conditions (V, omega) of Sect. 5.1.
PAPER_STARTS = {"IC1": (1.5, 0.5), "IC2": (-1.5, 0.5), "IC3": (-1.5, -2.0)}

# --- TOML files of rollers ---


@dataclass
class SceneSection:
    """[scene]: the parameters of :class:`Scene`; with a preset all are optional.

    alpha : T_epsilon/T_sigma, retardation time divided by relaxation time, in [1, 1e12]; 1 is
        elastic.  The unit of time is T_epsilon.
    kappa : R/l0 = sqrt(E' R/(32 P)), radius divided by contact length at rest, > 0.  The theory of
        half-spaces requires a kappa much larger than 1.
    gamma : P T_ref^2/(m R), > 0; the larger gamma, the faster speeds change.  Motions need it;
        contact, stress and steady rolling do not.
    j : moment of inertia divided by m R^2, > 0; default: 1/2, that of a solid cylinder.
    coupled : has no effect in a scene file, since a scene there has two bodies of one material.
    prony : Prony series in place of alpha: moduli divided by the long-time modulus, and relaxation
        times.
    creep : creep series in place of alpha: compliances divided by the long-time compliance,
        retardation times, and optionally alpha.
    """

    alpha: float | None = None
    kappa: float | None = None
    mu: float | None = None
    gamma: float | None = None
    j: float | None = None
    coupled: bool | None = None
    prony: PronySection | None = None
    creep: CreepSection | None = None


@dataclass(kw_only=True)
class CylinderSection:
    """[cylinder]: the parameters of :class:`Cylinder` without its materials.

    R : radius, m, > 0.
    m : mass per metre of length, kg/m, > 0.
    mu : coefficient of friction, > 0.
    E : long-time Young's modulus of both bodies, Pa, > 0.  E, nu, T_epsilon and T_sigma take the
        place of a section [material].
    nu : Poisson's ratio of both bodies, in (-1, 0.5].
    T_epsilon : retardation time of both bodies, s, at least T_sigma.
    T_sigma : relaxation time of both bodies, s, > 0.
    j : moment of inertia divided by m R^2, > 0; default: 1/2, that of a solid cylinder.
    g : gravitational acceleration, m/s^2, > 0, for the weight; default: 9.81.
    plane : "strain" for a long roller, "stress" for a thin disc, of which E' = pi E.
    coupled : for a cover, and for half-spaces with Dundurs' constant above 0.05: true (default)
        computes pressure and shear together, by a table that is made at first use; false takes the
        fast law, in which the effect of the shear on the pressure is approximate.
    """

    R: float
    m: float
    E: float | None = None
    nu: float | None = None
    T_epsilon: float | None = None
    T_sigma: float | None = None
    mu: float
    j: float | None = None
    g: float | None = None
    plane: Plane = "strain"
    load: float | None = None
    coupled: bool | None = None


#: Section of a roller -> its class.
SCHEMA: dict[str, type] = {"scene": SceneSection, "cylinder": CylinderSection}
#: Keys and sections one of which a scene file needs.
SCENES = ("preset", *SCHEMA)


def preset(name: str) -> Scene:
    """Return the scene of a preset, one of :data:`PRESETS`, with an error of the package
    for other names.

    name: name of the preset, as "paper-section-5".
    Raises ParameterError, which lists all names, for any other value.
    """
    if not isinstance(name, str) or name not in PRESETS:
        raise unknown_name_error("preset", name, PRESETS, "a preset")
    return PRESETS[name]


def read_roller(path: FilePath, more: tuple[str, ...] = ()) -> Scene | Cylinder:
    """Read the roller of a TOML file.

    Parameters
    ----------
    path : path of the file.  Its ``preset`` names a scene of this module; its [scene] gives
        alpha (or prony, or creep), kappa, mu (gamma, j), or changes those of the preset; its
        [cylinder] gives R, m, E, nu, T_epsilon, T_sigma, mu (j, g, plane, load) in SI units.  E to
        T_sigma may stand in a section [material], and [base] is the half-space if it is another
        material.
    more : names of further sections that the file may have; they are not read.

    Returns
    -------
    Scene or Cylinder
        A Cylinder in SI units if there is a section [cylinder], else a Scene, dimensionless.

    Raises
    ------
    FileError
        A file that cannot be read, is not TOML, has none of preset, [scene] and [cylinder] or a
        cylinder beside one of the others, an unknown or missing key, an unknown preset, a value of
        the wrong type or out of its range, a file of a material that is missing or wrong, bodies
        that do not go together.
    """
    content = read_toml(path)
    check_sections(path, content, dict.fromkeys(more))
    try:
        roller = make_roller(path, content, parse_materials(path, content))
        roller.scene()  # refuses parameters that leave the range of doubles
    except ParameterError as error:
        raise locate_error(path, content, error) from error
    return roller


def check_sections(path: Any, content: dict[str, Any], more: Mapping[str, type | None]) -> None:
    """Refuse a file whose sections do not describe one roller, or have keys or types that are not
    allowed.

    path: path of the file, for the message and the number of the line.
    content: name of a section, or key outside of sections -> its content, as tomllib reads it.
    more: name of a further section that the file may have -> its class; None if
        it is checked elsewhere.
    Returns nothing.
    Raises FileError if none of preset, [scene] and [cylinder] is given, or [cylinder] beside one of
    the others (a preset may stand beside [scene]); if a section of a material stands without
    [cylinder]; for an unknown key or section, and for wrong keys or types in [scene], [cylinder]
    and the sections of ``more``; the sections of materials are checked where they are read.
    """
    check_keys(path, "", content, (*SCENES, *SECTIONS, *more))
    if not content.keys() & set(SCENES):
        found = f"only {', '.join(content)}" if content else "no sections"
        problem = f"describes no roller, as it has {found}: add preset, [scene] or [cylinder]"
        raise section_error(path, "", "", problem)
    words = {"preset": "preset", "scene": "[scene]"}
    beside = " and ".join(words[name] for name in words if name in content)
    if "cylinder" in content and beside:
        problem = f"[cylinder] is given beside {beside}: remove [cylinder], or {beside}"
        raise section_error(path, "", "cylinder", problem)
    for name in (*SECTIONS, "heat"):
        if name in content and "cylinder" not in content:
            problem = f"[{name}] is given beside {beside}: remove [{name}], or write [cylinder] "
            raise section_error(path, "", name, f"{problem}in place of {beside}")
    for name, kind in {**SCHEMA, **more}.items():
        if name in content and kind is not None:
            as_struct(path, name, content[name], kind)


def make_roller(
    path: Any, content: Mapping[str, Any], materials: Mapping[str, Any]
) -> Scene | Cylinder:
    """Return the roller of checked sections, whose numbers may be arrays (n,).

    path: path of the file, for messages.
    content: name of a section -> its keys and values, of which "cylinder", else "scene" and
        ``preset``, the name of a scene, are read.
    materials: "material" and "base" -> :class:`Material`, as far as the file has these sections;
        ignored without [cylinder].
    Raises ParameterError for a value out of range or missing, shapes that do not broadcast, or an
    unknown preset; FileError for a wrong series; TypeError for an unknown key, ValueError for
    arrays of different n in one list.
    Returns a :class:`Cylinder` if there is a section [cylinder]; else a :class:`Scene`: that of the
    preset, in which the values of [scene] replace its own, or without a preset that of [scene].
    """
    if "cylinder" in content:
        return Cylinder(**content["cylinder"], **materials)
    given = dict(content.get("scene", {}))
    if (series := parse_series(path, "scene", given)) is not None:
        given["material"] = series
        # by the name of the key in the file, which the error states
        form = "creep" if "creep" in given else "prony"
        check_one_given(alpha=given.get("alpha"), **{form: given.pop(form)})
    if "preset" in content:
        return preset(content["preset"]).replace(**given)
    # they are optional in the section, since a preset has them
    if missing := [
        name for name in ("alpha",) * (series is None) + ("kappa", "mu") if name not in given
    ]:
        raise ParameterError(missing[0], None, "given", f"needs {' and '.join(missing)}")
    return Scene(**given)


def locate_error(path: Any, content: dict[str, Any], error: ParameterError) -> FileError:
    """Return the error of a parameter as a FileError with the section and the number of the line
    that gives it.

    path: path of the file, which is read again for the line.
    content: name of a section -> its keys and values.
    error: the error, whose ``name`` is that of the parameter.  The first section that gives it is
        named; if none does, the first of [scene] and [cylinder] in the file; of a key outside of
        sections, as preset, none.
    Returns the error, which is not raised.  Its message has no line if the file cannot be read
    again.
    """
    # of two parameters the first one
    key = error.name.partition(",")[0]
    # [scene] and [cylinder] first, as [material] may give a key of the same name
    sections = (
        name
        for name, given in (SCHEMA | content).items()
        if isinstance(given, dict) and key in given
    )
    default = next((name for name in SCHEMA if name in content), "")
    # the section "" is the top level, where preset stands
    return section_error(path, "" if key in content else next(sections, default), key, str(error))


def read_sections(path: FilePath) -> dict[str, Any]:
    """Return name of a section -> content of a file of bodies, unchecked, or of the name of a
    preset.

    path: TOML file, netCDF file or name of a preset.
    Returns the sections of TOML; {} of netCDF; {"preset": NAME} of the name of a preset.
    Raises FileError for a file that cannot be read or is no TOML.
    """
    if str(path) in PRESETS:
        return {"preset": str(path)}
    return {} if pathlib.Path(path).suffix.lower() == SUFFIX else read_toml(path)


def read_law_source(path: FilePath) -> Any:
    """Read the bodies of a file, for which a law can be tabulated by
    :func:`viscoroll.tables.law`.

    Parameters
    ----------
    path : path of a file, or the name of a preset.  The file is TOML with [material] and optionally
        [base], or with [cylinder], [scene] or a preset; or it is the netCDF file of a material.

    Returns
    -------
    Cylinder, Pair, Prony, Bodies or float
        For [cylinder] the Cylinder; for [scene] its material, or its alpha, a float, if it has no
        material; for [material] the Pair of it and [base].

    Raises
    ------
    FileError
        As :func:`read_roller` for a preset, [scene] or [cylinder], as :func:`read_materials` for
        other files; a file with none of these sections; a [base] that does not fit the material.
    """
    if read_sections(path).keys() & set(SCENES):
        roller = PRESETS.get(str(path)) or read_roller(path)
        if isinstance(roller, Cylinder):
            return roller
        return roller.alpha if roller.material is None else roller.material
    materials = read_materials(path)
    if "material" not in materials:
        raise FileError(path, "section [material], [scene] or [cylinder], or a preset, is missing")
    with as_section_error(path, "base"):
        return Pair(materials["material"], materials.get("base"))
