"""Units that inputs carry: every argument of every public function and class, found by its
signature.
"""

import dataclasses
import datetime
import enum
import inspect
import itertools
import math
import re
from collections import namedtuple
from collections.abc import Mapping
from decimal import Decimal
from fractions import Fraction
from functools import cache, partial

import numpy as np
import pandas as pd
import pint
import pytest
import tolerances
import xarray as xr
from closeness import close
from refusals import refused

import viscoroll as vr

pytestmark = pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")
Quantity = pint.get_application_registry().Quantity
SCENE = vr.Scene(11.0, 10.0, 0.3, 1.0)
CYLINDER = vr.Cylinder(R=1.0, m=40.0, E=2e6, nu=0.5, T_epsilon=0.5, T_sigma=0.05, mu=0.3)
RUBBER = vr.Material(2e6, 0.5, vr.Prony([2.0], [0.5]), 0.25)
OMEGA = np.geomspace(1e-2, 1e2, 12)
#: whole milliseconds, which a duration of pandas holds exactly
TIMES = np.round(OMEGA, 3)
CURVE = 1e6 * (1.0 + OMEGA**2 / (1.0 + OMEGA**2)), 1e6 * OMEGA / (1.0 + OMEGA**2)
#: value -> arguments that have it
VALUED = {
    0.5: "V V0 omega omega0 rested j share R T_epsilon T_ref low M F Q sigma level",
    0.25: "t thickness mu nu nu_instant",
    0.125: "x T_sigma t0",
    1e-3: "delta rest",
    1.0: "speed gamma",
    0.01: "force torque slope brake drag misfit",
    1e-6: "rtol",
    1e3: "density",
    30.0: "temperature reference",
    11.0: "alpha",
    10.0: "kappa g",
    40.0: "m",
    2e6: "E",
    400.0: "load pressed",
    4e6: "E0 G0",
    1e6: "G_inf",
    1e9: "bulk",
    1e5: "energy",
    20.0: "T0",
    17.0: "C1",
    50.0: "C2",
    4.0: "high",
}
#: a value of each argument, which goes with those of the others of its function
SAMPLES = {name: value for value, names in VALUED.items() for name in names.split()} | {
    "roller": SCENE,
    "cylinder": CYLINDER,
    "prony": RUBBER.prony,
    "shift": vr.WLF(T0=20.0),
    "what": CYLINDER,
    "quantiles": (0.25, 0.75),
}
#: moduli and times of the series of other programs
OF_PROGRAMS = {name: [0.5] for name in ("g", "k", "tau", "alpha")}
OF_PROGRAMS |= {"beta": [2.0], "G": [1e6], "K": [1e6]}
#: the same where a name means something else
OWN = {
    "Prony": {"E": [2.0], "tau": [0.5]},
    "Prony.creep": {"J": [0.5], "T": [0.5], "alpha": 2.0},
    "Prony.times": {"factor": 2.0},
    "Bodies": {"cylinder": RUBBER.prony, "base": RUBBER.prony, "poisson": (0.5, 0.3)},
    "Material.abaqus": OF_PROGRAMS,
    "Material.ansys": OF_PROGRAMS,
    "Material.comsol": OF_PROGRAMS,
    "Material.lsdyna": OF_PROGRAMS,
    "Cover": {"series": RUBBER.prony, "part": 0.75, "other_nu": 0.25, "other_thickness": 0.5},
    "Measured": {"M_error": ((1.0, 0.1),), "strain": 0.01},
    "fit_relaxation": {"t": TIMES, "relaxation": 1e6 * (1.0 + np.exp(-TIMES))},
    "fit_prony": {
        "omega": OMEGA,
        "storage": CURVE[0],
        "loss": CURVE[1],
        "temperature": np.full(12, 30.0),
    },
    "Coastdown": {"t": [0.0, 0.25], "V": [0.5, 0.4], "x": [0.0, 0.1], "omega": [0.5, 0.4]},
    "Motion.at": {"t": 0.125},
    "Motion.validity": {"capacity": 9e3},
}
#: words of annotations of what may be a number with a unit, and of what is none
NUMBERS = "float|ArrayLike|Numbers|Acting|Course|Any"
NO_NUMBERS = r"Mapping|Path|Callable\[\[|Iterable\[str\]|Reasons|Labels|LawTable"
#: left out: values that have a unit where they are used alone (tests of drives), files, mappings by
#: name, results; a tuple of temperatures (tests/test_dma.py); heat (tests/test_heat.py);
#: ``resolve`` goes with a function of time alone (tests/motion/test_fitted.py)
LEFT_OUT = """ShiftFactors Schedule Feedback read_dma load_law identify Values Steady Motion
Ensemble Validity Fit Law DynamicModuli RelaxationFit RelaxationModulus
read_relaxation fit_at_strain Temperatures temperature warming heat_limit
turning_points pair_temperatures conductance uniform_temperature"""
#: what has methods that take numbers
MADE = {
    "Material": lambda: dataclasses.replace(RUBBER, shift=vr.WLF(T0=20.0)),
    "WLF": lambda: vr.WLF(T0=20.0),
    "Arrhenius": lambda: vr.Arrhenius(energy=1e5, T0=20.0),
    "Law": CYLINDER.law,
    "Motion": lambda: CYLINDER.roll(0.5, 0.5, 0.25),
    "Ensemble": lambda: CYLINDER.ensemble([0.5, 0.4], 0.5, 0.25),
}
#: unit -> one that pint takes for it
TAKEN = {"1": "deg", "rad": "percent", "rad s-1": "1/min"}
#: how a unit is refused
REFUSED = "must be in .+, or in another unit|must be a number without dimension"


