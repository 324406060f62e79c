"""The examples of the bound law run, and their physics is that of the package."""

import runpy

import numpy as np
import tolerances as tol
from closeness import close
from places import ROOT

import viscoroll as vr


def example(name):
    return runpy.run_path(str(ROOT / f"docs/examples/{name}.py"))


def test_solve_ivp_is_roll(capsys):
    found = example("law_solve_ivp")
    m = vr.roll(vr.presets.RUBBER_ROLLER, 0.5, 0.0, found["t"], rtol=1e-11)
    assert found["found"].success
    assert close(found["V"], m.V, tol.EXAMPLE_RADAU, scale=1.0)
    assert close(found["omega"], m.omega, tol.EXAMPLE_RADAU, scale=1.0)
    assert "V = 0.044252, omega = 0.044252" in capsys.readouterr().out


def test_a_users_loop_is_roll_to_its_first_order():
    found = example("law_njit")
    scene = vr.presets.RUBBER_ROLLER
    t = 0.05
    h = 1e-5
    m = vr.roll(scene, 0.5, 0.5, t, force=0.01, rtol=1e-10)
    off = []
    for step in (2.0 * h, h):
        force = np.full(round(t / step), 0.01)
        last = found["rolled"](found["law"], scene.gamma, scene.j, 0.5, 0.5, force, step)[-1]
        off.append(np.abs(last - [m.V[-1], m.omega[-1]]).max())
    assert off[1] < tol.EXAMPLE_EULER
    assert close(off[0] / off[1], 2.0, tol.EXAMPLE_ORDER)


def test_every_rope_carries_the_resistance_behind_it():
    found = example("law_multibody")
    M = [vr.contact(found[name], 0.5, delta=0.0).M for name in ("warm", "cold")]
    force = found["stiffness"] * found["stretch"]
    assert close(force, [sum(M), M[1]], tol.EXAMPLE_TRAIN)
    assert close(found["V"], 0.5, tol.EXAMPLE_TRAIN)
    # the Jacobian is that of the rates
    y = np.array([0.01, 0.02, 0.3, 0.4, 0.301, 0.4002])
    J = found["jacobian"](0.0, y)
    for n, size in enumerate(y):
        step = 1e-6 * size * np.eye(y.size)[n]
        difference = (found["rates"](0.0, y + step) - found["rates"](0.0, y - step)) / (2e-6 * size)
        assert close(J[:, n], difference, tol.EXAMPLE_JACOBIAN, scale=1.0)
