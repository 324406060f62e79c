"""Steady rolling under load: extrema of M, all equilibria, stability, feedback, limits of
existence.
"""

import math

import flint
import mpmath as mp
import numpy as np
import pytest
import tolerances as tol
from calls import COVER
from closeness import close
from long_cases import long
from refusals import refused
from scipy.optimize import brentq

import viscoroll as vr
from pipeline.evidence.truth import material_of, zone_of
from viscoroll.contact_mechanics.contact_table import SLOPES_OF_BODIES

SCENE = vr.presets.PAPER_SECTION_5_ROUNDED
KAPPA = SCENE.kappa
TWO = vr.Prony([2.0, 6.0], [1.0, 1e-2])
#: a hump a mode, of ever smaller height
TEN = vr.Prony(2.0 ** np.arange(10), 10.0 ** np.linspace(0.0, -18.0, 10))
UNLIKE = vr.Bodies(TWO, vr.Prony([1.0, 3.0], [0.3, 3e-4]), 0.3)


def series_scene(material, mu=0.2, j=0.5):
    return vr.Scene(material=material, kappa=10.0, mu=mu, gamma=1.0, j=j, coupled=False)


def assert_balanced(scene, s, allowed):
    """V' and j omega' over gamma t at what was found, by the contact law, are 0 within
    ``allowed``.
    """
    c = scene.contact(s.V, omega=s.omega, fields=("Q", "M_half_space", "M_cylinder"))
    for off in (c.Q - c.M_half_space + s.force, -c.Q - c.M_cylinder + s.torque):
        assert (abs(off) <= allowed).all()


# --- accuracy ---


def test_speeds_against_extended_precision():
    """Also close to the fold: an error of 1e-16 of the load is one of its square root there."""
    scene = vr.Scene(11.0, KAPPA, 10.0)
    hump = scene.resistance_extrema()
    with mp.workdps(50), flint.ctx.workprec(600):

        def curve(x):
            """kappa V and kappa M over ln zeta."""
            z = mp.exp(x)
            f = zone_of(material_of(11.0), flint.arb(z))
            u = 1 / (2 * z * mp.sqrt(1 + 2 * mp.mpf(f.h.mid()) / z))
            return u, u * mp.mpf(f.m.mid())

        start = -mp.log(2 * mp.mpf(hump.V[0] * KAPPA))
        x_top = mp.findroot(
            lambda x: mp.diff(lambda y: curve(y)[1], x, h=mp.mpf(10) ** -15),
            (start - 0.3, start),
            tol=1e-25,
        )
        u_top, top = curve(x_top)
        assert abs(hump.V[0] * KAPPA / u_top - 1) < tol.STEADY_HUMP_V
        assert abs(hump.M[0] * KAPPA / top - 1) < tol.STEADY
        for short in (0.4, 1e-5, 1e-9, 1e-12):
            force = float(top * (1 - mp.mpf(short)) / mp.mpf(KAPPA))
            load = mp.mpf(force) * mp.mpf(KAPPA)

            def missing(x, load=load):
                return curve(x)[1] - load

            for found, end in zip(scene.steady(force=force).V, (x_top + 4, x_top - 4), strict=True):
                x = mp.findroot(missing, (x_top, end), solver="anderson", tol=1e-50, maxsteps=200)
                assert (
                    abs(mp.mpf(found) * mp.mpf(KAPPA) / curve(x)[0] - 1) * mp.sqrt(short)
                    < tol.STEADY
                ), short


def test_creep_has_its_traction():
    """From slight creep to friction all but spent, relative."""
    torque = 0.2 + 0.5 * series_scene(TWO).contact(0.3, delta=0.0).M
    for part in (1e-12, 1e-6, 1e-3, 0.3, 0.9, 1.0 - 1e-6, 1.0 - 1e-10):
        scene = series_scene(TWO, mu=0.2 / part)
        s = scene.steady(V=0.3, torque=torque)
        state = scene.contact(0.3, delta=s.delta)
        assert close(s.Q, 0.2, tol.STEADY)
        assert close(s.grip, 1.0 - part, tol.STEADY_GRIP / (1.0 - part))
        assert close(state.Q, s.Q, tol.STEADY)
        assert close(state.beta, s.beta, tol.STEADY / s.grip)


# --- several modes, two bodies ---