class Argument(namedtuple("Argument", "call function name value others")):
    """An argument that may carry a unit: of what, and the others of a call that is right."""

    def __call__(self, value):
        return self.function(**{**self.others, self.name: value})

    @property
    def unit(self):
        """The unit that a refusal of another asks for; "" where none is refused, or the call does
        not work.
        """
        try:
            self(self.value)
        except vr.ParameterError:
            return ""
        try:
            self(Quantity(np.asarray(self.value), "candela"))
        except vr.ParameterError as error:
            text = str(error)
            assert re.search(REFUSED, text), text
            assert "\n" not in text
            return (
                error.allowed.split(",")[0]
                .removeprefix("in ")
                .replace("a number without dimension", "1")
            )
        return ""


def parameters(function):
    given = inspect.signature(function).parameters
    return {
        name: one
        for name, one in given.items()
        if one.kind not in (one.VAR_KEYWORD, one.VAR_POSITIONAL)
    }


def may_be_numbers(name, parameter):
    """Whether its annotation allows for a number that has a unit."""
    said = str(parameter.annotation)
    others = "self", "fields", "material", "path", "resolve"
    return re.search(NUMBERS, said) and not re.search(NO_NUMBERS, said) and name not in others


def public():
    """Functions and classes of the package, and methods, that take numbers: a name, and how to have
    it.
    """
    for name in vr.__all__:
        value = getattr(vr, name)
        if not callable(value) or (
            inspect.isclass(value) and issubclass(value, Exception | enum.Enum)
        ):
            continue
        if name not in LEFT_OUT.split() and "roller" in parameters(value):
            yield f"{name} of a Scene", lambda value=value: partial(value, SCENE)
            yield f"{name} of a Cylinder", lambda value=value: partial(value, CYLINDER)
        elif name not in LEFT_OUT.split():
            yield name, lambda value=value: value
        for method, found in inspect.getmembers(value, inspect.isroutine):
            if (
                (method.startswith("_") and method != "__call__")
                or not (inspect.isfunction(found) or inspect.ismethod(found))
                or found in vars(vr).values()  # a function of the package
                or not any(may_be_numbers(*each) for each in parameters(found).items())
            ):
                continue
            if inspect.ismethod(found):
                yield f"{name}.{method}", lambda found=found: found
            elif name in MADE:
                yield (
                    f"{name}.{method}",
                    lambda name=name, method=method: getattr(MADE[name](), method),
                )


def sample(call, name):
    """The value of an argument; KeyError: give it in SAMPLES or OWN."""
    return (SAMPLES | OWN.get(call.partition(" of ")[0], {}))[name]


@cache
def arguments_of(call):
    """The arguments of a call of CALLS that may carry a unit, each with others with which the call
    works and looks at it; StopIteration where there are none.
    """
    function = CALLS[call]()
    given = parameters(function)
    needed = {name: sample(call, name) for name, one in given.items() if one.default is one.empty}
    may = {name: sample(call, name) for name, one in given.items() if may_be_numbers(name, one)}
    may = {name: value for name, value in may.items() if not isinstance(value, vr.Prony)}
    found = []
    for name, value in may.items():
        if call.endswith("a Scene") and name == "density":
            continue  # of a Cylinder alone
        more = [other for other in may if other not in needed and other != name]
        sizes = (0, 1, 2, len(more), max(len(more) - 1, 0))
        some = (others for size in sizes for others in itertools.combinations(more, size))
        tried = (
            Argument(call, function, name, value, needed | {other: may[other] for other in others})
            for others in some
        )
        found.append(next(one for one in tried if one.unit))
    return found


