"""FMUs as a tool drives them: the rules of the standard, forces and motions of the package,
refusals in words.
"""

import ctypes
import dataclasses
import shutil
import sys
from functools import cache, partial

import numpy as np
import pytest
import tolerances as tol
from c_code import needs_cc
from calls import STEEL
from closeness import close
from long_cases import long

import viscoroll as vr
from viscoroll import fmu
from viscoroll.cli import main
from viscoroll.core.errors import MissingDependencyError

pytestmark = needs_cc
fmpy = pytest.importorskip("fmpy", reason="not installed (make interop): fmpy")
validation = pytest.importorskip("fmpy.validation")

RUBBER = vr.Material(3e6, 0.5, vr.Prony([0.4, 0.6, 1.5], [1.0, 1e-2, 1e-4]), T_ref=0.2)
#: like bodies, and a rubber on steel, of which the cylinder alone loses work
CYLINDERS = {
    "alike": vr.Cylinder(R=0.1, m=35.5, material=RUBBER, mu=0.3),
    "unlike": vr.Cylinder(
        R=0.05, m=9.0, material=RUBBER, base=STEEL, mu=0.6, load=2000.0, coupled=False
    ),
}
#: the version of the standard that the FMUs of each have
VERSIONS = {"alike": 2, "unlike": 3}
both = pytest.mark.parametrize("name", ["alike", *long("unlike")])
TOML = "src/viscoroll/datasets/rubber.toml"
OUTPUTS = "force torque moment_half_space moment_cylinder"


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    """A function from (cylinder, model) to its FMU, made once, with which the checker of FMPy finds
    nothing wrong.
    """
    folder = tmp_path_factory.mktemp("fmu")

    @cache
    def path(name, model="Roller"):
        made = str(folder / f"{name}-{model}.fmu")
        with pytest.MonkeyPatch.context() as patch:  # the optimizer takes most of the time
            patch.setattr(fmu, "_FLAGS", {*fmu._FLAGS} - {"-O2"})
            fmu.build(CYLINDERS[name], made, model, VERSIONS[name])
        assert validation.validate_fmu(made) == []
        return made

    return path


class Instance:
    """An instance of an FMU, in model exchange or co-simulation, which is freed at the end of
    ``with``; names in place of references, several in one text.
    """

    def __init__(self, path, kind="ModelExchange", ready=True, **given):
        self.about = fmpy.read_model_description(path)
        self.said = []
        self.references = {v.name: v.valueReference for v in self.about.modelVariables}
        self.folder = fmpy.extract(path)
        self.fmu = fmpy.instantiate_fmu(
            self.folder, self.about, kind, logger=lambda *said: self.said.append(str(said))
        )
        self.two = self.about.fmiVersion == "2.0"
        self.set(**given)
        if ready:
            self.begin()
            self.fmu.exitInitializationMode()

    def __enter__(self):
        return self

    def __exit__(self, *error):
        self.fmu.freeInstance()
        shutil.rmtree(self.folder)

    def begin(self, stop=None):
        """Enter initialization; an end of the experiment is announced where one is given."""
        if self.two:
            self.fmu.setupExperiment(stopTime=stop)
            return self.fmu.enterInitializationMode()
        return self.fmu.enterInitializationMode(stopTime=stop)

    def at(self, names):
        return [self.references[name] for name in names]

    def set(self, **given):
        put = self.fmu.setReal if self.two else self.fmu.setFloat64
        put(self.at(given), list(given.values()))

    def get(self, names):
        get = self.fmu.getReal if self.two else self.fmu.getFloat64
        return np.array(get(self.at(names.split())))

    def step(self, t, h):
        """From t by h, in co-simulation."""
        self.fmu.doStep(t, h)

    def in_c(self, name):
        """A function of the standard, of this instance."""
        function = getattr(self.fmu.dll, f"fmi{2 if self.two else 3}{name}")
        return partial(function, ctypes.c_void_p(self.fmu.component))

    def refuses(self, words, call, *given, **named):
        """A call of the FMU fails, and the last message has these words."""
        with pytest.raises(fmpy.fmi1.FMICallException):
            call(*given, **named)
        assert words in self.said[-1].replace("-nan", "nan")

    def slopes(self, unknowns, knowns):
        """A row for each unknown."""
        rows = self.at(unknowns.split())
        columns = [self.fmu.getDirectionalDerivative(rows, self.at([one]), [1.0]) for one in knowns]
        return np.array(columns).T


