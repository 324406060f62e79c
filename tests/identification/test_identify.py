"""From synthetic measurements back to the parameters, and what is said where they do not hold
them.
"""

import numpy as np
import pytest
import tolerances as tol
import xarray as xr
from closeness import close
from experiments import (
    BRAKE,
    DRAG,
    HUMP,
    TIMES,
    TRUTH,
    noise,
    ranges,
    resistance,
    roller,
    thrown,
    traction,
)
from scipy.signal import lfilter

import viscoroll as vr

V = HUMP
M = resistance().M
OFF = {"mu": 0.4, "E": 4e6, "E_1": 7.0, "T_ref": 1.5e-3}

SHIFT = vr.WLF(T0=20.0, C1=8.86, C2=101.6)
BEARING = {"brake": (0.0, 0.5), "drag": (0.0, 0.1)}
KNOWN = TRUTH | {"brake": BRAKE, "drag": DRAG, "t0:run": 0.15, "V0:throw": 4.0}


def drum(load):
    """A roller on a drum, whose bearing takes a part too."""
    M = roller().replace(load=load).contact(V, delta=0.0).M
    return vr.Resistance(V, M + BRAKE + DRAG * V / 0.1, sigma=0.01, load=load, name=f"{load} N/m")


def late():
    """A motion under the bearing, by a clock that is late."""
    t = np.linspace(0.0, 30.0, 200)
    m = roller().roll(3.0, 30.0, t, rtol=1e-10, brake=BRAKE, torque=vr.Feedback(0.0, omega=-DRAG))
    return vr.Coastdown(
        t + 0.15, m.V, m.omega, sigma={"V": 5e-3, "omega": 0.05}, V0=3.0, t0=(-0.5, 0.5)
    )


def warm():
    """At 60 degrees the relaxation times are others."""
    M = roller(T_ref=TRUTH["T_ref"] * SHIFT(60.0)).contact(V, delta=0.0).M
    return vr.Resistance(V, M, sigma=0.01, temperature=60.0, name="warm")


def fit_of(names, data, more=(), **options):
    """A fit of these parameters, and ranges of more, that starts at the truth or where told."""
    options = {"cylinder": roller(), "starts": 1} | options
    return vr.identify(unknown=ranges(*names.split()) | dict(more), data=data, **options)


#: data without noise, what they hold, and what else is told
HELD = {
    "pull over the hump": (
        lambda: vr.Resistance(V, F=M / 0.1, sigma=0.1),
        ranges("E", "E_1", "T_ref"),
    ),
    "M and Q": (lambda: [resistance(), traction()], ranges("mu", "E", "T_ref")),
    "a throw": (lambda: thrown(t=TIMES[::4]), ranges("mu", "E", "T_ref")),
    "a bearing at two loads": (lambda: [drum(100.0), drum(700.0)], ranges("E", "T_ref") | BEARING),
    "a bearing and a late clock": (late, ranges("T_ref") | BEARING),
    "two temperatures": (lambda: [resistance(), warm()], ranges("E", "T_ref")),
}


@pytest.mark.parametrize("case", HELD)
def test_exact_data_give_the_truth(case):
    data, unknown = HELD[case]
    start = roller(**{name: OFF[name] for name in OFF.keys() & unknown})
    fit = vr.identify(
        start, unknown, data(), starts=1, shift=SHIFT if case == "two temperatures" else None
    )
    for name, value in fit.values.items():
        rel = tol.IDENTIFIED_DRIVEN if "clock" in case else tol.IDENTIFIED
        assert close(value, KNOWN[name], rel)
    assert fit.chi2 < tol.IDENTIFIED_CHI2
    assert fit.cylinder.mu == fit.values.get("mu", TRUTH["mu"])
    assert not fit.does_not_act
    assert not fit.misfit


