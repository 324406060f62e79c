"""Heat: equilibria of temperature, warming, limits, conductance, and the strain of a contact."""

import warnings
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
import pytest
import tolerances as tol
import xarray as xr
from closeness import close
from long_cases import long
from refusals import each, refusals, refused
from scipy.integrate import trapezoid

import viscoroll as vr

pytestmark = pytest.mark.filterwarnings(
    "ignore::viscoroll.ModelWarning"
)  # random rollers are beyond the model

WLF = vr.WLF(C1=8.86, C2=101.6, T0=0.0)
RUBBER = vr.Material(
    3e6, 0.49, vr.Prony([2.0, 40.0], [1.0, 1e-2]), 0.02, temperature=20.0, shift=WLF
)
ROLLER = vr.Cylinder(
    R=0.1, m=60.0, material=RUBBER, base=vr.Material.rigid(), mu=0.6, load=2e4, coupled=False
)
COLD = {"ambient": -30.0, "conductance": 6.0}
MILD = {"ambient": 0.0, "conductance": 6.0}
WARM = {"ambient": 20.0, "conductance": 6.0}


def ln_a_T(shift, theta):
    """ln a_T of either law as it is published."""
    if isinstance(shift, vr.WLF):
        return -np.log(10.0) * shift.C1 * (theta - shift.T0) / (shift.C2 + theta - shift.T0)
    return shift.energy / 8.314462618 * (1.0 / (theta + 273.15) - 1.0 / (shift.T0 + 273.15))


def with_shift(shift, **more):
    return ROLLER.replace(material=replace(RUBBER, shift=shift, **more))


def balanced(found, ambient, conductance, share=1.0):
    """Whether what is given off is what is lost, that of slip by half; of a rise of 1 mK at
    least.
    """
    given_off = conductance * (found.temperature - ambient)
    lost = share * (found.loss - 0.5 * found.loss_slip)
    return close(given_off, lost, tol.HEAT_BALANCE, scale=1e-3 * conductance)


def beside(**more):
    """The roller on its own rubber, with other data."""
    return ROLLER.replace(base=replace(RUBBER, **more))


# --- equilibria ---


def test_constant_shift_in_closed_form():
    """The loss does not depend on the temperature: theta = ambient + w/conductance, and warming is
    exponential.
    """
    roller = with_shift(lambda T: 1.0)
    w = 2e4 * 3.0 * roller.contact(3.0, delta=0.0).C_rr
    found = roller.temperature(3.0, ambient=5.0, conductance=10.0)
    assert close(found.temperature, [5.0 + w / 10.0], tol.HEAT_CLOSED)
    t = np.linspace(0.0, 3000.0, 7)
    course = roller.warming(3.0, t, ambient=5.0, conductance=10.0, capacity=9e3)
    assert close(course.temperature, 5.0 + w / 10.0 * -np.expm1(-10.0 * t / 9e3), tol.WARMING)


def test_against_a_dense_scan():
    """None of the equilibria of 50 random rollers at 60,000 temperatures is missed; they balance,
    and alternate.
    """
    rng = np.random.default_rng(5)
    several = 0
    for k in range(50):
        n = rng.integers(1, 5)
        shift = vr.WLF(C1=rng.uniform(6, 18), C2=rng.uniform(40, 120), T0=rng.uniform(-60, 20))
        shift = shift if k % 3 else vr.Arrhenius(energy=rng.uniform(3e4, 2e5), T0=20.0)
        series = vr.Prony(10 ** rng.uniform(-1, 2, n), 10 ** rng.uniform(-4, 1, n))
        rubber = vr.Material(
            10 ** rng.uniform(5.5, 7.5), 0.45, series, 0.1, temperature=20.0, shift=shift
        )
        like = bool(k % 2)
        base = None if like else ROLLER.base
        roller = ROLLER.replace(R=10 ** rng.uniform(-1.7, 0), material=rubber, base=base)
        V = 10 ** rng.uniform(-2, 1.7)
        A = rng.uniform(-35, 30)
        G = 10 ** rng.uniform(-0.5, 2.5)
        found = roller.temperature(V, ambient=A, conductance=G)
        share = 0.5 if like else 1.0
        assert balanced(found, A, G, share)
        assert found.count % 2
        assert found.stable.tolist() == [n % 2 == 0 for n in range(found.count)]
        free = partial(roller.contact, delta=0.0, fields="C_rr")
        power = roller.load * V / G
        theta = np.linspace(
            A, A + 1.1 * power * free(np.geomspace(1e-9, 1e9, 999)).C_rr.max(), 60_000
        )
        a_T = np.exp(ln_a_T(shift, theta) - ln_a_T(shift, 20.0))
        positive = share * power * free(V * a_T).C_rr > theta - A
        assert found.count >= np.count_nonzero(positive[1:] != positive[:-1])
        several += found.count > 1
    assert several > 3


