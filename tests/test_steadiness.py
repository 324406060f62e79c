"""How far the law of steady rolling drives a motion: the unsteadiness, speeds down to which it is
small, warnings.
"""

from itertools import pairwise

import numpy as np
import pytest
import tolerances as tol
from calls import ONE
from closeness import close
from drives import DMA
from drives import ON_DMA as ROLLER
from scipy.integrate import quad
from scipy.optimize import brentq

import viscoroll as vr

UNLIKE = ROLLER.replace(material=vr.Bodies(DMA, vr.Prony([4.0], [3e-3]), 0.3))


def law(scene, V):
    """gamma N/(1 + j) and gamma M/(1 + j)."""
    c = scene.contact(V, delta=0.0, fields=("N", "M"))
    g = scene.gamma / (1.0 + scene.j)
    return g * c.N, g * c.M


def over(scene, low, high, f):
    """Integral of f(V, braking) from one speed to another, over ln V."""
    ends = np.linspace(np.log(low), np.log(high), 25)
    parts = (
        quad(lambda s: np.exp(s) * f(np.exp(s), law(scene, np.exp(s))[1]), a, b, epsrel=1e-10)[0]
        for a, b in pairwise(ends)
    )
    return sum(parts)


@pytest.mark.parametrize("scene, V", [(ROLLER, 30.0), (ONE, 3.0), (UNLIKE, 20.0)])
def test_by_quadrature_of_N_and_M(scene, V):
    """The unsteadiness, the speeds at which it is 1 % and 10 %, time and way until there and the
    way left.
    """
    found = scene.validity(-V).steady
    assert close(found.value, abs(law(scene, V)[0]), tol.STEADINESS)
    rest = over(scene, 1e-9, V, lambda V, brake: V / brake)
    assert close(found.whole, rest, tol.STEADINESS)
    for reach, level in ((found.one_percent, 0.01), (found.ten_percent, 0.1)):
        grid = np.geomspace(1e-4 * V, V, 2000)
        top = grid[np.flatnonzero(abs(law(scene, grid)[0]) >= level)[-1]]
        speed = brentq(lambda V, level=level: law(scene, V)[0] - level, top, 1.01 * top, rtol=1e-14)
        assert close(reach.speed, speed, tol.STEADINESS)
        assert close(
            reach.time, over(scene, speed, V, lambda V, brake: 1.0 / brake), tol.STEADINESS
        )
        assert close(
            reach.distance, over(scene, speed, V, lambda V, brake: V / brake), tol.STEADINESS
        )
        assert close(reach.distance + reach.left, rest, tol.STEADINESS)
    assert close(found.share, found.ten_percent.left / rest, tol.STEADINESS)


@pytest.mark.parametrize("V", [30.0, 5.0])
def test_a_start_from_rest_costs_an_energy(V):
    """W in closed form; the speed that is left, and the way from it."""
    J = DMA.J
    T = DMA.T
    u = ROLLER.kappa * V
    g = ROLLER.gamma / 1.5
    found = ROLLER.validity(V).steady
    L = np.minimum(2.0 * u * T, 4.84 * max(2.0 * ROLLER.kappa * found.whole, 20.0))
    W = (0.25 * J * np.log(1.0 + (0.681 * L) ** 2)).sum() - np.log(DMA.alpha) / (8.0 * DMA.alpha)
    left = np.sqrt(V * V - 0.5 * g * W / ROLLER.kappa**2)
    assert close(found.start.speed, V - left, tol.STEADINESS)
    assert close(
        found.start.distance, found.whole - ROLLER.validity(left).steady.whole, tol.STEADINESS
    )


def test_no_relaxation_time_bounds_it():
    """Of any material |N| (kappa V)^2 <= 1.35/16 (1 - 1/alpha); modes that are slower change
    nothing much.
    """
    draw = np.random.default_rng(1)
    some = vr.Prony(10.0 ** draw.uniform(-2, 2, (20, 4)), 10.0 ** draw.uniform(-6, 2, (20, 4)))
    for material in (
        *(vr.Prony([alpha - 1.0], [1.0 / alpha]) for alpha in (1.05, 11.0, 100.0, 1e4)),
        *some,
    ):
        V = np.geomspace(1e-3 / material.T[0], 1e3 / material.T[-1], 300)
        N = abs(law(vr.Scene(material=material, kappa=1.0, mu=0.5, gamma=1.5), V)[0])
        assert (N * V * V).max() <= tol.STEADINESS_BOUND * (1.0 - 1.0 / material.alpha)
    years = vr.Prony([0.1, 0.1, *DMA.E], [1e4, 1e2, *DMA.tau])
    found, known = (ROLLER.replace(material=each).validity(30.0).steady for each in (years, DMA))
    assert close(found.ten_percent.speed, known.ten_percent.speed, 0.1)


# --- warnings of roll and ensemble ---


@pytest.mark.filterwarnings(
    "ignore::viscoroll.ModelWarning"
)  # the motion is beyond the model on purpose
def test_a_motion_is_judged_between_its_output_times():
    """A slow roller of a DMA rubber on steel: one output time at rest gives the report of 601,
    failures and share.
    """
    rubber = vr.fit_prony(*vr.read_dma(vr.datasets.path("dma.csv"))).material(nu=0.49)
    roller = vr.Cylinder(R=0.03, m=5.0, material=rubber, base=vr.Material.rigid(), load=2e3, mu=0.8)
    few, many = (
        roller.roll(0.4, 13.0, t, rest=1e-3).validity() for t in (60.0, np.linspace(0.0, 60.0, 601))
    )
    assert "steady" in few.failed
    assert few.failed == many.failed
    assert few.steady.holds.shape == (1,)
    assert few.steady.value[-1] >= 0.9 * many.steady.value[-1]
    assert close(few.steady.share, many.steady.share, 0.01, scale=1.0)
