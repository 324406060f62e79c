"""The bound law: the digits of contact() to Python, to jitted code and to C, in all regimes and
from many threads.
"""

import ctypes
import pickle
import runpy

import numba
import numpy as np
import pytest
import scipy
from calls import COVER

import viscoroll as vr
from viscoroll.kernels.records import LoadsAndSlopes

SERIES = vr.Prony([1.0, 2.0, 3.0], [1.0, 0.1, 0.01])
MATERIALS = {
    "alpha": {"alpha": 11.0},
    "alpha 1": {"alpha": 1.0},
    "series": {"material": SERIES},
    "series in slow time": {"material": SERIES.slower(300.0)},
    "no modes": {"material": vr.Prony.elastic()},
    "like bodies": {"material": vr.Bodies(SERIES, SERIES)},
    "on an elastic base": {"material": vr.Bodies(SERIES, vr.Prony.elastic(), 0.8)},
    "elastic bodies": {"material": vr.Bodies(vr.Prony.elastic(), vr.Prony.elastic(), 0.3)},
    "a cover": {"material": COVER, "coupled": False},
}
#: what the C function writes
NUMBERS = ctypes.c_double * len(LoadsAndSlopes._fields)
BAD = [(np.nan, 0.1), (0.1, np.nan), (np.inf, 0.1), (0.1, -np.inf), (1e299, 1e299)]


@pytest.fixture(scope="module", params=MATERIALS)
def law(request):
    return vr.Scene(kappa=50.0, mu=0.2, **MATERIALS[request.param]).law()


def states(scene):
    """(V, omega) of full slip, of slight and of nearly full slip, free rolling and rest, from
    1e-200 to 1e200.
    """
    V = np.array([1e-200, 1e-20, 1e-6, 3e-3, 0.07, 0.3, 4.0, 1e4, 1e160, 1e200])
    V = np.concatenate([V, -V])
    delta_star = scene.contact(V, delta=0.0).delta_star
    share = np.array([[0.0], [1e-9], [0.02], [0.3], [0.8], [0.9999], [1.0], [3.0]])
    omega = V * (1.0 + np.concatenate([share, -share]) * delta_star)
    more = [0.3, -0.3, 0.0, 0.0, -0.0, 0.0], [0.0, 0.4, 0.2, -0.2, 0.2, 0.0]
    return np.append(np.broadcast_to(V, omega.shape), more[0]), np.append(omega, more[1])


def bits(values):
    return np.array(values, dtype=np.float64).view(np.int64).tolist()


@numba.njit
def called(law, V, omega):
    return law(V, omega)


def test_law_is_contact_to_the_bit(law):
    """Of arrays, of numbers, in jitted code and in C."""
    function, scene = law.ctypes
    out = NUMBERS()
    V, omega = states(law.scene)
    state = law.scene.contact(V, omega=omega, fields=LoadsAndSlopes._fields)
    known = np.array([state[name] for name in LoadsAndSlopes._fields])
    found = law(V, omega, slopes=True)
    assert bits(found) == bits(known)
    for V_n, omega_n, of_n in zip(V.tolist(), omega.tolist(), known.T):
        each = V_n, omega_n
        expected = bits(of_n)
        assert bits(law(*each, slopes=True)) == expected, each
        assert bits(law(*each)) == expected[:4]
        assert bits(called(law.jitted, *each)) == bits(law.jitted(*each)) == expected
        assert function(*each, out, scene) == 0
        assert bits(out) == expected
    # a user's function is compiled once for all laws of half-spaces, and once for those of covers
    assert len(called.signatures) <= 1 + (law.scene.cover is not None)
    assert law(V[:2, None], omega[None, :3]).Q.shape == (2, 3)


def test_what_is_no_number_is_an_error_or_nan(law):
    function, scene = law.ctypes
    out = NUMBERS()
    for V, omega in BAD:
        with pytest.raises(vr.ParameterError):
            law(V, omega)
        with pytest.raises(vr.ParameterError):
            law(np.array([V, V]), omega)
        out[:] = [0.0] * len(out)
        assert function(V, omega, out, scene) != 0
        assert np.isnan(out[:]).all()
        assert np.isnan(called(law.jitted, V, omega)).all()


def test_scipy_takes_the_c_function(law):
    found = scipy.LowLevelCallable(*law.ctypes)
    assert found.signature == "int (double, double, double *, void *)"
    function, scene = law.ctypes
    assert (ctypes.cast(function, ctypes.c_void_p).value, scene.value) == law.address
    assert law.scene.replace(mu=0.3).law().address[0] == law.address[0]  # one function for all


def test_a_law_lasts_as_long_as_somebody_holds_a_part_of_it():
    scene = vr.Scene(kappa=50.0, mu=0.2, material=SERIES.slower(1.7))
    expected = scene.law()(0.3, 0.3001)
    function, data = scene.law().ctypes
    jitted = scene.law().jitted
    out = NUMBERS()
    others = [scene.replace(mu=mu, material=SERIES.slower(mu)).law() for mu in (0.3, 0.4)]
    function(0.3, 0.3001, out, data)
    assert tuple(out[:4]) == jitted(0.3, 0.3001)[:4] == expected
    assert others[0](0.3, 0.3001) != expected


@pytest.mark.filterwarnings(
    "ignore::numba.core.errors.NumbaWarning"
)  # numba says that it cannot cache the function
def test_jitted_code_with_a_law_inside_is_not_cached(tmp_path):
    """Addresses are those of a process: numba would serve them to the next.  What holds no law is
    cached beside it.
    """
    (tmp_path / "user.py").write_text(
        """\
import numba, viscoroll as vr
law = vr.law(vr.Scene(alpha=7.0, kappa=50.0, mu=0.2)).jitted
@numba.njit(cache=True)
def traction(V, omega):
    return law(V, omega).Q
@numba.njit(cache=True)
def slip(V, omega):
    return omega - V
"""
    )
    first, second = (runpy.run_path(str(tmp_path / "user.py")) for _ in range(2))
    assert first["traction"](0.3, 0.3001) == second["traction"](0.3, 0.3001)
    assert first["slip"](0.25, 0.5) == second["slip"](0.25, 0.5) == 0.25
    assert not second["traction"].stats.cache_hits
    assert len(second["slip"].stats.cache_hits) == 1
    assert {path.name.split("-")[0] for path in tmp_path.rglob("*.nb[ci]")} == {"user.slip"}


def test_a_pickled_law_binds_anew(law):
    again = pickle.loads(pickle.dumps(law))
    assert again.scene == law.scene
    assert again(0.3, 0.3001, slopes=True) == law(0.3, 0.3001, slopes=True)
    with pytest.raises(TypeError, match="bind it there"):
        pickle.dumps(law.jitted)
