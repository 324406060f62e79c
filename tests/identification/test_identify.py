"""From synthetic measurements back to the parameters, and what is said where they do not hold them."""

from __future__ import annotations

import numpy as np
import pytest
import tolerances as tol
from closeness import close
from experiments import (
    BRAKE,
    DRAG,
    HUMP,
    SLOW,
    TIMES,
    TRUTH,
    ranges,
    resistance,
    roller,
    thrown,
    traction,
)
from refusals import refused

import viscoroll as vr

V = HUMP
M = roller().contact(V, delta=0.0, fields="M").M
OFF = {"mu": 0.4, "E": 4e6, "E_1": 6.0, "T_ref": 2e-3}

#: data without noise, and what they hold
HELD = {
    "M over the hump": ([resistance()], ("E", "E_1", "T_ref")),
    "pull over the hump": ([vr.Resistance(V, F=M / 0.1, sigma=0.1)], ("E", "E_1", "T_ref")),
    "Q at three speeds": ([traction((0.1, 1.0, 10.0))], ("mu", "E")),
    "M and Q": ([resistance(), traction()], ("mu", "E", "E_1", "T_ref")),
    "a throw": ([thrown()], ("mu", "E", "E_1", "T_ref")),
    "a throw and M, the series known": ([thrown(), resistance()], ("mu", "E", "T_ref")),
}


@pytest.mark.parametrize("case", HELD)
def test_exact_data_give_the_truth(case):
    data, names = HELD[case]
    start = roller(**{name: OFF[name] for name in names})
    fit = vr.identify(start, ranges(*names), data, starts=1)
    for name in names:
        assert close(fit.values[name], TRUTH[name], rel=tol.IDENTIFIED), name
    assert fit.chi2 < tol.IDENTIFIED_CHI2
    assert fit.cylinder.mu == fit.values.get("mu", TRUTH["mu"])
    assert not fit.does_not_act
    assert not fit.misfit


def test_a_report_says_how_well_the_values_are_known():
    fit = vr.identify(roller(), ranges("E", "E_1", "T_ref"), [resistance(seed=3)], starts=1)
    for name, (low, high) in fit.intervals().items():
        assert low < TRUTH[name] < high
        assert low < fit.values[name] - fit.stderr[name] < fit.values[name] + fit.stderr[name] < high
    text = str(fit)
    assert text.startswith("3 unknowns, 40 points; chi2 ")
    assert "E_1 and T_ref are correlated: -0.999" in text
    assert len(text.splitlines()) == 7


def test_an_interval_is_where_a_dense_scan_of_the_profile_rises():
    fit = vr.identify(roller(), ranges("E", "E_1"), [resistance(seed=1)], starts=1)
    low, high = fit.intervals()["E"]

    def rise(E: float) -> float:
        one = vr.identify(roller(E=E), ranges("E_1"), fit.records.values(), starts=1)
        return one.chi2 - fit.chi2

    width = high - low
    for end, inward in ((low, 1.0), (high, -1.0)):
        assert rise(end + inward * tol.INTERVAL * width) < 3.841 < rise(end - inward * tol.INTERVAL * width)


def test_slow_rolling_tells_a_product_alone():
    fit = vr.identify(roller(), ranges("mu", "E", "E_1", "T_ref"), [resistance(SLOW, seed=2)], starts=1)
    assert fit.does_not_act == ("mu",)
    assert fit.undetermined == ("E", "E_1", "T_ref")
    assert fit.intervals()["mu"] == (None, None)
    (product,) = fit.products()
    assert product.powers == {"E_1": 1.0, "T_ref": 1.0}
    assert product.low < TRUTH["E_1"] * TRUTH["T_ref"] / product.value < product.high
    text = str(fit)
    assert "mu does not act on these data" in text
    assert "E, E_1 and T_ref cannot be told apart by these data: only E_1 T_ref = 0.00" in text