def brute(scene, force, torque, speeds):
    """Equilibria with V > 0 by changes of sign of M(V) - force - torque, friction sufficing."""
    c = scene.contact(speeds, delta=0.0, fields=("M", "M_cylinder"))
    off = c.M - force - torque
    turns = off[1:] * off[:-1] < 0.0
    return int((turns & (abs(torque - c.M_cylinder[1:]) < scene.mu)).sum())


def test_all_equilibria_of_random_materials():
    rng = np.random.default_rng(2)
    for n in range(12):
        modes = int(rng.integers(1, 6))
        series, other = (
            vr.Prony(10.0 ** rng.uniform(-1, 2, modes), 10.0 ** rng.uniform(-8, 0, modes))
            for _ in range(2)
        )
        scene = series_scene(
            series if n % 2 else vr.Bodies(series, other, rng.uniform(0.1, 0.9)), mu=0.03
        )
        speeds = np.geomspace(1e-7, 1e12, 40001)
        top = scene.resistance_extrema().M.max()
        for _ in range(8):
            g = rng.uniform(0.0, 1.1) * top
            q = rng.uniform(-0.03, 0.03)
            s = scene.steady(force=g - q, torque=q)
            within = (s.V > speeds[0]) & (s.V < speeds[-1])
            assert within.sum() == brute(scene, g - q, q, speeds)
            assert_balanced(scene, s, tol.STEADY_RESIDUAL / np.minimum(s.grip, 1.0))
            c = scene.contact(s.V, omega=s.omega)
            known = [c.beta, 1.0 - abs(c.Q) / scene.mu]
            assert not s.count or close(known, [s.beta, s.grip], tol.STEADY_BETA, scale=1.0)


