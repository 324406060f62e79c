"""Against implementations that nobody here wrote; each deviation as large as its own error
explains.
"""

import pytest
import tolerances as tol

from pipeline.evidence.prove import independent

#: source -> quantity -> how far it is off at most
BOUNDS = {
    "wang_knothe": {
        "creep, relative": tol.WANG_KNOTHE_CREEP[1],
        "p_max, relative": tol.WANG_KNOTHE_PEAK,
        "width, cells": tol.WANG_KNOTHE_CELLS,
        "width of the stick zone, cells": tol.WANG_KNOTHE_CELLS,
    },
    "bentall": {"creep, relative": tol.BENTALL},
    "carter": {"Q/μ, absolute": tol.CARTER_CELLS, "p_max, relative": tol.CARTER_PEAK},
    "half_space": {
        "Q/μ, absolute": tol.HALF_SPACE_Q,
        "λ, absolute": tol.HALF_SPACE_LENGTH,
        "ε, absolute": tol.HALF_SPACE_SHIFT,
        "β, absolute": tol.HALF_SPACE_STICK,
        "M, relative, κV up to 2": tol.HALF_SPACE_MOMENT_SLOW,
        "M, relative, κV up to 20": tol.HALF_SPACE_MOMENT,
        "full slip, decided otherwise": 0.0,
    },
    "profiles": {
        "p, divided by its peak": tol.HALF_SPACE_CODE_P,
        "τ, divided by μ times the peak of p": tol.HALF_SPACE_CODE_TAU,
    },
    "section_5": {
        "V, relative": tol.SECTION_5_SPEED,
        "ω, divided by V": tol.SECTION_5_SPEED,
        "onset time, relative": tol.SECTION_5_ONSET,
    },
}


@pytest.mark.filterwarnings(
    "ignore::viscoroll.ModelWarning"
)  # the paper's own scene is beyond the model
@pytest.mark.parametrize("source", BOUNDS)
def test_no_further_off_than_its_own_errors_explain(source):
    off = getattr(independent, source)()
    for name, bound in BOUNDS[source].items():
        assert abs(off[name]).max() <= bound, name