REFUSED = {
    "an unknown name": (lambda: vr.identify(roller(), {"mue": (0.1, 1.0)}, [resistance()]), "'mue'", "mu, j"),
    "a range without the start": (
        lambda: vr.identify(roller(), {"E": (1e6, 2e6)}, [resistance()]), "unknown E", "(1e+06, 2e+06)", "3e+06",
    ),
    "a range that falls": (lambda: vr.identify(roller(), {"E": (4e6, 2e6)}, [resistance()]), "low < high"),
    "a range for a logarithm": (lambda: vr.identify(roller(), {"E": (0.0, 9e6)}, [resistance()]), "above 0"),
    "NaN with its row": (lambda: vr.Resistance([0.1, 0.2], [1.0, np.nan], name="drum"), "drum: M = nan at row 1"),
    "more unknowns than points": (
        lambda: vr.identify(roller(), ranges("E", "T_ref"), [vr.Resistance(0.1, 0.1)]), "2 unknowns, but 1",
    ),
    "sigma of 0": (lambda: vr.Resistance(V, M, sigma=0.0), "sigma of M = 0.0", "> 0"),
    "one sigma for two": (lambda: vr.Coastdown(TIMES, TIMES, TIMES, sigma=0.1), "'V': ..., 'omega': ..."),
    "times that fall": (lambda: vr.Coastdown([0.0, 2.0, 1.0], [1.0, 1.0, 1.0], sigma=0.1), "2, 1 at rows 1, 2"),
    "values of another shape": (lambda: vr.Resistance(V, M[:-1], sigma=0.1), "(39,)", "(40,)"),
    "M and F": (lambda: vr.Resistance(V, M, F=M), "M and F are both given"),
    "two of one name": (
        lambda: vr.identify(roller(), ranges("E"), [resistance(name="a"), resistance(name="a")]), "'a'", "another",
    ),
    "values and plans": (
        lambda: vr.identify(roller(), ranges("E"), [resistance(), vr.Resistance(V, sigma=0.1, name="b")]), "then plan",
    ),
    "a plan without sigma": (lambda: vr.identify(roller(), ranges("E"), [vr.Resistance(V)]), "resistance: sigma"),
    "a start that nobody knows": (lambda: vr.Coastdown(TIMES, sigma=0.1), "V0", "a plan has no data"),
    "a temperature without a shift": (
        lambda: vr.identify(roller(), ranges("E"), [resistance(temperature=60.0)]), "temperature = 60 needs shift",
    ),
    "many cylinders": (lambda: vr.identify(roller().replace(mu=[0.1, 0.2]), ranges("E"), [resistance()]), "mu", "(2,)"),
    "no record": (lambda: vr.identify(roller(), ranges("E"), []), "no record"),
    "no unknown": (lambda: vr.identify(roller(), {}, [resistance()]), "at least one name"),
    "a prior of nothing": (
        lambda: vr.identify(roller(), ranges("E"), [resistance()], prior={"mu": (0.3, 0.1)}), "prior", "'mu'",
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", REFUSED)
def test_bad_input_is_refused_in_one_line(case):
    call, *words = REFUSED[case]
    refused(call, *words)


@pytest.mark.parametrize("units", ["km/h", "cm s-1", "%"])
def test_other_units_are_refused(units):
    xarray = pytest.importorskip("xarray")
    speeds = xarray.DataArray(V, dims="speed", attrs={"units": units})
    refused(lambda: vr.Resistance(speeds, sigma=0.1), "resistance: V", f"in {units}", "in m s-1")
    for same in ("m/s", "m s-1", "m s^-1"):
        assert vr.Resistance(speeds.assign_attrs(units=same), sigma=0.1).shape == V.shape


def test_bearing_is_told_from_the_material_at_two_loads():
    """Of a drum: M + brake + drag omega."""
    data = [
        vr.Resistance(V, at.M + BRAKE + DRAG * V / 0.1, sigma=0.01, load=load, name=name)
        for name, load in (("light", 100.0), ("heavy", 700.0))
        for at in [roller().replace(load=load).contact(V, delta=0.0, fields=("M",))]
    ]
    fit = vr.identify(roller(E=4e6), ranges("E", "T_ref") | {"brake": (0.0, 0.5), "drag": (0.0, 0.1)}, data, starts=1)
    for name, value in {"E": TRUTH["E"], "T_ref": TRUTH["T_ref"], "brake": BRAKE, "drag": DRAG}.items():
        assert close(fit.values[name], value, rel=tol.IDENTIFIED), name