def test_ten_humps():
    scene = series_scene(TEN)
    hump = scene.resistance_extrema()
    assert hump.is_maximum.tolist() == [True, False] * 9 + [True]
    slopes = scene.contact(hump.V, delta=0.0, fields="dM_dV").dM_dV
    assert (abs(slopes * hump.V) <= tol.STEADY_FLAT * hump.M).all()
    for g in (0.5 * hump.M.min(), 0.5 * (hump.M[2] + hump.M[4]), 0.99 * hump.M[0]):
        s = scene.steady(force=g)
        ends = np.concatenate([[0.0], hump.M, [0.0]])
        assert s.count == 2 * (np.diff(np.sign(ends - g)) > 0.0).sum()
        assert s.stable.tolist() == [True, False] * (s.count // 2)
        np.testing.assert_array_equal(s.M, [g] * s.count)
    for n, count in ((0, 1), (1, 3)):  # at the highest top, and at the bottom beside it
        s = scene.steady(force=hump.M[n])
        assert s.count == count
        assert close(s.V[n], hump.V[n], tol.SCENE)
    assert scene.steady(force=hump.M[0] * (1.0 + 1e-14)).count == 0


# --- stability ---


def test_eigenvalues_are_those_of_the_slopes_of_the_contact_law():
    """Of (V', omega') over gamma t by V and omega; the falling branch of every hump is a saddle."""
    for scene in (
        SCENE.replace(j=0.3),
        series_scene(TWO),
        series_scene(UNLIKE, j=2.0),
        series_scene(TEN),
    ):
        g = 0.6 * scene.resistance_extrema().M[0]
        for gains in (np.zeros((2, 2)), np.array([[-0.02, 0.01], [0.01, -0.05]])):
            force, torque = (vr.Feedback(part * g, *row) for part, row in zip((0.3, 0.7), gains))
            s = scene.steady(force=force, torque=torque)
            assert s.count >= 1
            c = scene.contact(
                s.V, omega=s.omega, fields=("dQ_dV", "dQ_domega", *SLOPES_OF_BODIES, "dM_dV")
            )
            a = c.dQ_dV - c.dM_half_space_dV + force.V
            b = c.dQ_domega + force.omega
            p = (-c.dQ_dV - c.dM_cylinder_dV + torque.V) / scene.j
            q = (-c.dQ_domega + torque.omega) / scene.j
            trace = s.eigenvalues.sum(axis=-1)
            det = s.eigenvalues.prod(axis=-1)
            assert close(trace.real, a + q, tol.STEADY_DETERMINANT, scale=abs(a))
            assert close(det.real, a * q - b * p, tol.STEADY_DETERMINANT, scale=abs(a * q))
            assert not np.any([trace.imag, det.imag])
            assert np.array_equal(s.stable, (s.eigenvalues.real < 0.0).all(axis=-1))
            assert gains.any() or np.array_equal(c.dM_dV < 0.0, ~s.stable)


def test_focus_where_friction_is_all_but_spent():
    """Complex eigenvalues: |Q| -> mu, j < 1."""
    hump = SCENE.resistance_extrema()
    f = 0.5 * hump.M[0]
    s = SCENE.replace(mu=0.5 * f * (1.0 + 1e-8), j=0.1).steady(force=f)
    assert close(s.grip[0], 1e-8, 1e-6)
    first, second = s.eigenvalues[0]
    assert first.conjugate() == second != first
    assert s.stable.tolist() == [True, False]


# --- against motions ---


def test_motions_settle_at_equilibria():
    """From rest up the first rising branch: unlike bodies on a slope, pushed, with a motor whose
    torque falls.
    """
    scene = series_scene(UNLIKE)
    load = {"slope": 0.002, "force": 0.001, "torque": vr.Feedback(0.003, omega=-0.05)}
    s = scene.steady(**load)
    end = 40.0 / -s.eigenvalues[0, 1].real
    m = scene.roll(0.0, 0.0, [0.0, end], rtol=1e-10, **load)
    assert close((m.V[-1], m.omega[-1]), (s.V[0], s.omega[0]), tol.STEADY_SETTLED)


# --- slope ---


def test_critical_slope():
    """tan(theta) = M_top of kappa/sqrt(cos(theta)): the definition."""
    turned = lambda theta: SCENE.replace(kappa=KAPPA / np.sqrt(np.cos(theta)))  # noqa: E731
    theta = brentq(
        lambda theta: math.tan(theta) - turned(theta).resistance_extrema().M[0],
        0.0,
        1.0,
        xtol=1e-16,
    )
    assert close(math.degrees(theta), 4.8, 0.05 / 4.8)
    s = SCENE.steady(slope=theta * np.array([1.0 - 1e-9, 1.0 + 1e-9]))
    assert s.count.tolist() == [2, 0]
    np.testing.assert_array_equal(
        SCENE.steady(slope=0.05).V, turned(0.05).steady(force=np.tan(0.05)).V
    )


# --- feedback ---


def brute_feedback(scene, force, torque, V):
    """Equilibria between speeds V of one sign: Q by the combination of both balances without omega,
    bisected at each speed, or that of full slip; changes of sign of what is left of the other.
    """
    ahead = abs(force.omega) > abs(torque.omega)
    gain = V * (force.omega if ahead else torque.omega)

    def left(delta):
        c = scene.contact(V, delta=delta, fields=("Q", "M_half_space", "M_cylinder"))
        omega = V * (1.0 + delta)
        axis = c.Q - c.M_half_space + force.value + force.V * V + force.omega * omega
        spin = torque.value + torque.V * V + torque.omega * omega - c.Q - c.M_cylinder
        return torque.omega * axis - force.omega * spin, axis if ahead else spin

    def count(off, allowed):
        return int((allowed[1:] & allowed[:-1] & (off[1:] * off[:-1] < 0.0)).sum())

    ends = scene.contact(V, delta=0.0, fields=("delta_minus", "delta_plus"))
    low, high = ends.delta_minus, ends.delta_plus
    back, ahead_of_it = (left(delta) for delta in (-10.0, 10.0))
    found = count(back[0], -10.0 - back[1] / gain < low)
    found += count(ahead_of_it[0], 10.0 - ahead_of_it[1] / gain > high)
    top = left(high)[0] > 0.0
    within = top != (left(low)[0] > 0.0)
    for _ in range(60):
        middle = 0.5 * (low + high)
        above = (left(middle)[0] > 0.0) == top
        low, high = np.where(above, low, middle), np.where(above, middle, high)
    return found + count(left(middle)[1], within)


ON_BELT = series_scene(COVER)
#: by the fast law, by the table of the coupled solution, and with the cover on the cylinder
COVERED = (
    ON_BELT,
    ON_BELT.replace(coupled=None),
    series_scene(vr.Cover(TWO, nu=0.3, thickness=1.0)),
)


@pytest.mark.parametrize(
    "scene", [SCENE, series_scene(TWO, mu=0.02), series_scene(UNLIKE, mu=0.02), *long(*COVERED)]
)
def test_feedback_on_omega_misses_none(scene):
    """With both loads, one load or the other dependent on omega, under random values and gains."""
    rng = np.random.default_rng(3)
    x = np.geomspace(1e-6, 1e4, 1001)
    several = 0
    for n in range(5):
        gains = rng.uniform(-0.5, 0.5, 4) * (1.0, n != 1, 1.0, n != 2)
        force = vr.Feedback(rng.uniform(-0.1, 0.1), V=gains[0], omega=gains[1])
        torque = vr.Feedback(rng.uniform(-0.1, 0.1), V=gains[2], omega=gains[3])
        s = scene.steady(force=force, torque=torque)
        assert_balanced(scene, s, tol.STEADY_SCAN * (1.0 + abs(s.omega)))
        assert (s.loss.slip >= 0.0).all()
        within = (abs(s.V) > x[0]) & (abs(s.V) < x[-1])
        brute = sum(brute_feedback(scene, force, torque, V) for V in (x, -x))
        assert within.sum() == brute, (n, gains)
        several += s.count > 2
    assert several


@pytest.mark.parametrize("coupled", [False, *long(None)])
def test_gains_on_omega_that_nearly_cancel_are_refused(coupled):
    force, torque = (vr.Feedback(0.01, omega=gain) for gain in (0.1, -0.1))
    scene = ON_BELT.replace(coupled=coupled)
    refused(lambda: scene.steady(force=force, torque=torque), "nearly cancel")


def test_opposite_gains_on_omega():
    """fw = -qw: V as without, and up to three slips at each, those of full slip included."""
    s = SCENE.steady(force=vr.Feedback(0.05, omega=-0.3), torque=vr.Feedback(0.0, omega=0.3))
    bare = SCENE.steady(force=0.05)
    assert set(np.round(s.V, 12)) == set(np.round(bare.V, 12))
    assert s.count == 4
    assert (np.sort(s.grip)[:3] == 0.0).all()
    assert_balanced(SCENE, s, tol.STEADY_SCAN)


# --- losses ---


def test_losses_are_what_the_loads_put_in():
    rng = np.random.default_rng(4)
    for scene in (SCENE, series_scene(UNLIKE)):
        g = rng.uniform(-0.9, 0.9, 50) * scene.resistance_extrema().M[0]
        q = rng.uniform(-0.3, 0.3, 50) * scene.mu
        s = scene.steady(force=g - q, torque=q)
        put_in = s.force * s.V + s.torque * s.omega
        lost = s.loss.slip + s.loss.half_space + s.loss.cylinder
        held = np.isfinite(s.V)
        assert close(lost[held], put_in[held], tol.STEADY_POWER)
        assert (s.loss.slip[held] >= 0.0).all()
        assert close(s.loss.coefficient[held], (lost / abs(s.V))[held], tol.STEADY)
    s = SCENE.steady(force=-0.06, torque=0.1)
    assert close(s.loss.efficiency, 0.6 * s.V / s.omega, tol.STEADY)
    assert (SCENE.steady(torque=0.05).loss.efficiency == 0.0).all()
    assert math.isnan(SCENE.steady().loss.efficiency[0])


# --- the least and the largest numbers ---


def test_eigenvalues_at_the_least_and_largest_numbers():
    """The slope over slip, mu kappa/V, exceeds the square root of the doubles; that over V
    is -T_mean/(1 + j) still.
    """
    scene = series_scene(TWO)
    for each in (scene, ON_BELT):
        known = each.steady(V=1e-8, torque=0.0).eigenvalues[0]
        for V in (1e-18, 1e-153, 1e-290, -1e-308, 5e-324):
            found = each.steady(V=V, torque=0.0)
            assert found.stable.all()
            assert close(found.eigenvalues[0].real.max(), known.real.max(), tol.SLOWEST)
    for j in (1e-300, 1e300):
        found = scene.replace(j=j).steady(V=1e-30, torque=0.0)
        assert found.stable.all()
        exact = -scene.material.T_mean / (1.0 + j)
        assert close(found.eigenvalues[0].real.max(), exact, tol.SLOWEST)