def test_an_interval_is_where_a_dense_scan_of_the_profile_rises():
    fit = fit_of("E T_ref", resistance(seed=1))
    low, high = fit.intervals()["E"]

    def rise(E):
        one = fit_of("T_ref", fit.records.values(), cylinder=roller(E=E))
        return one.chi2 - fit.chi2

    width = high - low
    for end, inward in ((low, 1.0), (high, -1.0)):
        assert (
            rise(end + inward * tol.INTERVAL * width)
            < tol.CHI2_95
            < rise(end - inward * tol.INTERVAL * width)
        )


#: a plan that tells a product of E_1 and T_ref alone
SLOWEST = vr.Resistance([1e-4, 2e-4, 4e-4], sigma=3e-5)


@pytest.mark.long
def test_slow_rolling_tells_a_product_alone():
    unknown = {"E_1": (4.5, 18.0), "T_ref": (5e-4, 2e-3)}
    fit = fit_of("mu", SLOWEST, unknown)
    assert fit.does_not_act == ("mu",)
    assert fit.undetermined == ("E_1", "T_ref")
    assert fit.intervals()["mu"] == (None, None)
    (product,) = fit.products()
    assert product.powers == {"E_1": 1.0, "T_ref": 1.0}
    assert product.low < TRUTH["E_1"] * TRUTH["T_ref"] / product.value < product.high
    assert "these data cannot separate E_1 and T_ref: only products of powers" in str(fit)
    assert "are determined: E_1 T_ref = 0.00" in str(fit)


@pytest.mark.long
def test_a_product_that_a_range_limits_is_told():
    """M at one speed tells a product; E and E/T_ref end where T_ref comes to an end of its
    range.
    """
    plan = vr.Resistance([2.0, 2.0], sigma=1e-3)
    fit = fit_of("", plan, {"E": (1e6, 1e7), "T_ref": (0.8e-3, 1.2e-3)})
    known, ratio = fit.products()
    assert known.limited_by == [["T_ref"], []]
    assert ratio.powers == {"E": -1.0, "T_ref": 1.0}
    assert (
        ratio.limited_by
        == fit._likelihood.unknown_profiles(tol.CHI2_95)[0].limited_by
        == [["T_ref"], ["T_ref"]]
    )
    said = str(fit)
    assert (
        "E T_ref^0.77 = 1.469e+04 (95%: -0.65 % to +0.34 %, the lower end set by the range "
        "given for T_ref) and" in said
    )
    assert (
        "E^-1 T_ref = 3.333e-10 (95%: -33 % to +39 %, both ends set by the range given for "
        "T_ref)" in said
    )
    assert "only products of powers are determined within the ranges given: E T_ref^0.77" in said


# --- what is not a fit of one minimum of good data ---


def test_a_wrong_model_is_told_before_any_interval():
    """M of two modes, by one."""
    M = two_modes().contact(V, delta=0.0).M
    fit = fit_of("E T_ref", vr.Resistance(V, M, sigma=0.01))
    assert fit.misfit == ("M of resistance",)
    lines = str(fit).splitlines()
    assert lines[1].startswith("  ! neighbouring residuals (predicted minus measured)")
    assert "M of resistance correlate by 0.8" in lines[1]
    assert "the intervals mean nothing" in lines[1]


def test_sigma_that_is_not_given_is_estimated():
    data = [resistance(seed=4), traction(seed=5)]
    given = fit_of("mu E T_ref", data)
    bare = [vr.Resistance(V, data[0].M), vr.Traction(data[1].V, data[1].delta, data[1].Q)]
    fit = fit_of("mu E T_ref", bare)
    for name, sigma in {"M of resistance": 0.01, "Q of traction": 1.0}.items():
        assert close(fit.sigma[name][0], sigma, tol.SIGMA)
    for name in fit.values:
        assert abs(fit.values[name] - given.values[name]) < 0.5 * given.stderr[name]
        assert close(fit.stderr[name], given.stderr[name], tol.SIGMA)
    assert "measured values, estimated from the fit: M of resistance 0.0" in str(fit)


def fit_with_outliers(seed, body, size, robust=True):
    """5 % of outliers in M of a body."""
    bad = noise(seed, body.contact(V, delta=0.0).M, size)
    bad[[7, 27]] += 0.2, -0.2
    return fit_of("E T_ref", vr.Resistance(V, bad, sigma=0.01), robust=robust)


