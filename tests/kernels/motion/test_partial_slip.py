"""Partial slip: where its slow manifold is sought first."""

from __future__ import annotations

import numpy as np
import pytest
import tolerances as tol
from closeness import close

from viscoroll.kernels.free.collocation import NODES, SMOOTH_SLOPES, N
from viscoroll.kernels.free.partial_slip import slow_D
from viscoroll.kernels.free.slow import NODE_D, slow_solve, slow_start, workspace
from viscoroll.scene import kernel_scene


@pytest.mark.parametrize(
    "scene", [(11.0, 2.91, 0.2, 0.5), (11.0, 2.91, 0.2, 1.5), (300.0, 10.0, 0.05, 0.3), (1.5, 5.0, 0.3, 0.8)]
)
def test_leading_order_of_the_slow_manifold(scene):
    """D0 is D but for a part of order 1/zeta, D being solved for by collocation; dD0/dy is its slope.

    A motion does not tell: what is solved for is D - D0, and comes out right from a bad D0, too.
    """
    given, work = kernel_scene(*scene), workspace.py_func()
    for array in work:
        array.fill(0.0)
    for zeta in (1e2, 1e3, 1e4, 1e5):
        y, length = np.log(zeta), 0.5
        slow_start(y, 0.0, work.values, given)
        assert slow_solve(y, length, 1e-12, SMOOTH_SLOPES, given, work)
        D0 = np.array([slow_D(at, given)[0] for at in y + 0.5 * length * (1.0 + NODES[1:])])
        assert close(work.values[1 : N + 1, NODE_D], D0, rel=tol.MANIFOLD_NEXT / zeta)
        before, behind = (slow_D(y + step, given)[0] for step in (-1e-4, 1e-4))
        # the slope is of order 1/zeta: beyond that differences of D0 lose it to rounding
        if zeta < 1e4:
            assert close(slow_D(y, given)[1], (behind - before) / 2e-4, rel=tol.MANIFOLD_SLOPE)