def test_heat_of_slip_and_given_loads():
    """A torque adds its slip to the heat; a force gives the speed too, at which the balance is the
    same.
    """
    driven = ROLLER.temperature(3.0, **WARM, torque=500.0, slip_share=1.0)
    assert driven.loss_slip[0] > 0.0
    assert close(6.0 * (driven.temperature - 20.0), driven.loss, tol.HEAT_BALANCE)
    found = ROLLER.temperature(force=80.0, **COLD)
    assert balanced(found, **COLD)
    assert close(found.C_rr, 80.0 / 2e4, tol.HEAT_BALANCE)
    for V, theta in zip(found.V, found.temperature):
        at_speed = ROLLER.temperature(V, torque=0.0, **COLD).temperature
        assert abs(at_speed - theta).min() < 1e-7


@pytest.mark.parametrize(
    "base", [ROLLER.base, *long(vr.Material.elastic(5e7, 0.3), vr.Material.elastic(3e6, 0.49))]
)
def test_vertical_shift_scales_the_moduli(base):
    """The equilibrium has the loss of the material whose moduli and times are those at its
    temperature, also beside an elastic body, of the rubber's long-time modulus too.
    """
    roller = with_shift(WLF, vertical_shift="entropic").replace(base=base)
    found = roller.temperature(3.0, **MILD)
    hot = roller.replace(material=roller.material.at(float(found.temperature[0])))
    assert close(hot.material.E / 3e6, (found.temperature[0] + 273.15) / 293.15, 1e-15)
    assert close(found.C_rr[0], hot.contact(3.0, delta=0.0).C_rr, 1e-12)
    assert balanced(found, **MILD)


@pytest.mark.long
@pytest.mark.parametrize("given", [{"thickness": 0.03}, {"nu": 0.3}])
def test_coupled_bodies_follow_their_own_law(given):
    """Free rolling of a cover, and of a half-space with a Dundurs' constant above 0.05, is steady
    rolling without torque, whose loss is in balance, by the coupled solution.
    """
    roller = with_shift(WLF, **given).replace(coupled=None)
    found = roller.temperature(2.0, **MILD)
    at = roller.replace(material=roller.material.at(float(found.temperature[0])))
    rolling = at.steady(V=2.0, torque=0.0)
    assert close(found.M, rolling.M, 1e-12)
    assert close(found.loss - found.loss_slip, rolling.loss.cylinder, 1e-12)
    assert balanced(found, **MILD)
    if "nu" in given:  # of a cover each load has a table of its own
        limit = roller.heat_limit(found.temperature[0], V=2.0, **MILD)
        assert close(limit.load, roller.load, tol.HEAT_LIMIT)


def test_two_bodies_with_a_temperature_each():
    """They balance by the law of both."""
    base = vr.Material(
        5e6,
        0.49,
        vr.Prony([9.0], [1.0]),
        1e-4,
        temperature=0.0,
        shift=vr.Arrhenius(energy=9e4, T0=10.0),
    )
    pair = ROLLER.replace(base=base)
    found = pair.pair_temperatures(-2.0, ambient=(0.0, 20.0), conductance=(6.0, 30.0))
    one, other = found.temperature[0].tolist()
    warm = pair.replace(material=RUBBER.at(one), base=base.at(other)).contact(-2.0, delta=0.0)
    assert close(-2.0 * np.array([warm.M_cylinder, warm.M_half_space]) / 0.1, found.loss[0], 1e-12)
    assert close(found.C_rr[0], warm.C_rr, 1e-12)
    assert close(found.loss[0], [6.0 * one, 30.0 * (other - 20.0)], 1e-8)