@both
def test_element_has_forces_of_the_law(built, name):
    """Its slopes are those of its forces, below, and of the law: evidence/test_interop.py."""
    cylinder = CYLINDERS[name]
    R = cylinder.R
    random = np.random.default_rng(3)
    v = random.choice([-1.0, 1.0], 100) * 10.0 ** random.uniform(-4.0, 2.0, 100)
    star = cylinder.contact(v, delta=0.0).delta_star
    omega = v / R * (1.0 + star * random.uniform(-1.3, 1.3, 100))
    Q, _, *moments = cylinder.law()(v, omega)
    exact = np.array([Q - moments[0] / R, -R * Q - moments[1], *moments]).T
    scale = cylinder.load * np.array([1.0, R, R, R])
    with Instance(built(name, "ContactElement")) as element:
        for n in range(100):
            element.set(v=v[n], omega=omega[n], load=cylinder.load)
            # omega and v of the law are rounded, which a creep of little counts
            assert close(element.get(OUTPUTS), exact[n], tol.FMU_FORCES, scale=scale)


def assert_slopes(slopes, values, at, steps):
    """Columns of slopes are difference quotients of the values, a function of all that is given."""
    for column, (name, value), h in zip(slopes.T, at.items(), steps):
        ends = {k: values(at | {name: value + k * h}) for k in (-2, -1, 1, 2)}
        quotient = (8.0 * (ends[1] - ends[-1]) - (ends[2] - ends[-2])) / (12.0 * h)
        assert close(column, quotient, tol.FMU_QUOTIENTS, scale=abs(quotient).max())


@pytest.mark.parametrize("v", [-2.0, 4e-7, 0.0])
def test_slopes_of_the_element_are_those_of_its_forces(built, v):
    """By v, omega and load, below v_min too, where the law is that of v_min; adjoint ones alike."""
    speed = max(abs(v), 1e-6)
    at = {"v": v, "omega": (v - 1e-3 * speed) / CYLINDERS["unlike"].R, "load": 2000.0}
    with Instance(built("unlike", "ContactElement"), **at) as element:

        def forces(given):
            element.set(**given)
            return element.get(OUTPUTS)

        slopes = element.slopes(OUTPUTS, at)
        for row, seed in zip(slopes, np.eye(4)):
            given = element.at(OUTPUTS.split()), element.at(at), seed.tolist()
            adjoint = element.fmu.getAdjointDerivative(*given, len(at))
            assert close(np.array(adjoint), row, tol.FMU_ROUNDED)
        assert_slopes(slopes, forces, at, [1e-5 * speed, 2e-4 * speed, 0.02])


#: thrown, and thrown the other way with a drive: V0, omega0, force on the axis, torque
THROWS = {"alike": (1.0, 0.0, 0.0, 0.0), "unlike": (-0.5, 20.0, 40.0, 10.0)}


def assert_rolls(
    path, cylinder, throw, end=0.5, kind="CoSimulation", rel=tol.FMU_ROLLER, least=0.0, **starts
):
    """An FMU rolls as the cylinder does; errors are divided by the largest value, at least by
    ``least`` m/s or m, and as much at the rim.
    """
    V0, omega0, force, torque = throw
    t = np.linspace(0.0, end, 21)
    exact = cylinder.roll(V0, omega0, t, rtol=1e-11, force=force, torque=torque)
    starts |= {"v0": V0, "omega0": omega0, "drive_force": force, "drive_torque": torque}
    found = fmpy.simulate_fmu(
        path,
        stop_time=end,
        output_interval=t[1],
        fmi_type=kind,
        start_values=starts,
        output=["v", "omega", "x"],
    )
    assert close(found["time"], t, tol.FMU_ROUNDED, scale=1.0)
    for column, name, unit in ("v", "V", 1.0), ("omega", "omega", cylinder.R), ("x", "x", 1.0):
        scale = max(abs(exact[name]).max(), least / unit)
        assert close(found[column], exact[name], rel, scale=scale)


