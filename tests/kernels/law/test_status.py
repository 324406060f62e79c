"""An iteration that does not converge: it is told, and what it leaves serves nobody.

Equation (6) is solved within a bracket and converges; that it may not is planted, in kernels that Python runs.
"""

from __future__ import annotations

from processes import printed

import viscoroll as vr

PLANT = """
import viscoroll as vr
from viscoroll.kernels.law import inverses, length, stick
from viscoroll.kernels.material.standard import standard

def capped(steps):
    length.MAX_STEPS = stick.MAX_STEPS = steps
"""
TABLES = """
tables = inverses.inverses_of(standard(11.0))
one, other = 0.3 * 2.0**-64, 0.3  # bins that share a row
for at in (inverses.at_speed, inverses.at_stick):
    first = at(one, tables)
    capped(1)
    bad = at(other, tables)
    capped(60)
    print(first[-1], bad[-1], at(one, tables) == first, at(other, tables)[-1])
"""
STARTS = """
capped(1)
for drive in ({}, {"force": 0.01}):
    for omega in (1.0, 3.0):  # in partial and in full slip
        print(int(vr.roll(vr.PAPER_SECTION_5, 1.0, omega, 1e-9, **drive).status))
"""


def test_a_bin_that_did_not_converge_is_made_anew():
    """The row of a table kept the number of the bin before, and answered for it from what was left half made."""
    assert printed(PLANT + TABLES, NUMBA_DISABLE_JIT="1") == "0 1 True 0\n" * 2


def test_a_start_that_did_not_converge_is_told():
    """In full slip it went on from a wrong length."""
    assert printed(PLANT + STARTS, NUMBA_DISABLE_JIT="1").split() == [str(int(vr.MotionStatus.NOT_CONVERGED))] * 4
