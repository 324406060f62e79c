"""Contacts that ask a material for more than was measured of it: a word, once a material, and a
mark in figures.
"""

import warnings
from dataclasses import replace

import numpy as np
import pytest
import tolerances as tol
import xarray as xr
from calls import BELT, MEASURED, pair
from closeness import close
from run_files import run_of
from scipy import stats

import viscoroll as vr
from viscoroll.core.plots import draw
from viscoroll.runs import estimate

DATA = MEASURED.measured
SHIFT = vr.WLF(C1=8.86, C2=101.6, T0=20.0)
#: the speed at which the transit frequency of that contact is 628 1/s, a third of the last
#: frequency of the data
LAST = 2.866


def test_where_the_data_end():
    """Of the same contact, by the law itself: at both ends the transit frequency is at the end of
    its band.
    """
    for at, end in zip(BELT.body_data.measured_rates, DATA.transit_band, strict=True):
        speed = at * BELT.l0
        assert close(
            speed / BELT.contact(speed, delta=0.0, fields="length").length, end, tol.CONTACT
        )
    found = BELT.validity(np.array([0.99, 1.01]) * LAST).measured
    assert found.holds.tolist() == [True, False]


@pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")
@pytest.mark.parametrize(
    "growth, thickness",
    [(0.0, None), (0.12, None), (0.3, None), pytest.param(0.12, 0.01, marks=pytest.mark.long)],
)
def test_data_over_the_band_determine_M(growth, thickness):
    """Rubbers of 15 modes, whose moduli of three decades are fitted: M at both ends of transit_band
    is that of the rubber to a tenth, and nearer a factor of 5 inside; where the data end at the
    transit frequency it is wrong.
    """
    k = np.arange(-6.0, 9.0)
    rubber = vr.Material(1e6, 0.49, vr.Prony(0.05 * 10.0 ** (growth * k), 10.0 ** (-k - 1.0)))
    omega = np.geomspace(1.0, 1e3, 31)
    fit = vr.fit_prony(omega, rubber.storage(omega), rubber.loss(omega)).material(nu=0.49)
    given = {"thickness": thickness, "measured": vr.Measured(1.0, 1e3, 0.0)}
    true, found = (
        pair(vr.Material.rigid(), replace(each, **given), load=1e3, coupled=False)
        for each in (rubber, fit)
    )
    low, high = true.body_data.measured_speeds
    V = np.array([low, 5.0 * low, high / 5.0, high, 3.0 * high])
    # where a cover rolls freely: at delta = 0 its traction is a part of M that the data do not
    # determine less
    moments = [
        each.contact(V, delta=each.contact(V, delta=0.0, fields="delta_0").delta_0).M
        for each in (found, true)
    ]
    error = np.abs(moments[0] / moments[1] - 1.0)
    assert max(error[0], error[3]) < tol.MEASURED_END
    assert max(error[1], error[2]) < tol.MEASURED_INSIDE
    assert error[4] > tol.MEASURED_BEYOND


@pytest.mark.parametrize("thickness", [None, 0.01])
def test_a_series_that_ends_below_the_frequencies_in_the_cold(thickness):
    """It has almost no loss there: a warning where M is far below that of a series with shorter
    times, and none for this one and for data with their own band.
    """

    def M(*series, **more):
        rubber = vr.Material(4e6, 0.49, vr.Prony(*series), thickness=thickness, **more)
        cold = rubber.at(-10.0, SHIFT)
        return pair(vr.Material.rigid(), cold, load=1e3, coupled=False).contact(2.0, delta=0.0).M

    narrow = [1.0, 2.0], [0.1, 1e-3]
    with pytest.warns(vr.ModelWarning, match="M is probably too small"):
        found = M(*narrow)
    warnings.simplefilter("error")
    assert found < 0.5 * M([1.0, 2.0, 4.0, 9.0], [0.1, 1e-3, 1e-5, 1e-7])
    M(*narrow, measured=vr.Measured(1e3, 1e9, 0.0))


@pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")
def test_curves_are_dashed_beyond(here):
    """Over speed, from a file, and over frequency: what is solid and what is dashed meet, and are
    all there is.
    """
    BELT.contact(np.geomspace(0.01, 100.0, 81), delta=0.0, fields="M").to_xarray().to_netcdf("M.nc")
    with xr.open_dataset("M.nc") as stored:
        over_speed = draw(stored)
    for figure, low, high in ((over_speed, 0.0, LAST), (MEASURED.plot(), DATA.low, DATA.high)):
        solid, dashed = figure.axes[0].get_lines()[:2]
        assert dashed.get_linestyle() == "--"
        x = solid.get_xdata()
        seen = np.isfinite(solid.get_ydata())
        beyond = np.isfinite(dashed.get_ydata())
        assert np.array_equal(seen, (x >= low) & (x <= high))
        assert (seen | beyond).all()
        assert np.count_nonzero(seen & beyond) == 1
        assert "dashed: outside the measured frequencies" in figure.get_suptitle()
    assert "dashed" not in replace(MEASURED, measured=None).plot().get_suptitle()


RUN = """
[cylinder]
R = 0.1
m = 30.0
mu = 0.5
[material]
E = inf
nu = 0.5
[base]
E = 2e6
nu = 0.5
prony = { E = [2.0, 6.0], tau = [1e-3, 1e-5] }
measured = { low = 0.06, high = HIGH, misfit = 0.01 }
wlf = { T0 = 20.0, C1 = 8.86, C2 = 101.6 }
temperature = { distribution = "norm", loc = 20.0, scale = 5.0 }
[start]
V0 = { distribution = "uniform", loc = 1.0, scale = 1e-9 }
omega0 = 10.0
[run]
n = 1000
t = [0.01]
method = "integrate"
summaries = ["x"]
"""


def test_the_share_of_motions_that_were_not_measured(tmp_path):
    """N(20, 5) degrees: the contact at 1 m/s needs frequencies that the data hold where a_T is
    below a bound.
    """
    high = 3.0 * BELT.validity(1.0).measured.value * SHIFT(17.0)
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always")
        estimate(run_of(RUN.replace("HIGH", str(high)), tmp_path), 1)
    (said,) = [str(each.message) for each in found if "not measured" in str(each.message)]
    share = float(said.split("%")[0].split()[-1]) / 100.0
    assert close(share, stats.norm(20.0, 5.0).cdf(17.0), tol.SHARE)