@both
def test_roller_by_co_simulation_is_that_of_roll(built, name):
    assert_rolls(built(name), CYLINDERS[name], THROWS[name])


@pytest.mark.long
def test_a_cover_rolls_by_its_law_on_disk(tmp_path):
    """It starts at a load that is its own; another load would be another law."""
    unlike = CYLINDERS["unlike"]
    cover = vr.Material(3e6, 0.5, vr.Prony([1.5], [1e-2]), 0.2, thickness=5e-3)
    cylinder = unlike.replace(material=cover, base=vr.Material.rigid())
    with pytest.warns(vr.ModelWarning, match="has the law with coupled=False.*the error of Q is"):
        law = vr.tables.law(cylinder.replace(coupled=True))
    vr.tables.save(law, tmp_path / "law.nc")
    path = str(tmp_path / "roller.fmu")
    with pytest.warns(
        vr.ModelWarning, match="has the law with coupled=False.*Dundurs' constant is"
    ):
        fmu.build(unlike.replace(material=dataclasses.replace(RUBBER, nu=0.3), coupled=True), path)
    with pytest.warns(vr.ModelWarning, match="has the fast law.*states the error"):
        fmu.build(vr.load_law(tmp_path / "law.nc"), path)
    own = {"R": unlike.R, "load": unlike.load}
    with Instance(path, "CoSimulation", v0=1.0) as roller:
        assert close(roller.get("load") * roller.get("R"), unlike.load * unlike.R, tol.FMU_ROUNDED)
        for given in ({"load": 2100.0}, {"R": 0.06}):
            roller.set(**own | given)
            roller.refuses("contact length at rest, in m,", roller.step, 0.0, 0.1)
        roller.set(R=unlike.R, load=1000.0, width=0.5)
        roller.step(0.0, 0.1)
    assert_rolls(path, cylinder, THROWS["unlike"], mass=unlike.m, mu=unlike.mu, **own)


#: ways to come to rest, to pass through it and to leave it: the cylinder, and as above
NEAR_REST = {
    "slowly": ("alike", 1e-3, 1e-2, 0.0, 0.0),
    "to rest": ("unlike", 0.02, 0.4, 0.0, 0.0),
    "through rest": ("alike", 0.3, 3.0, -5.0, 0.0),
    "pulled": ("unlike", 0.0, 0.0, 20.0, 0.0),
    "turned": ("alike", 0.0, 0.0, 0.0, 0.5),
    "left alone": ("unlike", 0.0, 0.0, 0.0, 0.0),
}


@pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")  # slow rolling is unsteady
@pytest.mark.parametrize("throw", NEAR_REST)
def test_an_integrator_of_the_tool_passes_through_rest(built, throw):
    """CVode stopped there, with error -4: it saw the law below v_min as it is, with slopes without
    bounds.
    """
    name, *start = NEAR_REST[throw]
    assert_rolls(
        built(name), CYLINDERS[name], start, 20.0, "ModelExchange", tol.FMU_NEAR_REST, least=1.0
    )


# --- states and steps ---


