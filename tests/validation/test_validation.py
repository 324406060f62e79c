"""The validation finds what is wrong; that it finds what is right: evidence/test_figures.py."""

import numpy as np
import pytest
import tolerances as tol

import viscoroll as vr
from pipeline import validation
from pipeline.validation import (
    Check,
    Report,
    motion_checks,
    random_state_checks,
    random_states,
    stress_checks,
)

pytestmark = pytest.mark.filterwarnings(
    "ignore::viscoroll.ModelWarning"
)  # the paper's own scene is beyond the model


def test_what_is_exceeded_or_no_number_is_counted():
    checks = Check("one", 2.0, 1.0, "absolute"), Check("lost", np.nan, 1.0, "absolute")
    bad = Report(checks, {"seed": 0})
    assert not bad.ok
    assert "2 checks: 2 with a difference larger than allowed." in str(bad)


def test_sample_holds_every_corner():
    scene, V, delta = random_states(4000, 1)
    s = np.abs(delta) / scene.contact(V, delta=0.0).delta_star
    assert (scene.alpha == 1.0).any()
    edges = [0.0, 5e-324, 1e-5, 1.0 - 1e-5, 1.0 - 1e-15, 1.2, np.inf]
    assert np.histogram(s, edges)[0].all()
    assert (V.min(), delta.min()) < (0.0, 0.0) < (V.max(), delta.max())


@pytest.mark.parametrize(
    "name, checks, some",
    [
        ("contact", lambda: random_state_checks(100, 0), all),
        ("roll", lambda: motion_checks(3), any),
        ("stress", lambda: [c for c in stress_checks(3, 0) if c.name == "stress: load"], any),
    ],
)
def test_wrong_scene_is_found(monkeypatch, name, checks, some):
    """The table method at a slightly other kappa."""
    right = getattr(vr, name)

    def wrong(scene, *arguments, **options):
        if "method" not in options:
            scene = scene.replace(kappa=np.asarray(scene.kappa) * (1.0 + tol.VALIDATION_WRONG))
        return right(scene, *arguments, **options)

    monkeypatch.setattr(validation, name, wrong)
    monkeypatch.setattr(validation, "PAPER_STARTS", {})
    assert not some(check.passed for check in checks())
