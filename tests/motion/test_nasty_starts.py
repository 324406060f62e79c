"""Starts and scenes on the edges of everything, for both ways of rolling: the flow map and the
integrator.
"""

import math

import numpy as np
import pytest
import tolerances as tol
from maps import decay_time

import viscoroll as vr
from viscoroll.motion.ensembles import FIELDS

SCENE = vr.presets.PAPER_SECTION_5_ROUNDED
#: mu kappa at alpha = 11, j = 1/2 where full slip returns: the maximum over V of kappa M over 6
RETURN = 0.24659784 / 6.0
SCENES = {
    "paper": SCENE,
    "ring": SCENE.replace(j=1.0),
    "heavy rim": SCENE.replace(j=1.9),
    "elastic ring": SCENE.replace(alpha=1.0, j=1.0),
    "next to elastic": SCENE.replace(alpha=1.0 + 2.3e-16),
    **{
        f"return of slip, {excess:+g}": SCENE.replace(mu=(1.0 + excess) * RETURN / SCENE.kappa)
        for excess in (-0.5, -1e-9, 0.0, 2e-3)
    },
}
#: a motion with several changes of regime takes some hundred
STEPS = 2000
# the paper's own scene is beyond the model
pytestmark = [
    pytest.mark.usefixtures("maps_of_this_file"),
    pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning"),
]


def ulps(x, n):
    for _ in range(abs(n)):
        x = math.nextafter(x, n * math.inf)
    return x


def nasty(scene):
    """Starts (V0, omega0): axes, V + j omega near 0, the stick boundary and delta = 0, subnormal
    numbers.
    """
    speeds = 1.0, 1e-3, 1e-200
    star = scene.contact(speeds, delta=0.0).delta_star
    opposite = -0.5 / scene.j
    return np.array(
        [
            (0.0, 0.0),
            (0.0, 1.0),
            (1.0, 0.0),
            (5e-324, 1.0),
            (-5e-324, 1.0),
            (1.0, 5e-324),
            (1e-300, 0.0),
            *[(0.5, ulps(opposite, n)) for n in (-2, -1, 0, 1, 2)],
            *[
                (V, ulps(V * at, n))
                for V, d in zip(speeds, star)
                for at in (1.0 - d, 1.0, 1.0 + d)
                for n in (-1, 0, 1)
            ],
        ]
    )


@pytest.mark.parametrize("method", ["integrate", "flow"])
@pytest.mark.parametrize("name", SCENES)
def test_finite_in_bounded_steps(name, method):
    """Any end time from 1e-12 to 1e12 decay times; the mirrored starts give the mirrored motions,
    bit for bit.
    """
    scene = SCENES[name]
    start = nasty(scene)
    t = decay_time(scene) * np.array([1e-12, 1e-6, 1e-2, 1.0, 10.0, 100.0, 1e3, 1e6, 1e12])
    options = {"method": method, "fields": FIELDS, "rtol": 1e-6, "max_steps": STEPS}
    here, there = (scene.ensemble(*(sign * start).T, t, **options) for sign in (1.0, -1.0))
    assert here.success.all(), start[~here.success]
    assert not np.isnan(here.delta).any()
    for field in ("V", "omega", "x", "angle"):
        finite = np.isfinite(here[field]).all(axis=1)
        assert finite.all(), (field, start[~finite])
        assert np.array_equal(here[field], -there[field]), field
    # resistance may feed a cylinder that spins against its way
    rolling = np.minimum.accumulate(here.V * here.omega, axis=1) >= 0.0
    rolling &= start.prod(axis=1, keepdims=True) >= 0.0
    energy = here.V**2 + scene.j * here.omega**2
    first = start**2 @ [[1.0], [scene.j]]
    assert (energy <= (1.0 + tol.MOTION_DEFAULT) * first)[rolling].all()
    if scene.alpha > 1.5:
        assert (abs(here.V[:, -1]) < tol.PROVEN_SUBNORMAL).all()
        np.testing.assert_array_equal(here.x[:, -1], here.x[:, -2])


@pytest.mark.parametrize("rtol", [1e-6, 1e-8, 1e-10])
def test_speeds_that_vanish_together(rtol):
    """Within 80 ULP of the omega for which V and omega slide to zero at once, onset lies near V =
    1e-16: what relaxes there takes no time that the clock could tell.  Found where matrices of
    other digits moved the onset."""
    omega = 1.4692137743888392 * (1.0 + np.arange(-80, 81) * np.finfo(float).eps)
    ended = SCENE.ensemble(-1.0, omega, [1e-3, 3e-3], rtol=rtol, method="integrate")
    assert ended.success.all()
    assert (abs(ended.V) <= tol.VANISHED * rtol).all()