@both
def test_a_state_that_was_taken_is_gone_on_from_with_the_same_bits(built, name):
    """Of another time, with other parameters and inputs; by itself and as bytes, also in another
    instance.
    """
    names = "v slip x omega drive_force mu load"
    path = built(name)
    given = {"v0": 1.0, "omega0": 2.0, "drive_force": 3.0, "mu": 0.2}
    with Instance(path, "CoSimulation", **given) as one, Instance(path, "CoSimulation") as other:
        one.step(0.0, 0.05)
        state = one.fmu.getFMUState()
        then = one.get(names)
        kept = one.fmu.serializeFMUState(state)
        one.step(0.05, 0.1)
        exact = one.get(names)
        one.set(drive_force=-50.0)
        one.step(0.05 + 0.1, 0.1)
        one.fmu.setFMUState(state)
        assert np.array_equal(one.get(names), then)
        one.step(0.05, 0.1)
        assert np.array_equal(one.get(names), exact)
        same = other.fmu.deserializeFMUState(kept)
        other.fmu.setFMUState(same)
        other.step(0.05, 0.1)
        assert np.array_equal(other.get(names), exact)
        for damaged in (kept[:-1], b"x" + kept[1:]):
            other.refuses(
                "a state which this FMU has serialized", other.fmu.deserializeFMUState, damaged
            )
        one.fmu.freeFMUState(state)
        other.fmu.freeFMUState(same)


@both
def test_steps_that_are_none_are_refused_in_words(built, name):
    """Backwards, NaN, infinite, or from another time than the end of the last one; the state stays
    as it was.
    """
    with Instance(built(name), "CoSimulation", v0=1.0) as roller:
        roller.step(0.0, 0.05)
        at = roller.get("v omega x")
        for t, h, said in (
            (0.05, -0.05, "communicationStepSize = -0.05: must be finite and >= 0"),
            (0.05, np.nan, "communicationStepSize = "),
            (0.05, np.inf, "communicationStepSize = inf: must be finite"),
            (5.0, 0.05, "currentCommunicationPoint = 5: must be 0.05, the end of the last step"),
            (np.nan, 0.05, "currentCommunicationPoint = "),
        ):
            roller.refuses(said, roller.step, t, h)
            assert np.array_equal(roller.get("v omega x"), at)
        roller.step(0.05, 0.0)
        assert np.array_equal(roller.get("v omega x"), at)
        roller.set(rtol=1e-300)
        roller.refuses("rtol = 1e-300: must be in [1e-12, 0.01]", roller.step, 0.05, 0.05)
        roller.set(rtol=1e-8)
        roller.step(0.05 + 1e-12, 0.05)  # times of tools are sums


# --- modes ---

#: call -> modes in which version 2 allows it; version 3 allows "get" in every mode
ALLOWED = {
    "begin": "instantiated",
    "exitInitializationMode": "initialization",
    "enterEventMode": "continuous-time",
    "enterContinuousTimeMode": "event",
    "terminate": "event continuous-time step",
    "reset": "instantiated initialization event continuous-time step terminated",
    "get": "initialization event continuous-time step terminated",
    "slopes": "initialization event continuous-time step terminated",
    "drive_force": "instantiated initialization event continuous-time step",
    "mu": "instantiated initialization event step",
    "v0": "instantiated initialization",
}
#: those that FMPy has for one of the interfaces
OF_KINDS = {
    "ModelExchange": {
        "discrete": "event",
        "completedIntegratorStep": "continuous-time",
        "setTime": "event continuous-time",
        "states": "continuous-time",
    },
    "CoSimulation": {"step": "step"},
}
#: mode -> calls that lead to it
WAYS = {
    "instantiated": "",
    "initialization": "begin",
    "event": "begin exitInitializationMode",
    "continuous-time": "begin exitInitializationMode enterContinuousTimeMode",
    "step": "begin exitInitializationMode",
    "terminated": "begin exitInitializationMode terminate",
}


def call_of(one, name):
    """A call of an instance by its name in the tables above."""

    def change():
        if status := one.in_c(name[0].upper() + name[1:])():
            raise fmpy.fmi1.FMICallException(name, status)

    if "Mode" in name:
        return change
    if name in one.references:
        return partial(one.set, **{name: 0.5})
    return {
        "begin": one.begin,
        "discrete": getattr(
            one.fmu, "newDiscreteStates" if one.two else "updateDiscreteStates", None
        ),
        "setTime": lambda: one.fmu.setTime(0.0),
        "states": lambda: one.fmu.setContinuousStates(*_pointer([1.0, 0.0, 0.0])),
        "step": lambda: one.step(0.0, 0.1),
        "get": lambda: one.get("v"),
        "slopes": lambda: one.slopes("der_v", ["v"]),
    }.get(name) or getattr(one.fmu, name)