def test_units_are_converted():
    pint = pytest.importorskip("pint").get_application_registry()
    given = {
        "ambient": pint.Quantity(293.15, "kelvin"),
        "conductance": pint.Quantity(6e-3, "kW/m/K"),
    }
    found = ROLLER.temperature(pint.Quantity(18.0, "km/h"), **given)
    assert close(found.temperature, ROLLER.temperature(5.0, **WARM).temperature, 1e-12)
    pair = partial(beside(temperature=60.0).pair_temperatures, 5.0, conductance=[6.0] * 2)
    kelvin = pint.Quantity([293.15] * 2, "K")
    assert close(pair(ambient=kelvin).loss, pair(ambient=[20.0] * 2).loss, tol.HEAT_UNITS)
    warming = partial(ROLLER.warming, t=[60.0, 120.0], capacity=9e3)
    speeds = vr.Schedule(pint.Quantity([0.0, 1.0], "min"), pint.Quantity([0.0, 18.0], "km/h"))
    course = warming(speeds, **given)
    known = warming(vr.Schedule([0.0, 60.0], [0.0, 5.0]), **WARM)
    assert close(course.temperature, known.temperature, tol.HEAT_UNITS)
    mass = {"ambient": 20.0, "conductance": pint.Quantity(6.0, "kg")}
    refused(lambda: ROLLER.temperature(5.0, **mass), "must be in W")


# --- warming ---


def test_warming_ends_in_a_stable_equilibrium():
    """From 0.1 K beside the unstable one to either side; the energy lost is stored or given off."""
    cold, middle, hot = ROLLER.temperature(1.0, **COLD).temperature
    t = np.linspace(0.0, 1e5, 4001)
    course = ROLLER.warming(1.0, t, **COLD, capacity=9e3, start=[middle - 0.1, middle + 0.1])
    assert close(course.temperature[:, -1], [cold, hot], tol.WARMING)
    # the trapezoidal rule of 4000 steps
    assert close(trapezoid(course.loss, t), course.heat[:, -1], 1e-4)
    stored = 9e3 * (course.temperature - course.temperature[:, :1])
    assert close(course.heat - course.given_off, stored, 1e-6, scale=1e5)


def test_warming_under_a_schedule():
    """A speed that changes at a corner warms as two warmings, one after the other."""
    once = ROLLER.warming(
        vr.Schedule([0.0, 500.0, 500.0], [4.0, 4.0, 1.0]), [500.0, 900.0], **COLD, capacity=9e3
    )
    first = ROLLER.warming(4.0, [500.0], **COLD, capacity=9e3)
    then = ROLLER.warming(lambda t: 1.0, [400.0], **COLD, capacity=9e3, start=first.temperature[0])
    assert close(once.temperature[1], then.temperature[0], tol.WARMING)


def test_warming_keeps_the_labels_of_its_states():
    """Also of as many states as times, along an axis of the name t."""
    days = xr.DataArray([-5.0, 10.0], dims="t", coords={"t": ["Monday", "Friday"]})
    course = ROLLER.warming(2.0, [0.0, 60.0], ambient=days, conductance=6.0, capacity=9e3)
    assert course.temperature.dims == ("given_t", "t")
    data = course.to_xarray().sel(given_t="Friday", t=0.0)
    assert data.temperature == data.ambient == 10.0


# --- limits ---


def test_limits_are_those_of_the_equilibria():
    V = np.array([1.0, 4.0])
    found = ROLLER.heat_limit(70.0, V=V, **WARM)
    for speed, load in zip(V, found.load, strict=True):
        at = ROLLER.replace(load=load).temperature(speed, **WARM).temperature
        assert close(at[0], 70.0, tol.HEAT_BALANCE)
    assert close(ROLLER.heat_limit(70.0, load=found.load, **WARM).V, V, tol.HEAT_BALANCE)
    # moduli < 0 above 520 degrees, where nothing is sought
    linear = with_shift(WLF, vertical_shift=lambda T: 1.04 - 0.002 * T)
    linear = linear.replace(load=linear.heat_limit(70.0, V=4.0, **WARM).load)
    assert close(linear.temperature(4.0, **WARM).temperature[0], 70.0, tol.HEAT_BALANCE)
    cold = ROLLER.heat_limit(50.0, V=1.0, **COLD)
    loads = cold.load * np.array([1.0 - 1e-8, 1.0 + 1e-8])
    less, more = (ROLLER.replace(load=load).temperature(1.0, **COLD) for load in loads)
    assert cold.runaway
    assert (less.count, more.count) == (3, 1)
    # the lower two lie between nodes of the curve
    assert balanced(less, **COLD)
    assert less.stable.tolist() == [True, False, True]


