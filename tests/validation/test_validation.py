"""The validation finds what is right and what is wrong; its integrator; the stage around it."""

import pytest
import tolerances as tol

import viscoroll as vr
from pipeline.validation import stresses, validate

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


def test_wrong_stress_is_found(monkeypatch):
    def louder(*arguments, **options):
        found = vr.stress(*arguments, **options)
        return type(found)(
            {
                name: values * (1.0 + tol.VALIDATION_WRONG)
                for name, values in found.as_dict().items()
            }
        )

    monkeypatch.setattr(stresses, "stress", louder)
    assert not any(
        check.passed for check in stresses.stress_checks(3, 0) if check.name == "stress: load"
    )
