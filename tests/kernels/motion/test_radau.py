"""Partial slip where the slow manifold is not far below: in time; and where there is none, at alpha = 1."""

from __future__ import annotations

import numpy as np
import pytest
import tolerances as tol
from closeness import close
from scipy.integrate import quad

import viscoroll as vr
from viscoroll.kernels.motion.collocation import SLOPES
from viscoroll.kernels.motion.radau import radau_solve, radau_start
from viscoroll.kernels.motion.slow import slow_solve, slow_start, workspace
from viscoroll.scene import kernel_scene
from viscoroll.validation.direct_motion import roll_direct

pytestmark = pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")  # the paper's own scene is beyond the model

PAPER = vr.PAPER_SECTION_5_ROUNDED
#: little stiffness: omega - V relaxes hardly faster than V decays
SOFT = vr.Scene(alpha=7.1, kappa=0.54, mu=0.08, gamma=1.0, j=1.67)


@pytest.mark.parametrize("start", [0.9, 0.5])
def test_creep_at_alpha_1(start):
    """Partial slip without rolling resistance against one quadrature."""
    scene = vr.Scene(alpha=1.0, kappa=2.0, mu=0.4, gamma=1.0, j=0.7)
    widest = scene.mu / (2.0 * scene.kappa)
    V0 = 1.3
    momentum = V0 * (1.0 + scene.j + scene.j * widest * start)

    def per_share(s: float) -> float:
        """-dt/ds: V = momentum/(1 + j + j widest s), V' = mu s (2 - s)."""
        whole = 1.0 + scene.j + scene.j * widest * s
        return momentum * scene.j * widest / (whole * whole * scene.mu * s * (2.0 - s))

    shares = start * np.array([0.9, 0.5, 0.1, 1e-3])
    t = [quad(per_share, s, start, epsabs=0.0, epsrel=1e-13, limit=200)[0] for s in shares]
    motion = vr.roll(scene, V0, V0 * (1.0 + widest * start), t, rtol=1e-10)
    V = momentum / (1.0 + scene.j + scene.j * widest * shares)
    assert close(motion.V, V, rel=tol.DIRECT_MOTION)
    assert close(motion.delta, widest * shares, rel=tol.DIRECT_MOTION, scale=1.0)
    assert close(motion.x + scene.j * motion.angle, momentum * motion.t, rel=tol.DIRECT_MOTION)


@pytest.mark.parametrize("end", [1e3, 1e55, 1e150])
def test_alpha_1_for_ever(end):
    """A start in full slip: V + j omega stays, both speeds become one."""
    scene = PAPER.replace(alpha=1.0)
    motion = vr.roll(scene, 1.0, 0.5, [end], rtol=1e-8)
    assert motion.status == vr.MotionStatus.DONE
    rolling = (1.0 + 0.5 * scene.j) / (1.0 + scene.j)
    assert close(motion.V[0], rolling, rel=tol.MOTION_DEFAULT)
    assert close(motion.omega[0], rolling, rel=tol.MOTION_DEFAULT)
    assert abs(motion.delta[0]) < 1e-300
    assert motion.steps < 60


@pytest.mark.parametrize("share", [-0.9, 0.0, 0.5, 0.9])
def test_a_motion_that_is_hardly_stiff(share):
    """No manifold to follow at first; delta of either sign, one that passes 0."""
    star = vr.contact(SOFT, 0.8, delta=0.0, fields="delta_star").delta_star
    start, t = (0.8, 0.8 * (1.0 + share * star)), np.array([0.01, 0.1, 0.5, 2.0, 8.0])
    exact = roll_direct(SOFT, *start, t)
    motion = vr.roll(SOFT, *start, t, rtol=1e-10)
    assert close(motion.V, exact.V, rel=tol.DIRECT_MOTION)
    assert close(motion.omega, exact.omega, rel=tol.DIRECT_MOTION)


@pytest.mark.parametrize("rtol", [1e-6, 1e-10, 1e-12])
def test_rest_of_a_motion_that_is_hardly_stiff(rtol):
    """A threshold is located on whatever panel it falls."""
    t = np.array([0.05, 0.5, 2.0])
    passed = vr.roll(SOFT, 0.8, 0.7, t, rtol=1e-12)
    for when, threshold in zip(t, np.maximum(passed.V, passed.omega), strict=True):
        rested = vr.roll(SOFT, 0.8, 0.7, [10.0], rtol=rtol, rest=threshold)
        assert close(rested.rest_time, when, rel=tol.MOTION_RTOL * rtol)


@pytest.mark.parametrize(
    ("parameters", "start"),
    [
        ((7.1, 5.8, 0.25, 1.9), (0.4, 1.7)),
        ((602.0, 9.0, 0.081, 1.5), (1.2, -0.4)),
        ((2.0, 2.15, 0.38, 1.9), (1.0, 0.3)),
    ],
)
def test_the_layer_ends_on_the_manifold(parameters, start):
    """At a tight tolerance, too, one leads to the other: steps between the two took 15 to 40 more."""
    alpha, kappa, mu, j = parameters
    scene = vr.Scene(alpha=alpha, kappa=kappa, mu=mu, gamma=1.0, j=j)
    loose, tight = (vr.roll(scene, *start, [50.0], rtol=rtol).steps for rtol in (1e-6, 1e-10))
    assert tight <= loose + 25


@pytest.mark.parametrize("material", [11.0, np.nan])
def test_what_cannot_be_computed_is_not_solved(material):
    """A NaN among the changes is no small change: on the slow manifold and in time."""
    scene, work, solvable = kernel_scene(material, 2.91, 0.2, 0.5), workspace.py_func(), np.isfinite(material)
    for array in work:
        array.fill(0.0)
    slow_start(1.0, 0.0, work.values, scene)
    assert slow_solve(1.0, 0.5, 1e-8, SLOPES, scene, work) == solvable
    rates = radau_start(1.0, 0.1, 1.0, 1, scene, work.nodes)
    assert radau_solve(1e-4, 1, 1.0, rates, 1e-8, scene, work) == solvable
