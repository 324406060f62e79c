"""Arrays of materials, one for each state or motion; with modes that fall away, of two bodies."""

from functools import partial

import numpy as np
import tolerances as tol
from closeness import close

import viscoroll as vr

#: materials of an array of pairs
COUNT = 12
#: two bodies of other times
UNLIKE = vr.Bodies(
    vr.Prony([2.0, 5.0], [1.0, 1e-3]), vr.Prony([4.0, 1.0, 0.3], [0.2, 2e-4, 1e-7]), 0.3
)


def states(count, seed):
    """alpha from exactly 1 to 1e12, kappa, mu, V > 0, and the share of delta_star, graded to both
    ends.
    """
    rng = np.random.default_rng(seed)
    alpha = 10.0 ** rng.uniform(0.0, 6.0, count)
    alpha[:6] = 1.0, 1.0 + 2.0**-52, 1.0 + 1e-9, 2.0, 2.0**20, 1e12
    kappa = 10.0 ** rng.uniform(-0.3, 2.3, count)
    mu = 10.0 ** rng.uniform(-2.0, 0.5, count)
    near = 1.0 - 10.0 ** rng.uniform(-6.0, 0.0, count)
    at_rest = 10.0 ** rng.uniform(-12.0, 0.0, count)
    s = np.choose(rng.integers(3, size=count), [at_rest, near, rng.random(count)])
    return alpha, kappa, mu, 10.0 ** rng.uniform(-7.0, 7.0, count) / kappa, s


def rubbers(draw, modes, count=COUNT):
    """Random ones; some with a mode less, of strength 0 or of equal times, and one elastic."""
    times = 10.0 ** draw.uniform(-4.0, 1.0, (count, modes))
    strengths = 10.0 ** draw.uniform(-1.0, 1.0, (count, modes))
    if modes > 2:
        strengths[1, 2] = 0.0
        times[4, 1] = times[4, 0]
        strengths[5] = 0.0
    return vr.Prony(strengths, times)


def series(seed, modes, decades, count):
    draw = np.random.default_rng(seed)
    return vr.Prony(
        10.0 ** draw.uniform(-1.5, 1.5, (count, modes)),
        10.0 ** draw.uniform(-decades, 0.0, (count, modes)),
    )


def of_alphas():
    alpha = np.array([1.0 + 1e-9, 1.01, 3.0, 11.0, 27.0, 300.0, 1e4, 1e6, 1e9, 1e12])
    return vr.Prony.creep(((alpha - 1.0) / alpha)[:, None], np.ones((alpha.size, 1)), alpha=alpha)


ONE = vr.Prony([2.0, 1.0], [1.0, 1e-2])
ELASTIC = vr.Prony.elastic()
_DRAW = np.random.default_rng(4)
SHARE = _DRAW.uniform(0.0, 1.0, COUNT)
FIRST = rubbers(_DRAW, 3)
#: of one body for all, of rigid and elastic bodies, of like series with a share each
PAIRS = {
    "each": (FIRST, rubbers(_DRAW, 3), SHARE),
    "one base": (FIRST, ONE, 0.6),
    "a share each": (ONE, vr.Prony([0.5], [0.1]), SHARE),
    "elastic base": (FIRST, ELASTIC, SHARE),
    "both elastic": (ELASTIC, ELASTIC, SHARE),
    "some rigid": (FIRST, rubbers(_DRAW, 2), 1.0 * (np.arange(COUNT) % 2)),
    "rigid cylinder": (ELASTIC, FIRST, 0.0),
    "of one series": (FIRST, FIRST, SHARE),
    "of equal times": (
        *(
            vr.Prony.creep(0.4 * _DRAW.uniform(size=(COUNT, 2)), [1.0, fast])
            for fast in (0.1, 1e-3)
        ),
        SHARE,
    ),
}
MATERIALS = {
    "one mode": of_alphas,
    "3 modes": lambda: FIRST,
    "6 modes over 14 decades": lambda: series(2, 6, 14.0, 6),
    "16 modes": lambda: series(3, 16, 10.0, 4),
} | {kind: partial(vr.Bodies, *bodies) for kind, bodies in PAIRS.items()}


def assert_covers_are_each(covers):
    """States and motions of two covers in one call are those of each."""
    scene = vr.Scene(material=covers, kappa=10.0, mu=0.3, gamma=0.5, coupled=False)
    V = np.array([0.01, -0.5])
    motion = (0.1, [1.0, 9.0])
    found = scene.contact(V, delta=-2e-3, slopes=True)
    motions = scene.ensemble(V, *motion, rtol=1e-10)
    for n, cover in enumerate(covers):
        one = scene.replace(material=cover)
        for name, value in one.contact(V[n], delta=-2e-3, slopes=True).as_dict().items():
            assert close(found[name][n], value, tol.COVER_EACH, what=name)
        assert close(motions.V[n], one.roll(V[n], *motion, rtol=1e-10).V, tol.COVER_EACH_MOTION)