@pytest.mark.long
def test_limit_of_a_cover():
    """The temperature at the load that was found is the allowed one."""
    cover = with_shift(WLF, thickness=0.03).replace(load=3.4e4)
    found = cover.heat_limit(70.0, V=-2.0, **MILD)
    at = cover.replace(load=found.load).temperature(-2.0, **MILD)
    assert close(at.temperature, [70.0], tol.HEAT_LIMIT)
    assert not found.runaway


def test_turning_points():
    """On either side of each the number of equilibria differs by two."""
    roller = with_shift(
        vr.WLF(C1=15.0, C2=60.0, T0=-20.0), prony=vr.Prony([2.0, 60.0, 60.0], [1.0, 1e-3, 1e-7])
    )
    found = 0
    for at in (ROLLER, roller):
        for V, _, runaway in zip(*at.turning_points(**COLD)):
            less, more = (
                at.temperature(V * (1.0 + e), **COLD).count for e in (-tol.TURNING, tol.TURNING)
            )
            assert less - more == (2 if runaway else -2)
            found += 1
    assert found > 1


@pytest.mark.parametrize("h", [1e-3, 0.015, 0.09])
def test_conductance_of_film_and_cover(h):
    """The ring with even sources: its mean temperature from radial conduction; a ring down to the
    axis is the solid cylinder, and without conduction there is the film alone.
    """
    R = 0.1
    k = 0.25
    film = 20.0
    conductance = partial(vr.conductance, R, film=film, conductivity=k)
    a = R - h
    area = R * R - a * a
    slow = a * a / (2.0 * k)
    nodes, weights = np.polynomial.legendre.leggauss(40)
    r = a + 0.5 * h * (1.0 + nodes)
    logs = np.log(r / a)
    # the slope of the logarithm from the heat through the film; a core that takes no heat sets it
    slope = (0.5 * R + film * area / (4.0 * k)) / (film * np.log(R / a) + k / R)
    surface = 0.5 * area / (R * film) - slow * np.log(R / a) + area / (4.0 * k)
    for core, rise in {"cooled": slope * logs, "insulated": surface + slow * logs}.items():
        mean = weights @ ((rise - (r * r - a * a) / (4.0 * k)) * r) * h / area
        assert close(conductance(thickness=h, core=core), np.pi * area / mean, tol.HEAT_RING)
    assert close(conductance(thickness=0.999 * R), conductance(), 1e-5)
    assert close(vr.conductance(R, film=film, thickness=h), 2.0 * np.pi * R * film, 1e-15)
    assert not vr.uniform_temperature(film, 0.015, k).holds


def test_cold_rubber_relaxes_slowly_but_has_fast_waves():
    """V a_T is far above the shear wave speed, V is not: no warning."""
    warnings.simplefilter("error")
    short = vr.Prony([2.0, 40.0], [1.0, 1e-5])
    with_shift(WLF, density=1100.0, prony=short).temperature(0.5, **COLD)


# --- bad input ---


REFUSED = each(
    lambda roller: roller.temperature(1.0, **WARM),
    {
        "given to the viscoelastic Material": vr.presets.RUBBER_CYLINDER,
        "rises with the temperature at": with_shift(lambda T: T + 300.0),
        "with vertical_shift needs temperature=": with_shift(
            WLF, vertical_shift="entropic", temperature=None
        ),
        "load has shape": with_shift(WLF, thickness=0.03).replace(load=[1e4, 2e4]),
        "law would differ at each temperature": with_shift(
            WLF, vertical_shift="entropic", thickness=0.03
        ),
        "is viscoelastic too": [
            beside(temperature=60.0),
            beside(thickness=0.01),
            beside(shift=vr.WLF(T0=-60.0)),
        ],
    },
) + each(
    None,
    {
        "above ambient": lambda: ROLLER.heat_limit(-40.0, V=1.0, **COLD),
        "has no Material": lambda: vr.presets.RUBBER_ROLLER.heat_limit(70.0, load=1.0, **COLD),
        "roller has an elastic or rigid body:": lambda: ROLLER.pair_temperatures(1.0, **COLD),
        "t has 60 s and then 60 s": lambda: ROLLER.warming(1.0, [60.0] * 2, **COLD, capacity=9e3),
        "at most 0.999 R": lambda: vr.conductance(0.1, thickness=0.2),
    },
)
REFUSED += each(
    vr.ShiftFactors,
    {
        "one a_T for each": {"temperature": (0.0, 20.0), "a_T": (1.0,)},
        "a_T = ": {"temperature": (0.0,), "a_T": (-1.0,)},
    },
    T0=0.0,
)


