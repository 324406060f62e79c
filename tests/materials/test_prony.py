"""Materials of several relaxation times: both forms of a series, its functions, and what rolls on
it.
"""

import numpy as np
import pytest
import tolerances as tol
from closeness import close
from hypothesis import given, settings
from hypothesis import strategies as st
from many import UNLIKE

import viscoroll as vr

WIDE = vr.Prony([0.5, 3.0, 8.0, 20.0], [1.0, 3e-2, 4e-5, 1e-9])
#: random series: modes, decades that their times span, size of the strengths
SERIES = st.tuples(
    st.integers(1, 12), st.floats(0.01, 14.0), st.floats(-3.0, 3.0), st.integers(0, 2**32 - 1)
)


def random_series(modes, decades, size, seed):
    draw = np.random.default_rng(seed)
    return vr.Prony(
        10.0 ** draw.uniform(size - 2.0, size, modes), 10.0 ** draw.uniform(-decades, 0.0, modes)
    )


# --- the two forms ---


@settings(max_examples=60, deadline=None)
@given(SERIES)
def test_forms_belong_together(drawn):
    """Times interlace, and creep gives relaxation back."""
    p = random_series(*drawn)
    m = p.modes
    assert (m.b < m.a).all()
    assert (m.a[:-1] < m.b[1:]).all()
    assert close(p.T_mean, (m.J / m.b).sum(), tol.SERIES_FORMS)
    back = vr.Prony.creep(m.J, 1.0 / m.b, alpha=p.alpha)
    assert close(back.tau, p.tau, tol.SERIES_FORMS)
    # rounding of the rates, over the relative distance of the closest two of both forms
    rates = np.sort(np.concatenate([m.a, m.b]))
    closest = min(1.0, (np.diff(rates) / rates[:-1]).min())
    assert close(back.E, p.E, tol.SERIES_BACK / closest)


def scene(material):
    return vr.Scene(material=material, kappa=10.0, mu=0.3)


@pytest.mark.parametrize("unit", [2.0**40, 3.7e-9])
def test_the_unit_of_time_is_free(unit):
    """T_ref times 1/unit: V in R/T_ref changes, nothing physical does."""
    far = WIDE.slower(unit)
    V = np.geomspace(1e-3, 1e9, 40)
    here = scene(WIDE).contact(V, delta=1e-3, slopes=True)
    there = scene(far).contact(V / unit, delta=1e-3, slopes=True)
    for name in ("lam", "epsilon", "delta_star", "beta", "Q", "M"):
        assert close(there[name], here[name], tol.UNIT)
    for name in ("zeta", "dQ_domega"):
        assert close(there[name] / unit, here[name], tol.UNIT)
    assert close(there.dM_dV / unit, here.dM_dV, tol.UNIT, scale=here.M / V)
    assert close(there.dQ_dV / unit, here.dQ_dV, tol.SERIES_SLOPE, scale=0.3 / V)


# --- two bodies ---


PARTS = ("M_half_space", "M_cylinder")


def test_slopes_of_the_parts_of_M():
    """Against differences (that of M, and the parts themselves, are claims of test_claims.py); at
    V = 0 the slow limit.
    """
    V = np.geomspace(1e-5, 1e7, 40)
    slopes = scene(UNLIKE).contact(V, delta=0.0, slopes=True)
    step = 1e-4 * V
    above, below = (
        scene(UNLIKE).contact(at, delta=0.0, fields=PARTS) for at in (V + step, V - step)
    )
    for name in PARTS:
        size = abs(slopes[name]) / V
        difference = (above[name] - below[name]) / (2.0 * step)
        assert close(slopes[f"d{name}_dV"], difference, tol.BODIES_DIFFERENCE, scale=size)
    rest = scene(UNLIKE).contact(0.0, delta=0.0, slopes=True)
    half_space = 0.7 * UNLIKE.base.T_mean
    cylinder = 0.3 * UNLIKE.cylinder.T_mean
    assert close((rest.dM_half_space_dV, rest.dM_cylinder_dV), (half_space, cylinder), tol.BODIES)


@pytest.mark.parametrize("law", [WIDE, UNLIKE])
def test_the_fastest_rolling(law):
    """Where z^2 underflows: epsilon, M and its parts go on as the logarithm says."""
    V = np.array([1e130, 1e150, 1e200, 1e290])
    series = law.total if isinstance(law, vr.Bodies) else law
    state = scene(law).contact(V, delta=0.0)
    z = np.sqrt(1.0 / series.alpha) / (20.0 * V)
    strengths = series.J / series.T
    terms = strengths.sum() * (-np.log(z) - np.euler_gamma) + strengths @ np.log(2.0 * series.T)
    rise = 0.5 * series.alpha * z
    assert close(state.epsilon, rise * terms, tol.BODIES)
    assert close(state.M, V * z * rise * (terms + 0.25 * strengths.sum()), tol.BODIES)
    if law is UNLIKE:
        assert close(state.M_half_space + state.M_cylinder, state.M, tol.BODIES)


# --- motions ---


def test_slip_is_lost_and_regained_in_two_bands():
    """M(V) has two humps (E = 2, 6, tau = 1, 1e-5): stick goes twice, where the condition of each
    says.
    """
    two = vr.Scene(material=vr.Prony([2.0, 6.0], [1.0, 1e-5]), kappa=10.0, mu=1.39e-3, gamma=1.0)
    motion = two.roll(5000.0, 5000.0, np.geomspace(1.0, 1e9, 50))
    assert [switch.regime for switch in motion.switches[:3]] == [
        "full slip",
        "partial slip",
        "full slip",
    ]
    V = [motion.at([switch.t]).V.item() for switch in motion.switches[:3]]
    assert close(V, [1264.0, 804.0, 0.0840], tol.SERIES_BANDS)
