"""The table refusals.txt: bad input is answered by an error of the package's own, doubtful input by
one warning.
"""

import warnings

import pytest
from calls import lines_of, names_in
from refusals import refused

import viscoroll as vr
from viscoroll.core import errors

LINES = lines_of("refusals.txt")


def told(call, answer, names):
    """One warning that points to who called, with these words; or none, or none with these."""
    first, *words = answer.split(" | ")
    silent = first == "no warning"
    first = words.pop() if silent and words else "" if silent else first
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always")
        eval(call, names)
    said = [each for each in found if first in str(each.message)]
    assert len(said) == (not silent), [str(each.message) for each in found]
    for each in said:
        assert (each.category, each.filename) == (vr.ModelWarning, "<string>")
        assert all(word in str(each.message) for word in words)


@pytest.mark.filterwarnings("ignore::viscoroll.ModelWarning")
@pytest.mark.parametrize(("call", "answer"), LINES, ids=[call for call, _ in LINES])
def test_answered(call, answer, tmp_path):
    names = names_in(tmp_path)
    (kind, _, words) = answer.rpartition("! ")
    if kind == "says":
        said = str(eval(call, names))
        assert all(word in said for word in words.split(" | ")), said
        return None
    if kind == "ModelWarning" or words.startswith("no warning"):
        told(call, words, names)
        return None
    error = getattr(errors, kind or "ParameterError")
    refused(lambda: eval(call, names), *words.split(" | "), error=error)


def test_errors_of_input_are_value_errors():
    assert issubclass(vr.ParameterError, ValueError)
