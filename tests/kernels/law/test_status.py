"""An iteration that does not converge is told.

Equation (6) is solved within a bracket and converges; that it may not is planted, in kernels that Python runs.
"""

from __future__ import annotations

from processes import printed

import viscoroll as vr

PLANT = """
import viscoroll as vr
from viscoroll.kernels.law import length, stick

def capped(steps):
    length.MAX_STEPS = stick.MAX_STEPS = steps
"""
STARTS = """
capped(1)
for drive in ({}, {"force": 0.01}):
    for omega in (1.0, 3.0):  # in partial and in full slip
        print(int(vr.roll(vr.PAPER_SECTION_5, 1.0, omega, 1e-9, **drive).status))
"""


def test_a_start_that_did_not_converge_is_told():
    """In full slip it went on from a wrong length."""
    assert printed(PLANT + STARTS, NUMBA_DISABLE_JIT="1").split() == [str(int(vr.MotionStatus.NOT_CONVERGED))] * 4
