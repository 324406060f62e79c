"""The table values.txt: what calls give, to the bit, or within a tolerance of a number by hand."""

import numpy as np
import pytest
import tolerances
from calls import lines_of, names_in
from closeness import close

LINES = lines_of("values.txt")


@pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")
@pytest.mark.parametrize(("call", "answer"), LINES, ids=[call for call, _ in LINES])
def test_value(call, answer, tmp_path):
    names = names_in(tmp_path)
    (exact, within, tolerance) = answer.partition(" within ")
    found = eval(call, names)
    exact = eval(exact.removeprefix("== "), names)
    if within:
        tolerance, _, scale = tolerance.partition(" of ")
        assert close(found, exact, eval(tolerance, vars(tolerances)), scale=float(scale or 0.0))
    else:
        assert (
            np.array_equal(found, exact, equal_nan=True)
            if isinstance(found, np.ndarray)
            else found == exact
        )
