"""From storage and loss modulus to a Prony series: what is recovered, what is said, what is
refused.
"""

import sys

import numpy as np
import pytest
import rubbers
import tolerances as tol
from closeness import close
from hypothesis import example, given, settings
from hypothesis import strategies as st
from places import DATA
from refusals import refused

import viscoroll as vr
from viscoroll.measurements.spectrum import FLOOR

pytestmark = pytest.mark.usefixtures("two_speeds")

#: a rubber of ten modes over eight decades, times in s
E = 1e6
TAU = np.logspace(2, -6, 10)
STRENGTHS = 3e5 * np.array([0.3, 0.5, 0.4, 0.6, 0.9, 1.5, 3.0, 8.0, 20.0, 40.0])
ALPHA = 1.0 + STRENGTHS.sum() / E


def curve(omega, strengths=STRENGTHS, tau=TAU, E=E, noise=0.0, seed=1):
    """omega, E', E'' of a series, with relative noise."""
    errors = 1.0 + noise * np.random.default_rng(seed).standard_normal((2, omega.size))
    return omega, *(rubbers.moduli(omega, strengths, tau, E) * errors)


# --- what is recovered ---


def test_two_modes_are_found_exactly():
    data = curve(np.logspace(-2, 5, 50), [2.0, 6.0], [1.0, 1e-3], 1.0)
    for modes in (None, 2, 5):
        fit = vr.fit_prony(*data, modes)
        found = *fit.prony.tau, *fit.prony.E, fit.E, fit.T_ref
        assert close(found, (1.0, 1e-3, 2.0, 6.0, 1.0, 1.0), tol.DMA_EXACT)
        assert not fit.outside.any()


@settings(max_examples=10, deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(3, 40), st.floats(0.0, 0.3), st.floats(0.5, 9.0))
@example(6140328, 6, 0.3, 1.0)
def test_strengths_are_not_negative_whatever_the_noise(seed, points, noise, decades):
    """Or, where noise hides the plateau, the data are refused as those of a fluid."""
    omega, storage, loss = curve(np.logspace(-2, -2 + decades, points), noise=noise, seed=seed)
    try:
        fit = vr.fit_prony(omega, np.abs(storage), np.abs(loss))
    except vr.ParameterError as refusal:
        if "no plateau at low frequencies" in str(refusal):
            return
        raise
    assert (fit.prony.E > 0.0).all()
    assert FLOOR * fit.storage.min() * 0.999 <= fit.E
    assert np.isfinite(fit.misfit).all()
    times = fit.prony.tau * fit.T_ref
    beyond = max(times.max() * fit.omega[0], 1.0 / (times.min() * fit.omega[-1]))
    assert beyond <= 10.0 * (1.0 + tol.DMA_EXACT)


# --- several temperatures ---

TEMPERATURES = np.array([-40.0, -30.0, -20.0, -10.0, 0.0, 10.0, 20.0, 40.0])


def wlf(T):
    return 10.0 ** (-8.86 * T / (101.6 + T))


def isotherms(points, noise):
    omega = 2.0 * np.pi * np.geomspace(0.1, 100.0, points)
    made = [curve(omega * wlf(T), noise=noise, seed=n) for n, T in enumerate(TEMPERATURES)]
    return [omega] * TEMPERATURES.size, *np.swapaxes(made, 0, 1)[1:]


CURVES = isotherms(21, 0.0)


@pytest.mark.parametrize(
    "points, noise, allowed", [(21, 0.0, tol.DMA_SHIFT), (11, 0.005, tol.DMA_SHIFT_NOISY)]
)
def test_shift_factors_are_found(points, noise, allowed):
    curves = isotherms(points, noise)
    fit = vr.fit_prony(*curves, temperature=TEMPERATURES, reference=0.0)
    assert close(np.log10(fit.shifts.a_T), np.log10(wlf(TEMPERATURES)), allowed, scale=1.0)
    assert max(fit.misfit) <= tol.DMA_MISFIT
    assert close(fit.alpha, ALPHA, tol.DMA_ALPHA)
    flat = [np.concatenate(column) for column in curves]
    again = vr.fit_prony(*flat, temperature=np.repeat(TEMPERATURES, points), reference=0.0)
    assert again.prony == fit.prony