@both
@pytest.mark.parametrize(
    "kind, mode",
    [("ModelExchange", mode) for mode in WAYS if mode != "step"]
    + [("CoSimulation", mode) for mode in WAYS if mode not in ("event", "continuous-time")],
)
def test_what_a_mode_allows(built, name, kind, mode):
    """Every call in every mode: allowed as the standard says, or an error in words that leaves the
    mode as it was.
    """
    with Instance(built(name), kind, ready=False, v0=1.0) as one:
        for called, modes in (ALLOWED | OF_KINDS[kind]).items():
            one.fmu.reset()
            for way in WAYS[mode].split():
                call_of(one, way)()
            call = call_of(one, called)
            if mode in modes.split() or (called == "get" and not one.two):
                call()
            else:
                one.refuses(f"is refused in the mode {mode}: the mode must be", call)
                if mode != "terminated":
                    call_of(one, "drive_force")()  # goes on


@both
def test_an_announced_end_is_kept(built, name):
    with Instance(built(name), "CoSimulation", ready=False, v0=1.0) as one:
        one.begin(stop=0.3)
        one.fmu.exitInitializationMode()
        one.step(0.0, 0.1)
        one.step(0.1, 0.1 + 1e-12)  # times of tools are sums
        then = one.get("v x")
        past = "end of the step = 0.4: must be at most stopTime = 0.3"
        one.refuses(past, one.step, 0.2, 0.2)
        assert np.array_equal(one.get("v x"), then)
        kept = one.fmu.serializeFMUState(one.fmu.getFMUState())
        one.step(0.2, 0.1)
        one.fmu.reset()
        one.fmu.setFMUState(one.fmu.deserializeFMUState(kept))
        one.refuses(past, one.step, 0.2, 0.2)


@both
def test_a_state_has_its_mode_and_initialization_has_the_speeds_of_the_start(built, name):
    with Instance(built(name), "CoSimulation", ready=False, v0=1.0, omega0=4.0) as one:
        if not one.two:  # version 3 reads in every mode
            assert close(one.get("v omega"), [1.0, 4.0], tol.FMU_ROUNDED)
        one.begin()
        assert close(one.get("v omega"), [1.0, 4.0], tol.FMU_ROUNDED)
        one.fmu.exitInitializationMode()
        state = one.fmu.getFMUState()
        one.fmu.terminate()
        one.fmu.setFMUState(state)
        one.step(0.0, 0.1)
        one.fmu.freeFMUState(state)


def test_slopes_of_the_roller_are_those_of_its_rates(built):
    unknowns = "der_v der_slip der_x v slip x omega"
    at = {"v": 1.0, "slip": -1e-3, "x": 0.0, "drive_force": 3.0, "drive_torque": 0.0}
    with Instance(built("alike")) as roller:
        roller.fmu.enterContinuousTimeMode()

        def rates(given):
            v, slip, x, force, torque = given.values()
            roller.fmu.setContinuousStates(*_pointer([v, slip, x]))
            roller.set(drive_force=force, drive_torque=torque)
            return roller.get(unknowns)

        rates(at)
        assert_slopes(roller.slopes(unknowns, at), rates, at, [1e-5, 1e-5, 1e-5, 1.0, 1.0])


def _pointer(values):
    array = np.ascontiguousarray(values)
    return array.ctypes.data_as(ctypes.POINTER(ctypes.c_double)), array.size


@both
def test_what_is_out_of_range_is_refused_in_words(built, name):
    with Instance(built(name, "ContactElement")) as element:
        element.set(load=-5.0, v=1.0)
        assert not element.get(f"{OUTPUTS} contact_length").any()
        for given, said in (
            ({"R": -1.0}, "R = -1: must be > 0"),
            ({"v": np.nan}, "v = nan: must be finite"),
            ({"v": 1e308, "load": 2e3}, "must be finite; an input or a parameter is too large"),
        ):
            element.set(**given)
            element.refuses(said, element.get, "force")
            element.set(R=0.1, v=1.0)
        element.refuses("that of an input or a parameter", element.set, force=1.0)
        element.get("force")