test_refused = refusals(REFUSED)


def test_beyond_the_ranges_is_named():
    """Of the shift: nothing is returned; of the data: the equilibrium is marked.  Both state the
    temperature.
    """

    @dataclass
    class Factors:
        """A function without a hash."""

        range: tuple[float, float]
        __call__ = staticmethod(WLF)

    found = with_shift(Factors((-40.0, 60.0))).temperature(5.0, **MILD)
    assert not found.count
    assert "°C, but the shift of the material is defined only up to 60 °C" in found.reason
    stopped = ROLLER.temperature(force=1e4, **MILD)
    assert stopped.reason.endswith("there is no steady speed other than 0")
    measured = with_shift(WLF, measured=vr.Measured(1e-3, 1e-2, 0.0))
    marked = measured.temperature(5.0, **MILD)
    assert not marked.measured[0]
    assert marked.reason.startswith("the heat given off equals the loss at 87.82")


# --- run files ---


def test_run_file_with_uncertain_surroundings(tmp_path):
    """Each motion has the material at the temperature of its own ambient and conductance."""
    from viscoroll.runs.run_store import roll_inputs

    path = tmp_path / "run.toml"
    path.write_text(
        """\
[cylinder]
R = 0.1
m = 60.0
mu = 0.6
load = 2e4
[base]
E = inf
[material]
E = 3e6
nu = 0.49
prony = { E = [2.0, 40.0], tau = [1.0, 1e-2] }
T_ref = 0.02
reference = 20.0
wlf = { T0 = 0.0, C1 = 8.86, C2 = 101.6 }
[start]
V0 = 3.0
omega0 = 30.0
[run]
n = 8
t = [1.0]
[heat]
ambient = { distribution = "uniform", loc = 0.0, scale = 30.0 }
conductance = 6.0
"""
    )
    run = vr.runs.read_run(path)
    assert run.inputs.uncertain == ("ambient",)
    ambient = np.array([0.0, 30.0])
    found = roll_inputs(run, {"ambient": ambient}, 2)
    for V, A in zip(found.V[:, -1], ambient, strict=True):
        theta = float(ROLLER.temperature(3.0, ambient=A, conductance=6.0).temperature[0])
        assert close(
            V, ROLLER.replace(material=RUBBER.at(theta)).roll(3.0, 30.0, [1.0]).V[-1], 1e-7
        )
    band = "measured = { low = 1e-3, high = 1e-2, misfit = 0.01 }\nT_ref"
    path.write_text(path.read_text().replace("T_ref", band))
    words = "ambient = 15 °C gives no allowed temperature at V = 3 m"
    refused(lambda: vr.runs.read_run(path), words, error=vr.FileError)


# --- strain ---


def test_strain_of_the_contact():
    """0.300 l/R beside a rigid body, half of it in like bodies; a thick layer is a half-space."""
    rubber = replace(RUBBER, nu=0.5, measured=vr.Measured(1e-9, 1e12, 0.0, strain=0.05))
    roller = ROLLER.replace(material=rubber)
    for base, part in ((ROLLER.base, 1.0), (None, 0.5)):
        at = roller.replace(base=base)
        strain = at.validity([1.0, 0.0]).strain
        assert close(
            strain.value, part * 0.300283 * at.contact([1.0, 0.0], delta=0.0).length / 0.1, 1e-6
        )
        assert strain.holds.all() == (part < 1.0)
    elastic = replace(rubber, prony=vr.Prony.elastic())
    thick = replace(elastic, thickness=1.5)
    belt = roller.replace(material=ROLLER.base, base=thick)
    on = roller.replace(material=ROLLER.base, base=rubber)
    assert close(belt.validity(0.0).strain.value, on.validity(0.0).strain.value, tol.THICK_STRAIN)
    assert ROLLER.validity(1.0).strain.holds is None
    # of one rubber, of which one body is a layer and the other one was measured
    layer = replace(elastic, thickness=0.03, measured=None)
    above, below = (
        roller.replace(material=one, base=other).validity(1.0)
        for one, other in ((layer, elastic), (elastic, layer))
    )
    assert close(above.strain.value, below.strain.value, 1e-12)
    assert above.strain.holds == below.strain.holds
    assert above.measured.holds == below.measured.holds