@pytest.mark.parametrize("robust", [False, True])
def test_outliers_count_less_where_asked(robust):
    """They are no misfit then, and one else."""
    fit = fit_with_outliers(1, roller(), 0.01, robust)
    off = max(abs(np.log(value / TRUTH[name])) for name, value in fit.values.items())
    assert (off < tol.OUTLIERS) == robust == (not fit.misfit)
    assert off < 1.0


def two_modes():
    """Another material."""
    return roller().replace(material=vr.Material(3e6, 0.5, vr.Prony([4.0, 5.0], [1.0, 0.05]), 1e-3))


@pytest.mark.parametrize("body, size", [(two_modes, 0.01), (roller, 0.025)])
def test_a_robust_fit_tells_a_wrong_model(body, size):
    """And a sigma far below the noise, of data with outliers."""
    assert fit_with_outliers(2, body(), size).misfit


def test_a_prior_tells_what_slow_rolling_does_not():
    per_cent = xr.DataArray(10.0, attrs={"units": "%"})
    fit = fit_of("E_1 T_ref", SLOWEST, prior={"E_1": (9.0, per_cent)})
    assert fit.undetermined == ()
    for name in fit.values:
        assert fit.stderr[name] < tol.PRIOR * fit.values[name]


def test_a_plan_tells_what_a_fit_will_know():
    names = "mu E T_ref"
    creeps = np.linspace(-0.06, 0.06, 21)
    planned = [vr.Resistance(V, sigma=0.01), vr.Traction(0.1, creeps, sigma=1.0)]
    plan = fit_of(names, planned)
    assert plan.planned
    assert plan.chi2 == 0.0
    assert plan.cylinder.mu == roller().mu
    fit = fit_of(names, [resistance(seed=8), traction(seed=9)])
    for name in fit.values:
        assert close(plan.stderr[name], fit.stderr[name], tol.PLANNED)
        low, high = plan.intervals()[name]
        assert low < TRUTH[name] < high


def test_a_prediction_has_bands():
    """And the labels of what it was asked at."""
    fit = fit_of("E T_ref", resistance(seed=1))
    speeds = xr.DataArray(
        [0.1, 1.0], dims="speed", coords={"speed": ["slow", "fast"]}, attrs={"units": "m/s"}
    )
    band = fit.predict(vr.Resistance(speeds)).M
    fast = band.value.sel(speed="fast").item()
    assert close(fast, fit.cylinder.contact(1.0, delta=0.0).M, tol.STEADY)
    t = np.linspace(0.0, 30.0, 7)
    by_slopes, drawn = (fit.predict(vr.Coastdown(t, V0=3.0), draws=draws) for draws in (0, 200))
    exact = roller().roll(3.0, 30.0, t).V
    assert ((by_slopes.V.low <= exact) & (exact <= by_slopes.V.high)).all()
    width = [found.V.high - found.V.low for found in (by_slopes, drawn)]
    assert close(width[1][1:], width[0][1:], tol.DRAWN)


def test_motions_that_fail_are_far_off_and_end_no_fit(monkeypatch):
    rolled = vr.Cylinder.roll

    def fails(self, V0, *more, **options):
        if self.mu > 0.45:
            raise vr.ConvergenceError("planted")
        m = rolled(self, V0, *more, **options)
        nothing = {"V": m.V * np.nan, "omega": m.V, "x": m.V, "regime": m.regime}
        return m if self.mu > 0.2 else type("Failed", (), nothing)

    monkeypatch.setattr(vr.Cylinder, "roll", fails)
    fit = fit_of("mu E", thrown(seed=2), cylinder=roller(mu=0.4), starts=4)
    assert abs(fit.values["mu"] - TRUTH["mu"]) < 5.0 * fit.stderr["mu"]
    assert fit.residuals({"mu": 0.5}).max() == fit.residuals({"mu": 0.1}).max() == 1e6


@pytest.fixture(scope="module")
def fit():
    """Of M and of a throw, with noise."""
    data = [resistance(seed=1), thrown(seed=2)]
    return fit_of("mu E", data, {"V0:throw": (3.0, 5.0)})


