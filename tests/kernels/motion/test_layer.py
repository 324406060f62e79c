"""The boundary layer behind the onset of stick: against the printed equations, and what it spares."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import tolerances as tol
from closeness import close
from scipy.integrate import solve_ivp

import viscoroll as vr
from viscoroll.kernels.motion.collocation import INTEGRAL, N
from viscoroll.kernels.motion.layer import layer_node, layer_solve, manifold, slow_creep
from viscoroll.kernels.motion.partial_slip import stiff_rates
from viscoroll.kernels.motion.path import D_TAU, D_TURN, D_X, D_Y, Y
from viscoroll.kernels.motion.slow import workspace
from viscoroll.presets import PAPER_STARTS
from viscoroll.scene import kernel_scene
from viscoroll.validation.direct_motion import roll_direct

pytestmark = pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")  # the paper's own scene is beyond the model

PAPER = vr.PAPER_SECTION_5_ROUNDED


def layer_times(scene: vr.Scene, start: tuple[float, float], count: int) -> np.ndarray:
    """Times from stick onset over twelve e-folds of omega - V."""
    motion = vr.roll(scene, *start, [1e-2], rtol=1e-12)
    V = vr.roll(scene, *start, [motion.onset_time], rtol=1e-12).V[0]
    rate = scene.gamma * (1.0 + 1.0 / scene.j) * 4.0 * scene.kappa / abs(V)
    return motion.onset_time + np.geomspace(0.02, 12.0, count) / rate


@pytest.mark.parametrize("ic", PAPER_STARTS)
def test_outputs_inside_the_layer(ic):
    """V, omega and the creep ratio between onset and the slow manifold, by scipy on the printed equations."""
    t = layer_times(PAPER, PAPER_STARTS[ic], 15)
    exact = roll_direct(PAPER, *PAPER_STARTS[ic], t)
    motion = vr.roll(PAPER, *PAPER_STARTS[ic], t, rtol=1e-10)
    assert close(motion.V, exact.V, rel=tol.DIRECT_MOTION)
    assert close(motion.omega, exact.omega, rel=tol.DIRECT_MOTION)
    assert close(motion.delta, exact.omega / exact.V - 1.0, rel=tol.DIRECT_MOTION, scale=1.0)


@pytest.mark.parametrize("ic", PAPER_STARTS)
def test_outputs_do_not_move_the_motion(ic):
    """Where outputs fall inside the layer has no say in what comes after it, nor in how few steps it takes."""
    start, end = PAPER_STARTS[ic], 2e-3
    inside = layer_times(PAPER, start, 40)
    many = vr.roll(PAPER, *start, [*inside, end])
    assert many.V[-1] == vr.roll(PAPER, *start, [end]).V[0]
    # an explicit method's are at most three e-folds long: sixteen e-folds to 1e-7 and their start took 20
    before, behind = (vr.roll(PAPER, *start, [when], rtol=1e-6).steps for when in inside[[0, -1]])
    assert behind - before <= 12


@pytest.mark.parametrize("ic", PAPER_STARTS)
def test_outputs_on_the_onset_and_just_behind(ic):
    """Graded nodes have no slope at the left end, where a time is looked for."""
    for rtol in (1e-6, 1e-12):
        onset = vr.roll(PAPER, *PAPER_STARTS[ic], [1e-3], rtol=rtol).onset_time
        t = onset * (1.0 + np.array([0.0, 2e-16, 1e-15, 1e-13, 1e-11, 1e-9, 1e-2]))
        motion = vr.roll(PAPER, *PAPER_STARTS[ic], t, rtol=rtol)
        # the speeds change by a few thousandths a per cent of the time, so not at all over 1e-9 of it
        assert close(motion.V[:6], motion.V[0], rel=1e-8)
        assert close(motion.omega[:6], motion.omega[0], rel=1e-8)
        assert np.all(np.isfinite([motion.delta, motion.x]))


def test_a_layer_from_inside_partial_slip():
    """Starts with delta of either sign, one that reaches delta = 0 soon and one on it."""
    star = vr.contact(PAPER, 1.0, delta=0.0, fields="delta_star").delta_star
    t = np.array([1e-6, 3e-6, 1e-5, 4e-4])
    for share in (-0.9, 0.0, 0.1, 0.9):
        exact = roll_direct(PAPER, 1.0, 1.0 + share * star, t)
        motion = vr.roll(PAPER, 1.0, 1.0 + share * star, t, rtol=1e-10)
        assert close(motion.V, exact.V, rel=tol.DIRECT_MOTION)
        assert close(motion.omega, exact.omega, rel=tol.DIRECT_MOTION)


def test_rest_inside_the_layer():
    """A threshold that is passed within the layer is located there."""
    t = layer_times(PAPER, PAPER_STARTS["IC1"], 3)
    passed = vr.roll(PAPER, *PAPER_STARTS["IC1"], [t[1]], rtol=1e-10)
    threshold = max(abs(passed.V[0]), abs(passed.omega[0]))
    rested = vr.roll(PAPER, *PAPER_STARTS["IC1"], [1e-2], rtol=1e-10, rest=threshold)
    assert close(rested.rest_time, t[1], rel=1e-8)


def test_distance_is_integrated_from_what_substitution_ends_with():
    """A layer from delta = 0: where substitution gains a million a time, its last change was 10 rtol of V.

    V(t) from the same motion; the distance is its integral by Gauss's rule over the first hundredth of the layer.
    """
    scene = vr.Scene(4164.88, 5.6216, 1.5713, 484343.0)
    end, V0 = 1.7e-8, -0.30878
    node, weight = np.polynomial.legendre.leggauss(30)
    motion = vr.roll(scene, V0, V0, np.append(0.5 * end * (1.0 + node), end), rtol=1e-12)
    way = 0.5 * end * weight @ motion.V[:-1]
    assert close(motion.x[-1], way, rel=1e-12)
    assert motion.steps < 20  # what was left of it looked like an error of the panel: 57


def around(y: float, D: float) -> tuple[Any, Any, float]:
    """Scene, arrays that hold the manifold around (y, D), and the distance of D from it."""
    scene, work = kernel_scene(11.0, 2.91, 0.2, 0.5), workspace.py_func()
    for array in work:
        array.fill(0.0)
    assert manifold(y, D, 1e-12, scene, work)
    return scene, work, D - slow_creep(y, work.slow)[0]


@pytest.mark.parametrize("D", [1.0, -1.0])
def test_a_panel_takes_the_time_in_which_the_distance_falls(D):
    """Two e-folds: (y, D) integrated in time for as long as the panel says are where it ends.

    Where panels fail, steps in time go through the layer: that is right, too, and only takes longer.
    """
    y, folds = np.log(2.0), 2.0
    scene, work, e = around(y, D)
    nodes, sign = work.nodes, np.sign(D)
    nodes[Y, 0] = y
    layer_node(0, e, 1.0, nodes, work.slow, scene)
    assert layer_solve(e, folds, 1, False, 1e-12, scene, work) == folds
    tau = 0.5 * folds * INTEGRAL @ nodes[D_TAU, 1:]
    exact = solve_ivp(
        lambda _, u: stiff_rates(*u, sign, scene)[:2], (0.0, tau), [y, D], "DOP853", rtol=1e-12, atol=1e-13
    )
    y_end, D_end = exact.y[:, -1]
    assert close(nodes[Y, N], y_end, rel=tol.LAYER_PANEL, scale=1.0)
    assert close(e * np.exp(-folds), D_end - slow_creep(y_end, work.slow)[0], rel=tol.LAYER_PANEL)


@pytest.mark.parametrize("D", [1.0, -1.0])
def test_slopes_over_e_folds_next_to_the_manifold(D):
    """All is linear in a small distance: it falls at one pace, while the rest goes at the rates on the manifold."""
    y = np.log(2.0)
    scene, work, e = around(y, D)
    nodes, (S, slope) = work.nodes, slow_creep(y, work.slow)
    (rise, fall), (back, drop) = (stiff_rates(y, S + h, np.sign(S), scene)[:2] for h in (1e-4, -1e-4))
    pace = -(fall - drop - slope * (rise - back)) / 2e-4
    dy, _, V, delta, _, _ = stiff_rates(y, S, np.sign(S), scene)
    for share in (1e-4, 1e-6, 1e-8, 1e-12):  # below 3e-7 of zeta rounding would spoil a difference of rates
        nodes[Y, 1] = y
        layer_node(1, share * e, 1.0, nodes, work.slow, scene)
        m = 1.0 / nodes[D_TAU, 1]
        assert close(m, pace, rel=tol.LAYER_LINEAR * (share + 1e-5))
        found = nodes[[D_Y, D_X, D_TURN], 1] * m
        assert close(found, [dy, V, V * delta], rel=tol.LAYER_LINEAR * (share + 1e-12))
