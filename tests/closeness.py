"""How far a number may lie from what it should be: one strict comparison for the whole suite.

``pytest.approx`` allows 1e-12 absolute, ``assert_allclose(atol=)`` 1e-7 relative and
``np.allclose(rtol=)`` 1e-8 absolute unless they are told otherwise; the linter forbids the three.
Here nothing is allowed that is not said.
"""

import numpy as np


def close(found, exact, rel, *, scale=0.0, what=""):
    """Whether ``|found - exact| <= rel max(|exact|, scale)`` everywhere; where it is not, the worst
    place is told.

    ``scale`` is the size of which ``rel`` counts where ``exact`` is small or 0: a sum's largest
    term, a motion's largest speed.  NaN agrees with NaN alone, infinity with the same infinity.
    ``what`` is told first.

    Raises
    ------
    AssertionError
        Beyond what is allowed, of another shape (a single ``exact`` stands for a whole array), or
        where there is nothing to compare.
    """
    found, exact = (np.asarray(v, complex if np.iscomplexobj(v) else float) for v in (found, exact))
    assert exact.ndim == 0 or found.shape == exact.shape, f"shape {found.shape}, not {exact.shape}"
    assert found.size, "nothing to compare"
    with np.errstate(invalid="ignore", over="ignore"):
        off = np.abs(found - exact)
        allowed = rel * np.maximum(np.abs(exact), np.abs(scale))
        good = (
            (found == exact)
            | (np.isnan(found) & np.isnan(exact))
            | ((off <= allowed) & np.isfinite(allowed))
        )
    if good.all():
        return True
    off, allowed, found, exact = np.broadcast_arrays(off, allowed, found, exact)
    with np.errstate(invalid="ignore", divide="ignore"):
        badness = np.where(good, -1.0, off / allowed)  # of several NaN the first
    worst = np.unravel_index(np.argmax(badness), off.shape)
    raise AssertionError(
        f"{what} {found[worst]!r} at {tuple(int(i) for i in worst)}, not {exact[worst]!r}: off by "
        f"{off[worst]:.3g}"
        f" where {allowed[worst]:.3g} is allowed; {np.count_nonzero(~good)} of {good.size} beyond"
    )
