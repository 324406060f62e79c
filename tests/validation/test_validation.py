"""The validation finds what is right and what is wrong; its integrator; the stage around it."""

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
    validate,
)

pytestmark = pytest.mark.filterwarnings(
    "ignore::viscoroll.ModelWarning"
)  # the paper's own scene is beyond the model

SMALL = {"states": 2000, "stress_states": 3, "table_points": 300, "times": 20}


@pytest.fixture(scope="module")
def law():
    return vr.tables.law(11.0)


@pytest.fixture(scope="module")
def report(law):
    return validate((law,), **SMALL, seed=5)


def test_all_is_well(report):
    assert report.ok, str(report)
    names = [check.name for check in report.checks]
    assert len(set(names)) == len(names)
    for part in (
        "random states: Q",
        "along IC1-IC3: M",
        "stress: load",
        f"{vr.tables.law(11.0).title}: press",
    ):
        assert part in names
    for start in vr.presets.PAPER_STARTS:
        assert f"motion {start}: onset time" in names


def test_text_names_every_check(report):
    text = str(report)
    assert all(check.name in text and check.meaning in text for check in report.checks)
    assert "EXCEEDED" not in text
    bad = Report(
        (Check("one", 2.0, 1.0, "absolute"), Check("lost", np.nan, 1.0, "absolute")), {"seed": 0}
    )
    assert not bad.ok
    assert "2 checks: 2 beyond what is allowed." in str(bad)


def test_sample_holds_every_corner():
    scene, V, delta = random_states(4000, 1)
    s = np.abs(delta) / vr.contact(scene, V, delta=0.0, fields="delta_star").delta_star
    assert (scene.alpha == 1.0).any()
    for low, high in (
        (0.0, 0.0),
        (1e-300, 1e-5),
        (1.0 - 1e-5, 1.0 - 1e-15),
        (1.0, 1.0),
        (1.2, np.inf),
    ):
        assert ((s >= low - 1e-15 * (low == 1.0)) & (s <= high + 1e-15 * (high == 1.0))).any(), low
    assert (V.min(), delta.min()) < (0.0, 0.0) < (V.max(), delta.max())


def test_wrong_stress_is_found(monkeypatch):
    def louder(*arguments, **options):
        found = vr.stress(*arguments, **options)
        return type(found)(
            {
                name: values * (1.0 + tol.VALIDATION_WRONG)
                for name, values in found.as_dict().items()
            }
        )

    monkeypatch.setattr(validation, "stress", louder)
    assert not any(check.passed for check in stress_checks(3, 0) if check.name == "stress: load")


@pytest.mark.parametrize("module", ["states", "motions"])
def test_wrong_scene_is_found(monkeypatch, module):
    """The table method at a slightly other kappa."""

    def other(scene):
        return scene.replace(kappa=np.asarray(scene.kappa) * (1.0 + tol.VALIDATION_WRONG))

    if module == "states":
        right = vr.contact
        monkeypatch.setattr(
            validation,
            "contact",
            lambda scene, *a, **o: right(scene if "method" in o else other(scene), *a, **o),
        )
        assert not all(check.passed for check in random_state_checks(100, 0))
    else:
        monkeypatch.setattr(
            validation, "roll", lambda scene, *a, **o: vr.roll(other(scene), *a, **o)
        )
        assert not any(check.passed for check in motion_checks(10))
