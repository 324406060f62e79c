"""The examples of the bound law run, and their physics is that of the package."""

import runpy

import tolerances as tol
from closeness import close
from places import ROOT

import viscoroll as vr


def example(name):
    return runpy.run_path(str(ROOT / f"docs/examples/{name}.py"))


def test_solve_ivp_is_roll():
    found = example("law_solve_ivp")
    m = vr.presets.RUBBER_ROLLER.roll(0.5, 0.0, found["t"], rtol=1e-11)
    assert found["found"].success
    assert close(found["V"], m.V, tol.EXAMPLE_RADAU, scale=1.0)
    assert close(found["omega"], m.omega, tol.EXAMPLE_RADAU, scale=1.0)


def test_every_rope_carries_the_resistance_behind_it():
    found = example("law_multibody")
    M = [found[name].contact(0.5, delta=0.0).M for name in ("warm", "cold")]
    force = found["stiffness"] * found["stretch"]
    assert close(force, [sum(M), M[1]], tol.EXAMPLE_TRAIN)
    assert close(found["V"], 0.5, tol.EXAMPLE_TRAIN)