def numbers_of(result):
    """All numbers that a result holds."""
    if hasattr(result, "to_xarray"):
        result = result.to_xarray()
    elif isinstance(result, vr.Prony):
        result = result.E, result.tau
    elif dataclasses.is_dataclass(result):
        # labels hold the arguments
        result = {name: value for name, value in vars(result).items() if name != "labels"}
    if isinstance(result, xr.Dataset):
        return [one.values for one in result.variables.values() if one.dtype.kind in "if"]
    if isinstance(result, Mapping):
        return numbers_of([*result.values()])
    if isinstance(result, tuple | list):
        return [*itertools.chain.from_iterable(map(numbers_of, result))]
    is_number = isinstance(result, int | float | np.ndarray | np.number | xr.DataArray)
    return [np.asarray(result)] if is_number else []


def others_of(unit, value):
    """The same quantity otherwise: by pint in the unit and in another, by xarray, as a duration."""
    value = np.asarray(value) if np.ndim(value) else value
    spelled = Quantity(1.0, unit.replace("-", "**-").replace("s2", "s**2")).units
    yield Quantity(value, spelled)
    other = {
        "1": "percent",
        "kg m-1": "g/mm",
        "degC": "K",
        "kg m-3": "g/cm**3",
        "m s-1": "km/h",
        "rad s-1": "rpm",
        "s-1": "1/minute",
    }
    yield Quantity(value, spelled).to(other.get(unit, f"milli{spelled}"))
    if not np.ndim(value):
        yield xr.DataArray(value, attrs={"units": unit})
    if unit == "s":
        yield pd.to_timedelta(value, unit)


CALLS = dict(public())


@pytest.mark.parametrize("call", CALLS)
def test_every_argument_is_converted_or_refused(call):
    for argument in arguments_of(call):
        unit = argument.unit
        exact = numbers_of(argument(argument.value))
        assert exact, call
        for other in others_of(unit, argument.value):
            for one, right in zip(numbers_of(argument(other)), exact, strict=True):
                if right.size:
                    scale = np.abs(right).max()
                    what = argument, other
                    close(one, right, tolerances.UNIT_CONVERTED, scale=scale, what=what)
        wrong = [
            xr.DataArray(argument.value, attrs={"units": other})
            for other in (TAKEN.get(unit, "mol"), *["1"] * (unit not in ("1", "rad")))
        ]
        wrong += [pd.Timedelta(1, "s"), np.timedelta64(1, "s")] * (unit != "s")
        for other in (*wrong, [Quantity(1.0, "mol")]):
            refused(partial(argument, other))


class Like:
    """What has a value of a float, and is no number."""

    def __float__(self):
        return 0.5


#: what is no number
ODD = [
    "ten",
    "1.0",
    b"1",
    {"a": 1.0},
    0.5 + 0j,
    math.nan,
    -math.inf,
    np.ma.array([1.0, 2.0], mask=[0, 1]),
    np.ma.masked,
    datetime.datetime(2020, 1, 1),
    np.datetime64("2020-01-01"),
    10**400,
    np.longdouble("-1e400"),
    pd.NA,
    pd.NaT,
    np.timedelta64("NaT"),
    np.timedelta64(1, "M"),
    [[1.0], [1.0, 2.0]],
    [True, 1.0],
    [None, 1.0],
    Like(),
    np.zeros(2, [("a", float)]),
    np,
    xr.Dataset({"a": 1.0}),
    pd.date_range("2020-01-01", periods=2),
    Decimal("NaN"),
    pd.Series(["a"]),
    {1.0},
    [Quantity(1.0, ""), 2.0],
]
#: what is one
GOOD = [
    Decimal,
    Fraction,
    lambda value: np.array(value, object),
    np.array,
    np.longdouble,
    np.float32,
    lambda value: np.array(value, ">f8"),
    xr.DataArray,
]


@pytest.mark.parametrize("call", CALLS)
def test_odd_values_are_right_or_refused(call):
    """A quarter of the odd values for each argument, and half of the others, by turns: all take the
    same way.
    """
    for n, argument in enumerate(arguments_of(call)):
        for odd in ODD[n % 4 :: 4]:
            refused(partial(argument, odd))
        if np.ndim(argument.value):
            continue
        plain = cache(argument)
        for made in GOOD[n % 2 :: 2]:
            value = made(argument.value)
            found, exact = map(numbers_of, (argument(value), plain(float(value))))
            for one, other in zip(found, exact, strict=True):
                assert np.array_equal(np.squeeze(one), np.squeeze(other), equal_nan=True), (
                    argument,
                    value,
                )


