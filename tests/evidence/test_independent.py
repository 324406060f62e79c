"""Against implementations that nobody here wrote; each deviation as large as its own error explains."""

from __future__ import annotations

import json

import numpy as np
import pytest
import tolerances as tol
from closeness import close
from places import RESULTS
from processes import made

from pipeline.evidence.prove import independent


def worst(off: dict[str, np.ndarray]) -> dict[str, float]:
    return {name: float(np.max(abs(values))) for name, values in off.items()}


def test_wang_and_knothe():
    """Given Q/mu, the creep lies 0.5-1.7 % above the tabulated one, in the elastic cases too: a grid error."""
    off = independent.wang_knothe()
    low, high = tol.WANG_KNOTHE_CREEP
    for name, cases in (("creep, relative", 6), ("creep, relative, elastic", 2)):
        assert off[name].size == cases
        assert np.all((low <= off[name]) & (off[name] <= high))
    assert worst(off)["p_max, relative"] <= tol.WANG_KNOTHE_PEAK
    assert worst(off)["width, cells"] <= tol.WANG_KNOTHE_CELLS
    assert worst(off)["width of the stick zone, cells"] <= tol.WANG_KNOTHE_CELLS


def test_half_space_code():
    off = independent.half_space()
    assert off["Q/μ, absolute"].size == 114
    found = worst(off)
    assert found["Q/μ, absolute"] <= tol.HALF_SPACE_Q
    assert found["λ, absolute"] <= tol.HALF_SPACE_LENGTH
    assert found["ε, absolute"] <= tol.HALF_SPACE_SHIFT
    assert found["β, absolute"] <= tol.HALF_SPACE_STICK
    assert found["M, relative, κV up to 2"] <= tol.HALF_SPACE_MOMENT_SLOW
    assert found["M, relative, κV up to 20"] <= tol.HALF_SPACE_MOMENT
    assert found["full slip, decided otherwise"] == 0.0


def test_deviations_of_the_half_space_code_are_its_own():
    """Where the law is Carter's, in closed form, the code is off by no less in Q and lam."""
    found = worst(independent.half_space())
    for name in ("Q/μ, absolute", "λ, absolute"):
        assert found[f"{name}, elastic"] == found[name]


def test_profiles_of_the_half_space_code():
    off = independent.profiles()
    p, tau = off["p, over its peak"], off["τ, over μ times the peak of p"]
    assert tau.size == 555
    assert abs(p).max() <= tol.HALF_SPACE_CODE_P
    assert abs(tau).max() <= tol.HALF_SPACE_CODE_TAU
    assert np.sqrt(np.mean(tau**2)) <= tol.HALF_SPACE_CODE_TAU_RMS


@pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")  # the paper's own scene is beyond the model
def test_implicit_integration():
    found = worst(independent.section_5())
    assert found["V, relative"] <= tol.SECTION_5_SPEED
    assert found["ω, over V"] <= tol.SECTION_5_SPEED
    assert found["onset time, relative"] <= tol.SECTION_5_ONSET


def test_committed_deviations_are_those_found_now(tmp_path):
    made("evidence.prove.independent", "-o", tmp_path / "independent.json")
    now = json.loads((tmp_path / "independent.json").read_text(encoding="utf-8"))
    committed = json.loads((RESULTS / "independent.json").read_text(encoding="utf-8"))
    for mine, theirs in zip(now["deviations"], committed["deviations"], strict=True):
        assert (mine["source"], mine["quantity"], mine["values"]) == tuple(
            theirs[k] for k in ("source", "quantity", "values")
        )
        assert close(mine["worst"], theirs["worst"], rel=tol.COMMITTED, scale=tol.STRESS_ELLIPSE / tol.COMMITTED)
    assert [row["here"] for row in now["paper"]] == [row["here"] for row in committed["paper"]]