@pytest.mark.usefixtures("two_speeds")
@pytest.mark.long
def test_fit_at_the_strain_of_the_contact():
    """Of moduli that fall with a power of the strain the fit has the strain that its own contact
    has.
    """
    omega = np.geomspace(1e-2, 1e5, 30)

    def record(strain, power=-0.3):
        moduli = [part(omega) * (strain / 0.01) ** power for part in (RUBBER.storage, RUBBER.loss)]
        return vr.DynamicModuli(omega, *moduli, strain=np.full(omega.size, strain), source="a test")

    sets = [record(0.001), record(0.1)]
    fit = vr.fit_at_strain(sets, ROLLER, 3.0)
    own = fit.material(0.49)
    strain = ROLLER.replace(material=own).validity(3.0).strain
    assert close(fit.strain, strain.value, tol.STRAIN_FIXED)
    assert strain.holds
    assert close(
        own.storage(1.0) / RUBBER.storage(1.0), (fit.strain / 0.01) ** -0.3, tol.STRAIN_FIT
    )
    assert "between data at 0.001 and 0.1" in own.measured.source
    small = vr.fit_at_strain([record(1e-6, 0.0), record(1e-5, 0.0)], ROLLER, 3.0)
    assert small.source == "a test, data at a strain of 1e-05"
    apart = [
        replace(each, temperature=np.full(omega.size, T)) for each, T in zip(sets, (20.0, 60.0))
    ]
    assert "data at a strain of" in vr.fit_at_strain(apart, ROLLER, 3.0).source
    for given, roller, words in (
        ([sets[0], replace(sets[1], mode="shear")], ROLLER, "all of tension or all"),
        ([], ROLLER, "at least one"),
        ([record(0.01), record(0.01)], ROLLER, "of different strains; leave out all but one"),
        (sets, vr.presets.RUBBER_ROLLER, "a Cylinder with material="),
    ):
        refused(partial(vr.fit_at_strain, given, roller, 3.0), words)


@pytest.mark.usefixtures("two_speeds")
def test_fit_divides_by_a_vertical_shift():
    """Curves of a rubber with an entropic shift give its moduli and its shift factors."""
    omega = np.geomspace(1e-2, 1e4, 40)
    at = [0.0, 20.0, 40.0]
    hot = [replace(RUBBER, vertical_shift="entropic").at(T) for T in at]
    moduli = [body.storage(omega) for body in hot], [body.loss(omega) for body in hot]
    fit = vr.fit_prony(
        [omega] * 3, *moduli, temperature=at, reference=20.0, vertical_shift="entropic"
    )
    assert close(fit.material().at(40.0, WLF).storage(10.0), hot[2].storage(10.0), tol.STRAIN_FIT)
    assert close(fit.shifts.a_T, [WLF(T) / WLF(20.0) for T in at], tol.STRAIN_FIT)


def test_a_figure_of_equilibria():
    """Temperatures over the speed, the unstable ones open."""
    found = ROLLER.temperature([1.0, 2.0], **COLD)
    stable, _ = found.plot().axes[0].lines
    assert np.array_equal(stable.get_ydata(), found.temperature[found.stable])
    limit = ROLLER.heat_limit(70.0, load=[1e4, 2e4], **WARM)
    (line,) = limit.plot().axes[0].lines
    assert np.array_equal(line.get_ydata(), limit.V)


def test_heat_of_a_motion():
    """A free motion that loses nearly all of its energy warms a body by that over the capacity."""
    motion = ROLLER.roll(3.0, 30.0, [1.0, 2000.0])
    heat = motion.validity(capacity=9e3).heat
    energy = 0.5 * 60.0 * 1.5 * (9.0 - motion.V**2)
    assert close(heat.value, energy / 9e3, 1e-4)
    assert heat.holds.all()
    assert not motion.validity(capacity=100.0).heat.holds[-1]
    assert motion.validity().heat.holds is None