of_cylinder = partial(CYLINDER.roll, 0.5, 0.5, 1.0)
of_scene = partial(SCENE.roll, 0.5, 0.5, 1.0)


@pytest.mark.parametrize(
    "name, unit",
    [("force", "N/m"), ("torque", "N*m/m"), ("brake", "N*m/m"), ("omega", "rad/s"), ("V", "m/s")],
)
def test_schedules_carry_units(name, unit):
    def rolled(times, values):
        return of_cylinder(**{name: vr.Schedule(times, values)})

    values = np.array([0.5, 0.25])
    exact = rolled([0.0, 0.5], values)
    milli = Quantity(values, unit).to(f"milli{unit}")
    durations = pd.to_timedelta([0.0, 0.5], "s")
    for times in (Quantity(np.array([0.0, 500.0]), "ms"), durations, [0.0, 0.5]):
        found = rolled(times, milli)
        assert close([found.V, found.omega], [exact.V, exact.omega], tolerances.UNIT_CONVERTED)
    long = partial(rolled, Quantity(np.array([0.0, 0.5]), "m"), values)
    refused(long, f"times of {name} is in meter", "in s")
    heavy = partial(rolled, [0.0, 0.5], Quantity(values, "kg"))
    refused(heavy, f"values of {name} is in kilogram")
    schedule = {name: vr.Schedule(durations, values)}
    refused(partial(of_scene, **schedule), f"times of {name} is in s: must be a number without")


@pytest.mark.parametrize(
    "name, units", [("force", ("N/m", "N*s/m**2", "N*s/m")), ("torque", ("N", "N*s/m", "N*s"))]
)
def test_feedbacks_carry_units(name, units):
    values = 2.0, -0.25, -0.125
    exact = {name: vr.Feedback(*values)}
    milli = (Quantity(1e3 * value, f"milli{unit}") for value, unit in zip(values, units))
    found = {name: vr.Feedback(*milli)}
    assert close(of_cylinder(**found).V, of_cylinder(**exact).V, tolerances.UNIT_CONVERTED)
    wrong = {name: vr.Feedback(2.0, V=Quantity(1.0, "kg"))}
    refused(partial(of_cylinder, **wrong), f"V of {name} is in kilogram")
    for call in (of_scene, SCENE.steady):
        refused(partial(call, **found), f"value of {name} is in", "without dimension")


def test_functions_of_time_give_quantities():
    exact = of_cylinder(force=lambda t: 2.0 * t)
    found = of_cylinder(force=lambda t: Quantity(2e3 * t, "mN/m"))
    assert close(found.V, exact.V, tolerances.UNIT_CONVERTED)
    with_unit = partial(of_scene, force=lambda t: Quantity(t, "N/m"))
    refused(with_unit, "force(t) is in newton / meter")


def test_columns_of_results_go_back():
    """Tables of pandas have units in their titles alone."""
    data = CYLINDER.roll(0.5, 0.5, [0.1, 0.2]).to_pandas().reset_index()
    V = data["V [m s-1]"]
    exact = CYLINDER.contact(V.to_numpy(), delta=0.0).M
    for column in (V, pd.Index(V), (3.6 * V).rename("V [km/h]"), V.rename("run [1]")):
        assert close(CYLINDER.contact(column, delta=0.0).M, exact, tolerances.UNIT_CONVERTED)
    assert np.array_equal(CYLINDER.roll(0.5, 0.5, data["t [s]"]).V, V)
    refused(lambda: SCENE.contact(V, delta=0.0), "V is in m s-1", "without dimension")


class Length:
    """A quantity that knows no more than how it becomes another."""

    magnitude = 25.0

    def to(self, unit):
        if unit != "m":
            raise ValueError("a length")
        made = Length()
        made.magnitude = 0.25
        return made


class WithUnit(np.ndarray):
    """An array like those of astropy and unyt."""

    unit = "cm"


def test_quantities_of_other_libraries():
    assert CYLINDER.replace(R=Length()).R == 0.25
    refused(lambda: CYLINDER.replace(m=Length()), "m cannot be converted (a length)", "in kg m-1")
    lengths = np.array([10.0, 20.0]).view(WithUnit)
    assert close(CYLINDER.replace(R=lengths).R, [0.1, 0.2], tolerances.UNIT_CONVERTED)
    refused(lambda: CYLINDER.replace(m=lengths), "m is in cm", "in kg m-1")