def test_slopes_are_those_of_the_residuals(fit):
    J = fit.jacobian(fit.values)
    for column, (name, value) in zip(J.T, fit.values.items()):
        step = 1e-4 * value
        up, down = (fit.residuals(fit.values | {name: value + sign * step}) for sign in (1.0, -1.0))
        found = (up - down) / (2.0 * step)
        assert close(column, found, tol.IDENTIFIED_SLOPES, scale=abs(column).max())


def test_a_dataset_and_a_figure_hold_all_of_it(fit):
    data = fit.to_xarray()
    assert close(
        data["throw V"] - data["throw V fit"],
        -fit.residuals(fit.values)[V.size :] * 5e-3,
        tol.IDENTIFIED,
    )
    assert data["throw V fit"].long_name == "velocity of the axis, by the best fit"
    assert data["throw V"].units == "m s-1"
    assert data.unit.sel(unknown="E") == "Pa"
    assert fit.plot().axes


@pytest.mark.long
def test_a_search_from_far_off_looks_beyond_the_ridges_of_its_valley():
    """V of a coast-down has a second valley, of a short time and a large strength, in which this
    start lies.
    """
    t = np.linspace(0.0, 40.0, 200)
    run = vr.Coastdown(t, noise(0, roller().roll(3.0, 30.0, t).V, 5e-3), sigma=5e-3, V0=3.0)
    fit = fit_of("E E_1 T_ref", run, cylinder=roller(E_1=72.0, T_ref=2e-4))
    for name, value in fit.values.items():
        assert abs(value - TRUTH[name]) < 3.0 * fit.stderr[name], name


@pytest.mark.parametrize(
    "points, least", [(40, tol.IDENTIFY_COVERAGE_FEW), (200, tol.IDENTIFY_COVERAGE)]
)
@pytest.mark.long
def test_intervals_of_autocorrelated_residuals_cover_the_truth(points, least):
    """Noise of an autoregression with 0.6, also of few points: by all points 70 % of the intervals
    would; the report states the points.
    """
    V = np.geomspace(0.02, 20.0, points)
    rng = np.random.default_rng(7)
    M = resistance(V).M
    inside = []
    narrow = []
    for _ in range(20):
        noise = lfilter([0.8], [1.0, -0.6], rng.standard_normal(points + 50))[50:]
        fit = fit_of("E T_ref", vr.Resistance(V, M + 0.01 * noise, sigma=0.01))
        far = np.array(
            [abs(value - TRUTH[name]) / fit.stderr[name] for name, value in fit.values.items()]
        )
        inside.extend(far < np.sqrt(fit._delta_chi2()))
        narrow.extend(far * np.sqrt(fit.noise["M of resistance"].repeats) < 1.96)
    assert np.mean(inside) > least
    assert np.mean(narrow) < tol.IDENTIFY_COVERAGE_NARROW
    assert f"in place of {points}" in str(fit)
    wide = fit.intervals()["E"]
    one = fit.values["E"]
    assert wide[0] < one - 1.5 * fit.stderr["E"] < one + 1.5 * fit.stderr["E"] < wide[1]


@pytest.mark.long
def test_a_roller_on_a_cover_is_pulled_without_torque_but_that_of_its_bearing():
    """The force is the work over distance of a motion at that speed; M at creepage 0 is 12 %
    larger.
    """
    belt = vr.Material(4e6, 0.3, vr.Prony([3.0, 2.0], [1.0, 0.05]), 1e-2, thickness=0.01)
    pulled = vr.Cylinder(0.1, 35.5, material=vr.Material.rigid(), base=belt, mu=0.5, coupled=False)
    motion = pulled.roll(None, 10.0, [3.0, 4.0], V=1.0, brake=0.2, rtol=1e-10)
    force = vr.Resistance(1.0).model(pulled, {"brake": 0.2})["F"]
    assert close(force * np.diff(motion.x), np.diff(motion.work_force), tol.MOTION_RTOL * 1e-10)