@both
def test_counts_and_times_that_cannot_be_are_refused(built, name):
    """Counts other than that of the states read and wrote other variables; any time was taken."""
    with Instance(built(name), ready=False, v0=1.0) as one:
        start = one.fmu.setupExperiment if one.two else one.fmu.enterInitializationMode
        for t in (np.nan, np.inf):
            one.refuses("must be finite", start, startTime=t)
        one.begin()
        one.fmu.exitInitializationMode()
        one.fmu.enterContinuousTimeMode()
        at = one.get("v slip x der_v")
        for called in (
            "SetContinuousStates",
            "GetContinuousStates",
            "GetDerivatives" if one.two else "GetContinuousStateDerivatives",
            "GetNominalsOfContinuousStates",
        ):
            for n in (2, 4):
                assert one.in_c(called)(*_pointer(np.ones(n)))
                assert f"number of values = {n}: must be 3" in one.said[-1]
        one.refuses("time = nan: must be finite", one.fmu.setTime, np.nan)
        assert np.array_equal(one.get("v slip x der_v"), at)


@pytest.mark.parametrize(
    "name, model, change, said",
    [
        ("unlike", "Roller", "token", "token: must be {"),
        ("unlike", "ContactElement", "", "use model exchange"),
        ("unlike", "Roller", "events", "eventModeUsed: must be false"),
    ],
)
def test_an_instance_that_is_none_says_why(built, name, model, change, said):
    """Another token, an interface that is not there, events in co-simulation."""
    path = built(name, model)
    about = fmpy.read_model_description(path)
    if change == "token":
        about.guid = "{0}"
    about.coSimulation = about.coSimulation or about.modelExchange
    lines = []
    with pytest.raises(Exception, match="nstantiate"):
        fmpy.instantiate_fmu(
            fmpy.extract(path),
            about,
            "CoSimulation",
            logger=lambda *given: lines.append(str(given)),
            event_mode_used=change == "events",
        )
    assert said in lines[-1]


@pytest.mark.filterwarnings("always::viscoroll.ModelWarning")  # printed by the program
@pytest.mark.long
def test_program(tmp_path, monkeypatch, capsys):
    """The same bytes for the same cylinder, so that they can be kept."""
    monkeypatch.setattr(fmu, "_FLAGS", ("-shared", "-fPIC"))  # nothing is computed
    law = tmp_path / "law.nc"
    roller = tmp_path / "roller.fmu"
    vr.tables.save(vr.tables.law(CYLINDERS["unlike"].pair), law)

    def make(*given):
        assert main(["fmu", *map(str, given), "-o", str(roller)]) == 0

    def starts():
        about = fmpy.read_model_description(str(roller))
        return {v.name: v.start for v in about.modelVariables}

    make(law, "--fmi", 3)
    first = roller.read_bytes()
    make(law, "--fmi", 3)
    assert roller.read_bytes() == first
    assert float(starts()["E_prime"]) == CYLINDERS["unlike"].E_prime
    assert float(starts()["T_ref"]) == RUBBER.T_ref
    capsys.readouterr()
    make("rubber-roller")
    unused = "kappa, mu, gamma and j of the dimensionless scene are not used"
    assert unused in capsys.readouterr().err
    make(TOML, "--model", "ContactElement")
    assert starts()["load"] == "2000.0"


@pytest.mark.parametrize("missing", ["fmpy", "cc"])
def test_what_is_missing_is_told(tmp_path, monkeypatch, missing):
    if missing == "cc":
        monkeypatch.setenv("PATH", str(tmp_path))
    else:
        monkeypatch.setitem(sys.modules, "fmpy", None)
    with pytest.raises(MissingDependencyError, match=f"{missing}.* is not installed"):
        fmu.build(11.0, tmp_path / "a.fmu")
    assert not list(tmp_path.iterdir())