@pytest.mark.long
def test_times_are_those_at_the_reference():
    """All modes times a_T, by functions whose constants are of any temperature and by factors.  A
    shift means a reference: T0 and the temperature of the factor 1, where they are among the
    curves; else the middle curve.
    """
    for shift, asked, meant in (
        (vr.WLF(C1=8.86, C2=101.6, T0=0.0), None, 0.0),
        # the same moved to -60
        (vr.WLF(C1=8.86 * 101.6 / 41.6, C2=41.6, T0=-60.0), None, 0.0),
        (lambda T: 7.0 * wlf(T), -30.0, -30.0),
        (3.0 * wlf(TEMPERATURES), None, 0.0),
        (wlf(TEMPERATURES) / wlf(20.0), None, 20.0),
    ):
        options = {"reference": asked, "shift": shift, "misfit": 1e-6}
        fit = vr.fit_prony(*CURVES, TAU.size, temperature=TEMPERATURES, **options)
        assert fit.material().temperature == fit.shifts.reference == meant
        assert np.isnan(fit.shifts.mismatch).all()
        truth = np.sort(TAU * wlf(meant))
        assert close(np.sort(fit.prony.tau) * fit.T_ref, truth, tol.DMA_SHIFTED_TIMES)
        assert close(fit.shifts.a_T, wlf(TEMPERATURES) / wlf(meant), tol.DMA_SHIFTED_TIMES)
    shift = vr.Arrhenius(energy=8e4, T0=-10.0)
    assert vr.fit_prony(*CURVES, temperature=TEMPERATURES, shift=shift).shifts.reference == -10.0


@pytest.mark.long
def test_temperatures_as_they_were_measured():
    """Within 0.5 K of a neighbour points are of one set, and the report says so; factors go by the
    sets, in either order.
    """
    omega, storage, loss = (np.concatenate(column[::-1]) for column in CURVES)
    nominal = np.repeat(TEMPERATURES[::-1], 21)
    measured = nominal + np.tile(np.linspace(-0.3, 0.3, 21), TEMPERATURES.size)
    for shift in (None, wlf(TEMPERATURES[::-1])):
        exact, fit = (
            vr.fit_prony(omega, storage, loss, temperature=temperature, reference=0.0, shift=shift)
            for temperature in (nominal, measured)
        )
        assert close(fit.shifts.temperature, TEMPERATURES, 1e-12, scale=1.0)
        assert close(fit.shifts.a_T, exact.shifts.a_T, tol.DMA_SHIFTED_TIMES)
        assert "were combined: " in str(fit)
        assert "were taken for" not in str(exact)
    assert close(exact.shifts.a_T, wlf(TEMPERATURES), tol.DMA_SHIFTED_TIMES)


def test_a_plateau_fixes_no_shift():
    """Two decades below the slowest mode nothing moves: a warning and the report say so; storage
    alone is offered.
    """
    omega = np.logspace(-5.0, -3.0, 11)
    storage = [curve(omega * wlf(T), STRENGTHS[1:], TAU[1:])[1] for T in (0.0, 10.0)]
    floor = [np.full(11, 50.0)] * 2  # of the instrument
    with pytest.warns(
        vr.ModelWarning,
        match=r"does not determine the shift from 0 to 10 °C \(.*: give known .* or try on=",
    ):
        fit = vr.fit_prony([omega] * 2, storage, floor, temperature=[0.0, 10.0], misfit=0.5)
    assert "does not determine the shift from 0 to 10 °C" in str(fit)


@pytest.mark.filterwarnings("ignore:storage and loss modulus overlap")
@pytest.mark.parametrize("part", [lambda f: f, lambda f: 1.0 / (800.0 * f), lambda f: 1.0])
def test_a_part_of_the_loss_that_does_not_shift_leaves_the_shift_to_the_storage(part):
    """A low-loss material, a decade for 5 K, with a part of E'' of the instrument as large as its
    own.
    """
    f = np.geomspace(0.1, 80.0, 15)
    temperatures = np.arange(20.0, 45.0, 5.0)
    rng = np.random.default_rng(3)
    x = np.log10(f) - np.arange(5.0)[:, None]
    storage = 1.0 + 0.025 * x + 0.0015 * x * np.abs(x)
    loss = 0.5 * np.pi * (0.025 + 0.003 * np.abs(x)) / np.log(10.0) + 0.02 * part(f / 80.0)
    storage *= 1.0 + 1e-3 * rng.standard_normal(x.shape)
    loss *= 1.0 + 1e-2 * rng.standard_normal(x.shape)
    fit = vr.fit_prony([f] * 5, storage, loss, temperature=temperatures, reference=20.0)
    assert close(np.log10(fit.shifts.a_T), -np.arange(5.0), tol.DMA_SHIFT_LOW_LOSS, scale=1.0)


def test_moduli_that_disagree_on_the_shift_and_factors_that_rise_are_named():
    omega, storage, loss = CURVES
    loss = loss * (1.0 + 0.1 * np.log(omega))
    with pytest.warns(
        vr.ModelWarning,
        match="storage and loss modulus overlap best at different shifts from -30 to -20 °C",
    ):
        vr.fit_prony(omega, storage, loss, temperature=TEMPERATURES, misfit=1.0)
    factors = wlf(TEMPERATURES)
    factors[2] = 2.0 * factors[1]
    with pytest.warns(
        vr.ModelWarning, match=r"the shift factor a_T rises from -30 to -20 °C \(by a factor of 2\)"
    ):
        vr.fit_prony(*CURVES, temperature=TEMPERATURES, shift=factors, misfit=1.0)


@pytest.mark.parametrize("decades", [2.4, 2.59, 3.5])
def test_curves_too_far_apart_are_refused(decades):
    """Of 2.7 decades each: less than 15 % of overlap is not enough to find a shift, and is not
    taken for the best.
    """
    omega = 2.0 * np.pi * np.geomspace(0.1, 50.0, 15)
    _, *moduli = np.swapaxes([curve(omega * a) for a in (10.0**decades, 1.0)], 0, 1)
    with pytest.raises(
        vr.ParameterError, match=r"at 0 and 20 °C (agree best with the least|do not agree)"
    ):
        vr.fit_prony([omega] * 2, *moduli, temperature=[0.0, 20.0])


def test_found_factors_are_a_shift_and_give_a_law():
    """Between the curves by interpolation, beyond them by WLF; of two or more by Arrhenius; what is
    none is refused.
    """
    fit = vr.fit_prony(*CURVES, temperature=TEMPERATURES, reference=0.0)
    law = fit.wlf()
    inside = TEMPERATURES[:-1] + 5.0
    beyond = np.array([-40.0, 60.0])
    assert close([*map(fit.shifts, inside)], wlf(inside), tol.DMA_SHIFT_BETWEEN)
    anywhere = np.append(inside, beyond)
    assert close([*map(law, anywhere)], wlf(anywhere), tol.DMA_SHIFT_LAW)
    rubber = fit.material(0.49)
    moved = rubber.at(-25.0, fit.shifts)
    assert close(moved.T_ref, rubber.T_ref * wlf(-25.0), tol.DMA_SHIFT_BETWEEN)
    two = vr.ShiftFactors(temperature=(0.0, 10.0), a_T=(9.0, 1.0), T0=10.0)
    refused(two.wlf, "at least 3")
    with pytest.warns(vr.ModelWarning, match="times the factor found at"):
        vr.ShiftFactors(temperature=(0.0, 10.0, 20.0), a_T=(100.0, 99.0, 1.0), T0=0.0).wlf()


# --- shear, records, many points, relaxation ---


def test_shear_is_shear():
    """E = 2 (1 + nu) G where the material is made, and the report, the material and the files say
    so.
    """
    omega, storage, loss = curve(np.logspace(-2.5, 6.5, 60))
    tension = vr.fit_prony(omega, storage, loss, temperature=20.0, source="sweep.csv")
    assert tension.to_xarray().temperature == 20.0
    record = vr.DynamicModuli(omega, storage / 2.98, loss / 2.98, mode="shear", source="sweep.csv")
    shear = vr.fit_prony(record)
    assert close(shear.material(0.49).E, tension.material(0.49).E, tol.DMA_EXACT)
    assert close(shear.material(0.3).G, shear.E, tol.DMA_EXACT)
    assert "shear: E = 2 (1 + nu) G = 2.98 G" in str(shear.material(0.49).measured)
    assert shear.to_xarray().attrs["modulus"] == shear.mode == "shear"


def test_many_points_are_thinned():
    """20,000 points with noise give the series of exact data, in a time that does not grow with
    them.
    """
    omega, storage, loss = curve(np.geomspace(1e-2, 1e5, 20000), noise=0.01)
    fit = vr.fit_prony(omega, storage, loss)
    assert fit.reached
    assert fit.points == 20000
    assert fit.data[0].size <= 500
    inner = np.geomspace(1e-2, 1e4, 200)
    _, storage, loss = curve(inner)
    material = fit.material()
    assert close(material.storage(inner), storage, tol.DMA_MANY)
    assert close(material.loss(inner), loss, tol.DMA_MANY)


def relaxing(t):
    return E + np.exp(-np.divide.outer(t, TAU)) @ STRENGTHS


def test_relaxation_and_dynamic_data_give_one_material():
    """E(t) of ten modes and E', E'' of the same: the same moduli inside both bands; the band
    follows from 1/t.
    """
    t = np.geomspace(1e-4, 1e3, 60)
    fit = vr.fit_relaxation(t[::-1], relaxing(t)[::-1], misfit=1e-3)
    assert fit.reached
    assert close((fit.measured.low, fit.measured.high), (1e-3, 1e4), 1e-12)
    omega = np.geomspace(1e-2, 1e3, 30)
    material = fit.material(0.5)
    _, storage, loss = curve(omega)
    assert close(material.storage(omega), storage, tol.DMA_RELAXATION)
    assert close(material.loss(omega), loss, tol.DMA_RELAXATION_LOSS)
    assert close(fit.modulus(t), fit.material().relaxation(t), 1e-13)
    assert close(fit.E, E, tol.DMA_ALPHA)


# --- files ---


@pytest.mark.long
def test_pyvisco_file_is_read_and_its_report_says_that_storage_and_loss_differ():
    omega, storage, loss = vr.read_dma(DATA / "materials/pyvisco_freq_user_master.csv")
    assert omega.size == 206
    first = 2.0 * np.pi * 1e-12, 88.79651575665739e6, 10.502460140936773e6
    assert close((omega[0], storage[0], loss[0]), first, tol.DMA_READ)
    fit = vr.fit_prony(omega[::4], storage[::4], loss[::4], 8)
    low, high = tol.DMA_PYVISCO
    assert low < fit.kramers_kronig.median < high
    assert not fit.reached
    text = str(fit)
    assert f"{fit.kramers_kronig.median:.2f} times the value from the slope of E'" in text
    assert (
        "the moduli contradict each other or rise steeply, or relaxation times are far apart"
        in text
    )
    flat = vr.fit_prony(omega[:5], np.full(5, 1e8), loss[:5])
    assert "E''       is above 0, but E' does not rise" in str(flat)


@pytest.mark.skipif(sys.platform != "linux", reason="names of files that are no UTF-8")
def test_source_is_a_text(tmp_path):
    """A name of a file that is no UTF-8 is a source that files can hold."""
    path = tmp_path / "\udcff.csv"
    path.write_text("omega [rad/s],E' [Pa],E'' [Pa]\n1,1e6,1e5\n10,2e6,2e5\n100,3e6,3e5\n")
    assert vr.read_dma(path).source == "?.csv"
